//! Random structures with rails, dead loads, and cases of trains.

use fastrand::Rng;
use fea::{
    BeamTheory, CrossSection, Dof, Girder, GroundSpring, Member, Model, Rail, RailSegment,
    RigidLink, Support,
};
use trains::{DeadLoads, Train, TrainCase, TrainWheel};

/// A structure, what stands on it, and where its spans end.
#[derive(Debug)]
pub struct Scene {
    pub model: Model,
    pub rails: Vec<Rail>,
    pub dead: DeadLoads,
    pub case: TrainCase,
    /// By rail: coordinates of the ends of spans.
    pub spans: Vec<Vec<f64>>,
}

/// A scene from its seed: a continuous girder or a frame with one or two rails, with one to three trains.
pub fn scene(seed: u64) -> Scene {
    let mut dice = Rng::with_seed(seed);
    let theory = if dice.bool() {
        BeamTheory::Timoshenko
    } else {
        BeamTheory::EulerBernoulli
    };
    let (model, rails, spans) = if dice.u8(..3) == 0 {
        girder(&mut dice, theory)
    } else {
        frame(&mut dice, theory)
    };
    let ranges: Vec<[f64; 2]> = rails.iter().map(|rail| covered(&model, rail)).collect();
    let case = case(&mut dice, &rails, &ranges);
    let dead = if dice.bool() {
        let lines = rails
            .iter()
            .map(|_| {
                if dice.bool() {
                    between(&mut dice, 0.1, 4.0)
                } else {
                    0.0
                }
            })
            .collect();
        DeadLoads {
            gravity: if dice.bool() { 9.81 } else { 0.0 },
            lines,
        }
    } else {
        DeadLoads::default()
    };
    Scene {
        model,
        rails,
        dead,
        case,
        spans,
    }
}

/// First and last coordinate that a rail covers.
pub fn covered(model: &Model, rail: &Rail) -> [f64; 2] {
    let ends = rail
        .segments
        .iter()
        .flat_map(|segment| segment_ends(model, rail, segment.member));
    ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    })
}

/// Coordinates of end 0 and end 1 of the flexible part of a member along a rail.
pub fn segment_ends(model: &Model, rail: &Rail, member: usize) -> [f64; 2] {
    let axis = unit(rail.axis);
    let member = &model.members[member];
    [0, 1].map(|end| {
        let point = model.points[member.points[end]];
        (0..3)
            .map(|k| (point[k] + member.offsets[end][k] - rail.origin[k]) * axis[k])
            .sum()
    })
}

pub fn unit(v: [f64; 3]) -> [f64; 3] {
    let size = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / size)
}

fn between(dice: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * dice.f64()
}

fn girder(dice: &mut Rng, theory: BeamTheory) -> (Model, Vec<Rail>, Vec<Vec<f64>>) {
    let spans: Vec<f64> = (0..dice.usize(1..=6))
        .map(|_| between(dice, 3.0, 12.0))
        .collect();
    let overhangs = [0, 1].map(|_| {
        if dice.u8(..3) == 0 {
            between(dice, 0.3, 2.5)
        } else {
            0.0
        }
    });
    let made = Girder {
        spans: spans.clone(),
        overhangs,
        e: 2.1e8,
        g: Some(8.1e7),
        area: Some(0.02),
        i_vertical: between(dice, 2e-4, 2e-3),
        i_lateral: Some(1e-4),
        j: Some(4e-6),
        ka_vertical: Some(0.005),
        ka_lateral: Some(0.009),
        rail_height: if dice.bool() {
            between(dice, 0.1, 0.6)
        } else {
            0.0
        },
        mass_per_length: Some(0.15),
        theory,
        ..Girder::default()
    };
    let (model, rail) = made.model_and_rail().expect("the girder is valid");
    let mut ends = vec![0.0];
    spans
        .iter()
        .for_each(|span| ends.push(ends[ends.len() - 1] + span));
    (model, vec![rail], vec![ends])
}

