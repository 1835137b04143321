//! Tables as archives of numpy arrays.
//!
//! | array | what |
//! |---|---|
//! | `name`, `units` | of the structure; three words |
//! | `stations` | x and z of every plain table; where they differ, `K_x` and `K_z` of table K |
//! | `tables`, `ids`, `names` | keys K of the plain tables, their numbers and names |
//! | `quantity`, `rail`, `load_rail` | of the plain tables, where known |
//! | K | a table: row z, column x |
//! | `curves` | keys C of the one-curve tables; C is stations x curves |
//! | `C_x`, `C_ids`, `C_names` | stations, numbers and names of the curves in C |
//! | `products`, `expressions` | keys P of the factored form, and as ADAMS would be told |
//! | `P_terms` | numbers of the curves of each term: at x, at z |

mod archive;
mod array;
mod header;
mod keys;
mod pack;
mod reader;
mod writer;

pub(super) use reader::read;
pub(super) use writer::write;
