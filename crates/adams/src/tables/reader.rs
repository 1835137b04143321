//! Reader of SPLINE and UNITS statements that passes over everything else.
//!
//! It reads tokens instead of using the reader of whole data sets, so that a file with statements that this
//! crate cannot read is no obstacle to reading its tables.

use super::curves::SplineValues;
use super::spline::{Spline, Tables};
use crate::keyword::lookup;
use crate::language::lexer::{RawStatement, Token, TokenKind, statement_word, statements, tokens};
use crate::language::{AdamsForceUnit, AdamsLengthUnit, AdamsMassUnit, AdamsUnits, UnitWords};
use crate::{AdamsFault, Error, number};

/// Reads the SPLINE and UNITS statements of a data set, up to END, and passes over every other statement.
///
/// Keywords may be in upper or lower case and may be abbreviated; numbers may have D exponents. A
/// continuation line begins with a comma, which also separates the items of a list; several commas in a row
/// count as one.
///
/// # Errors
/// [`Error::At`] with line and column for text that is not a statement of these kinds, values in another file
/// (FILE=, BLOCK=, CHANNEL=), lists of unequal length, fewer than four x values, or x or z values that do not
/// increase.
///
/// # Source
/// Adams Solver reference, SPLINE and UNITS.
///
/// ```
/// let text = "influence\nSPLINE/6, X=0,20,40,60, Y=0,2.5,2.5,0, LINEAR\nEND";
/// let tables = adams::tables::read(text)?;
/// assert_eq!(tables.splines[0].curves.y()[0], [0.0, 2.5, 2.5, 0.0]);
/// assert_eq!(adams::tables::read(&adams::tables::write(&tables)?)?, tables);
/// # Ok::<(), adams::Error>(())
/// ```
pub fn read(text: &str) -> Result<Tables, Error> {
    let (title, all) = statements(text)?;
    let mut out = Tables {
        title: title.map(str::to_owned),
        units: None,
        splines: Vec::new(),
    };
    for statement in &all {
        let Some(word) = statement
            .pieces
            .first()
            .and_then(|piece| statement_word(piece.text))
        else {
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

/// Whether a word abbreviates a keyword by at least so many letters.
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

/// A list of values and the token that began it.
struct List<'a> {
    at: Token<'a>,
    values: Vec<f64>,
}

/// The arguments of a SPLINE statement.
#[derive(Default)]
struct Arguments<'a> {
    x: Option<List<'a>>,
    y: Vec<List<'a>>,
    linear: bool,
}

/// One SPLINE statement; `before` are those whose identifiers are used already.
fn spline(statement: &RawStatement<'_>, before: &[Spline]) -> Result<Spline, Error> {
    let tokens = tokens(statement)?;
    let (id, at, rest) = match tokens.as_slice() {
        [_, _, at, rest @ ..] => match at.kind {
            TokenKind::Number(text) => {
                let id = text.parse::<u32>().ok().filter(|&id| id > 0);
                (id.ok_or_else(|| at.fault(AdamsFault::Id))?, *at, rest)
            }
            _ => return Err(at.fault(AdamsFault::Id)),
        },
        [.., last] => return Err(last.fault(AdamsFault::Id)),
        [] => {
            return Err(Error::At {
                line: 1,
                column: 1,
                fault: AdamsFault::Id,
            });
        }
    };
    if before.iter().any(|spline| spline.id == id) {
        return Err(at.fault(AdamsFault::DuplicateId { id }));
    }
    let Arguments { x, y, linear } = arguments(id, rest)?;
    let x = x.ok_or_else(|| at.fault(AdamsFault::NoX { id }))?;
    let owned = |text: Option<&str>| text.map(str::to_owned);
    let curves = curves(id, at, x, &y)?;
    Ok(Spline {
        id,
        name: owned(statement.name),
        units: owned(statement.units),
        linear_extrapolate: linear,
        curves,
    })
}

/// The arguments of the SPLINE `id`, from the tokens after its identifier.
fn arguments<'a>(id: u32, mut rest: &[Token<'a>]) -> Result<Arguments<'a>, Error> {
    let mut out = Arguments::default();
    // The list that takes the next number, and whether a comma or "=" has separated it from the text before.
    let mut target = None;
    let mut separated = false;
    while let [token, after @ ..] = rest {
        rest = after;
        match token.kind {
            TokenKind::Comma => separated = true,
            _ if !separated => return Err(token.fault(AdamsFault::UnexpectedText)),
            TokenKind::Number(text) => {
                let list = match target {
                    Some(Argument::X) => out.x.as_mut(),
                    Some(Argument::Y) => out.y.last_mut(),
                    _ => None,
                };
                let list = list.ok_or_else(|| token.fault(AdamsFault::UnexpectedText))?;
                list.values
                    .push(number::read(text).ok_or_else(|| token.fault(AdamsFault::Number))?);
                separated = false;
            }
            TokenKind::Word(word) => {
                let argument =
                    lookup(ARGUMENTS, word).ok_or_else(|| token.fault(AdamsFault::Argument))?;
                match argument {
                    Argument::File => return Err(token.fault(AdamsFault::File { id })),
                    Argument::Linear if out.linear => return Err(token.fault(AdamsFault::Repeated)),
                    Argument::Linear => (out.linear, separated, target) = (true, false, None),
                    Argument::X | Argument::Y => {
                        if argument == Argument::X && out.x.is_some() {
                            return Err(token.fault(AdamsFault::Repeated));
                        }
                        let [
                            Token {
                                kind: TokenKind::Equals,
                                ..
                            },
                            after @ ..,
                        ] = rest
                        else {
                            return Err(token.fault(AdamsFault::UnexpectedText));
                        };
                        rest = after;
                        target = Some(argument);
                        let list = List {
                            at: *token,
                            values: Vec::new(),
                        };
                        if argument == Argument::X {
                            out.x = Some(list)
                        } else {
                            out.y.push(list)
                        }
                    }
                }
            }
            TokenKind::Equals | TokenKind::Slash => {
                return Err(token.fault(AdamsFault::UnexpectedText));
            }
        }
    }
    Ok(out)
}

