//! Trolleys on girders that ride on bridges, against levers and conservation laws.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::GRAVITY;
use common::crane::{BASE, BRIDGE, TROLLEY, body, carried, crane_of, mount, travelling};
use sim::{
    Analysis, BodyDof, Brake, Carrier, Channel, Contact, Error, Foundation, Friction, FrictionLaw,
    Load, Run, Scene, Schedule, Status,
};

const HEIGHT: f64 = 3.0;

fn run(scene: &Scene, girders: Foundation) -> Run {
    let run = sim::run(scene, &[Foundation::rigid(), girders], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

const SITS: [BodyDof; 3] = [BodyDof::Y, BodyDof::Roll, BodyDof::Pitch];

#[test]
fn wheels_of_the_bridge_carry_the_trolley_by_its_levers_at_every_place() {
    for along in [
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.6, 0.0, -0.8],
    ] {
        let mut scene = crane_of(
            body(BRIDGE, [1e6, 4e6, 4e6], &SITS),
            body(
                TROLLEY,
                [9e4, 2e5, 2e5],
                &[BodyDof::Y, BodyDof::Roll, BodyDof::Pitch],
            ),
            10.0,
        );
        (scene.analysis, scene.output_dt) = (Analysis::QuasiStatic, 0.5);
        (scene.bodies[1].motion, scene.bodies[1].cg) = (travelling(3.0, -15.0), [0.7, 5.0, -0.3]);
        let at = [1.5, HEIGHT, -2.0];
        let run = run(&scene, carried(along, at));
        let time = run.history.column(Channel::Time);
        let mut worst = 0.0_f64;
        for (k, t) in time.iter().enumerate() {
            // Analytic: four equal springs under a load at (a, c): N = W/4 + W (a x / sum x^2 + c z / sum z^2).
            let (x, z) = (3.0 * t - 15.0 + 0.7, -0.3);
            let place = [
                at[0] + x * along[0] - z * along[2],
                at[2] + x * along[2] + z * along[0],
            ];
            let weights = [BRIDGE, TROLLEY].map(|mass| mass * GRAVITY);
            for (w, contact) in scene.contacts[..4].iter().enumerate() {
                let levers = place[0] * contact.at[0] / BASE[0].powi(2)
                    + place[1] * contact.at[2] / BASE[1].powi(2);
                let wanted = 0.25 * (weights[0] + weights[1] * (1.0 + levers));
                let found = run.history.column(Channel::Vertical(w))[k];
                worst = worst.max((found - wanted).abs() / weights[0]);
            }
        }
        println!("along {along:?}: {worst:.1e} of the bridge's weight");
        assert!(worst < 1e-11, "a wheel load errs by {worst}");
    }
}

#[test]
fn a_braking_trolley_gives_its_momentum_to_the_bridge() {
    let mut scene = crane_of(
        body(
            BRIDGE,
            [1e6, 4e6, 4e6],
            &[BodyDof::X, BodyDof::Y, BodyDof::Pitch],
        ),
        body(
            TROLLEY,
            [9e4, 2e5, 2e5],
            &[BodyDof::X, BodyDof::Y, BodyDof::Pitch],
        ),
        4.0,
    );
    (scene.bodies[0].cg, scene.bodies[1].cg) = ([0.0, 6.0, 0.0], [0.0, 5.0, 0.0]);
    (scene.bodies[1].start[0], scene.bodies[1].start_speed[0]) = (-6.0, 5.0);
    let mut braked = scene.wheels[0].clone();
    braked.friction = Some(Friction {
        law: FrictionLaw::Step,
        coefficient: 0.1,
        slip: 0.1,
    });
    scene.wheels.push(braked);
    scene.contacts[4..]
        .iter_mut()
        .for_each(|contact| contact.wheel = 1);
    scene.actuators.brakes = vec![Brake {
        body: 1,
        from: 0.5,
        speed: 0.5,
        contacts: vec![4, 5, 6, 7],
    }];
    scene.output_dt = 0.01;
    let at = [0.0, HEIGHT, 0.0];
    let run = run(&scene, carried([1.0, 0.0, 0.0], at));
    let column = |b, freedom| run.history.column(Channel::Speed(b, freedom));
    let speeds = [BodyDof::X, BodyDof::Pitch].map(|freedom| [0, 1].map(|b| column(b, freedom)));
    let total = TROLLEY * 5.0;
    let mut worst = 0.0_f64;
    let [[bridge, trolley], [turns, nods]] = &speeds;
    for (((v, relative), turn), nod) in bridge.iter().zip(trolley).zip(turns).zip(nods) {
        // Analytic: the speed along x of a point h above an origin is v - h pitch'.
        let momentum = BRIDGE * (v - 6.0 * turn)
            + TROLLEY * (v - (HEIGHT + 5.0) * turn + relative - 5.0 * nod);
        worst = worst.max((momentum - total).abs() / total);
    }
    let [end, left] = [0, 1].map(|b| speeds[0][b].last().copied().unwrap_or(f64::NAN));
    println!(
        "momentum {worst:.1e}, energy {:.1e}, bridge {end:.4}, trolley on it {left:.1e}, {:?}",
        run.audit.residual(),
        run.counts
    );
    assert!(worst < 1e-9, "momentum errs by {worst}");
    assert!(
        run.audit.residual() < 1e-7,
        "energy residual {}",
        run.audit.residual()
    );
    assert!(
        (end - total / (BRIDGE + TROLLEY)).abs() < 0.3 && left.abs() < 0.5,
        "{end} and {left}"
    );
    assert!(run.audit.exchanged.friction > 0.0);
}

#[test]
fn a_trolley_held_on_its_rails_is_part_of_the_bridge() {
    let free = [BodyDof::X, BodyDof::Y, BodyDof::Pitch];
    let mut scene = crane_of(
        body(BRIDGE, [1e6, 4e6, 4e6], &free),
        body(TROLLEY, [9e4, 2e5, 3e5], &[]),
        3.0,
    );
    (scene.bodies[0].start[1], scene.bodies[0].start_speed) =
        (-0.01, [1.0, 0.0, 0.0, 0.0, 0.0, 0.02]);
    scene.bodies[1].start[0] = 10.0;
    scene.output_dt = 0.05;
    // The rail runs along z: the trolley rolls where the bridge pitches.
    let two = run(&scene, carried([0.0, 0.0, 1.0], [7.0, HEIGHT, -10.0]));
    let whole = BRIDGE + TROLLEY;
    let share = TROLLEY / whole;
    // Analytic: parallel axes.
    let apart = BRIDGE * share * (7.0 * 7.0 + HEIGHT * HEIGHT);
    let mut one = scene.clone();
    one.bodies.truncate(1);
    one.contacts.truncate(4);
    (one.bodies[0].mass, one.bodies[0].cg) = (whole, [7.0 * share, HEIGHT * share, 0.0]);
    one.bodies[0].inertia[2] = 4e6 + 9e4 + apart;
    let one = sim::run(&one, &[Foundation::rigid()], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a scene");
    for freedom in free {
        let [a, b] = [&two, &one].map(|run| run.history.column(Channel::Displacement(0, freedom)));
        let size = b.iter().fold(0.0_f64, |max, b| max.max(b.abs()));
        let worst = a
            .iter()
            .zip(&b)
            .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()))
            / size;
        println!("{freedom:?}: {worst:.1e} of {size:.1e}");
        assert!(worst < 1e-9, "{freedom:?} errs by {worst}");
    }
    assert!(
        two.audit.residual() < 1e-7,
        "energy residual {}",
        two.audit.residual()
    );
}

