//! Beam specs: read, checked, in the units asked for.

mod block;
mod cuts;
mod frame;
mod girder;
mod grounds;
mod locate;
mod members;
mod rails;
mod raw;
mod sections;
mod shape;
mod stress;
mod tapers;
#[cfg(test)]
mod tests;

use fea::{Girder, Model, Rail, Theory};

pub use cuts::{Cut, Spot};
pub use frame::Frame;
pub use grounds::Ground;
pub use locate::SolveError;
pub use stress::{Detail, StressPoint};

use crate::check::Check;
use crate::diagnostic::Diagnostic;
use crate::fault::{Fault, Faults};
use crate::place::Place;
use crate::source::Source;
use crate::track::Pad;
use crate::units::{Scale, Units};
pub(crate) use block::{Block, Reference};
pub(crate) use raw::{RawDetail, RawSpec};

/// The word of the format, with its version.
pub const FORMAT: &str = "girderway-beam/1";

/// Name of the one rail of the short form.
pub const GIRDER_RAIL: &str = "rail";

/// Words of the beam theories.
pub const THEORIES: [(&str, Theory); 2] =
    [("euler-bernoulli", Theory::EulerBernoulli), ("timoshenko", Theory::Timoshenko)];

/// The word of a theory in files.
#[must_use]
pub const fn theory_word(theory: Theory) -> &'static str {
    match theory {
        Theory::EulerBernoulli => "euler-bernoulli",
        Theory::Timoshenko => "timoshenko",
    }
}

/// A beam spec, checked and in the units asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// Its name; the file's where it gives none.
    pub name: String,
    /// Units of all its numbers.
    pub units: Units,
    /// How its beams take shear.
    pub theory: Theory,
    /// What it describes.
    pub form: Form,
    /// Sections where internal forces are asked for.
    pub effects: Vec<Cut>,
}

/// The two forms of a spec.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A straight girder, continuous over its supports.
    Girder(Girder),
    /// Points, members, what holds them, and rails.
    Frame(Frame),
}

/// A rail as a user knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct RailOutline {
    /// Its name within the structure.
    pub name: String,
    /// First and last coordinate.
    pub range: [f64; 2],
    /// Stations of its grid.
    pub stations: Vec<f64>,
}

impl Spec {
    /// Reads a spec and converts it to `target` (its own units where there is none).
    ///
    /// # Errors
    /// The first syntax or type error, or everything else that is wrong.
    pub fn read(source: &Source, target: Option<Units>) -> Result<Spec, Vec<Diagnostic>> {
        let raw: RawSpec = source.parse(FORMAT).map_err(|error| vec![*error])?;
        let mut faults = Faults::default();
        let spec = Spec::check(&raw, &source.name, target, &mut faults);
        match spec {
            Some(spec) if faults.0.is_empty() => Ok(spec),
            _ => Err(source.diagnose(&faults)),
        }
    }

    /// The straight girder; none where the spec is a frame.
    #[must_use]
    pub const fn girder(&self) -> Option<&Girder> {
        match &self.form {
            Form::Girder(girder) => Some(girder),
            Form::Frame(_) => None,
        }
    }

    /// What stands between rails and structure at ties; empty where there are none.
    #[must_use]
    pub fn pads(&self) -> &[Pad] {
        match &self.form {
            Form::Girder(_) => &[],
            Form::Frame(frame) => &frame.pads,
        }
    }

    /// The rails, in order.
    #[must_use]
    pub fn rails(&self) -> Vec<RailOutline> {
        match &self.form {
            Form::Girder(girder) => vec![RailOutline {
                name: GIRDER_RAIL.to_owned(),
                range: girder::range(girder),
                stations: girder.stations.clone(),
            }],
            Form::Frame(frame) => {
                let rails = frame.rails.iter().zip(&frame.ranges);
                let outline = |((name, rail), range): (&(String, Rail), &[f64; 2])| RailOutline {
                    name: name.clone(),
                    range: *range,
                    stations: rail.stations.clone(),
                };
                rails.map(outline).collect()
            }
        }
    }

