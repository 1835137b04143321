//! Crossings at uniform speed by power series of time, for bodies on linear wheels over a rail without mass.
//!
//! If all wheels travel together at uniform speed, G is a polynomial of time between two breaks of the rails
//! ([`path`](super::path)). Forces and motions are then power series ([`series`](super::series)) whose coefficients
//! cost a few matrix products each, without further evaluations of G and without an iteration; samples and powers are
//! evaluated from the same series. The step length follows from the last terms of the series, so no step is rejected.
//! Forces and energy are evaluated with two more terms, which nearly removes the jumps between steps.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use pulp::{Arch, Simd, WithSimd};

use super::path::Path;
use super::series::{Contacts, Impulse, Matrix, ORDER, Series, TERMS, Values, subtract};
use crate::Error;
use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::mechanics::mobility::Mobility;
use crate::mechanics::state::State;
use crate::numerics::dense::solve_general;
use crate::record::energy::{Audit, stored};
use crate::record::recorder::Recorder;
use crate::record::solution::{Solution, SolutionBuilder};
use crate::time::outcome::Counts;

/// Largest number of contacts.
pub(crate) const WIDEST: usize = 8;

/// Allowed size of the last terms of a step, relative to the largest values, per unit of the accuracy of the run.
const LAST: f64 = 0.05;

/// Ratio of the allowed last terms of the forces, relative to the largest force, to those of the approaches, relative
/// to the largest approach.
const FORCES: f64 = 16.0;

/// Coarsest accuracy used for the step length; larger values are reduced to it.
const COARSEST: f64 = 1e-2;

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
    let mut moving = scene
        .bodies
        .iter()
        .enumerate()
        .filter_map(|(b, body)| Some((b, body.motion.as_ref()?)));
    let first = moving.next();
    let together = moving.next().is_none()
        && system
            .mechanics
            .wheels
            .iter()
            .all(|w| first.is_none_or(|(b, _)| system.mechanics.kinematics.root(w.body) == b));
    let uniform = first.is_none_or(|(_, motion)| motion.uniform(scene.end).is_some());
    let symmetric = system
        .foundations
        .iter()
        .all(|f| f.compliance.as_ref().is_none_or(|c| c.is_symmetric()));
    let mounted = !system.mechanics.carried.is_empty()
        || system.foundations.iter().any(|f| f.carrier.is_some());
    let troubles = [
        (!together, "wheels with the same speed"),
        (!uniform, "a constant speed"),
        (!system.traits.has_linear_laws, "linear contact laws"),
        (system.traits.is_uneven, "rails without irregularities"),
        (
            !system.traits.has_constant_rows || mounted,
            "massless structures supported on the ground",
        ),
        (!symmetric, "a symmetric compliance"),
        (
            !scene.actuators.loads.is_empty() || !scene.actuators.rules.is_empty(),
            "no loads or events",
        ),
        (system.elements.len() > WIDEST, "at most eight contacts"),
        (system.mechanics.dofs == 0, "degrees of freedom"),
        (
            system.mechanics.dofs > system.elements.len(),
            "no more degrees of freedom than contacts",
        ),
    ];
    troubles
        .into_iter()
        .find(|(found, _)| *found)
        .map(|(_, wanted)| wanted)
}

