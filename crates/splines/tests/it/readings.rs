//! Curves and table readings against published values and measured errors.

use crate::beam;

use beam::printed::{LATERAL, STATIONS, VERTICAL, table};
use beam::{Beam, Random, probe, read, tabulate};
use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, Error, Influence, InfluenceBlock, Probe, ReadingMethod, SplineTable,
    TableReading, akima, natural_spline,
};

fn fill(reading: &dyn Compliance, at: &[Probe]) -> Influence {
    let mut out = Influence::zeros(at.len());
    reading.fill(at, &mut out).expect("probes within the table");
    out
}

/// Deflection at z under a load at x.
fn value(reading: &dyn Compliance, x: f64, z: f64) -> f64 {
    fill(
        reading,
        &[probe(Axis::Vertical, z), probe(Axis::Vertical, x)],
    )
    .value[(0, 1)]
}

/// External: values published for AKIMA_SPLINE and CSPLINE of Adams View, three decimals.
#[test]
fn curves_give_the_values_published_for_adams() {
    let (x, y) = ([1.0, 2.0, 3.0, 4.0], [0.0, 2.0, 1.0, 3.0]);
    let published = [
        (
            akima(&x, &y),
            [0.0, 1.0, 1.667, 2.0, 1.778, 1.222, 1.0, 1.333, 2.0, 3.0],
        ),
        (
            natural_spline(&x, &y),
            [0.0, 0.963, 1.704, 2.0, 1.741, 1.259, 1.0, 1.296, 2.037, 3.0],
        ),
    ];
    for (curve, expected) in published {
        let curve = curve.expect("points increase");
        for (k, y) in expected.iter().enumerate() {
            let got = curve.at(1.0 + k as f64 / 3.0).value;
            assert!((got - y).abs() < 5.1e-4, "{k}: {got} {y}");
        }
    }
}

/// Analytic: both reproduce a straight line; the natural spline has no curvature at its ends and no jump of
/// its second derivative.
#[test]
fn natural_spline_is_twice_smooth_and_ends_straight() {
    let x = [0.0, 1.0, 2.5, 4.0, 4.5, 7.0];
    let curve = natural_spline(&x, &[1.0, -2.0, 0.5, 3.0, 2.0, -1.0]).expect("increase");
    assert!(curve.at(0.0).curvature.abs() < 1e-13 && curve.at(7.0).curvature.abs() < 1e-13);
    for &p in &x[1..5] {
        let (left, right) = (curve.at(p - 1e-9), curve.at(p));
        assert!((left.curvature - right.curvature).abs() < 1e-7);
        assert!((left.slope - right.slope).abs() < 1e-7);
    }
    let line: Vec<f64> = x.iter().map(|x| 3.0 - 2.0 * x).collect();
    for through in [akima, natural_spline] {
        let curve = through(&x, &line).expect("increase");
        for p in [-1.0, 0.3, 3.0, 6.9, 9.0] {
            let jet = curve.at(p);
            assert!((jet.value - (3.0 - 2.0 * p)).abs() < 1e-13 && (jet.slope + 2.0).abs() < 1e-13);
            assert_eq!(jet.outside, !(0.0..=7.0).contains(&p));
        }
    }
}

/// Analytic: slopes and curvatures are the derivatives of the values, and of the slopes.
#[test]
fn slopes_and_curvatures_are_derivatives() {
    let x = [0.0, 1.0, 2.5, 4.0, 4.5, 7.0];
    for through in [akima, natural_spline] {
        let curve = through(&x, &[1.0, -2.0, 0.5, 3.0, 2.0, -1.0]).expect("increase");
        for p in [0.4, 1.7, 3.1, 4.2, 5.0, 6.5, 8.0] {
            let (low, high, jet) = (curve.at(p - 1e-5), curve.at(p + 1e-5), curve.at(p));
            assert!(((high.value - low.value) / 2e-5 - jet.slope).abs() < 1e-8);
            assert!(((high.slope - low.slope) / 2e-5 - jet.curvature).abs() < 1e-8);
        }
    }
}

