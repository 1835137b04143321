//! Bodies of a scene and their motion along their rails.

use sim::MotionKind;

use super::actuator::read_drive;
use super::schedule::{MotionTable, motion_tables, read_profile};
use super::spin;
use crate::check::Check;
use crate::scene::raw::{RawBody, RawMotion, RawStart};
use crate::scene::values::body::{Body, BodyMotion, DOFS, SPACE};
use crate::text::entries::Entries;
use crate::text::fault::{Fault, alternatives, nearest, number};
use crate::text::names::{names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

pub(super) fn read(
    name: &str,
    raw: &RawBody,
    at: &Place<'_>,
    gravity: Option<f64>,
    check: &mut Check<'_>,
) -> Body {
    let mass = read_mass(raw, at, gravity, check);
    let mut inertia = [0.0; 3];
    let place = at.key("inertia");
    for (index, value) in raw.inertia.unwrap_or_default().into_iter().enumerate() {
        let hint = "[roll, yaw, pitch]; 0 for none";
        inertia[index] = check.not_negative(value, &place.index(index), Dimension::INERTIA, hint);
    }
    let cg = check.vector(raw.cg.unwrap_or_default(), &at.key("cg"), Dimension::LENGTH);
    let free = read_dofs(raw, at, check);
    let x0 = check.number(raw.x0.unwrap_or_default(), &at.key("x0"), Dimension::LENGTH);
    let v0 = check.number(raw.v0.unwrap_or_default(), &at.key("v0"), Dimension::SPEED);
    let start = raw
        .start
        .as_ref()
        .map(|start| read_start(start, &free, &at.key("start"), check));
    let motion = if free[0] {
        BodyMotion::Free
    } else {
        BodyMotion::Held
    };
    Body {
        name: name.to_owned(),
        mass,
        by_mass: raw.mass.is_some(),
        inertia,
        cg,
        free,
        in_space: raw
            .dof
            .iter()
            .flatten()
            .any(|word| SPACE.contains(&word.as_str())),
        track: Vec::new(),
        x0,
        v0,
        start,
        motion,
        pinned: None,
        brake: None,
    }
}

fn read_mass(raw: &RawBody, at: &Place<'_>, gravity: Option<f64>, check: &mut Check<'_>) -> f64 {
    match (raw.mass, raw.weight) {
        (Some(mass), None) => check.positive(
            mass,
            &at.key("mass"),
            Dimension::MASS,
            "force time^2 / length",
        ),
        (None, Some(weight)) => {
            let weight = check.positive(weight, &at.key("weight"), Dimension::FORCE, "");
            if gravity == Some(0.0) {
                let fault = Fault::new(&at.key("weight"), "requires a positive `gravity`")
                    .hint("or specify `mass`");
                check.faults.add(fault);
            }
            weight / gravity.filter(|g| *g > 0.0).unwrap_or(1.0)
        }
        (found, _) => {
            let found = if found.is_some() { "both" } else { "neither" };
            let hint = "`weight` is a force; `mass` is force time^2 / length";
            check.faults.add(
                Fault::new(at, "must have either `mass` or `weight`")
                    .got(found)
                    .hint(hint),
            );
            1.0
        }
    }
}

fn read_dofs(raw: &RawBody, at: &Place<'_>, check: &mut Check<'_>) -> [bool; 6] {
    let mut free = [false; 6];
    let Some(words) = check.faults.require(&raw.dof, at, "dof") else {
        return free;
    };
    let place = at.key("dof");
    if words.iter().any(|word| SPACE.contains(&word.as_str())) {
        if *words != SPACE {
            let fault = Fault::new(
                &place,
                "a body in space must have \"X\", \"Y\" and \"Z\", in this order",
            );
            check
                .faults
                .add(fault.hint("a body on a track has x, y, z, roll, yaw, pitch"));
        }
        return [true, true, true, false, false, false];
    }
    for (index, word) in words.iter().enumerate() {
        let item = place.index(index);
        match DOFS.iter().position(|known| known == word) {
            Some(known) if free[known] => {
                check.faults.add(
                    Fault::new(&item, "must be listed only once").got(format!("\"{word}\" again")),
                );
            }
            Some(known) => free[known] = true,
            None => {
                let mut fault = Fault::new(&item, format!("must be {}", alternatives(&DOFS)));
                fault = fault.got(format!("\"{word}\""));
                if let Some(near) = nearest(word, &DOFS) {
                    fault = fault.hint(format!("did you mean \"{near}\"?"));
                }
                check.faults.add(fault);
            }
        }
    }
    free
}

fn read_start(raw: &RawStart, free: &[bool; 6], at: &Place<'_>, check: &mut Check<'_>) -> [f64; 5] {
    let given = [raw.y, raw.z, raw.roll, raw.yaw, raw.pitch];
    let mut start = [0.0; 5];
    for (index, value) in given.into_iter().enumerate() {
        let Some(value) = value else { continue };
        let word = DOFS[index + 1];
        let dimension = if index < 2 {
            Dimension::LENGTH
        } else {
            Dimension::NUMBER
        };
        start[index] = check.number(value, &at.key(word), dimension);
        if !free[index + 1] {
            let fault =
                Fault::new(&at.key(word), format!("`{word}` is not free")).hint("list it in `dof`");
            check.faults.add(fault);
        }
    }
    start
}

/// Sets the motions of the bodies.
pub(super) fn read_motions(
    raw: &[RawMotion],
    raw_bodies: &Entries<RawBody>,
    bodies: &mut [Body],
    check: &mut Check<'_>,
) {
    let root = Place::root();
    let list = root.key("motions");
    let mut first: Vec<Option<usize>> = vec![None; bodies.len()];
    for (index, motion) in raw
        .iter()
        .enumerate()
        .filter(|(_, motion)| !spin::is_spin(motion))
    {
        let at = list.index(index);
        let body = read_subject(motion, bodies, &at, check);
        let Some(body) = body else {
            read_kind(motion, &at, check);
            continue;
        };
        if let Some(earlier) = first[body].replace(index) {
            let expected = format!(
                "body {} already has a motion in motions[{earlier}]",
                bodies[body].name
            );
            check
                .faults
                .add(Fault::new(&at, expected).hint("a body can have one motion along its rail"));
            continue;
        }
        if bodies[body].in_space {
            let fault = Fault::new(
                &at.key("body"),
                format!("body {} is not on a rail", bodies[body].name),
            );
            check
                .faults
                .add(fault.hint(
                    "the motion of a body in space follows from its ropes, stops and weight",
                ));
            continue;
        }
        if raw_bodies.0[body].1.pinned.is_some() {
            let fault = Fault::new(
                &at.key("body"),
                format!("body {} is pinned", bodies[body].name),
            );
            check
                .faults
                .add(fault.hint("prescribe the motion of the body that carries it"));
            continue;
        }
        read_motion(motion, &raw_bodies.0[body].1, &mut bodies[body], &at, check);
    }
    for (body, (name, raw)) in bodies.iter().zip(&raw_bodies.0) {
        let at = root.key("bodies");
        let at = at.key(name);
        if raw.v0.is_some() && raw.pinned.is_none() && body.motion == BodyMotion::Held {
            let fault = Fault::new(&at.key("v0"), "the body cannot move along its rail");
            check.faults.add(fault.hint("list \"x\" in `dof`"));
        }
    }
}

/// The body of a motion along the rail.
fn read_subject(
    motion: &RawMotion,
    bodies: &[Body],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<usize> {
    for (key, given) in [
        ("truck", motion.truck.is_some()),
        ("wheel", motion.wheel.is_some()),
    ] {
        if given {
            let fault = Fault::new(
                &at.key(key),
                format!("`{key}` is only available in the motion of a spin"),
            );
            check
                .faults
                .add(fault.at_key().hint("such a motion has \"dof\": \"spin\""));
        }
    }
    let body = check
        .faults
        .require(&motion.body, at, "body")
        .and_then(|name| {
            let known = names(bodies, |body| &body.name);
            resolve(name, &known, "body", &at.key("body"), check.faults)
        });
    if let Some(dof) = check.faults.require(&motion.dof, at, "dof") {
        let place = at.key("dof");
        if DOFS[1..].contains(&dof.as_str()) {
            let fault = Fault::new(
                &place,
                format!("a motion of {dof} is not available in this version"),
            );
            check
                .faults
                .add(fault.hint("motions of x, and of \"spin\" for wheels, are available"));
        } else {
            check.faults.one_of(dof, &place, &[("x", ())]);
        }
    }
    body
}

/// The keywords of `kind`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Prescribed,
    Drive,
    Free,
}

fn read_kind(motion: &RawMotion, at: &Place<'_>, check: &mut Check<'_>) -> Option<Kind> {
    let kind = check.faults.require(&motion.kind, at, "kind")?;
    let words = [
        ("prescribed", Kind::Prescribed),
        ("drive", Kind::Drive),
        ("free", Kind::Free),
    ];
    check.faults.one_of(kind, &at.key("kind"), &words)
}

fn read_motion(
    motion: &RawMotion,
    raw: &RawBody,
    body: &mut Body,
    at: &Place<'_>,
    check: &mut Check<'_>,
) {
    let Some(kind) = read_kind(motion, at, check) else {
        return;
    };
    for (key, given, holds, owner) in [
        (
            "gain",
            motion.gain.is_some(),
            kind == Kind::Drive,
            "\"drive\"",
        ),
        (
            "max_force",
            motion.max_force.is_some(),
            kind == Kind::Drive,
            "\"drive\"",
        ),
        (
            "brake",
            motion.brake.is_some(),
            kind != Kind::Prescribed,
            "\"drive\" or \"free\"",
        ),
    ] {
        if given && !holds {
            let fault = Fault::new(
                &at.key(key),
                format!("`{key}` is only available in the motion {owner}"),
            );
            check.faults.add(fault.at_key());
        }
    }
    let tables = motion_tables(
        motion,
        [Dimension::LENGTH, Dimension::SPEED, Dimension::ACCELERATION],
    );
    match kind {
        Kind::Prescribed => read_prescribed(&tables, raw, body, at, check),
        Kind::Drive | Kind::Free => read_unprescribed(motion, kind, &tables, body, at, check),
    }
}

/// Reads a motion that follows from forces: a free motion, or one with a drive.
fn read_unprescribed(
    motion: &RawMotion,
    kind: Kind,
    tables: &[MotionTable<'_>],
    body: &mut Body,
    at: &Place<'_>,
    check: &mut Check<'_>,
) {
    for (key, what, ..) in tables {
        if kind == Kind::Free || *what != MotionKind::Speed {
            let expected = format!("`{key}` is only available in the motion \"prescribed\"");
            check
                .faults
                .add(Fault::new(&at.key(key), expected).at_key());
        }
    }
    if !body.free[0] {
        let expected = format!(
            "body {} cannot move freely: \"x\" is not in its `dof`",
            body.name
        );
        check.faults.add(Fault::new(at, expected));
    }
    body.brake = motion.brake.map(|time| {
        check.not_negative(
            time,
            &at.key("brake"),
            Dimension::TIME,
            "time from which the brakes are on",
        )
    });
    let drive = if kind == Kind::Drive {
        read_drive(motion, at, check)
    } else {
        None
    };
    body.motion = drive.map_or(BodyMotion::Free, BodyMotion::Driven);
}

/// Reads a prescribed motion. `x0` and `v0` of the body must agree with it.
fn read_prescribed(
    tables: &[MotionTable<'_>],
    raw: &RawBody,
    body: &mut Body,
    at: &Place<'_>,
    check: &mut Check<'_>,
) {
    let Some(travel) = read_profile(tables, [body.x0, body.v0], at, check) else {
        return;
    };
    let what = tables[0].1;
    let begin = travel.at(0.0);
    let clashes = [
        ("x0", what == MotionKind::Position, raw.x0, begin.x),
        ("v0", what != MotionKind::Acceleration, raw.v0, begin.v),
    ];
    for (key, fixed, own, table) in clashes {
        if let Some(own) = own.filter(|own| fixed && *own != table) {
            let root = Place::root();
            let at = root.key("bodies");
            let at = at.key(&body.name);
            let expected = format!(
                "must be {}, the value of the motion at time 0",
                number(table)
            );
            check.faults.add(
                Fault::new(&at.key(key), expected)
                    .got(number(own))
                    .hint("leave it out, or change the motion"),
            );
        }
    }
    (body.x0, body.v0) = (begin.x, begin.v);
    body.motion = BodyMotion::Prescribed(travel);
}
