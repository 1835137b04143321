//! Extremes of the reactions of supports, at the rows at which the forces of girders are evaluated and between them.
//!
//! A reaction is the sum over the loads of force times influence line, minus the effects of the inertia of the structure,
//! plus dead load. Every row is evaluated once for all reactions; then the largest and the smallest value of each reaction are
//! refined over time between the rows beside them. Influence lines of reactions have corners at hinges and jumps where a
//! load passes from one body to another: the states just before and just after each such passage count as well.

use fea::{Dof, Effect};
use formats::scene::columns::Direction;
use formats::scene::{Origin, Scene};
use nalgebra::DMatrix;
use serde_json::{Value, json};
use splines::{Axis, InfluenceLines, Probe, RailElement};
use trains::{MemberForces, RailLoad};

use super::instants::LoadState;
use super::peaks::{PeakRows, SIGNS};
use super::refine::Refinement;
use crate::response::{ColumnEnvelope, dead_load, inertia, relative_direction};
use foundations::{BuiltFoundation, SolvedModel};

/// Directions of the components of a load.
const AXES: [Axis; 3] = [Axis::Longitudinal, Axis::Vertical, Axis::Lateral];
/// Fraction of the largest ordinate by which the ordinates or slopes of a line differ at a corner.
const CORNER: f64 = 1e-9;
/// Fraction of the largest reaction of its dimension below which a reaction is rounding.
const ROUNDING: f64 = 1e-12;

/// The largest or smallest value of a reaction of the ground, or of the body that carries the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct GirderReaction {
    /// Index of the structure in the scene.
    pub structure: usize,
    /// Name of the structure and of the supported point, as in the columns of a history.
    pub support: String,
    /// Global direction.
    pub direction: Dof,
    /// The direction relative to the first rail: vertical or lateral; `None` for others and for moments.
    pub relative: Option<Direction>,
    /// Whether it is the largest value; otherwise the smallest.
    pub is_max: bool,
    /// The force or moment on the structure; it includes the dead load where the output of the scene requests it.
    pub value: f64,
    /// The part that is due to dead load.
    pub dead: f64,
    /// Time.
    pub time: f64,
    /// Name of the column that a history may have of it.
    pub column: String,
}

impl GirderReaction {
    /// Takes the extreme of the column of the history where it is larger: steps that are left out of the rows may be output
    /// times.
    pub(crate) fn extend_to(&mut self, columns: &[ColumnEnvelope]) {
        let Some(known) = columns.iter().find(|known| known.column == self.column) else {
            return;
        };
        let (at, sign) = if self.is_max {
            (&known.max, 1.0)
        } else {
            (&known.min, -1.0)
        };
        // equal values but for rounding keep their time
        if sign * (at.value - self.value) > ROUNDING * at.value.abs() {
            (self.value, self.time) = (at.value, at.time);
        }
    }

    /// The reaction as a row of the extremes of case `number`.
    #[must_use]
    pub fn json(&self, number: usize) -> Value {
        json!({
            "case": number,
            "quantity": "reaction",
            "support": self.support,
            "direction": self.direction.to_string(),
            "kind": super::kind_word(self.is_max),
            "value": self.value,
            "dead": self.dead,
            "time": self.time,
        })
    }
}

/// A reaction: a direction of a supported point.
struct Reaction {
    structure: usize,
    support: String,
    column: String,
    direction: Dof,
    relative: Option<Direction>,
    /// The supports and springs of which it is the sum, as rows of the influence lines.
    parts: std::ops::Range<usize>,
    dead: f64,
    /// Reaction per unit acceleration of each degree of freedom, with the sign of inertia.
    inertia: Vec<f64>,
}

/// The reactions of a structure as functions of the loads on its rails.
pub(super) struct Reactions {
    all: Vec<Reaction>,
    lines: InfluenceLines,
    /// Places at which a line has a corner or a jump: rail and coordinate.
    corners: Vec<(usize, f64)>,
}

