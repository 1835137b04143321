//! Samples of a run, channel by channel.

use std::ops::Range;

use splines::{Axis, Influence, Probe};

use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::mechanics::wheels::WheelPoint;
use crate::numerics::dense::dot;
use crate::record::energy::{motion_force, spin_moment};
use crate::scene::dof::arm_rows;
use crate::{Analysis, BodyDof, Channel, Error};

/// Structures whose degrees of freedom are recorded, with the numbers of these degrees of freedom.
fn recorded<'a>(system: &'a System) -> impl Iterator<Item = (usize, Range<usize>)> + 'a {
    let all = system
        .mechanics
        .structures
        .iter()
        .zip(system.foundations)
        .enumerate();
    all.filter(|(_, (_, foundation))| foundation.recorded)
        .map(|(s, (range, _))| (s, range.clone()))
}

/// Number of channels of a body: six displacements, six speeds, drive and brake; and of a wheel.
const OF_BODY: usize = 14;
const OF_WHEEL: usize = 9;

/// Recorder of samples.
pub(crate) struct Recorder {
    channels: Vec<Channel>,
    /// Columns to which the elements add their forces, with the divisors.
    forces: Vec<ForceColumn>,
    /// Elements whose length is recorded, with the columns of the lengths.
    lengths: Vec<(usize, usize)>,
    /// Number of columns for channels of the elements' own.
    own_columns: usize,
    /// A row with what never changes: displacements that are fixed, and zeros.
    blank: Vec<f64>,
    /// Columns of displacements of bodies that are degrees of freedom, with the numbers of these.
    free: Vec<(usize, usize)>,
    /// Columns of bodies whose motion is prescribed, or follows from others.
    moved: Vec<Range<usize>>,
    /// Column of the first wheel.
    first_wheel: usize,
    /// Columns of forces that only press, or only pull.
    one_sided: Vec<usize>,
    /// Degrees of freedom of each recorded structure.
    recorded: Vec<Range<usize>>,
    wheels: Vec<WheelColumns>,
    /// The structures whose displacements are recorded.
    rails: Vec<RailColumns>,
    /// Working memory for the displacements of gauges, and of rails under wheels.
    gauges: Vec<f64>,
    under: Vec<(usize, f64)>,
    probes: Vec<Probe>,
    shape: Vec<f64>,
}

/// A structure whose displacements are recorded.
struct RailColumns {
    structure: usize,
    /// Its gauges.
    gauges: Vec<usize>,
    /// The wheels on it that share their force with others. Their mean penetration says nothing of the rail under one of them,
    /// so that its deflection is computed like that at a gauge.
    shared: Vec<usize>,
}

/// What the columns of a wheel need, looked up once.
struct WheelColumns {
    body: usize,
    /// The groups that the wheel belongs to.
    groups: Range<usize>,
    /// Height of its hub by the displacements of its body.
    arms: [f64; 6],
    /// Whether it has a spin, free or prescribed.
    turns: bool,
}

/// A column to which the force of an element, divided by `divisor`, is added.
struct ForceColumn {
    element: usize,
    column: usize,
    divisor: f64,
}

