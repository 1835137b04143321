//! The contacts where the wheels are now: places, compliance, and the rows between freedoms and components.

use nalgebra::DVector;
use splines::{Influence, Probe};

use crate::contact::link::{Hold, Link};
use crate::contact::path::Way;
use crate::contact::switches::Switches;
use crate::contact::system::{Entry, System};
use crate::mechanics::state::State;
use crate::mechanics::wheels::WheelPoint;
use crate::numerics::dense::along;
use crate::scene::dof::arm_rows;
use crate::{Error, Freedom, Moving};

/// Index of the roll among the displacements of a body.
const ROLL: usize = Freedom::Roll as usize;

/// Rows that stay as they are.
#[derive(Clone)]
struct Fixed {
    rows: Vec<f64>,
    held: Vec<f64>,
    rate_rows: Vec<f64>,
}

/// Everything about the contacts that depends on where the wheels are.
#[derive(Clone)]
pub(crate) struct Geometry {
    /// Travel of each body whose x is prescribed.
    pub travel: Vec<Moving>,
    /// Rail coordinate of each wheel.
    pub x: Vec<f64>,
    /// Piece of the uneven rail that each wheel is on.
    pub piece: Vec<usize>,
    /// Height of each wheel's centre above its rail, from the last solution.
    pub height: Vec<f64>,
    /// Share of each vertical contact's law that acts, and its slope along the rail.
    pub share: Vec<[f64; 2]>,
    /// G over components, row-major.
    pub compliance: Vec<f64>,
    /// d G(i, j)/d x_i over components, row-major.
    pub slope: Vec<f64>,
    /// d G(i, j)/d x by the place of each tread of component i, over components j, row-major.
    pub by_tread: Vec<f64>,
    /// Approach e = `held` + `rows` q, before the give of G.
    pub rows: Vec<f64>,
    pub held: Vec<f64>,
    /// Rows of the forces, `rows` and the force along the rail from its slope: f = -`force_rows`^T F.
    pub force_rows: Vec<f64>,
    /// Rates that dampers and friction feel: `rate_held` + `rate_rows` v.
    pub rate_rows: Vec<f64>,
    pub rate_held: Vec<f64>,
    /// Whether each drive or brake acts.
    pub pulls: Vec<bool>,
    /// Ropes and stops.
    pub links: Vec<Hold>,
    /// What rules have switched.
    pub switches: Switches,
    /// Growth of each approach along the rail by the shape of the unloaded rail, d e/d x.
    pub rise: Vec<f64>,
    /// Slope of the deflected rail under each component, d u/d x, that of its own shape included.
    pub rail_slope: Vec<f64>,
    influence: Vec<Influence>,
    /// Way of a wheel, beside its radius, over which the compliance of its rail is carried by its slope.
    pub near: f64,
    /// Where the influence of each structure was found, and how far each wheel is from there.
    probes: Vec<Vec<Probe>>,
    moved: Vec<Vec<f64>>,
    /// The way of each structure's wheels in this step, and how far from it they may be.
    ways: Vec<Option<Way>>,
    pub reach: f64,
    /// Whether the compliance of a structure is that of its way.
    is_on_way: Vec<bool>,
    shape: Vec<f64>,
    shape_slope: Vec<f64>,
    /// Slopes of the structures' shapes under each component, over the freedoms, row-major.
    shape_slopes: Vec<f64>,
    fixed: Fixed,
    built: bool,
}

