//! Names the motion that a singular stiffness allows.

use crate::assembly::Assembly;
use crate::factor::Factor;
use crate::freedoms::Freedoms;
use crate::model::Freedom;

/// Pivot of the scaled stiffness (diagonal about one) below which nothing but rounding is left.
pub(crate) const PIVOT: f64 = 1e-14;
/// The same in double-doubles.
pub(crate) const PIVOT_EXTENDED: f64 = 1e-27;
/// Shift that makes a singular scaled stiffness positive definite.
const SHIFTS: [f64; 3] = [1e-11, 1e-8, 1e-5];

/// Point and freedom with the largest part, stiffness considered, in the weakest motion.
pub(crate) fn weakest(assembly: &Assembly, freedoms: &Freedoms) -> (usize, Freedom) {
    let n = assembly.numbering.column.len();
    let factor = SHIFTS.iter().find_map(|&shift| Factor::new(&assembly.shifted(shift)).ok());
    // A start without structure: no motion is orthogonal to it by symmetry.
    let mut x: Vec<f64> = (0..n).map(|k| 1.0 + 0.5 * ((k * 7919 % 1009) as f64 / 1009.0)).collect();
    if let Some(factor) = factor {
        for _ in 0..3 {
            factor.solve(&mut x);
            let size = x.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            x.iter_mut().for_each(|v| *v /= size);
        }
    }
    let mut largest = 0;
    for (k, value) in x.iter().enumerate() {
        // The lower column among equals.
        let gain = value.abs() - x[largest].abs();
        if gain > 1e-9 || (gain > -1e-9 && assembly.numbering.column[k] < assembly.numbering.column[largest])
        {
            largest = k;
        }
    }
    let column = assembly.numbering.column.get(largest).copied().unwrap_or(0);
    (freedoms.bodies[column / 6].reference, Freedom::ALL[column % 6])
}