impl Recorder {
    pub fn new(system: &System) -> Self {
        let channels = channels_of(system);
        let column = |channel: &Channel| channels.iter().position(|known| known == channel);
        let (mut forces, mut lengths) = (Vec::new(), Vec::new());
        for (i, element) in system.elements.iter().enumerate() {
            for (channel, divisor) in element.channels(&system.mechanics) {
                forces.extend(column(&channel).map(|column| ForceColumn {
                    element: i,
                    column,
                    divisor,
                }));
            }
            let length = element.length_channel();
            lengths.extend(
                length
                    .and_then(|channel| column(&channel))
                    .map(|column| (i, column)),
            );
        }
        let is_one_sided = |force: &&ForceColumn| match channels[force.column] {
            Channel::Vertical(_) => !system.law(force.element).bilateral,
            Channel::Stop(_) | Channel::Tension(_) => true,
            _ => false,
        };
        let one_sided = forces.iter().filter(is_one_sided);
        let one_sided = one_sided.map(|force| force.column).collect();
        let own_columns = system
            .elements
            .iter()
            .map(|element| element.own_channels().len())
            .sum();
        let of_wheel = |(w, wheel): (usize, &WheelPoint)| WheelColumns {
            body: wheel.body,
            groups: system.mechanics.groups_of(w),
            arms: arm_rows(wheel.hub)[1],
            turns: wheel.spin.is_some() || wheel.turn.is_some(),
        };
        let wheels = system
            .mechanics
            .wheels
            .iter()
            .enumerate()
            .map(of_wheel)
            .collect();
        let shape = vec![0.0; 2 * system.mechanics.dofs];
        let (mut blank, mut free) = (vec![0.0; channels.len()], Vec::new());
        let (mut moved, first_wheel) = (Vec::new(), 1 + OF_BODY * system.scene.bodies.len());
        let bodies = system.scene.bodies.iter().enumerate();
        for (b, body) in bodies {
            let first = 1 + OF_BODY * b;
            blank[first..first + 6].copy_from_slice(&body.start);
            // The sum of no forces is -0.0, the sum of an empty iterator.
            blank[first + 12..first + OF_BODY].fill(-0.0);
            if body.pinned.is_some() {
                moved.push(first..first + 12);
            } else if body.motion.is_some() {
                moved.extend([0, 6, 12].map(|own| first + own..first + own + 1));
            }
            if body.pinned.is_none() {
                let numbers = system.mechanics.kinematics.numbers[b].iter().enumerate();
                free.extend(numbers.filter_map(|(i, number)| Some((first + i, (*number)?))));
            }
        }
        Recorder {
            blank,
            free,
            channels,
            moved,
            first_wheel,
            one_sided,
            recorded: recorded(system).map(|(_, range)| range).collect(),
            forces,
            lengths,
            own_columns,
            wheels,
            rails: rails_of(system),
            gauges: vec![0.0; system.scene.gauges.len()],
            under: Vec::new(),
            probes: Vec::new(),
            shape,
        }
    }

    /// The channels, in the order of each row.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Numbers of the degrees of freedom of the recorded structures, in the order of their channels.
    pub fn modes(&self) -> impl Iterator<Item = usize> {
        self.recorded.iter().cloned().flatten()
    }

    /// Positions in a row of the force that presses or pulls alone, never both.
    pub fn one_sided(&self) -> &[usize] {
        &self.one_sided
    }

    /// Positions in a row of the channels that may change over time.
    pub fn live(&self) -> Vec<usize> {
        let mut is_live = vec![false; self.channels.len()];
        for &(column, _) in &self.free {
            (is_live[column], is_live[column + 6]) = (true, true);
        }
        for own in &self.moved {
            is_live[own.clone()].fill(true);
        }
        for (w, wheel) in self.wheels.iter().enumerate() {
            let first = self.first_wheel + OF_WHEEL * w;
            for own in [0, 4, 5] {
                is_live[first + own] = true;
            }
            is_live[first + 6..first + 9].fill(wheel.turns);
        }
        let columns = self.forces.iter().map(|own| own.column);
        for column in columns.chain(self.lengths.iter().map(|own| own.1)) {
            is_live[column] = true;
        }
        is_live[self.first_wheel + OF_WHEEL * self.wheels.len() + self.own_columns..].fill(true);
        (0..is_live.len()).filter(|at| is_live[*at]).collect()
    }

