//! Stiffness of a whole frame, scaled, in elimination order.

use nalgebra::{Matrix3, SMatrix, Vector3};
use sprs::CsMat;

use crate::assembly::bodies::{Bodies, Body};
use crate::assembly::element::{Element, Matrix6, Matrix12, diagonal_blocks};
use crate::assembly::ordering::{Graph, order};
use crate::assembly::precision::{Extended, Real};
use crate::assembly::sparse::{Triplets, column_norm};
use crate::assembly::turning::{TurnedAxes, unstiffened_axes};
use crate::error::Error;
use crate::model::{ArmStiffness, GroundSpring, Model};

/// Size of an entry of a transformation, in roundings of the magnitudes behind it, at which it counts as zero.
const CANCELLED: f64 = 8.0;
/// Pivot of the scaled rotational stiffness of a body, in doubles, below which it is formed again in double-doubles.
const DOUBTFUL_PIVOT: f64 = 1e-12;
/// Such a pivot, in double-doubles, at which nothing stiffens the rotation: that of a mechanism.
const NO_PIVOT: f64 = 1e-27;
/// Largest such pivot that the rounding of coordinates can explain.
const LARGEST_NO_PIVOT: f64 = 1e-24;

/// The scaled stiffness S K S of the unknowns; S is diagonal, its entries are powers of two.
#[derive(Debug)]
pub(crate) struct ScaledStiffness<T: Real = f64> {
    /// Upper triangle.
    pub upper: CsMat<T>,
    pub numbering: Numbering,
    /// Largest ratio of the magnitudes that were added up for a diagonal entry to the entry itself.
    pub cancellation: f64,
}

/// The unknowns of a frame.
#[derive(Clone, Debug)]
pub(crate) struct Numbering {
    /// Unknown of each column of each body; `None` if supports fix it or nothing stiffens it.
    pub unknown: Vec<Option<usize>>,
    /// Column of each unknown.
    pub column: Vec<usize>,
    /// Bodies whose rotational columns are not about the global axes.
    pub turned: Vec<TurnedAxes>,
    /// Diagonal of S, by unknown.
    pub scale: Vec<f64>,
    /// Predicted operations of the factor, at most.
    pub operations: f64,
}

impl Numbering {
    /// The column of the largest component of a motion of the unknowns, by size; among those within `equal` of it, the
    /// first column. 0 without unknowns.
    pub fn largest_column(&self, motion: &[f64], equal: f64) -> usize {
        let mut largest = 0;
        for (k, component) in motion.iter().enumerate() {
            let gain = component.abs() - motion[largest].abs();
            if gain > equal || (gain > -equal && self.column[k] < self.column[largest]) {
                largest = k;
            }
        }
        self.column.get(largest).copied().unwrap_or(0)
    }
}

/// B, 12 x 12: local end displacements of a member (tips of its rigid offsets) by the motions of the
/// references of its two bodies.
pub(crate) fn transformation<T: Real>(element: &Element<T>, bodies: &Bodies<T>) -> Matrix12<T> {
    transformation_and_size(element, bodies).0
}

/// The same, with the sum of the magnitudes behind each entry. Entries that are only rounding are zero.
pub(crate) fn transformation_and_size<T: Real>(
    element: &Element<T>,
    bodies: &Bodies<T>,
) -> (Matrix12<T>, Matrix12) {
    let mut out = Matrix12::zeros();
    let mut size = Matrix12::zeros();
    let rotation = element.rotation();
    let magnitudes = |m: SMatrix<T, 6, 6>| m.map(|x| x.double().abs());
    let errors = Matrix3::from_fn(|row, _| element.axes_error[row]);
    let axes_error = diagonal_blocks(&errors);
    for end in 0..2 {
        let motion = bodies.motion(element.points[end], &element.offsets[end]);
        let value = product(&rotation, &motion);
        let bulk = product(&(magnitudes(rotation) + axes_error), &magnitudes(motion));
        let clean =
            value.zip_map(
                &bulk,
                |v, b| {
                    if v.double().abs() <= CANCELLED * T::ROUNDING * b { T::zero() } else { v }
                },
            );
        out.fixed_view_mut::<6, 6>(6 * end, 6 * end).copy_from(&clean);
        size.fixed_view_mut::<6, 6>(6 * end, 6 * end).copy_from(&bulk);
    }
    (out, size)
}

