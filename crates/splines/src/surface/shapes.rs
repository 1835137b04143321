//! Given motions of rails: what a mode or any other motion of the node states does at a probe.

use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use crate::error::Error;
use crate::probe::Probe;
use crate::rail::{EndForm, LocalPlace, MemberMotion, Rails};

/// Number of shapes from which wide vector registers are used.
const WIDE: usize = 16;

/// Motions of rails by the motions of their node states, phi_r(p) = N(p) s_r, and if given by motions of their members
/// between the ends.
///
/// Along an element each is a polynomial, stored when a probe first stands on the element: by its values and slopes at
/// the element's ends, four numbers a shape that replace the up to twelve entries of N, and, where the member has motions
/// of its own, by five more ([`RailShapes::with_member_motions`]).
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
    /// By element and direction.
    elements: Vec<[OnceLock<ElementShapes>; 3]>,
    /// For each element the motions of its member between the ends. Empty where no element has any.
    between: Vec<Vec<MemberMotion>>,
    /// Shapes x motions of all elements in their order: their amplitudes.
    amplitudes: DMatrix<f64>,
    /// For each element the first column of its amplitudes.
    first: Vec<usize>,
}

/// All shapes along one element in one direction.
#[derive(Clone, Debug)]
struct ElementShapes {
    /// The values of all shapes at the first end, then their slopes there by the fraction of the element, then both at
    /// the last end.
    ends: Vec<f64>,
    /// If the member has motions of its own: the coefficients of all shapes for each power of the fraction s of its
    /// length, in the quotient of their rest by s^2 (1 - s)^2.
    quotients: Vec<f64>,
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
            return Err(Error::NodalShape {
                rows,
                columns,
                expected,
            });
        }
        Ok(RailShapes {
            elements: line.elements().iter().map(|_| Default::default()).collect(),
            rails: line,
            motions: states.transpose(),
            between: Vec::new(),
            amplitudes: DMatrix::zeros(0, 0),
            first: Vec::new(),
        })
    }

    /// The same shapes with motions of the members between their ends added. `between` has the motions of the member of
    /// each element; `amplitudes` is motions x shapes, with the motions of all elements in their order.
    ///
    /// # Errors
    /// Another number of elements, motions or shapes.
    pub fn with_member_motions(
        mut self,
        between: Vec<Vec<MemberMotion>>,
        amplitudes: &DMatrix<f64>,
    ) -> Result<RailShapes, Error> {
        let mut first = Vec::with_capacity(between.len());
        let mut count = 0;
        for motions in &between {
            first.push(count);
            count += motions.len();
        }
        let (rows, columns) = amplitudes.shape();
        if between.len() != self.elements.len() || rows != count || columns != self.count() {
            return Err(Error::NodalShape {
                rows,
                columns,
                expected: count,
            });
        }
        self.elements = between.iter().map(|_| Default::default()).collect();
        (self.between, self.amplitudes, self.first) = (between, amplitudes.transpose(), first);
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
        if self.rails.elements()[span.element].flexibility.tension != 0.0 {
            return self.row_under_tension(at, value, slope);
        }
        let axis = at.axis.component();
        let of = self.elements[span.element][axis].get_or_init(|| self.along(span.element, axis));
        let reversed = self.rails.elements()[span.element].is_reversed();
        let (place, scale) = (span.local(at.x), span.scale);
        of.fill(
            count,
            hermite(place, scale),
            || quotient_weights(place, reversed, scale),
            value,
            slope,
        );
        Ok(())
    }

    /// [`RailShapes::row`] on an element with an axial force, along which the shapes are no polynomials.
    fn row_under_tension(
        &self,
        at: Probe,
        value: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), Error> {
        let row = self.rails.row(at)?;
        value.fill(0.0);
        slope.fill(0.0);
        let mut add = |weights: [f64; 2], motions: &mut dyn Iterator<Item = &f64>| {
            for ((value, slope), motion) in value.iter_mut().zip(slope.iter_mut()).zip(motions) {
                *value += weights[0] * motion;
                *slope += weights[1] * motion;
            }
        };
        for ((&k, &shape), &by_x) in row.indices().iter().zip(row.values()).zip(row.slopes()) {
            add([shape, by_x], &mut self.motions.column(k).iter());
        }
        for (k, motion) in self
            .between
            .get(row.element)
            .into_iter()
            .flatten()
            .enumerate()
        {
            let weights = self.rails.member_motion(at, motion)?;
            add(
                weights,
                &mut self.amplitudes.column(self.first[row.element] + k).iter(),
            );
        }
        Ok(())
    }

    /// Sum over the loads of force times displacement of each shape.
    pub(super) fn under(&self, loads: &[(Probe, f64)]) -> Result<Vec<f64>, Error> {
        let mut out = vec![0.0; self.count()];
        let (mut value, mut slope) = (out.clone(), out.clone());
        for (probe, force) in loads {
            self.row(*probe, &mut value, &mut slope)?;
            out.iter_mut()
                .zip(&value)
                .for_each(|(sum, shape)| *sum += shape * force);
        }
        Ok(out)
    }

    /// All shapes along an element.
    fn along(&self, element: usize, axis: usize) -> ElementShapes {
        let count = self.count();
        let rows = self.rails.end_rows(element, axis);
        let parts = rows
            .iter()
            .flat_map(|row| [(row, row.values()), (row, row.slopes())]);
        let sum = |indices: &[usize], weights: &[f64], shape: usize| -> f64 {
            indices
                .iter()
                .zip(weights)
                .map(|(&k, weight)| weight * self.motions[(shape, k)])
                .sum()
        };
        let mut ends: Vec<f64> = parts
            .flat_map(|(row, weights)| {
                (0..count).map(move |shape| sum(row.indices(), weights, shape))
            })
            .collect();
        let own = &self.rails.elements()[element];
        let motions = self.between.get(element).map_or(&[][..], |motions| motions);
        let mut quotients = vec![0.0; if motions.is_empty() { 0 } else { 5 * count }];
        for (k, motion) in motions.iter().enumerate() {
            let EndForm {
                mut values,
                mut slopes,
                quotient,
            } = EndForm::of(&motion.of_rail(own, axis));
            if own.is_reversed() {
                // Seen along the rail, the member begins with its last end.
                (values, slopes) = ([values[1], values[0]], [-slopes[1], -slopes[0]]);
            }
            let amplitudes = self.amplitudes.column(self.first[element] + k);
            for (shape, amplitude) in amplitudes.iter().enumerate() {
                ends[shape] += values[0] * amplitude;
                ends[count + shape] += slopes[0] * amplitude;
                ends[2 * count + shape] += values[1] * amplitude;
                ends[3 * count + shape] += slopes[1] * amplitude;
                for (power, c) in quotient.iter().enumerate() {
                    quotients[power * count + shape] += c * amplitude;
                }
            }
        }
        ElementShapes { ends, quotients }
    }
}

