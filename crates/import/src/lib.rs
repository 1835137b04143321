//! Import of models of other programs as beam specs.
//!
//! [`bdf`] reads NASTRAN bulk data, [`inp`] Abaqus input files, and [`msh`] meshes of gmsh. Each returns a
//! [`structure::ImportedStructure`], from which [`write()`] produces the text of a spec. [`import`] performs all of these steps.
//!
//! # Example
//! ```
//! use std::path::Path;
//!
//! use formats::units::{Force, Length};
//! use import::{ImportOptions, import};
//!
//! // a beam of one element, pinned at its left end
//! let deck = "BEGIN BULK\nGRID,1,,0.,0.,0.,,1234\nGRID,2,,6.,0.,0.,,23\nCBAR,7,3,1,2,0.,0.,1.\n\
//!             PBAR,3,4,0.01,1.E-4,2.E-5,1.E-6\nMAT1,4,2.1E11,,0.3\nENDDATA\n";
//! let open = |_: &Path| Ok(deck.as_bytes().to_vec());
//! let options = ImportOptions {
//!     length: Some(Length::Metre),
//!     force: Some(Force::Newton),
//!     up: Some([0.0, 0.0, 1.0]),
//!     rails: vec!["runway=7".parse().expect("a rail along element 7")],
//!     ..ImportOptions::default()
//! };
//! let model = import(Path::new("beam.bdf"), &open, &options).expect("a model without errors");
//! assert_eq!(model.structure.members.len(), 1);
//! assert_eq!(model.structure.rails[0].stations, [0.0, 6.0]);
//! assert!(model.text.contains("\"PBAR 3\""));
//! ```
//!
//! Wings, lowest first: findings, axes, structure, halves, links, rail, fix, write, frequencies, includes, msh, bdf, inp

mod axes;
pub mod bdf;
pub mod findings;
pub mod fix;
mod frequencies;
mod halves;
mod includes;
pub mod inp;
mod links;
pub mod msh;
pub mod rail;
pub mod structure;
mod write;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use includes::OpenFile;
pub use write::{PARTS, write};

use crate::findings::ImportFindings;
use crate::frequencies::lowest_frequency;
use crate::structure::ImportedStructure;
use formats::spec::{SECTIONS_FORMAT, SectionFile, Spec, stem};
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::read_error_message;
use formats::text::number::{number, rounded};
use formats::text::source::{Source, without_mark};
use formats::units::{Dimension, Force, Length, Scale, Units};

/// Properties of a model that the user specifies because its file does not contain them.
#[derive(Clone, Debug, Default)]
pub struct ImportOptions {
    /// Its unit of length.
    pub length: Option<Length>,
    /// Its unit of force.
    pub force: Option<Force>,
    /// Upward direction in the axes of the model.
    pub up: Option<[f64; 3]>,
    /// Rails along its members.
    pub rails: Vec<rail::RailRequest>,
    /// Supports at its sets of points.
    pub fix: Vec<fix::SupportRequest>,
    /// The sections file that a mesh requires.
    pub sections: Option<Source>,
    /// The SPC set of a deck that supports the structure.
    pub spc: Option<u64>,
    /// Names of the cards of a deck that are ignored.
    pub skip: Vec<String>,
    /// Whether what cannot change the stiffness of the structure is left out of a deck.
    pub skip_unused: bool,
    /// Where the mass of members acts; `None` means as the deck states.
    pub mass: Option<structure::MassDistribution>,
}

/// A model converted to a beam spec, with warnings.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The text of the beam spec.
    pub text: String,
    /// The structure from which the text was written.
    pub structure: ImportedStructure,
    /// Warnings about parts of the model that were ignored or changed.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a model and converts it to a beam spec. The file extension determines the format: `.bdf`, `.dat`, `.nas` and
