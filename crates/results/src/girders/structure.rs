//! The girders of one structure: extremes of its spans, and envelopes at places.

use formats::scene::Scene;
use sim::{Foundation, History};
use trains::{GirderResponse, MemberForces};

use super::distributed::{DistributedForces, FORCES};
use super::girder::LoadedGirders;
use super::instants::LoadStates;
use super::kept_rows::kept_rows;
use super::reactions::{GirderReaction, Reactions};
use super::refine::{GirderValue, Refinement};
use super::scan::{SIGNS, Scan};
use super::sections::Sections;
use super::solved::SolvedMembers;
use super::spans::SpanValue;
use super::stresses::GirderStresses;
use super::{GirderEnvelope, GirderExtreme};
use crate::Error;
use crate::response::WheelLoadReader;
use foundations::{BuiltFoundation, SolvedModel};

/// Largest number of values that a scan evaluates; of longer histories it takes fewer rows.
pub(super) const MAX_VALUES: usize = 2_000_000;
/// Number of rows above which deflections are evaluated at fewer rows.
const MAX_DEFLECTIONS: usize = 500;
/// The same for the ends of steps, between which deflections are less even.
const MAX_STEPS: usize = 4_000;

/// A structure prepared for any number of runs.
pub(super) struct PreparedGirders<'a> {
    scene: &'a Scene,
    s: usize,
    members: &'a MemberForces,
    sections: Sections,
    distributed: DistributedForces,
    reactions: Reactions,
}

/// The history of a run from which extremes are found.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    pub history: &'a History,
    pub loads: &'a WheelLoadReader,
    /// One for each structure.
    pub foundations: &'a [Foundation],
}

/// A choice among the rows of a history.
#[derive(Clone, Copy, Debug)]
pub(super) enum RowChoice {
    /// Every row, every second one and so on; fewer where there are too many values.
    Every(usize),
    /// Those between which loads differ from straight lines by more than a tolerance, relative to the largest load. It is
    /// raised until there are no more than `most` values of all rows.
    Needed { tolerance: f64, most: usize },
}

/// Rows of a history that are evaluated.
#[derive(Clone, Debug)]
pub(super) struct ChosenRows {
    pub rows: Vec<usize>,
    /// Every how many rows of the history were taken, where they were not chosen by need.
    pub stride: usize,
    /// Every how many of these rows deflections are evaluated.
    deflection_stride: usize,
}

