//! A whole data set.

use crate::layout::Layout;
use crate::{Error, Statement};

/// Title, statements in order; END is understood.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DataSet {
    /// First line.
    pub title: String,
    /// Statements in order.
    pub statements: Vec<Statement>,
}

impl DataSet {
    /// The text of the data set, ending with END.
    ///
    /// Guarantees: lines of at most 79 ASCII characters, numbers that read back to the same bits. Lists are
    /// broken before a separating comma, expressions after an operator or comma: the comma that begins a
    /// continued line separates in a list and vanishes in an expression.
    ///
    /// # Errors
    /// An identifier that is zero or used twice by one kind of statement; a name that has no place on a line;
    /// a piece of an expression that is longer than a line.
    pub fn write(&self) -> Result<String, Error> {
        let mut layout = Layout::new(&self.title);
        for (k, statement) in self.statements.iter().enumerate() {
            let twice = |other: &Statement| other.keyword == statement.keyword && other.id == statement.id;
            if let Some(id) = statement.id
                && (id == 0 || self.statements[..k].iter().any(twice))
            {
                return Err(Error::Id { keyword: statement.keyword.clone(), id });
            }
            layout.statement(statement)?;
        }
        Ok(layout.end())
    }

    /// The first statement of a kind with an identifier.
    #[must_use]
    pub fn find(&self, keyword: &str, id: u32) -> Option<&Statement> {
        self.statements.iter().find(|one| one.keyword == keyword && one.id == Some(id))
    }

    /// How many VARIABLE, GFORCE or other statements of a kind there are.
    #[must_use]
    pub fn count(&self, keyword: &str) -> usize {
        self.statements.iter().filter(|one| one.keyword == keyword).count()
    }
}
