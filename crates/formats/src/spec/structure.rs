//! A checked beam spec: a structure with its rails and user-defined names, as plain values.

use std::sync::Arc;

use fea::{
    BeamTheory, EntryFault, FactoredFrame, Girder, Member, MemberKind, Model, ModelEntry, Rail,
};

use super::cuts::Cut;
use super::outline::{MemberOutline, OutlinedMember, SectionOutline, SpecCraneRail};
use super::preload::SpecPreload;
use crate::units::Units;
use crate::verdict::OmittedCheck;

/// Name of the only rail of the short form.
pub const GIRDER_RAIL: &str = "rail";

/// A beam spec, checked and in the requested units.
///
/// ```
/// use formats::text::source::Source;
/// use formats::spec::Spec;
/// use formats::units::Units;
///
/// let text = r#"{"format": "girderway-beam/1", "units": {"length": "ft", "force": "lbf", "time": "s"},
///  "girder": {"spans": [60, 60], "E": 4.176e9, "I_vertical": 2.5}, "stations": [0, 30, 60]}"#;
/// let source = Source { name: "girder.json".to_owned(), text: text.to_owned() };
/// let spec = Spec::read(&source, Some(Units::SI)).expect("a girder over two spans");
/// assert_eq!(spec.name, "girder");
/// assert_eq!(spec.rails()[0].range, [0.0, 36.576]);
///
/// let wrong = Source { text: text.replace("[60, 60]", "[60, -60]"), ..source };
/// let faults = Spec::read(&wrong, None).expect_err("a span of negative length");
/// assert_eq!(faults[0].path, "girder.spans[1]");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// Its name; by default the name of the file without its extension.
    pub name: String,
    /// Units of all its numbers.
    pub units: Units,
    /// Beam theory, with or without shear deformation.
    pub theory: BeamTheory,
    /// The structure.
    pub form: Form,
    /// Sections of members whose internal forces are requested.
    pub effects: Vec<Cut>,
    /// Numbers that follow from names of rolled sections and crane rails, and defaults of steel, for the user to check, in words and in the
    /// units of the file.
    pub notes: Vec<String>,
    /// Results that follow from half an input, such as a weight without density, with what is missing.
    pub incomplete: Vec<OmittedCheck>,
    /// Shapes and strengths of the sections, in the order of the file; one for the short form.
    pub outlines: Vec<SectionOutline>,
    /// Crane rails by rail; empty where the rails are those of ties.
    pub crane_rails: Vec<Option<SpecCraneRail>>,
    /// Forces under which the structure is at rest; the model is that about this state.
    pub preload: Option<SpecPreload>,
}

/// The two forms of a spec.
#[derive(Clone, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "there are few specs, and most have the general form"
)]
pub enum Form {
    /// A straight girder, continuous over its supports.
    Girder(Girder),
    /// The general form: points, members, supports and springs, and rails.
    Frame(FrameSpec),
}

/// A rail in the terms of the user: its name, extent and stations.
#[derive(Clone, Debug, PartialEq)]
pub struct RailOutline {
    /// Its name within the structure.
    pub name: String,
    /// First and last coordinate, in length.
    pub range: [f64; 2],
    /// Coordinates of the stations of its influence grid, increasing.
    pub stations: Vec<f64>,
}

/// The checked general form, in the requested units: the model with the names of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameSpec {
    /// Points, members, supports, springs, links and masses.
    pub model: Model,
    /// Rails with their names, in the order of the file.
    pub rails: Vec<(String, Rail)>,
    /// First and last coordinate of each rail, in length.
    pub ranges: Vec<[f64; 2]>,
    /// Names of the sections.
    pub sections: Vec<String>,
    /// Number of points in the file. In the model they are followed by the points between the parts of tapered
    /// members.
    pub points: usize,
    /// Block of `cells` and index in it for each member. The parts of a tapered cell have the same entry.
    pub cells: Vec<[usize; 2]>,
    /// Named sets of points.
    pub point_sets: Vec<(String, Vec<usize>)>,
    /// Index of the corresponding support in the file for each support of the model, except the supports of ties.
    pub supports: Vec<usize>,
    /// Pads between rail and structure, if ties carry the rail.
    pub pads: Vec<Pad>,
    /// Section of the file that each member has; empty where ties have split the members.
    pub member_outlines: Vec<MemberOutline>,
}

/// The pad between a rail and its base at one tie. Its damper acts between the two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pad {
    /// Index of the point of the rail.
    pub rail: usize,
    /// Index of the point of the structure, and the rigid arm from it to the pad; `None` if the base is the ground.
    pub base: Option<(usize, [f64; 3])>,
    /// Direction of the damper, a unit vector.
    pub up: [f64; 3],
}

