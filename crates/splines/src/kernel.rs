//! What one clamped cell adds between its ends: its own Green's function.

use crate::Cell;

/// A bilinear form and its derivatives with respect to both places.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Green {
    pub value: f64,
    pub first: f64,
    pub second: f64,
}

impl Green {
    fn add(&mut self, other: Green) {
        self.value += other.value;
        self.first += other.first;
        self.second += other.second;
    }

    /// The two places exchanged.
    fn swapped(self) -> Green {
        Green { value: self.value, first: self.second, second: self.first }
    }

    fn mean(self, other: Green) -> Green {
        Green {
            value: 0.5 * (self.value + other.value),
            first: 0.5 * (self.first + other.first),
            second: 0.5 * (self.second + other.second),
        }
    }
}

/// Second derivatives of a bilinear form with respect to both places.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bend {
    pub first: f64,
    pub mixed: f64,
    pub second: f64,
}

impl Bend {
    fn add(&mut self, other: Bend) {
        self.first += other.first;
        self.mixed += other.mixed;
        self.second += other.second;
    }

    /// The two places exchanged.
    fn swapped(self) -> Bend {
        Bend { first: self.second, mixed: self.mixed, second: self.first }
    }

    fn mean(self, other: Bend) -> Bend {
        Bend {
            first: 0.5 * (self.first + other.first),
            mixed: 0.5 * (self.mixed + other.mixed),
            second: 0.5 * (self.second + other.second),
        }
    }
}

/// One bending plane: c = 1/EI, g = 1/kGA, l = length, inverse = 1/(c l^3 + 12 g l), zero where rigid.
#[derive(Clone, Copy, Debug, Default)]
struct Plane {
    c: f64,
    g: f64,
    l: f64,
    per_l: f64,
    inverse: f64,
}

impl Plane {
    fn new(c: f64, g: f64, l: f64) -> Self {
        let d = (c * l * l + 12.0 * g) * l;
        if d > 0.0 && d.is_finite() {
            Plane { c, g, l, per_l: 1.0 / l, inverse: 1.0 / d }
        } else {
            Plane::default()
        }
    }

    /// f v(a) + m theta(a) under a force F and a moment M at b, where a <= b; derivatives in a and b.
    ///
    /// Between the clamp and b the shear V and the end moment m0 are constant:
    /// theta' = c (m0 - V x), v' = theta + g V; both vanish at the far clamp.
    fn green(&self, a: f64, [f, m]: [f64; 2], b: f64, [force, moment]: [f64; 2]) -> Green {
        let Plane { c, g, l, per_l, inverse } = *self;
        let q = l - b;
        let v = (force * q * (c * q * (3.0 * l - 2.0 * q) + 12.0 * g) - 6.0 * c * moment * q * b) * inverse;
        let m0 = 0.5 * v * l + q * (moment - 0.5 * force * q) * per_l;
        let dv = (force * (6.0 * c * q * b + 12.0 * g) + 6.0 * c * moment * (q - b)) * inverse;
        let dm0 = 0.5 * dv * l + (moment - force * q) * per_l;
        let deflection = |v: f64, m0: f64| a * (g * v + c * a * (0.5 * m0 - v * a * (1.0 / 6.0)));
        let rotation = |v: f64, m0: f64| c * a * (m0 - 0.5 * v * a);
        let slope = rotation(v, m0) + g * v;
        Green {
            value: f * deflection(v, m0) + m * rotation(v, m0),
            first: f * slope + m * c * (m0 - v * a),
            second: -(f * deflection(dv, dm0) + m * rotation(dv, dm0)),
        }
    }

