//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use deck::DeckForm;
use formats::grid::block::GridBlock;
use formats::units::{Force, Length};
use import::rail::triple;
use import::{fix, rail};
use study::table_quality::TableReadingMethod;

/// From a beam spec to influence tables, simulation, plots and report.
#[derive(Debug, Parser)]
#[command(
    name = "girderway",
    version,
    about,
    max_term_width = 100,
    arg_required_else_help = true
)]
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
    Run(SceneArgs),
    /// Simulate alone, on the tables that an earlier run has left in the output folder
    #[command(after_help = "Example:\n  girderway sim examples/bogie/scene.json -o out")]
    Sim(SceneArgs),
    /// Solve a beam spec for its influence grid
    #[command(after_help = "Example:\n  girderway fea examples/bogie/spec.json -o grid.json")]
    Fea(FeaArgs),
    /// Write the tables of a grid or of another file, at their stations or at the fewest that are sufficient, or check their errors
    #[command(after_help = "Example:\n  girderway splines grid.json -o bridge.adm")]
    Splines(SplinesArgs),
    /// Write a scene as a complete ADAMS data set, with its command file; --check executes it against the simulator
    #[command(
        after_help = "Example:\n  girderway deck examples/bogie/scene.json -o bogie.adm --form symmetrised --check"
    )]
    Deck(DeckArgs),
    /// Turn a model of another program into a beam spec: NASTRAN bulk data, a gmsh mesh or an Abaqus file
    #[command(
        after_help = "Example:\n  girderway import deck.bdf --length m --force N --up 0,0,1 --rail runway=12,23,30-35 -o spec.json"
    )]
    Import(ImportArgs),
    /// Compare a beam spec's grids with those of independent FE codes: scikit-fem, OpenSees, PyNite, a gmsh solid
    #[command(after_help = "Example:\n  girderway crosscheck examples/bogie/spec.json")]
    Crosscheck(CrosscheckArgs),
    /// Chart accuracy against cost: a scene at many settings, compared with a converged reference that is run first
    #[command(after_help = "Example:\n  girderway study examples/bogie/scene.json -o out")]
    Study(StudyArgs),
    /// Envelopes, extremes and reactions of wheel trains on a structure, statically and exactly, with limits of codes
    #[command(after_help = "Example:\n  girderway design examples/runway/design.json -o out")]
    Design(DesignArgs),
    /// Many runs of a scene or design with other values of its axes, on all cores; resumes where it was interrupted
    #[command(after_help = "Example:\n  girderway sweep examples/runway/sweep.json -o out")]
    Sweep(SweepArgs),
    /// List rolled sections and crane rails by name, with dimensions and properties
    #[command(after_help = "Example:\n  girderway sections heb")]
    Sections(SectionsArgs),
    /// Print the JSON Schema of a format, with which editors complete and check files
    #[command(after_help = "Example:\n  girderway schema scene -o scene.schema.json")]
    Schema(SchemaArgs),
    /// Write starter files that run as they are: a crane runway, a bogie on a girder, a girder of a mill building, a bridge crane
    #[command(after_help = "Example:\n  girderway init bogie mine")]
    Init(InitArgs),
    /// Print the completions of a shell
    #[command(
        after_help = "Example:\n  girderway completions bash > ~/.local/share/bash-completion/completions/girderway"
    )]
    Completions(CompletionsArgs),
    /// Write the manual pages of the program and its commands
    #[command(after_help = "Example:\n  girderway man ~/.local/share/man/man1")]
    Man(ManArgs),
}

/// Arguments of `completions`.
#[derive(Clone, Copy, Debug, Args)]
pub struct CompletionsArgs {
    /// Shell that reads them
    pub shell: clap_complete::Shell,
}

/// Arguments of `man`.
#[derive(Clone, Debug, Args)]
pub struct ManArgs {
    /// Folder of the pages, created if it does not exist [default: the program's page to standard output]
    #[arg(value_name = "DIR")]
    pub folder: Option<PathBuf>,
}

