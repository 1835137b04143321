//! The plain form to the factored one.

use adams::SplineValues;
use nalgebra::DMatrix;
use splines::{Axis, Compliance, Factor, Factored, Influence, Probe, Rank, Sheet, Surface, Table as Values};

use super::deviation::Deviation;
use super::expand::expand;
use super::product::Product;
use super::set::{Table, TableSet};
use crate::block::GridBlock;
use crate::grid::{GridRail, axes};

/// A rail and an axis, by the rail's number.
type Way = (usize, Axis);

/// Tables in the factored form, and how far they are from those given.
#[derive(Clone, Debug)]
pub struct Factoring {
    /// The factored form.
    pub set: TableSet,
    /// Products kept and eigenvalues above rounding, of each set of directions that couple.
    pub ranks: Vec<[usize; 2]>,
    /// At the stations, against the tables.
    pub stations: Deviation,
    /// Tables left out: of a rail with fewer stations than a curve needs, or zero couplings.
    pub skipped: Vec<u32>,
    form: Factored,
    /// Number of the product's table in the plain form, deflection and load.
    ways: Vec<[Way; 2]>,
    rails: Vec<String>,
}

/// Directions of tables: deflection and load.
struct Ways {
    rails: Vec<String>,
    of: Vec<[Way; 2]>,
}

/// Decomposes the tables: G = sum of products of curves along the rails, each read by CUBSPL.
///
/// # Errors
/// Why the tables have no factored form.
pub fn factor(set: &TableSet, rank: Rank) -> Result<Factoring, Unfactored> {
    let (tables, skipped): (Vec<&Table>, Vec<&Table>) = set.tables.iter().partition(|table| {
        let relates = |quantity: GridBlock| quantity.direct() != [quantity; 2];
        let coupling = table.quantity.is_some_and(relates) || table.curves.x() != table.curves.z();
        let zero = table.curves.y().iter().flatten().all(|value| *value == 0.0);
        table.curves.z().len() >= SplineValues::MIN_POINTS && !(coupling && zero)
    });
    let ways = ways(&tables)?;
    let mut sheets = Vec::new();
    for (table, [deflection, load]) in tables.iter().zip(&ways.of) {
        let (x, z) = (table.curves.x().to_vec(), table.curves.z().to_vec());
        let values = DMatrix::from_row_iterator(z.len(), x.len(), table.curves.y().concat());
        let values = Values::new(x, z, values)?;
        sheets.push(Sheet { deflection: *deflection, load: *load, table: values });
    }
    let form = Factored::new(&sheets, rank)?;
    let curves = curves_of(&tables, &ways.of, &form)?;
    let ids = |way: &Way| curves.iter().find(|(known, _)| known == way).map(|(_, tables)| tables);
    let mut products = Vec::new();
    for (table, [deflection, load]) in tables.iter().zip(&ways.of) {
        let Some((x, z)) = ids(load).zip(ids(deflection)) else { continue };
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
    let ranks = form.factors().iter().map(|factor| [factor.rank(), factor.rank() + above(factor)]).collect();
    let stations = deviation(&tables, &new);
    let skipped = skipped.iter().map(|table| table.id).collect();
    Ok(Factoring { set: new, ranks, stations, skipped, form, ways: ways.of, rails: ways.rails })
}

/// Dropped eigenvalues that are more than rounding of the largest.
fn above(factor: &Factor) -> usize {
    let largest = factor.kept.first().copied().unwrap_or(0.0);
    factor.dropped.iter().filter(|value| value.abs() > 1e-15 * factor.dropped.len() as f64 * largest).count()
}

/// Why tables have no factored form.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unfactored {
    /// Nothing but curves, or curves of too few stations.
    #[error("there is no table of four stations both ways")]
    Empty,
    /// A table that does not say what it relates.
    #[error(
        "SPLINE/{id} does not say which directions of which rails it relates, and its x differ from its z"
    )]
    Unknown {
        /// The table.
        id: u32,
    },
    /// A structure without give.
    #[error("every product is zero")]
    Zero,
    /// What the decomposition refuses.
    #[error("{0}")]
    Splines(#[from] splines::Error),
}

/// Directions of the tables. A table without rails is of the one unnamed rail, as long as no other such table
/// has its quantity; one without quantity, if square, is a rail's own.
fn ways(tables: &[&Table]) -> Result<Ways, Unfactored> {
    let mut rails: Vec<String> = Vec::new();
    let mut number = |name: String| {
        rails.iter().position(|known| *known == name).unwrap_or_else(|| {
            rails.push(name);
            rails.len() - 1
        })
    };
    if tables.is_empty() {
        return Err(Unfactored::Empty);
    }
    let mut of = Vec::new();
    for table in tables {
        let alike = |other: &&&Table| other.rails.is_none() && other.quantity == table.quantity;
        let alone = tables.iter().filter(alike).count() == 1;
        let square = table.curves.x() == table.curves.z();
        of.push(match (table.quantity, &table.rails) {
            (Some(quantity), Some([rail, load])) => {
                let (deflection_axis, load_axis) = axes(quantity);
                [(number(rail.clone()), deflection_axis), (number(load.clone()), load_axis)]
            }
            (Some(quantity), None) if alone => {
                let rail = number(String::new());
                [(rail, axes(quantity).0), (rail, axes(quantity).1)]
            }
            (quantity, _) if square && quantity.is_none_or(|quantity| quantity.direct() == [quantity; 2]) => {
                let axis = quantity.map_or(Axis::Vertical, |quantity| axes(quantity).0);
                // no rail is called so: a number is no name of a table of ours
                [(number(format!("\0{}", table.id)), axis); 2]
            }
            _ => return Err(Unfactored::Unknown { id: table.id }),
        });
    }
    Ok(Ways { rails, of })
}

