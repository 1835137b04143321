//! The simply supported girder with overhangs of McConville's paper, against the digits of its tables and
//! closed forms (analytic).

use crate::common;

use common::near::assert_at_most;
use common::{Stream, paper, probes, with_nodes};
use fea::{grid, surface};
use splines::{Axis, Compliance, Influence, Probe};

const SPAN: f64 = 60.0;

/// Simply supported beam of length l with overhangs, deflection at x per unit load at z, times EI
/// (Timoshenko, Strength of Materials I, section 39; overhangs by the slope at the support).
fn bending(x: f64, z: f64) -> f64 {
    let l = SPAN;
    // Slope at the left and right support per unit load at z.
    let slopes = |z: f64| -> [f64; 2] {
        if z < 0.0 {
            [z * l / 3.0, -z * l / 6.0]
        } else if z > l {
            let a = z - l;
            [-a * l / 6.0, a * l / 3.0]
        } else {
            let b = l - z;
            [z * b * (l + b) / (6.0 * l), -z * b * (l + z) / (6.0 * l)]
        }
    };
    let free = |a: f64, c: f64| {
        let (a, c) = (a.min(c), a.max(c));
        a * a * (3.0 * c - a) / 6.0
    };
    let inside = |x: f64| (0.0..=l).contains(&x);
    if !inside(z) && inside(x) {
        return bending(z, x);
    }
    if x < 0.0 {
        slopes(z)[0] * x + if z < 0.0 { free(-x, -z) } else { 0.0 }
    } else if x > l {
        slopes(z)[1] * (x - l) + if z > l { free(x - l, z - l) } else { 0.0 }
    } else {
        let (a, c) = (x.min(z), x.max(z));
        let b = l - c;
        b * a * (l * l - b * b - a * a) / (6.0 * l)
    }
}

/// Shaft held at both supports, twist at x per unit torque at z, times GJ.
fn torsion(x: f64, z: f64) -> f64 {
    let (a, c) = (x.min(z), x.max(z));
    if c <= 0.0 {
        (-c).max(0.0)
    } else if a >= SPAN {
        a - SPAN
    } else if a >= 0.0 && c <= SPAN {
        a * (SPAN - c) / SPAN
    } else {
        0.0
    }
}

fn vertical(x: f64, z: f64) -> f64 {
    bending(x, z) / (9.528 * 4.32e9)
}

fn lateral(x: f64, z: f64) -> f64 {
    bending(x, z) / (0.874_97 * 4.32e9) + 3.6615 * 3.6615 / (1.661_538e9 * 0.6552) * torsion(x, z)
}

/// The paper's vertical table, in units of 1e-10 ft/lb. Rebuilt from the record of its digits: the closed form
/// truncated to three digits, but (15, 15) and (45, 45), which are printed as 6.15e-8.
const VERTICAL: [[f64; 7]; 7] = [
    [1360., 0., -717., -819., -512., 0., 546.],
    [0., 0., 0., 0., 0., 0., 0.],
    [-717., 0., 615., 751., 478., 0., -512.],
    [-819., 0., 751., 1090., 751., 0., -819.],
    [-512., 0., 478., 751., 615., 0., -717.],
    [0., 0., 0., 0., 0., 0., 0.],
    [546., 0., -512., -819., -717., 0., 1360.],
];

/// One unit of the last of three printed digits of `value`.
fn digit(value: f64) -> f64 {
    if value == 0.0 {
        1e-21
    } else {
        10f64.powf(value.abs().log10().floor() - 2.0)
    }
}

#[test]
fn vertical_table_agrees_with_every_printed_entry() {
    let (model, rail) = paper().model_and_rail().expect("sound");
    let at = probes(Axis::Vertical, &rail.stations);
    let value = grid(&model, &[rail], &at).expect("solvable").value;
    for i in 0..7 {
        for j in 0..7 {
            let printed = VERTICAL[i][j] * 1e-10;
            let error = (value[(i, j)] - printed).abs();
            assert!(
                error <= digit(printed) * (1.0 + 1e-9),
                "({i}, {j}): {} {printed}",
                value[(i, j)]
            );
        }
    }
}

#[test]
fn lateral_table_agrees_with_every_printed_entry() {
    // Rebuilt from the record of the printed digits: all are the truncated closed form with 1/EI = 2.6456e-10 and h^2/GJ = 1.2315e-8.
    let (model, rail) = paper().model_and_rail().expect("sound");
    let stations = rail.stations.clone();
    let value = grid(&model, &[rail], &probes(Axis::Lateral, &stations))
        .expect("solvable")
        .value;
    for (i, &x) in stations.iter().enumerate() {
        for (j, &z) in stations.iter().enumerate() {
            let exact = 2.6456e-10 * bending(x, z) + 1.2315e-8 * torsion(x, z);
            let unit = digit(exact);
            let printed = (exact / unit * (1.0 + 1e-12)).trunc() * unit;
            let error = (value[(i, j)] - printed).abs();
            assert!(
                error <= unit * (1.0 + 1e-9),
                "({i}, {j}): {} {printed}",
                value[(i, j)]
            );
        }
    }
}

