//! Inputs of a call: a path, or the text of a dictionary.

use std::path::PathBuf;

use formats::scene::SceneSource;
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::Inputs;
use formats::text::source::Source;
use pyo3::prelude::*;

/// Names by which messages call the texts of dictionaries.
const IN_MEMORY: [&str; 5] = ["scene", "changes", "spec", "design", "argument"];

/// Whether messages call the text of a dictionary, or an argument, by this name.
pub(crate) fn is_in_memory(file: &str) -> bool {
    IN_MEMORY.contains(&file)
}

/// An input as the package passes it: a path, or a text and the folder of the files that it names.
#[derive(Clone, Debug, FromPyObject)]
pub(crate) enum GivenInput {
    /// A text, and the folder.
    Text(String, PathBuf),
    /// A file.
    Path(PathBuf),
}

impl GivenInput {
    /// The files of the input, of which it is the first, and its text. Messages call a text in memory `name`.
    pub(crate) fn open(self, name: &str) -> Result<(Inputs, Source), Vec<Diagnostic>> {
        match self {
            GivenInput::Text(text, folder) => Ok(Inputs::of_text(name, text, &folder)),
            GivenInput::Path(path) => Inputs::open(&path).map_err(|error| vec![*error]),
        }
    }

    /// The input as a scene.
    pub(crate) fn scene(self) -> Result<SceneSource, Vec<Diagnostic>> {
        match self {
            GivenInput::Text(text, folder) => Ok(SceneSource::of_text(text, &folder)),
            GivenInput::Path(path) => SceneSource::open(&path),
        }
    }
}

/// Changes of a scene as a text.
pub(crate) fn changes(text: String) -> Source {
    Source {
        name: "changes".to_owned(),
        text,
    }
}
