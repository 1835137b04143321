//! Structures in their natural modes: loads that cross a simply supported beam, against series and converged
//! references.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::modes::{MASS, beam, oscillator};
use common::near::assert_near;
use common::{EI, SPAN};
use sim::{Channel, Foundation, Method, Scene, Status, run_by};

/// Midspan deflection, positive down, by W L^3 / 48 EI; wheel force by W; deflection under the wheel.
struct Crossing {
    middle: Vec<f64>,
    force: Vec<f64>,
    under: Vec<f64>,
}

fn cross(scene: &Scene, foundation: Foundation) -> Crossing {
    let run =
        sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    let weight = scene.bodies[0].mass * scene.gravity;
    let static_sag = weight * SPAN.powi(3) / (48.0 * EI);
    let scaled = |channel, scale: f64| {
        run.history
            .column(channel)
            .iter()
            .map(|x| x / scale)
            .collect()
    };
    Crossing {
        middle: scaled(Channel::Gauge(0), -static_sag),
        force: scaled(Channel::Vertical(0), weight),
        under: scaled(Channel::Deflection(0), static_sag),
    }
}

/// Largest value, on the parabola through the largest sample and its neighbours.
fn largest(values: &[f64]) -> f64 {
    let peak = (1..values.len() - 1)
        .max_by(|&i, &j| values[i].total_cmp(&values[j]))
        .unwrap_or(1);
    let (a, b, c) = (values[peak - 1], values[peak], values[peak + 1]);
    if b <= a || b <= c {
        return b.max(values[0]).max(values[values.len() - 1]);
    }
    b - (c - a).powi(2) / (8.0 * (a - 2.0 * b + c))
}

fn smallest(values: &[f64]) -> f64 {
    let mirrored: Vec<f64> = values.iter().map(|value| -value).collect();
    -largest(&mirrored)
}

fn close(what: &str, found: f64, wanted: f64, relative: f64) {
    println!(
        "{what}: {found:.10} for {wanted:.10}, {:.1e}",
        (found / wanted - 1.0).abs()
    );
    assert!(
        (found / wanted - 1.0).abs() < relative,
        "{what}: {found} for {wanted}"
    );
}

/// Analytic: the series of a constant force (Fryba, Vibration of Solids and Structures under Moving Loads, ch. 1).
/// The force is the weight of a mass of 1e-9 of the beam's: its inertia is worth 2e-9 of it.
#[test]
fn moving_force_meets_the_series() {
    let mut scene = oscillator(1e-9, 5e4, 0.25);
    scene.gravity *= 1e9;
    let found = cross(&scene, beam(20, true));
    close(
        "largest",
        largest(&found.middle),
        1.257_609_790_901_753_8,
        1e-6,
    );
    close("at 1/4", found.middle[500], 0.733_895_997_532_694_5, 1e-6);
    close("at 1/2", found.middle[1000], 1.065_792_021_930_880_7, 1e-6);
    close("at 3/4", found.middle[1500], 0.733_895_997_532_694_5, 1e-6);
}

/// External: converged reference of a sprung mass, 32 against 40 modes to 5e-9.
#[test]
fn moving_oscillator_meets_the_converged_reference() {
    let found = cross(&oscillator(0.5, 0.5, 0.25), beam(20, true));
    close(
        "largest",
        largest(&found.middle),
        1.218_222_263_802_929,
        1e-6,
    );
    close("at 1/2", found.middle[1000], 0.887_956_623_906_926_9, 1e-6);
    close("at 3/4", found.middle[1500], 1.216_006_290_951_369_1, 1e-6);
    close("under", found.under[1000], 0.887_956_623_906_928_1, 1e-6);
    close(
        "largest force",
        largest(&found.force),
        1.267_684_240_703_683_2,
        1e-6,
    );
    close(
        "smallest force",
        smallest(&found.force),
        0.834_297_226_615_525_9,
        1e-6,
    );
}

