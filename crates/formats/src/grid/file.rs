//! Grid files, `girderway-grid/1`. Numbers are written in the shortest decimal form that is read back bit for bit.

use std::fmt::Arguments;
use std::io::Write;

use fea::Certificate;
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;
use splines::ExactSurface;

use super::block::GridBlock;
use super::coupling::{Coupling, RawCoupling};
use super::effects_file::{self, RawEffects};
use super::influence::{GridCritical, GridRail, StationGrid};
use super::modes_file::RawModes;
use super::rows::MatrixRow;
use super::surface_file::{RawSurface, WrittenSurface};
use crate::spec::THEORIES;
use crate::text::diagnostic::Diagnostic;
use crate::text::fault::{Fault, Faults, number};
use crate::text::names::check_free_name;
use crate::text::place::Place;
use crate::text::source::Source;
use crate::units::{RawUnits, Units};

crate::text::object::objects!(RawGrid, RawRail, RawCertificate, RawInfluence);

/// Value of the member `format`: name and version of the format.
pub const FORMAT: &str = "girderway-grid/1";
/// Largest number of degrees of freedom of an exact compliance that a file contains. It corresponds to a file of about
/// 170 MB.
const MAX_DOFS: usize = 3000;

/// Why a file does not contain the exact compliance of `dofs` degrees of freedom (6 for each end state of the rail
/// elements); `None` where it does.
#[must_use]
pub fn surface_omission(dofs: usize) -> Option<String> {
    (dofs > MAX_DOFS).then(|| {
        format!(
            "no influence surface: the compliance matrix of the {dofs} degrees of freedom at the ends of the rail \
             elements is too large for a file"
        )
    })
}

/// The text of a grid file, with one matrix row per line and every number in its shortest exact decimal form. If
/// `surface` is given, the compliance between arbitrary positions is included, which is exact between the stations
/// too, unless it is too large for a file ([`surface_omission`]).
#[must_use]
pub fn write(grid: &StationGrid, surface: Option<&ExactSurface>) -> String {
    let mut head = serde_json::Map::new();
    head.insert("format".into(), json!(FORMAT));
    head.insert("name".into(), json!(grid.name));
    head.insert("units".into(), grid.units.json());
    if let Some(theory) = &grid.theory {
        head.insert("theory".into(), json!(theory));
    }
    let rails: Vec<_> = grid
        .rails
        .iter()
        .map(|rail| json!({ "name": rail.name, "stations": rail.stations }))
        .collect();
    head.insert("rails".into(), json!(rails));
    if let Some(certificate) = &grid.certificate {
        let precision = if certificate.extended {
            "double-double"
        } else {
            "double"
        };
        let object = json!({
            "condition": certificate.condition,
            "error_bound": certificate.error_bound,
            "precision": precision,
        });
        head.insert("certificate".into(), object);
    }
    match grid.critical {
        Some(GridCritical::At(factor)) => {
            head.insert("critical_factor".into(), json!(factor));
        }
        Some(GridCritical::Above(most)) => {
            head.insert("critical_factor".into(), json!({ "above": most }));
        }
        None => {}
    }
    if let Some(coupling) = Coupling::of(grid) {
        head.insert("coupling".into(), coupling.json());
    }
    if !grid.notes.is_empty() {
        head.insert("notes".into(), json!(grid.notes));
    }
    let mut text = Vec::new();
    put(&mut text, format_args!("{{\n"));
    for (key, value) in &head {
        put(&mut text, format_args!("  \"{key}\": {value},\n"));
    }
    put(&mut text, format_args!("  \"influence\": {{"));
    for (index, (quantity, block)) in grid.blocks.iter().enumerate() {
        let comma = if index > 0 { "," } else { "" };
        put(&mut text, format_args!("{comma}\n    \"{quantity}\": ["));
        for row in 0..block.nrows() {
            put(
                &mut text,
                format_args!("{}\n      ", if row > 0 { "," } else { "" }),
            );
            put_json(&mut text, &MatrixRow(block, row));
        }
        put(&mut text, format_args!("\n    ]"));
    }
    put(&mut text, format_args!("\n  }}"));
    if let Some(effects) = &grid.effects {
        let member = effects_file::write(effects, grid.units);
        put(&mut text, format_args!(",\n  \"effects\": {member}"));
    }
    if let Some(surface) = surface.filter(|given| surface_omission(given.nodal().nrows()).is_none())
    {
        put(&mut text, format_args!(",\n  \"surface\": "));
        put_json(&mut text, &WrittenSurface::of(surface));
    }
    put(&mut text, format_args!("\n}}\n"));
    String::from_utf8(text).expect("JSON is UTF-8")
}