    /// Second derivatives of [`Plane::green`].
    fn bend(&self, a: f64, [f, m]: [f64; 2], b: f64, [force, moment]: [f64; 2]) -> Bend {
        let Plane { c, g, l, per_l, inverse } = *self;
        let q = l - b;
        // The clamp's shear and moment, and their first and second derivatives by q.
        let v = (force * q * (c * q * (3.0 * l - 2.0 * q) + 12.0 * g) - 6.0 * c * moment * q * b) * inverse;
        let m0 = 0.5 * v * l + q * (moment - 0.5 * force * q) * per_l;
        let dv = (force * (6.0 * c * q * b + 12.0 * g) + 6.0 * c * moment * (q - b)) * inverse;
        let dm0 = 0.5 * dv * l + (moment - force * q) * per_l;
        let ddv = (6.0 * c * force * (b - q) + 12.0 * c * moment) * inverse;
        let ddm0 = 0.5 * ddv * l - force * per_l;
        let deflection = |v: f64, m0: f64| a * (g * v + c * a * (0.5 * m0 - v * a * (1.0 / 6.0)));
        let rotation = |v: f64, m0: f64| c * a * (m0 - 0.5 * v * a);
        let curvature = |v: f64, m0: f64| c * (m0 - v * a);
        Bend {
            first: f * curvature(v, m0) - m * c * v,
            mixed: -(f * (rotation(dv, dm0) + g * dv) + m * curvature(dv, dm0)),
            second: f * deflection(ddv, ddm0) + m * rotation(ddv, ddm0),
        }
    }

    fn bend_pair(&self, s: f64, p: [f64; 2], t: f64, q: [f64; 2]) -> Bend {
        if self.inverse == 0.0 {
            Bend::default()
        } else if s < t {
            self.bend(s, p, t, q)
        } else if s > t {
            self.bend(t, q, s, p).swapped()
        } else {
            self.bend(s, p, t, q).mean(self.bend(t, q, s, p).swapped())
        }
    }

    /// v(a) under a unit force at b, where a <= b: [`Plane::green`] without moments.
    #[inline]
    fn force(&self, a: f64, b: f64) -> Green {
        let Plane { c, g, l, per_l, inverse } = *self;
        let q = l - b;
        let v = q * (c * q * (3.0 * l - 2.0 * q) + 12.0 * g) * inverse;
        let m0 = 0.5 * (v * l - q * q * per_l);
        let dv = (6.0 * c * q * b + 12.0 * g) * inverse;
        let dm0 = 0.5 * dv * l - q * per_l;
        Green {
            value: a * (g * v + c * a * (0.5 * m0 - v * a * (1.0 / 6.0))),
            first: g * v + c * a * (m0 - 0.5 * v * a),
            second: -a * (g * dv + c * a * (0.5 * dm0 - dv * a * (1.0 / 6.0))),
        }
    }

    /// What `green` of a place with itself is added up from.
    fn magnitude(&self, s: f64, [f, m]: [f64; 2]) -> f64 {
        let Plane { c, g, l, per_l, inverse } = *self;
        let (q, f, m) = (l - s, f.abs(), m.abs());
        let v = (f * q * (c * q * 3.0 * l + 12.0 * g) + 6.0 * c * m * q * s) * inverse;
        let m0 = 0.5 * v * l + q * (m + 0.5 * f * q) * per_l;
        f * s * (g * v + c * s * (0.5 * m0 + v * s * (1.0 / 6.0))) + m * c * s * (m0 + 0.5 * v * s)
    }

    fn pair(&self, s: f64, p: [f64; 2], t: f64, q: [f64; 2]) -> Green {
        if self.inverse == 0.0 {
            return Green::default();
        }
        if p[1] == 0.0 && q[1] == 0.0 {
            let one = if s <= t { self.force(s, t) } else { self.force(t, s).swapped() };
            let one = if s == t { one.mean(one.swapped()) } else { one };
            let factor = p[0] * q[0];
            return Green {
                value: factor * one.value,
                first: factor * one.first,
                second: factor * one.second,
            };
        }
        if s < t {
            self.green(s, p, t, q)
        } else if s > t {
            self.green(t, q, s, p).swapped()
        } else {
            let one = self.green(s, p, t, q);
            one.mean(if p == q { one.swapped() } else { self.green(t, q, s, p).swapped() })
        }
    }
}

/// A clamped bar, axial or torsional: flexibility times a (l - b)/l.
fn bar(flexibility: f64, l: f64, s: f64, t: f64) -> Green {
    let green = |a: f64, b: f64| Green {
        value: flexibility * a * (l - b) / l,
        first: flexibility * (l - b) / l,
        second: -flexibility * a / l,
    };
    if s < t {
        green(s, t)
    } else if s > t {
        green(t, s).swapped()
    } else {
        green(s, t).mean(green(t, s).swapped())
    }
}

