//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use deck::DeckForm;
use formats::grid::block::GridBlock;
use formats::units::{Force, Length};
use import::rail::triple;
use import::{fix, rail};
use study::table_quality::TableReadingMethod;

/// Static design and moving-load simulation of crane girders, runway beams and mill buildings.
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
    /// Print errors only
    #[arg(long, global = true)]
    pub quiet: bool,
    /// Print the result as JSON to standard output and errors as JSON to standard error
    #[arg(long, global = true)]
    pub json: bool,
    /// Maximum number of threads [default: all cores]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve the structures, write their influence tables, simulate the scene, and write a report
    #[command(after_help = "Example:\n  girderway run examples/bogie/scene.json -o out")]
    Run(SceneArgs),
    /// Simulate with the tables of an earlier run in the output folder
    #[command(after_help = "Example:\n  girderway sim examples/bogie/scene.json -o out")]
    Sim(SceneArgs),
    /// Compute the influence coefficients of a beam spec, and optionally its natural modes
    #[command(after_help = "Example:\n  girderway fea examples/bogie/spec.json -o grid.json")]
    Fea(FeaArgs),
    /// Write or convert SPLINE tables, at the given or at the minimum number of stations, or check their interpolation
    /// errors
    #[command(after_help = "Example:\n  girderway splines grid.json -o bridge.adm")]
    Splines(SplinesArgs),
    /// Write a scene as an ADAMS/Solver data set with its command file; --check executes it and compares it with the
    /// simulator
    #[command(
        after_help = "Example:\n  girderway deck examples/bogie/scene.json -o bogie.adm --form symmetrised --check"
    )]
    Deck(DeckArgs),
    /// Convert NASTRAN bulk data, a gmsh mesh or an Abaqus input file to a beam spec
    #[command(
        after_help = "Example:\n  girderway import deck.bdf --length m --force N --up 0,0,1 --rail runway=12,23,30-35 -o spec.json"
    )]
    Import(ImportArgs),
    /// Compare the influence coefficients of a beam spec with independent FE codes: scikit-fem, OpenSees, PyNite and a
    /// gmsh solid model
    #[command(after_help = "Example:\n  girderway crosscheck examples/bogie/spec.json")]
    Crosscheck(CrosscheckArgs),
    /// Accuracy against cost: run a scene with many models and settings and compare each with a converged reference
    #[command(after_help = "Example:\n  girderway study examples/bogie/scene.json -o out")]
    Study(StudyArgs),
    /// Static design for wheel trains: exact envelopes, governing positions, reactions and code limits
    #[command(after_help = "Example:\n  girderway design examples/runway/design.json -o out")]
    Design(DesignArgs),
    /// Parameter study of a scene or design on all cores; an interrupted study resumes where it stopped
    #[command(after_help = "Example:\n  girderway sweep examples/runway/sweep.json -o out")]
    Sweep(SweepArgs),
    /// List rolled sections and crane rails by name, with dimensions and properties
    #[command(after_help = "Example:\n  girderway sections heb")]
    Sections(SectionsArgs),
    /// Print the JSON Schema of a file format, for completion and validation in editors
    #[command(after_help = "Example:\n  girderway schema scene -o scene.schema.json")]
    Schema(SchemaArgs),
    /// Write starter files that can be run: a crane runway, a bogie on a girder, a mill girderway or a bridge crane
    #[command(after_help = "Example:\n  girderway init bogie mine")]
    Init(InitArgs),
    /// Print the completion script of a shell
    #[command(
        after_help = "Example:\n  girderway completions bash > ~/.local/share/bash-completion/completions/girderway"
    )]
    Completions(CompletionsArgs),
    /// Write the manual pages (man) of the program and its commands
    #[command(after_help = "Example:\n  girderway man ~/.local/share/man/man1")]
    Man(ManArgs),
}

/// Arguments of `completions`.
#[derive(Clone, Copy, Debug, Args)]
pub struct CompletionsArgs {
    /// Shell
    pub shell: clap_complete::Shell,
}

/// Arguments of `man`.
#[derive(Clone, Debug, Args)]
pub struct ManArgs {
    /// Output folder, created if needed [default: print the main page to standard output]
    #[arg(value_name = "DIR")]
    pub folder: Option<PathBuf>,
}

