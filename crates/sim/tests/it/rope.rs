//! Bodies in space on ropes: pendulums, hoisting, slack.

use crate::common;

use std::ops::ControlFlow;

use common::space::{self, G, floor, scene};
use sim::{
    Actuators, Body, BodyDof, Channel, Rope, RopeEnd, Run, Scene, Schedule, Status, Stop, run,
};

/// A point mass that is free in space.
fn body(mass: f64, start: [f64; 3], speed: [f64; 3]) -> Body {
    space::body(mass, [true; 3], start, speed)
}

/// A rope from the origin of space.
fn rope(stiffness: f64, length: f64, to: usize) -> Rope {
    space::rope(stiffness, length, [None, Some(to)])
}

fn go(scene: &Scene) -> Run {
    let run = run(scene, &[], &mut |_| ControlFlow::Continue(())).expect("a scene that runs");
    assert_eq!(run.status, Status::Done);
    run
}

/// Last sample of a displacement.
fn last(run: &Run, freedom: BodyDof) -> f64 {
    *run.history
        .column(Channel::Displacement(0, freedom))
        .last()
        .expect("samples")
}

/// Analytic: with the ring at angle a0, the period is 4 sqrt(l/g) K(sin(a0/2)), K by the arithmetic-geometric mean;
/// half of it later the pendulum is at the other side.
#[test]
fn a_swing_of_sixty_degrees_takes_the_elliptic_period() {
    let (l, angle, ea) = (10.0_f64, 60.0_f64.to_radians(), 1e11);
    let (mut a, mut b) = (1.0_f64, (angle / 2.0).cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let period = 2.0 * std::f64::consts::PI * (l / G).sqrt() / a;
    // stretched by the part of the weight along it: no vibration
    let stretched = l * (1.0 + 1000.0 * G * angle.cos() / ea);
    let start = [stretched * angle.sin(), -stretched * angle.cos(), 0.0];
    let actuators = Actuators {
        ropes: vec![rope(ea, l, 0)],
        ..Actuators::default()
    };
    let run = go(&scene(
        vec![body(1000.0, start, [0.0; 3])],
        actuators,
        0.5 * period,
        1e-7,
    ));
    assert!(
        (last(&run, BodyDof::X) + start[0]).abs() < 2e-6,
        "{} {:?}",
        last(&run, BodyDof::X),
        run.counts
    );
    // m g (3 cos - 2 cos a0), at every sample
    let y = run.history.column(Channel::Displacement(0, BodyDof::Y));
    for (y, tension) in y.iter().zip(run.history.column(Channel::Tension(0))) {
        let wanted = 1000.0 * G * (-3.0 * y / l - 2.0 * angle.cos());
        assert!((tension / wanted - 1.0).abs() < 1e-4, "{tension} {wanted}");
    }
    // a stiff rope goes at the pace of the swing
    assert!(run.counts.steps < 300, "{:?}", run.counts);
    assert!(run.audit.residual() < 3e-8, "{:e}", run.audit.residual());
    println!("period: {:?} {:e}", run.counts, run.audit.residual());
}

#[test]
fn a_small_swing_of_an_elastic_rope_has_the_period_of_its_stretched_length() {
    let (m, l0, ea) = (1000.0, 8.0, 1e6);
    let l = l0 * (1.0 + m * G / ea);
    let period = 2.0 * std::f64::consts::PI * (l / G).sqrt();
    let x = 1e-3 * l;
    let start = [x, -(l * l - x * x).sqrt(), 0.0];
    let actuators = Actuators {
        ropes: vec![rope(ea, l0, 0)],
        ..Actuators::default()
    };
    let run = go(&scene(
        vec![body(m, start, [0.0; 3])],
        actuators,
        period,
        1e-6,
    ));
    assert!(
        (last(&run, BodyDof::X) / x - 1.0).abs() < 1e-5,
        "{}",
        last(&run, BodyDof::X) / x - 1.0
    );
    println!("small: {:?} {:e}", run.counts, run.audit.residual());
}

/// Analytic: thrown up at v from rest length, free flight, and the rope is tight again after 2 v/g.
#[test]
fn a_load_thrown_upwards_flies_until_the_rope_catches_it() {
    let (m, l, v) = (500.0, 5.0, 6.0);
    let actuators = Actuators {
        ropes: vec![rope(1e7, l, 0)],
        ..Actuators::default()
    };
    let run = go(&scene(
        vec![body(m, [0.0, -l, 0.0], [0.0, v, 0.0])],
        actuators,
        2.0,
        1e-7,
    ));
    let (t, y) = (
        run.history.column(Channel::Time),
        run.history.column(Channel::Displacement(0, BodyDof::Y)),
    );
    let tension = run.history.column(Channel::Tension(0));
    let catch = 2.0 * v / G;
    for ((t, y), tension) in t.iter().zip(&y).zip(&tension) {
        if *t < catch {
            assert!((y - (-l + v * t - 0.5 * G * t * t)).abs() < 1e-9, "t = {t}");
            assert_eq!(*tension, 0.0);
        }
    }
    // x'' = g - k x / m from x = 0 at v: the peak is m g + sqrt((m g)^2 + k m v^2)
    let k = 1e7 / l;
    let peak = m * G + ((m * G).powi(2) + k * m * v * v).sqrt();
    let most = tension.iter().copied().fold(0.0, f64::max);
    assert!((most / peak - 1.0).abs() < 0.05, "{most} {peak}");
    assert!(
        run.counts.events >= 1 && run.audit.residual() < 1e-7,
        "{:e}",
        run.audit.residual()
    );
    println!("throw: {:?} {:e}", run.counts, run.audit.residual());
}

/// Analytic: a rope that hangs slack, whatever its damper and its hoist do, leaves a load in free flight: it stores
/// nothing, dissipates nothing and does no work.
#[test]
fn a_slack_rope_stores_dissipates_and_supplies_nothing() {
    let (m, l, v) = (500.0, 5.0, 6.0);
    let mut line = rope(1e7, l, 0);
    line.damping = 3e4;
    line.speed = Schedule::new(&[[0.0, 0.4]]).expect("one row");
    let actuators = Actuators {
        ropes: vec![line],
        ..Actuators::default()
    };
    let run = go(&scene(
        vec![body(m, [0.3, -3.0, 0.0], [0.5, v, 0.0])],
        actuators,
        0.6,
        1e-7,
    ));
    let (start, end, exchanged) = (run.audit.start, run.audit.end, run.audit.exchanged);
    assert_eq!((start.ropes, end.ropes), (0.0, 0.0));
    assert_eq!(
        (exchanged.dampers, exchanged.hoists, exchanged.switches),
        (0.0, 0.0, 0.0)
    );
    assert!(
        (end.total() / start.total() - 1.0).abs() < 1e-9,
        "{start:?} {end:?}"
    );
    assert!((last(&run, BodyDof::X) - 0.6).abs() < 1e-12);
    // The same rope, taut: its damper takes what neither the load nor the hoist has in the end.
    let mut line = rope(1e6, l, 0);
    line.damping = 3e4;
    line.speed = Schedule::new(&[[0.0, 0.4]]).expect("one row");
    let actuators = Actuators {
        ropes: vec![line],
        ..Actuators::default()
    };
    let run = go(&scene(
        vec![body(m, [0.0, -l, 0.0], [0.0, v, 0.0])],
        actuators,
        2.5,
        1e-8,
    ));
    assert!(
        run.audit.exchanged.dampers > 1e3 && run.audit.exchanged.hoists > 1e2,
        "{:?}",
        run.audit.exchanged
    );
    assert!(run.audit.residual() < 1e-6, "{:e}", run.audit.residual());
}

/// Analytic: v sqrt(m k) however far the stop is from the origin, for a push of a tenth of a newton at a kilometre.
#[test]
fn a_light_push_on_a_stop_far_from_the_origin_is_held() {
    let (m, k, v) = (2.0, 50.0, 0.01);
    let stop = Stop {
        body: 0,
        against: None,
        at: [0.5, 0.0, 0.0],
        axis: 0,
        place: 1000.505,
        side: 1.0,
        stiffness: k,
        damping: 0.0,
    };
    let mut own = body(m, [1000.0, 0.0, 0.0], [v, 0.0, 0.0]);
    own.free[1] = false;
    let run = go(&scene(
        vec![own],
        Actuators {
            stops: vec![stop],
            ..Actuators::default()
        },
        1.5,
        1e-8,
    ));
    let peak = v * (m * k).sqrt();
    let most = run
        .history
        .column(Channel::Stop(0))
        .into_iter()
        .fold(0.0, f64::max);
    assert!((most / peak - 1.0).abs() < 1e-3, "{most} {peak}");
    let speed = *run
        .history
        .column(Channel::Speed(0, BodyDof::X))
        .last()
        .expect("samples");
    assert!((speed + v).abs() < 1e-6 * v, "{speed}");
}

/// Analytic: at rest below its rope a load stays, its tension is its weight.
#[test]
fn a_hung_load_starts_at_rest_stretched_by_its_weight() {
    let (m, l, ea) = (2000.0, 6.0, 5e6);
    let actuators = Actuators {
        ropes: vec![rope(ea, l, 0)],
        hanging: vec![0],
        ..Actuators::default()
    };
    let run = go(&scene(
        vec![body(m, [0.0; 3], [0.0; 3])],
        actuators,
        1.0,
        1e-6,
    ));
    for tension in run.history.column(Channel::Tension(0)) {
        assert!((tension / (m * G) - 1.0).abs() < 1e-9, "{tension}");
    }
    assert!((last(&run, BodyDof::Y) + l * (1.0 + m * G / ea)).abs() < 1e-10);
}

/// Analytic: hoisted at speed v from slack on a floor, the rope tightens until it lifts the load off at
/// k v t = m g; then m x'' = k (v t - x) gives a peak of m g + v sqrt(k m) with k all but constant.
#[test]
fn hoisting_off_the_floor_at_speed_peaks_at_weight_and_v_root_k_m() {
    let (m, l, ea, v) = (1000.0, 100.0, 1e8, 0.2);
    let mut line = rope(ea, l, 0);
    line.speed = Schedule::new(&[[0.0, v]]).expect("one row");
    let k_floor = 1e9;
    let floor = floor(-l, k_floor);
    let start = [0.0, -l - m * G / k_floor, 0.0];
    let actuators = Actuators {
        ropes: vec![line],
        stops: vec![floor],
        ..Actuators::default()
    };
    let run = go(&scene(vec![body(m, start, [0.0; 3])], actuators, 0.3, 1e-7));
    let peak = m * G + v * (ea / l * m).sqrt();
    let most = run
        .history
        .column(Channel::Tension(0))
        .into_iter()
        .fold(0.0, f64::max);
    assert!((most / peak - 1.0).abs() < 5e-3, "{most} {peak}");
    println!(
        "hoist: {most} {peak} {:?} {:e} {:?}",
        run.counts,
        run.audit.residual(),
        run.audit
    );
}

/// Analytic: v sqrt(m k), and the body comes back with its speed.
#[test]
fn a_buffer_peaks_at_v_root_m_k_and_gives_the_speed_back() {
    let (m, k, v) = (2000.0, 4e5, 1.5);
    let stop = Stop {
        body: 0,
        against: None,
        at: [1.0, 0.0, 0.0],
        axis: 0,
        place: 3.0,
        side: 1.0,
        stiffness: k,
        damping: 0.0,
    };
    let mut free = body(m, [0.0; 3], [v, 0.0, 0.0]);
    free.free[1] = false;
    let actuators = Actuators {
        stops: vec![stop],
        ..Actuators::default()
    };
    let run = go(&scene(vec![free], actuators, 2.5, 1e-8));
    let most = run
        .history
        .column(Channel::Stop(0))
        .into_iter()
        .fold(0.0, f64::max);
    let back = *run
        .history
        .column(Channel::Speed(0, BodyDof::X))
        .last()
        .expect("samples");
    assert!((most / (v * (m * k).sqrt()) - 1.0).abs() < 1e-3, "{most}");
    assert!((back / v + 1.0).abs() < 1e-7, "{back}");
    println!("buffer: {:?} {:e}", run.counts, run.audit.residual());
    assert!(run.audit.residual() < 1e-8);
}

/// Analytic: at angle a about the vertical the load goes round with w^2 = g/(l cos a).
#[test]
fn a_conical_pendulum_goes_round_on_a_stiff_rope() {
    let (m, l, angle, ea) = (800.0, 6.0, 0.9_f64, 1e11);
    let stretched = l * (1.0 + m * G / (ea * angle.cos()));
    let omega = (G / (stretched * angle.cos())).sqrt();
    let radius = stretched * angle.sin();
    let start = [radius, -stretched * angle.cos(), 0.0];
    let actuators = Actuators {
        ropes: vec![rope(ea, l, 0)],
        ..Actuators::default()
    };
    let speed = [0.0, 0.0, omega * radius];
    let end = 2.0 * std::f64::consts::PI / omega;
    let run = go(&scene(vec![body(m, start, speed)], actuators, end, 1e-7));
    for (freedom, place) in [BodyDof::X, BodyDof::Y, BodyDof::Z].into_iter().zip(start) {
        assert!(
            (last(&run, freedom) - place).abs() < 1e-5,
            "{freedom:?} {}",
            last(&run, freedom) - place
        );
    }
    for tension in run.history.column(Channel::Tension(0)) {
        assert!(
            (tension / (m * G / angle.cos()) - 1.0).abs() < 1e-5,
            "{tension}"
        );
    }
    println!("cone: {:?} {:e}", run.counts, run.audit.residual());
    assert!(
        run.counts.steps < 300 && run.audit.residual() < 1e-8,
        "{:?}",
        run.counts
    );
}

/// Analytic: two equal loads on equal ropes swing together, as 1 to root 2, with w^2 = (2 - root 2) g/l.
#[test]
fn a_load_below_a_load_swings_in_the_slow_mode_of_the_double_pendulum() {
    let (m, l, ea, a) = (500.0, 4.0, 1e11, 1e-3);
    let lower = Rope {
        from: RopeEnd {
            body: Some(0),
            at: [0.0; 3],
        },
        ..rope(ea, l, 1)
    };
    let actuators = Actuators {
        ropes: vec![lower, rope(ea, l, 0)],
        ..Actuators::default()
    };
    let reach = |sine: f64, load: f64| {
        let stretched = l * (1.0 + load * G / ea);
        [stretched * sine, -stretched * (1.0 - sine * sine).sqrt()]
    };
    let (upper, below) = (reach(a, 2.0 * m), reach(a * 2.0_f64.sqrt(), m));
    let bodies = vec![
        body(m, [upper[0], upper[1], 0.0], [0.0; 3]),
        body(m, [upper[0] + below[0], upper[1] + below[1], 0.0], [0.0; 3]),
    ];
    let period = 2.0 * std::f64::consts::PI / ((2.0 - 2.0_f64.sqrt()) * G / l).sqrt();
    let run = go(&scene(bodies, actuators, period, 1e-7));
    let x = run.history.column(Channel::Displacement(0, BodyDof::X));
    assert!(
        (last(&run, BodyDof::X) / upper[0] - 1.0).abs() < 1e-4,
        "{}",
        last(&run, BodyDof::X) / upper[0]
    );
    // halfway, at the other side
    assert!(
        (x[x.len() / 2] / upper[0] + 1.0).abs() < 1e-4,
        "{}",
        x[x.len() / 2]
    );
    println!("double: {:?} {:e}", run.counts, run.audit.residual());
}

/// Identity: a swing that is hoisted below a point that speeds up and stops conserves its energy balance, and tighter
/// accuracy moves it by no more than was asked.
#[test]
fn a_hoisted_swing_below_a_moving_point_closes_its_energy_at_the_pace_of_the_swing() {
    let solved = |accuracy: f64| {
        let mut crab = body(3000.0, [0.0; 3], [0.0; 3]);
        crab.free = [true, false, false, false, false, false];
        let table = [[0.0, 0.0], [2.0, 1.5], [4.0, 1.5], [5.0, 0.0]];
        crab.motion = Some(
            sim::Profile::new(sim::MotionKind::Speed, &table, 0.0, 0.0).expect("a valid table"),
        );
        let mut line = Rope {
            from: RopeEnd {
                body: Some(0),
                at: [0.0; 3],
            },
            ..rope(1e10, 12.0, 1)
        };
        line.speed =
            Schedule::new(&[[1.0, 0.0], [2.0, 0.5], [6.0, 0.5], [7.0, 0.0]]).expect("rows");
        line.damping = 2e5;
        let actuators = Actuators {
            ropes: vec![line],
            hanging: vec![1],
            ..Actuators::default()
        };
        go(&scene(
            vec![crab, body(1000.0, [0.0; 3], [0.0; 3])],
            actuators,
            8.0,
            accuracy,
        ))
    };
    let (run, fine) = (solved(1e-7), solved(1e-9));
    let column = |run: &Run| run.history.column(Channel::Displacement(1, BodyDof::X));
    let apart = column(&run)
        .iter()
        .zip(column(&fine))
        .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
    println!(
        "moving: {:?} {:e} {apart:e}",
        run.counts,
        run.audit.residual()
    );
    println!("moving: {:?} {:e}", fine.counts, fine.audit.residual());
    assert!(apart < 1e-5, "{apart}");
    assert!(run.audit.residual() < 1e-7, "{:e}", run.audit.residual());
}

/// Analytic: the reduced mass on the buffer's spring peaks at v sqrt(k m1 m2/(m1 + m2)); the impact is elastic.
#[test]
fn a_buffer_between_two_bodies_peaks_with_their_reduced_mass() {
    let (m1, m2, k, v) = (2000.0, 3000.0, 4e5, 1.5);
    let stop = Stop {
        body: 0,
        against: Some(1),
        at: [1.0, 0.0, 0.0],
        axis: 0,
        place: -0.5,
        side: 1.0,
        stiffness: k,
        damping: 0.0,
    };
    let mut bodies = vec![
        body(m1, [0.0; 3], [v, 0.0, 0.0]),
        body(m2, [3.0, 0.0, 0.0], [0.0; 3]),
    ];
    bodies.iter_mut().for_each(|body| body.free[1] = false);
    let actuators = Actuators {
        stops: vec![stop],
        ..Actuators::default()
    };
    let run = go(&scene(bodies, actuators, 2.5, 1e-8));
    let force = run.history.column(Channel::Stop(0));
    let peak = v * (k * m1 * m2 / (m1 + m2)).sqrt();
    let most = force.iter().copied().fold(0.0, f64::max);
    assert!((most / peak - 1.0).abs() < 1e-3, "{most} {peak}");
    // the gap is 3 - 1 - 0.5
    let first = force
        .iter()
        .position(|force| *force > 0.0)
        .expect("a meeting");
    assert!(
        (run.history.column(Channel::Time)[first] - 1.0).abs() < 3e-3,
        "{first}"
    );
    let after = |b: usize| {
        *run.history
            .column(Channel::Speed(b, BodyDof::X))
            .last()
            .expect("samples")
    };
    assert!(
        (after(0) - v * (m1 - m2) / (m1 + m2)).abs() < 1e-7,
        "{}",
        after(0)
    );
    assert!(
        (after(1) - 2.0 * v * m1 / (m1 + m2)).abs() < 1e-7,
        "{}",
        after(1)
    );
    assert!(run.audit.residual() < 1e-8);
}
