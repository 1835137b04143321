//! Bodies that are pinned to other bodies, such as trees of carriages, equalisers and bogies with mass.

use crate::check::Check;
use crate::scene::raw::RawBody;
use crate::scene::values::body::{Body, BodyMotion, DOFS, root_of};
use crate::text::entries::Entries;
use crate::text::fault::Fault;
use crate::text::names::{names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

/// Sets the pins of the bodies.
pub(super) fn read(raw: &Entries<RawBody>, bodies: &mut [Body], check: &mut Check<'_>) {
    let root = Place::root();
    let list = root.key("bodies");
    for (b, (name, raw)) in raw.0.iter().enumerate() {
        let own = list.key(name);
        let at = own.key("pinned");
        let Some(pin) = &raw.pinned else { continue };
        let to = check.faults.require(&pin.to, &at, "to").and_then(|to| {
            let known = names(bodies, |body| &body.name);
            resolve(to, &known, "body", &at.key("to"), check.faults)
        });
        let position = check.vector(pin.at.unwrap_or_default(), &at.key("at"), Dimension::LENGTH);
        for (key, given) in [
            ("track", raw.track.is_some()),
            ("x0", raw.x0.is_some()),
            ("v0", raw.v0.is_some()),
        ] {
            if given {
                let fault = Fault::new(
                    &own.key(key),
                    format!("`{key}` cannot be combined with `pinned`"),
                );
                check.faults.add(
                    fault
                        .at_key()
                        .hint("the position of a pinned body follows from its pin"),
                );
            }
        }
        let free = bodies[b].free;
        for (i, word) in DOFS.iter().enumerate().take(3).filter(|(i, _)| free[*i]) {
            let fault = Fault::new(
                &own.key("dof"),
                format!("{word} of a pinned body follows from its pin and cannot be free"),
            );
            check
                .faults
                .add(fault.hint("\"roll\", \"yaw\" and \"pitch\" can be free"));
            bodies[b].free[i] = false;
        }
        bodies[b].motion = BodyMotion::Held;
        let Some(to) = to else { continue };
        bodies[b].pinned = Some((to, position));
        if root_of(bodies, b).is_none() {
            let fault = Fault::new(&at.key("to"), "pins must not form a closed loop");
            check
                .faults
                .add(fault.got(format!("\"{}\"", bodies[to].name)));
            bodies[b].pinned = None;
        }
    }
}