impl Geometry {
    pub fn new(system: &System) -> Self {
        let (m, n) = (system.components(), system.mechanics.dofs);
        let mut geometry = Geometry {
            fixed: Fixed { rows: vec![0.0; m * n], held: vec![0.0; m], rate_rows: vec![0.0; m * n] },
            travel: vec![Moving::default(); system.scene.bodies.len()],
            x: vec![0.0; system.mechanics.wheels.len()],
            piece: vec![0; system.mechanics.wheels.len()],
            height: system
                .mechanics
                .wheels
                .iter()
                .map(|wheel| system.scene.wheels[wheel.kind].radius)
                .collect(),
            share: vec![[1.0, 0.0]; system.mechanics.groups.len()],
            compliance: vec![0.0; m * m],
            slope: vec![0.0; m * m],
            by_tread: vec![0.0; m * system.treads.len()],
            rows: vec![0.0; m * n],
            held: vec![0.0; m],
            force_rows: vec![0.0; m * n],
            rate_rows: vec![0.0; m * n],
            rate_held: vec![0.0; m],
            pulls: vec![false; system.pulls.len()],
            links: vec![Hold::default(); system.links.len()],
            switches: Switches::new(&system.scene.actuators),
            rise: vec![0.0; m],
            rail_slope: vec![0.0; m],
            influence: system.entries.iter().map(|entries| Influence::zeros(entries.len())).collect(),
            probes: system.entries.iter().map(|e| e.iter().map(|entry| entry.probe).collect()).collect(),
            near: 0.0,
            moved: system.entries.iter().map(|entries| vec![0.0; entries.len()]).collect(),
            ways: Way::all(system),
            reach: 0.0,
            is_on_way: vec![false; system.entries.len()],
            shape: vec![0.0; n],
            shape_slope: vec![0.0; n],
            shape_slopes: vec![0.0; m * n],
            built: false,
        };
        geometry.fill_rows(system);
        geometry
    }

    /// Approach of component `i` at the freedoms `q`, before the give of the compliance.
    pub fn approach(&self, i: usize, q: &DVector<f64>) -> f64 {
        self.held[i] + along(&self.rows, i, q.as_slice())
    }

    /// Rate that the damper or the friction of component `i` feels at the speeds `v` of the freedoms.
    pub fn rate(&self, i: usize, v: &DVector<f64>) -> f64 {
        self.rate_held[i] + along(&self.rate_rows, i, v.as_slice())
    }

    /// Updates everything for the wheels' places at (t, q); `force` are the latest forces, for the rail's slope.
    pub fn update(&mut self, system: &System, t: f64, q: &DVector<f64>, force: &[f64]) -> Result<(), Error> {
        self.travel(system, t);
        for w in 0..system.mechanics.wheels.len() {
            self.x[w] = self.place(system, w, q);
        }
        self.update_compliance(system)?;
        let rows_stand = self.built && system.constant_rows;
        self.built = true;
        if rows_stand {
            return Ok(());
        }
        self.update_rows(system)?;
        for (i, &w) in system.tractions.iter().enumerate() {
            let spin = system.mechanics.turn(w, t).map_or(0.0, |at| at.v * self.height[w]);
            let travel = self.travel[system.mechanics.kinematics.root(system.mechanics.wheels[w].body)].v;
            self.rate_held[system.traction(i)] = travel + spin;
        }
        for (i, pull) in system.pulls.iter().enumerate() {
            let reference = pull.reference(system.scene, &self.switches, t);
            self.pulls[i] = reference.is_some();
            self.rate_held[system.pull(i)] = -reference.unwrap_or(0.0);
        }
        self.update_links(system, t, q);
        self.update_force_rows(system, q, force)
    }

    fn travel(&mut self, system: &System, t: f64) {
        for (travel, body) in self.travel.iter_mut().zip(&system.scene.bodies) {
            if let Some(profile) = &body.motion {
                *travel = profile.at(t);
            }
        }
    }

    /// Rail coordinate of wheel `w` at the freedoms `q`, its prescribed travel being that of the last update.
    pub fn place(&self, system: &System, w: usize, q: &DVector<f64>) -> f64 {
        let wheel = &system.mechanics.wheels[w];
        let body = &system.scene.bodies[wheel.body];
        if body.pinned.is_some() {
            return self.pinned_x(system, wheel, q);
        }
        let numbers = &system.mechanics.kinematics.numbers[wheel.body];
        let value = |i: usize| numbers[i].map_or(body.start[i], |number| q[number]);
        let x = if body.motion.is_some() { self.travel[wheel.body].x } else { value(0) };
        x + wheel.hub[0] + value(4) * wheel.hub[2] - value(5) * wheel.hub[1]
    }