    /// Appends a sample to `values`; `geometry` must be current for `at`.
    ///
    /// # Errors
    /// Any error from evaluating the rails at the gauges.
    pub fn row(
        &mut self,
        system: &System,
        geometry: &Geometry,
        at: &State,
        values: &mut Vec<f64>,
    ) -> Result<(), Error> {
        let (first, mechanics) = (values.len(), &system.mechanics);
        let (bodies, wheels) = (
            OF_BODY * system.scene.bodies.len(),
            OF_WHEEL * self.wheels.len(),
        );
        self.under.clear();
        for k in 0..self.rails.len() {
            self.displacements(k, system, geometry, at)?;
        }
        let frame = geometry.frame(system, at);
        values.extend_from_slice(&self.blank);
        let row = &mut values[first..];
        row[0] = at.t;
        let (q, v) = (at.q.as_slice(), at.v.as_slice());
        for &(column, number) in &self.free {
            row[column] = q[number];
            row[column + 6] = v[number];
        }
        let (of_bodies, others) = row[1..].split_at_mut(bodies);
        let each = system
            .scene
            .bodies
            .iter()
            .enumerate()
            .zip(of_bodies.as_chunks_mut::<OF_BODY>().0);
        for ((b, body), own) in each {
            if body.pinned.is_some() {
                let (displacement, speed) = mechanics.kinematics.motion(b, at.t, &at.q, &at.v);
                own[..6].copy_from_slice(&displacement);
                own[6..12].copy_from_slice(&speed);
            } else if let Some(motion) = &body.motion {
                let travel = motion.at(at.t);
                (own[0], own[6]) = (travel.x, travel.v);
                own[12] = motion_force(system, &frame, b);
            }
        }
        let all = self
            .wheels
            .iter()
            .enumerate()
            .zip(others.as_chunks_mut::<OF_WHEEL>().0);
        for ((w, wheel), own) in all {
            write_wheel(system, geometry, at, (w, wheel), of_bodies, own);
        }
        for &(w, rise) in &self.under {
            others[OF_WHEEL * w + 5] = -rise;
        }
        for &ForceColumn {
            element,
            column,
            divisor,
        } in &self.forces
        {
            row[column] += 0.0 + at.force[element] / divisor;
        }
        for &(element, column) in &self.lengths {
            row[column] = geometry.local()[element].spring.length;
        }
        let (gauges, structures) =
            row[1 + bodies + wheels + self.own_columns..].split_at_mut(system.scene.gauges.len());
        gauges
            .iter_mut()
            .zip(&self.gauges)
            .for_each(|(column, moved)| *column = *moved);
        let (moves, mut next) = (system.scene.analysis == Analysis::Dynamic, 0);
        for (_, range) in recorded(system) {
            let (q, a) = structures[next..next + 2 * range.len()].split_at_mut(range.len());
            next += 2 * range.len();
            q.copy_from_slice(&at.q.as_slice()[range.clone()]);
            if moves {
                a.copy_from_slice(&at.a.as_slice()[range]);
            }
        }
        Ok(())
    }

    /// Sets the displacements G F + Phi q at the gauges of a structure and under the wheels on it that share their force.
    fn displacements(
        &mut self,
        k: usize,
        system: &System,
        geometry: &Geometry,
        at: &State,
    ) -> Result<(), Error> {
        let RailColumns {
            structure: s,
            gauges,
            shared,
        } = &self.rails[k];
        let (s, foundation) = (*s, &system.foundations[*s]);
        let failed = |source| Error::Compliance {
            structure: s,
            source,
        };
        let entries = &system.probes.entries[s];
        self.probes.clear();
        let at_gauges = gauges.iter().map(|&g| system.scene.gauges[g].probe);
        self.probes.extend(at_gauges);
        let under_wheels = entries.iter().map(|entry| Probe {
            x: geometry.places().x[entry.wheel],
            ..entry.probe
        });
        self.probes.extend(under_wheels);
        let influence = match &foundation.compliance {
            Some(compliance) => {
                let mut influence = Influence::zeros(self.probes.len());
                compliance
                    .fill(&self.probes, &mut influence)
                    .map_err(failed)?;
                Some(influence)
            }
            None => None,
        };
        let (probes, shape) = (&self.probes, &mut self.shape);
        let mut displacement = |i: usize| {
            let mut sum = 0.0;
            if let Some(influence) = &influence {
                for (j, entry) in entries.iter().enumerate() {
                    let value = influence.value[(i, gauges.len() + j)];
                    sum += value * entry.weight * at.force[entry.element];
                }
            }
            if let Some(structure) = &foundation.structure {
                let range = system.mechanics.structures[s].clone();
                let (value, slope) = shape.split_at_mut(system.mechanics.dofs);
                let value = &mut value[..range.len()];
                structure
                    .shapes
                    .row(probes[i], value, &mut slope[..range.len()])
                    .map_err(failed)?;
                sum += dot(value, &at.q.as_slice()[range]);
            }
            Ok(sum)
        };
        for (i, &g) in gauges.iter().enumerate() {
            self.gauges[g] = displacement(i)?;
        }
        for &w in shared {
            let groups = system.mechanics.groups_of(w);
            let own = entries.iter().enumerate().filter(|(_, entry)| {
                entry.wheel == w
                    && entry.probe.axis == Axis::Vertical
                    && groups.contains(&entry.element)
            });
            let most = own.max_by(|(_, a), (_, b)| {
                let share = |element: usize| geometry.fraction(element);
                share(a.element).total_cmp(&share(b.element))
            });
            if let Some((j, _)) = most {
                self.under.push((w, displacement(gauges.len() + j)?));
            }
        }
        Ok(())
    }
}

