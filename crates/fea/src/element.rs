//! The straight uniform member: 12 x 12 stiffness, releases, rigid arms.

use nalgebra::{Matrix3, SMatrix, Vector3};
use splines::Flexibility;

use crate::error::{Error, Fault, Item};
use crate::model::{Freedom, Kind, Member, Model};

pub(crate) type Matrix6 = SMatrix<f64, 6, 6>;
pub(crate) type Matrix12 = SMatrix<f64, 12, 12>;

/// Pivot, relative to its diagonal, below which a released freedom is held by nothing.
const LOOSE: f64 = 1e-10;
/// Stiffness, relative to what it was, below which condensation has removed it.
const GONE: f64 = 1e-13;

/// A member with its geometry worked out.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    pub points: [usize; 2],
    /// Ends of the flexible part, global.
    pub ends: [Vector3<f64>; 2],
    /// From the points to the ends, global.
    pub offsets: [Vector3<f64>; 2],
    /// Rows: local axes.
    pub axes: Matrix3<f64>,
    pub length: f64,
    pub flexibility: Flexibility,
    /// Local stiffness between the tips of the arms, releases condensed.
    pub stiffness: Matrix12,
    /// Diagonal of the stiffness before releases: the scale of its rounding.
    pub scale: [f64; 12],
    /// What its releases do; `None` without any.
    pub released: Option<Box<Released>>,
}

/// Motion of the flexible ends of a member with releases, local.
#[derive(Clone, Debug)]
pub(crate) struct Released {
    /// Whether anything is released at each end.
    pub ends: [bool; 2],
    /// Displacements of the flexible ends by those of the tips of the arms.
    pub recovery: Matrix12,
    /// Displacements of the flexible ends per load on them while the tips of the arms are held: zero
    /// but between released freedoms.
    pub slack: Matrix12,
}

