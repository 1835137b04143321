//! Statements to lines of text.

use super::lexer::statement_word;
use super::statement::{ArgumentValue, Statement};
use crate::{Error, StatementId, number};

/// Largest number of characters of a line.
const WIDTH: usize = 79;

/// The text of a data set as it grows, statement by statement.
pub(super) struct Layout {
    out: String,
}

impl Layout {
    pub fn new(title: &str) -> Layout {
        let mut out = line_of_title(title);
        out.push_str("\n!\n");
        Layout { out }
    }

    pub fn statement(&mut self, statement: &Statement) -> Result<(), Error> {
        for remark in &statement.remarks {
            self.remark(remark);
        }
        for (key, value) in [
            ("adams_view_name", &statement.name),
            ("adams_view_units", &statement.units),
        ] {
            let Some(value) = value else { continue };
            let line = format!("!  {key}='{value}'");
            let plain = value.bytes().all(|c| c.is_ascii_graphic() && c != b'\'');
            if !plain || value.is_empty() || line.len() > WIDTH {
                return Err(Error::Name {
                    statement: id_of(statement),
                });
            }
            self.line(&line);
        }
        self.out.push_str(&statement.keyword);
        self.out.push('/');
        if let Some(id) = statement.id {
            self.out.push_str(&id.to_string());
        }
        self.out.push('\n');
        let last = statement.arguments.len().saturating_sub(1);
        for (k, argument) in statement.arguments.iter().enumerate() {
            let written = self.argument(&argument.name, &argument.value, k == last);
            written.ok_or_else(|| Error::Long {
                statement: id_of(statement),
            })?;
        }
        self.line("!");
        Ok(())
    }

    /// Writes one argument; `None` if its text cannot be broken into lines. An expression that is not the
    /// last argument ends with `\`.
    fn argument(&mut self, name: &str, value: &ArgumentValue, last: bool) -> Option<()> {
        match value {
            ArgumentValue::Flag => self.line(&format!(", {name}")),
            ArgumentValue::Word(text) => return self.words(name, text),
            ArgumentValue::Whole(whole) => self.line(&format!(", {name} = {whole}")),
            ArgumentValue::Numbers(values) => {
                self.list(name, values.iter().map(|&value| number::write(value)))
            }
            ArgumentValue::Degrees(values) => {
                self.list(name, values.iter().map(|&value| number::write(value) + "D"));
            }
            ArgumentValue::Function(text) => {
                return self.expression(name, text, if last { "" } else { "\\" });
            }
        }
        Some(())
    }

    /// `, CNAMES = a, "b c"`, broken at commas where it is longer than a line.
    fn words(&mut self, name: &str, text: &str) -> Option<()> {
        if !text.bytes().all(|c| c.is_ascii_graphic() || c == b' ') {
            return None;
        }
        let line = format!(", {name} = {text}");
        if line.len() <= WIDTH {
            self.line(&line);
            return Some(());
        }
        let items = items(text);
        if items.iter().any(|item| item.len() + name.len() + 6 > WIDTH) {
            return None;
        }
        self.list(name, items.into_iter().map(str::to_owned));
        Some(())
    }

    pub fn end(mut self) -> String {
        self.line("END");
        self.out
    }

    fn line(&mut self, text: &str) {
        self.out.push_str(text);
        self.out.push('\n');
    }

    /// A comment, broken into lines at blanks.
    fn remark(&mut self, text: &str) {
        let mut line = String::from("!");
        for word in plain(text).split_whitespace() {
            if line.len() > 1 && line.len() + 1 + word.len() > WIDTH {
                self.line(&line);
                line = String::from("!");
            }
            line.push(' ');
            line.push_str(word);
        }
        line.truncate(WIDTH);
        self.line(&line);
    }

    /// `, X = 1.0, 2.0, ...`, broken before a separating comma.
    fn list(&mut self, name: &str, values: impl Iterator<Item = String>) {
        let mut line = format!(", {name} =");
        for (k, item) in values.enumerate() {
            if k > 0 && line.len() + item.len() + 2 > WIDTH {
                self.line(&line);
                line.clear();
            }
            line.push_str(if k == 0 { " " } else { ", " });
            line.push_str(&item);
        }
        self.line(&line);
    }

    /// `, FUNCTION = a + b`, broken after commas and operators but never inside a name or number.
    fn expression(&mut self, name: &str, text: &str, last: &str) -> Option<()> {
        let mut line = format!(", {name} = ");
        for piece in pieces(text) {
            if line.len() + piece.len() + last.len() > WIDTH {
                if line.trim() == "," || !text.is_ascii() {
                    return None;
                }
                self.line(line.trim_end());
                line = String::from(", ");
            }
            if line.len() + piece.len() + last.len() > WIDTH {
                return None;
            }
            line.push_str(piece);
        }
        line.push_str(last);
        self.line(&line);
        Some(())
    }
}

/// The statement that an error names.
fn id_of(statement: &Statement) -> StatementId {
    StatementId::new(&statement.keyword, statement.id.unwrap_or(0))
}

/// The items of a list of words, which are separated by commas outside double quotes.
fn items(text: &str) -> Vec<&str> {
    let mut quoted = false;
    let pieces = text.split(|c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    });
    pieces.map(str::trim).collect()
}

/// The pieces of an expression between which a line may end. Each ends with a comma, an operator or an
/// opening bracket.
fn pieces(text: &str) -> Vec<&str> {
    let bytes = text.as_bytes();
    let mut out = Vec::new();
    let mut start = 0;
    for (k, &c) in bytes.iter().enumerate() {
        let next = bytes.get(k + 1).copied();
        let exponent = k >= 2
            && matches!(c, b'+' | b'-')
            && matches!(bytes[k - 1], b'E' | b'e' | b'D' | b'd')
            && (bytes[k - 2].is_ascii_digit() || bytes[k - 2] == b'.');
        // A line must not end between the two stars of `**`.
        let power = c == b'*' && next == Some(b'*');
        if matches!(c, b',' | b'+' | b'-' | b'*' | b'/' | b'(' | b':') && !exponent && !power {
            out.push(&text[start..=k]);
            start = k + 1;
        }
    }
    out.push(&text[start..]);
    out
}

/// The title on one line, so that it cannot be taken for a statement or comment.
fn line_of_title(text: &str) -> String {
    let clean = plain(text.trim());
    let statement = statement_word(&clean).is_some() || clean.starts_with(['!', ',']);
    let mut out = if statement {
        format!("Model: {clean}")
    } else {
        clean
    };
    out.truncate(WIDTH);
    out.truncate(out.trim_end().len());
    out
}

/// The text with `?` for every character that is not printable ASCII.
fn plain(text: &str) -> String {
    text.chars()
        .map(|c| {
            if c.is_ascii_graphic() || c == ' ' {
                c
            } else {
                '?'
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::pieces;

    #[test]
    fn expressions_break_after_operators_but_not_inside_numbers() {
        let text = "1.5E-07*AKISPL(DZ(1,2),X**2,6)-2";
        assert_eq!(
            pieces(text),
            [
                "1.5E-07*", "AKISPL(", "DZ(", "1,", "2),", "X**", "2,", "6)-", "2"
            ]
        );
    }
}
