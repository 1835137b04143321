//! Shape rows: displacement of the rail at one place, by the node states at the ends of its element.

use super::beam_column::{power_derivatives, powers};
use super::element::{LocalPlace, MemberPlace};
use super::shape::ShapeCubics;

/// One row of the shape matrix N.
///
/// The displacement of the rail at a probe, along its axis, is the sum of [`ShapeRow::values`] times the degrees
/// of freedom [`ShapeRow::indices`], plus what the loads inside the element cause with its ends held. Degree of
/// freedom `6 * state + k` is a displacement for k = 0..3 and a rotation for k = 3..6, in the rail frame.
///
/// Made by [`crate::Rails::row`]:
///
/// ```
/// use splines::{Axis, RailElement, Flexibility, Rails, Probe};
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
/// let rail = Rails::new(vec![element])?;
/// let row = rail.row(Probe { rail: 0, x: 4.0, axis: Axis::Vertical })?;
/// // uy and rz of the first state, uy and rz of the second.
/// assert_eq!(row.indices(), [1, 5, 7, 11]);
/// assert_eq!(row.values(), [0.5, 1.0, 0.5, -1.0]);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeRow {
    /// Index of the element that carries the probe.
    pub element: usize,
    /// Component of the probe's axis: 0, 1 or 2.
    pub(crate) axis: usize,
    /// Place on the member.
    pub(crate) place: MemberPlace,
    /// Derivative of its distance from the first end by x.
    pub(crate) rate: f64,
    len: usize,
    groups: usize,
    index: [usize; 12],
    value: [f64; 12],
    slope: [f64; 12],
}

impl ShapeRow {
    pub(crate) const EMPTY: ShapeRow = ShapeRow {
        element: 0,
        axis: 0,
        place: MemberPlace { s: 0.0, q: 0.0 },
        rate: 0.0,
        len: 0,
        groups: 0,
        index: [0; 12],
        value: [0.0; 12],
        slope: [0.0; 12],
    };

    /// Degrees of freedom of the entries that do not vanish throughout the element: at most 12, each once.
    #[must_use]
    pub fn indices(&self) -> &[usize] {
        &self.index[..self.len]
    }

    /// Shape functions at the probe: without unit for displacements, a length for rotations.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.value[..self.len]
    }

    /// Derivatives of the values by the rail coordinate.
    #[must_use]
    pub fn slopes(&self) -> &[f64] {
        &self.slope[..self.len]
    }

    /// Evaluates the shape functions of an element at a place. `scale` = 1/(extent in x).
    #[inline]
    pub(crate) fn evaluate(
        &mut self,
        shapes: &ShapeCubics,
        LocalPlace { end, r }: LocalPlace,
        scale: f64,
    ) {
        let scale = if end == 0 { scale } else { -scale };
        self.len = shapes.len();
        self.groups = shapes.groups().len().min(3);
        let (indices, _) = self.index.as_chunks_mut::<4>();
        let (values, _) = self.value.as_chunks_mut::<4>();
        let (slopes, _) = self.slope.as_chunks_mut::<4>();
        if let Some(bent) = shapes.bent() {
            let of = bent.squares.map(|square| powers(square, r));
            let by_r = bent.squares.map(|square| power_derivatives(square, r)[0]);
            for (k, group) in shapes.groups().iter().take(3).enumerate() {
                indices[k] = group.index;
                values[k] = bent.sum(shapes.groups(), k, end, &of);
                slopes[k] = bent
                    .sum(shapes.groups(), k, end, &by_r)
                    .map(|slope| scale * slope);
            }
            return;
        }
        let out = indices.iter_mut().zip(values.iter_mut().zip(slopes));
        for (group, (index, (value, slope))) in shapes.groups().iter().zip(out) {
            let [a, b, c, d] = &group.cubic[end];
            *index = group.index;
            // Whole arrays are stored, so that later loads of whole arrays need not wait for single entries.
            *value = std::array::from_fn(|k| a[k] + r * (b[k] + r * (c[k] + r * d[k])));
            *slope = std::array::from_fn(|k| scale * (b[k] + r * (2.0 * c[k] + r * (3.0 * d[k]))));
        }
    }

    /// Values and slopes four at a time, the last group filled with zeros.
    #[inline]
    pub(crate) fn chunks(&self) -> [&[[f64; 4]]; 2] {
        [
            &self.value.as_chunks().0[..self.groups],
            &self.slope.as_chunks().0[..self.groups],
        ]
    }

    /// Degrees of freedom four at a time; fillers repeat a valid one.
    #[inline]
    pub(crate) fn index_chunks(&self) -> &[[usize; 4]] {
        &self.index.as_chunks().0[..self.groups]
    }
}
