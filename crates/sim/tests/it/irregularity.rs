//! Uneven rails: steps, ramps and bumps against closed forms and an independent integration.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::kutta::Kernel;
use common::{GRAVITY, bogie};
use sim::{
    BodyDof, Channel, Damper, Flange, Foundation, Irregularity, Method, MotionKind, Profile, Run,
    Scene, Side, Status, Wave,
};
use splines::Axis;

const MASS: f64 = 2.0;
const K: f64 = 800.0;
const SPEED: f64 = 3.0;
/// Where the rail begins to rise.
const START: f64 = 1.5;

/// A mass on one spring (and damper) at constant speed.
fn mass(damping: f64, end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Rail);
    let body = &mut scene.bodies[0];
    (body.mass, body.inertia) = (MASS, [MASS; 3]);
    body.free = [false, true, false, false, false, false];
    body.motion = Some(Profile::new(MotionKind::Speed, &[[0.0, SPEED]], 0.0, 0.0).expect("a row"));
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    scene.wheels[0].normal.stiffness = K;
    scene.wheels[0].normal.damping = damping;
    scene.wheels[0].normal.bilateral = true;
    scene.output_dt = end / 200.0;
    scene.accuracy = 1e-9;
    scene
}

fn uneven(vertical: &[[f64; 2]], lateral: &[[f64; 2]]) -> Foundation {
    let shape = Irregularity::new(vertical, lateral).expect("rows in order");
    Foundation {
        irregularities: vec![shape],
        ..Foundation::rigid()
    }
}

