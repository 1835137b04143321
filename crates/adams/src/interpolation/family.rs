//! A SPLINE as a function of x and z.

use super::hermite::Hermite;
use super::{akima, natural};
use crate::{Fault, Spline};

/// How curves run along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Method {
    /// AKISPL: Akima's cubics, once differentiable.
    Akima,
    /// CUBSPL: the natural cubic spline, twice differentiable.
    Natural,
}

/// Curves along x, straight lines along z.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    z: Vec<f64>,
    curves: Vec<Hermite>,
    linear: bool,
}

/// A value read from a SPLINE.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The value, or the derivative asked for.
    pub value: f64,
    /// Its derivative by x.
    pub by_x: f64,
    /// Its derivative by z; zero for one curve.
    pub by_z: f64,
    /// Outside the values that the SPLINE was given.
    pub beyond: bool,
}

impl Family {
    /// A SPLINE read by a method.
    #[must_use]
    pub fn new(spline: &Spline, method: Method) -> Family {
        let x = spline.curves.x();
        let rule = match method {
            Method::Akima => akima::slopes,
            Method::Natural => natural::slopes,
        };
        let curve = |y: &Vec<f64>| Hermite::new(x, y, rule(x, y), spline.linear);
        let curves = spline.curves.y().iter().map(curve).collect();
        Family { z: spline.curves.z().to_vec(), curves, linear: spline.linear }
    }

    /// Whether there is a second argument: derivatives can be asked of single curves alone.
    #[must_use]
    pub fn is_surface(&self) -> bool {
        !self.z.is_empty()
    }

    /// The value at (x, z), or along one curve its first or second derivative (`order` 0, 1, 2).
    ///
    /// Beyond the x of the SPLINE: with LINEAR_EXTRAPOLATE the tangent at the end, otherwise the parabola
    /// through the last three points. ADAMS' own pages name two different rules, so a deck should not get there.
    ///
    /// # Errors
    /// [`Fault::Beyond`] for z outside the SPLINE without LINEAR_EXTRAPOLATE; with it the last straight line
    /// goes on.
    pub fn read(&self, x: f64, z: f64, order: usize) -> Result<Reading, Fault> {
        let order = order.min(2);
        let outside = self.curves.first().is_some_and(|curve| curve.beyond(x));
        let n = self.z.len();
        if n < 2 {
            let all = self.curves.first().map_or([0.0; 4], |curve| curve.derivatives(x));
            return Ok(Reading { value: all[order], by_x: all[order + 1], by_z: 0.0, beyond: outside });
        }
        let past = z < self.z[0] || z > self.z[n - 1];
        if past && !self.linear {
            return Err(Fault::Beyond);
        }
        let k = self.z.partition_point(|at| *at <= z).clamp(1, n - 1) - 1;
        let (a, b) = (self.curves[k].derivatives(x), self.curves[k + 1].derivatives(x));
        let (width, step) = (self.z[k + 1] - self.z[k], z - self.z[k]);
        let share = step / width;
        Ok(Reading {
            value: a[0] + share * (b[0] - a[0]),
            by_x: a[1] + share * (b[1] - a[1]),
            by_z: (b[0] - a[0]) / width,
            beyond: outside || past,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Family, Method};
    use crate::{Curves, Spline};

    fn curve(x: &[f64], y: &[f64], linear: bool) -> Spline {
        let curves = Curves::new(x.to_vec(), Vec::new(), vec![y.to_vec()]).expect("increasing");
        Spline { id: 1, name: None, units: None, linear, curves }
    }

    /// Values that the Adams View help prints for AKIMA_SPLINE({1,2,3,4},{0,2,1,3},10) and CSPLINE of the same
    /// points; a page of the second prints 0.936 for 0.963.
    #[test]
    fn published_values_of_akima_spline_and_cspline_are_met() {
        let points = curve(&[1.0, 2.0, 3.0, 4.0], &[0.0, 2.0, 1.0, 3.0], false);
        let akima = [0.0, 1.0, 1.667, 2.0, 1.778, 1.222, 1.0, 1.333, 2.0, 3.0];
        let natural = [0.0, 0.963, 1.704, 2.0, 1.741, 1.259, 1.0, 1.296, 2.037, 3.0];
        for (method, printed) in [(Method::Akima, akima), (Method::Natural, natural)] {
            let family = Family::new(&points, method);
            for (k, value) in printed.into_iter().enumerate() {
                let found = family.read(1.0 + k as f64 / 3.0, 0.0, 0).expect("one curve").value;
                assert!((found - value).abs() < 5.1e-4, "{method:?} {k}: {found}");
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let x = [0.0, 1.0, 2.5, 3.0, 5.0];
        for method in [Method::Akima, Method::Natural] {
            for linear in [false, true] {
                let family = Family::new(&curve(&x, &[0.3, 1.0, -2.0, 0.5, 0.25], linear), method);
                for at in [-0.7, 0.2, 1.7, 2.8, 4.1, 6.0] {
                    for order in [0, 1] {
                        let read = |x: f64| family.read(x, 0.0, order).expect("one curve");
                        let step = 1e-5;
                        let slope = (read(at + step).value - read(at - step).value) / (2.0 * step);
                        assert!((slope - read(at).by_x).abs() < 1e-7, "{method:?} {at} {order}");
                    }
                }
            }
        }
    }

    #[test]
    fn natural_spline_bends_continuously_and_not_at_its_ends() {
        let x = [0.0, 1.0, 2.5, 3.0, 5.0];
        let family = Family::new(&curve(&x, &[0.3, 1.0, -2.0, 0.5, 0.25], true), Method::Natural);
        let bend = |x: f64| family.read(x, 0.0, 2).expect("one curve").value;
        assert!(bend(0.0).abs() < 1e-13 && bend(5.0).abs() < 1e-13);
        for at in &x[1..4] {
            assert!((bend(at - 1e-9) - bend(at + 1e-9)).abs() < 1e-6);
        }
    }

    #[test]
    fn parabola_goes_on_beyond_the_ends_unless_the_tangent_is_asked_for() {
        let square: Vec<f64> = [0.0, 1.0, 2.5, 3.0, 5.0].iter().map(|x: &f64| x * x).collect();
        let family = Family::new(&curve(&[0.0, 1.0, 2.5, 3.0, 5.0], &square, false), Method::Akima);
        for x in [-2.0, 7.0] {
            let found = family.read(x, 0.0, 0).expect("one curve");
            assert!((found.value - x * x).abs() < 1e-12 && found.beyond);
        }
    }
}
