//! An error with its place: what was expected, what was found, and what the user can do.

use std::fmt;

use serde::Serialize;

/// One error of an input with its place in the file, if known.
///
/// ```
/// use formats::text::diagnostic::Diagnostic;
///
/// let missing = Diagnostic::of_file("scene.json", "cannot be read: no such file").hint("check the path");
/// assert_eq!(missing.to_string(), "scene.json: cannot be read: no such file  hint: check the path");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Diagnostic {
    /// The file, as named by the user or by another input file.
    pub file: String,
    /// Line, counted from 1; `None` if the error concerns the whole file.
    pub line: Option<usize>,
    /// Column in characters, counted from 1.
    pub column: Option<usize>,
    /// JSON path of the value, such as `girder.spans[1]`; empty for the file's root.
    pub path: String,
    /// The requirement, such as `must be positive`.
    pub expected: String,
    /// The value that was found.
    pub found: Option<String>,
    /// What the user can do about it.
    pub hint: Option<String>,
    /// The part of the file around the place, if known; not part of the machine-readable form.
    #[serde(skip)]
    pub excerpt: Option<Excerpt>,
}

/// A part of a line of a file, and the place in it that is meant.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Excerpt {
    /// The text, about 100 characters at most, dots where it is cut, tabulators as single blanks.
    pub text: String,
    /// Number of characters before the place.
    pub before: usize,
}

/// Largest numbers of characters of an excerpt before and after the place.
const AROUND: [usize; 2] = [40, 60];

impl Excerpt {
    /// The part of the line of `text` that contains the byte at `offset`.
    ///
    /// ```
    /// use formats::text::diagnostic::Excerpt;
    ///
    /// let excerpt = Excerpt::new("{\n  \"spans\": [6, -7]\n}", 17);
    /// assert_eq!((excerpt.text.as_str(), excerpt.before), ("  \"spans\": [6, -7]", 15));
    /// ```
    #[must_use]
    pub fn new(text: &str, offset: usize) -> Excerpt {
        let (before, after) = text.split_at(char_boundary(text, offset));
        let before = &before[before.rfind('\n').map_or(0, |newline| newline + 1)..];
        let after = after.split('\n').next().unwrap_or_default();
        let mut near: Vec<char> = before
            .chars()
            .rev()
            .take(AROUND[0])
            .map(plain_char)
            .collect();
        if near.len() < before.chars().count() {
            near.extend(['.'; 3]);
        }
        let before = near.len();
        near.reverse();
        let mut after = after.trim_end().chars().map(plain_char);
        near.extend(after.by_ref().take(AROUND[1]));
        if after.next().is_some() {
            near.extend(['.'; 3]);
        }
        Excerpt {
            text: near.into_iter().collect(),
            before,
        }
    }
}

/// The byte at which the character at the byte `offset` begins, or the end of the text.
pub(super) fn char_boundary(text: &str, offset: usize) -> usize {
    let is_boundary = |byte: &usize| text.is_char_boundary(*byte);
    (0..=offset.min(text.len()))
        .rev()
        .find(is_boundary)
        .unwrap_or_default()
}

impl Diagnostic {
    /// An error that concerns a whole file: it is missing, cannot be read or cannot be written.
    #[must_use]
    pub fn of_file(file: impl Into<String>, expected: impl Into<String>) -> Self {
        Diagnostic {
            file: file.into(),
            line: None,
            column: None,
            path: String::new(),
            expected: expected.into(),
            found: None,
            hint: None,
            excerpt: None,
        }
    }

    /// Number of bytes of the position, `file:line:column:`, with which the message begins.
    #[must_use]
    pub fn position_length(&self) -> usize {
        let place = self
            .line
            .zip(self.column)
            .map_or(0, |(line, column)| format!(":{line}:{column}").len());
        plain(&self.file).len() + place + 1
    }

    /// Adds a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

/// A text without control characters, which a terminal would obey. Line feeds and tabs stay.
///
/// ```
/// assert_eq!(formats::text::diagnostic::plain("rail \u{1b}[31m\n"), "rail [31m\n");
/// ```
#[must_use]
pub fn plain(text: &str) -> String {
    let stays = |c: &char| matches!(c, '\n' | '\t') || !c.is_control();
    text.chars().filter(stays).collect()
}

/// The character in an excerpt, in which a blank stands for a control character.
fn plain_char(c: char) -> char {
    if c.is_control() { ' ' } else { c }
}

/// Writes the message without control characters.
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", plain(&self.message()))
    }
}

impl Diagnostic {
    fn message(&self) -> String {
        let mut text = self.file.clone();
        if let (Some(line), Some(column)) = (self.line, self.column) {
            text += &format!(":{line}:{column}");
        }
        text += ": ";
        if !self.path.is_empty() {
            text += &format!("{}: ", self.path);
        }
        text += &self.expected;
        if let Some(found) = &self.found {
            text += &format!(", got {found}");
        }
        if let Some(hint) = &self.hint {
            text += &format!("  hint: {hint}");
        }
        text
    }
}
