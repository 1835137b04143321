//! Influence grids of a structure at its stations.

use fea::{Certificate, Frame, Model};
use nalgebra::DMatrix;
use splines::{Axis, Probe};

use crate::block::GridBlock;
use crate::effect::Effects;
use crate::spec::{RailOutline, Spec, theory_word};
use crate::units::Units;

/// Influence coefficients between all stations of all rails of a structure.
///
/// With n stations in all, rails one after the other, each block is n x n: row = station of the displacement,
/// column = station of the unit load. Positive along +x, up and to the right.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Name of the structure.
    pub name: String,
    /// Units of all numbers.
    pub units: Units,
    /// Beam theory, where one is known.
    pub theory: Option<String>,
    /// Rails: name and stations.
    pub rails: Vec<GridRail>,
    /// The blocks that the structure resists.
    pub blocks: Vec<(GridBlock, DMatrix<f64>)>,
    /// How far to trust the numbers, where that is known.
    pub certificate: Option<Certificate>,
    /// Reactions and internal forces per unit load, where they are known.
    pub effects: Option<Effects>,
    /// What a reader should know, such as why a block is absent.
    pub notes: Vec<String>,
}

/// A rail of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridRail {
    /// Its name.
    pub name: String,
    /// Its stations, increasing.
    pub stations: Vec<f64>,
}

/// Directions of displacement and load of a block.
#[must_use]
pub const fn axes(quantity: GridBlock) -> (Axis, Axis) {
    match quantity {
        GridBlock::Vertical => (Axis::Vertical, Axis::Vertical),
        GridBlock::Lateral => (Axis::Lateral, Axis::Lateral),
        GridBlock::Longitudinal => (Axis::Longitudinal, Axis::Longitudinal),
        GridBlock::VerticalLateral => (Axis::Vertical, Axis::Lateral),
        GridBlock::VerticalLongitudinal => (Axis::Vertical, Axis::Longitudinal),
        GridBlock::LateralLongitudinal => (Axis::Lateral, Axis::Longitudinal),
    }
}

impl Grid {
    /// The grids of a spec from its factored frame.
    ///
    /// Blocks of directions that some rail does not resist are left out, with a note.
    ///
    /// # Errors
    /// A station where the frame gives no answer.
    pub fn of(spec: &Spec, frame: &Frame) -> Result<Grid, fea::Error> {
        let rails = spec.rails();
        let stations = stations(&rails);
        let resisted: Vec<Axis> = [Axis::Vertical, Axis::Lateral, Axis::Longitudinal]
            .into_iter()
            .filter(|axis| (0..rails.len()).all(|rail| frame.available(rail, *axis)))
            .collect();
        let probes: Vec<Probe> = resisted
            .iter()
            .flat_map(|axis| stations.iter().map(|(rail, x)| Probe { rail: *rail, x: *x, axis: *axis }))
            .collect();
        let solved = frame.grid(&probes)?;
        let n = stations.len();
        let start = |axis: Axis| resisted.iter().position(|known| *known == axis).map(|index| index * n);
        let mut blocks = Vec::new();
        let mut notes = Vec::new();
        for quantity in GridBlock::ALL {
            let (row, column) = axes(quantity);
            if let (Some(row), Some(column)) = (start(row), start(column)) {
                blocks.push((quantity, solved.value.view((row, column), (n, n)).into_owned()));
            }
        }
        for axis in [Axis::Vertical, Axis::Lateral, Axis::Longitudinal] {
            if start(axis).is_none() {
                let word = direction(axis);
                notes.push(format!(
                    "no {word} grids: the structure does not resist {word} loads at every rail"
                ));
            }
        }
        Ok(Grid {
            name: spec.name.clone(),
            units: spec.units,
            theory: Some(theory_word(spec.theory).to_owned()),
            rails: rails
                .into_iter()
                .map(|rail| GridRail { name: rail.name, stations: rail.stations })
                .collect(),
            blocks,
            certificate: Some(solved.certificate),
            effects: None,
            notes,
        })
    }

    /// The same with reactions and internal forces per unit load, from the frame and its model.
    ///
    /// # Errors
    /// A station where the frame gives no answer.
    pub fn with_effects(self, spec: &Spec, model: &Model, frame: &Frame) -> Result<Grid, fea::Error> {
        let direct = [GridBlock::Vertical, GridBlock::Lateral, GridBlock::Longitudinal];
        let resisted: Vec<Axis> =
            direct.into_iter().filter(|q| self.block(*q).is_some()).map(|q| axes(q).0).collect();
        let effects = Effects::of(spec, model, frame, &stations(&spec.rails()), &resisted)?;
        Ok(Grid { effects: Some(effects), ..self })
    }

    /// Index of the rail and coordinate of every station.
    #[must_use]
    pub fn stations(&self) -> Vec<(usize, f64)> {
        let list = self.rails.iter().enumerate();
        list.flat_map(|(index, rail)| rail.stations.iter().map(move |x| (index, *x))).collect()
    }

    /// One block, where the structure resists both directions.
    #[must_use]
    pub fn block(&self, quantity: GridBlock) -> Option<&DMatrix<f64>> {
        self.blocks.iter().find(|(known, _)| *known == quantity).map(|(_, block)| block)
    }

    /// Number of stations in all.
    #[must_use]
    pub fn size(&self) -> usize {
        self.rails.iter().map(|rail| rail.stations.len()).sum()
    }
}

/// Index of the rail and coordinate of every station.
fn stations(rails: &[RailOutline]) -> Vec<(usize, f64)> {
    let list =
        rails.iter().enumerate().flat_map(|(index, rail)| rail.stations.iter().map(move |x| (index, *x)));
    list.collect()
}

const fn direction(axis: Axis) -> &'static str {
    match axis {
        Axis::Longitudinal => "longitudinal",
        Axis::Vertical => "vertical",
        Axis::Lateral => "lateral",
    }
}
