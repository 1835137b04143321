//! One natural mode under a load that is a cubic polynomial of time.

use crate::numerics::cubic::cubic;

/// Largest damping ratio that is distinguished from others; the formulas are those of an oscillation.
const MOST_DAMPED: f64 = 0.999;

/// A load and its rate at both ends of a step, between which it is the cubic polynomial with these values.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoadAtEnds {
    pub value: [f64; 2],
    pub rate: [f64; 2],
}

/// q'' + 2 zeta omega q' + omega^2 q = Q, and the coefficients of its last step.
#[derive(Clone, Default)]
pub(super) struct Oscillator {
    pub omega: f64,
    ratio: f64,
    /// Displacement, velocity and acceleration.
    pub state: [f64; 3],
    /// Values of the free oscillation after a step of this length: by displacement and velocity at its start.
    step: [[f64; 2]; 2],
    length: f64,
}

impl Oscillator {
    /// A mode at rest with the circular frequency `omega` and the damping ratio `ratio`.
    pub fn new(omega: f64, ratio: f64) -> Self {
        Oscillator { omega, ratio: ratio.min(MOST_DAMPED), ..Oscillator::default() }
    }

    /// 1/omega^2, its displacement under a static unit load.
    pub fn flexibility(&self) -> f64 {
        (self.omega * self.omega).recip()
    }

    /// Starts at rest in the static deflection under `load`.
    pub fn begin(&mut self, load: f64) {
        self.state = [load * self.flexibility(), 0.0, 0.0];
    }

    /// Takes an impulse.
    pub fn push(&mut self, impulse: f64) {
        self.state[1] += impulse;
    }

    /// Coefficients of a step of length `h`.
    fn set_step(&mut self, h: f64) {
        self.length = h;
        let (omega, ratio) = (self.omega, self.ratio);
        let free = omega * (1.0 - ratio * ratio).sqrt();
        let (sin, cos) = (free * h).sin_cos();
        let decay = (-ratio * omega * h).exp();
        let slow = ratio * omega / free;
        self.step = [
            [decay * (cos + slow * sin), decay * sin / free],
            [-decay * omega * omega / free * sin, decay * (cos - slow * sin)],
        ];
    }

    /// Takes a step of length `h` under a load.
    ///
    /// The solution is a free oscillation about the polynomial p(t) = d_0 + d_1 t + d_2 t^2 + d_3 t^3 that fulfils the
    /// equation for the load c_0 + c_1 t + c_2 t^2 + c_3 t^3:
    /// omega^2 d_k = c_k - 2 zeta omega (k + 1) d_(k+1) - (k + 1)(k + 2) d_(k+2).
    pub fn advance(&mut self, h: f64, load: LoadAtEnds) {
        if (h - self.length).abs() > 1e-9 * h {
            self.set_step(h);
        }
        let LoadAtEnds { value: [a, b], rate: [rate, rate_b] } = load;
        let [_, _, c2, c3] = cubic([a, b], [h * rate, h * rate_b]);
        let (c2, c3) = (c2 / (h * h), c3 / (h * h * h));
        let (by, lag) = (self.flexibility(), 2.0 * self.ratio * self.omega);
        let d3 = by * c3;
        let d2 = by * (c2 - 3.0 * lag * d3);
        let d1 = by * (rate - 2.0 * lag * d2 - 6.0 * d3);
        let d0 = by * (a - lag * d1 - 2.0 * d2);
        let (x, v) = (self.state[0] - d0, self.state[1] - d1);
        let [of_x, of_v] = self.step;
        let x = of_x[0] * x + of_x[1] * v + (d0 + h * (d1 + h * (d2 + h * d3)));
        let v = of_v[0] * (self.state[0] - d0) + of_v[1] * v + (d1 + h * (2.0 * d2 + 3.0 * h * d3));
        self.state = [x, v, b - lag * v - self.omega * self.omega * x];
    }
}

#[cfg(test)]
mod tests;
