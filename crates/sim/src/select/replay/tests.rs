//! Accelerations of a carrying body against uniform ones, and the sums over the modes that are left out.

use super::*;

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

/// Analytic: what is lacking without the lowest m modes is the sum of the others; by values the largest of all samples counts,
/// by extremes the values at the rows of the record are kept.
#[test]
fn the_sums_over_the_modes_left_out_are_noted() {
    let counts = [0, 1, 3];
    let notes = [[8.0, -4.0, 2.0, 1.0], [0.0, 0.0, 0.0, -3.0]];
    let noted = |lacking: Lacking| {
        let mut slot = Slot { quantity: 0, lacking };
        notes.iter().enumerate().for_each(|(row, terms)| slot.note(&counts, row, |r| terms[r], 4));
        slot.lacking
    };
    let Lacking::Largest(largest) = noted(Lacking::Largest(vec![0.0; 3])) else { panic!("of one kind") };
    assert_eq!(largest, [7.0, 3.0, 3.0]);
    let Lacking::Series(series) = noted(Lacking::Series(vec![0.0; 6])) else { panic!("of one kind") };
    assert_eq!(series, [7.0, -3.0, -1.0, -3.0, 1.0, -3.0]);
}
