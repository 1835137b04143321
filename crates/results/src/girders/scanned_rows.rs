//! The rows of a history at which peaks are looked for: every row where loads and motions vary quickly, one of up to
//! [`MOST`] where they are smooth. Extremes are then followed among all rows.

/// By how much loads and motions may differ from cubic polynomials through the scanned rows, relative to the largest magnitude
/// of their kind.
///
/// A sinusoid is scanned at 45 rows a period or more for this, and the vertex of a parabola through three of them is as near
/// to its crest.
const SMOOTH: f64 = 1e-5;
/// Largest number of rows from a scanned row to the next, a power of two.
const MOST: usize = 8;
/// What following peaks costs more than without rows left out, in rows that are evaluated at all sections.
const FOLLOWED: usize = 200;
/// Largest distance that a load moves from a scanned row to the next, relative to the shortest span.
const MOVED: f64 = 0.02;

/// Whether `scanned` rows, and what it costs to follow peaks between them, are fewer than `others`.
pub(super) fn is_worthwhile(scanned: usize, others: usize) -> bool {
    scanned + FOLLOWED <= others
}

/// The least number of rows that are scanned of so many.
pub(super) fn fewest(count: usize) -> usize {
    count.div_ceil(MOST)
}

/// Numbers of the `samples` that are scanned: among them those of `kept`, the first and the last. The first value of a
/// sample is its time; `kinds` are the places of the others by kind, those of coordinates of loads first. `span` is the
/// length of the shortest span.
///
/// Rows are left out by halves: every second one where the cubic polynomials through the four others beside it, two on either
/// side, are near enough to it in all channels, then every second one of those that are left, where those between them have
/// been left out.
pub(super) fn scanned_rows(
    samples: &[&[f64]],
    kinds: &[Vec<usize>; 4],
    kept: &[usize],
    span: f64,
) -> Vec<usize> {
    let count = samples.len();
    let size = |channels: &Vec<usize>| {
        let values = samples
            .iter()
            .flat_map(|sample| channels.iter().map(|c| sample[*c].abs()));
        values.fold(0.0, f64::max)
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
            let is_bare = half == 0
                || (is_left_out[row - half] && is_left_out.get(row + half) == Some(&true));
            if is_kept[row] || !is_bare || row < 3 * step || row + 3 * step >= count {
                continue;
            }
            let beside =
                [row - 3 * step, row - step, row + step, row + 3 * step].map(|row| samples[row]);
            let moved = |c: &usize| (beside[1][*c] - beside[2][*c]).abs();
            is_left_out[row] = kinds[0].iter().all(|c| moved(c) <= MOVED * span)
                && is_smooth(samples[row], beside, &allowed);
        }
        step *= 2;
    }
    (0..count).filter(|row| !is_left_out[*row]).collect()
}

