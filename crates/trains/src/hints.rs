//! The best arrangements at places that have been evaluated, as hints for places beside them.

use crate::plan::Arrangement;

/// An arrangement, and by how much the trains move along with the section from its place to another one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hint<'a> {
    pub at: &'a Arrangement,
    pub by: f64,
}

/// Arrangements by increasing place.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hints {
    known: Vec<(f64, Arrangement)>,
}

impl Hints {
    /// The arrangements at the nearest places on both sides.
    pub fn beside(&self, x: f64) -> Vec<Hint<'_>> {
        let next = self.known.partition_point(|(place, _)| *place < x);
        let near = self.known[next.saturating_sub(1)..].iter().take(2);
        near.map(|(place, at)| Hint { at, by: x - place }).collect()
    }

    /// Adds the arrangement at a place.
    pub fn add(&mut self, x: f64, arrangement: Arrangement) {
        let next = self.known.partition_point(|(place, _)| *place < x);
        self.known.insert(next, (x, arrangement));
    }
}
