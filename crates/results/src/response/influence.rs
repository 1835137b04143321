//! Influence lines of the columns of a structure: reactions, internal forces and stresses as linear functions of
//! wheel forces, accelerations and dead load.
//!
//! A column is a weighted sum of effects of the frame: a reaction may be the sum of several supports and springs at a
//! point, and a stress is the sum of internal forces divided by section properties. The effects of unit wheel forces
//! are exact influence lines of the FE model. By d'Alembert's principle the inertia forces of the structure are loads
//! like those of the wheels. Under wheel forces F, accelerations q'' of the degrees of freedom and gravity g the
//! effects are
//!
//! ```text
//! E = A F - S q'' + E_0
//! ```
//!
//! 1. Effects and their columns are listed from the spec ([`ColumnInfluence::new`]).
//! 2. A: influence lines of the effects, evaluated at the wheels at every output time ([`ColumnInfluence::at`]).
//! 3. S: effects of the inertia forces M phi_k of each degree of freedom k, by natural modes
//!    ([`fea::FactoredFrame::effects_of_modes`]) or by rigid parts ([`part_inertia`]). E_0: -g times the effects of a unit
//!    acceleration upwards of the whole mass.
//! 4. Columns that are zero under every load, weight and inertia force are dropped ([`ColumnInfluence::nonzero`]).

use std::sync::Arc;

use fea::{CrossSection, Dof, Effect, FactoredFrame, Model};
use nalgebra::{DMatrix, Vector3};
use splines::{Axis, InfluenceLines, Probe};

use super::part_inertia::part_inertia;
use crate::loads::WheelLoad;
use crate::pieces::Functional;
use formats::grid::effects::COMPONENTS;
use formats::scene::columns;
use formats::scene::columns::{Column, Direction, Kind};
use formats::spec::{Spec, StressPoint};
use formats::units::Dimension;
use foundations::{BuiltFoundation, MotionBasis, SolvedModel};

/// Fraction of the largest value of the same dimension up to which a column is treated as rounding error.
const ROUNDING: f64 = 1e-12;

/// Reactions, internal forces and stresses of a structure as linear functions of its loads:
///
/// E = A F - S q'' + E_0
///
/// A: influence lines of the exact structure; F: wheel forces; q'': accelerations of the degrees of freedom of the
/// foundation; S: effects of the inertia forces of their motions; E_0: effects of the dead load. Damping forces
/// inside the structure are included: the sum of all reactions equals the sum of the wheel forces minus the rate of
/// change of the momentum of the structure.
pub struct ColumnInfluence {
    columns: Vec<Column>,
    effects: InfluenceLines,
    /// The effects that `effects` has, in the FE model.
    sources: Vec<Effect>,
    /// Column and factor of each effect. The springs and supports of one degree of freedom of a point form one
    /// column, and a stress is a sum of internal forces.
    terms: Vec<ColumnTerm>,
    inertia: DMatrix<f64>,
    dead: Vec<f64>,
}

/// An effect as a term of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ColumnTerm {
    /// Index of the column.
    pub column: usize,
    /// Factor of the effect in the column.
    pub weight: f64,
}

impl ColumnInfluence {
    /// The influence lines of those columns of structure `name` for which `wanted` (kind, name) is true; `None` if
    /// there are none. `built` has the degrees of freedom; `gravity` is the acceleration of gravity of the scene.
    ///
    /// # Errors
    /// The errors of the frame solver.
    pub fn new(
        name: &str,
        spec: &Spec,
        solved: &SolvedModel,
        built: &BuiltFoundation,
        gravity: f64,
        wanted: &dyn Fn(Kind, &str) -> bool,
    ) -> Result<Option<ColumnInfluence>, fea::Error> {
        let (model, rails) = (&solved.model, &solved.rails);
        let [reactions, sections] = columns::names(name, spec);
        let stresses = columns::stresses(name, spec);
        let lists = [
            (Kind::Reaction, &reactions),
            (Kind::Section, &sections),
            (Kind::Stress, &stresses),
        ];
        if !lists
            .iter()
            .any(|(kind, names)| names.iter().any(|own| wanted(*kind, own)))
        {
            return Ok(None);
        }
        let frame = FactoredFrame::new(model, rails)?;
        let mut list = ColumnList::default();
        list.add_reactions(name, spec, (model, rails), &frame, wanted);
        list.add_internal_forces(name, spec, wanted);
        list.add_stresses(name, spec, model, wanted);
        let ColumnList {
            columns,
            effects,
            terms,
        } = list;
        let out = ColumnInfluence::of(&frame, solved, built, gravity, columns, &effects, terms)?;
        let nonzero = out.nonzero();
        if !nonzero.contains(&true) {
            return Ok(None);
        }
        Ok(Some(out.only(&nonzero, model, &frame, &effects)?))
    }

