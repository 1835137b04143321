//! Members of the general form, from `cells` and `cell_data`.

use fea::{Member, MemberKind, Model, Taper};

use super::block::Reference;
use super::column::Column;
use super::raw::{RawCellData, RawSpec};
use super::references::{dofs, index_below, refer};
use super::tapers::Tapers;
use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::place::Place;
use crate::units::Dimension;
use crate::vector::{length, parallel};

/// The cells of the file and the corresponding members.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    /// Block and index of the cell of each member.
    pub places: Vec<[usize; 2]>,
    /// Number of cells of each block.
    pub counts: Vec<usize>,
    /// The taper of each member; `None` for a uniform one.
    pub tapers: Vec<Option<Taper>>,
    /// Whether every cell was converted to a member without a fault.
    pub complete: bool,
}

impl Cells {
    /// Index of the member of the cell [block, index]; a fault if there is no such cell.
    pub fn of(
        &self,
        [block, index]: [usize; 2],
        at: &Place<'_>,
        check: &mut Check<'_>,
    ) -> Option<usize> {
        if self.counts.get(block).is_some_and(|count| index < *count) {
            return Some(self.counts[..block].iter().sum::<usize>() + index);
        }
        let fault = Fault::new(at, "must be [block, index] of a cell");
        check.faults.add(
            fault
                .got(format!("[{block}, {index}]"))
                .hint("indices count from 0"),
        );
        None
    }
}

