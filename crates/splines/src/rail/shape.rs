//! Shape functions of a rail element: displacement of the rail by the node states at the element's ends.
//!
//! Without load between its ends a uniform Timoshenko member deforms in cubics of the place, so the shape
//! functions are exact. With c = 1/EI, g = 1/kGA, h the length of the member, s = 0..1 along it, alpha = c
//! h^2/(c h^2 + 12 g) and beta = 1 - alpha (a rigid plane has alpha = 1), the deflection of a plane is
//!
//! v = v1 (1 - beta s - alpha (3 s^2 - 2 s^3)) + h theta1 (alpha (s - 2 s^2 + s^3) + beta (s - s^2)/2)
//!   + v2 (beta s + alpha (3 s^2 - 2 s^3))     + h theta2 (alpha (s^3 - s^2) - beta (s - s^2)/2),
//!
//! and the rotation is theta = v' - g V. Axial displacement and twist are linear.
//!
//! # Source
//! Przemieniecki, Theory of Matrix Structural Analysis (1968), chapter 5.

use super::element::{LocalPlace, RailElement};
use super::load::{AxisLoad, without_rounding};
use crate::vector::{RealNumber, cross, unit};

/// The shape functions of one element along one rail direction that do not vanish, as cubics.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ShapeCubics {
    /// How many there are, at most 12.
    len: usize,
    /// The cubics four at a time, the last group filled with zeros.
    groups: Vec<CubicGroup>,
}

/// Four shape functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CubicGroup {
    /// Degree of freedom of each: `6 * state + k`. Fillers repeat a valid one.
    pub index: [usize; 4],
    /// `[end][p][k]`: coefficient of r^p of function k, r being the distance from that end as a fraction of
    /// the element.
    pub cubic: [[[f64; 4]; 4]; 2],
}

impl ShapeCubics {
    /// Those of `element` along rail direction `axis`, 0, 1 or 2.
    pub fn new(element: &RailElement, axis: usize) -> ShapeCubics {
        let load = &AxisLoad::new(element, &element.frame, axis);
        let cubics = [0, 1].map(|end| cubics(element, axis, load, end));
        let used: Vec<usize> = (0..12).filter(|&k| cubics.iter().any(|of| of[k] != [0.0; 4])).collect();
        let index = |k: usize| 6 * element.ends[k / 6] + k % 6;
        let groups = used.chunks(4).map(|four| CubicGroup {
            index: std::array::from_fn(|k| index(*four.get(k).unwrap_or(&four[0]))),
            cubic: cubics.map(|of| {
                std::array::from_fn(|p| std::array::from_fn(|k| four.get(k).map_or(0.0, |&k| of[k][p])))
            }),
        });
        ShapeCubics { len: used.len(), groups: groups.collect() }
    }

    /// Number of functions.
    pub fn len(&self) -> usize {
        self.len
    }

    /// The functions, four at a time.
    pub fn groups(&self) -> &[CubicGroup] {
        &self.groups
    }

    /// Second derivatives of all functions by x at a place, zeros in unused entries. `scale` = 1/(extent in
    /// x).
    pub fn second_derivatives(&self, LocalPlace { end, r }: LocalPlace, scale: f64) -> [[f64; 4]; 3] {
        let mut out = [[0.0; 4]; 3];
        for (second, group) in out.iter_mut().zip(&self.groups) {
            let [_, _, c, d] = &group.cubic[end];
            *second = std::array::from_fn(|k| scale * scale * (2.0 * c[k] + 6.0 * r * d[k]));
        }
        out
    }
}

