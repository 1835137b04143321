//! The fewest stations for a reading and a tolerance.

use crate::beam;

use beam::{Beam, EI, Random, coupled};
use splines::quality::{CouplingBlock, sample_places, station_error};
use splines::{
    Axis, Compliance, Error, FactoredTable, InfluenceBlock, Rank, ReadingMethod, StationSearch,
    StationSet, TableReading, fewest_stations, fit_beam,
};

type Read = Box<splines::quality::MakeReading<'static>>;

const VERTICAL: &[Axis] = &[Axis::Vertical];

fn kind(kind: ReadingMethod) -> Read {
    Box::new(move |sheets| Ok(Box::new(TableReading::new(kind, sheets)?)))
}

fn raised() -> Read {
    Box::new(|sheets| Ok(Box::new(fit_beam(0, &sheets[0].table)?.surface)))
}

fn search<'a>(
    exact: &'a dyn Compliance,
    fixed: &'a [f64],
    range: [f64; 2],
    read: &'a Read,
    order: f64,
) -> StationSearch<'a> {
    StationSearch {
        exact,
        rail: 0,
        axes: VERTICAL,
        range,
        fixed,
        read,
        order,
        tolerance: 1e-2,
        max_stations: 400,
    }
}

/// The paper's girder with equal distances: -15 + 90 k/(6 m), so that both supports are stations.
fn equal(search: &StationSearch<'_>) -> usize {
    let at = |m: u32| -> Vec<f64> {
        (0..=6 * m)
            .map(|k| -15.0 + 15.0 * f64::from(k) / f64::from(m))
            .collect()
    };
    let found = (1..80)
        .map(at)
        .find(|at| station_error(search, at).is_ok_and(|e| e.error <= search.tolerance));
    found.map_or(usize::MAX, |at| at.len())
}

