//! The factored form: what it says of its error is true.

use formats::tables::{expand, factor, read};
use serde_json::Value;
use splines::Rank;

use super::{bogie_grid, bytes, folder, girderway, told};

/// At the stations the error is that of the tables; between them that of natural splines.
///
/// Source of the 0.84 %: this form with five curves at the paper's seven stations against the exact beam, of the
/// largest value of the span, by an independent program.
#[test]
fn five_curves_of_the_paper_girder_err_as_published() {
    let folder = folder();
    bogie_grid(folder.path());
    let arguments = [
        "--form", "factored", "--rank", "5", "--only", "vertical", "--json",
    ];
    let run = girderway(
        folder.path(),
        &[&["splines", "grid.json", "-o", "f.json"], &arguments[..]].concat(),
    );
    assert_eq!(run.status.code(), Some(0), "{}", told(&run));
    let result: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let found = &result["factored"];
    assert!(
        found["at_stations"]["largest"]
            .as_f64()
            .is_some_and(|error| error < 1e-14),
        "{found}"
    );
    let between = found["against_surface"]["largest"]
        .as_f64()
        .expect("the grid has its surface");
    assert!((0.007..0.0105).contains(&between), "{between}");
    assert_eq!(found["ranks"][0]["retained"], 5);
}

#[test]
fn fewer_curves_err_more_and_the_report_is_the_largest_difference() {
    let folder = folder();
    bogie_grid(folder.path());
    let run = girderway(
        folder.path(),
        &[
            "splines",
            "grid.json",
            "-o",
            "t.npz",
            "--only",
            "vertical,longitudinal",
        ],
    );
    assert_eq!(run.status.code(), Some(0), "{}", told(&run));
    let set = read("t.npz", &bytes(&folder.path().join("t.npz")), None).expect("our own file");
    assert_eq!(set.tables.len(), 3);
    let mut last = f64::INFINITY;
    for rank in [1, 2, 4, 8, 20] {
        let found = factor(&set, Rank::Count(rank)).expect("three tables of one structure");
        let back = expand(&found.set);
        let mut largest = 0.0_f64;
        for table in &set.tables {
            let back = back
                .tables
                .iter()
                .find(|back| back.name == table.name)
                .expect("its product");
            let size = table
                .curves
                .y()
                .iter()
                .flatten()
                .fold(0.0_f64, |size, value| size.max(value.abs()));
            for (a, b) in table
                .curves
                .y()
                .iter()
                .flatten()
                .zip(back.curves.y().iter().flatten())
            {
                largest = largest.max((a - b).abs() / size);
            }
        }
        assert_eq!(found.stations.largest, largest);
        assert!(largest <= last);
        last = largest;
        // symmetric to the last bit whatever the rank
        let direct = back
            .tables
            .iter()
            .find(|table| table.name.ends_with("rail_vertical"))
            .expect("vertical");
        let values = direct.curves.y();
        for (i, row) in values.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(value.to_bits(), values[j][i].to_bits());
            }
        }
    }
    assert!(last < 1e-13, "{last}");
}

#[test]
fn a_tolerance_keeps_the_stations_within_it() {
    let folder = folder();
    bogie_grid(folder.path());
    for tolerance in ["0.1", "1e-2", "1e-6"] {
        let run = girderway(
            folder.path(),
            &[
                "splines",
                "grid.json",
                "-o",
                "f.csv",
                "--json",
                "--form",
                "factored",
                "--only",
                "lateral",
                "--tolerance",
                tolerance,
            ],
        );
        assert_eq!(run.status.code(), Some(0), "{}", told(&run));
        let result: Value = serde_json::from_slice(&run.stdout).expect("JSON");
        let error = result["factored"]["at_stations"]["largest"]
            .as_f64()
            .expect("a number");
        assert!(
            error <= tolerance.parse().expect("a number"),
            "{tolerance} {error}"
        );
    }
}
