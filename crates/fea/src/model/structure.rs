//! A frame as given: points, members, supports, springs, links and masses.

use crate::dof::{Dof, DofSet};
use crate::error::{EntryAttribute, EntryFault, Error, ModelEntry, finite, not_negative};
use crate::model::section::{BeamTheory, CrossSection};

/// Which deformations a member resists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MemberKind {
    /// All deformations for which its section has a stiffness.
    #[default]
    Beam,
    /// Its change of length alone; its ends transmit no moment.
    Truss,
    /// Its change of length and its twist; its ends transmit no bending moment. The mass moves with the straight line
    /// between the ends and has no inertia in twist.
    Rod,
    /// Its change of length alone, as long as it is in tension; only its area counts.
    Cable,
}

/// A straight uniform member between two points, with rigid offsets and releases.
///
/// The flexible part of the member runs from end 0, at its first point plus `offsets[0]`, to end 1. Local x
/// runs from end 0 to end 1; local y is the part of `orientation` normal to local x; local z = x cross y.
///
/// # Example
/// ```
/// use fea::{Dof, Member};
///
/// // From point 0 to point 1 with section 0, local y upwards, hinged about local z at its second end.
/// let mut member = Member::beam([0, 1], 0, [0.0, 1.0, 0.0]);
/// member.releases[1][Dof::Rz as usize] = true;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member {
    /// Indices of its two points.
    pub points: [usize; 2],
    /// Which deformations it resists.
    pub kind: MemberKind,
    /// Index of its section.
    pub section: usize,
    /// Any global vector in the half plane of local x and +y. Trusses and rods may leave it zero.
    pub orientation: [f64; 3],
    /// Rigid offsets: global vectors from the points to the ends of the flexible part, length.
    pub offsets: [[f64; 3]; 2],
    /// Local degrees of freedom released at each end, between the rigid offset and the flexible part.
    pub releases: [DofSet; 2],
    /// Axial force about which the motions of the member are small, positive in tension; 0 without preload. It is that of
    /// an equilibrium of the whole structure ([`crate::preloaded`]): forces on some members alone give motions that no
    /// structure has.
    pub tension: f64,
}

impl Member {
    /// A beam between two points without offsets and releases.
    #[must_use]
    pub const fn beam(points: [usize; 2], section: usize, orientation: [f64; 3]) -> Self {
        Member {
            points,
            kind: MemberKind::Beam,
            section,
            orientation,
            offsets: [[0.0; 3]; 2],
            releases: [[false; 6]; 2],
            tension: 0.0,
        }
    }
}

/// Global degrees of freedom of a point that are fixed to the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Support {
    /// Index of the point.
    pub point: usize,
    /// Which degrees of freedom are fixed.
    pub fixed: DofSet,
}

/// A spring to ground, along or about a global axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundSpring {
    /// Index of the point.
    pub point: usize,
    /// Which degree of freedom it acts on.
    pub dof: Dof,
    /// Force per length, or moment per radian; not negative.
    pub stiffness: f64,
}

/// What the forces of a preload on rigid arms add to the stiffness against rotation of the body that the arms belong to.
///
/// A force F at the tip of an arm r that turns by theta does the work F . (theta x (theta x r))/2 of second order, so that
/// it resists with the stiffness (F . r) I - (F r^T + r F^T)/2, force length, global.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmStiffness {
    /// Index of a point of the body.
    pub point: usize,
    /// Moment about each global axis per radian about each, symmetric; it need not be positive.
    pub stiffness: [[f64; 3]; 3],
}

/// A rigid connection of two points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RigidLink {
    /// Index of one point.
    pub from: usize,
    /// Index of the other.
    pub to: usize,
}

/// A rigid mass at a point. Statics does not use it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMass {
    /// Index of the point.
    pub point: usize,
    /// Mass, force time^2/length.
    pub mass: f64,
    /// Principal moments of inertia about the global axes through the centre of mass, force length time^2.
    pub inertia: [f64; 3],
    /// Global vector from the point to the centre of mass, length.
    pub offset: [f64; 3],
}

