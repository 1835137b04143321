//! Small specs and scenes that are drawn from bytes and are valid, or nearly so: their structure is right, and their
//! numbers are of any size.

use serde_json::{Value, json};

/// Draws from bytes; zeros follow their end.
struct Draw<'b>(&'b [u8]);

impl Draw<'_> {
    fn byte(&mut self) -> u8 {
        let (first, rest) = self.0.split_first().unwrap_or((&0, &[]));
        self.0 = rest;
        *first
    }

    fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    fn one<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// From 0 to 1.
    fn share(&mut self) -> f64 {
        f64::from(u16::from_be_bytes([self.byte(), self.byte()])) / 65535.0
    }

    /// Between two positive numbers, evenly by their logarithms, with few digits.
    fn size(&mut self, from: f64, to: f64) -> f64 {
        let value = from * (to / from).powf(self.share());
        format!("{value:.3e}").parse().unwrap_or(from)
    }

    /// Between two numbers, with few digits.
    fn between(&mut self, from: f64, to: f64) -> f64 {
        let value = from + (to - from) * self.share();
        format!("{value:.4}").parse().unwrap_or(from)
    }

    /// True once in `count` times.
    fn rarely(&mut self, count: usize) -> bool {
        self.below(count) == count - 1
    }
}

fn units() -> Value {
    json!({ "length": "m", "force": "kN", "time": "s" })
}

/// A beam spec in one of the two forms.
pub fn spec(bytes: &[u8]) -> String {
    let mut draw = Draw(bytes);
    let spec = if draw.below(2) == 0 {
        girder(&mut draw)
    } else {
        frame(&mut draw)
    };
    spec.to_string()
}

