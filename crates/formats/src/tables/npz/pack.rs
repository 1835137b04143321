//! The arrays of a file, with checks of types and lengths.

use super::array::{Array, Data};
use crate::grid::GridBlock;
use crate::text::diagnostic::Diagnostic;

/// Quantity and rails (of deflection and of load) of a table, if known.
pub(super) type Relation = (Option<GridBlock>, Option<[String; 2]>);

/// The arrays of a file.
pub(super) struct Pack<'f> {
    pub file: &'f str,
    pub arrays: Vec<(String, Array)>,
}

impl Pack<'_> {
    /// A diagnostic for an array, or for an item of it.
    pub fn fault(&self, path: &str, expected: impl Into<String>) -> Diagnostic {
        Diagnostic {
            path: path.to_owned(),
            ..Diagnostic::of_file(self.file, expected)
        }
    }

    /// The array with this name.
    pub fn find(&self, name: &str) -> Option<&Array> {
        self.arrays
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, array)| array)
    }

    /// Strings of an array, if it exists.
    pub fn words(&self, name: &str) -> Result<Option<Vec<String>>, Box<Diagnostic>> {
        match self.find(name).map(|array| &array.data) {
            None => Ok(None),
            Some(Data::Words(words)) => Ok(Some(words.clone())),
            Some(Data::Numbers(_)) => Err(self
                .fault(name, "must be text")
                .hint("such as numpy.array([\"ft\", \"lbf\", \"s\"])")
                .into()),
        }
    }

    /// Numbers of a one-dimensional array, if it exists.
    pub fn line(&self, name: &str) -> Result<Option<&[f64]>, Box<Diagnostic>> {
        let Some(array) = self.find(name) else {
            return Ok(None);
        };
        match (&array.data, array.shape.as_slice()) {
            (Data::Numbers(list), [_]) => Ok(Some(list)),
            (Data::Numbers(_), shape) => Err(self.got(
                name,
                "must have one dimension",
                format!("the shape {shape:?}"),
            )),
            (Data::Words(_), _) => Err(self.fault(name, "must be numbers").into()),
        }
    }

    /// A diagnostic with the value that was found.
    pub fn got(&self, path: &str, expected: &str, found: impl ToString) -> Box<Diagnostic> {
        Box::new(Diagnostic {
            found: Some(found.to_string()),
            ..self.fault(path, expected)
        })
    }

    /// Strings of an array, if it exists; their number must be `count`.
    pub fn matched(
        &self,
        name: &str,
        count: usize,
    ) -> Result<Option<Vec<String>>, Box<Diagnostic>> {
        let words = self.words(name)?;
        match &words {
            Some(list) if list.len() != count => {
                Err(self.got(name, &format!("must have {count} items"), list.len()))
            }
            _ => Ok(words),
        }
    }

    /// Numbers of `count` tables, if the array exists.
    pub fn ids(&self, name: &str, count: usize) -> Result<Option<Vec<u32>>, Box<Diagnostic>> {
        let Some(list) = self.line(name)? else {
            return Ok(None);
        };
        if list.len() != count {
            return Err(self.got(name, &format!("must have {count} items"), list.len()));
        }
        let ids = list
            .iter()
            .enumerate()
            .map(|(k, value)| self.id(&format!("{name}[{k}]"), *value));
        ids.collect::<Result<Vec<u32>, _>>().map(Some)
    }

    /// The number of a table, which must be a whole number above 0.
    pub fn id(&self, path: &str, value: f64) -> Result<u32, Box<Diagnostic>> {
        let whole = value.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&value);
        if whole {
            Ok(value as u32)
        } else {
            Err(self.got(path, "must be a whole number above 0", value))
        }
    }

    /// Quantities and rails of `count` keys, from the arrays whose names have the prefix `before`.
    pub fn relations(&self, before: &str, count: usize) -> Result<Vec<Relation>, Box<Diagnostic>> {
        let named = |name: &str| self.matched(&format!("{before}{name}"), count);
        let (quantities, rails, loads) = (named("quantity")?, named("rail")?, named("load_rail")?);
        let mut out = Vec::new();
        for k in 0..count {
            let quantity =
                match quantities
                    .as_ref()
                    .map(|list| list[k].as_str())
                    .filter(|word| !word.is_empty())
                {
                    None => None,
                    Some(word) => {
                        let known = GridBlock::ALL.into_iter().find(|one| one.name() == word);
                        let path = format!("{before}quantity[{k}]");
                        Some(known.ok_or_else(|| {
                            self.got(&path, "must be the name of a quantity", word)
                        })?)
                    }
                };
            let pair = rails
                .as_ref()
                .zip(loads.as_ref())
                .map(|(rails, loads)| [rails[k].clone(), loads[k].clone()]);
            out.push((
                quantity,
                pair.filter(|pair| pair.iter().all(|rail| !rail.is_empty())),
            ));
        }
        Ok(out)
    }

    /// x or z of a table (`side` is "x" or "z"), and the name of the array that contains them.
    pub fn stations(&self, key: &str, side: &str) -> Result<(String, Vec<f64>), Box<Diagnostic>> {
        for name in [
            format!("{key}_{side}"),
            side.to_owned(),
            "stations".to_owned(),
        ] {
            if let Some(list) = self.line(&name)? {
                return Ok((name, list.to_vec()));
            }
        }
        let fault = self.fault(
            key,
            format!("has no stations: no array `{key}_{side}`, `{side}` or `stations`"),
        );
        Err(fault
            .hint("numpy.savez(file, stations=x, vertical=values, units=[\"ft\", \"lbf\", \"s\"])")
            .into())
    }
}
