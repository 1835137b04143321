//! Internal forces and deflections of the girders of one structure at any time and place.

use sim::Foundation;
use splines::{Axis, Probe};
use trains::{MemberForces, PassedLoads};

use super::distributed::{DistributedForces, FORCES, Quantities};
use super::sections::Sections;
use crate::pieces::OwnLoad;
use crate::pieces::{LoadPieces, LoadState};
use crate::response::displacements;

/// Signs of the deflections, downwards and along +z, in displacements, by plane.
pub(super) const DIRECTIONS: [f64; 2] = [-1.0, 1.0];

/// The probe of a deflection in the vertical (0) or the lateral plane.
pub(super) fn probe(rail: usize, x: f64, plane: usize) -> Probe {
    Probe {
        rail,
        x,
        axis: [Axis::Vertical, Axis::Lateral][plane],
    }
}

/// The girders of a structure under the loads of a run.
pub(super) struct LoadedGirders<'a> {
    pub foundation: &'a Foundation,
    pub members: &'a MemberForces,
    pub distributed: &'a DistributedForces,
    pub sections: &'a Sections,
    pub pieces: &'a LoadPieces<'a>,
    /// Whether nobody wants the results any more: searches end early.
    pub is_stopped: &'a dyn Fn() -> bool,
}

impl LoadedGirders<'_> {
    /// Whether each quantity, in the order of [`trains::GirderResponse::ALL`], is not zero throughout.
    pub fn acting(&self) -> [bool; FORCES] {
        let of_loads = self.members.acting(self.pieces.directions());
        let distributed = self.distributed.acting();
        std::array::from_fn(|k| of_loads[k] || distributed[k])
    }

    /// The quantities of a section at a distance from the first end of a member, with dead load.
    pub fn forces(
        &self,
        member: usize,
        place: f64,
        state: &LoadState<'_>,
        own: OwnLoad,
    ) -> Quantities {
        let mut passed = PassedLoads::default();
        self.members.load(member, &state.loads, &mut passed);
        let mut out = passed.quantities(place, own);
        let inertia = self
            .distributed
            .inertia(member, place, state.accelerations());
        let dead = self.distributed.dead(member, place);
        for (sum, (inertia, dead)) in out.iter_mut().zip(inertia.into_iter().zip(dead)) {
            *sum += inertia + dead;
        }
        out
    }

    /// Deflections of points of a rail, downwards or along +z; `None` where they are not known or the structure is
    /// unrestrained in this direction.
    pub fn deflections(
        &self,
        rail: usize,
        x: &[f64],
        plane: usize,
        state: &LoadState<'_>,
    ) -> Option<Vec<f64>> {
        if !self.has_deflections() {
            return None;
        }
        let rail = self.sections.rails[rail].rail;
        let probes: Vec<Probe> = x.iter().map(|&x| probe(rail, x, plane)).collect();
        let mut out = displacements(self.foundation, &probes, &state.loads, state.dofs()).ok()?;
        out.iter_mut().for_each(|value| *value *= DIRECTIONS[plane]);
        Some(out)
    }

    /// Whether the deflections of the rails are known.
    pub fn has_deflections(&self) -> bool {
        let own = self.foundation;
        own.parts.is_none() && (own.structure.is_some() || own.compliance.is_some())
    }

    /// Whether a member carries the rail at a coordinate of a span, within rounding.
    pub fn is_carried(&self, rail: usize, x: f64, span: usize) -> bool {
        let outline = &self.sections.rails[rail];
        let near = outline.slack();
        let ([from, to], of_rail) = (outline.bounds(span), outline.rail);
        self.members.members().any(|member| {
            let ends = [member.x[0].max(from), member.x[1].min(to)];
            member.rail == of_rail
                && ends[1] - ends[0] > near
                && ends[0] - near <= x
                && x <= ends[1] + near
        })
    }
}
