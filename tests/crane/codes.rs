//! Values of codes beside runs of the crane.

use serde_json::{Value, json};

use super::{GRAVITY, run, scene};

/// Weights of trolley, ladle, and of the bridge with two boxes of 75 ft, A = 2.0312 ft2, 19.7986 slug/ft3.
const TROLLEY: f64 = 450_000.0;
const LADLE: f64 = 1_020_000.0;
const BRIDGE: f64 = 556_000.0 + 2.0 * 75.0 * 2.0312 * 19.7986 * GRAVITY;

/// The value of a code whose formula begins so.
fn value(summary: &Value, row: &str, code: &str, formula: &str) -> f64 {
    let all = summary["practice"]["values"][row]["codes"]
        .as_array()
        .expect("codes");
    let of = |entry: &&Value| {
        entry["code"] == code
            && entry["formula"]
                .as_str()
                .is_some_and(|text| text.starts_with(formula))
    };
    all.iter()
        .find(of)
        .and_then(|entry| entry["value"].as_f64())
        .unwrap_or_else(|| panic!("{row} {code} {formula}"))
}

/// Analytic: a crane at rest has its static wheel loads, and codes multiply weights by their factors: with the trolley in the middle
/// (1.1 (B + T) + phi2 Q)/(B + T + Q), phi2 = 1.1 + 0.34 x 0.1524 m/s.
#[test]
fn factors_of_codes_stand_beside_a_crane_at_rest() {
    let mut scene = scene("drop");
    scene["bodies"]["ladle"]["weight"] = json!(LADLE);
    scene["practice"] =
        json!({"kind": "ladle", "hoisting": "HC2", "hoist_speed": 0.5, "bridge_speed": 5});
    scene["events"] = json!([]);
    scene["end"]["time"] = json!(0.1);
    let (_, summary) = run(&scene);
    let crane = &summary["practice"]["crane"];
    let near = |found: f64, wanted: f64, share: f64| {
        assert!((found / wanted - 1.0).abs() < share, "{found} {wanted}");
    };
    let of = |name: &str| crane[name].as_f64().expect("a number");
    near(of("bridge"), BRIDGE, 1e-9);
    near(of("span"), 75.0, 1e-12);
    near(of("approach"), 37.5, 1e-12);
    near(of("wheels"), 8.0, 1e-12);
    let found = summary["practice"]["values"]["rail_factor"]["measured"]["value"]
        .as_f64()
        .expect("found");
    near(found, 1.0, 1e-3);
    let phi2 = 1.1 + 0.34 * 0.5 * 0.3048;
    near(
        value(&summary, "load_factor", "EN 1991-3:2006", "phi2"),
        phi2,
        1e-12,
    );
    let factor = |name: &str| {
        summary["practice"]["factors"][name]["value"]
            .as_f64()
            .expect(name)
    };
    near(factor("phi6"), 0.5 + 0.5 * phi2, 1e-12);
    near(
        factor("wheel_near"),
        (BRIDGE + TROLLEY + LADLE) / 16.0,
        1e-9,
    );
    near(
        factor("wheel_impact"),
        1.25 * (BRIDGE + TROLLEY + LADLE) / 16.0,
        1e-9,
    );
    let all = BRIDGE + TROLLEY + LADLE;
    let wanted = (1.1 * (BRIDGE + TROLLEY) + phi2 * LADLE) / all;
    near(
        value(&summary, "rail_factor", "EN 1991-3:2006", "phi1"),
        wanted,
        1e-9,
    );
    // CMAA 70: 300 ft/min gives 1.05 + 0.15 = 1.2 for bridge and trolley, 30 ft/min of hoisting 15 %
    near(factor("dead_load_factor"), 1.2, 1e-12);
    near(factor("hoist_load_factor"), 0.15, 1e-12);
    near(factor("phi6_static"), 1.0, 1e-15);
    near(factor("test_load"), 1.25, 1e-15);
    let wanted = (1.2 * (BRIDGE + TROLLEY) + 1.15 * LADLE) / all;
    near(
        value(&summary, "rail_factor", "CMAA 70", "DLF"),
        wanted,
        1e-9,
    );
    near(
        value(&summary, "rail_factor", "AIST TR-13", "impact"),
        1.25,
        1e-12,
    );
}

