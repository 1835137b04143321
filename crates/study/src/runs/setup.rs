//! A setting made ready to run, as often as wanted.

use std::ops::ControlFlow;
use std::sync::Arc;

use sim::{Foundation, Run};
use splines::Compliance;

use crate::Error;
use crate::measure::cpu;
use crate::measure::deviation::ComparedColumns;
use crate::measure::quantity::ErrorGroup;
use crate::settings::setting::Setting;
use crate::stations;
use formats::grid::GridRail;
use formats::motion::{Cast, cast};
use formats::quantity::quantities;
use formats::scene::Scene;
use foundations::{BuiltFoundation, ModeCache, SolvedModel};
use foundations::{SolvedStructure, solution_of};
use results::cases::records_structure;
use results::record::NamedColumns;
use results::response::{self, Response};

/// What makes settings ready: solved structures and modes that were found already.
pub struct SetupCache<'k> {
    known: &'k [SolvedStructure],
    spectra: Vec<ModeCache>,
    /// Tables by their stations a rail.
    tables: Vec<(usize, Vec<SolvedStructure>)>,
}

/// A setting made ready.
pub struct CaseSetup {
    scene: Scene,
    cast: Cast,
    foundations: Vec<Foundation>,
    /// Stations a rail of the tables.
    stations: Option<usize>,
    /// Seconds of thread time that it took to make the foundations.
    pub setup: f64,
}

impl<'k> SetupCache<'k> {
    /// For runs of `scene` and of what settings make of it.
    #[must_use]
    pub fn new(scene: &Scene, known: &'k [SolvedStructure]) -> SetupCache<'k> {
        let spectra = scene.structures.iter().map(|_| ModeCache::default()).collect();
        SetupCache { known, spectra, tables: Vec::new() }
    }

    /// Makes a setting ready.
    ///
    /// # Errors
    /// Foundations that cannot be made.
    pub fn set_up(&mut self, setting: &Setting) -> Result<CaseSetup, Error> {
        let start = cpu::seconds();
        let scene = setting.scene.clone();
        let cast = cast(&scene)?;
        let mut laid = self.build(&scene, setting.stations)?;
        if setting.family.is_pure() {
            for laid in laid.iter_mut().filter(|laid| laid.foundation.structure.is_some()) {
                laid.foundation.compliance = None;
            }
        }
        let recorded = records_structure(&scene, self.known);
        let mut foundations: Vec<Foundation> = laid.into_iter().map(|laid| laid.foundation).collect();
        for (s, foundation) in foundations.iter_mut().enumerate() {
            foundation.recorded = recorded(s, foundation);
        }
        Ok(CaseSetup { scene, cast, foundations, stations: setting.stations, setup: cpu::seconds() - start })
    }

    /// The columns of a run that errors are measured in.
    ///
    /// # Errors
    /// A structure that does not stand.
    pub fn columns_of(&mut self, rig: &CaseSetup, run: &Run) -> Result<ComparedColumns, Error> {
        let scene = &rig.scene;
        let laid = self.build(scene, rig.stations)?;
        let known = self.known;
        let solved: Vec<Option<&SolvedModel>> =
            scene.structures.iter().map(|structure| solution_of(known, &structure.origin)).collect();
        let lines = response::lines(scene, &laid, &solved)?;
        let mut record = NamedColumns::new(scene, &run.history);
        let response = Response::new(scene, &rig.cast, &run.history, &laid, &solved, &lines, &mut record)?;
        let own = quantities(scene).len();
        let mut trace = ComparedColumns { time: record.values("time").to_vec(), columns: Vec::new() };
        for (index, column) in record.columns.into_iter().enumerate() {
            let is_reaction =
                index >= own && response.columns[index - own].kind == formats::scene::columns::Kind::Reaction;
            if let Some(quantity) = ErrorGroup::of(&column, scene, index < own, is_reaction) {
                trace.columns.push((column.name, quantity, column.values));
            }
        }
        Ok(trace)
    }

    fn build(&mut self, scene: &Scene, stations: Option<usize>) -> Result<Vec<BuiltFoundation>, Error> {
        let lateral = scene.pushes_sideways();
        let at = stations.map(|count| self.table(count)).transpose()?;
        let known = at.map_or(self.known, |at| self.tables[at].1.as_slice());
        let each = scene.structures.iter().zip(&mut self.spectra);
        let laid = each
            .map(|(own, spectra)| foundations::build(spectra, own, solution_of(known, &own.origin), lateral))
            .collect::<Result<_, _>>()?;
        Ok(laid)
    }

    /// Index of the grids at `count` even stations a rail.
    fn table(&mut self, count: usize) -> Result<usize, Error> {
        if let Some(at) = self.tables.iter().position(|(own, _)| *own == count) {
            return Ok(at);
        }
        let of = |known: &SolvedStructure| {
            Ok(SolvedStructure { spec: Arc::clone(&known.spec), solution: table(&known.solution, count)? })
        };
        let all = self.known.iter().map(of).collect::<Result<Vec<SolvedStructure>, Error>>()?;
        self.tables.push((count, all));
        Ok(self.tables.len() - 1)
    }
}

/// The same structure with grids at `count` even stations a rail.
fn table(solved: &SolvedModel, count: usize) -> Result<SolvedModel, Error> {
    let Some(surface) = &solved.surface else {
        return Err(Error::NoSurface);
    };
    let mut rails = solved.rails.clone();
    let mut named = Vec::new();
    for (rail, (given, known)) in rails.iter_mut().zip(&solved.grid.rails).enumerate() {
        let [low, high] = surface.range(rail).unwrap_or_default();
        given.stations =
            (0..count).map(|i| low + (high - low) * i as f64 / (count - 1).max(1) as f64).collect();
        named.push(GridRail { name: known.name.clone(), stations: given.stations.clone() });
    }
    let grid = stations::at(&solved.grid, surface, named)?;
    Ok(SolvedModel {
        model: solved.model.clone(),
        rails,
        surface: Some(surface.clone()),
        grid,
        girder: solved.girder.clone(),
        size: None,
    })
}

impl CaseSetup {
    /// Runs it once. `watch` sees the time reached, and may stop the run.
    ///
    /// # Errors
    /// A scene that cannot start; a method that does not suit it.
    pub fn run(&self, watch: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<Run, sim::Error> {
        sim::run_by(self.scene.stepping, &self.cast.scene, &self.foundations, watch)
    }

    /// Freedoms of bodies aside, how many the foundations have.
    #[must_use]
    pub fn dof_count(&self) -> usize {
        self.foundations.iter().map(Foundation::freedoms).sum()
    }
}
