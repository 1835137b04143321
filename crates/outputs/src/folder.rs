//! Output folders: which of their files belong to the program, and how a new result replaces an older one.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::mem;
use std::path::{Component, Path, PathBuf};

use tempfile::{NamedTempFile, TempDir};

use crate::Error;
use crate::files::{TEMPORARY, cannot_write, clear_dead_files, folder_of, sync, temporaries, temporary};
use crate::hashed::HashedWriter;
use crate::journal::Journal;
use crate::manifest::{MANIFEST, Manifest, OutputEntry, listed_files};
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::sha256;
use results::threads::parallel_map;

/// Number of files that are written to the disk at the same time. Their threads wait for the disk, which takes most files
/// in one go with the others, so that their number does not follow from that of the processors.
const AT_ONCE: u16 = 8;

/// Folder of the pictures in an output folder.
const PLOTS: &str = "plots";

/// Files that a command is going to write, as far as they are known before the work.
#[derive(Clone, Debug, Default)]
pub struct PlannedFiles {
    /// Names in the folder.
    pub names: Vec<String>,
    /// Beginnings of the names of pictures in the folder `plots`.
    pub plots: Vec<String>,
}

/// An output folder that is locked for one run. The contents are kept in memory or in temporary files until
/// [`OutputFolder::commit`] places them. A run that does not commit leaves the folder as it was.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    files: Vec<(String, FileContents)>,
    journal: Journal,
    /// Files of the folder that the program wrote, by its manifest and by the journal of a run that has not ended.
    listed: Vec<OutputEntry>,
    may_replace_all: bool,
    /// Folders that did not exist before, outermost first.
    created: Vec<PathBuf>,
    keeps_journal: bool,
}

/// The contents of a file of the folder.
#[derive(Debug)]
enum FileContents {
    /// In memory, with their hash in the manifest.
    Fixed(Vec<u8>),
    /// In memory; they may differ between equal runs.
    Varying(Vec<u8>),
    /// In a temporary file, with their number of bytes and SHA-256.
    Written(NamedTempFile, usize, String),
}

impl FileContents {
    /// The number of bytes and their SHA-256 in hexadecimal; `None` for those that may differ between equal runs.
    fn hash(&self) -> Option<(usize, String)> {
        match self {
            FileContents::Fixed(bytes) => Some((bytes.len(), sha256(bytes))),
            FileContents::Varying(_) => None,
            FileContents::Written(_, bytes, sha256) => Some((*bytes, sha256.clone())),
        }
    }

    /// Writes them to the disk, under a path of the same file system.
    fn put_at(&self, path: &Path) -> io::Result<()> {
        match self {
            FileContents::Fixed(bytes) | FileContents::Varying(bytes) => {
                let mut file = fs::File::create(path)?;
                file.write_all(bytes)?;
                file.sync_all()
            }
            FileContents::Written(file, ..) => {
                fs::rename(file.path(), path)?;
                file.as_file().sync_all()
            }
        }
    }
}

impl OutputFolder {
    /// Creates and locks the folder, and removes the temporary files that dead runs have left there.
    ///
    /// Files that the command would replace must have been written by this program and be unchanged since, unless
    /// `force` is set.
    ///
    /// # Errors
    /// Part of the path is a file; another run is writing into the folder; a file that would be replaced belongs to
    /// somebody else; an operation of the file system fails.
    pub fn open(
        path: &Path,
        command: &str,
        force: bool,
        planned: &PlannedFiles,
    ) -> Result<OutputFolder, Error> {
        check_path(path)?;
        let fail = |error: io::Error| cannot_write(path, &error);
        let mut created: Vec<PathBuf> =
            path.ancestors().take_while(|part| !part.exists()).map(Path::to_path_buf).collect();
        created.reverse();
        created.retain(|part| !part.as_os_str().is_empty());
        fs::create_dir_all(path).map_err(fail)?;
        let Some(journal) = Journal::open(path).map_err(fail)? else {
            let fault =
                Diagnostic::of_file(path.display().to_string(), "another run is writing into this folder");
            return Err(fault.hint("wait until it ends, or name another folder with -o").into());
        };
        let keeps_journal = !journal.listed().is_empty();
        let listed = journal.listed().to_vec();
        let mut folder = OutputFolder {
            path: path.to_path_buf(),
            files: Vec::new(),
            journal,
            listed,
            may_replace_all: force,
            created,
            keeps_journal,
        };
        folder.clear_dead();
        let older = fs::read(path.join(MANIFEST)).ok().and_then(|text| listed_files(&text));
        folder.listed.extend(older.into_iter().flatten());
        let mut names = planned.names.clone();
        names.extend(folder.pictures(&planned.plots));
        names.push(MANIFEST.to_owned());
        folder.check_owner(names.iter().map(String::as_str))?;
        folder.journal.begin(command).map_err(fail)?;
        Ok(folder)
    }

