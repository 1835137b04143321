//! Displacements of the rails of a structure under the loads of a run.

use sim::{Channel, Foundation};
use splines::{Axis, Error, PlaceDisplacements, Probe};
use trains::RailLoad;

use super::over_time::TimeSearch;
use crate::loads::WheelLoadReader;
use formats::scene::Scene;
use foundations::BuiltFoundation;

/// A structure with the wheel loads of a run.
pub(super) struct LoadedStructure<'a> {
    pub scene: &'a Scene,
    /// Index of the structure in the scene.
    pub s: usize,
    /// The run, and its accuracy.
    pub run: TimeSearch<'a>,
    pub loads: &'a WheelLoadReader,
    pub built: &'a BuiltFoundation,
}

impl LoadedStructure<'_> {
    /// Loads on the structure in a row of the solution.
    pub fn on(&self, row: &[f64]) -> Vec<RailLoad> {
        let on = self.loads.on(self.s);
        on.map(|source| source.load_in(row)).collect()
    }

    /// Displacements of its degrees of freedom in a row.
    pub fn dofs<'r>(&self, row: &'r [f64]) -> &'r [f64] {
        let start = self.start();
        start.map_or(&[][..], |at| &row[at..at + self.built.foundation.dofs()])
    }

    /// Whether the displacements can be computed: the structure is flexible, and its degrees of freedom, if any, were
    /// recorded.
    pub fn is_known(&self) -> bool {
        let foundation = &self.built.foundation;
        match foundation.structure {
            Some(_) => self.start().is_some(),
            None => foundation.compliance.is_some(),
        }
    }

    /// Channel of the first degree of freedom of the structure.
    fn start(&self) -> Option<usize> {
        self.run.solution.position(Channel::Coordinate(self.s, 0))
    }
}

/// Displacements u = G F + Phi q at the probes; G: compliance, F: loads, q: degrees of freedom, Phi: their shape
/// functions.
pub(crate) fn displacements(
    foundation: &Foundation,
    probes: &[Probe],
    loads: &[RailLoad],
    q: &[f64],
) -> Result<Vec<f64>, Error> {
    let mut out = vec![0.0; probes.len()];
    if let Some(compliance) = &foundation.compliance {
        compliance.displacements(
            probes,
            &components(loads, foundation.is_loaded_along),
            &mut out,
        )?;
    }
    add_motions(foundation, probes, q, &mut out)?;
    Ok(out)
}

/// Adds Phi q at the probes.
fn add_motions(
    foundation: &Foundation,
    probes: &[Probe],
    q: &[f64],
    out: &mut [f64],
) -> Result<(), Error> {
    if let (Some(structure), false) = (&foundation.structure, q.is_empty()) {
        let (mut value, mut slope) = (vec![0.0; q.len()], vec![0.0; q.len()]);
        for (out, probe) in out.iter_mut().zip(probes) {
            structure.shapes.row(*probe, &mut value, &mut slope)?;
            *out += value.iter().zip(q).map(|(phi, q)| phi * q).sum::<f64>();
        }
    }
    Ok(())
}

/// The components of loads that are not zero; those along the rails only where the structure is loaded along them.
fn components(loads: &[RailLoad], is_loaded_along: bool) -> Vec<(Probe, f64)> {
    let mut out = Vec::with_capacity(3 * loads.len());
    for load in loads {
        for (axis, force) in Axis::ALL.into_iter().zip(load.force) {
            if force != 0.0 && (axis != Axis::Longitudinal || is_loaded_along) {
                out.push((
                    Probe {
                        rail: load.rail,
                        x: load.x,
                        axis,
                    },
                    force,
                ));
            }
        }
    }
    out
}

/// The same displacements of fixed places, prepared for many loads and motions.
pub(crate) struct PlaceMotions<'a> {
    foundation: &'a Foundation,
    compliance: Option<Box<dyn PlaceDisplacements + 'a>>,
    /// Phi: for each degree of freedom the values at all places.
    shapes: Vec<f64>,
    count: usize,
}

impl<'a> PlaceMotions<'a> {
    /// The places of `probes` on a structure.
    ///
    /// # Errors
    /// A probe beyond its rail, or in a direction in which the structure is unrestrained.
    pub fn new(foundation: &'a Foundation, probes: &[Probe]) -> Result<PlaceMotions<'a>, Error> {
        let compliance = foundation
            .compliance
            .as_ref()
            .map(|own| own.at_places(probes))
            .transpose()?;
        let (count, dofs) = (probes.len(), foundation.dofs());
        let mut shapes = vec![0.0; dofs * count];
        if let Some(structure) = &foundation.structure {
            let (mut value, mut slope) = (vec![0.0; dofs], vec![0.0; dofs]);
            for (k, probe) in probes.iter().enumerate() {
                structure.shapes.row(*probe, &mut value, &mut slope)?;
                shapes
                    .iter_mut()
                    .skip(k)
                    .step_by(count)
                    .zip(&value)
                    .for_each(|(own, value)| *own = *value);
            }
        }
        Ok(PlaceMotions {
            foundation,
            compliance,
            shapes,
            count,
        })
    }

    /// The displacements under loads, with the degrees of freedom `q`, none where they are not known; then those of the
    /// probes `also`, which may be others at each call.
    ///
    /// # Errors
    /// A load or a probe beyond its rail, or in a direction in which the structure is unrestrained.
    pub fn under(&self, loads: &[RailLoad], q: &[f64], also: &[Probe]) -> Result<Vec<f64>, Error> {
        let mut out = vec![0.0; self.count + also.len()];
        let foundation = self.foundation;
        if let Some(compliance) = &self.compliance {
            compliance.under(
                &components(loads, foundation.is_loaded_along),
                also,
                &mut out,
            )?;
        }
        let (fixed, others) = out.split_at_mut(self.count);
        for (q, own) in q.iter().zip(self.shapes.chunks(self.count.max(1))) {
            fixed
                .iter_mut()
                .zip(own)
                .for_each(|(sum, phi)| *sum += phi * q);
        }
        add_motions(foundation, also, q, others)?;
        Ok(out)
    }
}
