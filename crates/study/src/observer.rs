//! What a study tells while it works.

/// Hears of the progress of a study; the command line shows it.
pub trait Observer {
    /// One line of news.
    fn say(&self, message: &str);

    /// Work of `steps` steps begins; it is over when the answer is dropped.
    fn begin(&self, message: &str, steps: u64) -> Box<dyn Steps>;
}

/// Work in steps that is under way.
pub trait Steps {
    /// `step` steps are done.
    fn reach(&self, step: u64);
}

/// Hears nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn say(&self, _: &str) {}

    fn begin(&self, _: &str, _: u64) -> Box<dyn Steps> {
        Box::new(Silent)
    }
}

impl Steps for Silent {
    fn reach(&self, _: u64) {}
}
