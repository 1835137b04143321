//! `girderway splines --check` and `--tolerance`, as a user meets them.

use std::fs;
use std::process::Output;

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{base, example, folder, girderway, json as parsed, path, text};

/// The paper's printed tables.
fn printed() -> String {
    path(&example("bogie").join("printed.adm")).to_owned()
}

fn check(folder: &TempDir, file: &str, more: &[&str]) -> (Option<i32>, Value) {
    let run = girderway(
        folder,
        &[&["splines", file, "--check", "--json"], more].concat(),
    );
    assert_eq!(text(&run.stderr), "", "{file}");
    (run.status.code(), parsed(&run.stdout))
}

/// The grid of an example's spec.
fn grid(folder: &TempDir, name: &str) {
    let run = girderway(
        folder,
        &[
            "fea",
            path(&example(name).join("spec.json")),
            "-o",
            "grid.json",
            "--quiet",
        ],
    );
    assert_eq!(run.status.code(), Some(0));
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn close(found: &Value, asked: f64, tolerance: f64) {
    assert!(
        (number(found) / asked - 1.0).abs() < tolerance,
        "found {found}, asked {asked:e}"
    );
}

/// A reading of the first table.
fn reading<'v>(found: &'v Value, word: &str) -> &'v Value {
    let all = found["tables"][0]["readings"].as_array().expect("readings");
    all.iter()
        .find(|reading| reading["reading"] == word)
        .expect("the reading")
}

/// A data set of one family named `name`, its rows z then values, x from `x`.
fn family(folder: &TempDir, name: &str, x: &str, rows: &[&str]) {
    let rows: Vec<String> = rows.iter().map(|row| format!(", Y = {row}\n")).collect();
    let text = format!(
        "tables\nUNITS/FORCE = NEWTON, MASS = KILOGRAM, LENGTH = METER, TIME = SECOND\n!  adams_view_name='{name}'\n\
         SPLINE/3\n, X = {x}\n{}, LINEAR_EXTRAPOLATE\nEND\n",
        rows.concat()
    );
    fs::write(folder.path().join("family.adm"), text).expect("writable");
}

/// Regression, measured first on an independent prototype: work of a loop, jumps of slope, rules beyond the table and errors
/// of the paper's printed table.
#[test]
fn printed_table_is_told_with_the_measured_figures() {
    let folder = folder();
    let more = [
        "--load",
        "2.4e6",
        "--spacing",
        "2.6666666667",
        "--beyond",
        "5",
    ];
    let (status, found) = check(&folder, &printed(), &more);
    assert_eq!(
        (status, &found["passed"], &found["format"]),
        (Some(0), &json!(true), &json!("girderway-check/1"))
    );
    let table = &found["tables"][0];
    assert_eq!(
        (&table["digits"], &table["supports"], &table["id"]),
        (&json!(3), &json!([0.0, 60.0]), &json!(6))
    );
    close(&table["exact"]["EI"], 1.0020 * 9.528 * 4.32e9, 1e-4);
    let akispl = reading(&found, "akispl");
    close(&akispl["pair"]["work"], 30_789.0, 2e-3);
    close(&akispl["pair"]["at"][0], 15.0, 1e-9);
    close(&akispl["slope_jump"]["before"], 2.26e-9, 0.01);
    close(&akispl["slope_jump"]["beyond"], -2.26e-9, 0.01);
    close(&akispl["error"]["relative"], 6.6e-2, 0.02);
    close(&akispl["error_between_supports"]["relative"], 7.3e-2, 0.03);
    close(
        &reading(&found, "natural")["error"]["relative"],
        8.8e-3,
        0.02,
    );
    assert_eq!(
        reading(&found, "natural")["layouts"][2]["stiffness"],
        Value::Null
    );
    assert!(number(&akispl["layouts"][2]["stiffness"]) < 1e9);
    for (rule, asked) in [
        ("parabola", 1.956e-7),
        ("cubic", 1.955e-7),
        ("tangent", 1.921e-7),
        ("line", 1.813e-7),
    ] {
        close(&table["beyond"][1][rule], asked, 4e-4);
    }
    // The lateral table is no beam's in bending: nothing says what is exact.
    let lateral = &found["tables"][1];
    assert_eq!(
        (&lateral["exact"], &lateral["readings"][0]["error"]),
        (&Value::Null, &Value::Null)
    );
}

