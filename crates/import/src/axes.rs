//! Local axes of elements, and inertia in turned axes.

use formats::vector::{cross, unit};

/// Axes of the basic system: the global axes.
pub const BASIC_AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Sum of the axes, each multiplied by one component. Vectors along the axes of the basic system are not changed.
pub fn combined(axes: &[[f64; 3]; 3], parts: [f64; 3]) -> [f64; 3] {
    if *axes == BASIC_AXES {
        return parts;
    }
    [0, 1, 2].map(|k| parts[0] * axes[0][k] + parts[1] * axes[1][k] + parts[2] * axes[2][k])
}

/// Unit vectors x, y and z of an element.
#[derive(Clone, Copy, Debug)]
pub struct LocalAxes([[f64; 3]; 3]);

impl LocalAxes {
    /// Axes with x along `along` and y in the half plane of x and `vector`; `None` if the two are parallel.
    #[must_use]
    pub fn new(along: [f64; 3], vector: [f64; 3]) -> Option<LocalAxes> {
        let x = unit(along)?;
        let z = unit(cross(x, unit(vector)?))?;
        Some(LocalAxes([x, cross(z, x), z]))
    }

    /// The global components of a vector with local components.
    #[must_use]
    pub fn vector(&self, parts: [f64; 3]) -> [f64; 3] {
        combined(&self.0, parts)
    }
}

/// The inertia matrix J of a body in global axes, where `inertia` is its matrix along `axes`: J = sum J_ij a_i a_j^T.
#[must_use]
pub fn turned_inertia(axes: &[[f64; 3]; 3], inertia: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    // rows along the global axes, columns still along the own ones
    let half: Vec<[f64; 3]> = (0..3)
        .map(|column| combined(axes, [0, 1, 2].map(|row| inertia[row][column])))
        .collect();
    [0, 1, 2].map(|row| combined(axes, [0, 1, 2].map(|column| half[column][row])))
}
