//! What "auto" chooses for random crossings, judged by the finite-element mesh whole.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod duty;

use std::ops::ControlFlow;
use std::time::Instant;

use duty::{Duty, duty};
use foundations::{Error, ModeCache, excited_modes, foundation_at};
use sim::{Choice, Fidelity, Foundation, FoundationProvider, Reason, Run, Scene, choose, distance};

/// What the rules of the selector were fitted to, and what they were not.
const FITTED: u64 = 0;
const HELD_OUT: u64 = 1;

/// Scenes of every kind that are soon run.
const QUICK: [u64; 12] = [1, 2, 3, 4, 11, 12, 15, 16, 22, 25, 30, 33];

const RUNGS: [Fidelity; 9] = [
    Fidelity::Rigid,
    Fidelity::Influence,
    Fidelity::Modal(2),
    Fidelity::Modal(4),
    Fidelity::Modal(6),
    Fidelity::Modal(8),
    Fidelity::Modal(12),
    Fidelity::Modal(16),
    Fidelity::Full,
];

struct Rungs<'a>(&'a Duty, ModeCache);

impl FoundationProvider for Rungs<'_> {
    type Error = Error;

    fn modes(&mut self, _: usize, count: usize) -> Result<Option<sim::Structure>, Error> {
        excited_modes(&self.0.solved, count)
    }

    fn foundation(&mut self, _: usize, rung: Fidelity) -> Result<Foundation, Error> {
        foundation_at(&mut self.1, &self.0.solved, rung, self.0.damping, 1)
    }
}

fn run(scene: &Scene, foundation: Foundation) -> Run {
    sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene")
}

/// Rigid, influence, modal, full.
fn class(rung: Fidelity) -> usize {
    match rung {
        Fidelity::Rigid => 0,
        Fidelity::Influence => 1,
        Fidelity::Modal(_) => 2,
        Fidelity::Half | Fidelity::Full => 3,
    }
}

/// A choice, judged.
struct Verdict {
    tolerance: f64,
    choice: Choice,
    /// Of the choice.
    own: f64,
    cheapest: Fidelity,
    /// Of the mesh whole, by one with twice as many elements, on a sample.
    mesh: Option<f64>,
    /// Runs made, and time by that of the chosen rung alone.
    runs: usize,
    cost: f64,
}

fn judge(seed: u64, index: u64) -> Verdict {
    let duty = duty(seed, index);
    // the caches are warm
    foundation_at(&mut ModeCache::default(), &duty.solved, Fidelity::Influence, 0.0, 1).expect("a surface");
    let mut scene = duty.scene.clone();
    let start = Instant::now();
    let mut rungs = Rungs(&duty, ModeCache::default());
    let selection =
        choose(&duty.scene, &[Some(duty.tolerance)], &mut rungs, &mut |_| ControlFlow::Continue(()))
            .expect("a valid scene");
    let taken = start.elapsed().as_secs_f64();
    let choice = selection.choices[0].clone();
    scene.accuracy = 0.03 * duty.tolerance;
    let start = Instant::now();
    let alone = foundation_at(&mut ModeCache::default(), &duty.solved, choice.fidelity, duty.damping, 1);
    run(&scene, alone.expect("it has mass"));
    let spent = start.elapsed().as_secs_f64();
    let cost = taken / spent;
    let start = Instant::now();
    assert!(excited_modes(&duty.solved, 3).is_ok_and(|modes| modes.is_some()));
    let modes = start.elapsed().as_secs_f64();

    let mut of = |rung, finer| {
        foundation_at(&mut rungs.1, &duty.solved, rung, duty.damping, finer).expect("it has mass")
    };
    scene.accuracy = 3e-3 * duty.tolerance;
    let reference = run(&scene, of(Fidelity::Full, 1));
    let with_mesh = class(choice.fidelity) == 3 && index.is_multiple_of(3);
    let mesh = with_mesh.then(|| distance(&run(&scene, of(Fidelity::Full, 2)), &reference, &scene));
    scene.accuracy = 0.03 * duty.tolerance;
    let mut errors = Vec::new();
    let mut cheapest = Fidelity::Full;
    for rung in RUNGS {
        let error = distance(&run(&scene, of(rung, 1)), &reference, &scene);
        errors.push(error);
        if error <= duty.tolerance {
            cheapest = rung;
            break;
        }
    }
    let own = distance(&selection.run, &reference, &scene);
    let Duty { kind, tolerance, numbers: [alpha, mass, frequency], .. } = duty;
    let said: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
    let predicted = choice.predicted.as_ref().map(|predicted| {
        let all = predicted.errors.iter().map(|(_, error)| format!("{error:.1e}"));
        all.collect::<Vec<_>>().join(" ")
    });
    let runs = selection.runs;
    println!(
        "{seed}.{index} {kind:?} alpha {alpha:.3} mass {mass:.2} frequency {frequency:.2} tolerance {tolerance:.0e}: \
         cheapest {cheapest:?}, chosen {:?} ({:?}), error {own:.1e}, estimate {:?}, mesh {mesh:?}, runs {runs}, cost \
         {cost:.2} of {:.3} ms, three modes {:.3} ms; {}; predicted {}",
        choice.fidelity,
        choice.reason,
        choice.estimate,
        1e3 * spent,
        1e3 * modes,
        said.join(" "),
        predicted.unwrap_or_default(),
    );
    Verdict { tolerance, choice, own, cheapest, mesh, runs, cost }
}

