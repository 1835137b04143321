//! Tests of irregularities, piece by piece.

use splines::Axis;

use super::{Irregularity, LATERAL, ShapeCell, VERTICAL, Wave};

#[test]
fn pieces_are_linear_between_rows_and_constant_beyond() {
    let shape =
        Irregularity::new(&[[1.0, 0.0], [3.0, 4.0], [3.0, 1.0]], &[[2.0, 5.0]]).expect("rows");
    assert_eq!(shape.breaks(), [1.0, 2.0, 3.0]);
    let at = |x: f64, direction: f64| shape.vertical(shape.piece(x, direction, 0), x);
    assert_eq!(at(-7.0, 1.0), [0.0, 0.0]);
    assert_eq!(at(1.5, 1.0), [1.0, 2.0]);
    assert_eq!(at(2.5, -1.0), [3.0, 2.0]);
    assert_eq!((at(3.0, -1.0), at(3.0, 1.0)), ([4.0, 2.0], [1.0, 0.0]));
    assert_eq!(at(9.0, 1.0), [1.0, 0.0]);
    assert_eq!(shape.side(LATERAL, 0, 0.0), [5.0, 0.0]);
}

#[test]
fn a_wheel_at_rest_at_a_corner_stays_on_its_piece() {
    let shape = Irregularity::new(&[[1.0, 0.0], [2.0, 1.0]], &[]).expect("rows");
    assert_eq!(
        [0, 1, 2].map(|current| shape.piece(1.0, 0.0, current)),
        [0, 1, 1]
    );
    assert_eq!(shape.piece(1.5, 0.0, 0), 1);
}

#[test]
fn tables_that_fall_back_or_step_twice_are_refused() {
    assert!(Irregularity::new(&[[1.0, 0.0], [0.5, 0.0]], &[]).is_err());
    assert!(Irregularity::new(&[], &[[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]]).is_err());
    assert!(Irregularity::new(&[[1.0, f64::NAN]], &[]).is_err());
    assert!(Irregularity::new(&[], &[]).expect("nothing").is_straight());
    let wave = Wave {
        amplitude: 1.0,
        length: 0.0,
        phase: 0.0,
        range: [0.0, 1.0],
    };
    assert!(Irregularity::wave(Axis::Vertical, wave).is_err());
    assert!(
        Irregularity::wave(
            Axis::Longitudinal,
            Wave {
                length: 1.0,
                ..wave
            }
        )
        .is_err()
    );
    assert!(
        Irregularity::wave(
            Axis::Lateral,
            Wave {
                length: 1.0,
                range: [1.0, 1.0],
                ..wave
            }
        )
        .is_err()
    );
}

#[test]
fn sum_has_the_corners_and_the_values_of_both() {
    let step = Irregularity::new(&[[3.0, 0.0], [3.0, 0.5]], &[[1.0, 2.0]]).expect("rows");
    let wave = Wave {
        amplitude: 2.0,
        length: 4.0,
        phase: 0.3,
        range: [2.0, 7.0],
    };
    let swell = Irregularity::wave(Axis::Vertical, wave).expect("a wave");
    let endless = Irregularity::wave(
        Axis::Lateral,
        Wave {
            range: [f64::NEG_INFINITY, f64::INFINITY],
            ..wave
        },
    )
    .expect("a wave");
    let sum = endless.plus(&step.plus(&swell));
    assert_eq!(sum.breaks(), [1.0, 2.0, 3.0, 7.0]);
    for x in [-4.0, 1.5, 2.5, 3.5, 6.9, 7.1] {
        let parts = [&step, &swell, &endless];
        let value = |s: &Irregularity| {
            (
                s.vertical(s.piece(x, 1.0, 0), x),
                s.side(LATERAL, s.piece(x, 1.0, 0), x),
            )
        };
        let (vertical, lateral) = value(&sum);
        for k in 0..2 {
            let [a, b] = [0, 1].map(|side| {
                parts
                    .iter()
                    .map(|s| {
                        if side == 0 {
                            value(s).0[k]
                        } else {
                            value(s).1[k]
                        }
                    })
                    .sum::<f64>()
            });
            assert!((vertical[k] - a).abs() < 1e-14 && (lateral[k] - b).abs() < 1e-14);
        }
    }
    let piece = |x: f64| sum.piece(x, 1.0, 0);
    assert!(
        (sum.vertical(piece(2.5), 2.5)[0] - 2.0 * (0.25 * std::f64::consts::PI + 0.3).sin()).abs()
            < 1e-14
    );
    assert_eq!(sum.vertical(piece(8.0), 8.0), [0.5, 0.0]);
}

