//! Internal forces at a fixed section of a member that carries rails, under a train.
//!
//! From the quantities Q(0) just inside the first end of the member, those at a distance s follow by equilibrium of the
//! part between: with a load passed at s_k < s, force and couple change by its jump a_k, and each moment by
//! s times its shear at the end plus (s - s_k) times the jump of the shear.

use crate::error::Error;
use crate::line::shifted;
use crate::pieces::{Piece, Pieces};
use crate::structure::{Carrier, GirderResponse, OnMember, QUANTITIES, Structure};
use crate::train::{COMPONENTS, PlacedTrain};
use nalgebra::Vector3;

/// A rail element on the member of a carrier: how its coordinate counts along the carrier.
#[derive(Clone, Debug)]
struct Mapping {
    rail: usize,
    element: usize,
    /// Rail coordinate of its first end, and the place on the carrier there.
    x: f64,
    s: f64,
    /// Change of the place by the coordinate.
    rate: f64,
    /// Jump of the quantities where each wheel of the train has been passed.
    jumps: Vec<[f64; QUANTITIES]>,
}

/// A train over one carrier.
#[derive(Clone, Debug)]
pub(crate) struct TrainOnCarrier {
    mappings: Vec<Mapping>,
    /// Rail coordinates of the wheels less the position of the train, and their rails.
    offsets: Vec<f64>,
    rails: Vec<usize>,
    length: f64,
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
    /// What changes where it has been passed.
    pub jump: [f64; QUANTITIES],
}

impl WheelOnMember {
    /// What quantity `k` of a section gains from the wheel at a distance `lever` before it.
    pub fn passed(&self, k: usize, lever: f64) -> f64 {
        self.jump[k] + slope_index(k).map_or(0.0, |shear| self.jump[shear] * lever)
    }
}

/// Index of the shear force that belongs to a moment.
pub(crate) fn slope_index(k: usize) -> Option<usize> {
    GirderResponse::ALL[k].slope()
}

impl TrainOnCarrier {
    pub fn new(
        structure: &Structure,
        carrier: &Carrier,
        train: &PlacedTrain,
    ) -> Result<TrainOnCarrier, Error> {
        let mut mappings = Vec::new();
        for OnMember { other, stretch, start, rate } in structure.on_member(carrier) {
            let mut units = [[Vector3::zeros(); 2]; COMPONENTS];
            for (component, unit) in units.iter_mut().enumerate() {
                *unit = structure.load(stretch, component)?;
            }
            let jump = |wheel: &crate::train::PlacedWheel| {
                let total = |part: usize| -> Vector3<f64> {
                    wheel.load.iter().zip(&units).map(|(load, unit)| unit[part] * *load).sum()
                };
                carrier.jump(&total(0), &total(1))
            };
            mappings.push(Mapping {
                rail: other.rail,
                element: other.element,
                x: other.x[0],
                s: start,
                rate,
                jumps: train.wheels.iter().map(jump).collect(),
            });
        }
        let offsets = train.wheels.iter().map(|wheel| wheel.offset).collect();
        let rails = train.wheels.iter().map(|wheel| wheel.rail).collect();
        Ok(TrainOnCarrier { mappings, offsets, rails, length: carrier.length })
    }

    /// The rail elements of the member with the wheels that can stand on them.
    fn reaching(&self) -> impl Iterator<Item = (&Mapping, usize)> {
        let wheels = self.rails.iter().enumerate();
        let pairs =
            wheels.flat_map(|(wheel, rail)| self.mappings.iter().map(move |mapping| (mapping, wheel, *rail)));
        pairs.filter(|(mapping, _, rail)| mapping.rail == *rail).map(|(mapping, wheel, _)| (mapping, wheel))
    }

