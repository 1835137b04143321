//! The paper's girder, from its numbers to the grid of its unit loads: times and coefficients for a comparison.
//!
//! `cargo run --release -p girderway-fea --example girder` prints a line with the least, median and largest milliseconds of thread time,
//! then 61 lines of 61 coefficients, ft/lb: row of the displacement, column of the load, both at -15, -13.5, ..., 75 ft.
//! `fea/bench_peers.py` calls it.

#![allow(
    clippy::print_stdout,
    reason = "the figures are what the example is for"
)]

use fea::{Girder, grid};
use rustix::time::{ClockId, clock_gettime};
use splines::{Axis, Probe};

const LOADS: usize = 61;
const REPETITIONS: usize = 51;

fn main() -> Result<(), fea::Error> {
    let at: Vec<Probe> = (0..LOADS)
        .map(|k| Probe {
            rail: 0,
            x: -15.0 + 90.0 * k as f64 / (LOADS - 1) as f64,
            axis: Axis::Vertical,
        })
        .collect();
    let mut times = Vec::with_capacity(REPETITIONS);
    let mut found = None;
    for _ in 0..REPETITIONS {
        let began = clock();
        let (model, rail) = girder().model_and_rail()?;
        let grid = grid(&model, &[rail], &at)?;
        times.push(clock() - began);
        found = Some(grid);
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{},{},{}",
        times[0],
        times[REPETITIONS / 2],
        times[REPETITIONS - 1]
    );
    for row in found.iter().flat_map(|grid| grid.value.row_iter()) {
        let row: Vec<String> = row.iter().map(|value| format!("{value:e}")).collect();
        println!("{}", row.join(","));
    }
    Ok(())
}

/// Time of this thread in milliseconds: other jobs of the machine do not count.
fn clock() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    1e3 * now.tv_sec as f64 + 1e-6 * now.tv_nsec as f64
}

/// Sixty feet between two supports, overhangs of fifteen.
fn girder() -> Girder {
    Girder {
        spans: vec![60.0],
        overhangs: [15.0; 2],
        e: 4.32e9,
        i_vertical: 9.528,
        ..Girder::default()
    }
}
