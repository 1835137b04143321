//! Memory that a run takes: bytes that its thread asks the allocator for.
//!
//! Counted where the program is built with the feature `memory`, as it is by default.

/// Bytes that a setting takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// What its foundations hold: surfaces, tables, modes.
    pub foundations: u64,
    /// The most that a run held beyond them, its history among it.
    pub run: u64,
}

impl Memory {
    /// All of it.
    #[must_use]
    pub fn total(self) -> u64 {
        self.foundations + self.run
    }
}

/// What came of a job, with the bytes that it still holds, and the most that it held at once; none where nobody counts.
pub struct AllocationCount<T> {
    /// What it gave.
    pub out: T,
    /// Bytes of it.
    pub retained: Option<u64>,
    /// The most at once.
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

/// Counts nothing.
#[cfg(not(feature = "memory"))]
pub fn held<T>(job: impl FnOnce() -> T) -> AllocationCount<T> {
    AllocationCount { out: job(), kept: None, most: None }
}

#[cfg(all(test, feature = "memory"))]
mod tests {
    use super::count_allocations;

    #[test]
    fn what_is_kept_and_what_was_held_at_once_are_told() {
        let found = count_allocations(|| {
            drop(vec![0_u8; 5000]);
            vec![0_u8; 1000]
        });
        assert_eq!((found.out.len(), found.retained, found.peak), (1000, Some(1000), Some(5000)));
    }
}
