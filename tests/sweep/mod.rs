//! The command `sweep`: the same bytes for any number of threads, in shards, and after any interruption; what it refuses.

mod refusals;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use serde_json::Value;
use tempfile::TempDir;

/// A folder with the runway's scene, spec and design, and a sweep with these members.
fn folder(sweep: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for name in ["scene.json", "spec.json", "design.json"] {
        fs::copy(example("runway").join(name), folder.path().join(name)).expect("a copy");
    }
    write(
        &folder,
        "sweep.json",
        &format!("{{\"format\": \"girderway-sweep/1\", {sweep}}}"),
    );
    folder
}

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../examples")
        .join(name)
}

fn write(folder: &TempDir, name: &str, text: &str) {
    fs::write(folder.path().join(name), text).expect("writable");
}

fn command(folder: &TempDir, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_girderway"));
    command
        .arg("sweep")
        .args(arguments)
        .current_dir(folder.path());
    command
}

fn girderway(folder: &TempDir, arguments: &[&str]) -> Output {
    command(folder, arguments)
        .output()
        .expect("the program starts")
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn read(folder: &TempDir, name: &str) -> Vec<u8> {
    let path = folder.path().join(name);
    fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn json(folder: &TempDir, name: &str) -> Value {
    serde_json::from_slice(&read(folder, name)).expect("JSON")
}

/// Runs a sweep without messages, which must succeed.
fn make(folder: &TempDir, arguments: &[&str]) {
    let run = girderway(folder, &[&["--quiet"], arguments].concat());
    assert_eq!((run.status.code(), errors(&run)), (Some(0), String::new()));
}

/// Names of the files in a folder and in the folders in it.
fn names(folder: &TempDir, own: &str) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder.path().join(own)).expect("a folder") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            found.extend(
                names(folder, &format!("{own}/{name}"))
                    .iter()
                    .map(|below| format!("{name}/{below}")),
            );
        } else {
            found.push(name);
        }
    }
    found.sort();
    found
}

/// Checks that two output folders have the same files with the same bytes.
fn assert_same(folder: &TempDir, a: &str, b: &str) {
    assert_eq!(names(folder, a), names(folder, b));
    for name in names(folder, a) {
        assert_eq!(
            read(folder, &format!("{a}/{name}")),
            read(folder, &format!("{b}/{name}")),
            "{name}"
        );
    }
}

/// Runs with the influence foundation, which take some milliseconds each.
const SCATTER: &str = r#""scene": "scene.json", "name": "scatter",
 "axes": {"/bodies/crane/weight": {"lognormal": [330, 30]}, "/motions/0/speed/0/1": {"uniform": [0.5, 1.7]},
          "spec.json#/girder/E": {"normal": [2.1e8, 4e6]}, "/structures/girder/foundation": ["influence", "rigid"]},
 "sampling": "latin", "count": 24, "seed": 3, "results": ["ratios", "girder.midspan"]"#;

