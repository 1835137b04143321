//! Fuzz targets: each takes any bytes, and must return. It panics where a result is wrong, such as a number that is
//! not finite, or an error without a message.
//!
//! A target returns a signature of what the bytes led to: the messages without their numbers and names. Bytes with a
//! new signature are worth keeping.

use std::cell::RefCell;
use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use adams::{AdamsModel, DataSet};
use formats::grid::file as grid_file;
use formats::scene::Document;
use formats::spec::{SolveError, Spec};
use formats::tables::{TableFormat, contents, expand, factor, is_tables, read, round, write};
use formats::text::diagnostic::Diagnostic;
use formats::text::source::Source;
use formats::units::{Force, Length, Units};
use foundations::{SolvedStructure, distinct_specs};
use import::{ImportOptions, import};
use splines::Rank;

use super::generate;

/// A target with its name, the beginnings of its corpus, and how long it takes.
#[derive(Clone, Copy)]
pub struct Target {
    /// Name, also of the file of a failure.
    pub name: &'static str,
    /// Executes the target and returns the signature of its result.
    pub run: fn(&[u8]) -> u64,
    /// Files of the repository with which the corpus begins, relative to its root; none for targets that generate
    /// their inputs from any bytes.
    pub seeds: &'static [&'static str],
}

/// All targets.
pub const TARGETS: &[Target] = &[
    Target {
        name: "spec",
        run: spec,
        seeds: &SPECS,
    },
    Target {
        name: "scene",
        run: scene,
        seeds: &SCENES,
    },
    Target {
        name: "design",
        run: design,
        seeds: &[
            "tests/malformed/base/design.json",
            "tests/fuzz/seeds/design.json",
            "tests/fuzz/seeds/runways_design.json",
        ],
    },
    Target {
        name: "grid",
        run: grid,
        seeds: &["tests/malformed/base/grid.json"],
    },
    Target {
        name: "tables_adm",
        run: tables_adm,
        seeds: &ADM,
    },
    Target {
        name: "tables_cmd",
        run: tables_cmd,
        seeds: &[],
    },
    Target {
        name: "tables_csv",
        run: tables_csv,
        seeds: &[],
    },
    Target {
        name: "tables_json",
        run: tables_json,
        seeds: &[],
    },
    Target {
        name: "tables_npz",
        run: tables_npz,
        seeds: &[],
    },
    Target {
        name: "arrays",
        run: arrays,
        seeds: &[],
    },
    Target {
        name: "deck",
        run: deck,
        seeds: &[
            "tests/fuzz/seeds/wheel.adm",
            "tests/fuzz/seeds/pendulum.adm",
        ],
    },
    Target {
        name: "nastran",
        run: nastran,
        seeds: &DECKS,
    },
    Target {
        name: "gmsh",
        run: gmsh,
        seeds: &MESHES,
    },
    Target {
        name: "abaqus",
        run: abaqus,
        seeds: &["tests/fuzz/seeds/frame.inp"],
    },
    Target {
        name: "sections",
        run: sections,
        seeds: &["tests/import/meshes/portal.json"],
    },
    Target {
        name: "solve",
        run: solve,
        seeds: &[
            "tests/malformed/base/spec.json",
            "tests/malformed/base/frame.json",
        ],
    },
    Target {
        name: "generated_spec",
        run: generated_spec,
        seeds: &[],
    },
    Target {
        name: "generated_scene",
        run: generated_scene,
        seeds: &[],
    },
];

const SPECS: [&str; 5] = [
    "tests/malformed/base/spec.json",
    "tests/malformed/base/frame.json",
    "examples/wheel/spec.json",
    "examples/bridge_crane/girders.json",
    "tests/deck/scenes/floor.json",
];

const SCENES: [&str; 6] = [
    "tests/malformed/base/scene.json",
    "examples/wheel/scene.json",
    "examples/bogie/scene.json",
    "examples/ties/scene.json",
    "examples/bridge_crane/scene.json",
    "examples/bridge_crane/lifting.json",
];

const ADM: [&str; 2] = [
    "tests/malformed/base/tables.adm",
    "examples/bogie/printed.adm",
];

const DECKS: [&str; 4] = [
    "tests/malformed/base/deck.bdf",
    "tests/import/decks/mill_small.bdf",
    "tests/import/decks/offset.bdf",
    "tests/import/decks/pinned.bdf",
];

