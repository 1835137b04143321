//! Conversion of a scene as written to a checked scene.

use super::files::Files;
use super::rail::rail_named;
use super::{
    actuator, body, event, inertia, method, mount, output, pin, practice, rope, spin, stop,
    structure, truck, truck_spacing, wheel,
};
use crate::check::Check;
use crate::limits::{BODIES, HISTORY_BYTES, ROW_NUMBERS, WHEELS};
use crate::scene::raw::RawScene;
use crate::scene::values::body::{Body, BodyMotion, SPACE, is_carried, root_of};
use crate::scene::values::scene::{Analysis, FORMAT, Scene, SceneRail};
use crate::scene::values::structure::Structure;
use crate::scene::values::truck::Truck;
use crate::scene::values::wheel::WheelKind;
use crate::text::fault::{Fault, Faults, number};
use crate::text::names::check_name;
use crate::text::place::Place;
use crate::units::{Dimension, Scale, Units};

/// Default relative error tolerance of the time steps.
const ACCURACY: f64 = 1e-4;

/// Default number of rows of a history.
const ROWS: f64 = 1000.0;

/// Checks a scene. Faults of the scene are added to `faults`, and faults of the files to which it refers to `files`.
///
/// Members are read in the order of their references: structures and their rails, bodies, pinned and carried bodies,
/// wheels, ropes, trucks, and then the actions on them. An invalid member is replaced by a default or omitted, so
/// that the others can be checked. Checks that involve several members are skipped unless all of them are valid.
pub(in crate::scene) fn read(
    raw: &RawScene,
    file: &str,
    files: &mut Files<'_>,
    faults: &mut Faults,
) -> Option<Scene> {
    let root = Place::root();
    crate::spec::format(&raw.format, FORMAT, &root, faults);
    let units = Units::read(&raw.units, &root, faults);
    let known = units.unwrap_or(Units::SI);
    let mut check = Check {
        faults,
        scale: Scale {
            from: known,
            to: known,
        },
    };
    let check = &mut check;
    let name = raw.name.clone().unwrap_or_else(|| crate::spec::stem(file));
    if raw.name.is_some() {
        check_name(&name, &root.key("name"), check.faults);
    }
    let gravity = read_gravity(raw, &root, check);
    let mut structures = read_structures(raw, gravity, &root, files, check);
    let rails = rails_of(&structures);
    let all_structures = structures.len() == raw.structures.0.len();
    let mut bodies = read_bodies(raw, gravity, all_structures.then_some(&rails), &root, check);
    pin::read(&raw.bodies, &mut bodies, check);
    body::read_motions(&raw.motions, &raw.bodies, &mut bodies, check);
    mount::read(&raw.structures, &mut structures, &bodies, check);
    let loads = actuator::read_loads(&raw.loads, &bodies, check);
    let wheels = read_wheels(raw, &root, check);
    let end = match check.faults.require(&raw.end, &root, "end") {
        Some(end) => {
            check.required_positive(end.time, &root.key("end"), "time", Dimension::TIME, "")
        }
        None => 1.0,
    };
    let ropes = rope::read_all(&raw.ropes, &bodies, end, check);
    let output = output::read(raw, &structures, &rails, &root, check);
    let mut scene = Scene {
        name,
        output,
        units: known,
        gravity: gravity.unwrap_or_default(),
        analysis: read_analysis(raw, &root, check),
        rails: if all_structures { rails } else { Vec::new() },
        structures,
        bodies,
        wheels,
        trucks: Vec::new(),
        spins: Vec::new(),
        loads,
        ropes,
        stops: Vec::new(),
        events: Vec::new(),
        practice: None,
        lateral_section: practice::lateral_section(&raw.practice, &root, check),
        end,
        dt: read_interval(raw, end, &root, check),
        accuracy: check.positive(
            raw.accuracy.unwrap_or(ACCURACY),
            &root.key("accuracy"),
            Dimension::NUMBER,
            "a relative error, such as 1e-4",
        ),
        stepping: method::read(raw, &root, check),
    };
    read_trucks(raw, &mut scene, &root, check);
    check_rows(&scene, &root, check);
    read_actions(raw, &mut scene, &root, check);
    units.map(|_| scene)
}

