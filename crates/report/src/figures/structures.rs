//! Figures of the structures: influence coefficients, influence surfaces, the deflected girder.

use splines::{Axis as Direction, Compliance, ExactSurface, Influence, Probe};

use super::error::FigureError;
use super::run_figure::{LabelledRun, RunFigure};
use crate::chart::{Deflected, GirderPlot, SupportMark, SurfacePlot};
use formats::grid::block::GridBlock;
use formats::scene::motion::SimulationInput;
use formats::units::{Dimension, Units};
use foundations::SolvedModel;
use results::columns::peak;
use results::threads::parallel_map;

/// Number of points along a rail at which smooth curves are sampled.
const SAMPLES: usize = 61;

/// Influence of one structure: the vertical and lateral grids at its stations and the exact surfaces between them.
/// None for structures with several rails.
///
/// # Errors
/// A figure cannot be drawn, or its influence surface cannot be evaluated.
pub fn influence(
    name: &str,
    units: Units,
    solved: &SolvedModel,
    threads: Option<u16>,
) -> Result<Vec<RunFigure>, FigureError> {
    let mut plots = Vec::new();
    let length = units.label(Dimension::LENGTH);
    let supports: Vec<f64> = solved
        .model
        .supports
        .iter()
        .map(|support| solved.model.points[support.point][0])
        .collect();
    for (quantity, axis, word) in [
        (GridBlock::Vertical, Direction::Vertical, "vertical"),
        (GridBlock::Lateral, Direction::Lateral, "lateral"),
    ] {
        let (Some(grid), true) = (solved.grid.block(quantity), solved.rails.len() == 1) else {
            continue;
        };
        let stations = &solved.rails[0].stations;
        let table = SurfacePlot {
            title: format!("{name}: {word} influence coefficients"),
            label: format!("{word} deflection per load"),
            unit: units.label(Dimension::FLEXIBILITY),
            length_unit: length.clone(),
            at: stations.clone(),
            loads: stations.clone(),
            values: (0..grid.nrows())
                .map(|i| grid.row(i).iter().copied().collect())
                .collect(),
            supports: supports.clone(),
            note: String::new(),
        };
        let caption = format!(
            "The {word} grid at the stations: deflection at the station of the row per unit load at the station of \
             the column."
        );
        plots.push((format!("grid-{name}-{word}"), caption, table.clone()));
        let Some(surface) = &solved.surface else {
            continue;
        };
        let Some([from, to]) = surface.range(0) else {
            continue;
        };
        let even = (0..SAMPLES).map(|i| from + (to - from) * i as f64 / (SAMPLES - 1) as f64);
        // the surface is zero along supports, where its contours are to end
        let mut places: Vec<f64> = even.chain(supports.iter().copied()).collect();
        places.retain(|x| (from..=to).contains(x));
        places.sort_by(f64::total_cmp);
        places.dedup_by(|b, a| *b - *a <= 1e-9 * (to - from));
        let dense = dense(surface, axis, &places)?;
        let smooth = SurfacePlot {
            title: format!("{name}: {word} influence surface"),
            at: places.clone(),
            loads: places.clone(),
            values: dense,
            ..table
        };
        let caption = format!(
            "The exact {word} influence surface, also between the stations; the simulation evaluates this surface."
        );
        plots.push((format!("influence-{name}-{word}"), caption, smooth));
    }
    let drawn = parallel_map(&plots, threads, |_, (.., plot)| plot.svg());
    let figures = plots.into_iter().zip(drawn);
    figures
        .map(|((name, caption, _), svg)| Ok(RunFigure::drawing(name, caption, svg?)))
        .collect()
}

/// Direct influence coefficients between all pairs of `places` on rail 0.
fn dense(
    surface: &ExactSurface,
    axis: Direction,
    places: &[f64],
) -> Result<Vec<Vec<f64>>, splines::Error> {
    let probes: Vec<Probe> = places.iter().map(|&x| Probe { rail: 0, x, axis }).collect();
    let mut influence = Influence::zeros(probes.len());
    surface.fill(&probes, &mut influence)?;
    Ok((0..probes.len())
        .map(|i| influence.value.row(i).iter().copied().collect())
        .collect())
}

