//! Memory that a result needs, predicted before it is allocated.

use crate::error::{Error, Quantity};

/// Most bytes that one factor, grid or surface may take.
pub const MEMORY: u64 = 8 << 30;

/// Refuses `count` numbers of `size` bytes each if together they exceed [`MEMORY`].
pub(crate) fn allow(quantity: Quantity, count: u64, size: u64) -> Result<(), Error> {
    let bytes = count.saturating_mul(size);
    if bytes <= MEMORY { Ok(()) } else { Err(Error::Memory { quantity, bytes, most: MEMORY }) }
}

/// Refuses a matrix of n x n doubles if it exceeds [`MEMORY`].
pub(crate) fn allow_square(quantity: Quantity, n: usize) -> Result<(), Error> {
    let n = n as u64;
    allow(quantity, n.saturating_mul(n), size_of::<f64>() as u64)
}

#[cfg(test)]
mod tests {
    use super::{MEMORY, allow_square};
    use crate::error::{Error, Quantity};

    #[test]
    fn more_than_is_allowed_is_refused_with_its_size() {
        assert_eq!(allow_square(Quantity::Surface, 32_768), Ok(()));
        let bytes = 8 * 32_769 * 32_769;
        let refused = Error::Memory { quantity: Quantity::Surface, bytes, most: MEMORY };
        assert_eq!(allow_square(Quantity::Surface, 32_769), Err(refused));
        assert!(allow_square(Quantity::Grid, usize::MAX).is_err());
    }
}