    /// Rail coordinate of a wheel whose body is pinned to another.
    fn pinned_x(&self, system: &System, wheel: &WheelPoint, q: &DVector<f64>) -> f64 {
        let kinematics = &system.mechanics.kinematics;
        let (moved, held) = (kinematics.apply(wheel.body, q), kinematics.constant(wheel.body));
        let root = kinematics.root(wheel.body);
        let travel = if system.scene.bodies[root].motion.is_some() { self.travel[root].x } else { 0.0 };
        let value = |i: usize| moved[i] + held[i];
        travel + value(0) + wheel.hub[0] + value(4) * wheel.hub[2] - value(5) * wheel.hub[1]
    }

    fn update_compliance(&mut self, system: &System) -> Result<(), Error> {
        let m = system.components();
        for (s, entries) in system.entries.iter().enumerate() {
            let foundation = &system.foundations[s];
            if let Some(chains) = &foundation.parts {
                for (normal, share) in system.mechanics.groups.iter().zip(&mut self.share) {
                    let contact = &system.scene.contacts[normal.contact];
                    if let (true, Some(part)) = (contact.structure == s, normal.part) {
                        let chain = &chains[contact.rail];
                        let mean = normal.wheels.clone().map(|w| self.x[w]).sum::<f64>() / normal.count();
                        *share = chain.share(part, mean);
                    }
                }
            }
            let Some(compliance) = &foundation.compliance else { continue };
            if let Some(way) = &mut self.ways[s]
                && way.follow(&self.x, self.reach)
            {
                way.put(m, [&mut self.compliance, &mut self.slope, &mut self.by_tread]);
                self.is_on_way[s] = true;
                continue;
            }
            let influence = &mut self.influence[s];
            let (probes, moved) = (&mut self.probes[s], &mut self.moved[s]);
            let (mut farthest, mut changed) = (0.0_f64, std::mem::take(&mut self.is_on_way[s]));
            for ((moved, probe), entry) in moved.iter_mut().zip(&*probes).zip(entries) {
                let now = self.x[entry.wheel] - probe.x;
                changed |= now != *moved;
                *moved = now;
                let radius = system.scene.wheels[system.mechanics.wheels[entry.wheel].kind].radius;
                farthest = farthest.max(now.abs() / radius);
            }
            if self.built && farthest <= if compliance.is_symmetric() { self.near } else { 0.0 } {
                if changed {
                    self.carry(system, s);
                }
                continue;
            }
            moved.fill(0.0);
            for (probe, entry) in probes.iter_mut().zip(entries) {
                probe.x = self.x[entry.wheel];
            }
            compliance
                .fill(probes, influence)
                .map_err(|source| Error::Compliance { structure: s, source })?;
            if system.is_direct[s] {
                transpose(influence.value.as_slice(), &mut self.compliance, m);
                transpose(influence.slope.as_slice(), &mut self.slope, m);
                continue;
            }
            self.carry(system, s);
        }
        Ok(())
    }

    /// Lays the ways of all wheels from a time and freedoms, to the second of those that are to come or to the first, so that no
    /// cell of a rail ends before it. Ways that lead to the first already stay.
    pub fn lay(&mut self, system: &System, ends: [(f64, &DVector<f64>); 3]) {
        if self.ways.iter().all(Option::is_none) {
            return;
        }
        let places = ends.map(|(t, q)| {
            self.travel(system, t);
            (0..system.mechanics.wheels.len()).map(|w| self.place(system, w, q)).collect::<Vec<_>>()
        });
        let [from, to, beyond] = places.each_ref().map(Vec::as_slice);
        for (s, way) in self.ways.iter_mut().enumerate() {
            let (Some(way), foundation, entries) = (way, &system.foundations[s], &system.entries[s]) else {
                continue;
            };
            if way.leads_to(from, self.reach) && way.leads_to(to, self.reach) {
                continue;
            }
            let is_free = |start: &[f64], end: &[f64]| {
                !entries.iter().any(|Entry { wheel, probe, .. }| {
                    foundation.breaks_between(probe.rail, start[*wheel], end[*wheel]).next().is_some()
                })
            };
            let inner = |end: &[f64]| -> [Vec<f64>; 2] {
                let of =
                    |k: usize| (0..from.len()).map(|w| within([from[w], end[w]], self.reach)[k]).collect();
                [of(0), of(1)]
            };
            // What the rail refuses, it refuses the step itself.
            let ends = [beyond, to].map(inner).into_iter().find(|[start, end]| is_free(start, end));
            let laid = ends.zip(foundation.compliance.as_ref()).is_some_and(|(ends, compliance)| {
                let goes_on = is_free(way.end(), &ends[0]);
                way.lay(compliance.as_ref(), ends.each_ref().map(Vec::as_slice), self.reach, goes_on).is_ok()
            });
            if !laid {
                way.leave();
            }
        }
    }

