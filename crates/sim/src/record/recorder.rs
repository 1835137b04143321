//! Samples of a run, channel by channel.

use std::ops::Range;

use splines::{Influence, Probe};

use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::numerics::dense::dot;
use crate::record::energy::{brake_force, drive_force, spin_moment};
use crate::record::history::History;
use crate::scene::dof::arm_rows;
use crate::{Analysis, Channel, Error, Freedom, Gauge};

/// Structures whose freedoms are recorded, with the numbers of these.
fn recorded<'a>(system: &'a System) -> impl Iterator<Item = (usize, Range<usize>)> + 'a {
    let all = system.mechanics.structures.iter().zip(system.foundations).enumerate();
    all.filter(|(_, (_, foundation))| foundation.recorded).map(|(s, (range, _))| (s, range.clone()))
}

/// Writes samples.
pub(crate) struct Recorder {
    pub history: History,
    /// Scratch of the gauges.
    probes: Vec<Probe>,
    shape: Vec<f64>,
    /// Wheels that each drive and each braked contact acts under, evenly.
    pulled: Vec<Vec<usize>>,
    /// Scratch: force of each wheel on the rail along +x.
    along: Vec<f64>,
}

impl Recorder {
    pub fn new(system: &System) -> Self {
        let actuators = &system.scene.actuators;
        let ends = 2 * actuators.ropes.len() + actuators.stops.len() + system.scene.gauges.len();
        let count = 1 + 14 * system.scene.bodies.len() + 9 * system.mechanics.wheels.len() + ends;
        let mut channels = Vec::with_capacity(count);
        channels.push(Channel::Time);
        for b in 0..system.scene.bodies.len() {
            channels.extend(Freedom::ALL.map(|freedom| Channel::Displacement(b, freedom)));
            channels.extend(Freedom::ALL.map(|freedom| Channel::Speed(b, freedom)));
            channels.extend([Channel::Drive(b), Channel::Brake(b)]);
        }
        for w in 0..system.mechanics.wheels.len() {
            channels.extend([
                Channel::Place(w),
                Channel::Vertical(w),
                Channel::Lateral(w),
                Channel::Traction(w),
                Channel::Penetration(w),
                Channel::Give(w),
                Channel::SpinAngle(w),
                Channel::SpinSpeed(w),
                Channel::SpinMoment(w),
            ]);
        }
        channels.extend((0..actuators.ropes.len()).flat_map(|r| [Channel::Tension(r), Channel::Length(r)]));
        channels.extend((0..actuators.stops.len()).map(Channel::Stop));
        channels.extend((0..system.scene.gauges.len()).map(Channel::Gauge));
        for (s, range) in recorded(system) {
            channels.extend((0..range.len()).map(|k| Channel::Coordinate(s, k)));
            channels.extend((0..range.len()).map(|k| Channel::Acceleration(s, k)));
        }
        let history = History { channels, values: Vec::new() };
        let pulled = (0..system.pulls.len()).map(|index| system.wheels_of(system.pull(index))).collect();
        let along = vec![0.0; system.mechanics.wheels.len()];
        Recorder { history, probes: Vec::new(), shape: vec![0.0; 2 * system.mechanics.dofs], pulled, along }
    }

    /// Numbers of a sample.
    pub fn width(&self) -> usize {
        self.history.channels().len()
    }

    /// Adds a sample; `geometry` belongs to `at`.
    pub fn record(&mut self, system: &System, geometry: &Geometry, at: &State) -> Result<(), Error> {
        let mut values = std::mem::take(&mut self.history.values);
        let done = self.row(system, geometry, at, &mut values);
        self.history.values = values;
        done
    }

