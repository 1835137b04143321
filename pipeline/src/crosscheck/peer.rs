//! The other codes and their execution.

use super::environment::{Environment, tail};
use super::error::Error;
use fea::BeamTheory;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Names and contents of the scripts, some of which import others.
const SCRIPTS: [(&str, &str); 5] = [
    (
        "scikit_fem_girder.py",
        include_str!("../../../fea/scikit_fem_girder.py"),
    ),
    ("gmsh_solid.py", include_str!("../../../fea/gmsh_solid.py")),
    (
        "frame_model.py",
        include_str!("../../../fea/frame_model.py"),
    ),
    (
        "opensees_frame.py",
        include_str!("../../../fea/opensees_frame.py"),
    ),
    (
        "pynite_frame.py",
        include_str!("../../../fea/pynite_frame.py"),
    ),
];

/// Square matrix of influence coefficients, as the other codes return them; rows are deflections, columns are loads.
pub type PlainGrid = Vec<Vec<f64>>;

/// Index of the rail and coordinate of a station.
pub type Station = (usize, f64);

/// An independent code that solves the same structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peer {
    /// Beam elements of scikit-fem, for straight girders only.
    ScikitFem,
    /// Frames of OpenSees, with both beam theories.
    OpenSees,
    /// Frames of PyNite, without shear deformation.
    PyNite,
    /// A solid meshed by gmsh and solved by scikit-fem, for straight girders of rectangular section only.
    Solid,
}

/// Scale relative to which a difference is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PeerMeasure {
    /// The largest entry of the grid; for a coupling block, the geometric mean of those of its two direct grids.
    Largest,
    /// sqrt(G_ii G_jj) of the direct grids, at least [`FLOOR`] times its largest value.
    Diagonal,
}

/// Lower bound of the scale under [`PeerMeasure::Diagonal`], relative to its largest value. It is needed because the
/// coefficients vanish at supports.
pub const FLOOR: f64 = 1e-3;

impl Peer {
    /// All codes in the order of their execution.
    pub const ALL: [Peer; 4] = [Peer::ScikitFem, Peer::OpenSees, Peer::PyNite, Peer::Solid];

    /// Name in messages and file names.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Peer::ScikitFem => "scikit-fem",
            Peer::OpenSees => "OpenSees",
            Peer::PyNite => "PyNite",
            Peer::Solid => "gmsh",
        }
    }

    /// Whether the code solves the short form of a spec only.
    #[must_use]
    pub const fn straight(self) -> bool {
        matches!(self, Peer::ScikitFem | Peer::Solid)
    }

    /// Beam theory of the comparison for a spec with the beam theory `theory`.
    #[must_use]
    pub const fn theory(self, theory: BeamTheory) -> BeamTheory {
        match self {
            Peer::ScikitFem | Peer::OpenSees => theory,
            Peer::PyNite => BeamTheory::EulerBernoulli,
            Peer::Solid => BeamTheory::Timoshenko,
        }
    }

    /// Largest difference that counts as agreement, unless the answer of the script contains one.
    #[must_use]
    pub const fn tolerance(self) -> f64 {
        match self {
            Peer::ScikitFem => 1e-9,
            Peer::OpenSees | Peer::PyNite => 2e-7,
            Peer::Solid => 1e-3,
        }
    }

    /// Whether it compares structures about the state of a preload.
    #[must_use]
    pub const fn takes_preload(self) -> bool {
        matches!(self, Peer::OpenSees | Peer::PyNite)
    }

    /// Scale relative to which its differences are measured.
    #[must_use]
    pub const fn measure(self) -> PeerMeasure {
        match self {
            Peer::ScikitFem | Peer::Solid => PeerMeasure::Largest,
            Peer::OpenSees | Peer::PyNite => PeerMeasure::Diagonal,
        }
    }

    const fn script(self) -> &'static str {
        match self {
            Peer::ScikitFem => "scikit_fem_girder.py",
            Peer::OpenSees => "opensees_frame.py",
            Peer::PyNite => "pynite_frame.py",
            Peer::Solid => "gmsh_solid.py",
        }
    }

    /// Runs the script of the code: `question` is written to it as JSON, and its JSON answer is returned.
    ///
    /// # Errors
    /// Python, its environment or the script fails; [`Error::Refused`] if the code does not solve the structure.
    pub fn ask(
        self,
        question: &impl Serialize,
        environment: &Environment,
        say: &mut dyn FnMut(&str),
    ) -> Result<PeerAnswer, Error> {
        let python = environment.prepare(say)?;
        let file = |path: &Path| {
            let path = path.to_owned();
            move |source| Error::File { path, source }
        };
        let folder = tempfile::tempdir().map_err(file(&std::env::temp_dir()))?;
        for (name, text) in SCRIPTS {
            let path = folder.path().join(name);
            std::fs::write(&path, text).map_err(file(&path))?;
        }
        let missing = |source| Error::NoPython {
            program: python.clone(),
            source,
        };
        let mut child = Command::new(&python)
            .args(["-E", "-s", "-B"])
            .arg(folder.path().join(self.script()))
            // The systems are small, and with one thread the order of summation is reproducible.
            .envs(
                ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"]
                    .map(|name| (name, "1")),
            )
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(missing)?;
        let answer = |source| Error::Answer {
            code: self.name(),
            source,
        };
        let question = serde_json::to_vec(question).map_err(answer)?;
        // The script reads all input before it writes; a script that ends early is detected by its exit status.
        let written = child.stdin.take().map(|mut pipe| pipe.write_all(&question));
        let output = child.wait_with_output().map_err(missing)?;
        if !output.status.success() || !matches!(written, Some(Ok(()))) {
            return Err(Error::Script {
                code: self.name(),
                output: tail(&output),
            });
        }
        let reply: PeerAnswer = serde_json::from_slice(&output.stdout).map_err(answer)?;
        match reply.refused {
            Some(why) => Err(Error::Refused(why)),
            None => Ok(reply),
        }
    }
}

/// Answer of a script.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct PeerAnswer {
    /// Reason why the code does not solve the structure.
    pub refused: Option<String>,
    /// Versions by package.
    pub versions: BTreeMap<String, String>,
    /// Finite elements used.
    pub elements: String,
    /// Indices of the stations of the grids among those of the spec; `None` means all stations.
    pub stations: Option<Vec<usize>>,
    /// Grids by name; `None` if a stiffness is unknown.
    pub influence: BTreeMap<String, Option<PlainGrid>>,
    /// Notes on the answer.
    pub notes: Vec<String>,
    /// Largest difference that the modelling of the code explains.
    pub tolerance: Option<f64>,
    /// The same for single grids, by name.
    pub tolerances: BTreeMap<String, f64>,
}
