//! Methods of integration of the equations of motion.

/// A method of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// `Series` or `Radau` where they are suited to the scene, and `Esdirk5` otherwise.
    #[default]
    Auto,
    /// SDIRK method of order 4, L-stable. It is applicable to every scene.
    Sdirk4,
    /// ESDIRK method of order 5, L-stable, whose stages have the order 2; steps after breaks and events are of the SDIRK method
    /// of order 4. It is applicable to every scene, and takes half as many steps as that method.
    Esdirk5,
    /// Radau IIA collocation with exact integration of the modes: five nodes and the order 9, or three and the order 5
    /// where dampers act between wheels and rails.
    Radau,
    /// Gauss collocation of order 4 with exact integration of the modes. It conserves the energy of undamped linear
    /// contacts.
    Gauss2,
    /// Gauss collocation of order 6 with exact integration of the modes. It conserves the energy of undamped linear
    /// contacts.
    Gauss3,
    /// Power series in time, of order 18. It requires wheels without a damper to
    /// their rail that travel together at uniform speed over structures without mass. Where the method is not
    /// applicable, for example where a contact opens, the whole run is repeated with Radau.
    Series,
}

/// A method of integration and its step size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stepping {
    /// The method.
    pub method: Method,
    /// Time step; all steps are equal except those that end at a break or an event. `None`: the step follows from the
    /// accuracy.
    pub step: Option<f64>,
}

impl From<Method> for Stepping {
    fn from(method: Method) -> Self {
        Stepping { method, step: None }
    }
}
