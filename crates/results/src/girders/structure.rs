//! The girders of one structure: extremes of its spans and reactions, and envelopes at places.

use formats::scene::Scene;
use sim::{Foundation, Solution, SolutionNodes};
use trains::{GirderResponse, MemberForces};

use super::distributed::{DistributedForces, FORCES};
use super::girder::LoadedGirders;
use super::reactions::Reactions;
use super::sections::{RailSpans, Sections};
use super::solved::SolvedMembers;
use super::spans::{GirderPeaks, SpanValue};
use super::value::GirderValue;
use super::{GirderEnvelope, GirderExtreme, GirderExtremes};
use crate::Error;
use crate::loads::WheelLoadReader;
use crate::pieces::SIGNS;
use crate::pieces::{LoadPieces, RailCells};
use foundations::{BuiltFoundation, SolvedModel};

/// A structure prepared for its run.
pub(super) struct PreparedGirders<'a> {
    s: usize,
    members: &'a MemberForces,
    sections: Sections,
    distributed: DistributedForces,
    reactions: Reactions,
}

impl<'a> PreparedGirders<'a> {
    /// Prepares structure `s`; `None` where it has no members under rails.
    ///
    /// # Errors
    /// [`Error::Girders`] for a model that cannot be solved.
    pub fn new(
        scene: &Scene,
        s: usize,
        built: &BuiltFoundation,
        solved: &SolvedModel,
        all: &'a SolvedMembers,
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
        Ok(Some(PreparedGirders {
            s,
            members,
            sections,
            distributed,
            reactions,
        }))
    }

    /// The cells in which influence lines of the members, places and supports are cubics, or of rigid parts of the fourth degree,
    /// and that no end of a span divides.
    fn cells(&self, foundation: &Foundation) -> RailCells {
        let structure = self.members.structure();
        let rails = structure.rail_count();
        let of_members = (0..rails).flat_map(|rail| {
            structure
                .member_ends(rail)
                .into_iter()
                .map(move |x| (rail, x))
        });
        let mut ends = self.reactions.breaks();
        ends.extend(of_members);
        let of_spans = |own: &RailSpans| -> Vec<(usize, f64)> {
            own.ends.iter().map(|x| (own.rail, *x)).collect()
        };
        let of_foundation = foundation.rails.iter().take(rails).enumerate();
        let of_foundation =
            of_foundation.flat_map(|(rail, own)| own.breaks.iter().map(move |x| (rail, *x)));
        let mut more: Vec<(usize, f64)> = of_foundation.collect();
        more.extend(self.sections.rails.iter().flat_map(of_spans));
        RailCells::new(rails, &ends, &more)
    }

    /// Adds the extremes of spans and reactions over a run, and the envelopes at all places and at those of the extremes.
    pub fn add(
        &self,
        (solution, nodes): (&Solution, &SolutionNodes),
        loads: &WheelLoadReader,
        foundation: &Foundation,
        is_stopped: &dyn Fn() -> bool,
        out: &mut GirderExtremes,
    ) {
        let pieces = LoadPieces::new(
            (solution, nodes),
            loads,
            (self.s, foundation.dofs()),
            self.cells(foundation),
        );
        if pieces.pieces.is_empty() {
            return;
        }
        let girders = |sections| LoadedGirders {
            foundation,
            members: self.members,
            distributed: &self.distributed,
            sections,
            pieces: &pieces,
            is_stopped,
        };
        let own = girders(&self.sections);
        let peaks = GirderPeaks::new(&own, true);
        let values = peaks.spans();
        out.extremes
            .extend(values.iter().map(|value| extreme(&peaks, value)));
        out.stresses.extend(peaks.stresses());
        out.reactions
            .extend(self.reactions.extremes(&pieces, is_stopped));
        let mut envelope = envelopes(&peaks, &peaks);
        let places: Vec<(usize, f64)> = values.iter().map(|v| (v.rail, v.found.x)).collect();
        let sections = self.sections.at(&places, self.members);
        let more = girders(&sections);
        envelope.extend(envelopes(&GirderPeaks::new(&more, false), &peaks));
        // places in order; quantities keep theirs
        envelope.sort_by(|a, b| a.rail.cmp(&b.rail).then(a.x.total_cmp(&b.x)));
        out.envelope.extend(envelope);
    }
}

/// An extreme of a span as a result.
fn extreme(peaks: &GirderPeaks<'_>, value: &SpanValue) -> GirderExtreme {
    let SpanValue {
        rail,
        span,
        quantity,
        kind,
        found,
    } = *value;
    let girders = peaks.girders;
    let of_section =
        |(member, place): (usize, f64)| girders.distributed.dead(member, place)[quantity];
    GirderExtreme {
        rail: girders.sections.rails[rail].scene_rail,
        span,
        quantity: GirderResponse::ALL[quantity],
        is_max: kind == 0,
        value: peaks.without_rounding(quantity, SIGNS[kind] * found.signed),
        dead: found.section.map_or(0.0, of_section) + 0.0,
        x: found.x + 0.0,
        side: found.side,
        time: girders.pieces.time(found.at),
    }
}

