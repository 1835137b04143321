//! Faults of a document, identified by path. They are collected first and located in the text afterwards.

pub use super::number::number;
use super::place::{Path, Place, Step};

/// Beginning of the message for a duplicate key.
const DUPLICATE: &str = "duplicate key ";

/// One fault, identified by its path. `Source::diagnose` determines its line and column.
///
/// ```
/// use formats::text::fault::Fault;
/// use formats::text::place::Place;
///
/// let root = Place::root();
/// let girder = root.key("girder");
/// let fault = Fault::new(&girder.key("E"), "must be positive").got(-29000).hint("a stress");
/// assert_eq!(fault.path.to_string(), "girder.E");
/// assert_eq!(fault.found.as_deref(), Some("-29000"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The value (or, with `at_key`, the key) that is wrong.
    pub path: Path,
    /// Whether the fault concerns the key itself instead of its value.
    pub at_key: bool,
    /// The requirement.
    pub expected: String,
    /// The value that was found.
    pub found: Option<String>,
    /// What the user can do about it.
    pub hint: Option<String>,
    /// From what the fault follows.
    pub basis: Basis,
}

/// What a fault follows from. If values of the file have wrong types, this decides whether the fault is certain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// The value alone: its range, a keyword, a missing key.
    Value,
    /// A name and the names that the file has.
    Names,
    /// Several values.
    #[default]
    Several,
}

impl Fault {
    /// A fault of the value at `place`.
    #[must_use]
    pub fn new(place: &Place<'_>, expected: impl Into<String>) -> Self {
        Fault {
            path: place.path(),
            at_key: false,
            expected: expected.into(),
            found: None,
            hint: None,
            basis: Basis::Several,
        }
    }

    /// A duplicate key in the object at `path`. Its place is the second occurrence of the key.
    #[must_use]
    pub(super) fn duplicate(path: Path, key: &str) -> Self {
        let expected = format!("{DUPLICATE}`{key}`");
        let hint = Some("give each key once".to_owned());
        Fault {
            path,
            at_key: false,
            expected,
            found: None,
            hint,
            basis: Basis::Value,
        }
    }

    /// Whether the fault is a duplicate key.
    pub(super) fn is_duplicate(&self) -> bool {
        self.expected.starts_with(DUPLICATE)
    }

    /// Adds the value that was found.
    #[must_use]
    pub fn got(mut self, found: impl ToString) -> Self {
        self.found = Some(found.to_string());
        self
    }

    /// Adds a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Declares that the fault follows from its value alone.
    #[must_use]
    pub fn of_value(mut self) -> Self {
        self.basis = Basis::Value;
        self
    }

    /// Declares that the fault is a name that the file does not have.
    #[must_use]
    pub fn of_names(mut self) -> Self {
        self.basis = Basis::Names;
        self
    }

    /// Places the fault at the key instead of its value.
    #[must_use]
    pub fn at_key(mut self) -> Self {
        self.at_key = true;
        self
    }
}

/// All faults found in a document so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults(pub Vec<Fault>);

impl Faults {
    /// Adds a fault.
    pub fn add(&mut self, fault: Fault) {
        self.0.push(fault);
    }

    /// Whether a fault concerns the whole document, or one of these members of it.
    #[must_use]
    pub fn concern(&self, members: &[&str]) -> bool {
        self.0.iter().any(|fault| match fault.path.0.first() {
            Some(Step::Key(key)) => members.contains(&key.as_str()),
            _ => true,
        })
    }

    /// Returns the value if it is present; otherwise adds a fault for the missing key.
    pub fn require<'v, T>(
        &mut self,
        value: &'v Option<T>,
        place: &Place<'_>,
        key: &str,
    ) -> Option<&'v T> {
        if value.is_none() {
            self.add(Fault::new(place, format!("missing key `{key}`")).of_value());
        }
        value.as_ref()
    }

    /// Returns the value of a keyword. An unknown keyword is a fault that lists the known ones and suggests the
    /// nearest.
    pub fn one_of<T: Copy>(
        &mut self,
        found: &str,
        place: &Place<'_>,
        words: &[(&str, T)],
    ) -> Option<T> {
        if let Some((_, value)) = words.iter().find(|(word, _)| *word == found) {
            return Some(*value);
        }
        let known: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        let mut fault = Fault::new(place, format!("must be {}", alternatives(&known)))
            .got(format!("\"{found}\""));
        fault = fault.of_value();
        if let Some(near) = nearest(found, &known).filter(|_| known.len() > 1) {
            fault = fault.hint(format!("did you mean \"{near}\"?"));
        }
        self.add(fault);
        None
    }

    /// Adds a fault if `found` is not the format `expected`; for another format of the program with the command for it.
    pub fn check_format(&mut self, found: &str, place: &Place<'_>, expected: &str) {
        match OTHER_FORMATS
            .iter()
            .find(|(format, _)| found == *format && found != expected)
        {
            Some((_, hint)) => {
                let fault = Fault::new(place, format!("must be \"{expected}\""))
                    .got(format!("\"{found}\""));
                self.add(fault.of_value().hint(*hint));
            }
            None => {
                self.one_of(found, place, &[(expected, ())]);
            }
        }
    }

    /// Adds a fault for a key of the format that this version does not support.
    pub fn unavailable(&mut self, place: &Place<'_>, what: &str) {
        self.add(Fault::new(place, format!("{what} is not available in this version")).at_key());
    }

    /// Whether numbers increase strictly. If not, a fault is added for the first number that does not increase.
    pub fn increasing(&mut self, numbers: &[f64], place: &Place<'_>) -> bool {
        let descent = numbers.windows(2).position(|pair| pair[1] <= pair[0]);
        if let Some(first) = descent {
            self.add(
                Fault::new(
                    &place.index(first + 1),
                    format!(
                        "must be above the one before it, {}",
                        number(numbers[first])
                    ),
                )
                .got(numbers[first + 1])
                .hint("list them in increasing order, each once"),
            );
        }
        descent.is_none()
    }
}

