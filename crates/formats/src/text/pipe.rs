//! Reading from a pipe, into which perhaps nobody writes.

use std::fs::OpenOptions;
use std::io::{self, ErrorKind, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;

/// Appends at most `most` bytes from a pipe to `bytes`, up to its end. A pipe that nobody has opened for writing is
/// waited for as long as `patience`, in seconds; returns whether there was a writer.
pub(super) fn read(path: &Path, most: u64, patience: i64, bytes: &mut Vec<u8>) -> io::Result<bool> {
    // without the flag, opening would wait for a writer without end
    let no_wait = OFlags::NONBLOCK.bits().cast_signed();
    let file = OpenOptions::new()
        .read(true)
        .custom_flags(no_wait)
        .open(path)?;
    let mut pipe = (&file).take(most);
    let mut block = vec![0; 1 << 16];
    let mut has_writer = false;
    loop {
        let patience = match pipe.read(&mut block) {
            Ok(0) if has_writer => return Ok(true),
            Ok(0) => Some(Timespec {
                tv_sec: patience,
                tv_nsec: 0,
            }),
            Ok(count) => {
                has_writer = true;
                bytes.extend_from_slice(&block[..count]);
                continue;
            }
            // the pipe has a writer, and no data yet
            Err(error) if error.kind() == ErrorKind::WouldBlock => None,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        let mut wait = [PollFd::new(&file, PollFlags::IN)];
        match poll(&mut wait, patience.as_ref()) {
            Ok(0) => return Ok(false),
            // data, or the end after a writer
            Ok(_) => has_writer = true,
            Err(error) if error == rustix::io::Errno::INTR => {}
            Err(error) => return Err(error.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    #[test]
    fn a_pipe_is_read_to_its_end_and_one_without_a_writer_is_given_up() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("pipe");
        let made = Command::new("mkfifo").arg(&path).status();
        assert!(
            made.is_ok_and(|status| status.success()),
            "mkfifo is part of every Unix"
        );
        let mut bytes = Vec::new();
        assert!(matches!(read(&path, 100, 0, &mut bytes), Ok(false)));
        for (script, wanted) in [
            ("printf first; sleep 0.1; printf second", "firstsecond"),
            ("true", ""),
        ] {
            let line = format!("exec > pipe; {script}");
            let writer = Command::new("sh")
                .args(["-c", &line])
                .current_dir(folder.path())
                .spawn();
            bytes.clear();
            assert!(matches!(read(&path, 100, 30, &mut bytes), Ok(true)));
            assert!(
                writer
                    .and_then(|mut writer| writer.wait())
                    .is_ok_and(|status| status.success())
            );
            assert_eq!(String::from_utf8_lossy(&bytes), wanted);
        }
    }
}
