//! Long work without the lock of the interpreter, watched by the thread that called it.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use pyo3::prelude::*;
use results::threads::watched;

/// Time between two looks at signals, and between two calls of a progress function.
const INTERVAL: Duration = Duration::from_millis(20);

/// Parts of the fraction that is done.
const PARTS: f64 = 1e6;

/// State that the work and the thread that watches it share.
#[derive(Default)]
pub(crate) struct WorkState {
    is_stopped: AtomicBool,
    done: AtomicU64,
}

impl WorkState {
    /// Notes the fraction that is done, 0 to 1, and says whether to go on.
    pub(crate) fn advance(&self, fraction: f64) -> ControlFlow<()> {
        self.done
            .store((PARTS * fraction) as u64, Ordering::Relaxed);
        self.go_on()
    }

    /// Whether the caller wants the work to go on.
    pub(crate) fn go_on(&self) -> ControlFlow<()> {
        if self.is_stopped.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Performs `work` on another thread without the lock of the interpreter. Meanwhile this thread looks for Ctrl-C and
/// calls `progress` with the fraction that is done; an exception of either stops the work and is returned. The function
/// is called once more with 1 at the end.
pub(crate) fn without_lock<R: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&WorkState) -> R + Send,
) -> PyResult<R> {
    let state = WorkState::default();
    let progress = progress.map(|progress| progress.clone().unbind());
    if let Some(progress) = &progress {
        progress.call1(py, (0.0,))?;
    }
    let mut raised = None;
    let made = py.detach(|| {
        watched(
            INTERVAL,
            || work(&state),
            || {
                if raised.is_some() {
                    return;
                }
                let looked = Python::attach(|py| {
                    py.check_signals()?;
                    let fraction = state.done.load(Ordering::Relaxed) as f64 / PARTS;
                    progress.as_ref().map_or(Ok(()), |progress| {
                        progress.call1(py, (fraction,)).map(|_| ())
                    })
                });
                if let Err(error) = looked {
                    raised = Some(error);
                    state.is_stopped.store(true, Ordering::Relaxed);
                }
            },
        )
    });
    match raised {
        Some(error) => Err(error),
        None => {
            progress.map_or(Ok(()), |progress| progress.call1(py, (1.0,)).map(|_| ()))?;
            Ok(made)
        }
    }
}
