//! Thinning of curves: of long ones that preserves all extremes, and of drawn ones by a distance that nobody sees.

/// Indices of the points that remain of a polyline with far more points than the picture has columns.
///
/// The points are divided into runs of consecutive points within one column of the width `column`. Of each run the
/// first, lowest, highest and last point remain, in their order: at most four. The envelope of the curve is therefore
/// that of all points to the last bit, also for curves whose x is not monotonic. Polylines of at most `limit` points
/// are unchanged.
pub(super) fn thin(points: &[[f64; 2]], column: f64, limit: usize) -> Vec<usize> {
    if points.len() <= limit {
        return (0..points.len()).collect();
    }
    let place = |i: usize| (points[i][0] / column).floor();
    let mut kept = Vec::with_capacity(limit);
    let mut start = 0;
    while start < points.len() {
        let mut end = start + 1;
        while end < points.len() && place(end) == place(start) {
            end += 1;
        }
        let (mut low, mut high) = (start, start);
        for i in start..end {
            if points[i][1] < points[low][1] {
                low = i;
            }
            if points[i][1] > points[high][1] {
                high = i;
            }
        }
        let mut run = [start, low.min(high), low.max(high), end - 1];
        run.sort_unstable();
        for i in run {
            if kept.last() != Some(&i) {
                kept.push(i);
            }
        }
        start = end;
    }
    kept
}

/// Indices of the points that remain of a polyline if every point that is left out is at most `distance` away from the
/// line between the remaining points before and after it (the algorithm of Douglas and Peucker).
///
/// Distances are vertical over lines that run to the right, and to the nearest end of others, so that they are never
/// smaller than those to the line.
pub(super) fn simplified(points: &[[f64; 2]], distance: f64) -> Vec<usize> {
    let mut is_kept = vec![points.len() < 3; points.len()];
    let mut open = Vec::new();
    if let (Some(last), false) = (points.len().checked_sub(1), points.len() < 3) {
        (is_kept[0], is_kept[last]) = (true, true);
        open.push((0, last));
    }
    while let Some((from, to)) = open.pop() {
        let ([x0, y0], [x1, y1]) = (points[from], points[to]);
        let away = |[x, y]: [f64; 2]| match x1 > x0 && (x0..=x1).contains(&x) {
            true => (y - y0 - (y1 - y0) * (x - x0) / (x1 - x0)).abs(),
            false => (x - x0).hypot(y - y0).min((x - x1).hypot(y - y1)),
        };
        let (mut farthest, mut most) = (from, distance);
        for (i, point) in points.iter().enumerate().take(to).skip(from + 1) {
            let own = away(*point);
            if own > most {
                (farthest, most) = (i, own);
            }
        }
        if farthest > from {
            is_kept[farthest] = true;
            open.extend([(from, farthest), (farthest, to)]);
        }
    }
    (0..points.len()).filter(|i| is_kept[*i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_point_left_out_is_farther_away_than_asked() {
        let points: Vec<[f64; 2]> = (0..4000)
            .map(|i| f64::from(i) * 0.2)
            .map(|x| {
                [
                    x,
                    100.0 * (x / 70.0).sin()
                        + if (300.0..310.0).contains(&x) {
                            20.0
                        } else {
                            0.0
                        },
                ]
            })
            .collect();
        let kept = simplified(&points, 0.05);
        assert!(kept.len() < 400, "{} of {}", kept.len(), points.len());
        assert_eq!((kept.first(), kept.last()), (Some(&0), Some(&3999)));
        for pair in kept.windows(2) {
            let ([x0, y0], [x1, y1]) = (points[pair[0]], points[pair[1]]);
            for [x, y] in &points[pair[0]..pair[1]] {
                assert!((y - y0 - (y1 - y0) * (x - x0) / (x1 - x0)).abs() <= 0.05 + 1e-12);
            }
        }
    }

    #[test]
    fn paths_that_turn_back_keep_their_corners() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
        assert_eq!(simplified(&square, 0.05), [0, 1, 2, 3, 4]);
        let upright = [[3.0, 0.0], [3.0, 5.0], [3.0, 2.0]];
        assert_eq!(simplified(&upright, 0.05), [0, 1, 2]);
        assert_eq!(simplified(&square[..2], 0.05), [0, 1]);
        assert!(simplified(&[], 0.05).is_empty());
    }
}
