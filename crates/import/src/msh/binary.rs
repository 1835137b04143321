//! Meshes with binary numbers, of formats 2 and 4.1.
//!
//! The names of sections, physical names and, in format 2, the numbers of nodes and elements are text; all other numbers
//! are binary. Whole numbers have 4 bytes, sizes and numbers of nodes and elements of format 4.1 have 8 bytes. The
//! integer 1 after the header shows the order of bytes. Nothing is reserved for the numbers of entries that a file
//! states: each entry is added when its bytes have been read.

use super::header::MeshVersion;
use super::mesh::{
    LINE, LINE_OF_THREE, Mesh, MeshLine, OtherElements, POINT, SECTIONS, report_others, require,
};
use super::text::{LARGEST, sections};
use super::version2::{Element2, ElementCollector};
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use formats::text::fault::number;

/// The position of all errors of a binary mesh, whose lines have no meaning.
const WHOLE_FILE: FilePlace = FilePlace {
    file: 0,
    line: 0,
    column: 0,
};

/// Why a section could not be read to its end.
struct Broken {
    expected: String,
    /// Offset of the first byte that was not understood.
    byte: usize,
}

/// A cursor over the bytes of a mesh.
struct Bytes<'b> {
    all: &'b [u8],
    at: usize,
    /// Whether the bytes of a number are in reverse order, most significant first.
    is_big: bool,
}

impl<'b> Bytes<'b> {
    fn broken(&self, expected: impl Into<String>) -> Broken {
        Broken {
            expected: expected.into(),
            byte: self.at,
        }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Broken> {
        let end = self.at.saturating_add(N);
        let part = self
            .all
            .get(self.at..end)
            .and_then(|part| <[u8; N]>::try_from(part).ok());
        let mut part = part.ok_or_else(|| self.broken("ends too early"))?;
        self.at = end;
        if self.is_big {
            part.reverse();
        }
        Ok(part)
    }

    fn skip(&mut self, count: usize) -> Result<(), Broken> {
        let end = self.at.saturating_add(count);
        if end > self.all.len() {
            return Err(self.broken("ends too early"));
        }
        self.at = end;
        Ok(())
    }

    fn int(&mut self) -> Result<i32, Broken> {
        self.take().map(i32::from_le_bytes)
    }

    /// The magnitude of an integer: the number of a physical group is negative for a reversed curve.
    fn tag(&mut self) -> Result<u64, Broken> {
        self.int().map(|value| u64::from(value.unsigned_abs()))
    }

    fn size(&mut self) -> Result<u64, Broken> {
        self.take().map(u64::from_le_bytes)
    }

    fn coordinate(&mut self) -> Result<f64, Broken> {
        let value = self.take().map(f64::from_le_bytes)?;
        if value.is_finite() && value.abs() <= LARGEST {
            return Ok(value);
        }
        self.at -= 8;
        Err(self.broken(format!(
            "must have finite coordinates, at most {} in magnitude",
            number(LARGEST)
        )))
    }

    /// The rest of a line of text, without its end.
    fn line(&mut self) -> Result<&'b str, Broken> {
        let rest = self.all.get(self.at..).unwrap_or_default();
        let length = rest
            .iter()
            .position(|byte| *byte == b'\n')
            .unwrap_or(rest.len());
        let line = std::str::from_utf8(&rest[..length]).map_err(|_| self.broken("must be text"))?;
        self.at = (self.at + length + 1).min(self.all.len());
        Ok(line.trim())
    }

    fn count(&mut self) -> Result<u64, Broken> {
        let before = self.at;
        let line = self.line()?;
        line.parse().map_err(|_| Broken {
            expected: "must begin with its number of entries".to_owned(),
            byte: before,
        })
    }

    /// The bytes up to the end of the section `name`, which the cursor passes.
    fn up_to_end(&mut self, name: &str) -> Result<&'b [u8], Broken> {
        let mark = format!("$End{name}");
        let rest = self.all.get(self.at..).unwrap_or_default();
        let found = rest
            .windows(mark.len())
            .position(|window| window == mark.as_bytes());
        let length = found.ok_or_else(|| self.broken("has no end"))?;
        self.at += length;
        self.line()?;
        Ok(&rest[..length])
    }
}

