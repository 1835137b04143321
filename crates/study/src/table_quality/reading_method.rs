//! Readings by their words.

use splines::{Axis, Compliance, Error, Factored, Kind, Lift, Rank, Reading, Sheet, Table, lift};

/// A table further than this from any beam in bending, of its largest entry, is not raised.
const MISFIT: f64 = 0.01;

/// A way to read tables of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableReadingMethod {
    /// AKISPL along the load, linear along the deflection.
    Akispl,
    /// The mean of AKISPL with load and deflection exchanged.
    Symmetrised,
    /// CUBSPL along the load, linear along the deflection.
    Cubspl,
    /// Natural splines along both.
    Natural,
    /// Products of one-curve CUBSPLs.
    Factored,
    /// The beam behind the values.
    Exact,
}

impl TableReadingMethod {
    /// All, as tables of findings list them.
    pub const ALL: [TableReadingMethod; 6] = [
        TableReadingMethod::Akispl,
        TableReadingMethod::Symmetrised,
        TableReadingMethod::Cubspl,
        TableReadingMethod::Natural,
        TableReadingMethod::Factored,
        TableReadingMethod::Exact,
    ];

    /// Its word on the command line and in results.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            TableReadingMethod::Akispl => "akispl",
            TableReadingMethod::Symmetrised => "symmetrised",
            TableReadingMethod::Cubspl => "cubspl",
            TableReadingMethod::Natural => "natural",
            TableReadingMethod::Factored => "factored",
            TableReadingMethod::Exact => "exact",
        }
    }

    /// Power of the distance of stations with which its error falls where bending alone gives.
    #[must_use]
    pub const fn order(self) -> f64 {
        match self {
            TableReadingMethod::Akispl | TableReadingMethod::Symmetrised | TableReadingMethod::Cubspl => 2.0,
            TableReadingMethod::Natural | TableReadingMethod::Factored | TableReadingMethod::Exact => 3.0,
        }
    }

    /// The tables read so. [`Manner::Exact`] raises one table of bending; it takes no couplings.
    ///
    /// # Errors
    /// As [`Reading::new`], [`Factored::new`] and [`raised()`].
    pub fn read(self, sheets: &[Sheet]) -> Result<Box<dyn Compliance>, Error> {
        let kind = match self {
            TableReadingMethod::Akispl => Kind::Akispl,
            TableReadingMethod::Cubspl => Kind::Cubspl,
            TableReadingMethod::Symmetrised => Kind::Symmetrised,
            TableReadingMethod::Natural => Kind::Natural,
            TableReadingMethod::Factored => return Ok(Box::new(Factored::new(sheets, Rank::Full)?)),
            TableReadingMethod::Exact => {
                return match sheets {
                    [one] if one.load == one.deflection && one.load.1 == Axis::Vertical => {
                        Ok(Box::new(raised(one.load.0, &one.table)?.surface))
                    }
                    _ => Err(Error::Unliftable),
                };
            }
        };
        Ok(Box::new(Reading::new(kind, sheets)?))
    }
}

/// The beam in bending behind a table.
///
/// # Errors
/// A table that is further than 1 percent from any such beam.
pub fn raised(rail: usize, table: &Table) -> Result<Lift, Error> {
    let found = lift(rail, table)?;
    if found.misfit <= MISFIT { Ok(found) } else { Err(Error::Unliftable) }
}
