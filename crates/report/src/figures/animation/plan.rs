//! The plan view: the runway is horizontal and the lateral axis points down.

use super::draw::{BLUE, DARK, GREY, INK, ORANGE, PlanDrawing, SIDE, STEEL, WIDTH};
use super::view::{AnimationView, BAR};
use formats::units::Dimension;

/// Largest height of the view, pixels.
const ACROSS: f64 = 300.0;

/// Draws the plan below the ordinate `top`, and returns the ordinate of its lower end.
pub(super) fn draw(view: &AnimationView, drawing: &mut PlanDrawing, top: f64) -> f64 {
    let rails = view.rails();
    let plan = Plan::new(view, &rails, top);
    drawing.text([0.5 * WIDTH, 20.0], "From above", (INK, 14.0), "middle");
    for (rail, z) in &rails {
        plan.draw_rail(drawing, *rail, *z);
    }
    let trucks = view.trucks();
    for body in view.order() {
        let places: Vec<[f64; 2]> = view
            .origins(body)
            .into_iter()
            .map(|at| plan.place(at))
            .collect();
        if view.scene.bodies[body].in_space {
            drawing.moving(places, view.still, |drawing| {
                drawing.disc([0.0, 0.0], 8.0, ORANGE)
            });
            continue;
        }
        drawing.moving(places, view.still, |drawing| {
            plan.draw_body(drawing, body, &trucks)
        });
    }
    let [low, high] = plan.across;
    let bottom = plan.top + (high - low) * plan.scale + BAR + 14.0;
    let unit = view.scene.units.label(Dimension::LENGTH);
    drawing.scale_bar([SIDE, bottom + 12.0], WIDTH - 2.0 * SIDE, plan.scale, &unit);
    plan.draw_axes(drawing, [WIDTH - SIDE - 70.0, bottom - 8.0], &rails);
    bottom + 26.0
}

/// Least and greatest of `values`, infinities in reverse order if there are none.
fn hull(values: &mut dyn Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    })
}

/// The view with its scale: both axes of the plan have the same.
struct Plan<'p> {
    view: &'p AnimationView<'p>,
    /// Pixels for each unit of length.
    scale: f64,
    /// Coordinate along the runway that is drawn at the abscissa `left`.
    from: f64,
    /// Smallest and largest lateral coordinate of the rails.
    across: [f64; 2],
    left: f64,
    /// Ordinate of the rail with the smallest lateral coordinate.
    top: f64,
}

