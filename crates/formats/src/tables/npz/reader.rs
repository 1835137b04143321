//! Reads the tables of an archive of arrays.

use super::archive;
use super::array::Data;
use super::keys::META;
use super::pack::Pack;
use crate::spec::stem;
use crate::tables::defect::{self, Defect, Part};
use crate::tables::parsed::{Draft, Parsed};
use crate::tables::set::Product;
use crate::text::diagnostic::Diagnostic;
use crate::units::Units;

/// Reads an archive written by this program or by a user of NumPy. In the latter every matrix is a table with the
/// name of its array K, and its stations are `K_x` and `K_z`, or `x` and `z`, or `stations` for both.
pub(in crate::tables) fn read(file: &str, bytes: &[u8]) -> Result<Parsed, Vec<Diagnostic>> {
    let one = |fault: Box<Diagnostic>| vec![*fault];
    let arrays = archive::read(file, bytes).map_err(one)?;
    let pack = Pack { file, arrays };
    let given = match pack.words("units").map_err(one)? {
        None => None,
        Some(words) => {
            let units = Units::parse(&words.join(" "));
            let hint =
                "such as [\"ft\", \"lbf\", \"s\"]; length ft, in, m or mm; force lbf, kip, N or kN";
            Some(units.ok_or_else(|| {
                vec![
                    pack.fault("units", "must be units of length and force")
                        .hint(hint),
                ]
            })?)
        }
    };
    let name = pack
        .words("name")
        .map_err(one)?
        .and_then(|words| words.into_iter().next());
    let mut drafts = pack.tables().map_err(one)?;
    drafts.extend(pack.curves().map_err(one)?);
    if drafts.is_empty() {
        let fault = Diagnostic::of_file(file, "has no table");
        return Err(vec![fault.hint(
            "a table is a matrix: row z, column x; its stations are an array `stations`",
        )]);
    }
    for (k, draft) in drafts.iter().enumerate() {
        if draft.id.is_some() && drafts[..k].iter().any(|other| other.id == draft.id) {
            return Err(vec![pack.fault("ids", "must all differ")]);
        }
    }
    Ok(Parsed {
        name: name.unwrap_or_else(|| stem(file)),
        units: given,
        missing_units: [
            "states no units",
            "such as an array units=[\"ft\", \"lbf\", \"s\"]",
        ],
        products: pack.products(&drafts).map_err(one)?,
        left_out: Vec::new(),
        drafts,
        comments: String::new(),
    })
}