    /// Forgets the ways.
    pub fn leave(&mut self) {
        self.ways.iter_mut().flatten().for_each(Way::leave);
    }

    /// Sums the compliance of structure `s` over its components, with what the wheels moved since it was found:
    /// G + dG/dx moved.
    fn carry(&mut self, system: &System, s: usize) {
        let (m, entries) = (system.components(), &system.entries[s]);
        let (influence, moved) = (&self.influence[s], &self.moved[s]);
        for row in entries {
            self.compliance[row.component * m..(row.component + 1) * m].fill(0.0);
            self.slope[row.component * m..(row.component + 1) * m].fill(0.0);
            if let Some(tread) = row.tread {
                self.by_tread[tread * m..(tread + 1) * m].fill(0.0);
            }
        }
        let count = entries.len();
        let (values, slopes) = (influence.value.as_slice(), influence.slope.as_slice());
        for (i, row) in entries.iter().enumerate() {
            let span = row.component * m..(row.component + 1) * m;
            let (sums, rates) = (&mut self.compliance[span.clone()], &mut self.slope[span]);
            // The values are symmetric; their slope by the column's place is that of the mirrored entry.
            let mirrored = &slopes[i * count..(i + 1) * count];
            for (j, column) in entries.iter().enumerate() {
                let weight = row.weight * column.weight;
                let (value, slope) = (values[i + j * count], slopes[i + j * count]);
                sums[column.component] += weight * (value + slope * moved[i] + mirrored[j] * moved[j]);
                rates[column.component] += weight * slope;
                if let Some(tread) = row.tread {
                    self.by_tread[tread * m + column.component] += weight * slope;
                }
            }
        }
    }

    /// Rows and what is held of them, as far as they are the same wherever the wheels are; flanges as if the wheels had no
    /// height.
    fn fill_rows(&mut self, system: &System) {
        let n = system.mechanics.dofs;
        let put =
            |rows: &mut [f64], held: &mut f64, component: usize, body: usize, row: [f64; 6], scale: f64| {
                let (terms, start) =
                    (system.mechanics.kinematics.terms(body), system.mechanics.kinematics.constant(body));
                for (i, entry) in row.into_iter().enumerate() {
                    for &(number, coefficient) in &terms[i] {
                        rows[component * n + number] += scale * entry * coefficient;
                    }
                    if i > 0 {
                        *held += scale * entry * start[i];
                    }
                }
            };
        let Fixed { rows, held, rate_rows } = &mut self.fixed;
        for (component, normal) in system.mechanics.groups.iter().enumerate() {
            for w in normal.wheels.clone() {
                let wheel = &system.mechanics.wheels[w];
                let (row, share) = (arm_rows(wheel.hub)[1], -1.0 / normal.count());
                put(rows, &mut held[component], component, wheel.body, row, share);
            }
            let span = component * n..(component + 1) * n;
            rate_rows[span.clone()].copy_from_slice(&rows[span]);
        }
        for (i, &w) in system.laterals.iter().enumerate() {
            let (component, wheel) = (system.lateral(i), &system.mechanics.wheels[w]);
            put(rows, &mut held[component], component, wheel.body, arm_rows(wheel.hub)[2], 1.0);
        }
        let mut unused = 0.0;
        for (i, &w) in system.tractions.iter().enumerate() {
            let (component, wheel) = (system.traction(i), &system.mechanics.wheels[w]);
            put(rate_rows, &mut unused, component, wheel.body, arm_rows(wheel.hub)[0], 1.0);
        }
        for (i, pull) in system.pulls.iter().enumerate() {
            put(rate_rows, &mut unused, system.pull(i), pull.body, pull.row, 1.0);
        }
    }