/// A frame in space: points, and what connects and supports them. Units are consistent; the crate knows none.
///
/// # Example
/// ```
/// use fea::{Member, Model, CrossSection, Support, point_compliance};
///
/// // A cantilever of 2 m along x; newtons and metres.
/// let section = CrossSection { e: 2.1e11, g: 8.1e10, area: 5e-3, iy: 2e-5, iz: 8e-5, j: 3e-7, ..CrossSection::default() };
/// let model = Model {
///     points: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
///     sections: vec![section],
///     members: vec![Member::beam([0, 1], 0, [0.0, 1.0, 0.0])],
///     supports: vec![Support { point: 0, fixed: [true; 6] }],
///     up: [0.0, 1.0, 0.0],
///     ..Model::default()
/// };
/// let (compliance, _) = point_compliance(&model, &[1])?;
/// let deflection = 2.0_f64.powi(3) / (3.0 * section.e * section.iz);
/// assert!((compliance[(1, 1)] / deflection - 1.0).abs() < 1e-12);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Global coordinates, length.
    pub points: Vec<[f64; 3]>,
    /// Cross sections.
    pub sections: Vec<CrossSection>,
    /// Members.
    pub members: Vec<Member>,
    /// Rigid supports.
    pub supports: Vec<Support>,
    /// Springs to ground; they add to the supports.
    pub springs: Vec<GroundSpring>,
    /// Rigid links.
    pub links: Vec<RigidLink>,
    /// Rigid masses; statics does not use them.
    pub masses: Vec<PointMass>,
    /// Stiffness of rigid arms under the forces of a preload; none without preload.
    pub arms: Vec<ArmStiffness>,
    /// The global direction up, any length. Only rails use it.
    pub up: [f64; 3],
    /// Beam theory of all members.
    pub theory: BeamTheory,
}

impl Model {
    /// Checks every number and index that needs no geometry.
    ///
    /// # Errors
    /// [`Error::Invalid`] with the first entry that cannot be used, and why.
    pub fn check(&self) -> Result<(), Error> {
        let at = |item: ModelEntry| move |fault: EntryFault| Error::Invalid { entry: item, fault };
        let known = |point: usize| {
            if point < self.points.len() {
                Ok(())
            } else {
                Err(EntryFault::NoPoint { point })
            }
        };
        finite(EntryAttribute::Coordinate, &self.up).map_err(at(ModelEntry::Up))?;
        for (k, point) in self.points.iter().enumerate() {
            finite(EntryAttribute::Coordinate, point).map_err(at(ModelEntry::Point(k)))?;
        }
        for (k, section) in self.sections.iter().enumerate() {
            section
                .check(self.theory)
                .map_err(at(ModelEntry::Section(k)))?;
        }
        for (k, member) in self.members.iter().enumerate() {
            self.check_member(member)
                .map_err(at(ModelEntry::Member(k)))?;
        }
        for (k, support) in self.supports.iter().enumerate() {
            known(support.point).map_err(at(ModelEntry::Support(k)))?;
        }
        for (k, spring) in self.springs.iter().enumerate() {
            known(spring.point)
                .and_then(|()| not_negative(EntryAttribute::Stiffness, spring.stiffness))
                .map_err(at(ModelEntry::Spring(k)))?;
        }
        for arm in &self.arms {
            let point = at(ModelEntry::Point(arm.point));
            known(arm.point).map_err(point)?;
            finite(EntryAttribute::Stiffness, arm.stiffness.as_flattened()).map_err(point)?;
        }
        for (k, link) in self.links.iter().enumerate() {
            known(link.from)
                .and_then(|()| known(link.to))
                .map_err(at(ModelEntry::Link(k)))?;
        }
        for (k, mass) in self.masses.iter().enumerate() {
            known(mass.point)
                .and_then(|()| not_negative(EntryAttribute::Mass, mass.mass))
                .and_then(|()| finite(EntryAttribute::Offset, &mass.offset))
                .and_then(|()| {
                    mass.inertia
                        .iter()
                        .try_for_each(|&i| not_negative(EntryAttribute::Inertia, i))
                })
                .map_err(at(ModelEntry::Mass(k)))?;
        }
        Ok(())
    }

    /// The model without preload.
    #[must_use]
    pub(crate) fn unloaded(&self) -> Model {
        let mut out = self.clone();
        out.members
            .iter_mut()
            .for_each(|member| member.tension = 0.0);
        out.arms.clear();
        out
    }

    /// Whether its stiffness is that about a loaded state.
    pub(crate) fn is_preloaded(&self) -> bool {
        !self.arms.is_empty() || self.members.iter().any(|member| member.tension != 0.0)
    }

    fn check_member(&self, member: &Member) -> Result<(), EntryFault> {
        for point in member.points {
            if point >= self.points.len() {
                return Err(EntryFault::NoPoint { point });
            }
        }
        if member.section >= self.sections.len() {
            return Err(EntryFault::NoSection {
                section: member.section,
            });
        }
        finite(EntryAttribute::Orientation, &member.orientation)?;
        finite(EntryAttribute::Tension, &[member.tension])?;
        let collapses = |area: Option<f64>| {
            let section = &self.sections[member.section];
            area.is_some_and(|area| {
                self.theory == BeamTheory::Timoshenko && -member.tension >= section.g * area
            })
        };
        let section = &self.sections[member.section];
        if member.kind == MemberKind::Beam
            && (collapses(section.shear_y) || collapses(section.shear_z))
        {
            return Err(EntryFault::ShearCollapse {
                tension: member.tension,
            });
        }
        member
            .offsets
            .iter()
            .try_for_each(|offset| finite(EntryAttribute::Offset, offset))
    }
}
