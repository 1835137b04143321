//! Methods of reading tables.

use splines::{
    Axis, BeamFit, Compliance, Error, FactoredTable, InfluenceBlock, Rank, ReadingMethod,
    SplineTable, TableReading, fit_beam,
};

/// Largest deviation of a table from a beam in bending, relative to its largest entry, at which the beam is taken as
/// the exact structure of the table.
const BEAM_TOLERANCE: f64 = 0.01;

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
            TableReadingMethod::Akispl
            | TableReadingMethod::Symmetrised
            | TableReadingMethod::Cubspl => 2.0,
            TableReadingMethod::Natural
            | TableReadingMethod::Factored
            | TableReadingMethod::Exact => 3.0,
        }
    }

    /// The tables read by this method. [`TableReadingMethod::Exact`] accepts a single vertical table without
    /// couplings.
    ///
    /// # Errors
    /// As [`TableReading::new`], [`FactoredTable::new`] and [`beam_of()`].
    pub fn read(self, blocks: &[InfluenceBlock]) -> Result<Box<dyn Compliance>, Error> {
        let kind = match self {
            TableReadingMethod::Akispl => ReadingMethod::Akispl,
            TableReadingMethod::Cubspl => ReadingMethod::Cubspl,
            TableReadingMethod::Symmetrised => ReadingMethod::Symmetrised,
            TableReadingMethod::Natural => ReadingMethod::Natural,
            TableReadingMethod::Factored => {
                return Ok(Box::new(FactoredTable::new(blocks, Rank::Full)?));
            }
            TableReadingMethod::Exact => {
                return match blocks {
                    [one] if one.load == one.deflection && one.load.1 == Axis::Vertical => {
                        Ok(Box::new(beam_of(one.load.0, &one.table)?.surface))
                    }
                    _ => Err(Error::NoBeamFit),
                };
            }
        };
        Ok(Box::new(TableReading::new(kind, blocks)?))
    }
}

/// The beam in bending whose influence coefficients a table holds, with its rail `rail`.
///
/// # Errors
/// A table that deviates from every such beam by more than 1 percent of its largest entry.
pub fn beam_of(rail: usize, table: &SplineTable) -> Result<BeamFit, Error> {
    let beam = fit_beam(rail, table)?;
    if beam.error <= BEAM_TOLERANCE {
        Ok(beam)
    } else {
        Err(Error::NoBeamFit)
    }
}
