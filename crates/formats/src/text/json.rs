//! Converts a JSON text (RFC 8259) to its tree.
//!
//! The grammar is that of `serde_json`. Each list and object is read one level at a time into slices of the text, one
//! for each item, key and value (`RawValue`), whose places in the text give the byte ranges of the tree. The slices of
//! lists and objects are then read in the same way. If the text is not JSON, `serde_json` reports an error within one
//! of these slices; that slice is read as far as possible, so that the tree contains everything before the error, with
//! open lists and objects marked as incomplete.

use std::borrow::Cow;
use std::fmt;

use serde::de::{Deserialize, Deserializer as _, MapAccess, SeqAccess, Visitor};
use serde_json::Deserializer;
use serde_json::value::RawValue;

use super::place::{Path, Step};
use super::tree::{TreeMember, TreeNode, Value};
use crate::limits::VALUES;

/// Nesting depth of lists and objects from which a text is rejected.
const DEPTH: usize = 128;

/// Message of a text of more values than are read.
pub(super) const TOO_MANY_VALUES: &str = "too many values";

/// The result of parsing a text: its tree, up to the first syntax error.
#[derive(Debug)]
pub(super) struct Reading<'t> {
    /// The value of the text.
    pub root: TreeNode<'t>,
    /// The syntax error, if the text is not JSON.
    pub error: Option<SyntaxError>,
}

/// A syntax error and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SyntaxError {
    /// What is wrong, in the words of `serde_json`.
    pub message: String,
    /// Byte offset.
    pub offset: usize,
    /// Path of the incomplete value.
    pub path: Path,
}

/// Parses a text.
pub(super) fn read(text: &str) -> Reading<'_> {
    read_up_to(text, VALUES)
}

/// Parses a text of at most about `most` values. They are counted by their commas before memory is taken for them.
fn read_up_to(text: &str, most: usize) -> Reading<'_> {
    if let Some((offset, _)) = text
        .bytes()
        .enumerate()
        .filter(|(_, byte)| *byte == b',')
        .nth(most)
    {
        let root = TreeNode {
            start: 0,
            end: 0,
            value: Value::Null,
        };
        return Reading {
            root,
            error: Some(SyntaxError::new(TOO_MANY_VALUES, offset)),
        };
    }
    let reader = Reader { text };
    let start = reader.skip_space(0);
    let mut values = Deserializer::from_str(&text[start..]).into_iter::<&RawValue>();
    let whole = values.next();
    let end = start + values.byte_offset();
    let is_whole = matches!(whole, Some(Ok(_)));
    let (root, error) = reader.value(start, is_whole.then_some(end), 0);
    let after = reader.skip_space(end);
    let error = error.or_else(|| match whole {
        Some(Err(error)) => Some(reader.locate(start, &error)),
        _ if after < text.len() => Some(SyntaxError::new("trailing characters", after)),
        _ => None,
    });
    Reading { root, error }
}

impl SyntaxError {
    fn new(message: &str, offset: usize) -> SyntaxError {
        SyntaxError {
            message: message.to_owned(),
            offset,
            path: Path::default(),
        }
    }

    /// The error, after adding `step` at the beginning of its path.
    #[cold]
    fn within(mut self, step: Step) -> SyntaxError {
        self.path.0.insert(0, step);
        self
    }
}

/// A value, as far as it can be read, and the error that ends it.
type Part<'t> = (TreeNode<'t>, Option<SyntaxError>);

#[derive(Clone, Copy)]
struct Reader<'t> {
    text: &'t str,
}

impl<'t> Reader<'t> {
    /// The offset of the first byte from `at` on that is not white space.
    fn skip_space(self, at: usize) -> usize {
        let is_space = |byte: &u8| matches!(byte, b' ' | b'\n' | b'\t' | b'\r');
        at + self.text.as_bytes()[at..]
            .iter()
            .take_while(|byte| is_space(byte))
            .count()
    }

    /// The byte range of a slice of the text.
    fn range(self, slice: &str) -> (usize, usize) {
        let start = slice.as_ptr().addr() - self.text.as_ptr().addr();
        (start, start + slice.len())
    }

