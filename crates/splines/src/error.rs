//! What can go wrong along a rail.

use crate::Axis;

/// Errors of this crate: ids and numbers; the caller knows the names and files.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A rail index that no cell has.
    #[error("rail {rail} does not exist")]
    NoRail {
        /// The index asked for.
        rail: usize,
    },
    /// A coordinate that no cell of the rail covers.
    #[error("rail {rail} has no cell at x = {x}")]
    OffRail {
        /// Which rail.
        rail: usize,
        /// The coordinate asked for.
        x: f64,
    },
    /// A direction in which the structure has no stiffness there.
    #[error("nothing resists a {axis:?} force on rail {rail} at x = {x}")]
    Unstiffened {
        /// Which rail.
        rail: usize,
        /// The coordinate asked for.
        x: f64,
        /// The direction asked for.
        axis: Axis,
    },
    /// A line without cells.
    #[error("a line needs at least one cell")]
    NoCells,
    /// A coordinate or offset that is not finite, or a state index beyond all reason.
    #[error("cell {cell} has a number that cannot be used")]
    CellNumber {
        /// Index of the cell.
        cell: usize,
    },
    /// Coordinates that do not increase.
    #[error("cell {cell} runs from x = {} to {}", x[0], x[1])]
    CellExtent {
        /// Index of the cell.
        cell: usize,
        /// Its coordinates.
        x: [f64; 2],
    },
    /// A length that is not positive.
    #[error("cell {cell} has length {length}")]
    CellLength {
        /// Index of the cell.
        cell: usize,
        /// Its length.
        length: f64,
    },
    /// A frame that is not a rotation.
    #[error("the frame of cell {cell} is not a rotation")]
    CellFrame {
        /// Index of the cell.
        cell: usize,
    },
    /// A negative flexibility, or one that is not a number.
    #[error("cell {cell} has a negative flexibility")]
    CellFlexibility {
        /// Index of the cell.
        cell: usize,
    },
    /// Cells of one member that differ in length or flexibility.
    #[error("cells {first} and {second} of one member differ in length or flexibility")]
    CellCarrier {
        /// Index of the first cell of the member.
        first: usize,
        /// Index of the cell that differs.
        second: usize,
    },
    /// Two cells that claim the same place.
    #[error("cells {first} and {second} of rail {rail} overlap at x = {x}")]
    Overlap {
        /// Which rail.
        rail: usize,
        /// Index of the cell that begins earlier.
        first: usize,
        /// Index of the cell that begins later.
        second: usize,
        /// Where the later one begins.
        x: f64,
    },
    /// A nodal compliance that does not fit the states.
    #[error("nodal compliance is {rows} x {columns}, expected {expected} x {expected}")]
    NodalShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
        /// Six freedoms a state.
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
    /// Effects of another shape than what they belong to.
    #[error("effects are {rows} x {columns}, expected {} x {}", expected[0], expected[1])]
    EffectShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
        /// Effects, and six freedoms a state.
        expected: [usize; 2],
    },
    /// An effect with a number that cannot be used.
    #[error("effect {effect} has a number that cannot be used")]
    EffectNumber {
        /// Index of the effect.
        effect: usize,
    },
    /// An influence matrix of another size than the probes.
    #[error("influence matrices are {rows} x {columns}, expected {expected} x {expected}")]
    OutputShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
        /// Number of probes.
        expected: usize,
    },
    /// Not as many y as x.
    #[error("{x} x values, {y} y values")]
    PointCount {
        /// x values given.
        x: usize,
        /// y values given.
        y: usize,
    },
    /// Too few points.
    #[error("{found} points, at least {least} needed")]
    Points {
        /// Points given.
        found: usize,
        /// Fewest that will do.
        least: usize,
    },
    /// A point that is not finite.
    #[error("point {index} is not finite")]
    PointNumber {
        /// Which point, from 0.
        index: usize,
    },
    /// Coordinates that do not increase.
    #[error("point {index} does not lie beyond the one before it")]
    PointOrder {
        /// Which point, from 0.
        index: usize,
    },
    /// A table whose values do not fit its stations.
    #[error("table is {rows} x {columns}, expected {} x {}", expected[0], expected[1])]
    TableShape {
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
        /// Curves, and values a curve.
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
    /// A reading without tables.
    #[error("a reading needs at least one table")]
    NoSheets,
    /// A coupling between directions that have no table of their own.
    #[error("table {sheet} couples a direction that has no table of its own")]
    SheetAlone {
        /// Which table, from 0.
        sheet: usize,
    },
    /// A second table for the same pair of directions.
    #[error("table {sheet} repeats the directions of another")]
    SheetTwice {
        /// Which table, from 0.
        sheet: usize,
    },
    /// Stations that differ from those of the direction's own table.
    #[error("the stations of table {sheet} differ between its directions' tables")]
    SheetStations {
        /// Which table, from 0.
        sheet: usize,
    },
    /// A coefficient that is infinite or not a number.
    #[error("no finite coefficient for a load at {x} and a deflection at {z}")]
    Coefficient {
        /// Where the load stands.
        x: f64,
        /// Where the deflection is taken.
        z: f64,
    },
    /// A tolerance that no number of stations meets, up to the most allowed.
    #[error("{most} stations give an error of {error:e}, more than asked")]
    Stations {
        /// The most stations allowed.
        most: usize,
        /// Their relative error.
        error: f64,
    },
    /// A tolerance that is negative or not a number.
    #[error("tolerance {tolerance} is not a positive number")]
    Tolerance {
        /// What was given.
        tolerance: f64,
    },
    /// A table that belongs to no uniform beam on knife edges at its stations.
    #[error("table belongs to no uniform beam on knife edges at its stations")]
    Unliftable,
}
