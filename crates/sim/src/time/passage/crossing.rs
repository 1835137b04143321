//! Crossings at uniform speed by power series of time, for bodies on linear wheels over a rail without mass.
//!
//! If all wheels travel together at uniform speed, G is a polynomial of time between two breaks of the rails
//! ([`path`](super::path)). Forces and motions are then power series ([`series`](super::series)) whose coefficients
//! cost a few matrix products each, without further evaluations of G and without an iteration; samples and powers are
//! evaluated from the same series. The step length follows from the last terms of the series, so no step is rejected.
//! Forces and energy are evaluated with two more terms, which nearly removes the jumps between steps.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::path::Path;
use super::series::{Contacts, Matrix, Series, TERMS, Values, subtract};
use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::mechanics::mobility::Mobility;
use crate::mechanics::state::State;
use crate::numerics::dense::solve_general;
use crate::record::energy::{Audit, stored};
use crate::record::recorder::Recorder;
use crate::time::counts::Counts;
use crate::{Error, History};

/// Largest number of contacts.
pub(crate) const WIDEST: usize = 8;

/// Allowed size of the last terms of a step, relative to the largest values, per unit of the accuracy of the run.
const LAST: f64 = 0.05;

/// Ratio of the allowed last terms of the forces, relative to the largest force, to those of the approaches, relative
/// to the largest approach.
const FORCES: f64 = 16.0;

/// Coarsest accuracy used for the step length; larger values are reduced to it.
const COARSEST: f64 = 1e-3;

/// Number of bounces over which the errors of steps add up to the accuracy allowed by [`LAST`]; for N more bounces the
/// steps are more accurate by N times the reciprocal.
const BOUNCES: f64 = 10.0;

/// Number of bounces up to which the steps are shortened.
const MOST_BOUNCES: f64 = 100.0;

/// Largest ratio of the squares of the highest frequency of a contact and of the bounce frequency of the bodies on
/// their wheels for which a series is used; stiffer scenes are left to another method.
const STIFF: f64 = 20.0;

/// Number of steps, estimated from the current step length, above which a series is not used.
const MANY: f64 = 1e4;

/// Abscissae and weights of Lobatto quadrature on [0, 1], exact to degree 13; the weight at 0 and at 1 is [`ENDS`].
const LOBATTO: [[f64; 2]; 6] = [
    [0.064_129_925_745_196_71, 0.105_352_113_571_753_04],
    [0.204_149_909_283_428_85, 0.170_561_346_241_752_15],
    [0.395_350_391_048_760_6, 0.206_229_397_329_351_9],
    [0.604_649_608_951_239_4, 0.206_229_397_329_351_9],
    [0.795_850_090_716_571_1, 0.170_561_346_241_752_15],
    [0.935_870_074_254_803_3, 0.105_352_113_571_753_04],
];
const ENDS: f64 = 1.0 / 56.0;

/// Property that the scene would need for a crossing of this kind, in addition to the requirements of collocation;
/// `None` if nothing is missing.
pub(crate) fn missing(system: &System) -> Option<&'static str> {
    let scene = system.scene;
    let mut moving = scene.bodies.iter().enumerate().filter_map(|(b, body)| Some((b, body.motion.as_ref()?)));
    let first = moving.next();
    let together = moving.next().is_none()
        && system
            .mechanics
            .wheels
            .iter()
            .all(|w| first.is_none_or(|(b, _)| system.mechanics.kinematics.root(w.body) == b));
    let uniform = first.is_none_or(|(_, motion)| motion.uniform(scene.end).is_some());
    let symmetric = system.foundations.iter().all(|f| f.compliance.as_ref().is_none_or(|c| c.is_symmetric()));
    let mounted =
        !system.mechanics.carried.is_empty() || system.foundations.iter().any(|f| f.carrier.is_some());
    let troubles = [
        (!together, "wheels that travel together"),
        (!uniform, "a uniform speed"),
        (!system.traits.has_linear_laws, "linear contacts"),
        (system.traits.is_uneven, "even rails"),
        (!system.traits.has_constant_rows || mounted, "structures without mass, on the ground"),
        (!symmetric, "a symmetric compliance"),
        (!scene.actuators.loads.is_empty() || !scene.actuators.rules.is_empty(), "no loads or events"),
        (system.elements.len() > WIDEST, "eight contacts at most"),
        (system.mechanics.dofs > system.elements.len(), "no more freedoms than contacts"),
    ];
    troubles.into_iter().find(|(found, _)| *found).map(|(_, wanted)| wanted)
}

