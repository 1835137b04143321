//! A SPLINE statement as a table.

use super::Spline;
use crate::{Curves, Error, Fault, Statement, Value};

/// The table of a SPLINE statement that has been read or built.
///
/// # Errors
/// [`Error::Statement`]: values in another file, no X or Y, lists that do not fit, fewer than four x, x or z not
/// increasing.
pub fn of_statement(statement: &Statement) -> Result<Spline, Error> {
    let id = statement.id.unwrap_or(0);
    let refuse = |fault: Fault| {
        Err(Error::Statement { keyword: statement.keyword.clone(), id, fault: Box::new(fault) })
    };
    let (mut x, mut y, mut linear) = (None, Vec::new(), false);
    for argument in &statement.arguments {
        match (argument.name.as_str(), &argument.value) {
            ("X", Value::Numbers(values)) => x = Some(values.clone()),
            ("Y", Value::Numbers(values)) => y.push(values.clone()),
            ("LINEAR_EXTRAPOLATE", _) => linear = true,
            ("FILE" | "BLOCK" | "CHANNEL", _) => return refuse(Fault::File { id }),
            _ => return refuse(Fault::Argument),
        }
    }
    let Some(x) = x else { return refuse(Fault::NoX { id }) };
    let expected = if y.len() == 1 && y[0].len() == x.len() { x.len() } else { x.len() + 1 };
    let (mut z, mut curves) = (Vec::new(), Vec::new());
    for list in y {
        if list.len() != expected {
            return refuse(Fault::Count { id, found: list.len(), expected });
        }
        let values = list.split_at(expected - x.len());
        z.extend(values.0);
        curves.push(values.1.to_vec());
    }
    if curves.is_empty() {
        return refuse(Fault::NoY { id });
    }
    match Curves::new(x, z, curves) {
        Ok(curves) => {
            Ok(Spline { id, name: statement.name.clone(), units: statement.units.clone(), linear, curves })
        }
        Err(fault) => refuse(fault),
    }
}
