//! Nodes of collocation on [0, 1]: the abscissae and the integrals of the Lagrange polynomials.

use crate::Method;
use crate::numerics::propagator::POWERS;

/// Coefficients of a collocation method with s nodes.
pub(crate) struct Nodes {
    /// Abscissae of the nodes, followed by 1 for the end of the step.
    pub c: Vec<f64>,
    /// Coefficients of the Lagrange polynomials by powers, s x s, row-major.
    pub lagrange: Vec<f64>,
    /// Matrix A and, as the last row, the weights b: integrals of the Lagrange polynomials to every node and to the
    /// end, (s + 1) x s, row-major.
    pub a: Vec<f64>,
    /// Product A A and, as the last row, b A; row-major.
    pub a2: Vec<f64>,
    /// A^-1, s x s: derivatives at the nodes from the differences of the values at the nodes and the value at 0.
    pub rate: Vec<f64>,
    /// Weights of the extrapolation to the last node from 0 and all other nodes.
    pub ahead: Vec<f64>,
    /// Places in the middle between two nodes, and the weights of the interpolation there from the nodes.
    pub middles: Vec<(f64, Vec<f64>)>,
}

impl Nodes {
    /// Abscissae of Radau IIA with three nodes, (4 -+ sqrt(6))/10 and 1.
    pub const RADAU_3: [f64; 3] = [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];
    /// Abscissae of Radau IIA with five nodes, the roots of the fourth derivative of x^4 (x - 1)^5.
    pub const RADAU_5: [f64; 5] = [
        0.057_104_196_114_517_68,
        0.276_843_013_638_123_8,
        0.583_590_432_368_916_8,
        0.860_240_135_656_219_4,
        1.0,
    ];

    /// The nodes of `method`; `None` if it is not a collocation method. Radau has five nodes and the order 9, but three
    /// and the order 5 where dampers act between wheels and rails (`has_memory`): a penetration under such a damper
    /// follows its force in a small part of a step, and its error does not decrease with the number of nodes.
    ///
    /// # Source
    /// Hairer, Wanner, Solving Ordinary Differential Equations II (1996), section IV.5.
    pub fn new(method: Method, has_memory: bool) -> Option<Nodes> {
        let fifteen = 15.0_f64.sqrt();
        let c = match method {
            Method::Auto | Method::Sdirk4 | Method::Esdirk5 | Method::Series => return None,
            Method::Radau if has_memory => Self::RADAU_3.to_vec(),
            Method::Radau => Self::RADAU_5.to_vec(),
            Method::Gauss2 => vec![0.5 - 3.0_f64.sqrt() / 6.0, 0.5 + 3.0_f64.sqrt() / 6.0],
            Method::Gauss3 => vec![0.5 - fifteen / 10.0, 0.5, 0.5 + fifteen / 10.0],
        };
        let s = c.len();
        let lagrange: Vec<f64> = (0..s).flat_map(|j| polynomial(&c, j)).collect();
        let ends: Vec<f64> = c.iter().copied().chain([1.0]).collect();
        let mut a = vec![0.0; (s + 1) * s];
        for (i, &end) in ends.iter().enumerate() {
            for j in 0..s {
                let terms =
                    (0..s).map(|k| lagrange[j * s + k] * end.powi(k as i32 + 1) / (k + 1) as f64);
                a[i * s + j] = terms.sum();
            }
        }
        let mut a2 = vec![0.0; (s + 1) * s];
        for i in 0..=s {
            for j in 0..s {
                a2[i * s + j] = (0..s).map(|k| a[i * s + k] * a[k * s + j]).sum();
            }
        }
        // Derivatives at the nodes of the polynomial of degree s through the values at 0 and at the nodes.
        let with_start: Vec<f64> = [0.0].into_iter().chain(c.iter().copied()).collect();
        let mut rate = vec![0.0; s * s];
        for j in 0..s {
            let poly = polynomial(&with_start, j + 1);
            for i in 0..s {
                rate[i * s + j] = (1..=s)
                    .map(|k| k as f64 * poly[k] * c[i].powi(k as i32 - 1))
                    .sum();
            }
        }
        let ahead = (0..s)
            .map(|j| {
                let poly = polynomial(&with_start[..s], j);
                (0..s).map(|k| poly[k] * c[s - 1].powi(k as i32)).sum()
            })
            .collect();
        let mut nodes = Nodes {
            c: ends,
            lagrange,
            a,
            a2,
            rate,
            ahead,
            middles: Vec::new(),
        };
        let middle = |pair: &[f64]| 0.5 * (pair[0] + pair[1]);
        let weights = |share: f64| (0..s).map(|b| nodes.value(b, share)).collect();
        nodes.middles = c
            .windows(2)
            .map(middle)
            .map(|share| (share, weights(share)))
            .collect();
        Some(nodes)
    }

    /// Response to the Lagrange polynomial of node `b`, from the responses `powers` to the powers of time; `part` is
    /// 0 for displacement and 1 for speed.
    pub fn load(&self, b: usize, powers: &[[f64; 2]; POWERS], part: usize) -> f64 {
        let s = self.count();
        (0..s)
            .map(|k| self.lagrange[b * s + k] * powers[k][part])
            .sum()
    }

    /// Value of the Lagrange polynomial of node `b` at the fraction `share` of the step.
    pub fn value(&self, b: usize, share: f64) -> f64 {
        let s = self.count();
        self.lagrange[b * s..(b + 1) * s]
            .iter()
            .rev()
            .fold(0.0, |sum, factor| sum * share + factor)
    }

    /// Displacement, speed and acceleration at the fraction `share` of a step of the length `h` by a unit acceleration
    /// that is the Lagrange polynomial of node `b`.
    pub fn motion(&self, b: usize, share: f64, h: f64) -> [f64; 3] {
        let s = self.count();
        let (mut q, mut v, mut power) = (0.0, 0.0, share);
        for (k, factor) in self.lagrange[b * s..(b + 1) * s].iter().enumerate() {
            let order = k as f64 + 1.0;
            v += factor * power / order;
            power *= share;
            q += factor * power / (order * (order + 1.0));
        }
        [h * h * q, h * v, self.value(b, share)]
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.c.len() - 1
    }
}

/// Coefficients by powers of the polynomial that is 1 at node `j` and 0 at the others.
fn polynomial(nodes: &[f64], j: usize) -> Vec<f64> {
    let mut poly = vec![0.0; nodes.len()];
    poly[0] = 1.0;
    for (degree, (_, node)) in nodes
        .iter()
        .enumerate()
        .filter(|(i, _)| *i != j)
        .enumerate()
    {
        let scale = 1.0 / (nodes[j] - node);
        for k in (0..=degree + 1).rev() {
            let lower = if k > 0 { poly[k - 1] } else { 0.0 };
            poly[k] = scale * (lower - node * poly[k]);
        }
    }
    poly
}
