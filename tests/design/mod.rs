//! `girderway design` from its files to its tables.

mod built_up;
mod details;
mod form;
mod lines;
mod mill;
mod moving;
mod published;
mod verdict;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Value, json};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Runs a design with its spec in a folder of its own; returns the folder and what the program said.
fn run(spec: &Value, design: &Value, flags: &[&str]) -> (tempfile::TempDir, Output) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in [("spec.json", spec), ("design.json", design)] {
        std::fs::write(folder.path().join(name), value.to_string()).expect("a writable folder");
    }
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["design", "design.json", "-o", "out"])
        .args(flags)
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    (folder, output)
}

/// The summary of a design, which has the form of its schema.
fn summary(folder: &tempfile::TempDir) -> Value {
    let text = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary");
    let summary = serde_json::from_str(&text).expect("the summary is JSON");
    form::fits(&summary);
    summary
}

/// Rows of a CSV file of the output folder, by the names of its columns.
fn table(folder: &Path, name: &str) -> Vec<BTreeMap<String, String>> {
    let text = std::fs::read_to_string(folder.join(name)).expect("the table exists");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let row = |line: &str| {
        names
            .iter()
            .map(|n| (*n).to_owned())
            .zip(line.split(',').map(str::to_owned))
            .collect()
    };
    lines.map(row).collect()
}

fn number(text: &str) -> f64 {
    text.parse()
        .unwrap_or_else(|_| panic!("{text} is not a number"))
}

/// The worked runway: HEB 400 with a shear area of 0.007 m2 over 6, 7.5 and 6 m.
fn spec() -> Value {
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "timoshenko",
        "girder": {"spans": [6, 7.5, 6], "E": 2.1e8, "G": 8.1e7, "A": 0.01978, "I_vertical": 5.768e-4,
                   "kA_vertical": 0.007},
        "stations": [0, 9.75, 19.5]
    })
}

fn design() -> Value {
    json!({
        "format": "girderway-design/1", "name": "worked", "units": {"length": "m", "force": "kN", "time": "s"},
        "spec": "spec.json",
        "trains": [{"name": "crane", "wheels": [{"x": 0, "vertical": 180}, {"x": 3.6, "vertical": 180}]}]
    })
}

fn extreme<'s>(summary: &'s Value, wanted: &[(&str, Value)]) -> &'s Value {
    let all = summary["extremes"].as_array().expect("a list of extremes");
    let same = |entry: &&Value| wanted.iter().all(|(key, value)| entry[*key] == *value);
    all.iter()
        .find(same)
        .unwrap_or_else(|| panic!("no extreme with {wanted:?}"))
}

