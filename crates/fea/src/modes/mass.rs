//! Consistent mass of members and rigid masses, over the unknowns of the stiffness.

use nalgebra::{SMatrix, Vector3};
use sprs::{CsMat, TriMat};

use crate::assembly::{
    BendingPlane, Bodies, Element, Matrix6, Matrix12, Numbering, ScaledStiffness, arm,
    bending_planes, transformation,
};
use crate::dof::Dof;
use crate::error::Error;
use crate::model::{BeamTheory, CrossSection, MemberKind, Model, PointMass};
use crate::modes::interior::{InteriorMotion, end_degrees};
use crate::modes::shapes::{bending_shapes, integral_of_product, polynomial};

/// Mass of a degree of freedom that nothing stiffens, relative to what was added up, that is only rounding.
const ROUNDING: f64 = 1e-24;

/// The mass of a frame: S M S of the coordinates, and that of the whole.
///
/// The coordinates are the amplitudes of the interior motions, each scaled to twice the strain energy one, then the
/// unknowns of the stiffness, scaled by S as there.
#[derive(Debug)]
pub(crate) struct ScaledMass {
    /// The interior motions of members.
    pub(super) interior: Vec<InteriorMotion>,
    /// Upper triangle of S M S.
    pub upper: CsMat<f64>,
    /// S M r of the coordinates for six rigid motions r of the whole structure, supports included: three
    /// translations along the global axes, three rotations about the global origin.
    pub rigid: [Vec<f64>; 6],
    /// r^T M r.
    pub total: Matrix6,
}

/// Mass of a member between the tips of its rigid offsets, local axes.
#[derive(Debug)]
struct MemberMass {
    /// In the directions that the member resists; that of a truss or rod in all directions.
    resisted: Matrix12,
    /// In the directions that a beam does not resist.
    unresisted: Matrix12,
}

impl ScaledMass {
    /// Assembles the mass in the order and scale of the stiffness.
    ///
    /// A degree of freedom that nothing stiffens is left out if all its mass is that of beams without
    /// stiffness along it: such a model is plane, or straight, by intent.
    ///
    /// # Errors
    /// [`Error::Mechanism`] for a degree of freedom that nothing stiffens and that has any other mass.
    pub fn new(
        m: &Model,
        elements: &[Element],
        bodies: &Bodies,
        stiffness: &ScaledStiffness,
    ) -> Result<ScaledMass, Error> {
        MassSum::new(m, elements, bodies, &stiffness.numbering).finish()
    }
}

/// Mass of a whole structure that moves as one with its supports: r^T M r, 6 x 6, symmetric, for three
/// translations along the global axes and three rotations about the global origin.
///
/// # Errors
/// [`Error::Invalid`] for an entry of the model that cannot be used.
pub fn rigid_mass(m: &Model) -> Result<[[f64; 6]; 6], Error> {
    m.check()?;
    let elements = Element::all(m)?;
    let mut bodies = Bodies::new(m);
    let stiffness = ScaledStiffness::new(m, &elements, &mut bodies)?;
    Ok(rows(
        &MassSum::new(m, &elements, &bodies, &stiffness.numbering).symmetric_total(),
    ))
}

/// A 6 x 6 matrix by rows.
pub(super) fn rows(matrix: &Matrix6) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

struct MassSum<'a> {
    bodies: &'a Bodies,
    numbering: &'a Numbering,
    triplets: TriMat<f64>,
    rigid: [Vec<f64>; 6],
    total: Matrix6,
    /// For each column that nothing stiffens: its mass, and the magnitudes behind it.
    unstiffened: Vec<[f64; 2]>,
    interior: Vec<InteriorMotion>,
}

