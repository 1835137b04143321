//! The response of structures in a run: reactions, internal forces and stresses, their envelopes, the deflections of
//! rails, uplift of wheels, natural modes.
//!
//! All values are computed from the history after the run. Reactions and internal forces are the products of
//! influence lines and wheel forces, minus the effects of the inertia of the structure ([`ColumnInfluence`]).
//!
//! Files, lowest first: over_time, loaded, part_inertia, influence, envelope, serviceability, modes, this one, comparison.

mod comparison;
mod envelope;
mod influence;
mod loaded;
mod modes;
mod over_time;
mod part_inertia;
mod serviceability;

pub use crate::loads::{WheelLoad, WheelLoadReader};
pub use comparison::{ColumnStatistics, ComparedRun, RunComparison, rail_sums};
pub use envelope::{ColumnEnvelope, ColumnExtreme, Sway, Uplift};
pub use influence::ColumnInfluence;
pub(crate) use influence::{dead_load, inertia, relative_direction};
pub(crate) use loaded::{PlaceMotions, displacements};
pub use modes::SceneMode;
pub use serviceability::{Deflection, Drift};

pub(crate) use over_time::{LargestInTime, TimeSearch, crest, grid, largest_along};

use loaded::LoadedStructure;
use serde_json::{Map, Value, json};
use sim::{Channel, History, Run, SolutionNodes};

use crate::Error;
use crate::columns::NamedColumns;
use crate::pieces::{Functionals, LoadPieces, Peak, RailCells, SIGNS};
use crate::steps::{ColumnInstant, SteppedColumns};
use formats::scene::columns::{self, Column, Kind};
use formats::scene::motion::SimulationInput;
use formats::scene::{ColumnSelection, Origin, Scene};
use foundations::{BuiltFoundation, RailChords, SolvedModel, SolvedStructure, solution_of};

/// The response of the structures in a run, in addition to the columns in its record.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// The columns of reactions, internal forces and stresses in the record.
    pub columns: Vec<Column>,
    /// Value of each column under the dead load of the structures. It is included in the columns where the output of
    /// the scene requests it.
    pub dead_load: Vec<f64>,
    /// Extremes of the columns.
    pub envelopes: Vec<ColumnEnvelope>,
    /// Names of the columns of stresses with a detail category, and the values at which they turn, in their order.
    pub turns: Vec<(String, Vec<ColumnInstant>)>,
    /// Largest deflection of each span.
    pub deflections: Vec<Deflection>,
    /// Largest lateral displacement of each rail on a frame.
    pub drifts: Vec<Drift>,
    /// Intervals in which wheels are off their rails.
    pub uplifts: Vec<Uplift>,
    /// Ranges of the positions of bodies in space.
    pub sways: Vec<Sway>,
    /// Natural modes of the scene near the end of the run.
    pub modes: Vec<SceneMode>,
    /// Notes on contributions that the columns neglect.
    pub notes: Vec<String>,
}

/// For each structure of `scene`, whether it may have columns whose values need its degrees of freedom.
#[must_use]
pub fn structures_with_columns(scene: &Scene, known: &[SolvedStructure]) -> Vec<bool> {
    let few = columns::has_few(scene);
    let some = |pick: &ColumnSelection, few: bool| {
        !matches!(pick, ColumnSelection::None) && (few || !matches!(pick, ColumnSelection::Few))
    };
    let output = &scene.output;
    let is_asked = some(&output.reactions, few[0])
        || some(&output.sections, few[1])
        || some(&output.stresses, few[2]);
    scene
        .structures
        .iter()
        .map(|structure| is_asked && solution_of(known, &structure.origin).is_some())
        .collect()
}

/// Influence lines of every structure of `scene` for the columns that its output requests; `None` for a structure
/// without such columns. `built` and `solved` have one entry per structure.
///
/// # Errors
/// [`Error::Lines`] for a structure that is a mechanism.
pub fn influence_lines(
    scene: &Scene,
    built: &[BuiltFoundation],
    solved: &[Option<&SolvedModel>],
) -> Result<Vec<Option<ColumnInfluence>>, Error> {
    let few = columns::has_few(scene);
    let each =
        scene
            .structures
            .iter()
            .zip(built)
            .zip(solved)
            .map(|((structure, built), solved)| {
                let (Origin::Spec { spec, .. }, Some(solved)) = (&structure.origin, solved) else {
                    return Ok(None);
                };
                let wanted = |kind: Kind, name: &str| {
                    let (pick, few) = match kind {
                        Kind::Reaction => (&scene.output.reactions, few[0]),
                        Kind::Section => (&scene.output.sections, few[1]),
                        Kind::Stress => (&scene.output.stresses, few[2]),
                    };
                    pick.selects(name, few)
                };
                ColumnInfluence::new(&structure.name, spec, solved, built, scene.gravity, &wanted)
                    .map_err(|source| Error::Lines {
                        structure: structure.name.clone(),
                        source,
                    })
            });
    each.collect()
}