const MESHES: [&str; 5] = [
    "tests/malformed/base/mesh.msh",
    "tests/import/meshes/portal.msh",
    "tests/import/meshes/portal_22.msh",
    "tests/import/meshes/portal_binary.msh",
    "tests/import/meshes/portal_22_binary.msh",
];

/// Unknowns of the largest structure that is solved, in members and stations.
const MEMBERS: usize = 60;
const STATIONS: usize = 40;
/// Wheels of all cases of the largest design that is calculated.
const LOADED_WHEELS: usize = 12;

/// The root of the repository.
pub fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let found = own
        .ancestors()
        .find(|folder| folder.join("examples").is_dir() && folder.join("crates").is_dir());
    found
        .expect("this crate is in the repository")
        .to_path_buf()
}

/// The signature of messages: their words, without numbers and quoted text.
fn signature<'m>(messages: impl IntoIterator<Item = &'m str>) -> u64 {
    let mut hasher = DefaultHasher::new();
    for message in messages {
        for (index, part) in message.split(['"', '`']).enumerate() {
            if index % 2 == 0 {
                part.split(|c: char| c.is_ascii_digit())
                    .for_each(|part| part.hash(&mut hasher));
            }
        }
    }
    hasher.finish()
}

/// Checks that there are errors, that each has a message and a place within the text, and that none shows a number
/// that is not finite. Returns their signature.
fn refused(wrong: &[Diagnostic], text: Option<&[u8]>) -> u64 {
    assert!(!wrong.is_empty(), "an error without a message");
    for one in wrong {
        assert!(!one.expected.is_empty() && !one.file.is_empty(), "{one}");
        if let (Some(line), Some(text)) = (one.line, text) {
            let lines = text.iter().filter(|byte| **byte == b'\n').count() + 1;
            assert!(
                (1..=lines + 1).contains(&line),
                "{one}: the text has {lines} lines"
            );
        }
    }
    signature(wrong.iter().map(|one| one.expected.as_str()))
}

fn source(name: &str, bytes: &[u8]) -> Result<Source, u64> {
    Source::from_bytes(name, bytes.to_vec()).map_err(|wrong| refused(&[*wrong], None))
}

fn spec(bytes: &[u8]) -> u64 {
    let source = match source("spec.json", bytes) {
        Ok(source) => source,
        Err(told) => return told,
    };
    match Spec::read(&source, None) {
        Ok(spec) => spec.rails().len() as u64,
        Err(wrong) => refused(&wrong, Some(bytes)),
    }
}

thread_local! {
    static FOLDER: RefCell<Option<tempfile::TempDir>> = const { RefCell::new(None) };
}

/// The path of a file in a folder of this thread that also has the files to which scenes refer.
fn file_beside_others(name: &str) -> PathBuf {
    FOLDER.with_borrow_mut(|folder| {
        let folder = folder.get_or_insert_with(|| {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let mut others: Vec<PathBuf> = ["spec.json", "frame.json", "grid.json", "tables.adm"]
                .map(|name| root().join("tests/malformed/base").join(name))
                .to_vec();
            others.extend(
                ["aisle.json", "girders.json"]
                    .map(|name| root().join("examples/bridge_crane").join(name)),
            );
            others.push(root().join("examples/bogie/printed.adm"));
            others.push(root().join("tests/fuzz/seeds/runways.json"));
            for other in others {
                let name = other.file_name().expect("the name of a file");
                fs::copy(&other, folder.path().join(name)).expect("a writable folder");
            }
            folder
        });
        folder.path().join(name)
    })
}

fn opened(bytes: &[u8]) -> Result<Document, u64> {
    let path = file_beside_others("fuzzed.json");
    fs::write(&path, bytes).expect("a writable folder");
    Document::open(&path).map_err(|wrong| {
        let of_scene: Vec<Diagnostic> = wrong
            .iter()
            .filter(|one| one.file.ends_with("fuzzed.json"))
            .cloned()
            .collect();
        if of_scene.is_empty() {
            refused(&wrong, None)
        } else {
            refused(&of_scene, Some(bytes))
        }
    })
}

fn scene(bytes: &[u8]) -> u64 {
    match opened(bytes) {
        Ok(document) => document.cases.len() as u64,
        Err(told) => told,
    }
}

