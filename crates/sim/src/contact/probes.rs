//! Where force elements load the structures: probes on rails, and the unknowns that rails without mass add.

use splines::Probe;

/// One probe of a structure: the element that it belongs to, and its signed weight there.
pub(crate) struct Entry {
    pub element: usize,
    pub weight: f64,
    pub wheel: usize,
    pub probe: Probe,
    /// The tangential contact that it belongs to, an index into [`Probes::tangential`].
    pub tangential: Option<usize>,
}

/// Wheels of one contact under an element along a rail that complies: they move alike.
pub(crate) struct TangentialContact {
    pub element: usize,
    /// The first of its wheels.
    pub wheel: usize,
}

/// All probes of a scene.
pub(crate) struct Probes {
    /// Probes of each structure.
    pub entries: Vec<Vec<Entry>>,
    /// Whether the probes of a structure are the elements in their order, with weight -1 each: the compliance of the
    /// elements is then the structure's.
    pub is_direct: Vec<bool>,
    /// Where elements along the rails load structures that comply along them.
    pub tangential: Vec<TangentialContact>,
    /// Where the state holds the penetration of each element, or the displacement of its rail along x.
    pub slots: Vec<Option<usize>>,
    /// Elements whose rails' displacement along x is a state.
    pub sliding: Vec<usize>,
}
