//! Effects of rail loads elsewhere in the structure: influence lines of reactions and internal forces.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::error::Error;
use crate::probe::Probe;
use crate::rail::{MemberPlace, RailElement, Rails, ShapeRow};
use crate::vector::{cross, dot, unit};

/// Places along a member that differ by less than this fraction of its length count as equal.
const ROUNDING: f64 = 1e-12;

/// A component of the internal force of a member, in its local axes.
///
/// Cut the member and take the face whose outward normal is +x. The part beyond the cut acts on it with the
/// force (N, Vy, Vz) and the moment (Mx, My, Mz), positive along +x, +y, +z and right-handed about them. So N
/// is tension, a positive Mz stretches the fibres at -y, a positive My those at +z, and between loads dMz/dx
/// = -Vy and dMy/dx = Vz.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ForceComponent {
    /// N, force per unit force.
    Axial,
    /// Vy.
    ShearY,
    /// Vz.
    ShearZ,
    /// Mx, moment per unit force.
    Torsion,
    /// My, bending in the local x-z plane.
    BendingY,
    /// Mz, bending in the local x-y plane.
    BendingZ,
}

impl ForceComponent {
    /// All six, in order.
    pub const ALL: [ForceComponent; 6] = [
        ForceComponent::Axial,
        ForceComponent::ShearY,
        ForceComponent::ShearZ,
        ForceComponent::Torsion,
        ForceComponent::BendingY,
        ForceComponent::BendingZ,
    ];

    /// The component on a face at x that balances a force f and a moment m at z on the part before it: the
    /// factors of fx fy fz mx my mz, with `lever` = x - z. Equilibrium of that part gives R = -f and M = -m +
    /// lever e_x cross f.
    #[must_use]
    pub fn balance(self, lever: f64) -> [f64; 6] {
        let mut out = [0.0; 6];
        out[self as usize] = -1.0;
        match self {
            ForceComponent::BendingY => out[2] = -lever,
            ForceComponent::BendingZ => out[1] = lever,
            _ => {}
        }
        out
    }

    /// What an axial force N of one adds to the component, by the deflection of the section in its plane and by the
    /// derivative of this deflection: the plane (0 for x-y, 1 for x-z) and both factors; `None` where it adds nothing.
    ///
    /// Moments turn with N times the deflection, and the shear force normal to the bent axis with N times its slope.
    #[must_use]
    pub fn under_tension(self) -> Option<(usize, [f64; 2])> {
        match self {
            ForceComponent::ShearY => Some((0, [0.0, -1.0])),
            ForceComponent::ShearZ => Some((1, [0.0, -1.0])),
            ForceComponent::BendingY => Some((1, [-1.0, 0.0])),
            ForceComponent::BendingZ => Some((0, [1.0, 0.0])),
            ForceComponent::Axial | ForceComponent::Torsion => None,
        }
    }
}

/// An internal force: a section of a member and the component of the force there.
#[derive(Clone, Debug, PartialEq)]
pub struct InternalForce {
    /// Identity of the member, as in [`crate::ElementMember`].
    pub member: usize,
    /// Place along the member in the direction of its own local x, 0..=1. At 0 and 1 the section is just
    /// inside.
    pub place: f64,
    /// Component of the internal force.
    pub component: ForceComponent,
    /// The component per unit load on the ends of the flexible part (fx fy fz mx my mz in local axes, first
    /// end, then last) while the rest of the structure holds the member's ends.
    pub ends: [f64; 12],
}

/// Effects of unit rail loads at any place (influence lines). An effect is a linear function of the load:
///
/// E(p) = A N(p)^T + \[p on the section's member\] e(p),
///
/// with the shape rows N of the rails, the effects A of unit loads on the node states, and the effect e of
/// the load while the ends of the member are held.
///
/// Guarantee: exact wherever the load stands, on either side of a section and at it.
///
/// # Source
/// Principle of Mueller-Breslau, by which A is a deflected shape of the structure: Ghali, Neville and Brown,
/// Structural Analysis (2009), chapter 12.
///
/// ```
/// use std::sync::Arc;
///
/// use nalgebra::DMatrix;
/// use splines::{Axis, RailElement, InfluenceLines, Flexibility, Rails, Probe};
///
/// let element = RailElement {
///     rail: 0,
///     x: [0.0, 8.0],
///     ends: [0, 1],
///     length: 8.0,
///     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     offset: [0.0; 3],
///     flexibility: Flexibility { bending_z: 1.0, ..Flexibility::default() },
///     member: None,
/// };
/// // Reaction of the left support of a simply supported beam: -1 per unit force on the left end, 1/8 per
/// // unit moment on either end.
/// let mut rows = DMatrix::zeros(1, 12);
/// (rows[(0, 1)], rows[(0, 5)], rows[(0, 11)]) = (-1.0, 0.125, 0.125);
/// let effects = InfluenceLines::new(Arc::new(Rails::new(vec![element])?), rows, vec![None])?;
/// let mut reaction = [0.0];
/// effects.fill(Probe { rail: 0, x: 2.0, axis: Axis::Vertical }, &mut reaction)?;
/// assert!((reaction[0] + 0.75).abs() < 1e-15);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct InfluenceLines {
    rails: Arc<Rails>,
    rows: DMatrix<f64>,
    sections: Vec<Option<InternalForce>>,
}