/// `"a"`, `"a" or "b"`, `"a", "b" or "c"`.
#[must_use]
pub fn alternatives(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match quoted.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}

/// The known word that a misspelt word most probably means: a word that begins with it, or otherwise the one with the
/// smallest edit distance. The maximum distance is 1 to 3, depending on the length of the word; `None` if there is no
/// such word.
#[must_use]
pub fn nearest<'w>(word: &str, known: &[&'w str]) -> Option<&'w str> {
    let allowed = match word.chars().count() {
        0..=2 => 1,
        3..=5 => 2,
        _ => 3,
    };
    let lower = word.to_lowercase();
    let begun = known
        .iter()
        .find(|candidate| lower.len() > 2 && candidate.to_lowercase().starts_with(&lower));
    if let Some(candidate) = begun {
        return Some(candidate);
    }
    known
        .iter()
        .map(|candidate| (distance(&lower, &candidate.to_lowercase()), *candidate))
        .filter(|(edits, candidate)| *edits <= allowed && *edits < candidate.chars().count())
        .min_by_key(|(edits, _)| *edits)
        .map(|(_, candidate)| candidate)
}

/// Edit distance between two words: insertions, deletions, substitutions, and transpositions of adjacent characters.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before: Vec<usize> = Vec::new();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut next = vec![i + 1];
        for j in 0..b.len() {
            let mut least = (row[j] + usize::from(a[i] != b[j]))
                .min(row[j + 1] + 1)
                .min(next[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                least = least.min(before[j - 1] + 1);
            }
            next.push(least);
        }
        before = std::mem::replace(&mut row, next);
    }
    row[b.len()]
}

/// Formats of the program, with what to do with a file of each that is given in place of another.
const OTHER_FORMATS: [(&str, &str); 9] = [
    (
        "girderway-beam/1",
        "this is a beam spec, which `fea` and `crosscheck` read; scenes and designs refer to it by `spec`",
    ),
    (
        "girderway-scene/1",
        "this is a scene, which `run`, `sim`, `study` and `deck` read",
    ),
    (
        "girderway-design/1",
        "this is a design, which `design` reads",
    ),
    ("girderway-sweep/1", "this is a sweep, which `sweep` reads"),
    (
        "girderway-sections/1",
        "these are sections, which `import` reads with --sections",
    ),
    (
        "girderway-shard/1",
        "this belongs to a shard, whose folder `sweep --merge` reads",
    ),
    ("girderway-grid/1", "this is a grid, which `splines` reads"),
    (
        "girderway-summary/1",
        "this is the summary of a run, which no command reads",
    ),
    (
        "girderway-design-summary/1",
        "this is the summary of a design, which no command reads",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_counts_single_edits() {
        for (a, b, edits) in [
            ("", "abc", 3),
            ("spans", "span", 1),
            ("kitten", "sitting", 3),
            ("heigth", "height", 1),
            ("x", "x", 0),
        ] {
            assert_eq!(distance(a, b), edits, "{a} {b}");
        }
    }

    #[test]
    fn nearest_suggests_a_misspelling_and_keeps_quiet_otherwise() {
        let known = ["spans", "overhangs", "E", "G", "I_vertical", "I_lateral"];
        assert_eq!(nearest("span", &known), Some("spans"));
        assert_eq!(nearest("i_vertical", &known), Some("I_vertical"));
        assert_eq!(nearest("overhang", &known), Some("overhangs"));
        assert_eq!(nearest("over", &known), Some("overhangs"));
        assert_eq!(nearest("colour", &known), None);
        assert_eq!(nearest("q", &known), None);
    }

    #[test]
    fn word_lists_what_is_known() {
        let mut faults = Faults::default();
        let root = Place::root();
        assert_eq!(
            faults.one_of("rail", &root, &[("rail", 1), ("ground", 2)]),
            Some(1)
        );
        assert_eq!(
            faults.one_of("grund", &root, &[("rail", 1), ("ground", 2)]),
            None
        );
        assert_eq!(faults.0.len(), 1);
        assert_eq!(faults.0[0].expected, "must be \"rail\" or \"ground\"");
        assert_eq!(
            faults.0[0].hint.as_deref(),
            Some("did you mean \"ground\"?")
        );
    }
}