    /// Locates an error that `serde_json` found in the text from `start` on; it counts lines and bytes from 1.
    #[cold]
    fn locate(self, start: usize, error: &serde_json::Error) -> SyntaxError {
        let words = error.to_string();
        let tail = format!(" at line {} column {}", error.line(), error.column());
        let lines = self.text[start..]
            .split_inclusive('\n')
            .take(error.line() - 1);
        let offset = start + lines.map(str::len).sum::<usize>() + error.column().saturating_sub(1);
        SyntaxError::new(
            words.strip_suffix(&tail).unwrap_or(&words),
            offset.min(self.text.len()),
        )
    }

    /// Reads the value that begins at `start`. Its `end` is known if the value is complete.
    fn value(self, start: usize, end: Option<usize>, depth: usize) -> Part<'t> {
        let text = &self.text[start..end.unwrap_or(self.text.len())];
        if let Some(b'[' | b'{') = text.as_bytes().first() {
            let level = end
                .and_then(|_| Level::of_scalars(text))
                .unwrap_or_else(|| Level::read(text));
            let (value, error) = self.level(start, &level, depth);
            let end = end.filter(|_| error.is_none()).unwrap_or(0);
            return (TreeNode { start, end, value }, error);
        }
        let number = end.and_then(|_| number(text));
        match number.map_or_else(|| leaf(text), Ok) {
            Ok(value) => (
                TreeNode {
                    start,
                    end: end.unwrap_or(0),
                    value,
                },
                None,
            ),
            Err(error) => (
                TreeNode {
                    start,
                    end: 0,
                    value: Value::Null,
                },
                Some(self.locate(start, &error)),
            ),
        }
    }

    /// Converts the list or object that begins at `start`.
    fn level(
        self,
        start: usize,
        level: &Level<'t>,
        depth: usize,
    ) -> (Value<'t>, Option<SyntaxError>) {
        let too_deep = depth + 1 == DEPTH;
        let fault = || level.fault.as_ref().map(|error| self.locate(start, error));
        let (value, error) = if self.text[start..].starts_with('[') {
            let mut items = Vec::with_capacity(level.values.len());
            let read = if too_deep {
                Ok(())
            } else {
                self.items(level, start, depth, &mut items)
            };
            (Value::List(items), read.err())
        } else {
            let mut members = Vec::with_capacity(level.keys.len());
            let read = if too_deep {
                Ok(())
            } else {
                self.members(level, start, depth, &mut members)
            };
            (Value::Object(members), read.err())
        };
        let deep = too_deep.then(|| SyntaxError::new("recursion limit exceeded", start));
        (value, deep.or(error).or_else(fault))
    }

    /// Reads the items of a list that begins at `start`, the last of which may be incomplete.
    fn items(
        self,
        level: &Level<'t>,
        start: usize,
        depth: usize,
        items: &mut Vec<TreeNode<'t>>,
    ) -> Result<(), SyntaxError> {
        let mut after = start + 1;
        let mut add = |start: usize, end: Option<usize>| {
            let (item, error) = self.value(start, end, depth + 1);
            items.push(item);
            error.map_or(Ok(()), |error| {
                Err(error.within(Step::Index(items.len() - 1)))
            })
        };
        for value in &level.values {
            let (start, end) = self.range(value);
            add(start, Some(end))?;
            after = end;
        }
        if level.fault.is_none() {
            return Ok(());
        }
        match self.next(after, level.values.is_empty()) {
            Some(at) if !self.text[at..].starts_with(']') => add(at, None),
            _ => Ok(()),
        }
    }

    /// The offset of the text that follows a key that ends at `end`, and its colon.
    fn value_after(self, end: usize) -> Option<usize> {
        let at = self.skip_space(end);
        let at = self.text[at..]
            .starts_with(':')
            .then(|| self.skip_space(at + 1));
        at.filter(|at| *at < self.text.len())
    }

    /// The offset of the text that follows `after` and a comma, or white space alone before the first item.
    fn next(self, after: usize, is_first: bool) -> Option<usize> {
        let at = self.skip_space(after);
        let at = match self.text.as_bytes().get(at) {
            Some(b',') if !is_first => self.skip_space(at + 1),
            _ if !is_first => return None,
            _ => at,
        };
        (at < self.text.len()).then_some(at)
    }

    /// Reads the members of an object that begins at `start`, the last of which may be incomplete. A key whose value is
    /// missing is recorded as present.
    fn members(
        self,
        level: &Level<'t>,
        start: usize,
        depth: usize,
        members: &mut Vec<TreeMember<'t>>,
    ) -> Result<(), SyntaxError> {
        let mut after = start + 1;
        for (index, raw) in level.keys.iter().enumerate() {
            let (start, end) = self.range(raw);
            let key = string(raw).map_err(|error| self.locate(start, &error))?;
            let place = match level.values.get(index) {
                Some(value) => {
                    let (start, end) = self.range(value);
                    after = end;
                    Some((start, Some(end)))
                }
                None => self.value_after(end).map(|start| (start, None)),
            };
            let missing = TreeNode {
                start: end,
                end: 0,
                value: Value::Null,
            };
            let (value, error) = place.map_or((missing, None), |(start, end)| {
                self.value(start, end, depth + 1)
            });
            if let Some(error) = error {
                let step = Step::Key(key.clone().into_owned());
                members.push(TreeMember { start, key, value });
                return Err(error.within(step));
            }
            members.push(TreeMember { start, key, value });
        }
        // a key that is incomplete
        if level.fault.is_some()
            && level.keys.len() == level.values.len()
            && let Some(at) = self.next(after, members.is_empty())
            && self.text[at..].starts_with('"')
        {
            string(&self.text[at..]).map_err(|error| self.locate(at, &error))?;
        }
        Ok(())
    }
}

