//! Stiffness of a whole frame, scaled, in elimination order.

use nalgebra::{Matrix3, Vector3};
use sprs::CsMat;

use crate::assembly::blocks::BlockSums;
use crate::assembly::bodies::{Bodies, Body};
use crate::assembly::element::{Element, Matrix6};
use crate::assembly::ends::{congruence, end_motions, magnitudes, product};
use crate::assembly::graph::Graph;
use crate::assembly::ordering::order;
use crate::assembly::precision::{Extended, Real};
use crate::assembly::sparse::column_norm;
use crate::assembly::turning::{TurnedAxes, unstiffened_axes};
use crate::error::Error;
use crate::model::{ArmStiffness, GroundSpring, Model};

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

/// Stiffness of the members, springs and arms over the columns of the bodies.
struct Contributions<T: Real> {
    sums: BlockSums<T>,
    /// Stiffness of the three rotational columns of each body, without that of its rigid arms.
    rotational: Vec<[[T; 3]; 3]>,
    /// Diagonal of the sum, by column.
    diagonal: Vec<f64>,
    /// Magnitudes that each diagonal entry was formed from.
    bulk: Vec<f64>,
}

impl<T: Real> Contributions<T> {
    fn new(m: &Model, elements: &[Element<T>], bodies: &Bodies<T>) -> Contributions<T> {
        let count = bodies.list.len();
        let mut out = Contributions {
            sums: BlockSums::new(count, elements.len()),
            rotational: Vec::new(),
            diagonal: vec![0.0; 6 * count],
            bulk: vec![0.0; 6 * count],
        };
        elements
            .iter()
            .for_each(|element| out.add_member(element, bodies));
        m.springs
            .iter()
            .for_each(|spring| out.add_spring(spring, bodies));
        out.rotational = (0..count).map(|body| out.sums.rotational(body)).collect();
        m.arms.iter().for_each(|arm| out.add_arm(arm, bodies));
        out
    }

    fn add_member(&mut self, element: &Element<T>, bodies: &Bodies<T>) {
        let pair = bodies.pair(element.points);
        // A member within one rigid body has no strain.
        if pair[0] == pair[1] {
            return;
        }
        let (mut b, mut size) = end_motions(element, bodies);
        for (end, &body) in pair.iter().enumerate() {
            // Most bodies are free: their basis is the identity.
            let body = &bodies.list[body];
            if !body.is_free {
                b[end] = product(&b[end], &body.basis);
                size[end] = product(&size[end], &magnitudes(&body.basis));
            }
        }
        let unreleased = element.unreleased_stiffness();
        let (local, growth) = match &element.released {
            None => (&unreleased, 1.0),
            Some(released) => (&released.stiffness, released.growth),
        };
        let k = congruence(local, &b);
        // |K_ij| <= sqrt(K_ii K_jj) bounds what the congruence adds up for a diagonal entry. An error dB of the
        // transformation changes the entry by 2 B^T K dB + dB^T K dB.
        let roots = element
            .diagonal_sizes(&unreleased)
            .map(|size| (growth * size).sqrt());
        for (end, &body) in pair.iter().enumerate() {
            let roots = &roots[6 * end..6 * end + 6];
            for i in 0..6 {
                let (mut own, mut behind) = (0.0, 0.0);
                for (l, root) in roots.iter().enumerate() {
                    own += root * b[end][(l, i)].double().abs();
                    behind += root * size[end][(l, i)];
                }
                let diagonal = k[(6 * end + i, 6 * end + i)].double();
                // What has cancelled in the transformation.
                let lost = (behind - own).max(0.0);
                let moved = 2.0 * diagonal.max(0.0).sqrt() + T::ROUNDING * lost;
                self.diagonal[6 * body + i] += diagonal;
                self.bulk[6 * body + i] += own * own + moved * lost;
            }
            self.sums
                .add_own(body, &k.fixed_view::<6, 6>(6 * end, 6 * end).into_owned());
        }
        self.sums
            .add_coupling(pair, k.fixed_view::<6, 6>(0, 6).into_owned());
    }

    fn add_spring(&mut self, spring: &GroundSpring, bodies: &Bodies<T>) {
        let body = bodies.of_point[spring.point];
        let motion = bodies.motion(spring.point, &Vector3::zeros());
        let motion = product(&motion, &bodies.list[body].basis);
        let row: [T; 6] = std::array::from_fn(|k| motion[(spring.dof as usize, k)]);
        let stiffness = T::from(spring.stiffness);
        let all = Matrix6::from_fn(|i, j| stiffness * row[i] * row[j]);
        for k in 0..6 {
            let part = all[(k, k)].double();
            self.diagonal[6 * body + k] += part;
            self.bulk[6 * body + k] += part;
        }
        self.sums.add_own(body, &all);
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
        self.sums.add_own(body, &all);
    }

