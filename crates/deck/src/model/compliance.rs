//! The compliance of a structure's rails in a deck: SPLINE statements, and the expressions that read them.
//!
//! The displacement of a rail at x by forces F_j at x_j is u(x) = sum_j G(x, x_j) F_j. A deck reads G in one of two
//! ways:
//!
//! - Families: G of each pair of directions is one SPLINE of two variables. It is evaluated for each pair of wheel
//!   and force, which takes N^2 look-ups for N wheels.
//! - Factored: G(x, z) = sum_k phi_k(x) phi_k(z), with one SPLINE for each curve phi_k. The products q_k = sum_j F_j
//!   phi_k(x_j) are VARIABLEs that all wheels use, and u(x) = sum_k q_k phi_k(x), which takes r N look-ups for r
//!   curves. The slope du/dx uses the derivatives of the curves.

use adams::{Spline, SplineValues, Statement};
use sim::{Extent, Foundation};
use splines::{
    Axis, Compliance, FactoredTable, Influence, InfluenceBlock, Probe, Rank, ReadingMethod,
    TableReading,
};

use crate::Error;
use crate::words::form::DeckForm;
use crate::words::ids::{NextId, product};
use crate::words::remark;
use crate::words::text::{TermList, plain, value};
use formats::scene::Structure;

/// Fraction of the largest entry of a table below which products are dropped. It bounds the change of every value at
/// a station.
pub const DROPPED_FRACTION: f64 = 1e-6;

/// A direction of forces and displacements of a structure: (rail, axis).
pub type RailAxis = (usize, Axis);

/// A force on a rail in terms of expressions.
pub struct LoadedMarker {
    /// Rail and axis of the force.
    pub direction: RailAxis,
    /// Expression of its rail coordinate.
    pub place: String,
    /// Expression of its value.
    pub force: String,
    /// Whether a positive force acts along the negative axis (downwards).
    pub negative: bool,
}

/// The compliance of the rails of one structure in the form that the deck uses.
pub struct RailCompliance {
    name: String,
    rails: Vec<formats::spec::RailOutline>,
    form: DeckForm,
    /// Directions of the forces of its wheels.
    directions: Vec<RailAxis>,
    tables: Tables,
}

enum Tables {
    Rigid,
    /// A family for each ordered pair of directions that has a table, and the influence blocks.
    Families(Vec<Family>, Vec<InfluenceBlock>),
    /// The factors, the identifier of the first SPLINE of each direction of each factor, and the number of the first
    /// factor.
    Factored(FactoredTable, Vec<Vec<u32>>, usize),
}

struct Family {
    deflection: RailAxis,
    load: RailAxis,
    table: splines::SplineTable,
    id: u32,
}

impl RailCompliance {
    /// A rigid structure.
    #[must_use]
    pub fn rigid(structure: &Structure, form: DeckForm) -> RailCompliance {
        let (name, rails) = (structure.name.clone(), structure.rails.clone());
        RailCompliance {
            name,
            rails,
            form,
            directions: Vec::new(),
            tables: Tables::Rigid,
        }
    }

    /// The compliance in `directions` from the influence `blocks`. Identifiers of SPLINEs are taken from `ids`;
    /// factors are numbered from `factors`, which is increased by their number.
    ///
    /// # Errors
    /// A direction without a table; fewer stations than a SPLINE must have.
    pub fn new(
        structure: &Structure,
        mut directions: Vec<RailAxis>,
        blocks: &[InfluenceBlock],
        form: DeckForm,
        ids: &mut NextId,
        factors: &mut usize,
    ) -> Result<RailCompliance, String> {
        directions.sort_unstable();
        directions.dedup();
        let used = |block: &&InfluenceBlock| {
            directions.contains(&block.deflection) && directions.contains(&block.load)
        };
        let blocks: Vec<InfluenceBlock> = blocks.iter().filter(used).cloned().collect();
        for direction in &directions {
            if !blocks
                .iter()
                .any(|block| block.deflection == *direction && block.load == *direction)
            {
                return Err(format!(
                    "no {} table of rail {}",
                    word(direction.1),
                    structure.rails[direction.0].name
                ));
            }
        }
        for &(rail, _) in &directions {
            let outline = &structure.rails[rail];
            if outline.stations.len() < SplineValues::MIN_POINTS {
                return Err(format!(
                    "rail {} has fewer than four stations",
                    outline.name
                ));
            }
        }
        let tables = match form {
            DeckForm::Factored => {
                let factored = FactoredTable::new(&blocks, Rank::Tolerance(DROPPED_FRACTION))
                    .map_err(|error| error.to_string())?;
                let mut first = Vec::new();
                for factor in factored.factors() {
                    let mut starts = Vec::new();
                    for _ in &factor.curves {
                        starts.push(ids.take());
                        for _ in 1..factor.rank() {
                            ids.take();
                        }
                    }
                    first.push(starts);
                }
                let number = *factors;
                *factors += factored.factors().len();
                Tables::Factored(factored, first, number)
            }
            DeckForm::Akispl | DeckForm::Symmetrised | DeckForm::Paper => families(blocks, ids)?,
        };
        let (name, rails) = (structure.name.clone(), structure.rails.clone());
        Ok(RailCompliance {
            name,
            rails,
            form,
            directions,
            tables,
        })
    }

