//! NASTRAN bulk data: beams, bars and rods with their sections, supports, springs, rigid links and masses.
//!
//! A deck is read in four stages: `line` joins the files of a deck, `card` joins lines to cards (after `divide` has
//! divided them into fields and `replication` has written out those that repeat others), `deck` sorts the cards by type
//! (one file for each group of cards), and `resolve` replaces references by indices into a structure.
//!
//! # Source
//! NASTRAN quick reference guides: formats of cards, local axes, planes 1 and 2, offsets and pin flags of CBAR.

mod card;
mod coordinates;
mod deck;
mod divide;
mod element;
mod field;
mod fields;
mod grid;
mod line;
mod lump;
mod lumped;
mod material;
mod member;
mod place;
mod property;
mod replication;
mod resolve;
mod rigid;
mod roles;
mod section;
mod support;

use std::io;
use std::path::Path;

pub use deck::Omissions;

use super::findings::ImportFindings;
use super::includes::OpenFile;
use super::structure::{ImportedStructure, MassDistribution};

/// Reads a deck into `empty`, a structure that has a name and units only.
///
/// `spc` is the SPC set that the user selected, `omit` what is left out of the deck, and `mass` the distribution of the
/// mass of elements, if it is not that of the deck.
///
/// # Errors
/// The deck cannot be read as a file; all other errors are among the findings.
pub fn read(
    path: &Path,
    open: OpenFile<'_>,
    empty: ImportedStructure,
    spc: Option<u64>,
    omit: Omissions<'_>,
    mass: Option<MassDistribution>,
    findings: &mut ImportFindings,
) -> io::Result<ImportedStructure> {
    let lines = line::read(path, open, findings)?;
    let deck = deck::BulkDeck::new(&lines, omit, findings);
    // a reference to a card that could not be read would cause a second, misleading error
    if findings.has_errors() {
        return Ok(empty);
    }
    let of_deck = if deck.coupled_mass {
        MassDistribution::Distributed
    } else {
        MassDistribution::LumpedRods
    };
    let asked = resolve::Asked {
        spc,
        mass: mass.unwrap_or(of_deck),
        moves_mass: mass.is_none() && !deck.coupled_mass,
        unused: omit.unused,
    };
    Ok(resolve::resolve(&deck, empty, asked, findings))
}
