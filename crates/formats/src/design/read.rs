//! Reads a design file and its spec, and reports all faults of both.

use std::path::Path;
use std::sync::Arc;

use fea::{Model, Rail};

use super::practice;
use super::raw::{RawCase, RawDead, RawDesign, RawForces, RawNamedCase, RawSectionCut, RawTrain};
use super::values::{
    Design, DesignCase, DesignDead, DesignSection, DesignTrain, DesignWheel, TILTING,
    TROLLEY_DRIVES, WHOLE,
};
use crate::check::Check;
use crate::limits::{CASE_TRAINS, TRAIN_WHEELS, TRAINS};
use crate::spec::{COMPONENTS, Form, RailOutline, Spec, format, stem};
use crate::text::diagnostic::Diagnostic;
use crate::text::fault::{Fault, Faults, number};
use crate::text::inputs::Inputs;
use crate::text::names::{check_name, names, resolve};
use crate::text::place::Place;
use crate::text::source::Source;
use crate::units::{Dimension, STANDARD_GRAVITY, Scale, Units};
use crate::vector::length;
use ::practice::limit_choice::code_name;

/// Value of the member `format`: name and version of the format.
pub const FORMAT: &str = "girderway-design/1";

/// Names of loads that every case may factor, beside those of parts of vertical forces.
const LOADS: [&str; 8] = [
    "dead",
    WHOLE,
    "lateral",
    "longitudinal",
    "skewing",
    "buffer",
    TROLLEY_DRIVES,
    TILTING,
];

impl Design {
    /// Reads a design and the spec that it names.
    ///
    /// # Errors
    /// All faults of both files, each with its place.
    pub fn open(path: &Path) -> Result<(Design, Inputs), Vec<Diagnostic>> {
        let (inputs, source) = Inputs::open(path).map_err(|error| vec![*error])?;
        Design::read(inputs, &source)
    }

    /// Reads a design from its text, the first of `inputs`, and the spec that it names.
    ///
    /// # Errors
    /// As [`Design::open`].
    pub fn read(mut inputs: Inputs, source: &Source) -> Result<(Design, Inputs), Vec<Diagnostic>> {
        let design = source.read_with_others(FORMAT, |raw: &RawDesign, faults, wrong| {
            read(raw, &source.name, &mut inputs, faults, wrong)
        })?;
        Ok((design, inputs))
    }
}

fn read(
    raw: &RawDesign,
    file: &str,
    inputs: &mut Inputs,
    faults: &mut Faults,
    wrong: &mut Vec<Diagnostic>,
) -> Option<Design> {
    let root = Place::root();
    format(&raw.format, FORMAT, &root, faults);
    let own = Units::read(&raw.units, &root, faults);
    let units = own.unwrap_or(Units::SI);
    if let Some(name) = &raw.name {
        check_name(name, &root.key("name"), faults);
    }
    let spec = spec(raw, units, inputs, &root, faults, wrong);
    let scale = Scale {
        from: units,
        to: units,
    };
    let mut check = Check { faults, scale };
    let standard = STANDARD_GRAVITY
        * Scale {
            from: Units::SI,
            to: units,
        }
        .factor(Dimension::LENGTH);
    let gravity = match raw.gravity {
        Some(given) => check.not_negative(
            given,
            &root.key("gravity"),
            Dimension::ACCELERATION,
            "a magnitude: it always acts downwards",
        ),
        None => standard,
    };
    // What is on the structure can only be checked where the structure and the units are known.
    let Some(spec) = spec.filter(|_| own.is_some()) else {
        check_trains(raw, &[], &root, &mut check);
        return None;
    };
    let rails = spec.rails();
    let dead = dead_load(&raw.dead_load, gravity, &rails, &root, &mut check);
    let trains = check_trains(raw, &rails, &root, &mut check);
    check_fit(&trains, &spec, &rails, &root, &mut check);
    let cases = cases(raw, &trains, &root, &mut check);
    let sections = raw.sections.iter().enumerate();
    let at = root.key("sections");
    let sections: Vec<DesignSection> = sections
        .filter_map(|(k, raw)| section(raw, &spec, &at.index(k), &mut check))
        .collect();
    unique(
        sections.iter().map(|section| section.name.as_str()),
        &at,
        check.faults,
    );
    let (spans, are_spans_given) = spans(raw, &spec, &rails, &root, &mut check);
    let given = raw.practice.clone().unwrap_or_default();
    let practice = practice::read(&given, units, &root.key("practice"), &mut check);
    if practice.combinations {
        require_parts(
            &trains,
            &cases,
            practice.code.as_deref(),
            &root,
            check.faults,
        );
    }
    Some(Design {
        name: raw.name.clone().unwrap_or_else(|| stem(file)),
        units: own?,
        spec_file: raw.spec.clone()?,
        spec,
        dead,
        trains,
        cases,
        sections,
        spans,
        are_spans_given,
        practice,
    })
}

