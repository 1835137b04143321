//! Potential energy of a frame under dead loads, and its minimum as the loads grow.

use nalgebra::{Const, SVector, U1, Vector3};
use num_dual::{DualNum, DualSVec64};
use sprs::CsMat;

use super::member::{EndForces, MovingMember};
use super::turn::{Turn, Vec3, along, constant, cross, difference, sum};
use crate::assembly::{BlockSums, Element, Matrix6, Real};
use crate::factor::Factor;
use crate::influence::FactoredFrame;
use crate::model::{MemberKind, Model};
use crate::preload::{ArmForce, BodyLoads};

/// Steps of Newton's method for one load.
const MOST_STEPS: usize = 20;
/// Work of a step, relative to that of the loads, at which the equilibrium is found: displacements are right to about its root.
const SETTLED: f64 = 1e-14;
/// Displacement by the size of the frame whose work counts as none.
const UNMOVED: f64 = 1e-9;
/// Displacements behind the first step of Newton's method, relative to those of this step, beyond which the loads grow too fast:
/// the equilibrium may be one to which the frame snaps through.
const FARTHER: f64 = 1.0;
/// Smallest part of the loads by which they grow.
const LEAST_GROWTH: f64 = 1.0 / 256.0;
/// Largest work of a step with the stiffness of the linear frame, relative to that of the one before, for displacements to count
/// as small: the steps shrink by the root of it.
const QUICK: f64 = 0.04;
/// Rotation of one step, radian, beyond which the loads grow too fast.
const LARGEST_TURN: f64 = 0.5;

/// A frame whose members turn with it.
///
/// State: the scaled unknowns x of a linear frame, by which the displacements and rotation vectors of its bodies are linear
/// functions. The potential energy is that of the members ([`MovingMember`]) and of the springs to ground, less the work of the
/// loads. A force F at the tip of a rigid arm r keeps its direction: it does the work F . (u + R r - r). One on a rail also keeps
/// its place along the rail, as a wheel does that the rail turns under: of the turn of its arm only the part about the rail counts.
///
/// Supports hold the motions that they hold in the linear frame: where they act on an arm of a rigid body, its rotation counts to
/// first order.
pub(super) struct MovingFrame<'a> {
    frame: &'a FactoredFrame,
    members: Vec<Option<MovingMember>>,
    springs: Vec<GroundSpring>,
    /// Largest distance of a point from the first one along an axis.
    size: f64,
}

/// A spring to ground.
struct GroundSpring {
    body: usize,
    /// From the reference of the body to the spring.
    arm: [f64; 3],
    /// Degree of freedom, 0 to 5.
    dof: usize,
    stiffness: f64,
}

/// The path of equilibria ends: no stable equilibrium was found beyond this part of the loads.
pub(super) struct Lost {
    pub part: f64,
}

/// Loads by the scaled unknowns, and their arms.
pub(super) struct DeadLoads {
    by_unknown: Vec<f64>,
    on_arms: Vec<ArmForce>,
}

impl DeadLoads {
    pub fn new(frame: &FactoredFrame, loads: &BodyLoads) -> DeadLoads {
        let mut by_unknown = vec![0.0; frame.unknowns()];
        loads
            .load
            .iter()
            .for_each(|&(k, value)| by_unknown[k] += value);
        DeadLoads {
            by_unknown,
            on_arms: loads.on_arms.clone(),
        }
    }

    /// The loads whose arms turn with their bodies.
    fn turning(&self) -> impl Iterator<Item = &ArmForce> {
        let none = Vector3::zeros();
        self.on_arms
            .iter()
            .filter(move |own| own.arm != none && own.force != none)
    }

    /// `self` + `part` of `other`.
    pub fn plus(&self, part: f64, other: &DeadLoads) -> DeadLoads {
        let by_unknown = self.by_unknown.iter().zip(&other.by_unknown);
        let grown = other.on_arms.iter().map(|own| ArmForce {
            force: own.force * part,
            ..*own
        });
        DeadLoads {
            by_unknown: by_unknown.map(|(a, b)| a + part * b).collect(),
            on_arms: self.on_arms.iter().copied().chain(grown).collect(),
        }
    }
}