/// Solutions of the structures of a scene, and the chords of their rails.
#[derive(Clone, Copy)]
pub struct SolvedStructures<'s> {
    /// By structure; `None` for one without spec.
    pub models: &'s [Option<&'s SolvedModel>],
    /// By rail of the scene and plane (vertical, lateral): chords from which deflections are measured. Without entries no
    /// deflections are computed.
    pub chords: &'s [RailChords],
}

impl Response {
    /// The response of a run without natural modes ([`SceneMode::all`]). The columns of `lines` are added to `record`. `built` and
    /// `lines` have one entry per structure of `scene`; `nodes` are those of the solution of the run, and `steps` its columns there.
    pub fn new(
        scene: &Scene,
        input: &SimulationInput,
        (run, nodes): (&Run, &SolutionNodes),
        built: &[BuiltFoundation],
        solved: SolvedStructures<'_>,
        lines: &[Option<ColumnInfluence>],
        (record, steps): (&mut NamedColumns, &SteppedColumns),
    ) -> Response {
        let history = &run.history;
        let loads = WheelLoadReader::new(scene, input, history);
        let mut response = Response::default();
        for (s, lines) in lines.iter().enumerate() {
            if let Some(lines) = lines {
                let is_incomplete = add_columns(scene, s, history, &loads, lines, record);
                response.note_columns(scene, s, lines, is_incomplete);
                let dofs = built[s].foundation.dofs();
                let found = ColumnsInTime::new((scene, s), (run, nodes), &loads, lines, dofs);
                for (column, extremes) in lines.columns().iter().zip(found.extremes) {
                    let at = (scene, input);
                    let own = ColumnEnvelope::new(column, extremes, at, &run.solution, &loads);
                    response.envelopes.push(own);
                }
                response.turns.extend(found.turns);
            }
        }
        for (s, built) in built.iter().enumerate() {
            let loaded = LoadedStructure {
                scene,
                s,
                run: TimeSearch {
                    solution: &run.solution,
                    nodes,
                    accuracy: input.scene.accuracy,
                },
                loads: &loads,
                built,
            };
            let deflections = serviceability::deflections(&loaded, solved);
            response.deflections.extend(deflections);
            let drifts = serviceability::drifts(&loaded, solved.models[s]);
            response.drifts.extend(drifts);
        }
        response.uplifts = envelope::uplifts(input, steps);
        response.sways = envelope::sways(scene, &steps.record);
        response
    }

    /// The earliest uplift of a wheel.
    #[must_use]
    pub fn first_uplift(&self) -> Option<&Uplift> {
        let uplifts = self.uplifts.iter();
        uplifts.min_by(|a, b| a.time.total_cmp(&b.time))
    }

    /// Adds the columns of structure `s`, and a note where the structure does not resist all loads.
    fn note_columns(
        &mut self,
        scene: &Scene,
        s: usize,
        lines: &ColumnInfluence,
        is_incomplete: bool,
    ) {
        if is_incomplete {
            self.notes.push(format!(
                "{}: its reactions neglect wheel forces in directions in which the structure is unrestrained",
                scene.structures[s].name
            ));
        }
        self.dead_load.extend(lines.dead_load());
        self.columns.extend(lines.columns().iter().cloned());
    }

    /// The members of a run's summary that the response has.
    #[must_use]
    pub fn json(&self) -> Map<String, Value> {
        let mut out = Map::new();
        if !self.columns.is_empty() {
            let dead = self
                .columns
                .iter()
                .zip(&self.dead_load)
                .map(|(c, dead)| (c.name.clone(), json!(dead + 0.0)));
            out.insert("dead_load".into(), Value::Object(dead.collect()));
            let all = self
                .envelopes
                .iter()
                .map(|envelope| (envelope.column.clone(), envelope.json()));
            out.insert("envelopes".into(), Value::Object(all.collect()));
        }
        if !self.deflections.is_empty() {
            out.insert(
                "deflection_ratios".into(),
                self.deflections.iter().map(Deflection::json).collect(),
            );
        }
        if !self.drifts.is_empty() {
            out.insert(
                "drift".into(),
                self.drifts.iter().map(Drift::json).collect(),
            );
        }
        if !self.uplifts.is_empty() {
            out.insert(
                "uplift".into(),
                self.uplifts.iter().map(Uplift::json).collect(),
            );
        }
        if !self.sways.is_empty() {
            let all = self
                .sways
                .iter()
                .map(|sway| (sway.body.clone(), sway.json()));
            out.insert("sway".into(), Value::Object(all.collect()));
        }
        if !self.modes.is_empty() {
            out.insert(
                "natural_modes".into(),
                self.modes.iter().map(SceneMode::json).collect(),
            );
        }
        out
    }
}

