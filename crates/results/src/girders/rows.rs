//! Rows of the history from which extremes are found: those of the output, or more of them from a repetition of the run.

use design::{plane_word, quantity_word};
use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use formats::text::number::{number, rounded};
use sim::{Channel, Foundation, History};
use trains::GirderResponse;

use super::GirderExtremes;
use super::solved::SolvedMembers;
use super::spans::SpanValue;
use super::structure::{PreparedGirders, RowChoice, Rows, SpanExtremes};
use crate::response::WheelLoadReader;
use foundations::{BuiltFoundation, SolvedModel};

/// Largest number of rows, and of values of a history, to which a repetition is raised.
const MAX_ROWS: [usize; 2] = [40_000, 20_000_000];
/// Largest number of repetitions.
const REPETITIONS: usize = 2;
/// Ratio of the changes before and after a repetition above which there is no other one.
const WORTHWHILE: f64 = 0.7;

/// Error of extremes by their difference from those at every second time, where errors fall with the square of the interval.
const OF_EVERY_SECOND: f64 = 1.0 / 3.0;
/// Every how many rows of long steps are evaluated first where not half of them can be left out, and the error of the extremes,
/// relative to the accuracy, from which all are.
const FEWER: (usize, f64) = (3, 0.3);

/// The girders of a scene, prepared for any number of runs on the same foundations.
pub(super) struct Prepared<'a> {
    girders: Vec<PreparedGirders<'a>>,
    notes: Vec<String>,
}

impl<'a> Prepared<'a> {
    /// Prepares the girders of every structure with a spec. A structure that cannot be evaluated has a note instead. Once
    /// `is_stopped` says so, what is found of the girders is incomplete.
    pub fn new(
        scene: &'a Scene,
        built: &[BuiltFoundation],
        solved: &[Option<&SolvedModel>],
        members: &'a SolvedMembers,
        is_stopped: &'a dyn Fn() -> bool,
    ) -> Prepared<'a> {
        let (mut girders, mut notes) = (Vec::new(), Vec::new());
        for (s, (built, solved)) in built.iter().zip(solved).enumerate() {
            let Some(solved) = solved else { continue };
            match PreparedGirders::new(scene, s, built, solved, (members, is_stopped)) {
                Ok(prepared) => girders.extend(prepared),
                Err(error) => notes.push(format!("extremes of girders were not computed: {error}")),
            }
        }
        Prepared { girders, notes }
    }

    /// What there is of a run without an interval.
    pub fn without_rows(&self) -> GirderExtremes {
        GirderExtremes {
            notes: self.notes.clone(),
            ..GirderExtremes::default()
        }
    }
}

