//! Foundations that are "auto": what is run, named, recorded and explained.

use std::ops::ControlFlow;
use std::path::Path;

use formats::scene::motion::simulation_input;
use formats::scene::{Document, Foundation, Scene};
use foundations::{
    AutoRun, Error, MotionBasis, SolvedStructure, TrialObserver, check_name, distinct_specs,
    fidelity_name, select_and_run, selection_doubt, selection_reason, solve_specs,
};
use sim::{Channel, Choice, Fidelity, History, Reason, Record, Status, TrialCheck};

fn example(name: &str) -> (Scene, Vec<SolvedStructure>) {
    let path = format!("../../examples/{name}/scene.json");
    let document = Document::open(Path::new(&path)).expect("a scene without faults");
    let solved = solve_specs(&document, &distinct_specs(&document)).expect("structures that stand");
    (document.scene().clone(), solved)
}

/// Descriptions of all runs.
#[derive(Default)]
struct Names(Vec<String>);

impl TrialObserver for Names {
    fn record(&mut self, history: &History, _: &[Option<MotionBasis>]) -> Result<Record, Error> {
        Ok(Record::of(history))
    }

    fn effects(&mut self, _: usize, _: &MotionBasis) -> Result<Vec<(String, Vec<f64>)>, Error> {
        Ok(Vec::new())
    }

    fn begin(&mut self, trial: &str) {
        self.0.push(trial.to_owned());
    }
}

fn selected(
    scene: &mut Scene,
    solved: &[SolvedStructure],
    recorded: bool,
) -> (AutoRun, Vec<String>) {
    let input = simulation_input(scene)
        .expect("trucks with equal wheels")
        .scene;
    let mut names = Names::default();
    let watch = &mut |_| ControlFlow::Continue(());
    let found = select_and_run(scene, &input, solved, &|_, _| recorded, &mut names, watch);
    (found.expect("a scene that starts"), names.0)
}

/// A sprung mass at 28 m/s over a bridge: its largest deflection is that of the converged reference of the example,
/// 2.407316 mm, within the tolerance.
#[test]
fn a_fast_crossing_is_run_with_modes_within_its_tolerance() {
    for recorded in [true, false] {
        let (mut scene, solved) = example("yang_yau");
        let own = &mut scene.structures[0];
        (own.auto, own.tolerance, own.foundation) = (true, 1e-2, Foundation::Influence);
        let (found, names) = selected(&mut scene, &solved, recorded);
        assert_eq!(found.run.status, Status::Done);
        let [choice] = &found.choices[..] else {
            panic!("one structure")
        };
        let Fidelity::Modal(modes) = choice.fidelity else {
            panic!("{choice:?}")
        };
        assert!(
            matches!(choice.reason, Reason::Sufficient | Reason::Kept),
            "{choice:?}"
        );
        // The choice is entered in the scene and built again.
        assert!(
            matches!(scene.structures[0].foundation, Foundation::Modal { modes: own, .. } if own == modes)
        );
        assert!(found.built[0].foundation.dofs() >= modes);
        // A single structure is not named.
        assert_eq!(names[0], "influence");
        assert!(
            names
                .iter()
                .skip(1)
                .any(|name| *name == fidelity_name(choice.fidelity)),
            "{names:?}"
        );
        let middle = found.run.history.column(Channel::Gauge(0));
        let most = middle.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
        assert!((most / 2.407316e-3 - 1.0).abs() < 1e-2, "{most}");
        let coordinate = found.run.history.position(Channel::Coordinate(0, 0));
        assert_eq!(coordinate.is_some(), recorded);
    }
}

/// Analytic: frequencies of the bridge, (r pi/l)^2 sqrt(EI/m). By extremes they are within a tenth of the tolerance; at equal
/// times the phase error of the highest one in the run, times its amplitude 1/omega^2, is within a twentieth of it.
#[test]
fn frequencies_of_chosen_modes_have_the_accuracy_that_the_measure_needs() {
    let omega = |r: usize| {
        (r as f64 * std::f64::consts::PI / 25.0).powi(2) * (2.87e9 * 2.9 / 2303.0_f64).sqrt()
    };
    for measure in [sim::Measure::Extremes, sim::Measure::History] {
        let (mut scene, solved) = example("yang_yau");
        let own = &mut scene.structures[0];
        (own.auto, own.tolerance, own.measure, own.foundation) =
            (true, 1e-2, measure, Foundation::Influence);
        let end = scene.end;
        let (found, _) = selected(&mut scene, &solved, false);
        let Fidelity::Modal(modes) = found.choices[0].fidelity else {
            panic!("{:?}", found.choices)
        };
        let structure = found.built[0].foundation.structure.as_ref().expect("mass");
        let frequencies = structure.dynamics.frequencies();
        let share = omega(1) / omega(modes);
        let allowed = match measure {
            sim::Measure::Extremes => 0.1 * 1e-2,
            sim::Measure::History => {
                (0.05 * 1e-2 / (share * share * omega(modes) * end)).min(0.1 * 1e-2)
            }
        };
        for (k, found) in frequencies.iter().take(modes).enumerate() {
            let error = (found / omega(k + 1) - 1.0).abs();
            assert!(
                error <= allowed,
                "{measure:?}, mode {k}: {error:e} of {allowed:e}"
            );
        }
        let Some(MotionBasis::Modes { refined, .. }) = &found.built[0].basis else {
            panic!("natural modes")
        };
        assert!(
            refined.error.is_some_and(|error| error > 1e-6),
            "no finer than needed: {:?}",
            refined.error
        );
    }
}

