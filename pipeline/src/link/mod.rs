//! From FE results to foundations: the transfer of data that used to be done by hand.

mod parts;

use std::collections::BTreeMap;

use fea::{Certificate, Frame};
use nalgebra::DMatrix;
use sim::{Extent, Foundation};
use splines::{Axis, Kind, Probe, Reading, Sheet, Surface, Table};

use crate::exit::Failure;
use crate::scene::{self, Handover, Origin, Structure};
use crate::spec::{Form, Spec, Theory};

/// A structure's FE model, solved.
pub struct Solved {
    /// The model.
    pub model: fea::Model,
    /// Its rails.
    pub rails: Vec<fea::Rail>,
    /// Exact influence surface.
    pub surface: Surface,
    /// Probes of the grid: all stations of all rails, for each available direction.
    pub probes: BTreeMap<Axis, Vec<Probe>>,
    /// Grids by (row direction, column direction), in the order of `probes`; couplings once.
    pub grids: BTreeMap<(Axis, Axis), DMatrix<f64>>,
    /// How far to trust them.
    pub certificate: Certificate,
    /// The girder, where the structure is one.
    pub girder: Option<fea::Girder>,
}

/// The FE girder of a spec's short form.
#[must_use]
pub fn girder(spec: &Spec) -> fea::Girder {
    let Form::Girder(short) = &spec.form;
    fea::Girder {
        spans: short.spans.clone(),
        overhangs: short.overhangs,
        e: short.e,
        g: short.g,
        area: short.area,
        i_vertical: short.i_vertical,
        i_lateral: short.i_lateral,
        j: short.j,
        ka_vertical: short.ka_vertical,
        ka_lateral: short.ka_lateral,
        rail_height: short.rail_height,
        mass_per_length: short.mass_per_length,
        theory: match spec.theory {
            Theory::EulerBernoulli => fea::Theory::EulerBernoulli,
            Theory::Timoshenko => fea::Theory::Timoshenko,
        },
        stations: short.stations.clone(),
    }
}

/// Solves a spec: grid at its stations and exact surface.
///
/// # Errors
/// A mechanism, or numbers that cannot be trusted.
pub fn solve(spec: &Spec) -> Result<Solved, Failure> {
    let girder = girder(spec);
    let (model, rail) = girder.frame().map_err(untrusted)?;
    let rails = vec![rail];
    let frame = Frame::new(&model, &rails).map_err(untrusted)?;
    let exact = frame.surface().map_err(untrusted)?;
    let mut probes = BTreeMap::new();
    for axis in Axis::ALL {
        if (0..rails.len()).all(|rail| frame.available(rail, axis)) {
            let all = rails.iter().enumerate().flat_map(|(rail, outline)| {
                outline.stations.iter().map(move |&x| Probe { rail, x, axis })
            });
            probes.insert(axis, all.collect::<Vec<Probe>>());
        }
    }
    let at: Vec<Probe> = probes.values().flatten().copied().collect();
    let grid = frame.grid(&at).map_err(untrusted)?;
    let mut grids = BTreeMap::new();
    let stations = probes.values().next().map_or(0, Vec::len);
    for (r, &row) in probes.keys().enumerate() {
        for (c, &column) in probes.keys().enumerate() {
            let block = grid.value.view((r * stations, c * stations), (stations, stations)).into_owned();
            grids.insert((row, column), block);
        }
    }
    Ok(Solved { model, rails, surface: exact.surface, probes, grids, certificate: exact.certificate, girder: Some(girder) })
}

/// The foundation of one structure of a scene.
///
/// # Errors
/// What the tables or the FE model refuse.
pub fn foundation(structure: &Structure, solved: Option<&Solved>) -> Result<Foundation, Failure> {
    let extents = || {
        let extent = |rail: &crate::spec::RailOutline| Extent { range: Some(rail.range), breaks: Vec::new() };
        structure.rails.iter().map(extent).collect::<Vec<_>>()
    };
    match structure.foundation {
        scene::Foundation::Rigid => Ok(Foundation { rails: extents(), ..Foundation::rigid() }),
        scene::Foundation::Influence => influence(structure, solved),
        scene::Foundation::Parts { count, handover } => {
            let girder = solved.and_then(|solved| solved.girder.as_ref()).ok_or_else(|| {
                Failure::Untrusted(format!("{}: parts need a beam spec of a straight girder", structure.name))
            })?;
            parts::foundation(girder, count, handover)
        }
    }
}

fn influence(structure: &Structure, solved: Option<&Solved>) -> Result<Foundation, Failure> {
    let rails = structure.rails.len();
    let exact = structure.reading == scene::Reading::Exact;
    if let (true, Some(solved)) = (exact, solved) {
        return Ok(Foundation::influence(Box::new(solved.surface.clone()), rails));
    }
    let mut sheets = Vec::new();
    let mut add = |row: (usize, Axis), column: (usize, Axis), stations: [&[f64]; 2], values: DMatrix<f64>| {
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
                    for (&(a, b), grid) in solved.grids.iter().filter(|((a, b), _)| (r, a) <= (c, b)) {
                        let block = grid.view((first, left), (size[0], size[1])).into_owned();
                        add((r, a), (c, b), stations, block)?;
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
    let kind = match structure.reading {
        // A table of values alone has no exact form; its natural splines are the closest reading.
        scene::Reading::Exact | scene::Reading::Natural => Kind::Natural,
        scene::Reading::Akispl => Kind::Akispl,
        scene::Reading::Cubspl => Kind::Cubspl,
    };
    let reading = Reading::new(kind, &sheets).map_err(|error| failure(&structure.name, &error))?;
    Ok(Foundation::influence(Box::new(reading), rails))
}

pub(crate) fn untrusted(error: fea::Error) -> Failure {
    Failure::Untrusted(error.to_string())
}

fn failure(name: &str, error: &splines::Error) -> Failure {
    Failure::Untrusted(format!("{name}: {error}"))
}

fn window(handover: Handover) -> Option<f64> {
    match handover {
        Handover::Blend { length } | Handover::PerPart { length } => length,
    }
}
