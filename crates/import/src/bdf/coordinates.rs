//! Coordinate systems CORD1R, CORD1C, CORD1S, CORD2R, CORD2C and CORD2S, and their transformation to the basic system.
//!
//! A system is defined by three points: its origin, a point on its z axis, and a point in the half plane of its x and z
//! axes. CORD2x states the coordinates of these points in a reference system, CORD1x names grids. Cylindrical
//! coordinates are R, theta, Z, and spherical coordinates are R, theta (from the z axis), phi, with angles in degrees.
//!
//! A system is resolved when something first refers to it. A system to which nothing refers has no effect, even if its
//! points or references cannot be used.

use std::collections::{BTreeMap, BTreeSet};

use super::fields::CardFields;
use super::grid::{GridCard, GridDefaults};
use crate::axes::{BASIC_AXES, combined};
use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use formats::vector::{cross, dot, minus, unit};

/// The kind of coordinates of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SystemKind {
    Rectangular,
    Cylindrical,
    Spherical,
}

/// The three points that define a system.
#[derive(Clone, Debug)]
enum SystemPoints {
    /// Their coordinates in the reference system with this number.
    Given(u64, [[f64; 3]; 3]),
    /// The numbers of grids.
    Grids([u64; 3]),
}

/// A coordinate system as its card defines it.
#[derive(Clone, Debug)]
pub struct CoordinateCard {
    /// Position of its card.
    pub card: FilePlace,
    /// Name of its card.
    name: String,
    kind: SystemKind,
    points: SystemPoints,
}

/// Origin and unit axes of a coordinate system, in the basic system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoordinateFrame {
    kind: SystemKind,
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
}

const BASIC: CoordinateFrame = CoordinateFrame {
    kind: SystemKind::Rectangular,
    origin: [0.0; 3],
    axes: BASIC_AXES,
};

/// Cosine and sine of an angle in degrees, exact for multiples of 90 degrees.
fn cosine_and_sine(degrees: f64) -> [f64; 2] {
    let turn = degrees.rem_euclid(360.0);
    for (right, values) in [
        (0.0, [1.0, 0.0]),
        (90.0, [0.0, 1.0]),
        (180.0, [-1.0, 0.0]),
        (270.0, [0.0, -1.0]),
    ] {
        if turn == right {
            return values;
        }
    }
    let radians = turn.to_radians();
    [radians.cos(), radians.sin()]
}

impl CoordinateFrame {
    /// Transforms the coordinates of a point to the basic system. If the axes are exactly the basic ones, rectangular
    /// coordinates are only shifted, so that points of the basic system are reproduced without rounding.
    #[must_use]
    pub fn basic(&self, at: [f64; 3]) -> [f64; 3] {
        let at = match self.kind {
            SystemKind::Rectangular => at,
            SystemKind::Cylindrical => {
                let [cosine, sine] = cosine_and_sine(at[1]);
                [at[0] * cosine, at[0] * sine, at[2]]
            }
            SystemKind::Spherical => {
                let [[ct, st], [cp, sp]] = [at[1], at[2]].map(cosine_and_sine);
                [at[0] * st * cp, at[0] * st * sp, at[0] * ct]
            }
        };
        let turned = combined(&self.axes, at);
        [0, 1, 2].map(|k| self.origin[k] + turned[k])
    }

    /// Directions of the displacements of a point, in the basic system. On the z axis of a cylindrical or spherical
    /// system these are the axes that define the system, as the reference guides state.
    #[must_use]
    pub fn directions(&self, at: [f64; 3]) -> [[f64; 3]; 3] {
        let from = minus(at, self.origin);
        let [x, y, z] = self.axes.map(|axis| dot(axis, from));
        let around = x.hypot(y);
        if self.kind == SystemKind::Rectangular || around <= 1e-12 * z.abs() || around == 0.0 {
            return self.axes;
        }
        let [cosine, sine] = [x / around, y / around];
        let outwards = combined(&self.axes, [cosine, sine, 0.0]);
        let tangent = combined(&self.axes, [-sine, cosine, 0.0]);
        if self.kind == SystemKind::Cylindrical {
            return [outwards, tangent, self.axes[2]];
        }
        let radius = around.hypot(z);
        let [level, up] = [around / radius, z / radius];
        let radial = combined(&self.axes, [level * cosine, level * sine, up]);
        let downwards = combined(&self.axes, [up * cosine, up * sine, -level]);
        [radial, downwards, tangent]
    }

