//! Charts of a run and of its structures.

use splines::{Axis as Direction, Compliance, ExactSurface, Influence, Probe};

use super::error::FigureError;
use crate::Picture;
use crate::chart::{
    self, Chart, ChartAxis, Deflected, GirderPlot, Series, Style, SupportMark, SurfacePlot, Svg,
};
use formats::grid::block::GridBlock;
use formats::scene::motion::{NamedWheel, SimulationInput};
use formats::scene::{Body, Scene};
use formats::units::{Dimension, Units};
use foundations::SolvedModel;
use results::columns::{NamedColumns, peak};

/// Number of points along a rail at which smooth curves are sampled.
const SAMPLES: usize = 61;

/// Largest number of wheels in a chart of lateral forces or traction.
const WHEELS: usize = 6;

/// A named picture with a caption.
pub struct RunFigure {
    /// File name without extension.
    pub name: String,
    /// The caption.
    pub caption: String,
    /// The picture.
    pub picture: Picture,
}

impl RunFigure {
    /// A chart.
    pub fn chart(name: impl Into<String>, caption: impl Into<String>, chart: Chart) -> RunFigure {
        RunFigure { name: name.into(), caption: caption.into(), picture: chart.into() }
    }

    fn drawing(name: impl Into<String>, caption: impl Into<String>, svg: Svg) -> RunFigure {
        RunFigure { name: name.into(), caption: caption.into(), picture: svg.into() }
    }

    /// As SVG.
    ///
    /// # Errors
    /// Data that the chart cannot draw.
    pub fn svg(&self) -> Result<Svg, chart::Error> {
        match &self.picture {
            Picture::Chart(chart) => chart.svg(),
            Picture::Svg(svg) => Ok(svg.clone()),
            Picture::Animation(film) => Ok(film.svg.clone()),
        }
    }
}

/// One run with its label.
pub struct LabelledRun<'a> {
    /// Its label.
    pub label: String,
    /// Its scene.
    pub scene: &'a Scene,
    /// Its columns.
    pub record: &'a NamedColumns,
}

/// Charts of the path of every body along its rail, with all runs in each chart.
#[must_use]
pub fn paths(runs: &[LabelledRun]) -> Vec<RunFigure> {
    let scene = runs[0].scene;
    let unit = scene.units.label(Dimension::LENGTH);
    let mut plates = Vec::new();
    for body in scene.bodies.iter().filter(|body| !body.in_space) {
        let mut chart = Chart::new(
            format!("Path of {}", body.name),
            ChartAxis::new("place along the rail", &unit),
            ChartAxis::new("deflection", &unit).downwards(),
        );
        for (index, run) in runs.iter().enumerate() {
            let points = run.record.points(&format!("{}.x", body.name), &format!("{}.deflection", body.name));
            let style = if index == 0 { Style::Line } else { Style::Dashed };
            chart = chart.with(Series::new(&run.label, style, points));
        }
        let caption =
            format!("Deflection of {} below the unloaded rail, over its place along the rail.", body.name);
        plates.push(RunFigure::chart(format!("path-{}", body.name), caption, chart));
    }
    plates
}

