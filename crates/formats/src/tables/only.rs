//! Tables of some directions.

use super::set::TableSet;
use crate::block::GridBlock;

/// The tables whose deflections and loads are of these directions: direct tables and the couplings between them.
/// In the factored form the products, and the curves that they need.
#[must_use]
pub fn only(set: &TableSet, directions: &[GridBlock]) -> TableSet {
    let wanted = |quantity: Option<GridBlock>| {
        quantity.is_some_and(|quantity| quantity.direct().iter().all(|direct| directions.contains(direct)))
    };
    let mut out = set.clone();
    out.products.retain(|product| wanted(product.quantity));
    let terms: Vec<u32> =
        out.products.iter().flat_map(|product| product.terms.iter().flatten().copied()).collect();
    out.tables.retain(|table| {
        let curve = table.curves.z().is_empty() && !set.products.is_empty();
        if curve { terms.contains(&table.id) } else { wanted(table.quantity) }
    });
    out
}
