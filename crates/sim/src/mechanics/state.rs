//! The state of a scene at one time, and the interpolation polynomial between two states.

use nalgebra::DVector;

/// Degrees of freedom, their rates, penetrations and forces at one time.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub t: f64,
    pub q: DVector<f64>,
    pub v: DVector<f64>,
    pub a: DVector<f64>,
    /// Penetration of each vertical contact, negative where it is open, followed by the displacements of massless
    /// rails along x (see `contact::tangential`).
    pub p: Vec<f64>,
    /// Rate of penetration, where a damper between wheel and rail makes the penetration a state, followed by the
    /// rates of the massless rails.
    pub p_rate: Vec<f64>,
    /// Force of each contact component.
    pub force: Vec<f64>,
    /// Whether the state is an interpolant. Its penetration rates are then as accurate as its positions, but for
    /// stiff wheels its penetrations are not.
    pub is_between: bool,
}

impl State {
    /// A state in which all values are zero.
    pub fn zeros(freedoms: usize, penetrations: usize, components: usize) -> Self {
        State {
            t: 0.0,
            q: DVector::zeros(freedoms),
            v: DVector::zeros(freedoms),
            a: DVector::zeros(freedoms),
            p: vec![0.0; penetrations],
            p_rate: vec![0.0; penetrations],
            force: vec![0.0; components],
            is_between: false,
        }
    }

    pub fn copy_from(&mut self, other: &State) {
        self.t = other.t;
        for (to, from) in [
            (&mut self.q, &other.q),
            (&mut self.v, &other.v),
            (&mut self.a, &other.a),
        ] {
            to.as_mut_slice().copy_from_slice(from.as_slice());
        }
        self.p.copy_from_slice(&other.p);
        self.p_rate.copy_from_slice(&other.p_rate);
        self.force.copy_from_slice(&other.force);
        self.is_between = other.is_between;
    }

    /// Sets this state to the interpolant between `from` and `to` at the fraction `s` of the step. q and v follow the
    /// quintic Hermite polynomial through q, v and a at both ends, and the penetrations follow the cubic Hermite
    /// polynomial through their values and rates. Accelerations and forces are interpolated linearly; the forces
    /// serve as a first guess.
    pub fn interpolate(&mut self, from: &State, to: &State, s: f64) {
        let h = to.t - from.t;
        self.is_between = true;
        self.t = from.t + s * h;
        let (s2, s3, s4) = (s * s, s * s * s, s * s * s * s);
        let s5 = s4 * s;
        let w0 = 1.0 - 10.0 * s3 + 15.0 * s4 - 6.0 * s5;
        let w1 = s - 6.0 * s3 + 8.0 * s4 - 3.0 * s5;
        let w2 = 0.5 * (s2 - 3.0 * s3 + 3.0 * s4 - s5);
        let w3 = 0.5 * (s3 - 2.0 * s4 + s5);
        let w4 = -4.0 * s3 + 7.0 * s4 - 3.0 * s5;
        let d0 = -30.0 * s2 + 60.0 * s3 - 30.0 * s4;
        let d1 = 1.0 - 18.0 * s2 + 32.0 * s3 - 15.0 * s4;
        let d2 = 0.5 * (2.0 * s - 9.0 * s2 + 12.0 * s3 - 5.0 * s4);
        let d3 = 0.5 * (3.0 * s2 - 8.0 * s3 + 5.0 * s4);
        let d4 = -12.0 * s2 + 28.0 * s3 - 15.0 * s4;
        for i in 0..self.q.len() {
            let dq = to.q[i] - from.q[i];
            let (v0, v1, a0, a1) = (
                h * from.v[i],
                h * to.v[i],
                h * h * from.a[i],
                h * h * to.a[i],
            );
            self.q[i] = from.q[i] + (1.0 - w0) * dq + w1 * v0 + w2 * a0 + w3 * a1 + w4 * v1;
            self.v[i] = (-d0 * dq + d1 * v0 + d2 * a0 + d3 * a1 + d4 * v1) / h;
            self.a[i] = from.a[i] + s * (to.a[i] - from.a[i]);
        }
        for i in 0..self.p.len() {
            let dp = to.p[i] - from.p[i];
            let (r0, r1) = (h * from.p_rate[i], h * to.p_rate[i]);
            self.p[i] =
                from.p[i] + (3.0 * s2 - 2.0 * s3) * dp + (s - 2.0 * s2 + s3) * r0 + (s3 - s2) * r1;
            self.p_rate[i] = ((6.0 * s - 6.0 * s2) * dp
                + (1.0 - 4.0 * s + 3.0 * s2) * r0
                + (3.0 * s2 - 2.0 * s) * r1)
                / h;
        }
        for (force, (a, b)) in self.force.iter_mut().zip(from.force.iter().zip(&to.force)) {
            *force = a + s * (b - a);
        }
    }

