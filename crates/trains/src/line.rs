//! Influence lines as piecewise cubics along the rails.

use crate::train::COMPONENTS;

/// Places in a cell at which a function is sampled to find its cubic: the nodes of Chebyshev, which keep away from the
/// ends, where a line may jump.
pub(crate) const NODES: [f64; 4] = [
    0.038_060_233_744_356_62,
    0.308_658_283_817_455_1,
    0.691_341_716_182_544_9,
    0.961_939_766_255_643_4,
];

/// Influence lines of N responses over one stretch of rail.
#[derive(Clone, Debug)]
pub(crate) struct LineCell<const N: usize> {
    /// First and last coordinate.
    pub x: [f64; 2],
    /// Number of the stretch of rail; `None` where several have been joined.
    pub stretch: Option<usize>,
    /// Whether it begins within a member, where its lines have no kink.
    pub begins_inside: bool,
    /// By component of the load and response: the cubic in the distance from `x[0]`.
    pub cubics: [[[f64; 4]; N]; COMPONENTS],
}

/// Influence lines of N responses: for each rail, its cells by increasing coordinate, without gaps.
#[derive(Clone, Debug)]
pub(crate) struct Lines<const N: usize> {
    pub rails: Vec<Vec<LineCell<N>>>,
}

impl<const N: usize> Lines<N> {
    /// Lines that are zero, with the cells of others.
    pub fn zeros_like<const M: usize>(other: &Lines<M>) -> Lines<N> {
        let zero = |cell: &LineCell<M>| LineCell {
            x: cell.x,
            stretch: cell.stretch,
            begins_inside: cell.begins_inside,
            cubics: [[[0.0; 4]; N]; COMPONENTS],
        };
        Lines {
            rails: other
                .rails
                .iter()
                .map(|cells| cells.iter().map(zero).collect())
                .collect(),
        }
    }
}

/// The cell at a coordinate; `None` beyond the rail.
pub(crate) fn cell_at<const N: usize>(cells: &[LineCell<N>], x: f64) -> Option<usize> {
    let (first, last) = (cells.first()?, cells.last()?);
    // A train that just fits may stand beyond an end by rounding.
    let slack = 1e-12 * first.x[0].abs().max(last.x[1].abs());
    if x < first.x[0] - slack || x > last.x[1] + slack {
        return None;
    }
    Some(
        cells
            .partition_point(|cell| cell.x[0] <= x)
            .saturating_sub(1),
    )
}

/// A stretch of rail on one side of every jump: a rail element, or a part of one on a member under axial force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    pub rail: usize,
    pub element: usize,
    /// Its number among the stretches of all rails.
    pub number: usize,
    pub x: [f64; 2],
    /// Whether each end is within the element.
    pub inner: [bool; 2],
}

impl Stretch {
    /// Whether it is the whole element.
    pub fn is_whole(&self) -> bool {
        self.inner == [false; 2]
    }

    /// The coordinates of those ends that are ends of the element.
    pub fn ends_of_element(&self) -> impl Iterator<Item = f64> + use<> {
        let ends = self.x.into_iter().zip(self.inner);
        ends.filter(|(_, inner)| !inner).map(|(x, _)| x)
    }
}

/// The cubics of functions that are cubic over a stretch, by their values at four nodes (Newton's divided differences);
/// `values` is evaluated at a coordinate and writes one value for each function.
pub(crate) fn cubics<E>(
    x: [f64; 2],
    count: usize,
    mut values: impl FnMut(f64, &mut [f64]) -> Result<(), E>,
) -> Result<Vec<[f64; 4]>, E> {
    let h = x[1] - x[0];
    let mut samples = vec![0.0; 4 * count];
    for (node, out) in NODES.iter().zip(samples.chunks_mut(count)) {
        values(x[0] + node * h, out)?;
    }
    let cubic = |k: usize| {
        let f: [f64; 4] = std::array::from_fn(|i| samples[i * count + k]);
        in_powers(f).into_iter().zip([1.0, h, h * h, h * h * h])
    };
    Ok((0..count)
        .map(|k| {
            let mut out = [0.0; 4];
            out.iter_mut()
                .zip(cubic(k))
                .for_each(|(out, (c, power))| *out = c / power);
            out
        })
        .collect())
}

/// A bound of a cubic on 0..=h: the largest of its Bernstein coefficients.
pub(crate) fn bound_of_cubic([a, b, c, d]: &[f64; 4], h: f64) -> f64 {
    let (b, c, d) = (b * h, c * h * h, d * h * h * h);
    let inner = (a + b / 3.0).max(a + (2.0 * b + c) / 3.0);
    inner.max(*a).max(a + b + c + d)
}

/// The value of a cubic.
pub(crate) fn value_of_cubic([a, b, c, d]: &[f64; 4], t: f64) -> f64 {
    a + t * (b + t * (c + t * d))
}

/// The cubic c(x + t).
pub(crate) fn shifted([a, b, c, d]: &[f64; 4], t: f64) -> [f64; 4] {
    [
        a + t * (b + t * (c + t * d)),
        b + t * (2.0 * c + t * (3.0 * d)),
        c + 3.0 * t * d,
        *d,
    ]
}

/// Coefficients of the cubic with the values f at the nodes.
pub(crate) fn in_powers(f: [f64; 4]) -> [f64; 4] {
    let [a, b, c, d] = NODES;
    let first = [
        (f[1] - f[0]) / (b - a),
        (f[2] - f[1]) / (c - b),
        (f[3] - f[2]) / (d - c),
    ];
    let second = [
        (first[1] - first[0]) / (c - a),
        (first[2] - first[1]) / (d - b),
    ];
    let third = (second[1] - second[0]) / (d - a);
    // f0 + (r - a) (f01 + (r - b) (f012 + (r - c) f0123))
    let inner = [second[0] - c * third, third];
    let middle = [first[0] - b * inner[0], inner[0] - b * inner[1], inner[1]];
    [
        f[0] - a * middle[0],
        middle[0] - a * middle[1],
        middle[1] - a * middle[2],
        middle[2],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_found_by_its_values() {
        let known = [0.3, -1.2, 0.7, 0.05];
        let found = cubics([2.0, 5.0], 1, |x, out| {
            let t = x - 2.0;
            out[0] = known[0] + t * (known[1] + t * (known[2] + t * known[3]));
            Ok::<(), ()>(())
        });
        for (a, b) in found.expect("the function has values")[0].iter().zip(known) {
            assert!((a - b).abs() < 1e-14, "{a}, not {b}");
        }
    }
}
