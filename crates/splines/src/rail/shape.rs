//! Shape functions of a rail element: displacement of the rail by the node states at the element's ends.
//!
//! Without load between its ends a uniform Timoshenko member deforms in cubics of the place, so the shape
//! functions are exact. With c = 1/EI, g = 1/kGA, h the length of the member, s = 0..1 along it, alpha = c
//! h^2/(c h^2 + 12 g) and beta = 1 - alpha (a rigid plane has alpha = 1), the deflection of a plane is
//!
//! v = v1 (1 - beta s - alpha (3 s^2 - 2 s^3)) + h theta1 (alpha (s - 2 s^2 + s^3) + beta (s - s^2)/2)
//!   + v2 (beta s + alpha (3 s^2 - 2 s^3))     + h theta2 (alpha (s^3 - s^2) - beta (s - s^2)/2),
//!
//! and the rotation is theta = v' - g V. Axial displacement and twist are linear. Under an axial force `beam_column` has
//! the coefficients, and bent functions take the place of the powers.
//!
//! # Source
//! Przemieniecki, Theory of Matrix Structural Analysis (1968), chapter 5.

use super::beam_column::{BeamColumn, power_derivatives, powers};
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
    /// What an axial force changes; `None` without one.
    bent: Option<Box<BentShapes>>,
}

/// Shape functions under an axial force: `groups` then holds the coefficients of the functions of the x-y plane, and of all
/// that is linear.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BentShapes {
    /// (lambda l)^2 of the x-y plane, then of the x-z plane.
    pub squares: [f64; 2],
    /// Coefficients of the functions of the x-z plane, as in `groups`.
    pub across: Vec<[[[f64; 4]; 4]; 2]>,
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
        let squares = squares(element);
        let planes = if squares.is_some() {
            Planes::FirstWithLinear
        } else {
            Planes::Both
        };
        let own = [0, 1].map(|end| cubics(element, axis, load, end, planes));
        let across =
            squares.map(|_| [0, 1].map(|end| cubics(element, axis, load, end, Planes::Second)));
        let all = || own.iter().chain(across.iter().flatten());
        let used: Vec<usize> = (0..12)
            .filter(|&k| all().any(|of| of[k] != [0.0; 4]))
            .collect();
        let index = |k: usize| 6 * element.ends[k / 6] + k % 6;
        let four_at_a_time = |cubics: [[[f64; 4]; 12]; 2], four: &[usize]| {
            cubics.map(|of| {
                std::array::from_fn(|p| {
                    std::array::from_fn(|k| four.get(k).map_or(0.0, |&k| of[k][p]))
                })
            })
        };
        let groups = used.chunks(4).map(|four| CubicGroup {
            index: std::array::from_fn(|k| index(*four.get(k).unwrap_or(&four[0]))),
            cubic: four_at_a_time(own, four),
        });
        let bent = squares.zip(across).map(|(squares, across)| {
            let across = used
                .chunks(4)
                .map(|four| four_at_a_time(across, four))
                .collect();
            Box::new(BentShapes { squares, across })
        });
        ShapeCubics {
            len: used.len(),
            groups: groups.collect(),
            bent,
        }
    }

    /// What an axial force changes; `None` without one.
    #[inline]
    pub fn bent(&self) -> Option<&BentShapes> {
        self.bent.as_deref()
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
    pub fn second_derivatives(
        &self,
        LocalPlace { end, r }: LocalPlace,
        scale: f64,
    ) -> [[f64; 4]; 3] {
        let mut out = [[0.0; 4]; 3];
        if let Some(bent) = self.bent() {
            let second = bent.squares.map(|square| power_derivatives(square, r)[1]);
            for (k, out) in out.iter_mut().enumerate().take(self.groups.len()) {
                *out = bent
                    .sum(&self.groups, k, end, &second)
                    .map(|value| scale * scale * value);
            }
            return out;
        }
        for (second, group) in out.iter_mut().zip(&self.groups) {
            let [_, _, c, d] = &group.cubic[end];
            *second = std::array::from_fn(|k| scale * scale * (2.0 * c[k] + 6.0 * r * d[k]));
        }
        out
    }
}

impl BentShapes {
    /// Four functions at a place: the sums of their coefficients times the functions of both planes, or the derivatives of
    /// these.
    #[inline]
    pub fn sum(&self, groups: &[CubicGroup], k: usize, end: usize, of: &[[f64; 4]; 2]) -> [f64; 4] {
        let (own, across) = (&groups[k].cubic[end], &self.across[k][end]);
        std::array::from_fn(|k| {
            (0..4)
                .map(|p| own[p][k] * of[0][p] + across[p][k] * of[1][p])
                .sum()
        })
    }
}

