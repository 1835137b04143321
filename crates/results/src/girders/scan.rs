//! Values of every section and beside every wheel at all rows of a history, and where wheels pass sections.

use splines::Axis;
use trains::{PassedLoads, RailLoad, SectionSide};

use super::distributed::{FORCES, Quantities};
use super::fibres::StressRows;
use super::girder::{LoadedGirders, passing};
use super::instants::LoadState;
use super::peaks::Peak;
use super::points::{DIRECTIONS, PointBlock, probe};
use crate::response::displacements;

/// Signs with which the largest and the smallest values are the largest.
pub(super) const SIGNS: [f64; 2] = [1.0, -1.0];

/// Peaks of the largest and of the smallest values of each quantity.
pub(super) type ForcePeaks = [[Peak; 2]; FORCES];

/// A wheel that passes a section: the time counted in rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    pub section: usize,
    pub load: usize,
    pub position: f64,
    /// Whether it is the state just after the passage.
    pub is_after: bool,
    /// Whether the section is just behind the load.
    pub is_behind: bool,
    pub values: Quantities,
}

/// The peaks of all values over the rows of a history.
pub(super) struct Scan {
    /// By section.
    pub sections: Vec<ForcePeaks>,
    /// By point and plane, with rows counted in steps of [`LoadedGirders::deflection_stride`].
    pub points: Vec<[[Peak; 2]; 2]>,
    /// By load, side (before, behind) and number of the span over all rails.
    pub wheels: Vec<ForcePeaks>,
    /// Deflections under loads: by load and number of the span over all rails, with rows like those of `points`.
    pub under: Vec<[[Peak; 2]; 2]>,
    /// First number of the spans of each rail, and the number of all.
    pub first_span: Vec<usize>,
    pub passages: Vec<Passage>,
    pub stresses: StressRows,
    /// Largest magnitude of each quantity, and of both deflections.
    pub sizes: [f64; FORCES + 2],
}

impl Scan {
    /// Scans all rows.
    pub fn new(girders: &LoadedGirders<'_>) -> Scan {
        let sections = girders.sections;
        let mut first_span = vec![0];
        for rail in &sections.rails {
            first_span.push(first_span[first_span.len() - 1] + rail.ends.len() + 1);
        }
        let rows = girders.states.len();
        let loads = if rows > 0 { girders.states.at_row(0).loads.len() } else { 0 };
        let spans = first_span[first_span.len() - 1];
        let mut scan = Scan {
            sections: vec![ForcePeaks::default(); sections.sections.len()],
            points: vec![Default::default(); sections.points.len()],
            wheels: vec![ForcePeaks::default(); 2 * loads * spans],
            under: vec![Default::default(); loads * spans],
            first_span,
            passages: Vec::new(),
            stresses: StressRows::new(&sections.stressed, sections.sections.len(), loads),
            sizes: [0.0; FORCES + 2],
        };
        let mut before: Option<LoadState<'_>> = None;
        for row in 0..rows {
            let state = girders.states.at_row(row);
            scan.add_forces(girders, row, &state);
            if row.is_multiple_of(girders.deflection_stride) {
                scan.add_deflections(girders, row / girders.deflection_stride, &state);
            }
            if let Some(before) = &before {
                scan.add_passages(girders, row - 1, before, &state);
            }
            before = Some(state);
        }
        let forces = scan.sections.iter_mut().chain(&mut scan.wheels).flatten().flatten();
        let deflections = scan.points.iter_mut().chain(&mut scan.under).flatten().flatten();
        forces.chain(deflections).for_each(Peak::finish);
        scan
    }

    /// Index of the peaks beside a load in a span of a rail.
    pub fn wheel(&self, load: usize, is_behind: bool, rail: usize, span: usize) -> usize {
        let spans = self.first_span[self.first_span.len() - 1];
        (2 * load + usize::from(is_behind)) * spans + self.first_span[rail] + span
    }

    /// Index of the peaks under a load in a span of a rail.
    pub fn under(&self, load: usize, rail: usize, span: usize) -> usize {
        load * self.first_span[self.first_span.len() - 1] + self.first_span[rail] + span
    }

