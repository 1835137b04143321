//! A bulk data deck with its cards sorted by type.

use std::collections::BTreeMap;

use super::card::{Card, cards};
use super::element::{self, ElementCard};
use super::field::{Number, number};
use super::fields::CardFields;
use super::grid::{self, CoordinateCard, GridCard};
use super::line::BulkLine;
use super::lump::{self, MassCard, SpringCard};
use super::material::{MaterialCard, material};
use super::property::{self, Property};
use super::rigid::{self, Rigid};
use super::support::{self, SupportCard};
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// Cards that are ignored with a warning: they do not affect the static stiffness, or a beam spec has no counterpart.
const LEFT_OUT: &[&str] = &[
    "PARAM", "DEBUG", "FORCE", "FORCE1", "FORCE2", "MOMENT", "MOMENT1", "MOMENT2", "LOAD", "PLOAD", "PLOAD1",
    "PLOAD2", "PLOAD4", "PLOADX1", "SLOAD", "GRAV", "RFORCE", "ACCEL", "ACCEL1", "TEMP", "TEMPD", "TEMPRB",
    "TEMPP1", "DAREA", "DLOAD", "DELAY", "DPHASE", "RLOAD1", "RLOAD2", "TLOAD1", "TLOAD2", "LSEQ", "TABLED1",
    "TABLED2", "TABLED3", "TABLED4", "TABLEM1", "TABDMP1", "TABRND1", "RANDPS", "EIGR", "EIGRL", "EIGC",
    "EIGB", "FREQ", "FREQ1", "FREQ2", "FREQ3", "FREQ4", "TSTEP", "TSTEPNL", "NLPARM", "NLPCI", "ASET",
    "ASET1", "OMIT", "OMIT1", "USET", "USET1", "SET1", "SET3", "PLOTEL", "SEQGP", "CBARAO", "ECHOON",
    "ECHOOFF", "DCONADD", "MATT1",
];

/// Properties and materials of elements that cannot be imported; they are ignored with a warning.
const UNUSED: &[&str] = &[
    "PSHELL", "PSOLID", "PCOMP", "PCOMPG", "PSHEAR", "PBUSH", "PGAP", "PMASS", "MAT2", "MAT8", "MAT9",
    "MAT10",
];

/// The contents of a deck, by type of card.
#[derive(Debug, Default)]
pub struct BulkDeck {
    /// GRID cards by number.
    pub grids: BTreeMap<u64, GridCard>,
    /// Defaults of the GRDSET card.
    pub defaults: grid::GridDefaults,
    /// CORD2R cards by number.
    pub systems: BTreeMap<u64, CoordinateCard>,
    /// MAT1 cards by number.
    pub materials: BTreeMap<u64, MaterialCard>,
    /// PBAR, PBARL, PBEAM, PBEAML and PROD cards by number.
    pub properties: BTreeMap<u64, Property>,
    /// CBAR, CBEAM, CROD and CONROD cards by number.
    pub elements: BTreeMap<u64, ElementCard>,
    /// RBE2 and RBAR cards.
    pub rigid: Vec<Rigid>,
    /// CONM2 cards.
    pub masses: Vec<MassCard>,
    /// CELAS1 and CELAS2 cards.
    pub springs: Vec<SpringCard>,
    /// Positions and stiffnesses of PELAS cards by number.
    pub stiffness: BTreeMap<u64, (FilePlace, f64)>,
    /// SPC and SPC1 cards.
    pub supports: Vec<SupportCard>,
    /// Sets that each SPCADD card combines, by number.
    pub adds: BTreeMap<u64, Vec<u64>>,
    /// Whether the deck has a case control section.
    pub controlled: bool,
    /// SPC sets that case control selects, with their positions.
    pub control: Vec<(u64, FilePlace)>,
    /// Factor applied to all masses (PARAM WTMASS).
    pub wtmass: Option<f64>,
}

