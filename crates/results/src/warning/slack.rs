//! Cables that lose their tension under the wheels of a run, which keeps them taut.

use fea::{Effect, ForceComponent, MemberKind};
use formats::scene::motion::SimulationInput;
use formats::scene::{Origin, Scene};
use formats::spec::Spec;
use splines::{Axis, InfluenceLines, Probe};

use crate::columns::NamedColumns;

/// Most times at which the tension of cables is looked at.
const MOST_TIMES: usize = 2000;

/// The cables of a structure with the influence lines of their axial forces, and these forces without wheels.
struct Cables {
    members: Vec<usize>,
    lines: InfluenceLines,
    tension: Vec<f64>,
}

impl Cables {
    /// Those of a spec; `None` where it has none, or no state.
    fn of(spec: &Spec) -> Option<Cables> {
        let preload = spec.preload.as_ref()?;
        let (model, _, frame) = spec.factored().ok()?;
        let is_cable = |index: &usize| model.members[*index].kind == MemberKind::Cable;
        let members: Vec<usize> = (0..model.members.len()).filter(is_cable).collect();
        if members.is_empty() {
            return None;
        }
        let axial = |&member: &usize| Effect::InternalForce {
            member,
            place: 0.5,
            component: ForceComponent::Axial,
        };
        let effects: Vec<Effect> = members.iter().map(axial).collect();
        let lines = frame.influence_lines(&model, &effects).ok()?;
        let mut tension: Vec<f64> = members
            .iter()
            .map(|&member| model.members[member].tension)
            .collect();
        let mut one = vec![0.0; members.len()];
        for wheel in &preload.wheels {
            lines
                .fill(
                    Probe {
                        rail: wheel.rail,
                        x: wheel.x,
                        axis: Axis::Vertical,
                    },
                    &mut one,
                )
                .ok()?;
            tension
                .iter_mut()
                .zip(&one)
                .for_each(|(sum, effect)| *sum -= effect * wheel.force[1]);
        }
        Some(Cables {
            members,
            lines,
            tension,
        })
    }
}

/// Warnings about cables that lose their tension at any recorded time.
pub(super) fn slack_cables(
    scene: &Scene,
    input: &SimulationInput,
    record: &NamedColumns,
) -> Vec<String> {
    let mut all = Vec::new();
    for (index, structure) in scene.structures.iter().enumerate() {
        let Origin::Spec { spec, .. } = &structure.origin else {
            continue;
        };
        let Some(cables) = Cables::of(spec) else {
            continue;
        };
        let wheels: Vec<(usize, &[f64], &[f64])> = input
            .wheels
            .iter()
            .filter(|wheel| scene.rails[wheel.rail].structure == index)
            .map(|wheel| {
                let part = |part| record.part(&wheel.name, part);
                (scene.rails[wheel.rail].rail, part("x"), part("vertical"))
            })
            .collect();
        let times = record.values("time");
        let stride = times.len().div_ceil(MOST_TIMES).max(1);
        let mut one = vec![0.0; cables.members.len()];
        let mut first: Vec<Option<f64>> = vec![None; cables.members.len()];
        for (t, time) in times.iter().enumerate().step_by(stride) {
            let mut tension = cables.tension.clone();
            for (rail, x, force) in &wheels {
                let (Some(&x), Some(&force)) = (x.get(t), force.get(t)) else {
                    continue;
                };
                let at = Probe {
                    rail: *rail,
                    x,
                    axis: Axis::Vertical,
                };
                if force != 0.0 && cables.lines.fill(at, &mut one).is_ok() {
                    tension
                        .iter_mut()
                        .zip(&one)
                        .for_each(|(sum, effect)| *sum -= effect * force);
                }
            }
            for (first, tension) in first.iter_mut().zip(tension) {
                if tension <= 0.0 {
                    first.get_or_insert(*time);
                }
            }
        }
        for (member, time) in cables.members.iter().zip(first) {
            if let Some(time) = time {
                all.push(format!(
                    "{}: the cable {} would become slack at t = {time:.3} s; the run models it as a bar that \
                     also resists compression",
                    structure.name,
                    spec.member_words(*member)
                ));
            }
        }
    }
    all
}
