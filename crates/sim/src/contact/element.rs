//! The interface of all force elements.
//!
//! A force element is one unknown scalar force F_i of a stage: a vertical contact, a flange, friction below a wheel,
//! a drive, a brake, a rope or a stop. With e = R q + offset its approach, G the compliance of rails without mass and
//! W, Y the effect of all forces on penetrations and rates, a stage solves
//!
//! F = law(p, r),  p = e - W F,  r = r_0 - Y F
//!
//! by one Newton iteration that is independent of the kind of element. The trait [`Element`] describes all
//! differences between kinds: the location of an element (rows and probes), its law with slopes, the guards whose
//! change of sign ends a step, its energy, and its channels. Every method except the law has a default, so a new
//! element implements only the methods that concern it, in its own file, and is listed in `contact::elements`.

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
use crate::scene::irregularity::ShapeCell;

/// A force element.
pub(crate) trait Element {
    // Location.

    /// Writes the part of its row that is constant.
    fn constant_row(&self, _mechanics: &Mechanics, _row: &mut RowMut) {}

    /// Adds the part of its row that depends on positions and time; the shapes of the rail are added afterwards.
    fn update_row(&self, _at: &Where, _row: &mut RowMut, _local: &mut Local) {}

    /// Whether [`Element::update_row`] adds to the rows of approach and rate, which then begin with their constant
    /// parts.
    fn row_changes(&self) -> [bool; 2] {
        [false; 2]
    }

    /// Fraction of its law that acts at the present positions of the wheels, and the slope of this fraction along the
    /// rail.
    fn fraction(&self, _mechanics: &Mechanics, _places: &Places) -> Option<[f64; 2]> {
        None
    }

    /// Its probes on the rails.
    fn probes(&self, _mechanics: &Mechanics) -> Vec<ElementProbe> {
        Vec::new()
    }

    /// The body on whose displacements alone its row depends, beside the spins of its wheels and the modes of its
    /// structures; `None` if it acts between two points.
    fn body(&self, _mechanics: &Mechanics) -> Option<usize> {
        None
    }

    /// The wheel on which the slope of the deflected rail exerts a force along x, if the element acts on a wheel.
    fn tilted_wheel(&self) -> Option<usize> {
        None
    }

    /// Whether it acts along the rail. Its rate rows then load the degrees of freedom, and the longitudinal
    /// displacement of a massless rail is a state.
    fn is_tangential(&self) -> bool {
        false
    }

    /// Whether its row changes with the motion within a stage.
    fn follows_motion(&self) -> bool {
        false
    }

    /// Whether it depends on the height of its wheel above the rail.
    fn uses_height(&self) -> bool {
        false
    }

    /// The two points between which it acts, for a rope or a stop.
    fn points(&self) -> Option<&PointPair> {
        None
    }

    /// Its role in static equilibrium.
    fn role(&self) -> Role {
        Role::Absent
    }

    /// Stiffness and clearance of a flange at rest, for the height of its wheel in `_at`; `None` for other elements.
    fn flange(&self, _at: &State) -> Option<[f64; 2]> {
        None
    }

    // Force law.

    /// Whether a rule has disabled it permanently.
    fn is_released(&self, _switches: &Switches) -> bool {
        false
    }

    /// Whether it is active initially, before any decision on the active set.
    fn begins_active(&self) -> bool {
        true
    }

    /// Whether it has no force in the stage that begins with the force `_force`; its column of the mobility is then
    /// omitted.
    fn is_idle(&self, is_active: bool, _local: &Local, _force: f64) -> bool {
        !is_active
    }

    /// Whether its law depends on a rate of the degrees of freedom, which the forces of the same stage change.
    fn feels_rates(&self) -> bool {
        false
    }

    /// Whether its penetration is a state while it is active, as with a damper between wheel and rail.
    fn has_memory(&self) -> bool {
        false
    }

    /// Whether it is watched while it is idle, because it may begin to act within a stage.
    fn is_followed(&self) -> bool {
        false
    }

    /// Whether it may begin to act within the time `_h` after `_at`, where it has no force.
    fn may_act(&self, _at: &At, _h: f64) -> bool {
        true
    }

    /// Whether an idle element begins to act within a stage at the penetration `_p`.
    fn touches(&self, _p: f64) -> bool {
        false
    }

