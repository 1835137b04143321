//! What rules switch on the way, against closed forms.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::single;
use common::space::{G, body, floor, rope, scene as space};
use sim::{
    Action, Actuators, Body, BodyDof, Brake, Channel, Compare, Condition, Damper, Drive, Error,
    Fired, Foundation, Friction, FrictionLaw, NormalLaw, Rule, Run, Scene, Schedule, Status, Wheel,
    run,
};

const X: Channel = Channel::Displacement(0, BodyDof::X);
const SPEED: Channel = Channel::Speed(0, BodyDof::X);

fn schedule(table: &[[f64; 2]]) -> Schedule {
    Schedule::new(table).expect("a valid table")
}

fn rule(channel: Channel, compare: Compare, level: f64, actions: &[Action]) -> Rule {
    Rule {
        when: Condition {
            terms: vec![(channel, 1.0)],
            compare,
            level,
        },
        actions: actions.to_vec(),
    }
}

/// Body 0 on one wheel of stiffness `k` and friction `mu`, free along the rail; other bodies in space.
fn trolley(
    bodies: Vec<Body>,
    [k, mu]: [f64; 2],
    actuators: Actuators,
    end: f64,
    accuracy: f64,
) -> Scene {
    let friction = Friction {
        law: FrictionLaw::Coulomb,
        coefficient: mu,
        slip: 1e-3,
    };
    Scene {
        wheels: vec![Wheel {
            radius: 0.5,
            normal: NormalLaw::linear(k, 0.0, Damper::Rail),
            flange: None,
            friction: Some(friction),
            spin_inertia: None,
        }],
        contacts: vec![single()],
        ..space(bodies, actuators, end, accuracy)
    }
}

fn go(scene: &Scene) -> Run {
    let foundations = if scene.contacts.is_empty() {
        Vec::new()
    } else {
        vec![Foundation::rigid()]
    };
    run(scene, &foundations, &mut |_| ControlFlow::Continue(())).expect("a scene that runs")
}

fn last(run: &Run, channel: Channel) -> f64 {
    *run.history.column(channel).last().expect("samples")
}

/// Analytic: coasting from v, the brake at x = 10 rubs with mu m g tanh(v/s); from v to u it takes
/// (v^2/2 + s^2 pi^2/12 - s u)/(mu g), where u is small beside s.
#[test]
fn full_speed_and_an_emergency_brake_take_the_braking_distance() {
    let (v, mu, s) = (4.0, 0.15, 0.01);
    let brakes = vec![Brake {
        body: 0,
        from: f64::INFINITY,
        speed: s,
        contacts: vec![0],
    }];
    let rules = vec![
        rule(
            X,
            Compare::AtLeast,
            10.0,
            &[Action::Brake { body: 0, on: true }],
        ),
        rule(SPEED, Compare::AtMost, 1e-6, &[Action::End]),
    ];
    let actuators = Actuators {
        brakes,
        rules,
        ..Actuators::default()
    };
    let moving = body(5000.0, [true, true, false], [0.0; 3], [v, 0.0, 0.0]);
    let run = go(&trolley(vec![moving], [1e7, mu], actuators, 20.0, 1e-8));
    assert_eq!(run.fired[0].rule, 0);
    assert!(
        (run.fired[0].time / 2.5 - 1.0).abs() < 1e-9,
        "{:?}",
        run.fired
    );
    assert_eq!(run.status, Status::Ended(run.fired[1]));
    assert_eq!(last(&run, Channel::Time), run.fired[1].time);
    let wanted = (0.5 * v * v + s * s * PI * PI / 12.0 - s * 1e-6) / (mu * G);
    let distance = last(&run, X) - 10.0;
    println!(
        "brake: {distance} {wanted} {:?} {:e}",
        run.counts,
        run.audit.residual()
    );
    assert!(
        (distance / wanted - 1.0).abs() < 1e-6,
        "{distance} {wanted}"
    );
    assert!(run.audit.residual() < 1e-5, "{:e}", run.audit.residual());
    let lost = run.audit.exchanged.friction / (0.5 * 5000.0 * v * v);
    assert!((lost - 1.0).abs() < 1e-7, "{lost}");
}

