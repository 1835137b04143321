//! A SPLINE as a function of x and z: cubics along x, straight lines along z.

use super::cubic::{HermiteCurve, akima_slopes, natural_slopes};
use super::spline::Spline;
use crate::AdamsFault;

/// How curves are interpolated along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SplineMethod {
    /// AKISPL: Akima's cubics, once continuously differentiable.
    Akima,
    /// CUBSPL: the natural cubic spline, twice continuously differentiable.
    Natural,
}

/// The function f(x, z) that a SPLINE defines: cubics along x, straight lines along z.
///
/// ```
/// use adams::{SplineValues, SplineFunction, SplineMethod, Spline};
///
/// // The points of an example in the Adams View help of AKIMA_SPLINE.
/// let curves = SplineValues::new(vec![1.0, 2.0, 3.0, 4.0], vec![], vec![vec![0.0, 2.0, 1.0, 3.0]])?;
/// let spline = Spline { id: 1, name: None, units: None, linear_extrapolate: true, curves };
/// let family = SplineFunction::new(&spline, SplineMethod::Akima);
/// let found = family.read(5.0 / 3.0, 0.0, 0)?;
/// assert!((found.value - 1.667).abs() < 5e-4 && !found.extrapolated);
/// # Ok::<(), adams::AdamsFault>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SplineFunction {
    z: Vec<f64>,
    curves: Vec<HermiteCurve>,
    linear: bool,
}

/// A value read from a SPLINE.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineReading {
    /// The value, or the requested derivative with respect to x.
    pub value: f64,
    /// The derivative of `value` with respect to x.
    pub by_x: f64,
    /// The derivative of `value` with respect to z; zero for a single curve.
    pub by_z: f64,
    /// Whether x or z is outside the values of the SPLINE.
    pub extrapolated: bool,
}

impl SplineFunction {
    /// The function of a SPLINE by an interpolation method.
    #[must_use]
    pub fn new(spline: &Spline, method: SplineMethod) -> SplineFunction {
        let x = spline.curves.x();
        let rule = match method {
            SplineMethod::Akima => akima_slopes,
            SplineMethod::Natural => natural_slopes,
        };
        let curve = |y: &Vec<f64>| HermiteCurve::new(x, y, rule(x, y), spline.linear_extrapolate);
        let curves = spline.curves.y().iter().map(curve).collect();
        SplineFunction {
            z: spline.curves.z().to_vec(),
            curves,
            linear: spline.linear_extrapolate,
        }
    }

    /// Whether the function depends on z. Derivatives are defined for single curves only.
    #[must_use]
    pub fn is_surface(&self) -> bool {
        !self.z.is_empty()
    }

