//! Vectors of three components as arrays.

/// The difference a - b.
#[must_use]
pub fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The scalar product a . b.
#[must_use]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product a x b.
#[must_use]
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The length |a|, computed without overflow.
#[must_use]
pub fn length(a: [f64; 3]) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// The unit vector a / |a|; `None` where that is not finite, as of a zero vector.
#[must_use]
pub fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let size = length(a);
    let unit = a.map(|part| part / size);
    unit.iter().all(|part| part.is_finite()).then_some(unit)
}

/// Whether two vectors are parallel to 1e-9 rad, or one of them is zero.
#[must_use]
pub fn parallel(a: [f64; 3], b: [f64; 3]) -> bool {
    match (unit(a), unit(b)) {
        (Some(a), Some(b)) => length(cross(a, b)) <= 1e-9,
        _ => true,
    }
}
