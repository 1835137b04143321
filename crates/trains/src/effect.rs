//! Extremes of effects elsewhere: reactions and internal forces of named sections.

use fea::Effect;

use crate::collect::standings;
use crate::dead::DeadLoads;
use crate::error::Error;
use crate::extremes::Governing;
use crate::follow::SectionSide;
use crate::line::Lines;
use crate::pieces::{Pieces, ResponsePiece};
use crate::plan::{CasePlan, Responses};
use crate::structure::{Structure, Tip, section_of};
use crate::train::{COMPONENTS, PlacedTrain, PlacedWheel, TrainCase};

/// Effects whose influence lines are solved at once.
const BATCH: usize = 32;

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
    for wheel in plans
        .iter()
        .flat_map(|plan| &plan.trains)
        .flatten()
        .flat_map(|train| &train.wheels)
    {
        used.iter_mut()
            .zip(wheel.load)
            .for_each(|(used, load)| *used |= load != 0.0);
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
    let of_one_section = effects.chunk_by(|a, b| section_of(a) == section_of(b));
    for sums in of_one_section.flat_map(|sums| sums.chunks(BATCH)) {
        let lines = structure.effect_lines_of(sums, used)?;
        for (sum, line) in sums.iter().zip(lines) {
            let of_dead = structure.dead_effect(sum, &line, dead)?;
            let tips = structure.tips(sum)?;
            let line = EffectLine {
                line: line.joined(&tips),
                tips,
                at_section: structure.at_section(sum),
            };
            for (plan, out) in plans.iter().zip(&mut out) {
                out.push(governing(structure, plan, &line, plan.dead * of_dead));
            }
        }
    }
    Ok(out)
}

/// The influence line of a sum of effects.
struct EffectLine {
    line: Lines<1>,
    tips: Vec<Tip>,
    /// Rails and coordinates at which a wheel is at the section of the sum.
    at_section: Vec<(usize, f64)>,
}

/// The response to a train of a sum of effects. A wheel at an end of a stretch of rail is counted on either side of a section
/// there, by a part of no length.
fn responses(of: &EffectLine, train: &PlacedTrain, slack: f64) -> Vec<ResponsePiece> {
    let EffectLine {
        line,
        tips,
        at_section,
    } = of;
    let is_at_section = |position: f64| {
        let mut wheels = train.wheels.iter();
        let at = |wheel: &PlacedWheel, (rail, x): &(usize, f64)| {
            *rail == wheel.rail && (x - wheel.offset - position).abs() <= slack
        };
        wheels.any(|wheel| at_section.iter().any(|place| at(wheel, place)))
    };
    let mut pieces = Pieces::sum(line, train, slack).responses();
    for piece in &mut pieces {
        piece.at_section = piece.position.map(is_at_section);
    }
    let beyond = |piece: &ResponsePiece, end: usize| {
        let position = piece.position[end];
        let at = |wheel: &PlacedWheel, tip: &Tip| {
            (tip.rail, tip.end) == (wheel.rail, end)
                && (tip.x - wheel.offset - position).abs() <= slack
        };
        let pairs = train
            .wheels
            .iter()
            .flat_map(|wheel| tips.iter().map(move |tip| (wheel, tip)));
        let changes = pairs.filter(|(wheel, tip)| at(wheel, tip));
        let change = changes
            .map(|(wheel, tip)| {
                let each = wheel.load.iter().zip(tip.change);
                each.map(|(load, change)| load * change).sum::<f64>()
            })
            .reduce(|a, b| a + b)?;
        Some(ResponsePiece {
            position: [position; 2],
            cubic: [piece.at(position) + change, 0.0, 0.0, 0.0],
            origin: piece.origin,
            at_section: [true; 2],
        })
    };
    let with_both = |piece: ResponsePiece| {
        let [first, last] = [0, 1].map(|end| beyond(&piece, end));
        first.into_iter().chain([piece]).chain(last)
    };
    pieces.into_iter().flat_map(with_both).collect()
}

/// The states of a case with the largest and the smallest value of an effect, whose influence line is given, and its value
/// under dead load.
fn governing(
    structure: &Structure,
    plan: &CasePlan,
    line: &EffectLine,
    dead: f64,
) -> [Governing; 2] {
    let slack = structure.slack();
    let of = |(stance, train)| (stance, responses(line, train, slack));
    let responses: Responses = plan
        .trains
        .iter()
        .map(|stances| stances.iter().enumerate().map(of).collect())
        .collect();
    [1.0, -1.0].map(|sign| {
        let found = plan
            .best(&responses, sign, f64::NEG_INFINITY)
            .unwrap_or_default();
        Governing {
            value: sign * found.signed + dead,
            dead,
            x: 0.0,
            side: SectionSide::At,
            trains: standings(plan, &found),
            coincident: [0.0; 3],
        }
    })
}