/// What the columns of a structure are over a run.
pub(crate) struct ColumnsInTime {
    /// By column: its largest and its smallest value.
    pub extremes: Vec<[ColumnInstant; 2]>,
    turns: Vec<(String, Vec<ColumnInstant>)>,
}

impl ColumnsInTime {
    /// The columns of `lines` of structure `s`, which has `dofs` recorded degrees of freedom.
    pub fn new(
        (scene, s): (&Scene, usize),
        (run, nodes): (&Run, &SolutionNodes),
        loads: &WheelLoadReader,
        lines: &ColumnInfluence,
        dofs: usize,
    ) -> ColumnsInTime {
        let functionals = lines.functionals();
        let effects = lines.effects();
        let rails = effects
            .rails()
            .elements()
            .iter()
            .map(|element| element.rail + 1);
        let cells = RailCells::new(rails.max().unwrap_or_default(), &effects.breaks(), &[]);
        let pieces = LoadPieces::new((&run.solution, nodes), loads, (s, dofs), cells);
        let found = Functionals::new(effects, &functionals, &pieces);
        let dead = |column: usize| match scene.output.dead_load {
            true => lines.dead_load()[column],
            false => 0.0,
        };
        let extreme = |(column, peaks): (usize, [Peak; 2])| {
            [0, 1].map(|kind| ColumnInstant {
                value: SIGNS[kind] * peaks[kind].signed + dead(column),
                time: pieces.time(peaks[kind].at),
            })
        };
        let peaks = found.peaks(&|| false).into_iter();
        // without an interval there are none
        let extremes = peaks
            .enumerate()
            .filter(|_| !pieces.pieces.is_empty())
            .map(extreme);
        let turns = |(column, own): (usize, &Column)| {
            has_detail(scene, s, &own.name).then(|| {
                let mut all = found.turns(column);
                all.iter_mut().for_each(|turn| turn.value += dead(column));
                (own.name.clone(), all)
            })
        };
        ColumnsInTime {
            extremes: extremes.collect(),
            turns: lines
                .columns()
                .iter()
                .enumerate()
                .filter_map(turns)
                .collect(),
        }
    }
}

/// Whether a column is the stress at a point with a detail category.
fn has_detail(scene: &Scene, s: usize, column: &str) -> bool {
    let structure = &scene.structures[s];
    let Origin::Spec { spec, .. } = &structure.origin else {
        return false;
    };
    spec.effects.iter().any(|cut| {
        let mut points = cut.points.iter().filter(|point| point.detail.is_some());
        points.any(|point| column == format!("{}.{}.{}", structure.name, cut.name, point.name))
    })
}

/// Adds the columns of `lines`, one entry for each structure of `scene`, to `record`, which has the rows of `history`; returns them.
pub fn add_all_columns(
    scene: &Scene,
    input: &SimulationInput,
    history: &History,
    lines: &[Option<ColumnInfluence>],
    record: &mut NamedColumns,
) -> Vec<Column> {
    let loads = WheelLoadReader::new(scene, input, history);
    let mut added = Vec::new();
    for (s, lines) in lines.iter().enumerate() {
        if let Some(lines) = lines {
            add_columns(scene, s, history, &loads, lines, record);
            added.extend(lines.columns().iter().cloned());
        }
    }
    added
}

/// Adds the columns of structure `s` to `record`, which has the rows of `history`; returns whether there are loads that the
/// structure does not resist.
fn add_columns(
    scene: &Scene,
    s: usize,
    history: &History,
    loads: &WheelLoadReader,
    lines: &ColumnInfluence,
    record: &mut NamedColumns,
) -> bool {
    let start = history.position(Channel::Acceleration(s, 0));
    let mut values = vec![Vec::with_capacity(history.len()); lines.columns().len()];
    let mut is_incomplete = false;
    for sample in history.samples() {
        let (now, is_complete) = values_in(scene, (s, start), loads, lines, sample);
        is_incomplete |= !is_complete;
        for (column, value) in values.iter_mut().zip(now) {
            column.push(value);
        }
    }
    for (column, values) in lines.columns().iter().zip(values) {
        record.push(column.name.clone(), column.dimension, values);
    }
    is_incomplete
}

/// Values of the columns of structure `s` in a row, and whether it resists all loads; `start` is the position of its first
/// acceleration.
fn values_in(
    scene: &Scene,
    (s, start): (usize, Option<usize>),
    loads: &WheelLoadReader,
    lines: &ColumnInfluence,
    row: &[f64],
) -> (Vec<f64>, bool) {
    let mut now = vec![0.0; lines.columns().len()];
    let acceleration = start.map_or(&[][..], |at| &row[at..at + lines.dofs()]);
    let on = loads.at(row);
    let own = on.iter().filter(|load| load.structure == s);
    let is_complete = lines.at(own, acceleration, &mut now);
    if scene.output.dead_load {
        let dead = now.iter_mut().zip(lines.dead_load());
        dead.for_each(|(value, dead)| *value += dead);
    }
    (now, is_complete)
}
