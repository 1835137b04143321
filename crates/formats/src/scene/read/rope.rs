//! Ropes of a scene.

use super::schedule::read_schedule;
use crate::check::Check;
use crate::scene::raw::{RawEnds, RawRope};
use crate::scene::values::actuator::Rope;
use crate::scene::values::body::Body;
use crate::text::fault::Fault;
use crate::text::names::{check_name, names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

/// Reads the ropes.
pub(super) fn read_all(
    raw: &[RawRope],
    bodies: &[Body],
    end: f64,
    check: &mut Check<'_>,
) -> Vec<Rope> {
    let root = Place::root();
    let list = root.key("ropes");
    let mut ropes: Vec<Rope> = Vec::new();
    for (index, raw) in raw.iter().enumerate() {
        let at = list.index(index);
        let Some(rope) = read(raw, index + 1, bodies, end, &at, check) else {
            continue;
        };
        if ropes.iter().any(|other| other.name == rope.name)
            || bodies.iter().any(|body| body.name == rope.name)
        {
            let expected = format!("the name \"{}\" is already used", rope.name);
            check.faults.add(
                Fault::new(&at, expected)
                    .hint("names of ropes and bodies are also names of columns"),
            );
        }
        ropes.push(rope);
    }
    ropes
}

fn read(
    raw: &RawRope,
    number: usize,
    bodies: &[Body],
    end: f64,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Rope> {
    let name = raw.name.clone().unwrap_or_else(|| format!("rope{number}"));
    check_name(&name, &at.key("name"), check.faults);
    let from = check.faults.require(&raw.from, at, "from");
    let from = from.and_then(|end| read_end(end, bodies, &at.key("from"), check));
    let to = check.faults.require(&raw.to, at, "to");
    let to = to.and_then(|end| read_end(end, bodies, &at.key("to"), check));
    let stiffness = check.required_positive(
        raw.stiffness,
        at,
        "EA",
        Dimension::FORCE,
        "a force: modulus times area",
    );
    let length = check.required_positive(
        raw.length,
        at,
        "length",
        Dimension::LENGTH,
        "unstretched length at time 0",
    );
    let damping = check.not_negative(
        raw.c.unwrap_or_default(),
        &at.key("c"),
        Dimension::DAMPING,
        "",
    );
    let place = at.key("speed");
    let still = vec![[0.0, 0.0]];
    let table = raw.speed.as_ref().unwrap_or(&still);
    let speed = read_schedule(table, &place, Dimension::SPEED, check)?;
    let turns = speed
        .turns()
        .chain(speed.breaks())
        .chain([end])
        .filter(|t| (0.0..=end).contains(t));
    if turns
        .map(|t| length - speed.integral(t))
        .any(|left| left <= 0.0)
        && length > 0.0
    {
        let fault = Fault::new(
            &place,
            "must not hoist more than the length of the rope before the end of the run",
        );
        check
            .faults
            .add(fault.hint("positive speeds shorten the rope"));
    }
    let (from, to) = (from?, to?);
    if from.0 == to.0 {
        let fault = Fault::new(at, "must join two bodies, or a body and a point in space");
        check
            .faults
            .add(fault.hint("an end without `body` is a point in space"));
    }
    Some(Rope {
        name,
        bodies: [from.0, to.0],
        at: [from.1, to.1],
        stiffness,
        damping,
        length,
        speed,
    })
}

fn read_end(
    raw: &RawEnds,
    bodies: &[Body],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<(Option<usize>, [f64; 3])> {
    let point = check.vector(raw.at.unwrap_or_default(), &at.key("at"), Dimension::LENGTH);
    let Some(name) = &raw.body else {
        if raw.at.is_none() {
            check.faults.add(Fault::new(
                at,
                "must have `body`, or `at` for a point in space",
            ));
        }
        return Some((None, point));
    };
    let known = names(bodies, |body| &body.name);
    let body = resolve(name, &known, "body", &at.key("body"), check.faults)?;
    Some((Some(body), point))
}
