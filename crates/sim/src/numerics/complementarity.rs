//! The linear complementarity problem of one-sided contact: F >= 0, s = A F - b >= 0, F . s = 0.
//!
//! A = G + diag(1/k) is symmetric positive definite, so the solution exists and is unique for every b.

use super::dense::{solve_general, solve_spd};

/// Maximum number of active-set sweeps before Lemke's method is used.
const SWEEPS: usize = 30;

/// Solves the problem for A (n x n, row-major, symmetric positive definite) and b. On entry `force` contains a first
/// guess, whose entries > 0 define the initial active set; on return it contains F. Returns the number of active sets
/// tried; `None` where no solution was found.
///
/// Each sweep of the primal-dual active set method (a semi-smooth Newton method) solves A F = b on the active
/// contacts, with F = 0 on the others. It then keeps the active contacts with F > 0 and activates the inactive
/// contacts with A F - b < 0. The iteration stops when the active set no longer changes. Where the sets cycle,
/// Lemke's pivoting is used, which terminates for every positive definite A.
///
/// # Source
/// Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865-888; Cottle, Pang, Stone, The Linear
/// Complementarity Problem (2009), section 4.4.
pub(crate) fn complementarity(a: &[f64], b: &[f64], force: &mut [f64]) -> Option<usize> {
    let n = b.len();
    let mut active: Vec<bool> = force.iter().map(|&f| f > 0.0).collect();
    for sweep in 1..=SWEEPS {
        solve_active(a, b, &active, force)?;
        let mut changed = false;
        for i in 0..n {
            let keep = if active[i] {
                force[i] > 0.0
            } else {
                (0..n).map(|j| a[i * n + j] * force[j]).sum::<f64>() - b[i] < 0.0
            };
            changed |= keep != active[i];
            active[i] = keep;
        }
        if !changed {
            return Some(sweep);
        }
    }
    lemke(a, b, force).then_some(SWEEPS + 1)
}

/// Solves for the forces of the active contacts; the forces of the inactive contacts are zero.
fn solve_active(a: &[f64], b: &[f64], active: &[bool], force: &mut [f64]) -> Option<()> {
    let n = b.len();
    let index: Vec<usize> = (0..n).filter(|&i| active[i]).collect();
    let mut matrix: Vec<f64> = index
        .iter()
        .flat_map(|&i| index.iter().map(move |&j| a[i * n + j]))
        .collect();
    let mut rhs: Vec<f64> = index.iter().map(|&i| b[i]).collect();
    if !solve_spd(&mut matrix, &mut rhs) {
        let mut matrix: Vec<f64> = index
            .iter()
            .flat_map(|&i| index.iter().map(move |&j| a[i * n + j]))
            .collect();
        rhs = index.iter().map(|&i| b[i]).collect();
        if !solve_general(&mut matrix, &mut rhs) {
            return None;
        }
    }
    force.fill(0.0);
    for (&i, f) in index.iter().zip(rhs) {
        force[i] = f;
    }
    Some(())
}

/// Lemke's complementary pivoting with a covering vector of ones. Returns false on a secondary ray or when the limit
/// on pivots is reached.
fn lemke(a: &[f64], b: &[f64], force: &mut [f64]) -> bool {
    let n = b.len();
    force.fill(0.0);
    if b.iter().all(|&entry| entry <= 0.0) {
        return true;
    }
    // Tableau of w - A z - 1 z0 = -b. The columns are w (n), z (n), z0 and the right-hand side.
    let width = 2 * n + 2;
    let mut tableau = vec![0.0; n * width];
    for i in 0..n {
        tableau[i * width + i] = 1.0;
        for j in 0..n {
            tableau[i * width + n + j] = -a[i * n + j];
        }
        tableau[i * width + 2 * n] = -1.0;
        tableau[i * width + 2 * n + 1] = -b[i];
    }
    let mut basis: Vec<usize> = (0..n).collect();
    let Some(mut row) = (0..n).max_by(|&p, &q| b[p].total_cmp(&b[q])) else {
        return true;
    };
    let mut entering = 2 * n;
    for _ in 0..50 * (n + 1) {
        let leaving = basis[row];
        pivot(&mut tableau, width, n, row, entering);
        basis[row] = entering;
        if leaving == 2 * n {
            for (i, &variable) in basis.iter().enumerate() {
                if (n..2 * n).contains(&variable) {
                    force[variable - n] = tableau[i * width + 2 * n + 1].max(0.0);
                }
            }
            return true;
        }
        entering = if leaving < n {
            leaving + n
        } else {
            leaving - n
        };
        let ratio = |i: usize| tableau[i * width + 2 * n + 1] / tableau[i * width + entering];
        let best = (0..n)
            .filter(|&i| tableau[i * width + entering] > 1e-14 * a[0].abs().max(f64::MIN_POSITIVE))
            .min_by(|&p, &q| {
                ratio(p)
                    .total_cmp(&ratio(q))
                    .then((basis[q] == 2 * n).cmp(&(basis[p] == 2 * n)))
            });
        match best {
            Some(next) => row = next,
            None => return false,
        }
    }
    false
}

