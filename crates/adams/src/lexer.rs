//! Lines to statements, statements to tokens.

use crate::{Error, Fault};

/// A statement: its pieces of text, one a line, and the names that Adams View left in comments before it.
#[derive(Debug, Default)]
pub(crate) struct Statement<'a> {
    pub pieces: Vec<Piece<'a>>,
    pub name: Option<&'a str>,
    pub units: Option<&'a str>,
    /// Other comments before it.
    pub remarks: Vec<&'a str>,
}

/// Part of a line: its number and first column, counted from 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<'a> {
    pub line: usize,
    pub column: usize,
    pub text: &'a str,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Token<'a> {
    pub line: usize,
    pub column: usize,
    pub kind: TokenKind<'a>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TokenKind<'a> {
    Word(&'a str),
    Number(&'a str),
    Equals,
    Comma,
    Slash,
}

impl Token<'_> {
    pub fn fault(&self, fault: Fault) -> Error {
        Error::At { line: self.line, column: self.column, fault }
    }
}

/// The first word of a line that reads WORD/..., or the lone word END.
pub(crate) fn head(text: &str) -> Option<&str> {
    let text = text.trim_start();
    let end = text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(text.len());
    let (word, rest) = text.split_at(end);
    let starts = word.starts_with(|c: char| c.is_ascii_alphabetic());
    let end = word.eq_ignore_ascii_case("END") && rest.trim().is_empty();
    (starts && (rest.trim_start().starts_with('/') || end)).then_some(word)
}

/// Title and statements of a data set, up to END.
///
/// A line continues the statement before it if it begins with a comma, or if that one ended with a comma and
/// it does not begin a statement. `;` ends a statement, `!` begins a comment.
pub(crate) fn statements(text: &str) -> Result<(Option<&str>, Vec<Statement<'_>>), Error> {
    let mut lines = text.lines().enumerate().peekable();
    let title = match lines.peek() {
        Some((_, first)) if head(first).is_none() && !first.trim_start().starts_with('!') => {
            let title = first.trim();
            lines.next();
            (!title.is_empty()).then_some(title)
        }
        _ => None,
    };
    let mut all: Vec<Statement<'_>> = Vec::new();
    let (mut name, mut units, mut remarks) = (None, None, Vec::new());
    let (mut open, mut comma) = (false, false);
    for (number, line) in lines {
        let body = line.trim_start();
        if let Some(comment) = body.strip_prefix('!') {
            let views = (view(comment, "adams_view_name"), view(comment, "adams_view_units"));
            if views == (None, None) && !comment.trim().is_empty() {
                remarks.push(comment.trim());
            }
            name = views.0.or(name);
            units = views.1.or(units);
            continue;
        }
        let parts = code(line);
        let ends = parts.len() - 1;
        let mut column = 1;
        for (k, part) in parts.into_iter().enumerate() {
            let piece = Piece { line: number + 1, column, text: part };
            column += part.chars().count() + 1;
            let trimmed = part.trim();
            if trimmed.is_empty() {
                open &= ends == 0;
                continue;
            }
            let continues =
                k == 0 && (trimmed.starts_with(',') || (open && comma && head(trimmed).is_none()));
            if continues {
                match all.last_mut().filter(|_| open) {
                    Some(last) => last.pieces.push(piece),
                    None => {
                        let column = piece.column + part.chars().take_while(|c| c.is_whitespace()).count();
                        return Err(Error::At { line: piece.line, column, fault: Fault::Text });
                    }
                }
            } else {
                if head(trimmed).is_some_and(|word| word.eq_ignore_ascii_case("END")) {
                    return Ok((title, all));
                }
                let remarks = std::mem::take(&mut remarks);
                all.push(Statement { pieces: vec![piece], name: name.take(), units: units.take(), remarks });
            }
            open = k == ends;
            comma = trimmed.ends_with(',');
        }
    }
    Ok((title, all))
}

/// What stands before `!`, cut at `;`; neither counts between double quotes.
fn code(line: &str) -> Vec<&str> {
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
fn view<'a>(comment: &'a str, key: &str) -> Option<&'a str> {
    let value = comment.trim().strip_prefix(key)?.trim_start().strip_prefix('=')?.trim();
    let inner = value.strip_prefix('\'')?.strip_suffix('\'')?;
    (!inner.is_empty()).then_some(inner)
}

/// Tokens of a statement.
pub(crate) fn tokens<'a>(statement: &Statement<'a>) -> Result<Vec<Token<'a>>, Error> {
    let mut out = Vec::new();
    for piece in &statement.pieces {
        let mut rest = piece.text;
        let mut column = piece.column;
        loop {
            let trimmed = rest.trim_start();
            column += rest[..rest.len() - trimmed.len()].chars().count();
            rest = trimmed;
            let Some(first) = rest.chars().next() else { break };
            let at = |kind| Token { line: piece.line, column, kind };
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
                _ => return Err(Error::At { line: piece.line, column, fault: Fault::Text }),
            };
            out.push(token);
            rest = &rest[length..];
            column += length;
        }
    }
    Ok(out)
}

/// Bytes of the number at the start of `text`; letters that cling to it belong to it, so that they are refused.
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
