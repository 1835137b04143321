//! The factored form of influence tables: G as a sum of products of curves along the rails.
//!
//! All tables of coupled directions are the blocks of one symmetric matrix over the stations of these directions. Let
//! lambda_k be its eigenvalues and v_k its eigenvectors. The curves are phi_k = sqrt(lambda_k) v_k, and G(x, z) = sum
//! over k of phi_k(x) phi_k(z). The smallest eigenvalues may be dropped. [`factor`] computes the decomposition, and
//! [`expand`] evaluates the sums at the stations.

use adams::SplineValues;
use nalgebra::DMatrix;
use serde_json::{Value, json};
use splines::{
    Axis, Compliance, ExactSurface, FactoredTable, Influence, InfluenceBlock, Probe, Rank,
    SplineTable as Values, TableFactor,
};

use super::parsed::Draft;
use super::set::{Product, Table, TableSet};
use crate::grid::{GridBlock, GridRail, axes};

/// Index of a rail, and the axis of a displacement or load on it.
type Direction = (usize, Axis);

/// Tables in the factored form, and their deviation from the original tables.
#[derive(Clone, Debug)]
pub struct FactoredTables {
    /// The factored form.
    pub set: TableSet,
    /// For each set of coupled directions, the number of retained products and the number of eigenvalues above
    /// rounding.
    pub ranks: Vec<[usize; 2]>,
    /// Largest deviation from the original tables at their stations.
    pub stations: TableDeviation,
    /// Numbers of the omitted tables: those of a rail with fewer stations than a curve requires, and couplings that
    /// are zero.
    pub skipped: Vec<u32>,
    form: FactoredTable,
    /// The directions of deflection and load of each product.
    directions: Vec<[Direction; 2]>,
    /// Names of the rails.
    rails: Vec<String>,
}

/// The rails of the tables, and the directions of deflection and load of each table.
struct Directions {
    rails: Vec<String>,
    of_tables: Vec<[Direction; 2]>,
}

/// Decomposes the tables into products of curves along the rails, which CUBSPL can interpolate. `rank` determines the
/// number of retained products.
///
/// # Errors
/// No table with four stations in both directions; a table whose rails or directions are unknown; tables that are all
/// zero; tables without a factored form, such as those of a matrix with negative eigenvalues.
pub fn factor(set: &TableSet, rank: Rank) -> Result<FactoredTables, FactorError> {
    let (tables, skipped): (Vec<&Table>, Vec<&Table>) = set.tables.iter().partition(|table| {
        let relates = |quantity: GridBlock| quantity.direct() != [quantity; 2];
        let coupling = table.quantity.is_some_and(relates) || table.curves.x() != table.curves.z();
        let zero = table.curves.y().iter().flatten().all(|value| *value == 0.0);
        table.curves.z().len() >= SplineValues::MIN_POINTS && !(coupling && zero)
    });
    let directions = directions(&tables)?;
    let mut sheets = Vec::new();
    for (table, [deflection, load]) in tables.iter().zip(&directions.of_tables) {
        let (x, z) = (table.curves.x().to_vec(), table.curves.z().to_vec());
        let values = DMatrix::from_row_iterator(z.len(), x.len(), table.curves.y().concat());
        let values = Values::new(x, z, values)?;
        sheets.push(InfluenceBlock {
            deflection: *deflection,
            load: *load,
            table: values,
        });
    }
    let form = FactoredTable::new(&sheets, rank)?;
    let curves = curves_of(&tables, &directions.of_tables, &form)?;
    let ids = |direction: &Direction| {
        curves
            .iter()
            .find(|(known, _)| known == direction)
            .map(|(_, tables)| tables)
    };
    let mut products = Vec::new();
    for (table, [deflection, load]) in tables.iter().zip(&directions.of_tables) {
        let Some((x, z)) = ids(load).zip(ids(deflection)) else {
            continue;
        };
        products.push(Product {
            name: table.name.clone(),
            quantity: table.quantity,
            rails: table.rails.clone(),
            terms: x.iter().zip(z).map(|(x, z)| [x.id, z.id]).collect(),
        });
    }
    let new = TableSet {
        tables: curves.into_iter().flat_map(|(_, tables)| tables).collect(),
        products,
        ..set.clone()
    };
    let ranks = form
        .factors()
        .iter()
        .map(|factor| [factor.rank(), factor.rank() + significant(factor)])
        .collect();
    let stations = deviation(&tables, &new);
    let skipped = skipped.iter().map(|table| table.id).collect();
    Ok(FactoredTables {
        set: new,
        ranks,
        stations,
        skipped,
        form,
        directions: directions.of_tables,
        rails: directions.rails,
    })
}

