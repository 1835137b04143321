//! PART and MARKER: their position, orientation and initial motion.

use super::arguments::Arguments;
use crate::kinematics::vector::{IDENTITY, Matrix, Vector, cross, dot, norm, product, subtract};
use crate::{AdamsFault, Error, Pose};
use nalgebra::{Matrix3, Vector3};

/// A rigid body, or ground.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub id: u32,
    pub ground: bool,
    /// Initial position of the origin.
    pub origin: Vector<f64>,
    /// Initial axes, as columns.
    pub rotation: Matrix<f64>,
    pub mass: f64,
    /// The marker at the centre of mass.
    pub cm: Option<usize>,
    /// Initial velocity of the centre of mass.
    pub velocity: Vector<f64>,
    pub spin: Vector<f64>,
}

/// A frame fixed to a part, or a floating one.
#[derive(Clone, Debug)]
pub(crate) struct Marker {
    pub part: usize,
    /// Position in part coordinates.
    pub position: Vector<f64>,
    /// Axes in part coordinates, as columns.
    pub axes: Matrix<f64>,
    pub floating: bool,
    /// The marker whose position a floating marker takes.
    pub follows: Option<usize>,
}

impl Part {
    /// A PART statement, without its CM.
    pub(super) fn read(arguments: &Arguments<'_>) -> Result<Part, Error> {
        let one = |name: &'static str| Ok(arguments.number(name)?.unwrap_or(0.0));
        let (origin, rotation) = placement(arguments, ["QG", "ZG", "XG"])?;
        Ok(Part {
            id: arguments.id()?,
            ground: arguments.flag("GROUND"),
            origin,
            rotation,
            mass: one("MASS")?,
            cm: None,
            velocity: [one("VX")?, one("VY")?, one("VZ")?],
            spin: [one("WX")?, one("WY")?, one("WZ")?],
        })
    }

    /// The initial pose. VX to VZ are the velocity of the centre of mass, from which that of the origin
    /// follows.
    pub fn pose(&self, markers: &[Marker]) -> Pose {
        let rotation = Matrix3::from_fn(|i, j| self.rotation[i][j]);
        let center = self
            .cm
            .and_then(|k| markers.get(k))
            .map_or([0.0; 3], |marker| marker.position);
        let arm = rotation * Vector3::from(center);
        let spin = Vector3::from(self.spin);
        Pose::moving(
            self.origin.into(),
            rotation,
            Vector3::from(self.velocity) - spin.cross(&arm),
            spin,
        )
    }
}

impl Marker {
    /// A MARKER statement on the part at an index.
    pub(super) fn read(arguments: &Arguments<'_>, part: usize) -> Result<Marker, Error> {
        let (position, axes) = placement(arguments, ["QP", "ZP", "XP"])?;
        let floating = arguments.flag("FLOATING");
        Ok(Marker {
            part,
            position,
            axes,
            floating,
            follows: None,
        })
    }
}

/// The origin and axes of a PART or MARKER: from a point and Euler angles, or from a point and points on the
/// axes.
fn placement(
    arguments: &Arguments<'_>,
    [q, z, x]: [&'static str; 3],
) -> Result<(Vector<f64>, Matrix<f64>), Error> {
    let origin = arguments.three(q)?.unwrap_or([0.0; 3]);
    let angles = arguments.angles("REULER")?;
    let (z_point, x_point) = (arguments.three(z)?, arguments.three(x)?);
    let axes = match (angles, z_point, x_point) {
        (Some(angles), None, None) => euler(angles),
        (None, None, None) => IDENTITY,
        (None, Some(point), other) => {
            let first = subtract(&point, &origin);
            let by_x = arguments.flag("USEXP");
            // Without a second point the x axis of the part takes its place, or the y axis if the first point
            // is on x.
            let spare = if first[1].abs() + first[2].abs() > 1e-9 * norm(&first) {
                [1.0, 0.0, 0.0]
            } else {
                [0.0, 1.0, 0.0]
            };
            let second = other.map_or(spare, |point| subtract(&point, &origin));
            let axes = if by_x {
                from_axes(second, first, true)
            } else {
                from_axes(first, second, false)
            };
            axes.ok_or_else(|| arguments.fault(AdamsFault::Axes))?
        }
        _ => return Err(arguments.fault(AdamsFault::Axes)),
    };
    Ok((origin, axes))
}

/// Axes from the direction of the x or z axis and a second vector that fixes the x-z plane.
fn from_axes(first: Vector<f64>, second: Vector<f64>, first_is_x: bool) -> Option<Matrix<f64>> {
    let unit = |v: Vector<f64>| {
        let length = norm(&v);
        (length > 0.0 && length.is_finite()).then(|| v.map(|part| part / length))
    };
    let a = unit(first)?;
    let along = dot(&a, &second);
    let b = unit(std::array::from_fn(|k| second[k] - along * a[k]))?;
    let (x, z) = if first_is_x { (a, b) } else { (b, a) };
    let y = cross(&z, &x);
    Some(std::array::from_fn(|row| [x[row], y[row], z[row]]))
}

/// R_z(a) R_x(b) R_z(c), body-fixed 3-1-3 angles, each given as cosine and sine.
fn euler([a, b, c]: [(f64, f64); 3]) -> Matrix<f64> {
    let about_z = |(cos, sin): (f64, f64)| [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]];
    let (cos, sin) = b;
    let about_x = [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]];
    product(&about_z(a), &product(&about_x, &about_z(c)))
}

#[cfg(test)]
mod tests {
    use super::super::arguments::cosines_and_sines;
    use super::{euler, from_axes};
    use crate::ArgumentValue;
    use crate::kinematics::vector::apply;

    #[test]
    fn euler_angles_are_body_3_1_3() {
        // x along ground z, y along ground y.
        let angles =
            cosines_and_sines(&ArgumentValue::Degrees(vec![270.0, 90.0, 90.0])).expect("angles");
        let axes = euler([angles[0], angles[1], angles[2]]);
        assert_eq!(apply(&axes, &[1.0, 0.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(apply(&axes, &[0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]);
        let other = from_axes([0.0, 0.0, 2.0], [-3.0, 0.0, 1.0], true).expect("two directions");
        assert_eq!(other, axes);
    }
}
