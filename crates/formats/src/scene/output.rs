//! What a run writes beside the motion: the scene's member `output`.

use practice::Repetition;

use super::raw::{RawColumns, RawFatigue, RawOutput, RawScene};
use super::{Origin, SceneRail, Structure};
use crate::check::Check;
use crate::fault::{Fault, nearest};
use crate::place::Place;
use crate::scene::columns::{names, stresses};
use crate::units::Dimension;

/// Which quantities of one kind become columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Pick {
    /// All of them where they are few.
    #[default]
    Few,
    /// All of them.
    All,
    /// None.
    None,
    /// Those of these names, or of names that go on from these after a dot.
    Names(Vec<String>),
}

impl Pick {
    /// Whether the quantity `name` is meant; `few`: whether there are few of its kind.
    #[must_use]
    pub fn takes(&self, name: &str, few: bool) -> bool {
        match self {
            Pick::Few => few,
            Pick::All => true,
            Pick::None => false,
            Pick::Names(all) => all.iter().any(|own| belongs(name, own)),
        }
    }
}

/// Whether `name` is `own`, or goes on from it after a dot.
fn belongs(name: &str, own: &str) -> bool {
    name.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// What a run writes beside the motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Output {
    /// Reactions of the ground.
    pub reactions: Pick,
    /// Internal forces at the sections that specs name.
    pub sections: Pick,
    /// Stresses at the points that specs give with sections.
    pub stresses: Pick,
    /// How these are judged.
    pub fatigue: Fatigue,
    /// Whether they include those of the structures' own weight.
    pub dead_load: bool,
    /// Ends of the spans of rails whose deflections are judged, where the scene gives them: rail of the scene, coordinates.
    pub spans: Vec<(usize, Vec<f64>)>,
}

/// How stress histories are judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fatigue {
    /// gamma_Ff on the ranges.
    pub loads: f64,
    /// gamma_Mf of the strength.
    pub material: f64,
    /// Whether the history happens once or follows itself.
    pub history: Repetition,
    /// How often the run happens in the life looked at, if that is known.
    pub crossings: Option<f64>,
}

impl Default for Fatigue {
    fn default() -> Fatigue {
        Fatigue { loads: 1.0, material: 1.0, history: Repetition::Once, crossings: None }
    }
}

fn read_fatigue(raw: &Option<RawFatigue>, at: &Place<'_>, check: &mut Check<'_>) -> Fatigue {
    let mut fatigue = Fatigue::default();
    let Some(raw) = raw else { return fatigue };
    for (given, key, value) in
        [(raw.loads, "gamma_Ff", &mut fatigue.loads), (raw.material, "gamma_Mf", &mut fatigue.material)]
    {
        if let Some(given) = given {
            *value = check.positive(given, &at.key(key), Dimension::NUMBER, "a partial factor, such as 1.15");
        }
    }
    let words = [("once", Repetition::Once), ("repeated", Repetition::Repeated)];
    let history = raw.history.as_ref().and_then(|word| check.faults.word(word, &at.key("history"), &words));
    fatigue.history = history.unwrap_or(Repetition::Once);
    let hint = "how often the run happens in a life";
    fatigue.crossings = check.optional_positive(raw.crossings, &at.key("crossings"), Dimension::NUMBER, hint);
    fatigue
}

pub(super) fn read(
    raw: &RawScene,
    structures: &[Structure],
    rails: &[SceneRail],
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Output {
    let Some(raw) = &raw.output else { return Output::default() };
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
    let mut pick = |raw: &Option<RawColumns>, key: &str, kind: usize, form: &str| match raw {
        None => Pick::Few,
        Some(RawColumns::All(true)) => Pick::All,
        Some(RawColumns::All(false)) => Pick::None,
        Some(RawColumns::Names(own)) => {
            for (index, name) in own.iter().enumerate() {
                let all = || known.iter().flat_map(|names| &names[kind]);
                if all().any(|known| belongs(known, name)) {
                    continue;
                }
                let place = at.key(key);
                let mut fault = Fault::new(&place.index(index), format!("must be {form}"));
                let mut words: Vec<&str> = all().map(String::as_str).collect();
                words.extend(all().filter_map(|known| known.rsplit_once('.')).map(|(before, _)| before));
                if let Some(near) = nearest(name, &words) {
                    fault = fault.hint(format!("did you mean \"{near}\"?"));
                } else if words.is_empty() {
                    fault = fault.hint("no beam spec of this scene has any");
                }
                check.faults.add(fault.got(format!("\"{name}\"")));
            }
            Pick::Names(own.clone())
        }
    };
    let reactions =
        pick(&raw.reactions, "reactions", 0, "a structure, or `<structure>.<support>` or `.<freedom>` of it");
    let sections = pick(
        &raw.sections,
        "sections",
        1,
        "a structure, or `<structure>.<section>` or `.<component>` of it, of the spec's `effects`",
    );
    let stresses = pick(
        &raw.stresses,
        "stresses",
        2,
        "a structure, or `<structure>.<section>` or `.<point>` of it, of the `points` of the spec's sections",
    );
    let fatigue = read_fatigue(&raw.fatigue, &at.key("fatigue"), check);
    let spans = read_spans(raw, rails, &at.key("spans"), check);
    Output { reactions, sections, stresses, fatigue, dead_load: raw.dead_load, spans }
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
        let Some(rail) = super::rail(name, rails, &at, check.faults) else { continue };
        if given.len() < 2 {
            let fault = Fault::new(&at, "must have the two ends of a span at least").got(given.len());
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
            check.faults.add(fault.hint(format!("it runs from {first} to {last}")));
        }
        spans.push((rail, ends));
    }
    spans
}
