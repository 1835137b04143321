//! Pictures of the paper's girder and bogie, written where they can be looked at.

use super::*;
use std::f64::consts::PI;

const EI: f64 = 9.528 * 4.32e9;

/// Influence function of the simply supported 60 ft girder with overhangs, ft/lbf.
fn influence(x: f64, z: f64) -> f64 {
    let kernel = |a: f64, b: f64| (a - b).abs().powi(3) / (12.0 * EI);
    let weights = |a: f64| [1.0 - a / 60.0, a / 60.0];
    let supports = [0.0, 60.0];
    let mut total = kernel(x, z);
    for i in 0..2 {
        total -= weights(x)[i] * kernel(supports[i], z) + weights(z)[i] * kernel(x, supports[i]);
        for j in 0..2 {
            total += weights(x)[i] * weights(z)[j] * kernel(supports[i], supports[j]);
        }
    }
    total
}

fn stations(count: usize) -> Vec<f64> {
    (0..count)
        .map(|i| -15.0 + 90.0 * i as f64 / (count - 1) as f64)
        .collect()
}

fn surface(count: usize, loads: usize) -> SurfacePlot {
    let (at, loads) = (stations(count), stations(loads));
    let values = at
        .iter()
        .map(|x| loads.iter().map(|z| influence(*x, *z)).collect())
        .collect();
    SurfacePlot {
        title: "Influence surface of the girder".into(),
        label: "vertical deflection per unit load".into(),
        unit: "ft/lbf".into(),
        length_unit: "ft".into(),
        at,
        loads,
        values,
        supports: vec![0.0, 60.0],
        note: "Positive up: a load on an overhang lifts the span.".into(),
    }
}

/// Parses the picture, and writes it to the folder named by `GIRDERWAY_CHARTS` so that it can be looked at.
fn show(name: &str, picture: &Svg) -> String {
    let svg = picture.file();
    if let Some(folder) = std::env::var_os("GIRDERWAY_CHARTS").map(std::path::PathBuf::from) {
        std::fs::create_dir_all(&folder).expect("the folder can be made");
        std::fs::write(folder.join(format!("{name}.svg")), &svg)
            .expect("the folder can be written");
    }
    roxmltree::Document::parse(&svg).expect("an SVG file is XML");
    svg
}

fn crossing(label: &str, style: Style, scale: f64) -> Series {
    let at = |i: usize| 60.0 * i as f64 / 600.0;
    let deflection = |x: f64| scale * 0.5 * (PI * x / 60.0).sin().powi(2) + 0.024;
    Series::new(
        label,
        style,
        (0..=600).map(|i| [at(i), deflection(at(i))]).collect(),
    )
}

fn trunnion() -> Chart {
    Chart::new(
        "Path of the trunnion over the girder",
        ChartAxis::new("position of the trunnion", "ft"),
        ChartAxis::new("deflection", "ft").downwards(),
    )
    .with(crossing("influence, exact", Style::Line, 1.04))
    .with(crossing(
        "two rigid parts, contact handed over",
        Style::Line,
        2.3,
    ))
    .with(crossing(
        "two rigid parts, two forces a wheel",
        Style::Dashed,
        2.1,
    ))
    .with(crossing(
        "AKISPL reading of the printed table",
        Style::Line,
        1.01,
    ))
    .with(Series::new(
        "rigid rail",
        Style::Dashed,
        vec![[0.0, 0.05], [60.0, 0.05]],
    ))
    .with(Series::new(
        "classical, midspan",
        Style::Points,
        vec![[30.0, 0.525]],
    ))
    .mark(0.0, "support")
    .mark(30.0, "midspan")
    .mark(32.0, "end of the first part")
    .mark(60.0, "support")
}

#[test]
fn path_of_the_trunnion_is_drawn() {
    show("trunnion", &trunnion().svg().expect("data are finite"));
}

