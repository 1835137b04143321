//! A uniform stretch of rail: the data of one rail element.

use crate::error::Error;
use crate::vector::{RealNumber, cross, dot};

/// Rounding allowed in the frame of an element: how far its axes may be from orthogonal unit vectors.
const ORTHOGONALITY: f64 = 1e-9;

/// A frame whose axes are those of the rail.
pub(crate) const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Flexibilities of a member's section: reciprocal stiffnesses, so that zero means rigid.
///
/// Local x runs along the member. `bending_z` and `shear_y` act in the local x-y plane, `bending_y` and
/// `shear_z` in the local x-z plane. `f64::INFINITY` means that the section has no stiffness of that kind. A `tension` is
/// the one number that is no flexibility: it stiffens bending, and compression, its opposite, softens it.
///
/// ```
/// use splines::Flexibility;
///
/// // A steel girder in lb and ft: E = 4.32e9 lb/ft^2, Iz = 9.528 ft^4; all else rigid.
/// let girder = Flexibility { bending_z: 1.0 / (4.32e9 * 9.528), ..Flexibility::default() };
/// assert_eq!(girder.shear_y, 0.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flexibility {
    /// 1/(E A), 1/force.
    pub axial: f64,
    /// 1/(G J), 1/(force length^2).
    pub torsion: f64,
    /// 1/(E Iy), 1/(force length^2).
    pub bending_y: f64,
    /// 1/(E Iz), 1/(force length^2).
    pub bending_z: f64,
    /// 1/(G Asy), 1/force.
    pub shear_y: f64,
    /// 1/(G Asz), 1/force.
    pub shear_z: f64,
    /// Axial force N of the member, positive in tension, about which its motions are small; 0 without preload. It adds
    /// the energy 1/2 integral of N w'^2 to each plane of bending ([`crate::BeamColumn`]).
    pub tension: f64,
}

/// The member to which a rail element belongs.
///
/// Elements of one member, on different rails, are the same piece of steel: a force on one of them also bends
/// the other between its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElementMember {
    /// Identity of the member; only equality counts.
    pub id: usize,
    /// Whether the member's own local x runs against that of the element. The element's local axes are then
    /// those of the member, turned by half a turn about local y.
    pub reversed: bool,
}

/// A rail element: a uniform stretch of rail between two node states.
///
/// A node state is the displacement u and the rotation theta (six degrees of freedom, ux uy uz rx ry rz) of a
/// flexible end, in the frame of the element's rail. The element joins state `ends[0]` at `x[0]` and state
/// `ends[1]` at `x[1]`. The rail at x has the displacement u(x) + theta(x) cross `offset`.
///
/// Where `ends[0] == ends[1]` the element is a rigid arm of that one state: the rail at x has the
/// displacement u + theta cross (`offset` + (x - `x[0]`) e_x), and `length`, `frame` and `flexibility` are
/// ignored.
///
/// ```
/// use splines::{RailElement, Flexibility};
///
/// // 20 ft of rail, 3 ft above the axis of the girder that carries it.
/// let element = RailElement {
///     rail: 0,
///     x: [0.0, 20.0],
///     ends: [0, 1],
///     length: 20.0,
///     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     offset: [0.0, 3.0, 0.0],
///     flexibility: Flexibility { bending_z: 2.4e-11, ..Flexibility::default() },
///     member: None,
/// };
/// assert_eq!(element.place_on_member(5.0), 5.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RailElement<T = f64> {
    /// Index of the rail.
    pub rail: usize,
    /// First and last rail coordinate, increasing, length.
    pub x: [T; 2],
    /// Indices of the node states at the two ends.
    pub ends: [usize; 2],
    /// Length of the member's stretch, > 0. It exceeds `x[1] - x[0]` where the member is inclined to the
    /// rail.
    pub length: T,
    /// 3 x 3, one row an axis: the local axes in the rail frame; local x runs from `ends[0]` to `ends[1]`.
    pub frame: [[T; 3]; 3],
    /// Vector from the flexible axis to the rail, in the rail frame, length.
    pub offset: [T; 3],
    /// Flexibilities of the section.
    pub flexibility: Flexibility,
    /// The member whose whole flexible part the element stands on; `None` where no other element shares it.
    pub member: Option<ElementMember>,
}

impl<T: RealNumber> RailElement<T> {
    /// Whether the member runs against the element.
    #[must_use]
    pub fn is_reversed(&self) -> bool {
        self.member.is_some_and(|carrier| carrier.reversed)
    }

    /// 3 x 3, one row an axis: the member's own local axes in the rail frame. They are those of `frame`,
    /// turned by half a turn about local y where the member runs against the element.
    #[must_use]
    pub fn member_axes(&self) -> [[T; 3]; 3] {
        let [x, y, z] = self.frame;
        if self.is_reversed() {
            [x.map(|a| -a), y, z.map(|a| -a)]
        } else {
            self.frame
        }
    }

