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

pub use build::{adm, data_set};
pub use deviation::Deviation;
pub use digits::{Rounding, Unrounded, round};
pub use expand::expand;
pub use factor::{Factoring, Unfactored, factor};
pub use format::{Contents, Format, contents, is_tables, read, write};
pub use only::only;
pub use product::Product;
pub use set::{Table, TableSet};
