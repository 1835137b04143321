//! A train over one member that carries rails, and its responses at a fixed section.
//!
//! From the quantities Q(0) just inside the first end of the member, those at a distance s follow by equilibrium of the
//! part between: with a load passed at s_k < s, force and couple change by its jump a_k, and each moment by
//! s times its shear at the end plus (s - s_k) times the jump of the shear. Where the member has an axial force, `bent`
//! gives the cubics in s and s - s_k that take the place of these. The deflection of the rail is a cubic in s, to which
//! each load that has been passed adds its kernel.

use crate::bent::{Bent, FIRST};
use crate::error::Error;
use crate::kernel::{Kernel, RailPoint};
use crate::line::{Lines, shifted, value_of_cubic};
use crate::pieces::{Pieces, ResponsePiece};
use crate::rail_deflection::{CarrierLines, POWERS};
use crate::structure::{Carrier, GirderResponse, OnMember, QUANTITIES, Structure};
use crate::train::{COMPONENTS, PlacedTrain};
use nalgebra::Vector3;
use smallvec::SmallVec;

/// Wheels for which no memory is allocated.
const FEW: usize = 16;

/// A rail element on the member of a carrier: how its coordinate counts along the carrier.
#[derive(Clone, Debug)]
struct Mapping {
    rail: usize,
    stretch: usize,
    /// Rail coordinate of its first end, and the place on the carrier there.
    x: f64,
    s: f64,
    /// Change of the place by the coordinate.
    rate: f64,
    /// What changes where each wheel of the train has been passed.
    changes: Vec<Change>,
}

/// What changes in the quantities of a section, and in both deflections, where a wheel has been passed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Change {
    jump: [f64; QUANTITIES],
    /// The same by the distance behind the wheel: a cubic for each quantity.
    passed: [[f64; 4]; QUANTITIES],
    kernels: [Kernel; 2],
}

impl Change {
    fn new(carrier: &Carrier, jump: [f64; QUANTITIES], kernels: [Kernel; 2]) -> Change {
        let of = |k: usize| {
            let bent = carrier.bent.as_ref().and_then(|bent| bent.passed(k, &jump));
            bent.unwrap_or([
                jump[k],
                slope_index(k).map_or(0.0, |shear| jump[shear]),
                0.0,
                0.0,
            ])
        };
        Change {
            jump,
            passed: std::array::from_fn(of),
            kernels,
        }
    }
}

/// A train over one carrier.
#[derive(Clone, Debug)]
pub(crate) struct TrainOnCarrier {
    mappings: Vec<Mapping>,
    /// Rail coordinates of the wheels less the position of the train, and their rails.
    offsets: Vec<f64>,
    rails: Vec<usize>,
    length: f64,
    bent: Option<Box<Bent>>,
}

/// A wheel on the member, in one piece of the positions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WheelOnMember {
    /// Its index in the train.
    pub wheel: usize,
    /// Its place at the first position of the piece.
    pub start: f64,
    /// Change of the place by the position.
    pub rate: f64,
    change: Change,
}

impl WheelOnMember {
    /// What quantity `k` changes by where the wheel has been passed.
    pub fn jump(&self, k: usize) -> f64 {
        self.change.jump[k]
    }

    /// The cubic by which quantity `k` changes behind the wheel, in the distance from it.
    pub fn behind(&self, k: usize) -> &[f64; 4] {
        &self.change.passed[k]
    }

    /// The kernel of a deflection, 0 downwards and 1 along +z.
    pub fn kernel(&self, direction: usize) -> &Kernel {
        &self.change.kernels[direction]
    }

    /// What response k of a section at place s gains where the wheel has been passed, by the distance from the first
    /// position of the piece.
    fn passed(&self, k: usize, s: f64) -> [f64; 4] {
        let lever = s - self.start;
        if let Some(direction) = k.checked_sub(QUANTITIES) {
            return self.kernel(direction).passing(lever, self.rate);
        }
        let [a, b, c, d] = self.change.passed[k];
        let rate = self.rate;
        let [slope, bend] = [b + lever * (2.0 * c + lever * 3.0 * d), c + 3.0 * d * lever];
        let value = a + lever * (b + lever * (c + lever * d));
        [
            value,
            -rate * slope,
            rate * rate * bend,
            -rate * rate * rate * d,
        ]
    }
}

