//! Sweeps and shards that are refused, each with its place.

use super::{errors, folder, girderway, make, read, write};

/// Members of a sweep of the runway with these axes and others.
fn sweep(axes: &str, rest: &str) -> String {
    format!(r#""scene": "scene.json", "axes": {{{axes}}}, {rest}"#)
}

#[test]
fn faults_of_a_sweep_are_told_with_their_places() {
    let grid = r#""sampling": "grid", "results": ["peaks"]"#;
    let latin = r#""sampling": "latin", "count": 10, "results": ["peaks"]"#;
    let weight = r#""/bodies/crane/weight": [300, 400]"#;
    let cases = [
        (
            sweep(r#""/bodies/crane/wieght": [1]"#, grid),
            "\"wieght\" is not in /bodies/crane",
        ),
        (
            sweep(r#""/bodies/crane": [1]"#, grid),
            "must refer to a number",
        ),
        (sweep(r#""bodies": [1]"#, grid), "must be a JSON pointer"),
        (
            sweep(r#""other.json#/girder/E": [1]"#, grid),
            "its files: spec.json",
        ),
        (
            sweep(r#""/compare/0/label": ["a"]"#, grid),
            "comparisons are not run in a sweep",
        ),
        (
            sweep(r#""/bodies/crane/weight": []"#, grid),
            "must have at least one value",
        ),
        (
            sweep(r#""/bodies/crane/weight": ["heavy"]"#, grid),
            "must be a number, as in the file",
        ),
        (
            sweep(
                r#""/structures/girder/foundation": {"uniform": [0, 1]}"#,
                latin,
            ),
            "must be a list",
        ),
        (
            sweep(r#""/bodies/crane/weight": {"uniform": [2, 1]}"#, latin),
            "must be greater than the first, 2",
        ),
        (
            sweep(r#""/bodies/crane/weight": {"normal": [2, -1]}"#, latin),
            "must be positive, got -1",
        ),
        (
            sweep(r#""/bodies/crane/weight": {"uniform": [1, 2]}"#, grid),
            "distributions need",
        ),
        (
            sweep(r#""/bodies/crane/weight": {"range": [1, 2, 1e12]}"#, grid),
            "must be a whole number from 1 to",
        ),
        (
            sweep(
                r#""/bodies/crane/weight": {"range": [1, 2, 3], "uniform": [1, 2]}"#,
                grid,
            ),
            "must have one of",
        ),
        (
            sweep(
                r#""/bodies/crane/weight": {"range": [1, 2, 100000]}, "/motions/0/speed/0/1": {"range": [1, 2, 100000]}"#,
                grid,
            ),
            "must have at most 10000000 combinations",
        ),
        (sweep("", grid), "must have at least one axis"),
        (
            sweep(
                weight,
                r#""sampling": "latin", "count": 1e12, "results": ["peaks"]"#,
            ),
            "must be a whole number",
        ),
        (
            sweep(
                weight,
                r#""sampling": "latin", "count": 2.5, "results": ["peaks"]"#,
            ),
            "must be a whole number",
        ),
        (
            sweep(weight, r#""sampling": "latin", "results": ["peaks"]"#),
            "missing key `count`",
        ),
        (
            sweep(
                weight,
                r#""sampling": "grid", "count": 5, "results": ["peaks"]"#,
            ),
            "cannot be combined with",
        ),
        (
            sweep(weight, r#""sampling": "random", "results": ["peaks"]"#),
            "\"grid\", \"latin\" or \"sobol\"",
        ),
        (
            sweep(weight, r#""results": ["peaks"]"#),
            "missing key `sampling`",
        ),
        (
            sweep(weight, r#""sampling": "grid", "results": []"#),
            "must have at least one result",
        ),
        (
            sweep(weight, r#""sampling": "grid", "results": ["peeks"]"#),
            "did you mean \"peaks\"?",
        ),
        (
            sweep(
                weight,
                r#""sampling": "grid", "results": ["peaks", "peaks"]"#,
            ),
            "must be listed once",
        ),
        (
            sweep(
                weight,
                r#""sampling": "grid", "results": ["girder.midspam"]"#,
            ),
            "did you mean \"girder.midspan\"?",
        ),
        (
            sweep(weight, r#""sampling": "grid", "results": ["fatigue"]"#),
            "no stress point of the scene has",
        ),
        (
            sweep(
                weight,
                r#""sampling": "grid", "results": ["peaks"], "design": "design.json""#,
            ),
            "combined with `scene`",
        ),
        (
            sweep(
                weight,
                r#""sampling": "grid", "results": ["peaks"], "axis": 1"#,
            ),
            "unknown key `axis`",
        ),
        (
            format!(r#""axes": {{{weight}}}, {grid}"#),
            "missing key `scene` or `design`",
        ),
        (
            format!(r#""scene": "none.json", "axes": {{{weight}}}, {grid}"#),
            "no such file",
        ),
        (
            format!(r#""design": "design.json", "axes": {{"/trains/0/lateral": [1]}}, {grid}"#),
            "must be \"extremes\" or \"ratios\" for a design",
        ),
    ];
    for (members, expected) in cases {
        let folder = folder(&members);
        let run = girderway(&folder, &["sweep.json", "-o", "out", "--quiet"]);
        let told = errors(&run);
        assert_eq!(run.status.code(), Some(2), "{members}\n{told}");
        assert!(told.contains(expected), "{members}\n{told}");
        let is_located = told.starts_with("sweep.json:") || told.starts_with("none.json:");
        assert!(is_located, "{told}");
        assert!(!folder.path().join("out").exists(), "{members}");
    }
}

#[test]
fn an_input_that_cannot_be_run_is_refused_before_the_runs() {
    let folder = folder(&sweep(
        r#""/bodies/crane/weight": [300]"#,
        r#""sampling": "grid", "results": ["peaks"]"#,
    ));
    let scene = String::from_utf8(read(&folder, "scene.json")).expect("text");
    write(
        &folder,
        "scene.json",
        &scene.replace("\"weight\": 360", "\"weight\": -360"),
    );
    let run = girderway(&folder, &["sweep.json", "-o", "out", "--quiet"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(errors(&run).starts_with("scene.json:"), "{}", errors(&run));
}

#[test]
fn shards_that_do_not_belong_together_are_refused_by_their_folders() {
    let axes = r#""/bodies/crane/weight": {"uniform": [300, 400]}, "/structures/girder/foundation": ["rigid"]"#;
    let rest = r#""sampling": "sobol", "count": 4, "results": ["girder.rail.reaction"]"#;
    let folder = folder(&sweep(axes, rest));
    for shard in ["1/2", "2/2"] {
        make(
            &folder,
            &[
                "sweep.json",
                "--shard",
                shard,
                "-o",
                &format!("shard{}", &shard[..1]),
            ],
        );
    }
    let refused = |shards: &[&str]| {
        let run = girderway(
            &folder,
            &[&["--quiet", "--merge"], shards, &["-o", "out"]].concat(),
        );
        assert_eq!(run.status.code(), Some(2), "{}", errors(&run));
        assert!(!folder.path().join("out").exists());
        errors(&run)
    };
    assert!(refused(&["shard1"]).contains("needs all 2 shards, 2 missing"));
    assert!(refused(&["shard1", "shard1", "shard2"]).contains("is shard 1 of 2, as shard1 is"));
    assert!(
        refused(&["shard1", "nowhere"])
            .starts_with("nowhere: is not the folder of a finished shard")
    );
    let rows = String::from_utf8(read(&folder, "shard2/rows.jsonl")).expect("text");
    write(&folder, "shard2/rows.jsonl", &rows.replacen("[", "[ ", 1));
    assert!(refused(&["shard1", "shard2"]).contains("shard2: has a modified rows.jsonl"));
    let text = String::from_utf8(read(&folder, "sweep.json")).expect("text");
    write(
        &folder,
        "sweep.json",
        &text.replace("[300, 400]", "[300, 401]"),
    );
    make(
        &folder,
        &["sweep.json", "--shard", "2/2", "-o", "shard2", "--force"],
    );
    assert!(refused(&["shard1", "shard2"]).contains("shard2: belongs to a different sweep"));

    for (shard, expected) in [
        ("0/2", "K from 1 to N"),
        ("3/2", "K from 1 to N"),
        ("x", "K/N"),
        ("5/5", "too few"),
    ] {
        let run = girderway(&folder, &["sweep.json", "--shard", shard, "-o", "more"]);
        assert_eq!(run.status.code(), Some(2));
        assert!(errors(&run).contains(expected), "{}", errors(&run));
    }
}
