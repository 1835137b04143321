//! NASTRAN bulk data.
//!
//! # Source
//! The formats of cards are those of the NASTRAN quick reference guides; local axes, planes 1 and 2, offsets and
//! pin flags of CBAR as there.

mod card;
mod deck;
mod element;
mod field;
mod fields;
mod grid;
mod line;
mod lump;
mod material;
mod property;
mod resolve;
mod rigid;
mod support;

use std::io;
use std::path::Path;

pub use line::Open;

use super::findings::ImportFindings;
use super::structure::ImportedStructure;

/// Reads a deck into `empty`, a structure that has its name and units. `spc`: the set of supports; `skip`: cards to
/// leave out.
///
/// # Errors
/// Why the file cannot be read; everything else is among the findings.
pub fn read(
    path: &Path,
    open: Open<'_>,
    empty: ImportedStructure,
    spc: Option<u64>,
    skip: &[String],
    findings: &mut ImportFindings,
) -> io::Result<ImportedStructure> {
    let lines = line::read(path, open, findings)?;
    let deck = deck::BulkDeck::new(&lines, skip, findings);
    // what refers to a card that could not be read is no fault of its own
    if findings.wrong() {
        return Ok(empty);
    }
    Ok(resolve::resolve(&deck, empty, spc, findings))
}
