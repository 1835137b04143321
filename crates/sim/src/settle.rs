//! Which vertical contacts act: the complementarity problem of one instant.

use crate::Error;
use crate::complementarity::complementarity;
use crate::energy;
use crate::solver::Solver;
use crate::state::State;

impl Solver<'_> {
    /// Finds which vertical contacts act at (t, q, v), and the forces: the complementarity problem, by sweeps
    /// of the active set. Returns whether it settled.
    pub fn settle(&mut self, at: &mut State) -> Result<bool, Error> {
        let count = self.system.normals.len();
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
                at.p_rate[i] = 0.0;
                continue;
            }
            let deepest = (0..count)
                .filter(|&i| !self.active[i] && self.closing(i, at) > 0.0)
                .max_by(|&i, &j| at.p[i].total_cmp(&at.p[j]));
            let Some(i) = deepest else { return Ok(true) };
            self.active[i] = true;
        }
        Ok(false)
    }

    /// Active contacts of the complementarity problem (G + 1/k) F - (e + (c/k) r) >= 0, F >= 0, where every law is
    /// linear and none remembers its penetration: the sweeps of [`Solver::settle`] start from its solution.
    fn guess_active(&mut self, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let (n, m, count) = (system.freedoms, system.components(), system.normals.len());
        if !system.linear_normals || (0..count).any(|i| system.law(i).has_memory() || system.law(i).bilateral)
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
            let per_wheel = system.law(i).stiffness * system.normals[i].count() * share(i);
            matrix[r * felt.len() + r] += 1.0 / per_wheel;
            let row = &self.geometry.rate_rows[i * n..(i + 1) * n];
            let rate: f64 = row.iter().zip(at.v.iter()).map(|(r, v)| r * v).sum();
            reach[r] = energy::approach(system, &self.geometry, at, i)
                + system.law(i).damping / system.law(i).stiffness * rate;
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
        let n = self.system.freedoms;
        let row = &self.geometry.rate_rows[i * n..(i + 1) * n];
        let rate: f64 = row.iter().zip(at.v.iter()).map(|(r, v)| r * v).sum();
        let spring = law.spring(at.p[i]);
        if at.p[i] <= 0.0 { spring } else { law.at(at.p[i], rate).force }
    }

    pub fn bilateral(&self, i: usize) -> bool {
        self.system.law(i).bilateral
    }
}
