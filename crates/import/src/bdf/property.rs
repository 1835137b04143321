//! Properties: PBAR, PBARL, PBEAM, PBEAML, PROD, PTUBE and PELAS.
//!
//! PBAR and PBEAM define areas and second moments directly. PBARL and PBEAML define a shape with dimensions DIM1 to
//! DIMn; `formats` computes the section properties. Second moments with a product I12 are replaced by the principal
//! ones, whose axes are turned against those of the element (see [`principal`]). Bars with I12 are rigid in shear. A
//! beam has values at end A, at intermediate stations and at end B. It must be uniform or vary linearly from end A to
//! end B: the intermediate stations must have the values of end A.

use super::fields::CardFields;
use crate::findings::FilePlace;
use formats::spec::cross_section::{SHAPES, ShapeError, dimensions, section_properties};
use formats::text::fault::nearest;

/// A property of bars, beams or rods.
#[derive(Clone, Debug)]
pub struct Property {
    /// Position of its card.
    pub card: FilePlace,
    /// Name of its card.
    pub kind: String,
    /// Number of its material.
    pub material: u64,
    /// Area; 0 for a bar without axial stiffness.
    pub area: f64,
    /// Second moments of area for bending in planes 1 and 2; both are 0 for rods, one for a bar that bends in the other
    /// plane alone.
    pub bending: [f64; 2],
    /// Torsion constant.
    pub j: f64,
    /// Shear area factors of planes 1 and 2; 0 means rigid in shear.
    pub shear: [f64; 2],
    /// Non-structural mass per length, not yet multiplied by WTMASS.
    pub nsm: f64,
    /// Angle in radians from the y axis of the element to that of `bending[0]`, positive from y to z. Only uniform
    /// sections have one.
    pub turn: f64,
    /// Offset of the neutral axis from the shear centre, along y and z of the element.
    pub neutral: [f64; 2],
    /// Property at end B of a tapered beam, whose properties vary linearly between the ends; `None` if uniform.
    pub end: Option<Box<Property>>,
}

impl Property {
    /// Whether it resists bending in any plane.
    #[must_use]
    pub fn bends(&self) -> bool {
        self.bending
            .iter()
            .any(|second_moment| *second_moment > 0.0)
    }

    /// Its area, or a placeholder of the same order for a bar without axial stiffness.
    #[must_use]
    pub fn area_or_placeholder(&self) -> f64 {
        if self.area > 0.0 {
            self.area
        } else {
            self.bending.iter().copied().fold(self.j, f64::max).sqrt()
        }
    }

    /// Fields of its card without which its members have no axial stiffness, or none to bending in one plane.
    #[must_use]
    pub fn missing(&self) -> Vec<&'static str> {
        let [i1, i2] = self.bending.map(|second_moment| second_moment == 0.0);
        let bends = self.bends();
        let fields = [
            ("A", self.area == 0.0),
            ("I1", bends && i1),
            ("I2", bends && i2),
        ];
        let missing = fields.into_iter().filter(|(_, is_missing)| *is_missing);
        missing.map(|(name, _)| name).collect()
    }
}

const NO_PRODUCT: &str =
    "specify the principal second moments of area, and rotate the orientation of the elements";
const SHEAR: &str =
    "beams with a product of inertia require equal shear factors K1 and K2, or neither";
const RIGID_IN_SHEAR: &str = "a bar with a product of inertia I12 is rigid in shear; use CBEAM with PBEAM or PBEAML \
                              if shear deformation matters";

/// Principal second moments of a section with I1, I2 and the product I12, and the angle from the y axis to the axis of
/// the first of them: tan 2a = 2 I12 / (I1 - I2). `None` if they are not positive.
///
/// With y' = y cos a + z sin a, the integral of y'^2 is I1 cos^2 a + I2 sin^2 a + 2 I12 sin a cos a.
fn principal([i1, i2]: [f64; 2], product: f64) -> Option<([f64; 2], f64)> {
    let mean = 0.5 * (i1 + i2);
    let radius = (0.5 * (i1 - i2)).hypot(product);
    let angle = 0.5 * (2.0 * product).atan2(i1 - i2);
    (mean > radius).then_some(([mean + radius, mean - radius], angle))
}

/// Reads PROD.
pub fn rod(card: &mut CardFields<'_, '_>) -> Option<(u64, Property)> {
    let id = card.id(1, "PID")?;
    Some((id, rod_from(card, 2)?))
}

