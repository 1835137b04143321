//! Bodies pinned to bodies: trees of carriages, equalisers and bogies with mass.

use super::body::{Body, FREEDOMS};
use super::raw::RawBody;
use crate::check::Check;
use crate::entries::Entries;
use crate::fault::Fault;
use crate::place::Place;
use crate::units::Dimension;

/// Reads the pins into their bodies.
pub(super) fn read(raw: &Entries<RawBody>, bodies: &mut [Body], check: &mut Check<'_>) {
    let root = Place::root();
    let list = root.key("bodies");
    for (b, (name, raw)) in raw.0.iter().enumerate() {
        let own = list.key(name);
        let at = own.key("pinned");
        let Some(pin) = &raw.pinned else { continue };
        let to = check.faults.need(&pin.to, &at, "to").and_then(|to| {
            let known = super::names(bodies, |body| &body.name);
            super::resolve(to, &known, "body", &at.key("to"), check.faults)
        });
        let position = check.vector(pin.at.unwrap_or_default(), &at.key("at"), Dimension::LENGTH);
        for (key, given) in
            [("track", raw.track.is_some()), ("x0", raw.x0.is_some()), ("v0", raw.v0.is_some())]
        {
            if given {
                let fault = Fault::new(&own.key(key), format!("`{key}` cannot stand beside `pinned`"));
                check.faults.add(fault.at_key().hint("a pinned body goes where its pin goes"));
            }
        }
        let free = bodies[b].free;
        for (i, word) in FREEDOMS.iter().enumerate().take(3).filter(|(i, _)| free[*i]) {
            let fault = Fault::new(&own.key("dof"), format!("{word} of a pinned body is that of its pin"));
            check.faults.add(fault.hint("\"roll\", \"yaw\" and \"pitch\" can be free"));
            bodies[b].free[i] = false;
        }
        bodies[b].motion = super::Along::Held;
        let Some(to) = to else { continue };
        bodies[b].pinned = Some((to, position));
        if root_of(bodies, b).is_none() {
            let fault = Fault::new(&at.key("to"), "pins must not run in a circle");
            check.faults.add(fault.got(format!("\"{}\"", bodies[to].name)));
            bodies[b].pinned = None;
        }
    }
}

/// Body at the root of `b`'s tree, and how far ahead of its origin that of `b` is; `None` where pins run in a circle.
pub(super) fn root_of(bodies: &[Body], b: usize) -> Option<(usize, f64)> {
    seat_of(bodies, b).map(|(root, arm)| (root, arm[0]))
}

/// Body at the root of `b`'s tree, and where the origin of `b` is from that body's; `None` where pins run in a circle.
pub(super) fn seat_of(bodies: &[Body], b: usize) -> Option<(usize, [f64; 3])> {
    let (mut root, mut arm) = (b, [0.0; 3]);
    for _ in 0..=bodies.len() {
        let Some((to, pin)) = bodies[root].pinned else { return Some((root, arm)) };
        root = to;
        arm.iter_mut().zip(pin).for_each(|(arm, at)| *arm += at);
    }
    None
}

/// Whether a body of the tree below `b`, or `b` itself, has one of the trucks counted.
pub(super) fn is_carried(bodies: &[Body], b: usize, trucks: &[usize]) -> bool {
    (0..bodies.len()).filter(|&other| trucks[other] > 0).any(|other| {
        let mut at = other;
        while let (true, Some((to, _))) = (at != b, bodies[at].pinned) {
            at = to;
        }
        at == b
    })
}
