//! The moving view of a scene without carried or suspended bodies: its rails from the side, deflected under the wheels.

use splines::{Axis, Compliance, Probe};

use super::draw::{DARK, GREY, INK, ORANGE, PlanDrawing, SIDE, STEEL, WIDTH};
use super::view::BAR;
use crate::document::animated::Animation;
use crate::figures::design::{digits, reading_unit};
use crate::figures::error::FigureError;
use crate::figures::run_figure::{LabelledRun, RunFigure};
use crate::{Picture, number};
use formats::scene::motion::SimulationInput;
use formats::units::Dimension;
use foundations::{SolvedStructure, solution_of};

/// Largest number of frames, of points along a rail, and of rails.
const FRAMES: usize = 200;
const POINTS: usize = 41;
const RAILS: usize = 3;
/// Largest drawn deflection, pixels.
const DEPTH: f64 = 40.0;
/// Radius of a wheel, pixels.
const WHEEL: f64 = 6.0;
/// Height of the view of a rail, pixels.
const HEIGHT: f64 = BAR + DEPTH + 74.0;

/// The moving side view; `None` where no wheel rolls.
///
/// The deflected rail is that of the forces of the wheels at each instant, by the influence functions of its structure
/// (without the inertia of the structure); wheels stand where the run has them. On a rail without a solved structure the
/// wheels alone are drawn.
///
/// # Errors
/// A wheel beside its rail, which a run does not have.
pub(super) fn side_view(
    run: &LabelledRun,
    input: &SimulationInput,
    known: &[SolvedStructure],
) -> Result<Option<RunFigure>, FigureError> {
    let scene = run.scene;
    let time = run.record.values("time");
    let mut rails: Vec<usize> = input.wheels.iter().map(|wheel| wheel.rail).collect();
    rails.sort_unstable();
    rails.dedup();
    rails.truncate(RAILS);
    if rails.is_empty() || time.len() < 2 {
        return Ok(None);
    }
    let rows: Vec<usize> = (0..time.len())
        .step_by(time.len().div_ceil(FRAMES))
        .collect();
    let on_rows = |name: &str, part: &str| -> Vec<f64> {
        let values = run.record.part(name, part);
        rows.iter()
            .map(|row| values.get(*row).copied().unwrap_or_default())
            .collect()
    };
    let wheels: Vec<[Vec<f64>; 3]> = input
        .wheels
        .iter()
        .map(|wheel| ["x", "rail_deflection", "vertical"].map(|part| on_rows(&wheel.name, part)))
        .collect();
    let mut shapes = Vec::new();
    for rail in &rails {
        shapes.push(deflected(run, input, known, *rail, &wheels)?);
    }
    let most =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most: f64, v| most.max(v.abs()));
    let deepest = most(
        &mut shapes
            .iter()
            .flat_map(|shape| shape.iter().flat_map(|(_, w)| w.iter().copied())),
    );
    let deepest = deepest.max(most(
        &mut wheels.iter().flat_map(|wheel| wheel[1].iter().copied()),
    ));
    let largest = most(&mut wheels.iter().flat_map(|wheel| wheel[2].iter().copied()));
    let still = (0..rows.len())
        .max_by(|a, b| {
            let depth = |frame: usize| most(&mut wheels.iter().map(|wheel| wheel[1][frame]));
            depth(*a).total_cmp(&depth(*b))
        })
        .unwrap_or_default();

    let range = |rail: usize| scene.rails[rail].range;
    let from = rails
        .iter()
        .map(|rail| range(*rail)[0])
        .fold(f64::INFINITY, f64::min);
    let to = rails
        .iter()
        .map(|rail| range(*rail)[1])
        .fold(f64::NEG_INFINITY, f64::max);
    if !(from.is_finite() && to > from) {
        return Ok(None);
    }
    let scale = (WIDTH - 2.0 * SIDE) / (to - from);
    let across = |x: f64| SIDE + (x - from) * scale;
    let depth = if deepest > 0.0 { DEPTH / deepest } else { 0.0 };
    let force = if largest > 0.0 { BAR / largest } else { 0.0 };
    let mut drawing = PlanDrawing::new();
    for (k, (rail, shape)) in rails.iter().zip(shapes).enumerate() {
        let level = 20.0 + BAR + 26.0 + HEIGHT * k as f64;
        let ends = range(*rail).map(across);
        drawing.line([[ends[0], level], [ends[1], level]], GREY, 0.8);
        drawing.text(
            [ends[0], level + DEPTH + 22.0],
            &scene.rails[*rail].name,
            (GREY, 11.0),
            "start",
        );
        let (x, w): (Vec<f64>, Vec<Vec<f64>>) = shape
            .into_iter()
            .map(|(x, w)| {
                (
                    across(x),
                    w.into_iter().map(|w| level + depth * w).collect(),
                )
            })
            .unzip();
        if !x.is_empty() {
            drawing.curve(x, w, still, (INK, 3.0));
        }
        for (wheel, [x, w, f]) in input
            .wheels
            .iter()
            .zip(&wheels)
            .filter(|(wheel, _)| wheel.rail == *rail)
        {
            let places: Vec<[f64; 2]> = x
                .iter()
                .zip(w)
                .map(|(x, w)| [across(*x), level + depth * w])
                .collect();
            let is_driven = scene.wheels[wheel.kind].driven;
            drawing.moving(places, still, |drawing| {
                drawing.disc([0.0, -WHEEL], WHEEL, if is_driven { DARK } else { STEEL });
                let top = -2.0 * WHEEL;
                let ends = f.iter().map(|f| top - force * f).collect();
                drawing.bar([0.0, top], "y2", ends, still, (ORANGE, 4.0));
            });
        }
    }
    let bottom = 20.0 + HEIGHT * rails.len() as f64;
    let unit = scene.units.label(Dimension::LENGTH);
    drawing.scale_bar([SIDE, bottom - 6.0], WIDTH - 2.0 * SIDE, scale, &unit);
    let (svg, tracks) = drawing.finish(WIDTH, bottom + 12.0);
    let (force_unit, force_factor) = reading_unit(scene.units, Dimension::FORCE);
    let factor = number(depth / scale, 2).unwrap_or_default();
    let caption = format!(
        "The wheels on their rails at t = {:.2} s, when a rail deflects most ({}). Orange: vertical forces, at most {} {}. \
         Deflections are drawn {factor} times as large as lengths along the rail, and follow from the forces of the wheels. \
         The animation requires scripts.",
        time[rows[still]],
        run.label,
        digits(force_factor * largest, 4),
        force_unit,
    );
    let times: Vec<f64> = rows.iter().map(|row| time[*row]).collect();
    let animation = Animation {
        svg,
        still_time: times[still],
        times,
        tracks,
    };
    let picture = Picture::Animation(Box::new(animation));
    Ok(Some(RunFigure {
        name: "motion".to_owned(),
        caption,
        picture,
    }))
}

