//! Instants at which a step must end: breaks of the rails, contacts that open or close, corners of drives.

use crate::Error;
use crate::contact::actuator::Pull;
use crate::contact::drag::slip;
use crate::mechanics::state::State;
use crate::numerics::dense::dot;
use crate::numerics::root::narrow;
use crate::time::stepper::{OVERSHOOT, PASSED, Stepper, interpolate};

/// Distance to a break of a rail, relative to 1 + |x|, within which a rolling wheel is at it.
const SLACK: f64 = 1e-11;

/// The same for each unit of the error that a step may make, where that is more.
const SLACK_BY_ERROR: f64 = 1e-4;

impl Stepper<'_, '_> {
    /// Length of the step that ends where a wheel with prescribed motion meets a break of its rail, if the
    /// step of length `h` would pass it.
    pub(crate) fn prescribed_break(&self, start: f64, h: f64) -> Option<f64> {
        let system = self.solver.system;
        let mut best: Option<f64> = None;
        for (b, body) in system.scene.bodies.iter().enumerate() {
            let Some(profile) = &body.motion else { continue };
            let (x0, x1) = (profile.at(start).x, profile.at(start + h).x);
            for wheel in
                system.mechanics.wheels.iter().filter(|w| system.mechanics.kinematics.root(w.body) == b)
            {
                let contact = &system.scene.contacts[wheel.contact];
                let offset = system.mechanics.kinematics.constant(wheel.body)[0];
                let ahead = wheel.hub[0] + offset;
                let foundation = &system.foundations[contact.structure];
                for place in foundation.breaks_between(contact.rail, x0 + ahead, x1 + ahead) {
                    let target = place - ahead;
                    let slack = 1e-9 * (1.0 + target.abs());
                    if (x0 - target) * (x1 - target) >= 0.0 || (x0 - target).abs() < slack {
                        continue;
                    }
                    // A little before the break: there the rail's slope is still that of the cell the wheel is on.
                    let length = root(|s| profile.at(start + s * h).x - target) * h
                        - 4.0 * f64::EPSILON * (start + h).abs();
                    if length > 0.0 && length < h * (1.0 - 1e-9) && best.is_none_or(|known| length < known) {
                        best = Some(length);
                    }
                }
            }
        }
        best
    }

    /// Share of the step just taken at which a freely rolling wheel meets a break of its rail, if the step passes one:
    /// the root of the wheel's place on the interpolant, less half of the slack. Repeated, the step ends before the
    /// break, where the rail's slope is still that of the cell the wheel comes from.
    pub(crate) fn rolling_break(&mut self) -> Option<f64> {
        let system = self.solver.system;
        if !system.moves_freely {
            return None;
        }
        let nearness = self.nearness();
        let mut first: Option<f64> = None;
        for (w, wheel) in system.mechanics.wheels.iter().enumerate() {
            if system.scene.bodies[system.mechanics.kinematics.root(wheel.body)].motion.is_some() {
                continue;
            }
            let contact = &system.scene.contacts[wheel.contact];
            let [x0, x1] = [&self.from, &self.to].map(|at| self.solver.geometry.place(system, w, &at.q));
            for place in system.foundations[contact.structure].breaks_between(contact.rail, x0, x1) {
                let slack = nearness * (1.0 + place.abs());
                // Within the slack a step may start before the break and cross it, or end beyond it.
                let is_there = (x0 - place).abs() < PASSED * slack || (x1 - place).abs() < slack;
                if (x0 - place) * (x1 - place) >= 0.0 || is_there {
                    continue;
                }
                let aim = place - 0.5 * slack * (x1 - x0).signum();
                let (from, to, geometry) = (&self.from, &self.to, &self.solver.geometry);
                let probe = &mut self.probe;
                let share = root(|share| {
                    probe.interpolate(from, to, share);
                    geometry.place(system, w, &probe.q) - aim
                });
                if first.is_none_or(|known| share < known) {
                    (first, self.meets) = (Some(share), Some(w));
                }
            }
        }
        first
    }

    /// Distance to a break of a rail, relative to 1 + |x|, within which a rolling wheel is at it.
    pub(crate) fn nearness(&self) -> f64 {
        if self.fixed.is_some() { SLACK } else { SLACK.max(SLACK_BY_ERROR * self.tolerance) }
    }

    /// Share of a step of length `h` at which a freely rolling wheel meets a break, by the accelerations where the step
    /// starts: near enough where the accuracy asked lets steps end beside a break. Leaves its guess in `to`.
    pub(crate) fn predicted_break(&mut self, h: f64) -> Option<f64> {
        if !self.solver.system.moves_freely || self.nearness() <= SLACK {
            return None;
        }
        let (from, to) = (&self.from, &mut self.to);
        to.t = from.t + h;
        to.q.axpy(h, &from.v, 1.0);
        to.q.axpy(0.5 * h * h, &from.a, 1.0);
        to.v.axpy(h, &from.a, 1.0);
        self.rolling_break()
    }

