//! Lines to statements, and statements to tokens.

use crate::{AdamsFault, Error};

/// The text of one statement, and the content of the comments before it.
#[derive(Debug, Default)]
pub(crate) struct RawStatement<'a> {
    /// The text, one piece for each line.
    pub pieces: Vec<Piece<'a>>,
    /// The `adams_view_name` in the comments.
    pub name: Option<&'a str>,
    /// The `adams_view_units` in the comments.
    pub units: Option<&'a str>,
    /// All other comments.
    pub remarks: Vec<&'a str>,
}

impl<'a> RawStatement<'a> {
    /// Takes the name, the units or the remark of a comment.
    fn note(&mut self, comment: &'a str) {
        let (name, units) = (
            quoted(comment, "adams_view_name"),
            quoted(comment, "adams_view_units"),
        );
        if (name, units) == (None, None) && !comment.trim().is_empty() {
            self.remarks.push(comment.trim());
        }
        self.name = name.or(self.name);
        self.units = units.or(self.units);
    }
}

/// Part of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<'a> {
    /// Line, from 1.
    pub line: usize,
    /// Column of the first character, from 1.
    pub column: usize,
    pub text: &'a str,
}

/// A token of the kind `K` with its position. Data sets and Adams View commands have tokens of different kinds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Positioned<K> {
    /// Line, from 1.
    pub line: usize,
    /// Column of the first character, from 1.
    pub column: usize,
    pub kind: K,
}

/// A token of a data set.
pub(crate) type Token<'a> = Positioned<TokenKind<'a>>;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TokenKind<'a> {
    Word(&'a str),
    Number(&'a str),
    Equals,
    Comma,
    Slash,
}

impl<K> Positioned<K> {
    /// An error at this token.
    pub fn fault(&self, fault: AdamsFault) -> Error {
        Error::At {
            line: self.line,
            column: self.column,
            fault,
        }
    }
}

/// The first word of a line that begins a statement: of `WORD/...`, or of a line with END alone.
pub(crate) fn statement_word(text: &str) -> Option<&str> {
    let text = text.trim_start();
    let end = text
        .find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .unwrap_or(text.len());
    let (word, rest) = text.split_at(end);
    let starts = word.starts_with(|c: char| c.is_ascii_alphabetic());
    let end = word.eq_ignore_ascii_case("END") && rest.trim().is_empty();
    (starts && (rest.trim_start().starts_with('/') || end)).then_some(word)
}

/// The title and the statements of a data set, up to END.
///
/// The first line is the title unless it is blank, a comment or a statement. A line continues the statement
/// before it if it begins with a comma, or if that statement ended with a comma and the line does not begin a
/// statement. `;` ends a statement, `!` begins a comment.
pub(crate) fn statements(text: &str) -> Result<(Option<&str>, Vec<RawStatement<'_>>), Error> {
    let mut lines = text.lines().enumerate().peekable();
    let title = match lines.peek() {
        Some((_, first))
            if statement_word(first).is_none() && !first.trim_start().starts_with('!') =>
        {
            let title = first.trim();
            lines.next();
            (!title.is_empty()).then_some(title)
        }
        _ => None,
    };
    let mut all: Vec<RawStatement<'_>> = Vec::new();
    // The name, units and remarks in the comments since the last statement; they belong to the next one.
    let mut next = RawStatement::default();
    // Whether the last statement may be continued, and whether it ended with a comma.
    let (mut open, mut comma) = (false, false);
    for (number, line) in lines {
        let body = line.trim_start();
        if let Some(comment) = body.strip_prefix('!') {
            next.note(comment);
            continue;
        }
        let parts = split_statements(line);
        let ends = parts.len() - 1;
        let mut column = 1;
        for (k, part) in parts.into_iter().enumerate() {
            let piece = Piece {
                line: number + 1,
                column,
                text: part,
            };
            column += part.chars().count() + 1;
            let trimmed = part.trim();
            if trimmed.is_empty() {
                open &= ends == 0;
                continue;
            }
            let continues = k == 0
                && (trimmed.starts_with(',')
                    || (open && comma && statement_word(trimmed).is_none()));
            if continues {
                match all.last_mut().filter(|_| open) {
                    Some(last) => last.pieces.push(piece),
                    None => {
                        let column =
                            piece.column + part.chars().take_while(|c| c.is_whitespace()).count();
                        return Err(Error::At {
                            line: piece.line,
                            column,
                            fault: AdamsFault::UnexpectedText,
                        });
                    }
                }
            } else {
                if statement_word(trimmed).is_some_and(|word| word.eq_ignore_ascii_case("END")) {
                    return Ok((title, all));
                }
                all.push(RawStatement {
                    pieces: vec![piece],
                    ..std::mem::take(&mut next)
                });
            }
            open = k == ends;
            comma = trimmed.ends_with(',');
        }
    }
    Ok((title, all))
}

/// The text of a line before `!`, split at `;`. Both characters have no effect between double quotes.
fn split_statements(line: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let (mut start, mut quoted) = (0, false);
    for (k, c) in line.char_indices() {
        match c {
            '"' => quoted = !quoted,
            ';' if !quoted => {
                parts.push(&line[start..k]);
                start = k + 1;
            }
            '!' if !quoted => {
                parts.push(&line[start..k]);
                return parts;
            }
            _ => {}
        }
    }
    parts.push(&line[start..]);
    parts
}

/// The value of `key='value'` in a comment.
fn quoted<'a>(comment: &'a str, key: &str) -> Option<&'a str> {
    let value = comment
        .trim()
        .strip_prefix(key)?
        .trim_start()
        .strip_prefix('=')?
        .trim();
    let inner = value.strip_prefix('\'')?.strip_suffix('\'')?;
    (!inner.is_empty()).then_some(inner)
}

