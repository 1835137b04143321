//! Tapered members of the general form: `section_b` and `parts`.

use fea::{Member, MemberKind, Model, Taper};

use super::block::Reference;
use super::column::Column;
use super::raw::{RawCellData, RawSpec};
use super::references::refer;
use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::place::Place;

/// Maximum number of uniform parts of a tapered member. A finer subdivision only adds rounding error.
const MAX_PARTS: usize = 1000;

/// The tapers of the file.
pub(super) struct Tapers<'r> {
    section_b: Column<'r, Option<Reference>>,
    parts: Column<'r, Option<usize>>,
    /// Number of parts of cells without a number of their own.
    default: Option<usize>,
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
            check_parts(parts, &root.key("parts"), check);
        }
        let at = root.key("cell_data");
        Tapers {
            section_b: Column::new("section_b", &data.section_b, counts, &at, check),
            parts: Column::new("parts", &data.parts, counts, &at, check),
            default: raw.parts,
        }
    }

    /// The taper of the cell [block, index] at `place`, which was converted to `member`; `None` for a uniform one.
    /// `names` are the names of the sections.
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
            self.parts
                .at(here, &data, |place| check_parts(parts, place, check));
        }
        let Some(other) = self.section_b.get(block, index).and_then(Option::as_ref) else {
            return own.map(|parts| Taper {
                section: member.section,
                parts,
            });
        };
        self.section_b.at(here, &data, |item| {
            let other = refer(other, names, "section", item, check)?;
            self.between(member, other, own, item, place, model, check)
        })
    }

    /// The taper of `member` to the section `other`, whose place in the file is `item`.
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
            let fault = Fault::new(item, "must have the same material as the cell's `section`");
            check
                .faults
                .add(fault.hint("a tapered cell has one material"));
        }
        for (name, pair) in [
            ("Asy", [a.shear_y, b.shear_y]),
            ("Asz", [a.shear_z, b.shear_z]),
        ] {
            if member.kind == MemberKind::Beam && pair[0].is_some() != pair[1].is_some() {
                let fault = Fault::new(
                    item,
                    format!("must have `{name}` if and only if the cell's `section` has it"),
                );
                let hint =
                    "shear areas vary linearly between two values, or are absent at both ends";
                check.faults.add(fault.hint(hint));
            }
        }
        // a tapered truss or rod remains a single bar
        let of_kind = (member.kind != MemberKind::Beam).then_some(1);
        let Some(parts) = own.or(self.default).or(of_kind) else {
            let hint = "a cell with `section_b` is solved in uniform parts: state their number in `parts` or \
                        `cell_data.parts`";
            check
                .faults
                .add(Fault::new(place, "missing key `parts`").hint(hint));
            return None;
        };
        Some(Taper {
            section: other,
            parts,
        })
    }
}

/// Adds a fault if the number of parts is out of range.
fn check_parts(parts: usize, at: &Place<'_>, check: &mut Check<'_>) {
    if !(1..=MAX_PARTS).contains(&parts) {
        let fault = Fault::new(at, format!("must be from 1 to {MAX_PARTS}"))
            .got(parts)
            .of_value();
        check
            .faults
            .add(fault.hint("errors decrease with the square of the number of parts"));
    }
}

#[cfg(test)]
mod tests;
