//! Checks of single numbers with conversion of their units.

use crate::limits::{Limit, MAGNITUDES};
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
    /// Any number whose magnitude is within the limits.
    pub fn number(&mut self, value: f64, place: &Place<'_>, dimension: Dimension) -> f64 {
        let [_, largest] = MAGNITUDES;
        if value.abs() > largest {
            let fault = Fault::new(
                place,
                format!("must be at most {} in magnitude", number(largest)),
            );
            self.faults.add(fault.got(number(value)).of_value());
        }
        self.scaled(value, place, self.scale.factor(dimension))
    }

    /// Multiplies a number, whose magnitude has been checked, by a factor. The product must be finite, and must not
    /// underflow to zero.
    pub fn scaled(&mut self, value: f64, place: &Place<'_>, factor: f64) -> f64 {
        let converted = value * factor;
        if !is_within(value) {
            return converted;
        }
        if !converted.is_finite() || (value != 0.0 && converted == 0.0) {
            let expected = "must stay within double precision after conversion of its unit";
            self.faults
                .add(Fault::new(place, expected).got(number(value)).of_value());
        }
        converted
    }

    /// A number above zero.
    pub fn positive(
        &mut self,
        value: f64,
        place: &Place<'_>,
        dimension: Dimension,
        hint: &str,
    ) -> f64 {
        if value <= 0.0 {
            self.faults.add(hinted(
                Fault::new(place, "must be positive")
                    .got(number(value))
                    .of_value(),
                hint,
            ));
        }
        self.magnitude(value, place, hint);
        self.scaled(value, place, self.scale.factor(dimension))
    }

    /// A number that is zero or above.
    pub fn not_negative(
        &mut self,
        value: f64,
        place: &Place<'_>,
        dimension: Dimension,
        hint: &str,
    ) -> f64 {
        if value < 0.0 {
            self.faults.add(hinted(
                Fault::new(place, "must not be negative")
                    .got(number(value))
                    .of_value(),
                hint,
            ));
        }
        self.magnitude(value, place, hint);
        self.scaled(value, place, self.scale.factor(dimension))
    }

    /// Checks that a number is within the limits of magnitude, unless it is zero or negative.
    fn magnitude(&mut self, value: f64, place: &Place<'_>, hint: &str) {
        if value > 0.0 && !is_within(value) {
            let [least, most] = MAGNITUDES.map(number);
            let fault = Fault::new(place, format!("must be between {least} and {most}"))
                .got(number(value))
                .of_value();
            self.faults.add(hinted(fault, hint));
        }
    }

    /// Checks a count. Returns whether it is within the limit.
    pub(crate) fn count(&mut self, count: usize, limit: &Limit, place: &Place<'_>) -> bool {
        self.limit(
            count,
            limit,
            format!("must be at most {}", limit.most),
            place,
        )
    }

    /// Checks the number of items of a list. Returns whether it is within the limit.
    pub(crate) fn items(&mut self, count: usize, limit: &Limit, place: &Place<'_>) -> bool {
        self.limit(
            count,
            limit,
            format!("must have at most {} items", limit.most),
            place,
        )
    }

    fn limit(&mut self, count: usize, limit: &Limit, expected: String, place: &Place<'_>) -> bool {
        if count > limit.most {
            self.faults.add(
                Fault::new(place, expected)
                    .got(count)
                    .hint(limit.reason)
                    .of_value(),
            );
        }
        count <= limit.most
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

/// Whether the magnitude of a number is zero or within the limits.
fn is_within(value: f64) -> bool {
    let [least, most] = MAGNITUDES;
    value == 0.0 || (least..=most).contains(&value.abs())
}

fn hinted(fault: Fault, hint: &str) -> Fault {
    if hint.is_empty() {
        fault
    } else {
        fault.hint(hint)
    }
}
