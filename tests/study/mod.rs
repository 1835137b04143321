//! Studies of small scenes: orders of convergence, references that are checked, what is refused.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

mod command;
use crate::common::near;
mod stability;

use formats::scene::{Document, TableInterpolation};
use foundations::solve;
use foundations::{SolvedStructure, distinct_specs};
use near::assert_near;
use serde_json::{Value, json};
use sim::Method;
use study::{
    ErrorGroup, PointOutcome, ReferenceKind, SettingFamily, SilentObserver, Study, StudyBudget,
    study,
};

/// The paper's girder; `mass` by length, where it has one.
fn girder(mass: Option<f64>) -> Value {
    json!({
        "format": "girderway-beam/1", "units": {"length": "ft", "force": "lbf", "time": "s"},
        "theory": "euler-bernoulli",
        "girder": {"spans": [60], "overhangs": [15, 15], "E": 4.32e9, "I_vertical": 9.528, "mass_per_length": mass},
        "stations": [-15, 0, 15, 30, 45, 60, 75],
    })
}

/// A body on one wheel, from `x0` at `speed` for a time, on springs that do not ring.
fn scene(x0: f64, speed: f64, end: f64) -> Value {
    json!({
        "format": "girderway-scene/1", "name": "small", "units": {"length": "ft", "force": "lbf", "time": "s"},
        "gravity": 32.174,
        "structures": {"girder": {"spec": "spec.json", "foundation": "influence", "measure": "history"}},
        "bodies": {"car": {"weight": 2e6, "dof": ["y"], "x0": x0}},
        "wheels": {"wheel": {"radius": 1.25, "vertical": {"k": 2e7}}},
        "trucks": [{"name": "axle", "body": "car", "rail": "girder.rail", "tree": [0], "wheel": "wheel"}],
        "motions": [{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, speed]]}],
        "end": {"time": end}, "output": {"dt": end / 100.0}, "accuracy": 1e-6,
    })
}

/// Nothing tried, nothing timed.
fn nothing() -> StudyBudget {
    StudyBudget {
        accuracies: Vec::new(),
        steps: Vec::new(),
        modes: Vec::new(),
        elements: Vec::new(),
        parts: Vec::new(),
        stations: Vec::new(),
        repetitions: 0,
        ..StudyBudget::quick()
    }
}

fn conduct(scene: &Value, spec: &Value, depth: &StudyBudget) -> Study {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in [("scene.json", scene), ("spec.json", spec)] {
        // a key without a value is left out
        let mut value = value.clone();
        if let Some(girder) = value.get_mut("girder").and_then(Value::as_object_mut) {
            girder.retain(|_, own| !own.is_null());
        }
        std::fs::write(folder.path().join(name), value.to_string()).expect("writable");
    }
    let document =
        Document::open(&folder.path().join("scene.json")).expect("a scene without faults");
    let solved = |spec: &std::sync::Arc<formats::spec::Spec>| SolvedStructure {
        spec: std::sync::Arc::clone(spec),
        solution: solve(spec).expect("a girder that stands").into(),
    };
    let known: Vec<SolvedStructure> = distinct_specs(&document)
        .iter()
        .map(|(_, _, spec)| solved(spec))
        .collect();
    study(document.scene(), &known, depth, &SilentObserver).expect("a reference")
}

/// Values and errors along a family, in their order.
fn curve(study: &Study, family: SettingFamily, quantity: ErrorGroup) -> Vec<[f64; 2]> {
    let own = study
        .points
        .iter()
        .filter(|point| point.setting.family == family);
    own.map(|point| {
        let error = point.error(quantity);
        [
            point.setting.value,
            error.unwrap_or_else(|| panic!("{}: {:?}", point.setting.label(), point.outcome)),
        ]
    })
    .collect()
}

/// Slope of log error over log value from the first point to the last, with its sign turned.
fn order(curve: &[[f64; 2]]) -> f64 {
    let (first, last) = (curve[0], curve[curve.len() - 1]);
    -(last[1] / first[1]).ln() / (last[0] / first[0]).ln()
}

