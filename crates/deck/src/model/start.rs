//! The state at time 0 as the simulator computes it, in static equilibrium if the scene specifies this.

use std::ops::ControlFlow;

use sim::{BodyDof, Channel, Foundation};

use crate::Error;

/// State of bodies and wheels at time 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Displacements (x, y, z) and rotations (roll, yaw, pitch) of each body; x is its rail coordinate.
    pub displacement: Vec<[f64; 6]>,
    /// Speed of each body along the rail.
    pub speed: Vec<f64>,
    /// Rail coordinate of each wheel.
    pub place: Vec<f64>,
    /// Penetration of each wheel.
    pub penetration: Vec<f64>,
    /// Downward displacement of the rail under each wheel.
    pub deflection: Vec<f64>,
    /// Vertical force of each wheel.
    pub vertical: Vec<f64>,
    /// Flange force of each wheel.
    pub lateral: Vec<f64>,
    /// Friction force of each wheel.
    pub traction: Vec<f64>,
}

impl Start {
    /// The state of `scene` at time 0: the first sample of a run that is stopped there.
    ///
    /// # Errors
    /// [`Error::Start`] for a scene that cannot start.
    pub fn of(scene: &sim::Scene, foundations: &[Foundation]) -> Result<Start, Error> {
        let run =
            sim::run(scene, foundations, &mut |_| ControlFlow::Break(())).map_err(Error::Start)?;
        let history = &run.history;
        let at = |channel: Channel| history.column(channel).first().copied().unwrap_or_default();
        let bodies = 0..scene.bodies.len();
        let count: usize = scene
            .contacts
            .iter()
            .map(|contact| contact.offsets.len())
            .sum();
        let of_wheels =
            |channel: fn(usize) -> Channel| (0..count).map(|w| at(channel(w))).collect();
        Ok(Start {
            displacement: bodies
                .clone()
                .map(|b| BodyDof::ALL.map(|dof| at(Channel::Displacement(b, dof))))
                .collect(),
            speed: bodies.map(|b| at(Channel::Speed(b, BodyDof::X))).collect(),
            place: of_wheels(Channel::Position),
            penetration: of_wheels(Channel::Penetration),
            deflection: of_wheels(Channel::Deflection),
            vertical: of_wheels(Channel::Vertical),
            lateral: of_wheels(Channel::Lateral),
            traction: of_wheels(Channel::Traction),
        })
    }
}

/// Rotation matrix of the rotation vector a, by Rodrigues' formula: R = I + (sin t/t) A + ((1 - cos t)/t^2) A^2 with
/// the angle t = |a| and the cross-product matrix A of a. Below 1e-4 the coefficients are evaluated by their series.
#[must_use]
pub fn rotation(a: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = a;
    let squared = x * x + y * y + z * z;
    let angle = squared.sqrt();
    let (s, c) = if angle < 1e-4 {
        (1.0 - squared / 6.0, 0.5 - squared / 24.0)
    } else {
        (angle.sin() / angle, (1.0 - angle.cos()) / squared)
    };
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let mut out = [[0.0; 3]; 3];
    for (i, row) in out.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let twice: f64 = (0..3).map(|k| cross[i][k] * cross[k][j]).sum();
            *entry = f64::from(u8::from(i == j)) + s * cross[i][j] + c * twice;
        }
    }
    out
}

/// Angles of the body-fixed 3-1-3 rotations (Euler angles of ADAMS) of the rotation matrix `r`, radians.
#[must_use]
pub fn euler(r: [[f64; 3]; 3]) -> [f64; 3] {
    let tilt = r[0][2].hypot(r[1][2]);
    if tilt == 0.0 {
        return [r[1][0].atan2(r[0][0]), 0.0, 0.0];
    }
    [
        r[0][2].atan2(-r[1][2]),
        tilt.atan2(r[2][2]),
        r[2][0].atan2(r[2][1]),
    ]
}

/// The vector `v` rotated by `r`.
#[must_use]
pub fn rotated(r: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    r.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

#[cfg(test)]
mod tests {
    use super::{euler, rotated, rotation};

    fn times(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    }

    #[test]
    fn angles_3_1_3_reproduce_the_rotation() {
        for vector in [
            [0.0, 0.0, 0.02],
            [0.01, -0.03, 0.02],
            [1.0, -0.4, 0.7],
            [0.0, 0.0, -2.0],
            [0.0; 3],
        ] {
            let r = rotation(vector);
            let [a, b, c] = euler(r);
            let about_z = |t: f64| rotation([0.0, 0.0, t]);
            let again = times(times(about_z(a), rotation([b, 0.0, 0.0])), about_z(c));
            for (row, other) in r.iter().zip(again) {
                for (one, two) in row.iter().zip(other) {
                    assert!((one - two).abs() < 1e-14, "{vector:?}");
                }
            }
        }
    }

    #[test]
    fn a_small_rotation_is_its_cross_product() {
        let rotated = rotated(rotation([0.0, 0.0, 1e-6]), [2.0, 1.0, 0.0]);
        assert!(
            (rotated[0] - (2.0 - 1e-6)).abs() < 1e-11 && (rotated[1] - (1.0 + 2e-6)).abs() < 1e-11
        );
    }
}
