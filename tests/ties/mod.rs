//! Rails on sprung ties against closed forms and published track numbers: 136RE rail, units in, lbf and s.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use std::sync::Arc;

use fea::{BeamTheory, CrossSection, Girder};
use formats::scene::Document;
use formats::spec::ties::{Ties, on_ground, on_structure};
use formats::spec::{Form, Spec};
use formats::units::{Force, Length, Units};
use foundations::solve;
use foundations::{SolvedStructure, distinct_specs};
use nalgebra::DMatrix;
use results::case_result::CaseResult;
use results::cases::simulate;
use sim::{Fidelity, Reason};
use splines::{Axis, Compliance, ExactSurface, Influence, Probe};

const E: f64 = 30e6;
const I: f64 = 94.9;
const UNITS: Units = Units {
    length: Length::Inch,
    force: Force::Pound,
};

/// Ties that are, on the average, a bed of the modulus `u`.
fn ties(spacing: f64, u: f64) -> Ties {
    let rail = CrossSection {
        e: E,
        iz: I,
        ..CrossSection::default()
    };
    Ties {
        spacing,
        k: u * spacing,
        rail,
        elements: 1,
        ..Ties::default()
    }
}

fn influence(surface: &ExactSurface, probes: &[Probe]) -> DMatrix<f64> {
    let mut out = Influence::zeros(probes.len());
    surface.fill(probes, &mut out).expect("places on the rail");
    out.value
}

/// G(x, x), vertical, of the first rail.
fn give(spec: &Spec, places: &[f64]) -> Vec<f64> {
    let surface = solve(spec)
        .expect("it stands")
        .surface
        .expect("it is small");
    let at = |x: f64| {
        let probe = Probe {
            rail: 0,
            x,
            axis: Axis::Vertical,
        };
        influence(&surface, &[probe])[(0, 0)]
    };
    places.iter().map(|&x| at(x)).collect()
}

fn close(what: &str, found: f64, wanted: f64, tolerance: f64) {
    assert!(
        (found / wanted - 1.0).abs() < tolerance,
        "{what}: {found}, wanted {wanted}"
    );
}

/// External: beam on discrete springs 24 in apart, solved by transfer matrices: over a tie, at a quarter of the bay, in
/// its middle, and the difference of the extremes by their mean.
#[test]
fn discrete_ties_meet_the_published_give_and_modulation() {
    let cases = [
        (
            3000.0,
            [
                3.773_161_008_044_098e-6,
                3.777_522_958_263_273_4e-6,
                3.780_995_964_835_813e-6,
            ],
            0.002_074_343_125_207_224,
        ),
        (
            20000.0,
            [
                9.049_112_594_210_274e-7,
                9.129_680_331_731_793e-7,
                9.195_378_991_848_971e-7,
            ],
            0.016_034_033_828_649_95,
        ),
    ];
    for (u, wanted, modulation) in cases {
        // more than 30 decay lengths on either side
        let length = 24.0 * 120.0;
        let middle = length / 2.0;
        let spec = on_ground("track", UNITS, &ties(24.0, u), [0.0, length]).expect("a track");
        let found = give(&spec, &[middle, middle + 6.0, middle + 12.0]);
        for ((place, found), wanted) in ["tie", "quarter", "middle"].iter().zip(&found).zip(wanted)
        {
            close(&format!("u {u}, {place}"), *found, wanted, 1e-9);
        }
        close(
            "modulation",
            2.0 * (found[2] - found[0]) / (found[2] + found[0]),
            modulation,
            1e-9,
        );
    }
}

