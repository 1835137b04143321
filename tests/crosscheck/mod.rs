//! The other codes against closed forms, and the program against them.
//!
//! Needs Python 3.11 with venv, and PyPI the first time; the environment stays in the target directory.

use formats::grid::block::GridBlock;
use girderway::crosscheck::{Environment, PeerOutcome, PlainGirder, crosscheck};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

mod codes;

type Grid = Vec<Vec<f64>>;

/// Bending stiffness of the paper's girder, lbf ft^2.
const EI: f64 = 9.528 * 4.32e9;

/// Influence coefficients of the simply supported 60 ft girder with overhangs of 15 ft, ft/lbf.
/// Source: analytic, force method.
pub const PAPER: [[f64; 7]; 7] = [
    [
        1.3665862020710885e-07,
        0.0,
        -7.174577560873216e-08,
        -8.199517212426532e-08,
        -5.1246982577665826e-08,
        0.0,
        5.466344808284355e-08,
    ],
    [0.0; 7],
    [
        -7.174577560873216e-08,
        0.0,
        6.149637909319899e-08,
        7.516224111390987e-08,
        4.783051707248811e-08,
        0.0,
        -5.124698257766582e-08,
    ],
    [
        -8.199517212426533e-08,
        0.0,
        7.516224111390987e-08,
        1.0932689616568709e-07,
        7.516224111390989e-08,
        0.0,
        -8.199517212426531e-08,
    ],
    [
        -5.1246982577665826e-08,
        0.0,
        4.783051707248811e-08,
        7.516224111390989e-08,
        6.149637909319899e-08,
        0.0,
        -7.174577560873216e-08,
    ],
    [0.0; 7],
    [
        5.466344808284353e-08,
        0.0,
        -5.124698257766582e-08,
        -8.199517212426532e-08,
        -7.174577560873216e-08,
        0.0,
        1.3665862020710885e-07,
    ],
];

/// Both constants reproduce the paper's printed lateral table: 1/EI_lateral and rail_height^2/GJ.
const LATERAL: [f64; 2] = [2.6456e-10, 1.2315e-8];
const HEIGHT: f64 = 3.6615;

fn paper() -> PlainGirder {
    PlainGirder {
        spans: vec![60.0],
        overhangs: [15.0, 15.0],
        stations: vec![-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0],
        rail_height: HEIGHT,
        axial: Some(4.32e9),
        bending_vertical: Some(EI),
        bending_lateral: Some(1.0 / LATERAL[0]),
        torsion: Some(HEIGHT * HEIGHT / LATERAL[1]),
        ..PlainGirder::default()
    }
}

/// The environment, made by the first test that needs it.
pub fn environment() -> &'static Environment {
    static MADE: OnceLock<Environment> = OnceLock::new();
    MADE.get_or_init(|| {
        let environment = Environment {
            python: "python3".into(),
            cache: cache().join("girderway"),
        };
        let prepared = environment.prepare(&mut |_| {});
        prepared.unwrap_or_else(|error| panic!("the other codes cannot be installed: {error}"));
        environment
    })
}

/// What the program takes for the user's cache.
pub fn cache() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("python")
}

fn compare(girder: &PlainGirder, ours: &[(GridBlock, Grid)], tolerance: f64) -> PeerOutcome {
    crosscheck(girder, ours, tolerance, environment(), &mut |_| {})
        .unwrap_or_else(|error| panic!("{error}"))
}

/// A grid from a function of the stations of deflection and load.
fn grid(stations: &[f64], entry: impl Fn(f64, f64) -> f64) -> Grid {
    stations
        .iter()
        .map(|x| stations.iter().map(|z| entry(*x, *z)).collect())
        .collect()
}

/// Twist at x from a unit torque at z, times GJ: linear in the span, constant beyond the outer supports.
/// Source: analytic; the twist is held at 0 and at the span, and overhangs are cantilevers.
fn twist(span: f64, x: f64, z: f64) -> f64 {
    let (near, far) = (x.min(z), x.max(z));
    if near >= 0.0 && far <= span {
        near * (span - far) / span
    } else if far < 0.0 {
        -far
    } else if near > span {
        near - span
    } else {
        0.0
    }
}

/// Influence function of a girder on two supports with overhangs: a kernel of the distance, projected onto
/// zero at both supports. |r|^3 / 12 EI for bending, -|r| / 2 kGA for shear.
/// Source: analytic; the kernel solves the beam's equation, the projection adds a rigid motion and reactions.
fn pinned(span: f64, x: f64, z: f64, kernel: impl Fn(f64) -> f64) -> f64 {
    let kernel = |a: f64, b: f64| kernel((a - b).abs());
    let weights = |a: f64| [1.0 - a / span, a / span];
    let supports = [0.0, span];
    let mut total = kernel(x, z);
    for i in 0..2 {
        total -= weights(x)[i] * kernel(supports[i], z) + weights(z)[i] * kernel(x, supports[i]);
        for j in 0..2 {
            total += weights(x)[i] * weights(z)[j] * kernel(supports[i], supports[j]);
        }
    }
    total
}