#[test]
fn a_trolley_that_rolls_out_slows_the_slewing_bridge() {
    let mut scene = crane_of(
        body(BRIDGE, [1e6, 4e6, 4e6], &[BodyDof::Yaw]),
        body(TROLLEY, [0.0, 2e5, 0.0], &[]),
        5.0,
    );
    scene.contacts.drain(..4);
    scene.gravity = 0.0;
    scene.bodies[0].start_speed[4] = 1e-3;
    scene.bodies[1].motion = travelling(6.0, 4.0);
    scene.output_dt = 0.1;
    let run = run(&scene, carried([0.0, 0.0, -1.0], [0.0, HEIGHT, 0.0]));
    let (time, yaw) = (
        run.history.column(Channel::Time),
        run.history.column(Channel::Speed(0, BodyDof::Yaw)),
    );
    let mut worst = 0.0_f64;
    let about = |t: f64| 4e6 + 2e5 + TROLLEY * (4.0 + 6.0 * t).powi(2);
    for (t, yaw) in time.iter().zip(&yaw) {
        // Analytic: the angular momentum is kept.
        let wanted = 1e-3 * about(0.0) / about(*t);
        worst = worst.max((yaw - wanted).abs() / 1e-3);
    }
    println!("yaw {worst:.1e}");
    assert!(worst < 1e-7, "the speed of yaw errs by {worst}");
}