/// A B, N x N; skips the zeros, which are most entries of both.
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

/// B^T K B for a symmetric K, symmetric to the last bit.
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
fn bases<T: Real>(pair: [usize; 2], bodies: &Bodies<T>) -> Matrix12<T> {
    let mut out = Matrix12::zeros();
    out.fixed_view_mut::<6, 6>(0, 0).copy_from(&bodies.list[pair[0]].basis);
    out.fixed_view_mut::<6, 6>(6, 6).copy_from(&bodies.list[pair[1]].basis);
    out
}

/// Stiffness of each member and spring over the columns of the bodies that it joins.
struct Contributions<T: Real> {
    /// Two different bodies, and the stiffness over their twelve columns.
    members: Vec<([usize; 2], Matrix12<T>)>,
    /// Body, displacement of the spring by its six columns, stiffness.
    springs: Vec<(usize, [T; 6], T)>,
    /// Body, and the stiffness of its rigid arms over its six columns.
    arms: Vec<(usize, Matrix6<T>)>,
    /// Diagonal of the sum, by column.
    diagonal: Vec<f64>,
    /// Magnitudes that each diagonal entry was formed from.
    bulk: Vec<f64>,
}

impl<T: Real> Contributions<T> {
    fn new(m: &Model, elements: &[Element<T>], bodies: &Bodies<T>) -> Contributions<T> {
        let columns = 6 * bodies.list.len();
        let mut out = Contributions {
            members: Vec::with_capacity(elements.len()),
            springs: Vec::with_capacity(m.springs.len()),
            arms: Vec::with_capacity(m.arms.len()),
            diagonal: vec![0.0; columns],
            bulk: vec![0.0; columns],
        };
        elements.iter().for_each(|element| out.add_member(element, bodies));
        m.springs.iter().for_each(|spring| out.add_spring(spring, bodies));
        m.arms.iter().for_each(|arm| out.add_arm(arm, bodies));
        out
    }

    fn add_member(&mut self, element: &Element<T>, bodies: &Bodies<T>) {
        let pair = bodies.pair(element.points);
        // A member within one rigid body has no strain.
        if pair[0] == pair[1] {
            return;
        }
        let (mut b, mut size) = transformation_and_size(element, bodies);
        // Most bodies are free: their basis is the identity.
        if !pair.iter().all(|&body| bodies.list[body].is_free()) {
            let basis = bases(pair, bodies);
            (b, size) = (product(&b, &basis), product(&size, &basis.map(|x| x.double().abs())));
        }
        let k = congruence(&element.stiffness, &b);
        // |K_ij| <= sqrt(K_ii K_jj) bounds what the congruence adds up for a diagonal entry. An error dB of the
        // transformation changes the entry by 2 B^T K dB + dB^T K dB.
        let growth = element.release_growth;
        let roots = SMatrix::<f64, 1, 12>::from_fn(|_, i| (growth * element.unreleased_diagonal[i]).sqrt());
        let (own, behind) = (roots * b.map(|x| x.double().abs()), roots * size);
        for i in 0..12 {
            let column = 6 * pair[i / 6] + i % 6;
            let diagonal = k[(i, i)].double();
            // What has cancelled in the transformation.
            let lost = (behind[i] - own[i]).max(0.0);
            let moved = 2.0 * diagonal.max(0.0).sqrt() + T::ROUNDING * lost;
            self.diagonal[column] += diagonal;
            self.bulk[column] += own[i] * own[i] + moved * lost;
        }
        self.members.push((pair, k));
    }

