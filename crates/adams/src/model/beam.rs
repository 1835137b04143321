//! BEAM.

use super::fields::Fields;
use crate::frame::{Frame, Measure, angle, measure};
use crate::space::{Vector, apply};
use crate::{Error, Fault, Scalar, Value};

/// A massless beam from J along x of J to I: F = -K u - C v on I, small rotations.
#[derive(Clone, Debug)]
pub(crate) struct Beam {
    length: f64,
    stiffness: [[f64; 6]; 6],
    damping: [[f64; 6]; 6],
}

impl Beam {
    /// # Source
    /// Timoshenko's beam element, J. S. Przemieniecki, Theory of Matrix Structural Analysis (1968), section 5.6,
    /// with the argument names of the Adams Solver reference, BEAM; ASY and ASZ divide the area.
    pub fn read(fields: &Fields<'_>) -> Result<Beam, Error> {
        let [length, area, e, g] = [
            fields.needed("LENGTH")?,
            fields.needed("AREA")?,
            fields.needed("EMODULUS")?,
            fields.needed("GMODULUS")?,
        ];
        let [ixx, iyy, izz] = [fields.needed("IXX")?, fields.needed("IYY")?, fields.needed("IZZ")?];
        let shear = [fields.number("ASY")?.unwrap_or(0.0), fields.number("ASZ")?.unwrap_or(0.0)];
        let positive = [length, area, e, g].into_iter().all(|value| value > 0.0);
        if !positive || [ixx, iyy, izz, shear[0], shear[1]].into_iter().any(|value| value < 0.0) {
            return Err(fields.fault(Fault::Parameter));
        }
        match fields.statement.get("FORMULATION") {
            None => {}
            Some(Value::Word(word)) if word.eq_ignore_ascii_case("LINEAR") => {}
            Some(_) => return Err(fields.fault(Fault::Given { argument: "FORMULATION".to_owned() })),
        }
        let (l, l2, l3) = (length, length * length, length * length * length);
        let py = 12.0 * e * izz * shear[0] / (g * area * l2);
        let pz = 12.0 * e * iyy * shear[1] / (g * area * l2);
        let mut k = [[0.0; 6]; 6];
        k[0][0] = e * area / l;
        k[3][3] = g * ixx / l;
        k[1][1] = 12.0 * e * izz / (l3 * (1.0 + py));
        k[1][5] = -6.0 * e * izz / (l2 * (1.0 + py));
        k[5][5] = (4.0 + py) * e * izz / (l * (1.0 + py));
        k[2][2] = 12.0 * e * iyy / (l3 * (1.0 + pz));
        k[2][4] = 6.0 * e * iyy / (l2 * (1.0 + pz));
        k[4][4] = (4.0 + pz) * e * iyy / (l * (1.0 + pz));
        (k[5][1], k[4][2]) = (k[1][5], k[2][4]);
        let damping = match (fields.number("CRATIO")?, fields.numbers("CMATRIX")?) {
            (ratio, None) => k.map(|row| row.map(|value| value * ratio.unwrap_or(0.0))),
            (None, Some(list)) => lower(&list).ok_or_else(|| fields.fault(Fault::Parameter))?,
            _ => return Err(fields.fault(Fault::Parameter)),
        };
        Ok(Beam { length, stiffness: k, damping })
    }

    /// Force and torque on I, along ground axes.
    pub fn wrench<T: Scalar>(&self, i: &Frame<T>, j: &Frame<T>) -> [Vector<T>; 2] {
        let get = |what: Measure| measure(what, [i, j, j, j], true);
        let mut u: [T; 6] =
            std::array::from_fn(|k| if k < 3 { get(Measure::Displacement(k)) } else { angle(k - 3, i, j) });
        u[0] = u[0].minus(&T::constant(self.length));
        let v: [T; 6] =
            std::array::from_fn(
                |k| if k < 3 { get(Measure::Velocity(k)) } else { get(Measure::Spin(k - 3)) },
            );
        let row = |k: usize| {
            let terms =
                (0..6).map(|m| u[m].scaled(self.stiffness[k][m]).plus(&v[m].scaled(self.damping[k][m])));
            terms.fold(T::constant(0.0), |sum, term| sum.minus(&term))
        };
        [apply(&j.axes, &std::array::from_fn(row)), apply(&j.axes, &std::array::from_fn(|k| row(k + 3)))]
    }
}

/// A symmetric matrix from its 21 numbers, column by column from the diagonal down.
fn lower(list: &[f64]) -> Option<[[f64; 6]; 6]> {
    if list.len() != 21 {
        return None;
    }
    // Column k begins after 6 + 5 + ... numbers.
    let start = |column: usize| column * (13 - column) / 2;
    let entry = |a: usize, b: usize| list[start(a.min(b)) + a.abs_diff(b)];
    Some(std::array::from_fn(|row| std::array::from_fn(|column| entry(row, column))))
}
