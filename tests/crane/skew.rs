//! A bridge that only its north wheels drive: what keeps it straight.

use serde_json::{Value, json};

use super::{GRAVITY, History, example, read, run, scene};

/// Half the distance of the rails.
const HALF: f64 = 37.5;

/// Wheels by truck: its name, their number, the z of their rail.
const TRUCKS: [(&str, usize, f64); 3] = [("NW", 4, HALF), ("NE", 4, HALF), ("S", 8, -HALF)];

fn skew(end: f64) -> Value {
    let mut scene = scene("skew");
    scene["end"]["time"] = json!(end);
    scene["output"] = json!({"dt": 0.02, "reactions": ["aisle"], "sections": false});
    scene
}

/// Moments about the vertical through x = `from` on the crane at every output: of what pushes it along at its treads, and of its flanges.
fn moments(history: &History, from: f64) -> [Vec<f64>; 2] {
    let rows = history.column("time").len();
    let mut out = [vec![0.0; rows], vec![0.0; rows]];
    for (truck, count, z) in TRUCKS {
        for wheel in 1..=count {
            let of = |part: &str| history.column(&format!("{truck}.wheel{wheel}.{part}"));
            let (x, traction, lateral) = (of("x"), of("traction"), of("lateral"));
            for row in 0..rows {
                out[0][row] -= z * traction[row];
                out[1][row] += (x[row] - from) * lateral[row];
            }
        }
    }
    out
}

/// Analytic: nothing of an influence foundation has inertia: about the vertical through the origin the columns' feet hold, force by
/// force and with their own moments, what drive and flanges turn, at every output.
#[test]
fn feet_of_columns_hold_the_moment_of_drive_and_flanges() {
    let (histories, _) = run(&skew(3.0));
    let history = &histories[0];
    let spec = read(&example().join("aisle.json"));
    let rows = history.column("time").len();
    let mut ground = vec![0.0; rows];
    let sets = spec["point_sets"].as_object().expect("point sets");
    for (name, points) in sets.iter().filter(|(name, _)| name.contains("foot")) {
        let point = &spec["points"][points[0].as_u64().expect("an index") as usize];
        let [x, z] = [0, 2].map(|k| point[k].as_f64().expect("a coordinate"));
        for (freedom, arm) in [("ux", z), ("uz", -x), ("ry", 1.0)] {
            let all = history.all(&format!("aisle.{name}.{freedom}"), "");
            for (sum, value) in ground
                .iter_mut()
                .zip(all.first().expect("a reaction").iter())
            {
                *sum += arm * value;
            }
        }
    }
    let [push, flanges] = moments(history, 0.0);
    let largest = push.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
    let apart = (0..rows)
        .map(|row| (ground[row] - push[row] - flanges[row]).abs())
        .fold(0.0, f64::max);
    println!(
        "moments {:.1e} of the largest, {largest} lbf ft, apart",
        apart / largest
    );
    assert!(apart < 1e-9 * largest && largest > 1e6, "{apart} {largest}");
}

/// Analytic: the flanges turn the bridge back as the one-sided drive turns it, but for the angular momentum that it gains:
/// integral of both moments = sum m (z v_x - x v_z) + I yaw', about the vertical where the bridge ends.
#[test]
fn flanges_turn_back_what_a_one_sided_drive_turns() {
    let mut scene = skew(4.0);
    scene["compare"] = json!([{"label": "rigid", "structures": {
        "aisle": {"foundation": "rigid", "longitudinal": false}, "girders": {"foundation": "rigid"}}}]);
    let (histories, _) = run(&scene);
    for (history, label) in histories.iter().zip(["flexible", "rigid"]) {
        let last = |name: &str| history.column(name).last().copied().expect("rows");
        let time = history.column("time");
        let impulse = |values: &[f64]| -> f64 {
            (1..time.len())
                .map(|i| 0.5 * (values[i] + values[i - 1]) * (time[i] - time[i - 1]))
                .sum()
        };
        let [push, flanges] = moments(history, last("bridge.x")).map(|moment| impulse(&moment));
        // The trolley stands 14 ft from the south; the girders' mass lies evenly.
        let trolley = 4.5e5 / GRAVITY * (14.0 - HALF) * last("bridge.speed");
        let [x, z] = [last("ladle.X") - last("bridge.x"), last("ladle.Z")];
        let ladle = 1.02e6 / GRAVITY * (z * last("ladle.X_speed") - x * last("ladle.Z_speed"));
        let gained = trolley + ladle;
        println!("{label}: drive {push:.4e}, flanges {flanges:.4e}, gained {gained:.4e}");
        assert!(
            push > 5e6 && flanges < -0.5 * push,
            "{label}: {push} {flanges}"
        );
        assert!(
            (push + flanges - gained).abs() < 0.03 * push,
            "{label}: {push} {flanges} {gained}"
        );
        // only the north wheels drive
        assert!(
            history
                .all("S.", ".traction")
                .iter()
                .all(|own| own.iter().all(|force| *force == 0.0))
        );
    }
}
