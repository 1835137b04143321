//! The header of every file of this program: its format, and its default name.

use crate::text::fault::Faults;
use crate::text::place::Place;

/// Checks that the member `format` is present and equal to `expected`.
pub fn format(found: &Option<String>, expected: &str, root: &Place<'_>, faults: &mut Faults) {
    if let Some(word) = faults.require(found, root, "format") {
        faults.one_of(word, &root.key("format"), &[(expected, ())]);
    }
}

/// The name of a file without folder and extension.
pub fn stem(file: &str) -> String {
    let path = std::path::Path::new(file);
    path.file_stem().map_or_else(|| file.to_owned(), |stem| stem.to_string_lossy().into_owned())
}
