//! Columns of reactions, internal forces and stresses, identified by name.

use super::values::scene::Scene;
use super::values::structure::Origin;
use crate::grid::effects::COMPONENTS;
use crate::spec::Spec;
use crate::units::Dimension;

/// Number of columns of one kind up to which all of them are written by default.
pub const MOST_BY_DEFAULT: usize = 100;

/// A reaction, a component of the internal force at a section, or the stress at a point of a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// `<structure>.<support>.<dof>`, `<structure>.<section>.<component>` or `<structure>.<section>.<point>`.
    pub name: String,
    /// Force or moment.
    pub dimension: Dimension,
    /// Its kind.
    pub kind: Kind,
    /// Whether it is a force of the ground along the structure's `up`, or in the lateral direction of its first rail.
    pub direction: Option<Direction>,
}

/// Kind of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A reaction of the ground.
    Reaction,
    /// A component of the internal force at a section.
    Section,
    /// The direct stress at a point of a section.
    Stress,
}

/// Direction of a force of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along `up`.
    Vertical,
    /// Normal to `up` and to the first rail.
    Lateral,
}

/// Names of all reactions and of all internal forces that are available for a structure with this spec.
#[must_use]
pub fn names(structure: &str, spec: &Spec) -> [Vec<String>; 2] {
    let reactions = spec.model().map_or_else(
        |_| Vec::new(),
        |(model, _)| {
            let grounds = spec.supported_points(&model);
            let all = grounds.iter().flat_map(|ground| {
                ground
                    .dofs
                    .iter()
                    .map(|dof| format!("{structure}.{}.{}", ground.name, spec.dof_word(*dof)))
            });
            all.collect()
        },
    );
    let sections = spec.effects.iter().flat_map(|cut| {
        COMPONENTS
            .iter()
            .map(move |(word, _)| format!("{structure}.{}.{word}", cut.name))
    });
    [reactions, sections.collect()]
}

/// Names of all stresses that are available for a structure with this spec.
#[must_use]
pub fn stresses(structure: &str, spec: &Spec) -> Vec<String> {
    let cuts = spec.effects.iter();
    let points = cuts.flat_map(|cut| cut.points.iter().map(move |point| (&cut.name, &point.name)));
    points
        .map(|(cut, point)| format!("{structure}.{cut}.{point}"))
        .collect()
}

/// Whether the reactions, the internal forces and the stresses of a scene number at most [`MOST_BY_DEFAULT`] each.
#[must_use]
pub fn has_few(scene: &Scene) -> [bool; 3] {
    let mut counts = [0; 3];
    for structure in &scene.structures {
        if let Origin::Spec { spec, .. } = &structure.origin {
            let [reactions, sections] = names(&structure.name, spec);
            counts[0] += reactions.len();
            counts[1] += sections.len();
            counts[2] += stresses(&structure.name, spec).len();
        }
    }
    counts.map(|count| count <= MOST_BY_DEFAULT)
}