impl<'a> MassSum<'a> {
    fn new(
        m: &Model,
        elements: &[Element],
        bodies: &'a Bodies,
        numbering: &'a Numbering,
    ) -> MassSum<'a> {
        let interior = InteriorMotion::all(m, elements, bodies);
        let n = interior.len() + numbering.column.len();
        let mut sum = MassSum {
            bodies,
            numbering,
            triplets: TriMat::with_capacity((n, n), 90 * elements.len() + 21 * m.masses.len()),
            rigid: std::array::from_fn(|_| vec![0.0; n]),
            total: Matrix6::zeros(),
            unstiffened: vec![[0.0; 2]; numbering.unknown.len()],
            interior,
        };
        for (element, member) in elements.iter().zip(&m.members) {
            let section = &m.sections[member.section];
            if section.mass == 0.0 {
                continue;
            }
            let MemberMass {
                resisted,
                unresisted,
            } = mass_between_tips(element, section, m.theory, member.kind);
            let b = transformation(element, bodies);
            sum.add(
                m,
                bodies.pair(element.points),
                &b,
                &resisted,
                &(resisted + unresisted),
            );
        }
        m.masses.iter().for_each(|mass| sum.add_rigid(m, mass));
        (0..sum.interior.len()).for_each(|index| sum.add_interior(m, elements, index));
        sum
    }

    /// Adds the mass of an interior motion and what couples it with the ends of its member.
    fn add_interior(&mut self, m: &Model, elements: &[Element], index: usize) {
        let motion = &self.interior[index];
        let element = &elements[motion.member];
        let load = motion.unit_load();
        self.triplets
            .add_triplet(index, index, load * load * motion.mass);
        let b = transformation(element, self.bodies);
        let ends = release_shapes(element).map_or(b, |shape| shape * b);
        let row = ends.transpose() * motion.coupling * load;
        let first = self.interior.len();
        for (end, body) in self.bodies.pair(element.points).into_iter().enumerate() {
            let own = row.fixed_rows::<6>(6 * end);
            let moved = self.bodies.list[body].basis.transpose() * own;
            let reference = Vector3::from(m.points[self.bodies.list[body].reference]);
            let whole = arm(&reference).transpose() * own;
            self.rigid
                .iter_mut()
                .zip(&whole)
                .for_each(|(rigid, &part)| rigid[index] += part);
            for (k, &value) in moved.iter().enumerate().filter(|(_, value)| **value != 0.0) {
                if let Some(unknown) = self.numbering.unknown[6 * body + k] {
                    let scale = self.numbering.scale[unknown];
                    self.triplets
                        .add_triplet(index, first + unknown, scale * value);
                }
            }
        }
    }

    fn add_rigid(&mut self, m: &Model, mass: &PointMass) {
        let body = self.bodies.of_point[mass.point];
        let mut own = Matrix12::zeros();
        for k in 0..3 {
            own[(k, k)] = mass.mass;
            own[(k + 3, k + 3)] = mass.inertia[k];
        }
        let mut b = Matrix12::zeros();
        let motion = self.bodies.motion(mass.point, &Vector3::from(mass.offset));
        b.fixed_view_mut::<6, 6>(0, 0).copy_from(&motion);
        self.add(m, [body, body], &b, &own, &own);
    }

    fn symmetric_total(&self) -> Matrix6 {
        (self.total + self.total.transpose()) * 0.5
    }

    /// Adds the mass `all` of a part that moves by `b` with two bodies (or twice the same one); the part
    /// `resisted` of it needs something that stiffens it.
    fn add(
        &mut self,
        m: &Model,
        pair: [usize; 2],
        b: &Matrix12,
        resisted: &Matrix12,
        all: &Matrix12,
    ) {
        let mut basis = Matrix12::zeros();
        let mut whole = SMatrix::<f64, 12, 6>::zeros();
        for (k, &body) in pair.iter().enumerate() {
            let body = &self.bodies.list[body];
            basis
                .fixed_view_mut::<6, 6>(6 * k, 6 * k)
                .copy_from(&body.basis);
            let reference = Vector3::from(m.points[body.reference]);
            whole
                .fixed_view_mut::<6, 6>(6 * k, 0)
                .copy_from(&arm(&reference));
        }
        let whole = b * whole;
        // Magnitudes show whether a mass that should be zero is only rounding.
        let (own, size) = (b * basis, b.abs() * basis.abs());
        let mass = own.transpose() * all * own;
        let momentum = own.transpose() * all * whole;
        self.total += whole.transpose() * all * whole;
        let resisted_mass = own.transpose() * resisted * own;
        let bulk = size.transpose() * resisted.abs() * size;
        let Numbering { unknown, scale, .. } = self.numbering;
        let column = |i: usize| 6 * pair[i / 6] + i % 6;
        for i in 0..12 {
            let Some(row) = unknown[column(i)] else {
                self.unstiffened[column(i)][0] += resisted_mass[(i, i)];
                self.unstiffened[column(i)][1] += bulk[(i, i)];
                continue;
            };
            let first = self.interior.len();
            for (k, rigid) in self.rigid.iter_mut().enumerate() {
                rigid[first + row] += scale[row] * momentum[(i, k)];
            }
            for j in 0..12 {
                let value = 0.5 * (mass[(i, j)] + mass[(j, i)]);
                if let Some(other) =
                    unknown[column(j)].filter(|&other| row <= other && value != 0.0)
                {
                    let value = scale[row] * value * scale[other];
                    self.triplets.add_triplet(first + row, first + other, value);
                }
            }
        }
    }

    fn finish(self) -> Result<ScaledMass, Error> {
        let total = self.symmetric_total();
        for (column, &[own, bulk]) in self.unstiffened.iter().enumerate() {
            let body = &self.bodies.list[column / 6];
            if body.free[column % 6] && own > ROUNDING * bulk {
                let freedom = Dof::ALL[column % 6];
                return Err(Error::Mechanism {
                    point: body.reference,
                    dof: freedom,
                });
            }
        }
        let MassSum {
            interior,
            triplets,
            rigid,
            ..
        } = self;
        Ok(ScaledMass {
            interior,
            upper: triplets.to_csc(),
            rigid,
            total,
        })
    }
}

