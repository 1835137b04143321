//! What a linear theory leaves out: its answers beside those of finite displacements.

use nalgebra::{SVector, Vector3};

use super::frame::{DeadLoads, Lost, MovingFrame};
use super::member::EndForces;
use crate::assembly::{Element, Matrix12, Real, end_displacements};
use crate::error::Error;
use crate::influence::FactoredFrame;
use crate::model::{Model, Rail, cut_at, equal_cuts};
use crate::preload::{ArmForce, Preload};

/// Angle within a part of a member, radian, up to which its bending counts as moderate.
const BENT: f64 = 0.2;
/// L sqrt(N/EI) of a part up to which its axial force is right to a few percent of its effect.
const COMPRESSED: f64 = 0.8;
/// M L/sqrt(EI GJ) of a part up to which the effect of its moment on twist is right to a few percent.
const TWISTED: f64 = 0.2;
/// Most parts of a member between loads.
const MOST_PARTS: f64 = 24.0;
/// Distance of a cut from the ends of a member and from other cuts, relative to its length, at which both count as one: much
/// shorter parts would be much stiffer than the others. A force between two cuts acts on both.
const SAME: f64 = 2e-3;

/// A linear theory of a structure: of first order, or about the state under a preload. It is compared with finite displacements.
///
/// # Example
/// ```
/// use fea::{CrossSection, LargeDisplacements, LinearState, Member, Model, Preload, Rail, RailForce, RailSegment, Support};
///
/// // A cantilever of 2 m pressed along its axis by a tenth of its critical load, and pushed across at its tip.
/// let section = CrossSection { e: 2.1e11, g: 8.1e10, area: 5e-3, iy: 8e-5, iz: 8e-5, j: 1e-4, ..CrossSection::default() };
/// let model = Model {
///     points: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
///     sections: vec![section],
///     members: vec![Member::beam([0, 1], 0, [0.0, 1.0, 0.0])],
///     supports: vec![Support { point: 0, fixed: [true; 6] }],
///     up: [0.0, 1.0, 0.0],
///     ..Model::default()
/// };
/// let segments = vec![RailSegment { member: 0, offset: [0.0; 3] }];
/// let rail = Rail { axis: [1.0, 0.0, 0.0], segments, ..Rail::default() };
/// let critical = (std::f64::consts::PI / 4.0).powi(2) * section.e * section.iz;
/// let live = vec![RailForce { rail: 0, x: 2.0, force: [-0.1 * critical, -1e3, 0.0] }];
///
/// let none = Preload::default();
/// let rails = [rail];
/// let state = LinearState::new(&model, &rails, &none)?;
/// let LargeDisplacements::Found(left_out) = state.compare(&Preload { rails: live, ..Preload::default() })? else {
///     panic!("it stands");
/// };
/// // 3 (tan u - u)/u^3 - 1 with u = (pi/2) sqrt(0.1), of the deflection across
/// let u = 0.1_f64.sqrt() * std::f64::consts::FRAC_PI_2;
/// let known = 3.0 * (u.tan() - u) / u.powi(3) - 1.0;
/// assert!((left_out.deflection.relative() / known - 1.0).abs() < 0.05);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Debug)]
pub struct LinearState<'a> {
    model: &'a Model,
    rails: &'a [Rail],
    base: &'a Preload,
    frame: FactoredFrame,
}

/// What finite displacements say of a linear theory under given loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LargeDisplacements {
    /// There is an equilibrium, which differs by this.
    Found(Omitted),
    /// As the loads grow, no stable equilibrium was found beyond this part of them; 0 where the structure does not stand even
    /// without them.
    Lost {
        /// Part of the loads, 0 to 1.
        part: f64,
    },
}

/// Differences of a linear theory from finite displacements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Omitted {
    /// Displacements of points and under forces on rails, length; on rails those across them.
    pub deflection: LargestDifference,
    /// Axial and shear forces at the ends of members and of their parts, force.
    pub force: LargestDifference,
    /// Bending moments and torques there, force length.
    pub moment: LargestDifference,
}

/// Largest value of a quantity by the linear theory, and the largest difference from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LargestDifference {
    /// Largest absolute value of the linear theory.
    pub largest: f64,
    /// Largest difference from it, at whatever place.
    pub difference: f64,
}

impl LargestDifference {
    fn take(&mut self, linear: f64, difference: f64) {
        self.largest = self.largest.max(linear.abs());
        self.difference = self.difference.max(difference.abs());
    }

