//! Diagonally implicit Runge-Kutta methods.

use std::cmp::Ordering;

/// A diagonally implicit, stiffly accurate method. Stage 0 is the start of the step and needs no solution; all others have the
/// same coefficient `gamma` in the diagonal. Methods without an explicit stage give stage 0 no weight.
pub(crate) struct Tableau {
    pub gamma: f64,
    /// Abscissae.
    pub c: &'static [f64],
    /// Rows of the coefficient matrix below the diagonal; row i has i entries. The last row and `gamma` are the
    /// weights.
    pub a: &'static [&'static [f64]],
    /// Earlier stages from which each stage is guessed ([`Guesses`](super::guesses::Guesses)): in steps in which the set of
    /// elements with a force changes, and in others. More stages make a guess of higher order, and multiply what is not smooth.
    pub guess: [&'static [&'static [usize]]; 2],
    /// Weights minus those of the embedded method, times a factor that makes the estimates of all methods as cautious as that of
    /// SDIRK4, which is ten to twenty times the error of an oscillation of half a radian a step.
    pub error: &'static [f64],
    /// Power of the step length with which the error decreases that is estimated by the embedded method.
    pub error_power: f64,
    /// Largest tolerance of a step for the errors of forces: at larger ones too many runs miss the accuracy of their forces.
    pub loosest: f64,
    /// Length of a step, relative to one of ESDIRK5 with the same error.
    pub length: f64,
}

impl Tableau {
    /// Number of stages.
    pub fn stages(&self) -> usize {
        self.c.len()
    }

    /// Entry of the coefficient matrix, with its diagonal.
    pub fn coefficient(&self, i: usize, j: usize) -> f64 {
        match i.cmp(&j) {
            Ordering::Greater => self.a[i][j],
            Ordering::Equal if i > 0 => self.gamma,
            _ => 0.0,
        }
    }

    /// Weight of stage `i`.
    pub fn weight(&self, i: usize) -> f64 {
        self.coefficient(self.stages() - 1, i)
    }
}

/// SDIRK of order 4 in five stages, L-stable and stiffly accurate, with an embedded method of order 3.
///
/// # Source
/// Hairer, Wanner, Solving Ordinary Differential Equations II (1996), table IV.6.5.
pub(crate) const SDIRK4: Tableau = Tableau {
    gamma: 0.25,
    c: &[0.0, 0.25, 0.75, 0.55, 0.5, 1.0],
    a: &[
        &[],
        &[0.0],
        &[0.0, 0.5],
        &[0.0, 17.0 / 50.0, -1.0 / 25.0],
        &[0.0, 371.0 / 1360.0, -137.0 / 2720.0, 15.0 / 544.0],
        &[0.0, 25.0 / 24.0, -49.0 / 48.0, 125.0 / 16.0, -85.0 / 12.0],
    ],
    guess: [&[&[], &[], &[0, 1], &[0, 1, 2], &[0, 1, 2, 3], &[0, 2, 3]]; 2],
    error: &[0.0, -3.0 / 16.0, -27.0 / 32.0, 25.0 / 32.0, 0.0, 0.25],
    error_power: 4.0,
    loosest: 8e-3,
    length: 0.5,
};

/// Factor on the estimated error of ESDIRK5.
const CAUTION: f64 = 4.0;

/// ESDIRK of order 5 in six implicit stages, L-stable and stiffly accurate, with stages of order 2 and an embedded method of
/// order 4.
///
/// # Source
/// Kennedy, Carpenter, Diagonally implicit Runge-Kutta methods for stiff ODEs, Applied Numerical Mathematics 146 (2019),
/// ESDIRK5(4)7L\[2\]SA2, whose coefficients are rounded to doubles here.
pub(crate) const ESDIRK5: Tableau = Tableau {
    gamma: 0.184,
    c: &[
        0.0,
        0.368,
        0.628_215_295_476_649_5,
        0.138_810_198_300_283_3,
        0.699_958_619_404_574_7,
        0.908_376_963_350_785_3,
        1.0,
    ],
    a: &[
        &[],
        &[0.184],
        &[0.222_107_647_738_324_75, 0.222_107_647_738_324_75],
        &[
            -0.014_049_475_381_926_283,
            -0.014_049_475_381_926_283,
            -0.017_090_850_935_864_15,
        ],
        &[
            -0.408_388_592_549_314_64,
            -0.408_388_592_549_314_64,
            0.166_463_998_213_629_64,
            1.166_271_806_289_574_5,
        ],
        &[
            -0.539_290_723_558_811_4,
            -0.539_290_723_558_811_4,
            -0.242_234_428_845_425,
            1.488_880_611_122_514_6,
            0.556_312_228_191_318_4,
        ],
        &[
            -0.039_466_069_109_740_26,
            -0.039_466_069_109_740_26,
            0.272_636_490_250_242_67,
            0.432_165_172_520_288_2,
            0.352_416_086_232_889_1,
            -0.162_285_610_783_939_52,
        ],
    ],
    guess: [
        &[
            &[],
            &[],
            &[0, 1],
            &[0, 1, 2],
            &[1, 2, 3],
            &[0, 1, 2],
            &[0, 1, 4, 5],
        ],
        &[
            &[],
            &[],
            &[0, 1],
            &[0, 1, 2],
            &[0, 1, 2, 3],
            &[0, 1, 2, 3, 4],
            &[0, 1, 2, 4, 5],
        ],
    ],
    error: &[
        CAUTION * 0.041_223_397_456_907_174,
        CAUTION * 0.041_223_397_456_907_174,
        CAUTION * 0.089_736_805_636_807_14,
        CAUTION * -0.084_848_701_245_942_79,
        CAUTION * -0.074_183_645_069_565_21,
        CAUTION * -0.057_958_752_816_804_54,
        CAUTION * 0.044_807_498_581_691_03,
    ],
    error_power: 5.0,
    loosest: 1.8e-2,
    length: 1.0,
};

