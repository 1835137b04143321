//! Polylines on the picture: thinned without losing extremes, walked by length.

/// Thins a polyline that has far more points than the picture has columns.
///
/// Runs of consecutive points within one column of the given width keep their first, lowest, highest and last
/// point, in order: at most four points a run, and the envelope of the curve is that of all points, to the
/// last bit. Works for curves that turn back in x as well. Short polylines are returned as they are.
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

/// Points every `spacing` along a polyline, the first at `offset`.
pub(super) fn along(points: &[[f64; 2]], spacing: f64, offset: f64) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let (mut gone, mut next) = (0.0, offset);
    for pair in points.windows(2) {
        let (dx, dy) = (pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
        let length = dx.hypot(dy);
        while length > 0.0 && next <= gone + length {
            let t = (next - gone) / length;
            found.push([pair[0][0] + t * dx, pair[0][1] + t * dy]);
            next += spacing;
        }
        gone += length;
    }
    found
}
