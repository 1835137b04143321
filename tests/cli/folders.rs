//! Output files and folders: files of others, links, dead and living runs, grids of other structures.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use formats::text::inputs::sha256;
use serde_json::Value;
use tempfile::TempDir;

use super::{base, example, files, folder, girderway, json, path, text};

const JOURNAL: &str = ".girderway-journal";

/// A folder with the bogie's scene, without its comparisons, and its spec.
fn bogie() -> TempDir {
    let folder = folder();
    let copied = fs::copy(
        example("bogie").join("spec.json"),
        folder.path().join("spec.json"),
    );
    copied.expect("a copy");
    let mut scene = json(&fs::read(example("bogie").join("scene.json")).expect("the example"));
    scene.as_object_mut().expect("an object").remove("compare");
    write(&folder, "scene.json", &scene.to_string());
    folder
}

fn write(folder: &TempDir, name: &str, text: &str) {
    fs::write(folder.path().join(name), text).expect("writable");
}

fn read(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name)).expect("a readable file")
}

/// Runs the scene into `out`; its status and messages.
fn run(folder: &TempDir, more: &[&str]) -> (Option<i32>, String) {
    let run = girderway(
        folder,
        &[&["run", "scene.json", "-o", "out", "--quiet"], more].concat(),
    );
    (run.status.code(), text(&run.stderr).to_owned())
}

/// Names and hashes of all files of the folder `out`, except those that change from run to run.
fn hashes(folder: &TempDir) -> Vec<(String, String)> {
    let out = folder.path().join("out");
    let names = files(&out, "")
        .into_iter()
        .filter(|name| name != "timing.json");
    names
        .map(|name| (sha256(&fs::read(out.join(&name)).expect("readable")), name))
        .map(|(a, b)| (b, a))
        .collect()
}

#[test]
fn a_name_too_long_for_files_is_refused_at_its_place_and_leaves_the_older_result() {
    let folder = bogie();
    assert_eq!(run(&folder, &[]), (Some(0), String::new()));
    let before = hashes(&folder);
    let name = "g".repeat(238);
    let scene = read(&folder, "scene.json");
    write(
        &folder,
        "scene.json",
        &scene
            .replace("\"girder\"", &format!("\"{name}\""))
            .replace("girder.rail", &format!("{name}.rail")),
    );
    let (status, told) = run(&folder, &[]);
    assert_eq!(status, Some(2));
    assert!(
        told.starts_with("scene.json:1:") && told.contains(&format!("structures.{name}: makes")),
        "{told}"
    );
    assert!(
        told.contains("too long for the file system") && told.contains("hint: shorten"),
        "{told}"
    );
    assert_eq!(hashes(&folder), before);
    assert!(!folder.path().join("out").join(JOURNAL).exists());
}

#[test]
fn files_of_others_stop_a_run_before_any_work_unless_it_is_forced() {
    let folder = bogie();
    fs::create_dir(folder.path().join("out")).expect("writable");
    for name in ["out/history.csv", "out/notes.txt"] {
        write(&folder, name, "mine");
    }
    let (status, told) = run(&folder, &[]);
    assert_eq!(status, Some(2));
    assert!(
        told.starts_with("out/history.csv: ") && told.contains("--force"),
        "{told}"
    );
    assert_eq!(told.lines().count(), 1, "{told}");
    assert_eq!(
        files(&folder.path().join("out"), ""),
        ["history.csv", "notes.txt"]
    );
    assert_eq!(read(&folder, "out/history.csv"), "mine");

    assert_eq!(run(&folder, &["--force"]), (Some(0), String::new()));
    assert!(read(&folder, "out/history.csv").starts_with("time,"));
    assert_eq!(read(&folder, "out/notes.txt"), "mine");
    assert_eq!(
        run(&folder, &[]).0,
        Some(0),
        "its own result is replaced without --force"
    );

    write(&folder, "out/report.html", "edited");
    write(&folder, "out/plots/wheel-forces.svg", "edited");
    let (status, told) = run(&folder, &[]);
    assert_eq!((status, told.lines().count()), (Some(2), 2), "{told}");
    assert!(
        told.contains("out/report.html: ") && told.contains("out/plots/wheel-forces.svg: "),
        "{told}"
    );
    assert_eq!(read(&folder, "out/report.html"), "edited");
}

#[test]
fn a_run_is_refused_while_another_one_writes_into_its_folder() {
    let folder = bogie();
    fs::create_dir(folder.path().join("out")).expect("writable");
    let journal = File::create(folder.path().join("out").join(JOURNAL)).expect("writable");
    journal.lock().expect("a lock");
    let staging = folder.path().join("out/.girderway-Alive1");
    fs::create_dir(&staging).expect("writable");
    let (status, told) = run(&folder, &["--force"]);
    assert_eq!(status, Some(2));
    assert!(
        told.starts_with("out: another run is writing into this folder  hint: "),
        "{told}"
    );
    assert!(staging.exists());
    drop(journal);
    // a process that another test is starting may hold a copy of the lock for a moment
    let ends = (0..100)
        .map(|_| run(&folder, &[]))
        .find(|(status, _)| *status != Some(2));
    assert_eq!(ends, Some((Some(0), String::new())));
    assert!(!staging.exists());
    assert!(
        files(&folder.path().join("out"), "")
            .iter()
            .all(|name| !name.starts_with('.'))
    );
}

