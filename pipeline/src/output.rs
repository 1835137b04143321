//! Standard output, and results that go to a file or to it.

use std::io::{self, IsTerminal, Write};
use std::path::Path;

use crate::exit::Failure;
use crate::progress::Progress;
use formats::text::diagnostic::{Diagnostic, plain};
use outputs::files::{reason, write};

/// Writes to standard output. A closed pipe is not an error.
///
/// # Errors
/// Standard output cannot be written.
pub fn print(text: &str) -> Result<(), Failure> {
    // a file that goes there keeps its bytes, a terminal obeys no control characters
    if io::stdout().is_terminal() {
        return print_bytes(plain(text).as_bytes());
    }
    print_bytes(text.as_bytes())
}

/// Creates the diagnostic of standard output that cannot be written.
pub fn cannot_print(error: &io::Error) -> Diagnostic {
    Diagnostic::of_file(
        "standard output",
        format!("cannot be written: {}", reason(error)),
    )
}

fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(cannot_print(&error).into()),
        _ => Ok(()),
    }
}

/// Writes `text` to the named file, with a message, or to standard output if `path` is `None`.
///
/// # Errors
/// An operation of the file system fails; the error contains the name of the file.
pub fn deliver(path: Option<&Path>, text: &str, progress: &Progress) -> Result<(), Failure> {
    deliver_bytes(path, text.as_bytes(), progress)
}

/// Writes `bytes` to the named file, with a message, or to standard output if `path` is `None`.
///
/// # Errors
/// An operation of the file system fails; the error contains the name of the file.
pub fn deliver_bytes(
    path: Option<&Path>,
    bytes: &[u8],
    progress: &Progress,
) -> Result<(), Failure> {
    let Some(path) = path else {
        return print_bytes(bytes);
    };
    write(path, bytes)?;
    progress.say(&format!("wrote {}", path.display()));
    Ok(())
}
