//! The whole chain on the girder of McConville's paper: spec, grid, tables, simulation.

use std::path::{Path, PathBuf};
use std::process::Command;

use formats::grid::block::GridBlock;
use formats::spec::Spec;
use formats::tables;
use formats::text::source::Source;
use foundations::{SolvedModel, solve};
use serde_json::{Value, json};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn text(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn girder() -> (Spec, SolvedModel) {
    let source = Source {
        name: "spec.json".to_owned(),
        text: text("examples/bogie/spec.json"),
    };
    let spec = Spec::read(&source, None).expect("the example's spec");
    let solved = solve(&spec).expect("a girder on two supports stands");
    (spec, solved)
}

/// One unit of the third digit of a printed number.
fn last_digit(printed: f64) -> f64 {
    10f64.powf(printed.abs().log10().floor() - 2.0)
}

#[test]
fn all_98_printed_entries_are_met_within_one_unit_of_their_last_digit() {
    let (_, solved) = girder();
    // the digits of examples/bogie/printed.adm: see its comment
    let printed = adams::tables::read(&text("examples/bogie/printed.adm")).expect("our own file");
    let mut entries = 0;
    for (id, quantity) in [(6, GridBlock::Vertical), (7, GridBlock::Lateral)] {
        let table = &printed
            .splines
            .iter()
            .find(|spline| spline.id == id)
            .expect("the table")
            .curves;
        let grid = solved.grid.block(quantity).expect("the girder resists it");
        for (row, column) in (0..7).flat_map(|row| (0..7).map(move |column| (row, column))) {
            let (digits, found) = (table.y()[row][column], grid[(row, column)]);
            let unit = if digits == 0.0 {
                1e-20
            } else {
                last_digit(digits)
            };
            assert!(
                (found - digits).abs() <= unit * (1.0 + 1e-9),
                "{quantity} {row} {column}: {found} for {digits}"
            );
            entries += 1;
        }
    }
    assert_eq!(entries, 98);
}

#[test]
fn tables_read_back_bit_for_bit() {
    let (_, solved) = girder();
    let set = tables::data_set(&solved.grid);
    let written = adams::tables::write(&set).expect("tables");
    assert!(
        written
            .lines()
            .all(|line| line.len() <= 79 && line.is_ascii())
    );
    let read = adams::tables::read(&written).expect("what was written");
    assert_eq!(read.splines.len(), GridBlock::ALL.len());
    for (id, spline, quantity) in (6..)
        .zip(&read.splines)
        .zip(GridBlock::ALL)
        .map(|((id, s), q)| (id, s, q))
    {
        assert_eq!(spline.id, id);
        let grid = solved.grid.block(quantity).expect("the girder resists it");
        for row in 0..7 {
            for column in 0..7 {
                assert_eq!(
                    spline.curves.y()[row][column].to_bits(),
                    (grid[(row, column)] + 0.0).to_bits()
                );
            }
        }
    }
}

/// Runs `command` on `scene`, written beside the example's files, and returns its output folder.
fn run(command: &str, scene: &Value, folder: &Path) {
    for file in ["spec.json", "printed.adm"] {
        std::fs::copy(root().join("examples/bogie").join(file), folder.join(file)).expect("a copy");
    }
    std::fs::write(folder.join("scene.json"), scene.to_string()).expect("a scene");
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .arg(command)
        .arg(folder.join("scene.json"))
        .arg("-o")
        .arg(folder.join("out"))
        .output()
        .expect("the program starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

fn columns(folder: &Path, names: [&str; 3]) -> [Vec<f64>; 3] {
    let mut reader = csv::Reader::from_path(folder.join("out/history.csv")).expect("a history");
    let header = reader.headers().expect("a header").clone();
    let at = names.map(|name| {
        header
            .iter()
            .position(|known| known == name)
            .expect("the column")
    });
    let mut columns = [Vec::new(), Vec::new(), Vec::new()];
    for row in reader.records() {
        let row = row.expect("a row");
        for (column, at) in columns.iter_mut().zip(at) {
            column.push(row[at].parse().expect("a number"));
        }
    }
    columns
}

fn numbers(reference: &Value, name: &str) -> Vec<f64> {
    reference[name]
        .as_array()
        .expect("an array")
        .iter()
        .map(|value| value.as_f64().expect("a number"))
        .collect()
}

/// External: scipy on a closed-form influence function, fea/bogie_reference.py.
#[test]
fn crossings_at_5_and_100_ft_a_second_follow_the_scipy_reference() {
    for (file, speed, end) in [("bogie_s1.json", 5.0, 12.0), ("bogie_s2.json", 100.0, 0.55)] {
        let mut scene: Value =
            serde_json::from_str(&text("examples/bogie/scene.json")).expect("the example");
        scene["compare"] = json!([]);
        scene["wheels"]["crane"]["vertical"]["damper"] = json!("ground");
        scene["motions"][0]["speed"] = json!([[0, speed]]);
        scene["end"]["time"] = json!(end);
        scene["output"]["dt"] = json!(end / 100.0);
        scene["accuracy"] = json!(1e-7);
        let folder = tempfile::tempdir().expect("a temporary folder");
        run("run", &scene, folder.path());
        let reference: Value = serde_json::from_str(&text(&format!("fea/reference/{file}")))
            .expect("the reference is JSON");
        let found = columns(
            folder.path(),
            [
                "bogie.deflection",
                "truck.wheel1.vertical",
                "truck.wheel2.vertical",
            ],
        );
        let mut worst = [0.0_f64; 3];
        for (k, name) in ["z", "F1", "F2"].iter().enumerate() {
            let wanted = numbers(&reference, name);
            assert_eq!(found[k].len(), wanted.len(), "{file}: samples");
            for (a, b) in found[k].iter().zip(&wanted) {
                worst[k] = worst[k].max((a - b).abs());
            }
        }
        println!(
            "{file}: z {:.1e} ft, forces {:.1e} and {:.1e} lbf",
            worst[0], worst[1], worst[2]
        );
        assert!(
            worst[0] < 1e-6 && worst[1] < 50.0 && worst[2] < 50.0,
            "{worst:?}"
        );
        let summary: Value = serde_json::from_slice(
            &std::fs::read(folder.path().join("out/summary.json")).expect("a summary"),
        )
        .expect("the summary is JSON");
        assert!(summary["energy"]["residual"].as_f64().expect("a number") < 1e-6);
    }
}

#[test]
fn two_rigid_halves_under_one_central_load_meet_their_closed_form() {
    let mut scene: Value =
        serde_json::from_str(&text("examples/bogie/scene.json")).expect("the example");
    scene["compare"] = json!([]);
    scene["analysis"] = json!("quasi-static");
    scene["structures"]["girder"]["foundation"] = json!("parts");
    scene["structures"]["girder"]["count"] = json!(2);
    scene["bodies"]["bogie"]["dof"] = json!(["x", "y"]);
    scene["trucks"][0]["tree"] = json!([0]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    run("run", &scene, folder.path());
    let [x, z, _] = columns(folder.path(), ["bogie.x", "bogie.deflection", "time"]);
    let middle = x
        .iter()
        .position(|x| (x - 30.0).abs() < 1e-9)
        .expect("midspan");
    // Analytic: each half turns about its support by M 45/(2 E I), M = (P/2) 30, and the wheel's own spring.
    let ei = 9.528 * 4.32e9;
    let closed = 30.0 * (2.4e6 * 30.0) * 45.0 / (2.0 * ei) + 4.8e6 / 1e8;
    assert!(
        (z[middle] - closed).abs() < 1e-10,
        "{} for {closed}",
        z[middle]
    );
}

#[test]
fn simulation_on_existing_tables_gives_the_same_history() {
    let scene: Value =
        serde_json::from_str(&text("examples/bogie/scene.json")).expect("the example");
    let folder = tempfile::tempdir().expect("a temporary folder");
    run("run", &scene, folder.path());
    let file = folder.path().join("out/history.csv");
    let first = std::fs::read(&file).expect("a history");
    run("sim", &scene, folder.path());
    assert_eq!(first, std::fs::read(&file).expect("a history"));
    // a comparison with a spec of its own has tables of its own
    let mut other = scene.clone();
    other["compare"] =
        json!([{"label": "stiff", "structures": {"girder": {"spec": "stiff.json"}}}]);
    let stiff = text("examples/bogie/spec.json").replace("9.528", "95.28");
    std::fs::write(folder.path().join("stiff.json"), stiff).expect("a spec");
    let file = folder.path().join("out/history-stiff.csv");
    run("run", &other, folder.path());
    let first = std::fs::read(&file).expect("a history");
    run("sim", &other, folder.path());
    assert_eq!(first, std::fs::read(&file).expect("a history"));
    assert!(folder.path().join("out/grid-girder-stiff.json").is_file());
    // other numbers in the spec: the tables no longer fit
    let spec = text("examples/bogie/spec.json").replace("9.528", "9.5");
    std::fs::write(folder.path().join("spec.json"), spec).expect("a spec");
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["sim", "--quiet"])
        .arg(folder.path().join("scene.json"))
        .arg("-o")
        .arg(folder.path().join("out"))
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&output.stderr)
            .contains("its tables are out of date: spec.json is new or has changed")
    );
}
