//! Sets of nodes and elements by name.

use std::collections::{BTreeMap, BTreeSet};

use super::keyword::KeywordBlock;
use super::values::{key_of, number_of, whole};
use crate::findings::{ImportFinding, ImportFindings};

/// Largest number of entries of all sets together. Sets may contain others, so that small files could define more.
const MOST_ENTRIES: usize = 10_000_000;

/// Numbers from the first to the second with the third as step.
type SetRange = [u64; 3];

/// A set as the file defines it.
#[derive(Clone, Debug, Default)]
pub struct InpSet {
    /// Its name as first written.
    pub name: String,
    entries: BTreeSet<SetRange>,
}

/// Sets by the keys of their names.
#[derive(Clone, Debug, Default)]
pub struct InpSets {
    sets: BTreeMap<String, InpSet>,
    entries: usize,
}

impl InpSets {
    /// The sets in the order of their keys.
    pub fn iter(&self) -> impl Iterator<Item = &InpSet> {
        self.sets.values()
    }

    /// The set with a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&InpSet> {
        self.sets.get(&key_of(name))
    }

    /// Adds a number to a set, which is made if it does not exist.
    pub fn add(&mut self, name: &str, number: u64) {
        self.add_range(name, [number, number, 1]);
    }

    /// The set with a name, which is made if it does not exist.
    pub fn define(&mut self, name: &str) -> &mut InpSet {
        let set = self.sets.entry(key_of(name)).or_default();
        if set.name.is_empty() {
            name.trim().clone_into(&mut set.name);
        }
        set
    }

    fn add_range(&mut self, name: &str, range: SetRange) {
        let is_new = self.define(name).entries.insert(range);
        self.entries += usize::from(is_new);
    }

    /// Reads *NSET or *ELSET, of which `parameter` is the name of the set.
    pub fn read(&mut self, block: &KeywordBlock, parameter: &str, findings: &mut ImportFindings) {
        let Some(name) = block
            .required(parameter, findings)
            .map(|name| name.text.clone())
        else {
            return;
        };
        let generates = block.parameter("GENERATE").is_some();
        for line in &block.data {
            if self.entries > MOST_ENTRIES {
                let expected = format!("exceeds the limit of {MOST_ENTRIES} entries of all sets");
                findings.error(ImportFinding::new(block.at, block.label(), expected));
                return;
            }
            if generates {
                let first = whole(block, line, 0, "first number", findings);
                let last = whole(block, line, 1, "last number", findings);
                let step = if line.len() > 2 {
                    whole(block, line, 2, "increment", findings)
                } else {
                    Some(1)
                };
                if let (Some(first), Some(last), Some(step)) = (first, last, step) {
                    self.add_range(&name, [first, last, step]);
                }
                continue;
            }
            for field in line.iter().filter(|field| !field.text.is_empty()) {
                if let Some(number) = number_of(&field.text) {
                    self.add(&name, number);
                } else if let Some(other) = self.get(&field.text) {
                    for range in other.entries.clone() {
                        self.add_range(&name, range);
                    }
                } else {
                    let expected = "must be a number or the name of a previously defined set";
                    let finding = ImportFinding::new(field.at, block.label(), expected);
                    findings.error(finding.with_found(&field.text));
                }
            }
        }
        self.define(&name);
    }
}

impl InpSet {
    /// The numbers of the set that are keys of `known`, in increasing order.
    pub fn numbers<T>(&self, known: &BTreeMap<u64, T>) -> Vec<u64> {
        let mut found = BTreeSet::new();
        for &[first, last, step] in &self.entries {
            if first <= last {
                let inside = known.range(first..=last).map(|(number, _)| *number);
                found.extend(inside.filter(|number| (number - first) % step == 0));
            }
        }
        found.into_iter().collect()
    }
}
