//! The command line: help, exit status, what goes where.

mod alternatives;
mod drives;
mod events;
mod fatigue;
mod figures;
mod folders;
mod full;
mod grids;
mod init;
mod modes;
mod notes;
mod rides;
mod ropes;
mod schema;
mod sections;
mod slips;
mod specs;
mod steps;
mod stops;
mod stresses;
mod tables;
mod typos;
mod warnings;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../examples")
        .join(name)
}

fn base(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../tests/malformed/base")
        .join(name)
}

fn girderway(folder: &TempDir, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(arguments)
        .current_dir(folder.path())
        .output()
        .expect("the program starts")
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

fn path(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).expect("JSON")
}

/// Commands that `--help` lists.
fn commands(folder: &TempDir) -> Vec<String> {
    let run = girderway(folder, &["--help"]);
    let (_, list) = text(&run.stdout)
        .split_once("Commands:\n")
        .expect("a list of commands");
    let lines = list.lines().take_while(|line| !line.is_empty());
    let words = lines.filter_map(|line| {
        line.strip_prefix("  ")
            .filter(|line| !line.starts_with(' '))
    });
    words
        .filter_map(|line| line.split(' ').next())
        .map(str::to_owned)
        .filter(|word| word != "help")
        .collect()
}

#[test]
fn every_command_in_the_help_has_one_example() {
    let folder = folder();
    let commands = commands(&folder);
    assert!(
        commands.contains(&"run".to_owned()) && commands.contains(&"fea".to_owned()),
        "{commands:?}"
    );
    for command in commands {
        let run = girderway(&folder, &[&command, "--help"]);
        assert_eq!(run.status.code(), Some(0));
        let help = text(&run.stdout);
        assert_eq!(help.matches("Example").count(), 1, "{command}");
        assert!(
            help.contains(&format!("  girderway {command} ")),
            "{command}"
        );
        for flag in ["--quiet", "--json", "--threads"] {
            assert!(help.contains(flag), "{command} {flag}");
        }
    }
}

#[test]
fn wrong_usage_has_status_2_and_leaves_standard_output_empty() {
    let folder = folder();
    for arguments in [
        &[] as &[&str],
        &["runn"],
        &["fea"],
        &["fea", "--theory", "euler", "x"],
        &["run", "x", "--threads", "0"],
    ] {
        let run = girderway(&folder, arguments);
        assert_eq!(run.status.code(), Some(2), "{arguments:?}");
        assert!(
            run.stdout.is_empty() && !run.stderr.is_empty(),
            "{arguments:?}"
        );
    }
}

#[test]
fn errors_are_json_on_standard_error_where_that_is_asked_for() {
    let folder = folder();
    fs::write(
        folder.path().join("spec.json"),
        "{\"format\": \"girderway-beam/1\",\n \"nane\": 1}",
    )
    .expect("writable");
    let run = girderway(&folder, &["fea", "spec.json", "--json"]);
    assert_eq!(run.status.code(), Some(2));
    let told = json(&run.stderr);
    assert_eq!(told["status"], 2);
    let error = told["errors"]
        .as_array()
        .and_then(|all| all.iter().find(|one| one["path"] == "nane"));
    let error = error.expect("the fault of the key");
    assert_eq!(
        (&error["file"], &error["line"], &error["column"]),
        (&"spec.json".into(), &2.into(), &2.into())
    );
    assert_eq!(
        (&error["path"], &error["expected"]),
        (&"nane".into(), &"unknown key `nane`".into())
    );

    let run = girderway(&folder, &["runn", "--json"]);
    assert_eq!(
        (run.status.code(), &json(&run.stderr)["status"]),
        (Some(2), &2.into())
    );
}

#[test]
fn fea_writes_a_grid_and_nothing_else_to_standard_output() {
    let folder = folder();
    let run = girderway(&folder, &["fea", path(&base("spec.json"))]);
    assert_eq!((run.status.code(), text(&run.stderr)), (Some(0), ""));
    let grid = json(&run.stdout);
    assert_eq!(grid["format"], "girderway-grid/1");
    assert_eq!(
        grid["influence"]["vertical"].as_array().map(Vec::len),
        Some(7)
    );
    assert!(
        grid["certificate"]["error_bound"]
            .as_f64()
            .is_some_and(|bound| bound < 1e-9)
    );
}