    /// The influence lines of `columns`. Each column is the weighted sum of the `effects` whose entry in `terms`
    /// refers to it.
    ///
    /// # Errors
    /// The errors of the frame solver.
    fn of(
        frame: &FactoredFrame,
        solved: &SolvedModel,
        built: &BuiltFoundation,
        gravity: f64,
        columns: Vec<Column>,
        effects: &[Effect],
        terms: Vec<ColumnTerm>,
    ) -> Result<ColumnInfluence, fea::Error> {
        let dead = dead_load(frame, &solved.model, gravity, effects)?;
        let lines = frame.influence_lines(&solved.model, effects)?;
        let mut out = ColumnInfluence {
            inertia: DMatrix::zeros(columns.len(), 0),
            dead: vec![0.0; columns.len()],
            columns,
            effects: lines,
            sources: effects.to_vec(),
            terms,
        };
        for (e, &ColumnTerm { column, weight }) in out.terms.iter().enumerate() {
            out.dead[column] += weight * dead[e];
        }
        out.set_motion(built.basis.as_ref(), solved)?;
        Ok(out)
    }

    /// Computes the effects of the inertia forces of the motions `basis` of the structure, in place of those of other
    /// motions.
    ///
    /// # Errors
    /// The errors of the frame solver.
    pub fn set_motion(
        &mut self,
        basis: Option<&MotionBasis>,
        solved: &SolvedModel,
    ) -> Result<(), fea::Error> {
        let effects = inertia(&self.sources, basis, solved)?;
        self.inertia = DMatrix::zeros(self.columns.len(), effects.ncols());
        for (e, &ColumnTerm { column, weight }) in self.terms.iter().enumerate() {
            for k in 0..effects.ncols() {
                self.inertia[(column, k)] += weight * effects[(e, k)];
            }
        }
        Ok(())
    }

    /// Minus the value of a column per unit acceleration of each degree of freedom.
    #[must_use]
    pub fn per_acceleration(&self, column: usize) -> Vec<f64> {
        self.inertia.row(column).iter().copied().collect()
    }

    /// The columns without dead load as sums of influence lines and of inertia.
    pub(crate) fn functionals(&self) -> Vec<Functional> {
        let of = |column: usize| {
            let terms = self
                .terms
                .iter()
                .enumerate()
                .filter(|(_, term)| term.column == column);
            Functional {
                terms: terms.map(|(effect, term)| (effect, term.weight)).collect(),
                inertia: self
                    .inertia
                    .row(column)
                    .iter()
                    .map(|per| 0.0 - per)
                    .collect(),
            }
        };
        (0..self.columns.len()).map(of).collect()
    }

    /// The influence lines of the effects of which columns are sums.
    pub(crate) fn effects(&self) -> &InfluenceLines {
        &self.effects
    }