    fn update_rows(&mut self, system: &System) -> Result<(), Error> {
        let n = system.mechanics.dofs;
        self.rows.copy_from_slice(&self.fixed.rows);
        self.rate_rows.copy_from_slice(&self.fixed.rate_rows);
        self.held.copy_from_slice(&self.fixed.held);
        if system.mechanics.has_structures() {
            self.shape_slopes.fill(0.0);
        }
        for (i, &w) in system.laterals.iter().enumerate() {
            let (component, wheel) = (system.lateral(i), &system.mechanics.wheels[w]);
            // Where the rail is, below the hub.
            let by_height = arm_rows([0.0, -self.height[w], 0.0])[2][ROLL];
            for &(number, coefficient) in &system.mechanics.kinematics.terms(wheel.body)[ROLL] {
                self.rows[component * n + number] += by_height * coefficient;
            }
            self.held[component] += by_height * system.mechanics.kinematics.constant(wheel.body)[ROLL];
        }
        if system.is_uneven {
            self.update_shape(system);
        }
        for (i, &w) in system.tractions.iter().enumerate() {
            if let Some(spin) = system.mechanics.wheels[w].spin {
                self.rate_rows[system.traction(i) * n + spin] += self.height[w];
            }
        }
        for (s, entries) in system.entries.iter().enumerate() {
            let Some(structure) = &system.foundations[s].structure else { continue };
            let range = system.mechanics.structures[s].clone();
            let size = range.len();
            for entry in entries {
                let at = Probe { x: self.x[entry.wheel], ..entry.probe };
                let (value, slope) = (&mut self.shape[..size], &mut self.shape_slope[..size]);
                structure
                    .shapes
                    .row(at, value, slope)
                    .map_err(|source| Error::Compliance { structure: s, source })?;
                let span = entry.component * n + range.start..entry.component * n + range.end;
                let is_along = system.drags().contains(&entry.component);
                let rows = if is_along { &mut self.rate_rows } else { &mut self.rows };
                for (target, shape) in rows[span.clone()].iter_mut().zip(value.iter()) {
                    *target -= entry.weight * shape;
                }
                for (target, shape) in self.shape_slopes[span].iter_mut().zip(slope.iter()) {
                    *target += entry.weight * shape;
                }
            }
        }
        Ok(())
    }

    /// Adds the shapes of unloaded rails to the approaches: y0 up brings the rail nearer, z0 takes it along.
    fn update_shape(&mut self, system: &System) {
        self.rise.fill(0.0);
        for (component, normal) in system.mechanics.groups.iter().enumerate() {
            for w in normal.wheels.clone() {
                if let Some(shape) = system.mechanics.irregularity(w) {
                    let [height, slope] = shape.vertical(self.piece[w], self.x[w]);
                    self.held[component] += height / normal.count();
                    self.rise[component] += slope / normal.count();
                }
            }
        }
        for (i, &w) in system.laterals.iter().enumerate() {
            if let Some(shape) = system.mechanics.irregularity(w) {
                let [place, slope] = shape.lateral(self.piece[w], self.x[w]);
                self.held[system.lateral(i)] -= place;
                self.rise[system.lateral(i)] = -slope;
            }
        }
    }

    /// Slope of the deflected rail under each component that presses, for the forces and freedoms given and the wheels
    /// where the last update found them. Where nothing presses, nothing feels it: zero.
    pub fn update_rail_slope(&mut self, system: &System, q: &DVector<f64>, force: &[f64]) {
        for (i, own) in force.iter().enumerate() {
            if *own == 0.0 {
                self.rail_slope[i] = 0.0;
                continue;
            }
            self.rail_slope[i] = along(&self.slope, i, force);
            if system.mechanics.has_structures() {
                self.rail_slope[i] += along(&self.shape_slopes, i, q.as_slice());
            }
            if system.is_uneven {
                self.rail_slope[i] -= self.rise[i];
            }
        }
    }

