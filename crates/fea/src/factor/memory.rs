//! Memory that a result needs, predicted before it is allocated.

use crate::error::{EntryAttribute, Error};

/// Most bytes that one factor, grid or surface may take.
pub const MEMORY_LIMIT: u64 = 8 << 30;

/// Refuses `count` numbers of `size` bytes each if together they exceed [`MEMORY_LIMIT`].
pub(crate) fn allow(quantity: EntryAttribute, count: u64, size: u64) -> Result<(), Error> {
    let bytes = count.saturating_mul(size);
    if bytes <= MEMORY_LIMIT {
        Ok(())
    } else {
        Err(Error::Memory {
            quantity,
            bytes,
            most: MEMORY_LIMIT,
        })
    }
}

/// Refuses a matrix of n x n doubles if it exceeds [`MEMORY_LIMIT`].
pub(crate) fn allow_square(quantity: EntryAttribute, n: usize) -> Result<(), Error> {
    let n = n as u64;
    allow(quantity, n.saturating_mul(n), size_of::<f64>() as u64)
}

#[cfg(test)]
mod tests {
    use super::{MEMORY_LIMIT, allow_square};
    use crate::error::{EntryAttribute, Error};

    #[test]
    fn more_than_is_allowed_is_refused_with_its_size() {
        assert_eq!(allow_square(EntryAttribute::Surface, 32_768), Ok(()));
        let bytes = 8 * 32_769 * 32_769;
        let refused = Error::Memory {
            quantity: EntryAttribute::Surface,
            bytes,
            most: MEMORY_LIMIT,
        };
        assert_eq!(allow_square(EntryAttribute::Surface, 32_769), Err(refused));
        assert!(allow_square(EntryAttribute::Grid, usize::MAX).is_err());
    }
}
