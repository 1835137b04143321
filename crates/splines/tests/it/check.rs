//! Quality of readings of a table, against figures of independent prototypes and closed forms.

use crate::beam;

use beam::near::assert_near;
use beam::printed::{STATIONS, VERTICAL, table};
use beam::{Beam, Random, read, tabulate};
use nalgebra::DMatrix;
use splines::quality::{
    CouplingBlock, asymmetry, diagonal_slope_jumps, extrapolated_rows, indefinite_fraction,
    loop_work, pair_slope_jumps, reading_error, sample_places, slope_jumps, spectrum,
    station_asymmetry, station_spectrum, support_stations, table_precision, weakest_layouts,
};
use splines::{Axis, Compliance, ReadingMethod, SplineTable, TableReading, fit_beam};

const UP: (usize, Axis) = (0, Axis::Vertical);
const WHOLE: [f64; 2] = [-15.0, 75.0];
/// Wheels of the paper's bogie are 32 inches apart.
const BOGIE: f64 = 32.0 / 12.0;

fn printed(kind: ReadingMethod) -> TableReading {
    read(kind, table(&VERTICAL))
}

fn strip(compliance: &dyn Compliance) -> CouplingBlock<'_> {
    CouplingBlock::direct(compliance, UP)
}

fn close(found: f64, asked: f64, tolerance: f64) {
    assert!(
        (found / asked - 1.0).abs() < tolerance,
        "found {found:e}, asked {asked:e}"
    );
}

/// Regression, measured first on an independent prototype (printed table, wheels 32 in apart, P = 2.4e6 lb):
/// 30 789 ft lb a loop near x = 15 ft, 2.4 percent of the energy that the bogie stores at midspan. The
/// prototype took the largest of samples; the peak is sharp, 0.13 percent higher, and at 15 ft to the last
/// bit. From the other end it is the same.
#[test]
fn closed_loop_of_forces_on_the_printed_table_gives_the_measured_work() {
    let reading = printed(ReadingMethod::Akispl);
    let found = loop_work(
        &strip(&reading),
        BOGIE,
        &sample_places(&STATIONS, [0.0, 60.0], 200),
    )
    .expect("on the table");
    assert_near(
        "largest G12 - G21 of wheels 32 in apart, printed table by AKISPL, ft/lb",
        "prototype",
        5.345e-9,
        found.work,
        2e-3,
    );
    assert_eq!(found.at, [15.0, 15.0 + BOGIE]);
    assert_near(
        "place of the rear one, ft",
        "prototype",
        15.0,
        found.at[0],
        1e-9,
    );
    assert_near(
        "work of a loop of two forces of 2.4e6 lb there, ft lb",
        "prototype",
        30_789.0,
        found.work * 2.4e6 * 2.4e6,
        2e-3,
    );
    let mirrored = strip(&reading)
        .matrix(&[45.0 - BOGIE, 45.0], &[45.0 - BOGIE, 45.0])
        .expect("on the table");
    close(
        (mirrored[(0, 1)] - mirrored[(1, 0)]).abs(),
        found.work,
        1e-12,
    );
    let middle = [30.0 - BOGIE / 2.0, 30.0 + BOGIE / 2.0];
    let beam = Beam::paper().surface(&STATIONS);
    let stored = 0.5
        * strip(&beam)
            .matrix(&middle, &middle)
            .expect("on the rail")
            .sum();
    assert_near(
        "that work by the energy the wheels store at midspan",
        "prototype",
        0.024,
        found.work / stored,
        0.05,
    );
    let stored = 0.5
        * strip(&beam)
            .matrix(&found.at, &found.at)
            .expect("on the rail")
            .sum();
    // The prototype has 0.024, relative to the energy at midspan; the loop is at 15 ft, where the girder is stiffer.
    assert_near(
        "that work by the energy they store where they stand",
        "regression",
        0.0393,
        found.work / stored,
        0.01,
    );
    for exact in [&printed(ReadingMethod::Natural) as &dyn Compliance, &beam] {
        let none = loop_work(&strip(exact), BOGIE, &sample_places(&STATIONS, WHOLE, 200))
            .expect("on the table");
        assert_eq!(none.work, 0.0);
    }
}

