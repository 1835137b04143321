//! The Python package `girderway`: the libraries with numpy arrays, dictionaries and exceptions.
//!
//! The module `_native` has what needs Rust; the package in the folder `python` beside this one adds types, names and
//! notebooks. Columns of a run are moved into numpy once and handed out as views that cannot be written. The lock of
//! the interpreter is released while structures are solved, scenes run and files written.
//!
//! Wings, lowest first: convert, source, errors, watch, solved_design, structure, run, many, models

mod convert;
mod errors;
mod many;
mod models;
mod run;
mod solved_design;
mod source;
mod structure;
mod watch;

use pyo3::prelude::*;

/// The part of the package girderway that is written in Rust.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::many::run_many;
    #[pymodule_export]
    use super::models::import_model;
    #[pymodule_export]
    use super::run::{Run, run};
    #[pymodule_export]
    use super::solved_design::{Design, design};
    #[pymodule_export]
    use super::structure::{Modes, Structure};

    use super::*;

    /// Adds the version of the libraries.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