impl Pack<'_> {
    /// The tables over load and deflection: those listed in `tables`, or every matrix.
    fn tables(&self) -> Result<Vec<Draft>, Box<Diagnostic>> {
        let listed = self.words("tables")?;
        let ours = listed.is_some() || self.find("curves").is_some();
        let keys = match listed {
            Some(list) => list,
            None if ours => Vec::new(),
            None => self.matrices()?,
        };
        let names = self.matched("names", keys.len())?;
        let ids = self.ids("ids", keys.len())?;
        let relations = self.relations("", keys.len())?;
        let mut out = Vec::new();
        for (k, (key, (quantity, rails))) in keys.iter().zip(relations).enumerate() {
            let array = self.find(key).ok_or_else(|| {
                self.fault(
                    &format!("tables[{k}]"),
                    format!("no array is called `{key}`"),
                )
            })?;
            let (rows, columns) = match (&array.data, array.shape.as_slice()) {
                (Data::Numbers(list), [rows, columns]) if *columns > 0 => ((*rows, list), *columns),
                (Data::Numbers(list), [columns]) if *columns > 0 => ((1, list), *columns),
                (_, shape) => {
                    return Err(self.got(
                        key,
                        "must be a matrix of numbers",
                        format!("the shape {shape:?}"),
                    ));
                }
            };
            let rows_of: Vec<Vec<f64>> = rows.1.chunks(columns).map(<[f64]>::to_vec).collect();
            let (x_name, x) = self.stations(key, "x")?;
            let (z_name, z) = if array.shape.len() == 1 {
                (String::new(), Vec::new())
            } else {
                self.stations(key, "z")?
            };
            let curves = defect::checked(x, z, rows_of).map_err(|defect| {
                self.located(defect, key, [&x_name, &z_name], array.shape.len() == 1)
            })?;
            out.push(Draft {
                id: ids.as_ref().map(|list| list[k]),
                name: Some(
                    names
                        .as_ref()
                        .map_or_else(|| key.clone(), |list| list[k].clone()),
                ),
                quantity,
                rails,
                ..Draft::of(curves)
            });
        }
        Ok(out)
    }

    /// Names of the arrays that are tables, for a file that does not list them.
    fn matrices(&self) -> Result<Vec<String>, Box<Diagnostic>> {
        let mut out = Vec::new();
        for (name, array) in &self.arrays {
            let stations = name.strip_suffix("_x").or_else(|| name.strip_suffix("_z"));
            let known = META.contains(&name.as_str())
                || stations.is_some_and(|key| self.find(key).is_some());
            match (&array.data, array.shape.len()) {
                _ if known => {}
                (Data::Numbers(_), 1 | 2) => out.push(name.clone()),
                _ => {
                    let fault = self.got(
                        name,
                        "unknown array",
                        format!("the shape {:?}", array.shape),
                    );
                    return Err(fault
                        .hint(format!(
                            "tables are matrices; other arrays are {}",
                            META.join(", ")
                        ))
                        .into());
                }
            }
        }
        Ok(out)
    }

    /// Converts a defect of the table `key` to a diagnostic. `x` and `z` are the arrays of its stations; `line`
    /// specifies whether the table has one dimension.
    fn located(&self, defect: Defect, key: &str, [x, z]: [&str; 2], line: bool) -> Diagnostic {
        let path = match defect.part {
            Part::Xs => x.to_owned(),
            Part::X(k) => format!("{x}[{k}]"),
            Part::Z(k) => format!("{z}[{k}]"),
            Part::Values => key.to_owned(),
            Part::Row(_) if line => key.to_owned(),
            Part::Row(i) => format!("{key}[{i}]"),
            Part::Value(_, j) if line => format!("{key}[{j}]"),
            Part::Value(i, j) => format!("{key}[{i}][{j}]"),
        };
        let fault = self.fault(&path, defect.expected);
        Diagnostic {
            found: defect.found,
            hint: defect.hint.map(str::to_owned),
            ..fault
        }
    }

    /// The tables of one curve: columns of the arrays listed in `curves`.
    fn curves(&self) -> Result<Vec<Draft>, Box<Diagnostic>> {
        let Some(keys) = self.words("curves")? else {
            return Ok(Vec::new());
        };
        let relations = self.relations("curves_", keys.len())?;
        let mut out = Vec::new();
        for (k, (key, (quantity, rails))) in keys.iter().zip(relations).enumerate() {
            let array = self.find(key).ok_or_else(|| {
                self.fault(
                    &format!("curves[{k}]"),
                    format!("no array is called `{key}`"),
                )
            })?;
            let (Data::Numbers(list), [_, count]) = (&array.data, array.shape.as_slice()) else {
                return Err(self.got(
                    key,
                    "must be a matrix of numbers",
                    format!("the shape {:?}", array.shape),
                ));
            };
            let names = self.matched(&format!("{key}_names"), *count)?;
            let ids = self.ids(&format!("{key}_ids"), *count)?;
            let (x_name, x) = self.stations(key, "x")?;
            for c in 0..*count {
                let values: Vec<f64> = list.iter().skip(c).step_by(*count).copied().collect();
                let curves =
                    defect::checked(x.clone(), Vec::new(), vec![values]).map_err(|defect| {
                        let column = |part: Part| match part {
                            Part::Value(_, j) => Part::Value(j, c),
                            Part::Row(_) => Part::Values,
                            other => other,
                        };
                        self.located(
                            Defect {
                                part: column(defect.part),
                                ..defect
                            },
                            key,
                            [&x_name, ""],
                            false,
                        )
                    })?;
                out.push(Draft {
                    id: ids.as_ref().map(|list| list[c]),
                    name: Some(
                        names
                            .as_ref()
                            .map_or_else(|| format!("{key}_{}", c + 1), |list| list[c].clone()),
                    ),
                    quantity,
                    rails: rails.clone(),
                    ..Draft::of(curves)
                });
            }
        }
        Ok(out)
    }

    /// The products of the factored form. Their terms must be curves with the same x.
    fn products(&self, drafts: &[Draft]) -> Result<Vec<Product>, Box<Diagnostic>> {
        let Some(keys) = self.words("products")? else {
            return Ok(Vec::new());
        };
        let names = self.matched("products_names", keys.len())?;
        let relations = self.relations("products_", keys.len())?;
        let mut out = Vec::new();
        for (k, (key, (quantity, rails))) in keys.iter().zip(relations).enumerate() {
            let path = format!("{key}_terms");
            let array = self.find(&path).ok_or_else(|| {
                self.fault(
                    &format!("products[{k}]"),
                    format!("no array is called `{path}`"),
                )
            })?;
            let (Data::Numbers(list), [_, 2]) = (&array.data, array.shape.as_slice()) else {
                return Err(self.got(
                    &path,
                    "must have two columns of numbers",
                    format!("the shape {:?}", array.shape),
                ));
            };
            let x_of = |id: u32| {
                let draft = drafts
                    .iter()
                    .find(|draft| draft.id == Some(id) && draft.curves.z().is_empty());
                draft.map(|draft| draft.curves.x())
            };
            let mut terms: Vec<[u32; 2]> = Vec::new();
            for (t, pair) in list.chunks(2).enumerate() {
                let mut term = [0; 2];
                for (side, value) in pair.iter().enumerate() {
                    let place = format!("{path}[{t}][{side}]");
                    let id = self.id(&place, *value)?;
                    let first = terms.first().map_or(id, |first| first[side]);
                    match x_of(id) {
                        None => {
                            return Err(self.got(
                                &place,
                                "must be the number of a table of one curve",
                                id,
                            ));
                        }
                        Some(x) if Some(x) != x_of(first) => {
                            return Err(self.got(
                                &place,
                                "must have the same x as the first term",
                                id,
                            ));
                        }
                        Some(_) => term[side] = id,
                    }
                }
                terms.push(term);
            }
            let name = names
                .as_ref()
                .map_or_else(|| key.clone(), |list| list[k].clone());
            out.push(Product {
                name,
                quantity,
                rails,
                terms,
            });
        }
        Ok(out)
    }
}