/// Analytic: a load of m g let go under a carrier M on a spring k: the rope's force jumps from m g to zero, the carrier
/// swings with sqrt(k/M) and m g/k about M g/k, the load falls freely.
#[test]
fn a_load_let_go_leaves_its_carrier_at_its_own_frequency() {
    let (carrier, load, k, ea, l) = (4000.0, 1500.0, 4e6, 1e8, 5.0);
    let rules = vec![rule(
        Channel::Time,
        Compare::AtLeast,
        0.25,
        &[Action::Release { rope: 0 }],
    )];
    let ropes = vec![rope(ea, l, [Some(0), Some(1)])];
    let actuators = Actuators {
        ropes,
        rules,
        hanging: vec![1],
        ..Actuators::default()
    };
    let bodies = vec![
        body(carrier, [false, true, false], [0.0; 3], [0.0; 3]),
        body(load, [true; 3], [0.0; 3], [0.0; 3]),
    ];
    let run = go(&trolley(bodies, [k, 0.2], actuators, 1.25, 1e-9));
    assert_eq!(
        run.fired,
        [Fired {
            time: 0.25,
            rule: 0
        }]
    );
    let omega = (k / carrier).sqrt();
    let (t, y) = (
        run.history.column(Channel::Time),
        run.history.column(Channel::Displacement(0, BodyDof::Y)),
    );
    let fall = run.history.column(Channel::Displacement(1, BodyDof::Y));
    let tension = run.history.column(Channel::Tension(0));
    for i in 0..t.len() {
        let since = (t[i] - 0.25).max(0.0);
        let wanted = -(carrier + load * (omega * since).cos()) * G / k;
        assert!(
            (y[i] - wanted).abs() < 1e-7 * load * G / k,
            "t = {}: {} {wanted}",
            t[i],
            y[i]
        );
        assert!(
            (fall[i] - fall[0] + 0.5 * G * since * since).abs() < 1e-9,
            "t = {}",
            t[i]
        );
        let wanted = if since > 0.0 { 0.0 } else { load * G };
        assert!(
            (tension[i] - wanted).abs() < 1e-8 * load * G,
            "t = {}: {}",
            t[i],
            tension[i]
        );
    }
    println!("drop: {:?} {:e}", run.counts, run.audit.residual());
    // the rope's own energy goes with it
    let stored = 0.5 * (load * G).powi(2) * l / ea;
    assert!(
        (run.audit.exchanged.switches / stored - 1.0).abs() < 1e-6,
        "{:?}",
        run.audit.exchanged
    );
    assert!(run.audit.residual() < 1e-8, "{:e}", run.audit.residual());
}

/// Analytic: hoisted at v from the ground, the load leaves it when the rope pulls m g, and then vibrates: the peak is
/// m g + v sqrt(k m). The hoist stops a second later; the work of hoisting is what the audit says.
#[test]
fn a_load_hoisted_off_the_ground_peaks_at_weight_and_v_root_k_m() {
    let (m, l, ea, v, ground) = (1000.0, 1e3, 1e9, 0.2, 1e10);
    let floor = floor(-l, ground);
    let rules = vec![
        rule(
            Channel::Time,
            Compare::AtLeast,
            0.1,
            &[Action::Hoist { rope: 0, speed: v }],
        ),
        rule(Channel::Stop(0), Compare::AtMost, 0.0, &[]),
        rule(
            Channel::Time,
            Compare::AtLeast,
            1.1,
            &[Action::Hoist {
                rope: 0,
                speed: 0.0,
            }],
        ),
    ];
    let ropes = vec![rope(ea, l, [None, Some(0)])];
    let actuators = Actuators {
        ropes,
        rules,
        stops: vec![floor],
        ..Actuators::default()
    };
    let load = body(m, [true; 3], [0.0, -l - m * G / ground, 0.0], [0.0; 3]);
    let mut scene = space(vec![load], actuators, 1.5, 1e-7);
    scene.output_dt = 1e-4;
    let run = go(&scene);
    assert_eq!(run.status, Status::Done);
    let k = ea / l;
    let peak = m * G + v * (k * m).sqrt();
    let (t, tension) = (
        run.history.column(Channel::Time),
        run.history.column(Channel::Tension(0)),
    );
    let found = t
        .iter()
        .zip(&tension)
        .filter(|(t, _)| **t < 1.1)
        .fold(0.0_f64, |max, (_, n)| max.max(*n));
    println!(
        "hoist: {found} {peak} {:?} {:e}",
        run.counts,
        run.audit.residual()
    );
    assert!((found / peak - 1.0).abs() < 2e-4, "{found} {peak}");
    let lifts: Vec<&Fired> = run.fired.iter().filter(|fired| fired.rule == 1).collect();
    let wanted = 0.1 + m * G / (k * v);
    // as the load leaves, it trembles on the ground with sqrt(ground / m)
    assert!(
        (lifts[0].time - wanted).abs() < (m / ground).sqrt(),
        "{lifts:?} {wanted}"
    );
    let length = last(&run, Channel::Length(0));
    assert!((length - (l - v)).abs() < 0.05, "{length}");
    // gained: the height, the rope's stretch and the swing
    let (start, end) = (run.audit.start.total(), run.audit.end.total());
    assert!(
        (run.audit.exchanged.hoists / (end - start) - 1.0).abs() < 1e-6,
        "{:?}",
        run.audit
    );
    assert!(run.audit.residual() < 1e-6, "{:e}", run.audit.residual());
}

