//! The calculation of a design.

use std::collections::BTreeMap;
use std::sync::Arc;

use fea::{Effect, Model, Rail};
use formats::design::{Design, DesignCase};
use formats::kept::KeptValues;
use formats::spec::{SolveError, Spec};
use formats::text::inputs::Inputs;
use formats::verdict::OmittedCheck;
use practice::limits::{DeflectionLimit, LimitedDisplacement};
use trains::{
    CaseEnvelopes, DeadLoads, Governing, Request, Structure, TrainCase, twists_without_warping,
};

use crate::chords::{Chords, PlaneSpans};
use crate::combinations::groups_left_out;
use crate::details::Details;
use crate::limits::{check_limits, fatigue_loads, left_out};
use crate::loads::{LoadKind, has, train_case};
use crate::outcome::{DesignResult, LimitCheck, ReactionExtremes, ReactionName, SolvedCase};
use crate::placed::RailLines;
use crate::rail_pairs::{has_limit, pair_limits};
use crate::rounding::Sizes;
use crate::service::{ServiceCase, ServiceLoad, service_cases};
use crate::solve_error::solve_error;
use crate::words::quantity_word;

/// Parts of each span at whose ends envelopes are listed.
const PARTS: usize = 20;

/// The solved structures of many designs: each spec is solved once, for all threads.
#[derive(Debug, Default)]
pub struct DesignStructures {
    /// By spec, and whether loads stand beside the rails.
    solved: KeptValues<(Arc<Spec>, bool), Arc<DesignStructure>>,
}

/// The model of a spec and its solution.
#[derive(Debug)]
struct DesignStructure {
    model: Model,
    rails: Vec<Rail>,
    structure: Structure,
    spans: PlaneSpans,
}

impl DesignStructures {
    fn of(&self, design: &Design) -> Result<Arc<DesignStructure>, trains::Error> {
        let mut wheels = design.trains.iter().flat_map(|train| &train.wheels);
        let is_eccentric = wheels.any(|wheel| wheel.eccentricity != 0.0);
        self.solved
            .get(&(Arc::clone(&design.spec), is_eccentric), || {
                let (model, rails) = design.spec.model()?;
                let structure = Structure::new(&model, &rails, is_eccentric)?;
                let spans = PlaneSpans::new(&design.spec, &model, &rails, &structure)?;
                Ok(Arc::new(DesignStructure {
                    model,
                    rails,
                    structure,
                    spans,
                }))
            })
    }
}

/// Solves a design; `inputs` are the files from which it was read.
///
/// # Errors
/// A structure that has no trustworthy solution; loads that it does not resist; trains that do not fit beside each other.
pub fn solve(design: &Design, inputs: &Inputs) -> Result<DesignResult, SolveError> {
    solve_on(&DesignStructures::default(), design, inputs)
}

/// Solves a design like [`solve`], on a structure that an earlier design may have solved.
///
/// # Errors
/// As [`solve`].
pub fn solve_on(
    structures: &DesignStructures,
    design: &Design,
    inputs: &Inputs,
) -> Result<DesignResult, SolveError> {
    let in_files = |error: trains::Error| solve_error(&error, design, inputs);
    let solved = structures.of(design).map_err(in_files)?;
    let DesignStructure {
        model,
        rails,
        structure,
        spans,
    } = &*solved;
    let error = structure.error_of_lines().map_err(in_files)?;
    if error > MOST_ERROR {
        let times = (error / NOTED_ERROR).powf(0.25).ceil();
        return Err(SolveError::NoSolution(format!(
            "{}: the relative error of influence lines under the preload may be {error:.1e}, more than {MOST_ERROR:e}  \
             hint: subdivide the cells that carry rails into {times} times as many `cell_data.parts`, in the general \
             form",
            design.spec_file
        )));
    }
    let dead = DeadLoads {
        gravity: design.dead.gravity,
        lines: design.dead.lines.clone(),
    };
    let (names, reactions) = reactions(design, model, structure);
    let sections = design.sections.iter().map(|section| {
        vec![Effect::InternalForce {
            member: section.member,
            place: section.place,
            component: section.component,
        }]
    });
    let mut effects = reactions.clone();
    effects.extend(sections);
    let chords = spans.chords(design);
    let request = Request {
        spans: design.spans.clone(),
        chords: chords.ends.clone(),
        places: places(design, structure),
        effects,
    };
    let cases: Vec<TrainCase> = design
        .cases
        .iter()
        .map(|case| train_case(design, case, LoadKind::All))
        .collect();
    let found = trains::envelopes(structure, &dead, &cases, &request).map_err(in_files)?;
    let mut solved = Vec::new();
    let length = (0..structure.rail_count())
        .map(|rail| structure.range(rail))
        .map(|[a, b]| b - a)
        .fold(0.0, f64::max);
    for (case, mut envelopes) in design.cases.iter().zip(found) {
        Sizes::of(&envelopes, length).clean_all(&mut envelopes);
        let mut all = std::mem::take(&mut envelopes.effects);
        let sections = all.split_off(names.len());
        solved.push(SolvedCase {
            name: case.name.clone(),
            reactions: named(&names, all),
            by_load: by_load(design, case, structure, &names, &reactions).map_err(in_files)?,
            sections,
            envelopes,
        });
    }
    let (mut told, doubts) = doubts(design);
    told.extend(warnings(design, &solved));
    let mut warnings = told;
    if error > NOTED_ERROR {
        warnings.push(format!(
            "{}: the relative error of influence lines under the preload may be {error:.1e}; it decreases with the \
             fourth power of `cell_data.parts`",
            design.spec_file
        ));
    }
    let ranges: Vec<[f64; 2]> = design.spec.rails().iter().map(|rail| rail.range).collect();
    let lines = RailLines::new(rails, &ranges, model.up);
    let details =
        Details::new(design, model, rails, &lines, &dead, &cases, &solved).map_err(in_files)?;
    let limits =
        service_limits(design, structure, &lines, &chords, &cases, &solved).map_err(in_files)?;
    let error_bound = structure.frame().certificate().error_bound;
    let mut left_out = left_out(design, &chords, groups_left_out(design), &limits);
    left_out.extend(details.left_out);
    left_out.extend(doubts);
    Ok(DesignResult {
        cases: solved,
        limits,
        chords: chords.ends,
        is_lateral_bound: rails
            .iter()
            .map(|rail| twists_without_warping(model, rail))
            .collect(),
        stresses: details.stresses,
        wheel_stresses: details.wheel_stresses,
        end_stops: details.end_stops,
        pairs: details.pairs,
        fatigue: fatigue_loads(design),
        left_out,
        warnings,
        error_bound,
    })
}

