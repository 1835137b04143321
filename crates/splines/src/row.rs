//! Displacement of the rail at one place, by the states at the ends of its cell.

use crate::Cell;
use crate::kernel::{Arm, clean, cross, free, unit};
use crate::lean::Lean;

/// One row of N: displacement of the rail at a probe = sum of `values` times state freedoms, plus what
/// the clamped cell itself gives.
///
/// Freedom `6 * state + k`: k = 0..3 displacement, 3..6 rotation, in the rail frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Index of the cell that carries the probe.
    pub cell: usize,
    /// Component of the probe's axis: 0, 1 or 2.
    pub(crate) axis: usize,
    /// Place along the member, from 0 to its length; derivative of it by x.
    pub(crate) s: f64,
    pub(crate) rate: f64,
    len: usize,
    groups: usize,
    index: [usize; 12],
    value: [f64; 12],
    slope: [f64; 12],
}

/// A place in a cell: its distance r from the nearer end, in lengths of the cell, and which end that is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fraction {
    pub end: usize,
    pub r: f64,
}

impl Fraction {
    /// Share of the cell between its first end and the place.
    #[inline]
    pub fn along(self) -> f64 {
        if self.end == 0 { self.r } else { 1.0 - self.r }
    }
}

impl Terms {
    #[inline]
    pub(crate) fn lean(&self) -> Option<&Lean> {
        self.lean.as_ref()
    }

    /// What each value is added up from, in the order of [`Row::values`]: sums of |coefficient| r^p.
    pub(crate) fn magnitudes(&self, Fraction { end, r }: Fraction) -> impl Iterator<Item = f64> + '_ {
        let one = move |group: &Group, k: usize| {
            group.cubic[end].iter().rev().fold(0.0, |sum, terms| terms[k].abs() + r * sum)
        };
        (0..self.len).map(move |k| one(&self.groups[k / 4], k % 4))
    }
}

impl Row {
    pub(crate) const EMPTY: Row = Row {
        cell: 0,
        axis: 0,
        s: 0.0,
        rate: 0.0,
        len: 0,
        groups: 0,
        index: [0; 12],
        value: [0.0; 12],
        slope: [0.0; 12],
    };

    /// State freedoms of the entries that are not zero for the whole cell: at most 12, each once.
    #[must_use]
    pub fn indices(&self) -> &[usize] {
        &self.index[..self.len]
    }

    /// Shape values, dimensionless at displacements, a length at rotations.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.value[..self.len]
    }

    /// Derivatives of the values with respect to the rail coordinate.
    #[must_use]
    pub fn slopes(&self) -> &[f64] {
        &self.slope[..self.len]
    }

    /// Evaluates the cubics of a cell's axis; `scale` = 1/(extent in x).
    ///
    /// Cubics in the distance from the nearer end keep the digits of what vanishes there.
    #[inline]
    pub(crate) fn evaluate(&mut self, terms: &Terms, Fraction { end, r }: Fraction, scale: f64) {
        let scale = if end == 0 { scale } else { -scale };
        self.len = terms.len;
        self.groups = terms.groups.len().min(3);
        let (indices, _) = self.index.as_chunks_mut::<4>();
        let (values, _) = self.value.as_chunks_mut::<4>();
        let (slopes, _) = self.slope.as_chunks_mut::<4>();
        let out = indices.iter_mut().zip(values.iter_mut().zip(slopes));
        for (group, (index, (value, slope))) in terms.groups.iter().zip(out) {
            let [a, b, c, d] = &group.cubic[end];
            *index = group.index;
            // Whole arrays are stored, so that they can be loaded again without waiting.
            *value = std::array::from_fn(|k| a[k] + r * (b[k] + r * (c[k] + r * d[k])));
            *slope = std::array::from_fn(|k| scale * (b[k] + r * (2.0 * c[k] + r * (3.0 * d[k]))));
        }
    }

    /// Second derivatives of the values by x, in the order of [`Row::values`], the rest zero.
    pub(crate) fn bends(terms: &Terms, Fraction { end, r }: Fraction, scale: f64) -> [[f64; 4]; 3] {
        let mut out = [[0.0; 4]; 3];
        for (bend, group) in out.iter_mut().zip(&terms.groups) {
            let [_, _, c, d] = &group.cubic[end];
            *bend = std::array::from_fn(|k| scale * scale * (2.0 * c[k] + 6.0 * r * d[k]));
        }
        out
    }

    /// The entries four at a time, the last group filled with zeros.
    #[inline]
    pub(crate) fn chunks(&self) -> [&[[f64; 4]]; 2] {
        [&self.value.as_chunks().0[..self.groups], &self.slope.as_chunks().0[..self.groups]]
    }

    /// Places of the entries four at a time; fillers repeat a valid place.
    #[inline]
    pub(crate) fn places(&self) -> &[[usize; 4]] {
        &self.index.as_chunks().0[..self.groups]
    }
}

/// Entries of N of one cell along one axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Terms {
    len: usize,
    groups: Vec<Group>,
    /// Where four entries are enough and one plane or bar gives alone.
    lean: Option<Lean>,
}

/// Four entries: cubics in r, the distance from either end; `cubic[end][p][k]` is the coefficient of r^p of entry k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Group {
    pub index: [usize; 4],
    pub cubic: [[[f64; 4]; 4]; 2],
}