/// Beside the mean of the values at the points.
#[test]
fn average_over_points_is_the_mean_of_their_values() {
    let wave = |length: f64, phase: f64| {
        let range = [f64::NEG_INFINITY, f64::INFINITY];
        let wave = Wave {
            amplitude: 2e-3,
            length,
            phase,
            range,
        };
        Irregularity::wave(Axis::Vertical, wave).expect("a wave")
    };
    let shape = wave(60.0, 0.3).plus(&wave(7.0, -1.1));
    let ahead = [0.0, 1.5, 4.0, 9.25];
    let average = shape.averaged(&ahead).expect("it has no corners");
    for x in [-20.0, 0.0, 3.7, 55.0] {
        let all = ahead.map(|distance| shape.vertical(0, x + distance));
        let found = average.vertical(0, x);
        for (k, found) in found.into_iter().enumerate() {
            let mean = all.iter().map(|own| own[k]).sum::<f64>() / ahead.len() as f64;
            assert!((found - mean).abs() < 1e-16, "{x}: {found} for {mean}");
        }
    }
    assert!(
        Irregularity::new(&[[1.0, 0.0], [2.0, 1.0]], &[])
            .expect("rows")
            .averaged(&ahead)
            .is_none()
    );
}

#[test]
fn cells_have_values_and_slopes_of_the_shape_in_any_order_of_places() {
    let wave = |length: f64, phase: f64| Wave {
        amplitude: 2e-3,
        length,
        phase,
        range: [f64::NEG_INFINITY, f64::INFINITY],
    };
    let of = |length, phase| {
        Irregularity::wave(Axis::Vertical, wave(length, phase)).expect("a sinusoid")
    };
    let table =
        Irregularity::new(&[[0.0, 1e-3], [8.0, 5e-3]], &[[0.0, 2.0], [8.0, 6.0]]).expect("rows");
    let shape = of(3.0, 0.4).plus(&of(11.0, 2.0)).plus(&table);
    let (mut one, mut other) = (ShapeCell::default(), ShapeCell::default());
    let places = (0..400).map(|k| 0.017 * f64::from(k));
    let forth: Vec<[f64; 2]> = places
        .clone()
        .map(|x| one.at(&shape, VERTICAL, 1, x))
        .collect();
    let mut back: Vec<[f64; 2]> = places
        .clone()
        .rev()
        .map(|x| other.at(&shape, VERTICAL, 1, x))
        .collect();
    back.reverse();
    assert_eq!(forth, back);
    for (x, [value, slope]) in places.zip(forth) {
        let [exact, exact_slope] = shape.vertical(1, x);
        assert!(
            (value - exact).abs() < 1e-14 && (slope - exact_slope).abs() < 1e-12,
            "{x}"
        );
    }
    // Without sinusoids a single cell serves, and each piece has its own line.
    let [mut first, mut second] = [ShapeCell::default(); 2];
    assert_eq!(first.at(&table, LATERAL, 1, 3.0), [3.5, 0.5]);
    assert_eq!(first.at(&table, LATERAL, 2, 9.0), [6.0, 0.0]);
    assert_eq!(second.at(&table, LATERAL, 0, 9.0), [2.0, 0.0]);
}