    /// Removes what dead runs have left. Only the holder of the lock has folders of temporary files here.
    fn clear_dead(&self) {
        if !self.journal.is_locked() {
            return;
        }
        clear_dead_files(&self.path);
        for (path, kind) in temporaries(&self.path) {
            if kind.is_dir() {
                // a folder that cannot be removed does not disturb the run
                let _ = fs::remove_dir_all(path);
            }
        }
    }

    /// Pictures in the folder whose names begin in one of the given ways.
    fn pictures(&self, beginnings: &[String]) -> Vec<String> {
        let entries = fs::read_dir(self.path.join(PLOTS)).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names
            .filter(|name| name.ends_with(".svg") && beginnings.iter().any(|start| name.starts_with(start)))
            .map(|name| format!("{PLOTS}/{name}"))
            .collect();
        names.sort();
        names
    }

    /// Checks that the program may replace the files of these names.
    fn check_owner<'n>(&self, names: impl Iterator<Item = &'n str>) -> Result<(), Error> {
        let mut foreign: Vec<Diagnostic> = Vec::new();
        for name in names {
            let path = self.path.join(name);
            let last = Path::new(name).file_name().unwrap_or_default().to_string_lossy();
            if is_too_long(&folder_of(&path), &last) {
                return Err(cannot_write(&path, &io::ErrorKind::InvalidFilename.into()));
            }
            let Ok(there) = path.symlink_metadata() else { continue };
            let file = path.display().to_string();
            if there.is_dir() {
                foreign.push(
                    Diagnostic::of_file(file, "is a folder, and a file of this name is to be written")
                        .hint("move it, or name another folder with -o"),
                );
            } else if !self.may_replace_all && !self.is_ours(name) {
                foreign.push(
                    Diagnostic::of_file(file, "would be replaced, but is not as girderway wrote it")
                        .hint("move it, name another folder with -o, or replace it with --force"),
                );
            }
        }
        if foreign.is_empty() { Ok(()) } else { Err(foreign.into()) }
    }

    /// Whether the program wrote the existing file of this name, and nobody has changed it since.
    fn is_ours(&self, name: &str) -> bool {
        let path = self.path.join(name);
        if !path.symlink_metadata().is_ok_and(|there| there.is_file()) {
            return false;
        }
        if name == MANIFEST {
            return fs::read(&path).is_ok_and(|text| listed_files(&text).is_some());
        }
        let mut entries = self.listed.iter().filter(|entry| entry.name == name).peekable();
        if entries.peek().is_none() {
            return false;
        }
        let hash = fs::read(&path).ok().map(|bytes| sha256(&bytes));
        entries.any(|entry| entry.sha256.is_none() || entry.sha256 == hash)
    }

    /// Adds a file under its name in the folder, such as `plots/path.svg`, and replaces an earlier one of this name.
    pub fn add(&mut self, name: &str, bytes: impl Into<Vec<u8>>) {
        self.put(name, FileContents::Fixed(bytes.into()));
    }

    /// Adds a file whose contents may differ between equal runs; the manifest does not contain its size and hash.
    pub fn add_varying(&mut self, name: &str, bytes: impl Into<Vec<u8>>) {
        self.put(name, FileContents::Varying(bytes.into()));
    }

    /// Adds a file that `write` writes piece by piece, so that its contents are never in memory as a whole.
    ///
    /// # Errors
    /// An operation of the file system fails, or `write` does.
    pub fn add_written(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>,
    ) -> Result<(), Error> {
        let written = temporary(&self.path).and_then(|file| {
            let mut writer = HashedWriter::new(BufWriter::new(file));
            write(&mut writer)?;
            let (file, bytes, sha256) = writer.finish();
            Ok(FileContents::Written(file.into_inner()?, bytes, sha256))
        });
        self.put(name, written.map_err(|error| cannot_write(&self.path.join(name), &error))?);
        Ok(())
    }

    fn put(&mut self, name: &str, contents: FileContents) {
        self.files.retain(|(known, _)| known != name);
        self.files.push((name.to_owned(), contents));
    }

    /// Writes all files and then `manifest.json`, which lists them.
    ///
    /// All files, the manifest last, are first written to the disk in a temporary folder, under their own names. The
    /// journal then lists the files of the older result and of the new one. The older manifest is put aside, so that
    /// a manifest never lists files of another run; the files are renamed; the new manifest comes last. If one of
    /// these steps fails, the older result is put back. Only then are files of the older result removed that the new
    /// one does not have and nobody has changed, and at last the journal.
    ///
    /// # Errors
    /// A file that would be replaced belongs to somebody else, or an operation of the file system fails; the error
    /// contains the name of the file.
    pub fn commit(mut self, mut manifest: Manifest) -> Result<PathBuf, Error> {
        self.files.sort_by(|a, b| a.0.cmp(&b.0));
        for (name, contents) in &self.files {
            let (bytes, sha256) = contents.hash().unzip();
            manifest.outputs.push(OutputEntry { name: name.clone(), bytes, sha256 });
        }
        let names = self.files.iter().map(|(name, _)| name.as_str());
        self.check_owner(names.chain([MANIFEST]))?;
        self.write(&manifest).map_err(|(file, error)| cannot_write(&file, &error))?;
        self.clear_older();
        self.keeps_journal = false;
        self.created.clear();
        Ok(self.path.clone())
    }

    fn write(&mut self, manifest: &Manifest) -> Result<(), (PathBuf, io::Error)> {
        let staging = self.stage(manifest)?;
        let older = staging.path().join("older");
        fs::create_dir(&older).map_err(at(&older))?;
        let all = self.listed.iter().chain(&manifest.outputs);
        let entries: Vec<OutputEntry> =
            all.filter(|entry| !self.journal.listed().contains(entry)).cloned().collect();
        self.journal.list(&entries).map_err(at(&self.path))?;
        let mut exchange = Exchange { older, steps: Vec::new() };
        let placed = self.place(&staging.path().join("new"), &mut exchange);
        if placed.is_err() && exchange.undo().is_err() {
            // the older files remain beside the new ones, and the next run may replace both
            self.keeps_journal = true;
            let _ = staging.keep();
        }
        placed
    }

    /// Writes all files to the disk in a temporary folder, under their own names.
    fn stage(&self, manifest: &Manifest) -> Result<TempDir, (PathBuf, io::Error)> {
        let staging =
            tempfile::Builder::new().prefix(TEMPORARY).tempdir_in(&self.path).map_err(at(&self.path))?;
        let new = staging.path().join("new");
        let manifest = [(MANIFEST.to_owned(), FileContents::Fixed(manifest.text().into_bytes()))];
        let files: Vec<&(String, FileContents)> = self.files.iter().chain(&manifest).collect();
        let mut folders: Vec<PathBuf> = Vec::new();
        for (name, _) in &files {
            let folder = folder_of(&new.join(name));
            if !folders.contains(&folder) {
                fs::create_dir_all(&folder).map_err(at(&self.path.join(name)))?;
                folders.push(folder);
            }
        }
        let put = |_, (name, contents): &&(String, FileContents)| {
            contents.put_at(&new.join(name)).map_err(at(&self.path.join(name)))
        };
        parallel_map(&files, Some(AT_ONCE), put).into_iter().collect::<Result<(), _>>()?;
        Ok(staging)
    }

    /// Renames all files from the temporary folder `new`, the manifest last.
    fn place(&self, new: &Path, exchange: &mut Exchange) -> Result<(), (PathBuf, io::Error)> {
        let manifest = self.path.join(MANIFEST);
        let mut folders = vec![self.path.clone()];
        exchange.take_away(&manifest).map_err(at(&manifest))?;
        for (name, _) in &self.files {
            let target = self.path.join(name);
            let folder = folder_of(&target);
            if !folders.contains(&folder) {
                fs::create_dir_all(&folder).map_err(at(&folder))?;
                folders.push(folder);
            }
            exchange.replace(&target, &new.join(name)).map_err(at(&target))?;
        }
        for folder in &folders {
            sync(folder).map_err(at(folder))?;
        }
        exchange.replace(&manifest, &new.join(MANIFEST)).map_err(at(&manifest))?;
        sync(&self.path).map_err(at(&self.path))
    }

    /// Removes files of older runs that have not been changed since and that this run does not write.
    fn clear_older(&mut self) {
        for entry in mem::take(&mut self.listed) {
            let name = entry.name.as_str();
            let is_inside = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
            if !is_inside || name == MANIFEST || self.files.iter().any(|(known, _)| known == name) {
                continue;
            }
            let path = self.path.join(name);
            let is_file = path.symlink_metadata().is_ok_and(|there| there.is_file());
            let hash = || fs::read(&path).ok().map(|bytes| sha256(&bytes));
            if is_file && (entry.sha256.is_none() || entry.sha256 == hash()) {
                // a file that cannot be removed remains, but the new manifest does not list it
                let _ = fs::remove_file(&path);
            }
        }
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        // errors are ignored: what remains is cleared by the next run
        if !self.keeps_journal {
            let _ = self.journal.remove();
        }
        for folder in self.created.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Checks that a folder exists at `path` or can be created there.
///
/// # Errors
/// Part of the path is a file.
pub fn check_path(path: &Path) -> Result<(), Error> {
    let there = path.ancestors().find(|part| !part.as_os_str().is_empty() && part.exists());
    if let Some(part) = there.filter(|part| !part.is_dir()) {
        let expected = format!("cannot be an output folder: {} is a file", part.display());
        return Err(Diagnostic::of_file(path.display().to_string(), expected).into());
    }
    Ok(())
}

/// Whether `name` is too long for the file system of a folder, which need not exist yet.
#[must_use]
pub fn is_too_long(folder: &Path, name: &str) -> bool {
    let there = folder.ancestors().find(|part| part.is_dir()).unwrap_or(Path::new("."));
    let found = there.join(name).symlink_metadata();
    found.is_err_and(|error| error.kind() == io::ErrorKind::InvalidFilename)
}

fn at(file: &Path) -> impl FnOnce(io::Error) -> (PathBuf, io::Error) + use<> {
    let file = file.to_path_buf();
    move |error| (file, error)
}

/// Replacements of files that can be undone. What was there before is kept in the folder `older`.
struct Exchange {
    older: PathBuf,
    /// Each file, and where the one that was there before is kept.
    steps: Vec<(PathBuf, Option<PathBuf>)>,
}

impl Exchange {
    /// Moves a file to the folder `older`, if it exists.
    fn take_away(&mut self, target: &Path) -> io::Result<()> {
        let kept = self.place_of_next();
        let was_there = unless_missing(fs::rename(target, &kept))?;
        self.steps.push((target.to_path_buf(), was_there.then_some(kept)));
        Ok(())
    }

    /// Renames `new` to `target`. What was there has a second name in the folder `older` from then on, so that
    /// `target` exists at every instant.
    fn replace(&mut self, target: &Path, new: &Path) -> io::Result<()> {
        let kept = self.place_of_next();
        let was_there = unless_missing(fs::hard_link(target, &kept))
            .or_else(|_| unless_missing(fs::rename(target, &kept)))?;
        self.steps.push((target.to_path_buf(), was_there.then_some(kept)));
        fs::rename(new, target)
    }

    fn place_of_next(&self) -> PathBuf {
        self.older.join(self.steps.len().to_string())
    }

    /// Puts everything back, the last replacement first.
    fn undo(&mut self) -> io::Result<()> {
        let mut result = Ok(());
        while let Some((target, kept)) = self.steps.pop() {
            let step = match kept {
                Some(kept) => fs::rename(kept, &target),
                None => unless_missing(fs::remove_file(&target)).map(|_| ()),
            };
            result = result.and(step);
        }
        result
    }
}

/// Whether the file existed on which an operation was tried.
fn unless_missing(result: io::Result<()>) -> io::Result<bool> {
    match result {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests;