/// The girder with its rail, deflected under the wheels at the time of the largest rail deflection under a wheel.
/// `None` for structures that are not a straight girder, or without wheels.
///
/// # Errors
/// A figure cannot be drawn, or its influence surface cannot be evaluated.
pub fn girder(
    name: &str,
    structure: usize,
    run: &LabelledRun,
    input: &SimulationInput,
    solved: &SolvedModel,
) -> Result<Option<RunFigure>, FigureError> {
    let (Some(short), Some(surface)) = (&solved.girder, &solved.surface) else {
        return Ok(None);
    };
    let Some(range) = surface.range(0) else {
        return Ok(None);
    };
    let on: Vec<&String> = input
        .wheels
        .iter()
        .filter(|wheel| run.scene.rails[wheel.rail].structure == structure)
        .map(|wheel| &wheel.name)
        .collect();
    let deepest = on
        .iter()
        .filter_map(|name| peak(run.record.part(name, "rail_deflection")))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((instant, _)) = deepest else {
        return Ok(None);
    };
    let value = |wheel: &str, part: &str| run.record.part(wheel, part)[instant];
    let loads: Vec<(f64, f64)> = on
        .iter()
        .map(|wheel| (value(wheel, "x"), value(wheel, "vertical")))
        .collect();
    let shape = deflected_rail(surface, range, &loads)?;
    let length_unit = run.scene.units.label(Dimension::LENGTH);
    let plot = girder_plot(
        name,
        length_unit,
        solved,
        short.rail_height,
        range,
        &loads,
        &shape,
    );
    let caption = format!(
        "The girder and its rail at the time of the largest rail deflection under a wheel, t = {:.3} s ({}).",
        run.record.values("time")[instant],
        run.label
    );
    Ok(Some(RunFigure::drawing(
        format!("girder-{name}"),
        caption,
        plot.svg()?,
    )))
}

/// Deflection of rail 0 under vertical `loads` (position, force) at equally spaced points of `range`: (position,
/// deflection downwards).
fn deflected_rail(
    surface: &ExactSurface,
    [from, to]: [f64; 2],
    loads: &[(f64, f64)],
) -> Result<Vec<[f64; 2]>, splines::Error> {
    let places: Vec<f64> = (0..=4 * SAMPLES)
        .map(|i| from + (to - from) * i as f64 / (4 * SAMPLES) as f64)
        .collect();
    let probe = |x: f64| Probe {
        rail: 0,
        x,
        axis: Direction::Vertical,
    };
    let at: Vec<Probe> = places.iter().map(|&x| probe(x)).collect();
    let loads: Vec<(Probe, f64)> = loads.iter().map(|&(x, force)| (probe(x), force)).collect();
    let mut down = vec![0.0; at.len()];
    surface.displacements(&at, &loads, &mut down)?;
    Ok(places
        .into_iter()
        .zip(down)
        .map(|(x, down)| [x, down])
        .collect())
}

/// Side view of the girder under `loads` (position, force), with the deflected `shape` of its rail.
fn girder_plot(
    name: &str,
    length_unit: String,
    solved: &SolvedModel,
    height: f64,
    [from, to]: [f64; 2],
    loads: &[(f64, f64)],
    shape: &[[f64; 2]],
) -> GirderPlot {
    let support_mark = |support: &fea::Support| SupportMark {
        at: [solved.model.points[support.point][0], 0.0],
        is_fixed_lengthwise: support.fixed[0],
    };
    GirderPlot {
        title: format!("{name} under its wheels"),
        length_unit,
        members: vec![vec![[from, 0.0], [to, 0.0]]],
        rail: vec![[from, height], [to, height]],
        supports: solved.model.supports.iter().map(support_mark).collect(),
        stations: solved.rails[0]
            .stations
            .iter()
            .map(|&x| [x, height])
            .collect(),
        loads: loads.iter().map(|&(x, _)| [x, height]).collect(),
        deflected: Some(Deflected {
            label: "deflected rail".to_owned(),
            at: shape.iter().map(|&[x, _]| [x, height]).collect(),
            by: shape.iter().map(|&[_, down]| [0.0, -down]).collect(),
            factor: None,
        }),
        note: String::new(),
    }
}
