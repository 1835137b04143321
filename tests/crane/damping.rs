//! The crane that rings: its frequency beside its natural modes, its damping beside that of its rope.

use std::f64::consts::TAU;

use practice::decay;
use serde_json::{Value, json};

use super::{GRAVITY, History, run, scene};

const LADLE: f64 = 1.02e6;
/// Rope: EA over its unstretched length.
const ROPE: f64 = 2.8e8 / 40.0;

/// The crane that stands in the long bay with its ladle at rest, flexible and rigid; `damping` in both ropes.
fn standing(damping: [f64; 2], start: [Option<f64>; 2], end: f64) -> Vec<(History, Value)> {
    let mut scene = scene("lifting");
    scene["stops"] = json!([]);
    scene["end"]["time"] = json!(end);
    scene["output"] = json!({"dt": 0.01, "reactions": false, "sections": false});
    let rope = |c: f64| json!([{"name": "hoist", "from": {"body": "trolley", "at": [0, 4, 0]}, "to": {"body": "ladle"}, "EA": 2.8e8, "length": 40, "c": c}]);
    let ladle = |start: Option<f64>| match start {
        Some(y) => json!({"weight": LADLE, "dof": ["X", "Y", "Z"], "x0": 120, "start": {"y": y}}),
        None => json!({"weight": LADLE, "dof": ["X", "Y", "Z"]}),
    };
    (scene["bodies"]["ladle"], scene["ropes"]) = (ladle(start[0]), rope(damping[0]));
    let other = match start[1] {
        Some(_) => ladle(start[1]),
        None => json!({}),
    };
    scene["compare"] = json!([{"label": "rigid", "bodies": {"ladle": other}, "ropes": rope(damping[1]), "structures": {
        "aisle": {"foundation": "rigid", "longitudinal": false}, "girders": {"foundation": "rigid"}}}]);
    let (histories, summary) = run(&scene);
    let mut out: Vec<(History, Value)> = Vec::new();
    for (k, history) in histories.into_iter().enumerate() {
        let own = if k == 0 {
            &summary
        } else {
            &summary["compare"]["rigid"]
        };
        out.push((history, own["natural_modes"].clone()));
    }
    out
}

/// Frequency and kinetic share of the ladle in the mode in which it bounces.
fn bounce(modes: &Value) -> [f64; 2] {
    let all = modes.as_array().expect("natural modes");
    let own = |mode: &&Value| {
        mode["mode"]
            .as_str()
            .is_some_and(|name| name.starts_with("ladle.Y"))
    };
    let mode = all.iter().find(own).expect("a bouncing ladle");
    [&mode["hz"], &mode["fractions"]["ladle.Y"]].map(|value| value.as_f64().expect("a number"))
}

/// Analytic: a mode of frequency w in which the ladle has the share s of the kinetic energy stretches its rope by m w^2 / k
/// of the ladle's motion: a damper c beside the rope gives it s c m w^3 / (2 k^2) of critical damping. The ladle plucked at rest
/// rings at w and dies away so.
#[test]
fn a_plucked_ladle_rings_and_dies_away_as_its_mode_says() {
    let mass = LADLE / GRAVITY;
    let rest = standing([0.0; 2], [None; 2], 2.0);
    let modes = [0, 1].map(|k| bounce(&rest[k].1));
    let start = [0, 1].map(|k| Some(rest[k].0.column("ladle.Y")[0] - 0.02));
    let [soft, stiff] = [modes[0][0], modes[1][0]];
    assert!(soft < 0.92 * stiff, "{soft} {stiff}");
    let mut wheels = [0.0; 2];
    for ratio in [0.0, 0.005, 0.01, 0.02, 0.05] {
        let damping = modes
            .map(|[hz, share]| 2.0 * ratio * ROPE * ROPE / (share * mass * (TAU * hz).powi(3)));
        for (k, (history, _)) in standing(damping, start, 5.0).iter().enumerate() {
            // half a second for what else the pluck shakes
            let ring = &history.column("hoist.tension")[50..];
            let found = decay(ring, 0.01, 0.05)
                .expect("samples")
                .expect("a ringing rope");
            let hz = modes[k][0];
            let name = ["flexible", "rigid"][k];
            println!(
                "{name}, rope {ratio}: damping {:.5}, {:.4} Hz of {hz:.4} by the mode, c {:.0}",
                found.ratio, found.frequency, damping[k]
            );
            assert!(
                (found.frequency / hz - 1.0).abs() < 0.01,
                "{name}, {ratio}: {found:?} {hz}"
            );
            if ratio == 0.0 {
                // the wheels' own dampers
                wheels[k] = found.ratio;
                assert!(found.ratio > 0.0 && found.ratio < 1e-3, "{name}: {found:?}");
            } else {
                let own = found.ratio - wheels[k];
                assert!((own / ratio - 1.0).abs() < 0.05, "{name}, {ratio}: {own}");
            }
        }
    }
}