    /// Force as a function of penetration and rate, with its slopes; `None` if the element does not act. Slopes with
    /// respect to forces of other elements (and to its own force, for an implicit law) are added to `couplings`.
    fn law(&self, query: &Query, couplings: &mut Vec<Coupling>) -> Option<Law>;

    // Guards.

    /// Switching function: positive if an inactive element must become active or an active one inactive. The value is
    /// the force by which the limit is exceeded. `None` if the element is never switched.
    fn switch(&self, _at: &At, _active: &ActiveSet) -> Option<f64> {
        None
    }

    /// The kind of its guards, if it has any.
    fn guard_kind(&self) -> Option<GuardKind> {
        None
    }

    /// Quantities of its law of this guard kind, at whose change of sign the next step should begin.
    fn guards(&self, _at: &At, _put: &mut dyn FnMut(Guard)) {}

    // Energy.

    /// Adds the energy stored in the element.
    fn stored(&self, _at: &At, _energy: &mut Stored) {}

    /// Adds the power that it dissipates and supplies, without the rate of [`Element::boundary`]. It is called where the element
    /// has a force; without one it exchanges nothing.
    fn power(&self, _at: &At, _power: &mut Exchanged) {}

    /// Boundary term of the energy dissipated by its damper; [`Element::power`] omits its rate.
    fn boundary(&self, _at: &At) -> f64 {
        0.0
    }

    /// Its contribution to the force along +x that is required for the prescribed motion of root body `_b`.
    fn resistance(&self, _at: &At, _b: usize) -> f64 {
        0.0
    }

    // Channels.

    /// Channels to which its force is added, each with a divisor.
    fn channels(&self, _mechanics: &Mechanics) -> Vec<(Channel, f64)> {
        Vec::new()
    }

    /// Its own channels in a history, in their order, in addition to those of bodies and wheels.
    fn own_channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    /// The channel of the distance between its two points.
    fn length_channel(&self) -> Option<Channel> {
        None
    }
}

/// Constant properties of an element, stored for fast access in the innermost loops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixed {
    pub feels_rates: bool,
    pub has_memory: bool,
    pub is_followed: bool,
    pub is_tangential: bool,
    pub row_changes: [bool; 2],
}

impl Fixed {
    /// The constant properties of `element`.
    pub fn of(element: &dyn Element) -> Self {
        Fixed {
            feels_rates: element.feels_rates(),
            has_memory: element.has_memory(),
            is_followed: element.is_followed(),
            is_tangential: element.is_tangential(),
            row_changes: element.row_changes(),
        }
    }
}

/// Role of an element in static equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// It carries weight.
    Carries,
    /// It guides wheels laterally.
    Guides,
    /// It is a spring between two points.
    Spring,
    /// It has no force at rest.
    Absent,
}

/// The state at which rows are evaluated.
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
    /// Weight, positive along the axis of the probe.
    pub weight: f64,
    pub axis: Axis,
    /// The rigid part on which it acts, if every part has its own force.
    pub part: Option<usize>,
}

/// Properties of an element, other than its row, that change with the state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    /// Fraction of the law that acts, and its slope along the rail.
    pub fraction: [f64; 2],
    /// Whether a drive or a brake is on.
    pub is_on: bool,
    /// The spring of a rope or a stop.
    pub spring: Spring,
    /// The shape of the unloaded rail about the element.
    pub shape: ShapeCell,
}

impl Default for Local {
    fn default() -> Self {
        Local {
            fraction: [1.0, 0.0],
            is_on: false,
            spring: Spring::default(),
            shape: ShapeCell::default(),
        }
    }
}

/// Spring and damper between two points at one state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spring {
    pub stiffness: f64,
    pub damping: f64,
    /// Unit vector along which the approach increases: from `from` to `to` for a rope, into the stop for a stop.
    pub direction: [f64; 3],
    /// Distance between the ends of a rope, or penetration of a stop.
    pub length: f64,
    /// Unstretched length of a rope, and its rate.
    pub unstretched: [f64; 2],
    /// Force below which rounding of the positions makes the active state undecidable.
    pub noise: f64,
}

