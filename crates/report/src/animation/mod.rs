//! A crane that moves: plan, and the view along the runway, as one picture and what changes in it over time.

mod draw;
mod film;
mod plan;
mod section;

pub use film::{Film, Track};

use crate::pictures::{Labelled, Plate};
use crate::{Picture, number};
use draw::{Drawing, WIDTH};
use formats::motion::Cast;
use formats::scene::Scene;
use formats::units::Dimension;
use foundations::Error;
use results::layout::ScenePositions;

/// Most frames.
const FRAMES: usize = 400;
/// Length of the longest bar, in pixels.
const BAR: f64 = 48.0;

/// What both views need of one run.
struct View<'v> {
    scene: &'v Scene,
    cast: &'v Cast,
    layout: ScenePositions<'v>,
    run: &'v Labelled<'v>,
    /// Rows of the record that are frames.
    rows: Vec<usize>,
    /// Index among them of the frame that stands still.
    still: usize,
    /// Pixels a force.
    force: f64,
}

impl View<'_> {
    /// A quantity of a wheel at the frames.
    fn wheel(&self, wheel: usize, part: &str) -> Vec<f64> {
        let values = self.run.record.part(&self.cast.wheels[wheel].name, part);
        self.rows.iter().map(|row| values.get(*row).copied().unwrap_or_default()).collect()
    }

    /// Origins of a body at the frames.
    fn origins(&self, body: usize) -> Vec<[f64; 3]> {
        self.rows.iter().map(|row| self.layout.origin(self.run.record, body, *row)).collect()
    }

    /// Bodies in the order in which they are drawn: what is carried over what carries it.
    fn order(&self) -> Vec<usize> {
        let bodies = &self.scene.bodies;
        let mut order: Vec<usize> = (0..bodies.len()).collect();
        order.sort_by_key(|body| (bodies[*body].in_space, self.layout.track(*body).is_some(), *body));
        order
    }

    /// Rails on the ground, and where the wheels of bodies on them are across.
    fn rails(&self) -> Vec<(usize, f64)> {
        let mut rails: Vec<(usize, f64)> = Vec::new();
        for truck in &self.scene.trucks {
            let is_known = rails.iter().any(|(rail, _)| *rail == truck.rail);
            let is_grounded = self.layout.axle(truck.rail).is_none();
            if !is_known && is_grounded && self.scene.bodies[truck.body].pinned.is_none() {
                rails.push((truck.rail, truck.at[2]));
            }
        }
        rails
    }

    /// Wheels of the simulator's order under each truck.
    fn trucks(&self) -> Vec<std::ops::Range<usize>> {
        let mut next = 0;
        let counts = self.scene.trucks.iter().map(|truck| truck.wheel_offsets().len());
        counts
            .map(|count| {
                next += count;
                next - count..next
            })
            .collect()
    }
}

/// The moving picture of a run in which structures ride on bodies or bodies hang in space; `None` for others.
///
/// # Errors
/// A spec that no model can be made of.
pub fn plate(run: &Labelled, cast: &Cast) -> Result<Option<Plate>, Error> {
    let scene = run.scene;
    let rides = scene.structures.iter().any(|structure| structure.on.is_some());
    let hangs = scene.bodies.iter().any(|body| body.in_space);
    let time = run.record.values("time");
    if !(rides || hangs) || time.len() < 2 {
        return Ok(None);
    }
    let every = time.len().div_ceil(FRAMES);
    let rows: Vec<usize> = (0..time.len()).step_by(every).collect();
    let layout = ScenePositions::new(scene)?;
    let largest = |row: &usize| {
        let grounded = cast.wheels.iter().filter(|wheel| layout.axle(wheel.rail).is_none());
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
    let view = View { scene, cast, layout, run, rows, still, force };
    let mut drawing = Drawing::new();
    let top = plan::draw(&view, &mut drawing, 46.0);
    let bottom = section::draw(&view, &mut drawing, top + 34.0);
    let unit = scene.units.label(Dimension::FORCE);
    let caption = format!(
        "The crane from above and along its runway at t = {:.2} s, when a wheel of the runway presses hardest: \
         {} {unit} ({}). Black bars: vertical forces of its wheels, orange: lateral ones; blue: those of wheels on the bridge, at half the \
         scale; below: the sums of each rail. It moves where scripts run.",
        time[view.rows[view.still]],
        number(most, 4).unwrap_or_default(),
        run.label,
    );
    let times: Vec<f64> = view.rows.iter().map(|row| time[*row]).collect();
    let (svg, tracks) = drawing.finish(WIDTH, bottom);
    let film = Film { svg, still: times[view.still], times, tracks };
    Ok(Some(Plate { name: "crane".to_owned(), caption, picture: Picture::Film(Box::new(film)) }))
}
