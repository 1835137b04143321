//! What every force element answers.
//!
//! A force element is one unknown scalar force F_i of a stage: a vertical contact, a flange, friction below a wheel,
//! a drive, a brake, a rope or a stop. With e = R q + offset its approach, G the compliance of rails without mass and
//! W, Y the effect of all forces on penetrations and rates, a stage solves
//!
//! F = law(p, r),  p = e - W F,  r = r_0 - Y F
//!
//! by one Newton iteration that never asks what kind of element it solves for. All that differs between kinds is said
//! by the trait [`Element`]: where an element acts (rows and probes), its law with slopes, the guards whose change of
//! sign ends a step, its energy, and its channels. Every question has the answer "nothing" by default, so that a new
//! law answers the few that concern it, in a file of its own and a line of `contact::elements`.

use std::ops::Deref;

use nalgebra::DVector;
use splines::Axis;

use super::active::ActiveSet;
use super::energy::{Exchanged, Stored};
use super::matrices::RailMatrices;
use super::places::Places;
use super::probes::{Probes, TangentialContact};
use super::rows::{RowMut, Rows};
use super::switches::Switches;
use crate::Channel;
use crate::mechanics::assembly::Mechanics;
use crate::mechanics::point::PointPair;
use crate::mechanics::state::State;
use crate::numerics::dense::along;

/// The questions.
pub(crate) trait Element {
    // Where it acts.

    /// Writes the part of its row that is the same at every state.
    fn constant_row(&self, _mechanics: &Mechanics, _row: &mut RowMut) {}

    /// Adds to its row what follows places and time; the rail's shapes are added afterwards.
    fn update_row(&self, _at: &Where, _row: &mut RowMut, _local: &mut Local) {}

    /// Fraction of its law that acts where the wheels are, and the slope of that fraction along the rail.
    fn fraction(&self, _mechanics: &Mechanics, _places: &Places) -> Option<[f64; 2]> {
        None
    }

    /// Its probes on the rails.
    fn probes(&self, _mechanics: &Mechanics) -> Vec<ElementProbe> {
        Vec::new()
    }

    /// The wheel that the slope of its deflected rail pushes along x, where it presses on one.
    fn tilted_wheel(&self) -> Option<usize> {
        None
    }

    /// Whether it acts along the rail: its rate rows load the degrees of freedom, and the displacement of a rail
    /// without mass along x is a state.
    fn is_tangential(&self) -> bool {
        false
    }

    /// Whether its row follows the motion within a stage.
    fn follows_motion(&self) -> bool {
        false
    }

    /// Whether it depends on the height of its wheel above the rail.
    fn uses_height(&self) -> bool {
        false
    }

    /// The two points that it joins, where it is a rope or a stop.
    fn points(&self) -> Option<&PointPair> {
        None
    }

    /// Its part in static equilibrium.
    fn role(&self) -> Role {
        Role::Absent
    }

    // Its law.

    /// Whether a rule has put it out of action for good.
    fn is_released(&self, _switches: &Switches) -> bool {
        false
    }

    /// Whether it is active where nothing has been decided yet.
    fn begins_active(&self) -> bool {
        true
    }

    /// Whether it has no force in the stage that begins at `force`: its column of the mobility is left out.
    fn is_idle(&self, is_active: bool, _local: &Local, _force: f64) -> bool {
        !is_active
    }

    /// Whether its law feels a rate of the degrees of freedom themselves, which forces of the same stage change.
    fn feels_rates(&self) -> bool {
        false
    }

    /// Whether its penetration is a state while it acts: a damper between wheel and rail.
    fn has_memory(&self) -> bool {
        false
    }

    /// Whether its penetration is followed while it is idle: it may begin to act within a stage, or others ask for it.
    fn is_followed(&self) -> bool {
        false
    }

    /// Whether an idle element begins to act within a stage at the penetration `p`.
    fn touches(&self, _p: f64) -> bool {
        false
    }

    /// Force by penetration and rate, with slopes; `None` where it does not act. Slopes by forces of other elements
    /// (and by its own, where the law is implicit) go to `couplings`.
    fn law(&self, query: &Query, couplings: &mut Vec<Coupling>) -> Option<Law>;

    // Its guards.

    /// Positive where it must begin to act (if it does not) or cease (if it does): the force by which it has gone too
    /// far. `None` where it is not switched.
    fn switch(&self, _at: &At, _active: &ActiveSet) -> Option<f64> {
        None
    }

