//! The selector on a simply supported beam in closed form: independent, finer runs judge what it chose.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod common;

use std::ops::ControlFlow;

use common::modes::{beam, oscillator};
use sim::{Choice, Error, Foundation, Ladder, Reason, Run, Rung, Scene, choose, distance};

struct Beam {
    mass: bool,
}

fn at(rung: Rung) -> Foundation {
    match rung {
        Rung::Rigid => Foundation { rails: beam(0, true).rails, ..Foundation::rigid() },
        Rung::Influence => beam(0, true),
        Rung::Modal(modes) => beam(modes, true),
        Rung::Full => beam(24, true),
    }
}

impl Ladder for Beam {
    type Error = Error;

    fn has_mass(&mut self, _: usize) -> Result<bool, Error> {
        Ok(self.mass)
    }

    fn foundation(&mut self, _: usize, rung: Rung) -> Result<Foundation, Error> {
        Ok(at(rung))
    }
}

fn scene(mass: f64, frequency: f64, alpha: f64) -> Scene {
    let mut scene = oscillator(mass, frequency, alpha);
    (scene.output_dt, scene.accuracy) = (scene.end / 200.0, 1e-5);
    scene
}

fn chosen(scene: &Scene, tolerance: f64, mass: bool) -> Choice {
    let mut all = choose(scene, &[Some(tolerance)], &mut Beam { mass }).expect("a valid scene");
    assert_eq!(all.len(), 1);
    all.remove(0)
}

fn ran(scene: &Scene, rung: Rung) -> Run {
    sim::run(scene, &[at(rung)], &mut |_| ControlFlow::Continue(())).expect("a valid scene")
}

/// Independent: 24 modes with the rest, which the selector did not compare with.
#[test]
fn a_sufficient_rung_is_within_the_tolerance_of_the_full_beam() {
    for (mass, frequency, alpha, tolerance) in
        [(0.5, 0.5, 0.003, 1e-2), (0.5, 0.5, 0.1, 1e-2), (0.2, 1.0, 0.25, 1e-2), (1.0, 0.02, 0.1, 1e-2)]
    {
        let scene = scene(mass, frequency, alpha);
        let choice = chosen(&scene, tolerance, true);
        let error = distance(&ran(&scene, choice.rung), &ran(&scene, Rung::Full), &scene);
        println!("alpha {alpha}: {:?}, estimate {:?}, error {error:.1e}", choice.rung, choice.estimate);
        assert_eq!(choice.reason, Reason::Sufficient);
        assert!(error <= tolerance, "{choice:?}: {error}");
    }
}

#[test]
fn speed_climbs_above_influence() {
    let choice = chosen(&scene(0.5, 0.5, 0.25), 1e-2, true);
    assert!(matches!(choice.rung, Rung::Modal(_)), "{choice:?}");
    assert!(choice.tried.iter().any(|tried| tried.rung == Rung::Influence && tried.estimate > 1e-2));
}

#[test]
fn a_soft_spring_needs_no_rail_that_gives() {
    assert_eq!(chosen(&scene(1.0, 0.02, 0.1), 1e-2, true).rung, Rung::Rigid);
}

#[test]
fn without_mass_no_estimate_is_claimed() {
    let choice = chosen(&scene(0.5, 0.5, 0.25), 1e-2, false);
    assert_eq!((choice.rung, choice.reason, choice.estimate), (Rung::Influence, Reason::NoMass, None));
}
