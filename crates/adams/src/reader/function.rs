//! Function expressions within statements.

use super::flow::Flow;
use super::grammar::{Arguments, Form, argument};
use crate::{Error, Value, expression};

/// An expression up to `\`, the end, or a comma and another argument of the statement.
pub(super) fn read(flow: &mut Flow, table: Option<Arguments>) -> Result<Value, Error> {
    let start = flow.index();
    let mut text: Vec<char> = Vec::new();
    let mut places: Vec<usize> = Vec::new();
    let (mut depth, mut blank) = (0_usize, false);
    while let Some(letter) = flow.peek() {
        match letter.c {
            '\\' => {
                flow.take();
                break;
            }
            ',' if depth == 0 && flow.ahead(|flow| names(flow, table)) => break,
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        let at = flow.index();
        flow.take();
        if letter.lead || letter.c.is_whitespace() {
            blank = true;
            continue;
        }
        // A blank stays where it keeps two names or numbers apart, which the parser will refuse.
        if blank && joins(letter.c) && text.last().is_some_and(|c| joins(*c)) {
            text.push(' ');
            places.push(at);
        }
        blank = false;
        text.push(letter.c);
        places.push(at);
    }
    let text: String = text.into_iter().collect();
    expression::parse(&text).map_err(|(offset, fault)| {
        let at = places.get(offset).copied().unwrap_or_else(|| places.last().map_or(start, |at| at + 1));
        flow.fault(at, fault)
    })?;
    Ok(Value::Function(text))
}

fn joins(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '.'
}

/// Whether commas and another argument come next: its name with `=`, or in full if it is a flag.
fn names(flow: &mut Flow, table: Option<Arguments>) -> bool {
    flow.separator();
    let Some(word) = flow.word() else { return false };
    if flow.eat('=') {
        return true;
    }
    let end = !flow.skip() || flow.peek().is_some_and(|letter| letter.c == ',');
    let flag = |table| {
        argument(table, &word).is_some_and(|found| found.0 == Form::Flag && found.1.len() == word.len())
    };
    end && table.is_some_and(flag)
}
