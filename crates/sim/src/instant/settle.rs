//! Which vertical contacts act: the complementarity problem of one instant.

use crate::Error;
use crate::contact::solver::{RIGID, Solver};
use crate::mechanics::state::State;
use crate::numerics::complementarity::complementarity;

/// Relative rounding of a penetration.
const ROUNDING: f64 = 1e-12;

impl Solver<'_> {
    /// Finds which vertical contacts act at (t, q, v), and the forces: the complementarity problem, by sweeps
    /// of the active set. Returns whether it settled.
    pub fn settle(&mut self, at: &mut State) -> Result<bool, Error> {
        let count = self.system.mechanics.groups.len();
        if !self.system.links.is_empty() {
            self.geometry.update(self.system, at.t, &at.q, &at.force)?;
            self.geometry.settle_links(self.system, at);
        }
        self.guess_active(at)?;
        for _ in 0..4 * count + 8 {
            if !self.instant(at)? {
                return Ok(false);
            }
            let weakest = (0..count)
                .filter(|&i| self.active[i] && self.opens(i, at))
                .min_by(|&i, &j| at.force[i].total_cmp(&at.force[j]));
            if let Some(i) = weakest {
                self.active[i] = false;
                self.keep(i, at);
                continue;
            }
            let deepest = (0..count)
                .filter(|&i| !self.active[i] && self.closing(i, at) > 0.0)
                .max_by(|&i, &j| at.p[i].total_cmp(&at.p[j]));
            let Some(i) = deepest else { return Ok(true) };
            self.active[i] = true;
            at.p_rate[i] = self.closing_rate(i, at);
        }
        Ok(false)
    }

    /// Rate of penetration of a contact that closes now. Where the rail gives, its penetration and so its force go
    /// on without a jump: the force starts at zero, on the side where the contact presses. A rigid rail takes the wheel's
    /// own rate.
    fn closing_rate(&self, i: usize, at: &State) -> f64 {
        let system = self.system;
        let law = system.law(i);
        let give = self.geometry.compliance[i * system.components() + i];
        if give * law.stiffness > RIGID {
            let point = law.at(at.p[i], 0.0);
            if point.by_rate > 0.0 { (ROUNDING - 1.0) * point.force / point.by_rate } else { 0.0 }
        } else {
            self.approach_rate(i, at)
        }
    }

    /// Active contacts of the complementarity problem (G + 1/k) F - e >= 0, F >= 0, where every law is
    /// linear and undamped: the sweeps of [`Solver::settle`] start from its solution.
    fn guess_active(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let (m, count) = (system.components(), system.mechanics.groups.len());
        if !system.linear_normals
            || !system.symmetric
            || (0..count).any(|i| system.law(i).damping > 0.0 || system.law(i).bilateral)
        {
            return Ok(());
        }
        self.geometry.update(system, at.t, &at.q, &at.force)?;
        let share = |i: usize| self.geometry.share[i][0];
        let felt: Vec<usize> = (0..count).filter(|&i| share(i) > 0.0).collect();
        let mut matrix: Vec<f64> = felt
            .iter()
            .flat_map(|&i| felt.iter().map(move |&j| i * m + j))
            .map(|at| self.geometry.compliance[at])
            .collect();
        let mut reach = vec![0.0; felt.len()];
        for (r, &i) in felt.iter().enumerate() {
            let per_wheel = system.law(i).stiffness * system.mechanics.groups[i].count() * share(i);
            matrix[r * felt.len() + r] += 1.0 / per_wheel;
            reach[r] = self.geometry.approach(i, &at.q);
        }
        let mut force: Vec<f64> = felt.iter().map(|&i| at.force[i]).collect();
        if complementarity(&matrix, &reach, &mut force).is_some() {
            self.active.fill(false);
            for (&i, f) in felt.iter().zip(force) {
                self.active[i] = f > 0.0;
            }
        }
        Ok(())
    }

    /// Whether an active contact must open: it pulls though it may not, or its part has let go of the wheel.
    pub fn opens(&self, i: usize, at: &State) -> bool {
        let share = self.geometry.share[i][0];
        share == 0.0 || (at.force[i] < 0.0 && !self.bilateral(i))
    }

    /// Remembers the penetration at which contact `i` opens at `at`.
    pub fn keep(&mut self, i: usize, at: &State) {
        self.kept[i] = Some([at.p[i].max(0.0) * (1.0 + ROUNDING), at.t]);
    }

    /// Penetration that spring and damper of open contact `i` still have at `t`: free of force they relax from the one at
    /// which it opened by k p + c p' = 0, and wheel and rail are apart until they meet there. `None` where that is not known.
    fn left(&self, i: usize, t: f64) -> Option<f64> {
        let law = self.system.law(i);
        let [p, since] = self.kept[i].filter(|_| law.has_memory() && law.is_linear())?;
        Some(p * (-(t - since) * law.stiffness / law.damping).exp())
    }

    /// Force that an open contact would have if it closed now, per wheel; positive: it must close.
    pub fn closing(&self, i: usize, at: &State) -> f64 {
        let law = self.system.law(i);
        let share = self.geometry.share[i][0];
        if share == 0.0 {
            return -1.0;
        }
        if law.bilateral {
            return 1.0;
        }
        if let Some(left) = self.left(i, at.t) {
            return law.spring(at.p[i] - left);
        }
        let rate = if law.has_memory() { at.p_rate[i] } else { self.geometry.rate(i, &at.v) };
        let spring = law.spring(at.p[i]);
        if at.p[i] <= 0.0 { spring } else { law.at(at.p[i], rate).force }
    }

    pub fn bilateral(&self, i: usize) -> bool {
        self.system.law(i).bilateral
    }
}