/// Result of a crossing from the start to the end, or until the caller stopped it.
pub(crate) struct Crossed {
    pub is_stopped: bool,
    pub history: History,
    pub audit: Audit,
    pub counts: Counts,
    /// Number of bounces over which errors add up.
    pub bounces: f64,
}

/// Runs a scene for which nothing is [`missing`]. Returns `None` if a contact opens, if the wheels are too stiff, or
/// if G is not a polynomial of low degree between breaks; another method must then take the run.
///
/// # Errors
/// As [`crate::run()`].
pub(crate) fn run(
    system: &System,
    start: &State,
    placed: bool,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Crossed>, Error> {
    match system.elements.len() {
        1..=2 => Crossing::<2>::new(system, start)?.run(placed, watch),
        3..=4 => Crossing::<4>::new(system, start)?.run(placed, watch),
        5..=WIDEST => Crossing::<WIDEST>::new(system, start)?.run(placed, watch),
        _ => Ok(None),
    }
}

/// A crossing in progress; arrays over contacts and degrees of freedom are padded to P.
struct Crossing<'a, const P: usize> {
    system: &'a System<'a>,
    geometry: Geometry,
    state: State,
    travel: UniformTravel,
    contacts: Contacts<P>,
    matrices: Matrices<P>,
    q: [f64; P],
    v: [f64; P],
    series: Series<P>,
    /// Length of the last step.
    length: f64,
    audit: Audit,
    energy_at_start: f64,
    /// Largest approach and largest force so far, as magnitudes.
    largest_approach: f64,
    largest_force: f64,
}

/// The uniform travel of a crossing.
struct UniformTravel {
    /// The body with prescribed travel, and its speed.
    root: Option<usize>,
    speed: f64,
    /// Positions of the wheels along the rail at time 0.
    places: Vec<f64>,
}

/// Matrices and vectors of the degrees of freedom that are constant over a crossing.
struct Matrices<const P: usize> {
    /// R by columns of degrees of freedom, and the constant terms of the approaches.
    rows: Matrix<P>,
    constant: [f64; P],
    /// M^-1 R^T by columns of contacts; M^-1 f.
    spread: Matrix<P>,
    free_fall: [f64; P],
    /// M, the weights f, and the coupling of the momentum of the degrees of freedom with the travel.
    mass: Matrix<P>,
    weight: [f64; P],
    travel_inertia: [f64; P],
}

