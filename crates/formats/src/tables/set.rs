//! Tables in no particular format.

use adams::{Spline, SplineValues, Tables};

use super::product::Product;
use crate::block::GridBlock;
use crate::grid::Grid;
use crate::units::{Dimension, Units};

/// Number of the first SPLINE: the paper's vertical table is SPLINE/6, its lateral one SPLINE/7.
pub(super) const FIRST: u32 = 6;

/// Tables of one structure.
///
/// In the plain form each table is G itself over load and deflection. In the factored form each is one curve
/// along a rail, and `products` say how G is made of them.
#[derive(Clone, Debug, PartialEq)]
pub struct TableSet {
    /// Name of the structure.
    pub name: String,
    /// Units of all numbers: stations in length, values in length per force, curves in its square root.
    pub units: Units,
    /// In the order of the file.
    pub tables: Vec<Table>,
    /// How G is made of one-curve tables; empty in the plain form.
    pub products: Vec<Product>,
}

/// One table: what a SPLINE holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Number of the SPLINE.
    pub id: u32,
    /// Its name.
    pub name: String,
    /// Which deflection it relates to which load, where that is known.
    pub quantity: Option<GridBlock>,
    /// Rail of the deflection and rail of the load, where they are known.
    pub rails: Option<[String; 2]>,
    /// x: where the load stands; z: where the deflection is taken; y: values, a row for each z.
    pub curves: SplineValues,
}

