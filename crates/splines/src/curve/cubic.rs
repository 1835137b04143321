//! Piecewise cubics in Hermite form.

use crate::error::Error;

/// Value and derivatives of a curve at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveValue {
    /// y.
    pub value: f64,
    /// dy/dx.
    pub slope: f64,
    /// d2y/dx2; zero outside the points. At an inner point it is that of the interval to the right.
    pub curvature: f64,
    /// Whether the place lies outside the points, where the curve continues along its end tangent.
    pub outside: bool,
}

/// Piecewise cubic through given points (x, y) with given slopes t.
///
/// Between neighbouring points at distance h, with s = 0..1 the fraction of the interval,
///
/// y = (1 + 2 s)(1 - s)^2 y0 + s (1 - s)^2 h t0 + s^2 (3 - 2 s) y1 + s^2 (s - 1) h t1.
///
/// [`crate::akima()`] and [`crate::natural_spline()`] choose the slopes and construct the curve.
///
/// ```
/// let curve = splines::natural_spline(&[0.0, 1.0, 3.0], &[0.0, 2.0, 6.0])?;
/// assert_eq!(curve.slopes(), [2.0; 3]);
/// let beyond = curve.at(4.0);
/// assert!(beyond.outside);
/// assert_eq!((beyond.value, beyond.curvature), (8.0, 0.0));
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseCubic {
    x: Vec<f64>,
    y: Vec<f64>,
    t: Vec<f64>,
}

impl PiecewiseCubic {
    pub(crate) fn new(x: &[f64], y: &[f64], t: Vec<f64>) -> PiecewiseCubic {
        PiecewiseCubic {
            x: x.to_vec(),
            y: y.to_vec(),
            t,
        }
    }

    /// Value and derivatives at x, any finite number.
    #[must_use]
    pub fn at(&self, x: f64) -> CurveValue {
        let last = self.x.len() - 1;
        if x < self.x[0] || x > self.x[last] {
            let k = if x < self.x[0] { 0 } else { last };
            let value = self.y[k] + self.t[k] * (x - self.x[k]);
            return CurveValue {
                value,
                slope: self.t[k],
                curvature: 0.0,
                outside: true,
            };
        }
        let (value, slope, curvature) = self.inside(&Interval::find(&self.x, x));
        CurveValue {
            value,
            slope,
            curvature,
            outside: false,
        }
    }

    /// Slopes at the points.
    #[must_use]
    pub fn slopes(&self) -> &[f64] {
        &self.t
    }

    /// Value, slope and curvature within an interval. The value starts from the nearer point, so that it is
    /// exact at both.
    fn inside(&self, at: &Interval) -> (f64, f64, f64) {
        let Interval { k, s, h } = *at;
        let (rise, secant) = (self.y[k + 1] - self.y[k], (self.y[k + 1] - self.y[k]) / h);
        let (t0, t1) = (self.t[k], self.t[k + 1]);
        let cubic = t0 + t1 - 2.0 * secant;
        let slope = t0 + s * (2.0 * (secant - t0 - cubic) + 3.0 * s * cubic);
        let curvature = (2.0 * (secant - t0 - cubic) + 6.0 * s * cubic) / h;
        let r = 1.0 - s;
        let value = if s > 0.5 {
            self.y[k + 1] - r * r * (1.0 + 2.0 * s) * rise + s * r * h * (r * t0 - s * t1)
        } else {
            self.y[k] + s * s * (1.0 + 2.0 * r) * rise + s * r * h * (r * t0 - s * t1)
        };
        (value, slope, curvature)
    }
}

/// The interval of increasing points in which a coordinate falls, with the Hermite basis there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Interval {
    /// Index of the interval: it runs from point k to point k + 1.
    pub k: usize,
    /// Fraction of the interval, 0..=1.
    pub s: f64,
    /// Width of the interval.
    pub h: f64,
}

impl Interval {
    /// The interval of x, which lies within the points; there are at least two. At an inner point it is the
    /// interval to the right.
    #[inline]
    pub fn find(points: &[f64], x: f64) -> Interval {
        let inner = &points[1..points.len() - 1];
        let k = inner.partition_point(|&p| p <= x);
        let h = points[k + 1] - points[k];
        Interval {
            k,
            s: (x - points[k]) / h,
            h,
        }
    }

    /// Weights of y0, t0, y1 and t1 in the value (the Hermite basis).
    #[inline]
    pub fn weights(&self) -> [f64; 4] {
        let Interval { s, h, .. } = *self;
        let r = 1.0 - s;
        [
            (1.0 + 2.0 * s) * r * r,
            s * r * r * h,
            s * s * (1.0 + 2.0 * r),
            -s * s * r * h,
        ]
    }

    /// Weights of y0, t0, y1 and t1 in the first derivative by x.
    #[inline]
    pub fn slope_weights(&self) -> [f64; 4] {
        let Interval { s, h, .. } = *self;
        let r = 1.0 - s;
        [
            -6.0 * s * r / h,
            r * (r - 2.0 * s),
            6.0 * s * r / h,
            s * (s - 2.0 * r),
        ]
    }

    /// Weights of y0, t0, y1 and t1 in the second derivative by x.
    #[inline]
    pub fn curvature_weights(&self) -> [f64; 4] {
        let Interval { s, h, .. } = *self;
        let (first, last) = (12.0 * s - 6.0, 6.0 * s);
        [
            first / (h * h),
            (last - 4.0) / h,
            -first / (h * h),
            (last - 2.0) / h,
        ]
    }

    /// The same place as the end of the interval to the left; `None` unless it is an inner point.
    pub fn before(&self, points: &[f64]) -> Option<Interval> {
        let k = self.k.checked_sub(1).filter(|_| self.s == 0.0)?;
        Some(Interval {
            k,
            s: 1.0,
            h: points[self.k] - points[k],
        })
    }
}

/// Checks that there are at least `least` points, as many y as x, all finite, with x increasing.
pub(crate) fn check_points(x: &[f64], y: &[f64], least: usize) -> Result<(), Error> {
    if x.len() < least {
        return Err(Error::TooFewPoints {
            found: x.len(),
            least,
        });
    }
    if x.len() != y.len() {
        return Err(Error::PointCount {
            x: x.len(),
            y: y.len(),
        });
    }
    check_increasing(x)?;
    match y.iter().position(|y| !y.is_finite()) {
        Some(index) => Err(Error::PointNumber { index }),
        None => Ok(()),
    }
}

/// Checks that coordinates are finite and increase.
pub(crate) fn check_increasing(x: &[f64]) -> Result<(), Error> {
    if let Some(index) = x.iter().position(|x| !x.is_finite()) {
        return Err(Error::PointNumber { index });
    }
    match x.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(k) => Err(Error::PointOrder { index: k + 1 }),
        None => Ok(()),
    }
}