    /// Whether the element is a rigid arm of one node state.
    pub(crate) fn is_rigid_arm(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// In which ways the section has no stiffness: axially, in torsion, in the x-y plane and in the x-z
    /// plane.
    pub(crate) fn without_stiffness(&self) -> [bool; 4] {
        let flexibility = &self.flexibility;
        let infinite = |x: f64| x == f64::INFINITY;
        [
            infinite(flexibility.axial),
            infinite(flexibility.torsion),
            infinite(flexibility.bending_z) || infinite(flexibility.shear_y),
            infinite(flexibility.bending_y) || infinite(flexibility.shear_z),
        ]
    }
}

impl RailElement {
    /// Place along the member, 0..=`length` in the direction of the member's own local x, of rail coordinate
    /// x. Coordinates beyond the element count as its ends.
    #[must_use]
    pub fn place_on_member(&self, x: f64) -> f64 {
        let [first, last] = self.x;
        let r = if x >= last {
            1.0
        } else {
            ((x - first) / (last - first)).clamp(0.0, 1.0)
        };
        if self.is_reversed() {
            (1.0 - r) * self.length
        } else {
            r * self.length
        }
    }

    /// Checks the numbers of element number `index`.
    pub(crate) fn check(&self, index: usize) -> Result<(), Error> {
        let numbers = self.x.iter().chain(&self.offset);
        if numbers.copied().any(|x| !x.is_finite())
            || self.ends.iter().any(|&end| end > u32::MAX as usize)
        {
            return Err(Error::ElementNumber { cell: index });
        }
        if self.x[0] >= self.x[1] {
            return Err(Error::ElementExtent {
                cell: index,
                x: self.x,
            });
        }
        if self.is_rigid_arm() {
            return Ok(());
        }
        if !(self.length > 0.0 && self.length.is_finite()) {
            return Err(Error::ElementLength {
                cell: index,
                length: self.length,
            });
        }
        let [x, y, z] = self.frame;
        let third = cross(x, y);
        let third = [third[0] - z[0], third[1] - z[1], third[2] - z[2]];
        let defects = [
            dot(&x, &x) - 1.0,
            dot(&y, &y) - 1.0,
            dot(&x, &y),
            dot(&third, &third).sqrt(),
        ];
        if defects
            .iter()
            .any(|d| d.abs() > ORTHOGONALITY || d.is_nan())
        {
            return Err(Error::ElementFrame { cell: index });
        }
        let f = &self.flexibility;
        let all = [
            f.axial,
            f.torsion,
            f.bending_y,
            f.bending_z,
            f.shear_y,
            f.shear_z,
        ];
        // Shear that is softer than the compression has no stable straight state.
        let collapses = [f.shear_y, f.shear_z]
            .iter()
            .any(|shear| shear * f.tension <= -1.0);
        if all.iter().any(|x| *x < 0.0 || x.is_nan()) || !f.tension.is_finite() || collapses {
            return Err(Error::ElementFlexibility { cell: index });
        }
        Ok(())
    }
}

/// A place in an element, measured from the nearer end.
///
/// Polynomials in the distance from the nearer end keep their relative accuracy where they vanish at that
/// end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalPlace<T = f64> {
    /// Which end is nearer, 0 or 1.
    pub end: usize,
    /// Distance from it as a fraction of the element, 0..=0.5.
    pub r: T,
}

impl<T: RealNumber> LocalPlace<T> {
    /// The place of coordinate x in an element with the ends `ends` and 1/extent = `scale`.
    #[inline]
    pub fn of(x: T, ends: [T; 2], scale: T) -> LocalPlace<T> {
        LocalPlace::by_distances([x - ends[0], ends[1] - x], scale)
    }

    /// The place by its distances from both ends.
    #[inline]
    pub fn by_distances(distances: [T; 2], scale: T) -> LocalPlace<T> {
        let [first, last] = distances.map(|distance| distance * scale);
        let inside = |r: T| if r > T::from(0.0) { r } else { T::from(0.0) };
        if first <= T::from(0.5) {
            LocalPlace {
                end: 0,
                r: inside(first),
            }
        } else {
            LocalPlace {
                end: 1,
                r: inside(last),
            }
        }
    }

    /// The same on the member that carries the element.
    #[inline]
    pub fn on_member(self, length: T, reversed: bool) -> MemberPlace<T> {
        let near = self.r * length;
        let far = length - near;
        if (self.end == 1) == reversed {
            MemberPlace { s: near, q: far }
        } else {
            MemberPlace { s: far, q: near }
        }
    }
}

/// A place on a member by its distances from both ends; the smaller one keeps its relative accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MemberPlace<T = f64> {
    /// Distance from the first end.
    pub s: T,
    /// Distance from the last end.
    pub q: T,
}

impl<T: RealNumber> MemberPlace<T> {
    /// The place as seen from the other end.
    #[inline(always)]
    pub fn mirrored(self) -> MemberPlace<T> {
        MemberPlace {
            s: self.q,
            q: self.s,
        }
    }

    /// Whether the place is before another one, judged by the accurate distances.
    #[inline(always)]
    pub fn is_before(self, other: MemberPlace<T>) -> bool {
        if self.s > self.q && other.s > other.q {
            self.q > other.q
        } else {
            self.s < other.s
        }
    }
}