    /// The first contact that opens or closes within the step, if one does: the share of the step at which it does,
    /// and the force by which the step has gone too far.
    ///
    /// Forces of contacts that remember their penetration relax faster than the interpolant follows: for them the
    /// share is the secant of the forces at both ends, for all others the root on the interpolant. Repeated, both
    /// end within [`OVERSHOOT`] beyond the event.
    pub(crate) fn first_event(&mut self) -> Result<Option<(f64, f64)>, Error> {
        let system = self.solver.system;
        let links = (0..system.links.len()).map(|index| system.link(index));
        let own = (0..system.mechanics.groups.len()).chain(links);
        let aim = 0.5 * OVERSHOOT * self.largest_force();
        let mut first: Option<(f64, f64)> = None;
        let mut interpolated = false;
        for i in own {
            let excess = self.event(i, &self.to);
            if excess <= 0.0 {
                continue;
            }
            let noise =
                i.checked_sub(system.link(0)).map_or(0.0, |index| self.solver.geometry.links[index].noise);
            let share = if i < system.mechanics.groups.len() && self.solver.remembers(i) {
                let start = self.from.force[i].max(0.0);
                ((start + aim) / (start + excess)).min(1.0)
            } else {
                interpolated = true;
                self.root_on_interpolant(i, aim + noise)?
            };
            if first.is_none_or(|(known, _)| share < known) {
                first = Some((share, excess - 2.0 * noise));
            }
        }
        if interpolated {
            self.return_to_end()?;
        }
        Ok(first)
    }

    /// Share of the step at which the event function of contact `i` reaches `aim` on the interpolant.
    fn root_on_interpolant(&mut self, i: usize, aim: f64) -> Result<f64, Error> {
        // The geometry is that of the end: the value at the start is a guess.
        let [start, end] = [&self.from, &self.to].map(|at| self.event(i, at) - aim);
        if end <= 0.0 {
            return Ok(1.0);
        }
        let mut failure = None;
        let [_, share] = narrow([start.min(-aim), end], 1e-12, |share| {
            let value = self.solved_at(share).map(|solved| solved.then(|| self.event(i, &self.probe) - aim));
            value.unwrap_or_else(|error| {
                failure = Some(error);
                None
            })
        });
        failure.map_or(Ok(share), Err)
    }

    /// Brings `probe` to the share `share` of the step just tried, with its forces; returns whether they converged.
    pub(crate) fn solved_at(&mut self, share: f64) -> Result<bool, Error> {
        self.probe.copy_from(&self.to);
        let ends = [&self.from, &self.to];
        interpolate(self.solver, self.collocation.as_ref(), ends, share, &mut self.probe)?;
        self.solver.instant(&mut self.probe)
    }

    /// Leaves the solver's geometry at the end of the step, after looks inside.
    pub(crate) fn return_to_end(&mut self) -> Result<(), Error> {
        self.probe.copy_from(&self.to);
        self.solver.instant(&mut self.probe)?;
        Ok(())
    }

    /// Share of the step at which a drive reaches or leaves a limit, if one does by more than [`OVERSHOOT`]: the
    /// secant of its margins at both ends.
    pub(crate) fn first_corner(&self) -> Option<f64> {
        let system = self.solver.system;
        let slack = OVERSHOOT * self.largest_force();
        let geometry = &self.solver.geometry;
        let margins = |index: usize, pull: &Pull, at: &State| {
            let speed = if system.is_dragged {
                slip(system, geometry, at, system.pull(index)) - geometry.rate_held[system.pull(index)]
            } else {
                dot(&pull.row, &system.mechanics.body(pull.body, at.t, &at.q, &at.v).1)
            };
            let reference = pull.reference(system.scene, &geometry.switches, at.t);
            pull.margins(reference, speed, pull.traction(&at.force))
        };
        let shares = system.pulls.iter().enumerate().flat_map(|(index, pull)| {
            let (from, to) = (margins(index, pull, &self.from), margins(index, pull, &self.to));
            std::iter::zip(from, to).filter_map(|(from, to)| {
                let passes = from * to < 0.0 && from.abs() > slack && to.abs() > slack;
                passes.then(|| (from.abs() + 0.5 * slack) / (from.abs() + to.abs()))
            })
        });
        shares.min_by(f64::total_cmp)
    }

    /// Largest contact force so far.
    pub(crate) fn largest_force(&self) -> f64 {
        self.to.force.iter().fold(self.force_scale, |max, force| max.max(force.abs()))
    }

    /// Positive where contact or link `i` must open (if it acts) or close (if it does not): the force by which it has gone
    /// too far. A contact closes where its spring is pressed and its law pushes: the lesser of the two, since the
    /// damper's force may jump where wheel and rail meet, the spring's where a pressed contact begins to push.
    pub(crate) fn event(&self, i: usize, at: &State) -> f64 {
        let system = self.solver.system;
        if i >= system.mechanics.groups.len() {
            let index = i - system.link(0);
            if self.solver.geometry.switches.is_released(index) {
                return -1.0;
            }
            let margin = self.solver.geometry.margin(system, index, at);
            let hold = &self.solver.geometry.links[index];
            return if hold.taut { -margin - hold.noise } else { margin - hold.noise };
        }
        if self.solver.active[i] {
            return if self.solver.bilateral(i) { -1.0 } else { -at.force[i] };
        }
        let closing = self.solver.closing(i, at);
        if closing > 0.0 { closing.min(self.solver.system.law(i).spring(at.p[i])) } else { closing }
    }
}

/// Root in (0, 1) of a function with opposite signs at the ends, from the side of 0.
fn root(mut f: impl FnMut(f64) -> f64) -> f64 {
    let ends = [f(0.0), f(1.0)];
    narrow(ends, 1e-15, |at| Some(f(at)))[0]
}