/// Appends a text.
fn put(out: &mut Vec<u8>, text: Arguments<'_>) {
    out.write_fmt(text).expect("memory takes all bytes");
}

/// Appends a value as JSON on one line.
fn put_json(out: &mut Vec<u8>, value: &impl Serialize) {
    serde_json::to_writer(out, value).expect("memory takes all bytes, and the keys are text");
}

/// An influence grid: influence coefficients of the rails of a structure at stations.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawGrid {
    /// Name and version of the format.
    format: Option<String>,
    /// Name of the structure.
    name: Option<String>,
    /// Units of all numbers of the file.
    units: Option<RawUnits>,
    /// Beam theory: "euler-bernoulli" or "timoshenko".
    theory: Option<String>,
    /// Rails with their stations.
    rails: Option<Vec<RawRail>>,
    /// Bound of the error from rounding.
    certificate: Option<RawCertificate>,
    /// Smallest factor on the preload at which the stiffness is singular, of axial forces alone; lateral-torsional buckling is
    /// not included. Absent without preload.
    critical_factor: Option<RawCritical>,
    /// Size of the coupling of directions, for information: it follows from the grids.
    #[serde(rename = "coupling")]
    _coupling: Option<RawCoupling>,
    /// Reasons why blocks are absent.
    #[serde(default)]
    notes: Vec<String>,
    /// Blocks of influence coefficients.
    influence: Option<RawInfluence>,
    /// Reactions and internal forces under unit loads.
    effects: Option<RawEffects>,
    /// The exact influence surface between the stations.
    surface: Option<RawSurface>,
    /// Natural modes.
    modes: Option<RawModes>,
}

/// A rail of an influence grid.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawRail {
    /// Name of the rail.
    name: Option<String>,
    /// Coordinates of the stations, length.
    stations: Option<Vec<f64>>,
}

/// Bound of the error of the influence coefficients from rounding.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawCertificate {
    /// Condition number of the scaled stiffness matrix.
    condition: f64,
    /// Bound of the error of entry ij, relative to sqrt(G_ii G_jj).
    error_bound: f64,
    /// Precision in which the stiffness matrix was formed and factored.
    #[serde(default)]
    precision: Precision,
}

/// A critical factor, or an object with the factor `above` which there is one at most.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or an object with `above`")]
enum RawCritical {
    /// The factor.
    At(f64),
    /// There is none up to a factor.
    Above {
        /// That factor.
        above: f64,
    },
}

/// Precision in which the stiffness matrix is formed and factored.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
enum Precision {
    #[default]
    Double,
    DoubleDouble,
}

/// Blocks of influence coefficients, length / force. Rows are stations of the displacement, columns those of the
/// load.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
struct RawInfluence {
    /// Vertical displacement per vertical load.
    vertical: Option<Vec<Vec<f64>>>,
    /// Lateral displacement per lateral load.
    lateral: Option<Vec<Vec<f64>>>,
    /// Longitudinal displacement per longitudinal load.
    longitudinal: Option<Vec<Vec<f64>>>,
    /// Vertical displacement per lateral load.
    vertical_lateral: Option<Vec<Vec<f64>>>,
    /// Vertical displacement per longitudinal load.
    vertical_longitudinal: Option<Vec<Vec<f64>>>,
    /// Lateral displacement per longitudinal load.
    lateral_longitudinal: Option<Vec<Vec<f64>>>,
}

impl RawInfluence {
    fn block(&self, quantity: GridBlock) -> Option<&Vec<Vec<f64>>> {
        match quantity {
            GridBlock::Vertical => self.vertical.as_ref(),
            GridBlock::Lateral => self.lateral.as_ref(),
            GridBlock::Longitudinal => self.longitudinal.as_ref(),
            GridBlock::VerticalLateral => self.vertical_lateral.as_ref(),
            GridBlock::VerticalLongitudinal => self.vertical_longitudinal.as_ref(),
            GridBlock::LateralLongitudinal => self.lateral_longitudinal.as_ref(),
        }
    }
}

