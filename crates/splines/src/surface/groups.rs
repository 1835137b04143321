//! The exact surface between groups of probes that move along their rails.
//!
//! Algorithm. On half of an element the shape functions of a probe are N = [1 r r^2 r^3] K in the distance r from its end,
//! so that between two halves N(p) C N(q)^T is bicubic with the 16 coefficients K C K^T. (1) These are formed when probes
//! come to other halves, and kept while they remain there. (2) At each call the powers of r, times the weights of the
//! members, are summed over the members of a group on one half; a pair of such sums costs three scalar products of four
//! terms. (3) Green's function within elements is added pair by pair, as products of the factors of both places
//! (`SeparatedLoad`).

use nalgebra::DMatrix;

use super::planar::Output;
use crate::compliance::{
    ElementHalf, GroupMember, GroupPart, Influence, KeptProducts, ProbeGroups,
};
use crate::error::Error;
use crate::probe::Probe;
use crate::rail::{LocalPlace, Rails, SeparatedLoad};
use crate::vector::dot4;

/// Where a probe stands.
#[derive(Clone, Copy)]
struct Standing {
    half: ElementHalf,
    at: LocalPlace,
    /// Derivative of the distance from the nearer end, in lengths of the element, by the coordinate.
    rate: f64,
    length: f64,
    is_reversed: bool,
}

/// Fills `out` where every element is free of axial force and no member carries two elements, and returns whether it did; else
/// `out` is untouched. `nodal` is the nodal compliance.
///
/// # Errors
/// As [`crate::Compliance::fill`].
pub(super) fn fill(
    rails: &Rails,
    nodal: &DMatrix<f64>,
    groups: &ProbeGroups,
    kept: &mut KeptProducts,
    out: &mut Influence,
) -> Result<bool, Error> {
    if rails.shares_members() {
        return Ok(false);
    }
    let standings = groups
        .probes
        .iter()
        .map(|probe| stand(rails, *probe))
        .collect::<Result<Vec<_>, _>>()?;
    let stays = standings.len() == kept.halves.len()
        && standings
            .iter()
            .zip(&kept.halves)
            .all(|(standing, half)| standing.half == *half);
    if !stays && !renew(rails, nodal, groups, &standings, kept) {
        return Ok(false);
    }
    for part in &mut kept.parts {
        (part.value, part.slope) = ([0.0; 4], [0.0; 4]);
    }
    for (GroupMember { probe, weight, .. }, part) in groups.members.iter().zip(&kept.part_of) {
        let Standing {
            at: LocalPlace { r, .. },
            rate,
            ..
        } = standings[*probe];
        let part = &mut kept.parts[*part];
        let (value, slope) = ([1.0, r, r * r, r * r * r], [0.0, 1.0, 2.0 * r, 3.0 * r * r]);
        part.value = std::array::from_fn(|k| part.value[k] + weight * value[k]);
        part.slope = std::array::from_fn(|k| part.slope[k] + weight * rate * slope[k]);
    }
    let mut to = Output::of(out, groups.count);
    to.value.fill(0.0);
    to.slope.fill(0.0);
    add_nodal(kept, &mut to);
    add_elements(rails, groups, &standings, kept, &mut to);
    let is_lost = |group: usize| !to.value[group * (groups.count + 1)].is_finite();
    if let Some(lost) = groups.members.iter().find(|member| is_lost(member.group)) {
        // One probe of the group moves without limit.
        let own = groups
            .members
            .iter()
            .filter(|member| member.group == lost.group);
        let moves = |member: &&GroupMember| {
            let shapes = rails.row(groups.probes[member.probe]);
            shapes.is_ok_and(|row| {
                row.indices()
                    .iter()
                    .any(|&k| nodal[(k, k)] == f64::INFINITY)
            })
        };
        let Probe { rail, x, axis } = groups.probes[own.clone().find(moves).unwrap_or(lost).probe];
        return Err(Error::NoStiffness { rail, x, axis });
    }
    Ok(true)
}

fn stand(rails: &Rails, probe: Probe) -> Result<Standing, Error> {
    let span = rails.stiff_span(probe)?;
    let at = span.local(probe.x);
    Ok(Standing {
        half: ElementHalf {
            element: span.element,
            axis: probe.axis.component(),
            end: at.end,
        },
        at,
        rate: if at.end == 0 { span.scale } else { -span.scale },
        length: span.length,
        is_reversed: span.reversed,
    })
}

