//! The explicit Runge-Kutta pair of orders 5 and 4 as scipy's RK45 takes it.

/// Where a run ended, and how often it asked for rates.
#[derive(Clone, Copy, Debug)]
pub struct Ended<const N: usize> {
    pub y: [f64; N],
    pub rates: usize,
}

/// Weights of earlier rates in the stages' places; the last row is that of the end of the step.
const STAGES: [[f64; 6]; 6] = [
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
        0.0,
    ],
    [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];
/// Weights of all seven rates in the error.
const ERROR: [f64; 7] = [
    -71.0 / 57600.0,
    0.0,
    71.0 / 16695.0,
    -71.0 / 1920.0,
    17253.0 / 339_200.0,
    -22.0 / 525.0,
    1.0 / 40.0,
];

fn norm<const N: usize>(values: [f64; N]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / N as f64).sqrt()
}

/// y' = `rate`(y) from `y` over `end`, with the tolerances `rtol` and `atol` a step; `watch` sees t and y after each.
///
/// # Source
/// J. R. Dormand, P. J. Prince, A family of embedded Runge-Kutta formulae, Journal of Computational and Applied Mathematics 6
/// (1980); step control and first step of E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I,
/// section II.4, with the constants of scipy.integrate.RK45.
pub fn dormand<const N: usize>(
    y: [f64; N],
    end: f64,
    [rtol, atol]: [f64; 2],
    rate: impl Fn([f64; N]) -> [f64; N],
    mut watch: impl FnMut(f64, [f64; N]),
) -> Ended<N> {
    let scaled = |values: [f64; N], a: [f64; N], b: [f64; N]| {
        norm(std::array::from_fn::<f64, N, _>(|j| {
            values[j] / (atol + rtol * a[j].abs().max(b[j].abs()))
        }))
    };
    let mut y = y;
    let mut first = rate(y);
    let (size, slope) = (scaled(y, y, y), scaled(first, y, y));
    let guess = if size < 1e-5 || slope < 1e-5 {
        1e-6
    } else {
        0.01 * size / slope
    };
    let ahead = rate(std::array::from_fn(|j| y[j] + guess * first[j]));
    let bend = scaled(std::array::from_fn(|j| ahead[j] - first[j]), y, y) / guess;
    let most = slope.max(bend);
    let second = if most <= 1e-15 {
        (1e-3 * guess).max(1e-6)
    } else {
        (0.01 / most).powf(0.2)
    };
    let mut h = (100.0 * guess).min(second);
    let (mut t, mut rates) = (0.0, 2);
    while t < end {
        let mut was_rejected = false;
        loop {
            let next = (t + h).min(end);
            let step = next - t;
            let mut k = [first; 7];
            let mut to = y;
            for (s, row) in STAGES.iter().enumerate() {
                to = std::array::from_fn(|j| {
                    y[j] + step
                        * row
                            .iter()
                            .zip(&k)
                            .take(s + 1)
                            .map(|(weight, k)| weight * k[j])
                            .sum::<f64>()
                });
                k[s + 1] = rate(to);
            }
            rates += 6;
            let error = std::array::from_fn(|j| {
                step * ERROR
                    .iter()
                    .zip(&k)
                    .map(|(weight, k)| weight * k[j])
                    .sum::<f64>()
            });
            let error = scaled(error, y, to);
            let factor = 0.9 * error.powf(-0.2);
            if error < 1.0 {
                let most = if was_rejected { 1.0 } else { 10.0 };
                h = step * factor.min(most);
                (t, y, first) = (next, to, k[6]);
                watch(t, y);
                break;
            }
            h = step * factor.max(0.2);
            was_rejected = true;
        }
    }
    Ended { y, rates }
}
