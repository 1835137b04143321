//! Reactions of a building that has mass, while it is struck by a rope that breaks.

use formats::scene::Document;
use foundations::{ModeCache, MotionBasis, solve};
use foundations::{SolvedStructure, distinct_specs, solution_of};
use results::cases::simulate;
use serde_json::json;
use sim::Channel;

use super::{example, scene};

/// Analytic: at every output the ground gives what the wheels press, less the momentum that the building gains, in three
/// directions; momenta by the mass matrix of the frame, accelerations by the run.
#[test]
fn columns_of_a_building_with_mass_carry_wheel_forces_less_its_inertia() {
    let mut scene = scene("drop");
    let folder = tempfile::tempdir().expect("a temporary folder");
    for spec in ["aisle.json", "girders.json"] {
        std::fs::copy(example().join(spec), folder.path().join(spec)).expect("a copy");
    }
    scene["events"][0]["when"] = json!("time >= 0.1");
    scene["bodies"]["bridge"]["start"] = json!({"z": 0.045});
    scene["structures"]["aisle"] = json!({"spec": "aisle.json", "foundation": "modal", "modes": 8, "damping": 0.02, "longitudinal": true});
    scene["end"]["time"] = json!(0.4);
    scene["output"] = json!({"dt": 0.01, "reactions": ["aisle"], "sections": false});
    std::fs::write(folder.path().join("scene.json"), scene.to_string()).expect("written");
    let document = Document::open(&folder.path().join("scene.json"))
        .unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let known: Vec<SolvedStructure> = distinct_specs(&document)
        .into_iter()
        .map(|(_, _, spec)| SolvedStructure {
            spec: spec.clone(),
            solution: solve(spec).expect("it stands").into(),
        })
        .collect();
    let outcomes = simulate(&document, &known, Some(1), &|_| ()).expect("it runs");
    let structure = &document.cases[0].scene.structures[0];
    let laid = foundations::build(
        &mut ModeCache::default(),
        structure,
        solution_of(&known, &structure.origin),
        true,
    )
    .expect("a foundation");
    let Some(MotionBasis::Modes { refined, .. }) = &laid.basis else {
        panic!("natural modes")
    };
    let (record, history) = (&outcomes[0].columns, &outcomes[0].run.history);
    let all = |begin: &str, end: &str| -> Vec<&Vec<f64>> {
        let own = record
            .columns
            .iter()
            .filter(|c| c.name.starts_with(begin) && c.name.ends_with(end));
        own.map(|column| &column.values).collect()
    };
    let weight: f64 = ["aisle.north.reaction", "aisle.south.reaction"]
        .map(|rail| record.values(rail)[0])
        .iter()
        .sum();
    for (k, (freedom, part, sign)) in [
        (".ux", ".traction", -1.0),
        (".uy", ".vertical", -1.0),
        (".uz", ".lateral", 1.0),
    ]
    .into_iter()
    .enumerate()
    {
        let wheels: Vec<&Vec<f64>> = ["NW.", "NE.", "S."]
            .iter()
            .flat_map(|truck| all(truck, part))
            .collect();
        let ground = all("aisle.", freedom);
        assert_eq!((wheels.len(), ground.len() > 5), (16, true), "{freedom}");
        let (mut worst, mut most) = (0.0_f64, 0.0_f64);
        for row in 0..history.len() {
            let mut inertia = 0.0;
            for (mode, shape) in refined.modes.modes.iter().enumerate() {
                inertia += shape.coupling[k] * history.column(Channel::Acceleration(0, mode))[row];
            }
            let loads: f64 = wheels.iter().map(|own| sign * own[row]).sum();
            let held: f64 = ground.iter().map(|own| own[row]).sum();
            worst = worst.max((held + loads - inertia).abs() / weight);
            most = most.max(inertia.abs() / weight);
        }
        println!("{freedom}: {worst:.1e} of the crane's weight open, inertia up to {most:.1e}");
        assert!(worst < 1e-9, "{freedom}: {worst:e}");
        assert!(k == 0 || most > 1e-4, "{freedom}: inertia {most:e}");
    }
}