impl BulkDeck {
    /// Reads the cards of a deck and sorts them by type. Cards named in `skip` are ignored without a warning.
    pub fn new(lines: &[BulkLine], skip: &[String], findings: &mut ImportFindings) -> BulkDeck {
        let mut deck = BulkDeck::default();
        let bulk = deck.control(lines, skip, findings);
        let cards = cards(bulk, findings);
        let cards: Vec<&Card> = cards.iter().filter(|card| !skip.contains(&card.name)).collect();
        // defaults are read first because they also apply to the cards before them
        let mut bars = element::BarDefaults::default();
        let mut beams = element::BarDefaults::default();
        let mut seen: BTreeMap<&str, FilePlace> = BTreeMap::new();
        for card in &cards {
            let slot = match card.name.as_str() {
                "BAROR" => &mut bars,
                "BEAMOR" => &mut beams,
                "GRDSET" => {
                    let mut fields = CardFields { card, findings };
                    deck.defaults = grid::defaults(&mut fields).unwrap_or_default();
                    once(&mut seen, card, findings);
                    continue;
                }
                _ => continue,
            };
            *slot = element::defaults(&mut CardFields { card, findings }).unwrap_or_default();
            once(&mut seen, card, findings);
        }
        let mut left_out: BTreeMap<&str, (FilePlace, usize)> = BTreeMap::new();
        let mut unknown: BTreeMap<&str, (FilePlace, usize)> = BTreeMap::new();
        for card in &cards {
            let mut fields = CardFields { card, findings };
            match card.name.as_str() {
                "CBAR" => deck.element(element::bar(&mut fields, &bars), findings),
                "CBEAM" => deck.element(element::bar(&mut fields, &beams), findings),
                "BAROR" | "BEAMOR" | "GRDSET" => {}
                "PARAM" if fields.text(1) == "WTMASS" => deck.weight(&mut fields),
                name if deck.take(name, &mut fields) => {}
                name if LEFT_OUT.contains(&name) || UNUSED.contains(&name) => count(&mut left_out, card),
                _ => count(&mut unknown, card),
            }
        }
        for (name, (at, number)) in left_out {
            findings.warn(ImportFinding::new(at, name, format!("is left out, {}", cards_of(number))));
        }
        for (name, (at, number)) in unknown {
            let hint = format!("{}; if it can be ignored, add --skip {name}", advice(name));
            findings.error(
                ImportFinding::new(at, name, format!("is not supported, {}", cards_of(number))).hint(hint),
            );
        }
        deck
    }

    /// Reads the executive and case control sections and returns the lines of the bulk data section.
    fn control<'l>(
        &mut self,
        lines: &'l [BulkLine],
        skip: &[String],
        findings: &mut ImportFindings,
    ) -> &'l [BulkLine] {
        let word = |line: &BulkLine, n: usize| {
            let mut words = line.text.split([' ', '=', ',', '(']).filter(|word| !word.is_empty());
            words.nth(n).unwrap_or_default().to_ascii_uppercase()
        };
        let begins: Vec<usize> = (0..lines.len()).filter(|&k| word(&lines[k], 0) == "BEGIN").collect();
        let Some(&begin) = begins.first() else {
            if let Some(line) = lines.iter().find(|line| word(line, 0) == "CEND") {
                findings.error(
                    ImportFinding::new(line.at, "CEND", "must be followed by BEGIN BULK")
                        .hint("bulk data follow BEGIN BULK; a deck of bulk data alone has neither"),
                );
                return &[];
            }
            return lines;
        };
        for &other in &begins[1..] {
            findings.error(
                ImportFinding::new(lines[other].at, "BEGIN", "must occur only once")
                    .hint("superelements are not supported"),
            );
        }
        self.controlled = lines[..begin].iter().any(|line| word(line, 0) == "CEND");
        for line in &lines[..begin] {
            let key = word(line, 0);
            let set = match number(&word(line, 1)) {
                Some(Number::Integer(set)) if set > 0 => u64::try_from(set).ok(),
                _ => None,
            };
            match (key.as_str(), set) {
                ("SPC", Some(set)) => self.control.push((set, line.at)),
                ("SPC", None) => {
                    findings.error(
                        ImportFinding::new(line.at, "SPC", "must be a whole number above 0")
                            .with_found(word(line, 1)),
                    );
                }
                ("MPC", _) if skip.iter().all(|name| name != "MPC") => {
                    let hint = "constraints by equations are not supported; rigid links are RBE2 and RBAR; to leave them \
                            out, add --skip MPC";
                    findings.error(ImportFinding::new(line.at, "MPC", "is not supported").hint(hint));
                }
                _ => {}
            }
        }
        &lines[begin + 1..]
    }

    fn weight(&mut self, fields: &mut CardFields<'_, '_>) {
        if let Some(value) = property::positive(fields, 2, "WTMASS") {
            if self.wtmass.is_some() {
                fields.refuse(2, "WTMASS", "must occur only once", "");
            }
            self.wtmass = Some(value);
        }
    }

    fn element(&mut self, read: Option<(u64, ElementCard)>, findings: &mut ImportFindings) {
        let Some((id, element)) = read else { return };
        let (kind, card) = (element.kind.clone(), element.card);
        put(&mut self.elements, id, element, |other| other.card, card, &kind, findings);
    }

    /// Reads a card that defines part of the structure; returns false for any other card.
    fn take(&mut self, name: &str, fields: &mut CardFields<'_, '_>) -> bool {
        let at = fields.card.at;
        match name {
            "GRID" => {
                if let Some((id, grid)) = grid::grid(fields) {
                    put(&mut self.grids, id, grid, |other| other.card, at, name, fields.findings);
                }
            }
            "CORD2R" => {
                if let Some((id, system)) = grid::system(fields) {
                    put(&mut self.systems, id, system, |other| other.card, at, name, fields.findings);
                }
            }
            "MAT1" => {
                if let Some((id, found)) = material(fields) {
                    put(&mut self.materials, id, found, |other| other.card, at, name, fields.findings);
                }
            }
            "PBAR" | "PBARL" | "PBEAM" | "PBEAML" | "PROD" => {
                let read = match name {
                    "PBAR" => property::bar(fields),
                    "PBEAM" => property::beam(fields),
                    "PROD" => property::rod(fields),
                    _ => property::shaped(fields),
                };
                if let Some((id, found)) = read {
                    put(&mut self.properties, id, found, |other| other.card, at, name, fields.findings);
                }
            }
            "CROD" | "CONROD" => {
                let read = if name == "CROD" { element::rod(fields) } else { element::own_rod(fields) };
                self.element(read, fields.findings);
            }
            "RBE2" => self.rigid.extend(rigid::rbe2(fields)),
            "RBAR" => self.rigid.extend(rigid::rbar(fields)),
            "CONM2" => self.masses.extend(lump::mass(fields)),
            "CELAS1" | "CELAS2" => self.springs.extend(lump::spring(fields)),
            "PELAS" => {
                for (id, card, k) in property::springs(fields) {
                    put(&mut self.stiffness, id, (card, k), |other| other.0, at, name, fields.findings);
                }
            }
            "SPC" => self.supports.extend(support::spc(fields)),
            "SPC1" => self.supports.extend(support::spc1(fields)),
            "SPCADD" => {
                if let Some((set, parts)) = support::spcadd(fields)
                    && self.adds.insert(set, parts).is_some()
                {
                    fields.refuse(1, "SID", "must differ from the other sets of SPCADD", "");
                }
            }
            _ => return false,
        }
        true
    }
}

