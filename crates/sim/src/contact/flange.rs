//! Flange of a wheel: L = k S(h) (|e| - clearance) sign(e) beyond the clearance, where h is the height of the wheel.

use nalgebra::DVector;
use splines::Axis;

use super::element::{
    At, Coupling, Element, ElementProbe, Guard, GuardKind, Law, Local, Query, Role, Where,
};
use super::energy::{Exchanged, Stored};
use super::rows::RowMut;
use crate::mechanics::assembly::Mechanics;
use crate::mechanics::state::State;
use crate::scene::dof::arm_rows;
use crate::scene::irregularity::LATERAL;
use crate::{BodyDof, Channel, Flange};

/// Part of the clearance within which a flange is near its rail.
const NEAR: f64 = 0.01;
/// Factor on the motion that speed and acceleration at the start of a step predict for it.
const CLOSING: f64 = 1.5;

/// Index of the roll among the displacements of a body.
const ROLL: usize = BodyDof::Roll as usize;

/// The flange of one wheel.
pub(crate) struct FlangeContact<'a> {
    flange: &'a Flange,
    wheel: usize,
    radius: f64,
    /// The vertical contact whose penetration determines the height of the wheel.
    vertical: usize,
}

impl<'a> FlangeContact<'a> {
    /// The flanges of all wheels that have one.
    pub fn all(mechanics: &Mechanics<'a>) -> Vec<Self> {
        let wheels = mechanics.wheels.iter().enumerate();
        wheels
            .filter_map(|(w, wheel)| {
                let kind = &mechanics.scene.wheels[wheel.kind];
                let vertical = mechanics.groups_of(w).next().unwrap_or(0);
                Some(FlangeContact {
                    flange: kind.flange.as_ref()?,
                    wheel: w,
                    radius: kind.radius,
                    vertical,
                })
            })
            .collect()
    }
}

