//! The rows of all force elements over the degrees of freedom.
//!
//! The approach of element i to its rail (or its stretch, or its penetration into a stop) is e_i = R_i q + offset,
//! and its rate is R'_i v + offset'. Its force loads the degrees of freedom by f = -B_i^T F_i. B_i is R_i (or R'_i,
//! for forces along a rail), plus the component of the force along the rail due to the slope of the rail, if bodies
//! move freely along it.

use std::ops::Range;

use nalgebra::DVector;

use crate::mechanics::kinematics::Kinematics;
use crate::numerics::dense::dot;

/// Rows of all elements, row-major.
#[derive(Clone)]
pub(crate) struct Rows {
    dofs: usize,
    /// Degrees of freedom from the first to the last on which each row depends; its other entries are zero.
    spans: Vec<Range<usize>>,
    /// R, the rows of the approach without the deflection of the rails, and its offset.
    pub approach: Vec<f64>,
    pub approach_offset: Vec<f64>,
    /// R', the rows of the rates of dampers and friction, and their offset.
    pub rate: Vec<f64>,
    pub rate_offset: Vec<f64>,
    /// B, the rows of the loads on the degrees of freedom.
    pub force: Vec<f64>,
    /// Derivative of each approach along the rail due to the shape of the unloaded rail, d e/d x.
    pub rise: Vec<f64>,
}

/// The row of one element, for writing.
pub(crate) struct RowMut<'r> {
    pub approach: &'r mut [f64],
    pub approach_offset: &'r mut f64,
    pub rate: &'r mut [f64],
    pub rate_offset: &'r mut f64,
    pub rise: &'r mut f64,
}

impl Rows {
    /// Rows of zeros that depend on the degrees of freedom `spans`, one for each element.
    pub fn zeros(spans: Vec<Range<usize>>, dofs: usize) -> Self {
        let elements = spans.len();
        Rows {
            dofs,
            spans,
            approach: vec![0.0; elements * dofs],
            approach_offset: vec![0.0; elements],
            rate: vec![0.0; elements * dofs],
            rate_offset: vec![0.0; elements],
            force: vec![0.0; elements * dofs],
            rise: vec![0.0; elements],
        }
    }

    /// Copies the offset of the approach of element `i` from `constant`, and approach and rate where they have
    /// changed; sets its `rise` to zero.
    #[inline]
    pub fn reset(
        &mut self,
        i: usize,
        constant: &Rows,
        [approach_has_changed, rate_has_changed]: [bool; 2],
    ) {
        let span = self.span(i);
        if approach_has_changed {
            self.approach[span.clone()].copy_from_slice(&constant.approach[span.clone()]);
        }
        if rate_has_changed {
            self.rate[span.clone()].copy_from_slice(&constant.rate[span]);
        }
        self.approach_offset[i] = constant.approach_offset[i];
        self.rise[i] = 0.0;
    }

    /// Places of the entries of row `i` that are not always zero.
    #[inline]
    pub fn span(&self, i: usize) -> Range<usize> {
        let span = &self.spans[i];
        i * self.dofs + span.start..i * self.dofs + span.end
    }

    /// The row of element `i`, for writing.
    #[inline]
    pub fn row_mut(&mut self, i: usize) -> RowMut<'_> {
        let span = i * self.dofs..(i + 1) * self.dofs;
        RowMut {
            approach: &mut self.approach[span.clone()],
            approach_offset: &mut self.approach_offset[i],
            rate: &mut self.rate[span],
            rate_offset: &mut self.rate_offset[i],
            rise: &mut self.rise[i],
        }
    }

    /// R_i.
    #[inline]
    pub fn approach_row(&self, i: usize) -> &[f64] {
        &self.approach[i * self.dofs..(i + 1) * self.dofs]
    }

    /// R'_i.
    #[inline]
    pub fn rate_row(&self, i: usize) -> &[f64] {
        &self.rate[i * self.dofs..(i + 1) * self.dofs]
    }

    /// B_i.
    pub fn force_row(&self, i: usize) -> &[f64] {
        &self.force[i * self.dofs..(i + 1) * self.dofs]
    }

    /// Approach of element `i` at the degrees of freedom `q`, without the deflection of the rails.
    #[inline]
    pub fn approach_at(&self, i: usize, q: &DVector<f64>) -> f64 {
        self.approach_offset[i] + self.approach_along(i, q)
    }

    /// R_i times a vector over the degrees of freedom.
    #[inline]
    pub fn approach_along(&self, i: usize, vector: &DVector<f64>) -> f64 {
        dot(
            &self.approach[self.span(i)],
            &vector.as_slice()[self.spans[i].clone()],
        )
    }

    /// R'_i times a vector over the degrees of freedom.
    #[inline]
    pub fn rate_along(&self, i: usize, vector: &DVector<f64>) -> f64 {
        dot(
            &self.rate[self.span(i)],
            &vector.as_slice()[self.spans[i].clone()],
        )
    }

    /// Rate for the damper or the friction law of element `i` at the speeds `v`.
    #[inline]
    pub fn rate_at(&self, i: usize, v: &DVector<f64>) -> f64 {
        self.rate_offset[i] + self.rate_along(i, v)
    }
}

impl RowMut<'_> {
    /// Adds `scale` times the linear combination `line` of the displacements of a body to the approach. The constant
    /// part of x is omitted because it is the position along the rail.
    pub fn add_approach(
        &mut self,
        kinematics: &Kinematics,
        body: usize,
        line: [f64; 6],
        scale: f64,
    ) {
        let (terms, constant) = (kinematics.terms(body), kinematics.constant(body));
        for (i, entry) in line.into_iter().enumerate() {
            for &(number, coefficient) in &terms[i] {
                self.approach[number] += scale * entry * coefficient;
            }
            if i > 0 {
                *self.approach_offset += scale * entry * constant[i];
            }
        }
    }

    /// Adds the linear combination `line` of the speeds of a body to the rate.
    pub fn add_rate(&mut self, kinematics: &Kinematics, body: usize, line: [f64; 6]) {
        for (entry, terms) in line.into_iter().zip(kinematics.terms(body)) {
            for &(number, coefficient) in terms {
                self.rate[number] += entry * coefficient;
            }
        }
    }
}
