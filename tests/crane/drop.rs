//! A load that falls off: its fall, what its carriers do, and the whole crane that bounces.

use serde_json::json;

use super::{GRAVITY, run, scene};

const FALLS: f64 = 1.0;
const LADLE: f64 = 1.02e6;
const TROLLEY: f64 = 4.5e5;
const BRIDGE: f64 = 5.56e5;

/// Analytic: before it falls the rope carries the load, then nothing does, which falls by g t^2/2.
#[test]
fn a_dropped_load_falls_freely_and_the_whole_crane_bounces() {
    let mut scene = scene("drop");
    scene["end"]["time"] = json!(3);
    scene["output"]["dt"] = json!(0.02);
    let (histories, summary) = run(&scene);
    let history = &histories[0];
    let (time, height, tension) = (
        history.column("time"),
        history.column("ladle.Y"),
        history.column("hoist.tension"),
    );
    let mut fallen = 0;
    for ((t, y), force) in time.iter().zip(height).zip(tension) {
        let since = (t - FALLS).max(0.0);
        let wanted = height[0] - 0.5 * GRAVITY * since * since;
        assert!(
            (y - wanted).abs() < 1e-6 * (1.0 + since),
            "t = {t}: {y}, {wanted}"
        );
        let carried = if *t <= FALLS { LADLE } else { 0.0 };
        assert!(
            (force - carried).abs() < 1e-6 * LADLE || (t - FALLS).abs() < 1e-9,
            "t = {t}: {force}"
        );
        fallen += usize::from(since > 0.0);
    }
    assert!(fallen > 90, "{fallen}");
    // it is thrown off its girders, lands and clatters: the run goes on to its end
    let least = history
        .column("girders.west.reaction")
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    let steps = &summary["steps"];
    println!(
        "least force {least}, {steps}, energy {}",
        summary["energy"]["residual"]
    );
    assert_eq!(summary["status"], "done");
    assert_eq!(least, 0.0);
    assert!(
        steps["events"].as_u64().is_some_and(|events| events > 20),
        "{steps}"
    );
    assert!(
        summary["energy"]["residual"]
            .as_f64()
            .is_some_and(|left| left < 1e-4),
        "{}",
        summary["energy"]
    );
}

/// Analytic: on rails that do not give and without dampers the bridge on sixteen wheels and the trolley on four are two masses on
/// springs in a row, let go by W: F(t) = W_t + W sum a_j cos w_j t on the trolley's wheels, as long as they press.
#[test]
fn carriers_of_a_lighter_load_rebound_as_two_masses() {
    let load = 1.5e5;
    let (k, wheels) = (1e8, [16.0, 4.0]);
    let mut scene = scene("drop");
    scene["structures"]["aisle"] = json!({"spec": "aisle.json", "foundation": "rigid"});
    scene["structures"]["girders"]["foundation"] = json!("rigid");
    scene["bodies"]["ladle"]["weight"] = json!(load);
    for kind in ["runway", "trolley"] {
        scene["wheels"][kind]["vertical"]["c"] = json!(0);
    }
    scene["end"]["time"] = json!(1.4);
    scene["output"] = json!({"dt": 0.001, "reactions": false, "sections": false});
    scene["accuracy"] = json!(1e-6);
    let (histories, _) = run(&scene);
    let history = &histories[0];
    let carried = |row: usize| -> f64 {
        ["aisle.north.reaction", "aisle.south.reaction"]
            .iter()
            .map(|rail| history.column(rail)[row])
            .sum()
    };
    let girders = carried(0) - BRIDGE - TROLLEY - load;
    let [lower, upper] = wheels.map(|count| count * k);
    let [m1, m2] = [(BRIDGE + girders) / GRAVITY, TROLLEY / GRAVITY];
    // K phi = w^2 M phi of m1 below, m2 above
    let (a, b) = ((lower + upper) / m1, upper / m2);
    let root = ((a - b).powi(2) + 4.0 * upper * upper / (m1 * m2)).sqrt();
    let squares = [0.5 * (a + b - root), 0.5 * (a + b + root)];
    // before: y1 = W/lower, y2 = y1 + W/upper, down, from where the crane rests without the load
    let start = [load / lower, load / lower + load / upper];
    let parts = squares.map(|square| {
        let shape = [1.0, (lower + upper - square * m1) / upper];
        let own = (m1 * shape[0] * start[0] + m2 * shape[1] * start[1])
            / (m1 * shape[0] * shape[0] + m2 * shape[1] * shape[1]);
        (square.sqrt(), upper * own * (shape[1] - shape[0]))
    });
    let (mut worst, mut least, mut rows) = (0.0_f64, f64::INFINITY, 0);
    let sides = ["girders.west.reaction", "girders.east.reaction"].map(|rail| history.column(rail));
    for (row, t) in history
        .column("time")
        .iter()
        .enumerate()
        .filter(|(_, t)| **t > FALLS + 1e-9)
    {
        let since = t - FALLS;
        let wanted = TROLLEY
            + parts
                .iter()
                .map(|(omega, part)| part * (omega * since).cos())
                .sum::<f64>();
        let seen = sides[0][row] + sides[1][row];
        worst = worst.max((seen - wanted).abs() / TROLLEY);
        least = least.min(seen);
        rows += 1;
    }
    println!("within {worst:.1e} of the trolley's weight over {rows} rows, least {least} lbf");
    assert!(rows > 390 && worst < 2e-3, "{worst:e} over {rows}");
    assert!(least > 0.0 && least < TROLLEY - 0.9 * load, "{least}");
}
