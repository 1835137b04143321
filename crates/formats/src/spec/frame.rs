//! The general form: points, members, what holds them, and rails on them.

use fea::{Freedom, Link, Mass, Model, Segment, Spring, Support, Taper, Theory};

use super::block::Reference;
use super::cuts::{self, Cut};
use super::raw::RawSpec;
use super::stress::{self, StressPoint};
use super::{members, rails, sections};
use crate::check::Check;
use crate::fault::Fault;
use crate::place::Place;
use crate::track::Pad;
use crate::units::Dimension;
use crate::vector::length;

/// A checked general form, in the units asked for: the model with the names that users know.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Points, members and what holds them.
    pub model: Model,
    /// Rails with their names, in the order of the file.
    pub rails: Vec<(String, fea::Rail)>,
    /// First and last coordinate of each rail.
    pub ranges: Vec<[f64; 2]>,
    /// Names of the sections.
    pub sections: Vec<String>,
    /// Number of points in the file; those of tapered members' parts follow them.
    pub points: usize,
    /// For each member, the block of `cells` and the index in it: parts of a tapered cell share it.
    pub cells: Vec<[usize; 2]>,
    /// Named sets of points.
    pub point_sets: Vec<(String, Vec<usize>)>,
    /// For each support of the model the one of the file that gave it; those of ties are not among them.
    pub supports: Vec<usize>,
    /// Between rail and structure, where ties carry the rail.
    pub pads: Vec<Pad>,
}

/// Words of the freedoms of points and members' ends.
pub(super) const FREEDOMS: [(&str, Freedom); 6] = [
    ("ux", Freedom::Ux),
    ("uy", Freedom::Uy),
    ("uz", Freedom::Uz),
    ("rx", Freedom::Rx),
    ("ry", Freedom::Ry),
    ("rz", Freedom::Rz),
];

/// Direction up where the spec gives none.
const UP: [f64; 3] = [0.0, 1.0, 0.0];

pub(super) fn read(
    raw: &RawSpec,
    theory: Theory,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> (Frame, Vec<Cut>) {
    let mut model = Model { theory, up: raw.up.unwrap_or(UP), ..Model::default() };
    if length(model.up) == 0.0 {
        check.faults.add(Fault::new(&root.key("up"), "must not be zero"));
    }
    let place = root.key("points");
    for (index, point) in check.faults.need(&raw.points, root, "points").into_iter().flatten().enumerate() {
        model.points.push(check.vector(*point, &place.index(index), Dimension::LENGTH));
    }
    if raw.stations.is_some() {
        let fault = Fault::new(&root.key("stations"), "`stations` belongs to the short form").at_key();
        check.faults.add(fault.hint("in the general form each of `rails` has its own"));
    }
    let sections = sections::read(raw, root, &mut model, check);
    let cells = members::read(raw, root, &sections, &mut model, check);
    if cells.whole {
        sections::complete(raw, root, &model, &cells.tapers, check);
    }
    let point_sets = read_sets(raw, root, &model, check);
    let known = Points { count: model.points.len(), sets: &point_sets };
    let supports = read_supports(raw, root, &known, &mut model, check);
    read_springs(raw, root, &known, &mut model, check);
    read_links(raw, root, &known, &mut model, check);
    read_masses(raw, root, &known, &mut model, check);
    let (rails, ranges) = rails::read(raw, root, &model, &cells, check);
    let points = stress::of_sections(raw, root, check);
    // a tapered cell has no section of its own between its ends
    let of = |member: usize| -> Vec<StressPoint> {
        let uniform = cells.tapers.get(member).is_some_and(Option::is_none);
        let section = model.members.get(member).map(|member| member.section).filter(|_| uniform);
        section.and_then(|section| points.get(section)).cloned().unwrap_or_default()
    };
    let cuts = cuts::read_frame(raw, &cells, &of, root, check);
    let points = model.points.len();
    let frame = Frame {
        model,
        rails,
        ranges,
        sections,
        points,
        cells: cells.places,
        point_sets,
        supports,
        pads: Vec::new(),
    };
    if cells.whole { in_parts(frame, cuts, &cells.tapers) } else { (frame, cuts) }
}

/// Puts uniform parts in the place of tapered cells; rails run over all parts, cuts are in theirs.
fn in_parts(frame: Frame, mut cuts: Vec<Cut>, tapers: &[Option<Taper>]) -> (Frame, Vec<Cut>) {
    if tapers.iter().all(Option::is_none) {
        return (frame, cuts);
    }
    let (model, parts) = frame.model.tapered(tapers);
    let mut rails = frame.rails;
    for (_, rail) in &mut rails {
        let segments = std::mem::take(&mut rail.segments);
        rail.segments = segments
            .iter()
            .flat_map(|segment| parts[segment.member].clone().map(|member| Segment { member, ..*segment }))
            .collect();
    }
    for cut in &mut cuts {
        let own = &parts[cut.member];
        let along = cut.place * own.len() as f64;
        // the index of a place within the cell is small and not negative
        let part = (along as usize).min(own.len().saturating_sub(1));
        cut.member = own.start + part;
        cut.place = (along - part as f64).min(1.0);
    }
    let cells = frame.cells.iter().zip(&parts).flat_map(|(cell, own)| own.clone().map(|_| *cell)).collect();
    (Frame { model, rails, cells, ..frame }, cuts)
}

/// What an index or a name can mean.
struct Points<'s> {
    /// How many there are.
    count: usize,
    /// Points by the name of their set.
    sets: &'s [(String, Vec<usize>)],
}

