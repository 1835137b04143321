//! Influence lines of a structure's columns, for wheel forces, inertia and weight.

use std::sync::Arc;

use fea::{Effect, Frame, Freedom, Model, Section};
use nalgebra::{DMatrix, Vector3};
use splines::{Axis, Effects, Probe};

use super::part_inertia::part_inertia;
use super::wheel_load::WheelLoadHistory;
use formats::effect::COMPONENTS;
use formats::scene::columns;
use formats::scene::columns::{Column, Direction, Kind};
use formats::spec::{Spec, StressPoint};
use formats::units::Dimension;
use foundations::{BuiltFoundation, MotionBasis, SolvedModel};

/// Share of the largest of a kind below which a column is rounding.
const ROUNDING: f64 = 1e-12;

/// Reactions and internal forces of a structure as linear functions of what loads it:
///
/// E = A F - S q'' + E_0
///
/// A: influence lines of the exact structure; F: wheel forces; q'': accelerations of the foundation's freedoms; S:
/// effects of the inertia of the model behind them; E_0: of the own weight. Damping forces inside the structure are
/// part of it: over all supports the ground gives what wheels press, less the structure's change of momentum.
pub struct ColumnInfluence {
    columns: Vec<Column>,
    effects: Effects,
    /// What each effect is part of: springs and supports of one freedom of a point are one column, stresses sum forces.
    owner: Vec<Part>,
    inertia: DMatrix<f64>,
    dead: Vec<f64>,
}

/// The part of an effect in a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    /// Index of the column.
    pub column: usize,
    /// What the effect counts there.
    pub weight: f64,
}

impl ColumnInfluence {
    /// Those of the columns that are `wanted` (by kind and name); `None` where none is.
    ///
    /// # Errors
    /// What the frame refuses.
    pub fn new(
        name: &str,
        spec: &Spec,
        solved: &SolvedModel,
        laid: &BuiltFoundation,
        gravity: f64,
        wanted: &dyn Fn(Kind, &str) -> bool,
    ) -> Result<Option<ColumnInfluence>, fea::Error> {
        let (model, rails) = (&solved.model, &solved.rails);
        let [reactions, sections] = columns::names(name, spec);
        let stresses = columns::stresses(name, spec);
        let lists = [(Kind::Reaction, &reactions), (Kind::Section, &sections), (Kind::Stress, &stresses)];
        if !lists.iter().any(|(kind, names)| names.iter().any(|own| wanted(*kind, own))) {
            return Ok(None);
        }
        let frame = Frame::new(model, rails)?;
        let mut columns: Vec<Column> = Vec::new();
        let (mut effects, mut owner) = (Vec::new(), Vec::new());
        let holds = frame.holds(model);
        for ground in spec.grounds(model) {
            for &freedom in &ground.freedoms {
                let own = format!("{name}.{}.{}", ground.name, spec.freedom_word(freedom));
                let of = |hold: &&fea::Hold| hold.point == ground.point && hold.freedom == freedom;
                let all: Vec<Effect> = holds.iter().filter(of).copied().map(Effect::Reaction).collect();
                if wanted(Kind::Reaction, &own) && !all.is_empty() {
                    owner.extend(all.iter().map(|_| Part { column: columns.len(), weight: 1.0 }));
                    effects.extend(all);
                    columns.push(Column {
                        name: own,
                        dimension: dimension(freedom >= Freedom::Rx),
                        kind: Kind::Reaction,
                        direction: direction(model, rails, freedom),
                    });
                }
            }
        }
        for cut in &spec.effects {
            for (index, (word, component)) in COMPONENTS.into_iter().enumerate() {
                let own = format!("{name}.{}.{word}", cut.name);
                if wanted(Kind::Section, &own) {
                    owner.push(Part { column: columns.len(), weight: 1.0 });
                    effects.push(Effect::Force { member: cut.member, place: cut.place, component });
                    columns.push(Column {
                        name: own,
                        dimension: dimension(index >= 3),
                        kind: Kind::Section,
                        direction: None,
                    });
                }
            }
        }
        for cut in &spec.effects {
            let section = model.members.get(cut.member).and_then(|member| model.sections.get(member.section));
            for point in &cut.points {
                let own = format!("{name}.{}.{}", cut.name, point.name);
                let Some(section) = section.filter(|_| wanted(Kind::Stress, &own)) else { continue };
                for ((_, component), weight) in COMPONENTS.into_iter().zip(weights(section, point)) {
                    if weight != 0.0 {
                        owner.push(Part { column: columns.len(), weight });
                        effects.push(Effect::Force { member: cut.member, place: cut.place, component });
                    }
                }
                columns.push(Column {
                    name: own,
                    dimension: Dimension::STRESS,
                    kind: Kind::Stress,
                    direction: None,
                });
            }
        }
        let out = ColumnInfluence::of(&frame, solved, laid, gravity, columns, &effects, owner)?;
        let felt = out.felt();
        if !felt.contains(&true) {
            return Ok(None);
        }
        Ok(Some(out.only(&felt, model, &frame, &effects)?))
    }

