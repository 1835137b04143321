//! Extremes of girders that are computed with a run, and those that are computed when they are asked for.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use formats::scene::SceneSource;
use formats::text::source::Source;
use foundations::StructureCache;
use results::cases::{GirderTime, RunOptions};
use results::scene_run::SceneRun;

/// Runs an example with changes.
fn run(example: &str, changes: &str, cache: &StructureCache, girders: GirderTime) -> SceneRun {
    let path = format!(
        "{}/../../examples/{example}/scene.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let source = SceneSource::open(path.as_ref()).expect("an example");
    let changes = Source {
        name: "changes".to_owned(),
        text: changes.to_owned(),
    };
    let document = source
        .document(Some(&changes), true)
        .expect("a scene without faults");
    let options = RunOptions {
        threads: Some(2),
        girders,
    };
    SceneRun::of(document, cache, options, &|_| ControlFlow::Continue(()))
        .expect("a scene that starts")
}

/// Both ways give the same extremes, whether the history is there or not.
fn assert_same(example: &str, changes: &str) {
    let cache = StructureCache::default();
    let with_run = run(example, changes, &cache, GirderTime::WithRun);
    let mut dropped = run(example, changes, &cache, GirderTime::OnDemand);
    let asked = run(example, changes, &cache, GirderTime::OnDemand);
    asked
        .compute_girders(Some(2), &|| ControlFlow::Continue(()))
        .expect("nobody stops it");
    dropped
        .cases
        .iter_mut()
        .for_each(|case| case.drop_history());
    assert_eq!(with_run.cases.len(), dropped.cases.len());
    assert!(
        !with_run.cases[0].girders().extremes.is_empty(),
        "{example} has a girder"
    );
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
fn extremes_that_were_stopped_anywhere_are_found_when_they_are_asked_for_again() {
    // steps and modes, and rows whose run is repeated
    for (example, changes) in [
        ("runway", r#"{"end": {"time": 1}}"#),
        ("bogie", r#"{"end": {"time": 1}}"#),
    ] {
        let cache = StructureCache::default();
        let known = run(example, changes, &cache, GirderTime::OnDemand);
        let asked = AtomicUsize::new(0);
        let count = || {
            asked.fetch_add(1, Ordering::Relaxed);
            ControlFlow::Continue(())
        };
        known
            .compute_girders(Some(1), &count)
            .expect("nobody stops it");
        let all = asked.load(Ordering::Relaxed);
        assert!(all > 20, "{example} asks {all} times whether to go on");
        let stopped = run(example, changes, &cache, GirderTime::OnDemand);
        for last in [0, 1, all / 7, all / 3, all / 2, all - 2] {
            let asked = AtomicUsize::new(0);
            let stop = || match asked.fetch_add(1, Ordering::Relaxed) {
                number if number < last => ControlFlow::Continue(()),
                _ => ControlFlow::Break(()),
            };
            let found = stopped.compute_girders(Some(1), &stop);
            // cases that were complete before are not computed again
            assert!(
                matches!(found, Err(results::Error::Stopped)) || last > all / 7,
                "{example} after {last}"
            );
        }
        stopped
            .compute_girders(Some(1), &|| ControlFlow::Continue(()))
            .expect("nobody stops it");
        for (known, found) in known.cases.iter().zip(&stopped.cases) {
            assert_eq!(
                known.girders(),
                found.girders(),
                "{example} {}",
                known.label
            );
        }
    }
}

#[test]
fn runs_that_share_solved_structures_and_modes_are_those_that_do_not() {
    let changes = |modes: usize| {
        let structure = format!(r#"{{"foundation": "modal", "modes": {modes}}}"#);
        format!(r#"{{"end": {{"time": 1}}, "structures": {{"girder": {structure}}}}}"#)
    };
    let shared = StructureCache::default();
    for modes in [8, 3, 8, 5] {
        let alone = run(
            "runway",
            &changes(modes),
            &StructureCache::default(),
            GirderTime::OnDemand,
        );
        let among = run("runway", &changes(modes), &shared, GirderTime::OnDemand);
        assert_eq!(
            alone.cases[0].columns, among.cases[0].columns,
            "{modes} modes"
        );
    }
}
