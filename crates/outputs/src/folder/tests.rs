use super::*;
use crate::journal::JOURNAL;
use formats::text::inputs::Inputs;
use serde_json::{Value, json};

fn open(path: &Path, force: bool, names: &[&str]) -> Result<OutputFolder, Error> {
    let names = names.iter().map(|name| (*name).to_owned()).collect();
    OutputFolder::open(
        path,
        "run",
        force,
        &PlannedFiles {
            names,
            plots: vec!["path-".to_owned()],
        },
    )
}

fn filled(path: &Path, files: &[(&str, &str)]) -> OutputFolder {
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    let mut folder = open(path, false, &names).expect("a folder that may be written");
    for (name, text) in files {
        folder.add(name, *text);
    }
    folder.add_varying("timing.json", "0.1");
    folder
}

fn new_manifest() -> Manifest {
    Manifest::new("run", &Inputs::default(), json!({}))
}

fn commit(path: &Path, files: &[(&str, &str)]) {
    filled(path, files)
        .commit(new_manifest())
        .expect("a writable folder");
}

fn manifest(path: &Path) -> Value {
    let text = fs::read(path.join(MANIFEST)).expect("a manifest");
    serde_json::from_slice(&text).expect("JSON")
}

fn names(path: &Path) -> Vec<String> {
    let entries = fs::read_dir(path).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("a readable file")
}

fn message(failure: &Error) -> String {
    failure.to_string()
}

#[test]
fn a_folder_has_its_files_and_a_manifest_and_nothing_else() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path().join("deep/out");
    commit(&path, &[("b.csv", "1,2"), ("plots/a.svg", "<svg/>")]);
    assert_eq!(
        names(&path),
        ["b.csv", "manifest.json", "plots", "timing.json"]
    );
    let outputs = manifest(&path)["outputs"].clone();
    assert_eq!(
        outputs[0],
        json!({ "name": "b.csv", "bytes": 3, "sha256": sha256(b"1,2") })
    );
    assert_eq!(outputs[2], json!({ "name": "timing.json" }));
}

#[test]
fn a_new_run_takes_away_what_the_old_one_left_but_not_what_a_user_changed() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path();
    commit(
        path,
        &[
            ("history.csv", "1"),
            ("history-old.csv", "2"),
            ("history-mine.csv", "3"),
        ],
    );
    fs::write(path.join("history-mine.csv"), "edited").expect("writable");
    fs::write(path.join("notes.txt"), "mine").expect("writable");
    commit(path, &[("history.csv", "4")]);
    let left = [
        "history-mine.csv",
        "history.csv",
        "manifest.json",
        "notes.txt",
        "timing.json",
    ];
    assert_eq!(names(path), left);
    assert_eq!(read(&path.join("history.csv")), "4");
}

#[test]
fn a_folder_under_a_file_is_refused_before_any_work() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let file = temporary.path().join("file");
    fs::write(&file, "x").expect("writable");
    assert!(open(&file.join("out"), false, &[]).is_err());
}

#[test]
fn a_run_that_does_not_commit_leaves_no_trace() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path().join("deep/out");
    drop(filled(&path, &[("history.csv", "1")]));
    assert!(names(temporary.path()).is_empty());
}

#[test]
fn files_of_others_are_refused_by_name_and_replaced_by_force_alone() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path();
    commit(
        path,
        &[
            ("history.csv", "1"),
            ("plots/path-a.svg", "2"),
            ("summary.json", "3"),
        ],
    );
    fs::write(path.join("history.csv"), "edited").expect("writable");
    fs::write(path.join("plots/path-b.svg"), "mine").expect("writable");
    fs::write(path.join("plots/photo.svg"), "mine").expect("writable");
    let planned = ["history.csv", "summary.json", "timing.json"];
    let told = message(&open(path, false, &planned).expect_err("files of others"));
    assert_eq!(told.lines().count(), 2, "{told}");
    assert!(
        told.contains("history.csv: would be overwritten") && told.contains("plots/path-b.svg"),
        "{told}"
    );
    assert!(told.contains("--force"), "{told}");

    // names that are known only at the end are checked before anything is replaced
    let known = PlannedFiles {
        names: vec!["summary.json".to_owned()],
        plots: Vec::new(),
    };
    let mut folder = OutputFolder::open(path, "run", false, &known).expect("it is ours");
    folder.add("summary.json", "4");
    folder.add("plots/photo.svg", "5");
    assert!(
        message(&folder.commit(new_manifest()).expect_err("a file of others"))
            .contains("photo.svg")
    );
    assert_eq!(
        (
            read(&path.join("summary.json")),
            read(&path.join("plots/photo.svg"))
        ),
        ("3".into(), "mine".into())
    );

    let mut folder = open(path, true, &planned).expect("force");
    folder.add("history.csv", "6");
    folder.commit(new_manifest()).expect("force");
    assert_eq!(
        (
            read(&path.join("history.csv")),
            read(&path.join("plots/photo.svg"))
        ),
        ("6".into(), "mine".into())
    );
    assert!(!path.join("summary.json").exists() && path.join("plots/path-b.svg").exists());
}

#[test]
fn a_manifest_of_another_program_is_a_file_of_others() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let file = temporary.path().join(MANIFEST);
    fs::write(&file, r#"{"name": "web", "outputs": []}"#).expect("writable");
    assert!(message(&open(temporary.path(), false, &[]).expect_err("not ours")).contains(MANIFEST));
    assert_eq!(names(temporary.path()), [MANIFEST]);
}