/// Columns along one or two lines, girders between them with rigid ends (gaps of the rail over columns) or without,
/// some turned end for end, some slightly inclined, some hinged at one end; frames across where there are two lines.
fn frame(dice: &mut Rng, theory: BeamTheory) -> (Model, Vec<Rail>, Vec<Vec<f64>>) {
    let bays = dice.usize(1..=4);
    let lines = dice.usize(1..=2);
    let steel = |area: f64, inertia: f64, mass: f64| CrossSection {
        e: 2.1e8,
        g: 8.1e7,
        area,
        iy: inertia / 4.0,
        iz: inertia,
        j: inertia / 40.0,
        shear_y: Some(area / 3.0),
        shear_z: Some(area / 2.0),
        mass,
    };
    let mut model = Model {
        sections: vec![
            steel(0.02, 8e-4, 0.15),
            steel(0.03, 5e-4, 0.0),
            steel(0.01, 2e-4, 0.08),
        ],
        up: [0.0, 0.0, 1.0],
        theory,
        ..Model::default()
    };
    let lengths: Vec<f64> = (0..bays).map(|_| between(dice, 4.0, 10.0)).collect();
    let half = if dice.bool() {
        between(dice, 0.05, 0.3)
    } else {
        0.0
    };
    let slope = if dice.u8(..3) == 0 {
        between(dice, -0.05, 0.05)
    } else {
        0.0
    };
    let width = between(dice, 6.0, 20.0);
    let mut rails = Vec::new();
    let mut spans = Vec::new();
    let mut tops: Vec<Vec<usize>> = Vec::new();
    for line in 0..lines {
        let y = width * line as f64;
        let start = between(dice, -3.0, 3.0) * line as f64;
        let mut x = start;
        let mut top = Vec::new();
        let mut supports = Vec::new();
        let origin = [start + between(dice, -5.0, 5.0), y, 6.0];
        for bay in 0..=bays {
            let height = 6.0
                + slope * (x - start)
                + if dice.u8(..4) == 0 {
                    between(dice, -0.1, 0.1)
                } else {
                    0.0
                };
            model.points.push([x, y, 0.0]);
            let foot = model.points.len() - 1;
            let fixed = [true, true, true, true, dice.bool(), true];
            model.supports.push(Support { point: foot, fixed });
            if !fixed[4] {
                model.springs.push(GroundSpring {
                    point: foot,
                    dof: Dof::Ry,
                    stiffness: between(dice, 1e3, 1e5),
                });
            }
            model.points.push([x, y, height]);
            let mut head = model.points.len() - 1;
            model
                .members
                .push(Member::beam([foot, head], 1, [1.0, 0.0, 0.0]));
            if dice.u8(..3) == 0 {
                // A bracket: the girder sits beside the column.
                model.points.push([x, y - 0.4, height]);
                model.links.push(RigidLink {
                    from: head,
                    to: head + 1,
                });
                head += 1;
            }
            top.push(head);
            supports.push(x - origin[0]);
            x += lengths.get(bay).copied().unwrap_or(0.0);
        }
        let mut segments = Vec::new();
        let offset = [
            0.0,
            if dice.bool() {
                between(dice, -0.2, 0.2)
            } else {
                0.0
            },
            between(dice, 0.0, 0.5),
        ];
        for bay in 0..bays {
            let mut points = [top[bay], top[bay + 1]];
            let mut offsets = [[half, 0.0, 0.0], [-half, 0.0, 0.0]];
            if dice.u8(..3) == 0 {
                points.reverse();
                offsets.reverse();
            }
            let mut member = Member {
                offsets,
                ..Member::beam(points, 0, [0.0, 0.0, 1.0])
            };
            if dice.u8(..4) == 0 {
                let end = dice.usize(..2);
                member.releases[end][Dof::Rz as usize] = true;
            }
            model.members.push(member);
            segments.push(RailSegment {
                member: model.members.len() - 1,
                offset,
            });
        }
        rails.push(Rail {
            origin,
            axis: [1.0, 0.0, 0.0],
            segments,
            stations: Vec::new(),
        });
        let range = covered(&model, &rails[line]);
        supports[0] = range[0];
        supports[bays] = range[1];
        spans.push(supports);
        tops.push(top);
    }
    if lines == 2 {
        for (a, b) in tops[0].iter().zip(&tops[1]) {
            model
                .members
                .push(Member::beam([*a, *b], 2, [0.0, 0.0, 1.0]));
        }
    }
    (model, rails, spans)
}

fn case(dice: &mut Rng, rails: &[Rail], ranges: &[[f64; 2]]) -> TrainCase {
    let count = [1, 1, 1, 2, 2, 3][dice.usize(..6)];
    let apart = |r: usize| rails[0].origin[0] - rails[r].origin[0];
    // The stretch over which all rails run, measured on rail 0.
    let low = (0..rails.len())
        .map(|r| ranges[r][0] - apart(r))
        .fold(f64::NEG_INFINITY, f64::max);
    let high = (0..rails.len())
        .map(|r| ranges[r][1] - apart(r))
        .fold(f64::INFINITY, f64::min);
    let room = (high - low).max(1.0) / (count as f64) * 0.6;
    let mut trains: Vec<Train> = Vec::new();
    for _ in 0..count {
        if !trains.is_empty() && dice.u8(..3) == 0 {
            let again = trains[dice.usize(..trains.len())].clone();
            trains.push(again);
            continue;
        }
        trains.push(train(dice, rails.len(), room));
    }
    TrainCase {
        trains,
        ordered: dice.u8(..3) == 0,
        gap: if dice.bool() {
            between(dice, 0.0, 0.3)
        } else {
            0.0
        },
        dead: [0.0, 1.0, 1.35][dice.usize(..3)],
    }
}

fn train(dice: &mut Rng, rails: usize, room: f64) -> Train {
    let count = dice.usize(1..=6);
    let length = between(dice, 0.2, 1.0) * room;
    let lateral = dice.u8(..3) == 0;
    let along = dice.u8(..3) == 0;
    let eccentric = dice.u8(..3) == 0;
    let own = dice.usize(..rails);
    let both = dice.bool();
    let equal = dice.bool();
    let mut wheels: Vec<TrainWheel> = (0..count)
        .map(|_| TrainWheel {
            rail: if both { dice.usize(..rails) } else { own },
            x: between(dice, 0.0, length),
            vertical: if equal {
                100.0
            } else {
                between(dice, 20.0, 200.0)
            },
            lateral: if lateral {
                between(dice, -20.0, 20.0)
            } else {
                0.0
            },
            longitudinal: if along {
                between(dice, -20.0, 20.0)
            } else {
                0.0
            },
            eccentricity: if eccentric {
                between(dice, -0.05, 0.05)
            } else {
                0.0
            },
        })
        .collect();
    wheels.sort_by(|a, b| a.x.total_cmp(&b.x));
    // the position of a train is that of its first wheel
    let start = wheels[0].x;
    wheels.iter_mut().for_each(|wheel| wheel.x -= start);
    Train {
        wheels,
        ends: [0, 1].map(|_| {
            if dice.bool() {
                between(dice, 0.0, 0.05 * room)
            } else {
                0.0
            }
        }),
        turned: dice.bool(),
        reverses: dice.u8(..3) > 0,
        enters: dice.u8(..3) == 0,
    }
}