#[cfg(test)]
mod tests {
    use super::{ESDIRK5, SDIRK4, Tableau};

    /// Residuals of the conditions for the orders up to 5 by `weights` (Hairer, Norsett, Wanner I, table II.2.1), by order.
    fn residuals(tableau: &Tableau, weights: &[f64]) -> [Vec<f64>; 5] {
        let s = tableau.stages();
        let times = |vector: &[f64]| -> Vec<f64> {
            (0..s)
                .map(|i| (0..s).map(|j| tableau.coefficient(i, j) * vector[j]).sum())
                .collect()
        };
        let product =
            |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a * b).collect() };
        let sum = |vector: &[f64]| -> f64 { weights.iter().zip(vector).map(|(w, x)| w * x).sum() };
        let ones = vec![1.0; s];
        let c = times(&ones);
        let (c2, ac) = (product(&c, &c), times(&c));
        let c3 = product(&c2, &c);
        let (ac2, aac) = (times(&c2), times(&ac));
        let aac2 = times(&ac2);
        [
            vec![sum(&ones) - 1.0],
            vec![sum(&c) - 1.0 / 2.0],
            vec![sum(&c2) - 1.0 / 3.0, sum(&ac) - 1.0 / 6.0],
            vec![
                sum(&c3) - 1.0 / 4.0,
                sum(&product(&c, &ac)) - 1.0 / 8.0,
                sum(&ac2) - 1.0 / 12.0,
                sum(&aac) - 1.0 / 24.0,
            ],
            vec![
                sum(&product(&c3, &c)) - 1.0 / 5.0,
                sum(&product(&c2, &ac)) - 1.0 / 10.0,
                sum(&product(&ac, &ac)) - 1.0 / 20.0,
                sum(&product(&c, &ac2)) - 1.0 / 15.0,
                sum(&times(&c3)) - 1.0 / 20.0,
                sum(&product(&c, &aac)) - 1.0 / 30.0,
                sum(&times(&product(&c, &ac))) - 1.0 / 40.0,
                sum(&aac2) - 1.0 / 60.0,
                sum(&times(&aac)) - 1.0 / 120.0,
            ],
        ]
    }

    /// Analytic: the conditions of the order of each method and of its embedded method, and one of the next order that it does
    /// not meet; abscissae that are the sums of their rows.
    #[test]
    fn methods_meet_the_conditions_of_their_orders() {
        for (tableau, order) in [(&SDIRK4, 4), (&ESDIRK5, 5)] {
            let s = tableau.stages();
            for (i, abscissa) in tableau.c.iter().enumerate() {
                let sum: f64 = (0..s).map(|j| tableau.coefficient(i, j)).sum();
                assert!(
                    (sum - abscissa).abs() < 2e-15,
                    "order {order}, stage {i}: {sum} for {abscissa}"
                );
            }
            let own: Vec<f64> = (0..s).map(|i| tableau.weight(i)).collect();
            let embedded: Vec<f64> = own
                .iter()
                .zip(tableau.error)
                .map(|(own, error)| own - error)
                .collect();
            for (weights, order) in [(own, order), (embedded, order - 1)] {
                let largest =
                    |residuals: &[f64]| residuals.iter().fold(0.0_f64, |max, r| max.max(r.abs()));
                for (index, residuals) in residuals(tableau, &weights).iter().enumerate() {
                    let found = largest(residuals);
                    if index < order {
                        assert!(
                            found < 1e-14,
                            "order {order}, conditions of {}: {found:e}",
                            index + 1
                        );
                    } else if index == order {
                        assert!(found > 1e-4, "order {order} is higher: {found:e}");
                    }
                }
            }
        }
    }

    /// Analytic: stages of order 2, sum a_ij c_j = c_i^2/2, but for the first implicit one of equal weights.
    #[test]
    fn esdirk5_has_stages_of_order_two() {
        let s = ESDIRK5.stages();
        for i in 1..s {
            let found: f64 = (0..s)
                .map(|j| ESDIRK5.coefficient(i, j) * ESDIRK5.c[j])
                .sum();
            assert!(
                (found - 0.5 * ESDIRK5.c[i].powi(2)).abs() < 2e-15,
                "stage {i}: {found}"
            );
        }
    }
}