/// Extremes of the spans of a structure and the largest magnitudes of its quantities, for one history.
pub(super) struct SpanExtremes {
    pub values: Vec<SpanValue>,
    /// The scan from which they follow.
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
        all: &'a SolvedMembers<'_>,
    ) -> Result<Option<PreparedGirders<'a>>, Error> {
        let failed =
            |source: trains::Error| Error::Girders { structure: scene.structures[s].name.clone(), source };
        let Some(members) = all.of(solved) else { return Ok(None) };
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
        Ok(Some(PreparedGirders { scene, s, members, sections, distributed, reactions }))
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
        let on = loads.at(history.sample(0)).iter().filter(|load| load.structure == self.s).count();
        FORCES * (self.sections.sections.len() + 2 * on) + 2 * self.sections.points.len()
    }

    /// Largest number of rows of a history like this one that are all evaluated.
    pub fn most_rows(&self, history: &History, loads: &WheelLoadReader) -> usize {
        MAX_VALUES / self.width(history, loads).max(1)
    }

    fn chosen(&self, Rows { history, loads, foundations }: Rows<'_>, choice: RowChoice) -> ChosenRows {
        let width = self.width(history, loads);
        let (rows, stride, most) = match choice {
            RowChoice::Needed { tolerance, most } => {
                let own = (self.s, foundations[self.s].dofs());
                (kept_rows(history, loads, own, tolerance, most / width.max(1)), 1, MAX_STEPS)
            }
            RowChoice::Every(factor) => {
                let stride = factor * (history.len() * width).div_ceil(MAX_VALUES).max(1);
                let mut rows: Vec<usize> = (0..history.len()).step_by(stride).collect();
                let last = history.len().saturating_sub(1);
                if rows.last().is_some_and(|row| *row != last) {
                    rows.push(last);
                }
                (rows, stride, MAX_DEFLECTIONS)
            }
        };
        let deflection_stride = (rows.len() / most).max(1);
        ChosenRows { rows, stride, deflection_stride }
    }

    fn loaded<'b>(
        &'b self,
        Rows { history, loads, foundations }: Rows<'b>,
        sections: &'b Sections,
        chosen: &ChosenRows,
    ) -> LoadedGirders<'b> {
        let foundation = &foundations[self.s];
        let ends: Vec<(usize, f64)> =
            self.members.members().flat_map(|member| member.x.map(|x| (member.rail, x))).collect();
        let own = (self.s, foundation.dofs());
        let mut girders = LoadedGirders {
            foundation,
            members: self.members,
            distributed: &self.distributed,
            sections,
            states: LoadStates::new(history, loads, own, &ends, chosen.rows.clone()),
            deflects: [foundation.parts.is_none()
                && (foundation.structure.is_some() || foundation.compliance.is_some());
                2],
            deflection_stride: chosen.deflection_stride,
        };
        if girders.deflects[1] {
            girders.deflects[1] = girders.has_deflections(1);
        }
        girders
    }

    /// Extremes of all spans, at some of the rows.
    pub fn spans(&self, rows: Rows<'_>, choice: RowChoice, accuracy: f64) -> SpanExtremes {
        let chosen = self.chosen(rows, choice);
        let girders = self.loaded(rows, &self.sections, &chosen);
        let scan = Scan::new(&girders);
        let sizes = scan.sizes;
        let refinement = Refinement { girders: &girders, scan: &scan, sizes, accuracy };
        let values = refinement.spans();
        SpanExtremes { values, scan, sizes, chosen }
    }

    /// The extremes of spans and reactions as results, and the envelopes at all places and at those of the extremes.
    pub fn results(
        &self,
        rows: Rows<'_>,
        found: &SpanExtremes,
        accuracy: f64,
    ) -> (Vec<GirderExtreme>, Vec<GirderEnvelope>, GirderStresses, Vec<GirderReaction>) {
        let sizes = found.sizes;
        let girders = self.loaded(rows, &self.sections, &found.chosen);
        let refinement = Refinement { girders: &girders, scan: &found.scan, sizes, accuracy };
        let extremes = found.values.iter().map(|value| extreme(&refinement, value)).collect();
        let stresses = refinement.stresses(&found.values);
        let reactions = refinement.reactions(&self.reactions);
        let mut all = envelopes(&refinement);
        let places: Vec<(usize, f64)> = found.values.iter().map(|v| (v.rail, v.found.x)).collect();
        let sections = self.sections.at(&places, self.members);
        let girders = self.loaded(rows, &sections, &found.chosen);
        let scan = Scan::new(&girders);
        all.extend(envelopes(&Refinement { girders: &girders, scan: &scan, sizes, accuracy }));
        // places in order; quantities keep theirs
        all.sort_by(|a, b| a.rail.cmp(&b.rail).then(a.x.total_cmp(&b.x)));
        (extremes, all, stresses, reactions)
    }
}

/// An extreme of a span as a result.
fn extreme(refinement: &Refinement<'_>, value: &SpanValue) -> GirderExtreme {
    let girders = refinement.girders;
    let SpanValue { rail, span, quantity, kind, found } = *value;
    let dead = found.section.map_or(0.0, |(member, place)| girders.dead(member, place)[quantity]);
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
    let quantities: Vec<usize> = (0..FORCES + 2).filter(|quantity| !refinement.is_zero(*quantity)).collect();
    let mut out = Vec::new();
    for (index, (point, sections)) in all.points.iter().zip(&at_point).enumerate() {
        for &quantity in &quantities {
            for (kind, sign) in SIGNS.into_iter().enumerate() {
                let found = match quantity.checked_sub(FORCES) {
                    Some(plane) => refinement.point(index, plane, kind),
                    None => sections
                        .iter()
                        .filter_map(|at| refinement.section(*at, quantity, kind, true))
                        .reduce(|best, next| if next.signed > best.signed { next } else { best }),
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
    let deflection =
        girders.deflections(rail, &[found.x], usize::from(is_lateral), &state).map_or(0.0, |all| all[0]);
    let section = found.section.or_else(|| {
        let section = girders.sections.sections[first?];
        Some((section.member, section.place))
    });
    let forces =
        section.map_or([0.0; FORCES], |(member, place)| girders.forces_in(member, place, &state, found.own));
    let [moment, shear] = if is_lateral {
        [GirderResponse::LateralMoment, GirderResponse::LateralShear]
    } else {
        [GirderResponse::VerticalMoment, GirderResponse::VerticalShear]
    };
    [forces[moment as usize], forces[shear as usize], deflection]
}
