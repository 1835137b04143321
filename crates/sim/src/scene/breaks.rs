//! Coordinates of all rails at which time steps must end, in increasing order.

use super::foundation::Foundation;
use super::irregularity::Irregularity;

/// Breaks of every rail: those of its [`Extent`](super::foundation::Extent) and the corners of its irregularity.
pub(crate) struct RailBreaks {
    /// Increasing coordinates of each rail of each structure.
    sorted: Vec<Vec<Vec<f64>>>,
}

impl RailBreaks {
    /// Sorts the breaks of all rails.
    pub fn new(foundations: &[Foundation]) -> Self {
        let of_rail = |foundation: &Foundation, rail: usize| {
            let own = foundation
                .rails
                .get(rail)
                .map_or(&[][..], |extent| &extent.breaks);
            let corners = foundation
                .irregularities
                .get(rail)
                .map_or(&[][..], Irregularity::breaks);
            let mut all: Vec<f64> = own
                .iter()
                .chain(corners)
                .copied()
                .filter(|x| !x.is_nan())
                .collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        };
        let of_structure = |foundation: &Foundation| {
            let rails = foundation.rails.len().max(foundation.irregularities.len());
            (0..rails).map(|rail| of_rail(foundation, rail)).collect()
        };
        RailBreaks {
            sorted: foundations.iter().map(of_structure).collect(),
        }
    }

    /// Breaks of `rail` of `structure` from `a` to `b`, both included, in the order in which a wheel that moves from
    /// `a` to `b` meets them. They are found by bisection.
    pub fn between(
        &self,
        structure: usize,
        rail: usize,
        a: f64,
        b: f64,
    ) -> impl ExactSizeIterator<Item = f64> + '_ {
        let all = self.of_rail(structure, rail);
        let (low, high) = (a.min(b), a.max(b));
        let from = &all[all.partition_point(|x| *x < low)..];
        let found = &from[..from.partition_point(|x| *x <= high)];
        let last = found.len().saturating_sub(1);
        (0..found.len()).map(move |k| if a <= b { found[k] } else { found[last - k] })
    }

    /// Breaks of `rail` of `structure` next before and behind `x`; `None` where `x` is at a break or beyond all.
    pub fn around(&self, structure: usize, rail: usize, x: f64) -> Option<[f64; 2]> {
        let all = self.of_rail(structure, rail);
        let behind = all.partition_point(|own| *own < x);
        let bounds = [*all.get(behind.checked_sub(1)?)?, *all.get(behind)?];
        (bounds[1] > x).then_some(bounds)
    }

    /// Breaks of `rail` of `structure` next before and behind `x`, infinite where there is none.
    pub fn about(&self, structure: usize, rail: usize, x: f64) -> [f64; 2] {
        let all = self.of_rail(structure, rail);
        let behind = all.partition_point(|own| *own <= x);
        let before = behind.checked_sub(1).map(|at| all[at]);
        [
            before.unwrap_or(f64::NEG_INFINITY),
            all.get(behind).copied().unwrap_or(f64::INFINITY),
        ]
    }

    fn of_rail(&self, structure: usize, rail: usize) -> &[f64] {
        self.sorted
            .get(structure)
            .and_then(|rails| rails.get(rail))
            .map_or(&[][..], Vec::as_slice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Extent;

    #[test]
    fn breaks_come_in_the_order_in_which_a_wheel_meets_them() {
        let extent = Extent {
            range: None,
            breaks: vec![9.0, 2.0, f64::NAN, 5.0, 2.0],
        };
        let shape =
            Irregularity::new(&[[1.0, 0.0], [3.0, 0.1], [5.0, 0.0]], &[]).expect("rows in order");
        let foundation = Foundation {
            rails: vec![extent],
            irregularities: vec![shape],
            ..Foundation::rigid()
        };
        let breaks = RailBreaks::new(&[Foundation::rigid(), foundation]);
        let of = |a: f64, b: f64| breaks.between(1, 0, a, b).collect::<Vec<_>>();
        assert_eq!(of(0.0, 10.0), [1.0, 2.0, 3.0, 5.0, 9.0]);
        assert_eq!(of(5.0, 1.5), [5.0, 3.0, 2.0]);
        assert_eq!(of(2.0, 2.0), [2.0]);
        assert_eq!(of(9.1, 20.0), [0.0; 0]);
        assert_eq!(of(f64::NAN, f64::NAN), [0.0; 0]);
        assert_eq!(breaks.between(0, 0, 0.0, 10.0).len(), 0);
        assert_eq!(breaks.between(1, 1, 0.0, 10.0).len(), 0);
        let around = |x: f64| breaks.around(1, 0, x);
        assert_eq!(
            [1.5, 4.0, 8.9].map(around),
            [Some([1.0, 2.0]), Some([3.0, 5.0]), Some([5.0, 9.0])]
        );
        assert_eq!([0.5, 1.0, 3.0, 9.0, 9.5, f64::NAN].map(around), [None; 6]);
        assert_eq!(breaks.about(1, 0, 4.0), [3.0, 5.0]);
        assert_eq!(breaks.about(1, 0, 0.0), [f64::NEG_INFINITY, 1.0]);
        assert_eq!(breaks.about(1, 0, 9.5), [9.0, f64::INFINITY]);
        assert_eq!(
            [breaks.around(0, 0, 1.5), breaks.around(1, 1, 1.5)],
            [None; 2]
        );
    }
}
