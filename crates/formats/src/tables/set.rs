//! The tables of one structure, independent of the file format.

use adams::SplineValues;
use adams::view::ModifiedSpline;

use crate::grid::{GridBlock, StationGrid};
use crate::units::Units;

/// Number of the first SPLINE. In the paper the vertical table is SPLINE/6 and the lateral table SPLINE/7.
pub(super) const FIRST: u32 = 6;

/// Influence tables of one structure.
///
/// In the plain form each table is G(x, z) itself, the deflection at z per unit load at x. In the factored form each
/// table is one curve along a rail, and G is the sum of the products of curves listed in `products`.
///
/// ```
/// use formats::tables::{TableFormat, expand, factor, read, write};
/// use formats::units::{Force, Length, Units};
///
/// // deflections in ft/lbf: a row for each z, a column for each x
/// let csv = ",0,20,40,60\n0,4,3,2,1\n20,3,4,3,2\n40,2,3,4,3\n60,1,2,3,4\n";
/// let units = Units { length: Length::Foot, force: Force::Pound };
/// let set = read("north_vertical.csv", csv.as_bytes(), Some(units)).expect("one table");
/// assert_eq!((set.tables[0].id, set.tables[0].name.as_str()), (6, "north_vertical"));
/// assert_eq!(set.tables[0].curves.y()[0], [4.0, 3.0, 2.0, 1.0]);
///
/// // the SPLINE statements read back as the same tables, and so does the factored form but for rounding
/// let adm = write(&set, TableFormat::Adams).expect("tables of different numbers");
/// assert_eq!(read("north.adm", &adm, None).expect("our own file").tables[0].curves, set.tables[0].curves);
/// let factored = factor(&set, splines::Rank::Full).expect("a positive definite table").set;
/// assert_eq!(factored.tables.len(), 4);
/// assert!((expand(&factored).tables[0].curves.y()[0][1] - 3.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TableSet {
    /// Name of the structure.
    pub name: String,
    /// Units of all numbers. Stations are lengths and values are lengths per force; curves of the factored form have
    /// the square root of the unit of values.
    pub units: Units,
    /// The tables, in the order of the file.
    pub tables: Vec<Table>,
    /// The products whose sums are G; empty in the plain form.
    pub products: Vec<Product>,
    /// Tables that the file has but that were left out, because a later command modifies them.
    pub left_out: Vec<ModifiedSpline>,
}

/// One table: the content of a SPLINE statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Number of the SPLINE.
    pub id: u32,
    /// Its name.
    pub name: String,
    /// Quantity: the directions of deflection and load, if known.
    pub quantity: Option<GridBlock>,
    /// Rail of the deflection and rail of the load, if known.
    pub rails: Option<[String; 2]>,
    /// x: position of the load; z: position of the deflection; y: values, with a row for each z.
    pub curves: SplineValues,
}

impl TableSet {
    /// Message about the tables that were left out; `None` if there are none.
    #[must_use]
    pub fn left_out_message(&self) -> Option<String> {
        let named = |table: &ModifiedSpline| format!("{} (line {})", table.name, table.line);
        let list: Vec<String> = self.left_out.iter().map(named).collect();
        let message = "tables left out, because a later command `data_element modify spline` changes their values";
        (!list.is_empty()).then(|| format!("{message}: {}", list.join(", ")))
    }

