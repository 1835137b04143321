//! Columns that give sideways.

use serde_json::json;

use super::{run, scene};

/// Independent: gauges at the columns record the same displacements on their way through the simulator; limits are height/400, and
/// 2 in where that is less. The verdict lists what is kept among what was not checked, as the forces of a run are not the
/// loads of the codes, and fails what is exceeded.
#[test]
fn drift_is_the_largest_that_gauges_at_the_columns_read() {
    let mut scene = scene("skew");
    scene["end"]["time"] = json!(4);
    scene["output"] = json!({"dt": 0.05, "reactions": false, "sections": false, "stresses": false});
    scene["practice"]["code"] = json!(["EN 1993-6", "AIST TR-13"]);
    let columns = [
        ("north", &[45.0, 90.0, 150.0, 195.0][..]),
        ("south", &[45.0, 90.0, 120.0, 150.0, 195.0][..]),
    ];
    let mut gauges = json!({});
    for (rail, places) in columns {
        for x in places {
            gauges[format!("{rail} {x}")] = json!({"rail": rail, "x": x, "direction": "lateral"});
        }
    }
    scene["structures"]["aisle"]["gauges"] = gauges;
    let (_, summary) = run(&scene);
    let drifts = summary["drift"].as_array().expect("drifts");
    assert_eq!(drifts.len(), 2, "{drifts:?}");
    for (drift, (rail, places)) in drifts.iter().zip(columns) {
        let of = |key: &str| drift[key].as_f64().expect(key);
        let read = |x: &f64| {
            let peak = &summary["peaks"][format!("aisle.{rail} {x}")];
            let size = |kind: &str| peak[kind]["value"].as_f64().expect(kind).abs();
            size("max").max(size("min"))
        };
        let most = places.iter().map(read).fold(0.0, f64::max);
        println!(
            "{rail}: {} at {}, {most} of the gauges",
            of("displacement"),
            of("x")
        );
        assert!(most > 1e-2, "{most}");
        assert!(
            (of("displacement") / most - 1.0).abs() < 1e-9,
            "{drift} {most}"
        );
        let height = of("height");
        assert!((50.0..60.0).contains(&height), "{height}");
        let limits = drift["limits"].as_array().expect("limits");
        assert_eq!(limits[0]["value"], height / 400.0);
        assert!(
            (limits[1]["value"].as_f64().expect("a limit") / (height / 400.0).min(1.0 / 6.0) - 1.0)
                .abs()
                < 1e-12
        );
        let verdict = &summary["verdict"];
        for limit in limits {
            let named = |one: &&serde_json::Value| {
                one["check"] == "lateral displacement of the frame at the rail"
                    && one["clause"] == limit["clause"]
            };
            let of = |key: &str| verdict[key].as_array().expect("a list").iter();
            let checked = of("checks")
                .filter(named)
                .filter(|one| one["rail"] == drift["rail"]);
            let listed = of("not_checked").filter(named);
            let listed = listed.filter(|one| {
                let rail = drift["rail"].as_str().expect("a name");
                one["reason"]
                    .as_str()
                    .is_some_and(|why| why.contains(&format!("rail {rail} by")))
            });
            let is_kept = limit["within"] == true;
            let found = [checked.count(), listed.count()];
            assert_eq!(
                found,
                [usize::from(!is_kept), usize::from(is_kept)],
                "{verdict}"
            );
        }
    }
}