/// Regression, measured first on an independent prototype: slopes of the rail under one wheel.
#[test]
fn slope_under_a_wheel_jumps_at_stations_as_measured() {
    let reading = printed(ReadingMethod::Akispl);
    let found = diagonal_slope_jumps(&strip(&reading), WHOLE).expect("on the table");
    let at = |x: f64| {
        found
            .iter()
            .find(|kink| kink.x == x)
            .map_or(0.0, |kink| kink.jump())
    };
    assert_eq!(found.len(), 5);
    close(at(30.0), -4.5e-9, 0.01);
    for x in [15.0, 45.0] {
        close(at(x), -3.2e-9, 0.01);
    }
    close(found[2].before, 2.26e-9, 0.01);
    close(found[2].beyond, -2.26e-9, 0.01);
    for smooth in [
        &printed(ReadingMethod::Natural) as &dyn Compliance,
        &Beam::paper().surface(&STATIONS),
    ] {
        let kinks = diagonal_slope_jumps(&strip(smooth), WHOLE).expect("on the table");
        assert_eq!(kinks.len(), 5);
        assert!(
            kinks.iter().all(|kink| kink.jump().abs() < 1e-20),
            "{kinks:?}"
        );
    }
}

/// A pair passes every station twice; the jumps of its mean agree with one-sided differences.
#[test]
fn pair_of_wheels_meets_every_station_twice() {
    let reading = printed(ReadingMethod::Akispl);
    let strip = strip(&reading);
    let found = pair_slope_jumps(&strip, BOGIE, WHOLE).expect("on the table");
    assert_eq!(found.len(), 10);
    let give = |x: f64| {
        strip
            .matrix(&[x, x + BOGIE], &[x, x + BOGIE])
            .map(|g| 0.25 * g.sum())
            .expect("on it")
    };
    for kink in &found {
        let h = 1e-5;
        let jump = (give(kink.x + h) - 2.0 * give(kink.x) + give(kink.x - h)) / h;
        assert!((jump - kink.jump()).abs() < 1e-13, "{kink:?} {jump:e}");
    }
    assert!(
        pair_slope_jumps(&strip, 90.0, WHOLE)
            .expect("nothing to move")
            .is_empty()
    );
}

/// Analytic: polynomials up to degree 6 have exact slopes at both ends.
#[test]
fn kinks_are_exact_for_polynomials() {
    let f = |x: f64| {
        Ok(if x < 1.0 {
            x.powi(6)
        } else {
            3.0 - 2.0 * x + (x - 1.0).powi(6)
        })
    };
    let found = slope_jumps(f, &[1.0, 1.0 + 1e-13], [0.0, 3.0]).expect("no error");
    assert_eq!(found.len(), 1);
    assert!(
        (found[0].before - 6.0).abs() < 1e-12 && (found[0].beyond + 2.0).abs() < 1e-11,
        "{found:?}"
    );
}

/// Regression, measured first on an independent prototype (rows of the printed table extrapolated by 5 ft).
#[test]
fn rules_of_extrapolation_differ_as_measured() {
    let rows = extrapolated_rows(&table(&VERTICAL), 80.0).expect("rows of a table");
    let last = rows[6];
    assert_eq!((last.z, last.x), (75.0, 80.0));
    for (found, asked) in [
        (last.parabola, 1.956e-7),
        (last.cubic, 1.955e-7),
        (last.tangent, 1.921e-7),
        (last.line, 1.813e-7),
    ] {
        assert!((found - asked).abs() < 0.6e-10, "{found:e} {asked:e}");
    }
    assert!((last.spread() - 0.143e-7).abs() < 1.2e-10);
    // The table is the same from either end.
    let mirrored = extrapolated_rows(&table(&VERTICAL), -20.0).expect("rows of a table")[0];
    for (a, b) in [
        (last.parabola, mirrored.parabola),
        (last.cubic, mirrored.cubic),
    ] {
        assert!((a - b).abs() < 1e-20);
    }
    assert!(
        extrapolated_rows(&table(&VERTICAL), 75.0)
            .expect("on the table")
            .is_empty()
    );
}

