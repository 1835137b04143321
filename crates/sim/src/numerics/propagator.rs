//! Exact response of a natural mode to its initial state and to a load that is a polynomial of time.

use nalgebra::Complex;

/// Number of powers of time of a load, 0 to 4.
pub(crate) const POWERS: usize = 5;

/// Square of a term of the series of phi_5, which is about 1/120, below which the rest of the series is rounding.
const NEGLIGIBLE: f64 = 1e-38;

/// k! for k = 0 to 5.
const FACTORIALS: [f64; POWERS + 1] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0];

/// phi_k(z), k = 1 to 5: phi_1 = (e^z - 1)/z, phi_(k+1) = (phi_k - 1/k!)/z. Where |z| < 2 this loses digits: there phi_5
/// is a power series, and phi_k = z phi_(k+1) + 1/k! downwards.
///
/// # Source
/// Hochbruck, Ostermann, Exponential integrators, Acta Numerica 19 (2010), section 2.
fn phi(z: Complex<f64>) -> [Complex<f64>; POWERS] {
    let mut out = [Complex::new(0.0, 0.0); POWERS];
    if z.norm() < 2.0 {
        let mut term = Complex::new(FACTORIALS[POWERS].recip(), 0.0);
        let mut n = POWERS as f64;
        while term.norm_sqr() > NEGLIGIBLE {
            out[POWERS - 1] += term;
            n += 1.0;
            term *= z / n;
        }
        for k in (1..POWERS).rev() {
            out[k - 1] = z * out[k] + FACTORIALS[k].recip();
        }
        return out;
    }
    out[0] = (z.exp() - 1.0) / z;
    for k in 1..POWERS {
        out[k] = (out[k - 1] - FACTORIALS[k].recip()) / z;
    }
    out
}

/// A mode q'' + 2 zeta omega q' + omega^2 q = f over a step h, with loads (t/h)^k for k = 0 to 4.
pub(crate) struct Propagator {
    rate: Complex<f64>,
    h: f64,
}

impl Propagator {
    /// Requires `omega` > 0 and 0 <= `zeta` < 1.
    pub fn new(omega: f64, zeta: f64, h: f64) -> Self {
        let damped = omega * ((1.0 - zeta) * (1.0 + zeta)).sqrt();
        Propagator {
            rate: Complex::new(-zeta * omega, damped),
            h,
        }
    }

    /// Response to the initial state at time `c` h: [q per q0, q per v0, v per q0, v per v0].
    pub fn free(&self, c: f64) -> [f64; 4] {
        let (decay, damped) = (self.rate.re, self.rate.im);
        let wave = (self.rate * (c * self.h)).exp();
        let impulse = wave.im / damped;
        [
            wave.re - decay * impulse,
            impulse,
            -self.rate.norm_sqr() * impulse,
            wave.re + decay * impulse,
        ]
    }

    /// Displacement q and speed v at time `c` h under the load (t/h)^k, one pair for each k: q = k! c^(k+1) h
    /// Im(phi_(k+1)) / omega_d.
    pub fn forced(&self, c: f64) -> [[f64; 2]; POWERS] {
        let responses = phi(self.rate * (c * self.h));
        let mut scale = self.h / self.rate.im;
        let mut out = [[0.0; 2]; POWERS];
        for (k, (out, response)) in out.iter_mut().zip(responses).enumerate() {
            scale *= c * if k == 0 { 1.0 } else { k as f64 };
            *out = [scale * response.im, scale * (self.rate * response).im];
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::Propagator;

    /// Analytic: an undamped mode under a constant and a linear load, by the angle omega h.
    #[test]
    fn answers_meet_closed_forms_for_slow_and_fast_modes() {
        for angle in [1e-6, 1e-3, 0.3, 0.999, 1.001, 7.0, 1e2, 1e4, 1e6] {
            let mode = Propagator::new(angle, 0.0, 1.0);
            let [one, linear, ..] = mode.forced(1.0);
            let half = (0.5 * angle).sin();
            let wanted = 2.0 * half * half / (angle * angle);
            assert!(
                (one[0] - wanted).abs() < 1e-13 * (wanted + 1.0 / (angle * angle).max(1.0)),
                "{angle}"
            );
            assert!(
                (one[1] - angle.sin() / angle).abs() < 1e-13 / angle.max(1.0),
                "{angle}"
            );
            // The speed under the linear load equals the displacement under the constant load.
            assert!(
                (linear[1] - one[0]).abs() < 1e-12 / (angle * angle).max(1.0),
                "{angle}"
            );
            let [qq, qv, vq, vv] = mode.free(1.0);
            assert!((qq * vv - qv * vq - 1.0).abs() < 1e-12, "{angle}");
        }
    }

    /// Two half steps, with the powers of the load expanded about the middle, equal one whole step for damped modes.
    #[test]
    fn two_halves_make_a_whole() {
        for angle in [1e-3, 0.5, 3.0, 50.0, 1e3] {
            let (whole, half) = (
                Propagator::new(angle, 0.05, 1.0),
                Propagator::new(angle, 0.05, 0.5),
            );
            let (first, free) = (half.forced(1.0), half.free(1.0));
            // (t/h)^2 over the whole is s^2/4 over the first half, (1 + 2 s + s^2)/4 over the second.
            for row in 0..2 {
                let start = [0.25 * first[2][0], 0.25 * first[2][1]];
                let carried = free[2 * row] * start[0] + free[2 * row + 1] * start[1];
                let added = 0.25 * (first[0][row] + 2.0 * first[1][row] + first[2][row]);
                let wanted = whole.forced(1.0)[2][row];
                let size = if row == 0 { 1.0 } else { angle };
                assert!(
                    (carried + added - wanted).abs() < 1e-12 * size / (1.0 + angle * angle),
                    "{angle} {row}"
                );
            }
        }
    }
}