fn pivot(tableau: &mut [f64], width: usize, n: usize, row: usize, column: usize) {
    let scale = tableau[row * width + column];
    for entry in &mut tableau[row * width..(row + 1) * width] {
        *entry /= scale;
    }
    for i in (0..n).filter(|&i| i != row) {
        let factor = tableau[i * width + column];
        if factor != 0.0 {
            for k in 0..width {
                tableau[i * width + k] -= factor * tableau[row * width + k];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{complementarity, lemke};

    /// A = B B^T/n + 0.05 I, and b such that a known pair F >= 0, s >= 0 with F . s = 0 is the solution.
    fn planted(n: usize, seed: u64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let mut numbers = fastrand::Rng::with_seed(seed);
        let mut random = move || numbers.f64() * 2.0 - 1.0;
        let factor: Vec<f64> = (0..n * n).map(|_| random()).collect();
        let mut a = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                a[i * n + j] = (0..n)
                    .map(|k| factor[i * n + k] * factor[j * n + k])
                    .sum::<f64>()
                    / n as f64;
            }
            a[i * n + i] += 0.05;
        }
        let mixed: Vec<f64> = (0..n).map(|_| random()).collect();
        let force: Vec<f64> = mixed.iter().map(|&m| m.max(0.0)).collect();
        let b = (0..n)
            .map(|i| (0..n).map(|j| a[i * n + j] * force[j]).sum::<f64>() - (-mixed[i]).max(0.0))
            .collect();
        (a, b, force)
    }

    #[test]
    fn active_set_and_lemke_both_find_the_planted_forces() {
        for n in [1, 2, 5, 8, 16] {
            for seed in 1..40 {
                let (a, b, force) = planted(n, seed);
                let mut found = vec![0.0; n];
                assert!(complementarity(&a, &b, &mut found).is_some());
                let mut pivoted = vec![0.0; n];
                assert!(lemke(&a, &b, &mut pivoted));
                for i in 0..n {
                    assert!(
                        (found[i] - force[i]).abs() < 1e-9,
                        "n {n} seed {seed}: {} for {}",
                        found[i],
                        force[i]
                    );
                    assert!(
                        (pivoted[i] - force[i]).abs() < 1e-9,
                        "lemke n {n} seed {seed}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_good_guess_ends_in_one_sweep() {
        let (a, b, force) = planted(8, 3);
        let mut guess = force.clone();
        assert_eq!(complementarity(&a, &b, &mut guess), Some(1));
    }

    /// Forces found by testing every active set for F >= 0 and s >= 0.
    fn brute(n: usize, a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
        (0..1_u32 << n).find_map(|set| {
            let active: Vec<bool> = (0..n).map(|i| set >> i & 1 == 1).collect();
            let mut force = vec![0.0; n];
            super::solve_active(a, b, &active, &mut force)?;
            let slack = |i: usize| (0..n).map(|j| a[i * n + j] * force[j]).sum::<f64>() - b[i];
            (0..n)
                .all(|i| force[i] >= 0.0 && (active[i] || slack(i) >= 0.0))
                .then_some(force)
        })
    }

    #[test]
    fn active_set_and_lemke_agree_with_every_set_tried() {
        for n in 1..=6 {
            for seed in 50..90 {
                let (a, mut b, _) = planted(n, seed);
                // This right-hand side has no known solution.
                b.reverse();
                let wanted = brute(n, &a, &b).expect("one set solves it");
                let (mut found, mut pivoted) = (vec![0.0; n], vec![0.0; n]);
                assert!(
                    complementarity(&a, &b, &mut found).is_some() && lemke(&a, &b, &mut pivoted)
                );
                for i in 0..n {
                    assert!(
                        (found[i] - wanted[i]).abs() < 1e-9
                            && (pivoted[i] - wanted[i]).abs() < 1e-9
                    );
                }
            }
        }
    }
}
