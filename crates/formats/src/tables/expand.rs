//! The factored form back to the plain one.

use adams::SplineValues;

use super::set::{Draft, Table, TableSet};

/// The plain form: at the stations of the curves, G = sum of products.
///
/// Read by natural splines, these tables are the factored form at every place, but for rounding. Tables of
/// one curve that no product names stay as they are; a set in the plain form stays as it is.
#[must_use]
pub fn expand(set: &TableSet) -> TableSet {
    if set.products.is_empty() {
        return set.clone();
    }
    let named =
        |table: &&Table| !set.products.iter().any(|p| p.terms.iter().flatten().any(|&id| id == table.id));
    let mut drafts = Vec::new();
    for product in &set.products {
        let terms: Option<Vec<[&Table; 2]>> =
            product.terms.iter().map(|[x, z]| Some([set.find(*x)?, set.find(*z)?])).collect();
        let Some(terms) = terms else { continue };
        let Some([first_x, first_z]) = terms.first() else { continue };
        let (x, z) = (first_x.curves.x(), first_z.curves.x());
        let fits = |[a, b]: &[&Table; 2]| a.curves.x() == x && b.curves.x() == z;
        if !terms.iter().all(fits) {
            continue;
        }
        let value = |i: usize, j: usize| {
            let one = |[a, b]: &[&Table; 2]| a.curves.y()[0][j] * b.curves.y()[0][i];
            terms.iter().map(one).sum::<f64>()
        };
        let values = (0..z.len()).map(|i| (0..x.len()).map(|j| value(i, j)).collect()).collect();
        let Ok(curves) = SplineValues::new(x.to_vec(), z.to_vec(), values) else { continue };
        drafts.push(Draft {
            name: Some(product.name.clone()),
            quantity: product.quantity,
            rails: product.rails.clone(),
            ..Draft::of(curves)
        });
    }
    for table in set.tables.iter().filter(named) {
        drafts.push(Draft {
            id: Some(table.id),
            name: Some(table.name.clone()),
            quantity: table.quantity,
            rails: table.rails.clone(),
            ..Draft::of(table.curves.clone())
        });
    }
    TableSet::assemble(set.name.clone(), set.units, drafts, "")
}
