//! Thinning of long curves that preserves all extremes.

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