/// External: converged reference of a mass that stays on the beam, with all convective terms.
#[test]
fn moving_mass_meets_the_converged_reference() {
    let mut scene = oscillator(0.5, 3000.0, 0.25);
    scene.accuracy = 1e-7;
    let found = cross(&scene, beam(40, true));
    close(
        "largest",
        largest(&found.middle),
        1.417_897_987_569_308_3,
        1e-5,
    );
    close("at 1/4", found.middle[500], 0.618_221_494_000_048_7, 1e-5);
    close("at 1/2", found.middle[1000], 1.416_432_087_649_909_5, 1e-5);
    close("at 3/4", found.middle[1500], 0.665_269_664_277_970_4, 1e-5);
    close(
        "under at 3/4",
        found.under[1500],
        0.548_799_577_982_933_2,
        1e-5,
    );
}

/// Published in the reference with the same definition: errors of the wheel force and of the midspan deflection over
/// the crossing, against 60 modes with the rest. Pure modes need five times as many as modes with the static give
/// of the others.
#[test]
fn static_give_of_the_other_modes_is_worth_several_modes() {
    let scene = oscillator(0.5, 0.5, 0.1);
    let reference = cross(&scene, beam(40, true));
    for (modes, rest, force, middle) in [
        (1, false, 2.5e-2, 1.5e-2),
        (5, false, 4.3e-4, 9.1e-4),
        (20, false, 8.0e-6, 1.7e-5),
        (0, true, 3.3e-2, 9.7e-2),
        (1, true, 8.9e-4, 5.3e-4),
        (3, true, 3.4e-5, 3.5e-5),
        (5, true, 4.8e-6, 7.2e-6),
    ] {
        let [found_force, found_middle] = errors(&cross(&scene, beam(modes, rest)), &reference);
        let of = |what: &str| {
            format!(
                "mass 0.5 m L, alpha 0.1, {}: error of {what}",
                named(modes, rest)
            )
        };
        assert_near(
            of("the wheel's force"),
            "prototype",
            force,
            found_force,
            0.1,
        );
        assert_near(of("midspan"), "prototype", middle, found_middle, 0.1);
    }
}

fn named(modes: usize, rest: bool) -> String {
    format!(
        "{modes} modes {} the others' static give",
        if rest { "with" } else { "without" }
    )
}

/// Largest errors over a crossing: of the force by the weight, of midspan by its largest.
fn errors(found: &Crossing, reference: &Crossing) -> [f64; 2] {
    let of = |a: &[f64], b: &[f64]| {
        a.iter()
            .zip(b)
            .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()))
    };
    [
        of(&found.force, &reference.force),
        of(&found.middle, &reference.middle) / largest(&reference.middle),
    ]
}

/// A carriage of five beams on springs three times as fast as the beam; a wheel as stiff under half a beam.
#[test]
fn heavy_and_stiff_wheels_need_modes_beyond_their_own_frequency() {
    let scene = oscillator(5.0, 3.0, 0.05);
    let reference = cross(&scene, beam(30, true));
    for (modes, known) in [(1, 0.08), (2, 0.14), (3, 0.13), (5, 0.018)] {
        let found = errors(&cross(&scene, beam(modes, true)), &reference);
        let what = format!(
            "mass 5 m L on springs of 3 omega_1, alpha 0.05, {}: error of the wheel's force",
            named(modes, true)
        );
        assert_near(what, "prototype", known, found[0], 0.1);
    }
    let scene = oscillator(0.5, 3.0, 0.25);
    let reference = cross(&scene, beam(40, true));
    for (rest, force, middle) in [(false, 3.2e-2, 1.4e-3), (true, 4.1e-4, 1.7e-5)] {
        let found = errors(&cross(&scene, beam(5, rest)), &reference);
        let of = |what: &str| {
            format!(
                "mass 0.5 m L on springs of 3 omega_1, alpha 0.25, {}: error of {what}",
                named(5, rest)
            )
        };
        assert_near(of("the wheel's force"), "prototype", force, found[0], 0.05);
        assert_near(of("midspan"), "prototype", middle, found[1], 0.05);
    }
}