    /// The model and rails to solve.
    ///
    /// # Errors
    /// A girder of numbers that no model can be made of.
    pub fn model(&self) -> Result<(Model, Vec<Rail>), fea::Error> {
        match &self.form {
            Form::Girder(girder) => girder.frame().map(|(model, rail)| (model, vec![rail])),
            Form::Frame(frame) => {
                Ok((frame.model.clone(), frame.rails.iter().map(|(_, rail)| rail.clone()).collect()))
            }
        }
    }

    /// The same structure under another theory.
    #[must_use]
    pub fn with_theory(mut self, theory: Theory) -> Spec {
        self.theory = theory;
        match &mut self.form {
            Form::Girder(girder) => girder.theory = theory,
            Form::Frame(frame) => frame.model.theory = theory,
        }
        self
    }

    fn check(raw: &RawSpec, file: &str, target: Option<Units>, faults: &mut Faults) -> Option<Spec> {
        let root = Place::root();
        format(&raw.format, FORMAT, &root, faults);
        let own = Units::read(&raw.units, &root, faults);
        let theory = match &raw.theory {
            Some(word) => faults.word(word, &root.key("theory"), &THEORIES).unwrap_or(Theory::Timoshenko),
            None => Theory::Timoshenko,
        };
        let any = Units { length: crate::units::Length::Metre, force: crate::units::Force::Newton };
        let from = own.unwrap_or(any);
        let to = target.filter(|_| own.is_some()).unwrap_or(from);
        let mut check = Check { faults, scale: Scale { from, to } };
        let (form, effects) = match &raw.girder {
            Some(girder) => {
                refuse_general(raw, &root, check.faults);
                let before = check.faults.0.len();
                let points = &girder.points;
                let girder = girder::read(girder, &raw.stations, theory, &root, &mut check);
                let sound = check.faults.0.len() == before;
                let points = stress::read(points, &root.key("girder"), &mut check);
                let effects = cuts::read_girder(raw, &girder, &points, sound, &root, &mut check);
                (Form::Girder(girder), effects)
            }
            None if raw.points.is_some() || raw.cells.is_some() => {
                let (frame, effects) = frame::read(raw, theory, &root, &mut check);
                (Form::Frame(frame), effects)
            }
            None => {
                let fault = Fault::new(&root, "must have a `girder`, or `points` and `cells`").got("neither");
                check
                    .faults
                    .add(fault.hint("`girder` is the short form, `points` and `cells` the general one"));
                return None;
            }
        };
        let name = raw.name.clone().unwrap_or_else(|| stem(file));
        Some(Spec { name, units: to, theory, form, effects })
    }
}

/// Keys of the general form beside `girder`.
fn refuse_general(raw: &RawSpec, root: &Place<'_>, faults: &mut Faults) {
    let general = [
        ("up", raw.up.is_some()),
        ("points", raw.points.is_some()),
        ("cells", raw.cells.is_some()),
        ("cell_data", raw.cell_data.is_some()),
        ("point_sets", raw.point_sets.is_some()),
        ("cell_sets", raw.cell_sets.is_some()),
        ("materials", raw.materials.is_some()),
        ("sections", raw.sections.is_some()),
        ("supports", raw.supports.is_some()),
        ("springs", raw.springs.is_some()),
        ("links", raw.links.is_some()),
        ("masses", raw.masses.is_some()),
        ("rails", raw.rails.is_some()),
        ("parts", raw.parts.is_some()),
    ];
    for (key, given) in general {
        if given {
            let fault = Fault::new(&root.key(key), format!("`{key}` cannot stand beside `girder`")).at_key();
            faults.add(
                fault.hint("a spec is either a short `girder` or the general form with `points` and `cells`"),
            );
        }
    }
}

/// Checks the member `format`.
pub fn format(found: &Option<String>, expected: &str, root: &Place<'_>, faults: &mut Faults) {
    if let Some(word) = faults.need(found, root, "format") {
        faults.word(word, &root.key("format"), &[(expected, ())]);
    }
}

/// The name of a file without folder and ending.
pub fn stem(file: &str) -> String {
    let path = std::path::Path::new(file);
    path.file_stem().map_or_else(|| file.to_owned(), |stem| stem.to_string_lossy().into_owned())
}
