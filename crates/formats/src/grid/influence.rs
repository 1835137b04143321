//! Influence coefficients of a structure between its stations.

use fea::{Certificate, CriticalFactor, FactoredFrame, Model};
use nalgebra::DMatrix;
use splines::{Axis, Probe};

use super::block::{GridBlock, axes};
use super::effects::Effects;
use crate::spec::{Spec, theory_word};
use crate::units::Units;

/// Influence coefficients between all stations of all rails of a structure: G(i, j) is the displacement of station i
/// under a unit load at station j.
///
/// With n stations in total, numbered rail after rail, each block is an n x n matrix in length per force. Its rows
/// are the stations of the displacement, its columns the stations of the unit load. Displacements and loads are
/// positive along +x, upwards and to the right.
///
/// ```
/// use formats::grid::{StationGrid, GridBlock};
/// use formats::grid::file as grid_file;
/// use formats::text::source::Source;
/// use formats::spec::Spec;
///
/// let text = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "N", "time": "s"},
///  "theory": "euler-bernoulli", "stations": [3, 5],
///  "girder": {"spans": [10], "E": 2e11, "I_vertical": 1e-4}}"#;
/// let spec = Spec::read(&Source { name: "beam.json".to_owned(), text: text.to_owned() }, None)
///     .expect("a beam on two supports");
/// let (model, rails) = spec.model().expect("a model of it");
/// let frame = fea::FactoredFrame::new(&model, &rails).expect("a stable structure");
/// let grid = StationGrid::of(&spec, &frame).expect("stations on the rail");
///
/// // at midspan L^3 / (48 EI)
/// let vertical = grid.block(GridBlock::Vertical).expect("the supports resist vertical loads");
/// assert!((vertical[(1, 1)] * 48.0 * 2e11 * 1e-4 / 1e3 - 1.0).abs() < 1e-12);
///
/// let file = Source { name: "grid.json".to_owned(), text: grid_file::write(&grid, None) };
/// assert_eq!(grid_file::read(&file).expect("our own file").0, grid);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StationGrid {
    /// Name of the structure.
    pub name: String,
    /// Units of all numbers.
    pub units: Units,
    /// Keyword of the beam theory, if known.
    pub theory: Option<String>,
    /// The rails, in the order of rows and columns.
    pub rails: Vec<GridRail>,
    /// The blocks of the directions in which every rail is supported.
    pub blocks: Vec<(GridBlock, DMatrix<f64>)>,
    /// Condition number of the stiffness matrix and bound of the relative error, if known.
    pub certificate: Option<Certificate>,
    /// Reactions and internal forces per unit load, if known.
    pub effects: Option<Effects>,
    /// The smallest factor on the preload of the structure at which its stiffness is singular; `None` without preload.
    pub critical: Option<GridCritical>,
    /// Remarks for the user, such as the reason why a block is missing.
    pub notes: Vec<String>,
}

/// The critical factor of a preload: of axial forces alone, without lateral-torsional buckling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GridCritical {
    /// The factor.
    At(f64),
    /// None up to this one.
    Above(f64),
}

/// A rail of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridRail {
    /// Its name.
    pub name: String,
    /// Coordinates of its stations along the rail, increasing.
    pub stations: Vec<f64>,
}