/// Index of the shear force that belongs to a moment.
pub(crate) fn slope_index(k: usize) -> Option<usize> {
    GirderResponse::ALL[k].slope()
}

impl TrainOnCarrier {
    fn new(
        structure: &Structure,
        carrier: &Carrier,
        train: &PlacedTrain,
    ) -> Result<TrainOnCarrier, Error> {
        let mut mappings = Vec::new();
        let point = RailPoint::new(structure, carrier)?;
        for OnMember {
            other,
            stretch,
            start,
            rate,
        } in structure.on_member(carrier)
        {
            let mut units = [[Vector3::zeros(); 2]; COMPONENTS];
            for (component, unit) in units.iter_mut().enumerate() {
                *unit = structure.load(stretch, component)?;
            }
            let change = |wheel: &crate::train::PlacedWheel| {
                let total = |part: usize| -> Vector3<f64> {
                    wheel
                        .load
                        .iter()
                        .zip(&units)
                        .map(|(load, unit)| unit[part] * *load)
                        .sum()
                };
                let (force, couple) = (total(0), total(1));
                Change::new(
                    carrier,
                    carrier.jump_of_load(&force, &couple),
                    point.kernels(&force, &couple),
                )
            };
            mappings.push(Mapping {
                rail: other.rail,
                stretch: other.stretch,
                x: other.x[0],
                s: start,
                rate,
                changes: train.wheels.iter().map(change).collect(),
            });
        }
        let offsets = train.wheels.iter().map(|wheel| wheel.offset).collect();
        let rails = train.wheels.iter().map(|wheel| wheel.rail).collect();
        let bent = carrier.bent.clone();
        Ok(TrainOnCarrier {
            mappings,
            offsets,
            rails,
            length: carrier.length,
            bent,
        })
    }

    /// The rail elements of the member with the wheels that can stand on them.
    fn reaching(&self) -> impl Iterator<Item = (&Mapping, usize)> {
        let wheels = self.rails.iter().enumerate();
        let pairs = wheels.flat_map(|(wheel, rail)| {
            self.mappings
                .iter()
                .map(move |mapping| (mapping, wheel, *rail))
        });
        pairs
            .filter(|(mapping, _, rail)| mapping.rail == *rail)
            .map(|(mapping, wheel, _)| (mapping, wheel))
    }

    /// By how much quantity k changes where each wheel that can stand on the member has been passed.
    pub fn jumps(&self, k: usize) -> impl Iterator<Item = f64> {
        self.reaching()
            .map(move |(mapping, wheel)| mapping.changes[wheel].jump[k])
    }

    /// Sum of the jumps of the slope of a deflection under all wheels that can stand on the member.
    pub fn kinks(&self, direction: usize) -> f64 {
        self.reaching()
            .map(|(mapping, wheel)| mapping.changes[wheel].kernels[direction].slope().abs())
            .sum()
    }

    /// The rails of the member on which wheels of the train can stand.
    pub fn reached_rails(&self) -> impl Iterator<Item = usize> {
        self.reaching().map(|(mapping, _)| mapping.rail)
    }

    /// Whether wheels can stand on a rail of the member that runs against the carrier.
    pub fn has_opposed_wheels(&self) -> bool {
        self.reaching().any(|(mapping, _)| mapping.rate < 0.0)
    }

    /// Adds the rail coordinates of the carrier opposite to the wheels that stand on the member with the train at a position.
    pub fn coordinates(&self, carrier: &Carrier, position: f64, out: &mut Vec<f64>) {
        (0..self.offsets.len()).for_each(|wheel| self.coordinate_of(carrier, position, wheel, out));
    }

    /// Adds the rail coordinates of the carrier opposite to a wheel that stands on the member.
    pub fn coordinate_of(
        &self,
        carrier: &Carrier,
        position: f64,
        wheel: usize,
        out: &mut Vec<f64>,
    ) {
        for mapping in self
            .mappings
            .iter()
            .filter(|mapping| mapping.rail == self.rails[wheel])
        {
            let s = mapping.s + (position + self.offsets[wheel] - mapping.x) * mapping.rate;
            if (-1e-9 * self.length..=(1.0 + 1e-9) * self.length).contains(&s) {
                out.push(carrier.coordinate(s.clamp(0.0, self.length)));
            }
        }
    }

