//! Equilibrium at every output time, inertia and all.

use super::*;

/// Nodes and weights on -1..1, exact to degree seven.
const GAUSS: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];

/// Integral of m phi_k along the girder for each freedom: momentum per unit speed, from the shapes alone.
pub(super) fn momenta(laid: &BuiltFoundation, mass: f64) -> Vec<f64> {
    let Some(structure) = &laid.foundation.structure else {
        return Vec::new();
    };
    let n = laid.foundation.dofs();
    if let Some(MotionBasis::Parts(parts)) = &laid.basis {
        let of = |k: usize| {
            let each = parts.ends.windows(2).enumerate();
            each.map(|(j, ends)| mass * (ends[1] - ends[0]) * parts.basis[(6 * j + 1, k)])
                .sum()
        };
        return (0..n).map(of).collect();
    }
    let extent = &laid.foundation.rails[0];
    let mut cuts: Vec<f64> = extent
        .range
        .into_iter()
        .flatten()
        .chain(extent.breaks.iter().copied())
        .collect();
    // shapes are cubics between the joints of the members as they are cut
    if let Some(MotionBasis::Modes { refined, .. }) = &laid.basis {
        cuts.extend(refined.frame.line().expect("a rail").breaks(0));
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let mut sum = vec![0.0; n];
    let (mut value, mut slope) = (vec![0.0; n], vec![0.0; n]);
    for cut in cuts.windows(2) {
        let half = 0.5 * (cut[1] - cut[0]);
        for [place, weight] in GAUSS {
            let at = Probe {
                rail: 0,
                x: cut[0] + half * (1.0 + place),
                axis: Axis::Vertical,
            };
            structure
                .shapes
                .row(at, &mut value, &mut slope)
                .expect("a place on the rail");
            sum.iter_mut()
                .zip(&value)
                .for_each(|(sum, phi)| *sum += mass * half * weight * phi);
        }
    }
    sum
}

/// Largest imbalance of wheel forces, reactions and inertia over the largest wheel force; and the largest inertia.
fn imbalance(ran: &Ran, case: usize, mass: f64) -> [f64; 2] {
    let history = &ran.outcomes[case].run.history;
    let laid = ran.laid(case);
    let momenta = momenta(&laid, mass);
    let wheels = ran.sum(case, ".reaction");
    let reactions = ran.sum(case, ".vertical");
    let mut inertia = vec![0.0; wheels.len()];
    for (k, momentum) in momenta.iter().enumerate() {
        let acceleration = history.column(Channel::Acceleration(0, k));
        inertia
            .iter_mut()
            .zip(acceleration)
            .for_each(|(sum, a)| *sum += momentum * a);
    }
    let whole = largest(wheels.iter().copied());
    // up: reactions - wheels = m a
    let apart = wheels
        .iter()
        .zip(&reactions)
        .zip(&inertia)
        .map(|((w, r), a)| (r - w - a) / whole);
    [largest(apart), largest(inertia.iter().map(|a| a / whole))]
}

#[test]
fn reactions_are_wheel_forces_less_inertia_at_every_output_on_every_foundation() {
    let foundations = [
        json!({"foundation": "influence"}),
        json!({"foundation": "rigid"}),
        json!({"foundation": "modal", "modes": 4, "damping": 0.02}),
        json!({"foundation": "full", "elements": 12, "damping": 0.005}),
        json!({"foundation": "parts", "count": 6}),
    ];
    let mut given = scene(&json!([-0.9, 0.9]), 12.0, 1.3, 0.01);
    given["bodies"]["car"]["start"] = json!({"y": 0.004});
    given["structures"]["girder"] = json!({"spec": "spec.json", "foundation": "influence"});
    given["compare"] = foundations[1..]
        .iter()
        .enumerate()
        .map(|(k, foundation)| json!({"label": format!("case{k}"), "structures": {"girder": foundation}}))
        .collect();
    let ran = run(&given, &girder(&[9.0, 11.0]));
    for (case, foundation) in foundations.iter().enumerate() {
        let [apart, inertia] = imbalance(&ran, case, 400.0);
        let word = foundation["foundation"].as_str().expect("a word");
        println!("{word}: imbalance {apart:.1e}, inertia up to {inertia:.2} of the wheel forces");
        assert!(apart < 1e-9, "{word}: {apart:e}");
        let moves = !matches!(word, "influence" | "rigid");
        assert!(moves == (inertia > 0.01), "{word}: inertia {inertia}");
    }
}

/// Independent of the solver's own accelerations: those recorded are second differences of the motion recorded.
#[test]
fn recorded_accelerations_are_second_differences_of_the_motion() {
    let mut given = scene(&json!([0.0]), 12.0, 0.6, 0.0005);
    given["structures"]["girder"] =
        json!({"spec": "spec.json", "foundation": "modal", "modes": 2, "damping": 0.01});
    let ran = run(&given, &girder(&[10.0]));
    let history = &ran.outcomes[0].run.history;
    for k in 0..2 {
        let q = history.column(Channel::Coordinate(0, k));
        let a = history.column(Channel::Acceleration(0, k));
        let scale = largest(a.iter().copied());
        let apart = (2..q.len() - 2).map(|i| {
            let second = -q[i - 2] + 16.0 * q[i - 1] - 30.0 * q[i] + 16.0 * q[i + 1] - q[i + 2];
            (second / (12.0 * 0.0005 * 0.0005) - a[i]) / scale
        });
        let worst = largest(apart);
        println!("mode {k}: accelerations within {worst:.1e} of second differences");
        assert!(worst < 1e-2, "mode {k}: {worst:e}");
    }
}

/// The paper's claim for a girder that wheels press statically: flexible and rigid have one settled mean.
#[test]
fn flexible_and_rigid_reactions_have_equal_settled_means() {
    let mut given = scene(&json!([-0.9, 0.9]), 0.0, 20.0, 0.02);
    given["bodies"]["car"]["x0"] = json!(4.0);
    given["bodies"]["car"]["start"] = json!({"y": 0.003});
    given["structures"]["girder"] =
        json!({"spec": "spec.json", "foundation": "modal", "modes": 5, "damping": 0.03});
    given["compare"] =
        json!([{"label": "rigid", "structures": {"girder": {"foundation": "rigid"}}}]);
    let ran = run(&given, &girder(&[10.0]));
    let mean = |case: usize| {
        let values = ran.column(case, "girder.support1.vertical");
        let settled = &values[values.len() / 2..];
        settled.iter().sum::<f64>() / settled.len() as f64
    };
    let [flexible, rigid] = [mean(0), mean(1)];
    println!("settled means: {flexible:.3} flexible, {rigid:.3} rigid");
    assert!((flexible / rigid - 1.0).abs() < 1e-3);
    assert!((rigid / (0.6 * 8000.0 * 9.81) - 1.0).abs() < 1e-3);
}

/// The momentum of a mode by the mass matrix of the frame, whose path to the reactions is another.
#[test]
fn the_mill_girderway_with_mass_balances_in_three_directions() {
    let example =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/mill_girderway");
    let read = |name: &str| -> Value {
        let text = std::fs::read_to_string(example.join(name)).expect("an example");
        serde_json::from_str(&text).expect("JSON")
    };
    let (mut given, mut spec) = (read("scene.json"), read("spec.json"));
    for material in spec["materials"].as_array_mut().expect("materials") {
        material["density"] = json!(15.2);
    }
    given["structures"]["aisle"] =
        json!({"spec": "spec.json", "foundation": "modal", "modes": 8, "damping": 0.02});
    given["wheels"]["runway"]["lateral"] = json!({"k": 1e6, "clearance": 0.0});
    given["bodies"]["truck"]["dof"] = json!(["y", "z", "pitch"]);
    given["bodies"]["truck"]["start"] = json!({"z": 0.01});
    given["motions"][0]["speed"] = json!([[0, 40]]);
    given["end"]["time"] = json!(1.0);
    given["output"]["dt"] = json!(0.02);
    given["accuracy"] = json!(1e-4);
    given["compare"] = json!([]);
    let ran = run(&given, &spec);
    let structure = &ran.document.cases[0].scene.structures[0];
    let laid = foundations::build(
        &mut ModeCache::default(),
        structure,
        solution_of(&ran.known, &structure.origin),
        true,
    )
    .expect("a foundation");
    let Some(MotionBasis::Modes { refined, .. }) = &laid.basis else {
        panic!("natural modes")
    };
    let record = &ran.outcomes[0].columns;
    let history = &ran.outcomes[0].run.history;
    let wheels = |part: &str, sign: f64| -> Vec<f64> {
        let all: Vec<&[f64]> = (1..=4)
            .map(|k| record.values(&format!("truck.wheel{k}.{part}")))
            .collect();
        (0..history.len())
            .map(|i| sign * all.iter().map(|force| force[i]).sum::<f64>())
            .collect()
    };
    let still = vec![0.0; history.len()];
    for (k, (freedom, loads)) in [
        (".ux", still),
        (".uy", wheels("vertical", -1.0)),
        (".uz", wheels("lateral", 1.0)),
    ]
    .into_iter()
    .enumerate()
    {
        let own = record
            .columns
            .iter()
            .filter(|c| c.name.starts_with("aisle.") && c.name.ends_with(freedom));
        let mut sum = loads.clone();
        own.for_each(|column| {
            sum.iter_mut()
                .zip(&column.values)
                .for_each(|(sum, value)| *sum += value)
        });
        for (mode, shape) in refined.modes.modes.iter().enumerate() {
            let acceleration = history.column(Channel::Acceleration(0, mode));
            sum.iter_mut()
                .zip(acceleration)
                .for_each(|(sum, a)| *sum -= shape.coupling[k] * a);
        }
        let apart = largest(sum) / 480_000.0;
        println!("mill girderway{freedom}: imbalance {apart:.1e} of the truck's weight");
        assert!(apart < 1e-9, "{freedom}: {apart:e}");
    }
}
