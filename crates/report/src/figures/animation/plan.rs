//! The plan view: x to the right, the right side of the runway downward.

use super::draw::{BLUE, DARK, GREY, INK, ORANGE, PlanDrawing, SIDE, STEEL, WIDTH};
use super::view::{AnimationView, BAR};

/// Largest height of the view, pixels.
const ACROSS: f64 = 300.0;

/// Draws the plan below the ordinate `top`, and returns the ordinate of its lower end.
pub(super) fn draw(view: &AnimationView, drawing: &mut PlanDrawing, top: f64) -> f64 {
    let scene = view.scene;
    let rails = view.rails();
    let hull = |values: &mut dyn Iterator<Item = f64>| {
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    };
    let [mut from, mut to] = hull(&mut rails.iter().flat_map(|(rail, _)| scene.rails[*rail].range));
    if from >= to || !from.is_finite() || !to.is_finite() {
        (from, to) = (0.0, 1.0);
    }
    let [low, high] = hull(&mut rails.iter().map(|(_, z)| *z));
    let [low, high] = if low.is_finite() { [low, high] } else { [0.0, 0.0] };
    let mut scale = (WIDTH - 2.0 * SIDE) / (to - from);
    if high > low {
        scale = scale.min(ACROSS / (high - low));
    }
    let left = 0.5 * (WIDTH - scale * (to - from));
    let first = top + BAR + 14.0;
    let place = |[x, _, z]: [f64; 3]| [left + (x - from) * scale, first + (z - low) * scale];
    drawing.text([0.5 * WIDTH, 20.0], "From above", (INK, 14.0), "middle");
    for (rail, z) in &rails {
        let own = &scene.rails[*rail];
        let ends = own.range.map(|x| place([x, 0.0, *z]));
        drawing.line(ends, INK, 2.0);
        let side = if *z > 0.5 * (low + high) || high == low { 14.0 } else { -8.0 };
        drawing.text([ends[0][0], ends[0][1] + side], &own.name, (GREY, 11.0), "start");
        for x in &scene.structures[own.structure].rails[own.rail].stations {
            let [x, y] = place([*x, 0.0, *z]);
            drawing.line([[x, y - 2.0], [x, y + 2.0]], GREY, 1.0);
        }
    }
    let trucks = view.trucks();
    for body in view.order() {
        let places: Vec<[f64; 2]> = view.origins(body).into_iter().map(place).collect();
        if scene.bodies[body].in_space {
            drawing.moving(places, view.still, |drawing| drawing.disc([0.0, 0.0], 8.0, ORANGE));
            continue;
        }
        drawing.moving(places, view.still, |drawing| {
            let local = |point: [f64; 3]| {
                let [x, _, z] = view.layout.rotated(body, point);
                [x * scale, z * scale]
            };
            let own: Vec<(usize, [f64; 2])> = scene
                .trucks
                .iter()
                .zip(&trucks)
                .filter(|(truck, _)| truck.body == body)
                .flat_map(|(truck, range)| range.clone().zip(view.layout.wheels(truck)))
                .map(|(wheel, at)| (wheel, local(at)))
                .collect();
            let [x0, x1] = hull(&mut own.iter().map(|(_, at)| at[0]));
            let [y0, y1] = hull(&mut own.iter().map(|(_, at)| at[1]));
            let carries: Vec<_> = view.layout.carried(body).flat_map(|mount| &mount.rails).collect();
            if own.is_empty() {
            } else if carries.is_empty() && y1 - y0 < 0.5 * (high - low) * scale {
                drawing.rectangle([x0 - 4.0, y0 - 3.0, x1 - x0 + 8.0, y1 - y0 + 6.0], DARK);
            } else {
                // end trucks along both rails, girders between them
                for y in [y0, y1] {
                    drawing.rectangle([x0 - 5.0, y - 4.0, x1 - x0 + 10.0, 8.0], STEEL);
                }
                let mut girders: Vec<f64> = carries.iter().map(|axle| axle.origin[0] * scale).collect();
                if girders.is_empty() {
                    girders = vec![0.25 * (3.0 * x0 + x1), 0.25 * (x0 + 3.0 * x1)];
                }
                for x in girders {
                    drawing.rectangle([x - 4.0, y0, 8.0, y1 - y0], STEEL);
                }
            }
            for (wheel, [x, y]) in own {
                let outwards = if y > 0.5 * (y0 + y1) { 1.0 } else { -1.0 };
                let turned = view.layout.track(body).is_some();
                let bars = |part: &str, sign: f64, end: f64| -> Vec<f64> {
                    view.wheel(wheel, part).into_iter().map(|force| end + sign * view.force * force).collect()
                };
                if turned {
                    let outwards = if x > 0.5 * (x0 + x1) { 1.0 } else { -1.0 };
                    drawing.bar([x, y], "x2", bars("vertical", 0.5 * outwards, x), view.still, (BLUE, 3.0));
                } else {
                    drawing.bar([x, y], "y2", bars("vertical", outwards, y), view.still, (INK, 3.0));
                    drawing.bar([x + 4.0, y], "y2", bars("lateral", 1.0, y), view.still, (ORANGE, 3.0));
                }
            }
        });
    }
    first + (high - low) * scale + BAR + 14.0
}
