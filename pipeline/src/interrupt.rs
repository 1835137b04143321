//! What the program says when the user stops it with Ctrl-C.

use outputs::journal::{folder_at_work, would_resume};

/// Exit status of a program that was stopped by the keyboard: 128 and the number of the signal.
const STOPPED: i32 = 130;

/// What a stop leaves, in a sentence.
fn left() -> String {
    match folder_at_work() {
        None => "girderway: interrupted; no files were written or changed\n".to_owned(),
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
