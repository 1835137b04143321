//! Forces that the ground exerts.

use nalgebra::DMatrix;
use splines::Probe;

use crate::effect::Effect;
use crate::error::Error;
use crate::frame::Frame;
use crate::model::{Freedom, Model};
use crate::rail::Rail;

/// Where a reaction acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hold {
    /// Index of the point.
    pub point: usize,
    /// Global freedom that is held.
    pub freedom: Freedom,
    /// Index of the spring that holds it; `None` is a support.
    pub spring: Option<usize>,
}

/// Reactions per unit rail load.
#[derive(Clone, Debug)]
pub struct Reactions {
    /// One a row: supports first, then springs. A support that others of the same rigid body make
    /// redundant is left out.
    pub holds: Vec<Hold>,
    /// `value[(i, j)]`: force or moment of the ground on the structure at hold i, global and positive
    /// along its freedom, per unit force at probe j along its axis.
    pub value: DMatrix<f64>,
}

/// Reactions of supports and springs to unit loads at the probes `at`.
///
/// In equilibrium with the loads: forces and moments of loads and reactions add up to zero.
///
/// # Errors
/// As [`Frame::new`]; a probe beyond its rail, or in a direction that nothing resists.
pub fn reactions(m: &Model, rails: &[Rail], at: &[Probe]) -> Result<Reactions, Error> {
    Frame::new(m, rails)?.reactions(m, at)
}

impl Frame {
    /// [`reactions`] of a frame that is already factored from the same model.
    ///
    /// # Errors
    /// A probe beyond its rail, or in a direction that nothing resists.
    pub fn reactions(&self, m: &Model, at: &[Probe]) -> Result<Reactions, Error> {
        let holds = self.holds(m);
        let effects: Vec<Effect> = holds.iter().copied().map(Effect::Reaction).collect();
        let value = self.effects(m, &effects, at)?;
        Ok(Reactions { holds, value })
    }
}
