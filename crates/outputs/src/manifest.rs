//! `manifest.json`: inputs, settings and outputs of a run.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use formats::text::inputs::Inputs;

/// Name of the manifest in an output folder.
pub const MANIFEST: &str = "manifest.json";

const FORMAT: &str = "girderway-manifest/1";

/// Inputs, settings and outputs of a run. The manifest is written after all other files.
#[derive(Clone, Debug, Serialize)]
pub struct Manifest {
    format: &'static str,
    program: &'static str,
    version: &'static str,
    /// Name of the command.
    pub command: String,
    /// Settings on which the result depends.
    pub settings: Value,
    inputs: Vec<InputEntry>,
    /// The files written, in the order of their names.
    pub outputs: Vec<OutputEntry>,
}

/// A file read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputEntry {
    name: String,
    bytes: usize,
    sha256: String,
}

impl InputEntry {
    /// The entries of files, in the order in which they were read.
    #[must_use]
    pub fn all(inputs: &Inputs) -> Vec<InputEntry> {
        let entry = |input: &formats::text::inputs::Input| InputEntry {
            name: input.name.clone(),
            bytes: input.bytes.len(),
            sha256: input.sha256.clone(),
        };
        inputs.all().iter().map(entry).collect()
    }
}

/// A file written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutputEntry {
    /// Its name in the folder.
    pub name: String,
    /// Size in bytes; `None` if it may differ between equal runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bytes: Option<usize>,
    /// SHA-256 in hexadecimal; `None` if it may differ between equal runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
}

impl Manifest {
    /// Creates the manifest of a command from its inputs and settings.
    #[must_use]
    pub fn new(command: &str, inputs: &Inputs, settings: Value) -> Manifest {
        Manifest::of_entries(command, InputEntry::all(inputs), settings)
    }

    /// Creates the manifest of a command from the entries of its inputs and its settings.
    #[must_use]
    pub fn of_entries(command: &str, inputs: Vec<InputEntry>, settings: Value) -> Manifest {
        Manifest {
            format: FORMAT,
            program: "girderway",
            version: env!("CARGO_PKG_VERSION"),
            command: command.to_owned(),
            settings,
            inputs,
            outputs: Vec::new(),
        }
    }

    /// The manifest as JSON text.
    #[must_use]
    pub fn text(&self) -> String {
        // serialization cannot fail, because all values are strings and numbers
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// The files that a manifest lists; `None` if the text is not a manifest of this program.
#[must_use]
pub fn listed_files(text: &[u8]) -> Option<Vec<OutputEntry>> {
    #[derive(Deserialize)]
    struct Listed {
        format: String,
        outputs: Vec<OutputEntry>,
    }
    let manifest: Listed = serde_json::from_slice(text).ok()?;
    (manifest.format == FORMAT).then_some(manifest.outputs)
}