    fn add_spring(&mut self, spring: &GroundSpring, bodies: &Bodies<T>) {
        let body = bodies.of_point[spring.point];
        let motion = bodies.motion(spring.point, &Vector3::zeros());
        let motion = product(&motion, &bodies.list[body].basis);
        let row: [T; 6] = std::array::from_fn(|k| motion[(spring.dof as usize, k)]);
        let stiffness = T::from(spring.stiffness);
        for (k, &displacement) in row.iter().enumerate() {
            let part = (stiffness * displacement * displacement).double();
            self.diagonal[6 * body + k] += part;
            self.bulk[6 * body + k] += part;
        }
        self.springs.push((body, row, stiffness));
    }

    fn add_arm(&mut self, arm: &ArmStiffness, bodies: &Bodies<T>) {
        let body = bodies.of_point[arm.point];
        let turning = bodies.list[body].basis.fixed_rows::<3>(3).into_owned();
        let given = Matrix3::from_fn(|i, j| T::from(arm.stiffness[i][j]));
        let all = turning.transpose() * given * turning;
        // Symmetric to the last bit, whatever the order of the products above.
        let all = (all + all.transpose()) * T::from(0.5);
        let size = turning.map(|x| x.double().abs());
        let bulk = size.transpose() * given.map(|x| x.double().abs()) * size;
        for k in 0..6 {
            self.diagonal[6 * body + k] += all[(k, k)].double();
            self.bulk[6 * body + k] += bulk[(k, k)];
        }
        self.arms.push((body, all));
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
                    // The diagonal always: its place exists even if this member adds zero.
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
        for (body, stiffness) in &self.arms {
            for i in 0..6 {
                for j in (0..6).filter(|&j| stiffness[(i, j)] != T::zero()) {
                    add(6 * body + i, 6 * body + j, stiffness[(i, j)]);
                }
            }
        }
        triplets.sum()
    }

    /// Stiffness of the three rotational columns of each body.
    fn rotational_blocks(&self, bodies: usize) -> Vec<[[T; 3]; 3]> {
        let mut blocks = vec![[[T::zero(); 3]; 3]; bodies];
        for (pair, k) in &self.members {
            for (end, &body) in pair.iter().enumerate() {
                for (i, row) in blocks[body].iter_mut().enumerate() {
                    for (j, entry) in row.iter_mut().enumerate() {
                        *entry += k[(6 * end + 3 + i, 6 * end + 3 + j)];
                    }
                }
            }
        }
        for &(body, row, stiffness) in &self.springs {
            for (i, entries) in blocks[body].iter_mut().enumerate() {
                for (j, entry) in entries.iter_mut().enumerate() {
                    *entry += stiffness * row[3 + i] * row[3 + j];
                }
            }
        }
        blocks
    }

    /// Whether nothing seems to stiffen a column that no support fixes, or a rotation of a body about some axis.
    fn may_lack_stiffness(&self, bodies: &Bodies) -> bool {
        let columns = bodies.list.iter().enumerate();
        let mut columns = columns.flat_map(|(body, own)| (0..6).map(move |k| (6 * body + k, own.free[k])));
        columns.any(|(column, is_free)| is_free && self.diagonal[column] <= 0.0)
            || self.rotational_blocks(bodies.list.len()).iter().any(|block| {
                let doubles = block.map(|row| row.map(|x| x.double()));
                !unstiffened_axes(&doubles, DOUBTFUL_PIVOT).is_empty()
            })
    }

    fn cancellation(&self, numbering: &Numbering) -> f64 {
        numbering.column.iter().map(|&c| self.bulk[c] / self.diagonal[c].abs()).fold(1.0, f64::max)
    }