    /// Lines of `effects` of the frame of `solved`, each a part of the column that `owner` says.
    ///
    /// # Errors
    /// What the frame refuses.
    pub(super) fn of(
        frame: &Frame,
        solved: &SolvedModel,
        laid: &BuiltFoundation,
        gravity: f64,
        columns: Vec<Column>,
        effects: &[Effect],
        owner: Vec<Part>,
    ) -> Result<ColumnInfluence, fea::Error> {
        let model = &solved.model;
        let inertia = inertia(effects, laid, solved)?;
        let weight = frame.inertial(model, effects, &[])?.rigid;
        let up = Vector3::from(model.up).normalize();
        let dead: Vec<f64> = (0..effects.len())
            .map(|e| -gravity * (0..3).map(|k| weight[(e, k)] * up[k]).sum::<f64>())
            .collect();
        let lines = frame.influence_lines(model, effects)?;
        let mut out = ColumnInfluence {
            inertia: DMatrix::zeros(columns.len(), inertia.ncols()),
            dead: vec![0.0; columns.len()],
            columns,
            effects: lines,
            owner,
        };
        for (e, &Part { column, weight }) in out.owner.iter().enumerate() {
            out.dead[column] += weight * dead[e];
            for k in 0..inertia.ncols() {
                out.inertia[(column, k)] += weight * inertia[(e, k)];
            }
        }
        Ok(out)
    }

    /// Which columns any load, weight or inertia can make other than zero, up to rounding.
    fn felt(&self) -> Vec<bool> {
        let n = self.columns.len();
        let mut units = vec![0.0_f64; n];
        for cell in self.line().cells() {
            for share in [0.0, 0.3, 0.6, 1.0] {
                let x = cell.x[0] + share * (cell.x[1] - cell.x[0]);
                for axis in [Axis::Longitudinal, Axis::Vertical, Axis::Lateral] {
                    let unit = self.unit(Probe { rail: cell.rail, x, axis }).unwrap_or_default();
                    units.iter_mut().zip(unit).for_each(|(most, value)| *most = most.max(value.abs()));
                }
            }
        }
        let dead: Vec<f64> = self.dead.iter().map(|value| value.abs()).collect();
        let inertia =
            (0..n).map(|column| self.inertia.row(column).iter().fold(0.0_f64, |m, s| m.max(s.abs())));
        let mut felt = vec![false; n];
        for sizes in [units, dead, inertia.collect()] {
            let most = |dimension: Dimension| {
                let own = self.columns.iter().zip(&sizes).filter(|(column, _)| column.dimension == dimension);
                own.fold(0.0_f64, |most, (_, size)| most.max(*size))
            };
            let kinds = [Dimension::FORCE, Dimension::MOMENT, Dimension::STRESS];
            let largest = kinds.map(most);
            for ((felt, size), column) in felt.iter_mut().zip(&sizes).zip(&self.columns) {
                let own = kinds.iter().position(|kind| *kind == column.dimension);
                *felt |= own.is_some_and(|own| *size > ROUNDING * largest[own]);
            }
        }
        felt
    }

