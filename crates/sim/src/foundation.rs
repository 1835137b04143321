//! What carries a rail: a compliance, and where its mass counts a structure with freedoms of its own.
//!
//! M q'' + C q' + K q = Phi^T F, (G + diag(1/k)) F = d - Phi q: rigid has neither G nor q, influence has G
//! alone, parts have q alone (or, without mass, G = Phi K^-1 Phi^T).

use nalgebra::DMatrix;
use splines::{Compliance, Probe};

use crate::{Irregularity, Mount, PartChain};

/// Shapes Phi of a structure's freedoms along its rails.
pub trait Shapes: Send + Sync {
    /// Displacement at `at` along its axis per unit of each freedom, and its derivative along the rail,
    /// into `value` and `slope`, of one entry a freedom.
    ///
    /// # Errors
    /// A probe beyond its rail.
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error>;
}

/// Freedoms of a structure that has mass.
pub struct Structure {
    /// M, C and K.
    pub dynamics: Dynamics,
    /// Phi.
    pub shapes: Box<dyn Shapes>,
}

/// How the freedoms of a structure move.
#[derive(Clone, Debug, PartialEq)]
pub enum Dynamics {
    /// Freedoms of any kind, n x n matrices.
    Matrices {
        /// M, symmetric and positive definite.
        mass: DMatrix<f64>,
        /// C, symmetric.
        damping: DMatrix<f64>,
        /// K, symmetric and positive definite.
        stiffness: DMatrix<f64>,
    },
    /// Natural modes of modal mass 1: q'' + 2 zeta omega q' + omega^2 q = load.
    Modes {
        /// omega, > 0, radian/time.
        omega: Vec<f64>,
        /// zeta, >= 0, one a mode.
        ratio: Vec<f64>,
    },
}

impl Dynamics {
    /// Frequencies of natural modes; empty for freedoms of any kind.
    #[must_use]
    pub fn frequencies(&self) -> &[f64] {
        match self {
            Dynamics::Matrices { .. } => &[],
            Dynamics::Modes { omega, .. } => omega,
        }
    }

    /// Number of freedoms.
    #[must_use]
    pub fn freedoms(&self) -> usize {
        match self {
            Dynamics::Matrices { mass, .. } => mass.nrows(),
            Dynamics::Modes { omega, .. } => omega.len(),
        }
    }
}

/// One rail's extent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extent {
    /// First and last coordinate; `None`: without end.
    pub range: Option<[f64; 2]>,
    /// Coordinates where the rail's give is less smooth: supports, hinges, stations, hand-overs.
    pub breaks: Vec<f64>,
}

/// One structure as the wheels feel it.
#[derive(Default)]
pub struct Foundation {
    /// G; `None`: rigid beside the freedoms of `structure`.
    pub compliance: Option<Box<dyn Compliance>>,
    /// Freedoms with mass.
    pub structure: Option<Structure>,
    /// One force a part: the wheels of rail r feel each rigid part of chain r on its own, and the rails of
    /// `compliance` and `structure` are the parts ([`PartChain::rail`]). `None`: one force a wheel.
    pub parts: Option<Vec<PartChain>>,
    /// Extents of the rails; empty: rails without end or break.
    pub rails: Vec<Extent>,
    /// Whether histories hold its freedoms and their accelerations.
    pub recorded: bool,
    /// Whether friction, drives and brakes load the structure along its rails, and feel their speed.
    pub is_dragged: bool,
    /// Shapes of the rails when nothing loads them; empty: straight.
    pub irregularities: Vec<Irregularity>,
    /// The body that carries the structure, all its supports in it; `None`: the ground.
    pub on: Option<Mount>,
}

impl Foundation {
    /// A rail that does not give.
    #[must_use]
    pub fn rigid() -> Self {
        Foundation::default()
    }

    /// A massless structure of `rails` rails.
    #[must_use]
    pub fn influence(compliance: Box<dyn Compliance>, rails: usize) -> Self {
        let extent = |rail| Extent { range: compliance.range(rail), breaks: compliance.breaks(rail) };
        Foundation {
            rails: (0..rails).map(extent).collect(),
            compliance: Some(compliance),
            ..Foundation::default()
        }
    }

    /// Coordinates along `rail` at which steps must end, between `a` and `b` in either order.
    pub(crate) fn breaks_between(&self, rail: usize, a: f64, b: f64) -> impl Iterator<Item = f64> + '_ {
        let (low, high) = (a.min(b), a.max(b));
        let own = self.rails.get(rail).map_or(&[][..], |extent| &extent.breaks);
        let corners = self.irregularities.get(rail).map_or(&[][..], Irregularity::breaks);
        let first = corners.partition_point(|x| *x < low);
        let near = corners[first..].iter().take_while(move |x| **x <= high);
        own.iter().filter(move |x| (low..=high).contains(*x)).chain(near).copied()
    }

    /// Number of freedoms with mass.
    #[must_use]
    pub fn freedoms(&self) -> usize {
        self.structure.as_ref().map_or(0, |structure| structure.dynamics.freedoms())
    }
}
