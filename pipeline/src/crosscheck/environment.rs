//! The Python environment of the reference models.

use super::error::Error;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Packages with pinned versions.
pub const REQUIREMENTS: &str = include_str!("../../../fea/requirements.txt");
/// Oldest version of Python that the pinned packages support.
const OLDEST: [u32; 2] = [3, 11];
/// Name of the file that marks an environment as complete.
const MARK: &str = "complete";

/// Python interpreter and cache directory for the environment of the other codes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Environment {
    /// Interpreter that creates the environment.
    pub python: PathBuf,
    /// Directory that contains an environment for each set of requirements.
    pub cache: PathBuf,
}

impl Environment {
    /// Uses `python3` of the search path, and `$XDG_CACHE_HOME/girderway` or else `~/.cache/girderway` as cache.
    ///
    /// # Errors
    /// [`Error::NoCache`] if neither directory is known.
    pub fn of_user() -> Result<Self, Error> {
        let set = |name| std::env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
        let cache = set("XDG_CACHE_HOME").filter(|p| p.is_absolute());
        let cache = cache.or_else(|| set("HOME").map(|home| home.join(".cache")));
        Ok(Environment { python: "python3".into(), cache: cache.ok_or(Error::NoCache)?.join("girderway") })
    }

    /// Directory of the environment for the pinned requirements.
    pub fn folder(&self) -> PathBuf {
        let digest = Sha256::digest(REQUIREMENTS.as_bytes());
        let name: String = digest.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        self.cache.join(name)
    }

    /// Returns the interpreter of the environment. Creates a missing environment, with a message to `say`.
    ///
    /// The environment is created in a temporary directory and renamed when it is complete, so that interrupted or
    /// concurrent processes do not leave an incomplete one.
    ///
    /// # Errors
    /// Python is missing or too old, or the packages cannot be installed.
    pub fn prepare(&self, say: &mut dyn FnMut(&str)) -> Result<PathBuf, Error> {
        let folder = self.folder();
        if complete(&folder) {
            return Ok(program(&folder));
        }
        self.check_version()?;
        say(&format!(
            "making a Python environment with scikit-fem, gmsh, OpenSees and PyNite in {} (once, about 650 MB)",
            folder.display()
        ));
        let file = |path: &Path| {
            let path = path.to_owned();
            move |source| Error::File { path, source }
        };
        fs::create_dir_all(&self.cache).map_err(file(&self.cache))?;
        let place =
            tempfile::Builder::new().prefix("new-").tempdir_in(&self.cache).map_err(file(&self.cache))?;
        let new = place.path().join("environment");
        let requirements = place.path().join("requirements.txt");
        fs::write(&requirements, REQUIREMENTS).map_err(file(&requirements))?;

        let make = start(Command::new(&self.python).args(["-m", "venv"]).arg(&new))?;
        succeeded(&make, "make a Python environment (python3 -m venv)")?;
        let mut install = Command::new(program(&new));
        install.args(["-m", "pip", "install", "--disable-pip-version-check", "--no-input", "--quiet"]);
        // The list includes all dependencies, so that no unpinned package is installed.
        install.args(["--no-deps", "--only-binary", ":all:", "--requirement"]).arg(&requirements);
        succeeded(&start(&mut install)?, "install the packages with pip")?;
        let mark = new.join(MARK);
        fs::write(&mark, REQUIREMENTS).map_err(file(&mark))?;

        if folder.exists() && !complete(&folder) {
            // Its interpreter no longer exists, for example after an upgrade of the system.
            fs::remove_dir_all(&folder).map_err(file(&folder))?;
        }
        match fs::rename(&new, &folder) {
            Ok(()) => Ok(program(&folder)),
            // Another process has created the environment in the meantime.
            Err(_) if complete(&folder) => Ok(program(&folder)),
            Err(source) => Err(Error::File { path: folder, source }),
        }
    }

    fn check_version(&self) -> Result<(), Error> {
        let ask = "import sys; print('%d.%d' % sys.version_info[:2])";
        let answer = start(Command::new(&self.python).args(["-I", "-c", ask]))?;
        succeeded(&answer, "ask Python for its version")?;
        let found = String::from_utf8_lossy(&answer.stdout).trim().to_owned();
        let version: Vec<u32> = found.split('.').filter_map(|part| part.parse().ok()).collect();
        if version.as_slice() < OLDEST.as_slice() {
            return Err(Error::OldPython { program: self.python.clone(), found });
        }
        Ok(())
    }
}

/// Whether the environment was completed and its interpreter still exists.
fn complete(folder: &Path) -> bool {
    folder.join(MARK).is_file() && program(folder).exists()
}

fn program(folder: &Path) -> PathBuf {
    if cfg!(windows) { folder.join("Scripts").join("python.exe") } else { folder.join("bin").join("python") }
}

fn start(command: &mut Command) -> Result<Output, Error> {
    command.output().map_err(|source| Error::NoPython { program: command.get_program().into(), source })
}

fn succeeded(output: &Output, step: &'static str) -> Result<(), Error> {
    if output.status.success() { Ok(()) } else { Err(Error::Environment { step, output: tail(output) }) }
}

/// Last lines of the output of a process.
pub(super) fn tail(output: &Output) -> String {
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    let text = String::from_utf8_lossy(&text);
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(12)..].join("\n")
}
