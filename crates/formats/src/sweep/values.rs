//! A checked sweep, as plain values.

use super::axis_value::AxisValue;
use super::target::{AxisPlace, SweepTarget};

/// A sweep: the runs of a scene or design with other values of its axes.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Its name.
    pub name: String,
    /// File of the scene or design, as the sweep names it.
    pub input: SweepInput,
    /// The files of the scene or design, in which the values of a run are put.
    pub target: SweepTarget,
    /// The axes, in the order of the file.
    pub axes: Vec<SweepAxis>,
    /// How runs are chosen.
    pub sampling: Sampling,
    /// Number of runs.
    pub count: usize,
    /// Seed of random numbers.
    pub seed: u64,
    /// The results of each run, in the order of the file.
    pub results: Vec<ResultKind>,
}

impl Sweep {
    /// Pointers of the axes, which head their columns.
    #[must_use]
    pub fn pointers(&self) -> Vec<String> {
        self.axes.iter().map(|axis| axis.pointer.clone()).collect()
    }
}

/// What is run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SweepInput {
    /// A scene, without its comparisons.
    Scene(String),
    /// A design.
    Design(String),
}

impl SweepInput {
    /// The file as the sweep names it.
    #[must_use]
    pub fn file(&self) -> &str {
        match self {
            SweepInput::Scene(file) | SweepInput::Design(file) => file,
        }
    }
}

/// An axis of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepAxis {
    /// Its pointer as written, which is the heading of its column.
    pub pointer: String,
    /// The value in the files that it varies.
    pub place: AxisPlace,
    /// Its values.
    pub values: AxisValues,
}

/// The values of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisValues {
    /// Values in a list.
    List(Vec<AxisValue>),
    /// Equally spaced values: the first, the last, and their number.
    Range(f64, f64, usize),
    /// A uniform distribution between two values.
    Uniform(f64, f64),
    /// A normal distribution with a mean and a standard deviation.
    Normal(f64, f64),
    /// A lognormal distribution with a mean and a standard deviation, of the values and not of their logarithms.
    Lognormal(f64, f64),
}

impl AxisValues {
    /// Number of values of a list or a range; `None` for a distribution.
    #[must_use]
    pub fn levels(&self) -> Option<usize> {
        match self {
            AxisValues::List(values) => Some(values.len()),
            AxisValues::Range(.., count) => Some(*count),
            AxisValues::Uniform(..) | AxisValues::Normal(..) | AxisValues::Lognormal(..) => None,
        }
    }
}

/// How the runs of a sweep are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// Every combination of the values of the axes; the last axis changes first.
    Grid,
    /// A Latin hypercube: each axis has one value in each of as many intervals of equal probability as there are runs.
    Latin,
    /// The first points of a Sobol sequence, shifted by the seed.
    Sobol,
}

/// Results of a run that become columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ResultKind {
    /// Largest and smallest value of every column of the history.
    Peaks,
    /// Extremes of moments, shear forces, deflections and reactions.
    Extremes,
    /// Fatigue damage of every stress point.
    Fatigue,
    /// Values of the run over those of codes: limits, utilisations of stresses, dynamic factors.
    Ratios,
    /// Largest and smallest value of one column of the history.
    Column(String),
}