#[test]
fn text_goes_to_standard_output_and_names_every_reading() {
    let folder = folder();
    let run = girderway(&folder, &["splines", &printed(), "--check"]);
    assert_eq!((run.status.code(), text(&run.stderr)), (Some(0), ""));
    let told = text(&run.stdout);
    for words in [
        "SPLINE/6 rail_vertical",
        "akispl",
        "natural",
        "never",
        "uncertainty of the digits",
        "rigid supports inside the table",
    ] {
        assert!(told.contains(words), "{words}");
    }
    assert!(told.is_ascii() && !told.contains("NaN") && !told.contains("inf "));
}

/// The grid file says what is exact: the raised values agree with it, errors are those of the printed table but for its
/// digits, and couplings are checked too.
#[test]
fn grid_file_is_checked_against_its_surface() {
    let folder = folder();
    grid(&folder, "bogie");
    let (status, found) = check(&folder, "grid.json", &[]);
    assert_eq!(status, Some(0));
    assert!(number(&reading(&found, "exact")["error"]["relative"]) < 1e-14);
    close(
        &reading(&found, "akispl")["error"]["relative"],
        6.6e-2,
        0.02,
    );
    close(
        &reading(&found, "cubspl")["error_between_supports"]["relative"],
        8.0e-2,
        0.02,
    );
    let tables = found["tables"].as_array().expect("tables");
    assert_eq!(tables.len(), 6);
    let coupling = tables
        .iter()
        .find(|table| table["id"] == 10)
        .expect("vertical from longitudinal");
    assert!(
        coupling["direct"] == false && number(&coupling["readings"][0]["error"]["relative"]) > 1e-3
    );
    assert_eq!(tables[3]["readings"], json!([]));
}

/// Supports and hinges between the stations of the mill's girderway.
#[test]
fn breaks_without_stations_are_named() {
    let folder = folder();
    grid(&folder, "mill_girderway");
    let (status, found) = check(&folder, "grid.json", &[]);
    let hazards = found["tables"][0]["hazards"].as_array().expect("hazards");
    let kinds: Vec<&str> = hazards
        .iter()
        .filter_map(|hazard| hazard["kind"].as_str())
        .collect();
    assert_eq!(
        (status, kinds),
        (Some(0), vec!["uneven-stations", "breaks-without-station"])
    );
}

#[test]
fn error_above_the_tolerance_fails_with_status_1() {
    let folder = folder();
    let first = |more: &[&str]| {
        let (status, found) = check(&folder, "one.adm", more);
        (status, found["tables"][0]["failed"].clone())
    };
    let text = fs::read_to_string(printed()).expect("the printed tables");
    let (one, _) = text
        .split_once("!  adams_view_name='rail_lateral'")
        .expect("two tables");
    fs::write(folder.path().join("one.adm"), format!("{one}END\n")).expect("writable");
    let (status, failed) = first(&["--tolerance", "0.05"]);
    assert_eq!(
        (status, &failed[0]["reading"], failed[0]["check"].as_str()),
        (Some(1), &json!("akispl"), Some("error"))
    );
    assert_eq!(first(&["--tolerance", "0.07"]), (Some(0), json!([])));
    assert_eq!(
        first(&["--tolerance", "0.01", "--reading", "natural"]),
        (Some(0), json!([]))
    );
    let (status, failed) = first(&["--tolerance", "0.01", "--reading", "symmetrised"]);
    assert_eq!(
        (status, failed.as_array().map(Vec::len)),
        (Some(1), Some(1))
    );
    // Nothing says what is exact of the lateral table: its error cannot be shown to be small.
    let (status, found) = check(&folder, &printed(), &["--tolerance", "0.5"]);
    assert_eq!(
        (status, &found["tables"][1]["failed"][0]["error"]),
        (Some(1), &Value::Null)
    );
}

