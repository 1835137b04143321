//! All numbers of one table.

use splines::check::{
    Beyond, Deviation, Digits, Extreme, Spectrum, Way, beyond, digits, station_asymmetry, station_spectrum,
    supports,
};
use splines::{Axis, Compliance, Error, Lift, Sheet};

use super::extrapolation_risk::ExtrapolationRisk;
use super::reading_method::{TableReadingMethod, raised};
use super::readings::{ReadingFindings, ReadingPlanes, strip};
use super::subject::{TableItem, TableSource};

/// What the user asks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Settings {
    /// Force of one wheel.
    pub load: Option<f64>,
    /// Distance of the wheels of a pair.
    pub spacing: Option<f64>,
    /// How far beyond the table its rules are compared; one spacing of the stations where absent.
    pub beyond: Option<f64>,
    /// The reading whose error is judged, and how large it may be, of the largest coefficient.
    pub judged: Option<(TableReadingMethod, f64)>,
}

/// What a reading is compared with.
#[derive(Clone, Debug)]
pub enum Truth {
    /// The exact surface of the grid file.
    Surface,
    /// The beam behind the table.
    Lifted(Lift),
    /// Neither.
    None,
}

/// One table.
pub struct TableQuality {
    /// The table.
    pub item: TableItem,
    /// Digits that its entries were written with.
    pub digits: Digits,
    /// Largest |T_ij - T_ji|; `None` where that has no meaning.
    pub asymmetry: Option<Extreme>,
    /// Ends of its spectrum; `None` where that has no meaning.
    pub spectrum: Option<Spectrum>,
    /// Rigid supports.
    pub supports: Vec<f64>,
    /// What errors are against.
    pub truth: Truth,
    /// Of a coupling, the geometric mean of its two directions' largest entries; `None` of a direct table, or
    /// where they are not known.
    pub scale: Option<f64>,
    /// Each reading; those that the table does not allow are left out.
    pub readings: Vec<ReadingFindings>,
    /// The row with the largest spread of rules beyond the first and the last station.
    pub beyond: Vec<Beyond>,
    /// What about its stations will hurt.
    pub hazards: Vec<ExtrapolationRisk>,
    /// What has failed.
    pub verdicts: Vec<TableVerdict>,
    /// Force of one wheel, where the user gave it.
    pub load: Option<f64>,
}

/// What a table must be and is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableVerdict {
    /// Unsymmetric beyond its digits.
    Asymmetric(Extreme),
    /// An eigenvalue below zero beyond its digits.
    Indefinite(Spectrum),
    /// The judged reading errs more than allowed, relative.
    Error(TableReadingMethod, f64, f64),
    /// The judged reading has nothing to be compared with.
    Unknown(TableReadingMethod),
}

impl TableQuality {
    /// The numbers of table `index` of a file.
    ///
    /// # Errors
    /// A place of the table for which the exact surface has no answer.
    pub fn of(subject: &TableSource, index: usize, settings: &Settings) -> Result<TableQuality, Error> {
        let item = &subject.items[index];
        let table = &item.table;
        let direct = item.is_direct();
        let lifted = if direct { raised(0, table).ok() } else { None };
        let truth = match (&subject.surface, item.ways, &lifted) {
            (Some(_), Some(_), _) => Truth::Surface,
            (_, _, Some(lift)) => Truth::Lifted(lift.clone()),
            _ => Truth::None,
        };
        let supports = if direct { supports(table) } else { Vec::new() };
        let mut found = TableQuality {
            item: item.clone(),
            digits: digits(table),
            asymmetry: station_asymmetry(table).filter(|_| direct),
            spectrum: station_spectrum(table).filter(|_| direct),
            scale: if direct { None } else { scale(subject, item) },
            readings: Vec::new(),
            beyond: Vec::new(),
            hazards: ExtrapolationRisk::of(table, direct, item.linear, &breaks(subject, item)),
            verdicts: Vec::new(),
            load: settings.load,
            supports,
            truth,
        };
        for end in ends(table.x(), settings.beyond) {
            let worst = beyond(table, end)?.into_iter().max_by(|a, b| a.spread().total_cmp(&b.spread()));
            found.beyond.extend(worst);
        }
        found.readings = found.read(subject, settings, lifted.as_ref())?;
        found.judge(settings);
        Ok(found)
    }

    fn read(
        &self,
        subject: &TableSource,
        settings: &Settings,
        lifted: Option<&Lift>,
    ) -> Result<Vec<ReadingFindings>, Error> {
        let mut out = Vec::new();
        let Some(ways) = self.item.ways.filter(|_| !self.is_empty()) else { return Ok(out) };
        let Some(frame) = self.frame(subject, settings, ways) else { return Ok(out) };
        for manner in TableReadingMethod::ALL {
            if manner == TableReadingMethod::Exact {
                // The raised table is worth a column where something else says what is exact.
                if let (Some(lift), Truth::Surface) = (lifted, &self.truth) {
                    out.push(ReadingFindings::of(manner, &strip(&lift.surface, UP), &frame)?);
                }
                continue;
            }
            let Some(reading) = reading(subject, &self.item, manner) else { continue };
            out.push(ReadingFindings::of(manner, &strip(reading.as_ref(), ways), &frame)?);
        }
        Ok(out)
    }

