//! Vertical contact of a wheel, or of the wheels of massless equalisers, with a rail: F = n s (k p^e + S(p) c r).
//!
//! p is the penetration, r its rate or that of the wheel alone, n the number of wheels, and s the fraction of the law
//! that acts while a wheel passes between rigid parts. The contact is one-sided: it opens if its force would be
//! tensile, and closes if spring and damper would push.

use std::ops::Range;

use splines::Axis;

use super::active::ActiveSet;
use super::element::{At, Coupling, Element, ElementProbe, Law, Local, Query, Role, Where};
use super::energy::{Exchanged, Stored};
use super::places::Places;
use super::rows::RowMut;
use crate::mechanics::assembly::Mechanics;
use crate::mechanics::state::State;
use crate::numerics::step::step_integral;
use crate::scene::dof::arm_rows;
use crate::scene::irregularity::VERTICAL;
use crate::scene::wheel::LawValue;
use crate::{Channel, Damper, Irregularity, NormalLaw};

/// A vertical contact.
pub(crate) struct Vertical<'a> {
    law: &'a NormalLaw,
    body: usize,
    wheels: Range<usize>,
    contact: usize,
    /// The rigid part on which it acts, if every part has its own force.
    part: Option<usize>,
    /// The shape of the unloaded rail averaged over the wheels, at the rail coordinate of the first of them; `None` where it
    /// has corners, which the wheels pass one by one.
    mean: Option<Irregularity>,
}

impl<'a> Vertical<'a> {
    /// One contact for each wheel group, in their order.
    pub fn all(mechanics: &Mechanics<'a>) -> Vec<Self> {
        let groups = mechanics.groups.iter();
        groups
            .map(|group| Vertical {
                law: &mechanics.scene.wheels[group.kind].normal,
                body: mechanics.scene.contacts[group.contact].body,
                wheels: group.wheels.clone(),
                contact: group.contact,
                part: group.part,
                mean: mean_shape(mechanics, group.wheels.clone()),
            })
            .collect()
    }

    /// Number of wheels that share the force.
    pub fn count(&self) -> f64 {
        self.wheels.len() as f64
    }

    /// Whether an active contact must open: a one-sided contact has a tensile force, or the fraction of its part is
    /// zero.
    pub fn opens(&self, force: f64, fraction: f64) -> bool {
        fraction == 0.0 || (force < 0.0 && !self.law.bilateral)
    }

    /// Force of one wheel that open contact `i` would have if it closed now at `at`, where `rate` is the rate of its
    /// damper to ground. A positive value means that it must close.
    pub fn closing(
        &self,
        i: usize,
        fraction: f64,
        active: &ActiveSet,
        at: &State,
        rate: impl FnOnce() -> f64,
    ) -> f64 {
        let law = self.law;
        if fraction == 0.0 {
            return -1.0;
        }
        if law.bilateral {
            return 1.0;
        }
        if let Some(left) = self.relaxed(active.stored(i), at.t) {
            return law.spring(at.p[i] - left);
        }
        let rate = if law.has_memory() {
            at.p_rate[i]
        } else {
            rate()
        };
        let spring = law.spring(at.p[i]);
        if at.p[i] <= 0.0 {
            spring
        } else {
            law.at(at.p[i], rate).force
        }
    }

    /// Remaining penetration of spring and damper of an open contact at `t`. Without force, the penetration `stored`
    /// at opening decays ([`NormalLaw::relaxed`]), and wheel and rail are separated until the wheel reaches the remaining
    /// penetration. `None` if no penetration is stored, or if the law has no damper between wheel and rail.
    fn relaxed(&self, stored: Option<[f64; 2]>, t: f64) -> Option<f64> {
        let [p, since] = stored.filter(|_| self.law.has_memory())?;
        Some(self.law.relaxed(p, t - since))
    }
}

/// The shape of the unloaded rail averaged over `wheels`, which move along it together.
fn mean_shape(mechanics: &Mechanics, wheels: Range<usize>) -> Option<Irregularity> {
    let first = mechanics.wheels[wheels.start].hub;
    let ahead: Vec<f64> = wheels
        .clone()
        .map(|w| mechanics.wheels[w].hub[0] - first[0])
        .collect();
    let together = wheels
        .clone()
        .all(|w| mechanics.wheels[w].hub[1..] == first[1..]);
    mechanics
        .irregularity(wheels.start)
        .filter(|_| together)?
        .averaged(&ahead)
}

