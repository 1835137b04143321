//! The letters of a statement with their places.

use crate::lexer::Statement;
use crate::{Error, Fault};

/// One letter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Letter {
    pub c: char,
    line: usize,
    column: usize,
    /// The comma that begins a continued line.
    pub lead: bool,
}

/// A statement as one run of letters, with a blank between lines.
pub(super) struct Flow {
    letters: Vec<Letter>,
    next: usize,
}

impl Flow {
    pub fn new(statement: &Statement<'_>) -> Flow {
        let mut letters = Vec::new();
        for piece in &statement.pieces {
            let first = piece.text.chars().position(|c| !c.is_whitespace());
            for (k, c) in piece.text.chars().enumerate() {
                let lead = c == ',' && first == Some(k) && !letters.is_empty();
                letters.push(Letter { c, line: piece.line, column: piece.column + k, lead });
            }
            let column = piece.column + piece.text.chars().count();
            letters.push(Letter { c: ' ', line: piece.line, column, lead: false });
        }
        Flow { letters, next: 0 }
    }

    /// An error at the letter `index`, or at the end.
    pub fn fault(&self, index: usize, fault: Fault) -> Error {
        let place = self.letters.get(index).or(self.letters.last());
        let (line, column) = place.map_or((1, 1), |letter| (letter.line, letter.column));
        Error::At { line, column, fault }
    }

    /// Index of the next letter.
    pub fn index(&self) -> usize {
        self.next
    }

    pub fn peek(&self) -> Option<Letter> {
        self.letters.get(self.next).copied()
    }

    pub fn take(&mut self) -> Option<Letter> {
        let letter = self.peek()?;
        self.next += 1;
        Some(letter)
    }

    /// Past blanks; whether that is not the end.
    pub fn skip(&mut self) -> bool {
        while self.peek().is_some_and(|letter| letter.c.is_whitespace()) {
            self.next += 1;
        }
        self.peek().is_some()
    }

    /// Past blanks and this letter, if it comes next.
    pub fn eat(&mut self, c: char) -> bool {
        self.skip();
        let found = self.peek().is_some_and(|letter| letter.c == c);
        self.next += usize::from(found);
        found
    }

    /// Past blanks and commas; whether there was a comma.
    pub fn separator(&mut self) -> bool {
        let mut found = false;
        while self.eat(',') {
            found = true;
        }
        found
    }

    /// A word of letters, digits and underscores that begins with a letter.
    pub fn word(&mut self) -> Option<String> {
        self.skip();
        if !self.peek().is_some_and(|letter| letter.c.is_ascii_alphabetic()) {
            return None;
        }
        Some(self.run(|c| c.is_ascii_alphanumeric() || c == '_'))
    }

    /// Letters as long as they pass.
    pub fn run(&mut self, pass: impl Fn(char) -> bool) -> String {
        let mut out = String::new();
        while let Some(letter) = self.peek().filter(|letter| pass(letter.c)) {
            out.push(letter.c);
            self.next += 1;
        }
        out
    }

    /// What `look` finds from here, without moving.
    pub fn ahead<T>(&mut self, look: impl FnOnce(&mut Flow) -> T) -> T {
        let next = self.next;
        let out = look(self);
        self.next = next;
        out
    }
}
