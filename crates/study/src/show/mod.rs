//! A study as data and as pictures.

pub(crate) mod data;
pub(crate) mod picture;
