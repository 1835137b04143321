//! Deflections of the points of all rails of a structure: places that stay, prepared once for all rows.

use std::ops::Range;

use sim::Foundation;
use splines::{Axis, Probe};

use super::instants::{LoadState, LoadStates};
use super::sections::Sections;
use crate::response::{PlaceMotions, spread};

/// Signs of the deflections, downwards and along +z, in displacements, by plane.
pub(super) const DIRECTIONS: [f64; 2] = [-1.0, 1.0];
/// Number of rows at which lateral deflections are looked for.
const FEW: usize = 24;

/// The probe of a deflection in the vertical (0) or the lateral plane.
pub(super) fn probe(rail: usize, x: f64, plane: usize) -> Probe {
    Probe {
        rail,
        x,
        axis: [Axis::Vertical, Axis::Lateral][plane],
    }
}

/// The deflections of all points in the planes in which they are known and not zero throughout.
pub(super) struct PointDeflections<'a> {
    blocks: Vec<PointBlock>,
    motions: Option<PlaceMotions<'a>>,
}

/// The points of one rail in one plane.
#[derive(Clone, Debug)]
pub(super) struct PointBlock {
    /// Index in the list of rails.
    pub rail: usize,
    pub plane: usize,
    /// Indices of the points, and of their deflections among those of all blocks.
    pub points: Range<usize>,
    pub values: Range<usize>,
}

impl<'a> PointDeflections<'a> {
    /// The points of `sections`. Rails whose deflections are not known, or that are unrestrained in a plane, have none.
    pub fn new(
        foundation: &'a Foundation,
        sections: &Sections,
        states: &LoadStates,
    ) -> PointDeflections<'a> {
        let is_known = foundation.parts.is_none()
            && (foundation.structure.is_some() || foundation.compliance.is_some());
        let vertical = Self::of(foundation, sections, if is_known { &[0] } else { &[] });
        let lateral = Self::of(foundation, sections, if is_known { &[1] } else { &[] });
        let mut few = spread(states.len(), FEW);
        if few.any(|row| {
            lateral
                .at(&states.at_row(row), &[])
                .iter()
                .flatten()
                .any(|value| *value != 0.0)
        }) {
            return Self::of(foundation, sections, &[0, 1]);
        }
        vertical
    }

    fn of(
        foundation: &'a Foundation,
        sections: &Sections,
        planes: &[usize],
    ) -> PointDeflections<'a> {
        let (mut blocks, mut probes) = (Vec::new(), Vec::new());
        for &plane in planes {
            let mut first = 0;
            for (rail, outline) in sections.rails.iter().enumerate() {
                let own: Vec<Probe> = outline
                    .places
                    .iter()
                    .map(|x| probe(outline.rail, *x, plane))
                    .collect();
                let points = first..first + own.len();
                first = points.end;
                if !own.is_empty() && PlaceMotions::new(foundation, &own).is_ok() {
                    let values = probes.len()..probes.len() + own.len();
                    blocks.push(PointBlock {
                        rail,
                        plane,
                        points,
                        values,
                    });
                    probes.extend(own);
                }
            }
        }
        PointDeflections {
            blocks,
            motions: PlaceMotions::new(foundation, &probes).ok(),
        }
    }

    /// The blocks of points.
    pub fn blocks(&self) -> &[PointBlock] {
        &self.blocks
    }

    /// Whether there are deflections in a plane.
    pub fn has(&self, plane: usize) -> bool {
        self.blocks.iter().any(|block| block.plane == plane)
    }

    /// The deflections of all blocks, then those at `also`; `None` where the structure is unrestrained under a load or there.
    pub fn at(&self, state: &LoadState<'_>, also: &[Probe]) -> Option<Vec<f64>> {
        let mut out = self
            .motions
            .as_ref()?
            .under(&state.loads, &state.dofs(), also)
            .ok()?;
        let count = out.len() - also.len();
        let (own, others) = out.split_at_mut(count);
        for block in &self.blocks {
            own[block.values.clone()]
                .iter_mut()
                .for_each(|value| *value *= DIRECTIONS[block.plane]);
        }
        for (value, probe) in others.iter_mut().zip(also) {
            *value *= DIRECTIONS[usize::from(probe.axis == Axis::Lateral)];
        }
        Some(out)
    }
}
