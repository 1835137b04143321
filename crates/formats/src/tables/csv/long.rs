//! Tables with one value per line, below a header with the names of the columns.

use super::Sheet;
use super::cells::Cell;
use crate::tables::defect;
use crate::tables::parsed::Draft;
use crate::text::diagnostic::Diagnostic;
use crate::units::{Force, Length, Units};

/// Indices of the columns.
pub(super) struct Header {
    id: Option<usize>,
    name: Option<usize>,
    z: Option<usize>,
    x: usize,
    value: usize,
    /// Units in brackets after the names of the columns.
    pub units: Option<Units>,
}

/// Names of the columns.
const KNOWN: [&str; 5] = ["id", "name", "z", "x", "value"];

impl Header {
    /// The header in the first row; `None` if it has no column `value`.
    pub fn of(sheet: &Sheet<'_>) -> Result<Option<Header>, Vec<Diagnostic>> {
        let head: Vec<(String, Option<&str>)> = sheet.rows[0]
            .iter()
            .map(|cell| name_and_unit(&cell.text))
            .collect();
        let find = |name: &str| head.iter().position(|(known, _)| known == name);
        let Some(value) = find("value") else {
            return Ok(None);
        };
        for (k, (name, _)) in head.iter().enumerate() {
            let expected = if !KNOWN.contains(&name.as_str()) {
                format!("unknown column `{name}`")
            } else if find(name) != Some(k) {
                format!("duplicate column `{name}`")
            } else {
                continue;
            };
            let hint = format!("known columns are {}", KNOWN.join(", "));
            return Err(vec![sheet.fault(&sheet.rows[0][k], expected).hint(hint)]);
        }
        let Some(x) = find("x") else {
            return Err(vec![sheet.fault(&sheet.rows[0][0], "missing column `x`")]);
        };
        let unit = |column: usize| head[column].1;
        let units = unit(x).zip(unit(value)).map(|(length, value)| {
            // the text between the brackets contains the length first and the force second, as in ft/lbf
            let units = Units::parse(value);
            units.filter(|units| Length::of_word(length) == Some(units.length))
        });
        let units = match units {
            Some(None) => {
                let fault =
                    sheet.fault(&sheet.rows[0][value], "must be a unit of length per force");
                let example = Units {
                    length: Length::Foot,
                    force: Force::Pound,
                };
                let hint = format!(
                    "such as [{}/{}]",
                    example.length.word(),
                    example.force.word()
                );
                return Err(vec![fault.hint(hint)]);
            }
            Some(units) => units,
            None => None,
        };
        Ok(Some(Header {
            id: find("id"),
            name: find("name"),
            z: find("z"),
            x,
            value,
            units,
        }))
    }
}

/// The name of a column in lower case, and the unit in brackets after it.
fn name_and_unit(text: &str) -> (String, Option<&str>) {
    match text.split_once('[') {
        Some((name, unit)) => (
            name.trim().to_lowercase(),
            Some(unit.trim_end().trim_end_matches(']').trim()),
        ),
        None => (text.trim().to_lowercase(), None),
    }
}

/// The numbers and the cells of a row.
struct Entry<'s> {
    z: Option<f64>,
    x: f64,
    value: f64,
    row: &'s [Cell],
}

/// The rows of one table.
struct Group<'s> {
    id: Option<u32>,
    name: Option<String>,
    entries: Vec<Entry<'s>>,
}

/// Reads the tables: a table is the rows of one id and name, in any order.
pub(super) fn read(sheet: &Sheet<'_>, header: &Header) -> Result<Vec<Draft>, Vec<Diagnostic>> {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for row in &sheet.rows[1..] {
        let (id, name, entry) = entry(sheet, header, row).map_err(|fault| vec![*fault])?;
        match groups
            .iter_mut()
            .rfind(|group| group.id == id && group.name == name)
        {
            Some(group) => group.entries.push(entry),
            None => {
                if id.is_some() && groups.iter().any(|group| group.id == id) {
                    let cell = header
                        .id
                        .and_then(|column| row.get(column))
                        .unwrap_or(&row[0]);
                    return Err(vec![
                        sheet.fault(cell, "this id belongs to a table with another name"),
                    ]);
                }
                groups.push(Group {
                    id,
                    name,
                    entries: vec![entry],
                });
            }
        }
    }
    if groups.is_empty() {
        return Err(vec![
            sheet.fault(&sheet.rows[0][0], "the file has no values"),
        ]);
    }
    groups
        .into_iter()
        .map(|group| draft(sheet, header, group).map_err(|fault| vec![*fault]))
        .collect()
}

