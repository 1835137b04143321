//! Input of the crane design codes that is not part of the motion.

use practice::aist::{BuildingClass, CraneKind};
use practice::duty::FatigueClass;
use practice::factor::{DriveOnset, HoistingClass, Release};
use practice::limits::{DeflectionLimit, ServiceClass};
use practice::skew::Guide;

/// Properties of a crane that the codes require in addition to the rest of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Practice {
    /// Codes by whose limits a run is judged, as written.
    pub codes: Vec<String>,
    /// Limits of one's own.
    pub limits: Vec<DeflectionLimit>,
    /// Index of the body that runs on two rails.
    pub crane: usize,
    /// Its rails, as indices into the rails of the scene.
    pub rails: [usize; 2],
    /// The body that runs on the crane, if there is one.
    pub trolley: Option<usize>,
    /// Bodies that hang from the crane or the trolley.
    pub loads: Vec<usize>,
    /// Row of the table in TR-13.
    pub kind: CraneKind,
    /// Service class by CMAA 70; none if it is not specified.
    pub class: Option<ServiceClass>,
    /// Class of load effect history of EN 1991-3; none if it is not specified.
    pub s_class: Option<FatigueClass>,
    /// Class of the mill building in TR-13; none if it is not specified.
    pub building_class: Option<BuildingClass>,
    /// Hoisting class; none if it is not specified.
    pub hoisting: Option<HoistingClass>,
    /// Onset of the drive forces.
    pub drives: DriveOnset,
    /// How rapidly a payload is released.
    pub release: Release,
    /// How the crane is guided.
    pub guide: Guide,
    /// Smallest distance of the hook from a rail, length; none if that of the run applies.
    pub approach: Option<f64>,
    /// Width of the rail head, length.
    pub rail_head: Option<f64>,
    /// Rated speeds of bridge, trolley and hoist, length / time; none if those that the scene prescribes apply.
    pub speeds: [Option<f64>; 3],
    /// Stroke of the bumpers, length; none if it is not specified.
    pub bumper_stroke: Option<f64>,
    /// Ratio of the mean force of the bumpers to their largest force.
    pub bumper_efficiency: f64,
}
