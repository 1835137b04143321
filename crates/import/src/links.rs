//! Rigid links that join only some degrees of freedom of their ends.
//!
//! A beam spec has links of all six degrees of freedom. A partial link is replaced by something of the same effect where
//! there is such a thing:
//! 1. the other degrees of freedom of the dependent point are rotations that nothing else resists: the whole link;
//! 2. the independent point is fixed in what the link transmits: a support of the dependent point;
//! 3. the link joins translations alone, and only one beam ends at the dependent point: the beam ends at the
//!    independent point, with a rigid offset and released rotations.

use crate::structure::ImportedStructure;
use fea::MemberKind;
use formats::vector::minus;

/// A link of some degrees of freedom between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartialLink {
    /// The independent point.
    pub from: usize,
    /// The dependent point.
    pub to: usize,
    /// Global degrees of freedom of the dependent point that follow the independent one.
    pub set: [bool; 6],
}

/// Member and end of a member.
type End = (usize, usize);

/// Adds a partial link to a structure whose whole links, supports and springs are known; returns false if this is not
/// possible. `all` are the partial links of the structure, of which others may act at the dependent point too.
pub fn add(structure: &mut ImportedStructure, link: PartialLink, all: &[PartialLink]) -> bool {
    let PartialLink { from, to, set } = link;
    if is_fixed(structure, link) {
        let support = structure.supports.entry(to).or_default();
        for (dof, fix) in set.iter().enumerate() {
            support[dof] |= fix;
        }
        return true;
    }
    let joins_translations = set[..3].iter().all(|joined| *joined);
    let is_partial = all
        .iter()
        .filter(|other| other.from == to || other.to == to)
        .count()
        > 1;
    let is_linked = is_partial || structure.links.iter().any(|ends| ends.contains(&to));
    if !joins_translations || is_linked || holds_free_part(structure, link) {
        return false;
    }
    let ends: Vec<End> = structure
        .members
        .iter()
        .enumerate()
        .flat_map(|(index, member)| [0, 1].map(|end| (index, end, member.points[end])))
        .filter(|(_, _, point)| *point == to)
        .map(|(index, end, _)| (index, end))
        .collect();
    let turns_freely = |&(index, end): &End| {
        let member = &structure.members[index];
        member.kind == MemberKind::Truss && member.offsets[end] == [0.0; 3]
    };
    if ends.iter().all(turns_freely) {
        structure.links.push([from, to]);
        return true;
    }
    let joins_rotations = set[3..].iter().any(|joined| *joined);
    let [(index, end)] = ends[..] else {
        return false;
    };
    let is_supported = structure
        .supports
        .get(&to)
        .is_some_and(|fix| fix.contains(&true));
    let has_spring = structure.springs.iter().any(|spring| spring.point == to);
    let arm = minus(structure.points[to].at, structure.points[from].at);
    let member = &mut structure.members[index];
    let other = member.points[1 - end];
    if joins_rotations
        || is_supported
        || has_spring
        || member.offsets[end] != [0.0; 3]
        || other == from
    {
        return false;
    }
    member.points[end] = from;
    member.offsets[end] = arm;
    member.releases[end][3..].fill(true);
    for mass in structure.masses.iter_mut().filter(|mass| mass.point == to) {
        mass.point = from;
        mass.offset = [0, 1, 2].map(|axis| mass.offset[axis] + arm[axis]);
    }
    true
}

/// Whether supports fix everything at the independent point that moves the dependent one.
fn is_fixed(structure: &ImportedStructure, PartialLink { from, to, set }: PartialLink) -> bool {
    let Some(fix) = structure.supports.get(&from) else {
        return false;
    };
    let coincide = structure.points[from].at == structure.points[to].at;
    let translates = set[..3].iter().any(|joined| *joined);
    let needed = |dof: usize| set[dof] || (dof >= 3 && translates && !coincide);
    (0..6).all(|dof| fix[dof] || !needed(dof))
}

/// Whether a support, spring or mass resists the degrees of freedom of the dependent point that the link leaves free.
fn holds_free_part(
    structure: &ImportedStructure,
    PartialLink { to, set, .. }: PartialLink,
) -> bool {
    let fixes = |fix: &[bool; 6]| (0..6).any(|dof| fix[dof] && !set[dof]);
    structure.supports.get(&to).is_some_and(fixes)
        || structure
            .springs
            .iter()
            .any(|spring| spring.point == to && !set[spring.dof])
        || structure
            .masses
            .iter()
            .any(|mass| mass.point == to && (mass.inertia != [0.0; 3] || mass.offset != [0.0; 3]))
}
