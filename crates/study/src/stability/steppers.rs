//! Usual time steppers for one oscillator whose stiffness and damping depend on time, and their monodromy matrices.

use nalgebra::DMatrix;

/// z'' + d(t) z' + s(t) z = 0.
pub struct Oscillator<'a> {
    /// d(t), 1/time.
    pub damping: &'a dyn Fn(f64) -> f64,
    /// s(t), 1/time^2.
    pub stiffness: &'a dyn Fn(f64) -> f64,
}

/// State of a stepper: z, z' and up to two more numbers (an acceleration, or z and z' of the step before).
pub type OscillatorState = [f64; 4];

/// One step of length `h` from time `t`.
pub type StepMethod = fn(&Oscillator<'_>, f64, f64, OscillatorState) -> OscillatorState;

/// Steppers: name, length of the state, function of one step.
pub const STEPPERS: [(&str, usize, StepMethod); 8] = [
    ("semi-implicit Euler", 2, euler),
    ("Runge-Kutta 4", 2, rk4),
    ("Dormand-Prince 5", 2, dp5),
    ("midpoint", 2, midpoint),
    ("trapezoid (Newmark 1/4)", 2, trapezoid),
    ("generalised-alpha 0.8", 3, alpha8),
    ("generalised-alpha 0.5", 3, alpha5),
    ("BDF2", 4, bdf2),
];

impl Oscillator<'_> {
    fn slope(&self, t: f64, [z, v]: [f64; 2]) -> [f64; 2] {
        [v, -(self.damping)(t) * v - (self.stiffness)(t) * z]
    }

    /// Solves y = r + h A(t) y for y, with r = (z, v) and the matrix A of the first-order system.
    fn implicit(&self, t: f64, h: f64, [z, v]: [f64; 2]) -> [f64; 2] {
        let s = (self.stiffness)(t);
        let new = (v - h * s * z) / (1.0 + h * (self.damping)(t) + h * h * s);
        [z + h * new, new]
    }
}

fn euler(of: &Oscillator<'_>, t: f64, h: f64, [z, v, ..]: OscillatorState) -> OscillatorState {
    let v = v + h * of.slope(t, [z, v])[1];
    [z + h * v, v, 0.0, 0.0]
}

/// One step of an explicit Runge-Kutta method by the nodes, rows and weights of its tableau.
fn explicit<const S: usize>(
    of: &Oscillator<'_>,
    t: f64,
    h: f64,
    [z, v, ..]: OscillatorState,
    nodes: [f64; S],
    rows: [&[f64]; S],
    weights: [f64; S],
) -> OscillatorState {
    let mut slopes = [[0.0; 2]; S];
    for (stage, (node, row)) in nodes.iter().zip(rows).enumerate() {
        let mut at = [z, v];
        for (weight, slope) in row.iter().zip(&slopes) {
            at = [at[0] + h * weight * slope[0], at[1] + h * weight * slope[1]];
        }
        slopes[stage] = of.slope(t + node * h, at);
    }
    let sum = |i: usize| {
        weights
            .iter()
            .zip(&slopes)
            .map(|(weight, slope)| weight * slope[i])
            .sum::<f64>()
    };
    [z + h * sum(0), v + h * sum(1), 0.0, 0.0]
}

fn rk4(of: &Oscillator<'_>, t: f64, h: f64, state: OscillatorState) -> OscillatorState {
    let weights = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
    explicit(
        of,
        t,
        h,
        state,
        [0.0, 0.5, 0.5, 1.0],
        [&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]],
        weights,
    )
}

/// One step of the method of order 5 of Dormand and Prince.
///
/// # Source
/// J. R. Dormand, P. J. Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6 (1980), 19-26.
fn dp5(of: &Oscillator<'_>, t: f64, h: f64, state: OscillatorState) -> OscillatorState {
    let rows: [&[f64]; 6] = [
        &[],
        &[1.0 / 5.0],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[
            19372.0 / 6561.0,
            -25360.0 / 2187.0,
            64448.0 / 6561.0,
            -212.0 / 729.0,
        ],
        &[
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18656.0,
        ],
    ];
    let weights = [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ];
    explicit(
        of,
        t,
        h,
        state,
        [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0],
        rows,
        weights,
    )
}

fn midpoint(of: &Oscillator<'_>, t: f64, h: f64, [z, v, ..]: OscillatorState) -> OscillatorState {
    // y1 = 2 m - y0, m = y0 + h/2 A m
    let middle = of.implicit(t + 0.5 * h, 0.5 * h, [z, v]);
    [2.0 * middle[0] - z, 2.0 * middle[1] - v, 0.0, 0.0]
}

fn trapezoid(of: &Oscillator<'_>, t: f64, h: f64, [z, v, ..]: OscillatorState) -> OscillatorState {
    let slope = of.slope(t, [z, v]);
    let [z, v] = of.implicit(
        t + h,
        0.5 * h,
        [z + 0.5 * h * slope[0], v + 0.5 * h * slope[1]],
    );
    [z, v, 0.0, 0.0]
}

