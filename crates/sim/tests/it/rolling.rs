//! The force along the rail, scenes that cannot stand, and scenes nobody would draw.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::hinged::Hinged;
use common::near::assert_near;
use common::{SPAN, bogie, girder, give};
use nalgebra::DMatrix;
use sim::{
    Analysis, BodyDof, Channel, Damper, Error, Flange, Foundation, Friction, FrictionLaw, Method,
    Run, Scene, Status, Stop,
};
use splines::{
    Axis, Compliance, Influence, InfluenceBlock, Probe, ReadingMethod, SplineTable, TableReading,
};

fn run(scene: &Scene, foundation: Foundation) -> Result<Run, Error> {
    sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(()))
}

/// The bogie without dampers, free to roll from rest at 15 ft.
fn rolling(end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Ground);
    scene.wheels[0].normal.damping = 0.0;
    let body = &mut scene.bodies[0];
    body.motion = None;
    body.free[0] = true;
    body.start[0] = 15.0;
    scene.accuracy = 1e-8;
    scene
}

#[test]
fn freely_rolling_bogie_keeps_its_energy_on_the_exact_surface_and_not_on_akispl() {
    let stations: Vec<f64> = (0..7).map(|i| 15.0 * f64::from(i) - 15.0).collect();
    let values = DMatrix::from_fn(7, 7, |i, j| give(stations[i], stations[j]).0);
    let table = SplineTable::new(stations.clone(), stations, values).expect("stations increase");
    let way = (0, Axis::Vertical);
    let reading = TableReading::new(
        ReadingMethod::Akispl,
        &[InfluenceBlock {
            deflection: way,
            load: way,
            table,
        }],
    )
    .expect("a table");
    let exact = run(&rolling(20.0), girder()).expect("valid");
    let mut coarse = rolling(20.0);
    coarse.accuracy = 1e-6;
    let akispl = run(&coarse, Foundation::massless(Box::new(reading), 1)).expect("valid");
    println!(
        "imbalance: exact {:.3e} of {:.3e}",
        exact.audit.imbalance, exact.audit.peak_stored
    );
    println!(
        "imbalance: AKISPL {:.3e}, {:?}",
        akispl.audit.imbalance, akispl.status
    );
    assert_eq!(exact.status, Status::Done);
    let x = exact.history.column(Channel::Displacement(0, BodyDof::X));
    assert!(
        x.iter().any(|&x| x > 0.5 * SPAN),
        "it rolls through the sag"
    );
    assert!(exact.audit.residual() < 1e-6, "{}", exact.audit.residual());
    assert!(akispl.audit.imbalance > 1e3 * exact.audit.imbalance);
}

#[test]
fn freely_rolling_bogie_crosses_hinges_at_order_four_and_keeps_its_energy() {
    let at = |accuracy: f64| {
        let mut scene = rolling(6.0);
        scene.bodies[0].start_speed[0] = 5.0;
        scene.accuracy = accuracy;
        let run = run(&scene, Foundation::massless(Box::new(Hinged), 1)).expect("valid");
        assert_eq!(run.status, Status::Done);
        let end = [BodyDof::X, BodyDof::Y, BodyDof::Pitch].map(|freedom| {
            let column = run.history.column(Channel::Displacement(0, freedom));
            column[column.len() - 1]
        });
        (end, run.counts, run.audit.residual())
    };
    let (exact, _, residual) = at(1e-11);
    assert!(
        exact[0] > 40.0,
        "both wheels have passed three hinges: {}",
        exact[0]
    );
    assert!(residual < 1e-8, "{residual}");
    // The error against the steps taken, from the coarsest to the finest.
    let pairs = [1e-3, 1e-5, 1e-7].map(|accuracy| {
        let (end, counts, residual) = at(accuracy);
        let error = (0..3)
            .map(|i| (end[i] - exact[i]).abs())
            .fold(0.0_f64, f64::max);
        println!("accuracy {accuracy:.0e}: {error:.2e} ft, {counts:?}, audit {residual:.1e}");
        (error, counts.steps as f64)
    });
    let order = (pairs[0].0 / pairs[2].0).ln() / (pairs[2].1 / pairs[0].1).ln();
    println!("order {order:.2}, audit {residual:.1e} at 1e-11");
    assert!(order > 3.5, "{order}");
}

