//! Random and damaged inputs, in process: no target panics, hangs or gives a number that is not finite.
//!
//! The environment sets how much is executed (see CONTRIBUTING.md): `GIRDERWAY_FUZZ_SECONDS` for all targets together,
//! or `GIRDERWAY_FUZZ_RUNS` for each; `GIRDERWAY_FUZZ_TARGET` names one target, and `GIRDERWAY_FUZZ_SEED` another
//! sequence of random numbers. An input that fails is stored, and its path is printed with the seed.

mod combinations;
mod generate;
mod mutate;
mod targets;

use std::collections::BTreeSet;
use std::env;
use std::fs::{self, File};
use std::io::{self, Read, Seek, Write};
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use fastrand::Rng;
use formats::tables::{TableFormat, read, write};
use formats::units::{Force, Length, Units};
use targets::{TARGETS, Target, root};

/// Seconds of all targets together, without other settings.
const SECONDS: f64 = 15.0;

/// Seconds after which one execution counts as a hang.
const HANG: u64 = 60;

/// Inputs of a corpus. Those that lead to the same messages as an earlier one are not kept.
const CORPUS: usize = 400;

fn setting<T: std::str::FromStr>(name: &str) -> Option<T> {
    let text = env::var(name).ok()?;
    let value = text.parse().ok();
    assert!(
        value.is_some(),
        "{name} must be a number or a name, got {text:?}"
    );
    value
}

/// The beginnings of a corpus.
fn seeds(target: &Target) -> Vec<Vec<u8>> {
    let mut seeds: Vec<Vec<u8>> = target
        .seeds
        .iter()
        .map(|file| fs::read(root().join(file)).expect("a file of the repository"))
        .collect();
    if target.name == "arrays" {
        let archives =
            ["plain", "packed", "oblong"].map(|name| format!("tests/tables/data/{name}.npz"));
        let read = |file: String| fs::read(root().join(file)).expect("a file of the repository");
        seeds.extend(archives.map(|file| unpacked(&read(file))));
    }
    if let Some(ending) = target.name.strip_prefix("tables_") {
        let units = Units {
            length: Length::Foot,
            force: Force::Pound,
        };
        let text = fs::read(root().join("tests/malformed/base/tables.adm"))
            .expect("a file of the repository");
        let set = read("tables.adm", &text, Some(units)).expect("tables without faults");
        let format = TableFormat::of(&format!("a.{ending}")).expect("a format of the program");
        seeds.push(write(&set, format).expect("tables that can be written"));
    }
    if seeds.is_empty() {
        seeds = (0..8u8)
            .map(|k| {
                (0..120u8)
                    .map(|byte| byte.wrapping_mul(29 + 2 * k).wrapping_add(k))
                    .collect()
            })
            .collect();
    }
    seeds
}

/// An archive in the form that the target `arrays` takes.
fn unpacked(bytes: &[u8]) -> Vec<u8> {
    let mut archive = zip::ZipArchive::new(io::Cursor::new(bytes)).expect("an archive");
    let mut out = Vec::new();
    for index in 0..archive.len() {
        let mut member = archive.by_index(index).expect("a member");
        let mut contents = Vec::new();
        member
            .read_to_end(&mut contents)
            .expect("a member that is right");
        let length = u32::try_from(contents.len()).expect("a small member");
        out.extend(member.name().expect("a plain name").bytes());
        out.push(b'\n');
        out.extend(length.to_be_bytes());
        out.extend(contents);
    }
    out
}

/// Words of the corpus, and for JSON all keys of its format.
fn words(target: &Target, corpus: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let mut words = BTreeSet::new();
    for seed in corpus {
        words.extend(
            mutate::tokens(seed)
                .into_iter()
                .map(|(from, to)| seed[from..to].to_vec()),
        );
    }
    let schema = match target.name {
        "scene" => Some(formats::schema::scene()),
        "design" => Some(formats::schema::design()),
        "spec" | "solve" => Some(formats::schema::beam()),
        "grid" => Some(formats::schema::grid()),
        _ => None,
    };
    if let Some(schema) = schema {
        let text = schema.to_string();
        let keys = mutate::tokens(text.as_bytes())
            .into_iter()
            .map(|(from, to)| &text.as_bytes()[from..to]);
        words.extend(
            keys.filter(|word| word.starts_with(b"\""))
                .map(<[u8]>::to_vec),
        );
    }
    words.into_iter().filter(|word| word.len() < 40).collect()
}

