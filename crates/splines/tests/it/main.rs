//! Tests of the crate `splines` through its public interface, one executable.

mod accuracy;
mod beam;
mod beam_column;
mod carriers;
mod check;
mod definite;
mod factored;
mod groups;
mod interior;
mod jets;
mod lift;
mod parted;
mod places;
mod readings;
mod rest;
mod sizes;
mod stations;
mod surface;
mod varying;
mod well;
