//! SFORCE, VFORCE, GFORCE and BEAM: forces and torques between two markers.

use super::beam::Beam;
use super::configuration::Configuration;
use crate::Scalar;
use crate::kinematics::vector::{Vector, apply, column, norm, resolve, scale, subtract, vector};

/// A force and torque on the part of marker I at I, with the opposite force and torque on the part of J at
/// the same point.
#[derive(Clone, Debug)]
pub(crate) struct AppliedForce {
    pub kind: LoadKind,
    pub id: u32,
    pub i: usize,
    pub j: usize,
    pub law: Law,
}

/// The kind of a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum LoadKind {
    Sforce,
    Vforce,
    Gforce,
    Beam,
}

/// How a load follows from the values of its expressions.
#[derive(Clone, Debug)]
pub(crate) enum Law {
    /// A force along the line from J to I, or along z of J if it acts on I only.
    Force { slot: usize, action_only: bool },
    /// A torque about z of J.
    Torque { slot: usize, action_only: bool },
    /// Slots of FX, FY, FZ, TX, TY, TZ along the axes of the marker `rm`; `None` is zero.
    Components {
        slots: [Option<usize>; 6],
        rm: usize,
    },
    /// A massless beam.
    Beam(Box<Beam>),
}

/// The arguments of the components of a VFORCE or GFORCE.
pub(super) const COMPONENTS: [&str; 6] = ["FX", "FY", "FZ", "TX", "TY", "TZ"];

impl AppliedForce {
    /// The keyword, and the argument whose expression gives a component.
    pub fn label(&self, component: usize) -> (&'static str, &'static str) {
        let argument = match self.law {
            Law::Components { .. } => COMPONENTS.get(component).copied().unwrap_or("FUNCTION"),
            _ => "FUNCTION",
        };
        (self.kind.keyword(), argument)
    }

    /// The slot that equals a component (2 to 4, 6 to 8) in the axes of `frame`, which must be those of the
    /// load's own marker RM. `None` if the component needs arithmetic, `Some(None)` if it is zero.
    pub fn direct(&self, component: usize, frame: Option<usize>) -> Option<Option<usize>> {
        match (&self.law, component) {
            (Law::Components { slots, rm }, 2..=4) if frame == Some(*rm) => {
                Some(slots[component - 2])
            }
            (Law::Components { slots, rm }, 6..=8) if frame == Some(*rm) => {
                Some(slots[component - 3])
            }
            _ => None,
        }
    }

    /// The slots of the force (components 1 to 4) or of the torque (5 to 8).
    pub fn part(&self, component: usize) -> Vec<usize> {
        match &self.law {
            Law::Force { slot, .. } | Law::Torque { slot, .. } => vec![*slot],
            Law::Components { slots, .. } => {
                let half = if component <= 4 {
                    &slots[..3]
                } else {
                    &slots[3..]
                };
                half.iter().flatten().copied().collect()
            }
            Law::Beam(_) => Vec::new(),
        }
    }

    /// The force on I and the torque about I, in ground axes.
    pub fn wrench<T: Scalar>(&self, at: &Configuration<T>) -> [Vector<T>; 2] {
        let zero = || vector([0.0; 3]);
        let (i, j) = (at.frame(Some(self.i)), at.frame(Some(self.j)));
        let value = |slot: usize| at.values.get(slot).cloned().unwrap_or(T::constant(0.0));
        match &self.law {
            Law::Force {
                slot,
                action_only: true,
            } => [scale(&column(&j.axes, 2), &value(*slot)), zero()],
            Law::Force {
                slot,
                action_only: false,
            } => {
                let d = subtract(&i.origin, &j.origin);
                let length = norm(&d);
                if length.value() == 0.0 {
                    return [zero(), zero()];
                }
                [scale(&d, &value(*slot).over(&length)), zero()]
            }
            Law::Torque { slot, .. } => [zero(), scale(&column(&j.axes, 2), &value(*slot))],
            Law::Components { slots, rm } => {
                let axes = &at.frame(Some(*rm)).axes;
                let three = |from: usize| {
                    std::array::from_fn(|k| slots[from + k].map_or(T::constant(0.0), value))
                };
                [apply(axes, &three(0)), apply(axes, &three(3))]
            }
            Law::Beam(beam) => beam.wrench(i, j),
        }
    }

    /// The six components in the axes in which the statement defines them.
    pub fn components(&self, at: &Configuration<f64>) -> [f64; 6] {
        let value = |slot: usize| at.values.get(slot).copied().unwrap_or(0.0);
        match &self.law {
            Law::Force { slot, .. } => [value(*slot), 0.0, 0.0, 0.0, 0.0, 0.0],
            Law::Torque { slot, .. } => [0.0, 0.0, 0.0, value(*slot), 0.0, 0.0],
            Law::Components { slots, .. } => slots.map(|slot| slot.map_or(0.0, value)),
            Law::Beam(_) => {
                let axes = &at.frame(Some(self.j)).axes;
                let [force, torque] = self.wrench(at).map(|vector| resolve(axes, &vector));
                [
                    force[0], force[1], force[2], torque[0], torque[1], torque[2],
                ]
            }
        }
    }

    /// Whether the load acts on I only, without reaction on J.
    pub fn action_only(&self) -> bool {
        matches!(
            self.law,
            Law::Force {
                action_only: true,
                ..
            } | Law::Torque {
                action_only: true,
                ..
            }
        )
    }
}

impl LoadKind {
    pub fn keyword(self) -> &'static str {
        match self {
            LoadKind::Sforce => "SFORCE",
            LoadKind::Vforce => "VFORCE",
            LoadKind::Gforce => "GFORCE",
            LoadKind::Beam => "BEAM",
        }
    }
}
