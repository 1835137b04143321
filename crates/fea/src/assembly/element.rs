//! The straight uniform member: exact 12 x 12 stiffness, releases, local axes.

use nalgebra::{Matrix3, RowSVector, SMatrix, Vector3};
use num_traits::Zero;
use splines::{BeamColumn, Flexibility, ForceComponent};

use crate::assembly::precision::{Extended, Real, exact_sum};
use crate::dof::{Dof, DofSet};
use crate::error::{EntryFault, Error, ModelEntry};
use crate::model::{Member, MemberKind, Model};

pub(crate) type Matrix6<T = f64> = SMatrix<T, 6, 6>;
pub(crate) type Matrix12<T = f64> = SMatrix<T, 12, 12>;

/// Length of a member, relative to its coordinates, at which it counts as zero.
const NO_LENGTH: f64 = 1e-12;
/// Pivot, relative to its diagonal entry, at which a released degree of freedom has no stiffness left.
const LEAST_RELEASE_PIVOT: f64 = 1e-10;
/// Diagonal entry, in roundings of its value before condensation, at which it counts as zero.
const CANCELLED: f64 = 450.0;
/// Sine of the angle between orientation and member at which the local axes are not determined.
const PARALLEL: f64 = 1e-6;

/// A member with its geometry evaluated, in the precision T.
#[derive(Clone, Debug)]
pub(crate) struct Element<T: Real = f64> {
    /// Indices of its points.
    pub points: [usize; 2],
    /// Its geometry, to all digits.
    pub geometry: Geometry,
    /// From the points to the ends, global.
    pub offsets: [Vector3<T>; 2],
    /// Rows: local axes.
    pub axes: Matrix3<T>,
    /// Error of the components of each local axis, in roundings of T; 0 where only their own digits are rounded.
    pub axes_error: [f64; 3],
    /// Length of the flexible part.
    pub length: T,
    pub flexibility: Flexibility,
    /// Whether it resists transverse displacements of its ends as a string, by its axial force alone.
    pub is_string: bool,
    /// Effect of its releases; `None` if it has none.
    pub released: Option<Box<Released<T>>>,
}

/// Where a member lies. It is evaluated in double-doubles: coordinates and offsets can be far larger than the member.
#[derive(Clone, Debug)]
pub(crate) struct Geometry {
    /// Largest coordinate of the ends of the flexible part, absolute value.
    pub far: f64,
    /// Rows: local axes.
    pub axes: Matrix3<Extended>,
    /// Error of the components of each of them, in roundings of double-doubles; 0 where they are exact.
    pub axes_error: [f64; 3],
    /// Length of the flexible part.
    pub length: Extended,
}

impl Geometry {
    /// The geometry of a member of a checked model.
    fn new(m: &Model, member: &Member) -> Result<Geometry, EntryFault> {
        let [[p, q], [a, b]] = [member.points.map(|point| m.points[point]), member.offsets];
        let along: Vector3<Extended> = Vector3::from(std::array::from_fn(|k| {
            exact_sum([q[k], -p[k], b[k], -a[k]])
        }));
        let length = norm(&along);
        let sizes = (0..3).flat_map(|k| [(p[k] + a[k]).abs(), (q[k] + b[k]).abs()]);
        let far = sizes.fold(0.0_f64, f64::max);
        // Points that are equal up to the rounding of their coordinates have no distance.
        if length.double() <= NO_LENGTH * far || !length.double().is_finite() {
            return Err(EntryFault::NoLength);
        }
        let Triad { axes, error } =
            local_axes(along / length, vector(member.orientation), member.kind)
                .ok_or(EntryFault::Orientation)?;
        // The first axis keeps all its digits.
        Ok(Geometry {
            far,
            axes,
            axes_error: [0.0, error, error],
            length,
        })
    }
}