/// Result of a crossing from the start to the end, or until the caller stopped it.
pub(crate) struct Crossed {
    pub is_stopped: bool,
    pub solution: Solution,
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
    start: State,
    placed: bool,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Crossed>, Error> {
    match system.elements.len() {
        1..=2 => dispatch::<2>(system, start, placed, watch),
        3..=4 => dispatch::<4>(system, start, placed, watch),
        5..=WIDEST => dispatch::<WIDEST>(system, start, placed, watch),
        _ => Ok(None),
    }
}

/// Runs a crossing of at most P contacts with the widest vector registers that the processor has. The order of the sums
/// is fixed and products are rounded before they are added: the results are the same in every bit without them.
fn dispatch<const P: usize>(
    system: &System,
    start: State,
    placed: bool,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Crossed>, Error> {
    let crossing = Crossing::<P>::new(system, start)?;
    Arch::new().dispatch(Dispatched {
        crossing,
        placed,
        watch,
    })
}

/// [`Crossing::run`], compiled for several sets of vector registers.
struct Dispatched<'a, 'w, const P: usize> {
    crossing: Crossing<'a, P>,
    placed: bool,
    watch: &'w mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl<const P: usize> WithSimd for Dispatched<'_, '_, P> {
    type Output = Result<Option<Crossed>, Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.crossing.run(self.placed, self.watch)
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
    /// G over the scaled time of the step.
    compliance: [Matrix<P>; TERMS],
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
    /// The body with prescribed travel and its position at time 0, and its speed.
    root: Option<(usize, f64)>,
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
    fn new(system: &'a System<'a>, start: State) -> Result<Self, Error> {
        let (n, m) = (system.mechanics.dofs, system.elements.len());
        let pad = |values: &[f64]| std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0));
        let (q, v) = (pad(start.q.as_slice()), pad(start.v.as_slice()));
        let mut geometry = Geometry::new(system);
        geometry.update(system, 0.0, &start.q, &start.force)?;
        let zero = [[0.0; P]; P];
        let (mut rows, mut spread, mut mobile, mut mass) = (zero, zero, zero, zero);
        let mobility = Mobility::new(&system.mechanics)?;
        let mut free_fall = [0.0; P];
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
        let root = system
            .scene
            .bodies
            .iter()
            .position(|body| body.motion.is_some());
        let begun = root
            .map(|root| geometry.places().travel[root])
            .unwrap_or_default();
        let mut travel_inertia = [0.0; P];
        for &(number, inertia) in root
            .iter()
            .flat_map(|&root| system.mechanics.kinematics.travel_inertia(root))
        {
            travel_inertia[number] += inertia;
        }
        let constant = pad(&geometry.rows().approach_offset);
        Ok(Crossing {
            travel: UniformTravel {
                root: root.map(|root| (root, begun.x)),
                speed: begun.v,
                places: geometry.places().x.clone(),
            },
            matrices: Matrices {
                rows,
                constant,
                spread,
                free_fall,
                mass,
                weight: pad(system.mechanics.gravity.as_slice()),
                travel_inertia,
            },
            q,
            v,
            series: Series::new(),
            compliance: [zero; TERMS],
            contacts: Contacts {
                mobile,
                free,
                ratio,
                damping,
                softness,
            },
            state: start,
            audit: Audit::default(),
            energy_at_start: 0.0,
            length: 0.0,
            largest_approach: 0.0,
            largest_force: 0.0,
            system,
            geometry,
        })
    }

