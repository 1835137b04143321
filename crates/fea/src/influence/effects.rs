//! Reactions and internal forces under loads on rails.

use nalgebra::DMatrix;
use splines::{InfluenceLines, Probe};

use crate::error::Error;
use crate::influence::frame::FactoredFrame;
use crate::influence::functional::{Effect, Restraint};
use crate::model::Model;

/// Reactions per unit load on the rails.
#[derive(Clone, Debug)]
pub struct Reactions {
    /// One for each row: supports first, then springs, as [`FactoredFrame::restraints`].
    pub restraints: Vec<Restraint>,
    /// Restraints x probes: `value[(i, j)]` is the force or moment of the ground on the structure at
    /// restraint i, global and positive along its degree of freedom, per unit force at probe j along its axis.
    pub value: DMatrix<f64>,
}

impl FactoredFrame {
    /// Reactions of supports and springs to unit loads at the probes `at`; `m` is the model that the frame was
    /// made of.
    ///
    /// Guarantee: forces and moments of loads and reactions are in equilibrium, up to rounding.
    ///
    /// # Errors
    /// As [`FactoredFrame::effects`].
    pub fn reactions(&self, m: &Model, at: &[Probe]) -> Result<Reactions, Error> {
        let holds = self.restraints(m);
        let effects: Vec<Effect> = holds.iter().copied().map(Effect::Reaction).collect();
        let value = self.effects(m, &effects, at)?;
        Ok(Reactions {
            restraints: holds,
            value,
        })
    }

    /// Influence lines: the effects of unit loads anywhere on the rails, with one solve for each effect.
    ///
    /// An effect e^T u of the displacements u = K^-1 p has the row A = (K^-1 e)^T over the motions of the
    /// states (reciprocity, Mueller-Breslau). `m` is the model that the frame was made of.
    ///
    /// # Errors
    /// [`Error::NoRails`]; [`Error::Invalid`] for a member or restraint that does not exist, or a place
    /// outside 0 to 1.
    pub fn influence_lines(&self, m: &Model, effects: &[Effect]) -> Result<InfluenceLines, Error> {
        let functionals = self.functionals(m, effects)?;
        let line = self.line()?;
        let states = &self.states()[..line.state_count()];
        let unstiffened: Vec<usize> = (0..6 * states.len())
            .filter(|&k| self.scaled(&states[k / 6][k % 6]).is_none())
            .collect();
        let mut rows = DMatrix::zeros(effects.len(), 6 * states.len());
        for (e, functional) in functionals.iter().enumerate() {
            let motions = self.motions(&self.scaled_where_stiffened(&functional.strain));
            for (k, state) in states.iter().flatten().enumerate() {
                rows[(e, k)] = state.evaluate(&motions) - functional.direct.dot(state);
            }
        }
        // A load there is refused: evaluation finds the infinity.
        for k in unstiffened {
            rows.column_mut(k).fill(f64::INFINITY);
        }
        let sections = functionals
            .into_iter()
            .map(|functional| functional.section)
            .collect();
        Ok(InfluenceLines::new(line.clone(), rows, sections)?)
    }

    /// Effects (rows) of unit loads at the probes (columns): one solve for each effect by
    /// [`FactoredFrame::influence_lines`] or, if there are fewer loads than effects, one solve for each load.
    ///
    /// # Errors
    /// As [`FactoredFrame::influence_lines`]; [`Error::Rail`] for a probe beyond its rail, or in a direction that
    /// nothing resists.
    pub fn effects(
        &self,
        m: &Model,
        effects: &[Effect],
        at: &[Probe],
    ) -> Result<DMatrix<f64>, Error> {
        if effects.len() > at.len() {
            return self.effects_by_load(m, effects, at);
        }
        let mut value = DMatrix::zeros(effects.len(), at.len());
        let lines = self.influence_lines(m, effects)?;
        for (j, &probe) in at.iter().enumerate() {
            lines.fill(probe, value.column_mut(j).as_mut_slice())?;
        }
        Ok(value)
    }

    /// [`FactoredFrame::effects`] with one solve for each load.
    fn effects_by_load(
        &self,
        m: &Model,
        effects: &[Effect],
        at: &[Probe],
    ) -> Result<DMatrix<f64>, Error> {
        let mut value = DMatrix::zeros(effects.len(), at.len());
        let functionals = self.functionals(m, effects)?;
        // Only an internal force has a part from a load on its own member between fixed ends.
        let inner: Vec<usize> = (0..effects.len())
            .filter(|&i| functionals[i].section.is_some())
            .collect();
        let sections = inner
            .iter()
            .map(|&i| functionals[i].section.clone())
            .collect();
        let line = self.line()?;
        let clamped = InfluenceLines::new(
            line.clone(),
            DMatrix::zeros(inner.len(), 6 * line.state_count()),
            sections,
        )?;
        let mut own = vec![0.0; inner.len()];
        for (j, &probe) in at.iter().enumerate() {
            clamped.fill(probe, &mut own)?;
            inner
                .iter()
                .zip(&own)
                .for_each(|(&i, &part)| value[(i, j)] = part);
            let (load, _) = self.load(probe)?;
            let motions = self.motions(&load);
            let (row, _) = self.row(probe)?;
            for (i, functional) in functionals.iter().enumerate() {
                value[(i, j)] += functional.strain.evaluate(&motions) - functional.direct.dot(&row);
            }
        }
        Ok(value)
    }
}
