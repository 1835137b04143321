//! Atomic writing of output files.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::NamedTempFile;

use crate::Error;
use formats::text::diagnostic::Diagnostic;

/// Beginning of the names of temporary files and folders.
pub(crate) const TEMPORARY: &str = ".girderway-";

/// Length of the random part of the names of temporary files and folders.
const RANDOM: usize = 6;

/// Symbolic links that are followed one after the other before they are taken for a circle.
const LINKS: usize = 40;

/// Writes a file atomically: writes a temporary file in the same folder, flushes it to the disk and renames it.
///
/// Symbolic links are followed, and the file to which they lead is replaced. What is not a regular file, such as a
/// device or a pipe, is opened and written.
///
/// # Errors
/// An operation of the file system fails; the error contains the name of the file.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let written = match fs::metadata(path) {
        Ok(there) if !there.is_file() && !there.is_dir() => write_through(path, bytes),
        _ => target(path).and_then(|path| put_by(&path, bytes, |file| file.persist(&path))),
    };
    written.map_err(|error| cannot_write(path, &error))
}

/// Writes to a device, a pipe or a terminal.
fn write_through(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = OpenOptions::new().write(true).open(path)?;
    file.write_all(bytes).and_then(|()| file.flush())
}

/// The path to which symbolic links lead; a file need not exist there.
fn target(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        if !path
            .symlink_metadata()
            .is_ok_and(|there| there.is_symlink())
        {
            return Ok(path);
        }
        path = folder_of(&path).join(fs::read_link(&path)?);
    }
    Err(io::Error::other("its symbolic links form a loop"))
}

/// Writes a file atomically, but fails if it exists already.
///
/// # Errors
/// The file exists already, or an operation of the file system fails; the error contains the name of the file.
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let new = |file: NamedTempFile| file.persist_noclobber(path);
    put_by(path, bytes, new).map_err(|error| cannot_write(path, &error))
}

/// Creates a folder and its missing parent folders.
///
/// # Errors
/// An operation of the file system fails; the error contains the name of the folder.
pub fn make(folder: &Path) -> Result<(), Error> {
    fs::create_dir_all(folder).map_err(|error| cannot_write(folder, &error))
}

fn put_by(
    path: &Path,
    bytes: &[u8],
    persist: impl FnOnce(NamedTempFile) -> Result<File, tempfile::PersistError>,
) -> io::Result<()> {
    let file = staged(path, bytes)?;
    persist(file).map_err(|error| error.error)?;
    sync(&folder_of(path))
}

/// Writes bytes to the disk in a temporary file beside `path`. It has the permissions of the file that it is to
/// replace, or those of a new file.
fn staged(path: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let folder = folder_of(path);
    clear_dead_files(&folder);
    let mut file = temporary(&folder)?;
    if let Ok(older) = path.metadata() {
        file.as_file().set_permissions(older.permissions())?;
    }
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

/// Writes several files that belong together: all of them to the disk in temporary files first, so that a full disk
/// leaves the older ones as they were.
///
/// # Errors
/// An operation of the file system fails; the error contains the name of the file.
pub fn write_together(files: &[(&Path, &[u8])]) -> Result<(), Error> {
    let mut all = Vec::new();
    for (path, bytes) in files {
        let stage = || {
            let path = target(path)?;
            Ok((staged(&path, bytes)?, path))
        };
        all.push((stage().map_err(|error| cannot_write(path, &error))?, path));
    }
    for ((file, to), path) in all {
        let placed = file
            .persist(&to)
            .map_err(|error| error.error)
            .and_then(|_| sync(&folder_of(&to)));
        placed.map_err(|error| cannot_write(path, &error))?;
    }
    Ok(())
}

/// Creates a temporary file that is locked until it is closed, so that other runs do not take it for one that a dead
/// run has left. It has the permissions that new files have.
pub(crate) fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY).rand_bytes(RANDOM);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        let file = builder.tempfile_in(folder)?;
        // without locks of the file system, nothing is cleared either
        let _ = file.as_file().lock();
        if has_name(file.as_file())? {
            return Ok(file);
        }
    }
}

/// Removes the temporary files of runs that have died: those that nobody has locked.
///
/// What cannot be removed remains.
pub(crate) fn clear_dead_files(folder: &Path) {
    for (path, kind) in temporaries(folder) {
        if kind.is_file()
            && let Ok(file) = File::open(&path)
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(&path);
        }
    }
}

/// Temporary files and folders of the program in a folder.
pub(crate) fn temporaries(folder: &Path) -> Vec<(PathBuf, fs::FileType)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let ours = entries.filter(|entry| {
        let name = entry.file_name();
        let random = name.to_str().and_then(|name| name.strip_prefix(TEMPORARY));
        random.is_some_and(|random| {
            random.len() == RANDOM && random.bytes().all(|byte| byte.is_ascii_alphanumeric())
        })
    });
    ours.filter_map(|entry| Some((entry.path(), entry.file_type().ok()?)))
        .collect()
}

