//! Structures: what carries the rails, and how the simulation sees it.

use std::sync::Arc;

use splines::{Axis, Couplings};

use crate::spec::{GIRDER_RAIL, RailOutline, Spec};

/// Something that carries rails.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Its name.
    pub name: String,
    /// Where its influence coefficients come from.
    pub origin: Origin,
    /// Its rails.
    pub rails: Vec<RailOutline>,
    /// How the simulation models its compliance.
    pub foundation: Foundation,
    /// Whether the scene leaves the foundation to the run ("auto"); then `foundation` is the default.
    pub auto: bool,
    /// Damping ratio of its natural modes, from 0 to below 1.
    pub damping: f64,
    /// How its influence table is interpolated.
    pub interpolation: TableInterpolation,
    /// Which couplings between its wheels are taken into account.
    pub couplings: Couplings,
    /// Relative error that the choice of the foundation may cause.
    pub tolerance: f64,
    /// Places whose displacement is recorded.
    pub gauges: Vec<Gauge>,
    /// Whether friction, drives and brakes load it along its rails.
    pub longitudinal: bool,
    /// Irregularities of its unloaded rails, one for each rail; empty where all are straight.
    pub irregularities: Vec<sim::Irregularity>,
    /// The body that carries it; none: the ground.
    pub carrier: Option<CarriedBy>,
}

/// What carries a structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedBy {
    /// Index of the body.
    pub body: usize,
    /// Position of the spec's origin relative to the body's, length.
    pub at: [f64; 3],
    /// Which degrees of freedom x, y, z, roll, yaw, pitch of the body's origin may change.
    pub may_move: [bool; 6],
}

/// Where influence coefficients come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A beam spec, in the scene's units.
    Spec {
        /// The file, as the scene names it.
        file: String,
        /// Its contents.
        spec: Arc<Spec>,
    },
    /// SPLINE tables of an ADAMS data set, in the scene's units.
    Tables {
        /// The file, as the scene names it.
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
                vec![RailOutline { name: GIRDER_RAIL.to_owned(), range, stations }]
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
    /// The same, laterally.
    pub lateral: Option<Vec<Vec<f64>>>,
}

/// Model of a structure's compliance under wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Foundation {
    /// Rigid.
    Rigid,
    /// A chain of rigid parts with massless beams between their centres.
    Parts {
        /// Number of parts.
        count: usize,
        /// How a wheel passes from one part to the next.
        handover: Handover,
        /// Damping ratio of each natural mode, where the parts have mass.
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
        /// Whether it has mass and moves in natural modes.
        has_mass: bool,
        /// Number of modes; none: all modes of the mesh.
        modes: Option<usize>,
        /// Damping ratio of each mode.
        damping: f64,
        /// Damper of each tie, force time/length.
        c: f64,
    },
}

/// How a wheel passes from one rigid part to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Handover {
    /// One contact, whose part is blended by STEP over a length about the joint.
    Blend {
        /// Length of the blend; none: from centre to centre of the parts.
        length: Option<f64>,
    },
    /// One unilateral force for each part, faded by STEP over a length about the joint.
    PerPart {
        /// Length of the fading; none: from centre to centre of the parts.
        length: Option<f64>,
    },
}

/// Interpolation of an influence table between its stations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableInterpolation {
    /// The exact surface of the beams.
    Exact,
    /// Natural cubic splines along both directions.
    Natural,
    /// AKISPL along the position of the load, linear along that of the deflection.
    Akispl,
    /// CUBSPL along the position of the load, linear along that of the deflection.
    Cubspl,
}

impl TableInterpolation {
    /// The interpolations by their words in scenes.
    pub const WORDS: [(&'static str, TableInterpolation); 4] = [
        ("exact", TableInterpolation::Exact),
        ("natural", TableInterpolation::Natural),
        ("akispl", TableInterpolation::Akispl),
        ("cubspl", TableInterpolation::Cubspl),
    ];

    /// Its word in scenes.
    #[must_use]
    pub fn word(self) -> &'static str {
        TableInterpolation::WORDS.iter().find(|(_, reading)| *reading == self).map_or("", |(word, _)| *word)
    }
}

impl Foundation {
    /// Its word in scenes.
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

/// Default of [`Structure::tolerance`].
pub const TOLERANCE: f64 = 1e-3;

/// Default number of modes.
pub const MODES: usize = 5;

/// Default number of elements of each member.
pub const ELEMENTS: usize = 8;

/// Default number of parts of a chain.
pub const DEFAULT_PARTS: usize = 2;

/// A place whose displacement a run records as `<structure>.<name>`.
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