    /// Whether nothing seems to stiffen a column that no support fixes, or a rotation of a body about some axis.
    fn may_lack_stiffness(&self, bodies: &Bodies) -> bool {
        let columns = bodies.list.iter().enumerate();
        let mut columns =
            columns.flat_map(|(body, own)| (0..6).map(move |k| (6 * body + k, own.free[k])));
        columns.any(|(column, is_free)| is_free && self.diagonal[column] <= 0.0)
            || self.rotational.iter().any(|block| {
                let doubles = block.map(|row| row.map(|x| x.double()));
                !unstiffened_axes(&doubles, DOUBTFUL_PIVOT).is_empty()
            })
    }

    fn cancellation(&self, numbering: &Numbering) -> f64 {
        numbering
            .column
            .iter()
            .map(|&c| self.bulk[c] / self.diagonal[c].abs())
            .fold(1.0, f64::max)
    }

    fn stiffness(&self, numbering: Numbering) -> ScaledStiffness<T> {
        let cancellation = self.cancellation(&numbering);
        let upper = self.sums.upper(&numbering.unknown, &numbering.scale);
        ScaledStiffness {
            upper,
            numbering,
            cancellation,
        }
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
    pub fn new(
        m: &Model,
        elements: &[Element],
        bodies: &mut Bodies,
    ) -> Result<ScaledStiffness, Error> {
        let mut parts = Contributions::new(m, elements, bodies);
        // An axial force stiffens no rotation that nothing else stiffens: only where something seems to be missing, the
        // stiffness without the preload has to be known.
        let unloaded = if m.is_preloaded() && parts.may_lack_stiffness(bodies) {
            Some(m.unloaded())
        } else {
            None
        };
        let own = unloaded.as_ref().map(Element::all).transpose()?;
        let mut elastic = unloaded
            .as_ref()
            .zip(own.as_ref())
            .map(|(m, own)| Contributions::new(m, own, bodies));
        let turned = match (&unloaded, &own, &elastic) {
            (Some(unloaded), Some(own), Some(elastic)) => {
                let armed =
                    |body: usize| m.arms.iter().any(|arm| bodies.of_point[arm.point] == body);
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
            elastic = unloaded
                .as_ref()
                .zip(own.as_ref())
                .map(|(m, own)| Contributions::new(m, own, bodies));
        }
        let is_stiffened = |column: usize| {
            parts.diagonal[column] > 0.0
                || elastic
                    .as_ref()
                    .is_some_and(|elastic| elastic.diagonal[column] > 0.0)
        };
        // Bodies that are held take no part in the elimination.
        let moves = |&body: &usize| bodies.list[body].free.contains(&true);
        let edges: Vec<[usize; 2]> = parts
            .sums
            .pairs()
            .filter(|pair| pair.iter().all(moves))
            .collect();
        let mut unknown = vec![None; parts.diagonal.len()];
        let mut column = Vec::new();
        let (order, operations) = order(&Graph::new(bodies.list.len(), &edges));
        for body in order {
            let Body {
                free, unstiffened, ..
            } = &bodies.list[body];
            let stiffened = |&k: &usize| free[k] && !unstiffened[k] && is_stiffened(6 * body + k);
            for k in (0..6).filter(stiffened) {
                unknown[6 * body + k] = Some(column.len());
                column.push(6 * body + k);
            }
        }
        // The scale comes from the doubles also where the stiffness is formed again in double-doubles.
        let scale = column
            .iter()
            .map(|&c| scale_of(parts.diagonal[c]))
            .collect();
        Ok(parts.stiffness(Numbering {
            unknown,
            column,
            turned,
            scale,
            operations,
        }))
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
            let Body {
                free, unstiffened, ..
            } = &bodies.list[column / 6];
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
        let scale = known
            .column
            .iter()
            .map(|&c| scale_of(parts.diagonal[c]))
            .collect();
        Some(parts.stiffness(Numbering {
            scale,
            ..known.clone()
        }))
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
    let doubtful: Vec<bool> = parts
        .rotational
        .iter()
        .map(|block| !unstiffened_axes(block, DOUBTFUL_PIVOT).is_empty())
        .collect();
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
    let blocks = Contributions::new(m, &adjacent, &bodies).rotational;
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
