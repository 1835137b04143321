//! The text of an input file: it is parsed into a located tree and converted, and faults are located in it.

use serde::de::DeserializeOwned;

use super::convert::{Located, convert};
use super::diagnostic::{Diagnostic, Excerpt, char_boundary};
use super::examine::{Examined, examine};
use super::fault::{Fault, Faults};
use super::json::{self, SyntaxError};
use super::place::{Path, Place, Step};
use super::tree::{TreeNode, Value};
use super::wording::syntax;

/// The name of an input file, as the user knows it, and its text.
///
/// ```
/// use formats::text::fault::{Fault, Faults};
/// use formats::text::place::Place;
/// use formats::text::source::Source;
///
/// let text = "{\n  \"spans\": [60, -60]\n}";
/// let source = Source { name: "girder.json".to_owned(), text: text.to_owned() };
///
/// let root = Place::root();
/// let mut faults = Faults::default();
/// faults.add(Fault::new(&root.key("spans").index(1), "must be positive").got(-60));
/// let wrong = source.diagnose(&faults);
/// assert_eq!(wrong[0].to_string(), "girder.json:2:17: spans[1]: must be positive, got -60");
/// ```
#[derive(Clone, Debug)]
pub struct Source {
    /// Name used in messages.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// The mark with which some editors begin a file of UTF-8 text. It is no part of the text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The bytes of a file without the byte order mark at their beginning.
///
/// ```
/// use formats::text::source::without_mark;
///
/// assert_eq!(without_mark(b"\xef\xbb\xbf{}"), b"{}");
/// assert_eq!(without_mark(b"{}"), b"{}");
/// ```
#[must_use]
pub fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes)
}

impl Source {
    /// Makes a source of the bytes of a file, without a byte order mark.
    ///
    /// # Errors
    /// Bytes that are not UTF-8, with their line and column.
    pub fn from_bytes(
        name: impl Into<String>,
        mut bytes: Vec<u8>,
    ) -> Result<Source, Box<Diagnostic>> {
        let name = name.into();
        bytes.drain(..bytes.len() - without_mark(&bytes).len());
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Source { name, text }),
            Err(error) => {
                let valid = error.utf8_error().valid_up_to();
                let byte = error.as_bytes().get(valid).copied().unwrap_or_default();
                let before = String::from_utf8_lossy(&error.as_bytes()[..valid]).into_owned();
                let (line, column) = line_and_column(&before, before.len());
                Err(Box::new(Diagnostic {
                    line: Some(line),
                    column: Some(column),
                    found: Some(format!("the byte 0x{byte:02x}")),
                    hint: Some("save the file as UTF-8".to_owned()),
                    ..Diagnostic::of_file(name, "must be UTF-8 text")
                }))
            }
        }
    }

    /// The text as a tree.
    #[must_use]
    pub fn tree(&self) -> Tree<'_> {
        let json::Reading { mut root, error } = json::read(&self.text);
        if let Value::Object(members) = &mut root.value {
            // the path of a schema concerns editors alone
            members.retain(|member| member.key != "$schema");
        }
        Tree {
            source: self,
            root,
            error,
        }
    }

    /// Numbers in lists that were probably meant with a decimal comma, which JSON reads as two numbers: digits on both
    /// sides of a comma without a blank, in a list whose other commas are followed by one.
    ///
    /// ```
    /// use formats::text::source::Source;
    ///
    /// let text = r#"{"spans": [6, 7,5, 6]}"#;
    /// let source = Source { name: "girder.json".to_owned(), text: text.to_owned() };
    /// let found = source.decimal_commas();
    /// assert!(found[0].starts_with("girder.json:1:15: spans: 7,5 is read as two numbers"), "{}", found[0]);
    /// ```
    #[must_use]
    pub fn decimal_commas(&self) -> Vec<String> {
        let mut found = Vec::new();
        self.tree().root.for_each_list(&mut Path::default(), &mut |path, items| {
            let between = |pair: &[TreeNode<'_>]| &self.text[pair[0].end..pair[1].start];
            let is_apart = |pair: &[TreeNode<'_>]| between(pair) != ",";
            let is_number = |node: &TreeNode<'_>| {
                let kind = matches!(node.value, Value::Unsigned(_) | Value::Signed(_) | Value::Float(_));
                kind && node.is_whole()
            };
            if !items.iter().all(is_number) || !items.windows(2).any(is_apart) {
                return;
            }
            for pair in items.windows(2).filter(|pair| !is_apart(pair)) {
                let written = &self.text[pair[0].start..pair[1].end];
                let is_negative = matches!(pair[1].value, Value::Signed(_));
                if !written.contains('.') && !is_negative {
                    let (line, column) = line_and_column(&self.text, pair[0].start);
                    found.push(format!(
                        "{}:{line}:{column}: {path}: {written} is read as two numbers; if it is one number, use a \
                         decimal point: {}",
                        self.name,
                        written.replace(',', ".")
                    ));
                }
            }
        });
        found
    }

    /// Converts the text to `T`, the contents of a file of this format, and checks it.
    ///
    /// # Errors
    /// Those of [`Tree::read`].
    pub fn read<T: DeserializeOwned, R>(
        &self,
        format: &str,
        check: impl FnOnce(&T, &mut Faults) -> Option<R>,
    ) -> Result<R, Vec<Diagnostic>> {
        self.tree().read(format, check)
    }

    /// Converts and checks the text like [`Source::read`], together with other files that it names: the check adds what
    /// is wrong in those to the list that it is given, after the faults of this text.
    ///
    /// # Errors
    /// All faults of this text and of the other files.
    pub fn read_with_others<T: DeserializeOwned, R>(
        &self,
        format: &str,
        check: impl FnOnce(&T, &mut Faults, &mut Vec<Diagnostic>) -> Option<R>,
    ) -> Result<R, Vec<Diagnostic>> {
        let mut others = Vec::new();
        match self.read(format, |raw: &T, faults| {
            Some(check(raw, faults, &mut others))
        }) {
            Ok(Some(value)) if others.is_empty() => Ok(value),
            Ok(_) => Err(others),
            Err(own) => Err(own.into_iter().chain(others).collect()),
        }
    }

    /// Locates faults in the text and returns them in the order of the text.
    #[must_use]
    pub fn diagnose(&self, faults: &Faults) -> Vec<Diagnostic> {
        self.tree().diagnose(faults)
    }
}

