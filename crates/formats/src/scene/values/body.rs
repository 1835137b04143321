//! Bodies of a scene, and how they move along their rails.

use sim::{Profile, Schedule};

/// A rigid body: on wheels, pinned to another body, or a point in space on ropes. Lengths, forces and masses are in the
/// scene's units, times in seconds, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Mass, force time^2 / length, above 0.
    pub mass: f64,
    /// Whether the scene gives the mass itself, not the weight.
    pub by_mass: bool,
    /// Moments of inertia about the centre of mass for roll, yaw, pitch (about x, y, z), mass length^2, not negative.
    pub inertia: [f64; 3],
    /// Position of the centre of mass relative to the body's origin, in the rail frame.
    pub cg: [f64; 3],
    /// Which of the degrees of freedom x, y, z, roll, yaw, pitch are free.
    pub free: [bool; 6],
    /// Whether it is a point in space; then x, y, z are the displacements X, Y, Z in space.
    pub in_space: bool,
    /// Rails that restrain the degrees of freedom that are not free, as indices into the scene's rails.
    pub track: Vec<usize>,
    /// Position along the rail at time 0.
    pub x0: f64,
    /// Speed along the rail at time 0.
    pub v0: f64,
    /// Displacements y, z, roll, yaw, pitch at time 0, measured from where the wheels just touch the unloaded rail;
    /// none: the run starts from static equilibrium.
    pub start: Option<[f64; 5]>,
    /// How it moves along its rails.
    pub motion: BodyMotion,
    /// Index of the body that carries it, and position of the pin relative to that body's origin; none: wheels or ropes
    /// carry it.
    pub pinned: Option<(usize, [f64; 3])>,
    /// Time from which its brakes are on and its drive is off; infinite where only events apply the brakes; none: it has
    /// no brakes.
    pub brake: Option<f64>,
}

/// How a body moves along its rails.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyMotion {
    /// It does not move along them.
    Held,
    /// Its forces move it.
    Free,
    /// Its forces and that of a drive move it.
    Driven(Drive),
    /// Its motion is prescribed; the force that this needs is computed.
    Prescribed(Profile),
}

impl BodyMotion {
    /// Whether x is an unknown that follows from the forces.
    #[must_use]
    pub fn is_free(&self) -> bool {
        matches!(self, BodyMotion::Free | BodyMotion::Driven(_))
    }
}

/// Words of a body's degrees of freedom, in the order of [`Body::free`].
pub const DOFS: [&str; 6] = ["x", "y", "z", "roll", "yaw", "pitch"];

/// Words of the degrees of freedom of a body in space.
pub(in crate::scene) const SPACE: [&str; 3] = ["X", "Y", "Z"];

/// A drive along the rail: its force is gain (wanted speed - speed), within +-max_force.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Wanted speed over time, length / time.
    pub speed: Schedule,
    /// Force per difference of speeds, force time / length, above 0.
    pub gain: f64,
    /// Its largest force, not negative; none: unlimited.
    pub max_force: Option<f64>,
}

/// The body at the root of the tree of pins that `b` is in, and how far ahead of its origin the origin of `b` is;
/// none where pins run in a circle.
pub(in crate::scene) fn root_of(bodies: &[Body], b: usize) -> Option<(usize, f64)> {
    seat_of(bodies, b).map(|(root, arm)| (root, arm[0]))
}

/// The body at the root of the tree of pins that `b` is in, and the position of the origin of `b` relative to the root's;
/// none where pins run in a circle.
pub(in crate::scene) fn seat_of(bodies: &[Body], b: usize) -> Option<(usize, [f64; 3])> {
    let (mut root, mut arm) = (b, [0.0; 3]);
    for _ in 0..=bodies.len() {
        let Some((to, pin)) = bodies[root].pinned else { return Some((root, arm)) };
        root = to;
        arm.iter_mut().zip(pin).for_each(|(arm, at)| *arm += at);
    }
    None
}

/// Whether body `b`, or a body that is pinned to it directly or through others, has trucks; `trucks` are their numbers
/// by body.
pub(in crate::scene) fn is_carried(bodies: &[Body], b: usize, trucks: &[usize]) -> bool {
    (0..bodies.len()).filter(|&other| trucks[other] > 0).any(|other| {
        let mut at = other;
        while let (true, Some((to, _))) = (at != b, bodies[at].pinned) {
            at = to;
        }
        at == b
    })
}
