//! The member `practice`: input of the crane design codes that is not part of the motion.

use practice::aist::{BuildingClass, CraneKind};
use practice::duty::FatigueClass;
use practice::factor::{DriveOnset, Release};
use practice::limits::ServiceClass;
use practice::skew::Guide;

use crate::check::Check;
use crate::own_limits;
use crate::practice_words;
use crate::practice_words::{
    BUILDINGS, CLASSES, DRIVES, GUIDE, HOISTING, KINDS, LATERAL_SECTIONS, LateralSection, RELEASE,
    fatigue_classes,
};
use crate::scene::raw::{RawCodes, RawPractice};
use crate::scene::values::practice::Practice;
use crate::scene::values::scene::{Scene, mean_lateral_position, root_body};
use crate::text::fault::{Fault, Faults, number};
use crate::text::names::{names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;
use practice::limit_choice::code_name;

/// Efficiency of a bumper whose force rises linearly, such as a spring.
const SPRING_EFFICIENCY: f64 = 0.5;

/// Least efficiency of a bumper that is accepted.
const LEAST_EFFICIENCY: f64 = 1e-3;

/// Classes of the crane and its building.
struct Classes {
    service: Option<ServiceClass>,
    history: Option<FatigueClass>,
    building: Option<BuildingClass>,
}

impl Classes {
    fn read(raw: &RawPractice, at: &Place<'_>, check: &mut Check<'_>) -> Classes {
        let histories = fatigue_classes();
        let building = raw.building_class.as_ref();
        Classes {
            service: raw
                .class
                .as_ref()
                .and_then(|word| check.faults.one_of(word, &at.key("class"), &CLASSES)),
            history: raw
                .s_class
                .as_ref()
                .and_then(|word| check.faults.one_of(word, &at.key("s_class"), &histories)?),
            building: building.and_then(|word| {
                check
                    .faults
                    .one_of(word, &at.key("building_class"), &BUILDINGS)
            }),
        }
    }
}

/// Efficiency of the bumpers, between 0.001 and 1.
fn efficiency(raw: &RawPractice, at: &Place<'_>, check: &mut Check<'_>) -> f64 {
    let efficiency = raw.bumper_efficiency.unwrap_or(SPRING_EFFICIENCY);
    if !(LEAST_EFFICIENCY..=1.0).contains(&efficiency) {
        let place = at.key("bumper_efficiency");
        let fault = Fault::new(&place, format!("must be between {LEAST_EFFICIENCY} and 1"));
        let hint =
            "ratio of mean to largest force: 0.5 for a spring, about 0.8 for a hydraulic bumper";
        check
            .faults
            .add(fault.got(number(efficiency)).of_value().hint(hint));
    }
    efficiency
}

/// What resists lateral moments in stresses of girders.
pub(super) fn lateral_section(
    raw: &Option<RawPractice>,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<LateralSection> {
    let word = raw.as_ref()?.lateral_section.as_ref()?;
    check.faults.one_of(
        word,
        &root.key("practice").key("lateral_section"),
        &LATERAL_SECTIONS,
    )
}

/// Whether the member requests stresses and says nothing else. They need no crane on two rails, which codes need.
fn is_for_stresses(raw: &RawPractice) -> bool {
    let alone = RawPractice {
        lateral_section: raw.lateral_section.clone(),
        ..RawPractice::default()
    };
    raw.lateral_section.is_some() && *raw == alone
}

/// Reads the member of a scene whose bodies, trucks and ropes have already been read. A member with `lateral_section` alone gives
/// nothing, without a fault, where the scene has no crane to which codes apply.
pub(super) fn read(
    raw: &Option<RawPractice>,
    scene: &Scene,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Practice> {
    let raw = raw.as_ref()?;
    let at = root.key("practice");
    let mut unheeded = Faults::default();
    let faults = if is_for_stresses(raw) {
        &mut unheeded
    } else {
        &mut *check.faults
    };
    let check = &mut Check {
        faults,
        scale: check.scale,
    };
    let classes = Classes::read(raw, &at, check);
    let codes = codes(raw, &at, check);
    let limits = raw.limits.as_ref().map_or_else(Vec::new, |own| {
        own_limits::read(own, scene.units, &at.key("limits"), check)
    });
    let bumper_efficiency = efficiency(raw, &at, check);
    let kind = raw
        .kind
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("kind"), &KINDS));
    let hoisting = raw
        .hoisting
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("hoisting"), &HOISTING));
    let drives = raw
        .drives
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("drives"), &DRIVES));
    let release = raw
        .release
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("release"), &RELEASE));
    let guide = raw
        .guide
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &at.key("guide"), &GUIDE));
    let mut size = |value: Option<f64>, key: &str, dimension: Dimension, hint: &str| {
        check.optional_positive(value, &at.key(key), dimension, hint)
    };
    let approach = size(
        raw.approach,
        "approach",
        Dimension::LENGTH,
        "distance from the hook to the nearer rail",
    );
    let rail_head = size(
        raw.rail_head,
        "rail_head",
        Dimension::LENGTH,
        "width of the rail head",
    );
    let speeds = [
        size(
            raw.bridge_speed,
            "bridge_speed",
            Dimension::SPEED,
            "rated speed",
        ),
        size(
            raw.trolley_speed,
            "trolley_speed",
            Dimension::SPEED,
            "rated speed",
        ),
        size(
            raw.hoist_speed,
            "hoist_speed",
            Dimension::SPEED,
            "rated speed",
        ),
    ];
    let bumper_stroke = size(
        raw.bumper_stroke,
        "bumper_stroke",
        Dimension::LENGTH,
        "stroke of the bumpers",
    );
    let (crane, place) = match &raw.crane {
        Some(name) => {
            let known = names(&scene.bodies, |body| &body.name);
            let place = at.key("crane");
            (resolve(name, &known, "body", &place, check.faults)?, place)
        }
        None => (only_crane(scene, &at, check)?, at),
    };
    let rails = rails_of(scene, crane, &place, check)?;
    let (trolley, loads) = hung_from(scene, crane);
    if let Some(approach) = approach {
        check_approach(approach, scene, (crane, rails), root, check);
    }
    Some(Practice {
        codes,
        limits,
        crane,
        rails,
        trolley,
        loads,
        kind: kind.unwrap_or(CraneKind::Mill),
        class: classes.service,
        s_class: classes.history,
        building_class: classes.building,
        hoisting,
        drives: drives.unwrap_or(DriveOnset::Smooth),
        release: release.unwrap_or(Release::Rapid),
        guide: guide.unwrap_or(Guide::Flanges),
        approach,
        rail_head,
        speeds,
        bumper_stroke,
        bumper_efficiency,
    })
}