/// The bending planes whose shape functions are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Planes {
    /// Both, axial displacement and twist.
    Both,
    /// The x-y plane, axial displacement and twist.
    FirstWithLinear,
    /// The x-z plane.
    Second,
}

/// (lambda l)^2 of both bending planes of an element with an axial force; `None` of others.
pub(crate) fn squares<T: RealNumber>(element: &RailElement<T>) -> Option<[T; 2]> {
    let f = &element.flexibility;
    let square = |bending: f64, shear: f64| {
        if bending.is_finite() && shear.is_finite() {
            BeamColumn::new(bending, shear, f.tension, element.length).square()
        } else {
            T::from(0.0)
        }
    };
    (f.tension != 0.0 && !element.is_rigid_arm()).then(|| {
        [
            square(f.bending_z, f.shear_y),
            square(f.bending_y, f.shear_z),
        ]
    })
}

/// Values of all twelve shape functions of an element at the distance r from `end`.
pub(crate) fn shape_values<T: RealNumber>(
    element: &RailElement<T>,
    axis: usize,
    load: &AxisLoad<T>,
    LocalPlace { end, r }: LocalPlace<T>,
) -> [T; 12] {
    let Some([first, second]) = squares(element) else {
        return cubics(element, axis, load, end, Planes::Both)
            .map(|[a, b, c, d]| a + r * (b + r * (c + r * d)));
    };
    let parts =
        [(first, Planes::FirstWithLinear), (second, Planes::Second)].map(|(square, planes)| {
            let of = powers(square, r);
            cubics(element, axis, load, end, planes)
                .map(|c| c[0] * of[0] + c[1] * of[1] + c[2] * of[2] + c[3] * of[3])
        });
    std::array::from_fn(|k| parts[0][k] + parts[1][k])
}

/// Cubics of all twelve degrees of freedom, in the rail frame, by the distance from `end`; under an axial force the
/// coefficients of the functions of the given plane.
pub(crate) fn cubics<T: RealNumber>(
    element: &RailElement<T>,
    axis: usize,
    load: &AxisLoad<T>,
    end: usize,
    planes: Planes,
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
    let mut local = local_cubics(element, load, end, T::from(-1.0));
    for (k, own) in local.iter_mut().enumerate() {
        let is_second = matches!(k % 6, 2 | 4);
        if planes != Planes::Both && is_second != (planes == Planes::Second) {
            *own = [T::from(0.0); 4];
        }
    }
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
        let near = [
            [scale, minus * scale, zero, zero],
            [zero, scale, zero, zero],
        ];
        [near[end], near[1 - end]]
    };
    // Seen from the last end the member runs backwards: rotations and moments change sign.
    let tension = element.flexibility.tension;
    let plane = |c: f64, g: f64, load: [T; 2]| {
        if tension == 0.0 {
            return plane_cubics(c, g, element.length, load, minus);
        }
        let column = BeamColumn::new(c, g, tension, element.length);
        if minus < zero {
            column.shapes(load)
        } else {
            column.shape_sizes(load)
        }
    };
    let bending = |c: f64, g: f64, [force, moment]: [T; 2]| {
        if end == 0 {
            return plane(c, g, [force, moment]);
        }
        let [v0, t0, v1, t1] = plane(c, g, [force, minus * moment]);
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
fn plane_cubics<T: RealNumber>(
    c: f64,
    g: f64,
    h: T,
    [force, moment]: [T; 2],
    minus: T,
) -> [[T; 4]; 4] {
    let [zero, half, one, two, three, four, six, twelve] =
        [0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 12.0].map(T::from);
    let (bent, sheared) = (T::from(c) * h * h, twelve * T::from(g));
    let total = bent + sheared;
    let (alpha, beta) = if total > zero {
        (bent / total, sheared / total)
    } else {
        (one, zero)
    };
    let v = [
        [one, minus * beta, minus * three * alpha, two * alpha],
        [
            zero,
            h * (alpha + half * beta),
            minus * h * (two * alpha + half * beta),
            h * alpha,
        ],
        [zero, beta, three * alpha, minus * two * alpha],
        [
            zero,
            minus * half * h * beta,
            minus * h * (alpha + minus * half * beta),
            h * alpha,
        ],
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