/// A give that is the same everywhere and not symmetric, as tables read by AKISPL are.
struct Skew;

const SKEW: [[f64; 2]; 2] = [[2e-8, 1.2e-8], [0.3e-8, 1e-8]];

impl Compliance for Skew {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), splines::Error> {
        out.slope.fill(0.0);
        out.value = DMatrix::from_fn(at.len(), at.len(), |i, j| SKEW[i][j]);
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        None
    }

    fn is_symmetric(&self) -> bool {
        false
    }
}

#[test]
fn forces_on_a_table_that_is_not_symmetric_use_all_of_it() {
    let mut scene = bogie(5.0, 1.0, Damper::Rail);
    let body = &mut scene.bodies[0];
    body.free = [false; 6];
    body.start = [0.0, -0.1, 0.0, 0.0, 0.0, 0.03];
    // Analytic: (I/k + G) F = e, by Cramer's rule; the dampers of k/c = 1000/s have come to rest.
    let e = [-4.0 / 3.0, 4.0 / 3.0].map(|x: f64| 0.1 - 0.03 * x);
    let [[a, b], [c, d]] = [
        [SKEW[0][0] + 1e-8, SKEW[0][1]],
        [SKEW[1][0], SKEW[1][1] + 1e-8],
    ];
    let wanted = [
        (d * e[0] - b * e[1]) / (a * d - b * c),
        (a * e[1] - c * e[0]) / (a * d - b * c),
    ];
    for analysis in [Analysis::Dynamic, Analysis::QuasiStatic] {
        scene.analysis = analysis;
        let run = run(&scene, Foundation::massless(Box::new(Skew), 1)).expect("valid");
        for (wheel, wanted) in wanted.into_iter().enumerate() {
            let force = run.history.column(Channel::Vertical(wheel));
            let last = force[force.len() - 1];
            assert!(
                (last / wanted - 1.0).abs() < 1e-12,
                "{analysis:?}: {last} for {wanted}"
            );
        }
    }
}

#[test]
fn force_along_the_rail_is_the_slope_of_the_potential() {
    let mut scene = bogie(5.0, 12.0, Damper::Rail);
    scene.wheels[0].normal.damping = 0.0;
    scene.analysis = Analysis::QuasiStatic;
    scene.output_dt = 2e-3;
    let run = run(&scene, girder()).expect("valid");
    let [x, y, drive] = [
        Channel::Displacement(0, BodyDof::X),
        Channel::Displacement(0, BodyDof::Y),
        Channel::Drive(0),
    ]
    .map(|channel| run.history.column(channel));
    // Identity: V = W y / 2 at rest for linear springs, hence drive = dV/dx.
    for i in (500..5500).step_by(250) {
        let slope = 0.5 * common::WEIGHT * (y[i + 1] - y[i - 1]) / (x[i + 1] - x[i - 1]);
        assert!(
            (drive[i] - slope).abs() < 2.0,
            "at {}: {} for {slope}",
            x[i],
            drive[i]
        );
    }
}

