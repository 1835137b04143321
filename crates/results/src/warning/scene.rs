//! Warnings about values of a scene that are probably wrong: numbers in other units than those of the file, weights
//! entered as masses, bodies that rotate without moment of inertia, structures that extend beyond the body below them, ropes beyond their strength.

use crate::columns::NamedColumns;
use formats::plausible::{
    BREAKING_STRAIN, GRAVITIES, HOIST_SPEEDS, LARGE_ROTATION, OVERHANG, PENETRATION, RADII,
    WHEEL_PRESSURE, WHEEL_STIFFNESS,
};
use formats::scene::motion::{NamedWheel, wheels};
use formats::scene::{Analysis, Body, NormalForceLaw, Origin, Scene, root_body};
use formats::text::number::number;
use formats::text::number::rounded;
use formats::units::{Dimension, Scale, Units};

/// Values of a scene that are probably in another unit.
#[must_use]
pub(super) fn implausible_values(scene: &Scene, record: &NamedColumns) -> Vec<String> {
    let mut all = Vec::new();
    all.extend(implausible(
        "`gravity`",
        scene.gravity,
        Dimension::ACCELERATION,
        GRAVITIES,
        "9.81 m/s^2 on earth",
        scene,
    ));
    for wheel in &scene.wheels {
        let what = format!("`radius` of wheel \"{}\"", wheel.name);
        all.extend(implausible(
            &what,
            wheel.radius,
            Dimension::LENGTH,
            RADII,
            "crane wheels have 0.1 to 0.6 m",
            scene,
        ));
    }
    for wheel in &scene.wheels {
        if wheel.vertical.law == NormalForceLaw::Linear {
            let what = format!("`vertical.k` of wheel \"{}\"", wheel.name);
            let usual = "steel wheels on rails have 1e8 to 1e10 N/m";
            all.extend(implausible(
                &what,
                wheel.vertical.k,
                Dimension::STIFFNESS,
                WHEEL_STIFFNESS,
                usual,
                scene,
            ));
        }
    }
    if let Some(speed) = scene
        .practice
        .as_ref()
        .and_then(|practice| practice.speeds[2])
    {
        let usual = "usual are 0.02 to 1 m/s";
        all.extend(implausible(
            "`hoist_speed`",
            speed,
            Dimension::SPEED,
            HOIST_SPEEDS,
            usual,
            scene,
        ));
    }
    all.extend(soft_wheels(scene, record));
    for (b, body) in scene.bodies.iter().enumerate() {
        all.extend(heavy(scene, b, body));
    }
    all
}

/// Warnings about what a scene does not say, and about motions beyond its assumptions.
#[must_use]
pub(super) fn scene_warnings(scene: &Scene, record: &NamedColumns) -> Vec<String> {
    let mut all = Vec::new();
    all.extend(idle_brakes(scene));
    for body in &scene.bodies {
        all.extend(without_inertia(scene, body));
        all.extend(large_rotation(body, record));
    }
    all.extend((0..scene.structures.len()).filter_map(|s| overhanging(scene, s)));
    all.extend(overstretched(scene, record));
    all
}

/// A number other than zero outside a plausible range, which is in SI units.
fn implausible(
    what: &str,
    value: f64,
    dimension: Dimension,
    [low, high]: [f64; 2],
    usual: &str,
    scene: &Scene,
) -> Option<String> {
    let si = value
        * Scale {
            from: scene.units,
            to: Units::SI,
        }
        .factor(dimension);
    (value != 0.0 && !(low..=high).contains(&si)).then(|| {
        let in_units =
            |value: f64, units: Units| format!("{} {}", number(value), units.label(dimension));
        let own = in_units(rounded(value, 6), scene.units);
        let in_si = in_units(rounded(si, 3), Units::SI);
        // a scene in m and s has the same text twice
        let both = if own == in_si {
            own
        } else {
            format!("{own}, {in_si}")
        };
        format!("{what} is {both}: check its unit; {usual}")
    })
}

