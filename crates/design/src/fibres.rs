//! The section of a member as stresses need it: its extreme fibres in the planes of the rail.

use fea::{CrossSection, Model};
use formats::LateralSection;
use formats::spec::{OutlineShape, SectionOutline, SectionPlates, Spec};

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
    /// Area.
    area: f64,
    /// Second moments of area for vertical and for lateral bending.
    second: [f64; 2],
    outline: Outline,
    /// The I section with its upper flange listed last, where the web is upright.
    pub(crate) plates: Option<SectionPlates>,
    /// Width and thickness of the upper flange, where there is one.
    top_flange: Option<[f64; 2]>,
    lateral: LateralSection,
    /// Whether a crane rail is a part of the section, so that its fibres are not those of its plates.
    pub is_composite: bool,
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
        is_composite: bool,
    ) -> Result<Fibres, String> {
        let (outline, is_tapered) =
            spec.outline(member).ok_or_else(|| "the spec does not have its members".to_owned())?;
        let SectionOutline { name, shape, yield_strength } = outline;
        if is_tapered {
            return Err(format!("members of section {name} are tapered"));
        }
        let Some(shape) = shape else {
            return Err(format!(
                "section {name} has no shape: name a rolled section or give the dimensions of its plates"
            ));
        };
        let turned = Turned::new(model, member, axes)
            .ok_or_else(|| format!("no axis of section {name} is upright under the rail"))?;
        let own: CrossSection = model.sections[model.members[member].section];
        let second = if turned.is_y_up { [own.iz, own.iy] } else { [own.iy, own.iz] };
        let fibres = Fibres {
            name: name.clone(),
            yield_strength: *yield_strength,
            area: own.area,
            second,
            outline: turned.outline(shape),
            plates: turned.plates(shape),
            top_flange: turned.top_flange(shape),
            lateral,
            is_composite,
        };
        if lateral == LateralSection::TopFlange && fibres.top_flange.is_none() {
            return Err(format!("section {name} has no top flange that could take the lateral moments"));
        }
        Ok(fibres)
    }

    /// The fibre of largest stress of either sign under a normal force, a vertical and a lateral moment; `None` where it is not
    /// finite. Stresses are in force over the square of length, positive in tension:
    ///
    /// sigma = N/A - M_v v/I_v + M_l w/I_l at the height v above the centroid and the width w along +z (a positive moment sags
    /// down and towards +z). Where the top flange alone takes lateral moments, M_l w/I_l is M_l/(t b^2/6) at its edges and 0
    /// elsewhere. Shear, torsion and warping are not included.
    #[must_use]
    pub fn worst(&self, forces: [f64; 3]) -> Option<FibreStress> {
        let mut worst: Option<(f64, FibreStress)> = None;
        self.each(forces, |stress| {
            let size = stress.value().abs();
            if worst.is_none_or(|(known, _)| size > known) {
                worst = Some((size, stress));
            }
        });
        worst.filter(|(size, _)| size.is_finite()).map(|(_, stress)| stress)
    }

    /// The stresses at all fibres under a normal force, a vertical and a lateral moment.
    fn each(&self, [normal, vertical, lateral]: [f64; 3], mut take: impl FnMut(FibreStress)) {
        let over = |force: f64, by: f64| if force == 0.0 { 0.0 } else { force / by };
        let axial = over(normal, self.area);
        let [i_vertical, i_lateral] = self.second;
        match &self.outline {
            Outline::Corners(corners) => {
                for &(fibre, [v, w]) in corners {
                    let sideways = match (self.lateral, self.top_flange) {
                        (LateralSection::TopFlange, Some([width, thickness])) if v > 0.0 => {
                            over(lateral, thickness * width.powi(2) / 6.0) * w.signum()
                        }
                        (LateralSection::TopFlange, _) => 0.0,
                        (LateralSection::Whole, _) => over(lateral, i_lateral) * w,
                    };
                    take(FibreStress { fibre, parts: [axial, -over(vertical, i_vertical) * v, sideways] });
                }
            }
            Outline::Round(radius) => {
                let [a, b] = [over(vertical, i_vertical), over(lateral, i_lateral)];
                let size = a.hypot(b);
                let parts = |sign: f64| {
                    if size == 0.0 {
                        [axial, 0.0, 0.0]
                    } else {
                        [axial, sign * radius * a * a / size, sign * radius * b * b / size]
                    }
                };
                take(FibreStress { fibre: "tension side", parts: parts(1.0) });
                take(FibreStress { fibre: "compression side", parts: parts(-1.0) });
            }
        }
    }

    /// Thickness of the web times the height over the flanges.
    pub(crate) fn web_area(&self) -> Option<f64> {
        self.plates.map(|plates| plates.height * plates.web)
    }
}

/// How the local axes of a member lie in the planes of the rail.
#[derive(Clone, Copy, Debug)]
struct Turned {
    /// Whether local y is upright; otherwise local z is.
    is_y_up: bool,
    /// Sign of the upright local axis along up, and of the other one along +z of the rail.
    signs: [f64; 2],
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
        let t = if dot(x, along) < 0.0 { x.map(|part| -part) } else { x };
        let rise = dot(up, t);
        let u = unit(std::array::from_fn(|k| up[k] - rise * t[k]));
        let w = cross(t, u);
        let is_along = |a: [f64; 3], b: [f64; 3]| dot(a, b).abs() > 1.0 - UPRIGHT * UPRIGHT;
        if is_along(y, u) {
            Some(Turned { is_y_up: true, signs: [dot(y, u).signum(), dot(z, w).signum()] })
        } else if is_along(z, u) {
            Some(Turned { is_y_up: false, signs: [dot(z, u).signum(), dot(y, w).signum()] })
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
        let OutlineShape::I(mut plates) = *shape else { return None };
        if self.signs[0] < 0.0 {
            plates.widths.reverse();
            plates.flanges.reverse();
        }
        self.is_y_up.then_some(plates)
    }

    fn top_flange(&self, shape: &OutlineShape) -> Option<[f64; 2]> {
        match shape {
            OutlineShape::Box([_, width, flange]) if self.is_y_up => Some([*width, *flange]),
            _ => self.plates(shape).map(|plates| [plates.widths[1], plates.flanges[1]]),
        }
    }
}
