//! Checked access to the arguments of a statement.

use crate::{AdamsFault, ArgumentValue, Error, Statement, StatementId};

/// A statement whose arguments are read and checked. A missing optional argument is `None`; a value of the
/// wrong form is an error that names the statement and the argument.
#[derive(Clone, Copy)]
pub(super) struct Arguments<'a> {
    pub statement: &'a Statement,
}

impl<'a> Arguments<'a> {
    /// An error of this statement.
    pub fn fault(&self, fault: AdamsFault) -> Error {
        Error::Statement {
            statement: StatementId::new(&self.statement.keyword, self.statement.id.unwrap_or(0)),
            fault: Box::new(fault),
        }
    }

    /// The identifier.
    pub fn id(&self) -> Result<u32, Error> {
        self.statement
            .id
            .filter(|id| *id > 0)
            .ok_or_else(|| self.fault(AdamsFault::Id))
    }

    /// Whether an argument is given.
    pub fn flag(&self, name: &str) -> bool {
        self.statement.get(name).is_some()
    }

    /// The error of a value of the wrong form.
    pub fn wrong_form(&self, argument: &'static str) -> Error {
        self.fault(AdamsFault::WrongForm { argument })
    }

    /// The error of a required argument that is missing.
    pub fn missing_argument(&self, argument: &'static str) -> Error {
        self.fault(AdamsFault::MissingArgument { argument })
    }

    /// A list of finite numbers; angles in radians.
    pub fn numbers(&self, name: &'static str) -> Result<Option<Vec<f64>>, Error> {
        let all = match self.statement.get(name) {
            None => return Ok(None),
            Some(ArgumentValue::Numbers(all)) => all.clone(),
            Some(ArgumentValue::Degrees(all)) => {
                all.iter().map(|angle| angle.to_radians()).collect()
            }
            Some(ArgumentValue::Whole(whole)) => vec![*whole as f64],
            Some(_) => return Err(self.wrong_form(name)),
        };
        if all.iter().all(|value| value.is_finite()) {
            Ok(Some(all))
        } else {
            Err(self.wrong_form(name))
        }
    }

    /// One finite number.
    pub fn number(&self, name: &'static str) -> Result<Option<f64>, Error> {
        match self.numbers(name)?.as_deref() {
            None => Ok(None),
            Some([value]) => Ok(Some(*value)),
            Some(_) => Err(self.wrong_form(name)),
        }
    }

    /// One finite number that must be given.
    pub fn required(&self, name: &'static str) -> Result<f64, Error> {
        self.number(name)?
            .ok_or_else(|| self.missing_argument(name))
    }

    /// Three finite numbers.
    pub fn three(&self, name: &'static str) -> Result<Option<[f64; 3]>, Error> {
        match self.numbers(name)?.as_deref() {
            None => Ok(None),
            Some([a, b, c]) => Ok(Some([*a, *b, *c])),
            Some(_) => Err(self.wrong_form(name)),
        }
    }

    /// Three angles, each as cosine and sine.
    pub fn angles(&self, name: &'static str) -> Result<Option<[(f64, f64); 3]>, Error> {
        let Some(value) = self.statement.get(name) else {
            return Ok(None);
        };
        match cosines_and_sines(value).as_deref() {
            Some([a, b, c]) if self.three(name)?.is_some() => Ok(Some([*a, *b, *c])),
            _ => Err(self.wrong_form(name)),
        }
    }

    /// The identifier of another statement.
    pub fn reference(&self, name: &'static str) -> Result<Option<u32>, Error> {
        match self.statement.get(name) {
            None => Ok(None),
            Some(ArgumentValue::Whole(whole)) => u32::try_from(*whole)
                .map(Some)
                .map_err(|_| self.wrong_form(name)),
            Some(_) => Err(self.wrong_form(name)),
        }
    }

    /// The text of a function expression.
    pub fn function(&self, name: &'static str) -> Result<Option<&'a str>, Error> {
        match self.statement.get(name) {
            None => Ok(None),
            Some(ArgumentValue::Function(text)) => Ok(Some(text)),
            Some(_) => Err(self.wrong_form(name)),
        }
    }

    /// The only one of these arguments without value that is given.
    pub fn one_of(&self, names: &[&'static str]) -> Result<Option<&'static str>, Error> {
        let mut found = names.iter().filter(|name| self.flag(name));
        match (found.next(), found.next()) {
            (first, None) => Ok(first.copied()),
            (_, Some(second)) => Err(self.wrong_form(second)),
        }
    }
}

/// The cosine and sine of every angle of a value. They are exact for multiples of 90 degrees given in
/// degrees.
pub(super) fn cosines_and_sines(value: &ArgumentValue) -> Option<Vec<(f64, f64)>> {
    match value {
        ArgumentValue::Numbers(all) => {
            Some(all.iter().map(|angle| (angle.cos(), angle.sin())).collect())
        }
        ArgumentValue::Degrees(all) => Some(
            all.iter()
                .map(|degrees| {
                    let quarter = degrees.rem_euclid(360.0) / 90.0;
                    match quarter {
                        0.0 => (1.0, 0.0),
                        1.0 => (0.0, 1.0),
                        2.0 => (-1.0, 0.0),
                        3.0 => (0.0, -1.0),
                        _ => (degrees.to_radians().cos(), degrees.to_radians().sin()),
                    }
                })
                .collect(),
        ),
        ArgumentValue::Whole(angle) => Some(vec![((*angle as f64).cos(), (*angle as f64).sin())]),
        _ => None,
    }
}