/// Analytic: a carrier that all but stops at once leaves its load with v: it swings to v^2/(2 g l) above its rest,
/// v/sqrt(g l) for small angles.
#[test]
fn a_sudden_stop_swings_the_load_by_v_over_root_g_l() {
    let (carrier, load, v, l, ea, mu) = (1e6, 1.0, 0.5, 8.0, 1e6, 500.0);
    let brakes = vec![Brake {
        body: 0,
        from: f64::INFINITY,
        speed: 1e-6,
        contacts: vec![0],
    }];
    let rules = vec![rule(
        X,
        Compare::AtLeast,
        0.25,
        &[Action::Brake { body: 0, on: true }],
    )];
    let ropes = vec![rope(ea, l, [Some(0), Some(1)])];
    let actuators = Actuators {
        brakes,
        ropes,
        rules,
        hanging: vec![1],
        ..Actuators::default()
    };
    let bodies = vec![
        body(carrier, [true, true, false], [0.0; 3], [v, 0.0, 0.0]),
        body(load, [true; 3], [0.0; 3], [v, 0.0, 0.0]),
    ];
    let mut scene = trolley(bodies, [1e9, mu], actuators, 4.0, 1e-6);
    scene.output_dt = 2e-3;
    let run = go(&scene);
    let (x, hung) = (
        run.history.column(X),
        run.history.column(Channel::Displacement(1, BodyDof::X)),
    );
    let swing = x
        .iter()
        .zip(&hung)
        .fold(0.0_f64, |max, (a, b)| max.max((b - a).abs()));
    let angle = (swing / (l * (1.0 + load * G / ea))).asin();
    let wanted = (1.0 - v * v / (2.0 * G * l)).acos();
    println!(
        "stop: {angle} {wanted} {} {:?} {:e}",
        v / (G * l).sqrt(),
        run.counts,
        run.audit.residual()
    );
    assert!((angle / wanted - 1.0).abs() < 1e-4, "{angle} {wanted}");
    assert!((v / (G * l).sqrt() / wanted - 1.0).abs() < 1e-3);
}

/// Analytic: the drive reaches 2 m/s with its largest force F in 2 m/F, is told 1 m/s at x = 6 and turned off at 8: what
/// it put in is the kinetic energy.
#[test]
fn a_drive_follows_the_speed_it_is_told_and_is_turned_off() {
    let (m, force) = (1000.0, 4000.0);
    let drives = vec![Drive {
        body: 0,
        speed: schedule(&[[0.0, 2.0]]),
        gain: 1e6,
        max_force: force,
        contacts: Vec::new(),
        until: f64::INFINITY,
    }];
    let rules = vec![
        rule(SPEED, Compare::AtLeast, 1.5, &[]),
        rule(
            X,
            Compare::AtLeast,
            6.0,
            &[Action::Drive {
                body: 0,
                speed: Some(1.0),
            }],
        ),
        rule(
            X,
            Compare::AtLeast,
            8.0,
            &[Action::Drive {
                body: 0,
                speed: None,
            }],
        ),
        rule(X, Compare::Above, 9.0, &[Action::End]),
    ];
    let actuators = Actuators {
        drives,
        rules,
        ..Actuators::default()
    };
    let run = go(&space(
        vec![body(m, [true, false, false], [0.0; 3], [0.0; 3])],
        actuators,
        20.0,
        1e-8,
    ));
    let order: Vec<usize> = run.fired.iter().map(|fired| fired.rule).collect();
    assert_eq!(order, [0, 1, 2, 3]);
    assert!(
        (run.fired[0].time - 1.5 * m / force).abs() < 1e-8,
        "{:?}",
        run.fired
    );
    assert!(
        (last(&run, SPEED) - 1.0).abs() < 1e-7,
        "{}",
        last(&run, SPEED)
    );
    assert!((last(&run, X) - 9.0).abs() < 1e-7, "{}", last(&run, X));
    let work = run.audit.exchanged.drives;
    assert!((work / (0.5 * m) - 1.0).abs() < 1e-6, "{work}");
    println!(
        "drive: {:?} {:e} {:?}",
        run.counts,
        run.audit.residual(),
        run.audit
    );
}

