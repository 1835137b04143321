//! PART and MARKER.

use super::fields::Fields;
use crate::space::{IDENTITY, Matrix, Vector, cross, dot, norm, subtract};
use crate::{Error, Fault, Pose, Value};
use nalgebra::{Matrix3, Vector3};

#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub id: u32,
    pub ground: bool,
    pub origin: Vector<f64>,
    pub rotation: Matrix<f64>,
    pub mass: f64,
    /// Centre of mass.
    pub cm: Option<usize>,
    /// Of the centre of mass.
    pub velocity: Vector<f64>,
    pub spin: Vector<f64>,
}

#[derive(Clone, Debug)]
pub(crate) struct Marker {
    pub part: usize,
    /// In part coordinates.
    pub position: Vector<f64>,
    pub axes: Matrix<f64>,
    pub floating: bool,
    /// The marker at which a floating one is kept.
    pub follows: Option<usize>,
}

impl Part {
    pub fn read(fields: &Fields<'_>) -> Result<Part, Error> {
        let one = |name: &str| Ok(fields.number(name)?.unwrap_or(0.0));
        let (origin, rotation) = placement(fields, ["QG", "ZG", "XG"])?;
        Ok(Part {
            id: fields.id()?,
            ground: fields.flag("GROUND"),
            origin,
            rotation,
            mass: one("MASS")?,
            cm: None,
            velocity: [one("VX")?, one("VY")?, one("VZ")?],
            spin: [one("WX")?, one("WY")?, one("WZ")?],
        })
    }

    pub fn pose(&self, markers: &[Marker]) -> Pose {
        let rotation = Matrix3::from_fn(|i, j| self.rotation[i][j]);
        let center = self.cm.and_then(|k| markers.get(k)).map_or([0.0; 3], |marker| marker.position);
        let arm = rotation * Vector3::from(center);
        let spin = Vector3::from(self.spin);
        Pose::moving(self.origin.into(), rotation, Vector3::from(self.velocity) - spin.cross(&arm), spin)
    }
}

impl Marker {
    pub fn read(fields: &Fields<'_>, part: usize) -> Result<Marker, Error> {
        let (position, axes) = placement(fields, ["QP", "ZP", "XP"])?;
        let floating = fields.flag("FLOATING");
        Ok(Marker { part, position, axes, floating, follows: None })
    }
}

/// Origin and axes from a point and Euler angles, or from points on the axes.
fn placement(fields: &Fields<'_>, [q, z, x]: [&str; 3]) -> Result<(Vector<f64>, Matrix<f64>), Error> {
    let origin = fields.three(q)?.unwrap_or([0.0; 3]);
    let angles = fields.angles("REULER")?;
    let (z_point, x_point) = (fields.three(z)?, fields.three(x)?);
    let axes = match (angles, z_point, x_point) {
        (Some(angles), None, None) => euler(angles),
        (None, None, None) => IDENTITY,
        (None, Some(point), other) => {
            let first = subtract(&point, &origin);
            let by_x = fields.flag("USEXP");
            // Without a second point, the part's x, or its y if that is the axis itself.
            let spare = if first[1].abs() + first[2].abs() > 1e-9 * norm(&first) {
                [1.0, 0.0, 0.0]
            } else {
                [0.0, 1.0, 0.0]
            };
            let second = other.map_or(spare, |point| subtract(&point, &origin));
            let axes = if by_x { from_axes(second, first, true) } else { from_axes(first, second, false) };
            axes.ok_or_else(|| fields.fault(Fault::Axes))?
        }
        _ => return Err(fields.fault(Fault::Axes)),
    };
    Ok((origin, axes))
}

/// Axes from one axis and a vector in the x-z plane on the positive side of the other; the first is x or z.
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

/// R_z(a) R_x(b) R_z(c), for angles as (cosine, sine).
fn euler([a, b, c]: [(f64, f64); 3]) -> Matrix<f64> {
    let about_z = |(cos, sin): (f64, f64)| [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]];
    let (cos, sin) = b;
    let about_x = [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]];
    crate::space::product(&about_z(a), &crate::space::product(&about_x, &about_z(c)))
}

/// Cosine and sine, exact at right angles given in degrees.
pub(super) fn turn(value: &Value) -> Option<Vec<(f64, f64)>> {
    match value {
        Value::Numbers(all) => Some(all.iter().map(|angle| (angle.cos(), angle.sin())).collect()),
        Value::Degrees(all) => Some(
            all.iter()
                .map(|degrees| {
                    let quarter = degrees.rem_euclid(360.0) / 90.0;
                    match quarter {
                        0.0 => (1.0, 0.0),
                        1.0 => (0.0, 1.0),
                        2.0 => (-1.0, 0.0),
                        3.0 => (0.0, -1.0),
                        _ => (degrees.to_radians().cos(), degrees.to_radians().sin()),
                    }
                })
                .collect(),
        ),
        Value::Whole(angle) => Some(vec![((*angle as f64).cos(), (*angle as f64).sin())]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{euler, from_axes, turn};
    use crate::Value;
    use crate::space::apply;

    #[test]
    fn euler_angles_are_body_3_1_3() {
        // x along ground z, y along ground y.
        let angles = turn(&Value::Degrees(vec![270.0, 90.0, 90.0])).expect("angles");
        let axes = euler([angles[0], angles[1], angles[2]]);
        assert_eq!(apply(&axes, &[1.0, 0.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(apply(&axes, &[0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]);
        let other = from_axes([0.0, 0.0, 2.0], [-3.0, 0.0, 1.0], true).expect("two directions");
        assert_eq!(other, axes);
    }
}