/// The spec in the units of the design.
fn spec(
    raw: &RawDesign,
    units: Units,
    inputs: &mut Inputs,
    root: &Place<'_>,
    faults: &mut Faults,
    wrong: &mut Vec<Diagnostic>,
) -> Option<Arc<Spec>> {
    let name = faults.require(&raw.spec, root, "spec")?;
    let input = match inputs.open_referenced(name) {
        Ok(input) => input,
        Err(why) => {
            let fault = Fault::new(&root.key("spec"), format!("\"{name}\" {why}"));
            faults.add(fault.hint("paths are relative to the folder of the design"));
            return None;
        }
    };
    let read = input
        .source()
        .map_err(|error| vec![*error])
        .and_then(|source| Spec::read(&source, Some(units)));
    match read {
        Ok(spec) => Some(Arc::new(spec)),
        Err(faults) => {
            wrong.extend(faults);
            None
        }
    }
}

fn dead_load(
    raw: &Option<RawDead>,
    gravity: f64,
    rails: &[RailOutline],
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> DesignDead {
    let mut lines = vec![0.0; rails.len()];
    let weight = match raw {
        None => false,
        Some(RawDead::Weight(weight)) => *weight,
        Some(RawDead::Parts(parts)) => {
            let at = root.key("dead_load");
            let at = at.key("line");
            let known = names(rails, |rail| &rail.name);
            for (name, load) in &parts.line.0 {
                let here = at.key(name);
                if let Some(rail) = resolve(name, &known, "rail", &here, check.faults) {
                    lines[rail] =
                        check.not_negative(*load, &here, Dimension::STIFFNESS, "downwards");
                }
            }
            parts.weight.unwrap_or(false)
        }
    };
    DesignDead {
        gravity: if weight { gravity } else { 0.0 },
        lines,
    }
}

fn check_trains(
    raw: &RawDesign,
    rails: &[RailOutline],
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<DesignTrain> {
    let Some(list) = check.faults.require(&raw.trains, root, "trains") else {
        return Vec::new();
    };
    let at = root.key("trains");
    if list.is_empty() {
        check
            .faults
            .add(Fault::new(&at, "must have at least one train").of_value());
    }
    check.items(list.len(), &TRAINS, &at);
    let trains: Vec<DesignTrain> = list
        .iter()
        .enumerate()
        .map(|(k, raw)| train(raw, rails, &at.index(k), check))
        .collect();
    unique(
        trains.iter().map(|train| train.name.as_str()),
        &at,
        check.faults,
    );
    trains
}

/// Refuses a name that occurs before.
fn unique<'n>(names: impl Iterator<Item = &'n str>, at: &Place<'_>, faults: &mut Faults) {
    let mut seen: Vec<&str> = Vec::new();
    for (k, name) in names.enumerate() {
        if seen.contains(&name) && !name.is_empty() {
            let here = at.index(k);
            let fault = Fault::new(&here.key("name"), "must differ from the other names");
            faults.add(fault.got(format!("\"{name}\"")));
        }
        seen.push(name);
    }
}

fn train(
    raw: &RawTrain,
    rails: &[RailOutline],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> DesignTrain {
    let name = check
        .faults
        .require(&raw.name, at, "name")
        .cloned()
        .unwrap_or_default();
    if raw.name.is_some() {
        check_name(&name, &at.key("name"), check.faults);
    }
    let known = names(rails, |rail| &rail.name);
    let rail = match &raw.rail {
        Some(name) if !rails.is_empty() => {
            resolve(name, &known, "rail", &at.key("rail"), check.faults)
        }
        _ => None,
    };
    let mut ends = [0.0; 2];
    for (k, end) in raw.ends.into_iter().flatten().enumerate() {
        let place = at.key("ends");
        ends[k] = check.not_negative(
            end,
            &place.index(k),
            Dimension::LENGTH,
            "distance beyond the outermost wheel",
        );
    }
    let list = check
        .faults
        .require(&raw.wheels, at, "wheels")
        .map_or(&[][..], Vec::as_slice);
    let places = at.key("wheels");
    if raw.wheels.is_some() && list.is_empty() {
        check
            .faults
            .add(Fault::new(&places, "must have at least one wheel").of_value());
    }
    check.items(list.len(), &TRAIN_WHEELS, &places);
    let signs = [("both", true), ("given", false)];
    let reverses = raw
        .signs
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("signs"), &signs));
    let whole = raw
        .longitudinal
        .map(|force| check.number(force, &at.key("longitudinal"), Dimension::FORCE));
    let buffer = raw
        .buffer
        .map(|force| check.number(force, &at.key("buffer"), Dimension::FORCE));
    let buffer = buffer.unwrap_or(0.0) / list.len().max(1) as f64;
    let sharing = list
        .iter()
        .filter(|wheel| wheel.longitudinal.is_none())
        .count()
        .max(1) as f64;
    let of_train = [
        raw.lateral
            .map(|force| check.number(force, &at.key("lateral"), Dimension::FORCE)),
        whole.map(|force| force / sharing),
        raw.eccentricity
            .map(|e| check.number(e, &at.key("eccentricity"), Dimension::LENGTH)),
    ];
    let mut wheels = Vec::with_capacity(list.len());
    for (k, given) in list.iter().enumerate() {
        let here = places.index(k);
        let x = check
            .faults
            .require(&given.x, &here, "x")
            .copied()
            .unwrap_or(f64::INFINITY);
        let x = if given.x.is_some() {
            check.number(x, &here.key("x"), Dimension::LENGTH)
        } else {
            x
        };
        let own = match &given.rail {
            Some(name) if !rails.is_empty() => {
                resolve(name, &known, "rail", &here.key("rail"), check.faults)
            }
            _ => rail,
        };
        if own.is_none() && given.rail.is_none() && raw.rail.is_none() && rails.len() > 1 && k == 0
        {
            let fault = Fault::new(at, "missing key `rail`").of_value();
            let words: Vec<&str> = rails.iter().map(|rail| rail.name.as_str()).collect();
            check
                .faults
                .add(fault.hint(format!("the structure has several: {}", words.join(", "))));
        }
        let [lateral, longitudinal, eccentricity] = of_train;
        let mut own_number = |value: Option<f64>, key: &str, dimension, default: Option<f64>| {
            value
                .map(|value| check.number(value, &here.key(key), dimension))
                .or(default)
                .unwrap_or(0.0)
        };
        let lateral = own_number(given.lateral, "lateral", Dimension::FORCE, lateral);
        let longitudinal = own_number(
            given.longitudinal,
            "longitudinal",
            Dimension::FORCE,
            longitudinal,
        );
        let eccentricity = own_number(
            given.eccentricity,
            "eccentricity",
            Dimension::LENGTH,
            eccentricity,
        );
        let skewing = own_number(given.skewing, "skewing", Dimension::FORCE, None);
        let tilting = own_number(given.tilting, "tilting", Dimension::FORCE, None);
        let vertical = vertical(&given.vertical, &here, check);
        let rail = own.unwrap_or(0);
        wheels.push(DesignWheel {
            rail,
            x,
            vertical,
            lateral,
            longitudinal,
            skewing,
            buffer,
            trolley_drives: 0.0,
            tilting,
            eccentricity,
        });
    }
    check_order(&wheels, &places, check.faults);
    let mut weight = |value: Option<f64>, key: &str| {
        value.map(|value| check.not_negative(value, &at.key(key), Dimension::FORCE, "a weight"))
    };
    let weights = [
        weight(raw.hoist_load, "hoist_load"),
        weight(raw.trolley, "trolley"),
        weight(raw.bridge, "bridge"),
    ];
    if let [Some(lifted), Some(trolley), _] = weights {
        let whole = ::practice::buffer::trolley_force(lifted, trolley).unwrap_or(0.0);
        let share = whole / wheels.len().max(1) as f64;
        wheels
            .iter_mut()
            .for_each(|wheel| wheel.trolley_drives = share);
    }
    DesignTrain {
        weights,
        name,
        ends,
        wheels,
        turned: raw.turned.unwrap_or(true),
        enters: raw.enters.unwrap_or(false),
        reverses: reverses.unwrap_or(true),
    }
}