    /// For each column, whether any load, weight or inertia force makes it nonzero beyond rounding errors.
    ///
    /// Loads are applied at four positions of every rail element: an influence line is a cubic within an element and
    /// is therefore zero throughout if it is zero at four positions.
    fn nonzero(&self) -> Vec<bool> {
        let n = self.columns.len();
        let mut units = vec![0.0_f64; n];
        for element in self.rails().elements() {
            for fraction in [0.0, 0.3, 0.6, 1.0] {
                let x = element.x[0] + fraction * (element.x[1] - element.x[0]);
                for axis in Axis::ALL {
                    let unit = self
                        .unit(Probe {
                            rail: element.rail,
                            x,
                            axis,
                        })
                        .unwrap_or_default();
                    units
                        .iter_mut()
                        .zip(unit)
                        .for_each(|(most, value)| *most = most.max(value.abs()));
                }
            }
        }
        let dead: Vec<f64> = self.dead.iter().map(|value| value.abs()).collect();
        let inertia = (0..n).map(|column| {
            self.inertia
                .row(column)
                .iter()
                .fold(0.0_f64, |m, s| m.max(s.abs()))
        });
        let mut nonzero = vec![false; n];
        for sizes in [units, dead, inertia.collect()] {
            let most = |dimension: Dimension| {
                let own = self
                    .columns
                    .iter()
                    .zip(&sizes)
                    .filter(|(column, _)| column.dimension == dimension);
                own.fold(0.0_f64, |most, (_, size)| most.max(*size))
            };
            let kinds = [Dimension::FORCE, Dimension::MOMENT, Dimension::STRESS];
            let largest = kinds.map(most);
            for ((nonzero, size), column) in nonzero.iter_mut().zip(&sizes).zip(&self.columns) {
                let own = kinds.iter().position(|kind| *kind == column.dimension);
                *nonzero |= own.is_some_and(|own| *size > ROUNDING * largest[own]);
            }
        }
        nonzero
    }

    /// The influence lines of only those columns for which `kept` is true.
    fn only(
        self,
        kept: &[bool],
        model: &Model,
        frame: &FactoredFrame,
        effects: &[Effect],
    ) -> Result<ColumnInfluence, fea::Error> {
        if !kept.contains(&false) {
            return Ok(self);
        }
        let number = |column: usize| kept[..column].iter().filter(|kept| **kept).count();
        let rows: Vec<usize> = (0..kept.len()).filter(|column| kept[*column]).collect();
        let is_kept = |(_, term): &(&Effect, &ColumnTerm)| kept[term.column];
        let renumbered = |term: &ColumnTerm| ColumnTerm {
            column: number(term.column),
            ..*term
        };
        let (effects, terms): (Vec<Effect>, Vec<ColumnTerm>) = effects
            .iter()
            .zip(&self.terms)
            .filter(is_kept)
            .map(|(e, term)| (*e, renumbered(term)))
            .unzip();
        Ok(ColumnInfluence {
            effects: frame.influence_lines(model, &effects)?,
            sources: effects,
            terms,
            inertia: self.inertia.select_rows(&rows),
            dead: rows.iter().map(|row| self.dead[*row]).collect(),
            columns: rows.iter().map(|row| self.columns[*row].clone()).collect(),
        })
    }

    /// The columns.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Number of degrees of freedom of the foundation.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.inertia.ncols()
    }

    /// Value of each column under the dead load of the structure.
    #[must_use]
    pub fn dead_load(&self) -> &[f64] {
        &self.dead
    }

    /// The rails, with their elements.
    #[must_use]
    pub fn rails(&self) -> &Arc<splines::Rails> {
        self.effects.rails()
    }

    /// Writes the value of every column under `loads` and `acceleration` into `out`, without dead load. Returns
    /// whether the structure resists all of the loads; loads that it does not resist are neglected.
    pub fn at<'l>(
        &self,
        loads: impl Iterator<Item = &'l WheelLoad>,
        acceleration: &[f64],
        out: &mut [f64],
    ) -> bool {
        out.fill(0.0);
        let mut is_complete = true;
        let mut unit = vec![0.0; self.effects.len()];
        for load in loads {
            for (axis, force) in Axis::ALL.into_iter().zip(load.force) {
                if force == 0.0 {
                    continue;
                }
                if self
                    .effects
                    .fill(
                        Probe {
                            rail: load.rail,
                            x: load.x,
                            axis,
                        },
                        &mut unit,
                    )
                    .is_err()
                {
                    is_complete = false;
                    continue;
                }
                for (value, term) in unit.iter().zip(&self.terms) {
                    out[term.column] += force * term.weight * value;
                }
            }
        }
        for (k, a) in acceleration.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            for (out, effect) in out.iter_mut().zip(self.inertia.column(k)) {
                *out -= effect * a;
            }
        }
        is_complete
    }

    /// The value of every column under a unit load; `None` where the structure does not resist the load.
    #[must_use]
    pub fn unit(&self, at: Probe) -> Option<Vec<f64>> {
        let mut unit = vec![0.0; self.effects.len()];
        self.effects.fill(at, &mut unit).ok()?;
        let mut out = vec![0.0; self.columns.len()];
        unit.iter()
            .zip(&self.terms)
            .for_each(|(value, term)| out[term.column] += term.weight * value);
        Some(out)
    }
}

