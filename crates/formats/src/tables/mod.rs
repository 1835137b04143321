//! Influence tables as files, both ways.
//!
//! A [`TableSet`] is what every format holds; [`read()`] and [`write()`] go by the ending of the file's name.

mod adm;
mod build;
mod csv;
mod deviation;
mod digits;
mod expand;
mod factor;
mod format;
mod json;
mod npz;
mod only;
mod product;
mod set;
mod units;
mod view;
mod wrong;

pub use self::csv::Columns;
pub use build::{adm, data_set};
pub use deviation::Deviation;
pub use digits::{Rounding, Unrounded, round};
pub use expand::expand;
pub use factor::{Factoring, Unfactored, factor};
pub use format::{Contents, Format, WriteError, contents, is_tables, read, write};
pub use only::only;
pub use product::Product;
pub use set::{Table, TableSet};

/// What is wrong with the last of these rows (x, value), where x must not fall and two rows at one x are a step.
pub(crate) fn disorder(rows: &[[f64; 2]]) -> Option<String> {
    match rows {
        [.., before, last] if last[0] < before[0] => {
            Some(format!("x must not fall: the row before is at {}", crate::fault::number(before[0])))
        }
        [.., first, _, last] if last[0] == first[0] => {
            Some("two rows at one x at most: they are a step".to_owned())
        }
        _ => None,
    }
}
