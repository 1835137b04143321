//! The choice of foundations by "auto", and its cost.

use sim::Stepping;

use crate::measure::cpu::limited;
use crate::measure::spread::TimeSpread;
use crate::settings::budget::StudyBudget;
use crate::settings::list::{self, varies};
use formats::scene::Scene;
use formats::scene::motion::simulation_input;
use foundations::SolvedStructure;
use results::cases::records_dofs;
use results::observe::ColumnObserver;
use results::run_error;

/// The foundations that "auto" chose.
#[derive(Clone, Debug, Default)]
pub struct Auto {
    /// Name of each structure, and the reason of its foundation.
    pub reasons: Vec<(String, String)>,
    /// Times of the whole choice, all its trial runs included.
    pub trials: Option<TimeSpread>,
}

/// Lets "auto" choose every foundation that may vary, and returns its reasons and the scene on the chosen
/// foundations.
pub fn choose_foundations(
    scene: &Scene,
    known: &[SolvedStructure],
    budget: &StudyBudget,
) -> (Result<Auto, String>, Option<Scene>) {
    let mut chosen = left_to_auto(scene);
    let choices = match choose(&mut chosen, known, 10.0 * budget.limit) {
        Ok(choices) => choices,
        Err(why) => return (Err(why), None),
    };
    if choices.is_empty() {
        return (
            Err("the scene has no foundation that can vary".to_owned()),
            None,
        );
    }
    let name = |choice: &sim::Choice| chosen.structures[choice.structure].name.clone();
    let reasons = choices
        .iter()
        .map(|choice| (name(choice), foundations::selection_reason(choice)))
        .collect();
    for choice in choices.iter().filter(|choice| choice.estimate.is_some()) {
        let structure = &chosen.structures[choice.structure];
        let tolerance = sim::Tolerance {
            value: structure.tolerance,
            measure: structure.measure,
        };
        chosen.accuracy = chosen.accuracy.min(tolerance.run_accuracy());
    }
    chosen
        .structures
        .iter_mut()
        .for_each(|structure| structure.auto = false);
    (
        Ok(Auto {
            reasons,
            trials: None,
        }),
        Some(chosen),
    )
}

/// The scene with every foundation that may vary left to "auto".
#[must_use]
pub fn left_to_auto(scene: &Scene) -> Scene {
    let mut out = list::massless(scene);
    out.stepping = Stepping::default();
    for structure in out
        .structures
        .iter_mut()
        .filter(|structure| varies(structure))
    {
        structure.auto = true;
    }
    out
}

/// Lets "auto" choose within `limit` seconds of thread time.
///
/// # Errors
/// A scene that cannot be simulated, or a choice that took longer, in words.
pub fn choose(
    scene: &mut Scene,
    known: &[SolvedStructure],
    limit: f64,
) -> Result<Vec<sim::Choice>, String> {
    let input = simulation_input(scene).map_err(|failure| failure.to_string())?;
    let recorded = records_dofs(scene, known);
    let judged = scene.clone();
    let mut observer = ColumnObserver::new(&judged, &input, known, &|_| ());
    let selected = limited(limit, |watch| {
        foundations::select_and_run(scene, &input.scene, known, &recorded, &mut observer, watch)
    });
    let selected = selected.map_err(|error| match error {
        foundations::Error::Simulation(error) => run_error::in_scene_names(&error, scene),
        other => other.to_string(),
    })?;
    match selected.run.status {
        sim::Status::Stopped => Err("the choice exceeded its time limit".to_owned()),
        _ => Ok(selected.choices),
    }
}
