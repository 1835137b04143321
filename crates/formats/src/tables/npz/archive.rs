//! Arrays in a zip archive, as NumPy writes them.

use std::io::{Cursor, Read, Write};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::array::{Array, Refusal};
use crate::text::diagnostic::Diagnostic;

/// Maximum total size of the arrays that are read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// The arrays of an archive in the order of the archive, each with its name without `.npy`.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Vec<(String, Array)>, Box<Diagnostic>> {
    let refuse = |error: ZipError| {
        let mut fault = Diagnostic::of_file(file, "must be a zip archive of arrays");
        fault.found = Some(error.to_string());
        fault.hint("numpy.savez and numpy.savez_compressed write one")
    };
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(refuse)?;
    let mut left = MAX_BYTES;
    let mut out: Vec<(String, Array)> = Vec::new();
    for index in 0..archive.len() {
        let mut member = archive.by_index(index).map_err(refuse)?;
        if member.is_dir() {
            continue;
        }
        let full = member.name().map_err(refuse)?.into_owned();
        let name = full.strip_suffix(".npy").unwrap_or(&full).to_owned();
        let at = |expected: String| Diagnostic {
            path: name.clone(),
            ..Diagnostic::of_file(file, expected)
        };
        let mut data = Vec::new();
        let size = (&mut member)
            .take(left.saturating_add(1))
            .read_to_end(&mut data);
        let size = size.map_err(|error| {
            let mut fault = at("cannot be unpacked".to_owned());
            fault.found = Some(error.to_string());
            fault
        })?;
        match left.checked_sub(size as u64) {
            Some(rest) => left = rest,
            None => return Err(at(format!("the arrays have more than {MAX_BYTES} bytes")).into()),
        }
        let array = Array::read(&data).map_err(|refusal| match refusal {
            Refusal::NoArray => {
                at("must be an .npy array".to_owned()).hint("numpy.savez writes them")
            }
            Refusal::Kind(descr) => {
                let mut fault = at("must be real numbers or text".to_owned());
                fault.found = Some(format!("the type {descr}"));
                fault.hint("such as numpy.asarray(values, dtype=float)")
            }
            Refusal::Size { expected, found } => {
                let mut fault = at(format!("must have {expected} bytes of data"));
                fault.found = Some(found.to_string());
                fault
            }
        })?;
        if out.iter().any(|(known, _)| *known == name) {
            return Err(at("occurs twice".to_owned()).into());
        }
        out.push((name, array));
    }
    Ok(out)
}

/// The bytes of an archive. It is not compressed and all its dates are the same, so that equal arrays result in equal
/// bytes.
pub(super) fn write(arrays: &[(String, Vec<u8>)]) -> Result<Vec<u8>, ZipError> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(zip::DateTime::default());
    for (name, bytes) in arrays {
        writer.start_file(format!("{name}.npy"), options)?;
        writer.write_all(bytes)?;
    }
    Ok(writer.finish()?.into_inner())
}
