//! The bridge crane's event of 45 s on one core: processor time of a run, rigid and flexible.
//!
//! `cargo bench -p girderway --bench crane -- --accuracy 1e-4 --runs 5`; with `--against 1e-7` also the largest error of displacements,
//! vertical and lateral wheel forces beside a run of that accuracy, each relative to its largest value.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use formats::scene::motion::simulation_input;
use formats::scene::{Case, Document};
use foundations::{ModeCache, build, solve};
use foundations::{SolvedStructure, distinct_specs, solution_of};
use sim::{BodyDof, Channel, Run};
use study::measure::cpu::seconds;

/// What the command line asks for.
struct Wanted {
    scene: PathBuf,
    accuracy: Option<f64>,
    against: Option<f64>,
    runs: usize,
}

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

#[expect(clippy::print_stdout, reason = "a benchmark prints")]
fn main() -> Outcome<()> {
    let wanted = wanted()?;
    let document = Document::open(&wanted.scene).map_err(|_| "the scene cannot be read")?;
    let mut known = Vec::new();
    for (_, _, spec) in distinct_specs(&document) {
        known.push(SolvedStructure {
            spec: spec.clone(),
            solution: solve(spec)?.into(),
        });
    }
    print!(
        "{:12} {:>9} {:>10} {:>9} {:>7} {:>7} {:>7} {:>9} {:>9} {:>9}",
        "run",
        "accuracy",
        "fastest_ms",
        "median_ms",
        "samples",
        "steps",
        "stages",
        "rejected",
        "us/stage",
        "residual"
    );
    println!(
        "{}",
        if wanted.against.is_some() {
            " displaced  vertical   lateral"
        } else {
            ""
        }
    );
    for case in &document.cases {
        time(case, &known, &wanted)?;
    }
    Ok(())
}

fn wanted() -> Outcome<Wanted> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bridge_crane/scene.json");
    let mut wanted = Wanted {
        scene,
        accuracy: None,
        against: None,
        runs: 5,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--accuracy" => wanted.accuracy = Some(words.next().ok_or("which accuracy?")?.parse()?),
            "--against" => wanted.against = Some(words.next().ok_or("which accuracy?")?.parse()?),
            "--runs" => wanted.runs = words.next().ok_or("how many runs?")?.parse()?,
            "--scene" => wanted.scene = words.next().ok_or("which scene?")?.into(),
            // what cargo adds, and what its other benchmarks understand
            _ => {}
        }
    }
    Ok(wanted)
}

/// Processor times of some runs of a case.
#[expect(clippy::print_stdout, reason = "a benchmark prints")]
fn time(case: &Case, known: &[SolvedStructure], wanted: &Wanted) -> Outcome<()> {
    let given = &case.scene;
    let mut scene = simulation_input(given)
        .map_err(|_| "the scene cannot be set up")?
        .scene;
    scene.accuracy = wanted.accuracy.unwrap_or(scene.accuracy);
    let mut foundations = Vec::new();
    for structure in &given.structures {
        let solved = solution_of(known, &structure.origin);
        let laid = build(
            &mut ModeCache::default(),
            structure,
            solved,
            given.has_flanges(),
        );
        foundations.push(laid.map_err(|_| "a foundation cannot be made")?.foundation);
    }
    let mut times = Vec::new();
    let mut last = None;
    for _ in 0..wanted.runs.max(1) {
        let start = seconds();
        let run = sim::run(&scene, &foundations, &mut |_| ControlFlow::Continue(()))?;
        times.push(seconds() - start);
        last = Some(run);
    }
    let Some(run) = last else { return Ok(()) };
    times.sort_by(f64::total_cmp);
    let (least, median) = (times[0], times[times.len() / 2]);
    let errors = match wanted.against {
        Some(accuracy) => {
            let finer = sim::Scene {
                accuracy,
                ..scene.clone()
            };
            let exact = sim::run(&finer, &foundations, &mut |_| ControlFlow::Continue(()))?;
            errors(&run, &exact, scene.bodies.len())
                .map(|error| format!(" {error:9.1e}"))
                .concat()
        }
        None => String::new(),
    };
    println!(
        "{:12} {:9.0e} {:10.1} {:9.1} {:7} {:7} {:7} {:9} {:9.2} {:9.1e}{errors}",
        case.label.as_deref().unwrap_or("scene"),
        scene.accuracy,
        1e3 * least,
        1e3 * median,
        times.len(),
        run.counts.steps,
        run.counts.stages,
        run.counts.rejected,
        1e6 * least / run.counts.stages as f64,
        run.audit.residual(),
    );
    Ok(())
}

/// Largest differences beside the largest values: displacements y of the bodies, vertical and lateral forces of the wheels.
fn errors(run: &Run, exact: &Run, bodies: usize) -> [f64; 3] {
    let wheels = exact
        .history
        .channels()
        .iter()
        .filter(|c| matches!(c, Channel::Vertical(_)))
        .count();
    let apart = |channels: &mut dyn Iterator<Item = Channel>| {
        let (mut most, mut largest) = (0.0_f64, 0.0_f64);
        for channel in channels {
            for (a, b) in run
                .history
                .column(channel)
                .iter()
                .zip(exact.history.column(channel))
            {
                (most, largest) = (most.max((a - b).abs()), largest.max(b.abs()));
            }
        }
        most / largest
    };
    [
        apart(&mut (0..bodies).map(|b| Channel::Displacement(b, BodyDof::Y))),
        apart(&mut (0..wheels).map(Channel::Vertical)),
        apart(&mut (0..wheels).map(Channel::Lateral)),
    ]
}
