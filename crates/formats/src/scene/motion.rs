//! Converts a scene of the file format to a scene of the simulator.

use sim::{Contact, NormalLaw};
use splines::Probe;
use thiserror::Error;

use super::values::actuator::Spin;
use super::values::body::{Body, BodyMotion};
use super::values::scene::{Analysis, Scene};
use super::values::structure::Gauge;
use super::values::truck::Truck;
use super::values::wheel::{DamperVelocity, FrictionLaw, NormalForceLaw, WheelKind};
use crate::units::{Dimension, Length, Scale, Units};

/// Sliding speed s at which a brake has 76 % of its friction mu N tanh(s / speed), ft/s.
const BRAKE_SPEED_FT: f64 = 0.02;

/// Input of the simulation: its scene, and the wheels by name.
pub struct SimulationInput {
    /// The scene.
    pub scene: sim::Scene,
    /// The wheels, in the simulator's order.
    pub wheels: Vec<NamedWheel>,
}

/// One wheel of a scene.
pub struct NamedWheel {
    /// `<truck>.wheel<n>`, counted from 1.
    pub name: String,
    /// Its body.
    pub body: usize,
    /// Its rail, as an index into the scene's rails.
    pub rail: usize,
    /// Index of its wheel type.
    pub kind: usize,
    /// Whether its angle is a variable: it is a degree of freedom, or prescribed.
    pub spins: bool,
    /// Whether its spin is prescribed.
    pub is_prescribed: bool,
}

/// An equaliser whose wheels carry unequal fractions of its load.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "{truck}: all wheels under one equaliser must carry equal loads: both its ends need the same number of wheels"
)]
pub struct UnequalFractions {
    /// Name of the truck.
    pub truck: String,
}

/// Makes the input of the simulation: one contact for each top-level node of each truck, and
/// forces in the units of the scene.
///
/// # Errors
/// An equaliser whose wheels carry unequal fractions of its load.
pub fn simulation_input(scene: &Scene) -> Result<SimulationInput, UnequalFractions> {
    let bodies = scene.bodies.iter().map(body).collect();
    let wheels: Vec<sim::Wheel> = scene.wheels.iter().map(wheel).collect();
    let mut contacts = Vec::new();
    for truck in &scene.trucks {
        let rail = &scene.rails[truck.rail];
        for node in &truck.tree {
            let below = node.wheels();
            if below
                .iter()
                .any(|(_, fraction)| (fraction - below[0].1).abs() > 1e-12)
            {
                return Err(UnequalFractions {
                    truck: truck.name.clone(),
                });
            }
            contacts.push(Contact {
                body: truck.body,
                structure: rail.structure,
                rail: rail.rail,
                at: truck.at,
                offsets: below.into_iter().map(|(offset, _)| offset).collect(),
                wheel: truck.wheel,
            });
        }
    }
    let names = self::wheels(scene);
    let scene = sim::Scene {
        actuators: sim::Actuators {
            spins: turns(scene),
            ..actuators(scene, &contacts)
        },
        gauges: gauges(scene),
        gravity: scene.gravity,
        bodies,
        wheels,
        contacts,
        analysis: match scene.analysis {
            Analysis::Dynamic => sim::Analysis::Dynamic,
            Analysis::QuasiStatic => sim::Analysis::QuasiStatic,
        },
        end: scene.end,
        output_dt: scene.dt,
        output_parts: 1,
        accuracy: scene.accuracy,
    };
    Ok(SimulationInput {
        scene,
        wheels: names,
    })
}

/// The wheels of `scene`, in the simulator's order.
#[must_use]
pub fn wheels(scene: &Scene) -> Vec<NamedWheel> {
    let of_truck = |(index, truck): (usize, &Truck)| {
        let kind = &scene.wheels[truck.wheel];
        let (name, body, rail, kind, spins) = (
            truck.name.clone(),
            truck.body,
            truck.rail,
            truck.wheel,
            kind.friction
                .is_some()
                .then_some(kind.spin_inertia.is_some()),
        );
        let numbers = 1..=truck.wheel_offsets().len();
        numbers.map(move |number| {
            let turned = scene
                .spins
                .iter()
                .any(|spin| (spin.truck, spin.wheel + 1) == (index, number));
            NamedWheel {
                name: format!("{name}.wheel{number}"),
                body,
                rail,
                kind,
                spins: spins.is_some_and(|spins| spins || turned),
                is_prescribed: turned,
            }
        })
    };
    scene.trucks.iter().enumerate().flat_map(of_truck).collect()
}

/// Wheels whose spin is prescribed, identified by their contacts.
fn turns(scene: &Scene) -> Vec<sim::PrescribedSpin> {
    let mut contact = 0;
    let mut turns = Vec::new();
    for (index, truck) in scene.trucks.iter().enumerate() {
        let mut first = 0;
        for node in &truck.tree {
            let count = node.wheels().len();
            let own =
                |spin: &&Spin| spin.truck == index && (first..first + count).contains(&spin.wheel);
            turns.extend(
                scene
                    .spins
                    .iter()
                    .filter(own)
                    .map(|spin| sim::PrescribedSpin {
                        contact,
                        wheel: spin.wheel - first,
                        motion: spin.motion.clone(),
                    }),
            );
            (contact, first) = (contact + 1, first + count);
        }
    }
    turns
}