impl Geometry {
    /// The axes in the precision T, and their error in roundings of T.
    ///
    /// Components that are only rounding in T are set to zero, so that exact zeros of the stiffness stay.
    fn rounded_axes<T: Real>(&self) -> (Matrix3<T>, [f64; 3]) {
        let rounded = without_rounding(&self.axes, 4.0 * T::ROUNDING);
        let error = std::array::from_fn(|row| {
            let changed = (0..3).fold(0.0_f64, |most, k| {
                let lost = if rounded[(row, k)] == Extended::zero() {
                    self.axes[(row, k)]
                } else {
                    Extended::zero()
                };
                most.max(lost.double().abs())
            });
            (changed + self.axes_error[row] * Extended::ROUNDING) / T::ROUNDING
        });
        (rounded.map(T::rounded), error)
    }
}

/// Axes with components of at most `size` set to zero.
pub(crate) fn without_rounding(axes: &Matrix3<Extended>, size: f64) -> Matrix3<Extended> {
    axes.map(|a| {
        if a.double().abs() <= size {
            Extended::zero()
        } else {
            a
        }
    })
}

/// Motion of the flexible ends of a member with releases, local axes.
#[derive(Clone, Debug)]
pub(crate) struct Released<T: Real = f64> {
    /// Whether each end has a release.
    pub ends: [bool; 2],
    /// Local stiffness between the tips of the rigid offsets, releases condensed.
    pub stiffness: Matrix12<T>,
    /// Displacements of the flexible ends by those of the tips of the rigid offsets, without load.
    pub recovery: Matrix12<T>,
    /// K_rr^-1: displacements of the flexible ends per load on them while the tips are fixed. It is zero
    /// except between released degrees of freedom.
    pub compliance: Matrix12<T>,
    /// Largest ratio of a diagonal entry before the releases to its pivot: what rounding grows by.
    pub growth: f64,
    /// Number of negative pivots: compression has buckled the member between its ends.
    pub negative: usize,
}

/// One of the two planes in which a member bends: local x-y or x-z.
pub(crate) struct BendingPlane {
    /// Index of the deflection among the six degrees of freedom of an end.
    pub deflection: usize,
    /// Index of the rotation.
    pub rotation: usize,
    /// Sign of the rotation that a positive slope of the deflection is.
    pub sign: f64,
    /// 1/EI.
    pub bending: f64,
    /// 1/GAs.
    pub shear: f64,
    /// Axial force, positive in tension.
    pub tension: f64,
}

impl BendingPlane {
    /// phi = 12 EI / (G As L^2), the ratio of shear to bending flexibility, for a plane with finite 1/EI.
    pub fn shear_ratio(&self, length: f64) -> f64 {
        12.0 * self.shear / (self.bending * length * length)
    }
}

/// The local x-y plane, in which Iz bends, then the x-z plane, in which Iy bends.
pub(crate) fn bending_planes(f: &Flexibility) -> [BendingPlane; 2] {
    let tension = f.tension;
    [
        BendingPlane {
            deflection: 1,
            rotation: 5,
            sign: 1.0,
            bending: f.bending_z,
            shear: f.shear_y,
            tension,
        },
        BendingPlane {
            deflection: 2,
            rotation: 4,
            sign: -1.0,
            bending: f.bending_y,
            shear: f.shear_z,
            tension,
        },
    ]
}

impl<T: Real> Element<T> {
    /// The elements of all members of a checked model.
    ///
    /// # Errors
    /// A member without length or local axes; releases that leave a mechanism in a member.
    pub fn all(m: &Model) -> Result<Vec<Element<T>>, Error> {
        let mut elements = Vec::with_capacity(m.members.len());
        for index in 0..m.members.len() {
            elements.push(Element::new(m, index)?);
        }
        Ok(elements)
    }