    /// The tables of a grid.
    ///
    /// SPLINE/6 is the vertical table, 7 the lateral and 8 the longitudinal one; 9 to 11 are the couplings
    /// vertical-lateral, vertical-longitudinal and lateral-longitudinal. If there are several rails, the six tables
    /// of the first rail with itself come first, followed by those of each other pair of rails. A direct block of two
    /// different rails is written once, because the other one is its transpose. A rail with fewer than four stations,
    /// the minimum of a SPLINE, has no tables.
    #[must_use]
    pub fn of_grid(grid: &StationGrid) -> TableSet {
        let mut tables = Vec::new();
        let rails = &grid.rails;
        let mut pair = 0;
        let mut top = 0;
        for (r, row) in rails.iter().enumerate() {
            let mut left = 0;
            for (c, column) in rails.iter().enumerate() {
                for (index, quantity) in GridBlock::ALL.into_iter().enumerate() {
                    let direct = quantity.direct() == [quantity; 2];
                    // G_rc of a direct block is the transpose of G_cr
                    let Some(block) = grid.block(quantity).filter(|_| !direct || r <= c) else {
                        continue;
                    };
                    let (n, m) = (row.stations.len(), column.stations.len());
                    let values = block.view((top, left), (n, m));
                    let values = values
                        .row_iter()
                        .map(|line| line.iter().copied().collect())
                        .collect();
                    let Ok(curves) =
                        SplineValues::new(column.stations.clone(), row.stations.clone(), values)
                    else {
                        continue;
                    };
                    let name = if r == c {
                        format!("{}_{}_{quantity}", grid.name, row.name)
                    } else {
                        format!("{}_{}_from_{}_{quantity}", grid.name, row.name, column.name)
                    };
                    tables.push(Table {
                        id: FIRST
                            .saturating_add(u32::try_from(6 * pair + index).unwrap_or(u32::MAX)),
                        name: adams_name(&name),
                        quantity: Some(quantity),
                        rails: Some([row.name.clone(), column.name.clone()]),
                        curves,
                    });
                }
                pair += 1;
                left += column.stations.len();
            }
            top += row.stations.len();
        }
        TableSet {
            name: grid.name.clone(),
            units: grid.units,
            tables,
            products: Vec::new(),
            left_out: Vec::new(),
        }
    }

    /// The table with the number `id`.
    #[must_use]
    pub fn table(&self, id: u32) -> Option<&Table> {
        self.tables.iter().find(|table| table.id == id)
    }
}

/// G(x, z) as a sum of products of curves, G(x, z) = sum over k of a_k(x) b_k(z), with the load at x and the
/// deflection at z.
///
/// Each curve is interpolated by the natural cubic spline, as in CUBSPL of ADAMS.
#[derive(Clone, Debug, PartialEq)]
pub struct Product {
    /// Name of the table in the plain form.
    pub name: String,
    /// Quantity: the directions of deflection and load, if known.
    pub quantity: Option<GridBlock>,
    /// Rail of the deflection and rail of the load, if known.
    pub rails: Option<[String; 2]>,
    /// The numbers of the two curves of each term: the curve over x and the curve over z.
    pub terms: Vec<[u32; 2]>,
}

impl Product {
    /// The ADAMS expression, for a comment: `name(x,z) = CUBSPL(x,0,101)*CUBSPL(z,0,101) + ...`.
    #[must_use]
    pub fn expression(&self) -> String {
        let term = |[x, z]: &[u32; 2]| format!("CUBSPL(x,0,{x})*CUBSPL(z,0,{z})");
        let sum: Vec<String> = self.terms.iter().map(term).collect();
        let sum = if sum.is_empty() {
            "0".to_owned()
        } else {
            sum.join(" + ")
        };
        format!("{}(x,z) = {sum}", adams_name(&self.name))
    }
}

/// Selects the tables whose deflection and load are both in the given directions (direct blocks): the direct tables
/// and the couplings between them. In the factored form these are the products and the curves of their terms.
#[must_use]
pub fn select(set: &TableSet, directions: &[GridBlock]) -> TableSet {
    let wanted = |quantity: Option<GridBlock>| {
        quantity.is_some_and(|quantity| {
            quantity
                .direct()
                .iter()
                .all(|direct| directions.contains(direct))
        })
    };
    let mut out = set.clone();
    out.products.retain(|product| wanted(product.quantity));
    let terms: Vec<u32> = out
        .products
        .iter()
        .flat_map(|product| product.terms.iter().flatten().copied())
        .collect();
    out.tables.retain(|table| {
        let is_curve = table.curves.z().is_empty() && !set.products.is_empty();
        if is_curve {
            terms.contains(&table.id)
        } else {
            wanted(table.quantity)
        }
    });
    out
}

/// A name that is valid in data sets and in Adams View: ASCII letters, digits and underscores, at most 56 characters.
pub(super) fn adams_name(name: &str) -> String {
    let name: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
        .take(56)
        .collect();
    if name.is_empty() {
        "_".to_owned()
    } else {
        name
    }
}
