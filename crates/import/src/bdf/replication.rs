//! Replication: lines that repeat the fields of the line before them, with increments.
//!
//! `=` is the same field of the line before, `==` all of its fields from here on, `*(x)` its value plus x. A line that
//! begins with `=` is one such copy, with `=(n)` there are n of them, in which increments add up; `%(x)` is an increment
//! with which the last copy has the value x. `=(n)` alone goes on with the increments of the line before. The
//! parentheses may be left out. A marker of a continuation such as `+A-1` is counted up in each copy; any other is left out.
//!
//! Copies of a continuation line belong to copies of its card, so that their markers must be counted up.
//!
//! # Source
//! NASTRAN user's manual (NASA), section 2.4.1.2, free-field input; NASTRAN quick reference guides, replication.

use super::divide::{CardField, LineFields};
use super::field::{Number, number};
use crate::findings::ImportFinding;

/// Largest number of lines that replication makes of a deck. A larger number indicates a mistake in a count.
const MOST_COPIES: u64 = 200_000;

/// What a copy does with a field of the line before.
#[derive(Clone, Debug, PartialEq)]
enum Change {
    /// It has the same value.
    Same,
    /// Its value is increased by a number of the same type.
    Add(Number),
    /// It has another text.
    Text(String),
}

/// The state of replication from line to line.
#[derive(Debug, Default)]
pub(super) struct Replication {
    /// The line before.
    before: Option<LineFields>,
    /// The changes by which the line before was made of the one before it.
    changes: Option<Vec<Change>>,
    copies: u64,
}

impl Replication {
    /// The lines for which a line stands: itself, or copies of the line before.
    pub fn expanded(&mut self, line: LineFields) -> Result<Vec<LineFields>, Box<ImportFinding>> {
        let is_copy = line.head.starts_with('=');
        let refers = |field: &CardField| {
            matches!(field.text.as_str(), "=" | "==")
                || field.text.starts_with("*(")
                || field.text.starts_with("%(")
        };
        let head_refers = line.free && line.head == ")";
        let fields_refer = line.free && line.fields.iter().any(refers);
        if !(is_copy || head_refers || fields_refer) {
            self.before = Some(line.clone());
            self.changes = None;
            return Ok(vec![line]);
        }
        let Some(before) = self.before.clone() else {
            return Err(refused(
                &line,
                "must follow a line whose fields it repeats",
                "",
            ));
        };
        if before.large || line.large {
            let expected = "must not repeat fields of lines in large field format";
            return Err(refused(&line, expected, "write the line out"));
        }
        let count = count(&line)?;
        self.copies += count;
        if self.copies > MOST_COPIES {
            let expected = format!("must not make more than {MOST_COPIES} lines by replication");
            return Err(refused(&line, &expected, ""));
        }
        copied_head(&line, &before, 1)?;
        let is_bare = line.fields.iter().all(|field| field.text.is_empty())
            && line.tail.text.is_empty()
            && line.head.len() > 1
            && is_copy;
        let changes = match self.changes.clone().filter(|_| is_bare) {
            Some(changes) => changes,
            None if is_bare => {
                let expected = "must follow a line with the increments that it repeats";
                return Err(refused(&line, expected, "such as =,*(1),=,*(.5),=="));
            }
            None => changes(&line, &before, count)?,
        };
        let mut copies = Vec::new();
        for k in 1..=count {
            copies.push(copy(&line, &before, &changes, k)?);
        }
        self.before = copies.last().cloned();
        self.changes = is_copy.then_some(changes);
        Ok(copies)
    }
}

/// The error of a line of replication.
fn refused(line: &LineFields, expected: &str, hint: &str) -> Box<ImportFinding> {
    let finding = ImportFinding::new(line.at, "", expected).with_found(&line.head);
    Box::new(if hint.is_empty() {
        finding
    } else {
        finding.hint(hint)
    })
}

/// The number of copies that the first field of a line asks for: of `=(4)` 4, of a name 1.
fn count(line: &LineFields) -> Result<u64, Box<ImportFinding>> {
    let Some(rest) = line.head.strip_prefix('=').filter(|rest| !rest.is_empty()) else {
        return Ok(1);
    };
    match number(inside(rest)) {
        Some(Number::Integer(count)) if count > 0 => Ok(count.unsigned_abs()),
        _ => {
            let expected = "must be =, or = with a number of copies above 0";
            Err(refused(line, expected, "such as =(3)"))
        }
    }
}

/// The text between parentheses, which may be left out.
fn inside(text: &str) -> &str {
    text.strip_prefix('(')
        .and_then(|rest| rest.strip_suffix(')'))
        .unwrap_or(text)
}

