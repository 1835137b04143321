//! The section of a member as stresses need it: its extreme fibres in the planes of the rail.
//!
//! A part of a tapered member has the dimensions of its place, and those of both ends where the place is not known. Where a
//! crane rail is a part of the section, the area, the second moments and the centroid are those of both, and the fibres those of
//! the girder: the strength of the rail is not in the spec.

use fea::{CrossSection, Model};
use formats::LateralSection;
use formats::spec::{
    DrawnSection, OutlineShape, OutlinedMember, SectionOutline, SectionPlates, Spec,
};

use crate::placed::unit;
use formats::vector::{cross, dot};

/// Sine of the largest angle between a local axis and the plane of up and the rail that counts as rounding.
const UPRIGHT: f64 = 1e-6;

/// A member's section turned into the planes of the rail: heights along up, widths along +z of the rail, both from the centroid.
#[derive(Clone, Debug, PartialEq)]
pub struct Fibres {
    /// Name of the section.
    pub name: String,
    /// Yield strength, where the spec gives it.
    pub yield_strength: Option<f64>,
    /// The section; of a part of a tapered member those of both its ends.
    planes: Vec<FibrePlane>,
    /// How the section changes along a part of a tapered member.
    taper: Option<FibreTaper>,
    lateral: LateralSection,
    /// Whether a crane rail is a part of the section.
    pub is_composite: bool,
}

/// A section at one place of a member.
#[derive(Clone, Debug, PartialEq)]
struct FibrePlane {
    /// Area.
    area: f64,
    /// Second moments of area for vertical and for lateral bending.
    second: [f64; 2],
    /// Height of the centroid above the axis of the member: 0 without a crane rail in the section.
    centroid: f64,
    /// Heights above the centroid.
    outline: Outline,
    /// The I section with its upper flange listed last, where the web is upright.
    plates: Option<SectionPlates>,
    /// Width and thickness of the upper flange, where there is one.
    top_flange: Option<[f64; 2]>,
}

/// A part of a tapered member.
#[derive(Clone, Debug, PartialEq)]
struct FibreTaper {
    ends: [DrawnSection; 2],
    /// The part as fractions of the length of the tapered member.
    stretch: [f64; 2],
    turned: Turned,
    rail: Option<CompositeRail>,
}

/// A crane rail that is a part of the section of a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CompositeRail {
    /// Area.
    pub area: f64,
    /// Second moments about its own centroid for vertical and for lateral bending.
    pub second: [f64; 2],
    /// Height of its centroid above the axis of the member.
    pub height: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum Outline {
    /// Heights and widths of corners, by their names.
    Corners(Vec<(&'static str, [f64; 2])>),
    /// Radius.
    Round(f64),
}

/// The direct stress at a fibre and its parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FibreStress {
    /// Name of the fibre.
    pub fibre: &'static str,
    /// Parts of normal force, of the vertical and of the lateral moment; their sum is the stress, positive in tension.
    pub parts: [f64; 3],
}

impl FibreStress {
    /// The stress.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.parts.iter().sum()
    }
}

impl Fibres {
    /// The fibres of a member on a rail with these directions (along, up, z).
    ///
    /// # Errors
    /// What is missing, in words.
    pub(crate) fn new(
        spec: &Spec,
        model: &Model,
        member: usize,
        axes: [[f64; 3]; 3],
        lateral: LateralSection,
        rail: Option<CompositeRail>,
    ) -> Result<Fibres, String> {
        let OutlinedMember { section, taper } = spec
            .outline(member)
            .ok_or_else(|| "the spec does not define its members".to_owned())?;
        let SectionOutline {
            name,
            shape,
            drawn,
            yield_strength,
        } = section;
        let Some(shape) = shape else {
            return Err(format!(
                "section {name} has no shape: name a rolled section or give the dimensions of its plates"
            ));
        };
        let turned = Turned::new(model, member, axes)
            .ok_or_else(|| format!("no axis of section {name} is vertical under the rail"))?;
        let (name, planes, taper) = match taper {
            None => {
                let whole: CrossSection = model.sections[model.members[member].section];
                let plane = FibrePlane::of_whole(shape, &whole, &turned, rail.as_ref());
                (name.clone(), vec![plane], None)
            }
            Some((other, stretch)) => {
                let unknown = || {
                    format!(
                        "the dimensions of members that taper from section {name} to section {} are not known: give both a \
                         `shape` of one kind by dimensions, without A, Iy and Iz",
                        other.name
                    )
                };
                let ends = drawn
                    .zip(other.drawn)
                    .map(|(a, b)| [a, b])
                    .ok_or_else(unknown)?;
                let taper = FibreTaper {
                    ends,
                    stretch,
                    turned,
                    rail,
                };
                let planes: Option<Vec<FibrePlane>> = [0.0, 1.0]
                    .into_iter()
                    .map(|place| taper.plane(place))
                    .collect();
                (
                    format!("{name} to {}", other.name),
                    planes.ok_or_else(unknown)?,
                    Some(taper),
                )
            }
        };
        if lateral == LateralSection::TopFlange && planes[0].top_flange.is_none() {
            return Err(format!(
                "section {name} has no top flange to resist the lateral moments"
            ));
        }
        let (yield_strength, is_composite) = (*yield_strength, rail.is_some());
        Ok(Fibres {
            name,
            yield_strength,
            planes,
            taper,
            lateral,
            is_composite,
        })
    }