/// Arguments of `design`.
#[derive(Clone, Debug, Args)]
pub struct DesignArgs {
    /// Design file
    pub design: PathBuf,
    /// Output folder [default: girderway-out/NAME-design, after the design's name]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace files in the folder that girderway did not write, or that have been changed since
    #[arg(long)]
    pub force: bool,
    /// Exit with status 1 where a limit of the code is exceeded
    #[arg(long)]
    pub fail_on_limit: bool,
}

/// Arguments of `sweep`.
#[derive(Clone, Debug, Args)]
pub struct SweepArgs {
    /// Sweep file
    #[arg(required_unless_present = "merge", value_name = "SWEEP")]
    pub sweep: Option<PathBuf>,
    /// Output folder [default: girderway-out/NAME-sweep, after the sweep's name; a shard: NAME-sweep-K-of-N; one run: NAME-run-K]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace files in the folder that girderway did not write, or that have been changed since, and discard the runs of another sweep that was interrupted there
    #[arg(long)]
    pub force: bool,
    /// Only shard K of N: every N-th run from run K
    #[arg(long, value_name = "K/N", value_parser = shard, conflicts_with = "merge")]
    pub shard: Option<(usize, usize)>,
    /// Join the folders of all shards of a sweep, in place of running one
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with = "sweep", requires = "output")]
    pub merge: Vec<PathBuf>,
    /// Repeat one run with everything that `run` or `design` writes
    #[arg(long, value_name = "K", conflicts_with_all = ["shard", "merge"])]
    pub run: Option<usize>,
}

/// Reads `K/N`.
fn shard(text: &str) -> Result<(usize, usize), String> {
    let parts = text
        .split_once('/')
        .and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    match parts {
        Some((k, n)) if 1 <= k && k <= n => Ok((k, n)),
        _ => Err("must be K/N with K from 1 to N, such as 3/8".to_owned()),
    }
}

/// Arguments of `sections`.
#[derive(Clone, Debug, Args)]
pub struct SectionsArgs {
    /// Part of the names to list, where blanks and case do not count [default: all]
    #[arg(value_name = "PATTERN")]
    pub pattern: Vec<String>,
}

/// Arguments of `schema`.
#[derive(Clone, Debug, Args)]
pub struct SchemaArgs {
    /// Which format
    pub format: SchemaArg,
    /// File to write [default: standard output]
    #[arg(short, long, value_name = "FILE.json")]
    pub output: Option<PathBuf>,
}

/// Words of the formats that have a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaArg {
    /// Beam spec
    Beam,
    /// Influence grid
    Grid,
    /// Scene
    Scene,
    /// Design
    Design,
    /// Sweep
    Sweep,
    /// Summary of a run
    Summary,
    /// Summary of a design
    DesignSummary,
}

/// Arguments of `init`.
#[derive(Clone, Debug, Args)]
pub struct InitArgs {
    /// Which files
    pub what: Starter,
    /// Folder to write them into, created if it does not exist [default: the current folder]
    #[arg(value_name = "DIR")]
    pub folder: Option<PathBuf>,
}

/// Words of the starter files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Starter {
    /// Two wheels cross a girder on two supports
    Bogie,
    /// A bridge crane in a building of two girderways
    Crane,
    /// One girderway on columns and brackets
    Girderway,
    /// A plain crane runway, with its design and a sweep
    Runway,
}

/// Arguments of `study`.
#[derive(Clone, Debug, Args)]
pub struct StudyArgs {
    /// Scene file
    pub scene: PathBuf,
    /// Output folder [default: girderway-out/NAME-study, after the scene's name]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace files in the folder that girderway did not write, or that have been changed since
    #[arg(long)]
    pub force: bool,
    /// The comparison of the scene to study [default: the scene itself]
    #[arg(long, value_name = "LABEL")]
    pub case: Option<String>,
    /// Fewer settings, coarser references, fewer repetitions
    #[arg(long)]
    pub quick: bool,
    /// Instead of the charts, map where methods fail for the first straight girder of the scene and its wheels
    #[arg(long)]
    pub stability: bool,
    /// Time limit in seconds of one run and of all its repetitions (with --quick half a second of these); references may take ten times as long
    /// [default: 20, with --quick 5]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub limit: Option<f64>,
    /// Largest uncertainty of the references, relative to the largest value; status 3 where they do not reach it [default: 1e-4, with --quick 1e-2]
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub resolution: Option<f64>,
}

