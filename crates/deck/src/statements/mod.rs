//! The statements of a deck, one file per kind.

pub mod contact;
pub(crate) mod joints;
pub(crate) mod parts;
pub(crate) mod request;
pub(crate) mod solver;
