//! Words of the methods of integration.

use sim::Method;

/// Names of the methods of integration.
pub const STEPPERS: [(&str, Method); 6] = [
    ("auto", Method::Auto),
    ("sdirk4", Method::Sdirk4),
    ("radau", Method::Radau),
    ("series", Method::Series),
    ("gauss2", Method::Gauss2),
    ("gauss3", Method::Gauss3),
];

/// Name of a method of integration.
#[must_use]
pub fn stepper_word(method: Method) -> &'static str {
    STEPPERS.iter().find(|(_, known)| *known == method).map_or("", |(word, _)| *word)
}
