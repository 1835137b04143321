//! Thread time.

use std::ops::ControlFlow;
use std::time::Instant;

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
    START
        .get_or_init(std::time::Instant::now)
        .elapsed()
        .as_secs_f64()
}

/// Runs `job` with a callback that stops it once this thread has worked for `limit` seconds.
///
/// A thread works no longer than time passes. Its own clock, which takes a call of the system, is asked only when so much
/// time has passed that the limit may have been reached.
pub fn limited<T>(limit: f64, job: impl FnOnce(&mut dyn FnMut(f64) -> ControlFlow<()>) -> T) -> T {
    let (start, begun, mut due) = (seconds(), Instant::now(), limit);
    job(&mut |_| {
        let passed = begun.elapsed().as_secs_f64();
        if passed <= due {
            return ControlFlow::Continue(());
        }
        let left = limit - (seconds() - start);
        due = passed + left;
        if left < 0.0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })
}
