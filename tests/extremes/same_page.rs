//! The same physics, the same page: scenes that are told in other units or axes, from the other end or side, as frames of few or
//! many members, with wheels in another order or more stations, at another output interval, at another accuracy or on one thread
//! have the same extremes.

use std::collections::BTreeMap;

use fastrand::Rng;
use serde_json::{Value, json};

use super::summary_of;

/// A scene in metres, kilonewtons and seconds.
struct Base {
    kind: Kind,
    spans: Vec<f64>,
    girder: BTreeMap<&'static str, f64>,
    weight: f64,
    places: Vec<f64>,
    stiffness: f64,
    speed: f64,
    step: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Plain,
    Modal,
    Lateral,
    Step,
    QuasiStatic,
}

/// How a scene is told.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Telling {
    Plain,
    /// Millimetres and newtons.
    Units,
    /// Turned by half a turn about the vertical.
    Turned,
    /// Mirrored in the vertical plane of the rail.
    Mirrored,
    /// With the wheels in reverse order.
    Order,
    /// As a frame with a member for each span.
    Members,
    /// As a frame with three members for each span.
    Subdivided,
    /// As a frame with z upwards.
    Axes,
    /// With stations everywhere.
    Stations,
    Interval,
    Accuracy,
    OneThread,
}

impl Telling {
    /// Number of members of a span, where the girder is a frame.
    fn members(self) -> Option<usize> {
        match self {
            Telling::Members | Telling::Axes => Some(1),
            Telling::Subdivided => Some(3),
            _ => None,
        }
    }
}

const ACCURACY: f64 = 1e-4;

impl Base {
    fn new(seed: u64) -> Base {
        let mut random = Rng::with_seed(seed);
        let mut between = |low: f64, high: f64| low + (high - low) * random.f64();
        let count = 1 + (seed as usize) % 4;
        let spans: Vec<f64> = (0..count).map(|_| between(4.0, 9.0)).collect();
        let kinds = [
            Kind::Plain,
            Kind::Modal,
            Kind::Lateral,
            Kind::Step,
            Kind::QuasiStatic,
        ];
        let wheels = [1, 2, 4][(seed as usize / 5) % 3];
        let base = between(1.0, 2.5);
        let places = (0..wheels).map(|k| {
            if wheels == 1 {
                0.0
            } else {
                base * (k as f64 / (wheels - 1) as f64 - 0.5)
            }
        });
        let girder = BTreeMap::from([
            ("E", 2.1e8),
            ("G", 8.1e7),
            ("A", 0.02),
            ("I_vertical", between(4e-4, 1.5e-3)),
            ("I_lateral", between(1e-4, 4e-4)),
            ("J", 4e-6),
            ("kA_vertical", 0.005),
            ("kA_lateral", 0.012),
            ("rail_height", 0.3),
            ("mass_per_length", 0.16),
        ]);
        Base {
            kind: kinds[(seed as usize) % 5],
            spans,
            girder,
            weight: between(50.0, 300.0),
            places: places.collect(),
            stiffness: 3e5,
            speed: between(1.0, 4.0),
            step: between(0.3, 0.7),
        }
    }

    fn length(&self) -> f64 {
        self.spans.iter().sum()
    }

