//! Grids and coordinate systems (GRID, GRDSET and CORD2R), and the transformation of grids to the basic system.

use std::collections::BTreeMap;

use super::fields::CardFields;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use formats::vector::{cross, dot, minus, unit};

/// A grid as its card defines it, in its own coordinate system.
#[derive(Clone, Debug)]
pub struct GridCard {
    /// Position of its card.
    pub card: FilePlace,
    /// Coordinates in the coordinate system `cp`.
    pub at: [f64; 3],
    /// Number of the coordinate system of `at`; `None` if blank.
    pub cp: Option<u64>,
    /// Number of the coordinate system of displacements; `None` if blank.
    pub cd: Option<u64>,
    /// Permanently restrained degrees of freedom; `None` if blank.
    pub fix: Option<[bool; 6]>,
    /// Positions of the fields `cp` and `cd`.
    pub spots: [FilePlace; 2],
}

/// Defaults of GRDSET for blank fields of GRID.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridDefaults {
    cp: u64,
    cd: u64,
    fix: [bool; 6],
}

/// A Cartesian coordinate system defined by three points.
#[derive(Clone, Debug)]
pub struct CoordinateCard {
    /// Position of its card.
    pub card: FilePlace,
    /// Number of the coordinate system in which its points are defined.
    pub reference: u64,
    /// The origin, a point on the z axis and a point in the x-z plane.
    pub points: [[f64; 3]; 3],
}

/// Origin and unit axes of a coordinate system, in the basic system.
#[derive(Clone, Copy, Debug)]
pub struct CoordinateFrame {
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
}

