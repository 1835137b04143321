//! Structures of a scene: their source of influence coefficients, and their models in the simulation.

use std::sync::Arc;

use sim::PartChain;
use splines::Couplings;

use super::files::Files;
use super::{gauge, irregularity, tables, ties};
use crate::check::Check;
use crate::limits::{ELEMENTS as MOST_ELEMENTS, MODES as MOST_MODES, PARTS};
use crate::scene::raw::{RawStructure, RawTables};
use crate::scene::values::structure::{
    DEFAULT_PARTS, ELEMENTS, Foundation, Handover, MODES, Origin, Structure, TOLERANCE,
    TableInterpolation,
};
use crate::spec::ties::Ties;
use crate::spec::{RailOutline, Spec, SpecPreload};
use crate::text::fault::{Fault, nearest, number};
use crate::text::place::Place;
use crate::units::Dimension;

/// Smallest permitted tolerance, which is the accuracy to which runs can be compared.
const SMALLEST_TOLERANCE: f64 = 1e-7;

/// Foundations that a scene can specify.
#[derive(Clone, Copy)]
enum FoundationWord {
    Rigid,
    Parts,
    Influence,
    Modal,
    Full,
    Ties,
    Auto,
}

/// Reads a structure. `others` are the names of the other structures of the scene.
pub(super) fn read(
    name: &str,
    others: &[&str],
    raw: &RawStructure,
    at: &Place<'_>,
    files: &mut Files<'_>,
    gravity: Option<f64>,
    check: &mut Check<'_>,
) -> Option<Structure> {
    let word = foundation_word(raw, at, check);
    let count = read_count(raw, at, check);
    let handover = read_handover(raw, at, check);
    let damping = read_damping(raw, at, check);
    let interpolation = read_interpolation(raw, at, check);
    let couplings = read_couplings(raw, word, at, check);
    let tolerance = read_tolerance(raw, at, check);
    let measure = read_measure(raw, at, check);
    let ties = ties::read(raw, matches!(word, FoundationWord::Ties), at, check);
    let origin = read_origin((name, others), raw, (word, ties.as_ref()), at, files, check);
    let (origin, preload) = read_preload(origin, raw, gravity, at, check);
    let foundation = match word {
        FoundationWord::Rigid => Foundation::Rigid,
        FoundationWord::Parts => Foundation::Parts {
            count,
            handover,
            damping,
        },
        FoundationWord::Influence | FoundationWord::Auto => Foundation::Influence,
        FoundationWord::Modal => Foundation::Modal {
            modes: raw.modes.unwrap_or(MODES),
            damping,
        },
        FoundationWord::Ties => ties::foundation(raw, ties.as_ref(), damping, at, check),
        FoundationWord::Full => Foundation::Full {
            elements: raw.elements.unwrap_or(ELEMENTS),
            damping,
        },
    };
    let origin = origin?;
    if let (FoundationWord::Parts, Origin::Spec { spec, .. }) = (word, &origin)
        && spec.girder().is_none()
    {
        let fault = Fault::new(&at.key("foundation"), "\"parts\" needs a straight girder");
        check
            .faults
            .add(fault.hint("the short form of a spec, with `girder`"));
    }
    if let (
        Foundation::Parts {
            count, handover, ..
        },
        Origin::Spec { spec, .. },
    ) = (foundation, &origin)
        && let Some(girder) = spec.girder()
    {
        windows_fit(girder, count, handover, at, check);
    }
    if let (FoundationWord::Modal | FoundationWord::Full, Origin::Spec { spec, .. }) =
        (word, &origin)
        && !spec.has_mass()
    {
        let expected = format!(
            "\"{}\" needs mass, but the spec has none",
            foundation.word()
        );
        let fault = Fault::new(&at.key("foundation"), expected);
        check
            .faults
            .add(fault.hint("give its materials a density, or the girder `mass_per_length`"));
    }
    let rails = origin.rails();
    if interpolation != TableInterpolation::Exact {
        enough_stations(&rails, interpolation, at, check);
    }
    let auto = matches!(word, FoundationWord::Auto);
    let gauges = gauge::read(&raw.gauges, &rails, &at.key("gauges"), check);
    let longitudinal = read_longitudinal(raw, word, at, check);
    let place = at.key("irregularities");
    let irregularities = irregularity::read(&raw.irregularities, &rails, &place, files, check);
    Some(Structure {
        name: name.to_owned(),
        origin,
        rails,
        foundation,
        auto,
        damping,
        interpolation,
        couplings,
        tolerance,
        measure,
        gauges,
        longitudinal,
        irregularities,
        preload,
        carrier: None,
    })
}

