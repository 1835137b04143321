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
/// Name of the file that marks an environment in which packages are missing; it contains the identifier of the process
/// that made it. This process uses it, and later ones try again.
const PARTIAL: &str = "partial";
/// A small package of the requirements, by which an index that cannot be reached is noticed at once.
const SMALLEST: &str = "wcwidth";
/// What the models of each code need besides numpy and scipy, by the beginnings of the lines of the requirements.
const PACKAGES: [(&str, &[&str]); 4] = [
    ("scikit-fem", &["scikit-fem"]),
    ("OpenSees", &["openseespy"]),
    ("PyNite", PYNITE),
    ("gmsh", &["gmsh"]),
];
const PYNITE: &[&str] = &[
    "PyNiteFEA",
    "prettytable",
    "wcwidth",
    "matplotlib",
    "contourpy",
    "cycler",
    "fonttools",
    "kiwisolver",
    "packaging",
    "pillow",
    "pyparsing",
    "python-dateutil",
];
/// What every model needs.
const SHARED: &[&str] = &["numpy", "scipy"];

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
        let set = |name| {
            std::env::var_os(name)
                .filter(|v| !v.is_empty())
                .map(PathBuf::from)
        };
        let cache = set("XDG_CACHE_HOME").filter(|p| p.is_absolute());
        let cache = cache.or_else(|| set("HOME").map(|home| home.join(".cache")));
        Ok(Environment {
            python: "python3".into(),
            cache: cache.ok_or(Error::NoCache)?.join("girderway"),
        })
    }

    /// Directory of the environment for the pinned requirements.
    pub fn folder(&self) -> PathBuf {
        let digest = Sha256::digest(REQUIREMENTS.as_bytes());
        let name: String = digest
            .iter()
            .take(8)
            .map(|byte| format!("{byte:02x}"))
            .collect();
        self.cache.join(name)
    }

    /// Returns the interpreter of the environment. Creates a missing environment, with a message to `say`.
    ///
    /// The environment is created in a temporary directory and renamed when it is complete, so that interrupted or
    /// concurrent processes do not leave an incomplete one.
    ///
    /// If the packages cannot be installed together, those of each code are installed separately, and the codes that
    /// remain are used.
    ///
    /// # Errors
    /// Python is missing or too old, the index of packages cannot be reached, or no code can be installed.
    pub fn prepare(&self, say: &mut dyn FnMut(&str)) -> Result<PathBuf, Error> {
        let folder = self.folder();
        if complete(&folder) || made_by_this_process(&folder) {
            return Ok(program(&folder));
        }
        self.check_version()?;
        say(&format!(
            "creating a Python environment with scikit-fem, gmsh, OpenSees and PyNite in {} (once, about 650 MB)",
            folder.display()
        ));
        let file = |path: &Path| {
            let path = path.to_owned();
            move |source| Error::File { path, source }
        };
        fs::create_dir_all(&self.cache).map_err(file(&self.cache))?;
        let place = tempfile::Builder::new()
            .prefix("new-")
            .tempdir_in(&self.cache)
            .map_err(file(&self.cache))?;
        let new = place.path().join("environment");
        let requirements = place.path().join("requirements.txt");
        fs::write(&requirements, REQUIREMENTS).map_err(file(&requirements))?;

        let make = start(Command::new(&self.python).args(["-m", "venv"]).arg(&new))?;
        succeeded(&make, "create a Python environment (python3 -m venv)")?;
        let python = program(&new);
        let one = ask_index(&python)?;
        let is_online = one.status.success();
        if !is_online && std::env::var_os(COPIES).is_none_or(|places| places.is_empty()) {
            return Err(offline(&one));
        }
        let options = if is_online { RETRIES } else { WITHOUT_INDEX };
        if !is_online {
            say(&format!(
                "pip cannot reach PyPI; using only packages in {COPIES}"
            ));
        }
        let every = [
            "--requirement".to_owned(),
            requirements.display().to_string(),
        ];
        let all = install(&python, &every, options)?;
        let mark = match all.status.success() {
            true => (MARK, REQUIREMENTS.to_owned()),
            false => {
                let separate = install_separately(&python, &all, options, say);
                separate.map_err(|error| if is_online { error } else { offline(&one) })?;
                (PARTIAL, std::process::id().to_string())
            }
        };
        let path = new.join(mark.0);
        fs::write(&path, mark.1).map_err(file(&path))?;

        if folder.exists() && !complete(&folder) {
            // Packages are missing, or its interpreter no longer exists, for example after an upgrade of the system.
            fs::remove_dir_all(&folder).map_err(file(&folder))?;
        }
        match fs::rename(&new, &folder) {
            Ok(()) => Ok(program(&folder)),
            // Another process has created the environment in the meantime.
            Err(_) if complete(&folder) || folder.join(PARTIAL).is_file() => Ok(program(&folder)),
            Err(source) => Err(Error::File {
                path: folder,
                source,
            }),
        }
    }

    fn check_version(&self) -> Result<(), Error> {
        let ask = "import sys; print('%d.%d' % sys.version_info[:2])";
        let answer = start(Command::new(&self.python).args(["-I", "-c", ask]))?;
        succeeded(&answer, "determine the Python version")?;
        let found = String::from_utf8_lossy(&answer.stdout).trim().to_owned();
        let version: Vec<u32> = found
            .split('.')
            .filter_map(|part| part.parse().ok())
            .collect();
        if version.as_slice() < OLDEST.as_slice() {
            return Err(Error::OldPython {
                program: self.python.clone(),
                found,
            });
        }
        Ok(())
    }
}