impl ElementShapes {
    /// Writes the values and slopes of all `count` shapes by the weights of their end values and slopes, and of their
    /// quotients.
    fn fill(
        &self,
        count: usize,
        weights: ([f64; 4], [f64; 4]),
        of_quotients: impl FnOnce() -> [[f64; 2]; 5],
        value: &mut [f64],
        slope: &mut [f64],
    ) {
        if count >= WIDE {
            Arch::new().dispatch(Fill {
                shapes: self,
                count,
                weights,
                of_quotients,
                value,
                slope,
            });
        } else {
            self.sum(count, weights, of_quotients, value, slope);
        }
    }

    /// The sums of [`ElementShapes::fill`], compiled for the vector registers of the caller.
    #[inline(always)]
    fn sum(
        &self,
        count: usize,
        ([p, q, r, s], [dp, dq, dr, ds]): ([f64; 4], [f64; 4]),
        weights: impl FnOnce() -> [[f64; 2]; 5],
        value: &mut [f64],
        slope: &mut [f64],
    ) {
        let (first, last) = self.ends.split_at(2 * count);
        let ((a, b), (c, d)) = (first.split_at(count), last.split_at(count));
        let data = a.iter().zip(b).zip(c.iter().zip(d));
        let out = value.iter_mut().zip(slope);
        if self.quotients.is_empty() {
            for ((value, slope), ((a, b), (c, d))) in out.zip(data) {
                *value = p * a + q * b + r * c + s * d;
                *slope = dp * a + dq * b + dr * c + ds * d;
            }
            return;
        }
        let (e, rest) = self.quotients.split_at(count);
        let (f, rest) = rest.split_at(count);
        let (g, rest) = rest.split_at(count);
        let (h, i) = rest.split_at(count);
        let [t, u, v, w, x] = weights();
        let quotients = e.iter().zip(f).zip(g.iter().zip(h)).zip(i);
        for (((value, slope), ((a, b), (c, d))), (((e, f), (g, h)), i)) in
            out.zip(data).zip(quotients)
        {
            *value = (p * a + q * b + r * c + s * d)
                + (t[0] * e + u[0] * f + v[0] * g + w[0] * h + x[0] * i);
            *slope = (dp * a + dq * b + dr * c + ds * d)
                + (t[1] * e + u[1] * f + v[1] * g + w[1] * h + x[1] * i);
        }
    }
}