/// Reads a mesh and adds its errors to the findings.
pub fn read(mesh: &mut Mesh, all: &[u8], version: MeshVersion, findings: &mut ImportFindings) {
    let mut bytes = Bytes {
        all,
        at: 0,
        is_big: false,
    };
    let mut seen: Vec<String> = Vec::new();
    while bytes.at < all.len() {
        let name = match bytes.line() {
            Ok("") => continue,
            Ok(line) => line.strip_prefix('$').map(str::to_owned),
            Err(_) => None,
        };
        let Some(name) = name else {
            let expected = "must have sections between $Name and $EndName";
            let finding = ImportFinding::new(WHOLE_FILE, format!("byte {}", bytes.at), expected);
            findings.error(finding.hint("the file is damaged; save the mesh again"));
            return;
        };
        let result = if SECTIONS.contains(&name.as_str()) && seen.contains(&name) {
            Err(bytes.broken("must occur only once"))
        } else {
            section(mesh, &name, &mut bytes, version, findings)
        };
        if let Err(Broken { expected, byte }) = result {
            let about = format!("${name}, byte {byte}");
            let finding = ImportFinding::new(WHOLE_FILE, about, expected);
            findings.error(finding.hint("the file is damaged; save the mesh again"));
            return;
        }
        seen.push(name);
    }
    let seen: Vec<&str> = seen.iter().map(String::as_str).collect();
    let needed: &[&str] = match version {
        MeshVersion::Two => &["Nodes", "Elements"],
        MeshVersion::FourOne => &["Entities", "Nodes", "Elements"],
    };
    require(needed, &seen, findings);
}

/// Reads one section, after its name.
fn section(
    mesh: &mut Mesh,
    name: &str,
    bytes: &mut Bytes<'_>,
    version: MeshVersion,
    findings: &mut ImportFindings,
) -> Result<(), Broken> {
    match (name, version) {
        ("MeshFormat", _) => {
            bytes.line()?;
            match bytes.int()? {
                1 => {}
                one if one.swap_bytes() == 1 => bytes.is_big = true,
                _ => return Err(bytes.broken("must indicate the byte order by the integer 1")),
            }
        }
        ("PhysicalNames", _) => {
            let inside = String::from_utf8_lossy(bytes.up_to_end(name)?);
            let text = format!("$PhysicalNames\n{inside}\n$EndPhysicalNames\n");
            for mut block in sections(&text, findings) {
                let _whole = mesh.read_names(&mut block, findings);
            }
            return Ok(());
        }
        ("Entities", MeshVersion::FourOne) => entities(mesh, bytes)?,
        ("Nodes", MeshVersion::FourOne) => nodes(mesh, bytes, findings)?,
        ("Elements", MeshVersion::FourOne) => elements(mesh, bytes, findings)?,
        ("Nodes", MeshVersion::Two) => nodes_2(mesh, bytes, findings)?,
        ("Elements", MeshVersion::Two) => elements_2(mesh, bytes, findings)?,
        ("PartitionedEntities", _) => {
            return Err(bytes.broken("is not supported: save the mesh without partitions"));
        }
        _ => {}
    }
    // what follows the last number of a section that was read is the end of its line
    let after = bytes.at;
    let rest = bytes.up_to_end(name)?;
    let is_read = ["MeshFormat", "Entities", "Nodes", "Elements"].contains(&name);
    if is_read && rest.iter().any(|byte| !byte.is_ascii_whitespace()) {
        return Err(Broken {
            expected: "has more bytes than its entries require".to_owned(),
            byte: after,
        });
    }
    Ok(())
}

fn entities(mesh: &mut Mesh, bytes: &mut Bytes<'_>) -> Result<(), Broken> {
    let counts = [bytes.size()?, bytes.size()?, bytes.size()?, bytes.size()?];
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = bytes.tag()?;
            // coordinates of a point, or the bounding box of another entity
            bytes.skip(if dimension == 0 { 24 } else { 48 })?;
            let mut list = Vec::new();
            for _ in 0..bytes.size()? {
                list.push(bytes.tag()?);
            }
            if dimension > 0 {
                for _ in 0..bytes.size()? {
                    bytes.int()?;
                }
            }
            if mesh.groups.insert((dimension, tag), list).is_some() {
                return Err(bytes.broken(format!(
                    "defines entity {tag} of dimension {dimension} twice"
                )));
            }
        }
    }
    Ok(())
}

