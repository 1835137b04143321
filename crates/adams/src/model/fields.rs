//! The arguments of a statement, checked.

use super::body::turn;
use crate::{Error, Fault, Statement, Value};

/// One statement, for reading.
#[derive(Clone, Copy)]
pub(crate) struct Fields<'a> {
    pub statement: &'a Statement,
}

impl<'a> Fields<'a> {
    pub fn fault(&self, fault: Fault) -> Error {
        Error::Statement {
            keyword: self.statement.keyword.clone(),
            id: self.statement.id.unwrap_or(0),
            fault: Box::new(fault),
        }
    }

    pub fn id(&self) -> Result<u32, Error> {
        self.statement.id.filter(|id| *id > 0).ok_or_else(|| self.fault(Fault::Id))
    }

    pub fn flag(&self, name: &str) -> bool {
        self.statement.get(name).is_some()
    }

    fn wrong(&self, name: &str) -> Error {
        self.fault(Fault::Given { argument: name.to_owned() })
    }

    pub fn lacks(&self, name: &str) -> Error {
        self.fault(Fault::Lacks { argument: name.to_owned() })
    }

    /// Numbers, angles in radians.
    pub fn numbers(&self, name: &str) -> Result<Option<Vec<f64>>, Error> {
        let all = match self.statement.get(name) {
            None => return Ok(None),
            Some(Value::Numbers(all)) => all.clone(),
            Some(Value::Degrees(all)) => all.iter().map(|angle| angle.to_radians()).collect(),
            Some(Value::Whole(whole)) => vec![*whole as f64],
            Some(_) => return Err(self.wrong(name)),
        };
        if all.iter().all(|value| value.is_finite()) { Ok(Some(all)) } else { Err(self.wrong(name)) }
    }

    pub fn number(&self, name: &str) -> Result<Option<f64>, Error> {
        match self.numbers(name)?.as_deref() {
            None => Ok(None),
            Some([value]) => Ok(Some(*value)),
            Some(_) => Err(self.wrong(name)),
        }
    }

    pub fn needed(&self, name: &str) -> Result<f64, Error> {
        self.number(name)?.ok_or_else(|| self.lacks(name))
    }

    pub fn three(&self, name: &str) -> Result<Option<[f64; 3]>, Error> {
        match self.numbers(name)?.as_deref() {
            None => Ok(None),
            Some([a, b, c]) => Ok(Some([*a, *b, *c])),
            Some(_) => Err(self.wrong(name)),
        }
    }

    /// Three angles as cosine and sine.
    pub fn angles(&self, name: &str) -> Result<Option<[(f64, f64); 3]>, Error> {
        let Some(value) = self.statement.get(name) else { return Ok(None) };
        match turn(value).as_deref() {
            Some([a, b, c]) if self.three(name)?.is_some() => Ok(Some([*a, *b, *c])),
            _ => Err(self.wrong(name)),
        }
    }

    pub fn reference(&self, name: &str) -> Result<Option<u32>, Error> {
        match self.statement.get(name) {
            None => Ok(None),
            Some(Value::Whole(whole)) => u32::try_from(*whole).map(Some).map_err(|_| self.wrong(name)),
            Some(_) => Err(self.wrong(name)),
        }
    }

    pub fn function(&self, name: &str) -> Result<Option<&'a str>, Error> {
        match self.statement.get(name) {
            None => Ok(None),
            Some(Value::Function(text)) => Ok(Some(text)),
            Some(_) => Err(self.wrong(name)),
        }
    }

    /// The one of these flags that is there.
    pub fn one_of(&self, names: &[&'static str]) -> Result<Option<&'static str>, Error> {
        let mut found = names.iter().filter(|name| self.flag(name));
        match (found.next(), found.next()) {
            (first, None) => Ok(first.copied()),
            (_, Some(second)) => Err(self.wrong(second)),
        }
    }
}