/// Regression, measured first on an independent prototype: fractions of random wheel sets with an indefinite
/// symmetric part; with 16 random wheels definiteness is lost above k = 8e8 lb/ft, so that a searched layout
/// loses it earlier.
#[test]
fn akispl_is_indefinite_for_as_many_layouts_as_measured() {
    let reading = printed(ReadingMethod::Akispl);
    for (wheels, asked) in [(2, 0.12), (4, 0.72), (8, 1.0)] {
        let share =
            indefinite_fraction(&strip(&reading), wheels, 2000, WHOLE).expect("on the table");
        assert!((share - asked).abs() < 0.03, "{wheels}: {share}");
        let natural =
            indefinite_fraction(&strip(&printed(ReadingMethod::Natural)), wheels, 500, WHOLE)
                .expect("on it");
        assert_eq!(natural, 0.0);
    }
    let grid = sample_places(&STATIONS, WHOLE, 100);
    let found = weakest_layouts(&strip(&reading), &[16], &grid)
        .expect("on the table")
        .remove(0);
    assert!(
        found.smallest < -1.2e-9 && found.stiffness.is_some_and(|k| k < 8e8),
        "{found:?}"
    );
}

/// The stiffness found is the limit: the Cholesky factor exists below it and not above, and no random layout
/// has a lower one.
#[test]
fn stiffness_found_is_where_definiteness_ends() {
    let reading = printed(ReadingMethod::Akispl);
    let strip = strip(&reading);
    let grid = sample_places(&STATIONS, WHOLE, 100);
    let mut random = Random::new(5);
    let mut before = f64::INFINITY;
    let all = weakest_layouts(&strip, &[2, 4, 8], &grid).expect("on the table");
    for (wheels, found) in [2, 4, 8].into_iter().zip(&all) {
        let k = found.stiffness.expect("AKISPL is indefinite");
        assert!(k < before && found.places.len() == wheels);
        before = k;
        let g = strip
            .matrix(&found.places, &found.places)
            .expect("on the table");
        let with = |k: f64| 0.5 * (&g + g.transpose()) + DMatrix::identity(wheels, wheels) / k;
        assert!(with(0.999 * k).cholesky().is_some() && with(1.001 * k).cholesky().is_none());
        for _ in 0..2000 {
            let at: Vec<f64> = (0..wheels).map(|_| random.between(-15.0, 75.0)).collect();
            let other = spectrum(&strip, &at).expect("on the table").smallest;
            assert!(
                other >= found.smallest,
                "{at:?}: {other:e} {:e}",
                found.smallest
            );
        }
    }
    let beam = Beam::paper().surface(&STATIONS);
    for sound in [&printed(ReadingMethod::Natural) as &dyn Compliance, &beam] {
        let found = weakest_layouts(&CouplingBlock::direct(sound, UP), &[4, 8], &grid)
            .expect("on the rail");
        assert!(
            found.iter().all(|layout| layout.stiffness.is_none()),
            "{found:?}"
        );
    }
}

/// Regression, measured first on an independent prototype: AKISPL 6.6 percent at 7 stations, CUBSPL 8 percent
/// in the span; independently computed: 9.19e-8 instead of 9.93e-8 ft/lb under a wheel at 23.5 ft.
#[test]
fn deviations_are_those_measured_with_their_places() {
    let beam = Beam::paper();
    let exact = beam.surface(&STATIONS);
    let (akispl, cubspl) = (
        read(ReadingMethod::Akispl, tabulate(&beam, &STATIONS)),
        read(ReadingMethod::Cubspl, tabulate(&beam, &STATIONS)),
    );
    let whole = sample_places(&STATIONS, WHOLE, 200);
    let found =
        reading_error(&strip(&akispl), &strip(&exact), &whole, &whole).expect("on the rail");
    close(found.relative(), 6.6e-2, 0.02);
    let at = found.largest;
    let there = strip(&akispl).at(at.x, at.z).expect("on it") - beam.deflection(at.x, at.z);
    assert!((there - at.value).abs() < 1e-20);
    let span = sample_places(&STATIONS, [0.0, 60.0], 200);
    let found = reading_error(&strip(&cubspl), &strip(&exact), &span, &span).expect("on the rail");
    close(found.relative(), 8.0e-2, 0.02);
    // The error of linear reading along z is largest on the diagonal.
    let diagonal = found.diagonal.expect("a direct strip");
    assert!(diagonal.value < 0.0 && diagonal.x == diagonal.z);
    close(diagonal.value, found.largest.value, 0.05);
    close(
        strip(&printed(ReadingMethod::Akispl))
            .at(23.5, 23.5)
            .expect("on it")
            / 9.93e-8
            - 1.0,
        -0.075,
        0.01,
    );
    let zero = reading_error(&strip(&exact), &strip(&exact), &span, &span).expect("on the rail");
    assert_eq!((zero.relative(), zero.largest.value), (0.0, 0.0));
}