fn nodes(
    mesh: &mut Mesh,
    bytes: &mut Bytes<'_>,
    findings: &mut ImportFindings,
) -> Result<(), Broken> {
    let blocks = bytes.size()?;
    bytes.skip(24)?;
    for _ in 0..blocks {
        let dimension = bytes.tag()?;
        let entity = bytes.tag()?;
        let parameters = if bytes.int()? == 0 {
            0
        } else {
            dimension.min(3) as usize
        };
        let count = bytes.size()?;
        let mut tags = Vec::new();
        for _ in 0..count {
            tags.push(bytes.size()?);
        }
        for tag in tags {
            let place = [
                bytes.coordinate()?,
                bytes.coordinate()?,
                bytes.coordinate()?,
            ];
            bytes.skip(8 * parameters)?;
            mesh.add_node(tag, place, WHOLE_FILE, findings);
            if dimension == 0 {
                mesh.points.entry(entity).or_default().push(tag);
            }
        }
    }
    Ok(())
}

fn elements(
    mesh: &mut Mesh,
    bytes: &mut Bytes<'_>,
    findings: &mut ImportFindings,
) -> Result<(), Broken> {
    let blocks = bytes.size()?;
    bytes.skip(24)?;
    let mut others = OtherElements::new();
    for _ in 0..blocks {
        let dimension = bytes.tag()?;
        let entity = bytes.tag()?;
        let kind = bytes.tag()?;
        let length = node_count(kind).ok_or_else(|| bytes.broken(unknown(kind)))?;
        for _ in 0..bytes.size()? {
            let tag = bytes.size()?;
            match kind {
                LINE | LINE_OF_THREE => {
                    let line = MeshLine {
                        curve: entity,
                        ends: [bytes.size()?, bytes.size()?],
                        middle: if kind == LINE {
                            None
                        } else {
                            Some(bytes.size()?)
                        },
                        at: WHOLE_FILE,
                    };
                    mesh.add_line(tag, line, findings);
                }
                POINT if dimension == 0 => {
                    let node = bytes.size()?;
                    mesh.add_point(entity, node);
                }
                _ => {
                    bytes.skip(8 * length)?;
                    others.entry(kind).or_insert((WHOLE_FILE, 0)).1 += 1;
                }
            }
        }
    }
    report_others(others, findings);
    Ok(())
}

fn nodes_2(
    mesh: &mut Mesh,
    bytes: &mut Bytes<'_>,
    findings: &mut ImportFindings,
) -> Result<(), Broken> {
    for _ in 0..bytes.count()? {
        let tag = bytes.tag()?;
        let place = [
            bytes.coordinate()?,
            bytes.coordinate()?,
            bytes.coordinate()?,
        ];
        mesh.add_node(tag, place, WHOLE_FILE, findings);
    }
    Ok(())
}

/// Elements of format 2 are in blocks of one type and number of tags.
fn elements_2(
    mesh: &mut Mesh,
    bytes: &mut Bytes<'_>,
    findings: &mut ImportFindings,
) -> Result<(), Broken> {
    let count = bytes.count()?;
    let mut collector = ElementCollector::default();
    let mut read = 0;
    while read < count {
        let kind = bytes.tag()?;
        let follow = bytes.tag()?;
        let tags = bytes.tag()?;
        let length = node_count(kind).ok_or_else(|| bytes.broken(unknown(kind)))?;
        if follow == 0 {
            return Err(bytes.broken("has a block without elements"));
        }
        for _ in 0..follow {
            let tag = bytes.tag()?;
            let mut labels = [0; 2];
            for index in 0..tags {
                let label = bytes.tag()?;
                if let Some(slot) = labels.get_mut(index as usize) {
                    *slot = label;
                }
            }
            let mut nodes = Vec::new();
            for _ in 0..length {
                nodes.push(bytes.tag()?);
            }
            let [group, entity] = labels;
            let element = Element2 {
                tag,
                kind,
                group,
                entity,
                nodes: &nodes,
                at: WHOLE_FILE,
            };
            collector.add(mesh, element, findings);
        }
        read += follow;
    }
    collector.finish(findings);
    Ok(())
}

fn unknown(kind: u64) -> String {
    format!("has elements of the unknown type {kind}")
}

/// Number of nodes of a type of element.
const fn node_count(kind: u64) -> Option<usize> {
    Some(match kind {
        15 => 1,
        1 => 2,
        2 | 8 => 3,
        3 | 4 | 26 => 4,
        7 | 27 => 5,
        6 | 9 | 28 => 6,
        5 | 16 => 8,
        10 | 20 => 9,
        11 | 21 => 10,
        22 => 12,
        19 => 13,
        14 => 14,
        18 | 23 | 24 => 15,
        13 => 18,
        17 | 29 => 20,
        25 => 21,
        12 => 27,
        30 => 35,
        31 => 56,
        92 => 64,
        93 => 125,
        _ => return None,
    })
}