/// Reads the bodies and, if the rails of all structures are known (`rails`), their references to rails.
fn read_bodies(
    raw: &RawScene,
    gravity: Option<f64>,
    rails: Option<&Vec<SceneRail>>,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<Body> {
    let mut bodies = Vec::new();
    let place = root.key("bodies");
    if raw.bodies.0.is_empty() {
        check
            .faults
            .add(Fault::new(root, "must have at least one body in `bodies`").of_value());
    }
    check.items(raw.bodies.0.len(), &BODIES, &place);
    for (name, raw) in &raw.bodies.0 {
        let at = place.key(name);
        check_name(name, &at, check.faults);
        let mut body = body::read(name, raw, &at, gravity, check);
        if let Some(rails) = rails {
            let track = at.key("track");
            for (index, rail) in raw.track.iter().flatten().enumerate() {
                body.track
                    .extend(rail_named(rail, rails, &track.index(index), check.faults));
            }
        }
        bodies.push(body);
    }
    bodies
}

fn read_wheels(raw: &RawScene, root: &Place<'_>, check: &mut Check<'_>) -> Vec<WheelKind> {
    let mut wheels = Vec::new();
    let place = root.key("wheels");
    for (name, raw) in &raw.wheels.0 {
        let at = place.key(name);
        check_name(name, &at, check.faults);
        wheels.push(wheel::read(name, raw, &at, check));
    }
    wheels
}

/// Reads the actions on bodies and trucks, and carries out the checks that involve several members.
fn read_actions(raw: &RawScene, scene: &mut Scene, root: &Place<'_>, check: &mut Check<'_>) {
    let all_trucks = scene.trucks.len() == raw.trucks.len();
    if all_trucks {
        scene.spins = spin::read_all(&raw.motions, scene, check);
    }
    scene.stops = stop::read_all(&raw.stops, scene, check);
    event::fit_brakes(&raw.events, &mut scene.bodies);
    scene.events = event::read_all(&raw.events, scene, check);
    if all_trucks {
        actuator::check_wheels(raw, scene, check.faults);
    }
    if all_trucks && truck_spacing::check(scene, check.faults) {
        scene.practice = practice::read(&raw.practice, scene, root, check);
    }
    let before = check.faults.clone();
    let bodies_on_rails = ["structures", "bodies", "trucks"];
    let is_right = |more: &[&str]| !before.concern(&bodies_on_rails) && !before.concern(more);
    if is_right(&["loads"]) {
        mount::check(scene, check.faults);
    }
    if is_right(&["motions", "end"]) {
        check_travel(raw, scene, root, check.faults);
    }
    if is_right(&["motions"]) {
        inertia::check(raw, scene, root, check.faults);
    }
    if is_right(&[
        "wheels", "motions", "stepper", "step", "analysis", "ropes", "stops", "loads", "events",
    ]) {
        method::suits(scene, root, check.faults);
    }
}

fn read_gravity(raw: &RawScene, root: &Place<'_>, check: &mut Check<'_>) -> Option<f64> {
    let hint = "a magnitude: it always acts downwards";
    match raw.gravity {
        Some(gravity) => {
            Some(check.not_negative(gravity, &root.key("gravity"), Dimension::ACCELERATION, hint))
        }
        None => {
            let fault = Fault::new(root, "missing key `gravity`").of_value();
            check
                .faults
                .add(fault.hint("such as 32.174 with ft and s, 9.80665 with m and s, or 0"));
            None
        }
    }
}

fn read_structures(
    raw: &RawScene,
    gravity: Option<f64>,
    root: &Place<'_>,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Vec<Structure> {
    if raw.structures.0.is_empty() {
        check
            .faults
            .add(Fault::new(root, "must have at least one structure in `structures`").of_value());
    }
    let place = root.key("structures");
    let mut structures = Vec::new();
    let all = &raw.structures.0;
    for (name, raw) in all {
        let at = place.key(name);
        check_name(name, &at, check.faults);
        let others: Vec<&str> = all
            .iter()
            .map(|(other, _)| other.as_str())
            .filter(|other| other != name)
            .collect();
        structures.extend(structure::read(
            name, &others, raw, &at, files, gravity, check,
        ));
    }
    structures
}

fn rails_of(structures: &[Structure]) -> Vec<SceneRail> {
    let mut rails = Vec::new();
    for (index, structure) in structures.iter().enumerate() {
        for (rail, outline) in structure.rails.iter().enumerate() {
            let name = format!("{}.{}", structure.name, outline.name);
            rails.push(SceneRail {
                name,
                structure: index,
                rail,
                range: outline.range,
            });
        }
    }
    rails
}

fn read_analysis(raw: &RawScene, root: &Place<'_>, check: &mut Check<'_>) -> Analysis {
    let words = [
        ("dynamic", Analysis::Dynamic),
        ("quasi-static", Analysis::QuasiStatic),
    ];
    match &raw.analysis {
        Some(word) => check
            .faults
            .one_of(word, &root.key("analysis"), &words)
            .unwrap_or(Analysis::Dynamic),
        None => Analysis::Dynamic,
    }
}

fn read_interval(raw: &RawScene, end: f64, root: &Place<'_>, check: &mut Check<'_>) -> f64 {
    let Some(dt) = raw.output.as_ref().and_then(|output| output.dt) else {
        return end / ROWS;
    };
    let output = root.key("output");
    let place = output.key("dt");
    check.positive(
        dt,
        &place,
        Dimension::TIME,
        "time between two rows of the history",
    )
}

/// Checks the memory that the rows of the history need.
fn check_rows(scene: &Scene, root: &Place<'_>, check: &mut Check<'_>) {
    let wheels: usize = scene
        .trucks
        .iter()
        .map(|truck| truck.wheel_offsets().len())
        .sum();
    let [own, body, wheel] = ROW_NUMBERS;
    let numbers = own + body * scene.bodies.len() as f64 + wheel * wheels as f64;
    let most = HISTORY_BYTES / (8.0 * numbers);
    if scene.dt > 0.0 && scene.end / scene.dt > most {
        let output = root.key("output");
        let expected = format!("must be at least {}", short(scene.end / most));
        let fault = Fault::new(&output.key("dt"), expected).got(number(scene.dt));
        check.faults.add(fault.hint(format!(
            "the {} rows of this history would take more than {} GB",
            format_args!("{:.1e}", scene.end / scene.dt),
            number(HISTORY_BYTES / 1e9)
        )));
    }
}

/// A positive number rounded up to two digits.
fn short(value: f64) -> String {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    format!("{:.1e}", (value / unit).ceil() * unit)
}

fn read_trucks(raw: &RawScene, scene: &mut Scene, root: &Place<'_>, check: &mut Check<'_>) {
    let place = root.key("trucks");
    if raw.trucks.is_empty() {
        check.faults.add(
            Fault::new(root, "must have at least one truck in `trucks`")
                .of_value()
                .hint("trucks carry the bodies on the rails"),
        );
    }
    let wheels: usize = raw.trucks.iter().map(truck::count).sum();
    if wheels > WHEELS.most {
        let fault = Fault::new(
            &place,
            format!("must have at most {} wheels in total", WHEELS.most),
        );
        check.faults.add(fault.got(wheels).hint(WHEELS.reason));
        return;
    }
    let mut counts = vec![0; scene.bodies.len()];
    let mut trucks: Vec<Truck> = Vec::new();
    for (index, raw) in raw.trucks.iter().enumerate() {
        let at = place.index(index);
        let owner = match &raw.body {
            Some(name) => scene.bodies.iter().position(|body| body.name == *name),
            None => (!scene.bodies.is_empty()).then_some(0),
        };
        let number = owner.map_or(1, |owner| {
            counts[owner] += 1;
            counts[owner]
        });
        let Some(truck) = truck::read(
            raw,
            number,
            &at,
            &scene.bodies,
            &scene.rails,
            &scene.wheels,
            check,
        ) else {
            continue;
        };
        if trucks.iter().any(|other| other.name == truck.name) {
            let expected = format!(
                "the name \"{}\" is already used by another truck",
                truck.name
            );
            check.faults.add(Fault::new(&at.key("name"), expected));
        }
        trucks.push(truck);
    }
    let place = root.key("bodies");
    let owned: usize = counts.iter().sum();
    let carried: Vec<bool> = (0..scene.bodies.len())
        .map(|b| is_carried(&scene.bodies, b, &counts))
        .collect();
    for (index, body) in scene.bodies.iter_mut().enumerate() {
        let dof = raw.bodies.0[index].1.dof.iter().flatten();
        let in_space = dof.into_iter().any(|word| SPACE.contains(&word.as_str()));
        if !carried[index] && owned == raw.trucks.len() && owned > 0 && !in_space {
            let fault = Fault::new(&place.key(&body.name), "no truck carries this body").at_key();
            check
                .faults
                .add(fault.hint(format!("add a truck with \"body\": \"{}\"", body.name)));
        }
        if body.track.is_empty() {
            for truck in trucks.iter().filter(|truck| truck.body == index) {
                if !body.track.contains(&truck.rail) {
                    body.track.push(truck.rail);
                }
            }
        }
        if scene.analysis == Analysis::QuasiStatic && body.motion.is_free() {
            let fault = Fault::new(
                &place.key(&body.name),
                "in a quasi-static analysis every x must be prescribed or fixed",
            );
            check
                .faults
                .add(fault.hint("prescribe a motion of x, or remove \"x\" from `dof`"));
        }
    }
    scene.trucks = trucks;
}

/// Checks that every wheel is on its rail at the start and, if the travel is prescribed, until the end.
fn check_travel(raw: &RawScene, scene: &Scene, root: &Place<'_>, faults: &mut Faults) {
    let trucks = root.key("trucks");
    let motions = root.key("motions");
    let bodies = root.key("bodies");
    for (index, truck) in scene.trucks.iter().enumerate() {
        let Some((owner, ahead)) = root_of(&scene.bodies, truck.body) else {
            continue;
        };
        let body = &scene.bodies[owner];
        let rail = &scene.rails[truck.rail];
        let at = trucks.index(index);
        let left = truck
            .wheel_offsets()
            .into_iter()
            .enumerate()
            .filter_map(|(index, offset)| {
                let offset = ahead + offset;
                let (time, x) = leaves(
                    body,
                    [rail.range[0] - offset, rail.range[1] - offset],
                    scene.end,
                )?;
                Some((index + 1, time, x + offset))
            });
        let Some((wheel, time, x)) = left.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            continue;
        };
        let own = bodies.key(&body.name);
        let (x0, tree) = (own.key("x0"), at.key("tree"));
        let motion = raw
            .motions
            .iter()
            .position(|motion| motion.body.as_ref() == Some(&body.name));
        let given = raw
            .bodies
            .0
            .get(owner)
            .is_some_and(|(_, raw)| raw.x0.is_some());
        let place = match motion.map(|motion| motions.index(motion)) {
            Some(place) if time > 0.0 => place,
            _ if given => x0,
            _ if raw.trucks[index].tree.is_some() => tree,
            _ => at,
        };
        let expected = format!(
            "wheel {wheel} of truck \"{}\" must stay on rail {}, from x = {} to {}",
            truck.name,
            rail.name,
            number(rail.range[0]),
            number(rail.range[1])
        );
        let found = if time > 0.0 {
            let end = if x < rail.range[0] {
                rail.range[0]
            } else {
                rail.range[1]
            };
            format!("x beyond {} from t = {time:.4}", number(end))
        } else {
            format!("x = {} at the start", number(x))
        };
        faults.add(
            Fault::new(&place, expected)
                .got(found)
                .hint("check x0, the motion and end.time"),
        );
    }
}

/// Time and position at which the origin of a body leaves a range, if this follows from its motion.
fn leaves(body: &Body, range: [f64; 2], end: f64) -> Option<(f64, f64)> {
    match &body.motion {
        BodyMotion::Prescribed(travel) => travel.leaves(range, end),
        BodyMotion::Held | BodyMotion::Free | BodyMotion::Driven(_) => {
            (body.x0 < range[0] || body.x0 > range[1]).then_some((0.0, body.x0))
        }
    }
}