/// Arguments of a force law.
pub(crate) struct Query<'q> {
    /// Index of the element.
    pub index: usize,
    /// Rate on which the law depends.
    pub rate: f64,
    /// Penetration and rate of every element under the present forces.
    pub reached: &'q [[f64; 2]],
    /// Present forces.
    pub force: &'q [f64],
    pub local: &'q Local,
    /// Whether the element may act.
    pub is_active: bool,
    /// Decrease of the element's rate per unit of its own force.
    pub fall: f64,
    /// Whether the law of an element that presses is continued to where it would separate.
    pub continues: bool,
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
    /// Another element, and the slope with respect to its penetration.
    pub by_other: Option<(usize, f64)>,
}

/// Slope of the law of `element` with respect to the force of element `by`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupling {
    pub element: usize,
    pub by: usize,
    pub slope: f64,
}

/// A quantity of a law that changes sign at a kink of the law.
pub(crate) struct Guard {
    pub value: f64,
    /// Force per unit of the quantity; changes that correspond to negligible forces are ignored.
    pub stiffness: f64,
}

/// Treatment of a guard by a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GuardKind {
    /// Checked only if the error of the step exceeds its tolerance; located on the interpolant.
    Touch,
    /// Checked in every step; located by the secant between both ends.
    Corner,
}

/// A scene at one state, with the rows and matrices of this state.
pub(crate) struct Frame<'c> {
    pub mechanics: &'c Mechanics<'c>,
    pub probes: &'c Probes,
    pub state: &'c State,
    pub rows: &'c Rows,
    pub rails: &'c RailMatrices,
    pub places: &'c Places,
    pub switches: &'c Switches,
    /// Properties of every element, other than its row, that change with the state.
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

    /// Its properties, other than its row, that change with the state.
    #[inline]
    pub fn local(&self) -> &Local {
        &self.frame.local[self.index]
    }

    /// Slope of the deflected rail at the element.
    #[inline]
    pub fn rail_slope(&self) -> f64 {
        self.frame.rail_slope[self.index]
    }

    /// Its approach without the deflection of the rail.
    #[inline]
    pub fn approach(&self) -> f64 {
        self.rows.approach_at(self.index, &self.state.q)
    }

    /// Deflection of the massless rail.
    #[inline]
    pub fn deflection(&self) -> f64 {
        self.rails.deflection(self.index, &self.state.force)
    }

    /// Its rate due to the degrees of freedom alone.
    #[inline]
    pub fn rate(&self) -> f64 {
        self.rate_of(self.index)
    }

    /// Rate of element `i` due to the degrees of freedom alone.
    #[inline]
    pub fn rate_of(&self, i: usize) -> f64 {
        self.rows.rate_at(i, &self.state.v)
    }

    /// Elastic energy of the rails due to its force.
    pub fn rail_energy(&self) -> f64 {
        0.5 * self.force() * self.deflection()
    }

    /// Sliding rate of its law along the rail: the rate of its wheels minus that of the rail.
    pub fn slip(&self) -> f64 {
        let own = self.rate();
        if self.probes.sliding.is_empty() {
            return own;
        }
        let rail = self.probes.slots[self.index].map_or(0.0, |slot| self.state.p_rate[slot]);
        own - rail
            + passing(
                self.mechanics,
                self.probes,
                self.rails,
                self.state,
                self.index,
            )
    }
}

/// Rate of the rail displacement under element `i` due to the motion of its wheels along the rail, x' dG/dx F.
pub(crate) fn passing(
    mechanics: &Mechanics,
    probes: &Probes,
    rails: &RailMatrices,
    state: &State,
    i: usize,
) -> f64 {
    tangential_of(mechanics, probes, state, i)
        .map(|(contact, speed)| speed * rails.tangential_slope(contact, &state.force))
        .sum()
}

/// The tangential contacts of element `i` with the speeds of their wheels along the rail.
pub(crate) fn tangential_of<'s>(
    mechanics: &'s Mechanics,
    probes: &'s Probes,
    at: &'s State,
    i: usize,
) -> impl Iterator<Item = (usize, f64)> + 's {
    let own = probes
        .tangential
        .iter()
        .enumerate()
        .filter(move |(_, contact)| contact.element == i);
    own.map(|(contact, TangentialContact { wheel, .. })| {
        (contact, mechanics.speed_along(*wheel, at))
    })
}