    fn stiffness(&self, numbering: Numbering) -> ScaledStiffness<T> {
        let cancellation = self.cancellation(&numbering);
        ScaledStiffness { upper: self.sum(&numbering), numbering, cancellation }
    }
}

impl ScaledStiffness {
    /// Numbers the unknowns and adds up their stiffness. A column with a diagonal of exactly zero is left
    /// out: nothing stiffens it. So is a rotation about any other axis about which nothing stiffens a body: its
    /// rotational columns are turned.
    ///
    /// Under a preload a column stays that is stiffened without it, or by it: only one that is neither is left out. About
    /// which axes nothing stiffens a body is asked without the preload, of bodies without arms.
    ///
    /// # Errors
    /// As [`Element::all`].
    pub fn new(m: &Model, elements: &[Element], bodies: &mut Bodies) -> Result<ScaledStiffness, Error> {
        let mut parts = Contributions::new(m, elements, bodies);
        // An axial force stiffens no rotation that nothing else stiffens: only where something seems to be missing, the
        // stiffness without the preload has to be known.
        let unloaded =
            if m.is_preloaded() && parts.may_lack_stiffness(bodies) { Some(m.unloaded()) } else { None };
        let own = unloaded.as_ref().map(Element::all).transpose()?;
        let mut elastic =
            unloaded.as_ref().zip(own.as_ref()).map(|(m, own)| Contributions::new(m, own, bodies));
        let turned = match (&unloaded, &own, &elastic) {
            (Some(unloaded), Some(own), Some(elastic)) => {
                let armed = |body: usize| m.arms.iter().any(|arm| bodies.of_point[arm.point] == body);
                let mut turned = turned_axes(unloaded, own, bodies, elastic)?;
                turned.retain(|axes| !armed(axes.body));
                turned
            }
            _ if m.is_preloaded() => Vec::new(),
            _ => turned_axes(m, elements, bodies, &parts)?,
        };
        if !turned.is_empty() {
            bodies.turn(&turned);
            parts = Contributions::new(m, elements, bodies);
            elastic = unloaded.as_ref().zip(own.as_ref()).map(|(m, own)| Contributions::new(m, own, bodies));
        }
        let is_stiffened = |column: usize| {
            parts.diagonal[column] > 0.0
                || elastic.as_ref().is_some_and(|elastic| elastic.diagonal[column] > 0.0)
        };
        // Bodies that are held take no part in the elimination.
        let moves = |&body: &usize| bodies.list[body].free.contains(&true);
        let pairs = parts.members.iter().map(|part| part.0);
        let edges: Vec<[usize; 2]> = pairs.filter(|pair| pair.iter().all(moves)).collect();
        let mut unknown = vec![None; parts.diagonal.len()];
        let mut column = Vec::new();
        let (order, operations) = order(&Graph::new(bodies.list.len(), &edges));
        for body in order {
            let Body { free, unstiffened, .. } = &bodies.list[body];
            let stiffened = |&k: &usize| free[k] && !unstiffened[k] && is_stiffened(6 * body + k);
            for k in (0..6).filter(stiffened) {
                unknown[6 * body + k] = Some(column.len());
                column.push(6 * body + k);
            }
        }
        // The scale comes from the doubles also where the stiffness is formed again in double-doubles.
        let scale = column.iter().map(|&c| scale_of(parts.diagonal[c])).collect();
        Ok(parts.stiffness(Numbering { unknown, column, turned, scale, operations }))
    }

