//! Rails on elastic ties, on the rails of a structure or on the ground, as specs of the general form.
//!
//! [`on_ground`] builds a spec of the rail alone: points at the ties and between them, beams with the section of the
//! rail, and a spring to the ground at every tie. [`on_structure`] adds a rail above each rail of a structure in four
//! steps. First, the position of every tie on the members of the structure is determined (`Seat`). Second, the
//! members are split there (`split`). Third, the new rail is added along the line of the rail of the structure
//! (`lay`). Fourth, the two are connected at every tie by a truss member with the stiffness of the tie, from the
//! point of the new rail to the point of the structure, with a rigid arm at the latter. Every rail must be parallel
//! to a global axis, because the supports that restrain the new rail longitudinally exist for global axes only.

use fea::{
    BeamTheory, CrossSection, Dof, GroundSpring, Member, Model, PointMass, Rail, RailSegment,
    Support,
};
use nalgebra::Vector3;
use thiserror::Error;

use super::cuts::Cut;
pub use super::structure::Pad;
use super::structure::{Form, FrameSpec, GIRDER_RAIL, RailOutline, Spec};
use crate::units::Units;

/// Maximum number of elements of one rail: bays between ties times elements per bay.
pub const MAX_ELEMENTS: f64 = 2000.0;
/// Approximate number of stations of a rail on the ground.
const STATIONS: usize = 50;
/// Distance, as a fraction of a length (of the member, or of the spacing of ties), below which two positions are
/// considered equal.
const SAME: f64 = 1e-9;

/// A rail and the ties under it, in one system of units.
///
/// Every tie is a vertical spring `k` below the axis of the rail, with a damper `c` in parallel. If the rail may bend
/// laterally, the tie also has a lateral spring `lateral_k`. The mass of the tie moves with the rail. At every tie
/// the ground restrains the rail longitudinally and against roll.
///
/// ```
/// use formats::spec::ties::{Ties, on_ground};
/// use formats::units::Units;
///
/// let rail = fea::CrossSection { e: 2.1e11, area: 7.7e-3, iy: 5e-6, iz: 3e-5, ..fea::CrossSection::default() };
/// let ties = Ties { spacing: 0.6, k: 5e7, rail, elements: 2, ..Ties::default() };
/// let spec = on_ground("track", Units::SI, &ties, [0.0, 6.0]).expect("eleven ties");
/// assert_eq!(spec.pads().len(), 11);
/// let (model, rails) = spec.model().expect("a model of it");
/// assert_eq!((model.springs.len(), rails[0].segments.len()), (11, 20));
///
/// let few = on_ground("track", Units::SI, &ties, [0.0, 0.5]).expect_err("one tie");
/// assert_eq!(few.to_string(), "must place at least two ties on the rail, which extends from 0 to 0.5");
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ties {
    /// Distance between ties, length.
    pub spacing: f64,
    /// Coordinate of the first tie, length; `None` for a tie at the beginning of the rail.
    pub first: Option<f64>,
    /// Vertical stiffness of one tie, force/length.
    pub k: f64,
    /// Lateral stiffness of one tie, force/length; `None` if the rail is laterally fixed.
    pub lateral_k: Option<f64>,
    /// Vertical damping coefficient of one tie, force time/length.
    pub c: f64,
    /// Mass of one tie, force time^2/length.
    pub mass: f64,
    /// Section of the rail: `iz` is for vertical bending, `iy` for lateral bending.
    pub rail: CrossSection,
    /// Number of beam elements between two ties.
    pub elements: usize,
}

impl Ties {
    /// Whether rail or ties have mass.
    #[must_use]
    pub fn has_mass(&self) -> bool {
        self.mass > 0.0 || self.rail.mass > 0.0
    }

    /// Coordinates of the ties on a rail from `first` to `last`.
    fn places(&self, [first, last]: [f64; 2]) -> Result<Vec<f64>, TiesError> {
        let start = self.first.unwrap_or(first);
        let slack = SAME * self.spacing;
        // at least two ties are required
        if start < first - slack || start + self.spacing > last + slack {
            return Err(TiesError::Few {
                range: [first, last],
            });
        }
        let count = ((last - start + slack) / self.spacing).floor();
        if (count + 2.0) * self.elements as f64 > MAX_ELEMENTS {
            return Err(TiesError::Many {
                bays: (count + 2.0) * self.elements as f64,
            });
        }
        let place = |k: usize| (start + k as f64 * self.spacing).max(first).min(last);
        Ok((0..=count as usize).map(place).collect())
    }
}