/// Arguments of `crosscheck`.
#[derive(Clone, Debug, Args)]
pub struct CrosscheckArgs {
    /// Beam spec
    pub spec: PathBuf,
    /// Folder for the result as text and JSON, with plots of the differences [default: console only]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace files in the folder that girderway did not write, or that have been changed since
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Beam theory that replaces that of the spec
    #[arg(long)]
    pub theory: Option<TheoryArg>,
}

/// Arguments of `splines`.
#[derive(Clone, Debug, Args)]
pub struct SplinesArgs {
    /// Grid file, or a file of tables: .adm, .cmd, .csv, .json or .npz
    pub grid: PathBuf,
    /// File to write: .adm, .cmd, .csv, .json or .npz [default: an ADAMS data set on standard output]; with --check a
    /// picture (.svg), a page (.html) or all numbers (.json)
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Only the tables of these directions [default: all]
    #[arg(
        long,
        value_name = "DIRECTIONS",
        value_delimiter = ',',
        conflicts_with = "check"
    )]
    pub only: Vec<DirectionArg>,
    /// Tables of G itself, or of curves whose products make G [default: tables; the form of a file of tables]
    #[arg(long, conflicts_with = "check")]
    pub form: Option<TableFormArg>,
    /// Largest number of products of the factored form [default: all that exceed rounding errors]
    #[arg(long, value_name = "R", value_parser = clap::value_parser!(u16).range(1..))]
    pub rank: Option<u16>,
    /// Round to N significant digits (Adams View writes 10) [default: all digits]
    #[arg(long, value_name = "N", conflicts_with = "check", value_parser = clap::value_parser!(u8).range(1..=17))]
    pub digits: Option<u8>,
    /// Unit of length of tables whose file does not contain it
    #[arg(long, requires = "force")]
    pub length: Option<LengthArg>,
    /// Unit of force of tables whose file does not contain it
    #[arg(long, requires = "length")]
    pub force: Option<ForceArg>,
    /// Print the error of each reading method of the tables
    #[arg(long)]
    pub check: bool,
    /// Reading method that must meet the tolerance: writes tables at the fewest stations that are sufficient; with --check a
    /// larger error is a failure [default with --check: akispl]
    #[arg(long, requires = "tolerance")]
    pub reading: Option<TableReadingArg>,
    /// Error allowed, relative to the largest coefficient; for the factored form without --reading, the error at the stations
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub tolerance: Option<f64>,
    /// Directions that must meet the tolerance [default: vertical,lateral]
    #[arg(
        long,
        value_name = "DIRECTIONS",
        value_delimiter = ',',
        conflicts_with = "check",
        requires = "reading"
    )]
    pub directions: Vec<DirectionArg>,
    /// Force of one wheel, for work and angles
    #[arg(long, value_name = "FORCE", value_parser = positive, requires = "check")]
    pub load: Option<f64>,
    /// Distance between two wheels that move together
    #[arg(long, value_name = "LENGTH", value_parser = positive, requires = "check")]
    pub spacing: Option<f64>,
    /// Compare the rules of extrapolation up to this distance beyond a table [default: its last station distance]
    #[arg(long, value_name = "LENGTH", value_parser = positive, requires = "check")]
    pub beyond: Option<f64>,
}

/// Words of the forms of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableFormArg {
    /// G over load and deflection
    Table,
    /// One-curve splines, and G as the sum of their products
    Factored,
}

/// Words of the reading methods of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableReadingArg {
    /// AKISPL along the load, linear interpolation along the deflection
    Akispl,
    /// The mean of AKISPL with load and deflection exchanged
    Symmetrised,
    /// CUBSPL along the load, linear interpolation along the deflection
    Cubspl,
    /// Natural splines along both
    Natural,
    /// Products of one-curve CUBSPLs
    Factored,
    /// The beam whose coefficients the values are
    Exact,
}

impl From<TableReadingArg> for TableReadingMethod {
    fn from(reading: TableReadingArg) -> TableReadingMethod {
        match reading {
            TableReadingArg::Akispl => TableReadingMethod::Akispl,
            TableReadingArg::Symmetrised => TableReadingMethod::Symmetrised,
            TableReadingArg::Cubspl => TableReadingMethod::Cubspl,
            TableReadingArg::Natural => TableReadingMethod::Natural,
            TableReadingArg::Factored => TableReadingMethod::Factored,
            TableReadingArg::Exact => TableReadingMethod::Exact,
        }
    }
}

