//! Rules: actions that are triggered when a quantity of the history passes a threshold.

use super::channel::Channel;

/// Actions that are executed once, as soon as a condition is met.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Condition that triggers the actions.
    pub when: Condition,
    /// Actions, executed in this order.
    pub actions: Vec<Action>,
}

/// Comparison of a weighted sum of channels with a threshold.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Channels with their factors.
    pub terms: Vec<(Channel, f64)>,
    /// Comparison operator.
    pub compare: Compare,
    /// Threshold.
    pub level: f64,
}

/// Comparison operator.
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
    /// Time at which the condition becomes met, where it only requires that time exceeds a value; `None` otherwise.
    pub(crate) fn time(&self) -> Option<f64> {
        let rises = matches!(self.compare, Compare::AtLeast | Compare::Above);
        match self.terms[..] {
            [(Channel::Time, factor)] if rises && factor > 0.0 => Some(self.level / factor),
            _ => None,
        }
    }

    /// Whether the condition is met for the sum `value`.
    pub(crate) fn is_met(&self, value: f64) -> bool {
        match self.compare {
            Compare::AtLeast => value >= self.level,
            Compare::Above => value > self.level,
            Compare::AtMost => value <= self.level,
            Compare::Below => value < self.level,
        }
    }
}

/// Action of a rule. A command remains in effect until the next one and overrides the times and tables of the
/// actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Applies or releases all brakes of a body.
    Brake {
        /// Which body.
        body: usize,
        /// Whether the brakes are applied.
        on: bool,
    },
    /// Sets the reference speed of the drive of a body, or switches the drive off.
    Drive {
        /// Which body.
        body: usize,
        /// Reference speed; `None`: the drive is switched off.
        speed: Option<f64>,
    },
    /// Sets the hoisting speed of a rope.
    Hoist {
        /// Which rope.
        rope: usize,
        /// Speed, positive where the rope is shortened; at 0 the unstretched length is constant.
        speed: f64,
    },
    /// Releases a rope, which then has no tension.
    Release {
        /// Which rope.
        rope: usize,
    },
    /// Ends the run.
    End,
}

/// Record of a rule that was executed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fired {
    /// Time at which the rule was executed.
    pub time: f64,
    /// Index of the rule in the scene.
    pub rule: usize,
}
