//! Checks of single numbers with conversion of their units.

use crate::text::fault::{Fault, Faults, number};
use crate::text::place::Place;
use crate::units::{Dimension, Scale};

/// Checks numbers as they are written in a file and converts them.
///
/// A number that fails is converted nevertheless so that checking can continue; the caller stops if there are faults.
#[derive(Debug)]
pub struct Check<'f> {
    /// All faults so far.
    pub faults: &'f mut Faults,
    /// Conversion from the units of the file to the target units.
    pub scale: Scale,
}

impl Check<'_> {
    /// Any finite number.
    pub fn number(&mut self, value: f64, place: &Place<'_>, dimension: Dimension) -> f64 {
        self.scaled(value, place, self.scale.factor(dimension))
    }

    /// Multiplies a number by a factor. The product must be finite, and must not underflow to zero.
    pub fn scaled(&mut self, value: f64, place: &Place<'_>, factor: f64) -> f64 {
        let converted = value * factor;
        if !converted.is_finite() || (value != 0.0 && converted == 0.0) {
            let expected = "must stay within double precision after conversion of its unit";
            self.faults.add(Fault::new(place, expected).got(number(value)));
        }
        converted
    }

    /// A number above zero.
    pub fn positive(&mut self, value: f64, place: &Place<'_>, dimension: Dimension, hint: &str) -> f64 {
        if value <= 0.0 {
            self.faults.add(hinted(Fault::new(place, "must be positive").got(number(value)), hint));
        }
        self.number(value, place, dimension)
    }

    /// A number that is zero or above.
    pub fn not_negative(&mut self, value: f64, place: &Place<'_>, dimension: Dimension, hint: &str) -> f64 {
        if value < 0.0 {
            self.faults.add(hinted(Fault::new(place, "must not be negative").got(number(value)), hint));
        }
        self.number(value, place, dimension)
    }

    /// A number above zero that may be left out.
    pub fn optional_positive(
        &mut self,
        value: Option<f64>,
        place: &Place<'_>,
        dimension: Dimension,
        hint: &str,
    ) -> Option<f64> {
        value.map(|value| self.positive(value, place, dimension, hint))
    }

    /// A required number above zero at `key` of the object at `place`.
    pub fn required_positive(
        &mut self,
        value: Option<f64>,
        place: &Place<'_>,
        key: &str,
        dimension: Dimension,
        hint: &str,
    ) -> f64 {
        match self.faults.require(&value, place, key) {
            Some(value) => self.positive(*value, &place.key(key), dimension, hint),
            None => 1.0,
        }
    }

    /// A vector.
    pub fn vector(&mut self, value: [f64; 3], place: &Place<'_>, dimension: Dimension) -> [f64; 3] {
        let mut converted = [0.0; 3];
        for (index, component) in value.into_iter().enumerate() {
            converted[index] = self.number(component, &place.index(index), dimension);
        }
        converted
    }
}

fn hinted(fault: Fault, hint: &str) -> Fault {
    if hint.is_empty() { fault } else { fault.hint(hint) }
}
