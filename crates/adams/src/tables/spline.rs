//! One SPLINE statement, and the tables of a data set.

use super::curves::SplineValues;
use crate::language::{AdamsUnits, ArgumentValue, DataSet, Statement};
use crate::{AdamsFault, Error, StatementId};

/// The SPLINE and UNITS statements of a data set.
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    /// The first line; `None` where it is blank or already a statement.
    pub title: Option<String>,
    /// The UNITS statement; `None` where it is missing or says SYSTEM=NONE.
    pub units: Option<AdamsUnits>,
    /// The SPLINE statements in the order of the text.
    pub splines: Vec<Spline>,
}

/// A SPLINE statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// The identifier, unique among SPLINE statements.
    pub id: u32,
    /// The `adams_view_name` in a comment before it.
    pub name: Option<String>,
    /// The `adams_view_units` in a comment before it, such as `no_units`.
    pub units: Option<String>,
    /// Whether LINEAR_EXTRAPOLATE is given.
    pub linear_extrapolate: bool,
    /// The values: x, and one curve for every z or a single curve.
    pub curves: SplineValues,
}

impl Spline {
    /// The SPLINE statement.
    #[must_use]
    pub fn statement(&self) -> Statement {
        let mut out = Statement::new("SPLINE", self.id);
        (out.name, out.units) = (self.name.clone(), self.units.clone());
        if self.linear_extrapolate {
            out = out.flag("LINEAR_EXTRAPOLATE");
        }
        out = out.numbers("X", self.curves.x());
        for (i, values) in self.curves.y().iter().enumerate() {
            let line: Vec<f64> = self
                .curves
                .z()
                .get(i)
                .into_iter()
                .chain(values)
                .copied()
                .collect();
            out = out.numbers("Y", &line);
        }
        out
    }
}

/// The table of a SPLINE statement that has been read or built.
///
/// # Errors
/// [`Error::Statement`] for values in another file, a missing X or Y, lists of unequal length, fewer than
/// four x values, or x or z values that do not increase.
pub fn of_statement(statement: &Statement) -> Result<Spline, Error> {
    let id = statement.id.unwrap_or(0);
    let refuse = |fault: AdamsFault| {
        let statement = StatementId::new(&statement.keyword, id);
        Err(Error::Statement {
            statement,
            fault: Box::new(fault),
        })
    };
    let (mut x, mut y, mut linear) = (None, Vec::new(), false);
    for argument in &statement.arguments {
        match (argument.name.as_str(), &argument.value) {
            ("X", ArgumentValue::Numbers(values)) => x = Some(values.clone()),
            ("Y", ArgumentValue::Numbers(values)) => y.push(values.clone()),
            ("LINEAR_EXTRAPOLATE", _) => linear = true,
            ("FILE" | "BLOCK" | "CHANNEL", _) => return refuse(AdamsFault::File { id }),
            _ => return refuse(AdamsFault::Argument),
        }
    }
    let Some(x) = x else {
        return refuse(AdamsFault::NoX { id });
    };
    // A single list as long as x is a curve; otherwise every list begins with its z.
    let expected = if y.len() == 1 && y[0].len() == x.len() {
        x.len()
    } else {
        x.len() + 1
    };
    let (mut z, mut curves) = (Vec::new(), Vec::new());
    for list in y {
        if list.len() != expected {
            return refuse(AdamsFault::Count {
                id,
                found: list.len(),
                expected,
            });
        }
        let values = list.split_at(expected - x.len());
        z.extend(values.0);
        curves.push(values.1.to_vec());
    }
    if curves.is_empty() {
        return refuse(AdamsFault::NoY { id });
    }
    match SplineValues::new(x, z, curves) {
        Ok(curves) => Ok(Spline {
            id,
            name: statement.name.clone(),
            units: statement.units.clone(),
            linear_extrapolate: linear,
            curves,
        }),
        Err(fault) => refuse(fault),
    }
}

/// Writes a data set with a title, UNITS, the SPLINE statements with their Adams View names, and END.
///
/// Guarantees: no line is longer than 79 ASCII characters, and every number has the digits that make
/// [`super::read`] return the same bits. A title is cut to one such line; `Model: ` is put before a title
/// that would otherwise read as a statement or comment.
///
/// # Errors
/// [`Error::Id`] for an identifier that is zero or used twice; [`Error::Name`] for a name or unit that cannot
/// be written between quotes on one line.
pub fn write(tables: &Tables) -> Result<String, Error> {
    let units = tables.units.iter().map(AdamsUnits::statement);
    let statements = units
        .chain(tables.splines.iter().map(Spline::statement))
        .collect();
    DataSet {
        title: tables.title.clone().unwrap_or_default(),
        statements,
    }
    .write()
}
