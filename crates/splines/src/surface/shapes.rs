//! Given motions of rails: what a mode or any other motion of the node states does at a probe.

use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;

use crate::error::Error;
use crate::probe::Probe;
use crate::rail::{LocalPlace, Rails};

/// Motions of rails by the motions of their node states, phi_r(p) = N(p) s_r, and if given by uniform loads on their
/// members.
///
/// Along an element each is a cubic, stored by its values and slopes at the element's ends when a probe first
/// stands on the element. Four numbers a shape then replace the up to twelve entries of N.
///
/// ```
/// use std::sync::Arc;
///
/// use nalgebra::DMatrix;
/// use splines::{Axis, RailElement, Flexibility, Rails, Probe, RailShapes};
///
/// let element = RailElement {
///     rail: 0,
///     x: [0.0, 8.0],
///     ends: [0, 1],
///     length: 8.0,
///     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     offset: [0.0; 3],
///     flexibility: Flexibility { bending_z: 1.0, ..Flexibility::default() },
///     member: None,
/// };
/// // One shape: the second end rises by one, without rotation.
/// let mut states = DMatrix::zeros(12, 1);
/// states[(7, 0)] = 1.0;
/// let shapes = RailShapes::new(Arc::new(Rails::new(vec![element])?), states)?;
/// let (mut value, mut slope) = ([0.0], [0.0]);
/// shapes.row(Probe { rail: 0, x: 4.0, axis: Axis::Vertical }, &mut value, &mut slope)?;
/// assert_eq!((value[0], slope[0]), (0.5, 1.5 / 8.0));
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct RailShapes {
    rails: Arc<Rails>,
    /// Shapes x degrees of freedom: what a place needs of all shapes is contiguous.
    motions: DMatrix<f64>,
    /// By element and direction: the values of all shapes at the first end, then their slopes there by the
    /// fraction of the element, then both at the last end.
    ends: Vec<[OnceLock<Vec<f64>>; 3]>,
    /// Shapes x (two for each element): intensities of uniform loads on the members, under which they deflect between
    /// their ends. Without columns where there are none.
    loads: DMatrix<f64>,
}

impl RailShapes {
    /// Shapes of the rails `line`. `states` is 6 S x shapes with S = `line.states()`: column r holds the
    /// motions s_r of the node states.
    ///
    /// # Errors
    /// A number of rows other than 6 S.
    pub fn new(line: Arc<Rails>, states: DMatrix<f64>) -> Result<RailShapes, Error> {
        let expected = 6 * line.state_count();
        let (rows, columns) = states.shape();
        if rows != expected {
            return Err(Error::NodalShape { rows, columns, expected });
        }
        let ends = line.elements().iter().map(|_| Default::default()).collect();
        let loads = DMatrix::zeros(states.ncols(), 0);
        Ok(RailShapes { rails: line, motions: states.transpose(), ends, loads })
    }

    /// The same shapes with deflections of the members between their ends added: those of clamped members under uniform
    /// loads along their local y and z axes ([`Rails::uniform_load`]). `loads` is 2 E x shapes for E elements: rows
    /// 2 e and 2 e + 1 hold the intensities on the member of element e.
    ///
    /// # Errors
    /// Another number of rows or columns.
    pub fn with_uniform_loads(mut self, loads: &DMatrix<f64>) -> Result<RailShapes, Error> {
        let expected = 2 * self.rails.elements().len();
        let (rows, columns) = loads.shape();
        if rows != expected || columns != self.count() {
            return Err(Error::NodalShape { rows, columns, expected });
        }
        self.loads = loads.transpose();
        Ok(self)
    }

    /// Number of shapes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.motions.nrows()
    }

    /// Writes the displacement of each shape at `at`, along its axis, into `value`, and its derivative along
    /// the rail into `slope`; both have one entry a shape.
    ///
    /// # Errors
    /// A probe beyond its rail, or in a direction that nothing resists.
    pub fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), Error> {
        let span = self.rails.stiff_span(at)?;
        let count = self.count();
        if count == 0 {
            return Ok(());
        }
        let axis = at.axis.component();
        let ends = self.ends[span.element][axis].get_or_init(|| self.ends(span.element, axis));
        let ([p, q, r, s], [dp, dq, dr, ds]) = hermite(span.local(at.x), span.scale);
        let (first, last) = ends.split_at(2 * count);
        let ((a, b), (c, d)) = (first.split_at(count), last.split_at(count));
        let data = a.iter().zip(b).zip(c.iter().zip(d));
        for ((value, slope), ((a, b), (c, d))) in value.iter_mut().zip(slope.iter_mut()).zip(data) {
            *value = p * a + q * b + r * c + s * d;
            *slope = dp * a + dq * b + dr * c + ds * d;
        }
        if self.loads.ncols() > 0 {
            let planes = self.rails.uniform_load_on(span, at);
            for (plane, [w, dw]) in planes.into_iter().enumerate().filter(|(_, of)| *of != [0.0; 2]) {
                let first = (2 * span.element + plane) * count;
                let loads = &self.loads.as_slice()[first..first + count];
                value.iter_mut().zip(loads).for_each(|(value, load)| *value += w * load);
                slope.iter_mut().zip(loads).for_each(|(slope, load)| *slope += dw * load);
            }
        }
        Ok(())
    }

    /// Sum over the loads of force times displacement of each shape.
    pub(super) fn under(&self, loads: &[(Probe, f64)]) -> Result<Vec<f64>, Error> {
        let mut out = vec![0.0; self.count()];
        let (mut value, mut slope) = (out.clone(), out.clone());
        for (probe, force) in loads {
            self.row(*probe, &mut value, &mut slope)?;
            out.iter_mut().zip(&value).for_each(|(sum, shape)| *sum += shape * force);
        }
        Ok(out)
    }

    /// Values and slopes of all shapes at both ends of an element.
    fn ends(&self, element: usize, axis: usize) -> Vec<f64> {
        let rows = self.rails.end_rows(element, axis);
        let parts = rows.iter().flat_map(|row| [(row, row.values()), (row, row.slopes())]);
        let sum = |indices: &[usize], weights: &[f64], shape: usize| -> f64 {
            indices.iter().zip(weights).map(|(&k, weight)| weight * self.motions[(shape, k)]).sum()
        };
        parts
            .flat_map(|(row, weights)| (0..self.count()).map(move |shape| sum(row.indices(), weights, shape)))
            .collect()
    }
}

/// Weights of the values and slopes at both ends of an element in the value at a place, and the derivatives
/// of these weights by x. `scale` = 1/(extent in x). They are computed from the distance to the nearer end,
/// so that those which vanish there do so exactly.
fn hermite(LocalPlace { end, r }: LocalPlace, scale: f64) -> ([f64; 4], [f64; 4]) {
    let far = r * r * (3.0 - 2.0 * r);
    let [value, slope, value_far, slope_far] =
        [1.0 - far, r * (1.0 - r) * (1.0 - r), far, -r * r * (1.0 - r)];
    let steep = 6.0 * r * (1.0 - r);
    let by = [-steep, (1.0 - r) * (1.0 - 3.0 * r), steep, r * (3.0 * r - 2.0)].map(|weight| weight * scale);
    if end == 0 {
        ([value, slope, value_far, slope_far], by)
    } else {
        // Seen from the last end, x runs backwards.
        ([value_far, -slope_far, value, -slope], [-by[2], by[3], -by[0], by[1]])
    }
}
