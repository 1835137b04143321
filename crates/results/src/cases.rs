//! The cases of a scene (the scene itself and its comparisons), each simulated on its own foundations.
//!
//! For each case the simulation input is made from the scene, foundations are chosen and the scene is run
//! ([`foundations::select_and_run`]), and the history is converted to named columns. Reactions, envelopes, natural
//! modes, values of codes and fatigue are then computed from these columns.

use std::cmp::Reverse;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use sim::{Foundation, Status};

use crate::Error;
use crate::case_result::CaseResult;
use crate::codes::{CodeCheck, SpanResponse};
use crate::columns::NamedColumns;
use crate::fatigue;
use crate::girders::{DeferredGirders, GirderInputs, SolvedMembers};
use crate::observe::ColumnObserver;
use crate::plane_spans::plane_spans;
use crate::response::{
    self, ColumnExtreme, ColumnInfluence, ColumnsInTime, Response, SceneMode, SolvedStructures,
    TimeSearch, WheelLoadReader,
};
use crate::steps::{ColumnInstant, ColumnPeak, SteppedColumns};
use crate::threads::parallel_map;
use crate::undetermined::{ContactChanges, undetermined};
use formats::scene::columns::Column;
use formats::scene::motion::{SimulationInput, simulation_input};
use formats::scene::{self, Case, Document, Scene, SceneRail, Structure};
use foundations::{BuiltFoundation, SolvedModel, SolvedStructure, solution_of};
use trains::twists_without_warping;

/// How far a simulation is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SimulationProgress<'a> {
    /// Fraction of all simulated time that is done, 0 to 1; that of a case begins again with each trial. At 1 all runs
    /// have ended and are evaluated.
    Fraction(f64),
    /// A run with these foundations begins, as one of several from which "auto" chooses.
    Trial(&'a str),
}

/// When the extremes of girders are computed, which can take longer than a run. They are the same at either time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GirderTime {
    /// With the run, on its thread; `progress` can break off.
    #[default]
    WithRun,
    /// When they are first asked for ([`CaseResult::girders`]), if ever; until then what they are computed from stays in
    /// memory.
    OnDemand,
}

/// How a scene is run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunOptions {
    /// Largest number of threads; `None`: as many as the machine has.
    pub threads: Option<u16>,
    /// When the extremes of girders are computed.
    pub girders: GirderTime,
}

