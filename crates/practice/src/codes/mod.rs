//! Values of codes: EN 1991-3, CMAA 70, AIST TR-13, 29 CFR 1910.179 and FEM 1.001.
//!
//! `crane` has the static wheel loads from which the others start. `factor`, `drive`, `skew`, `buffer` and
//! `duty` are the chapters of EN 1991-3; `cmaa`, `aist` and `osha` are one document each.

pub mod aist;
pub mod buffer;
pub mod cmaa;
pub mod crane;
pub mod drive;
pub mod duty;
pub mod factor;
pub mod osha;
pub mod skew;
