//! Consistent mass of members and point masses, as the unknowns see it.

use nalgebra::{SMatrix, Vector3};
use sprs::{CsMat, TriMat};

use crate::assembly::{Assembly, Numbering, reach};
use crate::element::{Element, Matrix6, Matrix12, arm};
use crate::error::Error;
use crate::freedoms::Freedoms;
use crate::model::{Freedom, Kind, Model};
use crate::section::{Section, Theory};

/// Mass on a freedom that nothing stiffens, relative to what was added up, that is rounding alone.
const ROUNDING: f64 = 1e-24;

/// The mass of a frame: S M S of the unknowns, S the scale of the stiffness, and that of the whole.
#[derive(Debug)]
pub(crate) struct Mass {
    /// Upper triangle of S M S.
    pub upper: CsMat<f64>,
    /// S M r of the unknowns for six rigid motions r of the whole structure, supports included: three
    /// translations, three rotations about the global origin.
    pub rigid: [Vec<f64>; 6],
    /// r^T M r.
    pub total: Matrix6,
}

/// Mass of a member between the tips of its arms, local.
#[derive(Debug)]
struct Inertia {
    /// In directions that it resists, and of trusses in all.
    held: Matrix12,
    /// In directions that a beam does not resist.
    loose: Matrix12,
}

impl Mass {
    /// Assembles the mass in the order and scale of the stiffness.
    ///
    /// A freedom that nothing stiffens is left out where all its mass is that of beams without
    /// stiffness along it: such a model is plane, or straight, by intent.
    ///
    /// # Errors
    /// A freedom that nothing stiffens and that carries any other mass.
    pub fn new(
        m: &Model,
        elements: &[Element],
        freedoms: &Freedoms,
        assembly: &Assembly,
    ) -> Result<Mass, Error> {
        Sum::new(m, elements, freedoms, assembly).finish()
    }
}

/// Mass of a whole structure that moves as one with its supports: r^T M r for three translations along the global axes
/// and three rotations about the global origin, 6 x 6, symmetric; zeros where it has none.
///
/// # Errors
/// An entry of the model that cannot be used.
pub fn rigid_mass(m: &Model) -> Result<[[f64; 6]; 6], Error> {
    m.check()?;
    let elements: Vec<Element> =
        (0..m.members.len()).map(|index| Element::new(m, index)).collect::<Result<_, _>>()?;
    let freedoms = Freedoms::new(m);
    let assembly = Assembly::new(m, &elements, &freedoms);
    let total = Sum::new(m, &elements, &freedoms, &assembly).symmetric_total();
    Ok(std::array::from_fn(|i| std::array::from_fn(|j| total[(i, j)])))
}

struct Sum<'a> {
    freedoms: &'a Freedoms,
    assembly: &'a Assembly,
    triplets: TriMat<f64>,
    rigid: [Vec<f64>; 6],
    total: Matrix6,
    /// Of each column that nothing stiffens: its mass, and the magnitudes behind it.
    idle: Vec<[f64; 2]>,
}

