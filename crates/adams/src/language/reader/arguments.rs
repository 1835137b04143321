//! The arguments of one statement, in each form of value.

use super::cursor::{Cursor, single_blanks};
use super::grammar::{Arguments, Form, argument};
use crate::language::statement::{ArgumentValue, Statement, StatementArgument};
use crate::{AdamsFault, Error, expression, number};

/// Reads the arguments of a statement by the table of its kind.
pub(super) fn known(
    cursor: &mut Cursor,
    table: Arguments,
    out: &mut Statement,
) -> Result<(), Error> {
    // Without an identifier the slash before the first argument separates as a comma does.
    let mut separated = out.id.is_none();
    loop {
        separated |= cursor.separator();
        if !cursor.skip() {
            return Ok(());
        }
        let start = cursor.index();
        let word = cursor
            .word()
            .filter(|_| separated)
            .ok_or_else(|| cursor.fault(start, AdamsFault::UnexpectedText))?;
        let (form, name) =
            argument(table, &word).ok_or_else(|| cursor.fault(start, AdamsFault::Argument))?;
        let many = out.keyword == "SPLINE" && name == "Y";
        if !many && out.get(name).is_some() {
            return Err(cursor.fault(start, AdamsFault::Repeated));
        }
        if form != Form::Flag && !cursor.eat('=') {
            return Err(cursor.fault(cursor.index(), AdamsFault::UnexpectedText));
        }
        let value = match form {
            Form::Flag => ArgumentValue::Flag,
            Form::Word => ArgumentValue::Word(item(cursor)?),
            Form::Words => ArgumentValue::Word(words(cursor, table)?),
            Form::Whole => whole(cursor)?,
            Form::Numbers => numbers(cursor, false)?,
            Form::Angles => numbers(cursor, true)?,
            Form::Function => function(cursor, Some(table))?,
        };
        separated = form == Form::Function;
        out.arguments.push(StatementArgument {
            name: name.to_owned(),
            value,
        });
    }
}

/// Reads the arguments of any other statement: names with the text after them, as it is written.
pub(super) fn unknown(cursor: &mut Cursor, out: &mut Statement) -> Result<(), Error> {
    loop {
        cursor.separator();
        if !cursor.skip() {
            return Ok(());
        }
        let name = cursor.ahead(|cursor| cursor.word().map(|word| (word, cursor.eat('='))));
        if let Some((word, true)) = name {
            cursor.word();
            cursor.eat('=');
            let name = word.to_ascii_uppercase();
            let value = if "FUNCTION".starts_with(&name) && name.len() >= 3 {
                function(cursor, None)?
            } else {
                cursor.separator();
                ArgumentValue::Word(item(cursor)?)
            };
            out.arguments.push(StatementArgument { name, value });
            continue;
        }
        let text = item(cursor)?;
        let goes_on = !text.starts_with(|c: char| c.is_ascii_alphabetic());
        match out.arguments.last_mut() {
            Some(StatementArgument {
                value: ArgumentValue::Word(list),
                ..
            }) if goes_on => {
                list.push_str(", ");
                list.push_str(&text);
            }
            _ => out.arguments.push(StatementArgument {
                name: text,
                value: ArgumentValue::Flag,
            }),
        }
    }
}

/// Reads text up to a comma outside brackets and quotes, and reduces its blanks to single ones.
fn item(cursor: &mut Cursor) -> Result<String, Error> {
    cursor.skip();
    let start = cursor.index();
    let (mut text, mut depth, mut quoted) = (String::new(), 0_usize, false);
    while let Some(character) = cursor.peek() {
        match character.c {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => break,
            '\\' => {
                cursor.take();
                break;
            }
            _ => {}
        }
        if !(character.c.is_ascii_graphic() || character.c.is_whitespace()) {
            return Err(cursor.fault(cursor.index(), AdamsFault::UnexpectedText));
        }
        text.push(character.c);
        cursor.take();
    }
    let text = single_blanks(&text);
    if text.is_empty() || quoted {
        Err(cursor.fault(start, AdamsFault::UnexpectedText))
    } else {
        Ok(text)
    }
}

/// Reads items up to the next argument.
fn words(cursor: &mut Cursor, table: Arguments) -> Result<String, Error> {
    cursor.separator();
    let mut out = item(cursor)?;
    loop {
        let next = cursor.ahead(|cursor| {
            let comma = cursor.separator();
            let end = !cursor.skip();
            let named = cursor
                .word()
                .is_some_and(|word| cursor.eat('=') || argument(table, &word).is_some());
            comma && !end && !named
        });
        if !next {
            return Ok(out);
        }
        cursor.separator();
        out.push_str(", ");
        out.push_str(&item(cursor)?);
    }
}