fn judged(seed: u64, scenes: &[u64]) -> Vec<Verdict> {
    let half = |odd: u64| {
        let own = scenes.iter().filter(move |index| *index % 2 == odd);
        own.map(|index| judge(seed, *index)).collect::<Vec<_>>()
    };
    std::thread::scope(|scope| {
        let other = scope.spawn(|| half(1));
        let mut all = half(0);
        all.extend(other.join().expect("the other half"));
        all
    })
}

struct Shares {
    cheapest: [f64; 4],
    within: f64,
    near: f64,
    /// Largest by the tolerance where the choice is not doubted.
    mesh: f64,
    /// Of rungs skipped, those that do not suffice.
    skipped: f64,
    /// Of choices not known to be allowed, those that are not.
    silent: usize,
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or_default()
}

fn shares(verdicts: &[Verdict]) -> Shares {
    let share = |counted: &dyn Fn(&Verdict) -> bool| {
        verdicts.iter().filter(|verdict| counted(verdict)).count() as f64 / verdicts.len() as f64
    };
    let step = |rung: Fidelity| RUNGS.iter().position(|other| *other == rung);
    let skipped: Vec<bool> = verdicts
        .iter()
        .flat_map(|v| v.choice.skipped.iter().map(|&rung| step(rung) < step(v.cheapest)))
        .collect();
    let doubted = |v: &Verdict| matches!(v.choice.reason, Reason::Highest | Reason::Unchecked);
    let found = Shares {
        cheapest: std::array::from_fn(|k| share(&|verdict| class(verdict.cheapest) == k)),
        within: share(&|verdict| verdict.own <= verdict.tolerance),
        near: share(&|verdict| class(verdict.choice.fidelity) <= class(verdict.cheapest) + 1),
        mesh: verdicts
            .iter()
            .filter(|v| !doubted(v))
            .filter_map(|v| Some(v.mesh? / v.tolerance))
            .fold(0.0, f64::max),
        skipped: skipped.iter().filter(|wrong| **wrong).count() as f64 / skipped.len().max(1) as f64,
        silent: verdicts.iter().filter(|v| v.own > v.tolerance && !doubted(v)).count(),
    };
    let finely =
        share(&|verdict| step(verdict.choice.fidelity) <= step(verdict.cheapest).map(|step| step + 1));
    println!("cheapest (rows) by chosen: rigid, influence, modal, full");
    for row in 0..4 {
        let counts: [usize; 4] = std::array::from_fn(|column| {
            let is = |v: &&Verdict| class(v.cheapest) == row && class(v.choice.fidelity) == column;
            verdicts.iter().filter(is).count()
        });
        println!("{counts:?}");
    }
    let all = verdicts.iter().map(|v| v.runs).sum::<usize>();
    let taken = verdicts.iter().filter(|v| v.choice.reason == Reason::Predicted).count();
    println!(
        "{} scenes: cheapest rigid {:.3}, influence {:.3}, modal {:.3}, full {:.3}; within the tolerance {:.3}; at most \
         one rung above {:.3} (numbers of modes counted as rungs: {finely:.3}); mesh doubled by tolerance {:.3}; {all} runs; \
         {taken} taken by prediction; {} rungs skipped, {:.4} of them in vain; {} doubted; {} silently wrong; median cost {:.2}",
        verdicts.len(),
        found.cheapest[0],
        found.cheapest[1],
        found.cheapest[2],
        found.cheapest[3],
        found.within,
        found.near,
        found.mesh,
        skipped.len(),
        1.0 - found.skipped,
        verdicts.iter().filter(|v| doubted(v)).count(),
        found.silent,
        median(verdicts.iter().map(|v| v.cost).collect()),
    );
    for class in 0..4 {
        let own = verdicts.iter().filter(|v| self::class(v.choice.fidelity) == class);
        println!("median cost of class {class}: {:.2}", median(own.map(|v| v.cost).collect()));
    }
    found
}

/// External to the selector: every rung run and compared with the mesh whole.
#[test]
fn twelve_choices_are_within_their_tolerance_and_near_the_cheapest() {
    let found = shares(&judged(HELD_OUT, &QUICK));
    assert_eq!([found.within, found.near], [1.0, 1.0]);
}

fn holds(seed: u64) {
    let found = shares(&judged(seed, &(0..200).collect::<Vec<_>>()));
    assert!(found.cheapest.iter().all(|share| *share >= 0.15), "{:?}", found.cheapest);
    assert!(found.within >= 0.99, "{}", found.within);
    assert!(found.near >= 0.9, "{}", found.near);
    assert!(found.mesh <= 1.0, "{}", found.mesh);
    assert!(found.skipped >= 0.95, "{}", found.skipped);
}

#[test]
#[ignore = "slow: 200 scenes at nine rungs each"]
fn choices_keep_the_tolerance_in_99_percent_and_lie_one_rung_above_in_90() {
    holds(FITTED);
}

#[test]
#[ignore = "slow: 200 scenes at nine rungs each"]
fn so_do_choices_for_scenes_that_the_rules_were_not_fitted_to() {
    holds(HELD_OUT);
}
