//! The formats of tables: which one a file has, and reading and writing it.

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
use crate::text::source::Source;
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
    /// The format of a file by the ending of its name.
    ///
    /// # Errors
    /// An ending that is none of `.adm`, `.cmd`, `.csv`, `.json` and `.npz`.
    pub fn of(name: &str) -> Result<TableFormat, Box<Diagnostic>> {
        let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref().unwrap_or_default() {
            "adm" => Ok(TableFormat::Adams),
            "cmd" => Ok(TableFormat::View),
            "json" => Ok(TableFormat::Json),
            "csv" => Ok(TableFormat::Csv),
            "npz" => Ok(TableFormat::Npz),
            _ => {
                let fault = Diagnostic::of_file(name, "the ending says no format");
                Err(Box::new(fault.hint("use .adm, .cmd, .csv, .json or .npz")))
            }
        }
    }
}

/// Why tables cannot be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The tables give no valid SPLINE statements, such as two of one number.
    #[error(transparent)]
    Adams(#[from] adams::Error),
    /// The archive cannot be written.
    #[error(transparent)]
    Archive(#[from] ZipError),
}

/// The bytes of a file of tables. Equal tables give equal bytes.
///
/// # Errors
/// Two tables of one number; an archive that cannot be written.
pub fn write(set: &TableSet, format: TableFormat) -> Result<Vec<u8>, WriteError> {
    match format {
        TableFormat::Adams => Ok(adm::write(set)?.into_bytes()),
        TableFormat::View => Ok(view::write(set)?.into_bytes()),
        TableFormat::Csv => Ok(csv::write(set).into_bytes()),
        TableFormat::Json => Ok(json::write(set).into_bytes()),
        TableFormat::Npz => Ok(npz::write(set)?),
    }
}

/// Reads the tables of a file, in the format that the ending of its name says.
///
/// `units` are those of the numbers where the file says none.
///
/// # Errors
/// What is wrong, by line and column, path, or array and index; units that are missing in both the file and `units`, or
/// that differ.
pub fn read(name: &str, bytes: &[u8], units: Option<Units>) -> Result<TableSet, Vec<Diagnostic>> {
    let parsed = parse(name, bytes)?;
    let units = match (parsed.units, units) {
        (Some(own), Some(given)) if own != given => {
            let words = |units: Units| format!("{} and {}", units.length.word(), units.force.word());
            let expected = format!("says its units itself: {}", words(own));
            let fault = Diagnostic { found: Some(words(given)), ..Diagnostic::of_file(name, expected) };
            return Err(vec![fault.hint("leave the units out")]);
        }
        (Some(units), _) | (None, Some(units)) => units,
        (None, None) => {
            let [missing, hint] = parsed.missing_units;
            let more = "none is guessed: --length ft --force lbf, or in a scene \"units\" of the tables";
            return Err(vec![Diagnostic::of_file(name, missing).hint(format!("{hint}; {more}"))]);
        }
    };
    Ok(parsed.set(units))
}

/// The tables of a file in the plain form, for inspection: the file need not say its units.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// Units, where the file says them.
    pub units: Option<Units>,
    /// The tables, each with whether ADAMS is to extrapolate it linearly beyond its ends, where the file says so.
    pub tables: Vec<(Table, Option<bool>)>,
}

/// Reads the tables of a file for inspection, in the format that the ending of its name says.
///
/// # Errors
/// What is wrong with the file; missing units are no fault.
pub fn contents(name: &str, bytes: &[u8]) -> Result<Contents, Vec<Diagnostic>> {
    let parsed = parse(name, bytes)?;
    let units = parsed.units;
    let linear: Vec<Option<bool>> = parsed.drafts.iter().map(|draft| draft.linear_extrapolate).collect();
    // the numbers are those of the file whatever the units
    let set = parsed.set(units.unwrap_or(Units::SI));
    let extrapolate =
        |k: usize| if set.products.is_empty() { linear.get(k).copied().flatten() } else { None };
    let tables =
        expand(&set).tables.into_iter().enumerate().map(|(k, table)| (table, extrapolate(k))).collect();
    Ok(Contents { units, tables })
}

/// Reads a file as it is.
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

/// Whether a file is one of tables and not a grid file: by the ending of its name, and of JSON also by its members.
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
            serde_json::from_slice(bytes).is_ok_and(|members: Members| match &members.format {
                Some(format) => format == json::FORMAT,
                None => members.tables.is_some() || members.values.is_some(),
            })
        }
        Ok(_) => true,
        Err(_) => false,
    }
}
