//! Disks that are full, outputs that nobody reads, and pipes into which nobody writes.
#![cfg(unix)]

use std::fs::{self, File};
use std::io::Write;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

use super::{example, files, folder, girderway, json, path, text};

/// A folder with the bogie's scene, without its comparisons, and its spec.
fn bogie() -> TempDir {
    let folder = folder();
    for name in ["spec.json", "scene.json"] {
        fs::copy(example("bogie").join(name), folder.path().join(name)).expect("a copy");
    }
    change(&folder, |scene| {
        scene.as_object_mut().expect("an object").remove("compare");
        scene["end"]["time"] = 1.into();
    });
    folder
}

fn change(folder: &TempDir, with: impl Fn(&mut serde_json::Value)) {
    let file = folder.path().join("scene.json");
    let mut scene = json(&fs::read(&file).expect("readable"));
    with(&mut scene);
    fs::write(file, scene.to_string()).expect("writable");
}

/// Names and contents of all files of the folder.
fn contents(folder: &TempDir) -> Vec<(String, Vec<u8>)> {
    let names = files(folder.path(), "");
    names
        .into_iter()
        .map(|name| (fs::read(folder.path().join(&name)).expect("readable"), name))
        .map(|(a, b)| (b, a))
        .collect()
}

/// Runs the program by a shell after other commands of the shell.
fn after(folder: &TempDir, before: &str, arguments: &str) -> Output {
    let line = format!(
        "{before}; exec {} {arguments}",
        env!("CARGO_BIN_EXE_girderway")
    );
    Command::new("sh")
        .args(["-c", &line])
        .current_dir(folder.path())
        .output()
        .expect("a shell")
}

/// A limit of the size of files, in blocks of 512 bytes. It meets a run where a full disk does.
fn limited(folder: &TempDir, blocks: u32, arguments: &str) -> Output {
    after(
        folder,
        &format!("trap '' XFSZ; ulimit -f {blocks}"),
        arguments,
    )
}

/// Runs the program with standard output on a device that is full, or into a pipe that is closed.
fn printing(folder: &TempDir, arguments: &[&str], to: Stdio) -> Output {
    let program = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(arguments)
        .current_dir(folder.path())
        .stdout(to)
        .stderr(Stdio::piped())
        .spawn();
    program
        .and_then(|child| child.wait_with_output())
        .expect("the program starts")
}

const PRINTING: [&[&str]; 5] = [
    &["fea", "spec.json"],
    &["deck", "scene.json"],
    &["schema", "scene"],
    &["run", "scene.json", "--json", "--quiet", "-o", "out"],
    &["run", "--help"],
];

#[test]
fn a_reader_that_has_gone_is_no_error() {
    let folder = bogie();
    for arguments in PRINTING {
        let mut reader = Command::new("true")
            .stdin(Stdio::piped())
            .spawn()
            .expect("a program that reads nothing");
        let pipe = reader.stdin.take().expect("its standard input");
        reader.wait().expect("it ends at once");
        let run = printing(&folder, arguments, Stdio::from(pipe));
        assert_eq!(
            run.status.code(),
            Some(0),
            "{arguments:?}: {}",
            text(&run.stderr)
        );
        assert!(
            !text(&run.stderr).contains("ipe"),
            "{arguments:?}: {}",
            text(&run.stderr)
        );
    }
}

