//! Values of codes: EN 1991-3, EN 1993-6, CMAA 70, AIST TR-13, AISC Design Guide 7, ASCE 7, IS 800, 29 CFR 1910.179
//! and FEM 1.001.
//!
//! `clause` names the code, edition and clause of a value, and how the value was checked. `crane` has the static
//! wheel loads from which the others start. `factor`, `drive`, `skew`, `buffer` and `duty` are the chapters of EN
//! 1991-3; `cmaa`, `aist`, `asce` and `osha` are one document each. `limits` has the limits of deflections of all
//! codes, `limit_choice` chooses them by name, `combination` and `mill_combination` the groups of loads with their factors, `local_stress` the stresses
//! in the web under a wheel.

pub mod aist;
pub mod asce;
pub mod buffer;
pub mod clause;
pub mod cmaa;
pub mod combination;
pub mod crane;
pub mod drive;
pub mod duty;
pub mod factor;
pub mod limit_choice;
pub mod limits;
pub mod local_stress;
pub mod mill_combination;
pub mod osha;
pub mod scope;
pub mod skew;
