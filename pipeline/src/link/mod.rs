//! From FE results to foundations: the transfer of data that used to be done by hand.

mod ladder;
mod modal;
mod mount;
mod parts;
mod rest;

use std::sync::Arc;

use fea::Frame;
use nalgebra::DMatrix;
use sim::{Extent, Foundation};
use splines::{Axis, Couplings, Influence, Kind, Parted, Probe, Reading, Sheet, Surface, Table};

use self::modal::Dampers;
use self::mount::Push;
use crate::exit::Failure;
use crate::grid::{Grid, axes};
use crate::scene::{self, Handover, Origin, Structure};
use crate::spec::Spec;

pub use ladder::{Chosen, Trouble, choose, doubt, elements, modes_of, reason, rung_of, word};
pub use modal::Spectra;
pub use mount::mount;
pub use parts::{RigidParts, roll_inertia};

/// A structure's FE model, solved.
pub struct Solved {
    /// The model.
    pub model: fea::Model,
    /// Its rails.
    pub rails: Vec<fea::Rail>,
    /// Exact influence surface; `None` where it is larger than asked for.
    pub surface: Option<Surface>,
    /// Grids at the stations.
    pub grid: Grid,
    /// The girder, where the structure is one.
    pub girder: Option<fea::Girder>,
    /// How large the system was; `None` where it was solved by an earlier run.
    pub size: Option<Size>,
}

/// Size of a system of equations.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// Unknown freedoms.
    pub unknowns: usize,
    /// Bytes of its factor.
    pub bytes: u64,
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} unknowns, a factor of {:.3} MB", self.unknowns, self.bytes as f64 / 1e6)
    }
}

/// Solves a spec: grid at its stations and exact surface.
///
/// # Errors
/// An entry that cannot be used, a mechanism, or numbers that cannot be trusted.
pub fn solve(spec: &Spec) -> Result<Solved, fea::Error> {
    solve_to(spec, fea::ACCURACY, usize::MAX)
}

/// The same, with compliances whose relative error bound is at most `accuracy`, and without a surface of more than
/// `most` freedoms.
///
/// # Errors
/// As [`solve`].
pub fn solve_to(spec: &Spec, accuracy: f64, most: usize) -> Result<Solved, fea::Error> {
    let (model, rails) = spec.model()?;
    let frame = Frame::accurate(&model, &rails, accuracy)?;
    let mut grid = Grid::of(spec, &frame)?.with_effects(spec, &model, &frame)?;
    let freedoms = 6 * frame.line()?.states();
    let surface = if freedoms <= most {
        Some(frame.surface()?.surface)
    } else {
        grid.notes.push(format!(
            "no surface: the compliance of {freedoms} freedoms at the ends of the rails' cells is too large for a file"
        ));
        None
    };
    let size = Some(Size { unknowns: frame.unknowns(), bytes: frame.bytes() });
    Ok(Solved { model, rails, surface, grid, girder: spec.girder().cloned(), size })
}

/// A foundation, with the model behind its freedoms.
pub struct Laid {
    /// What carries the rails.
    pub foundation: Foundation,
    /// What moves; `None`: nothing that has mass.
    pub motion: Option<Motion>,
}

impl From<Foundation> for Laid {
    fn from(foundation: Foundation) -> Laid {
        Laid { foundation, motion: None }
    }
}

/// The model whose motions are the freedoms of a foundation, in their order.
pub enum Motion {
    /// Natural modes of a frame, with its members cut, as far as wheels can excite them.
    Modes {
        /// The frame.
        frame: Arc<Frame>,
        /// Its modes.
        refined: Box<fea::Refined>,
    },
    /// Rigid parts of a straight girder.
    Parts(RigidParts),
}

