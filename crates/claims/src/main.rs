//! Makes the generated parts of the book, and the data they come from.
//!
//! `cargo run -p claims` writes the pages from what `docs/` holds; `-- figures` runs the tests that hold figures first,
//! `-- benches` all benchmarks; `-- study FOLDER NAME COMMAND` takes over a folder of `girderway study` with its charts,
//! `-- stability FOLDER` one of `girderway study --stability`.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use claims::{
    Bench, Error, FOLDER, Known, MAPS, Program, Sitting, charts, collect, excerpt, maps, pages, programs,
};

const USAGE: &str =
    "usage: claims [figures | benches | study FOLDER NAME COMMAND | stability FOLDER [COMMAND]]";
/// How the maps are made, where nothing else is said.
const MAPPED: &str = "girderway study examples/bogie/scene.json --stability";

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap_or(Path::new("."));
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        [] => Ok(()),
        ["figures"] => figures(root),
        ["study", folder, name, command @ ..] => study(root, Path::new(folder), name, &command.join(" ")),
        ["stability", folder, command @ ..] => stability(root, Path::new(folder), &command.join(" ")),
        ["benches"] => benches(root),
        _ => Err(Error::Run(USAGE.to_owned())),
    };
    match done.and_then(|()| write(root)) {
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
        let mut command = cargo(root);
        command.env(FOLDER, &folder).args(["test", "-p", &package]);
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

fn cargo(root: &Path) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root);
    command
}

/// Takes over a study, and its charts; charts that it has no longer are taken away.
fn study(root: &Path, folder: &Path, name: &str, command: &str) -> Result<(), Error> {
    let path = root.join("docs/studies");
    fs::create_dir_all(&path).map_err(|error| Error::file(&path, &error))?;
    put(&path.join(name).with_extension("json"), &excerpt(folder, command)?)?;
    for (chart, text) in charts(folder, name)? {
        let chart = path.join(chart);
        match text {
            Some(text) => put(&chart, &text)?,
            None if chart.is_file() => {
                fs::remove_file(&chart).map_err(|error| Error::file(&chart, &error))?
            }
            None => {}
        }
    }
    Ok(())
}

fn stability(root: &Path, folder: &Path, command: &str) -> Result<(), Error> {
    put(&root.join(MAPS), &maps(folder, if command.is_empty() { MAPPED } else { command })?)
}

/// Runs all benchmarks, builds first.
fn benches(root: &Path) -> Result<(), Error> {
    let mut build = cargo(root);
    build.args(["bench", "--no-run", "--message-format", "json-render-diagnostics"]);
    for (package, program) in claims::benches(root)? {
        build.args(["-p", &package, "--bench", &program]);
    }
    let output = build.stderr(Stdio::inherit()).output().map_err(|error| Error::Run(error.to_string()))?;
    if !output.status.success() {
        return Err(Error::Run("the benchmarks do not build".to_owned()));
    }
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let machine = claims::machine(&read("/proc/cpuinfo"), &read("/proc/loadavg"), cores);
    let days = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |own| own.as_secs() / 86_400);
    let start = Instant::now();
    let mut found = Vec::new();
    for program in claims::built(&String::from_utf8_lossy(&output.stdout)) {
        found.extend(bench(&program)?);
    }
    let seconds = start.elapsed().as_secs_f64().round();
    for (name, known) in claims::json::<Vec<(String, Known)>>(&root.join("docs/known_times.json"))? {
        let own = found.iter_mut().find(|own| own.name == name);
        let own = own.ok_or_else(|| Error::Run(format!("a time is known of {name}, which is no benchmark")));
        own?.known = Some(known);
    }
    let sitting = Sitting { date: claims::date(days), machine, seconds, benches: found };
    put(&root.join("docs/benchmarks.json"), &sitting.text())
}

/// Runs one program of benchmarks, as cargo does.
fn bench(program: &Program) -> Result<Vec<Bench>, Error> {
    println!("{}", program.name);
    let output = Command::new(&program.path).arg("--bench").current_dir(&program.folder).output();
    let output = output.map_err(|error| Error::file(&program.path, &error))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut found = claims::divan(&text, &program.name);
    found.extend(claims::table(&text, &program.name));
    if !output.status.success() || found.is_empty() {
        let told = String::from_utf8_lossy(&output.stderr);
        return Err(Error::Run(format!("{} printed no times\n{told}{text}", program.name)));
    }
    Ok(found)
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
