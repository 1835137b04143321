//! Outlines of cross sections: the plates and the yield strength, which stresses need beside area and second moments.

use sections::{RailProfile, SectionDimensions, crane_rail, rolled};

use super::raw::{RawGirder, RawSection, RawSectionShape, RawSpec, SectionTables};
use super::shape::{self, Kind};
use crate::check::Check;
use crate::text::place::Place;
use crate::units::{Dimension, Length, Scale};

/// Shape and strength of a cross section, in the units of the spec.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionOutline {
    /// Name of the rolled section, or of the section in the spec.
    pub name: String,
    /// Its shape; `None` where the spec gives numbers alone.
    pub shape: Option<OutlineShape>,
    /// Its dimensions, where the spec gives them, so that tapers to another section have dimensions too.
    pub drawn: Option<DrawnSection>,
    /// Yield strength of its material, where the spec gives it.
    pub yield_strength: Option<f64>,
}

/// Kind and dimensions of a section, in the units of the spec.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnSection {
    kind: Kind,
    dimensions: [f64; 8],
}

/// A section between those of the ends of a tapered member. Local y is along its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaperedSection {
    /// Its shape.
    pub shape: OutlineShape,
    /// Area.
    pub area: f64,
    /// Integral of z^2.
    pub iy: f64,
    /// Integral of y^2.
    pub iz: f64,
}

impl DrawnSection {
    /// The dimensions of a section; `None` where it has no shape of dimensions, or states A, Iy or Iz beside it.
    fn of_section(raw: &RawSection, check: &Check<'_>) -> Option<DrawnSection> {
        let is_stated = [raw.area, raw.iy, raw.iz].iter().any(Option::is_some);
        let (kind, dimensions) = shape::in_model_units(shape::dimensions(raw)?, &check.scale)?;
        (!is_stated).then_some(DrawnSection { kind, dimensions })
    }

    /// The section at the fraction `s` of the length of a member that tapers to `other`: dimensions vary linearly. `None` unless
    /// both are of one kind.
    #[must_use]
    pub fn towards(&self, other: &DrawnSection, s: f64) -> Option<TaperedSection> {
        if self.kind != other.kind {
            return None;
        }
        let dimensions = std::array::from_fn(|k| {
            self.dimensions[k] + (other.dimensions[k] - self.dimensions[k]) * s
        });
        let found = shape::properties(self.kind, dimensions)?;
        let shape = of_shape((self.kind, dimensions))?;
        Some(TaperedSection {
            shape,
            area: found.area,
            iy: found.i2,
            iz: found.i1,
        })
    }
}

/// The section of a member as stresses need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlinedMember<'a> {
    /// The section of the cell, of which a tapered one has it at its first end.
    pub section: &'a SectionOutline,
    /// Of a part of a tapered cell: the section at the last end of the cell, and the stretch of the part as fractions of the
    /// cell's length.
    pub taper: Option<(&'a SectionOutline, [f64; 2])>,
}

/// Shape of a cross section whose local y axis is along its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlineShape {
    /// An I section of plates.
    I(SectionPlates),
    /// A box with two equal flanges and two equal webs: height, width, thickness of the flanges.
    Box([f64; 3]),
    /// A solid rectangle: height and width.
    Bar([f64; 2]),
    /// A round tube of this outer diameter.
    Tube(f64),
}

impl OutlineShape {
    /// Height of the upper edge above the centroid.
    #[must_use]
    pub fn top(&self) -> f64 {
        match self {
            OutlineShape::I(plates) => plates.height - plates.centroid(),
            OutlineShape::Box([height, ..]) | OutlineShape::Bar([height, _]) => 0.5 * height,
            OutlineShape::Tube(diameter) => 0.5 * diameter,
        }
    }
}

/// Plates of an I section; root fillets are left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionPlates {
    /// Height over the flanges.
    pub height: f64,
    /// Thickness of the web.
    pub web: f64,
    /// Widths of the flange at -y and of the flange at +y.
    pub widths: [f64; 2],
    /// Thicknesses of these flanges.
    pub flanges: [f64; 2],
}

impl SectionPlates {
    /// Distance of the centroid from the edge at -y: sum of area times distance over the area of the three plates.
    #[must_use]
    pub fn centroid(&self) -> f64 {
        let [lower, upper] = self.flanges;
        let clear = self.height - lower - upper;
        let plates = [
            (self.widths[0] * lower, 0.5 * lower),
            (self.web * clear, lower + 0.5 * clear),
            (self.widths[1] * upper, self.height - 0.5 * upper),
        ];
        plates.iter().map(|(area, y)| area * y).sum::<f64>()
            / plates.iter().map(|(area, _)| area).sum::<f64>()
    }
}