/// Number of dropped eigenvalues that exceed the rounding error of the largest one.
fn significant(factor: &TableFactor) -> usize {
    let largest = factor.kept.first().copied().unwrap_or(0.0);
    factor
        .dropped
        .iter()
        .filter(|value| value.abs() > 1e-15 * factor.dropped.len() as f64 * largest)
        .count()
}

/// Why tables have no factored form.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FactorError {
    /// No table with four stations along x and along z.
    #[error("no table has four stations in both directions")]
    Empty,
    /// A table whose rails or directions are unknown.
    #[error(
        "SPLINE/{id} does not state which directions and rails it relates, and its x differ from its z"
    )]
    Unknown {
        /// The table.
        id: u32,
    },
    /// All tables are zero.
    #[error("every product is zero")]
    Zero,
    /// The decomposition fails.
    #[error("{0}")]
    Splines(#[from] splines::Error),
}

/// Determines the directions of the tables. A table without rails belongs to a single unnamed rail unless another
/// such table has the same quantity. A table without quantity is assigned a rail of its own if its x and z are equal.
fn directions(tables: &[&Table]) -> Result<Directions, FactorError> {
    let mut rails: Vec<String> = Vec::new();
    let mut number = |name: String| {
        rails
            .iter()
            .position(|known| *known == name)
            .unwrap_or_else(|| {
                rails.push(name);
                rails.len() - 1
            })
    };
    if tables.is_empty() {
        return Err(FactorError::Empty);
    }
    let mut of_tables = Vec::new();
    for table in tables {
        let alike = |other: &&&Table| other.rails.is_none() && other.quantity == table.quantity;
        let unique = tables.iter().filter(alike).count() == 1;
        let square = table.curves.x() == table.curves.z();
        of_tables.push(match (table.quantity, &table.rails) {
            (Some(quantity), Some([rail, load])) => {
                let (deflection_axis, load_axis) = axes(quantity);
                [
                    (number(rail.clone()), deflection_axis),
                    (number(load.clone()), load_axis),
                ]
            }
            (Some(quantity), None) if unique => {
                let rail = number(String::new());
                [(rail, axes(quantity).0), (rail, axes(quantity).1)]
            }
            (quantity, _)
                if square && quantity.is_none_or(|quantity| quantity.direct() == [quantity; 2]) =>
            {
                let axis = quantity.map_or(Axis::Vertical, |quantity| axes(quantity).0);
                // no rail has such a name
                [(number(format!("\0{}", table.id)), axis); 2]
            }
            _ => return Err(FactorError::Unknown { id: table.id }),
        });
    }
    Ok(Directions { rails, of_tables })
}