/// Loads, drives and brakes. Drives and brakes act on the contacts of driven and braked wheels.
fn actuators(scene: &Scene, contacts: &[Contact]) -> sim::Actuators {
    let own = |b: usize, is_meant: &dyn Fn(&WheelKind) -> bool| {
        let all = contacts.iter().enumerate();
        all.filter(|(_, contact)| contact.body == b && is_meant(&scene.wheels[contact.wheel]))
            .map(|(index, _)| index)
            .collect()
    };
    let to_scene = Scale {
        from: Units {
            length: Length::Foot,
            ..scene.units
        },
        to: scene.units,
    };
    let mut out = sim::Actuators::default();
    for rope in &scene.ropes {
        let [from, to] = [0, 1].map(|end| sim::RopeEnd {
            body: rope.bodies[end],
            at: rope.at[end],
        });
        out.ropes.push(sim::Rope {
            from,
            to,
            stiffness: rope.stiffness,
            damping: rope.damping,
            length: rope.length,
            speed: rope.speed.clone(),
        });
    }
    for stop in &scene.stops {
        out.stops
            .extend(stop.points.iter().map(|meeting| sim::Stop {
                body: meeting.body,
                against: stop.against,
                at: meeting.at,
                axis: stop.axis,
                place: stop.place,
                side: meeting.side,
                stiffness: stop.stiffness,
                damping: stop.damping,
            }));
    }
    out.rules = scene
        .events
        .iter()
        .map(|event| event.rule.clone())
        .collect();
    let in_space = scene
        .bodies
        .iter()
        .enumerate()
        .filter(|(_, body)| body.in_space && body.start.is_none());
    out.hanging = in_space.map(|(b, _)| b).collect();
    for load in &scene.loads {
        let dof = sim::BodyDof::ALL[load.dof];
        out.loads.push(sim::Load {
            body: load.body,
            dof,
            value: load.value.clone(),
        });
    }
    for (b, body) in scene.bodies.iter().enumerate() {
        if let BodyMotion::Driven(drive) = &body.motion {
            out.drives.push(sim::Drive {
                body: b,
                speed: drive.speed.clone(),
                gain: drive.gain,
                max_force: drive.max_force.unwrap_or(f64::INFINITY),
                contacts: own(b, &|wheel| wheel.driven),
                until: body.brake.unwrap_or(f64::INFINITY),
            });
        }
        if let Some(from) = body.brake {
            let speed = BRAKE_SPEED_FT * to_scene.factor(Dimension::LENGTH);
            out.brakes.push(sim::Brake {
                body: b,
                from,
                speed,
                contacts: own(b, &|wheel| wheel.braked),
            });
        }
    }
    out
}

/// Gauges of all structures, in the order of the structures.
fn gauges(scene: &Scene) -> Vec<sim::Gauge> {
    let structures = scene.structures.iter().enumerate();
    structures
        .flat_map(|(structure, given)| {
            let probe = |gauge: &Gauge| Probe {
                rail: gauge.rail,
                x: gauge.x,
                axis: gauge.axis,
            };
            given.gauges.iter().map(move |gauge| sim::Gauge {
                structure,
                probe: probe(gauge),
            })
        })
        .collect()
}

fn body(body: &Body) -> sim::Body {
    let [y, z, roll, yaw, pitch] = body.start.unwrap_or_default();
    let motion = match &body.motion {
        BodyMotion::Prescribed(travel) => Some(travel.clone()),
        BodyMotion::Held | BodyMotion::Free | BodyMotion::Driven(_) => None,
    };
    let mut free = body.free;
    free[0] = body.motion.is_free();
    sim::Body {
        mass: body.mass,
        inertia: body.inertia,
        cg: body.cg,
        free,
        start: [body.x0, y, z, roll, yaw, pitch],
        start_speed: [body.v0, 0.0, 0.0, 0.0, 0.0, 0.0],
        motion,
        pinned: body.pinned.map(|(to, at)| sim::Pin { body: to, at }),
    }
}

fn wheel(wheel: &WheelKind) -> sim::Wheel {
    let vertical = &wheel.vertical;
    let (exponent, depth) = match vertical.law {
        NormalForceLaw::Linear => (1.0, 0.0),
        NormalForceLaw::Impact { exponent, depth } => (exponent, depth),
    };
    sim::Wheel {
        radius: wheel.radius,
        normal: NormalLaw {
            stiffness: vertical.k,
            exponent,
            damping: vertical.c,
            depth,
            damper: match vertical.damper {
                DamperVelocity::Rail => sim::Damper::Rail,
                DamperVelocity::Ground => sim::Damper::Ground,
            },
            bilateral: vertical.bilateral,
        },
        flange: wheel.lateral.as_ref().map(|lateral| sim::Flange {
            stiffness: lateral.k,
            clearance: lateral.clearance,
            release: lateral.release,
        }),
        friction: wheel.friction.as_ref().map(|friction| sim::Friction {
            law: match friction.law {
                FrictionLaw::Step => sim::FrictionLaw::Step,
                FrictionLaw::Coulomb => sim::FrictionLaw::Coulomb,
            },
            coefficient: friction.mu,
            slip: friction.slip,
        }),
        spin_inertia: wheel.spin_inertia,
    }
}
