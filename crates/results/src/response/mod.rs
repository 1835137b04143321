//! What structures answer to a run: reactions, internal forces, their envelopes, and how far rails sag.
//!
//! All of it follows from the history: influence lines times wheel forces, less the inertia of the structure.

mod bending;
mod comparison;
mod deflection;
mod drift;
mod envelope;
mod line;
mod loaded;
mod natural;
mod part_inertia;
mod spans;
mod sway;
mod uplift;
mod wheel_load;

pub use bending::Bending;
pub use comparison::{ColumnStatistics, RunComparison, rail_sums};
pub use deflection::Deflection;
pub use drift::Drift;
pub use envelope::{ColumnEnvelope, ColumnExtreme};
pub use line::ColumnInfluence;
pub use natural::SceneMode;
pub use spans::spans;
pub use sway::Sway;
pub use uplift::Uplift;
pub use wheel_load::{WheelLoadHistories, WheelLoadHistory};

use loaded::LoadedStructure;
use serde_json::{Map, Value, json};
use sim::{Channel, History};

use crate::Error;
use crate::record::NamedColumns;
use formats::motion::Cast;
use formats::scene::columns::{self, Column, Kind};
use formats::scene::{Origin, Pick, Scene};
use foundations::{BuiltFoundation, SolvedModel, SolvedStructure, solution_of};

/// What a run's structures answered.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// Names of the columns of reactions and internal forces in the record.
    pub columns: Vec<Column>,
    /// By the structures' own weight, one a column; in the columns where the scene's output asks for it.
    pub dead: Vec<f64>,
    /// Extremes of the columns.
    pub envelopes: Vec<ColumnEnvelope>,
    /// Extremes of the bending moments along the rails, where they were asked for.
    pub bending: Vec<Bending>,
    /// Sag of the spans.
    pub deflections: Vec<Deflection>,
    /// Frames at the level of the crane.
    pub drifts: Vec<Drift>,
    /// Wheels that left their rails.
    pub uplifts: Vec<Uplift>,
    /// Where bodies in space have been.
    pub sways: Vec<Sway>,
    /// Natural modes of the scene towards its end.
    pub modes: Vec<SceneMode>,
    /// What is left out, and why.
    pub notes: Vec<String>,
}

/// Whether each structure of `scene` may have columns that its freedoms are needed for.
#[must_use]
pub fn structures_with_columns(scene: &Scene, known: &[SolvedStructure]) -> Vec<bool> {
    let few = columns::few(scene);
    let some = |pick: &Pick, few: bool| !matches!(pick, Pick::None) && (few || !matches!(pick, Pick::Few));
    let output = &scene.output;
    let asked =
        some(&output.reactions, few[0]) || some(&output.sections, few[1]) || some(&output.stresses, few[2]);
    scene
        .structures
        .iter()
        .map(|structure| asked && solution_of(known, &structure.origin).is_some())
        .collect()
}

/// Influence lines of every structure of `scene` for the columns it asks for; `None` where it asks for none.
///
/// # Errors
/// A structure that does not stand.
pub fn lines(
    scene: &Scene,
    laid: &[BuiltFoundation],
    solved: &[Option<&SolvedModel>],
) -> Result<Vec<Option<ColumnInfluence>>, Error> {
    let few = columns::few(scene);
    let each = scene.structures.iter().zip(laid).zip(solved).map(|((structure, laid), solved)| {
        let (Origin::Spec { spec, .. }, Some(solved)) = (&structure.origin, solved) else { return Ok(None) };
        let wanted = |kind: Kind, name: &str| {
            let (pick, few) = match kind {
                Kind::Reaction => (&scene.output.reactions, few[0]),
                Kind::Section => (&scene.output.sections, few[1]),
                Kind::Stress => (&scene.output.stresses, few[2]),
            };
            pick.takes(name, few)
        };
        ColumnInfluence::new(&structure.name, spec, solved, laid, scene.gravity, &wanted)
            .map_err(|source| Error::Lines { structure: structure.name.clone(), source })
    });
    each.collect()
}

