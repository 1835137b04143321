//! Charts of the motion: paths, positions and speeds of bodies, forces of wheels, sliding and rolling.

use super::design::{column_unit, reading_unit, scaled};
use super::run_figure::{LabelledRun, RunFigure};
use crate::chart::{Chart, ChartAxis, Series, Style};
use crate::is_rounding;
use formats::scene::Body;
use formats::scene::motion::{NamedWheel, SimulationInput};
use formats::units::Dimension;

/// Largest number of wheels in a chart of lateral forces or traction.
const WHEELS: usize = 6;

/// Largest number of wheels in the chart of vertical forces.
const VERTICAL_WHEELS: usize = 8;

/// Charts of the path of every body along its rail, with all runs in each chart; of the deflection over time where a body
/// stays at its place.
#[must_use]
pub fn paths(runs: &[LabelledRun]) -> Vec<RunFigure> {
    let scene = runs[0].scene;
    let length = scene.units.label(Dimension::LENGTH);
    let mut figures = Vec::new();
    for body in scene.bodies.iter().filter(|body| !body.in_space) {
        let values = runs
            .iter()
            .flat_map(|run| run.record.part(&body.name, "deflection"));
        let largest = values.fold(0.0_f64, |most, value| most.max(value.abs()));
        let (unit, factor) = column_unit(scene.units, Dimension::LENGTH, largest);
        let stays = |run: &LabelledRun| {
            run.record
                .part(&body.name, "x")
                .windows(2)
                .all(|pair| pair[0] == pair[1])
        };
        let (abscissa, title, x, over) = if runs.iter().all(stays) {
            (
                "time".to_owned(),
                format!("Deflection of {}", body.name),
                ChartAxis::new("time", "s"),
                "time",
            )
        } else {
            let axis = ChartAxis::new("position along the rail", &length);
            (
                format!("{}.x", body.name),
                format!("Path of {}", body.name),
                axis,
                "its position along the rail",
            )
        };
        let mut chart = Chart::new(title, x, ChartAxis::new("deflection", &unit).downwards());
        for (index, run) in runs.iter().enumerate() {
            let points = run
                .record
                .points(&abscissa, &format!("{}.deflection", body.name));
            let style = if index == 0 {
                Style::Line
            } else {
                Style::Dashed
            };
            chart = chart.with(Series::new(&run.label, style, scaled(points, factor)));
        }
        let caption = format!(
            "Deflection of {} below the unloaded rail, over {over}.",
            body.name
        );
        figures.push(RunFigure::chart(
            format!("path-{}", body.name),
            caption,
            chart,
        ));
    }
    figures
}

/// Charts of positions and speeds of the moving bodies over time, if the motion of any body is not prescribed.
/// `events` contains times and names of events.
#[must_use]
pub fn travel(run: &LabelledRun, events: &[(f64, &str)]) -> Vec<RunFigure> {
    let (scene, record) = (run.scene, run.record);
    if !scene
        .bodies
        .iter()
        .any(|body| !body.in_space && body.motion.is_free())
    {
        return Vec::new();
    }
    let moves = |body: &&Body| {
        let x = record.part(&body.name, "x");
        !body.in_space && body.pinned.is_none() && x.iter().any(|other| *other != x[0])
    };
    let moving: Vec<&Body> = scene.bodies.iter().filter(moves).collect();
    let each = [
        (
            "positions",
            "x",
            "position along its rails",
            Dimension::LENGTH,
        ),
        ("speeds", "speed", "speed", Dimension::SPEED),
    ];
    let figure = |(name, part, label, dimension): (&str, &str, &str, Dimension)| {
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
        let caption = format!(
            "{} of the bodies along their rails ({}).",
            chart.title, run.label
        );
        RunFigure::chart(name, caption, chart)
    };
    if moving.is_empty() {
        Vec::new()
    } else {
        each.into_iter().map(figure).collect()
    }
}

/// Charts of the wheel forces, and of sliding and rolling of the wheels that spin.
#[must_use]
pub fn wheels(run: &LabelledRun, input: &SimulationInput) -> Vec<RunFigure> {
    let mut figures = Vec::new();
    figures.extend(forces(
        run,
        input,
        "vertical",
        ["Wheel forces", "vertical force"],
    ));
    figures.extend(forces(
        run,
        input,
        "lateral",
        ["Lateral forces of the wheels", "lateral force"],
    ));
    figures.extend(forces(
        run,
        input,
        "traction",
        ["Traction of the wheels", "traction"],
    ));
    for wheel in input.wheels.iter().filter(|wheel| wheel.spins) {
        figures.extend(rolling(run, wheel));
    }
    figures
}

