//! Values of every section and beside every wheel at all rows of a history, and where wheels pass sections.

use splines::Axis;
use trains::{PassedLoads, RailLoad, SectionSide};

use super::distributed::{FORCES, Quantities};
use super::fibres::StressRows;
use super::girder::{LoadedGirders, passing};
use super::instants::LoadState;
use super::peaks::{PeakRows, Peaks, ScannedRow};
use super::points::{PointBlock, probe};

/// Peaks of the largest and of the smallest values of each quantity.
pub(super) type ForcePeaks = [Peaks; FORCES];

/// A wheel that passes a section: the time counted in rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
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
    /// By point and plane, with the numbers of the rows among [`LoadedGirders::deflected`].
    pub points: Vec<[Peaks; 2]>,
    /// By load, side (before, behind) and number of the span over all rails.
    pub wheels: Vec<ForcePeaks>,
    /// Deflections under loads: by load and number of the span over all rails, with rows like those of `points`.
    pub under: Vec<[Peaks; 2]>,
    /// First number of the spans of each rail, and the number of all.
    pub first_span: Vec<usize>,
    /// By section, each by increasing time.
    pub passages: Vec<Vec<Passage>>,
    pub stresses: StressRows,
    /// Largest magnitude of each quantity, and of both deflections.
    pub sizes: [f64; FORCES + 2],
    /// Whether each quantity is not zero throughout.
    acting: [bool; FORCES],
    /// The peaks so far: of the sections of each member, by quantity, and of the points of each block.
    of_members: Vec<[PeakRows; FORCES]>,
    of_blocks: Vec<PeakRows>,
}

/// Memory for the rows of a scan.
#[derive(Default)]
struct Workspace {
    passed: PassedLoads,
    /// Values of one quantity at the sections of a member, or of all of them section by section.
    values: Vec<f64>,
    all: Vec<Quantities>,
}

/// A row of girders as a row of a scan.
struct Target<'s> {
    scan: &'s mut Scan,
    row: ScannedRow,
    /// The same among those with deflections.
    deflections: Option<ScannedRow>,
}

impl<'s> Target<'s> {
    fn new(scan: &'s mut Scan, girders: &LoadedGirders<'_>, row: ScannedRow) -> Target<'s> {
        let number = girders.deflected.binary_search(&row.row).ok();
        let deflections = number.map(|number| ScannedRow {
            number,
            row: row.row,
        });
        Target {
            scan,
            row,
            deflections,
        }
    }
}

impl Scan {
    /// Scans the rows of `fine`, and those of `coarse`, which are the ones of `fine` with the numbers `chosen`.
    pub fn both(
        fine: &LoadedGirders<'_>,
        coarse: &LoadedGirders<'_>,
        chosen: &[usize],
    ) -> [Scan; 2] {
        let [mut all, mut few] = [Scan::empty(fine, true), Scan::empty(coarse, true)];
        let (mut next, mut memory) = (0, Workspace::default());
        for at in fine.scanned_rows() {
            let state = fine.states.at_row(at.row);
            let own = Target::new(&mut all, fine, at);
            if chosen.get(next) == Some(&at.number) {
                let other = ScannedRow {
                    number: next,
                    row: coarse.scanned[next],
                };
                add_row(
                    &mut [own, Target::new(&mut few, coarse, other)],
                    fine,
                    &state,
                    &mut memory,
                );
                next += 1;
            } else {
                add_row(&mut [own], fine, &state, &mut memory);
            }
        }
        [all.finished(fine), few.finished(coarse)]
    }

    /// Scans the rows for the sections and points alone: without the places of loads.
    pub fn of_sections(girders: &LoadedGirders<'_>) -> Scan {
        let (mut scan, mut memory) = (Scan::empty(girders, false), Workspace::default());
        for at in girders.scanned_rows() {
            let own = Target::new(&mut scan, girders, at);
            add_row(
                &mut [own],
                girders,
                &girders.states.at_row(at.row),
                &mut memory,
            );
        }
        scan.finished(girders)
    }

    fn empty(girders: &LoadedGirders<'_>, has_loads: bool) -> Scan {
        let sections = girders.sections;
        let mut first_span = vec![0];
        for rail in &sections.rails {
            first_span.push(first_span[first_span.len() - 1] + rail.ends.len() + 1);
        }
        let is_counted = has_loads && girders.states.len() > 0;
        let loads = if is_counted {
            girders.states.loads(0).len()
        } else {
            0
        };
        let spans = first_span[first_span.len() - 1];
        let acting = girders.acting();
        let of_member = |own: &Vec<usize>| {
            std::array::from_fn(|k| PeakRows::new(if acting[k] { own.len() } else { 0 }))
        };
        Scan {
            of_members: sections.of_member.iter().map(of_member).collect(),
            of_blocks: girders
                .points
                .blocks()
                .iter()
                .map(|block| PeakRows::new(block.points.len()))
                .collect(),
            sections: vec![ForcePeaks::default(); sections.sections.len()],
            points: vec![Default::default(); sections.points.len()],
            wheels: vec![ForcePeaks::default(); 2 * loads * spans],
            under: vec![Default::default(); loads * spans],
            first_span,
            passages: vec![Vec::new(); sections.sections.len()],
            stresses: StressRows::new(&sections.stressed, sections.sections.len(), loads),
            sizes: [0.0; FORCES + 2],
            acting,
        }
    }

