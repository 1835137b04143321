//! Errors: what is wrong, and where in the text or in which statement.
//!
//! An [`Error`] states the place: line and column of the text, or the statement by keyword and identifier. An
//! [`AdamsFault`] states what is wrong there.

use crate::keyword::StatementId;

/// Why a data set is refused, or why it has no solution at a state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The text cannot be read at this place.
    #[error("line {line}, column {column}: {fault}")]
    At {
        /// Line, from 1.
        line: usize,
        /// Column, from 1, in characters.
        column: usize,
        /// What is wrong there.
        fault: AdamsFault,
    },
    /// An identifier is zero or used twice by one kind of statement.
    #[error("{statement} is zero or stands twice")]
    Id {
        /// Which statement.
        statement: StatementId,
    },
    /// An Adams View name or unit cannot be written between quotes on one line.
    #[error("{statement} has a name or units that cannot be written")]
    Name {
        /// Which statement.
        statement: StatementId,
    },
    /// An item of an expression or list is longer than a line.
    #[error("{statement} has text that cannot be broken into lines")]
    Long {
        /// Which statement.
        statement: StatementId,
    },
    /// A statement cannot be executed.
    #[error("{statement}: {fault}")]
    Statement {
        /// Which statement.
        statement: StatementId,
        /// Why not.
        fault: Box<AdamsFault>,
    },
    /// An expression cannot be compiled, or has no value at a state.
    #[error("{statement}, {argument}, after {offset} characters: {fault}")]
    In {
        /// Which statement.
        statement: StatementId,
        /// The argument that holds the expression.
        argument: &'static str,
        /// Characters of the expression before the place.
        offset: usize,
        /// Why not.
        fault: Box<AdamsFault>,
    },
    /// The state has no entry for one of the parts or differential equations.
    #[error("the state has no {statement}")]
    State {
        /// Which statement.
        statement: StatementId,
    },
    /// Newton's method finds no solution of an algebraic loop from the initial values.
    #[error(
        "{statement}: no solution of the loop that it belongs to, after {iterations} iterations"
    )]
    Loop {
        /// The statement of the loop that moved most in the last iteration.
        statement: StatementId,
        /// Iterations done.
        iterations: usize,
    },
    /// No static equilibrium was found.
    #[error("no equilibrium after {iterations} iterations: {statement} is off by {residual:e}")]
    Equilibrium {
        /// The statement with the largest scaled residual.
        statement: StatementId,
        /// Its unbalanced force or torque, gap of a joint, or error of a VARIABLE.
        residual: f64,
        /// Iterations done.
        iterations: usize,
    },
}

/// What is wrong at a place of a data set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AdamsFault {
    /// The text does not belong there.
    #[error("unexpected text")]
    UnexpectedText,
    /// The text is not a finite real number.
    #[error("not a number")]
    Number,
    /// The text is not a positive integer.
    #[error("not an identifier")]
    Id,
    /// The identifier was used before.
    #[error("identifier {id} stands twice")]
    DuplicateId {
        /// The identifier.
        id: u32,
    },
    /// The statement has no such argument, or the abbreviation is ambiguous.
    #[error("unknown argument")]
    Argument,
    /// The argument was given before.
    #[error("argument given twice")]
    Repeated,
    /// The values of a SPLINE are in another file.
    #[error("SPLINE/{id} keeps its values in another file")]
    File {
        /// The identifier.
        id: u32,
    },
    /// A later command modifies a SPLINE.
    #[error("a SPLINE is changed after it is made, and no other is left")]
    Changed,
    /// A SPLINE has no X.
    #[error("SPLINE/{id} has no X")]
    NoX {
        /// The identifier.
        id: u32,
    },
    /// A SPLINE has no Y.
    #[error("SPLINE/{id} has no Y")]
    NoY {
        /// The identifier.
        id: u32,
    },
    /// A Y list has the wrong length. It has one value for each x, preceded by z in a family of curves.
    #[error("SPLINE/{id}: {found} values, expected {expected}")]
    Count {
        /// The identifier.
        id: u32,
        /// Values found.
        found: usize,
        /// Values expected.
        expected: usize,
    },
    /// The values of a SPLINE do not make curves.
    #[error("SPLINE/{id}: {source}")]
    Spline {
        /// The identifier.
        id: u32,
        /// Why not.
        source: Box<AdamsFault>,
    },
    /// There are too few x values.
    #[error("{found} points, at least {least} are needed")]
    Points {
        /// Points found.
        found: usize,
        /// Points needed.
        least: usize,
    },
    /// An x or z value is not finite or not above the one before it.
    #[error("point {index} is not above the one before it")]
    Order {
        /// Which point, from 0.
        index: usize,
    },
    /// The number of curves differs from the number of z values.
    #[error("{found} curves, expected {expected}")]
    Curves {
        /// Curves found.
        found: usize,
        /// Curves expected.
        expected: usize,
    },
    /// The number of values of a curve differs from the number of x values.
    #[error("curve {curve} has {found} values, expected {expected}")]
    Values {
        /// Which curve, from 0.
        curve: usize,
        /// Values found.
        found: usize,
        /// Values expected.
        expected: usize,
    },
    /// A value is not finite.
    #[error("value {index} of curve {curve} is not finite")]
    NotFinite {
        /// Which curve, from 0.
        curve: usize,
        /// Which value, from 0.
        index: usize,
    },
    /// Brackets, signs and powers are nested more than 100 deep.
    #[error("nested too deep")]
    NestedTooDeep,
    /// The name is no function or constant of the expression language.
    #[error("{name} is not known")]
    Unknown {
        /// The name in capitals.
        name: String,
    },
    /// The number of arguments is wrong, or an argument that must be a whole number is outside its range.
    #[error("wrong number of arguments, or one outside its range")]
    Arguments,
    /// A function or element is not defined for a parameter.
    #[error("a parameter is outside its range")]
    Parameter,
    /// A derivative of a family of curves is asked for.
    #[error("derivatives can be asked of one curve alone")]
    Derivative,
    /// z is outside a SPLINE without LINEAR_EXTRAPOLATE.
    #[error("z is outside the SPLINE, which has no LINEAR_EXTRAPOLATE")]
    OutsideZ,
    /// The value of an expression is not a finite number.
    #[error("the value is not finite")]
    NotFiniteValue,
    /// The reaction of a joint or motion is read where none is known.
    #[error("reactions are known at equilibrium alone, to requests")]
    Reaction,
    /// A statement that is referred to does not exist.
    #[error("{statement} is missing")]
    Missing {
        /// Which statement.
        statement: StatementId,
    },
    /// A required argument is missing.
    #[error("{argument} is missing")]
    MissingArgument {
        /// The argument.
        argument: &'static str,
    },
    /// The value of an argument has the wrong form.
    #[error("{argument} is given something else than it takes")]
    WrongForm {
        /// The argument.
        argument: &'static str,
    },
    /// A kind of statement, or one of its options, is not executed by this crate.
    #[error("not executed")]
    Unsupported,
    /// The type of a joint or motion is missing or does not fit.
    #[error("the type is missing or does not fit")]
    Type,
    /// A marker must float, must not float, or floats for two forces.
    #[error("JFLOAT takes a FLOATING marker of its own, everything else takes fixed ones")]
    Floating,
    /// Axes are given by both angles and points, or by points in one line.
    #[error("the axes are not determined")]
    Axes,
    /// A unit is not known, or UNITS has no force or length.
    #[error("unknown unit")]
    Unit,
}
