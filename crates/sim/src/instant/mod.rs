//! Solutions at one instant: static equilibrium, the active contacts, contact forces at given states, and natural
//! modes.
//!
//! This module depends on `contact` and, for the energies of natural modes, on `record`.

pub(crate) mod balance;
pub(crate) mod contact_forces;
pub(crate) mod equilibrium;
pub(crate) mod hang;
pub(crate) mod natural;
pub(crate) mod rates;
pub(crate) mod settle;
pub(crate) mod springs;
pub(crate) mod uneven;
