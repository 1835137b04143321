//! Methods of reading tables.

use splines::{Axis, Compliance, Error, Factored, Kind, Lift, Rank, Reading, Sheet, Table, lift};

/// Largest deviation of a table from a beam in bending, relative to its largest entry, at which the beam stands for
/// the table.
const MISFIT: f64 = 0.01;

/// A method of reading tables of influence coefficients.
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
    /// Sums of products of CUBSPLs of one variable.
    Factored,
    /// The beam whose influence coefficients the table holds.
    Exact,
}

impl TableReadingMethod {
    /// All methods, in the order of findings.
    pub const ALL: [TableReadingMethod; 6] = [
        TableReadingMethod::Akispl,
        TableReadingMethod::Symmetrised,
        TableReadingMethod::Cubspl,
        TableReadingMethod::Natural,
        TableReadingMethod::Factored,
        TableReadingMethod::Exact,
    ];

    /// The word of the method on the command line and in results.
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

    /// Order of its error in the distance of stations, for beams in bending.
    #[must_use]
    pub const fn order(self) -> f64 {
        match self {
            TableReadingMethod::Akispl | TableReadingMethod::Symmetrised | TableReadingMethod::Cubspl => 2.0,
            TableReadingMethod::Natural | TableReadingMethod::Factored | TableReadingMethod::Exact => 3.0,
        }
    }

    /// The tables read by this method. [`TableReadingMethod::Exact`] accepts a single vertical table without couplings.
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

/// The beam in bending whose influence coefficients a table holds, with its rail `rail`.
///
/// # Errors
/// A table that deviates from every such beam by more than 1 percent of its largest entry.
pub fn raised(rail: usize, table: &Table) -> Result<Lift, Error> {
    let beam = lift(rail, table)?;
    if beam.misfit <= MISFIT { Ok(beam) } else { Err(Error::Unliftable) }
}