impl InfluenceLines {
    /// Effects of loads on the rails `line`.
    ///
    /// `rows` is effects x 6 S with S = `line.states()`: the effect per unit load on each degree of freedom
    /// of the node states, in the frames of the rails; infinite where the structure has no stiffness against
    /// that load. `sections` has one entry an effect, `None` where the effect is no internal force.
    ///
    /// # Errors
    /// Shapes that differ; an entry that is not a number; a place outside 0..=1.
    pub fn new(
        line: Arc<Rails>,
        rows: DMatrix<f64>,
        sections: Vec<Option<InternalForce>>,
    ) -> Result<InfluenceLines, Error> {
        let expected = [sections.len(), 6 * line.state_count()];
        let (found, columns) = rows.shape();
        if [found, columns] != expected {
            return Err(Error::EffectShape {
                rows: found,
                columns,
                expected,
            });
        }
        for (effect, section) in sections.iter().enumerate() {
            let valid = |section: &InternalForce| {
                (0.0..=1.0).contains(&section.place)
                    && section.ends.iter().all(|end| end.is_finite())
            };
            if !section.as_ref().is_none_or(valid)
                || rows.row(effect).iter().any(|entry| entry.is_nan())
            {
                return Err(Error::EffectNumber { effect });
            }
        }
        Ok(InfluenceLines {
            rails: line,
            rows,
            sections,
        })
    }

    /// Number of effects.
    #[must_use]
    pub fn len(&self) -> usize {
        self.sections.len()
    }

    /// Whether there are no effects.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sections.is_empty()
    }

    /// The rails and their elements.
    #[must_use]
    pub fn rails(&self) -> &Arc<Rails> {
        &self.rails
    }

    /// Rails and coordinates between which every effect is one function of the place of a load: ends of elements, and the sections
    /// of internal forces.
    #[must_use]
    pub fn breaks(&self) -> Vec<(usize, f64)> {
        let mut out = Vec::new();
        for element in self.rails.elements() {
            out.extend(element.x.map(|x| (element.rail, x)));
            let Some(carrier) = element.member else {
                continue;
            };
            let own = self
                .sections
                .iter()
                .flatten()
                .filter(|own| own.member == carrier.id);
            for section in own {
                let along = if carrier.reversed {
                    1.0 - section.place
                } else {
                    section.place
                };
                let x = element.x[0] + along * (element.x[1] - element.x[0]);
                out.push((element.rail, x));
            }
        }
        out
    }

    /// Writes every effect per unit force at a probe, along its axis, into `out`.
    ///
    /// Where the load stands at the section itself, the result is the mean of both sides; at an end of the
    /// member the section is inside and the load outside.
    ///
    /// # Errors
    /// A probe beyond its rail, on a rail that does not exist, or in a direction in which the structure has
    /// no stiffness; `out` of another length than [`InfluenceLines::len`].
    pub fn fill(&self, at: Probe, out: &mut [f64]) -> Result<(), Error> {
        let n = self.len();
        if out.len() != n {
            return Err(Error::EffectShape {
                rows: out.len(),
                columns: 1,
                expected: [n, 1],
            });
        }
        let mut row = ShapeRow::EMPTY;
        self.rails.row_into(at, &mut row)?;
        out.fill(0.0);
        let entries = row.indices().iter().zip(row.values());
        // Zero times an infinite effect would not be a number.
        for (&index, &shape) in entries.filter(|(_, shape)| **shape != 0.0) {
            let column = &self.rows.as_slice()[index * n..(index + 1) * n];
            out.iter_mut()
                .zip(column)
                .for_each(|(sum, entry)| *sum += shape * entry);
        }
        let element = &self.rails.elements()[row.element];
        if let Some(carrier) = element.member.filter(|_| !element.is_rigid_arm()) {
            let mut load = None;
            for (sum, section) in out.iter_mut().zip(&self.sections) {
                if let Some(section) = section
                    .as_ref()
                    .filter(|section| section.member == carrier.id)
                {
                    let load = load.get_or_insert_with(|| MemberLoad::new(element, at, &row));
                    *sum += load.with_ends_held(section) + self.under_tension(section, &row);
                }
            }
        }
        if out.iter().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(Error::NoStiffness {
                rail: at.rail,
                x: at.x,
                axis: at.axis,
            })
        }
    }

    /// One effect per unit force at a probe, along its axis: the same number as [`InfluenceLines::fill`] writes.
    ///
    /// # Errors
    /// Those of [`InfluenceLines::fill`]; an effect that does not exist.
    pub fn value(&self, effect: usize, at: Probe) -> Result<f64, Error> {
        let n = self.len();
        let Some(section) = self.sections.get(effect) else {
            return Err(Error::EffectShape {
                rows: effect + 1,
                columns: 1,
                expected: [n, 1],
            });
        };
        let row = self.rails.row(at)?;
        let mut sum = 0.0;
        for (&index, &shape) in row
            .indices()
            .iter()
            .zip(row.values())
            .filter(|(_, shape)| **shape != 0.0)
        {
            sum += shape * self.rows[(effect, index)];
        }
        let element = &self.rails.elements()[row.element];
        let carrier = element.member.filter(|_| !element.is_rigid_arm());
        let own = carrier
            .zip(section.as_ref())
            .filter(|(carrier, section)| section.member == carrier.id);
        if let Some((_, section)) = own {
            sum += MemberLoad::new(element, at, &row).with_ends_held(section)
                + self.under_tension(section, &row);
        }
        if sum.is_finite() {
            Ok(sum)
        } else {
            Err(Error::NoStiffness {
                rail: at.rail,
                x: at.x,
                axis: at.axis,
            })
        }
    }
}

