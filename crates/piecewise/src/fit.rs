//! Polynomials that follow a function of several columns within tolerances.
//!
//! The function is evaluated at the nodes of degree 4, and once more between the two of them about which the error of the
//! polynomials is largest. If they meet the value there, and their coefficients fall, they are taken. Otherwise the same is done with degree 8, whose nodes are
//! those of degree 4 and others, one of which is known. Where those of the highest degree miss their value, the interval is halved.

use crate::function::Piecewise;
use crate::lobatto::Lobatto;

/// The degrees that are tried.
const DEGREES: [usize; 2] = [4, 8];

/// The node among those of twice the degree at which polynomials are tested: their error is proportional to sin(theta)
/// sin(n theta) with x = cos(theta), which is largest about the middle.
const TESTED: [usize; 2] = [3, 7];

/// Largest coefficient of the highest Chebyshev polynomial, per unit of what is allowed. Where the function has a corner the
/// polynomials may meet the value at one place by chance, but their coefficients do not fall.
const LAST: f64 = 16.0;

/// Number of times an interval is halved at most.
const HALVINGS: usize = 40;

/// Appends the values of all columns at a share of the interval; returns whether they are those of the function. Where they are
/// estimates, the interval is not halved.
pub type Evaluate<'a, E> = dyn FnMut(f64, &mut Vec<f64>) -> Result<bool, E> + 'a;

/// Appends a function to `to` in the interval. `ends` are its values, those of all columns, at both ends; `evaluate` appends those
/// at a share of the interval. `differs` is whether a row misses another, which is given second, by more than is allowed. Parts of
/// the interval that are shorter than `shortest`, relative to it, are not halved.
///
/// # Errors
/// Those of `evaluate`.
pub fn fit<E>(
    to: &mut Piecewise,
    interval: [f64; 2],
    shortest: f64,
    [first, last]: [&[f64]; 2],
    evaluate: &mut Evaluate<'_, E>,
    differs: &dyn Fn(&[f64], &[f64]) -> bool,
) -> Result<(), E> {
    let mut follow = Follow {
        whole: interval,
        shortest,
        evaluate,
        differs,
        row: vec![0.0; to.width()],
        zero: vec![0.0; to.width()],
        to,
    };
    follow.part([0.0, 1.0], [first, last], 0)
}

struct Follow<'a, E> {
    to: &'a mut Piecewise,
    whole: [f64; 2],
    shortest: f64,
    evaluate: &'a mut Evaluate<'a, E>,
    differs: &'a dyn Fn(&[f64], &[f64]) -> bool,
    row: Vec<f64>,
    zero: Vec<f64>,
}

