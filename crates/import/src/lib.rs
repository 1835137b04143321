//! Models of other programs as beam specs.
//!
//! [`bdf`] reads NASTRAN bulk data, [`msh`] meshes of gmsh; both give a [`structure::Structure`], which [`write()`]
//! turns into the text of a spec.
//!
//! Wings, lowest first: findings, structure, rail, fix, msh, bdf, write

pub mod bdf;
pub mod findings;
pub mod fix;
pub mod msh;
pub mod rail;
pub mod structure;
mod write;

use std::path::Path;

pub use write::{PARTS, write};

use crate::findings::ImportFindings;
use crate::structure::ImportedStructure;
use formats::diagnostic::Diagnostic;
use formats::inputs::cannot_read;
use formats::source::Source;
use formats::spec::{Spec, stem};
use formats::units::{Dimension, Force, Length, Scale, Units};

/// What a user says about a model, because its file does not.
#[derive(Clone, Debug, Default)]
pub struct ImportOptions {
    /// Its unit of length.
    pub length: Option<Length>,
    /// Its unit of force.
    pub force: Option<Force>,
    /// Direction up.
    pub up: Option<[f64; 3]>,
    /// Rails on its members.
    pub rails: Vec<rail::RailRequest>,
    /// Supports of its sets of points.
    pub fix: Vec<fix::SupportRequest>,
    /// The sections file of a mesh, and its bytes.
    pub sections: Option<Source>,
    /// The set of supports of a deck.
    pub spc: Option<u64>,
    /// Cards of a deck to leave out.
    pub skip: Vec<String>,
}

/// A model as the text of a beam spec, and what is to be said of it.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The beam spec.
    pub text: String,
    /// What it was made of.
    pub structure: ImportedStructure,
    /// What was left out or taken in another way.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a model, in the format of its file's ending.
///
/// # Errors
/// Everything that is wrong with it, placed; then nothing is taken.
pub fn import(
    path: &Path,
    open: bdf::Open<'_>,
    options: &ImportOptions,
) -> Result<Imported, Vec<Diagnostic>> {
    let name = path.display().to_string();
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let mesh = match ending.as_str() {
        "bdf" | "dat" | "nas" => false,
        "msh" => true,
        _ => {
            let wrong = Diagnostic::of_file(name, "the ending says no format");
            return Err(vec![wrong.hint("use .bdf, .dat or .nas (NASTRAN bulk data) or .msh (gmsh)")]);
        }
    };
    let mut findings = ImportFindings::default();
    let mut structure = if mesh {
        read_mesh(path, open, options, &mut findings)?
    } else {
        read_deck(path, open, options, &mut findings)?
    };
    if findings.wrong() {
        return Err(findings.errors());
    }
    structure.up = options.up;
    let mut wrong = Vec::new();
    for asked in &options.fix {
        wrong.extend(fix::hold(asked, &mut structure).err().map(|told| refused("--fix", told)));
    }
    for asked in &options.rails {
        let Some(up) = options.up else {
            let told = [
                "needs --up: a rail has a direction up, and the model has none".to_owned(),
                "add --up 0,0,1 or --up 0,1,0".to_owned(),
            ];
            wrong.push(refused("--rail", told));
            break;
        };
        match rail::lay(asked, up, &structure) {
            Ok(rail) if structure.rails.iter().any(|other| other.name == rail.name) => {
                wrong.push(refused(
                    "--rail",
                    [format!("gives two rails the name {}", rail.name), String::new()],
                ));
            }
            Ok(rail) => structure.rails.push(rail),
            Err(told) => wrong.push(refused("--rail", told)),
        }
    }
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let mut warnings = findings.warnings();
    if structure.rails.is_empty() {
        let told = Diagnostic::of_file(&name, "the spec has no rail, and cannot be solved without one");
        warnings.push(told.hint("add --rail NAME=ELEMENTS and --up X,Y,Z, or write `rails` into the spec"));
    }
    let text = write(&structure);
    sound(&name, &text, &structure)?;
    Ok(Imported { text, structure, warnings })
}

