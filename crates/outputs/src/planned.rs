//! Files that `run` and `sim` write, as far as a scene determines them before the work.

use std::path::Path;

use crate::Error;
use crate::folder::{PlannedFiles, is_too_long};
use adams::SplineValues;
use formats::scene::{Case, Document};
use formats::text::fault::{Fault, Faults};
use formats::text::place::Place;
use foundations::distinct_specs;

/// Names of pictures that every run or many runs have.
const PICTURES: [&str; 4] = ["crane.svg", "positions.svg", "speeds.svg", "wheel-"];

/// Beginnings of the names of pictures of a body, a rail or a structure, before its name.
const FAMILIES: [&str; 8] = [
    "path-",
    "speeds-",
    "trochoid-",
    "rail-",
    "moments-",
    "girder-",
    "grid-",
    "influence-",
];

/// Files that `command`, `run` or `sim`, writes for a scene. Without them: pictures of single columns, and the grids
/// that `sim` reads and checks itself.
pub fn planned_files(command: &str, document: &Document) -> PlannedFiles {
    let mut names: Vec<String> = ["summary.json", "report.html", "timing.json"]
        .into_iter()
        .map(str::to_owned)
        .collect();
    for (name, _, spec) in distinct_specs(document) {
        if command == "run" || !spec.pads().is_empty() {
            names.push(format!("grid-{name}.json"));
        }
        if spec
            .rails()
            .iter()
            .any(|rail| rail.stations.len() >= SplineValues::MIN_POINTS)
        {
            names.push(format!("{name}.adm"));
        }
    }
    names.extend(document.cases.iter().map(|case| of_case("history", case)));
    if !distinct_specs(document).is_empty() {
        names.extend(document.cases.iter().map(|case| of_case("envelope", case)));
    }
    let scene = document.scene();
    let subjects = (scene.bodies.iter().map(|body| &body.name))
        .chain(scene.rails.iter().map(|rail| &rail.name))
        .chain(scene.structures.iter().map(|structure| &structure.name));
    let of_subjects = subjects.flat_map(|name| FAMILIES.map(|family| format!("{family}{name}")));
    let plots = PICTURES
        .map(str::to_owned)
        .into_iter()
        .chain(of_subjects)
        .collect();
    PlannedFiles { names, plots }
}

/// Name of a table of a case.
fn of_case(table: &str, case: &Case) -> String {
    case.label.as_ref().map_or_else(
        || format!("{table}.csv"),
        |label| format!("{table}-{label}.csv"),
    )
}

/// Checks that no name of a structure or comparison makes the name of a file too long for the file system.
///
/// # Errors
/// Such names, with their places.
pub fn check_names(document: &Document, folder: &Path) -> Result<(), Error> {
    let root = Place::root();
    let (structures, comparisons) = (root.key("structures"), root.key("compare"));
    let mut faults = Faults::default();
    let mut check = |file: &str, place: &Place<'_>| {
        if is_too_long(folder, file) {
            let fault = Fault::new(
                place,
                "makes the name of a file too long for the file system",
            );
            faults.add(fault.got(format!("{file:?}")).hint("shorten the name"));
        }
    };
    let labelled = || {
        document
            .cases
            .iter()
            .filter(|case| case.label.is_some())
            .enumerate()
    };
    for (name, ..) in distinct_specs(document) {
        if document
            .scene()
            .structures
            .iter()
            .any(|structure| structure.name == name)
        {
            check(&format!("grid-{name}-vertical.svg"), &structures.key(&name));
        } else if let Some((index, _)) = labelled().find(|(_, case)| {
            case.label
                .as_ref()
                .is_some_and(|label| name.ends_with(label.as_str()))
        }) {
            check(&format!("grid-{name}.json"), &comparisons.index(index));
        }
    }
    for (index, case) in labelled() {
        check(
            &of_case("envelope", case),
            &comparisons.index(index).key("label"),
        );
    }
    if faults.0.is_empty() {
        return Ok(());
    }
    Err(Error::Files(document.diagnose(None, &faults)))
}
