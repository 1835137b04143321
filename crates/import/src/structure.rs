//! Structure read from a model of any format, before it is written as a beam spec.

use formats::limits::MAGNITUDES;
use std::collections::{BTreeMap, BTreeSet};

use fea::MemberKind;
use formats::units::Units;

/// A point with its name in the file of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedPoint {
    /// Name in the file, such as `GRID 101`; empty if the file has none.
    pub name: String,
    /// Coordinates.
    pub at: [f64; 3],
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedMaterial {
    /// Its name.
    pub name: String,
    /// Young's modulus.
    pub e: f64,
    /// Shear modulus.
    pub g: Option<f64>,
    /// Mass per volume.
    pub density: Option<f64>,
}

/// A cross section; the local y and z axes are those of the beam spec.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImportedSection {
    /// Its name.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Area.
    pub area: Option<f64>,
    /// Second moment for bending in the local x-z plane.
    pub iy: Option<f64>,
    /// Second moment for bending in the local x-y plane.
    pub iz: Option<f64>,
    /// Torsion constant.
    pub j: Option<f64>,
    /// Effective shear area along y; `None` means rigid in shear.
    pub shear_y: Option<f64>,
    /// Effective shear area along z; `None` means rigid in shear.
    pub shear_z: Option<f64>,
    /// What its file states no value of, so that it has a placeholder here. Its members are released accordingly, and must
    /// not be loaded between their ends.
    pub missing: Vec<&'static str>,
}

/// A member.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedMember {
    /// Number of the element in its file.
    pub id: u64,
    /// Indices of its points.
    pub points: [usize; 2],
    /// Which deformations it resists.
    pub kind: MemberKind,
    /// Index of its section; for a tapered member, of the section at end a.
    pub section: usize,
    /// Index of the section at end b of a tapered member; `None` if the member is uniform.
    pub section_b: Option<usize>,
    /// Vector in the half plane of local x and +y; `None` means the upward direction.
    pub orientation: Option<[f64; 3]>,
    /// Rigid offsets from the points to the flexible ends, in global axes.
    pub offsets: [[f64; 3]; 2],
    /// Released local degrees of freedom at each end.
    pub releases: [[bool; 6]; 2],
}

/// Where the mass of members acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassDistribution {
    /// Half of it at each end, in translation.
    Lumped,
    /// That of rods and tubes at their ends, that of beams along them.
    LumpedRods,
    /// Evenly along them.
    Distributed,
}

/// A spring to ground.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedSpring {
    /// Index of the point.
    pub point: usize,
    /// Index of the global degree of freedom.
    pub dof: usize,
    /// Stiffness.
    pub k: f64,
}

/// A rigid mass.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedMass {
    /// Index of the point.
    pub point: usize,
    /// Mass.
    pub mass: f64,
    /// Moments of inertia about the centre of mass, in global axes.
    pub inertia: [f64; 3],
    /// Vector from the point to the centre of mass.
    pub offset: [f64; 3],
}

/// What the sums of masses and moments of inertia must be.
pub const MASS_RANGE: &str = "must be 0 or between 1e-30 and 1e30 in sum";

impl ImportedMass {
    /// A mass or moment of inertia that no spec can have ([`MAGNITUDES`]).
    #[must_use]
    pub fn beyond_magnitudes(&self) -> Option<f64> {
        let [least, most] = MAGNITUDES;
        let mut parts = std::iter::once(self.mass).chain(self.inertia);
        parts.find(|part| *part != 0.0 && !(least..=most).contains(&part.abs()))
    }
}

/// A rail along members.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedRail {
    /// Its name.
    pub name: String,
    /// Point at which its coordinate is 0.
    pub origin: [f64; 3],
    /// Direction of increasing coordinate.
    pub axis: [f64; 3],
    /// Indices of its members in the order of the request.
    pub members: Vec<usize>,
    /// Offset from the flexible axes of the members to the rail.
    pub offset: [f64; 3],
    /// Coordinates of its stations, increasing.
    pub stations: Vec<f64>,
}

/// Materials and sections in the words of a beam spec and in the units of the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenTables {
    /// `materials` of the spec.
    pub materials: serde_json::Value,
    /// `sections` of the spec.
    pub sections: serde_json::Value,
}

/// A structure with all data that a beam spec in the general form can describe.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedStructure {
    /// Its name.
    pub name: String,
    /// Units of all values.
    pub units: Units,
    /// Upward direction; `None` means +y.
    pub up: Option<[f64; 3]>,
    /// Points.
    pub points: Vec<ImportedPoint>,
    /// Materials.
    pub materials: Vec<ImportedMaterial>,
    /// Sections.
    pub sections: Vec<ImportedSection>,
    /// Materials and sections of a file of sections, which are written in place of the others.
    pub written: Option<WrittenTables>,
    /// Members.
    pub members: Vec<ImportedMember>,
    /// Restrained degrees of freedom of each supported point.
    pub supports: BTreeMap<usize, [bool; 6]>,
    /// Springs to ground.
    pub springs: Vec<ImportedSpring>,
    /// Rigid links between two points.
    pub links: Vec<[usize; 2]>,
    /// Masses.
    pub masses: Vec<ImportedMass>,
    /// Named sets of points.
    pub point_sets: Vec<(String, Vec<usize>)>,
    /// Named sets of members.
    pub cell_sets: Vec<(String, Vec<usize>)>,
    /// Rails.
    pub rails: Vec<ImportedRail>,
    /// Whether beams have their mass along them although that of the model is at their ends.
    pub moves_mass: bool,
}

impl ImportedStructure {
    /// Creates a structure that has a name and units only.
    #[must_use]
    pub fn empty(name: String, units: Units) -> ImportedStructure {
        ImportedStructure {
            name,
            units,
            up: None,
            points: Vec::new(),
            materials: Vec::new(),
            sections: Vec::new(),
            written: None,
            members: Vec::new(),
            supports: BTreeMap::new(),
            springs: Vec::new(),
            links: Vec::new(),
            masses: Vec::new(),
            point_sets: Vec::new(),
            cell_sets: Vec::new(),
            rails: Vec::new(),
            moves_mass: false,
        }
    }

    /// Whether a beam has mass along it.
    #[must_use]
    pub fn has_beams_with_mass(&self) -> bool {
        let has_mass = |name: &str| {
            let material = self.materials.iter().find(|known| known.name == name);
            material.is_some_and(|known| known.density.is_some())
        };
        let beams = self
            .members
            .iter()
            .filter(|member| member.kind == MemberKind::Beam);
        let sections: BTreeSet<usize> = beams.map(|member| member.section).collect();
        sections
            .into_iter()
            .any(|index| has_mass(&self.sections[index].material))
    }

    /// Coordinates of the flexible ends of a member: its points with their offsets.
    #[must_use]
    pub fn ends(&self, member: usize) -> [[f64; 3]; 2] {
        let member = &self.members[member];
        [0, 1].map(|end| {
            let at = self.points[member.points[end]].at;
            [0, 1, 2].map(|axis| at[axis] + member.offsets[end][axis])
        })
    }
}