impl<'p> Plan<'p> {
    /// The plan of `rails` (index, lateral coordinate) below the ordinate `top`.
    fn new(view: &'p AnimationView<'p>, rails: &[(usize, f64)], top: f64) -> Plan<'p> {
        let scene = view.scene;
        let [mut from, mut to] =
            hull(&mut rails.iter().flat_map(|(rail, _)| scene.rails[*rail].range));
        if from >= to || !from.is_finite() || !to.is_finite() {
            (from, to) = (0.0, 1.0);
        }
        let [low, high] = hull(&mut rails.iter().map(|(_, z)| *z));
        let [low, high] = if low.is_finite() {
            [low, high]
        } else {
            [0.0, 0.0]
        };
        let mut scale = (WIDTH - 2.0 * SIDE) / (to - from);
        if high > low {
            scale = scale.min(ACROSS / (high - low));
        }
        let left = 0.5 * (WIDTH - scale * (to - from));
        Plan {
            view,
            scale,
            from,
            across: [low, high],
            left,
            top: top + BAR + 14.0,
        }
    }

    /// Place of a point on the picture.
    fn place(&self, [x, _, z]: [f64; 3]) -> [f64; 2] {
        [
            self.left + (x - self.from) * self.scale,
            self.top + (z - self.across[0]) * self.scale,
        ]
    }

    /// Arrows of the axes, along the runway and lateral, and of north where the names of the rails tell it.
    fn draw_axes(&self, drawing: &mut PlanDrawing, [x, y]: [f64; 2], rails: &[(usize, f64)]) {
        let mut arrow = |[dx, dy]: [f64; 2], from: [f64; 2], name: &str| {
            let tip = [from[0] + 26.0 * dx, from[1] + 26.0 * dy];
            drawing.line([from, tip], INK, 1.2);
            let side = |sign: f64| {
                [
                    tip[0] - 7.0 * dx - 3.0 * sign * dy,
                    tip[1] - 7.0 * dy + 3.0 * sign * dx,
                ]
            };
            drawing.shape(&[tip, side(1.0), side(-1.0)], INK);
            drawing.text(
                [tip[0] + 10.0 * dx + 6.0 * dy.abs(), tip[1] + 4.0 + 4.0 * dy],
                name,
                (INK, 11.0),
                "middle",
            );
        };
        arrow([1.0, 0.0], [x, y], "x");
        arrow([0.0, 1.0], [x, y], "z");
        let named = |word: &str| {
            let is_named = |(rail, _): &&(usize, f64)| {
                self.view.scene.rails[*rail]
                    .name
                    .to_lowercase()
                    .contains(word)
            };
            rails.iter().find(is_named).map(|(_, z)| *z)
        };
        if let (Some(north), Some(south)) = (named("north"), named("south")) {
            let down = (north - south).signum();
            arrow([0.0, down], [x - 40.0, y + 13.0 - 13.0 * down], "N");
        }
    }

    /// A rail with its name and stations.
    fn draw_rail(&self, drawing: &mut PlanDrawing, rail: usize, z: f64) {
        let scene = self.view.scene;
        let [low, high] = self.across;
        let own = &scene.rails[rail];
        let ends = own.range.map(|x| self.place([x, 0.0, z]));
        drawing.line(ends, INK, 2.0);
        let side = if z > 0.5 * (low + high) || high == low {
            14.0
        } else {
            -8.0
        };
        drawing.text(
            [ends[0][0], ends[0][1] + side],
            &own.name,
            (GREY, 11.0),
            "start",
        );
        for x in &scene.structures[own.structure].rails[own.rail].stations {
            let [x, y] = self.place([*x, 0.0, z]);
            drawing.line([[x, y - 2.0], [x, y + 2.0]], GREY, 1.0);
        }
    }

    /// A body on wheels relative to its origin; `trucks` are the indices of the wheels of each truck.
    fn draw_body(&self, drawing: &mut PlanDrawing, body: usize, trucks: &[std::ops::Range<usize>]) {
        let (view, scale) = (self.view, self.scale);
        let local = |point: [f64; 3]| {
            let [x, _, z] = view.layout.rotated(body, point);
            [x * scale, z * scale]
        };
        let wheels: Vec<(usize, [f64; 2])> = view
            .scene
            .trucks
            .iter()
            .zip(trucks)
            .filter(|(truck, _)| truck.body == body)
            .flat_map(|(truck, range)| range.clone().zip(view.layout.wheels(truck)))
            .map(|(wheel, at)| (wheel, local(at)))
            .collect();
        let x_range = hull(&mut wheels.iter().map(|(_, at)| at[0]));
        let y_range = hull(&mut wheels.iter().map(|(_, at)| at[1]));
        if !wheels.is_empty() {
            self.draw_frame(drawing, body, x_range, y_range);
        }
        for (wheel, at) in wheels {
            self.draw_forces(drawing, body, wheel, at, [x_range, y_range]);
        }
    }

    /// The frame of a body whose wheels lie within `x_range` and `y_range`: a bridge as end trucks on both rails with
    /// girders between them, another body as a rectangle.
    fn draw_frame(
        &self,
        drawing: &mut PlanDrawing,
        body: usize,
        [x0, x1]: [f64; 2],
        [y0, y1]: [f64; 2],
    ) {
        let [low, high] = self.across;
        let carries: Vec<_> = self
            .view
            .layout
            .carried(body)
            .flat_map(|mount| &mount.rails)
            .collect();
        if carries.is_empty() && y1 - y0 < 0.5 * (high - low) * self.scale {
            drawing.rectangle([x0 - 4.0, y0 - 3.0, x1 - x0 + 8.0, y1 - y0 + 6.0], DARK);
            return;
        }
        for y in [y0, y1] {
            drawing.rectangle([x0 - 5.0, y - 4.0, x1 - x0 + 10.0, 8.0], STEEL);
        }
        let mut girders: Vec<f64> = carries
            .iter()
            .map(|axle| axle.origin[0] * self.scale)
            .collect();
        if girders.is_empty() {
            girders = vec![0.25 * (3.0 * x0 + x1), 0.25 * (x0 + 3.0 * x1)];
        }
        for x in girders {
            drawing.rectangle([x - 4.0, y0, 8.0, y1 - y0], STEEL);
        }
    }

    /// Bars for the forces of a wheel at `[x, y]`, away from the middle of the ranges of all wheels of its body.
    /// Wheels on a bridge have one bar, at half the scale.
    fn draw_forces(
        &self,
        drawing: &mut PlanDrawing,
        body: usize,
        wheel: usize,
        [x, y]: [f64; 2],
        [[x0, x1], [y0, y1]]: [[f64; 2]; 2],
    ) {
        let view = self.view;
        let bars = |part: &str, sign: f64, end: f64| -> Vec<f64> {
            view.wheel(wheel, part)
                .into_iter()
                .map(|force| end + sign * view.force * force)
                .collect()
        };
        if view.layout.track(body).is_some() {
            let outwards = if x > 0.5 * (x0 + x1) { 1.0 } else { -1.0 };
            drawing.bar(
                [x, y],
                "x2",
                bars("vertical", 0.5 * outwards, x),
                view.still,
                (BLUE, 3.0),
            );
        } else {
            let outwards = if y > 0.5 * (y0 + y1) { 1.0 } else { -1.0 };
            drawing.bar(
                [x, y],
                "y2",
                bars("vertical", outwards, y),
                view.still,
                (INK, 3.0),
            );
            drawing.bar(
                [x + 4.0, y],
                "y2",
                bars("lateral", 1.0, y),
                view.still,
                (ORANGE, 3.0),
            );
        }
    }
}
