//! A structure as read from a model of any format, before it is written as a beam spec.

use std::collections::BTreeMap;

use formats::units::Units;

/// A point with the name that its file gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedPoint {
    /// Name in the file, such as `GRID 101`; empty where there is none.
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

/// A cross section; local y and z as in the beam spec.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImportedSection {
    /// Its name.
    pub name: String,
    /// Its material by name.
    pub material: String,
    /// Area.
    pub area: Option<f64>,
    /// Second moment for bending in the local x-z plane.
    pub iy: Option<f64>,
    /// Second moment for bending in the local x-y plane.
    pub iz: Option<f64>,
    /// Torsion constant.
    pub j: Option<f64>,
    /// Effective shear area along y; absent = rigid in shear.
    pub shear_y: Option<f64>,
    /// Effective shear area along z; absent = rigid in shear.
    pub shear_z: Option<f64>,
}

/// A member.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedMember {
    /// Number of the element in its file.
    pub id: u64,
    /// Indices of its points.
    pub points: [usize; 2],
    /// Whether it has axial stiffness only.
    pub truss: bool,
    /// Index of its section; of a tapered member that at end a.
    pub section: usize,
    /// Index of the section at end b of a tapered member.
    pub section_b: Option<usize>,
    /// Any vector in the half plane of local x and +y; absent = up.
    pub orientation: Option<[f64; 3]>,
    /// Global vectors from the points to the flexible ends.
    pub offsets: [[f64; 3]; 2],
    /// Released local degrees of freedom at each end.
    pub releases: [[bool; 6]; 2],
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
    /// Inertias about the global axes through the centre of mass.
    pub inertia: [f64; 3],
    /// From the point to the centre of mass.
    pub offset: [f64; 3],
}

/// A rail along members.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedRail {
    /// Its name.
    pub name: String,
    /// Where its coordinate is 0.
    pub origin: [f64; 3],
    /// Direction of increasing coordinate.
    pub axis: [f64; 3],
    /// Members in the order given.
    pub members: Vec<usize>,
    /// From the members' flexible axes to the rail.
    pub offset: [f64; 3],
    /// Increasing coordinates.
    pub stations: Vec<f64>,
}

/// Everything that a beam spec in the general form can describe.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedStructure {
    /// Its name.
    pub name: String,
    /// Units of all numbers.
    pub units: Units,
    /// Direction up; absent = +y.
    pub up: Option<[f64; 3]>,
    /// Points.
    pub points: Vec<ImportedPoint>,
    /// Materials.
    pub materials: Vec<ImportedMaterial>,
    /// Sections.
    pub sections: Vec<ImportedSection>,
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
}

impl ImportedStructure {
    /// A structure with a name and units, and nothing else.
    #[must_use]
    pub fn empty(name: String, units: Units) -> ImportedStructure {
        ImportedStructure {
            name,
            units,
            up: None,
            points: Vec::new(),
            materials: Vec::new(),
            sections: Vec::new(),
            members: Vec::new(),
            supports: BTreeMap::new(),
            springs: Vec::new(),
            links: Vec::new(),
            masses: Vec::new(),
            point_sets: Vec::new(),
            cell_sets: Vec::new(),
            rails: Vec::new(),
        }
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
