//! Reads a sweep file with the scene or design that it names, and reports all faults of all files.

use std::path::Path;

use super::axis_value::AxisValue;
use super::raw::{RawAxis, RawLaw, RawScalar, RawSweep};
use super::target::SweepTarget;
use super::values::{AxisValues, ResultKind, Sampling, Sweep, SweepAxis, SweepInput};
use crate::design::Design;
use crate::limits::{SWEEP_AXES, SWEEP_RUNS};
use crate::scene::Document;
use crate::spec::{format, stem};
use crate::text::diagnostic::Diagnostic;
use crate::text::fault::{Fault, Faults, number};
use crate::text::inputs::Inputs;
use crate::text::names::check_name;
use crate::text::place::Place;

/// Value of the member `format`: name and version of the format.
pub const FORMAT: &str = "girderway-sweep/1";

/// Words of results that are not columns.
const RESULTS: [(&str, ResultKind); 4] = [
    ("peaks", ResultKind::Peaks),
    ("extremes", ResultKind::Extremes),
    ("fatigue", ResultKind::Fatigue),
    ("ratios", ResultKind::Ratios),
];

impl Sweep {
    /// Reads a sweep, and the scene or design that it names, which must be without faults itself. Returns the sweep
    /// and its own file.
    ///
    /// # Errors
    /// All faults of all files, each with its place.
    pub fn open(path: &Path) -> Result<(Sweep, Inputs), Vec<Diagnostic>> {
        let (inputs, source) = Inputs::open(path).map_err(|error| vec![*error])?;
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let sweep = source.read_with_others(FORMAT, |raw: &RawSweep, faults, wrong| {
            read(raw, &source.name, &folder, faults, wrong)
        })?;
        Ok((sweep, inputs))
    }
}

fn read(
    raw: &RawSweep,
    file: &str,
    folder: &Path,
    faults: &mut Faults,
    wrong: &mut Vec<Diagnostic>,
) -> Option<Sweep> {
    let root = Place::root();
    format(&raw.format, FORMAT, &root, faults);
    if let Some(name) = &raw.name {
        check_name(name, &root.key("name"), faults);
    }
    let input = input(raw, &root, faults);
    let target = input.as_ref().and_then(|input| match open(input, folder) {
        Ok(inputs) => Some(SweepTarget::new(inputs)),
        Err(found) => {
            wrong.extend(found);
            None
        }
    });
    let sampling = sampling(raw, &root, faults);
    let axes = axes(raw, target.as_ref(), sampling, &root, faults);
    let count = count(raw, sampling, &axes, &root, faults);
    let results = results(raw, input.as_ref(), &root, faults);
    Some(Sweep {
        name: raw.name.clone().unwrap_or_else(|| stem(file)),
        input: input?,
        target: target?,
        axes: axes.into_iter().collect::<Option<Vec<_>>>()?,
        sampling: sampling?,
        count: count?,
        seed: raw.seed.unwrap_or(1),
        results: results?,
    })
}

/// The one input of the sweep.
fn input(raw: &RawSweep, root: &Place<'_>, faults: &mut Faults) -> Option<SweepInput> {
    match (&raw.scene, &raw.design) {
        (Some(scene), None) => Some(SweepInput::Scene(scene.clone())),
        (None, Some(design)) => Some(SweepInput::Design(design.clone())),
        (None, None) => {
            let fault = Fault::new(root, "missing key `scene` or `design`").of_value();
            faults.add(fault.hint("a sweep runs one scene or one design"));
            None
        }
        (Some(_), Some(_)) => {
            let fault = Fault::new(&root.key("design"), "cannot be combined with `scene`").at_key();
            faults.add(fault.hint("a sweep runs one scene or one design"));
            None
        }
    }
}

/// Reads and checks the scene or design; returns its files.
fn open(input: &SweepInput, folder: &Path) -> Result<Inputs, Vec<Diagnostic>> {
    let path = folder.join(input.file());
    match input {
        SweepInput::Scene(_) => Document::open(&path).map(|document| document.inputs),
        SweepInput::Design(_) => Design::open(&path).map(|(_, inputs)| inputs),
    }
}

fn sampling(raw: &RawSweep, root: &Place<'_>, faults: &mut Faults) -> Option<Sampling> {
    let words = [
        ("grid", Sampling::Grid),
        ("latin", Sampling::Latin),
        ("sobol", Sampling::Sobol),
    ];
    match &raw.sampling {
        Some(word) => faults.one_of(word, &root.key("sampling"), &words),
        None => {
            let fault = Fault::new(root, "missing key `sampling`").of_value();
            faults.add(fault.hint("\"grid\", \"latin\" or \"sobol\""));
            None
        }
    }
}

