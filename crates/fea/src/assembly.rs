//! Stiffness of a whole frame, scaled, in elimination order.

use nalgebra::{SMatrix, Vector3};
use sprs::CsMat;

use crate::element::{Element, Matrix12};
use crate::freedoms::Freedoms;
use crate::model::Model;
use crate::order::{Graph, order};
use crate::real::Real;
use crate::triplets::Triplets;

/// The scaled stiffness S K S of the unknowns, S diagonal, powers of two.
#[derive(Debug)]
pub(crate) struct Assembly<T: Real = f64> {
    /// Upper triangle.
    pub upper: CsMat<T>,
    pub numbering: Numbering,
    /// Largest ratio of what was added up to form a diagonal entry to the entry itself.
    pub cancellation: f64,
}

/// The unknowns of a frame.
#[derive(Clone, Debug)]
pub(crate) struct Numbering {
    /// Unknown of each column of each body; `None` where supports hold it or nothing stiffens it.
    pub unknown: Vec<Option<usize>>,
    /// Column of each unknown.
    pub column: Vec<usize>,
    /// S, by unknown.
    pub scale: Vec<f64>,
    /// Operations of the factor, at most.
    pub operations: f64,
}

/// Local end displacements of a member (tips of its arms) by the motions of its two bodies.
pub(crate) fn reach<T: Real>(element: &Element<T>, freedoms: &Freedoms<T>) -> Matrix12<T> {
    reach_and_size(element, freedoms).0
}

/// The same, with the sum of the magnitudes behind each entry.
fn reach_and_size<T: Real>(element: &Element<T>, freedoms: &Freedoms<T>) -> (Matrix12<T>, Matrix12) {
    let mut out = Matrix12::zeros();
    let mut size = Matrix12::zeros();
    let rotation = element.rotation();
    let bulk_of = |m: SMatrix<T, 6, 6>| m.map(|x| x.double().abs());
    for end in 0..2 {
        let motion = freedoms.motion(element.points[end], &element.offsets[end]);
        let value = product(&rotation, &motion);
        let bulk = bulk_of(rotation) * bulk_of(motion);
        let clean = value
            .zip_map(&bulk, |v, b| if v.double().abs() <= 8.0 * T::ROUNDING * b { T::zero() } else { v });
        out.fixed_view_mut::<6, 6>(6 * end, 6 * end).copy_from(&clean);
        size.fixed_view_mut::<6, 6>(6 * end, 6 * end).copy_from(&bulk);
    }
    (out, size)
}

/// A B, N x N; zeros, which are most of both, cost nothing.
fn product<T: Real, const N: usize>(a: &SMatrix<T, N, N>, b: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let zero = T::zero();
    let mut out = SMatrix::<T, N, N>::zeros();
    for j in 0..N {
        for l in (0..N).filter(|&l| b[(l, j)] != zero) {
            for i in (0..N).filter(|&i| a[(i, l)] != zero) {
                out[(i, j)] += a[(i, l)] * b[(l, j)];
            }
        }
    }
    out
}

/// B^T K B, symmetric as K.
fn congruence<T: Real>(k: &Matrix12<T>, b: &Matrix12<T>) -> Matrix12<T> {
    let zero = T::zero();
    let kb = product(k, b);
    let mut out = Matrix12::<T>::zeros();
    for i in 0..12 {
        for l in (0..12).filter(|&l| b[(l, i)] != zero) {
            for j in (i..12).filter(|&j| kb[(l, j)] != zero) {
                out[(i, j)] += b[(l, i)] * kb[(l, j)];
            }
        }
        for j in i + 1..12 {
            out[(j, i)] = out[(i, j)];
        }
    }
    out
}

/// What the supports leave of the motions of two bodies.
fn bases<T: Real>(pair: [usize; 2], freedoms: &Freedoms<T>) -> Matrix12<T> {
    let mut out = Matrix12::zeros();
    out.fixed_view_mut::<6, 6>(0, 0).copy_from(&freedoms.bodies[pair[0]].basis);
    out.fixed_view_mut::<6, 6>(6, 6).copy_from(&freedoms.bodies[pair[1]].basis);
    out
}

/// Stiffness of every part of a frame over the columns of the bodies it joins.
struct Parts<T: Real> {
    members: Vec<([usize; 2], Matrix12<T>)>,
    /// Body, its motion along the spring by its six columns, stiffness.
    springs: Vec<(usize, [T; 6], T)>,
    /// Diagonal of the sum, and the magnitudes that it was formed from.
    diagonal: Vec<f64>,
    bulk: Vec<f64>,
}

