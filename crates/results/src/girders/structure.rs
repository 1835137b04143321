//! The girders of one structure: extremes of its spans, and envelopes at places.

use formats::scene::Scene;
use sim::{Channel, Foundation, History};
use trains::{GirderResponse, MemberForces, RailLoad};

use super::distributed::{DistributedForces, FORCES};
use super::girder::LoadedGirders;
use super::instants::{LoadStates, MemberEnd};
use super::kept_rows::kept_rows;
use super::peaks::SIGNS;
use super::points::PointDeflections;
use super::reactions::{GirderReaction, Reactions};
use super::refine::{GirderValue, Refinement};
use super::scan::Scan;
use super::scanned_rows::{fewest, is_worthwhile, scanned_rows};
use super::sections::{RailSpans, Sections};
use super::solved::SolvedMembers;
use super::spans::SpanValue;
use super::stresses::GirderStresses;
use super::{GirderEnvelope, GirderExtreme};
use crate::Error;
use crate::response::WheelLoadReader;
use foundations::{BuiltFoundation, SolvedModel};

/// Largest number of values that a scan evaluates; of longer histories it takes fewer rows.
const MAX_VALUES: usize = 2_000_000;
/// Tolerances within which loads are straight lines between the rows that are needed, and the largest number of values of
/// these rows, finer and coarser. Also where the number of values decides, the finer ones are more.
const NEEDED: [(f64, usize); 2] = [(1e-5, usize::MAX), (1e-4, usize::MAX)];
/// Largest number of values that a scan evaluates of the rows of long steps.
const MAX_SAMPLED: usize = 3 * MAX_VALUES;
/// Number of rows beside a time at which a load is at an end of a member that are kept: cubic polynomials do not extend across
/// it.
const BESIDE: usize = 4;
/// Number of rows above which deflections are evaluated at fewer rows.
const MAX_DEFLECTIONS: usize = 500;
/// The same for the ends of steps, between which deflections are less even.
const MAX_STEPS: usize = 4_000;

/// A structure prepared for any number of runs.
pub(super) struct PreparedGirders<'a> {
    scene: &'a Scene,
    s: usize,
    members: &'a MemberForces,
    ends: Vec<MemberEnd>,
    sections: Sections,
    distributed: DistributedForces,
    reactions: Reactions,
    /// Whether nobody wants the results any more.
    is_stopped: &'a dyn Fn() -> bool,
}

/// The history of a run from which extremes are found.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    pub history: &'a History,
    pub loads: &'a WheelLoadReader,
    /// One for each structure.
    pub foundations: &'a [Foundation],
    /// Times at which motions and loads have corners.
    pub breaks: &'a [f64],
}

/// A choice among the rows of a history, with a coarser one, to see by how much extremes change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RowChoice {
    /// Every row and every second one; fewer where there are too many values.
    Every,
    /// Those between which loads differ from straight lines by more than the tolerances [`NEEDED`], finer and coarser,
    /// relative to the largest load. They are raised until there are no more than [`MAX_VALUES`] of all rows.
    Needed,
    /// One of so many rows and every second one of these, at most [`MAX_SAMPLED`] values, and in both the rows beside those
    /// at which a load is at an end of a member or a motion has a corner: rows at the ends of long steps, which end at such
    /// times, and inside of them.
    Sampled(usize),
    /// `Sampled` with every row where fewer of them need be scanned than one of so many, otherwise with one of so many.
    Smooth(usize),
}

/// Rows of a history that are evaluated.
#[derive(Clone, Debug)]
pub(super) struct ChosenRows {
    pub rows: Vec<usize>,
    /// Every how many rows of the history were taken, where they were not chosen by need; 1 where they were.
    pub stride: usize,
    /// Indices of those of the coarser choice.
    coarse: Vec<usize>,
    /// Indices of those that are scanned in any case.
    kept: Vec<usize>,
    /// Number of rows above which deflections are evaluated at fewer of them.
    most_deflections: usize,
}