/// Arguments of `design`.
#[derive(Clone, Debug, Args)]
pub struct DesignArgs {
    /// Design file
    pub design: PathBuf,
    /// Output folder [default: girderway-out/NAME-design, where NAME is the name of the design]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Overwrite files in the output folder that girderway did not write or that were modified since
    #[arg(long)]
    pub force: bool,
    /// Exit with status 1 if a check fails; with `strict` also if nothing was checked or a check of the named code was not done
    #[arg(long, num_args = 0..=1, require_equals = true, default_missing_value = "limit", value_name = "WHEN")]
    pub fail_on_limit: Option<FailOnLimit>,
}

/// Arguments of `sweep`.
#[derive(Clone, Debug, Args)]
pub struct SweepArgs {
    /// Sweep file
    #[arg(required_unless_present = "merge", value_name = "SWEEP")]
    pub sweep: Option<PathBuf>,
    /// Output folder [default: girderway-out/NAME-sweep; with --shard: girderway-out/NAME-sweep-K-of-N; with --run:
    /// girderway-out/NAME-run-K]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Overwrite files in the output folder that girderway did not write or that were modified since, and discard the
    /// finished runs of another interrupted sweep there
    #[arg(long)]
    pub force: bool,
    /// Run only shard K of N: every N-th run, starting with run K
    #[arg(long, value_name = "K/N", value_parser = shard, conflicts_with = "merge")]
    pub shard: Option<(usize, usize)>,
    /// Merge the folders of all shards of a sweep instead of running one
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with = "sweep", requires = "output")]
    pub merge: Vec<PathBuf>,
    /// Repeat run K and write all files of `run` or `design`
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
    /// Part of a name, ignoring spaces and case [default: list all names]
    #[arg(value_name = "PATTERN")]
    pub pattern: Vec<String>,
}

/// Arguments of `schema`.
#[derive(Clone, Debug, Args)]
pub struct SchemaArgs {
    /// File format
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
    /// Grid of influence coefficients
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
    /// Starter to write
    pub what: Starter,
    /// Output folder, created if needed [default: the current folder]
    #[arg(value_name = "DIR")]
    pub folder: Option<PathBuf>,
}

/// Words of the starter files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Starter {
    /// A two-wheel bogie crossing a simply supported girder with overhangs
    Bogie,
    /// A bridge crane in a mill building with two girderways
    Crane,
    /// A single girderway on columns and brackets
    Girderway,
    /// A crane runway, with a scene, a design and a sweep
    Runway,
}

/// Arguments of `study`.
#[derive(Clone, Debug, Args)]
pub struct StudyArgs {
    /// Scene file
    pub scene: PathBuf,
    /// Output folder [default: girderway-out/NAME-study, where NAME is the name of the scene]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Overwrite files in the output folder that girderway did not write or that were modified since
    #[arg(long)]
    pub force: bool,
    /// Label of the comparison (`compare`) to study [default: the scene itself]
    #[arg(long, value_name = "LABEL")]
    pub case: Option<String>,
    /// Fewer settings and repetitions, and coarser references
    #[arg(long)]
    pub quick: bool,
    /// Map where methods fail, for the wheels of the scene on its first straight girder, instead of studying accuracy
    /// against cost
    #[arg(long)]
    pub stability: bool,
    /// Time limit in seconds for a single run and for all its repetitions together (with --quick: half a second for the
    /// repetitions); ten times as long for references [default: 20; with --quick: 5]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub limit: Option<f64>,
    /// Maximum uncertainty of the references, relative to the largest value; exit status 3 if it is exceeded [default:
    /// 1e-4; with --quick: 1e-2]
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub resolution: Option<f64>,
}

/// Arguments of `crosscheck`.
#[derive(Clone, Debug, Args)]
pub struct CrosscheckArgs {
    /// Beam spec
    pub spec: PathBuf,
    /// Output folder for text, JSON and plots of the differences [default: print the result only]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Overwrite files in the output folder that girderway did not write or that were modified since
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Beam theory, overriding that of the spec
    #[arg(long)]
    pub theory: Option<TheoryArg>,
}

