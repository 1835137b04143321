//! Tables as JSON: `girderway-tables/1`, or a single table as `x`, `z` and `values`.

use std::fmt::Write;

use adams::SplineValues;
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::defect::{self, Defect, Part};
use super::parsed::{Draft, Parsed};
use super::set::{Product, TableSet};
use crate::grid::GridBlock;
use crate::spec::{format, stem};
use crate::text::diagnostic::Diagnostic;
use crate::text::fault::{Fault, Faults};
use crate::text::place::Place;
use crate::text::source::Source;
use crate::units::{RawUnits, Units};

crate::text::object::objects!(RawSet, RawTable, RawProduct);

/// Value of the member `format`: name and version of the format.
pub(super) const FORMAT: &str = "girderway-tables/1";

/// The text, with one row of values per line and every number in its shortest exact decimal form.
pub(super) fn write(set: &TableSet) -> String {
    let mut text = format!(
        "{{\n  \"format\": \"{FORMAT}\",\n  \"name\": {},\n",
        json!(set.name)
    );
    // writing to a string cannot fail
    let _ = writeln!(text, "  \"units\": {},\n  \"tables\": [", set.units.json());
    for (k, table) in set.tables.iter().enumerate() {
        let mut head = Map::new();
        head.insert("id".into(), json!(table.id));
        head.insert("name".into(), json!(table.name));
        relation(&mut head, table.quantity, &table.rails);
        let head = Value::Object(head).to_string();
        let head = head.trim_start_matches('{').trim_end_matches('}');
        let _ = writeln!(
            text,
            "    {{{head},\n      \"x\": {},",
            json!(table.curves.x())
        );
        if !table.curves.z().is_empty() {
            let _ = writeln!(text, "      \"z\": {},", json!(table.curves.z()));
        }
        let rows: Vec<String> = table
            .curves
            .y()
            .iter()
            .map(|row| format!("        {}", json!(row)))
            .collect();
        let comma = if k + 1 < set.tables.len() { "," } else { "" };
        let _ = writeln!(
            text,
            "      \"values\": [\n{}\n      ]}}{comma}",
            rows.join(",\n")
        );
    }
    text.push_str("  ]");
    if !set.products.is_empty() {
        let product = |product: &Product| {
            let mut object = Map::new();
            object.insert("name".into(), json!(product.name));
            relation(&mut object, product.quantity, &product.rails);
            object.insert("terms".into(), json!(product.terms));
            object.insert("expression".into(), json!(product.expression()));
            format!("    {}", Value::Object(object))
        };
        let products: Vec<String> = set.products.iter().map(product).collect();
        let _ = write!(text, ",\n  \"factored\": [\n{}\n  ]", products.join(",\n"));
    }
    text.push_str("\n}\n");
    text
}

/// Adds the quantity and the rails, if known.
fn relation(
    object: &mut Map<String, Value>,
    quantity: Option<GridBlock>,
    rails: &Option<[String; 2]>,
) {
    if let Some(quantity) = quantity {
        object.insert("quantity".into(), json!(quantity.name()));
    }
    if let Some([rail, load_rail]) = rails {
        object.insert("rail".into(), json!(rail));
        object.insert("load_rail".into(), json!(load_rail));
    }
}

#[derive(Debug, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawSet {
    format: Option<String>,
    name: Option<String>,
    units: Option<RawUnits>,
    tables: Option<Vec<RawTable>>,
    factored: Option<Vec<RawProduct>>,
    /// These four are the one table of a file without `format` and `tables`.
    x: Option<Vec<f64>>,
    z: Option<Vec<f64>>,
    stations: Option<Vec<f64>>,
    values: Option<Vec<Vec<f64>>>,
}

#[derive(Debug, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawTable {
    id: Option<u32>,
    name: Option<String>,
    quantity: Option<String>,
    rail: Option<String>,
    load_rail: Option<String>,
    x: Option<Vec<f64>>,
    z: Option<Vec<f64>>,
    values: Option<Vec<Vec<f64>>>,
}

