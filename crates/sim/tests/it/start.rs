//! The first sample of a run: forces, penetrations and all other channels are those of the motion that begins.

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::modes::{MASS, beam, omega};
use common::{SPAN, WEIGHT, bogie, girder, surface};
use sim::{
    Channel, Contact, Damper, Foundation, Gauge, Method, MotionKind, Profile, Run, Scene, Status,
    run_by,
};
use splines::{Axis, Probe};

fn go(method: Method, scene: &Scene, foundation: Foundation) -> Run {
    let run = run_by(method, scene, &[foundation], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// The bogie from `x0` on, with dampers between wheel and rail and a gauge.
fn moving(x0: f64, speed: f64, end: f64) -> Scene {
    let mut scene = bogie(speed, end, Damper::Rail);
    scene.bodies[0].motion =
        Some(Profile::new(MotionKind::Speed, &[[0.0, speed]], x0, 0.0).expect("a valid table"));
    scene.gauges = vec![Gauge {
        structure: 0,
        probe: Probe {
            rail: 0,
            x: 31.0,
            axis: Axis::Vertical,
        },
    }];
    scene.accuracy = 1e-8;
    scene
}

/// Analytic: each wheel carries half of the weight, the modes are at rest under both wheels, q_r = sum of F phi_r(x) /
/// omega_r^2, and the rail below a wheel at speed v falls away by v w', where w' is the slope of the deflection.
#[test]
fn the_first_force_of_a_damper_contains_the_slope_of_a_rail_with_mass() {
    let (x0, speed, count) = (14.0, 80.0, 12);
    let places = [x0 - 4.0 / 3.0, x0 + 4.0 / 3.0];
    let wave = |r: usize| r as f64 * PI / SPAN;
    let slope = |x: f64| -> f64 {
        let of = |r: usize| {
            let load: f64 = places
                .iter()
                .map(|place| 0.5 * WEIGHT * (wave(r) * place).sin())
                .sum();
            2.0 / (MASS * SPAN) * load / omega(r).powi(2) * wave(r) * (wave(r) * x).cos()
        };
        (1..=count).map(of).sum()
    };
    for method in [Method::Radau, Method::Sdirk4] {
        let run = go(method, &moving(x0, speed, 0.01), beam(count, false));
        for (w, x) in places.into_iter().enumerate() {
            let force = run.history.column(Channel::Vertical(w))[0];
            let depth = run.history.column(Channel::Penetration(w))[0];
            let wanted = 0.5 * WEIGHT - 1e5 * speed * slope(x);
            assert!(
                (wanted - 0.5 * WEIGHT).abs() > 1e4,
                "the damper matters: {wanted}"
            );
            assert!(
                (force / wanted - 1.0).abs() < 1e-11,
                "{method:?}, wheel {w}: {force} for {wanted}"
            );
            assert!(
                (depth / (0.5 * WEIGHT / 1e8) - 1.0).abs() < 1e-11,
                "{depth}"
            );
        }
    }
}

type Named = (&'static str, fn() -> Foundation);

/// Identity: each channel is continuous where the run begins, so that its first sample is the limit of the others.
#[test]
fn every_first_sample_is_the_limit_of_those_after_it() {
    let foundations: [Named; 4] = [
        ("exact", || Foundation::massless(Box::new(surface()), 1)),
        ("closed form", girder),
        ("modes", || beam(8, false)),
        ("modes and the rest", || beam(3, true)),
    ];
    for (name, foundation) in foundations {
        for speed in [5.0, 100.0] {
            for method in [Method::Radau, Method::Sdirk4] {
                let mut scene = moving(14.0, speed, 2e-6);
                scene.output_dt = 5e-7;
                let early = go(method, &scene, foundation());
                (scene.end, scene.output_dt) = (0.2, 1e-3);
                let whole = go(method, &scene, foundation());
                for &channel in early.history.channels() {
                    let column = early.history.column(channel);
                    let size = whole
                        .history
                        .values(channel)
                        .fold(0.0_f64, |max, value| max.max(value.abs()));
                    let limit = 3.0 * column[1] - 3.0 * column[2] + column[3];
                    assert!(
                        (column[0] - limit).abs() <= 1e-4 * size,
                        "{name}, {speed} ft/s, {method:?}, {channel:?}: {} for {limit}",
                        column[0]
                    );
                }
            }
        }
    }
}

/// Third-order difference quotient of the rate at the first of four samples `h` apart.
fn rate_at_first(column: &[f64], h: f64) -> f64 {
    (-11.0 * column[0] + 18.0 * column[1] - 9.0 * column[2] + 2.0 * column[3]) / (6.0 * h)
}

/// Identity: in the first row, as in every other, F = k p + c p' with the recorded penetration and its rate, on
/// rigid rails, on rails with mass and on rails without. A rail without mass has w = G F at every instant and rests
/// with p' = 0: the part c v w' would violate the law there by 4e-3 of the force.
#[test]
fn the_contact_law_holds_in_the_first_row_on_every_foundation_by_every_method() {
    let foundations: [Named; 5] = [
        ("rigid", Foundation::rigid),
        ("exact", || Foundation::massless(Box::new(surface()), 1)),
        ("closed form", girder),
        ("modes", || beam(8, false)),
        ("modes and the rest", || beam(3, true)),
    ];
    let (k, c, h) = (1e8, 1e5, 2e-7);
    for (name, foundation) in foundations {
        for speed in [5.0, 100.0] {
            for method in [Method::Auto, Method::Radau, Method::Sdirk4] {
                let mut scene = moving(14.0, speed, 8.0 * h);
                if name == "rigid" {
                    scene.gauges.clear();
                }
                scene.bodies[0].start_speed[5] = 0.01;
                scene.output_dt = h;
                let run = go(method, &scene, foundation());
                for w in 0..2 {
                    let force = run.history.column(Channel::Vertical(w));
                    let depth = run.history.column(Channel::Penetration(w));
                    for row in 0..5 {
                        let law = k * depth[row] + c * rate_at_first(&depth[row..], h);
                        // The later rows are interpolated; the quotient multiplies their relative errors by 1.5e4.
                        assert!(
                            (force[row] / law - 1.0).abs() < 5e-6,
                            "{name}, {speed} ft/s, {method:?}, wheel {w}, row {row}: {} for {law}",
                            force[row]
                        );
                    }
                }
            }
        }
    }
}

/// Analytic: a rail without mass has the force F = (e - p)/G, and p' = (F - k p)/c is zero at rest. Where a wheel begins
/// to move from rest, p and e cannot jump, so that F is the static force, and its rate is -v F (dG/dx)/G. The force
/// approaches that of the moving wheel with the time constant T = c G/(1 + k G) of the damper on this rail.
#[test]
fn a_rail_without_mass_keeps_its_deflection_for_an_instant_and_its_force_begins_at_rest() {
    let (x0, speed, k, c) = (14.0, 100.0, 1e8, 1e5);
    let mut scene = moving(x0, speed, 1e-3);
    scene.gauges.clear();
    scene.bodies[0].free = [false, true, false, false, false, false];
    scene.bodies[0].mass *= 0.5;
    scene.contacts = vec![common::single()];
    let load = 0.5 * WEIGHT;
    let compliance = common::give(x0, x0).0;
    let slope = 2.0 * common::give(x0, x0).1;
    let constant = c * compliance / (1.0 + k * compliance);
    scene.end = constant;
    scene.output_dt = 0.05 * constant;
    let run = go(
        Method::Radau,
        &scene,
        Foundation::massless(Box::new(surface()), 1),
    );
    let force = run.history.column(Channel::Vertical(0));
    let rate = rate_at_first(&force, scene.output_dt);
    assert!((force[0] / load - 1.0).abs() < 1e-11, "{}", force[0]);
    let wanted = -speed * slope * load / compliance;
    assert!((rate / wanted - 1.0).abs() < 1e-2, "{rate} for {wanted}");
    assert!((rate * constant / load).abs() > 1e-3, "the damper matters");
}

/// Analytic: a wheel that falls onto its damper at the start presses with k p + c v.
#[test]
fn the_first_force_of_a_falling_wheel_contains_its_speed() {
    let mut scene = bogie(0.0, 0.01, Damper::Rail);
    scene.bodies[0].start_speed[1] = -0.5;
    let run = go(Method::Auto, &scene, Foundation::rigid());
    let force = run.history.column(Channel::Vertical(0))[0];
    let wanted = 0.5 * WEIGHT + 1e5 * 0.5;
    assert!((force / wanted - 1.0).abs() < 1e-12, "{force} for {wanted}");
}

/// Analytic: wheels placed into the top of a rail without mass at rest find it undeflected, p + G F = e with F = 0. Their springs
/// and dampers relax by p' = -r = -k p^e/c, and the forces grow by F' with G F' = r where they press. Of three wheels close to
/// each other the middle one would have to pull: it opens at once, and the other two carry r/(G11 + G13) t each.
#[test]
fn of_wheels_placed_below_their_rail_those_press_that_need_not_pull() {
    let (x0, apart, depth) = (30.0, 2.0, 0.01);
    for exponent in [1.0, 1.1, 1.5] {
        let mut scene = moving(x0, 0.0, 1e-6);
        scene.accuracy = 1e-4;
        scene.gauges.clear();
        scene.bodies[0].free = [false, true, false, false, false, true];
        scene.bodies[0].start[1] = -depth;
        let law = &mut scene.wheels[0].normal;
        (law.exponent, law.depth) = (exponent, if exponent == 1.0 { 0.0 } else { 1e-3 });
        let rate = law.spring(depth) / law.damping;
        scene.contacts = [-apart, 0.0, apart]
            .map(|x| Contact {
                at: [x, 0.0, 0.0],
                ..common::single()
            })
            .into();
        let run = go(Method::Auto, &scene, girder());
        let [own, other] = [x0 - apart, x0 + apart].map(|x| common::give(x0 - apart, x).0);
        let wanted = [rate / (own + other) * scene.end, 0.0];
        for (wheel, wanted) in [(0, wanted[0]), (1, wanted[1]), (2, wanted[0])] {
            let force = run.history.column(Channel::Vertical(wheel));
            let last = force[force.len() - 1];
            assert!(
                (last - wanted).abs() < 1e-3 * rate / own * scene.end,
                "{exponent} {wheel}: {last} for {wanted}"
            );
        }
    }
}

/// Analytic: each wheel of two bodies carries half of its body, whatever its law, and F = k p^e. With penetrations a
/// hundred-thousandth of the deflection, which keep the rounding of it, they find their places at rest as well.
#[test]
fn wheels_much_stiffer_than_their_rail_are_at_rest() {
    for x0 in [3.0, 11.7, 22.2, 29.9] {
        for exponent in [1.1, 1.5, 2.2] {
            let mut scene = moving(x0, 0.0, 1e-6);
            let law = &mut scene.wheels[0].normal;
            (law.stiffness, law.exponent, law.damping) =
                (0.5 * WEIGHT / 5e-6_f64.powf(exponent), exponent, 0.0);
            let mut second = scene.bodies[0].clone();
            second.motion = Some(
                Profile::new(MotionKind::Speed, &[[0.0, 0.0]], x0 + 17.3, 0.0)
                    .expect("a valid table"),
            );
            scene.bodies.push(second);
            let others: Vec<_> = scene
                .contacts
                .iter()
                .map(|own| sim::Contact {
                    body: 1,
                    ..own.clone()
                })
                .collect();
            scene.contacts.extend(others);
            let run = go(
                Method::Sdirk4,
                &scene,
                Foundation::massless(Box::new(surface()), 1),
            );
            for w in 0..4 {
                let force = run.history.column(Channel::Vertical(w))[0];
                let depth = run.history.column(Channel::Penetration(w))[0];
                assert!(
                    (force / (0.5 * WEIGHT) - 1.0).abs() < 1e-9,
                    "{x0}, {exponent}: {force}"
                );
                assert!(
                    (depth / 5e-6 - 1.0).abs() < 1e-9,
                    "{x0}, {exponent}: {depth}"
                );
            }
        }
    }
}
