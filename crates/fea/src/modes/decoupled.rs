//! The unknowns that given forces can move.
//!
//! Vertical forces on a straight girder move it in its vertical plane alone: no entry of stiffness or mass connects
//! these unknowns with the others. The modes that such forces excite are those of the connected unknowns.

use nalgebra::{DMatrix, DVector};
use splines::{Axis, Probe};
use sprs::{CsMat, TriMat};

use crate::assembly::{ScaledStiffness, bending_planes, transformation};
use crate::error::Error;
use crate::factor::Solver;
use crate::influence::{FactoredFrame, RailLoads};
use crate::model::Model;
use crate::modes::mass::ScaledMass;

/// Entry of a symmetric positive semi-definite matrix, relative to the geometric mean of its two diagonal entries,
/// below which it is rounding: less than what a change of the diagonal entries by one rounding can do.
const ROUNDING: f64 = 1e-15;

/// Forces whose response is wanted: it consists of the natural modes that they excite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExcitingForces {
    /// Directions of forces anywhere on the rails.
    pub axes: Vec<Axis>,
    /// Motions of the supports as one rigid body, whose forces are those of inertia: for each its components along
    /// three translations along the global axes and three rotations about the global origin.
    pub motions: Vec<[f64; 6]>,
}

impl ExcitingForces {
    /// Vertical forces on the rails.
    #[must_use]
    pub fn vertical() -> ExcitingForces {
        ExcitingForces {
            axes: vec![Axis::Vertical],
            motions: Vec::new(),
        }
    }
}

/// Some of the coordinates of a frame, in the order of [`ScaledMass`], and their stiffness and mass, both scaled.
///
/// In the stiffness, each interior motion has one on the diagonal and nothing beside it.
#[derive(Debug)]
pub(super) struct Part {
    /// The coordinates, in increasing order.
    pub unknowns: Vec<usize>,
    /// Upper triangle of the stiffness.
    pub stiffness: CsMat<f64>,
    /// Upper triangle of the mass.
    pub mass: CsMat<f64>,
    /// Number of interior motions of the frame.
    interior: usize,
    /// Number of coordinates of the frame.
    all: usize,
}

impl Part {
    /// All coordinates of a frame.
    pub fn whole(frame: &FactoredFrame, mass: &ScaledMass) -> Part {
        let interior = mass.interior.len();
        let all = interior + frame.unknowns();
        Part {
            unknowns: (0..all).collect(),
            stiffness: with_interior(&frame.stiffness().upper, interior),
            mass: mass.upper.clone(),
            interior,
            all,
        }
    }

    /// The unknowns that `forces` can move: those that entries of stiffness or mass connect with an unknown on which
    /// a force acts. Their modes, with zeros for the other unknowns, are exactly the modes of the frame that the
    /// forces excite, because the matrices are block diagonal.
    pub fn moved_by(
        forces: &ExcitingForces,
        loads: RailLoads<'_>,
        stiffness: &ScaledStiffness,
        mass: &ScaledMass,
    ) -> Part {
        let interior = mass.interior.len();
        let stiffness = with_interior(&stiffness.upper, interior);
        let all = stiffness.cols();
        let mut blocks = Blocks::new(all);
        blocks.connect(&stiffness);
        blocks.connect(&mass.upper);
        let mut moved = vec![false; all];
        for unknown in loaded_unknowns(forces, loads, mass) {
            moved[blocks.root(unknown)] = true;
        }
        let unknowns: Vec<usize> = (0..all)
            .filter(|&unknown| moved[blocks.root(unknown)])
            .collect();
        let mut index = vec![None; all];
        unknowns
            .iter()
            .enumerate()
            .for_each(|(k, &unknown)| index[unknown] = Some(k));
        let restricted = |upper: &CsMat<f64>| {
            let mut entries = TriMat::new((unknowns.len(), unknowns.len()));
            for (&value, (i, j)) in upper.iter() {
                if let (Some(i), Some(j)) = (index[i], index[j]) {
                    entries.add_triplet(i, j, value);
                }
            }
            entries.to_csc()
        };
        Part {
            stiffness: restricted(&stiffness),
            mass: restricted(&mass.upper),
            unknowns,
            interior,
            all,
        }
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.unknowns.len()
    }

    /// Values of all coordinates of the frame; those outside the part are zero.
    pub fn expand(&self, values: &[f64]) -> DVector<f64> {
        let mut out = DVector::zeros(self.all);
        self.unknowns
            .iter()
            .zip(values)
            .for_each(|(&unknown, &value)| out[unknown] = value);
        out
    }

    /// K^-1 x of the part by a factor of the stiffness of the frame.
    pub fn solve(&self, solver: &Solver, x: &DVector<f64>) -> DVector<f64> {
        let mut all = self.expand(x.as_slice());
        solver.solve(&mut all.as_mut_slice()[self.interior..]);
        DVector::from_fn(self.len(), |k, _| all[self.unknowns[k]])
    }
}

/// Upper triangle of a stiffness behind that of `interior` motions of unit stiffness.
fn with_interior(upper: &CsMat<f64>, interior: usize) -> CsMat<f64> {
    if interior == 0 {
        return upper.clone();
    }
    let size = interior + upper.cols();
    let mut entries = TriMat::with_capacity((size, size), interior + upper.nnz());
    (0..interior).for_each(|k| entries.add_triplet(k, k, 1.0));
    for (&value, (i, j)) in upper.iter() {
        entries.add_triplet(interior + i, interior + j, value);
    }
    entries.to_csc()
}