/// Reads the source of the influence coefficients: a spec, tables, or a rail on ties. `others` are the names of the
/// other structures of the scene.
fn read_origin(
    (name, others): (&str, &[&str]),
    raw: &RawStructure,
    (word, ties): (FoundationWord, Option<&Ties>),
    at: &Place<'_>,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Option<Origin> {
    let hint = "`spec` is a beam spec to be solved, `tables` are existing SPLINE tables";
    match (&raw.spec, &raw.tables) {
        (None, None) if ties.is_some() || matches!(word, FoundationWord::Ties) => {
            ties::on_ground(name, raw, ties, at, check)
        }
        (Some(file), None) if matches!(word, FoundationWord::Ties) => {
            let origin = read_spec(file, &at.key("spec"), files, check);
            origin.and_then(|origin| ties::on_structure(origin, raw, ties, at, check))
        }
        (Some(file), None) => read_spec(file, &at.key("spec"), files, check),
        (None, Some(tables)) => read_tables(tables, &at.key("tables"), word, files, check),
        (Some(_), Some(_)) => {
            let fault = Fault::new(at, "must have either `spec` or `tables`").got("both");
            check.faults.add(fault.hint(hint));
            None
        }
        (None, None) => {
            let fault = Fault::new(at, "must have either `spec` or `tables`").got("neither");
            let meant = nearest(name, others).map(|near| format!("did you mean \"{near}\"? "));
            check
                .faults
                .add(fault.hint(format!("{}{hint}", meant.unwrap_or_default())));
            None
        }
    }
}