/// External: an independent Timoshenko model with elements of 0.05 m.
#[test]
fn the_worked_runway_has_its_digits() {
    let (folder, output) = run(&spec(), &design(), &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let found = summary(&folder);
    let moment = extreme(
        &found,
        &[
            ("span", json!(2)),
            ("quantity", json!("moment")),
            ("kind", json!("max")),
        ],
    );
    let value = moment["value"].as_f64().expect("a number");
    assert!((value - 241.2377).abs() < 5e-5, "{moment}");
    let x = moment["x"].as_f64().expect("a number");
    assert!(
        (x - 9.2442).abs() < 5e-5 || (x - 10.2558).abs() < 5e-5,
        "{moment}"
    );
    for (support, kind, known) in [
        ("support1", "max", 235.687),
        ("support1", "min", -28.335),
        ("support2", "max", 317.259),
        ("support2", "min", -26.143),
    ] {
        let keys = [
            ("support", json!(support)),
            ("direction", json!("uy")),
            ("kind", json!(kind)),
        ];
        let reaction = extreme(&found, &keys)["value"].as_f64().expect("a number");
        assert!(
            (reaction - known).abs() < 1e-3,
            "{support} {kind}: {reaction}, not {known}"
        );
    }
    let rows = table(&folder.path().join("out"), "envelope.csv");
    let at = |x: f64, kind: &str| {
        let same = |row: &&BTreeMap<String, String>| {
            number(&row["x"]) == x
                && row["quantity"] == "moment"
                && row["plane"] == "vertical"
                && row["kind"] == kind
        };
        number(&rows.iter().find(same).expect("the place is listed")["value"])
    };
    assert!((at(9.75, "max") - 233.048).abs() < 5e-4);
    assert!((at(6.0, "min") + 195.174).abs() < 5e-4);
}

/// Factors multiply the loads that they name; a part has its own factor, and horizontal forces stay.
#[test]
fn factors_multiply_the_loads_that_they_name() {
    let mut spec = spec();
    spec["girder"]["I_lateral"] = json!(1e-4);
    let mut design = design();
    design["trains"][0]["wheels"] =
        json!([{"x": 0, "vertical": {"crane": 60, "hoist": 120}, "lateral": 10}]);
    design["cases"] = json!([["crane"], {"name": "ultimate", "trains": ["crane"], "factors": {"crane": 1.1, "hoist": 1.5}}]);
    let (folder, output) = run(&spec, &design, &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let found = summary(&folder);
    let of = |case: usize, direction: &str| {
        let keys = [
            ("case", json!(case)),
            ("support", json!("support1")),
            ("direction", json!(direction)),
            ("kind", json!("max")),
        ];
        extreme(&found, &keys)["value"].as_f64().expect("a number")
    };
    assert!((of(1, "uy") - 180.0).abs() < 1e-9 && (of(2, "uy") - 246.0).abs() < 1e-9);
    assert!((of(1, "uz") - 10.0).abs() < 1e-9 && (of(2, "uz") - 10.0).abs() < 1e-9);
}

/// Reactions by load: dead, vertical and side thrust add up to those of all loads where they govern together.
#[test]
fn reactions_are_listed_by_load() {
    let out = tempfile::tempdir().expect("a temporary folder");
    let status = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["design", "--quiet"])
        .arg(root().join("examples/runway/design.json"))
        .arg("-o")
        .arg(out.path())
        .status()
        .expect("the program starts");
    assert!(status.success());
    let rows = table(out.path(), "reactions.csv");
    let value = |direction: &str, load: &str| {
        let same = |row: &&BTreeMap<String, String>| {
            row["case"] == "1"
                && row["support"] == "support1"
                && row["direction"] == direction
                && row["load"] == load
                && row["kind"] == "max"
        };
        number(&rows.iter().find(same).expect("the reaction is listed")["value"])
    };
    // The crane stands over the support: its whole longitudinal force goes there, and the twist is the lateral force
    // at the height of the rail: 15 kN (1 + 2.4/6) 0.275 m.
    assert!((value("ux", "traction") - 25.0).abs() < 1e-9);
    assert!((value("rx", "side thrust") - 15.0 * 1.4 * 0.275).abs() < 1e-9);
    // Traction at the height of the rail bends the girder, and lifts or presses the supports a little.
    let together = value("uy", "dead") + value("uy", "vertical") + value("uy", "traction");
    let text = std::fs::read_to_string(out.path().join("summary.json")).expect("a summary");
    let found: Value = serde_json::from_str(&text).expect("JSON");
    let keys = [
        ("case", json!(1)),
        ("support", json!("support1")),
        ("direction", json!("uy")),
        ("kind", json!("max")),
    ];
    let all = extreme(&found, &keys)["value"].as_f64().expect("a number");
    assert!(
        all <= together + 1e-9 && all > together - 5.0,
        "{all} and {together}"
    );
    for file in ["report.html", "manifest.json", "envelope.csv"] {
        assert!(out.path().join(file).is_file(), "{file} is missing");
    }
}

/// The same design gives the same bytes, whatever the number of threads.
#[test]
fn equal_designs_give_equal_bytes() {
    let manifest = |threads: &str| {
        let (folder, output) = run(&spec(), &design(), &["--quiet", "--threads", threads]);
        assert!(output.status.success());
        std::fs::read(folder.path().join("out/manifest.json")).expect("a manifest")
    };
    assert_eq!(manifest("1"), manifest("2"));
}

/// The runway under a crane whose wheel loads are given in parts, with the data that codes need.
fn coded(practice: Value) -> Value {
    let wheel = |x: f64| json!({"x": x, "vertical": {"crane": 60, "hoist": 120}, "skewing": 12});
    json!({
        "format": "girderway-design/1", "name": "coded", "units": {"length": "m", "force": "kN", "time": "s"},
        "spec": "spec.json",
        "trains": [{"name": "crane", "wheels": [wheel(0.0), wheel(3.6)], "longitudinal": 20}],
        "practice": practice
    })
}

/// The spec of the worked runway with the stiffness that lateral forces need.
fn lateral_spec() -> Value {
    let mut spec = spec();
    spec["girder"]["I_lateral"] = json!(1.082e-4);
    spec
}

fn by_name<'s>(summary: &'s Value, name: &str) -> &'s Value {
    let cases = summary["cases"].as_array().expect("a list of cases");
    cases
        .iter()
        .find(|case| case["name"] == name)
        .unwrap_or_else(|| panic!("no case {name} in {cases:?}"))
}

