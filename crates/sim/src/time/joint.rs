//! Joints of rails that give along x.

use crate::Error;
use crate::numerics::dense::along;
use crate::record::energy::stored;
use crate::time::stepper::{PASSED, Stepper};

impl Stepper<'_, '_> {
    /// Where the step has ended at a joint of a rail, the wheel there goes over to another part, which the same forces
    /// have displaced along x by another way: the displacement jumps, and slides nowhere. What pushes along x then pushes
    /// that part, so that the rail below all wheels jumps as well, by Maxwell's theorem with as much work: penetrations
    /// follow. Returns the energy put in.
    pub(crate) fn pass_joint(&mut self) -> Result<f64, Error> {
        let system = self.solver.system;
        let Some(w) = self.meets.take().filter(|_| system.is_dragged) else { return Ok(0.0) };
        let (x, speed) =
            (self.solver.geometry.place(system, w, &self.to.q), system.mechanics.speed_along(w, &self.to));
        let near = PASSED * self.nearness() * (1.0 + x.abs());
        let contact = &system.scene.contacts[system.mechanics.wheels[w].contact];
        let foundation = &system.foundations[contact.structure];
        let is_there = foundation.breaks_between(contact.rail, x - near, x + near).next().is_some();
        if !is_there || speed == 0.0 {
            return Ok(0.0);
        }
        let before = stored(system, &self.solver.geometry, &self.to);
        let felt: Vec<usize> =
            (0..system.mechanics.groups.len()).filter(|&i| self.solver.remembers(i)).collect();
        for &i in &felt {
            self.to.p[i] += along(&self.solver.geometry.compliance, i, &self.to.force);
        }
        self.probe.q.copy_from(&self.to.q);
        self.probe.q.axpy(near / speed.abs(), &self.to.v, 1.0);
        self.solver.geometry.leave();
        self.solver.geometry.update(system, self.to.t, &self.probe.q, &self.to.force)?;
        for i in felt {
            self.to.p[i] -= along(&self.solver.geometry.compliance, i, &self.to.force);
        }
        for (k, i) in system.drags().enumerate() {
            self.to.p[system.mechanics.groups.len() + k] =
                along(&self.solver.geometry.compliance, i, &self.to.force);
        }
        Ok(stored(system, &self.solver.geometry, &self.to).total() - before.total())
    }
}