    /// Least distance along the member between two wheels that can stand on it; 0 where wheels move against each other.
    pub fn least_distance(&self) -> f64 {
        if self.has_opposed_wheels() {
            return 0.0;
        }
        let place = |(mapping, wheel): (&Mapping, usize)| {
            mapping.s + (self.offsets[wheel] - mapping.x) * mapping.rate
        };
        let mut places: Vec<f64> = self.reaching().map(place).collect();
        places.sort_by(f64::total_cmp);
        let distances = places.windows(2).map(|pair| pair[1] - pair[0]);
        distances
            .filter(|distance| *distance > 1e-12 * self.length)
            .fold(f64::INFINITY, f64::min)
    }

    /// Length of the member.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// What the axial force of the member does to moments; `None` without.
    pub fn bent(&self) -> Option<&Bent> {
        self.bent.as_deref()
    }

    /// The cubics of quantity `k` by place, each with the quantity at the first end that it multiplies, where an axial force
    /// bends it.
    pub fn bent_row(&self, k: usize) -> Option<impl Iterator<Item = (&[f64; 4], usize)>> {
        Some(self.bent()?.row(k)?.iter().zip(FIRST..))
    }

    /// The wheels on the member in a piece, by increasing place.
    fn wheels(&self, pieces: &Pieces<QUANTITIES>, piece: usize) -> Vec<WheelOnMember> {
        let mut out = Vec::new();
        let position = pieces.list[piece].position[0];
        for (wheel, stretch) in pieces.stretches(piece).iter().enumerate() {
            let Some(mapping) = self
                .mappings
                .iter()
                .find(|mapping| Some(mapping.stretch) == *stretch)
            else {
                continue;
            };
            let start = mapping.s + (position + self.offsets[wheel] - mapping.x) * mapping.rate;
            out.push(WheelOnMember {
                wheel,
                start,
                rate: mapping.rate,
                change: mapping.changes[wheel],
            });
        }
        out.sort_by(|a, b| a.start.total_cmp(&b.start));
        out
    }
}

/// A train in one stance over one carrier.
#[derive(Clone, Debug)]
pub(crate) struct Passage {
    pub on: TrainOnCarrier,
    /// The quantities just inside the first end of the carrier.
    pub pieces: Pieces<QUANTITIES>,
    /// Deflections downwards and along +z, where the structure resists them: coefficients of the powers of the place over
    /// the length of the carrier.
    pub deflections: [Option<Pieces<POWERS>>; 2],
    /// The wheels on the member in each piece, by increasing place.
    wheels: Vec<Vec<WheelOnMember>>,
}

impl Passage {
    pub fn new(
        structure: &Structure,
        carrier: &Carrier,
        train: &PlacedTrain,
        lines: &CarrierLines,
    ) -> Result<Passage, Error> {
        let slack = structure.slack();
        let pieces = Pieces::sum(&lines.forces, train, slack);
        let of = |lines: &Option<Lines<POWERS>>| {
            lines.as_ref().map(|lines| Pieces::sum(lines, train, slack))
        };
        let deflections = [of(&lines.deflections[0]), of(&lines.deflections[1])];
        let on = TrainOnCarrier::new(structure, carrier, train)?;
        let wheels = (0..pieces.list.len())
            .map(|piece| on.wheels(&pieces, piece))
            .collect();
        Ok(Passage {
            on,
            pieces,
            deflections,
            wheels,
        })
    }

    /// The wheels on the member in a piece, by increasing place.
    pub fn wheels(&self, piece: usize) -> &[WheelOnMember] {
        &self.wheels[piece]
    }