/// Charts of positions and speeds of the moving bodies over time, if the motion of any body is not prescribed;
/// `events` contains times and names of events.
#[must_use]
pub fn travel(run: &LabelledRun, events: &[(f64, &str)]) -> Vec<RunFigure> {
    let (scene, record) = (run.scene, run.record);
    if !scene.bodies.iter().any(|body| !body.in_space && body.motion.is_free()) {
        return Vec::new();
    }
    let moves = |body: &&Body| {
        let x = record.part(&body.name, "x");
        !body.in_space && body.pinned.is_none() && x.iter().any(|other| *other != x[0])
    };
    let moving: Vec<&Body> = scene.bodies.iter().filter(moves).collect();
    let each = [
        ("positions", "x", "place along its rails", Dimension::LENGTH),
        ("speeds", "speed", "speed", Dimension::SPEED),
    ];
    let plate = |(name, part, label, dimension): (&str, &str, &str, Dimension)| {
        let mut chart = Chart::new(
            format!("{}{} over time", name[..1].to_uppercase(), &name[1..]),
            ChartAxis::new("time", "s"),
            ChartAxis::new(label, scene.units.label(dimension)),
        );
        for (index, body) in moving.iter().enumerate() {
            let style = Style::alternating(index);
            let points = record.points("time", &format!("{}.{part}", body.name));
            chart = chart.with(Series::new(&body.name, style, points));
        }
        for (time, what) in events {
            chart = chart.mark(*time, *what);
        }
        let caption = format!("{} of the bodies along their rails ({}).", chart.title, run.label);
        RunFigure::chart(name, caption, chart)
    };
    if moving.is_empty() { Vec::new() } else { each.into_iter().map(plate).collect() }
}

/// Charts of the wheel forces, and of sliding and rolling of the wheels that spin.
#[must_use]
pub fn wheels(run: &LabelledRun, cast: &SimulationInput) -> Vec<RunFigure> {
    let units = run.scene.units;
    let time = || ChartAxis::new("time", "s");
    let mut forces =
        Chart::new("Wheel forces", time(), ChartAxis::new("vertical force", units.label(Dimension::FORCE)));
    for (index, wheel) in cast.wheels.iter().enumerate() {
        let name = &wheel.name;
        let style = Style::alternating(index);
        forces =
            forces.with(Series::new(name, style, run.record.points("time", &format!("{name}.vertical"))));
    }
    let caption = format!("Vertical force of each wheel on its rail ({}).", run.label);
    let mut plates = vec![RunFigure::chart("wheel-forces", caption, forces)];
    plates.extend(horizontal(run, cast, "lateral", "sideways"));
    plates.extend(horizontal(run, cast, "traction", "along the rail"));
    for wheel in cast.wheels.iter().filter(|wheel| wheel.spins) {
        plates.extend(rolling(run, wheel));
    }
    plates
}

/// Chart of the lateral forces or traction of the wheels with the largest ones; `None` if all are zero.
fn horizontal(run: &LabelledRun, cast: &SimulationInput, part: &str, word: &str) -> Option<RunFigure> {
    let reach = |wheel: &NamedWheel| {
        run.record.part(&wheel.name, part).iter().fold(0.0_f64, |most, force| most.max(force.abs()))
    };
    let mut own: Vec<(usize, f64)> = cast
        .wheels
        .iter()
        .enumerate()
        .map(|(w, wheel)| (w, reach(wheel)))
        .filter(|(_, r)| *r > 0.0)
        .collect();
    own.sort_by(|a, b| b.1.total_cmp(&a.1));
    let all = own.len();
    own.truncate(WHEELS);
    own.sort_by_key(|(w, _)| *w);
    let title = format!("Forces of wheels {word}");
    let axis = ChartAxis::new(format!("force {word}"), run.scene.units.label(Dimension::FORCE));
    let mut chart = Chart::new(title, ChartAxis::new("time", "s"), axis);
    for (index, (w, _)) in own.iter().enumerate() {
        let name = &cast.wheels[*w].name;
        let style = Style::alternating(index);
        chart = chart.with(Series::new(name, style, run.record.points("time", &format!("{name}.{part}"))));
    }
    let few = if all > WHEELS { format!(", the largest {WHEELS} of {all}") } else { String::new() };
    let caption = format!("Force of wheels on their rails {word}{few} ({}).", run.label);
    (all > 0).then(|| RunFigure::chart(format!("wheel-{part}"), caption, chart))
}

