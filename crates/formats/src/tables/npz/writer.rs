//! Writes tables as an archive of arrays.

use zip::result::ZipError;

use super::archive;
use super::array::{Array, Data};
use super::keys::{Keys, preferred};
use crate::grid::GridBlock;
use crate::tables::set::{Product, Table, TableSet};

/// The bytes of the archive. Equal tables result in equal bytes.
pub(in crate::tables) fn write(set: &TableSet) -> Result<Vec<u8>, ZipError> {
    let mut out = Out(Vec::new());
    let mut keys = Keys::default();
    out.add(
        "name",
        &Array {
            shape: Vec::new(),
            data: Data::Words(vec![set.name.clone()]),
        },
    );
    out.add(
        "units",
        &Array::words(&[set.units.length.word(), set.units.force.word(), "s"].map(str::to_owned)),
    );
    let (curves, tables): (Vec<&Table>, Vec<&Table>) = set
        .tables
        .iter()
        .partition(|table| table.curves.z().is_empty());
    let rails = set
        .tables
        .iter()
        .filter_map(|table| table.rails.as_ref())
        .flatten();
    let rails = rails.chain(
        set.products
            .iter()
            .filter_map(|product| product.rails.as_ref())
            .flatten(),
    );
    let mut known: Vec<&String> = rails.collect();
    known.sort();
    known.dedup();
    let one_rail = known.len() == 1;
    plain_tables(&mut out, &mut keys, &tables, one_rail);
    stacks(&mut out, &mut keys, &curves, one_rail);
    products(&mut out, &mut keys, &set.products, one_rail);
    archive::write(&out.0)
}

/// Arrays by name, as bytes.
struct Out(Vec<(String, Vec<u8>)>);

impl Out {
    fn add(&mut self, name: &str, array: &Array) {
        self.0.push((name.to_owned(), array.bytes(false)));
    }

    /// Adds numbers as 64-bit integers.
    fn whole(&mut self, name: &str, shape: Vec<usize>, list: Vec<f64>) {
        self.0.push((
            name.to_owned(),
            Array {
                shape,
                data: Data::Numbers(list),
            }
            .bytes(true),
        ));
    }

    fn ids(&mut self, name: &str, ids: impl Iterator<Item = u32>) {
        let list: Vec<f64> = ids.map(f64::from).collect();
        self.whole(name, vec![list.len()], list);
    }

    /// Adds the arrays `quantity`, `rail` and `load_rail`, with the prefix `before`, if some table has them.
    fn relations<'t>(
        &mut self,
        before: &str,
        all: impl Iterator<Item = (Option<GridBlock>, &'t Option<[String; 2]>)> + Clone,
    ) {
        if all.clone().any(|(quantity, _)| quantity.is_some()) {
            let quantity =
                |one: Option<GridBlock>| one.map(|one| one.to_string()).unwrap_or_default();
            let words: Vec<String> = all.clone().map(|(one, _)| quantity(one)).collect();
            self.add(&format!("{before}quantity"), &Array::words(&words));
        }
        if all.clone().any(|(_, rails)| rails.is_some()) {
            for (index, name) in ["rail", "load_rail"].into_iter().enumerate() {
                let rail =
                    |rails: &Option<[String; 2]>| rails.as_ref().map(|two| two[index].clone());
                let words: Vec<String> = all
                    .clone()
                    .map(|(_, rails)| rail(rails).unwrap_or_default())
                    .collect();
                self.add(&format!("{before}{name}"), &Array::words(&words));
            }
        }
    }
}

