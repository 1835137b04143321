//! Forces and places between samples against the functions that were sampled.

use super::*;

/// Samples of position, vertical, lateral and traction at times.
fn sampled(times: &[f64], x: impl Fn(f64) -> f64, force: impl Fn(f64) -> f64) -> History {
    let channels = vec![
        Channel::Time,
        Channel::Position(0),
        Channel::Vertical(0),
        Channel::Lateral(0),
        Channel::Traction(0),
    ];
    let row = |&t: &f64| [t, x(t), force(t), 2.0 * force(t), -force(t)];
    History::of(channels, times.iter().flat_map(row).collect())
}

fn wheel(steps: &[[f64; 2]], breaks: &[f64], is_damped: bool) -> LoadedWheel {
    LoadedWheel {
        steps: steps.to_vec(),
        breaks: breaks.to_vec(),
        is_damped,
        index: 0,
        body: 0,
        rail: 0,
        first: 1,
        contact: [1.0, 3.0],
        at_modes: Vec::new(),
    }
}

/// Analytic: a force that is a parabola in time is followed exactly between samples at unequal times, with its rate, and the
/// position of a steady wheel with its speed.
#[test]
fn a_parabola_is_followed_exactly() {
    let times = [0.0, 0.4, 0.7, 1.5, 1.8, 2.6, 3.0];
    let (force, rate) = (
        |t: f64| 50.0 + 3.0 * t - 2.0 * t * t,
        |t: f64| 3.0 - 4.0 * t,
    );
    let history = sampled(&times, |t| 2.0 + 5.0 * t, force);
    let own = wheel(&[], &[], true);
    for i in 1..times.len() - 2 {
        let interval = own.interval(&history, i);
        for share in [0.0, 0.3, 1.0] {
            let t = times[i] + share * (times[i + 1] - times[i]);
            let found = interval.at(share, 1.0);
            assert!((found.x - 2.0 - 5.0 * t).abs() < 1e-8 && (found.speed - 5.0).abs() < 1e-12);
            for (k, factor) in [-1.0, 2.0, -1.0].into_iter().enumerate() {
                assert!(
                    (found.forces[k] - factor * force(t)).abs() < 1e-12,
                    "{found:?}"
                );
                assert!(
                    (found.rates[k] - factor * rate(t)).abs() < 1e-11,
                    "{found:?}"
                );
            }
        }
    }
}

/// Analytic: a force that vanishes until the wheel meets its rail and then grows evenly has both rates at that sample.
#[test]
fn a_bend_of_a_force_is_kept() {
    let times: Vec<f64> = (0..9).map(|k| 0.25 * f64::from(k)).collect();
    let history = sampled(&times, |t| t, |t| (8.0 * (t - 1.0)).max(0.0));
    let own = wheel(&[], &[], false);
    let [before, after] = [3, 4].map(|i| own.interval(&history, i));
    assert_eq!(
        (before.at(1.0, -1.0).rates[2], after.at(0.0, 1.0).rates[2]),
        (0.0, -8.0)
    );
    assert_eq!(before.at(0.5, 1.0).forces[2], 0.0);
    assert_eq!(after.at(0.5, 1.0).forces[2], -1.0);
}

/// Analytic: a wheel that passes a step of its rail keeps the rates of its force on both sides of the jump; a damped one that
/// meets its rail jumps in the middle, an undamped one does not.
#[test]
fn forces_jump_at_steps_of_the_rail_and_where_a_damped_wheel_meets_it() {
    let times: Vec<f64> = (0..9).map(f64::from).collect();
    let stepped = |t: f64| {
        if t < 4.25 {
            10.0 + 2.0 * t
        } else {
            90.0 - 3.0 * t
        }
    };
    let history = sampled(&times, |t| 2.0 * t, stepped);
    let interval = wheel(&[[8.5, 0.5]], &[], false).interval(&history, 4);
    assert_eq!(interval.corners().collect::<Vec<_>>(), [0.25]);
    // c dh, downwards on a rail that rises
    assert_eq!((interval.impulse(0.25), interval.impulse(0.5)), (-1.5, 0.0));
    for (share, side) in [(0.1, 1.0), (0.25, -1.0), (0.25, 1.0), (0.6, -1.0)] {
        let t = 4.0 + share;
        let expected = if share < 0.25 || side < 0.0 && share == 0.25 {
            10.0 + 2.0 * t
        } else {
            90.0 - 3.0 * t
        };
        assert!(
            (interval.at(share, side).forces[2] + expected).abs() < 1e-12,
            "{share} {side}"
        );
    }
    let landing = sampled(
        &times,
        |t| 2.0 * t,
        |t| if t < 4.5 { 0.0 } else { 60.0 + 5.0 * t },
    );
    let [damped, undamped] = [true, false].map(|own| wheel(&[], &[], own).interval(&landing, 4));
    assert_eq!(
        (
            damped.at(0.5, -1.0).forces[2],
            damped.at(0.5, 1.0).forces[2]
        ),
        (0.0, -82.5)
    );
    assert_eq!((undamped.corners().count(), damped.impulse(0.5)), (0, 0.0));
}

/// Identity: at a break of the rail the two instants lie on its two sides, also of a wheel that moves backwards.
#[test]
fn shapes_are_evaluated_on_both_sides_of_a_break() {
    for direction in [1.0, -1.0] {
        let history = sampled(
            &[0.0, 1.0, 2.0, 3.0],
            |t| 10.0 + direction * 4.0 * t,
            |_| 7.0,
        );
        let at = 10.0 + direction * 5.0;
        let interval = wheel(&[], &[at, 99.0], false).interval(&history, 1);
        assert_eq!(interval.corners().collect::<Vec<_>>(), [0.25]);
        let [left, right] = [-1.0, 1.0].map(|side| interval.at(0.25, side).x);
        assert!(
            (left - at) * direction < 0.0 && (right - at) * direction > 0.0,
            "{left} {at} {right}"
        );
        assert!((left - right).abs() < 1e-7);
    }
}
