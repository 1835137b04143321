//! Memory that a run takes, counted as the bytes that its thread requests from the allocator.
//!
//! Allocations are counted where the crate is built with the feature `memory`, as it is by default.

/// Bytes that a setting takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Bytes of its foundations: surfaces, tables, modes.
    pub foundations: u64,
    /// Largest number of bytes that a run held at once beyond these, its history included.
    pub run: u64,
}

impl Memory {
    /// Foundations and run together.
    #[must_use]
    pub fn total(self) -> u64 {
        self.foundations + self.run
    }
}

/// The result of a job with the bytes that it allocated; `None` where allocations are not counted.
pub struct AllocationCount<T> {
    /// The result of the job.
    pub out: T,
    /// Bytes that the result occupies.
    pub retained: Option<u64>,
    /// Largest number of bytes that were held at once.
    pub peak: Option<u64>,
}

/// Counts what `job` allocates on this thread.
#[cfg(feature = "memory")]
pub fn count_allocations<T>(job: impl FnOnce() -> T) -> AllocationCount<T> {
    let mut out = None;
    let info = allocation_counter::measure(|| out = Some(job()));
    AllocationCount {
        out: out.expect("the job ran"),
        retained: u64::try_from(info.bytes_current).ok(),
        peak: Some(info.bytes_max),
    }
}

/// Runs `job` without counting.
#[cfg(not(feature = "memory"))]
pub fn count_allocations<T>(job: impl FnOnce() -> T) -> AllocationCount<T> {
    AllocationCount {
        out: job(),
        retained: None,
        peak: None,
    }
}

#[cfg(all(test, feature = "memory"))]
mod tests {
    use super::count_allocations;

    #[test]
    fn retained_and_peak_bytes_are_counted() {
        let counted = count_allocations(|| {
            drop(vec![0_u8; 5000]);
            vec![0_u8; 1000]
        });
        assert_eq!(
            (counted.out.len(), counted.retained, counted.peak),
            (1000, Some(1000), Some(5000))
        );
    }
}
