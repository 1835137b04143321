//! Scenes that combine features, drawn from a seed and mostly valid: structures of one and two rails, one to three bodies on,
//! beside and carried by each other, all laws, foundations, steppers, motions, events, ropes, stops, loads, comparisons and codes.

use fastrand::Rng;
use serde_json::{Map, Value, json};

/// A scene with the files to which it refers.
pub struct Combination {
    pub scene: Value,
    pub specs: Vec<(String, Value)>,
}

/// Random numbers with the distributions of engineering quantities.
struct Draw(Rng);

impl Draw {
    fn yes(&mut self, chance: f64) -> bool {
        self.0.f64() < chance
    }

    fn one<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.0.usize(..all.len())].clone()
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.0.f64()
    }

    /// Between two positive numbers, evenly by their logarithms.
    fn size(&mut self, from: f64, to: f64) -> f64 {
        from * (to / from).powf(self.0.f64())
    }

    /// A number that is round as often as not.
    fn place(&mut self, from: f64, to: f64) -> f64 {
        let value = self.between(from, to);
        if self.yes(0.5) {
            value.round().clamp(from, to)
        } else {
            value
        }
    }
}

/// A rail with its range and the side on which it is.
struct RailSide {
    name: String,
    /// Whether its structure has mass, and whether it is a straight girder.
    has_mass: bool,
    is_girder: bool,
    range: [f64; 2],
    z: f64,
}

fn units() -> Value {
    json!({ "length": "m", "force": "kN", "time": "s" })
}

/// A scene by its seed.
pub fn combination(seed: u64) -> Combination {
    let mut draw = Draw(Rng::with_seed(seed));
    // most runs are short: what combines does so at the start
    let end = if draw.yes(0.1) {
        draw.size(0.01, 0.3)
    } else {
        draw.size(0.0005, 0.01)
    };
    let (spec, rails) = structure(&mut draw);
    let mut scene = json!({
        "format": "girderway-scene/1", "name": "n", "units": units(), "gravity": 9.81, "structures": {}, "bodies": {},
        "wheels": {}, "trucks": [], "motions": [], "end": { "time": end },
        "output": { "dt": end / draw.one(&[3.0, 20.0, 60.0]) }
    });
    let mut specs = vec![("spec.json".to_owned(), spec)];
    scene["structures"]["s"] = foundation(&mut draw, "spec.json", &rails);
    let lateral = draw.yes(0.3);
    for kind in ["w", "v"] {
        scene["wheels"][kind] = wheel(&mut draw, lateral);
    }
    let is_still = draw.yes(0.1);
    if is_still {
        scene["analysis"] = json!("quasi-static");
    }
    let count = draw.one(&[1, 1, 1, 2, 2, 3]);
    let mut names = Vec::new();
    for own in ["a", "b", "c"].iter().take(count) {
        body(&mut draw, &mut scene, own, &rails, end, is_still);
        names.push((*own).to_owned());
    }
    if count > 1 && draw.yes(0.15) {
        pin(&mut draw, &mut scene, &names);
    }
    if !is_still && draw.yes(0.15) {
        carried(&mut draw, &mut scene, &mut specs, end);
    }
    if !is_still && draw.yes(0.2) {
        rope(&mut draw, &mut scene, &names);
    }
    extras(&mut draw, &mut scene, &names, &rails, end);
    Combination { scene, specs }
}

/// A spec with one or two rails.
fn structure(draw: &mut Draw) -> (Value, Vec<RailSide>) {
    if draw.yes(0.4) {
        short(draw)
    } else {
        frame(draw)
    }
}