impl<'a> MovingFrame<'a> {
    /// `m` is the model that the frame was made of, without axial forces of a preload, as its `elements` are.
    pub fn new(m: &Model, frame: &'a FactoredFrame, elements: &[Element]) -> MovingFrame<'a> {
        let bodies = &frame.bodies;
        let arm = |point: usize| bodies.arms[point].map(Real::double);
        let members = m.members.iter().zip(elements).map(|(member, element)| {
            let pair = bodies.pair(member.points);
            let arms = [0, 1].map(|end| arm(member.points[end]) + element.offsets[end]);
            let is_cable = member.kind == MemberKind::Cable;
            (pair[0] != pair[1]).then(|| MovingMember::new(element, pair, arms, is_cable))
        });
        let springs = m.springs.iter().map(|spring| GroundSpring {
            body: bodies.of_point[spring.point],
            arm: arm(spring.point).into(),
            dof: spring.dof as usize,
            stiffness: spring.stiffness,
        });
        MovingFrame {
            frame,
            members: members.collect(),
            springs: springs.collect(),
            size: m.points.iter().fold(0.0, |most, point| {
                (0..3).fold(most, |most: f64, k| {
                    most.max((point[k] - m.points[0][k]).abs())
                })
            }),
        }
    }

    /// The equilibrium under `loads` alone; `None` where none is found.
    ///
    /// Hangers resist nothing before they are loaded. Where the loads cannot grow from nothing, the search begins at the linear
    /// state, which is near the equilibrium.
    pub fn standing(&self, loads: &DeadLoads) -> Option<Vec<f64>> {
        let rest = vec![0.0; self.frame.unknowns()];
        if loads.by_unknown.iter().all(|load| *load == 0.0) {
            return Some(rest);
        }
        let nothing = DeadLoads {
            by_unknown: rest.clone(),
            on_arms: Vec::new(),
        };
        self.follow(rest, &nothing, loads).ok().or_else(|| {
            let mut near = loads.by_unknown.clone();
            self.frame.solver().solve(&mut near);
            self.equilibrium(&near, loads)
        })
    }

    /// The equilibrium under `base` and `more`, from the one under `base` at `x`, as `more` grows from nothing to all of it.
    ///
    /// Where no equilibrium is found for a load, the load grows by half as much.
    pub fn follow(
        &self,
        mut x: Vec<f64>,
        base: &DeadLoads,
        more: &DeadLoads,
    ) -> Result<Vec<f64>, Lost> {
        let (mut reached, mut growth) = (0.0_f64, 1.0_f64);
        while reached < 1.0 {
            let part = (reached + growth).min(1.0);
            match self.equilibrium(&x, &base.plus(part, more)) {
                Some(found) => {
                    (x, reached) = (found, part);
                    growth *= 2.0;
                }
                None if growth > LEAST_GROWTH => growth *= 0.5,
                None => return Err(Lost { part: reached }),
            }
        }
        Ok(x)
    }

    /// The minimum of the potential energy near `start`; `None` where none is found.
    ///
    /// Where displacements are small, steps with the stiffness of the linear frame find it, whose factors are known; the second
    /// derivatives at their end tell whether it is a minimum. Elsewhere Newton's method does.
    pub fn equilibrium(&self, start: &[f64], loads: &DeadLoads) -> Option<Vec<f64>> {
        let near = self.by_linear_stiffness(start, loads);
        let is_stable = |x: &Vec<f64>| Factor::new(&self.stiffness(x, loads)).is_ok();
        near.filter(is_stable)
            .or_else(|| self.by_newton(start, loads))
    }

    /// The equilibrium near `start` by steps with the stiffness of the linear frame, if their work falls quickly.
    fn by_linear_stiffness(&self, start: &[f64], loads: &DeadLoads) -> Option<Vec<f64>> {
        let mut x = start.to_vec();
        let mut before = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let solve = |change: &mut [f64]| self.frame.solver().solve(change);
            let (change, work) = self.step(&x, loads, &solve);
            let is_small = self.largest_turn(&change) <= LARGEST_TURN;
            if !(work <= QUICK * before && is_small) {
                return None;
            }
            add(&mut x, &change);
            if self.is_settled(work, &x, loads) {
                return Some(x);
            }
            before = work;
        }
        None
    }