    /// Appends a sample to `values`; `geometry` belongs to `at`.
    pub fn row(
        &mut self,
        system: &System,
        geometry: &Geometry,
        at: &State,
        values: &mut Vec<f64>,
    ) -> Result<(), Error> {
        values.push(at.t);
        for b in 0..system.scene.bodies.len() {
            let (displacement, speed) = system.mechanics.body(b, at.t, &at.q, &at.v);
            values.extend(displacement);
            values.extend(speed);
            values.extend([drive_force(system, geometry, at, b), brake_force(system, at, b)]);
        }
        self.pull_along(system, at);
        for (w, wheel) in system.mechanics.wheels.iter().enumerate() {
            let mut vertical = 0.0;
            let mut deepest = f64::NEG_INFINITY;
            for i in system.mechanics.groups_of(w) {
                vertical += at.force[i] / system.mechanics.groups[i].count();
                if geometry.share[i][0] > 0.0 {
                    deepest = deepest.max(at.p[i]);
                }
            }
            let lateral =
                system.laterals.iter().position(|&l| l == w).map_or(0.0, |i| at.force[system.lateral(i)]);
            let (displacement, _) = system.mechanics.body(wheel.body, at.t, &at.q, &at.v);
            let own = system
                .mechanics
                .irregularity(w)
                .map_or(0.0, |shape| shape.vertical(geometry.piece[w], geometry.x[w])[0]);
            let down = own - dot(&arm_rows(wheel.hub)[1], &displacement);
            let (angle, speed) = match (wheel.spin, system.mechanics.turn(w, at.t)) {
                (Some(number), _) => (at.q[number], at.v[number]),
                (None, Some(turn)) => (turn.x, turn.v),
                (None, None) => (0.0, 0.0),
            };
            values.extend([
                geometry.x[w],
                vertical,
                lateral,
                self.along[w],
                deepest,
                down - deepest,
                angle,
                speed,
                spin_moment(system, geometry, at, w),
            ]);
        }
        let ropes = system.scene.actuators.ropes.len();
        for (index, hold) in geometry.links.iter().enumerate() {
            values.push(at.force[system.link(index)]);
            if index < ropes {
                values.push(hold.length);
            }
        }
        for gauge in &system.scene.gauges {
            let displacement = self.displacement(system, geometry, at, gauge)?;
            values.push(displacement);
        }
        let moves = system.scene.analysis == Analysis::Dynamic;
        for (_, range) in recorded(system) {
            values.extend(range.clone().map(|k| at.q[k]));
            values.extend(range.map(|k| if moves { at.a[k] } else { 0.0 }));
        }
        Ok(())
    }

    /// What every wheel does to the rail along +x: its friction, its shares of the drive and of its brake.
    fn pull_along(&mut self, system: &System, at: &State) {
        self.along.fill(0.0);
        for (index, &w) in system.tractions.iter().enumerate() {
            self.along[w] += at.force[system.traction(index)];
        }
        for (index, wheels) in self.pulled.iter().enumerate() {
            let share = at.force[system.pull(index)] / wheels.len() as f64;
            wheels.iter().for_each(|&w| self.along[w] += share);
        }
    }

    /// G F + Phi q at a gauge.
    fn displacement(
        &mut self,
        system: &System,
        geometry: &Geometry,
        at: &State,
        gauge: &Gauge,
    ) -> Result<f64, Error> {
        let (foundation, s) = (&system.foundations[gauge.structure], gauge.structure);
        let failed = |source| Error::Compliance { structure: s, source };
        let mut sum = 0.0;
        if let Some(compliance) = &foundation.compliance {
            let entries = &system.entries[s];
            self.probes.clear();
            self.probes.push(gauge.probe);
            let wheels = entries.iter().map(|e| Probe { x: geometry.x[e.wheel], ..e.probe });
            self.probes.extend(wheels);
            let mut influence = Influence::zeros(self.probes.len());
            compliance.fill(&self.probes, &mut influence).map_err(failed)?;
            for (j, entry) in entries.iter().enumerate() {
                sum += influence.value[(0, j + 1)] * entry.weight * at.force[entry.component];
            }
        }
        if let Some(structure) = &foundation.structure {
            let range = system.mechanics.structures[s].clone();
            let (value, slope) = self.shape.split_at_mut(system.mechanics.dofs);
            let value = &mut value[..range.len()];
            structure.shapes.row(gauge.probe, value, &mut slope[..range.len()]).map_err(failed)?;
            sum += dot(value, &at.q.as_slice()[range]);
        }
        Ok(sum)
    }
}