/// The reason why a rail on ties cannot be built.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum TiesError {
    /// Fewer than two ties on a rail.
    #[error("must place at least two ties on the rail, which extends from {} to {}", range[0], range[1])]
    Few {
        /// First and last coordinate of the rail.
        range: [f64; 2],
    },
    /// More than [`MAX_ELEMENTS`] elements of a rail.
    #[error("must result in at most {MAX_ELEMENTS} rail elements, got {bays}")]
    Many {
        /// Number of elements that would be required.
        bays: f64,
    },
    /// A tie at the end of a member that has releases.
    #[error("the tie at {x} is at a hinge of cell {cell}")]
    Hinge {
        /// Coordinate along the rail.
        x: f64,
        /// Index of the member.
        cell: usize,
    },
    /// A rail that is not parallel to a global axis.
    #[error("rail {rail} must be parallel to a global axis and perpendicular to `up`")]
    Oblique {
        /// Index of the rail.
        rail: usize,
    },
    /// A structure without a model.
    #[error("the structure cannot carry ties, because its model cannot be formed")]
    Model,
}

/// A rail on ties on the ground, from coordinate `range[0]` to `range[1]`, as a spec with this name.
///
/// # Errors
/// Fewer than two ties; more than [`MAX_ELEMENTS`] elements.
pub fn on_ground(
    name: &str,
    units: Units,
    ties: &Ties,
    range: [f64; 2],
) -> Result<Spec, TiesError> {
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let places = ties.places(range)?;
    let mut pads = Vec::new();
    let line = Line {
        origin: Vector3::zeros(),
        x: Vector3::x(),
        y: Vector3::y(),
    };
    let mut rail = Rail {
        axis: [1.0, 0.0, 0.0],
        ..Rail::default()
    };
    let points = lay(&mut model, &mut rail, ties, &line, range, &places);
    for point in points {
        restrain(&mut model, ties, point, &line);
        model.springs.push(GroundSpring {
            point,
            dof: Dof::Uy,
            stiffness: ties.k,
        });
        let lateral = ties.lateral_k.map(|stiffness| GroundSpring {
            point,
            dof: Dof::Uz,
            stiffness,
        });
        model.springs.extend(lateral);
        pads.push(Pad {
            rail: point,
            base: None,
            up: model.up,
        });
    }
    rail.stations = places
        .iter()
        .copied()
        .step_by(places.len().div_ceil(STATIONS))
        .collect();
    let frame = FrameSpec {
        sections: vec![GIRDER_RAIL.to_owned()],
        rails: vec![(GIRDER_RAIL.to_owned(), rail)],
        ranges: vec![range],
        points: model.points.len(),
        cells: Vec::new(),
        point_sets: Vec::new(),
        supports: Vec::new(),
        model,
        pads,
        member_outlines: Vec::new(),
    };
    let (name, form) = (name.to_owned(), Form::Frame(frame));
    let theory = BeamTheory::EulerBernoulli;
    let (outlines, crane_rails) = (Vec::new(), Vec::new());
    let (effects, notes, preload) = (Vec::new(), Vec::new(), None);
    Ok(Spec {
        name,
        units,
        theory,
        form,
        effects,
        notes,
        incomplete: Vec::new(),
        outlines,
        crane_rails,
        preload,
    })
}

