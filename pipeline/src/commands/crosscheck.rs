//! `girderway crosscheck`: comparison of a structure with independent FE codes.

use fea::{BeamTheory, Girder};
use serde_json::{Value, json};

use crate::cli::{CrosscheckArgs, Global};
use crate::crosscheck::{
    self, Environment, Error, Peer, PeerComparison, PeerOutcome, PlainGrid, Station, plot,
};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::grid::block::GridBlock;
use formats::spec::{Form, Spec, theory_word};
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::Inputs;
use formats::text::source::Source;
use formats::units::Dimension;
use outputs::files::json as json_text;
use outputs::folder::{OutputFolder, PlannedFiles};
use outputs::manifest::Manifest;

/// Ratio of effective shear area to area of a solid rectangle.
const RECTANGLE: f64 = 5.0 / 6.0;

/// Solves the spec with this program and with every code that supports it, and compares all grids entry by entry.
///
/// # Errors
/// The spec is invalid, the structure is a mechanism, the Python environment cannot be created, or a file cannot be
/// written. Differences are not errors: they determine the exit status.
pub fn run(args: &CrosscheckArgs, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let (inputs, source) = Inputs::open(&args.spec).map_err(|error| Failure::from(*error))?;
    let mut spec = Spec::read(&source, None)?;
    if let Some(theory) = args.theory {
        spec = spec.with_theory(theory.into());
    }
    for note in &spec.notes {
        progress.say(&format!("note: {note}"));
    }
    let planned = PlannedFiles {
        names: vec!["crosscheck.json".to_owned(), "crosscheck.txt".to_owned()],
        plots: vec!["difference-".to_owned()],
    };
    let open = |path| OutputFolder::open(path, "crosscheck", args.force, &planned);
    let folder = args.output.as_deref().map(open).transpose()?;
    let mut check = Check::new(&source, spec)?;
    let mut result = PeerComparison {
        rails: check.rails(),
        ..PeerComparison::default()
    };
    let bar = progress.bar("comparing", Peer::ALL.len() as u64);
    for (done, peer) in Peer::ALL.into_iter().enumerate() {
        bar.set(done as u64);
        if peer.straight() && !matches!(check.spec.form, Form::Girder(_)) {
            let why = "supports straight girders only (short form of a spec)".to_owned();
            result.absent.push((peer, why));
            continue;
        }
        if check.spec.preload.is_some() && !peer.takes_preload() {
            result.absent.push((
                peer,
                "does not support the axial forces of a preload".to_owned(),
            ));
            continue;
        }
        bar.name(&format!("comparing with {}", peer.name()));
        match check.compare(peer, &progress)? {
            Ok(outcome) => result.outcomes.push(outcome),
            Err(why) => result.absent.push((peer, why)),
        }
    }
    drop(bar);
    let text = if global.json {
        json_text(&result.json())
    } else {
        result.table()
    };
    output::print(&text)?;
    if let Some(mut folder) = folder {
        fill(&mut folder, &result, &check.spec)?;
        let settings = json!({ "theory": theory_word(check.spec.theory) });
        let written = folder.commit(Manifest::new("crosscheck", &inputs, settings))?;
        progress.say(&format!("wrote {}", written.display()));
    }
    Ok(if result.agrees() {
        Exit::Done
    } else {
        Exit::Differs
    })
}

/// A spec, its source and the environment of the other codes.
struct Check<'a> {
    source: &'a Source,
    /// The spec as JSON in numbers, which the other codes read, or why it cannot be written so.
    raw: Result<Value, String>,
    spec: Spec,
    environment: Environment,
}

/// Influence grids of a spec at its stations.
type Grids = Vec<(GridBlock, PlainGrid)>;

impl<'a> Check<'a> {
    fn new(source: &'a Source, spec: Spec) -> Result<Self, Failure> {
        let raw = serde_json::from_str(&source.text)
            .map_err(|error| Diagnostic::of_file(&source.name, error.to_string()))?;
        let raw = crosscheck::in_numbers(raw, &spec);
        Ok(Check {
            source,
            raw,
            spec,
            environment: Environment::of_user().map_err(|e| broken(&e))?,
        })
    }

    fn rails(&self) -> Vec<String> {
        self.spec
            .rails()
            .into_iter()
            .map(|rail| rail.name)
            .collect()
    }

    fn stations(&self) -> Vec<Station> {
        let rails = self.spec.rails().into_iter().enumerate();
        rails
            .flat_map(|(rail, outline)| outline.stations.into_iter().map(move |x| (rail, x)))
            .collect()
    }

    fn solve(&self, spec: &Spec) -> Result<Grids, Failure> {
        let solved =
            foundations::solve(spec).map_err(|error| spec.locate_error(self.source, &error))?;
        let block = |block: &nalgebra::DMatrix<f64>| {
            block
                .row_iter()
                .map(|row| row.iter().copied().collect())
                .collect::<PlainGrid>()
        };
        Ok(solved
            .grid
            .blocks
            .iter()
            .map(|(quantity, values)| (*quantity, block(values)))
            .collect())
    }