/// Words of the directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DirectionArg {
    /// Up
    Vertical,
    /// To the right
    Lateral,
    /// Along the rail
    Longitudinal,
}

impl From<DirectionArg> for splines::Axis {
    fn from(direction: DirectionArg) -> splines::Axis {
        match direction {
            DirectionArg::Vertical => splines::Axis::Vertical,
            DirectionArg::Lateral => splines::Axis::Lateral,
            DirectionArg::Longitudinal => splines::Axis::Longitudinal,
        }
    }
}

impl From<DirectionArg> for GridBlock {
    fn from(direction: DirectionArg) -> GridBlock {
        match direction {
            DirectionArg::Vertical => GridBlock::Vertical,
            DirectionArg::Lateral => GridBlock::Lateral,
            DirectionArg::Longitudinal => GridBlock::Longitudinal,
        }
    }
}

/// Parses a positive number below 1e60.
fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if value > 0.0 && value < 1e60 {
        Ok(value)
    } else {
        Err("must be positive, below 1e60".to_owned())
    }
}

/// Arguments of `deck`.
#[derive(Clone, Debug, Args)]
pub struct DeckArgs {
    /// Scene file
    pub scene: PathBuf,
    /// Data set to write; its command file is written to the same folder [default: standard output, data set only]
    #[arg(short, long, value_name = "FILE.adm")]
    pub output: Option<PathBuf>,
    /// Replace a command file beside the data set that girderway did not write
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Method by which the deck reads the compliance of the rails [default: factored; akispl where the scene reads a structure by it]
    #[arg(long)]
    pub form: Option<DeckFormArg>,
    /// Execute the deck and compare its forces with the simulator's; status 1 where they differ
    #[arg(long)]
    pub check: bool,
    /// Random states of the check
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..))]
    pub states: u32,
}

/// Words of the forms of decks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeckFormArg {
    /// AKISPL of a family of curves: N^2 look-ups for N wheels; neither symmetric nor conservative between the stations
    Akispl,
    /// The mean of AKISPL(x, z) and AKISPL(z, x): 2 N^2 look-ups, symmetric
    Symmetrised,
    /// Products of r curves read by CUBSPL: r N curves, symmetric, positive, with the force along the rail
    Factored,
    /// The expressions printed in the paper, with their inaccuracies, for comparison only
    Paper,
}

impl From<DeckFormArg> for DeckForm {
    fn from(form: DeckFormArg) -> DeckForm {
        match form {
            DeckFormArg::Akispl => DeckForm::Akispl,
            DeckFormArg::Symmetrised => DeckForm::Symmetrised,
            DeckFormArg::Factored => DeckForm::Factored,
            DeckFormArg::Paper => DeckForm::Paper,
        }
    }
}

/// Arguments of `import`.
#[derive(Clone, Debug, Args)]
pub struct ImportArgs {
    /// Model: .bdf, .dat or .nas (NASTRAN bulk data), .msh (gmsh), or .inp (Abaqus)
    pub model: PathBuf,
    /// Beam spec to write [default: standard output]
    #[arg(short, long, value_name = "SPEC.json")]
    pub output: Option<PathBuf>,
    /// Unit of length of the model, which its file does not contain
    #[arg(long)]
    pub length: Option<LengthArg>,
    /// Unit of force of bulk data and Abaqus files, which do not contain it
    #[arg(long)]
    pub force: Option<ForceArg>,
    /// Upward direction; required for rails
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true)]
    pub up: Option<[f64; 3]>,
    /// A rail along elements (12,23,30-35) or a set of them; /offset=X,Y,Z and /axis=X,Y,Z may follow
    #[arg(long, value_name = "NAME=ELEMENTS")]
    pub rail: Vec<rail::RailRequest>,
    /// Restrain degrees of freedom of a set of points, such as feet=ux,uy,uz
    #[arg(long, value_name = "SET=DOF")]
    pub fix: Vec<fix::SupportRequest>,
    /// Materials and sections of a mesh, by the names of its physical groups
    #[arg(long, value_name = "FILE.json")]
    pub sections: Option<PathBuf>,
    /// Set of supports, where case control does not choose one
    #[arg(long, value_name = "SET")]
    pub spc: Option<u64>,
    /// Cards or keywords to leave out, such as CQUAD4,MPC
    #[arg(long, value_name = "CARDS", value_delimiter = ',')]
    pub skip: Vec<String>,
    /// Leave out what cannot change statics, such as optimisation, aeroelasticity and damping; each is listed
    #[arg(long)]
    pub skip_unused: bool,
    /// Where the mass of bulk-data elements acts [default: along beams, and at the ends of rods unless PARAM COUPMASS is above 0]
    #[arg(long, value_name = "WHERE")]
    pub mass: Option<MassArg>,
}

