//! The girders of one structure: extremes of its spans, and envelopes at places.

use formats::scene::Scene;
use sim::{Foundation, History};
use trains::{GirderResponse, MemberForces};

use super::distributed::{DistributedForces, FORCES};
use super::girder::LoadedGirders;
use super::instants::LoadStates;
use super::kept_rows::kept_rows;
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
/// Factor by which the tolerance of a choice is raised.
const RAISED: f64 = 2.0;
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
}

/// The history of a run from which extremes are found.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    pub history: &'a History,
    pub loads: &'a WheelLoadReader,
    /// One for each structure.
    pub foundations: &'a [Foundation],
    /// How rows are left out; `None` for all rows.
    pub choice: Option<RowChoice>,
}

/// A choice among the rows of a history.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowChoice {
    /// Difference of loads from straight lines between rows up to which rows are left out, relative to the largest load. It
    /// is raised until there are no more than `most` values of all rows.
    pub tolerance: f64,
    pub most: usize,
}

/// Extremes of the spans of a structure and the largest magnitudes of its quantities, for one history.
pub(super) struct SpanExtremes {
    pub values: Vec<SpanValue>,
    /// The scan from which they follow.
    scan: Scan,
    pub sizes: [f64; FORCES + 2],
    /// Every how many rows were evaluated.
    pub stride: usize,
    /// Number of rows that were evaluated.
    pub rows: usize,
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
        Ok(Some(PreparedGirders { scene, s, members, sections, distributed }))
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

    fn loaded<'b>(
        &'b self,
        Rows { history, loads, foundations, choice }: Rows<'b>,
        sections: &'b Sections,
        factor: usize,
    ) -> (LoadedGirders<'b>, usize) {
        let foundation = &foundations[self.s];
        let ends: Vec<(usize, f64)> =
            self.members.members().flat_map(|member| member.x.map(|x| (member.rail, x))).collect();
        let own = (self.s, foundation.dofs());
        let width = self.width(history, loads);
        let all = match choice {
            Some(RowChoice { tolerance, most }) => {
                let mut tolerances =
                    std::iter::successors(Some(tolerance), |t| (*t < 1.0).then_some(RAISED * t));
                let kept = |tolerance: f64| kept_rows(history, loads, own, tolerance);
                let fits = |rows: &Vec<usize>| rows.len() * width <= most;
                tolerances.find_map(|t| Some(kept(t)).filter(fits)).unwrap_or_else(|| kept(1.0))
            }
            None => (0..history.len()).collect(),
        };
        let (stride, most_deflections) = match choice {
            Some(_) => (factor, MAX_STEPS),
            None => (factor * (all.len() * width).div_ceil(MAX_VALUES).max(1), MAX_DEFLECTIONS),
        };
        let mut rows: Vec<usize> = all.iter().copied().step_by(stride).collect();
        if rows.last() != all.last() {
            rows.extend(all.last());
        }
        let mut girders = LoadedGirders {
            foundation,
            members: self.members,
            distributed: &self.distributed,
            sections,
            states: LoadStates::new(history, loads, own, &ends, rows),
            deflects: [foundation.parts.is_none()
                && (foundation.structure.is_some() || foundation.compliance.is_some());
                2],
            deflection_stride: 1,
        };
        girders.deflection_stride = (girders.states.len() / most_deflections).max(1);
        if girders.deflects[1] {
            girders.deflects[1] = girders.has_deflections(1);
        }
        (girders, stride)
    }

    /// Extremes of all spans, at every row (`factor` 1) or every second one (2).
    pub fn spans(&self, rows: Rows<'_>, factor: usize, accuracy: f64) -> SpanExtremes {
        let (girders, stride) = self.loaded(rows, &self.sections, factor);
        let scan = Scan::new(&girders);
        let sizes = scan.sizes;
        let refinement = Refinement { girders: &girders, scan: &scan, sizes, accuracy };
        let values = refinement.spans();
        SpanExtremes { values, scan, sizes, stride, rows: girders.states.len() }
    }

    /// The extremes as results, and the envelopes at all places and at those of the extremes.
    pub fn results(
        &self,
        rows: Rows<'_>,
        found: &SpanExtremes,
        accuracy: f64,
    ) -> (Vec<GirderExtreme>, Vec<GirderEnvelope>, GirderStresses) {
        let sizes = found.sizes;
        let (girders, _) = self.loaded(rows, &self.sections, 1);
        let refinement = Refinement { girders: &girders, scan: &found.scan, sizes, accuracy };
        let extremes = found.values.iter().map(|value| extreme(&refinement, value)).collect();
        let stresses = refinement.stresses(&found.values);
        let mut all = envelopes(&refinement);
        let places: Vec<(usize, f64)> = found.values.iter().map(|v| (v.rail, v.found.x)).collect();
        let sections = self.sections.at(&places, self.members);
        let (girders, _) = self.loaded(rows, &sections, 1);
        let scan = Scan::new(&girders);
        all.extend(envelopes(&Refinement { girders: &girders, scan: &scan, sizes, accuracy }));
        // places in order; quantities keep theirs
        all.sort_by(|a, b| a.rail.cmp(&b.rail).then(a.x.total_cmp(&b.x)));
        (extremes, all, stresses)
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