impl<'a> Sum<'a> {
    fn new(m: &Model, elements: &[Element], freedoms: &'a Freedoms, assembly: &'a Assembly) -> Sum<'a> {
        let n = assembly.numbering.column.len();
        let mut sum = Sum {
            freedoms,
            assembly,
            triplets: TriMat::with_capacity((n, n), 78 * elements.len() + 21 * m.masses.len()),
            rigid: std::array::from_fn(|_| vec![0.0; n]),
            total: Matrix6::zeros(),
            idle: vec![[0.0; 2]; assembly.numbering.unknown.len()],
        };
        for (element, member) in elements.iter().zip(&m.members) {
            let section = &m.sections[member.section];
            if section.mass == 0.0 {
                continue;
            }
            let Inertia { held, loose } = inertia(element, section, m.theory, member.kind);
            let b = reach(element, freedoms);
            let bodies = element.points.map(|point| freedoms.body[point]);
            sum.add(m, bodies, &b, &held, &(held + loose));
        }
        for mass in &m.masses {
            let body = freedoms.body[mass.point];
            let mut own = Matrix12::zeros();
            for k in 0..3 {
                own[(k, k)] = mass.mass;
                own[(k + 3, k + 3)] = mass.inertia[k];
            }
            let mut b = Matrix12::zeros();
            let motion = freedoms.motion(mass.point, &Vector3::from(mass.offset));
            b.fixed_view_mut::<6, 6>(0, 0).copy_from(&motion);
            sum.add(m, [body, body], &b, &own, &own);
        }
        sum
    }

    fn symmetric_total(&self) -> Matrix6 {
        (self.total + self.total.transpose()) * 0.5
    }

    /// Adds the mass `all` of a part that moves by `b` with two bodies (or twice the same); `held` of it
    /// needs something that stiffens it.
    fn add(&mut self, m: &Model, bodies: [usize; 2], b: &Matrix12, held: &Matrix12, all: &Matrix12) {
        let mut basis = Matrix12::zeros();
        let mut whole = SMatrix::<f64, 12, 6>::zeros();
        for (k, &body) in bodies.iter().enumerate() {
            let body = &self.freedoms.bodies[body];
            basis.fixed_view_mut::<6, 6>(6 * k, 6 * k).copy_from(&body.basis);
            let reference = Vector3::from(m.points[body.reference]);
            whole.fixed_view_mut::<6, 6>(6 * k, 0).copy_from(&arm(&reference));
        }
        let whole = b * whole;
        let (own, size) = (b * basis, b.abs() * basis.abs());
        let mass = own.transpose() * all * own;
        let momentum = own.transpose() * all * whole;
        self.total += whole.transpose() * all * whole;
        let resisted = own.transpose() * held * own;
        let bulk = size.transpose() * held.abs() * size;
        let Numbering { unknown, scale, .. } = &self.assembly.numbering;
        let column = |i: usize| 6 * bodies[i / 6] + i % 6;
        for i in 0..12 {
            let Some(row) = unknown[column(i)] else {
                self.idle[column(i)][0] += resisted[(i, i)];
                self.idle[column(i)][1] += bulk[(i, i)];
                continue;
            };
            for (k, rigid) in self.rigid.iter_mut().enumerate() {
                rigid[row] += scale[row] * momentum[(i, k)];
            }
            for j in 0..12 {
                let value = 0.5 * (mass[(i, j)] + mass[(j, i)]);
                if let Some(other) = unknown[column(j)].filter(|&other| row <= other && value != 0.0) {
                    self.triplets.add_triplet(row, other, scale[row] * value * scale[other]);
                }
            }
        }
    }

    fn finish(self) -> Result<Mass, Error> {
        let total = self.symmetric_total();
        for (column, [own, bulk]) in self.idle.into_iter().enumerate() {
            let body = &self.freedoms.bodies[column / 6];
            if body.free[column % 6] && own > ROUNDING * bulk {
                let freedom = Freedom::ALL[column % 6];
                return Err(Error::Mechanism { point: body.reference, freedom });
            }
        }
        Ok(Mass { upper: self.triplets.to_csc(), rigid: self.rigid, total })
    }
}

/// Cubic in the fraction of the length: coefficient of each power.
pub(crate) type Cubic = [f64; 4];

/// Integral of a product over the unit length.
fn product(a: &Cubic, b: &Cubic) -> f64 {
    let mut sum = 0.0;
    for (p, x) in a.iter().enumerate() {
        for (q, y) in b.iter().enumerate() {
            sum += x * y / (p + q + 1) as f64;
        }
    }
    sum
}

/// M = integral of m N^T N + (m I / A) N'^T N' with the shapes N of the member without load.
///
/// Cubic in bending, with the part of shear under Timoshenko's theory, linear else. The rotation of
/// sections in bending has its inertia under Timoshenko's theory alone; that of twist, m (Iy + Iz) / A,
/// always. A released freedom moves as without load.
///
/// # Source
/// Archer (1965), AIAA J. 3; Przemieniecki, Theory of Matrix Structural Analysis (1968), section 11.4.
fn inertia(element: &Element, section: &Section, theory: Theory, kind: Kind) -> Inertia {
    let Inertia { mut held, mut loose } = unreleased(element, section, theory, kind);
    if let Some(shape) = shapes(element) {
        held = shape.transpose() * held * shape;
        loose = shape.transpose() * loose * shape;
    }
    Inertia { held, loose }
}