    /// Adds the forces of all sections at a row, and of those just before and just behind each load.
    fn add_forces(&mut self, girders: &LoadedGirders<'_>, row: usize, state: &LoadState<'_>) {
        let sections = girders.sections;
        let mut passed = PassedLoads::default();
        for (index, member) in girders.members.members().enumerate() {
            let Some(rail) = sections.rails.iter().position(|rail| rail.rail == member.rail) else {
                continue;
            };
            girders.members.load(index, &state.loads, &mut passed);
            let fibres = sections.stressed.of(index);
            for &section in &sections.of_member[index] {
                let place = sections.sections[section].place;
                let values = girders.sum(index, place, state, &passed, None);
                add(&mut self.sections[section], &mut self.sizes, row, &values);
                self.stresses.add_section(section, fibres, row, &values);
            }
            for (load, place) in passed.places() {
                let x = girders.members.coordinate(index, place);
                // at the end of a member the side of the load is that of the member
                let is_first = x - member.x[0] < member.x[1] - x;
                let side = if is_first { SectionSide::Behind } else { SectionSide::Before };
                let span = sections.rails[rail].span(x, side);
                for is_behind in [false, true] {
                    let values = girders.sum(index, place, state, &passed, Some((load, is_behind)));
                    let at = self.wheel(load, is_behind, rail, span);
                    add(&mut self.wheels[at], &mut self.sizes, row, &values);
                    self.stresses.add_wheel((load, is_behind), fibres, row, &values);
                }
            }
        }
    }

    /// Adds the deflections of all points at a row, and those under each load on a member.
    fn add_deflections(&mut self, girders: &LoadedGirders<'_>, row: usize, state: &LoadState<'_>) {
        let Some(all) = girders.points.at(state) else { return };
        let (mut probes, mut under) = (Vec::new(), Vec::new());
        for PointBlock { rail, plane, points, values } in girders.points.blocks().iter().cloned() {
            let own = &all[values];
            for (peaks, value) in self.points[points].iter_mut().zip(own) {
                add_signed(&mut peaks[plane], row, *value);
            }
            self.add_size(FORCES + plane, own);
            let outline = &girders.sections.rails[rail];
            for (load, RailLoad { rail: on, x, .. }) in state.loads.iter().enumerate() {
                if *on != outline.rail || *x < outline.range[0] || *x > outline.range[1] {
                    continue;
                }
                let spans = outline.spans_at(*x).filter(|span| girders.is_carried(rail, *x, *span));
                under.extend(spans.map(|span| (probes.len(), self.under(load, rail, span), plane)));
                probes.push(probe(*on, *x, plane));
            }
        }
        let Ok(moved) = displacements(girders.foundation, &probes, &state.loads, state.dofs()) else { return };
        for (probe, value) in probes.iter().zip(&moved) {
            self.add_size(FORCES + usize::from(probe.axis == Axis::Lateral), &[*value]);
        }
        for (index, at, plane) in under {
            add_signed(&mut self.under[at][plane], row, DIRECTIONS[plane] * moved[index]);
        }
    }

    fn add_size(&mut self, quantity: usize, values: &[f64]) {
        let size = &mut self.sizes[quantity];
        *size = values.iter().fold(*size, |most, value| most.max(value.abs()));
    }

    /// Adds the sections that loads pass between two rows.
    fn add_passages(&mut self, girders: &LoadedGirders<'_>, row: usize, a: &LoadState<'_>, b: &LoadState<'_>) {
        let sections = girders.sections;
        for (load, (from, to)) in a.loads.iter().zip(&b.loads).enumerate() {
            if from.force == [0.0; 3] && to.force == [0.0; 3] {
                continue;
            }
            let (low, high) = (from.x.min(to.x), from.x.max(to.x));
            for (index, section) in sections.sections.iter().enumerate() {
                let point = sections.points[section.point];
                if sections.rails[point.rail].rail != from.rail || point.x < low || point.x > high {
                    continue;
                }
                // a load that rests is at the same place at all rows
                if from.x == to.x && row > 0 {
                    continue;
                }
                let fraction = girders.states.passage(row, load, point.x, [from.x, to.x]);
                let position = row as f64 + fraction;
                for (is_after, is_behind) in passing(section.side, from.x <= to.x) {
                    let mut state = girders.states.limit(position, is_after);
                    state.loads[load].x = point.x;
                    let own = Some((load, is_behind));
                    let values = girders.forces_in(section.member, section.place, &state, own);
                    let sizes = self.sizes.iter_mut().zip(values);
                    sizes.for_each(|(size, value)| *size = size.max(value.abs()));
                    let passage = Passage { section: index, load, position, is_after, is_behind, values };
                    self.passages.push(passage);
                }
            }
        }
    }
}

fn add(peaks: &mut ForcePeaks, sizes: &mut [f64], row: usize, values: &[f64; FORCES]) {
    for ((own, size), value) in peaks.iter_mut().zip(sizes).zip(values) {
        *size = size.max(value.abs());
        add_signed(own, row, *value);
    }
}

/// Adds a value to the peaks of the largest and of the smallest values.
fn add_signed(peaks: &mut [Peak; 2], row: usize, value: f64) {
    peaks.iter_mut().zip(SIGNS).for_each(|(peak, sign)| peak.add(row, sign * value));
}