#[test]
fn largest_force_along_the_rail_of_one_wheel_meets_its_closed_form() {
    let mut scene = bogie(5.0, 12.0, Damper::Rail);
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    scene.bodies[0].free[5] = false;
    scene.analysis = Analysis::QuasiStatic;
    scene.output_dt = 1e-3;
    let run = run(&scene, girder()).expect("valid");
    let [x, drive] = [Channel::Displacement(0, BodyDof::X), Channel::Drive(0)]
        .map(|channel| run.history.column(channel));
    let downhill = (0..x.len())
        .min_by(|&i, &j| drive[i].total_cmp(&drive[j]))
        .expect("samples");
    println!("{:.1} lb at {:.3} ft", drive[downhill], x[downhill]);
    // Analytic: G(x, x) = x^2 (L - x)^2 / (3 EI L), H = P^2/2 dG/dx, largest at L (1/2 - 1/sqrt(12)).
    let at = SPAN * (0.5 - 1.0 / 12.0_f64.sqrt());
    let slope = 2.0 * at * (SPAN - at) * (SPAN - 2.0 * at) / (3.0 * common::EI * SPAN);
    let wanted = 0.5 * common::WEIGHT.powi(2) * slope;
    assert!((drive[downhill] + wanted).abs() < 1.0 && (x[downhill] - at).abs() < 0.01);
    assert_near(
        "largest force along the rail of one wheel of 4.8e6 lb, lb",
        "closed form",
        64_635.0,
        -drive[downhill],
        1e-4,
    );
    assert_near("where, ft", "closed form", 12.68, x[downhill], 1e-3);
    assert_near(
        "that force by the weight",
        "closed form",
        0.0135,
        -drive[downhill] / common::WEIGHT,
        0.005,
    );
    let sag = common::WEIGHT * common::give(30.0, 30.0).0;
    assert_near(
        "that share by sag / span",
        "closed form",
        1.54,
        -drive[downhill] / common::WEIGHT / (sag / SPAN),
        0.005,
    );
    // from the support to midspan, where the drive holds it back
    let way = x.iter().zip(&drive).filter(|(x, _)| **x <= 30.0);
    let way: Vec<(f64, f64)> = way.map(|(x, drive)| (*x, -drive)).collect();
    let work: f64 = way
        .windows(2)
        .map(|own| 0.5 * (own[0].1 + own[1].1) * (own[1].0 - own[0].0))
        .sum();
    let (sunk, all) = (0.5 * common::WEIGHT * sag, 0.5 * common::WEIGHT * 0.54709);
    // The prototype has 1.31e6. That is 1/2 P times the bogie's 0.547 ft, which contains the 0.024 ft by which its wheels
    // deflect everywhere. The girder alone sags by 0.5248 ft under one wheel, and the force along the rail does that work in
    // a run.
    assert_near(
        "work of the weight from support to midspan, 1/2 P sag, ft lb",
        "regression",
        sunk,
        work,
        1e-4,
    );
    assert!((all / 1.31e6 - 1.0).abs() < 5e-3, "{all}");
}

#[test]
fn body_that_overhangs_its_wheels_has_no_equilibrium() {
    let mut scene = bogie(5.0, 1.0, Damper::Ground);
    scene.bodies[0].cg = [5.0, 0.0, 0.0];
    for analysis in [Analysis::Dynamic, Analysis::QuasiStatic] {
        scene.analysis = analysis;
        let Some(Error::NoEquilibrium {
            fall: Some(fall), ..
        }) = run(&scene, girder()).err()
        else {
            panic!("it stands")
        };
        // its front sinks
        assert!(fall.body == 0 && fall.motion[5] < 0.0, "{fall:?}");
    }
}

/// A point mass 4 ft above its origin: x and pitch move it alike, m and 4 m, 4 m and 16 m. Height alone does not.
#[test]
fn freedoms_that_move_nothing_of_their_own_are_refused_by_name() {
    let mut scene = rolling(1.0);
    scene.bodies[0].inertia = [0.0; 3];
    scene.bodies[0].cg = [0.0, 4.0, 0.0];
    let refused = |freedom| {
        Some(Error::NoInertia {
            body: 0,
            dof: freedom,
        })
    };
    assert_eq!(run(&scene, girder()).err(), refused(BodyDof::Pitch));
    scene.bodies[0].free[0] = false;
    assert_eq!(
        run(&scene, girder()).map(|run| run.status),
        Ok(Status::Done)
    );
    scene.bodies[0].cg = [0.0; 3];
    assert_eq!(run(&scene, girder()).err(), refused(BodyDof::Pitch));
}

