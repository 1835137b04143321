//! What can be wrong with a frame, by index; no error knows a model.

use std::fmt;

use crate::dof::Dof;

/// Errors of this crate. Entries are reported by index; the caller knows their names and files.
///
/// # Example
/// ```
/// use fea::{Error, Girder, ModelEntry};
///
/// let girder = Girder { spans: vec![60.0, -5.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
/// let Err(error) = girder.model_and_rail() else { panic!("a span is negative") };
/// assert!(matches!(error, Error::Invalid { entry: ModelEntry::Span(1), .. }));
/// assert_eq!(error.to_string(), "span 1: length must be positive, got -5");
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// An entry of the model or of a rail cannot be used.
    #[error("{entry}: {fault}")]
    Invalid {
        /// Which entry.
        entry: ModelEntry,
        /// What is wrong with it.
        fault: EntryFault,
    },
    /// The releases of one member let a part of it move without strain.
    #[error("releases of member {member} leave a mechanism in it: {dof} at its end {end}")]
    Released {
        /// Index of the member.
        member: usize,
        /// 0 at its first point, 1 at its second.
        end: usize,
        /// Local degree of freedom that has no stiffness left.
        dof: Dof,
    },
    /// The structure can move without strain.
    #[error("mechanism: point {point} is not restrained in {dof}")]
    Mechanism {
        /// Point that moves most, weighted by stiffness.
        point: usize,
        /// Degree of freedom of the point that moves most.
        dof: Dof,
    },
    /// The error bound that rounding allows is larger than the accuracy asked for.
    #[error(
        "condition {condition:.1e} bounds the error by {bound:.1e}, but {asked:.1e} is required; the least stiff degree of freedom is {dof} of point {point}"
    )]
    IllConditioned {
        /// Estimate of the condition number of the scaled stiffness.
        condition: f64,
        /// Relative error bound that can be given; infinite if there is none.
        bound: f64,
        /// Relative error bound asked for.
        asked: f64,
        /// Point that moves most in the weakest motion.
        point: usize,
        /// Degree of freedom of the point that moves most.
        dof: Dof,
    },
    /// The structure buckles at or below its preload.
    #[error("the structure buckles at {factor:.4} times its preload: {mode}")]
    Buckled {
        /// The critical factor, at most 1.
        factor: f64,
        /// The motion in which it buckles.
        mode: Buckling,
    },
    /// The axial forces of the preload have no equilibrium with small motions.
    #[error("{}", no_equilibrium(*member, *turned))]
    NoEquilibrium {
        /// The member that turns most, or has the largest axial force.
        member: usize,
        /// The angle by which it turns, radian; `None` where the forces do not settle.
        turned: Option<f64>,
    },
    /// The stiffness is not finite, or its factor exceeds the indices or the memory.
    #[error("the stiffness matrix of {unknowns} degrees of freedom cannot be factored")]
    NotFactorable {
        /// Number of unknown degrees of freedom.
        unknowns: usize,
    },
    /// More memory is needed than is allowed. Nothing has been allocated.
    #[error("the {quantity} would require {bytes} bytes, more than the limit of {most}")]
    Memory {
        /// What the memory is for.
        quantity: EntryAttribute,
        /// How much is needed.
        bytes: u64,
        /// How much is allowed.
        most: u64,
    },
    /// Modes were asked for, but the structure has no mass that can move.
    #[error("no free degree of freedom has mass")]
    NoMass,
    /// The modes could not all be found, or could not be shown to be the lowest.
    #[error("{found} of {asked} modes were found, but not shown to be the lowest")]
    Modes {
        /// How many were asked for.
        asked: usize,
        /// How many were found.
        found: usize,
    },
    /// All modes were asked for, of a frame with too many unknowns.
    #[error(
        "all modes of {unknowns} unknowns: complete sets of modes are limited to {most} unknowns"
    )]
    TooManyModes {
        /// Number of unknown degrees of freedom.
        unknowns: usize,
        /// Largest number allowed.
        most: usize,
    },
    /// All modes were asked for, of a mesh of too many elements.
    #[error("a mesh of {elements} elements: complete sets of modes are limited to {most} elements")]
    Elements {
        /// Number of elements.
        elements: usize,
        /// Largest number allowed.
        most: usize,
    },
    /// A rail was asked for, but none was given.
    #[error("no rail was given")]
    NoRails,
    /// A place or direction that the rails do not offer.
    #[error(transparent)]
    Rail(#[from] splines::Error),
}

fn no_equilibrium(member: usize, turned: Option<f64>) -> String {
    match turned {
        Some(angle) => format!(
            "under the preload member {member} rotates by {angle:.2} rad: specify the geometry of the loaded structure"
        ),
        None => format!(
            "the axial forces of the preload do not converge (largest in member {member}): specify the geometry of \
             the loaded structure"
        ),
    }
}