    /// The fibre of largest stress of either sign under a normal force, a vertical and a lateral moment; `None` where it is not
    /// finite. Stresses are in force over the square of length, positive in tension:
    ///
    /// sigma = N/A - M_v v/I_v + M_l w/I_l at the height v above the centroid and the width w along +z (a positive moment sags
    /// down and towards +z). Where the top flange alone takes lateral moments, M_l w/I_l is M_l/(t b^2/6) at its edges and 0
    /// elsewhere. Shear, torsion and warping are not included. In a part of a tapered member it is the larger stress of those at
    /// both ends of the part.
    #[must_use]
    pub fn worst(&self, forces: [f64; 3]) -> Option<FibreStress> {
        self.worst_of(&self.planes, forces)
    }

    /// The same at a place of the member, as a fraction of its length in the direction of the rail.
    #[must_use]
    pub(crate) fn worst_at(&self, place: f64, forces: [f64; 3]) -> Option<FibreStress> {
        match self.plane_at(place) {
            Some(plane) => self.worst_of(&[plane], forces),
            None => self.worst(forces),
        }
    }

    /// The stresses at all fibres, in the same order for all forces.
    #[must_use]
    pub fn all(&self, forces: [f64; 3]) -> Vec<FibreStress> {
        let mut out = Vec::new();
        for plane in &self.planes {
            plane.each(self.lateral, forces, |stress| out.push(stress));
        }
        out
    }

    /// The section at a place of a part of a tapered member; `None` of other members.
    fn plane_at(&self, place: f64) -> Option<FibrePlane> {
        let taper = self.taper.as_ref()?;
        taper.plane(if taper.turned.is_reversed {
            1.0 - place
        } else {
            place
        })
    }

    fn worst_of(&self, planes: &[FibrePlane], forces: [f64; 3]) -> Option<FibreStress> {
        let mut worst: Option<(f64, FibreStress)> = None;
        for plane in planes {
            plane.each(self.lateral, forces, |stress| {
                let size = stress.value().abs();
                if worst.is_none_or(|(known, _)| size > known) {
                    worst = Some((size, stress));
                }
            });
        }
        worst
            .filter(|(size, _)| size.is_finite())
            .map(|(_, stress)| stress)
    }

    /// Whether the section changes along the member.
    pub(crate) fn is_tapered(&self) -> bool {
        self.taper.is_some()
    }

    /// The plates of an upright I section with its upper flange listed last; of a part of a tapered member each dimension is
    /// the smaller one of both ends.
    pub(crate) fn plates(&self) -> Option<SectionPlates> {
        let least = |a: SectionPlates, b: SectionPlates| SectionPlates {
            height: a.height.min(b.height),
            web: a.web.min(b.web),
            widths: std::array::from_fn(|k| a.widths[k].min(b.widths[k])),
            flanges: std::array::from_fn(|k| a.flanges[k].min(b.flanges[k])),
        };
        self.planes
            .iter()
            .map(|plane| plane.plates)
            .reduce(|a, b| Some(least(a?, b?)))?
    }

    /// Thickness of the web times the height over the flanges; of a part of a tapered member the smaller one of both ends.
    pub(crate) fn web_area(&self) -> Option<f64> {
        self.planes
            .iter()
            .map(FibrePlane::web_area)
            .reduce(|a, b| Some(a?.min(b?)))?
    }