    /// The columns that are `kept`.
    fn only(
        self,
        kept: &[bool],
        model: &Model,
        frame: &Frame,
        effects: &[Effect],
    ) -> Result<ColumnInfluence, fea::Error> {
        if !kept.contains(&false) {
            return Ok(self);
        }
        let number = |column: usize| kept[..column].iter().filter(|kept| **kept).count();
        let rows: Vec<usize> = (0..kept.len()).filter(|column| kept[*column]).collect();
        let of = |(_, part): &(&Effect, &Part)| kept[part.column];
        let moved = |part: &Part| Part { column: number(part.column), ..*part };
        let (effects, owner): (Vec<Effect>, Vec<Part>) =
            effects.iter().zip(&self.owner).filter(of).map(|(e, part)| (*e, moved(part))).unzip();
        Ok(ColumnInfluence {
            effects: frame.influence_lines(model, &effects)?,
            owner,
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

    /// Number of freedoms whose accelerations count.
    #[must_use]
    pub fn freedoms(&self) -> usize {
        self.inertia.ncols()
    }

    /// By the own weight, one a column.
    #[must_use]
    pub fn dead(&self) -> &[f64] {
        &self.dead
    }

    /// The cells of the rails.
    #[must_use]
    pub fn line(&self) -> &Arc<splines::Line> {
        self.effects.line()
    }

    /// Every column under `loads` and `acceleration` into `out`, without own weight. Returns whether the structure
    /// resists all of the loads; those that it does not are left out.
    pub fn at<'l>(
        &self,
        loads: impl Iterator<Item = &'l WheelLoadHistory>,
        acceleration: &[f64],
        out: &mut [f64],
    ) -> bool {
        out.fill(0.0);
        let mut whole = true;
        let mut unit = vec![0.0; self.effects.len()];
        for load in loads {
            for (axis, force) in
                [Axis::Longitudinal, Axis::Vertical, Axis::Lateral].into_iter().zip(load.force)
            {
                if force == 0.0 {
                    continue;
                }
                if self.effects.fill(Probe { rail: load.rail, x: load.x, axis }, &mut unit).is_err() {
                    whole = false;
                    continue;
                }
                for (value, part) in unit.iter().zip(&self.owner) {
                    out[part.column] += force * part.weight * value;
                }
            }
        }
        for (k, a) in acceleration.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            for (out, share) in out.iter_mut().zip(self.inertia.column(k)) {
                *out -= share * a;
            }
        }
        whole
    }

    /// Every effect of a unit load, one a column; `None` where the structure does not resist it.
    #[must_use]
    pub fn unit(&self, at: Probe) -> Option<Vec<f64>> {
        let mut unit = vec![0.0; self.effects.len()];
        self.effects.fill(at, &mut unit).ok()?;
        let mut out = vec![0.0; self.columns.len()];
        unit.iter().zip(&self.owner).for_each(|(value, part)| out[part.column] += part.weight * value);
        Some(out)
    }
}

/// Effects of the inertia of what moves, effects x freedoms.
fn inertia(
    effects: &[Effect],
    laid: &BuiltFoundation,
    solved: &SolvedModel,
) -> Result<DMatrix<f64>, fea::Error> {
    match &laid.motion {
        None => Ok(DMatrix::zeros(effects.len(), 0)),
        Some(MotionBasis::Modes { frame, refined }) => {
            let own: Vec<Effect> = effects.iter().map(|effect| refined.effect(*effect)).collect();
            Ok(frame.inertial(&refined.model, &own, &refined.modes.modes)?.modes)
        }
        Some(MotionBasis::Parts(parts)) => match &solved.girder {
            Some(girder) => part_inertia(girder, parts, effects),
            None => Ok(DMatrix::zeros(effects.len(), parts.basis.ncols())),
        },
    }
}

/// Stress at a point per unit of each component of the internal force, as of [`practice::stress::weights`]; what a section
/// does not resist makes none.
fn weights(section: &Section, point: &StressPoint) -> [f64; 6] {
    let over = |lever: f64, property: f64| if property > 0.0 { lever / property } else { 0.0 };
    [over(1.0, section.area), 0.0, 0.0, 0.0, over(point.z, section.iy), over(0.0 - point.y, section.iz)]
}

const fn dimension(is_moment: bool) -> Dimension {
    if is_moment { Dimension::MOMENT } else { Dimension::FORCE }
}

fn direction(model: &Model, rails: &[fea::Rail], freedom: Freedom) -> Option<Direction> {
    let k = freedom as usize;
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
