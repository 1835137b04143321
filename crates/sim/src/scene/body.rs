//! Rigid bodies, the pins between them, and their contacts with the rails.

use super::dof::arm_rows;
use super::error::Error;
use super::profile::Profile;

/// The pin that joins a body to another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Index of the body that carries the pin.
    pub body: usize,
    /// Position of the pin relative to the origin of that body.
    pub at: [f64; 3],
}

/// A rigid body on a track.
///
/// Its y and z are measured from the position in which its wheels just touch the unloaded straight rail and are
/// centred on it. Its x is the rail coordinate of its origin.
/// ```
/// use sim::{Body, BodyDof, MotionKind, Profile};
///
/// // 20 t, driven at 2 m/s from x = 1 m, free to roll beside what a new body is free in.
/// let mut body = Body::new(20e3, [5e3, 0.0, 40e3]);
/// body.motion = Some(Profile::new(MotionKind::Speed, &[[0.0, 2.0]], 1.0, 0.0)?);
/// body.free[BodyDof::Roll as usize] = true;
/// assert_eq!(body.free, [false, true, false, true, false, true]);
/// # Ok::<(), sim::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Mass, > 0.
    pub mass: f64,
    /// Moments of inertia about the centre of mass for roll, yaw and pitch.
    pub inertia: [f64; 3],
    /// Position of the centre of mass relative to the origin, in the frame of the track.
    pub cg: [f64; 3],
    /// Whether each degree of freedom is free; a fixed one keeps its starting value.
    pub free: [bool; 6],
    /// Starting displacements. For free y, roll and pitch the static equilibrium is computed.
    pub start: [f64; 6],
    /// Starting velocities.
    pub start_speed: [f64; 6],
    /// Prescribed x(t). `None`: x is free or fixed as given by `free`.
    pub motion: Option<Profile>,
    /// Pin that carries this body. The origin of the body moves with the pin. Fixed rotations are those of the
    /// carrying body; free rotations are about the axes of the track. The starting x, y and z are not used. `None`:
    /// the track carries the body.
    pub pinned: Option<Pin>,
}

impl Body {
    /// A body of `mass` with the moments of `inertia` for roll, yaw and pitch about its centre of mass, which is its
    /// origin. It is free in y and pitch, starts at rest at x = 0, and the track carries it.
    #[must_use]
    pub fn new(mass: f64, inertia: [f64; 3]) -> Self {
        Body {
            mass,
            inertia,
            cg: [0.0; 3],
            free: [false, true, false, false, false, true],
            start: [0.0; 6],
            start_speed: [0.0; 6],
            motion: None,
            pinned: None,
        }
    }

    /// 6 x 6 mass matrix about the origin, m J^T J + diag(0, 0, 0, inertia), where J maps the velocities of the
    /// origin to the velocity of the centre of mass.
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

/// Indices of the bodies in an order in which every body follows the one it is pinned to.
///
/// # Errors
/// [`Error::Pinned`] where the pins form a cycle.
pub(crate) fn parents_first(bodies: &[Body]) -> Result<Vec<usize>, Error> {
    let mut depths = Vec::with_capacity(bodies.len());
    for b in 0..bodies.len() {
        let (mut depth, mut at) = (0, b);
        while let Some(pin) = &bodies[at].pinned {
            (depth, at) = (depth + 1, pin.body);
            if depth > bodies.len() {
                return Err(Error::Pinned { body: b });
            }
        }
        depths.push((depth, b));
    }
    depths.sort_unstable();
    Ok(depths.into_iter().map(|(_, b)| b).collect())
}

/// One contact between a body and a rail: a single wheel, or several wheels on massless equalisers, which share the
/// contact force equally.
/// ```
/// use sim::Contact;
///
/// // A wheel 1.5 m ahead of the origin of body 0, and a truck of two wheels behind it.
/// let wheel = Contact::new(0, [1.5, 0.0, 0.0]);
/// let truck = Contact { offsets: vec![-0.4, 0.4], ..Contact::new(0, [-1.5, 0.0, 0.0]) };
/// assert_eq!((wheel.offsets.len(), truck.offsets.len()), (1, 2));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Which body.
    pub body: usize,
    /// Which structure.
    pub structure: usize,
    /// Which rail of the structure.
    pub rail: usize,
    /// Position of the hub of the truck relative to the origin of the body.
    pub at: [f64; 3],
    /// Offsets of the wheels along the rail from `at`. The body is loaded at the mean of the offsets.
    pub offsets: Vec<f64>,
    /// Index of the kind of wheel.
    pub wheel: usize,
}

impl Contact {
    /// One wheel of kind 0 on the first rail of structure 0, with its hub at `at` relative to the origin of `body`.
    #[must_use]
    pub fn new(body: usize, at: [f64; 3]) -> Self {
        Contact {
            body,
            structure: 0,
            rail: 0,
            at,
            offsets: vec![0.0],
            wheel: 0,
        }
    }
}