/// Columns with the effects of which they are sums, in the order of the spec.
#[derive(Default)]
struct ColumnList {
    columns: Vec<Column>,
    effects: Vec<Effect>,
    /// One entry per effect.
    terms: Vec<ColumnTerm>,
}

impl ColumnList {
    /// Adds a column of several effects of weight 1.
    fn add(&mut self, column: Column, effects: Vec<Effect>) {
        let index = self.columns.len();
        self.terms.extend(effects.iter().map(|_| ColumnTerm {
            column: index,
            weight: 1.0,
        }));
        self.effects.extend(effects);
        self.columns.push(column);
    }

    /// Adds the wanted reactions: for each degree of freedom of a point on the ground, the sum of its supports and
    /// springs.
    fn add_reactions(
        &mut self,
        structure: &str,
        spec: &Spec,
        (model, rails): (&Model, &[fea::Rail]),
        frame: &FactoredFrame,
        wanted: &dyn Fn(Kind, &str) -> bool,
    ) {
        let restraints = frame.restraints(model);
        for ground in spec.supported_points(model) {
            for &dof in &ground.dofs {
                let name = format!("{structure}.{}.{}", ground.name, spec.dof_word(dof));
                let is_here = |one: &&fea::Restraint| one.point == ground.point && one.dof == dof;
                let all: Vec<Effect> = restraints
                    .iter()
                    .filter(is_here)
                    .copied()
                    .map(Effect::Reaction)
                    .collect();
                if wanted(Kind::Reaction, &name) && !all.is_empty() {
                    let dimension = dimension(dof >= Dof::Rx);
                    let direction = relative_direction(model, rails, dof);
                    self.add(
                        Column {
                            name,
                            dimension,
                            kind: Kind::Reaction,
                            direction,
                        },
                        all,
                    );
                }
            }
        }
    }

    /// Adds the wanted components of the internal force at each section that the spec names.
    fn add_internal_forces(
        &mut self,
        structure: &str,
        spec: &Spec,
        wanted: &dyn Fn(Kind, &str) -> bool,
    ) {
        for cut in &spec.effects {
            for (index, (word, component)) in COMPONENTS.into_iter().enumerate() {
                let name = format!("{structure}.{}.{word}", cut.name);
                if wanted(Kind::Section, &name) {
                    let dimension = dimension(index >= 3);
                    let column = Column {
                        name,
                        dimension,
                        kind: Kind::Section,
                        direction: None,
                    };
                    self.add(
                        column,
                        vec![Effect::InternalForce {
                            member: cut.member,
                            place: cut.place,
                            component,
                        }],
                    );
                }
            }
        }
    }

