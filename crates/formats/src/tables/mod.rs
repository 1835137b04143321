//! Influence tables as files, written and read.
//!
//! A [`TableSet`] is what every format holds; [`read()`] and [`write()`] go by the ending of the file's name. From low
//! to high: the tables (`set`), what a file says of them (`parsed`, `defect`), the formats (`adm`, `view`, `csv`,
//! `json`, `npz`), the factored form (`factored`) and rounding (`round`), and the choice of the format (`format`).

mod adm;
mod csv;
mod defect;
mod factored;
mod format;
mod json;
mod npz;
mod parsed;
mod round;
mod set;
mod view;

pub use self::csv::CsvColumns;
pub use adm::{adm, data_set};
pub(crate) use defect::disorder;
pub use factored::{FactorError, FactoredTables, TableDeviation, expand, factor};
pub use format::{Contents, TableFormat, WriteError, contents, is_tables, read, write};
pub use round::{RoundError, Rounding, round};
pub use set::{Product, Table, TableSet, select};