/// Wheel types that are `braked` alone, in a scene without brakes: neither driven, as the wheels of a crane are of which
/// another scene brakes, nor with a brake of any body.
fn idle_brakes(scene: &Scene) -> Option<String> {
    if scene.bodies.iter().any(|body| body.brake.is_some()) {
        return None;
    }
    let kind = scene
        .wheels
        .iter()
        .find(|kind| kind.braked && !kind.driven)?;
    let truck = scene
        .trucks
        .iter()
        .find(|truck| scene.wheels[truck.wheel].name == kind.name);
    let body = truck.map_or("...", |truck| &scene.bodies[truck.body].name);
    let friction = match kind.friction {
        Some(_) => "",
        None => ", and the wheels \"friction\": {\"mu\": 0.2, \"slip\": ...}, a speed",
    };
    Some(format!(
        "wheels \"{}\" are `braked`, but nothing applies a brake, so that they roll freely: give the motion of {body}, \
         of kind \"free\" or \"drive\", its \"brake\", a time, or the scene an event that does {{\"brake\": \
         \"{body}\"}}{friction}",
        kind.name
    ))
}

/// Wheels that sink deep into their rails at the start; the deepest is named.
fn soft_wheels(scene: &Scene, record: &NamedColumns) -> Option<String> {
    let ratio = |wheel: &NamedWheel| {
        let first = record
            .part(&wheel.name, "penetration")
            .first()
            .copied()
            .unwrap_or_default();
        first / scene.wheels[wheel.kind].radius
    };
    let wheels = wheels(scene);
    let soft: Vec<&NamedWheel> = wheels
        .iter()
        .filter(|wheel| ratio(wheel) > PENETRATION)
        .collect();
    let deepest = soft.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
    let others = match soft.len() - 1 {
        0 => String::new(),
        1 => " and another wheel".to_owned(),
        count => format!(" and {count} other wheels"),
    };
    Some(format!(
        "the initial contact penetration of {}{others} reaches {} {}, {} of the radius: check `k` of the contact, \
         force / length",
        deepest.name,
        number(rounded(
            ratio(deepest) * scene.wheels[deepest.kind].radius,
            3
        )),
        scene.units.label(Dimension::LENGTH),
        number(rounded(ratio(deepest), 2))
    ))
}

/// A body that turns by more than [`LARGE_ROTATION`], by its largest rotation: it turns over, or begins far beyond a stop that
/// pushes it back.
fn large_rotation(body: &Body, record: &NamedColumns) -> Option<String> {
    let turned = ["roll", "yaw", "pitch"].map(|part| {
        let angles = record.part(&body.name, part).iter();
        (
            part,
            angles.fold(0.0_f64, |most, angle| most.max(angle.abs())),
        )
    });
    let (part, most) = turned.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (most > LARGE_ROTATION).then(|| {
        format!(
            "{}.{part} reaches {} rad, more than {LARGE_ROTATION}: the assumption of small rotations does not hold",
            body.name,
            number(rounded(most, 2))
        )
    })
}

/// A mass that is too heavy for its wheels, probably a weight entered as a mass.
fn heavy(scene: &Scene, b: usize, body: &Body) -> Option<String> {
    let (root, _) = root_body(scene, b);
    let below = scene
        .trucks
        .iter()
        .filter(|truck| root_body(scene, truck.body).0 == root);
    let squares: Vec<f64> = below
        .flat_map(|truck| {
            let diameter = 2.0 * scene.wheels[truck.wheel].radius;
            truck
                .wheel_offsets()
                .into_iter()
                .map(move |_| diameter * diameter)
        })
        .collect();
    let weight = body.mass * scene.gravity;
    let scale = Scale {
        from: scene.units,
        to: Units::SI,
    };
    let pressure = weight / squares.iter().sum::<f64>() * scale.factor(Dimension::STRESS);
    let [force, mass] = [Dimension::FORCE, Dimension::MASS].map(|of| scene.units.label(of));
    (body.by_mass && !squares.is_empty() && pressure > WHEEL_PRESSURE).then(|| {
        format!(
            "`mass` of {} is {} {mass}, a weight of {} {force}: its {} wheels are too small for it; enter a weight \
             as `weight`",
            body.name,
            number(body.mass),
            number(rounded(weight, 3)),
            squares.len()
        )
    })
}