/// The structure with a rail on ties above each of its rails. The new rails have the names, coordinates and stations
/// of the rails of the structure.
///
/// Members are split at the ties. Pads are truss members of the stiffness `k` with rigid arms to the structure, so
/// that the base of a pad moves as the rail of the structure does at that position.
///
/// # Errors
/// Fewer than two ties on a rail, or more than [`MAX_ELEMENTS`] elements; a tie at a hinge; a rail that is not
/// parallel to a global axis; a structure without a model.
pub fn on_structure(spec: &Spec, ties: &Ties) -> Result<Spec, TiesError> {
    let (model, rails) = spec.model().map_err(|_| TiesError::Model)?;
    let (seats, lines) = seats_on(spec, &model, &rails, ties)?;
    let (mut model, points, parts) = split(&model, &seats)?;
    let base = model.points.len();
    // EA / L = k for a truss member of length L = spacing
    let stiff = |k: f64| CrossSection {
        e: k * ties.spacing,
        area: 1.0,
        ..CrossSection::default()
    };
    let section = model.sections.len() + 1;
    let mut new_rails = Vec::new();
    let mut pads = Vec::new();
    let mut trusses = Vec::new();
    let mut seated = seats.iter().zip(points);
    for (rail, (line, places, outline)) in rails.iter().zip(lines) {
        let own: Vec<_> = seated.by_ref().take(places.len()).collect();
        let above = RailAbove::new(
            &mut model,
            rail,
            (line, &places, outline.range),
            &own,
            section,
            ties,
        );
        pads.extend(above.pads);
        trusses.extend(above.trusses);
        let stations = outline.stations;
        new_rails.push((
            outline.name,
            Rail {
                stations,
                ..above.rail
            },
        ));
    }
    let mut sections = match &spec.form {
        Form::Girder(_) => vec!["girder".to_owned()],
        Form::Frame(frame) => frame.sections.clone(),
    };
    sections.resize(section - 1, "part".to_owned());
    model.sections.push(stiff(ties.k));
    sections.extend(["tie rail".to_owned(), "tie".to_owned()]);
    if let Some(k) = ties.lateral_k {
        model.sections.push(stiff(k));
        sections.push("tie, lateral".to_owned());
    }
    model.members.extend(trusses);
    let cells = match &spec.form {
        Form::Girder(_) => Vec::new(),
        Form::Frame(frame) => parts
            .iter()
            .filter_map(|(member, _)| frame.cells.get(*member))
            .copied()
            .collect(),
    };
    let (point_sets, supports) = match &spec.form {
        Form::Girder(_) => Default::default(),
        Form::Frame(frame) => (frame.point_sets.clone(), frame.supports.clone()),
    };
    let ranges = spec.rails().iter().map(|rail| rail.range).collect();
    let effects = spec
        .effects
        .iter()
        .map(|cut| on_part(cut, &parts))
        .collect();
    let frame = FrameSpec {
        model,
        rails: new_rails,
        ranges,
        sections,
        points: base,
        cells,
        point_sets,
        supports,
        pads,
        member_outlines: Vec::new(),
    };
    Ok(Spec {
        form: Form::Frame(frame),
        effects,
        crane_rails: Vec::new(),
        ..spec.clone()
    })
}

/// The seats of the ties of all rails of a structure, and the line, the positions of the ties and the outline of each
/// rail.
#[allow(clippy::type_complexity)]
fn seats_on(
    spec: &Spec,
    model: &Model,
    rails: &[Rail],
    ties: &Ties,
) -> Result<(Vec<Seat>, Vec<(Line, Vec<f64>, RailOutline)>), TiesError> {
    let mut seats = Vec::new();
    let mut lines = Vec::new();
    for (index, (rail, outline)) in rails.iter().zip(spec.rails()).enumerate() {
        let line = Line::of(model, rail).ok_or(TiesError::Oblique { rail: index })?;
        let places = ties.places(outline.range)?;
        for &x in &places {
            seats.push(Seat::of(model, rail, &line, x).ok_or(TiesError::Model)?);
        }
        lines.push((line, places, outline));
    }
    Ok((seats, lines))
}

/// A rail on ties above a rail of a structure, with the trusses that connect them.
struct RailAbove {
    rail: Rail,
    trusses: Vec<Member>,
    pads: Vec<Pad>,
}

impl RailAbove {
    /// Adds the new rail to the model along the line of `rail`, with its restraints. `own` are the seats of its ties
    /// and their points; `section` is the index of the section of the trusses, which are not yet part of the model.
    fn new(
        model: &mut Model,
        rail: &Rail,
        (mut line, places, range): (Line, &[f64], [f64; 2]),
        own: &[(&Seat, usize)],
        section: usize,
        ties: &Ties,
    ) -> RailAbove {
        if let Some((seat, _)) = own.first() {
            // the axis of the new rail intersects the rail of the structure at the first tie
            let off = seat.place - line.origin;
            line.origin += off - line.x * off.dot(&line.x);
        }
        let mut new = Rail {
            segments: Vec::new(),
            ..rail.clone()
        };
        let on_rail = lay(model, &mut new, ties, &line, range, places);
        let (mut trusses, mut pads) = (Vec::new(), Vec::new());
        for (&x, (&point, &(_, seat))) in places.iter().zip(on_rail.iter().zip(own)) {
            let foot = Vector3::from(model.points[seat]);
            let at = line.origin + line.x * x;
            let mut spring = |direction: Vector3<f64>, section: usize| {
                let tip = at + direction * ties.spacing;
                let offsets = [[0.0; 3], (tip - foot).into()];
                let kind = fea::MemberKind::Truss;
                trusses.push(Member {
                    kind,
                    offsets,
                    ..Member::beam([point, seat], section, line.y.into())
                });
            };
            spring(-line.y, section);
            if ties.lateral_k.is_some() {
                spring(line.x.cross(&line.y), section + 1);
            }
            pads.push(Pad {
                rail: point,
                base: Some((seat, (at - foot).into())),
                up: line.y.into(),
            });
            restrain(model, ties, point, &line);
        }
        RailAbove {
            rail: new,
            trusses,
            pads,
        }
    }
}