/// A motion in which a structure buckles, by what moves most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buckling {
    /// Point and degree of freedom that move most, weighted by stiffness.
    pub point: usize,
    /// See `point`.
    pub dof: Dof,
    /// The member whose axial force does most of the work.
    pub member: usize,
    /// Whether that member buckles between its ends, which stay at rest.
    pub between_ends: bool,
}

impl fmt::Display for Buckling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Buckling {
            point,
            dof,
            member,
            between_ends,
        } = self;
        if *between_ends {
            write!(f, "member {member} buckles between its ends")
        } else {
            write!(
                f,
                "point {point} moves in {dof}, due to the axial force of member {member}"
            )
        }
    }
}

/// An entry, by its index in the model's or rail's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelEntry {
    /// The global direction up.
    Up,
    /// A point.
    Point(usize),
    /// A section.
    Section(usize),
    /// A member.
    Member(usize),
    /// A support.
    Support(usize),
    /// A spring.
    Spring(usize),
    /// A link.
    Link(usize),
    /// A mass.
    Mass(usize),
    /// A span of a girder.
    Span(usize),
    /// An overhang of a girder: 0 before the first support, 1 after the last.
    Overhang(usize),
    /// A girder as a whole.
    Girder,
    /// A rail.
    Rail(usize),
    /// A segment of a rail.
    Segment {
        /// Which rail.
        rail: usize,
        /// Which of its segments.
        segment: usize,
    },
    /// An effect asked for, by its index in the list.
    Effect(usize),
    /// A preload as a whole.
    Preload,
    /// A force of a preload: those on points first, then those on rails.
    PreloadForce(usize),
    /// A station of a rail.
    Station {
        /// Which rail.
        rail: usize,
        /// Which of its stations.
        station: usize,
    },
}

/// What is wrong with an entry.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EntryFault {
    /// The number is infinite or not a number.
    #[error("{quantity} is not finite")]
    NotFinite {
        /// Which number of the entry.
        quantity: EntryAttribute,
    },
    /// The number must be positive.
    #[error("{quantity} must be positive, got {value}")]
    NotPositive {
        /// Which number of the entry.
        quantity: EntryAttribute,
        /// The value given.
        value: f64,
    },
    /// The number must not be negative.
    #[error("{quantity} must not be negative, got {value}")]
    Negative {
        /// Which number of the entry.
        quantity: EntryAttribute,
        /// The value given.
        value: f64,
    },
    /// A shear area without a shear modulus.
    #[error("a shear area needs a shear modulus")]
    NoShearModulus,
    /// A point that does not exist.
    #[error("point {point} does not exist")]
    NoPoint {
        /// The index given.
        point: usize,
    },
    /// A section that does not exist.
    #[error("section {section} does not exist")]
    NoSection {
        /// The index given.
        section: usize,
    },
    /// A member that does not exist.
    #[error("member {member} does not exist")]
    NoMember {
        /// The index given.
        member: usize,
    },
    /// A place that is not on the member.
    #[error("positions in a member are from 0 to 1, got {place}")]
    NoPlace {
        /// The place given.
        place: f64,
    },
    /// A degree of freedom of a point without a reaction of its own.
    #[error("point {point} has no reaction of its own in {dof}")]
    NoReaction {
        /// The point given.
        point: usize,
        /// The degree of freedom given.
        dof: Dof,
    },
    /// The flexible part of a member has no length.
    #[error("the flexible part has no length")]
    NoLength,
    /// An orientation that does not determine the local axes.
    #[error("the orientation is parallel to the member, or zero")]
    Orientation,
    /// An empty list.
    #[error("has no {quantity}")]
    Empty {
        /// Which list of the entry.
        quantity: EntryAttribute,
    },
    /// A rail axis without length, or along `up`.
    #[error("the axis is zero or parallel to up")]
    Axis,
    /// A segment whose member is at right angles to the rail.
    #[error("the member has no extent along the rail")]
    NoExtent,
    /// Two segments that cover the same stretch of rail.
    #[error("overlaps segment {segment} at x = {x}")]
    Overlap {
        /// The other segment.
        segment: usize,
        /// Where the overlap begins.
        x: f64,
    },
    /// A station that is not larger than the one before it.
    #[error("stations must increase, got {value}")]
    Unsorted {
        /// The station.
        value: f64,
    },
    /// A force on a degree of freedom that nothing holds.
    #[error("the structure is not restrained in {dof} there")]
    NotHeld {
        /// The degree of freedom.
        dof: Dof,
    },
    /// A cable that is not in tension under the preload.
    #[error("the cable is slack under the preload: its axial force is {tension}")]
    Slack {
        /// The axial force.
        tension: f64,
    },
    /// A cable that sags.
    #[error("the cable sags: (w L)^2 EA/(12 T^3) is {sag:.2e}, more than 0.01")]
    Sag {
        /// The measure of its sag.
        sag: f64,
    },
    /// Compression beyond the shear stiffness of a member.
    #[error("the axial force {tension} exceeds the shear stiffness")]
    ShearCollapse {
        /// The axial force.
        tension: f64,
    },
    /// A station that no segment covers.
    #[error("no segment covers x = {x}")]
    Uncovered {
        /// The station.
        x: f64,
    },
}

