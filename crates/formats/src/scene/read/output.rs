//! Output of a run in addition to the motion: the member `output` of a scene.

use practice::Repetition;

use super::rail::rail_named;
use crate::check::Check;
use crate::scene::columns::{names, stresses};
use crate::scene::raw::{RawColumns, RawFatigue, RawOutput, RawScene};
use crate::scene::values::output::{ColumnSelection, Fatigue, Output, belongs};
use crate::scene::values::scene::SceneRail;
use crate::scene::values::structure::{Origin, Structure};
use crate::text::fault::{Fault, nearest};
use crate::text::place::Place;
use crate::units::Dimension;

fn read_fatigue(raw: &Option<RawFatigue>, at: &Place<'_>, check: &mut Check<'_>) -> Fatigue {
    let mut fatigue = Fatigue::default();
    let Some(raw) = raw else { return fatigue };
    for (given, key, value) in [
        (raw.loads, "gamma_Ff", &mut fatigue.loads),
        (raw.material, "gamma_Mf", &mut fatigue.material),
    ] {
        if let Some(given) = given {
            *value = check.positive(
                given,
                &at.key(key),
                Dimension::NUMBER,
                "a partial factor, such as 1.15",
            );
        }
    }
    let words = [
        ("once", Repetition::Once),
        ("repeated", Repetition::Repeated),
    ];
    let history = raw
        .history
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("history"), &words));
    fatigue.history = history.unwrap_or(Repetition::Once);
    let hint = "number of runs in the design life";
    fatigue.crossings =
        check.optional_positive(raw.crossings, &at.key("crossings"), Dimension::NUMBER, hint);
    fatigue
}

pub(super) fn read(
    raw: &RawScene,
    structures: &[Structure],
    rails: &[SceneRail],
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Output {
    let Some(raw) = &raw.output else {
        return Output::default();
    };
    let at = root.key("output");
    let known: Vec<[Vec<String>; 3]> = structures
        .iter()
        .filter_map(|structure| match &structure.origin {
            Origin::Spec { spec, .. } => {
                let [reactions, sections] = names(&structure.name, spec);
                Some([reactions, sections, stresses(&structure.name, spec)])
            }
            Origin::Tables { .. } => None,
        })
        .collect();
    let mut pick = |raw: &Option<RawColumns>, key: &str, kind: usize, form: &str| {
        let known: Vec<&String> = known.iter().flat_map(|names| &names[kind]).collect();
        read_columns(raw, &at.key(key), &known, form, check)
    };
    let reactions = pick(
        &raw.reactions,
        "reactions",
        0,
        "a structure, `<structure>.<support>` or `<structure>.<support>.<dof>`",
    );
    let sections = pick(
        &raw.sections,
        "sections",
        1,
        "a structure, `<structure>.<section>` or `<structure>.<section>.<component>`, with a section of the spec's \
         `effects`",
    );
    let stresses = pick(
        &raw.stresses,
        "stresses",
        2,
        "a structure, `<structure>.<section>` or `<structure>.<section>.<point>`, with one of the `points` of the \
         spec's sections",
    );
    let fatigue = read_fatigue(&raw.fatigue, &at.key("fatigue"), check);
    let spans = read_spans(raw, rails, &at.key("spans"), check);
    Output {
        reactions,
        sections,
        stresses,
        fatigue,
        dead_load: raw.dead_load,
        spans,
    }
}

/// Reads a selection of columns. Each name must select some of the columns `known`; `form` says what a name must be.
fn read_columns(
    raw: &Option<RawColumns>,
    place: &Place<'_>,
    known: &[&String],
    form: &str,
    check: &mut Check<'_>,
) -> ColumnSelection {
    let own = match raw {
        None => return ColumnSelection::Few,
        Some(RawColumns::All(true)) => return ColumnSelection::All,
        Some(RawColumns::All(false)) => return ColumnSelection::None,
        Some(RawColumns::Names(own)) => own,
    };
    for (index, name) in own.iter().enumerate() {
        if known.iter().any(|known| belongs(known, name)) {
            continue;
        }
        let mut fault = Fault::new(&place.index(index), format!("must be {form}"));
        let mut words: Vec<&str> = known.iter().map(|name| name.as_str()).collect();
        words.extend(
            known
                .iter()
                .filter_map(|known| known.rsplit_once('.'))
                .map(|(before, _)| before),
        );
        if let Some(near) = nearest(name, &words) {
            fault = fault.hint(format!("did you mean \"{near}\"?"));
        } else if words.is_empty() {
            fault = fault.hint("no beam spec of this scene defines any such name");
        }
        check.faults.add(fault.got(format!("\"{name}\"")));
    }
    ColumnSelection::Names(own.clone())
}

fn read_spans(
    raw: &RawOutput,
    rails: &[SceneRail],
    place: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<(usize, Vec<f64>)> {
    let mut spans = Vec::new();
    for (name, given) in &raw.spans.0 {
        let at = place.key(name);
        let Some(rail) = rail_named(name, rails, &at, check.faults) else {
            continue;
        };
        if given.len() < 2 {
            let fault = Fault::new(
                &at,
                "must have at least two coordinates, the ends of a span",
            )
            .got(given.len());
            check.faults.add(fault);
        }
        if !check.faults.increasing(given, &at) {
            continue;
        }
        let ends: Vec<f64> = given
            .iter()
            .enumerate()
            .map(|(k, x)| check.number(*x, &at.index(k), Dimension::LENGTH))
            .collect();
        let [first, last] = rails[rail].range;
        if let Some(k) = ends.iter().position(|x| *x < first || *x > last) {
            let fault = Fault::new(&at.index(k), format!("must lie on rail {name}")).got(given[k]);
            check
                .faults
                .add(fault.hint(format!("the rail extends from {first} to {last}")));
        }
        spans.push((rail, ends));
    }
    spans
}