/// Chosen rows, the states at them, and those of them at which peaks are looked for.
struct ScannedStates {
    chosen: ChosenRows,
    states: LoadStates,
    scanned: Vec<usize>,
}

/// Extremes of the spans of a structure and the largest magnitudes of its quantities, for one history.
pub(super) struct SpanExtremes {
    pub values: Vec<SpanValue>,
    /// Those of the coarser choice of rows.
    pub coarse: Vec<SpanValue>,
    /// The states at these rows, those of them that were scanned, and the scan from which the extremes follow.
    states: LoadStates,
    scanned: Vec<usize>,
    scan: Scan,
    pub sizes: [f64; FORCES + 2],
    /// The rows that were evaluated.
    pub chosen: ChosenRows,
}

impl<'a> PreparedGirders<'a> {
    /// Prepares structure `s`; `None` where it has no members under rails.
    ///
    /// # Errors
    /// [`Error::Girders`] for a model that cannot be solved.
    pub fn new(
        scene: &'a Scene,
        s: usize,
        built: &BuiltFoundation,
        solved: &SolvedModel,
        (all, is_stopped): (&'a SolvedMembers, &'a dyn Fn() -> bool),
    ) -> Result<Option<PreparedGirders<'a>>, Error> {
        let failed = |source: trains::Error| Error::Girders {
            structure: scene.structures[s].name.clone(),
            source,
        };
        let Some(members) = all.of(solved) else {
            return Ok(None);
        };
        let members = members.map_err(failed)?;
        let sections = Sections::new(scene, s, solved, members);
        if sections.sections.is_empty() {
            return Ok(None);
        }
        let load = (scene.gravity, scene.output.dead_load);
        let distributed = DistributedForces::new(solved, built, members, &sections, load)
            .map_err(|source| failed(source.into()))?;
        let reactions = Reactions::new((scene, s), solved, built, members, load)
            .map_err(|source| failed(source.into()))?;
        let ends = MemberEnd::all(members);
        Ok(Some(PreparedGirders {
            scene,
            s,
            members,
            ends,
            sections,
            distributed,
            reactions,
            is_stopped,
        }))
    }

    /// Index of the structure.
    pub fn structure(&self) -> usize {
        self.s
    }

    /// Name of the structure.
    pub fn name(&self) -> &str {
        &self.scene.structures[self.s].name
    }

    /// Number of values of one row.
    fn width(&self, history: &History, loads: &WheelLoadReader) -> usize {
        let on = loads
            .at(history.sample(0))
            .iter()
            .filter(|load| load.structure == self.s)
            .count();
        FORCES * (self.sections.sections.len() + 2 * on) + 2 * self.sections.points.len()
    }

    /// Largest number of rows of a history like this one that are all evaluated.
    pub fn most_rows(&self, history: &History, loads: &WheelLoadReader) -> usize {
        MAX_VALUES / self.width(history, loads).max(1)
    }

    fn chosen(&self, rows: Rows<'_>, choice: RowChoice) -> ChosenRows {
        let Rows {
            history,
            loads,
            foundations,
            ..
        } = rows;
        let width = self.width(history, loads).max(1);
        let all: Vec<usize> = (0..history.len()).collect();
        if let RowChoice::Sampled(least) = choice {
            let beside = self.rows_beside_corners(rows);
            let stride = (history.len() * width).div_ceil(MAX_SAMPLED).max(least);
            let rows = with(every(&all, stride), &beside);
            let is_kept = |index: &usize| beside.binary_search(&rows[*index]).is_ok();
            let kept: Vec<usize> = (0..rows.len()).filter(is_kept).collect();
            let coarse = with(every(&(0..rows.len()).collect::<Vec<_>>(), 2), &kept);
            return ChosenRows {
                rows,
                stride,
                coarse,
                kept,
                most_deflections: MAX_STEPS,
            };
        }
        if choice == RowChoice::Needed {
            // places, forces, displacements and accelerations
            let of_loads = |k: usize| {
                loads
                    .on(self.s)
                    .flat_map(|source| source.channels()[k].clone())
                    .collect()
            };
            let mut kinds: Vec<Vec<usize>> = vec![of_loads(0), of_loads(1)];
            for first in [
                Channel::Coordinate(self.s, 0),
                Channel::Acceleration(self.s, 0),
            ] {
                let dofs = foundations[self.s].dofs();
                kinds.extend(
                    history
                        .position(first)
                        .map(|first| (first..first + dofs).collect()),
                );
            }
            let needed = |rows: &[usize], (tolerance, most): (f64, usize)| {
                let samples: Vec<&[f64]> = rows.iter().map(|row| history.sample(*row)).collect();
                kept_rows(&samples, kinds.clone(), tolerance, most / width)
            };
            let rows = needed(&all, NEEDED[0]);
            let coarse = needed(&rows, NEEDED[1]);
            return ChosenRows {
                rows,
                stride: 1,
                coarse,
                kept: Vec::new(),
                most_deflections: MAX_STEPS,
            };
        }
        let stride = (history.len() * width).div_ceil(MAX_VALUES).max(1);
        let rows = every(&all, stride);
        let coarse = every(&(0..rows.len()).collect::<Vec<_>>(), 2);
        ChosenRows {
            rows,
            stride,
            coarse,
            kept: Vec::new(),
            most_deflections: MAX_DEFLECTIONS,
        }
    }

    /// Rows at which a load is at an end of a member of its rail, or a motion or load has a corner, and the [`BESIDE`] rows on
    /// both sides of them.
    fn rows_beside_corners(
        &self,
        Rows {
            history,
            loads,
            breaks,
            ..
        }: Rows<'_>,
    ) -> Vec<usize> {
        let is_at_end = |load: &RailLoad| self.ends.iter().any(|end| end.has(load));
        let is_corner = |row: &usize| {
            let sample = history.sample(*row);
            breaks.contains(&sample[0])
                || loads
                    .on(self.s)
                    .any(|source| is_at_end(&source.load_in(sample)))
        };
        let beside = |row: usize| row.saturating_sub(BESIDE)..(row + BESIDE + 1).min(history.len());
        with(
            (0..history.len())
                .filter(is_corner)
                .flat_map(beside)
                .collect(),
            &[],
        )
    }

    fn loaded<'b>(
        &'b self,
        Rows { foundations, .. }: Rows<'b>,
        (sections, points): (&'b Sections, &'b PointDeflections<'b>),
        (states, scanned): (&'b LoadStates, &'b [usize]),
        most_deflections: usize,
    ) -> LoadedGirders<'b> {
        let most = (states.len() / most_deflections).max(1);
        // a power of two, as the distances of scanned rows are
        let deflection_stride = 1 << most.ilog2();
        let is_deflected = |row: &usize| row.is_multiple_of(deflection_stride);
        LoadedGirders {
            foundation: &foundations[self.s],
            members: self.members,
            distributed: &self.distributed,
            sections,
            points,
            is_stopped: self.is_stopped,
            deflection_stride,
            states,
            scanned,
            deflected: scanned.iter().copied().filter(is_deflected).collect(),
        }
    }

    /// The states of the structure at rows of the history.
    fn states(
        &self,
        Rows {
            history,
            loads,
            foundations,
            ..
        }: Rows<'_>,
        rows: &[usize],
    ) -> LoadStates {
        LoadStates::new(
            history,
            loads,
            (self.s, foundations[self.s].dofs()),
            &self.ends,
            rows,
        )
    }

    /// Extremes of all spans, at some of the rows.
    pub fn spans(&self, rows: Rows<'_>, choice: RowChoice, accuracy: f64) -> SpanExtremes {
        let scanned = |choice: RowChoice| self.scanned(rows, self.chosen(rows, choice));
        let found = match choice {
            RowChoice::Smooth(stride) => {
                let (all, fewer) = (rows.history.len(), rows.history.len().div_ceil(stride));
                // of long histories alone, because the choice itself takes time
                is_worthwhile(fewest(all), fewer)
                    .then(|| scanned(RowChoice::Sampled(1)))
                    .filter(|found| is_worthwhile(found.scanned.len(), fewer))
                    .unwrap_or_else(|| scanned(RowChoice::Sampled(stride)))
            }
            _ => scanned(choice),
        };
        self.spans_at(rows, found, accuracy)
    }

    /// Extremes of all spans, with peaks that are looked for at the scanned rows.
    fn spans_at(&self, rows: Rows<'_>, found: ScannedStates, accuracy: f64) -> SpanExtremes {
        let ScannedStates {
            chosen,
            states,
            scanned,
        } = found;
        let few: Vec<usize> = chosen
            .coarse
            .iter()
            .map(|index| chosen.rows[*index])
            .collect();
        let points = PointDeflections::new(&rows.foundations[self.s], &self.sections, &states);
        let places = (&self.sections, &points);
        let fine = self.loaded(rows, places, (&states, &scanned), chosen.most_deflections);
        let few = self.states(rows, &few);
        let common: Vec<[usize; 2]> = scanned
            .iter()
            .enumerate()
            .filter_map(|(number, row)| Some([number, chosen.coarse.binary_search(row).ok()?]))
            .collect();
        let [numbers, own] =
            [0, 1].map(|k| common.iter().map(|pair| pair[k]).collect::<Vec<usize>>());
        let coarse = self.loaded(rows, places, (&few, &own), chosen.most_deflections);
        let [scan, few] = Scan::both(&fine, &coarse, &numbers);
        let values = |girders: &LoadedGirders<'_>, scan: &Scan| {
            Refinement {
                girders,
                scan,
                sizes: scan.sizes,
                accuracy,
            }
            .spans()
        };
        let (values, coarse) = (values(&fine, &scan), values(&coarse, &few));
        SpanExtremes {
            values,
            coarse,
            sizes: scan.sizes,
            states,
            scanned,
            scan,
            chosen,
        }
    }

    /// The states at chosen rows, and those of them at which peaks are looked for: all where stresses are wanted, of which only
    /// the largest row is known, and where too few can be left out.
    fn scanned(&self, rows: Rows<'_>, chosen: ChosenRows) -> ScannedStates {
        let states = self.states(rows, &chosen.rows);
        let (count, has_stresses) = (states.len(), !self.sections.stressed.all.is_empty());
        let scanned = (!has_stresses && is_worthwhile(fewest(count), count))
            .then(|| self.smooth(&states, &chosen.kept))
            .filter(|scanned| is_worthwhile(scanned.len(), count));
        ScannedStates {
            chosen,
            scanned: scanned.unwrap_or_else(|| (0..count).collect()),
            states,
        }
    }

    /// The rows that are left where those between which loads and motions are smooth are left out.
    fn smooth(&self, states: &LoadStates, kept: &[usize]) -> Vec<usize> {
        let lengths = self.sections.rails.iter().flat_map(RailSpans::lengths);
        let samples: Vec<&[f64]> = (0..states.len()).map(|row| states.row(row)).collect();
        scanned_rows(
            &samples,
            &states.kinds(),
            kept,
            lengths.fold(f64::INFINITY, f64::min),
        )
    }

    /// The extremes of spans and reactions as results, and the envelopes at all places and at those of the extremes.
    pub fn results(
        &self,
        rows: Rows<'_>,
        found: &SpanExtremes,
        accuracy: f64,
    ) -> (
        Vec<GirderExtreme>,
        Vec<GirderEnvelope>,
        GirderStresses,
        Vec<GirderReaction>,
    ) {
        let (sizes, most) = (found.sizes, found.chosen.most_deflections);
        let (foundation, states) = (&rows.foundations[self.s], &found.states);
        let points = PointDeflections::new(foundation, &self.sections, states);
        let states_of = (states, &found.scanned[..]);
        let girders = self.loaded(rows, (&self.sections, &points), states_of, most);
        let refinement = Refinement {
            girders: &girders,
            scan: &found.scan,
            sizes,
            accuracy,
        };
        let extremes = found
            .values
            .iter()
            .map(|value| extreme(&refinement, value))
            .collect();
        let stresses = refinement.stresses(&found.values);
        let reactions = refinement.reactions(&self.reactions);
        let mut all = envelopes(&refinement);
        let places: Vec<(usize, f64)> = found.values.iter().map(|v| (v.rail, v.found.x)).collect();
        let sections = self.sections.at(&places, self.members);
        let points = PointDeflections::new(foundation, &sections, states);
        let girders = self.loaded(rows, (&sections, &points), states_of, most);
        let scan = Scan::of_sections(&girders);
        all.extend(envelopes(&Refinement {
            girders: &girders,
            scan: &scan,
            sizes,
            accuracy,
        }));
        // places in order; quantities keep theirs
        all.sort_by(|a, b| a.rail.cmp(&b.rail).then(a.x.total_cmp(&b.x)));
        (extremes, all, stresses, reactions)
    }
}