    /// The element of one member.
    ///
    /// # Errors
    /// As [`Element::all`].
    pub fn new(m: &Model, index: usize) -> Result<Element<T>, Error> {
        let member = &m.members[index];
        let invalid = |fault| Error::Invalid {
            entry: ModelEntry::Member(index),
            fault,
        };
        let geometry = Geometry::new(m, member).map_err(invalid)?;
        let length = T::rounded(geometry.length);
        let (axes, axes_error) = geometry.rounded_axes();
        let mut flexibility = m.sections[member.section].flexibility(m.theory);
        match member.kind {
            MemberKind::Beam => {}
            MemberKind::Truss | MemberKind::Cable => {
                flexibility = without_bending(f64::INFINITY, flexibility);
            }
            MemberKind::Rod => flexibility = without_bending(flexibility.torsion, flexibility),
        }
        flexibility.tension = member.tension;
        let mut element = Element {
            points: member.points,
            offsets: member.offsets.map(vector),
            geometry,
            axes,
            axes_error,
            length,
            flexibility,
            is_string: member.kind != MemberKind::Beam,
            released: None,
        };
        if member.releases.iter().flatten().any(|&released| released) {
            let condensed = condense(element.unreleased_stiffness(), &member.releases);
            element.released = Some(Box::new(condensed.map_err(|k| Error::Released {
                member: index,
                end: k / 6,
                dof: Dof::ALL[k % 6],
            })?));
        }
        Ok(element)
    }

    /// Local stiffness between the tips of the rigid offsets, releases condensed.
    pub fn stiffness(&self) -> Matrix12<T> {
        self.released.as_ref().map_or_else(
            || self.unreleased_stiffness(),
            |released| released.stiffness,
        )
    }

    /// The same before releases.
    pub fn unreleased_stiffness(&self) -> Matrix12<T> {
        let mut stiffness = stiffness(&self.flexibility, self.length);
        if self.is_string {
            add_string(
                &mut stiffness,
                T::from(self.flexibility.tension) / self.length,
            );
        }
        stiffness
    }

    /// The magnitudes that were added up for each diagonal entry of `unreleased`, the stiffness before releases: more than the
    /// entry where an axial force takes stiffness away.
    pub fn diagonal_sizes(&self, unreleased: &Matrix12<T>) -> [f64; 12] {
        let length = self.length.double();
        let string = 2.0 * (self.flexibility.tension / length).abs();
        let arm = string * length * length;
        let added = [string, string, string, 0.0, arm, arm];
        std::array::from_fn(|k| {
            let own = unreleased[(k, k)].double().abs();
            if own == 0.0 { 0.0 } else { own + added[k % 6] }
        })
    }

    /// Rotation of a displacement and a rotation from global into local axes.
    pub fn rotation(&self) -> Matrix6<T> {
        diagonal_blocks(&self.axes)
    }
}

impl Element {
    /// What the axial force adds to an internal force at the fraction `place` of the length, by the displacements of the
    /// flexible ends, local axes; `None` where it adds nothing.
    ///
    /// It is N times the deflection from the first end, or its slope ([`ForceComponent::under_tension`]).
    pub fn tension_row(
        &self,
        place: f64,
        component: ForceComponent,
    ) -> Option<RowSVector<f64, 12>> {
        let tension = self.flexibility.tension;
        let (plane, factors) = component.under_tension().filter(|_| tension != 0.0)?;
        let own = &bending_planes(&self.flexibility)[plane];
        let [mut deflection, slope] = if let Some(column) = self.column(own) {
            column.section(place)
        } else if self.is_string {
            let rate = 1.0 / self.length;
            [[1.0 - place, 0.0, place, 0.0], [-rate, 0.0, rate, 0.0]]
        } else {
            return None;
        };
        deflection[0] -= 1.0;
        let at = [
            own.deflection,
            own.rotation,
            own.deflection + 6,
            own.rotation + 6,
        ];
        let mut row = RowSVector::<f64, 12>::zeros();
        for (k, sign) in [1.0, own.sign, 1.0, own.sign].into_iter().enumerate() {
            row[at[k]] = tension * sign * (factors[0] * deflection[k] + factors[1] * slope[k]);
        }
        Some(row)
    }

    /// Turns the end forces of an inertia that is uniform over the member, rows of `forces`, into those under the axial force:
    /// the moments at the clamped ends change by [`BeamColumn::uniform_end_moment`].
    pub fn bend_uniform_load(&self, forces: &mut Matrix12) {
        if self.flexibility.tension == 0.0 {
            return;
        }
        for plane in bending_planes(&self.flexibility) {
            let Some(column) = self.column(&plane) else {
                continue;
            };
            let factor = column.uniform_end_moment();
            for row in [plane.rotation, plane.rotation + 6] {
                forces
                    .row_mut(row)
                    .iter_mut()
                    .for_each(|force| *force *= factor);
            }
        }
    }

