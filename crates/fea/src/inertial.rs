//! Effects of forces on the mass of a frame: of its inertia in motion, and of its weight.

use nalgebra::{DMatrix, SVector, Vector3};

use crate::assembly::reach;
use crate::effect::{Effect, Functional};
use crate::element::{Element, arm};
use crate::error::Error;
use crate::frame::Frame;
use crate::freedoms::Sum;
use crate::mass::{Cubic, bent, gyration, plain, shapes};
use crate::model::{Kind, Model};
use crate::modes::Mode;
use crate::section::{Section, Theory};

type Vector12 = SVector<f64, 12>;

/// Effects of the forces M a, for accelerations a of the whole structure.
///
/// What moves with a feels the opposite, -M a. So the weight under gravity g along -y has the effects -g `rigid` of
/// y, and a structure whose natural modes move with accelerations q'' under rail loads F has the effects
///
/// E = A F - `modes` q''
///
/// where forces of damping are internal: they hold the structure as its stiffness does.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertial {
    /// Effects x 6: a is a rigid motion with the supports, three translations along the global axes, three rotations
    /// about the global origin.
    pub rigid: DMatrix<f64>,
    /// Effects x modes: a is the shape of a mode.
    pub modes: DMatrix<f64>,
}

impl Frame {
    /// Effects of M a, M the consistent mass of members and the rigid masses, supports included. One solve an effect.
    ///
    /// `m`: the model that the frame was made of; `modes`: of the same frame.
    ///
    /// Guarantee: forces M a and reactions are in equilibrium, whatever the residuals of the modes, to the rounding of
    /// the factor: over the supports, reactions along a global axis add up to less [`Mode::coupling`] of it.
    ///
    /// # Errors
    /// An effect of a member or hold that does not exist, or a place outside 0..=1.
    ///
    /// # Source
    /// Mode acceleration: Cook, Malkus, Plesha and Witt, Concepts and Applications of Finite Element Analysis (2002),
    /// section 11.8; reciprocity as in [`Frame::influence_lines`].
    pub fn inertial(&self, m: &Model, effects: &[Effect], modes: &[Mode]) -> Result<Inertial, Error> {
        let functionals = self.functionals(m, effects)?;
        let rigid = self.fields(m, &[0, 1, 2, 3, 4, 5], |&k, body| whole(m, self, body, k));
        let shapes =
            self.fields(m, modes, |mode, body| mode.points[self.freedoms.bodies[body].reference].into());
        let mut out = Inertial {
            rigid: DMatrix::zeros(effects.len(), 6),
            modes: DMatrix::zeros(effects.len(), modes.len()),
        };
        for (e, functional) in functionals.iter().enumerate() {
            let motions = self.motions(&self.stiffened(&functional.strain));
            for (k, field) in rigid.iter().enumerate() {
                out.rigid[(e, k)] = self.effect_of(m, functional, &motions, field);
            }
            for (k, field) in shapes.iter().enumerate() {
                out.modes[(e, k)] = self.effect_of(m, functional, &motions, field);
            }
        }
        Ok(out)
    }

    /// Forces M a on the bodies, and the acceleration of the flexible ends of members, for each of `all`, which give
    /// the motions of the bodies' references.
    fn fields<T>(&self, m: &Model, all: &[T], motion: impl Fn(&T, usize) -> SVector<f64, 6>) -> Vec<Field> {
        let bodies = self.freedoms.bodies.len();
        let motions: Vec<Vec<SVector<f64, 6>>> =
            all.iter().map(|one| (0..bodies).map(|body| motion(one, body)).collect()).collect();
        let still = || Field {
            forces: vec![SVector::zeros(); bodies],
            ends: vec![Vector12::zeros(); self.elements.len()],
        };
        let mut fields: Vec<Field> = all.iter().map(|_| still()).collect();
        for (index, (element, member)) in self.elements.iter().zip(&m.members).enumerate() {
            let section = &m.sections[member.section];
            if section.mass == 0.0 {
                continue;
            }
            let pair = element.points.map(|point| self.freedoms.body[point]);
            let b = reach(element, &self.freedoms);
            let tips = shapes(element).map_or(b, |recovery| recovery * b);
            let mass = tips.transpose() * plain(element, section, m.theory, member.kind);
            for (field, motions) in fields.iter_mut().zip(&motions) {
                let both = Vector12::from_fn(|k, _| motions[pair[k / 6]][k % 6]);
                let local = tips * both;
                let load = mass * local;
                for (k, &body) in pair.iter().enumerate() {
                    field.forces[body] += load.fixed_rows::<6>(6 * k);
                }
                field.ends[index] = local;
            }
        }
        for mass in &m.masses {
            let body = self.freedoms.body[mass.point];
            let motion = self.freedoms.motion(mass.point, &Vector3::from(mass.offset));
            for (field, motions) in fields.iter_mut().zip(&motions) {
                let mut own = motion * motions[body];
                for k in 0..3 {
                    own[k] *= mass.mass;
                    own[k + 3] *= mass.inertia[k];
                }
                field.forces[body] += motion.transpose() * own;
            }
        }
        fields
    }

