//! Extremes and envelopes of the girders in a run: moments, shear forces, normal forces and torsion of the members that
//! carry rails, and deflections of the rails, with the signs of [`trains::GirderResponse`].
//!
//! At each time the forces of a member follow from the influence lines of its end, by equilibrium with the loads on it
//! ([`trains::MemberForces`]); inertia and dead load are added (`distributed`). A run is divided into pieces of time in which what
//! the loads cause is a polynomial (`pieces`).
//!
//! 1. The polynomials of all sections and of both sides of each load, of all listed places and of the places under loads have their
//!    largest and smallest values (`forces`, `deflections`). Times at which loads are too far or too small are left out by
//!    a bound.
//! 2. The largest values of spans are sought between sections and places as well (`spans`, `climb`). Without loads that are
//!    distributed along members, forces are largest at sections or beside loads.
//! 3. Envelopes are evaluated at stations, ends of members and spans, twentieths of spans, and the places of all
//!    extremes (`structure`).
//!
//! The largest and smallest reactions of supports are polynomials of time in the same pieces (`reactions`). Where the scene asks
//! for stresses, those of the fibres are sought with the forces (`fibres`, `stresses`).
//!
//! Files, lowest first: solved, fibres, sections, distributed, value, girder, climb, member_lines, forces, deflections, spans, stresses,
//! reactions, structure, deferred, which computes all of it when it is asked for, and this one.

mod climb;
mod deferred;
mod deflections;
mod distributed;
mod fibres;
mod forces;
mod girder;
mod member_lines;
mod reactions;
mod sections;
mod solved;
mod spans;
mod stresses;
mod structure;
mod value;

pub(crate) use deferred::{DeferredGirders, GirderInputs};
pub use reactions::GirderReaction;
pub(crate) use solved::SolvedMembers;
pub use stresses::{GirderStress, GirderStresses};

use std::fmt::Write;

use design::{plane_word, quantity_word, side_word};
use formats::scene::Scene;
use serde_json::{Value, json};
use trains::{GirderResponse, SectionSide};

use crate::columns::bytes;

/// The extreme of one quantity over a span.
#[derive(Clone, Debug, PartialEq)]
pub struct GirderExtreme {
    /// Index of the rail in the scene.
    pub rail: usize,
    /// Number of the span, from 1; 0 and one more than the last for overhangs.
    pub span: usize,
    /// The quantity.
    pub quantity: GirderResponse,
    /// Whether it is the largest value; otherwise the smallest.
    pub is_max: bool,
    /// The value; it includes the dead load where the output of the scene requests it.
    pub value: f64,
    /// The part that is due to dead load; 0 for deflections.
    pub dead: f64,
    /// Rail coordinate of the section.
    pub x: f64,
    /// Side of the section.
    pub side: SectionSide,
    /// Time.
    pub time: f64,
}

/// The largest or smallest value of one quantity at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct GirderEnvelope {
    /// Index of the rail in the scene.
    pub rail: usize,
    /// Rail coordinate.
    pub x: f64,
    /// The quantity.
    pub quantity: GirderResponse,
    /// Whether it is the largest value; otherwise the smallest.
    pub is_max: bool,
    /// The value, the larger one of both sides of the section.
    pub value: f64,
    /// Time.
    pub time: f64,
    /// Moment, shear and deflection of the same section and plane at this time.
    pub coincident: [f64; 3],
}

/// Extremes and envelopes of the girders of a run. Rails and quantities that are zero throughout are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GirderExtremes {
    /// Extremes by rail, span and quantity, largest first.
    pub extremes: Vec<GirderExtreme>,
    /// Extremes of the reactions of the same structures, largest first; all directions of all supports are listed.
    pub reactions: Vec<GirderReaction>,
    /// Envelopes by rail, place and quantity, largest first.
    pub envelope: Vec<GirderEnvelope>,
    /// Largest direct stresses, where the scene asks for them.
    pub stresses: GirderStresses,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// Word of a kind of extreme.
const fn kind_word(is_max: bool) -> &'static str {
    if is_max { "max" } else { "min" }
}

impl GirderExtremes {
    /// The member `extremes` of the summary of case `number`, counted from 1; `None` without girders.
    #[must_use]
    pub fn json(&self, scene: &Scene, number: usize) -> Option<Value> {
        let one = |found: &GirderExtreme| {
            json!({
                "case": number,
                "rail": scene.rails[found.rail].name,
                "span": found.span,
                "quantity": quantity_word(found.quantity),
                "plane": plane_word(found.quantity),
                "kind": kind_word(found.is_max),
                "value": found.value,
                "x": found.x,
                "side": side_word(found.side),
                "dead": found.dead,
                "time": found.time,
            })
        };
        let reactions = self.reactions.iter().map(|reaction| reaction.json(number));
        (!self.extremes.is_empty())
            .then(|| self.extremes.iter().map(one).chain(reactions).collect())
    }

    /// The envelopes of case `number`, counted from 1, as comma-separated values; `None` without girders.
    ///
    /// # Errors
    /// None in practice: writing to memory does not fail.
    pub fn csv(&self, scene: &Scene, number: usize) -> Result<Option<Vec<u8>>, csv::Error> {
        if self.envelope.is_empty() {
            return Ok(None);
        }
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record([
            "case",
            "rail",
            "plane",
            "x",
            "quantity",
            "kind",
            "value",
            "time",
            "moment",
            "shear",
            "deflection",
        ])?;
        let (number, mut text) = (number.to_string(), String::new());
        for row in &self.envelope {
            let [value, time] = [row.value, row.time];
            writer.write_field(&number)?;
            writer.write_field(&scene.rails[row.rail].name)?;
            writer.write_field(plane_word(row.quantity))?;
            write_number(&mut writer, row.x, &mut text)?;
            writer.write_field(quantity_word(row.quantity))?;
            writer.write_field(kind_word(row.is_max))?;
            for value in [value, time].into_iter().chain(row.coincident) {
                write_number(&mut writer, value, &mut text)?;
            }
            writer.write_record(None::<&[u8]>)?;
        }
        bytes(writer).map(Some)
    }
}

/// Writes a number as a field; `text` is memory.
fn write_number(
    writer: &mut csv::Writer<Vec<u8>>,
    value: f64,
    text: &mut String,
) -> Result<(), csv::Error> {
    text.clear();
    write!(text, "{}", value + 0.0).expect("a string takes all text");
    writer.write_field(&*text)
}