    /// What the axial force adds to an internal force by the deflection of the clamped member under the inertia of a unit
    /// of uniform acceleration, and the degree of freedom of its first end in that direction.
    pub fn uniform_load_under_tension(
        &self,
        mass: f64,
        section: &splines::InternalForce,
    ) -> Option<(usize, f64)> {
        let (plane, factors) = section
            .component
            .under_tension()
            .filter(|_| self.flexibility.tension != 0.0)?;
        let own = &bending_planes(&self.flexibility)[plane];
        let [deflected, slope] = self.column(own)?.under_uniform_load(section.place);
        Some((
            own.deflection,
            mass * (factors[0] * deflected + factors[1] * slope),
        ))
    }

    /// The plane under the axial force; `None` where it has no bending stiffness.
    fn column(&self, plane: &BendingPlane) -> Option<BeamColumn<f64>> {
        (plane.bending.is_finite() && plane.shear.is_finite())
            .then(|| BeamColumn::new(plane.bending, plane.shear, plane.tension, self.length))
    }

    /// Displacements of the flexible ends by those of the tips of the rigid offsets, without load.
    pub fn recovery(&self) -> Matrix12 {
        self.released
            .as_ref()
            .map_or(Matrix12::identity(), |released| released.recovery)
    }
}

/// Doubles in the precision T.
pub(crate) fn vector<T: Real>(v: [f64; 3]) -> Vector3<T> {
    Vector3::from(v.map(T::from))
}

/// Length of a vector; exact for one along a global axis.
pub(crate) fn norm(v: &Vector3<Extended>) -> Extended {
    if only_component(v).is_some() {
        v.iter()
            .fold(Extended::zero(), |sum, x| sum + x.magnitude())
    } else {
        v.dot(v).root()
    }
}

/// The component of a vector that is not zero, if there is exactly one.
fn only_component(v: &Vector3<Extended>) -> Option<usize> {
    let zero = v.map(|x| x == Extended::zero());
    match [zero.x, zero.y, zero.z] {
        [false, true, true] => Some(0),
        [true, false, true] => Some(1),
        [true, true, false] => Some(2),
        _ => None,
    }
}

/// The same 3 x 3 matrix for the displacement and for the rotation.
pub(crate) fn diagonal_blocks<T: Real>(q: &Matrix3<T>) -> Matrix6<T> {
    let mut b = Matrix6::zeros();
    b.fixed_view_mut::<3, 3>(0, 0).copy_from(q);
    b.fixed_view_mut::<3, 3>(3, 3).copy_from(q);
    b
}

/// Right-handed axes as rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triad {
    pub axes: Matrix3<Extended>,
    /// Error of the components, in roundings; 0 where the axes are those of the coordinates.
    pub error: f64,
}

impl Triad {
    /// The unit vector `x`, the part of `y` normal to it, their cross product.
    ///
    /// Components that are only rounding are set to zero, so that exact zeros of the stiffness stay. `None` if
    /// `y` is zero, not finite, or parallel to `x`.
    pub fn new(x: Vector3<Extended>, y: Vector3<Extended>) -> Option<Triad> {
        let zero = Extended::zero();
        let clean = |v: Vector3<Extended>| {
            v.map(|a| {
                if a.double().abs() <= 4.0 * Extended::ROUNDING {
                    zero
                } else {
                    a
                }
            })
        };
        let size = norm(&y);
        if let Some(along) = only_component(&x) {
            let mut across = y;
            across[along] = zero;
            if let Some(up) = only_component(&across)
                && across[up].double().abs() > PARALLEL * size.double()
                && size.double().is_finite()
            {
                return Some(Triad::along_coordinates([along, up], [x[along], y[up]]));
            }
        }
        let x = clean(x);
        let normal = y - x * x.dot(&y);
        let least = norm(&normal);
        if !(size > zero && size.double().is_finite() && least.double() > PARALLEL * size.double())
        {
            return None;
        }
        let y = clean(normal / least);
        let z = clean(x.cross(&y));
        let error = 4.0 * size.double() / least.double();
        Some(Triad {
            axes: Matrix3::from_rows(&[x.transpose(), y.transpose(), z.transpose()]),
            error,
        })
    }
}