impl Reactions {
    /// The reactions of structure `s` on the foundation `built`; `dead` is whether dead load counts.
    ///
    /// # Errors
    /// The errors of the frame solver.
    pub fn new(
        (scene, s): (&Scene, usize),
        solved: &SolvedModel,
        built: &BuiltFoundation,
        members: &MemberForces,
        (gravity, dead): (f64, bool),
    ) -> Result<Reactions, fea::Error> {
        let frame = members.structure().frame();
        let model = &solved.model;
        let structure = &scene.structures[s];
        let (mut all, mut effects) = (Vec::new(), Vec::new());
        if let Origin::Spec { spec, .. } = &structure.origin {
            let restraints = frame.restraints(model);
            for ground in spec.supported_points(model) {
                for &direction in &ground.dofs {
                    let first = effects.len();
                    let own = restraints
                        .iter()
                        .filter(|r| r.point == ground.point && r.dof == direction);
                    effects.extend(own.copied().map(Effect::Reaction));
                    let parts = first..effects.len();
                    if !parts.is_empty() {
                        let support = format!("{}.{}", structure.name, ground.name);
                        let relative = relative_direction(model, &solved.rails, direction);
                        let column = format!("{support}.{}", spec.dof_word(direction));
                        let (dead, inertia) = (0.0, Vec::new());
                        let structure = s;
                        all.push(Reaction {
                            structure,
                            support,
                            column,
                            direction,
                            relative,
                            parts,
                            dead,
                            inertia,
                        });
                    }
                }
            }
        }
        let lines = frame.influence_lines(model, &effects)?;
        let weight = match dead {
            true => dead_load(frame, model, gravity, &effects)?,
            false => vec![0.0; effects.len()],
        };
        let moved: DMatrix<f64> = inertia(&effects, built.basis.as_ref(), solved)?;
        for reaction in &mut all {
            reaction.dead = reaction.parts.clone().map(|part| weight[part]).sum();
            let per_dof = |dof| {
                reaction
                    .parts
                    .clone()
                    .map(|part| 0.0 - moved[(part, dof)])
                    .sum()
            };
            reaction.inertia = (0..moved.ncols()).map(per_dof).collect();
        }
        let corners = corners(&lines);
        Ok(Reactions {
            all,
            lines,
            corners,
        })
    }

    /// Writes all reactions in a state into `out`. Loads that the structure does not resist are neglected.
    fn fill(&self, state: &LoadState, ordinates: &mut Vec<f64>, out: &mut [f64]) {
        ordinates.resize(self.lines.len(), 0.0);
        let accelerations = state.accelerations();
        for (out, reaction) in out.iter_mut().zip(&self.all) {
            *out = reaction.apart_from_loads(&accelerations);
        }
        for (probe, force) in forces(&state.loads) {
            if self.lines.fill(probe, ordinates).is_ok() {
                for (out, reaction) in out.iter_mut().zip(&self.all) {
                    *out += force * ordinates[reaction.parts.clone()].iter().sum::<f64>();
                }
            }
        }
    }

    /// One reaction in a state.
    fn value(&self, index: usize, state: &LoadState) -> f64 {
        let reaction = &self.all[index];
        let of = |(probe, force): (Probe, f64)| {
            let parts = reaction
                .parts
                .clone()
                .map(|part| self.lines.value(part, probe));
            force * parts.sum::<Result<f64, _>>().unwrap_or(0.0)
        };
        reaction.apart_from_loads(&state.accelerations())
            + forces(&state.loads).map(of).sum::<f64>()
    }
}

impl Reaction {
    /// The part of dead load and inertia.
    fn apart_from_loads(&self, accelerations: &[f64]) -> f64 {
        self.dead
            + self
                .inertia
                .iter()
                .zip(accelerations)
                .map(|(per, a)| per * a)
                .sum::<f64>()
    }
}

/// The components of loads that are not zero, with their places.
fn forces(loads: &[RailLoad]) -> impl Iterator<Item = (Probe, f64)> + '_ {
    let each = loads.iter().flat_map(|load| {
        AXES.into_iter().zip(load.force).map(|(axis, force)| {
            (
                Probe {
                    rail: load.rail,
                    x: load.x,
                    axis,
                },
                force,
            )
        })
    });
    each.filter(|(_, force)| *force != 0.0)
}