    /// The same at a place of the member, as a fraction of its length in the direction of the rail.
    pub(crate) fn web_area_at(&self, place: f64) -> Option<f64> {
        self.plane_at(place)
            .map_or_else(|| self.web_area(), |plane| plane.web_area())
    }
}

impl FibreTaper {
    /// The section at a fraction of the length of the part, from its first end.
    fn plane(&self, place: f64) -> Option<FibrePlane> {
        let [from, to] = self.stretch;
        let [a, b] = &self.ends;
        let own = a.towards(b, from + (to - from) * place)?;
        let mut second = if self.turned.is_y_up {
            [own.iz, own.iy]
        } else {
            [own.iy, own.iz]
        };
        let mut area = own.area;
        if let Some(rail) = &self.rail {
            area += rail.area;
            let shift = rail.height * (rail.area / area);
            second[0] += rail.second[0] + own.area * shift * rail.height;
            second[1] += rail.second[1];
        }
        Some(FibrePlane::new(
            &own.shape,
            (area, second),
            &self.turned,
            self.rail.as_ref(),
        ))
    }
}

impl FibrePlane {
    /// A section whose area and second moments, those of a crane rail in it included, the model has.
    fn of_whole(
        shape: &OutlineShape,
        whole: &CrossSection,
        turned: &Turned,
        rail: Option<&CompositeRail>,
    ) -> FibrePlane {
        let second = if turned.is_y_up {
            [whole.iz, whole.iy]
        } else {
            [whole.iy, whole.iz]
        };
        FibrePlane::new(shape, (whole.area, second), turned, rail)
    }

    /// A section with the area and the second moments of the whole. The centroid is e = h A_r/A above the axis of the member,
    /// with the area A_r of the rail and the height h of its centroid above this axis.
    fn new(
        shape: &OutlineShape,
        (area, second): (f64, [f64; 2]),
        turned: &Turned,
        rail: Option<&CompositeRail>,
    ) -> FibrePlane {
        let centroid = rail.map_or(0.0, |rail| rail.height * (rail.area / area));
        let outline = match turned.outline(shape) {
            Outline::Corners(corners) => Outline::Corners(
                corners
                    .into_iter()
                    .map(|(name, [v, w])| (name, [v - centroid, w]))
                    .collect(),
            ),
            round @ Outline::Round(..) => round,
        };
        let (plates, top_flange) = (turned.plates(shape), turned.top_flange(shape));
        FibrePlane {
            area,
            second,
            centroid,
            outline,
            plates,
            top_flange,
        }
    }

    fn web_area(&self) -> Option<f64> {
        self.plates.map(|plates| plates.height * plates.web)
    }

    /// The stresses at all fibres under a normal force in the axis of the member, a vertical and a lateral moment about it.
    fn each(
        &self,
        resists: LateralSection,
        [normal, vertical, lateral]: [f64; 3],
        mut take: impl FnMut(FibreStress),
    ) {
        let over = |force: f64, by: f64| if force == 0.0 { 0.0 } else { force / by };
        let axial = over(normal, self.area);
        // a tension below the centroid makes it sag
        let vertical = vertical + normal * self.centroid;
        let [i_vertical, i_lateral] = self.second;
        match &self.outline {
            Outline::Corners(corners) => {
                for &(fibre, [v, w]) in corners {
                    let sideways = match (resists, self.top_flange) {
                        (LateralSection::TopFlange, Some([width, thickness]))
                            if fibre.starts_with("top") =>
                        {
                            over(lateral, thickness * width.powi(2) / 6.0) * w.signum()
                        }
                        (LateralSection::TopFlange, _) => 0.0,
                        (LateralSection::Whole, _) => over(lateral, i_lateral) * w,
                    };
                    take(FibreStress {
                        fibre,
                        parts: [axial, -over(vertical, i_vertical) * v, sideways],
                    });
                }
            }
            Outline::Round(radius) => {
                let [a, b] = [over(vertical, i_vertical), over(lateral, i_lateral)];
                let size = a.hypot(b);
                // the middle of a tube is below the centroid of the tube with a rail
                let below = a * self.centroid;
                let parts = |sign: f64| {
                    if size == 0.0 {
                        [axial, 0.0, 0.0]
                    } else {
                        [
                            axial,
                            sign * radius * a * a / size + below,
                            sign * radius * b * b / size,
                        ]
                    }
                };
                take(FibreStress {
                    fibre: "tension side",
                    parts: parts(1.0),
                });
                take(FibreStress {
                    fibre: "compression side",
                    parts: parts(-1.0),
                });
            }
        }
    }
}

