//! Output folders: which of their files belong to the program, and how a new result replaces an older one.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::mem;
use std::path::{Component, Path, PathBuf};

use crate::Error;
use crate::files::{cannot_write, clear_dead_files, folder_of, sync, temporaries, temporary};
use crate::hashed::HashedWriter;
use crate::journal::Journal;
use crate::manifest::{MANIFEST, Manifest, OutputEntry, listed_files};
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::sha256;
use staging::{FileContents, Staging};

mod staging;

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

/// An output folder that is locked for one run. Its files are written to the disk under temporary names while the run goes
/// on, until [`OutputFolder::commit`] places them. A run that does not commit leaves the folder as it was.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// Names of the files, and their numbers in the temporary folder.
    files: Vec<(String, usize)>,
    /// Removed before the folder itself.
    staging: Option<Staging>,
    journal: Journal,
    /// Files of the folder that the program wrote, by its manifest and by the journal of a run that has not ended.
    listed: Vec<OutputEntry>,
    may_replace_all: bool,
    /// Folders that did not exist before, outermost first.
    created: Vec<PathBuf>,
    keeps_journal: bool,
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
        let mut created: Vec<PathBuf> = path
            .ancestors()
            .take_while(|part| !part.exists())
            .map(Path::to_path_buf)
            .collect();
        created.reverse();
        created.retain(|part| !part.as_os_str().is_empty());
        fs::create_dir_all(path).map_err(fail)?;
        let Some(journal) = Journal::open(path).map_err(fail)? else {
            let fault = Diagnostic::of_file(
                path.display().to_string(),
                "another run is writing into this folder",
            );
            return Err(fault
                .hint("wait until it ends, or name another folder with -o")
                .into());
        };
        let keeps_journal = !journal.listed().is_empty();
        let listed = journal.listed().to_vec();
        let mut folder = OutputFolder {
            path: path.to_path_buf(),
            files: Vec::new(),
            staging: None,
            journal,
            listed,
            may_replace_all: force,
            created,
            keeps_journal,
        };
        folder.clear_dead();
        let older = fs::read(path.join(MANIFEST))
            .ok()
            .and_then(|text| listed_files(&text));
        folder.listed.extend(older.into_iter().flatten());
        let mut names = planned.names.clone();
        names.extend(folder.pictures(&planned.plots));
        names.push(MANIFEST.to_owned());
        folder.check_owner(names.iter().map(String::as_str))?;
        folder.journal.begin(command).map_err(fail)?;
        folder.staging = Some(Staging::new(path).map_err(fail)?);
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
        let entries = fs::read_dir(self.path.join(PLOTS))
            .into_iter()
            .flatten()
            .flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names
            .filter(|name| {
                name.ends_with(".svg") && beginnings.iter().any(|start| name.starts_with(start))
            })
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
            let last = Path::new(name)
                .file_name()
                .unwrap_or_default()
                .to_string_lossy();
            if is_too_long(&folder_of(&path), &last) {
                return Err(cannot_write(&path, &io::ErrorKind::InvalidFilename.into()));
            }
            let Ok(there) = path.symlink_metadata() else {
                continue;
            };
            let file = path.display().to_string();
            if there.is_dir() {
                foreign.push(
                    Diagnostic::of_file(
                        file,
                        "is a folder, and a file of this name is to be written",
                    )
                    .hint("move it, or name another folder with -o"),
                );
            } else if !self.may_replace_all && !self.is_ours(name) {
                foreign.push(
                    Diagnostic::of_file(
                        file,
                        "would be overwritten, but was not written by girderway or was modified since",
                    )
                    .hint("move it, name another folder with -o, or overwrite it with --force"),
                );
            }
        }
        if foreign.is_empty() {
            Ok(())
        } else {
            Err(foreign.into())
        }
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
        let mut entries = self
            .listed
            .iter()
            .filter(|entry| entry.name == name)
            .peekable();
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
        self.put(
            name,
            written.map_err(|error| cannot_write(&self.path.join(name), &error))?,
        );
        Ok(())
    }

    fn put(&mut self, name: &str, contents: FileContents) {
        let number = self.staging().begin(contents);
        self.files.retain(|(known, _)| known != name);
        self.files.push((name.to_owned(), number));
    }

    fn staging(&mut self) -> &mut Staging {
        self.staging
            .as_mut()
            .expect("it is there from the opening to the end")
    }

    /// Places all files and then `manifest.json`, which lists them.
    ///
    /// All files, the manifest last, have first been written to the disk in a temporary folder. The journal then lists the
    /// files of the older result and of the new one. The older manifest is put aside, so that a manifest never lists files
    /// of another run; the files are renamed; the new manifest comes last. If one of these steps fails, the older result is
    /// put back. Only then are files of the older result removed that the new one does not have and nobody has changed,
    /// and at last the journal.
    ///
    /// # Errors
    /// A file that would be replaced belongs to somebody else, or an operation of the file system fails; the error
    /// contains the name of the file.
    pub fn commit(mut self, mut manifest: Manifest) -> Result<PathBuf, Error> {
        self.files.sort_by(|a, b| a.0.cmp(&b.0));
        let names = self.files.iter().map(|(name, _)| name.as_str());
        self.check_owner(names.chain([MANIFEST]))?;
        self.write(&mut manifest)
            .map_err(|(file, error)| cannot_write(&file, &error))?;
        self.clear_older();
        self.keeps_journal = false;
        self.created.clear();
        Ok(self.path.clone())
    }

    fn write(&mut self, manifest: &mut Manifest) -> Result<(), (PathBuf, io::Error)> {
        self.finish_files(manifest)?;
        let number = self
            .staging()
            .begin(FileContents::Fixed(manifest.text().into_bytes()));
        let all = self.listed.iter().chain(&manifest.outputs);
        let entries: Vec<OutputEntry> = all
            .filter(|entry| !self.journal.listed().contains(entry))
            .cloned()
            .collect();
        self.journal.list(&entries).map_err(at(&self.path))?;
        self.staging()
            .finish(number)
            .map_err(at(&self.path.join(MANIFEST)))?;
        let staging = self
            .staging
            .take()
            .expect("it is there from the opening to the end");
        let mut exchange = Exchange {
            staging: &staging,
            steps: Vec::new(),
        };
        let placed = self.place(&mut exchange, number);
        if placed.is_err() && exchange.undo().is_err() {
            // the older files remain beside the new ones, and the next run may replace both
            self.keeps_journal = true;
            staging.keep();
        }
        placed
    }

    /// Waits until all files are on the disk, and lists them in the manifest.
    fn finish_files(&mut self, manifest: &mut Manifest) -> Result<(), (PathBuf, io::Error)> {
        let staging = self
            .staging
            .as_mut()
            .expect("it is there from the opening to the end");
        for (name, number) in &self.files {
            let hash = staging.finish(*number).map_err(at(&self.path.join(name)))?;
            let (bytes, sha256) = hash.unzip();
            manifest.outputs.push(OutputEntry {
                name: name.clone(),
                bytes,
                sha256,
            });
        }
        Ok(())
    }

    /// Renames all files from the temporary folder, the manifest of the given number last.
    fn place(&self, exchange: &mut Exchange, number: usize) -> Result<(), (PathBuf, io::Error)> {
        let manifest = self.path.join(MANIFEST);
        let mut folders = vec![self.path.clone()];
        exchange.take_away(&manifest).map_err(at(&manifest))?;
        for (name, number) in &self.files {
            let target = self.path.join(name);
            let folder = folder_of(&target);
            if !folders.contains(&folder) {
                fs::create_dir_all(&folder).map_err(at(&folder))?;
                folders.push(folder);
            }
            exchange.replace(&target, *number).map_err(at(&target))?;
        }
        for folder in &folders {
            sync(folder).map_err(at(folder))?;
        }
        exchange.replace(&manifest, number).map_err(at(&manifest))?;
        sync(&self.path).map_err(at(&self.path))
    }

    /// Removes files of older runs that have not been changed since and that this run does not write.
    fn clear_older(&mut self) {
        for entry in mem::take(&mut self.listed) {
            let name = entry.name.as_str();
            let is_inside = Path::new(name)
                .components()
                .all(|part| matches!(part, Component::Normal(_)));
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
        self.staging = None;
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
    let there = path
        .ancestors()
        .find(|part| !part.as_os_str().is_empty() && part.exists());
    if let Some(part) = there.filter(|part| !part.is_dir()) {
        let expected = format!("cannot be an output folder: {} is a file", part.display());
        return Err(Diagnostic::of_file(path.display().to_string(), expected).into());
    }
    Ok(())
}

/// Whether `name` is too long for the file system of a folder, which need not exist yet.
#[must_use]
pub fn is_too_long(folder: &Path, name: &str) -> bool {
    let there = folder
        .ancestors()
        .find(|part| part.is_dir())
        .unwrap_or(Path::new("."));
    let found = there.join(name).symlink_metadata();
    found.is_err_and(|error| error.kind() == io::ErrorKind::InvalidFilename)
}

fn at(file: &Path) -> impl FnOnce(io::Error) -> (PathBuf, io::Error) + use<> {
    let file = file.to_path_buf();
    move |error| (file, error)
}

/// Replacements of files that can be undone. What was there before is kept in the temporary folder.
struct Exchange<'s> {
    staging: &'s Staging,
    /// Each file, and where the one that was there before is kept.
    steps: Vec<(PathBuf, Option<PathBuf>)>,
}

impl Exchange<'_> {
    /// Moves a file to the temporary folder, if it exists.
    fn take_away(&mut self, target: &Path) -> io::Result<()> {
        let kept = self.place_of_next();
        let was_there = unless_missing(fs::rename(target, &kept))?;
        self.steps
            .push((target.to_path_buf(), was_there.then_some(kept)));
        Ok(())
    }

    /// Renames the new file of a number to `target`. What was there has a second name in the temporary folder from then on,
    /// so that `target` exists at every instant.
    fn replace(&mut self, target: &Path, number: usize) -> io::Result<()> {
        let kept = self.place_of_next();
        let was_there = unless_missing(fs::hard_link(target, &kept))
            .or_else(|_| unless_missing(fs::rename(target, &kept)))?;
        self.steps
            .push((target.to_path_buf(), was_there.then_some(kept)));
        fs::rename(self.staging.path(number), target)
    }

    fn place_of_next(&self) -> PathBuf {
        self.staging.path_of_older(self.steps.len())
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
