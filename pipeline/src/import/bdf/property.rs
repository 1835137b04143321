//! PBAR, PBARL, PBEAM, PBEAML, PROD and PELAS: what elements resist with.

use super::fields::Fields;
use super::shape::{Refusal, SHAPES, dimensions, properties};
use crate::fault::nearest;
use crate::import::findings::Spot;

/// A property of bars, beams or rods.
#[derive(Clone, Debug)]
pub struct Property {
    /// Where its card is.
    pub card: Spot,
    /// Name of its card.
    pub kind: String,
    /// Its material.
    pub material: u64,
    /// Area.
    pub area: f64,
    /// Second moments for bending in planes 1 and 2; zeros for rods.
    pub bending: [f64; 2],
    /// Torsion constant.
    pub j: f64,
    /// Shear factors of planes 1 and 2; 0 is rigid in shear.
    pub shear: [f64; 2],
    /// Further mass per length, before WTMASS.
    pub nsm: f64,
}

const NO_PRODUCT: &str = "give the principal second moments, and turn the orientation of the elements";

/// Reads PROD.
pub fn rod(card: &mut Fields<'_, '_>) -> Option<(u64, Property)> {
    let id = card.id(1, "PID")?;
    let material = card.id(2, "MID");
    let area = positive(card, 3, "A");
    let j = card.not_negative(4, "J");
    let nsm = card.not_negative(6, "NSM");
    card.end(7);
    let property = Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material: material?,
        area: area?,
        bending: [0.0; 2],
        j: j?,
        shear: [0.0; 2],
        nsm: nsm?,
    };
    Some((id, property))
}

/// A real number above 0.
pub fn positive(card: &mut Fields<'_, '_>, index: usize, name: &str) -> Option<f64> {
    let value = card.real(index, name)?;
    if value <= 0.0 {
        card.refuse(index, name, "must be positive", "");
    }
    (value > 0.0).then_some(value)
}

/// Reads PBAR.
pub fn bar(card: &mut Fields<'_, '_>) -> Option<(u64, Property)> {
    let id = card.id(1, "PID")?;
    let material = card.id(2, "MID");
    let area = positive(card, 3, "A");
    let bending = [(4, "I1"), (5, "I2")].map(|(index, name)| card.not_negative(index, name));
    let j = card.not_negative(6, "J");
    let nsm = card.not_negative(7, "NSM");
    let shear = [(17, "K1"), (18, "K2")].map(|(index, name)| card.not_negative(index, name));
    let product = card.zero(19, "I12", NO_PRODUCT);
    card.end(20);
    let [i1, i2] = bending;
    let [k1, k2] = shear;
    product?;
    let property = Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material: material?,
        area: area?,
        bending: [i1?, i2?],
        j: j?,
        shear: [k1?, k2?],
        nsm: nsm?,
    };
    whole(card, &property).then_some((id, property))
}

/// Whether a bar bends in both planes, or in none.
fn whole(card: &mut Fields<'_, '_>, property: &Property) -> bool {
    let [i1, i2] = property.bending.map(|value| value > 0.0);
    let hint = "give both second moments, or neither for a bar that only changes its length";
    if i1 != i2 {
        let (index, name) = if i1 { (5, "I2") } else { (4, "I1") };
        card.refuse(index, name, "must be positive where the other plane bends", hint);
    } else if !i1 && property.j > 0.0 {
        card.refuse(4, "I1", "must be positive where J is", hint);
        return false;
    }
    i1 == i2
}