#[test]
fn threads_shards_and_interruptions_change_no_byte() {
    let folder = folder(SCATTER);
    make(&folder, &["sweep.json", "-o", "one", "--threads", "1"]);
    // the name by which the sweep is called is in no result
    let sweep = folder.path().join("sweep.json");
    make(
        &folder,
        &[
            sweep.to_str().expect("a path in UTF-8"),
            "-o",
            "two",
            "--threads",
            "2",
        ],
    );
    assert_same(&folder, "one", "two");

    for shard in ["1/3", "2/3", "3/3"] {
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
    make(
        &folder,
        &["--merge", "shard2", "shard1", "shard3", "-o", "merged"],
    );
    assert_same(&folder, "one", "merged");

    // killed again and again, each time a little later, until it ends
    let mut kills = 0;
    loop {
        let mut child = command(
            &folder,
            &["sweep.json", "-o", "killed", "--quiet", "--threads", "2"],
        )
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
        std::thread::sleep(Duration::from_millis(60 + 40 * kills));
        if let Some(status) = child.try_wait().expect("a child") {
            assert_eq!(status.code(), Some(0));
            break;
        }
        child.kill().expect("a living child");
        child.wait().expect("a dead child");
        kills += 1;
        assert!(kills < 200, "the sweep does not get on");
    }
    assert!(kills > 0, "the sweep was never killed");
    assert_same(&folder, "one", "killed");
}

#[test]
fn a_bad_run_is_a_line_and_the_others_are_made() {
    let folder = folder(SCATTER);
    make(&folder, &["sweep.json", "-o", "out"]);
    let failures = String::from_utf8(read(&folder, "out/failures.csv")).expect("text");
    let results = String::from_utf8(read(&folder, "out/results.csv")).expect("text");
    // at more than 1.67 m/s the second wheel leaves the rail
    let reasons: Vec<&str> = failures.lines().skip(1).collect();
    assert!(
        !reasons.is_empty()
            && reasons
                .iter()
                .all(|line| line.contains("must stay on rail")),
        "{failures}"
    );
    assert_eq!(results.lines().count() - 1 + reasons.len(), 24);
    let head = "run,/bodies/crane/weight,/motions/0/speed/0/1,spec.json#/girder/E,/structures/girder/foundation,\
                girder.rail.dynamic factor,girder.midspan.max,girder.midspan.min";
    assert_eq!(results.lines().next(), Some(head));
    let summary = json(&folder, "out/summary.json");
    assert_eq!(summary["failures"], reasons.len());
    assert_eq!(summary["results"]["girder.midspan.max"]["unit"], "m");
}

#[test]
fn a_run_is_that_of_the_command_run_to_the_last_bit() {
    let axes =
        r#""axes": {"/bodies/crane/weight": [300, 355.7], "spec.json#/girder/E": [1.9e8, 2.1e8]}"#;
    let folder = folder(&format!(
        r#""scene": "scene.json", {axes}, "sampling": "grid", "results": ["peaks", "extremes"]"#
    ));
    make(&folder, &["sweep.json", "-o", "out"]);
    let results = String::from_utf8(read(&folder, "out/results.csv")).expect("text");
    let rows: Vec<Vec<&str>> = results
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 5);
    assert_eq!(rows[3][..3], ["3", "355.7", "190000000.0"]);

    // the same values written into the files by hand
    let replaced = |name: &str, old: &str, new: &str| {
        let text = String::from_utf8(read(&folder, name)).expect("text");
        assert_eq!(text.matches(old).count(), 1, "{name}");
        write(&folder, name, &text.replace(old, new));
    };
    replaced("scene.json", "\"weight\": 360", "\"weight\": 355.7");
    replaced("spec.json", "\"E\": 2.1e8", "\"E\": 1.9e8");
    let run = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["run", "scene.json", "-o", "by hand", "--quiet"])
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    assert_eq!(run.status.code(), Some(0), "{}", errors(&run));
    let summary = json(&folder, "by hand/summary.json");
    for (name, value) in rows[0]
        .iter()
        .zip(&rows[3])
        .skip(3)
        .filter(|(name, _)| !name.contains("span "))
    {
        let (column, kind) = name.rsplit_once('.').expect("a kind");
        let value: f64 = value.parse().expect("a number");
        if let Some(peak) = summary["peaks"][column][kind]["value"].as_f64() {
            assert_eq!(value, peak, "{name}");
        }
    }
    let moment = rows[0]
        .iter()
        .position(|name| *name == "girder.rail.span 2.moment.vertical.max");
    let moment: f64 = rows[3][moment.expect("an extreme")]
        .parse()
        .expect("a number");
    let extremes = summary["extremes"].as_array().expect("a list");
    let is_it = |one: &&Value| {
        one["span"] == 2
            && one["quantity"] == "moment"
            && one["plane"] == "vertical"
            && one["kind"] == "max"
    };
    assert_eq!(
        extremes.iter().find(is_it).expect("an extreme")["value"],
        moment
    );
}

#[test]
fn one_run_is_repeated_with_all_its_files() {
    let folder = folder(SCATTER);
    make(&folder, &["sweep.json", "-o", "out"]);
    let results = String::from_utf8(read(&folder, "out/results.csv")).expect("text");
    let row: Vec<&str> = results.lines().nth(1).expect("a run").split(',').collect();
    make(&folder, &["sweep.json", "--run", row[0], "-o", "repeated"]);
    let summary = json(&folder, "repeated/summary.json");
    let peak = &summary["peaks"]["girder.midspan"]["max"]["value"];
    assert_eq!(peak.as_f64(), row[6].parse().ok());
    assert!(folder.path().join("repeated/report.html").exists());
}

#[test]
fn designs_are_swept_and_their_ratios_follow_the_limits() {
    let folder = folder(
        r#""design": "design.json", "axes": {"spec.json#/girder/I_vertical": {"range": [4e-4, 8e-4, 3]}},
           "sampling": "grid", "results": ["extremes", "ratios"]"#,
    );
    make(&folder, &["sweep.json", "-o", "out"]);
    let results = String::from_utf8(read(&folder, "out/results.csv")).expect("text");
    let rows: Vec<Vec<&str>> = results
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    let column = |name: &str| {
        let place = rows[0]
            .iter()
            .position(|one| one.contains(name))
            .unwrap_or_else(|| panic!("{name}"));
        rows[1..]
            .iter()
            .map(|row| row[place].parse().expect("a number"))
            .collect::<Vec<f64>>()
    };
    let used = column("case 1.rail.span 2.vertical deflection");
    assert!(
        used[0] > used[1] && used[1] > used[2],
        "a stiffer girder uses less of the limit: {used:?}"
    );
    let report = String::from_utf8(read(&folder, "out/report.html")).expect("text");
    assert!(report.contains("spec.json#/girder/I_vertical") && report.contains("--run"));
}

