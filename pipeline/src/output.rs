//! Atomic writing of output files and output folders.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::NamedTempFile;

use crate::exit::Failure;
use crate::manifest::{MANIFEST, Manifest, OutputEntry};
use crate::progress::Progress;
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::sha256;

/// Writes a file atomically: writes a temporary file in the same folder, flushes it to the disk and renames it.
///
/// # Errors
/// An operation of the file system fails; the error contains the name of the file.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    put(path, bytes).map_err(|error| cannot_write(path, &error))
}

/// Writes a file atomically, but fails if it exists already.
///
/// # Errors
/// The file exists already, or an operation of the file system fails; the error contains the name of the file.
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let new = |file: NamedTempFile| file.persist_noclobber(path);
    put_by(path, bytes, new).map_err(|error| cannot_write(path, &error))
}

/// Creates a folder and its missing parent folders.
///
/// # Errors
/// An operation of the file system fails; the error contains the name of the folder.
pub fn make(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder).map_err(|error| cannot_write(folder, &error))
}

fn put(path: &Path, bytes: &[u8]) -> io::Result<()> {
    put_by(path, bytes, |file| file.persist(path))
}

fn put_by(
    path: &Path,
    bytes: &[u8],
    persist: impl FnOnce(NamedTempFile) -> Result<fs::File, tempfile::PersistError>,
) -> io::Result<()> {
    let folder = folder_of(path);
    let mut file = tempfile::Builder::new().prefix(".girderway-").tempfile_in(&folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    let file = persist(file).map_err(|error| error.error)?;
    readable(&file)?;
    sync(&folder)
}

/// Makes a file readable for all users. Temporary files are created readable for their owner only.
#[cfg(unix)]
fn readable(file: &fs::File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable(_file: &fs::File) -> io::Result<()> {
    Ok(())
}

/// Flushes renames in a folder to the disk, on systems that support it.
fn sync(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { fs::File::open(folder)?.sync_all() } else { Ok(()) }
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    let why = match error.kind() {
        io::ErrorKind::NotFound => "its folder does not exist".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::NotADirectory => "part of its path is not a folder".to_owned(),
        _ => error.to_string(),
    };
    Diagnostic::of_file(path.display().to_string(), format!("cannot be written: {why}")).into()
}

/// Formats JSON for files and standard output: indented, with a newline at the end.
#[must_use]
pub(crate) fn json(value: &Value) -> String {
    format!("{value:#}\n")
}

/// Writes to standard output. A closed pipe is not an error.
///
/// # Errors
/// Standard output cannot be written.
pub fn print(text: &str) -> Result<(), Failure> {
    print_bytes(text.as_bytes())
}

fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Diagnostic::of_file("standard output", format!("cannot be written: {error}")).into())
        }
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
pub fn deliver_bytes(path: Option<&Path>, bytes: &[u8], progress: &Progress) -> Result<(), Failure> {
    let Some(path) = path else { return print_bytes(bytes) };
    write(path, bytes)?;
    progress.say(&format!("wrote {}", path.display()));
    Ok(())
}

/// Contents of an output folder, which are kept in memory until [`OutputFolder::commit`] writes them.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    files: Vec<(String, Vec<u8>, bool)>,
}

impl OutputFolder {
    /// Creates an empty output folder in memory for the path `path`.
    ///
    /// # Errors
    /// No folder can be created at `path` because part of it is a file.
    pub fn new(path: &Path) -> Result<OutputFolder, Failure> {
        let there = path.ancestors().find(|part| !part.as_os_str().is_empty() && part.exists());
        if let Some(part) = there.filter(|part| !part.is_dir()) {
            let expected = format!("cannot be an output folder: {} is a file", part.display());
            return Err(Diagnostic::of_file(path.display().to_string(), expected).into());
        }
        Ok(OutputFolder { path: path.to_path_buf(), files: Vec::new() })
    }

    /// Adds a file under its name in the folder, such as `plots/path.svg`, and replaces an earlier one of this name.
    pub fn add(&mut self, name: &str, bytes: impl Into<Vec<u8>>) {
        self.put(name, bytes.into(), true);
    }

    /// Adds a file whose contents may differ between equal runs; the manifest does not contain its size and hash.
    pub fn add_varying(&mut self, name: &str, bytes: impl Into<Vec<u8>>) {
        self.put(name, bytes.into(), false);
    }

    fn put(&mut self, name: &str, bytes: Vec<u8>, fixed: bool) {
        self.files.retain(|(known, ..)| known != name);
        self.files.push((name.to_owned(), bytes, fixed));
    }

    /// Writes all files and then `manifest.json`, which lists them.
    ///
    /// All files are first written to the disk under temporary names. Then an older manifest is removed, the files
    /// are renamed, and the new manifest is written, so that a manifest never lists files of another run. Files that
    /// the older manifest lists are removed if this run does not write them and they have not been changed since.
    ///
    /// # Errors
    /// An operation of the file system fails; the error contains the name of the file.
    pub fn commit(mut self, mut manifest: Manifest) -> Result<PathBuf, Failure> {
        self.files.sort_by(|a, b| a.0.cmp(&b.0));
        for (name, bytes, fixed) in &self.files {
            let sha256 = fixed.then(|| sha256(bytes));
            manifest.outputs.push(OutputEntry {
                name: name.clone(),
                bytes: fixed.then_some(bytes.len()),
                sha256,
            });
        }
        let path = self.path.clone();
        self.write(&manifest).map_err(|(file, error)| cannot_write(&file, &error))?;
        Ok(path)
    }

