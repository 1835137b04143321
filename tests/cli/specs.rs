//! Specs in their short spellings say what the long ones say.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use super::{base, folder, girderway, json, text};

/// The grid file of the base frame after these exchanges of text.
fn solved(folder: &TempDir, exchanges: &[(&str, &str)]) -> Vec<u8> {
    let mut spec = fs::read_to_string(base("frame.json")).expect("the base frame");
    for (old, new) in exchanges {
        assert_eq!(spec.matches(old).count(), 1, "{old}");
        spec = spec.replace(old, new);
    }
    fs::write(folder.path().join("frame.json"), spec).expect("a file");
    let run = girderway(folder, &["fea", "frame.json"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    run.stdout
}

#[test]
fn one_item_a_block_names_and_sets_give_the_bytes_of_the_long_spelling() {
    let folder = folder();
    let long = solved(&folder, &[]);
    let short = solved(
        &folder,
        &[
            (
                "[[\"beam\", \"beam\", \"beam\"], [\"truss\", \"truss\"]]",
                "[null, \"truss\"]",
            ),
            (
                "[[0, 1, 0], [2, 2]]",
                "[[\"column\", 1, \"column\"], \"tie\"]",
            ),
            ("[[0, 0, 1], [0, 0, 1]]]", "[0, 0, 1]]"),
            ("[[[], [\"rz\"], []], [[], []]]", "[[[], [\"rz\"], []], []]"),
            (
                "\"point_sets\": {\"crown\": [4]}",
                "\"point_sets\": {\"crown\": [4], \"feet\": [0, 3]}",
            ),
            (
                "{\"point\": 0, \"fix\": [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]},\n",
                "",
            ),
            ("{\"point\": 3, \"fix\"", "{\"point\": \"feet\", \"fix\""),
            (
                "{\"point\": 4, \"fix\": [\"uz\"]}",
                "{\"point\": \"crown\", \"fix\": [\"uz\"]}",
            ),
            (
                "{\"point\": 4, \"mass\": 2.5}",
                "{\"point\": \"crown\", \"mass\": 2.5}",
            ),
        ],
    );
    // the feet are a set of their own now, and called so
    let named = text(&short)
        .replace("feet1", "point0")
        .replace("feet2", "point3");
    assert_eq!(named, text(&long));
}

fn vertical(grid: &[u8]) -> Vec<f64> {
    let grid: Value = json(grid);
    let rows = grid["influence"]["vertical"].as_array().expect("a grid");
    rows.iter()
        .flat_map(|row| row.as_array().expect("a row"))
        .map(|g| g.as_f64().expect("a number"))
        .collect()
}

#[test]
fn a_section_by_its_plates_is_that_of_its_integrals() {
    let folder = folder();
    // welded I of 600 x 300 mm, flanges 25, web 12: sums over its three plates, by hand
    let (h, b, t, w): (f64, f64, f64, f64) = (0.6, 0.3, 0.025, 0.012);
    let clear = h - 2.0 * t;
    let area = 2.0 * b * t + clear * w;
    let iz =
        2.0 * (b * t.powi(3) / 12.0 + b * t * (0.5 * (h - t)).powi(2)) + w * clear.powi(3) / 12.0;
    let iy = (2.0 * t * b.powi(3) + clear * w.powi(3)) / 12.0;
    let j = (2.0 * b * t.powi(3) + (h - t) * w.powi(3)) / 3.0;
    let numbers = format!(
        "\"A\": {area}, \"Iy\": {iy}, \"Iz\": {iz}, \"J\": {j}, \"Asy\": {}, \"Asz\": {}",
        clear * w,
        5.0 / 3.0 * b * t
    );
    let plates = "\"shape\": {\"kind\": \"I\", \"height\": 600, \"width\": 300, \"flange\": 25, \"web\": 12, \"length\": \"mm\"}";
    let old = "\"A\": 0.02, \"Iy\": 2e-5, \"Iz\": 4e-4, \"J\": 2e-6, \"Asy\": 0.008";
    let by_numbers = vertical(&solved(&folder, &[(old, &numbers)]));
    let by_plates = vertical(&solved(&folder, &[(old, plates)]));
    for (plates, numbers) in by_plates.iter().zip(&by_numbers) {
        assert!(
            (plates - numbers).abs() <= 1e-12 * numbers.abs().max(1e-9),
            "{plates} {numbers}"
        );
    }
    // what stands beside the shape comes before it
    let stiffer = format!("\"Iz\": {}, {plates}", 2.0 * iz);
    let stiffer = vertical(&solved(&folder, &[(old, &stiffer)]));
    assert!(
        stiffer[12] < 0.9 * by_plates[12],
        "{} {}",
        stiffer[12],
        by_plates[12]
    );
}

#[test]
fn a_modulus_of_no_material_is_told() {
    let folder = folder();
    let spec = fs::read_to_string(base("frame.json"))
        .expect("the base frame")
        .replace("2.1e8", "2.1e5");
    fs::write(folder.path().join("frame.json"), spec).expect("a file");
    let run = girderway(&folder, &["fea", "frame.json", "-o", "grid.json"]);
    assert!(run.status.success());
    let told = "warning: `E` of section \"column\" is 210000 kN/m^2, 0.21 GPa: steel has about 200000000 kN/m^2";
    assert!(text(&run.stderr).contains(told), "{}", text(&run.stderr));
}

/// A byte order mark, as some editors write it, is no part of the text: results and places of faults are the same.
#[test]
fn a_byte_order_mark_is_skipped_in_every_file() {
    let [plain, marked] = [folder(), folder()];
    let files = [
        "spec.json",
        "scene.json",
        "design.json",
        "grid.json",
        "mesh.msh",
        "groups.json",
        "deck.bdf",
    ];
    let sweep = r#"{"format": "girderway-sweep/1", "scene": "scene.json", "axes": {"/bodies/bogie/weight": [4e6, 5e6], "spec.json#/girder/E": [4e9]}, "sampling": "grid", "results": ["ratios"]}"#;
    for name in files.into_iter().chain(["sweep.json"]) {
        let text = if name == "sweep.json" {
            sweep.as_bytes().to_vec()
        } else {
            fs::read(base(name)).expect("a base file")
        };
        fs::write(plain.path().join(name), &text).expect("a writable folder");
        let text = [b"\xef\xbb\xbf", text.as_slice()].concat();
        fs::write(marked.path().join(name), text).expect("a writable folder");
    }
    for line in [
        "fea spec.json",
        "splines grid.json",
        "import mesh.msh --length m --up 0,1,0 --sections groups.json",
        "import deck.bdf --length m --force N",
        "run scene.json -o run --quiet",
        "design design.json -o design --quiet",
        "sweep sweep.json -o sweep --quiet",
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let [one, two] = [&plain, &marked].map(|folder| girderway(folder, &arguments));
        for run in [&one, &two] {
            assert!(run.status.success(), "{line}: {}", text(&run.stderr));
        }
        assert_eq!(text(&one.stdout), text(&two.stdout), "{line}");
    }
    for file in [
        "run/history.csv",
        "design/envelope.csv",
        "sweep/results.csv",
    ] {
        let [one, two] = [&plain, &marked].map(|folder| fs::read(folder.path().join(file)));
        assert!(one.expect(file) == two.expect(file), "{file}");
    }
    fs::write(
        marked.path().join("wrong.json"),
        b"\xef\xbb\xbf{\"formt\": 1}",
    )
    .expect("a writable folder");
    let wrong = girderway(&marked, &["fea", "wrong.json"]);
    assert!(
        text(&wrong.stderr).contains("wrong.json:1:2: formt"),
        "{}",
        text(&wrong.stderr)
    );
}
