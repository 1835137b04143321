//! The compliance of contacts that travel together at uniform speed, as a polynomial of time between two breaks of
//! their rails. The polynomial is the Hermite interpolant of G and its rate at four points.

use super::series::{Matrix, TERMS};
use crate::Error;
use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::mechanics::state::State;

/// Points of an interval, on [-1, 1], at which G and its rate are evaluated: zeros of the Chebyshev polynomial of
/// degree 4.
const PLACES: [f64; 4] = [
    -0.923_879_532_511_286_7,
    -0.382_683_432_365_089_8,
    0.382_683_432_365_089_8,
    0.923_879_532_511_286_7,
];

/// Largest coefficient of degree 7, relative to the compliance of rail and wheel, for which G is regarded as a
/// polynomial of degree 6.
const ROUNDING: f64 = 1e-11;

/// G over one interval of time, by divided differences over [`PLACES`], each point used twice.
pub(super) struct Path<const P: usize> {
    middle: f64,
    half: f64,
    differences: [Matrix<P>; TERMS],
}

impl<const P: usize> Path<P> {
    /// Interpolates G from time `from` to `to` at `speed`; `softness` is the compliance of the wheels. Returns `None`
    /// if G is not a polynomial of degree 6.
    ///
    /// # Errors
    /// Any error from evaluating the structures.
    pub fn new(
        system: &System,
        geometry: &mut Geometry,
        at: &State,
        [from, to]: [f64; 2],
        speed: f64,
        softness: f64,
    ) -> Result<Option<Self>, Error> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let m = system.elements.len();
        let (mut value, mut rate) = ([[[0.0; P]; P]; 4], [[[0.0; P]; P]; 4]);
        let mut size = softness;
        for (place, (value, rate)) in PLACES.iter().zip(value.iter_mut().zip(&mut rate)) {
            geometry.update(system, middle + half * place, &at.q, &at.force)?;
            for i in 0..m {
                for j in 0..m {
                    let (there, back) = (i * m + j, j * m + i);
                    value[i][j] = geometry.rails().value[there];
                    rate[i][j] = (geometry.rails().slope[there] + geometry.rails().slope[back])
                        * speed
                        * half;
                }
                size = size.max(value[i][i]);
            }
        }
        let mut all: [Matrix<P>; TERMS + 1] = std::array::from_fn(|k| value[k / 2]);
        for order in 1..=TERMS {
            for k in (order..=TERMS).rev() {
                let gap = place(k) - place(k - order);
                let (before, own) = (all[k - 1], &mut all[k]);
                for (i, row) in own.iter_mut().enumerate() {
                    for (j, entry) in row.iter_mut().enumerate() {
                        *entry = if gap == 0.0 {
                            rate[k / 2][i][j]
                        } else {
                            (*entry - before[i][j]) / gap
                        };
                    }
                }
            }
        }
        let [differences @ .., last] = all;
        let is_polynomial = last
            .as_flattened()
            .iter()
            .all(|last| last.abs() <= ROUNDING * size);
        Ok(is_polynomial.then_some(Path {
            middle,
            half,
            differences,
        }))
    }

    /// Coefficients of G over the time since `t` divided by `scale`.
    #[inline(always)]
    pub fn about(&self, t: f64, scale: f64) -> [Matrix<P>; TERMS] {
        let at = (t - self.middle) / self.half;
        let mut sum = [[[0.0; P]; P]; TERMS];
        sum[0] = self.differences[TERMS - 1];
        for k in (0..TERMS - 1).rev() {
            let gap = at - place(k);
            for j in (1..TERMS - k).rev() {
                let lower = sum[j - 1];
                blend(&mut sum[j], gap, &lower);
            }
            blend(&mut sum[0], gap, &self.differences[k]);
        }
        let mut power = 1.0;
        for matrix in &mut sum[1..] {
            power *= scale / self.half;
            matrix
                .as_flattened_mut()
                .iter_mut()
                .for_each(|entry| *entry *= power);
        }
        sum
    }
}

fn place(k: usize) -> f64 {
    PLACES[k / 2]
}

/// `sum` = `gap` `sum` + `more`.
#[inline(always)]
fn blend<const P: usize>(sum: &mut Matrix<P>, gap: f64, more: &Matrix<P>) {
    for (sum, more) in sum.as_flattened_mut().iter_mut().zip(more.as_flattened()) {
        *sum = *sum * gap + more;
    }
}