/// Cubics of all twelve degrees of freedom, in the rail frame, by the distance from `end`.
pub(crate) fn cubics<T: RealNumber>(
    element: &RailElement<T>,
    axis: usize,
    load: &AxisLoad<T>,
    end: usize,
) -> [[T; 4]; 12] {
    let mut cubics = [[T::from(0.0); 4]; 12];
    if element.is_rigid_arm() {
        let zero = T::from(0.0);
        let along = cross([element.x[1] - element.x[0], zero, zero], unit(axis));
        let moment = cross(element.offset, unit(axis));
        cubics[axis][0] = T::from(1.0);
        for k in 0..3 {
            let rows = [[moment[k], along[k]], [moment[k] + along[k], -along[k]]];
            cubics[3 + k][..2].copy_from_slice(&rows[end]);
        }
        return cubics;
    }
    let local = local_cubics(element, load, end, T::from(-1.0));
    for (k, axes) in element.frame.iter().enumerate() {
        for (a, &component) in axes.iter().enumerate() {
            let factor = without_rounding(component, T::from(1.0));
            for block in [0, 3, 6, 9] {
                for p in 0..4 {
                    cubics[block + a][p] = cubics[block + a][p] + factor * local[block + k][p];
                }
            }
        }
    }
    cubics
}

/// The same in local axes: u, v, w, theta x, y, z of the first end, then of the last.
///
/// `minus` is -1. With +1 all terms are positive for a positive load: the result then bounds the rounding of the
/// cubics.
pub(crate) fn local_cubics<T: RealNumber>(
    element: &RailElement<T>,
    load: &AxisLoad<T>,
    end: usize,
    minus: T,
) -> [[T; 4]; 12] {
    let zero = T::from(0.0);
    let mut out = [[zero; 4]; 12];
    let without_stiffness = element.without_stiffness();
    let linear = |scale: T| {
        let near = [[scale, minus * scale, zero, zero], [zero, scale, zero, zero]];
        [near[end], near[1 - end]]
    };
    // Seen from the last end the member runs backwards: rotations and moments change sign.
    let bending = |c: f64, g: f64, [force, moment]: [T; 2]| {
        if end == 0 {
            return plane_cubics(c, g, element.length, [force, moment], minus);
        }
        let [v0, t0, v1, t1] = plane_cubics(c, g, element.length, [force, minus * moment], minus);
        [v1, t1.map(|x| minus * x), v0, t0.map(|x| minus * x)]
    };
    if !without_stiffness[0] {
        [out[0], out[6]] = linear(load.axial);
    }
    if !without_stiffness[1] {
        [out[3], out[9]] = linear(load.twist);
    }
    let f = &element.flexibility;
    if !without_stiffness[2] {
        [out[1], out[5], out[7], out[11]] = bending(f.bending_z, f.shear_y, load.xy);
    }
    if !without_stiffness[3] {
        // In the x-z plane (w, -theta_y) take the place of (v, theta_z).
        let [w0, t0, w1, t1] = bending(f.bending_y, f.shear_z, load.xz);
        [out[2], out[4], out[8], out[10]] = [w0, t0.map(|x| minus * x), w1, t1.map(|x| minus * x)];
    }
    out
}

/// force v + moment theta of one bending plane, as cubics of (v, theta) at the first end, then at the last;
/// `minus` is -1, or 1 for the absolute values of all terms.
fn plane_cubics<T: RealNumber>(c: f64, g: f64, h: T, [force, moment]: [T; 2], minus: T) -> [[T; 4]; 4] {
    let [zero, half, one, two, three, four, six, twelve] =
        [0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 12.0].map(T::from);
    let (bent, sheared) = (T::from(c) * h * h, twelve * T::from(g));
    let total = bent + sheared;
    let (alpha, beta) = if total > zero { (bent / total, sheared / total) } else { (one, zero) };
    let v = [
        [one, minus * beta, minus * three * alpha, two * alpha],
        [zero, h * (alpha + half * beta), minus * h * (two * alpha + half * beta), h * alpha],
        [zero, beta, three * alpha, minus * two * alpha],
        [zero, minus * half * h * beta, minus * h * (alpha + minus * half * beta), h * alpha],
    ];
    let theta = [
        [zero, minus * six * alpha / h, six * alpha / h, zero],
        [one, minus * (four * alpha + beta), three * alpha, zero],
        [zero, six * alpha / h, minus * six * alpha / h, zero],
        [zero, beta + minus * two * alpha, three * alpha, zero],
    ];
    let mix = |k: usize| std::array::from_fn(|p| force * v[k][p] + moment * theta[k][p]);
    [mix(0), mix(1), mix(2), mix(3)]
}
