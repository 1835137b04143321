//! The other codes, and the call of one of them.

use super::environment::{Environment, tail};
use super::error::Error;
use super::grid::PlainGrid;
use fea::BeamTheory;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Scripts by file name; some import others.
const SCRIPTS: [(&str, &str); 5] = [
    ("scikit_fem_girder.py", include_str!("../../../fea/scikit_fem_girder.py")),
    ("gmsh_solid.py", include_str!("../../../fea/gmsh_solid.py")),
    ("frame_model.py", include_str!("../../../fea/frame_model.py")),
    ("opensees_frame.py", include_str!("../../../fea/opensees_frame.py")),
    ("pynite_frame.py", include_str!("../../../fea/pynite_frame.py")),
];

/// An independent code that solves the same structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peer {
    /// Beam elements of scikit-fem; straight girders.
    ScikitFem,
    /// Frames of OpenSees, both theories.
    OpenSees,
    /// Frames of PyNite, without shear deformation.
    PyNite,
    /// A solid meshed by gmsh, solved by scikit-fem; straight girders of rectangular section.
    Solid,
}

/// What a difference is measured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PeerMeasure {
    /// The largest entry of the grid; for a coupling the geometric mean of those of its two direct grids.
    Largest,
    /// sqrt(G_ii G_jj) of the direct grids, at least [`FLOOR`] of its largest value.
    Diagonal,
}

/// Least measure by its largest value under [`PeerMeasure::Diagonal`]: at supports the coefficients vanish.
pub const FLOOR: f64 = 1e-3;

impl Peer {
    /// All codes, in the order in which they run.
    pub const ALL: [Peer; 4] = [Peer::ScikitFem, Peer::OpenSees, Peer::PyNite, Peer::Solid];

    /// Its name for people and files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Peer::ScikitFem => "scikit-fem",
            Peer::OpenSees => "OpenSees",
            Peer::PyNite => "PyNite",
            Peer::Solid => "gmsh",
        }
    }

    /// Whether it solves the short form of a spec alone.
    #[must_use]
    pub const fn straight(self) -> bool {
        matches!(self, Peer::ScikitFem | Peer::Solid)
    }

    /// The theory under which both sides are compared, for a spec under `theory`.
    #[must_use]
    pub const fn theory(self, theory: BeamTheory) -> BeamTheory {
        match self {
            Peer::ScikitFem | Peer::OpenSees => theory,
            Peer::PyNite => BeamTheory::EulerBernoulli,
            Peer::Solid => BeamTheory::Timoshenko,
        }
    }

    /// Largest difference that counts as agreement, where the answer states none.
    #[must_use]
    pub const fn tolerance(self) -> f64 {
        match self {
            Peer::ScikitFem => 1e-9,
            Peer::OpenSees | Peer::PyNite => 2e-7,
            Peer::Solid => 1e-3,
        }
    }

    /// What its differences are measured by.
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

    /// Asks the code: one JSON value in, its answer out.
    ///
    /// # Errors
    /// Python, its environment or the script fails; [`Error::Refused`] where the code does not solve the structure.
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
        let missing = |source| Error::NoPython { program: python.clone(), source };
        let mut child = Command::new(&python)
            .args(["-E", "-s", "-B"])
            .arg(folder.path().join(self.script()))
            // One thread: the systems are small, and the sums keep their order.
            .envs(["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"].map(|name| (name, "1")))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(missing)?;
        let answer = |source| Error::Answer { code: self.name(), source };
        let question = serde_json::to_vec(question).map_err(answer)?;
        // The script reads all before it writes; a script that died early is reported by its exit status.
        let written = child.stdin.take().map(|mut pipe| pipe.write_all(&question));
        let output = child.wait_with_output().map_err(missing)?;
        if !output.status.success() || !matches!(written, Some(Ok(()))) {
            return Err(Error::Script { code: self.name(), output: tail(&output) });
        }
        let reply: PeerAnswer = serde_json::from_slice(&output.stdout).map_err(answer)?;
        match reply.refused {
            Some(why) => Err(Error::Refused(why)),
            None => Ok(reply),
        }
    }
}

/// What a script answers.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct PeerAnswer {
    /// Why there is no answer.
    pub refused: Option<String>,
    /// Versions by package.
    pub versions: BTreeMap<String, String>,
    /// Finite elements used.
    pub elements: String,
    /// Stations of the grids among those of the spec; all where absent.
    pub stations: Option<Vec<usize>>,
    /// Grids by name; absent where a stiffness is unknown.
    pub influence: BTreeMap<String, Option<PlainGrid>>,
    /// What a reader should know.
    pub notes: Vec<String>,
    /// Largest difference that the code's own modelling explains.
    pub tolerance: Option<f64>,
}
