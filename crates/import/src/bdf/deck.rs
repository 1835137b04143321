//! A bulk data deck with its cards sorted by type.

use std::collections::BTreeMap;

use super::card::{Card, cards};
use super::coordinates::{self, CoordinateCard};
use super::element::{self, ElementCard};
use super::field::{Number, number};
use super::fields::CardFields;
use super::grid::{self, GridCard};
use super::line::BulkLine;
use super::lump::{self, MassCard, SpringCard};
use super::material::{MaterialCard, material};
use super::property::{self, Property};
use super::rigid::{self, Rigid};
use super::roles::{CardRole, advice, has_mass, is_other_element, role};
use super::support::{self, SupportCard};
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// The contents of a deck, by type of card.
#[derive(Debug, Default)]
pub struct BulkDeck {
    /// GRID cards by number.
    pub grids: BTreeMap<u64, GridCard>,
    /// Defaults of the GRDSET card.
    pub defaults: grid::GridDefaults,
    /// Coordinate systems by number.
    pub systems: BTreeMap<u64, CoordinateCard>,
    /// MAT1 cards by number.
    pub materials: BTreeMap<u64, MaterialCard>,
    /// PBAR, PBARL, PBEAM, PBEAML, PROD and PTUBE cards by number.
    pub properties: BTreeMap<u64, Property>,
    /// CBAR, CBEAM, CROD, CTUBE and CONROD cards by number.
    pub elements: BTreeMap<u64, ElementCard>,
    /// Number of cards of each type of element that is not a member, of those that are left out too.
    pub others: BTreeMap<String, usize>,
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
    /// Whether case control selects constraints by equations (MPC).
    pub equations: bool,
    /// Factor applied to all masses (PARAM WTMASS).
    pub wtmass: Option<f64>,
    /// Whether the mass of elements is consistent with their shapes (PARAM COUPMASS above 0). Otherwise it is lumped at
    /// their ends.
    pub coupled_mass: bool,
}

/// What the user asks to leave out of a deck.
#[derive(Clone, Copy, Debug, Default)]
pub struct Omissions<'a> {
    /// Names of cards that are ignored without a warning.
    pub skip: &'a [String],
    /// Whether cards that cannot change the stiffness of the structure are left out.
    pub unused: bool,
}

impl Omissions<'_> {
    /// Whether the user asked to ignore a card, keyword or type of element by its name.
    #[must_use]
    pub fn skips(&self, name: &str) -> bool {
        self.skip.iter().any(|skipped| skipped == name)
    }
}