/// Where inputs that fail are stored: beside the build, so that they survive the test.
fn store() -> PathBuf {
    let folder = env::var_os("GIRDERWAY_FUZZ_FOLDER")
        .map_or_else(|| env::temp_dir().join("girderway-fuzz"), PathBuf::from);
    fs::create_dir_all(&folder).expect("a writable folder");
    folder
}

/// The input that is being executed, on the disk: it survives where the process is ended.
struct Current {
    path: PathBuf,
    file: File,
}

impl Current {
    fn new(target: &Target) -> Current {
        let path = store().join(format!("{}-{}", target.name, std::process::id()));
        Current {
            file: File::create(&path).expect("a writable folder"),
            path,
        }
    }

    fn set(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.rewind()?;
        self.file.write_all(bytes)?;
        self.file.set_len(bytes.len() as u64)
    }
}

/// Ends the process, with the path of the input, when an execution takes too long.
fn watch(executions: Arc<AtomicU64>, path: PathBuf, what: String) {
    thread::spawn(move || {
        let mut before = executions.load(Ordering::Relaxed);
        loop {
            thread::sleep(Duration::from_secs(HANG));
            let now = executions.load(Ordering::Relaxed);
            if now == u64::MAX {
                return;
            }
            if now == before {
                let mut stderr = io::stderr();
                let _ = writeln!(stderr, "{what}: more than {HANG} s for {}", path.display());
                std::process::abort();
            }
            before = now;
        }
    });
}

/// What one target was given.
struct Tally {
    executions: u64,
    seconds: f64,
    slowest: f64,
    corpus: usize,
}

/// Executes a target until the time or the number of executions is reached.
fn campaign(target: &Target, seconds: f64, most: u64, seed: u64) -> Tally {
    let mut dice = Rng::with_seed(seed);
    let mut corpus = seeds(target);
    let words = words(target, &corpus);
    let mut known = BTreeSet::new();
    let mut current = Current::new(target);
    let executions = Arc::new(AtomicU64::new(0));
    watch(
        Arc::clone(&executions),
        current.path.clone(),
        target.name.to_owned(),
    );
    let start = Instant::now();
    let mut tally = Tally {
        executions: 0,
        seconds: 0.0,
        slowest: 0.0,
        corpus: 0,
    };
    let first = corpus.len();
    while tally.executions < most
        && (tally.executions < first as u64 || start.elapsed().as_secs_f64() < seconds)
    {
        let index = tally.executions as usize;
        let input = if index < first {
            corpus[index].clone()
        } else {
            let [base, other] = [0; 2].map(|_| dice.usize(..corpus.len()));
            mutate::mutated(&corpus[base], &corpus[other], &words, &mut dice)
        };
        current.set(&input).expect("a writable folder");
        let begun = Instant::now();
        let result = panic::catch_unwind(AssertUnwindSafe(|| (target.run)(&input)));
        let Ok(signature) = result else {
            panic!(
                "{} fails (seed {seed}, execution {index}) for {}",
                target.name,
                current.path.display()
            );
        };
        tally.slowest = tally.slowest.max(begun.elapsed().as_secs_f64());
        tally.executions += 1;
        executions.fetch_add(1, Ordering::Relaxed);
        if known.insert(signature) && index >= first && corpus.len() < CORPUS {
            corpus.push(input);
        }
    }
    executions.store(u64::MAX, Ordering::Relaxed);
    fs::remove_file(&current.path).expect("our own file");
    tally.seconds = start.elapsed().as_secs_f64();
    tally.corpus = corpus.len();
    tally
}

