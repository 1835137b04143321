//! Deviation of a run from its reference, by groups of columns.

use formats::scene::Scene;
use sim::Measure;

use crate::measure::quantity::ErrorGroup;

/// Columns of a run with their groups, at its output times.
#[derive(Clone, Debug, Default)]
pub struct ComparedColumns {
    /// Output times.
    pub time: Vec<f64>,
    /// Name, group and values of each column.
    pub columns: Vec<(String, ErrorGroup, Vec<f64>)>,
}

/// Moments below this fraction of the largest force times the longest rail are rounding.
const NEGLIGIBLE: f64 = 1e-6;

impl ComparedColumns {
    /// Removes moments that are rounding: those below [`NEGLIGIBLE`] times the largest wheel force and the `length`
    /// of the longest rail.
    pub(crate) fn prune(&mut self, length: f64) {
        let largest = |values: &[f64]| {
            values
                .iter()
                .fold(0.0_f64, |most, value| most.max(value.abs()))
        };
        let forces = self
            .columns
            .iter()
            .filter(|(_, group, _)| *group == ErrorGroup::WheelForce);
        let force = forces
            .map(|(.., values)| largest(values))
            .fold(0.0, f64::max);
        let least = NEGLIGIBLE * force * length;
        self.columns
            .retain(|(_, group, values)| *group != ErrorGroup::Moment || largest(values) > least);
    }

    /// Removes all output times after `time`, s.
    pub(crate) fn cut(&mut self, time: f64) {
        let count = self.time.iter().take_while(|own| **own <= time).count();
        self.time.truncate(count);
        self.columns
            .iter_mut()
            .for_each(|(.., values)| values.truncate(count));
    }
}

/// Errors of the columns of one group, relative to the largest value of the reference in this group.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Largest difference at an output time.
    pub largest: f64,
    /// Largest difference of the maxima or of the minima of a column.
    pub peak: f64,
}

impl Deviation {
    /// The error by a measure: of extremes over the run, or of values at equal times.
    #[must_use]
    pub fn by(&self, measure: Measure) -> f64 {
        match measure {
            Measure::Extremes => self.peak,
            Measure::History => self.largest,
        }
    }
}

/// The measure of a study of `scene`: values at equal times where a structure asks for them, and otherwise extremes.
#[must_use]
pub fn study_measure(scene: &Scene) -> Measure {
    let is_history = scene
        .structures
        .iter()
        .any(|structure| structure.measure == Measure::History);
    if is_history {
        Measure::History
    } else {
        Measure::Extremes
    }
}

/// Errors of `run` against `reference` in each group, in the order of [`ErrorGroup::ALL`]; `None` where the reference
/// has nothing but zeros in a group, or a column of the group is missing in `run`.
///
/// e = max |a - b| / max |b| over the columns of a group and the output times that both runs have. The extremes of a
/// column are compared whatever their times.
#[must_use]
pub fn deviations(
    run: &ComparedColumns,
    reference: &ComparedColumns,
) -> [Option<Deviation>; ErrorGroup::COUNT] {
    let common = common(run, reference);
    ErrorGroup::ALL.map(|group| of(run, reference, group, common))
}

/// Number of output times that both runs have in common, from the first on.
fn common(run: &ComparedColumns, reference: &ComparedColumns) -> usize {
    let pairs = run.time.iter().zip(&reference.time);
    pairs
        .take_while(|(a, b)| (*a - *b).abs() <= 1e-9 * b.abs().max(1e-9))
        .count()
}

/// The last output time until which the largest error of `run` in each of `groups` is at most `wanted`, as
/// [`deviations`] computes it for runs that end there; `None` where there is no such time, or a column is missing in
/// `run`.
#[must_use]
pub fn horizon(
    run: &ComparedColumns,
    reference: &ComparedColumns,
    groups: &[ErrorGroup],
    wanted: f64,
) -> Option<f64> {
    let mut pairs = Vec::new();
    for (name, group, values) in &reference.columns {
        if let Some(at) = groups.iter().position(|own| own == group) {
            let (_, _, found) = run.columns.iter().find(|(own, ..)| own == name)?;
            pairs.push((at, found, values));
        }
    }
    let mut worst = vec![[0.0_f64; 2]; groups.len()];
    let mut last = None;
    for (k, time) in reference
        .time
        .iter()
        .enumerate()
        .take(common(run, reference))
    {
        for (at, found, values) in &pairs {
            let [error, scale] = &mut worst[*at];
            *error = error.max((found[k] - values[k]).abs());
            *scale = scale.max(values[k].abs());
        }
        if worst.iter().all(|[error, scale]| *error <= wanted * scale) {
            last = Some(*time);
        }
    }
    last
}

