//! Bounds of the influence lines of the forces in a member, and of what follows from them.

use piecewise::Lobatto;
use trains::{PassedLoads, RailLoad};

use super::distributed::{FORCES, Quantities};
use super::girder::LoadedGirders;
use crate::pieces::{Bounds, Cell, LINE_DEGREE, LoadPieces, Stay};

/// Bounds of the forces of a member at its first end, in its middle and at its other end, between which they are linear: of
/// moments without an axial force, and nearly so with one.
pub(super) type AlongMember = [[Bounds; FORCES]; 3];

/// Bounds at a fraction of the length.
pub(super) fn bounds_at(along: &AlongMember, k: usize, fraction: f64) -> Bounds {
    match fraction < 0.5 {
        true => along[0][k].towards(along[1][k], 2.0 * fraction),
        false => along[1][k].towards(along[2][k], 2.0 * fraction - 1.0),
    }
}

/// Largest magnitude along the member.
pub(super) fn size_along(along: &AlongMember, k: usize) -> f64 {
    along.iter().map(|own| own[k].size()).fold(0.0, f64::max)
}

/// The forces in a member under unit loads in a cell.
struct CellForces {
    /// Whether the member itself is there.
    is_on: bool,
    /// By direction of the load: bounds along the member.
    bounds: [AlongMember; 3],
    /// By direction: largest magnitudes at any section, and of the slopes by the coordinate of the load on either side of it.
    sizes: [Quantities; 3],
    slopes: [Quantities; 3],
}

/// The forces in a member under unit loads in the cells that are visited.
pub(super) struct MemberLines<'a> {
    girders: &'a LoadedGirders<'a>,
    member: usize,
    /// By cell that is visited.
    cells: Vec<CellForces>,
}

impl<'a> MemberLines<'a> {
    pub fn new(girders: &'a LoadedGirders<'a>, member: usize) -> MemberLines<'a> {
        let visited = girders.pieces.visited().iter();
        let of_cell = |cell: &Cell| CellForces::new(girders, member, *cell);
        MemberLines {
            girders,
            member,
            cells: visited.map(of_cell).collect(),
        }
    }

    /// Bounds of the forces during a stay, without dead load; `None` where a load is on the member.
    pub fn bounds(&self, stay: &Stay) -> Option<AlongMember> {
        let distributed = self.girders.distributed;
        let mut out = [distributed.inertia_bounds(self.member, &stay.accelerations); 3];
        for (cell, force) in &stay.loads {
            let own = Some(&self.cells[*cell]).filter(|own| !own.is_on)?;
            for (force, per) in force.iter().zip(&own.bounds).filter(|(f, _)| !f.is_zero()) {
                let each = out.iter_mut().flatten().zip(per.iter().flatten());
                each.for_each(|(sum, per)| sum.add_product(*force, *per));
            }
        }
        Some(out)
    }

    /// How much the forces of any section that no load passes change in a piece from its middle node, at most.
    pub fn changes(&self, pieces: &LoadPieces<'_>, index: usize) -> Quantities {
        let stay = &pieces.stays[pieces.pieces[index].stay];
        let [_, accelerations] = pieces.changes_of_motion(index);
        let distributed = self.girders.distributed;
        let mut out = distributed.inertia_size(self.member, accelerations);
        for (change, (cell, _)) in pieces.changes(index).iter().zip(&stay.loads) {
            let own = &self.cells[*cell];
            for k in (0..3).filter(|k| change.size(*k) > 0.0) {
                let moved = change.size(k) * change.place;
                let each = out.iter_mut().zip(own.sizes[k].iter().zip(&own.slopes[k]));
                each.for_each(|(sum, (size, slope))| {
                    *sum += change.force[k] * size + moved * slope;
                });
            }
        }
        out
    }
}

impl CellForces {
    fn new(girders: &LoadedGirders<'_>, member: usize, cell: Cell) -> CellForces {
        let members = girders.members;
        let length = members.members().nth(member).map_or(0.0, |own| own.length);
        let nodes = Lobatto::of(LINE_DEGREE);
        let [low, high] = girders.pieces.cells().inside(cell);
        let load = |share: f64, direction: usize| {
            let mut force = [0.0; 3];
            force[direction] = 1.0;
            RailLoad {
                rail: cell.0,
                x: low + share * (high - low),
                force,
            }
        };
        let mut out = CellForces {
            is_on: members.stands(member, &load(0.5, 1)).is_some(),
            bounds: [[[Bounds::ZERO; FORCES]; 3]; 3],
            sizes: [[0.0; FORCES]; 3],
            slopes: [[0.0; FORCES]; 3],
        };
        let mut passed = PassedLoads::default();
        for direction in 0..3 {
            // sections before the load, and behind it
            for is_behind in [false, true] {
                let mut values = [[[0.0; LINE_DEGREE + 1]; FORCES]; 3];
                for (n, share) in nodes.nodes().iter().enumerate() {
                    members.load(member, &[load(*share, direction)], &mut passed);
                    for (at, values) in values.iter_mut().enumerate() {
                        let place = 0.5 * at as f64 * length;
                        let found = passed.quantities_behind(place, &|_, _| is_behind);
                        (0..FORCES).for_each(|k| values[k][n] = found[k]);
                    }
                }
                for (at, values) in values.iter().enumerate() {
                    for (k, values) in values.iter().enumerate() {
                        let polynomial = nodes.polynomial(values);
                        let own = Bounds::of(&polynomial);
                        let slope = Bounds::of(&polynomial.derivative()).size() / (high - low);
                        out.bounds[direction][at][k] = own;
                        let (size, slopes) =
                            (&mut out.sizes[direction][k], &mut out.slopes[direction][k]);
                        (*size, *slopes) = (size.max(own.size()), slopes.max(slope));
                    }
                }
            }
        }
        out
    }
}
