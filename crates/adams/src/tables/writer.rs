//! Tables to text.

use super::{Spline, Tables};
use crate::units::{Units, keyword};
use crate::{DataSet, Error, Statement};

/// Writes a data set: title, UNITS, the SPLINE statements with their View names, END.
///
/// Guarantees: lines of at most 79 ASCII characters; every number with the digits that make [`super::read`]
/// return the same bits. A title is cut to one such line; it begins with "Model: " if it would otherwise read
/// as a statement or comment.
///
/// # Errors
/// An identifier that is zero or used twice; a name that has no place between quotes on one line.
pub fn write(tables: &Tables) -> Result<String, Error> {
    let units = tables.units.iter().map(Units::statement);
    let statements = units.chain(tables.splines.iter().map(Spline::statement)).collect();
    DataSet { title: tables.title.clone().unwrap_or_default(), statements }.write()
}

impl Units {
    /// The UNITS statement.
    #[must_use]
    pub fn statement(&self) -> Statement {
        Statement::lone("UNITS")
            .word("FORCE", keyword(self.force))
            .word("MASS", keyword(self.mass))
            .word("LENGTH", keyword(self.length))
            .word("TIME", "SECOND")
    }
}

impl Spline {
    /// The SPLINE statement.
    #[must_use]
    pub fn statement(&self) -> Statement {
        let mut out = Statement::new("SPLINE", self.id);
        (out.name, out.units) = (self.name.clone(), self.units.clone());
        if self.linear {
            out = out.flag("LINEAR_EXTRAPOLATE");
        }
        out = out.numbers("X", self.curves.x());
        for (i, values) in self.curves.y().iter().enumerate() {
            let line: Vec<f64> = self.curves.z().get(i).into_iter().chain(values).copied().collect();
            out = out.numbers("Y", &line);
        }
        out
    }
}
