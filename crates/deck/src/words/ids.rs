//! Identifiers of the statements, unique within each kind.

/// The VARIABLEs of a wheel; the value of a variant is the last two digits of the identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableSlot {
    /// Rail coordinate of the wheel.
    Place = 1,
    /// Vertical displacement of the rail under the wheel, up.
    Rise = 2,
    /// Lateral displacement of the rail under the wheel.
    Shift = 3,
    /// Penetration of a contact; at the first wheel of the contact.
    Penetration = 4,
    /// Downward force of each wheel of a contact on the rail; at the first wheel of the contact.
    Press = 5,
    /// Lateral displacement of the wheel's contact from the rail.
    Sideways = 6,
    /// Flange force on the rail.
    Flange = 7,
    /// Friction on the rail, +x.
    Traction = 8,
    /// Component of the vertical force along the rail due to the slope of the deflected rail.
    Slope = 9,
    /// Component of the flange force along the rail due to the lateral slope of the deflected rail.
    Tilt = 10,
}

/// Identifier of a VARIABLE of wheel `wheel`, counted from 0.
#[must_use]
pub fn variable(wheel: usize, slot: VariableSlot) -> u32 {
    100 * number(wheel) + slot as u32
}

/// Identifier of the VARIABLE of product `k` of factor `factor`, both counted from 0.
#[must_use]
pub fn product(factor: usize, k: usize) -> u32 {
    1_000_000 * number(factor) + number(k)
}

/// The identifier of an index; identifiers are counted from 1.
#[must_use]
pub fn number(index: usize) -> u32 {
    u32::try_from(index)
        .unwrap_or(u32::MAX - 1)
        .saturating_add(1)
}

/// Generator of successive identifiers.
#[derive(Clone, Copy, Debug)]
pub struct NextId(u32);

impl NextId {
    /// The identifiers from `first` on.
    #[must_use]
    pub const fn from(first: u32) -> NextId {
        NextId(first)
    }

    /// The next identifier.
    pub fn take(&mut self) -> u32 {
        let id = self.0;
        self.0 = id.saturating_add(1);
        id
    }
}
