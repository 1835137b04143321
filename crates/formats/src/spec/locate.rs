//! Converts errors of the solver to the terms of the spec, with the place in the file that caused them.

use fea::{Dof, Error, ModelEntry};

use super::structure::{Form, Spec};
use crate::text::diagnostic::Diagnostic;
use crate::text::fault::{Basis, Fault, Faults};
use crate::text::number::{number, rounded};
use crate::text::place::{Path, Step};
use crate::text::source::Source;

/// The reason why the structure of a spec, or a design on it, has no solution, in the terms of its files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SolveError {
    /// An entry of the file is invalid.
    Input(Vec<Diagnostic>),
    /// There is no reliable solution: the structure is a mechanism, ill-conditioned, or too large for the memory.
    NoSolution(String),
}

impl Spec {
    /// Converts an error of the solver to the terms of the spec. An invalid entry is an input error with its place in
    /// `source`; a mechanism or an ill-conditioned system has no reliable solution.
    #[must_use]
    pub fn locate_error(&self, source: &Source, error: &Error) -> SolveError {
        match error {
            Error::Invalid { entry: item, fault } => {
                let fault = Fault {
                    path: self.path(*item),
                    at_key: false,
                    expected: fault.to_string(),
                    found: None,
                    hint: None,
                    basis: Basis::Several,
                };
                SolveError::Input(source.diagnose(&Faults(vec![fault])))
            }
            Error::Mechanism { point, dof } => SolveError::NoSolution(format!(
                "{}: mechanism: {} is not restrained in {dof} ({})",
                source.name,
                self.point_words(*point),
                meaning(*dof)
            )),
            Error::IllConditioned {
                condition,
                bound,
                asked,
                point,
                dof,
            } => SolveError::NoSolution(format!(
                "{}: the condition number {condition:.1e} permits a relative error of {bound:.1e}, above the accuracy \
                     of {asked:.1e}; the worst degree of freedom is {dof} of {} ({})  hint: lengthen or merge the \
                     shortest members, or specify a larger error with --accuracy",
                source.name,
                self.point_words(*point),
                meaning(*dof)
            )),
            Error::Released { member, end, dof } => SolveError::NoSolution(format!(
                "{}: mechanism: with its releases {} has no stiffness in {dof} at its end {}",
                source.name,
                self.path(ModelEntry::Member(*member)),
                if *end == 0 { "a" } else { "b" }
            )),
            Error::Buckled { factor, mode } => SolveError::NoSolution(format!(
                "{}: the structure buckles at {} times its preload: {}  hint: the factor is for axial forces only",
                source.name,
                number(rounded(*factor, 4)),
                self.buckling_words(mode)
            )),
            Error::Memory {
                quantity,
                bytes,
                most,
            } => SolveError::NoSolution(format!(
                "{}: the {quantity} would need {:.1} GB of memory, more than the permitted {:.1} GB  hint: {}",
                source.name,
                *bytes as f64 / 1e9,
                *most as f64 / 1e9,
                "shorten the rails to the travel of the wheels, or use fewer members"
            )),
            Error::NotFactorable { .. }
            | Error::NoEquilibrium { .. }
            | Error::NoRails
            | Error::Rail(_)
            | Error::NoMass
            | Error::TooManyModes { .. }
            | Error::Elements { .. }
            | Error::Modes { .. } => SolveError::NoSolution(format!("{}: {error}", source.name)),
        }
    }

