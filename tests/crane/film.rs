//! The crane that moves in the report.

use serde_json::{Value, json};

use super::{run_whole, scene};

/// What moves in a report, frame by frame, and the time that it stands at.
fn film(report: &str) -> (Value, f64) {
    let (_, rest) = report
        .split_once("class=\"picture animation\"")
        .expect("a picture that moves");
    let (_, rest) = rest
        .split_once("data-still=\"")
        .expect("a frame that stands");
    let (still, rest) = rest.split_once("\">").expect("an attribute");
    let (data, _) = rest.split_once("</script>").expect("an end");
    (
        serde_json::from_str(data).expect("JSON"),
        still.parse().expect("a time"),
    )
}

/// The numbers of a code: whole steps of a power of ten, each from the one before; the last step repeats.
fn decoded(code: &Value, count: usize) -> Vec<f64> {
    let power = 10f64.powi(code["s"].as_i64().expect("an exponent") as i32);
    let steps: Vec<i64> = serde_json::from_value(code["v"].clone()).expect("whole numbers");
    let mut at = 0;
    (0..count)
        .map(|index| {
            at += steps[index.min(steps.len() - 1)];
            at as f64 * power
        })
        .collect()
}

/// By definition: pixels from the first frame are feet times one scale, for the bridge and for the ladle above the same rails; bars
/// are forces times one scale; all at the output times.
#[test]
fn pictures_move_as_the_history_does() {
    let mut scene = scene("skew");
    scene["end"]["time"] = json!(2);
    scene["output"]["dt"] = json!(0.1);
    let (histories, _, report) = run_whole(&scene);
    let history = &histories[0];
    let (film, still) = film(&report);
    let own = history.column("time");
    let count = own.len();
    assert_eq!(film["time"]["n"], count);
    for (time, own) in decoded(&film["time"], count).into_iter().zip(own) {
        assert!((time - own).abs() <= 5.1e-7, "{time} {own}");
    }
    assert!(own.contains(&still), "{still}");
    let tracks = film["tracks"].as_array().expect("tracks");
    let moved: Vec<Vec<[f64; 2]>> = tracks
        .iter()
        .filter(|track| track["a"] == "transform")
        .map(|track| {
            let [x, y] = ["x", "y"].map(|axis| decoded(&track[axis], count));
            x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
        })
        .collect();
    // bridge, trolley, ladle in plan
    let bridge = history.column("bridge.x");
    let last = bridge.len() - 1;
    let scale = (moved[0][last][0] - moved[0][0][0]) / (bridge[last] - bridge[0]);
    // 748 pixels for 240 ft between the outer columns
    assert!((scale / (748.0 / 240.0) - 1.0).abs() < 0.05, "{scale}");
    for (places, column) in [
        (&moved[0], "bridge.x"),
        (&moved[1], "bridge.x"),
        (&moved[2], "ladle.X"),
    ] {
        let x = history.column(column);
        for (place, x_now) in places.iter().zip(x) {
            let wanted = (x_now - x[0]) * scale;
            assert!(
                (place[0] - places[0][0] - wanted).abs() < 0.03,
                "{column}: {place:?} {wanted}"
            );
        }
    }
    let says: Vec<&Value> = tracks.iter().filter(|track| track["a"] == "text").collect();
    let shown = decoded(&says[1]["v"], count);
    for (shown, x) in shown.iter().zip(history.column("bridge.x")) {
        assert!((shown - x).abs() <= 0.005 + 1e-9, "{shown} {x}");
    }
}
