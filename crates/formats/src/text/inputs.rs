//! Input files: each is read once and stored with its hash.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::diagnostic::Diagnostic;
#[cfg(unix)]
use super::pipe;
use super::source::Source;
use crate::limits::FILE_BYTES;

/// Time to wait for a program that writes into a pipe, s.
#[cfg(unix)]
const PATIENCE: i64 = 10;

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
        let bytes = read_limited(path, FILE_BYTES)?;
        Ok(Input {
            name,
            display_name: path.display().to_string(),
            sha256: sha256(&bytes),
            bytes,
        })
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
        let name = path
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let first = Input::read(name, path)
            .map_err(|why| Box::new(Diagnostic::of_file(path.display().to_string(), why)))?;
        Ok(Inputs {
            folder,
            read: vec![first],
        })
    }

    /// A first file that exists in memory alone, and whose references are relative to `folder`. Messages call it `name`.
    ///
    /// ```
    /// use formats::text::inputs::Inputs;
    ///
    /// let (inputs, source) = Inputs::of_text("spec", "{}".to_owned(), "models".as_ref());
    /// assert_eq!((inputs.all()[0].name.as_str(), source.name.as_str()), ("spec", "spec"));
    /// assert_eq!(inputs.all()[0].bytes, b"{}");
    /// ```
    #[must_use]
    pub fn of_text(name: &str, text: String, folder: &Path) -> (Inputs, Source) {
        let mut inputs = Inputs {
            folder: folder.to_path_buf(),
            read: Vec::new(),
        };
        inputs.add(name, text.clone().into_bytes());
        (
            inputs,
            Source {
                name: name.to_owned(),
                text,
            },
        )
    }

    /// Adds a file that exists in memory alone, and to which others refer by `name`.
    pub fn add(&mut self, name: &str, bytes: Vec<u8>) {
        let sha256 = sha256(&bytes);
        self.read.push(Input {
            name: name.to_owned(),
            display_name: name.to_owned(),
            sha256,
            bytes,
        });
    }

    /// Adds files that were read for another job of the same folder, so that they are not read again.
    pub fn keep<'i>(&mut self, files: impl IntoIterator<Item = &'i Input>) {
        for file in files {
            if self.find(&file.name).is_none() {
                self.read.push(file.clone());
            }
        }
    }

    /// Reads a file to which another one refers, or returns the stored contents if it has been read before.
    ///
    /// # Errors
    /// The reason why it cannot be read, as text.
    pub fn open_referenced(&mut self, name: &str) -> Result<&Input, String> {
        let index = match self.read.iter().position(|input| input.name == name) {
            Some(index) => index,
            None => {
                self.read
                    .push(Input::read(name.to_owned(), &self.folder.join(name))?);
                self.read.len() - 1
            }
        };
        Ok(&self.read[index])
    }

    /// Puts other contents in place of those of a file, by its index in [`Inputs::all`].
    ///
    /// # Panics
    /// If there is no such file.
    pub fn replace(&mut self, index: usize, bytes: Vec<u8>) {
        self.read[index].sha256 = sha256(&bytes);
        self.read[index].bytes = bytes;
    }

    /// The file that was read under this name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&Input> {
        self.read.iter().find(|input| input.name == name)
    }

    /// Numbers of JSON files that were probably meant with a decimal comma ([`Source::decimal_commas`]).
    #[must_use]
    pub fn decimal_commas(&self) -> Vec<String> {
        let is_json = |input: &&Input| input.name.ends_with(".json");
        let sources = self
            .read
            .iter()
            .filter(is_json)
            .filter_map(|input| input.source().ok());
        sources.flat_map(|source| source.decimal_commas()).collect()
    }

    /// All files read, in the order in which they were read.
    #[must_use]
    pub fn all(&self) -> &[Input] {
        &self.read
    }
}

/// Reads a regular file or a pipe of at most the maximum size of an input file.
///
/// # Errors
/// The file cannot be read or is too large.
pub fn read_file(path: &Path) -> std::io::Result<Vec<u8>> {
    let reason = |message: String| message.trim_start_matches("cannot be read: ").to_owned();
    read_limited(path, FILE_BYTES).map_err(|message| std::io::Error::other(reason(message)))
}

/// Reads a regular file or a pipe of at most `most` bytes. Devices are refused, because they may have no end.
fn read_limited(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let message = |error: std::io::Error| read_error_message(&error);
    let kind = std::fs::metadata(path).map_err(message)?;
    if !(kind.is_file() || kind.is_dir() || is_pipe(&kind)) {
        return Err("cannot be read: it is neither a file nor a pipe".to_owned());
    }
    let mut bytes = Vec::new();
    let is_written = read_bytes(path, is_pipe(&kind), most + 1, &mut bytes).map_err(message)?;
    if !is_written {
        return Err("cannot be read: nothing is written into this pipe".to_owned());
    }
    if bytes.len() as u64 > most {
        return Err(format!(
            "cannot be read: it has more than {} MB, the maximum size of an input file",
            most >> 20
        ));
    }
    Ok(bytes)
}

/// Appends at most `most` bytes of a file or pipe; returns whether there was a writer of the pipe.
fn read_bytes(path: &Path, is_pipe: bool, most: u64, bytes: &mut Vec<u8>) -> std::io::Result<bool> {
    #[cfg(unix)]
    if is_pipe {
        return pipe::read(path, most, PATIENCE, bytes);
    }
    debug_assert!(!is_pipe, "pipes have names on Unix alone");
    File::open(path)?
        .take(most)
        .read_to_end(bytes)
        .map(|_| true)
}

#[cfg(unix)]
fn is_pipe(kind: &std::fs::Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&kind.file_type())
}

#[cfg(not(unix))]
fn is_pipe(_: &std::fs::Metadata) -> bool {
    false
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
    Sha256::digest(bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit_and_refused_beyond() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
        let size = std::fs::metadata(&path)
            .expect("the manifest of this crate")
            .len();
        assert_eq!(
            read_limited(&path, size).map(|bytes| bytes.len() as u64),
            Ok(size)
        );
        let why = read_limited(&path, size - 1).expect_err("one byte too long");
        assert!(why.starts_with("cannot be read: it has more than"), "{why}");
    }
}
