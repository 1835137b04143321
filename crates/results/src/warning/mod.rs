//! Warnings about runs that are near the limits of their method and about input that is probably wrong.
//!
//! Files, lowest first: tension, slack, second, scene, scope, bounces, this one.

mod bounces;
mod scene;
mod scope;
mod second;
mod slack;
mod tension;

use std::f64::consts::PI;

use sim::{GapCause, Run};

use crate::case_result::CaseResult;
use crate::columns::NamedColumns;
use crate::response::Uplift;
use crate::steps::ColumnPeak;
use formats::scene::motion::SimulationInput;
use formats::scene::stepper_word;
use formats::scene::{
    Analysis, Document, Foundation, Origin, Scene, SceneRail, TableInterpolation, root_body,
};
use formats::spec::Form;
use formats::text::number::{number, rounded};
use formats::verdict::OmittedCheck;

/// Residual of the energy audit above which a warning is issued.
pub const RESIDUAL: f64 = 1e-3;

/// Values that are probably wrong, as what was not checked.
const PLAUSIBLE_SPEC: &str = "plausibility of the spec";
const PLAUSIBLE_SCENE: &str = "plausibility of the scene";

/// Ratio of a rail's deflection to its span above which displacements are not small.
const LARGE_DEFLECTION: f64 = 0.01;

/// Relative increase of the bending stiffness by axial tension above which the tension should not be neglected.
const TENSION: f64 = 0.01;

/// Ratio of the speed to the critical speed above which the mass of a girder should not be neglected.
const FAST: f64 = 0.5;

/// What first order leaves out in a case, computed once.
fn of_second_order<'a>(
    scene: &Scene,
    outcome: &'a CaseResult,
    is_warning: bool,
) -> impl Iterator<Item = String> + use<'a> {
    let all = outcome
        .second_order
        .get_or_init(|| second::second_order(scene, outcome));
    all.iter()
        .filter(move |doubt| doubt.is_warning == is_warning)
        .map(|doubt| doubt.text.clone())
}

/// The warnings of a case: of its run, and of the foundations chosen for it.
#[must_use]
pub fn case_warnings(scene: &Scene, outcome: &CaseResult) -> Vec<String> {
    let find = || {
        let mut all = warnings(scene, outcome);
        all.extend(bounces::cycles_of_bounces(scene, outcome));
        all.extend(outcome.undetermined.first().map(|worst| {
            format!(
                "largest values are not determined: {}; that of {}",
                worst.reason,
                worst.range()
            )
        }));
        all.extend(of_second_order(scene, outcome, true));
        all.extend(outcome.choices.iter().filter_map(|choice| {
            let structure = &scene.structures[choice.structure];
            foundations::selection_doubt(&structure.name, choice, structure.tolerance)
        }));
        all
    };
    outcome.warnings.get_or_init(find).clone()
}

/// Notes of a case: numbers of its specs that follow from names of rolled sections and crane rails, and what its `accuracy` holds for.
#[must_use]
pub fn case_notes(scene: &Scene, outcome: &CaseResult) -> Vec<String> {
    let mut all = Vec::new();
    for structure in &scene.structures {
        if let Origin::Spec { spec, .. } = &structure.origin {
            // a girder that is the structure "girder" is named once
            let own = format!("{}: ", structure.name);
            all.extend(spec.notes.iter().map(|note| match note.strip_prefix(&own) {
                Some(rest) => format!("{own}{rest}"),
                None => format!("{own}{note}"),
            }));
        }
    }
    all.extend(of_second_order(scene, outcome, false));
    all.extend(scope::accuracy_notes(scene, outcome));
    all
}

/// A warning or a note, with the labels of the runs that it concerns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Whether it is a warning.
    pub is_warning: bool,
    /// Labels of the runs; empty where it concerns all of several.
    pub runs: Vec<String>,
    /// What is to be known.
    pub text: String,
}

impl std::fmt::Display for Message {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.is_warning {
            "warning: "
        } else {
            "note: "
        })?;
        if !self.runs.is_empty() {
            write!(f, "{}: ", self.runs.join(", "))?;
        }
        f.write_str(&self.text)
    }
}

