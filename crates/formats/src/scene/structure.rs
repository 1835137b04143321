//! Structures of a scene: what they are, and how the simulation sees them.

use std::sync::Arc;

use splines::Couplings;

use super::files::Files;
use super::gauge::{self, Gauge};
use super::raw::{RawStructure, RawTables};
use super::{irregularity, tables, ties};
use crate::check::Check;
use crate::fault::{Fault, nearest};
use crate::place::Place;
use crate::spec::{RailOutline, Spec};
use crate::units::Dimension;

/// Something that carries rails.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Its name.
    pub name: String,
    /// Where its influence coefficients come from.
    pub origin: Origin,
    /// Its rails.
    pub rails: Vec<RailOutline>,
    /// How it gives way.
    pub foundation: Foundation,
    /// Whether the scene leaves the foundation to the run ("auto"); then `foundation` is the default.
    pub auto: bool,
    /// Share of critical damping of modes.
    pub damping: f64,
    /// How its table is read.
    pub reading: Reading,
    /// Which of its couplings count.
    pub couplings: Couplings,
    /// Relative error allowed to the choice of the foundation.
    pub tolerance: f64,
    /// Places whose displacement is recorded.
    pub gauges: Vec<Gauge>,
    /// Whether friction, drives and brakes load it along its rails.
    pub longitudinal: bool,
    /// Shapes of its rails when nothing loads them, one a rail; none where all are straight.
    pub irregularities: Vec<sim::Irregularity>,
    /// The body that carries it; `None`: the ground.
    pub on: Option<On>,
}

/// What carries a structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct On {
    /// Index of the body.
    pub body: usize,
    /// Where the spec's origin is from that body's.
    pub at: [f64; 3],
    /// Which of x, y, z, roll, yaw, pitch of the body's origin may move.
    pub moves: [bool; 6],
}

/// Where influence coefficients come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A beam spec, in the scene's units.
    Spec {
        /// The file, as the scene names it.
        file: String,
        /// Its contents.
        spec: Arc<Spec>,
    },
    /// SPLINE tables of an ADAMS data set, in the scene's units.
    Tables {
        /// The file, as the scene names it.
        file: String,
        /// Stations and values of the tables.
        tables: Arc<TablePair>,
    },
}

impl Origin {
    /// Its rails.
    fn rails(&self) -> Vec<RailOutline> {
        match self {
            Origin::Spec { spec, .. } => spec.rails(),
            Origin::Tables { tables, .. } => {
                let stations = tables.stations.clone();
                let ends = stations.first().zip(stations.last());
                let range = ends.map_or([0.0; 2], |(first, last)| [*first, *last]);
                vec![RailOutline { name: crate::spec::GIRDER_RAIL.to_owned(), range, stations }]
            }
        }
    }
}

/// Two SPLINE tables at the same stations.
#[derive(Clone, Debug, PartialEq)]
pub struct TablePair {
    /// Stations of the rail.
    pub stations: Vec<f64>,
    /// `vertical[i][j]`: vertical deflection at station i per unit vertical load at station j.
    pub vertical: Option<Vec<Vec<f64>>>,
    /// The same, lateral.
    pub lateral: Option<Vec<Vec<f64>>>,
}

/// How a structure gives way under wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Foundation {
    /// Not at all.
    Rigid,
    /// As a chain of rigid parts and massless beams between their centres.
    Parts {
        /// Number of parts.
        count: usize,
        /// How a wheel passes from one to the next.
        handover: Handover,
        /// Share of critical damping of each natural mode of parts with mass.
        damping: f64,
    },
    /// By its influence coefficients, without mass.
    Influence,
    /// In its lowest natural modes, with the static give of the others.
    Modal {
        /// Number of modes.
        modes: usize,
        /// Share of critical damping of each.
        damping: f64,
    },
    /// In all modes of a finite-element mesh.
    Full {
        /// Elements a member.
        elements: usize,
        /// Share of critical damping of each mode.
        damping: f64,
    },
    /// As a rail on sprung ties.
    Ties {
        /// Whether it moves in natural modes; otherwise it has no mass.
        moves: bool,
        /// Number of modes; `None`: all of the mesh.
        modes: Option<usize>,
        /// Share of critical damping of each mode.
        damping: f64,
        /// Damper of each tie, force time/length.
        c: f64,
    },
}