/// One unit of the last digit is no asymmetry; more is, and so is a diagonal that no structure has.
#[test]
fn unsymmetric_and_indefinite_tables_fail_beyond_their_digits() {
    let folder = folder();
    let x = "0, 1, 2, 3";
    let last = "3, 1.01E-8, 1.02E-8, 1.03E-8, 3.03E-8";
    let verdicts = |rows: &[&str]| {
        family(&folder, "rail_vertical", x, rows);
        let (status, found) = check(&folder, "family.adm", &[]);
        let failed = found["tables"][0]["failed"]
            .as_array()
            .expect("a list")
            .clone();
        let words: Vec<String> = failed
            .iter()
            .filter_map(|f| f["check"].as_str())
            .map(str::to_owned)
            .collect();
        (status, words)
    };
    let sound = [
        "0, 3.03E-8, 1.02E-8, 1.02E-8, 1.01E-8",
        "1, 1.02E-8, 3.03E-8, 1.02E-8, 1.02E-8",
        "2, 1.02E-8, 1.02E-8, 3.03E-8, 1.03E-8",
        last,
    ];
    assert_eq!(verdicts(&sound), (Some(0), vec![]));
    let rounded = [
        sound[0],
        "1, 1.03E-8, 3.03E-8, 1.02E-8, 1.02E-8",
        sound[2],
        last,
    ];
    assert_eq!(verdicts(&rounded), (Some(0), vec![]));
    let skewed = [
        sound[0],
        "1, 1.32E-8, 3.03E-8, 1.02E-8, 1.02E-8",
        sound[2],
        last,
    ];
    assert_eq!(verdicts(&skewed), (Some(1), vec!["symmetric".to_owned()]));
    let negative = [
        sound[0],
        "1, 1.02E-8, -3.03E-8, 1.02E-8, 1.02E-8",
        sound[2],
        last,
    ];
    assert_eq!(
        verdicts(&negative),
        (Some(1), vec!["positive-semidefinite".to_owned()])
    );
    // As a coupling, by its name, the same numbers are nothing to complain of.
    family(&folder, "rail_vertical_lateral", x, &negative);
    assert_eq!(check(&folder, "family.adm", &[]).0, Some(0));
}

/// Deflections at other stations than loads: ADAMS reads that, the natural tensor does not.
#[test]
fn table_that_is_not_square_is_read_as_far_as_it_goes() {
    let folder = folder();
    family(
        &folder,
        "rail_vertical",
        "0, 1, 2, 3, 4",
        &[
            "0, 0, 0, 0, 0, 0",
            "2.5, 0, 1E-8, 2E-8, 1E-8, 0",
            "4, 0, 0, 0, 0, 0",
        ],
    );
    let (status, found) = check(&folder, "family.adm", &[]);
    assert_eq!(status, Some(0));
    let table = &found["tables"][0];
    let words: Vec<&Value> = table["readings"]
        .as_array()
        .expect("readings")
        .iter()
        .map(|r| &r["reading"])
        .collect();
    assert_eq!(words, ["akispl", "symmetrised", "cubspl"]);
    assert_eq!(
        (&table["asymmetry"], &table["eigenvalues"]),
        (&Value::Null, &Value::Null)
    );
    assert!(number(&table["readings"][0]["asymmetry"]["value"]) > 0.0);
}

#[test]
fn zeros_alone_are_read_without_a_division_by_them() {
    let folder = folder();
    family(
        &folder,
        "rail_vertical",
        "0, 1, 2, 3",
        &[
            "0, 0, 0, 0, 0",
            "1, 0, 0, 0, 0",
            "2, 0, 0, 0, 0",
            "3, 0, 0, 0, 0",
        ],
    );
    let run = girderway(&folder, &["splines", "family.adm", "--check"]);
    assert_eq!((run.status.code(), text(&run.stderr)), (Some(0), ""));
    assert!(
        text(&run.stdout).contains("no coupling")
            || text(&run.stdout).contains("nothing but zeros")
    );
}