    /// Whether the rails are flexible.
    #[must_use]
    pub fn is_flexible(&self) -> bool {
        !matches!(self.tables, Tables::Rigid)
    }

    /// Number of curves of the largest factor; `None` for families.
    #[must_use]
    pub fn rank(&self) -> Option<usize> {
        match &self.tables {
            Tables::Factored(factored, ..) => factored
                .factors()
                .iter()
                .map(splines::TableFactor::rank)
                .max(),
            _ => None,
        }
    }

    /// The foundation of the simulator that interpolates the same tables as the deck. Without `slopes` rails have no
    /// slope, so that no force acts along them, as in a deck that reads families.
    ///
    /// # Errors
    /// [`Error::Tables`] for tables that cannot be interpolated.
    pub fn foundation(&self, slopes: bool) -> Result<Foundation, Error> {
        let fail = |source| Error::Tables {
            structure: self.name.clone(),
            source,
        };
        let rails = self.rails.len();
        match &self.tables {
            Tables::Rigid => {
                let extent = |rail: &formats::spec::RailOutline| Extent {
                    range: Some(rail.range),
                    breaks: Vec::new(),
                };
                Ok(Foundation {
                    rails: self.rails.iter().map(extent).collect(),
                    ..Foundation::rigid()
                })
            }
            Tables::Families(_, blocks) => {
                let kind = if self.form == DeckForm::Symmetrised {
                    ReadingMethod::Symmetrised
                } else {
                    ReadingMethod::Akispl
                };
                let reading = TableReading::new(kind, blocks).map_err(fail)?;
                Ok(if slopes {
                    Foundation::massless(Box::new(reading), rails)
                } else {
                    Foundation::massless(Box::new(WithoutSlopes(reading)), rails)
                })
            }
            Tables::Factored(factored, ..) => {
                Ok(Foundation::massless(Box::new(factored.clone()), rails))
            }
        }
    }

    /// The SPLINE statements.
    ///
    /// # Errors
    /// [`Error::Spline`] for tables that do not form a valid SPLINE.
    pub fn splines(&self) -> Result<Vec<Statement>, Error> {
        let mut out = Vec::new();
        match &self.tables {
            Tables::Rigid => {}
            Tables::Families(families, _) => {
                for family in families {
                    let (a, b) = (
                        self.direction_name(family.deflection),
                        self.direction_name(family.load),
                    );
                    let name = if a == b { a } else { format!("{a}_from_{b}") };
                    let table = &family.table;
                    let rows = table
                        .values()
                        .row_iter()
                        .map(|row| row.iter().copied().collect())
                        .collect();
                    out.push(spline(
                        family.id,
                        &name,
                        table.x().to_vec(),
                        table.z().to_vec(),
                        rows,
                    )?);
                }
            }
            Tables::Factored(factored, first, _) => {
                for (factor, first) in factored.factors().iter().zip(first) {
                    for (curves, &first) in factor.curves.iter().zip(first) {
                        for (id, column) in (first..).zip(curves.values.column_iter()) {
                            let name = format!(
                                "{}_product_{}",
                                self.direction_name(curves.direction),
                                id - first + 1
                            );
                            let values = column.iter().copied().collect();
                            out.push(spline(
                                id,
                                &name,
                                curves.stations.clone(),
                                Vec::new(),
                                vec![values],
                            )?);
                        }
                    }
                }
            }
        }
        if let Some(statement) = out.first_mut() {
            let range = self
                .directions
                .first()
                .map_or([0.0; 2], |direction| self.rails[direction.0].range);
            statement.remarks = remark::tables(self.form, range);
        }
        Ok(out)
    }

    /// VARIABLEs of the products, q_k = sum over the loads of F phi_k(x), which all wheels use.
    #[must_use]
    pub fn products(&self, loads: &[LoadedMarker]) -> Vec<Statement> {
        let Tables::Factored(factored, first, number) = &self.tables else {
            return Vec::new();
        };
        let mut out = Vec::new();
        for (f, (factor, first)) in factored.factors().iter().zip(first).enumerate() {
            for k in 0..factor.rank() {
                let mut sum = TermList::default();
                for load in loads {
                    let Some(curve) = curve(factor, first, load.direction, k) else {
                        continue;
                    };
                    sum.add(
                        load.negative,
                        &format!("{}*CUBSPL({},0,{curve})", load.force, load.place),
                    );
                }
                out.push(
                    Statement::new("VARIABLE", product(number + f, k))
                        .named(plain(&format!("{}_product_{}_{}", self.name, f + 1, k + 1)))
                        .function("FUNCTION", sum.text()),
                );
            }
        }
        out
    }

