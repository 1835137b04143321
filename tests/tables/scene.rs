//! Scenes on tables of every format.

use std::fs;
use std::path::Path;

use formats::scene::{Document, Origin};

use super::{ENDINGS, bogie_grid, folder, girderway, told};

fn scene(folder: &Path, tables: &str, reading: &str) -> String {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/malformed/base/scene.json");
    let text = fs::read_to_string(base).expect("the base scene");
    let structure = format!("\"tables\": {tables}, \"reading\": \"{reading}\"");
    let text = text
        .replace("\"spec\": \"spec.json\"", &structure)
        .replace("\"time\": 12}", "\"time\": 1}");
    fs::write(folder.join("scene.json"), &text).expect("writable");
    text
}

fn stations_and_values(folder: &Path) -> (Vec<f64>, Vec<Vec<f64>>) {
    let document =
        Document::open(&folder.join("scene.json")).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let structure = &document.scene().structures[0];
    let Origin::Tables { tables, .. } = &structure.origin else {
        panic!("tables")
    };
    (
        tables.stations.clone(),
        tables.vertical.clone().expect("a vertical table"),
    )
}

#[test]
fn a_scene_reads_the_same_numbers_from_every_format() {
    let folder = folder();
    bogie_grid(folder.path());
    let mut first = None;
    for ending in ENDINGS {
        let run = girderway(
            folder.path(),
            &["splines", "grid.json", "-o", &format!("bridge.{ending}")],
        );
        assert_eq!(run.status.code(), Some(0), "{}", told(&run));
        for pick in ["6", "\"vertical\"", "\"bridge_flex_rail_vertical\""] {
            let tables =
                format!("{{\"file\": \"bridge.{ending}\", \"vertical\": {pick}, \"lateral\": 7}}");
            scene(folder.path(), &tables, "natural");
            let found = stations_and_values(folder.path());
            assert_eq!(
                first.get_or_insert_with(|| found.clone()),
                &found,
                "{ending} {pick}"
            );
        }
    }
    let (stations, values) = first.expect("five formats");
    // mid-span: 1/48 L^3/EI of the paper's girder
    assert_eq!(stations[3], 30.0);
    assert!((values[3][3] / (60_f64.powi(3) / 48.0 / (9.528 * 4.32e9)) - 1.0).abs() < 1e-12);
}

#[test]
fn a_scene_says_the_units_of_a_file_that_does_not() {
    let folder = folder();
    let text = ",-20,20,40,60\n-20,4,3,2,1\n20,3,4,3,2\n40,2,3,4,3\n60,1,2,3,4\n";
    fs::write(folder.path().join("vertical.csv"), text).expect("writable");
    let units = "{\"length\": \"m\", \"force\": \"N\", \"time\": \"s\"}";
    let tables =
        format!("{{\"file\": \"vertical.csv\", \"units\": {units}, \"vertical\": \"vertical\"}}");
    scene(folder.path(), &tables, "natural");
    let (stations, values) = stations_and_values(folder.path());
    assert!((stations[1] * 0.3048 / 20.0 - 1.0).abs() < 1e-15);
    assert!((values[0][0] * 0.3048 / 4.448_221_615_260_5 / 4.0 - 1.0).abs() < 1e-15);
    scene(
        folder.path(),
        "{\"file\": \"vertical.csv\", \"vertical\": 6}",
        "natural",
    );
    let wrong = Document::open(&folder.path().join("scene.json"))
        .map(|_| ())
        .expect_err("no units");
    assert!(
        wrong[0]
            .hint
            .as_ref()
            .is_some_and(|hint| hint.contains("or specify --length ft --force lbf")),
        "{wrong:?}"
    );
}

/// The factored form is the natural reading of its own products at the stations.
#[test]
fn a_scene_runs_on_the_factored_form_as_on_the_tables() {
    let folder = folder();
    bogie_grid(folder.path());
    let mut deflections = Vec::new();
    for (name, form) in [("plain.npz", "table"), ("factored.adm", "factored")] {
        let run = girderway(
            folder.path(),
            &[
                "splines",
                "grid.json",
                "-o",
                name,
                "--form",
                form,
                "--only",
                "vertical",
            ],
        );
        assert_eq!(run.status.code(), Some(0), "{}", told(&run));
        scene(
            folder.path(),
            &format!("{{\"file\": \"{name}\", \"vertical\": \"vertical\"}}"),
            "natural",
        );
        let run = girderway(
            folder.path(),
            &["run", "scene.json", "-o", "out", "--quiet"],
        );
        assert_eq!(run.status.code(), Some(0), "{}", told(&run));
        let history = fs::read_to_string(folder.path().join("out/history.csv")).expect("a history");
        let column = history
            .lines()
            .next()
            .expect("a header")
            .split(',')
            .position(|name| name == "bogie.deflection");
        let column = column.expect("the bogie's deflection");
        let values: Vec<f64> = history
            .lines()
            .skip(1)
            .map(|line| {
                line.split(',')
                    .nth(column)
                    .expect("a cell")
                    .parse()
                    .expect("a number")
            })
            .collect();
        deflections.push(values);
    }
    let largest = deflections[0]
        .iter()
        .fold(0.0_f64, |largest, value| largest.max(value.abs()));
    for (plain, factored) in deflections[0].iter().zip(&deflections[1]) {
        assert!(
            (plain - factored).abs() < 1e-9 * largest,
            "{plain} {factored}"
        );
    }
    assert!(largest > 0.01 && deflections[0].len() == deflections[1].len());
}
