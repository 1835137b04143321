//! What a structure's rails give: SPLINE statements, and the expressions that read them.

use adams::{Spline, SplineValues, Statement};
use sim::{Extent, Foundation};
use splines::{Axis, Factored, Kind, Rank, Reading, Sheet};

use crate::Error;
use crate::words::expression::{TermList, value};
use crate::words::form::DeckForm;
use crate::words::ids::{NextId, product};
use crate::words::name::plain;
use crate::words::remark;
use formats::scene::Structure;

/// Products below this share of a table's largest entry are left out: no station's value changes by more.
pub const SHARE: f64 = 1e-6;

/// A direction of a structure: rail and axis.
pub type RailAxis = (usize, Axis);

/// A force on a rail, as expressions.
pub struct LoadedMarker {
    /// Where it acts, and which way.
    pub way: RailAxis,
    /// Rail coordinate.
    pub place: String,
    /// Force.
    pub force: String,
    /// Whether a positive force points along the negative axis: down.
    pub negative: bool,
}

/// The give of one structure.
pub struct RailCompliance {
    name: String,
    rails: Vec<formats::spec::RailOutline>,
    form: DeckForm,
    /// Directions in which wheels press.
    ways: Vec<RailAxis>,
    tables: Tables,
}

enum Tables {
    Rigid,
    /// A family for each pair of directions that has one: deflection, load, table, identifier.
    Families(Vec<Family>, Vec<Sheet>),
    /// Curves; the first identifier of each factor's directions, and the number of the first factor.
    Factored(Factored, Vec<Vec<u32>>, usize),
}

struct Family {
    deflection: RailAxis,
    load: RailAxis,
    table: splines::Table,
    id: u32,
}

impl RailCompliance {
    /// A structure that does not give.
    #[must_use]
    pub fn rigid(structure: &Structure, form: DeckForm) -> RailCompliance {
        let (name, rails) = (structure.name.clone(), structure.rails.clone());
        RailCompliance { name, rails, form, ways: Vec::new(), tables: Tables::Rigid }
    }

