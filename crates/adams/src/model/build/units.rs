//! The factor from mass times acceleration to force in the units of a data set.

use super::super::arguments::Arguments;
use crate::keyword::lookup;
use crate::language::UnitWords;
use crate::{AdamsFault, AdamsForceUnit, AdamsLengthUnit, AdamsMassUnit, ArgumentValue, Error};

/// Newtons of a pound-force, kilograms of a pound, metres of a foot: exact by definition.
const POUND_FORCE: f64 = 4.448_221_615_260_5;
const POUND_MASS: f64 = 0.453_592_37;
const FOOT: f64 = 0.3048;

/// The force, in the unit of a UNITS statement, that gives one unit of mass an acceleration of one unit of
/// length per second squared.
///
/// It is one without UNITS, with SYSTEM=NONE, and where the three units are consistent.
///
/// # Errors
/// [`AdamsFault::Unit`] for an unknown unit or system.
pub(super) fn force_of_mass(arguments: &Arguments<'_>) -> Result<f64, Error> {
    let word = |name: &str| match arguments.statement.get(name) {
        Some(ArgumentValue::Word(word)) => Some(word.clone()),
        _ => None,
    };
    let unknown = || arguments.fault(AdamsFault::Unit);
    if let Some(system) = word("SYSTEM") {
        let systems = &[
            (1.0, "MKS"),
            (1.0, "NONE"),
            (POUND_MASS * FOOT / POUND_FORCE, "FPS"),
            (POUND_MASS * FOOT / 12.0 / POUND_FORCE, "IPS"),
            (0.001, "CGS"),
            (0.001, "MMKS"),
        ];
        return lookup(systems, &system).ok_or_else(unknown);
    }
    let (Some(force), Some(mass), Some(length)) = (word("FORCE"), word("MASS"), word("LENGTH"))
    else {
        return Ok(1.0);
    };
    let newton = match lookup(AdamsForceUnit::ALL, &force).ok_or_else(unknown)? {
        AdamsForceUnit::Newton => 1.0,
        AdamsForceUnit::Kilonewton => 1000.0,
        AdamsForceUnit::Pound => POUND_FORCE,
        AdamsForceUnit::Kilopound => 1000.0 * POUND_FORCE,
    };
    let kilogram = match lookup(AdamsMassUnit::ALL, &mass).ok_or_else(unknown)? {
        AdamsMassUnit::Kilogram => 1.0,
        AdamsMassUnit::Tonne => 1000.0,
        AdamsMassUnit::Pound => POUND_MASS,
        AdamsMassUnit::Slug => POUND_FORCE / FOOT,
        AdamsMassUnit::Slinch => POUND_FORCE / (FOOT / 12.0),
    };
    let meter = match lookup(AdamsLengthUnit::ALL, &length).ok_or_else(unknown)? {
        AdamsLengthUnit::Meter => 1.0,
        AdamsLengthUnit::Millimeter => 0.001,
        AdamsLengthUnit::Foot => FOOT,
        AdamsLengthUnit::Inch => FOOT / 12.0,
    };
    let factor: f64 = kilogram * meter / newton;
    // Slug and foot are consistent with the pound-force by definition; their quotient is not one to the last
    // bit.
    Ok(if (factor - 1.0).abs() < 1e-12 {
        1.0
    } else {
        factor
    })
}
