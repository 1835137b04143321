//! Elements CBAR, CBEAM, CROD and CONROD, with the defaults of BAROR and BEAMOR.

use super::field::{Number, number};
use super::fields::CardFields;
use super::property::{Property, rod_from};
use crate::findings::FilePlace;

/// Orientation of the local y axis of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orientation {
    /// An orientation vector at end A.
    Vector([f64; 3]),
    /// The orientation vector points from grid GA to this grid.
    Grid(u64),
}

/// Reference from an element to its property.
#[derive(Clone, Debug)]
pub enum SectionOf {
    /// The number of a property.
    Number(u64),
    /// A property defined on the element card itself (CONROD).
    Own(Box<Property>),
}

/// An element as its card defines it, before references are resolved.
#[derive(Clone, Debug)]
pub struct ElementCard {
    /// Position of its card.
    pub card: FilePlace,
    /// Name of its card.
    pub kind: String,
    /// Its property.
    pub section: SectionOf,
    /// Numbers of the grids at ends A and B.
    pub grids: [u64; 2],
    /// Orientation of the local y axis; `None` for rods.
    pub orientation: Option<Orientation>,
    /// Released degrees of freedom at ends A and B.
    pub pins: [[bool; 6]; 2],
    /// Offsets of ends A and B in global axes.
    pub offsets: [[f64; 3]; 2],
}

/// Defaults of BAROR and BEAMOR for blank fields.
#[derive(Clone, Debug, Default)]
pub struct BarDefaults {
    property: Option<u64>,
    orientation: Option<Orientation>,
    frame: Option<String>,
}

/// Reads BAROR or BEAMOR.
pub fn defaults(card: &mut CardFields<'_, '_>) -> Option<BarDefaults> {
    let property = if card.blank(2) { Some(None) } else { card.id(2, "PID").map(Some) };
    let orientation = orientation(card)?;
    let frame = (!card.blank(8)).then(|| card.text(8).to_owned());
    card.end(9);
    Some(BarDefaults { property: property?, orientation, frame })
}

/// Reads fields 5 to 7, which contain a vector or the number of a grid. Returns `Some(None)` if all are blank and
/// `None`, with an error, if they cannot be read.
fn orientation(card: &mut CardFields<'_, '_>) -> Option<Option<Orientation>> {
    if (5..8).all(|index| card.blank(index)) {
        return Some(None);
    }
    if card.blank(6) && card.blank(7) && matches!(number(card.text(5)), Some(Number::Integer(_))) {
        return card.id(5, "G0").map(|grid| Some(Orientation::Grid(grid)));
    }
    card.vector(5, ["X1", "X2", "X3"]).map(|vector| Some(Orientation::Vector(vector)))
}

/// Reads CBAR or CBEAM.
pub fn bar(card: &mut CardFields<'_, '_>, defaults: &BarDefaults) -> Option<(u64, ElementCard)> {
    let id = card.id(1, "EID")?;
    let property = card.id_or(2, "PID", defaults.property.unwrap_or(id));
    let grids = ends(card, 3);
    let given = orientation(card).map(|given| given.or(defaults.orientation));
    if given == Some(None) {
        card.refuse(5, "X1", "is missing", "state the orientation as vector X1, X2, X3 or grid G0");
    }
    let frame =
        if card.blank(8) { defaults.frame.clone().unwrap_or_default() } else { card.text(8).to_owned() };
    // the first letter selects the displacement or the basic system, which have the same axes here
    if !matches!(frame.as_str(), "" | "GGG" | "BGG") {
        let hint = "offsets and orientation in the element's own system are not supported; use GGG";
        card.refuse(8, "OFFT", "must be GGG, BGG or blank", hint);
    }
    let pins = [(9, "PA"), (10, "PB")].map(|(index, name)| card.freedoms(index, name));
    let from = card.vector(11, ["W1A", "W2A", "W3A"]);
    let to = card.vector(14, ["W1B", "W2B", "W3B"]);
    let mut last = 17;
    if card.card.name == "CBEAM" {
        let warping = "warping of the section is not supported";
        card.zero(17, "SA", warping);
        card.zero(18, "SB", warping);
        last = 19;
    }
    card.end(last);
    let [a, b] = pins;
    let element = ElementCard {
        card: card.card.at,
        kind: card.card.name.clone(),
        section: SectionOf::Number(property?),
        grids: grids?,
        orientation: given?,
        pins: [a?, b?],
        offsets: [from?, to?],
    };
    element.orientation.is_some().then_some((id, element))
}

fn ends(card: &mut CardFields<'_, '_>, first: usize) -> Option<[u64; 2]> {
    let a = card.id(first, "GA");
    let b = card.id(first + 1, "GB");
    let (a, b) = (a?, b?);
    if a == b {
        card.refuse(first + 1, "GB", "must differ from GA", "");
    }
    (a != b).then_some([a, b])
}

/// Reads CROD.
pub fn rod(card: &mut CardFields<'_, '_>) -> Option<(u64, ElementCard)> {
    let id = card.id(1, "EID")?;
    let property = card.id_or(2, "PID", id);
    let grids = ends(card, 3);
    card.end(5);
    Some((id, plain(card, SectionOf::Number(property?), grids?)))
}

/// Reads CONROD, a rod with its own property.
pub fn own_rod(card: &mut CardFields<'_, '_>) -> Option<(u64, ElementCard)> {
    let id = card.id(1, "EID")?;
    let grids = ends(card, 2);
    let property = rod_from(card, 4);
    Some((id, plain(card, SectionOf::Own(Box::new(property?)), grids?)))
}

fn plain(card: &CardFields<'_, '_>, section: SectionOf, grids: [u64; 2]) -> ElementCard {
    ElementCard {
        card: card.card.at,
        kind: card.card.name.clone(),
        section,
        grids,
        orientation: None,
        pins: [[false; 6]; 2],
        offsets: [[0.0; 3]; 2],
    }
}