#[test]
fn errors_of_equal_steps_fall_with_the_order_of_the_method() {
    let depth = StudyBudget {
        steps: vec![3, 6, 12, 24, 48],
        references: vec![(1e-10, 2)],
        ..nothing()
    };
    // between supports, where the rail's give is smooth
    let study = conduct(&scene(20.0, 40.0, 0.5), &girder(None), &depth);
    let known = study
        .reference(ReferenceKind::Own)
        .expect("the scene's own reference");
    println!(
        "the reference resolves errors from {:.1e}",
        known.resolution(ErrorGroup::Deflection)
    );
    // Radau is as exact as the reference from 24 steps on; with fewer its order is still approached
    for (method, wanted, within) in [
        (Method::Sdirk4, 4.0, 0.5),
        (Method::Radau, 9.0, 2.5),
        (Method::Gauss2, 4.0, 0.5),
        (Method::Gauss3, 6.0, 0.5),
    ] {
        let curve = curve(&study, SettingFamily::Fixed(method), ErrorGroup::Deflection);
        let coarsest = usize::from(method != Method::Radau);
        let told: Vec<[f64; 2]> = curve
            .iter()
            .skip(coarsest)
            .filter(|own| own[1] > known.resolution(ErrorGroup::Deflection))
            .copied()
            .collect();
        println!("{method:?}: {curve:?}");
        assert!(told.len() > 1, "{method:?}: {curve:?}");
        let found = order(&told);
        assert!(
            (found - wanted).abs() < within,
            "{method:?}: order {found}, theory {wanted}; {curve:?}"
        );
    }
}

/// A body that bounces without damping, whose phases differ between influence functions and modes.
#[test]
fn a_study_judges_by_the_measure_of_its_scene() {
    let by = |measure: Option<&str>| {
        let mut scene = scene(0.0, 40.0, 0.5);
        scene["structures"]["girder"]["measure"] = json!(measure);
        if measure.is_none() {
            scene["structures"]["girder"]
                .as_object_mut()
                .expect("an object")
                .remove("measure");
        }
        let depth = StudyBudget {
            accuracies: vec![1e-4],
            ..nothing()
        };
        let study = conduct(&scene, &girder(Some(500.0)), &depth);
        let point = study
            .points
            .iter()
            .find(|own| own.setting.family == SettingFamily::Influence);
        let point = point.expect("influence functions").clone();
        let error = point.error(ErrorGroup::WheelForce).expect("an error");
        (
            error,
            point.measured().expect("a run").errors[1].expect("wheel forces"),
        )
    };
    for (measure, is_history) in [
        (None, false),
        (Some("extremes"), false),
        (Some("history"), true),
    ] {
        let (error, deviation) = by(measure);
        assert!(
            deviation.peak < 0.99 * deviation.largest,
            "the case tells the measures apart: {deviation:?}"
        );
        let wanted = if is_history {
            deviation.largest
        } else {
            deviation.peak
        };
        assert!(
            (error - wanted).abs() <= 0.0,
            "{measure:?}: {error}, {deviation:?}"
        );
    }
}

#[test]
fn errors_of_tables_and_parts_fall_with_their_orders() {
    let depth = StudyBudget {
        stations: vec![13, 25, 49],
        parts: vec![6, 12, 24, 48],
        ..nothing()
    };
    let mut scene = scene(0.0, 5.0, 12.0);
    scene["analysis"] = json!("quasi-static");
    let study = conduct(&scene, &girder(None), &depth);
    // natural splines: 3 where loads stand between stations; Akima's bilinear row: 2
    for (family, wanted) in [
        (SettingFamily::Table(TableInterpolation::Natural), 3.0),
        (SettingFamily::Table(TableInterpolation::Akispl), 2.0),
        (SettingFamily::Table(TableInterpolation::Cubspl), 2.0),
        (SettingFamily::Parts, 2.0),
    ] {
        let curve = curve(&study, family, ErrorGroup::Deflection);
        let found = order(&curve);
        println!("{}: {curve:?}, order {found:.2}", family.name());
        assert!(
            (found - wanted).abs() < 0.3,
            "{}: order {found}; {curve:?}",
            family.name()
        );
    }
    let exact = curve(&study, SettingFamily::Influence, ErrorGroup::Deflection);
    assert!(
        exact.iter().all(|own| own[1] == 0.0),
        "the exact surface is the reference: {exact:?}"
    );
}