/// One step of the generalised-alpha method with the spectral radius `radius` at infinite frequency.
///
/// # Source
/// J. Chung, G. M. Hulbert, A time integration algorithm for structural dynamics with improved numerical dissipation,
/// J. Appl. Mech. 60 (1993), 371-375.
fn alpha(
    of: &Oscillator<'_>,
    t: f64,
    h: f64,
    [z, v, a, _]: OscillatorState,
    radius: f64,
) -> OscillatorState {
    let (am, af) = (
        (2.0 * radius - 1.0) / (radius + 1.0),
        radius / (radius + 1.0),
    );
    let gamma = 0.5 + af - am;
    let beta = 0.25 * (1.0 + af - am) * (1.0 + af - am);
    let [s0, s1] = [(of.stiffness)(t), (of.stiffness)(t + h)];
    let [d0, d1] = [(of.damping)(t), (of.damping)(t + h)];
    let z0 = z + h * v + h * h * (0.5 - beta) * a;
    let v0 = v + h * (1.0 - gamma) * a;
    let load = am * a + (1.0 - af) * (d1 * v0 + s1 * z0) + af * (d0 * v + s0 * z);
    let mass = (1.0 - am) + (1.0 - af) * (d1 * gamma * h + s1 * beta * h * h);
    let new = -load / mass;
    [z0 + beta * h * h * new, v0 + gamma * h * new, new, 0.0]
}

fn alpha8(of: &Oscillator<'_>, t: f64, h: f64, state: OscillatorState) -> OscillatorState {
    alpha(of, t, h, state, 0.8)
}

fn alpha5(of: &Oscillator<'_>, t: f64, h: f64, state: OscillatorState) -> OscillatorState {
    alpha(of, t, h, state, 0.5)
}

fn bdf2(of: &Oscillator<'_>, t: f64, h: f64, [z, v, z0, v0]: OscillatorState) -> OscillatorState {
    let [new, speed] = of.implicit(
        t + h,
        2.0 / 3.0 * h,
        [(4.0 * z - z0) / 3.0, (4.0 * v - v0) / 3.0],
    );
    [new, speed, z, v]
}

/// Spectral radius: the largest absolute value of the eigenvalues; infinite where an entry is not finite.
#[must_use]
pub fn radius(matrix: &DMatrix<f64>) -> f64 {
    if matrix.iter().any(|own| !own.is_finite()) {
        return f64::INFINITY;
    }
    matrix
        .complex_eigenvalues()
        .iter()
        .map(|own| own.norm())
        .fold(0.0, f64::max)
}

/// Spectral radius of the monodromy matrix of `count` equal steps over the time `period`.
///
/// Column j of this `size` x `size` matrix is the state after all steps that start from the unit state j.
#[must_use]
pub fn monodromy(
    of: &Oscillator<'_>,
    step: StepMethod,
    size: usize,
    period: f64,
    count: usize,
) -> f64 {
    let h = period / count as f64;
    let mut out = DMatrix::zeros(size, size);
    for column in 0..size {
        let mut state: OscillatorState = [0.0; 4];
        state[column] = 1.0;
        for i in 0..count {
            state = step(of, i as f64 * h, h, state);
        }
        for row in 0..size {
            out[(row, column)] = state[row];
        }
    }
    radius(&out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error of z after unit time of z'' + (0.2 + 0.3 t) z' + 4 (1 + t) z = 0 by `steps` steps.
    fn error(name: &str, step: StepMethod, steps: u32) -> f64 {
        let stiffness = |t: f64| 4.0 * (1.0 + t);
        let of = Oscillator {
            damping: &|t| 0.2 + 0.3 * t,
            stiffness: &stiffness,
        };
        let run = |name: &str, step: StepMethod, steps: u32| {
            let h = 1.0 / f64::from(steps);
            // a multistep method starts from an earlier exact state or acceleration
            let fine = |until: f64| {
                let count = 4000;
                let h = until / f64::from(count);
                (0..count).fold([1.0, 0.5, 0.0, 0.0], |state, i| {
                    rk4(&of, f64::from(i) * h, h, state)
                })
            };
            if name == "BDF2" {
                let [z, v, ..] = fine(h);
                let start = [z, v, 1.0, 0.5];
                return (1..steps).fold(start, |state, i| step(&of, f64::from(i) * h, h, state))[0];
            }
            let start = [1.0, 0.5, -0.2 * 0.5 - 4.0, 0.0];
            (0..steps).fold(start, |state, i| step(&of, f64::from(i) * h, h, state))[0]
        };
        (run(name, step, steps) - run("", rk4, 20_000)).abs()
    }

    #[test]
    fn steppers_have_their_orders() {
        for ((name, _, step), order) in STEPPERS
            .into_iter()
            .zip([1.0, 4.0, 5.0, 2.0, 2.0, 2.0, 2.0, 2.0])
        {
            let [coarse, fine] = [40, 80].map(|steps| error(name, step, steps));
            let observed = (coarse / fine).log2();
            assert!(
                (observed - order).abs() < 0.3,
                "{name}: order {observed}, theory {order}"
            );
        }
    }
}
