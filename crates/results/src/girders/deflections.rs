//! The largest deflections of places of the rails over a run, and those under the loads.
//!
//! They are found like forces ([`super::forces`]): by the polynomials through the values at the nodes of pieces, for a number of
//! places of a rail at a time, and without the stays whose bounds are below the values of all these places.

use piecewise::{Lobatto, between};
use smallvec::SmallVec;
use splines::Probe;
use trains::{RailLoad, SectionSide};

use super::forces::by_rank;
use super::girder::{DIRECTIONS, LoadedGirders, probe};
use super::sections::RailPoint;
use super::value::{GirderValue, floors, offer_values};
use crate::pieces::{
    Bounds, Cell, Instant, LINE_DEGREE, LoadPieces, LoadState, Part, Peak, Piece, Stay, WHOLE,
    known, offer_piece, offer_polynomial,
};
use crate::response::PlaceMotions;

/// Factor by which a slope may exceed those that are seen of it: of polynomials of the fourth degree that are near to the function,
/// and between places.
const STEEPER: f64 = 1.5;

/// Number of points whose deflections are evaluated at once.
const AT_ONCE: usize = 100;

/// The largest deflections, by plane (vertical, lateral) and kind (largest, smallest).
pub(super) struct DeflectionPeaks {
    /// By point.
    pub points: Vec<[[Peak; 2]; 2]>,
    /// By span of all rails: those under loads.
    pub under: Vec<[[Option<GirderValue>; 2]; 2]>,
}

/// The largest deflection that is known of a span.
pub(super) struct KnownDeflection {
    /// Index in the list of rails.
    pub rail: usize,
    pub plane: usize,
    /// 0: largest, 1: smallest.
    pub kind: usize,
    pub x: f64,
    /// The deflection, with the sign of its kind.
    pub signed: f64,
}

/// A place of a rail.
#[derive(Clone, Copy)]
struct Place {
    x: f64,
    /// Index of its peaks.
    peaks: usize,
}

/// Places of a rail in their order, in the planes in which they are known.
struct PlaceSearch<'a> {
    girders: &'a LoadedGirders<'a>,
    /// Index in the list of rails.
    rail: usize,
    /// Index of the first span of the rail among those of all rails.
    first_span: usize,
    planes: Vec<usize>,
    places: Vec<Place>,
    /// Coordinates of the first place, and of the one behind the last.
    range: [f64; 2],
    /// All places in the first plane, then those in the next.
    motions: PlaceMotions<'a>,
    has_loads: bool,
}

impl DeflectionPeaks {
    /// Searches the points of all spans; the deflections under loads only if `has_loads`. `first_span` has the index of the first
    /// span of each rail.
    pub fn new(
        girders: &LoadedGirders<'_>,
        first_span: &[usize],
        has_loads: bool,
    ) -> DeflectionPeaks {
        let sections = girders.sections;
        let mut out = DeflectionPeaks {
            points: vec![[[Peak::NONE; 2]; 2]; sections.points.len()],
            under: vec![Default::default(); first_span[first_span.len() - 1]],
        };
        for (rail, first_span) in (0..sections.rails.len()).zip(first_span) {
            let of_point = |(peaks, point): (usize, &RailPoint)| {
                (point.rail == rail).then_some(Place { x: point.x, peaks })
            };
            let points = sections.points.iter().enumerate().filter_map(of_point);
            let places: Vec<Place> = points.collect();
            out.search(girders, (rail, *first_span), &places, has_loads);
        }
        out
    }

    /// The largest deflections at the places of those that are `known`, at any time, where they are larger.
    pub fn larger(girders: &LoadedGirders<'_>, known: &[KnownDeflection]) -> Vec<Option<Peak>> {
        let mut out = DeflectionPeaks {
            points: vec![[[Peak::above(f64::INFINITY); 2]; 2]; known.len()],
            under: Vec::new(),
        };
        for (own, known) in out.points.iter_mut().zip(known) {
            own[known.plane][known.kind] = Peak::above(known.signed);
        }
        for rail in 0..girders.sections.rails.len() {
            let of_known = |(peaks, known): (usize, &KnownDeflection)| {
                (known.rail == rail).then_some(Place { x: known.x, peaks })
            };
            let mut places: Vec<Place> = known.iter().enumerate().filter_map(of_known).collect();
            places.sort_by(|a, b| a.x.total_cmp(&b.x));
            out.search(girders, (rail, 0), &places, false);
        }
        let found = known.iter().zip(out.points);
        let found = found.map(|(known, own)| own[known.plane][known.kind]);
        found.map(|peak| peak.is_new.then_some(peak)).collect()
    }

