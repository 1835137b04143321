//! The whole crane for its first seconds.

use serde_json::json;

use super::{run, scene};

/// Analytic: nothing of an influence foundation has inertia, so that at every output the ground pushes up as much as all wheels
/// press down, along the rails as much as the drive pushes the bridge, and sideways as much as all flanges take.
#[test]
fn columns_carry_what_the_wheels_press() {
    let mut scene = scene("skew");
    scene["end"]["time"] = json!(4);
    scene["output"] = json!({"dt": 0.1, "reactions": ["aisle"], "sections": false});
    let (histories, _) = run(&scene);
    let history = &histories[0];
    let wheels = |part: &str| -> Vec<&[f64]> {
        ["NW.", "NE.", "S."]
            .into_iter()
            .flat_map(|truck| history.all(truck, part))
            .collect()
    };
    let weight =
        history.column("aisle.north.reaction")[0] + history.column("aisle.south.reaction")[0];
    let up = history.all("aisle.", ".uy");
    assert_eq!((up.len(), wheels(".vertical").len()), (13, 16));
    let pairs = [
        ("up", up, wheels(".vertical"), 1.0),
        (
            "along",
            history.all("aisle.", ".ux"),
            wheels(".traction"),
            -1.0,
        ),
        (
            "by the drive",
            history.all("aisle.", ".ux"),
            vec![history.column("bridge.drive")],
            1.0,
        ),
        (
            "sideways",
            history.all("aisle.", ".uz"),
            wheels(".lateral"),
            -1.0,
        ),
    ];
    let sum = |of: &[&[f64]], i: usize| of.iter().map(|values| values[i]).sum::<f64>();
    for (word, ground, crane, sign) in &pairs {
        let rows = 0..history.column("time").len();
        let off = rows
            .clone()
            .map(|i| (sum(ground, i) - sign * sum(crane, i)).abs())
            .fold(0.0, f64::max)
            / weight;
        let most = rows.map(|i| sum(crane, i).abs()).fold(0.0, f64::max) / weight;
        println!("{word}: {off:e} of the crane's weight open, {most} carried");
        assert!(off < 1e-9 && most > 1e-3, "{word}: {off:e} {most}");
    }
}

/// Analytic: at rest each row of columns carries the same, whether the rails give or not; that of the two rows follows from moments.
#[test]
fn at_rest_both_rows_carry_the_same_flexible_and_rigid() {
    let mut scene = scene("lifting");
    scene["compare"] = json!([{"label": "rigid", "structures": {
        "aisle": {"foundation": "rigid", "longitudinal": false}, "girders": {"foundation": "rigid"}}}]);
    scene["bodies"]["ladle"] = json!({"weight": 1.02e6, "dof": ["X", "Y", "Z"]});
    scene["ropes"][0]
        .as_object_mut()
        .expect("a rope")
        .remove("speed");
    scene["stops"] = json!([]);
    scene["end"]["time"] = json!(0.2);
    scene["output"]["dt"] = json!(0.002);
    let (histories, summary) = run(&scene);
    let [flexible, rigid] = &histories[..] else {
        panic!("two runs")
    };
    for row in ["aisle.north.reaction", "aisle.south.reaction"] {
        let (soft, stiff) = (flexible.column(row)[0], rigid.column(row)[0]);
        println!("{row}: {soft} flexible, {stiff} rigid");
        assert!((soft / stiff - 1.0).abs() < 2e-3, "{row}: {soft} {stiff}");
    }
    let column = &summary["comparison"]["aisle.north foot 4.uy"];
    assert!(
        column["rigid"]["settled_mean"].is_number()
            && column.as_object().is_some_and(|runs| runs.len() == 2),
        "{column}"
    );
}