/// [`ElementShapes::fill`] for many shapes, compiled for several sets of vector registers.
struct Fill<'a, W> {
    shapes: &'a ElementShapes,
    count: usize,
    weights: ([f64; 4], [f64; 4]),
    of_quotients: W,
    value: &'a mut [f64],
    slope: &'a mut [f64],
}

impl<W: FnOnce() -> [[f64; 2]; 5]> WithSimd for Fill<'_, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.shapes.sum(
            self.count,
            self.weights,
            self.of_quotients,
            self.value,
            self.slope,
        );
    }
}

/// Weights of the coefficients of a quotient in the value at a place, and the derivatives of these weights by x:
/// s^p s^2 (1 - s)^2 with s along the member.
fn quotient_weights(
    LocalPlace { end, r }: LocalPlace,
    reversed: bool,
    scale: f64,
) -> [[f64; 2]; 5] {
    let s = if (end == 0) == reversed { 1.0 - r } else { r };
    let scale = if reversed { -scale } else { scale };
    let product = r * (1.0 - r);
    let (double, steep) = (product * product, 2.0 * product * (1.0 - 2.0 * s));
    let mut out = [[0.0; 2]; 5];
    let (mut power, mut derivative) = (1.0, 0.0);
    for weights in &mut out {
        *weights = [
            double * power,
            scale * (steep * power + double * derivative),
        ];
        derivative = s * derivative + power;
        power *= s;
    }
    out
}

/// Weights of the values and slopes at both ends of an element in the value at a place, and the derivatives
/// of these weights by x. `scale` = 1/(extent in x). They are computed from the distance to the nearer end,
/// so that those which vanish there do so exactly.
fn hermite(LocalPlace { end, r }: LocalPlace, scale: f64) -> ([f64; 4], [f64; 4]) {
    let far = r * r * (3.0 - 2.0 * r);
    let [value, slope, value_far, slope_far] = [
        1.0 - far,
        r * (1.0 - r) * (1.0 - r),
        far,
        -r * r * (1.0 - r),
    ];
    let steep = 6.0 * r * (1.0 - r);
    let by = [
        -steep,
        (1.0 - r) * (1.0 - 3.0 * r),
        steep,
        r * (3.0 * r - 2.0),
    ]
    .map(|weight| weight * scale);
    if end == 0 {
        ([value, slope, value_far, slope_far], by)
    } else {
        // Seen from the last end, x runs backwards.
        (
            [value_far, -slope_far, value, -slope],
            [-by[2], by[3], -by[0], by[1]],
        )
    }
}
