//! Wheels on rails without mass that follow their forces without delay: p + G K p = e.

use nalgebra::{DMatrix, DVector};

use super::Solver;
use crate::Error;
use crate::mechanics::state::State;
use crate::numerics::lu::LuFactors;

/// Contacts at one state: approaches e, compliance G, and the penetrations g of springs K alone, (I + G K) g = e, with
/// their rates g'. Its memory serves for one state after the other.
#[derive(Default)]
pub(crate) struct Followed {
    pub approach: Vec<f64>,
    /// Row by row.
    compliance: Vec<f64>,
    pub value: Vec<f64>,
    pub rate: Vec<f64>,
    speed: Vec<f64>,
    factors: LuFactors,
}

impl Followed {
    /// Compliance of contact `r` under its own force.
    pub fn own_compliance(&self, r: usize) -> f64 {
        self.compliances(r)[r]
    }

    /// Compliances of contact `r` under the forces of all contacts.
    pub fn compliances(&self, r: usize) -> &[f64] {
        let count = self.approach.len();
        &self.compliance[r * count..(r + 1) * count]
    }

    /// Factors of I + G K.
    pub fn factors(&self) -> &LuFactors {
        &self.factors
    }

    /// Sets the compliance, and factors I + G K.
    fn factor(&mut self, compliance: impl Iterator<Item = f64>, stiffness: &[f64]) {
        set(&mut self.compliance, compliance);
        let count = stiffness.len();
        self.factors.replace(count, |matrix| {
            for (r, row) in self.compliance.chunks_exact(count).enumerate() {
                let own = |(c, (entry, stiffness))| f64::from(u8::from(r == c)) + entry * stiffness;
                matrix.extend(row.iter().zip(stiffness).enumerate().map(own));
            }
        });
    }

    /// Contacts without approach on springs of the given `stiffness`.
    #[cfg(test)]
    pub fn of_springs(compliance: impl Fn(usize, usize) -> f64, stiffness: &[f64]) -> Followed {
        let count = stiffness.len();
        let mut made = Followed {
            approach: vec![0.0; count],
            ..Followed::default()
        };
        let compliance = &compliance;
        made.factor(
            (0..count).flat_map(|r| (0..count).map(move |c| compliance(r, c))),
            stiffness,
        );
        made
    }
}

/// Time in which a penetration follows its force, c G/(1 + k G), under a law as [`Solver::law_of`] returns it.
pub(crate) fn delay_of([_, by_place, by_rate]: [f64; 3], compliance: f64) -> f64 {
    by_rate * compliance / (1.0 + by_place * compliance)
}

/// Replaces the contents of a vector.
fn set<T>(out: &mut Vec<T>, values: impl Iterator<Item = T>) {
    out.clear();
    out.extend(values);
}

