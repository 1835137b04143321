//! Input files: read once, remembered with their hashes.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::diagnostic::Diagnostic;
use crate::source::Source;

/// One input file of a job.
#[derive(Clone, Debug)]
pub struct Input {
    /// As named by the user or by the file that refers to it.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
    /// Its text.
    pub source: Source,
}

impl Input {
    fn read(name: String, path: &Path) -> Result<Input, Unread> {
        let bytes = std::fs::read(path).map_err(|error| Unread::Io(cannot_read(&error)))?;
        let sha256 = sha256(&bytes);
        let source = Source::from_bytes(path.display().to_string(), bytes).map_err(Unread::Text)?;
        Ok(Input { name, sha256, source })
    }
}

/// The input files of a job; names are relative to the folder of the first.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    folder: PathBuf,
    read: Vec<Input>,
}

impl Inputs {
    /// Starts with the file that the user named.
    ///
    /// # Errors
    /// A file that cannot be read or is not text.
    pub fn open(path: &Path) -> Result<(Inputs, Source), Box<Diagnostic>> {
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let first = Input::read(name, path).map_err(|unread| match unread {
            Unread::Io(why) => Box::new(Diagnostic::of_file(path.display().to_string(), why)),
            Unread::Text(diagnostic) => diagnostic,
        })?;
        let source = first.source.clone();
        Ok((Inputs { folder, read: vec![first] }, source))
    }

    /// Reads a file that another one refers to, or takes it from memory where it was read before.
    ///
    /// # Errors
    /// Why it cannot be read, in words; or that it is not text, placed in it.
    pub fn refer(&mut self, name: &str) -> Result<Source, Unread> {
        if let Some(known) = self.find(name) {
            return Ok(known.source.clone());
        }
        let input = Input::read(name.to_owned(), &self.folder.join(name))?;
        let source = input.source.clone();
        self.read.push(input);
        Ok(source)
    }

    /// The file that was read under this name.
    #[must_use]
    pub(crate) fn find(&self, name: &str) -> Option<&Input> {
        self.read.iter().find(|input| input.name == name)
    }

    /// All files read, in the order of reading.
    #[must_use]
    pub fn all(&self) -> &[Input] {
        &self.read
    }
}

/// Why a file that another one refers to gave no text.
#[derive(Debug)]
pub enum Unread {
    /// The file system's reason.
    Io(String),
    /// Bytes that are not text, placed in the file itself.
    Text(Box<Diagnostic>),
}

/// Why the file system gave nothing, in plain words.
pub(crate) fn cannot_read(error: &std::io::Error) -> String {
    let why = match error.kind() {
        std::io::ErrorKind::NotFound => "no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        std::io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
        _ => error.to_string(),
    };
    format!("cannot be read: {why}")
}

/// SHA-256 in hexadecimal.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
