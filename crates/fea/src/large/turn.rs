//! Finite rotations by rotation vectors, for numbers that carry their derivatives.

use num_dual::DualNum;

/// A vector of numbers with derivatives.
pub(super) type Vec3<D> = [D; 3];

/// Terms of the series of sin(t)/t and (1 - cos t)/t^2 in t^2: exact to rounding up to t = pi.
const TERMS: usize = 14;

/// R(t) v, the vector v turned by the rotation vector t:
///
/// R v = v + a t x v + b t x (t x v),    a = sin|t|/|t|,    b = (1 - cos|t|)/|t|^2
///
/// Both factors are power series in |t|^2, which are smooth at t = 0.
///
/// # Source
/// Rodrigues' formula; Crisfield, Non-linear Finite Element Analysis of Solids and Structures 2 (1997), section 16.2.
pub(super) struct Turn<D> {
    vector: Vec3<D>,
    /// a, b and their derivatives by |t|^2.
    factors: [[D; 2]; 2],
    /// R - 1, by rows.
    change: [Vec3<D>; 3],
}

impl<D: DualNum<Primitive = f64> + Copy> Turn<D> {
    pub fn new(vector: Vec3<D>) -> Turn<D> {
        let squares = vector.map(|t| t * t);
        let square = squares[0] + squares[1] + squares[2];
        let factors = [series(square, 1.0), series(square, 2.0)];
        let [a, b] = factors.map(|own| own[0]);
        let [x, y, z] = vector.map(|t| t * a);
        let [bx, by, bz] = vector.map(|t| t * b);
        let [xy, yz, zx] = [bx * vector[1], by * vector[2], bz * vector[0]];
        let less = |i: usize, j: usize| -((squares[i] + squares[j]) * b);
        Turn {
            vector,
            factors,
            change: [
                [less(1, 2), xy - z, zx + y],
                [xy + z, less(0, 2), yz - x],
                [zx - y, yz + x, less(0, 1)],
            ],
        }
    }

    pub fn of(&self, v: [f64; 3]) -> Vec3<D> {
        let change = self.change(v);
        std::array::from_fn(|k| change[k] + v[k])
    }

    /// Gradient by t of the sum over all pairs of g . R v, with g as it is:
    ///
    /// a v x g + 2 a' (t . v x g) t + b (g (v . t) + v (g . t) - 2 (g . v) t) + 2 b' ((g . t)(v . t) - |t|^2 g . v) t
    pub fn gradient(&self, pairs: &[(Vec3<D>, [f64; 3])]) -> Vec3<D> {
        let t = self.vector;
        let [[a, by_a], [b, by_b]] = self.factors;
        let square = dot(t, t);
        let mut out = [D::zero(); 3];
        for (g, v) in pairs {
            let turned = cross(constant(*v), *g);
            let (v_t, g_t, g_v) = (along(t, *v), dot(*g, t), along(*g, *v));
            let by_square =
                (by_a * dot(t, turned) + by_b * (g_t * v_t - square * g_v) - b * g_v) * 2.0;
            for k in 0..3 {
                out[k] += a * turned[k] + b * (g[k] * v_t + g_t * v[k]) + by_square * t[k];
            }
        }
        out
    }

    /// R v - v.
    pub fn change(&self, v: [f64; 3]) -> Vec3<D> {
        self.change.map(|row| along(row, v))
    }
}

/// f(s) = sum over k of (-s)^k/(2 k + n)!, sin(t)/t for n = 1 and (1 - cos t)/t^2 for n = 2, with s = t^2, and its derivative,
/// for numbers that carry first derivatives: f and two derivatives at the value of s by Horner's rule, and the lines along them
/// for what s carries beside its value.
fn series<D: DualNum<Primitive = f64> + Copy>(s: D, n: f64) -> [D; 2] {
    let mut coefficients = [1.0 / n; TERMS];
    for k in 1..TERMS {
        let last = 2.0 * k as f64 + n;
        coefficients[k] = -coefficients[k - 1] / (last * (last - 1.0));
    }
    let at = s.re();
    let [mut value, mut first, mut second] = [0.0; 3];
    for c in coefficients.into_iter().rev() {
        second = second * at + 2.0 * first;
        first = first * at + value;
        value = value * at + c;
    }
    let beside = s - at;
    [beside * first + value, beside * second + first]
}

pub(super) fn constant<D: DualNum<Primitive = f64> + Copy>(v: [f64; 3]) -> Vec3<D> {
    v.map(D::from)
}

/// Product of `v` with a vector that is constant.
pub(super) fn along<D: DualNum<Primitive = f64> + Copy>(v: Vec3<D>, constant: [f64; 3]) -> D {
    v[0] * constant[0] + v[1] * constant[1] + v[2] * constant[2]
}

pub(super) fn dot<D: DualNum<Primitive = f64> + Copy>(a: Vec3<D>, b: Vec3<D>) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross<D: DualNum<Primitive = f64> + Copy>(a: Vec3<D>, b: Vec3<D>) -> Vec3<D> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(super) fn sum<D: DualNum<Primitive = f64> + Copy>(a: Vec3<D>, b: Vec3<D>) -> Vec3<D> {
    std::array::from_fn(|k| a[k] + b[k])
}

pub(super) fn difference<D: DualNum<Primitive = f64> + Copy>(a: Vec3<D>, b: Vec3<D>) -> Vec3<D> {
    std::array::from_fn(|k| a[k] - b[k])
}

pub(super) fn scaled<D: DualNum<Primitive = f64> + Copy>(a: Vec3<D>, factor: D) -> Vec3<D> {
    a.map(|a| a * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Analytic: a turn by t about z maps x to (cos t, sin t, 0), up to a half turn.
    #[test]
    fn a_turn_about_an_axis_is_that_of_sine_and_cosine() {
        for t in [0.0, 1e-9, 0.3, 1.7, 3.1] {
            let found = Turn::new([0.0, 0.0, t]).of([1.0, 0.0, 0.0]);
            let known = [f64::cos(t), f64::sin(t), 0.0];
            assert!(
                (0..3).all(|k| (found[k] - known[k]).abs() < 1e-14),
                "{t}: {found:?}"
            );
        }
    }
}