/// Reads a grid file: the grid, and the exact compliance if the file contains it.
///
/// # Errors
/// All faults of the file, such as a block whose size differs from the number of stations or a direct block that is
/// not exactly symmetric.
pub fn read(source: &Source) -> Result<(StationGrid, Option<ExactSurface>), Vec<Diagnostic>> {
    source.read(FORMAT, |raw: &RawGrid, faults| {
        let grid = check(raw, source, faults);
        let place = Place::root();
        let surface = raw
            .surface
            .as_ref()
            .and_then(|raw| raw.surface(&place.key("surface"), faults));
        grid.map(|grid| (grid, surface))
    })
}

fn check(raw: &RawGrid, source: &Source, faults: &mut Faults) -> Option<StationGrid> {
    let root = Place::root();
    crate::spec::format(&raw.format, FORMAT, &root, faults);
    let units = Units::read(&raw.units, &root, faults);
    if let Some(theory) = &raw.theory {
        faults.one_of(theory, &root.key("theory"), &THEORIES);
    }
    let rails = read_rails(raw, &root, faults);
    let size = rails.iter().map(|rail| rail.stations.len()).sum();
    if let Some(modes) = &raw.modes {
        modes.check(size, &root.key("modes"), faults);
    }
    let influence = faults.require(&raw.influence, &root, "influence")?;
    let at = root.key("influence");
    let mut blocks = Vec::new();
    for quantity in GridBlock::ALL {
        let Some(rows) = influence.block(quantity) else {
            continue;
        };
        let place = at.key(quantity.name());
        if let Some(block) = square(rows, size, &place, faults) {
            if quantity.direct() == [quantity; 2] {
                symmetric(&block, &place, faults);
            }
            blocks.push((quantity, block));
        }
    }
    if blocks.is_empty() && faults.0.is_empty() {
        faults.add(Fault::new(&at, "must have at least one grid"));
    }
    let effects = raw
        .effects
        .as_ref()
        .map(|raw| raw.effects(size, &root.key("effects"), faults));
    let certificate = raw.certificate.as_ref();
    let certificate = certificate.map(|given| Certificate {
        condition: given.condition,
        error_bound: given.error_bound,
        extended: given.precision == Precision::DoubleDouble,
    });
    Some(StationGrid {
        name: raw
            .name
            .as_ref()
            .inspect(|name| check_free_name(name, &root.key("name"), faults))
            .cloned()
            .unwrap_or_else(|| crate::spec::stem(&source.name)),
        units: units?,
        theory: raw.theory.clone(),
        rails,
        blocks,
        certificate,
        effects,
        critical: raw.critical_factor.map(|given| match given {
            RawCritical::At(factor) => GridCritical::At(factor),
            RawCritical::Above { above } => GridCritical::Above(above),
        }),
        notes: raw.notes.clone(),
    })
}

fn read_rails(raw: &RawGrid, root: &Place<'_>, faults: &mut Faults) -> Vec<GridRail> {
    let list = root.key("rails");
    let mut rails: Vec<GridRail> = Vec::new();
    let given = faults
        .require(&raw.rails, root, "rails")
        .map(Vec::as_slice)
        .unwrap_or_default();
    for (index, raw) in given.iter().enumerate() {
        let at = list.index(index);
        let name = faults
            .require(&raw.name, &at, "name")
            .cloned()
            .unwrap_or_default();
        let stations = faults
            .require(&raw.stations, &at, "stations")
            .cloned()
            .unwrap_or_default();
        faults.increasing(&stations, &at.key("stations"));
        check_free_name(&name, &at.key("name"), faults);
        if rails.iter().any(|rail| rail.name == name) {
            faults.add(
                Fault::new(&at.key("name"), "must differ from the other rails")
                    .got(format!("\"{name}\"")),
            );
        }
        rails.push(GridRail { name, stations });
    }
    if rails.iter().all(|rail| rail.stations.is_empty()) && faults.0.is_empty() {
        faults.add(Fault::new(&list, "must have at least one station"));
    }
    rails
}

/// The matrix of `rows`; a fault if it is not `size` x `size`.
fn square(
    rows: &[Vec<f64>],
    size: usize,
    place: &Place<'_>,
    faults: &mut Faults,
) -> Option<DMatrix<f64>> {
    if rows.len() != size {
        let fault = Fault::new(
            place,
            format!("must have {size} rows, one for each station"),
        )
        .got(rows.len());
        faults.add(fault);
        return None;
    }
    let wrong = rows.iter().position(|row| row.len() != size);
    if let Some(row) = wrong {
        let fault = Fault::new(
            &place.index(row),
            format!("must have {size} numbers, one for each station"),
        );
        faults.add(fault.got(rows[row].len()));
        return None;
    }
    Some(DMatrix::from_fn(size, size, |row, column| {
        rows[row][column]
    }))
}

