//! A whole data set.

use super::layout::Layout;
use super::statement::Statement;
use crate::{Error, StatementId};

/// A data set: its title and its statements in order. The final END is not stored.
///
/// ```
/// use adams::{DataSet, Statement};
///
/// let mut set = DataSet { title: "two parts".to_owned(), ..DataSet::default() };
/// set.statements.push(Statement::new("PART", 1).flag("GROUND"));
/// set.statements.push(Statement::new("PART", 2).numbers("MASS", &[1.5]));
/// let text = set.write()?;
/// assert_eq!(DataSet::read(&text)?, set);
/// # Ok::<(), adams::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DataSet {
    /// First line.
    pub title: String,
    /// Statements in order.
    pub statements: Vec<Statement>,
}

impl DataSet {
    /// Writes the data set as text that ends with END.
    ///
    /// Guarantees: no line is longer than 79 ASCII characters, and every number reads back to the same bits.
    /// A list is broken before a separating comma, an expression after an operator or comma, because the
    /// comma that begins a continued line separates items of a list but is dropped from an expression.
    ///
    /// # Errors
    /// [`Error::Id`] for an identifier that is zero or used twice by one kind of statement; [`Error::Name`]
    /// for a name or unit that does not fit between quotes on a line; [`Error::Long`] for a piece of text
    /// that is longer than a line and cannot be broken.
    pub fn write(&self) -> Result<String, Error> {
        let mut layout = Layout::new(&self.title);
        for (k, statement) in self.statements.iter().enumerate() {
            let twice =
                |other: &Statement| other.keyword == statement.keyword && other.id == statement.id;
            if let Some(id) = statement.id
                && (id == 0 || self.statements[..k].iter().any(twice))
            {
                return Err(Error::Id {
                    statement: StatementId::new(&statement.keyword, id),
                });
            }
            layout.statement(statement)?;
        }
        Ok(layout.end())
    }

    /// The first statement with this keyword and identifier.
    #[must_use]
    pub fn find(&self, keyword: &str, id: u32) -> Option<&Statement> {
        self.statements
            .iter()
            .find(|one| one.keyword == keyword && one.id == Some(id))
    }

    /// The number of statements with this keyword, such as VARIABLE.
    #[must_use]
    pub fn count(&self, keyword: &str) -> usize {
        self.statements
            .iter()
            .filter(|one| one.keyword == keyword)
            .count()
    }
}
