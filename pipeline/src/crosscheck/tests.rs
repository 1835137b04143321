//! Comparison and refusals, without Python.

use super::run::compare;
use super::*;
use formats::grid::block::GridBlock;
use std::path::PathBuf;

fn girder() -> PlainGirder {
    PlainGirder {
        spans: vec![60.0],
        overhangs: [15.0, 15.0],
        stations: vec![-15.0, 30.0, 75.0],
        rail_height: 3.6615,
        bending_vertical: Some(9.528 * 4.32e9),
        ..PlainGirder::default()
    }
}

fn nowhere() -> Environment {
    Environment {
        python: PathBuf::from("/no/such/python3"),
        cache: std::env::temp_dir().join("girderway-none"),
    }
}

#[test]
fn largest_difference_is_found_with_its_place() {
    let stations = [(0, 0.0), (0, 10.0)];
    let ours = vec![(GridBlock::Vertical, vec![vec![4.0, 1.0], vec![1.0, 2.0]])];
    let mut theirs = ours.clone();
    theirs[0].1[1][0] += 1e-3;
    theirs.push((GridBlock::Lateral, vec![vec![0.0; 2]; 2]));
    let (found, skipped) = compare(&ours, &theirs, &stations, PeerMeasure::Largest);
    assert_eq!(skipped, [GridBlock::Lateral]);
    assert_eq!(
        (found.len(), found[0].at, found[0].entries),
        (1, [10.0, 0.0], 4)
    );
    assert!((found[0].relative - 2.5e-4).abs() < 1e-15);
}

#[test]
fn coupling_is_measured_by_its_direct_grids() {
    let grid = |v: f64| vec![vec![v]];
    let theirs = vec![
        (GridBlock::Vertical, grid(4.0)),
        (GridBlock::Lateral, grid(9.0)),
        (GridBlock::VerticalLateral, grid(0.0)),
    ];
    let ours = vec![(GridBlock::VerticalLateral, grid(0.6))];
    let (found, _) = compare(&ours, &theirs, &[(0, 0.0)], PeerMeasure::Largest);
    assert!(
        (found[0].relative - 0.1).abs() < 1e-15,
        "0.6 of sqrt(4 x 9)"
    );
}

#[test]
fn nothing_compared_is_no_agreement() {
    let mut outcome = PeerOutcome {
        peer: Peer::ScikitFem,
        code: "scikit-fem".into(),
        elements: String::new(),
        theory: None,
        tolerance: 1e-9,
        own_tolerances: Vec::new(),
        differences: vec![],
        skipped: vec![GridBlock::Lateral],
        stations: vec![(0, 0.0)],
        notes: vec![],
        theirs: vec![],
        chosen: vec![0],
    };
    assert!(!outcome.agrees());
    assert!(outcome.table(&[]).contains("nothing compared"));
    let empty = PeerComparison {
        outcomes: vec![outcome.clone()],
        ..PeerComparison::default()
    };
    assert!(!empty.agrees() && !PeerComparison::default().agrees());
    assert!(
        PeerComparison::default()
            .table()
            .contains("nothing compared")
    );
    outcome.differences.push(BlockDifference {
        entries: 1,
        scale: 1.0,
        ours: 1.0,
        theirs: 1.0,
        profile: vec![0.0],
        ..BlockDifference::none(GridBlock::Vertical)
    });
    assert!(outcome.agrees());
    outcome.differences[0].relative = 2e-9;
    assert!(!outcome.agrees());
    assert!(outcome.table(&[]).contains("DISAGREE"));
    assert_eq!(outcome.json(&[])["agrees"], false);
}

#[test]
fn missing_python_is_named_and_nothing_is_left_behind() {
    let error =
        influence(&girder(), &nowhere(), &mut |_| {}).expect_err("there is no such program");
    assert!(matches!(error, Error::NoPython { .. }));
    assert!(error.to_string().contains("/no/such/python3"), "{error}");
    assert!(!nowhere().cache.exists());
}

#[test]
fn unusable_girders_are_refused_before_python_starts() {
    let refuse = |change: &dyn Fn(&mut PlainGirder)| {
        let mut girder = girder();
        change(&mut girder);
        influence(&girder, &nowhere(), &mut |_| {})
            .expect_err("the girder is unusable")
            .to_string()
    };
    assert!(refuse(&|g| g.spans.clear()).contains("no span"));
    assert!(refuse(&|g| g.spans[0] = -60.0).contains("length 1"));
    assert!(refuse(&|g| g.overhangs[1] = f64::NAN).contains("length 2"));
    assert!(refuse(&|g| g.bending_vertical = Some(0.0)).contains("EI_vertical"));
    assert!(refuse(&|g| g.stations[0] = -15.1).contains("station 0"));
    assert!(refuse(&|g| g.stations[1] = -15.0).contains("station 1"));
    assert!(refuse(&|g| g.stations[2] = f64::NAN).contains("station 2"));
}

#[test]
fn grids_of_another_size_are_refused() {
    let grid = vec![vec![0.0; 2]; 2];
    let run = |grid| {
        crosscheck(
            &girder(),
            &[(GridBlock::Vertical, grid)],
            1e-9,
            &nowhere(),
            &mut |_| {},
        )
    };
    assert!(matches!(
        run(grid),
        Err(Error::Shape {
            quantity: GridBlock::Vertical,
            stations: 3
        })
    ));
    let mut grid = vec![vec![0.0; 3]; 3];
    grid[1][2] = f64::NAN;
    assert!(matches!(
        run(grid),
        Err(Error::NotFinite {
            row: 1,
            column: 2,
            ..
        })
    ));
}
