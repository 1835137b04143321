//! Everything that this crate refuses, with the index or number that is at fault.

use crate::probe::Axis;

/// Errors of this crate. They carry indices and numbers; the caller knows the names and the files.
///
/// ```
/// use splines::{Error, akima};
///
/// let refused = akima(&[0.0, 2.0, 1.0], &[0.0; 3]).expect_err("x decreases");
/// assert_eq!(refused, Error::PointOrder { index: 2 });
/// assert_eq!(refused.to_string(), "point 2 does not lie beyond the one before it");
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// No rail element has this rail index.
    #[error("rail {rail} does not exist")]
    NoRail {
        /// The index asked for.
        rail: usize,
    },
    /// A coordinate that no element of the rail covers.
    #[error("rail {rail} has no element at x = {x}")]
    OffRail {
        /// Which rail.
        rail: usize,
        /// The coordinate asked for.
        x: f64,
    },
    /// A direction in which the structure has no stiffness at the probe.
    #[error("the structure has no {axis:?} stiffness on rail {rail} at x = {x}")]
    NoStiffness {
        /// Which rail.
        rail: usize,
        /// The coordinate asked for.
        x: f64,
        /// The direction asked for.
        axis: Axis,
    },
    /// Rails without any element.
    #[error("rails need at least one element")]
    NoElements,
    /// A coordinate or offset that is not finite, or a node state index above `u32::MAX`.
    #[error("rail element {cell} has an invalid coordinate, offset or state index")]
    ElementNumber {
        /// Index of the element.
        cell: usize,
    },
    /// Coordinates of an element that do not increase.
    #[error("rail element {cell} runs from x = {} to {}", x[0], x[1])]
    ElementExtent {
        /// Index of the element.
        cell: usize,
        /// Its first and last coordinate.
        x: [f64; 2],
    },
    /// A length that is not positive.
    #[error("rail element {cell} has length {length}")]
    ElementLength {
        /// Index of the element.
        cell: usize,
        /// Its length.
        length: f64,
    },
    /// A frame that is not a rotation.
    #[error("the frame of rail element {cell} is not a rotation")]
    ElementFrame {
        /// Index of the element.
        cell: usize,
    },
    /// A flexibility that is negative or not a number, or compression beyond the shear stiffness.
    #[error(
        "rail element {cell} has a flexibility that is negative or not a number, or compression beyond its shear stiffness"
    )]
    ElementFlexibility {
        /// Index of the element.
        cell: usize,
    },
    /// Elements of one member that differ in length or flexibility.
    #[error("rail elements {first} and {second} of one member differ in length or flexibility")]
    ElementMember {
        /// Index of the first element of the member.
        first: usize,
        /// Index of the element that differs.
        second: usize,
    },
    /// Two elements of one rail that cover the same place.
    #[error("rail elements {first} and {second} of rail {rail} overlap at x = {x}")]
    Overlap {
        /// Which rail.
        rail: usize,
        /// Index of the element that begins earlier.
        first: usize,
        /// Index of the element that begins later.
        second: usize,
        /// Coordinate at which the later one begins.
        x: f64,
    },
    /// A nodal compliance whose size does not fit the number of node states.
    #[error("nodal compliance is {rows} x {columns}, expected {expected} x {expected}")]
    NodalShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
        /// Six degrees of freedom for each node state.
        expected: usize,
    },
    /// An entry of a nodal compliance that is not a number, or infinite off the diagonal.
    #[error("nodal compliance ({row}, {column}) is not finite")]
    NodalNumber {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// A matrix of effects whose size fits neither the sections nor the node states.
    #[error("effects are {rows} x {columns}, expected {} x {}", expected[0], expected[1])]
    EffectShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
        /// Number of effects, and six degrees of freedom for each node state.
        expected: [usize; 2],
    },
    /// An effect with an entry that is not a number, or with a section outside its member.
    #[error("effect {effect} has an entry that is not a number or a section outside 0 to 1")]
    EffectNumber {
        /// Index of the effect.
        effect: usize,
    },
    /// An influence matrix whose size is not the number of probes.
    #[error("influence matrices are {rows} x {columns}, expected {expected} x {expected}")]
    OutputShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
        /// Number of probes.
        expected: usize,
    },
    /// Numbers of x and y values that differ.
    #[error("{x} x values, {y} y values")]
    PointCount {
        /// x values given.
        x: usize,
        /// y values given.
        y: usize,
    },
    /// Too few points.
    #[error("{found} points, at least {least} needed")]
    TooFewPoints {
        /// Points given.
        found: usize,
        /// Fewest allowed.
        least: usize,
    },
    /// A point with a coordinate or value that is not finite.
    #[error("point {index} is not finite")]
    PointNumber {
        /// Which point, from 0.
        index: usize,
    },
    /// Point coordinates that do not increase.
    #[error("point {index} does not lie beyond the one before it")]
    PointOrder {
        /// Which point, from 0.
        index: usize,
    },
    /// A table whose matrix of values does not fit its stations.
    #[error("table is {rows} x {columns}, expected {} x {}", expected[0], expected[1])]
    TableShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
        /// Number of curves, and number of values of each.
        expected: [usize; 2],
    },
    /// A table entry that is not finite.
    #[error("table entry ({row}, {column}) is not finite")]
    TableNumber {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// A table reading without tables.
    #[error("a reading needs at least one table")]
    NoBlocks,
    /// A coupling between directions of which one has no table of its own.
    #[error("table {sheet} couples a direction that has no table of its own")]
    BlockAlone {
        /// Which table, from 0.
        sheet: usize,
    },
    /// A second table for the same pair of directions, or for the opposite pair.
    #[error("table {sheet} repeats the directions of another")]
    BlockTwice {
        /// Which table, from 0.
        sheet: usize,
    },
    /// Stations that differ from those of the direction's own table.
    #[error("the stations of table {sheet} differ between its directions' tables")]
    BlockStations {
        /// Which table, from 0.
        sheet: usize,
    },
    /// An influence coefficient that is infinite or not a number.
    #[error("no finite coefficient for a load at {x} and a deflection at {z}")]
    Coefficient {
        /// Coordinate of the load.
        x: f64,
        /// Coordinate at which the deflection is taken.
        z: f64,
    },
    /// The tolerance is not reached with the largest number of stations allowed.
    #[error("{most} stations give an error of {error:e}, which exceeds the tolerance")]
    TooFewStations {
        /// Largest number of stations allowed.
        most: usize,
        /// Relative error with that many.
        error: f64,
    },
    /// A tolerance that is negative, infinite or not a number.
    #[error("tolerance {tolerance} is not a finite number of zero or more")]
    Tolerance {
        /// The tolerance given.
        tolerance: f64,
    },
    /// A table that no uniform beam with supports at its stations can have.
    #[error("the table fits no uniform beam with supports at its stations")]
    NoBeamFit,
}