impl Element {
    pub fn new(m: &Model, index: usize) -> Result<Element, Error> {
        let member: &Member = &m.members[index];
        let invalid = |fault| Error::Invalid { item: Item::Member(index), fault };
        let offsets = member.offsets.map(Vector3::from);
        let place = |k: usize| Vector3::from(m.points[member.points[k]]) + offsets[k];
        let ends = [place(0), place(1)];
        let along = ends[1] - ends[0];
        let length = along.norm();
        if length <= 1e-12 * ends[0].amax().max(ends[1].amax()) || !length.is_finite() {
            return Err(invalid(Fault::NoLength));
        }
        let axes = axes(along / length, Vector3::from(member.orientation), member.kind)
            .ok_or(invalid(Fault::Orientation))?;
        let mut flexibility = m.sections[member.section].flexibility(m.theory);
        if member.kind == Kind::Truss {
            let none = f64::INFINITY;
            let axial = flexibility.axial;
            flexibility =
                Flexibility { axial, torsion: none, bending_y: none, bending_z: none, ..Default::default() };
        }
        let mut stiffness = stiffness(&flexibility, length);
        let scale = std::array::from_fn(|k| stiffness[(k, k)]);
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
    pub fn rotation(&self) -> Matrix6 {
        blocks(&self.axes)
    }
}

/// Displacements of the tip of a rigid arm by those of its root: u + theta cross r, theta.
pub(crate) fn arm(r: &Vector3<f64>) -> Matrix6 {
    let mut a = Matrix6::identity();
    a.fixed_view_mut::<3, 3>(0, 3).copy_from(&-r.cross_matrix());
    a
}

/// The same 3 x 3 for displacement and rotation.
pub(crate) fn blocks(q: &Matrix3<f64>) -> Matrix6 {
    let mut b = Matrix6::zeros();
    b.fixed_view_mut::<3, 3>(0, 0).copy_from(q);
    b.fixed_view_mut::<3, 3>(3, 3).copy_from(q);
    b
}

/// Rows: unit x, the part of `y` normal to it, their cross product.
pub(crate) fn triad(x: Vector3<f64>, y: Vector3<f64>) -> Option<Matrix3<f64>> {
    let clean = |v: Vector3<f64>| v.map(|a| if a.abs() <= 4.0 * f64::EPSILON { 0.0 } else { a });
    let x = clean(x);
    let size = y.norm();
    let normal = y - x * x.dot(&y);
    if size == 0.0 || !size.is_finite() || normal.norm() <= 1e-6 * size {
        return None;
    }
    let y = clean(normal.normalize());
    let z = clean(x.cross(&y));
    Some(Matrix3::from_rows(&[x.transpose(), y.transpose(), z.transpose()]))
}

fn axes(x: Vector3<f64>, orientation: Vector3<f64>, kind: Kind) -> Option<Matrix3<f64>> {
    // A truss has no use for its y axis: any normal does.
    let any = || triad(x, Matrix3::identity().column(x.iamin()).into());
    triad(x, orientation).or_else(|| if kind == Kind::Truss { any() } else { None })
}

/// Exact stiffness of a uniform member, local axes, freedoms ux uy uz rx ry rz at each end.
///
/// In a plane, with r = EI / (L^3 (1 + p)) and p = 12 EI / (G As L^2): 12 r, 6 L r, (4 + p) L^2 r and
/// (2 - p) L^2 r; it is the inverse of the end flexibilities and does not lock.
///
/// # Source
/// Przemieniecki, Theory of Matrix Structural Analysis (1968), section 5.6.
fn stiffness(f: &Flexibility, length: f64) -> Matrix12 {
    let mut k = Matrix12::zeros();
    for (at, stiffness) in [(0, 1.0 / (f.axial * length)), (3, 1.0 / (f.torsion * length))] {
        k[(at, at)] = stiffness;
        k[(at + 6, at + 6)] = stiffness;
        k[(at, at + 6)] = -stiffness;
        k[(at + 6, at)] = -stiffness;
    }
    for (v, turn, sign, bending, shear) in
        [(1, 5, 1.0, f.bending_z, f.shear_y), (2, 4, -1.0, f.bending_y, f.shear_z)]
    {
        let ei = 1.0 / bending;
        let p = 12.0 * ei * shear / (length * length);
        let r = ei / (length * length * length * (1.0 + p));
        let (a, b) = (12.0 * r, sign * 6.0 * length * r);
        let (c, d) = ((4.0 + p) * length * length * r, (2.0 - p) * length * length * r);
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
fn condense(k: &mut Matrix12, releases: &[[bool; 6]; 2]) -> Result<(Matrix12, Matrix12), usize> {
    let before: [f64; 12] = std::array::from_fn(|i| k[(i, i)]);
    let mut recovery = Matrix12::identity();
    let mut slack = Matrix12::zeros();
    for r in (0..12).filter(|&r| releases[r / 6][r % 6]) {
        let pivot = k[(r, r)];
        if before[r] == 0.0 {
            recovery.row_mut(r).fill(0.0);
            continue;
        }
        if pivot <= LOOSE * before[r] {
            return Err(r);
        }
        let mut row = -k.row(r) / pivot;
        row[r] = 0.0;
        let column = k.column(r).into_owned();
        *k += column * row;
        k.row_mut(r).fill(0.0);
        k.column_mut(r).fill(0.0);
        // Whatever followed the freedom just released now follows what it follows.
        let share = recovery.column(r).into_owned();
        slack += share * share.transpose() / pivot;
        recovery.column_mut(r).fill(0.0);
        recovery += share * row;
    }
    for i in 0..12 {
        if k[(i, i)] <= GONE * before[i] {
            k.row_mut(i).fill(0.0);
            k.column_mut(i).fill(0.0);
        }
    }
    // To the last bit, whatever the order of the products above.
    *k = (*k + k.transpose()) * 0.5;
    Ok((recovery, slack))
}
