//! Parser of function expressions: characters to tokens, tokens to a tree.

use super::tree::{Expression, ExpressionName, FactorOperator, TermOperator};
use crate::{AdamsFault, number};

/// Largest depth of nested brackets, signs and powers. It bounds the recursion of everything that walks a
/// tree.
const DEEPEST: usize = 100;

/// Reads a function expression.
///
/// The operator `**` associates to the right and binds more tightly than a sign (`-A**2` is `-(A**2)`); `*`
/// and `/` come next, then `+` and `-`. A number may have an E or D exponent. A D without digits after it
/// marks an angle in degrees, so that `90D` is pi/2, whereas `90D+5` is 90e5 as in Fortran.
///
/// # Errors
/// The number of characters before the first place that cannot be read, and what is wrong there.
///
/// ```
/// use adams::{Expression, AdamsFault, expression};
///
/// assert_eq!(expression::parse("180D"), Ok(Expression::Number(std::f64::consts::PI)));
/// assert_eq!(expression::parse("1+*2"), Err((2, AdamsFault::UnexpectedText)));
/// ```
pub fn parse(text: &str) -> Result<Expression, (usize, AdamsFault)> {
    let letters: Vec<char> = text.chars().collect();
    let tokens = tokens(&letters)?;
    let mut parser = Parser {
        tokens: &tokens,
        next: 0,
        end: letters.len(),
        depth: 0,
    };
    let out = parser.sum()?;
    match parser.peek() {
        None => Ok(out),
        Some(_) => Err((parser.offset(), AdamsFault::UnexpectedText)),
    }
}

/// A recursive-descent parser.
struct Parser<'a> {
    tokens: &'a [(usize, Token)],
    /// Index of the next token.
    next: usize,
    /// Characters of the whole text.
    end: usize,
    /// Nesting depth of the place that is being read.
    depth: usize,
}

type Parsed = Result<Expression, (usize, AdamsFault)>;

impl Parser<'_> {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next).map(|(_, token)| token)
    }

    fn offset(&self) -> usize {
        self.tokens
            .get(self.next)
            .map_or(self.end, |(offset, _)| *offset)
    }

    /// Passes over a token if it comes next, and returns whether it did.
    fn take(&mut self, token: &Token) -> bool {
        let found = self.peek() == Some(token);
        self.next += usize::from(found);
        found
    }

    fn expect(&mut self, token: &Token) -> Result<(), (usize, AdamsFault)> {
        if self.take(token) {
            Ok(())
        } else {
            Err((self.offset(), AdamsFault::UnexpectedText))
        }
    }

    /// Reads a part that is nested one level deeper.
    fn within(&mut self, part: impl FnOnce(&mut Self) -> Parsed) -> Parsed {
        if self.depth == DEEPEST {
            return Err((self.offset(), AdamsFault::NestedTooDeep));
        }
        self.depth += 1;
        let out = part(self);
        self.depth -= 1;
        out
    }

    fn sign(&mut self) -> Option<TermOperator> {
        if self.take(&Token::Plus) {
            Some(TermOperator::Plus)
        } else if self.take(&Token::Minus) {
            Some(TermOperator::Minus)
        } else {
            None
        }
    }

    fn sum(&mut self) -> Parsed {
        let first = self.sign();
        let mut terms = vec![(first.unwrap_or(TermOperator::Plus), self.product()?)];
        while let Some(sign) = self.sign() {
            terms.push((sign, self.product()?));
        }
        if let [(TermOperator::Plus, _)] = terms.as_slice()
            && let Some((_, only)) = terms.pop()
        {
            return Ok(only);
        }
        Ok(Expression::Sum(terms))
    }

    fn product(&mut self) -> Parsed {
        let mut factors = vec![(FactorOperator::Times, self.signed()?)];
        loop {
            let factor = if self.take(&Token::Times) {
                FactorOperator::Times
            } else if self.take(&Token::Over) {
                FactorOperator::Over
            } else {
                break;
            };
            factors.push((factor, self.signed()?));
        }
        if let [_] = factors.as_slice()
            && let Some((_, only)) = factors.pop()
        {
            return Ok(only);
        }
        Ok(Expression::Product(factors))
    }

    /// Reads a power, possibly with a sign before it as in `A*-B`.
    fn signed(&mut self) -> Parsed {
        match self.sign() {
            Some(sign) => {
                let inner = self.within(Parser::signed)?;
                Ok(if sign == TermOperator::Plus {
                    inner
                } else {
                    Expression::Sum(vec![(sign, inner)])
                })
            }
            None => self.power(),
        }
    }

    fn power(&mut self) -> Parsed {
        let base = self.atom()?;
        if !self.take(&Token::Power) {
            return Ok(base);
        }
        let exponent = self.within(Parser::signed)?;
        Ok(Expression::Power(Box::new(base), Box::new(exponent)))
    }

    fn atom(&mut self) -> Parsed {
        let offset = self.offset();
        match self.peek().cloned() {
            Some(Token::Number(value)) => {
                self.next += 1;
                Ok(Expression::Number(value))
            }
            Some(Token::Open) => {
                self.next += 1;
                let inner = self.within(Parser::sum)?;
                self.expect(&Token::Close)?;
                Ok(inner)
            }
            Some(Token::Word(word)) => {
                self.next += 1;
                let name = ExpressionName { word, offset };
                if self.take(&Token::Open) {
                    self.call(name)
                } else {
                    Ok(Expression::Name(name))
                }
            }
            _ => Err((offset, AdamsFault::UnexpectedText)),
        }
    }

    fn call(&mut self, name: ExpressionName) -> Parsed {
        let mut arguments = Vec::new();
        if self.take(&Token::Close) {
            return Ok(Expression::Call(name, arguments));
        }
        let choice = name.word == "IF";
        loop {
            arguments.push(self.within(Parser::sum)?);
            if choice && arguments.len() == 1 {
                self.expect(&Token::Colon)?;
            } else if self.take(&Token::Close) {
                return Ok(Expression::Call(name, arguments));
            } else {
                self.expect(&Token::Comma)?;
            }
        }
    }
}

/// A token of an expression.
#[derive(Clone, Debug, PartialEq)]
enum Token {
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

/// The tokens of an expression, each with the number of characters before it.
fn tokens(text: &[char]) -> Result<Vec<(usize, Token)>, (usize, AdamsFault)> {
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
                let (value, end) = number_at(text, start).ok_or((start, AdamsFault::Number))?;
                k = end;
                Token::Number(value)
            }
            c if c.is_ascii_alphabetic() || c == '_' => {
                while text
                    .get(k)
                    .is_some_and(|c| c.is_ascii_alphanumeric() || *c == '_')
                {
                    k += 1;
                }
                Token::Word(
                    text[start..k]
                        .iter()
                        .collect::<String>()
                        .to_ascii_uppercase(),
                )
            }
            _ => return Err((start, AdamsFault::UnexpectedText)),
        };
        out.push((start, token));
    }
    Ok(out)
}

/// The value of the number at `start` and the index after it. `1.5D+01` has an exponent; `90D` is an angle in
/// degrees, whose value is returned in radians.
fn number_at(text: &[char], start: usize) -> Option<(f64, usize)> {
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
    if text
        .get(k)
        .is_some_and(|c| c.is_ascii_alphanumeric() || *c == '_' || *c == '.')
    {
        return None;
    }
    let value = number::read(&digits)?;
    Some((if degrees { value.to_radians() } else { value }, k))
}
