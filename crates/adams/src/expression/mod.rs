//! Function expressions: text to tree.

mod parser;
mod token;

pub use parser::parse;

/// A function expression as it is written; names mean nothing yet.
///
/// Sums and products are lists, so that depth comes from brackets alone.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number; angles with the suffix D are in radians here.
    Number(f64),
    /// A word without arguments, such as TIME.
    Name(Name),
    /// A function; `IF(e: a, b, c)` has four arguments.
    Call(Name, Vec<Expression>),
    /// Terms from left to right, with the operator before each.
    Sum(Vec<(Sign, Expression)>),
    /// Factors from left to right, with the operator before each.
    Product(Vec<(Factor, Expression)>),
    /// Base and exponent.
    Power(Box<Expression>, Box<Expression>),
}

/// A word in capitals and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// In capitals.
    pub word: String,
    /// Characters before it.
    pub offset: usize,
}

/// What stands before a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// +
    Plus,
    /// -
    Minus,
}

/// What stands before a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    /// *
    Times,
    /// /
    Over,
}

impl Expression {
    /// The whole number that the expression is, such as the identifier of a marker.
    #[must_use]
    pub fn whole(&self) -> Option<u32> {
        match self {
            Expression::Number(value) if value.fract() == 0.0 && (0.0..4e9).contains(value) => {
                Some(*value as u32)
            }
            _ => None,
        }
    }
}
