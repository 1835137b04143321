//! Writer of tables as Adams View commands.

use super::units::{FORCES, LENGTHS, MASSES, word};
use crate::tables::{Spline, Tables};
use crate::{Error, StatementId, number};

/// Largest number of characters of a line.
const WIDTH: usize = 79;

/// The name that Adams View gives to a spline without a name.
pub(super) fn default_name(id: u32) -> String {
    format!("SPLINE_{id}")
}

/// Writes the commands that create a model with these tables: `defaults units`, `model create`, and one
/// `data_element create spline` for each table. The title is the name of the model.
///
/// `remarks` are comments at the start of the file. Guarantees: no line is longer than 79 ASCII characters,
/// and every number has the digits that make [`super::read`] return the same bits.
///
/// # Errors
/// [`Error::Id`] for an identifier that is zero or used twice; [`Error::Name`] for a name that is too long
/// for a line, begins with a digit, or has other characters than letters, digits and underscores;
/// [`Error::Long`] for a remark that cannot be broken into lines.
///
/// ```
/// let text = "SPLINE/6, X=0,20,40,60, Y=0,2.5,2.5,0\nEND";
/// let tables = adams::tables::read(text)?;
/// let commands = adams::view::write(&tables, &["influence of the girder".to_owned()])?;
/// assert_eq!(adams::view::read(&commands)?.splines, tables.splines);
/// # Ok::<(), adams::Error>(())
/// ```
pub fn write(tables: &Tables, remarks: &[String]) -> Result<String, Error> {
    let mut out = Out(String::new());
    for remark in remarks {
        out.remark(remark)?;
    }
    out.line("!");
    if let Some(units) = &tables.units {
        out.command(
            "defaults units",
            &[
                ("length", vec![word(LENGTHS, &units.length).to_owned()]),
                ("angle", vec!["deg".to_owned()]),
                ("force", vec![word(FORCES, &units.force).to_owned()]),
                ("mass", vec![word(MASSES, &units.mass).to_owned()]),
                ("time", vec!["sec".to_owned()]),
            ],
        );
    }
    let model = tables.title.as_deref().unwrap_or("MODEL_1");
    if !plain(model) {
        return Err(Error::Name {
            statement: StatementId::new("MODEL", 0),
        });
    }
    out.command("model create", &[("model_name", vec![format!(".{model}")])]);
    for (k, spline) in tables.splines.iter().enumerate() {
        let statement = StatementId::new("SPLINE", spline.id);
        if spline.id == 0
            || tables.splines[..k]
                .iter()
                .any(|other| other.id == spline.id)
        {
            return Err(Error::Id { statement });
        }
        let name = spline
            .name
            .clone()
            .unwrap_or_else(|| default_name(spline.id));
        let entries = entries(spline, &format!(".{model}.{name}"));
        let short = 12 + model.len() + name.len() < WIDTH - 12;
        if !plain(&name) || !short || !spline.units.as_deref().is_none_or(plain) {
            return Err(Error::Name { statement });
        }
        out.command("data_element create spline", &entries);
    }
    Ok(out.0)
}

/// The keys of a spline and their values.
fn entries<'s>(spline: &Spline, name: &str) -> Vec<(&'s str, Vec<String>)> {
    let list = |values: &[f64]| {
        values
            .iter()
            .map(|&value| number::write(value))
            .collect::<Vec<_>>()
    };
    let mut all = vec![
        ("spline_name", vec![name.to_owned()]),
        ("adams_id", vec![spline.id.to_string()]),
    ];
    all.extend(
        spline
            .units
            .iter()
            .map(|units| ("units", vec![units.clone()])),
    );
    all.push(("x", list(spline.curves.x())));
    all.push(("y", list(&spline.curves.y().concat())));
    if !spline.curves.z().is_empty() {
        all.push(("z", list(spline.curves.z())));
    }
    let answer = if spline.linear_extrapolate {
        "yes"
    } else {
        "no"
    };
    all.push(("linear_extrapolate", vec![answer.to_owned()]));
    all
}

/// Whether Adams View accepts a name: letters, digits and underscores, not beginning with a digit.
fn plain(name: &str) -> bool {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    !name.starts_with(|c: char| c.is_ascii_digit()) && !name.is_empty() && name.chars().all(letter)
}

/// The text of the command file as it grows.
struct Out(String);

impl Out {
    fn line(&mut self, text: &str) {
        self.0.push_str(text);
        self.0.push('\n');
    }

    /// A comment, broken into lines at blanks.
    fn remark(&mut self, text: &str) -> Result<(), Error> {
        let mut line = String::from("!");
        for word in text.split_whitespace() {
            if line.len() > 1 && line.len() + 1 + word.len() > WIDTH {
                self.line(&line);
                line = String::from("!");
            }
            line.push(' ');
            line.push_str(word);
            if line.len() > WIDTH || !line.is_ascii() {
                return Err(Error::Long {
                    statement: StatementId::new("!", 0),
                });
            }
        }
        self.line(&line);
        Ok(())
    }

    /// A command: `head  &`, then a line `key = value, value  &` for each key, broken after a separating
    /// comma.
    fn command(&mut self, head: &str, entries: &[(&str, Vec<String>)]) {
        self.line(&format!("{head}  &"));
        for (k, (key, values)) in entries.iter().enumerate() {
            let end = if k + 1 < entries.len() { "  &" } else { "" };
            let mut line = format!("   {key} = ");
            for (i, value) in values.iter().enumerate() {
                let comma = if i + 1 < values.len() { "," } else { "" };
                if i > 0 && line.len() + value.len() + 4 > WIDTH {
                    self.line(&format!("{}  &", line.trim_end()));
                    line = String::from("      ");
                }
                line.push_str(value);
                line.push_str(comma);
                if i + 1 < values.len() {
                    line.push(' ');
                }
            }
            self.line(&format!("{line}{end}"));
        }
        self.line("!");
    }
}
