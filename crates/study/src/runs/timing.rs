//! Times of all settings of a study.

use std::ops::ControlFlow;

use crate::measure::cpu;
use crate::measure::spread::TimeSpread;
use crate::observer::Observer;
use crate::runs::auto::{Auto, choose, left_to_auto};
use crate::runs::point::{PointOutcome, StudyPoint};
use crate::runs::setup::TimedCase;
use crate::settings::budget::StudyBudget;
use formats::scene::Scene;
use foundations::SolvedStructure;

/// Duration, s, below which several runs are timed together.
const BATCH: f64 = 2e-3;
/// Largest number of runs timed together.
const LARGEST_BATCH: f64 = 200.0;

/// Times all settings that ran to their ends, and the choice of foundations by "auto".
///
/// Every repetition runs all settings once, and each repetition starts with another setting, so that other work of
/// the machine affects all settings alike. Runs shorter than [`BATCH`] are timed several at once. A setting is not
/// repeated once its repetitions have taken `budget.repetition_limit` seconds; the first run of a setting that takes
/// longer alone is its only time.
pub fn time(
    points: &mut [StudyPoint],
    auto: &mut Result<Auto, String>,
    cases: &[TimedCase],
    scene: &Scene,
    known: &[SolvedStructure],
    budget: &StudyBudget,
    observer: &dyn Observer,
) {
    let bar = observer.begin("timing", budget.repetitions as u64);
    let mut times: Vec<Vec<f64>> = cases.iter().map(|_| Vec::new()).collect();
    let mut trials = Vec::new();
    for repetition in 0..budget.repetitions {
        for k in 0..cases.len() {
            let index = (k + repetition * cases.len() / budget.repetitions) % cases.len();
            let Some((case, first)) = &cases[index] else {
                continue;
            };
            if (repetition + 1) as f64 * first > budget.repetition_limit {
                if repetition == 0 {
                    times[index].push(*first);
                }
                continue;
            }
            let batch = (BATCH / first.max(1e-9)).ceil().clamp(1.0, LARGEST_BATCH);
            let start = cpu::seconds();
            for _ in 0..batch as usize {
                let _ = std::hint::black_box(case.run(&mut |_| ControlFlow::Continue(())));
            }
            times[index].push((cpu::seconds() - start) / batch);
        }
        let spent: f64 = trials.iter().sum();
        if auto.is_ok() && (repetition == 0 || spent <= budget.repetition_limit) {
            let mut again = left_to_auto(scene);
            let start = cpu::seconds();
            if choose(&mut again, known, f64::INFINITY).is_ok() {
                trials.push(cpu::seconds() - start);
            }
        }
        bar.advance_to(repetition as u64 + 1);
    }
    for (point, times) in points.iter_mut().zip(&times) {
        if let PointOutcome::Done(measured) = &mut point.outcome {
            measured.time = TimeSpread::of(times);
        }
    }
    if let Ok(auto) = auto {
        auto.trials = TimeSpread::of(&trials);
    }
}