/// A straight girder over one to four spans.
fn short(draw: &mut Draw) -> (Value, Vec<RailSide>) {
    let spans: Vec<f64> = (0..draw.one(&[1, 1, 2, 3, 4]))
        .map(|_| draw.place(4.0, 15.0))
        .collect();
    let overhangs = if draw.yes(0.3) {
        [draw.place(1.0, 3.0), draw.place(1.0, 3.0)]
    } else {
        [0.0; 2]
    };
    let range = [-overhangs[0], spans.iter().sum::<f64>() + overhangs[1]];
    let mut girder = json!({ "spans": spans, "overhangs": overhangs, "E": 2.1e8, "G": 8.1e7, "A": 0.02,
        "I_vertical": draw.size(1e-5, 1e-1), "I_lateral": draw.size(1e-6, 1e-2), "J": draw.size(1e-7, 1e-3) });
    for (key, from, to) in [
        ("kA_vertical", 1e-3, 1e-1),
        ("kA_lateral", 1e-3, 1e-1),
        ("rail_height", 0.05, 2.0),
        ("mass_per_length", 1e-3, 2.0),
    ] {
        if draw.yes(0.5) {
            girder[key] = json!(draw.size(from, to));
        }
    }
    let has_mass = girder.get("mass_per_length").is_some();
    let stations: Vec<f64> = (0..5)
        .map(|k| range[0] + (range[1] - range[0]) * f64::from(k) / 4.0)
        .collect();
    let theory = draw.one(&["timoshenko", "euler-bernoulli"]);
    let spec = json!({ "format": "girderway-beam/1", "name": "girder", "units": units(), "theory": theory, "girder": girder, "stations": stations });
    (
        spec,
        vec![RailSide {
            has_mass,
            is_girder: true,
            name: "rail".to_owned(),
            range,
            z: 0.0,
        }],
    )
}