fn refused(flag: &str, [expected, hint]: [String; 2]) -> Diagnostic {
    let wrong = Diagnostic::of_file("command line", format!("{flag} {expected}"));
    if hint.is_empty() { wrong } else { wrong.hint(hint) }
}

/// What the reader of beam specs says of the text, but for rails that nobody asked for.
fn sound(name: &str, text: &str, structure: &ImportedStructure) -> Result<(), Vec<Diagnostic>> {
    let source = Source { name: format!("{name}, as a beam spec"), text: text.to_owned() };
    let Err(mut wrong) = Spec::read(&source, None) else { return Ok(()) };
    wrong.retain(|wrong| wrong.path != "rails" || !structure.rails.is_empty());
    if wrong.is_empty() { Ok(()) } else { Err(wrong) }
}

fn unread(path: &Path, error: &std::io::Error) -> Vec<Diagnostic> {
    vec![Diagnostic::of_file(path.display().to_string(), cannot_read(error))]
}

fn read_deck(
    path: &Path,
    open: bdf::Open<'_>,
    options: &ImportOptions,
    findings: &mut ImportFindings,
) -> Result<ImportedStructure, Vec<Diagnostic>> {
    let name = path.display().to_string();
    let (Some(length), Some(force)) = (options.length, options.force) else {
        let wrong = Diagnostic::of_file(name, "bulk data have no units: --length and --force must say them");
        return Err(vec![
            wrong.hint("such as --length m --force N; masses are force s^2 / length after WTMASS"),
        ]);
    };
    if options.sections.is_some() {
        let wrong = refused(
            "--sections",
            ["belongs to meshes: bulk data have their own sections".to_owned(), String::new()],
        );
        return Err(vec![wrong]);
    }
    let empty = ImportedStructure::empty(stem(&name), Units { length, force });
    bdf::read(path, open, empty, options.spc, &options.skip, findings).map_err(|error| unread(path, &error))
}

fn read_mesh(
    path: &Path,
    open: bdf::Open<'_>,
    options: &ImportOptions,
    findings: &mut ImportFindings,
) -> Result<ImportedStructure, Vec<Diagnostic>> {
    let name = path.display().to_string();
    let mut wrong = Vec::new();
    if options.length.is_none() {
        let told =
            Diagnostic::of_file(&name, "a mesh has no units: --length must say that of its coordinates");
        wrong.push(told.hint("such as --length mm"));
    }
    if options.sections.is_none() {
        let told =
            Diagnostic::of_file(&name, "a mesh has no sections: --sections must name a file that has them");
        let hint = format!(
            "a JSON file of format {} with units, materials and sections by the names of the physical groups",
            msh::FORMAT
        );
        wrong.push(told.hint(hint));
    }
    let deck = [
        ("--spc", options.spc.is_some()),
        ("--skip", !options.skip.is_empty()),
        ("--force", options.force.is_some()),
    ];
    for (flag, _) in deck.into_iter().filter(|(_, given)| *given) {
        wrong.push(refused(flag, ["belongs to bulk data".to_owned(), String::new()]));
    }
    let (Some(length), Some(source)) = (options.length, &options.sections) else { return Err(wrong) };
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let sections = msh::Sections::read(source)?;
    let bytes = open(path).map_err(|error| unread(path, &error))?;
    findings.files.push(name.clone());
    let to = sections.units;
    let factor = Scale { from: Units { length, ..to }, to }.factor(Dimension::LENGTH);
    let mut empty = ImportedStructure::empty(stem(&name), to);
    empty.up = options.up;
    // a binary mesh is no text, and its first lines say so
    let text = String::from_utf8_lossy(&bytes);
    Ok(msh::read(&text, factor, &sections, empty, findings))
}
