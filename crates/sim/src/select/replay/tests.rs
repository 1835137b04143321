//! Accelerations of a carrying body against uniform ones, and the sums over the modes that are left out.

use super::*;

/// Analytic: six speeds that grow uniformly from sample to sample, at unequal times; a single sample has none.
#[test]
fn accelerations_of_a_carrier_are_differences_of_its_speeds() {
    let speeds = [
        BodyDof::X,
        BodyDof::Y,
        BodyDof::Z,
        BodyDof::Roll,
        BodyDof::Yaw,
        BodyDof::Pitch,
    ];
    let channels: Vec<Channel> = std::iter::once(Channel::Time)
        .chain(speeds.map(|dof| Channel::Speed(0, dof)))
        .collect();
    let history = |times: &[f64]| {
        let sample = |t: &f64| -> Vec<f64> {
            let speeds = (0..6).map(|k| 5.0 + f64::from(k) * t);
            std::iter::once(*t).chain(speeds).collect()
        };
        History::of(channels.clone(), times.iter().flat_map(sample).collect())
    };
    let uniform = history(&[0.0, 0.5, 0.75, 2.0]);
    for i in 0..4 {
        assert_eq!(
            acceleration(&uniform, i, 1),
            [0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
            "sample {i}"
        );
    }
    assert_eq!(acceleration(&history(&[0.5]), 0, 1), [0.0; 6]);
}

/// Analytic: what is lacking without the lowest m modes is the sum of the others; by values the largest of all samples counts,
/// by extremes the values at the rows of the record are kept. A value that is no number is not forgotten.
#[test]
fn the_sums_over_the_modes_left_out_are_noted() {
    let counts = [0, 1, 3];
    let notes = [[8.0, -4.0, 2.0, 1.0], [0.0, 0.0, 0.0, -3.0]];
    for times in [0, 2] {
        let mut slot = Slot {
            quantity: 0,
            largest: vec![0.0; 3],
            series: vec![0.0; 3 * times],
        };
        notes
            .iter()
            .enumerate()
            .for_each(|(row, terms)| slot.note(&counts, row, |r| terms[r], 4));
        assert_eq!(slot.largest, [7.0, 3.0, 3.0]);
        assert_eq!(slot.series, [7.0, -1.0, 1.0, -3.0, -3.0, -3.0][..3 * times]);
        slot.note(&counts, 0, |r| if r == 1 { f64::NAN } else { 0.0 }, 4);
        slot.note(&counts, 1, |_| 1.0, 4);
        assert!(slot.largest[0].is_nan() && slot.largest[1].is_nan() && slot.largest[2] == 3.0);
    }
}

/// Analytic: 1/n^2 and 1/n^4 summed over the modes. The factors are integrals in place of sums, and differ from them by 1/(2 k).
#[test]
fn modes_above_the_known_ones_contribute_as_their_series_does() {
    for (kept, known) in [(20, 60), (60, 96), (96, 144)] {
        let sum =
            |power: i32, to: usize| (kept + 1..=to).map(|n| (n as f64).powi(power)).sum::<f64>();
        let ratios =
            [sum_beyond(kept, known), root_beyond(kept, known).powi(2)].map(|factor| factor - 1.0);
        for (found, power) in ratios.into_iter().zip([-2, -4]) {
            let exact = sum(power, 1_000_000) / sum(power, known) - 1.0;
            assert!(
                (found / exact - 1.0).abs() < 3.0 / kept as f64,
                "{kept} of {known}: {found} for {exact}"
            );
        }
    }
}
