//! Extremes of effects elsewhere: reactions and internal forces of named sections.

use fea::Effect;

use crate::collect::standings;
use crate::dead::DeadLoads;
use crate::error::Error;
use crate::extremes::Governing;
use crate::follow::SectionSide;
use crate::pieces::Pieces;
use crate::plan::{CasePlan, Responses};
use crate::structure::Structure;
use crate::train::{COMPONENTS, TrainCase};

/// Largest and smallest value of sums of effects, by case and sum: reactions, internal forces of sections.
///
/// # Errors
/// A train or a case that does not fit on the rails, a load that the structure does not resist, an effect that does not
/// exist.
///
/// # Example
/// ```
/// use fea::{Effect, Girder};
/// use trains::{DeadLoads, Structure, Train, TrainCase, TrainWheel, effects};
///
/// // The reaction of a simple beam of 8 m is largest with the first of two wheels over the support.
/// let girder = Girder { spans: vec![8.0], e: 2.1e8, i_vertical: 5e-4, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let structure = Structure::new(&model, &[rail], false)?;
/// let wheel = |x: f64| TrainWheel { rail: 0, x, vertical: 100.0, lateral: 0.0, longitudinal: 0.0, eccentricity: 0.0 };
/// let train = Train {
///     wheels: vec![wheel(0.0), wheel(2.0)], ends: [0.0; 2], turned: true, reverses: true, enters: false,
/// };
/// let case = TrainCase { trains: vec![train], ..TrainCase::default() };
/// let holds = structure.frame().restraints(&model);
/// let up = holds.into_iter().find(|hold| hold.dof == fea::Dof::Uy).expect("the first support holds uy");
/// let found = effects(&structure, &DeadLoads::default(), &[case], &[vec![Effect::Reaction(up)]])?;
/// assert!((found[0][0][0].value - 175.0).abs() < 1e-11);
/// # Ok::<(), trains::Error>(())
/// ```
pub fn effects(
    structure: &Structure,
    dead: &DeadLoads,
    cases: &[TrainCase],
    effects: &[Vec<Effect>],
) -> Result<Vec<Vec<[Governing; 2]>>, Error> {
    let (plans, used) = plans(structure, dead, cases)?;
    extremes_of_effects(structure, dead, &plans, effects, used)
}

/// The cases with their trains in every stance, and the components of load that any of them has.
pub(crate) fn plans(
    structure: &Structure,
    dead: &DeadLoads,
    cases: &[TrainCase],
) -> Result<(Vec<CasePlan>, [bool; COMPONENTS]), Error> {
    let plans: Vec<CasePlan> = cases
        .iter()
        .enumerate()
        .map(|(index, case)| CasePlan::new(structure, case, index))
        .collect::<Result<_, _>>()?;
    let mut used = [false; COMPONENTS];
    used[1] = dead.lines.iter().any(|line| *line != 0.0);
    for wheel in plans.iter().flat_map(|plan| &plan.trains).flatten().flat_map(|train| &train.wheels) {
        used.iter_mut().zip(wheel.load).for_each(|(used, load)| *used |= load != 0.0);
    }
    Ok((plans, used))
}

/// [`effects`] of cases that are already planned.
pub(crate) fn extremes_of_effects(
    structure: &Structure,
    dead: &DeadLoads,
    plans: &[CasePlan],
    effects: &[Vec<Effect>],
    used: [bool; COMPONENTS],
) -> Result<Vec<Vec<[Governing; 2]>>, Error> {
    let mut out = vec![Vec::with_capacity(effects.len()); plans.len()];
    for sum in effects {
        let line = structure.effect_line(sum, used)?;
        let of_dead = structure.dead_effect(sum, &line, dead)?;
        for (plan, out) in plans.iter().zip(&mut out) {
            let own = plan.dead * of_dead;
            let slack = structure.slack();
            let of = |(stance, train)| (stance, Pieces::sum(&line, train, slack).responses());
            let responses: Responses =
                plan.trains.iter().map(|stances| stances.iter().enumerate().map(of).collect()).collect();
            out.push([1.0, -1.0].map(|sign| {
                let found = plan.best(&responses, sign, f64::NEG_INFINITY).unwrap_or_default();
                Governing {
                    value: sign * found.signed + own,
                    dead: own,
                    x: 0.0,
                    side: SectionSide::At,
                    trains: standings(plan, &found),
                    coincident: [0.0; 3],
                }
            }));
        }
    }
    Ok(out)
}
