//! Formulas of design codes for one crane and its run, one method for each quantity.

use practice::skew::WheelPairs;
use practice::{aist, buffer, cmaa, drive, factor, osha, skew};
use serde_json::json;

use super::crane::{CraneData, to_si};
use super::measured::MeasuredCrane;
use formats::scene::{Practice, Scene};
use formats::units::Dimension;

/// A value by a code, with its clause.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeValue {
    /// The code.
    pub code: &'static str,
    /// The clause or table.
    pub clause: &'static str,
    /// The formula in words.
    pub formula: String,
    /// The value.
    pub value: f64,
}

impl CodeValue {
    pub(super) fn json(&self) -> serde_json::Value {
        json!({ "code": self.code, "clause": self.clause, "formula": self.formula, "value": self.value + 0.0 })
    }
}

pub(super) const EN: &str = "EN 1991-3:2006";
pub(super) const CMAA: &str = "CMAA 70";
pub(super) const AIST: &str = "AIST TR-13";
const FEM: &str = "FEM 1.001";
const OSHA: &str = "29 CFR 1910.179";

/// Values for one quantity; values outside the domain of a formula are omitted.
#[derive(Default)]
pub(super) struct CodeValues(pub Vec<CodeValue>);

impl CodeValues {
    fn add(
        mut self,
        code: &'static str,
        clause: &'static str,
        formula: impl Into<String>,
        value: Option<f64>,
    ) -> CodeValues {
        if let Some(value) = value.filter(|value| value.is_finite()) {
            self.0.push(CodeValue { code, clause, formula: formula.into(), value });
        }
        self
    }
}

/// The input of the formulas.
pub(super) struct CodeCase<'c> {
    pub practice: &'c Practice,
    pub crane: &'c CraneData,
    pub measured: &'c MeasuredCrane,
    /// Gravity of the scene.
    pub gravity: f64,
    /// Length unit of the scene, m.
    pub metre: f64,
    /// Dynamic factor phi2 of lifting, where hoisting class and speed are known.
    pub phi2: Option<f64>,
    /// Whether an event of the scene releases a load.
    pub releases_load: bool,
    /// Static loads of a wheel of the loaded crane on the near and the far rail.
    pub full: Option<practice::StaticWheelLoads>,
}

