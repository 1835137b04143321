//! Transients of penetrations behind a break or an event.
//!
//! A penetration p under a damper between wheel and rail follows the equation p + G F(p, p') = e. Where the approach e jumps, as
//! at a step of the rail, or another force acts on the wheel, its rate and the force jump, and the difference decays as
//! exp(-t/tau), tau = c G/(1 + k G). Inside a step of length h the difference is the cubic through its values at the start and at
//! the nodes of Radau's method of order 5, c = 0.155, 0.645, 1. The derivative of that cubic at the start errs by
//! c1 c2 c3 h^3/24 times the fourth derivative. A force that jumps by dF at t = 0 therefore errs by
//! (c1 c2 c3/24) (h/tau)^3 exp(-t/tau) dF at most, which limits the length of a step that starts at t to
//! tau (allowed/(dF c1 c2 c3/24))^(1/3) exp(t/(3 tau)).

use crate::contact::solver::Solver;
use crate::mechanics::state::State;

/// The error of the force at the start, per unit of its jump and of (h/tau)^3: c1 c2 c3/24 with c1 c2 c3 = 1/10.
const CUBIC: f64 = 1.0 / 240.0;

/// Number of times tau after which a transient has no effect.
const DECAYED: f64 = 40.0;

/// The transients that have not decayed.
pub(crate) struct Transients {
    all: Vec<Transient>,
    /// Time of the last event that made an element active or inactive.
    last_switch: f64,
}

struct Transient {
    /// Time of the jump.
    start: f64,
    /// The time tau in which the penetration follows its force.
    delay: f64,
    /// Longest step at the jump.
    longest: f64,
}

impl Transients {
    pub fn none() -> Transients {
        Transients {
            all: Vec::new(),
            last_switch: f64::NEG_INFINITY,
        }
    }

    /// Adds those of the contacts whose forces differ between the states `before` and `after` a break or an event, to which the
    /// geometry of the solver belongs. The force of a contact may err by what is `allowed` of it, but for the time `window` around
    /// the event; transients that are quicker than `shortest` are not resolved. Where the event `has_switched` elements, and so has
    /// one shortly before, wheels are thrown off and back again: they come to rest sooner in long steps, and no transient is
    /// followed.
    pub fn add(
        &mut self,
        solver: &Solver,
        [before, after]: [&State; 2],
        allowed: &dyn Fn(usize) -> f64,
        [window, shortest]: [f64; 2],
        has_switched: bool,
    ) {
        self.all
            .retain(|own| after.t < own.start + DECAYED * own.delay);
        let contacts = || (0..solver.system().verticals()).filter(|&i| solver.remembers(i));
        if has_switched {
            let longest = contacts()
                .map(|i| solver.delay(i, after))
                .fold(0.0, f64::max);
            let since = after.t - self.last_switch;
            self.last_switch = after.t;
            if since < DECAYED * longest {
                self.all.clear();
                return;
            }
        }
        for i in contacts() {
            let force = |at: &State| solver.law_of(i, after.p[i], at.p_rate[i])[0];
            let jump = (force(after) - force(before)).abs();
            let (delay, allowed) = (solver.delay(i, after), allowed(i));
            if delay > shortest && allowed > 0.0 && jump > allowed {
                self.all.push(Transient {
                    start: after.t,
                    delay,
                    longest: (delay * (allowed / (CUBIC * jump)).cbrt()).max(window),
                });
            }
        }
    }

    /// Longest step from the time `t`.
    pub fn longest(&self, t: f64) -> f64 {
        let each = self
            .all
            .iter()
            .map(|own| own.longest * ((t - own.start) / (3.0 * own.delay)).exp());
        each.fold(f64::INFINITY, f64::min)
    }
}
