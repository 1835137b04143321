//! The largest direct stress of each section under a rail in a run, from normal force and moments that act at once.
//!
//! Stresses are evaluated at all sections of the scan and on both sides of each wheel at all rows, where wheels pass sections,
//! and where the normal force and the moments of spans are extreme. The largest of them are refined over time between the
//! neighbouring rows and, where forces are distributed along members, between the neighbouring sections. Like the extremes of
//! spans, what is found is a sample: a larger stress between rows and sections is not excluded.

use design::{FibreStress, by_reason, side_word};
use formats::LateralSection;
use formats::scene::{Origin, Scene};
use serde_json::{Map, Value, json};
use trains::{PassedLoads, SectionSide};

use super::distributed::Quantities;
use super::fibres::DIRECT;
use super::peaks::largest;
use super::refine::{GirderValue, NEAR, ROUNDS, Refinement, offer};
use super::spans::SpanValue;

/// Stresses on both sides of a wheel that count as equal, relative to their size.
const ROUNDING: f64 = 1e-12;
/// Stresses below this fraction of the largest one of a structure count as zero.
const ZERO: f64 = 1e-9;

/// The largest direct stress of a section under a rail over a run.
#[derive(Clone, Debug, PartialEq)]
pub struct GirderStress {
    /// Index of the rail in the scene.
    pub rail: usize,
    /// Number of the span; 0 and one more than the last for overhangs.
    pub span: usize,
    /// Name of the section.
    pub section: String,
    /// The fibre, by its edges, such as `top, +z`.
    pub fibre: &'static str,
    /// The stress, in force over the square of length, positive in tension:
    /// sigma = N/A - M_v v/I_v + M_l w/I_l, the last part M_l/(t b^2/6) where the top flange alone takes lateral moments.
    pub value: f64,
    /// Its parts of normal force, vertical and lateral moment.
    pub parts: [f64; 3],
    /// The normal force, the vertical and the lateral moment; with dead load where the output of the scene requests it.
    pub forces: [f64; 3],
    /// Yield strength, where the spec gives it.
    pub yield_strength: Option<f64>,
    /// Rail coordinate.
    pub x: f64,
    /// Side of the section.
    pub side: SectionSide,
    /// Time.
    pub time: f64,
}

impl GirderStress {
    /// The stress over the yield strength; `None` where that is not known.
    #[must_use]
    pub fn utilisation(&self) -> Option<f64> {
        Some(self.value.abs() / self.yield_strength?)
    }
}

/// Direct stresses of the girders of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GirderStresses {
    /// One for each section under each rail, unless it is zero throughout.
    pub rows: Vec<GirderStress>,
    /// Rails of the scene, and what keeps sections under them from having stresses.
    pub lacks: Vec<(usize, String)>,
}

impl GirderStresses {
    /// The largest stress by utilisation; by size where no yield strength is known.
    #[must_use]
    pub fn governing(&self) -> Option<&GirderStress> {
        let used = self.rows.iter().filter(|row| row.yield_strength.is_some());
        let most = used.reduce(|a, b| {
            if b.utilisation() > a.utilisation() {
                b
            } else {
                a
            }
        });
        most.or_else(|| {
            self.rows
                .iter()
                .reduce(|a, b| if b.value.abs() > a.value.abs() { b } else { a })
        })
    }

    /// Adds the stresses of another structure.
    pub(super) fn extend(&mut self, other: GirderStresses) {
        self.rows.extend(other.rows);
        self.lacks.extend(other.lacks);
    }

    /// The member `stresses` of the summary of case `number`, counted from 1; `None` without stresses.
    #[must_use]
    pub fn json(&self, scene: &Scene, number: usize) -> Option<Value> {
        let named = |names: [&str; 3], values: [f64; 3]| -> Map<String, Value> {
            names
                .into_iter()
                .zip(values)
                .map(|(name, value)| (name.to_owned(), json!(value + 0.0)))
                .collect()
        };
        let one = |found: &GirderStress| {
            let mut out = json!({
                "case": number,
                "rail": scene.rails[found.rail].name,
                "span": found.span,
                "section": found.section,
                "quantity": "direct stress",
                "value": found.value + 0.0,
                "fibre": found.fibre,
                "parts": named(["normal", "vertical", "lateral"], found.parts),
                "forces": named(["normal", "moment", "lateral moment"], found.forces),
                "lateral_section": scene.lateral_section.map(LateralSection::word),
                "sampled": true,
                "x": found.x + 0.0,
                "side": side_word(found.side),
                "time": found.time,
            });
            if let (Some(strength), Some(utilisation)) = (found.yield_strength, found.utilisation())
            {
                out["strength"] = json!(strength);
                out["utilisation"] = json!(utilisation);
                out["within"] = json!(utilisation <= 1.0);
            }
            out
        };
        (!self.rows.is_empty()).then(|| self.rows.iter().map(one).collect())
    }

