//! All trains of a case over one carrier, and the best arrangement for a response of one of its sections.

use crate::bounds::Bounds;
use crate::error::Error;
use crate::hints::Hint;
use crate::line::Lines;
use crate::pieces::ResponsePiece;
use crate::plan::{Arrangement, CasePlan, Responses, Standing, TIE, can_exceed, offer_part};
use crate::promising::{BoundedPiece, BoundedPieces};
use crate::rail_deflection::{CarrierLines, POWERS};
use crate::section::Passage;
use crate::structure::{Carrier, GirderResponse, QUANTITIES, Structure};
use smallvec::SmallVec;

/// Responses that differ by no more than this, relative to the largest, are those of one stance.
const EQUAL: f64 = 1e-14;

/// The trains of a case over one carrier, by train and stance.
pub(crate) struct Overrun {
    pub passages: Vec<Vec<Passage>>,
    /// By response and train: the stances that differ. A lateral force, for instance, does not change a vertical moment,
    /// whatever its sign.
    distinct: Vec<Vec<Vec<usize>>>,
    /// Bounds of the responses, by train and stance.
    bounds: Vec<Vec<Bounds>>,
}

impl Overrun {
    pub fn new(
        structure: &Structure,
        plan: &CasePlan,
        carrier: &Carrier,
        lines: &CarrierLines,
    ) -> Result<Overrun, Error> {
        Overrun::from_response(structure, plan, carrier, lines, 0)
    }

    /// Only the responses from `first` on are prepared.
    fn from_response(
        structure: &Structure,
        plan: &CasePlan,
        carrier: &Carrier,
        lines: &CarrierLines,
        first: usize,
    ) -> Result<Overrun, Error> {
        let of = |train| Passage::new(structure, carrier, train, lines);
        let passages = plan
            .trains
            .iter()
            .map(|stances| stances.iter().map(of).collect());
        let passages: Vec<Vec<Passage>> = passages.collect::<Result<_, _>>()?;
        let distinct = |k: usize| match k >= first {
            true => (0..passages.len())
                .map(|train| distinct_stances(plan, train, &passages[train], k))
                .collect(),
            false => vec![Vec::new(); passages.len()],
        };
        let distinct: Vec<Vec<Vec<usize>>> = (0..GirderResponse::ALL.len()).map(distinct).collect();
        let of = |(train, stances): (usize, &Vec<Passage>)| {
            let bounds = |(stance, passage): (usize, &Passage)| {
                let wanted = std::array::from_fn(|k| distinct[k][train].contains(&stance));
                Bounds::new(passage, &wanted)
            };
            stances.iter().enumerate().map(bounds).collect()
        };
        let bounds = passages.iter().enumerate().map(of).collect();
        Ok(Overrun {
            passages,
            distinct,
            bounds,
        })
    }

    /// Deflections alone, with other influence lines of them.
    pub fn of_deflections(
        structure: &Structure,
        plan: &CasePlan,
        carrier: &Carrier,
        deflections: [Option<Lines<POWERS>>; 2],
    ) -> Result<Option<Overrun>, Error> {
        let Some(forces) = deflections.iter().flatten().next().map(Lines::zeros_like) else {
            return Ok(None);
        };
        let lines = CarrierLines {
            forces,
            deflections,
        }
        .joined(structure, carrier);
        Overrun::from_response(structure, plan, carrier, &lines, QUANTITIES).map(Some)
    }

    /// The passages of all trains in all stances.
    pub fn all(&self) -> impl Iterator<Item = &Passage> {
        self.passages.iter().flatten()
    }

    /// Bounds of the responses to a single train in a stance.
    pub fn bounds(&self, stance: usize) -> &Bounds {
        &self.bounds[0][stance]
    }

    /// The stances of a train that differ in response k.
    pub fn distinct(&self, k: usize, train: usize) -> &[usize] {
        &self.distinct[k][train]
    }