/// The samples of a run from which extremes are found.
#[derive(Clone, Copy)]
pub(super) enum Recorded<'a> {
    /// The rows of its history.
    Rows(&'a History),
    /// The same, and the ends of its steps.
    Steps(&'a History),
    /// The same, and times inside of its steps.
    Inside(&'a History),
}

/// Repeats a run with a number of rows in each output interval; `None` if it cannot be repeated.
pub(super) type Repetition<'a> = dyn FnMut(usize) -> Option<History> + 'a;

/// The extremes and envelopes of all girders of a scene.
///
/// Where the ends of steps were recorded, the extremes are those at the ends of steps and between them: those
/// between which loads and motions are straight lines to 1e-5 of the largest. By how much they change from those of a tolerance
/// of 1e-4 shows what they may still change; the steps themselves are as accurate as the run. Where long steps were sampled
/// inside, all of these times count, or every third of them where most would have to be evaluated and the error is small enough,
/// and the extremes are compared with those at every second one: D is then the difference of two errors of which one has twice
/// the interval, and where errors fall with its square at least, that of all times is D/3 or less.
///
/// Otherwise the extremes at all rows are compared with those at every second row. As cubic polynomials interpolate between the
/// rows, their difference falls with the fourth power of the interval where the motion is smooth. If it exceeds
/// `accuracy` times the largest value of its kind, the run is repeated with as many rows as this rate suggests, at most
/// twice. The change after a repetition is the smaller one of that from every second row and that from the history
/// before; a note says by how much the extremes still change.
pub(super) fn of_run(
    prepared: &Prepared<'_>,
    (scene, input): (&Scene, &SimulationInput),
    recorded: Recorded<'_>,
    foundations: &[Foundation],
    repeat: &mut Repetition<'_>,
) -> GirderExtremes {
    let girders = &prepared.girders;
    let mut out = prepared.without_rows();
    let (Recorded::Rows(history) | Recorded::Steps(history) | Recorded::Inside(history)) = recorded;
    let is_known = |girders: &&PreparedGirders<'_>| {
        let s = girders.structure();
        foundations[s].dofs() == 0 || history.position(Channel::Coordinate(s, 0)).is_some()
    };
    let girders: Vec<&PreparedGirders<'_>> = girders.iter().filter(is_known).collect();
    if girders.is_empty() {
        return out;
    }
    let breaks = input.scene.breaks();
    let all = Evaluation {
        scene,
        input,
        foundations,
        girders: &girders,
        breaks: &breaks,
    };
    let (found, finer) = match recorded {
        Recorded::Rows(rows) => all.by_repetition(rows, repeat),
        Recorded::Steps(steps) => (all.attempt(steps, RowChoice::Needed), None),
        Recorded::Inside(steps) => (all.inside(steps), None),
    };
    let history = finer.as_ref().unwrap_or(history);
    let loads = WheelLoadReader::new(scene, input, history);
    for (girders, spans) in girders.iter().zip(&found.spans) {
        let rows = Rows {
            history,
            loads: &loads,
            foundations,
            breaks: &breaks,
        };
        let (extremes, envelope, stresses, reactions) =
            girders.results(rows, spans, scene.accuracy);
        out.extremes.extend(extremes);
        out.reactions.extend(reactions);
        out.envelope.extend(envelope);
        out.stresses.extend(stresses);
        let usual = if matches!(recorded, Recorded::Inside(_)) {
            FEWER.0
        } else {
            1
        };
        if spans.chosen.stride > usual {
            out.notes.push(format!(
                "{}: extremes of girders are evaluated at one in {} times to limit the computing time",
                girders.name(),
                spans.chosen.stride
            ));
        }
    }
    if found.change.fraction > scene.accuracy {
        out.notes.push(format!(
            "extremes of girders are not converged: refining the sampling changes them by {} of the largest value of \
             their kind, with {} sampling times{}",
            number(rounded(found.change.fraction, 2)),
            found.spans.iter().map(|spans| spans.chosen.rows.len()).max().unwrap_or_default(),
            found.change.place()
        ));
    }
    out
}

/// The extremes at the rows of one history.
struct Attempt {
    /// By structure.
    spans: Vec<SpanExtremes>,
    /// Largest change from a coarser choice of rows, relative to the largest value of its kind.
    change: Change,
    /// Largest number of rows that are all evaluated.
    most_rows: usize,
}

/// A change of extremes, relative to the largest value of their kind.
#[derive(Clone, Debug, Default)]
struct Change {
    fraction: f64,
    /// Quantity and number of the span with the largest change.
    at: Option<(usize, usize)>,
    /// Name of the structure.
    structure: String,
}

impl Change {
    fn larger(self, other: Change) -> Change {
        if other.fraction > self.fraction {
            other
        } else {
            self
        }
    }

    fn smaller(self, other: Change) -> Change {
        if other.fraction < self.fraction {
            other
        } else {
            self
        }
    }

    /// Where the largest change is, as the end of a sentence.
    fn place(&self) -> String {
        self.at.map_or_else(String::new, |(quantity, span)| {
            let quantity = GirderResponse::ALL[quantity];
            let (plane, word) = (plane_word(quantity), quantity_word(quantity));
            format!(
                "; the largest change is that of the {plane} {word} in span {span} of {}",
                self.structure
            )
        })
    }
}

/// Girders with what their evaluation needs beside a history.
struct Evaluation<'a> {
    scene: &'a Scene,
    input: &'a SimulationInput,
    foundations: &'a [Foundation],
    girders: &'a [&'a PreparedGirders<'a>],
    /// Times at which motions and loads have corners.
    breaks: &'a [f64],
}

