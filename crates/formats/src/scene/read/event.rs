//! Events: actions that are carried out when a quantity of the run crosses a value.

use sim::{Action, Channel, Compare, Condition, Rule};

use crate::check::Check;
use crate::scene::motion::wheels;
use crate::scene::quantity::{Quantity, quantities};
use crate::scene::raw::{RawDo, RawEvent, RawFollow, RawHoist};
use crate::scene::values::actuator::{Event, Rope};
use crate::scene::values::body::{Body, BodyMotion};
use crate::scene::values::scene::{Analysis, Scene};
use crate::text::fault::{Fault, nearest, number};
use crate::text::names::{check_name, names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

/// Adds a brake that is not applied by time to free bodies that only events brake.
pub(super) fn fit_brakes(raw: &[RawEvent], bodies: &mut [Body]) {
    for body in bodies
        .iter_mut()
        .filter(|body| body.brake.is_none() && body.motion.is_free())
    {
        if raw.iter().any(|event| event.brakes(&body.name)) {
            body.brake = Some(f64::INFINITY);
        }
    }
}

/// Reads the events of a scene whose bodies, trucks, ropes and stops have already been read.
pub(super) fn read_all(raw: &[RawEvent], scene: &Scene, check: &mut Check<'_>) -> Vec<Event> {
    if raw.is_empty() {
        return Vec::new();
    }
    let root = Place::root();
    let list = root.key("events");
    if scene.analysis == Analysis::QuasiStatic {
        let fault = Fault::new(&list, "a quasi-static analysis cannot have events").at_key();
        check
            .faults
            .add(fault.hint("leave `analysis` out to solve the equations of motion"));
    }
    let known = quantities(scene);
    let mut events: Vec<Event> = Vec::new();
    for (index, raw) in raw.iter().enumerate() {
        let at = list.index(index);
        let name = raw
            .name
            .clone()
            .unwrap_or_else(|| format!("event{}", index + 1));
        check_name(&name, &at.key("name"), check.faults);
        let when = check.faults.require(&raw.when, &at, "when").cloned();
        let place = at.key("when");
        let condition = when
            .as_ref()
            .and_then(|text| read_condition(text, &known, scene, &place, check));
        let actions = check.faults.require(&raw.actions, &at, "do");
        let actions = actions.and_then(|raw| read_actions(raw, scene, &at.key("do"), check));
        let (Some(condition), Some((actions, what))) = (condition, actions) else {
            continue;
        };
        let event = Event {
            name,
            when: when.unwrap_or_default(),
            description: what,
            rule: Rule {
                when: condition,
                actions,
            },
        };
        compare_with(&event, &events, &at, check);
        events.push(event);
    }
    events
}

/// Compares an event with the previous ones. Its name must be unique, no previous event may end the run before its
/// condition can be met, and actions with the same condition must not contradict each other.
fn compare_with(event: &Event, before: &[Event], at: &Place<'_>, check: &mut Check<'_>) {
    if before.iter().any(|other| other.name == event.name) {
        let expected = format!(
            "the name \"{}\" is already used by another event",
            event.name
        );
        check.faults.add(Fault::new(&at.key("name"), expected));
    }
    for other in before {
        let ends = other.rule.actions.contains(&Action::End);
        if let (true, Some(end), Some(time)) =
            (ends, time_of(&other.rule.when), time_of(&event.rule.when))
            && end < time
        {
            let expected = format!(
                "can never be met: {} ends the run at {}",
                other.name,
                number(end)
            );
            check
                .faults
                .add(Fault::new(&at.key("when"), expected).got(format!("{:?}", event.when)));
        }
        let together = other.rule.when == event.rule.when;
        let pairs = || {
            event
                .rule
                .actions
                .iter()
                .flat_map(|a| other.rule.actions.iter().map(move |b| (a, b)))
        };
        if together && pairs().any(|(a, b)| contradict(a, b)) {
            let expected = format!(
                "contradicts {}, which has the same condition: {}",
                other.name, other.description
            );
            let fault = Fault::new(&at.key("do"), expected).got(event.description.clone());
            check
                .faults
                .add(fault.hint("give them different conditions"));
        }
    }
}

/// Whether two simultaneous actions contradict each other.
fn contradict(a: &Action, b: &Action) -> bool {
    match (a, b) {
        (Action::Brake { body: a, on: x }, Action::Brake { body: b, on: y }) => a == b && x != y,
        (Action::Drive { body: a, speed: x }, Action::Drive { body: b, speed: y }) => {
            a == b && x != y
        }
        (Action::Hoist { rope: a, speed: x }, Action::Hoist { rope: b, speed: y }) => {
            a == b && x != y
        }
        (Action::Hoist { rope: a, .. }, Action::Release { rope: b })
        | (Action::Release { rope: a }, Action::Hoist { rope: b, .. }) => a == b,
        _ => false,
    }
}

/// The time from which a condition that depends on time alone is met.
fn time_of(condition: &Condition) -> Option<f64> {
    let rises = matches!(condition.compare, Compare::AtLeast | Compare::Above);
    (rises && matches!(condition.terms[..], [(Channel::Time, _)])).then_some(condition.level)
}

/// `<quantity> <comparison> <number>`.
fn read_condition(
    text: &str,
    known: &[Quantity],
    scene: &Scene,
    place: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Condition> {
    let words = [
        (">=", Compare::AtLeast),
        ("<=", Compare::AtMost),
        (">", Compare::Above),
        ("<", Compare::Below),
    ];
    let hint = "such as \"trolley.x >= 44\", with >=, >, <= or <";
    let split = words
        .iter()
        .find_map(|(word, compare)| text.split_once(word).map(|(a, b)| (a, *compare, b)));
    let parts = split.and_then(|(name, compare, level)| {
        let level = level
            .trim()
            .parse()
            .ok()
            .filter(|level: &f64| level.is_finite())?;
        Some((name.trim(), compare, level))
    });
    let Some((name, compare, level)) = parts else {
        let fault = Fault::new(place, "must be a quantity, a comparison and a number");
        check.faults.add(fault.got(format!("{text:?}")).hint(hint));
        return None;
    };
    let Some(quantity) = known.iter().find(|quantity| quantity.name == name) else {
        let names: Vec<&str> = known
            .iter()
            .map(|quantity| quantity.name.as_str())
            .collect();
        let owner = name.split_once('.').map_or(name, |(owner, _)| owner);
        let own: Vec<&str> = names
            .iter()
            .copied()
            .filter(|known| known.split('.').next() == Some(owner))
            .collect();
        let mut hint = match &own[..] {
            [] => "quantities have the names of the columns of the history".to_owned(),
            own => format!("known: {}", own.join(", ")),
        };
        if let Some(near) = nearest(name, &names) {
            hint = format!("did you mean \"{near}\"? {hint}");
        }
        check.faults.add(
            Fault::new(place, "must begin with the name of a quantity")
                .got(format!("\"{name}\""))
                .hint(hint),
        );
        return None;
    };
    let level = check.number(level, place, quantity.dimension);
    let condition = Condition {
        terms: quantity.terms.clone(),
        compare,
        level,
    };
    if let Some(why) = why_useless(&condition, quantity, scene) {
        check
            .faults
            .add(Fault::new(place, why).got(format!("{text:?}")));
    }
    Some(condition)
}

/// The reason why a condition can never be met, or is met from the start, if this follows from the scene.
fn why_useless(condition: &Condition, quantity: &Quantity, scene: &Scene) -> Option<String> {
    let rises = matches!(condition.compare, Compare::AtLeast | Compare::Above);
    let level = condition.level;
    let least = |least: f64, what: &str| {
        let below = if condition.compare == Compare::Below {
            level <= least
        } else {
            level < least
        };
        (!rises && below).then(|| format!("can never be met: {what}"))
    };
    let &[(channel, _), ..] = &quantity.terms[..] else {
        return Some(format!("can never be met: {} is always 0", quantity.name));
    };
    match channel {
        Channel::Time if !rises => {
            Some("is met from the start, because time only increases".to_owned())
        }
        Channel::Time if level >= scene.end => Some(format!(
            "can never be met: the scene ends at {}",
            number(scene.end)
        )),
        Channel::Tension(_) => least(0.0, "a rope cannot push"),
        Channel::Stop(_) => least(0.0, "a stop cannot pull"),
        Channel::Vertical(w) => {
            let wheels = wheels(scene);
            let pulls = scene.wheels[wheels[w].kind].vertical.bilateral;
            if pulls {
                None
            } else {
                least(0.0, "a wheel cannot pull")
            }
        }
        Channel::Position(w) => {
            let wheels = wheels(scene);
            let [low, high] = scene.rails[wheels[w].rail].range;
            let beyond = if rises { level > high } else { level < low };
            let range = format!("the rail extends from {} to {}", number(low), number(high));
            beyond.then(|| format!("can never be met: {range}"))
        }
        Channel::Displacement(b, sim::BodyDof::X) | Channel::Speed(b, sim::BodyDof::X) => {
            why_out_of_range(
                b,
                matches!(channel, Channel::Displacement(..)).then_some(level),
                rises,
                scene,
            )
        }
        _ => None,
    }
}

/// The reason why a condition on x of body `b` at `level`, or on its speed if there is no level, can never be met.
fn why_out_of_range(b: usize, level: Option<f64>, rises: bool, scene: &Scene) -> Option<String> {
    let body = &scene.bodies[b];
    if body.pinned.is_some() || body.in_space {
        return None;
    }
    if body.motion == BodyMotion::Held {
        return Some(format!("body {} cannot move along its rail", body.name));
    }
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for truck in scene.trucks.iter().filter(|truck| truck.body == b) {
        let range = scene.rails[truck.rail].range;
        for offset in truck.wheel_offsets() {
            (low, high) = (low.max(range[0] - offset), high.min(range[1] - offset));
        }
    }
    let beyond = level.is_some_and(|level| if rises { level > high } else { level < low });
    beyond.then(|| {
        format!(
            "can never be met: the wheels are on their rails only where x is between {} and {}",
            number(low),
            number(high)
        )
    })
}

/// The actions of an event and their descriptions.
#[derive(Default)]
struct Actions {
    list: Vec<Action>,
    words: Vec<String>,
}

impl Actions {
    fn brake(&mut self, raw: &RawDo, scene: &Scene, at: &Place<'_>, check: &mut Check<'_>) {
        for (key, name, on) in [
            ("release_brake", &raw.release_brake, false),
            ("brake", &raw.brake, true),
        ] {
            let Some(name) = name else { continue };
            let place = at.key(key);
            let Some(b) = body(name, &place, scene, check) else {
                continue;
            };
            let given = &scene.bodies[b];
            if !given.motion.is_free() {
                let fault = Fault::new(
                    &place,
                    format!("body {name} does not move freely along its rail"),
                );
                check
                    .faults
                    .add(fault.hint("brakes need a motion \"drive\" or \"free\""));
            } else if given.brake.is_none() {
                let fault = Fault::new(
                    &place,
                    format!("the brakes of body {name} are never applied"),
                );
                check
                    .faults
                    .add(fault.hint("apply them with `brake` of its motion or of another event"));
            }
            if on && matches!(given.motion, BodyMotion::Driven(_)) && raw.drive.is_none() {
                self.list.push(Action::Drive {
                    body: b,
                    speed: None,
                });
            }
            self.list.push(Action::Brake { body: b, on });
            self.words.push(format!(
                "{} {name}",
                if on { "brake" } else { "release the brake of" }
            ));
        }
    }

    fn drive_off(&mut self, name: &str, scene: &Scene, at: &Place<'_>, check: &mut Check<'_>) {
        if let Some(b) = driven(name, &at.key("drive_off"), scene, check) {
            self.list.push(Action::Drive {
                body: b,
                speed: None,
            });
            self.words.push(format!("turn the drive of {name} off"));
        }
    }

    fn drive(&mut self, raw: &RawFollow, scene: &Scene, at: &Place<'_>, check: &mut Check<'_>) {
        let place = at.key("drive");
        let name = check.faults.require(&raw.body, &place, "body");
        let b = name.and_then(|name| driven(name, &place.key("body"), scene, check));
        let speed = check.faults.require(&raw.speed, &place, "speed").copied();
        let speed = speed.map(|speed| check.number(speed, &place.key("speed"), Dimension::SPEED));
        if let (Some(b), Some(speed)) = (b, speed) {
            self.list.push(Action::Drive {
                body: b,
                speed: Some(speed),
            });
            self.words.push(format!(
                "drive {} at {}",
                scene.bodies[b].name,
                number(speed)
            ));
        }
    }

    fn hoist(&mut self, raw: &RawHoist, scene: &Scene, at: &Place<'_>, check: &mut Check<'_>) {
        let place = at.key("hoist");
        let known = names(&scene.ropes, |rope| &rope.name);
        let name = check.faults.require(&raw.rope, &place, "rope");
        let rope =
            name.and_then(|name| resolve(name, &known, "rope", &place.key("rope"), check.faults));
        let speed = check.faults.require(&raw.speed, &place, "speed").copied();
        let speed = speed.map(|speed| check.number(speed, &place.key("speed"), Dimension::SPEED));
        if let (Some(rope), Some(speed)) = (rope, speed) {
            self.list.push(Action::Hoist { rope, speed });
            self.words.push(format!(
                "hoist with {} at {}",
                scene.ropes[rope].name,
                number(speed)
            ));
        }
    }

    fn drop(&mut self, name: &str, scene: &Scene, at: &Place<'_>, check: &mut Check<'_>) {
        let ropes = dropped(name, &at.key("drop"), scene, check);
        self.list
            .extend(ropes.into_iter().map(|rope| Action::Release { rope }));
        self.words.push(format!("drop {name}"));
    }
}

/// Reads the actions of an event and their description.
fn read_actions(
    raw: &RawDo,
    scene: &Scene,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<(Vec<Action>, String)> {
    let faults = check.faults.0.len();
    let mut actions = Actions::default();
    actions.brake(raw, scene, at, check);
    if let Some(name) = &raw.drive_off {
        actions.drive_off(name, scene, at, check);
    }
    if let Some(follow) = &raw.drive {
        actions.drive(follow, scene, at, check);
    }
    if let Some(hoist) = &raw.hoist {
        actions.hoist(hoist, scene, at, check);
    }
    if let Some(name) = &raw.drop {
        actions.drop(name, scene, at, check);
    }
    let Actions {
        mut list,
        mut words,
    } = actions;
    if raw.end == Some(true) {
        list.push(Action::End);
        words.push("end the run".to_owned());
    }
    if words.is_empty() && check.faults.0.len() == faults {
        let hint = "`brake`, `release_brake`, `drive`, `drive_off`, `hoist`, `drop` or `end`";
        check
            .faults
            .add(Fault::new(at, "must have at least one action").hint(hint));
    }
    let mut pairs = list
        .iter()
        .enumerate()
        .flat_map(|(i, a)| list[..i].iter().map(move |b| (a, b)));
    if pairs.any(|(a, b)| contradict(a, b)) {
        let fault = Fault::new(at, "has actions that contradict each other");
        check.faults.add(fault.got(words.join("; ")));
    }
    (check.faults.0.len() == faults).then(|| (list, words.join("; ")))
}

fn body(name: &str, place: &Place<'_>, scene: &Scene, check: &mut Check<'_>) -> Option<usize> {
    let known = names(&scene.bodies, |body| &body.name);
    resolve(name, &known, "body", place, check.faults)
}

/// Finds a body that has a drive.
fn driven(name: &str, place: &Place<'_>, scene: &Scene, check: &mut Check<'_>) -> Option<usize> {
    let b = body(name, place, scene, check)?;
    if !matches!(scene.bodies[b].motion, BodyMotion::Driven(_)) {
        let fault = Fault::new(place, format!("body {name} has no drive"));
        check
            .faults
            .add(fault.hint("a drive is a motion of \"kind\": \"drive\""));
        return None;
    }
    Some(b)
}

/// Finds the rope with that name, or all ropes that carry the body with that name.
fn dropped(name: &str, place: &Place<'_>, scene: &Scene, check: &mut Check<'_>) -> Vec<usize> {
    if let Some(rope) = scene.ropes.iter().position(|rope| rope.name == name) {
        return vec![rope];
    }
    let ropes = names(&scene.ropes, |rope| &rope.name);
    let bodies = scene
        .bodies
        .iter()
        .filter(|body| body.in_space)
        .map(|body| (body.name.as_str(), 0));
    let known: Vec<(&str, usize)> = ropes.into_iter().chain(bodies).collect();
    if resolve(
        name,
        &known,
        "rope, or of a body on ropes",
        place,
        check.faults,
    )
    .is_none()
    {
        return Vec::new();
    }
    let own = |rope: &&Rope| {
        rope.bodies
            .iter()
            .flatten()
            .any(|&b| scene.bodies[b].name == name)
    };
    let all: Vec<usize> = scene
        .ropes
        .iter()
        .enumerate()
        .filter(|(_, rope)| own(rope))
        .map(|(index, _)| index)
        .collect();
    if all.is_empty() {
        check.faults.add(Fault::new(
            place,
            format!("no rope is attached to body {name}"),
        ));
    }
    all
}
