//! The content of a file of tables, and default names, numbers and quantities for missing ones.

use adams::SplineValues;
use adams::view::ModifiedSpline;

use super::set::{FIRST, Product, Table, TableSet};
use crate::grid::GridBlock;
use crate::units::Units;

/// The content of a file, of any format.
pub(super) struct Parsed {
    /// Name of the structure.
    pub name: String,
    /// Units, if the file specifies them.
    pub units: Option<Units>,
    /// Message and hint for a file without units.
    pub missing_units: [&'static str; 2],
    pub drafts: Vec<Draft>,
    /// The comments of the file.
    pub comments: String,
    /// The products, in formats that do not store them in comments.
    pub products: Vec<Product>,
    /// Tables that were left out, because a later command modifies them.
    pub left_out: Vec<ModifiedSpline>,
}

impl Parsed {
    /// Converts the content to tables whose numbers are in `units`.
    pub fn set(self, units: Units) -> TableSet {
        let mut set = TableSet::assemble(self.name, units, self.drafts, &self.comments);
        set.products.extend(self.products);
        set.left_out = self.left_out;
        set
    }
}

/// A table as read from a file. Some of its properties may be missing.
pub(super) struct Draft {
    pub id: Option<u32>,
    pub name: Option<String>,
    pub quantity: Option<GridBlock>,
    pub rails: Option<[String; 2]>,
    /// Whether ADAMS extrapolates it linearly beyond its ends, if the file specifies this.
    pub linear_extrapolate: Option<bool>,
    pub curves: SplineValues,
}

impl Draft {
    /// A table without any other properties.
    pub fn of(curves: SplineValues) -> Draft {
        Draft {
            id: None,
            name: None,
            quantity: None,
            rails: None,
            linear_extrapolate: None,
            curves,
        }
    }
}

/// Chooses a number for a table that has none and adds it to `used`. It is the number of its quantity
/// (SPLINE/6 to 11) if that is unused, and otherwise one above all used numbers and above 11.
fn free(used: &mut Vec<u32>, quantity: Option<GridBlock>) -> u32 {
    let own =
        quantity.and_then(|quantity| GridBlock::ALL.into_iter().position(|one| one == quantity));
    let own = own
        .and_then(|index| u32::try_from(index).ok())
        .map(|index| FIRST + index);
    let beyond = FIRST + 6;
    let next = used
        .iter()
        .max()
        .map_or(beyond, |last| last.saturating_add(1).max(beyond));
    let id = own.filter(|id| !used.contains(id)).unwrap_or(next);
    used.push(id);
    id
}

impl TableSet {
    /// The tables of a file, with default numbers, names and quantities for missing ones, and with the products that
    /// its comments state.
    pub(super) fn assemble(
        name: String,
        units: Units,
        drafts: Vec<Draft>,
        comments: &str,
    ) -> TableSet {
        let mut used: Vec<u32> = drafts.iter().filter_map(|draft| draft.id).collect();
        let mut tables = Vec::new();
        for (k, draft) in drafts.into_iter().enumerate() {
            let title = draft.name.unwrap_or_else(|| {
                if k == 0 {
                    name.clone()
                } else {
                    format!("table {}", k + 1)
                }
            });
            let quantity = draft.quantity.or_else(|| {
                if draft.curves.z().is_empty() {
                    None
                } else {
                    quantity(&title)
                }
            });
            let id = draft.id.unwrap_or_else(|| free(&mut used, quantity));
            tables.push(Table {
                id,
                name: title,
                quantity,
                rails: draft.rails,
                curves: draft.curves,
            });
        }
        let known = |id: u32| {
            tables
                .iter()
                .any(|table: &Table| table.id == id && table.curves.z().is_empty())
        };
        let mut products = Product::read(comments);
        products.retain(|product| product.terms.iter().flatten().all(|&id| known(id)));
        TableSet {
            name,
            units,
            tables,
            products,
            left_out: Vec::new(),
        }
    }
}

/// The quantity stated at the end of a name, such as `north_vertical`.
fn quantity(name: &str) -> Option<GridBlock> {
    let ends = |quantity: &&GridBlock| {
        let before = name.strip_suffix(quantity.name());
        before.is_some_and(|before| !before.ends_with(|c: char| c.is_alphanumeric()))
    };
    GridBlock::ALL
        .iter()
        .filter(ends)
        .max_by_key(|quantity| quantity.name().len())
        .copied()
}

impl Product {
    /// Reads the products that comments state in the form of [`Product::expression`]. Lines may be broken at blanks.
    fn read(comments: &str) -> Vec<Product> {
        let words: Vec<&str> = comments.split_whitespace().collect();
        let mut out = Vec::new();
        for (k, pair) in words.windows(2).enumerate() {
            let Some(name) = pair[0]
                .strip_suffix("(x,z)")
                .filter(|name| !name.is_empty() && pair[1] == "=")
            else {
                continue;
            };
            let sum = words.get(k + 2..).unwrap_or(&[]);
            let Some(terms) = sum_of(sum) else { continue };
            out.push(Product {
                name: name.to_owned(),
                quantity: quantity(name),
                rails: None,
                terms,
            });
        }
        out
    }
}

/// The terms of `term + term + term`, up to the end of the sum; `None` if there is no term.
fn sum_of(words: &[&str]) -> Option<Vec<[u32; 2]>> {
    if words.first() == Some(&"0") {
        return Some(Vec::new());
    }
    let mut terms = Vec::new();
    for pair in words.chunks(2) {
        terms.push(term(pair[0])?);
        if pair.get(1) != Some(&"+") {
            break;
        }
    }
    (!terms.is_empty()).then_some(terms)
}

/// The term `CUBSPL(x,0,A)*CUBSPL(z,0,B)` as [A, B].
fn term(word: &str) -> Option<[u32; 2]> {
    let (x, z) = word
        .strip_prefix("CUBSPL(x,0,")?
        .split_once(")*CUBSPL(z,0,")?;
    Some([x.parse().ok()?, z.strip_suffix(')')?.parse().ok()?])
}
