//! Two cranes on one runway that meet at a buffer.

use serde_json::json;

use super::{GRAVITY, run, scene};

/// Analytic: nothing but drives pushes the cranes along straight rails that do not give: all momentum along the runway is that of
/// the drives, and the second crane's that of its drive and the buffer.
#[test]
fn momentum_of_two_cranes_passes_through_the_buffer() {
    let mut scene = scene("two_cranes");
    scene["structures"]["aisle"] = json!({"spec": "aisle.json", "foundation": "rigid"});
    scene["structures"]["girders"]["foundation"] = json!("rigid");
    // trapezia of drives at their limits, which flanges shake: at 0.005 s they err by 1 % of the buffer's impulse
    scene["output"] = json!({"dt": 0.002, "reactions": false, "sections": false});
    let (histories, _) = run(&scene);
    let history = &histories[0];
    let time = history.column("time");
    let impulse = |name: &str| -> f64 {
        let values = history.column(name);
        (1..time.len())
            .map(|i| 0.5 * (values[i] + values[i - 1]) * (time[i] - time[i - 1]))
            .sum()
    };
    let last = |name: &str| history.column(name).last().copied().expect("rows");
    // the girders' weight is what all wheels carry beyond the bodies
    let carried: f64 = ["aisle.north.reaction", "aisle.south.reaction"]
        .iter()
        .map(|rail| history.column(rail)[0])
        .sum();
    let girders = carried - 5.56e5 - 4.5e5 - 1.02e6 - 1.2e6;
    let first = (5.56e5 + girders + 4.5e5) / GRAVITY * last("bridge.speed");
    let ladle = 1.02e6 / GRAVITY * last("ladle.X_speed");
    let second = 1.2e6 / GRAVITY * last("second.speed");
    let [drives, buffer] = [
        impulse("bridge.drive") + impulse("second.drive"),
        impulse("between.force"),
    ];
    let all = first + ladle + second;
    println!("momentum {all:.4e}, drives {drives:.4e}; second {second:.4e}, buffer {buffer:.4e}");
    assert!(buffer > 1e5, "{buffer}");
    assert!(
        (all - drives).abs() < 0.01 * buffer,
        "{all} {drives} {buffer}"
    );
    let given = buffer + impulse("second.drive");
    assert!(
        (second - given).abs() < 0.01 * buffer,
        "{second} {given} {buffer}"
    );
}

/// Analytic: two cranes of masses m1 and m2 without drives and load that meet at v press a buffer of k with v sqrt(k m), m =
/// m1 m2/(m1 + m2), for pi sqrt(m/k), and leave each other at v.
#[test]
fn free_cranes_bounce_off_each_other() {
    let (speeds, k) = ([2.5, -1.5], 2e5);
    let mut scene = scene("two_cranes");
    scene["structures"]["aisle"] = json!({"spec": "aisle.json", "foundation": "rigid"});
    scene["structures"]["girders"]["foundation"] = json!("rigid");
    scene["bodies"]
        .as_object_mut()
        .expect("bodies")
        .remove("ladle");
    scene["ropes"] = json!([]);
    scene["motions"] = json!([]);
    for (body, speed) in ["bridge", "second"].into_iter().zip(speeds) {
        scene["bodies"][body]["v0"] = json!(speed);
        scene["bodies"][body]["dof"] = json!(["x", "y", "roll", "pitch"]);
    }
    scene["stops"] =
        json!([{"name": "between", "body": "bridge", "against": "second", "gap": 4, "k": k}]);
    scene["end"]["time"] = json!(4);
    scene["output"] = json!({"dt": 0.005, "reactions": false, "sections": false});
    let (histories, summary) = run(&scene);
    let history = &histories[0];
    let carried: f64 = ["aisle.north.reaction", "aisle.south.reaction"]
        .iter()
        .map(|rail| history.column(rail)[0])
        .sum();
    let masses = [(carried - 1.2e6) / GRAVITY, 1.2e6 / GRAVITY];
    let reduced = masses[0] * masses[1] / (masses[0] + masses[1]);
    let closing = speeds[0] - speeds[1];
    let wanted = closing * (k * reduced).sqrt();
    let peak = history.most("between.force");
    let touching = history
        .column("between.force")
        .iter()
        .filter(|force| **force > 0.0)
        .count() as f64
        * 0.005;
    let stay = std::f64::consts::PI * (reduced / k).sqrt();
    let last = |name: &str| history.column(name).last().copied().expect("rows");
    let parting = last("second.speed") - last("bridge.speed");
    println!("peak {peak}, {wanted}; {touching} s, {stay}; parting {parting}, closing {closing}");
    assert!((peak / wanted - 1.0).abs() < 0.01, "{peak} {wanted}");
    assert!(
        (touching - stay).abs() < 0.01 + 0.01 * stay,
        "{touching} {stay}"
    );
    assert!(
        (parting / closing - 1.0).abs() < 0.01,
        "{parting} {closing}"
    );
    assert!(
        summary["energy"]["residual"]
            .as_f64()
            .is_some_and(|left| left < 1e-4),
        "{}",
        summary["energy"]
    );
}