/// Forms what depends on the halves of elements on which the probes stand. Returns false where the shape functions of one of
/// them are no cubics.
#[cold]
fn renew(
    rails: &Rails,
    nodal: &DMatrix<f64>,
    groups: &ProbeGroups,
    standings: &[Standing],
    kept: &mut KeptProducts,
) -> bool {
    kept.halves.clear();
    if standings.iter().any(|own| {
        rails
            .shape_cubics(own.half.element, own.half.axis)
            .bent()
            .is_some()
    }) {
        return false;
    }
    let mut blocks: Vec<ElementHalf> = standings.iter().map(|standing| standing.half).collect();
    blocks.sort_unstable();
    blocks.dedup();
    let known: Vec<Option<usize>> = blocks
        .iter()
        .map(|half| kept.blocks.binary_search(half).ok())
        .collect();
    // Pairs of parts are in the order of their blocks, so that rows are not before columns.
    let mut bicubics = vec![[[0.0; 4]; 4]; blocks.len() * blocks.len()];
    for (i, (row, a)) in blocks.iter().zip(&known).enumerate() {
        for (j, (column, b)) in blocks.iter().zip(&known).enumerate().take(i + 1) {
            bicubics[i * blocks.len() + j] = match (a, b) {
                (Some(a), Some(b)) => kept.bicubics[a * kept.blocks.len() + b],
                _ => bicubic(rails, nodal, row, column),
            };
        }
    }
    let half_of = |member: &GroupMember| standings[member.probe].half;
    let mut parts: Vec<(ElementHalf, usize)> = groups
        .members
        .iter()
        .map(|member| (half_of(member), member.group))
        .collect();
    parts.sort_unstable();
    parts.dedup();
    let place = |member: &GroupMember| {
        parts
            .binary_search(&(half_of(member), member.group))
            .expect("every member has a part")
    };
    kept.part_of.clear();
    kept.part_of.extend(groups.members.iter().map(place));
    kept.parts.clear();
    kept.parts
        .extend(parts.iter().map(|(half, group)| GroupPart {
            group: *group,
            block: blocks.binary_search(half).expect("every half has a block"),
            value: [0.0; 4],
            slope: [0.0; 4],
        }));
    kept.order.clear();
    kept.order.extend(0..groups.members.len());
    kept.order
        .sort_by_key(|&k| half_of(&groups.members[k]).element);
    (kept.blocks, kept.bicubics) = (blocks, bicubics);
    kept.halves
        .extend(standings.iter().map(|standing| standing.half));
    true
}

/// The coefficients K C K^T between two halves: for each power of the distance on `column` those of the powers on `row`.
fn bicubic(
    rails: &Rails,
    nodal: &DMatrix<f64>,
    row: &ElementHalf,
    column: &ElementHalf,
) -> [[f64; 4]; 4] {
    let groups_of = |half: &ElementHalf| rails.shape_cubics(half.element, half.axis).groups();
    let (size, nodal) = (nodal.nrows(), nodal.as_slice());
    let mut out = [[0.0; 4]; 4];
    for load in groups_of(column) {
        let shapes = &load.cubic[column.end];
        for (k, &dof) in load.index.iter().enumerate() {
            let moved = &nodal[dof * size..(dof + 1) * size];
            let mut by_power = [0.0; 4];
            for place in groups_of(row) {
                let (of, own) = (place.index.map(|dof| moved[dof]), &place.cubic[row.end]);
                by_power = std::array::from_fn(|power| by_power[power] + dot4(&own[power], &of));
            }
            for (out, shapes) in out.iter_mut().zip(shapes) {
                *out = std::array::from_fn(|power| out[power] + shapes[k] * by_power[power]);
            }
        }
    }
    out
}

/// Adds N C N^T between all parts of groups.
fn add_nodal(kept: &KeptProducts, to: &mut Output) {
    let KeptProducts {
        parts,
        blocks,
        bicubics,
        ..
    } = kept;
    for (k, load) in parts.iter().enumerate() {
        // Parts on one block follow each other.
        let (mut block, mut moved) = (None, [[0.0; 4]; 2]);
        for (number, part) in parts[k..].iter().enumerate() {
            if block != Some(part.block) {
                let columns = &bicubics[part.block * blocks.len() + load.block];
                moved = [times(columns, &load.value), times(columns, &load.slope)];
                block = Some(part.block);
            }
            let value = dot4(&part.value, &moved[0]);
            let slopes = [dot4(&part.slope, &moved[0]), dot4(&part.value, &moved[1])];
            to.add([part.group, load.group], value, slopes, number == 0);
        }
    }
}

/// Adds Green's function between members in one element.
fn add_elements(
    rails: &Rails,
    groups: &ProbeGroups,
    standings: &[Standing],
    kept: &KeptProducts,
    to: &mut Output,
) {
    let element = |k: usize| standings[groups.members[k].probe].half.element;
    let mut loads: Vec<(usize, SeparatedLoad)> = Vec::with_capacity(kept.order.len());
    for own in kept.order.chunk_by(|&a, &b| element(a) == element(b)) {
        let Some(clamped) = rails.clamped(element(own[0])) else {
            continue;
        };
        loads.clear();
        loads.extend(own.iter().map(|&k| {
            let GroupMember {
                group,
                probe,
                weight,
            } = groups.members[k];
            let Standing {
                half,
                at,
                rate,
                length,
                is_reversed,
            } = standings[probe];
            let place = at.on_member(length, is_reversed);
            let rate = if (half.end == 1) == is_reversed {
                rate * length
            } else {
                -rate * length
            };
            (group, clamped.separated(half.axis, place, rate, weight))
        }));
        for (k, (group, load)) in loads.iter().enumerate() {
            for (number, (other, part)) in loads[k..].iter().enumerate() {
                if !part.meets(load) {
                    continue;
                }
                let [value, by_part, by_load] = part.with(load);
                to.add([*other, *group], value, [by_part, by_load], number == 0);
            }
        }
    }
}

/// The sum of columns, each times its entry of `of`.
#[inline]
fn times(columns: &[[f64; 4]; 4], of: &[f64; 4]) -> [f64; 4] {
    let [a, b, c, d] = columns;
    std::array::from_fn(|k| (of[0] * a[k] + of[1] * b[k]) + (of[2] * c[k] + of[3] * d[k]))
}