/// The axes; `None` for those with faults.
fn axes(
    raw: &RawSweep,
    target: Option<&SweepTarget>,
    sampling: Option<Sampling>,
    root: &Place<'_>,
    faults: &mut Faults,
) -> Vec<Option<SweepAxis>> {
    let at = root.key("axes");
    let Some(axes) = faults.require(&raw.axes, root, "axes") else {
        return vec![None];
    };
    if axes.0.is_empty() {
        faults.add(Fault::new(&at, "must have at least one axis").of_value());
        return vec![None];
    }
    if axes.0.len() > SWEEP_AXES.most {
        let fault =
            Fault::new(&at, format!("must have at most {} axes", SWEEP_AXES.most)).of_value();
        faults.add(fault.got(axes.0.len()).hint(SWEEP_AXES.reason));
        return vec![None];
    }
    let mut all: Vec<Option<SweepAxis>> = Vec::new();
    for (pointer, written) in &axes.0 {
        let place = at.key(pointer);
        let values = axis_values(written, sampling, &place, faults);
        let found = target.and_then(|target| match target.find(pointer) {
            Ok(found) => Some(found),
            Err(error) => {
                faults.add(Fault::new(&place, error.expected).hint(error.hint).at_key());
                None
            }
        });
        let Some(((place_in_file, old), values)) = found.zip(values) else {
            all.push(None);
            continue;
        };
        if let Some(other) = all
            .iter()
            .flatten()
            .find(|other| other.place == place_in_file)
        {
            let fault =
                Fault::new(&place, "must not refer to the same value as another axis").at_key();
            faults.add(fault.got(format!("the value of {:?}", other.pointer)));
        }
        check_kind(&values, &old, &place, faults);
        all.push(Some(SweepAxis {
            pointer: pointer.clone(),
            place: place_in_file,
            values,
        }));
    }
    all
}

/// Checks that the values of an axis are of the kind of the value that they replace.
fn check_kind(values: &AxisValues, old: &AxisValue, at: &Place<'_>, faults: &mut Faults) {
    let word = |value: &AxisValue| match value {
        AxisValue::Number(_) => "a number",
        AxisValue::Text(_) => "a string",
        AxisValue::Flag(_) => "true or false",
    };
    let wanted = word(old);
    match values {
        AxisValues::List(list) => {
            for (index, value) in list
                .iter()
                .enumerate()
                .filter(|(_, value)| word(value) != wanted)
            {
                let fault = Fault::new(
                    &at.index(index),
                    format!("must be {wanted}, as in the file"),
                );
                faults.add(fault.got(value.json().to_string()));
            }
        }
        _ if wanted != "a number" => {
            let fault = Fault::new(
                at,
                format!("must be a list: the value in the file is {wanted}"),
            );
            faults.add(fault.got(old.json().to_string()));
        }
        _ => {}
    }
}

fn axis_values(
    raw: &RawAxis,
    sampling: Option<Sampling>,
    at: &Place<'_>,
    faults: &mut Faults,
) -> Option<AxisValues> {
    match raw {
        RawAxis::List(list) if list.is_empty() => {
            faults.add(Fault::new(at, "must have at least one value").of_value());
            None
        }
        RawAxis::List(list) => {
            let value = |raw: &RawScalar| match raw {
                RawScalar::Number(value) => AxisValue::Number(*value),
                RawScalar::Text(text) => AxisValue::Text(text.clone()),
                RawScalar::Flag(flag) => AxisValue::Flag(*flag),
            };
            Some(AxisValues::List(list.iter().map(value).collect()))
        }
        RawAxis::Law(law) => {
            let values = law_values(law, at, faults)?;
            if sampling == Some(Sampling::Grid) && values.levels().is_none() {
                let fault = Fault::new(
                    at,
                    "must be a list or a range with `\"sampling\": \"grid\"`",
                )
                .of_value();
                faults.add(fault.hint("distributions need \"latin\" or \"sobol\" and `count`"));
                return None;
            }
            Some(values)
        }
    }
}