/// Analytic: the stops take v sqrt(m S) of bridge and trolley as one mass, less what the bridge's parts move against each other; the
/// code takes 1.25 x 0.7 of the rated speed in place of v.
#[test]
fn a_buffer_stands_beside_its_code_value() {
    let mut scene = scene("buffer");
    for name in ["aisle", "girders"] {
        scene["structures"][name]["foundation"] = json!("rigid");
    }
    scene["structures"]["aisle"]["longitudinal"] = json!(false);
    scene["bodies"]["bridge"]["x0"] = json!(202.0);
    scene["bodies"]["ladle"]["x0"] = json!(202.0);
    scene["end"]["time"] = json!(1.2);
    scene["practice"] =
        json!({"kind": "ladle", "bridge_speed": 5, "bumper_stroke": 1.5, "bumper_efficiency": 0.8});
    let (_, summary) = run(&scene);
    let wanted = 2.5 * ((BRIDGE + TROLLEY) / GRAVITY * 4e5).sqrt();
    let found = summary["practice"]["values"]["buffer"]["measured"]["value"]
        .as_f64()
        .expect("found");
    println!("{found} found, {wanted} of the closed form");
    assert!((found / wanted - 1.0).abs() < 2e-2, "{found} {wanted}");
    let code = value(&summary, "buffer", "EN 1991-3:2006", "phi7");
    assert!(
        (code / (1.25 * 0.7 * 5.0 / 2.5 * wanted) - 1.0).abs() < 1e-9,
        "{code}"
    );
    // a load that cannot swing adds its mass
    let loaded = value(&summary, "buffer", "EN 1991-3:2006", "with hoisted load");
    let mass = (BRIDGE + TROLLEY + LADLE) / (BRIDGE + TROLLEY);
    assert!(
        (loaded / (code * mass.sqrt()) - 1.0).abs() < 1e-9,
        "{loaded}"
    );
    // m v^2/(2 eta s) with v = 0.4 x 5 ft/s, a stroke of 1.5 ft and an efficiency of 0.8
    let stopped = value(&summary, "buffer", "29 CFR 1910.179", "m v^2");
    let by_hand = (BRIDGE + TROLLEY) / GRAVITY * 4.0 / (2.0 * 0.8 * 1.5);
    assert!(
        (stopped / by_hand - 1.0).abs() < 1e-9,
        "{stopped} {by_hand}"
    );
}

/// Every value says its edition and how it was checked.
fn assert_sources(practice: &Value) {
    let rows = practice["values"].as_object().expect("values").values();
    let codes = rows.flat_map(|row| row["codes"].as_array().expect("codes"));
    let factors = practice["factors"].as_object().expect("factors").values();
    let limits = practice["limits"].as_array().expect("limits").iter();
    let limits = limits.flat_map(|limit| limit["codes"].as_array().expect("codes"));
    let groups = practice["load_groups"].as_array().expect("groups").iter();
    let mut count = 0;
    for value in codes.chain(factors).chain(limits).chain(groups) {
        let text = |key: &str| {
            value[key]
                .as_str()
                .unwrap_or_else(|| panic!("{key} of {value}"))
                .to_owned()
        };
        assert!(
            !text("code").is_empty() && !text("clause").is_empty(),
            "{value}"
        );
        assert!(
            text("code") == "mechanics" || !text("edition").is_empty(),
            "{value}"
        );
        let sources = [
            "quoted in published calculations",
            "used by a public program",
            "from memory",
            "mechanics",
        ];
        assert!(sources.contains(&text("source").as_str()), "{value}");
        count += 1;
    }
    assert!(count > 50, "{count} values");
}

