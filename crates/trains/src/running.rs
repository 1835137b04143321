//! Piecewise cubic functions of a position: running maxima and sums.

use crate::pieces::Piece;
use crate::polynomial::Polynomial;

/// A function that is cubic between increasing positions and may jump at them, where the larger of both limits counts.
#[derive(Clone, Debug, Default)]
pub(crate) struct PiecewiseFunction {
    /// First and last position of each piece, and the cubic in the distance from the first.
    pieces: Vec<([f64; 2], Polynomial)>,
}

impl PiecewiseFunction {
    /// Sign times response k of a list of pieces.
    pub fn of<const N: usize>(pieces: &[Piece<N>], k: usize, sign: f64) -> PiecewiseFunction {
        let cubic = |piece: &Piece<N>| Polynomial::default().plus(&piece.polynomial(k), sign);
        PiecewiseFunction { pieces: pieces.iter().map(|piece| (piece.position, cubic(piece))).collect() }
    }

    /// The largest value at positions up to `last`, with the first position that has it.
    pub fn largest(&self, last: f64) -> Option<(f64, f64)> {
        let mut best: Option<(f64, f64)> = None;
        for ([from, to], cubic) in self.pieces.iter().filter(|([from, _], _)| *from <= last) {
            let floor = best.map_or(f64::NEG_INFINITY, |(_, value)| value);
            if let Some((t, value)) = cubic.largest_above((to.min(last) - from).max(0.0), floor)
                && value > floor
            {
                best = Some((from + t, value));
            }
        }
        best
    }
}

/// q -> max over p <= q - distance of f(p), for q from the first position of f on; beyond the last it is constant up to
/// infinity. A `distance` of minus infinity stands for no restriction.
pub(crate) fn running_maximum(f: &PiecewiseFunction, distance: f64) -> PiecewiseFunction {
    let whole = [f64::NEG_INFINITY, f64::INFINITY];
    if distance == f64::NEG_INFINITY {
        let most = f.largest(f64::INFINITY).map_or(f64::NEG_INFINITY, |(_, value)| value);
        return PiecewiseFunction { pieces: vec![(whole, Polynomial::new(&[most]))] };
    }
    let mut out = PiecewiseFunction::default();
    let mut most = f64::NEG_INFINITY;
    let mut add = |from: f64, to: f64, cubic: Polynomial| {
        out.pieces.push(([from + distance, to + distance], cubic));
    };
    for ([start, end], cubic) in &f.pieces {
        let places = cubic.candidates(end - start);
        most = most.max(cubic.at(0.0));
        for ends in places.list().windows(2) {
            let (from, to) = (start + ends[0], start + ends[1]);
            let value = cubic.at(ends[1]);
            if value <= most {
                add(from, to, Polynomial::new(&[most]));
                continue;
            }
            let reached = if cubic.at(ends[0]) >= most { ends[0] } else { crossing(cubic, most, ends) };
            if reached > ends[0] {
                add(from, start + reached, Polynomial::new(&[most]));
            }
            add(start + reached, to, cubic.shifted(reached));
            most = value;
        }
        if places.list().len() < 2 {
            add(*start, *end, Polynomial::new(&[most]));
        }
    }
    let end = f.pieces.last().map_or(0.0, |([_, end], _)| *end);
    add(end, f64::INFINITY, Polynomial::new(&[most]));
    out
}

/// Where an increasing stretch of a cubic reaches a level.
fn crossing(cubic: &Polynomial, level: f64, ends: &[f64]) -> f64 {
    let above = cubic.plus(&Polynomial::new(&[level]), -1.0);
    let (mut a, mut b) = (ends[0], ends[1]);
    for _ in 0..100 {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            break;
        }
        if above.at(middle) < 0.0 { a = middle } else { b = middle }
    }
    b
}

/// The sum of two functions where both are defined; `None` where they nowhere are.
pub(crate) fn sum_of(f: &PiecewiseFunction, g: &PiecewiseFunction) -> Option<PiecewiseFunction> {
    let mut out = PiecewiseFunction::default();
    for ([a, b], first) in &f.pieces {
        for ([c, d], second) in g.pieces.iter().filter(|([c, d], _)| *c <= *b && *d >= *a) {
            let (from, to) = (a.max(*c), b.min(*d));
            // Pieces that only touch give their common limit, which counts where one of them has no length.
            if from > to || (from == to && a != b && c != d) {
                continue;
            }
            let second = if c.is_finite() { second.shifted(from - c) } else { *second };
            out.pieces.push(([from, to], first.shifted(from - a).plus(&second, 1.0)));
        }
    }
    out.pieces.sort_by(|x, y| x.0[0].total_cmp(&y.0[0]));
    (!out.pieces.is_empty()).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The running maximum of a random piecewise cubic against samples.
    #[test]
    fn running_maximum_against_samples() {
        let mut random = fastrand::Rng::with_seed(11);
        for _ in 0..50 {
            let mut f = PiecewiseFunction::default();
            for k in 0..6 {
                let c: [f64; 4] = std::array::from_fn(|_| 2.0 * random.f64() - 1.0);
                f.pieces.push(([f64::from(k), f64::from(k + 1)], Polynomial::new(&c)));
            }
            let running = running_maximum(&f, 0.5);
            for k in 0..600 {
                let p = f64::from(k) / 100.0 + 0.003;
                let known = f.largest(p).expect("p is within f").1;
                let at = running.pieces.iter().find(|([a, b], _)| *a <= p + 0.5 && p + 0.5 <= *b);
                let ([a, _], cubic) = at.expect("q is within the maximum");
                assert!((cubic.at(p + 0.5 - a) - known).abs() < 1e-13, "at {p}");
            }
        }
    }
}