/// Analytic: t = (3 m_1 - m_2)/2 at the ends; the degenerate rule where secants agree two by two.
#[test]
fn akima_follows_its_rules_at_ends_and_where_it_is_degenerate() {
    let curve = akima(&[0.0, 1.0, 2.0, 3.0, 4.0], &[0.0, 0.0, 0.0, 1.0, 2.0]).expect("increase");
    assert_eq!(curve.slopes()[2], 0.5);
    let curve = akima(&[0.0, 1.0, 3.0, 4.0], &[0.0, 2.0, 1.0, 3.0]).expect("increase");
    assert_eq!(curve.slopes()[0], 0.5 * (3.0 * 2.0 + 0.5));
    assert_eq!(curve.slopes()[3], 0.5 * (3.0 * 2.0 + 0.5));
}

/// External: an independent AKISPL of the printed vertical table.
#[test]
fn akispl_reads_the_printed_table_as_computed_independently() {
    let reading = read(ReadingMethod::Akispl, table(&VERTICAL));
    let expected = [
        (7.5, 22.5, 3.5872669338221285e-08),
        (23.5, 23.5, 9.185757027896275e-08),
        (11.0, 52.3, 1.818793688844393e-08),
        (-7.0, 33.0, -3.488411360752106e-08),
        (31.0, 44.0, 7.820561092838247e-08),
        (22.5, 7.5, 3.8336294163633975e-08),
        (52.3, 11.0, 1.8402025470756533e-08),
        (33.0, -7.0, -3.624807777276148e-08),
        (44.0, 31.0, 7.868029631569977e-08),
    ];
    for (x, z, expected) in expected {
        let got = value(&reading, x, z);
        assert!(
            (got / expected - 1.0).abs() < 1e-14,
            "AKISPL({x}, {z}) = {got:e}, expected {expected:e}"
        );
    }
}

/// Regression (the digits were made by this rule, see `printed.rs`): every entry within one unit of its last
/// digit of the force method.
#[test]
fn printed_tables_follow_from_the_girder() {
    let vertical = Beam::paper();
    let lateral = Beam {
        c: 2.6456e-10,
        g: 0.0,
        supports: vec![0.0, 60.0],
    };
    let twist = |x: f64, z: f64| {
        let (a, c) = (x.min(z), x.max(z));
        1.2315e-8
            * if c <= 0.0 {
                -c
            } else if a >= 60.0 {
                a - 60.0
            } else {
                a.max(0.0) * (60.0 - c).max(0.0) / 60.0
            }
    };
    for (i, &x) in STATIONS.iter().enumerate() {
        for (j, &z) in STATIONS.iter().enumerate() {
            let exact = [
                vertical.deflection(x, z),
                lateral.deflection(x, z) + twist(x, z),
            ];
            for (exact, printed) in exact.into_iter().zip([VERTICAL[i][j], LATERAL[i][j]]) {
                let unit = if printed == 0.0 {
                    1e-18
                } else {
                    10_f64.powf(printed.abs().log10().floor() - 2.0)
                };
                assert!(
                    (exact - printed).abs() <= unit * (1.0 + 1e-9),
                    "({x}, {z}): {exact:e} {printed:e}"
                );
            }
        }
    }
}

/// The error of the CUBSPL reading at seven stations is 8 percent of the largest value in the span.
#[test]
fn cubspl_errs_as_measured() {
    let beam = Beam::paper();
    let reading = read(ReadingMethod::Cubspl, tabulate(&beam, &STATIONS));
    let error = (0..=120)
        .flat_map(|i| (0..=120).map(move |j| (0.5 * f64::from(i), 0.5 * f64::from(j))))
        .map(|(x, z)| (value(&reading, x, z) - beam.deflection(x, z)).abs())
        .fold(0.0, f64::max);
    let relative = error / beam.deflection(30.0, 30.0);
    assert!((relative / 8.0e-2 - 1.0).abs() < 0.05, "{relative}");
}