/// A crane rail on a rail of a spec.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecCraneRail {
    /// Its dimensions, in millimetres.
    pub profile: &'static RailProfile,
    /// Whether it is a part of the section of its members.
    pub is_composite: bool,
}

/// The section of the file that a member has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemberOutline {
    /// Index of the section in the file.
    pub section: usize,
    /// Of a part of a tapered cell: the section at the last end of the cell, and the stretch of the part as fractions of the
    /// cell's length.
    pub taper: Option<(usize, [f64; 2])>,
}

/// The outline of the only section of a girder.
pub(super) fn of_girder(raw: &RawGirder, at: &Place<'_>, check: &mut Check<'_>) -> SectionOutline {
    let fy = check.optional_positive(raw.fy, &at.key("fy"), Dimension::STRESS, "a yield strength");
    let section = raw.section.as_deref().and_then(rolled);
    SectionOutline {
        name: section.map_or("girder", |section| section.name).to_owned(),
        shape: girder_shape(raw, &check.scale),
        drawn: None,
        yield_strength: fy,
    }
}

/// The shape of the section of a girder, where its name or its dimensions give it.
pub(super) fn girder_shape(raw: &RawGirder, scale: &Scale) -> Option<OutlineShape> {
    let section = raw.section.as_deref().and_then(rolled);
    let named = section.map(|section| of_dimensions(&section.dimensions, scale.to.length));
    let drawn = || of_shape(shape::in_model_units(raw.shape.as_ref()?, scale)?);
    named.or_else(drawn)
}

/// The outlines of the sections of the general form, in their order.
pub(super) fn of_sections(
    tables: SectionTables<'_>,
    root: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<SectionOutline> {
    let list = root.key("materials");
    let mut strengths = Vec::new();
    for (index, material) in tables.materials.iter().flatten().enumerate() {
        let at = list.index(index);
        let fy = check.optional_positive(
            material.fy,
            &at.key("fy"),
            Dimension::STRESS,
            "a yield strength",
        );
        strengths.push((material.name.as_deref(), fy));
    }
    let length = check.scale.to.length;
    let outline = |section: &RawSection| {
        let own = section.material.as_deref();
        let strength = strengths
            .iter()
            .find(|(name, _)| own.is_some() && *name == own);
        let rolled = match &section.shape {
            Some(RawSectionShape::Name(name)) => rolled(name),
            _ => None,
        };
        let named =
            rolled.map(|section| (section.name, of_dimensions(&section.dimensions, length)));
        let name = named.map_or_else(
            || section.name.as_deref().unwrap_or_default(),
            |(name, _)| name,
        );
        let drawn = || {
            shape::dimensions(section)
                .and_then(|raw| of_shape(shape::in_model_units(raw, &check.scale)?))
        };
        SectionOutline {
            name: name.to_owned(),
            shape: named.map(|(_, shape)| shape).or_else(drawn),
            drawn: DrawnSection::of_section(section, check),
            yield_strength: strength.and_then(|(_, fy)| *fy),
        }
    };
    tables.sections.iter().flatten().map(outline).collect()
}

/// The crane rails of a spec without faults, by rail.
pub(super) fn crane_rails(raw: &RawSpec) -> Vec<Option<SpecCraneRail>> {
    let carried = |name: &Option<String>, composite: Option<bool>| {
        let profile = crane_rail(name.as_deref()?)?;
        Some(SpecCraneRail {
            profile,
            is_composite: composite.unwrap_or(false),
        })
    };
    match &raw.girder {
        Some(girder) => vec![carried(&girder.crane_rail, girder.composite)],
        None => {
            let rails = raw.rails.iter().flat_map(|rails| &rails.0);
            rails
                .map(|(_, rail)| carried(&rail.crane_rail, rail.composite))
                .collect()
        }
    }
}

/// The plates of a rolled section in a unit of length.
fn of_dimensions(section: &SectionDimensions, unit: Length) -> OutlineShape {
    let one = Length::Millimetre.in_units_of(unit);
    OutlineShape::I(SectionPlates {
        height: section.height * one,
        web: section.web * one,
        widths: [section.width * one; 2],
        flanges: [section.flange * one; 2],
    })
}

/// The shape of plates with dimensions in the order of the keys of `shape`.
fn of_shape((kind, dimensions): (Kind, [f64; 8])) -> Option<OutlineShape> {
    let [
        height,
        width,
        flange,
        web,
        lower_width,
        lower_flange,
        diameter,
        _,
    ] = dimensions;
    Some(match kind {
        Kind::I => OutlineShape::I(SectionPlates {
            height,
            web,
            widths: [lower_width, width],
            flanges: [lower_flange, flange],
        }),
        Kind::Box => OutlineShape::Box([height, width, flange]),
        Kind::Bar => OutlineShape::Bar([height, width]),
        Kind::Tube => OutlineShape::Tube(diameter),
    })
}
