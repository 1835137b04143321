//! How a deck reads the give of its rails.

use formats::scene::Reading;

/// How a deck reads the give of its rails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeckForm {
    /// AKISPL of a family: N^2 look-ups for N wheels; neither symmetric nor conservative off the stations.
    Akispl,
    /// The mean of AKISPL(x, z) and AKISPL(z, x): 2 N^2 look-ups, symmetric.
    Symmetrised,
    /// Products of r curves read by CUBSPL: r N curves, symmetric, positive, with the force along the rail.
    Factored,
    /// The paper's own expressions with what is loose in them, for comparison alone.
    Paper,
}

impl DeckForm {
    /// The form of a scene that asks for none: factored, unless a structure is read by AKISPL.
    ///
    /// Factored, because it alone is symmetric and positive everywhere, smooth under a moving wheel, and lets the
    /// deck have the force along the rail, without which a free body gains energy.
    #[must_use]
    pub fn of_readings(readings: impl IntoIterator<Item = Reading>) -> DeckForm {
        let akispl = readings.into_iter().any(|reading| reading == Reading::Akispl);
        if akispl { DeckForm::Akispl } else { DeckForm::Factored }
    }

    /// Its word on the command line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            DeckForm::Akispl => "akispl",
            DeckForm::Symmetrised => "symmetrised",
            DeckForm::Factored => "factored",
            DeckForm::Paper => "paper",
        }
    }
}
