//! A bridge crane of 11 freedoms beside the same one written out by hand in another language, and beside other steppers.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::crane::{body, mount};
use common::kutta::Kernel;
use common::near::{assert_at_most, assert_near};
use nalgebra::DMatrix;
use serde_json::Value;
use sim::{
    Actuators, Analysis, BodyDof, Brake, Channel, Contact, Damper, Drive, Extent, Flange,
    Foundation, Friction, FrictionLaw, NormalLaw, Rope, RopeEnd, Run, Scene, Schedule, Status,
    Wheel,
};
use splines::{Axis, Probe};

/// External: `fea/crane_reference.py`, whose scene this is.
const REFERENCE: &str = include_str!("../../../../fea/reference/crane.json");

const G: f64 = 32.174;
const E: f64 = 4.176e9;
const SPAN: f64 = 75.0;
const RADIUS: f64 = 1.25;
const COLUMNS: [f64; 6] = [0.0, 45.0, 90.0, 150.0, 195.0, 240.0];
/// Deflections and slopes over the columns.
const STATES: usize = 12;

/// A continuous girder on columns: compliance of deflection and slope over them.
struct Runway {
    bending: f64,
    compliance: DMatrix<f64>,
}

impl Runway {
    fn new(bending: f64, column: f64) -> Runway {
        let mut stiffness = DMatrix::zeros(STATES, STATES);
        for (e, ends) in COLUMNS.windows(2).enumerate() {
            let l = ends[1] - ends[0];
            let (a, b, c) = (6.0 * l, 4.0 * l * l, 2.0 * l * l);
            let cell = [
                [12.0, a, -12.0, a],
                [a, b, -a, c],
                [-12.0, -a, 12.0, -a],
                [a, c, -a, b],
            ];
            for (i, row) in cell.iter().enumerate() {
                for (j, entry) in row.iter().enumerate() {
                    stiffness[(2 * e + i, 2 * e + j)] += bending / l.powi(3) * entry;
                }
            }
        }
        for i in 0..COLUMNS.len() {
            stiffness[(2 * i, 2 * i)] += column;
        }
        let compliance = stiffness.try_inverse().expect("columns hold it");
        Runway {
            bending,
            compliance,
        }
    }

    /// The cell of x, its cubic shapes and their slopes.
    fn shapes(x: f64) -> (usize, [f64; 4], [f64; 4]) {
        let e = COLUMNS[1..5].iter().take_while(|end| x > **end).count();
        let h = COLUMNS[e + 1] - COLUMNS[e];
        let s = (x - COLUMNS[e]) / h;
        let (s2, s3) = (s * s, s * s * s);
        (
            e,
            [
                1.0 - 3.0 * s2 + 2.0 * s3,
                h * (s - 2.0 * s2 + s3),
                3.0 * s2 - 2.0 * s3,
                h * (s3 - s2),
            ],
            [
                6.0 * (s2 - s) / h,
                1.0 - 4.0 * s + 3.0 * s2,
                6.0 * (s - s2) / h,
                3.0 * s2 - 2.0 * s,
            ],
        )
    }

    /// G(x, z) and dG/dx.
    fn give(&self, x: f64, z: f64) -> [f64; 2] {
        let ((e, value, slope), (f, other, _)) = (Runway::shapes(x), Runway::shapes(z));
        let mut out = [0.0; 2];
        for (j, other) in other.iter().enumerate() {
            let column = |i: usize| self.compliance[(2 * e + i, 2 * f + j)] * other;
            out[0] += (0..4).map(|i| value[i] * column(i)).sum::<f64>();
            out[1] += (0..4).map(|i| slope[i] * column(i)).sum::<f64>();
        }
        if e == f {
            let l = COLUMNS[e + 1] - COLUMNS[e];
            let own = clamped(x - COLUMNS[e], z - COLUMNS[e], l);
            out[0] += own[0] / self.bending;
            out[1] += own[1] / self.bending;
        }
        out
    }
}