#[test]
fn runs_of_another_sweep_are_not_lost() {
    let folder = folder(SCATTER);
    let mut child = command(&folder, &["sweep.json", "-o", "out", "--quiet"])
        .spawn()
        .expect("the program starts");
    let rows = folder.path().join("out/.girderway-sweep");
    while fs::read_to_string(&rows).map_or(0, |text| text.lines().count()) < 3 {
        assert!(
            child.try_wait().expect("a child").is_none(),
            "the sweep ended before it was killed"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().expect("a living child");
    child.wait().expect("a dead child");
    let text = String::from_utf8(read(&folder, "sweep.json")).expect("text");
    write(
        &folder,
        "sweep.json",
        &text.replace("\"seed\": 3", "\"seed\": 4"),
    );
    let run = girderway(&folder, &["sweep.json", "-o", "out", "--quiet"]);
    assert_eq!(run.status.code(), Some(2), "{}", errors(&run));
    assert!(
        errors(&run).contains("contains the runs of another interrupted sweep"),
        "{}",
        errors(&run)
    );
    assert!(errors(&run).contains("--force"), "{}", errors(&run));
    make(&folder, &["sweep.json", "-o", "out", "--force"]);
    assert!(!rows.exists());
}

#[test]
fn figures_have_values_of_codes_and_the_mean_of_damages_with_its_confidence() {
    let folder = folder("");
    for name in ["crane.json", "girder.json", "bridge.json"] {
        fs::copy(example("runway").join(name), folder.path().join(name)).expect("a copy");
    }
    let text = fs::read_to_string(example("runway").join("crane_sweep.json")).expect("an example");
    assert_eq!(text.matches("\"count\": 200").count(), 1);
    write(
        &folder,
        "sweep.json",
        &text.replace("\"count\": 200", "\"count\": 8"),
    );
    make(&folder, &["sweep.json", "-o", "out"]);
    let figure = |name: &str| {
        String::from_utf8(read(&folder, &format!("out/plots/{name}.svg"))).expect("text")
    };
    let first = figure("distribution-1");
    assert!(
        first.contains("Distribution of rail_factor") && first.contains("AIST TR-13"),
        "{first}"
    );
    // three factors have values by codes, then come the damages of the life
    let damage = figure("mean-4");
    assert!(
        damage.contains("life damage") && damage.contains("95 % confidence"),
        "{damage}"
    );
    let summary = json(&folder, "out/summary.json");
    let found = &summary["results"]["south.midspan.bottom flange.life damage"];
    let [low, high] = [0, 1].map(|k| found["mean_interval"][k].as_f64().expect("a number"));
    let mean = found["mean"].as_f64().expect("a number");
    assert!(
        0.0 < low && low < mean && mean < high && high < 1.0,
        "{found}"
    );
    let listed = String::from_utf8(read(&folder, "out/manifest.json")).expect("text");
    assert!(
        names(&folder, "out")
            .iter()
            .filter(|name| *name != "manifest.json")
            .all(|name| listed.contains(name.as_str()))
    );
}

/// The load of the crane of the runway stands on the floor at the start, and its rails carry a part of the weight: what
/// they carry later is no multiple of it.
#[test]
fn dynamic_factors_are_those_of_rails_that_start_with_their_static_force() {
    let folder = folder(
        r#""scene": "crane.json", "axes": {"/end/time": [1, 2]}, "sampling": "grid", "results": ["ratios"]"#,
    );
    for name in ["crane.json", "girder.json", "bridge.json"] {
        fs::copy(example("runway").join(name), folder.path().join(name)).expect("a copy");
    }
    make(&folder, &["sweep.json", "-o", "lifted"]);
    let header = |name: &str| {
        let text = String::from_utf8(read(&folder, name)).expect("text");
        text.lines().next().unwrap_or_default().to_owned()
    };
    let lifted = header("lifted/results.csv");
    assert!(
        lifted.contains("rail_factor") && !lifted.contains("dynamic factor"),
        "{lifted}"
    );
    let sweep = r#"{"format": "girderway-sweep/1", "scene": "scene.json", "axes": {"/end/time": [1, 2]}, "sampling": "grid", "results": ["ratios"]}"#;
    write(&folder, "rolling.json", sweep);
    make(&folder, &["rolling.json", "-o", "rolling"]);
    let rolling = header("rolling/results.csv");
    assert!(rolling.contains("girder.rail.dynamic factor"), "{rolling}");
}