impl StationGrid {
    /// Computes the influence coefficients between the stations of `spec` from the factored `frame`.
    ///
    /// Blocks of a direction in which some rail is not restrained are omitted, and a note is added.
    ///
    /// # Errors
    /// A station for which the frame has no solution, such as one beyond the end of its rail.
    pub fn of(spec: &Spec, frame: &FactoredFrame) -> Result<StationGrid, fea::Error> {
        let rails = spec.rails();
        let lists = rails.iter().map(|rail| rail.stations.as_slice());
        let stations = listed(lists);
        let resisted: Vec<Axis> = [Axis::Vertical, Axis::Lateral, Axis::Longitudinal]
            .into_iter()
            .filter(|axis| (0..rails.len()).all(|rail| frame.resists(rail, *axis)))
            .collect();
        let probes: Vec<Probe> = resisted
            .iter()
            .flat_map(|axis| {
                stations.iter().map(|(rail, x)| Probe {
                    rail: *rail,
                    x: *x,
                    axis: *axis,
                })
            })
            .collect();
        let solved = frame.grid(&probes)?;
        let n = stations.len();
        let start = |axis: Axis| {
            resisted
                .iter()
                .position(|known| *known == axis)
                .map(|index| index * n)
        };
        let mut blocks = Vec::new();
        let mut notes = Vec::new();
        for quantity in GridBlock::ALL {
            let (row, column) = axes(quantity);
            if let (Some(row), Some(column)) = (start(row), start(column)) {
                blocks.push((
                    quantity,
                    solved.value.view((row, column), (n, n)).into_owned(),
                ));
            }
        }
        for axis in [Axis::Vertical, Axis::Lateral, Axis::Longitudinal] {
            if start(axis).is_none() {
                let word = direction(axis);
                notes.push(format!(
                    "no {word} grids: the structure has no {word} stiffness on at least one rail"
                ));
            }
        }
        Ok(StationGrid {
            name: spec.name.clone(),
            units: spec.units,
            theory: Some(theory_word(spec.theory).to_owned()),
            rails: rails
                .into_iter()
                .map(|rail| GridRail {
                    name: rail.name,
                    stations: rail.stations,
                })
                .collect(),
            blocks,
            certificate: Some(solved.certificate),
            effects: None,
            critical: None,
            notes,
        })
    }

    /// Adds the critical factor of the preload of `spec`, with a note of its mode.
    ///
    /// # Errors
    /// As [`Spec::preloaded`].
    pub fn with_critical_factor(mut self, spec: &Spec) -> Result<StationGrid, fea::Error> {
        let Some(state) = spec.preloaded()? else {
            return Ok(self);
        };
        let reach =
            "for the preloaded state; axial forces only, lateral-torsional buckling not included";
        let (critical, note) = match &state.critical {
            CriticalFactor::At(factor, mode) => {
                let mode = spec.buckling_words(&mode.most);
                (
                    GridCritical::At(*factor),
                    format!("critical factor {factor:.6}: {mode} ({reach})"),
                )
            }
            CriticalFactor::Above(most) => (
                GridCritical::Above(*most),
                format!("no critical factor up to {most:e} ({reach})"),
            ),
        };
        self.critical = Some(critical);
        self.notes.push(note);
        Ok(self)
    }

    /// Adds the influence lines of reactions and internal forces, computed from the frame and its model.
    ///
    /// # Errors
    /// A station for which the frame has no solution.
    pub fn with_effects(
        self,
        spec: &Spec,
        model: &Model,
        frame: &FactoredFrame,
    ) -> Result<StationGrid, fea::Error> {
        let direct = [
            GridBlock::Vertical,
            GridBlock::Lateral,
            GridBlock::Longitudinal,
        ];
        let resisted: Vec<Axis> = direct
            .into_iter()
            .filter(|q| self.block(*q).is_some())
            .map(|q| axes(q).0)
            .collect();
        let effects = Effects::of(spec, model, frame, &self.stations(), &resisted)?;
        Ok(StationGrid {
            effects: Some(effects),
            ..self
        })
    }

    /// Index of the rail and coordinate of every station, in the order of rows and columns.
    #[must_use]
    pub fn stations(&self) -> Vec<(usize, f64)> {
        listed(self.rails.iter().map(|rail| rail.stations.as_slice()))
    }

    /// One block; `None` if it is missing in the grid.
    #[must_use]
    pub fn block(&self, quantity: GridBlock) -> Option<&DMatrix<f64>> {
        self.blocks
            .iter()
            .find(|(known, _)| *known == quantity)
            .map(|(_, block)| block)
    }

    /// Total number n of stations of all rails.
    #[must_use]
    pub fn size(&self) -> usize {
        self.rails.iter().map(|rail| rail.stations.len()).sum()
    }
}

/// Index of the rail and coordinate of every station, from the stations of each rail.
fn listed<'r>(rails: impl Iterator<Item = &'r [f64]>) -> Vec<(usize, f64)> {
    rails
        .enumerate()
        .flat_map(|(index, stations)| stations.iter().map(move |x| (index, *x)))
        .collect()
}

/// Name of a direction in notes.
const fn direction(axis: Axis) -> &'static str {
    match axis {
        Axis::Longitudinal => "longitudinal",
        Axis::Vertical => "vertical",
        Axis::Lateral => "lateral",
    }
}
