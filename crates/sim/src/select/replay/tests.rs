//! Steps of one mode against its equation, and accelerations of a carrying body against uniform ones.

use super::*;

/// q'' + 2 ratio omega q' + omega^2 q = load(t) from rest in the static deflection of load(0), by the classical
/// Runge-Kutta method in `steps` steps: q, q' and q'' at `end`.
fn integrated(omega: f64, ratio: f64, load: impl Fn(f64) -> f64, end: f64, steps: u32) -> [f64; 3] {
    let h = end / f64::from(steps);
    let acceleration = |t: f64, q: f64, v: f64| load(t) - 2.0 * ratio * omega * v - omega * omega * q;
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

/// Independent integration: loads that are linear between samples are followed exactly, in steps longer than the period
/// and of unequal length, undamped and strongly damped.
#[test]
fn steps_of_a_mode_follow_its_equation_exactly_under_a_load_of_straight_pieces() {
    let samples = [(0.0, 2.0), (0.3, 5.0), (1.7, -1.0), (2.0, -1.0), (3.1, 4.0)];
    let load = |t: f64| {
        let k = samples.iter().rposition(|(from, _)| *from <= t).unwrap_or(0).min(samples.len() - 2);
        let ((from, a), (to, b)) = (samples[k], samples[k + 1]);
        a + (b - a) * (t - from) / (to - from)
    };
    for (omega, ratio) in [(1.3, 0.0), (7.0, 0.02), (4.0, 0.3), (2.0, 0.9)] {
        let mut mode = Oscillator { omega, ratio, ..Oscillator::default() };
        mode.begin(samples[0].1);
        for pair in samples.windows(2) {
            let h = pair[1].0 - pair[0].0;
            mode.advance(h, pair[1].1);
            // The ends of the pieces are ends of steps of the integration: its step is 1/10000.
            let steps = (pair[1].0 * 1e4).round() as u32;
            let [q, v, a] = integrated(omega, ratio, load, pair[1].0, steps);
            for (found, expected) in mode.state.into_iter().zip([q, v, a]) {
                let size = 10.0 * omega.max(1.0).powi(2);
                assert!((found - expected).abs() < 1e-9 * size, "{omega} {ratio}: {found}, not {expected}");
            }
        }
    }
}

/// Analytic: a load that jumps by J in the middle of a step leaves an undamped mode with the free vibration J/omega^2 about its
/// new deflection, however long the step is.
#[test]
fn a_jump_of_the_load_within_a_step_excites_modes_of_short_periods() {
    let (omega, h) = (50.0_f64, 1.0);
    for share in [0.2, 0.5, 0.93] {
        let mut mode = Oscillator { omega, ..Oscillator::default() };
        mode.begin(4.0);
        mode.jump(h, share, 6.5);
        // The next step is as long as the whole of this one.
        for later in [0.0, h] {
            if later > 0.0 {
                mode.advance(later, 6.5);
            }
            let since = omega * ((1.0 - share) * h + later);
            let expected =
                [(6.5 - 2.5 * since.cos()) / (omega * omega), 2.5 * since.sin() / omega, 2.5 * since.cos()];
            for (found, expected) in mode.state.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-11, "{share}: {found}, not {expected}");
            }
        }
    }
}

/// Identity: under a constant load a mode stays where it began.
#[test]
fn a_mode_begins_at_rest_in_its_static_deflection() {
    let mut mode = Oscillator { omega: 3.0, ratio: 0.1, ..Oscillator::default() };
    mode.begin(18.0);
    for _ in 0..5 {
        mode.advance(0.37, 18.0);
        let [q, v, a] = mode.state;
        assert!((q - 2.0).abs() < 1e-14 && v.abs() < 1e-13 && a.abs() < 1e-12, "{q} {v} {a}");
    }
}

/// Analytic: six speeds that grow uniformly from sample to sample, at unequal times; a single sample has none.
#[test]
fn accelerations_of_a_carrier_are_differences_of_its_speeds() {
    let speeds = [BodyDof::X, BodyDof::Y, BodyDof::Z, BodyDof::Roll, BodyDof::Yaw, BodyDof::Pitch];
    let channels: Vec<Channel> =
        std::iter::once(Channel::Time).chain(speeds.map(|dof| Channel::Speed(0, dof))).collect();
    let history = |times: &[f64]| {
        let mut history = History::new(channels.clone());
        let sample = |t: &f64| std::iter::once(*t).chain((0..6).map(|k| 5.0 + f64::from(k) * t)).collect();
        history.put_values(times.iter().flat_map(|t| -> Vec<f64> { sample(t) }).collect());
        history
    };
    let uniform = history(&[0.0, 0.5, 0.75, 2.0]);
    for i in 0..4 {
        assert_eq!(acceleration(&uniform, i, 1), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], "sample {i}");
    }
    assert_eq!(acceleration(&history(&[0.5]), 0, 1), [0.0; 6]);
}

/// Analytic: what is lacking without the lowest m modes is the sum of the others, and the largest of all samples counts.
#[test]
fn the_largest_sums_over_the_modes_left_out_are_noted() {
    let mut largest = vec![0.0; 3];
    note(&[0, 1, 3], &mut largest, |r| [8.0, -4.0, 2.0, 1.0][r], 4);
    assert_eq!(largest, [7.0, 1.0, 1.0]);
    note(&[0, 1, 3], &mut largest, |r| [0.0, -4.0, 2.0, 0.5][r], 4);
    assert_eq!(largest, [7.0, 1.5, 1.0]);
}