    /// Axes of the system, in the basic system.
    #[must_use]
    pub fn axes(&self) -> [[f64; 3]; 3] {
        self.axes
    }

    /// Whether the coordinates are rectangular.
    #[must_use]
    pub fn is_rectangular(&self) -> bool {
        self.kind == SystemKind::Rectangular
    }
}

/// Reads one of the six cards. CORD1x may define two systems.
pub fn systems(card: &mut CardFields<'_, '_>) -> Vec<(u64, CoordinateCard)> {
    let name = card.card.name.clone();
    let kind = match name.as_bytes().last() {
        Some(b'C') => SystemKind::Cylindrical,
        Some(b'S') => SystemKind::Spherical,
        _ => SystemKind::Rectangular,
    };
    let at = card.card.at;
    let made = |points: SystemPoints| CoordinateCard {
        card: at,
        name: name.clone(),
        kind,
        points,
    };
    let mut found = Vec::new();
    if name.starts_with("CORD2") {
        let id = card.id(1, "CID");
        let reference = card.whole(2, "RID");
        let a = card.vector(3, ["A1", "A2", "A3"]);
        let b = card.vector(6, ["B1", "B2", "B3"]);
        let c = card.vector(9, ["C1", "C2", "C3"]);
        card.end(12);
        if let (Some(id), Some(reference), Some(a), Some(b), Some(c)) = (id, reference, a, b, c) {
            found.push((id, made(SystemPoints::Given(reference, [a, b, c]))));
        }
        return found;
    }
    for first in [1, 5] {
        if first == 5 && (5..9).all(|index| card.blank(index)) {
            continue;
        }
        let id = card.id(first, "CID");
        let grids = [(1, "G1"), (2, "G2"), (3, "G3")].map(|(k, field)| card.id(first + k, field));
        if let (Some(id), [Some(a), Some(b), Some(c)]) = (id, grids) {
            found.push((id, made(SystemPoints::Grids([a, b, c]))));
        }
    }
    card.end(9);
    found
}

/// The coordinate systems of a deck, resolved when they are first needed.
pub struct CoordinateSystems<'d> {
    cards: &'d BTreeMap<u64, CoordinateCard>,
    grids: &'d BTreeMap<u64, GridCard>,
    defaults: GridDefaults,
    /// The systems that have been resolved; `None` for one that cannot be used.
    known: BTreeMap<u64, Option<CoordinateFrame>>,
}

