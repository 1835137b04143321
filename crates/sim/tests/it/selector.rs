//! The selector on a simply supported beam in closed form: independent, finer runs judge what it chose.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::modes::{beam, oscillator};
use sim::{
    Bounces, Choice, Contact, Error, Fidelity, Foundation, FoundationProvider, Measure, ModalBasis,
    Reason, Record, Run, Scene, Selection, Status, Tolerance, TrialCheck, choose, difference,
};

/// Number of modes of the beam that stands for all of them.
const WHOLE: usize = 48;

/// The beam at every fidelity.
#[derive(Default)]
struct Beam {
    /// Without mass.
    light: bool,
    /// Fidelities that cannot be built.
    refused: Option<fn(Fidelity) -> bool>,
    /// Descriptions of the runs.
    begun: Vec<Vec<(usize, Fidelity)>>,
    runs: usize,
}

fn at(fidelity: Fidelity) -> Foundation {
    match fidelity {
        Fidelity::Rigid => Foundation {
            rails: beam(0, true).rails,
            ..Foundation::rigid()
        },
        Fidelity::Influence => beam(0, true),
        Fidelity::Modal(modes) => beam(modes, true),
    }
}

impl FoundationProvider for Beam {
    type Error = Error;

    fn modes(&mut self, _: usize, count: usize) -> Result<Option<ModalBasis>, Error> {
        let structure = beam(count, true).structure.filter(|_| !self.light);
        let basis = |structure| ModalBasis {
            structure,
            coupling: Vec::new(),
            effects: Vec::new(),
            is_whole: false,
        };
        Ok(structure.map(basis))
    }

