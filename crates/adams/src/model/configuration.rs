//! The configuration that expressions and forces are evaluated on.

use super::part::Marker;
use crate::Scalar;
use crate::kinematics::Frame;

/// Frames, times and values at one instant, indexed as in the model.
pub(crate) struct Configuration<T> {
    /// The value of TIME, in s.
    pub time: f64,
    /// The value of MODE.
    pub mode: f64,
    /// One for each marker.
    pub frames: Vec<Frame<T>>,
    pub ground: Frame<T>,
    /// One for each slot.
    pub values: Vec<T>,
    /// DIF of each DIFF.
    pub differentials: Vec<T>,
}

impl<T: Scalar> Configuration<T> {
    /// MODE at a given state.
    pub const DYNAMIC: f64 = 4.0;
    /// MODE in static equilibrium.
    pub const STATIC: f64 = 5.0;

    /// The configuration of parts with these frames; all `slots` values are zero.
    ///
    /// A floating marker is at the position of the marker that it follows, parallel to its own part.
    pub fn new(markers: &[Marker], parts: &[Frame<T>], slots: usize) -> Configuration<T> {
        let fixed = |marker: &Marker| parts[marker.part].marker(marker.position, marker.axes);
        let place = |marker: &Marker| match marker.follows.and_then(|k| markers.get(k)) {
            Some(leader) if marker.floating => {
                parts[marker.part].parallel_at(&fixed(leader).origin)
            }
            _ => fixed(marker),
        };
        Configuration {
            time: 0.0,
            mode: Self::DYNAMIC,
            frames: markers.iter().map(place).collect(),
            ground: Frame::ground(),
            values: vec![T::constant(0.0); slots],
            differentials: Vec::new(),
        }
    }

    /// The frame of a marker; `None` is ground.
    pub fn frame(&self, marker: Option<usize>) -> &Frame<T> {
        marker
            .and_then(|k| self.frames.get(k))
            .unwrap_or(&self.ground)
    }
}
