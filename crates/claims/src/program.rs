//! Programs of benchmarks: where they are in the source, and where cargo built them.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::error::Error;
use crate::file::{folder, name};

/// A program of benchmarks that cargo built.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Package and name.
    pub name: String,
    /// The executable.
    pub path: PathBuf,
    /// Folder of its package, in which cargo runs it.
    pub folder: PathBuf,
}

/// Folder of the crate that is named after the program, not after its folder.
const PIPELINE: &str = "pipeline";

fn package(folder: &Path) -> String {
    if folder.ends_with(PIPELINE) { "girderway".to_owned() } else { name(folder) }
}

/// Benchmarks of all crates: package and name.
///
/// # Errors
/// Folders that cannot be read.
pub fn benches(root: &Path) -> Result<Vec<(String, String)>, Error> {
    let mut out = Vec::new();
    for own in folder(&root.join("crates"))?.into_iter().chain([root.join(PIPELINE)]) {
        for path in folder(&own.join("benches"))? {
            if path.extension().is_some_and(|ending| ending == "rs") {
                out.push((package(&own), name(&path.with_extension(""))));
            }
        }
    }
    Ok(out)
}

/// The benchmarks among what cargo tells of a build, one JSON object a line.
#[must_use]
pub fn built(messages: &str) -> Vec<Program> {
    let mut out = Vec::new();
    for line in messages.lines() {
        let Ok(own) = serde_json::from_str::<Value>(line) else { continue };
        let is_bench =
            own["target"]["kind"].as_array().is_some_and(|kinds| kinds.iter().any(|kind| kind == "bench"));
        let told = |value: &Value| value.as_str().map(str::to_owned);
        if let (true, Some(path), Some(manifest), Some(name)) =
            (is_bench, told(&own["executable"]), told(&own["manifest_path"]), told(&own["target"]["name"]))
        {
            let folder = Path::new(&manifest).parent().unwrap_or(Path::new("")).to_owned();
            out.push(Program { name: format!("{}/{name}", package(&folder)), path: path.into(), folder });
        }
    }
    out.sort_by(|a, b| a.name.cmp(&b.name));
    out
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::{Program, built};

    #[test]
    fn benchmarks_are_found_among_what_cargo_tells() {
        let text = r#"{"reason":"compiler-artifact","manifest_path":"/r/crates/fea/Cargo.toml","target":{"kind":["lib"],"name":"fea"},"executable":null}
not JSON
{"reason":"compiler-artifact","manifest_path":"/r/pipeline/Cargo.toml","target":{"kind":["bench"],"name":"crane"},"executable":"/t/crane-1"}
{"reason":"compiler-artifact","manifest_path":"/r/crates/fea/Cargo.toml","target":{"kind":["bench"],"name":"grid"},"executable":"/t/grid-2"}
{"reason":"build-finished","success":true}"#;
        let program = |name: &str, path: &str, folder: &str| Program {
            name: name.to_owned(),
            path: PathBuf::from(path),
            folder: PathBuf::from(folder),
        };
        assert_eq!(
            built(text),
            [
                program("fea/grid", "/t/grid-2", "/r/crates/fea"),
                program("girderway/crane", "/t/crane-1", "/r/pipeline")
            ]
        );
    }
}