    /// The spec and the scene.
    fn told(&self, telling: Telling) -> [Value; 2] {
        let is_turned = telling == Telling::Turned;
        let (mm, n): (f64, f64) = if telling == Telling::Units {
            (1e3, 1e3)
        } else {
            (1.0, 1.0)
        };
        let units = match telling {
            Telling::Units => json!({"length": "mm", "force": "N", "time": "s"}),
            _ => json!({"length": "m", "force": "kN", "time": "s"}),
        };
        // by the dimension: powers of length and force
        let factor = |key: &str| match key {
            "E" | "G" => n / (mm * mm),
            "A" | "kA_vertical" | "kA_lateral" => mm * mm,
            "I_vertical" | "I_lateral" | "J" => mm.powi(4),
            "rail_height" => mm,
            // force s^2 / length^2
            _ => n / (mm * mm),
        };
        let mut girder: serde_json::Map<String, Value> = self
            .girder
            .iter()
            .map(|(key, value)| ((*key).to_owned(), json!(value * factor(key))))
            .collect();
        let mut spans: Vec<f64> = self.spans.iter().map(|span| span * mm).collect();
        if is_turned {
            spans.reverse();
        }
        girder.insert("spans".to_owned(), json!(spans));
        let length = self.length();
        let mut spec = match telling.members() {
            Some(count) => self.frame(count, telling == Telling::Axes),
            None => {
                json!({"format": "girderway-beam/1", "name": "g", "units": units, "girder": girder})
            }
        };
        if telling == Telling::Stations {
            let stations: Vec<f64> = (0..=60).map(|k| length * f64::from(k) / 60.0).collect();
            spec["stations"] = json!(stations);
        }
        let turned = |x: f64| if is_turned { length - x } else { x };
        let sign = if is_turned { -1.0 } else { 1.0 };
        let half = self.places.iter().copied().fold(0.0, f64::max);
        let first = half + 0.05;
        let reach = length - 2.0 * first;
        // the ramps of one second at both ends cover as much as one at full speed
        let own_speed = self.speed.min(reach / 1.5);
        let time = reach / own_speed;
        let speed = sign * own_speed * mm;
        let mut structure = json!({"spec": "g.json", "foundation": "influence"});
        if self.kind == Kind::Modal {
            structure =
                json!({"spec": "g.json", "foundation": "modal", "modes": 6, "damping": 0.01});
        }
        if self.kind == Kind::Step {
            let step = json!({"kind": "step", "x": turned(self.step * length) * mm, "height": sign * 0.001 * mm});
            structure["irregularities"] = json!([step]);
        }
        let k = self.stiffness * n / mm;
        let mut wheel = json!({"radius": 0.3 * mm, "vertical": {"k": k, "c": 2e-3 * k}});
        let mut dof = vec!["y"];
        if self.places.len() > 1 {
            dof.push("pitch");
        }
        let mut places: Vec<f64> = self.places.iter().map(|place| sign * place * mm).collect();
        places.sort_by(f64::total_cmp);
        if telling == Telling::Order {
            places.reverse();
        }
        if self.kind == Kind::Lateral {
            dof.push("z");
            wheel["lateral"] = json!({"k": 0.1 * k, "clearance": 0.0});
        }
        let inertia = self.weight * n * mm / 5.0;
        let accuracy = if telling == Telling::Accuracy {
            1e-7
        } else {
            ACCURACY
        };
        let dt = if telling == Telling::Interval {
            0.0137
        } else {
            0.05
        };
        let mut scene = json!({
            "format": "girderway-scene/1",
            "name": "told",
            "units": units,
            "gravity": 9.81 * mm,
            "structures": {"g": structure},
            "bodies": {"b": {"weight": self.weight * n, "inertia": [inertia, inertia, inertia], "dof": dof,
                "x0": turned(first) * mm}},
            "wheels": {"w": wheel},
            "trucks": [{"name": "T", "body": "b", "rail": "g.rail", "wheel": "w", "tree": places}],
            "motions": [{"body": "b", "dof": "x", "kind": "prescribed",
                "speed": [[0, 0], [1, speed], [time, speed], [time + 1.0, 0]]}],
            "end": {"time": time + 1.0},
            "accuracy": accuracy,
            "output": {"dt": dt, "reactions": true},
        });
        if self.kind == Kind::Lateral {
            let side = if telling == Telling::Mirrored {
                -1.0
            } else {
                sign
            };
            let force = side * 0.08 * self.weight * n;
            let value = [
                [0.0, 0.0],
                [0.3 * time, force],
                [0.6 * time, -0.5 * force],
                [time, 0.7 * force],
            ];
            scene["loads"] = json!([{"body": "b", "dof": "z", "value": value}]);
        }
        if self.kind == Kind::QuasiStatic {
            scene["analysis"] = json!("quasi-static");
        }
        [spec, scene]
    }