/// Ends of elements of the rails at which the value or the slope of any line differs on both sides.
fn corners(lines: &InfluenceLines) -> Vec<(usize, f64)> {
    let elements = lines.rails().elements();
    let mut ordinates = vec![0.0; lines.len()];
    // Of each element and direction: values and slopes at both ends of the cubics through four ordinates.
    let mut ends: Vec<Vec<EndValues>> = Vec::new();
    let mut sizes = vec![0.0_f64; lines.len()];
    for element in elements {
        let mut own = Vec::new();
        for axis in AXES {
            let four = FRACTIONS.map(|fraction| {
                let probe = Probe {
                    rail: element.rail,
                    x: inside(element, fraction),
                    axis,
                };
                let is_known = lines.fill(probe, &mut ordinates).is_ok();
                if is_known {
                    ordinates.clone()
                } else {
                    vec![0.0; lines.len()]
                }
            });
            for (line, size) in sizes.iter_mut().enumerate() {
                let values = [0, 1, 2, 3].map(|k: usize| four[k][line]);
                *size = values
                    .iter()
                    .fold(*size, |most, value| most.max(value.abs()));
                own.push(end_values(values));
            }
        }
        ends.push(own);
    }
    let mut out: Vec<(usize, f64)> = Vec::new();
    for (a, left) in elements.iter().enumerate() {
        for (b, right) in elements.iter().enumerate() {
            let slack = CORNER * (left.x[1] - left.x[0]).min(right.x[1] - right.x[0]);
            if left.rail != right.rail || (left.x[1] - right.x[0]).abs() > slack {
                continue;
            }
            let lengths = [left, right].map(|element| element.x[1] - element.x[0]);
            let differs = |(k, (left, right)): (usize, (&EndValues, &EndValues))| {
                let allowed = CORNER * sizes[k % sizes.len()];
                let slope = (left[1][1] / lengths[0] - right[0][1] / lengths[1]).abs();
                (left[1][0] - right[0][0]).abs() > allowed
                    || slope * lengths[0].min(lengths[1]) > allowed
            };
            if ends[a].iter().zip(&ends[b]).enumerate().any(differs) {
                out.push((left.rail, left.x[1]));
            }
        }
    }
    out
}

/// Places at which a cubic is read, as fractions of its element.
const FRACTIONS: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];

/// A place of an element; its ends are taken just inside.
fn inside(element: &RailElement, fraction: f64) -> f64 {
    let [a, b] = element.x;
    if fraction == 0.0 {
        a.next_up()
    } else if fraction == 1.0 {
        b.next_down()
    } else {
        a + fraction * (b - a)
    }
}

/// Value and slope at both ends of an element.
type EndValues = [[f64; 2]; 2];

/// Value and slope, per length of the element, at both ends of the cubic through the ordinates at [`FRACTIONS`].
fn end_values([a, b, c, d]: [f64; 4]) -> EndValues {
    [
        [a, 0.5 * (-11.0 * a + 18.0 * b - 9.0 * c + 2.0 * d)],
        [d, 0.5 * (11.0 * d - 18.0 * c + 9.0 * b - 2.0 * a)],
    ]
}

/// A value of a reaction: sign times value, and the time counted in rows.
type Found = (f64, f64);
/// Before any value is known.
const NONE: Found = (f64::NEG_INFINITY, 0.0);

/// Keeps the larger values of both signs.
fn keep_larger(known: &mut [[Found; 2]], values: &[f64], position: f64) {
    for (known, value) in known.iter_mut().zip(values) {
        for (known, sign) in known.iter_mut().zip(SIGNS) {
            if sign * value > known.0 {
                *known = (sign * value, position);
            }
        }
    }
}