    fn foundation(&mut self, structure: usize, fidelity: Fidelity) -> Result<Foundation, Error> {
        if self.refused.is_some_and(|refused| refused(fidelity)) {
            return Err(Error::NoSuch {
                what: "structure",
                index: structure,
            });
        }
        Ok(at(fidelity))
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

    fn begin(&mut self, fidelities: &[(usize, Fidelity)]) {
        self.begun.push(fidelities.to_vec());
    }
}

fn scene(mass: f64, frequency: f64, alpha: f64) -> Scene {
    let mut scene = oscillator(mass, frequency, alpha);
    (scene.output_dt, scene.accuracy) = (scene.end / 200.0, 1e-5);
    scene
}

fn within(value: f64) -> Option<Tolerance> {
    Some(Tolerance {
        value,
        measure: Measure::Extremes,
    })
}

fn select(scene: &Scene, tolerances: &[Option<Tolerance>], provider: &mut Beam) -> Selection {
    let found = choose(scene, tolerances, provider, &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene");
    assert_eq!(found.runs, provider.runs);
    assert!(
        found.runs <= provider.begun.len(),
        "a run that began and failed is not counted"
    );
    found
}

fn chosen(scene: &Scene, tolerance: f64, provider: &mut Beam) -> (Choice, Run) {
    let Selection {
        mut choices, run, ..
    } = select(scene, &[within(tolerance)], provider);
    assert_eq!(choices.len(), 1);
    (choices.remove(0), run)
}

fn ran(scene: &Scene, fidelity: Fidelity) -> Run {
    let finer = Scene {
        accuracy: 1e-7,
        ..scene.clone()
    };
    sim::run(&finer, &[at(fidelity)], &mut |_| ControlFlow::Continue(())).expect("a valid scene")
}

/// Largest error of a run at equal times, which is never smaller than that of its extremes.
fn error(run: &Run, reference: &Run) -> f64 {
    let bounces = Bounces {
        slowest: f64::INFINITY,
        remembered: 0.0,
    };
    let [run, reference] = [run, reference].map(|run| Record::of(&run.history));
    difference(&run, &reference, Measure::History, bounces).largest
}

/// Independent: 48 modes with the rest, which the selector did not compare with.
#[test]
fn a_sufficient_fidelity_is_within_the_tolerance_of_the_whole_beam() {
    for (mass, frequency, alpha, tolerance) in [
        (0.5, 0.5, 0.003, 1e-2),
        (0.5, 0.5, 0.1, 1e-2),
        (0.2, 1.0, 0.25, 1e-2),
        (1.0, 0.02, 0.1, 1e-2),
        (0.05, 4.0, 0.05, 1e-3),
        (5.0, 0.3, 0.4, 1e-3),
    ] {
        let scene = scene(mass, frequency, alpha);
        let mut provider = Beam::default();
        let (choice, run) = chosen(&scene, tolerance, &mut provider);
        let error = error(&run, &ran(&scene, Fidelity::Modal(WHOLE)));
        let Choice {
            fidelity,
            estimate,
            quantity,
            ..
        } = &choice;
        println!(
            "alpha {alpha}: {fidelity:?}, estimate {estimate:?} of {quantity}, error {error:.1e}"
        );
        assert!(
            matches!(choice.reason, Reason::Sufficient | Reason::Kept),
            "{choice:?}"
        );
        assert!(error <= tolerance, "{choice:?}: {error}");
        let most = provider
            .begun
            .iter()
            .filter(|begun| begun[0].1 == *fidelity)
            .count();
        assert!(most <= 3 && provider.runs <= 4, "{choice:?}");
    }
}

/// The estimate of the wheel forces acting on the modes, and the difference of runs: the error of influence functions
/// by 48 modes, within a factor of three.
#[test]
fn estimates_have_the_size_of_the_error() {
    for (mass, frequency, alpha) in [
        (0.5, 0.5, 0.05),
        (0.5, 0.5, 0.2),
        (2.0, 0.2, 0.1),
        (0.1, 1.5, 0.1),
    ] {
        let scene = scene(mass, frequency, alpha);
        let choice = chosen(&scene, 1e-6, &mut Beam::default()).0;
        let error = error(
            &ran(&scene, Fidelity::Influence),
            &ran(&scene, Fidelity::Modal(WHOLE)),
        );
        let tried = &choice.tried[0];
        println!(
            "alpha {alpha}: estimate {:.1e} by {:?}, error {error:.1e}",
            tried.estimate, tried.against
        );
        assert!(matches!(tried.against, TrialCheck::Replay(_)), "{tried:?}");
        assert_eq!(tried.fidelity, Fidelity::Influence);
        assert!(
            (error / 3.0..error * 3.0).contains(&tried.estimate),
            "{tried:?}: {error}"
        );
    }
}

#[test]
fn a_creeping_wheel_is_run_on_influence_functions_alone() {
    let mut provider = Beam::default();
    let choice = chosen(&scene(0.5, 0.05, 0.001), 1e-2, &mut provider).0;
    assert_eq!(
        (choice.fidelity, choice.reason),
        (Fidelity::Influence, Reason::Sufficient)
    );
    // to choose it, and with the accuracy of the result
    assert_eq!(
        provider.begun,
        [[(0, Fidelity::Influence)], [(0, Fidelity::Influence)]]
    );
}

#[test]
fn speed_needs_modes() {
    let choice = chosen(&scene(0.5, 0.5, 0.25), 1e-2, &mut Beam::default()).0;
    assert!(matches!(choice.fidelity, Fidelity::Modal(_)), "{choice:?}");
}

#[test]
fn a_spring_far_softer_than_the_rail_needs_no_flexible_rail() {
    let choice = chosen(&scene(1e-3, 1e-5, 0.001), 1e-2, &mut Beam::default()).0;
    assert_eq!(choice.fidelity, Fidelity::Rigid, "{choice:?}");
}

#[test]
fn without_mass_no_estimate_is_claimed() {
    let (choice, _) = chosen(
        &scene(0.5, 0.5, 0.25),
        1e-2,
        &mut Beam {
            light: true,
            ..Beam::default()
        },
    );
    assert_eq!(
        (choice.fidelity, choice.reason, choice.estimate),
        (Fidelity::Influence, Reason::NoMass, None)
    );
}

#[test]
fn the_run_of_the_choice_has_the_samples_of_the_scene() {
    let scene = scene(0.5, 0.5, 0.1);
    let (choice, run) = chosen(&scene, 1e-2, &mut Beam::default());
    let again = ran(&scene, choice.fidelity);
    let times = |run: &Run| run.history.column(sim::Channel::Time);
    assert_eq!(times(&run), times(&again));
    assert!(error(&run, &again) < 1e-4);
}

#[test]
fn a_choice_that_cannot_be_checked_is_marked() {
    let refused: fn(Fidelity) -> bool = |fidelity| fidelity > Fidelity::Influence;
    let (choice, run) = chosen(
        &scene(0.5, 0.5, 0.25),
        1e-2,
        &mut Beam {
            refused: Some(refused),
            ..Beam::default()
        },
    );
    assert_eq!(
        (choice.fidelity, choice.reason, choice.estimate),
        (Fidelity::Influence, Reason::Unchecked, None)
    );
    assert!(
        matches!(choice.failed[..], [Fidelity::Modal(_)]),
        "{choice:?}"
    );
    assert_eq!(run.status, Status::Done);
}

#[test]
fn a_choice_that_is_stopped_leaves_its_run() {
    let found = choose(
        &scene(0.5, 0.5, 0.25),
        &[within(1e-2)],
        &mut Beam::default(),
        &mut |t| {
            if t > 0.0 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        },
    );
    let found = found.expect("a valid scene");
    assert_eq!((found.run.status, found.runs), (Status::Stopped, 1));
    assert_eq!(found.choices[0].reason, Reason::Unchecked);
}

/// Two oscillators that have nothing in common, on a beam each; by the frequency and the speed of the second.
fn two([frequency, alpha]: [f64; 2]) -> Scene {
    let (mut scene, slow) = (scene(0.5, 0.5, 0.25), scene(0.5, frequency, alpha));
    scene.bodies.extend(slow.bodies);
    scene.wheels.extend(slow.wheels);
    scene.contacts.push(Contact {
        body: 1,
        structure: 1,
        wheel: 1,
        ..slow.contacts[0].clone()
    });
    scene
}

/// Independent: both beams in 48 modes.
#[test]
fn every_structure_has_a_choice_of_its_own_and_all_together_keep_their_tolerances() {
    for second in [[0.05, 0.001], [0.5, 0.25]] {
        let scene = two(second);
        let found = select(&scene, &[within(1e-2), within(1e-2)], &mut Beam::default());
        let finer = Scene {
            accuracy: 1e-7,
            ..scene
        };
        let whole = [WHOLE, WHOLE].map(|modes| at(Fidelity::Modal(modes)));
        let whole =
            sim::run(&finer, &whole, &mut |_| ControlFlow::Continue(())).expect("a valid scene");
        let error = error(&found.run, &whole);
        println!("{second:?}: {:?}, error {error:.1e}", found.choices);
        for (choice, alpha) in found.choices.iter().zip([0.25, second[1]]) {
            assert_eq!(
                choice.fidelity > Fidelity::Influence,
                alpha > 0.05,
                "{choice:?}"
            );
        }
        assert!(error <= 1e-2, "{error}");
    }
}

#[test]
fn structures_that_are_given_are_kept() {
    let found = select(
        &two([0.5, 0.003]),
        &[None, within(1e-2)],
        &mut Beam::default(),
    );
    assert_eq!(
        found
            .choices
            .iter()
            .map(|choice| choice.structure)
            .collect::<Vec<_>>(),
        [1]
    );
}

/// A record of one force over time.
fn record(count: usize, force: impl Fn(f64) -> f64) -> Record {
    let time: Vec<f64> = (0..count).map(|i| i as f64 * 0.01).collect();
    let values = time.iter().map(|t| force(*t)).collect();
    let quantity = sim::RecordedQuantity {
        name: "force".to_owned(),
        kind: "force",
        channel: None,
        is_position: false,
        group: String::new(),
        least_scale: 0.0,
        values,
    };
    Record {
        time,
        quantities: vec![quantity],
    }
}

/// Closed forms: a bounce of 1 Hz about 10, shifted by a tenth of its period; its amplitude late in the run raised by 2.
#[test]
fn extremes_ignore_a_shift_in_time_and_find_a_late_error() {
    let bounces = Bounces {
        slowest: 1.0,
        remembered: 30.0,
    };
    let wave = |shift: f64| record(3001, move |t| 10.0 + (2.0 * PI * (t - shift)).sin());
    let by = |a: &Record, b: &Record, measure| difference(a, b, measure, bounces).largest;
    assert!(by(&wave(0.1), &wave(0.0), Measure::Extremes) < 0.02);
    let wanted = 2.0 * (0.1 * PI).sin() / 11.0;
    assert!((by(&wave(0.1), &wave(0.0), Measure::History) - wanted).abs() < 0.02);
    let late = record(3001, |t| {
        let size = if t > 20.0 { 3.0 } else { 1.0 };
        10.0 + size * (2.0 * PI * t).sin()
    });
    assert!((by(&late, &wave(0.0), Measure::Extremes) - 2.0 / 11.0).abs() < 1e-3);
}

/// With many bounces the wheels of a body are one: which of them is the more heavily loaded does not count.
#[test]
fn wheels_of_a_body_are_one_in_a_long_run() {
    let pair = |sizes: [f64; 2]| {
        let mut both = record(3001, |t| sizes[0] * (2.0 * PI * t).sin());
        both.quantities
            .extend(record(3001, |t| sizes[1] * (2.0 * PI * t).sin()).quantities);
        both.quantities
            .iter_mut()
            .for_each(|own| "wheels".clone_into(&mut own.group));
        both
    };
    let (a, b) = (pair([1.0, 0.9]), pair([0.9, 1.0]));
    let by = |remembered: f64| {
        difference(
            &a,
            &b,
            Measure::Extremes,
            Bounces {
                slowest: 1.0,
                remembered,
            },
        )
        .largest
    };
    // by the range of the wheel that moves less, 1.8
    assert!(
        (by(30.0) - 0.1 / 1.8).abs() < 1e-3,
        "30 bounces: {}",
        by(30.0)
    );
    assert!(by(300.0) < 1e-12, "300 bounces: {}", by(300.0));
}

#[test]
fn runs_of_different_quantities_cannot_be_compared() {
    let bounces = Bounces {
        slowest: 1.0,
        remembered: 30.0,
    };
    let apart = difference(
        &record(11, |t| t),
        &Record::default(),
        Measure::Extremes,
        bounces,
    );
    assert_eq!(apart.largest, f64::INFINITY);
    let broken = difference(
        &record(11, |_| f64::NAN),
        &record(11, |t| t),
        Measure::Extremes,
        bounces,
    );
    assert_eq!(broken.largest, f64::INFINITY);
}