    /// The minimum near `start` by Newton's method; `None` where it does not find one.
    fn by_newton(&self, start: &[f64], loads: &DeadLoads) -> Option<Vec<f64>> {
        let mut x = start.to_vec();
        let mut before = f64::INFINITY;
        let (mut first, mut farther) = (0.0_f64, 0.0_f64);
        for step in 0..MOST_STEPS {
            let factor = Factor::new(&self.stiffness(&x, loads)).ok()?;
            let (change, work) = self.step(&x, loads, &|change| factor.solve(change));
            if !work.is_finite() || self.largest_turn(&change) > LARGEST_TURN {
                return None;
            }
            let moved = self.largest_displacement(&change);
            if step == 0 {
                first = moved;
            } else {
                farther += moved;
                if farther > FARTHER * first {
                    return None;
                }
            }
            add(&mut x, &change);
            if self.is_settled(work, &x, loads) {
                return Some(x);
            }
            // Far from the answer a step may do more work than the one before it, but not for long.
            if step > 3 && work > before {
                return None;
            }
            before = work;
        }
        None
    }

    /// The step from `x` with a stiffness that `solve` divides by, and its work.
    fn step(&self, x: &[f64], loads: &DeadLoads, solve: &dyn Fn(&mut [f64])) -> (Vec<f64>, f64) {
        let gradient = self.gradient(x, loads);
        let mut change: Vec<f64> = gradient.iter().map(|g| -g).collect();
        solve(&mut change);
        let work = -dot(&gradient, &change);
        (change, work)
    }

    /// Whether the work of the step to `x` is none beside that of the loads.
    fn is_settled(&self, work: f64, x: &[f64], loads: &DeadLoads) -> bool {
        let forces = loads.on_arms.iter().map(|own| own.force.norm());
        let least = UNMOVED * self.size * forces.sum::<f64>();
        work <= SETTLED * dot(&loads.by_unknown, x).abs().max(least)
    }

    /// The largest turn of a body in a step.
    fn largest_turn(&self, change: &[f64]) -> f64 {
        let motions = self.frame.body_motions(change);
        let turns = motions.iter().map(|own| own.fixed_rows::<3>(3).norm());
        turns.fold(0.0, f64::max)
    }

    /// The largest displacement of a body, by its reference.
    fn largest_displacement(&self, x: &[f64]) -> f64 {
        let motions = self.frame.body_motions(x);
        motions.iter().fold(0.0, |most, motion| {
            most.max(motion.fixed_rows::<3>(0).norm())
        })
    }

    /// Second derivatives of the potential energy by the scaled unknowns.
    fn stiffness(&self, x: &[f64], loads: &DeadLoads) -> CsMat<f64> {
        let frame = self.frame;
        let motions = frame.body_motions(x);
        let mut sums = BlockSums::new(motions.len(), self.members.len());
        let basis = |body: usize| &frame.bodies.list[body].basis;
        let own = |sums: &mut BlockSums<f64>, body: usize, block: &Matrix6| {
            sums.add_own(body, &(basis(body).transpose() * block * basis(body)));
        };
        for member in self.members.iter().flatten() {
            let [a, b] = member.bodies;
            let [of_a, between, of_b] = member.stiffness([&motions[a], &motions[b]]);
            own(&mut sums, a, &of_a);
            own(&mut sums, b, &of_b);
            sums.add_coupling([a, b], basis(a).transpose() * between * basis(b));
        }
        for spring in &self.springs {
            let gradient = spring.gradient(variables(&motions[spring.body]));
            own(&mut sums, spring.body, &derivatives(&gradient));
        }
        for force in loads.turning() {
            let gradient = arm_gradient(force, variables(&motions[force.body]));
            own(&mut sums, force.body, &derivatives(&gradient));
        }
        let numbering = &frame.stiffness().numbering;
        sums.upper(&numbering.unknown, &numbering.scale)
    }

    /// First derivatives of the potential energy by the scaled unknowns.
    fn gradient(&self, x: &[f64], loads: &DeadLoads) -> Vec<f64> {
        let motions = self.frame.body_motions(x);
        let mut by_body = vec![SVector::<f64, 6>::zeros(); motions.len()];
        for member in self.members.iter().flatten() {
            let [a, b] = member.bodies;
            let [on_a, on_b] = member.forces_on_bodies([&motions[a], &motions[b]]);
            by_body[a] += on_a;
            by_body[b] += on_b;
        }
        for spring in &self.springs {
            by_body[spring.body] += SVector::from(spring.gradient(motions[spring.body].into()));
        }
        for force in loads.turning() {
            by_body[force.body] += SVector::from(arm_gradient(force, motions[force.body].into()));
        }
        let numbering = &self.frame.stiffness().numbering;
        let columns = numbering.column.iter().zip(&numbering.scale);
        columns
            .zip(&loads.by_unknown)
            .map(|((&column, scale), load)| {
                let basis = &self.frame.bodies.list[column / 6].basis;
                scale * basis.column(column % 6).dot(&by_body[column / 6]) - load
            })
            .collect()
    }

