//! Reads a beam spec: detects which of the two forms it has, and reports all its faults.

use fea::BeamTheory;

use super::raw::RawSpec;
use super::references::Points;
use super::structure::{Form, Spec};
use super::words::THEORIES;
use super::{cuts, frame, girder, incomplete, notes, outline, preload, stress};
use crate::check::Check;
use crate::text::diagnostic::Diagnostic;
use crate::text::fault::{Fault, Faults};
use crate::text::names::check_free_name;
use crate::text::place::Place;
use crate::text::source::Source;
use crate::units::{Scale, Units};

/// Value of the member `format`: name and version of the format.
pub const FORMAT: &str = "girderway-beam/1";

impl Spec {
    /// Reads a spec and converts it to the units `target`, or keeps its own units if that is `None`.
    ///
    /// # Errors
    /// All faults of the file, each with its place.
    pub fn read(source: &Source, target: Option<Units>) -> Result<Spec, Vec<Diagnostic>> {
        source.read(FORMAT, |raw: &RawSpec, faults| {
            Spec::check(raw, &source.name, target, faults)
        })
    }

    fn check(
        raw: &RawSpec,
        file: &str,
        target: Option<Units>,
        faults: &mut Faults,
    ) -> Option<Spec> {
        let root = Place::root();
        format(&raw.format, FORMAT, &root, faults);
        let own = Units::read(&raw.units, &root, faults);
        let theory = match &raw.theory {
            Some(word) => faults
                .one_of(word, &root.key("theory"), &THEORIES)
                .unwrap_or(BeamTheory::Timoshenko),
            None => BeamTheory::Timoshenko,
        };
        // without units the numbers are checked in an arbitrary system of units
        let from = own.unwrap_or(Units::SI);
        let to = target.filter(|_| own.is_some()).unwrap_or(from);
        let mut check = Check {
            faults,
            scale: Scale { from, to },
        };
        let (form, effects, preload) = match &raw.girder {
            Some(girder) => {
                refuse_general(raw, &root, check.faults);
                let before = check.faults.0.len();
                let points = &girder.points;
                let girder = girder::read(girder, &raw.stations, theory, &root, &mut check);
                let faultless = check.faults.0.len() == before;
                let points = stress::read(points, &root.key("girder"), &mut check);
                let effects =
                    cuts::read_girder(raw, &girder, &points, faultless, &root, &mut check);
                let places = girder.model_and_rail().map_or_else(
                    |_| Vec::new(),
                    |(model, _)| model.points.iter().map(|point| point[0]).collect(),
                );
                let has_mass = girder.mass_per_length.is_some_and(|mass| mass > 0.0);
                let known = Points {
                    count: 0,
                    sets: &[],
                };
                let preload =
                    preload::read(raw, &root, Some(&places), &known, has_mass, &mut check);
                (Form::Girder(girder), effects, preload)
            }
            None if raw.points.is_some() || raw.cells.is_some() => {
                let (frame, effects, preload) = frame::read(raw, theory, &root, &mut check);
                (Form::Frame(frame), effects, preload)
            }
            None => {
                let fault = Fault::new(&root, "must have a `girder`, or `points` and `cells`")
                    .got("neither");
                check.faults.add(
                    fault.hint("`girder` is the short form, `points` and `cells` the general one"),
                );
                return None;
            }
        };
        if let Some(name) = &raw.name {
            check_free_name(name, &root.key("name"), check.faults);
        }
        let name = raw.name.clone().unwrap_or_else(|| stem(file));
        let outlines = match &raw.girder {
            Some(girder) => vec![outline::of_girder(girder, &root.key("girder"), &mut check)],
            None => outline::of_sections(raw.tables(), &root, &mut check),
        };
        let (notes, incomplete) = if check.faults.0.is_empty() {
            (notes::of(raw, from), incomplete::of(raw, &form, from))
        } else {
            Default::default()
        };
        let crane_rails = outline::crane_rails(raw);
        Some(Spec {
            name,
            units: to,
            theory,
            form,
            effects,
            notes,
            incomplete,
            outlines,
            crane_rails,
            preload,
        })
    }
}

/// Rejects keys of the general form in a spec that has a `girder`.
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
            let fault = Fault::new(
                &root.key(key),
                format!("`{key}` cannot be combined with `girder`"),
            )
            .at_key();
            faults.add(fault.hint(
                "a spec is either a short `girder` or the general form with `points` and `cells`",
            ));
        }
    }
}

/// Checks that the member `format` is present and equal to `expected`.
pub fn format(found: &Option<String>, expected: &str, root: &Place<'_>, faults: &mut Faults) {
    match found {
        Some(word) => faults.check_format(word, &root.key("format"), expected),
        None => {
            let fault = Fault::new(root, "missing key `format`").of_value();
            faults.add(fault.hint(format!("such as \"format\": \"{expected}\"")));
        }
    }
}

/// The name of a file without folder and extension.
pub fn stem(file: &str) -> String {
    let path = std::path::Path::new(file);
    path.file_stem().map_or_else(
        || file.to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}
