//! A map of where methods work and where they fail.

use report::chart::Series;

/// What a method gave at a point.
#[derive(Clone, Debug, PartialEq)]
pub enum MapVerdict {
    /// What it should.
    Right,
    /// Numbers that look like any others, and are not right; nobody is told.
    Wrong,
    /// Numbers without bound: wrong, and seen to be.
    Diverged,
    /// Wrong, and the program says so.
    Warned,
    /// None, with a message.
    Refused(String),
}

impl MapVerdict {
    /// Their words, in the order of charts.
    pub const WORDS: [&'static str; 5] =
        ["right", "silently wrong", "diverges", "wrong, with a warning", "refused"];

    /// Its word.
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

    /// Of an error: right up to `allowed`, without bound beyond `obvious`.
    #[must_use]
    pub fn of(error: f64, allowed: f64, obvious: f64) -> MapVerdict {
        if error <= allowed {
            MapVerdict::Right
        } else if error < obvious {
            MapVerdict::Wrong
        } else {
            // not a number included
            MapVerdict::Diverged
        }
    }
}

/// A point of a map.
#[derive(Clone, Debug)]
pub struct MapPoint {
    /// Place on the map.
    pub at: [f64; 2],
    /// What the verdict follows from, such as a spectral radius or an error.
    pub value: f64,
    /// The verdict.
    pub verdict: MapVerdict,
}

/// One method over the map.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Its name.
    pub method: String,
    /// Whether it is what the program does.
    pub is_ours: bool,
    /// Its points.
    pub cells: Vec<MapPoint>,
    /// Lines over them.
    pub lines: Vec<Series>,
}

impl Layer {
    /// A method without points.
    #[must_use]
    pub fn new(method: impl Into<String>, is_ours: bool) -> Layer {
        Layer { method: method.into(), is_ours, cells: Vec::new(), lines: Vec::new() }
    }

    /// The same with its points.
    #[must_use]
    pub fn with(self, cells: Vec<MapPoint>) -> Layer {
        Layer { cells, ..self }
    }

    /// How many points have each verdict, in the order of [`Verdict::WORDS`].
    #[must_use]
    pub fn counts(&self) -> [usize; 5] {
        MapVerdict::WORDS.map(|word| self.cells.iter().filter(|cell| cell.verdict.word() == word).count())
    }
}

/// A number found on the way.
#[derive(Clone, Debug)]
pub struct MapFinding {
    /// What it is, with its unit.
    pub what: String,
    /// The number.
    pub value: f64,
}

/// An axis of a map: label, unit, whether logarithmic.
#[derive(Clone, Debug)]
pub struct MapScale {
    /// What is measured.
    pub label: String,
    /// Unit; empty for numbers.
    pub unit: String,
    /// Whether it is logarithmic.
    pub log: bool,
}

impl MapScale {
    /// An axis.
    #[must_use]
    pub fn new(label: &str, unit: &str, log: bool) -> MapScale {
        MapScale { label: label.to_owned(), unit: unit.to_owned(), log }
    }
}

/// A map.
#[derive(Clone, Debug)]
pub struct StabilityMap {
    /// Its name in files.
    pub name: &'static str,
    /// Its heading.
    pub title: String,
    /// Both axes.
    pub axes: [MapScale; 2],
    /// Methods.
    pub layers: Vec<Layer>,
    /// Numbers found on the way.
    pub findings: Vec<MapFinding>,
    /// What the verdicts mean here.
    pub note: String,
}

impl StabilityMap {
    /// A map without layers.
    #[must_use]
    pub fn new(name: &'static str, title: &str, axes: [MapScale; 2], note: &str) -> StabilityMap {
        let (layers, findings) = (Vec::new(), Vec::new());
        StabilityMap { name, title: title.to_owned(), axes, layers, findings, note: note.to_owned() }
    }

    /// Notes a number.
    pub fn find(&mut self, what: impl Into<String>, value: f64) {
        self.findings.push(MapFinding { what: what.into(), value });
    }

    /// Points at which the program itself is silently wrong.
    #[must_use]
    pub fn silent(&self) -> usize {
        let ours = self.layers.iter().filter(|layer| layer.is_ours);
        ours.map(|layer| layer.counts()[1] + layer.counts()[2]).sum()
    }
}
