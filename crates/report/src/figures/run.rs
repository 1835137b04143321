//! The figures of a run, in the order of the report.

use formats::scene::Document;
use foundations::{SolvedStructure, solution_of};
use results::case_result::CaseResult;
use results::response::{Response, RunComparison};

use super::error::FigureError;
use super::pictures::{LabelledRun, RunFigure};
use super::{animation, pictures, rail_picture, response_picture};

/// The figures of a scene and its comparisons with their `outcomes`: runs first, with comparisons in the same charts,
/// then the structures, solved in `known`.
///
/// # Errors
/// A figure that cannot be drawn or evaluated.
pub fn figures(
    document: &Document,
    outcomes: &[CaseResult],
    known: &[SolvedStructure],
    comparison: &RunComparison,
) -> Result<Vec<RunFigure>, FigureError> {
    let scene = document.scene();
    let labelled: Vec<LabelledRun> = document
        .cases
        .iter()
        .zip(outcomes)
        .map(|(case, outcome)| LabelledRun {
            label: outcome.label.clone(),
            scene: &case.scene,
            record: &outcome.columns,
        })
        .collect();
    let fired: Vec<(f64, &str)> = outcomes[0]
        .run
        .fired
        .iter()
        .map(|fired| (fired.time, scene.events[fired.rule].name.as_str()))
        .collect();
    let (run, input) = (&labelled[0], &outcomes[0].input);
    let mut plates: Vec<RunFigure> = animation::animation_figure(run, input)?.into_iter().collect();
    plates.extend(pictures::travel(run, &fired));
    plates.extend(rail_picture::rails(&labelled, comparison));
    plates.extend(pictures::paths(&labelled));
    plates.extend(pictures::wheels(run, input));
    let responses: Vec<&Response> = outcomes.iter().map(|outcome| &outcome.response).collect();
    plates.extend(response_picture::pictures(&labelled, &responses, &outcomes[0].lines));
    for (index, structure) in scene.structures.iter().enumerate() {
        let Some(solved) = solution_of(known, &structure.origin) else { continue };
        plates.extend(pictures::girder(&structure.name, index, run, input, solved)?);
        plates.extend(pictures::structure(&structure.name, scene.units, solved)?);
    }
    Ok(plates)
}
