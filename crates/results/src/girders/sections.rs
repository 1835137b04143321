//! Sections of the members under the rails of a structure, and the spans to which they belong.

use fea::Model;
use formats::scene::{Origin, Scene};
use formats::spec::Spec;
use trains::{MemberForces, SectionSide};

use super::fibres::StressedSections;
use foundations::SolvedModel;

/// Parts into which each span is divided.
const PARTS: usize = 20;
/// Differences of coordinates that count as rounding, relative to the length of a rail.
const ROUNDING: f64 = 1e-9;

/// A rail of a structure with the ends of its spans.
#[derive(Clone, Debug)]
pub(super) struct RailSpans {
    /// Index of the rail in the scene, and in the structure.
    pub scene_rail: usize,
    pub rail: usize,
    /// First and last coordinate.
    pub range: [f64; 2],
    /// Increasing coordinates between which the spans lie.
    pub ends: Vec<f64>,
    /// Coordinates of the sections, increasing.
    pub places: Vec<f64>,
}

impl RailSpans {
    /// Number of the span of a section: from 1; 0 and one more than the last for overhangs. A section at the end of a
    /// span belongs to the one on its side.
    pub fn span(&self, x: f64, side: SectionSide) -> usize {
        let near = self.slack();
        let before = |end: &&f64| match side {
            SectionSide::Behind => **end <= x + near,
            _ => **end < x - near,
        };
        self.ends.iter().filter(before).count()
    }

    /// First and last coordinate of a span.
    pub fn bounds(&self, span: usize) -> [f64; 2] {
        let from = span.checked_sub(1).and_then(|end| self.ends.get(end));
        let to = self.ends.get(span);
        [
            from.map_or(self.range[0], |x| *x),
            to.map_or(self.range[1], |x| *x),
        ]
    }

    /// The sections beside a coordinate, or the coordinate itself at an end of the rail.
    pub fn neighbours(&self, x: f64) -> [f64; 2] {
        let before = self.places.iter().rev().find(|place| **place < x);
        let after = self.places.iter().find(|place| **place > x);
        [
            before.map_or(x, |place| *place),
            after.map_or(x, |place| *place),
        ]
    }

    /// Differences of coordinates that count as rounding.
    pub fn slack(&self) -> f64 {
        ROUNDING * (self.range[1] - self.range[0])
    }
}

/// A point of a rail, whose deflection is evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct RailPoint {
    /// Index in the list of rails.
    pub rail: usize,
    pub x: f64,
}

/// A section of a member under a rail.
#[derive(Clone, Copy, Debug)]
pub(super) struct MemberSection {
    /// Index of its point.
    pub point: usize,
    pub member: usize,
    /// Distance from the first end of the member.
    pub place: f64,
    pub side: SectionSide,
    /// Number of its span.
    pub span: usize,
}

/// The sections of a structure.
pub(super) struct Sections {
    pub rails: Vec<RailSpans>,
    /// Points, rail by rail with increasing coordinates.
    pub points: Vec<RailPoint>,
    pub sections: Vec<MemberSection>,
    /// Indices of the sections of each member.
    pub of_member: Vec<Vec<usize>>,
    /// Their distances from the first end of the member.
    pub places: Vec<Vec<f64>>,
    /// What stresses need; empty where they are not wanted.
    pub stressed: StressedSections,
}

impl Sections {
    /// Sections of the rails of structure `s` at stations, ends of members and twentieths of spans.
    pub fn new(scene: &Scene, s: usize, solved: &SolvedModel, members: &MemberForces) -> Sections {
        let mut rails = Vec::new();
        let mut stressed = StressedSections::default();
        if let Origin::Spec { spec, .. } = &scene.structures[s].origin {
            for index in (0..scene.rails.len()).filter(|rail| scene.rails[*rail].structure == s) {
                rails.push(rail_spans(
                    scene,
                    index,
                    spec,
                    &solved.model,
                    solved,
                    members,
                ));
            }
            let known: Vec<[usize; 2]> = rails
                .iter()
                .map(|rail| [rail.scene_rail, rail.rail])
                .collect();
            stressed = StressedSections::new(scene, spec, solved, members, &known);
        }
        Sections {
            stressed,
            ..Sections::of(rails, members)
        }
    }