/// Statement: rigid parts have the damping of the scene, as modes and meshes have.
#[test]
fn parts_have_the_damping_of_the_scene() {
    let depth = StudyBudget {
        parts: vec![2, 4],
        ..nothing()
    };
    let mut scene = scene(15.0, 30.0, 0.5);
    scene["structures"]["girder"]["foundation"] = json!("modal");
    scene["structures"]["girder"]["modes"] = json!(3);
    scene["structures"]["girder"]["damping"] = json!(0.1);
    scene["accuracy"] = json!(1e-4);
    let study = conduct(&scene, &girder(Some(26.4)), &depth);
    let own = study
        .points
        .iter()
        .filter(|point| point.setting.family == SettingFamily::Parts);
    let dampings: Vec<f64> = own
        .map(|point| match point.setting.scene.structures[0].foundation {
            formats::scene::Foundation::Parts { damping, .. } => damping,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(dampings, [0.1, 0.1]);
}

#[test]
fn residual_flexibility_spares_modes() {
    let depth = StudyBudget {
        modes: vec![1, 2, 4],
        references: vec![(1e-5, 12)],
        fine_accuracy: 1e-5,
        ..nothing()
    };
    let mut scene = scene(0.0, 100.0, 0.6);
    scene["bodies"]["car"]["weight"] = json!(2e4);
    scene["wheels"]["wheel"]["vertical"]["k"] = json!(1e5);
    let study = conduct(&scene, &girder(Some(15.2)), &depth);
    let least = study
        .reference(ReferenceKind::Whole)
        .expect("a reference")
        .resolution(ErrorGroup::Deflection);
    let [with, without] = [SettingFamily::Modal, SettingFamily::ModalWithoutResidual]
        .map(|family| curve(&study, family, ErrorGroup::Deflection));
    println!("with {with:?}, without {without:?}, told from {least:.1e}");
    for (with, without) in with.iter().zip(&without) {
        assert!(
            with[1].max(least) < 0.2 * without[1],
            "{with:?} {without:?}"
        );
    }
    assert!(
        without.windows(2).all(|pair| pair[1][1] < pair[0][1]),
        "{without:?}"
    );
    let massless = curve(&study, SettingFamily::Influence, ErrorGroup::Deflection);
    assert!(
        massless.iter().all(|own| own[1] > with[0][1]),
        "{massless:?}"
    );
}

#[test]
fn errors_by_modes_are_those_found_elsewhere() {
    // a sprung mass of half the girder's, half its frequency, a tenth of its critical speed: errors that a prototype of
    // other code gave, rounded
    let (length, bending, mass) = (20.0_f64, 1e9_f64, 1000.0_f64);
    let wave = std::f64::consts::PI / length;
    let omega = wave * wave * (bending / mass).sqrt();
    let speed = 0.1 * wave * (bending / mass).sqrt();
    let sprung = 0.5 * mass * length;
    let mut spec = girder(Some(mass));
    spec["girder"]["spans"] = json!([length]);
    spec["girder"]["overhangs"] = json!([0, 0]);
    spec["girder"]["E"] = json!(bending);
    spec["girder"]["I_vertical"] = json!(1);
    spec["stations"] = json!([0, 5, 10, 15, 20]);
    spec["effects"] = json!([{"name": "mid", "x": 10}]);
    let mut scene = scene(0.0, speed, length / speed);
    scene["bodies"]["car"]["weight"] = json!(sprung * 32.174);
    scene["wheels"]["wheel"]["vertical"]["k"] = json!(sprung * 0.25 * omega * omega);
    scene["output"]["dt"] = json!(length / speed / 400.0);
    let depth = StudyBudget {
        modes: vec![1, 3, 5, 20],
        accuracies: vec![1e-6],
        references: vec![(1e-7, 40)],
        fine_accuracy: 1e-7,
        resolution: 1e-4,
        ..nothing()
    };
    let study = conduct(&scene, &spec, &depth);
    for (family, quantity, wanted) in [
        (
            SettingFamily::Modal,
            ErrorGroup::WheelForce,
            [8.9e-4, 3.4e-5, 4.8e-6, f64::NAN],
        ),
        (
            SettingFamily::Modal,
            ErrorGroup::Moment,
            [3.4e-3, 8.9e-4, 3.6e-4, f64::NAN],
        ),
        (
            SettingFamily::ModalWithoutResidual,
            ErrorGroup::WheelForce,
            [2.5e-2, f64::NAN, 4.3e-4, 8.0e-6],
        ),
        (
            SettingFamily::ModalWithoutResidual,
            ErrorGroup::Moment,
            [1.6e-1, f64::NAN, 6.0e-2, 1.8e-2],
        ),
        (
            SettingFamily::Influence,
            ErrorGroup::WheelForce,
            [3.3e-2, f64::NAN, f64::NAN, f64::NAN],
        ),
        (
            SettingFamily::Influence,
            ErrorGroup::Moment,
            [8.4e-2, f64::NAN, f64::NAN, f64::NAN],
        ),
    ] {
        let curve = curve(&study, family, quantity);
        println!(
            "{} {}: {curve:?}, elsewhere {wanted:?}",
            family.name(),
            quantity.name()
        );
        for (own, wanted) in curve
            .iter()
            .zip(wanted)
            .filter(|(_, wanted)| wanted.is_finite())
        {
            let what = format!(
                "girderway study, {} {}: error of the {}",
                family.name(),
                own[0],
                quantity.name()
            );
            if (family, quantity) != (SettingFamily::ModalWithoutResidual, ErrorGroup::Moment) {
                assert_near(what, "prototype", wanted, own[1], 0.2);
                continue;
            }
            let known = [(1.0, 1.99e-2), (5.0, 1.08e-3), (20.0, 2.34e-5)];
            let (_, known) = known
                .into_iter()
                .find(|(modes, _)| *modes == own[0])
                .expect("one of them");
            // The prototype sums the bending moments of the modes, a series that converges slowly. Ours takes moments from
            // the equilibrium of wheel forces and the inertia of the modes, which needs no curvature.
            assert_near(what, "regression", known, own[1], 0.02);
        }
    }
}

#[test]
fn a_run_beyond_its_limit_is_stopped_and_says_so() {
    let depth = StudyBudget {
        steps: vec![16, 4_000_000],
        limit: 0.05,
        ..nothing()
    };
    let study = conduct(&scene(20.0, 40.0, 0.5), &girder(None), &depth);
    let of = |value: f64| {
        let found = study.points.iter().find(|own| {
            own.setting.family == SettingFamily::Fixed(Method::Sdirk4) && own.setting.value == value
        });
        &found.expect("a setting").outcome
    };
    assert!(matches!(of(16.0), PointOutcome::Done(_)), "{:?}", of(16.0));
    assert!(matches!(of(4e6), PointOutcome::Stopped), "{:?}", of(4e6));
}

#[test]
fn methods_that_do_not_suit_are_refused_with_what_they_lack() {
    let depth = StudyBudget {
        steps: vec![64],
        ..nothing()
    };
    let mut scene = scene(20.0, 40.0, 0.5);
    scene["wheels"]["wheel"]["vertical"]["c"] = json!(1e4);
    let study = conduct(&scene, &girder(None), &depth);
    let gauss = study
        .points
        .iter()
        .find(|own| own.setting.family == SettingFamily::Fixed(Method::Gauss2));
    match &gauss.expect("a setting").outcome {
        PointOutcome::Refused(why) => {
            assert!(why.contains("damper between wheel and rail"), "{why}")
        }
        other => panic!("{other:?}"),
    }
}
