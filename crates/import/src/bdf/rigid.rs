//! Rigid links: RBE2 and RBAR.

use super::field::{Number, number};
use super::fields::CardFields;
use crate::findings::FilePlace;

/// Rigid links from one independent grid to dependent grids.
#[derive(Clone, Debug)]
pub struct Rigid {
    /// Name and number of its card.
    pub label: String,
    /// Number of the independent grid, with the position of its field.
    pub from: (u64, FilePlace),
    /// Numbers of the dependent grids, with the positions of their fields.
    pub to: Vec<(u64, FilePlace)>,
    /// Displacement components of the dependent grids that follow the independent one.
    pub set: [bool; 6],
}

const WHOLE: [bool; 6] = [true; 6];
const PARTIAL: &str = "all degrees of freedom of one end must be independent";

/// Reads RBE2.
pub fn rbe2(card: &mut CardFields<'_, '_>) -> Option<Rigid> {
    card.id(1, "EID")?;
    let from = card.id(2, "GN");
    let fix = card.freedoms(3, "CM")?;
    let mut last = card.last();
    // the last field may be the coefficient of thermal expansion
    if matches!(number(card.text(last)), Some(Number::Real(_))) {
        last -= 1;
    }
    let mut to = Vec::new();
    for index in 4..=last {
        if !card.blank(index) {
            to.push((card.id(index, "GM")?, card.at(index)));
        }
    }
    if fix == [false; 6] {
        card.refuse(3, "CM", "must have at least one component", "");
        return None;
    }
    if to.is_empty() {
        card.refuse(4, "GM1", "is missing", "specify the dependent grids");
        return None;
    }
    Some(Rigid {
        label: card.label(),
        from: (from?, card.at(2)),
        to,
        set: fix,
    })
}

/// Reads RBAR.
pub fn rbar(card: &mut CardFields<'_, '_>) -> Option<Rigid> {
    card.id(1, "EID")?;
    let a = card.id(2, "GA");
    let b = card.id(3, "GB");
    let leads = [(4, "CNA"), (5, "CNB")].map(|(index, name)| card.freedoms(index, name));
    let follows = [(6, "CMA"), (7, "CMB")].map(|(index, name)| card.freedoms(index, name));
    card.end(9);
    let [Some(leads_a), Some(leads_b)] = leads else {
        return None;
    };
    let [Some(follows_a), Some(follows_b)] = follows else {
        return None;
    };
    let none = [false; 6];
    // all degrees of freedom of one end must be independent; blank dependent fields mean all of the other end
    let [leading, following] = match (leads_a == WHOLE, leads_b == WHOLE) {
        (true, false) if leads_b == none && follows_a == none => [a, b],
        (false, true) if leads_a == none && follows_b == none => [b, a],
        _ => {
            card.refuse(
                4,
                "CNA",
                "must be 123456 with CNB blank, or blank with CNB 123456",
                PARTIAL,
            );
            return None;
        }
    };
    let follows = if leads_a == WHOLE {
        follows_b
    } else {
        follows_a
    };
    let set = if follows == none { WHOLE } else { follows };
    let (leading, following) = (leading?, following?);
    if leading == following {
        card.refuse(3, "GB", "must differ from GA", "");
        return None;
    }
    let at = card.at(2);
    Some(Rigid {
        label: card.label(),
        from: (leading, at),
        to: vec![(following, at)],
        set,
    })
}
