//! A checked scene.

use sim::Method;

use super::actuator::{Event, Load, Rope, Spin, Stop};
use super::body::{Body, seat_of};
use super::output::Output;
use super::practice::Practice;
use super::structure::Structure;
use super::truck::Truck;
use super::wheel::WheelKind;
use crate::practice_words::LateralSection;
use crate::units::Units;

/// Value of the member `format`: name and version of the format.
pub const FORMAT: &str = "girderway-scene/1";

/// A checked scene, with names resolved to indices.
///
/// All numbers are in [`Scene::units`], times in seconds.
///
/// ```
/// use std::path::Path;
///
/// use formats::scene::{Document, Scene, root_body};
///
/// let document = Document::open(Path::new("../../examples/wheel/scene.json")).expect("an example is right");
/// let scene: &Scene = document.scene();
/// assert_eq!((scene.name.as_str(), scene.end, scene.dt), ("wheel", 2.0, 0.005));
/// assert_eq!(scene.rails[scene.trucks[0].rail].name, "floor.rail");
/// assert_eq!(root_body(scene, 0), (0, [0.0; 3]), "the hub is pinned to no other body");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Its name; by default the name of the file.
    pub name: String,
    /// Units of all its numbers.
    pub units: Units,
    /// Acceleration of gravity, length / time^2, acting downwards; not negative.
    pub gravity: f64,
    /// Type of the analysis.
    pub analysis: Analysis,
    /// Structures, which carry rails.
    pub structures: Vec<Structure>,
    /// All rails of all structures, in order.
    pub rails: Vec<SceneRail>,
    /// Bodies that run on rails, are pinned to each other, or hang from ropes.
    pub bodies: Vec<Body>,
    /// Kinds of wheels.
    pub wheels: Vec<WheelKind>,
    /// Trucks: wheels under a body on one rail.
    pub trucks: Vec<Truck>,
    /// Wheels whose spin is prescribed.
    pub spins: Vec<Spin>,
    /// Ropes.
    pub ropes: Vec<Rope>,
    /// End stops of rails, and floors.
    pub stops: Vec<Stop>,
    /// Events: actions on conditions.
    pub events: Vec<Event>,
    /// Forces and moments on bodies.
    pub loads: Vec<Load>,
    /// Time at which the run ends, s.
    pub end: f64,
    /// Time between two rows of the history, s.
    pub dt: f64,
    /// Output in addition to the motion.
    pub output: Output,
    /// Input of the crane design codes; none if the codes are not applied.
    pub practice: Option<Practice>,
    /// What resists lateral moments in stresses of girders; none if stresses are not requested.
    pub lateral_section: Option<LateralSection>,
    /// Relative error tolerance of the time steps.
    pub accuracy: f64,
    /// Method of time integration.
    pub stepping: sim::Stepping,
}

/// Type of an analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Analysis {
    /// Equations of motion.
    Dynamic,
    /// Static equilibrium at every position along the travel.
    QuasiStatic,
}

/// One rail of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneRail {
    /// `<structure>.<rail>`.
    pub name: String,
    /// Index of its structure.
    pub structure: usize,
    /// Index within the structure.
    pub rail: usize,
    /// First and last coordinate, length.
    pub range: [f64; 2],
}

impl Scene {
    /// Whether some wheel has flanges, which load its rail laterally.
    #[must_use]
    pub fn has_flanges(&self) -> bool {
        self.trucks
            .iter()
            .any(|truck| self.wheels[truck.wheel].lateral.is_some())
    }
}

/// End stops on the rails of a crane that limit the travel of the crane itself.
pub fn end_stops<'s>(scene: &'s Scene, practice: &'s Practice) -> impl Iterator<Item = &'s Stop> {
    scene.stops.iter().filter(|stop| {
        let is_rail = stop.rail.is_some_and(|rail| practice.rails.contains(&rail));
        is_rail
            && stop
                .points
                .iter()
                .any(|meeting| meeting.body == practice.crane)
    })
}

/// The root body of the tree of pins that contains a body (the body itself if it is not pinned), and the position of
/// the origin of the body relative to that of the root.
#[must_use]
pub fn root_body(scene: &Scene, body: usize) -> (usize, [f64; 3]) {
    seat_of(&scene.bodies, body).unwrap_or((body, [0.0; 3]))
}

/// Mean lateral position, length, of the trucks on one rail that support a body and the bodies pinned to it; 0 if
/// there are none.
#[must_use]
pub fn mean_lateral_position(scene: &Scene, body: usize, rail: usize) -> f64 {
    let places = scene
        .trucks
        .iter()
        .filter(|truck| truck.rail == rail)
        .filter_map(|truck| {
            let (root, arm) = root_body(scene, truck.body);
            (root == body).then_some(truck.at[2] + arm[2])
        });
    let (sum, count) = places.fold((0.0, 0.0), |(sum, count), z| (sum + z, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// Keywords of the methods of integration.
pub const STEPPERS: [(&str, Method); 7] = [
    ("auto", Method::Auto),
    ("sdirk4", Method::Sdirk4),
    ("esdirk5", Method::Esdirk5),
    ("radau", Method::Radau),
    ("series", Method::Series),
    ("gauss2", Method::Gauss2),
    ("gauss3", Method::Gauss3),
];

/// Keyword of a method of integration.
#[must_use]
pub fn stepper_word(method: Method) -> &'static str {
    STEPPERS
        .iter()
        .find(|(_, known)| *known == method)
        .map_or("", |(word, _)| *word)
}
