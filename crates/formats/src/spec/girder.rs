//! The short form of a spec: a straight girder, continuous over its supports.

use fea::{BeamTheory, Girder};

use super::girder_section::filled_girder;
use super::raw::RawGirder;
use super::structure::range;
use crate::check::Check;
use crate::limits::{SPANS, STATIONS};
use crate::text::fault::{Fault, number};
use crate::text::place::Place;
use crate::units::Dimension;

/// Reads the member `girder` and its `stations`.
pub(super) fn read(
    raw: &RawGirder,
    stations: &Option<Vec<f64>>,
    theory: BeamTheory,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Girder {
    let at = root.key("girder");
    let raw = &filled_girder(raw, &at, check);
    let before = check.faults.0.len();
    let (spans, overhangs) = read_lengths(raw, &at, check);
    // stations can only be checked if the lengths are valid
    let raw_range = (check.faults.0.len() == before).then(|| range_of(raw));
    let mut optional =
        |value, key: &str, dimension| check.optional_positive(value, &at.key(key), dimension, "");
    let g = optional(raw.g, "G", Dimension::STRESS);
    let area = optional(raw.area, "A", Dimension::AREA);
    let i_lateral = optional(raw.i_lateral, "I_lateral", Dimension::SECOND_MOMENT);
    let j = optional(raw.j, "J", Dimension::SECOND_MOMENT);
    let ka_vertical = optional(raw.ka_vertical, "kA_vertical", Dimension::AREA);
    let ka_lateral = optional(raw.ka_lateral, "kA_lateral", Dimension::AREA);
    let e = check.required_positive(raw.e, &at, "E", Dimension::STRESS, "");
    let i_vertical = check.required_positive(
        raw.i_vertical,
        &at,
        "I_vertical",
        Dimension::SECOND_MOMENT,
        "",
    );
    let hint = "0 if the rail lies on the elastic axis";
    let height = raw.rail_height.unwrap_or_default();
    let rail_height = check.not_negative(height, &at.key("rail_height"), Dimension::LENGTH, hint);
    let mass_per_length = raw
        .mass_per_length
        .map(|mass| check.not_negative(mass, &at.key("mass_per_length"), Dimension::LINE_MASS, ""));
    let sheared =
        theory == BeamTheory::Timoshenko && (ka_vertical.is_some() || ka_lateral.is_some());
    if sheared && g.is_none() {
        let fault = Fault::new(&at, "missing key `G`");
        check
            .faults
            .add(fault.hint("kA_vertical and kA_lateral have no effect without it"));
    }
    let girder = Girder {
        stations: read_stations(stations, (&spans, overhangs), raw_range, root, check),
        spans,
        overhangs,
        e,
        g,
        area,
        i_vertical,
        i_lateral,
        j,
        ka_vertical,
        ka_lateral,
        rail_height,
        mass_per_length,
        theory,
    };
    let [first, last] = range(&girder);
    if !(last - first).is_finite() {
        check
            .faults
            .add(Fault::new(&at.key("spans"), "must have a finite sum"));
    }
    girder
}

/// Reads the spans and the overhangs.
fn read_lengths(raw: &RawGirder, at: &Place<'_>, check: &mut Check<'_>) -> (Vec<f64>, [f64; 2]) {
    let mut spans = Vec::new();
    if let Some(given) = check.faults.require(&raw.spans, at, "spans") {
        let place = at.key("spans");
        if given.is_empty() {
            check.faults.add(
                Fault::new(&place, "must have at least one span")
                    .got("an empty list")
                    .of_value(),
            );
        }
        check.items(given.len(), &SPANS, &place);
        for (index, span) in given.iter().enumerate() {
            let hint = "spans are lengths, first support to last";
            spans.push(check.positive(*span, &place.index(index), Dimension::LENGTH, hint));
        }
    }
    let mut overhangs = [0.0; 2];
    let place = at.key("overhangs");
    for (index, overhang) in raw.overhangs.unwrap_or_default().into_iter().enumerate() {
        let hint = "overhangs are lengths beyond the first and the last support; 0 for none";
        overhangs[index] =
            check.not_negative(overhang, &place.index(index), Dimension::LENGTH, hint);
    }
    (spans, overhangs)
}

/// First and last coordinate of the rail, in the units of the file.
fn range_of(raw: &RawGirder) -> [f64; 2] {
    let [before, after] = raw.overhangs.unwrap_or_default();
    [-before, raw.spans.iter().flatten().sum::<f64>() + after]
}

/// Most parts between the supports at whose ends stations lie by default.
const PARTS: usize = 200;

/// The stations of a spec that has none: both ends, the supports and the tenths of the spans; on girders of many spans
/// fewer.
fn default_stations(spans: &[f64], overhangs: [f64; 2]) -> Vec<f64> {
    let parts = (PARTS / spans.len().max(1)).clamp(1, 10);
    let stride = (spans.len() * parts).div_ceil(5 * PARTS).max(1);
    let mut stations = Vec::new();
    let mut support = 0.0;
    for span in spans {
        stations.extend((0..parts).map(|part| support + span * part as f64 / parts as f64));
        support += span;
    }
    let mut stations: Vec<f64> = stations.into_iter().step_by(stride).collect();
    stations.push(support);
    if overhangs[0] > 0.0 {
        stations.insert(0, -overhangs[0]);
    }
    if overhangs[1] > 0.0 {
        stations.push(support + overhangs[1]);
    }
    stations
}

/// Reads the stations of a girder of given spans. `range` is the range of the rail in the units of the file, if its
/// lengths are valid.
fn read_stations(
    stations: &Option<Vec<f64>>,
    (spans, overhangs): (&[f64], [f64; 2]),
    range: Option<[f64; 2]>,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<f64> {
    let Some(given) = stations else {
        return default_stations(spans, overhangs);
    };
    let place = root.key("stations");
    if given.is_empty() {
        check.faults.add(
            Fault::new(&place, "must have at least one station")
                .got("an empty list")
                .of_value(),
        );
    }
    check.items(given.len(), &STATIONS, &place);
    check.faults.increasing(given, &place);
    let mut stations = Vec::new();
    for (index, station) in given.iter().enumerate() {
        let item = place.index(index);
        let mut station = *station;
        if let Some([first, last]) = range {
            let slack = 1e-12 * (last - first);
            if station < first - slack || station > last + slack {
                let expected = format!("must be on the rail, from {first} to {last}");
                let hint =
                    "stations are coordinates from the first support, and may be on the overhangs";
                check
                    .faults
                    .add(Fault::new(&item, expected).got(number(station)).hint(hint));
            }
            station = station.max(first).min(last);
        }
        stations.push(check.number(station, &item, Dimension::LENGTH));
    }
    stations
}
