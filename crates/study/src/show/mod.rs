//! Output of a study: data files and charts.

pub(crate) mod data;
pub(crate) mod figure;
