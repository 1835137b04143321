//! All faults of a text: those of its types, and those that a check finds in the values.
//!
//! A value of the wrong type is left out, and the remainder is checked nevertheless. The check can then find faults
//! that are only consequences, for example a missing key whose value is there and has the wrong type. A fault of the
//! remainder is reported if it is independent of what is left out:
//!
//! - It does not concern a value that is left out, a part of it, or an object or list around it, except a missing key
//!   that is another one.
//! - It follows from its value alone, or it is a reference to an unknown name, and no item and no name is left out.

use serde::de::DeserializeOwned;

use super::convert::{Conversion, Located, convert};
use super::fault::{Basis, Fault, Faults};
use super::place::{Path, Step};
use super::tree::TreeNode;

/// The result of a conversion and its check.
#[derive(Debug)]
pub(crate) struct Examined<R> {
    /// The result of the check, if all types are right.
    pub value: Option<R>,
    /// The faults of types and keys.
    pub types: Vec<Located>,
    /// The faults that the check found.
    pub faults: Faults,
}

/// Converts a tree and checks the value. The check begins with the faults of types in its list of faults, so that it
/// can omit what needs a faultless text.
pub(crate) fn examine<T: DeserializeOwned, R>(
    root: &TreeNode<'_>,
    check: impl FnOnce(&T, &mut Faults) -> Option<R>,
) -> Examined<R> {
    let Conversion {
        value,
        faults: types,
        lost,
    } = convert::<T>(root);
    let mut faults = Faults(types.iter().map(|located| located.fault.clone()).collect());
    let value = value
        .and_then(|value| check(&value, &mut faults))
        .filter(|_| types.is_empty());
    let mut faults = Faults(faults.0.split_off(types.len()));
    faults.0.retain(|fault| is_independent(fault, &lost));
    Examined {
        value,
        types,
        faults,
    }
}

/// Whether a fault of the remainder does not follow from the loss of values.
fn is_independent(fault: &Fault, lost: &[Path]) -> bool {
    lost.iter().all(|lost| {
        let (here, gone) = (fault.path.0.as_slice(), lost.0.as_slice());
        let is_inside = here.starts_with(gone);
        let is_around = gone.starts_with(here) && !misses_another_key(fault, gone.get(here.len()));
        let is_certain = match fault.basis {
            Basis::Value => true,
            Basis::Names => !may_have_name(gone),
            Basis::Several => false,
        };
        is_certain && !is_inside && !is_around
    })
}

/// Whether a fault is a missing key other than `key`.
fn misses_another_key(fault: &Fault, key: Option<&Step>) -> bool {
    let named = fault
        .expected
        .strip_prefix("missing key `")
        .and_then(|rest| rest.split_once('`'));
    named.is_some_and(|(named, _)| !matches!(key, Some(Step::Key(key)) if key == named))
}

/// Whether a value can be a named item, a list or object of them, or the name of one.
fn may_have_name(path: &[Step]) -> bool {
    path.len() <= 2
        || match path.last() {
            Some(Step::Key(key)) => key == "name",
            Some(Step::Index(_)) | None => true,
        }
}