/// A body that is free to rotate about axes about which it has no moment of inertia.
fn without_inertia(scene: &Scene, body: &Body) -> Option<String> {
    let words = ["roll", "yaw", "pitch"].into_iter().enumerate();
    let free: Vec<&str> = words
        .filter(|(k, _)| body.free[3 + k] && body.inertia[*k] == 0.0)
        .map(|(_, word)| word)
        .collect();
    (scene.analysis == Analysis::Dynamic && !free.is_empty()).then(|| {
        format!(
            "{} is free to {}, but its `inertia` in this rotation is 0: it rotates as if all its mass were \
             concentrated at its centre; `inertia` is [roll, yaw, pitch]",
            body.name,
            free.join(" and ")
        )
    })
}

/// A structure on a body whose supports extend beyond the wheels of the body.
fn overhanging(scene: &Scene, s: usize) -> Option<String> {
    let structure = &scene.structures[s];
    let (on, Origin::Spec { spec, .. }) = (structure.carrier?, &structure.origin) else {
        return None;
    };
    let (model, _) = spec.model().ok()?;
    let (root, own) = root_body(scene, on.body);
    let wheels: Vec<[f64; 3]> = scene
        .trucks
        .iter()
        .map(|truck| (truck, root_body(scene, truck.body)))
        .filter(|(_, (below, _))| *below == root)
        .flat_map(|(truck, (_, arm))| {
            let at = move |offset: f64| [arm[0] + offset, 0.0, arm[2] + truck.at[2]];
            truck.wheel_offsets().into_iter().map(at)
        })
        .collect();
    let supported = model.supports.iter().map(|support| support.point);
    let supported = supported.chain(model.springs.iter().map(|spring| spring.point));
    let supports: Vec<[f64; 3]> = supported
        .map(|point| [0, 1, 2].map(|k| own[k] + on.at[k] + model.points[point][k]))
        .collect();
    let outside = [(0, "along"), (2, "across")]
        .into_iter()
        .find_map(|(k, word)| {
            let [low, high] = range(&wheels, k);
            let [from, to] = range(&supports, k);
            let slack = OVERHANG * (high - low);
            (slack > 0.0 && (from < low - slack || to > high + slack)).then(|| {
                format!(
                    "{word} its track from {} to {}, but its wheels are located from {} to {}",
                    number(rounded(from, 6)),
                    number(rounded(to, 6)),
                    number(rounded(low, 6)),
                    number(rounded(high, 6))
                )
            })
        });
    let body = &scene.bodies[on.body].name;
    outside.map(|outside| {
        format!(
            "{body} supports {} {outside}: `at` of the structure is the position of the origin of its spec relative \
             to that of the body",
            structure.name
        )
    })
}

/// The smallest and the largest coordinate `k`.
fn range(places: &[[f64; 3]], k: usize) -> [f64; 2] {
    let all = places.iter().map(|place| place[k]);
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
        [low.min(at), high.max(at)]
    })
}

/// Ropes whose strain exceeds [`BREAKING_STRAIN`].
fn overstretched(scene: &Scene, record: &NamedColumns) -> Vec<String> {
    let warnings = scene.ropes.iter().filter_map(|rope| {
        let tension = record.part(&rope.name, "tension").iter().copied().fold(0.0, f64::max);
        let strain = tension / rope.stiffness;
        (strain > BREAKING_STRAIN).then(|| {
            format!(
                "{} is stretched by {strain:.3} of its length, more than {BREAKING_STRAIN}: a rope breaks at this \
                 strain; check the `mass` that it carries, and `EA`",
                rope.name
            )
        })
    });
    warnings.collect()
}