    /// Rows of the forces: those of the approach, less the rail's slope times the rows of the wheel's x.
    fn update_force_rows(&mut self, system: &System, q: &DVector<f64>, force: &[f64]) -> Result<(), Error> {
        let n = system.mechanics.dofs;
        let first_traction = system.traction(0);
        self.force_rows.copy_from_slice(&self.rows);
        self.force_rows[first_traction * n..].copy_from_slice(&self.rate_rows[first_traction * n..]);
        if !system.moves_freely {
            return Ok(());
        }
        self.update_rail_slope(system, q, force);
        let mut tilt = |component: usize, w: usize| {
            let wheel = &system.mechanics.wheels[w];
            let row = arm_rows(wheel.hub)[0];
            for (i, coefficient) in row.iter().enumerate().filter(|(_, c)| **c != 0.0) {
                for &(number, share) in &system.mechanics.kinematics.terms(wheel.body)[i] {
                    self.force_rows[component * n + number] -=
                        self.rail_slope[component] * coefficient * share;
                }
            }
        };
        for (component, normal) in system.mechanics.groups.iter().enumerate() {
            tilt(component, normal.wheels.start);
        }
        for (i, &w) in system.laterals.iter().enumerate() {
            tilt(system.lateral(i), w);
        }
        Ok(())
    }
}

impl Geometry {
    /// Rows, approaches and rates of the links at (t, q); prescribed motions are where they are at t.
    pub fn update_links(&mut self, system: &System, t: f64, q: &DVector<f64>) {
        let n = system.mechanics.dofs;
        for (index, link) in system.links.iter().enumerate() {
            let component = system.link(index);
            let natural = match link {
                Link::Rope { .. } => self.switches.natural(&system.scene.actuators, index, t),
                Link::Stop { .. } => [0.0; 2],
            };
            let [approach, rate] =
                link.read(&system.mechanics, &self.travel, t, q, natural, &mut self.links[index]);
            let span = component * n..(component + 1) * n;
            let row = &mut self.rows[span.clone()];
            row.fill(0.0);
            link.add_row(&system.mechanics, (t, q), self.links[index].direction, row);
            self.rate_rows[span].copy_from_slice(&self.rows[component * n..(component + 1) * n]);
            self.held[component] = approach - along(&self.rows, component, q.as_slice());
            self.rate_held[component] = rate;
        }
    }

    /// The force by which link `index` pulls or pushes at `at`; negative where it must not act: the lesser of its law
    /// and its spring, since the damper's force may jump where it begins.
    pub fn margin(&self, system: &System, index: usize, at: &State) -> f64 {
        let (component, hold) = (system.link(index), &self.links[index]);
        let p = self.approach(component, &at.q);
        hold.law(p, self.rate(component, &at.v)).min(hold.stiffness * p)
    }

    /// Finds which links act at `at`.
    pub fn settle_links(&mut self, system: &System, at: &State) {
        for index in 0..system.links.len() {
            let holds = !self.switches.is_released(index);
            self.links[index].taut = holds && self.margin(system, index, at) > 0.0;
        }
    }
}

/// A stretch of the rail without its ends, which may lie at a break: a quarter of `reach` less, or of itself.
fn within([from, to]: [f64; 2], reach: f64) -> [f64; 2] {
    let off = 0.25 * (to - from).clamp(-reach, reach);
    [from + off, to - off]
}

/// Copies the first rows and columns of a column-major square matrix into a row-major one of `m` columns, in tiles
/// that stay in the cache.
fn transpose(from: &[f64], to: &mut [f64], m: usize) {
    const TILE: usize = 16;
    let size = from.len().isqrt();
    for first in (0..size).step_by(TILE) {
        let rows = first..(first + TILE).min(size);
        for left in (0..size).step_by(TILE) {
            for i in rows.clone() {
                for j in left..(left + TILE).min(size) {
                    to[i * m + j] = from[j * size + i];
                }
            }
        }
    }
}
