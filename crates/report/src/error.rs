//! Errors of reports.

/// Why a report cannot be written. Indices of sections and their parts count from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A fact is infinite or not a number.
    #[error("fact {fact} of section {section} is not finite")]
    Fact {
        /// Index of the section.
        section: usize,
        /// Index of the fact in it.
        fact: usize,
    },
    /// A number of a table is infinite or not a number.
    #[error("row {row}, column {column} in table {table} of section {section} is not finite")]
    Cell {
        /// Index of the section.
        section: usize,
        /// Index of the table in it.
        table: usize,
        /// Index of the row.
        row: usize,
        /// Index of the column.
        column: usize,
    },
    /// The length of a row differs from the number of columns.
    #[error("row {row} in table {table} of section {section} has {found} cells, not {expected}")]
    Row {
        /// Index of the section.
        section: usize,
        /// Index of the table in it.
        table: usize,
        /// Index of the row.
        row: usize,
        /// Cells found.
        found: usize,
        /// Columns of the table.
        expected: usize,
    },
    /// A chart cannot be drawn.
    #[error("figure {figure} of section {section}: {source}")]
    Chart {
        /// Index of the section.
        section: usize,
        /// Index of the figure in it.
        figure: usize,
        /// The reason.
        source: crate::chart::Error,
    },
    /// A number of an animation is not finite.
    #[error("figure {figure} of section {section} moves by a number that is not finite")]
    Animation {
        /// Index of the section.
        section: usize,
        /// Index of the figure in it.
        figure: usize,
    },
}
