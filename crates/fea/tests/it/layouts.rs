//! Random layouts of wheels on three structures: their influence matrices always allow the contact to be solved.

use crate::common;

use common::{Stream, mill, paper};
use fea::{BeamTheory, Girder, surface};
use nalgebra::{Cholesky, DMatrix};
use splines::{Axis, Compliance, ExactSurface, Influence, Probe};

/// Coordinates of the ends of one rail, and the axes in which its wheels press.
struct Case {
    name: &'static str,
    surface: ExactSurface,
    range: [f64; 2],
    axes: &'static [Axis],
    /// Softest and stiffest wheel, in the structure's units.
    wheels: [f64; 2],
}

/// The paper's girder; three uneven spans with shear and overhangs; a mill building's girder, coupled in space.
fn cases() -> [Case; 3] {
    let spans = Girder {
        spans: vec![20.0, 45.0, 35.0],
        overhangs: [5.0, 10.0],
        ka_vertical: Some(0.35),
        ka_lateral: Some(0.35),
        theory: BeamTheory::Timoshenko,
        stations: vec![0.0, 20.0, 65.0, 100.0],
        ..paper()
    };
    let straight = |girder: &Girder| {
        let (model, rail) = girder.model_and_rail().expect("sound");
        surface(&model, &[rail]).expect("solvable").surface
    };
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let building = surface(&model, &[rail]).expect("solvable").surface;
    let case = |name, surface: ExactSurface, axes| {
        let range = surface.range(0).expect("a rail");
        Case {
            name,
            surface,
            range,
            axes,
            wheels: [1e4, 1e12],
        }
    };
    [
        case("one span", straight(&paper()), &Axis::ALL[1..2]),
        case("three spans with shear", straight(&spans), &Axis::ALL[1..2]),
        case("mill girderway", building, &Axis::ALL),
    ]
}

/// Two to eight wheels anywhere, or close together (1e-4 to 0.1 of the rail apart).
fn layout(case: &Case, random: &mut Stream) -> Vec<Probe> {
    let [first, last] = case.range;
    let n = 2 + (7.0 * random.next()) as usize;
    let pitch = (last - first) * 10.0_f64.powf(random.between(-4.0, -1.0));
    let close = random.next() < 0.5;
    let start = random.between(first, last);
    let place = |random: &mut Stream, k: usize| {
        let x = if close {
            start + pitch * k as f64
        } else {
            random.between(first, last)
        };
        if x > last {
            first + (x - last) % (last - first)
        } else {
            x
        }
    };
    (0..n)
        .map(|k| {
            let x = place(random, k);
            let axis = case.axes[(case.axes.len() as f64 * random.next()) as usize];
            Probe { rail: 0, x, axis }
        })
        .collect()
}

/// Smallest eigenvalue found, relative to the largest of its matrix.
fn check(case: &Case, layouts: usize, seed: u64) -> f64 {
    let mut random = Stream::new(seed);
    let mut worst = f64::INFINITY;
    for _ in 0..layouts {
        let at = layout(case, &mut random);
        let n = at.len();
        let mut out = Influence::zeros(n);
        case.surface.fill(&at, &mut out).expect("on the rail");
        for i in 0..n {
            for j in 0..i {
                assert_eq!(
                    out.value[(i, j)].to_bits(),
                    out.value[(j, i)].to_bits(),
                    "{} {at:?}",
                    case.name
                );
            }
        }
        for k in 0..=4 {
            let stiffness =
                case.wheels[0] * (case.wheels[1] / case.wheels[0]).powf(f64::from(k) / 4.0);
            let sum = &out.value + DMatrix::from_diagonal_element(n, n, 1.0 / stiffness);
            assert!(
                Cholesky::new(sum).is_some(),
                "{} k = {stiffness:e} {at:?}",
                case.name
            );
        }
        let eigenvalues = out.value.symmetric_eigenvalues();
        let share = eigenvalues.min() / eigenvalues.max();
        assert!(share >= -1e-13, "{} {share:e} {at:?}", case.name);
        worst = worst.min(share);
    }
    worst
}

/// Identity: Maxwell's law and positive energy, 10,000 layouts a structure.
#[test]
fn ten_thousand_layouts_are_symmetric_positive_and_factorise() {
    for (seed, case) in cases().iter().enumerate() {
        check(case, 10_000, seed as u64);
    }
}

/// The same, a million layouts a structure; prints the least eigenvalue of each.
#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "slow: a million layouts on each of three structures"
)]
fn a_million_layouts_are_symmetric_positive_and_factorise() {
    for (seed, case) in cases().iter().enumerate() {
        println!(
            "{}: {:e}",
            case.name,
            check(case, 1_000_000, 100 + seed as u64)
        );
    }
}