impl Points<'_> {
    /// The points that an index or the name of a point set means; all exist.
    fn all(&self, given: &Option<Reference>, key: &str, at: &Place<'_>, check: &mut Check<'_>) -> Vec<usize> {
        match check.faults.need(given, at, key) {
            None => Vec::new(),
            Some(Reference::Index(index)) => {
                let exists = index_below(*index, self.count, "points", &at.key(key), check);
                if exists { vec![*index] } else { Vec::new() }
            }
            Some(name) => {
                let names: Vec<(&str, usize)> =
                    self.sets.iter().enumerate().map(|(index, (name, _))| (name.as_str(), index)).collect();
                let set = refer(name, &names, "point set", &at.key(key), check);
                // points that do not exist are told where the set stands
                let all = set.map(|set| self.sets[set].1.as_slice()).unwrap_or_default();
                all.iter().copied().filter(|point| *point < self.count).collect()
            }
        }
    }

    /// The one point that an index or the name of a point set means.
    fn one(
        &self,
        given: &Option<Reference>,
        key: &str,
        at: &Place<'_>,
        check: &mut Check<'_>,
    ) -> Option<usize> {
        let before = check.faults.0.len();
        let found = self.all(given, key, at, check);
        if found.len() != 1 && check.faults.0.len() == before {
            let fault =
                Fault::new(&at.key(key), "must be one point").got(format!("a set of {}", found.len()));
            check.faults.add(fault.hint("supports alone take sets of several points"));
        }
        found.first().copied().filter(|_| found.len() == 1)
    }
}

