//! Tapered cells of the general form: `section_b` and `parts`.

use fea::{Kind, Member, Model, Taper};

use super::block::Reference;
use super::frame::refer;
use super::members::Column;
use super::raw::{RawCellData, RawSpec};
use crate::check::Check;
use crate::fault::Fault;
use crate::place::Place;

/// Most parts of a tapered cell: more cost digits and gain none.
const MOST: usize = 1000;

/// What the file says of tapers.
pub(super) struct Tapers<'r> {
    section_b: Column<'r, Option<Reference>>,
    parts: Column<'r, Option<usize>>,
    /// Parts of cells that have no number of their own.
    general: Option<usize>,
}

impl<'r> Tapers<'r> {
    /// Reads `parts` and the two columns of `cell_data`.
    pub fn new(
        raw: &RawSpec,
        data: &'r RawCellData,
        counts: &[usize],
        root: &Place<'_>,
        check: &mut Check<'_>,
    ) -> Self {
        if let Some(parts) = raw.parts {
            number(parts, &root.key("parts"), check);
        }
        let at = root.key("cell_data");
        Tapers {
            section_b: Column::new("section_b", &data.section_b, counts, &at, check),
            parts: Column::new("parts", &data.parts, counts, &at, check),
            general: raw.parts,
        }
    }

    /// The taper of the cell at `place`, [block, index], that became `member`; `names`: those of the sections.
    #[allow(clippy::too_many_arguments)]
    pub fn of(
        &self,
        member: &Member,
        [block, index]: [usize; 2],
        place: &Place<'_>,
        root: &Place<'_>,
        names: &[(&str, usize)],
        model: &Model,
        check: &mut Check<'_>,
    ) -> Option<Taper> {
        let data = root.key("cell_data");
        let here = [block, index];
        let own = self.parts.get(block, index).copied().flatten();
        if let Some(parts) = own {
            self.parts.at(here, &data, |place| number(parts, place, check));
        }
        let Some(other) = self.section_b.get(block, index).and_then(Option::as_ref) else {
            return own.map(|parts| Taper { section: member.section, parts });
        };
        self.section_b.at(here, &data, |item| {
            let other = refer(other, names, "section", item, check)?;
            self.between(member, other, own, item, place, model, check)
        })
    }

    /// The taper of `member` to the section `other`, which the file gives at `item`.
    #[allow(clippy::too_many_arguments)]
    fn between(
        &self,
        member: &Member,
        other: usize,
        own: Option<usize>,
        item: &Place<'_>,
        place: &Place<'_>,
        model: &Model,
        check: &mut Check<'_>,
    ) -> Option<Taper> {
        let (a, b) = (&model.sections[member.section], &model.sections[other]);
        if (a.e, a.g) != (b.e, b.g) {
            let fault = Fault::new(item, "must be of the material of the cell's `section`");
            check.faults.add(fault.hint("a tapered cell has one material"));
        }
        for (name, pair) in [("Asy", [a.shear_y, b.shear_y]), ("Asz", [a.shear_z, b.shear_z])] {
            if member.kind == Kind::Beam && pair[0].is_some() != pair[1].is_some() {
                let fault = Fault::new(item, format!("must have `{name}` where the cell's `section` has it"));
                let hint = "shear areas vary linearly between two values, or are absent at both ends";
                check.faults.add(fault.hint(hint));
            }
        }
        // A tapered truss is one bar.
        let least = (member.kind == Kind::Truss).then_some(1);
        let Some(parts) = own.or(self.general).or(least) else {
            let hint = "a cell with `section_b` is solved in uniform parts: give their number in `parts` or \
                        `cell_data.parts`";
            check.faults.add(Fault::new(place, "missing key `parts`").hint(hint));
            return None;
        };
        Some(Taper { section: other, parts })
    }
}

fn number(parts: usize, at: &Place<'_>, check: &mut Check<'_>) {
    if !(1..=MOST).contains(&parts) {
        let fault = Fault::new(at, format!("must be from 1 to {MOST}")).got(parts);
        check.faults.add(fault.hint("errors fall with the square of the number of parts"));
    }
}