#[derive(Debug, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawProduct {
    name: Option<String>,
    quantity: Option<String>,
    rail: Option<String>,
    load_rail: Option<String>,
    terms: Option<Vec<[u32; 2]>>,
    /// Follows from the terms and is not read.
    #[serde(rename = "expression")]
    _expression: Option<String>,
}

/// Reads `girderway-tables/1`, or an object of `x`, `z` (or `stations` for both) and `values`.
pub(super) fn read(source: &Source) -> Result<Parsed, Vec<Diagnostic>> {
    source.read(FORMAT, |raw: &RawSet, faults| {
        Some(check(raw, source, faults))
    })
}

fn check(raw: &RawSet, source: &Source, faults: &mut Faults) -> Parsed {
    let root = Place::root();
    let units = match &raw.units {
        None => None,
        units => Units::read(units, &root, faults),
    };
    let name = raw.name.clone().unwrap_or_else(|| stem(&source.name));
    let mut products = Vec::new();
    let drafts = if raw.format.is_some() || raw.tables.is_some() {
        format(&raw.format, FORMAT, &root, faults);
        for (key, there) in [
            ("x", raw.x.is_some()),
            ("z", raw.z.is_some()),
            ("stations", raw.stations.is_some()),
            ("values", raw.values.is_some()),
        ] {
            if there {
                let fault = Fault::new(&root.key(key), format!("unknown key `{key}`")).at_key();
                faults.add(fault.hint("numbers belong in `tables`"));
            }
        }
        let list = root.key("tables");
        let tables = faults
            .require(&raw.tables, &root, "tables")
            .map(Vec::as_slice)
            .unwrap_or_default();
        let drafts: Vec<Option<Draft>> = tables
            .iter()
            .enumerate()
            .map(|(k, table)| draft(table, &list.index(k), faults))
            .collect();
        check_ids(tables, &list, faults);
        products = read_products(raw, tables, &root.key("factored"), faults);
        if drafts.is_empty() && faults.0.is_empty() {
            faults.add(Fault::new(&list, "must have at least one table"));
        }
        drafts.into_iter().flatten().collect()
    } else {
        single(raw, &root, faults).into_iter().collect()
    };
    let missing_units = [
        "has no `units`",
        "such as \"units\": {\"length\": \"ft\", \"force\": \"lbf\", \"time\": \"s\"}",
    ];
    Parsed {
        name,
        units,
        missing_units,
        drafts,
        comments: String::new(),
        products,
        left_out: Vec::new(),
    }
}

/// The one table of a file without `format` and `tables`.
fn single(raw: &RawSet, root: &Place<'_>, faults: &mut Faults) -> Option<Draft> {
    let values = faults.require(&raw.values, root, "values")?;
    let (key, x) = match (&raw.stations, &raw.x) {
        (Some(_), Some(_)) => {
            faults.add(Fault::new(
                &root.key("x"),
                "cannot be combined with `stations`",
            ));
            return None;
        }
        (Some(stations), None) => ("stations", stations),
        (None, _) => ("x", faults.require(&raw.x, root, "x")?),
    };
    let z = match (&raw.stations, &raw.z) {
        (Some(_), Some(_)) => {
            faults.add(Fault::new(
                &root.key("z"),
                "cannot be combined with `stations`",
            ));
            return None;
        }
        (Some(stations), None) => stations.clone(),
        (None, z) => z.clone().unwrap_or_default(),
    };
    let curves = defect::checked(x.clone(), z, values.clone());
    let curves = curves
        .map_err(|defect| faults.add(placed(defect, root, key)))
        .ok()?;
    Some(Draft {
        name: raw.name.clone(),
        ..Draft::of(curves)
    })
}