/// Consistent mass between the tips of the rigid offsets, releases included:
///
/// M = integral of m N^T N + (m I / A) N'^T N' with the shapes N of the member without load.
///
/// The shapes are cubic in bending, with the part of shear under Timoshenko's theory, or bent by the axial force of the
/// member, and linear otherwise.
/// The rotation of sections in bending has inertia under Timoshenko's theory alone; that of twist,
/// m (Iy + Iz) / A, always, but for rods, which have none. A released degree of freedom moves as without load.
///
/// # Source
/// Archer (1965), AIAA J. 3; Przemieniecki, Theory of Matrix Structural Analysis (1968), section 11.4.
fn mass_between_tips(
    element: &Element,
    section: &CrossSection,
    theory: BeamTheory,
    kind: MemberKind,
) -> MemberMass {
    let planes = bending_planes(&element.flexibility);
    let MemberMass {
        mut resisted,
        mut unresisted,
    } = member_mass(element, section, theory, kind, &planes);
    if let Some(shape) = release_shapes(element) {
        resisted = shape.transpose() * resisted * shape;
        unresisted = shape.transpose() * unresisted * shape;
    }
    MemberMass {
        resisted,
        unresisted,
    }
}

/// Consistent mass between the flexible ends of a member, local axes, without its releases. `planes` are its planes of
/// bending, with the axial force that bends the shapes.
pub(super) fn unreleased_mass(
    element: &Element,
    section: &CrossSection,
    theory: BeamTheory,
    kind: MemberKind,
    planes: &[BendingPlane; 2],
) -> Matrix12 {
    let MemberMass {
        resisted,
        unresisted,
    } = member_mass(element, section, theory, kind, planes);
    resisted + unresisted
}

/// Motion of the flexible ends by that of the tips of the rigid offsets; `None` without releases.
pub(super) fn release_shapes(element: &Element) -> Option<Matrix12> {
    let mut shape = element.released.as_ref()?.recovery;
    // A release where the section has no stiffness changes nothing.
    let stiffness = element.unreleased_stiffness();
    for k in (0..12).filter(|&k| stiffness[(k, k)] == 0.0) {
        shape.row_mut(k).fill(0.0);
        shape[(k, k)] = 1.0;
    }
    Some(shape)
}

fn member_mass(
    element: &Element,
    section: &CrossSection,
    theory: BeamTheory,
    kind: MemberKind,
    planes: &[BendingPlane; 2],
) -> MemberMass {
    let (mass, length) = (section.mass, element.length);
    let mut out = MemberMass {
        resisted: Matrix12::zeros(),
        unresisted: Matrix12::zeros(),
    };
    let f = &element.flexibility;
    let straight = kind != MemberKind::Beam;
    out.add_linear(0, mass, length, straight || f.axial.is_finite());
    if !straight {
        let polar = section.gyration_squared(section.iy + section.iz);
        out.add_linear(3, mass * polar, length, f.torsion.is_finite());
    }
    for plane in planes.iter().filter(|plane| plane.bending.is_infinite()) {
        out.add_linear(plane.deflection, mass, length, straight);
    }
    for (plane, second) in planes.iter().zip([section.iz, section.iy]) {
        if plane.bending.is_infinite() {
            continue;
        }
        let rotary = if theory == BeamTheory::Timoshenko {
            mass * section.gyration_squared(second)
        } else {
            0.0
        };
        out.add_bending(plane, mass, rotary, length);
    }
    out
}

impl MemberMass {
    /// Adds `density` moving along straight lines between the ends, in degree of freedom `at`.
    fn add_linear(&mut self, at: usize, density: f64, length: f64, resists: bool) {
        let shapes = [polynomial(&[1.0, -1.0]), polynomial(&[0.0, 1.0])];
        let target = if resists {
            &mut self.resisted
        } else {
            &mut self.unresisted
        };
        for (i, a) in shapes.iter().enumerate() {
            for (j, b) in shapes.iter().enumerate() {
                target[(at + 6 * i, at + 6 * j)] += density * length * integral_of_product(a, b);
            }
        }
    }

    /// Adds bending in one plane: `mass` per length moves with the deflection, `rotary` with the rotation.
    fn add_bending(&mut self, plane: &BendingPlane, mass: f64, rotary: f64, length: f64) {
        let shapes = bending_shapes(plane, length);
        let at = end_degrees(plane);
        for (i, [a, turn_a]) in shapes.iter().enumerate() {
            for (j, [b, turn_b]) in shapes.iter().enumerate() {
                let value =
                    mass * integral_of_product(a, b) + rotary * integral_of_product(turn_a, turn_b);
                self.resisted[(at[i].0, at[j].0)] += at[i].1 * at[j].1 * length * value;
            }
        }
    }
}
