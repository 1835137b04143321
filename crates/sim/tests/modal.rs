//! Structures in their natural modes: loads that cross a simply supported beam, against series and converged
//! references.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod common;

use std::ops::ControlFlow;

use common::modes::{beam, oscillator};
use common::{EI, SPAN};
use sim::{Channel, Foundation, Scene, Status};

/// Midspan deflection, positive down, by W L^3 / 48 EI; wheel force by W; deflection under the wheel.
struct Crossing {
    middle: Vec<f64>,
    force: Vec<f64>,
    under: Vec<f64>,
}

fn cross(scene: &Scene, foundation: Foundation) -> Crossing {
    let run = sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    let weight = scene.bodies[0].mass * scene.gravity;
    let static_sag = weight * SPAN.powi(3) / (48.0 * EI);
    let scaled = |channel, scale: f64| run.history.column(channel).iter().map(|x| x / scale).collect();
    Crossing {
        middle: scaled(Channel::Gauge(0), -static_sag),
        force: scaled(Channel::Vertical(0), weight),
        under: scaled(Channel::Give(0), static_sag),
    }
}

/// Largest value, on the parabola through the largest sample and its neighbours.
fn largest(values: &[f64]) -> f64 {
    let peak = (1..values.len() - 1).max_by(|&i, &j| values[i].total_cmp(&values[j])).unwrap_or(1);
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
    println!("{what}: {found:.10} for {wanted:.10}, {:.1e}", (found / wanted - 1.0).abs());
    assert!((found / wanted - 1.0).abs() < relative, "{what}: {found} for {wanted}");
}

/// Analytic: the series of a constant force (Fryba, Vibration of Solids and Structures under Moving Loads, ch. 1).
/// The force is the weight of a mass of 1e-9 of the beam's: its inertia is worth 2e-9 of it.
#[test]
fn moving_force_meets_the_series() {
    let mut scene = oscillator(1e-9, 5e4, 0.25);
    scene.gravity *= 1e9;
    let found = cross(&scene, beam(20, true));
    close("largest", largest(&found.middle), 1.257_609_790_901_753_8, 1e-6);
    close("at 1/4", found.middle[500], 0.733_895_997_532_694_5, 1e-6);
    close("at 1/2", found.middle[1000], 1.065_792_021_930_880_7, 1e-6);
    close("at 3/4", found.middle[1500], 0.733_895_997_532_694_5, 1e-6);
}

/// External: converged reference of a sprung mass, 32 against 40 modes to 5e-9.
#[test]
fn moving_oscillator_meets_the_converged_reference() {
    let found = cross(&oscillator(0.5, 0.5, 0.25), beam(20, true));
    close("largest", largest(&found.middle), 1.218_222_263_802_929, 1e-6);
    close("at 1/2", found.middle[1000], 0.887_956_623_906_926_9, 1e-6);
    close("at 3/4", found.middle[1500], 1.216_006_290_951_369_1, 1e-6);
    close("under", found.under[1000], 0.887_956_623_906_928_1, 1e-6);
    close("largest force", largest(&found.force), 1.267_684_240_703_683_2, 1e-6);
    close("smallest force", smallest(&found.force), 0.834_297_226_615_525_9, 1e-6);
}

/// External: converged reference of a mass that stays on the beam, with all convective terms.
#[test]
fn moving_mass_meets_the_converged_reference() {
    let mut scene = oscillator(0.5, 3000.0, 0.25);
    scene.accuracy = 1e-7;
    let found = cross(&scene, beam(40, true));
    close("largest", largest(&found.middle), 1.417_897_987_569_308_3, 1e-5);
    close("at 1/4", found.middle[500], 0.618_221_494_000_048_7, 1e-5);
    close("at 1/2", found.middle[1000], 1.416_432_087_649_909_5, 1e-5);
    close("at 3/4", found.middle[1500], 0.665_269_664_277_970_4, 1e-5);
    close("under at 3/4", found.under[1500], 0.548_799_577_982_933_2, 1e-5);
}

/// Published in the reference with the same definition: errors of the wheel force and of the midspan deflection over
/// the crossing, against 60 modes with the rest. Pure modes need five times as many as modes with the static give
/// of the others.
#[test]
fn static_give_of_the_other_modes_is_worth_several_modes() {
    let scene = oscillator(0.5, 0.5, 0.1);
    let reference = cross(&scene, beam(30, true));
    let error = |found: &Crossing| {
        let of = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
        [of(&found.force, &reference.force), of(&found.middle, &reference.middle)]
    };
    for (modes, rest, force, middle) in [
        (1, false, 2.5e-2, 1.5e-2),
        (5, false, 4.3e-4, 9.1e-4),
        (0, true, 3.3e-2, 9.7e-2),
        (1, true, 8.9e-4, 5.3e-4),
        (3, true, 3.4e-5, 3.5e-5),
        (5, true, 4.8e-6, 7.2e-6),
    ] {
        let [found_force, found_middle] = error(&cross(&scene, beam(modes, rest)));
        println!(
            "{modes} modes, rest {rest}: force {found_force:.1e} for {force:.1e}, middle {found_middle:.1e} for {middle:.1e}"
        );
        assert!((found_force / force - 1.0).abs() < 0.3 && (found_middle / middle - 1.0).abs() < 0.3);
    }
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
        close(&format!("alpha {alpha}"), largest(&found.middle), factor, 1e-4);
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
        close(&format!("alpha {alpha}"), largest(&found.middle), factor, 1e-4);
    }
}