/// The envelopes of all points of `peaks`. What counts as zero is as in the peaks of the whole structure.
fn envelopes(peaks: &GirderPeaks<'_>, whole: &GirderPeaks<'_>) -> Vec<GirderEnvelope> {
    let girders = peaks.girders;
    let all = girders.sections;
    let mut at_point = vec![Vec::new(); all.points.len()];
    for (index, section) in all.sections.iter().enumerate() {
        at_point[section.point].push(index);
    }
    let quantities: Vec<usize> = (0..FORCES + 2)
        .filter(|quantity| !whole.is_zero(*quantity))
        .collect();
    let mut out = Vec::new();
    for (index, (point, sections)) in all.points.iter().zip(&at_point).enumerate() {
        if (girders.is_stopped)() {
            break;
        }
        for &quantity in &quantities {
            for (kind, sign) in SIGNS.into_iter().enumerate() {
                let value = |at: usize| peaks.value(at, quantity, kind);
                let found = match quantity < FORCES {
                    false => value(index),
                    true => sections
                        .iter()
                        .filter_map(|at| value(*at))
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
                    value: whole.without_rounding(quantity, sign * found.signed),
                    time: girders.pieces.time(found.at),
                    coincident: coincident(
                        girders,
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
    girders: &LoadedGirders<'_>,
    rail: usize,
    first: Option<usize>,
    quantity: usize,
    found: &GirderValue,
) -> [f64; 3] {
    let is_lateral = [
        GirderResponse::LateralShear as usize,
        GirderResponse::LateralMoment as usize,
        GirderResponse::LateralDeflection as usize,
    ]
    .contains(&quantity);
    let state = girders.pieces.at(found.at);
    let deflection = girders
        .deflections(rail, &[found.x], usize::from(is_lateral), &state)
        .map_or(0.0, |all| all[0]);
    let section = found.section.or_else(|| {
        let section = girders.sections.sections[first?];
        Some((section.member, section.place))
    });
    let forces = section.map_or([0.0; FORCES], |(member, place)| {
        girders.forces(member, place, &state, found.own)
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
    use crate::pieces::Instant;

    /// Number of times in a piece at which values are compared.
    const SAMPLES: usize = 24;

    /// How peaks of sections and places compare with values at many times: by how much, relative to the largest of its quantity, a
    /// value exceeds its peak, and a peak all values.
    fn compared(example: &str, changes: &str) -> [f64; 2] {
        let root = env!("CARGO_MANIFEST_DIR");
        let path = format!("{root}/../../examples/{example}/scene.json");
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
        let nodes = run.run.solution.intervals();
        let loads = WheelLoadReader::new(&scene, &input, &nodes.rows);
        let all = SolvedMembers::new(&known);
        let solved = solution_of(all.known(), &scene.structures[0].origin).expect("a spec");
        let own = PreparedGirders::new(&scene, 0, &run.built[0], solved, &all)
            .expect("members that are solved")
            .expect("a structure with members under rails");
        let foundation = &run.built[0].foundation;
        let cells = own.cells(foundation);
        let of_run = (&run.run.solution, &nodes);
        let pieces = LoadPieces::new(of_run, &loads, (0, foundation.dofs()), cells);
        let girders = LoadedGirders {
            foundation,
            members: own.members,
            distributed: &own.distributed,
            sections: &own.sections,
            pieces: &pieces,
            is_stopped: &|| false,
        };
        let peaks = GirderPeaks::new(&girders, true);
        let mut most = [f64::NEG_INFINITY; 2];
        let quantities = (0..FORCES + 2).filter(|quantity| !peaks.is_zero(*quantity));
        for quantity in quantities {
            let is_force = quantity < FORCES;
            let count = if is_force {
                own.sections.sections.len()
            } else {
                own.sections.points.len()
            };
            // every third place is enough
            for at in (0..count).step_by(3) {
                let value = |state: &crate::pieces::LoadState<'_>| match is_force {
                    true => {
                        let section = own.sections.sections[at];
                        girders.forces(section.member, section.place, state, None)[quantity]
                    }
                    false => {
                        let point = own.sections.points[at];
                        let plane = quantity - FORCES;
                        let found = girders.deflections(point.rail, &[point.x], plane, state);
                        found.expect("a structure that is restrained")[0]
                    }
                };
                let mut range = [f64::NEG_INFINITY; 2];
                for piece in 0..pieces.pieces.len() {
                    for k in 0..=SAMPLES {
                        let share = k as f64 / SAMPLES as f64;
                        let found = value(&pieces.at(Instant { piece, share }));
                        range = [range[0].max(found), range[1].max(-found)];
                    }
                }
                for (kind, found) in range.into_iter().enumerate() {
                    let peak = peaks.value(at, quantity, kind).expect("a peak").signed;
                    let size = peaks.sizes[quantity];
                    most[0] = most[0].max((found - peak) / size);
                    most[1] = most[1].max((peak - found) / size);
                }
            }
        }
        most
    }

    /// External: no value at two dozen times of every piece exceeds a peak that polynomials and bounds have found, and no peak
    /// exceeds these values by more than what they miss beside cusps and jumps.
    #[test]
    fn peaks_are_those_of_values_at_many_times() {
        let short = r#"{"end": {"time": 2}}"#;
        for example in ["bogie", "runway", "monorail"] {
            let [above, below] = compared(example, short);
            println!("{example}: {above:.1e} above, {below:.1e} below");
            assert!(above < 1e-6, "{example}: {above:e}");
            // the trolley of the monorail rests at a section, of which these values see one side
            let missed = if example == "monorail" { 0.02 } else { 2e-3 };
            assert!(below < missed, "{example}: {below:e}");
        }
    }
}