#[test]
fn a_run_clears_what_killed_runs_have_left() {
    let folder = bogie();
    assert_eq!(run(&folder, &[]).0, Some(0));
    let out = folder.path().join("out");
    let mut killed = 0;
    for delay in [0, 0, 50, 100, 200, 400] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_girderway"))
            .args(["run", "scene.json", "-o", "out", "--quiet"])
            .current_dir(folder.path())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        while !out.join(JOURNAL).exists() && child.try_wait().expect("a child").is_none() {
            thread::sleep(Duration::from_millis(1));
        }
        thread::sleep(Duration::from_millis(delay));
        child.kill().expect("a child");
        let status = child.wait().expect("a child");
        killed += usize::from(status.code().is_none());
    }
    assert!(killed > 0, "no run was killed");
    assert_eq!(run(&folder, &[]), (Some(0), String::new()));
    assert!(
        files(&out, "").iter().all(|name| !name.starts_with('.')),
        "{:?}",
        files(&out, "")
    );
    assert_eq!(manifest_faults(&out), Vec::<String>::new());
}

/// Files that the manifest lists and that are not as it lists them, or that it does not list.
fn manifest_faults(out: &Path) -> Vec<String> {
    let manifest = json(&fs::read(out.join("manifest.json")).expect("a manifest"));
    let listed = manifest["outputs"].as_array().expect("a list");
    let is_right = |name: &String| {
        let hash = || Value::from(sha256(&fs::read(out.join(name)).expect("readable")));
        let entry = listed.iter().find(|entry| entry["name"] == name.as_str());
        entry.is_some_and(|entry| entry["sha256"].is_null() || entry["sha256"] == hash())
    };
    files(out, "")
        .into_iter()
        .filter(|name| name != "manifest.json" && !is_right(name))
        .collect()
}

#[test]
fn sim_refuses_a_grid_that_is_not_the_one_of_the_manifest() {
    let folder = bogie();
    assert_eq!(run(&folder, &[]).0, Some(0));
    let sim = ["sim", "scene.json", "-o", "out", "--quiet"];
    assert_eq!(girderway(&folder, &sim).status.code(), Some(0));
    let stiff = read(&folder, "spec.json").replace("9.528", "95.28");
    write(&folder, "stiff.json", &stiff);
    let fea = girderway(
        &folder,
        &["fea", "stiff.json", "-o", "out/grid-girder.json"],
    );
    assert_eq!(fea.status.code(), Some(0));
    let history = read(&folder, "out/history.csv");
    for more in [&[] as &[&str], &["--force"]] {
        let run = girderway(&folder, &[&sim[..], more].concat());
        let told = text(&run.stderr);
        assert_eq!(run.status.code(), Some(2));
        assert!(
            told.starts_with("out/grid-girder.json: does not match the hash in manifest.json"),
            "{told}"
        );
        assert!(told.contains("girderway run"), "{told}");
    }
    assert_eq!(read(&folder, "out/history.csv"), history);
    assert_eq!(run(&folder, &["--force"]).0, Some(0));
    assert_eq!(girderway(&folder, &sim).status.code(), Some(0));
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_what_is_no_regular_file_is_written_through() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let folder = folder();
    let spec = base("spec.json");
    let place = |name: &str| folder.path().join(name);
    let grid = girderway(&folder, &["fea", path(&spec)]).stdout;
    write(&folder, "old.json", "old");
    symlink("old.json", place("link.json")).expect("a link");
    let run = girderway(&folder, &["fea", path(&spec), "-o", "link.json"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    assert!(
        place("link.json")
            .symlink_metadata()
            .expect("there")
            .is_symlink()
    );
    assert_eq!(fs::read(place("old.json")).expect("readable"), grid);

    let made = Command::new("mkfifo")
        .arg(place("pipe"))
        .status()
        .expect("mkfifo");
    assert!(made.success());
    let reader = Command::new("cat")
        .arg(place("pipe"))
        .stdout(Stdio::piped())
        .spawn()
        .expect("cat starts");
    let run = girderway(&folder, &["fea", path(&spec), "-o", "pipe"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    assert!(
        place("pipe")
            .symlink_metadata()
            .expect("there")
            .file_type()
            .is_fifo()
    );
    assert_eq!(reader.wait_with_output().expect("cat ends").stdout, grid);
    let mut names = files(folder.path(), "");
    names.retain(|name| name.starts_with('.'));
    assert!(names.is_empty(), "temporary files are left: {names:?}");
}