impl<'a, const P: usize> Crossing<'a, P> {
    fn new(system: &'a System<'a>, start: &State) -> Result<Self, Error> {
        let (n, m) = (system.mechanics.dofs, system.elements.len());
        let mut geometry = Geometry::new(system);
        geometry.update(system, 0.0, &start.q, &start.force)?;
        let zero = [[0.0; P]; P];
        let (mut rows, mut spread, mut mobile, mut mass) = (zero, zero, zero, zero);
        let mobility = Mobility::new(&system.mechanics)?;
        let mut free_fall = [0.0; P];
        let pad = |values: &[f64]| std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0));
        mobility.apply(system.mechanics.gravity.as_slice(), &mut free_fall[..n]);
        for (j, row) in geometry.rows().approach.chunks_exact(n).enumerate() {
            mobility.apply(row, &mut spread[j][..n]);
            for (column, entry) in rows.iter_mut().zip(row) {
                column[j] = *entry;
            }
        }
        let mut free = [0.0; P];
        for i in 0..P {
            for k in 0..n {
                free[i] += rows[k][i] * free_fall[k];
                for (j, column) in mobile.iter_mut().enumerate() {
                    column[i] += rows[k][i] * spread[j][k];
                }
            }
        }
        if let Some(matrix) = system.mechanics.blocks[0].body_mass() {
            for (j, column) in mass.iter_mut().enumerate().take(n) {
                column[..n].copy_from_slice(matrix.column(j).as_slice());
            }
        }
        let (mut ratio, mut damping, mut softness) = ([0.0; P], [0.0; P], [1.0; P]);
        for i in 0..m {
            let law = system.law(i);
            ratio[i] = law.damping / law.stiffness;
            damping[i] = law.damping * system.mechanics.groups[i].count();
            softness[i] = 1.0 / (law.stiffness * system.mechanics.groups[i].count());
        }
        let root = system.scene.bodies.iter().position(|body| body.motion.is_some());
        let speed = root.map_or(0.0, |root| geometry.places().travel[root].v);
        let mut travel_inertia = [0.0; P];
        for &(number, inertia) in
            root.iter().flat_map(|&root| system.mechanics.kinematics.travel_inertia(root))
        {
            travel_inertia[number] += inertia;
        }
        let constant = pad(&geometry.rows().approach_offset);
        Ok(Crossing {
            travel: UniformTravel { root, speed, places: geometry.places().x.clone() },
            matrices: Matrices {
                rows,
                constant,
                spread,
                free_fall,
                mass,
                weight: pad(system.mechanics.gravity.as_slice()),
                travel_inertia,
            },
            q: pad(start.q.as_slice()),
            v: pad(start.v.as_slice()),
            series: Series::new(order(system.scene.accuracy)),
            contacts: Contacts { mobile, free, ratio, damping, softness },
            state: start.clone(),
            audit: Audit::default(),
            energy_at_start: 0.0,
            length: 0.0,
            largest_approach: 0.0,
            largest_force: 0.0,
            system,
            geometry,
        })
    }

    fn run(
        mut self,
        placed: bool,
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Option<Crossed>, Error> {
        let system = self.system;
        let scene = system.scene;
        let softness =
            self.contacts.softness.iter().take(system.elements.len()).fold(0.0_f64, |max, s| max.max(*s));
        let mut recorder = Recorder::new(system);
        recorder.reserve_for(scene);
        let mut counts = Counts::default();
        let quick = |i: usize| self.contacts.softness[i] / self.contacts.mobile[i][i];
        let quickest = (0..system.elements.len()).map(quick).fold(f64::INFINITY, f64::min);
        let carried = scene.bodies.iter().map(|body| body.mass).sum::<f64>() / system.elements.len() as f64;
        if carried * softness > STIFF * quickest {
            return Ok(None);
        }
        let allowed = LAST * scene.accuracy.min(COARSEST)
            / (self.bounces(quickest).min(MOST_BOUNCES) / BOUNCES).max(1.0);
        let (mut t, mut scale, mut next) = (0.0, quickest.sqrt(), 0_u64);
        for end in self.breaks() {
            let path =
                Path::new(system, &mut self.geometry, &self.state, [t, end], self.travel.speed, softness)?;
            let Some(path) = path else { return Ok(None) };
            if t == 0.0 && !(placed || self.rest(&path.about(0.0, 1.0)[0])) {
                return Ok(None);
            }
            while t < end {
                let compliance = path.about(t, scale);
                let approach = self.approach(&self.q, true);
                let rate = self.approach(&self.v, false);
                self.largest_approach =
                    approach.iter().fold(self.largest_approach, |max, w| max.max(w.abs()));
                if self.series.expand(&self.contacts, &compliance, scale, [&approach, &rate]).is_none() {
                    return Ok(None);
                }
                let force = self.series.first().force;
                self.largest_force = force.iter().fold(self.largest_force, |max, force| max.max(force.abs()));
                // An error of an approach by this much changes a force by the fraction of the largest one.
                let yielding = self.yielding(&compliance[0]).min(self.largest_approach);
                let wanted =
                    scale * self.series.reach(allowed * yielding, FORCES * allowed * self.largest_force);
                let count = ((end - t) / wanted).ceil().max(1.0);
                let worthwhile = scene.end < MANY * wanted;
                if !worthwhile {
                    return Ok(None);
                }
                let h = (end - t) / count;
                if t == 0.0 && !self.begin(&compliance[0]) {
                    return Ok(None);
                }
                let to = if count == 1.0 { end } else { t + h };
                while scene.output_time(next) <= to {
                    let at = scene.output_time(next);
                    self.sample(at, (at - t) / scale, &compliance);
                    recorder.record(system, &self.geometry, &self.state)?;
                    next += 1;
                }
                if !self.step(h) {
                    return Ok(None);
                }
                counts.steps += 1;
                counts.stages += self.series.order;
                (t, scale) = (to, h);
                if watch(t).is_break() {
                    let bounces = self.bounces(quickest);
                    return self.finish(true, t, recorder, (counts, bounces)).map(Some);
                }
            }
        }
        let bounces = self.bounces(quickest);
        self.finish(false, t, recorder, (counts, bounces)).map(Some)
    }

    /// Number of bounces in the run over which errors add up, with `quickest` the reciprocal square of the
    /// highest frequency of a contact, whose damping limits it to 1 + 1/(2 pi zeta).
    fn bounces(&self, quickest: f64) -> f64 {
        let omega = quickest.sqrt().recip();
        let ratio =
            self.contacts.ratio[..self.system.elements.len()].iter().fold(f64::INFINITY, |a, b| a.min(*b));
        (self.system.scene.end * omega / TAU).min(1.0 + 2.0 / (TAU * ratio * omega))
    }

    /// Completes the run after a step that ended at `t`.
    fn finish(
        mut self,
        is_stopped: bool,
        t: f64,
        recorder: Recorder,
        (counts, bounces): (Counts, f64),
    ) -> Result<Crossed, Error> {
        let [at] = self.series.at([self.length / self.series.scale]);
        let (q, v) = (self.q, self.v);
        self.fill(t, &q, &v, &at);
        self.geometry.update(self.system, t.next_down(), &self.state.q, &self.state.force)?;
        self.audit.end = stored(self.system, &self.geometry, &self.state);
        let (history, audit) = (recorder.into_history(), self.audit);
        Ok(Crossed { is_stopped, history, audit, counts, bounces })
    }

    /// Approach of the stiffest contact under the largest force on each contact: the smallest row sum of G + 1/k, times
    /// this force.
    fn yielding(&self, compliance: &Matrix<P>) -> f64 {
        let m = self.system.elements.len();
        let row = |i: usize| (0..m).map(|j| compliance[j][i].abs()).sum::<f64>() + self.contacts.softness[i];
        (0..m).map(row).fold(f64::INFINITY, f64::min) * self.largest_force
    }

    /// Times at which wheels meet breaks of their rails, followed by the end time.
    fn breaks(&self) -> Vec<f64> {
        let system = self.system;
        let end = system.scene.end;
        let mut times = vec![end];
        for (wheel, x) in
            system.mechanics.wheels.iter().zip(&self.travel.places).filter(|_| self.travel.speed != 0.0)
        {
            let contact = &system.scene.contacts[wheel.contact];
            let to = x + self.travel.speed * end;
            let places = system.mechanics.breaks.between(contact.structure, contact.rail, *x, to);
            times.extend(places.map(|place| (place - x) / self.travel.speed));
        }
        let sliver = 1e-12 * end;
        times.retain(|t| *t > sliver && (*t < end - sliver || *t == end));
        times.sort_by(f64::total_cmp);
        times.dedup_by(|b, a| *b - *a < sliver);
        if let Some(last) = times.last_mut() {
            *last = end;
        }
        times
    }

    /// Approaches, constant + R q, or their rates, R v.
    fn approach(&self, freedoms: &[f64; P], with_constant: bool) -> [f64; P] {
        let mut sum = if with_constant { self.matrices.constant } else { [0.0; P] };
        for (column, q) in self.matrices.rows.iter().zip(freedoms) {
            for (sum, entry) in sum.iter_mut().zip(column) {
                *sum += entry * q;
            }
        }
        sum
    }

    /// Sets the degrees of freedom to static equilibrium: A F - R q = constant, R^T F = f. Returns false if the
    /// equations have no solution.
    fn rest(&mut self, compliance: &Matrix<P>) -> bool {
        let (n, m) = (self.system.mechanics.dofs, self.system.elements.len());
        let size = n + m;
        let mut matrix = vec![0.0; size * size];
        let mut right = vec![0.0; size];
        for i in 0..m {
            for j in 0..m {
                matrix[i * size + j] = compliance[i][j];
            }
            matrix[i * size + i] += self.contacts.softness[i];
            for k in 0..n {
                matrix[i * size + m + k] = -self.matrices.rows[k][i];
                matrix[(m + k) * size + i] = self.matrices.rows[k][i];
            }
            right[i] = self.matrices.constant[i];
        }
        right[m..].copy_from_slice(&self.matrices.weight[..n]);
        if !solve_general(&mut matrix, &mut right) || right.iter().any(|x| !x.is_finite()) {
            return false;
        }
        self.q[..n].copy_from_slice(&right[m..]);
        true
    }

    /// Starts the audit at the start of the first step; returns false if a contact is not pressed there.
    fn begin(&mut self, compliance: &Matrix<P>) -> bool {
        let look = self.series.first();
        let (p, _) = self.penetration(&look);
        let presses = |i: usize| (look.force[i] >= 0.0 && p[i] > 0.0) || self.system.law(i).bilateral;
        if !(0..self.system.elements.len()).all(presses) {
            return false;
        }
        let (q, v) = (self.q, self.v);
        self.fill(0.0, &q, &v, &look);
        self.fill_compliance(compliance);
        self.audit.start = stored(self.system, &self.geometry, &self.state);
        self.energy_at_start = self.energy(&q, &v, &look)[0];
        true
    }

    /// Penetration p = F/k - r w' and its rate.
    fn penetration(&self, at: &Values<P>) -> ([f64; P], [f64; P]) {
        let Contacts { mobile, free, ratio, softness, .. } = &self.contacts;
        let mut lift = *free;
        subtract(mobile, &at.force, &mut lift);
        (
            std::array::from_fn(|i| at.force[i] * softness[i] - ratio[i] * at.rate[i]),
            std::array::from_fn(|i| at.force_rate[i] * softness[i] - ratio[i] * lift[i]),
        )
    }

    /// Displacements and speeds of the degrees of freedom at the scaled time `s` of the step.
    fn moved(&self, s: f64) -> [[f64; P]; 2] {
        let time = s * self.series.scale;
        let [once, twice] = self.series.impulse(s);
        let mut q =
            std::array::from_fn(|k| self.q[k] + time * (self.v[k] + 0.5 * time * self.matrices.free_fall[k]));
        let mut v = std::array::from_fn(|k| self.v[k] + time * self.matrices.free_fall[k]);
        subtract(&self.matrices.spread, &twice, &mut q);
        subtract(&self.matrices.spread, &once, &mut v);
        [q, v]
    }

    /// Stored energy without its constant part, and the elastic part of it.
    fn energy(&self, q: &[f64; P], v: &[f64; P], at: &Values<P>) -> [f64; 2] {
        let (p, _) = self.penetration(at);
        let (mut elastic, mut rest) = (0.0, 0.0);
        for (i, p) in p.iter().enumerate() {
            elastic += 0.5 * (p * p / self.contacts.softness[i] + at.force[i] * (at.approach[i] - p));
        }
        for (k, column) in self.matrices.mass.iter().enumerate() {
            let momentum: f64 = column.iter().zip(v).map(|(entry, v)| entry * v).sum();
            rest += (0.5 * momentum + self.travel.speed * self.matrices.travel_inertia[k]) * v[k]
                - self.matrices.weight[k] * q[k];
        }
        [elastic + rest, elastic]
    }

    /// Takes the step of length `h` and adds it to the audit; returns false if a contact would have to pull.
    fn step(&mut self, h: f64) -> bool {
        let end = h / self.series.scale;
        self.length = h;
        let (mut dampers, mut drives) = (0.0, 0.0);
        let mut book = |at: &Values<P>, weight: f64| {
            let power = self.power(at);
            dampers += h * weight * power[0];
            drives += h * weight * power[1];
        };
        let [a, b, c, d, e, f] = LOBATTO.map(|[place, _]| place * end);
        let looks = self.series.at([a, b, c, d, e, f, end]);
        book(&self.series.first(), ENDS);
        for (at, weight) in looks.iter().zip(LOBATTO.map(|[_, weight]| weight).into_iter().chain([ENDS])) {
            book(at, weight);
        }
        self.audit.exchanged.dampers += dampers;
        self.audit.exchanged.drives += drives;
        let [.., at] = &looks;
        [self.q, self.v] = self.moved(end);
        let [total, elastic] = self.energy(&self.q, &self.v, at);
        self.audit.peak_stored = self.audit.peak_stored.max(elastic);
        let imbalance = (total + self.audit.exchanged.net_loss() - self.energy_at_start).abs();
        self.audit.imbalance = self.audit.imbalance.max(imbalance);
        let pulls = |i: usize| looks.iter().any(|at| at.force[i] < 0.0) && !self.system.law(i).bilateral;
        total.is_finite() && !(0..self.system.elements.len()).any(pulls)
    }

    /// Power dissipated in the dampers, c w' p', and power supplied by the travel, -1/2 F dG/dt F, where u = w - p is
    /// the deflection and F dG/dt F = F u' - u F'.
    fn power(&self, at: &Values<P>) -> [f64; 2] {
        let (p, p_rate) = self.penetration(at);
        let (mut dampers, mut drives) = (0.0, 0.0);
        for (i, (p, p_rate)) in p.iter().zip(&p_rate).enumerate() {
            let (give, give_rate) = (at.approach[i] - p, at.rate[i] - p_rate);
            dampers += self.contacts.damping[i] * at.rate[i] * p_rate;
            drives -= 0.5 * (at.force[i] * give_rate - give * at.force_rate[i]);
        }
        [dampers, drives]
    }

    /// Sets state and geometry to time `t`, at the scaled time `s` of the step.
    fn sample(&mut self, t: f64, s: f64, compliance: &[Matrix<P>; TERMS]) {
        let [look] = self.series.at([s]);
        let [q, v] = self.moved(s);
        self.fill(t, &q, &v, &look);
        if self.travel.root.is_none() {
            return;
        }
        if self.travel.speed == 0.0 {
            // the slopes of G are still those of the last evaluation, at the same places
            self.geometry.update_rail_slope(self.system, &self.state.q, &self.state.force);
            return;
        }
        // Half of dG/dx times the forces; its product with the forces is the longitudinal force of all wheels.
        let mut slope = [0.0; P];
        let mut power = -0.5 / (self.series.scale * self.travel.speed);
        for (k, matrix) in compliance.iter().enumerate().skip(1) {
            let scaled = look.force.map(|force| force * power * k as f64);
            subtract(matrix, &scaled, &mut slope);
            power *= s;
        }
        let count = self.system.elements.len();
        self.geometry.set_rail_slope(&slope[..count]);
    }

    fn fill(&mut self, t: f64, q: &[f64; P], v: &[f64; P], look: &Values<P>) {
        let (p, p_rate) = self.penetration(look);
        let (n, m) = (self.system.mechanics.dofs, self.system.elements.len());
        let mut a = self.matrices.free_fall;
        subtract(&self.matrices.spread, &look.force, &mut a);
        self.state.t = t;
        self.state.q.as_mut_slice().copy_from_slice(&q[..n]);
        self.state.v.as_mut_slice().copy_from_slice(&v[..n]);
        self.state.a.as_mut_slice().copy_from_slice(&a[..n]);
        self.state.p.copy_from_slice(&p[..m]);
        self.state.p_rate.copy_from_slice(&p_rate[..m]);
        self.state.force.copy_from_slice(&look.force[..m]);
        self.geometry.move_uniformly(
            self.system,
            &self.travel.places,
            self.travel.speed,
            t,
            self.travel.root,
        );
    }

    fn fill_compliance(&mut self, compliance: &Matrix<P>) {
        self.geometry.set_compliance(compliance.iter());
    }
}

/// Number of coefficients of the forces for an accuracy: a multiple of 4 plus 2. Taylor methods of other orders need
/// shorter steps along the imaginary axis, where the eigenvalues of oscillations lie.
fn order(accuracy: f64) -> usize {
    let more = ((-accuracy.log10() - 2.5) / 2.5).clamp(0.0, 3.0) as usize;
    10 + 4 * more
}
