//! Errors of a cross-check.

use formats::grid::block::GridBlock;
use std::path::PathBuf;

/// Why two codes were not compared.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The girder has no span.
    #[error("the girder has no span")]
    NoSpan,
    /// A span is not a positive number, or an overhang is negative or not a number.
    #[error("length {0} of the girder (overhang or span) is invalid")]
    Length(usize),
    /// A stiffness is not a positive number, or the rail height is not a number.
    #[error("{0} of the girder is invalid")]
    Stiffness(&'static str),
    /// Stations must increase and lie on the girder.
    #[error("station {0} does not increase or does not lie on the girder")]
    Station(usize),
    /// A grid has another size than stations x stations.
    #[error("the {quantity} grid is not {stations} x {stations}")]
    Shape {
        /// The grid.
        quantity: GridBlock,
        /// Number of stations.
        stations: usize,
    },
    /// A grid holds a number that is not finite.
    #[error("entry {row}, {column} of the {quantity} grid is not finite")]
    NotFinite {
        /// The grid.
        quantity: GridBlock,
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
    },
    /// Neither a cache directory nor a home directory is known.
    #[error("no folder for the Python environment: set XDG_CACHE_HOME or HOME")]
    NoCache,
    /// Python is missing or cannot be started.
    #[error(
        "cannot start {program}: {source}; the cross-check needs Python 3.11 or newer with venv and pip"
    )]
    NoPython {
        /// What was started.
        program: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// Python is older than the pinned packages allow.
    #[error("{program} is Python {found}; the cross-check needs 3.11 or newer")]
    OldPython {
        /// What was started.
        program: PathBuf,
        /// Its version.
        found: String,
    },
    /// The environment could not be made.
    #[error(
        "cannot {step} (on Debian: apt-get install python3-venv; packages come from PyPI)\n{output}"
    )]
    Environment {
        /// What was tried.
        step: &'static str,
        /// Last lines of what it wrote.
        output: String,
    },
    /// pip cannot reach its index of packages.
    #[error(
        "cannot reach PyPI, which provides scikit-fem, OpenSees, PyNite and gmsh: connect this machine once, or set \
         PIP_INDEX_URL or PIP_FIND_LINKS to a copy of the packages{output}"
    )]
    Offline {
        /// What pip wrote beside that it found no package: a line break and its last lines, or nothing.
        output: String,
    },
    /// The script failed.
    #[error("the model in {code} failed\n{output}")]
    Script {
        /// Which code.
        code: &'static str,
        /// Last lines of what it wrote.
        output: String,
    },
    /// The answer of the script has an unexpected form.
    #[error("cannot read the output of the {code} model: {source}")]
    Answer {
        /// Which code.
        code: &'static str,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// The script does not solve such a structure, or cannot load its code.
    #[error("{0}")]
    Refused(String),
    /// The script speaks of stations that are not there.
    #[error("the {code} model returned stations that are not in the spec")]
    Stations {
        /// Which code.
        code: &'static str,
    },
    /// A file of the environment could not be written or read.
    #[error("{path}: {source}")]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}
