//! Rules: what is switched when a quantity of the history passes a number.

use super::channel::Channel;

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