/// Converts `null`, `true`, `false` or a string, or reports why the text does not begin with a value.
fn leaf(text: &str) -> Result<Value<'_>, serde_json::Error> {
    if text.starts_with('"') {
        return string(text).map(Value::Text);
    }
    Ok(
        match serde_json::Value::deserialize(&mut Deserializer::from_str(text))? {
            serde_json::Value::Bool(value) => Value::Bool(value),
            _ => Value::Null,
        },
    )
}

/// Converts a complete number. There is none if the text is another value, or exceeds the range of double precision.
/// Numbers that exceed an integer of 64 bits, and -0, are floating-point numbers.
fn number(text: &str) -> Option<Value<'static>> {
    if !text.starts_with(|first: char| first == '-' || first.is_ascii_digit()) {
        return None;
    }
    if let Ok(value) = text.parse() {
        return Some(Value::Unsigned(value));
    }
    match text.parse() {
        Ok(value) if value < 0 => Some(Value::Signed(value)),
        _ => text
            .parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .map(Value::Float),
    }
}

/// Converts a string, without a copy if it contains no escape sequence.
fn string(text: &str) -> Result<Cow<'_, str>, serde_json::Error> {
    match <&str>::deserialize(&mut Deserializer::from_str(text)) {
        Ok(borrowed) => Ok(Cow::Borrowed(borrowed)),
        Err(_) => String::deserialize(&mut Deserializer::from_str(text)).map(Cow::Owned),
    }
}

/// The items of a list, or the keys and values of an object, as slices of the text. The value of the last key is
/// missing if it is incomplete.
#[derive(Default)]
struct Level<'t> {
    keys: Vec<&'t str>,
    values: Vec<&'t str>,
    /// The error that ends the list or object, if it is incomplete.
    fault: Option<serde_json::Error>,
}

impl<'t> Level<'t> {
    /// Reads the list or object at the beginning of a text.
    fn read(text: &'t str) -> Level<'t> {
        let mut level = Level::default();
        level.fault = Deserializer::from_str(text)
            .deserialize_any(&mut level)
            .err();
        level
    }

    /// The items of a complete list of numbers, which are the parts of the text between its commas. There is none if
    /// the list may contain anything but numbers, `true`, `false` and `null`.
    fn of_scalars(text: &'t str) -> Option<Level<'t>> {
        let inside = text.strip_prefix('[')?.strip_suffix(']')?;
        if inside.trim_ascii().is_empty()
            || inside
                .bytes()
                .any(|byte| matches!(byte, b'[' | b'{' | b'"'))
        {
            return None;
        }
        let values = inside.split(',').map(str::trim_ascii).collect();
        Some(Level {
            values,
            ..Level::default()
        })
    }
}

impl<'t> Visitor<'t> for &mut Level<'t> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list or an object")
    }

    fn visit_seq<A: SeqAccess<'t>>(self, mut items: A) -> Result<(), A::Error> {
        while let Some(item) = items.next_element::<&RawValue>()? {
            self.values.push(item.get());
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'t>>(self, mut members: A) -> Result<(), A::Error> {
        while let Some(key) = members.next_key::<&RawValue>()? {
            self.keys.push(key.get());
            self.values.push(members.next_value::<&RawValue>()?.get());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
