//! Which foundation a scene needs: the lowest rung whose error, predicted or measured against a higher one, is allowed.

mod climb;
mod distance;
mod joint;
mod predict;

use std::ops::ControlFlow;

use crate::{Analysis, Error, Foundation, Run, Scene, Structure, run};
use climb::{Candidate, Climb, Outcome};

pub use distance::distance;
pub use predict::Predicted;

/// Numbers of modes that are tried, and check what lies below them.
const MODES: [usize; 6] = [2, 4, 6, 8, 12, 16];
/// Modes that are looked at where no more are needed to tell rigid, influence and two modes.
const FEW: usize = 3;
/// Accuracy asked of the compared runs, by the tolerance: where a load strikes hard wheels, runs err by up to
/// thirty times what they are asked.
pub const STEPPING: f64 = 0.03;
/// Share of the tolerance that an estimate may reach: the higher rung errs too.
const SAFE: f64 = 0.8;

/// How much of a structure is modelled, from the cheapest to the dearest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// It does not give.
    Rigid,
    /// It gives without mass.
    Influence,
    /// This many modes, and the static give of the others.
    Modal(usize),
    /// All modes of a mesh with half as many elements a member as the one at the top, which it checks.
    Half,
    /// All modes of a mesh.
    Full,
}

/// What builds foundations on demand.
pub trait Ladder {
    /// What can go wrong.
    type Error: From<Error>;

    /// About the lowest `count` modes that vertical forces on the rails of `structure` excite, from the lowest, where it has
    /// so many: frequencies to a few parts in a hundred will do. `None`: its mass is not known.
    ///
    /// # Errors
    /// A structure whose modes cannot be found.
    fn modes(&mut self, structure: usize, count: usize) -> Result<Option<Structure>, Self::Error>;

    /// `structure` at `rung`; a structure whose foundation is given ignores `rung`.
    ///
    /// # Errors
    /// A rung that cannot be built.
    fn foundation(&mut self, structure: usize, rung: Rung) -> Result<Foundation, Self::Error>;

    /// Runs the scene: [`run()`], unless it is to be integrated in another way.
    ///
    /// # Errors
    /// A scene that cannot be set up.
    fn run(
        &mut self,
        scene: &Scene,
        foundations: &[Foundation],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, Error> {
        run(scene, foundations, watch)
    }
}

/// Why a rung was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// No mass is known: the error of leaving it out is not known either.
    NoMass,
    /// A sequence of equilibria has no inertia.
    QuasiStatic,
    /// What it leaves out is predicted to be far below the tolerance: no higher rung was run.
    Predicted,
    /// The estimate is within 0.8 of the tolerance.
    Sufficient,
    /// Nothing lower was sufficient. The estimate is that of the mesh with half as many elements: above the tolerance,
    /// or, where that mesh could not be run, none.
    Top,
    /// No higher rung could be built or run to check it: its error is not known, or exceeds the tolerance.
    Unchecked,
}

/// A rung that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tried {
    /// Which.
    pub rung: Rung,
    /// Its error against `against`, see [`distance`]; infinite where the two runs cannot be compared.
    pub estimate: f64,
    /// What it was checked against.
    pub against: Rung,
    /// Stages that its run took.
    pub stages: u64,
}

/// The foundation of one structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Which structure.
    pub structure: usize,
    /// Its rung.
    pub rung: Rung,
    /// Why.
    pub reason: Reason,
    /// Its error, where that is known.
    pub estimate: Option<f64>,
    /// What was expected of the rungs; `None` where nothing was.
    pub predicted: Option<Predicted>,
    /// Rungs left out, as they were expected to err by far more than is allowed.
    pub skipped: Vec<Rung>,
    /// All that were compared, in order.
    pub tried: Vec<Tried>,
    /// Rungs that could not be built, started or run to the end, in order.
    pub failed: Vec<Rung>,
}

/// Foundations chosen, and the run on them.
pub struct Selection {
    /// One a structure whose foundation was to be chosen, in their order.
    pub choices: Vec<Choice>,
    /// The run on the foundations chosen: of the scene's accuracy, or of 0.03 of the tolerance where that is finer.
    pub run: Run,
    /// Number of runs that were made, this one among them.
    pub runs: usize,
}

