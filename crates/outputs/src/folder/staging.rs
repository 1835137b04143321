//! The temporary folder in which the files of a run are written to the disk while the run goes on.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempDir};

use crate::files::TEMPORARY;
use formats::text::inputs::sha256;
use results::threads::Background;

/// Number of files that are written to the disk at the same time. Their threads wait for the disk, which takes most files
/// in one go with the others, so that their number does not follow from that of the processors.
const AT_ONCE: u16 = 8;

/// The contents of a file of the folder.
#[derive(Debug)]
pub(crate) enum FileContents {
    /// In memory, with their hash in the manifest.
    Fixed(Vec<u8>),
    /// In memory; they may differ between equal runs.
    Varying(Vec<u8>),
    /// In a temporary file, with their number of bytes and SHA-256.
    Written(NamedTempFile, usize, String),
}

/// Number of bytes of a file and their SHA-256 in hexadecimal; `None` where they may differ between equal runs.
type Hash = Option<(usize, String)>;

impl FileContents {
    /// Writes them to the disk, under a path of the same file system.
    fn put_at(self, path: &Path) -> io::Result<Hash> {
        let create = |bytes: &[u8]| {
            let mut file = fs::File::create(path)?;
            file.write_all(bytes)?;
            file.sync_all()
        };
        match self {
            FileContents::Fixed(bytes) => {
                create(&bytes)?;
                Ok(Some((bytes.len(), sha256(&bytes))))
            }
            FileContents::Varying(bytes) => create(&bytes).map(|()| None),
            FileContents::Written(file, bytes, sha256) => {
                fs::rename(file.path(), path)?;
                file.as_file().sync_all()?;
                Ok(Some((bytes, sha256)))
            }
        }
    }
}

/// A temporary folder with numbered files. Dropped, it is removed with all that is in it.
#[derive(Debug)]
pub(crate) struct Staging {
    /// Before the folder: its files are whole before it is removed.
    writers: Background<(FileContents, PathBuf), io::Result<Hash>>,
    folder: TempDir,
    /// Number of files so far, and what has become of those that were waited for; `None` where it has been asked.
    count: usize,
    written: Vec<Option<io::Result<Hash>>>,
}

impl Staging {
    /// Creates the folder in an output folder.
    pub fn new(parent: &Path) -> io::Result<Staging> {
        let folder = tempfile::Builder::new()
            .prefix(TEMPORARY)
            .tempdir_in(parent)?;
        let put = |(contents, path): (FileContents, PathBuf)| contents.put_at(&path);
        Ok(Staging {
            writers: Background::new(AT_ONCE, put),
            folder,
            count: 0,
            written: Vec::new(),
        })
    }

    /// Begins to write a file and returns its number.
    pub fn begin(&mut self, contents: FileContents) -> usize {
        let number = self.count;
        self.writers.begin((contents, self.path(number)));
        self.count += 1;
        number
    }

    /// Waits until the file of this number is on the disk, for which it is asked once.
    pub fn finish(&mut self, number: usize) -> io::Result<Hash> {
        if self.written.len() <= number {
            self.written
                .extend(self.writers.wait().into_iter().map(Some));
        }
        self.written[number].take().expect("it is asked once")
    }

    /// Path of the file of this number.
    pub fn path(&self, number: usize) -> PathBuf {
        self.folder.path().join(number.to_string())
    }

    /// Path at which an older file is kept that is the `step`-th to be replaced.
    pub fn path_of_older(&self, step: usize) -> PathBuf {
        self.folder.path().join(format!("older-{step}"))
    }

    /// Leaves the folder on the disk.
    pub fn keep(self) {
        let _ = self.folder.keep();
    }
}
