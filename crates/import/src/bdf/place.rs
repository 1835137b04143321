//! Transformation of grids to the basic system, and of their displacement components to global degrees of freedom.

use std::collections::BTreeMap;

use super::coordinates::CoordinateSystems;
use super::grid::{GridCard, GridDefaults};
use crate::axes::BASIC_AXES;
use crate::findings::{ImportFinding, ImportFindings};

/// A grid in the basic system.
#[derive(Clone, Copy, Debug)]
pub struct Resolved {
    /// Coordinates.
    pub at: [f64; 3],
    /// Directions of its displacement components, in the basic system.
    pub axes: [[f64; 3]; 3],
    /// Displacement components that its card or GRDSET restrains permanently.
    pub fix: [bool; 6],
}

/// Largest deviation of a direction from a global axis, in radians, that is taken for rounding.
const ALIGNED: f64 = 1e-9;

impl Resolved {
    /// The global degrees of freedom that a set of displacement components restrains; `None` if the components are along
    /// directions that no set of global axes spans.
    ///
    /// The restrained translations span a space whose projector is the sum of a a^T over their directions a. The set of
    /// global axes spans the same space if the projector is diagonal; rotations likewise.
    #[must_use]
    pub fn global(&self, set: &[bool; 6]) -> Option<[bool; 6]> {
        if self.axes == BASIC_AXES {
            return Some(*set);
        }
        let mut global = [false; 6];
        for half in [0, 3] {
            for i in 0..3 {
                for j in 0..3 {
                    let chosen = (0..3).filter(|&k| set[half + k]);
                    let projector: f64 = chosen.map(|k| self.axes[k][i] * self.axes[k][j]).sum();
                    let wanted = if i == j { projector.round() } else { 0.0 };
                    if (projector - wanted).abs() > ALIGNED {
                        return None;
                    }
                    global[half + i] |= i == j && wanted != 0.0;
                }
            }
        }
        Some(global)
    }

    /// The global degree of freedom along a displacement component, and its sign; `None` if the component is not along
    /// a global axis.
    #[must_use]
    pub fn global_component(&self, component: usize) -> Option<(usize, f64)> {
        let direction = self.axes[component % 3];
        let axis = (0..3).find(|&k| (direction[k].abs() - 1.0).abs() <= ALIGNED)?;
        let is_along = (0..3).all(|k| k == axis || direction[k].abs() <= ALIGNED);
        is_along.then_some((component - component % 3 + axis, direction[axis].signum()))
    }
}

/// Transforms all grids to the basic system.
pub fn resolve(
    grids: &BTreeMap<u64, GridCard>,
    defaults: GridDefaults,
    systems: &mut CoordinateSystems<'_>,
    findings: &mut ImportFindings,
) -> BTreeMap<u64, Resolved> {
    let mut resolved = BTreeMap::new();
    for (&id, grid) in grids {
        let [cp, cd] = [
            grid.cp.unwrap_or(defaults.cp),
            grid.cd.unwrap_or(defaults.cd),
        ];
        let place = systems.frame(cp, grid.spots[0], &format!("GRID {id}: CP"), findings);
        let turned = systems.frame(cd, grid.spots[1], &format!("GRID {id}: CD"), findings);
        let (Some(place), Some(turned)) = (place, turned) else {
            continue;
        };
        let at = place.basic(grid.at);
        if at.iter().all(|part| part.is_finite()) {
            let fix = grid.fix.unwrap_or(defaults.fix);
            resolved.insert(
                id,
                Resolved {
                    at,
                    axes: turned.directions(at),
                    fix,
                },
            );
        } else {
            findings.error(ImportFinding::new(
                grid.card,
                format!("GRID {id}"),
                "must have finite coordinates in the basic system",
            ));
        }
    }
    resolved
}
