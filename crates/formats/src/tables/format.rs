//! Which format a file is in.

use std::path::Path;

use serde::Deserialize;
use serde::de::IgnoredAny;
use thiserror::Error;
use zip::result::ZipError;

use super::product::Product;
use super::set::{Draft, Table, TableSet};
use super::{adm, csv, expand, json, npz, view};
use crate::diagnostic::Diagnostic;
use crate::source::Source;
use crate::units::Units;

/// A format of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// ADAMS data set, `.adm`.
    Adams,
    /// Commands of Adams View, `.cmd`.
    View,
    /// Values in rows, `.csv`.
    Csv,
    /// `girderway-tables/1`, `.json`.
    Json,
    /// Arrays of numpy, `.npz`.
    Npz,
}

impl Format {
    /// The format that the ending of a file's name says.
    ///
    /// # Errors
    /// An ending that says none.
    pub fn of(name: &str) -> Result<Format, Box<Diagnostic>> {
        let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref().unwrap_or_default() {
            "adm" => Ok(Format::Adams),
            "cmd" => Ok(Format::View),
            "json" => Ok(Format::Json),
            "csv" => Ok(Format::Csv),
            "npz" => Ok(Format::Npz),
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
    /// The tables are no SPLINE statements, such as two of one number.
    #[error(transparent)]
    Adams(#[from] adams::Error),
    /// The archive cannot be made.
    #[error(transparent)]
    Archive(#[from] ZipError),
}

/// The bytes of a file. The same tables give the same bytes.
///
/// # Errors
/// Numbers of tables that stand twice; an archive that cannot be made.
pub fn write(set: &TableSet, format: Format) -> Result<Vec<u8>, WriteError> {
    match format {
        Format::Adams => Ok(adm::write(set)?.into_bytes()),
        Format::View => Ok(view::write(set)?.into_bytes()),
        Format::Csv => Ok(csv::write(set).into_bytes()),
        Format::Json => Ok(json::write(set).into_bytes()),
        Format::Npz => Ok(npz::write(set)?),
    }
}

/// Reads the tables of a file by the ending of its name.
///
/// `told` are the units where the file says none.
///
/// # Errors
/// What is wrong, by line and column, path, or array and index; units that neither the file nor `told` says,
/// or that differ.
pub fn read(name: &str, bytes: &[u8], told: Option<Units>) -> Result<TableSet, Vec<Diagnostic>> {
    let parsed = parse(name, bytes)?;
    let units = match (parsed.units, told) {
        (Some(given), Some(told)) if given != told => {
            let words = |units: Units| format!("{} and {}", units.length.word(), units.force.word());
            let expected = format!("says its units itself: {}", words(given));
            let fault = Diagnostic { found: Some(words(told)), ..Diagnostic::of_file(name, expected) };
            return Err(vec![fault.hint("leave the units out")]);
        }
        (Some(units), _) | (None, Some(units)) => units,
        (None, None) => {
            let [lacks, hint] = parsed.lacks;
            let more = "none is guessed: --length ft --force lbf, or in a scene \"units\" of the tables";
            return Err(vec![Diagnostic::of_file(name, lacks).hint(format!("{hint}; {more}"))]);
        }
    };
    Ok(parsed.set(units))
}

/// The tables of a file in the plain form, for a look at them: without units where the file says none.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// Units, where the file says them.
    pub units: Option<Units>,
    /// The tables, and whether the file would have ADAMS go on with a line beyond their ends, where it says.
    pub tables: Vec<(Table, Option<bool>)>,
}

/// Reads the tables of a file by the ending of its name.
///
/// # Errors
/// What is wrong, but for units that are not said.
pub fn contents(name: &str, bytes: &[u8]) -> Result<Contents, Vec<Diagnostic>> {
    let parsed = parse(name, bytes)?;
    let units = parsed.units;
    let linear: Vec<Option<bool>> = parsed.drafts.iter().map(|draft| draft.linear).collect();
    let any = Units::SI;
    let set = parsed.set(units.unwrap_or(any));
    let said = |k: usize| if set.products.is_empty() { linear.get(k).copied().flatten() } else { None };
    let tables = expand(&set).tables.into_iter().enumerate().map(|(k, table)| (table, said(k))).collect();
    Ok(Contents { units, tables })
}

fn parse(name: &str, bytes: &[u8]) -> Result<Parsed, Vec<Diagnostic>> {
    let format = Format::of(name).map_err(|error| vec![*error])?;
    if format == Format::Npz {
        return npz::read(name, bytes);
    }
    let source = Source::from_bytes(name, bytes.to_vec()).map_err(|error| vec![*error])?;
    match format {
        Format::Adams => adm::read(&source),
        Format::View => view::read(&source),
        Format::Csv => csv::read(&source),
        Format::Json | Format::Npz => json::read(&source),
    }
}

/// What a file says.
pub(super) struct Parsed {
    pub name: String,
    pub units: Option<Units>,
    /// What to say where it has no units, with a hint.
    pub lacks: [&'static str; 2],
    pub drafts: Vec<Draft>,
    /// Its comments.
    pub remarks: String,
    /// The products of a format that does not have them in comments.
    pub products: Vec<Product>,
}

impl Parsed {
    fn set(self, units: Units) -> TableSet {
        let mut set = TableSet::assemble(self.name, units, self.drafts, &self.remarks);
        set.products.extend(self.products);
        set
    }
}

/// Whether a file is one of tables, not a grid: by its ending, and of JSON by its members.
#[must_use]
pub fn is_tables(name: &str, bytes: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Peek {
        format: Option<String>,
        tables: Option<IgnoredAny>,
        values: Option<IgnoredAny>,
    }
    match Format::of(name) {
        Ok(Format::Json) => serde_json::from_slice(bytes).is_ok_and(|peek: Peek| match &peek.format {
            Some(format) => format == json::FORMAT,
            None => peek.tables.is_some() || peek.values.is_some(),
        }),
        Ok(_) => true,
        Err(_) => false,
    }
}