/// Chooses a rung for every structure with a tolerance (`None`: its foundation is given), those that ride on bodies first, the
/// others held at theirs (influence before their turn), and runs the scene. `watch` sees the time that every run reaches,
/// and may stop the choice.
///
/// First the errors of the rungs are predicted, see [`Predicted`]: rungs expected to err by much more than the tolerance are
/// skipped; one expected to err by much less is taken without a higher one to check it. What is left is compared: rigid and
/// influence with the first [`Rung::Modal`] whose highest frequency exceeds three times that of the bodies on their contacts,
/// a number of modes with the next of 2, 4, 6, 8, 12, 16 and full, full with half its mesh. The run of the rung chosen is
/// kept. Where several structures climbed, all are checked together and raised together until the sum of their tolerances
/// holds. Not controlled: pitch, roll, lateral motion and forces, gauges and what lies between output times.
///
/// # Errors
/// A foundation that is given or influence that cannot be built; a scene that starts on no foundation.
pub fn choose<L: Ladder>(
    scene: &Scene,
    tolerances: &[Option<f64>],
    ladder: &mut L,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Selection, L::Error> {
    let mut foundations = (0..tolerances.len())
        .map(|structure| ladder.foundation(structure, Rung::Influence))
        .collect::<Result<Vec<_>, _>>()?;
    let mut choices: Vec<Choice> = Vec::new();
    let (mut last, mut runs) = (None, 0);
    // what rides on a body is small: it is tried on all that is still cheap
    let (riding, standing): (Vec<usize>, Vec<usize>) =
        (0..tolerances.len()).partition(|&structure| foundations[structure].on.is_some());
    for structure in riding.into_iter().chain(standing) {
        let Some(tolerance) = tolerances[structure] else { continue };
        if scene.analysis == Analysis::QuasiStatic {
            choices.push(Choice::new(structure, Rung::Influence, Reason::QuasiStatic));
            continue;
        }
        let few = match ladder.modes(structure, FEW) {
            Ok(None) => {
                choices.push(Choice::new(structure, Rung::Influence, Reason::NoMass));
                continue;
            }
            // where they cannot be found, the rungs say why
            few => few.ok().flatten(),
        };
        let climb = Climb::new(scene, tolerance, structure, &mut foundations, ladder, watch);
        let Outcome { choice, found, runs: own } = climb.climb(few)?;
        let Candidate { foundation, run, .. } = found;
        foundations[structure] = foundation;
        runs += own;
        choices.push(choice);
        last = Some(run);
    }
    let run = match last {
        Some(run) => run,
        None => {
            runs += 1;
            ladder.run(scene, &foundations, watch)?
        }
    };
    let selection = Selection { choices, run, runs };
    let mut settled = joint::settle(scene, tolerances, foundations, ladder, watch, selection);
    settled.choices.sort_by_key(|choice| choice.structure);
    Ok(settled)
}

impl Choice {
    fn new(structure: usize, rung: Rung, reason: Reason) -> Choice {
        let (skipped, tried, failed) = (Vec::new(), Vec::new(), Vec::new());
        Choice { structure, rung, reason, estimate: None, predicted: None, skipped, tried, failed }
    }
}

/// Frequency of the stiffest body on its contacts at rest, the rail rigid: sqrt(sum k' / m).
fn contact_frequency(scene: &Scene, structure: usize) -> f64 {
    let of = |b: usize| {
        let contacts = || scene.contacts.iter().filter(|contact| contact.body == b);
        let wheels: usize = contacts().map(|contact| contact.offsets.len()).sum();
        let body = &scene.bodies[b];
        let share = body.mass * scene.gravity / wheels.max(1) as f64;
        let stiffness: f64 = contacts()
            .filter(|contact| contact.structure == structure)
            .map(|contact| {
                let law = &scene.wheels[contact.wheel].normal;
                law.at(law.penetration(share), 0.0).by_penetration * contact.offsets.len() as f64
            })
            .sum();
        (stiffness / body.mass).sqrt()
    };
    (0..scene.bodies.len()).map(of).fold(0.0, f64::max)
}