    /// The largest of both values.
    #[must_use]
    pub fn or(self, other: LargestDifference) -> LargestDifference {
        LargestDifference {
            largest: self.largest.max(other.largest),
            difference: self.difference.max(other.difference),
        }
    }

    /// The difference by the largest value; 0 where all are zero.
    #[must_use]
    pub fn relative(&self) -> f64 {
        if self.largest > 0.0 {
            self.difference / self.largest
        } else {
            0.0
        }
    }
}

impl Omitted {
    /// The largest of both, for each quantity.
    #[must_use]
    pub fn or(self, other: Omitted) -> Omitted {
        Omitted {
            deflection: self.deflection.or(other.deflection),
            force: self.force.or(other.force),
            moment: self.moment.or(other.moment),
        }
    }
}

impl<'a> LinearState<'a> {
    /// The theory of `model`, which holds the axial forces of the preload `base` where it is linear about it; `base` stands on the
    /// structure in any case.
    ///
    /// # Errors
    /// As [`FactoredFrame::new`].
    pub fn new(model: &'a Model, rails: &'a [Rail], base: &'a Preload) -> Result<Self, Error> {
        base.check(model)?;
        let frame = FactoredFrame::new(model, rails)?;
        Ok(LinearState {
            model,
            rails,
            base,
            frame,
        })
    }

    /// What the theory leaves out of the answer to `live`, forces on points and rails in addition to those of the base.
    ///
    /// The model is cut at the forces and so finely that every part is moderately bent. The answer of finite displacements is the
    /// difference of the equilibria with and without `live`; that of the linear theory has its exact members.
    ///
    /// # Errors
    /// [`Error::Rail`] for a force beyond its rail, and as [`FactoredFrame::new`].
    pub fn compare(&self, live: &Preload) -> Result<LargeDisplacements, Error> {
        live.check(self.model)?;
        let (model, rails) = cut_at(self.model, self.rails, &self.cuts(live)?);
        let frame = FactoredFrame::new(&model, &rails)?;
        let unloaded = model.unloaded();
        let elements = Element::all(&unloaded)?;
        let moving = MovingFrame::new(&unloaded, &frame, &elements);

        let live_loads = live.loads(&model, &frame)?;
        let arms = &live_loads.on_arms;
        let linear = frame.motions(&live_loads.load);
        let more = DeadLoads::new(&frame, &live_loads);
        let base = DeadLoads::new(&frame, &self.base.loads(&model, &frame)?);
        let Some(standing) = moving.standing(&base) else {
            return Ok(LargeDisplacements::Lost { part: 0.0 });
        };
        let loaded = match moving.follow(standing.clone(), &base, &more) {
            Ok(loaded) => loaded,
            Err(Lost { part }) => return Ok(LargeDisplacements::Lost { part }),
        };

        let mut out = Omitted::default();
        let [before, after] = [&standing, &loaded].map(|x| moving.displacements(x, arms));
        let of_linear = linear_displacements(&frame, &linear, arms);
        let along = along_rails(&model, &rails, &frame, arms);
        let differences = before.iter().zip(&after).zip(&of_linear).zip(along);
        for (((before, after), own), along) in differences {
            let own = Vector3::from(*own);
            let difference = Vector3::from(*after) - Vector3::from(*before) - own;
            let across = |v: Vector3<f64>| along.map_or(v, |axis| v - axis * axis.dot(&v));
            let (own, difference) = (across(own), across(difference));
            (0..3).for_each(|k| out.deflection.take(own[k], difference[k]));
        }
        let [before, after] = [&standing, &loaded].map(|x| moving.end_forces(x));
        let ends = before.iter().zip(&after).zip(&frame.elements);
        for ((before, after), element) in ends {
            let (Some(before), Some(after)) = (before, after) else {
                continue;
            };
            let linear = linear_end_forces(&frame, element, &linear);
            for end in 0..2 {
                for k in 0..6 {
                    let own = linear[end][k];
                    let change = if k < 3 {
                        &mut out.force
                    } else {
                        &mut out.moment
                    };
                    change.take(own, after[end][k] - before[end][k] - own);
                }
            }
        }
        Ok(LargeDisplacements::Found(out))
    }