/// A number of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryAttribute {
    /// Coordinates of a point, an origin or a direction.
    Coordinate,
    /// Length.
    Length,
    /// Young's modulus.
    E,
    /// Shear modulus.
    G,
    /// Area.
    Area,
    /// Second moment of area about local y, lateral.
    Iy,
    /// Second moment of area about local z, vertical.
    Iz,
    /// Torsion constant.
    J,
    /// Shear area along local y, vertical.
    ShearY,
    /// Shear area along local z, lateral.
    ShearZ,
    /// Mass, or mass per length.
    Mass,
    /// Rotary inertia.
    Inertia,
    /// Offset.
    Offset,
    /// Orientation.
    Orientation,
    /// Stiffness of a spring.
    Stiffness,
    /// Axial force of a member.
    Tension,
    /// Force.
    Force,
    /// Spans.
    Spans,
    /// Segments.
    Segments,
    /// Station.
    Station,
    /// Cholesky factor.
    Factor,
    /// Influence coefficients of a list of probes.
    Grid,
    /// Compliance of the ends of all rail elements.
    Surface,
}

impl fmt::Display for ModelEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ModelEntry::Up => write!(f, "up"),
            ModelEntry::Point(k) => write!(f, "point {k}"),
            ModelEntry::Section(k) => write!(f, "section {k}"),
            ModelEntry::Member(k) => write!(f, "member {k}"),
            ModelEntry::Support(k) => write!(f, "support {k}"),
            ModelEntry::Spring(k) => write!(f, "spring {k}"),
            ModelEntry::Link(k) => write!(f, "link {k}"),
            ModelEntry::Mass(k) => write!(f, "mass {k}"),
            ModelEntry::Span(k) => write!(f, "span {k}"),
            ModelEntry::Overhang(k) => write!(f, "overhang {k}"),
            ModelEntry::Girder => write!(f, "girder"),
            ModelEntry::Rail(k) => write!(f, "rail {k}"),
            ModelEntry::Effect(k) => write!(f, "effect {k}"),
            ModelEntry::Preload => write!(f, "preload"),
            ModelEntry::PreloadForce(k) => write!(f, "force {k} of the preload"),
            ModelEntry::Segment { rail, segment } => write!(f, "segment {segment} of rail {rail}"),
            ModelEntry::Station { rail, station } => write!(f, "station {station} of rail {rail}"),
        }
    }
}

impl fmt::Display for EntryAttribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            EntryAttribute::Coordinate => "coordinate",
            EntryAttribute::Length => "length",
            EntryAttribute::E => "E",
            EntryAttribute::G => "G",
            EntryAttribute::Area => "area",
            EntryAttribute::Iy => "Iy",
            EntryAttribute::Iz => "Iz",
            EntryAttribute::J => "J",
            EntryAttribute::ShearY => "shear area along y",
            EntryAttribute::ShearZ => "shear area along z",
            EntryAttribute::Mass => "mass",
            EntryAttribute::Inertia => "inertia",
            EntryAttribute::Offset => "offset",
            EntryAttribute::Orientation => "orientation",
            EntryAttribute::Stiffness => "stiffness",
            EntryAttribute::Tension => "axial force",
            EntryAttribute::Force => "force",
            EntryAttribute::Spans => "spans",
            EntryAttribute::Segments => "segments",
            EntryAttribute::Station => "station",
            EntryAttribute::Factor => "factor",
            EntryAttribute::Grid => "grid",
            EntryAttribute::Surface => "surface",
        })
    }
}

/// Checks that all numbers are finite.
pub(crate) fn finite(quantity: EntryAttribute, values: &[f64]) -> Result<(), EntryFault> {
    if values.iter().all(|x| x.is_finite()) {
        Ok(())
    } else {
        Err(EntryFault::NotFinite { quantity })
    }
}

/// Checks that a number is finite and positive.
pub(crate) fn positive(quantity: EntryAttribute, value: f64) -> Result<(), EntryFault> {
    finite(quantity, &[value])?;
    if value > 0.0 {
        Ok(())
    } else {
        Err(EntryFault::NotPositive { quantity, value })
    }
}

/// Checks that a number is finite and not negative.
pub(crate) fn not_negative(quantity: EntryAttribute, value: f64) -> Result<(), EntryFault> {
    finite(quantity, &[value])?;
    if value >= 0.0 {
        Ok(())
    } else {
        Err(EntryFault::Negative { quantity, value })
    }
}
