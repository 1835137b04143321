//! Rails on elastic ties.

use std::sync::Arc;

use fea::CrossSection;

use crate::check::Check;
use crate::scene::raw::{RawStructure, RawTieRail};
use crate::scene::values::structure::{Foundation, Origin};
use crate::spec::ties::{self, Ties, TiesError};
use crate::text::fault::{Fault, number};
use crate::text::place::Place;
use crate::units::Dimension;

/// Default number of elements between two ties if rail or ties have mass.
const ELEMENTS: usize = 2;

/// Reads the member `ties`, which the foundation "ties" requires. `range` is required if the ground carries the rail.
pub(super) fn read(
    raw: &RawStructure,
    needed: bool,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Ties> {
    if raw.ties.is_none() && needed {
        check.faults.require(&raw.ties, at, "ties");
    }
    let given = raw.ties.as_ref()?;
    let at = at.key("ties");
    let spacing = check.required_positive(
        given.spacing,
        &at,
        "spacing",
        Dimension::LENGTH,
        "distance from tie to tie",
    );
    let k = check.required_positive(
        given.k,
        &at,
        "k",
        Dimension::STIFFNESS,
        "stiffness of one tie, force per length",
    );
    let hint = "lateral stiffness of one tie, force per length; leave it out if the rail is laterally fixed";
    let lateral_k = check.optional_positive(
        given.lateral_k,
        &at.key("lateral_k"),
        Dimension::STIFFNESS,
        hint,
    );
    let first = given
        .first
        .map(|first| check.number(first, &at.key("first"), Dimension::LENGTH));
    let mut or_zero = |value: Option<f64>, place: &Place<'_>, dimension, hint| {
        value.map_or(0.0, |value| {
            check.not_negative(value, place, dimension, hint)
        })
    };
    let c = or_zero(
        given.c,
        &at.key("c"),
        Dimension::DAMPING,
        "damping coefficient of one tie, force per speed",
    );
    let mass = or_zero(
        given.mass,
        &at.key("mass"),
        Dimension::MASS,
        "mass of one tie",
    );
    let rail = match check.faults.require(&given.rail, &at, "rail") {
        Some(rail) => read_rail(rail, lateral_k.is_some(), &at.key("rail"), check),
        None => CrossSection {
            e: 1.0,
            iz: 1.0,
            ..CrossSection::default()
        },
    };
    let mut ties = Ties {
        spacing,
        first,
        k,
        lateral_k,
        c,
        mass,
        rail,
        elements: 1,
    };
    if ties.has_mass() {
        ties.elements = raw.elements.unwrap_or(ELEMENTS).max(1);
    }
    Some(ties)
}

