//! Extremes of the reactions of supports over a run.

use fea::{Dof, Effect};
use formats::scene::columns::Direction;
use formats::scene::{Origin, Scene};
use nalgebra::DMatrix;
use serde_json::{Value, json};
use splines::InfluenceLines;
use trains::MemberForces;

use crate::pieces::{Functional, Functionals, LoadPieces, SIGNS};
use crate::response::{dead_load, inertia, relative_direction};
use foundations::{BuiltFoundation, SolvedModel};

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
}

impl GirderReaction {
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
    direction: Dof,
    relative: Option<Direction>,
    dead: f64,
}

/// The reactions of a structure as functions of the loads on its rails.
pub(super) struct Reactions {
    all: Vec<Reaction>,
    lines: InfluenceLines,
    /// Each reaction as the sum of the supports and springs of its direction.
    functionals: Vec<Functional>,
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
        let (mut all, mut functionals, mut effects) = (Vec::new(), Vec::new(), Vec::new());
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
                        functionals.push(Functional {
                            terms: parts.map(|part| (part, 1.0)).collect(),
                            inertia: Vec::new(),
                        });
                        all.push(Reaction {
                            structure: s,
                            support: format!("{}.{}", structure.name, ground.name),
                            direction,
                            relative: relative_direction(model, &solved.rails, direction),
                            dead: 0.0,
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
        for (reaction, functional) in all.iter_mut().zip(&mut functionals) {
            let parts = || functional.terms.iter().map(|(part, _)| *part);
            reaction.dead = parts().map(|part| weight[part]).sum();
            let per_dof = |dof| parts().map(|part| 0.0 - moved[(part, dof)]).sum();
            functional.inertia = (0..moved.ncols()).map(per_dof).collect();
        }
        Ok(Reactions {
            all,
            lines,
            functionals,
        })
    }

    /// Places between which the influence lines are cubics.
    pub fn breaks(&self) -> Vec<(usize, f64)> {
        self.lines.breaks()
    }

    /// The largest and smallest reactions over a run.
    pub fn extremes(
        &self,
        pieces: &LoadPieces<'_>,
        is_stopped: &dyn Fn() -> bool,
    ) -> Vec<GirderReaction> {
        let found = Functionals::new(&self.lines, &self.functionals, pieces).peaks(is_stopped);
        let is_moment = |reaction: &Reaction| usize::from(reaction.direction >= Dof::Rx);
        let mut sizes = [0.0_f64; 2];
        for (reaction, peaks) in self.all.iter().zip(&found) {
            let size = &mut sizes[is_moment(reaction)];
            for (peak, sign) in peaks.iter().zip(SIGNS) {
                *size = size.max((peak.signed + sign * reaction.dead).abs());
            }
        }
        let mut out = Vec::new();
        for (reaction, peaks) in self.all.iter().zip(&found) {
            let zero = ROUNDING * sizes[is_moment(reaction)];
            for (peak, sign) in peaks.iter().zip(SIGNS) {
                let value = sign * peak.signed + reaction.dead;
                out.push(GirderReaction {
                    structure: reaction.structure,
                    support: reaction.support.clone(),
                    direction: reaction.direction,
                    relative: reaction.relative,
                    is_max: sign > 0.0,
                    value: if value.abs() <= zero {
                        0.0
                    } else {
                        value + 0.0
                    },
                    dead: reaction.dead + 0.0,
                    time: pieces.time(peak.at),
                });
            }
        }
        out
    }
}
