//! Results of a run: samples over time.

use crate::scene::channel::Channel;

/// Samples of every channel at increasing times.
///
/// Values are stored sample by sample. [`History::samples`] and [`History::sample`] return slices over all channels,
/// and [`History::values`] iterates over one channel; none of them copies.
/// ```
/// # use std::ops::ControlFlow;
/// # use sim::{Body, Channel, Contact, Damper, Foundation, BodyDof, NormalLaw, Scene, Wheel};
/// # let scene = Scene {
/// #     bodies: vec![Body { free: [false, true, false, false, false, false], ..Body::new(1000.0, [0.0; 3]) }],
/// #     wheels: vec![Wheel::new(0.5, NormalLaw::linear(1e7, 0.0, Damper::Rail))],
/// #     contacts: vec![Contact::new(0, [0.0; 3])],
/// #     ..Scene::default()
/// # };
/// // A mass of 1 t at rest on its wheel for 1 s.
/// let history = sim::run(&scene, &[Foundation::rigid()], &mut |_| ControlFlow::Continue(()))?.history;
/// let force = history.position(Channel::Vertical(0)).expect("the scene has a wheel");
/// assert!(history.samples().all(|sample| (sample[force] / 9810.0 - 1.0).abs() < 1e-5));
/// let (time, y) = (history.values(Channel::Time), history.values(Channel::Displacement(0, BodyDof::Y)));
/// assert_eq!((time.len(), y.len()), (101, 101));
/// # Ok::<(), sim::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    channels: Vec<Channel>,
    /// Values of all channels, sample by sample.
    values: Vec<f64>,
}

impl History {
    /// The history of `channels` with these values, sample by sample.
    pub(crate) fn of(channels: Vec<Channel>, values: Vec<f64>) -> Self {
        History { channels, values }
    }

    /// Every `step`-th sample from the first one, and the last one if `with_last`.
    #[must_use]
    pub(crate) fn every(self, step: usize, with_last: bool) -> History {
        if step <= 1 {
            return self;
        }
        let last = self.len().saturating_sub(1);
        let kept = (0..self.len()).filter(|i| i % step == 0 || (with_last && *i == last));
        let values = kept.flat_map(|i| self.sample(i).iter().copied()).collect();
        History {
            channels: self.channels,
            values,
        }
    }

    /// The channels, in the order of each sample.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        if self.channels.is_empty() {
            0
        } else {
            self.values.len() / self.channels.len()
        }
    }

    /// Whether there are no samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Sample `i`, with one value for each channel.
    #[must_use]
    pub fn sample(&self, i: usize) -> &[f64] {
        let width = self.channels.len();
        &self.values[i * width..(i + 1) * width]
    }

    /// All samples in their order, each with one value for each channel, without a copy.
    pub fn samples(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.channels.len().max(1))
    }

    /// Position of a channel in every sample; `None` if the scene does not have it.
    #[must_use]
    pub fn position(&self, channel: Channel) -> Option<usize> {
        self.channels.iter().position(|&known| known == channel)
    }

    /// One channel over time, without a copy; empty if the scene does not have it.
    pub fn values(&self, channel: Channel) -> impl ExactSizeIterator<Item = f64> + Clone + '_ {
        let (samples, at) = match self.position(channel) {
            Some(at) => (self.values.as_slice(), at),
            None => (&[][..], 0),
        };
        samples
            .chunks_exact(self.channels.len().max(1))
            .map(move |sample| sample[at])
    }

    /// One channel over time; empty if the scene does not have it.
    #[must_use]
    pub fn column(&self, channel: Channel) -> Vec<f64> {
        self.values(channel).collect()
    }
}
