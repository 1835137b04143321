//! What carries a rail: a compliance, and where its mass counts a structure with degrees of freedom of its own.
//!
//! M q'' + C q' + K q = Phi^T F, (G + diag(1/k)) F = d - Phi q: rigid has neither G nor q, influence has G
//! alone, parts have q alone (or, without mass, G = Phi K^-1 Phi^T).

use splines::Compliance;

use super::carrier::Carrier;
use super::irregularity::Irregularity;
use super::parts::PartChain;
use super::structure::Structure;

/// One rail's extent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extent {
    /// First and last coordinate; `None`: without end.
    pub range: Option<[f64; 2]>,
    /// Coordinates where the deflection of the rail is less smooth: supports, hinges, stations, hand-overs.
    pub breaks: Vec<f64>,
}

/// One structure as the wheels feel it.
///
/// [`Foundation::default`] is a rigid rail without end; [`Foundation::massless`] is a compliance without mass; with a
/// [`structure`](Foundation::structure) it has mass.
/// ```
/// use sim::{Extent, Foundation};
///
/// // A rigid rail from 0 to 30 m with a joint at 12 m, where steps end.
/// let extent = Extent { range: Some([0.0, 30.0]), breaks: vec![12.0] };
/// let foundation = Foundation { rails: vec![extent], ..Foundation::rigid() };
/// assert_eq!(foundation.dofs(), 0);
/// ```
#[derive(Default)]
pub struct Foundation {
    /// G; `None`: rigid beside the degrees of freedom of `structure`.
    pub compliance: Option<Box<dyn Compliance>>,
    /// Freedoms with mass.
    pub structure: Option<Structure>,
    /// One force a part: the wheels of rail r feel each rigid part of chain r on its own, and the rails of
    /// `compliance` and `structure` are the parts ([`PartChain::rail`]). `None`: one force a wheel.
    pub parts: Option<Vec<PartChain>>,
    /// Extents of the rails; empty: rails without end or break.
    pub rails: Vec<Extent>,
    /// Whether histories hold its degrees of freedom and their accelerations.
    pub recorded: bool,
    /// Whether friction, drives and brakes load the structure along its rails, and feel their speed.
    pub is_loaded_along: bool,
    /// Shapes of the rails when nothing loads them; empty: straight.
    pub irregularities: Vec<Irregularity>,
    /// The body that carries the structure, all its supports in it; `None`: the ground.
    pub carrier: Option<Carrier>,
}

impl Foundation {
    /// A rigid rail.
    #[must_use]
    pub fn rigid() -> Self {
        Foundation::default()
    }

    /// A massless structure of `rails` rails.
    #[must_use]
    pub fn massless(compliance: Box<dyn Compliance>, rails: usize) -> Self {
        let extent = |rail| Extent { range: compliance.range(rail), breaks: compliance.breaks(rail) };
        Foundation {
            rails: (0..rails).map(extent).collect(),
            compliance: Some(compliance),
            ..Foundation::default()
        }
    }

    /// Coordinates along `rail` at which steps must end, between `a` and `b` in either order.
    pub(crate) fn breaks_between(&self, rail: usize, a: f64, b: f64) -> impl Iterator<Item = f64> + '_ {
        let (low, high) = (a.min(b), a.max(b));
        let own = self.rails.get(rail).map_or(&[][..], |extent| &extent.breaks);
        let corners = self.irregularities.get(rail).map_or(&[][..], Irregularity::breaks);
        let first = corners.partition_point(|x| *x < low);
        let near = corners[first..].iter().take_while(move |x| **x <= high);
        own.iter().filter(move |x| (low..=high).contains(*x)).chain(near).copied()
    }

    /// Number of degrees of freedom with mass.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.structure.as_ref().map_or(0, |structure| structure.dynamics.dofs())
    }
}
