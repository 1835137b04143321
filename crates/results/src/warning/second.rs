//! How far the linear theory holds for a run: finite displacements under the loads of the times that matter.

use fea::{LargeDisplacements, LinearState, Omitted, Preload, RailForce};
use formats::scene::{Foundation, Origin, Scene};
use formats::text::number::{number, rounded};
use piecewise::Side;
use sim::Channel;
use trains::GirderResponse;

use crate::case_result::{CaseResult, FirstOrderDoubt};

/// Relative change from which it is told, and from which it is a warning, as codes ask for second order then (EN 1993-1-1,
/// 5.2.1).
const NOTED: f64 = 1e-3;
const WARNED: f64 = 0.1;

/// Times, evenly spaced over the run, at which structures are looked at beside those of the largest responses.
const SPACED_TIMES: usize = 9;

/// What is to be told of the structures: what [`LinearState::compare`] finds at the times at which forces, moments and deflections
/// of their girders are largest, and at evenly spaced times. Differences are those of all these times, by the largest values.
pub(super) fn second_order(scene: &Scene, outcome: &CaseResult) -> Vec<FirstOrderDoubt> {
    (0..scene.structures.len())
        .filter_map(|index| of_structure(scene, index, outcome))
        .collect()
}

/// What is known of a structure after all times.
enum Finding {
    Omitted(Omitted),
    Lost { time: f64, part: f64 },
}

fn of_structure(scene: &Scene, index: usize, outcome: &CaseResult) -> Option<FirstOrderDoubt> {
    let structure = &scene.structures[index];
    let Origin::Spec { spec, .. } = &structure.origin else {
        return None;
    };
    if structure.foundation == Foundation::Rigid {
        return None;
    }
    let (model, rails) = spec.model().ok()?;
    let base = match &spec.preload {
        Some(preload) => preload.without_wheels(model.up),
        None if spec.has_mass() => Preload::weight(model.up, scene.gravity),
        None => Preload::default(),
    };
    let doubt = |is_warning: bool, text: String| FirstOrderDoubt {
        is_warning,
        text: format!("{}: {text}", structure.name),
    };
    let found = LinearState::new(&model, &rails, &base).and_then(|state| {
        let mut all = Omitted::default();
        for time in times(scene, index, outcome) {
            let live = Preload {
                rails: wheel_forces(scene, index, outcome, time),
                ..Preload::default()
            };
            if live.rails.is_empty() {
                continue;
            }
            match state.compare(&live)? {
                LargeDisplacements::Found(own) => all = all.or(own),
                LargeDisplacements::Lost { part } => return Ok(Finding::Lost { time, part }),
            }
        }
        Ok(Finding::Omitted(all))
    });
    let is_lateral_bound = (scene.rails.iter().zip(&outcome.is_lateral_bound))
        .any(|(rail, is_bound)| rail.structure == index && *is_bound);
    let warping = if is_lateral_bound {
        " (without the warping of its sections, which would hold them against twist)"
    } else {
        ""
    };
    let preload = match &spec.preload {
        Some(_) => "the run is linear about its preload",
        None => "the run neglects this; `preload` includes the axial forces of standing loads",
    };
    match found {
        Ok(Finding::Omitted(omitted)) => {
            let [deflection, force, moment] =
                [omitted.deflection, omitted.force, omitted.moment].map(|own| own.relative());
            let most = deflection.max(force).max(moment);
            (most >= NOTED).then(|| {
                doubt(
                    most >= WARNED,
                    format!(
                        "second-order effects and large rotations would change deflections by about {deflection:.1e}, \
                         forces by {force:.1e} and moments by {moment:.1e} of the largest{warping}; {preload}"
                    ),
                )
            })
        }
        Ok(Finding::Lost { part, .. }) if part == 0.0 && !base.is_zero() => Some(doubt(
            true,
            format!(
                "no stable equilibrium with finite displacements was found under its standing loads alone, so that \
                 second-order effects are not known; {preload}"
            ),
        )),
        Ok(Finding::Lost { time, part }) => Some(doubt(
            true,
            format!(
                "under the wheel forces at t = {} s the structure would lose its stability: no equilibrium with finite \
                 displacements was found beyond {part:.2} of these forces{warping}, so that second-order effects are not \
                 known; {preload}",
                number(rounded(time, 6))
            ),
        )),
        Err(error) => Some(doubt(
            false,
            format!("second-order effects are not known ({error})"),
        )),
    }
}

/// The times of the largest value of each quantity on the rails of a structure, and evenly spaced ones, increasing.
fn times(scene: &Scene, index: usize, outcome: &CaseResult) -> Vec<f64> {
    let mut largest: Vec<(GirderResponse, f64, f64)> = Vec::new();
    let all = outcome.girders().extremes.iter();
    for own in all.filter(|own| scene.rails[own.rail].structure == index) {
        let value = own.value.abs();
        match largest.iter_mut().find(|known| known.0 == own.quantity) {
            Some(known) if known.1 < value => *known = (own.quantity, value, own.time),
            Some(_) => {}
            None => largest.push((own.quantity, value, own.time)),
        }
    }
    let end = outcome
        .columns
        .values("time")
        .last()
        .copied()
        .unwrap_or(0.0);
    let spaced = (0..SPACED_TIMES).map(|k| end * k as f64 / (SPACED_TIMES - 1) as f64);
    let mut times: Vec<f64> = largest.iter().map(|own| own.2).chain(spaced).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup_by(|b, a| *b - *a <= 1e-6 * end);
    times
}

/// The forces of the wheels on the rails of a structure at a time.
fn wheel_forces(scene: &Scene, index: usize, outcome: &CaseResult, time: f64) -> Vec<RailForce> {
    let solution = &outcome.run.solution;
    let wheels = outcome.input.wheels.iter().enumerate();
    wheels
        .filter(|(_, wheel)| scene.rails[wheel.rail].structure == index)
        .map(|(k, wheel)| {
            let value = |channel: Channel| solution.value(channel, time, Side::Before);
            RailForce {
                rail: scene.rails[wheel.rail].rail,
                x: value(Channel::Position(k)),
                force: [
                    value(Channel::Traction(k)),
                    -value(Channel::Vertical(k)),
                    value(Channel::Lateral(k)),
                ],
            }
        })
        .filter(|own| own.force != [0.0; 3])
        .collect()
}
