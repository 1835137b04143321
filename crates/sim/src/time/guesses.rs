//! First guesses of the stages of diagonally implicit Runge-Kutta methods from the stages before them.
//!
//! The stages of a linear motion y' = L y have the derivatives sum_k h^k (A^k 1)_i y^(k+1), where A is the matrix of the method,
//! 1 a vector of ones and y^(k) the derivatives at the start of the step. A guess sum_j w_j y'_j of stage i from n stages before
//! it has weights for which sum_j w_j (A^k 1)_j = (A^k 1)_i, k < n. It is exact where the derivatives above the n-th vanish, though the
//! stages themselves are of order one or two; a polynomial through them is not, and is several times farther from stages whose
//! order is lower than its degree.
//!
//! # Source
//! Higueras, Roldan, Starting algorithms for some DIRK methods, Numerical Algorithms 23 (2000): conditions on such weights.

use super::tableau::Tableau;
use crate::numerics::dense::solve_general;

/// Weights of the stages before it in the guess of each stage, of one method.
pub(crate) struct Guesses {
    /// For steps in which the set of elements with a force changes, and for others.
    weights: [Vec<Vec<(usize, f64)>>; 2],
}

impl Guesses {
    /// Computes the weights of the stages that the method names.
    pub fn new(tableau: &Tableau) -> Self {
        let powers = powers(tableau);
        let of_stage = |(i, stages): (usize, &&[usize])| weights(&powers, i, stages);
        Guesses {
            weights: tableau
                .guess
                .map(|stages| stages.iter().enumerate().map(of_stage).collect()),
        }
    }

    /// Stages from which stage `i` is guessed, with their weights; none where the stage before it is the guess. `is_smooth` says
    /// that the same elements have a force in all stages before it.
    pub fn of_stage(&self, i: usize, is_smooth: bool) -> &[(usize, f64)] {
        &self.weights[usize::from(is_smooth)][i]
    }
}

/// The vectors A^k 1 for all k below the number of stages.
fn powers(tableau: &Tableau) -> Vec<Vec<f64>> {
    let count = tableau.stages();
    let next = |last: &Vec<f64>| -> Option<Vec<f64>> {
        let row = |i: usize| {
            last.iter()
                .enumerate()
                .map(|(j, power)| tableau.coefficient(i, j) * power)
                .sum()
        };
        Some((0..count).map(row).collect())
    };
    std::iter::successors(Some(vec![1.0; count]), next)
        .take(count)
        .collect()
}

fn weights(powers: &[Vec<f64>], i: usize, stages: &[usize]) -> Vec<(usize, f64)> {
    let conditions = &powers[..stages.len()];
    let mut matrix: Vec<f64> = conditions
        .iter()
        .flat_map(|power| stages.iter().map(|&stage| power[stage]))
        .collect();
    let mut weights: Vec<f64> = conditions.iter().map(|power| power[i]).collect();
    let is_solved = solve_general(&mut matrix, &mut weights);
    is_solved
        .then(|| stages.iter().copied().zip(weights).collect())
        .expect("a method names independent stages")
}

#[cfg(test)]
mod tests {
    use super::Guesses;
    use crate::time::tableau::{ESDIRK5, SDIRK4, Tableau};

    /// Derivatives y' of the stages of y' = z y, y(0) = 1, h = 1.
    fn stages(tableau: &Tableau, z: f64) -> Vec<f64> {
        let mut slopes: Vec<f64> = Vec::new();
        for i in 0..tableau.stages() {
            let known: f64 = slopes
                .iter()
                .enumerate()
                .map(|(j, slope)| tableau.coefficient(i, j) * slope)
                .sum();
            slopes.push(z * (1.0 + known) / (1.0 - z * tableau.coefficient(i, i)));
        }
        slopes
    }

    /// Analytic: a guess from n stages of y' = z y errs by a multiple of z^(n+1), that of the derivatives that it leaves out, or of
    /// a higher power.
    #[test]
    fn a_guess_from_n_stages_errs_by_the_derivatives_above_the_nth() {
        for tableau in [&SDIRK4, &ESDIRK5] {
            let guesses = Guesses::new(tableau);
            for (is_smooth, i) in [false, true]
                .into_iter()
                .flat_map(|s| (2..tableau.stages()).map(move |i| (s, i)))
            {
                let own = guesses.of_stage(i, is_smooth);
                let error = |z: f64| {
                    let slopes = stages(tableau, z);
                    own.iter()
                        .map(|&(j, weight)| weight * slopes[j])
                        .sum::<f64>()
                        - slopes[i]
                };
                let order = (error(0.1) / error(0.05)).log2();
                let expected = (own.len() + 1) as f64;
                assert!(
                    order > expected - 0.35,
                    "stage {i} from {own:?}: order {order}, {expected} expected"
                );
            }
        }
    }
}
