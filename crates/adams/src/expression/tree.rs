//! The tree of a function expression.

/// A function expression as it is written, without meaning of its names.
///
/// A sum or product of many operands is one node with a list, so that the depth of the tree comes from
/// brackets, signs and powers alone.
///
/// ```
/// use adams::{Expression, expression};
///
/// let tree = expression::parse("VARVAL(171)-1.25").expect("an expression");
/// let Expression::Sum(terms) = tree else { panic!("a sum") };
/// assert_eq!(terms.len(), 2);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number. An angle written with the suffix D is stored in radians.
    Number(f64),
    /// A word without arguments, such as TIME.
    Name(ExpressionName),
    /// A function and its arguments; `IF(e: a, b, c)` has four.
    Call(ExpressionName, Vec<Expression>),
    /// Terms from left to right, each with the operator before it.
    Sum(Vec<(TermOperator, Expression)>),
    /// Factors from left to right, each with the operator before it.
    Product(Vec<(FactorOperator, Expression)>),
    /// Base and exponent.
    Power(Box<Expression>, Box<Expression>),
}

/// A word of an expression and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionName {
    /// The word in capitals.
    pub word: String,
    /// Number of characters of the expression before it.
    pub offset: usize,
}

/// The operator before a term of a sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TermOperator {
    /// +
    Plus,
    /// -
    Minus,
}

/// The operator before a factor of a product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorOperator {
    /// *
    Times,
    /// /
    Over,
}

impl Expression {
    /// The value of an expression that is one whole number from 0 to 4e9, such as the identifier of a marker.
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
