//! Text to data set.

use super::{Spline, Tables};
use crate::lexer::{Statement, Token, TokenKind, statements, tokens};
use crate::units::{Force, Keyword, Length, Mass, Units, lookup};
use crate::{Curves, Error, Fault, number};

/// Reads the SPLINE and UNITS statements of a data set, up to END; every other statement is passed over.
///
/// Keywords may be abbreviated, in any case; numbers may have D exponents. Continuation lines begin with a
/// comma, which in a list also separates; several commas count as one.
///
/// # Errors
/// [`Error::At`] with line and column: text that is no statement of these kinds, values kept in another
/// file (FILE=, BLOCK=, CHANNEL=), lists that do not fit, fewer than four x, x or z not increasing.
///
/// # Source
/// Adams Solver reference, SPLINE and UNITS.
pub fn read(text: &str) -> Result<Tables, Error> {
    let (title, all) = statements(text)?;
    let mut out = Tables { title: title.map(str::to_owned), units: None, splines: Vec::new() };
    for statement in &all {
        let Some(word) = statement.pieces.first().and_then(|piece| crate::lexer::head(piece.text)) else {
            continue;
        };
        if abbreviates(word, "SPLINE", 3) {
            let spline = spline(statement, &out.splines)?;
            out.splines.push(spline);
        } else if abbreviates(word, "UNITS", 2) {
            out.units = units(&tokens(statement)?)?;
        }
    }
    Ok(out)
}

fn abbreviates(word: &str, full: &str, least: usize) -> bool {
    word.len() >= least && lookup(&[((), full)], word).is_some()
}

#[derive(Clone, Copy, PartialEq)]
enum Argument {
    X,
    Y,
    Linear,
    File,
}

const ARGUMENTS: &[(Argument, &str)] = &[
    (Argument::X, "X"),
    (Argument::Y, "Y"),
    (Argument::Linear, "LINEAR_EXTRAPOLATE"),
    (Argument::File, "FILE"),
    (Argument::File, "BLOCK"),
    (Argument::File, "CHANNEL"),
];

/// A list of values and where it began.
struct List<'a> {
    at: Token<'a>,
    values: Vec<f64>,
}

fn spline(statement: &Statement<'_>, before: &[Spline]) -> Result<Spline, Error> {
    let tokens = tokens(statement)?;
    let (id, at, mut rest) = match tokens.as_slice() {
        [_, _, at, rest @ ..] => match at.kind {
            TokenKind::Number(text) => {
                let id = text.parse::<u32>().ok().filter(|&id| id > 0);
                (id.ok_or_else(|| at.fault(Fault::Id))?, *at, rest)
            }
            _ => return Err(at.fault(Fault::Id)),
        },
        [.., last] => return Err(last.fault(Fault::Id)),
        [] => return Err(Error::At { line: 1, column: 1, fault: Fault::Id }),
    };
    if before.iter().any(|spline| spline.id == id) {
        return Err(at.fault(Fault::Twice { id }));
    }
    let mut x: Option<List<'_>> = None;
    let mut y: Vec<List<'_>> = Vec::new();
    let mut linear = false;
    // Into which list numbers go, and whether a comma or "=" stood before.
    let mut target = None;
    let mut separated = false;
    while let [token, after @ ..] = rest {
        rest = after;
        match token.kind {
            TokenKind::Comma => separated = true,
            _ if !separated => return Err(token.fault(Fault::Text)),
            TokenKind::Number(text) => {
                let list = match target {
                    Some(Argument::X) => x.as_mut(),
                    Some(Argument::Y) => y.last_mut(),
                    _ => None,
                };
                let list = list.ok_or_else(|| token.fault(Fault::Text))?;
                list.values.push(number::read(text).ok_or_else(|| token.fault(Fault::Number))?);
                separated = false;
            }
            TokenKind::Word(word) => {
                let argument = lookup(ARGUMENTS, word).ok_or_else(|| token.fault(Fault::Argument))?;
                match argument {
                    Argument::File => return Err(token.fault(Fault::File { id })),
                    Argument::Linear if linear => return Err(token.fault(Fault::Repeated)),
                    Argument::Linear => (linear, separated, target) = (true, false, None),
                    Argument::X | Argument::Y => {
                        if argument == Argument::X && x.is_some() {
                            return Err(token.fault(Fault::Repeated));
                        }
                        let [Token { kind: TokenKind::Equals, .. }, after @ ..] = rest else {
                            return Err(token.fault(Fault::Text));
                        };
                        rest = after;
                        target = Some(argument);
                        let list = List { at: *token, values: Vec::new() };
                        if argument == Argument::X { x = Some(list) } else { y.push(list) }
                    }
                }
            }
            TokenKind::Equals | TokenKind::Slash => return Err(token.fault(Fault::Text)),
        }
    }
    let x = x.ok_or_else(|| at.fault(Fault::NoX { id }))?;
    let owned = |text: Option<&str>| text.map(str::to_owned);
    let curves = curves(id, at, x, &y)?;
    Ok(Spline { id, name: owned(statement.name), units: owned(statement.units), linear, curves })
}