/// Analytic: beta/(2 u), beta^4 = u/(4 E I) (Hetenyi, Beams on Elastic Foundation, 1946); ties close together come to it
/// with the fourth power of their spacing.
#[test]
fn close_ties_come_to_a_bed_of_springs() {
    let u = 3000.0;
    let beta = 0.022_655_228_616_950_737_f64;
    close("beta", (u / (4.0 * E * I)).powf(0.25), beta, 1e-12);
    let mut errors = Vec::new();
    for spacing in [24.0, 12.0, 6.0] {
        let spec = on_ground("track", UNITS, &ties(spacing, u), [0.0, 1440.0]).expect("a track");
        let deflection = 3e4 * give(&spec, &[720.0])[0];
        errors.push((deflection / 0.113_276_143_084_753_69 - 1.0).abs());
    }
    println!("errors {errors:?}");
    assert!(
        errors[2] < 1e-5 && errors[0] / errors[1] > 12.0 && errors[1] / errors[2] > 12.0,
        "{errors:?}"
    );
    // External: the bed's deflection 24 in away, and where it first rises, 3 pi / (4 beta) away.
    let spec = on_ground("track", UNITS, &ties(6.0, u), [0.0, 1440.0]).expect("a track");
    let surface = solve(&spec)
        .expect("it stands")
        .surface
        .expect("it is small");
    let at = |x| Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    };
    let found = influence(
        &surface,
        &[at(720.0), at(744.0), at(720.0 + 104.002_238_513_251_21)],
    );
    close(
        "24 in away",
        found[(0, 1)],
        3.010_143_301_622_467_6e-6,
        1e-4,
    );
    assert!(
        found[(0, 2)].abs() < 1e-4 * found[(0, 0)],
        "{}",
        found[(0, 2)]
    );
}

/// Analytic: a rail on two ties is statically determinate: levers of the ties times the give of ties and girder, and
/// the rail's own bending between them.
#[test]
fn rail_on_two_ties_over_a_girder_is_the_sum_of_its_parts() {
    let girder = Girder {
        spans: vec![600.0],
        e: 29e6,
        i_vertical: 5000.0,
        i_lateral: Some(800.0),
        g: Some(11e6),
        j: Some(40.0),
        area: Some(60.0),
        rail_height: 15.0,
        theory: BeamTheory::EulerBernoulli,
        stations: vec![0.0, 300.0, 600.0],
        ..Girder::default()
    };
    let bare = Spec {
        name: "girder".to_owned(),
        units: UNITS,
        theory: BeamTheory::EulerBernoulli,
        form: Form::Girder(girder),
        effects: Vec::new(),
        notes: Vec::new(),
        incomplete: Vec::new(),
        outlines: Vec::new(),
        crane_rails: Vec::new(),
        preload: None,
    };
    let (first, spacing) = (100.0, 420.0);
    let mut given = Ties {
        first: Some(first),
        k: 5e4,
        ..ties(spacing, 1.0)
    };
    given.lateral_k = Some(2e4);
    given.rail.iy = 14.0;
    let spec = on_structure(&bare, &given).expect("two ties");
    let own = solve(&bare)
        .expect("it stands")
        .surface
        .expect("it is small");
    let both = solve(&spec)
        .expect("it stands")
        .surface
        .expect("it is small");
    for (axis, k, i) in [(Axis::Vertical, 5e4, I), (Axis::Lateral, 2e4, 14.0)] {
        let at = |x: f64| Probe { rail: 0, x, axis };
        let feet = influence(&own, &[at(first), at(first + spacing)]);
        for x in [100.0, 160.0, 310.0, 450.0, 520.0] {
            let found = influence(&both, &[at(x)])[(0, 0)];
            let r = (x - first) / spacing;
            let lever = [1.0 - r, r];
            let mut wanted = (lever[0] * lever[0] + lever[1] * lever[1]) / k;
            for a in 0..2 {
                for b in 0..2 {
                    wanted += lever[a] * feet[(a, b)] * lever[b];
                }
            }
            let (left, right) = (x - first, first + spacing - x);
            wanted += (left * right).powi(2) / (3.0 * E * i * spacing);
            close(&format!("{axis:?} at {x}"), found, wanted, 1e-10);
        }
    }
}