#[test]
fn natural_reading_is_positive_symmetric_and_passes_through_the_table() {
    let table = tabulate(&Beam::paper(), &STATIONS);
    let reading = read(ReadingMethod::Natural, table.clone());
    for (i, &z) in STATIONS.iter().enumerate() {
        for (j, &x) in STATIONS.iter().enumerate() {
            assert!((value(&reading, x, z) - table.values()[(i, j)]).abs() < 1e-21);
        }
    }
    let mut random = Random::new(17);
    for n in [2, 5, 12, 20] {
        for _ in 0..100 {
            let at: Vec<Probe> = (0..n)
                .map(|_| probe(Axis::Vertical, random.between(-15.0, 75.0)))
                .collect();
            let value = fill(&reading, &at).value;
            assert_eq!(value, value.transpose());
            let eigenvalues = value.symmetric_eigenvalues();
            assert!(eigenvalues.min() > -1e-14 * eigenvalues.max());
        }
    }
}

/// Analytic: central differences; at a station the mean of both one-sided slopes.
#[test]
fn slope_is_the_derivative_of_the_reading() {
    for kind in [
        ReadingMethod::Akispl,
        ReadingMethod::Symmetrised,
        ReadingMethod::Cubspl,
        ReadingMethod::Natural,
    ] {
        let reading = read(kind, table(&VERTICAL));
        for (z, x) in [
            (7.0, 22.0),
            (31.0, 31.0),
            (30.0, 40.0),
            (-8.0, 70.0),
            (15.0, 15.0),
        ] {
            let slope = fill(
                &reading,
                &[probe(Axis::Vertical, z), probe(Axis::Vertical, x)],
            )
            .slope[(0, 1)];
            let step = 1e-4;
            let exact =
                (value(&reading, x, z + step) - value(&reading, x, z - step)) / (2.0 * step);
            // Akima's curvature jumps at a station: a central difference there has an error of a quarter of
            // jump times step.
            let allowed = if kind == ReadingMethod::Symmetrised {
                1e-14
            } else {
                1e-16
            };
            assert!(
                (slope - exact).abs() < allowed,
                "{kind:?} {z} {x}: {slope:e} {exact:e}"
            );
        }
    }
}

#[test]
fn reading_refuses_places_and_directions_it_has_no_table_for() {
    for kind in [
        ReadingMethod::Akispl,
        ReadingMethod::Symmetrised,
        ReadingMethod::Cubspl,
        ReadingMethod::Natural,
    ] {
        let reading = read(kind, table(&VERTICAL));
        let refuse = |p: Probe| {
            reading
                .fill(&[p], &mut Influence::zeros(1))
                .expect_err("refused")
        };
        assert_eq!(
            refuse(probe(Axis::Vertical, 75.1)),
            Error::OffRail { rail: 0, x: 75.1 }
        );
        assert!(matches!(
            refuse(probe(Axis::Vertical, f64::NAN)),
            Error::OffRail { rail: 0, .. }
        ));
        let lateral = Error::NoStiffness {
            rail: 0,
            x: 3.0,
            axis: Axis::Lateral,
        };
        assert_eq!(refuse(probe(Axis::Lateral, 3.0)), lateral);
        assert_eq!(
            refuse(Probe {
                rail: 2,
                x: 3.0,
                axis: Axis::Vertical
            }),
            Error::NoRail { rail: 2 }
        );
        assert_eq!(
            (reading.range(0), reading.range(1)),
            (Some([-15.0, 75.0]), None)
        );
        assert_eq!(reading.breaks(0), STATIONS);
        assert_eq!(reading.method(), kind);
    }
}