impl Solver<'_> {
    /// The active vertical contacts.
    pub fn active_contacts(&self) -> impl Iterator<Item = usize> {
        (0..self.system.verticals()).filter(|&i| self.active.has(i))
    }

    /// Derivative of the force of vertical contact `i` by its penetration and by its rate, preceded by the force, at
    /// penetration `p` and rate `rate`.
    pub fn law_of(&self, i: usize, p: f64, rate: f64) -> [f64; 3] {
        let scale = self.system.mechanics.groups[i].count() * self.geometry.fraction(i);
        let value = self.system.law(i).at(p, rate);
        [value.force, value.by_penetration, value.by_rate].map(|value| scale * value)
    }

    /// Sets the rates of penetration of the active contacts to those at which their laws give the forces of `at`. In a
    /// stage the force is an unknown, and accurate, and the rate is a difference of penetrations over its length. After
    /// a very short step, at an event, c times the rounding error of this difference is not negligible.
    pub fn take_rates_from_forces(&self, at: &mut State) {
        for i in (0..self.system.verticals()).filter(|&i| self.remembers(i)) {
            let [force, _, by_rate] = self.law_of(i, at.p[i], at.p_rate[i]);
            let change = (at.force[i] - force) / by_rate;
            if change.is_finite() {
                at.p_rate[i] += change;
            }
        }
    }

    /// Sets `out` to the `contacts` with springs of the given `stiffness` at `at`, for which the geometry must be current.
    /// The rate of e contains the motion of the wheels along the rail, and the rate of G that of all wheels: dG_ij/dt = x_i'
    /// dG_ij/dx_i + x_j' dG_ji/dx_j, for a symmetric compliance. Returns false if the matrix is singular, or if forces of
    /// other elements deflect the rails below these wheels.
    pub fn follow(
        &self,
        at: &State,
        contacts: &[usize],
        stiffness: &[f64],
        out: &mut Followed,
    ) -> bool {
        let m = at.force.len();
        let (rows, rails) = (self.geometry.rows(), self.geometry.rails());
        // Forces of other elements that deflect the rails below these wheels are not included.
        let is_other = |j: &usize| at.force[*j] != 0.0 && !contacts.contains(j);
        let is_coupled = |j: usize| contacts.iter().any(|&i| rails.value[i * m + j] != 0.0);
        if (0..m).filter(is_other).any(is_coupled) {
            return false;
        }
        let compliance = contacts
            .iter()
            .flat_map(|&i| contacts.iter().map(move |&j| rails.value[i * m + j]));
        out.factor(compliance, stiffness);
        let Followed {
            approach,
            value,
            rate,
            speed,
            factors,
            ..
        } = out;
        set(
            speed,
            contacts.iter().map(|&i| self.system.contact_speed(i, at)),
        );
        set(
            approach,
            contacts.iter().map(|&i| self.geometry.approach(i, &at.q)),
        );
        value.clone_from(approach);
        if !factors.solve(value) {
            return false;
        }
        let rate_of = |(r, &i): (usize, &usize)| {
            let slope = rows.rise[i] - self.geometry.shape_slope(i, &at.q);
            let mut rate = rows.approach_along(i, &at.v) + slope * speed[r];
            for (c, &j) in contacts.iter().enumerate() {
                let passing = speed[r] * rails.slope[i * m + j] + speed[c] * rails.slope[j * m + i];
                rate -= passing * stiffness[c] * value[c];
            }
            rate
        };
        set(rate, contacts.iter().enumerate().map(rate_of));
        factors.solve(rate)
    }

    /// Sets the forces to those of the laws, at the penetrations of `at`, corrected once, and at their rates, and
    /// the accelerations to those by these forces. The correction is -(I + G K)^-1 (p + G F - e), with `factors` of I + G K at a
    /// state near to this one; an error of the rates then enters the forces as where the equation is solved. Returns false
    /// if elements other than active vertical contacts may have forces, if one of these must open, if rows depend on the
    /// forces, or if laws are not linear: penetrations then differ more from those of the springs.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn apply_laws(
        &mut self,
        at: &mut State,
        factors: &LuFactors,
        residual: &mut Vec<f64>,
    ) -> Result<bool, Error> {
        let (system, count) = (self.system, self.system.elements.len());
        let traits = &system.traits;
        let is_simple =
            traits.has_constant_rows && traits.has_linear_laws && count == system.verticals();
        if !(is_simple && (0..count).all(|i| self.active.has(i))) {
            return Ok(false);
        }
        self.update(at)?;
        for i in 0..count {
            // a rigid rail has no deflection, not one by rounding
            if self.geometry.own_compliance(i) == 0.0 {
                at.p[i] = self.geometry.approach(i, &at.q);
            }
            at.force[i] = self.law_of(i, at.p[i], at.p_rate[i])[0];
        }
        set(
            residual,
            (0..count).map(|i| at.p[i] - self.geometry.penetration(i, at)),
        );
        if !factors.solve(residual) {
            return Ok(false);
        }
        for (i, error) in residual.iter().enumerate() {
            at.p[i] -= error;
            at.force[i] = self.law_of(i, at.p[i], at.p_rate[i])[0];
            if self.opens(i, at) {
                return Ok(false);
            }
        }
        self.update_rail_slope(at);
        self.free
            .accelerate(system, at, &self.geometry.rows().force)?;
        Ok(true)
    }

    /// Whether a damper acts between the wheel of active vertical contact `i` and a rail with mass, or a rigid one.
    fn is_damped_by_mass(&self, i: usize) -> bool {
        let structure =
            self.system.scene.contacts[self.system.mechanics.groups[i].contact].structure;
        let has_mass = self.system.foundations[structure].structure.is_some();
        self.remembers(i) && (has_mass || self.is_on_rigid_rail(i))
    }

    /// Sets the penetration rates of the active contacts with a damper between the wheel and a rail with mass, or a
    /// rigid one, to those of a motion in which the compliance of the rails follows the forces of `at` without delay:
    /// (I + G K) r = e' - G' F, with the stiffnesses K of the laws. The geometry must belong to `at`. Returns false if
    /// there are no such contacts.
    pub fn follow_rails(&self, at: &mut State) -> bool {
        let contacts: Vec<usize> = self.active_contacts().collect();
        if !contacts.iter().any(|&i| self.is_damped_by_mass(i)) {
            return false;
        }
        let (count, m, rails) = (contacts.len(), at.force.len(), self.geometry.rails());
        let mut rates = DVector::from_fn(count, |r, _| {
            let i = contacts[r];
            let passing = contacts
                .iter()
                .map(|&j| rails.slope[j * m + i] * self.system.contact_speed(j, at) * at.force[j]);
            self.approach_rate(i, at) - passing.sum::<f64>()
        });
        let stiffness = |i: usize| self.law_of(i, at.p[i], at.p_rate[i])[1];
        let matrix = DMatrix::from_fn(count, count, |r, c| {
            let own = f64::from(u8::from(r == c));
            own + rails.value[contacts[r] * m + contacts[c]] * stiffness(contacts[c])
        });
        if !LuFactors::new(&matrix).solve(rates.as_mut_slice()) {
            return false;
        }
        for (&i, rate) in contacts
            .iter()
            .zip(rates.iter())
            .filter(|(i, _)| self.is_damped_by_mass(**i))
        {
            at.p_rate[i] = *rate;
        }
        true
    }
}
