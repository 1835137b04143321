//! The compliance of the rails between force elements.
//!
//! Elements on different structures do not deflect the rails of one another, and those on no compliant structure deflect
//! none. The rows of the matrices are over all elements, and products use the span of those that can differ from zero.

use std::ops::Range;

use super::probes::Probes;
use crate::numerics::dense::dot;

/// Compliance matrices over all elements, row-major.
#[derive(Clone)]
pub(crate) struct RailMatrices {
    /// G: deflection of the rail at element i per unit of force j.
    pub value: Vec<f64>,
    /// d G(i, j)/d x_i, where x_i is the position of element i along its rail.
    pub slope: Vec<f64>,
    /// Derivative of G(i, j) with respect to the position of each tangential contact of element i, over elements j.
    pub tangential: Vec<f64>,
    elements: usize,
    /// Columns of each row, from the first to the last element of its structures, outside of which its entries are
    /// zero; none where no compliant structure bears the element.
    spans: Vec<Range<usize>>,
    /// The same of the rows of tangential contacts.
    tangential_spans: Vec<Range<usize>>,
}

impl RailMatrices {
    /// Matrices of zeros for `elements` elements with `probes` on structures, of which those comply for which
    /// `complies` returns true.
    pub fn zeros(elements: usize, probes: &Probes, complies: impl Fn(usize) -> bool) -> Self {
        let tangential = probes.tangential.len();
        let mut spans = vec![0..0; elements];
        let compliant = probes
            .entries
            .iter()
            .enumerate()
            .filter(|(s, _)| complies(*s));
        for (_, entries) in compliant {
            let all = || entries.iter().map(|entry| entry.element);
            let (Some(first), Some(last)) = (all().min(), all().max()) else {
                continue;
            };
            for i in all() {
                let known = spans[i].clone();
                spans[i] = if known.is_empty() {
                    first..last + 1
                } else {
                    known.start.min(first)..known.end.max(last + 1)
                };
            }
        }
        RailMatrices {
            value: vec![0.0; elements * elements],
            slope: vec![0.0; elements * elements],
            tangential: vec![0.0; elements * tangential],
            elements,
            tangential_spans: probes
                .tangential
                .iter()
                .map(|own| spans[own.element].clone())
                .collect(),
            spans,
        }
    }

    /// Replaces the values of G by the given rows; its slopes are unchanged.
    pub fn set_value(&mut self, rows: impl Iterator<Item = impl AsRef<[f64]>>) {
        let elements = self.elements;
        for (row, values) in self.value.chunks_exact_mut(elements).zip(rows) {
            row.copy_from_slice(&values.as_ref()[..elements]);
        }
        self.spans.fill(0..elements);
    }

    /// Columns outside of which the entries of row `i` are zero.
    #[inline]
    pub fn span(&self, i: usize) -> Range<usize> {
        self.spans[i].clone()
    }

    /// Deflection of the rail at element `i` under the forces `force`.
    #[inline]
    pub fn deflection(&self, i: usize, force: &[f64]) -> f64 {
        self.product(&self.value, i, self.span(i), force)
    }

    /// Slope of the deflected rail at element `i` under the forces `force`.
    #[inline]
    pub fn deflected_slope(&self, i: usize, force: &[f64]) -> f64 {
        self.product(&self.slope, i, self.span(i), force)
    }

    /// Slope of the displacement of the rail at tangential contact `contact` under the forces `force`.
    #[inline]
    pub fn tangential_slope(&self, contact: usize, force: &[f64]) -> f64 {
        self.product(
            &self.tangential,
            contact,
            self.tangential_spans[contact].clone(),
            force,
        )
    }

    /// Adds `share` times row `i` of the slopes to `sum`.
    #[inline]
    pub fn add_slopes(&self, i: usize, share: f64, sum: &mut [f64]) {
        let span = self.span(i);
        let row = &self.slope[i * self.elements..][span.clone()];
        sum[span]
            .iter_mut()
            .zip(row)
            .for_each(|(sum, slope)| *sum += share * slope);
    }

    #[inline]
    fn product(&self, rows: &[f64], i: usize, span: Range<usize>, force: &[f64]) -> f64 {
        dot(&rows[i * self.elements..][span.clone()], &force[span])
    }
}