#[test]
fn wheel_forces_stand_in_millions() {
    let force = |i: usize| {
        2.4e6 * (1.0 + 0.02 * (i as f64 * 0.01).sin()) + if i > 6000 { -8e4 } else { 0.0 }
    };
    let points = (0..20_000).map(|i| [i as f64 * 6e-4, force(i)]).collect();
    let chart = Chart::new(
        "Wheel forces",
        ChartAxis::new("time", "s"),
        ChartAxis::new("wheel force", "lbf"),
    )
    .with(Series::new("rear wheel", Style::Line, points))
    .with(Series::new(
        "command",
        Style::Step,
        vec![[0.0, 2.4e6], [4.0, 2.41e6], [8.0, 2.39e6], [12.0, 2.4e6]],
    ));
    let svg = show("forces", &chart.svg().expect("data are finite"));
    assert!(
        svg.contains("wheel force (10\u{2076} lbf)"),
        "the power of ten is in the caption"
    );
    assert!(svg.len() < 150_000, "20,000 points are thinned");
}

#[test]
fn rim_path_keeps_its_aspect() {
    let r = 1.25;
    let rim = |i: usize| {
        let a = i as f64 * 0.01;
        [r * a - r * a.sin(), r - r * a.cos()]
    };
    let mut chart = Chart::new(
        "Path of a point of the rim",
        ChartAxis::new("x", "ft"),
        ChartAxis::new("y", "ft"),
    )
    .with(Series::new(
        "rim",
        Style::Line,
        (0..2000).map(rim).collect(),
    ));
    chart.equal_aspect = true;
    let drawing = chart.draw().expect("data are finite");
    show("trochoid", &drawing.svg);
    let [[x0, x1], [y0, y1]] = drawing.frame.ranges();
    let across = drawing.frame.width / (x1 - x0);
    let up = drawing.frame.height / (y1 - y0);
    assert!(
        (across / up - 1.0).abs() < 1e-12,
        "a foot is {across} by {up} pixels"
    );
}

#[test]
fn surfaces_are_drawn() {
    show("surface", &surface(61, 61).svg().expect("a grid"));
    let mut table = surface(7, 7);
    table.title = "Influence coefficients of the printed table".into();
    show("table", &table.svg().expect("a grid"));
    show(
        "lines",
        &surface(181, 7)
            .lines()
            .expect("a grid")
            .svg()
            .expect("finite"),
    );
}

#[test]
fn girder_is_drawn() {
    let line: Vec<_> = stations(91).iter().map(|x| [*x, 0.0]).collect();
    let by = line
        .iter()
        .map(|p| {
            [
                0.0,
                -2.4e6 * (influence(p[0], 23.7) + influence(p[0], 26.3)),
            ]
        })
        .collect();
    let plot = GirderPlot {
        title: "Girder with its rail".into(),
        length_unit: "ft".into(),
        members: vec![vec![[-15.0, 0.0], [75.0, 0.0]]],
        rail: vec![[-15.0, 3.66], [75.0, 3.66]],
        supports: vec![
            SupportMark {
                at: [0.0, 0.0],
                is_fixed_lengthwise: true,
            },
            SupportMark {
                at: [60.0, 0.0],
                is_fixed_lengthwise: false,
            },
        ],
        stations: stations(7).iter().map(|x| [*x, 3.66]).collect(),
        loads: vec![[23.7, 3.66], [26.3, 3.66]],
        deflected: Some(Deflected {
            label: "elastic axis under the bogie at 25 ft".into(),
            at: line,
            by,
            factor: None,
        }),
        note:
            "One scale in both directions; displacements exaggerated by the factor in the legend."
                .into(),
    };
    let svg = show("girder", &plot.svg().expect("points are finite"));
    assert!(svg.contains("displacements x 10"), "the factor is stated");
}