#[test]
fn a_name_too_long_is_refused_before_the_work_and_at_the_end_leaves_the_older_result() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path();
    commit(path, &[("history.csv", "1"), ("summary.json", "2")]);
    let before = read(&path.join(MANIFEST));
    let long = format!("plots/{}.svg", "a".repeat(300));
    assert!(message(&open(path, false, &[&long]).expect_err("too long")).contains("too long"));
    let mut folder = filled(path, &[("history.csv", "3")]);
    folder.add(&long, "4");
    assert!(message(&folder.commit(new_manifest()).expect_err("too long")).contains("too long"));
    assert_eq!(
        names(path),
        [
            "history.csv",
            "manifest.json",
            "summary.json",
            "timing.json"
        ]
    );
    assert_eq!(
        (read(&path.join("history.csv")), read(&path.join(MANIFEST))),
        ("1".into(), before)
    );
}

#[test]
fn a_replacement_that_fails_puts_the_older_result_back() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path();
    commit(path, &[("a.csv", "1"), ("b.csv", "2")]);
    let before = read(&path.join(MANIFEST));
    let mut folder = filled(path, &[("a.csv", "3"), ("b.csv", "4"), ("new.csv", "5")]);
    folder.finish_files(&mut new_manifest()).expect("writable");
    let staging = folder.staging.take().expect("an open folder");
    // the third file cannot be placed
    fs::remove_file(staging.path(2)).expect("written");
    let mut exchange = Exchange {
        staging: &staging,
        steps: Vec::new(),
    };
    folder
        .place(&mut exchange, 0)
        .expect_err("a file is missing");
    assert_eq!(
        (read(&path.join("a.csv")), path.join(MANIFEST).exists()),
        ("3".into(), false)
    );
    exchange.undo().expect("renames");
    drop((staging, folder));
    assert_eq!(
        names(path),
        ["a.csv", "b.csv", "manifest.json", "timing.json"]
    );
    let now = ["a.csv", "b.csv", MANIFEST].map(|name| read(&path.join(name)));
    assert_eq!(now, ["1".to_owned(), "2".to_owned(), before]);
}

#[test]
fn a_second_writer_is_refused_while_the_first_one_lives() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path();
    let mut first = filled(path, &[("history.csv", "1")]);
    let number = first.staging().begin(FileContents::Varying(Vec::new()));
    first.staging().finish(number).expect("writable");
    let staged = first.staging().path(number);
    let told = message(&open(path, true, &[]).expect_err("the first one lives"));
    assert!(
        told.contains("another run is writing into this folder"),
        "{told}"
    );
    assert!(staged.exists());
    first.add("summary.json", "2");
    first.commit(new_manifest()).expect("its own folder");
    drop(open(path, false, &["history.csv"]).expect("the first one has ended"));
}

#[test]
fn what_a_dead_run_left_is_cleared_and_its_files_count_as_ours() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path();
    commit(path, &[("a.csv", "1"), ("b.csv", "2")]);
    // a run that died after it had placed `a.csv` and `c.csv`: no destructor was run
    let mut dead = filled(
        path,
        &[
            ("a.csv", "3"),
            ("b.csv", "4"),
            ("c.csv", "5"),
            ("d.csv", "6"),
        ],
    );
    let entry = |name: &str, text: &str| OutputEntry {
        name: name.to_owned(),
        bytes: Some(text.len()),
        sha256: Some(sha256(text.as_bytes())),
    };
    let old = dead.listed.clone();
    dead.journal.list(&old).expect("writable");
    dead.journal
        .list(&[
            entry("a.csv", "3"),
            entry("b.csv", "4"),
            entry("c.csv", "5"),
        ])
        .expect("writable");
    dead.finish_files(&mut new_manifest()).expect("writable");
    let staging = dead.staging.take().expect("an open folder");
    let left = staging.path(0);
    staging.keep();
    fs::remove_file(path.join(MANIFEST)).expect("there");
    fs::write(path.join("a.csv"), "3").expect("writable");
    fs::write(path.join("c.csv"), "5").expect("writable");
    dead.keeps_journal = true;
    drop(dead);
    assert!(left.exists() && path.join(JOURNAL).exists());

    // a run that fails leaves the journal of the dead one
    drop(open(path, false, &["a.csv", "b.csv", "c.csv"]).expect("all of them are ours"));
    assert!(path.join(JOURNAL).exists() && !left.exists());
    commit(path, &[("a.csv", "7"), ("b.csv", "8")]);
    assert_eq!(
        names(path),
        ["a.csv", "b.csv", "manifest.json", "timing.json"]
    );
}

#[test]
fn a_journal_alone_makes_no_file_of_others_ours() {
    let temporary = tempfile::tempdir().expect("a temporary folder");
    let path = temporary.path();
    fs::write(
        path.join(JOURNAL),
        "\n{\"format\":\"girderway-journal/1\",\"command\":\"run\"}\n{\"name\":\"hist",
    )
    .expect("writable");
    fs::write(path.join("history.csv"), "mine").expect("writable");
    assert!(open(path, false, &["history.csv"]).is_err());
    assert!(open(path, false, &["summary.json"]).is_ok());
    fs::write(path.join(JOURNAL), "mine").expect("writable");
    assert!(message(&open(path, false, &[]).expect_err("no journal")).contains("not a journal"));
    assert_eq!(read(&path.join(JOURNAL)), "mine");
}
