//! From mass times acceleration to force.

use super::fields::Fields;
use crate::units::Keyword;
use crate::units::lookup;
use crate::{Error, Fault, Force, Length, Mass, Statement, Value};

/// N of a pound-force, kg of a pound, m of a foot: exact by definition.
const POUND_FORCE: f64 = 4.448_221_615_260_5;
const POUND_MASS: f64 = 0.453_592_37;
const FOOT: f64 = 0.3048;

/// Forces of the UNITS statement in one unit of mass times its unit of length per second squared; one without
/// UNITS, with SYSTEM=NONE, and where the three agree by definition.
pub(super) fn factor(statement: &Statement) -> Result<f64, Error> {
    let fields = Fields { statement };
    let word = |name: &str| match statement.get(name) {
        Some(Value::Word(word)) => Some(word.clone()),
        _ => None,
    };
    if let Some(system) = word("SYSTEM") {
        let systems = &[
            (1.0, "MKS"),
            (1.0, "NONE"),
            (POUND_MASS * FOOT / POUND_FORCE, "FPS"),
            (POUND_MASS * FOOT / 12.0 / POUND_FORCE, "IPS"),
            (0.001, "CGS"),
            (0.001, "MMKS"),
        ];
        return lookup(systems, &system).ok_or_else(|| fields.fault(Fault::Unit));
    }
    let (Some(force), Some(mass), Some(length)) = (word("FORCE"), word("MASS"), word("LENGTH")) else {
        return Ok(1.0);
    };
    let unknown = || fields.fault(Fault::Unit);
    let force = lookup(Force::ALL, &force).ok_or_else(unknown)?;
    let mass = lookup(Mass::ALL, &mass).ok_or_else(unknown)?;
    let length = lookup(Length::ALL, &length).ok_or_else(unknown)?;
    let newton = match force {
        Force::Newton => 1.0,
        Force::Kilonewton => 1000.0,
        Force::Pound => POUND_FORCE,
        Force::Kilopound => 1000.0 * POUND_FORCE,
    };
    let kilogram = match mass {
        Mass::Kilogram => 1.0,
        Mass::Tonne => 1000.0,
        Mass::Pound => POUND_MASS,
        Mass::Slug => POUND_FORCE / FOOT,
        Mass::Slinch => POUND_FORCE / (FOOT / 12.0),
    };
    let meter = match length {
        Length::Meter => 1.0,
        Length::Millimeter => 0.001,
        Length::Foot => FOOT,
        Length::Inch => FOOT / 12.0,
    };
    let factor: f64 = kilogram * meter / newton;
    Ok(if (factor - 1.0).abs() < 1e-12 { 1.0 } else { factor })
}
