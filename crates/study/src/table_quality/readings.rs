//! The numbers of one reading of one table.

use splines::check::{
    Deviation, Extreme, Kink, Layout, Spectrum, Strip, Work, asymmetry, deviation, diagonal_kinks,
    indefinite_share, pair_kinks, places, spectrum, weakest_layouts, work,
};
use splines::{Compliance, Error};

use super::reading_method::TableReadingMethod;

/// Numbers of wheels whose layouts are searched.
pub const WHEELS: [usize; 3] = [2, 4, 8];
/// Random layouts of each number.
const LAYOUTS: usize = 1000;
/// Least and most places along the rail at which a reading is looked at, and fewer for spectra.
const PLACES: [usize; 2] = [300, 900];
const SPECTRUM: usize = 120;

/// One reading of one table.
#[derive(Clone, Debug)]
pub struct ReadingFindings {
    /// Which.
    pub manner: TableReadingMethod,
    /// Against the exact surface, over the whole table; `None` where none is known.
    pub error: Option<Deviation>,
    /// The same between the first and the last support.
    pub span: Option<Deviation>,
    /// Of a direct table, what an unsymmetric and indefinite give costs.
    pub direct: Option<DirectFindings>,
}

/// What holds of deflections and loads of one way alone.
#[derive(Clone, Debug)]
pub struct DirectFindings {
    /// Largest |G(x, z) - G(z, x)|.
    pub asymmetry: Extreme,
    /// Largest |G| at the places looked at.
    pub scale: f64,
    /// Ends of the spectrum of the symmetric part, densely sampled.
    pub spectrum: Spectrum,
    /// Share of random layouts of 2, 4, 8 wheels that are indefinite.
    pub shares: [f64; 3],
    /// The weakest layouts of 2, 4, 8 wheels.
    pub layouts: Vec<Layout>,
    /// The largest jump of slope under a moving wheel; `None` where there is no station between the ends.
    pub kink: Option<Kink>,
    /// Two wheels at the distance asked for.
    pub pair: Option<Pair>,
}

/// Two wheels at one distance.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// The loop of forces with the most work.
    pub work: Work,
    /// The largest jump of slope of their mean.
    pub kink: Option<Kink>,
}

/// What a reading is held against, and where.
pub struct ReadingPlanes<'a> {
    /// The exact block.
    pub exact: Option<Strip<'a>>,
    /// Places of loads and of deflections that both know.
    pub range: [[f64; 2]; 2],
    /// From the first to the last support, where there are two.
    pub span: Option<[f64; 2]>,
    /// Distance of the wheels of a pair.
    pub spacing: Option<f64>,
}

impl ReadingFindings {
    /// The numbers of a reading whose block is `strip`.
    ///
    /// # Errors
    /// A place for which the reading or the exact surface has no answer.
    pub fn of(
        manner: TableReadingMethod,
        strip: &Strip<'_>,
        frame: &ReadingPlanes<'_>,
    ) -> Result<ReadingFindings, Error> {
        let [x, z] = [strip.load.0, strip.deflection.0].map(|rail| strip.compliance.breaks(rail));
        let exact = frame.exact.as_ref();
        let against = |from: [[f64; 2]; 2]| {
            let error = |exact: &Strip<'_>| {
                let ends = |own: &[f64], rail: usize| [own, &exact.compliance.breaks(rail)].concat();
                let [x, z] = [ends(&x, exact.load.0), ends(&z, exact.deflection.0)];
                let [x, z] = [dense(&x, from[0]), dense(&z, from[1])];
                deviation(strip, exact, &x, &z)
            };
            exact.map(error).transpose()
        };
        let direct = strip.is_direct().then(|| direct(strip, &x, frame)).transpose()?;
        let span = frame.span.filter(|_| strip.is_direct()).map_or(Ok(None), |span| against([span; 2]))?;
        Ok(ReadingFindings { manner, error: against(frame.range)?, span, direct })
    }
}

fn dense(breaks: &[f64], range: [f64; 2]) -> Vec<f64> {
    places(breaks, range, (4 * breaks.len()).clamp(PLACES[0], PLACES[1]))
}

fn direct(strip: &Strip<'_>, breaks: &[f64], frame: &ReadingPlanes<'_>) -> Result<DirectFindings, Error> {
    let range = frame.range[0];
    let at = dense(breaks, range);
    let few = places(breaks, range, SPECTRUM);
    let mut shares = [0.0; 3];
    for (share, wheels) in shares.iter_mut().zip(WHEELS) {
        *share = indefinite_share(strip, wheels, LAYOUTS, range)?;
    }
    let largest =
        |kinks: Vec<Kink>| kinks.into_iter().max_by(|a, b| a.jump().abs().total_cmp(&b.jump().abs()));
    let pair = match frame.spacing.filter(|spacing| *spacing < range[1] - range[0]) {
        None => None,
        Some(spacing) => {
            let kink = largest(pair_kinks(strip, spacing, range)?);
            Some(Pair { work: work(strip, spacing, &at)?, kink })
        }
    };
    Ok(DirectFindings {
        asymmetry: asymmetry(strip, &at)?,
        scale: strip.block(&few, &few)?.amax(),
        spectrum: spectrum(strip, &few)?,
        shares,
        layouts: weakest_layouts(strip, &WHEELS, &few)?,
        kink: largest(diagonal_kinks(strip, range)?),
        pair,
    })
}

/// Errors over places, for pictures: reading less exact, by rows of deflections.
///
/// # Errors
/// As [`ReadingFindings::of`].
pub fn map(strip: &Strip<'_>, exact: &Strip<'_>, z: &[f64], x: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
    let error = strip.block(z, x)? - exact.block(z, x)?;
    Ok(error.row_iter().map(|row| row.iter().copied().collect()).collect())
}

/// A block of a compliance.
#[must_use]
pub fn strip(compliance: &dyn Compliance, [deflection, load]: [splines::check::Way; 2]) -> Strip<'_> {
    Strip { compliance, deflection, load }
}
