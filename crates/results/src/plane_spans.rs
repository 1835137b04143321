//! The ends of the spans of rails in the planes of deflections.

use formats::scene::{Origin, Scene};
use formats::spec::Form;
use foundations::{RailChords, SolvedModel};
use trains::{SupportedEnds, supported_ends};

/// Chords of each rail of the scene by plane (vertical, lateral): between the coordinates that the scene gives, otherwise
/// between the supports of the plane ([`supported_ends`]), and between its firm supports where these are others. None
/// where a rail has no spans: on an elastic bed, without two supports, and without a solved structure.
pub fn plane_spans(scene: &Scene, solved: &[Option<&SolvedModel>]) -> Vec<RailChords> {
    let of_structure = |s: usize| -> Vec<RailChords> {
        let (Origin::Spec { spec, .. }, Some(solved)) = (&scene.structures[s].origin, solved[s])
        else {
            return Vec::new();
        };
        if let Some(known) = solved.chords.get() {
            return known.clone();
        }
        let candidates = spec.rail_spans(&solved.model, &solved.rails);
        let found = match (&spec.form, &solved.surface) {
            (Form::Frame(_), Some(surface)) => {
                supported_ends(&solved.model, &solved.rails, surface, &candidates).ok()
            }
            _ => None,
        };
        let found = found.unwrap_or_else(|| {
            let each = candidates.iter();
            each.map(|ends| [0, 1].map(|_| SupportedEnds::all_firm(ends)))
                .collect()
        });
        found.into_iter().map(|planes| planes.map(chords)).collect()
    };
    let all: Vec<Vec<[Vec<[f64; 2]>; 2]>> = (0..scene.structures.len()).map(of_structure).collect();
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
