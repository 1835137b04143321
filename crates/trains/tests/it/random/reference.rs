//! Responses evaluated state by state, without envelopes: influence lines of the very section from the structural solver,
//! a rail of its own for each eccentricity, and dead load by quadrature over rails along all members.

use std::collections::BTreeMap;

use fea::{Effect, FactoredFrame, ForceComponent, Model, Rail, RailSegment};
use splines::{Axis, Compliance, Influence, InfluenceLines, Probe};
use trains::{GirderResponse, Orientation, Train};

use super::scene::{Scene, covered, segment_ends, unit};

/// Places and weights of Gauss's rule with four points over -1 to 1.
const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_9],
    [-0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_9],
];

/// A section of a member under a rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub rail: usize,
    pub x: f64,
    pub member: usize,
    /// Fraction of the member from its end 0.
    pub fraction: f64,
}

/// A wheel in a state.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    pub rail: usize,
    pub x: f64,
    /// Along x, y (up) and z of the rail.
    pub force: [f64; 3],
    pub eccentricity: f64,
}

/// The structure with a rail for each eccentricity.
pub struct Reference<'a> {
    scene: &'a Scene,
    frame: FactoredFrame,
    /// By rail and eccentricity, the index of its rail.
    beside: BTreeMap<(usize, u64), usize>,
    pub ranges: Vec<[f64; 2]>,
    /// Rails along members with mass, by member: index of the rail, its length.
    weighted: Vec<(usize, f64, usize)>,
}

