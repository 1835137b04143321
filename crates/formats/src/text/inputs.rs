//! Input files: each is read once and stored with its hash.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::diagnostic::Diagnostic;
use super::source::Source;

/// One input file of a job.
#[derive(Clone, Debug)]
pub struct Input {
    /// Name used by the user or by the file that refers to it.
    pub name: String,
    /// Name used in messages.
    pub display_name: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
    /// Its contents.
    pub bytes: Vec<u8>,
}

impl Input {
    fn read(name: String, path: &Path) -> Result<Input, String> {
        let bytes = std::fs::read(path).map_err(|error| read_error_message(&error))?;
        Ok(Input { name, display_name: path.display().to_string(), sha256: sha256(&bytes), bytes })
    }

    /// Its text.
    ///
    /// # Errors
    /// Bytes that are not UTF-8, with their place.
    pub fn source(&self) -> Result<Source, Box<Diagnostic>> {
        Source::from_bytes(self.display_name.clone(), self.bytes.clone())
    }
}

/// The input files of a job. Names are relative to the folder of the first file.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    folder: PathBuf,
    read: Vec<Input>,
}

impl Inputs {
    /// Opens the file that the user named.
    ///
    /// # Errors
    /// A file that cannot be read or is not text.
    pub fn open(path: &Path) -> Result<(Inputs, Source), Box<Diagnostic>> {
        let inputs = Inputs::open_bytes(path)?;
        let source = inputs.read[0].source()?;
        Ok((inputs, source))
    }

    /// Opens the file that the user named, which need not be text. It is the first of [`Inputs::all`].
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn open_bytes(path: &Path) -> Result<Inputs, Box<Diagnostic>> {
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let first = Input::read(name, path)
            .map_err(|why| Box::new(Diagnostic::of_file(path.display().to_string(), why)))?;
        Ok(Inputs { folder, read: vec![first] })
    }

    /// Reads a file to which another one refers, or returns the stored contents if it has been read before.
    ///
    /// # Errors
    /// The reason why it cannot be read, as text.
    pub fn open_referenced(&mut self, name: &str) -> Result<&Input, String> {
        let index = match self.read.iter().position(|input| input.name == name) {
            Some(index) => index,
            None => {
                self.read.push(Input::read(name.to_owned(), &self.folder.join(name))?);
                self.read.len() - 1
            }
        };
        Ok(&self.read[index])
    }

    /// The file that was read under this name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&Input> {
        self.read.iter().find(|input| input.name == name)
    }

    /// All files read, in the order in which they were read.
    #[must_use]
    pub fn all(&self) -> &[Input] {
        &self.read
    }
}

/// Message of an error of the file system.
pub fn read_error_message(error: &std::io::Error) -> String {
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