/// Two modes more tell the error of a run: their difference by the error, over 24 runs.
#[test]
fn two_modes_more_tell_the_error() {
    let mut range = [[f64::INFINITY, 0.0_f64]; 2];
    for alpha in [0.05, 0.1, 0.25] {
        for (mass, frequency) in [(0.2, 0.5), (0.2, 1.0), (0.5, 0.5), (0.5, 1.0)] {
            let scene = oscillator(mass, frequency, alpha);
            let reference = cross(&scene, beam(24, true));
            for modes in [1, 3] {
                let own = cross(&scene, beam(modes, true));
                let estimate = errors(&own, &cross(&scene, beam(modes + 2, true)));
                let error = errors(&own, &reference);
                for ((range, estimate), error) in range.iter_mut().zip(estimate).zip(error) {
                    *range = [
                        range[0].min(estimate / error),
                        range[1].max(estimate / error),
                    ];
                }
            }
        }
    }
    for (what, known, found) in [
        ("midspan", [0.84, 1.11], range[1]),
        ("the wheel's force", [0.91, 1.12], range[0]),
    ] {
        for (word, known, found) in [("least", known[0], found[0]), ("most", known[1], found[1])] {
            // other runs than the prototype's 24
            assert_near(
                format!("error told by two modes more, by the true one, {what}, {word} of 24 runs"),
                "prototype",
                known,
                found,
                0.07,
            );
        }
    }
}

/// Largest difference from rest under a constant force that crosses, beside alpha / (1 - alpha), which bounds it.
#[test]
fn a_moving_force_differs_from_rest_by_less_than_alpha_tells() {
    for (alpha, known) in [
        (0.01, 0.009_92),
        (0.05, 0.0517),
        (0.1, 0.1090),
        (0.2, 0.2378),
        (0.25, 0.3227),
        (0.5, 0.8986),
    ] {
        let mut scene = oscillator(1e-9, 5e4, alpha);
        scene.gravity *= 1e9;
        scene.accuracy = 1e-6;
        let found = cross(&scene, beam(20, true));
        let rest = |i: usize| {
            let x = SPAN * i as f64 / (found.middle.len() - 1) as f64;
            common::give(0.5 * SPAN, x).0 / common::give(0.5 * SPAN, 0.5 * SPAN).0
        };
        let worst = (0..found.middle.len())
            .fold(0.0_f64, |max, i| max.max((found.middle[i] - rest(i)).abs()));
        assert_near(
            format!("constant force, alpha {alpha}: largest difference from rest at midspan"),
            "prototype",
            known,
            worst,
            1e-3,
        );
        assert!(worst < alpha / (1.0 - alpha));
    }
}

/// The paper's girder of 850 lb/ft under its bogie; how far it bends.
#[test]
fn the_papers_girder_has_its_frequencies_and_sag() {
    let mass = 850.0 / 32.174;
    let omega = (std::f64::consts::PI / SPAN).powi(2) * (EI / mass).sqrt();
    assert_near(
        "paper's girder, 850 lb/ft: first frequency, Hz",
        "prototype",
        17.22,
        omega / (2.0 * std::f64::consts::PI),
        1e-3,
    );
    let alpha = 5.0 * std::f64::consts::PI / (SPAN * omega);
    assert_near("alpha at 5 ft/s", "prototype", 0.002_42, alpha, 2e-3);
    let mut bogie = common::bogie(0.0, 1.0, sim::Damper::Ground);
    bogie.bodies[0].start[0] = 0.5 * SPAN;
    bogie.bodies[0].motion = None;
    let modes = sim::natural_modes(&bogie, &[common::girder()], 0.0, &[0.5 * SPAN])
        .expect("at rest")
        .expect("few");
    assert_near(
        "(omega_b / omega_1)^2 of the bogie at midspan",
        "prototype",
        0.0050,
        (modes[0].omega / omega).powi(2),
        0.02,
    );

    let load = common::WEIGHT;
    let slope = load * common::give(0.0, 0.5 * SPAN).1;
    assert_near(
        "slope of the girder's end under 4.8e6 lb at midspan",
        "prototype",
        0.0262,
        slope,
        2e-3,
    );
    assert_near(
        "1 - cos of it",
        "prototype",
        3.4e-4,
        1.0 - slope.cos(),
        0.02,
    );
    let steps = 6000;
    let h = SPAN / f64::from(steps);
    let along = |i: i32| common::give(h * (f64::from(i) + 0.5), 0.5 * SPAN).1 * load;
    let shortening: f64 = (0..steps).map(|i| 0.5 * along(i).powi(2) * h).sum();
    assert_near(
        "how far its ends approach, ft; (pi^2 / 4) sag^2 / L, of a sine",
        "prototype",
        0.0113,
        shortening,
        0.03,
    );
}