impl Response {
    /// Adds the columns of `lines` to `record`, and finds everything else.
    ///
    /// # Errors
    /// A place beyond a rail.
    pub fn new(
        scene: &Scene,
        cast: &Cast,
        history: &History,
        laid: &[BuiltFoundation],
        solved: &[Option<&SolvedModel>],
        lines: &[Option<ColumnInfluence>],
        record: &mut NamedColumns,
    ) -> Result<Response, Error> {
        let loads = WheelLoadHistories::new(scene, cast, history);
        let mut response = Response::default();
        for (s, lines) in lines.iter().enumerate() {
            let Some(lines) = lines else { continue };
            let start = history.channels().iter().position(|c| *c == Channel::Acceleration(s, 0));
            let mut values = vec![Vec::with_capacity(history.len()); lines.columns().len()];
            let mut now = vec![0.0; lines.columns().len()];
            let mut lost = false;
            for i in 0..history.len() {
                let sample = history.sample(i);
                let acceleration = start.map_or(&[][..], |at| &sample[at..at + lines.freedoms()]);
                let on = loads.at(sample);
                lost |= !lines.at(on.iter().filter(|load| load.structure == s), acceleration, &mut now);
                let dead = lines.dead().iter().map(|own| if scene.output.dead_load { *own } else { 0.0 });
                for ((column, value), dead) in values.iter_mut().zip(&now).zip(dead) {
                    column.push(value + dead);
                }
            }
            if lost {
                response.notes.push(format!(
                    "{}: wheel forces in directions that it does not resist are left out of its reactions",
                    scene.structures[s].name
                ));
            }
            response.dead.extend(lines.dead());
            for (column, values) in lines.columns().iter().zip(values) {
                record.push(column.name.clone(), column.dimension, values);
                response.columns.push(column.clone());
            }
        }
        response.envelopes = ColumnEnvelope::all(&response.columns, scene, cast, history, &loads, record)
            .map_err(Error::Envelope)?;
        for (s, structure) in scene.structures.iter().enumerate() {
            let failed = |source| Error::Rails { structure: structure.name.clone(), source };
            let loaded = LoadedStructure { scene, s, history, loads: &loads, laid: &laid[s] };
            response.deflections.extend(deflection::of(&loaded, solved[s]).map_err(failed)?);
            response.drifts.extend(drift::of(&loaded, solved[s]).map_err(failed)?);
        }
        response.uplifts = uplift::all(cast, record);
        response.sways = sway::all(scene, record);
        Ok(response)
    }

    /// Finds the extremes of the bending moments along the rails of structures that have a beam spec, for pictures.
    ///
    /// # Errors
    /// A structure that does not stand.
    pub fn bend(
        &mut self,
        scene: &Scene,
        cast: &Cast,
        history: &History,
        laid: &[BuiltFoundation],
        solved: &[Option<&SolvedModel>],
    ) -> Result<(), Error> {
        let loads = WheelLoadHistories::new(scene, cast, history);
        for (s, (laid, solved)) in laid.iter().zip(solved).enumerate() {
            let is_known = laid.foundation.freedoms() == 0 || laid.foundation.recorded;
            let Some(solved) = solved.filter(|_| is_known) else { continue };
            let failed = |source| Error::Lines { structure: scene.structures[s].name.clone(), source };
            let loaded = LoadedStructure { scene, s, history, loads: &loads, laid };
            self.bending.extend(bending::of(&loaded, solved).map_err(failed)?);
        }
        Ok(())
    }

    /// Members of a run's summary.
    #[must_use]
    pub fn json(&self) -> Map<String, Value> {
        let mut out = Map::new();
        if !self.columns.is_empty() {
            let dead =
                self.columns.iter().zip(&self.dead).map(|(c, dead)| (c.name.clone(), json!(dead + 0.0)));
            out.insert("dead_load".into(), Value::Object(dead.collect()));
            let all = self.envelopes.iter().map(|envelope| (envelope.column.clone(), envelope.json()));
            out.insert("envelopes".into(), Value::Object(all.collect()));
        }
        if !self.deflections.is_empty() {
            out.insert("deflection_ratios".into(), self.deflections.iter().map(Deflection::json).collect());
        }
        if !self.drifts.is_empty() {
            out.insert("drift".into(), self.drifts.iter().map(Drift::json).collect());
        }
        if !self.uplifts.is_empty() {
            out.insert("uplift".into(), self.uplifts.iter().map(Uplift::json).collect());
        }
        if !self.sways.is_empty() {
            let all = self.sways.iter().map(|sway| (sway.body.clone(), sway.json()));
            out.insert("sway".into(), Value::Object(all.collect()));
        }
        if !self.modes.is_empty() {
            out.insert("natural_modes".into(), self.modes.iter().map(SceneMode::json).collect());
        }
        out
    }
}