/// Deflection of a rail at points along it in each frame, under the vertical forces of all wheels on its
/// structure: (place, deflections). Empty where its structure has no influence functions.
fn deflected(
    run: &LabelledRun,
    input: &SimulationInput,
    known: &[SolvedStructure],
    rail: usize,
    wheels: &[[Vec<f64>; 3]],
) -> Result<Vec<(f64, Vec<f64>)>, FigureError> {
    let scene = run.scene;
    let own = &scene.rails[rail];
    let solved = solution_of(known, &scene.structures[own.structure].origin);
    let Some(surface) = solved.and_then(|solved| solved.surface.as_ref()) else {
        return Ok(Vec::new());
    };
    let [from, to] = own.range;
    let places: Vec<f64> = (0..POINTS)
        .map(|i| from + (to - from) * i as f64 / (POINTS - 1) as f64)
        .collect();
    let at: Vec<Probe> = places
        .iter()
        .map(|&x| Probe {
            rail: own.rail,
            x,
            axis: Axis::Vertical,
        })
        .collect();
    let mut shapes: Vec<(f64, Vec<f64>)> = places.iter().map(|x| (*x, Vec::new())).collect();
    let frames = wheels.first().map_or(0, |wheel| wheel[0].len());
    let fixed = surface.at_places(&at)?;
    let mut down = vec![0.0; at.len()];
    for frame in 0..frames {
        let on = input.wheels.iter().zip(wheels);
        let on = on.filter(|(wheel, _)| scene.rails[wheel.rail].structure == own.structure);
        let loads: Vec<(Probe, f64)> = on
            .map(|(wheel, [x, _, force])| {
                let rail = scene.rails[wheel.rail].rail;
                (
                    Probe {
                        rail,
                        x: x[frame],
                        axis: Axis::Vertical,
                    },
                    force[frame],
                )
            })
            .collect();
        fixed.under(&loads, &[], &mut down)?;
        for (shape, down) in shapes.iter_mut().zip(&down) {
            shape.1.push(*down);
        }
    }
    Ok(shapes)
}
