//! Figures of others beside ours.
//!
//! Tests assert a [`Figure`]; where the environment names a folder in [`FOLDER`] they also leave a line there for the book.
//! [`pages`] makes the generated parts of the book from data that are kept in `docs/`. For development alone: no part of
//! the program depends on it.

mod book;
mod collect;
mod figure;
mod number;
mod peers;
mod record;
mod study;

pub use book::{Error, Page, pages};
pub use collect::{collect, excerpt, programs};
pub use figure::{FOLDER, Figure, figure};
pub use number::{number, percent};
pub use record::{Record, Verdict};