#[test]
fn middle_wheel_hangs_free_over_a_sag_and_the_others_carry() {
    // A long rigid body on three wheels over midspan: the sagging rail leaves the middle wheel.
    let mut scene = bogie(5.0, 12.0, Damper::Rail);
    scene.contacts.push(scene.contacts[0].clone());
    for (contact, x) in scene.contacts.iter_mut().zip([-25.0, 0.0, 25.0]) {
        contact.offsets = vec![x];
    }
    scene.analysis = Analysis::QuasiStatic;
    scene.output_dt = 0.06;
    let mut standing = scene.clone();
    standing.bodies[0].motion = Some(
        sim::Profile::new(sim::MotionKind::Position, &[[0.0, 30.0]], 0.0, 0.0).expect("a table"),
    );
    let run = run(&standing, girder()).expect("valid");
    let [rear, middle, front] = [0, 1, 2].map(|w| run.history.column(Channel::Vertical(w))[0]);
    assert_eq!(middle, 0.0);
    assert!((rear - 2.4e6).abs() < 1e-3 && (front - 2.4e6).abs() < 1e-3);
}

#[test]
fn wheel_that_runs_off_the_rail_ends_the_run_and_leaves_its_history() {
    let mut scene = bogie(50.0, 2.0, Damper::Rail);
    scene.output_dt = 0.01;
    for analysis in [Analysis::Dynamic, Analysis::QuasiStatic] {
        scene.analysis = analysis;
        let run = run(&scene, girder_with_ends()).expect("valid at its start");
        let Status::Failed(time, _) = run.status else {
            panic!("{:?}", run.status)
        };
        // The front wheel, 4/3 ft ahead, meets the end at 75 ft after 1.4733 s; the sweep stops at its next sample.
        println!("refused at {time}");
        assert!(time > 1.3 && time <= 1.4801, "{time}");
        assert!(run.history.len() > 130);
        assert!(
            (0..run.history.len()).all(|i| run.history.sample(i).iter().all(|v| v.is_finite()))
        );
    }
}

fn girder_with_ends() -> Foundation {
    Foundation::massless(Box::new(common::surface()), 1)
}

#[test]
fn random_scenes_neither_panic_nor_give_what_is_not_a_number() {
    let mut numbers = fastrand::Rng::with_seed(1);
    let mut random = move || numbers.f64();
    let mut ended = [0; 4];
    for _ in 0..200 {
        let damper = if random() < 0.5 {
            Damper::Rail
        } else {
            Damper::Ground
        };
        let mut scene = bogie(120.0 * random() - 20.0, 0.1 + 0.2 * random(), damper);
        scene.accuracy = 10_f64.powf(-1.0 - 4.0 * random());
        scene.output_dt = 0.01;
        let wheel = &mut scene.wheels[0];
        wheel.normal.stiffness = 10_f64.powf(5.0 + 4.0 * random());
        wheel.normal.exponent = if random() < 0.5 { 1.0 } else { 1.0 + random() };
        wheel.normal.damping = if random() < 0.3 {
            0.0
        } else {
            10_f64.powf(6.0 * random())
        };
        wheel.normal.depth = if random() < 0.5 { 0.0 } else { 0.05 * random() };
        wheel.normal.bilateral = random() < 0.2;
        if random() < 0.3 {
            wheel.flange = Some(Flange {
                stiffness: 1e7,
                clearance: 0.04,
                release: Some([1.25, 1.385]),
            });
        }
        if random() < 0.3 {
            wheel.friction = Some(Friction {
                law: FrictionLaw::Step,
                coefficient: 0.2,
                slip: 0.1,
            });
            wheel.spin_inertia = Some(1e4);
        }
        let body = &mut scene.bodies[0];
        body.cg = [2.0 * random() - 1.0, 3.0 * random(), 0.0];
        body.free[2] = random() < 0.3;
        body.start_speed[1] = if random() < 0.3 { 4.0 * random() } else { 0.0 };
        body.start_speed[2] = random();
        let foundation = if random() < 0.3 {
            Foundation::rigid()
        } else {
            girder_with_ends()
        };
        let Ok(run) = run(&scene, foundation) else {
            ended[3] += 1;
            continue;
        };
        ended[match run.status {
            Status::Done | Status::Ended(_) | Status::Stopped => 0,
            Status::StepTooSmall(_) | Status::TooManySteps { .. } | Status::TooLarge { .. } => 1,
            Status::Failed(..) => 2,
        }] += 1;
        let all = (0..run.history.len()).flat_map(|i| run.history.sample(i).iter());
        assert!(all.into_iter().all(|value| value.is_finite()), "{scene:?}");
    }
    println!("done, too small, refused, no start: {ended:?}");
    assert!(ended[0] > 100);
}