    /// The kind of its guards, where it has some.
    fn guard_kind(&self) -> Option<GuardKind> {
        None
    }

    /// Quantities of its law of that kind, at whose change of sign the next step should begin.
    fn guards(&self, _at: &At, _put: &mut dyn FnMut(Guard)) {}

    // Its energy.

    /// Adds the energy stored in it.
    fn stored(&self, _at: &At, _energy: &mut Stored) {}

    /// Adds the rates of what it dissipates and supplies, less the rate of [`Element::boundary`].
    fn power(&self, _at: &At, _power: &mut Exchanged) {}

    /// Boundary term of what its damper dissipates, whose rate [`Element::power`] leaves out.
    fn boundary(&self, _at: &At) -> f64 {
        0.0
    }

    /// What it adds to the force along +x that the prescribed motion of root body `b` needs.
    fn resistance(&self, _at: &At, _b: usize) -> f64 {
        0.0
    }

    // Its channels.

    /// Channels to which it adds its force, each with a divisor.
    fn channels(&self, _mechanics: &Mechanics) -> Vec<(Channel, f64)> {
        Vec::new()
    }

    /// Channels of its own in a history, beside those of bodies and wheels, in their order.
    fn own_channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    /// The channel of the distance of its points.
    fn length_channel(&self) -> Option<Channel> {
        None
    }
}

/// Answers of an element that never change, kept at hand for the innermost loops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixed {
    pub feels_rates: bool,
    pub has_memory: bool,
    pub is_followed: bool,
    pub is_tangential: bool,
}

impl Fixed {
    /// The answers of `element`.
    pub fn of(element: &dyn Element) -> Self {
        Fixed {
            feels_rates: element.feels_rates(),
            has_memory: element.has_memory(),
            is_followed: element.is_followed(),
            is_tangential: element.is_tangential(),
        }
    }
}

/// Part of an element in static equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// It carries the weights.
    Carries,
    /// It guides across the rails.
    Guides,
    /// It joins two points by a spring.
    Spring,
    /// It has no force at rest.
    Absent,
}

/// Where rows are asked for.
pub(crate) struct Where<'c> {
    pub mechanics: &'c Mechanics<'c>,
    pub t: f64,
    pub q: &'c DVector<f64>,
    pub places: &'c Places,
    pub switches: &'c Switches,
    /// Whether some rail is uneven.
    pub is_uneven: bool,
}

/// One probe of an element on a rail.
pub(crate) struct ElementProbe {
    pub wheel: usize,
    /// Positive along the axis of the probe.
    pub weight: f64,
    pub axis: Axis,
    /// The rigid part that it presses on, where every part has its own force.
    pub part: Option<usize>,
}

/// What changes about an element with the state, beside its row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    /// Fraction of the law that acts, and its slope along the rail.
    pub fraction: [f64; 2],
    /// Whether a drive or a brake is on.
    pub is_on: bool,
    /// The spring of a rope or a stop.
    pub spring: Spring,
}

impl Default for Local {
    fn default() -> Self {
        Local { fraction: [1.0, 0.0], is_on: false, spring: Spring::default() }
    }
}

/// Spring and damper between two points at one state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spring {
    pub stiffness: f64,
    pub damping: f64,
    /// Unit vector along which the approach grows: from `from` to `to` of a rope, into a stop.
    pub direction: [f64; 3],
    /// Distance of the ends of a rope; depth of a stop.
    pub length: f64,
    /// Unstretched length of a rope, and its rate.
    pub unstretched: [f64; 2],
    /// Force below which rounding of places hides whether it acts.
    pub noise: f64,
}

/// What a law is asked.
pub(crate) struct Query<'q> {
    /// Index of the element.
    pub index: usize,
    /// Rate that the law feels.
    pub rate: f64,
    /// Penetration and rate of every element under the forces at hand.
    pub reached: &'q [[f64; 2]],
    /// Forces at hand.
    pub force: &'q [f64],
    pub local: &'q Local,
    /// Whether the element may act.
    pub is_active: bool,
    /// What a unit of the element's own force takes from its rate.
    pub fall: f64,
}

impl Query<'_> {
    /// Penetration of the element.
    pub fn penetration(&self) -> f64 {
        self.reached[self.index][0]
    }
}

/// A force and its slopes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Law {
    pub force: f64,
    pub by_penetration: f64,
    pub by_rate: f64,
    /// Another element, and the slope by its penetration.
    pub by_other: Option<(usize, f64)>,
}

