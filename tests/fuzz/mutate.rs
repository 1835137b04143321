//! Random changes of inputs: of bytes, of words and numbers, and of stretches that two inputs exchange.

use fastrand::Rng;

/// Largest number of bytes of an input.
pub const MOST_BYTES: usize = 32 << 10;

/// Numbers and marks that are often wrong.
const PIECES: [&str; 34] = [
    "0",
    "-1",
    "1",
    "7",
    "1e308",
    "1e-308",
    "1e999",
    "-0.0",
    "0.1",
    "1e30",
    "1e-30",
    "4294967296",
    "99999999999999999999",
    "-9223372036854775808",
    "1000000",
    "null",
    "true",
    "\"x\"",
    "\"\"",
    "[]",
    "{}",
    "[[]]",
    ",",
    ":",
    "}",
    "]",
    "{",
    "[",
    "\n",
    " ",
    "&",
    "!",
    "nan",
    "inf",
];

/// An input with one to four changes, and words from `words`.
pub fn mutated(base: &[u8], other: &[u8], words: &[Vec<u8>], dice: &mut Rng) -> Vec<u8> {
    let mut bytes = base.to_vec();
    for _ in 0..=dice.usize(..4) {
        change(&mut bytes, other, words, dice);
    }
    bytes.truncate(MOST_BYTES);
    bytes
}

fn change(bytes: &mut Vec<u8>, other: &[u8], words: &[Vec<u8>], dice: &mut Rng) {
    let any = |bytes: &[u8], dice: &mut Rng| dice.usize(..=bytes.len());
    match dice.usize(..10) {
        0 => {
            let at = any(bytes, dice);
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << dice.usize(..8);
            }
        }
        1 => {
            let at = any(bytes, dice);
            let count = dice.usize(1..=8);
            let new: Vec<u8> = (0..count).map(|_| dice.u8(..)).collect();
            bytes.splice(at..at, new);
        }
        2 => {
            let from = any(bytes, dice);
            let to = (from + dice.usize(..40)).min(bytes.len());
            bytes.drain(from..to);
        }
        3 => {
            // a stretch is doubled
            let from = any(bytes, dice);
            let to = (from + dice.usize(..200)).min(bytes.len());
            let again = bytes[from..to].to_vec();
            let at = if dice.bool() { to } else { any(bytes, dice) };
            bytes.splice(at..at, again);
        }
        4 if !other.is_empty() => {
            // a stretch of another input
            let from = dice.usize(..other.len());
            let to = (from + dice.usize(..200)).min(other.len());
            let at = any(bytes, dice);
            bytes.splice(at..at, other[from..to].iter().copied());
        }
        5 => bytes.truncate(any(bytes, dice)),
        _ => {
            // a word or number is replaced
            let all = tokens(bytes);
            if all.is_empty() {
                return;
            }
            let (from, to) = all[dice.usize(..all.len())];
            let piece = if words.is_empty() || dice.bool() {
                PIECES[dice.usize(..PIECES.len())].as_bytes()
            } else {
                &words[dice.usize(..words.len())]
            };
            bytes.splice(from..to, piece.iter().copied());
        }
    }
}

/// Byte ranges of words, numbers and marks.
pub fn tokens(bytes: &[u8]) -> Vec<(usize, usize)> {
    let is_word =
        |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'+' | b'_' | b'"');
    let mut found = Vec::new();
    let mut start = 0;
    while start < bytes.len() {
        let mut end = start + 1;
        while is_word(bytes[start]) && end < bytes.len() && is_word(bytes[end]) {
            end += 1;
        }
        if !bytes[start].is_ascii_whitespace() {
            found.push((start, end));
        }
        start = end;
    }
    found
}
