//! What a run leaves: samples over time.

use crate::Freedom;

/// One quantity of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Channel {
    /// Time.
    Time,
    /// Displacement of a body in one freedom.
    Displacement(usize, Freedom),
    /// Speed of a body in one freedom.
    Speed(usize, Freedom),
    /// Force along +x of a body's drive, or that its prescribed motion needs.
    Drive(usize),
    /// Force along +x of a body's brakes.
    Brake(usize),
    /// Rail coordinate of a wheel.
    Place(usize),
    /// Vertical force of a wheel on the rail.
    Vertical(usize),
    /// Lateral force of a wheel on the rail, +z.
    Lateral(usize),
    /// Force of a wheel on the rail along +x: its friction, and its shares of its body's drive and brake.
    Traction(usize),
    /// Penetration of a wheel into the rail, negative where it is off the rail.
    Penetration(usize),
    /// Downward deflection of the rail under a wheel.
    Give(usize),
    /// Angle of a wheel about z; rolling towards +x turns it negative.
    SpinAngle(usize),
    /// Angular speed of a wheel about z.
    SpinSpeed(usize),
    /// Moment about z that prescribes the spin of wheel i; zero where it is free.
    SpinMoment(usize),
    /// Tension of a rope.
    Tension(usize),
    /// Distance of the ends of a rope.
    Length(usize),
    /// Force of a stop.
    Stop(usize),
    /// Displacement of a gauge along its axis.
    Gauge(usize),
    /// One freedom of a structure that is [recorded](crate::Foundation::recorded): structure, freedom.
    Coordinate(usize, usize),
    /// Its second derivative by time; zero in a quasi-static run.
    Acceleration(usize, usize),
}

/// Samples of every channel at increasing times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    pub(crate) channels: Vec<Channel>,
    pub(crate) values: Vec<f64>,
}

impl History {
    /// The channels, in the order of each sample.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        if self.channels.is_empty() { 0 } else { self.values.len() / self.channels.len() }
    }

    /// Whether nothing was sampled.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Sample `i`, one value a channel.
    #[must_use]
    pub fn sample(&self, i: usize) -> &[f64] {
        let width = self.channels.len();
        &self.values[i * width..(i + 1) * width]
    }

    /// One channel over time; empty where the scene does not have it.
    #[must_use]
    pub fn column(&self, channel: Channel) -> Vec<f64> {
        match self.channels.iter().position(|&c| c == channel) {
            Some(at) => (0..self.len()).map(|i| self.sample(i)[at]).collect(),
            None => Vec::new(),
        }
    }
}