/// Reads the property of a rod from the fields MID, A, J, C and NSM, which begin at `first` and are the last ones.
pub fn rod_from(card: &mut CardFields<'_, '_>, first: usize) -> Option<Property> {
    let material = card.id(first, "MID");
    let area = positive(card, first + 1, "A");
    let j = card.not_negative(first + 2, "J");
    let nsm = card.not_negative(first + 4, "NSM");
    card.end(first + 5);
    Some(Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material: material?,
        area: area?,
        bending: [0.0; 2],
        j: j?,
        shear: [0.0; 2],
        nsm: nsm?,
        turn: 0.0,
        neutral: [0.0; 2],
        end: None,
    })
}

/// Reads PTUBE, a circular tube for CTUBE.
pub fn tube(card: &mut CardFields<'_, '_>) -> Option<(u64, Property)> {
    let id = card.id(1, "PID")?;
    let material = card.id(2, "MID");
    let outer = positive(card, 3, "OD")?;
    let wall = card.not_negative(4, "T")?;
    let nsm = card.not_negative(5, "NSM");
    if card
        .optional(6, "OD2")?
        .is_some_and(|other| other != outer && other != 0.0)
    {
        card.refuse(
            6,
            "OD2",
            "must be blank or equal to OD",
            "tubes of varying diameter are not supported",
        );
        return None;
    }
    card.end(7);
    if wall > 0.5 * outer {
        card.refuse(
            4,
            "T",
            "must be at most half of OD",
            "a blank T means a solid rod",
        );
        return None;
    }
    let inner = if wall == 0.0 { 0.0 } else { outer - 2.0 * wall };
    let quarter = std::f64::consts::FRAC_PI_4;
    let property = Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material: material?,
        area: quarter * (outer * outer - inner * inner),
        bending: [0.0; 2],
        j: 0.125 * quarter * (outer.powi(4) - inner.powi(4)),
        shear: [0.0; 2],
        nsm: nsm?,
        turn: 0.0,
        neutral: [0.0; 2],
        end: None,
    };
    Some((id, property))
}

/// Reads a required positive real number.
pub fn positive(card: &mut CardFields<'_, '_>, index: usize, name: &str) -> Option<f64> {
    let value = card.real(index, name)?;
    if value <= 0.0 {
        card.refuse(index, name, "must be positive", "");
    }
    (value > 0.0).then_some(value)
}

/// Reads PBAR. K1 and K2 have no effect where I12 is not 0.
///
/// # Source
/// MSC Nastran Quick Reference Guide 2022.4, PBAR, remark 5; NASTRAN-95, `mis/kbar.f`; MYSTRAN, `BAR1.f90`.
pub fn bar(card: &mut CardFields<'_, '_>) -> Option<(u64, Property)> {
    let id = card.id(1, "PID")?;
    let material = card.id(2, "MID");
    let area = card.not_negative(3, "A");
    let bending = [(4, "I1"), (5, "I2")].map(|(index, name)| card.not_negative(index, name));
    let j = card.not_negative(6, "J");
    let nsm = card.not_negative(7, "NSM");
    let shear = [(17, "K1"), (18, "K2")].map(|(index, name)| card.not_negative(index, name));
    let product = card.real_or(19, "I12", 0.0);
    card.end(20);
    let [i1, i2] = bending;
    let [k1, k2] = shear;
    let (product, mut k) = (product?, [k1?, k2?]);
    if product != 0.0 {
        let given = [(17, "K1"), (18, "K2")].into_iter().zip(k);
        for ((index, name), _) in given.filter(|(_, k)| *k > 0.0) {
            let fault = card.fault(index, name, "is ignored, because I12 is not 0");
            card.findings.warn(fault.hint(RIGID_IN_SHEAR));
        }
        k = [0.0; 2];
    }
    let mut property = Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material: material?,
        area: area?,
        bending: [i1?, i2?],
        j: j?,
        shear: k,
        nsm: nsm?,
        turn: 0.0,
        neutral: [0.0; 2],
        end: None,
    };
    if product != 0.0 && !turned(card, 19, product, &mut property) {
        return None;
    }
    if property.area == 0.0 && !property.bends() && property.j == 0.0 {
        card.refuse(3, "A", "must be positive if I1, I2 and J are 0", "");
        return None;
    }
    Some((id, property))
}

