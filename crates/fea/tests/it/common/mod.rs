//! Models and helpers that several test files use.
#![allow(dead_code)]

#[path = "../../../../../tests/near.rs"]
pub mod near;

use fea::{
    BeamTheory, CrossSection, Dof, Girder, GroundSpring, Member, MemberKind, Model, Rail,
    RailSegment, RigidLink, Support,
};
use nalgebra::Vector3;
use serde_json::Value;
use splines::{Axis, Probe};

/// McConville's girder: 60 ft simply supported, overhangs of 15 ft; pounds and feet.
pub fn paper() -> Girder {
    Girder {
        spans: vec![60.0],
        overhangs: [15.0; 2],
        e: 4.32e9,
        g: Some(1.661_538e9),
        area: Some(1.0),
        i_vertical: 9.528,
        i_lateral: Some(0.874_97),
        j: Some(0.6552),
        rail_height: 3.6615,
        theory: BeamTheory::EulerBernoulli,
        stations: vec![-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0],
        ..Girder::default()
    }
}

/// Two spans of steel with all stiffnesses, flexible in shear; newtons and metres.
pub fn two_spans() -> Girder {
    Girder {
        spans: vec![20.0, 20.0],
        e: 2e11,
        g: Some(8e10),
        area: Some(0.02),
        i_vertical: 4e-4,
        i_lateral: Some(3e-5),
        j: Some(2e-5),
        ka_vertical: Some(0.004),
        ka_lateral: Some(0.01),
        theory: BeamTheory::Timoshenko,
        ..Girder::default()
    }
}

pub fn probes(axis: Axis, at: &[f64]) -> Vec<Probe> {
    at.iter().map(|&x| Probe { rail: 0, x, axis }).collect()
}

/// The same model with nodes: members are cut at `places` (member, fraction of its flexible part), and a
/// point at the rigid offset from each cut is linked to it. Returns the linked points, in the order of `places`.
pub fn with_nodes(model: &Model, places: &[(usize, f64, [f64; 3])]) -> (Model, Vec<usize>) {
    let mut cut = Model {
        members: Vec::new(),
        ..model.clone()
    };
    let mut linked = vec![0; places.len()];
    for (index, member) in model.members.iter().enumerate() {
        let end = |k: usize| {
            Vector3::from(model.points[member.points[k]]) + Vector3::from(member.offsets[k])
        };
        let mut own: Vec<usize> = (0..places.len())
            .filter(|&k| places[k].0 == index)
            .collect();
        own.sort_by(|&a, &b| places[a].1.total_cmp(&places[b].1));
        let mut rest = *member;
        for same in own.chunk_by(|&a, &b| places[a].1 == places[b].1) {
            let place = end(0) + (end(1) - end(0)) * places[same[0]].1;
            let node = cut.points.len();
            cut.points.push(place.into());
            let mut first = rest;
            first.points[1] = node;
            first.offsets[1] = [0.0; 3];
            first.releases[1] = [false; 6];
            cut.members.push(first);
            rest.points[0] = node;
            rest.offsets[0] = [0.0; 3];
            rest.releases[0] = [false; 6];
            for &k in same {
                linked[k] = cut.points.len();
                cut.points.push((place + Vector3::from(places[k].2)).into());
                cut.links.push(RigidLink {
                    from: node,
                    to: linked[k],
                });
            }
        }
        cut.members.push(rest);
    }
    (cut, linked)
}

/// A repeatable sequence of random numbers from 0 to 1.
pub struct Stream(fastrand::Rng);

impl Stream {
    pub fn new(seed: u64) -> Stream {
        Stream(fastrand::Rng::with_seed(seed))
    }

    pub fn next(&mut self) -> f64 {
        self.0.f64()
    }

    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
}

/// The mill girderway of `data/`, and its one rail.
pub fn mill(theory: BeamTheory) -> (Model, Rail) {
    let spec: Value =
        serde_json::from_str(include_str!("../data/mill_girderway.json")).expect("valid");
    let material = &spec["materials"][0];
    let number = |value: &Value| value.as_f64().expect("a number");
    let sections = list(&spec["sections"])
        .iter()
        .map(|s| CrossSection {
            e: number(&material["E"]),
            g: number(&material["G"]),
            area: number(&s["A"]),
            iy: number(&s["Iy"]),
            iz: number(&s["Iz"]),
            j: number(&s["J"]),
            shear_y: s["Asy"].as_f64(),
            shear_z: s["Asz"].as_f64(),
            mass: 0.0,
        })
        .collect();
    let mut members = Vec::new();
    let mut first = Vec::new();
    for (block, cells) in list(&spec["cells"]).iter().enumerate() {
        first.push(members.len());
        for (k, pair) in list(&cells["data"]).iter().enumerate() {
            let data = |name: &str| &spec["cell_data"][name][block][k];
            members.push(Member {
                points: [index(&pair[0]), index(&pair[1])],
                kind: if data("kind") == "truss" {
                    MemberKind::Truss
                } else {
                    MemberKind::Beam
                },
                section: index(data("section")),
                orientation: vector(data("orientation")),
                offsets: [vector(data("offset_a")), vector(data("offset_b"))],
                releases: [set(data("release_a")), set(data("release_b"))],
                tension: 0.0,
            });
        }
    }
    let supports = list(&spec["supports"])
        .iter()
        .map(|s| Support {
            point: index(&s["point"]),
            fixed: set(&s["fix"]),
        })
        .collect();
    let springs = list(&spec["springs"])
        .iter()
        .map(|s| GroundSpring {
            point: index(&s["point"]),
            dof: freedom(&s["dof"]),
            stiffness: number(&s["k"]),
        })
        .collect();
    let north = &spec["rails"]["north"];
    let segments = list(&north["segments"])
        .iter()
        .map(|s| RailSegment {
            member: first[index(&s["cell"][0])] + index(&s["cell"][1]),
            offset: vector(&s["offset"]),
        })
        .collect();
    let rail = Rail {
        origin: vector(&north["origin"]),
        axis: vector(&north["axis"]),
        segments,
        stations: list(&north["stations"]).iter().map(number).collect(),
    };
    let points = list(&spec["points"]).iter().map(vector).collect();
    let up = vector(&spec["up"]);
    (
        Model {
            points,
            sections,
            members,
            supports,
            springs,
            up,
            theory,
            ..Model::default()
        },
        rail,
    )
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().expect("a list")
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("an index") as usize
}

fn vector(value: &Value) -> [f64; 3] {
    std::array::from_fn(|k| value[k].as_f64().expect("a number"))
}

fn freedom(value: &Value) -> Dof {
    let name = value.as_str().expect("a name");
    Dof::ALL
        .into_iter()
        .find(|freedom| freedom.to_string() == name)
        .expect("a freedom")
}

fn set(value: &Value) -> [bool; 6] {
    let mut out = [false; 6];
    list(value)
        .iter()
        .for_each(|name| out[freedom(name) as usize] = true);
    out
}
