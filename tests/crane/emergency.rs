//! All brakes at full speed: what stops, and what swings on.

use serde_json::json;

use super::{GRAVITY, run, scene};

/// Analytic: what brakes and drives push is the momentum that the crane and its ladle lose; they stop within v^2 / 2a, a = mu g times the
/// whole weight over that of the crane without its ladle, and the ladle swings on from where it
/// was by v sqrt(l/g), along the runway and across.
#[test]
fn an_emergency_stop_leaves_the_ladle_swinging_by_the_root_of_l_over_g() {
    let mut scene = scene("emergency");
    scene["structures"]["aisle"] = json!({"spec": "aisle.json", "foundation": "rigid"});
    scene["structures"]["girders"]["foundation"] = json!("rigid");
    scene["end"]["time"] = json!(8.2);
    scene["output"] = json!({"dt": 0.01, "reactions": false, "sections": false});
    let (histories, summary) = run(&scene);
    let history = &histories[0];
    let braked = summary["events"][0]["time"].as_f64().expect("an event");
    let time = history.column("time");
    let from = time.iter().position(|t| *t >= braked).expect("a row");
    let of = |name: &str| history.column(name);
    let carried: f64 = ["aisle.north.reaction", "aisle.south.reaction"]
        .iter()
        .map(|rail| of(rail)[0])
        .sum();
    let ladle = 1.02e6;
    let crane = carried - ladle;
    // along the runway
    let speed = of("bridge.speed")[from - 1];
    let last = time.len() - 1;
    let impulse: f64 = (from..=last)
        .map(|i| {
            let push = |i: usize| of("bridge.brake")[i] + of("bridge.drive")[i];
            0.5 * (push(i) + push(i - 1)) * (time[i] - time[i - 1])
        })
        .sum();
    let momentum =
        |i: usize| (crane * of("bridge.speed")[i] + ladle * of("ladle.X_speed")[i]) / GRAVITY;
    let lost = momentum(from - 1) - momentum(last);
    println!("brakes {impulse:.4e}, momentum lost {lost:.4e}");
    assert!((impulse + lost).abs() < 0.02 * lost, "{impulse} {lost}");
    let way = of("bridge.x")[last] - of("bridge.x")[from - 1];
    let most = speed * speed / (2.0 * 0.2 * GRAVITY * carried / crane);
    println!("stops within {way} ft, {most} without the ladle's pull");
    assert!(way > 0.9 * most && way < 1.3 * most, "{way} {most}");
    // about where the crane stands: from where the ladle was and as fast as it moved
    let root = (40.0 * (1.0 + ladle / 2.8e8) / GRAVITY).sqrt();
    let swing = |axis: &str, rest: f64| {
        let place = of(&format!("ladle.{axis}"));
        let most = place[from..]
            .iter()
            .map(|x| (x - rest).abs())
            .fold(0.0_f64, f64::max);
        let speed = of(&format!("ladle.{axis}_speed"))[from - 1];
        [most, (speed * root).hypot(place[from - 1] - rest)]
    };
    let along = swing("X", of("bridge.x")[last]);
    let across = swing("Z", of("trolley.x")[last] - 37.5);
    println!("swing along {along:?}, across {across:?}");
    assert!((along[1] / (5.0 * root) - 1.0).abs() < 0.05, "{along:?}");
    for [seen, wanted] in [along, across] {
        assert!((seen / wanted - 1.0).abs() < 0.05, "{seen} {wanted}");
    }
}
