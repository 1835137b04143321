//! Isotropic materials: MAT1.

use super::fields::CardFields;
use crate::findings::FilePlace;

/// An isotropic linear elastic material.
#[derive(Clone, Debug)]
pub struct MaterialCard {
    /// Position of its card.
    pub card: FilePlace,
    /// Young's modulus.
    pub e: f64,
    /// Shear modulus; `None` if the card defines neither G nor NU.
    pub g: Option<f64>,
    /// Mass per volume, not yet multiplied by WTMASS.
    pub density: f64,
}

/// Reads MAT1. A missing modulus is computed from the other one and NU: E = 2 (1 + NU) G. Beside both of them NU has no
/// effect on members.
pub fn material(card: &mut CardFields<'_, '_>) -> Option<(u64, MaterialCard)> {
    let id = card.id(1, "MID")?;
    let e = card.optional(2, "E");
    let g = card.optional(3, "G");
    let nu = card.optional(4, "NU");
    let density = card.not_negative(5, "RHO");
    let (e, g, nu, density) = (e?, g?, nu?, density?);
    for (index, name, value) in [(2, "E", e), (3, "G", g)] {
        if value.is_some_and(|value| value <= 0.0) {
            card.refuse(
                index,
                name,
                "must be positive",
                "leave it blank if the other two of E, G and NU are specified",
            );
            return None;
        }
    }
    if nu.is_some_and(|nu| !(nu > -1.0 && nu <= 0.5)) {
        let expected = "must be greater than -1 and at most 0.5";
        if e.is_none() || g.is_none() {
            card.refuse(4, "NU", expected, "");
            return None;
        }
        let fault = card.fault(4, "NU", format!("{expected}; it is ignored"));
        card.findings
            .warn(fault.hint("E and G are used as they are"));
    }
    let ratio = |nu: f64| 2.0 * (1.0 + nu);
    let (e, g) = match (e, g, nu) {
        (Some(e), Some(g), _) => (e, Some(g)),
        (Some(e), None, Some(nu)) => (e, Some(e / ratio(nu))),
        (Some(e), None, None) => (e, None),
        (None, Some(g), Some(nu)) => (ratio(nu) * g, Some(g)),
        (None, ..) => {
            card.refuse(2, "E", "is missing", "specify E, or G and NU");
            return None;
        }
    };
    let finite = e.is_finite() && g.is_none_or(|g| g.is_finite() && g > 0.0);
    if !finite {
        card.refuse(
            2,
            "E",
            "must give moduli within the range of double precision",
            "",
        );
    }
    finite.then_some((
        id,
        MaterialCard {
            card: card.card.at,
            e,
            g,
            density,
        },
    ))
}
