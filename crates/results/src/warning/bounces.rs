//! Free bounces of wheels without dampers among the cycles that fatigue counts.

use formats::scene::{Analysis, Foundation, Origin, Scene, root_body};
use sim::Fidelity;

use crate::case_result::CaseResult;

/// Damping ratio of the modes of a structure below which bounces on it last: after twenty of them more than half is left.
const DAMPED: f64 = 0.005;

/// A warning where stresses of a structure have cycles, and nothing damps the bounces of the wheels on it: neither a damper
/// of the wheels nor the structure.
pub(super) fn cycles_of_bounces(scene: &Scene, outcome: &CaseResult) -> Option<String> {
    if scene.analysis != Analysis::Dynamic {
        return None;
    }
    let bodies = undamped_bodies(scene);
    let concerned = (0..scene.structures.len()).filter_map(|s| {
        let body = *bodies.iter().find(|body| stands_on(scene, **body, s))?;
        (structure_damping(scene, outcome, s) < DAMPED).then_some((s, body))
    });
    let counted = concerned.filter_map(|(s, body)| {
        let prefix = format!("{}.", scene.structures[s].name);
        let own = outcome
            .fatigue
            .iter()
            .filter(|result| result.column.starts_with(&prefix));
        own.max_by(|a, b| a.count().total_cmp(&b.count()))
            .map(|most| (s, body, most))
    });
    let (s, body, most) = counted.max_by(|a, b| a.2.count().total_cmp(&b.2.count()))?;
    if most.count() == 0.0 {
        return None;
    }
    let structure = &scene.structures[s];
    let ways = match &structure.origin {
        Origin::Spec { .. } => {
            format!(
                ", or for {} a foundation with mass (`modal`) and `damping` of at least 0.005",
                structure.name
            )
        }
        Origin::Tables { .. } => String::new(),
    };
    Some(format!(
        "the cycles counted for fatigue ({} of {}) include undamped bouncing of {} on its wheels; real cranes damp \
         it: specify a damper `c` in `vertical` of the wheels{ways}",
        most.count(),
        most.column,
        scene.bodies[body].name
    ))
}

/// Bodies that can move on wheels none of which has a damper.
fn undamped_bodies(scene: &Scene) -> Vec<usize> {
    let [y, roll, pitch] = [1, 3, 5];
    let can_bounce = |body: &usize| {
        [y, roll, pitch]
            .into_iter()
            .any(|dof| scene.bodies[*body].free[dof])
    };
    let has_bare_wheels = |body: &usize| {
        let mut own = scene
            .trucks
            .iter()
            .filter(|truck| root_body(scene, truck.body).0 == *body)
            .peekable();
        own.peek().is_some() && own.all(|truck| scene.wheels[truck.wheel].vertical.c == 0.0)
    };
    (0..scene.bodies.len())
        .filter(can_bounce)
        .filter(has_bare_wheels)
        .collect()
}

/// Whether structure `s` carries the wheels of a body, directly or under a body whose structure does.
fn stands_on(scene: &Scene, body: usize, s: usize) -> bool {
    let own = scene
        .trucks
        .iter()
        .filter(|truck| root_body(scene, truck.body).0 == body);
    own.map(|truck| scene.rails[truck.rail].structure)
        .any(|under| {
            let carrier = scene.structures[under].carrier;
            under == s || carrier.is_some_and(|on| stands_on(scene, root_body(scene, on.body).0, s))
        })
}

/// Damping ratio of the natural modes of structure `s` in the run; 0 for a structure without mass.
fn structure_damping(scene: &Scene, outcome: &CaseResult, s: usize) -> f64 {
    let structure = &scene.structures[s];
    if let Some(choice) = outcome.choices.iter().find(|choice| choice.structure == s) {
        return if matches!(choice.fidelity, Fidelity::Modal(_)) {
            structure.damping
        } else {
            0.0
        };
    }
    match structure.foundation {
        Foundation::Parts { damping, .. }
        | Foundation::Modal { damping, .. }
        | Foundation::Full { damping, .. }
        | Foundation::Ties {
            damping,
            has_mass: true,
            ..
        } => damping,
        Foundation::Rigid | Foundation::Influence | Foundation::Ties { .. } => 0.0,
    }
}