/// By hand: a crane at rest with the trolley in the middle has the wheel load (B + T + Q)/16 on all its wheels.
#[test]
fn a_pendant_crane_has_its_row_and_its_fatigue_loads() {
    let mut scene = scene("drop");
    scene["bodies"]["ladle"]["weight"] = json!(LADLE);
    scene["practice"] =
        json!({"kind": "pendant", "hoisting": "HC2", "hoist_speed": 0.5, "s_class": "S5"});
    scene["events"] = json!([]);
    scene["end"]["time"] = json!(0.1);
    let (_, summary) = run(&scene);
    let practice = &summary["practice"];
    assert_sources(practice);
    let near = |found: f64, wanted: f64, share: f64| {
        assert!((found / wanted - 1.0).abs() <= share, "{found} {wanted}");
    };
    let factor = |name: &str| practice["factors"][name]["value"].as_f64().expect(name);
    let all = BRIDGE + TROLLEY + LADLE;
    // TR-13 for pendant-operated cranes: 10 % impact
    near(factor("impact"), 0.1, 1e-12);
    near(factor("wheel_impact"), 1.1 * all / 16.0, 1e-9);
    near(
        value(&summary, "rail_factor", "ASCE/SEI 7", "impact"),
        1.1,
        1e-12,
    );
    // no speed of the bridge is known: the least value of CMAA 70, and it says so
    near(factor("dead_load_factor"), 1.1, 1e-12);
    let formula = practice["factors"]["dead_load_factor"]["formula"]
        .as_str()
        .expect("a formula");
    assert!(
        formula.ends_with("minimum value, no speed given"),
        "{formula}"
    );
    // S5: lambda 0.630 and 0.758; phi_fat = (1 + 1.1)/2 and (1 + 1.151816)/2
    let phi2 = 1.1 + 0.34 * 0.5 * 0.3048;
    let load = (1.05 * (BRIDGE + TROLLEY) + (1.0 + phi2) / 2.0 * LADLE) / 16.0;
    near(factor("wheel_fatigue_normal"), 0.630 * load, 1e-9);
    near(factor("wheel_fatigue_shear"), 0.758 * load, 1e-9);
    let groups = practice["load_groups"].as_array().expect("groups");
    assert_eq!(
        groups.len(),
        11,
        "ten of EN 1991-3 and the fatigue combination of TR-13"
    );
    near(
        groups[0]["factors"]["hoist"].as_f64().expect("a factor"),
        phi2,
        1e-12,
    );
    near(
        groups[8]["factors"]["buffer"].as_f64().expect("a factor"),
        1.25,
        1e-12,
    );
    near(
        groups[10]["factors"]["side thrust"]
            .as_f64()
            .expect("a factor"),
        0.5,
        1e-12,
    );
    // at rest with the trolley in the middle the wheels carry their static loads, so that the run deflects as far;
    // the run is evaluated at fewer places of a span
    let limits = practice["limits"].as_array().expect("limits");
    let mut compared = 0;
    for limit in limits
        .iter()
        .filter(|limit| limit["name"] == "runway_vertical")
    {
        let ratios = summary["deflection_ratios"]
            .as_array()
            .expect("deflections");
        let same = |found: &&Value| {
            ["rail", "from", "to"]
                .iter()
                .all(|key| found[*key] == limit[*key])
                && found["direction"] == "vertical"
        };
        let of_run = ratios.iter().find(same).expect("the same span")["deflection"]
            .as_f64()
            .expect("a number");
        let by_statics = limit["static_deflection"].as_f64().expect("a number");
        assert!(
            (-2e-3..0.03).contains(&(by_statics / of_run - 1.0)),
            "{by_statics} {of_run}"
        );
        compared += 1;
    }
    assert!(compared >= 2, "a span of each rail");
    let left_out = practice["left_out"].to_string();
    assert!(
        !left_out.contains("s_class") && left_out.contains("bumper_stroke"),
        "{left_out}"
    );
}