/// Reads a design and, where it is small, calculates it: every number of its files is finite.
fn design(bytes: &[u8]) -> u64 {
    let path = file_beside_others("fuzzed.json");
    fs::write(&path, bytes).expect("a writable folder");
    let (read, inputs) = match formats::design::Design::open(&path) {
        Ok(read) => read,
        Err(wrong) => {
            let own: Vec<Diagnostic> = wrong
                .iter()
                .filter(|one| one.file.ends_with("fuzzed.json"))
                .cloned()
                .collect();
            return if own.is_empty() {
                refused(&wrong, None)
            } else {
                refused(&own, Some(bytes))
            };
        }
    };
    let all = design::with_combinations(&read);
    let wheels: usize = all
        .cases
        .iter()
        .flat_map(|case| &case.trains)
        .map(|&train| all.trains[train].wheels.len())
        .sum();
    if wheels > LOADED_WHEELS {
        return wheels as u64;
    }
    match design::solve(&all, &inputs) {
        Ok(result) => {
            let lines = design::governing_lines(&all, &inputs, &result)
                .expect("the structure was solved before");
            let page =
                report::text::design_report::design_report(&all, &result, &lines).html(Some(1));
            assert!(page.is_ok(), "{page:?}");
            let tables = [
                design::envelope_csv(&all, &result),
                design::reactions_csv(&result),
                design::influence_csv(&all, &lines),
            ];
            for table in tables {
                let text = table.expect("the table is finite");
                assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
            }
            let used = result
                .stresses
                .iter()
                .map(|stress| stress.utilisation() + stress.bound.unwrap_or(0.0));
            let local = result
                .wheel_stresses
                .iter()
                .map(|wheel| wheel.vertical + wheel.total_shear());
            let moved = result.pairs.iter().map(|pair| pair.value);
            assert!(
                used.chain(local).chain(moved).all(f64::is_finite),
                "a detail that is not finite"
            );
            result.cases.len() as u64
        }
        Err(SolveError::Input(wrong)) => refused(&wrong, None),
        Err(SolveError::NoSolution(why)) => signature([why.as_str()]),
    }
}

fn grid(bytes: &[u8]) -> u64 {
    let source = match source("grid.json", bytes) {
        Ok(source) => source,
        Err(told) => return told,
    };
    match grid_file::read(&source) {
        Ok((grid, surface)) => {
            let finite = grid
                .blocks
                .iter()
                .all(|(_, block)| block.iter().all(|value| value.is_finite()));
            assert!(finite, "a grid with a number that is not finite");
            let text = grid_file::write(&grid, surface.as_ref());
            let again = grid_file::read(&Source {
                name: "grid.json".to_owned(),
                text,
            });
            assert!(
                again.is_ok(),
                "a grid that is written is refused: {again:?}"
            );
            grid.blocks.len() as u64
        }
        Err(wrong) => refused(&wrong, Some(bytes)),
    }
}

fn tables(name: &str, bytes: &[u8]) -> u64 {
    let _ = is_tables(name, bytes);
    if let Err(wrong) = contents(name, bytes) {
        return refused(&wrong, None);
    }
    let units = Units {
        length: Length::Foot,
        force: Force::Pound,
    };
    let set = match read(name, bytes, Some(units)) {
        Ok(set) => set,
        Err(wrong) => return refused(&wrong, None),
    };
    let finite = |set: &formats::tables::TableSet| {
        set.tables.iter().all(|table| {
            table
                .curves
                .y()
                .iter()
                .flatten()
                .all(|value| value.is_finite())
        })
    };
    assert!(finite(&set), "a table with a number that is not finite");
    let _ =
        round(&set, 3).map(|(set, _)| assert!(finite(&set), "a rounded table that is not finite"));
    assert!(
        finite(&expand(&set)),
        "an expanded table that is not finite"
    );
    if set
        .tables
        .iter()
        .all(|table| table.curves.y().len() <= STATIONS)
    {
        let _ = factor(&set, Rank::Count(2));
    }
    for ending in ["adm", "cmd", "csv", "json", "npz"] {
        let format = TableFormat::of(&format!("a.{ending}")).expect("a format of the program");
        let _ = write(&set, format);
    }
    set.tables.len() as u64
}

fn tables_adm(bytes: &[u8]) -> u64 {
    tables("a.adm", bytes)
}

fn tables_cmd(bytes: &[u8]) -> u64 {
    tables("a.cmd", bytes)
}

fn tables_csv(bytes: &[u8]) -> u64 {
    tables("a.csv", bytes)
}

fn tables_json(bytes: &[u8]) -> u64 {
    tables("a.json", bytes)
}