impl Spec {
    /// The straight girder; `None` if the spec has the general form.
    #[must_use]
    pub const fn girder(&self) -> Option<&Girder> {
        match &self.form {
            Form::Girder(girder) => Some(girder),
            Form::Frame(_) => None,
        }
    }

    /// The pads between rails and structure; empty if there are no ties.
    #[must_use]
    pub fn pads(&self) -> &[Pad] {
        match &self.form {
            Form::Girder(_) => &[],
            Form::Frame(frame) => &frame.pads,
        }
    }

    /// Shape and strength of the section of a member, and how the member tapers; `None` for members that the file does not have.
    #[must_use]
    pub fn outline(&self, member: usize) -> Option<OutlinedMember<'_>> {
        match &self.form {
            Form::Girder(_) => Some(OutlinedMember {
                section: self.outlines.first()?,
                taper: None,
            }),
            Form::Frame(frame) => {
                let own = frame.member_outlines.get(member)?;
                let taper = match own.taper {
                    Some((other, stretch)) => Some((self.outlines.get(other)?, stretch)),
                    None => None,
                };
                Some(OutlinedMember {
                    section: self.outlines.get(own.section)?,
                    taper,
                })
            }
        }
    }

    /// Whether anything of the structure has mass.
    #[must_use]
    pub fn has_mass(&self) -> bool {
        match &self.form {
            Form::Girder(girder) => girder.mass_per_length.is_some_and(|mass| mass > 0.0),
            Form::Frame(FrameSpec { model, .. }) => has_mass(model),
        }
    }

    /// The rails, in the order of the file.
    #[must_use]
    pub fn rails(&self) -> Vec<RailOutline> {
        match &self.form {
            Form::Girder(girder) => vec![RailOutline {
                name: GIRDER_RAIL.to_owned(),
                range: range(girder),
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

    /// The model and its rails, as `fea::FactoredFrame::new` requires them: with a preload the model about its state.
    ///
    /// # Errors
    /// A girder from whose numbers no model can be built; a preload without a state; a cable without preload.
    pub fn model(&self) -> Result<(Model, Vec<Rail>), fea::Error> {
        let (model, rails) = self.unloaded_model()?;
        if let Some(preload) = &self.preload {
            return Ok((preload.state(&model, &rails)?.model.clone(), rails));
        }
        match model
            .members
            .iter()
            .position(|member| member.kind == MemberKind::Cable)
        {
            Some(member) => Err(fea::Error::Invalid {
                entry: ModelEntry::Member(member),
                fault: EntryFault::Slack { tension: 0.0 },
            }),
            None => Ok((model, rails)),
        }
    }

    /// The model, its rails and their factored stiffness, with the accuracy [`fea::DEFAULT_ACCURACY`].
    ///
    /// # Errors
    /// As [`Spec::model`] and [`FactoredFrame::new`].
    pub fn factored(&self) -> Result<(Model, Vec<Rail>, Arc<FactoredFrame>), fea::Error> {
        let (model, rails) = self.model()?;
        let frame = match &self.preload {
            // The search for the state has factored it.
            Some(preload) => {
                let (unloaded, _) = self.unloaded_model()?;
                Arc::clone(&preload.state(&unloaded, &rails)?.frame)
            }
            None => Arc::new(FactoredFrame::new(&model, &rails)?),
        };
        Ok((model, rails, frame))
    }

    /// The model without preload, and its rails.
    ///
    /// # Errors
    /// A girder from whose numbers no model can be built.
    pub fn unloaded_model(&self) -> Result<(Model, Vec<Rail>), fea::Error> {
        match &self.form {
            Form::Girder(girder) => girder
                .model_and_rail()
                .map(|(model, rail)| (model, vec![rail])),
            Form::Frame(frame) => Ok((
                frame.model.clone(),
                frame.rails.iter().map(|(_, rail)| rail.clone()).collect(),
            )),
        }
    }

    /// Returns the same structure with a different beam theory.
    #[must_use]
    pub fn with_theory(mut self, theory: BeamTheory) -> Spec {
        self.theory = theory;
        match &mut self.form {
            Form::Girder(girder) => girder.theory = theory,
            Form::Frame(frame) => frame.model.theory = theory,
        }
        self
    }
}

/// Whether anything of a model has mass.
pub(super) fn has_mass(model: &Model) -> bool {
    let mass = |member: &Member| {
        model
            .sections
            .get(member.section)
            .is_some_and(|section| section.mass > 0.0)
    };
    model.masses.iter().any(|point| point.mass > 0.0) || model.members.iter().any(mass)
}

/// First and last rail coordinate of a girder.
pub(super) fn range(girder: &Girder) -> [f64; 2] {
    [
        -girder.overhangs[0],
        girder.spans.iter().sum::<f64>() + girder.overhangs[1],
    ]
}