impl BulkDeck {
    /// Reads the cards of a deck and sorts them by type.
    pub fn new(lines: &[BulkLine], omit: Omissions<'_>, findings: &mut ImportFindings) -> BulkDeck {
        let mut deck = BulkDeck::default();
        let bulk = deck.control(lines, omit, findings);
        let cards = cards(bulk, findings);
        for card in cards.iter().filter(|card| is_other_element(&card.name)) {
            *deck.others.entry(card.name.clone()).or_insert(0) += 1;
        }
        let cards: Vec<&Card> = cards
            .iter()
            .filter(|card| !omit.skips(&card.name))
            .collect();
        let [bars, beams] = deck.defaults(&cards, findings);
        let mut left_out: BTreeMap<&str, (FilePlace, usize)> = BTreeMap::new();
        let mut unused: BTreeMap<&str, (FilePlace, usize)> = BTreeMap::new();
        let mut unknown: BTreeMap<&str, (FilePlace, usize)> = BTreeMap::new();
        for card in &cards {
            let mut fields = CardFields { card, findings };
            match card.name.as_str() {
                "CBAR" => deck.element(element::bar(&mut fields, &bars), findings),
                "CBEAM" => deck.element(element::bar(&mut fields, &beams), findings),
                "BAROR" | "BEAMOR" | "GRDSET" => {}
                "PARAM" if fields.text(1) == "WTMASS" => deck.weight(&mut fields),
                "PARAM" if fields.text(1) == "COUPMASS" => {
                    deck.coupled_mass =
                        matches!(number(fields.text(2)), Some(Number::Integer(1..)));
                }
                "MPC" | "MPCADD" if deck.controlled && !deck.equations => {
                    count(&mut left_out, card)
                }
                "MDLPRM" if fields.text(1) == "HDF5" => count(&mut left_out, card),
                // MDLPRM may change how offsets are read
                "MDLPRM" if fields.text(1) == "OFFDEF" => count(&mut unknown, card),
                name if deck.take(name, omit, &mut fields) => {}
                name => match role(name) {
                    Some(CardRole::Request | CardRole::Property) => count(&mut left_out, card),
                    Some(CardRole::NoStiffness) if omit.unused => count(&mut unused, card),
                    _ => count(&mut unknown, card),
                },
            }
        }
        for (name, (at, number)) in left_out {
            findings.warn(ImportFinding::new(
                at,
                name,
                format!("is ignored ({})", cards_of(number)),
            ));
        }
        for (name, (at, number)) in unused {
            let effect = if has_mass(name) {
                "its mass is missing in natural frequencies, weight and inertia forces"
            } else {
                "it does not affect the stiffness"
            };
            let message = format!("is ignored ({}): {effect}", cards_of(number));
            findings.warn(ImportFinding::new(at, name, message));
        }
        for (name, (at, number)) in unknown {
            let hint = if role(name) == Some(CardRole::NoStiffness) {
                format!(
                    "it does not affect the stiffness: ignore it with --skip-unused or --skip {name}"
                )
            } else {
                format!("{}; if it can be ignored, add --skip {name}", advice(name))
            };
            findings.error(
                ImportFinding::new(at, name, format!("is not supported ({})", cards_of(number)))
                    .hint(hint),
            );
        }
        deck
    }

    /// Reads GRDSET and returns the defaults of BAROR and BEAMOR. They are read first because they also apply to the
    /// cards before them.
    fn defaults(
        &mut self,
        cards: &[&Card],
        findings: &mut ImportFindings,
    ) -> [element::BarDefaults; 2] {
        let mut found = [
            element::BarDefaults::default(),
            element::BarDefaults::default(),
        ];
        let mut seen: BTreeMap<&str, FilePlace> = BTreeMap::new();
        for card in cards {
            let mut fields = CardFields { card, findings };
            match card.name.as_str() {
                "BAROR" => found[0] = element::defaults(&mut fields),
                "BEAMOR" => found[1] = element::defaults(&mut fields),
                "GRDSET" => self.defaults = grid::defaults(&mut fields).unwrap_or_default(),
                _ => continue,
            }
            once(&mut seen, card, findings);
        }
        found
    }

