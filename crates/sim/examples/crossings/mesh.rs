//! A beam on two supports in the natural modes of a mesh of Hermite elements, and the static give that they leave.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use sim::{Dynamics, Extent, Foundation, Shapes, Structure};
use splines::{Compliance, Error, Influence, Probe};

/// Uniform beam with supports at 0 and `span`, `overhang` beyond both.
pub struct Beam {
    pub span: f64,
    pub overhang: f64,
    pub bending: f64,
    pub mass: f64,
}

/// Modes on nodes `step` apart: columns are (w, w') at the nodes.
struct Mesh {
    first: f64,
    step: f64,
    count: usize,
    shapes: DMatrix<f64>,
    omega: Vec<f64>,
}

/// Hermite's cubics over a cell of length h at s = x/h: values and slopes.
fn cubics(s: f64, h: f64) -> [(f64, f64); 4] {
    [
        (1.0 - s * s * (3.0 - 2.0 * s), -6.0 * s * (1.0 - s) / h),
        (h * s * (1.0 - s).powi(2), (1.0 - s) * (1.0 - 3.0 * s)),
        (s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / h),
        (-h * s * s * (1.0 - s), -s * (2.0 - 3.0 * s)),
    ]
}

impl Mesh {
    fn new(beam: &Beam, step: f64, modes: usize) -> Option<Mesh> {
        let cells = ((beam.span + 2.0 * beam.overhang) / step).round() as usize;
        let size = 2 * (cells + 1);
        let (mut k, mut m) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
        let h = step;
        let stiff = [
            12.0,
            6.0 * h,
            -12.0,
            6.0 * h,
            4.0 * h * h,
            -6.0 * h,
            2.0 * h * h,
            12.0,
            -6.0 * h,
            4.0 * h * h,
        ];
        let heavy = [
            156.0,
            22.0 * h,
            54.0,
            -13.0 * h,
            4.0 * h * h,
            13.0 * h,
            -3.0 * h * h,
            156.0,
            -22.0 * h,
            4.0 * h * h,
        ];
        for cell in 0..cells {
            let mut entry = 0;
            for i in 0..4 {
                for j in i..4 {
                    let (a, b) = (2 * cell + i, 2 * cell + j);
                    for (a, b) in if a == b {
                        vec![(a, b)]
                    } else {
                        vec![(a, b), (b, a)]
                    } {
                        k[(a, b)] += stiff[entry] * beam.bending / h.powi(3);
                        m[(a, b)] += heavy[entry] * beam.mass * h / 420.0;
                    }
                    entry += 1;
                }
            }
        }
        let held =
            [beam.overhang, beam.overhang + beam.span].map(|x| 2 * (x / step).round() as usize);
        let free: Vec<usize> = (0..size).filter(|i| !held.contains(i)).collect();
        let pick = |full: &DMatrix<f64>| {
            DMatrix::from_fn(free.len(), free.len(), |i, j| full[(free[i], free[j])])
        };
        let lower = pick(&m).cholesky()?.l();
        let inverse = lower.try_inverse()?;
        let eigen = SymmetricEigen::new(&inverse * pick(&k) * inverse.transpose());
        let mut order: Vec<usize> = (0..free.len()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        order.truncate(modes);
        let mut shapes = DMatrix::zeros(size, order.len());
        for (column, &mode) in order.iter().enumerate() {
            let shape: DVector<f64> = inverse.transpose() * eigen.eigenvectors.column(mode);
            for (row, value) in free.iter().zip(shape.iter()) {
                shapes[(*row, column)] = *value;
            }
        }
        let omega = order
            .iter()
            .map(|&mode| eigen.eigenvalues[mode].sqrt())
            .collect();
        Some(Mesh {
            first: -beam.overhang,
            step,
            count: cells,
            shapes,
            omega,
        })
    }

    fn row(&self, x: f64, value: &mut [f64], slope: &mut [f64]) {
        let along = (x - self.first) / self.step;
        let cell = (along.max(0.0) as usize).min(self.count - 1);
        let cubics = cubics(along - cell as f64, self.step);
        for (mode, (value, slope)) in value.iter_mut().zip(slope).enumerate() {
            (*value, *slope) = (0.0, 0.0);
            for (i, (shape, rate)) in cubics.iter().enumerate() {
                *value += shape * self.shapes[(2 * cell + i, mode)];
                *slope += rate * self.shapes[(2 * cell + i, mode)];
            }
        }
    }
}

struct Sides(Arc<Mesh>);

impl Shapes for Sides {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), Error> {
        self.0.row(at.x, value, slope);
        Ok(())
    }
}

/// The exact give less that of the modes.
struct Rest<C> {
    exact: C,
    mesh: Arc<Mesh>,
}

impl<C: Compliance> Compliance for Rest<C> {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        self.exact.fill(at, out)?;
        let modes = self.mesh.omega.len();
        let rows: Vec<(Vec<f64>, Vec<f64>)> = at
            .iter()
            .map(|p| {
                let (mut value, mut slope) = (vec![0.0; modes], vec![0.0; modes]);
                self.mesh.row(p.x, &mut value, &mut slope);
                (value, slope)
            })
            .collect();
        for i in 0..at.len() {
            for j in 0..at.len() {
                for (mode, omega) in self.mesh.omega.iter().enumerate() {
                    let by = rows[j].0[mode] / (omega * omega);
                    out.value[(i, j)] -= rows[i].0[mode] * by;
                    out.slope[(i, j)] -= rows[i].1[mode] * by;
                }
            }
        }
        Ok(())
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.exact.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.exact.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

impl Beam {
    /// In the lowest `modes` of a mesh of elements `step` long, with the `exact` give of the rest.
    pub fn foundation(
        &self,
        step: f64,
        modes: usize,
        exact: impl Compliance + 'static,
    ) -> Option<Foundation> {
        let mesh = Arc::new(Mesh::new(self, step, modes)?);
        let range = exact.range(0);
        Some(Foundation {
            rails: vec![Extent {
                range,
                breaks: vec![0.0, self.span],
            }],
            structure: Some(Structure {
                dynamics: Dynamics::Modes {
                    omega: mesh.omega.clone(),
                    ratio: vec![0.0; mesh.omega.len()],
                },
                shapes: Box::new(Sides(Arc::clone(&mesh))),
            }),
            compliance: Some(Box::new(Rest { exact, mesh })),
            ..Foundation::default()
        })
    }
}
