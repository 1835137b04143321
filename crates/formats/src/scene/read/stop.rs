//! End stops of rails, and floors.

use super::rail::rail_named;
use crate::check::Check;
use crate::scene::raw::RawStop;
use crate::scene::values::actuator::{Stop, StopPoint};
use crate::scene::values::body::{BodyMotion, root_of};
use crate::scene::values::scene::Scene;
use crate::scene::values::truck::Truck;
use crate::text::fault::{Fault, number};
use crate::text::names::{check_name, names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

/// Reads the stops of a scene whose bodies and trucks have already been read.
pub(super) fn read_all(raw: &[RawStop], scene: &Scene, check: &mut Check<'_>) -> Vec<Stop> {
    let root = Place::root();
    let list = root.key("stops");
    let mut stops: Vec<Stop> = Vec::new();
    for (index, raw) in raw.iter().enumerate() {
        let at = list.index(index);
        let Some(stop) = read(raw, index + 1, scene, &at, check) else {
            continue;
        };
        let others = stops.iter().map(|other| &other.name);
        let others = others.chain(scene.bodies.iter().map(|body| &body.name));
        if others
            .chain(scene.ropes.iter().map(|rope| &rope.name))
            .any(|other| *other == stop.name)
        {
            let expected = format!("the name \"{}\" is already used", stop.name);
            check.faults.add(
                Fault::new(&at, expected)
                    .hint("names of stops, ropes and bodies are also names of columns"),
            );
        }
        stops.push(stop);
    }
    stops
}

fn read(
    raw: &RawStop,
    count: usize,
    scene: &Scene,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Stop> {
    let name = raw.name.clone().unwrap_or_else(|| format!("stop{count}"));
    check_name(&name, &at.key("name"), check.faults);
    let stiffness =
        check.required_positive(raw.k, at, "k", Dimension::STIFFNESS, "force per length");
    let damping = check.not_negative(
        raw.c.unwrap_or_default(),
        &at.key("c"),
        Dimension::DAMPING,
        "force per speed",
    );
    let body = raw.body.as_ref().map(|name| {
        let known = names(&scene.bodies, |body| &body.name);
        resolve(name, &known, "body", &at.key("body"), check.faults)
    });
    let point = raw
        .at
        .map(|point| check.vector(point, &at.key("at"), Dimension::LENGTH));
    if point.is_some() && body.is_none() {
        check.faults.add(
            Fault::new(&at.key("at"), "`at` needs `body`")
                .at_key()
                .hint("`at` is a point of that body"),
        );
    }
    if raw.gap.is_some() && raw.against.is_none() {
        check.faults.add(
            Fault::new(&at.key("gap"), "`gap` needs `against`")
                .at_key()
                .hint("`against` names the other body"),
        );
    }
    let stop = Stop {
        name,
        axis: 0,
        against: None,
        place: 0.0,
        rail: None,
        stiffness,
        damping,
        points: Vec::new(),
    };
    match (&raw.rail, raw.x, raw.height, &raw.against) {
        (None, None, None, Some(other)) => {
            check.faults.require(&raw.body, at, "body")?;
            let met = (body??, point.unwrap_or_default());
            let (against, place, side) = buffer(raw, met, other, scene, at, check)?;
            let points = vec![StopPoint {
                body: met.0,
                at: met.1,
                side,
            }];
            Some(Stop {
                against: Some(against),
                place,
                points,
                ..stop
            })
        }
        (Some(rail), Some(x), None, _) => {
            let rail = rail_named(rail, &scene.rails, &at.key("rail"), check.faults)?;
            let place = check.number(x, &at.key("x"), Dimension::LENGTH);
            let points = on_rail(
                raw,
                [body, Some(Some(rail))],
                point,
                place,
                scene,
                at,
                check,
            )?;
            Some(Stop {
                place,
                rail: Some(rail),
                points,
                ..stop
            })
        }
        (None, None, Some(height), _) => {
            let place = check.number(height, &at.key("Y"), Dimension::LENGTH);
            let words = [("above", -1.0), ("below", 1.0)];
            let side = raw.side.as_ref().map_or(Some(-1.0), |word| {
                check.faults.one_of(word, &at.key("side"), &words)
            });
            check.faults.require(&raw.body, at, "body")?;
            let points = vec![StopPoint {
                body: body??,
                at: point.unwrap_or_default(),
                side: side?,
            }];
            Some(Stop {
                axis: 1,
                place,
                points,
                ..stop
            })
        }
        _ => {
            let fault = Fault::new(
                at,
                "must have `rail` and `x`, `body` and `Y`, or `body` and `against`",
            );
            check.faults.add(
                fault.hint(
                    "an end stop of a rail, a floor below a body, or a buffer between bodies",
                ),
            );
            None
        }
    }
}

/// Reads a buffer between a point of one body and the body `other`, with an initial distance `gap`. Returns the body
/// that carries it, its position relative to the origin of that body, and the side.
fn buffer(
    raw: &RawStop,
    (body, point): (usize, [f64; 3]),
    other: &str,
    scene: &Scene,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<(usize, f64, f64)> {
    let known = names(&scene.bodies, |body| &body.name);
    let against = resolve(other, &known, "body", &at.key("against"), check.faults)?;
    let gap = raw.gap.unwrap_or_default();
    let gap = check.not_negative(
        gap,
        &at.key("gap"),
        Dimension::LENGTH,
        "initial clearance before the buffer is compressed",
    );
    if let Some(side) = &raw.side {
        let fault = Fault::new(&at.key("side"), "a buffer between bodies has no `side`").at_key();
        check.faults.add(
            fault
                .got(format!("\"{side}\""))
                .hint("the side follows from the positions of the bodies at the start"),
        );
    }
    let place =
        |b: usize| root_of(&scene.bodies, b).map(|(root, ahead)| scene.bodies[root].x0 + ahead);
    let roots =
        [body, against].map(|b| root_of(&scene.bodies, b).map(|(root, _)| &scene.bodies[root]));
    let [Some(one), Some(two)] = roots else {
        return None;
    };
    let same_rail = one.track.iter().any(|rail| two.track.contains(rail));
    if one.name == two.name || !same_rail {
        let fault = Fault::new(&at.key("against"), "must be another body on the same rail");
        check.faults.add(fault.got(format!("\"{other}\"")));
        return None;
    }
    let apart = place(body)? + point[0] - place(against)?;
    let side = if place(body)? <= place(against)? {
        1.0
    } else {
        -1.0
    };
    Some((against, apart + side * gap, side))
}

/// The points that make contact with the stop at `x` of a rail: the nearest wheel of one body, or of every body that
/// moves on the rail.
fn on_rail(
    raw: &RawStop,
    [body, rail]: [Option<Option<usize>>; 2],
    point: Option<[f64; 3]>,
    x: f64,
    scene: &Scene,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Vec<StopPoint>> {
    let words = [("before", 1.0), ("beyond", -1.0)];
    let side = match &raw.side {
        Some(word) => Some(check.faults.one_of(word, &at.key("side"), &words)?),
        None => None,
    };
    let meant: Vec<usize> = match body {
        Some(body) => vec![body?],
        None => (0..scene.bodies.len())
            .filter(|&b| scene.bodies[b].pinned.is_none())
            .collect(),
    };
    let mut meetings = Vec::new();
    for b in meant {
        let Some((root, ahead)) = root_of(&scene.bodies, b) else {
            continue;
        };
        if body.is_none() && scene.bodies[root].motion == BodyMotion::Held {
            continue;
        }
        let x0 = scene.bodies[root].x0;
        let points: Vec<(usize, [f64; 3], f64)> = match point {
            Some(point) => vec![(b, point, x0 + ahead + point[0])],
            None => treads(scene, b, rail.flatten()),
        };
        let first = points.iter().min_by(|a, b| a.2.total_cmp(&b.2));
        let last = points.iter().max_by(|a, b| a.2.total_cmp(&b.2));
        let (Some(first), Some(last)) = (first, last) else {
            if body.is_some() {
                let expected = format!("no wheel of body {} is on that rail", scene.bodies[b].name);
                check.faults.add(
                    Fault::new(&at.key("body"), expected)
                        .hint("specify by `at` the point of the body that meets the stop"),
                );
            }
            continue;
        };
        let side = side.unwrap_or_else(|| {
            side_at_start([first.2, last.2], x, &scene.bodies[b].name, at, check)
        });
        let (body, at, _) = if side > 0.0 { *last } else { *first };
        meetings.push(StopPoint { body, at, side });
    }
    if meetings.is_empty() && body.is_none() {
        check
            .faults
            .add(Fault::new(&at.key("rail"), "no body moves on that rail"));
    }
    Some(meetings)
}

/// Side of the stop at `x` on which a body with wheels from `first` to `last` is at the start: 1 before the stop, -1
/// beyond it. Wheels on both sides are a fault.
fn side_at_start(
    [first, last]: [f64; 2],
    x: f64,
    body: &str,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> f64 {
    if last <= x {
        return 1.0;
    }
    if first >= x {
        return -1.0;
    }
    let expected = format!("body {body} has wheels on both sides of the stop");
    let found = format!("wheels from x = {} to {}", number(first), number(last));
    let hint = "state the side of the body with \"side\": \"before\" or \"beyond\"";
    check
        .faults
        .add(Fault::new(&at.key("x"), expected).got(found).hint(hint));
    1.0
}

/// Wheels on a rail that belong to the tree of body `b`: their bodies, the positions of their treads relative to the
/// origins of these bodies, and x at the start.
fn treads(scene: &Scene, b: usize, rail: Option<usize>) -> Vec<(usize, [f64; 3], f64)> {
    let below = |truck: &&Truck| {
        let mut at = truck.body;
        while let (true, Some((to, _))) = (at != b, scene.bodies[at].pinned) {
            at = to;
        }
        at == b && Some(truck.rail) == rail
    };
    let trucks = scene.trucks.iter().filter(below);
    trucks
        .flat_map(|truck| {
            let (root, ahead) = root_of(&scene.bodies, truck.body).unwrap_or((truck.body, 0.0));
            let radius = scene.wheels[truck.wheel].radius;
            truck.wheel_offsets().into_iter().map(move |offset| {
                let tread = [offset, truck.at[1] - radius, truck.at[2]];
                (truck.body, tread, scene.bodies[root].x0 + ahead + offset)
            })
        })
        .collect()
}