/// Cubics of one axis of one cell, those that vanish left out.
///
/// Bending: Timoshenko shapes with alpha = c h^2/(c h^2 + 12 g), beta = 12 g/(c h^2 + 12 g),
/// c = 1/EI, g = 1/kGA, h = length; a rigid plane has alpha = 1, beta = 0.
pub(crate) fn terms(cell: &Cell, axis: usize) -> Terms {
    let load = &Arm::new(cell, axis);
    let cubics = [0, 1].map(|end| cubics(cell, axis, load, end));
    let used: Vec<usize> = (0..12).filter(|&k| cubics.iter().any(|of| of[k] != [0.0; 4])).collect();
    let index = |k: usize| 6 * cell.ends[k / 6] + k % 6;
    let groups = used.chunks(4).map(|four| Group {
        index: std::array::from_fn(|k| index(*four.get(k).unwrap_or(&four[0]))),
        cubic: cubics.map(|of| {
            std::array::from_fn(|p| std::array::from_fn(|k| four.get(k).map_or(0.0, |&k| of[k][p])))
        }),
    });
    let groups: Vec<Group> = groups.collect();
    let lean = groups.first().filter(|_| groups.len() == 1).and_then(|group| Lean::new(cell, axis, group));
    Terms { len: used.len(), groups, lean }
}

/// Cubics of all twelve freedoms in the distance from `end`.
fn cubics(cell: &Cell, axis: usize, load: &Arm, end: usize) -> [[f64; 4]; 12] {
    let mut cubics = [[0.0; 4]; 12];
    if cell.ends[0] == cell.ends[1] {
        let along = cross([cell.x[1] - cell.x[0], 0.0, 0.0], unit(axis));
        let moment = cross(cell.offset, unit(axis));
        cubics[axis][0] = 1.0;
        for k in 0..3 {
            let rows = [[moment[k], along[k]], [moment[k] + along[k], -along[k]]];
            cubics[3 + k][..2].copy_from_slice(&rows[end]);
        }
        return cubics;
    }
    let local = local(cell, load, end);
    for (k, axes) in cell.frame.iter().enumerate() {
        for (a, &component) in axes.iter().enumerate() {
            let factor = clean(component, 1.0);
            for block in [0, 3, 6, 9] {
                for p in 0..4 {
                    cubics[block + a][p] += factor * local[block + k][p];
                }
            }
        }
    }
    cubics
}

/// The same in local axes: u, v, w, theta x, y, z of the first end, then of the last, by the distance from `end`.
fn local(cell: &Cell, arm: &Arm, end: usize) -> [[f64; 4]; 12] {
    let mut out = [[0.0; 4]; 12];
    let free = free(cell);
    let linear = |scale: f64| {
        let near = [[scale, -scale, 0.0, 0.0], [0.0, scale, 0.0, 0.0]];
        [near[end], near[1 - end]]
    };
    // Seen from the last end the member runs backwards: rotations and moments change sign.
    let bent = |c: f64, g: f64, [force, moment]: [f64; 2]| {
        if end == 0 {
            return plane(c, g, cell.length, [force, moment]);
        }
        let [v0, t0, v1, t1] = plane(c, g, cell.length, [force, -moment]);
        [v1, t1.map(|x| -x), v0, t0.map(|x| -x)]
    };
    if !free[0] {
        [out[0], out[6]] = linear(arm.axial);
    }
    if !free[1] {
        [out[3], out[9]] = linear(arm.twist);
    }
    let f = &cell.flexibility;
    if !free[2] {
        [out[1], out[5], out[7], out[11]] = bent(f.bending_z, f.shear_y, arm.xy);
    }
    if !free[3] {
        let [w0, t0, w1, t1] = bent(f.bending_y, f.shear_z, arm.xz);
        [out[2], out[4], out[8], out[10]] = [w0, t0.map(|x| -x), w1, t1.map(|x| -x)];
    }
    out
}

/// force v + moment theta of one bending plane as cubics of (v, theta) at both ends.
fn plane(c: f64, g: f64, h: f64, [force, moment]: [f64; 2]) -> [[f64; 4]; 4] {
    let total = c * h * h + 12.0 * g;
    let (alpha, beta) = if total > 0.0 { (c * h * h / total, 12.0 * g / total) } else { (1.0, 0.0) };
    let v = [
        [1.0, -beta, -3.0 * alpha, 2.0 * alpha],
        [0.0, h * (alpha + 0.5 * beta), -h * (2.0 * alpha + 0.5 * beta), h * alpha],
        [0.0, beta, 3.0 * alpha, -2.0 * alpha],
        [0.0, -0.5 * h * beta, -h * (alpha - 0.5 * beta), h * alpha],
    ];
    let theta = [
        [0.0, -6.0 * alpha / h, 6.0 * alpha / h, 0.0],
        [1.0, -(4.0 * alpha + beta), 3.0 * alpha, 0.0],
        [0.0, 6.0 * alpha / h, -6.0 * alpha / h, 0.0],
        [0.0, beta - 2.0 * alpha, 3.0 * alpha, 0.0],
    ];
    let mix = |k: usize| std::array::from_fn(|p| force * v[k][p] + moment * theta[k][p]);
    [mix(0), mix(1), mix(2), mix(3)]
}
