//! Notes on the scope of `accuracy`: it is the error of values at equal times up to 100 bounces of the wheels, and up to the
//! first strike of a flange or a stop. Extremes of girders have notes of their own.

use formats::scene::motion::SimulationInput;
use formats::scene::{Foundation, Scene, Stop};
use formats::text::number::{number, rounded};
use sim::{Run, StruckBy};

use crate::case_result::CaseResult;

/// Notes of a case on what its `accuracy` holds for; none where it holds for the whole run.
#[must_use]
pub fn accuracy_notes(scene: &Scene, outcome: &CaseResult) -> Vec<String> {
    let CaseResult { run, input, .. } = outcome;
    let own = many_bounces(scene, run)
        .into_iter()
        .chain(after_strike(scene, input, run))
        .chain(end_stops(scene, outcome));
    own.chain(outcome.girders().notes.iter().cloned())
        .chain(outcome.girders().stresses.notes(scene))
        .collect()
}

/// End stops on flexible rails that are hit: the rails do not give way under them in the motion.
fn end_stops(scene: &Scene, outcome: &CaseResult) -> Option<String> {
    let is_hit = |stop: &Stop| {
        let rail = stop.rail.map(|rail| &scene.rails[rail]);
        let is_flexible = rail.is_some_and(|rail| {
            !matches!(
                scene.structures[rail.structure].foundation,
                Foundation::Rigid
            )
        });
        let peaks = outcome
            .peaks
            .iter()
            .filter(|peak| peak.column.starts_with(&stop.name));
        is_flexible && peaks.map(|peak| peak.max.value).fold(0.0, f64::max) > 0.0
    };
    let hit: Vec<&str> = scene
        .stops
        .iter()
        .filter(|stop| is_hit(stop))
        .map(|stop| stop.name.as_str())
        .collect();
    (!hit.is_empty()).then(|| {
        format!(
            "the forces of end stops ({}) act in reactions, internal forces and deflections of spans, but not in gauges, \
             `rail_deflection` and the motion",
            hit.join(", ")
        )
    })
}

/// A run of more bounces than those up to which errors keep the accuracy. Their sum grows with the number of bounces.
fn many_bounces(scene: &Scene, run: &Run) -> Option<String> {
    (run.bounces > Run::BOUNCES).then(|| {
        let each = scene.accuracy / Run::BOUNCES;
        format!(
            "the wheels bounce for about {:.0} cycles with little damping, and the errors of all cycles accumulate: \
             beyond {:.0} cycles `accuracy` is that of {:.0} cycles, an error of {} per cycle, {} in total",
            run.bounces,
            Run::BOUNCES,
            Run::BOUNCES,
            number(rounded(each, 2)),
            number(rounded(each * run.bounces, 2))
        )
    })
}

/// A run in which a flange or a stop strikes.
fn after_strike(scene: &Scene, input: &SimulationInput, run: &Run) -> Option<String> {
    let strike = run.strike?;
    let what = match strike.by {
        StruckBy::Flange(wheel) => {
            format!(
                "the flange of {}",
                input
                    .wheels
                    .get(wheel)
                    .map_or("a wheel", |wheel| wheel.name.as_str())
            )
        }
        StruckBy::Stop(index) => {
            let names = scene
                .stops
                .iter()
                .flat_map(|stop| stop.points.iter().map(|_| stop.name.as_str()));
            format!(
                "the stop {}",
                names.into_iter().nth(index).unwrap_or("of a body")
            )
        }
    };
    Some(format!(
        "impact of {what} at t = {:.6} s: afterwards small differences grow, and `accuracy` applies to the extremes \
         of the run, not to values at the same time",
        strike.time
    ))
}
