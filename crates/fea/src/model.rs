//! A frame as given: points, members, what holds them.

use std::fmt;

use crate::error::{Error, Fault, Item, Quantity};
use crate::section::{Section, Theory, finite, not_negative};

/// One of the six freedoms of a point or of a member's end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Freedom {
    /// Displacement along x.
    Ux,
    /// Displacement along y.
    Uy,
    /// Displacement along z.
    Uz,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

impl Freedom {
    /// All six, in order.
    pub const ALL: [Freedom; 6] =
        [Freedom::Ux, Freedom::Uy, Freedom::Uz, Freedom::Rx, Freedom::Ry, Freedom::Rz];
}

impl fmt::Display for Freedom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["ux", "uy", "uz", "rx", "ry", "rz"][*self as usize])
    }
}

/// A set of freedoms: true at `Freedom as usize`.
pub type Freedoms6 = [bool; 6];

/// What a member resists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Everything its section resists.
    #[default]
    Beam,
    /// Its change of length alone; its ends turn nobody.
    Truss,
}

/// A uniform member between two points, with rigid arms and releases.
///
/// Local x runs from flexible end 0 to flexible end 1; local y is the part of `orientation` normal to
/// it; z = x cross y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member {
    /// Indices of its points.
    pub points: [usize; 2],
    /// What it resists.
    pub kind: Kind,
    /// Index of its section.
    pub section: usize,
    /// Any global vector in the half plane of local x and +y. A truss may do without.
    pub orientation: [f64; 3],
    /// Global vectors from the points to the ends of the flexible part, rigid.
    pub offsets: [[f64; 3]; 2],
    /// Local freedoms let go at each end, on the member's side of the arm.
    pub releases: [Freedoms6; 2],
}

impl Member {
    /// A beam between two points, flexible from one to the other, with nothing let go.
    #[must_use]
    pub const fn beam(points: [usize; 2], section: usize, orientation: [f64; 3]) -> Self {
        Member {
            points,
            kind: Kind::Beam,
            section,
            orientation,
            offsets: [[0.0; 3]; 2],
            releases: [[false; 6]; 2],
        }
    }
}

/// Global freedoms of a point that the ground holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Support {
    /// Index of the point.
    pub point: usize,
    /// Which freedoms.
    pub fix: Freedoms6,
}

/// A spring to ground, along or about a global axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Index of the point.
    pub point: usize,
    /// Which freedom.
    pub freedom: Freedom,
    /// Force per length, or moment per radian.
    pub stiffness: f64,
}

/// A rigid connection of two points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// Index of one point.
    pub from: usize,
    /// Index of the other.
    pub to: usize,
}

/// A rigid mass at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// Index of the point.
    pub point: usize,
    /// Mass, force time^2/length.
    pub mass: f64,
    /// Principal inertias about the global axes through the centre of mass.
    pub inertia: [f64; 3],
    /// Global vector from the point to the centre of mass.
    pub offset: [f64; 3],
}

/// A frame in space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Coordinates.
    pub points: Vec<[f64; 3]>,
    /// Cross sections.
    pub sections: Vec<Section>,
    /// Members.
    pub members: Vec<Member>,
    /// Rigid supports.
    pub supports: Vec<Support>,
    /// Springs to ground, added to the supports.
    pub springs: Vec<Spring>,
    /// Rigid links.
    pub links: Vec<Link>,
    /// Rigid masses; statics does not use them.
    pub masses: Vec<Mass>,
    /// The global direction up.
    pub up: [f64; 3],
    /// Beam theory of all members.
    pub theory: Theory,
}

impl Model {
    /// Checks every number and index that needs no geometry.
    ///
    /// # Errors
    /// The first entry that cannot be used, and why.
    pub fn check(&self) -> Result<(), Error> {
        let at = |item: Item| move |fault: Fault| Error::Invalid { item, fault };
        let known = |point: usize| {
            if point < self.points.len() { Ok(()) } else { Err(Fault::NoPoint { point }) }
        };
        finite(Quantity::Coordinate, &self.up).map_err(at(Item::Up))?;
        for (k, point) in self.points.iter().enumerate() {
            finite(Quantity::Coordinate, point).map_err(at(Item::Point(k)))?;
        }
        for (k, section) in self.sections.iter().enumerate() {
            section.check(self.theory).map_err(at(Item::Section(k)))?;
        }
        for (k, member) in self.members.iter().enumerate() {
            self.check_member(member).map_err(at(Item::Member(k)))?;
        }
        for (k, support) in self.supports.iter().enumerate() {
            known(support.point).map_err(at(Item::Support(k)))?;
        }
        for (k, spring) in self.springs.iter().enumerate() {
            known(spring.point)
                .and_then(|()| not_negative(Quantity::Stiffness, spring.stiffness))
                .map_err(at(Item::Spring(k)))?;
        }
        for (k, link) in self.links.iter().enumerate() {
            known(link.from).and_then(|()| known(link.to)).map_err(at(Item::Link(k)))?;
        }
        for (k, mass) in self.masses.iter().enumerate() {
            known(mass.point)
                .and_then(|()| not_negative(Quantity::Mass, mass.mass))
                .and_then(|()| finite(Quantity::Offset, &mass.offset))
                .and_then(|()| mass.inertia.iter().try_for_each(|&i| not_negative(Quantity::Inertia, i)))
                .map_err(at(Item::Mass(k)))?;
        }
        Ok(())
    }

    fn check_member(&self, member: &Member) -> Result<(), Fault> {
        for point in member.points {
            if point >= self.points.len() {
                return Err(Fault::NoPoint { point });
            }
        }
        if member.section >= self.sections.len() {
            return Err(Fault::NoSection { section: member.section });
        }
        finite(Quantity::Orientation, &member.orientation)?;
        member.offsets.iter().try_for_each(|offset| finite(Quantity::Offset, offset))
    }
}
