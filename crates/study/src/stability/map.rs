//! Maps of where methods work and where they fail: one layer for each method, one verdict for each point.
//!
//! # Example
//! ```
//! use study::stability::{MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
//!
//! // Explicit Euler on z' = -z: its factor per step is 1 - h, so that it diverges for h > 2.
//! let axes = [MapScale::new("step", "s", false), MapScale::new("amplification", "", false)];
//! let mut map = StabilityMap::new("euler", "Explicit Euler", axes, "Wrong where the solution grows.");
//! let points = [0.5_f64, 1.5, 2.5].map(|h| {
//!     let value = (1.0 - h).abs();
//!     MapPoint { at: [h, value], value, verdict: MapVerdict::of(value, 1.0, 10.0) }
//! });
//! map.layers.push(MapLayer::new("explicit Euler", false).with(points.to_vec()));
//! map.note("largest stable step, s", 2.0);
//!
//! assert_eq!(map.layers[0].counts(), [2, 1, 0, 0, 0]);
//! assert_eq!(map.silent_count(), 0, "no layer is the program's own");
//! ```

use report::chart::Series;

/// Judgement of what a method returns at a point.
#[derive(Clone, Debug, PartialEq)]
pub enum MapVerdict {
    /// The method is right.
    Right,
    /// Its numbers look plausible and are wrong, and no message says so.
    Wrong,
    /// Its numbers grow without bound, which a user sees.
    Diverged,
    /// Its numbers are wrong, and a warning says so.
    Warned,
    /// It returns no numbers but this message.
    Refused(String),
}

impl MapVerdict {
    /// Words of the verdicts in files and legends, in the order of charts.
    pub const WORDS: [&'static str; 5] = [
        "right",
        "silently wrong",
        "diverges",
        "wrong, with a warning",
        "refused",
    ];

    /// The word of the verdict in files and legends.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        let at = match self {
            MapVerdict::Right => 0,
            MapVerdict::Wrong => 1,
            MapVerdict::Diverged => 2,
            MapVerdict::Warned => 3,
            MapVerdict::Refused(_) => 4,
        };
        MapVerdict::WORDS[at]
    }

    /// The verdict on an error: right up to `allowed`, diverged from `obvious` on or where it is not a number, else
    /// wrong.
    #[must_use]
    pub fn of(error: f64, allowed: f64, obvious: f64) -> MapVerdict {
        if error <= allowed {
            MapVerdict::Right
        } else if error < obvious {
            MapVerdict::Wrong
        } else {
            // also where the error is not a number
            MapVerdict::Diverged
        }
    }
}

/// A point of a map.
#[derive(Clone, Debug)]
pub struct MapPoint {
    /// Coordinates on both axes.
    pub at: [f64; 2],
    /// The number that the verdict follows from, such as a spectral radius or an error.
    pub value: f64,
    /// The verdict.
    pub verdict: MapVerdict,
}

/// One method over the map.
#[derive(Clone, Debug)]
pub struct MapLayer {
    /// Its name.
    pub method: String,
    /// Whether it is a method of this program.
    pub is_ours: bool,
    /// Its points.
    pub points: Vec<MapPoint>,
    /// Lines drawn over the points.
    pub lines: Vec<Series>,
}

impl MapLayer {
    /// A layer without points.
    #[must_use]
    pub fn new(method: impl Into<String>, is_ours: bool) -> MapLayer {
        MapLayer {
            method: method.into(),
            is_ours,
            points: Vec::new(),
            lines: Vec::new(),
        }
    }

    /// The same layer with these points.
    #[must_use]
    pub fn with(self, points: Vec<MapPoint>) -> MapLayer {
        MapLayer { points, ..self }
    }

    /// The number of points of each verdict, in the order of [`MapVerdict::WORDS`].
    #[must_use]
    pub fn counts(&self) -> [usize; 5] {
        MapVerdict::WORDS.map(|word| {
            self.points
                .iter()
                .filter(|point| point.verdict.word() == word)
                .count()
        })
    }
}

/// A single number that a map reports in addition to its points.
#[derive(Clone, Debug)]
pub struct MapFinding {
    /// What it is, with its unit.
    pub what: String,
    /// The number.
    pub value: f64,
}

/// Label, unit and scale of an axis of a map.
#[derive(Clone, Debug)]
pub struct MapScale {
    /// What is measured.
    pub label: String,
    /// Unit; empty for dimensionless quantities.
    pub unit: String,
    /// Whether the axis is logarithmic.
    pub log: bool,
}

impl MapScale {
    /// An axis from its parts.
    #[must_use]
    pub fn new(label: &str, unit: &str, log: bool) -> MapScale {
        MapScale {
            label: label.to_owned(),
            unit: unit.to_owned(),
            log,
        }
    }
}

/// Verdicts of several methods over two axes.
#[derive(Clone, Debug)]
pub struct StabilityMap {
    /// Its name in files.
    pub name: &'static str,
    /// Its heading.
    pub title: String,
    /// Both axes.
    pub axes: [MapScale; 2],
    /// Methods.
    pub layers: Vec<MapLayer>,
    /// Single numbers in addition to the points.
    pub findings: Vec<MapFinding>,
    /// Meaning of the verdicts on this map.
    pub note: String,
}

impl StabilityMap {
    /// A map without layers.
    #[must_use]
    pub fn new(name: &'static str, title: &str, axes: [MapScale; 2], note: &str) -> StabilityMap {
        let (layers, findings) = (Vec::new(), Vec::new());
        StabilityMap {
            name,
            title: title.to_owned(),
            axes,
            layers,
            findings,
            note: note.to_owned(),
        }
    }

    /// Adds a single number.
    pub fn note(&mut self, what: impl Into<String>, value: f64) {
        self.findings.push(MapFinding {
            what: what.into(),
            value,
        });
    }

    /// Number of points at which the program itself is wrong without a warning.
    #[must_use]
    pub fn silent_count(&self) -> usize {
        let ours = self.layers.iter().filter(|layer| layer.is_ours);
        ours.map(|layer| layer.counts()[1] + layer.counts()[2])
            .sum()
    }
}