/// No point of a fine, unrelated set of places exceeds an extreme.
#[test]
fn extremes_are_not_exceeded_between_the_places() {
    let (beam, reading) = (Beam::paper(), printed(ReadingMethod::Akispl));
    let lifted = fit_beam(0, &table(&VERTICAL)).expect("a beam on knife edges");
    let grid = sample_places(&STATIONS, WHOLE, 60);
    let skew = asymmetry(&strip(&reading), &grid).expect("on the table");
    let error = reading_error(&strip(&reading), &strip(&lifted.surface), &grid, &grid)
        .expect("on the table");
    // Regression, measured first on an independent prototype: up to 8.2 percent of the largest in the span.
    let share = skew.value / beam.deflection(30.0, 30.0);
    assert_near(
        "largest G12 - G21 at any spacing, by midspan's G",
        "prototype",
        8.2e-2,
        share,
        0.02,
    );
    let mut random = Random::new(11);
    for _ in 0..20_000 {
        let (x, z) = (random.between(-15.0, 75.0), random.between(-15.0, 75.0));
        let pair = strip(&reading)
            .matrix(&[x, z], &[x, z])
            .expect("on the table");
        assert!((pair[(0, 1)] - pair[(1, 0)]).abs() <= skew.value * (1.0 + 1e-9));
        let exact = strip(&lifted.surface).at(x, z).expect("on the rail");
        assert!((pair[(1, 0)] - exact).abs() <= error.largest.value.abs() * (1.0 + 1e-9));
    }
}

#[test]
fn printed_table_is_symmetric_has_three_digits_and_two_supports() {
    let given = table(&VERTICAL);
    assert_eq!(
        station_asymmetry(&given).map(|worst| worst.value),
        Some(0.0)
    );
    assert_eq!(
        (table_precision(&given).digits, support_stations(&given)),
        (3, vec![0.0, 60.0])
    );
    let spectrum = station_spectrum(&given).expect("square");
    assert!(spectrum.smallest > -table_precision(&given).slack && spectrum.largest > 3e-7);
    assert_eq!(
        table_precision(&tabulate(&Beam::paper(), &STATIONS)).digits,
        17
    );
    let mut skewed = given.values().clone();
    skewed[(2, 4)] += 1e-9;
    skewed[(3, 3)] = -1e-7;
    let skewed = SplineTable::new(STATIONS.to_vec(), STATIONS.to_vec(), skewed).expect("a table");
    let worst = station_asymmetry(&skewed).expect("square");
    assert!((worst.value - 1e-9).abs() < 1e-20 && (worst.x, worst.z) == (15.0, 45.0));
    assert!(station_spectrum(&skewed).expect("square").smallest < -1e-7);
    let narrow = SplineTable::new(STATIONS.to_vec(), vec![0.0, 30.0], DMatrix::zeros(2, 7))
        .expect("a table");
    assert_eq!(
        (station_asymmetry(&narrow), station_spectrum(&narrow)),
        (None, None)
    );
}

#[test]
fn places_hold_every_break_and_stay_within_their_number() {
    let found = sample_places(&STATIONS, [-10.0, 60.0], 100);
    assert!(found.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(
        [-10.0, 0.0, 15.0, 30.0, 45.0, 60.0]
            .iter()
            .all(|x| found.contains(x)),
        "{found:?}"
    );
    assert!(found.len() <= 101 && found.len() > 70);
    let many: Vec<f64> = (0..5000).map(f64::from).collect();
    assert!(sample_places(&many, [0.0, 4999.0], 300).len() <= 301);
}
