//! Concentrated masses and springs at grids: CONM2, CELAS1 and CELAS2.

use super::field::{Number, number};
use super::fields::CardFields;
use crate::findings::FilePlace;

/// A concentrated mass at a grid, not yet multiplied by WTMASS.
#[derive(Clone, Debug)]
pub struct MassCard {
    /// Position of the field that names its grid.
    pub at: FilePlace,
    /// Name and number of its card.
    pub label: String,
    /// Number of its grid.
    pub grid: u64,
    /// Mass.
    pub mass: f64,
    /// Inertia about the centre of mass, in the axes of `system`.
    pub inertia: [[f64; 3]; 3],
    /// Number of the coordinate system of inertia and offset, 0 for the basic one.
    pub system: u64,
    /// Vector to the centre of mass from the grid, or from the global origin if `absolute`.
    pub offset: [f64; 3],
    /// Whether `offset` is measured from the global origin.
    pub absolute: bool,
}

/// A spring between two degrees of freedom of grids, or between one of them and ground.
#[derive(Clone, Debug)]
pub struct SpringCard {
    /// Position of its card.
    pub card: FilePlace,
    /// Name and number of its card.
    pub label: String,
    /// Its stiffness, or the number of the PELAS card that defines it.
    pub stiffness: Stiffness,
    /// Grid and index of the degree of freedom at each end; `None` is ground.
    pub ends: [Option<(u64, usize)>; 2],
}

/// The stiffness of a spring.
#[derive(Clone, Copy, Debug)]
pub enum Stiffness {
    /// A stiffness on the card of the spring (CELAS2).
    Own(f64),
    /// The number of a PELAS card (CELAS1).
    Number(u64),
}

/// Reads CONM2.
pub fn mass(card: &mut CardFields<'_, '_>) -> Option<MassCard> {
    card.id(1, "EID")?;
    let grid = card.id(2, "G");
    let absolute = card.text(3) == "-1";
    let system = if absolute {
        Some(0)
    } else {
        card.whole(3, "CID")
    };
    let mass = card.not_negative(4, "M");
    let offset = card.vector(5, ["X1", "X2", "X3"]);
    let moments =
        [(9, "I11"), (11, "I22"), (14, "I33")].map(|(index, name)| card.not_negative(index, name));
    let products =
        [(10, "I21"), (12, "I31"), (13, "I32")].map(|(index, name)| card.real_or(index, name, 0.0));
    card.end(15);
    let ([Some(x), Some(y), Some(z)], [Some(yx), Some(zx), Some(zy)]) = (moments, products) else {
        return None;
    };
    Some(MassCard {
        at: card.at(2),
        label: card.label(),
        grid: grid?,
        mass: mass?,
        // the products of the card are integrals, which have the opposite sign in the inertia matrix
        inertia: [[x, -yx, -zx], [-yx, y, -zy], [-zx, -zy, z]],
        system: system?,
        offset: offset?,
        absolute,
    })
}

/// Reads CELAS1 or CELAS2.
pub fn spring(card: &mut CardFields<'_, '_>) -> Option<SpringCard> {
    let id = card.id(1, "EID")?;
    let stiffness = if card.card.name == "CELAS1" {
        card.id_or(2, "PID", id).map(Stiffness::Number)
    } else {
        card.real(2, "K").map(Stiffness::Own)
    };
    let mut ends = [None; 2];
    for (end, first) in [3, 5].into_iter().enumerate() {
        if card.blank(first) || number(card.text(first)) == Some(Number::Integer(0)) {
            continue;
        }
        let grid = card.id(first, "G")?;
        let dof = match number(card.text(first + 1)) {
            Some(Number::Integer(c @ 1..=6)) => usize::try_from(c - 1).ok(),
            _ => None,
        };
        let Some(dof) = dof else {
            let hint = match card.text(first + 1) {
                "" | "0" => {
                    "a component that is 0 or blank belongs to a scalar point, which is not supported"
                }
                _ => "",
            };
            card.refuse(first + 1, "C", "must be a single digit from 1 to 6", hint);
            return None;
        };
        ends[end] = Some((grid, dof));
    }
    card.end(9);
    if ends == [None; 2] {
        card.refuse(
            3,
            "G1",
            "is missing",
            "a spring must be connected to at least one grid",
        );
        return None;
    }
    Some(SpringCard {
        card: card.card.at,
        label: card.label(),
        stiffness: stiffness?,
        ends,
    })
}