/// Three labels at least on every logarithmic axis, in order and within it, whether it spans a fraction of a decade or
/// many decades.
#[test]
fn logarithmic_axes_can_be_read() {
    for (low, high) in [
        (1.3, 2.2),
        (5.6e3, 2.4e4),
        (0.9, 1.1),
        (2e-9, 3e-4),
        (0.5, 60.0),
        (2.1e-3, 0.62),
    ] {
        let ticks = ticks::Ticks::new(
            &scale::AxisScale {
                low,
                high,
                log: true,
            },
            6.0,
        );
        let labels = ticks
            .labels
            .iter()
            .filter(|label| !label.is_empty())
            .count();
        assert!(labels >= 3, "{low} to {high}: {:?}", ticks.labels);
        assert!(ticks.values.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(
            ticks
                .values
                .iter()
                .all(|value| (low..=high).contains(value))
        );
        assert!(ticks.values[0] < 10.0 * low && 10.0 * ticks.values[ticks.values.len() - 1] > high);
    }
}

#[test]
fn logarithmic_errors_are_drawn() {
    let points = |c: f64| {
        (0..6)
            .map(|i| [6.0 * 2f64.powi(i), c * 4f64.powi(-i)])
            .collect()
    };
    let chart = Chart::new(
        "Error against the number of parts",
        ChartAxis::new("parts", "").log(),
        ChartAxis::new("largest error", "ft").log(),
    )
    .with(Series::new("parts", Style::Line, points(0.05)))
    .with(Series::new("at midspan", Style::Points, points(0.003)));
    show("order", &chart.svg().expect("data are positive"));
}

fn plain(points: Vec<[f64; 2]>) -> Chart {
    Chart::new("", ChartAxis::new("x", ""), ChartAxis::new("y", "")).with(Series::new(
        "one",
        Style::Line,
        points,
    ))
}

#[test]
fn nan_and_infinity_are_refused_by_series_and_point() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let chart = plain(vec![[0.0, 1.0]]).with(Series::new(
            "two",
            Style::Points,
            vec![[0.0, 0.0], [1.0, bad]],
        ));
        assert_eq!(
            chart.svg(),
            Err(Error::NotFinite {
                series: 1,
                point: 1
            })
        );
        assert_eq!(
            plain(vec![[bad, 0.0]]).svg(),
            Err(Error::NotFinite {
                series: 0,
                point: 0
            })
        );
        assert_eq!(
            plain(vec![[0.0, 0.0]]).mark(bad, "here").svg(),
            Err(Error::Marker(0))
        );
        let mut grid = surface(3, 3);
        grid.values[1][2] = bad;
        assert_eq!(
            grid.svg(),
            Err(Error::NotFinite {
                series: 1,
                point: 2
            })
        );
    }
}

#[test]
fn unusable_axes_and_empty_charts_are_refused() {
    assert_eq!(plain(vec![]).svg(), Err(Error::NoData));
    let mut chart = plain(vec![[1.0, 0.0], [2.0, 1.0]]);
    chart.y_axis.log = true;
    assert_eq!(
        chart.svg(),
        Err(Error::NotPositive {
            series: 0,
            point: 0
        })
    );
    let mut chart = plain(vec![[1.0, 0.0], [2.0, 1.0]]);
    chart.x_axis.range = Some([2.0, 1.0]);
    assert_eq!(
        chart.svg(),
        Err(Error::Range {
            low: 2.0,
            high: 1.0
        })
    );
    let wide = plain(vec![[0.0, -f64::MAX], [1.0, f64::MAX]]);
    assert_eq!(
        wide.svg(),
        Err(Error::Range {
            low: -f64::MAX,
            high: f64::MAX
        })
    );
    let mut grid = surface(3, 3);
    grid.values[2].pop();
    assert_eq!(
        grid.svg(),
        Err(Error::Shape {
            row: 2,
            columns: 2,
            rows: 3,
            expected: 3
        })
    );
    grid = surface(3, 3);
    grid.loads[1] = grid.loads[0];
    assert_eq!(grid.svg(), Err(Error::Stations(1)));
}

#[test]
fn degenerate_data_are_still_drawn() {
    for points in [
        vec![[0.0, 0.0]],
        vec![[3.0, 5.0], [3.0, 5.0]],
        vec![[0.0, 1e-300], [1.0, 2e-300]],
        vec![[0.0, 1e300], [1.0, 1.0]],
        vec![[0.0, 1e9], [1.0, 1e9 + 1e-3]],
        vec![[-1e-320, 0.0], [0.0, 0.0]],
    ] {
        let svg = plain(points.clone())
            .svg()
            .expect("finite data over a usable range")
            .file();
        roxmltree::Document::parse(&svg).expect("an SVG file is XML");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{points:?}");
    }
}

