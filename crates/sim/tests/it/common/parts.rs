//! The paper's girder as two rigid halves joined by a beam.

use std::sync::Arc;

use nalgebra::{DMatrix, Matrix2, Matrix4, Matrix4x2};
use sim::{Dynamics, Extent, Foundation, PartChain, PartShapes, Structure};
use splines::{Flexibility, RailElement, Rails};

use super::EI;

/// States (v, rotation) of both centres per unit rotation of each part about its own support.
pub fn basis() -> Matrix4x2<f64> {
    Matrix4x2::new(7.5, 0.0, 1.0, 0.0, 0.0, -7.5, 0.0, 1.0)
}

/// Euler-Bernoulli beam of length `l`: v and slope at both ends.
pub fn beam(l: f64) -> Matrix4<f64> {
    let (a, b, c) = (6.0 * l, 4.0 * l * l, 2.0 * l * l);
    Matrix4::new(
        12.0, a, -12.0, a, a, b, -a, c, -12.0, -a, 12.0, -a, a, c, -a, b,
    ) * (EI / l.powi(3))
}

/// Stiffness of the parts' rotations: the beam of 45 ft between the centres.
pub fn stiffness() -> Matrix2<f64> {
    basis().transpose() * beam(45.0) * basis()
}

/// Places of v and rotation of both centres among the twelve states.
pub const STATES: [usize; 4] = [1, 5, 7, 11];

/// Rigid parts over the whole girder about `centres`, each on a rail of its own.
pub fn arms(centres: &[f64]) -> Arc<Rails> {
    let cells = centres.iter().enumerate().map(|(j, centre)| RailElement {
        rail: j,
        x: [-15.0, 75.0],
        ends: [j, j],
        length: 90.0,
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        offset: [-15.0 - centre, 0.0, 0.0],
        flexibility: Flexibility::default(),
        member: None,
    });
    Arc::new(Rails::new(cells.collect()).expect("rigid arms"))
}

/// Centres of the two halves.
pub const CENTRES: [f64; 2] = [7.5, 52.5];

/// Two halves, the datum blended over `window` about the joint; `None`: from centre to centre.
pub fn chain(window: Option<f64>) -> PartChain {
    PartChain::new(vec![-15.0, 30.0, 75.0], 0, window).expect("one joint")
}

/// Moment of inertia of a half about its support, `factor` times that of 15.2 slug/ft.
pub fn inertia(factor: f64) -> f64 {
    factor * 15.2 * 45.0 * (45.0 * 45.0 / 12.0 + 7.5 * 7.5)
}

/// Parts with mass: rotations about the supports as freedoms.
pub fn massive(factor: f64) -> Foundation {
    let stiffness = stiffness();
    let mut states = DMatrix::zeros(12, 2);
    for (i, &row) in STATES.iter().enumerate() {
        for k in 0..2 {
            states[(row, k)] = basis()[(i, k)];
        }
    }
    let chain = chain(Some(60.0));
    Foundation {
        rails: vec![Extent {
            range: Some(chain.range()),
            breaks: chain.breaks(),
        }],
        structure: Some(Structure {
            dynamics: Dynamics::Matrices {
                mass: DMatrix::identity(2, 2) * inertia(factor),
                damping: DMatrix::zeros(2, 2),
                stiffness: DMatrix::from_fn(2, 2, |i, j| stiffness[(i, j)]),
            },
            shapes: Box::new(PartShapes {
                line: arms(&CENTRES),
                basis: states,
                chains: vec![chain],
                separate: false,
            }),
        }),
        ..Foundation::default()
    }
}