impl<'a> Reference<'a> {
    pub fn new(scene: &'a Scene) -> Reference<'a> {
        let mut rails = scene.rails.clone();
        let mut beside = BTreeMap::new();
        for train in &scene.case.trains {
            for wheel in &train.wheels {
                for side in [wheel.eccentricity, -wheel.eccentricity] {
                    beside
                        .entry((wheel.rail, (side + 0.0).to_bits()))
                        .or_insert_with(|| {
                            let mut rail = scene.rails[wheel.rail].clone();
                            let z = cross(unit(rail.axis), scene.model.up);
                            for segment in &mut rail.segments {
                                (0..3).for_each(|k| segment.offset[k] += side * z[k]);
                            }
                            rails.push(rail);
                            rails.len() - 1
                        });
                }
            }
        }
        let mut weighted = Vec::new();
        for (index, member) in scene.model.members.iter().enumerate() {
            if scene.model.sections[member.section].mass > 0.0 {
                let ends = [0, 1].map(|end| {
                    let point = scene.model.points[member.points[end]];
                    [0, 1, 2].map(|k| point[k] + member.offsets[end][k])
                });
                let axis = [0, 1, 2].map(|k| ends[1][k] - ends[0][k]);
                let segments = vec![RailSegment {
                    member: index,
                    offset: [0.0; 3],
                }];
                rails.push(Rail {
                    origin: ends[0],
                    axis,
                    segments,
                    stations: Vec::new(),
                });
                weighted.push((
                    rails.len() - 1,
                    axis.iter().map(|a| a * a).sum::<f64>().sqrt(),
                    index,
                ));
            }
        }
        let frame = FactoredFrame::new(&scene.model, &rails).expect("the structure is stable");
        let ranges = scene
            .rails
            .iter()
            .map(|rail| covered(&scene.model, rail))
            .collect();
        Reference {
            scene,
            frame,
            beside,
            ranges,
            weighted,
        }
    }

    pub fn model(&self) -> &Model {
        &self.scene.model
    }

    /// Sections at a coordinate: two where members meet.
    pub fn places(&self, rail: usize, x: f64) -> Vec<Place> {
        let slack = 1e-9;
        let on = |segment: &RailSegment| {
            let [a, b] = segment_ends(&self.scene.model, &self.scene.rails[rail], segment.member);
            let fraction = (x - a) / (b - a);
            (-slack..=1.0 + slack).contains(&fraction).then_some(Place {
                rail,
                x,
                member: segment.member,
                fraction: fraction.clamp(0.0, 1.0),
            })
        };
        self.scene.rails[rail]
            .segments
            .iter()
            .filter_map(on)
            .collect()
    }

    /// Influence lines of all internal forces of sections, six for each.
    pub fn lines(&self, places: &[Place]) -> InfluenceLines {
        let effects: Vec<Effect> = places
            .iter()
            .flat_map(|place| {
                ForceComponent::ALL.map(|component| Effect::InternalForce {
                    member: place.member,
                    place: place.fraction,
                    component,
                })
            })
            .collect();
        self.effect_lines(&effects)
    }

    pub fn effect_lines(&self, effects: &[Effect]) -> InfluenceLines {
        self.frame
            .influence_lines(&self.scene.model, effects)
            .expect("the effects exist")
    }

    /// The wheels of a train in a state; those beyond their rails are left out.
    pub fn loads(&self, train: &Train, position: f64, stance: Orientation) -> Vec<Load> {
        let first = &self.scene.rails[train.wheels[0].rail];
        let axis = unit(first.axis);
        let [lateral, along, side] = stance.signs;
        let mut out = Vec::new();
        for wheel in &train.wheels {
            let own = &self.scene.rails[wheel.rail];
            let shift: f64 = (0..3)
                .map(|k| (first.origin[k] - own.origin[k]) * axis[k])
                .sum();
            let x = position + if stance.turned { -wheel.x } else { wheel.x } + shift;
            let [low, high] = self.ranges[wheel.rail];
            let slack = if train.enters { 1e-12 } else { 1e-9 };
            if x < low - slack || x > high + slack {
                assert!(
                    train.enters,
                    "a wheel at {x} is beyond its rail {low} to {high}"
                );
                continue;
            }
            out.push(Load {
                rail: wheel.rail,
                x: x.clamp(low, high),
                force: [
                    along * wheel.longitudinal,
                    -wheel.vertical,
                    lateral * wheel.lateral,
                ],
                eccentricity: side * wheel.eccentricity,
            });
        }
        out
    }

    /// Sums of influence lines under loads.
    pub fn respond(
        &self,
        lines: &InfluenceLines,
        loads: &[Load],
        out: &mut [f64],
        work: &mut Vec<f64>,
    ) {
        work.resize(out.len(), 0.0);
        for load in loads {
            let rail = self.beside[&(load.rail, (load.eccentricity + 0.0).to_bits())];
            for (force, axis) in
                load.force
                    .iter()
                    .zip([Axis::Longitudinal, Axis::Vertical, Axis::Lateral])
            {
                if *force != 0.0 {
                    lines
                        .fill(
                            Probe {
                                rail,
                                x: load.x,
                                axis,
                            },
                            work,
                        )
                        .expect("the load is on a rail that resists it");
                    out.iter_mut()
                        .zip(work.iter())
                        .for_each(|(out, one)| *out += force * one);
                }
            }
        }
    }

    /// Sums of influence lines under dead load, for lines that are cubic between the cuts of members: ends of
    /// segments and the sections themselves.
    pub fn dead(&self, lines: &InfluenceLines, count: usize, cuts: &[Place]) -> Vec<f64> {
        let mut out = vec![0.0; count];
        let mut work = vec![0.0; count];
        let mut add = |probe: Probe, weight: f64, out: &mut Vec<f64>| {
            lines
                .fill(probe, &mut work)
                .expect("the structure resists weight");
            out.iter_mut()
                .zip(&work)
                .for_each(|(out, one)| *out += weight * one);
        };
        let dead = &self.scene.dead;
        for (rail, load) in dead
            .lines
            .iter()
            .enumerate()
            .filter(|(_, load)| **load != 0.0)
        {
            let mut ends: Vec<f64> = Vec::new();
            for segment in &self.scene.rails[rail].segments {
                let [a, b] =
                    segment_ends(&self.scene.model, &self.scene.rails[rail], segment.member);
                ends.extend([a, b]);
                ends.extend(
                    cuts.iter()
                        .filter(|cut| cut.member == segment.member)
                        .map(|cut| a + cut.fraction * (b - a)),
                );
            }
            ends.sort_by(f64::total_cmp);
            // In a gap the nearer end carries the rail: it is cut in its middle.
            let middles: Vec<f64> = ends
                .windows(2)
                .map(|pair| 0.5 * (pair[0] + pair[1]))
                .collect();
            ends.extend(middles);
            ends.sort_by(f64::total_cmp);
            for pair in ends.windows(2) {
                for [at, weight] in GAUSS {
                    let half = 0.5 * (pair[1] - pair[0]);
                    let x = 0.5 * (pair[0] + pair[1]) + half * at;
                    if half > 0.0 {
                        add(
                            Probe {
                                rail,
                                x,
                                axis: Axis::Vertical,
                            },
                            -load * weight * half,
                            &mut out,
                        );
                    }
                }
            }
        }
        for &(rail, length, member) in &self.weighted {
            if dead.gravity == 0.0 {
                break;
            }
            let model = &self.scene.model;
            let of = &model.members[member];
            let mass = model.sections[of.section].mass;
            let mut ends = vec![0.0, length];
            ends.extend(
                cuts.iter()
                    .filter(|cut| cut.member == member)
                    .map(|cut| cut.fraction * length),
            );
            ends.sort_by(f64::total_cmp);
            let ends_of = [0, 1].map(|end| {
                let point = model.points[of.points[end]];
                [0, 1, 2].map(|k| point[k] + of.offsets[end][k])
            });
            let x_axis = unit([0, 1, 2].map(|k| ends_of[1][k] - ends_of[0][k]));
            let up = unit(model.up);
            let sine = dot(x_axis, up);
            let cosine = (1.0 - sine * sine).sqrt();
            for pair in ends.windows(2) {
                for [at, weight] in GAUSS {
                    let half = 0.5 * (pair[1] - pair[0]);
                    let x = 0.5 * (pair[0] + pair[1]) + half * at;
                    let load = -mass * dead.gravity * weight * half;
                    add(
                        Probe {
                            rail,
                            x,
                            axis: Axis::Vertical,
                        },
                        load * cosine,
                        &mut out,
                    );
                    if sine != 0.0 {
                        add(
                            Probe {
                                rail,
                                x,
                                axis: Axis::Longitudinal,
                            },
                            load * sine,
                            &mut out,
                        );
                    }
                }
            }
        }
        out
    }

    /// The six quantities of a section from the internal force of its member in its own axes.
    pub fn quantities(&self, place: &Place, own: &[f64]) -> [f64; 6] {
        let model = &self.scene.model;
        let member = &model.members[place.member];
        let ends = [0, 1].map(|end| {
            let point = model.points[member.points[end]];
            [0, 1, 2].map(|k| point[k] + member.offsets[end][k])
        });
        let x = unit([0, 1, 2].map(|k| ends[1][k] - ends[0][k]));
        let along = dot(member.orientation, x);
        let y = unit([0, 1, 2].map(|k| member.orientation[k] - along * x[k]));
        let z = cross(x, y);
        let rail = unit(self.scene.rails[place.rail].axis);
        // The face that looks along the rail; on the other face force and moment are opposite.
        let face = dot(x, rail).signum();
        let vector = |from: usize| {
            [0, 1, 2]
                .map(|k| face * (own[from] * x[k] + own[from + 1] * y[k] + own[from + 2] * z[k]))
        };
        let (force, moment) = (vector(0), vector(3));
        let t = x.map(|c| c * face);
        let slope = dot(unit(model.up), t);
        let u = unit([0, 1, 2].map(|k| unit(model.up)[k] - slope * t[k]));
        let w = cross(t, u);
        [
            dot(force, t),
            dot(moment, t),
            -dot(force, u),
            dot(force, w),
            dot(moment, w),
            dot(moment, u),
        ]
    }

    /// Deflection of a rail at a coordinate under loads.
    pub fn deflection(
        &self,
        surface: &dyn Compliance,
        rail: usize,
        x: f64,
        quantity: GirderResponse,
        loads: &[Load],
    ) -> f64 {
        let (axis, sign) = match quantity {
            GirderResponse::LateralDeflection => (Axis::Lateral, 1.0),
            _ => (Axis::Vertical, -1.0),
        };
        let mut influence = Influence::zeros(2);
        let mut sum = 0.0;
        for load in loads {
            let own = self.beside[&(load.rail, (load.eccentricity + 0.0).to_bits())];
            for (force, of) in
                load.force
                    .iter()
                    .zip([Axis::Longitudinal, Axis::Vertical, Axis::Lateral])
            {
                if *force != 0.0 {
                    let at = [
                        Probe { rail, x, axis },
                        Probe {
                            rail: own,
                            x: load.x,
                            axis: of,
                        },
                    ];
                    surface
                        .fill(&at, &mut influence)
                        .expect("both are on rails");
                    sum += sign * force * influence.value[(0, 1)];
                }
            }
        }
        sum
    }

    pub fn frame(&self) -> &FactoredFrame {
        &self.frame
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
