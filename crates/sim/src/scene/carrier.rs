//! The body that carries a structure: where the rails are on it, and what the structure weighs.

use super::dof::arm_rows;

/// The body that carries a structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Carrier {
    /// Which body.
    pub body: usize,
    /// Its rails, in their order.
    pub rails: Vec<CarriedRail>,
    /// Mass of the structure moving as one with the body, 6 x 6 over x, y, z, roll, yaw, pitch of the body's origin,
    /// in the order of [`crate::BodyDof`]; zeros where it is part of the body's.
    pub mass: [[f64; 6]; 6],
    /// Momentum of each of the structure's degrees of freedom by the six motions of the body's origin, phi^T M r;
    /// empty where the structure has none.
    pub coupling: Vec<[f64; 6]>,
}

/// A straight, level rail on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedRail {
    /// Where the rail's coordinate is 0, from the body's origin.
    pub origin: [f64; 3],
    /// Direction of increasing coordinate, of length 1, without a part along y.
    pub along: [f64; 3],
}

impl Carrier {
    /// A mass matrix 6 x 6 about `at` of a body, as its origin sees it: A^T `mass` A, A the motion at `at` by that of
    /// the origin.
    #[must_use]
    pub fn mass_about_origin(mass: &[[f64; 6]; 6], at: [f64; 3]) -> [[f64; 6]; 6] {
        let arm = arm(at);
        let product = |i: usize, j: usize| (0..6).map(|k| mass[i][k] * arm[k][j]).sum::<f64>();
        let half: [[f64; 6]; 6] = std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)));
        std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| arm[k][i] * half[k][j]).sum()))
    }

    /// What loads of the six motions about `at` of a body are about its origin: A^T `load`.
    #[must_use]
    pub fn load_about_origin(load: &[f64; 6], at: [f64; 3]) -> [f64; 6] {
        let arm = arm(at);
        std::array::from_fn(|i| (0..6).map(|k| arm[k][i] * load[k]).sum())
    }
}

/// Motion at `at` by the six of the origin.
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