    /// The value at (x, z) for `order` 0, or the first or second derivative of a single curve for `order` 1
    /// or 2.
    ///
    /// Beyond the x values of the SPLINE the curve continues by its tangent with LINEAR_EXTRAPOLATE, and by
    /// the parabola through the last three points without it. Two pages of the ADAMS documentation give
    /// different rules here, so a data set should not rely on either. Beyond the z values the last straight
    /// line continues with LINEAR_EXTRAPOLATE.
    ///
    /// # Errors
    /// [`AdamsFault::OutsideZ`] for z outside a SPLINE without LINEAR_EXTRAPOLATE.
    ///
    /// # Source
    /// Adams Solver reference, AKISPL, CUBSPL and SPLINE.
    pub fn read(&self, x: f64, z: f64, order: usize) -> Result<SplineReading, AdamsFault> {
        let order = order.min(2);
        let outside = self.curves.first().is_some_and(|curve| curve.beyond(x));
        let n = self.z.len();
        if n < 2 {
            let all = self
                .curves
                .first()
                .map_or([0.0; 4], |curve| curve.derivatives(x));
            return Ok(SplineReading {
                value: all[order],
                by_x: all[order + 1],
                by_z: 0.0,
                extrapolated: outside,
            });
        }
        let past = z < self.z[0] || z > self.z[n - 1];
        if past && !self.linear {
            return Err(AdamsFault::OutsideZ);
        }
        let k = self.z.partition_point(|at| *at <= z).clamp(1, n - 1) - 1;
        let (a, b) = (
            self.curves[k].derivatives(x),
            self.curves[k + 1].derivatives(x),
        );
        let (width, step) = (self.z[k + 1] - self.z[k], z - self.z[k]);
        let fraction = step / width;
        Ok(SplineReading {
            value: a[0] + fraction * (b[0] - a[0]),
            by_x: a[1] + fraction * (b[1] - a[1]),
            by_z: (b[0] - a[0]) / width,
            extrapolated: outside || past,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{SplineFunction, SplineMethod};
    use crate::{Spline, SplineValues};

    fn curve(x: &[f64], y: &[f64], linear: bool) -> Spline {
        let curves =
            SplineValues::new(x.to_vec(), Vec::new(), vec![y.to_vec()]).expect("increasing");
        Spline {
            id: 1,
            name: None,
            units: None,
            linear_extrapolate: linear,
            curves,
        }
    }

    /// The Adams View help prints these values for AKIMA_SPLINE({1,2,3,4},{0,2,1,3},10) and CSPLINE of the
    /// same points. The page of CSPLINE prints 0.936 instead of 0.963.
    #[test]
    fn published_values_of_akima_spline_and_cspline_are_met() {
        let points = curve(&[1.0, 2.0, 3.0, 4.0], &[0.0, 2.0, 1.0, 3.0], false);
        let akima = [0.0, 1.0, 1.667, 2.0, 1.778, 1.222, 1.0, 1.333, 2.0, 3.0];
        let natural = [0.0, 0.963, 1.704, 2.0, 1.741, 1.259, 1.0, 1.296, 2.037, 3.0];
        for (method, printed) in [
            (SplineMethod::Akima, akima),
            (SplineMethod::Natural, natural),
        ] {
            let family = SplineFunction::new(&points, method);
            for (k, value) in printed.into_iter().enumerate() {
                let found = family
                    .read(1.0 + k as f64 / 3.0, 0.0, 0)
                    .expect("one curve")
                    .value;
                assert!((found - value).abs() < 5.1e-4, "{method:?} {k}: {found}");
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let x = [0.0, 1.0, 2.5, 3.0, 5.0];
        for method in [SplineMethod::Akima, SplineMethod::Natural] {
            for linear in [false, true] {
                let family =
                    SplineFunction::new(&curve(&x, &[0.3, 1.0, -2.0, 0.5, 0.25], linear), method);
                for at in [-0.7, 0.2, 1.7, 2.8, 4.1, 6.0] {
                    for order in [0, 1] {
                        let read = |x: f64| family.read(x, 0.0, order).expect("one curve");
                        let step = 1e-5;
                        let slope = (read(at + step).value - read(at - step).value) / (2.0 * step);
                        assert!(
                            (slope - read(at).by_x).abs() < 1e-7,
                            "{method:?} {at} {order}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn natural_spline_bends_continuously_and_not_at_its_ends() {
        let x = [0.0, 1.0, 2.5, 3.0, 5.0];
        let family = SplineFunction::new(
            &curve(&x, &[0.3, 1.0, -2.0, 0.5, 0.25], true),
            SplineMethod::Natural,
        );
        let bend = |x: f64| family.read(x, 0.0, 2).expect("one curve").value;
        assert!(bend(0.0).abs() < 1e-13 && bend(5.0).abs() < 1e-13);
        for at in &x[1..4] {
            assert!((bend(at - 1e-9) - bend(at + 1e-9)).abs() < 1e-6);
        }
    }

    #[test]
    fn parabola_goes_on_beyond_the_ends_unless_the_tangent_is_asked_for() {
        let square: Vec<f64> = [0.0, 1.0, 2.5, 3.0, 5.0]
            .iter()
            .map(|x: &f64| x * x)
            .collect();
        let family = SplineFunction::new(
            &curve(&[0.0, 1.0, 2.5, 3.0, 5.0], &square, false),
            SplineMethod::Akima,
        );
        for x in [-2.0, 7.0] {
            let found = family.read(x, 0.0, 0).expect("one curve");
            assert!((found.value - x * x).abs() < 1e-12 && found.extrapolated);
        }
    }
}