    /// Response k at place s in a piece, with no wheel passed.
    fn base(&self, piece: usize, k: usize, s: f64) -> [f64; 4] {
        if let Some(direction) = k.checked_sub(QUANTITIES) {
            let Some(pieces) = &self.deflections[direction] else {
                return [0.0; 4];
            };
            let [a, b, c, d] = &pieces.list[piece].cubics;
            let u = s / self.on.length;
            return std::array::from_fn(|p| a[p] + u * (b[p] + u * (c[p] + u * d[p])));
        }
        let cubics = &self.pieces.list[piece].cubics;
        if let Some(row) = self.on.bent_row(k) {
            let mut sum = [0.0; 4];
            for (factor, of) in row.map(|(cubic, of)| (value_of_cubic(cubic, s), of)) {
                sum.iter_mut()
                    .zip(&cubics[of])
                    .for_each(|(sum, c)| *sum += factor * c);
            }
            return sum;
        }
        let Some(shear) = slope_index(k) else {
            return cubics[k];
        };
        std::array::from_fn(|p| cubics[k][p] + s * cubics[shear][p])
    }

    /// Calls `each` with the parts of a piece for response k of the section at place s: it is divided where a wheel passes
    /// the section. A wheel that stands at the section where the train's range ends, or where it or another wheel comes onto a
    /// member or leaves it, is counted on either side of it, by a part of no length.
    pub fn parts(&self, piece: usize, k: usize, s: f64, mut each: impl FnMut(ResponsePiece)) {
        let base = self.base(piece, k, s);
        let wheels = &self.wheels[piece];
        let whole = &self.pieces.list[piece];
        let part = |position, cubic, part, at_section| ResponsePiece {
            position,
            cubic,
            origin: [piece, part],
            at_section,
        };
        let h = whole.length();
        let slack = 1e-12 * self.on.length;
        let passage = |wheel: &WheelOnMember| (s - wheel.start) / wheel.rate;
        let is_near = |wheel: &WheelOnMember| {
            let t = passage(wheel);
            t > -slack && t < h + slack
        };
        if !wheels.iter().any(is_near) {
            let mut cubic = base;
            let passed = wheels
                .iter()
                .filter(|wheel| (0.5 * h > passage(wheel)) != (wheel.rate > 0.0));
            for wheel in passed {
                cubic
                    .iter_mut()
                    .zip(wheel.passed(k, s))
                    .for_each(|(sum, c)| *sum += c);
            }
            each(part(whole.position, cubic, 0, [false; 2]));
            return;
        }
        let passages: SmallVec<[f64; FEW]> = wheels.iter().map(passage).collect();
        let changes_member = |neighbour: usize, is_at: &dyn Fn(f64) -> bool| {
            let others = &self.wheels[neighbour];
            let mut at = wheels
                .iter()
                .zip(&passages)
                .filter(|(_, passage)| is_at(**passage));
            at.any(|(wheel, _)| others.iter().all(|other| other.wheel != wheel.wheel))
        };
        // Where another wheel passes from a member to the next, its response may jump.
        let list = &self.pieces.list;
        let at_ends = [
            piece == 0 || !whole.begins_inside || changes_member(piece - 1, &|t| t.abs() <= slack),
            list.get(piece + 1).is_none_or(|next| !next.begins_inside)
                || changes_member(piece + 1, &|t| (t - h).abs() <= slack),
        ];
        for (index, ends) in cuts(&passages, h, slack, at_ends).windows(2).enumerate() {
            let side = match index {
                _ if ends[1] > ends[0] => Side::Middle(0.5 * (ends[0] + ends[1])),
                0 => Side::Before,
                _ => Side::After,
            };
            let mut cubic = base;
            for (wheel, passage) in wheels.iter().zip(&passages) {
                // Counted as before the section: the wheel comes from below until it passes.
                let later = match side {
                    Side::Before => *passage <= -slack,
                    Side::Middle(t) => t > *passage,
                    Side::After => *passage <= h + slack,
                };
                if later != (wheel.rate > 0.0) {
                    cubic
                        .iter_mut()
                        .zip(wheel.passed(k, s))
                        .for_each(|(sum, c)| *sum += c);
                }
            }
            let at = |t: f64| {
                if t >= h {
                    whole.position[1]
                } else {
                    whole.position[0] + t
                }
            };
            let is_passage = |end: f64| {
                passages
                    .iter()
                    .any(|passage| (passage - end).abs() <= slack)
            };
            each(part(
                [at(ends[0]), at(ends[1])],
                shifted(&cubic, ends[0]),
                index,
                [is_passage(ends[0]), is_passage(ends[1])],
            ));
        }
    }