    /// The girder in metres and kilonewtons as a frame with `count` members for each span, with y upwards or z.
    fn frame(&self, count: usize, z_is_up: bool) -> Value {
        let turned = |[x, y, z]: [f64; 3]| if z_is_up { [x, -z, y] } else { [x, y, z] };
        let mut points = vec![turned([0.0; 3])];
        let mut end = 0.0;
        for span in &self.spans {
            let inside = (1..=count).map(|k| end + span * k as f64 / count as f64);
            points.extend(inside.map(|x| turned([x, 0.0, 0.0])));
            end += span;
        }
        let [vertical, lateral, about] = if z_is_up {
            ["uz", "uy", "rx"]
        } else {
            ["uy", "uz", "rx"]
        };
        let support = |k: usize| {
            let mut fix = vec![vertical, lateral, about];
            if k == 0 {
                fix.push("ux");
            }
            json!({"point": k * count, "fix": fix})
        };
        let members = points.len() - 1;
        let cells: Vec<[usize; 2]> = (0..members).map(|k| [k, k + 1]).collect();
        let of = |key: &str| self.girder[key];
        let segment =
            |k: usize| json!({"cell": [0, k], "offset": turned([0.0, of("rail_height"), 0.0])});
        let stations: Vec<f64> = (0..=20)
            .map(|k| self.length() * f64::from(k) / 20.0)
            .collect();
        json!({
            "format": "girderway-beam/1", "name": "g", "units": {"length": "m", "force": "kN", "time": "s"},
            "up": turned([0.0, 1.0, 0.0]), "theory": "timoshenko",
            "points": points, "cells": [{"type": "line", "data": cells}],
            "cell_data": {"kind": [vec!["beam"; members]], "section": [vec![0; members]],
                "orientation": [vec![turned([0.0, 1.0, 0.0]); members]]},
            "materials": [{"name": "steel", "E": of("E"), "G": of("G"), "density": of("mass_per_length") / of("A")}],
            "sections": [{"name": "girder", "material": "steel", "A": of("A"), "Iz": of("I_vertical"), "Iy": of("I_lateral"),
                "J": of("J"), "Asy": of("kA_vertical"), "Asz": of("kA_lateral")}],
            "supports": (0..=self.spans.len()).map(support).collect::<Vec<_>>(),
            "rails": {"rail": {"origin": [0, 0, 0], "axis": [1, 0, 0], "stations": stations,
                "segments": (0..members).map(segment).collect::<Vec<_>>()}},
        })
    }

    /// The extremes of its run in metres and kilonewtons, as those of the scene that is told plainly.
    fn extremes(&self, telling: Telling) -> BTreeMap<String, f64> {
        let [spec, scene] = self.told(telling);
        let flags: &[&str] = match telling {
            Telling::OneThread => &["--threads", "1"],
            _ => &[],
        };
        let summary = summary_of(("g.json", &spec), &scene, flags);
        assert!(
            summary["undetermined"].is_null(),
            "{}",
            summary["undetermined"]
        );
        let (mm, n): (f64, f64) = if telling == Telling::Units {
            (1e3, 1e3)
        } else {
            (1.0, 1.0)
        };
        let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let mut out = BTreeMap::new();
        for own in summary["extremes"].as_array().expect("extremes") {
            let (quantity, plane) = (word(&own["quantity"]), word(&own["plane"]));
            let (mut kind, mut direction) = (word(&own["kind"]), word(&own["direction"]));
            let mut value = own["value"].as_f64().expect("a value");
            let mut flips = false;
            if telling == Telling::Axes {
                let (before, is_other) = match direction.as_str() {
                    "uz" => ("uy", false),
                    "uy" => ("uz", true),
                    "ry" => ("rz", true),
                    "rz" => ("ry", false),
                    other => (other, false),
                };
                (direction, flips) = (before.to_owned(), is_other);
            }
            // forces along the rail are taken by one support alone
            if quantity == "normal" || direction == "ux" {
                continue;
            }
            let is_moment =
                ["moment", "torsion"].contains(&quantity.as_str()) || direction.starts_with('r');
            value /= match () {
                () if quantity == "deflection" => mm,
                () if is_moment => n * mm,
                () => n,
            };
            let mut place = match quantity.as_str() {
                "reaction" => {
                    let name = word(&own["support"]);
                    let number =
                        |prefix: &str| -> Option<u64> { name.strip_prefix(prefix)?.parse().ok() };
                    let of_point = |members: usize| Some(number("g.point")? / members as u64 + 1);
                    let place = match telling.members() {
                        Some(members) => of_point(members),
                        None => number("g.support"),
                    };
                    place.unwrap_or_else(|| panic!("{name} has a number"))
                }
                _ => own["span"].as_u64().expect("a span"),
            };
            if telling == Telling::Turned {
                let count = self.spans.len() as u64;
                place = if quantity == "reaction" {
                    count + 2 - place
                } else {
                    count + 1 - place
                };
                flips = match quantity.as_str() {
                    "shear" => plane == "vertical",
                    "moment" | "deflection" => plane == "lateral",
                    "reaction" => ["uz", "rx", "rz"].contains(&direction.as_str()),
                    _ => false,
                };
            }
            if telling == Telling::Mirrored {
                flips = match quantity.as_str() {
                    "shear" | "moment" | "deflection" => plane == "lateral",
                    "reaction" => ["uz", "rx", "ry"].contains(&direction.as_str()),
                    "torsion" => true,
                    _ => false,
                };
            }
            if flips {
                value = -value;
                kind = if kind == "max" { "min" } else { "max" }.to_owned();
            }
            out.insert(
                format!("{quantity} {plane}{direction} {place} {kind}"),
                value,
            );
        }
        out
    }
}

