//! Cells and their data: the members of the general form.

use fea::{Kind, Member, Model, Taper};

use super::block::{Block, Reference};
use super::frame::{freedoms, index_below, refer};
use super::raw::{RawCellData, RawSpec};
use super::tapers::Tapers;
use crate::check::Check;
use crate::fault::Fault;
use crate::place::Place;
use crate::units::Dimension;
use crate::vector::{length, parallel};

/// Where the members stand in the file.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    /// Block and index of each member.
    pub places: Vec<[usize; 2]>,
    /// Cells a block.
    pub counts: Vec<usize>,
    /// How each member differs from a uniform one.
    pub tapers: Vec<Option<Taper>>,
    /// Whether every cell became a member, of the kind meant.
    pub whole: bool,
}

impl Cells {
    /// The member of a cell given as [block, index]; a fault where there is none.
    pub fn of(&self, [block, index]: [usize; 2], at: &Place<'_>, check: &mut Check<'_>) -> Option<usize> {
        if self.counts.get(block).is_some_and(|count| index < *count) {
            return Some(self.counts[..block].iter().sum::<usize>() + index);
        }
        let fault = Fault::new(at, "must be [block, index] of a cell");
        check.faults.add(fault.got(format!("[{block}, {index}]")).hint("indices count from 0"));
        None
    }
}

/// One array of `cell_data`, with its place in the file.
pub(super) struct Column<'r, T> {
    pub key: &'static str,
    given: bool,
    blocks: Option<&'r Vec<Block<T>>>,
}

impl<'r, T: PartialEq> Column<'r, T> {
    /// One array a block, one item a cell, or one item a block; wrong lengths are faults and leave the column out.
    pub fn new(
        key: &'static str,
        blocks: &'r Option<Vec<Block<T>>>,
        counts: &[usize],
        at: &Place<'_>,
        check: &mut Check<'_>,
    ) -> Self {
        let Some(given) = blocks else { return Column { key, given: false, blocks: None } };
        let before = check.faults.0.len();
        let place = at.key(key);
        let hint = "cell_data has one array for each block of `cells`, with one item for each cell, or one item for the block";
        if given.len() != counts.len() {
            let fault = Fault::new(&place, format!("must have {} arrays", counts.len())).got(given.len());
            check.faults.add(fault.hint(hint));
        }
        for (block, (items, count)) in given.iter().zip(counts).enumerate() {
            let Block::Each(items) = items else { continue };
            if items.len() != *count {
                let fault =
                    Fault::new(&place.index(block), format!("must have {count} items")).got(items.len());
                check.faults.add(fault.hint(hint));
            }
        }
        Column { key, given: true, blocks: (check.faults.0.len() == before).then_some(given) }
    }

    pub fn get(&self, block: usize, index: usize) -> Option<&'r T> {
        self.blocks.and_then(|blocks| blocks.get(block)).and_then(|items| items.get(index))
    }

    /// Whether the column has nothing for this block.
    fn absent(&self, block: usize) -> bool {
        self.blocks.and_then(|blocks| blocks.get(block)).is_some_and(|items| *items == Block::Absent)
    }

    /// The path of a cell's item, below `cell_data` at `data`: that of its block where it has no other.
    pub fn at<R>(
        &self,
        [block, index]: [usize; 2],
        data: &Place<'_>,
        then: impl FnOnce(&Place<'_>) -> R,
    ) -> R {
        let key = data.key(self.key);
        let place = key.index(block);
        match self.blocks.and_then(|blocks| blocks.get(block)) {
            Some(Block::Each(_)) => then(&place.index(index)),
            _ => then(&place),
        }
    }
}

/// Reads `cells` and `cell_data` into the model.
///
/// `sections`: the names of the model's sections.
pub(super) fn read(
    raw: &RawSpec,
    root: &Place<'_>,
    sections: &[String],
    model: &mut Model,
    check: &mut Check<'_>,
) -> Cells {
    let names: Vec<(&str, usize)> =
        sections.iter().enumerate().map(|(index, name)| (name.as_str(), index)).collect();
    let Some(blocks) = check.faults.need(&raw.cells, root, "cells") else { return Cells::default() };
    let before = check.faults.0.len();
    let list = root.key("cells");
    let mut counts = Vec::new();
    for (block, raw) in blocks.iter().enumerate() {
        let at = list.index(block);
        if let Some(kind) = check.faults.need(&raw.kind, &at, "type") {
            check.faults.word(kind, &at.key("type"), &[("line", ())]);
        }
        counts.push(check.faults.need(&raw.data, &at, "data").map_or(0, Vec::len));
    }
    let none = RawCellData::default();
    let data = raw.cell_data.as_ref().unwrap_or(&none);
    let columns = Columns::new(data, &counts, root, check);
    let tapers = Tapers::new(raw, data, &counts, root, check);
    let mut cells = Cells { counts, ..Cells::default() };
    for (block, raw) in blocks.iter().enumerate() {
        let at = list.index(block);
        let at = at.key("data");
        for (index, ends) in raw.data.iter().flatten().enumerate() {
            if let Some(member) =
                columns.member(*ends, block, index, &at.index(index), root, &names, model, check)
            {
                cells.tapers.push(tapers.of(
                    &member,
                    [block, index],
                    &at.index(index),
                    root,
                    &names,
                    model,
                    check,
                ));
                model.members.push(member);
                cells.places.push([block, index]);
            }
        }
    }
    if model.members.is_empty() && check.faults.0.len() == before {
        check.faults.add(Fault::new(&list, "must have at least one cell"));
    }
    cells.whole = check.faults.0.len() == before;
    cells
}