/// Whether the channels of a row are within what is allowed of the polynomials through those of four others.
fn is_smooth(row: &[f64], beside: [&[f64]; 4], allowed: &[(usize, f64)]) -> bool {
    let weights: [f64; 4] = std::array::from_fn(|i| {
        let others = (0..4).filter(|j| *j != i);
        others
            .map(|j| (row[0] - beside[j][0]) / (beside[i][0] - beside[j][0]))
            .product()
    });
    allowed.iter().all(|&(c, allowed)| {
        let value: f64 = beside
            .iter()
            .zip(weights)
            .map(|(beside, weight)| weight * beside[c])
            .sum();
        (value - row[c]).abs() <= allowed
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Interval of the rows, and the number of them.
    const ROWS: (f64, usize) = (1e-3, 2000);

    /// Which of the rows are scanned of a load that moves by 1 m/s on spans of 10 m: its coordinate, its force, a
    /// displacement and an acceleration at a row, the last three by number from 0.
    fn scanned(value: &dyn Fn(usize, usize) -> f64, kept: &[usize]) -> Vec<bool> {
        let row = |row: usize| {
            let t = ROWS.0 * row as f64;
            [t, t, value(0, row), value(1, row), value(2, row)]
        };
        let rows: Vec<[f64; 5]> = (0..ROWS.1).map(row).collect();
        let samples: Vec<&[f64]> = rows.iter().map(|row| &row[..]).collect();
        let found = scanned_rows(&samples, &[vec![1], vec![2], vec![3], vec![4]], kept, 10.0);
        (0..ROWS.1)
            .map(|row| found.binary_search(&row).is_ok())
            .collect()
    }

    /// Three waves of half a second and of different size.
    fn wave(channel: usize, row: usize) -> f64 {
        [40.0, 0.02, 3.0][channel] * (12.0 * ROWS.0 * row as f64 + channel as f64).sin()
    }

    /// Analytic: seven of eight rows of smooth waves are left out but for the ends, and the cubic polynomials through
    /// four scanned rows are within the tolerance at all rows between; none is left out beside a value that changes its
    /// sign at every row.
    #[test]
    fn most_rows_of_smooth_waves_are_left_out_and_lie_near_the_polynomials_through_the_others() {
        let own = scanned(&wave, &[]);
        let rows: Vec<usize> = (0..ROWS.1).filter(|row| own[*row]).collect();
        assert!(rows.len() < ROWS.1 / 7, "{} rows", rows.len());
        assert!(own[0] && own[ROWS.1 - 1]);
        for four in rows.windows(4) {
            for (row, c) in (four[1]..four[2]).flat_map(|row| (0..3).map(move |c| (row, c))) {
                let weight = |i: usize| -> f64 {
                    let others = (0..4).filter(|j| *j != i).map(|j| four[j] as f64);
                    others
                        .map(|other| (row as f64 - other) / (four[i] as f64 - other))
                        .product()
                };
                let value: f64 = (0..4).map(|i| weight(i) * wave(c, four[i])).sum();
                let error = (value - wave(c, row)).abs() / [40.0, 0.02, 3.0][c];
                assert!(error < 1.1 * SMOOTH, "{error:e} in {c} at {row}");
            }
        }
        let rough = scanned(
            &|c, row| {
                if c == 2 {
                    [1.0, -1.0][row % 2]
                } else {
                    wave(c, row)
                }
            },
            &[],
        );
        assert!(rough.iter().all(|is_scanned| *is_scanned));
    }

    /// Analytic: whichever channel has a corner (a break of a motion), comes to zero and stays there (a contact that
    /// opens) or jumps (a switch), at a row or between rows, the rows beside it are scanned, and few others.
    #[test]
    fn rows_beside_a_corner_or_a_jump_are_never_left_out() {
        let corner = |past: f64| 5.0 * past.max(0.0);
        let jump = |past: f64| if past > 0.0 { 0.01 } else { 0.0 };
        for (channel, at) in (0..3).flat_map(|c| (1000..1017).map(move |k| (c, 0.5 * f64::from(k))))
        {
            let size = [40.0, 0.02, 3.0][channel];
            // from the middle of the force down to zero, where the contact opens
            let open = |past: f64| size * (-12.0 * past).clamp(0.0, 1.0);
            let with = |kink: &dyn Fn(f64) -> f64, keeps_wave: bool| {
                let value = |c: usize, row: usize| {
                    let past = ROWS.0 * (row as f64 - at);
                    let wave = if c != channel || keeps_wave {
                        wave(c, row)
                    } else {
                        0.0
                    };
                    if c == channel {
                        wave + kink(past)
                    } else {
                        wave
                    }
                };
                scanned(&value, &[])
            };
            let found = [
                with(&|past| size * corner(past), true),
                with(&|past| size * jump(past), true),
                with(&open, false),
            ];
            for (kind, own) in found.iter().enumerate() {
                let beside = [at.ceil() as usize - 1, at.floor() as usize + 1];
                assert!(
                    (beside[0]..=beside[1]).all(|row| own[row]),
                    "{kind} of {channel} at {at}"
                );
                let count = own.iter().filter(|is_scanned| **is_scanned).count();
                assert!(count < ROWS.1 / 6, "{count} rows");
            }
        }
    }

    /// Rows that are to be kept are, wherever they are, and so are all between which a load moves too far.
    #[test]
    fn rows_that_are_to_be_kept_are_scanned() {
        let kept = [301, 302, 304, 1001];
        let own = scanned(&wave, &kept);
        assert!(kept.iter().all(|row| own[*row]));
        assert!(!scanned(&wave, &[])[301]);
        let fast: Vec<[f64; 2]> = (0..50)
            .map(|row| [f64::from(row), 0.11 * f64::from(row)])
            .collect();
        let samples: Vec<&[f64]> = fast.iter().map(|row| &row[..]).collect();
        let kinds = [vec![1], Vec::new(), Vec::new(), Vec::new()];
        assert_eq!(scanned_rows(&samples, &kinds, &[], 10.0).len(), 50);
        assert!(scanned_rows(&samples, &kinds, &[], 100.0).len() < 30);
    }
}
