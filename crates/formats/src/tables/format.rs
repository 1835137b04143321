//! The formats of tables: detection of the format, reading and writing.

use std::path::Path;

use serde::Deserialize;
use serde::de::IgnoredAny;
use thiserror::Error;
use zip::result::ZipError;

use super::factored::expand;
use super::parsed::Parsed;
use super::set::{Table, TableSet};
use super::{adm, csv, json, npz, view};
use crate::text::diagnostic::Diagnostic;
use crate::text::source::{Source, without_mark};
use crate::units::Units;

/// A format of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// ADAMS data set, `.adm`.
    Adams,
    /// Commands of Adams View, `.cmd`.
    View,
    /// Rows of cells, `.csv`.
    Csv,
    /// `girderway-tables/1`, `.json`.
    Json,
    /// NumPy arrays, `.npz`.
    Npz,
}

impl TableFormat {
    /// The format of a file, from the extension of its name.
    ///
    /// # Errors
    /// An extension other than `.adm`, `.cmd`, `.csv`, `.json` and `.npz`.
    pub fn of(name: &str) -> Result<TableFormat, Box<Diagnostic>> {
        let ending = Path::new(name)
            .extension()
            .map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref().unwrap_or_default() {
            "adm" => Ok(TableFormat::Adams),
            "cmd" => Ok(TableFormat::View),
            "json" => Ok(TableFormat::Json),
            "csv" => Ok(TableFormat::Csv),
            "npz" => Ok(TableFormat::Npz),
            _ => {
                let fault = Diagnostic::of_file(
                    name,
                    "the extension of the file is not that of a known format",
                );
                Err(Box::new(fault.hint("use .adm, .cmd, .csv, .json or .npz")))
            }
        }
    }
}

/// Why tables cannot be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The tables cannot be written as valid SPLINE statements, for example because two have the same number.
    #[error(transparent)]
    Adams(#[from] adams::Error),
    /// The archive cannot be written.
    #[error(transparent)]
    Archive(#[from] ZipError),
}

/// The bytes of a file of tables. Equal tables result in equal bytes.
///
/// # Errors
/// Two tables with the same number; an archive that cannot be written.
pub fn write(set: &TableSet, format: TableFormat) -> Result<Vec<u8>, WriteError> {
    match format {
        TableFormat::Adams => Ok(adm::write(set)?.into_bytes()),
        TableFormat::View => Ok(view::write(set)?.into_bytes()),
        TableFormat::Csv => Ok(csv::write(set).into_bytes()),
        TableFormat::Json => Ok(json::write(set).into_bytes()),
        TableFormat::Npz => Ok(npz::write(set)?),
    }
}

/// Reads the tables of a file. The format follows from the extension of its name.
///
/// `units` are the units of the numbers if the file does not specify them.
///
/// # Errors
/// The faults of the file, located by line and column, by path, or by array and index; units that are missing in both
/// the file and `units`, or that differ.
pub fn read(name: &str, bytes: &[u8], units: Option<Units>) -> Result<TableSet, Vec<Diagnostic>> {
    let parsed = parse(name, bytes)?;
    let units = match (parsed.units, units) {
        (Some(own), Some(given)) if own != given => {
            let words =
                |units: Units| format!("{} and {}", units.length.word(), units.force.word());
            let expected = format!("already states its units: {}", words(own));
            let fault = Diagnostic {
                found: Some(words(given)),
                ..Diagnostic::of_file(name, expected)
            };
            return Err(vec![fault.hint("leave the units out")]);
        }
        (Some(units), _) | (None, Some(units)) => units,
        (None, None) => {
            let [missing, hint] = parsed.missing_units;
            let more = "or specify --length ft --force lbf, or in a scene \"units\" of the tables";
            return Err(vec![
                Diagnostic::of_file(name, missing).hint(format!("{hint}; {more}")),
            ]);
        }
    };
    Ok(parsed.set(units))
}

/// The tables of a file in the plain form, for inspection. The file need not specify its units.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// Units, if the file specifies them.
    pub units: Option<Units>,
    /// The tables. The flag of each table specifies linear extrapolation in ADAMS, if the file contains it.
    pub tables: Vec<(Table, Option<bool>)>,
}

/// Reads the tables of a file for inspection. The format follows from the extension of its name.
///
/// # Errors
/// The faults of the file. Missing units are not a fault.
pub fn contents(name: &str, bytes: &[u8]) -> Result<Contents, Vec<Diagnostic>> {
    let parsed = parse(name, bytes)?;
    let units = parsed.units;
    let linear: Vec<Option<bool>> = parsed
        .drafts
        .iter()
        .map(|draft| draft.linear_extrapolate)
        .collect();
    // no conversion takes place, so the choice of units has no effect on the numbers
    let set = parsed.set(units.unwrap_or(Units::SI));
    let extrapolate = |k: usize| {
        if set.products.is_empty() {
            linear.get(k).copied().flatten()
        } else {
            None
        }
    };
    let tables = expand(&set)
        .tables
        .into_iter()
        .enumerate()
        .map(|(k, table)| (table, extrapolate(k)))
        .collect();
    Ok(Contents { units, tables })
}

/// Reads a file without conversion of units.
fn parse(name: &str, bytes: &[u8]) -> Result<Parsed, Vec<Diagnostic>> {
    let format = TableFormat::of(name).map_err(|error| vec![*error])?;
    if format == TableFormat::Npz {
        return npz::read(name, bytes);
    }
    let source = Source::from_bytes(name, bytes.to_vec()).map_err(|error| vec![*error])?;
    match format {
        TableFormat::Adams => adm::read(&source),
        TableFormat::View => view::read(&source),
        TableFormat::Csv => csv::read(&source),
        TableFormat::Json | TableFormat::Npz => json::read(&source),
    }
}

/// Whether a file contains tables and is not a grid file. The extension of its name decides, and for JSON also its
/// members.
#[must_use]
pub fn is_tables(name: &str, bytes: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Members {
        format: Option<String>,
        tables: Option<IgnoredAny>,
        values: Option<IgnoredAny>,
    }
    match TableFormat::of(name) {
        Ok(TableFormat::Json) => {
            serde_json::from_slice(without_mark(bytes)).is_ok_and(|members: Members| match &members
                .format
            {
                Some(format) => format == json::FORMAT,
                None => members.tables.is_some() || members.values.is_some(),
            })
        }
        Ok(_) => true,
        Err(_) => false,
    }
}