    /// Whether the table holds nothing but zeros, or rounding beside its directions' own tables.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.item.table.values().amax() <= UNCOUPLED * self.scale.unwrap_or(0.0)
    }

    /// An error by what it is relative to: the largest exact coefficient of a direct table, the geometric mean of
    /// its two directions' of a coupling.
    #[must_use]
    pub fn relative(&self, error: &Deviation) -> f64 {
        match self.scale {
            Some(scale) if scale > 0.0 => error.largest.value.abs() / scale,
            _ => error.relative(),
        }
    }

    /// What readings are held against; `None` where table and exact surface have no place in common.
    fn frame<'a>(
        &'a self,
        subject: &'a TableSource,
        settings: &Settings,
        ways: [Way; 2],
    ) -> Option<ReadingPlanes<'a>> {
        let table = &self.item.table;
        let own = |points: &[f64]| [points[0], points[points.len() - 1]];
        let common = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        let mut range = [own(table.x()), own(table.z())];
        if self.item.is_direct() {
            range = [common(range[0], range[1]); 2];
        }
        let exact = match &self.truth {
            Truth::Surface => subject.surface.as_ref().map(|surface| strip(surface, ways)),
            Truth::Lifted(lift) => Some(strip(&lift.surface, UP)),
            Truth::None => None,
        };
        if let Some([x, z]) = exact.as_ref().and_then(splines::check::Strip::range) {
            range = [common(range[0], x), common(range[1], z)];
        }
        let span = match self.supports.as_slice() {
            [first, .., last] => Some(common([*first, *last], range[0])),
            _ => None,
        };
        let frame =
            ReadingPlanes { exact, range, span: span.filter(|[a, b]| a < b), spacing: settings.spacing };
        range.iter().all(|[a, b]| a < b).then_some(frame)
    }

    fn judge(&mut self, settings: &Settings) {
        let slack = self.digits.slack;
        if let Some(worst) = self.asymmetry.filter(|worst| worst.value > slack) {
            self.verdicts.push(TableVerdict::Asymmetric(worst));
        }
        if let Some(spectrum) = self.spectrum.filter(|s| s.smallest < -slack - ROUNDING * s.largest) {
            self.verdicts.push(TableVerdict::Indefinite(spectrum));
        }
        let Some((manner, tolerance)) = settings.judged else { return };
        if self.item.ways.is_none() || self.is_empty() {
            return;
        }
        let error =
            self.readings.iter().find(|reading| reading.manner == manner).and_then(|found| found.error);
        match error.map(|error| self.relative(&error)) {
            Some(error) if error <= tolerance => {}
            Some(error) => self.verdicts.push(TableVerdict::Error(manner, error, tolerance)),
            None => self.verdicts.push(TableVerdict::Unknown(manner)),
        }
    }
}

/// The raised table answers as the vertical of its first rail, whatever it is.
pub(super) const UP: [Way; 2] = [(0, Axis::Vertical); 2];
/// Eigenvalues above minus this, of the largest, are rounding.
const ROUNDING: f64 = 1e-13;

/// A coupling below this share of its directions' own coefficients is none.
const UNCOUPLED: f64 = 1e-9;

/// Geometric mean of the largest entries of a coupling's two directions.
fn scale(subject: &TableSource, item: &TableItem) -> Option<f64> {
    let largest = |way: Way| {
        let own = subject.items.iter().filter(|item| item.ways == Some([way; 2]));
        own.map(|item| item.table.values().amax()).next()
    };
    let [deflection, load] = item.ways?;
    Some((largest(deflection)? * largest(load)?).sqrt())
}

/// A reading of the table: together with all others where they allow it, alone otherwise.
pub(super) fn reading(
    subject: &TableSource,
    item: &TableItem,
    manner: TableReadingMethod,
) -> Option<Box<dyn Compliance>> {
    let [deflection, load] = item.ways?;
    let own = Sheet { deflection, load, table: item.table.clone() };
    let all = subject.sheets();
    let together = if all.contains(&own) { manner.read(&all).ok() } else { None };
    together.or_else(|| manner.read(&[own]).ok())
}

/// Ends of the cells of the rail that loads stand on; nothing where they are not known.
fn breaks(subject: &TableSource, item: &TableItem) -> Vec<f64> {
    let surface = subject.surface.as_ref().zip(item.ways);
    surface.map(|(surface, [_, load])| surface.breaks(load.0)).unwrap_or_default()
}

/// Places beyond both ends, at the distance asked for or at that of the last two stations.
fn ends(x: &[f64], distance: Option<f64>) -> [f64; 2] {
    let n = x.len();
    [x[0] - distance.unwrap_or(x[1] - x[0]), x[n - 1] + distance.unwrap_or(x[n - 1] - x[n - 2])]
}