impl<'c> CodeCase<'c> {
    pub fn new(
        scene: &Scene,
        practice: &'c Practice,
        crane: &'c CraneData,
        measured: &'c MeasuredCrane,
    ) -> CodeCase<'c> {
        let metre = to_si(scene.units).factor(Dimension::LENGTH);
        let phi2 = practice
            .hoisting
            .zip(crane.speeds[2])
            .and_then(|(class, speed)| factor::phi2(class, speed * metre).ok());
        let released = |action: &sim::Action| matches!(action, sim::Action::Release { .. });
        CodeCase {
            practice,
            crane,
            measured,
            gravity: scene.gravity,
            metre,
            phi2,
            releases_load: scene.events.iter().flat_map(|event| &event.rule.actions).any(released),
            full: crane.model.wheel_loads(1.0, 1.0).ok(),
        }
    }

    /// Near wheel load with the factors `dead` on the dead weight and `hoist` on the load, divided by that without
    /// factors.
    fn load_factor(&self, dead: f64, hoist: f64) -> Option<f64> {
        let full = self.full?.near;
        let factored = self.crane.model.wheel_loads(dead, hoist).ok()?.near;
        (full > 0.0).then(|| factored / full)
    }

    /// Factors on the static vertical force of a wheel or rail.
    pub fn vertical(&self) -> CodeValues {
        let hlf = self.crane.speeds[2].and_then(|v| cmaa::hoist_load_factor(v * self.metre).ok());
        let dlf = self.crane.speeds[0].and_then(|v| cmaa::dead_load_factor(v * self.metre).ok());
        let hoisted = hlf.unwrap_or(0.15);
        let moved = dlf.unwrap_or(1.1);
        CodeValues::default()
            .add(EN, "Table 2.4", "phi4, travelling on rails within tolerance", Some(factor::PHI4))
            .add(
                EN,
                "2.6, Tables 2.2, 2.4, 2.5",
                format!(
                    "phi1 = {} on dead weight, phi2 = {:.3} on the load",
                    factor::PHI1[1],
                    self.phi2.unwrap_or_default()
                ),
                self.phi2.and_then(|phi2| self.load_factor(factor::PHI1[1], phi2)),
            )
            .add(
                CMAA,
                "3.3.2.1.4 (2010)",
                format!("DLF = {moved:.3} on dead weight, 1 + HLF = {:.3} on the load", 1.0 + hoisted),
                self.load_factor(moved, 1.0 + hoisted),
            )
            .add(
                AIST,
                "3.7.2, Table 3.2 (2021)",
                "impact on the largest wheel loads",
                Some(1.0 + self.practice.kind.fractions().impact),
            )
    }

    /// Factors on the load while it is lifted.
    pub fn lifting(&self) -> CodeValues {
        let speed = self.crane.speeds[2];
        let hlf = speed.and_then(|v| cmaa::hoist_load_factor(v * self.metre).ok());
        CodeValues::default().add(EN, "Tables 2.4, 2.5", "phi2 = phi2,min + beta2 v", self.phi2).add(
            CMAA,
            "3.3.2.1.4.2 (2010)",
            "1 + HLF, 0.5 % per ft/min within 15 and 50 %",
            hlf.map(|hlf| 1.0 + hlf),
        )
    }

    /// Factor on the load after it is released.
    pub fn release(&self) -> CodeValues {
        let phi3 = factor::phi3(1.0, 1.0, self.practice.release).ok();
        CodeValues::default().add(
            EN,
            "Table 2.4",
            "phi3 = 1 - (dm/m)(1 + beta3), the whole load released",
            phi3,
        )
    }

    /// Lateral force of all wheels together.
    pub fn lateral(&self) -> CodeValues {
        let crane = &self.crane.model;
        let moving = crane.lifted + crane.trolley;
        let thrust = aist::side_thrust(self.practice.kind, crane).ok();
        let fractions = self.practice.kind.fractions();
        let inertia = self.measured.acceleration.and_then(|a| cmaa::drive_inertia(a * self.metre).ok());
        CodeValues::default()
            .add(
                AIST,
                "3.7.2, Table 3.2 (2021)",
                format!(
                    "largest of {} Q, {} (Q + T), {} (Q + T + B)",
                    fractions.lifted, fractions.trolley, fractions.crane
                ),
                thrust.map(|thrust| thrust.governing()),
            )
            .add(
                EN,
                "2.7.5 with 2.11.2",
                "0.1 (Q + T)",
                buffer::trolley_force(crane.lifted, crane.trolley).ok(),
            )
            .add(
                CMAA,
                "3.3.2.1.1.5 (1983)",
                "7.8 % of Q + T per ft/s2 of the trolley's acceleration in this run, at least 2.5 %",
                inertia.map(|fraction| fraction * moving),
            )
    }

    /// Lateral force of one wheel.
    pub fn flange(&self) -> CodeValues {
        let (span, base) = (self.crane.model.span, self.crane.wheel_base());
        let near = self.full.map(|full| full.near);
        let of_near = |s: Result<f64, practice::Error>| s.ok().zip(near).map(|(s, near)| s * near);
        let (guide, angle) = self.skewing().unzip();
        let at_angle = angle.map_or_else(String::new, |angle| format!(" at {angle:.4} rad"));
        CodeValues::default()
            .add(EN, "2.7.4, Tables 2.7 to 2.9", format!("guide force S = f lambda_S sum Q{at_angle}"), guide)
            .add(EN, "2.7.2", "H_T,1 = phi5 xi2 M/a of the drives", self.drives().map(|drives| drives.heavy))
            .add(
                CMAA,
                "3.3.2.2.2 (2010)",
                "S_sk times the largest wheel load, at every wheel",
                of_near(cmaa::skew_coefficient(span, base)),
            )
            .add(
                FEM,
                "booklet 2, 2.2.3.3",
                "0.025 p/a times the largest wheel load, at every wheel",
                of_near(skew::fem_coefficient(span, base)),
            )
    }

    /// Guide force and skew angle (rad) of a skewing crane.
    fn skewing(&self) -> Option<(f64, f64)> {
        let crane = self.crane;
        let play = crane.flange_play[0].or(crane.flange_play[1]);
        let given = play.zip(self.practice.rail_head).and_then(|(play, head)| {
            let m = self.metre;
            skew::angle(self.practice.guide, play * m, head * m, crane.wheel_base() * m).ok()
        });
        let angle = given.unwrap_or(skew::MAX_ANGLE).min(skew::MAX_ANGLE);
        let full = self.full?;
        let kind = if crane.flange_play.iter().all(Option::is_some) {
            WheelPairs::AloneFixed
        } else {
            WheelPairs::AloneFree
        };
        let near = full.near / (full.near + full.far);
        let skewing = skew::skewing(kind, crane.model.span, near, &crane.wheel_distances).ok()?;
        let force = skew::friction(angle).ok()? * skewing.guide * crane.model.weight();
        Some((force, angle))
    }

    /// Forces of the drives on the runway while the crane accelerates.
    fn drives(&self) -> Option<drive::DriveForces> {
        let crane = self.crane;
        let wheels = f64::from(crane.model.wheels);
        let empty = crane.model.wheel_loads(1.0, 0.0).ok()?;
        let least = vec![empty.far.min(empty.near); crane.driven[0] + crane.driven[1]];
        let travel = drive::AcceleratingCrane {
            span: crane.model.span,
            guides: crane.wheel_base(),
            heavy: wheels * self.full?.near,
            light: wheels * self.full?.far,
            drive: drive::drive_force(crane.friction?, &least).ok()?,
            factor: factor::phi5(self.practice.drives)[1],
            rails: 2,
        };
        drive::traction(&travel).ok()
    }

    /// Force of the wheels along one rail.
    pub fn longitudinal(&self) -> CodeValues {
        let most = self.crane.driven[0].max(self.crane.driven[1]);
        let loads = self.full.map(|full| vec![full.near; most]);
        let phi5 = factor::phi5(self.practice.drives)[1];
        CodeValues::default()
            .add(
                EN,
                "2.7.2, 2.7.3, Table 2.6",
                format!("H_L = phi5 K/n_r, phi5 = {phi5}, K by the least wheel loads of the empty crane"),
                self.drives().map(|drives| drives.along),
            )
            .add(
                AIST,
                "3.7.2, Table 3.2 (2021)",
                format!(
                    "{} of the largest loads of the driven wheels",
                    self.practice.kind.fractions().traction
                ),
                loads.and_then(|loads| aist::tractive_force(self.practice.kind, &loads).ok()),
            )
    }

    /// Force of all end stops together.
    pub fn buffer(&self) -> CodeValues {
        let crane = &self.crane.model;
        let mass = (crane.bridge + crane.trolley) / self.gravity;
        let force = |factor: f64, speed: Option<f64>| {
            buffer::buffer_force(factor, speed?, mass, self.crane.stop_stiffness).ok()
        };
        let rated = |fraction: f64| self.crane.speeds[0].map(|speed| fraction * speed);
        let phi7 = buffer::phi7(0.5).ok();
        CodeValues::default()
            .add(
                EN,
                "2.11.1, Table 2.10",
                "phi7 v1 sqrt(m S), phi7 = 1.25, v1 = 0.7 of the rated speed",
                phi7.and_then(|phi7| force(phi7, rated(buffer::END_STOP_SPEED))),
            )
            .add(
                EN,
                "2.11.1, Table 2.10",
                "the same with the speed of this run",
                phi7.and_then(|phi7| force(phi7, self.measured.impact_speed)),
            )
            .add(
                OSHA,
                "(e)(2)",
                "v sqrt(m S), v = 0.4 of the rated speed; so CMAA 70-1983, 3.3.2.1.3.2",
                force(1.0, rated(osha::BUMPER_SPEED)),
            )
            .add(
                "mechanics",
                "rigid mass",
                "v sqrt(m S), bridge and trolley as one rigid mass, speed of this run",
                force(1.0, self.measured.impact_speed),
            )
    }

    /// Force of the buffer between two cranes that collide.
    pub fn collision(&self) -> CodeValues {
        let energy = self.crane.buffer.zip(self.crane.speeds[0]).and_then(|(other, speed)| {
            let crane = &self.crane.model;
            let own = (crane.bridge + crane.trolley) / self.gravity;
            cmaa::collision_energy([own, other.weight / self.gravity], [speed, other.speed]).ok()
        });
        let force = energy.zip(self.crane.buffer);
        let force = force.map(|(energy, other)| (2.0 * energy * other.stiffness).sqrt());
        let formula = "sqrt(2 k E), E = m1 m2 (0.4 v1 + 0.4 v2)^2/(2 (m1 + m2)) without the loads on ropes";
        CodeValues::default().add(CMAA, "3.3.2.1.3.2 (1983)", formula, force)
    }

    /// Limit of the braking distance of bridge (0) or trolley (1) to standstill.
    pub fn braking_distance(&self, body: usize) -> CodeValues {
        let limit =
            self.measured.brakes[body].and_then(|(_, speed)| osha::brake_distance(speed * self.metre).ok());
        CodeValues::default().add(
            OSHA,
            "(f)(4)(vii)",
            "at most the distance of 6 s at the speed when the brakes are applied",
            limit.map(|distance| distance / self.metre),
        )
    }
}
