//! Cables that wheels would leave slack.

use std::ops::ControlFlow;

use formats::scene::SceneSource;
use formats::text::source::Source;
use foundations::StructureCache;
use results::cases::RunOptions;
use results::scene_run::SceneRun;
use results::warning::case_warnings;

fn warnings(changes: &str) -> Vec<String> {
    let scene = SceneSource::open("../../examples/monorail/scene.json".as_ref()).expect("the example");
    let changes = Source { name: "changes".to_owned(), text: changes.to_owned() };
    let document = scene.document(Some(&changes), false).expect("a scene without faults");
    let cache = StructureCache::default();
    let run = SceneRun::of(document, &cache, RunOptions::default(), &|_| ControlFlow::Continue(()))
        .expect("it runs");
    case_warnings(run.document.scene(), &run.cases[0])
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
    assert!(heavy.iter().any(|text| text.contains("cell [1, 2] would go slack")), "{heavy:?}");
    let light = in_first_bay(1.0);
    assert!(!light.iter().any(|text| text.contains("slack")), "{light:?}");
    let given = warnings(r#"{"end": {"time": 0.1}}"#);
    assert!(!given.iter().any(|text| text.contains("slack")), "{given:?}");
}