/// The parts of a vertical force.
fn vertical(raw: &Option<RawForces>, at: &Place<'_>, check: &mut Check<'_>) -> Vec<(String, f64)> {
    let place = at.key("vertical");
    match check.faults.require(raw, at, "vertical") {
        None => Vec::new(),
        Some(RawForces::Whole(force)) => {
            vec![(
                WHOLE.to_owned(),
                check.number(*force, &place, Dimension::FORCE),
            )]
        }
        Some(RawForces::Parts(parts)) => {
            if parts.0.is_empty() {
                check
                    .faults
                    .add(Fault::new(&place, "must have at least one part").of_value());
            }
            let mut out = Vec::new();
            for (name, force) in &parts.0 {
                let here = place.key(name);
                check_name(name, &here, check.faults);
                if name != TILTING && LOADS.contains(&name.as_str()) {
                    let fault =
                        Fault::new(&here, format!("\"{name}\" cannot be the name of a part"))
                            .at_key();
                    check
                        .faults
                        .add(fault.hint("`factors` of a case use this name for another load"));
                }
                out.push((name.clone(), check.number(*force, &here, Dimension::FORCE)));
            }
            out
        }
    }
}

/// Wheels of one rail must be listed from the rear to the front.
fn check_order(wheels: &[DesignWheel], places: &Place<'_>, faults: &mut Faults) {
    for (k, wheel) in wheels.iter().enumerate() {
        let before = wheels[..k]
            .iter()
            .rev()
            .find(|other| other.rail == wheel.rail);
        if let Some(before) = before.filter(|before| before.x >= wheel.x && before.x.is_finite()) {
            let here = places.index(k);
            let expected = format!(
                "must be greater than that of the previous wheel, {}",
                number(before.x)
            );
            let fault = Fault::new(&here.key("x"), expected).got(number(wheel.x));
            faults.add(fault.hint("list the wheels of a rail by increasing x"));
        }
    }
}

