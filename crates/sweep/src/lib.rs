//! Many runs of one scene or design with other values of its axes.
//!
//! A [`formats::sweep::Sweep`] names the axes. A [`RunPlan`] has the values of every run, which depend on the sweep
//! alone. A [`Runner`] puts them into the files, runs the scene or design, and returns the results by name. The rows of
//! all runs make a [`ResultTable`], of which the statistics follow: distributions ([`ResultDistribution`]), governing
//! runs, and the sensitivity of each result to each axis ([`sensitivities`]).
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use formats::sweep::Sweep;
//! use sweep::{ResultTable, RunPlan, RunRecord, Runner};
//!
//! let folder = tempfile::tempdir().expect("a temporary folder");
//! let file = folder.path().join("sweep.json");
//! let scene = std::fs::canonicalize("../../examples/yang_yau/scene.json").expect("an example");
//! let text = format!(
//!     r#"{{"format": "girderway-sweep/1", "scene": {scene:?}, "axes": {{"/motions/0/speed/0/1": [20, 25]}},
//!      "sampling": "grid", "results": ["girder.midspan"]}}"#
//! );
//! std::fs::write(&file, text).expect("writable");
//! let (sweep, _) = Sweep::open(&file).expect("a sweep without faults");
//!
//! let plan = RunPlan::new(&sweep);
//! let runner = Runner::new(&sweep);
//! let go_on = || ControlFlow::Continue(());
//! let record = |run| {
//!     let axes = plan.values(run);
//!     let outcome = runner.run(&axes, &go_on).expect("nobody stops it");
//!     RunRecord { run, axes, outcome }
//! };
//! let table = ResultTable::new(sweep.pointers(), (1..=plan.runs()).map(record));
//! assert_eq!(table.columns, ["girder.midspan.max", "girder.midspan.min"]);
//! assert_eq!(table.runs, [1, 2]);
//! ```
//!
//! Wings, lowest first: points, plan, outcome, info, values, runner, records, axis_column, table, statistics, sensitivity, summary, columns_file
//!
//! 1. `points`, `plan`: points of the unit hypercube; the values of the axes in each run;
//! 2. `outcome`, `info`, `values`, `runner`: what a run gives; what a sweep is; results by name; one run;
//! 3. `records`, `axis_column`, `table`: runs as lines of text; the values of an axis and the results of all runs;
//! 4. `statistics`, `sensitivity`, `summary`: what follows from the table;
//! 5. `columns_file`: the table as a Parquet file.

mod axis_column;
#[cfg(feature = "parquet")]
mod columns_file;
mod info;
mod outcome;
mod plan;
mod points;
mod records;
mod runner;
mod sensitivity;
mod statistics;
mod summary;
mod table;
mod values;

pub use axis_column::AxisColumn;
#[cfg(feature = "parquet")]
pub use columns_file::write_parquet;
pub use info::SweepInfo;
pub use outcome::{RunFailure, RunOutcome, RunRow};
pub use plan::RunPlan;
pub use records::{RecordLines, RecordReader, RunRecord};
pub use runner::{GoOn, Runner};
pub use sensitivity::{Sensitivity, sensitivities};
pub use statistics::{Interval, QUANTILES, ResultDistribution};
pub use summary::summary;
pub use table::{ResultTable, TableBuilder};