    fn effect_of(
        &self,
        m: &Model,
        functional: &Functional,
        motions: &[SVector<f64, 6>],
        field: &Field,
    ) -> f64 {
        let elastic: f64 = motions.iter().zip(&field.forces).map(|(u, f)| u.dot(f)).sum();
        let own = functional.section.as_ref().map_or(0.0, |section| {
            let (element, member) = (&self.elements[section.member], &m.members[section.member]);
            let pair = element.points.map(|point| self.freedoms.body[point]);
            let body = &m.sections[member.section];
            if pair[0] == pair[1] || body.mass == 0.0 {
                return 0.0;
            }
            let along = Along { element, section: body, theory: m.theory, kind: member.kind };
            let local = &field.ends[section.member];
            let held = plain(element, body, m.theory, member.kind) * local;
            let ends: f64 = section.ends.iter().zip(held.iter()).map(|(a, b)| a * b).sum();
            let to = section.place * element.length;
            ends + GAUSS
                .iter()
                .map(|[place, weight]| {
                    let z = 0.5 * to * (1.0 + place);
                    let load = along.force(local, z / element.length);
                    let balance = section.component.balance(to - z);
                    0.5 * to * weight * balance.iter().zip(load).map(|(a, b)| a * b).sum::<f64>()
                })
                .sum::<f64>()
        });
        elastic - on(&functional.direct, &field.forces) + own
    }
}

/// Places and weights on -1..1, exact to degree five.
const GAUSS: [[f64; 2]; 3] =
    [[-0.774_596_669_241_483_4, 5.0 / 9.0], [0.0, 8.0 / 9.0], [0.774_596_669_241_483_4, 5.0 / 9.0]];

/// Forces on the bodies' references, and local accelerations of the members' flexible ends.
struct Field {
    forces: Vec<SVector<f64, 6>>,
    ends: Vec<Vector12>,
}

/// Motion of a body's reference in rigid motion `k` of the whole.
fn whole(m: &Model, frame: &Frame, body: usize, k: usize) -> SVector<f64, 6> {
    let reference = m.points[frame.freedoms.bodies[body].reference];
    arm(&Vector3::from(reference)).column(k).into_owned()
}

fn on(sum: &Sum, forces: &[SVector<f64, 6>]) -> f64 {
    sum.terms.iter().map(|&(column, value)| value * forces[column / 6][column % 6]).sum()
}

/// Mass along a member.
struct Along<'a> {
    element: &'a Element,
    section: &'a Section,
    theory: Theory,
    kind: Kind,
}

impl Along<'_> {
    /// Force and moment per length, local, where the flexible ends have the accelerations `ends`: at the share `at` of
    /// the length.
    fn force(&self, ends: &Vector12, at: f64) -> [f64; 6] {
        let section = self.section;
        let linear = |k: usize| section.mass * ((1.0 - at) * ends[k] + at * ends[k + 6]);
        let value = |cubic: &Cubic| cubic.iter().rev().fold(0.0, |sum, c| sum * at + c);
        let mut out = [0.0; 6];
        out[0] = linear(0);
        if self.kind != Kind::Truss {
            out[3] = linear(3) * gyration(section, section.iy + section.iz);
        }
        let f = &self.element.flexibility;
        let planes = [
            (1, 5, 1.0, f.bending_z, f.shear_y, section.iz),
            (2, 4, -1.0, f.bending_y, f.shear_z, section.iy),
        ];
        for (v, turn, sign, bending, shear, second) in planes {
            if bending.is_infinite() {
                out[v] = linear(v);
                continue;
            }
            let length = self.element.length;
            let all = bent(12.0 * shear / (bending * length * length), length);
            let moved = [ends[v], sign * ends[turn], ends[v + 6], sign * ends[turn + 6]];
            let sum = |k: usize| -> f64 {
                let pick = |pair: &(Cubic, Cubic)| if k == 0 { value(&pair.0) } else { value(&pair.1) };
                all.iter().zip(moved).map(|(pair, moved)| pick(pair) * moved).sum()
            };
            out[v] = section.mass * sum(0);
            if self.theory == Theory::Timoshenko {
                out[turn] = sign * section.mass * gyration(section, second) * sum(1);
            }
        }
        out
    }
}
