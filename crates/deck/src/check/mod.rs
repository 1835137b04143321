//! Comparison of the deck, executed by our own interpreter of the ADAMS language, with the simulator.
//!
//! 1. The static equilibria of the simulator along the prescribed motion are computed ([`path::sweep`]), and random
//!    states of the scene are drawn, with the contact forces of the simulator at each (`states`), on foundations that
//!    interpolate the tables of the deck, so that equations are compared and not interpolations.
//! 2. The values of the simulator are put into the expressions of the deck, each of which must give the value of the
//!    simulator ([`compare`]). This is repeated with all rails on a moving part, which must not change the forces.
//! 3. The equilibria of the simulator must be those of the deck's static equations ([`path`]), with its small rotations; what
//!    finite ones change is computed too.

pub mod compare;
pub mod path;
mod poses;
mod random;
mod report;
mod states;

use adams::{AdamsModel, DataSet};

pub use compare::{CheckDifference, QUANTITIES, WrongStatement};
pub use path::{EquilibriumDifference, SweepDifference};

use self::compare::expected_values;
use self::poses::{CARRIER, state};
use sim::ContactForces;

use self::random::Random;
use self::states::CheckCase;
use super::{DeckForm, DeckPlan};
use crate::Error;

/// Limit of the differences, relative to the largest value.
pub const FORCE_LIMIT: f64 = 1e-12;
/// Limit of the differences with the rails on a moving part, where large coordinates cause larger rounding
/// errors.
pub const CARRIED_FORCE_LIMIT: f64 = 1e-9;
/// Largest number of states in the comparison on a moving part.
const SAMPLE: usize = 1000;

/// Least number of random states where none is given.
const LEAST: f64 = 200.0;

/// Number of random states that are checked where none is given: 10000 with up to three wheels, and fewer with more, down
/// to 200, because the work for each grows with the square of the wheels.
#[must_use]
pub fn default_states(plan: &DeckPlan<'_>) -> usize {
    let crowd = (3.0 / plan.wheels.len().max(1) as f64).min(1.0);
    (10_000.0 * crowd * crowd).round().max(LEAST) as usize
}

/// Numbers of random states, by the forces that act in them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StateCounts {
    /// All states.
    pub all: usize,
    /// States in which every wheel has a vertical force.
    pub loaded: usize,
    /// States in which no wheel has one.
    pub off: usize,
    /// States in which the wheel that is loaded least often has a vertical force.
    pub each: usize,
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
            each: states::loaded(cases).into_iter().min().unwrap_or(0),
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
    /// Differences of values at random states and at equilibria.
    pub forces: Vec<CheckDifference>,
    /// Differences along the quasi-static path; `None` if a body is free along its rail.
    pub path: Option<SweepDifference>,
    /// Largest force along a rail at the equilibria that the form of the deck leaves out, F du/dx, relative to the largest
    /// vertical force. The simulator leaves it out of the comparison too.
    pub missing_along: f64,
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
    AdamsModel::new(&set)?;
    let foundations = plan.foundations()?;
    let in_statics = plan.foundations_in_statics()?;
    let sweep = path::sweep(plan, &in_statics)?;
    let equilibria = sweep.as_ref().map_or(&[][..], |sweep| &sweep.cases);
    let missing_along = if plan.form == DeckForm::Factored {
        0.0
    } else {
        compare::largest_along(plan, &foundations, equilibria)?
    };
    let cases = states::states(plan, &foundations, equilibria, count)?;
    let still = cases.iter().chain(equilibria).map(|case| {
        let expected = expected_values(plan, &foundations, case, 0.0)?;
        Ok((state(plan, case, None), expected))
    });
    let what = ("forces at random states and at rest", FORCE_LIMIT);
    let mut forces = vec![compare::compare(plan, &set, what, still)?];

    let mut carried = set.clone();
    let part = poses::mount_rails(&mut carried);
    let mut random = Random::new(2);
    let moving = cases[..cases.len().min(SAMPLE)].iter().map(|case| {
        let by = poses::random_carrier(part, &mut random);
        let expected = expected_values(plan, &foundations, case, CARRIER + reach(case))?;
        Ok((state(plan, case, Some(by)), expected))
    });
    let what = ("the same, rails on a moving part", CARRIED_FORCE_LIMIT);
    forces.push(compare::compare(plan, &carried, what, moving)?);
    let path = match &sweep {
        Some(sweep) => Some(path::path(plan, &set, &in_statics, sweep)?),
        None => None,
    };
    Ok(CheckReport {
        states: StateCounts::of(&cases),
        forces,
        path,
        missing_along,
    })
}

/// Largest coordinate along the rails.
fn reach(case: &CheckCase) -> f64 {
    let places = case.instant.displacement.iter().map(|own| own[0].abs());
    places.fold(0.0, f64::max)
}