/// Replaces second moments with a product of inertia by the principal ones. Returns false, with an error, if this is
/// not possible.
fn turned(
    card: &mut CardFields<'_, '_>,
    index: usize,
    product: f64,
    property: &mut Property,
) -> bool {
    let Some((bending, turn)) = principal(property.bending, product) else {
        card.refuse(
            index,
            "I12",
            "must be less than the square root of I1 I2 in magnitude",
            "",
        );
        return false;
    };
    if property.shear[0] != property.shear[1] {
        card.refuse(index, "I12", "must be 0 if K1 and K2 differ", SHEAR);
        return false;
    }
    (property.bending, property.turn) = (bending, turn);
    true
}

/// Checks that a beam has bending stiffness in both planes or in none.
fn whole(card: &mut CardFields<'_, '_>, property: &Property) -> bool {
    let [i1, i2] = property.bending.map(|value| value > 0.0);
    let hint =
        "specify both second moments of area, or neither for a beam without bending stiffness";
    if i1 != i2 {
        let (index, name) = if i1 { (5, "I2") } else { (4, "I1") };
        card.refuse(
            index,
            name,
            "must be positive if the other second moment of area is",
            hint,
        );
    } else if !i1 && property.j > 0.0 {
        card.refuse(4, "I1", "must be positive if J is", hint);
        return false;
    }
    i1 == i2
}

const STATIONS: &str =
    "only linear variation from end A to end B is supported: divide other beams at their stations";

/// Reads PBEAM, whose properties must vary linearly between the ends.
pub fn beam(card: &mut CardFields<'_, '_>) -> Option<(u64, Property)> {
    let id = card.id(1, "PID")?;
    let material = card.id(2, "MID");
    let own = stiffness(card, 3, None);
    let nsm = card.not_negative(8, "NSM");
    let (own, nsm) = (own?, nsm?);
    let (other, first) = end_b(card, own, nsm)?;
    let shear = [(first + 1, "K1"), (first + 2, "K2")].map(|(index, name)| {
        if card.blank(index) {
            Some(1.0)
        } else {
            card.not_negative(index, name)
        }
    });
    let relief = "shear relief of tapered beams is not supported";
    let relief =
        [(first + 3, "S1"), (first + 4, "S2")].map(|(index, name)| card.zero(index, name, relief));
    let neutral = neutral_axis(card, first + 13);
    let lost = [
        first + 5,
        first + 6,
        first + 9,
        first + 10,
        first + 11,
        first + 12,
    ];
    if let Some(index) = lost
        .into_iter()
        .find(|index| !card.blank(*index) && card.text(*index) != "0.")
    {
        let fault = card.fault(
            index,
            "",
            "the inertia and the offset of the non-structural mass are ignored",
        );
        card.findings.warn(fault);
    }
    card.end(first + 17);
    let [k1, k2] = shear;
    relief.into_iter().collect::<Option<Vec<_>>>()?;
    let (material, shear, neutral) = (material?, [k1?, k2?], neutral?);
    let property = |[area, i1, i2, j, _]: [f64; 5]| Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material,
        area,
        bending: [i1, i2],
        j,
        shear,
        nsm,
        turn: 0.0,
        neutral,
        end: None,
    };
    let mut result = property(own);
    result.end = (other != own).then(|| Box::new(property(other)));
    if own[4] != 0.0 {
        if result.end.is_some() {
            card.refuse(6, "I12", "must be 0 if the beam is tapered", NO_PRODUCT);
            return None;
        }
        if !turned(card, 6, own[4], &mut result) {
            return None;
        }
    }
    if result.end.is_some() && neutral != [0.0; 2] {
        card.refuse(
            first + 13,
            "N1",
            "must be 0 if the beam is tapered",
            STATIONS,
        );
        return None;
    }
    let is_positive =
        result.end.is_none() || own[..4].iter().chain(&other[..4]).all(|value| *value > 0.0);
    if !is_positive {
        card.refuse(
            3,
            "A",
            "must be positive at both ends of a tapered beam, as must I1, I2 and J",
            "",
        );
    }
    (is_positive && spread(card, &result, 8) && whole(card, &result)).then_some((id, result))
}