/// The deviation in one group over the first `common` output times.
fn of(
    run: &ComparedColumns,
    reference: &ComparedColumns,
    of_group: ErrorGroup,
    common: usize,
) -> Option<Deviation> {
    let mut scale = 0.0_f64;
    let mut worst = Deviation::default();
    for (name, _, wanted) in reference
        .columns
        .iter()
        .filter(|(_, group, _)| *group == of_group)
    {
        let (_, _, found) = run.columns.iter().find(|(own, ..)| own == name)?;
        scale = wanted
            .iter()
            .fold(scale, |most, value| most.max(value.abs()));
        for (a, b) in found.iter().zip(wanted).take(common) {
            worst.largest = worst.largest.max((a - b).abs());
        }
        for sign in [1.0, -1.0] {
            let most = |values: &[f64]| {
                values
                    .iter()
                    .fold(f64::MIN, |most, value| most.max(sign * value))
            };
            worst.peak = worst.peak.max((most(found) - most(wanted)).abs());
        }
    }
    let relative = |value: f64| value / scale;
    let is_known = common > 0 && scale > 0.0 && worst.largest.is_finite() && worst.peak.is_finite();
    is_known.then(|| Deviation {
        largest: relative(worst.largest),
        peak: relative(worst.peak),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(deflection: &[f64], force: &[f64]) -> ComparedColumns {
        ComparedColumns {
            time: (0..deflection.len()).map(|i| 0.1 * i as f64).collect(),
            columns: vec![
                (
                    "body.deflection".into(),
                    ErrorGroup::Deflection,
                    deflection.to_vec(),
                ),
                (
                    "wheel.vertical".into(),
                    ErrorGroup::WheelForce,
                    force.to_vec(),
                ),
            ],
        }
    }

    #[test]
    fn errors_are_relative_to_the_largest_value_of_the_group() {
        let reference = trace(&[0.0, 2.0, -4.0], &[10.0, 10.0, 10.0]);
        let run = trace(&[0.1, 2.0, -4.2], &[10.0, 9.0, 10.0]);
        let [deflection, force, lateral, reaction, _] = deviations(&run, &reference);
        let deflection = deflection.expect("a scale of 4");
        assert!(
            (deflection.largest - 0.05).abs() < 1e-15 && (deflection.peak - 0.05).abs() < 1e-15
        );
        assert_eq!(
            force,
            Some(Deviation {
                largest: 0.1,
                peak: 0.1
            })
        );
        assert_eq!([lateral, reaction], [None, None]);
    }

    #[test]
    fn horizon_is_the_last_time_until_which_runs_are_close() {
        let reference = trace(&[0.0, 2.0, -4.0, 3.0], &[10.0, 10.0, 10.0, 10.0]);
        let run = trace(&[0.0, 2.0, -4.1, 3.0], &[10.0, 10.0, 10.0, 9.0]);
        let asked = [ErrorGroup::Deflection, ErrorGroup::WheelForce];
        let until = |wanted: f64| horizon(&run, &reference, &asked, wanted);
        assert_eq!(
            until(0.2),
            Some(reference.time[3]),
            "0.1 of the forces are within"
        );
        assert_eq!(
            until(0.05),
            Some(reference.time[2]),
            "a fortieth of the deflection is"
        );
        assert_eq!(until(0.01), Some(reference.time[1]));
        assert_eq!(
            horizon(&run, &reference, &asked[..1], 0.05),
            Some(reference.time[3])
        );
        let mut cut = reference.clone();
        cut.cut(reference.time[2]);
        assert_eq!((cut.time.len(), cut.columns[1].2.len()), (3, 3));
        assert_eq!(deviations(&run, &cut)[1].map(|own| own.largest), Some(0.0));
    }

    #[test]
    fn a_run_cut_short_is_compared_as_far_as_it_goes() {
        let reference = trace(&[1.0, 2.0, 1.0], &[0.0, 0.0, 0.0]);
        let mut run = trace(&[1.0, 2.0], &[0.0, 0.0]);
        let [deflection, force, ..] = deviations(&run, &reference);
        assert_eq!(deflection.map(|own| own.largest), Some(0.0));
        assert_eq!(force, None, "zeros have no scale");
        run.columns.remove(0);
        assert_eq!(
            deviations(&run, &reference)[0],
            None,
            "a column that is missing is no agreement"
        );
    }
}