    /// Response k of the section at place s, in all positions.
    pub fn response(&self, k: usize, s: f64) -> Vec<ResponsePiece> {
        let mut out = Vec::with_capacity(self.pieces.list.len() + 2 * self.on.offsets.len());
        (0..self.pieces.list.len())
            .for_each(|piece| self.parts(piece, k, s, |part| out.push(part)));
        out
    }

    /// Response k of the section at place s with the train at a position in a part of a piece.
    pub fn value(&self, k: usize, s: f64, position: f64, [piece, index]: [usize; 2]) -> f64 {
        let mut found = 0.0;
        self.parts(piece, k, s, |part| {
            if part.origin[1] == index {
                found = part.at(position);
            }
        });
        found
    }

    /// Whether response k is the same in another stance at every section, to a relative difference of its largest size.
    pub fn is_same(&self, other: &Passage, k: usize, tolerance: f64) -> bool {
        let size = self.size(k).max(other.size(k));
        let near = |a: f64, b: f64| (a - b).abs() <= tolerance * size;
        if self.pieces.list.len() != other.pieces.list.len() {
            return false;
        }
        let length = self.on.length;
        (0..self.pieces.list.len()).all(|piece| {
            let (a, b) = (&self.pieces.list[piece], &other.pieces.list[piece]);
            let h = a.length();
            let powers = [1.0, h, h * h, h * h * h];
            // Cubic in the place: equal where it is equal at four sections.
            let same_base = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].into_iter().all(|u| {
                let (a, b) = (
                    self.base(piece, k, u * length),
                    other.base(piece, k, u * length),
                );
                (0..4).all(|p| near(a[p] * powers[p], b[p] * powers[p]))
            });
            let (wheels, others) = (&self.wheels[piece], &other.wheels[piece]);
            let same_wheels = wheels.len() == others.len()
                && wheels.iter().zip(others).all(|(a, b)| {
                    (a.start - b.start).abs() <= 1e-14 * length
                        && a.rate == b.rate
                        && [0.5, 1.0].into_iter().all(|u| {
                            let s = a.start + u * length;
                            near(a.passed(k, s)[0], b.passed(k, s)[0])
                        })
                });
            a.position == b.position && same_base && same_wheels
        })
    }

    /// Bound of the size of response k without the wheels that have been passed.
    fn size(&self, k: usize) -> f64 {
        let of = |piece: usize, s: f64| {
            let h = self.pieces.list[piece].length();
            let [a, b, c, d] = self.base(piece, k, s).map(f64::abs);
            a + h * (b + h * (c + h * d))
        };
        let ends =
            (0..self.pieces.list.len()).map(|piece| of(piece, 0.0).max(of(piece, self.on.length)));
        ends.fold(0.0, f64::max)
    }
}

/// Where a sub-interval of a piece lies.
enum Side {
    /// Before a passage at the first position.
    Before,
    /// Around this distance from the first position.
    Middle(f64),
    /// After a passage at the last position.
    After,
}

/// The ends of the parts of a piece of length h in which wheels pass a section at some distances. A passage in the middle
/// cuts once; one at an end leaves a part of no length beyond it, where `at_ends` says so.
fn cuts(passages: &[f64], h: f64, slack: f64, at_ends: [bool; 2]) -> SmallVec<[f64; FEW]> {
    if h <= slack {
        return SmallVec::from_slice(&[0.0; 3]);
    }
    let mut within: SmallVec<[f64; FEW]> = SmallVec::new();
    let mut ends = [1, 1];
    for &t in passages.iter().filter(|t| **t > -slack && **t < h + slack) {
        if t <= slack {
            ends[0] += 1
        } else if t >= h - slack {
            ends[1] += 1
        } else {
            within.push(t)
        }
    }
    within.sort_by(f64::total_cmp);
    within.dedup_by(|b, a| *b - *a <= slack);
    // Elsewhere the neighbouring piece has the other limit.
    let [at_first, at_last] = at_ends.map(|at| if at { 2 } else { 1 });
    let mut out: SmallVec<[f64; FEW]> = SmallVec::new();
    out.extend(std::iter::repeat_n(0.0, ends[0].min(at_first)));
    out.extend(within);
    out.extend(std::iter::repeat_n(h, ends[1].min(at_last)));
    out
}