/// The limits on deflections under the loads that they name, without factors. `cases` are those of the design with their
/// factors, `solved` their responses, which serve where the loads are the same.
fn service_limits(
    design: &Design,
    structure: &Structure,
    lines: &RailLines,
    chords: &Chords,
    cases: &[TrainCase],
    solved: &[SolvedCase],
) -> Result<Vec<LimitCheck>, trains::Error> {
    let services = service_cases(design, structure);
    let trains = |services: &[ServiceCase]| -> Vec<TrainCase> {
        services
            .iter()
            .map(|case| case.train_case(design))
            .collect()
    };
    // Displacements of pairs of rails are sought in the states that govern deflections at these places.
    let places = if has_limit(design, lines) {
        places(design, structure)
    } else {
        Vec::new()
    };
    let envelopes = |services: &[ServiceCase], ends: &[Vec<Vec<f64>>; 2], places: Vec<Vec<f64>>| {
        let request = Request {
            spans: ends[0].clone(),
            chords: ends.clone(),
            places,
            ..Request::default()
        };
        trains::envelopes(
            structure,
            &DeadLoads::default(),
            &trains(services),
            &request,
        )
    };
    // Extremes of overhangs, unlike deflections from chords, contain the dead load of a case.
    let has_overhang =
        |limit: &DeflectionLimit| limit.displacement == LimitedDisplacement::Overhang;
    let is_alike =
        chords.ends[0] == design.spans && !design.practice.limits.iter().any(has_overhang);
    let known = |wanted: &TrainCase| {
        let same = |case: &TrainCase| {
            (&case.trains, case.ordered, case.gap) == (&wanted.trains, wanted.ordered, wanted.gap)
        };
        cases.iter().position(same).filter(|_| is_alike)
    };
    let service_trains = trains(&services);
    let known: Vec<Option<usize>> = service_trains.iter().map(known).collect();
    let pairs = services.iter().zip(&known);
    let new: Vec<ServiceCase> = pairs
        .filter(|(_, known)| known.is_none())
        .map(|(service, _)| service.clone())
        .collect();
    let mut computed = envelopes(&new, &chords.ends, places)?.into_iter();
    let found: Vec<CaseEnvelopes> = known
        .iter()
        .map(|known| match known {
            Some(case) => solved[*case].envelopes.clone(),
            None => computed
                .next()
                .expect("one for each service case that is not known"),
        })
        .collect();
    let mut out = check_limits(design, &chords.ends[0], &services, &found);
    out.extend(pair_limits(
        design,
        lines,
        structure,
        &services,
        &service_trains,
        &found,
    )?);
    if chords.has_soft_supports {
        let differs = chords.firm[0] != chords.ends[0];
        let affected = |service: &&ServiceCase| differs || service.load != ServiceLoad::Vertical;
        let services: Vec<ServiceCase> = services.iter().filter(affected).cloned().collect();
        let found = envelopes(&services, &chords.firm, Vec::new())?;
        // Trains that stand alone have rows of their own with the same words.
        let known = out.len();
        for row in check_limits(design, &chords.firm[0], &services, &found) {
            let same = |known: &LimitCheck| {
                (&known.rail, known.ends, known.quantity) == (&row.rail, row.ends, row.quantity)
                    && (known.case, known.clause, known.loads) == (row.case, row.clause, row.loads)
            };
            if !out[..known].iter().any(same) {
                out.push(row);
            }
        }
    }
    Ok(out)
}