fn refused(run: &Output) -> String {
    assert_eq!(
        (run.status.code(), text(&run.stdout)),
        (Some(2), ""),
        "{}",
        text(&run.stderr)
    );
    let told = text(&run.stderr).to_owned();
    assert!(
        !told.is_empty() && !told.contains("panicked") && !told.contains("internal error"),
        "{told}"
    );
    told
}

#[test]
fn what_cannot_be_checked_is_refused_with_its_place() {
    let folder = folder();
    let write =
        |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("writable");
    write(
        "garbage.adm",
        "title\nSPLINE/6\n, X = 0, 1, two, 3\n, Y = 1, 2, 3, 4\nEND\n",
    );
    write(
        "curve.adm",
        "title\nSPLINE/6\n, X = 0, 1, 2, 3\n, Y = 1, 2, 3, 4\nEND\n",
    );
    write("none.adm", "title\nPART/1, GROUND\nEND\n");
    write(
        "large.adm",
        "title\nSPLINE/6\n, X = 0, 1, 2, 3\n, Y = 0, 1, 2, 3, 1e200\n, Y = 1, 1, 2, 3, 4\nEND\n",
    );
    write(
        "near.adm",
        "title\nSPLINE/6\n, X = 0, 1, 1.0000000000001, 3\n, Y = 0, 1, 2, 3, 4\n, Y = 1, 1, 2, 3, 4\nEND\n",
    );
    write(
        "text.json",
        "{\"format\": \"girderway-grid/1\",\n \"nane\": 1}",
    );
    let mut short = parsed(&fs::read(base("grid.json")).expect("the base grid"));
    short["rails"] = json!([{"name": "a", "stations": [0, 1]}, {"name": "b", "stations": [0, 1]}]);
    write("short.json", &short.to_string());
    for (file, words) in [
        ("garbage.adm", "garbage.adm:3:"),
        ("curve.adm", "has no SPLINE with a curve for each z"),
        ("none.adm", "has no SPLINE with a curve for each z"),
        ("large.adm", "SPLINE/6 has the value 1e200"),
        ("near.adm", "SPLINE/6 has stations at 1 and 1.0000000000001"),
        ("text.json", "text.json:2:2: nane"),
        ("short.json", "must have a rail of at least four stations"),
        ("absent.adm", "no such file"),
    ] {
        let told = refused(&girderway(&folder, &["splines", file, "--check"]));
        assert!(told.contains(words), "{file}: {told}");
    }
    let told = refused(&girderway(
        &folder,
        &["splines", &printed(), "--check", "-o", "check.png"],
    ));
    assert!(told.contains("use .svg, .html or .json"), "{told}");
    refused(&girderway(&folder, &["splines", &printed(), "--load", "5"]));
    refused(&girderway(
        &folder,
        &["splines", &printed(), "--check", "--load", "-5"],
    ));
    refused(&girderway(
        &folder,
        &["splines", "grid.json", "--reading", "akispl"],
    ));
    let told = refused(&girderway(
        &folder,
        &["splines", path(&base("grid.json")), "--tolerance", "1e-2"],
    ));
    assert!(
        told.contains("--tolerance requires --reading, --check or --form factored"),
        "{told}"
    );
}