/// How a wheel passes from one rigid part to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Handover {
    /// One contact on a datum blended by STEP over `length` about the joint; none = from centre to centre.
    Blend {
        /// Length of the blend.
        length: Option<f64>,
    },
    /// One one-sided force a part, faded by STEP over `length` about the joint; none = from centre to centre.
    PerPart {
        /// Length of the fading.
        length: Option<f64>,
    },
}

/// How a table is read between its stations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// The exact surface of the beams.
    Exact,
    /// Natural cubic splines along both directions.
    Natural,
    /// AKISPL along the load's position, linear along the deflection's.
    Akispl,
    /// CUBSPL in place of AKISPL.
    Cubspl,
}

impl Reading {
    /// Words of the readings.
    pub const WORDS: [(&'static str, Reading); 4] = [
        ("exact", Reading::Exact),
        ("natural", Reading::Natural),
        ("akispl", Reading::Akispl),
        ("cubspl", Reading::Cubspl),
    ];

    /// Its word in scenes.
    #[must_use]
    pub fn word(self) -> &'static str {
        Reading::WORDS.iter().find(|(_, reading)| *reading == self).map_or("", |(word, _)| *word)
    }
}

impl Foundation {
    /// Its word in scenes.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Foundation::Rigid => "rigid",
            Foundation::Parts { .. } => "parts",
            Foundation::Influence => "influence",
            Foundation::Modal { .. } => "modal",
            Foundation::Full { .. } => "full",
            Foundation::Ties { .. } => "ties",
        }
    }
}

/// Relative error allowed to the choice of a foundation where the scene gives none.
pub const TOLERANCE: f64 = 1e-3;
/// Least tolerance that runs can be compared to.
const FINEST: f64 = 1e-7;

/// Modes where the scene gives no number of them.
pub const MODES: usize = 5;

/// Elements a member where the scene gives no number of them.
pub const ELEMENTS: usize = 8;

/// Parts of the chain where the scene gives no count.
pub const PARTS: usize = 2;

#[derive(Clone, Copy)]
enum Word {
    Rigid,
    Parts,
    Influence,
    Modal,
    Full,
    Ties,
    Auto,
}

