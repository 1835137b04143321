//! Reader of data sets: statements to arguments, by the table of each kind of statement.
//!
//! The text of a statement is read by a `cursor` over its characters. `grammar` has the tables, and
//! `arguments` reads values of each form.

mod arguments;
mod cursor;
mod grammar;

use super::data_set::DataSet;
use super::lexer::{RawStatement, statements};
use super::statement::Statement;
use crate::{AdamsFault, Error};
use cursor::{Cursor, single_blanks};
use std::collections::BTreeSet;

impl DataSet {
    /// Reads a data set, up to END.
    ///
    /// Keywords and names of arguments may be in upper or lower case and may be abbreviated as long as they
    /// stay unique; arguments may come in any order. The result has the full names. A line that begins with a
    /// comma continues the line before it: in a list this comma separates items, in a function expression it
    /// is dropped. An expression ends with `\`, with the statement, or before a comma and the name of another
    /// argument. Blanks in expressions are removed.
    ///
    /// Statements of kinds that this crate does not execute are kept as they are written.
    ///
    /// # Errors
    /// [`Error::At`] with line and column for text that is not a statement, an unknown or repeated argument,
    /// a value of the wrong form, an expression that cannot be parsed, or an identifier that is missing or
    /// used twice.
    ///
    /// # Source
    /// Adams Solver reference, the statements; continuation as in data sets written by Adams View.
    ///
    /// ```
    /// use adams::{DataSet, ArgumentValue};
    ///
    /// let set = DataSet::read("title\nVAR/1, FUN=TIME\n,*2\nEND")?;
    /// let function = set.find("VARIABLE", 1).and_then(|one| one.get("FUNCTION"));
    /// assert_eq!(function, Some(&ArgumentValue::Function("TIME*2".into())));
    /// # Ok::<(), adams::Error>(())
    /// ```
    pub fn read(text: &str) -> Result<DataSet, Error> {
        let (title, all) = statements(text)?;
        let mut out = DataSet {
            title: title.unwrap_or("").to_owned(),
            statements: Vec::new(),
        };
        let mut seen = BTreeSet::new();
        for raw in &all {
            let mut cursor = Cursor::new(raw);
            cursor.skip();
            let start = cursor.index();
            let statement = statement(raw, &mut cursor)?;
            if let Some(id) = statement.id
                && !seen.insert((statement.keyword.clone(), id))
            {
                return Err(cursor.fault(start, AdamsFault::DuplicateId { id }));
            }
            out.statements.push(statement);
        }
        Ok(out)
    }
}

/// One statement.
fn statement(raw: &RawStatement<'_>, cursor: &mut Cursor) -> Result<Statement, Error> {
    let start = cursor.index();
    let word = cursor
        .word()
        .ok_or_else(|| cursor.fault(start, AdamsFault::UnexpectedText))?;
    if !cursor.eat('/') {
        return Err(cursor.fault(start, AdamsFault::UnexpectedText));
    }
    let (keyword, arguments) = grammar::keyword(&word);
    let lone = grammar::has_no_id(&keyword);
    let mut out = Statement::without_id(keyword.as_str());
    let owned = |text: Option<&str>| text.map(str::to_owned);
    (out.name, out.units) = (owned(raw.name), owned(raw.units));
    out.remarks = raw.remarks.iter().map(|text| single_blanks(text)).collect();
    cursor.skip();
    let at = cursor.index();
    let digits = if lone {
        String::new()
    } else {
        cursor.run(|c| c.is_ascii_digit())
    };
    if digits.is_empty() {
        if arguments.is_some() && !lone {
            return Err(cursor.fault(at, AdamsFault::Id));
        }
    } else {
        let id = digits.parse().ok().filter(|&id: &u32| id > 0);
        out.id = Some(id.ok_or_else(|| cursor.fault(at, AdamsFault::Id))?);
    }
    match arguments {
        Some(table) => arguments::known(cursor, table, &mut out)?,
        None => arguments::unknown(cursor, &mut out)?,
    }
    Ok(out)
}