    /// Displacements of all points of the model, and of the tips of `arms`.
    pub fn displacements(&self, x: &[f64], arms: &[ArmForce]) -> Vec<[f64; 3]> {
        let motions = self.frame.body_motions(x);
        let bodies = &self.frame.bodies;
        let moved = |body: usize, arm: [f64; 3]| {
            let motion = &motions[body];
            let turn = Turn::new([motion[3], motion[4], motion[5]]);
            sum([motion[0], motion[1], motion[2]], turn.change(arm))
        };
        let points = bodies.of_point.iter().zip(&bodies.arms);
        points
            .map(|(&body, arm)| moved(body, arm.map(Real::double).into()))
            .chain(arms.iter().map(|own| moved(own.body, own.arm.into())))
            .collect()
    }

    /// Internal forces at the ends of all members; none for those within one rigid body.
    pub fn end_forces(&self, x: &[f64]) -> Vec<Option<EndForces>> {
        let motions = self.frame.body_motions(x);
        let of =
            |member: &MovingMember| member.end_forces(member.bodies.map(|body| &motions[body]));
        self.members
            .iter()
            .map(|member| member.as_ref().map(of))
            .collect()
    }
}

fn add(x: &mut [f64], change: &[f64]) {
    x.iter_mut().zip(change).for_each(|(x, own)| *x += own);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A number with its derivatives by the motions of a body.
type Variable = DualSVec64<6>;

impl GroundSpring {
    /// Gradient of its energy by the motion of its body.
    fn gradient<D: DualNum<Primitive = f64> + Copy>(&self, motion: [D; 6]) -> [D; 6] {
        let mut out = [D::zero(); 6];
        if self.dof < 3 {
            let turn = Turn::new([motion[3], motion[4], motion[5]]);
            let mut force = [D::zero(); 3];
            force[self.dof] = (motion[self.dof] + turn.change(self.arm)[self.dof]) * self.stiffness;
            out = with_turn(force, turn.gradient(&[(force, self.arm)]));
        } else {
            out[self.dof] = motion[self.dof] * self.stiffness;
        }
        out
    }
}

/// Gradient, by the motion of its body, of what the loads by unknown leave of the work of a force on an arm: they hold u + t x r,
/// and what remains is F . (R r - r - t x r).
fn arm_gradient<D: DualNum<Primitive = f64> + Copy>(own: &ArmForce, motion: [D; 6]) -> [D; 6] {
    let axis = own.rail.map(<[f64; 3]>::from);
    let about = |v: Vec3<D>| axis.map_or(v, |axis| axis.map(|own| along(v, axis) * own));
    let vector = about([motion[3], motion[4], motion[5]]);
    let (arm, force) = (<[f64; 3]>::from(own.arm), constant(own.force.into()));
    let finite = Turn::new(vector).gradient(&[(force, arm)]);
    let by_turn = difference(cross(constant(arm), force), finite);
    with_turn([D::zero(); 3], about(by_turn))
}

/// The motions of a body as variables.
fn variables(motion: &SVector<f64, 6>) -> [Variable; 6] {
    std::array::from_fn(|k| Variable::from_re(motion[k]).derivative(k))
}

/// A gradient by displacements and by rotations.
fn with_turn<D>(by_displacement: Vec3<D>, by_turn: Vec3<D>) -> [D; 6] {
    let [[a, b, c], [d, e, f]] = [by_displacement, by_turn];
    [a, b, c, d, e, f]
}

/// The derivatives of a gradient.
fn derivatives(gradient: &[Variable; 6]) -> Matrix6 {
    let rows = gradient.map(|own| own.eps.unwrap_generic(Const::<6>, U1));
    Matrix6::from_fn(|i, j| rows[i][j])
}