/// A coupling's transpose is the opposite block, whatever the reading; uncoupled directions give zero.
#[test]
fn couplings_are_read_both_ways() {
    let (up, side, other) = ((0, Axis::Vertical), (0, Axis::Lateral), (1, Axis::Vertical));
    let mut couple = [[0.0; 7]; 7];
    for (i, row) in couple.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = 1e-9 * (i as f64 - 0.3 * (j * j) as f64);
        }
    }
    let sheets = [
        InfluenceBlock {
            deflection: up,
            load: up,
            table: table(&VERTICAL),
        },
        InfluenceBlock {
            deflection: up,
            load: side,
            table: table(&couple),
        },
        InfluenceBlock {
            deflection: side,
            load: side,
            table: table(&LATERAL),
        },
        InfluenceBlock {
            deflection: other,
            load: other,
            table: table(&VERTICAL),
        },
    ];
    for kind in [
        ReadingMethod::Akispl,
        ReadingMethod::Symmetrised,
        ReadingMethod::Cubspl,
        ReadingMethod::Natural,
    ] {
        let reading = TableReading::new(kind, &sheets).expect("consistent");
        let at = [
            probe(Axis::Vertical, 15.0),
            probe(Axis::Lateral, 45.0),
            Probe {
                rail: 1,
                x: 30.0,
                axis: Axis::Vertical,
            },
        ];
        let value = fill(&reading, &at).value;
        assert!((value[(0, 1)] - couple[2][4]).abs() < 1e-22);
        assert_eq!(value[(0, 1)], value[(1, 0)]);
        assert!((value[(1, 1)] - LATERAL[4][4]).abs() < 1e-20);
        assert_eq!((value[(0, 2)], value[(2, 1)]), (0.0, 0.0));
    }
    let both = [sheets[0].clone(), sheets[0].clone()];
    assert_eq!(
        TableReading::new(ReadingMethod::Natural, &both).map(|_| ()),
        Err(Error::BlockTwice { sheet: 1 })
    );
    let alone = TableReading::new(ReadingMethod::Natural, &sheets[..2]).map(|_| ());
    assert_eq!(alone, Err(Error::BlockAlone { sheet: 1 }));
    assert_eq!(
        TableReading::new(ReadingMethod::Natural, &[]).map(|_| ()),
        Err(Error::NoBlocks)
    );
}

#[test]
fn unusable_tables_are_refused() {
    let x = || vec![0.0, 1.0, 2.0, 3.0];
    let values = || DMatrix::zeros(2, 4);
    let refuse = |x, z, values| SplineTable::new(x, z, values).expect_err("refused");
    assert_eq!(
        refuse(vec![0.0, 1.0, 2.0], vec![0.0, 1.0], DMatrix::zeros(2, 3)),
        Error::TooFewPoints { found: 3, least: 4 }
    );
    assert_eq!(
        refuse(vec![0.0, 1.0, 1.0, 2.0], vec![0.0, 1.0], values()),
        Error::PointOrder { index: 2 }
    );
    assert_eq!(
        refuse(x(), vec![1.0, 0.0], values()),
        Error::PointOrder { index: 1 }
    );
    assert_eq!(
        refuse(x(), vec![f64::NAN, 0.0], values()),
        Error::PointNumber { index: 0 }
    );
    assert_eq!(
        refuse(x(), vec![0.0], values()),
        Error::TableShape {
            rows: 2,
            columns: 4,
            expected: [1, 4]
        }
    );
    let mut bad = values();
    bad[(1, 2)] = f64::INFINITY;
    assert_eq!(
        refuse(x(), vec![0.0, 1.0], bad),
        Error::TableNumber { row: 1, column: 2 }
    );
    assert_eq!(
        akima(&x(), &[0.0; 3]).map(|_| ()),
        Err(Error::PointCount { x: 4, y: 3 })
    );
}

/// Rounding may place a probe just beyond the first or the last station, where the table has its end (analytic); a probe
/// that is further beyond is refused.
#[test]
fn rounding_leads_no_probe_off_its_table() {
    let stations: Vec<f64> = [0.15, 2.0, 3.0, 4.0, 5.6].to_vec();
    let beam = Beam::paper();
    for kind in [
        ReadingMethod::Natural,
        ReadingMethod::Akispl,
        ReadingMethod::Symmetrised,
        ReadingMethod::Cubspl,
    ] {
        let reading = read(kind, tabulate(&beam, &stations));
        for (end, beyond) in [
            (0.15, 0.15_f64.next_down()),
            (5.6, 5.6_f64.next_up()),
            (0.15, 0.15 - 4e-16),
        ] {
            let near = value(&reading, beyond, beyond);
            assert_eq!(near, value(&reading, end, end), "{kind:?} {beyond}");
        }
        let far = [probe(Axis::Vertical, 0.15 - 1e-9)];
        let mut out = Influence::zeros(1);
        assert!(matches!(
            reading.fill(&far, &mut out),
            Err(Error::OffRail { .. })
        ));
    }
}
