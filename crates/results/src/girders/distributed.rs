//! Internal forces due to what is distributed along members: the inertia of the structure and its dead load.
//!
//! Both are computed at nodes of each member under a rail by the effects of the frame ([`crate::response::inertia`]). Between the
//! nodes, shear, normal force and torsion are linear, and a moment is the cubic with the slopes of its shear.

use nalgebra::DVectorView;
use trains::{GirderResponse, MemberForces};

use super::sections::Sections;
use crate::pieces::Bounds;
use crate::response::{dead_load, inertia};
use foundations::{BuiltFoundation, SolvedModel};

/// Number of quantities of a section.
pub(super) const FORCES: usize = 6;
/// Number of sections above which only the ends and the middle of members are nodes.
const MANY: usize = 2000;

/// Moments, and the shear forces that are their slopes.
pub(super) const SLOPES: [(GirderResponse, GirderResponse); 2] = [
    (
        GirderResponse::VerticalMoment,
        GirderResponse::VerticalShear,
    ),
    (GirderResponse::LateralMoment, GirderResponse::LateralShear),
];

/// The quantities of a section, in the order of [`GirderResponse::ALL`].
pub(super) type Quantities = [f64; FORCES];

/// Forces of inertia and dead load along every member under a rail.
pub(super) struct DistributedForces {
    members: Vec<MemberNodes>,
}

#[derive(Default)]
struct MemberNodes {
    /// Distances from the first end of the member.
    places: Vec<f64>,
    dead: Vec<Quantities>,
    /// Quantities that inertia changes anywhere on the member.
    moved: Vec<usize>,
    /// By node: each of these per unit acceleration of the degrees of freedom, with the sign of inertia, one quantity after the
    /// other.
    inertia: Vec<Vec<f64>>,
}

impl DistributedForces {
    /// The forces of a structure on the foundation `built`; `dead` is whether dead load counts.
    ///
    /// # Errors
    /// The errors of the frame solver.
    pub fn new(
        solved: &SolvedModel,
        built: &BuiltFoundation,
        members: &MemberForces,
        sections: &Sections,
        (gravity, dead): (f64, bool),
    ) -> Result<DistributedForces, fea::Error> {
        let mut nodes: Vec<MemberNodes> =
            members.members().map(|_| MemberNodes::default()).collect();
        if built.basis.is_none() && !dead {
            return Ok(DistributedForces { members: nodes });
        }
        let mut effects = Vec::new();
        for (index, (member, node)) in members.members().zip(&mut nodes).enumerate() {
            node.places = vec![0.0, 0.5 * member.length, member.length];
            if sections.sections.len() <= MANY {
                let own = sections.of_member[index]
                    .iter()
                    .map(|section| sections.sections[*section].place);
                node.places.extend(own);
            }
            node.places.sort_by(f64::total_cmp);
            node.places.dedup_by(|b, a| *b - *a <= 1e-9 * member.length);
            effects.extend(
                node.places
                    .iter()
                    .flat_map(|place| members.effects(index, *place)),
            );
        }
        let weight = match dead {
            true => dead_load(
                members.structure().frame(),
                &solved.model,
                gravity,
                &effects,
            )?,
            false => vec![0.0; effects.len()],
        };
        let inertia = inertia(&effects, built.basis.as_ref(), solved)?;
        let mut first = 0;
        for (index, node) in nodes.iter_mut().enumerate() {
            let mut by_dof = Vec::with_capacity(node.places.len());
            for _ in 0..node.places.len() {
                let own = std::array::from_fn(|k| weight[first + k]);
                node.dead.push(members.quantities(index, own));
                let per_dof = (0..inertia.ncols()).map(|dof| {
                    members.quantities(
                        index,
                        std::array::from_fn(|k| 0.0 - inertia[(first + k, dof)]),
                    )
                });
                by_dof.push(per_dof.collect::<Vec<Quantities>>());
                first += FORCES;
            }
            let is_moved = |k: &usize| by_dof.iter().flatten().any(|own| own[*k] != 0.0);
            node.moved = (0..FORCES).filter(is_moved).collect();
            let by_quantity = |own: &Vec<Quantities>| {
                node.moved
                    .iter()
                    .flat_map(|k| own.iter().map(|own| own[*k]))
                    .collect()
            };
            node.inertia = by_dof.iter().map(by_quantity).collect();
        }
        Ok(DistributedForces { members: nodes })
    }

    /// Whether each quantity is not zero throughout.
    pub fn acting(&self) -> [bool; FORCES] {
        let mut out = [false; FORCES];
        for member in &self.members {
            member.moved.iter().for_each(|k| out[*k] = true);
            for values in &member.dead {
                out.iter_mut()
                    .zip(values)
                    .for_each(|(out, value)| *out |= *value != 0.0);
            }
        }
        for (moment, shear) in SLOPES {
            out[moment as usize] |= out[shear as usize];
        }
        out
    }

