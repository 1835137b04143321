//! From FE results to foundations: the transfer of data that used to be done by hand.

mod error;
mod ladder;
mod modal;
mod mount;
mod parts;
mod solved;

use std::sync::Arc;

use fea::Frame;
use nalgebra::DMatrix;
use sim::{Extent, Foundation};
use splines::{Axis, Couplings, Influence, Kind, Parted, Probe, Reading, Sheet, Table};

use self::modal::Dampers;
use self::mount::Excitation;
use formats::grid::axes;
use formats::scene::{self, Handover, Origin, Structure};

pub use error::Error;
pub use ladder::{
    AutoRun, excited_modes, fidelity_name, foundation_at, mesh_elements, select_and_run, selection_doubt,
    selection_reason,
};
pub use modal::ModeCache;
pub use mount::mount;
pub use parts::{RigidParts, roll_inertia};
pub use solved::{
    Solution, SolvedStructure, SystemSize, distinct_specs, solution_of, solve, solve_specs, solve_to,
};

/// A foundation, with the model behind its freedoms.
pub struct BuiltFoundation {
    /// What carries the rails.
    pub foundation: Foundation,
    /// What moves; `None`: nothing that has mass.
    pub motion: Option<MotionBasis>,
}

impl From<Foundation> for BuiltFoundation {
    fn from(foundation: Foundation) -> BuiltFoundation {
        BuiltFoundation { foundation, motion: None }
    }
}

/// The model whose motions are the freedoms of a foundation, in their order.
pub enum MotionBasis {
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
pub fn build(
    spectra: &mut ModeCache,
    structure: &Structure,
    solved: Option<&Solution>,
    lateral: bool,
) -> Result<BuiltFoundation, Error> {
    let irregularities = structure.irregularities.clone();
    let mut on = mount::mount(structure)?;
    let is_dragged = structure.longitudinal;
    let BuiltFoundation { mut foundation, motion } = build_on_ground(spectra, structure, solved, lateral)?;
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
            return Err(Error::NoLongitudinal { structure: structure.name.clone() });
        }
    }
    Ok(BuiltFoundation { foundation: Foundation { on, irregularities, is_dragged, ..foundation }, motion })
}

/// The same, without what carries it.
fn build_on_ground(
    spectra: &mut ModeCache,
    structure: &Structure,
    solved: Option<&Solution>,
    lateral: bool,
) -> Result<BuiltFoundation, Error> {
    let extents = || {
        let extent =
            |rail: &formats::spec::RailOutline| Extent { range: Some(rail.range), breaks: Vec::new() };
        structure.rails.iter().map(extent).collect::<Vec<_>>()
    };
    let push = Excitation { lateral, longitudinal: structure.longitudinal, on: structure.on };
    match structure.foundation {
        scene::Foundation::Rigid => Ok(Foundation { rails: extents(), ..Foundation::rigid() }.into()),
        scene::Foundation::Influence => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Parts { count, handover, damping } => {
            let girder = solved
                .and_then(|solved| solved.girder.as_ref())
                .ok_or_else(|| Error::NoGirder { structure: structure.name.clone() })?;
            parts::foundation(girder, count, handover, damping, push)
        }
        scene::Foundation::Modal { modes, damping } => spectra.lowest(
            &structure.name,
            required_solution(structure, solved)?,
            modes,
            damping,
            Dampers::NONE,
            push,
        ),
        scene::Foundation::Full { elements, damping } => spectra.full(
            &structure.name,
            required_solution(structure, solved)?,
            elements,
            damping,
            Dampers::NONE,
            push,
        ),
        scene::Foundation::Ties { moves: false, .. } => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Ties { moves: true, modes, damping, c } => {
            let pads = match &structure.origin {
                Origin::Spec { spec, .. } => spec.pads(),
                Origin::Tables { .. } => &[],
            };
            let (name, dampers) = (&structure.name, Dampers { pads, c });
            let solved = required_solution(structure, solved)?;
            match modes {
                Some(count) => spectra.lowest(name, solved, count, damping, dampers, push),
                // the mesh as it is
                None => spectra.full(name, solved, 1, damping, dampers, push),
            }
        }
    }
}

fn required_solution<'s>(structure: &Structure, solved: Option<&'s Solution>) -> Result<&'s Solution, Error> {
    solved.ok_or_else(|| Error::NoSpec { structure: structure.name.clone() })
}

fn influence(structure: &Structure, solved: Option<&Solution>) -> Result<Foundation, Error> {
    let rails = structure.rails.len();
    let exact = structure.reading == scene::Reading::Exact;
    if let (true, Some(surface)) = (exact, solved.and_then(|solved| solved.surface.as_ref())) {
        let surface = surface.clone();
        return Ok(match structure.couplings {
            Couplings::All => Foundation::influence(Box::new(surface), rails),
            some => Foundation::influence(Box::new(Parted::new(surface, some)), rails),
        });
    }
    let sheets = influence_blocks(structure, solved)?;
    let kind = match structure.reading {
        // A table of values alone has no exact form; its natural splines are the closest reading.
        scene::Reading::Exact | scene::Reading::Natural => Kind::Natural,
        scene::Reading::Akispl => Kind::Akispl,
        scene::Reading::Cubspl => Kind::Cubspl,
    };
    let reading = Reading::new(kind, &sheets).map_err(Error::rails(&structure.name))?;
    Ok(Foundation::influence(Box::new(reading), rails))
}

/// The tables of a structure: its direct grids and the couplings that count, station by station.
///
/// # Errors
/// A spec that has not been solved; what a table refuses.
pub fn influence_blocks(structure: &Structure, solved: Option<&Solution>) -> Result<Vec<Sheet>, Error> {
    let mut sheets = Vec::new();
    let mut add = |row: (usize, Axis), column: (usize, Axis), stations: [&[f64]; 2], values: DMatrix<f64>| {
        let probe = |(rail, axis)| Probe { rail, x: 0.0, axis };
        if !structure.couplings.keep(&probe(row), &probe(column)) {
            return Ok(());
        }
        let [at, loads] = stations.map(<[f64]>::to_vec);
        let table = Table::new(loads, at, values).map_err(Error::rails(&structure.name))?;
        sheets.push(Sheet { deflection: row, load: column, table });
        Ok::<(), Error>(())
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
            return Err(Error::Unsolved { structure: structure.name.clone() });
        }
    }
    Ok(sheets)
}

/// A girder as massless rigid parts with one contact a wheel on a datum blended over `window` (none: from centre
/// to centre): see [`sim::BlendedParts`].
///
/// # Errors
/// A girder that does not stand; windows that overlap.
pub fn rigid_parts(girder: &fea::Girder, count: usize, window: Option<f64>) -> Result<Foundation, Error> {
    Ok(parts::foundation(girder, count, Handover::Blend { length: window }, 0.0, Excitation::DOWN)?
        .foundation)
}

/// Every mode that vertical wheel forces can excite of a mesh of `elements` elements a member, undamped.
///
/// # Errors
/// A structure without mass; too many unknowns.
pub fn full_mesh(solved: &Solution, elements: usize) -> Result<Foundation, Error> {
    Ok(ModeCache::default()
        .full("structure", solved, elements, 0.0, Dampers::NONE, Excitation::DOWN)?
        .foundation)
}

fn window(handover: Handover) -> Option<f64> {
    match handover {
        Handover::Blend { length } | Handover::PerPart { length } => length,
    }
}