#[test]
fn a_file_written_says_so_once_and_quiet_says_nothing() {
    let folder = folder();
    let spec = base("spec.json");
    let run = girderway(&folder, &["fea", path(&spec), "-o", "a.json"]);
    assert_eq!(
        (run.status.code(), text(&run.stdout), text(&run.stderr)),
        (Some(0), "", "wrote a.json\n")
    );
    let run = girderway(&folder, &["fea", path(&spec), "-o", "b.json", "--quiet"]);
    assert_eq!(
        (run.status.code(), text(&run.stdout), text(&run.stderr)),
        (Some(0), "", "")
    );
    let read = |name: &str| fs::read(folder.path().join(name)).expect("written");
    assert_eq!(read("a.json"), read("b.json"));
    let names = fs::read_dir(folder.path()).expect("readable").count();
    assert_eq!(names, 2, "temporary files are left");
}

#[test]
fn theory_of_the_command_line_overrides_the_spec() {
    let folder = folder();
    let frame = base("frame.json");
    let own = json(&girderway(&folder, &["fea", path(&frame)]).stdout);
    let rigid = json(
        &girderway(
            &folder,
            &["fea", path(&frame), "--theory", "euler-bernoulli"],
        )
        .stdout,
    );
    assert_eq!(
        (&own["theory"], &rigid["theory"]),
        (&"timoshenko".into(), &"euler-bernoulli".into())
    );
    let middle = |grid: &Value| {
        grid["influence"]["vertical"][2][2]
            .as_f64()
            .expect("a number")
    };
    assert!(
        middle(&own) > middle(&rigid),
        "shear adds to the deflection"
    );
}

#[test]
fn tables_hold_the_grid_bit_for_bit() {
    let folder = folder();
    for arguments in [
        ["fea", path(&base("spec.json")), "-o", "grid.json"],
        ["splines", "grid.json", "-o", "bridge.adm"],
        ["splines", "grid.json", "-o", "bridge.json"],
        ["splines", "grid.json", "-o", "bridge.csv"],
    ] {
        assert_eq!(
            girderway(&folder, &arguments).status.code(),
            Some(0),
            "{arguments:?}"
        );
    }
    let read = |name: &str| fs::read(folder.path().join(name)).expect("written");
    let grid = json(&read("grid.json"));
    let set = adams::tables::read(text(&read("bridge.adm"))).expect("a data set");
    let tables = json(&read("bridge.json"));
    let ids: Vec<u32> = set.splines.iter().map(|spline| spline.id).collect();
    assert_eq!(ids, [6, 7, 8, 9, 10, 11]);
    for (index, block) in ["vertical", "lateral", "longitudinal"]
        .into_iter()
        .enumerate()
    {
        for i in 0..7 {
            for j in 0..7 {
                let value = grid["influence"][block][i][j].as_f64().expect("a number");
                assert_eq!(
                    set.splines[index].curves.y()[i][j].to_bits(),
                    value.to_bits()
                );
                assert_eq!(
                    tables["tables"][index]["values"][i][j].as_f64(),
                    Some(value)
                );
            }
        }
    }
    let csv = read("bridge.csv");
    assert_eq!(text(&csv).lines().count(), 1 + 6 * 49);
}

#[test]
fn splines_writes_a_data_set_to_standard_output() {
    let folder = folder();
    let run = girderway(&folder, &["splines", path(&base("grid.json"))]);
    assert_eq!((run.status.code(), text(&run.stderr)), (Some(0), ""));
    assert!(text(&run.stdout).contains("SPLINE/6"));
}

