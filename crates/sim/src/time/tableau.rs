//! Diagonally implicit Runge-Kutta methods.

/// A diagonally implicit, stiffly accurate method with the same coefficient `gamma` in every diagonal entry.
pub(crate) struct Tableau {
    pub gamma: f64,
    /// Abscissae.
    pub c: &'static [f64],
    /// Rows of the coefficient matrix below the diagonal; row i has i entries. The last row and `gamma` are the
    /// weights.
    pub a: &'static [&'static [f64]],
    /// Previous stages from which, with the start of the step, each stage is extrapolated for its first guess. Stages near
    /// to each other multiply their errors in an extrapolation: at the end of a step the quadratic through the start and
    /// two stages is nearer than the quartic through the start and four.
    pub guess: &'static [&'static [usize]],
    /// Weights minus those of the embedded method.
    pub error: &'static [f64],
}

impl Tableau {
    /// Number of stages.
    pub fn stages(&self) -> usize {
        self.c.len()
    }

    /// Weight of stage `i`.
    pub fn weight(&self, i: usize) -> f64 {
        let last = self.stages() - 1;
        if i == last { self.gamma } else { self.a[last][i] }
    }
}

/// SDIRK of order 4 in five stages, L-stable and stiffly accurate, with an embedded method of order 3.
///
/// # Source
/// Hairer, Wanner, Solving Ordinary Differential Equations II (1996), table IV.6.5.
pub(crate) const SDIRK4: Tableau = Tableau {
    gamma: 0.25,
    c: &[0.25, 0.75, 0.55, 0.5, 1.0],
    a: &[
        &[],
        &[0.5],
        &[17.0 / 50.0, -1.0 / 25.0],
        &[371.0 / 1360.0, -137.0 / 2720.0, 15.0 / 544.0],
        &[25.0 / 24.0, -49.0 / 48.0, 125.0 / 16.0, -85.0 / 12.0],
    ],
    guess: &[&[], &[0], &[0, 1], &[0, 1, 2], &[1, 2]],
    error: &[-3.0 / 16.0, -27.0 / 32.0, 25.0 / 32.0, 0.0, 0.25],
};

#[cfg(test)]
mod tests {
    use super::SDIRK4;

    /// The eight conditions of order 4 (Hairer, Norsett, Wanner I, table II.2.1), written out for the full matrix.
    #[test]
    fn sdirk4_meets_the_conditions_of_order_four() {
        let s = SDIRK4.stages();
        let a = |i: usize, j: usize| match i.cmp(&j) {
            std::cmp::Ordering::Greater => SDIRK4.a[i][j],
            std::cmp::Ordering::Equal => SDIRK4.gamma,
            std::cmp::Ordering::Less => 0.0,
        };
        let c = SDIRK4.c;
        let sum = |f: &dyn Fn(usize) -> f64| (0..s).map(|i| SDIRK4.weight(i) * f(i)).sum::<f64>();
        let inner = |i: usize, f: &dyn Fn(usize) -> f64| (0..s).map(|j| a(i, j) * f(j)).sum::<f64>();
        for (i, abscissa) in c.iter().enumerate() {
            assert!((inner(i, &|_| 1.0) - abscissa).abs() < 1e-14);
        }
        let conditions: [(f64, f64); 8] = [
            (sum(&|_| 1.0), 1.0),
            (sum(&|i| c[i]), 1.0 / 2.0),
            (sum(&|i| c[i] * c[i]), 1.0 / 3.0),
            (sum(&|i| inner(i, &|j| c[j])), 1.0 / 6.0),
            (sum(&|i| c[i].powi(3)), 1.0 / 4.0),
            (sum(&|i| c[i] * inner(i, &|j| c[j])), 1.0 / 8.0),
            (sum(&|i| inner(i, &|j| c[j] * c[j])), 1.0 / 12.0),
            (sum(&|i| inner(i, &|j| inner(j, &|k| c[k]))), 1.0 / 24.0),
        ];
        for (index, (found, wanted)) in conditions.iter().enumerate() {
            assert!((found - wanted).abs() < 1e-13, "condition {index}: {found} for {wanted}");
        }
        assert!(SDIRK4.error.iter().sum::<f64>().abs() < 1e-15);
    }
}
