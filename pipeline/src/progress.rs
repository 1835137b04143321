//! Progress messages and, on a terminal, progress bars; both are written to standard error.

use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};

use formats::text::diagnostic::plain;
use formats::text::inputs::Inputs;
use study::{Observer, Steps};

use crate::cli::Global;

/// Time between two drawings of a bar.
const TICK: Duration = Duration::from_millis(200);

/// Output of messages and progress bars to standard error.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    speaks: bool,
    draws: bool,
}

impl Progress {
    /// Creates the output according to the flags: it is silent with `--quiet` and with `--json`.
    #[must_use]
    pub fn new(global: Global) -> Progress {
        let speaks = !global.quiet && !global.json;
        Progress {
            speaks,
            draws: speaks && std::io::stderr().is_terminal(),
        }
    }

    /// Whether lines are written.
    #[must_use]
    pub const fn speaks(&self) -> bool {
        self.speaks
    }

    /// Writes a line.
    pub fn say(&self, message: &str) {
        if self.speaks {
            // an error of writing is ignored: standard error may be closed
            let _ = writeln!(std::io::stderr(), "{}", plain(message));
        }
    }

    /// Writes a line for each number of the input files that was probably meant with a decimal comma.
    pub fn warn_of_commas(&self, inputs: &Inputs) {
        for found in inputs.decimal_commas() {
            self.say(&format!("warning: {found}"));
        }
    }

    /// Shows a stage on a terminal until the returned value is dropped.
    #[must_use]
    pub fn stage(&self, message: &str) -> Bar {
        let bar = self.shown(ProgressBar::new_spinner);
        bar.without_end("");
        bar.name(message);
        bar
    }

    /// Shows a bar of `length` steps on a terminal until the returned value is dropped.
    #[must_use]
    pub fn bar(&self, message: &str, length: u64) -> Bar {
        let bar = self.shown(|| ProgressBar::new(length));
        bar.set_style_with_end();
        bar.name(message);
        bar
    }

    /// A bar on a terminal; elsewhere one that shows nothing.
    fn shown(&self, make: impl FnOnce() -> ProgressBar) -> Bar {
        let bar = self.draws.then(make);
        if let Some(bar) = &bar {
            // the times go on between two steps
            bar.enable_steady_tick(TICK);
        }
        Bar {
            bar,
            has_end: AtomicBool::new(true),
        }
    }
}

/// The time left, in a form such as `, 12s remaining`; nothing before the first step, which alone tells how long a step
/// takes.
fn left(state: &ProgressState, out: &mut dyn std::fmt::Write) {
    if state.pos() > 0 {
        // writing to the text of a bar does not fail
        let _ = write!(out, ", {:#} remaining", HumanDuration(state.eta()));
    }
}

/// A progress bar or a stage on the terminal.
#[derive(Debug)]
pub struct Bar {
    /// Nothing where nothing is drawn: a run tells its progress many thousand times.
    bar: Option<ProgressBar>,
    /// Whether it shows how far the work is.
    has_end: AtomicBool,
}

impl Bar {
    /// Shows a bar with the fraction that is done.
    fn set_style_with_end(&self) {
        let Some(bar) = &self.bar else { return };
        if let Ok(style) =
            ProgressStyle::with_template("{msg} [{bar:40}] {percent}%, {elapsed} elapsed{left}")
        {
            bar.set_style(style.progress_chars("=> ").with_key("left", left));
        }
    }

    /// Shows that the work goes on, without a fraction, until the bar is moved again; `what` follows the message.
    pub fn without_end(&self, what: &str) {
        let Some(bar) = self
            .bar
            .as_ref()
            .filter(|_| self.has_end.swap(false, Ordering::Relaxed))
        else {
            return;
        };
        let template = format!("{{spinner}} {{msg}}{what}, {{elapsed}} elapsed");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
    }

    /// Moves a bar to `position`.
    pub fn set(&self, position: u64) {
        let Some(bar) = &self.bar else { return };
        if !self.has_end.swap(true, Ordering::Relaxed) {
            self.set_style_with_end();
        }
        bar.set_position(position);
    }

    /// Moves a bar to `position` of `length`.
    pub fn set_of(&self, position: u64, length: u64) {
        if let Some(bar) = &self.bar {
            bar.set_length(length);
        }
        self.set(position);
    }

    /// Changes the message of a bar.
    pub fn name(&self, message: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(plain(message));
        }
    }
}

impl Observer for Progress {
    fn message(&self, message: &str) {
        Progress::say(self, message);
    }

    fn begin(&self, message: &str, steps: u64) -> Box<dyn Steps> {
        Box::new(self.bar(message, steps))
    }
}

impl Steps for Bar {
    fn advance_to(&self, step: u64) {
        self.set(step);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
