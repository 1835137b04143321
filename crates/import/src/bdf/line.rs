//! Lines of a deck, in which each INCLUDE line is replaced by the contents of the included file.

use std::io;
use std::path::Path;

use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use crate::includes::{Includes, OpenFile};

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
pub fn read(
    path: &Path,
    open: OpenFile<'_>,
    findings: &mut ImportFindings,
) -> io::Result<Vec<BulkLine>> {
    let bytes = open(path)?;
    let includes = Includes::new(path, open, "INCLUDE");
    let mut reader = Reader {
        includes,
        lines: Vec::new(),
        ended: false,
    };
    reader.file(path, &bytes, findings);
    Ok(reader.lines)
}

struct Reader<'a> {
    includes: Includes<'a>,
    lines: Vec<BulkLine>,
    ended: bool,
}

impl Reader<'_> {
    fn file(&mut self, path: &Path, bytes: &[u8], findings: &mut ImportFindings) {
        let file = self.includes.begin(path, findings);
        // comments may have any encoding; a replaced byte in a field causes an error when the field is read
        let text = String::from_utf8_lossy(bytes);
        let mut gap = false;
        for (index, raw) in text.lines().enumerate() {
            let at = FilePlace {
                file,
                line: index + 1,
                column: 1,
            };
            let text = raw.split('$').next().unwrap_or_default().trim_end();
            if text.trim().is_empty() {
                gap |= raw.trim().is_empty();
                continue;
            }
            // some decks separate parts by lines of this sign
            if text.chars().all(|c| matches!(c, '&' | ' ' | '\t')) {
                continue;
            }
            if let Some(name) = included(text) {
                self.include(name, at, findings);
            } else if text
                .trim_start()
                .to_ascii_uppercase()
                .starts_with("ENDDATA")
            {
                self.ended = true;
            } else {
                self.lines.push(BulkLine {
                    at,
                    text: expanded(text),
                    gap,
                });
            }
            gap = false;
            if self.ended {
                break;
            }
        }
        self.includes.end();
    }

    fn include(&mut self, name: Result<&str, ()>, at: FilePlace, findings: &mut ImportFindings) {
        let Ok(name) = name else {
            let fault = ImportFinding::new(
                at,
                "INCLUDE",
                "must be followed by a file name in quotation marks",
            );
            findings.error(fault.hint("write INCLUDE 'file name' on one line"));
            return;
        };
        match self.includes.open(name, at, findings) {
            Some((path, bytes)) => self.file(&path, &bytes, findings),
            None => self.ended |= Includes::is_full(findings),
        }
    }
}

/// Returns the file name of an INCLUDE line, `Err` if it is missing or its quotation marks do not match, and `None`
/// for any other line.
fn included(text: &str) -> Option<Result<&str, ()>> {
    let text = text.trim_start();
    let word = text.get(..7)?;
    let rest = &text[7..];
    if !word.eq_ignore_ascii_case("INCLUDE")
        || rest.starts_with(|c: char| c.is_ascii_alphanumeric())
    {
        return None;
    }
    let rest = rest.trim_start_matches([' ', '\t', '=', ',']).trim_end();
    for quote in ['\'', '"'] {
        if let Some(inside) = rest.strip_prefix(quote) {
            let name = inside
                .strip_suffix(quote)
                .filter(|name| !name.is_empty() && !name.contains(quote));
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