/// Reads a structure; `others`: names of the scene's other ones.
pub(super) fn read(
    name: &str,
    others: &[&str],
    raw: &RawStructure,
    at: &Place<'_>,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Option<Structure> {
    let word = foundation_word(raw, at, check);
    let count = raw.count.unwrap_or(PARTS);
    if count < 2 {
        check
            .faults
            .add(Fault::new(&at.key("count"), "must be at least 2").got(count).hint("parts of the chain"));
    }
    let handover = read_handover(raw, at, check);
    let damping = read_damping(raw, at, check);
    let reading = match &raw.reading {
        Some(word) => check.faults.word(word, &at.key("reading"), &Reading::WORDS).unwrap_or(Reading::Exact),
        None => Reading::Exact,
    };
    let couplings = read_couplings(raw, word, at, check);
    let tolerance = read_tolerance(raw, at, check);
    let ties = ties::read(raw, matches!(word, Word::Ties), at, check);
    let origin = match (&raw.spec, &raw.tables) {
        (None, None) if ties.is_some() || matches!(word, Word::Ties) => {
            ties::on_ground(name, raw, ties.as_ref(), at, check)
        }
        (Some(file), None) if matches!(word, Word::Ties) => {
            let origin = read_spec(file, &at.key("spec"), files, check);
            origin.and_then(|origin| ties::on_structure(origin, raw, ties.as_ref(), at, check))
        }
        (Some(file), None) => read_spec(file, &at.key("spec"), files, check),
        (None, Some(tables)) => read_tables(tables, &at.key("tables"), word, files, check),
        (Some(_), Some(_)) => {
            let fault = Fault::new(at, "must have either `spec` or `tables`").got("both");
            check
                .faults
                .add(fault.hint("`spec` is a beam spec to solve, `tables` are SPLINEs that exist already"));
            None
        }
        (None, None) => {
            let fault = Fault::new(at, "must have either `spec` or `tables`").got("neither");
            let meant = nearest(name, others).map(|near| format!("did you mean \"{near}\"? "));
            let hint = "`spec` is a beam spec to solve, `tables` are SPLINEs that exist already";
            check.faults.add(fault.hint(format!("{}{hint}", meant.unwrap_or_default())));
            None
        }
    };
    let foundation = match word {
        Word::Rigid => Foundation::Rigid,
        Word::Parts => Foundation::Parts { count, handover, damping },
        Word::Influence | Word::Auto => Foundation::Influence,
        Word::Modal => Foundation::Modal { modes: raw.modes.unwrap_or(MODES), damping },
        Word::Ties => ties::foundation(raw, ties.as_ref(), damping, at, check),
        Word::Full => Foundation::Full { elements: raw.elements.unwrap_or(ELEMENTS), damping },
    };
    let origin = origin?;
    if let (Word::Parts, Origin::Spec { spec, .. }) = (word, &origin)
        && spec.girder().is_none()
    {
        let fault = Fault::new(&at.key("foundation"), "\"parts\" needs a straight girder");
        check.faults.add(fault.hint("the short form of a spec, with `girder`"));
    }
    let rails = origin.rails();
    if reading != Reading::Exact {
        enough_stations(&rails, reading, at, check);
    }
    let auto = matches!(word, Word::Auto);
    let gauges = gauge::read(&raw.gauges, &rails, &at.key("gauges"), check);
    let longitudinal = read_longitudinal(raw, word, at, check);
    let place = at.key("irregularities");
    let irregularities = irregularity::read(&raw.irregularities, &rails, &place, files, check);
    Some(Structure {
        name: name.to_owned(),
        origin,
        rails,
        foundation,
        auto,
        damping,
        reading,
        couplings,
        tolerance,
        gauges,
        longitudinal,
        irregularities,
        on: None,
    })
}

