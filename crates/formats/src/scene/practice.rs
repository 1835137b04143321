//! What the codes of crane engineers need beside the scene itself: the member `practice`.

use practice::aist::CraneKind;
use practice::factor::{DriveOnset, HoistingClass, Release};
use practice::skew::Guide;
use schemars::JsonSchema;
use serde::Deserialize;

use super::pin::seat_of;
use super::{Scene, Stop};
use crate::check::Check;
use crate::fault::{Fault, number};
use crate::place::Place;
use crate::units::Dimension;

crate::object::objects!(RawPractice);

/// Words of the hoisting classes.
const HOISTING: [(&str, HoistingClass); 4] = [
    ("HC1", HoistingClass::Hc1),
    ("HC2", HoistingClass::Hc2),
    ("HC3", HoistingClass::Hc3),
    ("HC4", HoistingClass::Hc4),
];
/// Words of how drives come on.
const DRIVES: [(&str, DriveOnset); 4] = [
    ("steady", DriveOnset::Steady),
    ("smooth", DriveOnset::Smooth),
    ("sudden", DriveOnset::Sudden),
    ("backlash", DriveOnset::Backlash),
];
/// Words of how fast a payload lets go.
const RELEASE: [(&str, Release); 2] = [("slow", Release::Slow), ("rapid", Release::Rapid)];
/// Words of what guides a crane.
const GUIDE: [(&str, Guide); 2] = [("flanges", Guide::Flanges), ("rollers", Guide::Rollers)];
/// Words of kinds of cranes.
const KINDS: [(&str, CraneKind); 7] = [
    ("mill", CraneKind::Mill),
    ("ladle", CraneKind::Ladle),
    ("bucket", CraneKind::Bucket),
    ("soaking pit", CraneKind::SoakingPit),
    ("stripping", CraneKind::Stripping),
    ("motor room", CraneKind::MotorRoom),
    ("stacker", CraneKind::Stacker),
];

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawPractice {
    pub crane: Option<String>,
    pub kind: Option<String>,
    pub hoisting: Option<String>,
    pub drives: Option<String>,
    pub release: Option<String>,
    pub guide: Option<String>,
    pub approach: Option<f64>,
    pub rail_head: Option<f64>,
    pub bridge_speed: Option<f64>,
    pub trolley_speed: Option<f64>,
    pub hoist_speed: Option<f64>,
}

/// What codes ask of a crane that its scene does not say.
#[derive(Clone, Debug, PartialEq)]
pub struct Practice {
    /// Index of the body that runs on two rails.
    pub crane: usize,
    /// Its rails, as indices into the scene's.
    pub rails: [usize; 2],
    /// The body that runs on it, if there is one.
    pub trolley: Option<usize>,
    /// Bodies that hang from either.
    pub loads: Vec<usize>,
    /// Row of TR-13's table.
    pub kind: CraneKind,
    /// Hoisting class; `None`: not said.
    pub hoisting: Option<HoistingClass>,
    /// How its drives come on.
    pub drives: DriveOnset,
    /// How fast a load lets go.
    pub release: Release,
    /// What guides it.
    pub guide: Guide,
    /// Least distance of the hook from a rail; `None`: as the run has it.
    pub approach: Option<f64>,
    /// Width of the rail's head.
    pub rail_head: Option<f64>,
    /// Rated speeds of bridge, trolley and hoist; `None`: those that the scene commands.
    pub speeds: [Option<f64>; 3],
}

