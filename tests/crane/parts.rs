//! One part of a crane at a time, on a rail that does not give: closed forms.

use std::f64::consts::TAU;

use serde_json::{Value, json};

use super::{GRAVITY, run, upwards};

/// Weight of the ladle and of the trolley; rope: EA and length.
const LADLE: f64 = 1.02e6;
const TROLLEY: f64 = 4.5e5;
const EA: f64 = 2.8e8;
const LENGTH: f64 = 40.0;
const WHEEL: f64 = 1e8;

/// The trolley of the crane with its ladle, alone on the bridge girders, which stand on the ground and do not give.
fn trolley(end: f64) -> Value {
    json!({
        "format": "girderway-scene/1", "name": "trolley", "units": {"length": "ft", "force": "lbf", "time": "s"},
        "gravity": GRAVITY,
        "structures": {"girders": {"spec": "girders.json", "foundation": "rigid"}},
        "bodies": {
            "trolley": {"weight": TROLLEY, "inertia": [7e5, 9e5, 5e5], "dof": ["y", "roll", "pitch"],
                        "track": ["girders.west", "girders.east"], "x0": 37.5},
            "ladle": {"weight": LADLE, "dof": ["X", "Y", "Z"]}},
        "wheels": {"steel": {"radius": 1.25, "vertical": {"k": WHEEL}}},
        "trucks": [
            {"name": "W", "body": "trolley", "rail": "girders.west", "at": [0, 0, -10], "tree": [-6, 6]},
            {"name": "E", "body": "trolley", "rail": "girders.east", "at": [0, 0, 10], "tree": [-6, 6]}],
        "ropes": [{"name": "hoist", "from": {"body": "trolley"}, "to": {"body": "ladle"}, "EA": EA, "length": LENGTH}],
        "end": {"time": end}, "output": {"dt": 0.005, "reactions": false, "sections": false}, "accuracy": 1e-6,
    })
}

/// Length of the rope with the ladle at rest.
fn hung() -> f64 {
    LENGTH * (1.0 + LADLE / EA)
}

/// Analytic: let go `a` aside, the ladle swings with 2 pi sqrt(l/g) (1 + (a/l)^2 / 16) and comes back as far, since nothing
/// dissipates.
#[test]
fn a_ladle_swings_in_the_period_of_a_pendulum() {
    let aside = 2.0_f64;
    let mut scene = trolley(16.0);
    let top = 1.25;
    scene["bodies"]["ladle"]["x0"] = json!(37.5);
    scene["bodies"]["ladle"]["start"] =
        json!({"y": top - (hung() * hung() - aside * aside).sqrt(), "z": aside});
    let (histories, summary) = run(&scene);
    let swing = &histories[0];
    let passes = upwards(swing.column("time"), swing.column("ladle.Z"));
    let [first, .., last] = passes[..] else {
        panic!("{passes:?}")
    };
    let period = (last - first) / (passes.len() - 1) as f64;
    let wanted = TAU * (hung() / GRAVITY).sqrt() * (1.0 + (aside / hung()).powi(2) / 16.0);
    println!("period {period} s, {wanted} of the closed form");
    assert!((period / wanted - 1.0).abs() < 2e-3, "{period} {wanted}");
    assert!((swing.most("ladle.Z") / aside - 1.0).abs() < 1e-3);
    assert!(
        summary["energy"]["residual"]
            .as_f64()
            .is_some_and(|left| left < 1e-6),
        "{}",
        summary["energy"]
    );
}

/// Analytic: a trolley at v that stops at once leaves its ladle swinging by v sqrt(l/g), more exactly by theta with
/// 1 - cos theta = v^2 / (2 g l).
#[test]
fn a_sudden_stop_swings_the_ladle_by_the_root_of_l_over_g() {
    let speed = 3.33;
    let mut scene = trolley(4.0);
    scene["bodies"]["trolley"]["x0"] = json!(30.0);
    scene["bodies"]["ladle"]["v0"] = json!(speed);
    scene["motions"] = json!([{"body": "trolley", "dof": "x", "kind": "prescribed", "speed": [[0, speed], [1, speed], [1.0001, 0]]}]);
    let (histories, _) = run(&scene);
    let end = histories[0].most("trolley.x");
    let swing = histories[0].most("ladle.X") - end;
    let angle = (1.0 - speed * speed / (2.0 * GRAVITY * hung())).acos();
    let wanted = hung() * angle.sin();
    println!(
        "swing {swing} ft, {wanted} exactly, {} by v sqrt(l/g)",
        speed * (hung() / GRAVITY).sqrt()
    );
    assert!((swing / wanted - 1.0).abs() < 1e-2, "{swing} {wanted}");
}

/// Analytic: a rope that becomes taut at the hoisting speed v stretches until it carries the ladle, which then oscillates:
/// W + v sqrt(k m) with rope and wheels in series; the trolley's own mass changes that by a share (w/W)^2 of the two frequencies.
#[test]
fn hoisting_off_the_floor_peaks_at_the_two_mass_closed_form() {
    let speed = 0.5;
    let mut scene = trolley(1.5);
    let floor = 1.25 - LENGTH;
    scene["bodies"]["ladle"]["x0"] = json!(37.5);
    scene["bodies"]["ladle"]["start"] = json!({"y": floor - LADLE / 1e10});
    scene["ropes"][0]["length"] = json!(LENGTH + 0.05);
    scene["ropes"][0]["speed"] = json!([[0, speed]]);
    scene["stops"] = json!([{"name": "floor", "body": "ladle", "Y": floor, "k": 1e10}]);
    scene["output"]["dt"] = json!(0.001);
    let (histories, _) = run(&scene);
    let peak = histories[0].most("hoist.tension");
    let stiffness = 1.0 / (LENGTH / EA + 1.0 / (4.0 * WHEEL));
    let wanted = LADLE + speed * (stiffness * LADLE / GRAVITY).sqrt();
    println!("peak {peak} lbf, {wanted} of the closed form");
    assert!((peak / wanted - 1.0).abs() < 1e-2, "{peak} {wanted}");
}

/// Analytic: a trolley without a ladle that runs into a buffer at v presses with v sqrt(m k).
#[test]
fn a_buffer_takes_v_sqrt_m_k() {
    let (speed, k) = (3.33, 2e5);
    let mut scene = trolley(2.0);
    scene["bodies"]
        .as_object_mut()
        .expect("bodies")
        .remove("ladle");
    scene["ropes"] = json!([]);
    scene["bodies"]["trolley"]["dof"] = json!(["x", "y", "roll", "pitch"]);
    scene["bodies"]["trolley"]["v0"] = json!(speed);
    scene["stops"] = json!([
        {"name": "west", "rail": "girders.west", "x": 46, "k": k}, {"name": "east", "rail": "girders.east", "x": 46, "k": k}]);
    let (histories, _) = run(&scene);
    let peak = histories[0].most("west.force") + histories[0].most("east.force");
    let wanted = speed * (2.0 * k * TROLLEY / GRAVITY).sqrt();
    println!("peak {peak} lbf, {wanted} of the closed form");
    assert!((peak / wanted - 1.0).abs() < 1e-3, "{peak} {wanted}");
}
