//! Memory that a run takes, as the program's allocator counts it.
//!
//! The counters belong to the process: what other threads take meanwhile counts too. Where the program did not install
//! the counting allocator, as in tests of the library, nothing is told.

use peak_alloc::PeakAlloc;

/// Bytes that a setting takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// What its foundations hold: surfaces, tables, modes.
    pub foundations: usize,
    /// The most that a run held beyond them, its history among it.
    pub run: usize,
}

impl Memory {
    /// All of it.
    #[must_use]
    pub fn total(self) -> usize {
        self.foundations + self.run
    }
}

/// What `job` gives, and how many bytes of it are still held; none where nobody counts.
pub fn kept<T>(job: impl FnOnce() -> T) -> (T, Option<usize>) {
    let before = PeakAlloc.current_usage();
    let out = job();
    let after = PeakAlloc.current_usage();
    (out, counts().then(|| after.saturating_sub(before)))
}

/// What `job` gives, and the most bytes that it held at once; none where nobody counts.
pub fn most<T>(job: impl FnOnce() -> T) -> (T, Option<usize>) {
    let before = PeakAlloc.current_usage();
    PeakAlloc.reset_peak_usage();
    let out = job();
    let peak = PeakAlloc.peak_usage();
    (out, counts().then(|| peak.saturating_sub(before)))
}

/// Whether the program counts what it takes.
fn counts() -> bool {
    PeakAlloc.peak_usage() > 0
}

#[cfg(test)]
mod tests {
    use super::{kept, most};

    #[test]
    fn where_nobody_counts_nothing_is_told() {
        assert_eq!(kept(|| vec![0_u8; 1000].len()), (1000, None));
        assert_eq!(most(|| 1), (1, None));
    }
}