    /// Searches places of a rail; the deflections under loads only if `has_loads`. Rails whose deflections are not known, or that
    /// are unrestrained in a plane, have none.
    fn search(
        &mut self,
        girders: &LoadedGirders<'_>,
        (rail, first_span): (usize, usize),
        all: &[Place],
        has_loads: bool,
    ) {
        if !girders.has_deflections() {
            return;
        }
        let probes = |places: &[Place], plane: usize| -> Vec<Probe> {
            let of = |place: &Place| probe(girders.sections.rails[rail].rail, place.x, plane);
            places.iter().map(of).collect()
        };
        let is_known =
            |plane: &usize| PlaceMotions::new(girders.foundation, &probes(all, *plane)).is_ok();
        let planes: Vec<usize> = [0, 1].into_iter().filter(is_known).collect();
        let x = |k: usize| all.get(k).map_or(f64::INFINITY, |place| place.x);
        for (chunk, places) in all.chunks(AT_ONCE).enumerate() {
            let of_plane = |plane: &usize| probes(places, *plane);
            let probes: Vec<Probe> = planes.iter().flat_map(of_plane).collect();
            let Ok(motions) = PlaceMotions::new(girders.foundation, &probes) else {
                continue;
            };
            let search = PlaceSearch {
                girders,
                rail,
                first_span,
                planes: planes.clone(),
                places: places.to_vec(),
                range: [x(chunk * AT_ONCE), x((chunk + 1) * AT_ONCE)],
                motions,
                has_loads,
            };
            search.run(self);
        }
    }

    /// The largest of sign times the deflection of a point.
    pub fn point(
        &self,
        girders: &LoadedGirders<'_>,
        at: usize,
        plane: usize,
        kind: usize,
    ) -> Option<GirderValue> {
        let peak = &self.points[at][plane][kind];
        (peak.signed > f64::NEG_INFINITY).then(|| GirderValue {
            signed: peak.signed,
            at: peak.at,
            x: girders.sections.points[at].x,
            section: None,
            own: None,
            side: SectionSide::At,
        })
    }
}

/// Deflections of places under unit loads in a cell.
struct CellDeflections {
    /// Whether deflections under loads in the cell are looked for, so that stays with loads there are looked at in any case.
    is_near: bool,
    /// By direction of the load: bounds for all places, downwards or along +z, and largest slopes by the coordinate of the load.
    bounds: [Vec<Bounds>; 3],
    slopes: [Vec<f64>; 3],
}

/// Deflections of places under unit loads and displacements.
struct UnitDeflections {
    /// By cell that is visited.
    cells: Vec<CellDeflections>,
    /// By degree of freedom: those of all places, and the largest slope between two of them.
    dofs: Vec<(Vec<f64>, f64)>,
}

/// How much deflections change in a piece from its middle node.
struct DeflectionChanges {
    /// By place.
    places: Vec<f64>,
    /// Largest slope along the rail.
    slope: f64,
}

impl UnitDeflections {
    /// Bounds during a stay; `None` where it is looked at in any case.
    fn bounds(&self, stay: &Stay, count: usize) -> Option<Vec<Bounds>> {
        let mut out = vec![Bounds::ZERO; count];
        for (q, (own, _)) in stay.dofs.iter().zip(&self.dofs) {
            let each = out.iter_mut().zip(own);
            each.for_each(|(sum, per)| sum.add_product(*q, Bounds::at(*per)));
        }
        for (cell, force) in &stay.loads {
            let own = Some(&self.cells[*cell]).filter(|own| !own.is_near)?;
            for (force, own) in force.iter().zip(&own.bounds).filter(|(f, _)| !f.is_zero()) {
                let each = out.iter_mut().zip(own);
                each.for_each(|(sum, per)| sum.add_product(*force, *per));
            }
        }
        Some(out)
    }