    /// The best arrangement of several trains. What is reached at the positions of one of `hints`, or where all its trains
    /// have moved along with the section, is a floor for all others.
    fn best_of_several(
        &self,
        plan: &CasePlan,
        at: (usize, f64, f64),
        hints: &[Hint<'_>],
    ) -> Option<Arrangement> {
        let moved = |hint: &Hint<'_>| {
            self.value_at(at, hint.at, 0.0)
                .max(self.value_at(at, hint.at, hint.by))
        };
        let reached = hints.iter().map(moved).fold(f64::NEG_INFINITY, f64::max);
        let found = |floor: f64| self.best_in(plan, at, self.pieces_reaching(at, floor), floor);
        found(reached - 2.0 * TIE * reached.abs()).or_else(|| found(f64::NEG_INFINITY))
    }

    /// Sign times response k at place s with all trains of an arrangement moved along; minus infinity where they cannot.
    fn value_at(&self, (k, sign, s): (usize, f64, f64), at: &Arrangement, by: f64) -> f64 {
        let each = at.trains.iter().zip(&self.passages);
        let of = |(standing, stances): (&Standing, &Vec<Passage>)| {
            let passage = &stances[standing.stance];
            let position = standing.position + by;
            let list = &passage.pieces.list;
            let piece = list.partition_point(|piece| piece.position[1] < position);
            let mut value = f64::INFINITY;
            if piece < list.len() {
                passage.parts(piece, k, s, |part| {
                    if part.position[0] <= position && position <= part.position[1] {
                        value = value.min(sign * part.at(position));
                    }
                });
            }
            if value.is_finite() {
                value
            } else {
                f64::NEG_INFINITY
            }
        };
        each.map(of).sum()
    }

    /// The pieces of all trains with bounds of sign times response k around place s, without those that do not reach
    /// `floor` with the best of the other trains, wherever these stand.
    fn pieces_reaching(&self, (k, sign, s): (usize, f64, f64), floor: f64) -> Vec<BoundedPieces> {
        let most = |(train, distinct): (usize, &Vec<usize>)| {
            let all = distinct
                .iter()
                .map(|&stance| self.bounds[train][stance].most_near(k, sign, s));
            all.fold(f64::NEG_INFINITY, f64::max)
        };
        let most: Vec<f64> = self.distinct[k].iter().enumerate().map(most).collect();
        let sum: f64 = most.iter().sum();
        let of_train = |(train, distinct): (usize, &Vec<usize>)| {
            let least = if floor == f64::NEG_INFINITY {
                floor
            } else {
                floor - (sum - most[train])
            };
            let of = |&stance: &usize| {
                let bounds = self.bounds[train][stance]
                    .near(k, sign, s)
                    .iter()
                    .enumerate();
                let pieces = &self.passages[train][stance].pieces.list;
                let kept = bounds.filter(|(_, bound)| **bound >= least);
                let piece = |(index, bound): (usize, &f64)| BoundedPiece {
                    position: pieces[index].position,
                    bound: *bound,
                    index,
                };
                (stance, kept.map(piece).collect())
            };
            distinct.iter().map(of).collect()
        };
        self.distinct[k].iter().enumerate().map(of_train).collect()
    }

    /// The best arrangement of several trains in some of their pieces whose value reaches `floor`.
    fn best_in(
        &self,
        plan: &CasePlan,
        (k, sign, s): (usize, f64, f64),
        mut kept: Vec<BoundedPieces>,
        floor: f64,
    ) -> Option<Arrangement> {
        plan.keep_promising(&mut kept, floor);
        let mut parts: Responses = Vec::with_capacity(kept.len());
        for (train, kept) in kept.iter_mut().enumerate() {
            let mut own = Vec::with_capacity(kept.len());
            for (stance, pieces) in kept.iter_mut() {
                let passage = &self.passages[train][*stance];
                let mut list = Vec::with_capacity(2 * pieces.len());
                pieces
                    .iter()
                    .for_each(|piece| passage.parts(piece.index, k, s, |part| list.push(part)));
                // now by the largest value in each part
                let bounded = |(index, part): (usize, &ResponsePiece)| BoundedPiece {
                    position: part.position,
                    bound: part.largest(sign).1,
                    index,
                };
                *pieces = list.iter().enumerate().map(bounded).collect();
                own.push((*stance, list));
            }
            parts.push(own);
        }
        plan.keep_promising(&mut kept, floor);
        for (own, kept) in parts.iter_mut().zip(&kept) {
            for ((_, list), (_, pieces)) in own.iter_mut().zip(kept) {
                *list = pieces.iter().map(|piece| list[piece.index]).collect();
            }
        }
        plan.best(&parts, sign, floor)
    }