/// Analytic: a stop of stiffness k_s at height h in front of the hubs is pressed by d where the bogie starts. At rest its wheels
/// on rigid rails, at -a and a, give the pitch stiffness 2 a^2 k. The bogie turns by the angle phi, T h = 2 a^2 k phi, and the
/// stop keeps T = k_s (d - h phi) = k_s d / (1 + k_s h^2 / (2 a^2 k)). The stop is four times as stiff in pitch as the wheels.
/// A bogie that is free along the rail starts at the same rest.
#[test]
fn a_body_that_starts_against_a_stiff_stop_rests_on_its_wheels() {
    let (height, pressed) = (1.2, 0.01);
    let mut scene = bogie(0.0, 0.01, Damper::Ground);
    let half = 4.0 / 3.0;
    let turning = 2.0 * half * half * scene.wheels[0].normal.stiffness;
    let stiffness = 4.0 * turning / (height * height);
    scene.actuators.stops = vec![Stop {
        body: 0,
        against: None,
        at: [half, height, 0.0],
        axis: 0,
        place: half - pressed,
        side: 1.0,
        stiffness,
        damping: 0.0,
    }];
    let (mut swept, mut free) = (scene.clone(), scene);
    swept.analysis = Analysis::QuasiStatic;
    free.bodies[0].motion = None;
    free.bodies[0].free[0] = true;
    for scene in [swept, free] {
        let held = run(&scene, Foundation::rigid()).expect("a bogie at rest against the stop");
        let found = held.history.column(Channel::Stop(0))[0];
        assert_near(
            "force of the stop, lb",
            "analytic",
            stiffness * pressed / 5.0,
            found,
            1e-9,
        );
    }
}

/// Analytic: what each of four wheels deflects its rail by is the influence function of the girder times their forces, at every
/// output of a crossing in fewer than twenty steps. Between nodes some steps apart the function is interpolated; without a limit
/// on its error the deflections err by 8e-2.
#[test]
fn rails_of_a_fast_crossing_deflect_by_the_influence_function_and_the_forces() {
    for method in [Method::Sdirk4, Method::Esdirk5] {
        let mut scene = rolling(0.25);
        scene.contacts = [-7.5, -2.5, 2.5, 7.5]
            .map(|offset| sim::Contact {
                offsets: vec![offset],
                ..scene.contacts[0].clone()
            })
            .to_vec();
        scene.wheels[0].normal = sim::NormalLaw::linear(4e6, 1e4, Damper::Ground);
        scene.bodies[0].start_speed[0] = 240.0;
        scene.bodies[0].start[0] = 5.0;
        scene.output_dt = 1e-3;
        scene.accuracy = 6e-3;
        let run = sim::run_by(method, &scene, &[girder()], &mut |_| {
            ControlFlow::Continue(())
        })
        .expect("valid");
        assert_eq!(run.status, Status::Done);
        let columns = |channel: fn(usize) -> Channel| {
            [0, 1, 2, 3].map(|wheel| run.history.column(channel(wheel)))
        };
        let (x, force) = (columns(Channel::Position), columns(Channel::Vertical));
        let (mut largest, mut apart) = (0.0_f64, 0.0_f64);
        for (wheel, deflection) in columns(Channel::Deflection).iter().enumerate() {
            for (row, deflection) in deflection.iter().enumerate() {
                let expected: f64 = (0..4)
                    .map(|other| give(x[wheel][row], x[other][row]).0 * force[other][row])
                    .sum();
                (largest, apart) = (
                    largest.max(expected),
                    apart.max((expected - deflection).abs()),
                );
            }
        }
        println!(
            "{method:?}, {} steps: {:.1e} of the largest deflection",
            run.counts.steps,
            apart / largest
        );
        // A tenth of the accuracy.
        assert!(
            apart < 0.1 * scene.accuracy * largest,
            "{apart:e} of {largest:e}"
        );
    }
}
