//! Runs about a loaded state: energy, foundations, cables that wheels would leave slack.

use std::ops::ControlFlow;

use formats::scene::SceneSource;
use formats::text::source::Source;
use foundations::StructureCache;
use results::cases::RunOptions;
use results::scene_run::SceneRun;
use results::warning::{case_notes, case_warnings};

fn run(changes: &str) -> SceneRun {
    run_of("monorail", changes)
}

fn run_of(example: &str, changes: &str) -> SceneRun {
    let path = format!("../../examples/{example}/scene.json");
    let scene = SceneSource::open(path.as_ref()).expect("the example");
    let changes = Source {
        name: "changes".to_owned(),
        text: changes.to_owned(),
    };
    let document = scene
        .document(Some(&changes), false)
        .expect("a scene without faults");
    let cache = StructureCache::default();
    SceneRun::of(document, &cache, RunOptions::default(), &|_| {
        ControlFlow::Continue(())
    })
    .expect("it runs")
}

fn warnings(changes: &str) -> Vec<String> {
    let run = run(changes);
    case_warnings(run.document.scene(), &run.cases[0])
}

/// Identity: the energy of a run about a loaded state balances on every foundation, and all find the same sway of the trolley,
/// to what the mass of the track does.
#[test]
fn energy_balances_about_a_loaded_state_on_every_foundation() {
    let sways = [r#""influence""#, r#""modal", "modes": 12"#, r#""full", "elements": 2"#].map(|foundation| {
        let changes = format!(
            r#"{{"structures": {{"line": {{"foundation": {foundation}}}}}, "end": {{"time": 2}}, "accuracy": 1e-5}}"#
        );
        let run = run(&changes);
        let case = &run.cases[0];
        assert!(case.run.status.is_complete());
        assert!(case.run.audit.residual() < 1e-5, "{foundation}: {:e}", case.run.audit.residual());
        *case.columns.values("trolley.z").last().expect("a history")
    });
    for sway in &sways[1..] {
        assert!((sway / sways[0] - 1.0).abs() < 0.05, "{sways:?}");
    }
    assert!((sways[1] / sways[2] - 1.0).abs() < 0.01, "{sways:?}");
}

/// A trolley of 100 kN in the first bay of the monorail, whose hangers have the tension of its own weight alone, lifts the third
/// hanger; one of 1 kN does not, nor does the trolley over the middle whose weight belongs to the preload.
#[test]
fn cables_that_would_go_slack_are_named() {
    let in_first_bay = |weight: f64| {
        warnings(&format!(
            r#"{{"structures": {{"line": {{"preload": false}}}}, "end": {{"time": 0.1}},
                "bodies": {{"trolley": {{"weight": {weight}, "x0": 2.5}}}}}}"#
        ))
    };
    let heavy = in_first_bay(100.0);
    assert!(
        heavy
            .iter()
            .any(|text| text.contains("cell [1, 2] would become slack")),
        "{heavy:?}"
    );
    let light = in_first_bay(1.0);
    assert!(
        !light.iter().any(|text| text.contains("slack")),
        "{light:?}"
    );
    let given = warnings(r#"{"end": {"time": 0.1}}"#);
    assert!(
        !given.iter().any(|text| text.contains("slack")),
        "{given:?}"
    );
}

/// The girders of the mill turn over their axes under the crane, as their sections have no warping: a warning. A girder on two
/// supports whose vertical deflection is a 200th of its span has a shear force that is by its slope smaller: a note.
#[test]
fn what_second_order_would_change_is_told() {
    let about = |example: &str| {
        let run = run_of(example, r#"{"end": {"time": 12}}"#);
        let case = &run.cases[0];
        let all = [
            case_notes(run.document.scene(), case),
            case_warnings(run.document.scene(), case),
        ];
        all.map(|texts| {
            texts
                .into_iter()
                .filter(|text| text.contains("second-order effects"))
                .collect::<Vec<_>>()
        })
    };
    let [notes, warnings] = about("mill_girderway");
    assert!(
        notes.is_empty() && warnings.len() == 1 && warnings[0].contains("without the warping"),
        "{notes:?} {warnings:?}"
    );
    let [notes, warnings] = about("bogie");
    assert!(
        notes.len() == 1 && warnings.is_empty(),
        "{notes:?} {warnings:?}"
    );
}
