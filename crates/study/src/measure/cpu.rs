//! Thread time.

use std::ops::ControlFlow;

/// Thread time, s, since an arbitrary instant: time that other jobs of the machine take does not count.
#[cfg(unix)]
#[must_use]
pub fn seconds() -> f64 {
    use rustix::time::{ClockId, clock_gettime};
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// Time, s, since the first call, on systems without a clock for threads.
#[cfg(not(unix))]
#[must_use]
pub fn seconds() -> f64 {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed().as_secs_f64()
}

/// Runs `job` with a callback that stops it once this thread has worked for `limit` seconds.
pub fn limited<T>(limit: f64, job: impl FnOnce(&mut dyn FnMut(f64) -> ControlFlow<()>) -> T) -> T {
    let start = seconds();
    job(&mut |_| if seconds() - start > limit { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
}
