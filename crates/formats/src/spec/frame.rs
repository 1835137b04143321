//! The general form of a spec: points, members, supports and springs, links, masses, and rails.

use fea::{
    BeamTheory, Dof, GroundSpring, Member, Model, PointMass, RailSegment, RigidLink, Support, Taper,
};

use super::cuts::{self, Cut};
use super::outline::MemberOutline;
use super::preload::{self, SpecPreload};
use super::raw::RawSpec;
use super::references::{Points, dofs, index_below};
use super::shape::ShapeTaper;
use super::stress::{self, StressPoint};
use super::structure::{FrameSpec, has_mass};
use super::words::DOF_WORDS;
use super::{crane_rail, members, rails, sections};
use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::names::check_free_key;
use crate::text::place::Place;
use crate::units::Dimension;
use crate::vector::length;

/// Default upward direction.
const UP: [f64; 3] = [0.0, 1.0, 0.0];

/// Reads the general form: the structure, the sections whose internal forces are requested, and the preload.
///
/// All parts are read even if an earlier one has faults, so that every fault is reported at once. Checks that require
/// valid members (extent of rails, completeness of sections, tapers) are skipped if a member has a fault.
pub(super) fn read(
    raw: &RawSpec,
    theory: BeamTheory,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> (FrameSpec, Vec<Cut>, Option<SpecPreload>) {
    let mut model = Model {
        theory,
        up: raw.up.unwrap_or(UP),
        ..Model::default()
    };
    if length(model.up) == 0.0 {
        check
            .faults
            .add(Fault::new(&root.key("up"), "must not be zero"));
    }
    let place = root.key("points");
    for (index, point) in check
        .faults
        .require(&raw.points, root, "points")
        .into_iter()
        .flatten()
        .enumerate()
    {
        model
            .points
            .push(check.vector(*point, &place.index(index), Dimension::LENGTH));
    }
    if raw.stations.is_some() {
        let fault = Fault::new(
            &root.key("stations"),
            "`stations` is a key of the short form",
        )
        .at_key();
        check
            .faults
            .add(fault.hint("in the general form each rail has its own `stations`"));
    }
    let sections = sections::read(raw.tables(), root, &mut model, check);
    let cells = members::read(raw, root, &sections, &mut model, check);
    if cells.complete {
        sections::check_complete(raw.tables(), root, &model, &cells.tapers, "", check);
    }
    let point_sets = read_sets(raw, root, &model, check);
    let known = Points {
        count: model.points.len(),
        sets: &point_sets,
    };
    let supports = read_supports(raw, root, &known, &mut model, check);
    read_springs(raw, root, &known, &mut model, check);
    read_links(raw, root, &known, &mut model, check);
    read_masses(raw, root, &known, &mut model, check);
    let preload = preload::read(raw, root, None, &known, has_mass(&model), check);
    let (rails, ranges) = rails::read(raw, root, &model, &cells, check);
    let points = stress::of_sections(raw.tables(), root, check);
    // a tapered cell has no section of the file between its ends, and therefore no stress points
    let points_of = |member: usize| -> Vec<StressPoint> {
        let uniform = cells.tapers.get(member).is_some_and(Option::is_none);
        let section = model
            .members
            .get(member)
            .map(|member| member.section)
            .filter(|_| uniform);
        section
            .and_then(|section| points.get(section))
            .cloned()
            .unwrap_or_default()
    };
    let cuts = cuts::read_frame(raw, &cells, &points_of, root, check);
    let points = model.points.len();
    let member_outlines = member_outlines(&model, &cells.tapers);
    let frame = FrameSpec {
        model,
        rails,
        ranges,
        sections,
        points,
        cells: cells.places,
        point_sets,
        supports,
        pads: Vec::new(),
        member_outlines,
    };
    let (mut frame, cuts) = if cells.complete {
        let shapes = shapes(raw, &frame.model, &cells.tapers, check);
        let cut =
            |preload: &SpecPreload| preload::cut_for_weight(&frame.model, &cells.tapers, preload);
        let tapers = preload.as_ref().map_or_else(|| cells.tapers.clone(), cut);
        in_parts(frame, cuts, &tapers, &shapes)
    } else {
        (frame, cuts)
    };
    crane_rail::add(raw, root, &mut frame, check);
    (frame, cuts, preload)
}

/// The section of the file that each member has, before crane rails change it.
fn member_outlines(model: &Model, tapers: &[Option<Taper>]) -> Vec<MemberOutline> {
    let own = |(index, member): (usize, &Member)| {
        let taper = tapers.get(index).copied().flatten();
        MemberOutline {
            section: member.section,
            taper: taper
                .filter(|taper| taper.section != member.section)
                .map(|taper| (taper.section, [0.0, 1.0])),
        }
    };
    model.members.iter().enumerate().map(own).collect()
}

/// The shapes of each tapered member whose sections have shapes of one kind.
fn shapes(
    raw: &RawSpec,
    model: &Model,
    tapers: &[Option<Taper>],
    check: &Check<'_>,
) -> Vec<Option<ShapeTaper>> {
    let section = |index: usize| {
        raw.sections
            .as_ref()
            .and_then(|sections| sections.get(index))
    };
    let between = |(member, taper): (&Member, &Option<Taper>)| {
        let (a, b) = section(member.section).zip(section((*taper)?.section))?;
        ShapeTaper::between(a, b, &check.scale)
    };
    model.members.iter().zip(tapers).map(between).collect()
}

/// Replaces each tapered member by uniform parts. Rails are extended over all parts, and each cut is moved to the
/// part that contains it.
fn in_parts(
    frame: FrameSpec,
    mut cuts: Vec<Cut>,
    tapers: &[Option<Taper>],
    shapes: &[Option<ShapeTaper>],
) -> (FrameSpec, Vec<Cut>) {
    if tapers.iter().all(Option::is_none) {
        return (frame, cuts);
    }
    let sections = &frame.model.sections;
    let (model, parts) = frame.model.tapered_by(tapers, |member, range| {
        let ends = [frame.model.members[member].section, tapers[member]?.section];
        let [a, b] = ends.map(|section| &sections[section]);
        shapes[member].as_ref()?.section(a, b, range)
    });
    let mut rails = frame.rails;
    for (_, rail) in &mut rails {
        let segments = std::mem::take(&mut rail.segments);
        rail.segments = segments
            .iter()
            .flat_map(|segment| {
                parts[segment.member]
                    .clone()
                    .map(|member| RailSegment { member, ..*segment })
            })
            .collect();
    }
    for cut in &mut cuts {
        let own = &parts[cut.member];
        let along = cut.place * own.len() as f64;
        // `along` is between 0 and the number of parts
        let part = (along as usize).min(own.len().saturating_sub(1));
        cut.member = own.start + part;
        cut.place = (along - part as f64).min(1.0);
    }
    let cells = frame
        .cells
        .iter()
        .zip(&parts)
        .flat_map(|(cell, own)| own.clone().map(|_| *cell))
        .collect();
    let member_outlines = frame
        .member_outlines
        .iter()
        .zip(&parts)
        .flat_map(|(own, parts)| {
            let count = parts.len() as f64;
            (0..parts.len()).map(move |part| MemberOutline {
                taper: own
                    .taper
                    .map(|(other, _)| (other, [part, part + 1].map(|k| k as f64 / count))),
                ..*own
            })
        })
        .collect();
    (
        FrameSpec {
            model,
            rails,
            cells,
            member_outlines,
            ..frame
        },
        cuts,
    )
}

/// Reads the supports. The result contains, for each support of the model, the index of the corresponding support in
/// the file.
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
        let supported = known.all(&raw.point, "point", &at, check);
        let place = at.key("fix");
        let fix = check
            .faults
            .require(&raw.fix, &at, "fix")
            .map(|words| words.as_slice())
            .unwrap_or_default();
        let fix = dofs(fix, &place, check);
        given.extend(supported.iter().map(|_| index));
        model.supports.extend(
            supported
                .into_iter()
                .map(|point| Support { point, fixed: fix }),
        );
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
        let dof = check
            .faults
            .require(&raw.dof, &at, "dof")
            .and_then(|word| check.faults.one_of(word, &at.key("dof"), &DOF_WORDS));
        let rotational = matches!(dof, Some(Dof::Rx | Dof::Ry | Dof::Rz));
        let dimension = if rotational {
            Dimension::MOMENT
        } else {
            Dimension::STIFFNESS
        };
        let stiffness = check.required_positive(raw.k, &at, "k", dimension, "stiffness to ground");
        let both = point.zip(dof);
        model.springs.extend(both.map(|(point, dof)| GroundSpring {
            point,
            dof,
            stiffness,
        }));
    }
}

