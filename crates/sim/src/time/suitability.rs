//! Suitability of the methods of integration for a scene.

use crate::contact::system::System;
use crate::time::passage::crossing::missing;
use crate::{Dynamics, Error, Foundation, Method, Scene};

/// Number of contacts with dampers between wheel and rail, or with laws that are not linear, from which stages one by one cost
/// less than the system of all forces at all nodes of a collocation step.
const MANY: usize = 12;

/// Whether collocation would have to solve a large system; see [`MANY`]. Forces of other contacts are eliminated node by node.
/// On structures with mass stages would have the order two under these dampers.
fn is_large(system: &System) -> bool {
    let traits = &system.traits;
    let is_coupled = traits.has_memory || !traits.has_linear_laws;
    is_coupled && system.verticals() >= MANY && !system.mechanics.has_structures()
}

impl Method {
    /// Checks whether the method can integrate `scene` on `foundations`.
    ///
    /// # Errors
    /// [`Error::Method`] if it cannot, with the property that the scene would need; another error if the scene cannot
    /// be set up.
    pub fn suits(self, scene: &Scene, foundations: &[Foundation]) -> Result<(), Error> {
        self.check(&System::new(scene, foundations)?)
    }

    /// The method itself or, for `Auto`, the method chosen for the scene.
    pub(crate) fn chosen(self, system: &System) -> Method {
        match self {
            Method::Auto if Method::Series.check(system).is_ok() => Method::Series,
            Method::Auto if Method::Radau.check(system).is_ok() && !is_large(system) => {
                Method::Radau
            }
            Method::Auto => Method::Esdirk5,
            method => method,
        }
    }

    /// Checks whether the method can integrate the scene. Collocation needs prescribed positions along the rail,
    /// vertical contacts with one force per wheel, and structures in natural modes with damping ratios below
    /// 1. Gauss collocation also needs contacts without a damper between wheel and rail.
    pub(crate) fn check(self, system: &System) -> Result<(), Error> {
        if matches!(self, Method::Auto | Method::Sdirk4 | Method::Esdirk5) {
            return Ok(());
        }
        let modal = system
            .foundations
            .iter()
            .filter_map(|f| f.structure.as_ref())
            .all(|structure| match &structure.dynamics {
                Dynamics::Matrices { .. } => false,
                Dynamics::Modes { ratio, .. } => ratio.iter().all(|ratio| *ratio < 1.0),
            });
        let trouble = [
            (
                system.mechanics.moves_freely,
                "prescribed positions along the rail",
            ),
            (!system.traits.is_vertical, "only vertical contacts"),
            (
                system.foundations.iter().any(|f| f.parts.is_some()),
                "one contact force per wheel",
            ),
            (
                !system.mechanics.carried.is_empty(),
                "bodies on rails that are supported on the ground",
            ),
            (
                !system.mechanics.couplings.is_empty(),
                "structures supported on the ground",
            ),
            (
                !modal,
                "structures represented by underdamped natural modes",
            ),
            (
                self != Method::Radau && system.traits.has_memory,
                "contacts without a damper between wheel and rail",
            ),
        ];
        let found = trouble
            .into_iter()
            .find(|(found, _)| *found)
            .map(|(_, wanted)| wanted);
        match found.or_else(|| missing(system).filter(|_| self == Method::Series)) {
            Some(wanted) => Err(Error::Method {
                method: self,
                wanted,
            }),
            None => Ok(()),
        }
    }
}