/// Refuses trains that are longer than the rails that they stand on.
fn check_fit(
    trains: &[DesignTrain],
    spec: &Spec,
    rails: &[RailOutline],
    root: &Place<'_>,
    check: &mut Check<'_>,
) {
    if !check.faults.0.is_empty() {
        return;
    }
    let Ok((_, geometry)) = spec.model() else {
        return;
    };
    let shift = |first: usize, rail: usize| {
        let (a, b): (&Rail, &Rail) = (&geometry[first], &geometry[rail]);
        let size = length(b.axis);
        (0..3)
            .map(|k| (a.origin[k] - b.origin[k]) * b.axis[k] / size)
            .sum::<f64>()
    };
    let list = root.key("trains");
    for (k, train) in trains.iter().enumerate().filter(|(_, train)| !train.enters) {
        let first = train.wheels[0].rail;
        let limits = train.wheels.iter().map(|wheel| {
            rails[wheel.rail]
                .range
                .map(|end| end - wheel.x - shift(first, wheel.rail))
        });
        let range = limits.fold([f64::NEG_INFINITY, f64::INFINITY], |r, [a, b]| {
            [r[0].max(a), r[1].min(b)]
        });
        let slack = 1e-12 * range[0].abs().max(range[1].abs());
        if range[0] > range[1] + slack {
            let [low, high] = rails[first].range;
            let fault = Fault::new(&list.index(k), "must fit on its rails with all wheels");
            let fault = fault.got(format!(
                "a train that is {} too long",
                number(range[0] - range[1])
            ));
            check.faults.add(fault.hint(format!(
                "rail \"{}\" is covered from {} to {}; `\"enters\": true` allows wheels beyond its ends",
                rails[first].name,
                number(low),
                number(high)
            )));
        }
    }
}