    /// Fractions of the lengths at which members are cut: at the forces on rails, and between them as finely as axial forces and
    /// rotations of the linear theory need.
    fn cuts(&self, live: &Preload) -> Result<Vec<Vec<f64>>, Error> {
        let frame = &self.frame;
        let load = live.loads(self.model, frame)?;
        let base = self.base.loads(self.model, frame)?;
        let motions = frame.motions(&[load.load, base.load].concat());
        let elements = frame.elements.iter();
        let mut cuts: Vec<Vec<f64>> = elements
            .map(|element| {
                let pair = frame.bodies.pair(element.points);
                if pair[0] == pair[1] || element.is_string {
                    return Vec::new();
                }
                let turned = [0, 1].map(|end| motions[pair[end]].fixed_rows::<3>(3).norm());
                let ends = linear_end_forces(frame, element, &motions);
                let largest = |k: usize| ends[0][k].abs().max(ends[1][k].abs());
                let own = &element.flexibility;
                let or_rigid = |flexibility: f64| {
                    if flexibility.is_finite() {
                        flexibility
                    } else {
                        0.0
                    }
                };
                let bending = or_rigid(own.bending_y).max(or_rigid(own.bending_z));
                let column = element.length * (largest(0) * bending).sqrt();
                let moment = largest(4).max(largest(5));
                let twist = element.length * moment * (bending * or_rigid(own.torsion)).sqrt();
                let parts = (column / COMPRESSED)
                    .max(twist / TWISTED)
                    .max(2.0 * turned[0].max(turned[1]) / BENT);
                equal_cuts(parts.ceil().clamp(1.0, MOST_PARTS) as usize)
            })
            .collect();
        for given in self.base.rails.iter().chain(&live.rails) {
            let line = frame.line()?;
            let on = line.elements().iter();
            let on = on.filter(|e| e.rail == given.rail && e.x[0] <= given.x && given.x <= e.x[1]);
            for own in on {
                let Some(member) = own.member else { continue };
                cuts[member.id].push(own.place_on_member(given.x) / own.length);
            }
        }
        for own in &mut cuts {
            own.sort_unstable_by(f64::total_cmp);
            own.retain(|cut| (SAME..=1.0 - SAME).contains(cut));
            own.dedup_by(|b, a| *b - *a < SAME);
        }
        Ok(cuts)
    }
}

/// For each point, then for each of `arms`, the direction of the rail that it lies on.
fn along_rails(
    m: &Model,
    rails: &[Rail],
    frame: &FactoredFrame,
    arms: &[ArmForce],
) -> Vec<Option<Vector3<f64>>> {
    let mut all = vec![None; m.points.len()];
    for (index, rail) in rails.iter().enumerate() {
        let axis: Vector3<f64> = frame.rail_axes(index).row(0).transpose();
        for segment in &rail.segments {
            let points = m.members[segment.member].points;
            points.into_iter().for_each(|point| all[point] = Some(axis));
        }
    }
    all.extend(arms.iter().map(|own| own.rail));
    all
}

/// Displacements of all points, and of the tips of `arms`, in small motions of the bodies.
fn linear_displacements(
    frame: &FactoredFrame,
    motions: &[SVector<f64, 6>],
    arms: &[ArmForce],
) -> Vec<[f64; 3]> {
    let bodies = &frame.bodies;
    let points = bodies.of_point.iter().zip(&bodies.arms);
    let points = points.map(|(&body, arm)| (body, arm.map(Real::double)));
    points
        .chain(arms.iter().map(|own| (own.body, own.arm)))
        .map(|(body, arm)| {
            let motion = &motions[body];
            let moved = motion.fixed_rows::<3>(0) + motion.fixed_rows::<3>(3).cross(&arm);
            moved.into()
        })
        .collect()
}

/// Internal forces at both ends of a member in small motions of the bodies, as [`splines::ForceComponent`] has them: shear forces
/// are normal to the bent axis.
fn linear_end_forces(
    frame: &FactoredFrame,
    element: &Element,
    motions: &[SVector<f64, 6>],
) -> EndForces {
    let Some(tips) = end_displacements(element, &frame.bodies, motions) else {
        return EndForces::default();
    };
    let force = element.stiffness() * tips;
    let recovery: Matrix12 = element.recovery();
    let flexible = recovery * tips;
    let tension = if element.is_string {
        0.0
    } else {
        element.flexibility.tension
    };
    std::array::from_fn(|end| {
        let (at, sign) = (6 * end, if end == 0 { -1.0 } else { 1.0 });
        let own: [f64; 6] = std::array::from_fn(|k| sign * force[at + k]);
        [
            own[0],
            own[1] - tension * flexible[at + 5],
            own[2] + tension * flexible[at + 4],
            own[3],
            own[4],
            own[5],
        ]
    })
}