/// The warnings of all runs of a document, then their notes. Those that several runs share are one.
#[must_use]
pub fn messages(outcomes: &[CaseResult], document: &Document) -> Vec<Message> {
    let mut all: Vec<Message> = Vec::new();
    let mut add = |is_warning: bool, label: &str, text: String| {
        let same = all
            .iter_mut()
            .find(|known| known.is_warning == is_warning && known.text == text);
        match same {
            Some(known) => known.runs.push(label.to_owned()),
            None => all.push(Message {
                is_warning,
                runs: vec![label.to_owned()],
                text,
            }),
        }
    };
    for is_warning in [true, false] {
        for (outcome, case) in outcomes.iter().zip(&document.cases) {
            let of_case = if is_warning {
                case_warnings
            } else {
                case_notes
            };
            of_case(&case.scene, outcome)
                .into_iter()
                .for_each(|text| add(is_warning, &outcome.label, text));
        }
    }
    for message in &mut all {
        if message.runs.len() == outcomes.len() && outcomes.len() > 1 {
            message.runs.clear();
        }
    }
    all
}

fn warnings(scene: &Scene, outcome: &CaseResult) -> Vec<String> {
    let CaseResult {
        input,
        columns: record,
        run,
        ..
    } = outcome;
    let mut all = Vec::new();
    if let (Some((abandoned, t)), Some(method)) = (run.abandoned, run.method) {
        all.push(format!(
            "the method {} could not continue at t = {t:.6} s; the run was repeated with the method {}",
            stepper_word(abandoned),
            stepper_word(method)
        ));
    }
    let residual = run.audit.residual();
    if residual > RESIDUAL {
        all.push(format!(
            "the residual of the energy audit is {residual:.1e} of the peak stored energy; a smaller \"accuracy\" \
             reduces it, unless it comes from a table that is not symmetric or from a flange that engages abruptly{}",
            largest_gap(input, run)
        ));
    }
    all.extend(doubts(scene, record).iter().map(told));
    all.extend(scene::scene_warnings(scene, record));
    all.extend(slack::slack_cables(scene, input, record));
    let of_rail = |rail| Wheels {
        input,
        record,
        peaks: &outcome.peaks,
        rail,
    };
    let each = scene
        .rails
        .iter()
        .enumerate()
        .map(|(r, rail)| (rail, of_rail(r)));
    for (rail, wheels) in each {
        all.extend(large_deflection(scene, rail, &wheels));
        all.extend(axial_tension(scene, rail, &wheels));
        all.extend(near_critical_speed(scene, rail, &wheels));
        all.extend(clamped_table(scene, rail, &wheels));
        all.extend(unsymmetric_table(scene, rail, &wheels));
    }
    all.extend(lift_off(&outcome.response.uplifts));
    all
}

/// Results of half an input, and values that are probably wrong, as what was not checked.
#[must_use]
pub(crate) fn doubts(scene: &Scene, record: &NamedColumns) -> Vec<OmittedCheck> {
    let mut out = Vec::new();
    for structure in &scene.structures {
        let Origin::Spec { spec, .. } = &structure.origin else {
            continue;
        };
        let named = |reason: &str| format!("{}: {reason}", structure.name);
        let of_spec = spec.warnings().into_iter();
        out.extend(of_spec.map(|warning| OmittedCheck::new(PLAUSIBLE_SPEC, named(&warning))));
        out.extend(spec.incomplete.iter().map(|line| OmittedCheck {
            reason: named(&line.reason),
            ..line.clone()
        }));
    }
    let of_scene = scene::implausible_values(scene, record).into_iter();
    out.extend(of_scene.map(|warning| OmittedCheck::new(PLAUSIBLE_SCENE, warning)));
    out
}

/// A doubt as a warning; what is implausible needs no name.
fn told(doubt: &OmittedCheck) -> String {
    if [PLAUSIBLE_SPEC, PLAUSIBLE_SCENE].contains(&doubt.check.as_str()) {
        doubt.reason.clone()
    } else {
        doubt.to_string()
    }
}

/// The step that leaves the most energy unaccounted for, as the end of a sentence; empty if no step is known.
fn largest_gap(input: &SimulationInput, run: &Run) -> String {
    let gap = run.audit.gaps.largest[0];
    if gap.energy == 0.0 || run.audit.peak_stored == 0.0 {
        return String::new();
    }
    let name = |w: usize| {
        input
            .wheels
            .get(w)
            .map_or("a wheel", |wheel| wheel.name.as_str())
    };
    let place = match gap.cause {
        GapCause::Step => String::new(),
        GapCause::Flange(w) => format!(", where the flange of {} touches or separates", name(w)),
        GapCause::Contact(w) => format!(", where {} loses or gains contact", name(w)),
        GapCause::Break => ", at a breakpoint of a motion or load".to_owned(),
    };
    let share = gap.energy / run.audit.peak_stored;
    format!(
        "; the largest contribution of one step is {share:.1e} at t = {:.6} s{place}",
        gap.time
    )
}