/// Reads PBEAM; its ends must be alike.
pub fn beam(card: &mut Fields<'_, '_>) -> Option<(u64, Property)> {
    let id = card.id(1, "PID")?;
    let names = ["A", "I1", "I2", "I12", "J", "NSM"];
    let material = card.id(2, "MID");
    let area = positive(card, 3, "A");
    let i1 = card.not_negative(4, "I1");
    let i2 = card.not_negative(5, "I2");
    let product = card.zero(6, "I12", NO_PRODUCT);
    let j = card.not_negative(7, "J");
    let nsm = card.not_negative(8, "NSM");
    product?;
    let own = [area?, i1?, i2?, 0.0, j?, nsm?];
    let rows = card.card.fields.len().div_ceil(8);
    let station = |card: &Fields<'_, '_>, row: usize| matches!(card.text(8 * row + 1), "YES" | "YESA" | "NO");
    let blank = |card: &Fields<'_, '_>, row: usize| (1..=8).all(|field| card.blank(8 * row + field));
    // the second row has places for stresses, unless stations begin at once
    let mut row = if station(card, 1) { 1 } else { 2 };
    while row < rows && station(card, row) {
        let first = 8 * row;
        card.real(first + 2, "X/XB")?;
        for (k, name) in names.into_iter().enumerate() {
            let index = first + 3 + k;
            if card.optional(index, name)?.is_some_and(|value| value != own[k]) {
                card.refuse(
                    index,
                    name,
                    "must be that of end A",
                    "tapered beams cannot be taken: cut them into uniform ones",
                );
                return None;
            }
        }
        row += if card.text(first + 1) == "YES" || (row + 1 < rows && blank(card, row + 1)) { 2 } else { 1 };
    }
    let first = 8 * row;
    let shear = [(first + 1, "K1"), (first + 2, "K2")]
        .map(|(index, name)| if card.blank(index) { Some(1.0) } else { card.not_negative(index, name) });
    let relief = "shear relief belongs to taper, which cannot be taken";
    let relief = [(first + 3, "S1"), (first + 4, "S2")].map(|(index, name)| card.zero(index, name, relief));
    let apart = "give the neutral axis as offset of the elements";
    let apart =
        (first + 13..first + 17).map(|index| card.zero(index, "N", apart)).collect::<Option<Vec<_>>>();
    let lost = [first + 5, first + 6, first + 9, first + 10, first + 11, first + 12];
    if let Some(index) = lost.into_iter().find(|index| !card.blank(*index) && card.text(*index) != "0.") {
        let fault = card.fault(index, "", "inertia and offset of the further mass are left out");
        card.findings.warn(fault);
    }
    card.end(first + 17);
    let [k1, k2] = shear;
    relief.into_iter().collect::<Option<Vec<_>>>()?;
    apart?;
    let property = Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material: material?,
        area: own[0],
        bending: [own[1], own[2]],
        j: own[4],
        shear: [k1?, k2?],
        nsm: own[5],
    };
    whole(card, &property).then_some((id, property))
}

/// Reads PBARL or PBEAML; the ends of a beam must be alike.
pub fn shaped(card: &mut Fields<'_, '_>) -> Option<(u64, Property)> {
    let id = card.id(1, "PID")?;
    let material = card.id(2, "MID");
    if !card.blank(3) && card.text(3) != "MSCBML0" {
        card.refuse(3, "GROUP", "must be MSCBML0 or blank", "");
        return None;
    }
    let shape = card.text(4).to_owned();
    let Some(count) = dimensions(&shape) else {
        let known = SHAPES.map(|(name, _)| name);
        let hint = match nearest(&shape, &known) {
            Some(near) => format!("did you mean {near}? known: {}", known.join(", ")),
            None => format!("known: {}; others as PBAR or PBEAM", known.join(", ")),
        };
        card.refuse(4, "TYPE", "is not known", &hint);
        return None;
    };
    let mut dimensions = Vec::new();
    for k in 0..count {
        dimensions.push(card.real(9 + k, &format!("DIM{}", k + 1))?);
    }
    let nsm = card.not_negative(9 + count, "NSM")?;
    if card.card.name == "PBARL" {
        card.end(10 + count);
    } else {
        alike(card, &dimensions, nsm)?;
    }
    let section = match properties(&shape, &dimensions) {
        Ok(section) => section,
        Err(Refusal::Oblique) => {
            card.refuse(4, "TYPE", "must have its principal axes along y and z", NO_PRODUCT);
            return None;
        }
        Err(Refusal::Dimensions | Refusal::Unknown) => {
            card.refuse(
                9,
                "DIM1",
                "must begin dimensions of a section",
                "some of them leave no room for others",
            );
            return None;
        }
    };
    let property = Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material: material?,
        area: section.area,
        bending: [section.i1, section.i2],
        j: section.j,
        shear: [section.k1, section.k2],
        nsm,
    };
    Some((id, property))
}

/// Checks that the stations of a PBEAML have the dimensions of its end A.
fn alike(card: &mut Fields<'_, '_>, dimensions: &[f64], nsm: f64) -> Option<()> {
    let count = dimensions.len();
    let last = card.last();
    let mut first = 10 + count;
    while first <= last {
        if !matches!(card.text(first), "" | "YES" | "NO") {
            card.refuse(first, "SO", "must be YES or NO", "");
            return None;
        }
        card.optional(first + 1, "X/XB")?;
        for (k, own) in dimensions.iter().chain([&nsm]).enumerate() {
            let index = first + 2 + k;
            if card.optional(index, "DIM")?.is_some_and(|value| value != *own) {
                card.refuse(
                    index,
                    "DIM",
                    "must be that of end A",
                    "tapered beams cannot be taken: cut them into uniform ones",
                );
                return None;
            }
        }
        first += 3 + count;
    }
    Some(())
}

/// Reads PELAS: one or two springs.
pub fn springs(card: &mut Fields<'_, '_>) -> Vec<(u64, Spot, f64)> {
    let mut springs = Vec::new();
    for first in [1, 5] {
        if first == 5 && card.blank(5) {
            continue;
        }
        let id = card.id(first, "PID");
        let k = card.real(first + 1, "K");
        springs.extend(id.zip(k).map(|(id, k)| (id, card.card.at, k)));
    }
    card.end(9);
    springs
}