/// Words of the distribution of mass.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum MassArg {
    /// At the ends of members
    Lumped,
    /// Along members
    Distributed,
}

impl From<MassArg> for import::structure::MassDistribution {
    fn from(word: MassArg) -> import::structure::MassDistribution {
        match word {
            MassArg::Lumped => import::structure::MassDistribution::Lumped,
            MassArg::Distributed => import::structure::MassDistribution::Distributed,
        }
    }
}

/// Words of the units of length.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum LengthArg {
    /// Foot
    Ft,
    /// Inch
    In,
    /// Metre
    M,
    /// Millimetre
    Mm,
}

impl From<LengthArg> for Length {
    fn from(unit: LengthArg) -> Length {
        match unit {
            LengthArg::Ft => Length::Foot,
            LengthArg::In => Length::Inch,
            LengthArg::M => Length::Metre,
            LengthArg::Mm => Length::Millimetre,
        }
    }
}

/// Words of the units of force.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ForceArg {
    /// Pound-force
    Lbf,
    /// 1000 pound-force
    Kip,
    /// Newton
    #[value(name = "N")]
    Newton,
    /// Kilonewton
    #[value(name = "kN")]
    Kilonewton,
}

impl From<ForceArg> for Force {
    fn from(unit: ForceArg) -> Force {
        match unit {
            ForceArg::Lbf => Force::Pound,
            ForceArg::Kip => Force::Kip,
            ForceArg::Newton => Force::Newton,
            ForceArg::Kilonewton => Force::Kilonewton,
        }
    }
}

/// Arguments of `fea`.
#[derive(Clone, Debug, Args)]
pub struct FeaArgs {
    /// Beam spec
    pub spec: PathBuf,
    /// Grid file to write [default: standard output]
    #[arg(short, long, value_name = "GRID.json")]
    pub output: Option<PathBuf>,
    /// Beam theory that replaces that of the spec
    #[arg(long)]
    pub theory: Option<TheoryArg>,
    /// Relative error that rounding may cause; solved in double-doubles where doubles cannot promise it
    #[arg(long, value_name = "BOUND", default_value_t = fea::DEFAULT_ACCURACY, value_parser = fraction)]
    pub accuracy: f64,
    /// Add the N lowest natural modes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub modes: Option<u32>,
}

/// Parses a number between 0 and 1, both excluded.
fn fraction(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if value > 0.0 && value < 1.0 {
        Ok(value)
    } else {
        Err("must lie between 0 and 1".to_owned())
    }
}

/// Words of the beam theories.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TheoryArg {
    /// Sections stay normal to the axis
    EulerBernoulli,
    /// Sections shear
    Timoshenko,
}

impl From<TheoryArg> for fea::BeamTheory {
    fn from(theory: TheoryArg) -> fea::BeamTheory {
        match theory {
            TheoryArg::EulerBernoulli => fea::BeamTheory::EulerBernoulli,
            TheoryArg::Timoshenko => fea::BeamTheory::Timoshenko,
        }
    }
}

/// Arguments of `run` and `sim`.
#[derive(Clone, Debug, Args)]
pub struct SceneArgs {
    /// Scene file
    pub scene: PathBuf,
    /// Output folder [default: girderway-out/NAME, the scene's name]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Replace files in the folder that girderway did not write, or that have been changed since
    #[arg(long)]
    pub force: bool,
}