/// The wheels of one rail.
struct Wheels<'a> {
    input: &'a SimulationInput,
    record: &'a NamedColumns,
    peaks: &'a [ColumnPeak],
    rail: usize,
}

impl<'a> Wheels<'a> {
    fn histories(&self, part: &'a str) -> impl Iterator<Item = &'a [f64]> {
        let (record, rail) = (self.record, self.rail);
        self.input
            .wheels
            .iter()
            .filter(move |w| w.rail == rail)
            .map(move |w| record.part(&w.name, part))
    }

    /// Largest vertical displacement of the rail under the wheels.
    fn deepest(&self) -> f64 {
        let own = self
            .input
            .wheels
            .iter()
            .filter(|wheel| wheel.rail == self.rail);
        let peak = |name: &str| {
            let column = format!("{name}.rail_deflection");
            let peak = self.peaks.iter().find(|peak| peak.column == column);
            peak.map_or(0.0, |peak| peak.largest().value.abs())
        };
        own.map(|wheel| peak(&wheel.name)).fold(0.0, f64::max)
    }
}

/// The longest span of a girder; the length of the rail where the spans are not known.
fn span(scene: &Scene, rail: &SceneRail) -> f64 {
    let longest = match &scene.structures[rail.structure].origin {
        Origin::Spec { spec, .. } => match &spec.form {
            Form::Girder(girder) => girder
                .spans
                .iter()
                .fold(0.0, |most, span| f64::max(most, *span)),
            Form::Frame(_) => 0.0,
        },
        Origin::Tables { .. } => 0.0,
    };
    if longest > 0.0 {
        longest
    } else {
        rail.range[1] - rail.range[0]
    }
}

/// A rail whose deflection is large relative to its span.
fn large_deflection(scene: &Scene, rail: &SceneRail, wheels: &Wheels) -> Option<String> {
    let deepest = wheels.deepest();
    let span = span(scene, rail);
    let ratio = deepest / span;
    let what = if span < rail.range[1] - rail.range[0] {
        "span"
    } else {
        "length"
    };
    (ratio > LARGE_DEFLECTION).then(|| {
        format!(
            "{} deflects by {ratio:.3} of its {what}, more than {LARGE_DEFLECTION}: the assumption of small \
             displacements does not hold",
            rail.name
        )
    })
}

/// A rail that is restrained lengthwise at both ends, so that bending stretches it.
fn axial_tension(scene: &Scene, rail: &SceneRail, wheels: &Wheels) -> Option<String> {
    let Origin::Spec { spec, .. } = &scene.structures[rail.structure].origin else {
        return None;
    };
    let Form::Frame(frame) = &spec.form else {
        return None;
    };
    let (_, carried) = frame.rails.get(rail.rail)?;
    let growth = tension::stiffness_growth(&frame.model, carried, wheels.deepest());
    let growth = growth.filter(|growth| *growth > TENSION)?;
    Some(format!(
        "{} lies between supports that restrain it longitudinally: axial tension would increase the bending stiffness \
         of its members by a fraction of about {growth:.2}, which is neglected; release one end longitudinally if it \
         can slide",
        rail.name
    ))
}

/// A girder whose mass is neglected, under wheels whose speed is large relative to the critical speed
/// v_cr = 2 L f_1 = (pi / L) sqrt(E I / m) of its longest span L.
fn near_critical_speed(scene: &Scene, rail: &SceneRail, wheels: &Wheels) -> Option<String> {
    let structure = &scene.structures[rail.structure];
    let is_massless = structure.foundation == Foundation::Influence;
    let Origin::Spec { spec, .. } = &structure.origin else {
        return None;
    };
    let Form::Girder(girder) = &spec.form else {
        return None;
    };
    let mass = girder.mass_per_length.filter(|mass| *mass > 0.0)?;
    if !is_massless || structure.auto || scene.analysis != Analysis::Dynamic {
        return None;
    }
    let critical = PI / span(scene, rail) * (girder.e * girder.i_vertical / mass).sqrt();
    let time = wheels.record.values("time");
    let largest_speed = |x: &[f64]| {
        let steps = x
            .windows(2)
            .zip(time.windows(2))
            .filter(|(_, t)| t[1] > t[0]);
        steps.fold(0.0_f64, |most, (x, t)| {
            most.max(((x[1] - x[0]) / (t[1] - t[0])).abs())
        })
    };
    let alpha = wheels
        .histories("x")
        .fold(0.0_f64, |most, x| most.max(largest_speed(x)))
        / critical;
    (alpha > FAST).then(|| {
        format!(
            "wheels on {} run at {alpha:.2} of the critical speed, more than {FAST}, over a girder whose mass is \
             neglected: use \"modal\", \"full\" or \"auto\" to include it",
            rail.name
        )
    })
}

/// A table that is zero at an end of the rail, with wheels between this end and the next station.
fn clamped_table(scene: &Scene, rail: &SceneRail, wheels: &Wheels) -> Option<String> {
    let structure = &scene.structures[rail.structure];
    let Origin::Tables { tables, .. } = &structure.origin else {
        return None;
    };
    let (values, stations) = (tables.vertical.as_ref()?, &tables.stations);
    let last = stations.len().checked_sub(1).filter(|last| *last > 0)?;
    if structure.foundation == Foundation::Rigid {
        return None;
    }
    let ends = [
        (0, [stations[0], stations[1]]),
        (last, [stations[last - 1], stations[last]]),
    ];
    let used: Vec<String> = ends
        .into_iter()
        .filter(|(end, _)| values[*end].iter().all(|value| *value == 0.0))
        .filter(|(_, bay)| {
            wheels
                .histories("x")
                .flatten()
                .any(|x| *x >= bay[0] && *x <= bay[1])
        })
        .map(|(end, _)| stations[end].to_string())
        .collect();
    (!used.is_empty()).then(|| {
        format!(
            "the table of {} is zero at its end {}, and wheels are in the bay adjacent to it: the table does not \
             determine whether the rail can rotate there",
            rail.name,
            used.join(" and ")
        )
    })
}

/// A body that rolls freely along a rail whose interpolation is not symmetric and therefore not conservative.
fn unsymmetric_table(scene: &Scene, rail: &SceneRail, wheels: &Wheels) -> Option<String> {
    let structure = &scene.structures[rail.structure];
    let is_unsymmetric = matches!(
        structure.interpolation,
        TableInterpolation::Akispl | TableInterpolation::Cubspl
    );
    if !is_unsymmetric
        || structure.foundation != Foundation::Influence
        || scene.analysis != Analysis::Dynamic
    {
        return None;
    }
    let free = |body: usize| {
        let root = &scene.bodies[root_body(scene, body).0];
        root.motion.is_free().then_some(&root.name)
    };
    let own = wheels
        .input
        .wheels
        .iter()
        .filter(|wheel| wheel.rail == wheels.rail);
    let body = own.filter_map(|wheel| free(wheel.body)).next()?;
    Some(format!(
        "{body} rolls freely over {}, read by {}, which is not symmetric: energy is not conserved; \"natural\" and \
         \"exact\" conserve it",
        rail.name,
        structure.interpolation.word()
    ))
}

/// Wheels that are off their rails; the one that is off for longest is named.
fn lift_off(uplifts: &[Uplift]) -> Option<String> {
    let mut wheels: Vec<(&str, f64, Vec<&Uplift>)> = Vec::new();
    for uplift in uplifts {
        match wheels.iter_mut().find(|(name, ..)| *name == uplift.wheel) {
            Some((_, duration, own)) => {
                *duration += uplift.duration;
                own.push(uplift);
            }
            None => wheels.push((&uplift.wheel, uplift.duration, vec![uplift])),
        }
    }
    let longest = wheels.iter().reduce(|a, b| if b.1 > a.1 { b } else { a });
    let (name, duration, own) = longest?;
    let first = own
        .iter()
        .map(|uplift| uplift.time)
        .fold(f64::INFINITY, f64::min);
    let [first, duration] = [first, *duration].map(|time| number(rounded(time, 4)));
    let times = match own.len() {
        1 => format!("for {duration} s from {first} s"),
        count => format!("{count} times, for {duration} s together, first at {first} s"),
    };
    Some(match wheels.len() {
        1 => format!("{name} is not in contact with its rail {times}"),
        count => {
            format!(
                "{count} wheels are not always in contact with their rails, longest {name}, {times}"
            )
        }
    })
}