#[test]
fn a_foundation_that_is_given_is_kept() {
    let (mut scene, solved) = example("bogie");
    scene.structures[0].foundation = Foundation::Rigid;
    scene.end = 0.5;
    let (found, names) = selected(&mut scene, &solved, false);
    assert!(found.choices.is_empty() && found.built[0].foundation.compliance.is_none());
    assert_eq!(scene.structures[0].foundation, Foundation::Rigid);
    let deflection = found.run.history.column(Channel::Deflection(0));
    assert!(
        !deflection.is_empty() && deflection.iter().all(|y| *y == 0.0),
        "a rigid rail"
    );
    assert!(names.is_empty(), "no structure is chosen for: {names:?}");
}

fn choice(reason: Reason, estimate: Option<f64>, quantity: &str) -> Choice {
    Choice {
        structure: 0,
        fidelity: Fidelity::Modal(3),
        reason,
        estimate,
        quantity: quantity.to_owned(),
        tried: Vec::new(),
        failed: Vec::new(),
        drifting: None,
    }
}

#[test]
fn fidelities_and_checks_are_named() {
    let names = [
        Fidelity::Rigid,
        Fidelity::Influence,
        Fidelity::Modal(1),
        Fidelity::Modal(12),
    ];
    assert_eq!(
        names.map(fidelity_name),
        ["rigid", "influence", "modal, 1 mode", "modal, 12 modes"]
    );
    assert_eq!(
        check_name(TrialCheck::Replay(24)),
        "24 natural modes under its wheel forces"
    );
    assert_eq!(
        check_name(TrialCheck::Run(Fidelity::Modal(12))),
        "modal, 12 modes"
    );
    let start = check_name(TrialCheck::Start(Fidelity::Modal(12)));
    assert_eq!(
        start,
        "the first eighth of modal, 12 modes with smaller steps"
    );
    assert_eq!(
        check_name(TrialCheck::Whole(Fidelity::Modal(1))),
        "the motion of modal, 1 mode with larger steps"
    );
}

#[test]
fn every_reason_is_a_sentence_with_the_choice_its_error_and_its_quantity() {
    let all = [
        Reason::NoMass,
        Reason::QuasiStatic,
        Reason::Sufficient,
        Reason::Kept,
        Reason::Limit,
        Reason::NoBetter,
        Reason::Unchecked,
    ];
    for reason in all {
        for quantity in ["", "truck.vertical"] {
            let own = choice(reason, Some(2.34e-3), quantity);
            let sentence = selection_reason(&own);
            assert!(sentence.starts_with("auto: modal, 3 modes; "), "{sentence}");
            let is_estimated = matches!(
                reason,
                Reason::Sufficient | Reason::Kept | Reason::Limit | Reason::NoBetter
            );
            assert_eq!(sentence.contains("2.3e-3"), is_estimated, "{sentence}");
            assert_eq!(
                sentence.contains(" of truck.vertical"),
                is_estimated && !quantity.is_empty()
            );
            // Only an error that may exceed the tolerance is a reason for doubt.
            let doubt = selection_doubt("girder", &own, 1e-3);
            let is_doubtful =
                matches!(reason, Reason::Limit | Reason::NoBetter | Reason::Unchecked);
            assert_eq!(doubt.is_some(), is_doubtful, "{doubt:?}");
            if let Some(doubt) = doubt {
                assert!(
                    doubt.starts_with("girder: the ") && !doubt.contains("could not be run:"),
                    "{doubt}"
                );
                assert_eq!(
                    doubt.contains("the tolerance 0.001"),
                    reason != Reason::Unchecked,
                    "{doubt}"
                );
            }
        }
    }
    let drifting = Some(204.4);
    let doubt = selection_doubt(
        "girder",
        &Choice {
            drifting,
            ..choice(Reason::Sufficient, Some(1e-4), "")
        },
        1e-3,
    );
    assert!(doubt.is_some_and(
        |doubt| doubt.contains("is valid for 100 cycles") && doubt.contains("has 204 undamped")
    ));
    let failed = vec![Fidelity::Influence, Fidelity::Modal(24)];
    let doubt = selection_doubt(
        "girder",
        &Choice {
            failed,
            ..choice(Reason::Unchecked, None, "")
        },
        1e-3,
    );
    assert!(doubt.is_some_and(|doubt| doubt.ends_with(" (could not be run: influence; modal, 24 modes)")));
}