impl InfluenceLines {
    /// What the axial force of a member adds to an internal force by the deflection under a load on it with the row `row`,
    /// its ends held.
    fn under_tension(&self, section: &InternalForce, row: &ShapeRow) -> f64 {
        let element = &self.rails.elements()[row.element];
        let tension = element.flexibility.tension;
        if tension == 0.0 {
            return 0.0;
        }
        let Some((plane, factors)) = section.component.under_tension() else {
            return 0.0;
        };
        let Some(clamped) = self.rails.clamped(row.element) else {
            return 0.0;
        };
        let place = MemberPlace {
            s: section.place * element.length,
            q: (1.0 - section.place) * element.length,
        };
        let deflected = clamped.section(plane, place, row.axis, row.place);
        tension * dot(&factors, &deflected)
    }
}

/// A unit rail force on a member, in the member's own axes.
struct MemberLoad {
    /// Its place along the member.
    place: f64,
    /// Length of the member.
    length: f64,
    /// Force and moment on the axis at that place.
    own: [f64; 6],
    /// Equivalent forces and moments on the ends of the flexible part.
    ends: [f64; 12],
}

impl MemberLoad {
    fn new(element: &RailElement, at: Probe, row: &ShapeRow) -> MemberLoad {
        let axes = element.member_axes();
        let in_member_axes = |v: [f64; 3]| axes.map(|axis| dot(&axis, &v));
        let force = unit(at.axis.component());
        let [f, m] = [
            in_member_axes(force),
            in_member_axes(cross(element.offset, force)),
        ];
        // Force and moment on the first end of the member, then on its last.
        let mut ends = [[0.0; 3]; 4];
        for (&index, &value) in row.indices().iter().zip(row.values()) {
            let end =
                usize::from(index / 6 != element.ends[0]) ^ usize::from(element.is_reversed());
            ends[2 * end + index % 6 / 3][index % 3] = value;
        }
        let ends = ends.map(in_member_axes);
        MemberLoad {
            place: element.place_on_member(at.x),
            length: element.length,
            own: [f[0], f[1], f[2], m[0], m[1], m[2]],
            ends: std::array::from_fn(|k| ends[k / 3][k % 3]),
        }
    }

    /// The component at a section while the ends of the member are held: that of the forces on the ends, and
    /// that of the load itself where it stands before the section.
    fn with_ends_held(&self, section: &InternalForce) -> f64 {
        let lever = section.place * self.length - self.place;
        let before = if lever.abs() > ROUNDING * self.length {
            f64::from(u8::from(lever > 0.0))
        } else if section.place == 0.0 {
            1.0
        } else if section.place == 1.0 {
            0.0
        } else {
            0.5
        };
        dot(&section.ends, &self.ends) + before * dot(&section.component.balance(lever), &self.own)
    }
}
