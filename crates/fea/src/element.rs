//! The straight uniform member: 12 x 12 stiffness, releases, rigid arms.

use nalgebra::{Matrix3, SMatrix, Vector3};
use splines::Flexibility;

use crate::error::{Error, Fault, Item};
use crate::model::{Freedom, Kind, Member, Model};
use crate::real::Real;

pub(crate) type Matrix6<T = f64> = SMatrix<T, 6, 6>;
pub(crate) type Matrix12<T = f64> = SMatrix<T, 12, 12>;

/// Pivot, relative to its diagonal, below which a released freedom is held by nothing.
const LOOSE: f64 = 1e-10;
/// Stiffness, relative to what it was, below which condensation has removed it: so many roundings.
const GONE: f64 = 450.0;

/// A member with its geometry worked out, in the precision T.
#[derive(Clone, Debug)]
pub(crate) struct Element<T: Real = f64> {
    pub points: [usize; 2],
    /// Ends of the flexible part, global.
    pub ends: [Vector3<T>; 2],
    /// From the points to the ends, global.
    pub offsets: [Vector3<T>; 2],
    /// Rows: local axes.
    pub axes: Matrix3<T>,
    pub length: T,
    pub flexibility: Flexibility,
    /// Local stiffness between the tips of the arms, releases condensed.
    pub stiffness: Matrix12<T>,
    /// Diagonal of the stiffness before releases: the scale of its rounding.
    pub scale: [f64; 12],
    /// What its releases do; `None` without any.
    pub released: Option<Box<Released<T>>>,
}

/// Motion of the flexible ends of a member with releases, local.
#[derive(Clone, Debug)]
pub(crate) struct Released<T: Real = f64> {
    /// Whether anything is released at each end.
    pub ends: [bool; 2],
    /// Displacements of the flexible ends by those of the tips of the arms.
    pub recovery: Matrix12<T>,
    /// Displacements of the flexible ends per load on them while the tips of the arms are held: zero
    /// but between released freedoms.
    pub slack: Matrix12<T>,
}

impl<T: Real> Element<T> {
    pub fn new(m: &Model, index: usize) -> Result<Element<T>, Error> {
        let member: &Member = &m.members[index];
        let invalid = |fault| Error::Invalid { item: Item::Member(index), fault };
        let offsets = member.offsets.map(vector);
        let place = |k: usize| vector::<T>(m.points[member.points[k]]) + offsets[k];
        let ends = [place(0), place(1)];
        let along = ends[1] - ends[0];
        let length = norm(&along);
        let far = ends.iter().flat_map(|end| end.iter()).fold(0.0_f64, |a, x| a.max(x.double().abs()));
        if length.double() <= 1e-12 * far || !length.double().is_finite() {
            return Err(invalid(Fault::NoLength));
        }
        let axes = axes(along / length, vector(member.orientation), member.kind)
            .ok_or(invalid(Fault::Orientation))?;
        let mut flexibility = m.sections[member.section].flexibility(m.theory);
        if member.kind == Kind::Truss {
            let none = f64::INFINITY;
            let axial = flexibility.axial;
            flexibility =
                Flexibility { axial, torsion: none, bending_y: none, bending_z: none, ..Default::default() };
        }
        let mut stiffness: Matrix12<T> = stiffness(&flexibility, length);
        let scale = std::array::from_fn(|k| stiffness[(k, k)].double());
        let ends_released = member.releases.map(|set| set.contains(&true));
        let released = if ends_released.contains(&true) {
            let named =
                |k: usize| Error::Released { member: index, end: k / 6, freedom: Freedom::ALL[k % 6] };
            let (recovery, slack) = condense(&mut stiffness, &member.releases).map_err(named)?;
            Some(Box::new(Released { ends: ends_released, recovery, slack }))
        } else {
            None
        };
        let points = member.points;
        Ok(Element { points, ends, offsets, axes, length, flexibility, stiffness, scale, released })
    }

    /// Rotation of a vector pair into local axes.
    pub fn rotation(&self) -> Matrix6<T> {
        blocks(&self.axes)
    }
}

/// Doubles in the precision T.
pub(crate) fn vector<T: Real>(v: [f64; 3]) -> Vector3<T> {
    Vector3::from(v.map(T::from))
}

pub(crate) fn norm<T: Real>(v: &Vector3<T>) -> T {
    v.dot(v).root()
}

/// Displacements of the tip of a rigid arm by those of its root: u + theta cross r, theta.
pub(crate) fn arm<T: Real>(r: &Vector3<T>) -> Matrix6<T> {
    let mut a = Matrix6::identity();
    for (i, j, value) in [(0, 1, r.z), (1, 2, r.x), (2, 0, r.y)] {
        a[(i, 3 + j)] = value;
        a[(j, 3 + i)] = -value;
    }
    a
}

/// The same 3 x 3 for displacement and rotation.
pub(crate) fn blocks<T: Real>(q: &Matrix3<T>) -> Matrix6<T> {
    let mut b = Matrix6::zeros();
    b.fixed_view_mut::<3, 3>(0, 0).copy_from(q);
    b.fixed_view_mut::<3, 3>(3, 3).copy_from(q);
    b
}

