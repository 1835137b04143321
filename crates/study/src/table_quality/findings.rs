//! The findings of one table, and the verdicts that follow.

use splines::quality::{
    BlockExtreme, ExtrapolatedRow, RailDirection, ReadingError, Spectrum, TablePrecision,
    extrapolated_rows, station_asymmetry, station_spectrum, support_stations, table_precision,
};
use splines::{Axis, BeamFit, Compliance, Error, InfluenceBlock};

use super::extrapolation_risk::ExtrapolationRisk;
use super::reading_method::{TableReadingMethod, beam_of};
use super::readings::{ReadingFindings, ReadingPlanes, coupling_block};
use super::subject::{TableItem, TableSource};

/// Settings of an evaluation.
#[derive(Clone, Copy, Debug, Default)]
pub struct TableQualitySettings {
    /// Force of one wheel.
    pub load: Option<f64>,
    /// Distance of the wheels of a pair.
    pub spacing: Option<f64>,
    /// Distance beyond the table at which rules of extrapolation are compared; `None`: the spacing of its last two
    /// stations.
    pub beyond: Option<f64>,
    /// The reading that is judged, and its tolerance relative to the largest coefficient.
    pub judged: Option<(TableReadingMethod, f64)>,
}

/// The exact values with which readings are compared.
#[derive(Clone, Debug)]
pub enum ExactValues {
    /// The exact surface of the grid file.
    Surface,
    /// The beam whose influence coefficients the table holds.
    Beam(BeamFit),
    /// Neither.
    None,
}

/// The findings of one table.
pub struct TableQuality {
    /// The table.
    pub item: TableItem,
    /// Digits that its entries were written with.
    pub digits: TablePrecision,
    /// Largest |T_ij - T_ji|; `None` for couplings and for unequal stations.
    pub asymmetry: Option<BlockExtreme>,
    /// Smallest and largest eigenvalue; `None` for couplings and for unequal stations.
    pub spectrum: Option<Spectrum>,
    /// Rigid supports.
    pub supports: Vec<f64>,
    /// The exact values that errors are measured against.
    pub exact_values: ExactValues,
    /// Scale of the errors of a coupling: the geometric mean of the largest entries of its two direct tables; `None`
    /// for a direct table, or where these are missing.
    pub scale: Option<f64>,
    /// The findings of each reading that accepts the table.
    pub readings: Vec<ReadingFindings>,
    /// For each end of the table, the row in which rules of extrapolation differ most.
    pub beyond: Vec<ExtrapolatedRow>,
    /// Risks of its stations.
    pub risks: Vec<ExtrapolationRisk>,
    /// Failed checks.
    pub verdicts: Vec<TableVerdict>,
    /// Force of one wheel, where it is known.
    pub load: Option<f64>,
}

/// A check that a table fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableVerdict {
    /// It is unsymmetric beyond the rounding of its entries.
    Asymmetric(BlockExtreme),
    /// An eigenvalue is negative beyond the rounding of its entries.
    Indefinite(Spectrum),
    /// The judged reading exceeds its tolerance: method, relative error, tolerance.
    Error(TableReadingMethod, f64, f64),
    /// The error of the judged reading is unknown.
    Unknown(TableReadingMethod),
}

impl TableQuality {
    /// The findings of table `index` of a file.
    ///
    /// # Errors
    /// A place of the table at which the exact surface cannot be evaluated.
    pub fn of(
        subject: &TableSource,
        index: usize,
        settings: &TableQualitySettings,
    ) -> Result<TableQuality, Error> {
        let item = &subject.items[index];
        let table = &item.table;
        let direct = item.is_direct();
        let beam = if direct { beam_of(0, table).ok() } else { None };
        let exact_values = match (&subject.surface, item.paths, &beam) {
            (Some(_), Some(_), _) => ExactValues::Surface,
            (_, _, Some(beam)) => ExactValues::Beam(beam.clone()),
            _ => ExactValues::None,
        };
        let supports = if direct {
            support_stations(table)
        } else {
            Vec::new()
        };
        let mut quality = TableQuality {
            item: item.clone(),
            digits: table_precision(table),
            asymmetry: station_asymmetry(table).filter(|_| direct),
            spectrum: station_spectrum(table).filter(|_| direct),
            scale: if direct { None } else { scale(subject, item) },
            readings: Vec::new(),
            beyond: Vec::new(),
            risks: ExtrapolationRisk::of(table, direct, item.linear, &breaks(subject, item)),
            verdicts: Vec::new(),
            load: settings.load,
            supports,
            exact_values,
        };
        for end in ends(table.x(), settings.beyond) {
            let worst = extrapolated_rows(table, end)?
                .into_iter()
                .max_by(|a, b| a.spread().total_cmp(&b.spread()));
            quality.beyond.extend(worst);
        }
        quality.readings = quality.read(subject, settings, beam.as_ref())?;
        quality.judge(settings);
        Ok(quality)
    }

    /// The findings of every reading that accepts the table.
    fn read(
        &self,
        subject: &TableSource,
        settings: &TableQualitySettings,
        beam: Option<&BeamFit>,
    ) -> Result<Vec<ReadingFindings>, Error> {
        let mut out = Vec::new();
        let Some(paths) = self.item.paths.filter(|_| !self.is_empty()) else {
            return Ok(out);
        };
        let Some(frame) = self.frame(subject, settings, paths) else {
            return Ok(out);
        };
        for method in TableReadingMethod::ALL {
            if method == TableReadingMethod::Exact {
                // the beam of the table counts as a reading where the exact surface is another one
                if let (Some(beam), ExactValues::Surface) = (beam, &self.exact_values) {
                    out.push(ReadingFindings::of(
                        method,
                        &coupling_block(&beam.surface, UP),
                        &frame,
                    )?);
                }
                continue;
            }
            let Some(reading) = reading(subject, &self.item, method) else {
                continue;
            };
            out.push(ReadingFindings::of(
                method,
                &coupling_block(reading.as_ref(), paths),
                &frame,
            )?);
        }
        Ok(out)
    }

