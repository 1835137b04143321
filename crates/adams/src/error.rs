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
    #[error("SPLINE/{id} stands twice")]
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
    /// A unit that is not known, or UNITS without force and length.
    #[error("unknown unit")]
    Unit,
}