/// Rows: unit x, the part of `y` normal to it, their cross product.
pub(crate) fn triad<T: Real>(x: Vector3<T>, y: Vector3<T>) -> Option<Matrix3<T>> {
    let clean = |v: Vector3<T>| v.map(|a| if a.double().abs() <= 4.0 * T::ROUNDING { T::zero() } else { a });
    let x = clean(x);
    let size = norm(&y);
    let normal = y - x * x.dot(&y);
    let least = norm(&normal);
    if !(size > T::zero() && size.double().is_finite() && least.double() > 1e-6 * size.double()) {
        return None;
    }
    let y = clean(normal / least);
    let z = clean(x.cross(&y));
    Some(Matrix3::from_rows(&[x.transpose(), y.transpose(), z.transpose()]))
}

fn axes<T: Real>(x: Vector3<T>, orientation: Vector3<T>, kind: Kind) -> Option<Matrix3<T>> {
    // A truss has no use for its y axis: any normal does.
    let least = (0..3).fold(0, |a, b| if x[b].size() < x[a].size() { b } else { a });
    let any = || triad(x, Matrix3::identity().column(least).into());
    triad(x, orientation).or_else(|| if kind == Kind::Truss { any() } else { None })
}

/// Exact stiffness of a uniform member, local axes, freedoms ux uy uz rx ry rz at each end.
///
/// In a plane, with r = EI / (L^3 (1 + p)) and p = 12 EI / (G As L^2): 12 r, 6 L r, (4 + p) L^2 r and
/// (2 - p) L^2 r; it is the inverse of the end flexibilities and does not lock.
///
/// # Source
/// Przemieniecki, Theory of Matrix Structural Analysis (1968), section 5.6.
fn stiffness<T: Real>(f: &Flexibility, length: T) -> Matrix12<T> {
    let inverse = |x: f64, times: T| if x.is_finite() { T::one() / (T::from(x) * times) } else { T::zero() };
    let number = T::from;
    let mut k = Matrix12::zeros();
    for (at, stiffness) in [(0, inverse(f.axial, length)), (3, inverse(f.torsion, length))] {
        k[(at, at)] = stiffness;
        k[(at + 6, at + 6)] = stiffness;
        k[(at, at + 6)] = -stiffness;
        k[(at + 6, at)] = -stiffness;
    }
    let square = length * length;
    for (v, turn, sign, bending, shear) in
        [(1, 5, 1.0, f.bending_z, f.shear_y), (2, 4, -1.0, f.bending_y, f.shear_z)]
    {
        let ei = inverse(bending, T::one());
        let p = number(12.0) * ei * number(shear) / square;
        let r = ei / (square * length * (T::one() + p));
        let (a, b) = (number(12.0) * r, number(sign * 6.0) * length * r);
        let (c, d) = ((number(4.0) + p) * square * r, (number(2.0) - p) * square * r);
        let at = [v, turn, v + 6, turn + 6];
        let block = [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]];
        for (i, row) in block.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                k[(at[i], at[j])] = value;
            }
        }
    }
    k
}

/// Condenses released freedoms out of `k`, one after the other: u_r = -K_rr^-1 K_ro u_o + K_rr^-1 f_r.
///
/// Returns the matrix that gives all member displacements by those at the tips of the arms, and K_rr^-1.
/// A released freedom that the section does not resist stays at rest. Fails with a freedom that the
/// others' release has left loose.
fn condense<T: Real>(
    k: &mut Matrix12<T>,
    releases: &[[bool; 6]; 2],
) -> Result<(Matrix12<T>, Matrix12<T>), usize> {
    let before: [f64; 12] = std::array::from_fn(|i| k[(i, i)].double());
    let mut recovery = Matrix12::identity();
    let mut slack = Matrix12::zeros();
    for r in (0..12).filter(|&r| releases[r / 6][r % 6]) {
        let pivot = k[(r, r)];
        if before[r] == 0.0 {
            recovery.row_mut(r).fill(T::zero());
            continue;
        }
        if pivot.double() <= LOOSE * before[r] {
            return Err(r);
        }
        let mut row = -k.row(r) / pivot;
        row[r] = T::zero();
        let column = k.column(r).into_owned();
        *k += column * row;
        k.row_mut(r).fill(T::zero());
        k.column_mut(r).fill(T::zero());
        // Whatever followed the freedom just released now follows what it follows.
        let share = recovery.column(r).into_owned();
        slack += share * share.transpose() / pivot;
        recovery.column_mut(r).fill(T::zero());
        recovery += share * row;
    }
    for i in 0..12 {
        if k[(i, i)].double() <= GONE * T::ROUNDING * before[i] {
            k.row_mut(i).fill(T::zero());
            k.column_mut(i).fill(T::zero());
        }
    }
    // To the last bit, whatever the order of the products above.
    *k = (*k + k.transpose()) * T::from(0.5);
    Ok((recovery, slack))
}