/// Runs every case, on at most `threads` threads (`None`: as many as the machine has). `progress` is called from any
/// thread. `known` has the solutions of the specs of
/// all cases.
///
/// ```
/// use formats::scene::Document;
/// use foundations::{distinct_specs, solve_specs};
///
/// let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
/// let solved = solve_specs(&document, &distinct_specs(&document)).expect("a girder that stands");
/// let cases = results::cases::simulate(&document, &solved, Some(1), &|_| ()).expect("a scene that starts");
///
/// assert_eq!(cases.len(), document.cases.len(), "the scene's own case is the first");
/// assert!(cases[0].run.status.is_complete());
/// assert_eq!(cases[0].columns.columns[0].name, "time");
/// ```
///
/// # Errors
/// [`Error::Foundation`] for a foundation that cannot be built, [`Error::Run`] for a scene that cannot start,
/// [`Error::NotFinite`] for a column with a value that is not a finite number, and the errors of [`CodeCheck::new`] and [`fatigue::fatigue_results`].
pub fn simulate(
    document: &Document,
    known: &[SolvedStructure],
    threads: Option<u16>,
    progress: &(dyn Fn(SimulationProgress<'_>) + Sync),
) -> Result<Vec<CaseResult>, Error> {
    let observed = |now: SimulationProgress<'_>| {
        progress(now);
        ControlFlow::Continue(())
    };
    simulate_while(
        document,
        known,
        RunOptions {
            threads,
            ..RunOptions::default()
        },
        &observed,
    )
}

/// Runs every case like [`simulate`], with options, until `progress` breaks off.
///
/// # Errors
/// Those of [`simulate`]; [`Error::Stopped`] where `progress` breaks off.
pub fn simulate_while(
    document: &Document,
    known: &[SolvedStructure],
    options: RunOptions,
    progress: &(dyn Fn(SimulationProgress<'_>) -> ControlFlow<()> + Sync),
) -> Result<Vec<CaseResult>, Error> {
    let cases = &document.cases;
    let done: Vec<AtomicU64> = cases.iter().map(|_| AtomicU64::new(0)).collect();
    let members = Arc::new(SolvedMembers::new(known));
    let order = longest_first(cases);
    let mut outcomes = parallel_map(&order, options.threads, |_, &index| {
        let case = &cases[index];
        let fraction = || {
            let sum: u64 = done
                .iter()
                .map(|thousandths| thousandths.load(Ordering::Relaxed))
                .sum();
            progress(SimulationProgress::Fraction(
                sum as f64 / (1000.0 * cases.len() as f64),
            ))
        };
        let mut watch = |t: f64| {
            // extremes of girders may repeat the run, whose time starts again from zero
            done[index].fetch_max((1000.0 * t / case.scene.end) as u64, Ordering::Relaxed);
            fraction()
        };
        let trial = |trial: &str| {
            // with "auto" a case is run several times, and each run is a task of its own
            done[index].store(0, Ordering::Relaxed);
            // the steps of the trial ask again whether to go on
            let _ = progress(SimulationProgress::Trial(trial));
            let _ = fraction();
        };
        (
            index,
            run_case(case, &members, options.girders, &trial, &mut watch),
        )
    });
    outcomes.sort_by_key(|(index, _)| *index);
    outcomes.into_iter().map(|(_, outcome)| outcome).collect()
}

/// The cases in the order in which threads begin with them: first those that take longest, as far as their foundations tell,
/// so that no thread begins with a long one when the others are at their last. On foundations without mass a motion takes
/// several times as long as its quasi-static positions.
fn longest_first(cases: &[Case]) -> Vec<usize> {
    let of_foundation = |structure: &Structure| match structure.foundation {
        _ if structure.auto => 4,
        scene::Foundation::Full { .. } => 3,
        scene::Foundation::Modal { .. } => 2,
        scene::Foundation::Parts { .. }
        | scene::Foundation::Ties { .. }
        | scene::Foundation::Influence => 1,
        scene::Foundation::Rigid => 0,
    };
    let rank = |own: &Scene| {
        let foundation = own.structures.iter().map(of_foundation).max();
        (foundation, own.analysis == scene::Analysis::Dynamic)
    };
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by_key(|&index| Reverse(rank(&cases[index].scene)));
    order
}

/// Largest number of values of the degrees of freedom of a structure that a history stores where no column needs
/// them.
const MAX_RECORDED_VALUES: f64 = 1e7;

/// Criterion for storing the degrees of freedom of a structure (its index, its foundation) in the history of a run of
/// `scene`: columns of reactions or internal forces need them, or they are fewer than 1e7 values.
pub fn records_dofs(
    scene: &Scene,
    known: &[SolvedStructure],
) -> impl Fn(usize, &Foundation) -> bool + use<> {
    let (has_columns, rows) = (
        response::structures_with_columns(scene, known),
        scene.end / scene.dt,
    );
    move |s, foundation| {
        let dofs = foundation.dofs();
        dofs > 0 && (has_columns[s] || dofs as f64 * rows < MAX_RECORDED_VALUES)
    }
}

/// Simulates one case and evaluates its run.
fn run_case(
    case: &Case,
    members: &Arc<SolvedMembers>,
    when: GirderTime,
    trial: &dyn Fn(&str),
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<CaseResult, Error> {
    let known = members.known();
    let mut scene = case.scene.clone();
    let input = simulation_input(&scene)?;
    let recorded = records_dofs(&scene, known);
    let mut observer = ColumnObserver::new(&case.scene, &input, known, trial);
    let chosen = foundations::select_and_run(
        &mut scene,
        &input.scene,
        known,
        &recorded,
        &mut observer,
        watch,
    );
    let label = case
        .label
        .clone()
        .unwrap_or_else(|| foundation_label(&scene));
    let foundations::AutoRun {
        choices,
        run,
        built,
    } = chosen.map_err(|error| in_case(error, case, &label))?;
    if run.status == Status::Stopped {
        return Err(Error::Stopped);
    }
    let solved: Vec<Option<&SolvedModel>> = scene
        .structures
        .iter()
        .map(|structure| solution_of(known, &structure.origin))
        .collect();
    let lines = response::influence_lines(&scene, &built, &solved)?;
    let mut record = NamedColumns::new(&scene, &run.history);
    let nodes = run.solution.intervals();
    let steps = SteppedColumns::new(&scene, &nodes);
    let plane_spans = plane_spans(&scene, &solved);
    let mut response = Response::new(
        &scene,
        &input,
        (&run, &nodes),
        &built,
        SolvedStructures {
            models: &solved,
            chords: &plane_spans,
        },
        &lines,
        (&mut record, &steps),
    );
    let (mut foundations, bases): (Vec<Foundation>, Vec<_>) = built
        .into_iter()
        .map(|built| (built.foundation, built.basis))
        .unzip();
    for (s, foundation) in foundations.iter_mut().enumerate() {
        foundation.recorded = recorded(s, foundation);
    }
    response.modes = SceneMode::all(&scene, &input, &foundations, &run);
    let mut peaks = steps.peaks();
    let envelopes = response.columns.iter().zip(&response.envelopes);
    peaks.extend(envelopes.map(|(column, own)| {
        let instant = |own: &ColumnExtreme| ColumnInstant {
            value: own.value,
            time: own.time,
        };
        peak_of(column, [instant(&own.max), instant(&own.min)])
    }));
    let wheels = input.wheels.iter().map(|wheel| wheel.name.as_str());
    let changes = ContactChanges::new(response.uplifts.len(), wheels, &steps.record);
    let mut again = |factor: f64| {
        let accuracy = factor * input.scene.accuracy;
        peaks_at(accuracy, (&scene, &input), &foundations, &lines, watch)
    };
    let undetermined = match run.status.is_complete() {
        true => undetermined(scene.accuracy, changes, &peaks, &mut again),
        false => Vec::new(),
    };
    let spans = SpanResponse {
        run: TimeSearch {
            solution: &run.solution,
            nodes: &nodes,
            accuracy: scene.accuracy,
        },
        solved: &solved,
        spans: &plane_spans,
    };
    let codes = CodeCheck::new(&scene, &input, &steps.record, &spans)?;
    let fatigue = fatigue::fatigue_results(&scene, &response)?;
    let of_rail = |rail: &SceneRail| {
        let solved = solved[rail.structure];
        solved.is_some_and(|solved| twists_without_warping(&solved.model, &solved.rails[rail.rail]))
    };
    let is_lateral_bound = scene.rails.iter().map(of_rail).collect();
    let error_bounds = scene.structures.iter().zip(&solved);
    let error_bounds = error_bounds
        .filter_map(|(one, solved)| {
            let certificate = solved.as_ref()?.grid.certificate?;
            Some((one.name.clone(), certificate.error_bound))
        })
        .collect();
    if let Some((column, time)) = record.first_not_finite() {
        return Err(Error::NotFinite {
            label,
            column: column.to_owned(),
            time,
        });
    }
    let built = foundations.into_iter().zip(bases);
    let built = built
        .map(|(foundation, basis)| BuiltFoundation { foundation, basis })
        .collect();
    // not needed any more, and may be large
    drop(steps);
    let members = Arc::clone(members);
    let inputs = GirderInputs {
        scene,
        built,
        members,
    };
    let girders = match when {
        GirderTime::OnDemand => DeferredGirders::of(inputs),
        GirderTime::WithRun => {
            let end = input.scene.end;
            let found = inputs.extremes(&input, (&run.solution, &nodes), &mut || watch(end));
            found.ok_or(Error::Stopped)?.into()
        }
    };
    Ok(CaseResult {
        label,
        input,
        run,
        columns: record,
        peaks,
        undetermined,
        choices,
        lines,
        response,
        girders,
        codes,
        fatigue,
        error_bounds,
        is_lateral_bound,
        second_order: OnceLock::new(),
        warnings: OnceLock::new(),
    })
}

/// An error of the choice of foundations or of a run as one of a case.
fn in_case(error: foundations::Error, case: &Case, label: &str) -> Error {
    let foundations::Error::Simulation(error) = error else {
        return Error::Foundation(error);
    };
    let scene = &case.scene;
    let at = match &error {
        sim::Error::NoEquilibrium {
            fall: Some(fall), ..
        } => vec!["bodies".to_owned(), scene.bodies[fall.body].name.clone()],
        sim::Error::NoEquilibrium { fall: None, .. } => vec!["bodies".to_owned()],
        sim::Error::Method { .. } => vec!["stepper".to_owned()],
        sim::Error::Compliance { structure, .. } => {
            vec![
                "structures".to_owned(),
                scene.structures[*structure].name.clone(),
            ]
        }
        _ => Vec::new(),
    };
    Error::Run {
        label: label.to_owned(),
        why: crate::run_error::in_scene_names(&error, scene),
        at,
    }
}

/// The peaks of all columns of a run at another accuracy; `None` where it does not reach its end.
fn peaks_at(
    accuracy: f64,
    (scene, input): (&Scene, &SimulationInput),
    foundations: &[Foundation],
    lines: &[Option<ColumnInfluence>],
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<Vec<ColumnPeak>> {
    let other = sim::Scene {
        accuracy,
        ..input.scene.clone()
    };
    let run = sim::run_by(scene.stepping, &other, foundations, watch).ok()?;
    let nodes = run.solution.intervals();
    let mut found = SteppedColumns::new(scene, &nodes).peaks();
    let loads = WheelLoadReader::new(scene, input, &nodes.rows);
    for (s, lines) in lines.iter().enumerate() {
        let Some(lines) = lines else { continue };
        let dofs = foundations[s].dofs();
        let own = ColumnsInTime::new((scene, s), (&run, &nodes), &loads, lines, dofs);
        let each = lines.columns().iter().zip(own.extremes);
        found.extend(each.map(|(column, extremes)| peak_of(column, extremes)));
    }
    run.status.is_complete().then_some(found)
}

/// The peak of a column of influence lines.
fn peak_of(column: &Column, [max, min]: [ColumnInstant; 2]) -> ColumnPeak {
    ColumnPeak {
        column: column.name.clone(),
        dimension: column.dimension,
        max,
        min,
    }
}

/// Label of the run of the scene itself: the foundations of its structures.
fn foundation_label(scene: &Scene) -> String {
    let mut words: Vec<&str> = scene
        .structures
        .iter()
        .map(|structure| structure.foundation.word())
        .collect();
    words.dedup();
    words.join(" and ")
}
