//! The selector on a simply supported beam in closed form: independent, finer runs judge what it chose.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod common;

use std::ops::ControlFlow;

use common::modes::{beam, oscillator};
use common::{EI, SPAN};
use sim::{
    Choice, Contact, Error, Fidelity, Foundation, FoundationProvider, Reason, Run, Scene, Selection, Status,
    Structure, choose, distance,
};

/// The beam at every rung.
#[derive(Default)]
struct Beam {
    /// Without mass.
    light: bool,
    /// What cannot be built.
    refused: Option<fn(Fidelity) -> bool>,
    /// Half the mesh has one mode.
    poor: bool,
    runs: usize,
}

fn at(rung: Fidelity) -> Foundation {
    match rung {
        Fidelity::Rigid => Foundation { rails: beam(0, true).rails, ..Foundation::rigid() },
        Fidelity::Influence => beam(0, true),
        Fidelity::Modal(modes) => beam(modes, true),
        Fidelity::Half => beam(20, true),
        Fidelity::Full => beam(24, true),
    }
}

impl FoundationProvider for Beam {
    type Error = Error;

    fn modes(&mut self, _: usize, count: usize) -> Result<Option<Structure>, Error> {
        Ok(if self.light { None } else { beam(count, true).structure })
    }

    fn foundation(&mut self, structure: usize, rung: Fidelity) -> Result<Foundation, Error> {
        if self.refused.is_some_and(|refused| refused(rung)) {
            return Err(Error::NoSuch { what: "structure", index: structure });
        }
        Ok(match rung {
            Fidelity::Half if self.poor => beam(1, false),
            rung => at(rung),
        })
    }