    /// What is left out where the scene asks for stresses.
    #[must_use]
    pub fn notes(&self, scene: &Scene) -> Vec<String> {
        if scene.lateral_section.is_none() {
            return Vec::new();
        }
        let tables = scene.rails.iter().enumerate().filter_map(|(index, rail)| {
            let structure = &scene.structures[rail.structure];
            let is_tables = matches!(structure.origin, Origin::Tables { .. });
            is_tables.then(|| {
                (
                    index,
                    format!("structure {} is given by tables", structure.name),
                )
            })
        });
        let lacks: Vec<(String, String)> = tables
            .chain(self.lacks.iter().cloned())
            .map(|(rail, why)| (scene.rails[rail].name.clone(), why))
            .collect();
        let lacking = by_reason("no direct stress", &lacks);
        let mut out: Vec<String> = lacking.iter().map(ToString::to_string).collect();
        if scene.practice.is_none() {
            out.push(
                "the run is not compared with codes, because `practice` has only `lateral_section` and the body that \
                 runs on two rails is not unique; specify it by `practice.crane`"
                    .to_owned(),
            );
        }
        out
    }
}

impl Refinement<'_> {
    /// The largest stresses of the sections of a structure; `spans` are its extremes.
    pub fn stresses(&self, spans: &[SpanValue]) -> GirderStresses {
        let stressed = &self.girders.sections.stressed;
        let found: Vec<GirderStress> = (0..stressed.all.len())
            .filter_map(|section| self.of_section(section, spans))
            .collect();
        let most = found
            .iter()
            .fold(0.0_f64, |most, row| most.max(row.value.abs()));
        let rows = found
            .into_iter()
            .filter(|row| row.value.abs() > ZERO * most)
            .collect();
        GirderStresses {
            rows,
            lacks: stressed.lacks.clone(),
        }
    }

    fn of_section(&self, section: usize, spans: &[SpanValue]) -> Option<GirderStress> {
        let (girders, scan) = (self.girders, self.scan);
        let all = girders.sections;
        let is_own = |member: usize| all.stressed.of_member[member] == Some(section);
        let mut found: Option<GirderValue> = None;
        for value in spans
            .iter()
            .filter(|value| DIRECT.contains(&value.quantity))
        {
            if value
                .found
                .section
                .is_some_and(|(member, _)| is_own(member))
            {
                let signed = self
                    .stress_at(&value.found)
                    .map_or(0.0, |(worst, _)| worst.value().abs());
                offer(
                    &mut found,
                    Some(GirderValue {
                        signed,
                        ..value.found
                    }),
                );
            }
        }
        for (own, passages) in all
            .sections
            .iter()
            .zip(&scan.passages)
            .filter(|(own, _)| is_own(own.member))
        {
            for passage in passages {
                offer(
                    &mut found,
                    Some(GirderValue {
                        signed: self.stress_size(own.member, &passage.values),
                        position: passage.position,
                        x: all.points[own.point].x,
                        section: Some((own.member, own.place)),
                        own: Some((passage.load, passage.is_behind)),
                        is_after: Some(passage.is_after),
                        side: own.side,
                    }),
                );
            }
        }
        let loads = scan.stresses.wheels.len() / (2 * all.stressed.all.len());
        let tracks: Vec<(usize, bool)> = (0..loads)
            .flat_map(|load| [(load, false), (load, true)])
            .collect();
        let own: Vec<usize> = (0..all.sections.len())
            .filter(|at| is_own(all.sections[*at].member))
            .collect();
        let of_track =
            |track: &(usize, bool)| scan.stresses.wheels[scan.stresses.wheel(*track, section)];
        let rows = own
            .iter()
            .map(|at| scan.stresses.sections[*at])
            .chain(tracks.iter().map(of_track));
        let known = found.map_or(0.0, |found| found.signed);
        let least = (1.0 - NEAR) * rows.map(|row| row.size).fold(known, f64::max);
        for at in own {
            let row = scan.stresses.sections[at];
            if row.size >= least && row.size > 0.0 {
                offer(&mut found, Some(self.section_in_time(at, row.row)));
            }
        }
        for track in tracks {
            let row = of_track(&track);
            if row.size >= least && row.size > 0.0 {
                offer(&mut found, self.wheel_in_time(section, track, row.row));
            }
        }
        let mut found = found.filter(|found| found.signed > 0.0)?;
        if found.own.is_none() && !girders.distributed.is_empty() {
            found = self.stress_along(section, found);
        }
        self.result(section, &found)
    }

    /// The stress of the forces of a section of a member, without what is only rounding, and these forces.
    fn stress(&self, member: usize, values: &Quantities) -> Option<(FibreStress, [f64; 3])> {
        let (_, fibres) = self.girders.sections.stressed.of(member)?;
        let forces = DIRECT.map(|k| self.without_rounding(k, values[k]));
        Some((fibres.worst(forces)?, forces))
    }

    fn stress_size(&self, member: usize, values: &Quantities) -> f64 {
        self.stress(member, values)
            .map_or(0.0, |(worst, _)| worst.value().abs())
    }

    fn stress_at(&self, found: &GirderValue) -> Option<(FibreStress, [f64; 3])> {
        let (member, place) = found.section?;
        self.stress(
            member,
            &self
                .girders
                .forces_in(member, place, &self.state_of(found), found.own),
        )
    }

    /// The largest stress of a section of a member in the intervals beside a row.
    fn section_in_time(&self, at: usize, row: usize) -> GirderValue {
        let all = self.girders.sections;
        let section = &all.sections[at];
        let (signed, position) = self.near_in_time(row as f64, 1, &mut |position| {
            self.stress_size(section.member, &self.girders.forces(section, position))
        });
        GirderValue {
            signed,
            position,
            x: all.points[section.point].x,
            section: Some((section.member, section.place)),
            own: None,
            is_after: None,
            side: section.side,
        }
    }

    /// The largest stress beside a load, on members of one section, in the intervals beside a row.
    fn wheel_in_time(&self, section: usize, own: (usize, bool), row: usize) -> Option<GirderValue> {
        let girders = self.girders;
        let stressed = &girders.sections.stressed;
        let at = |position: f64| {
            let state = girders.states.at(position);
            let mut passed = PassedLoads::default();
            let on = |member: usize| {
                girders.members.load(member, &state.loads, &mut passed);
                let (_, place) = passed.places().find(|(load, _)| *load == own.0)?;
                Some((
                    self.stress_size(
                        member,
                        &girders.sum(member, place, &state, &passed, Some(own)),
                    ),
                    member,
                    place,
                ))
            };
            let members =
                (0..stressed.of_member.len()).filter(|m| stressed.of_member[*m] == Some(section));
            members
                .filter_map(on)
                .reduce(|a, b| if b.0 > a.0 { b } else { a })
        };
        let (signed, position) = self.near_in_time(row as f64, 1, &mut |position| {
            at(position).map_or(0.0, |found| found.0)
        });
        let (_, member, place) = at(position)?;
        let x = girders.members.coordinate(member, place);
        let side = SectionSide::At;
        Some(GirderValue {
            signed,
            position,
            x,
            section: Some((member, place)),
            own: Some(own),
            is_after: None,
            side,
        })
    }

    /// Refines a stress at a section without a wheel along its member and over time in turn.
    fn stress_along(&self, section: usize, from: GirderValue) -> GirderValue {
        let girders = self.girders;
        let outline = &girders.sections.rails[girders.sections.stressed.all[section].rail];
        let Some((member, ends)) = from
            .section
            .and_then(|(member, _)| Some((member, girders.members.members().nth(member)?.x)))
        else {
            return from;
        };
        let [before, after] = outline.neighbours(from.x);
        let near = [before.max(ends[0]), after.min(ends[1])];
        let size = |x: f64, position: f64| {
            let place = girders.members.place(member, x);
            self.stress_size(
                member,
                &girders.forces_in(member, place, &girders.states.at(position), None),
            )
        };
        let mut found = GirderValue {
            is_after: None,
            ..from
        };
        for _ in 0..ROUNDS {
            let known = (size(found.x, found.position), found.x);
            let (signed, x) = largest(near, known, self.search_end(from.signed), &mut |x| {
                size(x, found.position)
            });
            if signed <= (1.0 + 1e-3 * self.accuracy) * found.signed {
                break;
            }
            let (later, position) =
                self.near_in_time(found.position, 1, &mut |position| size(x, position));
            let section = Some((member, girders.members.place(member, x)));
            found = GirderValue {
                signed,
                x,
                section,
                side: SectionSide::At,
                ..found
            };
            if later > signed {
                found = GirderValue {
                    signed: later,
                    position,
                    ..found
                };
            }
        }
        found
    }

    fn result(&self, section: usize, found: &GirderValue) -> Option<GirderStress> {
        let girders = self.girders;
        let own = &girders.sections.stressed.all[section];
        let rail = &girders.sections.rails[own.rail];
        let (worst, forces) = self.stress_at(found)?;
        let side = match found.own {
            Some((load, is_behind)) if found.side == SectionSide::At => {
                let across = GirderValue {
                    own: Some((load, !is_behind)),
                    ..*found
                };
                let other = self
                    .stress_at(&across)
                    .map_or(0.0, |(worst, _)| worst.value().abs());
                match is_behind {
                    _ if other >= (1.0 - ROUNDING) * worst.value().abs() => SectionSide::At,
                    true => SectionSide::Behind,
                    false => SectionSide::Before,
                }
            }
            _ => found.side,
        };
        Some(GirderStress {
            rail: rail.scene_rail,
            span: rail.span(found.x, side),
            section: own.fibres.name.clone(),
            fibre: worst.fibre,
            value: worst.value(),
            parts: worst.parts,
            forces,
            yield_strength: own.fibres.yield_strength,
            x: found.x + 0.0,
            side,
            time: girders.states.at(found.position).time,
        })
    }
}