/// How a unit force at the rail loads the cell's axis, in local axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Arm {
    /// Local x force, and moment about local x.
    pub axial: f64,
    pub twist: f64,
    /// Force and moment in the plane of (v, theta z), and of (w, -theta y).
    pub xy: [f64; 2],
    pub xz: [f64; 2],
}

impl Arm {
    /// A unit force along rail direction `axis`: its local components, and those of `offset` x force.
    ///
    /// In the axes of the cell.
    pub fn new(cell: &Cell, axis: usize) -> Arm {
        Arm::along(cell, &cell.frame, axis)
    }

    /// The same in other local axes, rows of `frame`.
    fn along(cell: &Cell, frame: &[[f64; 3]; 3], axis: usize) -> Arm {
        let moment = cross(cell.offset, unit(axis));
        let reach = cell.offset.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let row = |k: usize| clean(frame[k][axis], 1.0);
        let turn = |k: usize| clean((0..3).map(|a| frame[k][a] * moment[a]).sum(), reach);
        Arm { axial: row(0), twist: turn(0), xy: [row(1), turn(2)], xz: [row(2), -turn(1)] }
    }

    /// Whether the force asks for stiffness along, about, across (x-y) and across (x-z) the axis.
    pub fn uses(&self) -> [bool; 4] {
        [self.axial != 0.0, self.twist != 0.0, self.xy != [0.0; 2], self.xz != [0.0; 2]]
    }
}

/// Zero where rounding of a rotation is all there is.
pub(crate) fn clean(value: f64, scale: f64) -> f64 {
    if value.abs() <= 4.0 * f64::EPSILON * scale { 0.0 } else { value }
}

pub(crate) fn unit(axis: usize) -> [f64; 3] {
    let mut e = [0.0; 3];
    e[axis] = 1.0;
    e
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Green's function of a cell clamped at both ends, between forces at the rail; along its member.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kernel {
    length: f64,
    axial: f64,
    torsion: f64,
    xy: Plane,
    xz: Plane,
    arms: [Arm; 3],
    /// Along, about, across (x-y), across (x-z): nothing resists.
    free: [bool; 4],
}

impl Kernel {
    pub fn new(cell: &Cell) -> Kernel {
        let flexibility = &cell.flexibility;
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        Kernel {
            length: cell.length,
            axial: finite(flexibility.axial),
            torsion: finite(flexibility.torsion),
            xy: Plane::new(flexibility.bending_z, flexibility.shear_y, cell.length),
            xz: Plane::new(flexibility.bending_y, flexibility.shear_z, cell.length),
            arms: [0, 1, 2].map(|axis| Arm::along(cell, &cell.axes(), axis)),
            free: free(cell),
        }
    }

    /// Displacement along axis `a` at s under a unit force along axis `b` at t, s and t in 0..=length
    /// along the member.
    pub fn pair(&self, a: usize, s: f64, b: usize, t: f64) -> Green {
        self.between(&self.arms[a], s, &self.arms[b], t)
    }

    /// The same under a force on another cell of the same member.
    pub fn across(&self, a: usize, s: f64, other: &Kernel, b: usize, t: f64) -> Green {
        self.between(&self.arms[a], s, &other.arms[b], t)
    }

    #[inline(always)]
    fn between(&self, p: &Arm, s: f64, q: &Arm, t: f64) -> Green {
        let mut sum = Green::default();
        if p.xy != [0.0; 2] && q.xy != [0.0; 2] {
            sum.add(self.xy.pair(s, p.xy, t, q.xy));
        }
        if p.xz != [0.0; 2] && q.xz != [0.0; 2] {
            sum.add(self.xz.pair(s, p.xz, t, q.xz));
        }
        let axial = self.axial * (p.axial * q.axial);
        if axial != 0.0 {
            sum.add(bar(axial, self.length, s, t));
        }
        let twist = self.torsion * (p.twist * q.twist);
        if twist != 0.0 {
            sum.add(bar(twist, self.length, s, t));
        }
        sum
    }

    /// Second derivatives of [`Kernel::across`] by both places along the member.
    pub fn bend(&self, a: usize, s: f64, other: &Kernel, b: usize, t: f64) -> Bend {
        let (p, q) = (&self.arms[a], &other.arms[b]);
        let mut sum = self.xy.bend_pair(s, p.xy, t, q.xy);
        sum.add(self.xz.bend_pair(s, p.xz, t, q.xz));
        // Bars are straight on both sides of the load.
        let bars = self.axial * (p.axial * q.axial) + self.torsion * (p.twist * q.twist);
        sum.mixed -= bars / self.length;
        sum
    }

