//! Foundation of a rail: a compliance and, where its mass is modelled, a structure with degrees of freedom of its
//! own.
//!
//! M q'' + C q' + K q = Phi^T F, (G + diag(1/k)) F = d - Phi q. A rigid foundation has neither G nor q, an influence
//! foundation has G only, and parts have q only (or, without mass, G = Phi K^-1 Phi^T).

use splines::Compliance;

use super::carrier::Carrier;
use super::irregularity::Irregularity;
use super::parts::PartChain;
use super::structure::Structure;

/// Extent of one rail.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extent {
    /// First and last coordinate; `None`: infinite rail.
    pub range: Option<[f64; 2]>,
    /// Coordinates at which the deflection of the rail is less smooth: supports, hinges, table stations, hand-overs.
    pub breaks: Vec<f64>,
}

/// One structure as it acts on the wheels.
///
/// [`Foundation::default`] is a rigid rail of infinite length, and [`Foundation::massless`] is a compliance without
/// mass. A foundation with a [`structure`](Foundation::structure) has mass.
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
    /// Compliance G; `None`: rigid except for the degrees of freedom of `structure`.
    pub compliance: Option<Box<dyn Compliance>>,
    /// Degrees of freedom with mass.
    pub structure: Option<Structure>,
    /// Chains of rigid parts, each part with a contact force of its own. The wheels on rail r are in contact with
    /// each part of chain r separately, and the rails of `compliance` and `structure` are the parts
    /// ([`PartChain::rail`]). `None`: one force per wheel.
    pub parts: Option<Vec<PartChain>>,
    /// Extents of the rails; empty: infinite rails without breaks.
    pub rails: Vec<Extent>,
    /// Whether the history records the degrees of freedom of the structure and their accelerations.
    pub recorded: bool,
    /// Whether friction, drives and brakes load the structure along its rails and depend on the velocity of the
    /// rails.
    pub is_loaded_along: bool,
    /// Irregularities of the unloaded rails; empty: straight rails.
    pub irregularities: Vec<Irregularity>,
    /// Body that carries the structure with all its supports; `None`: the ground.
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
        let extent = |rail| Extent {
            range: compliance.range(rail),
            breaks: compliance.breaks(rail),
        };
        Foundation {
            rails: (0..rails).map(extent).collect(),
            compliance: Some(compliance),
            ..Foundation::default()
        }
    }

    /// Number of degrees of freedom with mass.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.structure
            .as_ref()
            .map_or(0, |structure| structure.dynamics.dofs())
    }
}
