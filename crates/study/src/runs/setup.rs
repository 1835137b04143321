//! Settings made ready to run any number of times.

use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};

use sim::{Foundation, Run};
use splines::Compliance;

use crate::Error;
use crate::measure::cpu;
use crate::measure::deviation::ComparedColumns;
use crate::measure::quantity::ErrorGroup;
use crate::settings::setting::Setting;
use crate::stations;
use formats::grid::GridRail;
use formats::scene::Scene;
use formats::scene::motion::{SimulationInput, simulation_input};
use formats::scene::quantity::quantities;
use foundations::{BuiltFoundation, ComputedModes, ModeCache, SolvedModel};
use foundations::{SolvedStructure, solution_of};
use results::cases::records_dofs;
use results::columns::NamedColumns;
use results::response;

/// Builds the foundations of settings, and caches modes and tables that several settings use.
pub struct SetupCache<'k> {
    known: &'k [SolvedStructure],
    /// Modes of each structure.
    modes: Vec<ModeCache>,
    /// Structures with grids at equal distances, by the number of stations of each rail.
    tables: Vec<(usize, Vec<SolvedStructure>)>,
}

/// A setting that is ready to run.
pub struct CaseSetup {
    scene: Scene,
    input: SimulationInput,
    foundations: Vec<Foundation>,
    /// Stations of each rail of the tables that are read; `None`: those of the specs.
    stations: Option<usize>,
    /// Thread time, s, that building the foundations took.
    pub setup: f64,
}

/// A setting that ran to its end, with the thread time, s, of its first run; `None` where it did not.
pub type TimedCase = Option<(CaseSetup, f64)>;

impl<'k> SetupCache<'k> {
    /// An empty cache for settings of `scene`.
    #[must_use]
    pub fn new(scene: &Scene, known: &'k [SolvedStructure]) -> SetupCache<'k> {
        let modes = scene
            .structures
            .iter()
            .map(|_| ModeCache::default())
            .collect();
        SetupCache {
            known,
            modes,
            tables: Vec::new(),
        }
    }

    /// Builds the foundations of a setting and makes it ready to run.
    ///
    /// # Errors
    /// A truck that cannot be simulated; foundations that cannot be built.
    pub fn set_up(&mut self, setting: &Setting) -> Result<CaseSetup, Error> {
        let start = cpu::seconds();
        let scene = setting.scene.clone();
        let input = simulation_input(&scene)?;
        let mut built = self.build(&scene, setting.stations)?;
        if setting.family.omits_residual() {
            for own in built
                .iter_mut()
                .filter(|own| own.foundation.structure.is_some())
            {
                own.foundation.compliance = None;
            }
        }
        let recorded = records_dofs(&scene, self.known);
        let mut foundations: Vec<Foundation> =
            built.into_iter().map(|own| own.foundation).collect();
        for (s, foundation) in foundations.iter_mut().enumerate() {
            foundation.recorded = recorded(s, foundation);
        }
        Ok(CaseSetup {
            scene,
            input,
            foundations,
            stations: setting.stations,
            setup: cpu::seconds() - start,
        })
    }

    /// The columns of a `run` of `case` that errors are measured in.
    ///
    /// # Errors
    /// A structure that is a mechanism.
    pub fn columns_of(&mut self, case: &CaseSetup, run: &Run) -> Result<ComparedColumns, Error> {
        let scene = &case.scene;
        let built = self.build(scene, case.stations)?;
        let known = self.known;
        let solved: Vec<Option<&SolvedModel>> = scene
            .structures
            .iter()
            .map(|structure| solution_of(known, &structure.origin))
            .collect();
        let lines = response::influence_lines(scene, &built, &solved)?;
        let mut record = NamedColumns::new(scene, &run.history);
        let added =
            response::add_all_columns(scene, &case.input, &run.history, &lines, &mut record);
        let own = quantities(scene).len();
        let mut columns = ComparedColumns {
            time: record.values("time").to_vec(),
            columns: Vec::new(),
        };
        for (index, column) in record.columns.into_iter().enumerate() {
            let is_reaction =
                index >= own && added[index - own].kind == formats::scene::columns::Kind::Reaction;
            if let Some(quantity) = ErrorGroup::of(&column, scene, index < own, is_reaction) {
                columns.columns.push((column.name, quantity, column.values));
            }
        }
        Ok(columns)
    }

    /// The foundations of `scene`, their tables at `stations` equal distances a rail where that is given.
    fn build(
        &mut self,
        scene: &Scene,
        stations: Option<usize>,
    ) -> Result<Vec<BuiltFoundation>, Error> {
        let lateral = scene.has_flanges();
        let at = stations.map(|count| self.table(count)).transpose()?;
        let known = at.map_or(self.known, |at| self.tables[at].1.as_slice());
        let each = scene.structures.iter().zip(&mut self.modes);
        let built = each
            .map(|(own, modes)| {
                foundations::build(modes, own, solution_of(known, &own.origin), lateral)
            })
            .collect::<Result<_, _>>()?;
        Ok(built)
    }

    /// Index in `tables` of the grids at `count` equally spaced stations of each rail.
    fn table(&mut self, count: usize) -> Result<usize, Error> {
        if let Some(at) = self.tables.iter().position(|(own, _)| *own == count) {
            return Ok(at);
        }
        let of = |known: &SolvedStructure| {
            Ok(SolvedStructure {
                spec: Arc::clone(&known.spec),
                solution: Arc::new(table(&known.solution, count)?),
            })
        };
        let all = self
            .known
            .iter()
            .map(of)
            .collect::<Result<Vec<SolvedStructure>, Error>>()?;
        self.tables.push((count, all));
        Ok(self.tables.len() - 1)
    }
}

/// The same structure with its grid at `count` equally spaced stations of each rail, from the exact surface.
fn table(solved: &SolvedModel, count: usize) -> Result<SolvedModel, Error> {
    let Some(surface) = &solved.surface else {
        return Err(Error::NoSurface);
    };
    let mut rails = solved.rails.clone();
    let mut named = Vec::new();
    for (rail, (given, known)) in rails.iter_mut().zip(&solved.grid.rails).enumerate() {
        let [low, high] = surface.range(rail).unwrap_or_default();
        given.stations = (0..count)
            .map(|i| low + (high - low) * i as f64 / (count - 1).max(1) as f64)
            .collect();
        named.push(GridRail {
            name: known.name.clone(),
            stations: given.stations.clone(),
        });
    }
    let grid = stations::at(&solved.grid, surface, named)?;
    Ok(SolvedModel {
        model: solved.model.clone(),
        rails,
        surface: Some(surface.clone()),
        grid,
        girder: solved.girder.clone(),
        size: None,
        modes: ComputedModes::default(),
        chords: OnceLock::new(),
    })
}

impl CaseSetup {
    /// Runs the setting once. `watch` receives the simulated time, s, and can stop the run.
    ///
    /// # Errors
    /// A scene that cannot start; a method that cannot integrate it.
    pub fn run(&self, watch: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<Run, sim::Error> {
        sim::run_by(
            self.scene.stepping,
            &self.input.scene,
            &self.foundations,
            watch,
        )
    }

    /// Degrees of freedom of all foundations; those of bodies do not count.
    #[must_use]
    pub fn dof_count(&self) -> usize {
        self.foundations.iter().map(Foundation::dofs).sum()
    }
}