#[test]
fn no_input_makes_a_target_fail() {
    let chosen: Option<String> = setting("GIRDERWAY_FUZZ_TARGET");
    let targets: Vec<&Target> = TARGETS
        .iter()
        .filter(|target| chosen.as_ref().is_none_or(|name| name == target.name))
        .collect();
    assert!(!targets.is_empty(), "there is no target {chosen:?}");
    let runs: Option<u64> = setting("GIRDERWAY_FUZZ_RUNS");
    let seconds = setting("GIRDERWAY_FUZZ_SECONDS").unwrap_or(SECONDS) / targets.len() as f64;
    let (seconds, most) = runs.map_or((seconds, u64::MAX), |runs| (f64::INFINITY, runs));
    let seed = setting("GIRDERWAY_FUZZ_SEED").unwrap_or(1);
    let mut table = String::from("target | executions | per second | slowest, s | corpus\n");
    for target in targets {
        let Tally {
            executions,
            seconds,
            slowest,
            corpus,
        } = campaign(target, seconds, most, seed);
        let rate = executions as f64 / seconds.max(1e-9);
        table.push_str(&format!(
            "{} | {executions} | {rate:.0} | {slowest:.3} | {corpus}\n",
            target.name
        ));
    }
    let mut stderr = io::stderr();
    let _ = stderr.write_all(table.as_bytes());
}

/// What became of a combination.
enum Became {
    /// It ran to its end.
    Ran,
    /// The run was given up or ended early, with a reason.
    Incomplete,
    /// It was refused, with a message.
    Refused(String),
    /// It took longer than [`LONGEST`].
    Slow,
    /// It panicked or gave a number that is not finite.
    Failed,
}

/// Seconds that a combination may take.
const LONGEST: f64 = 20.0;

/// Runs a combination from its files to its summary.
fn run_combination(seed: u64, folder: &Path) -> Became {
    let combination = combinations::combination(seed);
    for (name, spec) in &combination.specs {
        fs::write(folder.join(name), spec.to_string()).expect("a writable folder");
    }
    let path = folder.join("scene.json");
    fs::write(&path, combination.scene.to_string()).expect("a writable folder");
    let begun = Instant::now();
    let run = || {
        let document = formats::scene::Document::open(&path)
            .map_err(|wrong| Became::Refused(wrong[0].to_string()))?;
        let go_on = |_: results::cases::SimulationProgress<'_>| match begun.elapsed().as_secs_f64()
            > LONGEST
        {
            true => std::ops::ControlFlow::Break(()),
            false => std::ops::ControlFlow::Continue(()),
        };
        let options = results::cases::RunOptions {
            threads: Some(1),
            ..Default::default()
        };
        let run = results::scene_run::SceneRun::of(
            document,
            &foundations::StructureCache::default(),
            options,
            &go_on,
        );
        let run = run.map_err(|error| match error {
            results::Error::Stopped => Became::Slow,
            results::Error::Input(wrong) => Became::Refused(wrong[0].to_string()),
            other => Became::Refused(other.to_string()),
        })?;
        let columns = run.cases.iter().flat_map(|case| &case.columns.columns);
        if columns
            .flat_map(|column| &column.values)
            .any(|value| !value.is_finite())
        {
            return Err(Became::Failed);
        }
        let _ = run.summary(&run.comparison(Some(1)));
        Ok(match run.reason_incomplete() {
            Some(_) => Became::Incomplete,
            None => Became::Ran,
        })
    };
    let became = panic::catch_unwind(AssertUnwindSafe(run))
        .unwrap_or(Err(Became::Failed))
        .unwrap_or_else(|other| other);
    match became {
        Became::Failed => Became::Failed,
        _ if begun.elapsed().as_secs_f64() > LONGEST => Became::Slow,
        other => other,
    }
}

