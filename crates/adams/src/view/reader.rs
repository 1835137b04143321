//! Reader of tables in Adams View commands.

use super::lexer::{Command, CommandToken, CommandTokenKind, commands};
use super::units::{FORCES, LENGTHS, MASSES, TIMES, unit};
use super::writer::default_name;
use crate::keyword::lookup;
use crate::language::{AdamsForceUnit, AdamsLengthUnit, AdamsMassUnit, AdamsUnits};
use crate::tables::{Spline, SplineValues, Tables};
use crate::{AdamsFault, Error, number};

/// A spline that a later command modifies. Its values are not those with which it was created, and the modified ones
/// are often expressions, so that it is left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModifiedSpline {
    /// Its identifier; `None` if no command of the text creates it.
    pub id: Option<u32>,
    /// Its name as the command states it, without the model.
    pub name: String,
    /// Line of the command that modifies it.
    pub line: usize,
}

/// Reads the commands `data_element create spline` and `defaults units`, and passes over every other command.
///
/// See [`read_with_modified`]; a text in which a command modifies a spline is refused.
///
/// # Errors
/// As [`read_with_modified`], and [`AdamsFault::Changed`] for a spline that a later command modifies.
pub fn read(text: &str) -> Result<Tables, Error> {
    let (tables, modified) = read_with_modified(text)?;
    match modified.first() {
        Some(first) => Err(Error::At {
            line: first.line,
            column: 1,
            fault: AdamsFault::Changed,
        }),
        None => Ok(tables),
    }
}

/// Reads the commands `data_element create spline` and `defaults units`, and passes over every other command.
///
/// The values of a family are listed curve after curve, x fastest. A spline without `adams_id` gets the next
/// free identifier, as in Adams View; a spline with the default name of its identifier has no name. The title
/// is the name of the model. The splines that a later command `data_element modify spline` names are left out and
/// returned beside the tables.
///
/// # Errors
/// [`Error::At`] with line and column for the same faults as [`crate::tables::read`], and for values that are
/// expressions or come from a file or result set; [`AdamsFault::Changed`] for a command that modifies a spline without
/// naming it, and if every spline of the text is left out.
///
/// # Source
/// Adams View command help, `data_element create spline` and `defaults units`.
pub fn read_with_modified(text: &str) -> Result<(Tables, Vec<ModifiedSpline>), Error> {
    let mut out = Tables {
        title: None,
        units: None,
        splines: Vec::new(),
    };
    // Splines without an identifier.
    let mut free = Vec::new();
    let mut units = DefaultUnits::default();
    let mut modified: Vec<ModifiedSpline> = Vec::new();
    for command in &commands(text) {
        if command.starts(&[("data_element", 4), ("create", 2), ("spline", 3)]) {
            let (spline, model, numbered) = spline(command, &out.splines)?;
            out.title = out.title.or(model);
            if !numbered {
                free.push(out.splines.len());
            }
            out.splines.push(spline);
        } else if command.starts(&[("data_element", 4), ("modify", 2), ("spline", 3)]) {
            let values = command.first_values();
            let named = values
                .iter()
                .find(|(key, _)| lookup(KEYS, key) == Some(Key::Name));
            let name = named
                .and_then(|(_, value)| value.rsplit('.').next())
                .filter(|name| !name.is_empty());
            let Some(name) = name else {
                return Err(Error::At {
                    line: command.line(),
                    column: 1,
                    fault: AdamsFault::Changed,
                });
            };
            modified.push(ModifiedSpline {
                id: None,
                name: name.to_owned(),
                line: command.line(),
            });
        } else if command.starts(&[("defaults", 3), ("units", 4)]) {
            units.take(command)?;
        }
    }
    for k in free {
        let last = out
            .splines
            .iter()
            .map(|spline| spline.id)
            .max()
            .unwrap_or(0);
        out.splines[k].id = last.saturating_add(1);
    }
    modified.dedup_by(|later, first| later.name.eq_ignore_ascii_case(&first.name));
    for change in &mut modified {
        let is_meant = |spline: &Spline| {
            let own = spline
                .name
                .clone()
                .unwrap_or_else(|| default_name(spline.id));
            own.eq_ignore_ascii_case(&change.name)
        };
        change.id = out
            .splines
            .iter()
            .find(|spline| is_meant(spline))
            .map(|spline| spline.id);
        out.splines.retain(|spline| !is_meant(spline));
    }
    if let Some(first) = modified.first().filter(|_| out.splines.is_empty()) {
        return Err(Error::At {
            line: first.line,
            column: 1,
            fault: AdamsFault::Changed,
        });
    }
    for spline in &mut out.splines {
        spline.name = spline
            .name
            .take()
            .filter(|name| *name != default_name(spline.id));
    }
    out.units = units.units();
    Ok((out, modified))
}

