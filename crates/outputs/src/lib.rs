//! Output folders: the files of runs and designs, each whole or absent, and what may replace them.
//!
//! An [`folder::OutputFolder`] is locked while results are made, keeps them in memory, and writes them together, with a
//! [`manifest::Manifest`] of inputs, settings and hashes as the last file. [`run_files`] and [`design_files`] are the
//! files of a run and of a design, [`planned`] those that are known before the work.
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use formats::scene::SceneSource;
//! use foundations::StructureCache;
//! use results::cases::RunOptions;
//! use outputs::clock::StageClock;
//! use outputs::run_files::save_run;
//! use results::scene_run::SceneRun;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let bogie = SceneSource::open("../../examples/bogie/scene.json".as_ref()).expect("an example is right");
//! let document = bogie.document(None, false).expect("an example is right");
//! let run = SceneRun::of(document, &StructureCache::default(), RunOptions::default(), &|_| ControlFlow::Continue(()))?;
//!
//! let folder = std::env::temp_dir().join(format!("girderway-outputs-{}", std::process::id()));
//! save_run(&run, &folder, false, None, StageClock::new())?;
//! assert!(folder.join("report.html").exists() && folder.join("manifest.json").exists());
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok(())
//! # }
//! ```
//!
//! Wings, lowest first: error, clock, hashed, manifest, files, journal, folder, planned, run_files, design_files, sweep_rows,
//! shard, sweep_files

pub mod clock;
pub mod design_files;
mod error;
pub mod files;
pub mod folder;
mod hashed;
pub mod journal;
pub mod manifest;
pub mod planned;
pub mod run_files;
pub mod shard;
pub mod sweep_files;
mod sweep_rows;

pub use error::Error;