/// The text of an input file as a tree of values, each with its byte range.
#[derive(Clone, Debug)]
pub struct Tree<'s> {
    source: &'s Source,
    root: TreeNode<'s>,
    /// The syntax error, if the text is not JSON.
    error: Option<SyntaxError>,
}

impl<'s> Tree<'s> {
    /// Whether the text is JSON.
    #[must_use]
    pub const fn is_whole(&self) -> bool {
        self.error.is_none()
    }

    /// The value of the text.
    #[must_use]
    pub const fn root(&self) -> &TreeNode<'s> {
        &self.root
    }

    /// Converts the tree to `T`, the contents of a file of this format, and checks it. If there are faults of types or
    /// keys, the remainder is checked as well.
    ///
    /// # Errors
    /// All faults in the order of the text: the syntax error, wrong types and keys, and the independent ones of those
    /// that the check finds; or only a different `format`, if that explains wrong types and keys.
    pub fn read<T: DeserializeOwned, R>(
        &self,
        format: &str,
        check: impl FnOnce(&T, &mut Faults) -> Option<R>,
    ) -> Result<R, Vec<Diagnostic>> {
        let Examined {
            value,
            types,
            faults,
        } = match self.error {
            None => examine(&self.root, check),
            Some(_) => {
                let types = convert::<T>(&self.root).faults;
                Examined {
                    value: None,
                    types,
                    faults: Faults::default(),
                }
            }
        };
        if let Some(value) = value.filter(|_| faults.0.is_empty()) {
            return Ok(value);
        }
        if !types.is_empty()
            && let Some(other) = self.other_format(format)
        {
            return Err(vec![other]);
        }
        let mut wrong: Vec<Diagnostic> =
            types.iter().map(|located| self.located(located)).collect();
        wrong.extend(self.diagnose(&faults));
        wrong.extend(self.syntax_error());
        if wrong.is_empty() {
            // a check that has no result reports why
            wrong.push(Diagnostic::of_file(&self.source.name, "cannot be read"));
        }
        Err(sorted(wrong))
    }

    /// The diagnostic for a file whose `format` is a different one.
    pub(crate) fn other_format(&self, format: &str) -> Option<Diagnostic> {
        let found = self.root.member("format")?.value.as_text()?;
        let mut faults = Faults::default();
        faults.check_format(found, &Place::root().key("format"), format);
        self.diagnose(&faults).pop()
    }

    fn not_json(&self, message: &str, offset: usize, path: &Path) -> Diagnostic {
        let (line, column) = line_and_column(&self.source.text, offset);
        let (expected, hint) = syntax(message, &self.source.text, offset);
        let is_deep = message == "recursion limit exceeded";
        Diagnostic {
            line: Some(line),
            column: Some(column),
            path: if is_deep {
                String::new()
            } else {
                path.to_string()
            },
            hint,
            excerpt: Some(Excerpt::new(&self.source.text, offset)),
            ..Diagnostic::of_file(&self.source.name, expected)
        }
    }

    fn located(&self, Located { fault, offset }: &Located) -> Diagnostic {
        self.diagnostic(fault, &fault.path, Some(*offset))
    }

    /// Locates faults in the text and returns them in the order of the text.
    #[must_use]
    pub fn diagnose(&self, faults: &Faults) -> Vec<Diagnostic> {
        sorted(
            faults
                .0
                .iter()
                .map(|fault| self.place(fault, &fault.path))
                .collect(),
        )
    }

    /// Locates faults of the document that results from merging the object at `compare[index]` into this one. A fault
    /// is located in that object if it contains the path, and in the remainder of the document otherwise.
    #[must_use]
    pub fn diagnose_merged(&self, index: usize, faults: &Faults) -> Vec<Diagnostic> {
        let entry = [Step::Key("compare".to_owned()), Step::Index(index)];
        let place = |fault: &Fault| {
            let inside = Path(entry.iter().chain(&fault.path.0).cloned().collect());
            let is_own = self.root.find(&inside).is_whole;
            let is_base = self.root.find(&fault.path).is_whole;
            self.place(
                fault,
                if is_own || !is_base {
                    &inside
                } else {
                    &fault.path
                },
            )
        };
        sorted(faults.0.iter().map(place).collect())
    }

    /// Locates a fault of the document that results from merging the object `changes` into this one, and the object at
    /// `compare[index]` of this one into the result: in the last of the three that contains its path, or else in the
    /// last one.
    #[must_use]
    pub fn diagnose_changed(
        &self,
        changes: &Tree<'_>,
        index: Option<usize>,
        faults: &Faults,
    ) -> Vec<Diagnostic> {
        let place = |fault: &Fault| {
            if let Some(index) = index {
                let entry = [Step::Key("compare".to_owned()), Step::Index(index)];
                let inside = Path(entry.iter().chain(&fault.path.0).cloned().collect());
                if self.root.find(&inside).is_whole {
                    return self.place(fault, &inside);
                }
            }
            let is_changed = changes.root.find(&fault.path).is_whole;
            let is_base = self.root.find(&fault.path).is_whole;
            if is_changed || !is_base {
                changes.place(fault, &fault.path)
            } else {
                self.place(fault, &fault.path)
            }
        };
        sorted(faults.0.iter().map(place).collect())
    }

    /// Locates a fault at the byte of `path`, or of the last part of the path that exists in the text.
    fn place(&self, fault: &Fault, path: &Path) -> Diagnostic {
        // in a text that is not JSON, such as a table, no place can be determined
        let hit = self.error.is_none().then(|| self.root.find(path));
        let offset =
            hit.map(
                |hit| match hit.node.second_of_a_key().filter(|_| fault.is_duplicate()) {
                    Some(second) => second.start,
                    None if fault.at_key => hit.key,
                    None => hit.node.start,
                },
            );
        self.diagnostic(fault, path, offset)
    }

    fn diagnostic(&self, fault: &Fault, path: &Path, offset: Option<usize>) -> Diagnostic {
        let position = offset.map(|offset| line_and_column(&self.source.text, offset));
        Diagnostic {
            file: self.source.name.clone(),
            line: position.map(|(line, _)| line),
            column: position.map(|(_, column)| column),
            path: path.to_string(),
            expected: fault.expected.clone(),
            found: fault.found.clone(),
            hint: fault.hint.clone(),
            excerpt: offset.map(|offset| Excerpt::new(&self.source.text, offset)),
        }
    }

    /// The syntax error, if the text is not JSON.
    #[must_use]
    pub fn syntax_error(&self) -> Option<Diagnostic> {
        let SyntaxError {
            message,
            offset,
            path,
        } = self.error.as_ref()?;
        Some(self.not_json(message, *offset, path))
    }

    /// Duplicate keys anywhere.
    #[must_use]
    pub fn duplicates(&self) -> Faults {
        let mut faults = Faults::default();
        find_duplicates(&self.root, Path::default(), &mut faults);
        faults
    }

    /// Duplicate keys in the value at `key` and anywhere within it.
    #[must_use]
    pub fn duplicates_below(&self, key: &str) -> Faults {
        let mut faults = Faults::default();
        if let Some(member) = self.root.member(key) {
            find_duplicates(
                &member.value,
                Path(vec![Step::Key(key.to_owned())]),
                &mut faults,
            );
        }
        faults
    }
}

fn sorted(mut placed: Vec<Diagnostic>) -> Vec<Diagnostic> {
    placed.sort_by_key(|found| (found.line, found.column));
    placed.dedup();
    placed
}

fn find_duplicates(node: &TreeNode<'_>, path: Path, faults: &mut Faults) {
    let below = |step: Step| Path(path.0.iter().cloned().chain([step]).collect());
    if let Some(second) = node.second_of_a_key() {
        faults.add(Fault::duplicate(path.clone(), &second.key));
    }
    match &node.value {
        Value::Object(members) => {
            for member in members {
                find_duplicates(
                    &member.value,
                    below(Step::Key(member.key.clone().into_owned())),
                    faults,
                );
            }
        }
        Value::List(items) => {
            for (index, item) in items.iter().enumerate() {
                find_duplicates(item, below(Step::Index(index)), faults);
            }
        }
        _ => {}
    }
}

/// Line and column (in characters) of a byte offset, both counted from 1.
fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..char_boundary(text, offset)];
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (
        before.matches('\n').count() + 1,
        before[start..].chars().count() + 1,
    )
}
