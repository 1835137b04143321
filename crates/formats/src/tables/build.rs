//! A grid's tables as an ADAMS data set.

use adams::Tables;

use super::set::TableSet;
use crate::grid::Grid;

/// The tables of a grid as SPLINE statements: those of [`TableSet::of_grid`].
#[must_use]
pub fn data_set(grid: &Grid) -> Tables {
    TableSet::of_grid(grid).adams()
}

/// The tables of a structure as the text of an ADAMS data set; `None` where no rail has the stations that a
/// SPLINE needs.
///
/// # Errors
/// More tables than identifiers.
pub fn adm(name: &str, grid: &Grid) -> Result<Option<String>, adams::Error> {
    let set = data_set(&Grid { name: name.to_owned(), ..grid.clone() });
    if set.splines.is_empty() { Ok(None) } else { adams::tables::write(&set).map(Some) }
}
