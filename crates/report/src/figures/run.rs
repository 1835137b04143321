//! The figures of a run, in the order of the report.

use crate::figures::run_name::run_name;
use formats::scene::Document;
use foundations::{SolvedStructure, solution_of};
use results::case_result::CaseResult;
use results::response::{Response, RunComparison};

use results::threads::parallel_map;

use super::error::FigureError;
use super::run_figure::{LabelledRun, RunFigure};
use super::{animation, motion, rails, responses, structures};
use crate::chart::Svg;

/// The figures of a run, and those that cannot be drawn.
#[derive(Default)]
pub struct RunFigures {
    /// The figures, in the order of the report.
    pub figures: Vec<RunFigure>,
    /// Figures that are omitted because they cannot be drawn.
    pub omitted: Vec<OmittedFigure>,
}

/// A figure that cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OmittedFigure {
    /// Its name, or that of its group of figures.
    pub name: String,
    /// The reason.
    pub why: String,
}

impl RunFigures {
    /// Adds the figures of a group, or records the reason why they cannot be drawn.
    fn add(
        &mut self,
        group: impl Into<String>,
        figures: Result<impl IntoIterator<Item = RunFigure>, FigureError>,
    ) {
        match figures {
            Ok(figures) => self.figures.extend(figures),
            Err(error) => self.omitted.push(OmittedFigure {
                name: group.into(),
                why: error.to_string(),
            }),
        }
    }

    /// Draws all figures, on at most `threads` threads. A figure that cannot be drawn is moved to `omitted`.
    pub fn draw(&mut self, threads: Option<u16>) -> Vec<(String, Svg)> {
        let drawn = parallel_map(&self.figures, threads, |_, figure| figure.picture.drawing());
        let mut pictures = Vec::new();
        for (mut figure, drawing) in std::mem::take(&mut self.figures).into_iter().zip(drawn) {
            let svg = match drawing {
                Ok(drawing) => {
                    figure.picture = figure.picture.with_drawing(drawing);
                    figure.svg()
                }
                Err(error) => Err(error),
            };
            match svg {
                Ok(svg) => {
                    pictures.push((figure.name.clone(), svg));
                    self.figures.push(figure);
                }
                Err(error) => {
                    self.omitted.push(OmittedFigure {
                        name: figure.name,
                        why: error.to_string(),
                    });
                }
            }
        }
        pictures
    }
}

/// The figures of a scene and its comparisons: first those of the runs with their `outcomes`, with the comparisons in
/// the same charts, then those of the structures, whose solutions are in `known`, which are drawn on at most `threads`
/// threads. Figures that cannot be evaluated are omitted.
#[must_use]
pub fn figures(
    document: &Document,
    outcomes: &[CaseResult],
    known: &[SolvedStructure],
    comparison: &RunComparison,
    threads: Option<u16>,
) -> RunFigures {
    let scene = document.scene();
    let labelled: Vec<LabelledRun> = document
        .cases
        .iter()
        .zip(outcomes)
        .map(|(case, outcome)| LabelledRun {
            label: run_name(&outcome.label).to_owned(),
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
    let mut all = RunFigures::default();
    all.add("animation", animation::animation_figure(run, input, known));
    all.figures.extend(motion::travel(run, &fired));
    all.figures
        .extend(rails::rail_sum_charts(&labelled, comparison));
    all.figures.extend(motion::paths(&labelled));
    all.figures.extend(motion::wheels(run, input));
    let responses: Vec<&Response> = outcomes.iter().map(|outcome| &outcome.response).collect();
    all.figures.extend(responses::response_charts(
        &labelled,
        &responses,
        &outcomes[0].lines,
        outcomes[0].girders(),
    ));
    for (index, structure) in scene.structures.iter().enumerate() {
        let Some(solved) = solution_of(known, &structure.origin) else {
            continue;
        };
        let name = &structure.name;
        all.add(
            format!("girder-{name}"),
            structures::girder(name, index, run, input, solved),
        );
        all.add(
            format!("influence-{name}"),
            structures::influence(name, scene.units, solved, threads),
        );
    }
    all
}