    /// The quantities of a section of a member under the accelerations of the degrees of freedom, without dead load.
    pub fn inertia(&self, member: usize, place: f64, accelerations: &[f64]) -> Quantities {
        let nodes = &self.members[member];
        // no accelerations are known where none were recorded
        if nodes.moved.is_empty() || accelerations.is_empty() {
            return [0.0; FORCES];
        }
        let known = DVectorView::from_slice(accelerations, accelerations.len());
        nodes.between(place, |node| {
            let mut out = [0.0; FORCES];
            let each = nodes.inertia[node].chunks_exact(known.len());
            for (k, per) in nodes.moved.iter().zip(each) {
                out[*k] = DVectorView::from_slice(per, per.len()).dot(&known);
            }
            out
        })
    }

    /// Bounds of the quantities of a member under accelerations within bounds.
    pub fn inertia_bounds(&self, member: usize, accelerations: &[Bounds]) -> [Bounds; FORCES] {
        let nodes = &self.members[member];
        let mut out = [Bounds::ZERO; FORCES];
        let all = nodes.inertia.iter().filter(|_| !accelerations.is_empty());
        for (number, node) in all.enumerate() {
            for (k, per) in nodes
                .moved
                .iter()
                .zip(node.chunks_exact(accelerations.len()))
            {
                let mut sum = Bounds::ZERO;
                for (per, a) in per.iter().zip(accelerations) {
                    sum.add_product(Bounds::at(*per), *a);
                }
                out[*k] = if number == 0 { sum } else { out[*k].with(sum) };
            }
        }
        for (moment, shear) in SLOPES {
            let more = nodes.rise() * out[shear as usize].size();
            out[moment as usize].low -= more;
            out[moment as usize].high += more;
        }
        out
    }

    /// Largest magnitudes of the quantities of a member under accelerations up to these.
    pub fn inertia_size(&self, member: usize, accelerations: &[f64]) -> Quantities {
        let nodes = &self.members[member];
        let mut out = [0.0; FORCES];
        for node in nodes.inertia.iter().filter(|_| !accelerations.is_empty()) {
            let each = node.chunks_exact(accelerations.len());
            for (k, per) in nodes.moved.iter().zip(each) {
                let terms = per.iter().zip(accelerations);
                let sum: f64 = terms.map(|(per, a)| per.abs() * a).sum();
                out[*k] = sum.max(out[*k]);
            }
        }
        for (moment, shear) in SLOPES {
            out[moment as usize] += nodes.rise() * out[shear as usize];
        }
        out
    }

    /// Whether inertia changes forces of a member.
    pub fn is_moved(&self, member: usize) -> bool {
        !self.members[member].moved.is_empty()
    }

    /// Whether inertia or dead load acts along members.
    pub fn is_along(&self) -> bool {
        let acts = |member: &MemberNodes| {
            !member.moved.is_empty() || member.dead.iter().flatten().any(|value| *value != 0.0)
        };
        self.members.iter().any(acts)
    }

    /// The quantities of a section under dead load.
    pub fn dead(&self, member: usize, place: f64) -> Quantities {
        let nodes = &self.members[member];
        nodes.between(place, |node| nodes.dead[node])
    }
}

impl MemberNodes {
    /// Half of the largest distance of two nodes: between them a moment exceeds both by no more than its shear over this length.
    fn rise(&self) -> f64 {
        let distances = self.places.windows(2).map(|pair| pair[1] - pair[0]);
        0.5 * distances.fold(0.0, f64::max)
    }

    /// Interpolates between the values at two nodes.
    fn between(&self, place: f64, value: impl Fn(usize) -> Quantities) -> Quantities {
        if self.places.is_empty() {
            return [0.0; FORCES];
        }
        let b = self
            .places
            .partition_point(|node| *node < place)
            .clamp(1, self.places.len() - 1);
        let h = self.places[b] - self.places[b - 1];
        let t = ((place - self.places[b - 1]) / h).clamp(0.0, 1.0);
        if t == 0.0 || t == 1.0 {
            return value(if t == 0.0 { b - 1 } else { b });
        }
        let (low, high) = (value(b - 1), value(b));
        let mut out: Quantities = std::array::from_fn(|k| low[k] + t * (high[k] - low[k]));
        for (moment, shear) in SLOPES {
            let (m, v) = (moment as usize, shear as usize);
            // cubic with the values and slopes at both nodes, as the chord plus a part that vanishes at the nodes
            let chord = high[m] - low[m];
            let (from, to) = (h * low[v] - chord, h * high[v] - chord);
            out[m] += t * (1.0 - t) * ((1.0 - t) * from - t * to);
        }
        out
    }
}
