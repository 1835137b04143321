//! Pareto fronts of points (cost, error).
//!
//! A point a dominates b if neither its cost nor its error is larger than that of b, and a differs from b. The front
//! is the set of points that no other dominates. All pairs are compared: a study has a hundred points.

/// Whether each point (cost, error) lies on the Pareto front, which no other point dominates.
///
/// Of points that are equal in both, all are on the front or none is.
///
/// ```
/// assert_eq!(study::on_front(&[[1.0, 0.1], [2.0, 0.01], [3.0, 0.05]]), [true, true, false]);
/// ```
///
/// # Source
/// V. Pareto, Manuale di economia politica (1906): no change makes one better without making the other worse.
#[must_use]
pub fn on_front(points: &[[f64; 2]]) -> Vec<bool> {
    let dominates = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    points
        .iter()
        .map(|point| !points.iter().any(|other| dominates(other, point)))
        .collect()
}

/// The Pareto front of `points` (cost, error), by ascending cost; equal points appear once.
#[must_use]
pub fn front(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let kept = points
        .iter()
        .zip(on_front(points))
        .filter(|(_, on)| *on)
        .map(|(point, _)| *point);
    let mut front: Vec<[f64; 2]> = kept.collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    front.dedup();
    front
}

/// Ratio of the cost of a point (cost, error) to that of the cheapest of `points` with no larger error: 1 on the
/// front.
#[must_use]
pub fn cost_ratio(point: [f64; 2], points: &[[f64; 2]]) -> f64 {
    let no_worse = points.iter().filter(|other| other[1] <= point[1]);
    let cheapest = no_worse.map(|other| other[0]).fold(point[0], f64::min);
    if cheapest > 0.0 {
        point[0] / cheapest
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn front_is_what_no_point_dominates() {
        let points = [
            [1.0, 1e-1],
            [2.0, 1e-2],
            [2.5, 5e-2],
            [3.0, 1e-2],
            [4.0, 1e-4],
            [9.0, 1e-3],
            [4.0, 1e-4],
        ];
        assert_eq!(
            on_front(&points),
            [true, true, false, false, true, false, true]
        );
        assert_eq!(front(&points), [[1.0, 1e-1], [2.0, 1e-2], [4.0, 1e-4]]);
    }

    #[test]
    fn errors_of_a_front_fall_as_its_costs_rise() {
        // a scattered cloud: multiples of two irrational numbers, modulo 1
        let point = |i: i32| {
            [
                f64::from(i) * 0.618_034 % 1.0,
                f64::from(i) * 0.414_214 % 1.0,
            ]
        };
        let cloud: Vec<[f64; 2]> = (1..500).map(point).collect();
        let front = front(&cloud);
        assert!(front.len() > 2);
        assert!(
            front
                .windows(2)
                .all(|pair| pair[0][0] < pair[1][0] && pair[0][1] > pair[1][1])
        );
        for point in &cloud {
            assert!(
                front
                    .iter()
                    .any(|best| best[0] <= point[0] && best[1] <= point[1]),
                "{point:?}"
            );
            assert_eq!(
                cost_ratio(*point, &cloud) == 1.0,
                front.contains(point),
                "{point:?}"
            );
        }
    }

    #[test]
    fn excess_is_the_ratio_to_the_cheapest_that_errs_no_more() {
        let points = [[1.0, 1e-1], [2.0, 1e-2], [8.0, 1e-3]];
        assert_eq!(cost_ratio([6.0, 2e-2], &points), 3.0);
        assert_eq!(cost_ratio([2.0, 1e-2], &points), 1.0);
        assert_eq!(cost_ratio([5.0, 1e-6], &points), 1.0);
    }
}