/// Analytic: largest midspan deflection under a constant force, by its static one.
#[test]
fn moving_force_meets_the_series_at_every_speed() {
    for (alpha, factor) in [
        (0.1, 1.0965),
        (0.2, 1.0653),
        (0.25, 1.2576),
        (0.5, 1.7054),
        (0.617, 1.7317),
        (1.0, 1.5481),
        (1.5, 1.0238),
        (2.0, 0.6710),
    ] {
        let mut scene = oscillator(1e-9, 5e4, alpha);
        scene.gravity *= 1e9;
        scene.accuracy = 1e-6;
        let found = cross(&scene, beam(10, true));
        close(
            &format!("alpha {alpha}"),
            largest(&found.middle),
            factor,
            1e-4,
        );
    }
}

/// External: converged reference, all convective terms, the mass half of the beam's; where the force pulls the
/// wheel stays on the beam.
#[test]
fn moving_mass_meets_the_reference_at_every_speed() {
    for (alpha, factor) in [(0.1, 1.0722), (0.25, 1.4179), (0.5, 2.0221), (0.75, 2.2308)] {
        let mut scene = oscillator(0.5, 1000.0, alpha);
        scene.accuracy = 1e-6;
        let found = cross(&scene, beam(20, true));
        close(
            &format!("alpha {alpha}"),
            largest(&found.middle),
            factor,
            1e-4,
        );
    }
}

/// Self-consistent: the accelerations of the modes of an undamped beam, of which reactions are sums, err by no more than a hundred
/// times the accuracy relative to the load of each mode, up to the last row.
#[test]
fn accelerations_of_high_modes_are_within_a_hundred_times_the_accuracy() {
    for (alpha, frequency) in [(0.15, 2.0), (0.35, 0.8), (0.6, 3.0)] {
        let scene = oscillator(0.1, frequency, alpha);
        let count = 60;
        let accelerations = |accuracy: f64| {
            let (scene, recorded) = (
                Scene {
                    accuracy,
                    ..scene.clone()
                },
                Foundation {
                    recorded: true,
                    ..beam(count, false)
                },
            );
            let run = run_by(Method::Radau, &scene, &[recorded], &mut |_| {
                ControlFlow::Continue(())
            })
            .expect("a valid scene");
            (0..count)
                .map(|k| run.history.column(Channel::Acceleration(0, k)))
                .collect::<Vec<_>>()
        };
        let (found, fine) = (accelerations(1e-5), accelerations(1e-9));
        let load = (2.0 / (MASS * SPAN)).sqrt() * 0.1 * MASS * SPAN * 32.174;
        let apart = |a: &[f64], b: &[f64]| {
            a.iter()
                .zip(b)
                .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
        };
        let worst = found
            .iter()
            .zip(&fine)
            .map(|(a, b)| apart(a, b) / load)
            .fold(0.0, f64::max);
        println!("alpha {alpha}: {worst:.1e}");
        assert!(worst < 100.0 * 1e-5, "alpha {alpha}: {worst:e}");
    }
}