impl Triad {
    /// Axes along those of the coordinates: the indices of x and y, and numbers that have their signs.
    fn along_coordinates(index: [usize; 2], signs: [Extended; 2]) -> Triad {
        let axis = |k: usize| {
            let mut axis = Vector3::zeros();
            axis[index[k]] = if signs[k] < Extended::zero() {
                -1.0
            } else {
                1.0
            };
            axis
        };
        let (x, y): (Vector3<f64>, Vector3<f64>) = (axis(0), axis(1));
        let axes = Matrix3::from_rows(&[x.transpose(), y.transpose(), x.cross(&y).transpose()]);
        // Adding 0.0 turns -0.0 into 0.0.
        Triad {
            axes: axes.map(|a| Extended::from(a + 0.0)),
            error: 0.0,
        }
    }
}

/// Local axes of a member. Trusses and rods do not use their y axis: without an orientation any normal will do.
fn local_axes(
    x: Vector3<Extended>,
    orientation: Vector3<Extended>,
    kind: MemberKind,
) -> Option<Triad> {
    let least = (0..3).fold(0, |a, b| {
        if x[b].magnitude() < x[a].magnitude() {
            b
        } else {
            a
        }
    });
    let any = || Triad::new(x, Matrix3::identity().column(least).into());
    Triad::new(x, orientation).or_else(|| {
        if kind == MemberKind::Beam {
            None
        } else {
            any()
        }
    })
}

/// The flexibility of a member that resists its change of length, twist with the flexibility `torsion`, and no bending.
fn without_bending(torsion: f64, f: Flexibility) -> Flexibility {
    let none = f64::INFINITY;
    Flexibility {
        axial: f.axial,
        torsion,
        bending_y: none,
        bending_z: none,
        ..Flexibility::default()
    }
}

/// Adds the resistance of a string, the axial force divided by the length, against transverse displacements of the ends.
fn add_string<T: Real>(k: &mut Matrix12<T>, string: T) {
    for at in [1, 2] {
        k[(at, at)] += string;
        k[(at + 6, at + 6)] += string;
        k[(at, at + 6)] -= string;
        k[(at + 6, at)] -= string;
    }
}

/// Exact stiffness of a uniform member in local axes, degrees of freedom ux uy uz rx ry rz at each end.
///
/// Change of length and twist: EA/L and GJ/L. In each plane of bending, with phi = 12 EI / (G As L^2) and
/// r = EI / (L^3 (1 + phi)), the entries are 12 r, 6 L r, (4 + phi) L^2 r and (2 - phi) L^2 r. The matrix is
/// the inverse of the end flexibilities and does not lock.
///
/// # Source
/// Przemieniecki, Theory of Matrix Structural Analysis (1968), section 5.6.
fn stiffness<T: Real>(f: &Flexibility, length: T) -> Matrix12<T> {
    let mut k = Matrix12::zeros();
    // An infinite flexibility leaves exact zeros, by which unstiffened degrees of freedom are recognised.
    for (at, stiffness) in [
        (0, inverse(f.axial, length)),
        (3, inverse(f.torsion, length)),
    ] {
        k[(at, at)] = stiffness;
        k[(at + 6, at + 6)] = stiffness;
        k[(at, at + 6)] = -stiffness;
        k[(at + 6, at)] = -stiffness;
    }
    for plane in bending_planes(f) {
        let at = [
            plane.deflection,
            plane.rotation,
            plane.deflection + 6,
            plane.rotation + 6,
        ];
        for (i, row) in bending_stiffness(&plane, length).iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                k[(at[i], at[j])] = value;
            }
        }
    }
    k
}