struct Columns<'r> {
    kind: Column<'r, String>,
    section: Column<'r, Reference>,
    orientation: Column<'r, [f64; 3]>,
    offsets: [Column<'r, [f64; 3]>; 2],
    releases: [Column<'r, Vec<String>>; 2],
}

impl<'r> Columns<'r> {
    fn new(data: &'r RawCellData, counts: &[usize], root: &Place<'_>, check: &mut Check<'_>) -> Self {
        let at = root.key("cell_data");
        Columns {
            kind: Column::new("kind", &data.kind, counts, &at, check),
            section: Column::new("section", &data.section, counts, &at, check),
            orientation: Column::new("orientation", &data.orientation, counts, &at, check),
            offsets: [
                Column::new("offset_a", &data.offset_a, counts, &at, check),
                Column::new("offset_b", &data.offset_b, counts, &at, check),
            ],
            releases: [
                Column::new("release_a", &data.release_a, counts, &at, check),
                Column::new("release_b", &data.release_b, counts, &at, check),
            ],
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn member(
        &self,
        points: [usize; 2],
        block: usize,
        index: usize,
        cell: &Place<'_>,
        root: &Place<'_>,
        names: &[(&str, usize)],
        model: &Model,
        check: &mut Check<'_>,
    ) -> Option<Member> {
        let data = root.key("cell_data");
        let here = [block, index];
        let mut known = true;
        for (end, point) in points.into_iter().enumerate() {
            known &= index_below(point, model.points.len(), "points", &cell.index(end), check);
        }
        let kinds = [("beam", Kind::Beam), ("truss", Kind::Truss)];
        let kind = self
            .kind
            .get(block, index)
            .and_then(|word| self.kind.at(here, &data, |place| check.faults.word(word, place, &kinds)));
        let kind = kind.unwrap_or(Kind::Beam);
        let section = match self.section.get(block, index) {
            Some(section) => {
                self.section.at(here, &data, |place| refer(section, names, "section", place, check))
            }
            None if model.sections.len() == 1 => Some(0),
            None => {
                let blank = self.section.absent(block);
                if index == 0 && (blank || block == 0) && !model.sections.is_empty() {
                    let hint = "with several sections each cell needs its own, by name or index";
                    let fault = Fault::new(root, "missing key `cell_data.section`").hint(hint);
                    match blank {
                        true => {
                            let fault = Fault { path: data.key("section").index(block).path(), ..fault };
                            let expected = "must be the sections of this block".to_owned();
                            check.faults.add(Fault { expected, ..fault }.got("null"));
                        }
                        false if !self.section.given => check.faults.add(fault),
                        false => {}
                    }
                }
                None
            }
        };
        let mut offsets = [[0.0; 3]; 2];
        let mut releases = [[false; 6]; 2];
        for end in 0..2 {
            let column = &self.offsets[end];
            if let Some(offset) = column.get(block, index) {
                offsets[end] = column.at(here, &data, |at| check.vector(*offset, at, Dimension::LENGTH));
            }
            let column = &self.releases[end];
            if let Some(words) = column.get(block, index) {
                releases[end] = column.at(here, &data, |at| freedoms(words, at, check));
            }
        }
        if !known {
            return None;
        }
        let tip = |end: usize, axis: usize| model.points[points[end]][axis] + offsets[end][axis];
        let along = [0, 1, 2].map(|axis| tip(1, axis) - tip(0, axis));
        if length(along) == 0.0 {
            let fault = Fault::new(cell, "must have a length between its flexible ends").got(0);
            check.faults.add(fault.hint("its two ends coincide, offsets included"));
        }
        let given = self.orientation.get(block, index);
        let orientation = given.copied().unwrap_or(model.up);
        if kind == Kind::Beam && length(along) > 0.0 && parallel(orientation, along) {
            let fault = |place: &Place<'_>| {
                let found = format!("{} on a member along {}", listed(orientation), listed(along));
                let fault =
                    Fault::new(place, "its orientation must not be zero or along the member").got(found);
                fault.hint(match given {
                    Some(_) => "local y is the part of `orientation` normal to the member",
                    None => "without `orientation` local y is `up`: give upright members, as columns, one that lies across them, such as [0, 0, 1]",
                })
            };
            let fault = match given {
                Some(_) => self.orientation.at(here, &data, fault),
                None => fault(cell),
            };
            check.faults.add(fault);
        }
        Some(Member { points, kind, section: section?, orientation, offsets, releases })
    }
}

/// A vector as files have it.
fn listed(vector: [f64; 3]) -> String {
    format!("[{}]", vector.map(crate::fault::number).join(", "))
}
