//! The text of an input file: parsed by serde, searched for places only when there is something to say.

use jsonc_parser::ast::{Object, Value};
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, ParseOptions};
use serde::de::DeserializeOwned;

use crate::diagnostic::Diagnostic;
use crate::fault::{Fault, Faults, nearest};
use crate::place::{Path, Place, Step};

/// An input file's name, as users know it, and its text.
#[derive(Clone, Debug)]
pub struct Source {
    /// As it appears in messages.
    pub name: String,
    /// The whole text.
    pub text: String,
}

impl Source {
    /// Takes the bytes of a file.
    ///
    /// # Errors
    /// Bytes that are not UTF-8, with their line and column.
    pub fn from_bytes(name: impl Into<String>, bytes: Vec<u8>) -> Result<Source, Box<Diagnostic>> {
        let name = name.into();
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

    /// Parses the text as `T`, the contents of a file of this format.
    ///
    /// # Errors
    /// The first syntax or type error, placed; another `format`, where that explains it.
    pub fn parse<T: DeserializeOwned>(&self, format: &str) -> Result<T, Box<Diagnostic>> {
        let mut deserializer = serde_json::Deserializer::from_str(&self.text);
        let parsed = serde_path_to_error::deserialize(&mut deserializer);
        let value = match parsed {
            Ok(value) => value,
            Err(error) => {
                let path = path_of(error.path());
                let other = if error.inner().is_data() { self.other_format(format) } else { None };
                return Err(Box::new(other.unwrap_or_else(|| self.parse_error(path, error.inner()))));
            }
        };
        match deserializer.end() {
            Ok(()) => Ok(value),
            Err(error) => Err(Box::new(self.parse_error(Path::default(), &error))),
        }
    }

    /// What to say of a file whose `format` is another one.
    fn other_format(&self, format: &str) -> Option<Diagnostic> {
        let tree = Tree::of(&self.text);
        let root = Place::root();
        let place = root.key("format");
        let hit = tree.find(&place.path()).filter(|hit| hit.whole)?;
        let found = hit.node.as_string_lit()?.value.clone();
        let mut faults = Faults::default();
        faults.word(&found, &place, &[(format, ())]);
        self.diagnose(&faults).pop()
    }

    fn parse_error(&self, path: Path, error: &serde_json::Error) -> Diagnostic {
        let message = error.to_string();
        let tail = format!(" at line {} column {}", error.line(), error.column());
        let message = message.strip_suffix(&tail).unwrap_or(&message);
        if error.is_data() {
            let fault = type_fault(path, message);
            if let Some(placed) = self.diagnose(&Faults(vec![fault.clone()])).pop()
                && placed.line.is_some()
            {
                return placed;
            }
            return Diagnostic {
                line: Some(error.line()),
                column: Some(error.column()),
                path: fault.path.to_string(),
                expected: fault.expected,
                found: fault.found,
                hint: fault.hint,
                file: self.name.clone(),
            };
        }
        let (line, column) = line_and_column(&self.text, self.offset(error.line(), error.column()));
        let (expected, hint) = syntax_hint(message, &self.text);
        let deep = message == "recursion limit exceeded";
        Diagnostic {
            line: Some(line),
            column: Some(column),
            path: if deep { String::new() } else { path.to_string() },
            hint,
            ..Diagnostic::of_file(&self.name, expected)
        }
    }

    /// Byte offset of serde_json's line and column (the latter counts bytes).
    fn offset(&self, line: usize, column: usize) -> usize {
        let start: usize = self.text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
        (start + column.saturating_sub(1)).min(self.text.len())
    }

    /// Places faults in the text, in the text's order.
    #[must_use]
    pub fn diagnose(&self, faults: &Faults) -> Vec<Diagnostic> {
        let tree = Tree::of(&self.text);
        let mut placed: Vec<Diagnostic> =
            faults.0.iter().map(|fault| self.place(&tree, fault, &fault.path)).collect();
        placed.sort_by_key(|found| (found.line, found.column));
        placed.dedup();
        placed
    }

    /// Places faults of the document that the object at `compare[index]`, merged into this one, gave:
    /// in that object where it has the path, in the rest of the document otherwise.
    #[must_use]
    pub fn diagnose_merged(&self, index: usize, faults: &Faults) -> Vec<Diagnostic> {
        let tree = Tree::of(&self.text);
        let entry = [Step::Key("compare".to_owned()), Step::Index(index)];
        let place = |fault: &Fault| {
            let inside = Path(entry.iter().chain(&fault.path.0).cloned().collect());
            let own = tree.find(&inside).is_some_and(|hit| hit.whole);
            let base = tree.find(&fault.path).is_some_and(|hit| hit.whole);
            let path = if own || !base { &inside } else { &fault.path };
            self.place(&tree, fault, path)
        };
        let mut placed: Vec<Diagnostic> = faults.0.iter().map(place).collect();
        placed.sort_by_key(|found| (found.line, found.column));
        placed.dedup();
        placed
    }

    fn place(&self, tree: &Tree<'_>, fault: &Fault, path: &Path) -> Diagnostic {
        let mut expected = fault.expected.clone();
        let mut at = None;
        if let Some(hit) = tree.find(path) {
            at = Some(if fault.at_key { hit.key } else { hit.value });
            if expected.starts_with(DUPLICATE)
                && let Value::Object(object) = hit.node
                && let Some((key, offset)) = second(object)
            {
                expected = format!("{DUPLICATE}`{key}`");
                at = Some(offset);
            }
        }
        let position = at.map(|offset| line_and_column(&self.text, offset));
        Diagnostic {
            file: self.name.clone(),
            line: position.map(|(line, _)| line),
            column: position.map(|(_, column)| column),
            path: path.to_string(),
            expected,
            found: fault.found.clone(),
            hint: fault.hint.clone(),
        }
    }

    /// Keys given twice anywhere below `compare`, which is merged before it is read.
    #[must_use]
    pub fn duplicates_below(&self, key: &str) -> Faults {
        let tree = Tree::of(&self.text);
        let path = Path(vec![Step::Key(key.to_owned())]);
        let mut faults = Faults::default();
        if let Some(hit) = tree.find(&path) {
            walk(hit.node, path, &mut faults);
        }
        faults
    }
}

const DUPLICATE: &str = "duplicate key ";

fn walk(node: &Value<'_>, path: Path, faults: &mut Faults) {
    let below = |step: Step| Path(path.0.iter().cloned().chain([step]).collect());
    match node {
        Value::Object(object) => {
            if let Some((key, _)) = second(object) {
                faults.add(type_fault(path.clone(), &format!("duplicate field `{key}`")));
            }
            for property in &object.properties {
                walk(&property.value, below(Step::Key(property.name.as_str().to_owned())), faults);
            }
        }
        Value::Array(array) => {
            for (index, item) in array.elements.iter().enumerate() {
                walk(item, below(Step::Index(index)), faults);
            }
        }
        _ => {}
    }
}

/// The first key of an object that stands there for the second time.
fn second(object: &Object<'_>) -> Option<(String, usize)> {
    let mut seen = std::collections::BTreeSet::new();
    let twice = object.properties.iter().find(|property| !seen.insert(property.name.as_str()))?;
    Some((twice.name.as_str().to_owned(), twice.start()))
}

/// The document as a tree with byte ranges; empty where the text is not JSON.
struct Tree<'t>(Option<Value<'t>>);

