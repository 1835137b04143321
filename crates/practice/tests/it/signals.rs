//! Envelopes, means, excursions, filter, spectrum and damping against closed forms.

use std::f64::consts::PI;

use practice::{
    Error, Excursions, HistorySpectrum, ResponseSettings, RunHistories, SineComponent, decay,
    envelope, excursions, low_pass, mean, resample, response,
};

fn close(found: f64, expected: f64, slack: f64) {
    assert!(
        (found - expected).abs() <= slack,
        "{found} is not {expected}"
    );
}

fn samples(count: usize, step: f64, value: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..count).map(|k| value(k as f64 * step)).collect()
}

/// exp(-zeta w t) cos(w_d t) for w_d = 2 pi f.
fn ringing(ratio: f64, frequency: f64) -> impl Fn(f64) -> f64 {
    let damped = 2.0 * PI * frequency;
    let fall = ratio / (1.0 - ratio * ratio).sqrt() * damped;
    move |t| (-fall * t).exp() * (damped * t).cos()
}

#[test]
fn an_envelope_has_what_stood_beside_it() -> Result<(), Error> {
    let times = [0.0, 1.0, 2.0, 3.0];
    let (reaction, moment, place) = (
        [1.0, 4.0, 2.0, -1.0],
        [0.5, -3.0, 9.0, 9.0],
        [10.0, 20.0, 30.0, 40.0],
    );
    let later = (
        [7.0, 7.0, 3.0, 1.0],
        [0.0, 1.0, -4.0, 2.0],
        [50.0, 60.0, 70.0, 80.0],
    );
    let runs = [
        RunHistories {
            times: &times,
            series: &[&reaction, &moment, &place],
        },
        RunHistories {
            times: &[5.0, 6.0, 7.0, 8.0],
            series: &[&later.0, &later.1, &later.2],
        },
    ];
    let found = envelope(&runs, 2)?;
    assert_eq!(found.len(), 2);
    // The first of equal values, with all values at that instant.
    let most = &found[0].max;
    assert_eq!((most.run, most.sample, most.time), (1, 0, 5.0));
    assert_eq!(most.values, [7.0, 0.0, 50.0]);
    assert_eq!(found[0].min.values, [-1.0, 9.0, 40.0]);
    assert_eq!(found[1].max.values, [2.0, 9.0, 30.0]);
    assert_eq!(found[1].min.values, [3.0, -4.0, 70.0]);
    Ok(())
}

#[test]
fn no_value_lies_outside_its_envelope() -> Result<(), Error> {
    let times = samples(500, 0.1, |t| t);
    let series: Vec<Vec<f64>> = (1..6)
        .map(|k| {
            samples(500, 0.1, |t| {
                (f64::from(k) * t).sin() + (0.37 * t * t).cos()
            })
        })
        .collect();
    let borrowed: Vec<&[f64]> = series.iter().map(Vec::as_slice).collect();
    for (own, extremes) in envelope(
        &[RunHistories {
            times: &times,
            series: &borrowed,
        }],
        5,
    )?
    .iter()
    .enumerate()
    {
        for instant in [&extremes.max, &extremes.min] {
            let there: Vec<f64> = series.iter().map(|values| values[instant.sample]).collect();
            assert_eq!(instant.values, there);
        }
        let [most, least] = [extremes.max.values[own], extremes.min.values[own]];
        assert!(
            series[own]
                .iter()
                .all(|value| (least..=most).contains(value))
        );
    }
    Ok(())
}