#[test]
fn thinning_keeps_every_extreme_to_the_last_bit() {
    let value = |i: usize| {
        (i as f64 * 0.37).sin() * (i as f64 * 0.001).cos() + if i == 77_777 { 3.25 } else { 0.0 }
    };
    let points: Vec<[f64; 2]> = (0..200_000).map(|i| [i as f64 * 1e-4, value(i)]).collect();
    let drawing = plain(points.clone()).draw().expect("data are finite");
    let thinned = &drawing.series[0];
    assert!(thinned.len() < 8_000, "{} points drawn", thinned.len());
    let extremes = |p: &[[f64; 2]]| {
        p.iter()
            .fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p[1]), b.max(p[1])))
    };
    assert_eq!(extremes(thinned), extremes(&points));
    assert!(thinned.contains(&points[77_777]), "a single spike is kept");
    assert_eq!(
        (thinned.first(), thinned.last()),
        (points.first(), points.last())
    );
}

#[test]
fn ticks_are_1_2_5_and_never_negative_zero() {
    for (low, high) in [
        (-0.3, 0.3),
        (0.0, 1e6),
        (-1e-9, 1e-9),
        (2.38e6, 2.42e6),
        (-7.0, 1e4),
        (-1.0, 1e-12),
    ] {
        let axis = ChartAxis::new("x", "").range(low, high);
        let scale = scale::AxisScale::new(&axis, std::iter::empty(), true).expect("a usable range");
        let ticks = ticks::Ticks::new(&scale, 8.0);
        let apart = (ticks.values[1] - ticks.values[0]) / 10f64.powi(ticks.exponent);
        let mantissa = apart / 10f64.powf(apart.log10().floor() + 1e-12);
        assert!(
            [1.0, 2.0, 5.0, 10.0]
                .iter()
                .any(|m| (mantissa - m).abs() < 1e-6),
            "{low}..{high}: step {apart}"
        );
        assert!(
            (4..=13).contains(&ticks.values.len()),
            "{low}..{high}: {} ticks",
            ticks.values.len()
        );
        let mut labels = ticks.labels.clone();
        labels.dedup();
        assert_eq!(
            labels.len(),
            ticks.labels.len(),
            "labels differ: {labels:?}"
        );
        for label in &ticks.labels {
            assert!(label.len() <= 8, "{low}..{high}: label {label}");
            let digits = label.strip_prefix('\u{2212}').unwrap_or("1");
            assert!(
                digits.bytes().any(|b| (b'1'..=b'9').contains(&b)),
                "negative zero in {:?}",
                ticks.labels
            );
        }
    }
}

#[test]
fn downward_axis_puts_larger_values_lower() {
    let drawing = trunnion().draw().expect("data are finite");
    let place = |y: f64| drawing.frame.place([30.0, y])[1];
    assert!(place(0.5) > place(0.1));
}

#[test]
fn text_is_escaped() {
    let mut chart = plain(vec![[0.0, 0.0], [1.0, 1.0]]).mark(0.5, "<a href='x'>&");
    chart.title = "<script>alert(\"1\")</script>".into();
    let svg = chart.svg().expect("data are finite").file();
    let parsed = roxmltree::Document::parse(&svg).expect("an SVG file is XML");
    assert!(
        parsed
            .descendants()
            .all(|n| !n.has_tag_name("script") && !n.has_tag_name("a"))
    );
    assert!(
        parsed
            .descendants()
            .any(|n| n.text().is_some_and(|t| t.trim() == chart.title))
    );
}

/// Area of a polygon by the shoelace formula.
fn area(polygon: &[[f64; 2]]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    0.5 * polygon
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum::<f64>()
}

#[test]
fn filled_contours_of_a_plane_have_its_areas() {
    // On the unit square the region x + 2 y >= level has the area 1 - level^2 / 4 for level <= 1.
    let x: Vec<f64> = [0.0, 0.13, 0.4, 0.75, 1.0].into();
    let values: Vec<Vec<f64>> = x
        .iter()
        .map(|y| x.iter().map(|x| x + 2.0 * y).collect())
        .collect();
    for level in [0.0, 0.1, 0.35, 0.999, 1.0] {
        let found = contour::region(&x, &x, &values, level);
        let total: f64 = found.polygons.iter().map(|p| area(p).abs()).sum();
        assert!(
            (total - (1.0 - level * level / 4.0)).abs() < 1e-14,
            "level {level}: area {total}"
        );
        let length: f64 = found
            .chords
            .iter()
            .map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1]))
            .sum();
        assert!(
            (length - level * 1.25f64.sqrt()).abs() < 1e-14,
            "level {level}: length {length}"
        );
    }
}
