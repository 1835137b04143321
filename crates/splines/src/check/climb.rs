//! From a good place to the best one near it.

use crate::Error;

/// Halvings of the step before a climb ends.
const HALVINGS: usize = 26;
/// Moves that a climb may make in all.
const MOVES: usize = 2000;

/// Climbs `f` from `at` to a place that no neighbour exceeds, and returns the value there.
///
/// A compass search: steps along each coordinate and along the diagonal on which all coordinates move alike,
/// kept within `bounds`, the step halved where none leads up, until it is 1e-7 of `step`. Needs no derivative
/// and takes kinks and ridges along coordinates and that diagonal.
///
/// # Errors
/// What `f` refuses.
///
/// # Source
/// Kolda, Lewis, Torczon, Optimization by direct search, SIAM Review 45, 385-482 (2003).
pub fn climb(
    f: impl Fn(&[f64]) -> Result<f64, Error>,
    at: &mut [f64],
    step: f64,
    bounds: [f64; 2],
) -> Result<f64, Error> {
    let n = at.len();
    let mut best = f(at)?;
    let (mut step, mut moves) = (step, 0);
    let mut trial = vec![0.0; n];
    for _ in 0..HALVINGS {
        let mut moved = true;
        while moved && moves < MOVES {
            moved = false;
            for direction in 0..2 * (n + 1) {
                let signed = if direction % 2 == 0 { step } else { -step };
                let axis = direction / 2;
                for (k, (t, a)) in trial.iter_mut().zip(at.iter()).enumerate() {
                    let moves = axis == n || axis == k;
                    *t = if moves { (a + signed).clamp(bounds[0], bounds[1]) } else { *a };
                }
                let value = f(&trial)?;
                if value > best {
                    best = value;
                    at.copy_from_slice(&trial);
                    moved = true;
                    moves += 1;
                }
            }
        }
        step *= 0.5;
    }
    Ok(best)
}