    /// Ends all sequences, and adds the sections that loads pass between the rows.
    fn finished(mut self, girders: &LoadedGirders<'_>) -> Scan {
        let mut clear = Vec::new();
        for row in girders.rows().skip(1) {
            self.add_passages(girders, row - 1, &mut clear);
        }
        self.wheels.iter_mut().flatten().for_each(Peaks::finish);
        self.under.iter_mut().flatten().for_each(Peaks::finish);
        for (peaks, sections) in self.of_members.iter_mut().zip(&girders.sections.of_member) {
            for (k, peaks) in peaks.iter_mut().enumerate() {
                peaks.finish();
                sections
                    .iter()
                    .zip(peaks.found())
                    .for_each(|(at, found)| self.sections[*at][k] = (*found).into());
            }
        }
        for (peaks, PointBlock { plane, points, .. }) in
            self.of_blocks.iter_mut().zip(girders.points.blocks())
        {
            peaks.finish();
            let own = self.points[points.clone()].iter_mut().zip(peaks.found());
            own.for_each(|(point, found)| point[*plane] = (*found).into());
        }
        self
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

    fn add_size(&mut self, quantity: usize, values: &[f64]) {
        let size = &mut self.sizes[quantity];
        *size = values.iter().fold(*size, |most, value| {
            if value.abs() > most {
                value.abs()
            } else {
                most
            }
        });
    }

    /// Adds the sections that loads pass between a row and the next. `clear` are the stretches of rails without sections on which
    /// the loads stood last; none before the first row.
    fn add_passages(&mut self, girders: &LoadedGirders<'_>, row: usize, clear: &mut Vec<[f64; 2]>) {
        let sections = girders.sections;
        let [before, after] = [row, row + 1].map(|row| girders.states.loads(row));
        clear.resize(before.len(), [0.0; 2]);
        for (load, (from, to)) in before.iter().zip(after).enumerate() {
            let [low, high] = clear[load];
            if low < from.x && from.x < high && low < to.x && to.x < high {
                continue;
            }
            clear[load] = sections.clear_about(to.rail, to.x);
            // a load that rests is at the same place at all rows
            if (from.force == [0.0; 3] && to.force == [0.0; 3]) || (from.x == to.x && row > 0) {
                continue;
            }
            for index in sections.between(from.rail, [from.x.min(to.x), from.x.max(to.x)]) {
                let section = &sections.sections[index];
                let point = sections.points[section.point];
                let fraction = girders.states.passage(row, load, point.x, [from.x, to.x]);
                let position = row as f64 + fraction;
                for (is_after, is_behind) in passing(section.side, from.x <= to.x) {
                    let mut state = girders.states.limit(position, is_after);
                    state.loads.to_mut()[load].x = point.x;
                    let own = Some((load, is_behind));
                    let values = girders.forces_in(section.member, section.place, &state, own);
                    let sizes = self.sizes.iter_mut().zip(values);
                    sizes.for_each(|(size, value)| *size = size.max(value.abs()));
                    self.passages[index].push(Passage {
                        load,
                        position,
                        is_after,
                        is_behind,
                        values,
                    });
                }
            }
        }
    }
}

/// Adds the values of a row to one or two scans.
fn add_row(
    targets: &mut [Target<'_>],
    girders: &LoadedGirders<'_>,
    state: &LoadState<'_>,
    memory: &mut Workspace,
) {
    add_forces(targets, girders, state, memory);
    if targets.iter().any(|target| target.deflections.is_some()) {
        add_deflections(targets, girders, state);
    }
}

/// Adds the forces of all sections at a row, and of those just before and just behind each load.
fn add_forces(
    targets: &mut [Target<'_>],
    girders: &LoadedGirders<'_>,
    state: &LoadState<'_>,
    memory: &mut Workspace,
) {
    let sections = girders.sections;
    let has_loads = targets.iter().any(|target| !target.scan.wheels.is_empty());
    for (index, member) in girders.members.members().enumerate() {
        let Some(rail) = sections
            .rails
            .iter()
            .position(|rail| rail.rail == member.rail)
        else {
            continue;
        };
        if !has_loads && sections.of_member[index].is_empty() {
            continue;
        }
        girders
            .members
            .load(index, &state.loads, &mut memory.passed);
        let fibres = sections.stressed.of(index);
        add_sections(targets, girders, index, state, memory);
        let passed = &memory.passed;
        if !has_loads {
            continue;
        }
        for (load, place) in passed.places() {
            let x = girders.members.coordinate(index, place);
            // at the end of a member the side of the load is that of the member
            let is_first = x - member.x[0] < member.x[1] - x;
            let side = if is_first {
                SectionSide::Behind
            } else {
                SectionSide::Before
            };
            let span = sections.rails[rail].span(x, side);
            for is_behind in [false, true] {
                let values = girders.sum(index, place, state, passed, Some((load, is_behind)));
                for Target { scan, row, .. } in targets.iter_mut() {
                    let at = scan.wheel(load, is_behind, rail, span);
                    add(
                        &mut scan.wheels[at],
                        (&scan.acting, &mut scan.sizes),
                        *row,
                        &values,
                    );
                    scan.stresses
                        .add_wheel((load, is_behind), fibres, row.row, &values);
                }
            }
        }
    }
}

/// Adds the forces of the sections of a member at a row, quantity by quantity.
fn add_sections(
    targets: &mut [Target<'_>],
    girders: &LoadedGirders<'_>,
    member: usize,
    state: &LoadState<'_>,
    Workspace {
        passed,
        values,
        all,
    }: &mut Workspace,
) {
    let sections = girders.sections;
    let (own, places) = (&sections.of_member[member], &sections.places[member]);
    let fibres = sections.stressed.of(member);
    let is_whole = fibres.is_some() || !girders.distributed.is_empty();
    if is_whole {
        all.clear();
        all.extend(
            places
                .iter()
                .map(|place| girders.sum(member, *place, state, passed, None)),
        );
    }
    if fibres.is_some() {
        for Target { scan, row, .. } in targets.iter_mut() {
            let each = own.iter().zip(&*all);
            each.for_each(|(section, values)| {
                scan.stresses.add_section(*section, fibres, row.row, values)
            });
        }
    }
    values.resize(places.len(), 0.0);
    for k in 0..FORCES {
        if !targets.iter().any(|target| target.scan.acting[k]) {
            continue;
        }
        match is_whole {
            true => values
                .iter_mut()
                .zip(&*all)
                .for_each(|(value, all)| *value = all[k]),
            false => passed.fill(k, places, values),
        }
        for Target { scan, row, .. } in targets.iter_mut().filter(|target| target.scan.acting[k]) {
            scan.add_size(k, values);
            scan.of_members[member][k].add(*row, values);
        }
    }
}

/// Adds the deflections of all points at a row, and those under each load on a member.
fn add_deflections(targets: &mut [Target<'_>], girders: &LoadedGirders<'_>, state: &LoadState<'_>) {
    let (mut probes, mut under) = (Vec::new(), Vec::new());
    let has_loads = targets.iter().any(|target| !target.scan.under.is_empty());
    for block in girders.points.blocks().iter().filter(|_| has_loads) {
        let outline = &girders.sections.rails[block.rail];
        for (load, RailLoad { rail, x, .. }) in state.loads.iter().enumerate() {
            if *rail == outline.rail && *x >= outline.range[0] && *x <= outline.range[1] {
                let spans = outline
                    .spans_at(*x)
                    .filter(|span| girders.is_carried(block.rail, *x, *span));
                under.extend(spans.map(|span| (probes.len(), load, block.rail, span)));
                probes.push(probe(*rail, *x, block.plane));
            }
        }
    }
    let Some(all) = girders.points.at(state, &probes) else {
        return;
    };
    let (fixed, moving) = all.split_at(all.len() - probes.len());
    let plane_of = |index: usize| usize::from(probes[index].axis == Axis::Lateral);
    for Target {
        scan, deflections, ..
    } in targets.iter_mut()
    {
        let Some(row) = *deflections else { continue };
        for (block, PointBlock { plane, values, .. }) in girders.points.blocks().iter().enumerate()
        {
            let own = &fixed[values.clone()];
            scan.of_blocks[block].add(row, own);
            scan.add_size(FORCES + plane, own);
        }
        for (index, value) in moving.iter().enumerate() {
            scan.add_size(FORCES + plane_of(index), &[*value]);
        }
        for &(index, load, rail, span) in &under {
            let at = scan.under(load, rail, span);
            scan.under[at][plane_of(index)].add(row, moving[index]);
        }
    }
}

/// Adds the quantities that are not zero throughout.
fn add(
    peaks: &mut ForcePeaks,
    (acting, sizes): (&[bool; FORCES], &mut [f64]),
    row: ScannedRow,
    values: &[f64; FORCES],
) {
    for k in (0..FORCES).filter(|k| acting[*k]) {
        sizes[k] = sizes[k].max(values[k].abs());
        peaks[k].add(row, values[k]);
    }
}