fn read_rail(
    raw: &RawTieRail,
    lateral: bool,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> CrossSection {
    let mut or_zero = |value: Option<f64>, key: &str, dimension| {
        check
            .optional_positive(value, &at.key(key), dimension, "")
            .unwrap_or(0.0)
    };
    let area = or_zero(raw.area, "A", Dimension::AREA);
    let g = or_zero(raw.g, "G", Dimension::STRESS);
    let j = or_zero(raw.j, "J", Dimension::SECOND_MOMENT);
    let iy = or_zero(raw.i_lateral, "I_lateral", Dimension::SECOND_MOMENT);
    let e = check.required_positive(raw.e, at, "E", Dimension::STRESS, "");
    let iz = check.required_positive(
        raw.i_vertical,
        at,
        "I_vertical",
        Dimension::SECOND_MOMENT,
        "",
    );
    if raw.i_lateral.is_some() != lateral {
        let key = if lateral { "I_lateral" } else { "lateral_k" };
        let fault = Fault::new(at, format!("missing key `{key}`"));
        check
            .faults
            .add(fault.hint(
                "`I_lateral` of the rail and `lateral_k` of the ties must be given together",
            ));
    }
    let mass = raw.mass_per_length;
    let mass = mass
        .map(|mass| check.not_negative(mass, &at.key("mass_per_length"), Dimension::LINE_MASS, ""));
    CrossSection {
        e,
        g,
        area,
        iy,
        iz,
        j,
        mass: mass.unwrap_or(0.0),
        ..CrossSection::default()
    }
}

/// Builds a rail on ties on the ground.
pub(super) fn on_ground(
    name: &str,
    raw: &RawStructure,
    ties: Option<&Ties>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Origin> {
    let given = *check.faults.require(&raw.range, at, "range")?;
    let place = at.key("range");
    let range = [0, 1].map(|k| check.number(given[k], &place.index(k), Dimension::LENGTH));
    if given[1] <= given[0] {
        let fault = Fault::new(
            &place.index(1),
            format!("must be above {}", number(given[0])),
        );
        check.faults.add(
            fault
                .got(number(given[1]))
                .hint("first and last coordinate of the rail"),
        );
    }
    is_right(check)?;
    match ties::on_ground(name, check.scale.to, ties?, range) {
        Ok(spec) => Some(Origin::Spec {
            file: String::new(),
            spec: Arc::new(spec),
        }),
        Err(refusal) => refuse(refusal, at, check),
    }
}

/// Builds rails on ties on the rails of a structure.
pub(super) fn on_structure(
    origin: Origin,
    raw: &RawStructure,
    ties: Option<&Ties>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Origin> {
    if raw.range.is_some() {
        let fault = Fault::new(&at.key("range"), "`range` cannot be combined with `spec`").at_key();
        check.faults.add(fault.hint(
            "rails on ties above a structure have the same ranges as the rails of the structure",
        ));
    }
    is_right(check)?;
    let Origin::Spec { file, spec } = origin else {
        return None;
    };
    match ties::on_structure(&spec, ties?) {
        Ok(spec) => Some(Origin::Spec {
            file,
            spec: Arc::new(spec),
        }),
        Err(refusal) => refuse(refusal, at, check),
    }
}

/// Returns `Some` if there are no faults so far, because ties can only be positioned with valid numbers.
fn is_right(check: &Check<'_>) -> Option<()> {
    check.faults.0.is_empty().then_some(())
}

fn refuse(refusal: TiesError, at: &Place<'_>, check: &mut Check<'_>) -> Option<Origin> {
    let ties = at.key("ties");
    let (place, hint) = match refusal {
        TiesError::Few { .. } => (
            ties.key("spacing"),
            "the first tie is at `first`, the others follow at distances of `spacing`",
        ),
        TiesError::Many { .. } => (ties.key("spacing"), "shorten the rail or reduce `elements`"),
        TiesError::Hinge { .. } => (ties, "change `first`, the coordinate of the first tie"),
        TiesError::Oblique { .. } | TiesError::Model => (ties, "use the foundation \"influence\""),
    };
    check
        .faults
        .add(Fault::new(&place, refusal.to_string()).hint(hint));
    None
}

/// The simulation model of a rail on ties. Without mass there are no modes and hence no modal damping.
pub(super) fn foundation(
    raw: &RawStructure,
    ties: Option<&Ties>,
    damping: f64,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Foundation {
    let (moves, c) = ties.map_or((false, 0.0), |ties| (ties.has_mass(), ties.c));
    if ties.is_some() && !moves {
        let under = at.key("ties");
        let given = [
            (c > 0.0, under.key("c")),
            (damping > 0.0, at.key("damping")),
        ];
        let others = [
            (raw.modes.is_some(), at.key("modes")),
            (raw.elements.is_some(), at.key("elements")),
        ];
        for (_, place) in given.iter().chain(&others).filter(|(given, _)| *given) {
            let fault = Fault::new(place, "needs a rail or ties with mass").at_key();
            check
                .faults
                .add(fault.hint("give `mass_per_length` of the rail or `mass` of a tie"));
        }
    }
    Foundation::Ties {
        has_mass: moves,
        modes: raw.modes,
        damping,
        c,
    }
}
