//! The input of the formulas of codes: a crane, its run, and what follows from both.

use practice::aist::CraneKind;
use practice::asce::CraneOperation;
use practice::skew::{Guide, WheelPairs};
use practice::{cmaa, drive, factor, skew};

use super::crane::{CraneData, to_si};
use super::measured::MeasuredCrane;
use formats::scene::{Practice, Scene};
use formats::units::Dimension;

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

/// Forces of a crane that skews, in the units of the scene.
pub(super) struct SkewingForces {
    /// The skewing angle, rad.
    pub angle: f64,
    /// S, the guide force.
    pub guide: f64,
    /// The force on the rail at the guide: S - H_S,1,1,T for flanges, H_S,1,1,T for rollers.
    pub rail: f64,
    /// H_S,2,1,T, of the front wheel on the other rail.
    pub other: f64,
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
            releases_load: scene
                .events
                .iter()
                .flat_map(|event| &event.rule.actions)
                .any(released),
            full: crane.model.wheel_loads(1.0, 1.0).ok(),
        }
    }

    /// Near wheel load with the factors `dead` on the dead weight and `hoist` on the load, divided by that without
    /// factors.
    pub fn load_factor(&self, dead: f64, hoist: f64) -> Option<f64> {
        let full = self.full?.near;
        let factored = self.crane.model.wheel_loads(dead, hoist).ok()?.near;
        (full > 0.0).then(|| factored / full)
    }

    /// Hoist load factor HLF of CMAA 70: by the hoisting speed, otherwise its least value.
    pub fn hoist_load_factor(&self) -> f64 {
        let speed = self.crane.speeds[2].map(|speed| speed * self.metre);
        let factor = speed.and_then(|speed| cmaa::hoist_load_factor(speed).ok());
        factor.unwrap_or(cmaa::LEAST_HOIST_LOAD_FACTOR)
    }

    /// Dead load factor DLF of CMAA 70: by the speed of the bridge, otherwise its least value.
    pub fn dead_load_factor(&self) -> f64 {
        let speed = self.crane.speeds[0].map(|speed| speed * self.metre);
        let factor = speed.and_then(|speed| cmaa::dead_load_factor(speed).ok());
        factor.unwrap_or(cmaa::LEAST_DEAD_LOAD_FACTOR)
    }

    /// How the crane is operated, for ASCE 7.
    pub fn operation(&self) -> CraneOperation {
        match self.practice.kind {
            CraneKind::Pendant => CraneOperation::Pendant,
            _ => CraneOperation::Cab,
        }
    }

    /// Forces of a skewing crane.
    pub fn skewing(&self) -> Option<SkewingForces> {
        let crane = self.crane;
        let play = crane.flange_play[0].or(crane.flange_play[1]);
        let given = play.zip(self.practice.rail_head).and_then(|(play, head)| {
            let m = self.metre;
            skew::angle(
                self.practice.guide,
                play * m,
                head * m,
                crane.wheel_base() * m,
            )
            .ok()
        });
        let angle = given.unwrap_or(skew::MAX_ANGLE);
        let full = self.full?;
        let kind = if crane.flange_play.iter().all(Option::is_some) {
            WheelPairs::AloneFixed
        } else {
            WheelPairs::AloneFree
        };
        let near = full.near / (full.near + full.far);
        let skewing = skew::skewing(kind, crane.model.span, near, &crane.wheel_distances).ok()?;
        let scale = skew::friction(angle).ok()? * crane.model.weight();
        let front = skewing.across.first()?;
        let rail = match self.practice.guide {
            Guide::Flanges => skewing.net_on_rail(),
            Guide::Rollers => front[0],
        };
        Some(SkewingForces {
            angle,
            guide: scale * skewing.guide,
            rail: scale * rail,
            other: scale * front[1],
        })
    }

    /// Forces of the drives on the runway while the crane accelerates.
    pub fn drives(&self) -> Option<drive::DriveForces> {
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
}
