//! Influence lines of the values that govern a design, with the ordinates under the wheels that cause them.

use formats::design::Design;
use formats::spec::SolveError;
use formats::text::inputs::Inputs;
use trains::{
    GirderResponse, Governing, InfluenceLine, SectionSide, SpanExtreme, Structure, TrainCase,
};

use crate::loads::{LoadKind, train_case};
use crate::outcome::{DesignResult, ReactionExtremes};
use crate::solve::reactions;
use crate::solve_error::solve_error;
use crate::tables::finish;
use crate::words::{kind_word, plane_word, quantity_word, side_word};

/// Rows of an influence line along the longest rail.
const ROWS: f64 = 200.0;
/// Lines on other rails below this fraction of the largest ordinate are left out.
const NEGLIGIBLE: f64 = 1e-9;

/// Which influence lines are shown for each rail, and whether the largest or the smallest value governs.
const SHOWN: [(GirderResponse, bool); 4] = [
    (GirderResponse::VerticalMoment, true),
    (GirderResponse::VerticalMoment, false),
    (GirderResponse::VerticalShear, true),
    (GirderResponse::VerticalDeflection, true),
];

/// What an influence line is of.
#[derive(Clone, Debug, PartialEq)]
pub enum LineSubject {
    /// A quantity of a girder at the section that governs.
    Girder {
        /// Index of its rail.
        rail: usize,
        /// Number of the span, from 1.
        span: usize,
        /// The quantity.
        quantity: GirderResponse,
    },
    /// A reaction.
    Reaction {
        /// The supported point.
        support: String,
        /// Its global direction.
        direction: String,
    },
}

/// A vertical wheel force in the governing position, with the ordinate of the influence line there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelOrdinate {
    /// Index of its rail.
    pub rail: usize,
    /// Its coordinate on the rail.
    pub x: f64,
    /// Force, positive pressing on the rail, with the factors of the case.
    pub force: f64,
    /// Response per unit of force.
    pub ordinate: f64,
}

/// The influence lines of one governing value: the response at the governing section, or of a support, to a unit load
/// that presses on a rail, as a function of its place.
#[derive(Clone, Debug)]
pub struct GoverningLine {
    /// What responds.
    pub subject: LineSubject,
    /// Index of the case that governs.
    pub case: usize,
    /// Whether its largest value governs; otherwise the smallest.
    pub is_max: bool,
    /// The governing value with its place and the positions of the trains.
    pub governing: Governing,
    /// By rail on which the load stands.
    pub lines: Vec<InfluenceLine>,
    /// The wheels of all trains of the case.
    pub wheels: Vec<WheelOrdinate>,
}

impl GoverningLine {
    /// The part of the value that is due to the vertical wheel forces: the sum of forces times ordinates.
    #[must_use]
    pub fn of_wheels(&self) -> f64 {
        self.wheels
            .iter()
            .map(|wheel| wheel.force * wheel.ordinate)
            .sum()
    }

    /// Indices of the rails on which loads matter.
    #[must_use]
    pub fn loaded_rails(&self) -> Vec<usize> {
        let sizes: Vec<f64> = self.lines.iter().map(InfluenceLine::size).collect();
        let most = sizes.iter().copied().fold(0.0, f64::max);
        (0..sizes.len())
            .filter(|rail| sizes[*rail] > NEGLIGIBLE * most)
            .collect()
    }

    /// Points of the line on a rail, evenly spread; two with the same coordinate where it jumps.
    #[must_use]
    pub fn points(&self, rail: usize) -> Vec<[f64; 2]> {
        let range = |line: &InfluenceLine| line.range().map_or(0.0, |[from, to]| to - from);
        let longest = self.lines.iter().map(range).fold(0.0, f64::max);
        self.lines[rail].points(longest / ROWS)
    }
}

/// The influence lines of the values that govern on each rail (largest sagging and hogging moment, shear force of the
/// largest size, deflection), and of the largest and the smallest vertical reaction.
///
/// # Errors
/// A structure that has no trustworthy solution.
pub fn governing_lines(
    design: &Design,
    inputs: &Inputs,
    result: &DesignResult,
) -> Result<Vec<GoverningLine>, SolveError> {
    let in_files = |error: trains::Error| solve_error(&error, design, inputs);
    let (model, rails) = design
        .spec
        .model()
        .map_err(|error| in_files(error.into()))?;
    let structure = Structure::new(&model, &rails, false).map_err(in_files)?;
    let mut out = Vec::new();
    for rail in 0..rails.len() {
        for (quantity, is_max) in SHOWN {
            let Some((case, found)) = governing_extreme(result, rail, quantity, is_max) else {
                continue;
            };
            let g = &found.governing;
            let lines = structure
                .girder_lines(rail, g.x, g.side, quantity)
                .map_err(in_files)?;
            let subject = LineSubject::Girder {
                rail,
                span: found.span,
                quantity,
            };
            out.push(line(
                design,
                &structure,
                (subject, case, found.is_max),
                g,
                lines,
            ));
        }
    }
    let (names, sums) = reactions(design, &model, &structure);
    for is_max in [true, false] {
        let Some((case, found, governing)) = governing_reaction(design, result, is_max) else {
            continue;
        };
        let Some(index) = names.iter().position(|name| *name == found.name) else {
            continue;
        };
        if governing.value == 0.0 {
            continue;
        }
        let lines = structure.effect_lines(&sums[index]).map_err(in_files)?;
        let ReactionExtremes { name, .. } = found;
        let subject = LineSubject::Reaction {
            support: name.support.clone(),
            direction: name.direction.clone(),
        };
        out.push(line(
            design,
            &structure,
            (subject, case, is_max),
            governing,
            lines,
        ));
    }
    out.retain(|line| line.lines.iter().any(|own| own.size() > 0.0));
    Ok(out)
}