fn holds(found: &StationSet, fixed: &[f64], range: [f64; 2]) {
    assert!(found.at.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!([found.at[0], found.at[found.at.len() - 1]], range);
    assert!(fixed.iter().all(|x| found.at.contains(x)), "{:?}", found.at);
}

/// Analytic: the force method, at places that are independent of those of the search, some just beside
/// stations.
#[test]
fn error_found_is_never_exceeded_and_supports_are_stations() {
    let (beam, range, fixed) = (Beam::paper(), [-15.0, 75.0], [0.0, 60.0]);
    let exact = beam.surface(&[-15.0, 0.0, 60.0, 75.0]);
    let scale = beam.deflection(75.0, 75.0);
    for (how, order) in [
        (ReadingMethod::Akispl, 2.0),
        (ReadingMethod::Cubspl, 2.0),
        (ReadingMethod::Natural, 3.0),
    ] {
        let read = kind(how);
        for tolerance in [1e-2, 1e-3] {
            let search = StationSearch {
                tolerance,
                ..search(&exact, &fixed, range, &read, order)
            };
            let found = fewest_stations(&search).expect("some number is enough");
            holds(&found, &fixed, range);
            assert!(
                found.error <= tolerance && found.error > 0.5 * tolerance,
                "{how:?} {found:?}"
            );
            let table = beam::tabulate(&beam, &found.at);
            let reading = beam::read(how, table);
            let strip = CouplingBlock::direct(&reading, (0, Axis::Vertical));
            let mut random = Random::new(3);
            for k in 0..20_000 {
                let mut at = [random.between(-15.0, 75.0), random.between(-15.0, 75.0)];
                if k % 4 == 0 {
                    at[0] = (found.at[k % found.at.len()] + 1e-6 * random.between(-1.0, 1.0))
                        .clamp(-15.0, 75.0);
                }
                if k % 3 == 0 {
                    at[1] = at[0];
                }
                let error = strip.at(at[0], at[1]).expect("on it") - beam.deflection(at[0], at[1]);
                assert!(
                    error.abs() / scale <= found.error * (1.0 + 1e-6) + 1e-12,
                    "{how:?} {at:?}"
                );
            }
            let at = found.worst;
            let there = strip.at(at.x, at.z).expect("on it") - beam.deflection(at.x, at.z);
            assert!(
                (there / at.value - 1.0).abs() < 1e-9
                    && (at.value.abs() / scale / found.error - 1.0).abs() < 1e-9
            );
        }
    }
}

/// One station fewer fails: with any one removed, at equal distances, and with the best placement of one
/// fewer.
#[test]
fn one_station_fewer_fails() {
    let (beam, range, fixed) = (Beam::paper(), [-15.0, 75.0], [0.0, 60.0]);
    let exact = beam.surface(&[-15.0, 0.0, 60.0, 75.0]);
    for (how, order, asked) in [
        (ReadingMethod::Akispl, 2.0, [16, 46]),
        (ReadingMethod::Natural, 3.0, [7, 13]),
    ] {
        let read = kind(how);
        for (tolerance, asked) in [1e-2, 1e-3].into_iter().zip(asked) {
            let search = StationSearch {
                tolerance,
                ..search(&exact, &fixed, range, &read, order)
            };
            let found = fewest_stations(&search).expect("some number is enough");
            // Regression: the numbers that the book states.
            assert_eq!(found.at.len(), asked, "{how:?} {tolerance}");
            assert!(equal(&search) >= found.at.len());
            for k in (1..found.at.len() - 1).filter(|&k| !fixed.contains(&found.at[k])) {
                let mut fewer = found.at.clone();
                fewer.remove(k);
                assert!(
                    station_error(&search, &fewer).expect("on it").error > tolerance,
                    "{how:?} without {k}"
                );
            }
            let short = fewest_stations(&StationSearch {
                max_stations: found.at.len() - 1,
                ..search
            });
            assert!(
                matches!(short, Err(Error::TooFewStations { error, .. }) if error > tolerance),
                "{how:?}"
            );
        }
    }
}

/// Equal distances waste stations where spans differ; a stretch between breaks keeps at least its two ends.
#[test]
fn unequal_spans_and_stiffness_get_stations_where_they_need_them() {
    let beam = Beam {
        c: 1.0 / EI,
        g: 0.0,
        supports: vec![0.0, 20.0, 80.0, 90.0],
    };
    let (range, fixed) = ([0.0, 90.0], [20.0, 80.0]);
    let exact = beam.surface(&[0.0, 20.0, 80.0, 90.0]);
    let read = kind(ReadingMethod::Akispl);
    let search = search(&exact, &fixed, range, &read, 2.0);
    let found = fewest_stations(&search).expect("some number is enough");
    holds(&found, &fixed, range);
    let within = |a: f64, b: f64| found.at.iter().filter(|x| **x > a && **x < b).count();
    assert!(
        within(20.0, 80.0) >= 12 && within(0.0, 20.0) <= 3 && within(80.0, 90.0) <= 1,
        "{:?}",
        found.at
    );
    let equal = (9..200).step_by(9).find(|&n| {
        let at: Vec<f64> = (0..=n)
            .map(|k| 90.0 * f64::from(k) / f64::from(n))
            .collect();
        station_error(&search, &at).is_ok_and(|e| e.error <= 1e-2)
    });
    assert!(
        equal.is_some_and(|n| n as usize + 1 > found.at.len() + 3),
        "{equal:?} {}",
        found.at.len()
    );
}

/// The exact form needs only the breaks, and the four stations of a SPLINE.
#[test]
fn exact_reading_needs_breaks_alone() {
    let beam = Beam::paper();
    let exact = beam.surface(&[-15.0, 0.0, 60.0, 75.0]);
    let read = raised();
    let search = StationSearch {
        tolerance: 1e-12,
        ..search(&exact, &[0.0, 60.0], [-15.0, 75.0], &read, 3.0)
    };
    let found = fewest_stations(&search).expect("the exact form");
    assert_eq!(found.at, [-15.0, 0.0, 60.0, 75.0]);
    assert!(found.error < 1e-13, "{:e}", found.error);
}

/// All directions and their couplings at the same stations: the worst of them counts.
#[test]
fn couplings_keep_the_tolerance_too() {
    let exact = coupled();
    let read = kind(ReadingMethod::Cubspl);
    let fixed = exact.breaks(0);
    let all = StationSearch {
        tolerance: 0.05,
        axes: &Axis::ALL,
        ..search(&exact, &fixed, [-15.0, 75.0], &read, 2.0)
    };
    let found = fewest_stations(&all).expect("some number is enough");
    holds(&found, &fixed, [-15.0, 75.0]);
    let table = |deflection, load| CouplingBlock {
        compliance: &exact,
        deflection: (0, deflection),
        load: (0, load),
    };
    let dense = sample_places(&fixed, [-15.0, 75.0], 90);
    let largest = |axis| {
        table(axis, axis)
            .matrix(&dense, &dense)
            .expect("on the rail")
            .amax()
    };
    let mut sheets = Vec::new();
    for (a, &deflection) in Axis::ALL.iter().enumerate() {
        for &load in &Axis::ALL[a..] {
            let values = table(deflection, load)
                .matrix(&found.at, &found.at)
                .expect("on the rail");
            let table = splines::SplineTable::new(found.at.clone(), found.at.clone(), values)
                .expect("stations");
            sheets.push(InfluenceBlock {
                deflection: (0, deflection),
                load: (0, load),
                table,
            });
        }
    }
    let reading = TableReading::new(ReadingMethod::Cubspl, &sheets).expect("consistent");
    for deflection in Axis::ALL {
        for load in Axis::ALL {
            let own = CouplingBlock {
                compliance: &reading,
                ..table(deflection, load)
            };
            let error = own.matrix(&dense, &dense).expect("on it")
                - table(deflection, load)
                    .matrix(&dense, &dense)
                    .expect("on it");
            let scale = (largest(deflection) * largest(load)).sqrt();
            assert!(
                error.amax() <= found.error * scale * 1.001,
                "{deflection:?} {load:?}"
            );
        }
    }
}

/// Regression: the table of stations in the book, fewest found compared with equal distances, on the paper's
/// girder.
#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "slow: hundreds of stations for 1e-4, half a minute"
)]
fn stations_of_every_reading_are_those_of_the_book() {
    let (beam, range, fixed) = (Beam::paper(), [-15.0, 75.0], [0.0, 60.0]);
    let exact = beam.surface(&[-15.0, 0.0, 60.0, 75.0]);
    let factored: Read = Box::new(|sheets| Ok(Box::new(FactoredTable::new(sheets, Rank::Full)?)));
    let readings: [(&str, Read, f64, [[usize; 2]; 3]); 6] = [
        (
            "akispl",
            kind(ReadingMethod::Akispl),
            2.0,
            [[16, 19], [46, 55], [143, 169]],
        ),
        (
            "symmetrised",
            kind(ReadingMethod::Symmetrised),
            2.0,
            [[14, 19], [40, 55], [122, 169]],
        ),
        (
            "cubspl",
            kind(ReadingMethod::Cubspl),
            2.0,
            [[16, 19], [46, 55], [143, 169]],
        ),
        (
            "natural",
            kind(ReadingMethod::Natural),
            3.0,
            [[7, 7], [13, 19], [28, 31]],
        ),
        ("factored", factored, 3.0, [[7, 7], [13, 19], [28, 31]]),
        ("exact", raised(), 3.0, [[4, 7], [4, 7], [4, 7]]),
    ];
    for (name, read, order, asked) in &readings {
        for (tolerance, asked) in [1e-2, 1e-3, 1e-4].into_iter().zip(asked) {
            let search = StationSearch {
                tolerance,
                ..search(&exact, &fixed, range, read, *order)
            };
            let found = fewest_stations(&search).expect("some number is enough");
            assert_eq!(
                [found.at.len(), equal(&search)],
                *asked,
                "{name} {tolerance}"
            );
        }
    }
}

