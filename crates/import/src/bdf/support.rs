//! Supports SPC, SPC1 and SPCADD, and the selection of the sets that apply.

use std::collections::{BTreeMap, BTreeSet};

use super::fields::CardFields;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// Grids and the degrees of freedom that a set restrains at each of them.
#[derive(Clone, Debug)]
pub struct SupportCard {
    /// Number of the set.
    pub set: u64,
    /// Position of its card.
    pub card: FilePlace,
    /// Numbers of grids, each with the position of its field.
    pub grids: Vec<(u64, FilePlace)>,
    /// Ranges of grid numbers, ends included; numbers to which no grid belongs are ignored.
    pub ranges: Vec<[u64; 2]>,
    /// Restrained degrees of freedom.
    pub fix: [bool; 6],
}

/// Reads SPC, which names up to two grids. Prescribed displacements are a load: they are left out, with a warning, if
/// `without_loads` is set.
pub fn spc(card: &mut CardFields<'_, '_>, without_loads: bool) -> Vec<SupportCard> {
    let mut supports = Vec::new();
    let Some(set) = card.id(1, "SID") else {
        return supports;
    };
    for first in [2, 5] {
        if first == 5 && (5..8).all(|index| card.blank(index)) {
            continue;
        }
        let grid = card.id(first, "G");
        let fix = card.freedoms(first + 1, "C");
        let moved = if without_loads {
            card.real_or(first + 2, "D", 0.0).map(|value| {
                if value != 0.0 {
                    let left = card.fault(
                        first + 2,
                        "D",
                        "is ignored: the displacement of the support is taken as 0",
                    );
                    card.findings.warn(left);
                }
            })
        } else {
            let hint = "prescribed displacements are not supported; --skip-unused takes them as 0";
            card.zero(first + 2, "D", hint)
        };
        if let (Some(grid), Some(fix), Some(())) = (grid, fix, moved) {
            let grids = vec![(grid, card.at(first))];
            supports.push(SupportCard {
                set,
                card: card.card.at,
                grids,
                ranges: Vec::new(),
                fix,
            });
        }
    }
    card.end(8);
    supports
}

/// Reads SPC1, which contains grids and ranges of grids.
pub fn spc1(card: &mut CardFields<'_, '_>) -> Option<SupportCard> {
    let set = card.id(1, "SID")?;
    let fix = card.freedoms(2, "C")?;
    let last = card.last();
    let mut support = SupportCard {
        set,
        card: card.card.at,
        grids: Vec::new(),
        ranges: Vec::new(),
        fix,
    };
    let mut index = 3;
    while index <= last {
        if card.blank(index) {
            index += 1;
            continue;
        }
        let at = card.at(index);
        let from = card.id(index, "G")?;
        if card.text(index + 1) == "THRU" {
            let to = card.id(index + 2, "G")?;
            if to < from {
                card.refuse(
                    index + 2,
                    "G",
                    "must not be less than the grid number before THRU",
                    "",
                );
                return None;
            }
            support.ranges.push([from, to]);
            index += 3;
        } else {
            support.grids.push((from, at));
            index += 1;
        }
    }
    if support.grids.is_empty() && support.ranges.is_empty() {
        card.refuse(
            3,
            "G1",
            "is missing",
            "specify the grids that the set restrains",
        );
    }
    Some(support)
}

/// Reads SPCADD, which defines a set as the union of others.
pub fn spcadd(card: &mut CardFields<'_, '_>) -> Option<(u64, Vec<u64>)> {
    let set = card.id(1, "SID")?;
    let mut parts = Vec::new();
    for index in 2..=card.last() {
        if !card.blank(index) {
            parts.push(card.id(index, "S")?);
        }
    }
    Some((set, parts))
}

/// Returns the numbers of the sets that restrain the structure; an SPCADD set is replaced by its parts.
///
/// `asked` is the set that the user selected, `controlled` whether the deck has case control, and `control` the sets
/// that case control selects, with their positions. The selection of the user has priority. If neither selects a
/// set, the deck must have a single one.
pub fn chosen(
    supports: &[SupportCard],
    adds: &BTreeMap<u64, Vec<u64>>,
    asked: Option<u64>,
    controlled: bool,
    control: &[(u64, FilePlace)],
    findings: &mut ImportFindings,
) -> BTreeSet<u64> {
    let plain: BTreeSet<u64> = supports.iter().map(|support| support.set).collect();
    let known: Vec<String> = plain
        .iter()
        .chain(adds.keys())
        .map(u64::to_string)
        .collect();
    let list = if known.is_empty() {
        "there are no sets".to_owned()
    } else {
        format!("known sets: {}", known.join(", "))
    };
    let selected: BTreeSet<u64> = control.iter().map(|(set, _)| *set).collect();
    let first = control.first().map_or(FilePlace::default(), |(_, at)| *at);
    let (set, at) = match (asked, selected.len()) {
        (Some(set), _) => (set, FilePlace::default()),
        (None, 1) => (*selected.first().unwrap_or(&0), first),
        (None, 0) => match only_set(supports, adds, controlled, &list, findings) {
            Some(only) => (only, FilePlace::default()),
            None => return BTreeSet::new(),
        },
        (None, _) => {
            let finding = ImportFinding::new(first, "SPC", "must be the same in all subcases");
            findings.error(finding.hint(format!("select one with --spc N; {list}")));
            return BTreeSet::new();
        }
    };
    if let Some(parts) = adds.get(&set) {
        for part in parts.iter().filter(|part| !plain.contains(part)) {
            findings.error(ImportFinding::new(
                at,
                format!("SPCADD {set}"),
                format!("refers to set {part}, which does not exist"),
            ));
        }
        return parts.iter().copied().collect();
    }
    if !plain.contains(&set) {
        let finding = ImportFinding::new(
            at,
            "SPC",
            "must be the number of a set of SPC, SPC1 or SPCADD",
        )
        .with_found(set);
        findings.error(finding.hint(list));
    }
    BTreeSet::from([set])
}

/// The only set of a deck whose case control selects none: the only SPCADD set or, if there is no SPCADD, the only
/// set. Several sets are an error that lists them.
fn only_set(
    supports: &[SupportCard],
    adds: &BTreeMap<u64, Vec<u64>>,
    controlled: bool,
    list: &str,
    findings: &mut ImportFindings,
) -> Option<u64> {
    let tops: BTreeSet<u64> = if adds.is_empty() {
        supports.iter().map(|support| support.set).collect()
    } else {
        adds.keys().copied().collect()
    };
    let at = supports
        .first()
        .map_or(FilePlace::default(), |support| support.card);
    let mut sets = tops.into_iter();
    match (sets.next(), sets.next()) {
        (Some(only), None) => {
            if controlled {
                let message = format!(
                    "set {only} is used, because it is the only one and case control selects none"
                );
                findings.warn(ImportFinding::new(at, "SPC", message));
            }
            Some(only)
        }
        (Some(_), Some(_)) => {
            let message =
                "must be selected, because there are several sets and case control selects none";
            let finding = ImportFinding::new(at, "SPC", message);
            findings.error(finding.hint(format!("add --spc N; {list}")));
            None
        }
        (None, _) => None,
    }
}