/// `.fem` are NASTRAN bulk data, `.msh` is a gmsh mesh, `.inp` an Abaqus input file (or bulk data, if it has a line BEGIN
/// BULK). `open` reads the file and those that it includes; a byte order mark at the beginning of a file is skipped.
///
/// # Errors
/// All errors of the model, with their positions. A model with errors is rejected as a whole.
pub fn import(
    path: &Path,
    open: OpenFile<'_>,
    options: &ImportOptions,
) -> Result<Imported, Vec<Diagnostic>> {
    let name = path.display().to_string();
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    // each file is read once, since a pipe cannot be read again
    let read: RefCell<BTreeMap<PathBuf, Vec<u8>>> = RefCell::default();
    let open: OpenFile<'_> = &|file: &Path| {
        if let Some(bytes) = read.borrow().get(file) {
            return Ok(bytes.clone());
        }
        let bytes = without_mark(&open(file)?).to_vec();
        read.borrow_mut().insert(file.to_path_buf(), bytes.clone());
        Ok(bytes)
    };
    let mut findings = ImportFindings::default();
    let mut structure = match ending.as_str() {
        "bdf" | "dat" | "nas" | "fem" => read_deck(path, open, options, &mut findings)?,
        "msh" => read_mesh(path, open, options, &mut findings)?,
        "inp" => {
            let bytes = open(path).map_err(|error| unreadable(path, &error))?;
            if is_bulk_data(&bytes) {
                read_deck(path, open, options, &mut findings)?
            } else {
                read_input(path, open, options, &mut findings)?
            }
        }
        _ => {
            if path.is_dir() {
                return Err(vec![Diagnostic::of_file(
                    name,
                    "cannot be read: it is a folder",
                )]);
            }
            let wrong = Diagnostic::of_file(
                name,
                "the extension of the file is not that of a known format",
            );
            let hint =
                "use .bdf, .dat, .nas or .fem (NASTRAN bulk data), .msh (gmsh) or .inp (Abaqus)";
            return Err(vec![wrong.hint(hint)]);
        }
    };
    if findings.has_errors() {
        return Err(findings.errors());
    }
    structure.up = options.up;
    add_requested(options, &mut structure)?;
    let mut warnings = findings.warnings();
    if structure.rails.is_empty() {
        let missing = Diagnostic::of_file(
            &name,
            "the spec has no rail, and cannot be solved without one",
        );
        warnings.push(
            missing.hint("add --rail NAME=ELEMENTS and --up X,Y,Z, or write `rails` into the spec"),
        );
    }
    let text = write(&structure);
    check_spec(&name, &text, &structure)?;
    if structure.moves_mass {
        warnings.push(moved_mass(path, open, options, &structure));
    }
    Ok(Imported {
        text,
        structure,
        warnings,
    })
}

/// The warning that the mass of beams does not act where that of the deck does, with the natural frequencies of both.
fn moved_mass(
    path: &Path,
    open: OpenFile<'_>,
    options: &ImportOptions,
    structure: &ImportedStructure,
) -> Diagnostic {
    let lumped = ImportOptions {
        mass: Some(structure::MassDistribution::Lumped),
        ..options.clone()
    };
    let of_deck = read_deck(path, open, &lumped, &mut ImportFindings::default());
    let of_deck = of_deck.ok().and_then(|mut own| {
        // the members and points are the same
        own.up = structure.up;
        own.supports.clone_from(&structure.supports);
        own.rails.clone_from(&structure.rails);
        lowest_frequency(&own)
    });
    let mut message =
        "the mass of beams acts along them, that of the deck at their ends".to_owned();
    if let (Some(own), Some(of_deck)) = (lowest_frequency(structure), of_deck) {
        let hertz = |frequency: f64| number(rounded(frequency, 4));
        message += &format!(
            ": the lowest natural frequency is {} Hz, with the masses of the deck {} Hz",
            hertz(own),
            hertz(of_deck)
        );
    }
    let hint = "use --mass lumped for the masses of the deck; the beams then have no weight between their ends";
    Diagnostic::of_file(path.display().to_string(), message).hint(hint)
}