    /// Reads the executive and case control sections and returns the lines of the bulk data section.
    fn control<'l>(
        &mut self,
        lines: &'l [BulkLine],
        omit: Omissions<'_>,
        findings: &mut ImportFindings,
    ) -> &'l [BulkLine] {
        let word = |line: &BulkLine, n: usize| {
            let mut words = line
                .text
                .split([' ', '=', ',', '('])
                .filter(|word| !word.is_empty());
            words.nth(n).unwrap_or_default().to_ascii_uppercase()
        };
        let begins: Vec<usize> = (0..lines.len())
            .filter(|&k| word(&lines[k], 0) == "BEGIN")
            .collect();
        let Some(&begin) = begins.first() else {
            if let Some(line) = lines.iter().find(|line| word(line, 0) == "CEND") {
                findings.error(
                    ImportFinding::new(line.at, "CEND", "must be followed by BEGIN BULK").hint(
                        "a deck that consists of bulk data only has neither CEND nor BEGIN BULK",
                    ),
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
                ("MPC", _) if !omit.skips("MPC") => {
                    self.equations = true;
                    let hint = "constraint equations are not supported; supported rigid links are RBE2 and RBAR; to \
                            ignore the equations, add --skip MPC";
                    findings
                        .error(ImportFinding::new(line.at, "MPC", "is not supported").hint(hint));
                }
                ("K2GG" | "K2PP", _) if !omit.skips(&key) => {
                    let hint = format!(
                        "direct matrix input is not supported; to ignore it, add --skip {key},DMIG"
                    );
                    findings.error(ImportFinding::new(line.at, key, "is not supported").hint(hint));
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
        put(
            &mut self.elements,
            id,
            element,
            |other| other.card,
            card,
            &kind,
            findings,
        );
    }

    /// Reads a card that defines part of the structure; returns false for any other card.
    fn take(&mut self, name: &str, omit: Omissions<'_>, fields: &mut CardFields<'_, '_>) -> bool {
        let at = fields.card.at;
        match name {
            "GRID" => {
                if let Some((id, grid)) = grid::grid(fields) {
                    put(
                        &mut self.grids,
                        id,
                        grid,
                        |other| other.card,
                        at,
                        name,
                        fields.findings,
                    );
                }
            }
            "CORD1R" | "CORD1C" | "CORD1S" | "CORD2R" | "CORD2C" | "CORD2S" => {
                for (id, system) in coordinates::systems(fields) {
                    put(
                        &mut self.systems,
                        id,
                        system,
                        |other| other.card,
                        at,
                        name,
                        fields.findings,
                    );
                }
            }
            "MAT1" => {
                if let Some((id, found)) = material(fields) {
                    put(
                        &mut self.materials,
                        id,
                        found,
                        |other| other.card,
                        at,
                        name,
                        fields.findings,
                    );
                }
            }
            "PBAR" | "PBARL" | "PBEAM" | "PBEAML" | "PROD" | "PTUBE" => {
                let read = match name {
                    "PBAR" => property::bar(fields),
                    "PBEAM" => property::beam(fields),
                    "PROD" => property::rod(fields),
                    "PTUBE" => property::tube(fields),
                    _ => property::shaped(fields),
                };
                if let Some((id, found)) = read {
                    put(
                        &mut self.properties,
                        id,
                        found,
                        |other| other.card,
                        at,
                        name,
                        fields.findings,
                    );
                }
            }
            "CROD" | "CTUBE" => {
                for rod in element::rods(fields) {
                    self.element(Some(rod), fields.findings);
                }
            }
            "CONROD" => self.element(element::own_rod(fields), fields.findings),
            "RBE2" => self.rigid.extend(rigid::rbe2(fields)),
            "RBAR" => self.rigid.extend(rigid::rbar(fields)),
            "CONM2" => self.masses.extend(lump::mass(fields)),
            "CELAS1" | "CELAS2" => self.springs.extend(lump::spring(fields)),
            "PELAS" => {
                for (id, card, k) in property::springs(fields) {
                    put(
                        &mut self.stiffness,
                        id,
                        (card, k),
                        |other| other.0,
                        at,
                        name,
                        fields.findings,
                    );
                }
            }
            "SPC" => self.supports.extend(support::spc(fields, omit.unused)),
            "SPC1" => self.supports.extend(support::spc1(fields)),
            "SPCADD" => {
                if let Some((set, parts)) = support::spcadd(fields)
                    && self.adds.insert(set, parts).is_some()
                {
                    fields.refuse(1, "SID", "must differ from that of every other SPCADD", "");
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
        let file = if other.file == at.file {
            String::new()
        } else {
            format!(" of {}", findings.files[other.file])
        };
        let expected = format!(
            "must have a unique number; line {}{file} uses the same",
            other.line
        );
        findings.error(ImportFinding::new(at, format!("{name} {id}"), expected));
        return;
    }
    map.insert(id, entry);
}

fn once<'c>(
    seen: &mut BTreeMap<&'c str, FilePlace>,
    card: &'c Card,
    findings: &mut ImportFindings,
) {
    if let Some(other) = seen.insert(&card.name, card.at) {
        let expected = format!("must occur only once; the first is in line {}", other.line);
        findings.error(ImportFinding::new(card.at, &card.name, expected));
    }
}

fn count<'c>(counts: &mut BTreeMap<&'c str, (FilePlace, usize)>, card: &'c Card) {
    counts.entry(&card.name).or_insert((card.at, 0)).1 += 1;
}

fn cards_of(number: usize) -> String {
    if number == 1 {
        "1 card".to_owned()
    } else {
        format!("{number} cards")
    }
}