/// A governing value with its lines, and the ordinates under the wheels.
fn line(
    design: &Design,
    structure: &Structure,
    (subject, case, is_max): (LineSubject, usize, bool),
    governing: &Governing,
    lines: Vec<InfluenceLine>,
) -> GoverningLine {
    let sign = if is_max { 1.0 } else { -1.0 };
    let TrainCase { trains, .. } = train_case(design, &design.cases[case], LoadKind::All);
    let mut wheels = Vec::new();
    for (train, at) in trains.iter().zip(&governing.trains) {
        for (given, (rail, x)) in train
            .wheels
            .iter()
            .zip(structure.wheel_coordinates(train, at))
        {
            // a wheel at a jump counts on the side that makes the value more extreme
            let [before, behind] =
                [SectionSide::Before, SectionSide::Behind].map(|side| lines[rail].value(x, side));
            let ordinate = if sign * given.vertical * before > sign * given.vertical * behind {
                before
            } else {
                behind
            };
            wheels.push(WheelOrdinate {
                rail,
                x,
                force: given.vertical,
                ordinate,
            });
        }
    }
    GoverningLine {
        subject,
        case,
        is_max,
        governing: governing.clone(),
        lines,
        wheels,
    }
}

/// The extreme of a quantity on a rail over all cases and spans, with the index of its case; a shear force of the largest
/// size, with either sign.
fn governing_extreme(
    result: &DesignResult,
    rail: usize,
    quantity: GirderResponse,
    is_max: bool,
) -> Option<(usize, &SpanExtreme)> {
    let is_shear = quantity == GirderResponse::VerticalShear;
    let sign = if is_max { 1.0 } else { -1.0 };
    let size = |found: &SpanExtreme| {
        let value = found.governing.value;
        if is_shear { value.abs() } else { sign * value }
    };
    let all = result.cases.iter().enumerate();
    let all = all.flat_map(|(case, own)| {
        own.envelopes
            .extremes
            .iter()
            .map(move |found| (case, found))
    });
    all.filter(|(_, found)| {
        found.rail == rail
            && found.quantity == quantity
            && (is_shear || found.is_max == is_max)
            && size(found) > 0.0
    })
    .reduce(|best, next| {
        if size(next.1) > size(best.1) {
            next
        } else {
            best
        }
    })
}

/// The largest or the smallest vertical reaction over all cases: the index of its case, the reaction, its value.
#[must_use]
pub fn governing_reaction<'r>(
    design: &Design,
    result: &'r DesignResult,
    is_max: bool,
) -> Option<(usize, &'r ReactionExtremes, &'r Governing)> {
    let up = upward_direction(design)?;
    let sign = if is_max { 1.0 } else { -1.0 };
    let all = result.cases.iter().enumerate().flat_map(|(case, solved)| {
        let own = solved
            .reactions
            .iter()
            .filter(|reaction| reaction.name.direction == up);
        own.map(move |reaction| (case, reaction, &reaction.extremes[usize::from(!is_max)]))
    });
    all.reduce(|best, next| {
        if sign * next.2.value > sign * best.2.value {
            next
        } else {
            best
        }
    })
}

/// Word of the global direction that is nearest to up.
fn upward_direction(design: &Design) -> Option<&'static str> {
    let (model, _) = design.spec.model().ok()?;
    let axis = (0..3).max_by(|&a, &b| model.up[a].abs().total_cmp(&model.up[b].abs()))?;
    Some(["ux", "uy", "uz"][axis])
}

/// The influence lines as CSV: one block of rows for each governing value and each rail on which loads matter.
///
/// # Errors
/// None in practice: the text is written into memory.
pub fn influence_csv(design: &Design, lines: &[GoverningLine]) -> Result<String, csv::Error> {
    let mut out = csv::Writer::from_writer(Vec::new());
    out.write_record([
        "line",
        "case",
        "quantity",
        "plane",
        "kind",
        "rail",
        "span",
        "x",
        "side",
        "support",
        "direction",
        "load_rail",
        "load_x",
        "value",
    ])?;
    let rails = design.spec.rails();
    let text = |value: f64| format!("{}", value + 0.0);
    for (number, line) in lines.iter().enumerate() {
        let g = &line.governing;
        let place = match &line.subject {
            LineSubject::Girder {
                rail,
                span,
                quantity,
            } => [
                quantity_word(*quantity).to_owned(),
                plane_word(*quantity).to_owned(),
                kind_word(line.is_max).to_owned(),
                rails[*rail].name.clone(),
                span.to_string(),
                text(g.x),
                side_word(g.side).to_owned(),
                String::new(),
                String::new(),
            ],
            LineSubject::Reaction { support, direction } => {
                let mut words = [(); 9].map(|()| String::new());
                words[0] = "reaction".to_owned();
                words[2] = kind_word(line.is_max).to_owned();
                (words[7], words[8]) = (support.clone(), direction.clone());
                words
            }
        };
        let head = [(number + 1).to_string(), (line.case + 1).to_string()];
        for rail in line.loaded_rails() {
            for [x, value] in line.points(rail) {
                let load = [rails[rail].name.clone(), text(x), text(value)];
                out.write_record(head.iter().chain(&place).chain(&load))?;
            }
        }
    }
    finish(out)
}