impl Element for FlangeContact<'_> {
    /// The row for a wheel of zero height.
    fn constant_row(&self, mechanics: &Mechanics, row: &mut RowMut) {
        let wheel = &mechanics.wheels[self.wheel];
        row.add_approach(
            &mechanics.kinematics,
            wheel.body,
            arm_rows(wheel.hub)[2],
            1.0,
        );
    }

    /// The rail is below the hub by the height of the wheel; the lateral irregularity of the rail reduces the
    /// approach.
    fn update_row(&self, at: &Where, row: &mut RowMut, local: &mut Local) {
        let (w, kinematics) = (self.wheel, &at.mechanics.kinematics);
        let body = at.mechanics.wheels[w].body;
        let by_height = arm_rows([0.0, -at.places.height[w], 0.0])[2][ROLL];
        for &(number, coefficient) in &kinematics.terms(body)[ROLL] {
            row.approach[number] += by_height * coefficient;
        }
        *row.approach_offset += by_height * kinematics.constant(body)[ROLL];
        if at.is_uneven
            && let Some(shape) = at.mechanics.irregularity(w)
        {
            let [place, slope] = local
                .shape
                .at(shape, LATERAL, at.places.piece[w], at.places.x[w]);
            *row.approach_offset -= place;
            *row.rise = -slope;
        }
    }

    fn row_changes(&self) -> [bool; 2] {
        [true, false]
    }

    fn probes(&self, _: &Mechanics) -> Vec<ElementProbe> {
        vec![ElementProbe {
            wheel: self.wheel,
            weight: 1.0,
            axis: Axis::Lateral,
            part: None,
        }]
    }

    fn body(&self, mechanics: &Mechanics) -> Option<usize> {
        Some(mechanics.wheels[self.wheel].body)
    }

    fn tilted_wheel(&self) -> Option<usize> {
        Some(self.wheel)
    }

    fn follows_motion(&self) -> bool {
        true
    }

    fn uses_height(&self) -> bool {
        true
    }

    fn role(&self) -> Role {
        Role::Guides
    }

    fn flange(&self, at: &State) -> Option<[f64; 2]> {
        let (share, _) = self.flange.fraction(self.radius - at.p[self.vertical]);
        Some([self.flange.stiffness * share, self.flange.clearance])
    }

    /// A flange that is free at the start of a stage is assumed to be free until it touches.
    fn is_idle(&self, _: bool, _: &Local, force: f64) -> bool {
        force == 0.0
    }

    fn is_followed(&self) -> bool {
        true
    }

    /// A flange may touch if what is left of its clearance is a hundredth of it, or less than one and a half times what its
    /// speed, in its direction, and its acceleration, in any, at the start close within `h`.
    fn may_act(&self, at: &At, h: f64) -> bool {
        let along = |motion: &DVector<f64>| at.rows.approach_along(at.index, motion);
        let passing = at.rows.rise[at.index] * at.mechanics.speed_along(self.wheel, at.state);
        let here = at.approach() - at.deflection();
        let ahead = here + CLOSING * h * (along(&at.state.v) + passing);
        let turned = CLOSING * 0.5 * h * h * along(&at.state.a).abs();
        here.abs().max(ahead.abs()) + turned > (1.0 - NEAR) * self.flange.clearance
    }

    fn touches(&self, p: f64) -> bool {
        self.flange.overlap(p) != 0.0
    }

    fn law(&self, query: &Query, _: &mut Vec<Coupling>) -> Option<Law> {
        let flange = self.flange;
        let mut overlap = if query.is_active {
            flange.overlap(query.penetration())
        } else {
            0.0
        };
        // An extrapolated force may have the sign of the other side.
        if overlap == 0.0 && query.continues && query.force[query.index] != 0.0 {
            overlap = query.penetration() - flange.clearance.copysign(query.penetration());
        }
        if overlap == 0.0 {
            return None;
        }
        let (share, by_height) = flange.fraction(self.radius - query.reached[self.vertical][0]);
        Some(Law {
            force: flange.stiffness * share * overlap,
            by_penetration: flange.stiffness * share,
            by_rate: 0.0,
            by_other: Some((self.vertical, -flange.stiffness * by_height * overlap)),
        })
    }

    fn guard_kind(&self) -> Option<GuardKind> {
        Some(GuardKind::Touch)
    }

    /// The overlap with the rail, negative if the flange is free.
    fn guards(&self, at: &At, put: &mut dyn FnMut(Guard)) {
        let e = at.approach() - at.deflection();
        put(Guard {
            value: e.abs() - self.flange.clearance,
            stiffness: self.flange.stiffness,
        });
    }

    fn stored(&self, at: &At, energy: &mut Stored) {
        if at.force() == 0.0 {
            return;
        }
        let flange = self.flange;
        let deflection = at.deflection();
        energy.structure += 0.5 * at.force() * deflection;
        let overlap = flange.overlap(at.approach() - deflection);
        let share = flange.fraction(at.places.height[self.wheel]).0;
        energy.contact += 0.5 * flange.stiffness * share * overlap * overlap;
    }

    /// Energy lost as the flange force is released while the wheel climbs: the power is -k overlap^2/2 times the rate
    /// of S(h).
    fn power(&self, at: &At, power: &mut Exchanged) {
        let flange = self.flange;
        let (share, slope) = flange.fraction(at.places.height[self.wheel]);
        if !(share > 0.0 && slope != 0.0) {
            return;
        }
        let overlap = at.force() / (flange.stiffness * share);
        let first = at.mechanics.groups[self.vertical].wheels.start;
        let uneven = if at.is_uneven {
            at.rows.rise[self.vertical] * at.mechanics.speed_along(first, at.state)
        } else {
            0.0
        };
        let climb = -at.rate_of(self.vertical) - uneven;
        power.flanges -= 0.5 * flange.stiffness * overlap * overlap * slope * climb;
    }

    fn resistance(&self, at: &At, b: usize) -> f64 {
        let body = at.mechanics.wheels[self.wheel].body;
        if at.mechanics.kinematics.root(body) == b {
            -(at.rail_slope() * at.force())
        } else {
            0.0
        }
    }

    fn channels(&self, _: &Mechanics) -> Vec<(Channel, f64)> {
        vec![(Channel::Lateral(self.wheel), 1.0)]
    }
}