/// Gives the preload of a spec the gravity of the scene, and reads whether the wheels at rest belong to it.
fn read_preload(
    origin: Option<Origin>,
    raw: &RawStructure,
    gravity: Option<f64>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> (Option<Origin>, bool) {
    let asked = raw.preload.unwrap_or(false);
    let gravity = gravity.unwrap_or_default();
    match origin {
        Some(Origin::Spec { file, mut spec }) => {
            let own = Arc::make_mut(&mut spec);
            if asked && own.preload.is_none() {
                own.preload = Some(SpecPreload::of_wheels(gravity));
            }
            if let Some(preload) = &mut own.preload {
                preload.gravity = gravity;
            }
            (Some(Origin::Spec { file, spec }), asked)
        }
        Some(tables @ Origin::Tables { .. }) if asked => {
            let fault = Fault::new(
                &at.key("preload"),
                "needs a `spec`: tables describe only one state",
            )
            .at_key();
            check.faults.add(fault);
            (Some(tables), false)
        }
        other => (other, false),
    }
}

/// Reads the number of rigid parts of the foundation "parts".
fn read_count(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> usize {
    let count = raw.count.unwrap_or(DEFAULT_PARTS);
    if count < 2 {
        let fault = Fault::new(&at.key("count"), "must be at least 2")
            .got(count)
            .of_value();
        check
            .faults
            .add(fault.hint("number of rigid parts of the chain"));
    }
    if check.count(count, &PARTS, &at.key("count")) {
        count
    } else {
        DEFAULT_PARTS
    }
}

fn read_interpolation(
    raw: &RawStructure,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> TableInterpolation {
    let word = raw.reading.as_ref();
    let known = &TableInterpolation::WORDS;
    let word = word.and_then(|word| check.faults.one_of(word, &at.key("reading"), known));
    word.unwrap_or(TableInterpolation::Exact)
}

fn foundation_word(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> FoundationWord {
    let Some(word) = &raw.foundation else {
        return if raw.ties.is_some() {
            FoundationWord::Ties
        } else {
            FoundationWord::Auto
        };
    };
    let place = at.key("foundation");
    let words = [
        ("rigid", FoundationWord::Rigid),
        ("parts", FoundationWord::Parts),
        ("influence", FoundationWord::Influence),
        ("modal", FoundationWord::Modal),
        ("full", FoundationWord::Full),
        ("ties", FoundationWord::Ties),
        ("auto", FoundationWord::Auto),
    ];
    check
        .faults
        .one_of(word, &place, &words)
        .unwrap_or(FoundationWord::Auto)
}

/// Keywords of the couplings that are taken into account.
const COUPLINGS: [(&str, Couplings); 3] = [
    ("all", Couplings::All),
    ("within rails", Couplings::WithinRails),
    ("none", Couplings::None),
];

/// Reads the couplings. They can be neglected only if a structure has no degrees of freedom of its own, because
/// natural modes move all rails together.
fn read_couplings(
    raw: &RawStructure,
    word: FoundationWord,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Couplings {
    let Some(given) = &raw.couplings else {
        return Couplings::All;
    };
    let place = at.key("couplings");
    let couplings = check
        .faults
        .one_of(given, &place, &COUPLINGS)
        .unwrap_or_default();
    if couplings != Couplings::All
        && !matches!(word, FoundationWord::Influence | FoundationWord::Rigid)
    {
        let fault = Fault::new(
            &place,
            "couplings can be neglected only with the foundation \"influence\"",
        )
        .at_key();
        check.faults.add(
            fault.hint(
                "modes and parts couple all rails of the structure; \"rigid\" has no couplings",
            ),
        );
    }
    couplings
}

/// Reads whether a structure is compliant in the longitudinal direction.
fn read_longitudinal(
    raw: &RawStructure,
    word: FoundationWord,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> bool {
    let longitudinal = raw.longitudinal.unwrap_or(false);
    let place = at.key("longitudinal");
    if longitudinal && raw.tables.is_some() {
        let fault = Fault::new(&place, "needs a `spec`").at_key();
        check
            .faults
            .add(fault.hint("tables contain only the vertical and the lateral compliance"));
    }
    if longitudinal && raw.on.is_some() {
        check
            .faults
            .unavailable(&place, "longitudinal compliance of a structure on a body");
    }
    if longitudinal && matches!(word, FoundationWord::Parts) {
        let fault = Fault::new(&place, "\"parts\" has no longitudinal compliance").at_key();
        check
            .faults
            .add(fault.hint("use \"influence\" or \"modal\""));
    }
    longitudinal
}

/// Reads the relative error permitted for the choice of a foundation.
fn read_tolerance(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> f64 {
    let (place, given) = (at.key("tolerance"), raw.tolerance.unwrap_or(TOLERANCE));
    let tolerance = check.positive(
        given,
        &place,
        Dimension::NUMBER,
        "a relative error, such as 1e-3",
    );
    if given > 0.0 && !(SMALLEST_TOLERANCE..1.0).contains(&given) {
        let fault = Fault::new(&place, "must be at least 1e-7 and below 1")
            .got(given)
            .of_value();
        check
            .faults
            .add(fault.hint("a relative error, such as 1e-3"));
    }
    tolerance
}

/// Reads the measure of that error.
fn read_measure(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> sim::Measure {
    let words = [
        ("extremes", sim::Measure::Extremes),
        ("history", sim::Measure::History),
    ];
    let word = raw.measure.as_ref();
    word.and_then(|word| check.faults.one_of(word, &at.key("measure"), &words))
        .unwrap_or_default()
}

/// Reads the damping ratio of the natural modes. The numbers of modes and elements must not be 0.
fn read_damping(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> f64 {
    for (key, count, limit) in [
        ("modes", raw.modes, &MOST_MODES),
        ("elements", raw.elements, &MOST_ELEMENTS),
    ] {
        if count == Some(0) {
            check.faults.add(
                Fault::new(&at.key(key), "must be at least 1")
                    .got(0)
                    .of_value(),
            );
        }
        check.count(count.unwrap_or(0), limit, &at.key(key));
    }
    let (place, given) = (at.key("damping"), raw.damping.unwrap_or(0.0));
    let damping = check.not_negative(
        given,
        &place,
        Dimension::NUMBER,
        "a fraction of critical damping, such as 0.01",
    );
    if damping >= 1.0 {
        let fault = Fault::new(&place, "must be below 1")
            .got(damping)
            .of_value();
        check
            .faults
            .add(fault.hint("a fraction of critical damping, such as 0.01"));
    }
    damping
}

fn read_handover(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> Handover {
    let words = [("blend", false), ("per-part", true)];
    let per_part = match &raw.handover {
        Some(word) => check
            .faults
            .one_of(word, &at.key("handover"), &words)
            .unwrap_or(false),
        None => false,
    };
    let hint = "length over which a wheel passes from one part to the next";
    let length = check.optional_positive(raw.blend, &at.key("blend"), Dimension::LENGTH, hint);
    if per_part {
        Handover::PerPart { length }
    } else {
        Handover::Blend { length }
    }
}

/// Checks that the windows in which wheels pass from part to part do not overlap.
fn windows_fit(
    girder: &fea::Girder,
    count: usize,
    handover: Handover,
    at: &Place<'_>,
    check: &mut Check<'_>,
) {
    let (Handover::Blend {
        length: Some(length),
    }
    | Handover::PerPart {
        length: Some(length),
    }) = handover
    else {
        return;
    };
    let (from, to) = (
        -girder.overhangs[0],
        girder.spans.iter().sum::<f64>() + girder.overhangs[1],
    );
    let ends: Vec<f64> = (0..=count)
        .map(|j| from + (to - from) * j as f64 / count as f64)
        .collect();
    if check.faults.0.is_empty() && PartChain::new(ends, 0, Some(length)).is_none() {
        let expected = format!(
            "must be at most {}, the length of a part",
            number((to - from) / count as f64)
        );
        let fault = Fault::new(&at.key("blend"), expected).got(number(length));
        check
            .faults
            .add(fault.hint("the transition lengths at adjacent joints must not overlap"));
    }
}

fn read_spec(
    file: &str,
    at: &Place<'_>,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Option<Origin> {
    files.read(file, at, check, |input, check| {
        let source = input.source().map_err(|error| vec![*error])?;
        let spec = Spec::read(&source, Some(check.scale.to))?;
        Ok(Origin::Spec {
            file: file.to_owned(),
            spec: Arc::new(spec),
        })
    })
}

fn read_tables(
    raw: &RawTables,
    at: &Place<'_>,
    word: FoundationWord,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Option<Origin> {
    if matches!(
        word,
        FoundationWord::Parts | FoundationWord::Modal | FoundationWord::Full | FoundationWord::Ties
    ) {
        let fault = Fault::new(at, "this foundation needs a `spec`")
            .hint("tables contain neither masses nor members");
        check.faults.add(fault);
    }
    if raw.vertical.is_none() && raw.lateral.is_none() {
        let fault = Fault::new(at, "must name a table as `vertical`, `lateral` or both");
        check
            .faults
            .add(fault.hint("such as \"vertical\": 6 for SPLINE/6, or its name in quotes"));
    }
    let file = check.faults.require(&raw.file, at, "file")?;
    let read = files.read(file, &at.key("file"), check, |input, check| {
        tables::read(raw, input, at, check)
    });
    read.flatten()
}

/// Checks that there are enough stations for the interpolation.
fn enough_stations(
    rails: &[RailOutline],
    reading: TableInterpolation,
    at: &Place<'_>,
    check: &mut Check<'_>,
) {
    let least = if reading == TableInterpolation::Natural {
        2
    } else {
        4
    };
    for rail in rails {
        if rail.stations.len() < least {
            let expected = format!("needs at least {least} stations on rail {}", rail.name);
            check
                .faults
                .add(Fault::new(&at.key("reading"), expected).got(rail.stations.len()));
        }
    }
}