impl Refinement<'_> {
    /// The extremes of all reactions.
    pub fn reactions(&self, reactions: &Reactions) -> Vec<GirderReaction> {
        let states = self.girders.states;
        let count = reactions.all.len();
        let mut peaks = PeakRows::new(count);
        let mut passages = vec![[NONE; 2]; count];
        let (mut ordinates, mut values) = (Vec::new(), vec![0.0; count]);
        let mut sizes = [0.0_f64; 2];
        for at in self.girders.scanned_rows() {
            let state = states.at_row(at.row);
            reactions.fill(&state, &mut ordinates, &mut values);
            peaks.add(at, &values);
            for (value, reaction) in values.iter().zip(&reactions.all) {
                let size = &mut sizes[usize::from(reaction.direction >= Dof::Rx)];
                *size = size.max(value.abs());
            }
        }
        for row in self.girders.rows().skip(1) {
            for (position, state) in self.passed_corners(reactions, row - 1) {
                reactions.fill(&state, &mut ordinates, &mut values);
                keep_larger(&mut passages, &values, position);
            }
        }
        let mut out = Vec::new();
        if (self.girders.is_stopped)() {
            return out;
        }
        peaks.finish();
        for (index, peaks) in peaks.found().iter().enumerate() {
            let reaction = &reactions.all[index];
            let size = sizes[usize::from(reaction.direction >= Dof::Rx)];
            let most = peaks
                .iter()
                .fold(0.0_f64, |most, peak| most.max(peak.largest.value.abs()));
            for (kind, peak) in peaks.iter().enumerate() {
                let refined = |row: usize| {
                    self.near_scanned(row, &mut |position| {
                        SIGNS[kind] * reactions.value(index, &states.at(position))
                    })
                };
                let mut found = (
                    peak.highest.value,
                    self.girders.scanned[peak.highest.row] as f64,
                );
                // a value that is only rounding has no crest
                if most > ROUNDING * size {
                    found = refined(peak.highest.row);
                    for vertex in self.lower_peaks(peak, (1, size)) {
                        let other = refined(vertex.row);
                        found = if other.0 > found.0 + ROUNDING * size {
                            other
                        } else {
                            found
                        };
                    }
                    // the crest beside the row of the highest vertex may be lower than its parabola says
                    if peak.largest.value > found.0 + ROUNDING * size {
                        found = refined(peak.largest.row);
                    }
                }
                if passages[index][kind].0 > found.0 + ROUNDING * size {
                    found = passages[index][kind];
                }
                let (signed, position) = found;
                let value = if signed.abs() <= ROUNDING * size {
                    0.0
                } else {
                    SIGNS[kind] * signed
                };
                out.push(GirderReaction {
                    structure: reaction.structure,
                    support: reaction.support.clone(),
                    direction: reaction.direction,
                    relative: reaction.relative,
                    is_max: kind == 0,
                    value: value + 0.0,
                    dead: reaction.dead + 0.0,
                    time: states.at(position).time,
                    column: reaction.column.clone(),
                });
            }
        }
        out
    }

    /// The states just before and just after each passage of a load over a corner between a row and the next, with their
    /// times. Loads that are at other corners at the same time stand on the same side of them.
    fn passed_corners(&self, reactions: &Reactions, row: usize) -> Vec<(f64, LoadState<'_>)> {
        let states = self.girders.states;
        let [a, b] = [row, row + 1].map(|row| states.loads(row));
        let mut out = Vec::new();
        for (load, (from, to)) in a.iter().zip(b).enumerate() {
            let (low, high) = (from.x.min(to.x), from.x.max(to.x));
            let passed = reactions
                .corners
                .iter()
                .filter(|(rail, x)| *rail == from.rail && low <= *x && *x <= high);
            for &(_, x) in passed.filter(|_| low < high) {
                let position = row as f64 + states.passage(row, load, x, [from.x, to.x]);
                for is_after in [false, true] {
                    let mut state = states.limit(position, is_after);
                    let loads = state.loads.to_mut();
                    loads[load].x = x;
                    for (own, (from, to)) in loads.iter_mut().zip(a.iter().zip(b)) {
                        let slack = CORNER * (to.x - from.x).abs();
                        if slack == 0.0 {
                            continue;
                        }
                        let corners = reactions
                            .corners
                            .iter()
                            .filter(|(rail, _)| *rail == own.rail);
                        let Some(&(_, x)) =
                            corners.clone().find(|(_, x)| (own.x - x).abs() <= slack)
                        else {
                            continue;
                        };
                        own.x = if (to.x > from.x) == is_after {
                            x.next_up()
                        } else {
                            x.next_down()
                        };
                    }
                    out.push((position, state));
                }
            }
        }
        out
    }
}
