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
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}

/// Weights of the derivative of the polynomial of the seventh degree through the values, per unit of the step, and the rates at
/// the places: with the Lagrange polynomials l_j of the places x_j it is the sum over j of
///
/// (1 - 2 l_j'(x_j) (x - x_j)) l_j^2 value_j + (x - x_j) l_j^2 rate_j.
pub struct SpringSlopes {
    by_value: [f64; COUNT],
    by_rate: [f64; COUNT],
}

impl SpringSlopes {
    /// Those at the fraction `share` of the step, where the Lagrange polynomials have these `slopes`.
    pub fn new(share: f64, slopes: &[f64; COUNT]) -> SpringSlopes {
        let away = PLACES.map(|place| share - place);
        let parts: [[f64; 2]; COUNT] = std::array::from_fn(|j| {
            let own = weights()[j][j];
            let value = OTHERS[j].iter().fold(SCALE[j], |product, other| product * away[*other]);
            let square_slope = 2.0 * value * slopes[j];
            [
                (1.0 - 2.0 * own * away[j]) * square_slope - 2.0 * own * value * value,
                away[j] * square_slope + value * value,
            ]
        });
        SpringSlopes { by_value: parts.map(|part| part[0]), by_rate: parts.map(|part| part[1]) }
    }

    /// Rate of the spring of contact `r` in a step of length `h`.
    pub fn rate(&self, followed: &[Followed; COUNT], r: usize, h: f64) -> f64 {
        let by_value = followed.iter().zip(self.by_value).map(|(node, weight)| weight * node.value[r]);
        let by_rate = followed.iter().zip(self.by_rate).map(|(node, weight)| weight * node.rate[r]);
        by_value.sum::<f64>() / h + by_rate.sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Identity: the derivative of a polynomial of the seventh degree from its values and derivatives at the places.
    #[test]
    fn rates_of_springs_between_the_places_are_those_of_their_polynomial() {
        let (value, rate) =
            (|x: f64| x.powi(7) - 2.0 * x.powi(4) + x, |x: f64| 7.0 * x.powi(6) - 8.0 * x.powi(3) + 1.0);
        let h = 0.25;
        let followed = PLACES.map(|place| {
            let mut node = Followed::default();
            (node.value, node.rate) = (vec![value(place)], vec![rate(place) / h]);
            node
        });
        for share in [0.0, 0.1, 0.4, PLACES[2], 0.9, 1.0] {
            let found = SpringSlopes::new(share, &slopes(share)).rate(&followed, 0, h);
            assert!((found - rate(share) / h).abs() < 1e-12 / h, "{share}: {found}");
        }
    }
}
