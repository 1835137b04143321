//! Stiffness of a whole frame, scaled, in elimination order.

use nalgebra::{SMatrix, Vector3};
use sprs::{CsMat, TriMat};

use crate::element::{Element, Matrix12};
use crate::freedoms::Freedoms;
use crate::model::Model;
use crate::order::{Graph, order};

/// The scaled stiffness S K S of the unknowns, S diagonal, powers of two.
#[derive(Debug)]
pub(crate) struct Assembly {
    /// Upper triangle.
    pub upper: CsMat<f64>,
    /// Unknown of each column of each body; `None` where supports hold it or nothing stiffens it.
    pub unknown: Vec<Option<usize>>,
    /// Column of each unknown.
    pub column: Vec<usize>,
    /// S, by unknown.
    pub scale: Vec<f64>,
    /// Largest ratio of what was added up to form a diagonal entry to the entry itself.
    pub cancellation: f64,
}

/// Local end displacements of a member (tips of its arms) by the motions of its two bodies.
pub(crate) fn reach(element: &Element, freedoms: &Freedoms) -> Matrix12 {
    reach_and_size(element, freedoms).0
}

/// The same, with the sum of the magnitudes behind each entry.
fn reach_and_size(element: &Element, freedoms: &Freedoms) -> (Matrix12, Matrix12) {
    let mut out = Matrix12::zeros();
    let mut size = Matrix12::zeros();
    let rotation = element.rotation();
    for end in 0..2 {
        let motion = freedoms.motion(element.points[end], &element.offsets[end]);
        let value = rotation * motion;
        let bulk = rotation.abs() * motion.abs();
        let clean = value.zip_map(&bulk, |v, b| if v.abs() <= 8.0 * f64::EPSILON * b { 0.0 } else { v });
        out.fixed_view_mut::<6, 6>(6 * end, 6 * end).copy_from(&clean);
        size.fixed_view_mut::<6, 6>(6 * end, 6 * end).copy_from(&bulk);
    }
    (out, size)
}

/// What the supports leave of the motions of two bodies.
fn bases(pair: [usize; 2], freedoms: &Freedoms) -> Matrix12 {
    let mut out = Matrix12::zeros();
    out.fixed_view_mut::<6, 6>(0, 0).copy_from(&freedoms.bodies[pair[0]].basis);
    out.fixed_view_mut::<6, 6>(6, 6).copy_from(&freedoms.bodies[pair[1]].basis);
    out
}

impl Assembly {
    pub fn new(m: &Model, elements: &[Element], freedoms: &Freedoms) -> Assembly {
        let columns = 6 * freedoms.bodies.len();
        let mut diagonal = vec![0.0_f64; columns];
        let mut bulk = vec![0.0_f64; columns];
        let mut edges = Vec::with_capacity(elements.len());
        let mut blocks: Vec<([usize; 2], Matrix12)> = Vec::with_capacity(elements.len());
        for element in elements {
            let pair = element.points.map(|point| freedoms.body[point]);
            if pair[0] == pair[1] {
                continue;
            }
            let (b, size) = reach_and_size(element, freedoms);
            let basis = bases(pair, freedoms);
            let (b, size) = (b * basis, size * basis.abs());
            let k = b.transpose() * element.stiffness * b;
            let roots = SMatrix::<f64, 1, 12>::from_fn(|_, i| element.scale[i].sqrt());
            let most = roots * size;
            for i in 0..12 {
                let column = 6 * pair[i / 6] + i % 6;
                diagonal[column] += k[(i, i)];
                bulk[column] += most[i] * most[i];
            }
            edges.push(pair);
            blocks.push((pair, k));
        }
        let springs: Vec<(usize, [f64; 6], f64)> = m
            .springs
            .iter()
            .map(|spring| {
                let body = freedoms.body[spring.point];
                let motion = freedoms.motion(spring.point, &Vector3::zeros()) * freedoms.bodies[body].basis;
                let row = std::array::from_fn(|k| motion[(spring.freedom as usize, k)]);
                (body, row, spring.stiffness)
            })
            .collect();
        for &(body, row, stiffness) in &springs {
            for (k, share) in row.iter().enumerate() {
                diagonal[6 * body + k] += stiffness * share * share;
                bulk[6 * body + k] += stiffness * share * share;
            }
        }

        let mut unknown = vec![None; columns];
        let mut column = Vec::new();
        let at: Vec<[f64; 3]> = freedoms.bodies.iter().map(|body| m.points[body.reference]).collect();
        for body in order(&Graph::new(at.len(), &edges), &at) {
            for k in (0..6).filter(|&k| freedoms.bodies[body].free[k] && diagonal[6 * body + k] > 0.0) {
                unknown[6 * body + k] = Some(column.len());
                column.push(6 * body + k);
            }
        }
        let n = column.len();
        let scale: Vec<f64> = column.iter().map(|&c| binary(diagonal[c])).collect();
        let cancellation = column.iter().map(|&c| bulk[c] / diagonal[c]).fold(1.0, f64::max);

        let mut triplets = TriMat::with_capacity((n, n), 78 * blocks.len() + n);
        let mut add = |a: usize, b: usize, value: f64| {
            if let (Some(i), Some(j)) = (unknown[a], unknown[b])
                && i <= j
            {
                triplets.add_triplet(i, j, scale[i] * value * scale[j]);
            }
        };
        for (pair, k) in &blocks {
            for i in 0..12 {
                for j in 0..12 {
                    let value = k[(i, j)];
                    if value != 0.0 || i == j {
                        add(6 * pair[i / 6] + i % 6, 6 * pair[j / 6] + j % 6, value);
                    }
                }
            }
        }
        for &(body, row, stiffness) in &springs {
            for i in 0..6 {
                for j in 0..6 {
                    if row[i] != 0.0 && row[j] != 0.0 {
                        add(6 * body + i, 6 * body + j, stiffness * row[i] * row[j]);
                    }
                }
            }
        }
        Assembly { upper: triplets.to_csc(), unknown, column, scale, cancellation }
    }

    /// Upper triangle of S K S + shift.
    pub fn shifted(&self, shift: f64) -> CsMat<f64> {
        &self.upper + &CsMat::eye_csc(self.column.len()).map(|one: &f64| one * shift)
    }

    /// Largest column sum of |S K S|.
    pub fn norm(&self) -> f64 {
        let mut sums = vec![0.0_f64; self.column.len()];
        for (value, (i, j)) in self.upper.iter() {
            sums[i] += value.abs();
            if i != j {
                sums[j] += value.abs();
            }
        }
        sums.into_iter().fold(0.0, f64::max)
    }
}

/// The power of two nearest to 1/sqrt(x).
fn binary(x: f64) -> f64 {
    let exponent = (-0.5 * x.log2()).round().clamp(-500.0, 500.0);
    f64::powi(2.0, exponent as i32)
}
