//! A structure whose fidelity is to be chosen, with the estimates for its numbers of modes.

use crate::select::replay::{ModalBasis, TailError};

/// Fraction of the tolerance that an estimated error may reach.
pub(super) const SAFE: f64 = 0.8;
/// Estimate for the largest number of modes, relative to the tolerance, above which no number is expected to suffice.
const UNREACHABLE: f64 = 10.0;
/// Ratio of the estimates for two numbers of modes up to which the larger number is no better, where neither suffices.
pub(super) const NO_BETTER: f64 = 1.5;
/// Estimate for the number of modes of a repetition, relative to that of the run itself, and the largest ratio with
/// which the error of the repetition is extrapolated.
const START_RATIO: [f64; 2] = [0.3, 0.5];
/// Least number of modes of a repetition, relative to that of the run, where it is not the second one of [`START_MODES`]:
/// a few more do not tell how forces change that depend on all of them.
const START_TIMES: usize = 2;
/// Number of modes, relative to that of the run, and the least number, from which a further reduction of the estimate is not
/// waited for.
const START_MODES: (usize, usize) = (3, 24);

/// A structure whose fidelity is to be chosen.
pub(super) struct Open {
    pub structure: usize,
    pub tolerance: f64,
    /// Estimates for which a number of modes is chosen first, and when it is raised.
    pub aims: [f64; 2],
    pub basis: ModalBasis,
    /// Estimates from the wheel forces of the last run, the number of this run, and the number of modes.
    pub tails: Vec<TailError>,
    pub tails_of: Option<(usize, usize)>,
    /// Index of its choice.
    pub choice: usize,
}

impl Open {
    /// Number of modes that are known.
    pub fn known(&self) -> usize {
        self.basis.structure.dynamics.dofs()
    }

    /// Smallest number of modes, at least `least`, whose estimate is at most `limit`; all modes if there is none and they
    /// are the whole structure.
    pub fn sufficient_count(&self, limit: f64, least: usize) -> Option<usize> {
        self.count_with(least, |tail| tail.error <= limit)
    }

    /// The same, from one mode on and by the estimate in phase, for a run that only checks influence functions; where there is
    /// none, the smallest number that is no worse.
    pub fn checking_count(&self, limit: f64) -> Option<usize> {
        self.count_with(1, |tail| tail.in_phase <= limit)
            .or_else(|| self.no_worse_count(1))
    }

    fn count_with(&self, least: usize, suffices: impl Fn(&TailError) -> bool) -> Option<usize> {
        let found = self
            .tails
            .iter()
            .find(|tail| tail.kept >= least && suffices(tail));
        let whole = Some(self.known()).filter(|_| self.basis.is_whole);
        found.map(|tail| tail.kept).or(whole)
    }

    /// That of [`Open::sufficient_count`]; where there is none, `spare` times the smallest number whose estimate, times
    /// `factor`, is within the tolerance with the margin [`SAFE`], and otherwise the largest one that has an estimate. Where
    /// even its estimate is far beyond the tolerance ([`UNREACHABLE`]), or a whole range, it is the smallest number that is no
    /// worse.
    pub fn count_for(&self, limit: f64, factor: f64, least: usize, spare: usize) -> Option<usize> {
        let within = || {
            let count = self.sufficient_count(SAFE / factor * self.tolerance, least)?;
            let more = self
                .tails
                .iter()
                .map(|tail| tail.kept)
                .find(|kept| *kept >= spare * count);
            Some(more.unwrap_or(count))
        };
        let most = || {
            let last = self.tails.last().filter(|last| last.kept >= least)?;
            if is_unreachable(last.error, self.tolerance) {
                self.no_worse_count(least)
            } else {
                Some(last.kept)
            }
        };
        self.sufficient_count(limit, least)
            .or_else(within)
            .or_else(most)
    }

    /// Smallest number of modes, at least `least`, whose estimate is that for the largest number or less, but for the factor
    /// [`NO_BETTER`].
    pub fn no_worse_count(&self, least: usize) -> Option<usize> {
        self.sufficient_count(NO_BETTER * self.tails.last()?.error, least)
    }

