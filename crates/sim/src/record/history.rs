//! What a run leaves: samples over time.

use crate::scene::channel::Channel;

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
