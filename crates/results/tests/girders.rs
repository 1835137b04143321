//! Extremes of girders that are computed with a run, and those that are computed when they are asked for.

use std::ops::ControlFlow;

use formats::scene::SceneSource;
use formats::text::source::Source;
use foundations::StructureCache;
use results::cases::{GirderTime, RunOptions};
use results::scene_run::SceneRun;

/// Runs an example with changes.
fn run(example: &str, changes: &str, cache: &StructureCache, girders: GirderTime) -> SceneRun {
    let path = format!("{}/../../examples/{example}/scene.json", env!("CARGO_MANIFEST_DIR"));
    let source = SceneSource::open(path.as_ref()).expect("an example");
    let changes = Source { name: "changes".to_owned(), text: changes.to_owned() };
    let document = source.document(Some(&changes), true).expect("a scene without faults");
    let options = RunOptions { threads: Some(2), girders };
    SceneRun::of(document, cache, options, &|_| ControlFlow::Continue(())).expect("a scene that starts")
}

/// Both ways give the same extremes, whether the history is there or not.
fn assert_same(example: &str, changes: &str) {
    let cache = StructureCache::default();
    let with_run = run(example, changes, &cache, GirderTime::WithRun);
    let mut dropped = run(example, changes, &cache, GirderTime::OnDemand);
    let asked = run(example, changes, &cache, GirderTime::OnDemand);
    asked.compute_girders(Some(2));
    dropped.cases.iter_mut().for_each(|case| case.drop_history());
    assert_eq!(with_run.cases.len(), dropped.cases.len());
    assert!(!with_run.cases[0].girders().extremes.is_empty(), "{example} has a girder");
    for ((known, dropped), asked) in with_run.cases.iter().zip(&dropped.cases).zip(&asked.cases) {
        assert_eq!(known.girders(), dropped.girders(), "{}", known.label);
        assert_eq!(known.girders(), asked.girders(), "{}", known.label);
        assert_eq!(dropped.run.history.len(), 0);
    }
}

#[test]
fn extremes_on_demand_are_those_of_the_run_to_the_last_bit() {
    // with ends of steps, with a modal structure, and quasi-static, which is repeated with more rows
    assert_same("runway", r#"{"end": {"time": 2}}"#);
    // stations of tables, chains of parts, and steps that no history records
    assert_same("bogie", r#"{"end": {"time": 2}}"#);
}

#[test]
fn runs_that_share_solved_structures_and_modes_are_those_that_do_not() {
    let changes = |modes: usize| {
        let structure = format!(r#"{{"foundation": "modal", "modes": {modes}}}"#);
        format!(r#"{{"end": {{"time": 1}}, "structures": {{"girder": {structure}}}}}"#)
    };
    let shared = StructureCache::default();
    for modes in [8, 3, 8, 5] {
        let alone = run("runway", &changes(modes), &StructureCache::default(), GirderTime::OnDemand);
        let among = run("runway", &changes(modes), &shared, GirderTime::OnDemand);
        assert_eq!(alone.cases[0].columns, among.cases[0].columns, "{modes} modes");
    }
}
