//! Sizes of the terms from which the functions of an element are computed, for bounds of rounding errors.

use super::element::{LocalPlace, RailElement};
use super::green::{BENT_ROUNDINGS, ClampedElement};
use super::load::{AxisLoad, without_rounding};
use super::shape::{Planes, cubics, local_cubics};
use crate::vector::{cross, unit};

/// Sizes of the terms from which shape row and Green's function at one probe are computed, as
/// [`crate::Rails::rounding_sizes`] gives them.
///
/// A computed value errs by a few units of rounding of its size; where its place is known to within an error, it
/// also errs by its `moved` part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoundingSizes {
    /// For each degree of freedom of the first end, then of the last, the sum of the absolute values of the terms of
    /// the shape row.
    pub row: [f64; 12],
    /// By how much the error of the place can change them.
    pub moved_row: [f64; 12],
    /// The same sum for Green's function of the clamped element at the probe.
    pub green: f64,
    /// By how much the error of the place can change it.
    pub moved_green: f64,
    /// Green's function under loads in all directions, of the size that an error of the axes can add to a load.
    pub turned_green: f64,
}

impl RoundingSizes {
    /// Sizes at `place` along direction `axis`. `axes` is the error of the axes in roundings, 0 where they are exact;
    /// `shift` is the error of the place in lengths of the element. `least` is the size of a component that counts
    /// as zero in doubles, in its scale: 0 where it is kept.
    pub(super) fn new(
        element: &RailElement,
        clamped: Option<&ClampedElement>,
        axis: usize,
        place: LocalPlace,
        [axes, shift]: [f64; 2],
        least: f64,
    ) -> RoundingSizes {
        let mut out = RoundingSizes::default();
        let arm: f64 = element.offset.iter().map(|x| x.abs()).sum();
        let load = magnitudes(element, &element.frame, axis, least);
        // What turned axes add to a load, to first order.
        let turned = AxisLoad {
            axial: axes,
            twist: axes * arm,
            xy: [axes, axes * arm],
            xz: [axes, axes * arm],
        };
        let exact = |component: f64| size_of(component, 1.0, least);
        let end = place.end;
        let terms = cubic_sizes(element, axis, &load, end, exact);
        let mut errors = [[0.0; 4]; 12];
        if axes > 0.0 {
            let parts = [
                cubic_sizes(element, axis, &turned, end, exact),
                cubic_sizes(element, axis, &load, end, |_| axes),
            ];
            errors =
                std::array::from_fn(|k| std::array::from_fn(|p| parts[0][k][p] + parts[1][k][p]));
        }
        let r = place.r;
        // The place may be as far as `shift` beyond r.
        let beyond = r + shift;
        let value = |[a, b, c, d]: [f64; 4]| a + r * (b + r * (c + r * d));
        for (k, (own, error)) in terms.into_iter().zip(errors).enumerate() {
            out.row[k] = value(own) + value(error);
            out.moved_row[k] = shift * (own[1] + beyond * (2.0 * own[2] + beyond * 3.0 * own[3]));
        }
        let Some(clamped) = clamped else { return out };
        let at = |r: f64| LocalPlace { end, r }.on_member(element.length, false);
        let [here, moved] = [at(r), at(beyond)];
        out.green = clamped.magnitude(&load, here);
        // Green's function of a place with itself is a product of powers of both distances, at most the third: it
        // changes by at most six times its size times the relative change of the nearer distance.
        if shift > 0.0 {
            let share = (6.0 * shift / r.max(shift)).min(6.0);
            out.moved_green = share * clamped.magnitude(&load, moved);
        }
        if axes > 0.0 {
            out.turned_green = clamped.magnitude(&turned, here);
        }
        out
    }
}

/// Size of a value of the scale `scale`: its absolute value, or `least` of the scale where it counts as zero.
fn size_of(value: f64, scale: f64, least: f64) -> f64 {
    let counts_as_zero = value != 0.0 && without_rounding(value, scale) == 0.0;
    value.abs() + if counts_as_zero { least * scale } else { 0.0 }
}

/// Sizes of the components of a unit force along `axis`: sums of the absolute values of their terms.
fn magnitudes(element: &RailElement, frame: &[[f64; 3]; 3], axis: usize, least: f64) -> AxisLoad {
    let moment = cross(element.offset, unit(axis));
    let largest = element.offset.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let force = |k: usize| size_of(frame[k][axis], 1.0, least);
    let about = |k: usize| {
        let terms: f64 = (0..3).map(|j| (frame[k][j] * moment[j]).abs()).sum();
        let sum: f64 = (0..3).map(|j| frame[k][j] * moment[j]).sum();
        terms + size_of(sum, largest, least) - sum.abs()
    };
    AxisLoad {
        axial: force(0),
        twist: about(0),
        xy: [force(1), about(2)],
        xz: [force(2), about(1)],
    }
}

/// Cubics with positive coefficients that bound the terms of those of [`cubics`], for the sizes `load` of the force and
/// `turn` of the components of the axes.
fn cubic_sizes(
    element: &RailElement,
    axis: usize,
    load: &AxisLoad,
    end: usize,
    turn: impl Fn(f64) -> f64,
) -> [[f64; 4]; 12] {
    if element.is_rigid_arm() {
        let plain = AxisLoad::default();
        let mut out =
            cubics(element, axis, &plain, end, Planes::Both).map(|terms| terms.map(f64::abs));
        let offset: f64 = element.offset.iter().map(|x| x.abs()).sum();
        let extent = element.x[1] - element.x[0];
        for own in &mut out[3..6] {
            // Seen from the far end the arm is a difference; turned axes mix the components of the offset.
            own[0] += turn(0.0) * offset
                + if end == 1 {
                    2.0 * offset.min(extent)
                } else {
                    0.0
                };
        }
        return out;
    }
    let mut local = local_cubics(element, load, end, 1.0);
    if element.flexibility.tension != 0.0 {
        local
            .iter_mut()
            .flatten()
            .for_each(|size| *size *= BENT_ROUNDINGS);
    }
    let mut out = [[0.0; 4]; 12];
    for (k, components) in element.frame.iter().enumerate() {
        for (a, &component) in components.iter().enumerate() {
            let factor = turn(component);
            if factor == 0.0 {
                continue;
            }
            for block in [0, 3, 6, 9] {
                for p in 0..4 {
                    out[block + a][p] += factor * local[block + k][p];
                }
            }
        }
    }
    out
}
