//! A map of where methods work and where they fail.

use report::chart::Series;

/// What a method gave at a point.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
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

impl Verdict {
    /// Their words, in the order of charts.
    pub const WORDS: [&'static str; 5] =
        ["right", "silently wrong", "diverges", "wrong, with a warning", "refused"];

    /// Its word.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        let at = match self {
            Verdict::Right => 0,
            Verdict::Wrong => 1,
            Verdict::Diverged => 2,
            Verdict::Warned => 3,
            Verdict::Refused(_) => 4,
        };
        Verdict::WORDS[at]
    }

    /// Of an error: right up to `allowed`, without bound beyond `obvious`.
    #[must_use]
    pub fn of(error: f64, allowed: f64, obvious: f64) -> Verdict {
        if error <= allowed {
            Verdict::Right
        } else if error < obvious {
            Verdict::Wrong
        } else {
            // not a number included
            Verdict::Diverged
        }
    }
}

/// A point of a map.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Place on the map.
    pub at: [f64; 2],
    /// What the verdict follows from, such as a spectral radius or an error.
    pub value: f64,
    /// The verdict.
    pub verdict: Verdict,
}

/// One method over the map.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Its name.
    pub method: String,
    /// Whether it is what the program does.
    pub is_ours: bool,
    /// Its points.
    pub cells: Vec<Cell>,
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
    pub fn with(self, cells: Vec<Cell>) -> Layer {
        Layer { cells, ..self }
    }

    /// How many points have each verdict, in the order of [`Verdict::WORDS`].
    #[must_use]
    pub fn counts(&self) -> [usize; 5] {
        Verdict::WORDS.map(|word| self.cells.iter().filter(|cell| cell.verdict.word() == word).count())
    }
}

/// A number found on the way.
#[derive(Clone, Debug)]
pub struct Finding {
    /// What it is, with its unit.
    pub what: String,
    /// The number.
    pub value: f64,
}

/// An axis of a map: label, unit, whether logarithmic.
#[derive(Clone, Debug)]
pub struct Scale {
    /// What is measured.
    pub label: String,
    /// Unit; empty for numbers.
    pub unit: String,
    /// Whether it is logarithmic.
    pub log: bool,
}

impl Scale {
    /// An axis.
    #[must_use]
    pub fn new(label: &str, unit: &str, log: bool) -> Scale {
        Scale { label: label.to_owned(), unit: unit.to_owned(), log }
    }
}

/// A map.
#[derive(Clone, Debug)]
pub struct Map {
    /// Its name in files.
    pub name: &'static str,
    /// Its heading.
    pub title: String,
    /// Both axes.
    pub axes: [Scale; 2],
    /// Methods.
    pub layers: Vec<Layer>,
    /// Numbers found on the way.
    pub findings: Vec<Finding>,
    /// What the verdicts mean here.
    pub note: String,
}

impl Map {
    /// A map without layers.
    #[must_use]
    pub fn new(name: &'static str, title: &str, axes: [Scale; 2], note: &str) -> Map {
        let (layers, findings) = (Vec::new(), Vec::new());
        Map { name, title: title.to_owned(), axes, layers, findings, note: note.to_owned() }
    }

    /// Notes a number.
    pub fn find(&mut self, what: impl Into<String>, value: f64) {
        self.findings.push(Finding { what: what.into(), value });
    }

    /// Points at which the program itself is silently wrong.
    #[must_use]
    pub fn silent(&self) -> usize {
        let ours = self.layers.iter().filter(|layer| layer.is_ours);
        ours.map(|layer| layer.counts()[1] + layer.counts()[2]).sum()
    }
}
