//! Error of a table reading against the exact surface.

use nalgebra::DMatrix;

use super::block::{BlockExtreme, CouplingBlock};
use super::search::refine_maximum;
use crate::error::Error;

/// Largest number of places from which an extreme is refined.
const STARTS: usize = 4;

/// Largest errors of a reading, signed (reading less exact), length/force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadingError {
    /// Largest |exact| over the places examined.
    pub scale: f64,
    /// The largest error.
    pub largest: BlockExtreme,
    /// The largest error under the load itself, x = z; `None` unless the block is direct.
    pub diagonal: Option<BlockExtreme>,
}

impl ReadingError {
    /// The largest error relative to the largest exact coefficient, without sign; 0 where that is 0.
    #[must_use]
    pub fn relative(&self) -> f64 {
        if self.scale > 0.0 {
            self.largest.value.abs() / self.scale
        } else {
            0.0
        }
    }
}

/// Largest errors of `reading` against `exact`, with loads at `x` and deflections at `z`, both increasing.
///
/// The errors are evaluated at all pairs of places, then refined from the four largest local maxima among
/// them, and along the diagonal x = z from the largest there. The result is a lower bound of the true
/// maximum.
///
/// # Errors
/// Those of either compliance.
pub fn reading_error(
    reading: &CouplingBlock<'_>,
    exact: &CouplingBlock<'_>,
    x: &[f64],
    z: &[f64],
) -> Result<ReadingError, Error> {
    let (&[first_x, .., last_x], &[first_z, .., last_z]) = (x, z) else {
        return Ok(ReadingError::default());
    };
    let truth = exact.matrix(z, x)?;
    let error = reading.matrix(z, x)? - &truth;
    let bounds = [first_x.max(first_z), last_x.min(last_z)];
    let signed = |x: f64, z: f64| Ok::<f64, Error>(reading.at(x, z)? - exact.at(x, z)?);
    let step = (last_x - first_x) / x.len() as f64;
    let mut largest = BlockExtreme::default();
    for (i, j) in peaks(&error) {
        let found = BlockExtreme {
            value: error[(i, j)],
            x: x[j],
            z: z[i],
        };
        if found.value.abs() > largest.value.abs() || largest == BlockExtreme::default() {
            largest = found;
        }
        let mut at = [x[j], z[i]];
        if at.iter().any(|p| *p < bounds[0] || *p > bounds[1]) {
            continue;
        }
        refine_maximum(|p| Ok(signed(p[0], p[1])?.abs()), &mut at, step, bounds)?;
        let value = signed(at[0], at[1])?;
        if value.abs() > largest.value.abs() {
            largest = BlockExtreme {
                value,
                x: at[0],
                z: at[1],
            };
        }
    }
    let mut diagonal = None;
    if reading.is_direct() && x == z {
        let worst =
            (0..x.len()).max_by(|&i, &j| error[(i, i)].abs().total_cmp(&error[(j, j)].abs()));
        let mut at = [x[worst.unwrap_or(0)]];
        refine_maximum(|p| Ok(signed(p[0], p[0])?.abs()), &mut at, step, bounds)?;
        let found = BlockExtreme {
            value: signed(at[0], at[0])?,
            x: at[0],
            z: at[0],
        };
        if found.value.abs() > largest.value.abs() {
            largest = found;
        }
        diagonal = Some(found);
    }
    Ok(ReadingError {
        scale: truth.amax(),
        largest,
        diagonal,
    })
}

/// The largest entries by absolute value that no neighbour exceeds, no two next to each other, at most four.
fn peaks(error: &DMatrix<f64>) -> Vec<(usize, usize)> {
    let mut out: Vec<(usize, usize)> = Vec::new();
    let (rows, columns) = error.shape();
    let size = |i: usize, j: usize| error[(i, j)].abs();
    let mut best: Vec<(f64, usize, usize)> = Vec::new();
    for j in 0..columns {
        for i in 0..rows {
            let near = i.saturating_sub(1)..=(i + 1).min(rows - 1);
            let value = size(i, j);
            let top = near.clone().all(|a| {
                (j.saturating_sub(1)..=(j + 1).min(columns - 1)).all(|b| size(a, b) <= value)
            });
            if top && value > 0.0 {
                best.push((value, i, j));
            }
        }
    }
    best.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, i, j) in best {
        if out.len() == STARTS {
            break;
        }
        if out
            .iter()
            .all(|&(a, b)| a.abs_diff(i) > 1 || b.abs_diff(j) > 1)
        {
            out.push((i, j));
        }
    }
    if out.is_empty() {
        out.push((0, 0));
    }
    out
}