/// What carries the rails of one structure of a scene, and the model behind it; modes that are known already stand in
/// `spectra`, `lateral`: whether wheels push sideways.
///
/// # Errors
/// What the tables or the FE model refuse.
pub fn laid(
    spectra: &mut Spectra,
    structure: &Structure,
    solved: Option<&Solved>,
    lateral: bool,
) -> Result<Laid, Failure> {
    let irregularities = structure.irregularities.clone();
    let mut on = mount::mount(structure)?;
    let is_dragged = structure.longitudinal;
    let Laid { mut foundation, motion } = grounded(spectra, structure, solved, lateral)?;
    if let (Some(on), Some(own)) = (&mut on, foundation.on.take()) {
        (on.mass, on.coupling) = (own.mass, own.coupling);
    }
    if let (true, Some(compliance), Some(rail)) =
        (is_dragged, &foundation.compliance, structure.rails.first())
    {
        let probe = Probe { rail: 0, x: rail.range[0], axis: Axis::Longitudinal };
        let mut give = Influence::zeros(1);
        let known = compliance.fill(&[probe], &mut give).is_ok() && give.value[(0, 0)].is_finite();
        if !known {
            let why = "its give along the rails is not known  hint: leave `longitudinal` out";
            return Err(Failure::Untrusted(format!("{}: {why}", structure.name)));
        }
    }
    Ok(Laid { foundation: Foundation { on, irregularities, is_dragged, ..foundation }, motion })
}

/// The same, without what carries it.
fn grounded(
    spectra: &mut Spectra,
    structure: &Structure,
    solved: Option<&Solved>,
    lateral: bool,
) -> Result<Laid, Failure> {
    let extents = || {
        let extent = |rail: &crate::spec::RailOutline| Extent { range: Some(rail.range), breaks: Vec::new() };
        structure.rails.iter().map(extent).collect::<Vec<_>>()
    };
    let push = Push { lateral, longitudinal: structure.longitudinal, on: structure.on };
    match structure.foundation {
        scene::Foundation::Rigid => Ok(Foundation { rails: extents(), ..Foundation::rigid() }.into()),
        scene::Foundation::Influence => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Parts { count, handover, damping } => {
            let girder = solved.and_then(|solved| solved.girder.as_ref()).ok_or_else(|| {
                Failure::Untrusted(format!("{}: parts need a beam spec of a straight girder", structure.name))
            })?;
            parts::foundation(girder, count, handover, damping, push)
        }
        scene::Foundation::Modal { modes, damping } => {
            spectra.lowest(&structure.name, needed(structure, solved)?, modes, damping, Dampers::NONE, push)
        }
        scene::Foundation::Full { elements, damping } => {
            spectra.full(&structure.name, needed(structure, solved)?, elements, damping, Dampers::NONE, push)
        }
        scene::Foundation::Ties { moves: false, .. } => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Ties { moves: true, modes, damping, c } => {
            let pads = match &structure.origin {
                Origin::Spec { spec, .. } => spec.pads(),
                Origin::Tables { .. } => &[],
            };
            let (name, dampers) = (&structure.name, Dampers { pads, c });
            let solved = needed(structure, solved)?;
            match modes {
                Some(count) => spectra.lowest(name, solved, count, damping, dampers, push),
                // the mesh as it is
                None => spectra.full(name, solved, 1, damping, dampers, push),
            }
        }
    }
}

fn needed<'s>(structure: &Structure, solved: Option<&'s Solved>) -> Result<&'s Solved, Failure> {
    let none = || Failure::Untrusted(format!("{}: modes need a beam spec", structure.name));
    solved.ok_or_else(none)
}

fn influence(structure: &Structure, solved: Option<&Solved>) -> Result<Foundation, Failure> {
    let rails = structure.rails.len();
    let exact = structure.reading == scene::Reading::Exact;
    if let (true, Some(surface)) = (exact, solved.and_then(|solved| solved.surface.as_ref())) {
        let surface = surface.clone();
        return Ok(match structure.couplings {
            Couplings::All => Foundation::influence(Box::new(surface), rails),
            some => Foundation::influence(Box::new(Parted::new(surface, some)), rails),
        });
    }
    let sheets = sheets(structure, solved)?;
    let kind = match structure.reading {
        // A table of values alone has no exact form; its natural splines are the closest reading.
        scene::Reading::Exact | scene::Reading::Natural => Kind::Natural,
        scene::Reading::Akispl => Kind::Akispl,
        scene::Reading::Cubspl => Kind::Cubspl,
    };
    let reading = Reading::new(kind, &sheets).map_err(|error| failure(&structure.name, &error))?;
    Ok(Foundation::influence(Box::new(reading), rails))
}

