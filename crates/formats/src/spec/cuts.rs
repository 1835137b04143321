//! Sections of members whose internal forces are requested: the key `effects` of both forms.

use fea::Girder;

use super::members::Cells;
use super::raw::{RawCut, RawSpec};
use super::stress::StressPoint;
use crate::check::Check;
use crate::text::fault::{Fault, number};
use crate::text::names::check_free_name;
use crate::text::place::Place;
use crate::units::Dimension;

/// A section of a member whose internal forces are requested.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// Its name.
    pub name: String,
    /// Its location, in the terms of the spec.
    pub place_in_spec: CutPlace,
    /// Index of the member.
    pub member: usize,
    /// Position along the flexible part of the member, as a fraction of its length from end a, 0..=1.
    pub place: f64,
    /// Points of the section whose stresses are requested.
    pub points: Vec<StressPoint>,
}

/// A position on a structure in the terms of the spec.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutPlace {
    /// Coordinate along a girder, in length.
    Along(f64),
    /// Block and index of a cell, and the position along its flexible part as a fraction from end a, 0..=1.
    Cell([usize; 2], f64),
}

/// Reads the cuts of a girder. A cut at a support is located just beyond it, a cut at the last end of the girder just
/// before it.
///
/// `faultless` specifies that the girder has no fault, so that cuts can be located on its members.
pub(super) fn read_girder(
    raw: &RawSpec,
    girder: &Girder,
    points: &[StressPoint],
    faultless: bool,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<Cut> {
    let mut cuts = Vec::new();
    let [before, after] = girder.overhangs;
    let mut bounds = vec![0.0];
    for span in &girder.spans {
        bounds.push(bounds[bounds.len() - 1] + span);
    }
    if before > 0.0 {
        bounds.insert(0, -before);
    }
    if after > 0.0 {
        bounds.push(bounds[bounds.len() - 1] + after);
    }
    each(raw, root, check, |raw, at, name, check| {
        for (key, given) in [("cell", raw.cell.is_some()), ("at", raw.at.is_some())] {
            if given {
                let fault = Fault::new(
                    &at.key(key),
                    format!("`{key}` is a key of the general form"),
                )
                .at_key();
                check.faults.add(fault.hint(
                    "in the short form its position is `x`, measured from the first support",
                ));
            }
        }
        let Some(&given) = check.faults.require(&raw.x, at, "x") else {
            return;
        };
        let x = check.number(given, &at.key("x"), Dimension::LENGTH);
        let (first, last) = (bounds[0], bounds[bounds.len() - 1]);
        let slack = 1e-12 * (last - first);
        if !faultless {
            return;
        }
        if x < first - slack || x > last + slack {
            let factor = check.scale.factor(Dimension::LENGTH);
            let [first, last] = [first, last].map(|end| number(end / factor));
            let expected = format!("must be on the girder, from {first} to {last}");
            check
                .faults
                .add(Fault::new(&at.key("x"), expected).got(number(given)));
            return;
        }
        let members = bounds.len() - 1;
        let member = bounds[1..members].partition_point(|bound| *bound <= x + slack);
        let place = ((x - bounds[member]) / (bounds[member + 1] - bounds[member])).clamp(0.0, 1.0);
        cuts.push(Cut {
            name,
            place_in_spec: CutPlace::Along(x),
            member,
            place,
            points: points.to_vec(),
        });
    });
    cuts
}

/// Reads the cuts of the general form, on the cells of the file. `points` returns the stress points of a member.
pub(super) fn read_frame(
    raw: &RawSpec,
    cells: &Cells,
    points: &dyn Fn(usize) -> Vec<StressPoint>,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<Cut> {
    let mut cuts = Vec::new();
    each(raw, root, check, |raw, at, name, check| {
        if raw.x.is_some() {
            let fault = Fault::new(&at.key("x"), "`x` is a key of the short form").at_key();
            check.faults.add(fault.hint(
                "in the general form its position is `at`, a fraction of the length of its `cell`",
            ));
        }
        let cell = check.faults.require(&raw.cell, at, "cell").copied();
        let place = check.faults.require(&raw.at, at, "at").copied();
        if let Some(place) = place.filter(|place| !(0.0..=1.0).contains(place)) {
            let fault = Fault::new(&at.key("at"), "must be from 0 to 1")
                .got(number(place))
                .of_value();
            check
                .faults
                .add(fault.hint("0 is the flexible end a of the cell, 1 its flexible end b"));
        }
        let member = cell.and_then(|cell| cells.of(cell, &at.key("cell"), check));
        if let (Some(cell), Some(member), Some(place)) = (cell, member, place) {
            cuts.push(Cut {
                name,
                place_in_spec: CutPlace::Cell(cell, place),
                member,
                place,
                points: points(member),
            });
        }
    });
    cuts
}

/// Calls `read` for every entry, with its place and its name. A name that is empty or not unique is a fault.
fn each(
    raw: &RawSpec,
    root: &Place<'_>,
    check: &mut Check<'_>,
    mut read: impl FnMut(&RawCut, &Place<'_>, String, &mut Check<'_>),
) {
    let list = root.key("effects");
    let mut names: Vec<&str> = Vec::new();
    for (index, raw) in raw.effects.iter().flatten().enumerate() {
        let at = list.index(index);
        let name = check
            .faults
            .require(&raw.name, &at, "name")
            .map(String::as_str)
            .unwrap_or_default();
        check_free_name(name, &at.key("name"), check.faults);
        if raw.name.is_some() && (name.is_empty() || names.contains(&name)) {
            let fault = Fault::new(&at.key("name"), "must differ from the other names")
                .got(format!("\"{name}\""));
            check.faults.add(fault);
        }
        names.push(name);
        read(raw, &at, name.to_owned(), check);
    }
}