/// Runs a scene and its comparisons, `girder.json` beside it.
fn run(scene: &str, girder: &str) -> Vec<CaseResult> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.json");
    std::fs::write(&path, scene).expect("room for a scene");
    std::fs::write(folder.path().join("girder.json"), girder).expect("room for a spec");
    let document = Document::open(&path).expect("a sound scene");
    let known: Vec<SolvedStructure> = distinct_specs(&document)
        .into_iter()
        .map(|(_, _, spec)| SolvedStructure {
            spec: Arc::clone(spec),
            solution: Arc::new(solve(spec).expect("it stands")),
        })
        .collect();
    simulate(&document, &known, None, &|_| ()).expect("runs")
}

/// A cart over ties whose foundation is left to the program.
fn on_ties(structure: &str) -> CaseResult {
    let scene = format!(
        r#"{{"format": "girderway-scene/1", "units": {{"length": "in", "force": "lbf", "time": "s"}}, "gravity": 386.0886,
 "structures": {{"track": {{{structure}"foundation": "auto", "range": [0, 480],
   "ties": {{"spacing": 24, "k": 72000, "rail": {{"E": 30e6, "I_vertical": 94.9}}}}}}}},
 "bodies": {{"cart": {{"weight": 30000, "inertia": [0, 0, 1e5], "dof": ["y", "pitch"], "x0": 200}}}},
 "wheels": {{"tread": {{"radius": 18, "vertical": {{"k": 1e6}}}}}},
 "trucks": [{{"name": "cart", "body": "cart", "tree": [-30, 30], "wheel": "tread"}}],
 "motions": [{{"body": "cart", "dof": "x", "kind": "prescribed", "speed": [[0, 100]]}}],
 "end": {{"time": 0.1}}, "output": {{"dt": 0.02}}}}"#
    );
    run(&scene, GIRDER).swap_remove(0)
}

/// 480 in, with mass, below the ties.
const GIRDER: &str = r#"{"format": "girderway-beam/1", "units": {"length": "in", "force": "lbf", "time": "s"},
 "girder": {"spans": [480], "E": 30e6, "I_vertical": 20000, "mass_per_length": 0.05}, "stations": [0, 240, 480]}"#;

/// Ties without mass know no error of leaving it out; over a girder with mass `auto` compares its rungs.
#[test]
fn auto_on_ties_says_which_rung_and_why() {
    let choice = |outcome: &CaseResult| outcome.choices.first().expect("it chose").clone();
    let ground = choice(&on_ties(""));
    assert_eq!(
        (ground.fidelity, ground.reason),
        (Fidelity::Influence, Reason::NoMass),
        "{ground:?}"
    );
    let girder = choice(&on_ties(r#""spec": "girder.json", "#));
    println!("{ground:?}\n{girder:?}");
    assert_eq!(
        (girder.fidelity, girder.reason),
        (Fidelity::Influence, Reason::Sufficient),
        "{girder:?}"
    );
    assert!(
        girder.estimate.is_some_and(|estimate| estimate < 1e-2),
        "{girder:?}"
    );
}

/// The largest and smallest amplification of a load of 30,000 lb while it runs at `theta` of the critical speed.
fn amplification(theta: f64, spacing: f64, length: f64) -> [f64; 2] {
    let (u, critical) = (3000.0, 24_440.914_634_362);
    let mass = (4.0 * u * E * I).sqrt() / (critical * critical);
    // speeding up over so many periods of the bed leaves next to no waves behind
    let (speed, ramp) = (theta * critical, 0.227);
    let end = ramp + 0.02;
    let text = format!(
        r#"{{"format": "girderway-scene/1", "units": {{"length": "in", "force": "lbf", "time": "s"}}, "gravity": 3e10,
        "structures": {{"track": {{"foundation": "ties", "range": [0, {length}], "elements": 1, "modes": 100, "ties": {{
          "spacing": {spacing}, "k": {}, "rail": {{"E": {E}, "I_vertical": {I}, "mass_per_length": {mass}}}}}}}}},
        "bodies": {{"load": {{"mass": 1e-6, "dof": ["y"], "x0": 450}}}},
        "wheels": {{"stiff": {{"radius": 18, "vertical": {{"law": "linear", "k": 1e9}}}}}},
        "trucks": [{{"body": "load", "tree": [0], "wheel": "stiff"}}],
        "motions": [{{"body": "load", "dof": "x", "kind": "prescribed", "speed": [[0, 0], [{ramp}, {speed}]]}}],
        "end": {{"time": {end}}}, "output": {{"dt": 0.0005}}, "accuracy": 1e-5}}"#,
        u * spacing
    );
    let outcomes = run(&text, "{}");
    let record = &outcomes[0].columns;
    let held = record
        .values("time")
        .iter()
        .zip(record.values("load.deflection"))
        .filter(|(t, _)| **t >= ramp);
    let own = held.map(|(_, deflection)| (deflection - 3e4 / 1e9) / 0.113_276_143_084_753_69);
    own.fold([f64::INFINITY, 0.0], |[least, most], value| {
        [least.min(value), most.max(value)]
    })
}

