//! What can go wrong, by place, identifier and number.

/// Why a data set is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Text that cannot be read.
    #[error("line {line}, column {column}: {fault}")]
    At {
        /// Line, from 1.
        line: usize,
        /// Column, from 1, in characters.
        column: usize,
        /// What is wrong there.
        fault: Fault,
    },
    /// An identifier that is zero or used twice.
    #[error("{keyword}/{id} is zero or stands twice")]
    Id {
        /// Kind of statement.
        keyword: String,
        /// The identifier.
        id: u32,
    },
    /// A name that has no place between quotes on a line.
    #[error("{keyword}/{id} has a name or units that cannot be written")]
    Name {
        /// Kind of statement.
        keyword: String,
        /// The identifier.
        id: u32,
    },
    /// An item of an expression or list that is longer than a line.
    #[error("{keyword}/{id} has text that cannot be broken into lines")]
    Long {
        /// Kind of statement.
        keyword: String,
        /// The identifier, zero for statements without one.
        id: u32,
    },
    /// A statement that cannot be executed.
    #[error("{keyword}/{id}: {fault}")]
    Statement {
        /// Kind of statement.
        keyword: String,
        /// The identifier, zero for statements without one.
        id: u32,
        /// Why not.
        fault: Box<Fault>,
    },
    /// An expression that cannot be executed, or has no value at a state.
    #[error("{keyword}/{id}, {argument}, after {offset} characters: {fault}")]
    In {
        /// Kind of statement.
        keyword: String,
        /// The identifier.
        id: u32,
        /// The argument.
        argument: String,
        /// Characters of the expression before the place.
        offset: usize,
        /// Why not.
        fault: Box<Fault>,
    },
    /// A state without one of the parts or differential equations.
    #[error("the state has no {keyword}/{id}")]
    State {
        /// Kind of statement.
        keyword: String,
        /// The identifier.
        id: u32,
    },
    /// A loop of expressions without a solution that Newton's method finds from the initial values.
    #[error("{keyword}/{id}: no solution of the loop that it belongs to, after {iterations} iterations")]
    Loop {
        /// Kind of statement.
        keyword: String,
        /// The identifier.
        id: u32,
        /// Iterations done.
        iterations: usize,
    },
    /// No static equilibrium was found; the statement is the one that is farthest from it.
    #[error("no equilibrium after {iterations} iterations: {keyword}/{id} is off by {residual:e}")]
    Equilibrium {
        /// Kind of statement.
        keyword: String,
        /// The identifier.
        id: u32,
        /// Unbalanced force or torque, gap of a joint, or error of a VARIABLE.
        residual: f64,
        /// Iterations done.
        iterations: usize,
    },
}

/// What is wrong at a place of a data set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// Something that cannot stand there.
    #[error("unexpected text")]
    Text,
    /// A number that is no finite real number.
    #[error("not a number")]
    Number,
    /// An identifier that is no positive integer.
    #[error("not an identifier")]
    Id,
    /// An identifier used before.
    #[error("identifier {id} stands twice")]
    Twice {
        /// The identifier.
        id: u32,
    },
    /// An argument that the statement has not, or that is ambiguous.
    #[error("unknown argument")]
    Argument,
    /// An argument given before.
    #[error("argument given twice")]
    Repeated,
    /// Values kept in another file.
    #[error("SPLINE/{id} keeps its values in another file")]
    File {
        /// The identifier.
        id: u32,
    },
    /// A SPLINE that a later command changes.
    #[error("a SPLINE is changed after it is made")]
    Changed,
    /// No X.
    #[error("SPLINE/{id} has no X")]
    NoX {
        /// The identifier.
        id: u32,
    },
    /// No Y.
    #[error("SPLINE/{id} has no Y")]
    NoY {
        /// The identifier.
        id: u32,
    },
    /// A Y list of the wrong length: one value each x, with z before them in a family.
    #[error("SPLINE/{id}: {found} values, expected {expected}")]
    Count {
        /// The identifier.
        id: u32,
        /// Values found.
        found: usize,
        /// Values expected.
        expected: usize,
    },
    /// Values of a SPLINE that make no curves.
    #[error("SPLINE/{id}: {source}")]
    Spline {
        /// The identifier.
        id: u32,
        /// Why not.
        source: Box<Fault>,
    },
    /// Too few x.
    #[error("{found} points, at least {least} are needed")]
    Points {
        /// Points found.
        found: usize,
        /// Points needed.
        least: usize,
    },
    /// x or z that does not increase.
    #[error("point {index} is not above the one before it")]
    Order {
        /// Which point, from 0.
        index: usize,
    },
    /// Curves that do not match z.
    #[error("{found} curves, expected {expected}")]
    Curves {
        /// Curves found.
        found: usize,
        /// Curves expected.
        expected: usize,
    },
    /// Values that do not match x.
    #[error("curve {curve} has {found} values, expected {expected}")]
    Values {
        /// Which curve, from 0.
        curve: usize,
        /// Values found.
        found: usize,
        /// Values expected.
        expected: usize,
    },
    /// A value that is not finite.
    #[error("value {index} of curve {curve} is not finite")]
    NotFinite {
        /// Which curve, from 0.
        curve: usize,
        /// Which value, from 0.
        index: usize,
    },
    /// Brackets, signs and powers too deep within each other.
    #[error("nested too deep")]
    Deep,
    /// A name that an expression cannot have.
    #[error("{name} is not known")]
    Unknown {
        /// In capitals.
        name: String,
    },
    /// A number of arguments that the function has not.
    #[error("wrong number of arguments, or one outside its range")]
    Arguments,
    /// A parameter for which a function or element has no meaning.
    #[error("a parameter is outside its range")]
    Parameter,
    /// Derivatives of a family of curves.
    #[error("derivatives can be asked of one curve alone")]
    Derivative,
    /// z outside a SPLINE without LINEAR_EXTRAPOLATE.
    #[error("z is outside the SPLINE, which has no LINEAR_EXTRAPOLATE")]
    Beyond,
    /// No finite real number.
    #[error("the value is not finite")]
    Infinite,
    /// A reaction of a joint or motion where none is known.
    #[error("reactions are known at equilibrium alone, to requests")]
    Reaction,
    /// A reference to what is not there.
    #[error("{keyword}/{id} is missing")]
    Missing {
        /// Kind of statement.
        keyword: String,
        /// The identifier.
        id: u32,
    },
    /// An argument that must be there.
    #[error("{argument} is missing")]
    Lacks {
        /// The argument.
        argument: String,
    },
    /// An argument that is given something else than it takes.
    #[error("{argument} is given something else than it takes")]
    Given {
        /// The argument.
        argument: String,
    },
    /// A kind of statement, or one of its options, that is not executed.
    #[error("not executed")]
    Unsupported,
    /// No type of joint or motion, or one that does not fit.
    #[error("the type is missing or does not fit")]
    Type,
    /// A marker that must float, or must not; or that floats for two forces.
    #[error("JFLOAT takes a FLOATING marker of its own, everything else takes fixed ones")]
    Floating,
    /// Axes by both angles and points, or by points in line.
    #[error("the axes are not determined")]
    Axes,
    /// A unit that is not known, or UNITS without force and length.
    #[error("unknown unit")]
    Unit,
}
