//! Small motions since the last update of the geometry: whether its data still serve, and what the wheels' motion changes in
//! the penetrations.

use nalgebra::DVector;

use super::Geometry;
use crate::contact::system::System;
use crate::numerics::dense::along;

/// Effect of the motion of the wheels since the last update, to first order.
#[derive(Clone)]
pub(super) struct Drift {
    /// Motion of every wheel along its rail.
    wheels: Vec<f64>,
    /// Change of the approach of every element less the deflection of its rail.
    change: Vec<f64>,
}

impl Drift {
    /// No motion of `wheels` wheels and `elements` elements.
    pub fn zeros(wheels: usize, elements: usize) -> Self {
        Drift { wheels: vec![0.0; wheels], change: vec![0.0; elements] }
    }

    /// Begins anew at an update.
    pub fn clear(&mut self) {
        self.change.fill(0.0);
    }
}

impl Geometry {
    /// Finds the change of the approach of each element less the deflection of its rail, where this is a state, by the motion
    /// dx of the wheels since the last update to the displacements `q` at the same time, under the forces `force`:
    ///
    /// (h_i' - w_i') dx_i - sum_j (dG_ij/dx_i dx_i + dG_ji/dx_j dx_j) F_j
    ///
    /// to first order, with the slopes h' of the unloaded rail and w' of the shapes of structures. It is zero where the
    /// compliance of a structure is not symmetric.
    pub fn drift_to(&mut self, system: &System, q: &DVector<f64>, force: &[f64]) {
        if !(system.traits.follows_motion && system.traits.has_symmetric_rails) {
            return;
        }
        let (mechanics, m) = (&system.mechanics, force.len());
        let mut drift = std::mem::replace(&mut self.drift, Drift::zeros(0, 0));
        let Drift { wheels, change } = &mut drift;
        for (w, moved) in wheels.iter_mut().enumerate() {
            *moved = self.places.of_wheel(mechanics, w, q) - self.places.x[w];
        }
        let slopes = &self.rails.matrices().slope;
        for &i in &system.probes.states {
            let moved = system.first_wheel[i].map_or(0.0, |wheel| wheels[wheel]);
            change[i] = moved * (self.rows.rise[i] - along(slopes, i, force));
            if mechanics.has_structures() {
                change[i] -= moved * self.shape_slope(i, q);
            }
        }
        for (j, force) in force.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            let Some(wheel) = system.first_wheel[j] else { continue };
            let share = wheels[wheel] * force;
            let row = &slopes[j * m..(j + 1) * m];
            for &i in &system.probes.states {
                change[i] -= share * row[i];
            }
        }
        self.drift = drift;
    }

    /// Change of the approach of element `i` less the deflection of its rail by the last [`Geometry::drift_to`]; zero
    /// immediately after an update, and where it is no state.
    #[inline]
    pub fn drift(&self, i: usize) -> f64 {
        self.drift.change[i]
    }

    /// Whether the data at the displacements `before` serve at `now`, at the same time. All data change by a part of the
    /// order of dq/L, with the lengths L of rail elements, irregularities and ropes, times the displacements of the bodies
    /// alone: rows are linear in those of structures. A change dh of the height of a wheel changes the approach of its
    /// flange by dh times its roll, and the sliding velocity of a spinning wheel by dh times its spin.
    pub fn is_near(&self, system: &System, before: &DVector<f64>, now: &DVector<f64>) -> bool {
        if !system.traits.has_symmetric_rails {
            return false;
        }
        let bodies = system.mechanics.body_dofs();
        let mut moved = before.as_slice().iter().zip(now.as_slice()).take(bodies);
        if !moved.all(|(before, now)| (now - before).abs() <= self.near) {
            return false;
        }
        let by_height = system.by_height.list().iter();
        by_height.filter_map(|&i| Some((i, system.first_wheel[i]?))).all(|(i, wheel)| {
            let raised = (self.places.height[wheel] - self.height[wheel]).abs();
            let arm =
                if system.fixed[i].is_tangential { 1.0 } else { system.mechanics.roll(wheel, now).abs() };
            raised * arm <= self.near
        })
    }
}