/// The changes of the fields of the line before that a line states.
fn changes(
    line: &LineFields,
    before: &LineFields,
    count: u64,
) -> Result<Vec<Change>, Box<ImportFinding>> {
    let mut changes = Vec::new();
    for (field, old) in line.fields.iter().zip(&before.fields) {
        let text = field.text.as_str();
        let wrong = |expected: &str| {
            Box::new(ImportFinding::new(field.at, "", expected).with_found(&field.text))
        };
        let change = match text {
            "=" => Change::Same,
            "==" => break,
            _ if text.starts_with(['*', '%']) => {
                let expected =
                    "must be an increment of the same type as the field of the line before";
                let stated = number(inside(&text[1..])).ok_or_else(|| wrong(expected))?;
                let step = match (text.starts_with('%'), number(&old.text), stated) {
                    (false, Some(Number::Integer(_)), Number::Integer(_))
                    | (false, Some(Number::Real(_)), Number::Real(_)) => stated,
                    (true, Some(Number::Integer(from)), Number::Integer(to)) => {
                        let count = i64::try_from(count).unwrap_or(i64::MAX);
                        let step = to.checked_sub(from).filter(|all| all % count == 0);
                        let expected = "must be reached by equal whole increments";
                        Number::Integer(step.ok_or_else(|| wrong(expected))? / count)
                    }
                    (true, Some(Number::Real(from)), Number::Real(to)) => {
                        Number::Real((to - from) / count as f64)
                    }
                    _ => return Err(wrong(expected)),
                };
                Change::Add(step)
            }
            _ => Change::Text(field.text.clone()),
        };
        changes.push(change);
    }
    // after `==`
    changes.resize(before.fields.len(), Change::Same);
    Ok(changes)
}

/// The copy number `k` of the line before.
fn copy(
    line: &LineFields,
    before: &LineFields,
    changes: &[Change],
    k: u64,
) -> Result<LineFields, Box<ImportFinding>> {
    let is_copy = line.head.starts_with('=');
    let mut fields = Vec::new();
    for (index, (change, old)) in changes.iter().zip(&before.fields).enumerate() {
        let at = line
            .fields
            .get(index)
            .filter(|field| !field.text.is_empty())
            .map_or(line.at, |field| field.at);
        let text = match change {
            Change::Same => old.text.clone(),
            Change::Text(text) => text.clone(),
            Change::Add(step) => increased(&old.text, *step, k).ok_or_else(|| {
                let expected = "must give a number within the range of its type";
                Box::new(ImportFinding::new(at, "", expected).with_found(&old.text))
            })?,
        };
        fields.push(CardField { at, text });
    }
    let head = copied_head(line, before, k)?;
    let tail = if is_copy && matches!(line.tail.text.as_str(), "" | "=" | "==") {
        CardField {
            at: line.at,
            text: counted(before.tail.text.trim(), k).unwrap_or_default(),
        }
    } else {
        line.tail.clone()
    };
    Ok(LineFields {
        head,
        fields,
        tail,
        ..line.clone()
    })
}

/// The first field of the copy number `k` of the line before: its name, or its marker counted up.
fn copied_head(
    line: &LineFields,
    before: &LineFields,
    k: u64,
) -> Result<String, Box<ImportFinding>> {
    let is_copy = line.head.starts_with('=');
    let is_continuation = before.head.is_empty() || before.head.starts_with(['+', '*']);
    match (line.head.as_str(), is_copy) {
        (")", _) => Ok(before.tail.text.trim().to_owned()),
        (own, false) => Ok(own.to_owned()),
        (_, true) if !is_continuation => Ok(before.head.clone()),
        _ => counted(&before.head, k).ok_or_else(|| {
            let expected = "must not repeat a continuation line whose marker has no number";
            let hint =
                "give the markers a form such as +A-1, which is counted up, or write the card out";
            refused(line, expected, hint)
        }),
    }
}

/// A number in the notation of bulk data plus `k` times a step of the same type.
fn increased(old: &str, step: Number, k: u64) -> Option<String> {
    match (number(old)?, step) {
        (Number::Integer(old), Number::Integer(step)) => {
            let all = step.checked_mul(i64::try_from(k).ok()?)?;
            Some(old.checked_add(all)?.to_string())
        }
        (Number::Real(old), Number::Real(step)) => {
            let value = old + step * k as f64;
            value.is_finite().then(|| format!("{value:E}"))
        }
        _ => None,
    }
}

/// A marker such as `+A-1`, counted up by `k`.
fn counted(marker: &str, k: u64) -> Option<String> {
    let (name, count) = marker.strip_prefix('+')?.rsplit_once('-')?;
    let count: u64 = count.parse().ok()?;
    Some(format!("+{name}-{}", count.checked_add(k)?))
}
