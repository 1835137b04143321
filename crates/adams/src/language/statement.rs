//! One statement of a data set, and how it is built.

/// A statement `KEYWORD/id, NAME = value, ...`, with the comments that stand before it.
///
/// ```
/// use adams::Statement;
///
/// let gap = Statement::new("VARIABLE", 171).named("gap").function("FUNCTION", "DY(216,49,49)");
/// assert!(gap.get("FUNCTION").is_some() && gap.get("IC").is_none());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// Full keyword in capitals, such as `MARKER`.
    pub keyword: String,
    /// The identifier; `None` for kinds that have none, such as UNITS.
    pub id: Option<u32>,
    /// The `adams_view_name` in a comment before it.
    pub name: Option<String>,
    /// The `adams_view_units` in a comment before it, such as `no_units`.
    pub units: Option<String>,
    /// Other comment lines before it.
    pub remarks: Vec<String>,
    /// Arguments in order.
    pub arguments: Vec<StatementArgument>,
}

/// One argument of a statement.
#[derive(Clone, Debug, PartialEq)]
pub struct StatementArgument {
    /// Full name in capitals, such as `QP`.
    pub name: String,
    /// Its value.
    pub value: ArgumentValue,
}

/// The value of an argument.
#[derive(Clone, Debug, PartialEq)]
pub enum ArgumentValue {
    /// No value: the name stands alone, as FLOATING does.
    Flag,
    /// A word such as POUND_FORCE, or quoted text, as it is written.
    Word(String),
    /// An identifier or a count.
    Whole(i64),
    /// One number or a list of numbers.
    Numbers(Vec<f64>),
    /// Angles in degrees, which are written with the suffix D.
    Degrees(Vec<f64>),
    /// The text of a function expression.
    Function(String),
}

impl Statement {
    /// A statement with an identifier and no arguments.
    #[must_use]
    pub fn new(keyword: &str, id: u32) -> Statement {
        Statement {
            id: Some(id),
            ..Statement::without_id(keyword)
        }
    }

    /// A statement of a kind without identifier, such as UNITS, without arguments.
    #[must_use]
    pub fn without_id(keyword: &str) -> Statement {
        Statement {
            keyword: keyword.to_owned(),
            id: None,
            name: None,
            units: None,
            remarks: Vec::new(),
            arguments: Vec::new(),
        }
    }

    /// Sets the name that Adams View shows.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Statement {
        self.name = Some(name.into());
        self
    }

    /// Adds a comment line before the statement.
    #[must_use]
    pub fn remark(mut self, text: impl Into<String>) -> Statement {
        self.remarks.push(text.into());
        self
    }

    /// Adds an argument.
    #[must_use]
    pub fn with(mut self, name: &str, value: ArgumentValue) -> Statement {
        self.arguments.push(StatementArgument {
            name: name.to_owned(),
            value,
        });
        self
    }

    /// Adds an argument without value.
    #[must_use]
    pub fn flag(self, name: &str) -> Statement {
        self.with(name, ArgumentValue::Flag)
    }

    /// Adds an argument whose value is an identifier.
    #[must_use]
    pub fn reference(self, name: &str, id: u32) -> Statement {
        self.with(name, ArgumentValue::Whole(i64::from(id)))
    }

    /// Adds an argument whose value is a word.
    #[must_use]
    pub fn word(self, name: &str, word: &str) -> Statement {
        self.with(name, ArgumentValue::Word(word.to_owned()))
    }

    /// Adds an argument whose value is a list of numbers.
    #[must_use]
    pub fn numbers(self, name: &str, values: &[f64]) -> Statement {
        self.with(name, ArgumentValue::Numbers(values.to_vec()))
    }

    /// Adds an argument whose value is a function expression.
    #[must_use]
    pub fn function(self, name: &str, expression: impl Into<String>) -> Statement {
        self.with(name, ArgumentValue::Function(expression.into()))
    }

    /// The value of the first argument with this full name in capitals.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&ArgumentValue> {
        self.arguments
            .iter()
            .find(|argument| argument.name == name)
            .map(|argument| &argument.value)
    }
}
