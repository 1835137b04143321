//! Differences that grow with time against the time at which they would arrive.

use super::*;

fn record(scale: f64, values: impl Fn(f64) -> f64, effect: impl Fn(f64) -> f64) -> Record {
    let time: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
    let quantity = |channel: Option<Channel>, values: Vec<f64>| RecordedQuantity {
        name: format!("{channel:?}"),
        kind: if channel.is_some() { "force" } else { "moment" },
        channel,
        is_position: false,
        group: String::new(),
        least_scale: scale,
        values,
    };
    let quantities = vec![
        quantity(
            Some(Channel::Vertical(0)),
            time.iter().map(|t| values(*t)).collect(),
        ),
        quantity(None, time.iter().map(|t| effect(*t)).collect()),
    ];
    Record { time, quantities }
}

/// Analytic: a force that is ahead by 0.02 t of its scale is 0.02 * 10 off after 10 s; one whose difference stays as it was in
/// the first half of the start keeps it. Internal forces and what follows the start do not count.
#[test]
fn a_difference_that_grows_with_time_is_extrapolated() {
    let exact = record(50.0, |_| 40.0, |_| 1.0);
    let growing = record(50.0, |t| 40.0 + t.min(0.8), |t| 1.0 + 30.0 * t);
    let bounces = Bounces {
        slowest: 0.1,
        remembered: 20.0,
    };
    let drift = |a: &Record, times: [f64; 2]| drift(a, &exact, Measure::History, bounces, times);
    let Difference {
        largest: found,
        quantity,
        ..
    } = drift(&growing, [0.8, 10.0]);
    assert!(
        (found - 0.2).abs() < 1e-12 && quantity == "Some(Vertical(0))",
        "{found} {quantity}"
    );
    let steady = record(50.0, |t| 40.0 + t.min(0.1), |_| 1.0);
    assert!((drift(&steady, [0.8, 10.0]).largest - 0.1 / 50.0).abs() < 1e-12);
    // what is forgotten within the start does not grow
    assert!((drift(&growing, [0.8, 0.5]).largest - 0.8 / 50.0).abs() < 1e-12);
    // an amplitude that grows is seen by extremes as well
    let by_extremes =
        super::drift(&growing, &exact, Measure::Extremes, bounces, [0.8, 10.0]).largest;
    assert!((by_extremes - 0.2).abs() < 1e-12, "{by_extremes}");
}

/// Analytic: a force of scale 20 moves by 2 in the last 0.2 s, a reaction of scale 10 by 0.4. Where the end of the run cuts
/// the fall of the reaction off, a shift in time moves its least value by (0.4/10) / (2/20) of what it moves the force; where
/// the least value lies within the run, not at all.
#[test]
fn a_shift_in_time_moves_extremes_at_the_end_of_a_run() {
    let force = |t: f64| {
        if t < 0.75 {
            20.0 * t
        } else {
            12.0 - 20.0 * (t - 0.9).abs()
        }
    };
    let cut_off = |t: f64| if t < 0.75 { 10.0 - t } else { 2.0 * (1.0 - t) };
    let record = |reaction: &dyn Fn(f64) -> f64| {
        let mut made = record(20.0, force, reaction);
        made.quantities[1].least_scale = 10.0;
        made
    };
    let found = share_at_end(&record(&cut_off), 0.25);
    assert!((found - 0.4).abs() < 1e-9, "{found}");
    let within = |t: f64| {
        if (t - 0.5).abs() < 0.01 {
            -1.0
        } else {
            cut_off(t)
        }
    };
    assert_eq!(share_at_end(&record(&within), 0.25), 0.0);
    assert_eq!(share_at_end(&Record::default(), 0.25), 0.0);
}

/// Analytic: a quantity rises from 0 to 1 in 1 s, and lacks a peak of 0.1 at 0.7 s whose phase is not known. With a reach of
/// 0.3 s its largest value may be 1.1 or 0.9; with one of 0.2 s, at most 0.9 + 0.1, only its mean changes, by 0.1/11. A peak of
/// 0.3 with that reach makes 1.2 of the value at 0.9 s and leaves the largest one, so that only y + A tells it; below zero only
/// y - A does. What is no number stays none.
#[test]
fn an_oscillation_changes_extremes_by_its_amplitude() {
    let bounces = Bounces {
        slowest: 5.0,
        remembered: 20.0,
    };
    let known = record(0.5, |t| t, |t| -t);
    let outlined = Outlined::new(&known, bounces).expect("few bounces");
    for sign in [-1.0, 1.0] {
        let lacking: Vec<f64> = known
            .time
            .iter()
            .map(|t| {
                if (t - 0.7).abs() < 0.01 {
                    sign * 0.1
                } else {
                    0.0
                }
            })
            .collect();
        for (reach, expected) in [
            (0, 0.1 / 11.0),
            (2, 0.1 / 11.0),
            (3, 0.1),
            (40, 0.1),
            (usize::MAX, 0.1),
        ] {
            for index in 0..2 {
                let found = outlined.difference_by_amplitude(index, &lacking, reach);
                assert!((found - expected).abs() < 1e-12, "{found} with {reach}");
            }
        }
        let beside: Vec<f64> = lacking.iter().map(|own| 3.0 * own).collect();
        for index in 0..2 {
            let found = outlined.difference_by_amplitude(index, &beside, 2);
            assert!(
                (found - 0.2).abs() < 1e-12,
                "{found} beside the extreme of {index}"
            );
        }
        let broken = [&lacking[..10], &[f64::NAN][..]].concat();
        assert_eq!(outlined.difference_by_amplitude(0, &[0.0; 11], 3), 0.0);
        assert!(outlined.difference_by_amplitude(0, &broken, 0).is_nan());
        // its phase as it is: the mean changes by one of eleven values
        for index in 0..2 {
            assert!((outlined.difference(index, &lacking) - 0.1 / 11.0).abs() < 1e-12);
        }
        assert!(outlined.difference(0, &broken).is_nan());
    }
    assert!(
        Outlined::new(
            &known,
            Bounces {
                remembered: 200.0,
                ..bounces
            }
        )
        .is_none()
    );
}

/// Analytic: in a run of many bounces the wheels of a body are one quantity, whose scale is that of the wheel with the largest
/// range: a wheel that hardly touches its rail adds no error of its own.
#[test]
fn wheels_of_many_bounces_have_one_scale() {
    let bounces = Bounces {
        slowest: 0.1,
        remembered: 200.0,
    };
    let wheels = |most: f64, light: f64| {
        let mut record = record(0.0, |t| most * t, |_| 0.0);
        let touching = RecordedQuantity {
            values: vec![light; 11],
            ..record.quantities[0].clone()
        };
        record.quantities[1] = touching;
        record
            .quantities
            .iter_mut()
            .for_each(|own| own.group = "force".to_owned());
        record
    };
    let found = difference(
        &wheels(101.0, 1.0),
        &wheels(100.0, 2.0),
        Measure::Extremes,
        bounces,
    );
    assert!((found.largest - 0.01).abs() < 1e-12, "{}", found.largest);
}
