//! Reading from a pipe, into which perhaps nobody writes.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Read};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use super::inputs::read_error_message;

/// Interval at which a pipe without data is read again.
const INTERVAL: Duration = Duration::from_millis(10);

/// Appends at most `most` bytes from a pipe to `bytes`, up to its end. A pipe from which nothing has come, and which
/// nobody has opened for writing, is waited for as long as `patience`.
///
/// # Errors
/// The reason why the pipe cannot be read, as text.
pub(super) fn read(path: &Path, most: u64, patience: Duration, bytes: &mut Vec<u8>) -> Result<(), String> {
    let message = |error: std::io::Error| read_error_message(&error);
    let mut options = OpenOptions::new();
    options.read(true);
    // otherwise opening would wait for a writer without end
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(
        &mut options,
        rustix::fs::OFlags::NONBLOCK.bits().cast_signed(),
    );
    let mut pipe = options.open(path).map_err(message)?.take(most);
    let begun = Instant::now();
    let mut block = vec![0; 1 << 16];
    loop {
        match pipe.read(&mut block) {
            Ok(0) if bytes.is_empty() && begun.elapsed() < patience => thread::sleep(INTERVAL),
            Ok(0) if bytes.is_empty() => {
                return Err("cannot be read: nothing is written into this pipe".to_owned());
            }
            Ok(0) => return Ok(()),
            Ok(count) => bytes.extend_from_slice(&block[..count]),
            // the pipe has a writer, and no data yet
            Err(error) if error.kind() == ErrorKind::WouldBlock => thread::sleep(INTERVAL),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(message(error)),
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::fs::File;
    use std::io::Write;
    use std::process::Command;

    use super::*;

    #[test]
    fn a_pipe_is_read_to_its_end_and_one_without_a_writer_is_given_up() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("pipe");
        let made = Command::new("mkfifo").arg(&path).status();
        assert!(made.is_ok_and(|status| status.success()), "mkfifo is part of every Unix");
        let mut bytes = Vec::new();
        let why = read(&path, 100, Duration::from_millis(50), &mut bytes).expect_err("nobody writes");
        assert!(why.contains("nothing is written"), "{why}");
        let to = path.clone();
        let writer = thread::spawn(move || {
            let mut pipe = File::create(to).expect("a reader is there");
            pipe.write_all(b"first ").expect("a reader is there");
            thread::sleep(Duration::from_millis(50));
            pipe.write_all(b"second").expect("a reader is there");
        });
        read(&path, 100, Duration::from_secs(10), &mut bytes).expect("a writer");
        writer.join().expect("no panic");
        assert_eq!(bytes, b"first second");
    }
}