/// The tables of a structure: its direct grids and the couplings that count, station by station.
///
/// # Errors
/// A spec that has not been solved; what a table refuses.
pub fn sheets(structure: &Structure, solved: Option<&Solved>) -> Result<Vec<Sheet>, Failure> {
    let mut sheets = Vec::new();
    let mut add = |row: (usize, Axis), column: (usize, Axis), stations: [&[f64]; 2], values: DMatrix<f64>| {
        let probe = |(rail, axis)| Probe { rail, x: 0.0, axis };
        if !structure.couplings.keep(&probe(row), &probe(column)) {
            return Ok(());
        }
        let [at, loads] = stations.map(<[f64]>::to_vec);
        let table = Table::new(loads, at, values).map_err(|error| failure(&structure.name, &error))?;
        sheets.push(Sheet { deflection: row, load: column, table });
        Ok::<(), Failure>(())
    };
    match (&structure.origin, solved) {
        (Origin::Tables { tables, .. }, _) => {
            for (axis, values) in [(Axis::Vertical, &tables.vertical), (Axis::Lateral, &tables.lateral)] {
                if let Some(values) = values {
                    let n = tables.stations.len();
                    let matrix = DMatrix::from_fn(n, n, |i, j| values[i][j]);
                    add((0, axis), (0, axis), [&tables.stations; 2], matrix)?;
                }
            }
        }
        (Origin::Spec { .. }, Some(solved)) => {
            let mut first = 0;
            for (r, row) in solved.rails.iter().enumerate() {
                let mut left = 0;
                for (c, column) in solved.rails.iter().enumerate() {
                    let stations: [&[f64]; 2] = [&row.stations, &column.stations];
                    let size = stations.map(<[f64]>::len);
                    for (quantity, grid) in &solved.grid.blocks {
                        let (a, b) = axes(*quantity);
                        // one of (row, column) and (column, row) is enough where both are the same block
                        if a != b || r <= c {
                            let block = grid.view((first, left), (size[0], size[1])).into_owned();
                            add((r, a), (c, b), stations, block)?;
                        }
                    }
                    left += column.stations.len();
                }
                first += row.stations.len();
            }
        }
        (Origin::Spec { .. }, None) => {
            return Err(Failure::Untrusted(format!("{}: its beam spec has not been solved", structure.name)));
        }
    }
    Ok(sheets)
}

/// A girder as massless rigid parts with one contact a wheel on a datum blended over `window` (none: from centre
/// to centre): see [`sim::BlendedParts`].
///
/// # Errors
/// A girder that does not stand; windows that overlap.
pub fn parts_of(girder: &fea::Girder, count: usize, window: Option<f64>) -> Result<Foundation, Failure> {
    Ok(parts::foundation(girder, count, Handover::Blend { length: window }, 0.0, Push::DOWN)?.foundation)
}

/// Every mode that vertical wheel forces can excite of a mesh of `elements` elements a member, undamped.
///
/// # Errors
/// A structure without mass; too many unknowns.
pub fn full_of(solved: &Solved, elements: usize) -> Result<Foundation, Failure> {
    Ok(Spectra::default().full("structure", solved, elements, 0.0, Dampers::NONE, Push::DOWN)?.foundation)
}

fn failure(name: &str, error: &splines::Error) -> Failure {
    Failure::Untrusted(format!("{name}: {error}"))
}

fn window(handover: Handover) -> Option<f64> {
    match handover {
        Handover::Blend { length } | Handover::PerPart { length } => length,
    }
}