/// One `key = values` of a command.
struct Entry<'a> {
    key: CommandToken<'a>,
    word: &'a str,
    values: Vec<CommandToken<'a>>,
}

/// The entries of a command after `skip` words.
fn entries<'a>(command: &Command<'a>, skip: usize) -> Result<Vec<Entry<'a>>, Error> {
    let tokens = command.tokens()?;
    let mut all: Vec<Entry<'a>> = Vec::new();
    let mut rest = tokens.get(skip..).unwrap_or(&[]);
    let mut separated = true;
    while let [token, after @ ..] = rest {
        rest = after;
        match (token.kind, after) {
            (
                CommandTokenKind::Word(word),
                [
                    CommandToken {
                        kind: CommandTokenKind::Equals,
                        ..
                    },
                    after @ ..,
                ],
            ) => {
                rest = after;
                all.push(Entry {
                    key: *token,
                    word,
                    values: Vec::new(),
                });
                separated = true;
            }
            (CommandTokenKind::Word(_) | CommandTokenKind::Quoted(_), _)
                if separated && !all.is_empty() =>
            {
                all.last_mut()
                    .into_iter()
                    .for_each(|last| last.values.push(*token));
                separated = false;
            }
            (CommandTokenKind::Comma, _) if !all.is_empty() => separated = true,
            _ => return Err(token.fault(AdamsFault::UnexpectedText)),
        }
    }
    Ok(all)
}

#[derive(Clone, Copy, PartialEq)]
enum Key {
    Name,
    Id,
    X,
    Y,
    Z,
    Linear,
    Units,
    File,
    Other,
}

const KEYS: &[(Key, &str)] = &[
    (Key::Name, "spline_name"),
    (Key::Id, "adams_id"),
    (Key::X, "x"),
    (Key::Y, "y"),
    (Key::Z, "z"),
    (Key::Linear, "linear_extrapolate"),
    (Key::Units, "units"),
    (Key::File, "file_name"),
    (Key::File, "x_result_set_component_name"),
    (Key::File, "y_result_set_component_name"),
    (Key::File, "z_result_set_component_name"),
    (Key::File, "block_name"),
    (Key::File, "channel"),
    (Key::Other, "comments"),
    (Key::Other, "x_units"),
    (Key::Other, "y_units"),
    (Key::Other, "z_units"),
];

const ANSWERS: &[(bool, &str)] = &[
    (true, "yes"),
    (false, "no"),
    (true, "true"),
    (false, "false"),
];

/// The spline of a command, the name of its model, and whether it has an identifier.
fn spline(
    command: &Command<'_>,
    before: &[Spline],
) -> Result<(Spline, Option<String>, bool), Error> {
    let entries = entries(command, 3)?;
    let mut seen = Vec::new();
    for entry in &entries {
        let key = lookup(KEYS, entry.word).ok_or_else(|| entry.key.fault(AdamsFault::Argument))?;
        if key != Key::Other && seen.iter().any(|(one, _)| *one == key) {
            return Err(entry.key.fault(AdamsFault::Repeated));
        }
        seen.push((key, entry));
    }
    let find = |key: Key| {
        seen.iter()
            .find(|(one, _)| *one == key)
            .map(|(_, entry)| *entry)
    };
    let at = match command.tokens()?.first() {
        Some(token) => *token,
        None => {
            return Err(Error::At {
                line: 1,
                column: 1,
                fault: AdamsFault::UnexpectedText,
            });
        }
    };
    let (id, numbered) = match find(Key::Id) {
        None => (0, false),
        Some(entry) => {
            let id = one(entry)?.0.parse::<u32>().ok().filter(|&id| id > 0);
            (id.ok_or_else(|| entry.key.fault(AdamsFault::Id))?, true)
        }
    };
    if let Some(entry) = find(Key::File) {
        return Err(entry.key.fault(AdamsFault::File { id }));
    }
    if numbered && before.iter().any(|spline| spline.id == id) {
        return Err(at.fault(AdamsFault::DuplicateId { id }));
    }
    let (name, model) = match find(Key::Name) {
        None => (None, None),
        Some(entry) => {
            let full = one(entry)?.0;
            let parts: Vec<&str> = full.split('.').filter(|part| !part.is_empty()).collect();
            let model = parts
                .first()
                .filter(|_| parts.len() > 1)
                .map(|part| (*part).to_owned());
            (parts.last().map(|part| (*part).to_owned()), model)
        }
    };
    let linear = match find(Key::Linear) {
        None => false,
        Some(entry) => {
            let (word, token) = one(entry)?;
            lookup(ANSWERS, word).ok_or_else(|| token.fault(AdamsFault::UnexpectedText))?
        }
    };
    let units = find(Key::Units)
        .map(one)
        .transpose()?
        .map(|(word, _)| word.to_owned());
    let x = find(Key::X).ok_or_else(|| at.fault(AdamsFault::NoX { id }))?;
    let y = find(Key::Y).ok_or_else(|| at.fault(AdamsFault::NoY { id }))?;
    let z = find(Key::Z).map(numbers).transpose()?.unwrap_or_default();
    let curves = curves(id, at, numbers(x)?, z, (y.key, numbers(y)?))?;
    Ok((
        Spline {
            id,
            name,
            units,
            linear_extrapolate: linear,
            curves,
        },
        model,
        numbered,
    ))
}