/// EI times deflection at x under a unit load at z of a beam clamped at both ends, and its slope at x.
///
/// # Source
/// R. J. Roark, Formulas for Stress and Strain, clamped beam under a concentrated load.
fn clamped(x: f64, z: f64, l: f64) -> [f64; 2] {
    // Analytic: from the left R x^3 / 6 - M x^2 / 2 up to the load; from the right the same mirrored.
    let left = |x: f64, z: f64| {
        let b = l - z;
        let reaction = b * b * (3.0 * z + b) / l.powi(3);
        let moment = z * b * b / (l * l);
        [
            0.5 * moment * x * x - reaction * x.powi(3) / 6.0,
            moment * x - 0.5 * reaction * x * x,
        ]
    };
    if x <= z {
        left(x, z)
    } else {
        let [value, slope] = left(l - x, l - z);
        [value, -slope]
    }
}

/// EI times deflection at x of a simply supported beam from 0 to `SPAN` under a unit load at z, and its slope.
fn simple(x: f64, z: f64) -> [f64; 2] {
    let left = |x: f64, z: f64| {
        let b = SPAN - z;
        let core = SPAN * SPAN - b * b;
        [
            b * x * (core - x * x) / (6.0 * SPAN),
            b * (core - 3.0 * x * x) / (6.0 * SPAN),
        ]
    };
    if x <= z {
        left(x, z)
    } else {
        let [value, slope] = left(SPAN - x, SPAN - z);
        [value, -slope]
    }
}

/// Both rails of the runway, which give upwards and sideways, each on its own.
fn aisle() -> Foundation {
    let (vertical, lateral) = (
        Runway::new(14.0 * E, 4e7),
        Runway::new(14.0 * E / 12.0, 5e6),
    );
    let give = move |p: Probe, q: Probe| match (p.rail == q.rail, p.axis, q.axis) {
        (true, Axis::Vertical, Axis::Vertical) => vertical.give(p.x, q.x),
        (true, Axis::Lateral, Axis::Lateral) => lateral.give(p.x, q.x),
        _ => [0.0; 2],
    };
    let rail = || Extent {
        range: Some([0.0, 240.0]),
        breaks: COLUMNS.to_vec(),
    };
    Foundation {
        rails: vec![rail(), rail()],
        ..Foundation::massless(Box::new(Kernel(give)), 2)
    }
}

/// Both girders of the bridge, on body 0: simply supported, x from midspan.
fn girders() -> Foundation {
    let give = |p: Probe, q: Probe| {
        if p.rail == q.rail && p.axis == Axis::Vertical && q.axis == Axis::Vertical {
            simple(p.x + 0.5 * SPAN, q.x + 0.5 * SPAN).map(|own| own / (20.0 * E))
        } else {
            [0.0; 2]
        }
    };
    let rail = || Extent {
        range: Some([-0.5 * SPAN, 0.5 * SPAN]),
        breaks: Vec::new(),
    };
    let foundation = Foundation::massless(Box::new(Kernel(give)), 2);
    let on = mount([0.0, 0.0, 1.0], [0.0, 5.0, 0.0]);
    Foundation {
        rails: vec![rail(), rail()],
        carrier: Some(on),
        ..foundation
    }
}

fn wheel(damping: f64, is_guided: bool) -> Wheel {
    let flange = Flange {
        stiffness: 1e8,
        clearance: 0.0,
        release: None,
    };
    Wheel {
        radius: RADIUS,
        normal: NormalLaw::linear(1e8, damping, Damper::Ground),
        flange: is_guided.then_some(flange),
        friction: Some(Friction {
            law: FrictionLaw::Coulomb,
            coefficient: 0.2,
            slip: 0.02,
        }),
        spin_inertia: None,
    }
}