impl Element for Vertical<'_> {
    fn constant_row(&self, mechanics: &Mechanics, row: &mut RowMut) {
        for w in self.wheels.clone() {
            let wheel = &mechanics.wheels[w];
            row.add_approach(
                &mechanics.kinematics,
                wheel.body,
                arm_rows(wheel.hub)[1],
                -1.0 / self.count(),
            );
        }
        row.rate.copy_from_slice(row.approach);
    }

    /// Shape of the unloaded rail: an upward irregularity increases the approach.
    fn update_row(&self, at: &Where, row: &mut RowMut, local: &mut Local) {
        if !at.is_uneven {
            return;
        }
        if let Some(shape) = &self.mean {
            let [height, slope] =
                local
                    .shape
                    .at(shape, VERTICAL, 0, at.places.x[self.wheels.start]);
            *row.approach_offset += height;
            *row.rise += slope;
            return;
        }
        for w in self.wheels.clone() {
            if let Some(shape) = at.mechanics.irregularity(w) {
                let [height, slope] = shape.vertical(at.places.piece[w], at.places.x[w]);
                *row.approach_offset += height / self.count();
                *row.rise += slope / self.count();
            }
        }
    }

    fn fraction(&self, mechanics: &Mechanics, places: &Places) -> Option<[f64; 2]> {
        let contact = &mechanics.scene.contacts[self.contact];
        let chains = mechanics.foundations[contact.structure].parts.as_ref()?;
        let part = self.part?;
        let mean = self.wheels.clone().map(|w| places.x[w]).sum::<f64>() / self.count();
        Some(chains[contact.rail].fraction(part, mean))
    }

    fn probes(&self, _: &Mechanics) -> Vec<ElementProbe> {
        let weight = -1.0 / self.count();
        let wheels = self.wheels.clone();
        wheels
            .map(|wheel| ElementProbe {
                wheel,
                weight,
                axis: Axis::Vertical,
                part: self.part,
            })
            .collect()
    }

    fn body(&self, _: &Mechanics) -> Option<usize> {
        Some(self.body)
    }

    fn tilted_wheel(&self) -> Option<usize> {
        Some(self.wheels.start)
    }

    fn role(&self) -> Role {
        Role::Carries
    }

    fn begins_active(&self) -> bool {
        false
    }

    fn feels_rates(&self) -> bool {
        self.law.damper == Damper::Ground
    }

    fn has_memory(&self) -> bool {
        self.law.has_memory()
    }

    fn law(&self, query: &Query, _: &mut Vec<Coupling>) -> Option<Law> {
        if !query.is_active {
            return None;
        }
        let LawValue {
            force,
            by_penetration,
            by_rate,
        } = self.law.at(query.penetration(), query.rate);
        let scale = self.count() * query.local.fraction[0];
        Some(Law {
            force: scale * force,
            by_penetration: scale * by_penetration,
            by_rate: scale * by_rate,
            by_other: None,
        })
    }

    /// A contact closes if its spring is compressed and its law pushes. The value is the smaller of the two forces,
    /// because the damper force may jump when wheel and rail meet, and the spring force may jump when a compressed
    /// contact begins to push.
    fn switch(&self, at: &At, active: &ActiveSet) -> Option<f64> {
        let i = at.index;
        if active.has(i) {
            return Some(if self.law.bilateral {
                -1.0
            } else {
                -at.force()
            });
        }
        let closing = self.closing(i, at.local().fraction[0], active, at.state, || at.rate());
        Some(if closing > 0.0 {
            closing.min(self.law.spring(at.state.p[i]))
        } else {
            closing
        })
    }

    fn stored(&self, at: &At, energy: &mut Stored) {
        if at.force() != 0.0 {
            energy.contact +=
                self.count() * at.local().fraction[0] * self.law.energy(at.state.p[at.index]);
        }
        energy.structure += at.rail_energy();
    }

    fn power(&self, at: &At, power: &mut Exchanged) {
        let (law, i) = (self.law, at.index);
        let [fraction, slope] = at.local().fraction;
        let rate = if slope == 0.0 {
            0.0
        } else {
            slope * at.mechanics.speed_along(self.wheels.start, at.state)
        };
        power.handover -= self.count() * rate * law.energy(at.state.p[i]);
        match law.damper {
            Damper::Rail => {
                power.dampers += (at.force() - self.count() * fraction * law.spring(at.state.p[i]))
                    * at.state.p_rate[i];
            }
            Damper::Ground => {
                let acceleration = at.rows.rate_along(i, &at.state.a);
                power.dampers -= self.count()
                    * law.damping
                    * (fraction * acceleration + rate * at.rate())
                    * step_integral(law.depth, at.state.p[i]);
            }
        }
    }

    /// With d the displacement of the wheel and S the ramp of a damper to ground, the integral of c S(p) d' dp equals
    /// [c d' Q(p)] minus the integral of c d'' Q(p) dt, where Q' = S. This is the boundary term c d' Q(p).
    fn boundary(&self, at: &At) -> f64 {
        let law = self.law;
        if !law.is_grounded() || at.force() == 0.0 {
            return 0.0;
        }
        self.count()
            * at.local().fraction[0]
            * law.damping
            * at.rate()
            * step_integral(law.depth, at.state.p[at.index])
    }

    fn resistance(&self, at: &At, b: usize) -> f64 {
        if at.mechanics.kinematics.root(self.body) == b {
            -(at.rail_slope() * at.force())
        } else {
            0.0
        }
    }

    fn channels(&self, _: &Mechanics) -> Vec<(Channel, f64)> {
        self.wheels
            .clone()
            .map(|w| (Channel::Vertical(w), self.count()))
            .collect()
    }
}
