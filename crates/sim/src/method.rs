//! The method by which the equations of motion are integrated.

use crate::passage;
use crate::system::System;
use crate::{Dynamics, Error, Foundation, Scene};

/// A method of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Series or Radau where they suit the scene, SDIRK elsewhere.
    #[default]
    Auto,
    /// SDIRK of order 4, L-stable: every scene.
    Sdirk4,
    /// Radau IIA collocation of order 5 with exact modes.
    Radau,
    /// Gauss collocation of order 4 with exact modes: conserves the energy of undamped linear contacts.
    Gauss2,
    /// Gauss collocation of order 6 with exact modes: conserves the energy of undamped linear contacts.
    Gauss3,
    /// Power series of time, of an order that grows with the accuracy: wheels without a damper to their rail that travel
    /// together at uniform speed over structures without mass. Where it meets its limits, as where a contact opens, Radau
    /// takes the whole run.
    Series,
}

/// A method of integration, and the length of its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stepping {
    /// The method.
    pub method: Method,
    /// Time of a step; all are equal but those that end at a break or an event. `None`: as the accuracy asks.
    pub step: Option<f64>,
}

impl From<Method> for Stepping {
    fn from(method: Method) -> Self {
        Stepping { method, step: None }
    }
}

impl Method {
    /// Whether the method can integrate `scene` on `foundations`.
    ///
    /// # Errors
    /// [`Error::Method`] where it cannot, with what the scene lacks; another for a scene that cannot be set up.
    pub fn suits(self, scene: &Scene, foundations: &[Foundation]) -> Result<(), Error> {
        self.check(&System::new(scene, foundations)?)
    }

    /// The method itself, or the one chosen for the scene.
    pub(crate) fn chosen(self, system: &System) -> Method {
        match self {
            Method::Auto if Method::Series.check(system).is_ok() => Method::Series,
            Method::Auto if Method::Radau.check(system).is_ok() => Method::Radau,
            Method::Auto => Method::Sdirk4,
            method => method,
        }
    }

    /// Whether the method can integrate the scene: collocation needs prescribed places, linear vertical contacts
    /// with one force a wheel and structures in natural modes of damping ratio below 1; Gauss, no damper between
    /// wheel and rail.
    pub(crate) fn check(self, system: &System) -> Result<(), Error> {
        if matches!(self, Method::Auto | Method::Sdirk4) {
            return Ok(());
        }
        let modal =
            system.foundations.iter().filter_map(|f| f.structure.as_ref()).all(|structure| match &structure
                .dynamics
            {
                Dynamics::Matrices { .. } => false,
                Dynamics::Modes { ratio, .. } => ratio.iter().all(|ratio| *ratio < 1.0),
            });
        let remembers = (0..system.normals.len()).any(|i| system.law(i).has_memory());
        let trouble = [
            (system.moves_freely, "places along the rail that are prescribed"),
            (system.components() > system.normals.len(), "vertical contacts alone"),
            (!system.linear_normals, "linear contacts"),
            (system.foundations.iter().any(|f| f.parts.is_some()), "one force a wheel"),
            (system.is_uneven, "even rails"),
            (!system.rides.is_empty(), "bodies that ride on the ground's rails"),
            (!system.ties.is_empty(), "structures on the ground"),
            (!modal, "structures in natural modes, damped below critical"),
            (self != Method::Radau && remembers, "contacts without a damper between wheel and rail"),
        ];
        let found = trouble.into_iter().find(|(found, _)| *found).map(|(_, wanted)| wanted);
        match found.or_else(|| passage::lacks(system).filter(|_| self == Method::Series)) {
            Some(wanted) => Err(Error::Method { method: self, wanted }),
            None => Ok(()),
        }
    }
}
