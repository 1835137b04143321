//! The arguments of one statement.

use super::flow::Flow;
use super::function;
use super::grammar::{Arguments, Form, argument};
use crate::{Argument, Error, Fault, Statement, Value, number};

/// Arguments of a statement whose table is known.
pub(super) fn known(flow: &mut Flow, table: Arguments, out: &mut Statement) -> Result<(), Error> {
    // The slash before the first argument separates as a comma does.
    let mut separated = out.id.is_none();
    loop {
        separated |= flow.separator();
        if !flow.skip() {
            return Ok(());
        }
        let start = flow.index();
        let word = flow.word().filter(|_| separated).ok_or_else(|| flow.fault(start, Fault::Text))?;
        let (form, name) = argument(table, &word).ok_or_else(|| flow.fault(start, Fault::Argument))?;
        let many = out.keyword == "SPLINE" && name == "Y";
        if !many && out.get(name).is_some() {
            return Err(flow.fault(start, Fault::Repeated));
        }
        if form != Form::Flag && !flow.eat('=') {
            return Err(flow.fault(flow.index(), Fault::Text));
        }
        let value = match form {
            Form::Flag => Value::Flag,
            Form::Word => Value::Word(item(flow)?),
            Form::Words => Value::Word(words(flow, table)?),
            Form::Whole => whole(flow)?,
            Form::Numbers => numbers(flow, false)?,
            Form::Angles => numbers(flow, true)?,
            Form::Function => function::read(flow, Some(table))?,
        };
        separated = form == Form::Function;
        out.arguments.push(Argument { name: name.to_owned(), value });
    }
}

/// Arguments of any other statement: names with what follows them, as it is written.
pub(super) fn unknown(flow: &mut Flow, out: &mut Statement) -> Result<(), Error> {
    loop {
        flow.separator();
        if !flow.skip() {
            return Ok(());
        }
        let name = flow.ahead(|flow| flow.word().map(|word| (word, flow.eat('='))));
        if let Some((word, true)) = name {
            flow.word();
            flow.eat('=');
            let name = word.to_ascii_uppercase();
            let value = if "FUNCTION".starts_with(&name) && name.len() >= 3 {
                function::read(flow, None)?
            } else {
                flow.separator();
                Value::Word(item(flow)?)
            };
            out.arguments.push(Argument { name, value });
            continue;
        }
        let text = item(flow)?;
        let goes_on = !text.starts_with(|c: char| c.is_ascii_alphabetic());
        match out.arguments.last_mut() {
            Some(Argument { value: Value::Word(list), .. }) if goes_on => {
                list.push_str(", ");
                list.push_str(&text);
            }
            _ => out.arguments.push(Argument { name: text, value: Value::Flag }),
        }
    }
}

/// Text up to a comma outside of brackets and quotes, with single blanks.
fn item(flow: &mut Flow) -> Result<String, Error> {
    flow.skip();
    let start = flow.index();
    let (mut text, mut depth, mut quoted) = (String::new(), 0_usize, false);
    while let Some(letter) = flow.peek() {
        match letter.c {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => break,
            '\\' => {
                flow.take();
                break;
            }
            _ => {}
        }
        if !(letter.c.is_ascii_graphic() || letter.c.is_whitespace()) {
            return Err(flow.fault(flow.index(), Fault::Text));
        }
        text.push(letter.c);
        flow.take();
    }
    let text = super::blanks(&text);
    if text.is_empty() || quoted { Err(flow.fault(start, Fault::Text)) } else { Ok(text) }
}

/// Items up to the next argument.
fn words(flow: &mut Flow, table: Arguments) -> Result<String, Error> {
    flow.separator();
    let mut out = item(flow)?;
    loop {
        let next = flow.ahead(|flow| {
            let comma = flow.separator();
            let end = !flow.skip();
            let named = flow.word().is_some_and(|word| flow.eat('=') || argument(table, &word).is_some());
            comma && !end && !named
        });
        if !next {
            return Ok(out);
        }
        flow.separator();
        out.push_str(", ");
        out.push_str(&item(flow)?);
    }
}

/// Letters of a number.
fn digits(flow: &mut Flow) -> String {
    flow.skip();
    flow.run(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
}

fn whole(flow: &mut Flow) -> Result<Value, Error> {
    flow.separator();
    flow.skip();
    let start = flow.index();
    let value = digits(flow).parse().ok().filter(|value: &i64| (0..=i64::from(u32::MAX)).contains(value));
    value.map(Value::Whole).ok_or_else(|| flow.fault(start, Fault::Id))
}

/// Numbers up to the next argument; a D that ends one makes it an angle in degrees.
fn numbers(flow: &mut Flow, angles: bool) -> Result<Value, Error> {
    flow.separator();
    let mut all: Vec<(f64, bool)> = Vec::new();
    loop {
        flow.skip();
        let start = flow.index();
        let text = digits(flow);
        let plain = text.strip_suffix(['d', 'D']).filter(|_| angles);
        let value = number::read(plain.unwrap_or(&text)).ok_or_else(|| flow.fault(start, Fault::Number))?;
        all.push((value, plain.is_some()));
        let next = flow.ahead(|flow| {
            let comma = flow.separator();
            let number =
                flow.skip() && flow.peek().is_some_and(|l| l.c.is_ascii_digit() || "+-.".contains(l.c));
            comma && number
        });
        if !next {
            break;
        }
        flow.separator();
    }
    let degrees = all.iter().any(|(_, degrees)| *degrees);
    if degrees && all.iter().all(|(value, degrees)| *degrees || *value == 0.0) {
        return Ok(Value::Degrees(all.into_iter().map(|(value, _)| value).collect()));
    }
    let radians = |(value, degrees): (f64, bool)| if degrees { value.to_radians() } else { value };
    Ok(Value::Numbers(all.into_iter().map(radians).collect()))
}
