//! The deck executed against the simulator.

pub mod compare;
pub mod mount;
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

/// Largest difference of forces, of the largest force.
pub const FORCES: f64 = 1e-12;
/// The same with the rails on a moving part: coordinates of hundreds of lengths round differently there.
pub const CARRIED: f64 = 1e-9;
/// States of the comparisons that are no more than a sample.
const SAMPLE: usize = 1000;

/// What the random states are like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// All of them.
    pub all: usize,
    /// With every wheel pressing.
    pub pressing: usize,
    /// With no wheel pressing.
    pub off: usize,
    /// With a flange that touches.
    pub flange: usize,
    /// With friction.
    pub slide: usize,
}

impl Count {
    fn of(cases: &[CheckCase]) -> Count {
        let count =
            |is: &dyn Fn(&ContactForces) -> bool| cases.iter().filter(|case| is(&case.forces)).count();
        Count {
            all: cases.len(),
            pressing: count(&|forces| forces.vertical.iter().all(|force| *force > 0.0)),
            off: count(&|forces| forces.vertical.iter().all(|force| *force == 0.0)),
            flange: count(&|forces| forces.lateral.iter().any(|force| *force != 0.0)),
            slide: count(&|forces| forces.traction.iter().any(|force| *force != 0.0)),
        }
    }
}

/// What a check found.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckReport {
    /// The random states.
    pub states: Count,
    /// Forces at random states.
    pub forces: Vec<CheckDifference>,
    /// The quasi-static path; `None` where a body is free along its rail.
    pub path: Option<SweepDifference>,
}

impl CheckReport {
    /// Whether everything that is judged is as asked.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.forces.iter().all(CheckDifference::holds)
            && self.path.as_ref().is_none_or(SweepDifference::holds)
    }
}

/// Executes the data set `text` at `count` random states, as it stands and with its rails on a moving part, and along
/// its quasi-static path, and compares it with the simulator on the same tables, read the same way.
///
/// # Errors
/// A text that cannot be executed; a scene without states to compare.
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
    let part = mount::mount(&mut carried);
    let mut random = Random::new(2);
    let carriers: Vec<CarrierPose> = (0..sample).map(|_| mount::carrier(part, &mut random)).collect();
    let moving = cases.iter().zip(&carriers).map(|(case, by)| state(plan, case, Turns::Small, Some(*by)));
    let what = ("the same, rails on a moving part", Some(CARRIED));
    forces.push(compare::compare(plan, &carried, what, &wanted[..sample], moving)?);

    let finite = cases[..sample].iter().map(|case| state(plan, case, Turns::Finite, None));
    let what = ("the same, finite rotations", None);
    forces.push(compare::compare(plan, &stepped, what, &wanted[..sample], finite)?);
    let path = path::path(plan, &model, &foundations)?;
    Ok(CheckReport { states: Count::of(&cases), forces, path })
}
