//! The header of a mesh, which states its version and whether it is text or binary.

use super::mesh::CONVERT;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// A format of meshes that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshFormat {
    /// Version.
    pub version: MeshVersion,
    /// Whether nodes and elements are binary numbers.
    pub binary: bool,
}

/// A version of the format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshVersion {
    /// Version 2.0 to 2.2: elements name their physical group.
    Two,
    /// Version 4.1: elements belong to entities, and entities to physical groups.
    FourOne,
}

/// Reads the header of a mesh; returns `None`, with an error, if its format cannot be read. `text` may have any
/// characters in place of binary numbers after the second line.
pub fn format(text: &str, findings: &mut ImportFindings) -> Option<MeshFormat> {
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty());
    let at = |line: usize| FilePlace {
        file: 0,
        line: line + 1,
        column: 1,
    };
    let first = lines.next();
    if first.is_none_or(|(_, line)| line.trim() != "$MeshFormat") {
        let line = first.map_or(0, |(line, _)| line);
        findings.error(
            ImportFinding::new(at(line), "", "must begin with $MeshFormat")
                .hint("check that the file is a gmsh mesh"),
        );
        return None;
    }
    let (line, format) = lines.next().unwrap_or((1, ""));
    let words: Vec<&str> = format.split_ascii_whitespace().collect();
    let mut refuse = |expected: &str, found: &str| {
        let finding = ImportFinding::new(at(line), "$MeshFormat", expected).with_found(found);
        findings.error(finding.hint(CONVERT));
        None
    };
    let known = "must be version 2.2 or 4.1";
    let version = match words.first() {
        Some(&"4.1") => MeshVersion::FourOne,
        Some(&("2" | "2.0" | "2.1" | "2.2")) => MeshVersion::Two,
        Some(version) => return refuse(known, version),
        None => return refuse(known, "nothing"),
    };
    match (words.get(1), words.get(2)) {
        (Some(&"0"), _) => Some(MeshFormat {
            version,
            binary: false,
        }),
        (Some(&"1"), Some(&"8")) => Some(MeshFormat {
            version,
            binary: true,
        }),
        (Some(&"1"), size) => refuse(
            "must have real numbers of 8 bytes",
            size.unwrap_or(&"nothing"),
        ),
        (kind, _) => refuse(
            "must be 0 for text or 1 for binary numbers",
            kind.unwrap_or(&"nothing"),
        ),
    }
}