    /// By how much quantity k changes where each wheel that can stand on the member has been passed.
    pub fn jumps(&self, k: usize) -> impl Iterator<Item = f64> {
        self.reaching().map(move |(mapping, wheel)| mapping.jumps[wheel][k])
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
    pub fn coordinate_of(&self, carrier: &Carrier, position: f64, wheel: usize, out: &mut Vec<f64>) {
        for mapping in self.mappings.iter().filter(|mapping| mapping.rail == self.rails[wheel]) {
            let s = mapping.s + (position + self.offsets[wheel] - mapping.x) * mapping.rate;
            if (-1e-9 * self.length..=(1.0 + 1e-9) * self.length).contains(&s) {
                out.push(carrier.coordinate(s.clamp(0.0, self.length)));
            }
        }
    }

    /// Length of the member.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The wheels on the member in a piece, by increasing place.
    pub fn wheels(&self, pieces: &Pieces<QUANTITIES>, piece: usize, out: &mut Vec<WheelOnMember>) {
        out.clear();
        let position = pieces.list[piece].position[0];
        for (wheel, element) in pieces.elements(piece).iter().enumerate() {
            let Some(mapping) = self.mappings.iter().find(|mapping| Some(mapping.element) == *element) else {
                continue;
            };
            let start = mapping.s + (position + self.offsets[wheel] - mapping.x) * mapping.rate;
            out.push(WheelOnMember { wheel, start, rate: mapping.rate, jump: mapping.jumps[wheel] });
        }
        out.sort_by(|a, b| a.start.total_cmp(&b.start));
    }

    /// The quantities of the section at place s as pieces, split where a wheel passes it. A wheel that stands at the
    /// section at an end of the train's range is counted on either side of it, by a piece of no length.
    pub fn section(&self, pieces: &Pieces<QUANTITIES>, s: f64) -> Vec<Piece<QUANTITIES>> {
        let slack = 1e-12 * self.length;
        let mut out = Vec::with_capacity(pieces.list.len() + 2 * self.offsets.len());
        let mut wheels = Vec::new();
        let mut passages = Vec::new();
        for (index, piece) in pieces.list.iter().enumerate() {
            let mut base = piece.cubics;
            for (k, cubic) in base.iter_mut().enumerate() {
                if let Some(shear) = slope_index(k) {
                    cubic.iter_mut().zip(piece.cubics[shear]).for_each(|(c, slope)| *c += s * slope);
                }
            }
            self.wheels(pieces, index, &mut wheels);
            if wheels.is_empty() {
                out.push(Piece { position: piece.position, cubics: base });
                continue;
            }
            let h = piece.length();
            passages.clear();
            passages.extend(wheels.iter().map(|wheel| (s - wheel.start) / wheel.rate));
            let mut cuts = vec![0.0, h];
            cuts.extend(
                passages.iter().copied().filter(|t| *t > -slack && *t < h + slack).map(|t| t.clamp(0.0, h)),
            );
            cuts.sort_by(f64::total_cmp);
            // A passage in the middle cuts once; one at an end leaves a piece of no length beyond it.
            let (mut kept, mut ends) = (Vec::with_capacity(cuts.len()), [0, 0]);
            for t in cuts {
                if t <= slack {
                    ends[0] += 1
                } else if t >= h - slack {
                    ends[1] += 1
                } else if kept.last().is_none_or(|last| t - last > slack) {
                    kept.push(t)
                }
            }
            // Within the range the neighbouring piece has the other limit.
            let [at_first, at_last] =
                [index == 0, index + 1 == pieces.list.len()].map(|at| if at { 2 } else { 1 });
            let mut bounds = vec![0.0; ends[0].min(at_first)];
            bounds.extend(kept);
            bounds.extend(std::iter::repeat_n(h, ends[1].min(at_last)));
            for ends in bounds.windows(2) {
                let side = if ends[1] > ends[0] {
                    Side::Middle(0.5 * (ends[0] + ends[1]))
                } else if ends[0] == 0.0 {
                    Side::Before
                } else {
                    Side::After
                };
                let mut cubics = base;
                for (wheel, passage) in wheels.iter().zip(&passages) {
                    // Counted as before the section: the wheel comes from below until it passes.
                    let later = match side {
                        Side::Before => *passage <= -slack,
                        Side::Middle(t) => t > *passage,
                        Side::After => *passage <= h + slack,
                    };
                    if later != (wheel.rate > 0.0) {
                        for (k, cubic) in cubics.iter_mut().enumerate() {
                            cubic[0] += wheel.passed(k, s - wheel.start);
                            cubic[1] -= slope_index(k).map_or(0.0, |shear| wheel.jump[shear] * wheel.rate);
                        }
                    }
                }
                cubics.iter_mut().for_each(|cubic| *cubic = shifted(cubic, ends[0]));
                out.push(Piece { position: ends_of(piece, ends), cubics });
            }
        }
        out
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

fn ends_of(piece: &Piece<QUANTITIES>, ends: &[f64]) -> [f64; 2] {
    let at = |t: f64| if t >= piece.length() { piece.position[1] } else { piece.position[0] + t };
    [at(ends[0]), at(ends[1])]
}