/// Arguments of `splines`.
#[derive(Clone, Debug, Args)]
pub struct SplinesArgs {
    /// Grid file or table file (.adm, .cmd, .csv, .json or .npz)
    pub grid: PathBuf,
    /// Output file: .adm, .cmd, .csv, .json or .npz [default: an ADAMS data set on standard output]; with --check: .svg
    /// (figures), .html (report) or .json (all values)
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Write only the tables of these directions [default: all]
    #[arg(
        long,
        value_name = "DIRECTIONS",
        value_delimiter = ',',
        conflicts_with = "check"
    )]
    pub only: Vec<DirectionArg>,
    /// Write influence coefficients directly, or factored as sums of products of curves [default: table; for table
    /// files, their own form]
    #[arg(long, conflicts_with = "check")]
    pub form: Option<TableFormArg>,
    /// Maximum number of products of the factored form [default: all that exceed rounding error]
    #[arg(long, value_name = "R", value_parser = clap::value_parser!(u16).range(1..))]
    pub rank: Option<u16>,
    /// Round values to N significant digits, as Adams View does to 10 [default: full precision]
    #[arg(long, value_name = "N", conflicts_with = "check", value_parser = clap::value_parser!(u8).range(1..=17))]
    pub digits: Option<u8>,
    /// Length unit of a table file that does not state one
    #[arg(long, requires = "force")]
    pub length: Option<LengthArg>,
    /// Force unit of a table file that does not state one
    #[arg(long, requires = "length")]
    pub force: Option<ForceArg>,
    /// Check the tables and report the interpolation error of each reading method
    #[arg(long)]
    pub check: bool,
    /// Reading method (interpolation) that must meet --tolerance: write tables with the minimum number of stations;
    /// with --check: fail if the error is larger [default with --check: akispl]
    #[arg(long, requires = "tolerance")]
    pub reading: Option<TableReadingArg>,
    /// Maximum error, relative to the largest coefficient; for --form factored without --reading: maximum error at the
    /// stations
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub tolerance: Option<f64>,
    /// Directions in which the tolerance must be met [default: vertical,lateral]
    #[arg(
        long,
        value_name = "DIRECTIONS",
        value_delimiter = ',',
        conflicts_with = "check",
        requires = "reading"
    )]
    pub directions: Vec<DirectionArg>,
    /// Wheel load for the reported work and slope changes
    #[arg(long, value_name = "FORCE", value_parser = positive, requires = "check")]
    pub load: Option<f64>,
    /// Distance between two wheels that move as a pair, for the reported work and slope changes of the pair
    #[arg(long, value_name = "LENGTH", value_parser = positive, requires = "check")]
    pub spacing: Option<f64>,
    /// Compare extrapolation rules up to this distance beyond the end of a table [default: its last station spacing]
    #[arg(long, value_name = "LENGTH", value_parser = positive, requires = "check")]
    pub beyond: Option<f64>,
}

/// Words of the forms of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableFormArg {
    /// Two-dimensional tables of influence coefficients G(load, deflection)
    Table,
    /// One-dimensional splines; G is the sum of their products
    Factored,
}

/// Words of the reading methods of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableReadingArg {
    /// AKISPL along the load coordinate, linear interpolation along the deflection coordinate
    Akispl,
    /// Mean of AKISPL(x, z) and AKISPL(z, x)
    Symmetrised,
    /// CUBSPL along the load coordinate, linear interpolation along the deflection coordinate
    Cubspl,
    /// Natural cubic splines along both coordinates
    Natural,
    /// Sum of products of one-dimensional CUBSPL curves
    Factored,
    /// Exact influence function of the beam
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
    /// Vertical, positive up
    Vertical,
    /// Lateral, positive to the right when looking along the rail
    Lateral,
    /// Longitudinal, positive along the rail
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
        Err("must be positive and less than 1e60".to_owned())
    }
}

