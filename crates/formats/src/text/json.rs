//! Parser of JSON (RFC 8259): converts a text to its tree.
//!
//! The parser is a recursive descent over the bytes. At the first error it returns the values read so far, with open
//! lists and objects marked as incomplete, and the error, so that the text before the error can be checked too.
//! Numbers and strings are converted, and errors are worded and located, as in `serde_json`; a test compares the two.

use std::borrow::Cow;

use super::place::{Path, Step};
use super::tree::{TreeMember, TreeNode, Value};

/// Nesting depth of lists and objects from which a text is rejected.
const DEPTH: usize = 128;

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
    pub message: &'static str,
    /// Byte offset.
    pub offset: usize,
    /// Path of the incomplete value.
    pub path: Path,
}

/// Parses a text.
pub(super) fn read(text: &str) -> Reading<'_> {
    let mut parser = Parser { text, bytes: text.as_bytes(), at: 0, depth: 0, error: None };
    let root = parser.value();
    if parser.error.is_none() {
        parser.skip_space();
        if parser.at < text.len() {
            parser.error = Some(parser.ahead("trailing characters"));
        }
    }
    Reading { root, error: parser.error }
}

struct Parser<'t> {
    text: &'t str,
    bytes: &'t [u8],
    /// Offset of the next byte.
    at: usize,
    /// Number of open lists and objects.
    depth: usize,
    error: Option<SyntaxError>,
}

