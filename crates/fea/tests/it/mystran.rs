//! Pin flags and offsets: displacements published with MYSTRAN's verification decks BAR-PINFLAG and
//! BAR-OFFSET (external).

use fea::{BeamTheory, CrossSection, Member, Model, Support, point_compliance};
use nalgebra::DVector;

const HELD: [bool; 6] = [true; 6];

fn bar(points: [usize; 2]) -> Member {
    Member::beam(points, 0, [0.0, 1.0, 0.0])
}

fn line(points: usize, pitch: f64, section: CrossSection) -> Model {
    Model {
        points: (0..points).map(|k| [pitch * k as f64, 0.0, 0.0]).collect(),
        sections: vec![section],
        members: (1..points).map(|k| bar([k - 1, k])).collect(),
        up: [0.0, 1.0, 0.0],
        theory: BeamTheory::Timoshenko,
        ..Model::default()
    }
}

/// Displacements of `points` under a load on the first of them.
fn solve(model: &Model, points: &[usize], load: [f64; 6]) -> DVector<f64> {
    let (compliance, _) = point_compliance(model, points).expect("solvable");
    compliance.columns(0, 6) * DVector::from_row_slice(&load)
}

fn compare(found: &DVector<f64>, expected: &[f64]) {
    for (k, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() < 1e-12, "degree of freedom {k}: {a} {b}");
    }
}

#[test]
fn released_bars_move_as_published() {
    let section = CrossSection {
        e: 1e7,
        g: 4e6,
        area: 0.1,
        iz: 0.01,
        iy: 0.02,
        j: 0.03,
        ..CrossSection::default()
    };
    let mut model = line(5, 1.0, section);
    model.supports = [0, 4].map(|point| Support { point, fixed: HELD }).to_vec();
    model.members[2].releases[0] = [false, true, true, true, true, true];
    let found = solve(&model, &[2, 1, 3], [200.0, 300.0, 600.0, 0.0, 0.0, 0.0]);
    compare(
        &found.rows(0, 6).into_owned(),
        &[0.0002, 0.008, 0.008, 0.0, -0.006, 0.006],
    );
    compare(
        &found.rows(6, 6).into_owned(),
        &[0.0001, 0.0025, 0.0025, 0.0, -0.0045, 0.0045],
    );
    compare(
        &found.rows(12, 6).into_owned(),
        &[0.0001, 0.0, 0.0, 0.0, 0.0, 0.0],
    );
}

#[test]
fn offset_bars_move_as_published() {
    let section = CrossSection {
        e: 1e7,
        g: 4e6,
        area: 0.1,
        iz: 0.1,
        iy: 0.1,
        j: 0.1,
        ..CrossSection::default()
    };
    let mut model = line(2, 10.0, section);
    model.supports = vec![Support {
        point: 0,
        fixed: HELD,
    }];
    model.members[0].offsets = [[0.0, 2.0, 0.0]; 2];
    let found = solve(&model, &[1], [200.0, 300.0, 600.0, 0.0, 0.0, 0.0]);
    compare(&found, &[0.04, 0.12, 0.26, -0.03, -0.03, 0.019]);
}
