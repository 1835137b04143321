//! A uniform straight beam on rigid supports by the force method: an independent computation of every
//! coefficient.
//!
//! The field of an infinite beam is superposed with reactions and a rigid motion a + b x, without elements,
//! shape functions or clamped elements.
#![allow(dead_code)]

#[path = "../../../../../tests/near.rs"]
pub mod near;
pub mod printed;

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use splines::{
    Axis, ExactSurface, Flexibility, InfluenceBlock, Probe, RailElement, Rails, ReadingMethod,
    SplineTable, TableReading,
};

/// EI of the paper's girder, lb ft^2.
pub const EI: f64 = 9.528 * 4.32e9;

/// c = 1/EI, g = 1/kGA; supports hold the deflection alone, except that ends may be free.
pub struct Beam {
    pub c: f64,
    pub g: f64,
    pub supports: Vec<f64>,
}

/// A load or the displacement that belongs to it: force and deflection, or moment and rotation.
#[derive(Clone, Copy, PartialEq)]
pub enum Effect {
    Force,
    Moment,
}

impl Beam {
    pub fn paper() -> Beam {
        Beam {
            c: 1.0 / EI,
            g: 0.0,
            supports: vec![0.0, 60.0],
        }
    }

    /// Field of the infinite beam at x under a unit load at z, up to a rigid motion.
    fn free(&self, at: Effect, x: f64, load: Effect, z: f64) -> f64 {
        let r = x - z;
        match (at, load) {
            (Effect::Force, Effect::Force) => {
                self.c * r.abs().powi(3) / 12.0 - 0.5 * self.g * r.abs()
            }
            (Effect::Moment, Effect::Force) => self.c * r * r.abs() / 4.0,
            (Effect::Force, Effect::Moment) => -self.c * r * r.abs() / 4.0,
            (Effect::Moment, Effect::Moment) => -self.c * r.abs() / 2.0,
        }
    }

    /// Deflection or rotation at x under a unit force or moment at z.
    pub fn give(&self, at: Effect, x: f64, load: Effect, z: f64) -> f64 {
        let n = self.supports.len();
        // Unknowns: upward reactions, then a, b. Equations: no deflection at supports, no net force or
        // moment.
        let mut matrix = DMatrix::zeros(n + 2, n + 2);
        let mut right = DVector::zeros(n + 2);
        for (i, &s) in self.supports.iter().enumerate() {
            for (j, &t) in self.supports.iter().enumerate() {
                matrix[(i, j)] = self.free(Effect::Force, s, Effect::Force, t) * EI;
            }
            matrix[(i, n)] = 1.0;
            matrix[(i, n + 1)] = s;
            matrix[(n, i)] = 1.0;
            matrix[(n + 1, i)] = s;
            right[i] = -self.free(Effect::Force, s, load, z) * EI;
        }
        (right[n], right[n + 1]) = if load == Effect::Force {
            (-1.0, -z)
        } else {
            (0.0, -1.0)
        };
        let solved = matrix.lu().solve(&right).expect("two supports hold a beam");
        let rigid = if at == Effect::Force {
            solved[n] + solved[n + 1] * x
        } else {
            solved[n + 1]
        };
        let mut sum = self.free(at, x, load, z) + rigid / EI;
        for (i, &s) in self.supports.iter().enumerate() {
            sum += solved[i] * self.free(at, x, Effect::Force, s);
        }
        sum
    }

    pub fn deflection(&self, x: f64, z: f64) -> f64 {
        self.give(Effect::Force, x, Effect::Force, z)
    }

    /// Exact surface of the vertical direction with node states at `stations`, their compliance by the force
    /// method.
    pub fn surface(&self, stations: &[f64]) -> ExactSurface {
        let mut nodal = DMatrix::zeros(6 * stations.len(), 6 * stations.len());
        let kinds = [(1, Effect::Force), (5, Effect::Moment)];
        for (i, &x) in stations.iter().enumerate() {
            for (j, &z) in stations.iter().enumerate() {
                for (a, at) in kinds {
                    for (b, load) in kinds {
                        nodal[(6 * i + a, 6 * j + b)] = self.give(at, x, load, z);
                    }
                }
            }
        }
        let flexibility = Flexibility {
            bending_z: self.c,
            shear_y: self.g,
            ..Flexibility::default()
        };
        let cells = chain(stations, [0.0; 3], flexibility);
        ExactSurface::new(Arc::new(Rails::new(cells).expect("valid cells")), nodal).expect("fits")
    }
}

pub const STRAIGHT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Elements of one straight rail from station to station.
pub fn chain(stations: &[f64], offset: [f64; 3], flexibility: Flexibility) -> Vec<RailElement> {
    let pairs = stations.windows(2).enumerate();
    pairs
        .map(|(k, x)| RailElement {
            rail: 0,
            x: [x[0], x[1]],
            ends: [k, k + 1],
            length: x[1] - x[0],
            frame: STRAIGHT,
            offset,
            flexibility,
            member: None,
        })
        .collect()
}

pub fn probe(axis: Axis, x: f64) -> Probe {
    Probe { rail: 0, x, axis }
}

/// Random numbers from a seed.
pub struct Random(fastrand::Rng);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(fastrand::Rng::with_seed(seed))
    }

    pub fn unit(&mut self) -> f64 {
        self.0.f64()
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// The table of values of a beam at its stations.
pub fn tabulate(beam: &Beam, stations: &[f64]) -> SplineTable {
    let n = stations.len();
    let values = DMatrix::from_fn(n, n, |i, j| beam.deflection(stations[i], stations[j]));
    SplineTable::new(stations.to_vec(), stations.to_vec(), values).expect("stations increase")
}

/// A reading of one vertical table on rail 0.
pub fn read(kind: ReadingMethod, table: SplineTable) -> TableReading {
    let way = (0, Axis::Vertical);
    TableReading::new(
        kind,
        &[InfluenceBlock {
            deflection: way,
            load: way,
            table,
        }],
    )
    .expect("one table")
}

/// A rolled and inclined girder with its rail outside both planes, on node states of equal compliance in all
/// directions.
pub fn coupled() -> ExactSurface {
    let c = 1.0 / EI;
    let flexibility = Flexibility {
        axial: 1e-9,
        torsion: 9.0 * c,
        bending_y: 4.0 * c,
        bending_z: c,
        shear_y: 1e-9,
        shear_z: 2e-9,
        tension: 0.0,
    };
    let (s, t) = (0.6, 0.8);
    let mut cells = chain(&printed::STATIONS, [0.1, 3.0, 0.5], flexibility);
    for cell in &mut cells {
        cell.frame = [[t, s, 0.0], [-s * t, t * t, s], [s * s, -s * t, t]];
        cell.length /= t;
    }
    let line = Rails::new(cells).expect("valid cells");
    let size = 6 * line.state_count();
    ExactSurface::new(Arc::new(line), DMatrix::identity(size, size) * 1e-8).expect("fits")
}