impl<'t> Parser<'t> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn next(&mut self) -> Option<u8> {
        let byte = self.peek();
        self.at += usize::from(byte.is_some());
        byte
    }

    fn skip_space(&mut self) {
        while let Some(b' ' | b'\n' | b'\t' | b'\r') = self.peek() {
            self.at += 1;
        }
    }

    /// An error at the byte that was read last.
    fn behind(&self, message: &'static str) -> SyntaxError {
        self.error_before(self.at, message)
    }

    /// An error at the next byte.
    fn ahead(&self, message: &'static str) -> SyntaxError {
        self.error_before((self.at + 1).min(self.bytes.len()), message)
    }

    /// An error at the byte before `end`, but in the same line as `end`.
    fn error_before(&self, end: usize, message: &'static str) -> SyntaxError {
        let begins_line = end == 0 || self.bytes[end - 1] == b'\n';
        let offset = if begins_line { end } else { end - 1 };
        SyntaxError { message, offset, path: Path::default() }
    }

    fn value(&mut self) -> TreeNode<'t> {
        self.skip_space();
        let start = self.at;
        let value = match self.peek() {
            Some(b'[') => return self.nested(start, Value::List(Vec::new()), Parser::list),
            Some(b'{') => return self.nested(start, Value::Object(Vec::new()), Parser::object),
            Some(b'"') => {
                self.at += 1;
                self.string().map(Value::Text)
            }
            Some(b'-' | b'0'..=b'9') => self.number(),
            Some(b'n') => self.word("null", Value::Null),
            Some(b't') => self.word("true", Value::Bool(true)),
            Some(b'f') => self.word("false", Value::Bool(false)),
            Some(_) => Err(self.ahead("expected value")),
            None => Err(self.ahead("EOF while parsing a value")),
        };
        match value {
            Ok(value) => TreeNode { start, end: self.at, value },
            Err(error) => {
                self.error = Some(error);
                TreeNode { start, end: 0, value: Value::Null }
            }
        }
    }

    /// Parses a list or an object. `empty` is its value without items or members.
    fn nested(
        &mut self,
        start: usize,
        empty: Value<'t>,
        fill: fn(&mut Self) -> (Value<'t>, Result<(), SyntaxError>),
    ) -> TreeNode<'t> {
        if self.depth + 1 == DEPTH {
            self.error = Some(self.ahead("recursion limit exceeded"));
            return TreeNode { start, end: 0, value: empty };
        }
        self.depth += 1;
        self.at += 1;
        let (value, filled) = fill(self);
        self.depth -= 1;
        if let Err(error) = filled {
            self.error = Some(error);
        }
        TreeNode { start, end: if self.error.is_some() { 0 } else { self.at }, value }
    }

    /// Returns the pending error, if any, after adding `step` at the beginning of its path.
    #[cold]
    fn within(&mut self, step: Step) -> Result<(), SyntaxError> {
        let Some(mut error) = self.error.take() else { return Ok(()) };
        error.path.0.insert(0, step);
        Err(error)
    }

    /// Parses the items of a list and its closing bracket.
    fn list(&mut self) -> (Value<'t>, Result<(), SyntaxError>) {
        let mut items = Vec::new();
        let filled = self.fill_list(&mut items);
        (Value::List(items), filled)
    }

    fn fill_list(&mut self, items: &mut Vec<TreeNode<'t>>) -> Result<(), SyntaxError> {
        loop {
            self.skip_space();
            match self.peek() {
                None => return Err(self.ahead("EOF while parsing a list")),
                Some(b']') => {
                    self.at += 1;
                    return Ok(());
                }
                Some(_) if items.is_empty() => {}
                Some(b',') => {
                    self.at += 1;
                    self.skip_space();
                    match self.peek() {
                        None => return Err(self.ahead("EOF while parsing a value")),
                        Some(b']') => return Err(self.ahead("trailing comma")),
                        Some(_) => {}
                    }
                }
                Some(_) => return Err(self.ahead("expected `,` or `]`")),
            }
            items.push(self.value());
            if self.error.is_some() {
                return self.within(Step::Index(items.len() - 1));
            }
        }
    }

    /// Parses the members of an object and its closing brace.
    fn object(&mut self) -> (Value<'t>, Result<(), SyntaxError>) {
        let mut members = Vec::new();
        let filled = self.fill_object(&mut members);
        (Value::Object(members), filled)
    }

    fn fill_object(&mut self, members: &mut Vec<TreeMember<'t>>) -> Result<(), SyntaxError> {
        loop {
            self.skip_space();
            match self.peek() {
                None => return Err(self.ahead("EOF while parsing an object")),
                Some(b'}') => {
                    self.at += 1;
                    return Ok(());
                }
                Some(b'"') if members.is_empty() => {}
                Some(_) if members.is_empty() => return Err(self.ahead("key must be a string")),
                Some(b',') => {
                    self.at += 1;
                    self.skip_space();
                    match self.peek() {
                        None => return Err(self.ahead("EOF while parsing a value")),
                        Some(b'"') => {}
                        Some(b'}') => return Err(self.ahead("trailing comma")),
                        Some(_) => return Err(self.ahead("key must be a string")),
                    }
                }
                Some(_) => return Err(self.ahead("expected `,` or `}`")),
            }
            let start = self.at;
            self.at += 1;
            let key = self.string()?;
            // a key whose value is missing is recorded as present
            members.push(TreeMember {
                start,
                key,
                value: TreeNode { start: self.at, end: 0, value: Value::Null },
            });
            self.skip_space();
            match self.peek() {
                None => return Err(self.ahead("EOF while parsing an object")),
                Some(b':') => self.at += 1,
                Some(_) => return Err(self.ahead("expected `:`")),
            }
            let value = self.value();
            let last = members.len() - 1;
            members[last].value = value;
            if self.error.is_some() {
                return self.within(Step::Key(members[last].key.clone().into_owned()));
            }
        }
    }

    fn word(&mut self, word: &str, value: Value<'t>) -> Result<Value<'t>, SyntaxError> {
        for expected in word.bytes() {
            match self.next() {
                None => return Err(self.behind("EOF while parsing a value")),
                Some(byte) if byte != expected => return Err(self.behind("expected ident")),
                Some(_) => {}
            }
        }
        Ok(value)
    }

    fn skip_digits(&mut self) -> usize {
        let rest = &self.bytes[self.at..];
        let count = rest.iter().position(|byte| !byte.is_ascii_digit()).unwrap_or(rest.len());
        self.at += count;
        count
    }

    fn number(&mut self) -> Result<Value<'t>, SyntaxError> {
        let start = self.at;
        let is_negative = self.peek() == Some(b'-');
        self.at += usize::from(is_negative);
        let digits = self.at;
        match self.next() {
            None => return Err(self.behind("EOF while parsing a value")),
            Some(b'0') => {
                if let Some(b'0'..=b'9') = self.peek() {
                    return Err(self.ahead("invalid number"));
                }
            }
            Some(b'1'..=b'9') => {
                self.skip_digits();
            }
            Some(_) => return Err(self.behind("invalid number")),
        }
        let integer = &self.text[digits..self.at];
        let mut is_integer = true;
        if self.peek() == Some(b'.') {
            is_integer = false;
            self.at += 1;
            if self.skip_digits() == 0 {
                let is_end = self.peek().is_none();
                return Err(self.ahead(if is_end { "EOF while parsing a value" } else { "invalid number" }));
            }
        }
        if let Some(b'e' | b'E') = self.peek() {
            is_integer = false;
            self.exponent(start)?;
        }
        // numbers that exceed an integer of 64 bits, and -0, are read as floating-point numbers
        if is_integer && let Ok(value) = integer.parse::<u64>() {
            if !is_negative {
                return Ok(Value::Unsigned(value));
            }
            if let Some(value) = 0_i64.checked_sub_unsigned(value).filter(|value| *value < 0) {
                return Ok(Value::Signed(value));
            }
        }
        match self.text[start..self.at].parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Value::Float(value)),
            _ => Err(self.behind("number out of range")),
        }
    }

    /// Parses the exponent of the number that begins at `start`.
    fn exponent(&mut self, start: usize) -> Result<(), SyntaxError> {
        let is_zero = !self.bytes[start..self.at].iter().any(|byte| matches!(byte, b'1'..=b'9'));
        self.at += 1;
        let is_negative = self.peek() == Some(b'-');
        if let Some(b'+' | b'-') = self.peek() {
            self.at += 1;
        }
        let mut exponent = match self.next() {
            None => return Err(self.behind("EOF while parsing a value")),
            Some(byte @ b'0'..=b'9') => i32::from(byte - b'0'),
            Some(_) => return Err(self.behind("invalid number")),
        };
        while let Some(byte @ b'0'..=b'9') = self.peek() {
            self.at += 1;
            let digit = i32::from(byte - b'0');
            exponent = match exponent.checked_mul(10).and_then(|tens| tens.checked_add(digit)) {
                Some(exponent) => exponent,
                None if is_zero || is_negative => i32::MAX,
                None => return Err(self.behind("number out of range")),
            };
        }
        Ok(())
    }

    /// Parses the remainder of a string after its opening quote.
    fn string(&mut self) -> Result<Cow<'t, str>, SyntaxError> {
        let mut copied: Option<String> = None;
        let mut from = self.at;
        loop {
            while let Some(byte) = self.peek()
                && byte != b'"'
                && byte != b'\\'
                && byte >= 0x20
            {
                self.at += 1;
            }
            let stretch = &self.text[from..self.at];
            match self.next() {
                None => return Err(self.behind("EOF while parsing a string")),
                Some(b'"') => {
                    return Ok(match copied {
                        None => Cow::Borrowed(stretch),
                        Some(copied) => Cow::Owned(copied + stretch),
                    });
                }
                Some(b'\\') => {
                    let so_far = copied.get_or_insert_default();
                    so_far.push_str(stretch);
                    let escaped = self.escape()?;
                    so_far.push(escaped);
                    from = self.at;
                }
                Some(_) => {
                    let message = "control character (\\u0000-\\u001F) found while parsing a string";
                    return Err(self.behind(message));
                }
            }
        }
    }

    /// Parses an escape sequence after its backslash and returns the character.
    fn escape(&mut self) -> Result<char, SyntaxError> {
        Ok(match self.next() {
            None => return Err(self.behind("EOF while parsing a string")),
            Some(b'"') => '"',
            Some(b'\\') => '\\',
            Some(b'/') => '/',
            Some(b'b') => '\u{8}',
            Some(b'f') => '\u{c}',
            Some(b'n') => '\n',
            Some(b'r') => '\r',
            Some(b't') => '\t',
            Some(b'u') => return self.unicode_escape(),
            Some(_) => return Err(self.behind("invalid escape")),
        })
    }

    /// Parses one or two `\uXXXX` sequences after the first `\u` and returns the character. Two sequences are a
    /// surrogate pair.
    fn unicode_escape(&mut self) -> Result<char, SyntaxError> {
        let first = self.four_digits()?;
        if let Some(character) = char::from_u32(first) {
            return Ok(character);
        }
        if first >= 0xdc00 {
            return Err(self.behind("lone leading surrogate in hex escape"));
        }
        for expected in [b'\\', b'u'] {
            match self.next() {
                None => return Err(self.behind("EOF while parsing a string")),
                Some(byte) if byte != expected => return Err(self.behind("unexpected end of hex escape")),
                Some(_) => {}
            }
        }
        let second = self.four_digits()?;
        if !(0xdc00..0xe000).contains(&second) {
            return Err(self.behind("lone leading surrogate in hex escape"));
        }
        let pair = 0x1_0000 + ((first - 0xd800) << 10) + (second - 0xdc00);
        char::from_u32(pair).ok_or_else(|| self.behind("invalid unicode code point"))
    }

    fn four_digits(&mut self) -> Result<u32, SyntaxError> {
        let Some(digits) = self.bytes.get(self.at..self.at + 4) else {
            self.at = self.bytes.len();
            return Err(self.behind("EOF while parsing a string"));
        };
        self.at += 4;
        let digit = |value: Option<u32>, byte: &u8| Some(value? * 16 + char::from(*byte).to_digit(16)?);
        digits.iter().fold(Some(0), digit).ok_or_else(|| self.behind("invalid escape"))
    }
}

#[cfg(test)]
mod tests;