    fn changes(&self, pieces: &LoadPieces<'_>, index: usize, count: usize) -> DeflectionChanges {
        let stay = &pieces.stays[pieces.pieces[index].stay];
        let mut out = DeflectionChanges {
            places: vec![0.0; count],
            slope: 0.0,
        };
        for (change, (cell, _)) in pieces.changes(index).iter().zip(&stay.loads) {
            let own = &self.cells[*cell];
            for k in (0..3).filter(|k| change.size(*k) > 0.0) {
                let (force, moved) = (change.force[k], change.size(k) * change.place);
                let each = out
                    .places
                    .iter_mut()
                    .zip(own.bounds[k].iter().zip(&own.slopes[k]));
                each.for_each(|(sum, (bounds, slope))| {
                    *sum += force * bounds.size() + moved * slope;
                });
                // by reciprocity
                out.slope += change.size(k) * own.slopes[k].iter().copied().fold(0.0, f64::max);
            }
        }
        let [dofs, _] = pieces.changes_of_motion(index);
        for ((q, bounds), (own, slope)) in dofs.iter().zip(&stay.dofs).zip(&self.dofs) {
            let each = out.places.iter_mut().zip(own);
            each.for_each(|(sum, own)| *sum += q * own.abs());
            out.slope += bounds.size() * slope;
        }
        out
    }
}