fn tables_npz(bytes: &[u8]) -> u64 {
    tables("a.npz", bytes)
}

/// Arrays of numpy as members of an archive that is right. An archive with random damage is refused by its checksums,
/// so that its arrays are never read.
fn arrays(bytes: &[u8]) -> u64 {
    tables("a.npz", &packed(bytes))
}

/// The archive of members that are each written as their name, a line feed, four bytes of length, and contents.
fn packed(mut bytes: &[u8]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(io::Cursor::new(Vec::new()));
    let options =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    while let Some(end) = bytes.iter().position(|byte| *byte == b'\n') {
        let (name, rest) = bytes.split_at(end);
        let Some((length, rest)) = rest[1..].split_at_checked(4) else {
            break;
        };
        let length = length
            .iter()
            .fold(0, |sum, byte| 256 * sum + usize::from(*byte));
        let (contents, rest) = rest.split_at(length.min(rest.len()));
        bytes = rest;
        // a name that occurs twice is left out
        if archive
            .start_file(String::from_utf8_lossy(name), options)
            .is_ok()
        {
            archive.write_all(contents).expect("memory");
        }
    }
    archive
        .finish()
        .map(io::Cursor::into_inner)
        .unwrap_or_default()
}

/// Reads a data set, resolves it, and executes it: the forces at its initial state and its equilibrium.
fn deck(bytes: &[u8]) -> u64 {
    let text = String::from_utf8_lossy(bytes);
    let told = |error: adams::Error| signature([error.to_string().as_str()]);
    let set = match DataSet::read(&text) {
        Ok(set) => set,
        Err(error) => return told(error),
    };
    let model = match AdamsModel::new(&set) {
        Ok(model) => model,
        Err(error) => return told(error),
    };
    let state = model.initial();
    let solution = match model.solve(&state) {
        Ok(solution) => solution,
        Err(error) => return told(error),
    };
    let values = solution
        .variables
        .values()
        .chain(solution.rates.values())
        .copied();
    let loads = solution.loads.values().flat_map(|load| load.components);
    assert!(
        values.chain(loads).all(f64::is_finite),
        "a value or load that is not finite"
    );
    if set.statements.len() > MEMBERS {
        return 1;
    }
    match model.equilibrium(0.0, &state) {
        Ok(rest) => {
            let finite = rest.state.parts.values().all(|part| {
                [part.origin.x, part.origin.y, part.origin.z]
                    .iter()
                    .all(|value| value.is_finite())
            });
            assert!(finite, "an equilibrium that is not finite");
            2
        }
        Err(error) => told(error),
    }
}

fn imported(name: &str, bytes: &[u8], options: &ImportOptions) -> u64 {
    let open = |path: &Path| {
        if path == Path::new(name) {
            Ok(bytes.to_vec())
        } else {
            Err(io::ErrorKind::NotFound.into())
        }
    };
    match import(Path::new(name), &open, options) {
        Ok(imported) => {
            let source = Source {
                name: "spec.json".to_owned(),
                text: imported.text,
            };
            match Spec::read(&source, None) {
                Ok(_) => signature(imported.warnings.iter().map(|one| one.expected.as_str())),
                Err(wrong) => {
                    let rails_alone = wrong.iter().all(|wrong| wrong.path == "rails");
                    assert!(rails_alone, "an imported spec is refused: {}", wrong[0]);
                    3
                }
            }
        }
        Err(wrong) => {
            let unforeseen = wrong.iter().find(|one| one.file.contains("as a beam spec"));
            assert!(
                unforeseen.is_none(),
                "the importer did not foresee: {unforeseen:?}"
            );
            refused(&wrong, None)
        }
    }
}

fn nastran(bytes: &[u8]) -> u64 {
    let options = ImportOptions {
        length: Some(Length::Metre),
        force: Some(Force::Newton),
        ..ImportOptions::default()
    };
    imported("deck.bdf", bytes, &options)
}

fn abaqus(bytes: &[u8]) -> u64 {
    let options = ImportOptions {
        length: Some(Length::Metre),
        force: Some(Force::Newton),
        ..ImportOptions::default()
    };
    imported("model.inp", bytes, &options)
}