/// Adds the supports and rails that the user requested.
fn add_requested(
    options: &ImportOptions,
    structure: &mut ImportedStructure,
) -> Result<(), Vec<Diagnostic>> {
    let mut wrong = Vec::new();
    for asked in &options.fix {
        wrong.extend(
            fix::restrain(asked, structure)
                .err()
                .map(|message| refused("--fix", message)),
        );
    }
    for asked in &options.rails {
        let Some(up) = options.up else {
            let message = [
                "requires --up, because the model does not define the upward direction".to_owned(),
                "add --up 0,0,1 or --up 0,1,0".to_owned(),
            ];
            wrong.push(refused("--rail", message));
            break;
        };
        match rail::rail_along_members(asked, up, structure) {
            Ok(rail) if structure.rails.iter().any(|other| other.name == rail.name) => {
                wrong.push(refused(
                    "--rail",
                    [
                        format!("defines two rails with the name {}", rail.name),
                        String::new(),
                    ],
                ));
            }
            Ok(rail) => structure.rails.push(rail),
            Err(message) => wrong.push(refused("--rail", message)),
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong) }
}

/// Creates the error of a flag of the command line from a message and a hint.
fn refused(flag: &str, [expected, hint]: [String; 2]) -> Diagnostic {
    let wrong = Diagnostic::of_file("command line", format!("{flag} {expected}"));
    if hint.is_empty() {
        wrong
    } else {
        wrong.hint(hint)
    }
}

/// Checks that the text is a valid beam spec. A spec without rails is accepted if no rail was requested.
fn check_spec(
    name: &str,
    text: &str,
    structure: &ImportedStructure,
) -> Result<(), Vec<Diagnostic>> {
    let source = Source {
        name: format!("{name}, as a beam spec"),
        text: text.to_owned(),
    };
    let Err(mut wrong) = Spec::read(&source, None) else {
        return Ok(());
    };
    wrong.retain(|wrong| wrong.path != "rails" || !structure.rails.is_empty());
    if wrong.is_empty() { Ok(()) } else { Err(wrong) }
}

/// Creates the error of a file that cannot be read.
fn unreadable(path: &Path, error: &std::io::Error) -> Vec<Diagnostic> {
    vec![Diagnostic::of_file(
        path.display().to_string(),
        read_error_message(error),
    )]
}

/// Whether a file with the ending `.inp` is NASTRAN bulk data: a line consists of BEGIN BULK.
fn is_bulk_data(bytes: &[u8]) -> bool {
    let begins = |line: &[u8]| {
        let words: Vec<&[u8]> = line
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty())
            .take(2)
            .collect();
        matches!(words.as_slice(), [a, b] if a.eq_ignore_ascii_case(b"BEGIN") && b.eq_ignore_ascii_case(b"BULK"))
    };
    bytes.split(|byte| *byte == b'\n').any(begins)
}

/// Errors of the given flags, none of which applies to the format of the model.
fn not_available(flags: &[(&str, bool)]) -> Vec<Diagnostic> {
    let given = flags.iter().filter(|(_, given)| *given);
    given
        .map(|(flag, _)| {
            refused(
                flag,
                [
                    "is not available for this file format".to_owned(),
                    String::new(),
                ],
            )
        })
        .collect()
}

