//! Tables as archives of numpy arrays.
//!
//! | array | content |
//! |---|---|
//! | `name`, `units` | name of the structure; words of the units of length, force and time |
//! | `stations` | x and z of every plain table; if they differ, `K_x` and `K_z` of table K |
//! | `tables`, `ids`, `names` | keys K of the plain tables, their numbers and names |
//! | `quantity`, `rail`, `load_rail` | quantities and rails of the plain tables, if known |
//! | K | a table: a row for each z, a column for each x |
//! | `curves` | keys C of the tables of one curve |
//! | C | curves: a row for each station, a column for each curve |
//! | `C_x`, `C_ids`, `C_names` | stations, numbers and names of the curves in C |
//! | `products`, `expressions` | keys P of the products of the factored form, and their ADAMS expressions |
//! | `P_terms` | a row for each term: the numbers of its curve over x and its curve over z |

mod archive;
mod array;
mod header;
mod keys;
mod pack;
mod reader;
mod writer;

pub(super) use reader::read;
pub(super) use writer::write;
