//! The ends of spans in the planes of deflections.

use fea::{Model, Rail};
use formats::design::Design;
use formats::spec::{Form, Spec};
use splines::Compliance;
use trains::{Error, Structure, SupportedEnds, supported_ends};

/// The planes of deflections, in words.
pub(crate) const PLANES: [&str; 2] = ["vertical", "lateral"];

/// The ends of the spans of all rails of a spec by plane (vertical, lateral); `surface` is that of its solution. Supports of
/// the short form of a spec hold both planes.
///
/// # Errors
/// Those of [`supported_ends`].
pub fn plane_ends(
    spec: &Spec,
    model: &Model,
    rails: &[Rail],
    surface: &dyn Compliance,
) -> Result<Vec<[SupportedEnds; 2]>, Error> {
    let candidates = spec.rail_spans(model, rails);
    if matches!(spec.form, Form::Girder(_)) {
        let both = candidates
            .iter()
            .map(|ends| [0, 1].map(|_| SupportedEnds::all_firm(ends)));
        return Ok(both.collect());
    }
    supported_ends(model, rails, surface, &candidates)
}

/// The ends of the spans of all rails of a spec, by rail and plane.
#[derive(Clone, Debug)]
pub(crate) struct PlaneSpans(Vec<[SupportedEnds; 2]>);

impl PlaneSpans {
    /// The spans of a spec; `structure` is its solution.
    ///
    /// # Errors
    /// Those of [`plane_ends`].
    pub fn new(
        spec: &Spec,
        model: &Model,
        rails: &[Rail],
        structure: &Structure,
    ) -> Result<PlaneSpans, Error> {
        let surface = structure.frame().surface()?.surface;
        plane_ends(spec, model, rails, &surface).map(PlaneSpans)
    }

    /// The chords of a design: those that it gives, otherwise those of the spec.
    pub fn chords(&self, design: &Design) -> Chords {
        let mut chords = Chords::default();
        for (rail, own) in self.0.iter().enumerate() {
            for (plane, found) in own.iter().enumerate() {
                let mut firm = None;
                let ends = if design.are_spans_given[rail] {
                    design.spans[rail].clone()
                } else if found.has_elastic_bed {
                    chords.undefined.push((plane, rail, ELASTIC_BED));
                    Vec::new()
                } else if found.ends.len() < 2 {
                    chords.undefined.push((plane, rail, NO_SUPPORTS));
                    Vec::new()
                } else {
                    firm = (found.firm != found.ends && found.firm.len() >= 2)
                        .then(|| found.firm.clone());
                    found.ends.clone()
                };
                chords.has_soft_supports |= firm.is_some();
                chords.firm[plane].push(firm.unwrap_or_else(|| ends.clone()));
                chords.ends[plane].push(ends);
            }
        }
        chords
    }
}

/// Why a girder on springs has no spans.
const ELASTIC_BED: &str = "the girder rests on supports that are less stiff than itself, so that its spans are not \
                           defined; specify `spans`";
/// Why a girder without supports in a plane has no spans.
const NO_SUPPORTS: &str = "fewer than two supports are known in this plane; specify `spans`";

/// Coordinates of the ends of the spans, from which deflections are measured.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chords {
    /// By plane (vertical, lateral) and rail; empty where spans are not defined.
    pub ends: [Vec<Vec<f64>>; 2],
    /// The same without soft supports, which deflect with the girder.
    pub firm: [Vec<Vec<f64>>; 2],
    /// Whether any of these differ.
    pub has_soft_supports: bool,
    /// Plane and rail without spans, with the reason.
    pub undefined: Vec<(usize, usize, &'static str)>,
}