/// Hand calculation, EN 1991-3: HC2 at 0.133 m/s has phi2 = 1.10 + 0.34 * 0.133 = 1.14522 (Tables 2.4 and 2.5); group 1
/// has phi1 = 1.1 on the crane and phi5 = 1.5 on drives, group 5 the factor 1 on all and on skewing.
#[test]
fn groups_of_a_code_become_cases_with_their_factors() {
    let practice = json!({"code": "EN 1991-3", "hoisting": "HC2", "hoist_speed": 0.133, "combinations": true, "s_class": "S5"});
    let (folder, output) = run(&lateral_spec(), &coded(practice), &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let found = summary(&folder);
    let first = &by_name(&found, "crane: EN 1991-3:2006 group 1")["factors"];
    for (load, known) in [
        ("crane", 1.1),
        ("hoist", 1.14522),
        ("longitudinal", 1.5),
        ("dead", 1.0),
        ("skewing", 0.0),
    ] {
        let factor = first[load].as_f64().expect("a factor");
        assert!((factor - known).abs() < 1e-12, "{load}: {factor}");
    }
    let fifth = by_name(&found, "crane: EN 1991-3:2006 group 5");
    assert_eq!(
        [
            &fifth["factors"]["skewing"],
            &fifth["factors"]["longitudinal"]
        ],
        [&json!(1.0), &json!(0.0)]
    );
    // The moments of a group are those of the wheel loads with its factors: 60 * 1.1 + 120 * 1.14522 in place of 180.
    let moment = |case: usize| {
        let keys = [
            ("case", json!(case)),
            ("span", json!(2)),
            ("quantity", json!("moment")),
            ("kind", json!("max")),
        ];
        let vertical = [&keys[..], &[("plane", json!("vertical"))]].concat();
        extreme(&found, &vertical)["value"]
            .as_f64()
            .expect("a number")
    };
    let factored = (60.0 * 1.1 + 120.0 * 1.14522) / 180.0;
    assert!(
        (moment(2) / moment(1) / factored - 1.0).abs() < 1e-12,
        "{} and {}",
        moment(1),
        moment(2)
    );
    // Skewing acts where a factor names it, and is listed as a load of its own.
    let rows = table(&folder.path().join("out"), "reactions.csv");
    assert!(
        rows.iter()
            .any(|row| row["load"] == "skewing" && number(&row["value"]) > 1.0),
        "{rows:?}"
    );
    // Damage-equivalent loads by hand: lambda = 0.63 for S5 (Table 2.12), (1.05 * 60 + 1.07261 * 120) * 0.63.
    let equivalent = found["fatigue"][0]["wheels"][0]["normal"]
        .as_f64()
        .expect("a load");
    assert!(
        (equivalent - 0.63 * (1.05 * 60.0 + 1.07261 * 120.0)).abs() < 1e-9,
        "{equivalent}"
    );
    // What the design lacks is named.
    let left_out = found["left_out"].to_string();
    assert!(
        left_out.contains("group 9 (EN 1991-3:2006): no train has a `buffer` force"),
        "{left_out}"
    );
}

/// Hand calculation: the worked sag of span 2 is 9.385 mm from the undeflected line, and its limits are 7.5 m/600 = 12.5 mm
/// (EN 1993-6, Table 7.2), 7.5 m/1000 = 7.5 mm (AIST TR-13, class A).
#[test]
fn limits_follow_the_code_and_its_class() {
    for (practice, limit, within) in [
        (json!({"code": "EN 1991-3"}), 7.5 / 600.0, true),
        (
            json!({"code": "AIST TR-13", "building_class": "A"}),
            7.5 / 1000.0,
            false,
        ),
        (
            json!({"code": "AISC Design Guide 7", "class": "C"}),
            7.5 / 600.0,
            true,
        ),
        (
            json!({"code": "AISC Design Guide 7", "class": "D"}),
            7.5 / 800.0,
            false,
        ),
    ] {
        let mut design = design();
        design["practice"] = practice.clone();
        let (folder, output) = run(&spec(), &design, &[]);
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let found = summary(&folder);
        let rows = found["limits"].as_array().expect("limits");
        let row = rows
            .iter()
            .find(|row| row["span"] == 2)
            .expect("a row for every span");
        assert!(
            (row["limit"].as_f64().expect("a limit") - limit).abs() < 1e-12,
            "{row}"
        );
        assert!(
            (row["value"].as_f64().expect("a value") - 9.385e-3).abs() < 2e-5,
            "{row}"
        );
        assert_eq!(
            (row["within"].as_bool(), found["within"].as_bool()),
            (Some(within), Some(within)),
            "{row}"
        );
        assert!(
            row["source"].is_string() && row["edition"].is_string() && row["clause"].is_string(),
            "{row}"
        );
        let (_folder, output) = run(&spec(), &design, &["--fail-on-limit"]);
        assert_eq!(
            output.status.code(),
            Some(if within { 0 } else { 1 }),
            "{practice}"
        );
    }
}

/// Timoshenko and Gere (1961), section 1.3: under half of the Euler load a wheel at mid-span has the moment F l/4 tan(u)/u, u =
/// (pi/2) sqrt(1/2). The design says nothing of an error.
#[test]
fn a_design_about_a_preload_has_the_closed_moment() {
    let mut spec = spec();
    spec["theory"] = json!("euler-bernoulli");
    spec["girder"]["spans"] = json!([6]);
    spec["stations"] = json!([0, 3, 6]);
    let euler = (std::f64::consts::PI / 6.0).powi(2) * 2.1e8 * 5.768e-4;
    spec["preload"] = json!({"loads": [{"x": 6, "force": [-0.5 * euler, 0, 0]}]});
    let mut design = design();
    design["trains"][0]["wheels"] = json!([{"x": 0, "vertical": 180}]);
    let (folder, output) = run(&spec, &design, &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let summary = summary(&folder);
    let u = 0.5 * std::f64::consts::PI * 0.5_f64.sqrt();
    let wanted = [
        ("quantity", json!("moment")),
        ("plane", json!("vertical")),
        ("kind", json!("max")),
    ];
    let found = extreme(&summary, &wanted)["value"]
        .as_f64()
        .expect("a number");
    assert!(
        (found / (0.25 * 180.0 * 6.0 * u.tan() / u) - 1.0).abs() < 1e-9,
        "{found}"
    );
    assert!(
        !summary["warnings"].to_string().contains("err by"),
        "{}",
        summary["warnings"]
    );
}

/// Statics: of states that differ by signs alone several have the same moment, and which of them is said to govern is a
/// matter of rounding; the largest stress is the same in any unit.
#[test]
fn stresses_do_not_depend_on_units() {
    let spec = json!({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "girder": {"spans": [4.57, 5.56, 5.72, 7.98], "overhangs": [0.68, 0], "fy": 235000.0, "E": 2.1e8, "G": 8.1e7,
            "density": 7.85, "rail_height": 0.35, "shape": {"kind": "I", "height": 700, "width": 300, "flange": 20,
                "web": 12, "lower_width": 200, "lower_flange": 15, "length": "mm"}},
        "stations": [-0.68, 1.949, 6.025, 9.713, 10.75, 21.778, 23.83]});
    let stress = |length: &str, force: &str, [l, f]: [f64; 2]| {
        let train = json!({"name": "t", "ends": [0.09 * l, 0.34 * l], "lateral": 1.96 * f, "longitudinal": 14.02 * f,
            "wheels": [{"x": 0, "vertical": 157.77 * f},
                {"x": 2.528 * l, "vertical": 113.08 * f, "longitudinal": -2.88 * f, "eccentricity": -0.043 * l}]});
        let design = json!({"format": "girderway-design/1", "units": {"length": length, "force": force, "time": "s"},
            "spec": "spec.json", "dead_load": {"weight": true, "line": {"rail": 0.6 * f / l}}, "trains": [train],
            "practice": {"code": "CMAA 70"}});
        let (folder, output) = run(&spec, &design, &[]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        let found = summary(&folder);
        let mut all = found["stresses"].as_array().expect("a list").iter();
        let own = all
            .find(|one| one["quantity"] == "direct stress")
            .expect("a direct stress");
        let utilisation = own["utilisation"].as_f64().expect("a number");
        (utilisation, own["signs"].clone(), own["side"].clone())
    };
    let metres = stress("m", "kN", [1.0, 1.0]);
    let others = [
        ("mm", "N", [1e3, 1e3]),
        ("mm", "kN", [1e3, 1.0]),
        ("m", "N", [1.0, 1e3]),
    ];
    for (length, force, factors) in others {
        let own = stress(length, force, factors);
        assert!((own.0 / metres.0 - 1.0).abs() < 1e-9, "{own:?} {metres:?}");
        assert_eq!((&own.1, &own.2), (&metres.1, &metres.2), "{length} {force}");
    }
}