    /// Place of an item of the model in the file.
    fn path(&self, item: ModelEntry) -> Path {
        let key = |word: &str| Step::Key(word.to_owned());
        let list = |word: &str, index: usize| Path(vec![key(word), Step::Index(index)]);
        match (&self.form, item) {
            (Form::Girder(_), ModelEntry::Span(index)) => {
                Path(vec![key("girder"), key("spans"), Step::Index(index)])
            }
            (Form::Girder(_), ModelEntry::Overhang(index)) => {
                Path(vec![key("girder"), key("overhangs"), Step::Index(index)])
            }
            (Form::Girder(_), ModelEntry::Station { station, .. }) => list("stations", station),
            (_, ModelEntry::Effect(index)) => list("effects", index),
            (_, ModelEntry::Preload) => Path(vec![key("preload")]),
            (_, ModelEntry::PreloadForce(index)) => {
                Path(vec![key("preload"), key("loads"), Step::Index(index)])
            }
            (Form::Girder(_), _) => Path(vec![key("girder")]),
            (Form::Frame(_), ModelEntry::Up) => Path(vec![key("up")]),
            (Form::Frame(_), ModelEntry::Point(index)) => list("points", index),
            (Form::Frame(_), ModelEntry::Section(index)) => list("sections", index),
            (Form::Frame(frame), ModelEntry::Support(index)) => list(
                "supports",
                frame.supports.get(index).copied().unwrap_or(index),
            ),
            (Form::Frame(_), ModelEntry::Spring(index)) => list("springs", index),
            (Form::Frame(_), ModelEntry::Link(index)) => list("links", index),
            (Form::Frame(_), ModelEntry::Mass(index)) => list("masses", index),
            (Form::Frame(frame), ModelEntry::Member(index)) => match frame.cells.get(index) {
                Some(&[block, cell]) => Path(vec![
                    key("cells"),
                    Step::Index(block),
                    key("data"),
                    Step::Index(cell),
                ]),
                None => Path(vec![key("cells")]),
            },
            (Form::Frame(_), ModelEntry::Rail(rail)) => self.rail_path(rail, None),
            (Form::Frame(_), ModelEntry::Segment { rail, segment }) => {
                self.rail_path(rail, Some(("segments", segment)))
            }
            (Form::Frame(_), ModelEntry::Station { rail, station }) => {
                self.rail_path(rail, Some(("stations", station)))
            }
            (
                Form::Frame(_),
                ModelEntry::Span(_) | ModelEntry::Overhang(_) | ModelEntry::Girder,
            ) => Path::default(),
        }
    }

    /// Place of a rail, or of an item in one of its lists.
    fn rail_path(&self, rail: usize, below: Option<(&str, usize)>) -> Path {
        let mut steps = vec![Step::Key("rails".to_owned())];
        if let Form::Frame(frame) = &self.form {
            steps.extend(
                frame
                    .rails
                    .get(rail)
                    .map(|(name, _)| Step::Key(name.clone())),
            );
        }
        if let Some((key, index)) = below {
            steps.extend([Step::Key(key.to_owned()), Step::Index(index)]);
        }
        Path(steps)
    }

    /// Description of a point in messages: index, set and coordinates, or for a girder its coordinate.
    pub(super) fn point_words(&self, index: usize) -> String {
        let unit = self.units.length.word();
        match &self.form {
            Form::Girder(girder) => match girder.model_and_rail() {
                Ok((model, _)) if index < model.points.len() => {
                    format!("the girder at x = {} {unit}", model.points[index][0])
                }
                _ => "the girder".to_owned(),
            },
            Form::Frame(frame) => {
                let place = frame.model.points.get(index).copied().unwrap_or_default();
                let set = frame
                    .point_sets
                    .iter()
                    .find(|(_, points)| points.contains(&index));
                let set = set.map_or_else(String::new, |(name, _)| format!(" of \"{name}\""));
                let kind = if index < frame.points {
                    format!("point {index}{set}")
                } else {
                    "an intermediate point".to_owned()
                };
                format!(
                    "{kind} at [{}, {}, {}] {unit}",
                    place[0], place[1], place[2]
                )
            }
        }
    }
}

/// Description of a degree of freedom.
const fn meaning(dof: Dof) -> &'static str {
    match dof {
        Dof::Ux => "displacement along x",
        Dof::Uy => "displacement along y",
        Dof::Uz => "displacement along z",
        Dof::Rx => "rotation about x",
        Dof::Ry => "rotation about y",
        Dof::Rz => "rotation about z",
    }
}
