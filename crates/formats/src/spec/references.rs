//! References within a spec: indices, names of sections and of point sets, keywords of degrees of freedom.

use super::block::Reference;
use super::words::DOF_WORDS;
use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::names::resolve;
use crate::text::place::Place;

/// The points of a spec, for the resolution of references to them.
pub(super) struct Points<'s> {
    /// Number of points.
    pub count: usize,
    /// Indices of points by the name of their set.
    pub sets: &'s [(String, Vec<usize>)],
}

impl Points<'_> {
    /// The points to which an index or the name of a point set refers. All of them exist.
    pub fn all(
        &self,
        given: &Option<Reference>,
        key: &str,
        at: &Place<'_>,
        check: &mut Check<'_>,
    ) -> Vec<usize> {
        match check.faults.require(given, at, key) {
            None => Vec::new(),
            Some(Reference::Index(index)) => {
                let exists = index_below(*index, self.count, "points", &at.key(key), check);
                if exists { vec![*index] } else { Vec::new() }
            }
            Some(name) => {
                let names: Vec<(&str, usize)> = self
                    .sets
                    .iter()
                    .enumerate()
                    .map(|(index, (name, _))| (name.as_str(), index))
                    .collect();
                let set = refer(name, &names, "point set", &at.key(key), check);
                // points that do not exist are reported in the set itself
                let all = set
                    .map(|set| self.sets[set].1.as_slice())
                    .unwrap_or_default();
                all.iter()
                    .copied()
                    .filter(|point| *point < self.count)
                    .collect()
            }
        }
    }

    /// The single point to which an index or the name of a point set refers. A set of several points is a fault.
    pub fn one(
        &self,
        given: &Option<Reference>,
        key: &str,
        at: &Place<'_>,
        check: &mut Check<'_>,
    ) -> Option<usize> {
        let before = check.faults.0.len();
        let found = self.all(given, key, at, check);
        if found.len() != 1 && check.faults.0.len() == before {
            let fault = Fault::new(&at.key(key), "must be one point")
                .got(format!("a set of {}", found.len()));
            check
                .faults
                .add(fault.hint("only supports accept sets of several points"));
        }
        found.first().copied().filter(|_| found.len() == 1)
    }
}

/// Index of the list item to which an index or a name refers; a fault if there is none. `what` is the kind of item,
/// such as "section".
pub(super) fn refer(
    given: &Reference,
    names: &[(&str, usize)],
    what: &str,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<usize> {
    match given {
        Reference::Index(index) => {
            index_below(*index, names.len(), &format!("{what}s"), at, check).then_some(*index)
        }
        Reference::Name(name) => resolve(name, names, what, at, check.faults),
    }
}

/// Whether an index is below `count`; a fault if it is not. `what` is the kind of items, such as "points".
pub(super) fn index_below(
    index: usize,
    count: usize,
    what: &str,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> bool {
    if index >= count {
        let fault =
            Fault::new(at, format!("must be below {count}, the number of {what}")).got(index);
        check.faults.add(fault.hint("indices count from 0"));
    }
    index < count
}

/// Reads a list of degrees of freedom, each at most once, as flags in the order ux, uy, uz, rx, ry, rz.
pub(super) fn dofs(words: &[String], at: &Place<'_>, check: &mut Check<'_>) -> [bool; 6] {
    let mut set = [false; 6];
    for (index, word) in words.iter().enumerate() {
        let item = at.index(index);
        let Some(dof) = check.faults.one_of(word, &item, &DOF_WORDS) else {
            continue;
        };
        if set[dof as usize] {
            check.faults.add(
                Fault::new(&item, "must be listed only once").got(format!("\"{word}\" again")),
            );
        }
        set[dof as usize] = true;
    }
    set
}
