//! What a scene holds: plain values, checked, in the scene's units, names resolved to indices.

pub mod actuator;
pub mod body;
pub mod output;
pub mod practice;
pub mod scene;
pub mod structure;
pub mod truck;
pub mod wheel;
