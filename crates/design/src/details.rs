//! What follows from the governing states: stresses, end stops, pairs of rails.

use fea::{Model, Rail};
use formats::design::Design;
use formats::verdict::OmittedCheck;
use trains::{DeadLoads, Error, TrainCase};

use crate::end_stops::{self, end_stop_forces};
use crate::girder_sections::GirderSections;
use crate::outcome::{EndStopForce, RailPairResponse, SolvedCase, StressCheck, WheelStress};
use crate::placed::RailLines;
use crate::rail_pairs::{self, pair_responses};
use crate::state_forces::StateForces;
use crate::stresses::StressBasis;
use crate::wheel_stresses::{self, wheel_stresses};

/// Results that follow from governing states, and what they lack.
#[derive(Clone, Debug, Default)]
pub(crate) struct Details {
    pub stresses: Vec<StressCheck>,
    pub wheel_stresses: Vec<WheelStress>,
    pub end_stops: Vec<EndStopForce>,
    pub pairs: Vec<RailPairResponse>,
    pub left_out: Vec<OmittedCheck>,
}

impl Details {
    /// The details of a design; `lines` are its rails, `trains` are its cases with their factors.
    pub fn new(
        design: &Design,
        model: &Model,
        rails: &[Rail],
        lines: &RailLines,
        dead: &DeadLoads,
        trains: &[TrainCase],
        cases: &[SolvedCase],
    ) -> Result<Details, Error> {
        let sections =
            GirderSections::new(&design.spec, design.practice.lateral_section, model, rails);
        let basis = StressBasis {
            design,
            lines,
            sections: &sections,
            trains,
            cases,
        };
        let mut left_out = basis.left_out();
        left_out.extend(wheel_stresses::left_out(&basis));
        left_out.extend(end_stops::left_out(design));
        let mut out = Details {
            end_stops: end_stop_forces(design),
            left_out,
            ..Details::default()
        };
        let has_pairs = rail_pairs::has_any(design, lines);
        if !(sections.have_strength() || wheel_stresses::has_any(&basis) || has_pairs) {
            return Ok(out);
        }
        let wheels = design.trains.iter().flat_map(|train| &train.wheels);
        let eccentric = wheels.into_iter().any(|wheel| wheel.eccentricity != 0.0);
        let mut forces = StateForces::new(model, rails, lines, dead, eccentric)?;
        out.stresses = basis.check(&mut forces)?;
        out.wheel_stresses = wheel_stresses(&basis, &forces);
        if has_pairs {
            out.pairs = pair_responses(design, lines, forces.structure(), trains, cases)?;
        }
        Ok(out)
    }
}
