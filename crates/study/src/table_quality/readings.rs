//! The findings of one reading of one table.

use splines::quality::{
    BlockExtreme, CouplingBlock, LoopWork, ReadingError, SlopeJump, Spectrum, WheelLayout,
    asymmetry, diagonal_slope_jumps, indefinite_fraction, loop_work, pair_slope_jumps,
    reading_error, sample_places, spectrum, weakest_layouts,
};
use splines::{Compliance, Error};

use super::reading_method::TableReadingMethod;

/// Numbers of wheels for which indefinite layouts are searched.
pub const WHEELS: [usize; 3] = [2, 4, 8];
/// Number of random layouts for each number of wheels.
const LAYOUTS: usize = 1000;
/// Smallest and largest number of places along the rail at which a reading is evaluated, and the number for spectra.
const PLACES: [usize; 2] = [300, 900];
const SPECTRUM: usize = 120;

/// The findings of one reading of one table.
#[derive(Clone, Debug)]
pub struct ReadingFindings {
    /// The method.
    pub method: TableReadingMethod,
    /// Error against the exact surface over the whole table; `None` where no exact values are known.
    pub error: Option<ReadingError>,
    /// The same between the first and the last support.
    pub span: Option<ReadingError>,
    /// Findings of a direct table on symmetry and definiteness.
    pub direct: Option<DirectFindings>,
}

/// Findings that are defined only for deflections and loads of one path and direction.
#[derive(Clone, Debug)]
pub struct DirectFindings {
    /// Largest |G(x, z) - G(z, x)|.
    pub asymmetry: BlockExtreme,
    /// Largest |G| at the evaluated places.
    pub scale: f64,
    /// Smallest and largest eigenvalue of the symmetric part at densely spaced places.
    pub spectrum: Spectrum,
    /// Fraction of random layouts of 2, 4 and 8 wheels whose compliance matrix is indefinite.
    pub indefinite_fractions: [f64; 3],
    /// The weakest layouts of 2, 4, 8 wheels.
    pub layouts: Vec<WheelLayout>,
    /// The largest jump of slope under a moving wheel; `None` where there is no station between the ends.
    pub slope_jump: Option<SlopeJump>,
    /// Findings of two wheels at the distance of the settings.
    pub pair: Option<Pair>,
}

/// Findings of two wheels at a fixed distance.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// The loop of forces with the most work.
    pub work: LoopWork,
    /// The largest jump of slope of their mean.
    pub slope_jump: Option<SlopeJump>,
}

/// Exact block and places with which a reading is compared.
pub struct ReadingPlanes<'a> {
    /// The exact block.
    pub exact: Option<CouplingBlock<'a>>,
    /// Ranges of loads and of deflections that both cover.
    pub range: [[f64; 2]; 2],
    /// From the first to the last support, where there are two.
    pub span: Option<[f64; 2]>,
    /// Distance of the wheels of a pair.
    pub spacing: Option<f64>,
}

impl ReadingFindings {
    /// The findings of a reading whose block is `block`.
    ///
    /// # Errors
    /// A place at which the reading or the exact surface cannot be evaluated.
    pub fn of(
        method: TableReadingMethod,
        block: &CouplingBlock<'_>,
        frame: &ReadingPlanes<'_>,
    ) -> Result<ReadingFindings, Error> {
        let [x, z] = [block.load.0, block.deflection.0].map(|rail| block.compliance.breaks(rail));
        let exact = frame.exact.as_ref();
        let against = |from: [[f64; 2]; 2]| {
            let error = |exact: &CouplingBlock<'_>| {
                let ends =
                    |own: &[f64], rail: usize| [own, &exact.compliance.breaks(rail)].concat();
                let [x, z] = [ends(&x, exact.load.0), ends(&z, exact.deflection.0)];
                let [x, z] = [dense(&x, from[0]), dense(&z, from[1])];
                reading_error(block, exact, &x, &z)
            };
            exact.map(error).transpose()
        };
        let direct = block
            .is_direct()
            .then(|| direct(block, &x, frame))
            .transpose()?;
        let span = frame
            .span
            .filter(|_| block.is_direct())
            .map_or(Ok(None), |span| against([span; 2]))?;
        Ok(ReadingFindings {
            method,
            error: against(frame.range)?,
            span,
            direct,
        })
    }
}

/// Densely spaced places over `range`, the breaks included.
fn dense(breaks: &[f64], range: [f64; 2]) -> Vec<f64> {
    sample_places(
        breaks,
        range,
        (4 * breaks.len()).clamp(PLACES[0], PLACES[1]),
    )
}

/// The findings on symmetry and definiteness of a direct block.
fn direct(
    block: &CouplingBlock<'_>,
    breaks: &[f64],
    frame: &ReadingPlanes<'_>,
) -> Result<DirectFindings, Error> {
    let range = frame.range[0];
    let at = dense(breaks, range);
    let few = sample_places(breaks, range, SPECTRUM);
    let mut fractions = [0.0; 3];
    for (fraction, wheels) in fractions.iter_mut().zip(WHEELS) {
        *fraction = indefinite_fraction(block, wheels, LAYOUTS, range)?;
    }
    let largest = |slope_jumps: Vec<SlopeJump>| {
        slope_jumps
            .into_iter()
            .max_by(|a, b| a.jump().abs().total_cmp(&b.jump().abs()))
    };
    let pair = match frame
        .spacing
        .filter(|spacing| *spacing < range[1] - range[0])
    {
        None => None,
        Some(spacing) => {
            let slope_jump = largest(pair_slope_jumps(block, spacing, range)?);
            Some(Pair {
                work: loop_work(block, spacing, &at)?,
                slope_jump,
            })
        }
    };
    Ok(DirectFindings {
        asymmetry: asymmetry(block, &at)?,
        scale: block.matrix(&few, &few)?.amax(),
        spectrum: spectrum(block, &few)?,
        indefinite_fractions: fractions,
        layouts: weakest_layouts(block, &WHEELS, &few)?,
        slope_jump: largest(diagonal_slope_jumps(block, range)?),
        pair,
    })
}

/// Errors (reading less exact) over places, for maps: one row for each place `z` of the deflection.
///
/// # Errors
/// As [`ReadingFindings::of`].
pub fn map(
    block: &CouplingBlock<'_>,
    exact: &CouplingBlock<'_>,
    z: &[f64],
    x: &[f64],
) -> Result<Vec<Vec<f64>>, Error> {
    let error = block.matrix(z, x)? - exact.matrix(z, x)?;
    Ok(error
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect())
}

/// The block of a compliance between two paths: deflection and load.
#[must_use]
pub fn coupling_block(
    compliance: &dyn Compliance,
    [deflection, load]: [splines::quality::RailDirection; 2],
) -> CouplingBlock<'_> {
    CouplingBlock {
        compliance,
        deflection,
        load,
    }
}