/// One or two girders on supports or columns, with hinges, springs, masses and ties.
fn frame(draw: &mut Draw) -> (Value, Vec<RailSide>) {
    let bays = draw.one(&[1, 2, 3, 5]);
    let bay = draw.place(4.0, 10.0);
    let sides: Vec<f64> = if draw.yes(0.6) {
        vec![-3.0, 3.0]
    } else {
        vec![0.0]
    };
    let is_on_columns = draw.yes(0.5);
    let has_mass = draw.yes(0.7);
    let (mut points, mut cells, mut sections, mut orientations) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut supports, mut rails, mut at) = (Vec::new(), Map::new(), Vec::new());
    for (r, z) in sides.iter().enumerate() {
        let first = points.len();
        for k in 0..=bays {
            points.push(json!([bay * f64::from(k), 6.0, z]));
        }
        let mut segments = Vec::new();
        for k in 0..bays as usize {
            segments.push(json!({ "cell": [0, cells.len()] }));
            cells.push([first + k, first + k + 1]);
            sections.push("girder");
            orientations.push([0, 1, 0]);
        }
        for k in 0..=bays as usize {
            let top = first + k;
            if is_on_columns {
                let foot = points.len();
                points.push(json!([bay * k as f64, 0.0, z]));
                cells.push([foot, top]);
                sections.push("column");
                orientations.push([0, 0, 1]);
                supports
                    .push(json!({ "point": foot, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"] }));
            } else if k == 0 {
                supports.push(json!({ "point": top, "fix": ["ux", "uy", "uz", "rx"] }));
            } else {
                supports.push(json!({ "point": top, "fix": ["uy", "uz", "rx"] }));
            }
        }
        let name = if sides.len() == 1 {
            "rail"
        } else {
            ["north", "south"][r]
        };
        let end = bay * f64::from(bays);
        rails.insert(name.to_owned(), json!({ "origin": [0, 6, z], "axis": [1, 0, 0], "segments": segments, "stations": [0, 0.2 * end, 0.4 * end, 0.7 * end, end] }));
        at.push(RailSide {
            has_mass,
            is_girder: false,
            name: name.to_owned(),
            range: [0.0, end],
            z: *z,
        });
    }
    if sides.len() == 2 && draw.yes(0.5) {
        let second = if is_on_columns {
            2 * (bays as usize + 1)
        } else {
            bays as usize + 1
        };
        cells.push([0, second]);
        sections.push("tie");
        orientations.push([0, 1, 0]);
    }
    let mut kinds = vec!["beam"; cells.len()];
    if sections.last() == Some(&"tie") && draw.yes(0.5) {
        kinds[cells.len() - 1] = "truss";
    }
    let mut release = vec![json!([]); cells.len()];
    if bays > 1 && draw.yes(0.3) {
        release[0] = json!(draw.one(&[vec!["rz"], vec!["ry", "rz"], vec!["rx"], vec!["ux"]]));
    }
    let section = |draw: &mut Draw, name: &str| {
        let mut own = json!({ "name": name, "material": "steel", "A": draw.size(2e-3, 0.1), "Iy": draw.size(1e-6, 1e-2), "Iz": draw.size(1e-5, 1e-1), "J": draw.size(1e-7, 1e-3) });
        if draw.yes(0.4) {
            own["Asy"] = json!(draw.size(1e-3, 0.05));
        }
        if draw.yes(0.3) {
            own["points"] = json!([{ "name": "bottom", "y": -0.3, "detail": 112 }, { "name": "top", "y": 0.3, "z": 0.1 }]);
        }
        own
    };
    let mut spec = json!({
        "format": "girderway-beam/1", "name": "frame", "units": units(), "theory": draw.one(&["timoshenko", "euler-bernoulli"]),
        "up": [0, 1, 0], "points": points, "cells": [{ "type": "line", "data": cells }],
        "cell_data": { "section": [sections], "orientation": [orientations], "release_b": [release], "kind": [kinds] },
        "materials": [{ "name": "steel", "E": 2.1e8, "G": 8.1e7, "density": has_mass.then_some(7.85) }],
        "sections": [section(draw, "girder"), section(draw, "column"), section(draw, "tie")],
        "supports": supports, "rails": rails, "point_sets": { "first": [0] },
        "effects": [{ "name": "mid", "cell": [0, 0], "at": 0.5 }]
    });
    if draw.yes(0.2) {
        let point = draw.0.usize(..bays as usize + 1);
        spec["springs"] = json!([{ "point": point, "dof": draw.one(&["uy", "uz", "ux", "rz"]), "k": draw.size(1.0, 1e6) }]);
    }
    if draw.yes(0.2) {
        spec["masses"] = json!([{ "point": 1, "mass": draw.size(1e-2, 10.0) }]);
    }
    (spec, at)
}

/// The entry of a structure.
fn foundation(draw: &mut Draw, spec: &str, rails: &[RailSide]) -> Value {
    let words = [
        "rigid",
        "influence",
        "influence",
        "influence",
        "influence",
        "auto",
        "ties",
        "parts",
        "modal",
        "full",
    ];
    // parts need a girder, modes need mass; once in twenty times what they need is missing
    let (has_mass, is_girder) = (rails[0].has_mass, rails[0].is_girder);
    let suits = |word: &&str| match *word {
        "parts" => is_girder,
        "modal" | "full" => has_mass,
        _ => true,
    };
    let word = match draw.yes(0.05) {
        true => draw.one(&words),
        false => draw.one(&words.into_iter().filter(suits).collect::<Vec<_>>()),
    };
    let mut own = json!({ "spec": spec, "foundation": word });
    if has_mass && word != "rigid" && draw.yes(0.5) {
        own["damping"] = json!(draw.between(0.0, 0.1));
    }
    match word {
        "modal" => own["modes"] = json!(draw.0.u32(1..12)),
        "full" => own["elements"] = json!(draw.0.u32(1..4)),
        "parts" => {
            own["count"] = json!(draw.0.u32(2..12));
            own["handover"] = json!(draw.one(&["blend", "per-part"]));
        }
        "auto" => {
            own["tolerance"] = json!(draw.one(&[0.3, 0.1, 0.01]));
            own["measure"] = json!(draw.one(&["extremes", "history"]));
        }
        "ties" => own["ties"] = ties(draw),
        "influence" if draw.yes(0.3) => {
            own["reading"] = json!(draw.one(&["exact", "natural", "akispl", "cubspl"]));
            own["couplings"] = json!(draw.one(&["all", "within rails", "none"]));
        }
        _ => {}
    }
    if !matches!(word, "parts" | "rigid") && draw.yes(0.15) {
        own["longitudinal"] = json!(true);
    }
    if draw.yes(0.1) {
        own["preload"] = json!(true);
    }
    let rail = &rails[draw.0.usize(..rails.len())];
    if draw.yes(0.3) {
        let direction = draw.one(&["vertical", "vertical", "lateral"]);
        own["gauges"] = json!({ "q": { "rail": rail.name, "x": draw.place(rail.range[0], rail.range[1]), "direction": direction } });
    }
    if draw.yes(0.35) {
        let count = draw.0.usize(1..3);
        let all: Vec<Value> = (0..count).map(|_| irregularity(draw, rail)).collect();
        own["irregularities"] = json!(all);
    }
    own
}

fn ties(draw: &mut Draw) -> Value {
    let mut own = json!({ "spacing": draw.place(1.0, 2.0), "k": draw.size(1e3, 1e6), "rail": { "E": 2.1e8, "I_vertical": draw.size(1e-6, 1e-4) } });
    if draw.yes(0.4) {
        own["lateral_k"] = json!(draw.size(1e3, 1e6));
        own["rail"]["I_lateral"] = json!(draw.size(1e-7, 1e-5));
    }
    if draw.yes(0.5) {
        own["rail"]["mass_per_length"] = json!(draw.size(1e-2, 0.2));
        own["mass"] = json!(draw.size(1e-3, 0.5));
    }
    if draw.yes(0.2) {
        own["c"] = json!(draw.size(1e-2, 10.0));
    }
    own
}

fn irregularity(draw: &mut Draw, rail: &RailSide) -> Value {
    let x = draw.place(rail.range[0], rail.range[1]);
    let mut own = match draw.0.u32(..5) {
        0 => {
            json!({ "kind": "step", "x": x, "height": draw.one(&[1.0, -1.0]) * draw.size(1e-5, 3e-3) })
        }
        1 => {
            json!({ "kind": "joint", "x": x, "depth": draw.size(1e-5, 5e-3), "length": draw.size(0.1, 2.0) })
        }
        2 => {
            json!({ "kind": "dip", "x": x, "depth": draw.size(1e-6, 5e-3), "length": draw.size(0.1, 3.0) })
        }
        3 => {
            json!({ "kind": "sinusoid", "amplitude": draw.size(1e-6, 3e-3), "length": draw.size(0.5, 10.0) })
        }
        _ => {
            json!({ "kind": "profile", "rows": [[rail.range[0], 0.0], [x + 0.01, draw.between(-2e-3, 2e-3)], [rail.range[1] + 1.0, 0.0]] })
        }
    };
    own["rail"] = json!(rail.name);
    if draw.yes(0.2) {
        own["direction"] = json!("lateral");
    }
    own
}

fn wheel(draw: &mut Draw, lateral: bool) -> Value {
    let k = draw.size(1e3, 1e7);
    let mut vertical = json!({ "k": k });
    if draw.yes(0.4) {
        vertical["law"] = json!("impact");
        vertical["exponent"] = json!(draw.one(&[1.0, 1.1, 1.5, 2.0]));
        vertical["depth"] = json!(draw.size(1e-6, 1e-3));
    }
    if draw.yes(0.6) {
        vertical["c"] = json!(draw.size(1e-6, 1e-2) * k);
        vertical["damper"] = json!(draw.one(&["rail", "rail", "ground"]));
    }
    if vertical.get("law").is_none() && draw.yes(0.1) {
        vertical["bilateral"] = json!(true);
    }
    let mut own = json!({ "radius": draw.between(0.1, 0.6), "vertical": vertical });
    if lateral && draw.yes(0.7) {
        own["lateral"] =
            json!({ "k": draw.size(1e3, 1e6), "clearance": draw.one(&[0.0, 1e-3, 0.02]) });
        if draw.yes(0.2) {
            own["lateral"]["release"] = json!([0.7, 0.8]);
        }
    }
    if draw.yes(0.5) {
        own["friction"] = json!({ "mu": draw.between(0.02, 0.6), "slip": draw.size(1e-4, 0.1), "law": draw.one(&["step", "coulomb"]) });
        match draw.0.u32(..4) {
            0 => own["driven"] = json!(true),
            1 => own["braked"] = json!(true),
            2 => {
                own["driven"] = json!(true);
                own["braked"] = json!(true);
            }
            _ => {}
        }
    }
    own
}

/// A body on one rail or on two, with its trucks and its motion.
fn body(
    draw: &mut Draw,
    scene: &mut Value,
    name: &str,
    rails: &[RailSide],
    end: f64,
    is_still: bool,
) {
    let shortest = rails.iter().fold(f64::INFINITY, |most, rail| {
        most.min(rail.range[1] - rail.range[0])
    });
    let middle = 0.5 * (rails[0].range[0] + rails[0].range[1]);
    let x0 = draw.place(middle - 0.2 * shortest, middle + 0.2 * shortest);
    let half = (0.12 * shortest).min(2.0);
    let mut dof = Vec::new();
    for (own, chance) in [
        ("y", 0.9),
        ("z", 0.15),
        ("roll", 0.3),
        ("yaw", 0.1),
        ("pitch", 0.7),
    ] {
        if draw.yes(chance) {
            dof.push(own);
        }
    }
    let mass = draw.size(0.05, 50.0);
    let mut own = json!({ "inertia": [mass * draw.size(0.1, 10.0), mass * draw.size(0.1, 10.0), mass * draw.size(0.1, 10.0)], "x0": x0 });
    match draw.yes(0.5) {
        true => own["mass"] = json!(mass),
        false => own["weight"] = json!(9.81 * mass),
    }
    if draw.yes(0.4) {
        own["cg"] = json!([
            draw.between(-0.5, 0.5) * half,
            draw.between(0.0, 2.0),
            draw.between(-1.0, 1.0)
        ]);
    }
    let on: Vec<&RailSide> = if rails.len() == 2 && draw.yes(0.6) {
        rails.iter().collect()
    } else {
        vec![&rails[draw.0.usize(..rails.len())]]
    };
    let (has_both, wheel) = (on.len() == 2, draw.one(&["w", "v"]));
    for rail in on {
        let tree = match draw.0.u32(..6) {
            0 => json!([0.0]),
            1 | 2 => json!([-half, half]),
            3 => json!([[-half, -0.4 * half], [0.4 * half, half]]),
            4 => json!([-half, 0.0, half]),
            _ => json!([[[-half, -0.5 * half], [0.5 * half, half]]]),
        };
        let z = if has_both { rail.z } else { 0.0 };
        scene["trucks"].as_array_mut().expect("a list").push(
            json!({ "name": format!("t{name}{}", rail.name), "body": name, "rail": format!("s.{}", rail.name), "wheel": wheel, "tree": tree, "at": [0, 0, z] }));
    }
    let reach = (0.2 * shortest / end).min(5.0);
    let speed = draw.between(-1.0, 1.0) * reach;
    let motion = match draw.0.u32(..6) {
        _ if is_still => {
            Some(json!({ "kind": "prescribed", "position": [[0, x0], [end, x0 + speed * end]] }))
        }
        0 | 1 => Some(json!({ "kind": "prescribed", "speed": [[0, 0], [0.5 * end, speed]] })),
        2 => Some(
            json!({ "kind": "prescribed", "acceleration": [[0, speed / end], [0.6 * end, -speed / end]] }),
        ),
        3 => Some(json!({ "kind": "free" })),
        4 => Some(
            json!({ "kind": "drive", "speed": [[0, 0], [0.3 * end, speed]], "gain": draw.size(0.1, 1e3), "max_force": draw.size(0.1, 1e3) }),
        ),
        _ => None,
    };
    if let Some(mut motion) = motion {
        if motion["kind"] != "prescribed" {
            dof.push("x");
            if draw.yes(0.3) {
                own["v0"] = json!(speed);
            }
            if scene["wheels"][wheel]["braked"] == true && draw.yes(0.5) {
                motion["brake"] = json!(0.5 * end);
            }
        } else if motion.get("position").is_some() {
            own["x0"] = json!(x0);
        }
        motion["body"] = json!(name);
        motion["dof"] = json!("x");
        scene["motions"]
            .as_array_mut()
            .expect("a list")
            .push(motion);
    }
    if dof.contains(&"y") && !is_still && draw.yes(0.1) {
        own["start"] = json!({ "y": draw.between(-0.01, 0.05) });
    }
    own["dof"] = json!(dof);
    scene["bodies"][name] = own;
}

/// The second body is carried by the first through a pin.
fn pin(draw: &mut Draw, scene: &mut Value, names: &[String]) {
    let name = &names[1];
    let own = &mut scene["bodies"][name];
    for key in ["x0", "v0", "start", "track"] {
        if let Some(members) = own.as_object_mut() {
            members.remove(key);
        }
    }
    own["dof"] = json!(["pitch"]);
    own["pinned"] = json!({ "to": names[0], "at": [draw.between(-1.0, 1.0), 0, 0] });
    if let Some(motions) = scene["motions"].as_array_mut() {
        motions.retain(|motion| motion["body"] != *name);
    }
}

/// A trolley on a girder that the first body carries.
fn carried(draw: &mut Draw, scene: &mut Value, specs: &mut Vec<(String, Value)>, end: f64) {
    let (mut spec, rails) = short(draw);
    spec["girder"]["mass_per_length"] = json!(draw.size(1e-2, 1.0));
    specs.push(("carried.json".to_owned(), spec));
    let mut own = json!({ "spec": "carried.json", "foundation": draw.one(&["rigid", "influence", "influence", "modal", "full", "parts", "parts", "auto"]), "on": "a", "at": [-rails[0].range[1] / 2.0, 2.0, 0.0] });
    if draw.yes(0.5) {
        own["damping"] = json!(0.02);
    }
    scene["structures"]["g"] = own;
    let x0 = 0.5 * rails[0].range[1];
    let dof = draw.one(&[vec!["y"], vec!["y", "pitch"], vec!["x", "y", "pitch"]]);
    let motion = match dof[0] {
        "x" => json!({ "body": "t", "dof": "x", "kind": "free" }),
        _ => {
            json!({ "body": "t", "dof": "x", "kind": "prescribed", "speed": [[0, 0.5 / end.max(0.5)]] })
        }
    };
    scene["bodies"]["t"] = json!({ "mass": draw.size(0.1, 10.0), "inertia": [1, 1, draw.size(0.1, 10.0)], "dof": dof, "x0": x0 });
    scene["trucks"].as_array_mut().expect("a list").push(
        json!({ "name": "tt", "body": "t", "rail": "g.rail", "wheel": draw.one(&["w", "v"]), "tree": draw.one(&[vec![-0.5, 0.5], vec![0.0]]) }));
    scene["motions"]
        .as_array_mut()
        .expect("a list")
        .push(motion);
}

/// A load on a rope.
fn rope(draw: &mut Draw, scene: &mut Value, names: &[String]) {
    let carrier = draw.one(names);
    scene["bodies"]["l"] = json!({ "mass": draw.size(0.05, 20.0), "dof": ["X", "Y", "Z"] });
    let mut own = json!({ "name": "r", "from": { "body": carrier, "at": [0, draw.between(-1.0, 2.0), 0] }, "to": { "body": "l" }, "EA": draw.size(1e3, 1e6), "length": draw.place(2.0, 20.0) });
    if draw.yes(0.5) {
        own["c"] = json!(draw.size(1e-2, 1e2));
    }
    if draw.yes(0.4) {
        own["speed"] = json!([[0, 0], [0.1, draw.between(-0.5, 0.5)]]);
    }
    scene["ropes"] = json!([own]);
}

/// Loads, stops, events, steppers, outputs, comparisons and codes.
fn extras(draw: &mut Draw, scene: &mut Value, names: &[String], rails: &[RailSide], end: f64) {
    let body = draw.one(names);
    let free: Vec<String> = scene["bodies"][&body]["dof"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|dof| Some(dof.as_str()?.to_owned()))
        .collect();
    if !free.is_empty() && draw.yes(0.25) {
        let dof = draw.one(&free);
        scene["loads"] = json!([{ "body": body, "dof": dof, "value": [[0, draw.between(-5.0, 5.0)], [0.4 * end, draw.between(-50.0, 50.0)]] }]);
    }
    if draw.yes(0.2) {
        let rail = &rails[0];
        let stop = match draw.0.u32(..3) {
            0 => {
                json!({ "rail": format!("s.{}", rail.name), "x": draw.between(rail.range[0], rail.range[1]), "k": draw.size(1e2, 1e6) })
            }
            1 => {
                json!({ "body": body, "Y": draw.between(-0.1, 0.0), "k": draw.size(1e2, 1e6), "c": draw.size(1e-2, 1e2) })
            }
            _ if names.len() > 1 => {
                json!({ "body": names[0], "against": names[1], "gap": draw.between(0.0, 0.5), "k": draw.size(1e2, 1e6) })
            }
            _ => {
                json!({ "rail": format!("s.{}", rail.name), "x": rail.range[1], "k": draw.size(1e2, 1e6), "c": 1.0 })
            }
        };
        scene["stops"] = json!([stop]);
    }
    let motion = scene["motions"]
        .as_array()
        .into_iter()
        .flatten()
        .find(|own| own["body"] == body)
        .cloned();
    let kind = motion
        .as_ref()
        .and_then(|own| own["kind"].as_str())
        .unwrap_or_default()
        .to_owned();
    if draw.yes(0.2) {
        let mut columns = vec!["time".to_owned()];
        if !kind.is_empty() {
            columns.push(format!("{body}.x"));
        }
        if free.iter().any(|dof| dof == "y") {
            columns.push(format!("{body}.deflection"));
        }
        let column = draw.one(&columns);
        let value = if column == "time" {
            0.5 * end
        } else {
            draw.between(-1.0, 10.0)
        };
        let mut actions = vec![json!({ "end": true })];
        if kind == "drive" {
            actions.extend([
                json!({ "drive": { "body": body, "speed": 0.3 } }),
                json!({ "drive_off": body }),
            ]);
        }
        if kind == "drive" || kind == "free" {
            actions.push(json!({ "brake": body }));
        }
        if scene.get("ropes").is_some() {
            actions.extend([
                json!({ "drop": "r" }),
                json!({ "hoist": { "rope": "r", "speed": 0.2 } }),
            ]);
        }
        scene["events"] =
            json!([{ "when": format!("{column} >= {value}"), "do": draw.one(&actions) }]);
    }
    if draw.yes(0.25) {
        let kinds = scene["motions"].as_array().into_iter().flatten();
        let is_prescribed = kinds.clone().all(|own| own["kind"] == "prescribed");
        let mut words = vec!["auto", "sdirk4", "esdirk5"];
        if is_prescribed {
            words.extend(["radau", "radau", "series"]);
        }
        scene["stepper"] = json!(draw.one(&words));
        if draw.yes(0.3) {
            scene["step"] = json!(end / 50.0);
        }
    }
    if draw.yes(0.5) {
        scene["accuracy"] = json!(draw.one(&[1e-2, 1e-3, 1e-5]));
    }
    if draw.yes(0.3) {
        scene["output"]["reactions"] = json!(true);
    }
    if draw.yes(0.2) {
        scene["output"]["dead_load"] = json!(true);
    }
    let trucks = scene["trucks"].as_array().into_iter().flatten();
    let is_on_two = trucks.filter(|truck| truck["body"] == body).count() == 2;
    if draw.yes(0.3) && is_on_two {
        scene["practice"] = draw.one(&[
            json!({}),
            json!({ "code": "EN 1991-3", "hoisting": "HC2" }),
            json!({ "lateral_section": "top flange" }),
            json!({ "code": ["CMAA 70", "AIST TR-13"], "limits": { "vertical": "L/700" } }),
        ]);
        scene["practice"]["crane"] = json!(body);
    }
    if draw.yes(0.25) {
        let change = draw.one(&[
            json!({ "structures": { "s": { "foundation": "rigid" } } }),
            json!({ "structures": { "s": { "foundation": "influence", "reading": null, "couplings": null } } }),
            json!({ "motions": null }), json!({ "gravity": 1.0 }), json!({ "accuracy": 1e-3 }), json!({ "loads": null, "events": null, "stops": null }),
        ]);
        let mut change = change;
        change["label"] = json!("o");
        scene["compare"] = json!([change]);
    }
}
