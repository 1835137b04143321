//! Slips that a scene can be read with: each is told by name, and what is meant is not.

use std::fs;

use serde_json::{Value, json};

use super::{example, folder, girderway, json as parse, text};

/// The bridge crane at the start of its run, with changes: exit status, warnings, standard error.
fn told(change: impl FnOnce(&mut Value)) -> (Option<i32>, Vec<String>, String) {
    let folder = folder();
    let crane = example("bridge_crane");
    for name in ["aisle.json", "girders.json"] {
        fs::copy(crane.join(name), folder.path().join(name)).expect("a copy");
    }
    let mut scene = parse(&fs::read(crane.join("scene.json")).expect("an example"));
    for key in ["compare", "practice", "events"] {
        scene.as_object_mut().expect("an object").remove(key);
    }
    scene["end"]["time"] = json!(0.1);
    scene["output"] = json!({ "dt": 0.01 });
    change(&mut scene);
    fs::write(folder.path().join("scene.json"), scene.to_string()).expect("written");
    let run = girderway(&folder, &["run", "--quiet", "scene.json", "-o", "out"]);
    let warnings = fs::read(folder.path().join("out/summary.json")).map_or_else(
        |_| Vec::new(),
        |summary| {
            parse(&summary)["warnings"]
                .as_array()
                .cloned()
                .unwrap_or_default()
        },
    );
    let warnings = warnings
        .iter()
        .filter_map(|warning| warning.as_str().map(str::to_owned))
        .collect();
    (run.status.code(), warnings, text(&run.stderr).to_owned())
}

fn warned(change: impl FnOnce(&mut Value)) -> Vec<String> {
    let (status, warnings, errors) = told(change);
    assert_eq!(status, Some(0), "{errors}");
    warnings
}

/// Gives the weight of a body as its mass.
fn mistake(scene: &mut Value, body: &str) {
    let body = scene["bodies"][body].as_object_mut().expect("a body");
    let weight = body.remove("weight").expect("its weight");
    body.insert("mass".to_owned(), weight);
}

#[test]
fn the_crane_as_it_is_is_passed_over() {
    assert_eq!(warned(|_| ()), Vec::<String>::new());
}

/// Analytic: 450,000 lbf s2/ft weigh 14.5e6 lbf, on four wheels 2.5 ft wide 579 kip/ft2, 27.7 N/mm2; as a weight 0.9.
#[test]
fn a_weight_in_the_place_of_a_mass_is_told() {
    let heavy = warned(|scene| mistake(scene, "trolley"));
    let expected = "`mass` of trolley is 450000 lbf s^2/ft, a weight of 14500000 lbf: its 4 wheels are too small for it";
    // under such a weight second order is not small either
    assert!(
        heavy.len() == 2
            && heavy[0].starts_with(expected)
            && heavy[1].contains("second-order effects"),
        "{heavy:?}"
    );
    let meant = warned(|scene| {
        mistake(scene, "trolley");
        scene["bodies"]["trolley"]["mass"] = json!(450_000.0 / 32.174);
    });
    assert_eq!(meant, Vec::<String>::new());
}

/// Analytic: a load of 1,020,000 lbf stretches the rope of EA 2.8e8 lbf by 0.0036 of its length, as a mass by 0.117.
#[test]
fn a_weight_in_the_place_of_a_hung_mass_is_told_by_its_rope() {
    let hung = warned(|scene| mistake(scene, "ladle"));
    assert!(
        hung.iter()
            .any(|told| told.starts_with("hoist is stretched by 0.117 of its length")),
        "{hung:?}"
    );
}

#[test]
fn rotations_without_inertia_are_told_where_girders_lend_theirs() {
    let idle = warned(|scene| {
        scene["bodies"]["bridge"]
            .as_object_mut()
            .expect("a body")
            .remove("inertia");
    });
    assert!(
        idle.len() == 1 && idle[0].starts_with("bridge is free to roll and yaw and pitch"),
        "{idle:?}"
    );
}

/// Without inertia about its centre a body that can move along x cannot be pushed at its centre and turn.
#[test]
fn rotations_that_nothing_resists_are_refused_by_name() {
    let (status, _, errors) = told(|scene| {
        scene["bodies"]["trolley"]
            .as_object_mut()
            .expect("a body")
            .remove("inertia");
    });
    assert_eq!(status, Some(2));
    assert!(
        errors.contains("bodies.trolley: missing key `inertia`: pitch is free, but has no inertia"),
        "{errors}"
    );
}

#[test]
fn structures_held_beyond_the_wheels_of_their_body_are_told() {
    let at = |z: f64| warned(|scene| scene["structures"]["girders"]["at"] = json!([0, 3, z]));
    assert_eq!(at(7.0), Vec::<String>::new());
    let beside = at(-10.0);
    let expected = "bridge supports girders across its track from -47.5 to 27.5, but its wheels are located from -37.5 to 37.5";
    assert!(
        beside.len() == 1 && beside[0].starts_with(expected),
        "{beside:?}"
    );
}
