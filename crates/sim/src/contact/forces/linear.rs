//! The forces as the solution of one linear system: of linear laws, and those that hold penetrations.

use super::{Effects, Problem, RowKind};
use crate::contact::element::Local;
use crate::contact::system::System;
use crate::numerics::dense::{solve_general, solve_spd};

impl Problem {
    /// Sets `force` to the forces at which the penetrations that are states keep the values p* they had, W F = e - p*, and
    /// to zero in all other active elements. The law of a damper whose coefficient grows with the penetration is not monotone in
    /// it, so that Newton's method may end at p = 0 where it begins far from p*; in a short step the solution is near p*.
    /// Returns false if there are no such penetrations, or W is singular.
    pub(super) fn hold_penetrations(&mut self, active: &[bool], force: &mut [f64]) -> bool {
        let m = force.len();
        let Effects { w, rate, kind, .. } = &self.effects;
        self.unknown.clear();
        self.unknown
            .extend((0..m).filter(|&i| active[i] && matches!(kind[i], RowKind::Memory(_))));
        let count = self.unknown.len();
        if count == 0 {
            return false;
        }
        for (row, &i) in self.unknown.iter().enumerate() {
            let RowKind::Memory(per_step) = kind[i] else {
                continue;
            };
            // e - p* = g r_0.
            self.residuals.value[row] = rate[i] / per_step;
            for (column, &j) in self.unknown.iter().enumerate() {
                self.matrix[row * count + column] = w[i * m + j];
            }
        }
        let (matrix, held) = (
            &mut self.matrix[..count * count],
            &mut self.residuals.value[..count],
        );
        if !solve_general(matrix, held) {
            return false;
        }
        force.fill(0.0);
        for (&i, held) in self.unknown.iter().zip(held) {
            force[i] = *held;
        }
        true
    }

    /// Solves the linear system F/k + W F + (c/k) Y F = e + (c/k) r, with k and c multiplied by the number of wheels
    /// and the fraction.
    pub(super) fn solve_linear(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &mut [f64],
    ) -> bool {
        let m = force.len();
        let Effects {
            w,
            y,
            approach,
            rate,
            kind,
        } = &self.effects;
        self.factors.elements.clear();
        self.unknown.clear();
        self.unknown
            .extend((0..m).filter(|&i| active[i] && kind[i] != RowKind::Given));
        let count = self.unknown.len();
        let has_given = kind.contains(&RowKind::Given);
        for (row, &i) in self.unknown.iter().enumerate() {
            let law = system.law(i);
            let ratio = law.damping / law.stiffness;
            // A damper between wheel and rail has Y = W/step, so its row is divided by 1 + ratio/step.
            let (scale, by_rate) = match kind[i] {
                RowKind::Memory(per_step) => (1.0 / (1.0 + ratio * per_step), 0.0),
                _ => (1.0, ratio),
            };
            let mut rhs = (approach[i] + ratio * rate[i]) * scale;
            let (own_w, own_y) = (&w[i * m..(i + 1) * m], &y[i * m..(i + 1) * m]);
            let entries = self.matrix[row * count..(row + 1) * count]
                .iter_mut()
                .zip(&self.unknown);
            if by_rate == 0.0 {
                entries.for_each(|(entry, &j)| *entry = own_w[j]);
            } else {
                entries.for_each(|(entry, &j)| *entry = own_w[j] + by_rate * own_y[j]);
            }
            for j in (0..m).filter(|&j| has_given && kind[j] == RowKind::Given) {
                rhs -= (own_w[j] + by_rate * own_y[j]) * force[j];
            }
            let wheels = system.mechanics.groups[i].count();
            self.matrix[row * count + row] +=
                scale / (law.stiffness * wheels * local[i].fraction[0]);
            self.residuals.value[row] = rhs;
        }
        let (matrix, rhs) = (
            &mut self.matrix[..count * count],
            &mut self.residuals.value[..count],
        );
        let is_symmetric = system.traits.is_symmetric
            && !self.unknown.iter().any(|&i| kind[i] == RowKind::Passing);
        let is_solved = if is_symmetric {
            solve_spd(matrix, rhs)
        } else {
            solve_general(matrix, rhs)
        };
        for i in (0..m).filter(|&i| kind[i] != RowKind::Given) {
            force[i] = 0.0;
        }
        for (row, &i) in self.unknown.iter().enumerate() {
            force[i] = self.residuals.value[row];
        }
        is_solved
    }
}
