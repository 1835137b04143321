//! Crane rails on the members of a frame: their height, their mass, and their part in the section.

use std::collections::{BTreeMap, BTreeSet};

use fea::{CrossSection, MemberKind, Model, Rail};
use sections::PlaneSection;

use super::raw::RawSpec;
use super::rolled;
use super::structure::FrameSpec;
use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::place::Place;
use crate::units::{Dimension, Length};
use crate::vector::{cross, dot, length, minus, parallel, unit};

/// Largest distance of a rail that is a part of the section from the vertical plane of the axis, as a fraction of its height
/// above the axis.
const IN_PLANE: f64 = 1e-6;

/// Adds the crane rails of the file to the frame.
///
/// The offset of every segment grows by the height of the rail along the part of `up` that is normal to the rail. The mass per
/// length of the rail is added to its members, on their axes; members of other rails keep their section. A rail in a gap between
/// segments has no mass. With `composite` the members bend as one plane section with the rail. Names and keys are checked in any
/// case; the frame is changed only if it has no fault.
pub(super) fn add(raw: &RawSpec, root: &Place<'_>, frame: &mut FrameSpec, check: &mut Check<'_>) {
    let is_sound = check.faults.0.is_empty();
    let list = root.key("rails");
    let mut changed = Changed::default();
    for (index, (name, raw)) in raw.rails.iter().flat_map(|rails| &rails.0).enumerate() {
        let at = list.key(name);
        let Some((profile, composite)) =
            rolled::carried(&raw.crane_rail, raw.composite, &at, check)
        else {
            continue;
        };
        let mut part = None;
        if composite {
            part = rolled::plane_section(profile, check.scale.to.length, &at, check);
            if part.is_none() {
                continue;
            }
        }
        let Some((_, rail)) = frame.rails.get_mut(index).filter(|_| is_sound) else {
            continue;
        };
        let crane_rail = CraneRail {
            mass: rolled::from_si(profile.mass, Dimension::LINE_MASS, check.scale.to),
            height: profile.height * Length::Millimetre.in_units_of(check.scale.to.length),
            part,
        };
        if let Err((expected, hint)) = crane_rail.place(&mut frame.model, rail, &mut changed) {
            check.faults.add(
                Fault::new(&at.key("composite"), expected)
                    .at_key()
                    .hint(hint),
            );
        }
    }
}

/// Sections and members that crane rails have changed so far.
#[derive(Default)]
struct Changed {
    /// Indices of the sections that were added to the model, by the bits of their numbers.
    sections: BTreeMap<Vec<u64>, usize>,
    /// Members that are a plane section with a rail.
    combined: BTreeSet<usize>,
}

impl Changed {
    /// Index of a section with these properties, which is appended to the model if no rail has made it before.
    fn index_of(&mut self, model: &mut Model, section: CrossSection) -> usize {
        let CrossSection {
            e,
            g,
            area,
            iy,
            iz,
            j,
            shear_y,
            shear_z,
            mass,
        } = section;
        // no shear area is 0, so that 0 stands for one that is absent
        let shear = [shear_y, shear_z].map(Option::unwrap_or_default);
        let bits = [e, g, area, iy, iz, j, shear[0], shear[1], mass]
            .map(f64::to_bits)
            .to_vec();
        *self.sections.entry(bits).or_insert_with(|| {
            model.sections.push(section);
            model.sections.len() - 1
        })
    }
}

/// An expectation of a composite rail that is not met, and a hint.
type Unmet = (&'static str, &'static str);

/// A crane rail in the units of the model.
struct CraneRail {
    /// Mass per length.
    mass: f64,
    /// Height.
    height: f64,
    /// If it is a part of the section: its plane section, and the height of its centroid above its base.
    part: Option<(PlaneSection, f64)>,
}