/// Adds the tables over load and deflection. They have common stations if these are exactly equal.
fn plain_tables(out: &mut Out, keys: &mut Keys, tables: &[&Table], one_rail: bool) {
    let Some(first) = tables.first() else { return };
    let names: Vec<String> = tables
        .iter()
        .map(|table| {
            keys.take(&preferred(
                &table.name,
                table.quantity,
                &table.rails,
                one_rail,
            ))
        })
        .collect();
    out.add("tables", &Array::words(&names));
    out.ids("ids", tables.iter().map(|table| table.id));
    out.add(
        "names",
        &Array::words(
            &tables
                .iter()
                .map(|table| table.name.clone())
                .collect::<Vec<_>>(),
        ),
    );
    out.relations(
        "",
        tables.iter().map(|table| (table.quantity, &table.rails)),
    );
    let stations = first.curves.x();
    let same = |table: &&Table| {
        [table.curves.x(), table.curves.z()]
            .iter()
            .all(|list| same_bits(list, stations))
    };
    let common = tables.iter().all(same);
    if common {
        out.add("stations", &Array::line(stations));
    }
    for (key, table) in names.iter().zip(tables) {
        let (x, z) = (table.curves.x(), table.curves.z());
        if !common {
            out.add(&format!("{key}_x"), &Array::line(x));
            out.add(&format!("{key}_z"), &Array::line(z));
        }
        out.add(
            key,
            &Array {
                shape: vec![z.len(), x.len()],
                data: Data::Numbers(table.curves.y().concat()),
            },
        );
    }
}

fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// Adds the curves. Consecutive curves with the same stations, quantity and rails become the columns of one array.
fn stacks(out: &mut Out, keys: &mut Keys, curves: &[&Table], one_rail: bool) {
    let alike = |a: &&Table, b: &&Table| {
        same_bits(a.curves.x(), b.curves.x()) && a.quantity == b.quantity && a.rails == b.rails
    };
    let groups: Vec<&[&Table]> = curves.chunk_by(alike).collect();
    if groups.is_empty() {
        return;
    }
    let name = |group: &[&Table]| {
        let first = group[0];
        let plain = preferred("curves", first.quantity, &first.rails, one_rail);
        keys.take(&format!("{plain}_phi"))
    };
    let names: Vec<String> = groups.iter().copied().map(name).collect();
    out.add("curves", &Array::words(&names));
    out.relations(
        "curves_",
        groups
            .iter()
            .map(|group| (group[0].quantity, &group[0].rails)),
    );
    for (key, group) in names.iter().zip(&groups) {
        let x = group[0].curves.x();
        out.add(&format!("{key}_x"), &Array::line(x));
        out.ids(&format!("{key}_ids"), group.iter().map(|table| table.id));
        let titles: Vec<String> = group.iter().map(|table| table.name.clone()).collect();
        out.add(&format!("{key}_names"), &Array::words(&titles));
        let value = |k: usize| group[k % group.len()].curves.y()[0][k / group.len()];
        let values = (0..x.len() * group.len()).map(value).collect();
        out.add(
            key,
            &Array {
                shape: vec![x.len(), group.len()],
                data: Data::Numbers(values),
            },
        );
    }
}

/// Adds the products of the factored form.
fn products(out: &mut Out, keys: &mut Keys, products: &[Product], one_rail: bool) {
    if products.is_empty() {
        return;
    }
    let names: Vec<String> = products
        .iter()
        .map(|product| {
            keys.take(&preferred(
                &product.name,
                product.quantity,
                &product.rails,
                one_rail,
            ))
        })
        .collect();
    out.add("products", &Array::words(&names));
    let titles: Vec<String> = products
        .iter()
        .map(|product| product.name.clone())
        .collect();
    out.add("products_names", &Array::words(&titles));
    out.relations(
        "products_",
        products
            .iter()
            .map(|product| (product.quantity, &product.rails)),
    );
    let expressions: Vec<String> = products.iter().map(Product::expression).collect();
    out.add("expressions", &Array::words(&expressions));
    for (key, product) in names.iter().zip(products) {
        let terms: Vec<f64> = product
            .terms
            .iter()
            .flatten()
            .map(|&id| f64::from(id))
            .collect();
        out.whole(&format!("{key}_terms"), vec![product.terms.len(), 2], terms);
    }
}
