//! The ends of the spans of rails in the planes of deflections.

use design::plane_ends;
use formats::scene::{Origin, Scene};
use foundations::{RailChords, SolvedModel};
use trains::SupportedEnds;

/// Chords of each rail of the scene by plane (vertical, lateral): between the coordinates that the scene gives, otherwise
/// between the supports of the plane ([`plane_ends`]), and between its firm supports where these are others. None where a
/// rail has no spans: on an elastic bed, without two supports, and without a solution. They are kept with the structure.
pub fn plane_spans(scene: &Scene, solved: &[Option<&SolvedModel>]) -> Vec<RailChords> {
    let of_structure = |s: usize| -> &[RailChords] {
        let (Origin::Spec { spec, .. }, Some(solved)) = (&scene.structures[s].origin, solved[s])
        else {
            return &[];
        };
        solved.chords.get_or_init(|| {
            let surface = solved.surface.as_ref();
            let found = surface
                .and_then(|surface| plane_ends(spec, &solved.model, &solved.rails, surface).ok());
            let found = found.unwrap_or_default().into_iter();
            found.map(|planes| planes.map(chords)).collect()
        })
    };
    let all: Vec<&[RailChords]> = (0..scene.structures.len()).map(of_structure).collect();
    let of_rail = |(index, rail): (usize, &formats::scene::SceneRail)| {
        let given = scene.output.spans.iter().find(|(known, _)| *known == index);
        match given {
            Some((_, ends)) => [pairs(ends), pairs(ends)],
            None => all[rail.structure]
                .get(rail.rail)
                .cloned()
                .unwrap_or_default(),
        }
    };
    scene.rails.iter().enumerate().map(of_rail).collect()
}

fn chords(found: SupportedEnds) -> Vec<[f64; 2]> {
    if found.has_elastic_bed {
        return Vec::new();
    }
    let mut out = pairs(&found.ends);
    for pair in pairs(&found.firm) {
        if !out.contains(&pair) {
            out.push(pair);
        }
    }
    out
}

fn pairs(ends: &[f64]) -> Vec<[f64; 2]> {
    ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}