    /// What the displacement along axis `a` at s under a unit force there is added up from, s in 0..=length.
    pub fn magnitude(&self, a: usize, s: f64) -> f64 {
        let p = &self.arms[a];
        let bar = s * (self.length - s) / self.length;
        self.xy.magnitude(s, p.xy)
            + self.xz.magnitude(s, p.xz)
            + (self.axial * p.axial * p.axial + self.torsion * p.twist * p.twist) * bar
    }

    /// Whether both forces act where nothing resists.
    pub fn is_free(&self, a: usize, b: usize) -> bool {
        let (p, q) = (self.arms[a].uses(), self.arms[b].uses());
        (0..4).any(|k| self.free[k] && p[k] && q[k])
    }
}

/// A clamped cell's kernel along one axis as far(s) . near(t), s >= t: far (2) and near (2) as cubics in the
/// distance from the first end of the member, and from its last, in lengths of the member.
///
/// `None` where the axis asks for more than one plane or the axial bar, or for a moment.
///
/// The nearer force meets the shear V and the moment m0 that the farther one causes at the clamp:
/// b = V (g t - c t^3/6) + m0 c t^2/2.
pub(crate) fn sides(cell: &Cell, axis: usize) -> Option<[[[f64; 4]; 4]; 2]> {
    if cell.ends[0] == cell.ends[1] {
        return Some([[[0.0; 4]; 4]; 2]);
    }
    let f = &cell.flexibility;
    let arm = Arm::along(cell, &cell.axes(), axis);
    let (force, plane) = match arm.uses() {
        [true, false, false, false] if f.axial.is_finite() => {
            let give = f.axial * arm.axial * arm.axial * cell.length;
            let (rise, fall) = ([0.0, 1.0, 0.0, 0.0], [1.0, -1.0, 0.0, 0.0]);
            let zero = [0.0; 4];
            let ends = [[fall, rise], [rise, fall]];
            return Some(ends.map(|[far, near]| [far.map(|x| give * x), zero, near, zero]));
        }
        [false, false, true, false] if arm.xy[1] == 0.0 => {
            (arm.xy[0], Plane::new(f.bending_z, f.shear_y, cell.length))
        }
        [false, false, false, true] if arm.xz[1] == 0.0 => {
            (arm.xz[0], Plane::new(f.bending_y, f.shear_z, cell.length))
        }
        _ => return None,
    };
    let Plane { c, g, l, inverse, .. } = plane;
    if inverse == 0.0 {
        return Some([[[0.0; 4]; 4]; 2]);
    }
    let first = [
        [1.0, -12.0 * g * inverse, -3.0 * c * l * inverse, 2.0 * c * inverse],
        [0.0, 1.0 - 6.0 * g * l * inverse, -1.5 * c * l * l * inverse - 0.5 / l, c * l * inverse],
        [0.0, g, 0.0, -c / 6.0],
        [0.0, 0.0, 0.5 * c, 0.0],
    ];
    let last = [
        [0.0, 12.0 * g * inverse, 3.0 * c * l * inverse, -2.0 * c * inverse],
        [0.0, 6.0 * g * l * inverse, 1.5 * c * l * l * inverse - 0.5 / l, -c * l * inverse],
        [g * l - c * l * l * l / 6.0, 0.5 * c * l * l - g, -0.5 * c * l, c / 6.0],
        [0.5 * c * l * l, -c * l, 0.5 * c, 0.0],
    ];
    let powers = [1.0, l, l * l, l * l * l];
    Some([first, last].map(|four| four.map(|cubic| std::array::from_fn(|p| force * cubic[p] * powers[p]))))
}

/// Along, about, across (x-y), across (x-z): where the section resists nothing.
pub(crate) fn free(cell: &Cell) -> [bool; 4] {
    let flexibility = &cell.flexibility;
    let infinite = |x: f64| x == f64::INFINITY;
    [
        infinite(flexibility.axial),
        infinite(flexibility.torsion),
        infinite(flexibility.bending_z) || infinite(flexibility.shear_y),
        infinite(flexibility.bending_y) || infinite(flexibility.shear_z),
    ]
}
