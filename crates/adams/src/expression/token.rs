//! Characters of an expression to tokens.

use crate::{Fault, number};

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Token {
    Number(f64),
    Word(String),
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Open,
    Close,
    Comma,
    Colon,
}

/// Tokens with the number of characters before each.
pub(crate) fn tokens(text: &[char]) -> Result<Vec<(usize, Token)>, (usize, Fault)> {
    let mut out = Vec::new();
    let mut k = 0;
    while let Some(&c) = text.get(k) {
        let start = k;
        k += 1;
        let token = match c {
            c if c.is_whitespace() => continue,
            '+' => Token::Plus,
            '-' => Token::Minus,
            '*' if text.get(k) == Some(&'*') => {
                k += 1;
                Token::Power
            }
            '*' => Token::Times,
            '/' => Token::Over,
            '(' => Token::Open,
            ')' => Token::Close,
            ',' => Token::Comma,
            ':' => Token::Colon,
            c if c.is_ascii_digit() || c == '.' => {
                let (value, end) = number(text, start).ok_or((start, Fault::Number))?;
                k = end;
                Token::Number(value)
            }
            c if c.is_ascii_alphabetic() || c == '_' => {
                while text.get(k).is_some_and(|c| c.is_ascii_alphanumeric() || *c == '_') {
                    k += 1;
                }
                Token::Word(text[start..k].iter().collect::<String>().to_ascii_uppercase())
            }
            _ => return Err((start, Fault::Text)),
        };
        out.push((start, token));
    }
    Ok(out)
}

/// A number at `start` and where it ends. `1.5D+01` has an exponent, `90D` is an angle in degrees.
fn number(text: &[char], start: usize) -> Option<(f64, usize)> {
    let digit = |k: usize| text.get(k).is_some_and(char::is_ascii_digit);
    let mut k = start;
    while digit(k) || text.get(k) == Some(&'.') {
        k += 1;
    }
    let mut degrees = false;
    if text.get(k).is_some_and(|c| "eEdD".contains(*c)) {
        let sign = usize::from(text.get(k + 1).is_some_and(|c| "+-".contains(*c)));
        if digit(k + 1 + sign) {
            k += 1 + sign;
            while digit(k) {
                k += 1;
            }
        }
    }
    let digits: String = text[start..k].iter().collect();
    if text.get(k).is_some_and(|c| "dD".contains(*c)) {
        degrees = true;
        k += 1;
    }
    if text.get(k).is_some_and(|c| c.is_ascii_alphanumeric() || *c == '_' || *c == '.') {
        return None;
    }
    let value = number::read(&digits)?;
    Some((if degrees { value.to_radians() } else { value }, k))
}