/// Error of influence lines under a preload, relative, from which it is named: lines are divided for 1e-9, and a thousandth
/// is left for the rounding of this estimate.
const NOTED_ERROR: f64 = 1.001e-9;
/// The same from which a design is refused.
const MOST_ERROR: f64 = 1e-3;

/// Reactions under each kind of load alone that the case has.
fn by_load(
    design: &Design,
    case: &DesignCase,
    structure: &Structure,
    names: &[ReactionName],
    reactions: &[Vec<Effect>],
) -> Result<Vec<(LoadKind, Vec<ReactionExtremes>)>, trains::Error> {
    let mut out = Vec::new();
    for kind in LoadKind::SINGLE {
        if has(design, case, kind) {
            let alone = train_case(design, case, kind);
            let found = trains::effects(structure, &DeadLoads::default(), &[alone], reactions)?;
            out.extend(found.into_iter().map(|found| (kind, named(names, found))));
        }
    }
    Ok(out)
}

fn named(names: &[ReactionName], found: Vec<[Governing; 2]>) -> Vec<ReactionExtremes> {
    let each = names.iter().cloned().zip(found);
    each.map(|(name, extremes)| ReactionExtremes { name, extremes })
        .collect()
}

/// Names of all reactions, and the sums of restraints that each consists of.
pub(crate) fn reactions(
    design: &Design,
    model: &Model,
    structure: &Structure,
) -> (Vec<ReactionName>, Vec<Vec<Effect>>) {
    let restraints = structure.frame().restraints(model);
    let mut names = Vec::new();
    let mut sums = Vec::new();
    for ground in design.spec.supported_points(model) {
        for &dof in &ground.dofs {
            let own = restraints
                .iter()
                .filter(|one| one.point == ground.point && one.dof == dof);
            let sum: Vec<Effect> = own.copied().map(Effect::Reaction).collect();
            if !sum.is_empty() {
                names.push(ReactionName {
                    support: ground.name.clone(),
                    direction: dof.to_string(),
                });
                sums.push(sum);
            }
        }
    }
    (names, sums)
}

/// Coordinates at which envelopes are listed: stations, ends of members and spans, twentieths of spans.
fn places(design: &Design, structure: &Structure) -> Vec<Vec<f64>> {
    let rails = design.spec.rails();
    let on = |(rail, outline): (usize, &formats::spec::RailOutline)| {
        let spans = design.spans[rail].windows(2);
        let twentieths = spans.flat_map(|ends| {
            let (from, to) = (ends[0], ends[1]);
            (0..=PARTS).map(move |k| from + (to - from) * k as f64 / PARTS as f64)
        });
        let mut all: Vec<f64> = twentieths.chain(outline.stations.iter().copied()).collect();
        all.extend(structure.member_ends(rail));
        let [low, high] = structure.range(rail);
        all.retain(|x| *x >= low && *x <= high);
        all.sort_by(f64::total_cmp);
        all.dedup_by(|b, a| *b - *a <= 1e-9 * (high - low));
        all
    };
    rails.iter().enumerate().map(on).collect()
}

/// Results of half an input and values that are probably wrong, as warnings and as what was not checked.
fn doubts(design: &Design) -> (Vec<String>, Vec<OmittedCheck>) {
    let implausible = design.spec.warnings();
    let mut told: Vec<String> = Vec::new();
    let of_spec = implausible.iter().cloned();
    let of_spec = of_spec.chain(design.spec.incomplete.iter().map(ToString::to_string));
    told.extend(of_spec.map(|text| format!("{}: {text}", design.spec_file)));
    let of_design = design.doubts();
    told.extend(of_design.iter().map(ToString::to_string));
    let mut omitted = design.spec.incomplete.clone();
    omitted.extend(of_design);
    let plausibility = |warning| OmittedCheck::new("plausibility of the spec", warning);
    omitted.extend(implausible.into_iter().map(plausibility));
    (told, omitted)
}

fn warnings(design: &Design, cases: &[SolvedCase]) -> Vec<String> {
    let mut out = Vec::new();
    if design.dead.gravity > 0.0 && !design.spec.has_mass() {
        out.push(format!(
            "{}: no part of the structure has mass, so its weight is 0; specify `mass_per_length` or densities",
            design.spec_file
        ));
    }
    for (number, case) in cases.iter().enumerate() {
        // Relative to the largest of their kind: forces, moments, deflections.
        let mut sizes: BTreeMap<&str, f64> = BTreeMap::new();
        for extreme in &case.envelopes.extremes {
            let size = sizes.entry(quantity_word(extreme.quantity)).or_default();
            *size = size.max(extreme.governing.value.abs());
        }
        let open = case.envelopes.extremes.iter().filter(|extreme| {
            let gap = (extreme.bound - extreme.governing.value).abs();
            gap > 1.001e-9 * sizes[quantity_word(extreme.quantity)]
        });
        let count = open.count();
        if count > 0 {
            out.push(format!(
                "case {} ({}): {count} extremes over spans are enclosed by bounds, not exact; summary.json has the bounds",
                number + 1,
                case.name
            ));
        }
    }
    out
}
