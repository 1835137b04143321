//! Data set to text.

use super::units::keyword;
use super::{DataSet, Spline};
use crate::Error;

/// No line is longer.
const WIDTH: usize = 79;

/// Writes a data set: title, UNITS, the SPLINE statements with their View names, END.
///
/// Guarantees: lines of at most 79 ASCII characters; every number with the digits that make [`super::read`]
/// return the same bits. A title is cut to one such line; it begins with "Model: " if it would otherwise read
/// as a statement or comment.
///
/// # Errors
/// An identifier that is zero or used twice; a name that has no place between quotes on one line.
pub fn write(set: &DataSet) -> Result<String, Error> {
    let mut out = title(set.title.as_deref().unwrap_or_default());
    out.push_str("\n!\n");
    if let Some(units) = &set.units {
        out.push_str("UNITS/\n");
        let (force, mass, length) = (keyword(units.force), keyword(units.mass), keyword(units.length));
        for (name, value) in [("FORCE", force), ("MASS", mass), ("LENGTH", length), ("TIME", "SECOND")] {
            out.push_str(&format!(", {name} = {value}\n"));
        }
        out.push_str("!\n");
    }
    for (k, spline) in set.splines.iter().enumerate() {
        let used = set.splines[..k].iter().any(|other| other.id == spline.id);
        if spline.id == 0 || used {
            return Err(Error::SplineId { id: spline.id });
        }
        statement(&mut out, spline)?;
    }
    out.push_str("END\n");
    Ok(out)
}

fn title(text: &str) -> String {
    let plain = |c: char| if c.is_ascii_graphic() || c == ' ' { c } else { '?' };
    let clean: String = text.trim().chars().map(plain).collect();
    let statement = super::lexer::head(&clean).is_some() || clean.starts_with(['!', ',']);
    let mut out = if statement { format!("Model: {clean}") } else { clean };
    out.truncate(WIDTH);
    out.truncate(out.trim_end().len());
    out
}

fn statement(out: &mut String, spline: &Spline) -> Result<(), Error> {
    for (key, value) in [("adams_view_name", &spline.name), ("adams_view_units", &spline.units)] {
        let Some(value) = value else { continue };
        let line = format!("!  {key}='{value}'");
        let plain = value.bytes().all(|c| c.is_ascii_graphic() && c != b'\'');
        if !plain || value.is_empty() || line.len() > WIDTH {
            return Err(Error::SplineName { id: spline.id });
        }
        out.push_str(&line);
        out.push('\n');
    }
    out.push_str(&format!("SPLINE/{}\n", spline.id));
    if spline.linear {
        out.push_str(", LINEAR_EXTRAPOLATE\n");
    }
    let table = &spline.table;
    list(out, "X", table.x().iter().copied());
    for (i, row) in table.values().row_iter().enumerate() {
        list(out, "Y", table.z().get(i).into_iter().copied().chain(row.iter().copied()));
    }
    out.push_str("!\n");
    Ok(())
}

/// `, X = 1.0, 2.0` and so on, broken before a separating comma.
fn list(out: &mut String, name: &str, values: impl Iterator<Item = f64>) {
    let mut line = format!(", {name} =");
    for (k, value) in values.enumerate() {
        let item = number(value);
        if k > 0 && line.len() + item.len() + 2 > WIDTH {
            out.push_str(&line);
            out.push('\n');
            line.clear();
        }
        line.push_str(if k == 0 { " " } else { ", " });
        line.push_str(&item);
    }
    out.push_str(&line);
    out.push('\n');
}

/// Shortest digits that read back to the same bits, always with a decimal point.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e7).contains(&size) {
        return format!("{value:?}");
    }
    let text = format!("{value:E}");
    match text.split_once('E') {
        Some((digits, exponent)) if !digits.contains('.') => format!("{digits}.0E{exponent}"),
        _ => text,
    }
}