/// One of `tables`.
fn draft(raw: &RawTable, at: &Place<'_>, faults: &mut Faults) -> Option<Draft> {
    let quantity = quantity(&raw.quantity, at, faults);
    let (x, values) = (
        faults.require(&raw.x, at, "x"),
        faults.require(&raw.values, at, "values"),
    );
    let (x, values) = x.zip(values)?;
    let z = raw.z.clone().unwrap_or_default();
    let curves: Result<SplineValues, Defect> = defect::checked(x.clone(), z, values.clone());
    let curves = curves
        .map_err(|defect| faults.add(placed(defect, at, "x")))
        .ok()?;
    let rails = raw
        .rail
        .clone()
        .zip(raw.load_rail.clone())
        .map(|(rail, load)| [rail, load]);
    Some(Draft {
        id: raw.id,
        name: raw.name.clone(),
        quantity,
        rails,
        ..Draft::of(curves)
    })
}

fn quantity(word: &Option<String>, at: &Place<'_>, faults: &mut Faults) -> Option<GridBlock> {
    let words: Vec<(&str, GridBlock)> = GridBlock::ALL
        .iter()
        .map(|one| (one.name(), *one))
        .collect();
    word.as_ref()
        .and_then(|word| faults.one_of(word, &at.key("quantity"), &words))
}

/// Converts a defect to a fault below `at`. `x` is the key of the x coordinates.
fn placed(defect: Defect, at: &Place<'_>, x: &str) -> Fault {
    let (values, xs, zs) = (
        at.key("values"),
        at.key(x),
        at.key(if x == "x" { "z" } else { x }),
    );
    let fault = |place: &Place<'_>| Fault {
        found: defect.found.clone(),
        hint: defect.hint.map(str::to_owned),
        ..Fault::new(place, defect.expected.clone())
    };
    match defect.part {
        Part::Xs => fault(&xs),
        Part::X(k) => fault(&xs.index(k)),
        Part::Z(k) => fault(&zs.index(k)),
        Part::Values => fault(&values),
        Part::Row(i) => fault(&values.index(i)),
        Part::Value(i, j) => fault(&values.index(i).index(j)),
    }
}

/// Checks that the numbers of tables are positive and unique.
fn check_ids(tables: &[RawTable], list: &Place<'_>, faults: &mut Faults) {
    for (k, table) in tables.iter().enumerate() {
        let Some(id) = table.id else { continue };
        let place = list.index(k);
        if id == 0 {
            faults.add(Fault::new(&place.key("id"), "must be positive").got(id));
        } else if tables[..k].iter().any(|other| other.id == Some(id)) {
            faults.add(Fault::new(&place.key("id"), "must differ from the other tables").got(id));
        }
    }
}

/// Reads the products in `factored`. Their terms must be curves with the same x.
fn read_products(
    raw: &RawSet,
    tables: &[RawTable],
    list: &Place<'_>,
    faults: &mut Faults,
) -> Vec<Product> {
    let mut out = Vec::new();
    for (k, raw) in raw.factored.iter().flatten().enumerate() {
        let at = list.index(k);
        let name = faults
            .require(&raw.name, &at, "name")
            .cloned()
            .unwrap_or_default();
        let terms = faults
            .require(&raw.terms, &at, "terms")
            .cloned()
            .unwrap_or_default();
        let place = at.key("terms");
        let find = |id: u32| tables.iter().find(|table| table.id == Some(id));
        let x_of = |id: u32| {
            find(id)
                .filter(|table| table.z.as_ref().is_none_or(Vec::is_empty))
                .map(|table| &table.x)
        };
        for (t, term) in terms.iter().enumerate() {
            for (side, &id) in term.iter().enumerate() {
                let term = place.index(t);
                let expected = match x_of(id) {
                    None => "must be the id of a table of one curve",
                    Some(x) if Some(x) != x_of(terms[0][side]) => {
                        "must have the same x as the first term"
                    }
                    Some(_) => continue,
                };
                faults.add(Fault::new(&term.index(side), expected).got(id));
            }
        }
        let rails = raw
            .rail
            .clone()
            .zip(raw.load_rail.clone())
            .map(|(rail, load)| [rail, load]);
        out.push(Product {
            name,
            quantity: quantity(&raw.quantity, &at, faults),
            rails,
            terms,
        });
    }
    out
}
