//! Structures, which carry the rails, and their models in the simulation.

use std::sync::Arc;

use splines::{Axis, Couplings};

use crate::spec::{GIRDER_RAIL, RailOutline, Spec};

/// A structure that carries rails.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Its name.
    pub name: String,
    /// Source of its influence coefficients.
    pub origin: Origin,
    /// Its rails.
    pub rails: Vec<RailOutline>,
    /// Model of its compliance in the simulation.
    pub foundation: Foundation,
    /// Whether the foundation is chosen by the run ("auto"). In this case `foundation` is the default.
    pub auto: bool,
    /// Damping ratio of its natural modes, at least 0 and below 1.
    pub damping: f64,
    /// Interpolation of its influence table.
    pub interpolation: TableInterpolation,
    /// Couplings between its wheels that are taken into account.
    pub couplings: Couplings,
    /// Relative error permitted for the choice of the foundation.
    pub tolerance: f64,
    /// Measure of that error.
    pub measure: sim::Measure,
    /// Points whose displacement is recorded.
    pub gauges: Vec<Gauge>,
    /// Whether friction, drives and brakes load it in the longitudinal direction.
    pub longitudinal: bool,
    /// Irregularities of its unloaded rails, one for each rail; empty if all rails are straight.
    pub irregularities: Vec<sim::Irregularity>,
    /// Whether the wheels at rest at the start are part of its preload.
    pub preload: bool,
    /// The body that carries it; none if the ground does.
    pub carrier: Option<CarriedBy>,
}

/// The body that carries a structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedBy {
    /// Index of the body.
    pub body: usize,
    /// Position of the origin of the spec relative to that of the body, length.
    pub at: [f64; 3],
    /// Which of the degrees of freedom x, y, z, roll, yaw, pitch of the origin of the body can change.
    pub may_move: [bool; 6],
}

/// Source of influence coefficients.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A beam spec, in the scene's units.
    Spec {
        /// The file, as named in the scene.
        file: String,
        /// Its contents.
        spec: Arc<Spec>,
    },
    /// SPLINE tables of an ADAMS data set, in the scene's units.
    Tables {
        /// The file, as named in the scene.
        file: String,
        /// Stations and values of the tables.
        tables: Arc<TablePair>,
    },
}

impl Origin {
    /// Its rails.
    pub(in crate::scene) fn rails(&self) -> Vec<RailOutline> {
        match self {
            Origin::Spec { spec, .. } => spec.rails(),
            Origin::Tables { tables, .. } => {
                let stations = tables.stations.clone();
                let ends = stations.first().zip(stations.last());
                let range = ends.map_or([0.0; 2], |(first, last)| [*first, *last]);
                vec![RailOutline {
                    name: GIRDER_RAIL.to_owned(),
                    range,
                    stations,
                }]
            }
        }
    }
}

/// Two SPLINE tables at the same stations.
#[derive(Clone, Debug, PartialEq)]
pub struct TablePair {
    /// Stations of the rail.
    pub stations: Vec<f64>,
    /// `vertical[i][j]`: vertical deflection at station i per unit vertical load at station j, length / force.
    pub vertical: Option<Vec<Vec<f64>>>,
    /// The same for the lateral direction.
    pub lateral: Option<Vec<Vec<f64>>>,
}

/// Model of the compliance of a structure under wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Foundation {
    /// Rigid.
    Rigid,
    /// A chain of rigid parts with massless beams between their centres.
    Parts {
        /// Number of parts.
        count: usize,
        /// Transition of a wheel from one part to the next.
        handover: Handover,
        /// Damping ratio of each natural mode, if the parts have mass.
        damping: f64,
    },
    /// Its influence coefficients, without mass.
    Influence,
    /// Its lowest natural modes, with the residual flexibility of the others.
    Modal {
        /// Number of modes.
        modes: usize,
        /// Damping ratio of each.
        damping: f64,
    },
    /// All modes of a finite-element mesh.
    Full {
        /// Number of elements of each member.
        elements: usize,
        /// Damping ratio of each mode.
        damping: f64,
    },
    /// A rail on elastic ties.
    Ties {
        /// Whether it has mass and its motion is represented by natural modes.
        has_mass: bool,
        /// Number of modes; none for all modes of the mesh.
        modes: Option<usize>,
        /// Damping ratio of each mode.
        damping: f64,
        /// Damper of each tie, force time/length.
        c: f64,
    },
}

/// Transition of a wheel from one rigid part to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Handover {
    /// One contact, whose assignment to the parts is blended by STEP over a length about the joint.
    Blend {
        /// Length of the blend; none for the distance between the centres of the parts.
        length: Option<f64>,
    },
    /// One unilateral force for each part, faded by STEP over a length about the joint.
    PerPart {
        /// Length of the fading; none for the distance between the centres of the parts.
        length: Option<f64>,
    },
}

/// Interpolation of an influence table between its stations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableInterpolation {
    /// The exact compliance of the beams.
    Exact,
    /// Natural cubic splines in both directions.
    Natural,
    /// AKISPL over the position of the load, linear over the position of the deflection.
    Akispl,
    /// CUBSPL over the position of the load, linear over the position of the deflection.
    Cubspl,
}

impl TableInterpolation {
    /// The interpolations and their keywords in scenes.
    pub const WORDS: [(&'static str, TableInterpolation); 4] = [
        ("exact", TableInterpolation::Exact),
        ("natural", TableInterpolation::Natural),
        ("akispl", TableInterpolation::Akispl),
        ("cubspl", TableInterpolation::Cubspl),
    ];

    /// Its keyword in scenes.
    #[must_use]
    pub fn word(self) -> &'static str {
        TableInterpolation::WORDS
            .iter()
            .find(|(_, reading)| *reading == self)
            .map_or("", |(word, _)| *word)
    }
}

impl Foundation {
    /// Its keyword in scenes.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Foundation::Rigid => "rigid",
            Foundation::Parts { .. } => "parts",
            Foundation::Influence => "influence",
            Foundation::Modal { .. } => "modal",
            Foundation::Full { .. } => "full",
            Foundation::Ties { .. } => "ties",
        }
    }
}

/// Default of [`Structure::tolerance`]. The loads, masses and stiffnesses of a crane and its runway are known to one per
/// cent at best, and so are the dynamic factors of codes.
pub const TOLERANCE: f64 = 1e-2;

/// Default number of modes.
pub const MODES: usize = 5;

/// Default number of elements of each member.
pub const ELEMENTS: usize = 8;

/// Default number of parts of a chain.
pub const DEFAULT_PARTS: usize = 2;

/// A point whose displacement a run records as `<structure>.<name>`.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauge {
    /// Its name.
    pub name: String,
    /// Rail of the structure.
    pub rail: usize,
    /// Coordinate along the rail, length.
    pub x: f64,
    /// Direction; vertical displacements are recorded positive downwards.
    pub axis: Axis,
}