fn run(scene: &Scene, foundation: Foundation) -> Run {
    let run =
        sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// Largest |found - expected| after the rise begins, `expected` of the time since then, about the place at rest.
fn error(run: &Run, freedom: BodyDof, expected: impl Fn(f64) -> f64) -> f64 {
    let (t, y) = (
        run.history.column(Channel::Time),
        run.history.column(Channel::Displacement(0, freedom)),
    );
    let rest = y.first().copied().unwrap_or(0.0);
    let pairs = t.iter().zip(&y).map(|(t, y)| {
        let since = t - START / SPEED;
        y - rest - if since > 0.0 { expected(since) } else { 0.0 }
    });
    pairs.fold(0.0, |max: f64, d| max.max(d.abs()))
}

#[test]
fn step_sets_a_sprung_mass_swinging_about_its_new_height() {
    // Analytic: m y'' = k (h - y).
    let (h, omega) = (0.01, (K / MASS).sqrt());
    let found = run(&mass(0.0, 2.0), uneven(&[[START, 0.0], [START, h]], &[]));
    let off = error(&found, BodyDof::Y, |t| h * (1.0 - (omega * t).cos()));
    println!(
        "step: {off:.2e} of {h}, audit {:.2e}",
        found.audit.residual()
    );
    assert!(off < 1e-7 * h, "{off:e}");
    assert!(found.audit.residual() < 1e-8);
    // The spring is pressed by h more: m g h + k h^2/2.
    let work = MASS * GRAVITY * h + 0.5 * K * h * h;
    assert!((found.audit.exchanged.rail_steps - work).abs() < 1e-9 * work);
}

#[test]
fn damper_on_a_rigid_rail_answers_a_step_with_an_impulse() {
    // Analytic: y(0) = 0, y'(0) = c h/m, then free damped motion about h.
    let (h, zeta, omega) = (0.01, 0.2_f64, (K / MASS).sqrt());
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let scene = mass(2.0 * zeta * omega * MASS, 2.0);
    let found = run(&scene, uneven(&[[START, 0.0], [START, h]], &[]));
    let closed = |t: f64| {
        let (sin, cos) = (damped * t).sin_cos();
        h + h * (-zeta * omega * t).exp() * (zeta * omega / damped * sin - cos)
    };
    let off = error(&found, BodyDof::Y, closed);
    println!(
        "damped step: {off:.2e} of {h}, audit {:.2e}",
        found.audit.residual()
    );
    assert!(off < 1e-6 * h, "{off:e}");
    assert!(found.audit.residual() < 1e-8);
}

#[test]
fn ramp_lifts_a_sprung_mass_with_a_lag() {
    // Analytic: m y'' = k (s v t - y).
    let (slope, omega) = (0.004, (K / MASS).sqrt());
    let end = START + 9.0;
    let found = run(
        &mass(0.0, 3.0),
        uneven(&[[START, 0.0], [end, slope * 9.0]], &[]),
    );
    let off = error(&found, BodyDof::Y, |t| {
        slope * SPEED * (t - (omega * t).sin() / omega)
    });
    println!("ramp: {off:.2e}, audit {:.2e}", found.audit.residual());
    assert!(off < 1e-9, "{off:e}");
    assert!(found.audit.residual() < 1e-8);
}

#[test]
fn sideways_step_of_the_rail_moves_a_wheel_between_flanges_without_play() {
    let (h, omega) = (0.02, (K / MASS).sqrt());
    let mut scene = mass(0.0, 2.0);
    scene.bodies[0].free[2] = true;
    scene.wheels[0].flange = Some(Flange {
        stiffness: K,
        clearance: 0.0,
        release: None,
    });
    let found = run(&scene, uneven(&[], &[[START, 0.0], [START, h]]));
    let off = error(&found, BodyDof::Z, |t| h * (1.0 - (omega * t).cos()));
    println!(
        "lateral step: {off:.2e}, audit {:.2e}",
        found.audit.residual()
    );
    assert!(off < 1e-7 * h, "{off:e}");
    assert!(found.audit.residual() < 1e-8);
}

#[test]
fn sinusoid_drives_a_linear_oscillator() {
    // Analytic: m y'' = k (a sin(w t) - y) from rest: y = a (omega^2 sin(w t) - w omega sin(omega t)) / (omega^2 - w^2).
    let (a, length, omega) = (0.004, 2.5, (K / MASS).sqrt());
    let w = std::f64::consts::TAU * SPEED / length;
    let wave = Wave {
        amplitude: a,
        length,
        phase: 0.0,
        range: [START, f64::INFINITY],
    };
    let shape = Irregularity::wave(Axis::Vertical, wave).expect("a wave");
    let found = run(
        &mass(0.0, 4.0),
        Foundation {
            irregularities: vec![shape],
            ..Foundation::rigid()
        },
    );
    let closed = |t: f64| {
        a * omega * (omega * (w * t).sin() - w * (omega * t).sin()) / (omega * omega - w * w)
    };
    let off = error(&found, BodyDof::Y, closed);
    println!(
        "sinusoid: {:.2e} of its amplitude, audit {:.2e}",
        off / a,
        found.audit.residual()
    );
    assert!(off < 1e-6 * a, "{off:e}");
    assert!(found.audit.residual() < 1e-8);
}

#[test]
fn steady_swing_over_a_sinusoid_has_the_amplitude_of_base_excitation() {
    // Analytic: |Y/a|^2 = (1 + (2 zeta r)^2) / ((1 - r^2)^2 + (2 zeta r)^2), r = w/omega.
    let (a, length, zeta, omega) = (0.004, 1.2, 0.3_f64, (K / MASS).sqrt());
    let wave = Wave {
        amplitude: a,
        length,
        phase: 0.4,
        range: [f64::NEG_INFINITY, f64::INFINITY],
    };
    let shape = Irregularity::wave(Axis::Vertical, wave).expect("a wave");
    let mut scene = mass(2.0 * zeta * omega * MASS, 10.0);
    scene.output_dt = 1e-3;
    let found = run(
        &scene,
        Foundation {
            irregularities: vec![shape],
            ..Foundation::rigid()
        },
    );
    let y = found.history.column(Channel::Displacement(0, BodyDof::Y));
    // Ten wavelengths at the end, 400 rows each; the start is e^-36 away.
    let last = &y[y.len() - 4000..];
    let mean = last.iter().sum::<f64>() / 4000.0;
    let swing = (last.iter().map(|y| (y - mean) * (y - mean)).sum::<f64>() / 2000.0).sqrt();
    let (r, d) = (std::f64::consts::TAU * SPEED / length / omega, |r: f64| {
        (2.0 * zeta * r).powi(2)
    });
    let expected = a * ((1.0 + d(r)) / ((1.0 - r * r).powi(2) + d(r))).sqrt();
    println!(
        "steady: {swing} of {expected}, audit {:.2e}",
        found.audit.residual()
    );
    assert!((swing / expected - 1.0).abs() < 1e-6);
    assert!((mean + MASS * GRAVITY / K).abs() < 1e-6 * a);
}

#[test]
fn corner_gives_a_stiff_wheel_the_velocity_of_its_slope() {
    // Analytic: the wheel's speed against the rail jumps by v times the change of slope; the force swings by
    // v slope sqrt(k m) about the weight, and a damper on a rigid rail pushes at once with c v slope.
    let slope = 0.002;
    let rows = [[START, 0.0], [START + 20.0, 20.0 * slope]];
    for (damping, peak) in [
        (0.0, SPEED * slope * (K * MASS).sqrt()),
        (40.0, 40.0 * SPEED * slope),
    ] {
        let mut scene = mass(damping, START / SPEED + 0.4);
        scene.output_dt = START / SPEED / 500.0;
        let found = run(&scene, uneven(&rows, &[]));
        let force = found.history.column(Channel::Vertical(0));
        let rise = if damping == 0.0 {
            force.iter().fold(0.0, |max: f64, f| max.max(*f))
        } else {
            let [before, after] = [Side::Before, Side::After].map(|side| {
                found
                    .solution
                    .value(Channel::Vertical(0), START / SPEED, side)
            });
            assert!((before / (MASS * GRAVITY) - 1.0).abs() < 1e-9);
            assert_eq!(
                force[500], before,
                "a row at a jump has the values before it"
            );
            after
        };
        let rise = rise - MASS * GRAVITY;
        println!("corner: {rise} of {peak}");
        assert!((rise / peak - 1.0).abs() < if damping == 0.0 { 1e-4 } else { 1e-9 });
    }
}

#[test]
fn wheel_falls_off_a_step_and_lands() {
    // Analytic: free fall over h - m g/k, then F = m g + sqrt((m g)^2 + k m v^2) at most, v^2 = 2 g (h - m g/k).
    let (h, weight) = (0.5, MASS * GRAVITY);
    let fall = h - weight / K;
    let mut scene = mass(0.0, START / SPEED + 0.28);
    scene.wheels[0].normal.bilateral = false;
    scene.output_dt = 1e-4;
    let found = run(&scene, uneven(&[[START, 0.0], [START, -h]], &[]));
    let (t, force) = (
        found.history.column(Channel::Time),
        found.history.column(Channel::Vertical(0)),
    );
    let lands = START / SPEED + (2.0 * fall / GRAVITY).sqrt();
    let pressed = t
        .iter()
        .zip(&force)
        .find(|(t, f)| **t > START / SPEED + 1e-3 && **f > 0.0);
    let peak = force.iter().fold(0.0, |max: f64, f| max.max(*f));
    let expected = weight + (weight * weight + 2.0 * K * MASS * GRAVITY * fall).sqrt();
    println!(
        "lands {pressed:?}, {lands}; peak {peak} of {expected}; events {}",
        found.counts.events
    );
    assert!(pressed.is_some_and(|(t, _)| (0.0..1.01e-4).contains(&(t - lands))));
    assert!((peak / expected - 1.0).abs() < 1e-6);
    assert_eq!(found.counts.events, 2);
    assert!(found.audit.residual() < 1e-8);
}

#[test]
fn drive_lifts_the_weight_slowly_over_a_profile() {
    // Analytic: carried up h without swing, the drive does the work m g h; the spring holds what it held.
    let h = 0.2;
    let ends = |v: f64| {
        Profile::new(
            MotionKind::Speed,
            &[[0.0, 0.0], [1.0, v], [11.0, v], [12.0, 0.0]],
            0.0,
            0.0,
        )
    };
    let mut scene = mass(2.0 * (K * MASS).sqrt(), 14.0);
    scene.bodies[0].motion = Some(ends(1.0).expect("rows"));
    let rows: Vec<[f64; 2]> = (0..=64_i32)
        .map(|i| f64::from(i) / 64.0)
        .map(|s| {
            [
                2.0 + 7.0 * s,
                h * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
            ]
        })
        .collect();
    let found = run(&scene, uneven(&rows, &[]));
    let (work, lost) = (found.audit.exchanged.drives, found.audit.exchanged.dampers);
    println!(
        "drive: {work}, dampers {lost}, of {}, audit {:.2e}",
        MASS * GRAVITY * h,
        found.audit.residual()
    );
    assert!((work - lost - MASS * GRAVITY * h).abs() < 1e-7 * work);
    assert!(lost < 1e-3 * work && lost > 0.0);
    assert!(found.audit.residual() < 1e-8);
}

/// A bump of 1 - cos, as a polyline of `pieces`.
fn bump(height: f64, length: f64, pieces: u32) -> Vec<[f64; 2]> {
    let at = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(pieces);
    (0..=pieces)
        .map(|i| {
            [
                START + length * f64::from(i) / f64::from(pieces),
                0.5 * height * (1.0 - at(i).cos()),
            ]
        })
        .collect()
}

/// y and p at the end, by the classical Runge-Kutta method with `count` steps a piece between `corners`, of
/// m y'' = k p + c p' - m g, (k p + c p') G = y0(x) - y - p: an independent form of the same mechanics.
fn independent(c: f64, give: f64, rows: &[[f64; 2]], end: f64, count: u32) -> [f64; 3] {
    let rest = MASS * GRAVITY;
    let mut corners: Vec<f64> = rows.iter().map(|row| row[0] / SPEED).collect();
    corners.dedup();
    corners.insert(0, 0.0);
    corners.push(end);
    let mut s = [-rest / K - give * rest, 0.0, rest / K];
    for (piece, ends) in corners.windows(2).enumerate() {
        let middle = 0.5 * SPEED * (ends[0] + ends[1]);
        let next = rows.partition_point(|row| row[0] < middle);
        let height = |t: f64| match (next.checked_sub(1).map(|i| rows[i]), rows.get(next)) {
            (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (SPEED * t - x0) / (x1 - x0),
            (Some([_, y]), None) | (None, Some(&[_, y])) => y,
            (None, None) => 0.0,
        };
        let rate = |t: f64, s: [f64; 3]| {
            let force = (height(t) - s[0] - s[2]) / give;
            [s[1], force / MASS - GRAVITY, (force - K * s[2]) / c]
        };
        let steps = if piece == 0 || piece + 2 == corners.len() {
            100 * count
        } else {
            count
        };
        let h = (ends[1] - ends[0]) / f64::from(steps);
        for i in 0..steps {
            let t = ends[0] + h * f64::from(i);
            let add = |k: [f64; 3], by: f64| std::array::from_fn::<f64, 3, _>(|j| s[j] + by * k[j]);
            let k1 = rate(t, s);
            let k2 = rate(t + 0.5 * h, add(k1, 0.5 * h));
            let k3 = rate(t + 0.5 * h, add(k2, 0.5 * h));
            let k4 = rate(t + h, add(k3, h));
            for j in 0..3 {
                s[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
            }
        }
    }
    s
}

#[test]
fn bump_and_step_on_a_rail_that_gives_follow_an_independent_integration() {
    let (c, give, end) = (30.0, 4e-4, 1.5);
    let mut rows = bump(0.02, 2.0, 24);
    rows.extend([[START + 2.4, 0.0], [START + 2.4, -0.008]]);
    let mut scene = mass(c, end);
    scene.accuracy = 1e-8;
    let foundation = Foundation {
        irregularities: vec![Irregularity::new(&rows, &[]).expect("rows")],
        ..Foundation::massless(Box::new(Kernel(move |_, _| [give, 0.0])), 1)
    };
    let found = run(&scene, foundation);
    let (coarse, fine) = (
        independent(c, give, &rows, end, 400),
        independent(c, give, &rows, end, 800),
    );
    let last = |channel| found.history.column(channel).last().copied().unwrap_or(0.0);
    let (y, p) = (
        last(Channel::Displacement(0, BodyDof::Y)),
        last(Channel::Penetration(0)),
    );
    println!(
        "bump: y {y} {:?} {:?} p {p}, audit {:.2e}",
        fine,
        coarse,
        found.audit.residual()
    );
    assert!(
        (coarse[0] - fine[0]).abs() < 1e-10,
        "the reference has converged"
    );
    assert!((y - fine[0]).abs() < 2e-7 && (p - fine[2]).abs() < 2e-7);
    assert!(
        found.audit.residual() < 1e-8,
        "{:e}",
        found.audit.residual()
    );
}

/// Integral of f from a to b by Gauss's rule with four points.
fn gauss(f: impl Fn(f64) -> f64, [a, b]: [f64; 2]) -> f64 {
    let points = [
        [0.339981043584856, 0.652145154862546],
        [0.861136311594053, 0.347854845137454],
    ];
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    points
        .iter()
        .map(|[at, weight]| half * weight * (f(middle - half * at) + f(middle + half * at)))
        .sum()
}

#[test]
fn wheel_that_turns_back_meets_every_corner_of_a_long_profile_twice() {
    // Analytic: y(T) = omega times the integral of sin(omega (T - t)) y0(x(t)), by Gauss's rule between corners.
    let (height, omega, count) = (1e-3, (K / MASS).sqrt(), 400_u32);
    // x = 4 t - t^2 turns at x = 4, t = 2, between two rows.
    let rows: Vec<[f64; 2]> = (0..=count)
        .map(|i| {
            [
                0.497 + 0.01 * f64::from(i),
                height * f64::from(i * i % 17) / 17.0,
            ]
        })
        .chain([[4.51, 0.0]])
        .collect();
    let end = 4.0;
    let way = |t: f64| 4.0 * t - t * t;
    let out = rows
        .iter()
        .filter(|[x, _]| *x < 4.0)
        .map(|[x, _]| 2.0 - (4.0 - x).sqrt());
    let mut times: Vec<f64> = out
        .clone()
        .chain(out.map(|t| end - t))
        .chain([0.0, 2.0, end])
        .collect();
    times.sort_by(f64::total_cmp);
    let shape = |x: f64| {
        let next = rows.partition_point(|row| row[0] <= x);
        let (Some(&[x1, y1]), true) = (rows.get(next), next > 0) else {
            return 0.0;
        };
        let [x0, y0] = rows[next - 1];
        y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    };
    let part = |t: f64| omega * (omega * (end - t)).sin() * shape(way(t));
    let exact: f64 = times
        .windows(2)
        .map(|ends| gauss(part, [ends[0], ends[1]]))
        .sum();
    for (accuracy, allowed) in [(1e-9, 1e-6), (1e-4, 1e-3)] {
        let mut scene = mass(0.0, end);
        scene.bodies[0].motion = Some(
            Profile::new(MotionKind::Speed, &[[0.0, 4.0], [end, -4.0]], 0.0, 0.0).expect("rows"),
        );
        scene.accuracy = accuracy;
        let found = run(&scene, uneven(&rows, &[]));
        let y = found.history.column(Channel::Displacement(0, BodyDof::Y));
        let off = (y[y.len() - 1] - y[0] - exact).abs();
        println!("out and back: {off:.2e} of {exact:.3e}, {:?}", found.counts);
        assert!(off < allowed * height, "{off:e}");
    }
}

#[test]
fn steps_between_corners_keep_order_four() {
    let (slope, omega) = (0.004, (K / MASS).sqrt());
    let rows = [[START, 0.0], [START + 15.0, 15.0 * slope]];
    let measured: Vec<[f64; 2]> = [1e-5, 1e-7, 1e-9]
        .map(|accuracy| {
            let mut scene = mass(0.0, 5.0);
            scene.accuracy = accuracy;
            let found = sim::run_by(Method::Sdirk4, &scene, &[uneven(&rows, &[])], &mut |_| {
                ControlFlow::Continue(())
            });
            let found = found.expect("a valid scene");
            let last = found.history.column(Channel::Displacement(0, BodyDof::Y));
            let t = 5.0 - START / SPEED;
            let exact = slope * SPEED * (t - (omega * t).sin() / omega) - MASS * GRAVITY / K;
            [
                found.counts.steps as f64,
                (last.last().copied().unwrap_or(0.0) - exact).abs(),
            ]
        })
        .to_vec();
    let order = |a: [f64; 2], b: [f64; 2]| (a[1] / b[1]).ln() / (b[0] / a[0]).ln();
    println!(
        "orders {:.2} {:.2}, {measured:?}",
        order(measured[0], measured[1]),
        order(measured[1], measured[2])
    );
    assert!((3.6..4.6).contains(&order(measured[0], measured[2])));
}

#[test]
fn wheel_that_rolls_up_a_ramp_pays_for_it_with_its_speed() {
    // Analytic: on a stiff wheel m v^2/2 + m g y is constant up to the little that is left in the spring.
    let height = 0.3;
    let mut scene = mass(0.0, 4.0);
    let body = &mut scene.bodies[0];
    (body.motion, body.free[0], body.start_speed[0]) = (None, true, 5.0);
    scene.wheels[0].normal.stiffness = 1e5;
    let found = run(
        &scene,
        uneven(
            &[[2.0, 0.0], [8.0, height], [9.0, height], [12.0, 0.0]],
            &[],
        ),
    );
    let (x, v) = (
        found.history.column(Channel::Displacement(0, BodyDof::X)),
        found.history.column(Channel::Speed(0, BodyDof::X)),
    );
    let top = x
        .iter()
        .zip(&v)
        .find(|(x, _)| **x > 8.5)
        .map_or(0.0, |(_, v)| *v);
    println!(
        "free: top {top}, end {:?}, audit {:.2e}",
        v.last(),
        found.audit.residual()
    );
    assert!((top - (25.0 - 2.0 * GRAVITY * height).sqrt()).abs() < 5e-3 * top);
    assert!(x.last().is_some_and(|x| *x > 12.0));
    assert!(v.last().is_some_and(|v| (v - 5.0).abs() < 5e-3 * 5.0));
    assert!(
        found.audit.imbalance < 1e-8 * 0.5 * MASS * 25.0,
        "{:e}",
        found.audit.imbalance
    );
}

/// Identity: collocation and stages integrate the same motion over a joint, a step and waves, on rails that give, with
/// and without dampers, and with a law that is not linear.
#[test]
fn collocation_and_stages_agree_on_uneven_rails() {
    let rows = [
        [START, 0.0],
        [START + 0.3, -0.004],
        [START + 0.6, 0.0],
        [3.0, 0.0],
        [3.0, 0.003],
    ];
    let wave = Wave {
        amplitude: 2e-3,
        length: 0.7,
        phase: 0.4,
        range: [0.2, 5.0],
    };
    let swell = Irregularity::wave(Axis::Vertical, wave).expect("a range");
    let shape = Irregularity::new(&rows, &[])
        .expect("rows in order")
        .plus(&swell);
    let foundation = || Foundation {
        irregularities: vec![shape.clone()],
        ..Foundation::massless(Box::new(Kernel(|_, _| [4e-4, 0.0])), 1)
    };
    for (damping, damper, exponent) in [
        (0.0, Damper::Rail, 1.0),
        (20.0, Damper::Ground, 1.0),
        (20.0, Damper::Rail, 1.0),
        (0.0, Damper::Rail, 1.5),
        (20.0, Damper::Ground, 1.5),
        (20.0, Damper::Rail, 1.3),
    ] {
        let mut scene = mass(damping, 1.8);
        let law = &mut scene.wheels[0].normal;
        (law.damper, law.exponent, law.bilateral) = (damper, exponent, false);
        law.stiffness = MASS * GRAVITY / (MASS * GRAVITY / K).powf(exponent);
        law.depth = if exponent > 1.0 {
            0.5 * MASS * GRAVITY / K
        } else {
            0.0
        };
        let by = |method, accuracy| {
            let scene = Scene {
                accuracy,
                ..scene.clone()
            };
            let run = sim::run_by(method, &scene, &[foundation()], &mut |_| {
                ControlFlow::Continue(())
            });
            run.expect("a valid scene")
        };
        let (nodes, stages) = (by(Method::Radau, 1e-8), by(Method::Sdirk4, 1e-9));
        for channel in [
            Channel::Displacement(0, BodyDof::Y),
            Channel::Vertical(0),
            Channel::Penetration(0),
        ] {
            let [a, b] = [&nodes, &stages].map(|run| run.history.column(channel));
            let size = b.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
            let off = a
                .iter()
                .zip(&b)
                .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
            println!(
                "{damper:?} {damping}, exponent {exponent}, {channel:?}: {:.1e}",
                off / size
            );
            assert!(
                off <= 1e-6 * size,
                "{damper:?} {damping}, exponent {exponent}, {channel:?}: {off}"
            );
        }
        assert!(nodes.counts.steps < stages.counts.steps);
    }
}