fn read_links(
    raw: &RawSpec,
    root: &Place<'_>,
    known: &Points<'_>,
    model: &mut Model,
    check: &mut Check<'_>,
) {
    let list = root.key("links");
    for (index, raw) in raw.links.iter().flatten().enumerate() {
        let at = list.index(index);
        let from = known.one(&raw.from, "from", &at, check);
        let to = known.one(&raw.to, "to", &at, check);
        if let Some((from, to)) = from.zip(to) {
            if from == to {
                check.faults.add(
                    Fault::new(&at, "a link must join two points")
                        .got(format!("point {from} twice")),
                );
            }
            model.links.push(RigidLink { from, to });
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
        let mass = match check.faults.require(&raw.mass, &at, "mass") {
            Some(mass) => check.not_negative(*mass, &at.key("mass"), Dimension::MASS, ""),
            None => 0.0,
        };
        let place = at.key("inertia");
        let mut inertia = [0.0; 3];
        for (axis, value) in raw.inertia.unwrap_or_default().into_iter().enumerate() {
            inertia[axis] = check.not_negative(value, &place.index(axis), Dimension::INERTIA, "");
        }
        let offset = check.vector(
            raw.offset.unwrap_or_default(),
            &at.key("offset"),
            Dimension::LENGTH,
        );
        model.masses.extend(point.map(|point| PointMass {
            point,
            mass,
            inertia,
            offset,
        }));
    }
}

/// Reads the point sets. Indices beyond the number of points are faults.
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
        check_free_key(name, &at, check.faults);
        for (index, point) in set.iter().enumerate() {
            index_below(
                *point,
                model.points.len(),
                "points",
                &at.index(index),
                check,
            );
        }
    }
    sets.cloned().collect()
}
