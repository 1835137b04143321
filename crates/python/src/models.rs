//! Models of other programs.

use std::path::PathBuf;

use formats::text::inputs::{Inputs, read_file};
use formats::units::{Force, Length};
use import::structure::MassDistribution;
use import::{ImportOptions, import};
use pyo3::prelude::*;

use crate::errors::Refusal;

/// Reads a model of another program. Returns the text of a beam spec and warnings.
#[pyfunction]
#[pyo3(signature = (path, length, force, up, rails, fix, sections, spc, skip, skip_unused, mass))]
#[expect(
    clippy::too_many_arguments,
    reason = "the options of the command, each by its name"
)]
pub(crate) fn import_model(
    py: Python<'_>,
    path: PathBuf,
    length: Option<&str>,
    force: Option<&str>,
    up: Option<[f64; 3]>,
    rails: Vec<String>,
    fix: Vec<String>,
    sections: Option<PathBuf>,
    spc: Option<u64>,
    skip: Vec<String>,
    skip_unused: bool,
    mass: Option<&str>,
) -> PyResult<(String, Vec<String>)> {
    let read = || -> Result<(String, Vec<String>), Refusal> {
        let sections = match sections {
            Some(path) => Some(Inputs::open(&path)?.1),
            None => None,
        };
        let options = ImportOptions {
            length: word(
                "length",
                length,
                &Length::ALL.map(|unit| (unit.word(), unit)),
            )?,
            force: word(
                "force",
                force,
                &[Force::Pound, Force::Kip, Force::Newton, Force::Kilonewton]
                    .map(|unit| (unit.word(), unit)),
            )?,
            up,
            rails: parsed("rails", &rails)?,
            fix: parsed("fix", &fix)?,
            sections,
            spc,
            skip: skip
                .iter()
                .map(|name| name.trim().to_ascii_uppercase())
                .collect(),
            skip_unused,
            mass: word(
                "mass",
                mass,
                &[
                    ("lumped", MassDistribution::Lumped),
                    ("distributed", MassDistribution::Distributed),
                ],
            )?,
        };
        let imported = import(&path, &read_file, &options)?;
        Ok((
            imported.text,
            imported.warnings.iter().map(ToString::to_string).collect(),
        ))
    };
    py.detach(read).map_err(|refusal| refusal.exception(py))
}

/// The value of a word.
fn word<T: Copy>(
    name: &str,
    given: Option<&str>,
    known: &[(&str, T)],
) -> Result<Option<T>, Refusal> {
    let Some(given) = given else { return Ok(None) };
    match known.iter().find(|(word, _)| *word == given) {
        Some((_, value)) => Ok(Some(*value)),
        None => {
            let words: Vec<&str> = known.iter().map(|(word, _)| *word).collect();
            let expected = format!("must be one of {}", words.join(", "));
            Err(Refusal::argument(
                name,
                expected,
                Some(format!("{given:?}")),
            ))
        }
    }
}

/// Requests in the words of the command line.
fn parsed<T: std::str::FromStr<Err = String>>(
    name: &str,
    given: &[String],
) -> Result<Vec<T>, Refusal> {
    let each = given.iter().map(|text| {
        text.parse().map_err(|expected: String| {
            Refusal::argument(name, expected, Some(format!("{text:?}")))
        })
    });
    each.collect()
}