fn cases(
    raw: &RawDesign,
    trains: &[DesignTrain],
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<DesignCase> {
    let Some(list) = &raw.cases else {
        let alone = |(index, train): (usize, &DesignTrain)| DesignCase {
            name: train.name.clone(),
            trains: vec![index],
            gap: 0.0,
            ordered: false,
            factors: Vec::new(),
        };
        return trains.iter().enumerate().map(alone).collect();
    };
    let at = root.key("cases");
    if list.is_empty() {
        check
            .faults
            .add(Fault::new(&at, "must have at least one case").of_value());
    }
    let plain = |trains: &Vec<String>| RawNamedCase {
        name: None,
        trains: Some(trains.clone()),
        gap: None,
        order: None,
        factors: Default::default(),
    };
    let mut out = Vec::new();
    for (k, given) in list.iter().enumerate() {
        let here = at.index(k);
        let found = match given {
            RawCase::Trains(names) => case(&plain(names), trains, &here, &here, check),
            RawCase::Named(named) => case(named, trains, &here, &here.key("trains"), check),
        };
        out.push(found);
    }
    unique(out.iter().map(|case| case.name.as_str()), &at, check.faults);
    out
}

fn case(
    raw: &RawNamedCase,
    trains: &[DesignTrain],
    at: &Place<'_>,
    list: &Place<'_>,
    check: &mut Check<'_>,
) -> DesignCase {
    let named = check
        .faults
        .require(&raw.trains, at, "trains")
        .cloned()
        .unwrap_or_default();
    if raw.trains.is_some() && named.is_empty() {
        check
            .faults
            .add(Fault::new(list, "must name at least one train").of_value());
    }
    check.items(named.len(), &CASE_TRAINS, list);
    let known = names(trains, |train| &train.name);
    // A train without a name has been reported, and may be the one that is meant.
    let all_named = trains.iter().all(|train| !train.name.is_empty());
    let chosen: Vec<usize> = named
        .iter()
        .enumerate()
        .filter(|_| all_named)
        .filter_map(|(k, name)| resolve(name, &known, "train", &list.index(k), check.faults))
        .collect();
    if let Some(name) = &raw.name {
        check_name(name, &at.key("name"), check.faults);
    }
    let gap = raw.gap.map_or(0.0, |gap| {
        check.not_negative(gap, &at.key("gap"), Dimension::LENGTH, "a clear distance")
    });
    let orders = [("any", false), ("given", true)];
    let ordered = raw
        .order
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("order"), &orders));
    let place = at.key("factors");
    let mut factors = Vec::new();
    let mut parts: Vec<&str> = chosen
        .iter()
        .flat_map(|&k| &trains[k].wheels)
        .flat_map(|wheel| &wheel.vertical)
        .map(|(name, _)| name.as_str())
        .filter(|name| *name != WHOLE && *name != TILTING)
        .collect();
    parts.sort_unstable();
    parts.dedup();
    let words: Vec<(&str, usize)> = LOADS
        .iter()
        .chain(&parts)
        .enumerate()
        .map(|(k, word)| (*word, k))
        .collect();
    for (name, factor) in &raw.factors.0 {
        let here = place.key(name);
        let factor = check.number(*factor, &here, Dimension::NUMBER);
        if chosen.len() == named.len()
            && resolve(name, &words, "load", &here, check.faults).is_some()
        {
            refuse_missing_parts(name, &parts, &chosen, trains, &here, check.faults);
        }
        factors.push((name.clone(), factor));
    }
    DesignCase {
        name: raw.name.clone().unwrap_or_else(|| named.join(" + ")),
        trains: chosen,
        gap,
        ordered: ordered.unwrap_or(false),
        factors,
    }
}

