//! NASTRAN bulk data: beams, bars and rods with their sections, supports, springs, rigid links and masses.
//!
//! A deck is read in four stages: `line` joins the files of a deck, `card` divides lines into cards and fields,
//! `deck` sorts the cards by type (one file for each group of cards), and `resolve` replaces references by indices
//! into a structure.
//!
//! # Source
//! NASTRAN quick reference guides: formats of cards, local axes, planes 1 and 2, offsets and pin flags of CBAR.

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
mod section;
mod support;

use std::io;
use std::path::Path;

pub use line::OpenFile;

use super::findings::ImportFindings;
use super::structure::ImportedStructure;

/// Reads a deck into `empty`, a structure that has a name and units only.
///
/// `spc` is the SPC set that the user selected; cards whose names are in `skip` are ignored.
///
/// # Errors
/// The deck cannot be read as a file; all other errors are among the findings.
pub fn read(
    path: &Path,
    open: OpenFile<'_>,
    empty: ImportedStructure,
    spc: Option<u64>,
    skip: &[String],
    findings: &mut ImportFindings,
) -> io::Result<ImportedStructure> {
    let lines = line::read(path, open, findings)?;
    let deck = deck::BulkDeck::new(&lines, skip, findings);
    // a reference to a card that could not be read would cause a second, misleading error
    if findings.has_errors() {
        return Ok(empty);
    }
    Ok(resolve::resolve(&deck, empty, spc, findings))
}