    /// Compares with one code. The inner error is the reason why this code does not support the structure.
    fn compare(
        &mut self,
        peer: Peer,
        progress: &Progress,
    ) -> Result<Result<PeerOutcome, String>, Failure> {
        let theory = peer.theory(self.spec.theory);
        let mut spec = self.spec.clone().with_theory(theory);
        let mut notes = Vec::new();
        if peer == Peer::Solid {
            notes.extend(sheared(&mut spec));
        }
        let ours = self.solve(&spec)?;
        let stations = self.stations();
        let mut say = |message: &str| progress.say(message);
        let outcome = match (&spec.form, peer) {
            (Form::Girder(girder), Peer::ScikitFem) => {
                let girder = stiffnesses(girder);
                let checked = girder.check();
                checked.and_then(|()| {
                    crosscheck::ask(peer, &girder, &ours, &stations, &self.environment, &mut say)
                })
            }
            _ => {
                let raw = match &self.raw {
                    Ok(raw) => raw,
                    Err(why) => return Ok(Err(why.clone())),
                };
                let question = json!({ "spec": raw, "theory": theory_word(theory) });
                crosscheck::ask(
                    peer,
                    &question,
                    &ours,
                    &stations,
                    &self.environment,
                    &mut say,
                )
            }
        };
        let mut outcome = match outcome {
            Ok(outcome) => outcome,
            Err(Error::Refused(why)) => return Ok(Err(why)),
            Err(error) => return Err(broken(&error)),
        };
        outcome.theory = Some(theory_word(theory));
        if theory != self.spec.theory {
            let word = theory_word(self.spec.theory);
            outcome.notes.push(format!(
                "both computed with {}; the theory of the spec is {word}",
                theory_word(theory)
            ));
        }
        if peer == Peer::Solid {
            let plain = self.solve(&self.spec.clone().with_theory(BeamTheory::EulerBernoulli))?;
            let list: Vec<String> = crosscheck::again(&outcome, &plain)
                .iter()
                .filter(|d| d.quantity.direct() == [d.quantity; 2])
                .map(|d| format!("{} {:.1e}", d.quantity, d.relative))
                .collect();
            notes.push(format!(
                "for information: Euler-Bernoulli beams differ by {}",
                list.join(", ")
            ));
        }
        outcome.notes.extend(notes);
        Ok(Ok(outcome))
    }
}

/// Sets missing shear areas of a girder to those of a solid rectangle; returns a note if any was missing.
fn sheared(spec: &mut Spec) -> Option<String> {
    let Form::Girder(girder) = &mut spec.form else {
        return None;
    };
    let (area, _) = girder.area.zip(girder.g)?;
    let absent = girder.ka_vertical.is_none() || girder.ka_lateral.is_none();
    girder.ka_vertical.get_or_insert(RECTANGLE * area);
    girder.ka_lateral.get_or_insert(RECTANGLE * area);
    absent.then(|| {
        "shear areas not given in the spec are taken as 5/6 A (rectangular section)".to_owned()
    })
}

/// Creates the failure of another code or of its environment.
fn broken(error: &Error) -> Failure {
    let hint = "first use requires Python 3.11 or newer with venv and access to PyPI; later uses need no network. Other commands are not affected";
    Diagnostic::of_file("python3", format!("nothing compared: {error}"))
        .hint(hint)
        .into()
}

/// Adds the files of the output folder: the result as JSON and as text, and charts of the differences.
fn fill(folder: &mut OutputFolder, result: &PeerComparison, spec: &Spec) -> Result<(), Failure> {
    folder.add("crosscheck.json", json_text(&result.json()));
    folder.add("crosscheck.txt", result.table());
    let unit = spec.units.label(Dimension::LENGTH);
    for outcome in &result.outcomes {
        let charts = plot::charts(outcome, &result.rails, &unit);
        let many = charts.len() > 1;
        for (index, chart) in charts.iter().enumerate() {
            let name = outcome.peer.name();
            let file = if many {
                format!("plots/difference-{name}-{}.svg", index + 1)
            } else {
                format!("plots/difference-{name}.svg")
            };
            let svg = chart
                .svg()
                .map_err(|error| Failure::Untrusted(error.to_string()))?;
            folder.add(&file, svg.file());
        }
    }
    Ok(())
}

/// Converts a girder to products of moduli and section properties.
fn stiffnesses(girder: &Girder) -> crosscheck::PlainGirder {
    let sheared = girder.theory == BeamTheory::Timoshenko;
    let shear = |area: Option<f64>| {
        area.zip(girder.g)
            .filter(|_| sheared)
            .map(|(area, g)| g * area)
    };
    crosscheck::PlainGirder {
        spans: girder.spans.clone(),
        overhangs: girder.overhangs,
        stations: girder.stations.clone(),
        rail_height: girder.rail_height,
        axial: girder.area.map(|area| girder.e * area),
        bending_vertical: Some(girder.e * girder.i_vertical),
        bending_lateral: girder.i_lateral.map(|moment| girder.e * moment),
        torsion: girder.j.zip(girder.g).map(|(j, g)| g * j),
        shear_vertical: shear(girder.ka_vertical),
        shear_lateral: shear(girder.ka_lateral),
    }
}
