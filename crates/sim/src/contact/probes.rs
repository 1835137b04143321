//! Load points of the force elements on the structures: probes on rails, and the additional states of massless rails.

use splines::Probe;

/// One probe of a structure: its element, and its signed weight in that element.
pub(crate) struct Entry {
    pub element: usize,
    pub weight: f64,
    pub wheel: usize,
    pub probe: Probe,
    /// The tangential contact of the probe, an index into [`Probes::tangential`].
    pub tangential: Option<usize>,
}

/// Wheels of one contact below one element along a compliant rail; they have the same motion along the rail.
pub(crate) struct TangentialContact {
    pub element: usize,
    /// The first of its wheels.
    pub wheel: usize,
}

/// All probes of a scene.
pub(crate) struct Probes {
    /// Probes of each structure.
    pub entries: Vec<Vec<Entry>>,
    /// Whether the probes of a structure are the elements in their order, each with weight -1. The compliance between
    /// the elements is then that of the structure.
    pub is_direct: Vec<bool>,
    /// Contacts of tangential elements with structures that are compliant along their rails.
    pub tangential: Vec<TangentialContact>,
    /// Index in the state of the penetration of each element, or of the longitudinal displacement of its rail.
    pub slots: Vec<Option<usize>>,
    /// Elements for which the longitudinal displacement of the rail is a state.
    pub sliding: Vec<usize>,
    /// Elements for which this or the penetration is a state.
    pub states: Vec<usize>,
}