/// How the local axes of a member lie in the planes of the rail.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turned {
    /// Whether local y is upright; otherwise local z is.
    is_y_up: bool,
    /// Sign of the upright local axis along up, and of the other one along +z of the rail.
    signs: [f64; 2],
    /// Whether the member runs against the rail.
    is_reversed: bool,
}

impl Turned {
    fn new(model: &Model, member: usize, [along, up, _]: [[f64; 3]; 3]) -> Option<Turned> {
        let own = &model.members[member];
        let tip = |end: usize| -> [f64; 3] {
            std::array::from_fn(|k| model.points[own.points[end]][k] + own.offsets[end][k])
        };
        let x = unit(std::array::from_fn(|k| tip(1)[k] - tip(0)[k]));
        let normal = cross(x, own.orientation);
        let z = unit(normal);
        let y = cross(z, x);
        // The planes of a member are those of its axis in the direction of the rail, and up.
        let t = if dot(x, along) < 0.0 {
            x.map(|part| -part)
        } else {
            x
        };
        let rise = dot(up, t);
        let u = unit(std::array::from_fn(|k| up[k] - rise * t[k]));
        let w = cross(t, u);
        let is_along = |a: [f64; 3], b: [f64; 3]| dot(a, b).abs() > 1.0 - UPRIGHT * UPRIGHT;
        let is_reversed = dot(x, along) < 0.0;
        if is_along(y, u) {
            Some(Turned {
                is_y_up: true,
                signs: [dot(y, u).signum(), dot(z, w).signum()],
                is_reversed,
            })
        } else if is_along(z, u) {
            Some(Turned {
                is_y_up: false,
                signs: [dot(z, u).signum(), dot(y, w).signum()],
                is_reversed,
            })
        } else {
            None
        }
    }

    /// Height and width of a point given by its local y and z.
    fn place(&self, y: f64, z: f64) -> [f64; 2] {
        let [upright, level] = if self.is_y_up { [y, z] } else { [z, y] };
        [self.signs[0] * upright, self.signs[1] * level]
    }

    fn outline(&self, shape: &OutlineShape) -> Outline {
        let corners: Vec<[f64; 2]> = match shape {
            OutlineShape::Tube(diameter) => return Outline::Round(0.5 * diameter),
            OutlineShape::I(plates) => {
                let low = -plates.centroid();
                let high = low + plates.height;
                let [a, b] = plates.widths.map(|width| 0.5 * width);
                vec![[low, -a], [low, a], [high, -b], [high, b]]
            }
            OutlineShape::Box([height, width, _]) | OutlineShape::Bar([height, width]) => {
                let (v, w) = (0.5 * height, 0.5 * width);
                vec![[-v, -w], [-v, w], [v, -w], [v, w]]
            }
        };
        let named = |[y, z]: [f64; 2]| {
            let [v, w] = self.place(y, z);
            let name = match (v > 0.0, w > 0.0) {
                (true, true) => "top, +z",
                (true, false) => "top, -z",
                (false, true) => "bottom, +z",
                (false, false) => "bottom, -z",
            };
            (name, [v, w])
        };
        Outline::Corners(corners.into_iter().map(named).collect())
    }

    /// The plates of an I section with an upright web, the upper flange last.
    fn plates(&self, shape: &OutlineShape) -> Option<SectionPlates> {
        let OutlineShape::I(mut plates) = *shape else {
            return None;
        };
        if self.signs[0] < 0.0 {
            plates.widths.reverse();
            plates.flanges.reverse();
        }
        self.is_y_up.then_some(plates)
    }

    fn top_flange(&self, shape: &OutlineShape) -> Option<[f64; 2]> {
        match shape {
            OutlineShape::Box([_, width, flange]) if self.is_y_up => Some([*width, *flange]),
            _ => self
                .plates(shape)
                .map(|plates| [plates.widths[1], plates.flanges[1]]),
        }
    }
}
