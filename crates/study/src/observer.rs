//! Progress messages of a study.

/// Receives the progress of a study; the command line shows it.
pub trait Observer {
    /// A message of one line.
    fn message(&self, message: &str);

    /// Work of `steps` steps begins; it ends when the returned value is dropped.
    fn begin(&self, message: &str, steps: u64) -> Box<dyn Steps>;
}

/// The progress of work in steps.
pub trait Steps {
    /// `step` steps are complete.
    fn advance_to(&self, step: u64);
}

/// An observer that ignores all messages.
#[derive(Clone, Copy, Debug, Default)]
pub struct SilentObserver;

impl Observer for SilentObserver {
    fn message(&self, _: &str) {}

    fn begin(&self, _: &str, _: u64) -> Box<dyn Steps> {
        Box::new(SilentObserver)
    }
}

impl Steps for SilentObserver {
    fn advance_to(&self, _: u64) {}
}