impl<E> Follow<'_, E> {
    /// The time at a share of the whole interval.
    fn time(&self, share: f64) -> f64 {
        let [from, to] = self.whole;
        if share == 1.0 {
            to
        } else {
            from + share * (to - from)
        }
    }

    /// Follows the function in a part of the whole interval with the values at its ends.
    fn part(
        &mut self,
        [from, to]: [f64; 2],
        [first, last]: [&[f64]; 2],
        halvings: usize,
    ) -> Result<(), E> {
        let (width, most) = (self.to.width(), DEGREES[DEGREES.len() - 1]);
        let [start, end] = [from, to].map(|share| self.time(share));
        // the values known so far, in the order in which they were found, and where those of each node of twice the highest
        // degree are among them
        let mut values = Vec::with_capacity((most + 2) * width);
        values.extend_from_slice(first);
        values.extend_from_slice(last);
        let mut place = [None; 2 * MOST + 1];
        let mut is_known = true;
        (place[0], place[2 * most]) = (Some(0), Some(1));
        for (degree, tested) in DEGREES.into_iter().zip(TESTED) {
            let stride = 2 * most / degree;
            let nodes = (0..=degree).map(|k| k * stride);
            let test = tested * stride / 2;
            for at in nodes.clone().chain([test]) {
                if place[at].is_none() {
                    place[at] = Some(values.len() / width.max(1));
                    let share = Lobatto::of(2 * most).nodes()[at];
                    is_known &= (self.evaluate)(from + share * (to - from), &mut values)?;
                }
            }
            let row = |at: usize| {
                let first = place[at].unwrap_or_default() * width;
                &values[first..first + width]
            };
            let weights = Lobatto::of(degree).weights(Lobatto::of(2 * degree).nodes()[tested]);
            self.row.fill(0.0);
            for (weight, at) in weights.iter().zip(nodes.clone()) {
                let terms = self.row.iter_mut().zip(row(at));
                terms.for_each(|(sum, value)| *sum += weight * value);
            }
            let is_met = !(self.differs)(&self.row, row(test)) && {
                // the coefficient of the highest Chebyshev polynomial
                self.row.fill(0.0);
                for (k, at) in nodes.clone().enumerate() {
                    let half = if k == 0 || k == degree { 0.5 } else { 1.0 };
                    let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
                    let weight = half * sign / (degree as f64 * LAST);
                    let terms = self.row.iter_mut().zip(row(at));
                    terms.for_each(|(sum, value)| *sum += weight * value);
                }
                !(self.differs)(&self.row, &self.zero)
            };
            let middle = 0.5 * (from + to);
            let can_halve = is_known
                && halvings < HALVINGS
                && to - from > 2.0 * self.shortest
                && self.time(middle) > start
                && self.time(middle) < end;
            if is_met || (degree == most && !can_halve) {
                self.to.push([start, end], degree, nodes.map(row));
                return Ok(());
            }
        }
        let middle = 0.5 * (from + to);
        let centre = place[most].unwrap_or_default() * width;
        let centre = values[centre..centre + width].to_vec();
        self.part([from, middle], [first, &centre], halvings + 1)?;
        self.part([middle, to], [&centre, last], halvings + 1)
    }
}

/// The highest degree.
const MOST: usize = DEGREES[DEGREES.len() - 1];

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;
    use crate::function::Side;

    /// A smooth function and one with a corner are followed within the tolerance.
    #[test]
    fn functions_are_followed() {
        let exact = |t: f64| [(5.0 * t).sin(), (t - 0.737).abs(), (t - 1.737).abs()];
        let mut own = Piecewise::new(3);
        let mut count = 0;
        let mut evaluate = |share: f64, row: &mut Vec<f64>| -> Result<bool, Infallible> {
            count += 1;
            row.extend(exact(1.0 + 2.0 * share));
            Ok(true)
        };
        let differs = |a: &[f64], b: &[f64]| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-6);
        let ends = [1.0, 3.0].map(exact);
        let ends = ends.each_ref().map(|row| row.as_slice());
        fit(&mut own, [1.0, 3.0], 1e-9, ends, &mut evaluate, &differs)
            .expect("the function has no errors");
        for k in 0..=1000 {
            let t = 1.0 + f64::from(k) / 500.0;
            for (column, exact) in exact(t).into_iter().enumerate() {
                let found = own.value(t, Side::After, column);
                assert!((found - exact).abs() < 2e-6, "{t} {column}: {found}");
            }
        }
        assert!(count < 400, "{count} evaluations");
    }

    /// A corner between estimates is not sought: one interval with the values at nine nodes and a test.
    #[test]
    fn estimates_are_not_refined() {
        let mut own = Piecewise::new(1);
        let mut count = 0;
        let mut evaluate = |share: f64, row: &mut Vec<f64>| -> Result<bool, Infallible> {
            count += 1;
            row.push((share - 0.3).abs());
            Ok(false)
        };
        let differs = |a: &[f64], b: &[f64]| (a[0] - b[0]).abs() > 1e-9;
        fit(
            &mut own,
            [0.0, 1.0],
            1e-9,
            [&[0.3], &[0.7]],
            &mut evaluate,
            &differs,
        )
        .expect("the function has no errors");
        assert_eq!((own.len(), count), (1, 8));
    }
}