/// Where a path leads.
struct Hit<'v, 't> {
    node: &'v Value<'t>,
    value: usize,
    key: usize,
    whole: bool,
}

impl<'t> Tree<'t> {
    fn of(text: &'t str) -> Tree<'t> {
        let options = ParseOptions {
            allow_comments: false,
            allow_loose_object_property_names: false,
            allow_trailing_commas: false,
            allow_missing_commas: false,
            allow_single_quoted_strings: false,
            allow_hexadecimal_numbers: false,
            allow_unary_plus_numbers: false,
            allow_bare_decimal_point_numbers: false,
            allow_non_finite_numbers: false,
            allow_extended_string_escapes: false,
        };
        let parsed = jsonc_parser::parse_to_ast(text, &CollectOptions::default(), &options);
        Tree(parsed.ok().and_then(|result| result.value))
    }

    /// Follows a path as far as the document has it.
    fn find(&self, path: &Path) -> Option<Hit<'_, 't>> {
        let mut node = self.0.as_ref()?;
        let mut key = node.start();
        for step in &path.0 {
            let next = match (node, step) {
                // where a key stands twice, the last is what a careless reader would have taken
                (Value::Object(object), Step::Key(name)) => {
                    let member = object.properties.iter().rfind(|property| property.name.as_str() == name);
                    member.map(|property| (&property.value, property.start()))
                }
                (Value::Array(array), Step::Index(index)) => {
                    array.elements.get(*index).map(|item| (item, item.start()))
                }
                _ => None,
            };
            match next {
                Some((value, start)) => (node, key) = (value, start),
                None => return Some(Hit { node, value: node.start(), key, whole: false }),
            }
        }
        Some(Hit { node, value: node.start(), key, whole: true })
    }
}

/// Line and column (in characters) of a byte offset, both counted from 1.
fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let mut end = offset.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[start..].chars().count() + 1)
}

/// serde_path_to_error's path as ours.
#[must_use]
pub fn path_of(path: &serde_path_to_error::Path) -> Path {
    use serde_path_to_error::Segment;
    let step = |segment: &Segment| match segment {
        Segment::Seq { index } => Some(Step::Index(*index)),
        Segment::Map { key } => Some(Step::Key(key.clone())),
        Segment::Enum { variant } => Some(Step::Key(variant.clone())),
        Segment::Unknown => None,
    };
    Path(path.iter().filter_map(step).collect())
}

