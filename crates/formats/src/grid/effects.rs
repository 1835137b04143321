//! Influence lines of reactions and internal forces, sampled at the stations.

use fea::{Effect, FactoredFrame, Model};
use splines::{Axis, Probe};

pub use crate::spec::COMPONENTS;
use crate::spec::{Cut, CutPlace, Form, Spec};

/// Influence lines of reactions and of internal forces, sampled at the stations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    /// Reactions of the ground.
    pub reactions: Vec<Reaction>,
    /// Internal forces at the named sections.
    pub sections: Vec<SectionForces>,
}

/// Influence lines for each direction of the unit load, with one value per station. Values are dimensionless for
/// forces and lengths for moments.
pub type EffectLines = Vec<(Axis, Vec<f64>)>;

/// A reaction, positive in the positive direction of its global degree of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct Reaction {
    /// Location of the reaction.
    pub at: ReactionPoint,
    /// Keyword of its degree of freedom, such as `uy`.
    pub dof: String,
    /// Index of the spring that exerts it; `None` if it is the reaction of a support.
    pub spring: Option<usize>,
    /// Its influence lines.
    pub lines: EffectLines,
}

/// A supported location in the terms of the spec.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReactionPoint {
    /// Coordinate along a girder.
    Along(f64),
    /// Index of a point.
    Point(usize),
}

/// Internal forces at a section.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionForces {
    /// Its name.
    pub name: String,
    /// Location of the section.
    pub at: CutPlace,
    /// Influence lines of the components N, Vy, Vz, Mx, My, Mz in the member's local axes.
    pub lines: [EffectLines; 6],
}

impl Effects {
    /// Influence lines at `stations` (index of the rail, coordinate) for unit loads along `axes`.
    ///
    /// `model` and `frame` are those of [`Spec::model`]. All effects are solved at once: rows are the reactions, then
    /// the six components of each section; columns are the stations for each of `axes` in turn.
    ///
    /// # Errors
    /// A station for which the frame has no solution.
    pub fn of(
        spec: &Spec,
        model: &Model,
        frame: &FactoredFrame,
        stations: &[(usize, f64)],
        axes: &[Axis],
    ) -> Result<Effects, fea::Error> {
        let holds = frame.restraints(model);
        let mut effects: Vec<Effect> = holds.iter().copied().map(Effect::Reaction).collect();
        for &Cut { member, place, .. } in &spec.effects {
            let force = |(_, component)| Effect::InternalForce {
                member,
                place,
                component,
            };
            effects.extend(COMPONENTS.map(force));
        }
        let load = |axis: Axis| {
            stations
                .iter()
                .map(move |&(rail, x)| Probe { rail, x, axis })
        };
        let probes: Vec<Probe> = axes.iter().copied().flat_map(load).collect();
        let value = frame.effects(model, &effects, &probes)?;
        let n = stations.len();
        let lines = |row: usize| -> EffectLines {
            let line = |k: usize| value.row(row).columns(k * n, n).iter().copied().collect();
            axes.iter()
                .enumerate()
                .map(|(k, &axis)| (axis, line(k)))
                .collect()
        };
        let ground = |point: usize| match &spec.form {
            Form::Girder(_) => {
                ReactionPoint::Along(model.points.get(point).map_or(0.0, |place| place[0]))
            }
            Form::Frame(_) => ReactionPoint::Point(point),
        };
        let reactions = holds.iter().enumerate().map(|(row, hold)| Reaction {
            at: ground(hold.point),
            dof: hold.dof.to_string(),
            spring: hold.spring,
            lines: lines(row),
        });
        let sections = spec
            .effects
            .iter()
            .enumerate()
            .map(|(index, cut)| SectionForces {
                name: cut.name.clone(),
                at: cut.place_in_spec,
                lines: std::array::from_fn(|k| lines(holds.len() + 6 * index + k)),
            });
        Ok(Effects {
            reactions: reactions.collect(),
            sections: sections.collect(),
        })
    }
}