    #[inline(always)]
    fn run(
        mut self,
        placed: bool,
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Option<Crossed>, Error> {
        let system = self.system;
        let scene = system.scene;
        let softness = self
            .contacts
            .softness
            .iter()
            .take(system.elements.len())
            .fold(0.0_f64, |max, s| max.max(*s));
        let mut builder: Option<SolutionBuilder> = None;
        let mut counts = Counts::default();
        let quick = |i: usize| self.contacts.softness[i] / self.contacts.mobile[i][i];
        let quickest = (0..system.elements.len())
            .map(quick)
            .fold(f64::INFINITY, f64::min);
        let carried =
            scene.bodies.iter().map(|body| body.mass).sum::<f64>() / system.elements.len() as f64;
        if carried * softness > STIFF * quickest {
            return Ok(None);
        }
        let allowed = LAST * scene.accuracy.min(COARSEST)
            / (self.bounces(quickest).min(MOST_BOUNCES) / BOUNCES).max(1.0);
        let (mut t, mut scale) = (0.0, quickest.sqrt());
        for end in self.breaks() {
            let path = Path::new(
                system,
                &mut self.geometry,
                &self.state,
                [t, end],
                self.travel.speed,
                softness,
            )?;
            let Some(path) = path else { return Ok(None) };
            if t == 0.0 && !(placed || self.rest(&path.about(0.0, 1.0)[0])) {
                return Ok(None);
            }
            let mut is_smooth = t == 0.0;
            while t < end {
                self.compliance = path.about(t, scale);
                let approach = self.approach(&self.q, true);
                let rate = self.approach(&self.v, false);
                self.largest_approach = approach
                    .iter()
                    .fold(self.largest_approach, |max, w| max.max(w.abs()));
                let starts = [&approach, &rate];
                if self
                    .series
                    .expand(&self.contacts, &self.compliance, scale, starts)
                    .is_none()
                {
                    return Ok(None);
                }
                let force = self.series.first().force;
                self.largest_force = force
                    .iter()
                    .fold(self.largest_force, |max, force| max.max(force.abs()));
                // An error of an approach by this much changes a force by the fraction of the largest one.
                let yielding = self
                    .yielding(&self.compliance[0])
                    .min(self.largest_approach);
                let wanted = scale
                    * self
                        .series
                        .reach(allowed * yielding, FORCES * allowed * self.largest_force);
                let count = ((end - t) / wanted).ceil().max(1.0);
                let worthwhile = scene.end < MANY * wanted;
                if !worthwhile {
                    return Ok(None);
                }
                let h = (end - t) / count;
                if t == 0.0 && !self.begin() {
                    return Ok(None);
                }
                let to = if count == 1.0 { end } else { t + h };
                let solution = match &mut builder {
                    Some(known) => known,
                    None => {
                        let (mut recorder, mut row) = (Recorder::new(system), Vec::new());
                        self.record(&mut recorder, t, t, &mut row)?;
                        builder.insert(SolutionBuilder::new(recorder, scene.accuracy, &row, None))
                    }
                };
                let mut evaluate = |share: f64, recorder: &mut Recorder, row: &mut Vec<f64>| {
                    self.record(recorder, t, t + share * (to - t), row)
                        .map(|()| true)
                };
                solution.follow([t, to], is_smooth, &mut evaluate)?;
                is_smooth = true;
                if !self.step(h) {
                    return Ok(None);
                }
                counts.steps += 1;
                counts.stages += ORDER;
                (t, scale) = (to, h);
                if watch(t).is_break() {
                    let bounces = self.bounces(quickest);
                    return Ok(Some(self.finish(true, t, builder, (counts, bounces))));
                }
            }
        }
        let bounces = self.bounces(quickest);
        Ok(Some(self.finish(false, t, builder, (counts, bounces))))
    }

    /// Number of bounces in the run over which errors add up, with `quickest` the reciprocal square of the
    /// highest frequency of a contact, whose damping limits it to 1 + 1/(2 pi zeta).
    fn bounces(&self, quickest: f64) -> f64 {
        let omega = quickest.sqrt().recip();
        let ratio = self.contacts.ratio[..self.system.elements.len()]
            .iter()
            .fold(f64::INFINITY, |a, b| a.min(*b));
        (self.system.scene.end * omega / TAU).min(1.0 + 2.0 / (TAU * ratio * omega))
    }

    /// Completes the run after a step that ended at `t`.
    fn finish(
        mut self,
        is_stopped: bool,
        t: f64,
        builder: Option<SolutionBuilder>,
        (counts, bounces): (Counts, f64),
    ) -> Crossed {
        let s = self.length / self.series.scale;
        let [at] = self.series.at(&[s]);
        let (q, v) = (self.q, self.v);
        self.fill(t, &q, &v, &at.force);
        let [compliance, _] = self.compliance_at(s);
        self.geometry.set_compliance(compliance.iter());
        self.audit.end = stored(self.system, &self.geometry, &self.state);
        let solution = builder.map(SolutionBuilder::finish).unwrap_or_default();
        let audit = self.audit;
        Crossed {
            is_stopped,
            solution,
            audit,
            counts,
            bounces,
        }
    }

    /// Approach of the stiffest contact under the largest force on each contact: the smallest row sum of G + 1/k, times
    /// this force.
    #[inline(always)]
    fn yielding(&self, compliance: &Matrix<P>) -> f64 {
        let m = self.system.elements.len();
        let row = |i: usize| {
            (0..m).map(|j| compliance[j][i].abs()).sum::<f64>() + self.contacts.softness[i]
        };
        (0..m).map(row).fold(f64::INFINITY, f64::min) * self.largest_force
    }

    /// Times at which wheels meet breaks of their rails, followed by the end time.
    fn breaks(&self) -> Vec<f64> {
        let system = self.system;
        let end = system.scene.end;
        let mut times = vec![end];
        for (wheel, x) in system
            .mechanics
            .wheels
            .iter()
            .zip(&self.travel.places)
            .filter(|_| self.travel.speed != 0.0)
        {
            let contact = &system.scene.contacts[wheel.contact];
            let to = x + self.travel.speed * end;
            let places = system
                .mechanics
                .breaks
                .between(contact.structure, contact.rail, *x, to);
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
    #[inline(always)]
    fn approach(&self, freedoms: &[f64; P], with_constant: bool) -> [f64; P] {
        let mut sum = if with_constant {
            self.matrices.constant
        } else {
            [0.0; P]
        };
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
    #[inline(always)]
    fn begin(&mut self) -> bool {
        let look = self.series.first();
        let p = self.penetration(&look.force, &look.rate);
        let presses =
            |i: usize| (look.force[i] >= 0.0 && p[i] > 0.0) || self.system.law(i).bilateral;
        if !(0..self.system.elements.len()).all(presses) {
            return false;
        }
        let (q, v) = (self.q, self.v);
        self.fill(0.0, &q, &v, &look.force);
        self.geometry.set_compliance(self.compliance[0].iter());
        self.audit.start = stored(self.system, &self.geometry, &self.state);
        self.energy_at_start = self.energy(&q, &v, &look)[0];
        true
    }

    /// Penetration p = F/k - r w' under the forces `force` at the rates of the approaches `rate`.
    #[inline(always)]
    fn penetration(&self, force: &[f64; P], rate: &[f64; P]) -> [f64; P] {
        let Contacts {
            ratio, softness, ..
        } = &self.contacts;
        std::array::from_fn(|i| force[i] * softness[i] - ratio[i] * rate[i])
    }

    /// Rate of the penetration.
    #[inline(always)]
    fn penetration_rate(&self, at: &Values<P>) -> [f64; P] {
        let mut lift = self.contacts.free;
        subtract(&self.contacts.mobile, &at.force, &mut lift);
        self.penetration(&at.force_rate, &lift)
    }

    /// Displacements and speeds of the degrees of freedom at the scaled time `s` of the step.
    #[inline(always)]
    fn moved(&self, s: f64, impulse: &Impulse<P>) -> [[f64; P]; 2] {
        let time = s * self.series.scale;
        let [mut q, mut v] = [[0.0; P]; 2];
        for k in 0..P {
            let fall = time * self.matrices.free_fall[k];
            q[k] = self.q[k] + time * (self.v[k] + 0.5 * fall);
            v[k] = self.v[k] + fall;
        }
        subtract(&self.matrices.spread, &impulse.twice, &mut q);
        subtract(&self.matrices.spread, &impulse.once, &mut v);
        [q, v]
    }

    /// Stored energy without its constant part, and the elastic part of it.
    #[inline(always)]
    fn energy(&self, q: &[f64; P], v: &[f64; P], at: &Values<P>) -> [f64; 2] {
        let p = self.penetration(&at.force, &at.rate);
        let (mut elastic, mut rest) = (0.0, 0.0);
        for (i, p) in p.iter().enumerate() {
            elastic +=
                0.5 * (p * p / self.contacts.softness[i] + at.force[i] * (at.approach[i] - p));
        }
        for (k, column) in self.matrices.mass.iter().enumerate() {
            let momentum: f64 = column.iter().zip(v).map(|(entry, v)| entry * v).sum();
            rest += (0.5 * momentum + self.travel.speed * self.matrices.travel_inertia[k]) * v[k]
                - self.matrices.weight[k] * q[k];
        }
        [elastic + rest, elastic]
    }

    /// Takes the step of length `h` and adds it to the audit; returns false if a contact would have to pull.
    #[inline(always)]
    fn step(&mut self, h: f64) -> bool {
        let end = h / self.series.scale;
        self.length = h;
        let (mut dampers, mut drives) = (0.0, 0.0);
        let mut book = |at: &Values<P>, weight: f64| {
            let power = self.power(at);
            dampers += h * weight * power[0];
            drives += h * weight * power[1];
        };
        // Three places at a time: their sums fit into the registers.
        let (first, second) = LOBATTO.split_at(3);
        let of = |places: &[[f64; 2]]| {
            self.series
                .at::<3>(&std::array::from_fn(|k| places[k][0] * end))
        };
        let (before, after, [at]) = (of(first), of(second), self.series.at(&[end]));
        book(&self.series.first(), ENDS);
        for (at, [_, weight]) in before.iter().chain(&after).zip(&LOBATTO) {
            book(at, *weight);
        }
        book(&at, ENDS);
        self.audit.exchanged.dampers += dampers;
        self.audit.exchanged.drives += drives;
        let [impulse] = self.series.impulses(&[end]);
        [self.q, self.v] = self.moved(end, &impulse);
        let [total, elastic] = self.energy(&self.q, &self.v, &at);
        self.audit.peak_stored = self.audit.peak_stored.max(elastic);
        let imbalance = (total + self.audit.exchanged.net_loss() - self.energy_at_start).abs();
        self.audit.imbalance = self.audit.imbalance.max(imbalance);
        let mut least = at.force;
        for at in before.iter().chain(&after) {
            least
                .iter_mut()
                .zip(&at.force)
                .for_each(|(least, force)| *least = least.min(*force));
        }
        let pulls = |i: usize| least[i] < 0.0 && !self.system.law(i).bilateral;
        total.is_finite() && !(0..self.system.elements.len()).any(pulls)
    }

    /// Power dissipated in the dampers, c w' p', and power supplied by the travel, -1/2 F dG/dt F, where u = w - p is
    /// the deflection and F dG/dt F = F u' - u F'.
    #[inline(always)]
    fn power(&self, at: &Values<P>) -> [f64; 2] {
        let (p, p_rate) = (
            self.penetration(&at.force, &at.rate),
            self.penetration_rate(at),
        );
        let (mut dampers, mut drives) = (0.0, 0.0);
        for (i, (p, p_rate)) in p.iter().zip(&p_rate).enumerate() {
            let (give, give_rate) = (at.approach[i] - p, at.rate[i] - p_rate);
            dampers += self.contacts.damping[i] * at.rate[i] * p_rate;
            drives -= 0.5 * (at.force[i] * give_rate - give * at.force_rate[i]);
        }
        [dampers, drives]
    }

    /// Appends the row of the state at `time` in the step that began at `start`.
    ///
    /// # Errors
    /// Any error from evaluating the rails at the gauges.
    fn record(
        &mut self,
        recorder: &mut Recorder,
        start: f64,
        time: f64,
        row: &mut Vec<f64>,
    ) -> Result<(), Error> {
        let s = (time - start) / self.series.scale;
        let [at] = self.series.impulses(&[s]);
        let [q, v] = self.moved(s, &at);
        self.fill(time, &q, &v, &at.force);
        self.tilt(s, &at.force);
        recorder.row(self.system, &self.geometry, &self.state, row)
    }

    /// Sets the slopes of the rails at the scaled time `s` under the forces `force`.
    #[inline(always)]
    fn tilt(&mut self, s: f64, force: &[f64; P]) {
        if self.travel.root.is_none() {
            return;
        }
        if self.travel.speed == 0.0 {
            // the slopes of G are still those of the last evaluation, at the same places
            self.geometry
                .update_rail_slope(self.system, &self.state.q, &self.state.force);
            return;
        }
        // Half of dG/dx times the forces; its product with the forces is the longitudinal force of all wheels.
        let [_, rate] = self.compliance_at(s);
        let half = -0.5 / (self.series.scale * self.travel.speed);
        let mut slope = [0.0; P];
        subtract(&rate, &force.map(|force| half * force), &mut slope);
        self.geometry.set_rail_slope(&slope);
    }

    /// G at the scaled time `s` of the step, and its derivative by the scaled time.
    #[inline(always)]
    fn compliance_at(&self, s: f64) -> [Matrix<P>; 2] {
        let (mut value, mut rate) = (self.compliance[TERMS - 1], [[0.0; P]; P]);
        for matrix in self.compliance[..TERMS - 1].iter().rev() {
            for ((value, rate), entries) in value.iter_mut().zip(&mut rate).zip(matrix) {
                for i in 0..P {
                    rate[i] = rate[i] * s + value[i];
                    value[i] = value[i] * s + entries[i];
                }
            }
        }
        [value, rate]
    }

    /// Sets the state to the degrees of freedom `q`, their rates `v` and the forces `force` at time `t`, and the places of the
    /// wheels with it.
    #[inline(always)]
    fn fill(&mut self, t: f64, q: &[f64; P], v: &[f64; P], force: &[f64; P]) {
        let p = self.penetration(force, &self.approach(v, false));
        let mut a = self.matrices.free_fall;
        subtract(&self.matrices.spread, force, &mut a);
        self.state.t = t;
        put(q, self.state.q.as_mut_slice());
        put(v, self.state.v.as_mut_slice());
        put(&a, self.state.a.as_mut_slice());
        put(&p, &mut self.state.p);
        put(force, &mut self.state.force);
        let UniformTravel {
            root,
            speed,
            places,
        } = &self.travel;
        self.geometry.move_uniformly(places, *speed, t, *root);
    }
}

/// Copies the leading values, two at a time: a call that copies two numbers takes longer.
#[inline(always)]
fn put<const P: usize>(values: &[f64; P], to: &mut [f64]) {
    let (pairs, last) = to.as_chunks_mut::<2>();
    if let ([last], Some(value)) = (last, values.get(2 * pairs.len())) {
        *last = *value;
    }
    pairs
        .iter_mut()
        .zip(values.as_chunks::<2>().0)
        .for_each(|(to, from)| *to = *from);
}
