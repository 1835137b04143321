//! One structure in a run: the wheels on it, and how its rails move.

use sim::{Channel, Foundation, History};
use splines::{Axis, Error, Influence, Probe};

use super::wheel_load::{WheelLoadHistories, WheelLoadHistory};
use formats::scene::Scene;
use foundations::BuiltFoundation;

/// A structure under the wheels of a run.
pub(super) struct LoadedStructure<'a> {
    pub scene: &'a Scene,
    /// Index of the structure in the scene.
    pub s: usize,
    pub history: &'a History,
    pub loads: &'a WheelLoadHistories,
    pub laid: &'a BuiltFoundation,
}

impl LoadedStructure<'_> {
    /// Wheel loads on it at an output time.
    pub fn on(&self, row: usize) -> Vec<WheelLoadHistory> {
        let all = self.loads.at(self.history.sample(row)).into_iter();
        all.filter(|load| load.structure == self.s).collect()
    }

    /// Whether it gives, and its freedoms were recorded where it has some.
    pub fn is_known(&self) -> bool {
        let foundation = &self.laid.foundation;
        match foundation.structure {
            Some(_) => self.start().is_some(),
            None => foundation.compliance.is_some(),
        }
    }

    /// Displacements at the probes at an output time, under the loads `on` it then; `None` in a direction that it does
    /// not resist.
    ///
    /// # Errors
    /// A place beyond a rail.
    pub fn displacements(
        &self,
        probes: &[Probe],
        on: &[WheelLoadHistory],
        row: usize,
    ) -> Result<Option<Vec<f64>>, Error> {
        let foundation = &self.laid.foundation;
        let sample = self.history.sample(row);
        let q = self.start().map_or(&[][..], |at| &sample[at..at + foundation.freedoms()]);
        match displacements(foundation, probes, on, q) {
            Ok(moved) => Ok(Some(moved)),
            Err(Error::Unstiffened { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Channel of its first freedom.
    fn start(&self) -> Option<usize> {
        self.history.channels().iter().position(|c| *c == Channel::Coordinate(self.s, 0))
    }
}

/// At most `most` of `count` indices, evenly spread from the first to the last.
pub(super) fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let shown = count.min(most);
    (0..shown).map(move |k| k * (count - 1) / (shown - 1).max(1))
}

/// G F + Phi q at the probes.
fn displacements(
    foundation: &Foundation,
    probes: &[Probe],
    loads: &[WheelLoadHistory],
    q: &[f64],
) -> Result<Vec<f64>, Error> {
    let mut out = vec![0.0; probes.len()];
    if let Some(compliance) = &foundation.compliance {
        let mut at = probes.to_vec();
        let mut forces = Vec::new();
        for load in loads {
            for (axis, force) in
                [Axis::Longitudinal, Axis::Vertical, Axis::Lateral].into_iter().zip(load.force)
            {
                if force != 0.0 && (axis != Axis::Longitudinal || foundation.is_dragged) {
                    at.push(Probe { rail: load.rail, x: load.x, axis });
                    forces.push(force);
                }
            }
        }
        let mut influence = Influence::zeros(at.len());
        compliance.fill(&at, &mut influence)?;
        for (i, out) in out.iter_mut().enumerate() {
            *out += forces
                .iter()
                .enumerate()
                .map(|(j, force)| influence.value[(i, probes.len() + j)] * force)
                .sum::<f64>();
        }
    }
    if let (Some(structure), false) = (&foundation.structure, q.is_empty()) {
        let (mut value, mut slope) = (vec![0.0; q.len()], vec![0.0; q.len()]);
        for (out, probe) in out.iter_mut().zip(probes) {
            structure.shapes.row(*probe, &mut value, &mut slope)?;
            *out += value.iter().zip(q).map(|(phi, q)| phi * q).sum::<f64>();
        }
    }
    Ok(out)
}