#[test]
fn means_and_samples_of_straight_lines_are_exact() -> Result<(), Error> {
    let times = [0.0, 0.3, 0.3, 1.1, 4.0, 4.0, 7.0];
    let line: Vec<f64> = times.iter().map(|t| 3.0 - 2.0 * t).collect();
    close(mean(&times, &line, 0.0)?, 3.0 - 7.0, 1e-12);
    close(mean(&times, &line, 0.7)?, 3.0 - 7.7, 1e-12);
    for (k, value) in resample(&times, &line, 0.5, 0.1)?.into_iter().enumerate() {
        close(value, 3.0 - 2.0 * (0.5 + 0.1 * k as f64), 1e-12);
    }
    assert_eq!(resample(&times, &line, 0.0, 0.1)?.len(), 71);
    // A jump: the later sample counts.
    assert_eq!(
        resample(&[0.0, 1.0, 1.0, 2.0], &[0.0, 0.0, 5.0, 5.0], 0.0, 0.5)?,
        [0.0, 0.0, 5.0, 5.0, 5.0]
    );
    close(
        mean(&[0.0, 1.0, 1.0, 2.0], &[0.0, 0.0, 5.0, 5.0], 0.0)?,
        2.5,
        1e-15,
    );
    Ok(())
}

#[test]
fn excursions_count_the_half_cycles_that_leave_the_band() -> Result<(), Error> {
    // Analytic: extremes follow at half periods, each exp(-pi zeta/sqrt(1 - zeta^2)) of the one before; the
    // first, at zero, is almost one.
    let (ratio, level) = (0.02_f64, 100.0);
    let fall = (PI * ratio / (1.0 - ratio * ratio).sqrt()).exp();
    let shape = ringing(ratio, 2.0);
    for halves in [4, 7, 12] {
        // The band lies between the last extreme outside and the first inside.
        let edge = fall.powf(0.5 - f64::from(halves));
        let values = samples(8000, 0.002, |t| level * (1.0 + 0.1 * shape(t)));
        let counts = excursions(&values, level, 0.1 * edge)?;
        assert_eq!(counts.total(), halves as usize);
        assert_eq!(
            counts,
            Excursions {
                above: halves as usize - halves as usize / 2,
                below: halves as usize / 2
            }
        );
    }
    assert_eq!(excursions(&[1.0, 1.0], 1.0, 0.0)?.total(), 0);
    assert_eq!(
        excursions(&[2.0, 0.0, 2.0], 1.0, 0.5)?,
        Excursions { above: 2, below: 1 }
    );
    Ok(())
}

/// The strongest sine component of a history in a band.
fn dominant(values: &[f64], step: f64, band: [f64; 2]) -> Result<Option<SineComponent>, Error> {
    HistorySpectrum::new(values, step)?.strongest(band)
}

#[test]
fn the_filter_has_its_gain_and_no_delay() -> Result<(), Error> {
    // Analytic: the squared magnitude of Butterworth's second order after the bilinear transform.
    let (step, cut) = (0.01, 4.0_f64);
    for frequency in [0.5, 2.0, 4.0, 6.0, 11.0] {
        let warp = (PI * frequency * step).tan() / (PI * cut * step).tan();
        let gain = 1.0 / (1.0 + warp.powi(4));
        let wave = |t: f64| (2.0 * PI * frequency * t + 0.4).sin();
        let found = low_pass(&samples(2000, step, wave), step, cut)?;
        for (k, value) in found.iter().enumerate().take(1500).skip(500) {
            close(*value, gain * wave(k as f64 * step), 1e-9);
        }
    }
    Ok(())
}

#[test]
fn the_filter_leaves_straight_lines_alone_up_to_their_ends() -> Result<(), Error> {
    let line = samples(400, 0.01, |t| 7.0 - 3.0 * t);
    for (found, given) in low_pass(&line, 0.01, 2.0)?.iter().zip(&line) {
        close(*found, *given, 1e-9);
    }
    // The filter is symmetric in time.
    let bent = samples(300, 0.01, |t| (3.0 * t * t).sin() + (40.0 * t).cos());
    let turned: Vec<f64> = bent.iter().rev().copied().collect();
    let [there, back] = [low_pass(&bent, 0.01, 5.0)?, low_pass(&turned, 0.01, 5.0)?];
    for (one, other) in there.iter().zip(back.iter().rev()).take(250).skip(50) {
        close(*one, *other, 1e-6);
    }
    assert_eq!(low_pass(&[3.0], 0.01, 5.0)?, [3.0]);
    assert!(low_pass(&[3.0, 4.0], 0.01, 50.0).is_err());
    Ok(())
}