/// Analytic: x = t^3/6 under a load that grows with time: a rule acts at the root within rounding, whatever the steps.
#[test]
fn rules_act_at_the_root_of_their_condition() {
    for accuracy in [1e-3, 1e-6] {
        let mut actuators = Actuators::default();
        let value = schedule(&[[0.0, 0.0], [10.0, 10.0]]);
        actuators.loads = vec![sim::Load {
            body: 0,
            dof: BodyDof::X,
            value,
        }];
        let (sum, compare) = (vec![(X, 6.0), (Channel::Time, 1.0)], Compare::AtLeast);
        // t^3 + t = 2
        actuators.rules = vec![
            Rule {
                when: Condition {
                    terms: sum,
                    compare,
                    level: 2.0,
                },
                actions: vec![Action::End],
            },
            rule(X, Compare::AtLeast, -1.0, &[]),
        ];
        let run = go(&space(
            vec![body(1.0, [true, false, false], [0.0; 3], [0.0; 3])],
            actuators,
            10.0,
            accuracy,
        ));
        assert_eq!(run.fired[0], Fired { time: 0.0, rule: 1 });
        let Status::Ended(Fired { time, rule: 0 }) = run.status else {
            panic!("{:?}", run.status)
        };
        println!("root: {accuracy:e} {:e} {:?}", time - 1.0, run.counts);
        assert!(
            (time - 1.0).abs() < accuracy.min(1e-8),
            "{accuracy:e} {time}"
        );
    }
}

#[test]
fn rules_of_what_is_not_there_are_refused() {
    let free = || vec![body(1.0, [true; 3], [0.0; 3], [0.0; 3])];
    let wrong = [
        rule(
            X,
            Compare::Above,
            1.0,
            &[Action::Brake { body: 0, on: true }],
        ),
        rule(
            X,
            Compare::Above,
            1.0,
            &[Action::Drive {
                body: 0,
                speed: None,
            }],
        ),
        rule(X, Compare::Above, 1.0, &[Action::Release { rope: 0 }]),
        rule(X, Compare::Above, f64::NAN, &[]),
        rule(Channel::Tension(0), Compare::Above, 1.0, &[]),
    ];
    for rule in wrong {
        let actuators = Actuators {
            rules: vec![rule.clone()],
            ..Actuators::default()
        };
        let refused = run(&space(free(), actuators, 1.0, 1e-6), &[], &mut |_| {
            ControlFlow::Continue(())
        });
        assert!(
            matches!(refused, Err(Error::NoSuch { .. } | Error::Number { .. })),
            "{rule:?}"
        );
    }
}

/// A rule may not hoist more than there is until the end of the scene.
#[test]
fn hoisting_the_whole_rope_in_ends_the_run() {
    let rules = vec![rule(
        Channel::Time,
        Compare::AtLeast,
        0.5,
        &[Action::Hoist {
            rope: 0,
            speed: 3.0,
        }],
    )];
    let ropes = vec![rope(1e6, 5.0, [None, Some(0)])];
    let actuators = Actuators {
        ropes,
        rules,
        hanging: vec![0],
        ..Actuators::default()
    };
    let run = go(&space(
        vec![body(10.0, [true; 3], [0.0; 3], [0.0; 3])],
        actuators,
        4.0,
        1e-6,
    ));
    assert!(
        matches!(run.status, Status::Failed(0.5, Error::Number { .. })),
        "{:?}",
        run.status
    );
}
