//! What the program says when the user stops it with Ctrl-C.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use outputs::journal::{folder_at_work, would_resume};

/// Exit status of a program that was stopped by the keyboard: 128 and the number of the signal.
const STOPPED: i32 = 130;

/// Files outside of output folders that this command has written while it goes on.
static WRITTEN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Writes files after which the command goes on. A stop waits until they are complete, and then names them.
///
/// # Errors
/// The error of `write`; the files are then not named.
pub fn writing<E>(files: &[&Path], write: impl FnOnce() -> Result<(), E>) -> Result<(), E> {
    let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    write()?;
    written.extend(files.iter().map(|path| (*path).to_owned()));
    Ok(())
}

/// What a stop leaves if no output folder is at work.
fn left_files(written: &[PathBuf]) -> String {
    let names: Vec<String> = written
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    match &names[..] {
        [] => "girderway: interrupted; no files were written or changed\n".to_owned(),
        [one] => format!("girderway: interrupted; {one} is written; no other files were changed\n"),
        [first @ .., last] => format!(
            "girderway: interrupted; {} and {last} are written; no other files were changed\n",
            first.join(", ")
        ),
    }
}

/// What a stop leaves, in a sentence.
fn left() -> String {
    match folder_at_work() {
        None => left_files(&WRITTEN.lock().unwrap_or_else(PoisonError::into_inner)),
        Some(folder) if would_resume() => format!(
            "girderway: interrupted; finished runs are saved in {}; repeat the command to resume\n",
            folder.display()
        ),
        Some(folder) => format!(
            "girderway: interrupted; all files in {} are complete, including those of an earlier result; the next run \
             there removes temporary files\n",
            folder.display()
        ),
    }
}

/// Makes Ctrl-C end the program with a sentence on what it leaves. Where the system refuses, Ctrl-C ends it in silence.
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        use std::io::{IsTerminal, Write};
        let mut out = std::io::stderr();
        // the sentence stands in place of a progress bar, not behind it
        let clear = if out.is_terminal() { "\r\x1b[2K" } else { "" };
        let _ = out.write_all(format!("{clear}{}", left()).as_bytes());
        std::process::exit(STOPPED);
    });
}

#[cfg(test)]
mod tests {
    use super::left_files;
    use std::path::PathBuf;

    #[test]
    fn a_stop_names_the_files_that_are_written() {
        let files = |names: &[&str]| -> Vec<PathBuf> { names.iter().map(PathBuf::from).collect() };
        assert!(left_files(&[]).contains("no files were written or changed"));
        assert!(left_files(&files(&["d.adm"])).contains("d.adm is written; no other"));
        let text = left_files(&files(&["d.adm", "d.acf"]));
        assert!(text.contains("d.adm and d.acf are written; no other"));
    }
}