/// The straight line of a rail: a point on it, its direction x and its upward direction y, both unit vectors.
struct Line {
    origin: Vector3<f64>,
    x: Vector3<f64>,
    y: Vector3<f64>,
}

impl Line {
    /// The line of a rail; `None` unless x and y are parallel to global axes and perpendicular to each other.
    fn of(model: &Model, rail: &Rail) -> Option<Line> {
        let unit = |vector: [f64; 3]| {
            let unit = Vector3::from(vector).normalize();
            let axis = unit.map(f64::round);
            ((unit - axis).amax() < 1e-12).then_some(axis)
        };
        let (x, y) = unit(rail.axis).zip(unit(model.up))?;
        (x.dot(&y) == 0.0).then(|| Line {
            origin: Vector3::from(rail.origin),
            x,
            y,
        })
    }
}

/// Adds a rail along `line` to a model: points at the ends of `range`, at the ties and, if there are several elements
/// per bay, between them; beams with the section of the rail between these points; and the segments of `rail`. The
/// result is the list of points at the ties, in the order of `places`.
fn lay(
    model: &mut Model,
    rail: &mut Rail,
    ties: &Ties,
    line: &Line,
    range: [f64; 2],
    places: &[f64],
) -> Vec<usize> {
    let section = model.sections.len();
    model.sections.push(ties.rail);
    let mut ends = places.to_vec();
    let slack = SAME * ties.spacing;
    if places.first().is_some_and(|x| x - range[0] > slack) {
        ends.insert(0, range[0]);
    }
    if places.last().is_some_and(|x| range[1] - x > slack) {
        ends.push(range[1]);
    }
    let mut at_ties = Vec::new();
    let add = |model: &mut Model, x: f64| {
        model.points.push((line.origin + line.x * x).into());
        model.points.len() - 1
    };
    for (k, &x) in ends.iter().enumerate() {
        for part in 1..=ties.elements {
            let fraction = part as f64 / ties.elements as f64;
            let point = match k {
                0 if part < ties.elements => continue,
                0 => add(model, x),
                _ if part == ties.elements => add(model, x),
                _ => add(model, ends[k - 1] + (x - ends[k - 1]) * fraction),
            };
            if k > 0 {
                model
                    .members
                    .push(Member::beam([point - 1, point], section, line.y.into()));
                rail.segments.push(RailSegment {
                    member: model.members.len() - 1,
                    offset: [0.0; 3],
                });
            }
        }
        if places.contains(&x) {
            at_ties.push(model.points.len() - 1);
        }
    }
    at_ties
}

/// Restrains a point of the rail longitudinally and against roll. If the rail is laterally fixed, lateral
/// displacement and lateral bending are restrained too. Adds the mass of the tie.
fn restrain(model: &mut Model, ties: &Ties, point: usize, line: &Line) {
    let z = line.x.cross(&line.y);
    let plane = ties.lateral_k.is_none();
    let is_along = |axis: &Vector3<f64>, k: usize| axis[k] != 0.0;
    let fix = std::array::from_fn(|k| match k {
        0..3 => is_along(&line.x, k) || (plane && is_along(&z, k)),
        _ => is_along(&line.x, k - 3) || (plane && is_along(&line.y, k - 3)),
    });
    model.supports.push(Support { point, fixed: fix });
    if ties.mass > 0.0 {
        model.masses.push(PointMass {
            point,
            mass: ties.mass,
            inertia: [0.0; 3],
            offset: [0.0; 3],
        });
    }
}

/// The position of a tie on a structure.
struct Seat {
    /// Coordinate along the rail.
    x: f64,
    /// Index of the member that carries it.
    member: usize,
    /// Position along the flexible part of the member, as a fraction of its length.
    fraction: f64,
    /// Position of the rail of the structure there.
    place: Vector3<f64>,
}