impl TableSet {
    /// The tables of a grid.
    ///
    /// SPLINE/6 holds the vertical grid, 7 the lateral, 8 the longitudinal one, 9 to 11 the couplings
    /// vertical-lateral, vertical-longitudinal, lateral-longitudinal. Of several rails, the six of the first with
    /// itself come first, then those of each other pair; a direct grid of two rails stands once. Rails of fewer
    /// than four stations, the least that a SPLINE may have, take no loads.
    #[must_use]
    pub fn of_grid(grid: &Grid) -> TableSet {
        let mut tables = Vec::new();
        let rails = &grid.rails;
        let mut pair = 0;
        let mut top = 0;
        for (r, row) in rails.iter().enumerate() {
            let mut left = 0;
            for (c, column) in rails.iter().enumerate() {
                for (index, quantity) in GridBlock::ALL.into_iter().enumerate() {
                    let direct = quantity.direct() == [quantity; 2];
                    let Some(block) = grid.block(quantity).filter(|_| !direct || r <= c) else { continue };
                    let (n, m) = (row.stations.len(), column.stations.len());
                    let values = block.view((top, left), (n, m));
                    let values = values.row_iter().map(|line| line.iter().copied().collect()).collect();
                    let Ok(curves) = SplineValues::new(column.stations.clone(), row.stations.clone(), values)
                    else {
                        continue;
                    };
                    let name = if r == c {
                        format!("{}_{}_{quantity}", grid.name, row.name)
                    } else {
                        format!("{}_{}_from_{}_{quantity}", grid.name, row.name, column.name)
                    };
                    tables.push(Table {
                        id: FIRST.saturating_add(u32::try_from(6 * pair + index).unwrap_or(u32::MAX)),
                        name: plain(&name),
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
        TableSet { name: grid.name.clone(), units: grid.units, tables, products: Vec::new() }
    }

    /// The table with this number.
    #[must_use]
    pub fn find(&self, id: u32) -> Option<&Table> {
        self.tables.iter().find(|table| table.id == id)
    }

    /// As SPLINE statements: every one extrapolates linearly.
    pub(super) fn adams(&self) -> Tables {
        let unit = self.units.label(Dimension::FLEXIBILITY);
        let spline = |table: &Table| Spline {
            id: table.id,
            name: Some(plain(&table.name)),
            units: Some("no_units".to_owned()),
            linear_extrapolate: true,
            curves: table.curves.clone(),
        };
        Tables {
            title: Some(format!("{}{TITLE}{unit}", self.name)),
            units: Some(self.units.to_adams()),
            splines: self.tables.iter().map(spline).collect(),
        }
    }

    /// Of SPLINE statements.
    pub(super) fn drafts(splines: Vec<Spline>) -> Vec<Draft> {
        let draft = |spline: Spline| Draft {
            id: Some(spline.id),
            name: Some(spline.name.unwrap_or_else(|| format!("SPLINE_{}", spline.id))),
            linear: Some(spline.linear_extrapolate),
            ..Draft::of(spline.curves)
        };
        splines.into_iter().map(draft).collect()
    }

    /// Tables as a file has them, with numbers, names and quantities where it has none, and the products that
    /// its remarks tell of.
    pub(super) fn assemble(name: String, units: Units, drafts: Vec<Draft>, remarks: &str) -> TableSet {
        let mut used: Vec<u32> = drafts.iter().filter_map(|draft| draft.id).collect();
        let mut tables = Vec::new();
        for (k, draft) in drafts.into_iter().enumerate() {
            let title =
                draft.name.unwrap_or_else(|| if k == 0 { name.clone() } else { format!("table {}", k + 1) });
            let quantity =
                draft.quantity.or_else(|| if draft.curves.z().is_empty() { None } else { quantity(&title) });
            let id = draft.id.unwrap_or_else(|| free(&mut used, quantity));
            tables.push(Table { id, name: title, quantity, rails: draft.rails, curves: draft.curves });
        }
        let known =
            |id: u32| tables.iter().any(|table: &Table| table.id == id && table.curves.z().is_empty());
        let mut products = Product::read(remarks);
        products.retain(|product| product.terms.iter().flatten().all(|&id| known(id)));
        TableSet { name, units, tables, products }
    }
}

/// A table of a file that need not say all about it.
pub(super) struct Draft {
    pub id: Option<u32>,
    pub name: Option<String>,
    pub quantity: Option<GridBlock>,
    pub rails: Option<[String; 2]>,
    /// Whether it goes on with a line beyond its ends.
    pub linear: Option<bool>,
    pub curves: SplineValues,
}

impl Draft {
    /// Of which nothing else is known.
    pub fn of(curves: SplineValues) -> Draft {
        Draft { id: None, name: None, quantity: None, rails: None, linear: None, curves }
    }
}

/// A number for a table that has none: its quantity's own, or the next after all of these.
pub(super) fn free(used: &mut Vec<u32>, quantity: Option<GridBlock>) -> u32 {
    let own = quantity.and_then(|quantity| GridBlock::ALL.into_iter().position(|one| one == quantity));
    let own = own.and_then(|index| u32::try_from(index).ok()).map(|index| FIRST + index);
    let beyond = FIRST + 6;
    let next = used.iter().max().map_or(beyond, |last| last.saturating_add(1).max(beyond));
    let id = own.filter(|id| !used.contains(id)).unwrap_or(next);
    used.push(id);
    id
}

/// What the end of a name says, such as `north_vertical`.
pub(super) fn quantity(name: &str) -> Option<GridBlock> {
    let ends = |quantity: &&GridBlock| {
        let before = name.strip_suffix(quantity.name());
        before.is_some_and(|before| !before.ends_with(|c: char| c.is_alphanumeric()))
    };
    GridBlock::ALL.iter().filter(ends).max_by_key(|quantity| quantity.name().len()).copied()
}

const TITLE: &str = ": influence coefficients, ";

/// The structure's name in the title of a data set.
pub(super) fn name_of_title(title: &str) -> &str {
    let own = title.split_once(TITLE).map(|(name, _)| name);
    own.or_else(|| title.strip_prefix("Adams View model name: ")).unwrap_or(title).trim()
}

/// A name that a data set and Adams View can hold.
pub(super) fn plain(name: &str) -> String {
    let plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).take(56).collect();
    if plain.is_empty() { "_".to_owned() } else { plain }
}
