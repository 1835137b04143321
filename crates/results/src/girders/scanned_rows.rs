//! The rows of a history at which peaks are looked for: every row where loads and motions vary quickly, one of up to
//! [`MOST`] where they are smooth. Extremes are then followed among all rows.

use super::instants::LoadStates;

/// By how much loads and motions may differ from cubic polynomials through the scanned rows, relative to the largest magnitude
/// of their kind.
///
/// A sinusoid is scanned at 45 rows a period or more for this, and the vertex of a parabola through three of them is as near
/// to its crest.
const SMOOTH: f64 = 1e-5;
/// Largest number of rows from a scanned row to the next, a power of two.
pub(super) const MOST: usize = 8;
/// Largest distance that a load moves from a scanned row to the next, relative to the shortest span.
const MOVED: f64 = 0.02;

/// Numbers of the rows of `states` that are scanned: among them those of `kept`, the first and the last. `span` is the length
/// of the shortest span.
///
/// Rows are left out by halves: every second one where the cubic polynomials through the four others beside it, two on either
/// side, are near enough to it in all channels, then every second one of those that are left, where those between them have
/// been left out.
pub(super) fn scanned_rows(states: &LoadStates, kept: &[usize], span: f64) -> Vec<usize> {
    let count = states.len();
    let kinds = states.kinds();
    let size = |channels: &Vec<usize>| {
        let rows = (0..count).map(|row| states.row(row));
        rows.flat_map(|row| channels.iter().map(|c| row[*c].abs())).fold(0.0, f64::max)
    };
    let allowed: Vec<(usize, f64)> = kinds
        .iter()
        .flat_map(|channels| {
            let allowed = SMOOTH * size(channels);
            channels.iter().map(move |c| (*c, allowed))
        })
        .collect();
    let mut is_left_out = vec![false; count];
    let mut is_kept = vec![false; count];
    kept.iter().for_each(|row| is_kept[*row] = true);
    let mut step = 1;
    while step < MOST {
        for row in (step..count).step_by(2 * step) {
            let half = step / 2;
            let is_bare =
                half == 0 || (is_left_out[row - half] && is_left_out.get(row + half) == Some(&true));
            if is_kept[row] || !is_bare || row < 3 * step || row + 3 * step >= count {
                continue;
            }
            let beside = [row - 3 * step, row - step, row + step, row + 3 * step].map(|row| states.row(row));
            let moved = |c: &usize| (beside[1][*c] - beside[2][*c]).abs();
            is_left_out[row] = kinds[0].iter().all(|c| moved(c) <= MOVED * span)
                && is_smooth(states.row(row), beside, &allowed);
        }
        step *= 2;
    }
    (0..count).filter(|row| !is_left_out[*row]).collect()
}

/// Whether the channels of a row are within what is allowed of the polynomials through those of four others.
fn is_smooth(row: &[f64], beside: [&[f64]; 4], allowed: &[(usize, f64)]) -> bool {
    let weights: [f64; 4] = std::array::from_fn(|i| {
        let others = (0..4).filter(|j| *j != i);
        others.map(|j| (row[0] - beside[j][0]) / (beside[i][0] - beside[j][0])).product()
    });
    allowed.iter().all(|&(c, allowed)| {
        let value: f64 = beside.iter().zip(weights).map(|(beside, weight)| weight * beside[c]).sum();
        (value - row[c]).abs() <= allowed
    })
}