/// Adds a fault at the first pair of unequal entries. A direct block is symmetric by Maxwell's reciprocity.
fn symmetric(block: &DMatrix<f64>, place: &Place<'_>, faults: &mut Faults) {
    for row in 0..block.nrows() {
        for column in 0..row {
            if block[(row, column)] != block[(column, row)] {
                let line = place.index(row);
                let expected = format!(
                    "must be symmetric: [{column}][{row}] is {}",
                    number(block[(column, row)])
                );
                let fault =
                    Fault::new(&line.index(column), expected).got(number(block[(row, column)]));
                faults.add(fault.hint(
                    "a displacement at i due to a load at j equals that at j due to the same load at i",
                ));
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::effects::{Effects, Reaction, ReactionPoint, SectionForces};
    use crate::spec::CutPlace;
    use crate::units::{Force, Length};
    use splines::Axis;

    fn grid() -> StationGrid {
        let block = DMatrix::from_row_slice(2, 2, &[1.0 / 3.0 * 1e-8, 2.5e-310, 2.5e-310, 1e-7]);
        StationGrid {
            name: "two \"stations\"".to_owned(),
            units: Units {
                length: Length::Foot,
                force: Force::Kip,
            },
            theory: Some("timoshenko".to_owned()),
            rails: vec![GridRail {
                name: "north".to_owned(),
                stations: vec![0.1, 0.30000000000000004],
            }],
            blocks: vec![
                (GridBlock::Vertical, block.clone()),
                (GridBlock::VerticalLateral, block * 2.0),
            ],
            certificate: Some(Certificate {
                condition: 12.5,
                error_bound: 1.0 / 7.0,
                extended: true,
            }),
            effects: None,
            critical: None,
            notes: vec!["no longitudinal grids".to_owned()],
        }
    }

    fn source(text: String) -> Source {
        Source {
            name: "grid.json".to_owned(),
            text,
        }
    }

    #[test]
    fn what_is_written_is_read_back_bit_for_bit() {
        let mut given = grid();
        given
            .blocks
            .insert(1, (GridBlock::Lateral, given.blocks[0].1.clone()));
        let lines = |k: f64| {
            vec![
                (Axis::Vertical, vec![k / 3.0, -1.0]),
                (Axis::Lateral, vec![0.1 * k, 0.0]),
            ]
        };
        let reaction = |at, spring| Reaction {
            at,
            dof: "uy".to_owned(),
            spring,
            lines: lines(1.0),
        };
        let section = |at| SectionForces {
            name: "mid \"span\"".to_owned(),
            at,
            lines: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(lines),
        };
        given.effects = Some(Effects {
            reactions: vec![
                reaction(ReactionPoint::Point(3), None),
                reaction(ReactionPoint::Along(0.1), Some(2)),
            ],
            sections: vec![
                section(CutPlace::Cell([1, 2], 0.3)),
                section(CutPlace::Along(1.0 / 3.0)),
            ],
        });
        for grid in [grid(), given] {
            let (read, surface) = read(&source(write(&grid, None))).expect("our own file");
            assert_eq!(read, grid);
            assert!(surface.is_none());
        }
    }

    #[test]
    fn an_unsymmetric_direct_grid_is_refused_by_its_first_pair() {
        let mut given = grid();
        given.blocks[0].1[(1, 0)] = f64::from_bits(2.5e-310f64.to_bits() + 1);
        let wrong = read(&source(write(&given, None))).expect_err("one bit differs");
        assert_eq!(wrong.len(), 1);
        assert_eq!(wrong[0].path, "influence.vertical[1][0]");
    }

    #[test]
    fn a_block_of_another_size_than_the_stations_is_refused() {
        let mut given = grid();
        given.rails[0].stations.push(0.5);
        let wrong = read(&source(write(&given, None))).expect_err("three stations, two rows");
        let paths: Vec<&str> = wrong.iter().map(|found| found.path.as_str()).collect();
        assert_eq!(paths, ["influence.vertical", "influence.vertical_lateral"]);
    }
}