/// Reads an Abaqus input file; the options specify the units, or the unit of length and a sections file for a file
/// without sections.
fn read_input(
    path: &Path,
    open: OpenFile<'_>,
    options: &ImportOptions,
    findings: &mut ImportFindings,
) -> Result<ImportedStructure, Vec<Diagnostic>> {
    let name = path.display().to_string();
    let mut wrong = Vec::new();
    let given = [
        ("--spc", options.spc.is_some()),
        ("--mass", options.mass.is_some()),
    ];
    wrong.extend(not_available(&given));
    if options.sections.is_some() && options.force.is_some() {
        let message =
            "is not available with --sections, whose file specifies the unit of force".to_owned();
        wrong.push(refused("--force", [message, String::new()]));
    }
    if options.length.is_none() || (options.force.is_none() && options.sections.is_none()) {
        let expected =
            "Abaqus input files contain no units: specify them with --length and --force";
        let hint = "such as --length m --force N; a file without sections requires --sections instead of --force";
        wrong.push(Diagnostic::of_file(&name, expected).hint(hint));
    }
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let omit = bdf::Omissions {
        skip: &options.skip,
        unused: options.skip_unused,
    };
    let length = options.length.unwrap_or(Length::Metre);
    let result = match (&options.sections, options.force) {
        (Some(source), _) => {
            let sections = SectionFile::read(source)?;
            let to = sections.units;
            let factor = Scale {
                from: Units { length, ..to },
                to,
            }
            .factor(Dimension::LENGTH);
            let mut empty = ImportedStructure::empty(stem(&name), to);
            empty.up = options.up;
            inp::read_mesh(path, open, factor, &sections, empty, omit, findings)
        }
        (None, force) => {
            let units = Units {
                length,
                force: force.unwrap_or(Force::Newton),
            };
            inp::read(
                path,
                open,
                ImportedStructure::empty(stem(&name), units),
                omit,
                findings,
            )
        }
    };
    result.map_err(|error| unreadable(path, &error))
}

/// Reads NASTRAN bulk data; the options specify the units.
fn read_deck(
    path: &Path,
    open: OpenFile<'_>,
    options: &ImportOptions,
    findings: &mut ImportFindings,
) -> Result<ImportedStructure, Vec<Diagnostic>> {
    let name = path.display().to_string();
    let (Some(length), Some(force)) = (options.length, options.force) else {
        let wrong = Diagnostic::of_file(
            name,
            "bulk data contain no units: specify them with --length and --force",
        );
        return Err(vec![wrong.hint(
            "such as --length m --force N; the unit of mass, after scaling by WTMASS, is force s^2 / length",
        )]);
    };
    if options.sections.is_some() {
        let wrong = refused(
            "--sections",
            [
                "is not available for bulk data, which contain their own sections".to_owned(),
                String::new(),
            ],
        );
        return Err(vec![wrong]);
    }
    let empty = ImportedStructure::empty(stem(&name), Units { length, force });
    let omit = bdf::Omissions {
        skip: &options.skip,
        unused: options.skip_unused,
    };
    bdf::read(path, open, empty, options.spc, omit, options.mass, findings)
        .map_err(|error| unreadable(path, &error))
}

/// Reads a gmsh mesh; the options specify the unit of its coordinates, the sections file all other units.
fn read_mesh(
    path: &Path,
    open: OpenFile<'_>,
    options: &ImportOptions,
    findings: &mut ImportFindings,
) -> Result<ImportedStructure, Vec<Diagnostic>> {
    let name = path.display().to_string();
    let mut wrong = Vec::new();
    if options.length.is_none() {
        let missing = Diagnostic::of_file(
            &name,
            "a mesh contains no units: specify that of its coordinates with --length",
        );
        wrong.push(missing.hint("such as --length mm"));
    }
    if options.sections.is_none() {
        let missing = Diagnostic::of_file(
            &name,
            "a mesh contains no sections: specify a file that defines them with --sections",
        );
        let hint = format!(
            "a JSON file of format {} with units, materials, and sections named after the physical groups",
            SECTIONS_FORMAT
        );
        wrong.push(missing.hint(hint));
    }
    let given = [
        ("--spc", options.spc.is_some()),
        ("--skip", !options.skip.is_empty()),
        ("--skip-unused", options.skip_unused),
        ("--mass", options.mass.is_some()),
        ("--force", options.force.is_some()),
    ];
    wrong.extend(not_available(&given));
    let (Some(length), Some(source)) = (options.length, &options.sections) else {
        return Err(wrong);
    };
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let sections = SectionFile::read(source)?;
    let bytes = open(path).map_err(|error| unreadable(path, &error))?;
    findings.files.push(name.clone());
    let to = sections.units;
    let factor = Scale {
        from: Units { length, ..to },
        to,
    }
    .factor(Dimension::LENGTH);
    let mut empty = ImportedStructure::empty(stem(&name), to);
    empty.up = options.up;
    Ok(msh::read(&bytes, factor, &sections, empty, findings))
}
