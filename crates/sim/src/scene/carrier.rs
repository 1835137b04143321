//! The body that carries a structure: the positions of the rails on it and the mass of the structure.

use super::dof::arm_rows;

/// The body that carries a structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Carrier {
    /// Which body.
    pub body: usize,
    /// Rails of the structure, in their order.
    pub rails: Vec<CarriedRail>,
    /// Mass matrix of the structure for rigid motion with the body, 6 x 6 over x, y, z, roll, yaw and pitch of the
    /// origin of the body, in the order of [`crate::BodyDof`]. It is zero where the mass of the body includes the
    /// structure.
    pub mass: [[f64; 6]; 6],
    /// Momentum phi^T M r of each degree of freedom of the structure per unit velocity of the six motions of the
    /// origin of the body; empty where the structure has no degrees of freedom.
    pub coupling: Vec<[f64; 6]>,
}

/// A straight, level rail on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedRail {
    /// Point at which the rail coordinate is 0, relative to the origin of the body.
    pub origin: [f64; 3],
    /// Unit vector in the direction of increasing coordinate; its y component is zero.
    pub along: [f64; 3],
}

impl Carrier {
    /// Transforms a 6 x 6 mass matrix about the point `at` of a body to the origin of the body: A^T `mass` A, where A
    /// maps the motion of the origin to that of `at`.
    #[must_use]
    pub fn mass_about_origin(mass: &[[f64; 6]; 6], at: [f64; 3]) -> [[f64; 6]; 6] {
        let arm = arm(at);
        let product = |i: usize, j: usize| (0..6).map(|k| mass[i][k] * arm[k][j]).sum::<f64>();
        let half: [[f64; 6]; 6] = std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)));
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..6).map(|k| arm[k][i] * half[k][j]).sum())
        })
    }

    /// Transforms the six loads about the point `at` of a body to its origin: A^T `load`.
    #[must_use]
    pub fn load_about_origin(load: &[f64; 6], at: [f64; 3]) -> [f64; 6] {
        let arm = arm(at);
        std::array::from_fn(|i| (0..6).map(|k| arm[k][i] * load[k]).sum())
    }
}

/// Matrix that maps the six motions of the origin to those of the point `at`.
fn arm(at: [f64; 3]) -> [[f64; 6]; 6] {
    let mut rows = [[0.0; 6]; 6];
    rows[..3].copy_from_slice(&arm_rows(at));
    (3..6).for_each(|i| rows[i][i] = 1.0);
    rows
}

#[cfg(test)]
mod tests {
    use super::Carrier;

    #[test]
    fn a_mass_moved_and_back_is_itself_and_its_moments_are_steiners() {
        let mut mass = [[0.0; 6]; 6];
        (0..3).for_each(|i| mass[i][i] = 2.0);
        (3..6).for_each(|i| mass[i][i] = i as f64);
        let moved = Carrier::mass_about_origin(&mass, [3.0, -1.0, 4.0]);
        // Analytic: parallel axes, and m (y, z, x) by the rule u + theta cross r.
        assert!((moved[5][5] - (5.0 + 2.0 * 10.0)).abs() < 1e-12);
        assert!((moved[3][4] - 2.0 * 3.0).abs() < 1e-12, "{}", moved[3][4]);
        assert!((moved[1][5] - 6.0).abs() < 1e-12 && (moved[0][5] - 2.0).abs() < 1e-12);
        let back = Carrier::mass_about_origin(&moved, [-3.0, 1.0, -4.0]);
        for (row, wanted) in back.iter().zip(&mass) {
            assert!(row.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }
}