    /// The stiffness of a model that differs from one numbered before by its axial forces alone, over the same unknowns; `None`
    /// where these stiffen what nothing stiffened there, or arms turn a body that has turned axes.
    pub fn renumbered(
        m: &Model,
        elements: &[Element],
        bodies: &Bodies,
        known: &Numbering,
    ) -> Option<ScaledStiffness> {
        let parts = Contributions::new(m, elements, bodies);
        let is_new = |column: usize| {
            let Body { free, unstiffened, .. } = &bodies.list[column / 6];
            let counts = free[column % 6] && !unstiffened[column % 6];
            counts && known.unknown[column].is_none() && parts.diagonal[column] > 0.0
        };
        let turned = |arm: &ArmStiffness| {
            let body = bodies.of_point[arm.point];
            known.turned.iter().any(|axes| axes.body == body)
        };
        if (0..known.unknown.len()).any(is_new) || m.arms.iter().any(turned) {
            return None;
        }
        let scale = known.column.iter().map(|&c| scale_of(parts.diagonal[c])).collect();
        Some(parts.stiffness(Numbering { scale, ..known.clone() }))
    }

    /// Upper triangle of S K S + shift * identity.
    pub fn shifted(&self, shift: f64) -> CsMat<f64> {
        &self.upper + &CsMat::eye_csc(self.len()).map(|one: &f64| one * shift)
    }
}

impl<T: Real> ScaledStiffness<T> {
    /// Stiffness of unknowns that are numbered already, formed from the model again in the precision T.
    ///
    /// # Errors
    /// As [`Element::all`].
    pub fn in_precision(m: &Model, numbering: &Numbering) -> Result<ScaledStiffness<T>, Error> {
        let mut bodies = Bodies::new(m);
        bodies.turn(&numbering.turned);
        let parts = Contributions::new(m, &Element::all(m)?, &bodies);
        Ok(parts.stiffness(numbering.clone()))
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.numbering.column.len()
    }

    /// 1-norm of S K S.
    pub fn norm(&self) -> f64 {
        column_norm(&self.upper)
    }
}

/// Bodies that can rotate without strain about an axis that is not global, while all others are at rest.
///
/// The rotational stiffness of each body shows in doubles whether it may be singular; only where it may, it is formed
/// again in double-doubles, as for a mechanism. Members that meet in a straight line do so within the rounding of their
/// coordinates: the square of that angle is no stiffness.
fn turned_axes(
    m: &Model,
    elements: &[Element],
    bodies: &Bodies,
    parts: &Contributions<f64>,
) -> Result<Vec<TurnedAxes>, Error> {
    let count = bodies.list.len();
    let blocks = parts.rotational_blocks(count);
    let doubtful: Vec<bool> =
        blocks.iter().map(|block| !unstiffened_axes(block, DOUBTFUL_PIVOT).is_empty()).collect();
    if !doubtful.contains(&true) {
        return Ok(Vec::new());
    }
    let mut tolerances = vec![NO_PIVOT; count];
    let mut adjacent = Vec::new();
    for (index, element) in elements.iter().enumerate() {
        let pair = bodies.pair(element.points);
        if pair[0] == pair[1] || !pair.iter().any(|&body| doubtful[body]) {
            continue;
        }
        adjacent.push(Element::<Extended>::new(m, index)?);
        let angle = 4.0 * f64::EPSILON * element.geometry.far / element.length;
        for body in pair {
            tolerances[body] = tolerances[body].max(angle * angle).min(LARGEST_NO_PIVOT);
        }
    }
    let bodies = Bodies::<Extended>::new(m);
    let blocks = Contributions::new(m, &adjacent, &bodies).rotational_blocks(count);
    let mut turned = Vec::new();
    for body in (0..count).filter(|&body| doubtful[body]) {
        let axes = unstiffened_axes(&blocks[body], tolerances[body]);
        if !axes.is_empty() {
            let free = [0, 1, 2].map(|k| blocks[body][k][k].double() > 0.0);
            turned.push(TurnedAxes::new(body, &axes, free));
        }
    }
    Ok(turned)
}

/// The power of two nearest to 1/sqrt(|x|).
fn scale_of(x: f64) -> f64 {
    // A power of two scales without rounding; the clamp keeps the scaled entries finite.
    let exponent = (-0.5 * x.abs().log2()).round().clamp(-500.0, 500.0);
    f64::powi(2.0, exponent as i32)
}