    fn write(&self, manifest: &Manifest) -> Result<(), (PathBuf, io::Error)> {
        let fail = |file: &Path| {
            let file = file.to_path_buf();
            move |error: io::Error| (file, error)
        };
        fs::create_dir_all(&self.path).map_err(fail(&self.path))?;
        let staging = tempfile::Builder::new()
            .prefix(".girderway-")
            .tempdir_in(&self.path)
            .map_err(fail(&self.path))?;
        let mut folders = vec![self.path.clone()];
        for (index, (name, bytes, _)) in self.files.iter().enumerate() {
            let target = self.path.join(name);
            let folder = folder_of(&target);
            if !folders.contains(&folder) {
                fs::create_dir_all(&folder).map_err(fail(&folder))?;
                folders.push(folder);
            }
            let mut file = fs::File::create(staging.path().join(index.to_string())).map_err(fail(&target))?;
            file.write_all(bytes).and_then(|()| file.sync_all()).map_err(fail(&target))?;
        }
        let manifest_path = self.path.join(MANIFEST);
        let older =
            fs::read(&manifest_path).ok().and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok());
        match fs::remove_file(&manifest_path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err((manifest_path, error)),
            _ => {}
        }
        self.clear(older.as_ref());
        for (index, (name, ..)) in self.files.iter().enumerate() {
            let target = self.path.join(name);
            fs::rename(staging.path().join(index.to_string()), &target).map_err(fail(&target))?;
        }
        for folder in &folders {
            sync(folder).map_err(fail(folder))?;
        }
        put(&manifest_path, manifest.text().as_bytes()).map_err(fail(&manifest_path))
    }

    /// Removes files of an older run that have not been changed since and that this run does not write.
    fn clear(&self, older: Option<&Value>) {
        let listed = older.and_then(|manifest| manifest.get("outputs")).and_then(Value::as_array);
        for entry in listed.into_iter().flatten() {
            let text = |key: &str| entry.get(key).and_then(Value::as_str);
            let Some(name) = text("name") else { continue };
            let inside =
                Path::new(name).components().all(|part| matches!(part, std::path::Component::Normal(_)));
            if !inside || self.files.iter().any(|(known, ..)| known == name) {
                continue;
            }
            let path = self.path.join(name);
            let unchanged =
                fs::read(&path).is_ok_and(|bytes| Some(sha256(&bytes).as_str()) == text("sha256"));
            if unchanged {
                // a file that cannot be removed remains, but the new manifest does not list it
                let _ = fs::remove_file(&path);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use formats::text::inputs::Inputs;
    use serde_json::json;

    fn commit(path: &Path, files: &[(&str, &str)]) {
        let mut folder = OutputFolder::new(path).expect("no file is in the way");
        for (name, text) in files {
            folder.add(name, *text);
        }
        folder.add_varying("timing.json", "0.1");
        folder.commit(Manifest::new("run", &Inputs::default(), json!({}))).expect("a writable folder");
    }

    fn manifest(path: &Path) -> Value {
        let text = fs::read(path.join(MANIFEST)).expect("a manifest");
        serde_json::from_slice(&text).expect("JSON")
    }

    fn names(path: &Path) -> Vec<String> {
        let entries = fs::read_dir(path).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_folder_has_its_files_and_a_manifest_and_nothing_else() {
        let temporary = tempfile::tempdir().expect("a temporary folder");
        let path = temporary.path().join("deep/out");
        commit(&path, &[("b.csv", "1,2"), ("plots/a.svg", "<svg/>")]);
        assert_eq!(names(&path), ["b.csv", "manifest.json", "plots", "timing.json"]);
        let outputs = manifest(&path)["outputs"].clone();
        assert_eq!(outputs[0], json!({ "name": "b.csv", "bytes": 3, "sha256": sha256(b"1,2") }));
        assert_eq!(outputs[2], json!({ "name": "timing.json" }));
    }

    #[test]
    fn a_new_run_takes_away_what_the_old_one_left_but_not_what_a_user_changed() {
        let temporary = tempfile::tempdir().expect("a temporary folder");
        let path = temporary.path();
        commit(path, &[("history.csv", "1"), ("history-old.csv", "2"), ("history-mine.csv", "3")]);
        fs::write(path.join("history-mine.csv"), "edited").expect("writable");
        fs::write(path.join("notes.txt"), "mine").expect("writable");
        commit(path, &[("history.csv", "4")]);
        let left = ["history-mine.csv", "history.csv", "manifest.json", "notes.txt", "timing.json"];
        assert_eq!(names(path), left);
        assert_eq!(fs::read(path.join("history.csv")).expect("written"), b"4");
    }

    #[test]
    fn a_folder_under_a_file_is_refused_before_any_work() {
        let temporary = tempfile::tempdir().expect("a temporary folder");
        let file = temporary.path().join("file");
        fs::write(&file, "x").expect("writable");
        assert!(OutputFolder::new(&file.join("out")).is_err());
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
}