fn foundation_word(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> Word {
    let Some(word) = &raw.foundation else {
        return if raw.ties.is_some() { Word::Ties } else { Word::Auto };
    };
    let place = at.key("foundation");
    let words = [
        ("rigid", Word::Rigid),
        ("parts", Word::Parts),
        ("influence", Word::Influence),
        ("modal", Word::Modal),
        ("full", Word::Full),
        ("ties", Word::Ties),
        ("auto", Word::Auto),
    ];
    check.faults.word(word, &place, &words).unwrap_or(Word::Auto)
}

/// Words of what a structure may leave out.
const COUPLINGS: [(&str, Couplings); 3] =
    [("all", Couplings::All), ("within rails", Couplings::WithinRails), ("none", Couplings::None)];

/// Couplings can be left out of what has no freedoms of its own; natural modes move all rails together.
fn read_couplings(raw: &RawStructure, word: Word, at: &Place<'_>, check: &mut Check<'_>) -> Couplings {
    let Some(given) = &raw.couplings else { return Couplings::All };
    let place = at.key("couplings");
    let couplings = check.faults.word(given, &place, &COUPLINGS).unwrap_or_default();
    if couplings != Couplings::All && !matches!(word, Word::Influence | Word::Rigid) {
        let fault = Fault::new(&place, "can be left out of the foundation \"influence\" alone").at_key();
        check
            .faults
            .add(fault.hint("modes and parts move all that they join; \"rigid\" has nothing to leave out"));
    }
    couplings
}

/// Whether a structure gives along its rails.
fn read_longitudinal(raw: &RawStructure, word: Word, at: &Place<'_>, check: &mut Check<'_>) -> bool {
    let longitudinal = raw.longitudinal.unwrap_or(false);
    let place = at.key("longitudinal");
    if longitudinal && raw.tables.is_some() {
        let fault = Fault::new(&place, "needs a `spec`").at_key();
        check.faults.add(fault.hint("tables of a scene know the vertical and the lateral give alone"));
    }
    if longitudinal && raw.on.is_some() {
        check.faults.unavailable(&place, "give along the rails of a structure on a body");
    }
    if longitudinal && matches!(word, Word::Parts) {
        let fault = Fault::new(&place, "\"parts\" do not give along the rail").at_key();
        check.faults.add(fault.hint("use \"influence\" or \"modal\""));
    }
    longitudinal
}

/// Relative error allowed to the choice of a foundation.
fn read_tolerance(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> f64 {
    let (place, given) = (at.key("tolerance"), raw.tolerance.unwrap_or(TOLERANCE));
    let tolerance = check.positive(given, &place, Dimension::NUMBER, "a relative error, such as 1e-3");
    if given > 0.0 && !(FINEST..1.0).contains(&given) {
        let fault = Fault::new(&place, "must be at least 1e-7 and below 1").got(given);
        check.faults.add(fault.hint("a relative error, such as 1e-3"));
    }
    tolerance
}

/// Share of critical damping; modes and elements must be some.
fn read_damping(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> f64 {
    for (key, count) in [("modes", raw.modes), ("elements", raw.elements)] {
        if count == Some(0) {
            check.faults.add(Fault::new(&at.key(key), "must be at least 1").got(0));
        }
    }
    let (place, given) = (at.key("damping"), raw.damping.unwrap_or(0.0));
    let damping = check.not_negative(given, &place, Dimension::NUMBER, "a share of critical, such as 0.01");
    if damping >= 1.0 {
        let fault = Fault::new(&place, "must be below 1").got(damping);
        check.faults.add(fault.hint("a share of critical, such as 0.01"));
    }
    damping
}

fn read_handover(raw: &RawStructure, at: &Place<'_>, check: &mut Check<'_>) -> Handover {
    let words = [("blend", false), ("per-part", true)];
    let per_part = match &raw.handover {
        Some(word) => check.faults.word(word, &at.key("handover"), &words).unwrap_or(false),
        None => false,
    };
    let hint = "the length over which the datum is blended";
    let length = check.optional_positive(raw.blend, &at.key("blend"), Dimension::LENGTH, hint);
    if per_part { Handover::PerPart { length } } else { Handover::Blend { length } }
}

fn read_spec(file: &str, at: &Place<'_>, files: &mut Files<'_>, check: &mut Check<'_>) -> Option<Origin> {
    files.read(file, at, check, |input, check| {
        let source = input.source().map_err(|error| vec![*error])?;
        let spec = Spec::read(&source, Some(check.scale.to))?;
        Ok(Origin::Spec { file: file.to_owned(), spec: Arc::new(spec) })
    })
}

fn read_tables(
    raw: &RawTables,
    at: &Place<'_>,
    word: Word,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Option<Origin> {
    if matches!(word, Word::Parts | Word::Modal | Word::Full | Word::Ties) {
        let fault = Fault::new(at, "this foundation needs a `spec`")
            .hint("tables know neither masses nor what lies between");
        check.faults.add(fault);
    }
    if raw.vertical.is_none() && raw.lateral.is_none() {
        let fault = Fault::new(at, "must name a table as `vertical`, `lateral` or both");
        check.faults.add(fault.hint("such as \"vertical\": 6 for SPLINE/6, or its name in quotes"));
    }
    let file = check.faults.need(&raw.file, at, "file")?;
    let read = files.read(file, &at.key("file"), check, |input, check| tables::read(raw, input, at, check));
    read.flatten()
}

/// What the spline readings of a table need.
fn enough_stations(rails: &[RailOutline], reading: Reading, at: &Place<'_>, check: &mut Check<'_>) {
    let least = if reading == Reading::Natural { 2 } else { 4 };
    for rail in rails {
        if rail.stations.len() < least {
            let expected = format!("needs at least {least} stations on rail {}", rail.name);
            check.faults.add(Fault::new(&at.key("reading"), expected).got(rail.stations.len()));
        }
    }
}
