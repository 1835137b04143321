//! Wheel types: radius, contact laws, friction, spin.

use crate::check::Check;
use crate::scene::raw::{RawFriction, RawLateral, RawVertical, RawWheel};
use crate::scene::values::wheel::{
    DEFAULT_IMPACT_EXPONENT, DamperVelocity, FlangeContact, Friction, FrictionLaw, NormalForceLaw,
    TreadContact, WheelKind,
};
use crate::text::fault::{Fault, number};
use crate::text::place::Place;
use crate::units::Dimension;

pub(super) fn read(name: &str, raw: &RawWheel, at: &Place<'_>, check: &mut Check<'_>) -> WheelKind {
    let radius = check.required_positive(raw.radius, at, "radius", Dimension::LENGTH, "");
    let vertical = match check.faults.require(&raw.vertical, at, "vertical") {
        Some(vertical) => read_vertical(vertical, &at.key("vertical"), check),
        None => TreadContact {
            law: NormalForceLaw::Linear,
            k: 1.0,
            c: 0.0,
            damper: DamperVelocity::Rail,
            bilateral: false,
        },
    };
    let lateral = raw
        .lateral
        .as_ref()
        .map(|lateral| read_lateral(lateral, &at.key("lateral"), check));
    let friction = raw
        .friction
        .as_ref()
        .map(|friction| read_friction(friction, &at.key("friction"), check));
    let spin_inertia = check.optional_positive(
        raw.spin_inertia,
        &at.key("spin_inertia"),
        Dimension::INERTIA,
        "leave it out for a wheel without inertia",
    );
    WheelKind {
        name: name.to_owned(),
        radius,
        vertical,
        lateral,
        friction,
        spin_inertia,
        driven: raw.driven,
        braked: raw.braked,
    }
}

fn read_vertical(raw: &RawVertical, at: &Place<'_>, check: &mut Check<'_>) -> TreadContact {
    let impact = match &raw.law {
        Some(word) => check
            .faults
            .one_of(word, &at.key("law"), &[("linear", false), ("impact", true)])
            .unwrap_or(false),
        None => false,
    };
    let exponent = if impact {
        raw.exponent.unwrap_or(DEFAULT_IMPACT_EXPONENT)
    } else {
        1.0
    };
    if impact && exponent < 1.0 {
        let fault = Fault::new(&at.key("exponent"), "must be at least 1")
            .got(number(exponent))
            .of_value();
        check
            .faults
            .add(fault.hint("below 1 the contact would be infinitely stiff at first touch"));
    }
    let k = match check.faults.require(&raw.k, at, "k") {
        Some(k) => {
            let place = at.key("k");
            check.positive(*k, &place, Dimension::NUMBER, "");
            let factor = check.scale.power_law(exponent.max(1.0));
            check.scaled(*k, &place, factor)
        }
        None => 1.0,
    };
    let c = check.not_negative(
        raw.c.unwrap_or_default(),
        &at.key("c"),
        Dimension::DAMPING,
        "0 for none",
    );
    let law = if impact {
        let depth = match raw.depth {
            None if c == 0.0 => 1.0,
            depth => check.required_positive(
                depth,
                at,
                "depth",
                Dimension::LENGTH,
                "penetration at which the damping coefficient is c",
            ),
        };
        NormalForceLaw::Impact { exponent, depth }
    } else {
        for (key, given) in [
            ("exponent", raw.exponent.is_some()),
            ("depth", raw.depth.is_some()),
        ] {
            if given {
                let fault = Fault::new(
                    &at.key(key),
                    format!("`{key}` is only available with the law \"impact\""),
                )
                .at_key();
                check
                    .faults
                    .add(fault.hint("set \"law\": \"impact\" or leave it out"));
            }
        }
        NormalForceLaw::Linear
    };
    let dampers = [
        ("rail", DamperVelocity::Rail),
        ("ground", DamperVelocity::Ground),
    ];
    let damper = match &raw.damper {
        Some(word) => check
            .faults
            .one_of(word, &at.key("damper"), &dampers)
            .unwrap_or(DamperVelocity::Rail),
        None => DamperVelocity::Rail,
    };
    TreadContact {
        law,
        k,
        c,
        damper,
        bilateral: raw.bilateral.unwrap_or_default(),
    }
}

fn read_lateral(raw: &RawLateral, at: &Place<'_>, check: &mut Check<'_>) -> FlangeContact {
    let k = check.required_positive(raw.k, at, "k", Dimension::STIFFNESS, "");
    let clearance = raw.clearance.unwrap_or_default();
    let clearance = check.not_negative(
        clearance,
        &at.key("clearance"),
        Dimension::LENGTH,
        "0 for none",
    );
    let place = at.key("release");
    let release = raw.release.map(|heights| {
        check.faults.increasing(&heights, &place);
        let hint = "heights of the wheel's centre above the rail";
        let mut converted = [0.0; 2];
        for (index, height) in heights.into_iter().enumerate() {
            converted[index] = check.positive(height, &place.index(index), Dimension::LENGTH, hint);
        }
        converted
    });
    FlangeContact {
        k,
        clearance,
        release,
    }
}

fn read_friction(raw: &RawFriction, at: &Place<'_>, check: &mut Check<'_>) -> Friction {
    let laws = [
        ("step", FrictionLaw::Step),
        ("coulomb", FrictionLaw::Coulomb),
    ];
    let given = raw
        .law
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("law"), &laws));
    let law = given.unwrap_or(FrictionLaw::Step);
    Friction {
        law,
        mu: check.required_positive(
            raw.mu,
            at,
            "mu",
            Dimension::NUMBER,
            "leave `friction` out for a wheel without friction",
        ),
        slip: check.required_positive(
            raw.slip,
            at,
            "slip",
            Dimension::SPEED,
            match law {
                FrictionLaw::Step => "sliding speed at which friction reaches mu N",
                FrictionLaw::Coulomb => "sliding speed at which friction is 76 % of mu N",
            },
        ),
    }
}
