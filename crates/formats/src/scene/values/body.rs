//! Bodies of a scene and their motion along their rails.

use sim::{Profile, Schedule};

/// A rigid body that runs on wheels or is pinned to another body, or a point mass in space that hangs from ropes.
/// Lengths, forces and masses are in the units of the scene, times in seconds, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Mass, force time^2 / length, above 0.
    pub mass: f64,
    /// Whether the scene specifies the mass instead of the weight.
    pub by_mass: bool,
    /// Moments of inertia about the centre of mass for roll, yaw, pitch (about x, y, z), mass length^2, not negative.
    pub inertia: [f64; 3],
    /// Position of the centre of mass relative to the body's origin, in the rail frame.
    pub cg: [f64; 3],
    /// Which of the degrees of freedom x, y, z, roll, yaw, pitch are free.
    pub free: [bool; 6],
    /// Whether it is a point mass in space. In this case x, y, z are the displacements X, Y, Z in space.
    pub in_space: bool,
    /// Rails that restrain the degrees of freedom that are not free, as indices into the rails of the scene.
    pub track: Vec<usize>,
    /// Position along the rail at time 0.
    pub x0: f64,
    /// Speed along the rail at time 0.
    pub v0: f64,
    /// Displacements y, z, roll, yaw, pitch at time 0, measured from the position in which the wheels just touch the
    /// unloaded rail; none if the run starts from static equilibrium.
    pub start: Option<[f64; 5]>,
    /// Its motion along its rails.
    pub motion: BodyMotion,
    /// Index of the body that carries it, and position of the pin relative to the origin of that body; none if wheels
    /// or ropes carry it.
    pub pinned: Option<(usize, [f64; 3])>,
    /// Time from which its brakes are applied and its drive is off; infinite if only events apply the brakes; none if
    /// it has no brakes.
    pub brake: Option<f64>,
}

/// Motion of a body along its rails.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyMotion {
    /// It is fixed along them.
    Held,
    /// Its motion follows from the forces on it.
    Free,
    /// Its motion follows from the forces on it and the force of a drive.
    Driven(Drive),
    /// Its motion is prescribed; the required force is computed.
    Prescribed(Profile),
}

impl BodyMotion {
    /// Whether x is an unknown that is determined by the forces.
    #[must_use]
    pub fn is_free(&self) -> bool {
        matches!(self, BodyMotion::Free | BodyMotion::Driven(_))
    }
}

/// Keywords of the degrees of freedom of a body, in the order of [`Body::free`].
pub const DOFS: [&str; 6] = ["x", "y", "z", "roll", "yaw", "pitch"];

/// Keywords of the degrees of freedom of a body in space.
pub(in crate::scene) const SPACE: [&str; 3] = ["X", "Y", "Z"];

/// A drive along the rail. Its force is gain (target speed - speed), limited to +-max_force.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Target speed over time, length / time.
    pub speed: Schedule,
    /// Force per speed difference, force time / length, above 0.
    pub gain: f64,
    /// Its largest force, not negative; none if it is unlimited.
    pub max_force: Option<f64>,
}

/// The root body of the tree of pins that contains `b`, and the longitudinal position of the origin of `b` relative
/// to that of the root; none if the pins form a cycle.
pub(in crate::scene) fn root_of(bodies: &[Body], b: usize) -> Option<(usize, f64)> {
    seat_of(bodies, b).map(|(root, arm)| (root, arm[0]))
}

/// The root body of the tree of pins that contains `b`, and the position of the origin of `b` relative to that of the
/// root; none if the pins form a cycle.
pub(in crate::scene) fn seat_of(bodies: &[Body], b: usize) -> Option<(usize, [f64; 3])> {
    let (mut root, mut arm) = (b, [0.0; 3]);
    for _ in 0..=bodies.len() {
        let Some((to, pin)) = bodies[root].pinned else {
            return Some((root, arm));
        };
        root = to;
        arm.iter_mut().zip(pin).for_each(|(arm, at)| *arm += at);
    }
    None
}

/// Whether body `b`, or a body that is pinned to it directly or indirectly, has trucks. `trucks` are the numbers of
/// trucks of the bodies.
pub(in crate::scene) fn is_carried(bodies: &[Body], b: usize, trucks: &[usize]) -> bool {
    (0..bodies.len())
        .filter(|&other| trucks[other] > 0)
        .any(|other| {
            let mut at = other;
            while let (true, Some((to, _))) = (at != b, bodies[at].pinned) {
                at = to;
            }
            at == b
        })
}