    /// The sections at the places of `rails`, without stresses.
    pub fn of(rails: Vec<RailSpans>, members: &MemberForces) -> Sections {
        let (mut points, mut sections) = (Vec::new(), Vec::new());
        let mut of_member = vec![Vec::new(); members.members().len()];
        let mut distances = vec![Vec::new(); of_member.len()];
        for (number, rail) in rails.iter().enumerate() {
            let near = rail.slack();
            for &x in &rail.places {
                let point = points.len();
                points.push(RailPoint { rail: number, x });
                for (index, member) in members
                    .members()
                    .enumerate()
                    .filter(|(_, m)| m.rail == rail.rail)
                {
                    if x < member.x[0] - near || x > member.x[1] + near {
                        continue;
                    }
                    let side = if x >= member.x[1] - near {
                        SectionSide::Before
                    } else if x <= member.x[0] + near {
                        SectionSide::Behind
                    } else {
                        SectionSide::At
                    };
                    let place = match side {
                        SectionSide::Before => member.length,
                        SectionSide::Behind => 0.0,
                        SectionSide::At => members.place(index, x),
                    };
                    of_member[index].push(sections.len());
                    distances[index].push(place);
                    sections.push(MemberSection {
                        point,
                        member: index,
                        place,
                        side,
                        span: rail.span(x, side),
                    });
                }
            }
        }
        Sections {
            rails,
            points,
            sections,
            of_member,
            places: distances,
            stressed: StressedSections::default(),
        }
    }

    /// Sections of the same rails at those of `places` (index in the list of rails, coordinate) that have none.
    pub fn at(&self, places: &[(usize, f64)], members: &MemberForces) -> Sections {
        let mut rails = self.rails.clone();
        for (number, rail) in rails.iter_mut().enumerate() {
            let known = std::mem::take(&mut rail.places);
            let near = rail.slack();
            let of_rail = places
                .iter()
                .filter(|(of, _)| *of == number)
                .map(|(_, x)| *x);
            rail.places = of_rail
                .filter(|x| known.iter().all(|own| (own - x).abs() > near))
                .collect();
            tidy(&mut rail.places, rail.range);
        }
        Sections::of(rails, members)
    }
}

fn rail_spans(
    scene: &Scene,
    index: usize,
    spec: &Spec,
    model: &Model,
    solved: &SolvedModel,
    members: &MemberForces,
) -> RailSpans {
    let rail = scene.rails[index].rail;
    let range = members.structure().range(rail);
    let given = scene.output.spans.iter().find(|(known, _)| *known == index);
    let mut ends = given.map_or_else(
        || spec.spans(model, &solved.rails, rail),
        |(_, ends)| ends.clone(),
    );
    // the first and the last support may lie beyond the part of the rail that carries loads
    ends.iter_mut()
        .for_each(|x| *x = x.clamp(range[0], range[1]));
    tidy(&mut ends, range);
    if ends.len() < 2 {
        ends = range.to_vec();
    }
    let mut places: Vec<f64> = ends
        .windows(2)
        .flat_map(|pair| {
            (0..=PARTS).map(move |k| pair[0] + (pair[1] - pair[0]) * k as f64 / PARTS as f64)
        })
        .collect();
    places.extend(
        spec.rails()
            .get(rail)
            .iter()
            .flat_map(|outline| outline.stations.iter().copied()),
    );
    places.extend(members.structure().member_ends(rail));
    tidy(&mut places, range);
    RailSpans {
        scene_rail: index,
        rail,
        range,
        ends,
        places,
    }
}

/// Sorts places, and removes those beyond the rail and those that others repeat.
fn tidy(places: &mut Vec<f64>, [from, to]: [f64; 2]) {
    places.retain(|x| *x >= from && *x <= to);
    places.sort_by(f64::total_cmp);
    places.dedup_by(|b, a| *b - *a <= ROUNDING * (to - from));
}