/// One list of n values is a curve; lists of n + 1, z first, are a family.
fn curves(id: u32, at: Token<'_>, x: List<'_>, y: &[List<'_>]) -> Result<Curves, Error> {
    let n = x.values.len();
    let (z, values) = match y {
        [] => return Err(at.fault(Fault::NoY { id })),
        [one] if one.values.len() == n => (Vec::new(), vec![one.values.clone()]),
        _ => {
            let expected = if y.len() == 1 { n } else { n + 1 };
            for list in y {
                let found = list.values.len();
                if found != n + 1 || found < 2 {
                    return Err(list.at.fault(Fault::Count { id, found, expected }));
                }
            }
            (
                y.iter().map(|list| list.values[0]).collect(),
                y.iter().map(|list| list.values[1..].to_vec()).collect(),
            )
        }
    };
    Curves::new(x.values, z, values)
        .map_err(|source| at.fault(Fault::Spline { id, source: Box::new(source) }))
}

#[derive(Clone, Copy)]
enum Quantity {
    Force,
    Mass,
    Length,
    Time,
    System,
}

const QUANTITIES: &[(Quantity, &str)] = &[
    (Quantity::Force, "FORCE"),
    (Quantity::Mass, "MASS"),
    (Quantity::Length, "LENGTH"),
    (Quantity::Time, "TIME"),
    (Quantity::System, "SYSTEM"),
];

const fn system(force: Force, mass: Mass, length: Length) -> Option<Units> {
    Some(Units { force, mass, length })
}

const SYSTEMS: &[(Option<Units>, &str)] = &[
    (system(Force::Newton, Mass::Kilogram, Length::Meter), "MKS"),
    (system(Force::Pound, Mass::Pound, Length::Foot), "FPS"),
    (system(Force::Pound, Mass::Pound, Length::Inch), "IPS"),
    (None, "NONE"),
];

fn units(tokens: &[Token<'_>]) -> Result<Option<Units>, Error> {
    let (mut force, mut mass, mut length) = (None, None, None);
    let mut rest = tokens.get(2..).unwrap_or(&[]);
    while let [first, after @ ..] = rest {
        rest = after;
        let name = match first.kind {
            TokenKind::Comma => continue,
            TokenKind::Word(name) => name,
            _ => return Err(first.fault(Fault::Text)),
        };
        let quantity = lookup(QUANTITIES, name).ok_or_else(|| first.fault(Fault::Argument))?;
        let [Token { kind: TokenKind::Equals, .. }, value, after @ ..] = after else {
            return Err(first.fault(Fault::Text));
        };
        rest = after;
        let unknown = || value.fault(Fault::Unit);
        let TokenKind::Word(word) = value.kind else { return Err(unknown()) };
        match quantity {
            Quantity::Force => force = Some(lookup(Force::ALL, word).ok_or_else(unknown)?),
            Quantity::Mass => mass = Some(lookup(Mass::ALL, word).ok_or_else(unknown)?),
            Quantity::Length => length = Some(lookup(Length::ALL, word).ok_or_else(unknown)?),
            Quantity::Time => lookup(&[((), "SECOND")], word).ok_or_else(unknown)?,
            Quantity::System => return lookup(SYSTEMS, word).ok_or_else(unknown),
        }
    }
    match (force, mass, length, tokens.first()) {
        (Some(force), Some(mass), Some(length), _) => Ok(Some(Units { force, mass, length })),
        (_, _, _, Some(token)) => Err(token.fault(Fault::Unit)),
        _ => Ok(None),
    }
}
