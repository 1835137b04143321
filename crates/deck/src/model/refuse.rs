//! Items of a scene that decks do not support, with their places in the scene file.

use adams::SplineValues;
use formats::scene::{self, BodyMotion, Scene};
use formats::text::fault::{Fault, Faults};
use formats::text::place::Place;

/// All items of a scene that decks do not support: ropes, stops, events, drives, brakes, loads, irregularities, pinned
/// bodies, foundations with masses, rails with too few stations and similar items. They are known before any structure is
/// solved.
#[must_use]
pub fn unsupported(scene: &Scene) -> Faults {
    let mut faults = Faults::default();
    structures(scene, &mut faults);
    stations(scene, &mut faults);
    bodies(scene, &mut faults);
    actions(scene, &mut faults);
    faults
}

fn structures(scene: &Scene, faults: &mut Faults) {
    let root = Place::root();
    let list = root.key("structures");
    for structure in &scene.structures {
        let at = list.key(&structure.name);
        let name = &structure.name;
        if structure.longitudinal {
            let why = format!(
                "decks do not support longitudinal compliance of rails: structure \"{name}\""
            );
            faults.add(Fault::new(&at.key("longitudinal"), why).hint("leave `longitudinal` out"));
        }
        if !structure.irregularities.is_empty() {
            let why = format!("decks do not support rail irregularities: structure \"{name}\"");
            faults
                .add(Fault::new(&at.key("irregularities"), why).hint("leave `irregularities` out"));
        }
        if structure.carrier.is_some() {
            let why =
                format!("structure \"{name}\": decks do not support structures carried by bodies");
            let hint = "leave out the trolley, and add its mass to the bridge";
            faults.add(Fault::new(&at.key("on"), why).hint(hint));
        }
        match structure.foundation {
            scene::Foundation::Rigid | scene::Foundation::Influence => {}
            scene::Foundation::Parts { .. }
            | scene::Foundation::Modal { .. }
            | scene::Foundation::Full { .. }
            | scene::Foundation::Ties { .. } => {
                let word = structure.foundation.word();
                let why =
                    format!("structure \"{name}\": decks do not support the foundation \"{word}\"");
                faults.add(
                    Fault::new(&at.key("foundation"), why).hint("use \"influence\" or \"rigid\""),
                );
            }
        }
    }
}

/// Refuses flexible rails under wheels with fewer stations than a SPLINE must have.
fn stations(scene: &Scene, faults: &mut Faults) {
    let root = Place::root();
    let list = root.key("structures");
    let least = SplineValues::MIN_POINTS;
    for (index, on_scene) in scene.rails.iter().enumerate() {
        let structure = &scene.structures[on_scene.structure];
        let stations = structure.rails[on_scene.rail].stations.len();
        let has_wheels = scene.trucks.iter().any(|truck| truck.rail == index);
        let is_flexible = structure.foundation == scene::Foundation::Influence;
        if is_flexible && has_wheels && stations < least {
            let key = match structure.origin {
                scene::Origin::Spec { .. } => "spec",
                scene::Origin::Tables { .. } => "tables",
            };
            let why = format!(
                "rail {} needs at least {least} stations for a deck",
                on_scene.name
            );
            let fault = Fault::new(&list.key(&structure.name).key(key), why).got(stations);
            faults.add(fault.hint("a SPLINE needs at least four x values"));
        }
    }
}

fn bodies(scene: &Scene, faults: &mut Faults) {
    let root = Place::root();
    let list = root.key("bodies");
    for body in &scene.bodies {
        let at = list.key(&body.name);
        let mut add = |what: &str, hint: &str| {
            faults.add(
                Fault::new(
                    &at,
                    format!("body \"{}\": decks do not support {what}", body.name),
                )
                .hint(hint),
            );
        };
        if body.in_space {
            add(
                "bodies in space",
                "leave it out, and add a PART to the deck by hand",
            );
        }
        if body.pinned.is_some() {
            let hint =
                "add its mass to the body that carries it, and give the truck a nested `tree`";
            add("bodies pinned to others", hint);
        }
        let hint = "use a motion of kind \"prescribed\", or add an SFORCE to the deck by hand";
        match (&body.motion, body.brake) {
            (BodyMotion::Driven(_), _) => add("drives", hint),
            (_, Some(_)) => add("brakes", hint),
            _ => {}
        }
    }
}

fn actions(scene: &Scene, faults: &mut Faults) {
    let root = Place::root();
    let mut add = |list: &str, index: usize, why: String, hint: &str| {
        faults.add(Fault::new(&root.key(list).index(index), why).hint(hint));
    };
    for (index, rope) in scene.ropes.iter().enumerate() {
        let hint = "leave `ropes` and suspended bodies out, and add an SFORCE to the deck by hand";
        add(
            "ropes",
            index,
            format!("decks do not support ropes: \"{}\"", rope.name),
            hint,
        );
    }
    for (index, event) in scene.events.iter().enumerate() {
        let hint = "leave `events` out, and add a SENSOR to the deck by hand";
        add(
            "events",
            index,
            format!("decks do not support events: \"{}\"", event.name),
            hint,
        );
    }
    for (index, stop) in scene.stops.iter().enumerate() {
        let hint = "leave `stops` out, and add an SFORCE with IMPACT to the deck by hand";
        add(
            "stops",
            index,
            format!("decks do not support stops: \"{}\"", stop.name),
            hint,
        );
    }
    for (index, load) in scene.loads.iter().enumerate() {
        let why = format!(
            "body \"{}\": decks do not support loads",
            scene.bodies[load.body].name
        );
        add(
            "loads",
            index,
            why,
            "leave `loads` out, and add an SFORCE to the deck by hand",
        );
    }
    let motions = root.key("motions");
    for spin in &scene.spins {
        let why = format!(
            "decks do not support prescribed wheel rotation: truck \"{}\"",
            scene.trucks[spin.truck].name
        );
        let hint = "leave the motion out, and add a MOTION to the deck by hand";
        faults.add(Fault::new(&motions, why).hint(hint));
    }
}
