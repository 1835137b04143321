//! Text to data set.

mod arguments;
mod flow;
mod function;
mod grammar;

use crate::lexer::{self, statements};
use crate::{DataSet, Error, Fault, Statement};
use flow::Flow;

impl DataSet {
    /// Reads a data set, up to END.
    ///
    /// Keywords and names of arguments may be abbreviated as long as they are unique, in any case and order;
    /// they come back in full. A line that begins with a comma continues the one before: in lists that comma
    /// separates, in function expressions it vanishes. An expression ends with `\`, with the statement, or before
    /// a comma and the name of another argument. Blanks in expressions are left out.
    ///
    /// Statements of kinds that the crate does not execute are kept as they are written.
    ///
    /// # Errors
    /// [`Error::At`] with line and column: what is no statement; an argument that the statement has not or has
    /// twice, or that is given something else; an expression that cannot be parsed; an identifier that is
    /// missing or used twice.
    ///
    /// # Source
    /// Adams Solver reference, the statements; continuation as in data sets that Adams View wrote.
    pub fn read(text: &str) -> Result<DataSet, Error> {
        let (title, all) = statements(text)?;
        let mut out = DataSet { title: title.unwrap_or("").to_owned(), statements: Vec::new() };
        let mut seen = std::collections::BTreeSet::new();
        for raw in &all {
            let mut flow = Flow::new(raw);
            flow.skip();
            let start = flow.index();
            let statement = statement(raw, &mut flow)?;
            if let Some(id) = statement.id
                && !seen.insert((statement.keyword.clone(), id))
            {
                return Err(flow.fault(start, Fault::Twice { id }));
            }
            out.statements.push(statement);
        }
        Ok(out)
    }
}

fn statement(raw: &lexer::Statement<'_>, flow: &mut Flow) -> Result<Statement, Error> {
    let start = flow.index();
    let word = flow.word().ok_or_else(|| flow.fault(start, Fault::Text))?;
    if !flow.eat('/') {
        return Err(flow.fault(start, Fault::Text));
    }
    let (keyword, arguments) = grammar::keyword(&word);
    let lone = grammar::LONE.contains(&keyword.as_str());
    let mut out = Statement::lone(&keyword);
    let owned = |text: Option<&str>| text.map(str::to_owned);
    (out.name, out.units) = (owned(raw.name), owned(raw.units));
    out.remarks = raw.remarks.iter().map(|text| blanks(text)).collect();
    flow.skip();
    let at = flow.index();
    let digits = if lone { String::new() } else { flow.run(|c| c.is_ascii_digit()) };
    if digits.is_empty() {
        if arguments.is_some() && !lone {
            return Err(flow.fault(at, Fault::Id));
        }
    } else {
        let id = digits.parse().ok().filter(|&id: &u32| id > 0);
        out.id = Some(id.ok_or_else(|| flow.fault(at, Fault::Id))?);
    }
    match arguments {
        Some(table) => arguments::known(flow, table, &mut out)?,
        None => arguments::unknown(flow, &mut out)?,
    }
    Ok(out)
}

/// With single blanks.
fn blanks(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