#[test]
fn a_trolley_that_runs_along_a_sprung_bridge_follows_its_own_equations() {
    let (speed, x0) = (8.0, -16.0);
    let mut scene = crane_of(
        body(BRIDGE, [1e6, 4e6, 4e6], &[BodyDof::Y, BodyDof::Pitch]),
        body(TROLLEY, [9e4, 2e5, 2e5], &[]),
        4.0,
    );
    scene.wheels[0].normal.stiffness = 2e5;
    scene.bodies[0].start = [0.0, -0.5, 0.0, 0.0, 0.0, 0.01];
    (scene.bodies[1].motion, scene.output_dt) = (travelling(speed, x0), 0.1);
    let run = run(&scene, carried([1.0, 0.0, 0.0], [0.0, HEIGHT, 0.0]));
    // Analytic: height and pitch of the bridge, RK4. y_t = y + x pitch, x_t = X - h pitch; no freedom along x.
    let rate = |t: f64, s: [f64; 4]| {
        let x = x0 + speed * t;
        let [y, pitch, _, turn] = s;
        let (m, j) = (
            BRIDGE + TROLLEY,
            4e6 + 2e5 + TROLLEY * (x * x + HEIGHT * HEIGHT),
        );
        let lift = TROLLEY * (2.0 * speed * turn + GRAVITY);
        let load = [
            -4.0 * 2e5 * y - BRIDGE * GRAVITY - lift,
            -4.0 * 2e5 * BASE[0].powi(2) * pitch - x * lift,
        ];
        let (c, d) = (TROLLEY * x, m * j - (TROLLEY * x).powi(2));
        [
            s[2],
            s[3],
            (j * load[0] - c * load[1]) / d,
            (m * load[1] - c * load[0]) / d,
        ]
    };
    let (mut s, h) = ([-0.5, 0.01, 0.0, 0.0], 1e-3);
    let ys = [BodyDof::Y, BodyDof::Pitch].map(|f| run.history.column(Channel::Displacement(0, f)));
    let mut worst = [0.0_f64; 2];
    for step in 0..4000 {
        if step % 100 == 0 {
            (0..2).for_each(|i| worst[i] = worst[i].max((ys[i][step / 100] - s[i]).abs()));
        }
        let t = f64::from(step as u32) * h;
        let plus = |k: [f64; 4], by: f64| [0, 1, 2, 3].map(|i| s[i] + by * k[i]);
        let k1 = rate(t, s);
        let k2 = rate(t + 0.5 * h, plus(k1, 0.5 * h));
        let k3 = rate(t + 0.5 * h, plus(k2, 0.5 * h));
        let k4 = rate(t + h, plus(k3, h));
        s = [0, 1, 2, 3].map(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    println!(
        "y {:.1e}, pitch {:.1e}, energy {:.1e}, {:?}",
        worst[0],
        worst[1],
        run.audit.residual(),
        run.counts
    );
    assert!(worst[0] < 1e-7 && worst[1] < 1e-8, "{worst:?}");
    assert!(
        run.audit.residual() < 1e-7,
        "energy residual {}",
        run.audit.residual()
    );
}

#[test]
fn ways_to_ride_that_are_not_known_are_refused() {
    let free = [BodyDof::Y];
    let scene = crane_of(
        body(BRIDGE, [1e6; 3], &free),
        body(TROLLEY, [1e6; 3], &free),
        1.0,
    );
    let refused = |scene: &Scene, girders: Foundation| {
        sim::run(scene, &[Foundation::rigid(), girders], &mut |_| {
            ControlFlow::Continue(())
        })
        .err()
    };
    let along = |x: f64, y: f64| carried([x, y, 0.0], [0.0; 3]);
    assert_eq!(
        refused(&scene, along(0.8, 0.6)),
        Some(Error::Carried { body: 1 }),
        "not level"
    );
    assert_eq!(
        refused(&scene, along(2.0, 0.0)),
        Some(Error::Carried { body: 1 }),
        "not of length 1"
    );
    let mut both = scene.clone();
    both.contacts[4].structure = 0;
    assert_eq!(
        refused(&both, along(1.0, 0.0)),
        Some(Error::Carried { body: 1 }),
        "on two carriers"
    );
    let mut own = along(1.0, 0.0);
    own.carrier = Some(Carrier {
        body: 1,
        ..mount([1.0, 0.0, 0.0], [0.0; 3])
    });
    assert_eq!(
        refused(&scene, own),
        Some(Error::Carried { body: 1 }),
        "on itself"
    );
    let mut loaded = scene.clone();
    let value = Schedule::new(&[[0.0, 1.0]]).expect("a valid table");
    loaded.actuators.loads = vec![Load {
        body: 1,
        dof: BodyDof::Y,
        value,
    }];
    assert_eq!(
        refused(&loaded, along(1.0, 0.0)),
        Some(Error::Carried { body: 1 }),
        "loaded"
    );
    let mut short = along(1.0, 0.0);
    short
        .carrier
        .iter_mut()
        .for_each(|mount| mount.rails.truncate(1));
    assert_eq!(
        refused(&scene, short),
        Some(Error::NoSuch {
            what: "rail",
            index: 1
        })
    );
    let mut upper = scene.clone();
    upper.bodies.push(body(1.0, [1.0; 3], &free));
    upper
        .contacts
        .extend(scene.contacts[4..].iter().map(|contact| Contact {
            body: 2,
            structure: 2,
            ..contact.clone()
        }));
    let floors = [
        Foundation::rigid(),
        along(1.0, 0.0),
        Foundation {
            carrier: Some(Carrier {
                body: 1,
                ..mount([1.0, 0.0, 0.0], [0.0; 3])
            }),
            ..Foundation::rigid()
        },
    ];
    let third = sim::run(&upper, &floors, &mut |_| ControlFlow::Continue(())).err();
    assert_eq!(third, Some(Error::Carried { body: 1 }), "three floors");
}