#[test]
fn run_writes_a_folder_whose_manifest_names_and_hashes_every_file() {
    let folder = folder();
    let run = girderway(
        &folder,
        &[
            "run",
            path(&example("bogie").join("scene.json")),
            "-o",
            "out",
            "--quiet",
        ],
    );
    assert_eq!(
        (run.status.code(), text(&run.stdout), text(&run.stderr)),
        (Some(0), "", "")
    );
    let out = folder.path().join("out");
    let manifest = json(&fs::read(out.join("manifest.json")).expect("a manifest"));
    let mut listed: Vec<String> = Vec::new();
    for entry in manifest["outputs"].as_array().expect("a list") {
        let name = entry["name"].as_str().expect("a name");
        let bytes = fs::read(out.join(name)).expect("a file that the manifest lists");
        if name != "timing.json" {
            assert_eq!(
                entry["sha256"],
                formats::text::inputs::sha256(&bytes),
                "{name}"
            );
        }
        listed.push(name.to_owned());
    }
    let mut found = files(&out, "");
    found.retain(|name| name != "manifest.json");
    assert_eq!(found, listed);
    assert!(
        listed.contains(&"history.csv".to_owned()) && listed.contains(&"report.html".to_owned())
    );
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let folder = folder();
    let scene = example("bogie").join("scene.json");
    for out in ["a", "b"] {
        let run = girderway(&folder, &["run", path(&scene), "-o", out, "--quiet"]);
        assert_eq!(run.status.code(), Some(0));
    }
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    let names = files(&a, "");
    assert_eq!(names, files(&b, ""));
    for name in names.iter().filter(|name| *name != "timing.json") {
        let same =
            fs::read(a.join(name)).expect("written") == fs::read(b.join(name)).expect("written");
        assert!(same, "{name} differs");
    }
}

/// Files below a folder, sorted.
fn files(folder: &Path, prefix: &str) -> Vec<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let entry = entry.expect("a readable folder");
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            names.extend(files(&entry.path(), &format!("{name}/")));
        } else {
            names.push(name);
        }
    }
    names.sort();
    names
}

#[test]
fn an_imported_deck_can_be_solved_at_once() {
    let folder = folder();
    fs::copy(base("deck.bdf"), folder.path().join("deck.bdf")).expect("writable");
    let deck = [
        "import",
        "deck.bdf",
        "--length",
        "m",
        "--force",
        "N",
        "--up",
        "0,1,0",
        "--rail",
        "crane=1,2",
    ];
    let run = girderway(&folder, &deck);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let spec = json(&run.stdout);
    assert_eq!(
        spec["rails"]["crane"]["stations"],
        serde_json::json!([0.0, 6.0, 12.0])
    );
    let told = "warning: deck.bdf:15:1: mass: the mass of rods and tubes is lumped at their ends, as in NASTRAN unless \
                PARAM COUPMASS is positive  hint: use --mass distributed to distribute it along all elements\n\
                warning: deck.bdf:18:1: CELAS2 6: is ignored, because it has no free end\n\
                warning: deck.bdf: the mass of beams acts along them, that of the deck at their ends  hint: use --mass \
                lumped for the masses of the deck; the beams then have no weight between their ends\n";
    assert_eq!(text(&run.stderr), told);
    let run = girderway(&folder, &[&deck[..], &["-o", "spec.json"]].concat());
    assert_eq!((run.status.code(), run.stdout.len()), (Some(0), 0));
    assert_eq!(text(&run.stderr), format!("{told}wrote spec.json\n"));
    assert_eq!(
        json(&fs::read(folder.path().join("spec.json")).expect("written")),
        spec
    );
    let run = girderway(&folder, &[&deck[..], &["--quiet"]].concat());
    assert_eq!((run.status.code(), text(&run.stderr)), (Some(0), ""));
    let run = girderway(&folder, &["fea", "spec.json"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    assert_eq!(json(&run.stdout)["format"], "girderway-grid/1");
    let run = girderway(&folder, &["import", "deck.bdf", "--json"]);
    assert_eq!(
        (run.status.code(), &json(&run.stderr)["status"]),
        (Some(2), &2.into())
    );
}
