//! Cubics of a rail element along a direction that involves one bending plane or the axial bar alone.
//!
//! That is the common case of a vertical load on a straight girder. Four shape functions are then enough, and
//! Green's function of the clamped element is a product of two terms (`separated` in `green`), so that eight
//! cubics say everything about a place.

use super::beam_column::{power_derivatives, powers};
use super::element::{LocalPlace, RailElement};
use super::green::separated;
use super::load::AxisLoad;
use super::shape::ShapeCubics;

/// Eight cubics of an element along one direction: four shape functions, then far and near of Green's
/// function, two entries each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlanarCubics {
    /// Degrees of freedom of the shape functions.
    pub index: [usize; 4],
    /// `[end][p]` are the coefficients of r^p, r being the distance from either end as a fraction of the
    /// element.
    value: [[[f64; 8]; 4]; 2],
    /// The same for the derivatives by x.
    slope: [[[f64; 8]; 3]; 2],
    /// (lambda l)^2 of the plane, whose bent functions take the place of the powers; 0 without axial force.
    square: f64,
    /// Derivative of the distance from either end, in lengths of the element, by x.
    rates: [f64; 2],
}

impl PlanarCubics {
    /// `None` where the direction involves more than one plane or bar.
    pub fn new(element: &RailElement, axis: usize, shapes: &ShapeCubics) -> Option<PlanarCubics> {
        let [group] = shapes.groups() else {
            return None;
        };
        let [first, last] = separated(element, axis)?;
        // One plane alone: its coefficients are in one of the two lists, and zero in the other.
        let bent = shapes.bent();
        let in_second = AxisLoad::new(element, &element.member_axes(), axis).uses()[3];
        let square = bent.map_or(0.0, |bent| bent.squares[usize::from(in_second)]);
        // Along x, far and near are exchanged where the member runs against the element.
        let exchange = |[a, b, c, d]: [[f64; 4]; 4]| [c, d, a, b];
        let ends = if element.is_reversed() {
            [exchange(last), exchange(first)]
        } else {
            [first, last]
        };
        let value: [[[f64; 8]; 4]; 2] = [0, 1].map(|end| {
            let shape = bent
                .filter(|_| in_second)
                .map_or(&group.cubic[end], |bent| &bent.across[0][end]);
            std::array::from_fn(|p| {
                std::array::from_fn(|k| {
                    if k < 4 {
                        shape[p][k]
                    } else {
                        ends[end][k - 4][p]
                    }
                })
            })
        });
        let rate = 1.0 / (element.x[1] - element.x[0]);
        let slope = [(0, rate), (1, -rate)].map(|(end, rate)| {
            [1.0, 2.0, 3.0].map(|p: f64| value[end][p as usize].map(|x| rate * p * x))
        });
        Some(PlanarCubics {
            index: group.index,
            value,
            slope,
            square,
            rates: [rate, -rate],
        })
    }

    /// Values of all eight at a place.
    #[inline]
    pub fn values(&self, LocalPlace { end, r }: LocalPlace) -> [f64; 8] {
        let [a, b, c, d] = &self.value[end];
        if self.square != 0.0 {
            return self.bent(end, &powers(self.square, r));
        }
        std::array::from_fn(|k| a[k] + r * (b[k] + r * (c[k] + r * d[k])))
    }

    /// Derivatives by x of all eight at a place.
    #[inline]
    pub fn slopes(&self, LocalPlace { end, r }: LocalPlace) -> [f64; 8] {
        let [a, b, c] = &self.slope[end];
        if self.square != 0.0 {
            let rate = self.rates[end];
            return self
                .bent(end, &power_derivatives(self.square, r)[0])
                .map(|slope| rate * slope);
        }
        std::array::from_fn(|k| a[k] + r * (b[k] + r * c[k]))
    }

    /// Second derivatives by x of all eight at a place. `scale` = 1/(extent in x).
    pub fn second_derivatives(&self, LocalPlace { end, r }: LocalPlace, scale: f64) -> [f64; 8] {
        if self.square != 0.0 {
            let second = power_derivatives(self.square, r)[1];
            return self.bent(end, &second).map(|value| scale * scale * value);
        }
        let scale = if end == 0 { scale } else { -scale };
        let [_, b, c] = &self.slope[end];
        std::array::from_fn(|k| scale * (b[k] + 2.0 * r * c[k]))
    }

    /// Sums of the coefficients times the functions of a plane under an axial force, or times their derivatives.
    #[inline]
    fn bent(&self, end: usize, of: &[f64; 4]) -> [f64; 8] {
        let [a, b, c, d] = &self.value[end];
        std::array::from_fn(|k| (a[k] * of[0] + b[k] * of[1]) + (c[k] * of[2] + d[k] * of[3]))
    }
}

/// Where a probe stands that [`PlanarCubics`] serve.
pub(crate) struct PlanarPlace<'a> {
    pub cubics: &'a PlanarCubics,
    /// Number of the element and direction: probes with the same number share their cubics.
    pub block: usize,
    /// Place in the element.
    pub at: LocalPlace,
    /// 1/(extent of the element in x).
    pub scale: f64,
}