/// The codes by whose limits a run is judged.
fn codes(raw: &RawPractice, at: &Place<'_>, check: &mut Check<'_>) -> Vec<String> {
    let at = at.key("code");
    let known = practice_words::codes();
    let mut one = |code: &String, place: &Place<'_>| {
        resolve(code_name(code), &known, "code", place, check.faults).map(|_| code.clone())
    };
    match &raw.code {
        None => Vec::new(),
        Some(RawCodes::One(code)) => one(code, &at).into_iter().collect(),
        Some(RawCodes::Several(list)) => {
            let each = list.iter().enumerate();
            each.filter_map(|(k, code)| one(code, &at.index(k)))
                .collect()
        }
    }
}

/// The trolley, which runs on structures of the crane, and the bodies in space that hang by ropes from either of
/// them.
fn hung_from(scene: &Scene, crane: usize) -> (Option<usize>, Vec<usize>) {
    let rides = |body: usize| {
        scene.trucks.iter().any(|truck| {
            let on = scene.structures[scene.rails[truck.rail].structure].carrier;
            root_body(scene, truck.body).0 == body && on.is_some_and(|on| on.body == crane)
        })
    };
    let trolley = (0..scene.bodies.len()).find(|body| rides(*body));
    let holds = |body: Option<usize>| body.is_some() && (body == Some(crane) || body == trolley);
    let mut loads = Vec::new();
    for rope in &scene.ropes {
        let [from, to] = rope.bodies;
        let hung = if holds(from) {
            to
        } else {
            from.filter(|_| holds(to))
        };
        loads.extend(hung.filter(|body| scene.bodies[*body].in_space && !loads.contains(body)));
    }
    (trolley, loads)
}

/// Checks that the approach of the hook is not larger than the distance of the rails of the crane.
fn check_approach(
    approach: f64,
    scene: &Scene,
    (crane, rails): (usize, [usize; 2]),
    root: &Place<'_>,
    check: &mut Check<'_>,
) {
    let span = (mean_lateral_position(scene, crane, rails[0])
        - mean_lateral_position(scene, crane, rails[1]))
    .abs();
    if approach > span {
        let at = root.key("practice");
        let fault = Fault::new(&at.key("approach"), "must be within the crane's span");
        check.faults.add(
            fault
                .got(approach)
                .hint(format!("its rails are {span} apart")),
        );
    }
}

/// The only body that carries structures or, if there is none, the only body on rails.
fn only_crane(scene: &Scene, at: &Place<'_>, check: &mut Check<'_>) -> Option<usize> {
    let mut found: Vec<usize> = scene
        .structures
        .iter()
        .filter_map(|structure| Some(structure.carrier?.body))
        .collect();
    if found.is_empty() {
        found = scene
            .trucks
            .iter()
            .map(|truck| root_body(scene, truck.body).0)
            .collect();
    }
    found.sort_unstable();
    found.dedup();
    match found[..] {
        [crane] => Some(crane),
        _ => {
            let names: Vec<String> = found
                .iter()
                .map(|body| format!("\"{}\"", scene.bodies[*body].name))
                .collect();
            let fault = Fault::new(at, "missing key `crane`");
            check.faults.add(fault.hint(format!(
                "specify the body that is the crane: {}",
                names.join(", ")
            )));
            None
        }
    }
}

/// The two rails of a crane, in the order of the scene.
fn rails_of(
    scene: &Scene,
    crane: usize,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<[usize; 2]> {
    let mut rails: Vec<usize> = scene
        .trucks
        .iter()
        .filter(|truck| root_body(scene, truck.body).0 == crane)
        .map(|truck| truck.rail)
        .collect();
    rails.sort_unstable();
    rails.dedup();
    match rails[..] {
        [one, other]
            if mean_lateral_position(scene, crane, one)
                != mean_lateral_position(scene, crane, other) =>
        {
            Some([one, other])
        }
        _ => {
            let found = match rails.len() {
                2 => {
                    format!(
                        "trucks on both rails at z = {}",
                        number(mean_lateral_position(scene, crane, rails[0]))
                    )
                }
                count => count.to_string(),
            };
            let fault = Fault::new(
                at,
                format!(
                    "\"{}\" must run on two rails with different lateral positions",
                    scene.bodies[crane].name
                ),
            );
            check.faults.add(fault.got(found).hint(
                "the codes apply to cranes on two rails; z of `at` is the lateral position of a truck",
            ));
            None
        }
    }
}