#[test]
fn a_sine_is_found_between_the_bins() -> Result<(), Error> {
    // 1001 samples, 10.01 s: bins are 0.1 Hz apart.
    for k in 0..21 {
        let frequency = 2.0 + 0.01 * f64::from(k);
        let wave = samples(1001, 0.01, |t| {
            5.0 + 1.7 * (2.0 * PI * frequency * t + 0.3).cos()
        });
        let tone = dominant(&wave, 0.01, [0.5, 10.0])?.expect("there is a sine");
        close(tone.frequency, frequency, 2e-5);
        close(tone.amplitude, 1.7, 5e-4);
    }
    Ok(())
}

#[test]
fn a_large_mean_hides_no_slow_sine() -> Result<(), Error> {
    // Two and a half cycles on a level 10,000 times as high.
    let wave = samples(1000, 0.01, |t| 1e4 + (2.0 * PI * 0.25 * t).cos());
    let tone = dominant(&wave, 0.01, [0.05, 10.0])?.expect("there is a sine");
    close(tone.frequency, 0.25, 5e-3);
    close(tone.amplitude, 1.0, 0.1);
    Ok(())
}

#[test]
fn the_stronger_of_two_sines_within_the_band_is_taken() -> Result<(), Error> {
    let wave = samples(3000, 0.01, |t| {
        (2.0 * PI * 1.3 * t).sin() + 0.4 * (2.0 * PI * 6.1 * t).sin()
    });
    let tone = |band| {
        dominant(&wave, 0.01, band)
            .map(|tone| tone.map(|SineComponent { frequency, .. }| frequency))
    };
    close(tone([0.0, 50.0])?.expect("one"), 1.3, 1e-4);
    close(tone([3.0, 50.0])?.expect("the other"), 6.1, 1e-4);
    assert_eq!(
        dominant(&samples(100, 0.1, |_| 4.0), 0.1, [0.0, 5.0])?,
        None
    );
    // The flank of a peak outside the band does not count as a peak.
    let slow = samples(1000, 0.01, |t| (2.0 * PI * 0.1 * t).sin());
    assert!(dominant(&slow, 0.01, [0.5, 0.9])?.is_none_or(|tone| tone.amplitude < 0.01));
    assert!(dominant(&[1.0; 7], 0.1, [0.0, 5.0]).is_err());
    Ok(())
}

#[test]
fn damping_is_found_whatever_the_mean() -> Result<(), Error> {
    for ratio in [0.005, 0.02, 0.05, 0.2] {
        for shift in [0.0, -40.0] {
            let shape = ringing(ratio, 1.9);
            let found =
                decay(&samples(1500, 0.01, |t| shift + shape(t)), 0.01, 0.01)?.expect("it rings");
            close(found.ratio, ratio, 2e-3 * ratio);
            close(found.frequency, 1.9, 2e-3);
        }
    }
    let steady = decay(
        &samples(1000, 0.01, |t| (2.0 * PI * 1.9 * t).sin()),
        0.01,
        0.5,
    )?
    .expect("it rings");
    close(steady.ratio, 0.0, 1e-6);
    assert_eq!(decay(&samples(1000, 0.01, |t| t * t), 0.01, 0.01)?, None);
    assert_eq!(decay(&[], 0.01, 0.01)?, None);
    Ok(())
}

