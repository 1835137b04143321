//! Couplings of the two girderways left out: what stays the same, and what a rail gives then.

use formats::scene::Document;
use foundations::distinct_specs;
use foundations::solve;
use serde_json::{Value, json};
use splines::{Axis, Compliance, Influence, Probe};

use super::{History, example, run, scene};

const LADLE: f64 = 1.02e6;
const TROLLEY: f64 = 4.5e5;
const BRIDGE: f64 = 5.56e5;

/// The crane at rest with its ladle hung, on the coupled aisle, on rails alone and on directions alone.
fn at_rest() -> Value {
    let mut scene = scene("scene");
    scene["structures"]["aisle"]["longitudinal"] = json!(false);
    scene["end"]["time"] = json!(0.02);
    scene["output"] = json!({"dt": 0.01, "reactions": false, "sections": false});
    let parted = |label: &str, word: &str| json!({"label": label, "structures": {"aisle": {"couplings": word}}});
    scene["compare"] = json!([parted("rails", "within rails"), parted("alone", "none")]);
    scene
}

/// Analytic: statics. All wheels together carry all weights whatever gives, also where flanges touch at rest; the girders
/// carry trolley and ladle.
#[test]
fn weights_are_carried_whatever_couplings_are_left_out() {
    let (histories, _) = run(&at_rest());
    let first = |history: &History, name: &str| history.column(name)[0];
    let girders = first(&histories[0], "girders.west.reaction")
        + first(&histories[0], "girders.east.reaction");
    let all =
        first(&histories[0], "aisle.north.reaction") + first(&histories[0], "aisle.south.reaction");
    let own = all - (BRIDGE + TROLLEY + LADLE);
    assert!(own > 1e5 && own < 3e5, "{own}: the girders' own weight");
    let mut pressed = 0.0_f64;
    for history in &histories {
        let carried =
            first(history, "girders.west.reaction") + first(history, "girders.east.reaction");
        let below = first(history, "aisle.north.reaction") + first(history, "aisle.south.reaction");
        let off = [
            carried / (TROLLEY + LADLE) - 1.0,
            carried / girders - 1.0,
            below / all - 1.0,
        ];
        println!("{off:?}");
        assert!(off.iter().all(|off| off.abs() < 1e-7), "{off:?}");
        let sideways = history
            .all("", ".lateral")
            .iter()
            .fold(0.0_f64, |most, own| most.max(own[0].abs()));
        pressed = pressed.max(sideways);
        let tension = history.column("hoist.tension")[0];
        assert!((tension / LADLE - 1.0).abs() < 1e-9, "{tension}");
    }
    assert!(pressed > 1e3, "a flange presses with {pressed}");
}

/// Independent: sums over the influence surface of the spec, solved apart, of the wheels that each word keeps.
#[test]
fn each_rail_gives_by_the_wheels_that_couplings_keep() {
    let mut scene = at_rest();
    scene["structures"]["aisle"]["irregularities"] = json!([]);
    let (histories, _) = run(&scene);
    let document = Document::open(&example().join("scene.json")).expect("a scene");
    let (_, _, spec) = distinct_specs(&document)
        .into_iter()
        .find(|(_, _, spec)| spec.rails().len() == 2)
        .expect("the aisle");
    let surface = solve(spec).expect("it stands").surface.expect("a surface");
    let mut wheels = Vec::new();
    for (truck, rail, count) in [("NW", 0, 4), ("NE", 0, 4), ("S", 1, 8)] {
        wheels.extend((1..=count).map(|k| (format!("{truck}.wheel{k}"), rail)));
    }
    let mut moved = [0.0_f64; 2];
    for (history, word) in histories.iter().zip(["all", "within rails", "none"]) {
        let of = |wheel: &str, part: &str| history.column(&format!("{wheel}.{part}"))[0];
        let probes: Vec<Probe> = [Axis::Vertical, Axis::Lateral]
            .into_iter()
            .flat_map(|axis| wheels.iter().map(move |(wheel, rail)| (wheel, *rail, axis)))
            .map(|(wheel, rail, axis)| Probe {
                rail,
                x: of(wheel, "x"),
                axis,
            })
            .collect();
        let forces: Vec<f64> = [("vertical", -1.0), ("lateral", 1.0)]
            .into_iter()
            .flat_map(|(part, sign)| wheels.iter().map(move |(wheel, _)| (wheel, part, sign)))
            .map(|(wheel, part, sign)| sign * of(wheel, part))
            .collect();
        let mut give = Influence::zeros(probes.len());
        surface
            .fill(&probes, &mut give)
            .expect("wheels on their rails");
        let sags: Vec<f64> = (0..wheels.len())
            .map(|i| {
                let kept = |j: &usize| match word {
                    "all" => true,
                    "within rails" => probes[i].rail == probes[*j].rail,
                    _ => (probes[i].rail, probes[i].axis) == (probes[*j].rail, probes[*j].axis),
                };
                -(0..probes.len())
                    .filter(kept)
                    .map(|j| give.value[(i, j)] * forces[j])
                    .sum::<f64>()
            })
            .collect();
        // wheels under one set of equalisers sag by their mean
        for truck in [0..4, 4..8, 8..16] {
            let wanted = sags[truck.clone()].iter().sum::<f64>() / truck.len() as f64;
            let seen = wheels[truck.clone()]
                .iter()
                .map(|(wheel, _)| of(wheel, "rail_deflection"))
                .sum::<f64>();
            let seen = seen / truck.len() as f64;
            assert!(
                (seen / wanted - 1.0).abs() < 1e-9,
                "{word}, {truck:?}: {seen} {wanted}"
            );
        }
        let sag = of("NW.wheel1", "rail_deflection");
        match word {
            "all" => moved = [sag; 2],
            "within rails" => moved[1] = sag,
            _ => {}
        }
    }
    println!(
        "sag of the north rail at its first wheel: {} coupled, {} alone",
        moved[0], moved[1]
    );
    assert!((moved[1] / moved[0] - 1.0).abs() > 1e-4, "{moved:?}");
}
