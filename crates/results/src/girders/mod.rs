//! Extremes and envelopes of the girders in a run: moments, shear forces, normal forces and torsion of the members that
//! carry rails, and deflections of the rails, with the signs of [`trains::GirderResponse`].
//!
//! At each row of the history the forces of a member follow from the influence lines of its end, by equilibrium with the
//! wheels on it, so that sections anywhere, and those just before and just behind each wheel, cost little
//! ([`trains::MemberForces`]). Inertia and dead load are added (`distributed`). Between the rows positions, forces and
//! motions are interpolated (`instants`).
//!
//! 1. All sections, and both sides of each wheel, are evaluated at rows near enough to each other (`scanned_rows`); so are the
//!    instants at which wheels pass sections, on both sides, and deflections at all listed places and under each wheel (`scan`).
//! 2. Each peak is followed to the row with the largest value, refined over time and, at sections without a wheel, along the member
//!    (`refine`, `spans`); deflections likewise along the rail and along the paths of wheels (`deflections`).
//! 3. Envelopes are evaluated at stations, ends of members and spans, twentieths of spans, and the places of all
//!    extremes (`structure`).
//! 4. The same is done at the ends of steps and inside of long ones, which the run records beside its output times, as many of
//!    them as loads and motions need (`kept_rows`), and the extremes are compared with those from fewer of them (`rows`). Runs
//!    without steps, such as quasi-static ones, are repeated with more rows.
//!
//! Not covered: what happens between two rows and is not shown by their values, such as a contact that is lost and found
//! again between them; extremes between sections without a wheel that are farther than a section from the largest one.
//!
//! The largest and smallest reactions of supports are found at the same rows and refined in the same way (`reactions`).
//! Where the scene asks for stresses, the largest ones are found among the same forces (`fibres`, `stresses`).
//!
//! Files, lowest first: solved, peaks, kept_rows, instants, scanned_rows, fibres, sections, points, distributed, girder, scan, refine, deflections, spans,
//! stresses, reactions, structure, rows, this one, and `deferred`, which computes all of it when it is asked for.

mod deferred;
mod deflections;
mod distributed;
mod fibres;
mod girder;
mod instants;
mod kept_rows;
mod peaks;
mod points;
mod reactions;
mod refine;
mod rows;
mod scan;
mod scanned_rows;
mod sections;
mod solved;
mod spans;
mod stresses;
mod structure;

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
