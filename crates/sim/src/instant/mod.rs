//! One instant solved: static equilibrium, which contacts act, contact forces at given states, natural modes.
//!
//! It stands on `contact` and, for the energies of natural modes, on `record`.

pub(crate) mod contact_forces;
pub(crate) mod equilibrium;
pub(crate) mod hang;
pub(crate) mod natural;
pub(crate) mod rates;
pub(crate) mod settle;
pub(crate) mod uneven;
