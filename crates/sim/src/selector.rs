//! Which foundation a scene needs: the lowest rung whose error, measured against a higher one, is allowed.

use std::ops::ControlFlow;

use crate::foundation::Dynamics;
use crate::{Analysis, Channel, Error, Foundation, Freedom, Run, Scene, Status, run};

/// Numbers of modes that are tried, and check what lies below them.
const MODES: [usize; 6] = [2, 4, 6, 8, 12, 16];
/// The highest mode kept must be this many times as fast as a body on its contacts to check anything.
const ABOVE_CONTACT: f64 = 3.0;
/// Accuracy asked of the compared runs, by the tolerance: where a load strikes hard wheels, runs err by up to
/// thirty times what they are asked.
const STEPPING: f64 = 0.03;
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
    /// All modes of a mesh.
    Full,
}

/// What builds foundations on demand.
pub trait Ladder {
    /// What can go wrong.
    type Error: From<Error>;

    /// Whether the mass of `structure` is known.
    ///
    /// # Errors
    /// A structure that cannot be asked.
    fn has_mass(&mut self, structure: usize) -> Result<bool, Self::Error>;

    /// `structure` at `rung`; a structure whose foundation is given ignores `rung`.
    ///
    /// # Errors
    /// A rung that cannot be built.
    fn foundation(&mut self, structure: usize, rung: Rung) -> Result<Foundation, Self::Error>;
}

/// Why a rung was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// No mass is known: the error of leaving it out is not known either.
    NoMass,
    /// A sequence of equilibria has no inertia.
    QuasiStatic,
    /// The estimate is within 0.8 of the tolerance.
    Sufficient,
    /// Nothing lower was sufficient; the error of this rung itself is not estimated.
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
    /// All that were tried, in order.
    pub tried: Vec<Tried>,
}

/// Chooses a rung for every structure with a tolerance (`None`: its foundation is given), in their order, the
/// others held at theirs (influence before their turn).
///
/// Rigid and influence are checked against the first [`Rung::Modal`] whose highest frequency exceeds three times
/// that of the bodies on their contacts, a number of modes against the next of 2, 4, 6, 8, 12, 16 and full. Not
/// controlled: pitch, roll, lateral motion and forces, gauges, what lies between output times, and the effect on
/// one structure of what a later one is given.
///
/// # Errors
/// A scene that cannot start on a given foundation, or on influence.
pub fn choose<L: Ladder>(
    scene: &Scene,
    tolerances: &[Option<f64>],
    ladder: &mut L,
) -> Result<Vec<Choice>, L::Error> {
    let mut rungs = vec![Rung::Influence; tolerances.len()];
    let mut choices = Vec::new();
    for (structure, tolerance) in tolerances.iter().enumerate() {
        let Some(tolerance) = *tolerance else { continue };
        let settled =
            |reason| Choice { structure, rung: Rung::Influence, reason, estimate: None, tried: Vec::new() };
        let choice = if scene.analysis == Analysis::QuasiStatic {
            settled(Reason::QuasiStatic)
        } else if !ladder.has_mass(structure)? {
            settled(Reason::NoMass)
        } else {
            let mut finer = scene.clone();
            finer.accuracy = finer.accuracy.min(STEPPING * tolerance);
            climb(&finer, tolerance, structure, &mut rungs, ladder)?
        };
        rungs[structure] = choice.rung;
        choices.push(choice);
    }
    Ok(choices)
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

fn climb<L: Ladder>(
    scene: &Scene,
    tolerance: f64,
    structure: usize,
    rungs: &mut [Rung],
    ladder: &mut L,
) -> Result<Choice, L::Error> {
    let mut attempt = |rung: Rung, ladder: &mut L| -> Result<(Run, f64), L::Error> {
        rungs[structure] = rung;
        let foundations = rungs
            .iter()
            .enumerate()
            .map(|(s, rung)| ladder.foundation(s, *rung))
            .collect::<Result<Vec<_>, _>>()?;
        let highest = match &foundations[structure].structure {
            Some(structure) => match &structure.dynamics {
                Dynamics::Modes { omega, .. } => omega.iter().copied().fold(0.0, f64::max),
                Dynamics::Matrices { .. } => 0.0,
            },
            None => 0.0,
        };
        Ok((run(scene, &foundations, &mut |_| ControlFlow::Continue(()))?, highest))
    };
    let needed = ABOVE_CONTACT * contact_frequency(scene, structure);
    let influence = attempt(Rung::Influence, ladder)?.0;
    let mut lower: Vec<(Rung, Run)> = Vec::new();
    // A rail that the wheels could not leave rigid may still be refused by the scene: it is only left out.
    if let Ok((rigid, _)) = attempt(Rung::Rigid, ladder) {
        lower.push((Rung::Rigid, rigid));
    }
    lower.push((Rung::Influence, influence));
    let mut tried = Vec::new();
    let none = lower.iter().all(|(_, run)| !run.status.is_complete());
    for against in MODES.map(Rung::Modal).into_iter().chain([Rung::Full]).filter(|_| !none) {
        let higher = match attempt(against, ladder) {
            Ok((higher, highest)) if higher.status.is_complete() => {
                if highest <= needed && against != Rung::Full {
                    continue;
                }
                higher
            }
            // A higher one may still follow the motion.
            _ => continue,
        };
        for (rung, found) in lower.drain(..) {
            let estimate = distance(&found, &higher, scene);
            tried.push(Tried { rung, estimate, against, stages: found.counts.stages as u64 });
            if estimate <= SAFE * tolerance {
                let (reason, estimate) = (Reason::Sufficient, Some(estimate));
                return Ok(Choice { structure, rung, reason, estimate, tried });
            }
        }
        if against == Rung::Full {
            return Ok(Choice { structure, rung: against, reason: Reason::Top, estimate: None, tried });
        }
        lower.push((against, higher));
    }
    let best = lower.pop().map_or(Rung::Influence, |(rung, _)| rung);
    Ok(Choice { structure, rung: best, reason: Reason::Unchecked, estimate: None, tried })
}

/// How far `a` is from `b`, two runs of `scene`: the larger of max |y_a - y_b| / max |y_b| over each body's height
/// and max |F_a - F_b| / max |F_b| over the vertical wheel forces, at the output times. Infinite where one did not
/// reach its end.
#[must_use]
pub fn distance(a: &Run, b: &Run, scene: &Scene) -> f64 {
    let by_rule = matches!((&a.status, &b.status), (Status::Ended(_), Status::Ended(_)));
    let reached = a.status.is_complete() && b.status.is_complete();
    if !reached || (a.history.len() != b.history.len() && !by_rule) {
        return f64::INFINITY;
    }
    let part = |channels: &[Channel]| {
        let (mut apart, mut peak) = (0.0_f64, 0.0_f64);
        for channel in channels {
            for (a, b) in a.history.column(*channel).iter().zip(b.history.column(*channel)) {
                apart = apart.max((a - b).abs());
                peak = peak.max(b.abs());
            }
        }
        if apart == 0.0 { 0.0 } else { apart / peak }
    };
    let forces: Vec<Channel> =
        b.history.channels().iter().copied().filter(|c| matches!(c, Channel::Vertical(_))).collect();
    (0..scene.bodies.len())
        .map(|body| part(&[Channel::Displacement(body, Freedom::Y)]))
        .fold(part(&forces), f64::max)
}
