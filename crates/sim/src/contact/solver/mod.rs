//! Solver of a scene, without allocation in repeated solutions: at one instant in this file, in one stage of a step
//! in [`stage`].

mod correct;
pub(crate) mod errors;
pub(crate) mod follow;
mod ropes;
mod stage;

use nalgebra::DVector;

use super::active::ActiveSet;
use super::charts::Charts;
use super::convergence::Convergence;
use super::element::{Frame, tangential_of};
use super::forces::{Problem, RowKind};
use super::free_motion::FreeMotion;
use super::geometry::Geometry;
use super::projection::Projection;
use super::system::System;
use crate::mechanics::state::State;
use crate::{Action, Error};

/// Compliance of a rail, relative to that of the wheel, below which the rail is treated as rigid.
pub(crate) const RIGID: f64 = 1e-9;

/// Ratio of what a longitudinal displacement of a rail would move in a step at the rate of its end to what it moves, from which on
/// this rate is that of no motion. In a motion that steps resolve the ratio is near 1; behind a jump it is 9 with SDIRK4 and 53 with
/// ESDIRK5.
const SNAP: f64 = 4.0;

/// Part of a longitudinal displacement of a rail that is no motion.
const AT_REST: f64 = 1e-6;

/// Maximum number of iterations on the positions and heights of the wheels in one solution.
const PASSES: usize = 30;

/// Treatment of the longitudinal displacements of massless rails in the solution at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RailMemory {
    /// The displacements are states.
    Known,
    /// The displacements follow from the forces.
    Unknown,
}

/// Displacements of an evaluation of the geometry in a stage.
struct Evaluated {
    q: DVector<f64>,
    /// Whether there was one in the present stage.
    is_valid: bool,
    /// Whether the present stage is the last one of its step.
    ends_step: bool,
}

/// A numbered scene with the current geometry of its elements, the active set, and the problem of the forces.
pub(crate) struct Solver<'a> {
    system: &'a System<'a>,
    geometry: Geometry,
    active: ActiveSet,
    /// Local coordinates of hanging bodies during a step.
    charts: Charts,
    free: FreeMotion<'a>,
    projection: Projection,
    problem: Problem,
    /// Coefficient g of the stage whose Jacobian is factored in `problem`.
    factored_for: Option<f64>,
    /// Displacements at which geometry, masses and loads of the present stage were evaluated last.
    evaluated: Evaluated,
    convergence: Convergence,
    rail_memory: RailMemory,
    /// Working memory: errors of approaches and rates that add up now, a quarter of a period later, and on their own.
    state_errors: [Vec<[f64; 2]>; 3],
}

impl<'a> Solver<'a> {
    /// # Errors
    /// A mass that is not positive definite.
    pub fn new(system: &'a System<'a>, rail_memory: RailMemory) -> Result<Self, Error> {
        let begin = system
            .elements
            .iter()
            .map(|element| element.begins_active())
            .collect();
        Ok(Solver {
            system,
            geometry: Geometry::new(system),
            active: ActiveSet::new(begin, system.verticals()),
            charts: Charts::default(),
            free: FreeMotion::new(system)?,
            projection: Projection::new(system),
            problem: Problem::new(system.elements.len()),
            factored_for: None,
            evaluated: Evaluated {
                q: DVector::zeros(system.mechanics.dofs),
                is_valid: false,
                ends_step: false,
            },
            convergence: Convergence::default(),
            rail_memory,
            state_errors: Default::default(),
        })
    }

    /// The numbered scene.
    pub fn system(&self) -> &'a System<'a> {
        self.system
    }

    /// Geometry of the elements at the last update.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The set of active elements.
    pub fn active(&self) -> &ActiveSet {
        &self.active
    }

