//! Lines of a deck, in which each INCLUDE line is replaced by the contents of the included file.

use std::io;
use std::path::{Path, PathBuf};

use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use formats::text::inputs::read_error_message;

/// Function that reads a file; the command line and the tests supply different ones.
pub type OpenFile<'a> = &'a dyn Fn(&Path) -> io::Result<Vec<u8>>;

/// Largest number of files of a deck. A larger number indicates files that include each other repeatedly.
const MOST_FILES: usize = 1000;

/// A line without its comment. Blank lines are not stored.
#[derive(Clone, Debug)]
pub struct BulkLine {
    /// Position of its beginning.
    pub at: FilePlace,
    /// Its characters.
    pub text: String,
    /// Whether a blank line precedes it.
    pub gap: bool,
}

/// Reads the lines of a deck and of all included files, up to ENDDATA.
///
/// # Errors
/// The deck itself cannot be read. Errors of included files are added to the findings.
pub fn read(path: &Path, open: OpenFile<'_>, findings: &mut ImportFindings) -> io::Result<Vec<BulkLine>> {
    let bytes = open(path)?;
    let mut reader = Reader { open, lines: Vec::new(), stack: Vec::new(), main: folder(path), ended: false };
    reader.file(path, &bytes, findings);
    Ok(reader.lines)
}

fn folder(path: &Path) -> PathBuf {
    path.parent().map(Path::to_path_buf).unwrap_or_default()
}

struct Reader<'a> {
    open: OpenFile<'a>,
    lines: Vec<BulkLine>,
    stack: Vec<PathBuf>,
    main: PathBuf,
    ended: bool,
}

impl Reader<'_> {
    fn file(&mut self, path: &Path, bytes: &[u8], findings: &mut ImportFindings) {
        let file = findings.files.len();
        findings.files.push(path.display().to_string());
        self.stack.push(path.to_path_buf());
        // comments may have any encoding; a replaced byte in a field causes an error when the field is read
        let text = String::from_utf8_lossy(bytes);
        let mut gap = false;
        for (index, raw) in text.lines().enumerate() {
            let at = FilePlace { file, line: index + 1, column: 1 };
            let text = raw.split('$').next().unwrap_or_default().trim_end();
            if text.trim().is_empty() {
                gap |= raw.trim().is_empty();
                continue;
            }
            if let Some(name) = included(text) {
                self.include(path, name, at, findings);
            } else if text.trim_start().to_ascii_uppercase().starts_with("ENDDATA") {
                self.ended = true;
            } else {
                self.lines.push(BulkLine { at, text: expanded(text), gap });
            }
            gap = false;
            if self.ended {
                break;
            }
        }
        self.stack.pop();
    }

    fn include(&mut self, from: &Path, name: Result<&str, ()>, at: FilePlace, findings: &mut ImportFindings) {
        let refuse = |expected: &str, hint: &str| ImportFinding::new(at, "INCLUDE", expected).hint(hint);
        let Ok(name) = name else {
            let hint = "write INCLUDE 'file name' in one line";
            findings.error(refuse("must name a file between quotation marks", hint));
            return;
        };
        let places = [folder(from).join(name), self.main.join(name)];
        let mut read = Err(io::ErrorKind::NotFound.into());
        let mut path = &places[0];
        for place in &places {
            if read.is_err() {
                path = place;
                read = (self.open)(place);
            }
        }
        let bytes = match read {
            Ok(bytes) => bytes,
            Err(error) => {
                let expected = format!("{} {}", places[0].display(), read_error_message(&error));
                findings.error(refuse(&expected, "names are relative to the file that includes"));
                return;
            }
        };
        if self.stack.contains(path) {
            findings.error(
                refuse("must not include a file that is already being read", "remove one of the INCLUDEs")
                    .with_found(name),
            );
        } else if findings.files.len() >= MOST_FILES {
            findings.error(refuse("includes too many files", "a deck may include up to 999 files"));
            self.ended = true;
        } else {
            self.file(&path.clone(), &bytes, findings);
        }
    }
}

/// Returns the file name of an INCLUDE line, `Err` if it is missing or its quotation marks do not match, and `None`
/// for any other line.
fn included(text: &str) -> Option<Result<&str, ()>> {
    let text = text.trim_start();
    let word = text.get(..7)?;
    let rest = &text[7..];
    if !word.eq_ignore_ascii_case("INCLUDE") || rest.starts_with(|c: char| c.is_ascii_alphanumeric()) {
        return None;
    }
    let rest = rest.trim_start_matches([' ', '\t', '=', ',']).trim_end();
    for quote in ['\'', '"'] {
        if let Some(inside) = rest.strip_prefix(quote) {
            let name = inside.strip_suffix(quote).filter(|name| !name.is_empty() && !name.contains(quote));
            return Some(name.ok_or(()));
        }
    }
    let plain = !rest.is_empty() && !rest.contains(['\'', '"']);
    Some(if plain { Ok(rest) } else { Err(()) })
}

/// Replaces each tab by blanks up to the next field of eight columns (in free format, by one blank).
fn expanded(text: &str) -> String {
    if !text.contains('\t') || text.contains(',') {
        return text.replace('\t', " ");
    }
    let mut out = String::new();
    let mut column = 0;
    for c in text.chars() {
        if c == '\t' {
            let width = 8 - column % 8;
            out.extend(std::iter::repeat_n(' ', width));
            column += width;
        } else {
            out.push(c);
            column += 1;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn included_names_are_found_with_and_without_quotes() {
        assert_eq!(included("INCLUDE 'a b.bdf'"), Some(Ok("a b.bdf")));
        assert_eq!(included("  include \"a.bdf\"  "), Some(Ok("a.bdf")));
        assert_eq!(included("INCLUDE sub/a.bdf"), Some(Ok("sub/a.bdf")));
        assert_eq!(included("INCLUDE 'a.bdf"), Some(Err(())));
        assert_eq!(included("INCLUDE"), Some(Err(())));
        assert_eq!(included("INCLUDED 1"), None);
        assert_eq!(included("GRID"), None);
    }

    #[test]
    fn tabs_lead_to_the_next_field() {
        assert_eq!(expanded("GRID\t1\t\t2."), "GRID    1               2.");
        assert_eq!(expanded("GRID,\t1"), "GRID, 1");
    }
}