/// Reads `cells` and `cell_data` into the model. `sections` are the names of the model's sections.
pub(super) fn read(
    raw: &RawSpec,
    root: &Place<'_>,
    sections: &[String],
    model: &mut Model,
    check: &mut Check<'_>,
) -> Cells {
    let names: Vec<(&str, usize)> = sections
        .iter()
        .enumerate()
        .map(|(index, name)| (name.as_str(), index))
        .collect();
    let Some(blocks) = check.faults.require(&raw.cells, root, "cells") else {
        return Cells::default();
    };
    let before = check.faults.0.len();
    let list = root.key("cells");
    let mut counts = Vec::new();
    for (block, raw) in blocks.iter().enumerate() {
        let at = list.index(block);
        if let Some(kind) = check.faults.require(&raw.kind, &at, "type") {
            check.faults.one_of(kind, &at.key("type"), &[("line", ())]);
        }
        counts.push(
            check
                .faults
                .require(&raw.data, &at, "data")
                .map_or(0, Vec::len),
        );
    }
    let none = RawCellData::default();
    let data = raw.cell_data.as_ref().unwrap_or(&none);
    let columns = Columns::new(data, &counts, root, check);
    let tapers = Tapers::new(raw, data, &counts, root, check);
    let mut cells = Cells {
        counts,
        ..Cells::default()
    };
    for (block, raw) in blocks.iter().enumerate() {
        let at = list.index(block);
        let at = at.key("data");
        for (index, ends) in raw.data.iter().flatten().enumerate() {
            if let Some(member) = columns.member(
                *ends,
                block,
                index,
                &at.index(index),
                root,
                &names,
                model,
                check,
            ) {
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
        check
            .faults
            .add(Fault::new(&list, "must have at least one cell"));
    }
    cells.complete = check.faults.0.len() == before;
    cells
}

/// The arrays of `cell_data`, except those of tapers.
struct Columns<'r> {
    kind: Column<'r, String>,
    section: Column<'r, Reference>,
    orientation: Column<'r, [f64; 3]>,
    offsets: [Column<'r, [f64; 3]>; 2],
    releases: [Column<'r, Vec<String>>; 2],
}

impl<'r> Columns<'r> {
    fn new(
        data: &'r RawCellData,
        counts: &[usize],
        root: &Place<'_>,
        check: &mut Check<'_>,
    ) -> Self {
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

    /// The member of a cell between two points; `None` and a fault if a point or its section is missing.
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
        let mut ends_exist = true;
        for (end, point) in points.into_iter().enumerate() {
            ends_exist &= index_below(point, model.points.len(), "points", &cell.index(end), check);
        }
        let kinds = [
            ("beam", MemberKind::Beam),
            ("truss", MemberKind::Truss),
            ("rod", MemberKind::Rod),
            ("cable", MemberKind::Cable),
        ];
        let kind = self.kind.get(block, index).and_then(|word| {
            self.kind.at(here, &data, |place| {
                check.faults.one_of(word, place, &kinds)
            })
        });
        let kind = kind.unwrap_or(MemberKind::Beam);
        let section = self.section(here, root, names, model.sections.len(), check);
        let (offsets, releases) = self.ends(here, &data, check);
        if !ends_exist {
            return None;
        }
        let tip = |end: usize, axis: usize| model.points[points[end]][axis] + offsets[end][axis];
        let along = [0, 1, 2].map(|axis| tip(1, axis) - tip(0, axis));
        if length(along) == 0.0 {
            let fault = Fault::new(
                cell,
                "must have a positive length between its flexible ends",
            )
            .got(0);
            check
                .faults
                .add(fault.hint("its two ends coincide after the offsets are added"));
        }
        let orientation = self
            .orientation
            .get(block, index)
            .copied()
            .unwrap_or(model.up);
        if kind == MemberKind::Beam && length(along) > 0.0 && parallel(orientation, along) {
            self.refuse_orientation(here, (orientation, along), cell, &data, check);
        }
        Some(Member {
            points,
            kind,
            section: section?,
            orientation,
            offsets,
            releases,
            tension: 0.0,
        })
    }

    /// The section of a cell. It may be left out if the spec has only one section; otherwise a missing section is
    /// reported once for its block.
    fn section(
        &self,
        here: [usize; 2],
        root: &Place<'_>,
        names: &[(&str, usize)],
        count: usize,
        check: &mut Check<'_>,
    ) -> Option<usize> {
        let data = root.key("cell_data");
        let [block, index] = here;
        if let Some(section) = self.section.get(block, index) {
            return self.section.at(here, &data, |place| {
                refer(section, names, "section", place, check)
            });
        }
        if count == 1 {
            return Some(0);
        }
        let absent = self.section.absent(block);
        if index == 0 && (absent || block == 0) && count > 0 {
            let hint = "if there are several sections, state the name or index of the section of each cell";
            if absent {
                let place = data.key("section");
                let fault =
                    Fault::new(&place.index(block), "must state the sections of this block");
                check.faults.add(fault.got("null").hint(hint));
            } else if !self.section.given {
                check
                    .faults
                    .add(Fault::new(root, "missing key `cell_data.section`").hint(hint));
            }
        }
        None
    }

    /// Offsets and releases of the two ends of a cell.
    fn ends(
        &self,
        here: [usize; 2],
        data: &Place<'_>,
        check: &mut Check<'_>,
    ) -> ([[f64; 3]; 2], [[bool; 6]; 2]) {
        let [block, index] = here;
        let mut offsets = [[0.0; 3]; 2];
        let mut releases = [[false; 6]; 2];
        for end in 0..2 {
            let column = &self.offsets[end];
            if let Some(offset) = column.get(block, index) {
                offsets[end] = column.at(here, data, |at| {
                    check.vector(*offset, at, Dimension::LENGTH)
                });
            }
            let column = &self.releases[end];
            if let Some(words) = column.get(block, index) {
                releases[end] = column.at(here, data, |at| dofs(words, at, check));
            }
        }
        (offsets, releases)
    }

    /// Adds the fault of an orientation that is parallel to its member, located at the orientation or, if it is the
    /// default, at the cell.
    fn refuse_orientation(
        &self,
        here: [usize; 2],
        (orientation, along): ([f64; 3], [f64; 3]),
        cell: &Place<'_>,
        data: &Place<'_>,
        check: &mut Check<'_>,
    ) {
        let found = format!(
            "{} on a member along {}",
            listed(orientation),
            listed(along)
        );
        let fault = |place: &Place<'_>| {
            Fault::new(
                place,
                "its orientation must not be zero or along the member",
            )
            .got(found)
        };
        check.faults.add(match self.orientation.get(here[0], here[1]) {
            Some(_) => self
                .orientation
                .at(here, data, fault)
                .hint("local y is the part of `orientation` normal to the member"),
            None => fault(cell).hint(
                "without `orientation` local y is `up`: vertical members such as columns need an orientation \
                 perpendicular to them, such as [0, 0, 1]",
            ),
        });
    }
}

/// A vector in the notation of the files.
fn listed(vector: [f64; 3]) -> String {
    format!("[{}]", vector.map(crate::text::fault::number).join(", "))
}