#[test]
fn scikit_fem_reproduces_the_closed_forms_of_the_papers_girder() {
    let girder = paper();
    let vertical: Grid = PAPER.iter().map(|row| row.to_vec()).collect();
    // Bending scales with 1/EI, and the rail adds the twist times its height.
    let mut lateral = grid(&girder.stations, |x, z| LATERAL[1] * twist(60.0, x, z));
    for (row, bending) in lateral.iter_mut().zip(&PAPER) {
        for (entry, bending) in row.iter_mut().zip(bending) {
            *entry += bending * EI * LATERAL[0];
        }
    }
    let zero = grid(&girder.stations, |_, _| 0.0);
    let ours = [
        (GridBlock::Vertical, vertical),
        (GridBlock::Lateral, lateral),
        (GridBlock::VerticalLateral, zero),
    ];
    let outcome = compare(&girder, &ours, 1e-11);
    assert!(outcome.agrees(), "{}", outcome.table(&[]));
    assert_eq!(outcome.differences.len(), 3, "{}", outcome.table(&[]));
    assert_eq!(outcome.code, "scikit-fem 12.0.2");
}

#[test]
fn scikit_fem_reproduces_the_longitudinal_closed_forms_at_the_supports() {
    // Slope of a simply supported span at its ends from moments at its ends: L/3EI and -L/6EI.
    let girder = PlainGirder {
        overhangs: [0.0; 2],
        stations: vec![0.0, 60.0],
        ..paper()
    };
    let bending = HEIGHT * HEIGHT * 60.0 / EI;
    let longitudinal = grid(
        &girder.stations,
        |x, z| if x == z { bending / 3.0 } else { -bending / 6.0 } + x.min(z) / 4.32e9,
    );
    let outcome = compare(&girder, &[(GridBlock::Longitudinal, longitudinal)], 1e-12);
    assert!(outcome.agrees(), "{}", outcome.table(&[]));
}

#[test]
fn longitudinal_load_at_the_rail_head_bends_the_span_as_a_moment() {
    // A load P along +x at a height h over x = 0 is a moment -h P: midspan moves by -M L^2 / 16 EI, down for
    // a moment that turns the end upwards. Source: analytic, end moment on a simply supported span.
    let girder = PlainGirder {
        overhangs: [0.0; 2],
        stations: vec![0.0, 30.0, 60.0],
        ..paper()
    };
    let zero = grid(&girder.stations, |_, _| 0.0);
    let outcome = compare(&girder, &[(GridBlock::VerticalLongitudinal, zero)], 1e-9);
    let worst = &outcome.differences[0];
    let expected = HEIGHT * 3600.0 / (16.0 * EI);
    assert_eq!(worst.at[0], 30.0, "midspan moves most");
    // Moments at both ends move midspan by the same size; loads at x = 0 push it down, at x = 60 up.
    let sign = if worst.at[1] == 0.0 { -1.0 } else { 1.0 };
    assert!(
        (worst.theirs / (sign * expected) - 1.0).abs() < 1e-12,
        "{}",
        outcome.table(&[])
    );
}

#[test]
fn scikit_fem_reproduces_the_two_span_girder() {
    // Source: analytic, three-moment equation: 23/1536 and -9/1536 of L^3/EI at midspans, and the rest.
    let unit = 60f64.powi(3) / EI;
    let girder = PlainGirder {
        spans: vec![60.0, 60.0],
        overhangs: [0.0; 2],
        stations: vec![0.0, 30.0, 60.0, 90.0, 120.0],
        ..paper()
    };
    let (near, far) = (23.0 / 1536.0 * unit, -9.0 / 1536.0 * unit);
    let midspan = |x: f64| x == 30.0 || x == 90.0;
    let vertical = grid(&girder.stations, |x, z| {
        match (midspan(x) && midspan(z), x == z) {
            (true, true) => near,
            (true, false) => far,
            (false, _) => 0.0,
        }
    });
    let outcome = compare(&girder, &[(GridBlock::Vertical, vertical)], 1e-12);
    assert!(outcome.agrees(), "{}", outcome.table(&[]));
}

#[test]
fn scikit_fem_reproduces_the_girder_that_shears() {
    let rigidity = 1e8;
    let girder = PlainGirder {
        shear_vertical: Some(rigidity),
        ..paper()
    };
    let stations = girder.stations.clone();
    let mut vertical = grid(&stations, |x, z| {
        pinned(60.0, x, z, |r| -0.5 * r / rigidity)
    });
    for (row, bending) in vertical.iter_mut().zip(&PAPER) {
        row.iter_mut()
            .zip(bending)
            .for_each(|(entry, bending)| *entry += bending);
    }
    let outcome = compare(&girder, &[(GridBlock::Vertical, vertical)], 1e-11);
    assert!(outcome.agrees(), "{}", outcome.table(&[]));
}

#[test]
fn many_stations_cost_no_digits() {
    // Reads of 181 stations stay within the tolerance, though a mesh of 180 elements would not.
    let stations: Vec<f64> = (0..=180).map(|i| -15.0 + 0.5 * f64::from(i)).collect();
    let vertical = grid(&stations, |x, z| {
        pinned(60.0, x, z, |r| r.powi(3) / (12.0 * EI))
    });
    let outcome = compare(
        &PlainGirder {
            stations,
            ..paper()
        },
        &[(GridBlock::Vertical, vertical)],
        1e-9,
    );
    assert!(outcome.agrees(), "{}", outcome.table(&[]));
}

#[test]
fn a_wrong_grid_is_found() {
    let mut vertical: Grid = PAPER.iter().map(|row| row.to_vec()).collect();
    vertical[2][4] += 3e-9 * 1.3665862020710885e-07;
    let outcome = compare(&paper(), &[(GridBlock::Vertical, vertical)], 1e-9);
    assert!(!outcome.agrees());
    assert_eq!(outcome.differences[0].at, [15.0, 45.0]);
}
