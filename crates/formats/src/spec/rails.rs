//! Rails of the general form.

use fea::{Model, Rail, RailSegment};

use super::members::Cells;
use super::raw::{RawRail, RawSpec};
use crate::check::Check;
use crate::limits::STATIONS;
use crate::text::fault::{Fault, number};
use crate::text::names::check_free_key;
use crate::text::place::Place;
use crate::units::Dimension;
use crate::vector::{length, parallel};

/// Reads the rails. The second list contains the first and last coordinate of each.
pub(super) fn read(
    raw: &RawSpec,
    root: &Place<'_>,
    model: &Model,
    cells: &Cells,
    check: &mut Check<'_>,
) -> (Vec<(String, Rail)>, Vec<[f64; 2]>) {
    let list = root.key("rails");
    let mut rails = Vec::new();
    let mut ranges = Vec::new();
    let given = check
        .faults
        .require(&raw.rails, root, "rails")
        .map(|rails| rails.0.as_slice())
        .unwrap_or_default();
    if raw.rails.is_some() && given.is_empty() {
        check
            .faults
            .add(Fault::new(&list, "must have at least one rail"));
    }
    for (name, raw) in given {
        let at = list.key(name);
        check_free_key(name, &at, check.faults);
        if name.is_empty() || name.contains('.') {
            check.faults.add(
                Fault::new(&at, "must be a name without dots")
                    .got(format!("\"{name}\""))
                    .at_key(),
            );
        }
        let (rail, range) = read_rail(raw, &at, model, cells, check);
        rails.push((name.clone(), rail));
        ranges.push(range);
    }
    (rails, ranges)
}

/// Reads a rail and its range. The range is zero if the rail or a member has a fault.
fn read_rail(
    raw: &RawRail,
    at: &Place<'_>,
    model: &Model,
    cells: &Cells,
    check: &mut Check<'_>,
) -> (Rail, [f64; 2]) {
    let before = check.faults.0.len();
    let origin = raw.origin.unwrap_or_default();
    let origin = check.vector(origin, &at.key("origin"), Dimension::LENGTH);
    let axis = check
        .faults
        .require(&raw.axis, at, "axis")
        .copied()
        .unwrap_or([1.0, 0.0, 0.0]);
    if parallel(axis, model.up) && length(model.up) > 0.0 {
        let fault =
            Fault::new(&at.key("axis"), "must not be zero or along `up`").got(format!("{axis:?}"));
        check.faults.add(fault);
    }
    let (segments, places) = read_segments(raw, at, cells, check);
    let stations = raw.stations.as_deref();
    if stations.is_none() {
        check.faults.require(&raw.stations, at, "stations");
    }
    let stations = stations.unwrap_or_default();
    let line = at.key("stations");
    if raw.stations.is_some() && stations.is_empty() {
        check.faults.add(
            Fault::new(&line, "must have at least one station")
                .got("an empty list")
                .of_value(),
        );
    }
    check.items(stations.len(), &STATIONS, &line);
    check.faults.increasing(stations, &line);
    let mut rail = Rail {
        origin,
        axis,
        segments,
        stations: Vec::new(),
    };
    for (index, station) in stations.iter().enumerate() {
        rail.stations
            .push(check.number(*station, &line.index(index), Dimension::LENGTH));
    }
    if check.faults.0.len() > before || !cells.complete {
        return (rail, [0.0; 2]);
    }
    let range = cover(&rail, &places, model, &at.key("segments"), check);
    if check.faults.0.len() > before {
        return (rail, range);
    }
    let slack = 1e-12 * range[0].abs().max(range[1].abs());
    for (index, station) in rail.stations.iter_mut().enumerate() {
        if *station < range[0] - slack || *station > range[1] + slack {
            let factor = check.scale.factor(Dimension::LENGTH);
            let [first, last] = range.map(|end| number(end / factor));
            let expected = format!("must be on the rail, from {first} to {last}");
            let fault = Fault::new(&line.index(index), expected).got(number(stations[index]));
            check
                .faults
                .add(fault.hint("a station is a distance from `origin` along `axis`"));
        }
        *station = station.max(range[0]).min(range[1]);
    }
    (rail, range)
}

/// Reads the segments of a rail. The second list contains their indices in the file.
fn read_segments(
    raw: &RawRail,
    at: &Place<'_>,
    cells: &Cells,
    check: &mut Check<'_>,
) -> (Vec<RailSegment>, Vec<usize>) {
    let place = at.key("segments");
    let mut segments = Vec::new();
    let mut places = Vec::new();
    let Some(given) = check.faults.require(&raw.segments, at, "segments") else {
        return (segments, places);
    };
    if given.is_empty() {
        check.faults.add(
            Fault::new(&place, "must have at least one segment")
                .got("an empty list")
                .of_value(),
        );
    }
    for (index, raw) in given.iter().enumerate() {
        let item = place.index(index);
        let offset = check.vector(
            raw.offset.unwrap_or_default(),
            &item.key("offset"),
            Dimension::LENGTH,
        );
        let Some(&cell) = check.faults.require(&raw.cell, &item, "cell") else {
            continue;
        };
        if let Some(member) = cells.of(cell, &item.key("cell"), check) {
            segments.push(RailSegment { member, offset });
            places.push(index);
        }
    }
    (segments, places)
}

/// First and last coordinate of the segments along the rail. `places` contains their indices in the file. A segment
/// whose member has no extent along the rail is a fault.
fn cover(
    rail: &Rail,
    places: &[usize],
    model: &Model,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> [f64; 2] {
    let size = length(rail.axis);
    let along = |point: usize, offset: [f64; 3]| {
        let part = |axis: usize| {
            (model.points[point][axis] + offset[axis] - rail.origin[axis]) * rail.axis[axis]
        };
        (part(0) + part(1) + part(2)) / size
    };
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for (segment, index) in rail.segments.iter().zip(places) {
        let member = &model.members[segment.member];
        let ends = [0, 1].map(|end| along(member.points[end], member.offsets[end]));
        if ends[0] == ends[1] {
            let fault = Fault::new(
                &at.index(*index),
                "its cell must have an extent along the rail",
            );
            check
                .faults
                .add(fault.hint("a cell that is perpendicular to the rail cannot carry it"));
        }
        range = [
            range[0].min(ends[0]).min(ends[1]),
            range[1].max(ends[0]).max(ends[1]),
        ];
    }
    range
}