/// By hand: pairs driven separately, the first at the guide, have H_S,1,1,T = f xi2 sum Q/n and H_S,2,1,T = f xi1 sum
/// Q/n with f = 0.3 (1 - exp(-250 alpha)); the rail at the guide receives S - H_S,1,1,T. H_T,1 : H_T,2 = xi2 : xi1.
#[test]
fn a_skewing_crane_prints_guide_force_and_net_force() {
    let mut scene = scene("skew");
    scene["end"]["time"] = json!(1.0);
    scene["practice"] =
        json!({"kind": "ladle", "rail_head": 0.333, "class": "D", "building_class": "A"});
    let (_, summary) = run(&scene);
    assert_sources(&summary["practice"]);
    let en = |formula: &str| value(&summary, "wheel_lateral", "EN 1991-3:2006", formula);
    let crane = &summary["practice"]["crane"];
    let of = |name: &str| crane[name].as_f64().expect("a number");
    let factor = |name: &str| {
        summary["practice"]["factors"][name]["value"]
            .as_f64()
            .expect(name)
    };
    let (close, far) = (factor("wheel_near"), factor("wheel_far"));
    let xi1 = close / (close + far);
    let guide = en("guide force S");
    // H_S,1,1,T : H_S,2,1,T = xi2 : xi1, both (1 - e1/h)/n with e1 = 0
    let rest = guide - en("net force on the rail");
    let other = en("H_S,2,1,T");
    assert!(
        (rest / other - (1.0 - xi1) / xi1).abs() < 1e-9,
        "{rest} {other}"
    );
    // f sum Q/n = H_S,1,1,T + H_S,2,1,T, and f = 0.3 (1 - exp(-250 alpha))
    let text = summary["practice"]["values"]["wheel_lateral"]["codes"][0]["formula"]
        .as_str()
        .expect("a text");
    let angle: f64 = text
        .rsplit("at ")
        .next()
        .and_then(|t| t.trim_end_matches(" rad").parse().ok())
        .expect(text);
    let friction = 0.3 * (1.0 - (-250.0 * angle).exp());
    let all = of("lifted") + of("trolley") + of("bridge");
    let by_hand = friction * all / of("wheels");
    assert!(
        ((rest + other) / by_hand - 1.0).abs() < 1e-2,
        "the angle is printed to four digits"
    );
    // H_T,1 : H_T,2 = xi2 : xi1
    let drives = en("H_T,1") / en("H_T,2");
    assert!((drives - (1.0 - xi1) / xi1).abs() < 1e-9, "{drives}");
    assert!(
        en("H_T,2") > en("H_T,1"),
        "the rail that carries less receives more"
    );
    // limits: class D of Design Guide 7 and class A of TR-13
    let limits = summary["practice"]["limits"].as_array().expect("limits");
    let vertical = limits
        .iter()
        .find(|limit| limit["name"] == "runway_vertical")
        .expect("a limit");
    let span =
        vertical["to"].as_f64().expect("an end") - vertical["from"].as_f64().expect("an end");
    let allowable = |code: &str| -> Vec<f64> {
        let codes = vertical["codes"].as_array().expect("codes").iter();
        let own = codes.filter(|limit| limit["code"] == code);
        own.map(|limit| limit["value"].as_f64().expect("a value"))
            .collect()
    };
    let expected = [
        ("AISC Design Guide 7", span / 800.0),
        ("AIST TR-13", span / 1000.0),
        ("CMAA 70", span / 600.0),
        ("EN 1993-6:2007", (span / 600.0).min(0.025 / 0.3048)),
        ("IS 800", span / 1000.0),
    ];
    for (code, expected) in expected {
        let found = allowable(code);
        assert!(
            found.len() == 1 && (found[0] / expected - 1.0).abs() < 1e-12,
            "{code}: {found:?}"
        );
    }
}
