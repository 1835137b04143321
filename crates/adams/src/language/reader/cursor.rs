//! The characters of a statement with their places in the text.

use crate::language::lexer::RawStatement;
use crate::{AdamsFault, Error};

/// One character of a statement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Character {
    pub c: char,
    line: usize,
    column: usize,
    /// Whether it is the comma that begins a continued line.
    pub lead: bool,
}

/// A position in the characters of a statement, whose lines are joined by a blank.
pub(super) struct Cursor {
    characters: Vec<Character>,
    next: usize,
}

impl Cursor {
    pub fn new(statement: &RawStatement<'_>) -> Cursor {
        let mut characters = Vec::new();
        for piece in &statement.pieces {
            let first = piece.text.chars().position(|c| !c.is_whitespace());
            for (k, c) in piece.text.chars().enumerate() {
                let lead = c == ',' && first == Some(k) && !characters.is_empty();
                characters.push(Character {
                    c,
                    line: piece.line,
                    column: piece.column + k,
                    lead,
                });
            }
            let column = piece.column + piece.text.chars().count();
            characters.push(Character {
                c: ' ',
                line: piece.line,
                column,
                lead: false,
            });
        }
        Cursor {
            characters,
            next: 0,
        }
    }

    /// An error at the character `index`, or at the last one beyond the end.
    pub fn fault(&self, index: usize, fault: AdamsFault) -> Error {
        let place = self.characters.get(index).or(self.characters.last());
        let (line, column) = place.map_or((1, 1), |character| (character.line, character.column));
        Error::At {
            line,
            column,
            fault,
        }
    }

    /// The index of the next character.
    pub fn index(&self) -> usize {
        self.next
    }

    pub fn peek(&self) -> Option<Character> {
        self.characters.get(self.next).copied()
    }

    pub fn take(&mut self) -> Option<Character> {
        let character = self.peek()?;
        self.next += 1;
        Some(character)
    }

    /// Passes over blanks, and returns whether characters are left.
    pub fn skip(&mut self) -> bool {
        while self
            .peek()
            .is_some_and(|character| character.c.is_whitespace())
        {
            self.next += 1;
        }
        self.peek().is_some()
    }

    /// Passes over blanks and then over the character `c`, and returns whether it came next.
    pub fn eat(&mut self, c: char) -> bool {
        self.skip();
        let found = self.peek().is_some_and(|character| character.c == c);
        self.next += usize::from(found);
        found
    }

    /// Passes over blanks and commas, and returns whether there was a comma.
    pub fn separator(&mut self) -> bool {
        let mut found = false;
        while self.eat(',') {
            found = true;
        }
        found
    }

    /// Reads a word of letters, digits and underscores that begins with a letter.
    pub fn word(&mut self) -> Option<String> {
        self.skip();
        if !self
            .peek()
            .is_some_and(|character| character.c.is_ascii_alphabetic())
        {
            return None;
        }
        Some(self.run(|c| c.is_ascii_alphanumeric() || c == '_'))
    }

    /// Reads characters as long as they satisfy `pass`.
    pub fn run(&mut self, pass: impl Fn(char) -> bool) -> String {
        let mut out = String::new();
        while let Some(character) = self.peek().filter(|character| pass(character.c)) {
            out.push(character.c);
            self.next += 1;
        }
        out
    }

    /// The result of `look` from here; the position stays.
    pub fn ahead<T>(&mut self, look: impl FnOnce(&mut Cursor) -> T) -> T {
        let next = self.next;
        let out = look(self);
        self.next = next;
        out
    }
}

/// The text with single blanks between its words.
pub(super) fn single_blanks(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
