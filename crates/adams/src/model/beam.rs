//! BEAM: a massless linear beam between two markers.

use super::arguments::Arguments;
use crate::kinematics::vector::{Vector, apply};
use crate::kinematics::{Frame, Measure, angle, measure};
use crate::{AdamsFault, ArgumentValue, Error, Scalar};

/// A massless beam from J to I, which lies at the distance LENGTH along x of J in the undeformed state.
///
/// The force and torque on I are F = -K u - C v, where u are the displacements and small rotations of I from
/// the undeformed state and v their rates, in the axes of J.
#[derive(Clone, Debug)]
pub(crate) struct Beam {
    length: f64,
    stiffness: [[f64; 6]; 6],
    damping: [[f64; 6]; 6],
}

impl Beam {
    /// A BEAM statement: the stiffness of a Timoshenko beam with P_y = 12 E Izz ASY/(G A L^2), and likewise
    /// P_z.
    ///
    /// ASY and ASZ are factors of the shear flexibility: the shear area is AREA/ASY.
    ///
    /// # Errors
    /// Arguments that are missing or outside their range, and any FORMULATION other than LINEAR.
    ///
    /// # Source
    /// Timoshenko's beam element, J. S. Przemieniecki, Theory of Matrix Structural Analysis (1968), section
    /// 5.6, with the argument names of the Adams Solver reference, BEAM.
    pub(super) fn read(arguments: &Arguments<'_>) -> Result<Beam, Error> {
        let [length, area, e, g] = [
            arguments.required("LENGTH")?,
            arguments.required("AREA")?,
            arguments.required("EMODULUS")?,
            arguments.required("GMODULUS")?,
        ];
        let [ixx, iyy, izz] = [
            arguments.required("IXX")?,
            arguments.required("IYY")?,
            arguments.required("IZZ")?,
        ];
        let shear = [
            arguments.number("ASY")?.unwrap_or(0.0),
            arguments.number("ASZ")?.unwrap_or(0.0),
        ];
        let positive = [length, area, e, g].into_iter().all(|value| value > 0.0);
        if !positive
            || [ixx, iyy, izz, shear[0], shear[1]]
                .into_iter()
                .any(|value| value < 0.0)
        {
            return Err(arguments.fault(AdamsFault::Parameter));
        }
        match arguments.statement.get("FORMULATION") {
            None => {}
            Some(ArgumentValue::Word(word)) if word.eq_ignore_ascii_case("LINEAR") => {}
            Some(_) => return Err(arguments.wrong_form("FORMULATION")),
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
        let damping = match (arguments.number("CRATIO")?, arguments.numbers("CMATRIX")?) {
            (ratio, None) => k.map(|row| row.map(|value| value * ratio.unwrap_or(0.0))),
            (None, Some(list)) => {
                symmetric(&list).ok_or_else(|| arguments.fault(AdamsFault::Parameter))?
            }
            _ => return Err(arguments.fault(AdamsFault::Parameter)),
        };
        Ok(Beam {
            length,
            stiffness: k,
            damping,
        })
    }

    /// The force on I and the torque about I, in ground axes.
    pub fn wrench<T: Scalar>(&self, i: &Frame<T>, j: &Frame<T>) -> [Vector<T>; 2] {
        let get = |what: Measure| measure(what, [i, j, j, j], true);
        let mut u: [T; 6] = std::array::from_fn(|k| {
            if k < 3 {
                get(Measure::Displacement(k))
            } else {
                angle(k - 3, i, j)
            }
        });
        u[0] = u[0].minus(&T::constant(self.length));
        let v: [T; 6] = std::array::from_fn(|k| {
            if k < 3 {
                get(Measure::Velocity(k))
            } else {
                get(Measure::AngularVelocity(k - 3))
            }
        });
        let row = |k: usize| {
            let terms = (0..6).map(|m| {
                u[m].scaled(self.stiffness[k][m])
                    .plus(&v[m].scaled(self.damping[k][m]))
            });
            terms.fold(T::constant(0.0), |sum, term| sum.minus(&term))
        };
        [
            apply(&j.axes, &std::array::from_fn(row)),
            apply(&j.axes, &std::array::from_fn(|k| row(k + 3))),
        ]
    }
}

/// The symmetric matrix of CMATRIX from its 21 numbers: the columns of the lower triangle, from the diagonal
/// down.
fn symmetric(list: &[f64]) -> Option<[[f64; 6]; 6]> {
    if list.len() != 21 {
        return None;
    }
    // Column k begins after 6 + 5 + ... numbers, k terms.
    let start = |column: usize| column * (13 - column) / 2;
    let entry = |a: usize, b: usize| list[start(a.min(b)) + a.abs_diff(b)];
    Some(std::array::from_fn(|row| {
        std::array::from_fn(|column| entry(row, column))
    }))
}