impl Evaluation<'_> {
    /// The extremes at the rows of a history, and if needed at those of repetitions of the run, the last of which is returned
    /// as well.
    fn by_repetition(
        &self,
        history: &History,
        repeat: &mut Repetition<'_>,
    ) -> (Attempt, Option<History>) {
        let mut found = self.attempt(history, RowChoice::Every);
        let (mut rows, mut finer) = (1, None);
        for _ in 0..REPETITIONS {
            let own = finer.as_ref().unwrap_or(history);
            let Some(more) = more_rows(self.scene, own, found.most_rows, found.change.fraction)
            else {
                break;
            };
            let more = more * rows;
            let Some(repeated) = repeat(more) else { break };
            let before = found.change.fraction;
            let last = std::mem::replace(&mut found, self.attempt(&repeated, RowChoice::Every));
            let from_last = self.change(&found, &last);
            found.change = found.change.smaller(from_last);
            (rows, finer) = (more, Some(repeated));
            // where forces jump, more rows do not help
            if found.change.fraction > WORTHWHILE * before {
                break;
            }
        }
        (found, finer)
    }

    /// The extremes at the ends of long steps and at times inside of them: at every third of them if most would have to be
    /// evaluated, unless the error of those is too large.
    fn inside(&self, steps: &History) -> Attempt {
        let attempt = |choice: RowChoice| {
            let mut found = self.attempt(steps, choice);
            found.change.fraction *= OF_EVERY_SECOND;
            found
        };
        let found = attempt(RowChoice::Smooth(FEWER.0));
        // where the values are many, the first choice has as many of them as the second
        let has_more = found
            .spans
            .iter()
            .any(|spans| spans.chosen.stride == FEWER.0);
        let is_rough = found.change.fraction > FEWER.1 * self.scene.accuracy;
        if has_more && is_rough {
            attempt(RowChoice::Sampled(1))
        } else {
            found
        }
    }

    /// Largest change of the extremes from one evaluation to the next, relative to the largest value of its kind.
    fn change(&self, next: &Attempt, before: &Attempt) -> Change {
        let each = self
            .girders
            .iter()
            .zip(next.spans.iter().zip(&before.spans));
        let of = |(girders, (next, before)): (&&PreparedGirders<'_>, (_, &SpanExtremes))| Change {
            structure: girders.name().to_owned(),
            ..difference(next, &before.values)
        };
        each.map(of).fold(Change::default(), Change::larger)
    }

    /// The extremes at rows of a history, and by how much they change from a coarser choice of them.
    fn attempt(&self, history: &History, choice: RowChoice) -> Attempt {
        let loads = WheelLoadReader::new(self.scene, self.input, history);
        let rows = Rows {
            history,
            loads: &loads,
            foundations: self.foundations,
            breaks: self.breaks,
        };
        let mut change = Change::default();
        let mut all = Vec::new();
        for girders in self.girders {
            let own = girders.spans(rows, choice, self.scene.accuracy);
            let structure = girders.name().to_owned();
            change = change.larger(Change {
                structure,
                ..difference(&own, &own.coarse)
            });
            all.push(own);
        }
        let most_rows = self
            .girders
            .iter()
            .map(|own| own.most_rows(history, &loads))
            .min()
            .unwrap_or_default();
        Attempt {
            spans: all,
            change,
            most_rows,
        }
    }
}

/// Largest difference of the extremes of two evaluations, relative to the largest value of their kind: of forces,
/// moments or deflections.
fn difference(fine: &SpanExtremes, coarse: &[SpanValue]) -> Change {
    let key = |v: &SpanValue| (v.rail, v.span, v.quantity, v.kind);
    let kind = |quantity: usize| match quantity {
        0 | 2 | 3 => 0,
        1 | 4 | 5 => 1,
        _ => 2,
    };
    let mut sizes = [0.0_f64; 3];
    fine.sizes
        .iter()
        .enumerate()
        .for_each(|(k, size)| sizes[kind(k)] = sizes[kind(k)].max(*size));
    let mut largest = Change::default();
    for value in &fine.values {
        let size = sizes[kind(value.quantity)];
        let Some(other) = coarse.iter().find(|other| key(other) == key(value)) else {
            continue;
        };
        if size > 0.0 {
            let change = (value.found.signed - other.found.signed).abs() / size;
            if change > largest.fraction {
                largest = Change {
                    fraction: change,
                    at: Some((value.quantity, value.span)),
                    ..largest
                };
            }
        }
    }
    largest
}

/// By how many times the rows of a history must increase; `None` where the extremes change by no more than the accuracy,
/// or where the history would become too long.
fn more_rows(scene: &Scene, history: &History, most: usize, change: f64) -> Option<usize> {
    if change <= scene.accuracy {
        return None;
    }
    let factor = (1.5 * (change / scene.accuracy).cbrt())
        .clamp(2.0, 16.0)
        .ceil() as usize;
    let width = history.channels().len().max(1);
    let most = most.min(MAX_ROWS[0]).min(MAX_ROWS[1] / width) / history.len().max(1);
    let factor = factor.min(most);
    (factor >= 2).then_some(factor)
}