/// Groups of loads of a code factor the weight of the crane and the hoisted load apart; those of ASCE 7 do not.
fn require_parts(
    trains: &[DesignTrain],
    cases: &[DesignCase],
    code: Option<&str>,
    root: &Place<'_>,
    faults: &mut Faults,
) {
    // Groups of ASCE 7 factor wheel loads as a whole; the other codes have limits alone.
    let has_parts =
        |code: &str| matches!(code_name(code), "EN 1991-3" | "EN 1993-6" | "AIST TR-13");
    if !code.is_some_and(has_parts) {
        return;
    }
    let at = root.key("trains");
    for (index, train) in trains.iter().enumerate() {
        if !cases
            .iter()
            .any(|case| case.factors.is_empty() && case.trains.contains(&index))
        {
            continue;
        }
        let lacking = train
            .wheels
            .iter()
            .position(|wheel| !wheel.has_code_parts());
        if let Some(wheel) = lacking {
            let train = at.index(index);
            let wheels = train.key("wheels");
            let here = wheels.index(wheel);
            let fault = Fault::new(
                &here.key("vertical"),
                "must be given in the parts `crane` and `hoist`",
            );
            let hint = "`combinations` of the code apply different factors to them: {\"crane\": 60, \"hoist\": 120}";
            faults.add(fault.of_value().hint(hint));
        }
    }
}

/// A factor of a part needs that every wheel of the case gives its vertical force in parts.
fn refuse_missing_parts(
    name: &str,
    parts: &[&str],
    chosen: &[usize],
    trains: &[DesignTrain],
    at: &Place<'_>,
    faults: &mut Faults,
) {
    if !parts.contains(&name) || LOADS.contains(&name) {
        return;
    }
    for &train in chosen {
        let whole = |wheel: &DesignWheel| wheel.vertical.iter().any(|(part, _)| part == WHOLE);
        if let Some(wheel) = trains[train].wheels.iter().position(whole) {
            let fault = Fault::new(
                at,
                "requires the vertical forces of all wheels to be given in parts",
            );
            faults.add(
                fault
                    .got(format!(
                        "a number for wheel {} of train \"{}\"",
                        wheel + 1,
                        trains[train].name
                    ))
                    .hint(format!(
                        "give its parts by name: {}; or specify a factor for `vertical`",
                        parts.join(", ")
                    )),
            );
            return;
        }
    }
}