    /// Number of modes with which the start of a run with `count` modes is repeated, and the ratio of the estimates for the
    /// two numbers; `None` where no more modes are known.
    pub fn beyond(&self, count: usize) -> Option<(usize, f64)> {
        let known = self.known();
        let own = self.tail(count).error;
        if count == 0 || known <= count || own == 0.0 {
            return None;
        }
        let most = self.tails.last().map_or(known, |last| last.kept);
        let many = START_MODES.1.max(START_MODES.0 * count).min(most);
        let suffices = |tail: &&TailError| tail.error <= START_RATIO[0] * own || tail.kept >= many;
        let least = (START_TIMES * count).min(START_MODES.1).max(count + 1);
        let found = self
            .tails
            .iter()
            .filter(|tail| tail.kept >= least)
            .find(suffices);
        let (more, error) = found.map_or((known, self.tail(known).error), |tail| {
            (tail.kept, tail.error)
        });
        Some((more, (error / own).min(START_RATIO[1])))
    }

    /// The number of modes of a repetition of a run with `count` modes that a run may keep.
    pub fn kept_beyond(&self, count: usize) -> usize {
        let most = self.tails.last().map_or(count, |last| last.kept);
        self.beyond(count)
            .map_or(count, |(more, _)| more.min(most))
            .max(count)
    }

    /// Number of known modes with frequencies below `omega`.
    pub fn modes_below(&self, omega: f64) -> usize {
        self.basis
            .structure
            .dynamics
            .frequencies()
            .iter()
            .filter(|own| **own < omega)
            .count()
    }

    /// The estimate for `kept` modes; for all known ones it is that of the largest number that has one.
    pub fn tail(&self, kept: usize) -> TailError {
        let found = self.tails.iter().find(|tail| tail.kept == kept).cloned();
        let beyond = || self.tails.last().filter(|_| !self.basis.is_whole).cloned();
        found.or_else(beyond).unwrap_or(TailError::none(kept))
    }
}

/// Whether an error is so far beyond a tolerance, or a whole range, that more modes are not expected to bring it within.
pub(super) fn is_unreachable(error: f64, tolerance: f64) -> bool {
    error > (UNREACHABLE * tolerance).min(1.0)
}

/// Largest one of the errors `of` the structures with these numbers of modes.
pub(super) fn largest(open: &[Open], counts: &[usize], of: impl Fn(&TailError) -> f64) -> f64 {
    open.iter()
        .zip(counts)
        .map(|(own, count)| of(&own.tail(*count)))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use splines::{Error, Probe};

    use super::*;
    use crate::{Dynamics, Shapes, Structure};

    /// Modes that no wheel asks for their shapes.
    struct Unseen;

    impl Shapes for Unseen {
        fn row(&self, _: Probe, _: &mut [f64], _: &mut [f64]) -> Result<(), Error> {
            Ok(())
        }
    }

    /// By the rule: a run that only checks influence functions has the fewest modes whose estimate in phase is small enough, and
    /// where none is, the fewest that are as good as the most, by their errors.
    #[test]
    fn a_checking_run_counts_modes_by_phase() {
        let dynamics = Dynamics::Modes {
            omega: vec![1.0; 24],
            ratio: vec![0.0; 24],
        };
        let structure = Structure {
            dynamics,
            shapes: Box::new(Unseen),
        };
        let tail = |(kept, error, in_phase)| TailError {
            error,
            in_phase,
            ..TailError::none(kept)
        };
        let open = Open {
            structure: 0,
            tolerance: 1.0,
            aims: [0.2, 0.4],
            basis: ModalBasis {
                structure,
                coupling: Vec::new(),
                effects: Vec::new(),
                is_whole: false,
            },
            tails: [
                (0, 1.0, 0.1),
                (1, 0.9, 0.5),
                (4, 0.6, 0.2),
                (8, 0.3, 0.15),
                (16, 0.25, 0.1),
            ]
            .map(tail)
            .to_vec(),
            tails_of: None,
            choice: 0,
        };
        assert_eq!(open.checking_count(0.5), Some(1));
        assert_eq!(open.checking_count(0.2), Some(4));
        assert_eq!(open.checking_count(0.1), Some(16));
        assert_eq!(
            open.checking_count(0.01),
            Some(8),
            "0.3 is not 1.5 times 0.25"
        );
        assert_eq!(open.sufficient_count(0.5, 1), Some(8));
    }
}