/// Number and name of the table of a row, followed by the row.
type Named<'s> = (Option<u32>, Option<String>, Entry<'s>);

fn entry<'s>(
    sheet: &Sheet<'_>,
    header: &Header,
    row: &'s [Cell],
) -> Result<Named<'s>, Box<Diagnostic>> {
    let width = sheet.rows[0].len();
    if row.len() > width {
        return Err(sheet
            .fault(
                &row[width],
                format!("a row must have {width} cells, like the header"),
            )
            .into());
    }
    let last = &row[row.len() - 1];
    let missing = Cell {
        line: last.line,
        column: last.column + last.text.chars().count() + 1,
        text: String::new(),
    };
    let number = |column: usize| sheet.number(row.get(column).unwrap_or(&missing));
    let id = match header.id.and_then(|column| row.get(column)) {
        None => None,
        Some(cell) => {
            let id = cell.text.parse::<u32>().ok().filter(|&id| id > 0);
            Some(id.ok_or_else(|| sheet.fault(cell, "must be a whole number above 0"))?)
        }
    };
    let name = header
        .name
        .and_then(|column| row.get(column))
        .map(|cell| cell.text.clone());
    let z = match header.z.and_then(|column| row.get(column)) {
        Some(cell) if !cell.text.is_empty() => Some(sheet.number(cell)?),
        _ => None,
    };
    Ok((
        id,
        name,
        Entry {
            z,
            x: number(header.x)?,
            value: number(header.value)?,
            row,
        },
    ))
}

/// The table of a group, with its rows sorted by z, then x. Every z must have values at the same x.
fn draft(
    sheet: &Sheet<'_>,
    header: &Header,
    mut group: Group<'_>,
) -> Result<Draft, Box<Diagnostic>> {
    let cell =
        |entry: &Entry<'_>, column: usize| entry.row.get(column).unwrap_or(&entry.row[0]).clone();
    let one_curve = group.entries.iter().all(|entry| entry.z.is_none());
    if let Some(entry) = group
        .entries
        .iter()
        .find(|entry| !one_curve && entry.z.is_none())
    {
        let z = header.z.unwrap_or(header.x);
        return Err(sheet
            .fault(
                &cell(entry, z),
                "must have a z, like the other rows of the table",
            )
            .into());
    }
    let z_of = |entry: &Entry<'_>| entry.z.unwrap_or(0.0);
    // -0 and 0 are the same coordinate, and partial_cmp treats them as equal
    let order = |a: &Entry<'_>, b: &Entry<'_>| {
        let z = z_of(a)
            .partial_cmp(&z_of(b))
            .unwrap_or(std::cmp::Ordering::Equal);
        z.then(a.x.partial_cmp(&b.x).unwrap_or(std::cmp::Ordering::Equal))
    };
    group.entries.sort_by(order);
    let rows: Vec<&[Entry<'_>]> = group.entries.chunk_by(|a, b| z_of(a) == z_of(b)).collect();
    let x: Vec<f64> = rows[0].iter().map(|entry| entry.x).collect();
    for row in &rows {
        if let Some(pair) = row.windows(2).find(|pair| pair[0].x == pair[1].x) {
            let later = pair
                .iter()
                .max_by_key(|entry| entry.row[0].line)
                .unwrap_or(&pair[0]);
            return Err(sheet
                .fault(
                    &cell(later, header.x),
                    "the value at this z and x is given twice",
                )
                .into());
        }
        let differs = row.iter().zip(&x).position(|(entry, x)| entry.x != *x);
        let short = || {
            if row.len() == x.len() {
                None
            } else {
                Some(row.len().min(x.len()))
            }
        };
        if let Some(k) = differs.or_else(short) {
            let entry = row.get(k).unwrap_or(&row[row.len() - 1]);
            let expected = "every z must have values at the same x";
            let mut fault = sheet.fault(&cell(entry, header.x), expected);
            fault.found = Some(format!("x = {} at z = {}", entry.x, z_of(entry)));
            return Err(fault.into());
        }
    }
    let z = if one_curve {
        Vec::new()
    } else {
        rows.iter().map(|row| z_of(&row[0])).collect()
    };
    let values = rows
        .iter()
        .map(|row| row.iter().map(|entry| entry.value).collect())
        .collect();
    let first = cell(&rows[0][0], header.x);
    let curves = defect::checked(x, z, values).map_err(|defect| Diagnostic {
        found: defect.found,
        hint: defect.hint.map(str::to_owned),
        ..sheet.fault(&first, defect.expected)
    })?;
    let name = group.name.filter(|name| !name.is_empty());
    Ok(Draft {
        id: group.id,
        name,
        ..Draft::of(curves)
    })
}
