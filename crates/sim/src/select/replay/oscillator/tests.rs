//! Steps of one mode against its equation.

use super::*;

/// q'' + 2 ratio omega q' + omega^2 q = load(t) from rest in the static deflection of load(0), by the classical
/// Runge-Kutta method in `steps` steps: q, q' and q'' at `end`.
fn integrated(omega: f64, ratio: f64, load: impl Fn(f64) -> f64, end: f64, steps: u32) -> [f64; 3] {
    let h = end / f64::from(steps);
    let acceleration =
        |t: f64, q: f64, v: f64| load(t) - 2.0 * ratio * omega * v - omega * omega * q;
    let (mut q, mut v) = (load(0.0) / (omega * omega), 0.0);
    for k in 0..steps {
        let t = h * f64::from(k);
        let rate = |t: f64, [q, v]: [f64; 2]| [v, acceleration(t, q, v)];
        let moved = |[dq, dv]: [f64; 2], by: f64| [q + by * dq, v + by * dv];
        let a = rate(t, [q, v]);
        let b = rate(t + 0.5 * h, moved(a, 0.5 * h));
        let c = rate(t + 0.5 * h, moved(b, 0.5 * h));
        let d = rate(t + h, moved(c, h));
        q += h / 6.0 * (a[0] + 2.0 * b[0] + 2.0 * c[0] + d[0]);
        v += h / 6.0 * (a[1] + 2.0 * b[1] + 2.0 * c[1] + d[1]);
    }
    [q, v, acceleration(end, q, v)]
}

/// Independent integration: loads that are cubic polynomials between samples, here with rates that jump at them, are followed
/// exactly, in steps longer than the period and of unequal length, undamped and strongly damped.
#[test]
fn steps_of_a_mode_follow_its_equation_exactly_under_a_load_of_cubic_pieces() {
    let times = [0.0, 0.3, 1.7, 2.0, 3.1];
    let pieces = [
        LoadAtEnds {
            value: [2.0, 5.0],
            rate: [10.0, 10.0],
        },
        LoadAtEnds {
            value: [5.0, -1.0],
            rate: [-3.0, 0.5],
        },
        LoadAtEnds {
            value: [-1.0, -1.0],
            rate: [7.0, 0.0],
        },
        LoadAtEnds {
            value: [-1.0, 4.0],
            rate: [0.0, -2.0],
        },
    ];
    let load = |t: f64| {
        let k = times
            .iter()
            .rposition(|from| *from <= t)
            .unwrap_or(0)
            .min(pieces.len() - 1);
        let (
            h,
            LoadAtEnds {
                value: [a, b],
                rate: [c, d],
            },
        ) = (times[k + 1] - times[k], pieces[k]);
        let s = (t - times[k]) / h;
        let r = 1.0 - s;
        a * r * r * (1.0 + 2.0 * s) + b * s * s * (1.0 + 2.0 * r) + h * s * r * (c * r - d * s)
    };
    for (omega, ratio) in [(1.3, 0.0), (7.0, 0.02), (4.0, 0.3), (2.0, 0.9)] {
        let mut mode = Oscillator::new(omega, ratio);
        mode.begin(pieces[0].value[0]);
        for (ends, piece) in times.windows(2).zip(pieces) {
            mode.advance(ends[1] - ends[0], piece);
            // The ends of the pieces are ends of steps of the integration: its step is 1/10000.
            let steps = (ends[1] * 1e4).round() as u32;
            let [q, v, a] = integrated(omega, ratio, load, ends[1], steps);
            for (found, expected) in mode.state.into_iter().zip([q, v, a]) {
                let size = 10.0 * omega.max(1.0).powi(2);
                assert!(
                    (found - expected).abs() < 1e-8 * size,
                    "{omega} {ratio}: {found}, not {expected}"
                );
            }
        }
    }
}

/// Analytic: a load that jumps by J between two steps leaves an undamped mode with the free vibration J/omega^2 about its new
/// deflection, however long the steps are.
#[test]
fn a_jump_of_the_load_excites_modes_of_short_periods() {
    let (omega, h) = (50.0_f64, 1.0);
    let constant = |load: f64| LoadAtEnds {
        value: [load; 2],
        rate: [0.0; 2],
    };
    for share in [0.2, 0.5, 0.93] {
        let mut mode = Oscillator::new(omega, 0.0);
        mode.begin(4.0);
        mode.advance(share * h, constant(4.0));
        mode.advance((1.0 - share) * h, constant(6.5));
        // The next step is as long as both of these.
        for later in [0.0, h] {
            if later > 0.0 {
                mode.advance(later, constant(6.5));
            }
            let since = omega * ((1.0 - share) * h + later);
            let expected = [
                (6.5 - 2.5 * since.cos()) / (omega * omega),
                2.5 * since.sin() / omega,
                2.5 * since.cos(),
            ];
            for (found, expected) in mode.state.into_iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-11,
                    "{share}: {found}, not {expected}"
                );
            }
        }
    }
}

/// Analytic: a load with a smooth course, sampled eight times in each of its periods, leaves a mode of a much shorter period
/// near its static deflection; the kinks of a load of straight pieces would shake it ten times as much.
#[test]
fn a_smooth_load_does_not_shake_modes_of_short_periods() {
    let (omega, h) = (60.0_f64, 2.0 * std::f64::consts::PI / 8.0);
    let mut mode = Oscillator::new(omega, 0.0);
    mode.begin(1.0);
    let mut largest = 0.0_f64;
    for k in 0..80 {
        let [a, b] = [f64::from(k), f64::from(k + 1)].map(|k| k * h);
        mode.advance(
            h,
            LoadAtEnds {
                value: [a.cos(), b.cos()],
                rate: [-a.sin(), -b.sin()],
            },
        );
        largest = largest.max(mode.state[2].abs());
    }
    // q'' of the static deflection is 1/omega^2; straight pieces have kinks of 0.6 and answers of 0.6/omega
    assert!(largest < 3.0 / (omega * omega), "{largest}");
}

/// Identity: under a constant load a mode stays where it began.
#[test]
fn a_mode_begins_at_rest_in_its_static_deflection() {
    let mut mode = Oscillator::new(3.0, 0.1);
    mode.begin(18.0);
    for _ in 0..5 {
        mode.advance(
            0.37,
            LoadAtEnds {
                value: [18.0; 2],
                rate: [0.0; 2],
            },
        );
        let [q, v, a] = mode.state;
        assert!(
            (q - 2.0).abs() < 1e-14 && v.abs() < 1e-13 && a.abs() < 1e-12,
            "{q} {v} {a}"
        );
    }
}