impl<'d> CoordinateSystems<'d> {
    /// The systems of a deck with these grids, whose blank fields have the values of `defaults`.
    #[must_use]
    pub fn new(
        cards: &'d BTreeMap<u64, CoordinateCard>,
        grids: &'d BTreeMap<u64, GridCard>,
        defaults: GridDefaults,
    ) -> CoordinateSystems<'d> {
        CoordinateSystems {
            cards,
            grids,
            defaults,
            known: BTreeMap::from([(0, Some(BASIC))]),
        }
    }

    /// The frame of a system; `None`, with an error at `at`, if the deck does not define it, and `None`, with errors at
    /// the cards of systems, if it cannot be used.
    ///
    /// Systems on which the system depends are resolved before it: the last entry of a stack is resolved if
    /// everything that it needs is known, and otherwise what it needs is put on top of it.
    pub fn frame(
        &mut self,
        id: u64,
        at: FilePlace,
        about: &str,
        findings: &mut ImportFindings,
    ) -> Option<CoordinateFrame> {
        if id != 0 && !self.cards.contains_key(&id) {
            let expected = "must be 0 or the number of a coordinate system";
            findings.error(ImportFinding::new(at, about, expected).with_found(id));
            return None;
        }
        let mut stack = vec![id];
        let mut waiting = BTreeSet::new();
        while let Some(&top) = stack.last() {
            if self.known.contains_key(&top) {
                stack.pop();
                continue;
            }
            let needs = self.needs(top);
            let open: Vec<u64> = needs
                .into_iter()
                .filter(|need| !self.known.contains_key(need))
                .collect();
            if open.is_empty() {
                let frame = self.resolved(top, findings);
                self.known.insert(top, frame);
                stack.pop();
            } else if open.iter().any(|need| waiting.contains(need)) || !waiting.insert(top) {
                self.refuse(
                    top,
                    "must not be defined by systems or grids that depend on it",
                    findings,
                );
                self.known.insert(top, None);
                stack.pop();
            } else {
                stack.extend(open);
            }
        }
        self.known.get(&id).copied().flatten()
    }

    /// The systems that must be known before a system can be resolved. Missing ones are left out.
    fn needs(&self, id: u64) -> Vec<u64> {
        let mut needs = match self.cards.get(&id).map(|card| &card.points) {
            Some(SystemPoints::Given(reference, _)) => vec![*reference],
            Some(SystemPoints::Grids(grids)) => grids
                .iter()
                .filter_map(|grid| self.grids.get(grid))
                .map(|grid| self.system_of(grid))
                .collect(),
            None => Vec::new(),
        };
        needs.retain(|need| *need == 0 || self.cards.contains_key(need));
        needs
    }

    fn system_of(&self, grid: &GridCard) -> u64 {
        grid.cp.unwrap_or(self.defaults.cp)
    }

    fn refuse(&self, id: u64, expected: &str, findings: &mut ImportFindings) {
        if let Some(card) = self.cards.get(&id) {
            findings.error(ImportFinding::new(
                card.card,
                format!("{} {id}", card.name),
                expected,
            ));
        }
    }

    /// Resolves a system whose needs are known; `None`, with an error, if this is not possible.
    fn resolved(&self, id: u64, findings: &mut ImportFindings) -> Option<CoordinateFrame> {
        let card = self.cards.get(&id)?;
        let frame_of = |system: u64| self.known.get(&system).copied();
        let mut points = [[0.0; 3]; 3];
        match &card.points {
            SystemPoints::Given(reference, given) => {
                let Some(frame) = frame_of(*reference) else {
                    let about = format!("{} {id}: RID", card.name);
                    let expected = "must be 0 or the number of a coordinate system";
                    findings.error(
                        ImportFinding::new(card.card, about, expected).with_found(reference),
                    );
                    return None;
                };
                // an error has already been added for a reference system that cannot be used
                let frame = frame?;
                points = given.map(|point| frame.basic(point));
            }
            SystemPoints::Grids(grids) => {
                for (point, number) in points.iter_mut().zip(grids) {
                    let grid = self.grids.get(number);
                    let Some((grid, frame)) =
                        grid.and_then(|grid| Some((grid, frame_of(self.system_of(grid))?)))
                    else {
                        let about = format!("{} {id}", card.name);
                        let expected = "refers to a grid that does not exist or whose coordinate system does not exist";
                        findings.error(
                            ImportFinding::new(card.card, about, expected).with_found(number),
                        );
                        return None;
                    };
                    *point = frame?.basic(grid.at);
                }
            }
        }
        let [a, b, c] = points;
        let z = unit(minus(b, a));
        let y = z.and_then(|z| unit(cross(z, minus(c, a))));
        let (Some(y), Some(z)) = (y, z) else {
            self.refuse(id, "its three points must not be collinear", findings);
            return None;
        };
        Some(CoordinateFrame {
            kind: card.kind,
            origin: a,
            axes: [cross(y, z), y, z],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: [f64; 3], expected: [f64; 3]) -> bool {
        found
            .iter()
            .zip(expected)
            .all(|(found, expected)| (found - expected).abs() < 1e-14)
    }

    #[test]
    fn cylinders_and_spheres_have_their_angles_in_degrees() {
        let cylinder = CoordinateFrame {
            kind: SystemKind::Cylindrical,
            origin: [1.0, 0.0, 0.0],
            ..BASIC
        };
        assert_eq!(cylinder.basic([2.0, 90.0, 3.0]), [1.0, 2.0, 3.0]);
        assert_eq!(cylinder.basic([2.0, -90.0, 3.0]), [1.0, -2.0, 3.0]);
        assert_eq!(
            cylinder.directions([1.0, 2.0, 3.0]),
            [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        );
        assert_eq!(
            cylinder.directions([1.0, 0.0, 3.0]),
            BASIC_AXES,
            "on the axis"
        );
        let sphere = CoordinateFrame {
            kind: SystemKind::Spherical,
            ..BASIC
        };
        assert_eq!(sphere.basic([2.0, 0.0, 17.0]), [0.0, 0.0, 2.0]);
        let place = sphere.basic([2.0, 60.0, 30.0]);
        assert!(near(place, [1.5, 0.75f64.sqrt(), 1.0]), "{place:?}");
        let [radial, downwards, tangent] = sphere.directions(place);
        assert!(near(radial, place.map(|part| part / 2.0)));
        assert!(near(cross(radial, downwards), tangent));
        assert!(downwards[2] < 0.0);
    }
}
