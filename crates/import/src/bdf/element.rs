//! Elements CBAR, CBEAM, CROD, CTUBE and CONROD, with the defaults of BAROR and BEAMOR.

use super::field::{Number, number};
use super::fields::CardFields;
use super::property::{Property, rod_from};
use crate::findings::FilePlace;

/// BarOrientation of the local y axis of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BarOrientation {
    /// An orientation vector at end A.
    Vector([f64; 3]),
    /// The orientation vector points from grid GA to this grid.
    Grid(u64),
}

/// Systems in which orientation vector and offsets of an element are stated (field OFFT).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElementSystems {
    /// Whether the orientation vector is in the basic system, and not in the displacement system of GA.
    pub basic: bool,
    /// Whether the offset of each end is in the element system, and not in the displacement system of its grid.
    pub own: [bool; 2],
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
    /// BarOrientation of the local y axis; `None` for rods.
    pub orientation: Option<BarOrientation>,
    /// Released degrees of freedom at ends A and B.
    pub pins: [[bool; 6]; 2],
    /// Offsets of ends A and B, in the systems of `systems`.
    pub offsets: [[f64; 3]; 2],
    /// Systems of orientation and offsets.
    pub systems: ElementSystems,
    /// Position and name of the BAROR or BEAMOR that defines its property; `None` if its own card does.
    pub property_default: Option<(FilePlace, &'static str)>,
    /// Position and name of the BAROR or BEAMOR that defines its orientation; `None` if its own card does.
    pub orientation_default: Option<(FilePlace, &'static str)>,
}

/// Defaults of BAROR and BEAMOR for blank fields.
#[derive(Clone, Debug, Default)]
pub struct BarDefaults {
    /// Position of the card.
    pub card: FilePlace,
    /// Number of the property.
    pub property: Option<u64>,
    orientation: Option<BarOrientation>,
    systems: Option<ElementSystems>,
    /// Whether the card could not be read, so that nothing is known of its defaults.
    is_unreadable: bool,
}

/// Reads BAROR or BEAMOR. A card that cannot be read causes errors of its own alone, not of the elements.
pub fn defaults(card: &mut CardFields<'_, '_>) -> BarDefaults {
    read_defaults(card).unwrap_or(BarDefaults {
        is_unreadable: true,
        ..BarDefaults::default()
    })
}

fn read_defaults(card: &mut CardFields<'_, '_>) -> Option<BarDefaults> {
    let property = if card.blank(2) {
        Some(None)
    } else {
        card.id(2, "PID").map(Some)
    };
    let orientation = orientation(card)?;
    let systems = systems(card)?;
    card.end(9);
    Some(BarDefaults {
        card: card.card.at,
        property: property?,
        orientation,
        systems,
        is_unreadable: false,
    })
}

/// Reads OFFT: the letters select the systems of the orientation and of the offsets at A and B. Older programs have
/// the flag F there, which tells whether fields 5 to 7 contain a vector (1) or a grid (2); their form tells it as well.
/// Returns `Some(None)` if the field is blank.
fn systems(card: &mut CardFields<'_, '_>) -> Option<Option<ElementSystems>> {
    match card.text(8) {
        "" | "0" => return Some(None),
        "1" | "2" => return Some(Some(ElementSystems::default())),
        _ => {}
    }
    let letters: Vec<char> = card.text(8).chars().collect();
    if let [vector, a, b] = letters.as_slice()
        && "GB".contains(*vector)
        && "GOE".contains(*a)
        && "GOE".contains(*b)
    {
        return Some(Some(ElementSystems {
            basic: *vector == 'B',
            own: [*a != 'G', *b != 'G'],
        }));
    }
    let hint = "G: displacement system, B: basic system, O or E: element system; or 1, 2 or blank";
    card.refuse(
        8,
        "OFFT",
        "must be three letters such as GGG, BGG or GOO",
        hint,
    );
    None
}

/// Reads fields 5 to 7, which contain a vector or the number of a grid. Returns `Some(None)` if all are blank and
/// `None`, with an error, if they cannot be read.
fn orientation(card: &mut CardFields<'_, '_>) -> Option<Option<BarOrientation>> {
    if (5..8).all(|index| card.blank(index)) {
        return Some(None);
    }
    if card.blank(6) && card.blank(7) && matches!(number(card.text(5)), Some(Number::Integer(_))) {
        return card
            .id(5, "G0")
            .map(|grid| Some(BarOrientation::Grid(grid)));
    }
    card.vector(5, ["X1", "X2", "X3"])
        .map(|vector| Some(BarOrientation::Vector(vector)))
}

/// Reads CBAR or CBEAM.
pub fn bar(card: &mut CardFields<'_, '_>, defaults: &BarDefaults) -> Option<(u64, ElementCard)> {
    let id = card.id(1, "EID")?;
    let property = card.id_or(2, "PID", defaults.property.unwrap_or(id));
    let grids = ends(card, 3);
    let default_card = (
        defaults.card,
        if card.card.name == "CBEAM" {
            "BEAMOR"
        } else {
            "BAROR"
        },
    );
    let from_default = |is_default: bool| is_default.then_some(default_card);
    let property_default = from_default(card.blank(2) && defaults.property.is_some());
    let own = orientation(card);
    let given = own.map(|given| given.or(defaults.orientation));
    if given == Some(None) && !defaults.is_unreadable {
        card.refuse(
            5,
            "X1",
            "is missing",
            "specify the orientation by the vector X1, X2, X3 or the grid G0",
        );
    }
    let systems = systems(card).map(|own| own.or(defaults.systems).unwrap_or_default());
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
        systems: systems?,
        property_default,
        orientation_default: from_default(own == Some(None)),
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

/// Reads CROD or CTUBE, which may define two elements.
pub fn rods(card: &mut CardFields<'_, '_>) -> Vec<(u64, ElementCard)> {
    let mut found = Vec::new();
    for first in [1, 5] {
        if first == 5 && (5..9).all(|index| card.blank(index)) {
            continue;
        }
        let Some(id) = card.id(first, "EID") else {
            continue;
        };
        let property = card.id_or(first + 1, "PID", id);
        let grids = ends(card, first + 2);
        if let (Some(property), Some(grids)) = (property, grids) {
            found.push((id, plain(card, SectionOf::Number(property), grids)));
        }
    }
    card.end(9);
    found
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
        systems: ElementSystems::default(),
        property_default: None,
        orientation_default: None,
    }
}
