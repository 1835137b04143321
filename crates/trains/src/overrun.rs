//! All trains of a case over one carrier, and the best arrangement for a response of one of its sections.

use crate::error::Error;
use crate::line::Lines;
use crate::plan::{Arrangement, CasePlan, Responses, Standing, TIE, offer_part};
use crate::rail_deflection::{CarrierLines, POWERS};
use crate::section::Passage;
use crate::structure::{Carrier, GirderResponse, Structure};

/// Responses that differ by no more than this, relative to the largest, are those of one stance.
const EQUAL: f64 = 1e-14;

/// The trains of a case over one carrier, by train and stance.
pub(crate) struct Overrun {
    pub passages: Vec<Vec<Passage>>,
    /// By response and train: the stances that differ. A lateral force, for instance, does not change a vertical moment,
    /// whatever its sign.
    distinct: Vec<Vec<Vec<usize>>>,
}

impl Overrun {
    pub fn new(
        structure: &Structure,
        plan: &CasePlan,
        carrier: &Carrier,
        lines: &CarrierLines,
    ) -> Result<Overrun, Error> {
        let of = |train| Passage::new(structure, carrier, train, lines);
        let passages = plan.trains.iter().map(|stances| stances.iter().map(of).collect());
        let passages: Vec<Vec<Passage>> = passages.collect::<Result<_, _>>()?;
        let distinct = |k: usize| passages.iter().map(|stances| distinct_stances(stances, k)).collect();
        let distinct = (0..GirderResponse::ALL.len()).map(distinct).collect();
        Ok(Overrun { passages, distinct })
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
        Overrun::new(structure, plan, carrier, &CarrierLines { forces, deflections }).map(Some)
    }

    /// The passages of all trains in all stances.
    pub fn all(&self) -> impl Iterator<Item = &Passage> {
        self.passages.iter().flatten()
    }

    /// The stances of a train that differ in response k.
    pub fn distinct(&self, k: usize, train: usize) -> &[usize] {
        &self.distinct[k][train]
    }

    /// Response k of the section at place s to each train, in the stances that differ.
    pub fn responses(&self, k: usize, s: f64) -> Responses {
        let of = |(train, stances): (usize, &Vec<Passage>)| {
            let own = self.distinct[k][train].iter();
            own.map(|&stance| (stance, stances[stance].response(k, s))).collect()
        };
        self.passages.iter().enumerate().map(of).collect()
    }

    /// The arrangement with the largest value of sign times response k at place s. Where it is near that of `hint`, it is
    /// found sooner.
    pub fn best(
        &self,
        plan: &CasePlan,
        k: usize,
        sign: f64,
        s: f64,
        hint: Option<&Standing>,
    ) -> Option<Arrangement> {
        let [stances] = &self.passages[..] else { return plan.best(&self.responses(k, s), sign) };
        let mut floor = f64::NEG_INFINITY;
        if let Some(hint) = hint {
            stances[hint.stance].parts(hint.origin[0], k, s, |part| {
                let found = part.times(sign).largest_above(part.length(), floor);
                floor = found.map_or(floor, |(_, value)| floor.max(value - 2.0 * TIE * value.abs()));
            });
        }
        let mut best: Option<(f64, Standing)> = None;
        for &stance in &self.distinct[k][0] {
            for piece in 0..stances[stance].pieces.list.len() {
                stances[stance].parts(piece, k, s, |part| {
                    offer_part(&mut best, &part, stance, sign, floor);
                });
            }
        }
        best.map(|(signed, standing)| Arrangement { signed, trains: vec![standing] })
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
