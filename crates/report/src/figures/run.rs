//! The figures of a run, in the order of the report.

use formats::scene::Document;
use foundations::{SolvedStructure, solution_of};
use results::case_result::CaseResult;
use results::response::{Response, RunComparison};

use super::error::FigureError;
use super::run_figure::{LabelledRun, RunFigure};
use super::{animation, motion, rails, responses, structures};

/// The figures of a scene and its comparisons: first those of the runs with their `outcomes`, with the comparisons in
/// the same charts, then those of the structures, whose solutions are in `known`.
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
    let mut figures: Vec<RunFigure> = animation::animation_figure(run, input)?.into_iter().collect();
    figures.extend(motion::travel(run, &fired));
    figures.extend(rails::rail_sum_charts(&labelled, comparison));
    figures.extend(motion::paths(&labelled));
    figures.extend(motion::wheels(run, input));
    let responses: Vec<&Response> = outcomes.iter().map(|outcome| &outcome.response).collect();
    figures.extend(responses::response_charts(&labelled, &responses, &outcomes[0].lines));
    for (index, structure) in scene.structures.iter().enumerate() {
        let Some(solved) = solution_of(known, &structure.origin) else { continue };
        figures.extend(structures::girder(&structure.name, index, run, input, solved)?);
        figures.extend(structures::influence(&structure.name, scene.units, solved)?);
    }
    Ok(figures)
}