/// Analytic: 1/sqrt(1 - theta^2) of a load that moves steadily along a beam on a bed of springs (Timoshenko 1926;
/// Fryba, Vibration of Solids and Structures under Moving Loads, 1972).
#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "slow: 100 modes over 20 periods of the bed"
)]
fn moving_load_meets_the_steady_amplification() {
    let wanted = 1.005_037_815_259_212;
    let [least, most] = amplification(0.1, 9.0, 2700.0);
    println!("{least} to {most} for {wanted}");
    // what the start leaves of waves, and the ripple of ties 9 in apart, swing about the mean
    assert!(
        (0.5 * (least + most) / wanted - 1.0).abs() < 1e-4 && most - least < 5e-4,
        "{least} to {most}"
    );
}

/// Identity: a stiff rail on three ties with dampers is one mass on one spring, damped by c/(2 sqrt(k m)) of critical;
/// over a stiff girder it is the same as over the ground.
#[test]
fn dampers_of_ties_under_a_stiff_rail_are_a_share_of_critical() {
    let (k, c, mass) = (1000.0, 2.0, 0.5);
    let share = c / (2.0 * f64::sqrt(k * mass));
    let scene = format!(
        r#"{{"format": "girderway-scene/1", "units": {{"length": "in", "force": "lbf", "time": "s"}}, "gravity": 386,
        "structures": {{"track": {{"foundation": "ties", "range": [0, 48], "elements": 1, "ties": {{
          "spacing": 24, "k": {k}, "c": {c}, "mass": {mass}, "rail": {{"E": 30e6, "I_vertical": 1e7}}}}}}}},
        "bodies": {{"load": {{"mass": 1, "dof": ["y"], "x0": 24, "start": {{"y": 0.3}}}}}},
        "wheels": {{"soft": {{"radius": 18, "vertical": {{"law": "linear", "k": 2000}}}}}},
        "trucks": [{{"body": "load", "tree": [0], "wheel": "soft"}}],
        "end": {{"time": 0.5}}, "output": {{"dt": 0.005}}, "accuracy": 1e-7,
        "compare": [
          {{"label": "share", "structures": {{"track": {{"damping": {share}, "ties": {{"c": null}}}}}}}},
          {{"label": "girder", "structures": {{"track": {{"spec": "girder.json", "range": null}}}}}},
          {{"label": "undamped", "structures": {{"track": {{"ties": {{"c": null}}}}}}}}]}}"#
    );
    let girder = r#"{"format": "girderway-beam/1", "units": {"length": "in", "force": "lbf", "time": "s"},
        "theory": "euler-bernoulli", "girder": {"spans": [48], "E": 30e6, "I_vertical": 1e7}, "stations": [0, 24, 48]}"#;
    let outcomes = run(&scene, girder);
    let apart = |index: usize| {
        let [own, other] = [0, index].map(|k| outcomes[k].columns.values("load.deflection"));
        own.iter()
            .zip(other)
            .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()))
    };
    println!(
        "share {:e}, girder {:e}, undamped {:e}",
        apart(1),
        apart(2),
        apart(3)
    );
    assert!(apart(1) < 1e-5 && apart(2) < 1e-5 && apart(3) > 1e-2);
    for outcome in &outcomes {
        assert!(
            outcome.run.audit.residual() < 1e-6,
            "energy of {}",
            outcome.label
        );
    }
}