/// 4 x 4 stiffness of one plane: deflection and rotation of the first end, then of the second.
fn bending_stiffness<T: Real>(plane: &BendingPlane, length: T) -> [[T; 4]; 4] {
    let number = T::from;
    if plane.tension != 0.0 && plane.bending.is_finite() && plane.shear.is_finite() {
        return stability_stiffness(plane, length);
    }
    let square = length * length;
    let ei = inverse(plane.bending, T::one());
    let phi = number(12.0) * ei * number(plane.shear) / square;
    let r = ei / (square * length * (T::one() + phi));
    let (a, b) = (number(12.0) * r, number(plane.sign * 6.0) * length * r);
    let (c, d) = (
        (number(4.0) + phi) * square * r,
        (number(2.0) - phi) * square * r,
    );
    [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]]
}

/// The same under an axial force N, from the stiffness of both ends against opposite and against equal rotations, s and t
/// ([`BeamColumn`]): 2 t/L^2 + N/L, t/L, (t + s)/2 and (t - s)/2.
///
/// # Source
/// Timoshenko and Gere, Theory of Elastic Stability (1961), section 1.10.
fn stability_stiffness<T: Real>(plane: &BendingPlane, length: T) -> [[T; 4]; 4] {
    let column = BeamColumn::new(plane.bending, plane.shear, plane.tension, length);
    let [opposite, equal] = column.rotational_stiffness();
    let half = T::from(0.5);
    let a = (equal + equal) / (length * length) + column.chord_stiffness();
    let b = T::from(plane.sign) * equal / length;
    let (c, d) = (half * (equal + opposite), half * (equal - opposite));
    [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]]
}

/// 1/(flexibility factor), 0 for an infinite flexibility.
fn inverse<T: Real>(flexibility: f64, factor: T) -> T {
    if flexibility.is_finite() {
        T::one() / (T::from(flexibility) * factor)
    } else {
        T::zero()
    }
}

/// Static condensation of the released degrees of freedom r of a member, one after the other:
///
/// K' = K_oo - K_or K_rr^-1 K_ro,   u_r = -K_rr^-1 K_ro u_o + K_rr^-1 f_r
///
/// A degree of freedom for which the section has no stiffness stays at rest. Fails with the index of one that the other
/// releases have left without stiffness.
fn condense<T: Real>(mut k: Matrix12<T>, releases: &[DofSet; 2]) -> Result<Released<T>, usize> {
    let before: [f64; 12] = std::array::from_fn(|i| k[(i, i)].double());
    let mut recovery = Matrix12::identity();
    let mut compliance = Matrix12::zeros();
    let mut growth = 1.0_f64;
    let mut negative = 0;
    for r in (0..12).filter(|&r| releases[r / 6][r % 6]) {
        let pivot = k[(r, r)];
        if before[r] == 0.0 {
            recovery.row_mut(r).fill(T::zero());
            continue;
        }
        if pivot.double().abs() <= LEAST_RELEASE_PIVOT * before[r].abs() {
            return Err(r);
        }
        growth = growth.max((before[r] / pivot.double()).abs());
        negative += usize::from(pivot < T::zero());
        let mut row = -k.row(r) / pivot;
        row[r] = T::zero();
        let column = k.column(r).into_owned();
        k += column * row;
        k.row_mut(r).fill(T::zero());
        k.column_mut(r).fill(T::zero());
        // Degrees of freedom released before depend on this one: substitute its own dependence.
        let dependence = recovery.column(r).into_owned();
        compliance += dependence * dependence.transpose() / pivot;
        recovery.column_mut(r).fill(T::zero());
        recovery += dependence * row;
    }
    // A diagonal entry that is only rounding is an exact zero: the releases have removed the stiffness.
    for i in 0..12 {
        if k[(i, i)].double().abs() <= CANCELLED * T::ROUNDING * before[i].abs() {
            k.row_mut(i).fill(T::zero());
            k.column_mut(i).fill(T::zero());
        }
    }
    // Symmetric to the last bit, whatever the order of the products above.
    let stiffness = (k + k.transpose()) * T::from(0.5);
    let ends = releases.map(|set| set.contains(&true));
    Ok(Released {
        ends,
        stiffness,
        recovery,
        compliance,
        growth,
        negative,
    })
}
