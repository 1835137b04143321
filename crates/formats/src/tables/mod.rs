//! Reading and writing files of influence tables.
//!
//! A [`TableSet`] is the content of a file in any format. [`read()`] and [`write()`] select the format by the
//! extension of the file name. The modules from low to high are the tables (`set`), the content of a file before
//! completion (`parsed`, `defect`), the formats (`adm`, `view`, `csv`, `json`, `npz`), the factored form (`factored`)
//! and rounding (`round`), and the selection of the format (`format`).

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