fn section(
    raw: &RawSectionCut,
    spec: &Spec,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<DesignSection> {
    let name = check.faults.require(&raw.name, at, "name").cloned();
    if let Some(name) = &name {
        check_name(name, &at.key("name"), check.faults);
    }
    let component = check
        .faults
        .require(&raw.component, at, "component")
        .and_then(|word| check.faults.one_of(word, &at.key("component"), &COMPONENTS));
    let (member, place) = match &spec.form {
        Form::Girder(_) => {
            for (key, given) in [("cell", raw.cell.is_some()), ("place", raw.place.is_some())] {
                if given {
                    let fault = Fault::new(
                        &at.key(key),
                        format!("`{key}` is a key of the general form"),
                    )
                    .at_key();
                    check
                        .faults
                        .add(fault.hint("in the short form of the spec the section is at `x`"));
                }
            }
            let x = check.faults.require(&raw.x, at, "x").copied()?;
            let x = check.number(x, &at.key("x"), Dimension::LENGTH);
            let (model, _) = spec.model().ok()?;
            on_girder(&model, x).or_else(|| {
                let [low, high] = spec.rails()[0].range.map(number);
                let fault = Fault::new(
                    &at.key("x"),
                    format!("must be on the girder, from {low} to {high}"),
                );
                check.faults.add(fault.got(number(x)));
                None
            })?
        }
        Form::Frame(frame) => {
            if raw.x.is_some() {
                let fault = Fault::new(&at.key("x"), "`x` is a key of the short form").at_key();
                check
                    .faults
                    .add(fault.hint("in the general form of the spec give `cell` and `place`"));
            }
            let cell = check.faults.require(&raw.cell, at, "cell").copied();
            let place = check.faults.require(&raw.place, at, "place").copied()?;
            if !(0.0..=1.0).contains(&place) {
                let fault = Fault::new(&at.key("place"), "must be from 0 to 1")
                    .got(number(place))
                    .of_value();
                check
                    .faults
                    .add(fault.hint("0 is the flexible end a of the cell, 1 its flexible end b"));
            }
            let cell = cell?;
            let parts: Vec<usize> = (0..frame.cells.len())
                .filter(|&k| frame.cells[k] == cell)
                .collect();
            if parts.is_empty() {
                let fault = Fault::new(
                    &at.key("cell"),
                    "must be [block, index] of a cell of the spec",
                );
                check.faults.add(
                    fault
                        .got(format!("[{}, {}]", cell[0], cell[1]))
                        .hint("indices count from 0"),
                );
                return None;
            }
            // A tapered cell has parts of equal length.
            let along = place.clamp(0.0, 1.0) * parts.len() as f64;
            let part = (along.floor() as usize).min(parts.len() - 1);
            (parts[part], along - part as f64)
        }
    };
    Some(DesignSection {
        name: name?,
        member,
        place,
        component: component?,
    })
}

/// Member and place of a coordinate of a girder; a support belongs to the member behind it.
fn on_girder(model: &Model, x: f64) -> Option<(usize, f64)> {
    let ends: Vec<f64> = model.points.iter().map(|point| point[0]).collect();
    let (first, last) = (*ends.first()?, *ends.last()?);
    let slack = 1e-12 * (last - first);
    if x < first - slack || x > last + slack {
        return None;
    }
    let member = ends
        .partition_point(|end| *end <= x + slack)
        .clamp(1, ends.len() - 1)
        - 1;
    Some((
        member,
        ((x - ends[member]) / (ends[member + 1] - ends[member])).clamp(0.0, 1.0),
    ))
}

fn spans(
    raw: &RawDesign,
    spec: &Spec,
    rails: &[RailOutline],
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> (Vec<Vec<f64>>, Vec<bool>) {
    // A model with a fault is refused when it is solved, with the place of the fault.
    let mut out: Vec<Vec<f64>> = match spec.model() {
        Ok((model, segments)) => spec.rail_spans(&model, &segments),
        Err(_) => rails.iter().map(|rail| rail.range.to_vec()).collect(),
    };
    let mut are_given = vec![false; rails.len()];
    let at = root.key("spans");
    let known = names(rails, |rail| &rail.name);
    for (name, list) in raw.spans.iter().flat_map(|entries| &entries.0) {
        let here = at.key(name);
        let Some(rail) = resolve(name, &known, "rail", &here, check.faults) else {
            continue;
        };
        if list.len() < 2 {
            check
                .faults
                .add(Fault::new(&here, "must have at least two coordinates").of_value());
        }
        if !check.faults.increasing(list, &here) {
            continue;
        }
        let [low, high] = rails[rail].range;
        let slack = 1e-9 * (high - low);
        let mut ends = Vec::with_capacity(list.len());
        for (k, x) in list.iter().enumerate() {
            let x = check.number(*x, &here.index(k), Dimension::LENGTH);
            if x < low - slack || x > high + slack {
                let expected = format!(
                    "must be on the rail, from {} to {}",
                    number(low),
                    number(high)
                );
                check
                    .faults
                    .add(Fault::new(&here.index(k), expected).got(number(x)));
            }
            ends.push(x.clamp(low, high));
        }
        out[rail] = ends;
        are_given[rail] = true;
    }
    (out, are_given)
}
