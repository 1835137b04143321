//! Data of one run that both views of the animation use.

use crate::figures::run_figure::LabelledRun;
use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use results::layout::ScenePositions;

/// Length of the bar of the largest force, pixels.
pub(super) const BAR: f64 = 48.0;

/// One run with the frames of its animation.
pub(super) struct AnimationView<'v> {
    pub scene: &'v Scene,
    pub input: &'v SimulationInput,
    pub layout: ScenePositions<'v>,
    pub run: &'v LabelledRun<'v>,
    /// Rows of the record that are drawn as frames.
    pub rows: Vec<usize>,
    /// Index of the frame that is shown without scripts.
    pub still: usize,
    /// Pixels for each unit of force.
    pub force: f64,
}

impl AnimationView<'_> {
    /// A quantity of a wheel in each frame.
    pub fn wheel(&self, wheel: usize, part: &str) -> Vec<f64> {
        let values = self.run.record.part(&self.input.wheels[wheel].name, part);
        self.rows
            .iter()
            .map(|row| values.get(*row).copied().unwrap_or_default())
            .collect()
    }

    /// Origin of a body in each frame.
    pub fn origins(&self, body: usize) -> Vec<[f64; 3]> {
        self.rows
            .iter()
            .map(|row| self.layout.origin(self.run.record, body, *row))
            .collect()
    }

    /// Bodies in the order in which they are drawn: carried bodies after those that carry them.
    pub fn order(&self) -> Vec<usize> {
        let bodies = &self.scene.bodies;
        let mut order: Vec<usize> = (0..bodies.len()).collect();
        order.sort_by_key(|body| {
            (
                bodies[*body].in_space,
                self.layout.track(*body).is_some(),
                *body,
            )
        });
        order
    }

    /// Rails on the ground, each with the lateral coordinate of the wheels on it.
    pub fn rails(&self) -> Vec<(usize, f64)> {
        let mut rails: Vec<(usize, f64)> = Vec::new();
        for truck in &self.scene.trucks {
            let is_known = rails.iter().any(|(rail, _)| *rail == truck.rail);
            let is_grounded = self.layout.rail_line(truck.rail).is_none();
            if !is_known && is_grounded && self.scene.bodies[truck.body].pinned.is_none() {
                rails.push((truck.rail, truck.at[2]));
            }
        }
        rails
    }

    /// Indices of the wheels under each truck, in the order of the simulator.
    pub fn trucks(&self) -> Vec<std::ops::Range<usize>> {
        let mut next = 0;
        let counts = self
            .scene
            .trucks
            .iter()
            .map(|truck| truck.wheel_offsets().len());
        counts
            .map(|count| {
                next += count;
                next - count..next
            })
            .collect()
    }
}