/// Scenes that combine features run, or are refused with a message; none panics. Those that fail are stored. Where
/// `GIRDERWAY_FUZZ_COMBINATIONS` gives their number, which is a measurement on a quiet machine, none may take longer than
/// [`LONGEST`] either; the second tier only lists those that do.
#[test]
fn combinations_of_features_run_or_are_refused() {
    let measured: Option<u64> = setting("GIRDERWAY_FUZZ_COMBINATIONS");
    let count = measured.unwrap_or(200);
    let first: u64 = setting("GIRDERWAY_FUZZ_SEED").unwrap_or(1) * 1_000_000_000;
    let next = AtomicU64::new(0);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let tallies = thread::scope(|scope| {
        let work = || {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let (mut counts, mut told) = ([0_u64; 5], Vec::new());
            loop {
                let seed = first + next.fetch_add(1, Ordering::Relaxed);
                if seed >= first + count {
                    return (counts, told);
                }
                let became = run_combination(seed, folder.path());
                let (at, what) = match &became {
                    Became::Ran => (0, None),
                    Became::Incomplete => (1, None),
                    Became::Refused(why) => (
                        2,
                        (!why.contains(".json:")).then_some("refused without a place"),
                    ),
                    Became::Slow => (3, Some("slow")),
                    Became::Failed => (4, Some("failed")),
                };
                counts[at] += 1;
                if let Some(what) = what {
                    let kept = store().join(format!("combination-{seed}"));
                    fs::create_dir_all(&kept).expect("a writable folder");
                    for entry in fs::read_dir(folder.path()).expect("a folder").flatten() {
                        let _ = fs::copy(entry.path(), kept.join(entry.file_name()));
                    }
                    told.push(format!("{what}: {}", kept.display()));
                }
                if let (Became::Refused(why), Ok(_)) = (&became, env::var("GIRDERWAY_FUZZ_TELL")) {
                    told.push(format!("refused {seed}: {why}"));
                }
            }
        };
        let all: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        all.into_iter()
            .map(|own| own.join().expect("a thread that ends"))
            .collect::<Vec<_>>()
    });
    let mut counts = [0_u64; 5];
    let mut told = Vec::new();
    for (own, texts) in tallies {
        counts
            .iter_mut()
            .zip(own)
            .for_each(|(sum, own)| *sum += own);
        told.extend(texts);
    }
    let [ran, incomplete, refused, slow, failed] = counts;
    let mut stderr = io::stderr();
    let _ = writeln!(
        stderr,
        "{}\n{count} combinations: {ran} ran, {incomplete} ended early, {refused} refused, {slow} slow, {failed} failed",
        told.join("\n")
    );
    assert!(
        failed == 0 && (slow == 0 || measured.is_none()) && 2 * (ran + incomplete) > count,
        "see above"
    );
}

/// Inputs that failed once. Each is named after its target.
#[test]
fn inputs_that_failed_once_do_not_fail_again() {
    let folder = root().join("tests/fuzz/found");
    let mut count = 0;
    for entry in fs::read_dir(&folder).expect("the folder of inputs") {
        let path = entry.expect("a readable folder").path();
        let name = stem_before_dash(&path);
        let target = TARGETS.iter().find(|target| target.name == name);
        let target = target.unwrap_or_else(|| panic!("{}: no target of that name", path.display()));
        let _ = (target.run)(&fs::read(&path).expect("a readable file"));
        count += 1;
    }
    assert!(count > 0, "{} is empty", folder.display());
}

/// The name of a file up to its first dash.
fn stem_before_dash(path: &Path) -> String {
    let name = path
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    name.split('-').next().unwrap_or_default().to_owned()
}

/// A campaign that never reaches a valid input tests only the first lines of the readers.
#[test]
fn most_generated_inputs_are_taken() {
    let mut dice = Rng::with_seed(5);
    let mut bytes = || (0..200).map(|_| dice.u8(..)).collect::<Vec<u8>>();
    let of = |text: String| formats::text::source::Source {
        name: "spec.json".to_owned(),
        text,
    };
    let specs = (0..200)
        .filter(|_| formats::spec::Spec::read(&of(generate::spec(&bytes())), None).is_ok())
        .count();
    assert!(specs > 100, "only {specs} of 200 generated specs are taken");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.json");
    let mut told = String::new();
    let mut taken = 0;
    for _ in 0..200 {
        let (spec, scene) = generate::scene(&bytes());
        fs::write(folder.path().join("generated.json"), spec).expect("a writable folder");
        fs::write(&path, scene).expect("a writable folder");
        match formats::scene::Document::open(&path) {
            Ok(_) => taken += 1,
            Err(wrong) => told.push_str(&format!("{}\n", wrong[0])),
        }
    }
    assert!(
        taken > 80,
        "only {taken} of 200 generated scenes are taken\n{told}"
    );
}