fn scene(accuracy: f64) -> Scene {
    let [bridge, trolley, ladle] = [750e3, 450e3, 1020e3].map(|weight| weight / G);
    use BodyDof::{Pitch, Roll, X, Y, Z};
    let about = [bridge * SPAN * SPAN / 12.0, 1.0, bridge * 1600.0 / 12.0];
    let own = [trolley * 400.0 / 12.0, 1.0, trolley * 144.0 / 12.0];
    let mut bodies = vec![
        body(bridge, about, &[X, Y, Z, Roll, Pitch]),
        body(trolley, own, &[X, Y, Pitch]),
        body(ladle, [0.0; 3], &[X, Y, Z]),
    ];
    (bodies[0].start[0], bodies[0].start_speed[0]) = (65.0, 5.0);
    bodies[1].start[0] = -12.0;
    (bodies[2].start, bodies[2].start_speed[0]) = ([65.0, -35.0, -12.0, 0.0, 0.0, 0.0], 5.0);
    let half = 0.5 * SPAN;
    // North front, north rear, south front, south rear; the trolley's four.
    let corners = [(15.0, half), (-15.0, half), (15.0, -half), (-15.0, -half)];
    let trucks = corners.map(|(x, z)| Contact {
        body: 0,
        structure: 0,
        rail: usize::from(z < 0.0),
        at: [x, RADIUS, z],
        offsets: vec![-7.5, -2.5, 2.5, 7.5],
        wheel: 0,
    });
    let axles = [(6.0, 6.0), (-6.0, 6.0), (6.0, -6.0), (-6.0, -6.0)].map(|(x, z)| Contact {
        body: 1,
        structure: 1,
        rail: usize::from(z > 0.0),
        at: [x, RADIUS, z],
        offsets: vec![0.0],
        wheel: 1,
    });
    let schedule = |table: &[[f64; 2]]| Schedule::new(table).expect("increasing times");
    let drive = |body: usize, speed: Schedule, gain: f64, until: f64| Drive {
        body,
        speed,
        gain,
        max_force: f64::INFINITY,
        contacts: (4 * body..4 * body + 4).collect(),
        until,
    };
    let brake = |body: usize, from: f64| Brake {
        body,
        from,
        speed: 0.02,
        contacts: (4 * body..4 * body + 4).collect(),
    };
    let end = |body: usize| RopeEnd {
        body: Some(body),
        at: [0.0; 3],
    };
    let (bridge_brake, trolley_brake) = (12.3457, 6.0137);
    Scene {
        gravity: G,
        bodies,
        wheels: vec![wheel(1e5, true), wheel(1e5, false)],
        contacts: [trucks, axles].concat(),
        gauges: Vec::new(),
        actuators: Actuators {
            drives: vec![
                drive(0, schedule(&[[0.0, 5.0]]), 2e5, bridge_brake),
                drive(
                    1,
                    schedule(&[[0.0, 0.0], [2.0, 10.0 / 3.0]]),
                    1e5,
                    trolley_brake,
                ),
            ],
            brakes: vec![brake(0, bridge_brake), brake(1, trolley_brake)],
            ropes: vec![Rope {
                from: end(1),
                to: end(2),
                stiffness: 7e6 * 40.0,
                damping: 0.04 * (7e6 * ladle).sqrt(),
                length: 40.0,
                speed: schedule(&[[0.0, 0.0]]),
            }],
            hanging: vec![2],
            ..Actuators::default()
        },
        analysis: Analysis::Dynamic,
        end: 22.0,
        output_dt: 0.1,
        output_parts: 1,
        accuracy,
    }
}

