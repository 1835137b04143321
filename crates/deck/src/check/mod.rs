//! The deck, executed by our own interpreter of the ADAMS language, against the simulator.
//!
//! 1. Random states of the scene are drawn, with the contact forces of the simulator at each (`states`).
//! 2. The forces that the deck should find there are written down ([`compare::expected_forces`]), on foundations that
//!    interpolate the deck's own tables: the comparison is of equations, not of interpolations.
//! 3. The deck is executed at each state, its differential equations replaced by one backward Euler step (`step`), and
//!    the six components of every GFORCE are compared. The same is done with all rails on a moving part, which must not
//!    change them, and with finite rotations, which is reported and not judged.
//! 4. Where no body is free along its rail, static equilibria of both are compared along the prescribed motion (`path`).

pub mod compare;
mod path;
mod poses;
mod random;
mod report;
mod states;
mod step;

use adams::{AdamsModel, DataSet};

pub use compare::{COMPONENTS, CheckDifference, ExpectedForces};
pub use path::SweepDifference;

use self::poses::{CarrierPose, Turns, state};
use sim::ContactForces;

use self::random::Random;
use self::states::CheckCase;
use super::DeckPlan;
use crate::Error;

/// Largest difference of forces that passes, relative to the largest force.
pub const FORCES: f64 = 1e-12;
/// The same with the rails on a moving part, where coordinates of hundreds of lengths have other rounding errors.
pub const CARRIED: f64 = 1e-9;
/// Most states of the comparisons on a moving part and with finite rotations.
const SAMPLE: usize = 1000;

/// Numbers of random states by what acts in them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StateCounts {
    /// All states.
    pub all: usize,
    /// States in which every wheel has a vertical force.
    pub loaded: usize,
    /// States in which no wheel has one.
    pub off: usize,
    /// States in which a flange touches.
    pub flange: usize,
    /// States in which a wheel slides.
    pub slide: usize,
}

impl StateCounts {
    fn of(cases: &[CheckCase]) -> StateCounts {
        let count =
            |is: &dyn Fn(&ContactForces) -> bool| cases.iter().filter(|case| is(&case.forces)).count();
        StateCounts {
            all: cases.len(),
            loaded: count(&|forces| forces.vertical.iter().all(|force| *force > 0.0)),
            off: count(&|forces| forces.vertical.iter().all(|force| *force == 0.0)),
            flange: count(&|forces| forces.lateral.iter().any(|force| *force != 0.0)),
            slide: count(&|forces| forces.traction.iter().any(|force| *force != 0.0)),
        }
    }
}

/// The result of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckReport {
    /// Numbers of the random states.
    pub states: StateCounts,
    /// Differences of forces at random states.
    pub forces: Vec<CheckDifference>,
    /// The quasi-static path; `None` where a body is free along its rail.
    pub path: Option<SweepDifference>,
}

impl CheckReport {
    /// Whether every difference that is judged is within its limit.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.forces.iter().all(CheckDifference::holds)
            && self.path.as_ref().is_none_or(SweepDifference::holds)
    }
}

/// Executes the data set `text` at `count` random states, as it is and with its rails on a moving part, and along its
/// quasi-static path, and compares it with the simulator on the same tables and interpolation.
///
/// # Errors
/// [`Error::Language`] for a text that cannot be executed; [`Error::States`] for a scene in which too few states were found.
pub fn check(plan: &DeckPlan<'_>, text: &str, count: usize) -> Result<CheckReport, Error> {
    let set = DataSet::read(text)?;
    let model = AdamsModel::new(&set)?;
    let mut stepped = set.clone();
    step::discretise(plan, &mut stepped);
    let foundations = plan.foundations()?;
    let cases = states::states(plan, &foundations, count)?;
    let wanted: Vec<ExpectedForces> = cases
        .iter()
        .map(|case| compare::expected_forces(plan, &foundations, case))
        .collect::<Result<_, _>>()?;
    let sample = count.min(SAMPLE);
    let mut forces = Vec::new();
    let small = cases.iter().map(|case| state(plan, case, Turns::Small, None));
    let what = ("forces at random states", Some(FORCES));
    forces.push(compare::compare(plan, &stepped, what, &wanted, small)?);

    let mut carried = stepped.clone();
    let part = poses::mount_rails(&mut carried);
    let mut random = Random::new(2);
    let carriers: Vec<CarrierPose> = (0..sample).map(|_| poses::random_carrier(part, &mut random)).collect();
    let moving = cases.iter().zip(&carriers).map(|(case, by)| state(plan, case, Turns::Small, Some(*by)));
    let what = ("the same, rails on a moving part", Some(CARRIED));
    forces.push(compare::compare(plan, &carried, what, &wanted[..sample], moving)?);

    let finite = cases[..sample].iter().map(|case| state(plan, case, Turns::Finite, None));
    let what = ("the same, finite rotations", None);
    forces.push(compare::compare(plan, &stepped, what, &wanted[..sample], finite)?);
    let path = path::path(plan, &model, &foundations)?;
    Ok(CheckReport { states: StateCounts::of(&cases), forces, path })
}
