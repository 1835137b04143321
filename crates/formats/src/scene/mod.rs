//! Scenes: read, checked, names resolved, in the scene's units.

mod actuator;
mod body;
pub mod columns;
mod compare;
mod event;
mod files;
mod gauge;
mod irregularity;
mod method;
mod mount;
mod output;
mod pin;
mod practice;
mod raw;
mod read;
mod rope;
mod spin;
mod stance;
mod stop;
mod structure;
mod survey;
mod tables;
mod ties;
mod truck;
mod wheel;

pub use actuator::{Drive, Load};
pub use body::{Along, Body, FREEDOMS};
pub use compare::{Case, Document};
pub use event::Event;
pub use gauge::Gauge;
pub use method::stepper_word;
pub use output::{Fatigue, Output, Pick};
pub use practice::Practice;
pub use practice::{across, end_stops, seat};
pub(crate) use raw::{Pick as RawPick, RawColumns, RawNode, RawScene};
pub use rope::Rope;
pub use spin::Spin;
pub use stop::{Meeting, Stop};
pub use structure::{Foundation, Handover, On, Origin, PARTS, Reading, Structure, TOLERANCE, TablePair};
pub use truck::{Node, Truck};
pub use wheel::{Damper, Friction, FrictionLaw, IMPACT_EXPONENT, Lateral, Law, Vertical, Wheel};

use crate::fault::{Fault, Faults, nearest};
use crate::place::Place;
use crate::units::Units;

/// The word of the format, with its version.
pub const FORMAT: &str = "girderway-scene/1";

/// A scene, checked, with names resolved to indices.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Its name; the file's where it gives none.
    pub name: String,
    /// Units of all its numbers.
    pub units: Units,
    /// Acceleration of gravity, downwards.
    pub gravity: f64,
    /// What is computed.
    pub analysis: Analysis,
    /// What carries rails.
    pub structures: Vec<Structure>,
    /// All rails of all structures, in order.
    pub rails: Vec<SceneRail>,
    /// What runs on them.
    pub bodies: Vec<Body>,
    /// Kinds of wheels.
    pub wheels: Vec<Wheel>,
    /// Wheels under bodies.
    pub trucks: Vec<Truck>,
    /// Wheels whose spin is prescribed.
    pub spins: Vec<Spin>,
    /// Ropes.
    pub ropes: Vec<Rope>,
    /// End stops of rails, and floors.
    pub stops: Vec<Stop>,
    /// What is switched on the way.
    pub events: Vec<Event>,
    /// Forces and moments on bodies.
    pub loads: Vec<Load>,
    /// Time at which the scene ends.
    pub end: f64,
    /// Time between two rows of the history.
    pub dt: f64,
    /// What is written beside the motion.
    pub output: Output,
    /// What the codes of crane engineers need; none = they are not asked.
    pub practice: Option<Practice>,
    /// Relative error allowed to the steps.
    pub accuracy: f64,
    /// How the motion is integrated.
    pub stepping: sim::Stepping,
}

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Analysis {
    /// Motion under inertia.
    Dynamic,
    /// Equilibrium at every position of the travel.
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
    /// First and last coordinate.
    pub range: [f64; 2],
}

impl Scene {
    /// Whether some wheel pushes its rail sideways.
    #[must_use]
    pub fn pushes_sideways(&self) -> bool {
        self.trucks.iter().any(|truck| self.wheels[truck.wheel].lateral.is_some())
    }
}

/// Names with their indices, as [`resolve`] takes them.
pub fn names<T>(all: &[T], name: impl Fn(&T) -> &str) -> Vec<(&str, usize)> {
    all.iter().enumerate().map(|(index, item)| (name(item), index)).collect()
}

/// Finds a name; one that is not there is a fault that lists those that are.
pub fn resolve(
    name: &str,
    known: &[(&str, usize)],
    what: &str,
    place: &Place<'_>,
    faults: &mut Faults,
) -> Option<usize> {
    let found = known.iter().find(|(word, _)| *word == name).map(|(_, index)| *index);
    if found.is_none() {
        let words: Vec<&str> = known.iter().map(|(word, _)| *word).collect();
        let mut hint = if words.is_empty() {
            "the file has none".to_owned()
        } else {
            format!("known: {}", words.join(", "))
        };
        if let Some(near) = nearest(name, &words) {
            hint = format!("did you mean \"{near}\"? {hint}");
        }
        faults.add(
            Fault::new(place, format!("must be the name of a {what}")).got(format!("\"{name}\"")).hint(hint),
        );
    }
    found
}

/// Finds a rail by `structure.rail`, or by its own name where only one structure has it.
pub fn rail(name: &str, rails: &[SceneRail], place: &Place<'_>, faults: &mut Faults) -> Option<usize> {
    let known = names(rails, |rail| &rail.name);
    if known.is_empty() {
        // the structures have been faulted already
        return None;
    }
    resolve(name, &known, "rail, \"structure.rail\"", place, faults)
}

/// Names become parts of column and file names.
pub fn name(name: &str, place: &Place<'_>, faults: &mut Faults) {
    let fits = name.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | ' '));
    if name.trim() != name || name.is_empty() || !fits {
        let fault = Fault::new(place, "must be a name of letters, digits, spaces, `_` and `-`")
            .got(format!("{name:?}"));
        faults.add(fault.hint("names become parts of column and file names"));
    }
}
