//! Lines to commands, and commands to tokens.

use crate::language::lexer::{Piece, Positioned};
use crate::{AdamsFault, Error};

/// A command: one piece of text for each line, without the `&` that continues it.
pub(super) struct Command<'a>(Vec<Piece<'a>>);

/// A token of a command.
pub(super) type CommandToken<'a> = Positioned<CommandTokenKind<'a>>;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CommandTokenKind<'a> {
    Word(&'a str),
    /// Text between double quotes.
    Quoted(&'a str),
    Equals,
    Comma,
}

/// The commands of a file. `!` at the start of a line begins a comment; a line that ends with `&` is
/// continued.
pub(super) fn commands(text: &str) -> Vec<Command<'_>> {
    let mut all: Vec<Command<'_>> = Vec::new();
    let mut open = false;
    for (number, line) in text.lines().enumerate() {
        let body = line.trim_end();
        if body.trim_start().starts_with('!') {
            continue;
        }
        let (code, goes_on) = match body.strip_suffix('&') {
            Some(code) => (code, true),
            None => (body, false),
        };
        let piece = Piece {
            line: number + 1,
            column: 1,
            text: code,
        };
        match all.last_mut().filter(|_| open) {
            Some(last) => last.0.push(piece),
            None => all.push(Command(vec![piece])),
        }
        open = goes_on;
    }
    all
}

impl<'a> Command<'a> {
    /// Whether the command begins with `words`, each abbreviated to no fewer letters than given, in any case.
    pub fn starts(&self, words: &[(&str, usize)]) -> bool {
        let mut given = self
            .0
            .iter()
            .flat_map(|piece| piece.text.split_whitespace());
        words.iter().all(|(full, least)| {
            let begins = |word: &str| {
                word.len() >= *least
                    && full
                        .get(..word.len())
                        .is_some_and(|start| start.eq_ignore_ascii_case(word))
            };
            given.next().is_some_and(begins)
        })
    }

    /// Line of the first character of the command.
    pub fn line(&self) -> usize {
        self.0.first().map_or(1, |piece| piece.line)
    }

    /// Each key with the first word of its values, in a command whose values may be expressions that [`Self::tokens`]
    /// refuses. The equals signs within parentheses belong to expressions.
    pub fn first_values(&self) -> Vec<(String, String)> {
        let text: Vec<&str> = self.0.iter().map(|piece| piece.text).collect();
        let text = text.join(" ");
        let mut found = Vec::new();
        let mut depth = 0_usize;
        for (at, c) in text.char_indices() {
            match c {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                '=' if depth == 0 => {
                    let key = text[..at].split_whitespace().last().unwrap_or_default();
                    let value = text[at + 1..].trim_start();
                    let value = match value.strip_prefix('"') {
                        Some(quoted) => quoted.split('"').next(),
                        None => value.split([' ', '\t', ',']).next(),
                    };
                    found.push((key.to_owned(), value.unwrap_or_default().to_owned()));
                }
                _ => {}
            }
        }
        found
    }

    /// The tokens of the command.
    pub fn tokens(&self) -> Result<Vec<CommandToken<'a>>, Error> {
        let mut out = Vec::new();
        for piece in &self.0 {
            let mut rest = piece.text;
            let mut column = piece.column;
            loop {
                let trimmed = rest.trim_start();
                column += rest[..rest.len() - trimmed.len()].chars().count();
                rest = trimmed;
                let Some(first) = rest.chars().next() else {
                    break;
                };
                let refused = || Error::At {
                    line: piece.line,
                    column,
                    fault: AdamsFault::UnexpectedText,
                };
                let (length, kind) = match first {
                    '=' => (1, CommandTokenKind::Equals),
                    ',' => (1, CommandTokenKind::Comma),
                    '"' => {
                        let end = rest[1..].find('"').ok_or_else(refused)?;
                        (end + 2, CommandTokenKind::Quoted(&rest[1..=end]))
                    }
                    c if c.is_ascii_alphanumeric() || "._+-".contains(c) => {
                        let ends = |c: char| !(c.is_ascii_alphanumeric() || "._+-".contains(c));
                        let length = rest.find(ends).unwrap_or(rest.len());
                        (length, CommandTokenKind::Word(&rest[..length]))
                    }
                    _ => return Err(refused()),
                };
                out.push(CommandToken {
                    line: piece.line,
                    column,
                    kind,
                });
                column += rest[..length].chars().count();
                rest = &rest[length..];
            }
        }
        Ok(out)
    }
}