/// Reads the characters of a number.
fn digits(cursor: &mut Cursor) -> String {
    cursor.skip();
    cursor.run(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
}

/// Reads an identifier or count.
fn whole(cursor: &mut Cursor) -> Result<ArgumentValue, Error> {
    cursor.separator();
    cursor.skip();
    let start = cursor.index();
    let value = digits(cursor)
        .parse()
        .ok()
        .filter(|value: &i64| (0..=i64::from(u32::MAX)).contains(value));
    value
        .map(ArgumentValue::Whole)
        .ok_or_else(|| cursor.fault(start, AdamsFault::Id))
}

/// Reads numbers up to the next argument. With `angles` a number that ends with D is an angle in degrees; a
/// list that mixes degrees and radians is converted to radians.
fn numbers(cursor: &mut Cursor, angles: bool) -> Result<ArgumentValue, Error> {
    cursor.separator();
    let mut all: Vec<(f64, bool)> = Vec::new();
    loop {
        cursor.skip();
        let start = cursor.index();
        let text = digits(cursor);
        let plain = text.strip_suffix(['d', 'D']).filter(|_| angles);
        let value = number::read(plain.unwrap_or(&text))
            .ok_or_else(|| cursor.fault(start, AdamsFault::Number))?;
        all.push((value, plain.is_some()));
        let next = cursor.ahead(|cursor| {
            let comma = cursor.separator();
            let number = cursor.skip()
                && cursor
                    .peek()
                    .is_some_and(|l| l.c.is_ascii_digit() || "+-.".contains(l.c));
            comma && number
        });
        if !next {
            break;
        }
        cursor.separator();
    }
    let degrees = all.iter().any(|(_, degrees)| *degrees);
    if degrees && all.iter().all(|(value, degrees)| *degrees || *value == 0.0) {
        return Ok(ArgumentValue::Degrees(
            all.into_iter().map(|(value, _)| value).collect(),
        ));
    }
    let radians = |(value, degrees): (f64, bool)| if degrees { value.to_radians() } else { value };
    Ok(ArgumentValue::Numbers(
        all.into_iter().map(radians).collect(),
    ))
}

/// Reads an expression up to `\`, the end of the statement, or a comma and another argument.
///
/// Blanks and the commas that begin continued lines are removed. The expression must parse.
fn function(cursor: &mut Cursor, table: Option<Arguments>) -> Result<ArgumentValue, Error> {
    let start = cursor.index();
    let mut text: Vec<char> = Vec::new();
    let mut places: Vec<usize> = Vec::new();
    let (mut depth, mut blank) = (0_usize, false);
    while let Some(character) = cursor.peek() {
        match character.c {
            '\\' => {
                cursor.take();
                break;
            }
            ',' if depth == 0 && cursor.ahead(|cursor| argument_follows(cursor, table)) => break,
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        let at = cursor.index();
        cursor.take();
        if character.lead || character.c.is_whitespace() {
            blank = true;
            continue;
        }
        // A blank between two names or numbers stays, so that the parser refuses them instead of joining
        // them.
        if blank && joins(character.c) && text.last().is_some_and(|c| joins(*c)) {
            text.push(' ');
            places.push(at);
        }
        blank = false;
        text.push(character.c);
        places.push(at);
    }
    let text: String = text.into_iter().collect();
    expression::parse(&text).map_err(|(offset, fault)| {
        let at = places
            .get(offset)
            .copied()
            .unwrap_or_else(|| places.last().map_or(start, |at| at + 1));
        cursor.fault(at, fault)
    })?;
    Ok(ArgumentValue::Function(text))
}

/// Whether a character belongs to a name or number.
fn joins(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '.'
}

/// Whether a comma and another argument of the statement come next: a name with `=`, or the full name of an
/// argument without value.
fn argument_follows(cursor: &mut Cursor, table: Option<Arguments>) -> bool {
    cursor.separator();
    let Some(word) = cursor.word() else {
        return false;
    };
    if cursor.eat('=') {
        return true;
    }
    let end = !cursor.skip() || cursor.peek().is_some_and(|character| character.c == ',');
    let flag = |table| {
        argument(table, &word)
            .is_some_and(|found| found.0 == Form::Flag && found.1.len() == word.len())
    };
    end && table.is_some_and(flag)
}
