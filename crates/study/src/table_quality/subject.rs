//! Tables read from a file.

use std::path::Path;

use nalgebra::DMatrix;
use splines::quality::RailDirection;
use splines::{ExactSurface, InfluenceBlock, SplineTable};

use crate::Error;
use formats::grid::axes;
use formats::grid::block::GridBlock;
use formats::grid::file as grid_file;
use formats::tables::{self, Contents, TableSet};
use formats::text::diagnostic::Diagnostic;
use formats::text::fault::{Fault, Faults};
use formats::text::inputs::Inputs;
use formats::text::place::Place;
use formats::text::source::Source;
use formats::units::Units;

/// Largest number of a table; larger ones are refused, since their squares must be finite.
const LARGEST: f64 = 1e60;
/// Smallest distance of stations relative to the length of the table; closer ones are refused, since their
/// differences would be rounding.
const NEAREST: f64 = 1e-9;

/// Tables of one file, and the exact surface where it has one.
pub struct TableSource {
    /// The file as the user named it.
    pub file: String,
    /// Units of all numbers, where the file states them.
    pub units: Option<Units>,
    /// Its tables.
    pub items: Vec<TableItem>,
    /// The exact surface of which they are values.
    pub surface: Option<ExactSurface>,
    /// Messages about parts of the file that are not read.
    pub notes: Vec<String>,
}

/// One table.
#[derive(Clone, Debug)]
pub struct TableItem {
    /// Its number.
    pub id: u32,
    /// Its name; empty where it has none.
    pub name: String,
    /// Paths (rail and direction) of deflection and load; `None` for a coupling whose directions the file does not
    /// state.
    pub paths: Option<[RailDirection; 2]>,
    /// Whether the file asks for linear extrapolation; `None` for a grid file.
    pub linear: Option<bool>,
    /// Its values.
    pub table: SplineTable,
}

impl TableItem {
    /// Whether deflections and loads are of the same path: only such a table is symmetric.
    #[must_use]
    pub fn is_direct(&self) -> bool {
        self.paths
            .is_some_and(|[deflection, load]| deflection == load)
    }
}

impl TableSource {
    /// Reads a grid file or a file of tables.
    ///
    /// # Errors
    /// A file that cannot be read, is invalid or has no table.
    pub fn open(path: &Path) -> Result<TableSource, Error> {
        let inputs = Inputs::open_bytes(path)?;
        let input = &inputs.all()[0];
        if tables::is_tables(&input.display_name, &input.bytes) {
            TableSource::of_tables(
                &input.display_name,
                &tables::contents(&input.display_name, &input.bytes)?,
            )
        } else {
            TableSource::of_grid(&input.source()?)
        }
    }

    fn of_grid(source: &Source) -> Result<TableSource, Error> {
        let (grid, surface) = grid_file::read(source)?;
        let mut notes: Vec<String> = Vec::new();
        for rail in grid
            .rails
            .iter()
            .filter(|rail| rail.stations.len() < SplineTable::FEWEST_X)
        {
            notes.push(format!(
                "rail {} has fewer than four stations, so it has no table of loads",
                rail.name
            ));
        }
        let rails = grid.rails.len();
        let mut items = Vec::new();
        for table in &TableSet::of_grid(&grid).tables {
            let paths = paths(table.id, rails);
            items.extend(item(&source.name, table)?.map(|item| TableItem { paths, ..item }));
        }
        if items.is_empty() {
            let fault = Fault::new(
                &Place::root().key("rails"),
                "must have a rail of at least four stations",
            );
            let fault = fault.hint("a SPLINE needs at least four x values");
            return Err(Error::Input(source.diagnose(&Faults(vec![fault]))));
        }
        Ok(TableSource {
            file: source.name.clone(),
            units: Some(grid.units),
            items,
            surface,
            notes,
        })
    }

