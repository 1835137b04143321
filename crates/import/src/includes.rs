//! Files of a model that include each other.

use std::io;
use std::path::{Path, PathBuf};

use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use formats::text::inputs::read_error_message;

/// Function that reads a file; the command line and the tests supply different ones.
pub type OpenFile<'a> = &'a dyn Fn(&Path) -> io::Result<Vec<u8>>;

/// Largest number of files of a model. A larger number indicates files that include each other repeatedly.
const MOST_FILES: usize = 1000;

/// The files that are being read, each included by the one before it.
pub(crate) struct Includes<'a> {
    open: OpenFile<'a>,
    /// The statement that includes a file, as messages name it.
    statement: &'static str,
    /// Folder of the file that is read first.
    main: PathBuf,
    stack: Vec<PathBuf>,
}

impl<'a> Includes<'a> {
    /// Prepares reading a file and those that it includes by `statement`.
    pub fn new(path: &Path, open: OpenFile<'a>, statement: &'static str) -> Includes<'a> {
        Includes {
            open,
            statement,
            main: folder(path),
            stack: Vec::new(),
        }
    }

    /// Begins with a file and returns its number; [`Includes::end`] ends it.
    pub fn begin(&mut self, path: &Path, findings: &mut ImportFindings) -> usize {
        findings.files.push(path.display().to_string());
        self.stack.push(path.to_path_buf());
        findings.files.len() - 1
    }

    /// Ends the file begun last.
    pub fn end(&mut self) {
        self.stack.pop();
    }

    /// Path and contents of the file that the file begun last includes by `name`, which is relative to its folder or to
    /// that of the first file. Adds an error at `at` and returns `None` if it cannot be read, is being read already, or is
    /// one too many.
    pub fn open(
        &self,
        name: &str,
        at: FilePlace,
        findings: &mut ImportFindings,
    ) -> Option<(PathBuf, Vec<u8>)> {
        let from = self
            .stack
            .last()
            .map(|path| folder(path))
            .unwrap_or_default();
        let places = [from.join(name), self.main.join(name)];
        let mut read = Err(io::ErrorKind::NotFound.into());
        let mut path = &places[0];
        for place in &places {
            if read.is_err() {
                path = place;
                read = (self.open)(place);
            }
        }
        let refuse = |expected: String, hint: &str| {
            ImportFinding::new(at, self.statement, expected).hint(hint)
        };
        let fault = match read {
            Err(error) => {
                let expected = format!("{} {}", places[0].display(), read_error_message(&error));
                refuse(
                    expected,
                    "names are relative to the folder of the including file or of the main file",
                )
            }
            Ok(_) if self.stack.contains(path) => {
                let expected = "must not include a file that is already being read".to_owned();
                refuse(expected, "remove an inclusion from this loop").with_found(name)
            }
            Ok(_) if Includes::is_full(findings) => refuse(
                "includes too many files".to_owned(),
                "a model may include at most 999 files",
            ),
            Ok(bytes) => return Some((path.clone(), bytes)),
        };
        findings.error(fault);
        None
    }

    /// Whether the model has as many files as it may have.
    pub fn is_full(findings: &ImportFindings) -> bool {
        findings.files.len() >= MOST_FILES
    }
}

fn folder(path: &Path) -> PathBuf {
    path.parent().map(Path::to_path_buf).unwrap_or_default()
}
