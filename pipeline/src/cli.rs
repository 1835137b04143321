//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

/// From a beam spec to influence tables, simulation, plots and report.
#[derive(Debug, Parser)]
#[command(name = "girderway", version, about, max_term_width = 100, arg_required_else_help = true)]
pub struct Cli {
    /// What every command takes.
    #[command(flatten)]
    pub global: Global,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// Flags of every command.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct Global {
    /// No progress and no messages; errors alone
    #[arg(long, global = true)]
    pub quiet: bool,
    /// A machine-readable result on standard output, errors as JSON on standard error
    #[arg(long, global = true)]
    pub json: bool,
    /// Most threads to use [default: one a processor]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve the structures, write their tables, simulate, draw and report: the main job
    #[command(after_help = "Example:\n  girderway run examples/bogie/scene.json -o out")]
    Run(Scene),
    /// Simulate alone, on the tables that an earlier run has left in the output folder
    #[command(after_help = "Example:\n  girderway sim examples/bogie/scene.json -o out")]
    Sim(Scene),
    /// Solve a beam spec for its influence grid
    #[command(after_help = "Example:\n  girderway fea examples/bogie/spec.json -o grid.json")]
    Fea(Fea),
    /// Write the tables of a grid, as an ADAMS data set or in the format of the file's ending
    #[command(after_help = "Example:\n  girderway splines grid.json -o bridge.adm")]
    Splines(Splines),
    /// Compare a beam spec's grids with those of independent FE codes: scikit-fem, OpenSees, PyNite, a gmsh solid
    #[command(after_help = "Example:\n  girderway crosscheck examples/bogie/spec.json")]
    Crosscheck(Crosscheck),
}

/// Arguments of `crosscheck`.
#[derive(Clone, Debug, Args)]
pub struct Crosscheck {
    /// Beam spec
    pub spec: PathBuf,
    /// Folder for the result as text and JSON, with plots of the differences [default: console alone]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Beam theory in place of the spec's
    #[arg(long)]
    pub theory: Option<Theory>,
}

/// Arguments of `splines`.
#[derive(Clone, Debug, Args)]
pub struct Splines {
    /// Grid file
    pub grid: PathBuf,
    /// File to write: .adm, .json or .csv [default: an ADAMS data set on standard output]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Arguments of `fea`.
#[derive(Clone, Debug, Args)]
pub struct Fea {
    /// Beam spec
    pub spec: PathBuf,
    /// Grid file to write [default: standard output]
    #[arg(short, long, value_name = "GRID.json")]
    pub output: Option<PathBuf>,
    /// Beam theory in place of the spec's
    #[arg(long)]
    pub theory: Option<Theory>,
}

/// Words of the beam theories.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Theory {
    /// Sections stay normal to the axis
    EulerBernoulli,
    /// Sections shear
    Timoshenko,
}

impl From<Theory> for fea::Theory {
    fn from(theory: Theory) -> fea::Theory {
        match theory {
            Theory::EulerBernoulli => fea::Theory::EulerBernoulli,
            Theory::Timoshenko => fea::Theory::Timoshenko,
        }
    }
}

/// Arguments of `run` and `sim`.
#[derive(Clone, Debug, Args)]
pub struct Scene {
    /// Scene file
    pub scene: PathBuf,
    /// Output folder [default: girderway-out/NAME, the scene's name]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}