/// Slope of the law of `element` by the force of element `by`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupling {
    pub element: usize,
    pub by: usize,
    pub slope: f64,
}

/// A quantity of a law that changes its sign where the law has a kink.
pub(crate) struct Guard {
    pub value: f64,
    /// Force per unit of the quantity: changes below a negligible force are not looked at.
    pub stiffness: f64,
}

/// How a step treats a guard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GuardKind {
    /// Looked at where the step errs by more than it may; located on the interpolant.
    Touch,
    /// Always looked at; located by the secant of both ends.
    Corner,
}

/// A scene at one state, to which rows and matrices belong.
pub(crate) struct Frame<'c> {
    pub mechanics: &'c Mechanics<'c>,
    pub probes: &'c Probes,
    pub state: &'c State,
    pub rows: &'c Rows,
    pub rails: &'c RailMatrices,
    pub places: &'c Places,
    pub switches: &'c Switches,
    /// What changes about every element beside its row.
    pub local: &'c [Local],
    /// Slope of the deflected rail at every element.
    pub rail_slope: &'c [f64],
    /// Whether some rail is uneven.
    pub is_uneven: bool,
}

/// One element of a frame.
pub(crate) struct At<'c> {
    /// Index of the element.
    pub index: usize,
    frame: &'c Frame<'c>,
}

impl<'c> Frame<'c> {
    /// Element `index` at this state.
    #[inline]
    pub fn at(&'c self, index: usize) -> At<'c> {
        At { index, frame: self }
    }
}

impl<'c> Deref for At<'c> {
    type Target = Frame<'c>;

    #[inline]
    fn deref(&self) -> &Frame<'c> {
        self.frame
    }
}

impl At<'_> {
    /// Its force.
    #[inline]
    pub fn force(&self) -> f64 {
        self.state.force[self.index]
    }

    /// What changes about it beside its row.
    #[inline]
    pub fn local(&self) -> &Local {
        &self.frame.local[self.index]
    }

    /// Slope of the deflected rail there.
    #[inline]
    pub fn rail_slope(&self) -> f64 {
        self.frame.rail_slope[self.index]
    }

    /// Its approach, before the deflection of the rail.
    #[inline]
    pub fn approach(&self) -> f64 {
        self.rows.approach_at(self.index, &self.state.q)
    }

    /// Deflection of the rail without mass.
    #[inline]
    pub fn deflection(&self) -> f64 {
        self.rails.deflection(self.index, &self.state.force)
    }

    /// The rate that it feels, that of the degrees of freedom alone.
    #[inline]
    pub fn rate(&self) -> f64 {
        self.rate_of(self.index)
    }

    /// The same of element `i`.
    #[inline]
    pub fn rate_of(&self, i: usize) -> f64 {
        self.rows.rate_at(i, &self.state.v)
    }

    /// Elastic energy of the rails under its force.
    pub fn rail_energy(&self) -> f64 {
        0.5 * self.force() * self.deflection()
    }

    /// Rate that its law feels along the rail: that of its wheels less that of the rail.
    pub fn slip(&self) -> f64 {
        let own = self.rate();
        if self.probes.sliding.is_empty() {
            return own;
        }
        let rail = self.probes.slots[self.index].map_or(0.0, |slot| self.state.p_rate[slot]);
        own - rail + passing(self.mechanics, self.probes, self.rails, self.state, self.index)
    }
}

/// Rate of the rail under element `i` that its wheels pass over by their own motion, x' dG/dx F.
pub(crate) fn passing(
    mechanics: &Mechanics,
    probes: &Probes,
    rails: &RailMatrices,
    state: &State,
    i: usize,
) -> f64 {
    tangential_of(mechanics, probes, state, i)
        .map(|(contact, speed)| speed * along(&rails.tangential, contact, &state.force))
        .sum()
}

/// The tangential contacts of element `i` with their speeds along the rail.
pub(crate) fn tangential_of<'s>(
    mechanics: &'s Mechanics,
    probes: &'s Probes,
    at: &'s State,
    i: usize,
) -> impl Iterator<Item = (usize, f64)> + 's {
    let own = probes.tangential.iter().enumerate().filter(move |(_, contact)| contact.element == i);
    own.map(|(contact, TangentialContact { wheel, .. })| (contact, mechanics.speed_along(*wheel, at)))
}
