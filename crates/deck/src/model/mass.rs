//! Masses of a deck in the mass unit that its UNITS statement names.

use formats::units::{Dimension, Force, Length, Scale, Units};

/// Pounds of mass in a kilogram's place: 0.45359237 kg, as whole numbers of 1e-8 kg.
const POUND: u128 = 45_359_237;
const KILOGRAM: u128 = 100_000_000;

/// The scene's unit of mass, force time^2 / length, in the unit of [`Units::to_adams`].
///
/// ADAMS computes F UCF = M a from the units it is told; with masses in that unit F = m a holds in the units of
/// the scene: 1 lbf s^2/ft = 1 slug, 1 lbf s^2/in = 386.0886 lb, 1 N s^2/mm = 1000 kg. Relative error below
/// 4e-16.
#[must_use]
pub fn factor(units: Units) -> f64 {
    match units.to_adams().mass {
        adams::AdamsMassUnit::Slug => {
            let slugs = Units { length: Length::Foot, force: Force::Pound };
            Scale { from: units, to: slugs }.factor(Dimension::MASS)
        }
        adams::AdamsMassUnit::Pound => {
            let kilograms = Scale { from: units, to: Units::SI }.factor(Dimension::MASS);
            kilograms * (KILOGRAM as f64) / (POUND as f64)
        }
        _ => Scale { from: units, to: Units::SI }.factor(Dimension::MASS),
    }
}

#[cfg(test)]
mod tests {
    use super::factor;
    use formats::units::{Force, Length, Units};

    #[test]
    fn masses_are_those_of_their_definitions() {
        // 1 lbf = 0.45359237 kg x 9.80665 m/s^2; 1 in = 0.0254 m
        for (length, force, expected) in [
            (Length::Foot, Force::Pound, 1.0),
            (Length::Foot, Force::Kip, 1000.0),
            (Length::Foot, Force::Newton, 1.0 / 4.448_221_615_260_5),
            (Length::Inch, Force::Pound, 9.80665 / 0.0254),
            (Length::Inch, Force::Kip, 9806.65 / 0.0254),
            (Length::Metre, Force::Newton, 1.0),
            (Length::Metre, Force::Kilonewton, 1e3),
            (Length::Millimetre, Force::Newton, 1e3),
            (Length::Millimetre, Force::Kilonewton, 1e6),
            (Length::Metre, Force::Pound, 4.448_221_615_260_5),
        ] {
            let found = factor(Units { length, force });
            assert!((found / expected - 1.0).abs() < 8e-16, "{length:?} {force:?}: {found} {expected}");
        }
    }
}
