//! The form in which a deck evaluates the compliance of its rails.

use formats::scene::TableInterpolation;

/// Form in which a deck evaluates the compliance of its rails.
///
/// ```
/// use deck::DeckForm;
/// use formats::scene::TableInterpolation;
///
/// assert_eq!(DeckForm::of_readings([TableInterpolation::Exact, TableInterpolation::Natural]), DeckForm::Factored);
/// assert_eq!(DeckForm::of_readings([TableInterpolation::Exact, TableInterpolation::Akispl]), DeckForm::Akispl);
/// assert_eq!(DeckForm::Symmetrised.word(), "symmetrised");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeckForm {
    /// AKISPL of a family: N^2 look-ups for N wheels, neither symmetric nor conservative between the stations.
    Akispl,
    /// The mean of AKISPL(x, z) and AKISPL(z, x): 2 N^2 look-ups, symmetric.
    Symmetrised,
    /// Products of r curves evaluated by CUBSPL: r N look-ups, symmetric and positive, with the force along the rail.
    Factored,
    /// The expressions of the paper, with their approximations, for comparison only.
    Paper,
}

impl DeckForm {
    /// The default form of a scene: factored, unless the reading of a structure is AKISPL.
    ///
    /// Only the factored form is symmetric and positive everywhere and smooth under a moving wheel, and only this
    /// form includes the force along the rail, without which a free body gains energy.
    #[must_use]
    pub fn of_readings(readings: impl IntoIterator<Item = TableInterpolation>) -> DeckForm {
        let akispl = readings
            .into_iter()
            .any(|reading| reading == TableInterpolation::Akispl);
        if akispl {
            DeckForm::Akispl
        } else {
            DeckForm::Factored
        }
    }

    /// The word for the form on the command line.
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
