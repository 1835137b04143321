//! The view along the runway: the lateral axis points right, the vertical axis up; numbers are shown to the right.

use super::draw::{DARK, GREY, INK, ORANGE, PlanDrawing, STEEL, WIDTH};
use super::view::{AnimationView, BAR};
use crate::figures::design::reading_unit;
use formats::units::Dimension;

/// Largest width and height of the view, pixels; the numbers are shown to its right.
const ROOM: [f64; 2] = [600.0, 330.0];

/// Draws the view below the ordinate `top`, and returns the ordinate of its lower end.
pub(super) fn draw(view: &AnimationView, drawing: &mut PlanDrawing, top: f64) -> f64 {
    let rails = view.rails();
    let origins: Vec<Vec<[f64; 3]>> = (0..view.scene.bodies.len())
        .map(|body| view.origins(body))
        .collect();
    let ropes = rope_ends(view);
    let points = rails.iter().map(|(_, z)| [*z, 0.0]);
    let points = points.chain(origins.iter().flatten().map(|[_, y, z]| [*z, *y]));
    let section = Section::new(
        view,
        points.chain(ropes.iter().flatten().flatten().copied()),
        top + 26.0,
    );
    drawing.text(
        [0.5 * WIDTH, top + 4.0],
        "Along the runway",
        (INK, 14.0),
        "middle",
    );
    let middle = rails.iter().map(|(_, z)| z).sum::<f64>() / rails.len().max(1) as f64;
    for (rail, z) in &rails {
        // labels are on the inner side, because the numbers are to the right of the view
        section.draw_rail(drawing, *rail, *z, if *z > middle { -1.0 } else { 1.0 });
    }
    for ends in &ropes {
        let both = ends
            .each_ref()
            .map(|end| end.iter().map(|at| section.place(*at)).collect());
        drawing.rope(both, view.still);
    }
    for body in view.order() {
        let places: Vec<[f64; 2]> = origins[body]
            .iter()
            .map(|[_, y, z]| section.place([*z, *y]))
            .collect();
        drawing.moving(places, view.still, |drawing| {
            section.draw_body(drawing, body)
        });
    }
    numbers(view, drawing, section.top);
    section.bottom()
}

/// The view with its scale: both axes have the same.
struct Section<'s> {
    view: &'s AnimationView<'s>,
    /// Smallest lateral and vertical coordinates that are drawn.
    low: [f64; 2],
    /// Largest lateral and vertical coordinates that are drawn.
    high: [f64; 2],
    /// Pixels for each unit of length.
    scale: f64,
    /// Size of symbols, in units of length.
    unit: f64,
    left: f64,
    top: f64,
}

impl<'s> Section<'s> {
    /// The view of all `points` (lateral, vertical) with its upper edge at the ordinate `top`.
    fn new(
        view: &'s AnimationView<'s>,
        points: impl Iterator<Item = [f64; 2]>,
        top: f64,
    ) -> Section<'s> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for (k, v) in point.into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(v), high[k].max(v));
            }
        }
        let size = (high[0] - low[0]).max(high[1] - low[1]).max(1e-9);
        let unit = 0.05 * size;
        for k in 0..2 {
            (low[k], high[k]) = (low[k] - 2.5 * unit, high[k] + 2.0 * unit);
        }
        let scale = (ROOM[0] / (high[0] - low[0])).min(ROOM[1] / (high[1] - low[1]));
        let left = 24.0 + 0.5 * (ROOM[0] - scale * (high[0] - low[0]));
        Section {
            view,
            low,
            high,
            scale,
            unit,
            left,
            top,
        }
    }

    /// Place of a point (lateral, vertical) on the picture.
    fn place(&self, [z, y]: [f64; 2]) -> [f64; 2] {
        [
            self.left + (z - self.low[0]) * self.scale,
            self.top + (self.high[1] - y) * self.scale,
        ]
    }

    /// Ordinate of the lower end of the view, with the bars of the rails.
    fn bottom(&self) -> f64 {
        let below = self.place([0.0, 0.0])[1] + self.unit * self.scale + 2.0 * BAR + 24.0;
        (self.top + (self.high[1] - self.low[1]) * self.scale + 10.0).max(below)
    }

    /// A rail at the lateral coordinate `z` with its name and the sums of the forces of its wheels; `inner` is the
    /// sign of the direction to the middle of the runway.
    fn draw_rail(&self, drawing: &mut PlanDrawing, rail: usize, z: f64, inner: f64) {
        let view = self.view;
        let at = self.place([z, 0.0]);
        let depth = self.unit * self.scale;
        drawing.rectangle([at[0] - 0.35 * depth, at[1], 0.7 * depth, depth], STEEL);
        let wheels: Vec<usize> = (0..view.input.wheels.len())
            .filter(|w| view.input.wheels[*w].rail == rail)
            .collect();
        let sum = |part: &str| -> Vec<f64> {
            let all: Vec<Vec<f64>> = wheels
                .iter()
                .map(|wheel| view.wheel(*wheel, part))
                .collect();
            (0..view.rows.len())
                .map(|k| all.iter().map(|values| values[k]).sum())
                .collect()
        };
        // the bar of all wheels of a rail is at most twice as long as that of the largest force of one wheel
        let force = view.force / wheels.len().max(1) as f64 * 2.0;
        let down = sum("vertical")
            .into_iter()
            .map(|f| at[1] + depth + force * f)
            .collect();
        drawing.bar([at[0], at[1] + depth], "y2", down, view.still, (INK, 5.0));
        let aside = sum("lateral")
            .into_iter()
            .map(|f| at[0] + force * f * 2.0)
            .collect();
        drawing.bar([at[0], at[1] - 3.0], "x2", aside, view.still, (ORANGE, 5.0));
        let anchor = if inner > 0.0 { "start" } else { "end" };
        let label = [at[0] + inner * 0.7 * depth, at[1] + 0.8 * depth];
        drawing.text(label, &view.scene.rails[rail].name, (GREY, 11.0), anchor);
    }

    /// A body relative to its origin: a ladle for a body in space, otherwise a girder or a frame over its wheels.
    fn draw_body(&self, drawing: &mut PlanDrawing, body: usize) {
        let (view, unit, scale) = (self.view, self.unit, self.scale);
        if view.scene.bodies[body].in_space {
            let [w, h] = [1.2 * unit * scale, 2.4 * unit * scale];
            drawing.shape(&[[-w, 0.0], [w, 0.0], [0.8 * w, h], [-0.8 * w, h]], ORANGE);
            return;
        }
        let trucks = view.scene.trucks.iter().filter(|truck| truck.body == body);
        let across: Vec<f64> = trucks
            .flat_map(|truck| view.layout.wheels(truck))
            .map(|at| view.layout.rotated(body, at)[2])
            .collect();
        let from = across.iter().copied().fold(f64::INFINITY, f64::min);
        let to = across.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if from > to {
            return;
        }
        let height = view.layout.carried(body).flat_map(|mount| &mount.rails);
        let height = height.map(|axle| axle.origin[1]).fold(0.0, f64::max);
        let fill = if height > 0.0 { STEEL } else { DARK };
        let tall = if height > 0.0 { height } else { 1.2 * unit };
        let [x, w] = [
            (from - 0.3 * unit) * scale,
            (to - from + 0.6 * unit) * scale,
        ];
        drawing.rectangle([x, 0.0 - tall * scale, w, tall * scale], fill);
        for z in across {
            drawing.disc([z * scale, 0.0], (0.25 * unit * scale).max(2.0), INK);
        }
    }
}