/// The structures that have gauges, or wheels that share their force with others.
fn rails_of(system: &System) -> Vec<RailColumns> {
    let mechanics = &system.mechanics;
    let of = |structure: usize| {
        let gauges = system.scene.gauges.iter().enumerate();
        let gauges = gauges.filter(|(_, gauge)| gauge.structure == structure);
        let shared = (0..mechanics.wheels.len()).filter(|&w| {
            let first = mechanics.groups_of(w).start;
            let contact = &system.scene.contacts[mechanics.wheels[w].contact];
            contact.structure == structure && mechanics.groups[first].wheels.len() > 1
        });
        RailColumns {
            structure,
            gauges: gauges.map(|(g, _)| g).collect(),
            shared: shared.collect(),
        }
    };
    (0..system.foundations.len())
        .map(of)
        .filter(|own| !own.gauges.is_empty() || !own.shared.is_empty())
        .collect()
}

/// All channels of a scene, in the order of each sample.
fn channels_of(system: &System) -> Vec<Channel> {
    let (bodies, wheels) = (system.scene.bodies.len(), system.mechanics.wheels.len());
    let others = 2 * system.elements.len() + system.scene.gauges.len();
    let mut channels = Vec::with_capacity(1 + OF_BODY * bodies + OF_WHEEL * wheels + others);
    channels.push(Channel::Time);
    for b in 0..bodies {
        channels.extend(BodyDof::ALL.map(|freedom| Channel::Displacement(b, freedom)));
        channels.extend(BodyDof::ALL.map(|freedom| Channel::Speed(b, freedom)));
        channels.extend([Channel::Drive(b), Channel::Brake(b)]);
    }
    for w in 0..wheels {
        channels.extend([
            Channel::Position(w),
            Channel::Vertical(w),
            Channel::Lateral(w),
            Channel::Traction(w),
            Channel::Penetration(w),
            Channel::Deflection(w),
            Channel::SpinAngle(w),
            Channel::SpinSpeed(w),
            Channel::SpinMoment(w),
        ]);
    }
    channels.extend(
        system
            .elements
            .iter()
            .flat_map(|element| element.own_channels()),
    );
    channels.extend((0..system.scene.gauges.len()).map(Channel::Gauge));
    for (s, range) in recorded(system) {
        channels.extend((0..range.len()).map(|k| Channel::Coordinate(s, k)));
        channels.extend((0..range.len()).map(|k| Channel::Acceleration(s, k)));
    }
    channels
}

/// Writes the columns of wheel `w`, whose body has its displacements in the columns `of_bodies`. The forces are left: they are
/// added by the elements.
fn write_wheel(
    system: &System,
    geometry: &Geometry,
    at: &State,
    (w, wheel): (usize, &WheelColumns),
    of_bodies: &[f64],
    own: &mut [f64; OF_WHEEL],
) {
    let (mechanics, places) = (&system.mechanics, geometry.places());
    let pressed = wheel.groups.clone().filter(|&i| geometry.fraction(i) > 0.0);
    let deepest = pressed.map(|i| at.p[i]).fold(f64::NEG_INFINITY, f64::max);
    let shape = if system.traits.is_uneven {
        mechanics.irregularity(w)
    } else {
        None
    };
    let irregular = shape.map_or(0.0, |shape| shape.vertical(places.piece[w], places.x[w])[0]);
    let down = irregular - dot(&wheel.arms, &of_bodies[OF_BODY * wheel.body..][..6]);
    own[0] = places.x[w];
    own[4] = deepest;
    own[5] = down - deepest;
    if !wheel.turns {
        return;
    }
    [own[6], own[7]] = match (mechanics.wheels[w].spin, mechanics.turn(w, at.t)) {
        (Some(number), _) => [at.q[number], at.v[number]],
        (None, turn) => turn.map_or([0.0; 2], |turn| [turn.x, turn.v]),
    };
    if mechanics.wheels[w].turn.is_some() {
        own[8] = spin_moment(system, geometry, at, w);
    }
}
