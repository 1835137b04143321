//! Tokens of an expression to a tree.

use super::token::{Token, tokens};
use super::{Expression, Factor, Name, Sign};
use crate::Fault;

/// Brackets, signs and powers within each other.
const DEEPEST: usize = 100;

/// Reads a function expression.
///
/// `**` binds from the right and before a sign (`-A**2` is `-(A**2)`), then `*` and `/`, then `+` and `-`.
/// Numbers may have E or D exponents; a D with no digits after it makes an angle in degrees, so `90D` is pi/2
/// and `90D+5` is 90e5, as Fortran has it.
///
/// # Errors
/// What cannot stand there, with the number of characters before it.
pub fn parse(text: &str) -> Result<Expression, (usize, Fault)> {
    let letters: Vec<char> = text.chars().collect();
    let tokens = tokens(&letters)?;
    let mut parser = Parser { tokens: &tokens, next: 0, end: letters.len(), depth: 0 };
    let out = parser.sum()?;
    match parser.peek() {
        None => Ok(out),
        Some(_) => Err((parser.offset(), Fault::Text)),
    }
}

struct Parser<'a> {
    tokens: &'a [(usize, Token)],
    next: usize,
    end: usize,
    depth: usize,
}

type Parsed = Result<Expression, (usize, Fault)>;

impl Parser<'_> {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next).map(|(_, token)| token)
    }

    fn offset(&self) -> usize {
        self.tokens.get(self.next).map_or(self.end, |(offset, _)| *offset)
    }

    fn take(&mut self, token: &Token) -> bool {
        let found = self.peek() == Some(token);
        self.next += usize::from(found);
        found
    }

    fn expect(&mut self, token: &Token) -> Result<(), (usize, Fault)> {
        if self.take(token) { Ok(()) } else { Err((self.offset(), Fault::Text)) }
    }

    /// One level deeper.
    fn within(&mut self, part: impl FnOnce(&mut Self) -> Parsed) -> Parsed {
        if self.depth == DEEPEST {
            return Err((self.offset(), Fault::Deep));
        }
        self.depth += 1;
        let out = part(self);
        self.depth -= 1;
        out
    }

    fn sign(&mut self) -> Option<Sign> {
        if self.take(&Token::Plus) {
            Some(Sign::Plus)
        } else if self.take(&Token::Minus) {
            Some(Sign::Minus)
        } else {
            None
        }
    }

    fn sum(&mut self) -> Parsed {
        let first = self.sign();
        let mut terms = vec![(first.unwrap_or(Sign::Plus), self.product()?)];
        while let Some(sign) = self.sign() {
            terms.push((sign, self.product()?));
        }
        if let [(Sign::Plus, _)] = terms.as_slice()
            && let Some((_, only)) = terms.pop()
        {
            return Ok(only);
        }
        Ok(Expression::Sum(terms))
    }

    fn product(&mut self) -> Parsed {
        let mut factors = vec![(Factor::Times, self.signed()?)];
        loop {
            let factor = if self.take(&Token::Times) {
                Factor::Times
            } else if self.take(&Token::Over) {
                Factor::Over
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

    /// A power, or one with a sign, as in `A*-B`.
    fn signed(&mut self) -> Parsed {
        match self.sign() {
            Some(sign) => {
                let inner = self.within(Parser::signed)?;
                Ok(if sign == Sign::Plus { inner } else { Expression::Sum(vec![(sign, inner)]) })
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
                let name = Name { word, offset };
                if self.take(&Token::Open) { self.call(name) } else { Ok(Expression::Name(name)) }
            }
            _ => Err((offset, Fault::Text)),
        }
    }

    fn call(&mut self, name: Name) -> Parsed {
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
