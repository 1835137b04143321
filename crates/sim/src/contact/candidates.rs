//! The elements whose forces are sought in a step: the contact search.
//!
//! Most flanges of a crane are far from their rails most of the time. An element that cannot touch within a step has no
//! force in its stages, so neither its row nor the deflection of the rail below it is evaluated there. At the end of the
//! step all elements are evaluated again, and an element that touches there ends the step at the touch.

/// A set of elements, as a list in their order and as flags.
#[derive(Clone)]
pub(crate) struct Candidates {
    list: Vec<usize>,
    has: Vec<bool>,
}

impl Candidates {
    /// All of `count` elements.
    pub fn all(count: usize) -> Self {
        Candidates {
            list: (0..count).collect(),
            has: vec![true; count],
        }
    }

    /// Sets the elements to those for which `may_act` returns true.
    pub fn choose(&mut self, may_act: impl Fn(usize) -> bool) {
        self.list.clear();
        for (i, has) in self.has.iter_mut().enumerate() {
            *has = may_act(i);
            if *has {
                self.list.push(i);
            }
        }
    }

    /// The elements in their order.
    #[inline]
    pub fn list(&self) -> &[usize] {
        &self.list
    }

    /// Whether element `i` is one of them.
    #[inline]
    pub fn has(&self, i: usize) -> bool {
        self.has[i]
    }

    /// Whether no element is missing.
    pub fn are_all(&self) -> bool {
        self.list.len() == self.has.len()
    }
}
