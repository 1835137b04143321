//! Comparison of the deck, executed by our own interpreter of the ADAMS language, with the simulator.
//!
//! 1. Random states of the scene are drawn, with the contact forces of the simulator at each (`states`).
//! 2. The expected forces of the deck at these states are computed ([`compare::expected_forces`]) on foundations that
//!    interpolate the tables of the deck, so that equations are compared and not interpolations.
//! 3. The deck is executed at each state, with its differential equations replaced by one backward Euler step
//!    (`step`), and the six components of every GFORCE are compared. This is repeated with all rails on a moving
//!    part, which must not change the forces, and with finite rotations, whose differences are reported without a
//!    limit.
//! 4. If no body is free along its rail, static equilibria of both are compared along the prescribed motion (`path`).

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

/// Limit of the difference of forces, relative to the largest force.
pub const FORCE_LIMIT: f64 = 1e-12;
/// Limit of the difference of forces with the rails on a moving part, where large coordinates cause larger rounding
/// errors.
pub const CARRIED_FORCE_LIMIT: f64 = 1e-9;
/// Largest number of states in the comparisons on a moving part and with finite rotations.
const SAMPLE: usize = 1000;

/// Numbers of random states, by the forces that act in them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StateCounts {
    /// All states.
    pub all: usize,
    /// States in which every wheel has a vertical force.
    pub loaded: usize,
    /// States in which no wheel has one.
    pub off: usize,
    /// States in which the flange force of a wheel is not zero.
    pub flange: usize,
    /// States in which the friction force of a wheel is not zero.
    pub slide: usize,
}

impl StateCounts {
    fn of(cases: &[CheckCase]) -> StateCounts {
        let count = |is: &dyn Fn(&ContactForces) -> bool| {
            cases.iter().filter(|case| is(&case.forces)).count()
        };
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
    /// Differences along the quasi-static path; `None` if a body is free along its rail.
    pub path: Option<SweepDifference>,
}

impl CheckReport {
    /// Whether every difference that has a limit is within it.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.forces.iter().all(CheckDifference::holds)
            && self.path.as_ref().is_none_or(SweepDifference::holds)
    }
}

/// Executes the data set `text` at `count` random states, unchanged and with its rails on a moving part, and along
/// its quasi-static path, and compares it with the simulator on the same tables and interpolation.
///
/// # Errors
/// [`Error::Language`] for a text that cannot be executed; [`Error::States`] for a scene in which too few states were
/// found.
pub fn check(plan: &DeckPlan<'_>, text: &str, count: usize) -> Result<CheckReport, Error> {
    let set = DataSet::read(text)?;
    let model = AdamsModel::new(&set)?;
    let mut stepped = set.clone();
    step::discretise(plan, &mut stepped);
    let foundations = plan.foundations()?;
    let cases = states::states(plan, &foundations, count)?;
    let expected: Vec<ExpectedForces> = cases
        .iter()
        .map(|case| compare::expected_forces(plan, &foundations, case))
        .collect::<Result<_, _>>()?;
    let sample = count.min(SAMPLE);
    let mut forces = Vec::new();
    let small = cases
        .iter()
        .map(|case| state(plan, case, Turns::Small, None));
    let what = ("forces at random states", Some(FORCE_LIMIT));
    forces.push(compare::compare(plan, &stepped, what, &expected, small)?);

    let mut carried = stepped.clone();
    let part = poses::mount_rails(&mut carried);
    let mut random = Random::new(2);
    let carriers: Vec<CarrierPose> = (0..sample)
        .map(|_| poses::random_carrier(part, &mut random))
        .collect();
    let moving = cases
        .iter()
        .zip(&carriers)
        .map(|(case, by)| state(plan, case, Turns::Small, Some(*by)));
    let what = (
        "the same, rails on a moving part",
        Some(CARRIED_FORCE_LIMIT),
    );
    forces.push(compare::compare(
        plan,
        &carried,
        what,
        &expected[..sample],
        moving,
    )?);

    let finite = cases[..sample]
        .iter()
        .map(|case| state(plan, case, Turns::Finite, None));
    let what = ("the same, finite rotations", None);
    forces.push(compare::compare(
        plan,
        &stepped,
        what,
        &expected[..sample],
        finite,
    )?);
    let path = path::path(plan, &model, &foundations)?;
    Ok(CheckReport {
        states: StateCounts::of(&cases),
        forces,
        path,
    })
}