/// Inserts an entry under its number, and adds an error if the number is already in use.
fn put<T>(
    map: &mut BTreeMap<u64, T>,
    id: u64,
    entry: T,
    card: impl Fn(&T) -> FilePlace,
    at: FilePlace,
    name: &str,
    findings: &mut ImportFindings,
) {
    if let Some(other) = map.get(&id) {
        let other = card(other);
        let file =
            if other.file == at.file { String::new() } else { format!(" of {}", findings.files[other.file]) };
        let expected = format!("must have a unique number: line {}{file} has the same", other.line);
        findings.error(ImportFinding::new(at, format!("{name} {id}"), expected));
        return;
    }
    map.insert(id, entry);
}

fn once<'c>(seen: &mut BTreeMap<&'c str, FilePlace>, card: &'c Card, findings: &mut ImportFindings) {
    if let Some(other) = seen.insert(&card.name, card.at) {
        let expected = format!("must occur only once; line {} already has one", other.line);
        findings.error(ImportFinding::new(card.at, &card.name, expected));
    }
}

fn count<'c>(counts: &mut BTreeMap<&'c str, (FilePlace, usize)>, card: &'c Card) {
    counts.entry(&card.name).or_insert((card.at, 0)).1 += 1;
}

fn cards_of(number: usize) -> String {
    if number == 1 { "1 card".to_owned() } else { format!("{number} cards") }
}

fn advice(name: &str) -> &'static str {
    match name {
        "CORD1R" | "CORD1C" | "CORD1S" | "CORD2C" | "CORD2S" => {
            "supported coordinate systems are CORD2R, given by points"
        }
        "MPC" | "MPCADD" | "RBE1" | "RBE3" | "RROD" | "RJOINT" => {
            "supported rigid links are RBE2 and RBAR with 123456"
        }
        "CBUSH" | "CELAS3" | "CELAS4" => "supported springs are CELAS1 and CELAS2",
        "CONM1" | "CMASS1" | "CMASS2" => "supported masses are CONM2",
        "SPCD" | "SPCOFF" | "SPCOFF1" => "supported restraints are SPC and SPC1",
        "CBEND" | "CTUBE" | "CBEAM3" | "CBAR3" => "supported members are CBAR, CBEAM, CROD and CONROD",
        _ if name.starts_with('C') => {
            "a beam spec consists of members, rigid links, masses and springs to ground"
        }
        _ => "this card is not known",
    }
}