/// No random search finds a set with one station fewer within the tolerance: each set that lacks one station
/// is moved at random, and every step that lowers the error is kept.
#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "slow: tens of thousands of sets, a minute"
)]
fn random_search_finds_no_set_with_one_station_fewer() {
    let fixed = [0.0, 60.0];
    let exact = Beam::paper().surface(&[-15.0, 0.0, 60.0, 75.0]);
    for (how, order, tolerance, steps) in [
        (ReadingMethod::Akispl, 2.0, 1e-2, 2000),
        (ReadingMethod::Natural, 3.0, 1e-2, 1000),
        (ReadingMethod::Natural, 3.0, 1e-3, 2000),
    ] {
        let read = kind(how);
        let search = StationSearch {
            tolerance,
            ..search(&exact, &fixed, [-15.0, 75.0], &read, order)
        };
        let found = fewest_stations(&search).expect("some number is enough");
        for k in (1..found.at.len() - 1).filter(|&k| !fixed.contains(&found.at[k])) {
            let mut at = found.at.clone();
            at.remove(k);
            let mut now = station_error(&search, &at).expect("on the rail");
            let (mut random, mut step) = (Random::new(7 + k as u64), 2.0_f64);
            for _ in 0..steps {
                let mut at = now.at.clone();
                let end = at.len() - 1;
                for x in at[1..end].iter_mut().filter(|x| !fixed.contains(x)) {
                    *x += if random.unit() < 0.4 {
                        step * random.between(-1.0, 1.0)
                    } else {
                        0.0
                    };
                }
                if at.windows(2).any(|pair| pair[1] - pair[0] < 0.2) {
                    continue;
                }
                let moved = station_error(&search, &at).expect("on the rail");
                step = if moved.error < now.error {
                    (1.5 * step).min(3.0)
                } else {
                    (0.98 * step).max(0.02)
                };
                if moved.error < now.error {
                    now = moved;
                }
            }
            assert!(now.error > tolerance, "{how:?} {tolerance}: {:?}", now.at);
        }
    }
}
