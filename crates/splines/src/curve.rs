//! Piecewise cubics through given points.

use crate::Error;

/// A curve's value and derivatives at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// y.
    pub value: f64,
    /// dy/dx.
    pub slope: f64,
    /// d2y/dx2; zero outside the points. At an inner point, that of the interval to the right.
    pub curvature: f64,
    /// Whether the place lies outside the points: the curve goes on along its end tangent.
    pub outside: bool,
}

/// Cubic Hermite curve: between neighbours at distance h, with s the fraction of the interval,
///
/// y = (1 + 2 s)(1 - s)^2 y0 + s (1 - s)^2 h t0 + s^2 (3 - 2 s) y1 + s^2 (s - 1) h t1.
///
/// Made by [`crate::akima()`] and [`crate::natural()`], which choose the slopes t.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    x: Vec<f64>,
    y: Vec<f64>,
    t: Vec<f64>,
}

impl Curve {
    pub(crate) fn new(x: &[f64], y: &[f64], t: Vec<f64>) -> Curve {
        Curve { x: x.to_vec(), y: y.to_vec(), t }
    }

    /// Value and derivatives at x, any finite number.
    #[must_use]
    pub fn at(&self, x: f64) -> Jet {
        let last = self.x.len() - 1;
        if x < self.x[0] || x > self.x[last] {
            let k = if x < self.x[0] { 0 } else { last };
            let value = self.y[k] + self.t[k] * (x - self.x[k]);
            return Jet { value, slope: self.t[k], curvature: 0.0, outside: true };
        }
        let place = Place::find(&self.x, x);
        let (value, slope, curvature) = self.inside(&place);
        Jet { value, slope, curvature, outside: false }
    }

    /// Slopes at the points.
    #[must_use]
    pub fn slopes(&self) -> &[f64] {
        &self.t
    }

    fn inside(&self, place: &Place) -> (f64, f64, f64) {
        let Place { k, s, h } = *place;
        let (rise, secant) = (self.y[k + 1] - self.y[k], (self.y[k + 1] - self.y[k]) / h);
        let (t0, t1) = (self.t[k], self.t[k + 1]);
        let bend = t0 + t1 - 2.0 * secant;
        let slope = t0 + s * (2.0 * (secant - t0 - bend) + 3.0 * s * bend);
        let curvature = (2.0 * (secant - t0 - bend) + 6.0 * s * bend) / h;
        let value = if s > 0.5 {
            let r = 1.0 - s;
            self.y[k + 1] - r * r * (1.0 + 2.0 * s) * rise + s * r * h * (r * t0 - s * t1)
        } else {
            let r = 1.0 - s;
            self.y[k] + s * s * (1.0 + 2.0 * r) * rise + s * r * h * (r * t0 - s * t1)
        };
        (value, slope, curvature)
    }
}

/// Where a coordinate falls among points: interval k, fraction s of it, its width h.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Place {
    pub k: usize,
    pub s: f64,
    pub h: f64,
}

impl Place {
    /// x within the points, at least two of them.
    #[inline]
    pub fn find(points: &[f64], x: f64) -> Place {
        let inner = &points[1..points.len() - 1];
        let k = inner.partition_point(|&p| p <= x);
        let h = points[k + 1] - points[k];
        Place { k, s: (x - points[k]) / h, h }
    }

    /// Weights of y0, t0, y1, t1.
    #[inline]
    pub fn weights(&self) -> [f64; 4] {
        let Place { s, h, .. } = *self;
        let r = 1.0 - s;
        [(1.0 + 2.0 * s) * r * r, s * r * r * h, s * s * (1.0 + 2.0 * r), -s * s * r * h]
    }

    /// Their derivatives by x.
    #[inline]
    pub fn rates(&self) -> [f64; 4] {
        let Place { s, h, .. } = *self;
        let r = 1.0 - s;
        [-6.0 * s * r / h, r * (r - 2.0 * s), 6.0 * s * r / h, s * (s - 2.0 * r)]
    }

    /// Their second derivatives by x.
    #[inline]
    pub fn bends(&self) -> [f64; 4] {
        let Place { s, h, .. } = *self;
        let (first, last) = (12.0 * s - 6.0, 6.0 * s);
        [first / (h * h), (last - 4.0) / h, -first / (h * h), (last - 2.0) / h]
    }

    /// The same place as the end of the interval before, if it is an inner point.
    pub fn before(&self, points: &[f64]) -> Option<Place> {
        let k = self.k.checked_sub(1).filter(|_| self.s == 0.0)?;
        Some(Place { k, s: 1.0, h: points[self.k] - points[k] })
    }
}

/// Refuses points that no curve can go through.
pub(crate) fn check(x: &[f64], y: &[f64], least: usize) -> Result<(), Error> {
    if x.len() < least {
        return Err(Error::Points { found: x.len(), least });
    }
    if x.len() != y.len() {
        return Err(Error::PointCount { x: x.len(), y: y.len() });
    }
    increasing(x)?;
    match y.iter().position(|y| !y.is_finite()) {
        Some(index) => Err(Error::PointNumber { index }),
        None => Ok(()),
    }
}

pub(crate) fn increasing(x: &[f64]) -> Result<(), Error> {
    if let Some(index) = x.iter().position(|x| !x.is_finite()) {
        return Err(Error::PointNumber { index });
    }
    match x.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(k) => Err(Error::PointOrder { index: k + 1 }),
        None => Ok(()),
    }
}