/// Deformations of a member.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Directions {
    pub axial: bool,
    pub torsion: bool,
    /// In the local x-y plane, then in the x-z plane.
    pub bending: [bool; 2],
}

impl Directions {
    pub const NONE: Directions = Directions {
        axial: false,
        torsion: false,
        bending: [false; 2],
    };
    pub const ALL: Directions = Directions {
        axial: true,
        torsion: true,
        bending: [true; 2],
    };

    /// The deformations of both.
    pub fn with(self, other: Directions) -> Directions {
        Directions {
            axial: self.axial || other.axial,
            torsion: self.torsion || other.torsion,
            bending: [0, 1].map(|plane| self.bending[plane] || other.bending[plane]),
        }
    }
}

impl FactoredFrame {
    /// For each member, the deformations that `forces` can cause; `m` is the model that the frame was made of.
    ///
    /// # Errors
    /// As [`FactoredFrame::modes`].
    pub(super) fn moved_directions(
        &self,
        m: &Model,
        forces: &ExcitingForces,
    ) -> Result<Vec<Directions>, Error> {
        let mass = ScaledMass::new(m, &self.elements, &self.bodies, self.stiffness())?;
        let part = Part::moved_by(forces, self.rail_loads(), self.stiffness(), &mass);
        let mut moves = vec![false; self.unknowns()];
        let of_frame = part
            .unknowns
            .iter()
            .filter_map(|unknown| unknown.checked_sub(part.interior));
        of_frame.for_each(|unknown| moves[unknown] = true);
        let all = self.elements.iter().map(|element| {
            let local = transformation(element, &self.bodies);
            let pair = self.bodies.pair(element.points);
            let basis = pair.map(|body| self.bodies.list[body].basis);
            // Whether an unknown of the part moves the degree of freedom `of` of one of the ends.
            let moved = |of: usize| {
                (0..12).any(|column| {
                    let (end, k) = (column / 6, column % 6);
                    let unknown = self.unknown(6 * pair[end] + k);
                    let motion = local.fixed_columns::<6>(6 * end) * basis[end].column(k);
                    unknown.is_some_and(|unknown| moves[unknown])
                        && (motion[of] != 0.0 || motion[of + 6] != 0.0)
                })
            };
            let bending = bending_planes(&element.flexibility)
                .map(|plane| moved(plane.deflection) || moved(plane.rotation));
            Directions {
                axial: moved(0),
                torsion: moved(3),
                bending,
            }
        });
        Ok(all.collect())
    }
}

/// The coordinates on which `forces` act. Interior motions are connected with the ends of their members.
fn loaded_unknowns(forces: &ExcitingForces, loads: RailLoads<'_>, mass: &ScaledMass) -> Vec<usize> {
    let mut loaded = Vec::new();
    let elements = loads.line.map_or(&[][..], |line| line.elements());
    for element in elements {
        let [a, b] = element.x;
        for at in [0.25, 0.5, 0.75] {
            for &axis in &forces.axes {
                let probe = Probe {
                    rail: element.rail,
                    x: a + at * (b - a),
                    axis,
                };
                // Nothing moves in a direction that nothing stiffens.
                let Ok((row, _)) = loads.row(probe) else {
                    continue;
                };
                let load = loads.scaled_where_stiffened(&row);
                loaded.extend(
                    load.into_iter()
                        .map(|(unknown, _)| mass.interior.len() + unknown),
                );
            }
        }
    }
    let diagonal = diagonal(&mass.upper);
    let total = DMatrix::from_iterator(6, 6, mass.total.iter().copied());
    for motion in &forces.motions {
        let motion = DVector::from_column_slice(motion);
        let own = motion.dot(&(&total * &motion));
        for (unknown, own_mass) in diagonal.iter().enumerate() {
            let force: f64 = mass
                .rigid
                .iter()
                .zip(&motion)
                .map(|(rigid, part)| rigid[unknown] * part)
                .sum();
            if force.abs() > ROUNDING * (own * own_mass).sqrt() {
                loaded.push(unknown);
            }
        }
    }
    loaded
}

/// Diagonal of a matrix given by its upper triangle.
fn diagonal(upper: &CsMat<f64>) -> Vec<f64> {
    (0..upper.cols())
        .map(|k| upper.get(k, k).copied().unwrap_or(0.0))
        .collect()
}

/// Unknowns grouped by the entries that connect them (a union-find forest).
struct Blocks {
    parent: Vec<usize>,
}

impl Blocks {
    fn new(count: usize) -> Blocks {
        Blocks {
            parent: (0..count).collect(),
        }
    }

    /// The unknown that stands for the group of `k`.
    fn root(&mut self, mut k: usize) -> usize {
        while self.parent[k] != k {
            self.parent[k] = self.parent[self.parent[k]];
            k = self.parent[k];
        }
        k
    }

    /// Joins the groups of unknowns with an entry that is more than rounding.
    fn connect(&mut self, upper: &CsMat<f64>) {
        let diagonal = diagonal(upper);
        for (value, (i, j)) in upper.iter() {
            if i != j && value.abs() > ROUNDING * (diagonal[i] * diagonal[j]).sqrt() {
                let (a, b) = (self.root(i), self.root(j));
                self.parent[a] = b;
            }
        }
    }
}