    /// Updates the geometry to `at`.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn update(&mut self, at: &State) -> Result<(), Error> {
        self.geometry.update(self.system, at.t, &at.q, &at.force)
    }

    /// Updates the geometry to the time and forces of `at` with the degrees of freedom `q`.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn update_to(&mut self, at: &State, q: &DVector<f64>) -> Result<(), Error> {
        self.geometry.update(self.system, at.t, q, &at.force)
    }

    /// Updates the slopes of the deflected rails for the forces of `at`; the positions of the wheels are unchanged.
    pub fn update_rail_slope(&mut self, at: &State) {
        self.geometry
            .update_rail_slope(self.system, &at.q, &at.force);
    }

    /// Sets the heights of all wheels to those of the penetrations of `at`.
    pub fn update_heights(&mut self, at: &State) {
        self.geometry.update_heights(self.system, at);
    }

    /// Sets the heights of all wheels to their radii.
    pub fn reset_heights(&mut self) {
        self.geometry.reset_heights(self.system);
    }

    /// Sets the piece of the uneven rail on which wheel `w` runs.
    pub fn set_piece(&mut self, w: usize, piece: usize) {
        self.geometry.set_piece(w, piece);
    }

    /// Executes `action` of a rule at time `t`. Returns whether the run ends.
    ///
    /// # Errors
    /// A hoisting speed that would wind up the whole rope before the end of the run.
    pub fn switch(&mut self, action: Action, t: f64) -> Result<bool, Error> {
        self.geometry.switch(self.system, action, t)
    }

    /// Whether interpolation of the compliance along paths is useful, see [`Geometry::set_paths`].
    pub fn wants_paths(&self) -> bool {
        self.geometry.wants_paths()
    }

    /// Sets the paths along which the compliance is interpolated, see [`Geometry::set_paths`].
    pub fn set_paths(&mut self, ends: [(f64, &DVector<f64>); 3]) {
        self.geometry.set_paths(self.system, ends);
    }

    /// Begins a path of the compliance of structure `s`; the present one is kept.
    pub fn begin_path(&mut self, s: usize) {
        self.geometry.begin_path(s);
    }

    /// Exchanges the path of the compliance of structure `s` and the one before the last joint.
    pub fn exchange_paths(&mut self, s: usize) {
        self.geometry.exchange_paths(s);
    }

    /// Exchanges the geometry of the solver with `geometry`, which belongs to the current state.
    pub fn exchange_geometry(&mut self, geometry: &mut Geometry) {
        std::mem::swap(&mut self.geometry, geometry);
    }

    /// Error, relative to the largest force, that the iterations of a stage may leave; zero if they end at rounding.
    pub fn allowed_error(&self) -> f64 {
        self.convergence.allowed().unwrap_or(0.0)
    }

    /// Activates or deactivates element `i`.
    pub fn set_active(&mut self, i: usize, is_active: bool) {
        self.active.set(i, is_active);
    }

    /// Opens vertical contact `i` at `at` and stores its present penetration for its damper.
    pub fn open(&mut self, i: usize, at: &State) {
        self.active.set(i, false);
        self.active.store(i, at);
    }

    /// Stores the penetrations of `at` for the open contacts that have no stored penetration yet.
    pub fn store_open(&mut self, at: &State) {
        for i in 0..self.system.verticals() {
            if !self.active.has(i) && self.active.stored(i).is_none() {
                self.active.store(i, at);
            }
        }
    }

    /// Restores the active set and the pieces of uneven rails on which the wheels run.
    pub fn restore(&mut self, active: &ActiveSet, pieces: &[usize]) {
        self.active.copy_from(active);
        self.geometry.set_pieces(pieces);
    }

    /// Determines which ropes and stops are active at `at`; the geometry must belong to `at`.
    pub fn settle_springs(&mut self, at: &State) {
        for &i in self.system.springs() {
            let spring = &self.geometry.local()[i].spring;
            let margin = spring.margin(
                self.geometry.approach(i, &at.q),
                self.geometry.rate(i, &at.v),
            );
            let is_released = self.system.elements[i].is_released(self.geometry.switches());
            self.active.set(i, !is_released && margin > 0.0);
        }
    }

    /// Whether element `i` is active and its penetration is a state.
    pub fn remembers(&self, i: usize) -> bool {
        self.active.has(i) && self.system.fixed[i].has_memory
    }

    /// Whether active vertical contact `i` must open.
    pub fn opens(&self, i: usize, at: &State) -> bool {
        self.system
            .vertical(i)
            .opens(at.force[i], self.geometry.fraction(i))
    }

    /// Force of one wheel that open contact `i` would have if it closed now. A positive value means that it must
    /// close.
    pub fn closing(&self, i: usize, at: &State) -> f64 {
        let rate = || self.geometry.rate(i, &at.v);
        self.system
            .vertical(i)
            .closing(i, self.geometry.fraction(i), &self.active, at, rate)
    }

    /// The scene at `at`; the geometry must belong to `at`.
    pub fn frame<'s>(&'s self, at: &'s State) -> Frame<'s> {
        self.geometry.frame(self.system, at)
    }

    /// Switching function of element `i` at `frame`: positive if an inactive element must become active or an active
    /// one inactive. The value is the force by which the limit is exceeded.
    pub fn switch_guard(&self, i: usize, frame: &Frame) -> Option<f64> {
        self.system.elements[i].switch(&frame.at(i), &self.active)
    }

    /// The first element from index `first` that must be switched at `at`, with the force by which its limit is
    /// exceeded.
    pub fn next_switch(&self, first: usize, at: &State) -> Option<(usize, f64)> {
        let frame = self.frame(at);
        (first..self.system.elements.len()).find_map(|i| {
            let excess = self
                .switch_guard(i, &frame)
                .filter(|excess| *excess > 0.0)?;
            Some((i, excess))
        })
    }

    /// The force by which vertical contact `i` has exceeded its limit of opening or closing at `frame`, beyond rounding.
    pub fn excess(&self, i: usize, frame: &Frame) -> f64 {
        let noise = frame.at(i).local().spring.noise;
        self.switch_guard(i, frame)
            .map_or(f64::NEG_INFINITY, |excess| excess - noise)
    }

    /// Whether the rail below vertical contact `i` is rigid relative to the wheel.
    pub fn is_on_rigid_rail(&self, i: usize) -> bool {
        self.geometry.own_compliance(i) * self.system.law(i).stiffness <= RIGID
    }

    /// Penetration of element `i` under `force`, from the matrices of the last solution.
    pub fn solved_penetration(&self, i: usize, force: &[f64]) -> f64 {
        self.problem.effects.penetration(i, force)
    }

    /// Rate at which wheel and rail approach each other at vertical contact `i`, with the rail that wheel `i` passes
    /// deflected as it is: r = R v + x' (h' - w'), where h' is the slope of the unloaded rail's shape and w' that of
    /// its deflection, downwards.
    pub fn approach_rate(&self, i: usize, at: &State) -> f64 {
        let rows = self.geometry.rows();
        let slope = rows.rise[i] - self.geometry.deflected_slope(i, &at.q, &at.force);
        rows.approach_along(i, &at.v) + slope * self.system.contact_speed(i, at)
    }

    /// M^-1 times the forces at `t` that are independent of the elements.
    pub fn free_accelerations(&mut self, t: f64) -> &DVector<f64> {
        self.free.accelerations(self.system, t)
    }

    /// `out` = M^-1 times `row`.
    pub fn apply_inverse(&self, row: &[f64], out: &mut [f64]) {
        self.free.inverse().apply(row, out);
    }

    /// Sets the longitudinal displacements of massless rails to the static ones under the forces of `at`, and their
    /// rates to zero.
    pub fn rest_rails(&self, at: &mut State) {
        for (i, slot) in self.sliding() {
            at.p[slot] = self.geometry.deflection(i, &at.force);
            at.p_rate[slot] = 0.0;
        }
    }

    /// Sets the longitudinal displacements of massless rails to those under the forces of `at`.
    pub fn move_rails(&self, at: &mut State) {
        for (i, slot) in self.sliding() {
            at.p[slot] = self.geometry.deflection(i, &at.force);
        }
    }

    /// Elements for which the longitudinal displacement of the rail is a state, with its index in the state.
    fn sliding(&self) -> impl Iterator<Item = (usize, usize)> + use<'a> {
        let (probes, first) = (&self.system.probes, self.system.verticals());
        probes
            .sliding
            .iter()
            .enumerate()
            .map(move |(k, &i)| (i, first + k))
    }

    /// Whether the longitudinal displacement of a rail below a wheel has jumped in the step between two states. Its rate at the end
    /// of the step is then that of no motion: under a wheel that slides, steps that begin with it move a rail without mass to and fro
    /// between the ends of the friction.
    pub fn snaps(&self, [from, to]: [&State; 2]) -> bool {
        self.sliding().any(|(_, slot)| {
            let by_rate = to.p_rate[slot].abs() * (to.t - from.t);
            by_rate > SNAP * (to.p[slot] - from.p[slot]).abs() + AT_REST * to.p[slot].abs()
        })
    }

    /// Solves for the forces, penetrations and accelerations at (t, q, v) with the present active set.
    ///
    /// The geometry is updated to (t, q) once. Each iteration solves for the forces and updates the heights of the wheels,
    /// with the rows that depend on them. It ends when the heights change by less than 1e-13. For active elements whose
    /// penetration is a state, the penetration p is prescribed at the ends of steps. On the interpolant within a step, the
    /// rate p' is prescribed instead, and p follows from p + G F = e: with F = k p + c p', an error of the rate then enters
    /// the force with the factor c/(1 + k G), whereas an error of a prescribed penetration would enter it with the factor k.
    /// Returns whether the forces converged.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn instant(&mut self, at: &mut State) -> Result<bool, Error> {
        self.instant_within(at, [0.0; 2])
    }

    /// As [`Solver::instant`], where the forces may err by the first `slack` relative to the largest, and the heights of the
    /// wheels by the second relative to themselves.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn instant_within(&mut self, at: &mut State, slack: [f64; 2]) -> Result<bool, Error> {
        self.update(at)?;
        self.instant_here(at, slack)
    }

    /// As [`Solver::instant_within`], where the geometry already belongs to `at`.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn instant_here(
        &mut self,
        at: &mut State,
        [slack, height_slack]: [f64; 2],
    ) -> Result<bool, Error> {
        let system = self.system;
        self.problem.seek_all();
        self.factored_for = None;
        self.problem.slack = slack;
        for pass in 0..PASSES {
            self.fill_instant(at);
            self.problem.is_repeated = pass > 0;
            let (local, active) = (self.geometry.local(), self.active.flags());
            if !self.problem.solve(system, local, active, &mut at.force) {
                return Ok(false);
            }
            for i in 0..system.verticals() {
                if self.problem.effects.kind[i] != RowKind::Given {
                    at.p[i] = self.problem.effects.penetration(i, &at.force);
                }
            }
            let change = self.geometry.update_heights(system, at);
            self.geometry
                .update_in_place(system, (at.t, &at.q), &at.force)?;
            if change < height_slack.max(1e-13) {
                break;
            }
        }
        self.update_rail_slope(at);
        self.free
            .accelerate(system, at, &self.geometry.rows().force)?;
        Ok(true)
    }

    /// Fills the problem of the forces at one instant: W = G, Y = 0, and the prescribed states.
    fn fill_instant(&mut self, at: &mut State) {
        let m = at.force.len();
        for i in 0..m {
            let remembers = self.remembers(i);
            let effects = &mut self.problem.effects;
            effects.approach[i] = self.geometry.approach(i, &at.q);
            effects.rate[i] = self.geometry.rate(i, &at.v);
            effects.kind[i] = RowKind::Law;
            if remembers && at.is_between {
                effects.rate[i] = at.p_rate[i];
            } else if remembers {
                effects.kind[i] = RowKind::Given;
                let (local, reached) = (self.geometry.local(), [at.p[i], at.p_rate[i]]);
                at.force[i] = self
                    .problem
                    .force_at(self.system, local, i, reached, &at.force);
            }
        }
        let effects = &mut self.problem.effects;
        effects.w.copy_from_slice(&self.geometry.rails().value);
        effects.y.fill(0.0);
        // A tangential force keeps the displacement of its massless rail, within the limits of its law. If the rail
        // is practically rigid, the law itself determines the force. In both cases the rate of the rail is the stored
        // one.
        for (i, slot) in self.sliding() {
            let complies = self.geometry.own_compliance(i) * self.stiffest() > RIGID;
            let effects = &mut self.problem.effects;
            if complies && self.rail_memory == RailMemory::Known {
                effects.kind[i] = RowKind::Keeps(at.p[slot]);
            }
            effects.rate[i] -= at.p_rate[slot];
            self.take_passing(i, at);
        }
    }

    /// Largest normal stiffness of all wheels.
    fn stiffest(&self) -> f64 {
        self.system
            .scene
            .wheels
            .iter()
            .fold(0.0, |max, wheel| wheel.normal.stiffness.max(max))
    }

    /// Subtracts x' dG/dx from row `i` of Y: the rate due to the motion of the wheels along the deflected rail.
    fn take_passing(&mut self, i: usize, at: &State) {
        let (system, m) = (self.system, at.force.len());
        for (contact, speed) in tangential_of(&system.mechanics, &system.probes, at, i) {
            let slopes = &self.geometry.rails().tangential[contact * m..(contact + 1) * m];
            let rows = &mut self.problem.effects.y[i * m..(i + 1) * m];
            for (y, slope) in rows.iter_mut().zip(slopes) {
                *y -= speed * slope;
            }
        }
    }

    /// Sets `at` to the interpolant between the two ends of the last attempted step, at `fraction` of the step, and the heights of
    /// the wheels to those at its penetrations.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn interpolate(
        &mut self,
        [from, to]: [&State; 2],
        fraction: f64,
        at: &mut State,
    ) -> Result<(), Error> {
        at.interpolate(from, to, fraction);
        self.geometry.update_heights(self.system, at);
        self.charts.interpolate(
            self.system,
            self.geometry.switches(),
            [from, to],
            fraction,
            at,
        );
        self.stretch_ropes(to.t - from.t, at)
    }

    /// Calls `each` with the number and the errors of displacement and speed of every degree of freedom; `of` returns
    /// the errors by number. For hanging bodies, `of` returns errors of the local coordinates, which are transformed
    /// to X, Y and Z.
    #[inline]
    pub fn for_errors(
        &self,
        at: &State,
        of: impl Fn(usize) -> [f64; 2],
        mut each: impl FnMut(usize, [f64; 2]),
    ) {
        (0..at.q.len())
            .filter(|&k| !self.charts.has(k))
            .for_each(|k| each(k, of(k)));
        self.charts
            .errors(self.system, self.geometry.switches(), at, of, each);
    }
}
