//! Tables as sums of products of curves.

use crate::beam;

use beam::printed::{LATERAL, STATIONS, VERTICAL, table};
use beam::{Beam, Random, probe, read, tabulate};
use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, Error, FactorCurves, FactoredTable, Influence, InfluenceBlock, Probe, Rank,
    ReadingMethod, SplineTable, TableFactor,
};

fn fill(reading: &dyn Compliance, at: &[Probe]) -> Influence {
    let mut out = Influence::zeros(at.len());
    reading.fill(at, &mut out).expect("on the rail");
    out
}

const UP: (usize, Axis) = (0, Axis::Vertical);
const SIDE: (usize, Axis) = (0, Axis::Lateral);

fn own(way: (usize, Axis), table: SplineTable) -> InfluenceBlock {
    InfluenceBlock {
        deflection: way,
        load: way,
        table,
    }
}

fn factored(table: SplineTable, rank: Rank) -> FactoredTable {
    FactoredTable::new(&[own(UP, table)], rank).expect("one table")
}

/// Identity: W Phi Phi^T W^T = W T W^T.
#[test]
fn all_products_make_the_natural_reading() {
    let table = tabulate(&Beam::paper(), &STATIONS);
    let (natural, factored) = (
        read(ReadingMethod::Natural, table.clone()),
        factored(table, Rank::Full),
    );
    assert_eq!(factored.factors()[0].rank(), 5);
    let mut random = Random::new(5);
    for _ in 0..200 {
        let at: Vec<Probe> = (0..5)
            .map(|_| probe(Axis::Vertical, random.between(-15.0, 75.0)))
            .collect();
        let (a, b) = (fill(&natural, &at), fill(&factored, &at));
        assert!(
            (&a.value - &b.value).amax() < 1e-21,
            "{:e}",
            (&a.value - &b.value).amax()
        );
        assert!((&a.slope - &b.slope).amax() < 1e-22);
        assert_eq!(b.value, b.value.transpose());
        assert!(b.value.symmetric_eigenvalues().min() >= -1e-15 * a.value.amax());
    }
}

/// Identity: no entry changes by more than the largest dropped eigenvalue.
#[test]
fn a_tolerance_keeps_every_station_within_it() {
    let given = tabulate(&Beam::paper(), &STATIONS);
    let largest = given.values().amax();
    for tolerance in [0.0, 1e-6, 1e-3, 1e-2, 0.1, 1.0] {
        let factored = factored(given.clone(), Rank::Tolerance(tolerance));
        let factor = &factored.factors()[0];
        let curves = &factor.curves[0].values;
        let error = (curves * curves.transpose() - given.values()).amax();
        assert!(error <= factor.error_bound() + 1e-15 * largest);
        assert!(factor.error_bound() <= tolerance * largest + 1e-15 * largest);
        assert_eq!(factor.kept.len() + factor.dropped.len(), 7);
    }
    let bad = FactoredTable::new(&[own(UP, given)], Rank::Tolerance(f64::NAN)).map(|_| ());
    assert!(matches!(bad, Err(Error::Tolerance { .. })));
}

/// A printed table with a negative eigenvalue, which no structure has: it is dropped and reported.
#[test]
fn negative_eigenvalues_are_dropped_and_reported() {
    let mut values = tabulate(&Beam::paper(), &STATIONS).values().clone();
    values[(1, 1)] = -1e-8;
    let table = SplineTable::new(STATIONS.to_vec(), STATIONS.to_vec(), values).expect("a table");
    let factored = factored(table, Rank::Full);
    let factor = &factored.factors()[0];
    assert!(factor.kept.iter().all(|&value| value > 0.0));
    let worst = factor.dropped.last().copied().expect("two are dropped");
    assert!((worst / -1e-8 - 1.0).abs() < 1e-9, "{worst:e}");
}

/// Identity: coupled directions share their products; uncoupled ones have products of their own.
#[test]
fn couplings_share_their_curves() {
    let other = (1, Axis::Vertical);
    let couple = DMatrix::from_fn(7, 7, |i, j| {
        0.2 * (VERTICAL[i][j] * LATERAL[i][j]).abs().sqrt()
    });
    let couple = SplineTable::new(STATIONS.to_vec(), STATIONS.to_vec(), couple).expect("a table");
    let sheets = [
        own(UP, table(&VERTICAL)),
        InfluenceBlock {
            deflection: UP,
            load: SIDE,
            table: couple.clone(),
        },
        own(other, table(&VERTICAL)),
        own(SIDE, table(&LATERAL)),
    ];
    let factored = FactoredTable::new(&sheets, Rank::Full).expect("consistent");
    let ways: Vec<Vec<_>> = factored
        .factors()
        .iter()
        .map(|factor| factor.curves.iter().map(|c| c.direction).collect())
        .collect();
    assert_eq!(ways, [vec![UP, SIDE], vec![other]]);
    let bound = factored.factors()[0].error_bound();
    let at = [
        probe(Axis::Vertical, 15.0),
        probe(Axis::Lateral, 45.0),
        Probe {
            rail: 1,
            x: 30.0,
            ..probe(Axis::Vertical, 0.0)
        },
    ];
    let value = fill(&factored, &at).value;
    assert!((value[(0, 1)] - couple.values()[(2, 4)]).abs() <= bound + 1e-21);
    assert!((value[(1, 1)] - LATERAL[4][4]).abs() <= bound + 1e-21);
    assert_eq!((value[(0, 2)], value[(2, 1)]), (0.0, 0.0));
}

#[test]
fn curves_are_taken_back_to_the_last_bit_and_unfit_ones_refused() {
    let first = factored(table(&VERTICAL), Rank::Count(3));
    let again = FactoredTable::from_factors(first.factors().to_vec()).expect("the same curves");
    let at = [probe(Axis::Vertical, 11.0), probe(Axis::Vertical, 52.5)];
    assert_eq!(fill(&first, &at).value, fill(&again, &at).value);
    let tables = first.factors()[0].curves[0]
        .tables()
        .expect("seven stations");
    assert_eq!(
        (tables.len(), tables[0].x(), tables[0].z().len()),
        (3, &STATIONS[..], 0)
    );
    let factor = first.factors()[0].clone();
    let with = |change: &dyn Fn(&mut FactorCurves)| {
        let mut factor = factor.clone();
        change(&mut factor.curves[0]);
        FactoredTable::from_factors(vec![factor])
            .map(|_| ())
            .expect_err("refused")
    };
    assert_eq!(
        with(&|c| c.stations[2] = 40.0),
        Error::PointOrder { index: 3 }
    );
    assert!(matches!(
        with(&|c| c.values[(1, 1)] = f64::NAN),
        Error::PointNumber { .. }
    ));
    assert!(matches!(
        with(&|c| c.values = DMatrix::zeros(7, 2)),
        Error::TableShape { .. }
    ));
    assert_eq!(
        FactoredTable::from_factors(vec![]).map(|_| ()),
        Err(Error::NoBlocks)
    );
    let twice: Vec<TableFactor> = vec![factor.clone(), factor];
    assert!(matches!(
        FactoredTable::from_factors(twice),
        Err(Error::BlockTwice { .. })
    ));
    let off = first.fill(&[probe(Axis::Vertical, 76.0)], &mut Influence::zeros(1));
    assert_eq!(off, Err(Error::OffRail { rail: 0, x: 76.0 }));
}