#[test]
fn standard_output_on_a_full_device_is_an_error() {
    let folder = bogie();
    if !fs::exists("/dev/full").is_ok_and(|there| there) {
        writeln!(std::io::stderr(), "skipped: this system has no /dev/full")
            .expect("standard error");
        return;
    }
    for arguments in PRINTING {
        let full = File::options()
            .write(true)
            .open("/dev/full")
            .expect("a device");
        let run = printing(&folder, arguments, Stdio::from(full));
        let told = text(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{arguments:?}: {told}");
        assert!(
            told.contains("standard output")
                && told.contains("cannot be written: the disk is full"),
            "{arguments:?}: {told}"
        );
    }
    let run = girderway(&folder, &["fea", "spec.json", "-o", "/dev/full", "--quiet"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(
        text(&run.stderr).starts_with("/dev/full: cannot be written: the disk is full  hint: free"),
        "{run:?}"
    );
}

#[test]
fn a_run_that_finds_no_room_leaves_the_older_result_and_nothing_else() {
    let folder = bogie();
    // nothing was there: nothing is there afterwards
    let before = contents(&folder);
    let told = limited(&folder, 8, "run scene.json -o out --quiet");
    assert_eq!(told.status.code(), Some(2), "{}", text(&told.stderr));
    assert!(
        text(&told.stderr).contains("cannot be written: the file is larger"),
        "{}",
        text(&told.stderr)
    );
    assert_eq!(contents(&folder), before);
    assert!(!folder.path().join("out").exists());
    // an older result stands there
    assert_eq!(
        girderway(&folder, &["run", "scene.json", "-o", "out", "--quiet"])
            .status
            .code(),
        Some(0)
    );
    change(&folder, |scene| {
        scene["bodies"]["bogie"]["weight"] = 4.7e6.into()
    });
    let older = contents(&folder);
    for blocks in [1, 2, 4, 16, 64, 128] {
        let told = limited(&folder, blocks, "run scene.json -o out --quiet");
        assert_eq!(
            told.status.code(),
            Some(2),
            "{blocks}: {}",
            text(&told.stderr)
        );
        assert!(
            text(&told.stderr).starts_with("out/"),
            "{blocks}: {}",
            text(&told.stderr)
        );
        assert_eq!(contents(&folder), older, "{blocks} blocks");
    }
    assert_eq!(
        girderway(&folder, &["run", "scene.json", "-o", "out", "--quiet"])
            .status
            .code(),
        Some(0)
    );
    assert_ne!(contents(&folder), older);
}

#[test]
fn a_single_file_and_a_deck_with_its_commands_are_whole_or_as_before() {
    let folder = bogie();
    for (blocks, arguments) in [
        (1, "fea spec.json -o grid.json --quiet"),
        (4, "fea spec.json -o grid.json --quiet"),
        (1, "deck scene.json -o bogie.adm --quiet"),
        (0, "deck scene.json -o bogie.adm --quiet"),
    ] {
        for older in [false, true] {
            if older {
                let whole: Vec<&str> = arguments.split(' ').collect();
                assert_eq!(girderway(&folder, &whole).status.code(), Some(0));
            }
            let before = contents(&folder);
            let run = limited(&folder, blocks, arguments);
            assert_eq!(
                run.status.code(),
                Some(2),
                "{arguments}: {}",
                text(&run.stderr)
            );
            assert_eq!(contents(&folder), before, "{arguments} in {blocks} blocks");
        }
        for name in ["grid.json", "bogie.adm", "bogie.acf"] {
            let _ = fs::remove_file(folder.path().join(name));
        }
    }
}

/// A file system of a few blocks in a name space of its own, where the system permits that.
#[test]
fn on_a_full_file_system_the_older_result_remains() {
    let folder = bogie();
    fs::create_dir(folder.path().join("disk")).expect("writable");
    let program = env!("CARGO_BIN_EXE_girderway");
    let script = format!(
        "mount -t tmpfs -o size=2m none disk || exit 77
         {program} run scene.json -o disk/out --quiet || exit 10
         sed -i s/4800000/4700000/ scene.json && grep -q 4700000 scene.json || exit 11
         dd if=/dev/zero of=disk/filler bs=4096 >/dev/null 2>&1
         find disk/out -type f | sort | xargs sha256sum > before
         {program} run scene.json -o disk/out --quiet 2> told; status=$?
         find disk/out -type f | sort | xargs sha256sum > after
         cat told >&2; cmp before after || exit 12
         rm disk/filler; {program} run scene.json -o disk/out --quiet || exit 13
         exit $status"
    );
    change(&folder, |scene| {
        scene["bodies"]["bogie"]["weight"] = 4_800_000.into()
    });
    let run = Command::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "sh", "-c", &script])
        .current_dir(folder.path())
        .output();
    let told = match run {
        Ok(run) if matches!(run.status.code(), Some(2 | 10..=13)) => run,
        other => {
            writeln!(
                std::io::stderr(),
                "skipped: no file system can be mounted: {other:?}"
            )
            .expect("standard error");
            return;
        }
    };
    assert_eq!(
        told.status.code(),
        Some(2),
        "{}{}",
        text(&told.stdout),
        text(&told.stderr)
    );
    assert!(
        text(&told.stderr).contains("cannot be written: the disk is full"),
        "{}",
        text(&told.stderr)
    );
}

#[test]
fn a_command_file_of_somebody_else_is_not_replaced() {
    let folder = bogie();
    let own = folder.path().join("bogie.acf");
    fs::write(&own, "file/model=other\nsimulate/static\n! mine\nstop\n").expect("writable");
    let before = contents(&folder);
    let run = girderway(
        &folder,
        &["deck", "scene.json", "-o", "bogie.adm", "--quiet"],
    );
    assert_eq!(run.status.code(), Some(2));
    let wanted =
        "bogie.acf: would be overwritten, but was not written by girderway or was modified since";
    assert!(
        text(&run.stderr).starts_with(wanted) && text(&run.stderr).contains("--force"),
        "{run:?}"
    );
    assert_eq!(contents(&folder), before);
    for more in [&["--force"][..], &[]] {
        let run = girderway(
            &folder,
            &[&["deck", "scene.json", "-o", "bogie.adm", "--quiet"], more].concat(),
        );
        assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    }
    assert!(
        fs::read_to_string(own)
            .expect("readable")
            .starts_with("file/model=bogie\n")
    );
}

#[test]
fn a_pipe_is_an_input_like_a_file() {
    let folder = bogie();
    let grid = |arguments: &str| {
        after(
            &folder,
            "mkfifo pipe && (cat spec.json > pipe &)",
            arguments,
        )
    };
    let run = grid("fea pipe");
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let file = girderway(&folder, &["fea", path(&folder.path().join("spec.json"))]);
    assert_eq!(
        json(&run.stdout)["influence"],
        json(&file.stdout)["influence"]
    );
}
