//! The places of a step at which penetrations are known, and slopes of polynomials through their values there.

use std::sync::LazyLock;

use crate::contact::solver::follow::Followed;
use crate::time::nodes::Nodes;

/// Number of places.
pub const COUNT: usize = 4;

/// The start and the nodes.
pub const PLACES: [f64; COUNT] = [0.0, Nodes::RADAU_3[0], Nodes::RADAU_3[1], Nodes::RADAU_3[2]];

/// The other places of each.
const OTHERS: [[usize; 3]; COUNT] = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];

/// Reciprocal of the product of the distances of each place from the others.
const SCALE: [f64; COUNT] = {
    let mut scale = [1.0; COUNT];
    let mut j = 0;
    while j < COUNT {
        let [a, b, c] = OTHERS[j];
        scale[j] /= (PLACES[j] - PLACES[a]) * (PLACES[j] - PLACES[b]) * (PLACES[j] - PLACES[c]);
        j += 1;
    }
    scale
};

/// Derivatives at `share` of the cubic Lagrange polynomials through the places.
pub fn slopes(share: f64) -> [f64; COUNT] {
    let away = PLACES.map(|place| share - place);
    std::array::from_fn(|j| {
        let [a, b, c] = OTHERS[j].map(|other| away[other]);
        SCALE[j] * (a * b + a * c + b * c)
    })
}

/// [`slopes`] at each of the places.
pub fn weights() -> &'static [[f64; COUNT]; COUNT] {
    static WEIGHTS: LazyLock<[[f64; COUNT]; COUNT]> = LazyLock::new(|| PLACES.map(slopes));
    &WEIGHTS
}

/// Sum of the values at the places, each times its weight.
#[inline]
pub fn sum_of(weights: &[f64; COUNT], values: &[f64; COUNT]) -> f64 {
    weights
        .iter()
        .zip(values)
        .map(|(weight, value)| weight * value)
        .sum()
}

/// Values at `share` of the cubic Lagrange polynomials through the places.
pub fn values(share: f64) -> [f64; COUNT] {
    let away = PLACES.map(|place| share - place);
    std::array::from_fn(|j| {
        OTHERS[j]
            .iter()
            .fold(SCALE[j], |product, other| product * away[*other])
    })
}

/// Weights of the polynomial of the seventh degree through the values, and the rates at the places, and of its derivative per
/// unit of the step: with the Lagrange polynomials l_j of the places x_j it is the sum over j of
///
/// (1 - 2 l_j'(x_j) (x - x_j)) l_j^2 value_j + (x - x_j) l_j^2 rate_j.
pub struct SpringPolynomial {
    /// By values and by rates.
    value: [[f64; COUNT]; 2],
    slope: [[f64; COUNT]; 2],
}

impl SpringPolynomial {
    /// The weights at the fraction `share` of the step, where the Lagrange polynomials have these `values` and `slopes`.
    pub fn new(share: f64, values: &[f64; COUNT], slopes: &[f64; COUNT]) -> SpringPolynomial {
        let mut made = SpringPolynomial {
            value: [[0.0; COUNT]; 2],
            slope: [[0.0; COUNT]; 2],
        };
        for j in 0..COUNT {
            let (away, own, value) = (share - PLACES[j], weights()[j][j], values[j]);
            let (square, square_slope) = (value * value, 2.0 * value * slopes[j]);
            let by_value = 1.0 - 2.0 * own * away;
            (made.value[0][j], made.value[1][j]) = (by_value * square, away * square);
            made.slope[0][j] = by_value * square_slope - 2.0 * own * square;
            made.slope[1][j] = away * square_slope + square;
        }
        made
    }

    /// Penetration of the spring of contact `r` and its rate in a step of length `h`.
    pub fn at(&self, followed: &[Followed; COUNT], r: usize, h: f64) -> [f64; 2] {
        let sum = |[by_value, by_rate]: &[[f64; COUNT]; 2]| {
            let of_values = followed
                .iter()
                .zip(by_value)
                .map(|(node, weight)| weight * node.value[r]);
            let of_rates = followed
                .iter()
                .zip(by_rate)
                .map(|(node, weight)| weight * node.rate[r]);
            [of_values.sum::<f64>(), of_rates.sum::<f64>()]
        };
        let ([by_values, by_rates], [slope_by_values, slope_by_rates]) =
            (sum(&self.value), sum(&self.slope));
        [
            by_values + h * by_rates,
            slope_by_values / h + slope_by_rates,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Identity: a polynomial of the seventh degree, and its derivative, from its values and derivatives at the places.
    #[test]
    fn springs_between_the_places_follow_their_polynomial() {
        let (value, rate) = (
            |x: f64| x.powi(7) - 2.0 * x.powi(4) + x,
            |x: f64| 7.0 * x.powi(6) - 8.0 * x.powi(3) + 1.0,
        );
        let h = 0.25;
        let followed = PLACES.map(|place| {
            let mut node = Followed::default();
            (node.value, node.rate) = (vec![value(place)], vec![rate(place) / h]);
            node
        });
        for share in [0.0, 0.1, 0.4, PLACES[2], 0.9, 1.0] {
            let polynomial = SpringPolynomial::new(share, &values(share), &slopes(share));
            let [found, found_rate] = polynomial.at(&followed, 0, h);
            assert!((found - value(share)).abs() < 1e-13, "{share}: {found}");
            assert!(
                (found_rate - rate(share) / h).abs() < 1e-12 / h,
                "{share}: {found_rate}"
            );
        }
    }
}
