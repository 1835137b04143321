//! A figure known from elsewhere, to be met by ours.

use std::fs::OpenOptions;
use std::io::Write;
use std::panic::Location;
use std::path::PathBuf;

use crate::record::{Record, Verdict};

/// Environment variable that names the folder for what tests find.
pub const FOLDER: &str = "GIRDERWAY_CLAIMS";

/// A figure known from elsewhere.
#[derive(Clone, Debug)]
#[must_use]
pub struct Figure {
    section: String,
    what: String,
    known: f64,
    source: String,
}

/// The figure `known` of `what` (with its unit), from `source`, for `section` of the book.
pub fn figure(
    section: impl Into<String>,
    what: impl Into<String>,
    source: impl Into<String>,
    known: f64,
) -> Figure {
    Figure { section: section.into(), what: what.into(), known, source: source.into() }
}

impl Figure {
    /// Ours meets it within `within` of it.
    ///
    /// # Panics
    /// Where it does not.
    #[track_caller]
    pub fn met(self, ours: f64, within: f64) {
        let apart = (ours - self.known).abs();
        let fits = apart <= within * self.known.abs();
        self.keep(ours, within, Verdict::Met, "");
        assert!(fits, "{}: {}: {ours:e} for {:e}, {within:e}", self.section, self.what, self.known);
    }

    /// Ours is at most that.
    ///
    /// # Panics
    /// Where it is more, or no number.
    #[track_caller]
    pub fn below(self, ours: f64) {
        let fits = ours <= self.known;
        self.keep(ours, 0.0, Verdict::Below, "");
        assert!(fits, "{}: {}: {ours:e} above {:e}", self.section, self.what, self.known);
    }

    /// Ours is not that but `own`, within `within` of it; `why` says why it is trusted.
    ///
    /// # Panics
    /// Where ours is not `own`.
    #[track_caller]
    pub fn corrected(self, ours: f64, own: f64, within: f64, why: &str) {
        let fits = (ours - own).abs() <= within * own.abs();
        self.keep(ours, within, Verdict::Corrected, why);
        assert!(fits, "{}: {}: {ours:e} for our own {own:e}, {within:e}", self.section, self.what);
    }

    /// Tells the test's output, and leaves a line where one is asked for.
    #[track_caller]
    #[allow(clippy::print_stdout, reason = "tests say what they found")]
    fn keep(&self, ours: f64, within: f64, verdict: Verdict, why: &str) {
        println!("{}: {}: {ours:e} for {:e}", self.section, self.what, self.known);
        let Some(folder) = std::env::var_os(FOLDER) else { return };
        // a test's thread is named after it
        let thread = std::thread::current();
        let record = Record {
            section: self.section.clone(),
            what: self.what.clone(),
            known: self.known,
            source: self.source.clone(),
            ours,
            within,
            verdict,
            why: why.to_owned(),
            file: file(Location::caller().file()),
            test: thread.name().unwrap_or_default().to_owned(),
        };
        let program = std::env::current_exe().ok();
        let stem = program.as_deref().and_then(|path| path.file_stem()).unwrap_or_default();
        let path = PathBuf::from(folder).join(stem).with_extension("jsonl");
        let line = serde_json::to_string(&record).map(|line| line + "\n").unwrap_or_default();
        let kept = OpenOptions::new().create(true).append(true).open(&path);
        let kept = kept.and_then(|mut file| file.write_all(line.as_bytes()));
        assert!(kept.is_ok(), "{}: {kept:?}", path.display());
    }
}

/// Path of a source file from the root of the repository.
fn file(path: &str) -> String {
    let path = path.replace('\\', "/");
    let parts: Vec<&str> = path.split('/').filter(|part| *part != ".").collect();
    let mut kept: Vec<&str> = Vec::new();
    for part in parts {
        match part {
            ".." => {
                kept.pop();
            }
            _ => kept.push(part),
        }
    }
    kept.join("/")
}

#[cfg(test)]
mod tests {
    use super::{figure, file};

    #[test]
    fn figures_are_met_or_not() {
        figure("s", "w", "by hand", 2.0).met(2.02, 0.011);
        figure("s", "w", "by hand", 2.0).below(1.0);
        figure("s", "w", "by hand", 2.0).corrected(3.0, 3.0, 0.0, "counted");
        let fails = |job: fn()| std::panic::catch_unwind(job).is_err();
        assert!(fails(|| figure("s", "w", "by hand", 2.0).met(2.1, 0.01)));
        assert!(fails(|| figure("s", "w", "by hand", 2.0).met(f64::NAN, 0.01)));
        assert!(fails(|| figure("s", "w", "by hand", 2.0).below(f64::NAN)));
        assert!(fails(|| figure("s", "w", "by hand", 2.0).corrected(2.0, 3.0, 0.1, "counted")));
    }

    #[test]
    fn files_are_named_from_the_root() {
        assert_eq!(file("pipeline/../tests/study/main.rs"), "tests/study/main.rs");
        assert_eq!(file("crates/sim/tests/well.rs"), "crates/sim/tests/well.rs");
    }
}
