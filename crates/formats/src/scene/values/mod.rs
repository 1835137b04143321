//! The content of a checked scene: plain values in the units of the scene, with names resolved to indices.

pub mod actuator;
pub mod body;
pub mod output;
pub mod practice;
pub mod scene;
pub mod structure;
pub mod truck;
pub mod wheel;