/// The curves of all directions as tables. The numbers of consecutive directions differ by 100, or by more if a
/// direction has more curves.
fn curves_of(
    tables: &[&Table],
    directions: &[[Direction; 2]],
    form: &FactoredTable,
) -> Result<Vec<(Direction, Vec<Table>)>, FactorError> {
    let most = form
        .factors()
        .iter()
        .map(TableFactor::rank)
        .max()
        .unwrap_or(0);
    if most == 0 {
        return Err(FactorError::Zero);
    }
    let step = if most < 100 {
        100
    } else {
        10_usize.pow(most.ilog10() + 1)
    };
    let mut out: Vec<(Direction, Vec<Table>)> = Vec::new();
    for (curves, rank) in form
        .factors()
        .iter()
        .flat_map(|one| one.curves.iter().map(move |c| (c, one.rank())))
    {
        let own = tables
            .iter()
            .zip(directions)
            .find(|(_, both)| **both == [curves.direction; 2]);
        let Some((table, _)) = own else { continue };
        let direct = table
            .quantity
            .map(|quantity: GridBlock| quantity.direct()[0]);
        let mut own = Vec::new();
        for k in 0..rank {
            let values = curves.values.column(k).iter().copied().collect();
            let curve = SplineValues::new(curves.stations.clone(), Vec::new(), vec![values]);
            own.push(Table {
                id: u32::try_from(step * (out.len() + 1) + k + 1).unwrap_or(u32::MAX),
                name: format!("{}_{}", table.name, k + 1),
                quantity: direct,
                rails: table.rails.clone(),
                curves: curve.map_err(|_| FactorError::Zero)?,
            });
        }
        out.push((curves.direction, own));
    }
    Ok(out)
}

/// Deviation of the factored form from `tables` at their stations.
fn deviation(tables: &[&Table], factored: &TableSet) -> TableDeviation {
    let plain = expand(factored);
    let mut out = TableDeviation::default();
    for table in tables {
        let Some(back) = plain.tables.iter().find(|back| back.name == table.name) else {
            continue;
        };
        let (given, back) = (table.curves.y(), back.curves.y());
        let largest = given
            .iter()
            .flatten()
            .fold(0.0_f64, |largest, value| largest.max(value.abs()));
        if largest == 0.0 {
            continue;
        }
        for ((z, given), back) in table.curves.z().iter().zip(given).zip(back) {
            for ((x, given), back) in table.curves.x().iter().zip(given).zip(back) {
                out.take(&table.name, *x, *z, (given - back).abs() / largest);
            }
        }
    }
    out
}

impl FactoredTables {
    /// Deviation from the exact compliance at the stations and at three points in each interval between them. `None`
    /// if a rail of the tables is missing in `rails`, the rails of the compliance.
    #[must_use]
    pub fn deviation_from(
        &self,
        surface: &ExactSurface,
        rails: &[GridRail],
    ) -> Option<TableDeviation> {
        let mut out = TableDeviation::default();
        for (product, [deflection, load]) in self.set.products.iter().zip(&self.directions) {
            let find = |id: Option<u32>| id.and_then(|id| self.set.table(id));
            let x = places(find(product.terms.first().map(|term| term[0]))?.curves.x());
            let z = places(find(product.terms.first().map(|term| term[1]))?.curves.x());
            let own = |direction: &Direction, x: f64| Probe {
                rail: direction.0,
                x,
                axis: direction.1,
            };
            let exact_rail = |direction: &Direction| {
                let name = self.rails.get(direction.0)?;
                rails.iter().position(|rail| rail.name == *name)
            };
            let exact = |direction: &Direction, x: f64| {
                Some(Probe {
                    rail: exact_rail(direction)?,
                    ..own(direction, x)
                })
            };
            let own_probes: Vec<Probe> = z
                .iter()
                .map(|z| own(deflection, *z))
                .chain(x.iter().map(|x| own(load, *x)))
                .collect();
            let exact_probes = z
                .iter()
                .map(|z| exact(deflection, *z))
                .chain(x.iter().map(|x| exact(load, *x)));
            let exact_probes: Vec<Probe> = exact_probes.collect::<Option<_>>()?;
            let [approximate, exact] = [
                filled(&self.form, &own_probes)?,
                filled(surface, &exact_probes)?,
            ];
            let block =
                |matrix: &DMatrix<f64>| matrix.view((0, z.len()), (z.len(), x.len())).into_owned();
            let (approximate, exact) = (block(&approximate), block(&exact));
            let largest = exact.amax();
            if largest == 0.0 {
                continue;
            }
            for (j, x) in x.iter().enumerate() {
                for (i, z) in z.iter().enumerate() {
                    out.take(
                        &product.name,
                        *x,
                        *z,
                        (approximate[(i, j)] - exact[(i, j)]).abs() / largest,
                    );
                }
            }
        }
        Some(out)
    }
}

