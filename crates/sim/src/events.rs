//! Instants at which a step must end: breaks of the rails, and contacts that open or close.

use crate::Error;
use crate::state::State;
use crate::stepper::Stepper;

impl Stepper<'_, '_> {
    /// Length of the step that ends where a wheel with prescribed motion meets a break of its rail, if the
    /// step of length `h` would pass it.
    pub(crate) fn prescribed_break(&self, start: f64, h: f64) -> Option<f64> {
        let system = self.solver.system;
        let mut best: Option<f64> = None;
        for (b, body) in system.scene.bodies.iter().enumerate() {
            let Some(profile) = &body.motion else { continue };
            let (x0, x1) = (profile.at(start).x, profile.at(start + h).x);
            for wheel in system.wheels.iter().filter(|wheel| wheel.body == b) {
                let contact = &system.scene.contacts[wheel.contact];
                for &place in system.foundations[contact.structure].breaks(contact.rail) {
                    let target = place - wheel.hub[0];
                    let slack = 1e-9 * (1.0 + target.abs());
                    if (x0 - target) * (x1 - target) >= 0.0 || (x0 - target).abs() < slack {
                        continue;
                    }
                    let length = root(|s| profile.at(start + s * h).x - target) * h;
                    if length < h * (1.0 - 1e-9) && best.is_none_or(|known| length < known) {
                        best = Some(length);
                    }
                }
            }
        }
        best
    }

    /// Share of the step at which the first contact opens or closes, if one does.
    pub(crate) fn first_event(&mut self) -> Result<Option<f64>, Error> {
        let count = self.solver.system.normals.len();
        self.probe.copy_from(&self.to);
        let mut first: Option<f64> = None;
        for i in 0..count {
            if self.event(i, &self.to) <= 0.0 {
                continue;
            }
            // Bisection and secant on the interpolant; the event function is negative at the start.
            let (mut low, mut high) = (0.0_f64, 1.0_f64);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                self.probe.interpolate(&self.from, &self.to, middle);
                if !self.solver.instant(&mut self.probe)? {
                    break;
                }
                if self.event(i, &self.probe) > 0.0 {
                    high = middle
                } else {
                    low = middle
                }
                if high - low < 1e-12 {
                    break;
                }
            }
            if first.is_none_or(|known| high < known) {
                first = Some(high);
            }
        }
        if first.is_some() {
            // Leave the solver's geometry at the end of the step.
            self.probe.copy_from(&self.to);
            self.solver.instant(&mut self.probe)?;
        }
        Ok(first)
    }

    /// Positive where contact `i` must open (if it acts) or close (if it does not).
    pub(crate) fn event(&self, i: usize, at: &State) -> f64 {
        if self.solver.active[i] {
            if self.solver.bilateral(i) { -1.0 } else { -at.force[i] }
        } else {
            self.solver.closing(i, at)
        }
    }
}

/// Root in (0, 1) of a function with opposite signs at the ends, by bisection.
fn root(f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(0.0).signum();
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    while high - low > 1e-15 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if f(middle).signum() == sign { low = middle } else { high = middle }
    }
    high
}
