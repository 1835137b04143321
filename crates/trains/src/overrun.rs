//! All trains of a case over one carrier, and the best arrangement for a response of one of its sections.

use crate::bounds::Bounds;
use crate::error::Error;
use crate::line::Lines;
use crate::plan::{Arrangement, CasePlan, Responses, Standing, TIE, can_exceed, offer_part};
use crate::rail_deflection::{CarrierLines, POWERS};
use crate::section::Passage;
use crate::structure::{Carrier, GirderResponse, QUANTITIES, Structure};

/// Responses that differ by no more than this, relative to the largest, are those of one stance.
const EQUAL: f64 = 1e-14;

/// The trains of a case over one carrier, by train and stance.
pub(crate) struct Overrun {
    pub passages: Vec<Vec<Passage>>,
    /// By response and train: the stances that differ. A lateral force, for instance, does not change a vertical moment,
    /// whatever its sign.
    distinct: Vec<Vec<Vec<usize>>>,
    /// Bounds of the responses to a single train, by stance; none for several.
    bounds: Vec<Bounds>,
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
        let passages = plan.trains.iter().map(|stances| stances.iter().map(of).collect());
        let passages: Vec<Vec<Passage>> = passages.collect::<Result<_, _>>()?;
        let distinct = |k: usize| match k >= first {
            true => passages.iter().map(|stances| distinct_stances(stances, k)).collect(),
            false => vec![Vec::new(); passages.len()],
        };
        let distinct = (0..GirderResponse::ALL.len()).map(distinct).collect();
        let bounds = match &passages[..] {
            [stances] => stances.iter().map(|passage| Bounds::new(passage, first)).collect(),
            _ => Vec::new(),
        };
        Ok(Overrun { passages, distinct, bounds })
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
        let lines = CarrierLines { forces, deflections };
        Overrun::from_response(structure, plan, carrier, &lines, QUANTITIES).map(Some)
    }

    /// The passages of all trains in all stances.
    pub fn all(&self) -> impl Iterator<Item = &Passage> {
        self.passages.iter().flatten()
    }

    /// Bounds of the responses to a single train in a stance.
    pub fn bounds(&self, stance: usize) -> &Bounds {
        &self.bounds[stance]
    }

    /// The stances of a train that differ in response k.
    pub fn distinct(&self, k: usize, train: usize) -> &[usize] {
        &self.distinct[k][train]
    }

    /// Response k of the section at place s to each train, in the stances that differ.
    fn responses(&self, k: usize, s: f64) -> Responses {
        let of = |(stances, distinct): (&Vec<Passage>, &Vec<usize>)| {
            distinct.iter().map(|&stance| (stance, stances[stance].response(k, s))).collect()
        };
        self.passages.iter().zip(&self.distinct[k]).map(of).collect()
    }

    /// Sign times response k at place s with the trains at the positions of an arrangement for another section.
    fn value_at(&self, k: usize, sign: f64, s: f64, at: &Arrangement) -> f64 {
        let each = at.trains.iter().zip(&self.passages);
        let of = |(standing, stances): (&Standing, &Vec<Passage>)| {
            let mut value = f64::INFINITY;
            stances[standing.stance].parts(standing.origin[0], k, s, |part| {
                if part.position[0] <= standing.position && standing.position <= part.position[1] {
                    value = value.min(sign * part.at(standing.position));
                }
            });
            if value.is_finite() { value } else { f64::NEG_INFINITY }
        };
        each.map(of).sum()
    }

    /// The arrangement with the largest value of sign times response k at place s. Where it is near that of `hint`, it is
    /// found sooner.
    pub fn best(
        &self,
        plan: &CasePlan,
        k: usize,
        sign: f64,
        s: f64,
        hint: Option<&Arrangement>,
    ) -> Option<Arrangement> {
        let lower = |value: f64| value - 2.0 * TIE * value.abs();
        let [stances] = &self.passages[..] else {
            let floor = hint.map_or(f64::NEG_INFINITY, |hint| lower(self.value_at(k, sign, s, hint)));
            let responses = self.responses(k, s);
            let found = |floor: f64| plan.best(&responses, sign, floor);
            return found(floor).or_else(|| found(f64::NEG_INFINITY));
        };
        // The piece of the hint, or the one with the largest bound, shows what is reached at least.
        let known = hint.map(|hint| (hint.trains[0].stance, hint.trains[0].origin[0]));
        let mut floor = f64::NEG_INFINITY;
        if let Some((stance, piece)) = known.or_else(|| self.most_promising(k, sign, s)) {
            stances[stance].parts(piece, k, s, |part| floor = floor.max(lower(part.largest(sign).1)));
        }
        let search = |floor: f64| {
            let mut best: Option<(f64, Standing)> = None;
            for &stance in &self.distinct[k][0] {
                for (piece, &bound) in self.bounds[stance].near(k, sign, s).iter().enumerate() {
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
        best.map(|(signed, standing)| Arrangement { signed, trains: vec![standing] })
    }

    /// The stance and the piece with the largest bound of sign times response k around place s under a single train.
    fn most_promising(&self, k: usize, sign: f64, s: f64) -> Option<(usize, usize)> {
        let of = |&stance: &usize| {
            let bounds = self.bounds[stance].near(k, sign, s).iter().enumerate();
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
        let all = stances
            .flat_map(|&stance| (0..self.passages[0][stance].pieces.list.len()).map(move |p| [stance, p]));
        all.filter(|[stance, piece]| self.bounds[*stance].over_all(k, sign, *piece) > floor).collect()
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

/// Of the stances with equal response k the first.
fn distinct_stances(stances: &[Passage], k: usize) -> Vec<usize> {
    let mut out: Vec<usize> = Vec::new();
    for (stance, passage) in stances.iter().enumerate() {
        if !out.iter().any(|&known| stances[known].is_same(passage, k, EQUAL)) {
            out.push(stance);
        }
    }
    out
}
