//! `manifest.json`: inputs, settings and outputs of a run.

use serde::Serialize;
use serde_json::Value;

use formats::text::inputs::Inputs;

/// Name of the manifest in an output folder.
pub const MANIFEST: &str = "manifest.json";

/// Inputs, settings and outputs of a run; it is written last.
#[derive(Clone, Debug, Serialize)]
pub struct Manifest {
    format: &'static str,
    program: &'static str,
    version: &'static str,
    /// The command.
    pub command: String,
    /// Settings that the result depends on.
    pub settings: Value,
    inputs: Vec<InputEntry>,
    /// Files written, by name.
    pub outputs: Vec<OutputEntry>,
}

#[derive(Clone, Debug, Serialize)]
struct InputEntry {
    name: String,
    bytes: usize,
    sha256: String,
}

/// A file written.
#[derive(Clone, Debug, Serialize)]
pub struct OutputEntry {
    /// Its name in the folder.
    pub name: String,
    /// Its size; left out where it may differ between equal runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bytes: Option<usize>,
    /// SHA-256 in hexadecimal; left out where it may differ between equal runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
}

impl Manifest {
    /// The manifest of a command that read these files under these settings.
    #[must_use]
    pub fn new(command: &str, inputs: &Inputs, settings: Value) -> Manifest {
        let entry = |input: &formats::text::inputs::Input| InputEntry {
            name: input.name.clone(),
            bytes: input.bytes.len(),
            sha256: input.sha256.clone(),
        };
        Manifest {
            format: "girderway-manifest/1",
            program: "girderway",
            version: env!("CARGO_PKG_VERSION"),
            command: command.to_owned(),
            settings,
            inputs: inputs.all().iter().map(entry).collect(),
            outputs: Vec::new(),
        }
    }

    /// Its text.
    #[must_use]
    pub fn text(&self) -> String {
        // plain strings and numbers: always JSON
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}
