//! Formulas of design codes for the quantities of a run, one method for each quantity.

use practice::clause::{
    Evidence, FEM_SKEW, aist_2021, asce_7, cmaa_1983, cmaa_2010, en_1991_3, mechanics,
    osha as osha_clause,
};
use practice::skew::Guide;
use practice::{aist, asce, buffer, cmaa, factor, osha, skew};

use super::case::CodeCase;
use super::value::{CodeValues, NO_SPEED};

use Evidence::{Memory, Quoted, Used};

/// How the row of TR-13 for the kind of crane was checked.
pub(super) fn aist_evidence(kind: aist::CraneKind) -> Evidence {
    use aist::CraneKind::{
        Bucket, Ladle, Mill, MotorRoom, Pendant, SoakingPit, Stacker, Stripping,
    };
    match kind {
        Mill | MotorRoom => Quoted,
        Bucket | Stacker | Pendant => Used,
        Ladle | SoakingPit | Stripping => Memory,
    }
}

impl CodeCase<'_> {
    /// Factors on the static vertical force of a wheel or rail.
    pub fn vertical(&self) -> CodeValues {
        let [hoist, dead] = [self.hoist_load_factor(), self.dead_load_factor()];
        let least = |speed: Option<f64>| {
            if speed.is_none() {
                format!(" ({NO_SPEED})")
            } else {
                String::new()
            }
        };
        let [of_dead, of_hoist] = [least(self.crane.speeds[0]), least(self.crane.speeds[2])];
        let kind = self.practice.kind;
        let impact = self.operation().impact();
        CodeValues::default()
            .add(
                en_1991_3("Table 2.4", Used),
                "phi4, travelling on rails within tolerance",
                Some(factor::PHI4),
            )
            .add(
                en_1991_3("2.6, Tables 2.2, 2.4, 2.5", Used),
                format!(
                    "phi1 = {} on dead weight, phi2 = {:.3} on the load",
                    factor::PHI1[1],
                    self.phi2.unwrap_or_default()
                ),
                self.phi2.and_then(|phi2| self.load_factor(factor::PHI1[1], phi2)),
            )
            .add(
                cmaa_2010("3.3.2.1.4", Quoted),
                format!(
                    "DLF = {dead:.3} on dead weight{of_dead}, 1 + HLF = {:.3} on the load{of_hoist}",
                    1.0 + hoist
                ),
                self.load_factor(dead, 1.0 + hoist),
            )
            .add(
                aist_2021("3.7.2, Table 3.2", aist_evidence(kind)),
                "impact on the largest wheel loads",
                Some(1.0 + kind.fractions().impact),
            )
            .add(asce_7("4.9.3", Quoted), "impact on the largest wheel loads", Some(1.0 + impact))
    }

    /// Factors on the load while it is lifted.
    pub fn lifting(&self) -> CodeValues {
        let hoist = self.crane.speeds[2].map(|_| 1.0 + self.hoist_load_factor());
        CodeValues::default()
            .add(
                en_1991_3("Tables 2.4, 2.5", Used),
                "phi2 = phi2,min + beta2 v",
                self.phi2,
            )
            .add(
                cmaa_2010("3.3.2.1.4.2", Quoted),
                "1 + HLF, 0.5 % per ft/min within 15 and 50 %",
                hoist,
            )
    }

    /// Factor on the load after it is released.
    pub fn release(&self) -> CodeValues {
        let phi3 = factor::phi3(1.0, 1.0, self.practice.release).ok();
        CodeValues::default().add(
            en_1991_3("Table 2.4", Used),
            "phi3 = 1 - (dm/m)(1 + beta3), the whole load released",
            phi3,
        )
    }

    /// Lateral force of all wheels together.
    pub fn lateral(&self) -> CodeValues {
        let crane = &self.crane.model;
        let thrust = aist::side_thrust(self.practice.kind, crane).ok();
        let fractions = self.practice.kind.fractions();
        let rule = match self.practice.kind {
            aist::CraneKind::Pendant => {
                format!("{} (Q + T + B), pendant-operated", fractions.crane)
            }
            _ => format!(
                "largest of {} Q, {} (Q + T), {} (Q + T + B)",
                fractions.lifted, fractions.trolley, fractions.crane
            ),
        };
        CodeValues::default()
            .add(
                aist_2021("3.7.2, Table 3.2", aist_evidence(self.practice.kind)),
                rule,
                thrust.map(|thrust| thrust.governing()),
            )
            .add(
                en_1991_3("2.7.5 with 2.11.2", Used),
                "0.1 (Q + T), the trolley accelerates or meets its buffers",
                buffer::trolley_force(crane.lifted, crane.trolley).ok(),
            )
            .add(
                asce_7("4.9.4", Used),
                "0.2 (Q + T)",
                asce::lateral_force(crane.lifted, crane.trolley).ok(),
            )
    }

    /// Lateral force of one wheel.
    pub fn flange(&self) -> CodeValues {
        let (span, base) = (self.crane.model.span, self.crane.wheel_base());
        let near = self.full.map(|full| full.near);
        let of_near = |s: Result<f64, practice::Error>| s.ok().zip(near).map(|(s, near)| s * near);
        let forces = self.skewing();
        let at_angle = forces
            .as_ref()
            .map_or_else(String::new, |found| format!(" at {:.4} rad", found.angle));
        let on_rail = match self.practice.guide {
            Guide::Flanges => "net force on the rail at the front flange, S - H_S,1,1,T",
            Guide::Rollers => "H_S,1,1,T of the front wheel; the guide roller carries S",
        };
        let clause = en_1991_3("2.7.4, Tables 2.7 to 2.9", Used);
        let drives = self.drives();
        CodeValues::default()
            .add(
                clause,
                format!("guide force S = f lambda_S sum Q{at_angle}"),
                forces.as_ref().map(|found| found.guide),
            )
            .add(
                clause,
                format!("{on_rail}{at_angle}"),
                forces.as_ref().map(|found| found.rail),
            )
            .add(
                clause,
                format!("H_S,2,1,T of the front wheel on the other rail{at_angle}"),
                forces.as_ref().map(|found| found.other),
            )
            .add(
                en_1991_3("2.7.2", Used),
                "H_T,1 = phi5 xi2 M/a of the drives, on the more heavily loaded rail",
                drives.map(|drives| drives.heavy),
            )
            .add(
                en_1991_3("2.7.2", Used),
                "H_T,2 = phi5 xi1 M/a of the drives, on the other rail",
                drives.map(|drives| drives.light),
            )
            .add(
                cmaa_2010("3.3.2.2.2", Memory),
                "S_sk times the largest wheel load, at every wheel",
                of_near(cmaa::skew_coefficient(span, base)),
            )
            .add(
                FEM_SKEW,
                "0.025 p/a times the largest wheel load, at every wheel",
                of_near(skew::fem_coefficient(span, base)),
            )
    }

    /// Force of the wheels along one rail.
    pub fn longitudinal(&self) -> CodeValues {
        let most = self.crane.driven[0].max(self.crane.driven[1]);
        let loads = |count: usize| self.full.map(|full| vec![full.near; count]);
        let phi5 = factor::phi5(self.practice.drives)[1];
        let kind = self.practice.kind;
        let all = self.crane.wheels[0].len().max(self.crane.wheels[1].len());
        CodeValues::default()
            .add(
                en_1991_3(
                    "2.7.2, 2.7.3, Table 2.6",
                    if phi5 == 1.5 { Used } else { Memory },
                ),
                format!(
                    "H_L = phi5 K/n_r, phi5 = {phi5}, K by the least wheel loads of the empty crane"
                ),
                self.drives().map(|drives| drives.along),
            )
            .add(
                aist_2021("3.7.2, Table 3.2", aist_evidence(kind)),
                format!(
                    "{} of the largest loads of the driven wheels",
                    kind.fractions().traction
                ),
                loads(most).and_then(|loads| aist::tractive_force(kind, &loads).ok()),
            )
            .add(
                asce_7("4.9.5", Used),
                "0.1 of the largest wheel loads of the rail",
                loads(all).and_then(|loads| asce::longitudinal_force(&loads).ok()),
            )
    }

    /// Force of all end stops together.
    pub fn buffer(&self) -> CodeValues {
        let crane = &self.crane.model;
        let empty = (crane.bridge + crane.trolley) / self.gravity;
        let loaded = crane.weight() / self.gravity;
        let force = |factor: f64, speed: Option<f64>, mass: f64| {
            buffer::buffer_force(factor, speed?, mass, self.crane.stop_stiffness).ok()
        };
        let rated = |fraction: f64| self.crane.speeds[0].map(|speed| fraction * speed);
        let phi7 = buffer::phi7(0.5).ok();
        let by_phi7 =
            |speed: Option<f64>, mass: f64| phi7.and_then(|phi7| force(phi7, speed, mass));
        let clause = en_1991_3("2.11.1, Table 2.10", Used);
        let code = rated(buffer::END_STOP_SPEED);
        let question = "m includes the hoisted load if it cannot swing; EN 13001-2 and CMAA 70 exclude a freely \
                        swinging load: check which applies";
        CodeValues::default()
            .add(
                clause,
                "phi7 v1 sqrt(m S), phi7 = 1.25, v1 = 0.7 of the rated speed, m without the hoisted load",
                by_phi7(code, empty),
            )
            .add(
                clause,
                format!("with hoisted load: phi7 v1 sqrt(m S) at 0.7 of the rated speed, {question}"),
                by_phi7(code, loaded),
            )
            .add(
                clause,
                "the same with the speed of this run, without the hoisted load",
                by_phi7(self.measured.impact_speed, empty),
            )
            .add(
                osha_clause("(e)(2)"),
                "v sqrt(m S), v = 0.4 of the rated speed; so CMAA 70-1983, 3.3.2.1.3.2",
                force(1.0, rated(osha::BUMPER_SPEED), empty),
            )
            .add(
                mechanics("rigid mass"),
                "v sqrt(m S), bridge and trolley as one rigid mass, speed of this run",
                force(1.0, self.measured.impact_speed, empty),
            )
            .add(
                osha_clause("(e)(2), with the balance of work and energy"),
                format!(
                    "m v^2/(2 eta s) of all bumpers together, eta = {}, v = 0.4 of the rated speed",
                    self.practice.bumper_efficiency
                ),
                self.bumper_force(rated(osha::BUMPER_SPEED), empty),
            )
            .add(
                mechanics("balance of work and energy"),
                "m v^2/(2 eta s) of all bumpers together, speed of this run",
                self.bumper_force(self.measured.impact_speed, empty),
            )
    }

    /// Force of bumpers that stop `mass` within their stroke.
    fn bumper_force(&self, speed: Option<f64>, mass: f64) -> Option<f64> {
        let (stroke, efficiency) = (
            self.practice.bumper_stroke?,
            self.practice.bumper_efficiency,
        );
        buffer::stopping_force(mass, speed?, stroke, efficiency).ok()
    }

    /// Force of the buffer between two cranes that collide.
    pub fn collision(&self) -> CodeValues {
        let energy = self
            .crane
            .buffer
            .zip(self.crane.speeds[0])
            .and_then(|(other, speed)| {
                let crane = &self.crane.model;
                let own = (crane.bridge + crane.trolley) / self.gravity;
                cmaa::collision_energy([own, other.weight / self.gravity], [speed, other.speed])
                    .ok()
            });
        let force = energy.zip(self.crane.buffer);
        let force = force.map(|(energy, other)| (2.0 * energy * other.stiffness).sqrt());
        let formula =
            "sqrt(2 k E), E = m1 m2 (0.4 v1 + 0.4 v2)^2/(2 (m1 + m2)) without the loads on ropes";
        CodeValues::default().add(cmaa_1983("3.3.2.1.3.2", Quoted), formula, force)
    }

    /// Limit of the braking distance of bridge (0) or trolley (1) to standstill.
    pub fn braking_distance(&self, body: usize) -> CodeValues {
        let limit = self.measured.brakes[body]
            .and_then(|(_, speed)| osha::brake_distance(speed * self.metre).ok());
        CodeValues::default().add(
            osha_clause("(f)(4)(vii)"),
            "at most the distance of 6 s at the speed when the brakes are applied",
            limit.map(|distance| distance / self.metre),
        )
    }
}