impl Seat {
    /// The position of coordinate `x` on the nearest segment along the rail; `None` for a rail without segments.
    fn of(model: &Model, rail: &Rail, line: &Line, x: f64) -> Option<Seat> {
        let seats = rail.segments.iter().filter_map(|segment| {
            let member = model.members.get(segment.member)?;
            let [a, b] = ends(model, member);
            let [from, to] = [a, b].map(|end| (end - Vector3::from(rail.origin)).dot(&line.x));
            let fraction = ((x - from) / (to - from)).clamp(0.0, 1.0);
            let fraction = if fraction < SAME {
                0.0
            } else if fraction > 1.0 - SAME {
                1.0
            } else {
                fraction
            };
            let place = a + (b - a) * fraction + Vector3::from(segment.offset);
            let away = (x - from - (to - from) * fraction).abs();
            Some((
                away,
                Seat {
                    x,
                    member: segment.member,
                    fraction,
                    place,
                },
            ))
        });
        // if two segments are equally near, the first is taken
        let nearest = seats.reduce(|best, other| {
            if other.0 < best.0 - SAME * x.abs().max(1.0) {
                other
            } else {
                best
            }
        });
        nearest.map(|(_, seat)| seat)
    }
}

/// Ends of the flexible part of a member.
fn ends(model: &Model, member: &Member) -> [Vector3<f64>; 2] {
    [0, 1].map(|k| Vector3::from(model.points[member.points[k]]) + Vector3::from(member.offsets[k]))
}

/// Index of the member for each part of a split member, and the beginning and end of the part along the flexible part
/// of the member, as fractions.
type Parts = Vec<(usize, [f64; 2])>;

/// Splits the members of a model at the seats. Returns the model, the point of each seat, and the parts.
///
/// A seat at the end of a member uses the existing point; every other seat has a new point on the axis of the member.
/// Inner ends of parts have neither offsets nor releases.
///
/// # Errors
/// A seat at an end with releases, because it would be ambiguous on which side of the tie the hinge is.
fn split(m: &Model, seats: &[Seat]) -> Result<(Model, Vec<usize>, Parts), TiesError> {
    let mut model = Model {
        members: Vec::new(),
        ..m.clone()
    };
    let mut points = vec![0; seats.len()];
    let mut parts = Vec::new();
    for (index, member) in m.members.iter().enumerate() {
        let mut own: Vec<(usize, &Seat)> = seats
            .iter()
            .enumerate()
            .filter(|(_, seat)| seat.member == index)
            .collect();
        own.sort_by(|a, b| a.1.fraction.total_cmp(&b.1.fraction));
        let [a, b] = ends(m, member);
        let mut last = (member.points[0], 0.0);
        let add = |model: &mut Model, last: (usize, f64), next: (usize, f64)| {
            let mut part = Member {
                points: [last.0, next.0],
                ..*member
            };
            for (end, outer) in [last.1 == 0.0, next.1 == 1.0].into_iter().enumerate() {
                if !outer {
                    part.offsets[end] = [0.0; 3];
                    part.releases[end] = [false; 6];
                }
            }
            model.members.push(part);
        };
        for (seat, Seat { x, fraction, .. }) in own {
            let end = if *fraction == 0.0 {
                Some(0)
            } else {
                (*fraction == 1.0).then_some(1)
            };
            if let Some(end) = end {
                if member.releases[end] != [false; 6] {
                    return Err(TiesError::Hinge { x: *x, cell: index });
                }
                points[seat] = member.points[end];
            } else {
                if fraction - last.1 > SAME {
                    model.points.push((a + (b - a) * *fraction).into());
                    let next = (model.points.len() - 1, *fraction);
                    add(&mut model, last, next);
                    parts.push((index, [last.1, next.1]));
                    last = next;
                }
                points[seat] = last.0;
            }
        }
        add(&mut model, last, (member.points[1], 1.0));
        parts.push((index, [last.1, 1.0]));
    }
    Ok((model, points, parts))
}

/// Moves a cut to the part of its member that contains it.
fn on_part(cut: &Cut, parts: &[(usize, [f64; 2])]) -> Cut {
    let own = parts
        .iter()
        .enumerate()
        .filter(|(_, (member, _))| *member == cut.member);
    let part = own
        .into_iter()
        .rfind(|(_, (_, range))| range[0] <= cut.place);
    let Some((member, (_, [from, to]))) = part else {
        return cut.clone();
    };
    let place = ((cut.place - from) / (to - from)).clamp(0.0, 1.0);
    Cut {
        member,
        place,
        ..cut.clone()
    }
}