impl CraneRail {
    /// Places the rail on the segments of `rail`.
    fn place(
        &self,
        model: &mut Model,
        rail: &mut Rail,
        changed: &mut Changed,
    ) -> Result<(), Unmet> {
        let Some(along) = unit(rail.axis) else {
            return Ok(());
        };
        let lift = dot(model.up, along);
        let Some(up) = unit(minus(model.up, along.map(|part| part * lift))) else {
            return Ok(());
        };
        let mut members = BTreeSet::new();
        for segment in &mut rail.segments {
            let member = segment.member;
            if members.insert(member) {
                let axis = axis_of(model, member);
                let mut section = model.sections[model.members[member].section];
                if let Some((part, centroid)) = &self.part {
                    let taken = !changed.combined.insert(member);
                    let carrier = Carrier {
                        axis,
                        along,
                        up,
                        offset: segment.offset,
                        taken,
                    };
                    section = carrier.with_rail(model, member, part, *centroid)?;
                }
                section.mass += self.mass * axis.map_or(1.0, |axis| dot(axis, along).abs());
                model.members[member].section = changed.index_of(model, section);
            }
            segment.offset = std::array::from_fn(|k| segment.offset[k] + self.height * up[k]);
        }
        Ok(())
    }
}

/// Unit vector from the flexible end a to the flexible end b of a member.
fn axis_of(model: &Model, member: usize) -> Option<[f64; 3]> {
    let member = &model.members[member];
    let [a, b] = [0, 1].map(|end| {
        let (point, offset) = (model.points[member.points[end]], member.offsets[end]);
        [
            point[0] + offset[0],
            point[1] + offset[1],
            point[2] + offset[2],
        ]
    });
    unit(minus(b, a))
}

/// A member with the rail that is to be a part of its section.
struct Carrier {
    /// Unit vector along the member.
    axis: Option<[f64; 3]>,
    /// Unit vector along the rail.
    along: [f64; 3],
    /// Unit vector upwards, normal to the rail.
    up: [f64; 3],
    /// Vector from the axis of the member to the base of the rail.
    offset: [f64; 3],
    /// Whether the member is already a plane section with a rail.
    taken: bool,
}

impl Carrier {
    /// The section of the member with the rail, and the mass of the member.
    fn with_rail(
        &self,
        model: &Model,
        member: usize,
        rail: &PlaneSection,
        centroid: f64,
    ) -> Result<CrossSection, Unmet> {
        let own = &model.members[member];
        let section = model.sections[own.section];
        let hint =
            "leave `composite` out and give the properties of the composite section as numbers";
        if own.kind != MemberKind::Beam {
            return Err(("the members of a composite rail must be beams", hint));
        }
        if self.taken {
            return Err(("a member can be composite with one rail only", hint));
        }
        let Some(axis) = self.axis.filter(|axis| parallel(*axis, self.along)) else {
            return Err((
                "the members of a composite rail must be parallel to it",
                hint,
            ));
        };
        let height = dot(self.offset, self.up);
        if height < 0.0
            || dot(self.offset, cross(self.along, self.up)).abs() > IN_PLANE * (height + centroid)
        {
            return Err((
                "a composite rail must lie above the axes of its members",
                hint,
            ));
        }
        // the component of `orientation` normal to the member is local y
        let normal = cross(axis, own.orientation);
        let is_y_up = parallel(cross(normal, axis), self.up) && length(normal) > 0.0;
        let is_z_up = parallel(normal, self.up) && length(normal) > 0.0;
        if !is_y_up && !is_z_up {
            return Err((
                "a local axis of the members of a composite rail must be vertical",
                hint,
            ));
        }
        let [i_vertical, i_lateral] = if is_y_up {
            [section.iz, section.iy]
        } else {
            [section.iy, section.iz]
        };
        let whole = PlaneSection {
            area: section.area,
            i_vertical,
            i_lateral,
        };
        let (whole, _) = whole.with_rail(rail, height + centroid);
        let [iz, iy] = if is_y_up {
            [whole.i_vertical, whole.i_lateral]
        } else {
            [whole.i_lateral, whole.i_vertical]
        };
        Ok(CrossSection {
            area: whole.area,
            iz,
            iy,
            ..section
        })
    }
}
