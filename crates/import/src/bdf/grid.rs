//! Grids: GRID and GRDSET.

use super::fields::CardFields;
use crate::findings::FilePlace;

/// A grid as its card defines it, in its own coordinate system.
#[derive(Clone, Debug)]
pub struct GridCard {
    /// Position of its card.
    pub card: FilePlace,
    /// Coordinates in the coordinate system `cp`.
    pub at: [f64; 3],
    /// Number of the coordinate system of `at`; `None` if blank.
    pub cp: Option<u64>,
    /// Number of the coordinate system of displacements; `None` if blank.
    pub cd: Option<u64>,
    /// Permanently restrained degrees of freedom; `None` if blank.
    pub fix: Option<[bool; 6]>,
    /// Positions of the fields `cp` and `cd`.
    pub spots: [FilePlace; 2],
}

/// Defaults of GRDSET for blank fields of GRID.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridDefaults {
    /// Number of the coordinate system of coordinates.
    pub cp: u64,
    /// Number of the coordinate system of displacements.
    pub cd: u64,
    /// Permanently restrained degrees of freedom.
    pub fix: [bool; 6],
}

/// Reads GRID.
pub fn grid(card: &mut CardFields<'_, '_>) -> Option<(u64, GridCard)> {
    let id = card.id(1, "ID")?;
    let cp = if card.blank(2) {
        Some(None)
    } else {
        card.whole(2, "CP").map(Some)
    };
    let at = card.vector(3, ["X1", "X2", "X3"]);
    let cd = match card.text(6) {
        "" => Some(None),
        "-1" => {
            card.refuse(6, "CD", "must not be -1", "fluid points are not supported");
            None
        }
        _ => card.whole(6, "CD").map(Some),
    };
    let fix = if card.blank(7) {
        Some(None)
    } else {
        card.freedoms(7, "PS").map(Some)
    };
    card.zero(8, "SEID", "superelements are not supported");
    card.end(9);
    let spots = [card.at(2), card.at(6)];
    Some((
        id,
        GridCard {
            card: card.card.at,
            at: at?,
            cp: cp?,
            cd: cd?,
            fix: fix?,
            spots,
        },
    ))
}

/// Reads GRDSET.
pub fn defaults(card: &mut CardFields<'_, '_>) -> Option<GridDefaults> {
    let cp = card.whole(2, "CP");
    let cd = card.whole(6, "CD");
    let fix = card.freedoms(7, "PS");
    card.zero(8, "SEID", "superelements are not supported");
    card.end(9);
    Some(GridDefaults {
        cp: cp?,
        cd: cd?,
        fix: fix?,
    })
}
