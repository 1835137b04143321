//! All trains of a case over one carrier.

use crate::error::Error;
use crate::line::Lines;
use crate::pieces::{Piece, Pieces};
use crate::plan::CasePlan;
use crate::section::TrainOnCarrier;
use crate::structure::{Carrier, QUANTITIES, Structure};

/// The trains of a case over one carrier, by train and stance.
pub(crate) struct Overrun {
    pub pieces: Vec<Vec<Pieces<QUANTITIES>>>,
    pub on: Vec<Vec<TrainOnCarrier>>,
}

impl Overrun {
    pub fn new(
        structure: &Structure,
        plan: &CasePlan,
        carrier: &Carrier,
        lines: &Lines<QUANTITIES>,
    ) -> Result<Overrun, Error> {
        let slack = structure.slack();
        let pieces = plan
            .trains
            .iter()
            .map(|stances| stances.iter().map(|train| Pieces::sum(lines, train, slack)).collect());
        let on = plan.trains.iter().map(|stances| {
            stances.iter().map(|train| TrainOnCarrier::new(structure, carrier, train)).collect()
        });
        Ok(Overrun { pieces: pieces.collect(), on: on.collect::<Result<_, _>>()? })
    }

    /// The quantities at a section as pieces, by train and stance.
    pub fn section(&self, s: f64) -> Vec<Vec<Vec<Piece<QUANTITIES>>>> {
        let of = |(pieces, on): (&Vec<Pieces<QUANTITIES>>, &Vec<TrainOnCarrier>)| {
            pieces.iter().zip(on).map(|(pieces, on)| on.section(pieces, s)).collect()
        };
        self.pieces.iter().zip(&self.on).map(of).collect()
    }
}