fn run(accuracy: f64) -> Run {
    let run = sim::run(&scene(accuracy), &[aisle(), girders()], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

fn column(json: &Value, name: &str) -> Vec<f64> {
    let values = json[name].as_array().map(Vec::as_slice).unwrap_or_default();
    values.iter().filter_map(Value::as_f64).collect()
}

/// Largest difference by the largest value.
fn apart(found: &[f64], wanted: &[f64]) -> f64 {
    assert_eq!(found.len(), wanted.len());
    let size = wanted
        .iter()
        .fold(0.0, |most, own| f64::max(most, own.abs()));
    found
        .iter()
        .zip(wanted)
        .fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
        / size
}

/// Force of the northern wheels.
fn north(run: &Run) -> Vec<f64> {
    let wheels: Vec<Vec<f64>> = (0..8)
        .map(|w| run.history.column(Channel::Vertical(w)))
        .collect();
    (0..run.history.len())
        .map(|k| wheels.iter().map(|wheel| wheel[k]).sum())
        .collect()
}

/// External: all freedoms and the wheels' forces, DOP853 at 1e-12 on equations of another make.
#[test]
fn the_crane_moves_as_one_written_out_by_hand() {
    let json: Value = serde_json::from_str(REFERENCE).expect("the file is JSON");
    let program = "scipy, fea/crane_reference.py";
    let wanted = column(&json, "north");
    for accuracy in [1e-3, 1e-4, 1e-5, 1e-6] {
        let run = run(accuracy);
        let found = north(&run);
        let error = apart(&found, &wanted);
        println!(
            "accuracy {accuracy:e}: {error:.1e}, {:?}, {:?}",
            run.counts,
            run.audit.residual()
        );
        assert!(error < 0.5 * accuracy, "{accuracy:e}: {error:e}");
        let columns = [
            ("X", 0, BodyDof::X),
            ("Y", 0, BodyDof::Y),
            ("Z", 0, BodyDof::Z),
            ("roll", 0, BodyDof::Roll),
            ("pitch", 0, BodyDof::Pitch),
            ("s", 1, BodyDof::X),
            ("y", 1, BodyDof::Y),
            ("nod", 1, BodyDof::Pitch),
            ("x_ladle", 2, BodyDof::X),
            ("y_ladle", 2, BodyDof::Y),
            ("z_ladle", 2, BodyDof::Z),
        ];
        for (name, body, freedom) in columns {
            let own = apart(
                &run.history.column(Channel::Displacement(body, freedom)),
                &column(&json, name),
            );
            // Z swings undamped at 2 Hz: its phase errs most.
            assert!(own < 20.0 * accuracy, "{accuracy:e}, {name}: {own:e}");
        }
        if accuracy == 1e-6 {
            let of = |what: &str, pick: fn(&[f64]) -> f64| {
                let what = format!("northern wheels, {what}, lb");
                assert_near(what, program, pick(&wanted), pick(&found), 1e-6);
            };
            of("at the start", |force| force[0]);
            of("largest", |force| force.iter().copied().fold(0.0, f64::max));
            of("least", |force| {
                force.iter().copied().fold(f64::INFINITY, f64::min)
            });
            of("at the end", |force| force[force.len() - 1]);
        }
        if accuracy == 1e-5 {
            let what = |of: &str| format!("simulator, accuracy 1e-5: {of}");
            assert_at_most(
                what("error of the northern wheels (Radau 5, 1e-4)"),
                "prototype",
                5.6e-6,
                error,
            );
            let stages = run.counts.stages as f64;
            assert_at_most(
                what("stages (rates of LSODA, 1e-6)"),
                "prototype",
                28_426.0,
                stages,
            );
        }
    }
}

/// External: what scipy's steppers err by and ask for on the same equations, as kept beside the reference.
#[test]
fn other_steppers_ask_for_more() {
    let json: Value = serde_json::from_str(REFERENCE).expect("the file is JSON");
    assert!(
        json["radau_apart"]
            .as_f64()
            .is_some_and(|apart| apart < 1e-9),
        "the reference has converged"
    );
    // First the prototype's error and rates, then ours. The masses, spans and laws of the prototype's scene are published;
    // its inertias, gains, brake times and the trolley's motion are not. They are those of fea/crane_reference.py, which ran
    // the steppers.
    for (index, name, known, own) in [
        (
            0,
            "Radau 5 of scipy, rtol 1e-4",
            [5.6e-6, 3959.0],
            [1.68e-5, 9344.0],
        ),
        (
            1,
            "Radau 5 of scipy, rtol 1e-6",
            [3.8e-8, 13_002.0],
            [6.91e-8, 26_454.0],
        ),
        (
            2,
            "BDF of scipy, rtol 1e-4",
            [1.8e-4, 11_582.0],
            [3.49e-4, 11_806.0],
        ),
        (
            3,
            "LSODA of scipy, rtol 1e-6",
            [4.9e-7, 28_426.0],
            [2.78e-6, 27_118.0],
        ),
        (
            4,
            "RK45 of scipy, rtol 1e-5",
            [4.2e-6, 23_854.0],
            [1.65e-4, 50_834.0],
        ),
        (
            5,
            "DOP853 of scipy, rtol 1e-6",
            [8.7e-7, 33_751.0],
            [2.43e-6, 72_290.0],
        ),
        (
            6,
            "generalised-alpha 0.8, 10 ms",
            [1.5e-2, 7293.0],
            [6.08e-3, 14_891.0],
        ),
    ] {
        let found =
            ["error", "rates"].map(|key| json["steppers"][index][key].as_f64().unwrap_or(f64::NAN));
        for (k, what) in ["error of the northern wheels", "rates asked for"]
            .iter()
            .enumerate()
        {
            let what = format!("{name}: {what}");
            if (found[k] / known[k] - 1.0).abs() < 0.06 {
                assert_near(what, "prototype", known[k], found[k], 0.06);
            } else {
                assert_near(what, "regression", own[k], found[k], 5e-3);
            }
        }
    }
}