/// Options of installations: an index that answers slowly is asked a second and a third time.
const RETRIES: &[&str] = &["--retries", "2"];
/// Options of installations where the index cannot be reached: asking it for each package would take minutes.
const WITHOUT_INDEX: &[&str] = &["--no-index"];
/// Variable of pip with places that have copies of packages.
const COPIES: &str = "PIP_FIND_LINKS";

/// Lines of the requirements that begin with one of `names`.
fn requirements_of(names: &[&str]) -> Vec<String> {
    let is_one = |line: &&str| names.iter().any(|name| line.starts_with(name));
    REQUIREMENTS
        .lines()
        .filter(is_one)
        .map(str::to_owned)
        .collect()
}

/// Installs a small package from the index of packages alone, which fails where the index cannot be reached: at once, or
/// after twenty seconds where it does not answer.
fn ask_index(python: &Path) -> Result<Output, Error> {
    let options = ["--retries", "0", "--timeout", "20"];
    start(pip_install(python, &requirements_of(&[SMALLEST]), &options).env_remove(COPIES))
}

/// The error of an index that cannot be reached. That pip has found no version says nothing more; a proxy or a certificate
/// that it complains of does.
fn offline(asked: &Output) -> Error {
    let says_more = |line: &&str| {
        !line.contains("(from versions: none)") && !line.contains("No matching distribution")
    };
    let text = tail(asked);
    Error::Offline {
        output: text
            .lines()
            .filter(says_more)
            .flat_map(|line| ["\n", line])
            .collect(),
    }
}

/// Runs pip in the environment of `python`. The requirements include all dependencies, so that no unpinned package is
/// installed.
fn install(python: &Path, packages: &[String], options: &[&str]) -> Result<Output, Error> {
    start(&mut pip_install(python, packages, options))
}

fn pip_install(python: &Path, packages: &[String], options: &[&str]) -> Command {
    let mut pip = Command::new(python);
    pip.args([
        "-m",
        "pip",
        "install",
        "--disable-pip-version-check",
        "--no-input",
        "--quiet",
    ]);
    pip.args(["--no-deps", "--only-binary", ":all:"])
        .args(options)
        .args(packages);
    pip
}

/// Installs what each code needs on its own and says which codes are missing; `together` is the output of the
/// installation of all.
fn install_separately(
    python: &Path,
    together: &Output,
    options: &[&str],
    say: &mut dyn FnMut(&str),
) -> Result<(), Error> {
    let step = "install the packages with pip";
    succeeded(&install(python, &requirements_of(SHARED), options)?, step)?;
    let mut missing = Vec::new();
    for (code, names) in PACKAGES {
        if !install(python, &requirements_of(names), options)?
            .status
            .success()
        {
            missing.push(code);
        }
    }
    if missing.len() == PACKAGES.len() {
        return succeeded(together, step);
    }
    if !missing.is_empty() {
        say(&format!(
            "skipping {}: installation failed and is retried next time",
            missing.join(", ")
        ));
    }
    Ok(())
}

/// Whether this process has made the environment, without some packages.
fn made_by_this_process(folder: &Path) -> bool {
    fs::read_to_string(folder.join(PARTIAL))
        .is_ok_and(|made| made == std::process::id().to_string())
}

/// Whether the environment was completed and its interpreter still exists.
fn complete(folder: &Path) -> bool {
    folder.join(MARK).is_file() && program(folder).exists()
}

fn program(folder: &Path) -> PathBuf {
    if cfg!(windows) {
        folder.join("Scripts").join("python.exe")
    } else {
        folder.join("bin").join("python")
    }
}

fn start(command: &mut Command) -> Result<Output, Error> {
    command.output().map_err(|source| Error::NoPython {
        program: command.get_program().into(),
        source,
    })
}

fn succeeded(output: &Output, step: &'static str) -> Result<(), Error> {
    if output.status.success() {
        Ok(())
    } else {
        Err(Error::Environment {
            step,
            output: tail(output),
        })
    }
}

/// Last lines of the output of a process.
pub(super) fn tail(output: &Output) -> String {
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    let text = String::from_utf8_lossy(&text);
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(12)..].join("\n")
}