/// Mass of a member between its flexible ends, local, as if nothing were released.
pub(crate) fn plain(element: &Element, section: &Section, theory: Theory, kind: Kind) -> Matrix12 {
    let Inertia { held, loose } = unreleased(element, section, theory, kind);
    held + loose
}

/// Square of the radius of gyration of a second moment; 0 without area.
pub(crate) fn gyration(section: &Section, second: f64) -> f64 {
    if section.area > 0.0 { second / section.area } else { 0.0 }
}

/// Motion of the flexible ends by that of the tips of the arms; `None` where nothing is released.
pub(crate) fn shapes(element: &Element) -> Option<Matrix12> {
    let mut shape = element.released.as_ref()?.recovery;
    // A release where the section resists nothing changes nothing.
    for k in (0..12).filter(|&k| element.scale[k] == 0.0) {
        shape.row_mut(k).fill(0.0);
        shape[(k, k)] = 1.0;
    }
    Some(shape)
}

fn unreleased(element: &Element, section: &Section, theory: Theory, kind: Kind) -> Inertia {
    let (mass, length) = (section.mass, element.length);
    let gyration = |second: f64| gyration(section, second);
    let linear = [[1.0, -1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]];
    let mut held = Matrix12::zeros();
    let mut loose = Matrix12::zeros();
    let mut pair = |at: usize, density: f64, resists: bool| {
        let target = if resists { &mut held } else { &mut loose };
        for (i, a) in linear.iter().enumerate() {
            for (j, b) in linear.iter().enumerate() {
                target[(at + 6 * i, at + 6 * j)] += density * length * product(a, b);
            }
        }
    };
    let f = &element.flexibility;
    let truss = kind == Kind::Truss;
    pair(0, mass, truss || f.axial.is_finite());
    if !truss {
        pair(3, mass * gyration(section.iy + section.iz), f.torsion.is_finite());
    }
    let planes =
        [(1, 5, 1.0, f.bending_z, f.shear_y, section.iz), (2, 4, -1.0, f.bending_y, f.shear_z, section.iy)];
    for (v, ..) in planes.iter().filter(|plane| plane.3.is_infinite()) {
        pair(*v, mass, truss);
    }
    for (v, turn, sign, bending, shear, second) in planes {
        if bending.is_infinite() {
            continue;
        }
        let shapes = bent(12.0 * shear / (bending * length * length), length);
        let rotary = if theory == Theory::Timoshenko { mass * gyration(second) } else { 0.0 };
        let at = [(v, 1.0), (turn, sign), (v + 6, 1.0), (turn + 6, sign)];
        for (i, (a, turn_a)) in shapes.iter().enumerate() {
            for (j, (b, turn_b)) in shapes.iter().enumerate() {
                let value = mass * product(a, b) + rotary * product(turn_a, turn_b);
                held[(at[i].0, at[j].0)] += at[i].1 * at[j].1 * length * value;
            }
        }
    }
    Inertia { held, loose }
}

/// Deflection and rotation by v, theta of the first end, then of the last; p = 12 EI / (G As L^2).
pub(crate) fn bent(p: f64, length: f64) -> [(Cubic, Cubic); 4] {
    let (d, h) = (1.0 / (1.0 + p), length);
    let scaled = |factor: f64, cubic: Cubic| cubic.map(|x| factor * x);
    [
        (scaled(d, [1.0 + p, -p, -3.0, 2.0]), scaled(d / h, [0.0, -6.0, 6.0, 0.0])),
        (scaled(d * h, [0.0, 1.0 + 0.5 * p, -2.0 - 0.5 * p, 1.0]), scaled(d, [1.0 + p, -4.0 - p, 3.0, 0.0])),
        (scaled(d, [0.0, p, 3.0, -2.0]), scaled(d / h, [0.0, 6.0, -6.0, 0.0])),
        (scaled(d * h, [0.0, -0.5 * p, 0.5 * p - 1.0, 1.0]), scaled(d, [0.0, p - 2.0, 3.0, 0.0])),
    ]
}
