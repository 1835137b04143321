//! Why a run stopped, with the names of its scene in place of the simulator's indices.

use sim::{Error, Status};

use formats::scene::{DOFS, Scene};

/// The word of a run's status in summaries, and a message where the run did not reach its end.
#[must_use]
pub fn status(status: &Status) -> (&'static str, Option<String>) {
    match status {
        Status::Done => ("done", None),
        Status::Ended(_) => ("ended by event", None),
        Status::Stopped => ("stopped", Some("the run was stopped".to_owned())),
        Status::StepTooSmall(t) => (
            "step too small",
            Some(format!(
                "no step was small enough at t = {t} s, or contacts opened and closed without end: the motion cannot be \
                 followed"
            )),
        ),
        Status::Failed(t, error) => ("refused", Some(format!("at t = {t} s: {error}"))),
    }
}

/// Why a run did not reach its end, with the names of `scene`; `None` where it did.
#[must_use]
pub fn reason_incomplete(status: &Status, scene: &Scene) -> Option<String> {
    match status {
        Status::Failed(t, error) => Some(format!("at t = {t:.4} s: {}", in_scene_names(error, scene))),
        status => self::status(status).1,
    }
}

/// The message of a simulation error with the names of `scene` in place of indices, and a hint where one is known.
#[must_use]
pub fn in_scene_names(error: &Error, scene: &Scene) -> String {
    let structure = |index: usize| {
        scene.structures.get(index).map_or_else(|| format!("structure {index}"), |one| one.name.clone())
    };
    let body = |index: usize| {
        let known = scene.bodies.get(index).map(|body| format!("\"{}\"", body.name));
        known.unwrap_or_else(|| format!("body {index}"))
    };
    match error {
        Error::Compliance { structure: s, source: splines::Error::OffRail { rail, x } } => {
            let found = scene.rails.iter().find(|known| (known.structure, known.rail) == (*s, *rail));
            match found {
                Some(rail) => format!(
                    "a wheel leaves the end of rail {} at x = {x:.4}: the rail runs from {} to {}  hint: end earlier \
                     (`end.time`), or hold the body on its rail by a drive, a brake or an end stop (`stops`)",
                    rail.name, rail.range[0], rail.range[1]
                ),
                None => error.to_string(),
            }
        }
        Error::Compliance { structure: s, source } => format!("{}: {source}", structure(*s)),
        Error::NoInertia { body: b, dof: freedom } => format!(
            "{} is free in {}, and nothing has inertia of its own there  hint: give `inertia` [roll, yaw, pitch] about the \
             centre of mass, or take it out of `dof`",
            body(*b),
            DOFS[*freedom as usize]
        ),
        Error::NoEquilibrium { .. } => {
            let carried = if scene.structures.iter().any(|one| one.carrier.is_some()) {
                ", at `at` of the structures on bodies"
            } else {
                ""
            };
            format!(
                "{error}  hint: each centre of mass (`cg`, and what hangs or rides on the body) must lie between its \
                 wheels: look at `at` and `tree` of the trucks{carried}, or give the body a `start`"
            )
        }
        _ => error.to_string(),
    }
}
