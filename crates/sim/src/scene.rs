//! A scene: bodies that ride on wheels along the rails of structures.

use splines::Probe;

use crate::{Actuators, Error, Profile, Wheel, kinematics};

/// Freedom of a body on its track; rotations are small and right-handed about x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Freedom {
    /// Along the rail.
    X,
    /// Up.
    Y,
    /// To the right when looking along the rail.
    Z,
    /// About x.
    Roll,
    /// About y.
    Yaw,
    /// About z: positive lifts the front.
    Pitch,
}

impl Freedom {
    /// All six, in the order of every array of six in this crate.
    pub const ALL: [Freedom; 6] =
        [Freedom::X, Freedom::Y, Freedom::Z, Freedom::Roll, Freedom::Yaw, Freedom::Pitch];
}

/// Displacement of a point at `r` from a body's origin: row i gives component i per unit of each freedom,
/// u + theta cross r with theta = (roll, yaw, pitch).
#[must_use]
pub(crate) fn arm_rows(r: [f64; 3]) -> [[f64; 6]; 3] {
    let [rx, ry, rz] = r;
    [[1.0, 0.0, 0.0, 0.0, rz, -ry], [0.0, 1.0, 0.0, -rz, 0.0, rx], [0.0, 0.0, 1.0, ry, -rx, 0.0]]
}

/// Where a body is pinned to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Which body.
    pub to: usize,
    /// The pin from that body's origin.
    pub at: [f64; 3],
}

/// A rigid body on a track.
///
/// Its y and z are measured from where its wheels just touch the unloaded, straight rail, centred; its x
/// is the rail coordinate of its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Mass, > 0.
    pub mass: f64,
    /// Moments of inertia about the centre of mass for roll, yaw and pitch.
    pub inertia: [f64; 3],
    /// Centre of mass from the origin, in the track's frame.
    pub cg: [f64; 3],
    /// Which freedoms are free; the others stay at their starting value.
    pub free: [bool; 6],
    /// Starting displacements; the static equilibrium is found for y, roll and pitch where they are free.
    pub start: [f64; 6],
    /// Starting speeds.
    pub start_speed: [f64; 6],
    /// The prescribed x(t); `None`: x is free or held, as `free` says.
    pub motion: Option<Profile>,
    /// The body that carries this one: the origin moves with the pin, rotations that are not free are those of that body,
    /// free ones are about the track's axes. The starting x, y and z are not used; `None`: the track carries it.
    pub pinned: Option<Pin>,
}

impl Body {
    /// 6 x 6 mass matrix about the origin, m J^T J + diag(0, 0, 0, inertia), J the velocity of the centre of mass.
    #[must_use]
    pub(crate) fn mass_matrix(&self) -> [[f64; 6]; 6] {
        let rows = arm_rows(self.cg);
        let mut matrix = [[0.0; 6]; 6];
        for (i, line) in matrix.iter_mut().enumerate() {
            for (j, entry) in line.iter_mut().enumerate() {
                *entry = self.mass * rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
            }
            if i >= 3 {
                line[i] += self.inertia[i - 3];
            }
        }
        matrix
    }
}

/// One contact between a body and a rail: a wheel, or the wheels of massless equalisers, which share its
/// force evenly.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Which body.
    pub body: usize,
    /// Which structure.
    pub structure: usize,
    /// Which rail of the structure.
    pub rail: usize,
    /// Hub of the truck from the body's origin.
    pub at: [f64; 3],
    /// Wheels by their offsets along the rail from `at`; their mean is where the body is loaded.
    pub offsets: Vec<f64>,
    /// Which kind of wheel.
    pub wheel: usize,
}

/// A place on a rail whose displacement is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Which structure.
    pub structure: usize,
    /// Where on its rails, and in which direction.
    pub probe: Probe,
}

/// How the scene is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Analysis {
    /// The equations of motion.
    #[default]
    Dynamic,
    /// A sequence of static equilibria over the prescribed motion.
    QuasiStatic,
}

/// Everything that moves, and for how long.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Acceleration of gravity, downwards.
    pub gravity: f64,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Kinds of wheels.
    pub wheels: Vec<Wheel>,
    /// Contacts.
    pub contacts: Vec<Contact>,
    /// Places whose displacement is recorded.
    pub gauges: Vec<Gauge>,
    /// Loads, drives and brakes.
    pub actuators: Actuators,
    /// How it is solved.
    pub analysis: Analysis,
    /// Time at the end, from 0.
    pub end: f64,
    /// Interval of the history.
    pub output_dt: f64,
    /// Relative accuracy asked of displacements and forces.
    pub accuracy: f64,
}

impl Scene {
    /// Checks indices and numbers against each other and against `structures` structures.
    ///
    /// # Errors
    /// The first index that does not exist, or number that is out of range.
    pub fn check(&self, structures: usize) -> Result<(), Error> {
        let positive = |what: &'static str, found: f64| {
            if found > 0.0 && found.is_finite() {
                Ok(())
            } else {
                Err(Error::Number { what, wanted: "positive", found })
            }
        };
        positive("end time", self.end)?;
        positive("output interval", self.output_dt)?;
        positive("accuracy", self.accuracy)?;
        for body in &self.bodies {
            positive("mass", body.mass)?;
        }
        kinematics::check(&self.bodies)?;
        for wheel in &self.wheels {
            positive("wheel radius", wheel.radius)?;
            positive("wheel stiffness", wheel.normal.stiffness)?;
            if wheel.normal.exponent < 1.0 {
                return Err(Error::Number {
                    what: "contact exponent",
                    wanted: "at least 1",
                    found: wheel.normal.exponent,
                });
            }
            if let Some(inertia) = wheel.spin_inertia {
                positive("spin inertia", inertia)?;
            }
        }
        for gauge in &self.gauges {
            if gauge.structure >= structures {
                return Err(Error::NoSuch { what: "structure", index: gauge.structure });
            }
        }
        for contact in &self.contacts {
            for (what, index, count) in [
                ("body", contact.body, self.bodies.len()),
                ("structure", contact.structure, structures),
                ("wheel", contact.wheel, self.wheels.len()),
            ] {
                if index >= count {
                    return Err(Error::NoSuch { what, index });
                }
            }
            if contact.offsets.is_empty() {
                return Err(Error::Number {
                    what: "wheels of a contact",
                    wanted: "at least one",
                    found: 0.0,
                });
            }
        }
        self.actuators.check(self)
    }
}