#[test]
fn a_response_is_told_in_its_numbers() -> Result<(), Error> {
    // A step of 50 at 1 s that oscillates at 2 Hz with 3 % damping, and chatter at 30 Hz that the filter
    // removes.
    let shape = ringing(0.03, 2.0);
    let value = |t: f64| {
        1000.0
            + if t < 1.0 {
                0.0
            } else {
                50.0 * (1.0 - shape(t - 1.0))
            }
    };
    let times: Vec<f64> = (0..16001).map(|k| f64::from(k) * 1e-3).collect();
    let clean: Vec<f64> = times.iter().map(|&t| value(t)).collect();
    let rough: Vec<f64> = times
        .iter()
        .map(|&t| value(t) + 3.0 * (2.0 * PI * 30.0 * t).sin())
        .collect();
    let view = ResponseSettings {
        from: 1.0,
        settled: 14.0,
        step: 0.002,
        cut_off: None,
        excursion_fraction: 0.01,
    };
    let plain = response(&times, &clean, &view)?;
    close(plain.mean, 1050.0, 0.002);
    // Analytic: the first overshoot of a step, half a period later.
    let overshoot = 50.0 * (-PI * 0.03_f64 / (1.0 - 0.03_f64 * 0.03).sqrt()).exp();
    close(plain.peak.value, 1050.0 + overshoot, 0.05);
    close(plain.peak.time, 1.25, 0.01);
    close(plain.trough.value, 1000.0, 1e-9);
    let even = resample(&times, &clean, view.from, view.step)?;
    close(
        dominant(&even, view.step, [0.5, 100.0])?
            .expect("it rings")
            .frequency,
        2.0,
        0.02,
    );
    close(
        decay(&even, view.step, 0.05)?.expect("it rings").ratio,
        0.03,
        1e-4,
    );
    // 50 exp(-k pi zeta') > 10.5 for k = 0 to 16.
    assert_eq!(plain.excursions, Excursions { above: 8, below: 9 });
    let counted = response(&times, &rough, &view)?.excursions;
    assert!(counted.total() > 17, "chatter counts: {counted:?}");
    let filtered = response(
        &times,
        &rough,
        &ResponseSettings {
            cut_off: Some(10.0),
            ..view
        },
    )?;
    assert_eq!(filtered.excursions, plain.excursions);
    let smooth = low_pass(
        &resample(&times, &rough, view.from, view.step)?,
        view.step,
        10.0,
    )?;
    close(
        decay(&smooth, view.step, 0.05)?.expect("it rings").ratio,
        0.03,
        1e-3,
    );
    Ok(())
}

#[test]
fn histories_that_make_no_sense_are_refused() {
    let (times, values) = ([0.0, 1.0], [1.0, 2.0]);
    assert_eq!(
        mean(&[0.0], &[1.0], 0.0),
        Err(Error::Few { found: 1, least: 2 })
    );
    assert!(mean(&times, &values, 1.0).is_err());
    assert_eq!(
        mean(&times, &[1.0], 0.0),
        Err(Error::Samples {
            series: 0,
            found: 1,
            expected: 2
        })
    );
    assert_eq!(
        mean(&[1.0, 0.0], &values, 0.0),
        Err(Error::Order { sample: 1 })
    );
    assert_eq!(
        mean(&[0.0, f64::NAN], &values, 0.0),
        Err(Error::Number {
            series: 1,
            sample: 1
        })
    );
    assert!(resample(&times, &values, 0.0, 1e-30).is_err());
    assert!(resample(&times, &values, 2.0, 0.1).is_err());
    assert!(excursions(&[f64::NAN], 0.0, 0.1).is_err());
    assert!(decay(&values, 0.0, 0.1).is_err());
    assert_eq!(
        envelope(&[], 0).map(|found| found.len()),
        Err(Error::Few { found: 0, least: 1 })
    );
    let run = RunHistories {
        times: &times,
        series: &[&values],
    };
    assert_eq!(
        envelope(&[run], 2),
        Err(Error::Series {
            run: 0,
            found: 1,
            expected: 2
        })
    );
    let infinite = [1.0, f64::INFINITY];
    let broken = RunHistories {
        times: &times,
        series: &[&infinite],
    };
    assert_eq!(
        envelope(&[run, broken], 1),
        Err(Error::Number {
            series: 0,
            sample: 1
        })
    );
}