    /// Sets q to the Bernstein coefficient `k`, 0 to 5, of the polynomial of degree five through q, v and a at both
    /// ends, by which [`interpolate`](State::interpolate) finds q.
    pub fn set_coefficient(&mut self, from: &State, to: &State, k: usize) {
        let h = to.t - from.t;
        let (at, s) = if k < 3 {
            (from, k as f64 / 5.0 * h)
        } else {
            (to, (k as f64 - 5.0) / 5.0 * h)
        };
        // The second derivative is 20 (c0 - 2 c1 + c2) / h^2.
        let bend = if k == 2 || k == 3 { h * h / 20.0 } else { 0.0 };
        self.q.copy_from(&at.q);
        self.q.axpy(s, &at.v, 1.0);
        self.q.axpy(bend, &at.a, 1.0);
    }
}

/// Constant terms of a stage: Q = `q` + (h gamma) V and V = `v` + (h gamma) A; the penetrations are treated in the
/// same way.
pub(crate) struct Known {
    pub q: DVector<f64>,
    pub v: DVector<f64>,
    pub p: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::State;

    #[test]
    fn interpolant_reproduces_a_quintic_and_its_rate() {
        let poly = |t: f64| {
            1.0 - t + 2.0 * t.powi(2) - 0.5 * t.powi(3) + 0.3 * t.powi(4) - 0.1 * t.powi(5)
        };
        let rate = |t: f64| -1.0 + 4.0 * t - 1.5 * t.powi(2) + 1.2 * t.powi(3) - 0.5 * t.powi(4);
        let curve = |t: f64| 4.0 - 3.0 * t + 3.6 * t.powi(2) - 2.0 * t.powi(3);
        let at = |t: f64| {
            let mut state = State::zeros(1, 0, 0);
            (state.t, state.q[0], state.v[0], state.a[0]) = (t, poly(t), rate(t), curve(t));
            state
        };
        let (from, to, mut middle) = (at(0.5), at(2.0), at(0.0));
        middle.interpolate(&from, &to, 0.3);
        assert!((middle.q[0] - poly(0.95)).abs() < 1e-13);
        assert!((middle.v[0] - rate(0.95)).abs() < 1e-13);
    }

    #[test]
    fn coefficients_are_those_of_a_quintic() {
        // At t = h s, s^n has the Bernstein coefficients binomial(k, n) / binomial(5, n).
        let (h, factors) = (2.0_f64, [1.0, -1.0, 2.0, -0.5, 0.3, -0.1]);
        let derivative = |t: f64, order: i32| {
            let falling = |n: i32| (0..order).map(|i| f64::from(n - i)).product::<f64>();
            (order..6)
                .map(|n| factors[n as usize] * falling(n) * t.powi(n - order))
                .sum::<f64>()
        };
        let at = |t: f64| {
            let mut state = State::zeros(1, 0, 0);
            state.t = t;
            (state.q[0], state.v[0], state.a[0]) =
                (derivative(t, 0), derivative(t, 1), derivative(t, 2));
            state
        };
        let (from, to, mut found) = (at(0.0), at(h), at(0.0));
        let binomial = |n: usize, k: usize| {
            (0..k)
                .map(|i| (n as f64 - i as f64) / (i as f64 + 1.0))
                .product::<f64>()
        };
        for k in 0..6 {
            let power = |n: usize| factors[n] * h.powi(n as i32) * binomial(k, n) / binomial(5, n);
            found.set_coefficient(&from, &to, k);
            assert!(
                (found.q[0] - (0..6).map(power).sum::<f64>()).abs() < 1e-13,
                "{k}"
            );
        }
    }
}