impl PlaceSearch<'_> {
    fn count(&self) -> usize {
        self.planes.len() * self.places.len()
    }

    fn run(&self, peaks: &mut DeflectionPeaks) {
        let units = self.units();
        let stays = &self.girders.pieces.stays;
        let all: Vec<Option<Vec<Bounds>>> = stays
            .iter()
            .map(|stay| units.bounds(stay, self.count()))
            .collect();
        let rank = |own: &Option<Vec<Bounds>>| match own {
            Some(own) => own.iter().map(Bounds::size).fold(0.0, f64::max),
            None => f64::INFINITY,
        };
        for stay in by_rank(&all.iter().map(rank).collect::<Vec<f64>>()) {
            let is_low = |own: &Vec<Bounds>| self.is_within(own, true, peaks);
            if all[stay].as_ref().is_some_and(is_low) {
                continue;
            }
            if (self.girders.is_stopped)() {
                return;
            }
            for piece in stays[stay].pieces() {
                self.search(&units, piece, peaks);
            }
        }
    }

    /// Whether bounds of all places are within the values that are known; but for rounding, if `is_rounded`.
    fn is_within(&self, all: &[Bounds], is_rounded: bool, peaks: &DeflectionPeaks) -> bool {
        let mut planes = self.planes.iter().zip(all.chunks(self.places.len()));
        planes.all(|(plane, own)| {
            let all = || {
                self.places
                    .iter()
                    .map(|place| known(&peaks.points[place.peaks][*plane]))
            };
            let most = if is_rounded {
                // places that are not looked for have no value
                let found = all().flatten().filter(|value| value.is_finite());
                found.fold(0.0, f64::max)
            } else {
                0.0
            };
            own.iter()
                .zip(all())
                .all(|(bounds, known)| bounds.is_within(known, most))
        })
    }

    /// Sign of the deflection of a place in its displacement.
    fn sign(&self, place: usize) -> f64 {
        DIRECTIONS[self.planes[place / self.places.len()]]
    }

    fn units(&self) -> UnitDeflections {
        let pieces = self.girders.pieces;
        let visited = pieces.visited().iter();
        let cells = visited.map(|cell| self.cell(*cell)).collect();
        let dofs = pieces.stays.first().map_or(0, |stay| stay.dofs.len());
        let mut unit = vec![0.0; dofs];
        let x = |k: usize| self.places[k].x;
        let of_dof = |dof: usize| {
            unit[dof] = 1.0;
            let found = self.motions.under(&[], &unit, &[]);
            unit[dof] = 0.0;
            let mut own = found.unwrap_or_else(|_| vec![0.0; self.count()]);
            own.iter_mut()
                .enumerate()
                .for_each(|(place, own)| *own *= self.sign(place));
            let slopes = own.chunks(self.places.len()).flat_map(|own| {
                let pairs = own.windows(2).enumerate();
                pairs.map(|(k, pair)| (pair[1] - pair[0]).abs() / (x(k + 1) - x(k)))
            });
            let slope = STEEPER * slopes.fold(0.0, f64::max);
            (own, slope)
        };
        UnitDeflections {
            cells,
            dofs: (0..dofs).map(of_dof).collect(),
        }
    }

    /// The deflections under unit loads in a cell. Loads that the structure does not resist have none.
    fn cell(&self, cell: Cell) -> CellDeflections {
        let [low, high] = self.girders.pieces.cells().inside(cell);
        let rail = self.girders.sections.rails[self.rail].rail;
        let [from, to] = self.range;
        let nodes = Lobatto::of(LINE_DEGREE);
        let mut out = CellDeflections {
            is_near: self.has_loads && cell.0 == rail && low <= to && high >= from,
            bounds: std::array::from_fn(|_| vec![Bounds::ZERO; self.count()]),
            slopes: std::array::from_fn(|_| vec![0.0; self.count()]),
        };
        for direction in 0..3 {
            let mut force = [0.0; 3];
            force[direction] = 1.0;
            let under = |share: &f64| {
                let load = RailLoad {
                    rail: cell.0,
                    x: low + share * (high - low),
                    force,
                };
                self.motions.under(&[load], &[], &[]).ok()
            };
            let all: Option<Vec<Vec<f64>>> = nodes.nodes().iter().map(under).collect();
            let Some(all) = all else { continue };
            for place in 0..self.count() {
                let values: SmallVec<[f64; 5]> = all.iter().map(|own| own[place]).collect();
                let polynomial = nodes.polynomial(&values).times(self.sign(place));
                let slope = Bounds::of(&polynomial.derivative()).size() / (high - low);
                out.bounds[direction][place] = Bounds::of(&polynomial);
                out.slopes[direction][place] = STEEPER * slope;
            }
        }
        out
    }

    /// The loads in the range of the points during a piece, with their spans.
    fn under(&self, state: &LoadState<'_>) -> SmallVec<[(usize, usize); 8]> {
        let outline = &self.girders.sections.rails[self.rail];
        let [from, to] = self.range;
        let span_of = |load: usize| {
            let RailLoad { rail, x, .. } = state.loads[load];
            let is_near = rail == outline.rail && from <= x && x < to && self.has_loads;
            let span = is_near.then(|| outline.span(x, SectionSide::At))?;
            self.girders
                .is_carried(self.rail, x, span)
                .then_some((load, span))
        };
        (0..state.loads.len()).filter_map(span_of).collect()
    }

    /// The deflections of all places in a state, then those under loads, plane by plane; `None` where the structure is unrestrained.
    fn values(&self, state: &LoadState<'_>, under: &[(usize, usize)]) -> Option<Vec<f64>> {
        let rail = self.girders.sections.rails[self.rail].rail;
        let of_plane = |plane: &usize| {
            let plane = *plane;
            under
                .iter()
                .map(move |(load, _)| probe(rail, state.loads[*load].x, plane))
        };
        let also: SmallVec<[Probe; 16]> = self.planes.iter().flat_map(of_plane).collect();
        let mut out = self.motions.under(&state.loads, state.dofs(), &also).ok()?;
        let (places, loads) = out.split_at_mut(self.count());
        places
            .iter_mut()
            .enumerate()
            .for_each(|(place, own)| *own *= self.sign(place));
        for (plane, own) in self.planes.iter().zip(loads.chunks_mut(under.len().max(1))) {
            own.iter_mut().for_each(|own| *own *= DIRECTIONS[*plane]);
        }
        Some(out)
    }

    /// Whether a piece may have larger or smaller values than those that are known, by the values in its middle.
    fn may_exceed(
        &self,
        units: &UnitDeflections,
        index: usize,
        (values, under): (&[f64], &[(usize, usize)]),
        peaks: &DeflectionPeaks,
    ) -> bool {
        let pieces = self.girders.pieces;
        let DeflectionChanges {
            places: changes,
            slope,
        } = units.changes(pieces, index, self.count());
        let (places, loads) = values.split_at(self.count());
        let of_place = |(value, change): (&f64, &f64)| Bounds::at(*value).widened(*change);
        let bounds: Vec<Bounds> = places.iter().zip(&changes).map(of_place).collect();
        if !self.is_within(&bounds, false, peaks) {
            return true;
        }
        let change = changes.iter().copied().fold(0.0, f64::max);
        let mut planes = self.planes.iter().zip(loads.chunks(under.len().max(1)));
        planes.any(|(plane, own)| {
            own.iter().zip(under).any(|(value, (load, span))| {
                let place = pieces.changes(index)[*load].place;
                let bounds = Bounds::at(*value).widened(change + slope * place);
                let known_values = peaks.under[self.first_span + span][*plane];
                !bounds.is_within(known(&floors(&known_values)), 0.0)
            })
        })
    }

    fn search(&self, units: &UnitDeflections, index: usize, peaks: &mut DeflectionPeaks) {
        let pieces = self.girders.pieces;
        let piece = &pieces.pieces[index];
        let middle = pieces.at_middle(index);
        let under = self.under(&middle);
        let Some(values) = self.values(&middle, &under) else {
            return;
        };
        if !self.may_exceed(units, index, (&values, &under), peaks) {
            return;
        }
        let states: Vec<LoadState<'_>> = (0..=piece.degree)
            .map(|k| pieces.at_node(piece, k))
            .collect();
        let values = states.iter().map(|state| self.values(state, &under));
        let values: Option<Vec<Vec<f64>>> = values.collect();
        let Some(values) = values.map(|values| values.concat()) else {
            return;
        };
        let all = self.count() + self.planes.len() * under.len();
        let at = (index, piece.nodes());
        let of = |place: usize| -> SmallVec<[f64; 17]> {
            values.iter().skip(place).step_by(all).copied().collect()
        };
        let bounds = Bounds::of_columns(&values, all);
        for (n, &plane) in self.planes.iter().enumerate() {
            for (k, own) in self.places.iter().enumerate() {
                let place = n * self.places.len() + k;
                let peaks = &mut peaks.points[own.peaks][plane];
                if bounds[place].is_within(known(peaks), 0.0) {
                    continue;
                }
                let passages = self.passages(piece, &states, own.x);
                if passages.is_empty() {
                    offer_piece(peaks, at, &of(place));
                } else {
                    self.offer_between(peaks, index, (plane, own.x), &passages);
                }
            }
            for (k, (load, span)) in under.iter().enumerate() {
                let known = &mut peaks.under[self.first_span + span][plane];
                let values = of(self.count() + n * under.len() + k);
                offer_values(known, at, &values, &|best| GirderValue {
                    signed: best.signed,
                    at: best.at,
                    x: pieces.at(best.at).loads[*load].x,
                    section: None,
                    own: None,
                    side: SectionSide::At,
                });
            }
        }
    }

    /// Shares of a piece at which loads pass a place, where the rail has a corner under each load if it shears. The `states` are
    /// those at the nodes of the piece.
    fn passages(&self, piece: &Piece, states: &[LoadState<'_>], x: f64) -> SmallVec<[f64; 4]> {
        let rail = self.girders.sections.rails[self.rail].rail;
        let loads = &states[0].loads;
        let mut out = SmallVec::new();
        for load in (0..loads.len()).filter(|load| loads[*load].rail == rail) {
            let distances: SmallVec<[f64; 17]> =
                states.iter().map(|state| state.loads[load].x - x).collect();
            if Bounds::through(distances.iter().copied()).contains(0.0) {
                out.extend(piece.nodes().polynomial(&distances).roots());
            }
        }
        out.retain(|share| *share > 0.0 && *share < 1.0);
        out.sort_by(f64::total_cmp);
        out
    }

    /// Offers the deflection of a place in a piece, as a polynomial between the passages of loads.
    fn offer_between(
        &self,
        peaks: &mut [Peak; 2],
        index: usize,
        (plane, x): (usize, f64),
        passages: &[f64],
    ) {
        let pieces = self.girders.pieces;
        let nodes = pieces.pieces[index].nodes();
        let mut from = 0.0;
        for to in passages.iter().copied().chain([1.0]) {
            let ends = [from, to];
            let value = |node: &f64| {
                let share = between(ends, *node);
                let state = pieces.at(Instant {
                    piece: index,
                    share,
                });
                Some(self.girders.deflections(self.rail, &[x], plane, &state)?[0])
            };
            let values: Option<Vec<f64>> = nodes.nodes().iter().map(value).collect();
            let Some(values) = values else { return };
            let part = Part { ends, ..WHOLE };
            offer_polynomial(peaks, index, &nodes.polynomial(&values), part);
            from = to;
        }
    }
}
