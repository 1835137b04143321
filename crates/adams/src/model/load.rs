//! SFORCE, VFORCE, GFORCE, BEAM.

use super::Beam;
use crate::Scalar;
use crate::code::View;
use crate::space::{Vector, apply, column, norm, resolve, scale, subtract, vector};

/// A force and torque on the marker I, and the opposite on the part of J at the same place.
#[derive(Clone, Debug)]
pub(crate) struct Load {
    pub kind: Kind,
    pub id: u32,
    pub i: usize,
    pub j: usize,
    pub law: Law,
}

/// Kinds of loads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Sforce,
    Vforce,
    Gforce,
    Beam,
}

#[derive(Clone, Debug)]
pub(crate) enum Law {
    /// Along the line from J to I, or along z of J if it acts on I alone.
    Line {
        slot: usize,
        alone: bool,
    },
    /// About z of J.
    Twist {
        slot: usize,
        alone: bool,
    },
    /// Slots of FX, FY, FZ, TX, TY, TZ along the axes of a marker.
    Components {
        slots: [Option<usize>; 6],
        rm: usize,
    },
    Beam(Box<Beam>),
}

const COMPONENTS: [&str; 6] = ["FX", "FY", "FZ", "TX", "TY", "TZ"];

impl Load {
    /// Keyword, and the argument of a component.
    pub fn label(&self, component: usize) -> (&'static str, &'static str) {
        let argument = match self.law {
            Law::Components { .. } => COMPONENTS.get(component).copied().unwrap_or("FUNCTION"),
            _ => "FUNCTION",
        };
        (self.kind.keyword(), argument)
    }

    /// The slot that a component (2..4, 6..8) in the axes of `frame` is without further arithmetic: those of
    /// its own reference marker. `Some(None)` is zero.
    pub fn direct(&self, component: usize, frame: Option<usize>) -> Option<Option<usize>> {
        match (&self.law, component) {
            (Law::Components { slots, rm }, 2..=4) if frame == Some(*rm) => Some(slots[component - 2]),
            (Law::Components { slots, rm }, 6..=8) if frame == Some(*rm) => Some(slots[component - 3]),
            _ => None,
        }
    }

    /// The slots of the force (components to 4) or of the torque.
    pub fn part(&self, component: usize) -> Vec<usize> {
        match &self.law {
            Law::Line { slot, .. } | Law::Twist { slot, .. } => vec![*slot],
            Law::Components { slots, .. } => {
                let half = if component <= 4 { &slots[..3] } else { &slots[3..] };
                half.iter().flatten().copied().collect()
            }
            Law::Beam(_) => Vec::new(),
        }
    }

    /// Force and torque on I at I, along ground axes.
    pub fn wrench<T: Scalar>(&self, view: &View<'_, T>) -> [Vector<T>; 2] {
        let zero = || vector([0.0; 3]);
        let (i, j) = (view.frame(Some(self.i)), view.frame(Some(self.j)));
        let value = |slot: usize| view.values.get(slot).cloned().unwrap_or(T::constant(0.0));
        match &self.law {
            Law::Line { slot, alone: true } => [scale(&column(&j.axes, 2), &value(*slot)), zero()],
            Law::Line { slot, alone: false } => {
                let d = subtract(&i.origin, &j.origin);
                let length = norm(&d);
                if length.value() == 0.0 {
                    return [zero(), zero()];
                }
                [scale(&d, &value(*slot).over(&length)), zero()]
            }
            Law::Twist { slot, .. } => [zero(), scale(&column(&j.axes, 2), &value(*slot))],
            Law::Components { slots, rm } => {
                let axes = &view.frame(Some(*rm)).axes;
                let three =
                    |from: usize| std::array::from_fn(|k| slots[from + k].map_or(T::constant(0.0), value));
                [apply(axes, &three(0)), apply(axes, &three(3))]
            }
            Law::Beam(beam) => beam.wrench(i, j),
        }
    }

    /// The six components as they are defined.
    pub fn components(&self, view: &View<'_, f64>) -> [f64; 6] {
        let value = |slot: usize| view.values.get(slot).copied().unwrap_or(0.0);
        match &self.law {
            Law::Line { slot, .. } => [value(*slot), 0.0, 0.0, 0.0, 0.0, 0.0],
            Law::Twist { slot, .. } => [0.0, 0.0, 0.0, value(*slot), 0.0, 0.0],
            Law::Components { slots, .. } => slots.map(|slot| slot.map_or(0.0, value)),
            Law::Beam(_) => {
                let axes = &view.frame(Some(self.j)).axes;
                let [force, torque] = self.wrench(view).map(|vector| resolve(axes, &vector));
                [force[0], force[1], force[2], torque[0], torque[1], torque[2]]
            }
        }
    }

    /// Whether J is left alone.
    pub fn alone(&self) -> bool {
        matches!(self.law, Law::Line { alone: true, .. } | Law::Twist { alone: true, .. })
    }
}

impl Kind {
    pub fn keyword(self) -> &'static str {
        match self {
            Kind::Sforce => "SFORCE",
            Kind::Vforce => "VFORCE",
            Kind::Gforce => "GFORCE",
            Kind::Beam => "BEAM",
        }
    }
}
