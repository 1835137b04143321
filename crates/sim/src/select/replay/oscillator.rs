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
    /// Displacement and velocity after a step of this length: by both at its start, by both values of the load, and by both
    /// rates of it.
    step: [[f64; 6]; 2],
    length: f64,
}

impl Oscillator {
    /// A mode at rest with the circular frequency `omega` and the damping ratio `ratio`.
    pub fn new(omega: f64, ratio: f64) -> Self {
        Oscillator {
            omega,
            ratio: ratio.min(MOST_DAMPED),
            ..Oscillator::default()
        }
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

    /// Takes a step of length `h` under a load.
    pub fn advance(&mut self, h: f64, load: LoadAtEnds) {
        if (h - self.length).abs() > 1e-9 * h {
            self.set_step(h);
        }
        let LoadAtEnds {
            value: [a, b],
            rate: [rate, rate_b],
        } = load;
        let [x, v, _] = self.state;
        let [x, v] = self.step.map(|by| {
            by[0] * x + by[1] * v + by[2] * a + by[3] * b + (by[4] * rate + by[5] * rate_b)
        });
        let lag = 2.0 * self.ratio * self.omega;
        self.state = [x, v, b - lag * v - self.omega * self.omega * x];
    }

    /// Coefficients of a step of length `h`, column by column.
    fn set_step(&mut self, h: f64) {
        self.length = h;
        let free = free_oscillation(self.omega, self.ratio, h);
        for k in 0..6 {
            let unit = |at: usize| f64::from(u8::from(at == k));
            let load = LoadAtEnds {
                value: [unit(2), unit(3)],
                rate: [unit(4), unit(5)],
            };
            let [x, v] = self.exact_step(h, free, [unit(0), unit(1)], load);
            (self.step[0][k], self.step[1][k]) = (x, v);
        }
    }

    /// Displacement and velocity after a step of length `h` from a state.
    ///
    /// The solution is a free oscillation about the polynomial p(t) = d_0 + d_1 t + d_2 t^2 + d_3 t^3 that fulfils the
    /// equation for the load c_0 + c_1 t + c_2 t^2 + c_3 t^3:
    /// omega^2 d_k = c_k - 2 zeta omega (k + 1) d_(k+1) - (k + 1)(k + 2) d_(k+2).
    fn exact_step(
        &self,
        h: f64,
        free: [[f64; 2]; 2],
        [x, v]: [f64; 2],
        load: LoadAtEnds,
    ) -> [f64; 2] {
        let LoadAtEnds {
            value: [a, b],
            rate: [rate, rate_b],
        } = load;
        let [_, _, c2, c3] = cubic([a, b], [h * rate, h * rate_b]);
        let (c2, c3) = (c2 / (h * h), c3 / (h * h * h));
        let (by, lag) = (self.flexibility(), 2.0 * self.ratio * self.omega);
        let d3 = by * c3;
        let d2 = by * (c2 - 3.0 * lag * d3);
        let d1 = by * (rate - 2.0 * lag * d2 - 6.0 * d3);
        let d0 = by * (a - lag * d1 - 2.0 * d2);
        let after = [
            d0 + h * (d1 + h * (d2 + h * d3)),
            d1 + h * (2.0 * d2 + 3.0 * h * d3),
        ];
        let apart = [x - d0, v - d1];
        [0, 1].map(|k| free[k][0] * apart[0] + free[k][1] * apart[1] + after[k])
    }
}

/// Displacement and velocity of a free oscillation after the time `h`, each by those at its start.
fn free_oscillation(omega: f64, ratio: f64, h: f64) -> [[f64; 2]; 2] {
    let free = omega * (1.0 - ratio * ratio).sqrt();
    let (sin, cos) = (free * h).sin_cos();
    let decay = (-ratio * omega * h).exp();
    let slow = ratio * omega / free;
    [
        [decay * (cos + slow * sin), decay * sin / free],
        [
            -decay * omega * omega / free * sin,
            decay * (cos - slow * sin),
        ],
    ]
}

#[cfg(test)]
mod tests;