#[test]
fn pictures_and_pages_are_whole_and_hold_every_direct_table() {
    let folder = folder();
    grid(&folder, "bogie");
    for file in ["check.svg", "check.html", "check.json"] {
        let run = girderway(&folder, &["splines", "grid.json", "--check", "-o", file]);
        assert_eq!(run.status.code(), Some(0));
        assert_eq!(text(&run.stderr), format!("wrote {file}\n"));
        assert!(text(&run.stdout).starts_with("SPLINE/6"));
    }
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("written");
    let svg = read("check.svg");
    let tree = roxmltree::Document::parse(&svg).expect("XML");
    // A chart and a map of three directions, a map of one coupling.
    assert_eq!(
        tree.root_element()
            .children()
            .filter(|node| node.has_tag_name("svg"))
            .count(),
        7
    );
    for words in [
        "akispl",
        "symmetrised",
        "error under one moving wheel",
        "minus exact",
    ] {
        assert!(
            svg.contains(words) && read("check.html").contains(words),
            "{words}"
        );
    }
    assert_eq!(
        parsed(read("check.json").as_bytes())["tables"]
            .as_array()
            .map(Vec::len),
        Some(6)
    );
    let nothing = base("grid.json");
    let told = refused(&girderway(
        &folder,
        &["splines", path(&nothing), "--check", "-o", "none.svg"],
    ));
    assert!(
        told.contains("no figure: the exact influence function of the tables is unknown"),
        "{told}"
    );
    assert!(!folder.path().join("none.svg").exists());
}

/// Stations of a tolerance: those told, supports among them, with the values that the solver gives there.
#[test]
fn tables_at_the_fewest_stations_hold_what_the_solver_gives_there() {
    let folder = folder();
    grid(&folder, "bogie");
    let arguments = [
        "splines",
        "grid.json",
        "--reading",
        "akispl",
        "--tolerance",
        "1e-2",
        "--directions",
        "vertical",
        "-o",
        "out.adm",
    ];
    let run = girderway(&folder, &arguments);
    assert_eq!((run.status.code(), text(&run.stdout)), (Some(0), ""));
    // Regression: the number in the book.
    assert!(
        text(&run.stderr).starts_with("rail rail: 16 stations, akispl has an error of at most 9."),
        "{}",
        text(&run.stderr)
    );
    let set =
        adams::tables::read(&fs::read_to_string(folder.path().join("out.adm")).expect("written"))
            .expect("tables");
    let stations = set.splines[0].curves.x();
    assert!(stations.len() == 16 && stations.contains(&0.0) && stations.contains(&60.0));
    let mut spec = parsed(&fs::read(example("bogie").join("spec.json")).expect("the spec"));
    spec["stations"] = json!(stations);
    fs::write(folder.path().join("spec.json"), spec.to_string()).expect("writable");
    let solved = parsed(&girderway(&folder, &["fea", "spec.json", "--quiet"]).stdout);
    for (index, block) in ["vertical", "lateral", "longitudinal"]
        .into_iter()
        .enumerate()
    {
        let y = set.splines[index].curves.y();
        let largest = y.iter().flatten().fold(0.0_f64, |a, v| a.max(v.abs()));
        for (i, row) in y.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                let exact = number(&solved["influence"][block][i][j]);
                assert!((value - exact).abs() < 1e-12 * largest, "{block} {i} {j}");
                assert_eq!(value.to_bits(), y[j][i].to_bits());
            }
        }
    }
    // The check of what was written agrees: the same reading keeps the tolerance against the beam behind the values.
    let (_, found) = check(&folder, "out.adm", &[]);
    let error = number(&reading(&found, "akispl")["error"]["relative"]);
    assert!(error <= 1e-2 && error > 0.85e-2, "{error}");
    let run = girderway(&folder, &[&arguments[..], &["--json"]].concat());
    let told = parsed(&run.stdout);
    assert_eq!(
        (told["rails"][0]["count"].as_u64(), text(&run.stderr)),
        (Some(16), "")
    );
    assert!(number(&told["rails"][0]["error"]["relative"]) <= 1e-2);
}

