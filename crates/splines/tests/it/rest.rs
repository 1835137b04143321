//! Residual flexibility: an exact surface less what shapes account for.

use crate::beam;

use std::sync::Arc;

use beam::{Beam, Random, probe};
use nalgebra::DMatrix;
use splines::{Axis, Compliance, Error, Influence, RailShapes, ResidualFlexibility};

const STATIONS: [f64; 4] = [-15.0, 0.0, 60.0, 75.0];

/// Shapes of the paper's beam by arbitrary motions of its node states, on the elements of its surface or on
/// finer ones.
fn shapes(stations: &[f64], count: usize) -> RailShapes {
    let line = Arc::clone(Beam::paper().surface(stations).rails());
    let mut random = Random::new(3);
    let states = DMatrix::from_fn(6 * line.state_count(), count, |_, _| {
        random.between(-1e-5, 1e-5)
    });
    RailShapes::new(line, states).expect("six freedoms a state")
}

/// Identity: the coefficient of every pair of probes decreases by the product of the shapes there, its slope
/// by the product of slope and shape; without shapes nothing changes.
#[test]
fn shapes_lower_the_surface_by_their_products() {
    let surface = Beam::paper().surface(&STATIONS);
    let at = [-9.0, 0.0, 13.5, 41.0, 66.0].map(|x| probe(Axis::Vertical, x));
    let mut whole = Influence::zeros(at.len());
    surface.fill(&at, &mut whole).expect("on the rail");
    for count in [0, 1, 3] {
        // The finer division has element ends where the surface has none.
        let taken = shapes(&[-15.0, 0.0, 20.0, 40.0, 60.0, 75.0], count);
        let rows = at.map(|p| {
            let (mut value, mut slope) = (vec![0.0; count], vec![0.0; count]);
            taken.row(p, &mut value, &mut slope).expect("on the rail");
            [value, slope]
        });
        let mut left = Influence::zeros(at.len());
        ResidualFlexibility::new(surface.clone(), taken)
            .fill(&at, &mut left)
            .expect("on the rail");
        for (i, [value, slope]) in rows.iter().enumerate() {
            for (j, [other, _]) in rows.iter().enumerate() {
                let sum = |a: &[f64]| a.iter().zip(other).map(|(a, b)| a * b).sum::<f64>();
                assert_eq!(left.value[(i, j)], whole.value[(i, j)] - sum(value));
                assert_eq!(left.slope[(i, j)], whole.slope[(i, j)] - sum(slope));
                assert_eq!(left.value[(i, j)], left.value[(j, i)]);
            }
        }
    }
}

/// Identity: along every element, at both ends and between, a shape is the shape row times the motions.
#[test]
fn shapes_are_shape_rows_times_their_motions() {
    let line = Arc::clone(Beam::paper().surface(&STATIONS).rails());
    let mut random = Random::new(7);
    let states = DMatrix::from_fn(6 * line.state_count(), 5, |_, _| random.between(-1.0, 1.0));
    let shapes = RailShapes::new(Arc::clone(&line), states.clone()).expect("six freedoms a state");
    let (mut value, mut slope) = ([0.0; 5], [0.0; 5]);
    for (axis, x) in [Axis::Vertical, Axis::Lateral]
        .into_iter()
        .flat_map(|axis| (0..=90).map(move |i| (axis, -15.0 + f64::from(i))))
    {
        let p = probe(axis, x);
        let Ok(row) = line.row(p) else { continue };
        shapes.row(p, &mut value, &mut slope).expect("on the rail");
        let sum = |shares: &[f64], shape: usize| -> [f64; 2] {
            let terms = row
                .indices()
                .iter()
                .zip(shares)
                .map(|(&k, share)| share * states[(k, shape)]);
            terms.fold([0.0; 2], |[sum, size], term| {
                [sum + term, size + term.abs()]
            })
        };
        for shape in 0..5 {
            for (seen, shares) in [(value[shape], row.values()), (slope[shape], row.slopes())] {
                let [sum, size] = sum(shares, shape);
                assert!(
                    (seen - sum).abs() <= 1e-14 * size,
                    "shape {shape} at {x}: {seen} for {sum}"
                );
            }
        }
    }
}

#[test]
fn shapes_of_other_rails_are_refused() {
    let line = Arc::clone(Beam::paper().surface(&STATIONS).rails());
    let rows = 6 * line.state_count();
    let wrong = RailShapes::new(line, DMatrix::zeros(rows + 1, 2));
    assert_eq!(
        wrong.err(),
        Some(Error::NodalShape {
            rows: rows + 1,
            columns: 2,
            expected: rows
        })
    );
}