const BASIC: CoordinateFrame =
    CoordinateFrame { origin: [0.0; 3], axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

impl CoordinateFrame {
    /// Transforms a point to the basic system. If the axes are exactly the basic ones, coordinates are only shifted,
    /// so that points of the basic system are reproduced without rounding.
    fn basic(&self, at: [f64; 3]) -> [f64; 3] {
        if self.axes == BASIC.axes {
            return [0, 1, 2].map(|k| self.origin[k] + at[k]);
        }
        [0, 1, 2].map(|k| {
            self.origin[k] + at[0] * self.axes[0][k] + at[1] * self.axes[1][k] + at[2] * self.axes[2][k]
        })
    }

    /// Whether the axes coincide with those of the basic system, to rounding.
    fn parallel(&self) -> bool {
        (0..3).all(|k| dot(self.axes[k], BASIC.axes[k]) > 1.0 - 1e-15)
    }
}

/// Reads GRID.
pub fn grid(card: &mut CardFields<'_, '_>) -> Option<(u64, GridCard)> {
    let id = card.id(1, "ID")?;
    let cp = if card.blank(2) { Some(None) } else { card.whole(2, "CP").map(Some) };
    let at = card.vector(3, ["X1", "X2", "X3"]);
    let cd = match card.text(6) {
        "" => Some(None),
        "-1" => {
            card.refuse(6, "CD", "must not be -1", "points of a fluid are not supported");
            None
        }
        _ => card.whole(6, "CD").map(Some),
    };
    let fix = if card.blank(7) { Some(None) } else { card.freedoms(7, "PS").map(Some) };
    card.zero(8, "SEID", "superelements are not supported");
    card.end(9);
    let spots = [card.at(2), card.at(6)];
    Some((id, GridCard { card: card.card.at, at: at?, cp: cp?, cd: cd?, fix: fix?, spots }))
}

/// Reads GRDSET.
pub fn defaults(card: &mut CardFields<'_, '_>) -> Option<GridDefaults> {
    let cp = card.whole(2, "CP");
    let cd = card.whole(6, "CD");
    let fix = card.freedoms(7, "PS");
    card.zero(8, "SEID", "superelements are not supported");
    card.end(9);
    Some(GridDefaults { cp: cp?, cd: cd?, fix: fix? })
}

/// Reads CORD2R.
pub fn system(card: &mut CardFields<'_, '_>) -> Option<(u64, CoordinateCard)> {
    let id = card.id(1, "CID")?;
    let reference = card.whole(2, "RID");
    let a = card.vector(3, ["A1", "A2", "A3"]);
    let b = card.vector(6, ["B1", "B2", "B3"]);
    let c = card.vector(9, ["C1", "C2", "C3"]);
    card.end(12);
    Some((id, CoordinateCard { card: card.card.at, reference: reference?, points: [a?, b?, c?] }))
}

/// A grid in the basic system.
#[derive(Clone, Copy, Debug)]
pub struct Resolved {
    /// Coordinates.
    pub at: [f64; 3],
    /// Degrees of freedom that its card or GRDSET restrains permanently.
    pub fix: [bool; 6],
}

/// Transforms all grids to the basic system.
pub fn resolve(
    grids: &BTreeMap<u64, GridCard>,
    defaults: GridDefaults,
    systems: &BTreeMap<u64, CoordinateCard>,
    findings: &mut ImportFindings,
) -> BTreeMap<u64, Resolved> {
    let frames = frames(systems, findings);
    let mut resolved = BTreeMap::new();
    for (&id, grid) in grids {
        let [cp, cd] = [grid.cp.unwrap_or(defaults.cp), grid.cd.unwrap_or(defaults.cd)];
        let known = |system: u64, at: FilePlace, name: &str, findings: &mut ImportFindings| {
            if !systems.contains_key(&system) && system != 0 {
                let finding = ImportFinding::new(
                    at,
                    format!("GRID {id}: {name}"),
                    "must be 0 or the number of a CORD2R",
                );
                findings.error(finding.with_found(system));
            }
            frames.get(&system).copied()
        };
        let place = known(cp, grid.spots[0], "CP", findings);
        let turned = known(cd, grid.spots[1], "CD", findings);
        if turned.is_some_and(|frame| !frame.parallel()) {
            let about = format!("GRID {id}: CD");
            let finding =
                ImportFinding::new(grid.spots[1], about, "must be a system with the axes of the basic one");
            findings.error(
                finding.with_found(cd).hint("supports and springs of a beam spec are along the global axes"),
            );
        }
        let Some(frame) = place else { continue };
        let at = frame.basic(grid.at);
        if at.iter().all(|part| part.is_finite()) {
            resolved.insert(id, Resolved { at, fix: grid.fix.unwrap_or(defaults.fix) });
        } else {
            findings.error(ImportFinding::new(
                grid.card,
                format!("GRID {id}"),
                "must lie at finite coordinates",
            ));
        }
    }
    resolved
}

/// Resolves all coordinate systems to the basic system. A system may refer to any other: each pass resolves those
/// whose reference system is already resolved. The iteration ends when no system remains, or when a pass resolves
/// none; the remaining systems form a cycle or refer to a missing one, and each of them is an error.
fn frames(
    systems: &BTreeMap<u64, CoordinateCard>,
    findings: &mut ImportFindings,
) -> BTreeMap<u64, CoordinateFrame> {
    let mut frames = BTreeMap::from([(0, BASIC)]);
    let mut left: Vec<(&u64, &CoordinateCard)> = systems.iter().collect();
    while !left.is_empty() {
        let before = left.len();
        left.retain(|(id, system)| {
            let Some(reference) = frames.get(&system.reference) else { return true };
            let [a, b, c] = system.points.map(|point| reference.basic(point));
            let z = unit(minus(b, a));
            let y = z.and_then(|z| unit(cross(z, minus(c, a))));
            match (y, z) {
                (Some(y), Some(z)) => {
                    frames.insert(**id, CoordinateFrame { origin: a, axes: [cross(y, z), y, z] });
                }
                _ => {
                    let expected = "its three points must not lie on one line";
                    findings.error(ImportFinding::new(system.card, format!("CORD2R {id}"), expected));
                }
            }
            false
        });
        if left.len() == before {
            for (id, system) in left.drain(..) {
                let about = format!("CORD2R {id}: RID");
                let expected = "must refer, directly or through other systems, to the basic system 0";
                findings.error(ImportFinding::new(system.card, about, expected).with_found(system.reference));
            }
        }
    }
    frames
}