    fn of_tables(file: &str, contents: &Contents) -> Result<TableSource, Error> {
        let mut items = Vec::new();
        let mut notes = Vec::new();
        for (table, linear) in &contents.tables {
            match item(file, table)? {
                Some(item) => items.push(TableItem {
                    linear: *linear,
                    ..item
                }),
                None => notes.push(format!(
                    "SPLINE/{} has a single curve, so it is not an influence table",
                    table.id
                )),
            }
        }
        // the file does not state which tables belong together: each is a path of its own
        for (index, item) in items.iter_mut().enumerate() {
            if !is_coupling(&item.name) {
                item.paths = Some([(index, splines::Axis::Vertical); 2]);
            }
        }
        if items.is_empty() {
            let wrong = Diagnostic::of_file(file, "has no SPLINE with a curve for each z");
            return Err(wrong
                .hint("an influence table has one Y list for each z")
                .into());
        }
        if contents.units.is_none() {
            notes.push(
                "the file states no units: all numbers are in the units of the file".to_owned(),
            );
        }
        Ok(TableSource {
            file: file.to_owned(),
            units: contents.units,
            items,
            surface: None,
            notes,
        })
    }

    /// The tables that can be read together: those of known paths, whose direct tables are in the file.
    #[must_use]
    pub fn blocks(&self) -> Vec<InfluenceBlock> {
        let own = |path: RailDirection| self.items.iter().any(|item| item.paths == Some([path; 2]));
        let known = self
            .items
            .iter()
            .filter_map(|item| Some((item.paths?, &item.table)));
        known
            .filter(|([deflection, load], table)| {
                own(*deflection) && own(*load) && table.z().len() > 1
            })
            .map(|([deflection, load], table)| InfluenceBlock {
                deflection,
                load,
                table: table.clone(),
            })
            .collect()
    }
}

/// A family of curves as a table; `None` for a single curve.
fn item(file: &str, given: &tables::Table) -> Result<Option<TableItem>, Error> {
    let curves = &given.curves;
    if curves.z().is_empty() {
        return Ok(None);
    }
    let numbers = curves
        .x()
        .iter()
        .chain(curves.z())
        .chain(curves.y().iter().flatten());
    if let Some(wrong) = numbers.into_iter().find(|number| number.abs() > LARGEST) {
        let wrong = format!(
            "SPLINE/{} has the value {wrong:e}, which is too large for any structure",
            given.id
        );
        return Err(Diagnostic::of_file(file, wrong)
            .hint("check the units")
            .into());
    }
    for points in [curves.x(), curves.z()] {
        let least = NEAREST * (points[points.len() - 1] - points[0]);
        if let Some(pair) = points.windows(2).find(|pair| pair[1] - pair[0] < least) {
            let wrong = format!(
                "SPLINE/{} has stations at {} and {}",
                given.id, pair[0], pair[1]
            );
            return Err(Diagnostic::of_file(file, wrong)
                .hint("remove one of them")
                .into());
        }
    }
    let values = DMatrix::from_fn(curves.z().len(), curves.x().len(), |i, j| curves.y()[i][j]);
    let table = SplineTable::new(curves.x().to_vec(), curves.z().to_vec(), values)?;
    let unnamed = format!("SPLINE_{}", given.id);
    let name = if given.name == unnamed {
        String::new()
    } else {
        given.name.clone()
    };
    Ok(Some(TableItem {
        id: given.id,
        name,
        paths: None,
        linear: None,
        table,
    }))
}

/// Paths of a table of a grid with this number of rails, by the number of the table: from 6 on, six for each pair of
/// rails.
fn paths(id: u32, rails: usize) -> Option<[RailDirection; 2]> {
    let place = usize::try_from(id).ok()?.checked_sub(6)?;
    let (pair, index) = (place / 6, place % 6);
    let (deflection, load) = axes(*GridBlock::ALL.get(index)?);
    Some([
        (pair / rails.max(1), deflection),
        (pair % rails.max(1), load),
    ])
}

/// Whether the name of a table says that it couples two directions or two rails.
fn is_coupling(name: &str) -> bool {
    let couplings = GridBlock::ALL
        .into_iter()
        .filter(|quantity| quantity.direct() != [*quantity; 2]);
    name.contains("_from_")
        || couplings
            .into_iter()
            .any(|quantity| name.ends_with(quantity.name()))
}