/// The curves of a SPLINE: one list of n values is a single curve; lists of n + 1 values, z first, are a
/// family.
fn curves(id: u32, at: Token<'_>, x: List<'_>, y: &[List<'_>]) -> Result<SplineValues, Error> {
    let n = x.values.len();
    let (z, values) = match y {
        [] => return Err(at.fault(AdamsFault::NoY { id })),
        [one] if one.values.len() == n => (Vec::new(), vec![one.values.clone()]),
        _ => {
            let expected = if y.len() == 1 { n } else { n + 1 };
            for list in y {
                let found = list.values.len();
                if found != n + 1 || found < 2 {
                    return Err(list.at.fault(AdamsFault::Count {
                        id,
                        found,
                        expected,
                    }));
                }
            }
            (
                y.iter().map(|list| list.values[0]).collect(),
                y.iter().map(|list| list.values[1..].to_vec()).collect(),
            )
        }
    };
    SplineValues::new(x.values, z, values).map_err(|source| {
        at.fault(AdamsFault::Spline {
            id,
            source: Box::new(source),
        })
    })
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

const fn system(
    force: AdamsForceUnit,
    mass: AdamsMassUnit,
    length: AdamsLengthUnit,
) -> Option<AdamsUnits> {
    Some(AdamsUnits {
        force,
        mass,
        length,
    })
}

const SYSTEMS: &[(Option<AdamsUnits>, &str)] = &[
    (
        system(
            AdamsForceUnit::Newton,
            AdamsMassUnit::Kilogram,
            AdamsLengthUnit::Meter,
        ),
        "MKS",
    ),
    (
        system(
            AdamsForceUnit::Pound,
            AdamsMassUnit::Pound,
            AdamsLengthUnit::Foot,
        ),
        "FPS",
    ),
    (
        system(
            AdamsForceUnit::Pound,
            AdamsMassUnit::Pound,
            AdamsLengthUnit::Inch,
        ),
        "IPS",
    ),
    (None, "NONE"),
];

/// The units of a UNITS statement.
fn units(tokens: &[Token<'_>]) -> Result<Option<AdamsUnits>, Error> {
    let (mut force, mut mass, mut length) = (None, None, None);
    let mut rest = tokens.get(2..).unwrap_or(&[]);
    while let [first, after @ ..] = rest {
        rest = after;
        let name = match first.kind {
            TokenKind::Comma => continue,
            TokenKind::Word(name) => name,
            _ => return Err(first.fault(AdamsFault::UnexpectedText)),
        };
        let quantity = lookup(QUANTITIES, name).ok_or_else(|| first.fault(AdamsFault::Argument))?;
        let [
            Token {
                kind: TokenKind::Equals,
                ..
            },
            value,
            after @ ..,
        ] = after
        else {
            return Err(first.fault(AdamsFault::UnexpectedText));
        };
        rest = after;
        let unknown = || value.fault(AdamsFault::Unit);
        let TokenKind::Word(word) = value.kind else {
            return Err(unknown());
        };
        match quantity {
            Quantity::Force => force = Some(lookup(AdamsForceUnit::ALL, word).ok_or_else(unknown)?),
            Quantity::Mass => mass = Some(lookup(AdamsMassUnit::ALL, word).ok_or_else(unknown)?),
            Quantity::Length => {
                length = Some(lookup(AdamsLengthUnit::ALL, word).ok_or_else(unknown)?)
            }
            Quantity::Time => lookup(&[((), "SECOND")], word).ok_or_else(unknown)?,
            Quantity::System => return lookup(SYSTEMS, word).ok_or_else(unknown),
        }
    }
    match (force, mass, length, tokens.first()) {
        (Some(force), Some(mass), Some(length), _) => Ok(Some(AdamsUnits {
            force,
            mass,
            length,
        })),
        (_, _, _, Some(token)) => Err(token.fault(AdamsFault::Unit)),
        _ => Ok(None),
    }
}
