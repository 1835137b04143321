//! The moving view of a scene: of a crane its plan and the view along the runway, in one picture; of other scenes the
//! rails from the side.
//!
//! `draw` is the picture under construction, `view` the data of a run that both views of a crane need; `plan` and
//! `section` draw them; `side` is the view of other scenes.

mod draw;
mod plan;
mod section;
mod side;
mod view;

use crate::document::animated::Animation;

use crate::Picture;
use crate::figures::design::{digits, reading_unit};
use crate::figures::error::FigureError;
use crate::figures::run_figure::{LabelledRun, RunFigure};
use draw::{PlanDrawing, WIDTH};
use formats::scene::motion::SimulationInput;
use formats::units::Dimension;
use foundations::SolvedStructure;
use results::layout::ScenePositions;
use view::{AnimationView, BAR};

/// Largest number of frames.
const FRAMES: usize = 400;

/// The moving view of a run: that of a crane where bodies carry structures or hang in space, and the rails from the side
/// otherwise; `known` has the solved structures.
///
/// Its frames are rows of the record at equal distances, at most 400. Without scripts it shows the frame in which the
/// vertical force of a runway wheel is largest.
///
/// # Errors
/// A structure of which no model can be built.
pub fn animation_figure(
    run: &LabelledRun,
    input: &SimulationInput,
    known: &[SolvedStructure],
) -> Result<Option<RunFigure>, FigureError> {
    let scene = run.scene;
    let is_carrying = scene
        .structures
        .iter()
        .any(|structure| structure.carrier.is_some());
    let has_suspended = scene.bodies.iter().any(|body| body.in_space);
    let time = run.record.values("time");
    if !(is_carrying || has_suspended) {
        return side::side_view(run, input, known);
    }
    if time.len() < 2 {
        return Ok(None);
    }
    let every = time.len().div_ceil(FRAMES);
    let rows: Vec<usize> = (0..time.len()).step_by(every).collect();
    let layout = ScenePositions::new(scene)?;
    let largest = |row: &usize| {
        let grounded = input
            .wheels
            .iter()
            .filter(|wheel| layout.rail_line(wheel.rail).is_none());
        let forces = grounded.map(|wheel| run.record.part(&wheel.name, "vertical")[*row]);
        forces.fold(0.0, f64::max)
    };
    let (mut still, mut most) = (0, 0.0);
    for (frame, row) in rows.iter().enumerate() {
        if largest(row) > most {
            (still, most) = (frame, largest(row));
        }
    }
    let force = if most > 0.0 { BAR / most } else { 0.0 };
    let view = AnimationView {
        scene,
        input,
        layout,
        run,
        rows,
        still,
        force,
    };
    let mut drawing = PlanDrawing::new();
    let top = plan::draw(&view, &mut drawing, 46.0);
    let bottom = section::draw(&view, &mut drawing, top + 34.0);
    let (unit, factor) = reading_unit(scene.units, Dimension::FORCE);
    let caption = format!(
        "The crane from above and along its runway at t = {:.2} s, when the vertical force of a wheel on the runway \
         is largest: {} {unit} ({}). Black bars: vertical forces of wheels on the runway; orange: their lateral \
         forces; blue: vertical forces of wheels on the bridge, at half the scale; lower view: sums for each rail. \
         The animation requires scripts.",
        time[view.rows[view.still]],
        digits(factor * most, 4),
        run.label,
    );
    let times: Vec<f64> = view.rows.iter().map(|row| time[*row]).collect();
    let (svg, tracks) = drawing.finish(WIDTH, bottom);
    let animation = Animation {
        svg,
        still_time: times[view.still],
        times,
        tracks,
    };
    Ok(Some(RunFigure {
        name: "crane".to_owned(),
        caption,
        picture: Picture::Animation(Box::new(animation)),
    }))
}