fn law_values(law: &RawLaw, at: &Place<'_>, faults: &mut Faults) -> Option<AxisValues> {
    let given = [
        law.range.is_some(),
        law.uniform.is_some(),
        law.normal.is_some(),
        law.lognormal.is_some(),
    ];
    if given.iter().filter(|given| **given).count() != 1 {
        let fault = Fault::new(
            at,
            "must have one of `range`, `uniform`, `normal` and `lognormal`",
        )
        .of_value();
        faults.add(fault);
        return None;
    }
    let before = faults.0.len();
    let positive = |pair: [f64; 2], index: usize, key: &str, what: &str, faults: &mut Faults| {
        if pair[index] <= 0.0 {
            let place = at.key(key);
            faults.add(
                Fault::new(&place.index(index), "must be positive")
                    .got(number(pair[index]))
                    .hint(what)
                    .of_value(),
            );
        }
    };
    let values = if let Some([from, to, levels]) = law.range {
        let place = at.key("range");
        let is_count = levels >= 1.0 && levels.fract() == 0.0 && levels <= SWEEP_RUNS.most as f64;
        if !is_count {
            let expected = format!("must be a whole number from 1 to {}", SWEEP_RUNS.most);
            let fault = Fault::new(&place.index(2), expected)
                .got(number(levels))
                .of_value();
            faults.add(fault.hint("a range is [first, last, number of values]"));
        } else if (levels == 1.0) != (from == to) {
            let fault = Fault::new(
                &place,
                "must have several values between different ends, or one value if its ends are equal",
            )
            .of_value();
            faults.add(fault);
        }
        AxisValues::Range(from, to, if is_count { levels as usize } else { 1 })
    } else if let Some([low, high]) = law.uniform {
        if low >= high {
            let place = at.key("uniform");
            let fault = Fault::new(
                &place.index(1),
                format!("must be greater than the first, {}", number(low)),
            );
            faults.add(fault.got(number(high)).of_value());
        }
        AxisValues::Uniform(low, high)
    } else if let Some(pair) = law.normal {
        positive(
            pair,
            1,
            "normal",
            "the second number is the standard deviation",
            faults,
        );
        AxisValues::Normal(pair[0], pair[1])
    } else {
        let pair = law.lognormal.unwrap_or([1.0, 1.0]);
        positive(
            pair,
            0,
            "lognormal",
            "the first number is the mean of the values",
            faults,
        );
        positive(
            pair,
            1,
            "lognormal",
            "the second number is the standard deviation of the values",
            faults,
        );
        AxisValues::Lognormal(pair[0], pair[1])
    };
    (faults.0.len() == before).then_some(values)
}

/// The number of runs.
fn count(
    raw: &RawSweep,
    sampling: Option<Sampling>,
    axes: &[Option<SweepAxis>],
    root: &Place<'_>,
    faults: &mut Faults,
) -> Option<usize> {
    let at = root.key("count");
    match (sampling?, raw.count) {
        (Sampling::Grid, Some(_)) => {
            let fault =
                Fault::new(&at, "cannot be combined with `\"sampling\": \"grid\"`").at_key();
            faults.add(fault.hint("a grid has every combination of its values"));
            None
        }
        (Sampling::Grid, None) => {
            let levels = axes
                .iter()
                .flatten()
                .filter_map(|axis| axis.values.levels());
            let runs = levels.map(|levels| levels as f64).product::<f64>();
            if runs > SWEEP_RUNS.most as f64 {
                let fault = Fault::new(
                    &root.key("axes"),
                    format!(
                        "must have at most {} combinations of values",
                        SWEEP_RUNS.most
                    ),
                );
                faults.add(fault.got(number(runs)).hint(SWEEP_RUNS.reason));
                return None;
            }
            Some(runs as usize)
        }
        (_, None) => {
            let fault = Fault::new(root, "missing key `count`").of_value();
            faults.add(fault.hint("the number of runs of a Latin hypercube or Sobol sequence"));
            None
        }
        (_, Some(count)) => {
            if count >= 1.0 && count.fract() == 0.0 && count <= SWEEP_RUNS.most as f64 {
                return Some(count as usize);
            }
            let expected = format!("must be a whole number from 1 to {}", SWEEP_RUNS.most);
            faults.add(
                Fault::new(&at, expected)
                    .got(number(count))
                    .hint(SWEEP_RUNS.reason)
                    .of_value(),
            );
            None
        }
    }
}

fn results(
    raw: &RawSweep,
    input: Option<&SweepInput>,
    root: &Place<'_>,
    faults: &mut Faults,
) -> Option<Vec<ResultKind>> {
    let at = root.key("results");
    let written = faults.require(&raw.results, root, "results")?;
    if written.is_empty() {
        let fault = Fault::new(&at, "must have at least one result").of_value();
        faults.add(
            fault.hint("\"peaks\", \"extremes\", \"fatigue\", \"ratios\", or names of columns"),
        );
        return None;
    }
    let is_design = matches!(input, Some(SweepInput::Design(_)));
    let mut kinds = Vec::new();
    for (index, word) in written.iter().enumerate() {
        let place = at.index(index);
        let kind = RESULTS
            .iter()
            .find(|(known, _)| known == word)
            .map(|(_, kind)| kind.clone());
        // names of columns have a dot
        let kind = kind.or_else(|| word.contains('.').then(|| ResultKind::Column(word.clone())));
        let Some(kind) = kind else {
            let known: Vec<(&str, ())> = RESULTS.iter().map(|(word, _)| (*word, ())).collect();
            faults.one_of(word, &place, &known);
            continue;
        };
        if kinds.contains(&kind) {
            faults.add(
                Fault::new(&place, "must be listed once")
                    .got(format!("\"{word}\" again"))
                    .of_value(),
            );
        }
        if is_design
            && matches!(
                kind,
                ResultKind::Peaks | ResultKind::Fatigue | ResultKind::Column(_)
            )
        {
            let fault = Fault::new(&place, "must be \"extremes\" or \"ratios\" for a design");
            faults.add(
                fault
                    .got(format!("\"{word}\""))
                    .hint("a design has no histories"),
            );
        }
        kinds.push(kind);
    }
    (kinds.len() == written.len()).then_some(kinds)
}
