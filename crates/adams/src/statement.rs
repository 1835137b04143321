//! One statement of a data set.

/// `KEYWORD/id, NAME = value, ...`, with the comments that Adams View leaves before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// Full keyword in capitals, such as `MARKER`.
    pub keyword: String,
    /// Identifier, where this kind of statement has one.
    pub id: Option<u32>,
    /// `adams_view_name` of the comment before it.
    pub name: Option<String>,
    /// `adams_view_units` of the comment before it, such as `no_units`.
    pub units: Option<String>,
    /// Free comment lines written before it.
    pub remarks: Vec<String>,
    /// Arguments in order.
    pub arguments: Vec<Argument>,
}

/// One argument.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// Full name in capitals, such as `QP`.
    pub name: String,
    /// What it is given.
    pub value: Value,
}

/// What an argument is given.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Nothing: the name alone, such as FLOATING.
    Flag,
    /// A word or quoted text as it is written, such as POUND_FORCE.
    Word(String),
    /// An identifier or count.
    Whole(i64),
    /// Numbers.
    Numbers(Vec<f64>),
    /// Angles in degrees, written with the suffix D.
    Degrees(Vec<f64>),
    /// A function expression.
    Function(String),
}

impl Statement {
    /// A statement with an identifier and no arguments.
    #[must_use]
    pub fn new(keyword: &str, id: u32) -> Statement {
        Statement { id: Some(id), ..Statement::lone(keyword) }
    }

    /// A statement of a kind that has no identifier.
    #[must_use]
    pub fn lone(keyword: &str) -> Statement {
        Statement {
            keyword: keyword.to_owned(),
            id: None,
            name: None,
            units: None,
            remarks: Vec::new(),
            arguments: Vec::new(),
        }
    }

    /// With its Adams View name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Statement {
        self.name = Some(name.into());
        self
    }

    /// With a comment line before it.
    #[must_use]
    pub fn remark(mut self, text: impl Into<String>) -> Statement {
        self.remarks.push(text.into());
        self
    }

    /// With one more argument.
    #[must_use]
    pub fn with(mut self, name: &str, value: Value) -> Statement {
        self.arguments.push(Argument { name: name.to_owned(), value });
        self
    }

    /// With an argument that is a name alone.
    #[must_use]
    pub fn flag(self, name: &str) -> Statement {
        self.with(name, Value::Flag)
    }

    /// With an identifier as argument.
    #[must_use]
    pub fn reference(self, name: &str, id: u32) -> Statement {
        self.with(name, Value::Whole(i64::from(id)))
    }

    /// With a word as argument.
    #[must_use]
    pub fn word(self, name: &str, word: &str) -> Statement {
        self.with(name, Value::Word(word.to_owned()))
    }

    /// With numbers as argument.
    #[must_use]
    pub fn numbers(self, name: &str, values: &[f64]) -> Statement {
        self.with(name, Value::Numbers(values.to_vec()))
    }

    /// With a function expression as argument.
    #[must_use]
    pub fn function(self, name: &str, expression: impl Into<String>) -> Statement {
        self.with(name, Value::Function(expression.into()))
    }

    /// The value of an argument.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.arguments.iter().find(|argument| argument.name == name).map(|argument| &argument.value)
    }
}