/// Reads N1 and N2 of both ends of a PBEAM, the offset of the neutral axis, which must be the same at both ends. Blank
/// fields of end B have the values of end A.
fn neutral_axis(card: &mut CardFields<'_, '_>, first: usize) -> Option<[f64; 2]> {
    let a = [
        card.real_or(first, "N1(A)", 0.0)?,
        card.real_or(first + 1, "N2(A)", 0.0)?,
    ];
    let b = [
        card.real_or(first + 2, "N1(B)", a[0])?,
        card.real_or(first + 3, "N2(B)", a[1])?,
    ];
    if a != b {
        let hint = "the neutral axis must be parallel to the axis of shear centres";
        card.refuse(
            first + 2,
            "N1(B)",
            "must be equal to N1(A), and N2(B) to N2(A)",
            hint,
        );
    }
    (a == b).then_some(a)
}

/// Reads the stations of a PBEAM. Returns A, I1, I2 and J at end B, and the number of fields before the first field
/// that follows the stations. `own` and `nsm` are the values at end A.
fn end_b(card: &mut CardFields<'_, '_>, own: [f64; 5], nsm: f64) -> Option<([f64; 5], usize)> {
    let rows = card.card.fields.len().div_ceil(8);
    let station = |card: &CardFields<'_, '_>, row: usize| {
        matches!(card.text(8 * row + 1), "YES" | "YESA" | "NO")
    };
    let blank =
        |card: &CardFields<'_, '_>, row: usize| (1..=8).all(|field| card.blank(8 * row + field));
    // the second row contains stress recovery points, unless it is already a station
    let mut row = if station(card, 1) { 1 } else { 2 };
    let mut other = own;
    while row < rows && station(card, row) {
        let first = 8 * row;
        let x = card.real(first + 2, "X/XB")?;
        let values = stiffness(card, first + 3, Some(own))?;
        if card
            .optional(first + 8, "NSM")?
            .is_some_and(|value| value != nsm)
        {
            let hint = "the non-structural mass must be uniform";
            card.refuse(
                first + 8,
                "NSM",
                "must be equal to the value at end A",
                hint,
            );
            return None;
        }
        if x == 1.0 {
            other = values;
        } else if values != own {
            card.refuse(
                first + 2,
                "X/XB",
                "must be 1. if the beam is tapered",
                STATIONS,
            );
            return None;
        }
        row += if card.text(first + 1) == "YES" || (row + 1 < rows && blank(card, row + 1)) {
            2
        } else {
            1
        };
    }
    Some((other, 8 * row))
}

/// Reads the consecutive fields A, I1, I2, I12 and J, and returns A, I1, I2, J and I12. Blank fields have the values of
/// `own`.
fn stiffness(
    card: &mut CardFields<'_, '_>,
    first: usize,
    own: Option<[f64; 5]>,
) -> Option<[f64; 5]> {
    let mut number = |index: usize, name: &str, k: usize| match own {
        Some(own) if card.blank(index) => Some(own[k]),
        _ if k == 0 => positive(card, index, name),
        _ if k == 4 => card.real_or(index, name, 0.0),
        _ => card.not_negative(index, name),
    };
    let values = [
        number(first, "A", 0),
        number(first + 1, "I1", 1),
        number(first + 2, "I2", 2),
        number(first + 4, "J", 3),
        number(first + 3, "I12", 4),
    ];
    let [a, i1, i2, j, product] = values;
    Some([a?, i1?, i2?, j?, product?])
}

