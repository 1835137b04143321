//! Figures that cannot be drawn.

use std::fs;

use super::{example, folder, girderway, path, text};

/// A rail 285 m above a girder of 19.5 m, as from a height in millimetres.
const SPEC: &str = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
 "girder": {"spans": [6, 7.5, 6], "E": 2.1e8, "I_vertical": 5.768e-4, "rail_height": 285}, "stations": [0, 6, 13.5, 19.5]}"#;

const SCENE: &str = r#"{"format": "girderway-scene/1", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
 "structures": {"runway": {"spec": "runway.json", "foundation": "influence"}},
 "bodies": {"car": {"weight": 100, "dof": ["y"], "x0": 2}}, "wheels": {"w": {"radius": 0.2, "vertical": {"k": 1e6, "c": 100}}},
 "trucks": [{"body": "car", "tree": [0], "wheel": "w"}],
 "motions": [{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, 1]]}], "end": {"time": 0.2}}"#;

#[test]
fn a_figure_that_cannot_be_drawn_is_omitted_and_the_results_are_written() {
    let folder = folder();
    fs::write(folder.path().join("runway.json"), SPEC).expect("written");
    fs::write(folder.path().join("scene.json"), SCENE).expect("written");
    let output = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(
        told.contains("warning: the figure girder-runway is omitted because it cannot be drawn"),
        "{told}"
    );
    for name in [
        "history.csv",
        "summary.json",
        "report.html",
        "plots/wheel-forces.svg",
    ] {
        assert!(folder.path().join("out").join(name).is_file(), "{name}");
    }
    assert!(!folder.path().join("out/plots/girder-runway.svg").exists());
}

/// Lateral reactions of a straight girder under vertical loads are zero up to rounding, and so is the loss of energy on a
/// rigid rail.
#[test]
fn reports_show_no_rounding_of_zero() {
    let folder = folder();
    for scene in ["runway/scene.json", "bogie/fast.json"] {
        let run = girderway(
            &folder,
            &[
                "run",
                path(&example(scene)),
                "-o",
                "out",
                "--quiet",
                "--force",
            ],
        );
        assert!(run.status.success(), "{}", text(&run.stderr));
        let report = fs::read_to_string(folder.path().join("out/report.html")).expect("a report");
        // exponents from -20 on in superscript digits
        let tiny = ["10\u{207b}\u{b2}", "10\u{207b}\u{b3}", "10\u{207b}\u{2074}"];
        let is_tiny = |rest: &str| {
            let next = rest.chars().nth(4);
            next.is_some_and(|c| {
                ('\u{2070}'..='\u{2079}').contains(&c) || "\u{b9}\u{b2}\u{b3}".contains(c)
            })
        };
        for start in tiny {
            for (at, _) in report.match_indices(start) {
                assert!(!is_tiny(&report[at..]), "{scene}: {:.12}", &report[at..]);
            }
        }
    }
}