/// Numbers of two increasing lists, each once, in order.
fn with(mut numbers: Vec<usize>, more: &[usize]) -> Vec<usize> {
    numbers.extend(more);
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// Every so many of the rows, and the last one.
fn every(rows: &[usize], stride: usize) -> Vec<usize> {
    let mut out: Vec<usize> = rows.iter().copied().step_by(stride).collect();
    if out.last() != rows.last() {
        out.extend(rows.last());
    }
    out
}

/// An extreme of a span as a result.
fn extreme(refinement: &Refinement<'_>, value: &SpanValue) -> GirderExtreme {
    let girders = refinement.girders;
    let SpanValue {
        rail,
        span,
        quantity,
        kind,
        found,
    } = *value;
    let dead = found
        .section
        .map_or(0.0, |(member, place)| girders.dead(member, place)[quantity]);
    GirderExtreme {
        rail: girders.sections.rails[rail].scene_rail,
        span,
        quantity: GirderResponse::ALL[quantity],
        is_max: kind == 0,
        value: refinement.without_rounding(quantity, SIGNS[kind] * found.signed),
        dead: dead + 0.0,
        x: found.x + 0.0,
        side: found.side,
        time: girders.states.at(found.position).time,
    }
}

/// The envelopes of all points.
fn envelopes(refinement: &Refinement<'_>) -> Vec<GirderEnvelope> {
    let Refinement { girders, .. } = refinement;
    let all = girders.sections;
    let mut at_point = vec![Vec::new(); all.points.len()];
    for (index, section) in all.sections.iter().enumerate() {
        at_point[section.point].push(index);
    }
    let quantities: Vec<usize> = (0..FORCES + 2)
        .filter(|quantity| !refinement.is_zero(*quantity))
        .collect();
    let mut out = Vec::new();
    for (index, (point, sections)) in all.points.iter().zip(&at_point).enumerate() {
        if (girders.is_stopped)() {
            break;
        }
        for &quantity in &quantities {
            for (kind, sign) in SIGNS.into_iter().enumerate() {
                let found = match quantity.checked_sub(FORCES) {
                    Some(plane) => refinement.point(index, plane, kind),
                    None => sections
                        .iter()
                        .filter_map(|at| refinement.section(*at, quantity, kind, true))
                        .reduce(|best, next| {
                            if next.signed > best.signed {
                                next
                            } else {
                                best
                            }
                        }),
                };
                let Some(found) = found else { continue };
                out.push(GirderEnvelope {
                    rail: all.rails[point.rail].scene_rail,
                    x: point.x,
                    quantity: GirderResponse::ALL[quantity],
                    is_max: kind == 0,
                    value: refinement.without_rounding(quantity, sign * found.signed),
                    time: girders.states.at(found.position).time,
                    coincident: coincident(
                        refinement,
                        point.rail,
                        sections.first().copied(),
                        quantity,
                        &found,
                    ),
                });
            }
        }
    }
    out
}

/// Moment, shear and deflection in the plane of a quantity, of the same section at the same time. Those of a deflection
/// are of the first section of its point.
fn coincident(
    refinement: &Refinement<'_>,
    rail: usize,
    first: Option<usize>,
    quantity: usize,
    found: &GirderValue,
) -> [f64; 3] {
    let girders = refinement.girders;
    let is_lateral = [
        GirderResponse::LateralShear as usize,
        GirderResponse::LateralMoment as usize,
        GirderResponse::LateralDeflection as usize,
    ]
    .contains(&quantity);
    let state = refinement.state_of(found);
    let deflection = girders
        .deflections(rail, &[found.x], usize::from(is_lateral), &state)
        .map_or(0.0, |all| all[0]);
    let section = found.section.or_else(|| {
        let section = girders.sections.sections[first?];
        Some((section.member, section.place))
    });
    let forces = section.map_or([0.0; FORCES], |(member, place)| {
        girders.forces_in(member, place, &state, found.own)
    });
    let [moment, shear] = if is_lateral {
        [GirderResponse::LateralMoment, GirderResponse::LateralShear]
    } else {
        [
            GirderResponse::VerticalMoment,
            GirderResponse::VerticalShear,
        ]
    };
    [forces[moment as usize], forces[shear as usize], deflection]
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use formats::scene::SceneSource;
    use formats::scene::motion::simulation_input;
    use formats::text::source::Source;
    use foundations::{distinct_specs, select_and_run, solution_of, solve_specs};

    use super::*;
    use crate::observe::ColumnObserver;

    /// How a run is evaluated with rows left out and with all of them.
    struct Compared {
        /// Numbers of the rows: all, and those scanned.
        rows: [usize; 2],
        /// Largest difference of an extreme, an envelope or a reaction, relative to the largest value of its kind.
        difference: f64,
    }

    /// Runs the first case of an example with changes and evaluates all rows, and those between which it is not smooth.
    fn compared(example: &str, changes: &str) -> Compared {
        let path = format!(
            "{}/../../examples/{example}/scene.json",
            env!("CARGO_MANIFEST_DIR")
        );
        let source = SceneSource::open(path.as_ref()).expect("an example");
        let changes = Source {
            name: "changes".to_owned(),
            text: changes.to_owned(),
        };
        let document = source
            .document(Some(&changes), true)
            .expect("a scene without faults");
        let known =
            solve_specs(&document, &distinct_specs(&document)).expect("structures that stand");
        let mut scene = document.cases[0].scene.clone();
        let input = simulation_input(&scene).expect("equal fractions");
        let mut observer = ColumnObserver::new(&document.cases[0].scene, &input, &known, &|_| ());
        let mut watch = |_: f64| ControlFlow::Continue(());
        let run = select_and_run(
            &mut scene,
            &input.scene,
            &known,
            &|_, _| true,
            &mut observer,
            &mut watch,
        );
        let run = run.expect("a scene that starts");
        let history = &run.run.solution.intervals().increasing();
        let loads = WheelLoadReader::new(&scene, &input, history);
        let (all, is_stopped) = (SolvedMembers::new(&known), || false);
        let solved = solution_of(all.known(), &scene.structures[0].origin).expect("a spec");
        let girders = PreparedGirders::new(&scene, 0, &run.built[0], solved, (&all, &is_stopped));
        let girders = girders
            .expect("members that are solved")
            .expect("a structure with members under rails");
        let foundations: Vec<Foundation> = run
            .built
            .into_iter()
            .map(|built| built.foundation)
            .collect();
        let breaks = input.scene.breaks();
        let rows = Rows {
            history,
            loads: &loads,
            foundations: &foundations,
            breaks: &breaks,
        };
        let mut counts = [0; 2];
        let found = [false, true].map(|leaves_out| {
            let chosen = girders.chosen(rows, RowChoice::Sampled(1));
            let states = girders.states(rows, &chosen.rows);
            let scanned = match leaves_out {
                true => girders.smooth(&states, &chosen.kept),
                false => (0..states.len()).collect(),
            };
            counts[usize::from(leaves_out)] = scanned.len();
            assert!(
                chosen
                    .kept
                    .iter()
                    .all(|row| scanned.binary_search(row).is_ok())
            );
            let spans = girders.spans_at(
                rows,
                ScannedStates {
                    chosen,
                    states,
                    scanned,
                },
                scene.accuracy,
            );
            let (extremes, envelopes, _, reactions) = girders.results(rows, &spans, scene.accuracy);
            (spans.sizes, extremes, envelopes, reactions)
        });
        let [(sizes, extremes, envelopes, reactions), few] = found;
        let of_kind = |quantity: usize| match quantity {
            0 | 2 | 3 => sizes[0].max(sizes[2]).max(sizes[3]),
            1 | 4 | 5 => sizes[1].max(sizes[4]).max(sizes[5]),
            _ => sizes[6].max(sizes[7]),
        };
        let size = |quantity: GirderResponse| {
            of_kind(
                GirderResponse::ALL
                    .iter()
                    .position(|own| *own == quantity)
                    .expect("one of all"),
            )
        };
        let mut difference = 0.0_f64;
        assert!(!extremes.is_empty() && extremes.len() == few.1.len());
        for (a, b) in extremes.iter().zip(&few.1) {
            assert_eq!(
                (a.rail, a.span, a.quantity, a.is_max),
                (b.rail, b.span, b.quantity, b.is_max)
            );
            difference = difference.max((a.value - b.value).abs() / size(a.quantity));
        }
        // places of extremes may differ by rounding
        let key = |a: &GirderEnvelope| (a.rail, a.x.to_bits(), a.quantity, a.is_max);
        let mut same = 0;
        for a in &envelopes {
            if let Some(b) = few.2.iter().find(|b| key(b) == key(a)) {
                difference = difference.max((a.value - b.value).abs() / size(a.quantity));
                same += 1;
            }
        }
        assert!(
            10 * same > 8 * envelopes.len(),
            "{same} of {}",
            envelopes.len()
        );
        assert!(!reactions.is_empty() && reactions.len() == few.3.len());
        for (a, b) in reactions.iter().zip(&few.3) {
            assert_eq!(
                (&a.support, a.direction, a.is_max),
                (&b.support, b.direction, b.is_max)
            );
            let size = of_kind(usize::from(a.direction >= fea::Dof::Rx));
            difference = difference.max((a.value - b.value).abs() / size);
        }
        Compared {
            rows: counts,
            difference,
        }
    }

    /// Identity: rows between which loads and motions are smooth change no extreme, envelope or reaction that is followed among
    /// them, of wheels that roll over supports on a girder that vibrates.
    #[test]
    fn extremes_with_rows_left_out_are_those_of_all_rows() {
        let short = r#"{"end": {"time": 4}}"#;
        for (example, changes) in [("bogie", "{}"), ("runway", short), ("monorail", "{}")] {
            let Compared {
                rows: [all, scanned],
                difference,
            } = compared(example, changes);
            assert!(3 * scanned < all, "{example}: {scanned} of {all} rows");
            assert!(difference < 1e-6, "{example}: {difference:e}");
        }
    }
}