/// Charts of the speeds of hub and rim, and of the path of a point on the rim.
fn rolling(run: &LabelledRun, wheel: &NamedWheel) -> Vec<RunFigure> {
    let (units, record, name) = (run.scene.units, run.record, &wheel.name);
    let (speed, length) = (units.label(Dimension::SPEED), units.label(Dimension::LENGTH));
    let values = |part: &str| record.part(name, part);
    let radius = run.scene.wheels[wheel.kind].radius;
    let (time, x) = (record.values("time"), values("x"));
    let (spin, angle, depth) = (values("spin_speed"), values("spin_angle"), values("penetration"));
    let hub = record.part(&run.scene.bodies[wheel.body].name, "speed");
    let pairs = |f: &dyn Fn(usize) -> f64| (0..time.len()).map(|i| [time[i], f(i)]).collect::<Vec<_>>();
    let rim = |i: usize| -spin[i] * (radius - depth[i]);
    let speeds = Chart::new(
        format!("{name}: from sliding to rolling"),
        ChartAxis::new("time", "s"),
        ChartAxis::new("speed", &speed),
    )
    .with(Series::new("hub", Style::Line, pairs(&|i| hub[i])))
    .with(Series::new("rim, backwards at the rail", Style::Dashed, pairs(&rim)))
    .with(Series::new("sliding", Style::Line, pairs(&|i| hub[i] - rim(i))));
    let deepest = depth.first().copied().unwrap_or(0.0);
    let point = |i: usize| [x[i] + radius * angle[i].sin(), radius - deepest - radius * angle[i].cos()];
    let mut trochoid = Chart::new(
        format!("{name}: path of a point of the rim"),
        ChartAxis::new("along the rail", &length),
        ChartAxis::new("height above the rail", &length),
    )
    .with(Series::new("point of the rim", Style::Line, (0..time.len()).map(point).collect()))
    .with(Series::new(
        "hub",
        Style::Dashed,
        (0..time.len()).map(|i| [x[i], radius - depth[i]]).collect(),
    ));
    trochoid.equal_aspect = true;
    vec![
        RunFigure::chart(
            format!("speeds-{name}"),
            "Speed of the hub, of the rim at the rail, and their difference.",
            speeds,
        ),
        RunFigure::chart(
            format!("trochoid-{name}"),
            "A point of the rim: a line drawn out while the wheel slides, a cycloid once it rolls.",
            trochoid,
        ),
    ]
}

/// Influence of one structure: tables of its grids, lines, and the girder under the wheels of `worst`.
///
/// # Errors
/// A figure cannot be drawn, or its influence surface cannot be evaluated.
pub fn structure(name: &str, units: Units, solved: &SolvedModel) -> Result<Vec<RunFigure>, FigureError> {
    let mut plates = Vec::new();
    let length = units.label(Dimension::LENGTH);
    let supports: Vec<f64> =
        solved.model.supports.iter().map(|support| solved.model.points[support.point][0]).collect();
    for (quantity, axis, word) in [
        (GridBlock::Vertical, Direction::Vertical, "vertical"),
        (GridBlock::Lateral, Direction::Lateral, "lateral"),
    ] {
        let (Some(grid), true) = (solved.grid.block(quantity), solved.rails.len() == 1) else { continue };
        let stations = &solved.rails[0].stations;
        let table = SurfacePlot {
            title: format!("{name}: {word} influence coefficients"),
            label: format!("{word} deflection per load"),
            unit: units.label(Dimension::FLEXIBILITY),
            length_unit: length.clone(),
            at: stations.clone(),
            loads: stations.clone(),
            values: (0..grid.nrows()).map(|i| grid.row(i).iter().copied().collect()).collect(),
            supports: supports.clone(),
            note: String::new(),
        };
        let caption = format!(
            "The {word} grid at the stations: deflection at a row's station per unit load at a column's."
        );
        plates.push(RunFigure::drawing(format!("grid-{name}-{word}"), caption, table.svg()?));
        let Some(surface) = &solved.surface else { continue };
        let Some([from, to]) = surface.range(0) else { continue };
        let places: Vec<f64> =
            (0..SAMPLES).map(|i| from + (to - from) * i as f64 / (SAMPLES - 1) as f64).collect();
        let dense = dense(surface, axis, &places)?;
        let smooth = SurfacePlot {
            title: format!("{name}: {word} influence surface"),
            at: places.clone(),
            loads: places.clone(),
            values: dense,
            ..table
        };
        plates.push(RunFigure::drawing(
            format!("influence-{name}-{word}"),
            format!("The exact {word} surface between the stations, which the simulation reads."),
            smooth.svg()?,
        ));
    }
    Ok(plates)
}