    /// The arrangement with the largest value of sign times response k at place s. Where it is near one of `hints`, it is
    /// found sooner.
    pub fn best(
        &self,
        plan: &CasePlan,
        k: usize,
        sign: f64,
        s: f64,
        hints: &[Hint<'_>],
    ) -> Option<Arrangement> {
        let lower = |value: f64| value - 2.0 * TIE * value.abs();
        let [stances] = &self.passages[..] else {
            return self.best_of_several(plan, (k, sign, s), hints);
        };
        // The pieces of the hints, or the one with the largest bound, show what is reached at least.
        let mut known: SmallVec<[(usize, usize); 2]> = hints
            .iter()
            .map(|hint| (hint.at.trains[0].stance, hint.at.trains[0].origin[0]))
            .collect();
        if known.is_empty() {
            known.extend(self.most_promising(k, sign, s));
        }
        let mut floor = f64::NEG_INFINITY;
        for (stance, piece) in known {
            stances[stance].parts(piece, k, s, |part| {
                floor = floor.max(lower(part.largest(sign).1))
            });
        }
        let search = |floor: f64| {
            let mut best: Option<(f64, Standing)> = None;
            for &stance in &self.distinct[k][0] {
                for (piece, &bound) in self.bounds[0][stance].near(k, sign, s).iter().enumerate() {
                    if !can_exceed(&best, bound, floor) {
                        continue;
                    }
                    stances[stance].parts(piece, k, s, |part| {
                        offer_part(&mut best, &part, stance, sign, floor);
                    });
                }
            }
            best
        };
        // Rounding of a bound can leave out even what has the floor.
        let best = search(floor).or_else(|| search(f64::NEG_INFINITY));
        best.map(|(signed, standing)| Arrangement {
            signed,
            trains: vec![standing],
        })
    }

    /// The stance and the piece with the largest bound of sign times response k around place s under a single train.
    fn most_promising(&self, k: usize, sign: f64, s: f64) -> Option<(usize, usize)> {
        let of = |&stance: &usize| {
            let bounds = self.bounds[0][stance].near(k, sign, s).iter().enumerate();
            bounds
                .map(|(piece, bound)| ([stance, piece], *bound))
                .reduce(|a, b| if b.1 > a.1 { b } else { a })
        };
        let all = self.distinct[k][0].iter().filter_map(of);
        let found = all.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
        Some((found.0[0], found.0[1]))
    }

    /// The pieces in which sign times response k of a single train can exceed a value anywhere on the carrier: stance and
    /// piece.
    pub fn pieces_above(&self, k: usize, sign: f64, floor: f64) -> Vec<[usize; 2]> {
        let stances = self.distinct[k][0].iter();
        let all = stances.flat_map(|&stance| {
            (0..self.passages[0][stance].pieces.list.len()).map(move |p| [stance, p])
        });
        all.filter(|[stance, piece]| self.bounds[0][*stance].over_all(k, sign, *piece) > floor)
            .collect()
    }

    /// Response k at place s in an arrangement, without dead load.
    pub fn value(&self, k: usize, s: f64, arrangement: &Arrangement) -> f64 {
        let each = arrangement.trains.iter().zip(&self.passages);
        each.map(|(standing, stances)| {
            stances[standing.stance].value(k, s, standing.position, standing.origin)
        })
        .sum()
    }
}

/// Of the stances with equal response k, and beside other trains with equal extents as well, the first.
fn distinct_stances(plan: &CasePlan, train: usize, stances: &[Passage], k: usize) -> Vec<usize> {
    let placed = &plan.trains[train];
    let fits_alike =
        |a: usize, b: usize| plan.trains.len() == 1 || placed[a].extents == placed[b].extents;
    let mut out: Vec<usize> = Vec::new();
    for (stance, passage) in stances.iter().enumerate() {
        if !out
            .iter()
            .any(|&known| fits_alike(known, stance) && stances[known].is_same(passage, k, EQUAL))
        {
            out.push(stance);
        }
    }
    out
}