fn gmsh(bytes: &[u8]) -> u64 {
    let sections = fs::read_to_string(root().join("tests/import/meshes/portal.json"))
        .expect("a file of the tests");
    let options = ImportOptions {
        length: Some(Length::Millimetre),
        up: Some([0.0, 0.0, 1.0]),
        sections: Some(Source {
            name: "sections.json".to_owned(),
            text: sections,
        }),
        ..ImportOptions::default()
    };
    imported("mesh.msh", bytes, &options)
}

fn sections(bytes: &[u8]) -> u64 {
    let source = match source("sections.json", bytes) {
        Ok(source) => source,
        Err(told) => return told,
    };
    match formats::spec::SectionFile::read(&source) {
        Ok(sections) => sections.groups.len() as u64,
        Err(wrong) => refused(&wrong, Some(bytes)),
    }
}

/// Solves a structure that is small; checks that grid and certificate are finite and the direct blocks symmetric.
fn solved(name: &str, text: &str) -> u64 {
    let source = Source {
        name: name.to_owned(),
        text: text.to_owned(),
    };
    let spec = match Spec::read(&source, None) {
        Ok(spec) => spec,
        Err(wrong) => return refused(&wrong, Some(text.as_bytes())),
    };
    let stations: usize = spec.rails().iter().map(|rail| rail.stations.len()).sum();
    let model = match spec.model() {
        Ok((model, _)) => model,
        Err(error) => {
            return signature([format!("{:?}", spec.locate_error(&source, &error)).as_str()]);
        }
    };
    if stations > STATIONS || model.members.len() > MEMBERS {
        return 0;
    }
    match foundations::solve(&spec) {
        Ok(solved) => {
            for (_, block) in &solved.grid.blocks {
                assert!(
                    block.iter().all(|value| value.is_finite()),
                    "a grid that is not finite: {text}"
                );
            }
            if let Some(certificate) = solved.grid.certificate {
                let finite =
                    certificate.error_bound.is_finite() && certificate.condition.is_finite();
                assert!(finite, "a certificate that is not finite: {text}");
            }
            if solved.grid.blocks.is_empty() {
                // the command `fea` refuses a structure that nothing stiffens in any direction of its rails
                return 2;
            }
            let written = grid_file::write(&solved.grid, solved.surface.as_ref());
            let read = grid_file::read(&Source {
                name: "grid.json".to_owned(),
                text: written,
            });
            assert!(
                read.is_ok(),
                "its grid is refused: {:?}: {text}",
                read.err()
            );
            1
        }
        Err(error) => {
            let told = format!("{:?}", spec.locate_error(&source, &error));
            assert!(!told.contains("NaN"), "{told}: {text}");
            signature([error.to_string().as_str()])
        }
    }
}

fn solve(bytes: &[u8]) -> u64 {
    match std::str::from_utf8(bytes) {
        Ok(text) => solved("spec.json", text),
        Err(_) => 0,
    }
}

fn generated_spec(bytes: &[u8]) -> u64 {
    solved("spec.json", &generate::spec(bytes))
}

/// Runs a generated scene from its files to its columns. Every number of a history must be finite.
fn generated_scene(bytes: &[u8]) -> u64 {
    let (spec, scene) = generate::scene(bytes);
    fs::write(file_beside_others("generated.json"), &spec).expect("a writable folder");
    let document = match opened(scene.as_bytes()) {
        Ok(document) => document,
        Err(told) => return told,
    };
    let before = results::preflight::check(&document);
    let mut known = Vec::new();
    for (_, _, spec) in distinct_specs(&document) {
        match foundations::solve(spec) {
            Ok(solution) => known.push(SolvedStructure {
                spec: Arc::clone(spec),
                solution: Arc::new(solution),
            }),
            Err(error) => return signature([error.to_string().as_str()]),
        }
    }
    match results::cases::simulate(&document, &known, Some(1), &|_| ()) {
        Ok(cases) => {
            assert!(
                before.is_ok(),
                "refused before the run, which succeeds: {before:?}: {scene}\n{spec}"
            );
            for case in &cases {
                let finite = case
                    .columns
                    .columns
                    .iter()
                    .all(|one| one.values.iter().all(|value| value.is_finite()));
                assert!(finite, "a history that is not finite: {scene}\n{spec}");
            }
            signature(
                cases
                    .iter()
                    .map(|case| results::run_error::status(&case.run.status).0),
            )
        }
        Err(error) => {
            // everything else is known before the run
            let told = error.to_string();
            assert!(
                told.contains("no static equilibrium"),
                "{told}: {scene}\n{spec}"
            );
            signature([told.as_str()])
        }
    }
}