/// The value of an entry that has exactly one.
fn one<'a>(entry: &Entry<'a>) -> Result<(&'a str, CommandToken<'a>), Error> {
    match entry.values.as_slice() {
        [token] => match token.kind {
            CommandTokenKind::Word(word) | CommandTokenKind::Quoted(word) => Ok((word, *token)),
            _ => Err(token.fault(AdamsFault::UnexpectedText)),
        },
        [_, second, ..] => Err(second.fault(AdamsFault::UnexpectedText)),
        [] => Err(entry.key.fault(AdamsFault::UnexpectedText)),
    }
}

/// The values of an entry as numbers.
fn numbers(entry: &Entry<'_>) -> Result<Vec<f64>, Error> {
    let read = |token: &CommandToken<'_>| match token.kind {
        CommandTokenKind::Word(text) => {
            number::read(text).ok_or_else(|| token.fault(AdamsFault::Number))
        }
        _ => Err(token.fault(AdamsFault::Number)),
    };
    entry.values.iter().map(read).collect()
}

/// The curves of a spline from its x, z and concatenated y values.
fn curves(
    id: u32,
    at: CommandToken<'_>,
    x: Vec<f64>,
    z: Vec<f64>,
    (key, y): (CommandToken<'_>, Vec<f64>),
) -> Result<SplineValues, Error> {
    let expected = x.len().saturating_mul(z.len().max(1));
    if y.len() != expected || x.is_empty() {
        return Err(key.fault(AdamsFault::Count {
            id,
            found: y.len(),
            expected,
        }));
    }
    let rows = y.chunks(x.len()).map(<[f64]>::to_vec).collect();
    SplineValues::new(x, z, rows).map_err(|source| {
        at.fault(AdamsFault::Spline {
            id,
            source: Box::new(source),
        })
    })
}

/// The units of all `defaults units` commands so far; a later command replaces the units it names.
#[derive(Default)]
struct DefaultUnits {
    force: Option<AdamsForceUnit>,
    mass: Option<AdamsMassUnit>,
    length: Option<AdamsLengthUnit>,
}

impl DefaultUnits {
    fn take(&mut self, command: &Command<'_>) -> Result<(), Error> {
        for entry in entries(command, 2)? {
            let key = entry.word.to_ascii_lowercase();
            if !matches!(key.as_str(), "length" | "force" | "mass" | "time") {
                continue;
            }
            let (word, token) = one(&entry)?;
            let unknown = || token.fault(AdamsFault::Unit);
            match key.as_str() {
                "length" => self.length = Some(unit(LENGTHS, word).ok_or_else(unknown)?),
                "force" => self.force = Some(unit(FORCES, word).ok_or_else(unknown)?),
                "mass" => self.mass = Some(unit(MASSES, word).ok_or_else(unknown)?),
                _ => unit(TIMES, word).ok_or_else(unknown)?,
            }
        }
        Ok(())
    }

    /// The units, if force and length are given. A missing unit of mass becomes the kilogram, since tables
    /// have no mass.
    fn units(&self) -> Option<AdamsUnits> {
        let (force, length) = self.force.zip(self.length)?;
        Some(AdamsUnits {
            force,
            mass: self.mass.unwrap_or(AdamsMassUnit::Kilogram),
            length,
        })
    }
}
