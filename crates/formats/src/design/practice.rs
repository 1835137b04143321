//! The member `practice` of a design: the code and what its rows need of the crane.

use practice::aist::CraneKind;
use practice::asce::CraneOperation;
use practice::factor::DriveOnset;
use practice::limit_choice::{code_name, limits_of};

use super::raw::RawDesignPractice;
use super::values::DesignPractice;
use crate::check::Check;
use crate::own_limits;
use crate::practice_words::{
    ASCE_7, DRIVES, FASTENINGS, HOISTING, KINDS, LATERAL_SECTIONS, OPERATIONS, RELEASE, codes,
    fatigue_classes,
};
use crate::text::fault::Fault;
use crate::text::names::resolve;
use crate::text::place::Place;
use crate::units::{Dimension, Scale, Units};

/// Reads the member; `units` are those of the file.
pub(super) fn read(
    raw: &RawDesignPractice,
    units: Units,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> DesignPractice {
    let mut limits = limits(raw, at, check);
    if let Some(own) = &raw.limits {
        limits.extend(own_limits::read(own, units, &at.key("limits"), check));
    }
    let histories = fatigue_classes();
    let faults = &mut *check.faults;
    let s_class = raw
        .s_class
        .as_ref()
        .and_then(|word| faults.one_of(word, &at.key("s_class"), &histories)?);
    let kind = raw
        .kind
        .as_ref()
        .and_then(|word| faults.one_of(word, &at.key("kind"), &KINDS));
    let operation = raw
        .operation
        .as_ref()
        .and_then(|word| faults.one_of(word, &at.key("operation"), &OPERATIONS));
    let hoisting = raw
        .hoisting
        .as_ref()
        .and_then(|word| faults.one_of(word, &at.key("hoisting"), &HOISTING));
    let drives = raw
        .drives
        .as_ref()
        .and_then(|word| faults.one_of(word, &at.key("drives"), &DRIVES));
    let release = raw
        .release
        .as_ref()
        .and_then(|word| faults.one_of(word, &at.key("release"), &RELEASE));
    let lateral_section = raw
        .lateral_section
        .as_ref()
        .and_then(|word| faults.one_of(word, &at.key("lateral_section"), &LATERAL_SECTIONS));
    let rail_fastening = raw
        .rail_fastening
        .as_ref()
        .and_then(|word| faults.one_of(word, &at.key("rail_fastening"), &FASTENINGS));
    let speed = check.optional_positive(
        raw.hoist_speed,
        &at.key("hoist_speed"),
        Dimension::SPEED,
        "rated speed",
    );
    let metric = Scale {
        from: units,
        to: Units::SI,
    }
    .factor(Dimension::SPEED);
    let combinations = raw.combinations.unwrap_or(false);
    if combinations && raw.code.is_none() {
        let fault = Fault::new(
            &at.key("combinations"),
            "requires a design code, which defines the load groups",
        );
        check.faults.add(
            fault
                .of_value()
                .hint("specify `code`, such as \"EN 1991-3\", \"ASCE 7\" or \"AIST TR-13\""),
        );
    }
    DesignPractice {
        code: raw.code.clone(),
        limits,
        s_class,
        kind: kind.unwrap_or(CraneKind::Mill),
        operation: operation.unwrap_or(CraneOperation::Cab),
        hoisting,
        drives: drives.unwrap_or(DriveOnset::Smooth),
        release,
        hoist_speed: speed.map(|speed| speed * metric),
        lateral_section: lateral_section.unwrap_or_default(),
        rail_fastening,
        combinations,
    }
}

/// Limits of deflections of the code.
fn limits(
    raw: &RawDesignPractice,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<practice::limits::DeflectionLimit> {
    let Some(code) = &raw.code else {
        return Vec::new();
    };
    let name = code_name(code);
    let known = codes();
    if resolve(name, &known, "code", &at.key("code"), check.faults).is_none() || name == ASCE_7 {
        return Vec::new();
    }
    let is_mill = name == "AIST TR-13";
    let (class, key) = if is_mill {
        (&raw.building_class, "building_class")
    } else {
        (&raw.class, "class")
    };
    if let Some(limits) = limits_of(name, class.as_deref()) {
        return limits;
    }
    let allowed = match name {
        "AIST TR-13" => "\"A\", \"B\", \"C\" or \"D\" (mill building)",
        "IS 800" => "\"manual\", \"electric\" (up to 50 t) or \"heavy\" (electric, above 50 t)",
        _ => "\"A\" to \"F\" (service class of CMAA 70)",
    };
    match class {
        Some(class) => {
            let fault = Fault::new(&at.key(key), "must be a class of the code")
                .of_value()
                .got(format!("\"{class}\""));
            check
                .faults
                .add(fault.hint(format!("classes of {name}: {allowed}")));
        }
        None => {
            let fault = Fault::new(at, format!("missing key `{key}`"));
            check
                .faults
                .add(fault.hint(format!("limits of {name} depend on the class: {allowed}")));
        }
    }
    Vec::new()
}