/// Reads the member of a scene whose bodies, trucks and ropes are known.
pub(super) fn read(
    raw: &Option<RawPractice>,
    scene: &Scene,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Practice> {
    let raw = raw.as_ref()?;
    let at = root.key("practice");
    let kind = raw.kind.as_ref().and_then(|word| check.faults.word(word, &at.key("kind"), &KINDS));
    let hoisting =
        raw.hoisting.as_ref().and_then(|word| check.faults.word(word, &at.key("hoisting"), &HOISTING));
    let drives = raw.drives.as_ref().and_then(|word| check.faults.word(word, &at.key("drives"), &DRIVES));
    let release = raw.release.as_ref().and_then(|word| check.faults.word(word, &at.key("release"), &RELEASE));
    let guide = raw.guide.as_ref().and_then(|word| check.faults.word(word, &at.key("guide"), &GUIDE));
    let mut size = |value: Option<f64>, key: &str, dimension: Dimension, hint: &str| {
        check.optional_positive(value, &at.key(key), dimension, hint)
    };
    let approach = size(raw.approach, "approach", Dimension::LENGTH, "from the hook to the nearer rail");
    let rail_head = size(raw.rail_head, "rail_head", Dimension::LENGTH, "width of the rail's head");
    let speeds = [
        size(raw.bridge_speed, "bridge_speed", Dimension::SPEED, "rated"),
        size(raw.trolley_speed, "trolley_speed", Dimension::SPEED, "rated"),
        size(raw.hoist_speed, "hoist_speed", Dimension::SPEED, "rated"),
    ];
    let (crane, place) = match &raw.crane {
        Some(name) => {
            let known = super::names(&scene.bodies, |body| &body.name);
            let place = at.key("crane");
            (super::resolve(name, &known, "body", &place, check.faults)?, place)
        }
        None => (guess(scene, &at, check)?, at),
    };
    let rails = rails_of(scene, crane, &place, check)?;
    let rides = |body: usize| {
        scene.trucks.iter().any(|truck| {
            let on = scene.structures[scene.rails[truck.rail].structure].on;
            seat(scene, truck.body).0 == body && on.is_some_and(|on| on.body == crane)
        })
    };
    let trolley = (0..scene.bodies.len()).find(|body| rides(*body));
    let holds = |body: Option<usize>| body.is_some() && (body == Some(crane) || body == trolley);
    let mut loads = Vec::new();
    for rope in &scene.ropes {
        let [from, to] = rope.bodies;
        let hung = if holds(from) { to } else { from.filter(|_| holds(to)) };
        loads.extend(hung.filter(|body| scene.bodies[*body].in_space && !loads.contains(body)));
    }
    if let Some(approach) = approach {
        let span = (across(scene, crane, rails[0]) - across(scene, crane, rails[1])).abs();
        if approach > span {
            let at = root.key("practice");
            let fault = Fault::new(&at.key("approach"), "must be within the crane's span");
            check.faults.add(fault.got(approach).hint(format!("its rails are {span} apart")));
        }
    }
    Some(Practice {
        crane,
        rails,
        trolley,
        loads,
        kind: kind.unwrap_or(CraneKind::Mill),
        hoisting,
        drives: drives.unwrap_or(DriveOnset::Smooth),
        release: release.unwrap_or(Release::Rapid),
        guide: guide.unwrap_or(Guide::Flanges),
        approach,
        rail_head,
        speeds,
    })
}

/// The one body that carries structures; without such a body the only one on rails.
fn guess(scene: &Scene, at: &Place<'_>, check: &mut Check<'_>) -> Option<usize> {
    let mut found: Vec<usize> =
        scene.structures.iter().filter_map(|structure| Some(structure.on?.body)).collect();
    if found.is_empty() {
        found = scene.trucks.iter().map(|truck| seat(scene, truck.body).0).collect();
    }
    found.sort_unstable();
    found.dedup();
    match found[..] {
        [crane] => Some(crane),
        _ => {
            let names: Vec<String> =
                found.iter().map(|body| format!("\"{}\"", scene.bodies[*body].name)).collect();
            let fault = Fault::new(at, "missing key `crane`");
            check.faults.add(fault.hint(format!("which body is the crane: {}", names.join(", "))));
            None
        }
    }
}

/// The two rails of a crane, in the order of the scene.
fn rails_of(scene: &Scene, crane: usize, at: &Place<'_>, check: &mut Check<'_>) -> Option<[usize; 2]> {
    let mut rails: Vec<usize> = scene
        .trucks
        .iter()
        .filter(|truck| seat(scene, truck.body).0 == crane)
        .map(|truck| truck.rail)
        .collect();
    rails.sort_unstable();
    rails.dedup();
    match rails[..] {
        [one, other] if across(scene, crane, one) != across(scene, crane, other) => Some([one, other]),
        _ => {
            let found = match rails.len() {
                2 => format!("trucks on both at z = {}", number(across(scene, crane, rails[0]))),
                count => count.to_string(),
            };
            let fault =
                Fault::new(at, format!("\"{}\" must run on two rails, apart", scene.bodies[crane].name));
            check.faults.add(fault.got(found).hint(
                "the codes speak of cranes on a runway of two rails; z of a truck's `at` is its place across",
            ));
            None
        }
    }
}

/// End stops on the rails of a crane that it meets itself.
pub fn end_stops<'s>(scene: &'s Scene, practice: &'s Practice) -> impl Iterator<Item = &'s Stop> {
    scene.stops.iter().filter(|stop| {
        let is_rail = stop.rail.is_some_and(|rail| practice.rails.contains(&rail));
        is_rail && stop.meetings.iter().any(|meeting| meeting.body == practice.crane)
    })
}

/// The body that a body is pinned to in the end, itself where it is not, and where its origin is from that body's.
#[must_use]
pub fn seat(scene: &Scene, body: usize) -> (usize, [f64; 3]) {
    seat_of(&scene.bodies, body).unwrap_or((body, [0.0; 3]))
}

/// Mean place of the trucks below a body, and below those pinned to it, across the track on one rail.
#[must_use]
pub fn across(scene: &Scene, body: usize, rail: usize) -> f64 {
    let places = scene.trucks.iter().filter(|truck| truck.rail == rail).filter_map(|truck| {
        let (root, arm) = seat(scene, truck.body);
        (root == body).then_some(truck.at[2] + arm[2])
    });
    let (sum, count) = places.fold((0.0, 0.0), |(sum, count), z| (sum + z, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}
