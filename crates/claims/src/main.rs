//! Makes the generated parts of the book, and the data they come from.
//!
//! `cargo run -p claims` writes the pages from what `docs/` holds; `-- figures` runs the tests that hold figures first,
//! `-- study FOLDER NAME COMMAND` takes over a folder of `girderway study`.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use claims::{Error, FOLDER, collect, excerpt, pages, programs};

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        [] => Ok(()),
        ["figures"] => figures(&root),
        ["study", folder, name, command @ ..] => study(&root, Path::new(folder), name, &command.join(" ")),
        _ => Err(Error::Run("usage: claims [figures | study FOLDER NAME COMMAND]".to_owned())),
    };
    match done.and_then(|()| write(&root)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the tests that hold figures.
fn figures(root: &Path) -> Result<(), Error> {
    let folder = std::env::temp_dir().join(format!("girderway-claims-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|error| Error::file(&folder, &error))?;
    let mut packages: Vec<(String, Vec<String>)> = Vec::new();
    for (package, test) in programs(root)? {
        match packages.last_mut().filter(|(own, _)| *own == package) {
            Some((_, tests)) => tests.push(test),
            None => packages.push((package, vec![test])),
        }
    }
    for (package, tests) in packages {
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command.current_dir(root).env(FOLDER, &folder).args(["test", "-p", &package]);
        command.args(tests.iter().flat_map(|test| ["--test", test]));
        // on one thread tests have no threads of their own, whose names are theirs
        command.args(["--", "--test-threads", "2"]);
        let status = command.status().map_err(|error| Error::Run(error.to_string()))?;
        if !status.success() {
            return Err(Error::Run(format!("tests of {package} failed")));
        }
    }
    let text = collect(&folder)?;
    put(&root.join("docs/claims.json"), &text)?;
    fs::remove_dir_all(&folder).map_err(|error| Error::file(&folder, &error))
}

fn study(root: &Path, folder: &Path, name: &str, command: &str) -> Result<(), Error> {
    let path = root.join("docs/studies");
    fs::create_dir_all(&path).map_err(|error| Error::file(&path, &error))?;
    put(&path.join(name).with_extension("json"), &excerpt(folder, command)?)
}

fn write(root: &Path) -> Result<(), Error> {
    for page in pages(root)? {
        put(&root.join(page.path), &page.text)?;
    }
    Ok(())
}

fn put(path: &PathBuf, text: &str) -> Result<(), Error> {
    if fs::read_to_string(path).is_ok_and(|own| own == text) {
        return Ok(());
    }
    println!("{}", path.display());
    fs::write(path, text).map_err(|error| Error::file(path, &error))
}
