//! What rail loads do elsewhere in the structure: reactions and internal forces.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::kernel::{cross, unit};
use crate::{Cell, Error, Line, Probe, Row};

/// Places along a member that differ by less than this share of its length are one.
const SLACK: f64 = 1e-12;

/// A component of the internal force of a member, in its local axes.
///
/// Cut the member and look at the face whose outward normal is +x: the part beyond the cut acts on it
/// with the force (N, Vy, Vz) and the moment (Mx, My, Mz), positive along +x, +y, +z and right-handed about
/// them. So N is tension; a positive Mz stretches the fibres at -y, a positive My those at +z; and where no
/// load stands, dMz/dx = -Vy, dMy/dx = Vz.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Component {
    /// N, force per force.
    Axial,
    /// Vy.
    ShearY,
    /// Vz.
    ShearZ,
    /// Mx, moment per force.
    Torsion,
    /// My, bends in the local x-z plane.
    BendingY,
    /// Mz, bends in the local x-y plane.
    BendingZ,
}

impl Component {
    /// All six, in order.
    pub const ALL: [Component; 6] = [
        Component::Axial,
        Component::ShearY,
        Component::ShearZ,
        Component::Torsion,
        Component::BendingY,
        Component::BendingZ,
    ];

    /// The component on a face at x from a force and a moment at z on the part before it: six factors of
    /// fx fy fz mx my mz, `reach` = x - z. Equilibrium of that part: R = -f, M = -m + reach e_x cross f.
    #[must_use]
    pub fn balance(self, reach: f64) -> [f64; 6] {
        let mut out = [0.0; 6];
        out[self as usize] = -1.0;
        match self {
            Component::BendingY => out[2] = -reach,
            Component::BendingZ => out[1] = reach,
            _ => {}
        }
        out
    }
}

/// A section of a member, and the component of its internal force.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Identity of the member, as in [`crate::Carrier`].
    pub member: usize,
    /// Place along the member in the direction of its own local x, 0..=1. The ends are just inside.
    pub place: f64,
    /// Which component.
    pub component: Component,
    /// The component per unit load on the ends of the flexible part (fx fy fz mx my mz in local axes,
    /// first end, then last) while the rest of the structure holds the member's ends.
    pub ends: [f64; 12],
}

/// Effects of unit rail loads at any place: linear functions of the load,
///
/// E(p) = A N(p)^T + \[p on the section's member\] e(p)
///
/// with the shape rows N of the line, the effects A of unit loads on its states, and what the member between
/// its held ends adds. Exact wherever the load stands, on either side of a section and beside it.
///
/// # Source
/// Reciprocity of Mueller-Breslau: A is a displaced shape of the structure; see Ghali, Neville and Brown,
/// Structural Analysis (2009), chapter 12.
#[derive(Clone, Debug)]
pub struct Effects {
    line: Arc<Line>,
    rows: DMatrix<f64>,
    sections: Vec<Option<Section>>,
}

impl Effects {
    /// `rows`: one an effect, 6 S wide for the S states of the line: the effect per unit load on each
    /// freedom of the states, in the frames of the rails; infinite where nothing resists that load.
    /// `sections`: of each effect that is an internal force.
    ///
    /// # Errors
    /// Shapes that differ; an entry that is not a number; a place outside 0..=1.
    pub fn new(
        line: Arc<Line>,
        rows: DMatrix<f64>,
        sections: Vec<Option<Section>>,
    ) -> Result<Effects, Error> {
        let expected = [sections.len(), 6 * line.states()];
        let (found, columns) = rows.shape();
        if [found, columns] != expected {
            return Err(Error::EffectShape { rows: found, columns, expected });
        }
        for (effect, section) in sections.iter().enumerate() {
            let sound = |section: &Section| {
                (0.0..=1.0).contains(&section.place) && section.ends.iter().all(|end| end.is_finite())
            };
            if !section.as_ref().is_none_or(sound) || rows.row(effect).iter().any(|entry| entry.is_nan()) {
                return Err(Error::EffectNumber { effect });
            }
        }
        Ok(Effects { line, rows, sections })
    }

    /// Number of effects.
    #[must_use]
    pub fn len(&self) -> usize {
        self.sections.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sections.is_empty()
    }

    /// The cells it stands on.
    #[must_use]
    pub fn line(&self) -> &Arc<Line> {
        &self.line
    }

    /// Every effect per unit force at a probe, along its axis, into `out`.
    ///
    /// Where the load stands at a section itself, the mean of both sides; at an end of the member the section
    /// is inside, the load outside.
    ///
    /// # Errors
    /// A probe beyond its rail, on a rail that does not exist, or in a direction that nothing resists;
    /// `out` of another length than [`Effects::len`].
    pub fn fill(&self, at: Probe, out: &mut [f64]) -> Result<(), Error> {
        let n = self.len();
        if out.len() != n {
            return Err(Error::EffectShape { rows: out.len(), columns: 1, expected: [n, 1] });
        }
        let row = self.line.row(at)?;
        out.fill(0.0);
        let entries = row.indices().iter().zip(row.values());
        // Nothing of a load on a freedom that nothing resists is nothing.
        for (&index, &share) in entries.filter(|(_, share)| **share != 0.0) {
            for (sum, entry) in out.iter_mut().zip(self.rows.column(index)) {
                *sum += share * entry;
            }
        }
        let cell = &self.line.cells()[row.cell];
        if let Some(carrier) = cell.carrier.filter(|_| cell.ends[0] != cell.ends[1]) {
            let mut load = None;
            for (sum, section) in out.iter_mut().zip(&self.sections) {
                if let Some(section) = section.as_ref().filter(|section| section.member == carrier.member) {
                    let load = load.get_or_insert_with(|| Load::new(cell, at, &row));
                    *sum += load.held(section);
                }
            }
        }
        if out.iter().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(Error::Unstiffened { rail: at.rail, x: at.x, axis: at.axis })
        }
    }
}

/// A unit rail force on a member, in the member's own axes.
struct Load {
    /// Its place along the member, and the member's length.
    place: f64,
    length: f64,
    /// Force and moment about the axis there.
    own: [f64; 6],
    /// Its equivalent on the ends of the flexible part.
    ends: [f64; 12],
}

impl Load {
    fn new(cell: &Cell, at: Probe, row: &Row) -> Load {
        let axes = cell.axes();
        let turned = |v: [f64; 3]| axes.map(|axis| axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]);
        let force = unit(at.axis.component());
        let [f, m] = [turned(force), turned(cross(cell.offset, force))];
        let mut shares = [[0.0; 3]; 4];
        for (&index, &value) in row.indices().iter().zip(row.values()) {
            let end = usize::from(index / 6 != cell.ends[0]) ^ usize::from(cell.is_reversed());
            shares[2 * end + index % 6 / 3][index % 3] = value;
        }
        let shares = shares.map(turned);
        Load {
            place: cell.place(at.x),
            length: cell.length,
            own: [f[0], f[1], f[2], m[0], m[1], m[2]],
            ends: std::array::from_fn(|k| shares[k / 3][k % 3]),
        }
    }

    /// The component at a section while the ends of the member are held.
    fn held(&self, section: &Section) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let reach = section.place * self.length - self.place;
        let before = if reach.abs() > SLACK * self.length {
            f64::from(u8::from(reach > 0.0))
        } else if section.place == 0.0 {
            1.0
        } else if section.place == 1.0 {
            0.0
        } else {
            0.5
        };
        dot(&section.ends, &self.ends) + before * dot(&section.component.balance(reach), &self.own)
    }
}
