//! The method by which the equations of motion are integrated.

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
    /// Power series of time, of an order that grows with the accuracy: wheels without a damper to their rail that
    /// travel together at uniform speed over structures without mass. Where it meets its limits, as where a contact
    /// opens, Radau takes the whole run.
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