fn theory(draw: &mut Draw<'_>) -> &'static str {
    draw.one(&["timoshenko", "euler-bernoulli"])
}

/// A straight girder over one to three spans, sometimes with numbers of extreme sizes.
fn girder(draw: &mut Draw<'_>) -> Value {
    let extreme = if draw.rarely(4) { 1e12 } else { 1e2 };
    let mut spans = Vec::new();
    for _ in 0..=draw.below(3) {
        spans.push(draw.size(0.1, 0.1 * extreme));
    }
    let overhangs = if draw.rarely(3) {
        [draw.size(1e-3, 10.0), draw.size(1e-3, 10.0)]
    } else {
        [0.0; 2]
    };
    let end = spans.iter().sum::<f64>() + overhangs[1];
    let count = 2 + draw.below(4);
    let station = |k: usize| -overhangs[0] + (end + overhangs[0]) * k as f64 / (count - 1) as f64;
    let mut stations: Vec<f64> = (0..count).map(station).collect();
    if let Some(last) = stations.last_mut() {
        *last = end;
    }
    let mut girder = json!({ "spans": spans, "overhangs": overhangs, "E": draw.size(1e4, 1e4 * extreme * extreme) });
    let members = [
        ("G", 1e3, 1e9),
        ("A", 1e-4, 1e1),
        ("I_vertical", 1e-9, 1e3),
        ("I_lateral", 1e-9, 1e3),
        ("J", 1e-9, 1e3),
        ("kA_vertical", 1e-4, 1e1),
        ("kA_lateral", 1e-4, 1e1),
        ("mass_per_length", 1e-3, 1e1),
        ("rail_height", 1e-3, 1e1),
    ];
    for (index, (key, from, to)) in members.into_iter().enumerate() {
        if index < 5 || draw.below(2) == 0 {
            girder[key] = json!(draw.size(from, to * extreme / 1e2));
        }
    }
    json!({ "format": "girderway-beam/1", "units": units(), "theory": theory(draw), "girder": girder,
            "stations": stations })
}

/// A frame of points on a coarse grid, with members between any of them and a rail along the first few.
fn frame(draw: &mut Draw<'_>) -> Value {
    let along = 2 + draw.below(3);
    let mut points: Vec<[f64; 3]> = (0..along).map(|k| [2.0 * k as f64, 0.0, 0.0]).collect();
    for _ in 0..draw.below(4) {
        points.push([
            draw.below(9) as f64,
            draw.one(&[-4.0, -2.0, -1e-3, 2.0]),
            draw.one(&[0.0, 0.0, 3.0, -1e-6]),
        ]);
    }
    let mut cells: Vec<[usize; 2]> = (1..along).map(|k| [k - 1, k]).collect();
    for _ in 0..draw.below(7) {
        cells.push([draw.below(points.len()), draw.below(points.len())]);
    }
    cells.retain(|[a, b]| a != b && points[*a] != points[*b]);
    let dofs = ["ux", "uy", "uz", "rx", "ry", "rz"];
    let mut supports = vec![json!({ "point": 0, "fix": dofs[..3 + draw.below(4)] })];
    for _ in 0..=draw.below(4) {
        let from = draw.below(3);
        supports
            .push(json!({ "point": draw.below(points.len()), "fix": dofs[from..from + 1 + draw.below(4)] }));
    }
    let mut releases = [vec![json!([]); cells.len()], vec![json!([]); cells.len()]];
    let mut kinds = vec!["beam"; cells.len()];
    for cell in 0..cells.len() {
        if draw.rarely(5) {
            let from = draw.below(6);
            releases[draw.below(2)][cell] = json!(dofs[from..(from + 1 + draw.below(3)).min(6)]);
        }
        if cell >= along && draw.rarely(4) {
            kinds[cell] = draw.one(&["truss", "rod"]);
        }
    }
    let section = json!({ "name": "s", "material": "steel", "A": draw.size(1e-4, 1.0), "Iy": draw.size(1e-8, 1.0),
                          "Iz": draw.size(1e-8, 1.0), "J": draw.size(1e-9, 1.0) });
    let segments: Vec<Value> = (0..along - 1).map(|k| json!({ "cell": [0, k] })).collect();
    let end = 2.0 * (along - 1) as f64;
    let [release_a, release_b] = releases;
    let orientations = vec![json!([0.1, 1, 0.2]); cells.len()];
    let mut spec = json!({
        "format": "girderway-beam/1", "units": units(), "theory": theory(draw), "points": points,
        "cells": [{ "type": "line", "data": cells }],
        "cell_data": { "kind": [kinds], "release_a": [release_a], "release_b": [release_b],
                       "orientation": [orientations] },
        "materials": [{ "name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85 }],
        "sections": [section], "supports": supports,
        "rails": { "rail": { "axis": [1, 0, 0], "segments": segments, "stations": [0, 0.3 * end, end] } }
    });
    if draw.rarely(3) {
        let k = draw.size(1e-3, 1e12);
        spec["springs"] =
            json!([{ "point": draw.below(points.len()), "dof": draw.one(&dofs), "k": k }]);
    }
    spec
}

/// A spec, which is to be stored as `generated.json`, and a scene of one or two bodies on it with a short time.
pub fn scene(bytes: &[u8]) -> (String, String) {
    let mut draw = Draw(bytes);
    let length = draw.between(6.0, 20.0);
    let spec = json!({
        "format": "girderway-beam/1", "units": units(), "theory": theory(&mut draw),
        "girder": { "spans": [length], "E": 2.1e8, "G": 8.1e7, "A": 0.02, "I_vertical": draw.size(1e-5, 1e-2),
                    "I_lateral": draw.size(1e-5, 1e-2), "J": 1e-4, "mass_per_length": draw.size(1e-2, 1.0),
                    "rail_height": 0.5 },
        "stations": [0, 0.25 * length, 0.5 * length, 0.75 * length, length]
    });
    let foundation = draw.one(&["rigid", "influence", "modal", "full", "parts", "auto"]);
    let mut structure = json!({ "spec": "generated.json", "foundation": foundation });
    if foundation == "modal" || foundation == "full" {
        structure["elements"] = json!(1 + draw.below(2));
        structure["damping"] = json!(draw.between(0.0, 0.2));
    }
    if foundation == "modal" {
        structure["modes"] = json!(1 + draw.below(2));
    }
    if foundation == "auto" {
        structure["tolerance"] = json!(draw.one(&[0.3, 0.1, 0.01]));
    }
    let lateral = draw.rarely(3);
    let mut dof = vec!["x", "y", "pitch"];
    if lateral {
        dof.push("z");
    }
    let mass = draw.size(0.1, 100.0);
    let inertia = [mass, mass, mass * draw.size(0.1, 10.0)];
    let x0 = draw.between(2.0, 4.0);
    let body = json!({ "mass": mass, "inertia": inertia, "dof": dof, "x0": x0 });
    let end = draw.size(1e-3, 0.1);
    let mut scene = json!({
        "format": "girderway-scene/1", "name": "generated", "units": units(), "gravity": 9.81,
        "structures": { "girder": structure }, "bodies": { "car": body }, "wheels": { "wheel": wheel(&mut draw, lateral) },
        "trucks": [{ "body": "car", "rail": "girder.rail", "tree": tree(&mut draw), "wheel": "wheel" }],
        "motions": [motion(&mut draw)], "end": { "time": end }, "output": { "dt": end / 8.0 },
        "accuracy": draw.one(&[1e-2, 1e-4])
    });
    if draw.rarely(3) {
        scene["analysis"] = json!("quasi-static");
    } else if draw.rarely(3) {
        scene["stepper"] = json!(draw.one(&["sdirk4", "radau", "gauss2", "gauss3", "auto"]));
        scene["step"] = json!(end / 16.0);
    }
    if draw.rarely(3) {
        let k = draw.size(1.0, 1e6);
        scene["stops"] = json!([{ "rail": "girder.rail", "x": draw.between(0.0, length), "k": k, "side": "before" }]);
    }
    if draw.rarely(3) {
        let value = draw.between(-50.0, 50.0);
        scene["loads"] = json!([{ "body": "car", "dof": draw.one(&["x", "y", "pitch"]), "value": [[0, 0], [end, value]] }]);
    }
    if draw.rarely(4) {
        let when = format!(
            "car.{} >= {}",
            draw.one(&["x", "y", "pitch"]),
            draw.between(-1.0, 4.0)
        );
        scene["events"] = json!([{ "when": when, "do": { "end": true } }]);
    }
    (spec.to_string(), scene.to_string())
}

fn wheel(draw: &mut Draw<'_>, lateral: bool) -> Value {
    let k = draw.size(1e2, 1e7);
    let mut vertical = json!({ "k": k, "c": draw.size(1e-6, 1e-2) * k });
    if draw.rarely(2) {
        vertical["law"] = json!("impact");
        vertical["exponent"] = json!(draw.one(&[1.0, 1.1, 1.5, 3.0]));
        vertical["depth"] = json!(draw.size(1e-5, 1e-1));
    }
    let mut wheel = json!({ "radius": draw.size(0.1, 1.0), "vertical": vertical });
    if lateral || draw.rarely(3) {
        wheel["lateral"] = json!({ "k": draw.size(1e2, 1e7), "clearance": draw.one(&[0.0, 0.01]) });
    }
    if draw.rarely(2) {
        wheel["friction"] =
            json!({ "law": "step", "mu": draw.between(0.01, 0.5), "slip": draw.size(1e-4, 1.0) });
        wheel["spin_inertia"] = json!(draw.size(1e-3, 10.0));
        wheel["driven"] = json!(draw.rarely(2));
    }
    wheel
}

fn tree(draw: &mut Draw<'_>) -> Value {
    let half = draw.between(0.1, 1.5);
    match draw.below(4) {
        0 => json!([0]),
        1 => json!([-half, half]),
        2 => json!([[-half - 0.2, -half], [half, half + 0.2]]),
        _ => json!([-half, 0.1, half]),
    }
}

fn motion(draw: &mut Draw<'_>) -> Value {
    let speed = draw.between(-3.0, 3.0);
    match draw.below(3) {
        0 => json!({ "body": "car", "dof": "x", "kind": "free" }),
        1 => json!({ "body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, speed]] }),
        _ => json!({ "body": "car", "dof": "x", "kind": "drive", "speed": [[0, 0], [0.1, speed]],
                     "gain": draw.size(1e-2, 1e4), "max_force": draw.size(1e-2, 1e4) }),
    }
}