    /// Whether all values are zero or, for a coupling, rounding relative to its direct tables.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.item.table.values().amax() <= UNCOUPLED * self.scale.unwrap_or(0.0)
    }

    /// A relative error. The scale of a direct table is its largest exact coefficient; that of a coupling is the
    /// geometric mean of the largest coefficients of its two direct tables.
    #[must_use]
    pub fn relative(&self, error: &ReadingError) -> f64 {
        match self.scale {
            Some(scale) if scale > 0.0 => error.largest.value.abs() / scale,
            _ => error.relative(),
        }
    }

    /// The exact block and the places of comparison; `None` where table and exact surface have no place in common.
    fn frame<'a>(
        &'a self,
        subject: &'a TableSource,
        settings: &TableQualitySettings,
        paths: [RailDirection; 2],
    ) -> Option<ReadingPlanes<'a>> {
        let table = &self.item.table;
        let own = |points: &[f64]| [points[0], points[points.len() - 1]];
        let common = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        let mut range = [own(table.x()), own(table.z())];
        if self.item.is_direct() {
            range = [common(range[0], range[1]); 2];
        }
        let exact = match &self.exact_values {
            ExactValues::Surface => subject
                .surface
                .as_ref()
                .map(|surface| coupling_block(surface, paths)),
            ExactValues::Beam(beam) => Some(coupling_block(&beam.surface, UP)),
            ExactValues::None => None,
        };
        if let Some([x, z]) = exact
            .as_ref()
            .and_then(splines::quality::CouplingBlock::range)
        {
            range = [common(range[0], x), common(range[1], z)];
        }
        let span = match self.supports.as_slice() {
            [first, .., last] => Some(common([*first, *last], range[0])),
            _ => None,
        };
        let frame = ReadingPlanes {
            exact,
            range,
            span: span.filter(|[a, b]| a < b),
            spacing: settings.spacing,
        };
        range.iter().all(|[a, b]| a < b).then_some(frame)
    }

    /// Adds the checks that fail.
    fn judge(&mut self, settings: &TableQualitySettings) {
        let slack = self.digits.slack;
        if let Some(worst) = self.asymmetry.filter(|worst| worst.value > slack) {
            self.verdicts.push(TableVerdict::Asymmetric(worst));
        }
        if let Some(spectrum) = self
            .spectrum
            .filter(|s| s.smallest < -slack - ROUNDING * s.largest)
        {
            self.verdicts.push(TableVerdict::Indefinite(spectrum));
        }
        let Some((method, tolerance)) = settings.judged else {
            return;
        };
        if self.item.paths.is_none() || self.is_empty() {
            return;
        }
        let error = self
            .readings
            .iter()
            .find(|reading| reading.method == method)
            .and_then(|found| found.error);
        match error.map(|error| self.relative(&error)) {
            Some(error) if error <= tolerance => {}
            Some(error) => self
                .verdicts
                .push(TableVerdict::Error(method, error, tolerance)),
            None => self.verdicts.push(TableVerdict::Unknown(method)),
        }
    }
}

/// Path of the beam whose coefficients a table holds: it has one rail and vertical deflections, whatever the
/// direction of the table.
pub(super) const UP: [RailDirection; 2] = [(0, Axis::Vertical); 2];
/// Fraction of the largest eigenvalue below which a negative one is rounding.
const ROUNDING: f64 = 1e-13;

/// Fraction of the coefficients of its direct tables below which a coupling is rounding.
const UNCOUPLED: f64 = 1e-9;

/// Geometric mean of the largest entries of the two direct tables of a coupling.
fn scale(subject: &TableSource, item: &TableItem) -> Option<f64> {
    let largest = |path: RailDirection| {
        let own = subject
            .items
            .iter()
            .filter(|item| item.paths == Some([path; 2]));
        own.map(|item| item.table.values().amax()).next()
    };
    let [deflection, load] = item.paths?;
    Some((largest(deflection)? * largest(load)?).sqrt())
}

/// A reading of the table: together with all other tables where the method accepts them, else alone.
pub(super) fn reading(
    subject: &TableSource,
    item: &TableItem,
    method: TableReadingMethod,
) -> Option<Box<dyn Compliance>> {
    let [deflection, load] = item.paths?;
    let own = InfluenceBlock {
        deflection,
        load,
        table: item.table.clone(),
    };
    let all = subject.blocks();
    let together = if all.contains(&own) {
        method.read(&all).ok()
    } else {
        None
    };
    together.or_else(|| method.read(&[own]).ok())
}

/// Ends of the elements of the loaded rail; empty where they are unknown.
fn breaks(subject: &TableSource, item: &TableItem) -> Vec<f64> {
    let surface = subject.surface.as_ref().zip(item.paths);
    surface
        .map(|(surface, [_, load])| surface.breaks(load.0))
        .unwrap_or_default()
}

/// Places beyond both ends, at the given `distance` or at the spacing of the outermost two stations.
fn ends(x: &[f64], distance: Option<f64>) -> [f64; 2] {
    let n = x.len();
    [
        x[0] - distance.unwrap_or(x[1] - x[0]),
        x[n - 1] + distance.unwrap_or(x[n - 1] - x[n - 2]),
    ]
}