/// The matrix of compliances between the positions; `None` if one of them is not on its rail.
fn filled(form: &dyn Compliance, at: &[Probe]) -> Option<DMatrix<f64>> {
    let mut out = Influence::zeros(at.len());
    form.fill(at, &mut out).ok()?;
    Some(out.value)
}

/// The stations, and three points in each interval between them.
fn places(stations: &[f64]) -> Vec<f64> {
    let between = |pair: &[f64]| {
        let (a, b) = (pair[0], pair[1]);
        [0.0, 0.25, 0.5, 0.75].map(|s| a + s * (b - a))
    };
    stations
        .windows(2)
        .flat_map(between)
        .chain(stations.last().copied())
        .collect()
}

/// Converts tables to the plain form by evaluating the sums of products at the stations of the curves.
///
/// The natural spline is linear in its values. These tables, interpolated by natural splines, therefore equal the
/// factored form everywhere except for rounding. Tables of one curve that belong to no product are unchanged, and so
/// is a set in the plain form.
#[must_use]
pub fn expand(set: &TableSet) -> TableSet {
    if set.products.is_empty() {
        return set.clone();
    }
    let unused = |table: &&Table| {
        !set.products
            .iter()
            .any(|p| p.terms.iter().flatten().any(|&id| id == table.id))
    };
    let mut drafts = Vec::new();
    for product in &set.products {
        let terms: Option<Vec<[&Table; 2]>> = product
            .terms
            .iter()
            .map(|[x, z]| Some([set.table(*x)?, set.table(*z)?]))
            .collect();
        let Some(terms) = terms else { continue };
        let Some([first_x, first_z]) = terms.first() else {
            continue;
        };
        let (x, z) = (first_x.curves.x(), first_z.curves.x());
        let on_same_stations = |[a, b]: &[&Table; 2]| a.curves.x() == x && b.curves.x() == z;
        if !terms.iter().all(on_same_stations) {
            continue;
        }
        let value = |i: usize, j: usize| {
            let term = |[a, b]: &[&Table; 2]| a.curves.y()[0][j] * b.curves.y()[0][i];
            terms.iter().map(term).sum::<f64>()
        };
        let values = (0..z.len())
            .map(|i| (0..x.len()).map(|j| value(i, j)).collect())
            .collect();
        let Ok(curves) = SplineValues::new(x.to_vec(), z.to_vec(), values) else {
            continue;
        };
        drafts.push(Draft {
            name: Some(product.name.clone()),
            quantity: product.quantity,
            rails: product.rails.clone(),
            ..Draft::of(curves)
        });
    }
    for table in set.tables.iter().filter(unused) {
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

/// The largest difference between two forms of tables, relative to the largest value of the same table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableDeviation {
    /// |difference| / largest |value|.
    pub largest: f64,
    /// Name of the table, and x and z of the largest difference.
    pub at: Option<(String, f64, f64)>,
}

impl TableDeviation {
    /// Updates the largest relative difference.
    fn take(&mut self, name: &str, x: f64, z: f64, error: f64) {
        if error > self.largest || self.at.is_none() {
            (self.largest, self.at) = (error, Some((name.to_owned(), x, z)));
        }
    }

    /// One line for the terminal.
    #[must_use]
    pub fn message(&self) -> String {
        let place = self
            .at
            .as_ref()
            .map(|(name, x, z)| format!(" ({name} at x = {x}, z = {z})"));
        format!(
            "{:.2e} of the largest value{}",
            self.largest,
            place.unwrap_or_default()
        )
    }

    /// The same as JSON.
    #[must_use]
    pub fn json(&self) -> Value {
        let at = self
            .at
            .as_ref()
            .map(|(name, x, z)| json!({ "table": name, "x": x, "z": z }));
        json!({ "largest": self.largest, "at": at })
    }
}