/// The tokens of a statement.
pub(crate) fn tokens<'a>(statement: &RawStatement<'a>) -> Result<Vec<Token<'a>>, Error> {
    let mut out = Vec::new();
    for piece in &statement.pieces {
        let mut rest = piece.text;
        let mut column = piece.column;
        loop {
            let trimmed = rest.trim_start();
            column += rest[..rest.len() - trimmed.len()].chars().count();
            rest = trimmed;
            let Some(first) = rest.chars().next() else {
                break;
            };
            let at = |kind| Token {
                line: piece.line,
                column,
                kind,
            };
            let (length, token) = match first {
                '=' => (1, at(TokenKind::Equals)),
                ',' => (1, at(TokenKind::Comma)),
                '/' => (1, at(TokenKind::Slash)),
                c if c.is_ascii_alphabetic() => {
                    let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
                    let word = &rest[..end.unwrap_or(rest.len())];
                    (word.len(), at(TokenKind::Word(word)))
                }
                c if c.is_ascii_digit() || "+-.".contains(c) => {
                    let number = &rest[..number_length(rest.as_bytes())];
                    (number.len(), at(TokenKind::Number(number)))
                }
                _ => {
                    return Err(Error::At {
                        line: piece.line,
                        column,
                        fault: AdamsFault::UnexpectedText,
                    });
                }
            };
            out.push(token);
            rest = &rest[length..];
            column += length;
        }
    }
    Ok(out)
}

/// The number of bytes of the number at the start of `text`. Letters that follow without a gap are counted
/// too, so that they are refused as part of a malformed number.
fn number_length(text: &[u8]) -> usize {
    let mut k = 1;
    while let Some(&c) = text.get(k) {
        let sign = matches!(c, b'+' | b'-') && matches!(text[k - 1], b'e' | b'E' | b'd' | b'D');
        if !(c.is_ascii_alphanumeric() || c == b'.' || sign) {
            break;
        }
        k += 1;
    }
    k
}