    fn run(
        &mut self,
        scene: &Scene,
        foundations: &[Foundation],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, Error> {
        self.runs += 1;
        sim::run(scene, foundations, watch)
    }
}

fn scene(mass: f64, frequency: f64, alpha: f64) -> Scene {
    let mut scene = oscillator(mass, frequency, alpha);
    (scene.output_dt, scene.accuracy) = (scene.end / 200.0, 1e-5);
    scene
}

fn selected(scene: &Scene, tolerance: f64, ladder: &mut Beam) -> (Choice, Run) {
    let found = choose(scene, &[Some(tolerance)], ladder, &mut |_| ControlFlow::Continue(()));
    let Selection { mut choices, run, runs } = found.expect("a valid scene");
    assert_eq!((choices.len(), runs), (1, ladder.runs));
    (choices.remove(0), run)
}

fn chosen(scene: &Scene, tolerance: f64) -> Choice {
    selected(scene, tolerance, &mut Beam::default()).0
}

fn ran(scene: &Scene, rung: Fidelity) -> Run {
    sim::run(scene, &[at(rung)], &mut |_| ControlFlow::Continue(())).expect("a valid scene")
}

/// Independent: 24 modes with the rest, which the selector did not compare with.
#[test]
fn a_sufficient_rung_is_within_the_tolerance_of_the_full_beam() {
    for (mass, frequency, alpha, tolerance) in
        [(0.5, 0.5, 0.003, 1e-2), (0.5, 0.5, 0.1, 1e-2), (0.2, 1.0, 0.25, 1e-2), (1.0, 0.02, 0.1, 1e-2)]
    {
        let scene = scene(mass, frequency, alpha);
        let choice = chosen(&scene, tolerance);
        let error = distance(&ran(&scene, choice.fidelity), &ran(&scene, Fidelity::Full), &scene);
        println!("alpha {alpha}: {:?}, estimate {:?}, error {error:.1e}", choice.fidelity, choice.estimate);
        assert!(matches!(choice.reason, Reason::Sufficient | Reason::Predicted), "{choice:?}");
        assert!(error <= tolerance, "{choice:?}: {error}");
    }
}

#[test]
fn speed_climbs_above_influence() {
    let choice = chosen(&scene(0.5, 0.5, 0.25), 1e-2);
    assert!(matches!(choice.fidelity, Fidelity::Modal(_)), "{choice:?}");
    assert_eq!(choice.skipped, [Fidelity::Rigid, Fidelity::Influence]);
    let expected = choice.predicted.and_then(|predicted| predicted.of(Fidelity::Influence));
    assert!(expected.is_some_and(|error| error > 1e-2), "{expected:?}");
}

#[test]
fn a_soft_spring_needs_no_rail_that_gives() {
    assert_eq!(chosen(&scene(1.0, 0.02, 0.1), 1e-2).fidelity, Fidelity::Rigid);
}

#[test]
fn without_mass_no_estimate_is_claimed() {
    let choice = selected(&scene(0.5, 0.5, 0.25), 1e-2, &mut Beam { light: true, ..Beam::default() }).0;
    assert_eq!(
        (choice.fidelity, choice.reason, choice.estimate),
        (Fidelity::Influence, Reason::NoMass, None)
    );
}

/// Analytic: alpha / (1 - alpha), Fryba's speed parameter; 1 - sqrt(1 - alpha^2); the mass and its spring as one body on
/// springs in series, omega_b^2 = 1 / ((G + 1 / k) M).
#[test]
fn predictors_of_a_crossing_are_those_of_the_beam() {
    let (mass, frequency, alpha) = (0.5, 0.5, 0.02);
    let scene = scene(mass, frequency, alpha);
    let predicted = chosen(&scene, 1e-2).predicted.expect("a sweep is possible");
    assert!((predicted.speed - alpha / (1.0 - alpha)).abs() < 1e-3 * alpha, "{predicted:?}");
    assert!((predicted.track - (1.0 - (1.0 - alpha * alpha).sqrt())).abs() < 1e-6, "{predicted:?}");
    // of the stiffness of beam and spring in series, by that of the spring: L^3 / 48 EI k
    let stiffness = scene.wheels[0].normal.stiffness;
    let give = SPAN.powi(3) / (48.0 * EI) * stiffness;
    // heights: give / (1 + give)
    assert!((predicted.deflection - give / (1.0 + give)).abs() < 1e-3, "{predicted:?}, {give}");
    assert_eq!([predicted.step], [0.0]);
    assert!(predicted.is_complete);
}

#[test]
fn the_run_of_the_choice_is_kept() {
    let scene = scene(0.5, 0.5, 0.003);
    let (choice, run) = selected(&scene, 1e-2, &mut Beam::default());
    let again = ran(&scene, choice.fidelity);
    let apart = distance(&run, &again, &scene);
    assert!(apart < 1e-4, "{apart}: {choice:?}");
}

#[test]
fn what_cannot_be_checked_is_said_to_be_unknown() {
    let mut ladder = Beam { refused: Some(|rung| rung > Fidelity::Influence), ..Beam::default() };
    let (choice, run) = selected(&scene(0.5, 0.5, 0.25), 1e-2, &mut ladder);
    assert_eq!(
        (choice.fidelity, choice.reason, choice.estimate),
        (Fidelity::Influence, Reason::Unchecked, None)
    );
    assert!(choice.failed.contains(&Fidelity::Full), "{choice:?}");
    assert_eq!(run.status, Status::Done);
}

#[test]
fn a_rung_that_cannot_be_built_is_left_out() {
    let mut ladder = Beam { refused: Some(|rung| rung == Fidelity::Modal(2)), ..Beam::default() };
    let (choice, _) = selected(&scene(0.5, 0.5, 0.25), 1e-2, &mut ladder);
    assert_eq!((choice.fidelity, choice.reason), (Fidelity::Modal(4), Reason::Sufficient));
    assert_eq!(choice.failed, [Fidelity::Modal(2)]);
}

#[test]
fn a_top_that_half_its_mesh_does_not_confirm_is_doubted() {
    let scene = scene(0.5, 0.5, 0.25);
    let refused: Option<fn(Fidelity) -> bool> = Some(|rung| matches!(rung, Fidelity::Modal(_)));
    let (choice, _) = selected(&scene, 1e-3, &mut Beam { poor: true, refused, ..Beam::default() });
    assert_eq!((choice.fidelity, choice.reason), (Fidelity::Full, Reason::Highest));
    assert!(choice.estimate.is_some_and(|estimate| estimate > 1e-3), "{choice:?}");
    let refused: Option<fn(Fidelity) -> bool> =
        Some(|rung| matches!(rung, Fidelity::Modal(_) | Fidelity::Half));
    let (choice, _) = selected(&scene, 1e-3, &mut Beam { refused, ..Beam::default() });
    assert_eq!((choice.fidelity, choice.reason, choice.estimate), (Fidelity::Full, Reason::Highest, None));
}

#[test]
fn a_choice_that_is_stopped_leaves_its_run() {
    let found = choose(&scene(0.5, 0.5, 0.25), &[Some(1e-2)], &mut Beam::default(), &mut |t| {
        if t > 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let found = found.expect("a valid scene");
    assert_eq!((found.run.status, found.runs), (Status::Stopped, 1));
    assert_eq!(found.choices[0].reason, Reason::Unchecked);
}

/// Two oscillators that have nothing in common, on a beam each; the second is far slower.
fn two(alpha: [f64; 2]) -> Scene {
    let (mut scene, slow) = (scene(0.5, 0.5, alpha[0]), scene(0.5, 0.5, alpha[1]));
    scene.bodies.extend(slow.bodies);
    scene.contacts.push(Contact { body: 1, structure: 1, ..slow.contacts[0].clone() });
    scene
}

/// Independent: both beams in 24 modes.
#[test]
fn every_structure_has_a_choice_of_its_own_and_all_together_keep_their_tolerances() {
    for alpha in [[0.25, 0.003], [0.25, 0.25]] {
        let scene = two(alpha);
        let mut ladder = Beam::default();
        let found =
            choose(&scene, &[Some(1e-2), Some(1e-2)], &mut ladder, &mut |_| ControlFlow::Continue(()))
                .expect("a valid scene");
        let whole =
            sim::run(&scene, &[at(Fidelity::Full), at(Fidelity::Full)], &mut |_| ControlFlow::Continue(()))
                .expect("a valid scene");
        let error = distance(&found.run, &whole, &scene);
        let rungs: Vec<Fidelity> = found.choices.iter().map(|choice| choice.fidelity).collect();
        println!("{alpha:?}: {rungs:?}, error {error:.1e}");
        for (choice, alpha) in found.choices.iter().zip(alpha) {
            assert_eq!(choice.fidelity > Fidelity::Influence, alpha > 0.05, "{choice:?}");
        }
        assert!(error <= 2e-2, "{error}");
        assert_eq!(found.runs, ladder.runs);
    }
}

#[test]
fn structures_that_are_given_are_kept() {
    let found = choose(&two([0.25, 0.003]), &[None, Some(1e-2)], &mut Beam::default(), &mut |_| {
        ControlFlow::Continue(())
    });
    let found = found.expect("a valid scene");
    assert_eq!(found.choices.iter().map(|choice| choice.structure).collect::<Vec<_>>(), [1]);
}
