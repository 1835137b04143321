//! The reason why a run stopped, with the names of its scene in place of the indices of the simulator.

use sim::{Error, Fall, Status};

use formats::scene::{DOFS, Scene, stepper_word};
use formats::text::number::{number, rounded};

/// The word for the status of a run in summaries, and a message where the run did not reach its end.
#[must_use]
pub fn status(status: &Status) -> (&'static str, Option<String>) {
    match status {
        Status::Done => ("done", None),
        Status::Ended(_) => ("ended by event", None),
        Status::Stopped => ("stopped", Some("the run was stopped".to_owned())),
        Status::StepTooSmall(t) => (
            "step too small",
            Some(format!(
                "the integration failed at t = {t} s: the step size became too small, or contacts opened and closed \
                 indefinitely"
            )),
        ),
        Status::TooManySteps {
            time,
            steps,
            expected,
        } => (
            "too many steps",
            Some(format!(
                "the run was given up at t = {} s: {steps} steps took it there, and it would take about {expected:.0e}: \
                 something vibrates far faster than the run is long, such as a small mass on a stiff wheel, or contacts \
                 that open and close; check masses, `k` and `c`, or use \"quasi-static\"",
                number(rounded(*time, 6))
            )),
        ),
        Status::TooLarge {
            time,
            stored,
            expected,
        } => (
            "too large",
            Some(format!(
                "the run was given up at t = {} s: its solution holds {:.1} GB there, and would hold about {:.0} GB: something \
                 vibrates fast in a structure of many unknowns; end the run sooner, use fewer `modes` or `elements`, or a \
                 coarser `accuracy`",
                number(rounded(*time, 6)),
                8e-9 * *stored as f64,
                8e-9 * expected,
            )),
        ),
        Status::Failed(t, error) => ("refused", Some(format!("at t = {t} s: {error}"))),
    }
}

/// The reason why a run did not reach its end, with the names of `scene`; `None` where it did.
#[must_use]
pub fn reason_incomplete(status: &Status, scene: &Scene) -> Option<String> {
    match status {
        Status::Failed(t, error) => {
            Some(format!("at t = {t:.4} s: {}", in_scene_names(error, scene)))
        }
        status => self::status(status).1,
    }
}

/// Smallest part of a fall that is named.
const NAMED: f64 = 0.1;

/// What is expected of a body that falls, how it falls, and a hint.
pub(crate) fn of_fall(fall: &Fall, scene: &Scene) -> (String, String) {
    let [_, y, _, roll, _, pitch] = fall.motion;
    // a body that tips turns about its outermost wheels, so that its origin may sink or rise
    let tips = [
        (roll > NAMED, "tips to its right (z > 0)"),
        (roll < -NAMED, "tips to its left (z < 0)"),
        (pitch > NAMED, "tips backwards (x < 0)"),
        (pitch < -NAMED, "tips forwards (x > 0)"),
    ];
    let tips: Vec<&str> = tips
        .iter()
        .filter(|part| part.0)
        .map(|part| part.1)
        .collect();
    let rises = tips.is_empty() && y > 0.0;
    let falls = match tips.as_slice() {
        [] if rises => "rises".to_owned(),
        [] => "sinks".to_owned(),
        tips => tips.join(" and "),
    };
    let carried = if scene.structures.iter().any(|one| one.carrier.is_some()) {
        ", and `at` of the structures on bodies"
    } else {
        ""
    };
    let hint = if rises {
        "its loads lift it off its rails: reduce `loads` at time 0, or give the body a `start`"
            .to_owned()
    } else {
        format!(
            "the centre of mass (`cg`) with the loads that the body carries or suspends must lie between its wheels: check \
             `at` and `tree` of the trucks{carried}, or give the body a `start`"
        )
    };
    (
        format!("its wheels cannot hold it under its weight and loads: it {falls}"),
        hint,
    )
}

/// The message of a simulation error with the names of `scene` in place of indices, and a hint where one is known.
#[must_use]
pub fn in_scene_names(error: &Error, scene: &Scene) -> String {
    let structure = |index: usize| {
        scene
            .structures
            .get(index)
            .map_or_else(|| format!("structure {index}"), |one| one.name.clone())
    };
    let body = |index: usize| {
        let known = scene
            .bodies
            .get(index)
            .map(|body| format!("\"{}\"", body.name));
        known.unwrap_or_else(|| format!("body {index}"))
    };
    match error {
        Error::Compliance {
            structure: s,
            source: splines::Error::OffRail { rail, x },
        } => {
            let found = scene
                .rails
                .iter()
                .find(|known| (known.structure, known.rail) == (*s, *rail));
            match found {
                Some(rail) => format!(
                    "a wheel runs off the end of rail {} at x = {x:.4}: the rail extends from {} to {}  hint: end \
                     earlier (`end.time`), or keep the body on its rail by a drive, a brake or an end stop (`stops`)",
                    rail.name,
                    number(rail.range[0]),
                    number(rail.range[1])
                ),
                None => error.to_string(),
            }
        }
        Error::Compliance {
            structure: s,
            source,
        } => format!("{}: {source}", structure(*s)),
        Error::NoInertia { body: b, dof } => format!(
            "{} is free in {}, but no mass has inertia in this motion  hint: give `inertia` [roll, yaw, pitch] about \
             the centre of mass, or remove the motion from `dof`",
            body(*b),
            DOFS[*dof as usize]
        ),
        Error::NoEquilibrium {
            time,
            fall: Some(fall),
        } => {
            let (why, hint) = of_fall(fall, scene);
            let own = body(fall.body);
            format!("no static equilibrium of {own} at t = {time}: {why}  hint: {hint}")
        }
        Error::Method { method, wanted } => {
            format!("the stepper \"{}\" needs {wanted}", stepper_word(*method))
        }
        Error::NoEquilibrium { fall: None, .. } => {
            format!("{error}  hint: give the bodies a `start`, from which they move to rest")
        }
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run that is given up for its size says when, and how large it was and would have been.
    #[test]
    fn a_run_that_grows_too_large_tells_its_size() {
        let (word, message) = status(&Status::TooLarge {
            time: 0.5,
            stored: 125_000_000,
            expected: 1e9,
        });
        let message = message.expect("a reason");
        assert_eq!(word, "too large");
        for part in ["t = 0.5 s", "holds 1.0 GB", "about 8 GB", "`modes`"] {
            assert!(message.contains(part), "{message}");
        }
    }
}
