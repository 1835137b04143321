//! The warning about free bounces among the cycles of fatigue.

use std::ops::ControlFlow;

use formats::scene::SceneSource;
use formats::text::source::Source;
use foundations::StructureCache;
use results::cases::{RunOptions, SimulationProgress};
use results::scene_run::SceneRun;
use results::warning::case_warnings;

/// The warnings about bounces, and the largest number of cycles, of an example with `changes`.
fn run_of(example: &str, changes: &str) -> (Vec<String>, f64) {
    let path = format!(
        "{}/../../examples/{example}/scene.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let source = SceneSource::open(path.as_ref()).expect("an example");
    let text = format!(r#"{{"accuracy": 1e-4, {changes}}}"#);
    let changes = Source {
        name: "changes".to_owned(),
        text,
    };
    let document = source
        .document(Some(&changes), false)
        .expect("a scene without faults");
    let go_on = |_: SimulationProgress<'_>| ControlFlow::Continue(());
    let run = SceneRun::of(
        document,
        &StructureCache::default(),
        RunOptions::default(),
        &go_on,
    )
    .expect("a run");
    let case = &run.cases[0];
    let all = case_warnings(&run.document.cases[0].scene, case).into_iter();
    let own = all
        .filter(|warning| warning.contains("undamped bouncing"))
        .collect();
    (
        own,
        case.fatigue
            .iter()
            .map(|result| result.count())
            .fold(0.0, f64::max),
    )
}

/// The same of a truck on the girderway of a mill building.
fn run(changes: &str) -> (Vec<String>, f64) {
    run_of(
        "mill_girderway",
        &format!(r#""end": {{"time": 30}}, {changes}"#),
    )
}

fn wheels(damper: &str) -> String {
    format!(r#""wheels": {{"runway": {{"vertical": {{"law": "linear", "k": 1e8, {damper}}}}}}}"#)
}

/// Equilibrium at every place counts the cycles of the crossing alone.
#[test]
fn cycles_of_wheels_that_bounce_without_damping_are_warned_of() {
    let (statics, few) = run(r#""analysis": "quasi-static""#);
    assert_eq!(statics, Vec::<String>::new(), "statics has no bounces");
    let (warnings, count) = run(&wheels(r#""c": 0"#));
    assert!(count > 4.0 * few, "{count} cycles, by statics {few}");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let counted =
        format!("({count} of aisle.bay3.bottom flange) include undamped bouncing of truck");
    assert!(
        warnings[0].contains(&counted) && warnings[0].contains("`c`"),
        "{warnings:?}"
    );
}

#[test]
fn damped_wheels_are_not_warned_of() {
    let (_, few) = run(r#""analysis": "quasi-static""#);
    assert_eq!(run(&wheels(r#""c": 1e5"#)).0, Vec::<String>::new());
    let (warnings, count) = run(&wheels(r#""c": 1e6, "damper": "ground""#));
    assert_eq!(warnings, Vec::<String>::new());
    assert!(count < 3.0 * few, "{count} cycles, by statics {few}");
}

/// A crane on undamped wheels, on a girder of steel with `damping` of its modes.
fn on_modes(damping: f64) -> (Vec<String>, f64) {
    let girder = format!(
        r#""girder": {{"spec": "girder.json", "foundation": "modal", "modes": 4, "damping": {damping}, "gauges": null}}"#
    );
    let wheels = r#""wheels": {"crane": {"vertical": {"c": 0}}}"#;
    run_of(
        "runway",
        &format!(r#""end": {{"time": 5}}, "structures": {{{girder}}}, {wheels}"#),
    )
}

#[test]
fn structures_that_damp_the_bounces_are_not_warned_of() {
    let ((warnings, _), (damped, _)) = (on_modes(0.001), on_modes(0.02));
    assert!(
        warnings.len() == 1 && warnings[0].contains("`modal`"),
        "{warnings:?}"
    );
    assert_eq!(damped, Vec::<String>::new());
}
