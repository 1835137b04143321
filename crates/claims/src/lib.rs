//! Figures of others beside ours.
//!
//! Tests assert a [`Figure`]; where the environment names a folder in [`FOLDER`] they also leave a line there for the book.
//! [`pages`] makes the generated parts of the book from data that are kept in `docs/`. For development alone: no part of
//! the program depends on it.

mod bench;
mod book;
mod collect;
mod error;
mod excerpt;
mod figure;
mod figures;
mod file;
mod map;
mod maps;
mod number;
mod origin;
mod peers;
mod program;
mod record;
mod roll;
mod sheets;
mod study;
mod times;

pub use bench::{Bench, Known, Sitting, date, divan, machine, table};
pub use book::{Page, pages};
pub use collect::{collect, programs};
pub use error::Error;
pub use excerpt::{LARGEST, charts, excerpt};
pub use figure::{FOLDER, Figure, figure};
pub use file::{folder, json, text};
pub use map::{FILE as MAPS, Finding, Map, Maps, Message, Method, Sums, excerpt as maps};
pub use number::{number, percent, time};
pub use program::{Program, benches, built};
pub use record::{Record, Verdict};