/// Whether an open file still has a name.
#[cfg(unix)]
fn has_name(file: &File) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    Ok(file.metadata()?.nlink() > 0)
}

#[cfg(not(unix))]
fn has_name(_file: &File) -> io::Result<bool> {
    Ok(true)
}

/// Flushes renames in a folder to the disk, on systems that support it.
pub(crate) fn sync(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        File::open(folder)?.sync_all()
    } else {
        Ok(())
    }
}

/// The folder of a file.
pub(crate) fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// Creates the failure of a file that cannot be written.
pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> Error {
    let fault = Diagnostic::of_file(
        path.display().to_string(),
        format!("cannot be written: {}", reason(error)),
    );
    if is_full(error) {
        fault
            .hint("free some space, or name another folder with -o")
            .into()
    } else {
        fault.into()
    }
}

/// The reason why something cannot be written, in words.
#[must_use]
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "its folder does not exist".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::InvalidFilename => "its name is too long for the file system".to_owned(),
        io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
        io::ErrorKind::NotADirectory => "part of its path is not a folder".to_owned(),
        io::ErrorKind::StorageFull => "the disk is full".to_owned(),
        io::ErrorKind::QuotaExceeded => "the quota of the disk is exceeded".to_owned(),
        io::ErrorKind::FileTooLarge => "the file is larger than the system permits".to_owned(),
        io::ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_owned(),
        _ => error.to_string(),
    }
}

/// Whether there is no room for a file.
fn is_full(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge
    )
}

/// Formats JSON for files and standard output: indented, with a newline at the end.
#[must_use]
pub fn json(value: &Value) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("the keys of JSON values are text");
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(path: &Path) -> Vec<String> {
        let entries = fs::read_dir(path).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|entry| {
                entry
                    .expect("an entry")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_that_cannot_be_replaced_leaves_no_trace() {
        let temporary = tempfile::tempdir().expect("a temporary folder");
        let path = temporary.path().join("folder");
        fs::create_dir(&path).expect("writable");
        assert!(write(&path, b"x").is_err());
        assert_eq!(names(temporary.path()), ["folder"]);
        assert!(names(&path).is_empty());
    }

    #[test]
    fn temporary_files_of_dead_runs_are_removed_and_those_of_living_runs_remain() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let dead = folder.path().join(".girderway-Dead01");
        fs::write(&dead, "half").expect("writable");
        let mine = folder.path().join(".girderway-notes");
        fs::write(&mine, "mine").expect("writable");
        let living = temporary(folder.path()).expect("a temporary file");
        write(&folder.path().join("grid.json"), b"{}").expect("writable");
        assert!(!dead.exists() && mine.exists() && living.path().exists());
        drop(living);
        assert_eq!(names(folder.path()), [".girderway-notes", "grid.json"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_file_keeps_its_permissions_and_a_new_one_has_those_of_new_files() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mode = |name: &str| {
            fs::metadata(folder.path().join(name))
                .expect("a file")
                .permissions()
                .mode()
                & 0o777
        };
        fs::write(folder.path().join("plain"), "x").expect("writable");
        let [old, new] = ["old", "new"].map(|name| folder.path().join(name));
        fs::write(&old, "x").expect("writable");
        fs::set_permissions(&old, fs::Permissions::from_mode(0o640)).expect("our own file");
        write(&old, b"y").expect("writable");
        write(&new, b"y").expect("writable");
        assert_eq!(mode("old"), 0o640);
        assert_eq!(mode("new"), mode("plain"));
    }

    #[test]
    fn of_files_that_belong_together_all_are_written_or_none() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let [one, two] = ["one", "none/two"].map(|name| folder.path().join(name));
        fs::write(&one, "old").expect("writable");
        assert!(write_together(&[(&one, b"new"), (&two, b"new")]).is_err());
        assert_eq!(fs::read(&one).expect("written"), b"old");
        assert_eq!(names(folder.path()), ["one"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_the_file_behind_it_is_replaced() {
        use std::os::unix::fs::symlink;
        let temporary = tempfile::tempdir().expect("a temporary folder");
        let folder = temporary.path();
        fs::create_dir(folder.join("deep")).expect("writable");
        fs::write(folder.join("deep/old.json"), "old").expect("writable");
        for (link, target) in [
            ("one", "deep/two"),
            ("deep/two", "old.json"),
            ("new", "deep/new.json"),
        ] {
            symlink(target, folder.join(link)).expect("a link");
        }
        write(&folder.join("one"), b"first").expect("writable");
        write(&folder.join("new"), b"second").expect("writable");
        let is_link = |name: &str| {
            folder
                .join(name)
                .symlink_metadata()
                .is_ok_and(|there| there.is_symlink())
        };
        assert!(is_link("one") && is_link("deep/two") && is_link("new"));
        assert_eq!(
            fs::read(folder.join("deep/old.json")).expect("written"),
            b"first"
        );
        assert_eq!(
            fs::read(folder.join("deep/new.json")).expect("written"),
            b"second"
        );
        symlink("circle", folder.join("circle")).expect("a link");
        assert!(write(&folder.join("circle"), b"x").is_err());
    }
}