/// Arguments of `deck`.
#[derive(Clone, Debug, Args)]
pub struct DeckArgs {
    /// Scene file
    pub scene: PathBuf,
    /// Output data set; the command file (.acf) is written beside it [default: data set only, on standard output]
    #[arg(short, long, value_name = "FILE.adm")]
    pub output: Option<PathBuf>,
    /// Overwrite a command file that girderway did not write
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Method of evaluating the rail compliance in the deck [default: factored, or akispl if the scene reads a table
    /// with it]
    #[arg(long)]
    pub form: Option<DeckFormArg>,
    /// Execute the deck and compare its forces with those of the simulator; exit status 1 if they differ
    #[arg(long)]
    pub check: bool,
    /// Number of random states for --check [default: 10000 with up to three wheels, fewer with more]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub states: Option<u32>,
}

/// Words of the forms of decks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeckFormArg {
    /// AKISPL of a family of curves: N^2 evaluations for N wheels; between stations neither symmetric nor conservative
    Akispl,
    /// Mean of AKISPL(x, z) and AKISPL(z, x): 2 N^2 evaluations; symmetric
    Symmetrised,
    /// Products of r CUBSPL curves: r N evaluations for N wheels; symmetric, positive semi-definite, with the
    /// longitudinal force component
    Factored,
    /// Expressions as printed in McConville's paper, including their errors; for comparison only
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
    /// Model file: .bdf, .dat, .nas or .fem (NASTRAN bulk data), .msh (gmsh) or .inp (Abaqus)
    pub model: PathBuf,
    /// Output file [default: standard output]
    #[arg(short, long, value_name = "SPEC.json")]
    pub output: Option<PathBuf>,
    /// Length unit of the model (model files do not state one)
    #[arg(long)]
    pub length: Option<LengthArg>,
    /// Force unit of the model (NASTRAN and Abaqus files do not state one)
    #[arg(long)]
    pub force: Option<ForceArg>,
    /// Upward direction; required if rails are defined or members have no orientation
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true)]
    pub up: Option<[f64; 3]>,
    /// Define a rail by elements (12,23,30-35) or by an element set, optionally with /offset=X,Y,Z and /axis=X,Y,Z; may
    /// be repeated
    #[arg(long, value_name = "NAME=ELEMENTS")]
    pub rail: Vec<rail::RailRequest>,
    /// Restrain degrees of freedom of a node set, such as feet=ux,uy,uz; may be repeated
    #[arg(long, value_name = "SET=DOF")]
    pub fix: Vec<fix::SupportRequest>,
    /// File of materials and sections, assigned by physical group or element set
    #[arg(long, value_name = "FILE.json")]
    pub sections: Option<PathBuf>,
    /// Single-point constraint set (SPC) if case control selects none
    #[arg(long, value_name = "SET")]
    pub spc: Option<u64>,
    /// Cards, keywords or element types to ignore, such as CQUAD4,MPC
    #[arg(long, value_name = "CARDS", value_delimiter = ',')]
    pub skip: Vec<String>,
    /// Ignore and list data that do not affect static results, such as optimisation, aeroelasticity and damping
    #[arg(long)]
    pub skip_unused: bool,
    /// Mass distribution of NASTRAN elements [default: beams distributed, rods lumped unless PARAM COUPMASS is positive]
    #[arg(long, value_name = "WHERE")]
    pub mass: Option<MassArg>,
}

/// Words of the distribution of mass.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum MassArg {
    /// Lumped at the member ends
    Lumped,
    /// Distributed along the members
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
    /// Kip (1000 pounds-force)
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
    /// Output file [default: standard output]
    #[arg(short, long, value_name = "GRID.json")]
    pub output: Option<PathBuf>,
    /// Beam theory, overriding that of the spec
    #[arg(long)]
    pub theory: Option<TheoryArg>,
    /// Maximum relative rounding error; extended precision (double-double) is used where double precision cannot
    /// guarantee it
    #[arg(long, value_name = "BOUND", default_value_t = fea::DEFAULT_ACCURACY, value_parser = fraction)]
    pub accuracy: f64,
    /// Compute the N lowest natural modes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub modes: Option<u32>,
}

/// Parses a number between 0 and 1, both excluded.
fn fraction(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if value > 0.0 && value < 1.0 {
        Ok(value)
    } else {
        Err("must be greater than 0 and less than 1".to_owned())
    }
}

/// Words of the beam theories.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TheoryArg {
    /// Rigid in shear: plane sections remain normal to the axis
    EulerBernoulli,
    /// Flexible in shear: plane sections do not remain normal to the axis
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
    /// Output folder [default: girderway-out/NAME, where NAME is the name of the scene]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Overwrite files in the output folder that girderway did not write or that were modified since
    #[arg(long)]
    pub force: bool,
    /// Exit with status 1 if a check of a run fails; with `strict` also if nothing was checked or a check of the named code was not done
    #[arg(long, num_args = 0..=1, require_equals = true, default_missing_value = "limit", value_name = "WHEN")]
    pub fail_on_limit: Option<FailOnLimit>,
}

/// When a verdict fails a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FailOnLimit {
    /// A check failed.
    Limit,
    /// A check failed, there was nothing to check against, or a check of a named code was not done.
    Strict,
}
