//! Factors of the derivatives of the residual by the differences at all places.

use super::places::{COUNT, sum_of, weights};
use crate::contact::solver::follow::Followed;
use crate::numerics::lu::LuFactors;

/// Place whose compliance serves for all.
pub const MIDDLE: usize = 2;

/// Factors of the derivatives of the residual by the differences.
///
/// With the compliance G of one place for all, stiffnesses K and dampings C, the derivatives are I + G K at each place and
/// (d/h) G C between places, where d are the weights of the slopes at the places. The derivative of a cubic polynomial taken
/// four times is zero, d^4 = 0, so that the series of the inverse ends: with B = (I + G K)^-1 G C/h
///
/// x = sum over j from 0 to 3 of (-1)^j d^j B^j (I + G K)^-1 r.
///
/// The factors of I + G K are those by which the springs' penetrations were found, and B = (I - (I + G K)^-1) K^-1 C/h.
/// Iterations converge as the compliance at the other places differs from this one. Where some differences at the start are
/// known, or laws are not linear, the whole matrix is factored.
#[derive(Default)]
pub struct Factors {
    whole: LuFactors,
    /// C/(K h) of each contact, where the compliance of one place serves for all.
    delays: Option<Vec<f64>>,
    /// Working memory: the equations place by place, a term of the series and its image.
    line: Vec<f64>,
    term: Vec<[f64; COUNT]>,
    image: Vec<[f64; COUNT]>,
}

impl Factors {
    /// Sets them to those of contacts that are `followed` at the places of a step of length `h` under the `laws`: force,
    /// stiffness and damping, place by place. Where they are alike at all places (`is_alike`), the laws are linear, and the
    /// equation is solved at all places for all contacts; else `is_solved` tells for each place and contact.
    pub fn set(
        &mut self,
        followed: &[Followed; COUNT],
        laws: &[[f64; 3]],
        (h, is_alike): (f64, bool),
        is_solved: impl Fn(usize, usize) -> bool,
    ) {
        let count = laws.len() / COUNT;
        let delays = self.delays.get_or_insert_default();
        delays.clear();
        delays.extend(
            laws[..count]
                .iter()
                .map(|[_, by_place, by_rate]| by_rate / (by_place * h)),
        );
        if is_alike && delays.iter().all(|delay| delay.is_finite()) {
            return;
        }
        self.delays = None;
        let size = COUNT * count;
        self.whole.replace(size, |matrix| {
            matrix.resize(size * size, 0.0);
            matrix
                .iter_mut()
                .step_by(size + 1)
                .for_each(|own| *own = 1.0);
            for (a, (node, weights)) in followed.iter().zip(weights()).enumerate() {
                for r in (0..count).filter(|&r| is_solved(a, r)) {
                    let row = a * count + r;
                    let entries = node
                        .compliances(r)
                        .iter()
                        .zip(&laws[a * count..])
                        .enumerate();
                    for (c, (compliance, [_, by_place, by_rate])) in entries {
                        matrix[row * size + a * count + c] += compliance * by_place;
                        for (b, weight) in weights.iter().enumerate() {
                            matrix[row * size + b * count + c] += compliance * by_rate * weight / h;
                        }
                    }
                }
            }
        });
    }

    /// Whether they are those of the whole matrix.
    pub fn are_whole(&self) -> bool {
        self.delays.is_none()
    }

    /// Replaces the `residual` by the change of the differences that brings it to zero; false where the factors are
    /// singular. The contacts are those with which the factors were set.
    pub fn solve(&mut self, followed: &[Followed; COUNT], residual: &mut [[f64; COUNT]]) -> bool {
        let Factors {
            whole,
            delays,
            line,
            term,
            image,
        } = self;
        let Some(delays) = delays else {
            line.clear();
            (0..COUNT).for_each(|a| line.extend(residual.iter().map(|own| own[a])));
            let is_solved = whole.solve(line);
            for (a, at_place) in line.chunks_exact(residual.len()).enumerate() {
                residual
                    .iter_mut()
                    .zip(at_place)
                    .for_each(|(own, value)| own[a] = *value);
            }
            return is_solved;
        };
        let in_place = followed[MIDDLE].factors();
        if !in_place.solve_four(residual) {
            return false;
        }
        term.clear();
        term.extend_from_slice(residual);
        for _ in 1..COUNT {
            for (term, delay) in term.iter_mut().zip(&*delays) {
                let own = *term;
                *term = weights().map(|weights| delay * sum_of(&weights, &own));
            }
            image.clear();
            image.extend_from_slice(term);
            if !in_place.solve_four(image) {
                return false;
            }
            for ((sum, term), image) in residual.iter_mut().zip(&mut *term).zip(&*image) {
                for ((sum, term), image) in sum.iter_mut().zip(term).zip(image) {
                    *term = image - *term;
                    *sum += *term;
                }
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Identity: where the compliance is the same at all places, the ended series is the inverse of the whole matrix.
    #[test]
    fn factors_of_one_place_solve_the_equation_of_all_places() {
        for count in [1, 2, 5, 70] {
            let compliance = |i: usize, j: usize| 1e-3 / (1.0 + i.abs_diff(j) as f64);
            let stiffness: Vec<f64> = (0..count).map(|i| 400.0 + i as f64).collect();
            let followed: [Followed; COUNT] =
                std::array::from_fn(|_| Followed::of_springs(compliance, &stiffness));
            let laws: Vec<[f64; 3]> = (0..COUNT)
                .flat_map(|_| stiffness.iter().enumerate())
                .map(|(i, &by_place)| [0.0, by_place, 30.0 + (i % 7) as f64])
                .collect();
            let residual: Vec<[f64; COUNT]> = (0..count)
                .map(|i| std::array::from_fn(|a| (1.0 + (COUNT * i + a) as f64).sin()))
                .collect();
            let [expected, found] = [false, true].map(|is_alike| {
                let (mut factors, mut change) = (Factors::default(), residual.clone());
                factors.set(&followed, &laws, (0.7, is_alike), |_, _| true);
                assert_eq!(factors.are_whole(), !is_alike);
                assert!(factors.solve(&followed, &mut change), "I + G K is regular");
                change
            });
            let largest = expected
                .iter()
                .flatten()
                .fold(0.0_f64, |largest, x| largest.max(x.abs()));
            for (expected, found) in expected.iter().flatten().zip(found.iter().flatten()) {
                assert!(
                    (expected - found).abs() < 1e-12 * largest,
                    "{count}: {found} for {expected}"
                );
            }
        }
    }
}