impl<T: Real> Parts<T> {
    fn new(m: &Model, elements: &[Element<T>], freedoms: &Freedoms<T>) -> Parts<T> {
        let columns = 6 * freedoms.bodies.len();
        let (mut diagonal, mut bulk) = (vec![0.0_f64; columns], vec![0.0_f64; columns]);
        let mut members = Vec::with_capacity(elements.len());
        for element in elements {
            let pair = element.points.map(|point| freedoms.body[point]);
            if pair[0] == pair[1] {
                continue;
            }
            let (b, size) = reach_and_size(element, freedoms);
            let basis = bases(pair, freedoms);
            let (b, size) = (product(&b, &basis), size * basis.map(|x| x.double().abs()));
            let k = congruence(&element.stiffness, &b);
            let roots = SMatrix::<f64, 1, 12>::from_fn(|_, i| element.scale[i].sqrt());
            let most = roots * size;
            for i in 0..12 {
                let column = 6 * pair[i / 6] + i % 6;
                diagonal[column] += k[(i, i)].double();
                bulk[column] += most[i] * most[i];
            }
            members.push((pair, k));
        }
        let spring = |spring: &crate::model::Spring| {
            let body = freedoms.body[spring.point];
            let motion = freedoms.motion(spring.point, &Vector3::zeros());
            let motion = product(&motion, &freedoms.bodies[body].basis);
            let row = std::array::from_fn(|k| motion[(spring.freedom as usize, k)]);
            (body, row, T::from(spring.stiffness))
        };
        let springs: Vec<(usize, [T; 6], T)> = m.springs.iter().map(spring).collect();
        for &(body, row, stiffness) in &springs {
            for (k, share) in row.iter().enumerate() {
                let part = (stiffness * *share * *share).double();
                diagonal[6 * body + k] += part;
                bulk[6 * body + k] += part;
            }
        }
        Parts { members, springs, diagonal, bulk }
    }

    /// Adds up the upper triangle of S K S.
    fn sum(&self, numbering: &Numbering) -> CsMat<T> {
        let Numbering { unknown, scale, .. } = numbering;
        let n = scale.len();
        let mut triplets = Triplets::new(n, 78 * self.members.len() + 36 * self.springs.len());
        let mut add = |a: usize, b: usize, value: T| {
            if let (Some(i), Some(j)) = (unknown[a], unknown[b])
                && i <= j
            {
                triplets.add(i, j, T::from(scale[i]) * value * T::from(scale[j]));
            }
        };
        for (pair, k) in &self.members {
            for i in 0..12 {
                for j in 0..12 {
                    let value = k[(i, j)];
                    if value != T::zero() || i == j {
                        add(6 * pair[i / 6] + i % 6, 6 * pair[j / 6] + j % 6, value);
                    }
                }
            }
        }
        for &(body, row, stiffness) in &self.springs {
            for i in 0..6 {
                for j in 0..6 {
                    if row[i] != T::zero() && row[j] != T::zero() {
                        add(6 * body + i, 6 * body + j, stiffness * row[i] * row[j]);
                    }
                }
            }
        }
        triplets.sum()
    }

    fn cancellation(&self, numbering: &Numbering) -> f64 {
        numbering.column.iter().map(|&c| self.bulk[c] / self.diagonal[c]).fold(1.0, f64::max)
    }
}

impl Assembly {
    /// Numbers the unknowns and adds up their stiffness.
    pub fn new(m: &Model, elements: &[Element], freedoms: &Freedoms) -> Assembly {
        let parts = Parts::new(m, elements, freedoms);
        let edges: Vec<[usize; 2]> = parts.members.iter().map(|part| part.0).collect();
        let at: Vec<[f64; 3]> = freedoms.bodies.iter().map(|body| m.points[body.reference]).collect();
        let mut unknown = vec![None; parts.diagonal.len()];
        let mut column = Vec::new();
        let (order, operations) = order(&Graph::new(at.len(), &edges), &at);
        for body in order {
            for k in (0..6).filter(|&k| freedoms.bodies[body].free[k] && parts.diagonal[6 * body + k] > 0.0) {
                unknown[6 * body + k] = Some(column.len());
                column.push(6 * body + k);
            }
        }
        let scale = column.iter().map(|&c| binary(parts.diagonal[c])).collect();
        let numbering = Numbering { unknown, column, scale, operations };
        let cancellation = parts.cancellation(&numbering);
        Assembly { upper: parts.sum(&numbering), numbering, cancellation }
    }

    /// Upper triangle of S K S + shift.
    pub fn shifted(&self, shift: f64) -> CsMat<f64> {
        &self.upper + &CsMat::eye_csc(self.numbering.column.len()).map(|one: &f64| one * shift)
    }
}

impl<T: Real> Assembly<T> {
    /// Stiffness of the unknowns that are numbered already, formed from the model in the precision T.
    ///
    /// # Errors
    /// As [`Element::new`].
    pub fn again(m: &Model, numbering: &Numbering) -> Result<Assembly<T>, crate::Error> {
        let elements: Vec<Element<T>> =
            (0..m.members.len()).map(|index| Element::new(m, index)).collect::<Result<_, _>>()?;
        let parts = Parts::new(m, &elements, &Freedoms::new(m));
        let cancellation = parts.cancellation(numbering);
        Ok(Assembly { upper: parts.sum(numbering), numbering: numbering.clone(), cancellation })
    }

    /// Largest column sum of |S K S|.
    pub fn norm(&self) -> f64 {
        let mut sums = vec![0.0_f64; self.numbering.column.len()];
        for (value, (i, j)) in self.upper.iter() {
            let size = value.double().abs();
            sums[i] += size;
            if i != j {
                sums[j] += size;
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
