//! Words of results.

use practice::clause::CodeClause;
use serde_json::{Value, json};
use trains::{GirderResponse, SectionSide};

/// Word of a quantity: `moment`, `shear`, `normal`, `torsion` or `deflection`.
#[must_use]
pub const fn quantity_word(quantity: GirderResponse) -> &'static str {
    match quantity {
        GirderResponse::Normal => "normal",
        GirderResponse::Torsion => "torsion",
        GirderResponse::VerticalShear | GirderResponse::LateralShear => "shear",
        GirderResponse::VerticalMoment | GirderResponse::LateralMoment => "moment",
        GirderResponse::VerticalDeflection | GirderResponse::LateralDeflection => "deflection",
    }
}

/// Word of the plane of a quantity; normal force and torsion belong to neither plane and are listed with the vertical
/// one.
#[must_use]
pub const fn plane_word(quantity: GirderResponse) -> &'static str {
    match quantity {
        GirderResponse::LateralShear
        | GirderResponse::LateralMoment
        | GirderResponse::LateralDeflection => "lateral",
        _ => "vertical",
    }
}

/// Word of the side of a section: `-`, `at` or `+`.
#[must_use]
pub const fn side_word(side: SectionSide) -> &'static str {
    match side {
        SectionSide::Before => "-",
        SectionSide::At => "at",
        SectionSide::Behind => "+",
    }
}

/// `max` or `min`.
pub(crate) const fn kind_word(is_max: bool) -> &'static str {
    if is_max { "max" } else { "min" }
}

/// Code, edition, clause and source of a value as members of a summary.
#[must_use]
pub fn clause_json(clause: &CodeClause) -> Value {
    json!({
        "code": clause.standard,
        "edition": clause.edition,
        "clause": clause.clause,
        "source": clause.evidence.words(),
    })
}
