//! The switching state set by rules: brakes, drives, hoisting speeds and released ropes.

use crate::{Action, Actuators, Error, Scene};

/// The switching state set by rules. An actuator that no rule has switched follows its own times and tables.
#[derive(Clone, Debug, Default)]
pub(crate) struct Switches {
    brakes: Vec<Option<bool>>,
    drives: Vec<Option<Option<f64>>>,
    hoists: Vec<Option<Hoist>>,
    released: Vec<bool>,
}

/// Hoisting at a constant speed since a time at which the length `taken` had been wound up.
#[derive(Clone, Copy, Debug)]
struct Hoist {
    speed: f64,
    since: f64,
    taken: f64,
}

impl Switches {
    pub fn new(actuators: &Actuators) -> Switches {
        let ropes = actuators.ropes.len();
        Switches {
            brakes: vec![None; actuators.brakes.len()],
            drives: vec![None; actuators.drives.len()],
            hoists: vec![None; ropes],
            released: vec![false; ropes],
        }
    }

    /// Executes `action` at `t`. Returns whether the run ends.
    ///
    /// # Errors
    /// A hoisting speed that would wind up the whole rope before the end of the run.
    pub fn switch(&mut self, scene: &Scene, action: Action, t: f64) -> Result<bool, Error> {
        let actuators = &scene.actuators;
        match action {
            Action::Brake { body, on } => {
                let own = self.brakes.iter_mut().zip(&actuators.brakes);
                own.filter(|(_, brake)| brake.body == body)
                    .for_each(|(command, _)| *command = Some(on));
            }
            Action::Drive { body, speed } => {
                let own = self.drives.iter_mut().zip(&actuators.drives);
                own.filter(|(_, drive)| drive.body == body)
                    .for_each(|(command, _)| *command = Some(speed));
            }
            Action::Hoist { rope, speed } => {
                let left = self.unstretched(actuators, rope, t)[0];
                let found = left - speed * (scene.end - t);
                if found <= 0.0 {
                    let what = "length of a rope that is hoisted";
                    return Err(Error::Number {
                        what,
                        wanted: "positive until the end",
                        found,
                    });
                }
                self.hoists[rope] = Some(Hoist {
                    speed,
                    since: t,
                    taken: actuators.ropes[rope].length - left,
                });
            }
            Action::Release { rope } => self.released[rope] = true,
            Action::End => return Ok(true),
        }
        Ok(false)
    }

    /// Whether brake `index` is on at `t`.
    pub fn is_braking(&self, actuators: &Actuators, index: usize, t: f64) -> bool {
        self.brakes[index].unwrap_or(t >= actuators.brakes[index].from)
    }

    /// Reference speed of drive `index` at `t`; `None` if it is off.
    pub fn drive_speed(&self, actuators: &Actuators, index: usize, t: f64) -> Option<f64> {
        let drive = &actuators.drives[index];
        self.drives[index].unwrap_or_else(|| (t < drive.until).then(|| drive.speed.at(t)))
    }

    /// Unstretched length of a rope at `t`, and its rate.
    pub fn unstretched(&self, actuators: &Actuators, rope: usize, t: f64) -> [f64; 2] {
        let given = &actuators.ropes[rope];
        match self.hoists[rope] {
            Some(hoist) => [
                given.length - hoist.taken - hoist.speed * (t - hoist.since),
                -hoist.speed,
            ],
            None => [given.length - given.speed.integral(t), -given.speed.at(t)],
        }
    }

    /// Second time derivative of the unstretched length of a rope at `t`.
    pub fn unstretched_acceleration(&self, actuators: &Actuators, rope: usize, t: f64) -> f64 {
        if self.hoists[rope].is_some() {
            0.0
        } else {
            -actuators.ropes[rope].speed.slope(t)
        }
    }

    /// Whether rope `rope` has been released.
    pub fn is_released(&self, rope: usize) -> bool {
        self.released.get(rope).copied().unwrap_or_default()
    }
}