/// serde's message about a value of the wrong type or an unknown key, in our words.
#[must_use]
pub fn type_fault(path: Path, message: &str) -> Fault {
    let mut fault = Fault { path, at_key: false, expected: message.to_owned(), found: None, hint: None };
    if let Some(rest) = message.strip_prefix("duplicate field ") {
        fault.expected = format!("{DUPLICATE}{rest}");
        fault.hint = Some("give each key once".to_owned());
    } else if let Some(rest) = message.strip_prefix("unknown field `")
        && let Some((key, known)) = rest.split_once('`')
    {
        let known: Vec<&str> = known.split('`').skip(1).step_by(2).collect();
        fault.at_key = true;
        fault.expected = format!("unknown key `{key}`");
        let list = format!("known keys are {}", known.join(", "));
        fault.hint = Some(match nearest(key, &known) {
            Some(near) => format!("did you mean `{near}`? {list}"),
            None => list,
        });
        if fault.path.0.last() != Some(&Step::Key(key.to_owned())) {
            fault.path.0.push(Step::Key(key.to_owned()));
        }
    } else if let Some((found, expected)) = message.split_once(", expected ") {
        let found = ["invalid type: ", "invalid value: ", "invalid length "]
            .iter()
            .find_map(|prefix| found.strip_prefix(prefix).map(|rest| (*prefix, rest)));
        if let Some((prefix, found)) = found {
            let count = prefix == "invalid length ";
            fault.expected = format!("must be {}", plain_type(expected));
            fault.found = Some(if count {
                format!("{found} item{}", if found == "1" { "" } else { "s" })
            } else {
                plain_found(found)
            });
            let whole =
                ["must be a list", "must be an object"].iter().any(|kind| fault.expected.starts_with(kind));
            if let Some(Step::Key(key)) = fault.path.0.last().filter(|_| whole) {
                let looks = LOOKS.iter().find(|(known, _)| known == key);
                fault.hint = looks.map(|(_, looks)| (*looks).to_owned());
            }
        }
    }
    fault
}

/// How values look whose kind is often mistaken, by the key that has them.
const LOOKS: [(&str, &str); 11] = [
    ("position", "rows [time, value], such as [[0, 4]]"),
    ("speed", "rows [time, value], such as [[0, 4]]"),
    ("acceleration", "rows [time, value], such as [[0, 4]]"),
    ("value", "rows [time, value], such as [[0, 4]]"),
    ("end", "such as {\"time\": 30}"),
    ("output", "such as {\"dt\": 0.01}"),
    ("do", "such as {\"brake\": \"trolley\"}"),
    ("dof", "such as [\"x\", \"y\", \"pitch\"]"),
    ("fix", "such as [\"ux\", \"uy\", \"uz\", \"rx\"]"),
    ("inertia", "[roll, yaw, pitch], in a spec about x, y, z"),
    ("at", "[x, y, z]: along, up, to the right"),
];

fn plain_type(expected: &str) -> String {
    match expected {
        "f64" => "a number".to_owned(),
        "usize" | "u64" | "u32" => "a whole number, zero or more".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a boolean" => "true or false".to_owned(),
        other => other
            .strip_prefix("an array of length ")
            .map_or_else(|| other.to_owned(), |count| format!("a list of {count} items")),
    }
}

fn plain_found(found: &str) -> String {
    let kinds = [
        ("string ", "the text "),
        ("floating point ", "the number "),
        ("integer ", "the number "),
        ("boolean ", ""),
    ];
    for (prefix, plain) in kinds {
        if let Some(rest) = found.strip_prefix(prefix) {
            return format!("{plain}{}", rest.trim_matches('`'));
        }
    }
    match found {
        "sequence" => "a list".to_owned(),
        "map" => "an object".to_owned(),
        other => other.to_owned(),
    }
}

fn syntax_hint(message: &str, text: &str) -> (String, Option<String>) {
    if text.trim().is_empty() {
        return ("the file is empty".to_owned(), Some("a JSON object is needed".to_owned()));
    }
    if text.starts_with('\u{feff}') {
        let hint = "the file begins with a byte order mark: save it as UTF-8 without one";
        return ("not valid JSON".to_owned(), Some(hint.to_owned()));
    }
    if message == "number out of range" {
        let hint = "double precision ends at 1.8e308";
        return ("the number is too large".to_owned(), Some(hint.to_owned()));
    }
    if message.starts_with("EOF while parsing") {
        return ("not valid JSON: the file ends too early".to_owned(), None);
    }
    let hint = match message {
        "key must be a string" => Some("JSON has no comments, and keys stand in double quotes"),
        "trailing comma" => Some("JSON has no comma after the last item"),
        "expected value" => Some("JSON has no NaN, Infinity, comments or single quotes"),
        "recursion limit exceeded" => Some("lists and objects may be nested 128 deep"),
        _ => None,
    };
    (format!("not valid JSON: {message}"), hint.map(str::to_owned))
}