/// The curves of every direction, numbered hundreds apart.
fn curves_of(
    tables: &[&Table],
    ways: &[[Way; 2]],
    form: &Factored,
) -> Result<Vec<(Way, Vec<Table>)>, Unfactored> {
    let most = form.factors().iter().map(Factor::rank).max().unwrap_or(0);
    if most == 0 {
        return Err(Unfactored::Zero);
    }
    let step = if most < 100 { 100 } else { 10_usize.pow(most.ilog10() + 1) };
    let mut out: Vec<(Way, Vec<Table>)> = Vec::new();
    for (curves, rank) in
        form.factors().iter().flat_map(|one| one.curves.iter().map(move |c| (c, one.rank())))
    {
        let own = tables.iter().zip(ways).find(|(_, way)| way[0] == curves.way && way[1] == curves.way);
        let Some((table, _)) = own else { continue };
        let direct = table.quantity.map(|quantity: GridBlock| quantity.direct()[0]);
        let mut own = Vec::new();
        for k in 0..rank {
            let values = curves.values.column(k).iter().copied().collect();
            let curve = SplineValues::new(curves.stations.clone(), Vec::new(), vec![values]);
            own.push(Table {
                id: u32::try_from(step * (out.len() + 1) + k + 1).unwrap_or(u32::MAX),
                name: format!("{}_{}", table.name, k + 1),
                quantity: direct,
                rails: table.rails.clone(),
                curves: curve.map_err(|_| Unfactored::Zero)?,
            });
        }
        out.push((curves.way, own));
    }
    Ok(out)
}

/// The factored form against tables, at their stations.
fn deviation(tables: &[&Table], factored: &TableSet) -> Deviation {
    let plain = expand(factored);
    let mut out = Deviation::default();
    for table in tables {
        let Some(back) = plain.tables.iter().find(|back| back.name == table.name) else { continue };
        let (given, back) = (table.curves.y(), back.curves.y());
        let largest = given.iter().flatten().fold(0.0_f64, |largest, value| largest.max(value.abs()));
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

impl Factoring {
    /// Against the exact surface, at the stations and three places between each two; `None` where a rail of
    /// the tables is not among those of the surface.
    #[must_use]
    pub fn against(&self, surface: &Surface, rails: &[GridRail]) -> Option<Deviation> {
        let mut out = Deviation::default();
        for (product, [deflection, load]) in self.set.products.iter().zip(&self.ways) {
            let find = |id: Option<u32>| id.and_then(|id| self.set.find(id));
            let x = places(find(product.terms.first().map(|term| term[0]))?.curves.x());
            let z = places(find(product.terms.first().map(|term| term[1]))?.curves.x());
            let own = |way: &Way, x: f64| Probe { rail: way.0, x, axis: way.1 };
            let theirs = |way: &Way| {
                let name = self.rails.get(way.0)?;
                rails.iter().position(|rail| rail.name == *name)
            };
            let exact = |way: &Way, x: f64| Some(Probe { rail: theirs(way)?, ..own(way, x) });
            let ours: Vec<Probe> =
                z.iter().map(|z| own(deflection, *z)).chain(x.iter().map(|x| own(load, *x))).collect();
            let true_ones = z.iter().map(|z| exact(deflection, *z)).chain(x.iter().map(|x| exact(load, *x)));
            let true_ones: Vec<Probe> = true_ones.collect::<Option<_>>()?;
            let [approximate, exact] = [filled(&self.form, &ours)?, filled(surface, &true_ones)?];
            let block = |matrix: &DMatrix<f64>| matrix.view((0, z.len()), (z.len(), x.len())).into_owned();
            let (approximate, exact) = (block(&approximate), block(&exact));
            let largest = exact.amax();
            if largest == 0.0 {
                continue;
            }
            for (j, x) in x.iter().enumerate() {
                for (i, z) in z.iter().enumerate() {
                    out.take(&product.name, *x, *z, (approximate[(i, j)] - exact[(i, j)]).abs() / largest);
                }
            }
        }
        Some(out)
    }
}

fn filled(form: &dyn Compliance, at: &[Probe]) -> Option<DMatrix<f64>> {
    let mut out = Influence::zeros(at.len());
    form.fill(at, &mut out).ok()?;
    Some(out.value)
}

/// Stations and three places between each two.
fn places(stations: &[f64]) -> Vec<f64> {
    let between = |pair: &[f64]| {
        let (a, b) = (pair[0], pair[1]);
        [0.0, 0.25, 0.5, 0.75].map(|s| a + s * (b - a))
    };
    stations.windows(2).flat_map(between).chain(stations.last().copied()).collect()
}