/// Reads PBARL or PBEAML: a shape with its dimensions, for PBEAML at both ends of the beam.
pub fn shaped(card: &mut CardFields<'_, '_>) -> Option<(u64, Property)> {
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
            None => format!(
                "known: {}; specify others by PBAR or PBEAM",
                known.join(", ")
            ),
        };
        card.refuse(4, "TYPE", "is not a supported section type", &hint);
        return None;
    };
    let mut dimensions = Vec::new();
    for k in 0..count {
        dimensions.push(card.real(9 + k, &format!("DIM{}", k + 1))?);
    }
    let nsm = card.not_negative(9 + count, "NSM")?;
    let other = if card.card.name == "PBARL" {
        card.end(10 + count);
        None
    } else {
        stations(card, &dimensions, nsm)?
    };
    let material = material?;
    let mut property = section(card, &shape, &dimensions, material, nsm)?;
    if card.card.name == "PBARL" && property.turn != 0.0 {
        // the PBAR that NASTRAN makes of it has I12
        property.shear = [0.0; 2];
        let fault = card.fault(
            4,
            "TYPE",
            "has a product of inertia: its members are rigid in shear",
        );
        card.findings.warn(fault.hint(RIGID_IN_SHEAR));
    }
    if let Some(other) = other {
        let end = section(card, &shape, &other, material, nsm)?;
        if property.turn != 0.0 || end.turn != 0.0 {
            card.refuse(
                4,
                "TYPE",
                "must have its principal axes along y and z if the beam is tapered",
                NO_PRODUCT,
            );
            return None;
        }
        property.end = Some(Box::new(end));
    }
    if card.card.name == "PBEAML"
        && ![
            "ROD", "TUBE", "TUBE2", "BAR", "BOX", "H", "I1", "CROSS", "Z",
        ]
        .contains(&shape.as_str())
    {
        let message = "the shear centre is assumed at the centroid, as for PBARL";
        let fault = card.fault(4, "TYPE", message);
        card.findings.warn(
            fault.hint("use PBEAM with N1 and N2 if the distance between them is significant"),
        );
    }
    spread(card, &property, 9 + count).then_some((id, property))
}

/// Checks that non-structural mass can be converted to a density, for which the area must be constant.
fn spread(card: &mut CardFields<'_, '_>, property: &Property, index: usize) -> bool {
    let varies = property
        .end
        .as_ref()
        .is_some_and(|end| end.area != property.area);
    if varies && property.nsm > 0.0 {
        let hint = "specify the non-structural mass by CONM2";
        card.refuse(
            index,
            "NSM",
            "must be 0 if the area of the beam varies",
            hint,
        );
    }
    !varies || property.nsm == 0.0
}

/// Computes the property of a shape from its dimensions; adds an error if the dimensions do not form a section.
fn section(
    card: &mut CardFields<'_, '_>,
    shape: &str,
    dimensions: &[f64],
    material: u64,
    nsm: f64,
) -> Option<Property> {
    let section = match section_properties(shape, dimensions) {
        Ok(section) => section,
        Err(ShapeError::Dimensions | ShapeError::Unknown) => {
            let hint = "dimensions must be positive, and plates must not overlap";
            card.refuse(9, "dimensions", "must form a valid section", hint);
            return None;
        }
    };
    Some(Property {
        card: card.card.at,
        kind: card.card.name.clone(),
        material,
        area: section.area,
        bending: [section.i1, section.i2],
        j: section.j,
        shear: [section.k1, section.k2],
        nsm,
        turn: section.turn,
        neutral: [0.0; 2],
        end: None,
    })
}

/// Reads the stations of a PBEAML and returns the dimensions at end B, or `Some(None)` if they are those at end A.
/// Intermediate stations must have the dimensions of end A.
fn stations(
    card: &mut CardFields<'_, '_>,
    dimensions: &[f64],
    nsm: f64,
) -> Option<Option<Vec<f64>>> {
    let count = dimensions.len();
    let last = card.last();
    let mut first = 10 + count;
    let mut other = None;
    while first <= last {
        if !matches!(card.text(first), "" | "YES" | "NO") {
            card.refuse(first, "SO", "must be YES or NO", "");
            return None;
        }
        let x = card.real_or(first + 1, "X/XB", 1.0)?;
        let mut here = Vec::new();
        for (k, own) in dimensions.iter().enumerate() {
            here.push(card.real_or(first + 2 + k, &format!("DIM{}", k + 1), *own)?);
        }
        if card
            .optional(first + 2 + count, "NSM")?
            .is_some_and(|value| value != nsm)
        {
            card.refuse(
                first + 2 + count,
                "NSM",
                "must be equal to the value at end A",
                "the non-structural mass must be uniform",
            );
            return None;
        }
        if here != dimensions {
            if x != 1.0 {
                card.refuse(
                    first + 1,
                    "X/XB",
                    "must be 1. if the beam is tapered",
                    STATIONS,
                );
                return None;
            }
            other = Some(here);
        }
        first += 3 + count;
    }
    Some(other)
}

/// Reads PELAS, which defines the stiffnesses of one or two springs.
pub fn springs(card: &mut CardFields<'_, '_>) -> Vec<(u64, FilePlace, f64)> {
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