/// What an index or a name means, of a list that has these names.
pub(super) fn refer(
    given: &Reference,
    names: &[(&str, usize)],
    what: &str,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<usize> {
    match given {
        Reference::Index(index) => {
            index_below(*index, names.len(), &format!("{what}s"), at, check).then_some(*index)
        }
        Reference::Name(name) => crate::scene::resolve(name, names, what, at, check.faults),
    }
}

/// Whether an index is within a list; a fault where it is not.
pub(super) fn index_below(
    index: usize,
    count: usize,
    what: &str,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> bool {
    if index >= count {
        let fault = Fault::new(at, format!("must be below {count}, the number of {what}")).got(index);
        check.faults.add(fault.hint("indices count from 0"));
    }
    index < count
}

/// A list of freedoms, each once, as a set.
pub(super) fn freedoms(words: &[String], at: &Place<'_>, check: &mut Check<'_>) -> [bool; 6] {
    let mut set = [false; 6];
    for (index, word) in words.iter().enumerate() {
        let item = at.index(index);
        let Some(freedom) = check.faults.word(word, &item, &FREEDOMS) else { continue };
        if set[freedom as usize] {
            check.faults.add(Fault::new(&item, "must stand there once").got(format!("\"{word}\" again")));
        }
        set[freedom as usize] = true;
    }
    set
}

fn read_supports(
    raw: &RawSpec,
    root: &Place<'_>,
    known: &Points<'_>,
    model: &mut Model,
    check: &mut Check<'_>,
) -> Vec<usize> {
    let list = root.key("supports");
    let mut given = Vec::new();
    for (index, raw) in raw.supports.iter().flatten().enumerate() {
        let at = list.index(index);
        let held = known.all(&raw.point, "point", &at, check);
        let place = at.key("fix");
        let fix = check.faults.need(&raw.fix, &at, "fix").map(|words| words.as_slice()).unwrap_or_default();
        let fix = freedoms(fix, &place, check);
        given.extend(held.iter().map(|_| index));
        model.supports.extend(held.into_iter().map(|point| Support { point, fix }));
    }
    given
}

fn read_springs(
    raw: &RawSpec,
    root: &Place<'_>,
    known: &Points<'_>,
    model: &mut Model,
    check: &mut Check<'_>,
) {
    let list = root.key("springs");
    for (index, raw) in raw.springs.iter().flatten().enumerate() {
        let at = list.index(index);
        let point = known.one(&raw.point, "point", &at, check);
        let freedom = check
            .faults
            .need(&raw.dof, &at, "dof")
            .and_then(|word| check.faults.word(word, &at.key("dof"), &FREEDOMS));
        let turns = matches!(freedom, Some(Freedom::Rx | Freedom::Ry | Freedom::Rz));
        let dimension = if turns { Dimension::MOMENT } else { Dimension::STIFFNESS };
        let stiffness = check.needed(raw.k, &at, "k", dimension, "stiffness to ground");
        let both = point.zip(freedom);
        model.springs.extend(both.map(|(point, freedom)| Spring { point, freedom, stiffness }));
    }
}

fn read_links(raw: &RawSpec, root: &Place<'_>, known: &Points<'_>, model: &mut Model, check: &mut Check<'_>) {
    let list = root.key("links");
    for (index, raw) in raw.links.iter().flatten().enumerate() {
        let at = list.index(index);
        let from = known.one(&raw.from, "from", &at, check);
        let to = known.one(&raw.to, "to", &at, check);
        if let Some((from, to)) = from.zip(to) {
            if from == to {
                check
                    .faults
                    .add(Fault::new(&at, "a link must join two points").got(format!("point {from} twice")));
            }
            model.links.push(Link { from, to });
        }
    }
}

fn read_masses(
    raw: &RawSpec,
    root: &Place<'_>,
    known: &Points<'_>,
    model: &mut Model,
    check: &mut Check<'_>,
) {
    let list = root.key("masses");
    for (index, raw) in raw.masses.iter().flatten().enumerate() {
        let at = list.index(index);
        let point = known.one(&raw.point, "point", &at, check);
        let mass = match check.faults.need(&raw.mass, &at, "mass") {
            Some(mass) => check.not_negative(*mass, &at.key("mass"), Dimension::MASS, ""),
            None => 0.0,
        };
        let place = at.key("inertia");
        let mut inertia = [0.0; 3];
        for (axis, value) in raw.inertia.unwrap_or_default().into_iter().enumerate() {
            inertia[axis] = check.not_negative(value, &place.index(axis), Dimension::INERTIA, "");
        }
        let offset = check.vector(raw.offset.unwrap_or_default(), &at.key("offset"), Dimension::LENGTH);
        model.masses.extend(point.map(|point| Mass { point, mass, inertia, offset }));
    }
}

fn read_sets(
    raw: &RawSpec,
    root: &Place<'_>,
    model: &Model,
    check: &mut Check<'_>,
) -> Vec<(String, Vec<usize>)> {
    let place = root.key("point_sets");
    let sets = raw.point_sets.iter().flat_map(|sets| &sets.0);
    for (name, set) in sets.clone() {
        let at = place.key(name);
        for (index, point) in set.iter().enumerate() {
            index_below(*point, model.points.len(), "points", &at.index(index), check);
        }
    }
    sets.cloned().collect()
}
