//! Conversion of a scene as written to a checked scene: one module for each kind of member, and `scene` for the
//! whole.

mod actuator;
mod body;
mod event;
mod files;
mod gauge;
mod inertia;
mod irregularity;
mod method;
mod mount;
mod output;
mod pin;
mod practice;
mod profile;
mod rail;
mod rope;
pub(super) mod scene;
mod schedule;
mod spin;
mod stop;
mod structure;
mod tables;
mod ties;
mod truck;
mod truck_spacing;
mod wheel;

pub(super) use files::Files;