/// Chart of one force, the `part` of a wheel, for the wheels with the largest ones; of wheels with equal forces, such as
/// those under one equaliser, the first is drawn. `None` if a horizontal force is zero at all wheels.
fn forces(
    run: &LabelledRun,
    input: &SimulationInput,
    part: &str,
    [title, quantity]: [&str; 2],
) -> Option<RunFigure> {
    let values = |wheel: &NamedWheel| run.record.part(&wheel.name, part);
    let largest = |wheel: &NamedWheel| {
        values(wheel)
            .iter()
            .fold(0.0_f64, |most, force| most.max(force.abs()))
    };
    let is_vertical = part == "vertical";
    let acting: Vec<&NamedWheel> = input
        .wheels
        .iter()
        .filter(|wheel| is_vertical || largest(wheel) > 0.0)
        .collect();
    let mut own: Vec<(usize, f64)> = Vec::new();
    for (w, wheel) in acting.iter().enumerate() {
        let most = largest(wheel);
        let is_equal = |(other, _): &(usize, f64)| {
            let pairs = values(acting[*other]).iter().zip(values(wheel));
            pairs.into_iter().all(|(a, b)| is_rounding(a - b, most))
        };
        if !own.iter().any(is_equal) {
            own.push((w, most));
        }
    }
    let different = own.len();
    let count = if is_vertical { VERTICAL_WHEELS } else { WHEELS };
    own.sort_by(|a, b| b.1.total_cmp(&a.1));
    own.truncate(count);
    own.sort_by_key(|(w, _)| *w);
    let (unit, factor) = reading_unit(run.scene.units, Dimension::FORCE);
    let mut chart = Chart::new(
        title,
        ChartAxis::new("time", "s"),
        ChartAxis::new(quantity, unit),
    );
    for (index, (w, _)) in own.iter().enumerate() {
        let name = &acting[*w].name;
        let style = Style::alternating(index);
        let points = run.record.points("time", &format!("{name}.{part}"));
        chart = chart.with(Series::new(name, style, scaled(points, factor)));
    }
    let few = match (different < acting.len(), different > count) {
        (_, true) => format!(", the {count} largest of {}", acting.len()),
        (true, false) => ", one of those with equal forces".to_owned(),
        (false, false) => String::new(),
    };
    let what = if is_vertical {
        "Vertical forces of the wheels"
    } else {
        title
    };
    let caption = format!("{what} on their rails{few} ({}).", run.label);
    let name = if is_vertical {
        "wheel-forces".to_owned()
    } else {
        format!("wheel-{part}")
    };
    (!acting.is_empty()).then(|| RunFigure::chart(name, caption, chart))
}

/// Charts of the speeds of hub and rim, and of the path of a point on the rim.
fn rolling(run: &LabelledRun, wheel: &NamedWheel) -> Vec<RunFigure> {
    let (units, record, name) = (run.scene.units, run.record, &wheel.name);
    let (speed, length) = (
        units.label(Dimension::SPEED),
        units.label(Dimension::LENGTH),
    );
    let values = |part: &str| record.part(name, part);
    let radius = run.scene.wheels[wheel.kind].radius;
    let (time, x) = (record.values("time"), values("x"));
    let (spin, angle, depth) = (
        values("spin_speed"),
        values("spin_angle"),
        values("penetration"),
    );
    let hub = record.part(&run.scene.bodies[wheel.body].name, "speed");
    let pairs =
        |f: &dyn Fn(usize) -> f64| (0..time.len()).map(|i| [time[i], f(i)]).collect::<Vec<_>>();
    let rim = |i: usize| -spin[i] * (radius - depth[i]);
    let speeds = Chart::new(
        format!("{name}: from sliding to rolling"),
        ChartAxis::new("time", "s"),
        ChartAxis::new("speed", &speed),
    )
    .with(Series::new("hub", Style::Line, pairs(&|i| hub[i])))
    .with(Series::new(
        "rim at the rail, backwards",
        Style::Dashed,
        pairs(&rim),
    ))
    .with(Series::new(
        "sliding speed",
        Style::Line,
        pairs(&|i| hub[i] - rim(i)),
    ));
    let deepest = depth.first().copied().unwrap_or(0.0);
    let point = |i: usize| {
        [
            x[i] + radius * angle[i].sin(),
            radius - deepest - radius * angle[i].cos(),
        ]
    };
    let mut trochoid = Chart::new(
        format!("{name}: path of a point on the rim"),
        ChartAxis::new("position along the rail", &length),
        ChartAxis::new("height above the rail", &length),
    )
    .with(Series::new(
        "point on the rim",
        Style::Line,
        (0..time.len()).map(point).collect(),
    ))
    .with(Series::new(
        "hub",
        Style::Dashed,
        (0..time.len()).map(|i| [x[i], radius - depth[i]]).collect(),
    ));
    trochoid.equal_aspect = true;
    vec![
        RunFigure::chart(
            format!("speeds-{name}"),
            "Speed of the hub, speed of the rim at the rail, and their difference, the sliding speed.",
            speeds,
        ),
        RunFigure::chart(
            format!("trochoid-{name}"),
            "Path of a point on the rim: a stretched curve while the wheel slides, a cycloid once it rolls.",
            trochoid,
        ),
    ]
}