/// Direct influence coefficients between all pairs of `places` on rail 0.
fn dense(surface: &ExactSurface, axis: Direction, places: &[f64]) -> Result<Vec<Vec<f64>>, splines::Error> {
    let probes: Vec<Probe> = places.iter().map(|&x| Probe { rail: 0, x, axis }).collect();
    let mut influence = Influence::zeros(probes.len());
    surface.fill(&probes, &mut influence)?;
    Ok((0..probes.len()).map(|i| influence.value.row(i).iter().copied().collect()).collect())
}

/// The girder with its rail, deflected under the wheels at the time of the largest rail deflection under a wheel.
///
/// # Errors
/// A figure cannot be drawn, or its influence surface cannot be evaluated.
pub fn girder(
    name: &str,
    structure: usize,
    run: &LabelledRun,
    cast: &SimulationInput,
    solved: &SolvedModel,
) -> Result<Option<RunFigure>, FigureError> {
    let (Some(short), Some(surface)) = (&solved.girder, &solved.surface) else { return Ok(None) };
    let Some([from, to]) = surface.range(0) else { return Ok(None) };
    let on: Vec<&String> = cast
        .wheels
        .iter()
        .filter(|wheel| run.scene.rails[wheel.rail].structure == structure)
        .map(|wheel| &wheel.name)
        .collect();
    let deepest = on
        .iter()
        .filter_map(|name| peak(run.record.part(name, "rail_deflection")))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((instant, _)) = deepest else { return Ok(None) };
    let value = |wheel: &str, part: &str| run.record.part(wheel, part)[instant];
    let loads: Vec<(f64, f64)> =
        on.iter().map(|wheel| (value(wheel, "x"), value(wheel, "vertical"))).collect();
    let places: Vec<f64> =
        (0..=4 * SAMPLES).map(|i| from + (to - from) * i as f64 / (4 * SAMPLES) as f64).collect();
    let probe = |x: f64| Probe { rail: 0, x, axis: Direction::Vertical };
    let at: Vec<Probe> =
        places.iter().map(|&x| probe(x)).chain(loads.iter().map(|&(x, _)| probe(x))).collect();
    let mut influence = Influence::zeros(at.len());
    surface.fill(&at, &mut influence)?;
    let down = |i: usize| -> f64 {
        loads.iter().enumerate().map(|(j, (_, force))| influence.value[(i, places.len() + j)] * force).sum()
    };
    let height = short.rail_height;
    let plot = GirderPlot {
        title: format!("{name} under its wheels"),
        length_unit: run.scene.units.label(Dimension::LENGTH),
        members: vec![vec![[from, 0.0], [to, 0.0]]],
        rail: vec![[from, height], [to, height]],
        supports: solved
            .model
            .supports
            .iter()
            .map(|support| SupportMark {
                at: [solved.model.points[support.point][0], 0.0],
                holds_length: support.fixed[0],
            })
            .collect(),
        stations: solved.rails[0].stations.iter().map(|&x| [x, height]).collect(),
        loads: loads.iter().map(|&(x, _)| [x, height]).collect(),
        deflected: Some(Deflected {
            label: "deflected rail".to_owned(),
            at: places.iter().map(|&x| [x, height]).collect(),
            by: (0..places.len()).map(|i| [0.0, -down(i)]).collect(),
            factor: None,
        }),
        note: String::new(),
    };
    let caption = format!(
        "The girder and its rail when the rail is deepest under a wheel, t = {:.3} s ({}).",
        run.record.values("time")[instant],
        run.label
    );
    Ok(Some(RunFigure::drawing(format!("girder-{name}"), caption, plot.svg()?)))
}
