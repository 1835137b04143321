//! What the program says when the user stops it with Ctrl-C.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Exit status of a program that was stopped by the keyboard: 128 and the number of the signal.
const STOPPED: i32 = 130;

/// The output folder in which the program is at work, if any, and whether it keeps the runs of a sweep.
static FOLDER: Mutex<Option<(PathBuf, bool)>> = Mutex::new(None);

/// From now on a stop leaves the journal of a run in `folder`; `None`: it leaves nothing.
pub(crate) fn leaves(folder: Option<&Path>) {
    *FOLDER.lock().unwrap_or_else(PoisonError::into_inner) = folder.map(|folder| (folder.to_owned(), false));
}

/// From now on a stop leaves the runs of a sweep in `folder`.
pub(crate) fn leaves_runs(folder: &Path) {
    *FOLDER.lock().unwrap_or_else(PoisonError::into_inner) = Some((folder.to_owned(), true));
}

/// What a stop leaves, in a sentence.
fn left() -> String {
    let folder = FOLDER.lock().unwrap_or_else(PoisonError::into_inner);
    match folder.as_ref() {
        Some((folder, true)) => format!(
            "girderway: stopped; the runs that are made are kept in {}; the same command resumes there\n",
            folder.display()
        ),
        None => "girderway: stopped; no file was written or changed\n".to_owned(),
        Some((folder, false)) => format!(
            "girderway: stopped; every file in {} is whole, those of an earlier result included; the next run there \
             clears what this one has left\n",
            folder.display()
        ),
    }
}

/// Makes Ctrl-C end the program with a sentence on what it leaves. Where the system refuses, Ctrl-C ends it in silence.
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        use std::io::Write;
        let _ = std::io::stderr().write_all(left().as_bytes());
        std::process::exit(STOPPED);
    });
}