/// Both ends of every rope in each frame: lateral and vertical coordinates.
fn rope_ends(view: &AnimationView) -> Vec<[Vec<[f64; 2]>; 2]> {
    let end = |body: Option<usize>, at: [f64; 3]| -> Vec<[f64; 2]> {
        match body {
            None => vec![[at[2], at[1]]; view.rows.len()],
            Some(body) => {
                let arm = view.layout.rotated(body, at);
                view.origins(body)
                    .iter()
                    .map(|[_, y, z]| [z + arm[2], y + arm[1]])
                    .collect()
            }
        }
    };
    let ropes = view.scene.ropes.iter();
    ropes
        .map(|rope| [0, 1].map(|k| end(rope.bodies[k], rope.at[k])))
        .collect()
}

/// Adds the numbers to the right of the view: time, motion of the bodies, tensions, and sums of forces on the rails.
fn numbers(view: &AnimationView, drawing: &mut PlanDrawing, top: f64) {
    let units = view.scene.units;
    let column = |name: &str| -> Option<Vec<f64>> {
        let values = view.run.record.values(name);
        (!values.is_empty()).then(|| view.rows.iter().map(|row| values[*row]).collect())
    };
    let (force_unit, force_factor) = reading_unit(units, Dimension::FORCE);
    let mut list = vec![(
        "time".to_owned(),
        "time".to_owned(),
        ("s".to_owned(), 1.0),
        2,
    )];
    for body in &view.scene.bodies {
        let parts: &[(&str, Dimension)] = if body.in_space {
            &[
                ("X", Dimension::LENGTH),
                ("Y", Dimension::LENGTH),
                ("Z", Dimension::LENGTH),
            ]
        } else {
            &[("x", Dimension::LENGTH), ("speed", Dimension::SPEED)]
        };
        for (part, dimension) in parts {
            list.push((
                format!("{}.{part}", body.name),
                format!("{} {part}", body.name),
                (units.label(*dimension), 1.0),
                2,
            ));
        }
    }
    for rope in &view.scene.ropes {
        list.push((
            format!("{}.tension", rope.name),
            format!("{} tension", rope.name),
            (force_unit.clone(), force_factor),
            1,
        ));
    }
    for (index, rail) in view.scene.rails.iter().enumerate() {
        if view.layout.rail_line(index).is_none() {
            for (part, word) in [("reaction", "vertical"), ("lateral", "lateral")] {
                list.push((
                    format!("{}.{part}", rail.name),
                    format!("{} {word}", rail.name),
                    (force_unit.clone(), force_factor),
                    1,
                ));
            }
        }
    }
    let mut y = top + 12.0;
    for (name, what, (unit, factor), digits) in list {
        let Some(mut values) = column(&name) else {
            continue;
        };
        values.iter_mut().for_each(|value| *value *= factor);
        drawing.reading([WIDTH - 236.0, y], &what, &unit, digits, values, view.still);
        y += 19.0;
    }
}
