//! Internal forces and deflections of the girders of one structure at any time and place.

use sim::Foundation;
use splines::Probe;
use trains::{MemberForces, PassedLoads, SectionSide};

use super::distributed::{DistributedForces, FORCES, Quantities};
use super::instants::{LoadState, LoadStates};
use super::peaks::ScannedRow;
use super::points::{DIRECTIONS, PointDeflections, probe};
use super::sections::{MemberSection, Sections};
use crate::response::displacements;

/// The girders of a structure under the loads of a run.
pub(super) struct LoadedGirders<'a> {
    pub foundation: &'a Foundation,
    pub members: &'a MemberForces,
    pub distributed: &'a DistributedForces,
    pub sections: &'a Sections,
    pub states: &'a LoadStates,
    /// The rows at which all sections and points are evaluated; extremes are followed among the rows between them.
    pub scanned: &'a [usize],
    /// The deflections of all points.
    pub points: &'a PointDeflections<'a>,
    /// Whether nobody wants the results any more: loops over rows and points end early.
    pub is_stopped: &'a dyn Fn() -> bool,
    /// Of how many rows the first is among those at which deflections are evaluated: they change more slowly than forces.
    pub deflection_stride: usize,
    /// The scanned rows at which deflections are evaluated.
    pub deflected: Vec<usize>,
}

/// A load that stands at a section: its index, and whether the section is just behind it.
pub(super) type OwnLoad = Option<(usize, bool)>;

/// States in which a load passes a section: whether just after it, and whether the section is just behind the load. At the
/// end of a member only those count in which the load can stand on this side: `is_forward` is whether it moves towards
/// larger coordinates.
pub(super) fn passing(side: SectionSide, is_forward: bool) -> Vec<(bool, bool)> {
    match side {
        SectionSide::At => vec![(false, false), (false, true), (true, false), (true, true)],
        SectionSide::Before => vec![
            (!is_forward, false),
            (!is_forward, true),
            (is_forward, false),
        ],
        SectionSide::Behind => vec![(is_forward, false), (is_forward, true), (!is_forward, true)],
    }
}

/// Number of rows between two questions whether the work is still wanted.
const ROWS_BETWEEN: usize = 16;

impl LoadedGirders<'_> {
    /// The rows, or the first of them where the results are not wanted any more.
    pub fn rows(&self) -> impl Iterator<Item = usize> {
        (0..self.states.len())
            .take_while(|row| !row.is_multiple_of(ROWS_BETWEEN) || !(self.is_stopped)())
    }

    /// The scanned rows by their numbers, or the first of them where the results are not wanted any more.
    pub fn scanned_rows(&self) -> impl Iterator<Item = ScannedRow> {
        let rows = self
            .scanned
            .iter()
            .enumerate()
            .map(|(number, row)| ScannedRow { number, row: *row });
        rows.take_while(|at| !at.number.is_multiple_of(ROWS_BETWEEN) || !(self.is_stopped)())
    }

    /// Whether each quantity, in the order of [`trains::GirderResponse::ALL`], is not zero throughout.
    pub fn acting(&self) -> [bool; FORCES] {
        let of_loads = self.members.acting(self.states.directions());
        let distributed = self.distributed.acting();
        std::array::from_fn(|k| of_loads[k] || distributed[k])
    }

    /// The quantities of a section at a distance from the first end of a member.
    pub fn forces_in(
        &self,
        member: usize,
        place: f64,
        state: &LoadState<'_>,
        own: OwnLoad,
    ) -> Quantities {
        let mut passed = PassedLoads::default();
        self.members.load(member, &state.loads, &mut passed);
        self.sum(member, place, state, &passed, own)
    }

    /// The same where the loads on the member are known.
    pub fn sum(
        &self,
        member: usize,
        place: f64,
        state: &LoadState<'_>,
        passed: &PassedLoads,
        own: OwnLoad,
    ) -> Quantities {
        let mut out = passed.quantities(place, own);
        if !self.distributed.is_empty() {
            let more = self.distributed.at(member, place, &state.accelerations());
            out.iter_mut()
                .zip(more)
                .for_each(|(sum, value)| *sum += value);
        }
        out
    }

    /// The quantities of a section at a time.
    pub fn forces(&self, section: &MemberSection, position: f64) -> Quantities {
        self.forces_in(
            section.member,
            section.place,
            &self.states.at(position),
            None,
        )
    }

    /// The member of a rail on which a coordinate lies within a span, and the place on it.
    pub fn member_at(&self, rail: usize, x: f64, span: usize) -> Option<(usize, f64)> {
        let outline = &self.sections.rails[rail];
        let [from, to] = outline.bounds(span);
        if x < from || x > to || (from == to) {
            return None;
        }
        let of_rail = self
            .members
            .members()
            .enumerate()
            .filter(|(_, m)| m.rail == outline.rail);
        let mut on =
            of_rail.filter(|(_, m)| m.x[0] <= x && x <= m.x[1] && m.x[0] < to && m.x[1] > from);
        on.next()
            .map(|(index, _)| (index, self.members.place(index, x)))
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

    /// Deflections of points of a rail, downwards or along +z; `None` where they are not known or the structure is
    /// unrestrained in this direction.
    pub fn deflections(
        &self,
        rail: usize,
        x: &[f64],
        plane: usize,
        state: &LoadState<'_>,
    ) -> Option<Vec<f64>> {
        if !self.points.has(plane) {
            return None;
        }
        let rail = self.sections.rails[rail].rail;
        let probes: Vec<Probe> = x.iter().map(|&x| probe(rail, x, plane)).collect();
        let mut out = displacements(self.foundation, &probes, &state.loads, &state.dofs()).ok()?;
        out.iter_mut().for_each(|value| *value *= DIRECTIONS[plane]);
        Some(out)
    }

    /// Deflection of one point at a time.
    pub fn deflection(&self, rail: usize, x: f64, plane: usize, position: f64) -> f64 {
        let state = self.states.at(position);
        self.deflections(rail, &[x], plane, &state)
            .map_or(0.0, |all| all[0])
    }

    /// Dead load at a section.
    pub fn dead(&self, member: usize, place: f64) -> Quantities {
        if self.distributed.is_empty() {
            [0.0; FORCES]
        } else {
            self.distributed.dead(member, place)
        }
    }
}