#[test]
fn exact_form_needs_the_supports_and_ends_alone() {
    let folder = folder();
    grid(&folder, "bogie");
    let run = girderway(
        &folder,
        &[
            "splines",
            "grid.json",
            "--reading",
            "exact",
            "--tolerance",
            "1e-12",
            "-o",
            "out.adm",
        ],
    );
    assert_eq!(run.status.code(), Some(0));
    assert!(
        text(&run.stderr).starts_with("rail rail: 4 stations"),
        "{}",
        text(&run.stderr)
    );
    grid(&folder, "mill_girderway");
    let told = refused(&girderway(
        &folder,
        &[
            "splines",
            "grid.json",
            "--reading",
            "exact",
            "--tolerance",
            "1e-3",
        ],
    ));
    assert!(
        told.contains("influence: is not that of a uniform beam"),
        "{told}"
    );
}

/// Two rails on one girder: both get stations, and what one gives the other keeps the tolerance too.
#[test]
fn paired_rails_get_stations_of_their_own() {
    let folder = folder();
    let mut spec = parsed(&fs::read(base("frame.json")).expect("the base frame"));
    let top = spec["rails"]["top"].clone();
    let mut under = top.clone();
    under["segments"][0]["offset"] = json!([0, -0.3, 0]);
    under["stations"] = json!([0, 3, 6]);
    spec["rails"] = json!({"top": top, "under": under});
    fs::write(folder.path().join("spec.json"), spec.to_string()).expect("writable");
    assert_eq!(
        girderway(&folder, &["fea", "spec.json", "-o", "grid.json", "--quiet"])
            .status
            .code(),
        Some(0)
    );
    let told = girderway(&folder, &["splines", "grid.json", "--check"]);
    assert_eq!(told.status.code(), Some(0), "{}", text(&told.stderr));
    assert!(text(&told.stdout).contains("rail under has fewer than four stations"));
    let run = girderway(
        &folder,
        &[
            "splines",
            "grid.json",
            "--reading",
            "natural",
            "--tolerance",
            "0.02",
            "--directions",
            "vertical",
            "-o",
            "out.adm",
            "--json",
        ],
    );
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let told = parsed(&run.stdout);
    assert_eq!(told["rails"].as_array().map(Vec::len), Some(2));
    let across = told["others"]
        .as_array()
        .expect("a list")
        .iter()
        .filter(|block| {
            block["deflection"]["axis"] == "vertical" && block["load"]["axis"] == "vertical"
        });
    let errors: Vec<f64> = across.map(|block| number(&block["relative"])).collect();
    assert!(errors.len() == 1 && errors[0] <= 0.02, "{errors:?}");
}

#[test]
fn stations_that_cannot_be_found_are_refused_in_words() {
    let folder = folder();
    let told = refused(&girderway(
        &folder,
        &[
            "splines",
            path(&base("grid.json")),
            "--reading",
            "akispl",
            "--tolerance",
            "1e-2",
        ],
    ));
    assert!(
        told.contains("grid.json:")
            && told.contains("has no `surface` (exact influence function between stations)")
            && told.contains("girderway fea"),
        "{told}"
    );
    let mut spec = parsed(&fs::read(example("bogie").join("spec.json")).expect("the spec"));
    for key in ["I_lateral", "J"] {
        spec["girder"]
            .as_object_mut()
            .expect("an object")
            .remove(key);
    }
    fs::write(folder.path().join("spec.json"), spec.to_string()).expect("writable");
    assert_eq!(
        girderway(&folder, &["fea", "spec.json", "-o", "grid.json", "--quiet"])
            .status
            .code(),
        Some(0)
    );
    let told = refused(&girderway(
        &folder,
        &[
            "splines",
            "grid.json",
            "--reading",
            "akispl",
            "--tolerance",
            "1e-2",
            "--directions",
            "lateral",
        ],
    ));
    assert!(told.contains("has no lateral grid"), "{told}");
    let run = girderway(
        &folder,
        &[
            "splines",
            "grid.json",
            "--reading",
            "akispl",
            "--tolerance",
            "1e-7",
        ],
    );
    assert_eq!((run.status.code(), text(&run.stdout)), (Some(1), ""));
    assert!(
        text(&run.stderr).contains("400 stations"),
        "{}",
        text(&run.stderr)
    );
}
