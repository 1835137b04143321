//! The journal of an output folder: a lock that ends with its process, and the list of the files that a run places.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use serde_json::json;

use crate::manifest::OutputEntry;

/// Name of the journal in an output folder.
pub const JOURNAL: &str = ".girderway-journal";

const FORMAT: &str = "girderway-journal/1";

/// The output folder in which the program is at work, if any.
static FOLDER: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Whether that folder keeps the runs of a sweep.
static KEEPS_RUNS: AtomicBool = AtomicBool::new(false);

/// From now on a stop of the program leaves the journal of a run in `folder`; `None`: it leaves nothing.
fn enter(folder: Option<&Path>) {
    KEEPS_RUNS.store(false, Ordering::Relaxed);
    *FOLDER.lock().unwrap_or_else(PoisonError::into_inner) = folder.map(Path::to_owned);
}

/// The output folder in which the program is at work, which a stop would leave with its journal.
#[must_use]
pub fn folder_at_work() -> Option<PathBuf> {
    FOLDER
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .clone()
}

/// From now on a stop of the program leaves the runs of a sweep in the folder.
pub(crate) fn keeps_runs() {
    KEEPS_RUNS.store(true, Ordering::Relaxed);
}

/// Whether a stop leaves the runs of a sweep in the folder, from which the same command resumes.
#[must_use]
pub fn would_resume() -> bool {
    KEEPS_RUNS.load(Ordering::Relaxed)
}

/// The journal of the run that writes into a folder. The run holds the lock on it until it ends or dies.
///
/// The journal is only appended to, one JSON object a line, so that a process that dies while it writes loses no
/// earlier line.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    listed: Vec<OutputEntry>,
    is_locked: bool,
}

impl Journal {
    /// Opens and locks the journal of an existing folder; `None` if a living process holds it.
    ///
    /// # Errors
    /// The journal cannot be created or read, or a file of its name is not a journal.
    pub fn open(folder: &Path) -> io::Result<Option<Journal>> {
        let path = folder.join(JOURNAL);
        loop {
            let mut file = OpenOptions::new()
                .read(true)
                .append(true)
                .create(true)
                .open(&path)?;
            let is_locked = match file.try_lock() {
                Ok(()) => true,
                Err(TryLockError::WouldBlock) => return Ok(None),
                // where the file system has no locks, runs do not exclude each other, and nothing of others is removed
                Err(TryLockError::Error(_)) => false,
            };
            // another run may have ended, and removed its journal, between the opening and the lock
            if is_locked && !is_at(&file, &path)? {
                continue;
            }
            let mut text = String::new();
            file.read_to_string(&mut text)?;
            let listed = entries(&text)?;
            return Ok(Some(Journal {
                path,
                file,
                listed,
                is_locked,
            }));
        }
    }

    /// Files listed by earlier runs that have not ended, and by this one.
    #[must_use]
    pub fn listed(&self) -> &[OutputEntry] {
        &self.listed
    }

    /// Whether the lock excludes other runs. It does not where the file system has no locks.
    #[must_use]
    pub const fn is_locked(&self) -> bool {
        self.is_locked
    }

    /// Appends the name of the command.
    ///
    /// # Errors
    /// The journal cannot be written.
    pub fn begin(&mut self, command: &str) -> io::Result<()> {
        let line = json!({ "format": FORMAT, "command": command });
        enter(self.path.parent());
        self.append(&format!("\n{line}\n"))
    }

    /// Appends files of the folder that belong to the program.
    ///
    /// # Errors
    /// The journal cannot be written.
    pub fn list(&mut self, files: &[OutputEntry]) -> io::Result<()> {
        let lines: Vec<String> = files
            .iter()
            .map(|entry| format!("{}\n", json!(entry)))
            .collect();
        self.append(&format!("\n{}", lines.concat()))?;
        self.file.sync_all()?;
        self.listed.extend_from_slice(files);
        Ok(())
    }

    fn append(&mut self, text: &str) -> io::Result<()> {
        self.file.write_all(text.as_bytes())
    }

    /// Removes the journal. The lock is released when the value is dropped.
    ///
    /// # Errors
    /// The journal cannot be removed.
    pub fn remove(&self) -> io::Result<()> {
        fs::remove_file(&self.path)?;
        enter(None);
        Ok(())
    }
}

/// Entries of a journal. Incomplete lines, which a dead process may leave, are passed over.
fn entries(text: &str) -> io::Result<Vec<OutputEntry>> {
    let mut lines = text.lines().filter(|line| !line.is_empty());
    if lines.next().is_some_and(|first| !first.starts_with("{\"")) {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            "it is not a journal of girderway",
        ));
    }
    Ok(lines
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect())
}

/// Whether the path still leads to the open file.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let open = file.metadata()?;
    match fs::metadata(path) {
        Ok(there) => Ok((there.dev(), there.ino()) == (open.dev(), open.ino())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

#[cfg(not(unix))]
fn is_at(_file: &File, path: &Path) -> io::Result<bool> {
    path.try_exists()
}