#[test]
fn grids_agree_with_closed_forms_to_1e_13() {
    let (model, rail) = paper().model_and_rail().expect("sound");
    let stations: Vec<f64> = (0..61).map(|k| -15.0 + 1.5 * f64::from(k)).collect();
    let rails = [rail];
    for (axis, exact) in [
        (Axis::Vertical, vertical as fn(f64, f64) -> f64),
        (Axis::Lateral, lateral),
    ] {
        let value = grid(&model, &rails, &probes(axis, &stations))
            .expect("solvable")
            .value;
        let largest = value.amax();
        let mut worst = 0.0_f64;
        for (i, &x) in stations.iter().enumerate() {
            for (j, &z) in stations.iter().enumerate() {
                worst = worst.max((value[(i, j)] - exact(x, z)).abs() / largest);
            }
        }
        assert!(worst < 1e-13, "{axis:?}: {worst:.1e}");
    }
}

/// Nodes at every station, as a mesh has them: more of them cost digits where lengths are no sums of halves.
#[test]
fn nodes_at_every_station_cost_no_more_digits_than_known() {
    let (model, _) = paper().model_and_rail().expect("sound");
    for (count, known) in [
        (7, 1.8e-15),
        (13, 2.9e-14),
        (19, 2e-13),
        (37, 4.6e-12),
        (73, 6.2e-12),
    ] {
        let stations: Vec<f64> = (0..count)
            .map(|k| -15.0 + 90.0 * f64::from(k) / f64::from(count - 1))
            .collect();
        let mut places = Vec::new();
        let mut inside = Vec::new();
        for (m, member) in model.members.iter().enumerate() {
            let ends = member.points.map(|point| model.points[point][0]);
            for x in stations
                .iter()
                .filter(|x| **x > ends[0] + 1e-9 && **x < ends[1] - 1e-9)
            {
                places.push((m, (x - ends[0]) / (ends[1] - ends[0]), [0.0; 3]));
                inside.push(*x);
            }
        }
        let (cut, nodes) = with_nodes(&model, &places);
        let (c, _) = fea::point_compliance(&cut, &nodes).expect("it stands");
        let mut worst = 0.0_f64;
        for (i, &x) in inside.iter().enumerate() {
            for (j, &z) in inside.iter().enumerate() {
                worst = worst.max((c[(6 * i + 1, 6 * j + 1)] - vertical(x, z)).abs());
            }
        }
        let found = worst / vertical(-15.0, -15.0);
        let what = format!("frame with nodes at {count} stations: largest error / largest value");
        assert_at_most(what, "prototype", known, found);
    }
}

#[test]
fn surface_agrees_with_closed_forms_at_ten_thousand_pairs() {
    let (model, rail) = paper().model_and_rail().expect("sound");
    let exact = surface(&model, &[rail]).expect("solvable");
    let mut stream = Stream::new(1);
    for (axis, form) in [
        (Axis::Vertical, vertical as fn(f64, f64) -> f64),
        (Axis::Lateral, lateral),
    ] {
        let largest = form(-15.0, -15.0);
        let mut worst = 0.0_f64;
        for _ in 0..10_000 {
            let (x, z) = (stream.between(-15.0, 75.0), stream.between(-15.0, 75.0));
            let mut out = Influence::zeros(2);
            let at = [x, z].map(|x| Probe { rail: 0, x, axis });
            exact.surface.fill(&at, &mut out).expect("on the rail");
            worst = worst.max((out.value[(0, 1)] - form(x, z)).abs() / largest);
        }
        assert!(worst < 1e-13, "{axis:?}: {worst:.1e}");
    }
}

#[test]
fn grid_agrees_with_published_values_between_stations() {
    // Independently computed values of the same beam (external).
    let (model, rail) = paper().model_and_rail().expect("sound");
    let rails = [rail];
    for (x, z, value) in [
        (7.5, 22.5, 4.057_052_787_398_543_4e-8),
        (23.5, 23.5, 9.930_324_788_073_188e-8),
        (11.0, 52.3, 1.954_720_612_552_384e-8),
        (-7.0, 33.0, -3.661_904_387_069_692_6e-8),
        (31.0, 44.0, 7.976_598_321_429_928e-8),
    ] {
        let found = grid(&model, &rails, &probes(Axis::Vertical, &[x, z]))
            .expect("solvable")
            .value[(0, 1)];
        assert!(
            (found - value).abs() < 1e-13 * 1.37e-7,
            "G({x}, {z}) = {found}"
        );
    }
}

#[test]
fn longitudinal_load_at_the_rail_bends_the_girder() {
    // A force along the rail is a moment h about the elastic axis: u = x/EA + h^2 times the slope per
    // moment, which is d2 g/(dx dz) of the bending form (analytic: (l^2 - 3 x l + 3 x^2)/(3 l) at x = z).
    let (model, rail) = paper().model_and_rail().expect("sound");
    let x = 22.0;
    let found = grid(&model, &[rail], &probes(Axis::Longitudinal, &[x]))
        .expect("solvable")
        .value[(0, 0)];
    let slope = (SPAN * SPAN - 3.0 * x * SPAN + 3.0 * x * x) / (3.0 * SPAN * 9.528 * 4.32e9);
    let exact = x / 4.32e9 + 3.6615 * 3.6615 * slope;
    assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
}