    /// Expression of the displacement of the rail at `place` in `direction`, positive along the axis. With `slope` it
    /// is the expression of the derivative along the rail, `None` for families, because AKISPL of a family has no
    /// derivative.
    #[must_use]
    pub fn displacement(
        &self,
        direction: RailAxis,
        place: &str,
        loads: &[LoadedMarker],
        slope: bool,
    ) -> Option<String> {
        let mut sum = TermList::default();
        match &self.tables {
            Tables::Families(families, _) if !slope => {
                let find = |a: RailAxis, b: RailAxis| {
                    families.iter().find(|f| f.deflection == a && f.load == b)
                };
                for load in loads {
                    let Some(family) = find(direction, load.direction) else {
                        continue;
                    };
                    let (x, z, id) = (&load.place, place, family.id);
                    let read = match self.form {
                        DeckForm::Symmetrised => {
                            let back =
                                find(load.direction, direction).map_or(id, |family| family.id);
                            format!("0.5*(AKISPL({x},{z},{id})+AKISPL({z},{x},{back}))")
                        }
                        DeckForm::Paper => format!("AKISPL({x},{x},{id})"),
                        _ => format!("AKISPL({x},{z},{id})"),
                    };
                    sum.add(load.negative, &format!("{}*{read}", load.force));
                }
            }
            Tables::Factored(factored, first, number) => {
                let order = if slope { ",1" } else { "" };
                for (f, (factor, first)) in factored.factors().iter().zip(first).enumerate() {
                    for k in 0..factor.rank() {
                        let Some(curve) = curve(factor, first, direction, k) else {
                            continue;
                        };
                        let q = value(product(number + f, k));
                        sum.add(false, &format!("{q}*CUBSPL({place},0,{curve}{order})"));
                    }
                }
            }
            _ => return None,
        }
        Some(sum.text())
    }

    /// Name of a direction in names of SPLINEs.
    fn direction_name(&self, (rail, axis): RailAxis) -> String {
        format!("{}_{}_{}", self.name, self.rails[rail].name, word(axis))
    }
}

/// Identifier of the SPLINE of curve `k` in a direction; `None` where the factor does not have the direction.
fn curve(
    factor: &splines::TableFactor,
    first: &[u32],
    direction: RailAxis,
    k: usize,
) -> Option<u32> {
    let at = factor
        .curves
        .iter()
        .position(|curves| curves.direction == direction)?;
    Some(first[at] + crate::words::ids::number(k) - 1)
}

/// A reading of tables whose slopes are zero.
struct WithoutSlopes(TableReading);

impl Compliance for WithoutSlopes {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), splines::Error> {
        self.0.fill(at, out)?;
        out.slope.fill(0.0);
        Ok(())
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.0.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.0.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        self.0.is_symmetric()
    }
}

/// Families of every ordered pair of directions that has a table, pairs of equal directions first. The transpose of a
/// coupling is the family of the reversed pair.
fn families(blocks: Vec<InfluenceBlock>, ids: &mut NextId) -> Result<Tables, String> {
    let mut all: Vec<(RailAxis, RailAxis, splines::SplineTable)> = Vec::new();
    for direct in [true, false] {
        for block in blocks
            .iter()
            .filter(|block| (block.deflection == block.load) == direct)
        {
            all.push((block.deflection, block.load, block.table.clone()));
            if !direct {
                let opposite = block
                    .table
                    .transposed()
                    .map_err(|error| error.to_string())?;
                all.push((block.load, block.deflection, opposite));
            }
        }
    }
    let family = |(deflection, load, table)| Family {
        deflection,
        load,
        table,
        id: ids.take(),
    };
    Ok(Tables::Families(
        all.into_iter().map(family).collect(),
        blocks,
    ))
}

/// A SPLINE statement with its name in Adams View.
pub(crate) fn spline(
    id: u32,
    name: &str,
    x: Vec<f64>,
    z: Vec<f64>,
    values: Vec<Vec<f64>>,
) -> Result<Statement, Error> {
    let curves = SplineValues::new(x, z, values).map_err(|fault| Error::Spline {
        id,
        name: name.to_owned(),
        fault,
    })?;
    let (name, units) = (Some(plain(name)), Some("no_units".to_owned()));
    Ok(Spline {
        id,
        name,
        units,
        linear_extrapolate: true,
        curves,
    }
    .statement())
}

/// The word for an axis in names.
pub(crate) fn word(axis: Axis) -> &'static str {
    match axis {
        Axis::Longitudinal => "longitudinal",
        Axis::Vertical => "vertical",
        Axis::Lateral => "lateral",
    }
}
