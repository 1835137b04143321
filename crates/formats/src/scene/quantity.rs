//! Quantities of a run, identified by their names in histories, events and charts.

use sim::{BodyDof, Channel};
use splines::Axis;

use super::motion::{NamedWheel, wheels};
use super::values::body::{Body, BodyMotion, DOFS};
use super::values::scene::{Scene, SceneRail};
use super::values::wheel::WheelKind;
use crate::units::Dimension;

/// A named linear combination of channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Its name: `time`, `<body>.x`, `<truck>.wheel1.vertical`, ...
    pub name: String,
    /// Its dimension; angles have the dimension of a pure number.
    pub dimension: Dimension,
    /// Channels and their factors.
    pub terms: Vec<(Channel, f64)>,
}

/// All quantities that a run of `scene` records: time; the quantities of bodies, wheels, ropes, stops and gauges; and
/// the sums of the vertical, lateral and longitudinal forces on each rail.
#[must_use]
pub fn quantities(scene: &Scene) -> Vec<Quantity> {
    let mut list = List(Vec::new());
    list.one("time", Dimension::TIME, Channel::Time);
    for (b, body) in scene.bodies.iter().enumerate() {
        list.body(b, body);
    }
    let wheels = wheels(scene);
    for (w, wheel) in wheels.iter().enumerate() {
        list.wheel(w, wheel);
    }
    for (r, rope) in scene.ropes.iter().enumerate() {
        list.one(
            format!("{}.tension", rope.name),
            Dimension::FORCE,
            Channel::Tension(r),
        );
        list.one(
            format!("{}.length", rope.name),
            Dimension::LENGTH,
            Channel::Length(r),
        );
    }
    let mut met = 0..0;
    for stop in &scene.stops {
        met = met.end..met.end + stop.points.len();
        let forces = met
            .clone()
            .map(|meeting| (Channel::Stop(meeting), 1.0))
            .collect();
        list.sum(format!("{}.force", stop.name), Dimension::FORCE, forces);
    }
    let gauges = scene.structures.iter().flat_map(|structure| {
        structure
            .gauges
            .iter()
            .map(move |gauge| (format!("{}.{}", structure.name, gauge.name), gauge))
    });
    for (k, (name, gauge)) in gauges.enumerate() {
        let sign = if gauge.axis == Axis::Vertical {
            -1.0
        } else {
            1.0
        };
        list.sum(name, Dimension::LENGTH, vec![(Channel::Gauge(k), sign)]);
    }
    for (r, rail) in scene.rails.iter().enumerate() {
        list.rail(r, rail, scene, &wheels);
    }
    list.0
}

struct List(Vec<Quantity>);

impl List {
    fn one(&mut self, name: impl Into<String>, dimension: Dimension, channel: Channel) {
        self.sum(name, dimension, vec![(channel, 1.0)]);
    }

    fn sum(&mut self, name: impl Into<String>, dimension: Dimension, terms: Vec<(Channel, f64)>) {
        self.0.push(Quantity {
            name: name.into(),
            dimension,
            terms,
        });
    }

    fn body(&mut self, b: usize, body: &Body) {
        let name = &body.name;
        if body.in_space {
            for (axis, dof) in ["X", "Y", "Z"].into_iter().zip(BodyDof::ALL) {
                self.one(
                    format!("{name}.{axis}"),
                    Dimension::LENGTH,
                    Channel::Displacement(b, dof),
                );
                self.one(
                    format!("{name}.{axis}_speed"),
                    Dimension::SPEED,
                    Channel::Speed(b, dof),
                );
            }
            return;
        }
        self.one(
            format!("{name}.x"),
            Dimension::LENGTH,
            Channel::Displacement(b, BodyDof::X),
        );
        let down = vec![(Channel::Displacement(b, BodyDof::Y), -1.0)];
        self.sum(format!("{name}.deflection"), Dimension::LENGTH, down);
        for (i, dof) in BodyDof::ALL
            .into_iter()
            .enumerate()
            .skip(2)
            .filter(|(i, _)| body.free[*i])
        {
            let dimension = if i == 2 {
                Dimension::LENGTH
            } else {
                Dimension::NUMBER
            };
            self.one(
                format!("{name}.{}", DOFS[i]),
                dimension,
                Channel::Displacement(b, dof),
            );
        }
        self.one(
            format!("{name}.speed"),
            Dimension::SPEED,
            Channel::Speed(b, BodyDof::X),
        );
        if matches!(
            body.motion,
            BodyMotion::Prescribed(_) | BodyMotion::Driven(_)
        ) {
            self.one(format!("{name}.drive"), Dimension::FORCE, Channel::Drive(b));
        }
        if body.brake.is_some() {
            self.one(format!("{name}.brake"), Dimension::FORCE, Channel::Brake(b));
        }
    }

    fn wheel(&mut self, w: usize, wheel: &NamedWheel) {
        let name = &wheel.name;
        let parts = [
            ("x", Dimension::LENGTH, Channel::Position(w)),
            ("vertical", Dimension::FORCE, Channel::Vertical(w)),
            ("lateral", Dimension::FORCE, Channel::Lateral(w)),
            ("traction", Dimension::FORCE, Channel::Traction(w)),
            ("penetration", Dimension::LENGTH, Channel::Penetration(w)),
            ("rail_deflection", Dimension::LENGTH, Channel::Deflection(w)),
        ];
        for (part, dimension, channel) in parts {
            self.one(format!("{name}.{part}"), dimension, channel);
        }
        if wheel.spins {
            self.one(
                format!("{name}.spin_angle"),
                Dimension::NUMBER,
                Channel::SpinAngle(w),
            );
            self.one(
                format!("{name}.spin_speed"),
                Dimension::of(0, 0, -1),
                Channel::SpinSpeed(w),
            );
        }
        if wheel.is_prescribed {
            self.one(
                format!("{name}.moment"),
                Dimension::MOMENT,
                Channel::SpinMoment(w),
            );
        }
    }

    /// Sums of the forces of the wheels on a rail.
    fn rail(&mut self, r: usize, rail: &SceneRail, scene: &Scene, wheels: &[NamedWheel]) {
        let on_rail = wheels
            .iter()
            .enumerate()
            .filter(|(_, wheel)| wheel.rail == r);
        let forces: Vec<_> = on_rail.map(|(w, _)| (Channel::Vertical(w), 1.0)).collect();
        if !forces.is_empty() {
            self.sum(format!("{}.reaction", rail.name), Dimension::FORCE, forces);
        }
        let kind = |wheel: &NamedWheel| &scene.wheels[wheel.kind];
        let mut sum =
            |part: &str, counts: &dyn Fn(&WheelKind) -> bool, channel: fn(usize) -> Channel| {
                let on_rail = wheels
                    .iter()
                    .enumerate()
                    .filter(|(_, wheel)| wheel.rail == r && counts(kind(wheel)));
                let forces: Vec<_> = on_rail.map(|(w, _)| (channel(w), 1.0)).collect();
                if !forces.is_empty() {
                    self.sum(format!("{}.{part}", rail.name), Dimension::FORCE, forces);
                }
            };
        sum(
            "lateral",
            &|wheel| wheel.lateral.is_some(),
            Channel::Lateral,
        );
        sum(
            "traction",
            &|wheel| wheel.driven || wheel.braked || wheel.friction.is_some(),
            Channel::Traction,
        );
    }
}