    /// The give along `ways` by `sheets`; SPLINE identifiers are taken from `ids`, factors are numbered from
    /// `factors` on.
    ///
    /// # Errors
    /// A direction without a table; stations too few for a SPLINE.
    pub fn new(
        structure: &Structure,
        mut ways: Vec<RailAxis>,
        sheets: &[Sheet],
        form: DeckForm,
        ids: &mut NextId,
        factors: &mut usize,
    ) -> Result<RailCompliance, String> {
        ways.sort_unstable();
        ways.dedup();
        let used = |sheet: &&Sheet| ways.contains(&sheet.deflection) && ways.contains(&sheet.load);
        let sheets: Vec<Sheet> = sheets.iter().filter(used).cloned().collect();
        for way in &ways {
            if !sheets.iter().any(|sheet| sheet.deflection == *way && sheet.load == *way) {
                return Err(format!("no {} table of rail {}", word(way.1), structure.rails[way.0].name));
            }
        }
        for &(rail, _) in &ways {
            let outline = &structure.rails[rail];
            if outline.stations.len() < SplineValues::MIN_POINTS {
                return Err(format!("rail {} has fewer than four stations", outline.name));
            }
        }
        let tables = match form {
            DeckForm::Factored => {
                let factored =
                    Factored::new(&sheets, Rank::Tolerance(SHARE)).map_err(|error| error.to_string())?;
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
            DeckForm::Akispl | DeckForm::Symmetrised | DeckForm::Paper => families(sheets, ids)?,
        };
        let (name, rails) = (structure.name.clone(), structure.rails.clone());
        Ok(RailCompliance { name, rails, form, ways, tables })
    }

    /// Whether the rails give at all.
    #[must_use]
    pub fn gives(&self) -> bool {
        !matches!(self.tables, Tables::Rigid)
    }

    /// Number of products of the largest factor; `None` for families.
    #[must_use]
    pub fn rank(&self) -> Option<usize> {
        match &self.tables {
            Tables::Factored(factored, ..) => factored.factors().iter().map(splines::Factor::rank).max(),
            _ => None,
        }
    }

    /// The simulator's foundation that reads the same tables the same way.
    ///
    /// # Errors
    /// What the tables refuse.
    pub fn foundation(&self) -> Result<Foundation, Error> {
        let fail = |source| Error::Tables { structure: self.name.clone(), source };
        let rails = self.rails.len();
        match &self.tables {
            Tables::Rigid => {
                let extent = |rail: &formats::spec::RailOutline| Extent {
                    range: Some(rail.range),
                    breaks: Vec::new(),
                };
                Ok(Foundation { rails: self.rails.iter().map(extent).collect(), ..Foundation::rigid() })
            }
            Tables::Families(_, sheets) => {
                let kind = if self.form == DeckForm::Symmetrised { Kind::Symmetrised } else { Kind::Akispl };
                let reading = Reading::new(kind, sheets).map_err(fail)?;
                Ok(Foundation::influence(Box::new(reading), rails))
            }
            Tables::Factored(factored, ..) => Ok(Foundation::influence(Box::new(factored.clone()), rails)),
        }
    }

    /// The SPLINE statements.
    ///
    /// # Errors
    /// Tables that are no SPLINE.
    pub fn splines(&self) -> Result<Vec<Statement>, Error> {
        let mut out = Vec::new();
        match &self.tables {
            Tables::Rigid => {}
            Tables::Families(families, _) => {
                for family in families {
                    let (a, b) = (self.way(family.deflection), self.way(family.load));
                    let name = if a == b { a } else { format!("{a}_from_{b}") };
                    let table = &family.table;
                    let rows = table.values().row_iter().map(|row| row.iter().copied().collect()).collect();
                    out.push(spline(family.id, &name, table.x().to_vec(), table.z().to_vec(), rows)?);
                }
            }
            Tables::Factored(factored, first, _) => {
                for (factor, first) in factored.factors().iter().zip(first) {
                    for (curves, &first) in factor.curves.iter().zip(first) {
                        for (id, column) in (first..).zip(curves.values.column_iter()) {
                            let name = format!("{}_product_{}", self.way(curves.way), id - first + 1);
                            let values = column.iter().copied().collect();
                            out.push(spline(id, &name, curves.stations.clone(), Vec::new(), vec![values])?);
                        }
                    }
                }
            }
        }
        if let Some(statement) = out.first_mut() {
            let range = self.ways.first().map_or([0.0; 2], |way| self.rails[way.0].range);
            statement.remarks = remark::tables(self.form, range);
        }
        Ok(out)
    }

    /// VARIABLEs of the products, q_k = sum over the loads of F phi_k: shared by all wheels.
    #[must_use]
    pub fn products(&self, loads: &[LoadedMarker]) -> Vec<Statement> {
        let Tables::Factored(factored, first, number) = &self.tables else { return Vec::new() };
        let mut out = Vec::new();
        for (f, (factor, first)) in factored.factors().iter().zip(first).enumerate() {
            for k in 0..factor.rank() {
                let mut sum = TermList::default();
                for load in loads {
                    let Some(curve) = curve(factor, first, load.way, k) else { continue };
                    sum.add(load.negative, &format!("{}*CUBSPL({},0,{curve})", load.force, load.place));
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

    /// The displacement of the rail at a place along `way`, positive along the axis; with `slope` its derivative
    /// along the rail, which families do not have.
    #[must_use]
    pub fn displacement(
        &self,
        way: RailAxis,
        place: &str,
        loads: &[LoadedMarker],
        slope: bool,
    ) -> Option<String> {
        let mut sum = TermList::default();
        match &self.tables {
            Tables::Families(families, _) if !slope => {
                let find =
                    |a: RailAxis, b: RailAxis| families.iter().find(|f| f.deflection == a && f.load == b);
                for load in loads {
                    let Some(family) = find(way, load.way) else { continue };
                    let (x, z, id) = (&load.place, place, family.id);
                    let read = match self.form {
                        DeckForm::Symmetrised => {
                            let back = find(load.way, way).map_or(id, |family| family.id);
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
                        let Some(curve) = curve(factor, first, way, k) else { continue };
                        let q = value(product(number + f, k));
                        sum.add(false, &format!("{q}*CUBSPL({place},0,{curve}{order})"));
                    }
                }
            }
            _ => return None,
        }
        Some(sum.text())
    }

    fn way(&self, (rail, axis): RailAxis) -> String {
        format!("{}_{}_{}", self.name, self.rails[rail].name, word(axis))
    }
}

/// SPLINE of product `k` along a direction, where the factor has the direction.
fn curve(factor: &splines::Factor, first: &[u32], way: RailAxis, k: usize) -> Option<u32> {
    let at = factor.curves.iter().position(|curves| curves.way == way)?;
    Some(first[at] + crate::words::ids::number(k) - 1)
}

/// Families of every ordered pair of directions that has a table: direct ones first.
fn families(sheets: Vec<Sheet>, ids: &mut NextId) -> Result<Tables, String> {
    let mut all: Vec<(RailAxis, RailAxis, splines::Table)> = Vec::new();
    for direct in [true, false] {
        for sheet in sheets.iter().filter(|sheet| (sheet.deflection == sheet.load) == direct) {
            all.push((sheet.deflection, sheet.load, sheet.table.clone()));
            if !direct {
                let opposite = sheet.table.transposed().map_err(|error| error.to_string())?;
                all.push((sheet.load, sheet.deflection, opposite));
            }
        }
    }
    let family = |(deflection, load, table)| Family { deflection, load, table, id: ids.take() };
    Ok(Tables::Families(all.into_iter().map(family).collect(), sheets))
}

/// A SPLINE statement with its View name.
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
    Ok(Spline { id, name, units, linear_extrapolate: true, curves }.statement())
}

/// Word of an axis in names.
pub(crate) fn word(axis: Axis) -> &'static str {
    match axis {
        Axis::Longitudinal => "longitudinal",
        Axis::Vertical => "vertical",
        Axis::Lateral => "lateral",
    }
}
