//! Rules: what is switched when a quantity of the history passes a number.

use crate::{Actuators, Channel, Error, Scene};

/// Something that happens once, as soon as its condition is met.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// When.
    pub when: Condition,
    /// What, in this order.
    pub actions: Vec<Action>,
}

/// A comparison of a sum of channels with a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Channels with their factors.
    pub terms: Vec<(Channel, f64)>,
    /// How the sum is compared.
    pub compare: Compare,
    /// The number it is compared with.
    pub level: f64,
}

/// A comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compare {
    /// >=
    AtLeast,
    /// >
    Above,
    /// <=
    AtMost,
    /// <
    Below,
}

impl Condition {
    /// Time from which it is met, where it compares time alone from below.
    pub(crate) fn time(&self) -> Option<f64> {
        let rises = matches!(self.compare, Compare::AtLeast | Compare::Above);
        match self.terms[..] {
            [(Channel::Time, factor)] if rises && factor > 0.0 => Some(self.level / factor),
            _ => None,
        }
    }

    /// Whether it is met at the sum `value`.
    pub(crate) fn is_met(&self, value: f64) -> bool {
        match self.compare {
            Compare::AtLeast => value >= self.level,
            Compare::Above => value > self.level,
            Compare::AtMost => value <= self.level,
            Compare::Below => value < self.level,
        }
    }
}

/// What a rule does. A command holds until the next one, in place of times and tables of the actuator itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Puts all brakes of a body on, or off.
    Brake {
        /// Which body.
        body: usize,
        /// On or off.
        on: bool,
    },
    /// Lets the drive of a body follow a speed, or turns it off.
    Drive {
        /// Which body.
        body: usize,
        /// The speed; `None`: off.
        speed: Option<f64>,
    },
    /// Hoists with a rope.
    Hoist {
        /// Which rope.
        rope: usize,
        /// Speed, positive where it shortens the rope; 0 holds its unstretched length.
        speed: f64,
    },
    /// Lets a rope go: it pulls no more.
    Release {
        /// Which rope.
        rope: usize,
    },
    /// Ends the run.
    End,
}

/// A rule that acted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fired {
    /// When.
    pub time: f64,
    /// Its index among the rules of the scene.
    pub rule: usize,
}

impl Rule {
    /// Checks the condition's numbers and that what the actions switch is there.
    pub(crate) fn check(&self, scene: &Scene) -> Result<(), Error> {
        let actuators = &scene.actuators;
        let speeds = self.actions.iter().filter_map(|action| match *action {
            Action::Drive { speed, .. } => speed,
            Action::Hoist { speed, .. } => Some(speed),
            _ => None,
        });
        let numbers = self.when.terms.iter().map(|(_, factor)| *factor).chain([self.when.level]);
        if let Some(found) = numbers.chain(speeds).find(|number| !number.is_finite()) {
            return Err(Error::Number { what: "number of a rule", wanted: "finite", found });
        }
        let missing = |what, index| Err(Error::NoSuch { what, index });
        for action in &self.actions {
            match *action {
                Action::Brake { body, .. } if actuators.brakes.iter().all(|brake| brake.body != body) => {
                    return missing("brake of body", body);
                }
                Action::Drive { body, .. } if actuators.drives.iter().all(|drive| drive.body != body) => {
                    return missing("drive of body", body);
                }
                Action::Hoist { rope, .. } | Action::Release { rope } if rope >= actuators.ropes.len() => {
                    return missing("rope", rope);
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// What rules have switched so far; where they have not, actuators follow their own times and tables.
#[derive(Clone, Debug, Default)]
pub(crate) struct Switches {
    brakes: Vec<Option<bool>>,
    drives: Vec<Option<Option<f64>>>,
    hoists: Vec<Option<Hoist>>,
    released: Vec<bool>,
}

/// Hoisting at a speed since a time, when `taken` of the rope was taken in.
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

    /// Carries out `action` at `t`; whether the run ends.
    ///
    /// # Errors
    /// Hoisting that would take in more rope than there is before the end.
    pub fn switch(&mut self, scene: &Scene, action: Action, t: f64) -> Result<bool, Error> {
        let actuators = &scene.actuators;
        match action {
            Action::Brake { body, on } => {
                let own = self.brakes.iter_mut().zip(&actuators.brakes);
                own.filter(|(_, brake)| brake.body == body).for_each(|(command, _)| *command = Some(on));
            }
            Action::Drive { body, speed } => {
                let own = self.drives.iter_mut().zip(&actuators.drives);
                own.filter(|(_, drive)| drive.body == body).for_each(|(command, _)| *command = Some(speed));
            }
            Action::Hoist { rope, speed } => {
                let left = self.natural(actuators, rope, t)[0];
                let found = left - speed * (scene.end - t);
                if found <= 0.0 {
                    let what = "length of a rope that is hoisted";
                    return Err(Error::Number { what, wanted: "positive until the end", found });
                }
                self.hoists[rope] =
                    Some(Hoist { speed, since: t, taken: actuators.ropes[rope].length - left });
            }
            Action::Release { rope } => self.released[rope] = true,
            Action::End => return Ok(true),
        }
        Ok(false)
    }

    /// Whether brake `index` is on at `t`.
    pub fn brakes(&self, actuators: &Actuators, index: usize, t: f64) -> bool {
        self.brakes[index].unwrap_or(t >= actuators.brakes[index].from)
    }

    /// Speed that drive `index` follows at `t`; `None` where it is off.
    pub fn drives(&self, actuators: &Actuators, index: usize, t: f64) -> Option<f64> {
        let drive = &actuators.drives[index];
        self.drives[index].unwrap_or_else(|| (t < drive.until).then(|| drive.speed.at(t)))
    }

    /// Unstretched length of a rope at `t`, and its rate.
    pub fn natural(&self, actuators: &Actuators, rope: usize, t: f64) -> [f64; 2] {
        let given = &actuators.ropes[rope];
        match self.hoists[rope] {
            Some(hoist) => [given.length - hoist.taken - hoist.speed * (t - hoist.since), -hoist.speed],
            None => [given.length - given.speed.integral(t), -given.speed.at(t)],
        }
    }

    /// Second rate of the unstretched length of a rope at `t`.
    pub fn natural_bend(&self, actuators: &Actuators, rope: usize, t: f64) -> f64 {
        if self.hoists[rope].is_some() { 0.0 } else { -actuators.ropes[rope].speed.slope(t) }
    }

    /// Whether link `index`, a rope, was let go.
    pub fn is_released(&self, index: usize) -> bool {
        self.released.get(index).copied().unwrap_or_default()
    }
}