/// Identity: twenty scenes told in twelve ways. What the program computes from other numbers agrees within the accuracy of the
/// scenes; the output interval changes nothing but rounding, and the number of threads nothing at all.
#[test]
fn the_same_physics_has_the_same_page() {
    let tellings = [
        (Telling::OneThread, 0.0),
        (Telling::Interval, 1e-12),
        (Telling::Units, ACCURACY),
        (Telling::Stations, ACCURACY),
        (Telling::Turned, ACCURACY),
        (Telling::Mirrored, ACCURACY),
        (Telling::Order, ACCURACY),
        (Telling::Members, ACCURACY),
        (Telling::Subdivided, ACCURACY),
        (Telling::Axes, ACCURACY),
        (Telling::Accuracy, 2.0 * ACCURACY),
    ];
    let mut worst: BTreeMap<String, f64> = BTreeMap::new();
    for seed in 0..20 {
        let base = Base::new(seed);
        let plain = base.extremes(Telling::Plain);
        let size = |key: &str| {
            let kind = key.split(' ').take(2).collect::<Vec<_>>();
            let same = plain
                .iter()
                .filter(|(other, _)| other.split(' ').take(2).eq(kind.iter().copied()));
            same.map(|(_, value)| value.abs()).fold(0.0, f64::max)
        };
        let most = |word: &str| {
            let same = plain.iter().filter(|(key, _)| key.starts_with(word));
            same.map(|(_, value)| value.abs()).fold(0.0, f64::max)
        };
        for (telling, allowed) in tellings {
            let found = base.extremes(telling);
            assert!(!plain.is_empty(), "{seed}");
            for (key, value) in &plain {
                // what is zero but for rounding may be missing
                let word = key.split(' ').next().unwrap_or_default();
                let size = size(key);
                if size < 1e-6 * most(word) || size == 0.0 {
                    continue;
                }
                let other = found.get(key).copied();
                let other =
                    other.unwrap_or_else(|| panic!("{seed} {:?} {telling:?}: no {key}", base.kind));
                // lateral forces are as accurate as the vertical force of their wheel, and nothing damps the swings between
                // flanges, whose errors add up
                let (size, allowed) = match base.kind {
                    Kind::Lateral if allowed >= ACCURACY => {
                        // torsion is a force at the height of the rail
                        let size = if word == "torsion" {
                            0.3 * most("shear")
                        } else {
                            most(word)
                        };
                        (size, 6.0 * ACCURACY)
                    }
                    _ => (size, allowed),
                };
                let apart = (other - value).abs() / size;
                let own = worst.entry(format!("{telling:?} {word}")).or_default();
                *own = own.max(apart);
                assert!(
                    apart <= allowed,
                    "{seed} {:?} {telling:?} {key}: {value} {other}",
                    base.kind
                );
            }
        }
    }
    println!("{worst:?}");
}
