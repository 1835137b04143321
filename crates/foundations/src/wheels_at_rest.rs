//! Wheels at rest as a part of the preload of the structures under them.

use std::ops::ControlFlow;
use std::sync::Arc;

use fea::RailForce;
use formats::scene::motion::simulation_input;
use formats::scene::{Document, Foundation, Origin, Scene, Structure};
use sim::{Analysis, Channel};

use crate::build::build;
use crate::modal::ModeCache;
use crate::solved::solve;

/// Solutions with the forces of wheels on flexible rails, after those on rigid ones.
const PASSES: usize = 2;

/// The document with the vertical forces of the wheels at rest, at the start of each case, in the preload of the structures
/// that ask for them.
///
/// The forces are those of the equilibrium on rigid rails; then twice those on the rails of the structure about the state under
/// the forces before. A case whose wheels have no equilibrium, or whose structure has no state, is left as it is: its run, or
/// its solution, reports why.
#[must_use]
pub fn with_wheels_at_rest(mut document: Document) -> Document {
    for case in &mut document.cases {
        let scene = &mut case.scene;
        if !scene.structures.iter().any(|structure| structure.preload) {
            continue;
        }
        for pass in 0..=PASSES {
            let Some(forces) = wheel_forces(scene, pass > 0) else {
                break;
            };
            for (structure, own) in scene.structures.iter_mut().zip(forces) {
                if let (true, Origin::Spec { spec, .. }) =
                    (structure.preload, &mut structure.origin)
                    && let Some(preload) = &mut Arc::make_mut(spec).preload
                {
                    preload.wheels = own;
                }
            }
        }
    }
    document
}

/// Vertical forces of all wheels at the start, by structure; `None` where there is no equilibrium.
fn wheel_forces(scene: &Scene, is_flexible: bool) -> Option<Vec<Vec<RailForce>>> {
    let input = simulation_input(scene).ok()?;
    let lateral = scene.has_flanges();
    let foundation = |structure: &Structure| {
        let solved = match &structure.origin {
            Origin::Spec { spec, .. } if structure.preload && is_flexible => {
                Some(solve(spec).ok()?)
            }
            _ => None,
        };
        let foundation = if solved.is_some() {
            Foundation::Influence
        } else {
            Foundation::Rigid
        };
        let plain = Structure {
            foundation,
            auto: false,
            ..structure.clone()
        };
        build(&mut ModeCache::default(), &plain, solved.as_ref(), lateral)
            .ok()
            .map(|built| built.foundation)
    };
    let foundations = scene
        .structures
        .iter()
        .map(foundation)
        .collect::<Option<Vec<_>>>()?;
    // The first sample of a run is its start.
    let short = sim::Scene {
        end: 1e-6 * input.scene.output_dt,
        analysis: Analysis::Dynamic,
        ..input.scene
    };
    let run = sim::run(&short, &foundations, &mut |_| ControlFlow::Continue(())).ok()?;
    let mut out = vec![Vec::new(); scene.structures.len()];
    for (index, wheel) in input.wheels.iter().enumerate() {
        let rail = &scene.rails[wheel.rail];
        let first = |channel| run.history.values(channel).next();
        let (x, force) = (
            first(Channel::Position(index))?,
            first(Channel::Vertical(index))?,
        );
        if force != 0.0 {
            out[rail.structure].push(RailForce {
                rail: rail.rail,
                x,
                force: [0.0, -force, 0.0],
            });
        }
    }
    Some(out)
}