    /// Adds the wanted stresses at points of those sections, as weighted sums of internal forces.
    fn add_stresses(
        &mut self,
        structure: &str,
        spec: &Spec,
        model: &Model,
        wanted: &dyn Fn(Kind, &str) -> bool,
    ) {
        for cut in &spec.effects {
            let section = model
                .members
                .get(cut.member)
                .and_then(|member| model.sections.get(member.section));
            for point in &cut.points {
                let name = format!("{structure}.{}.{}", cut.name, point.name);
                let Some(section) = section.filter(|_| wanted(Kind::Stress, &name)) else {
                    continue;
                };
                for ((_, component), weight) in
                    COMPONENTS.into_iter().zip(stress_weights(section, point))
                {
                    if weight != 0.0 {
                        self.terms.push(ColumnTerm {
                            column: self.columns.len(),
                            weight,
                        });
                        self.effects.push(Effect::InternalForce {
                            member: cut.member,
                            place: cut.place,
                            component,
                        });
                    }
                }
                let dimension = Dimension::STRESS;
                self.columns.push(Column {
                    name,
                    dimension,
                    kind: Kind::Stress,
                    direction: None,
                });
            }
        }
    }
}

/// Effects of the weight of a structure under `gravity`.
///
/// # Errors
/// The errors of the frame solver.
pub(crate) fn dead_load(
    frame: &FactoredFrame,
    model: &Model,
    gravity: f64,
    effects: &[Effect],
) -> Result<Vec<f64>, fea::Error> {
    let down = Vector3::from(model.up).normalize() * -gravity;
    frame.effects_of_weight(model, &frame.weight(model, down.into()), effects)
}

/// Effects of the inertia force at unit acceleration of each degree of freedom: effects x degrees of freedom.
///
/// # Errors
/// The errors of the frame solver.
pub(crate) fn inertia(
    effects: &[Effect],
    basis: Option<&MotionBasis>,
    solved: &SolvedModel,
) -> Result<DMatrix<f64>, fea::Error> {
    match basis {
        None => Ok(DMatrix::zeros(effects.len(), 0)),
        Some(MotionBasis::Modes { refined, inertia }) => {
            let modes = &refined.modes.modes;
            if effects.is_empty() {
                return Ok(DMatrix::zeros(0, modes.len()));
            }
            let own: Vec<Effect> = effects
                .iter()
                .map(|effect| refined.effect(*effect))
                .collect();
            let inertia =
                inertia.get_or_init(|| refined.frame.inertia_of_modes(&refined.model, modes));
            refined
                .frame
                .effects_of_modes(&refined.model, &own, modes, inertia)
        }
        Some(MotionBasis::Parts(parts)) => match &solved.girder {
            Some(girder) => part_inertia(girder, parts, effects),
            None => Ok(DMatrix::zeros(effects.len(), parts.basis.ncols())),
        },
    }
}

/// Normal stress at a point per unit of each component of the internal force: N/A + My z/Iy - Mz y/Iz, as in
/// [`practice::stress::weights`]; a component for which the section property is 0 causes no stress.
fn stress_weights(section: &CrossSection, point: &StressPoint) -> [f64; 6] {
    let over = |lever: f64, property: f64| {
        if property > 0.0 {
            lever / property
        } else {
            0.0
        }
    };
    [
        over(1.0, section.area),
        0.0,
        0.0,
        0.0,
        over(point.z, section.iy),
        over(0.0 - point.y, section.iz),
    ]
}

/// Dimension of a reaction or internal force.
const fn dimension(is_moment: bool) -> Dimension {
    if is_moment {
        Dimension::MOMENT
    } else {
        Dimension::FORCE
    }
}

/// Direction of a reaction relative to the first rail: vertical or lateral if it is within about 25 degrees of that
/// direction.
pub(crate) fn relative_direction(
    model: &Model,
    rails: &[fea::Rail],
    dof: Dof,
) -> Option<Direction> {
    let k = dof as usize;
    let up = Vector3::from(model.up).normalize();
    let side = Vector3::from(rails.first()?.axis).cross(&up).normalize();
    if k >= 3 {
        None
    } else if up[k].abs() > 0.9 {
        Some(Direction::Vertical)
    } else if side[k].abs() > 0.9 {
        Some(Direction::Lateral)
    } else {
        None
    }
}
