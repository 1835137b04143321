//! Crane rails on the members of a frame: their height, their mass, and their part in the section.

use fea::{CrossSection, MemberKind, Model};
use sections::{PlaneSection, RailProfile};

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
    let mut combined = Vec::new();
    for (index, (name, raw)) in raw.rails.iter().flat_map(|rails| &rails.0).enumerate() {
        let at = list.key(name);
        let Some((profile, composite)) = rolled::carried(&raw.crane_rail, raw.composite, &at, check) else {
            continue;
        };
        let part = if composite {
            let Some(part) = rolled::plane_section(profile, check.scale.to.length, &at, check) else {
                continue;
            };
            Some(part)
        } else {
            None
        };
        if is_sound {
            place(frame, index, profile, part, &mut combined, &at, check);
        }
    }
}

/// Adds one crane rail to the rail with this index. `combined` has the members that are already a plane section with a rail.
fn place(
    frame: &mut FrameSpec,
    index: usize,
    profile: &RailProfile,
    part: Option<(PlaneSection, f64)>,
    combined: &mut Vec<usize>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) {
    let FrameSpec { model, rails, .. } = frame;
    let Some((_, rail)) = rails.get_mut(index) else { return };
    let Some(along) = unit(rail.axis) else { return };
    let lift = dot(model.up, along);
    let Some(up) = unit(minus(model.up, along.map(|part| part * lift))) else { return };
    let mass = rolled::from_si(profile.mass, Dimension::LINE_MASS, check.scale.to);
    let height = profile.height * Length::Millimetre.in_units_of(check.scale.to.length);
    let mut done = Vec::new();
    for segment in &mut rail.segments {
        let member = segment.member;
        if !done.contains(&member) {
            done.push(member);
            let mut section = model.sections[model.members[member].section];
            let axis = axis_of(model, member);
            section.mass += mass * axis.map_or(1.0, |axis| dot(axis, along).abs());
            if let Some((part, centroid)) = &part {
                let carrier =
                    Carrier { axis, along, up, offset: segment.offset, taken: combined.contains(&member) };
                match carrier.with_rail(model, member, part, *centroid) {
                    Ok(whole) => section = CrossSection { mass: section.mass, ..whole },
                    Err((expected, hint)) => {
                        check.faults.add(Fault::new(&at.key("composite"), expected).at_key().hint(hint));
                        return;
                    }
                }
                combined.push(member);
            }
            model.members[member].section = index_of(model, section);
        }
        segment.offset = std::array::from_fn(|k| segment.offset[k] + height * up[k]);
    }
}

/// Unit vector from the flexible end a to the flexible end b of a member.
fn axis_of(model: &Model, member: usize) -> Option<[f64; 3]> {
    let member = &model.members[member];
    let [a, b] = [0, 1].map(|end| {
        let (point, offset) = (model.points[member.points[end]], member.offsets[end]);
        [point[0] + offset[0], point[1] + offset[1], point[2] + offset[2]]
    });
    unit(minus(b, a))
}

/// Index of a section with these properties, which is appended to the model if it has none.
fn index_of(model: &mut Model, section: CrossSection) -> usize {
    model.sections.iter().position(|other| *other == section).unwrap_or_else(|| {
        model.sections.push(section);
        model.sections.len() - 1
    })
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
    /// The section of the member and the rail; an expectation that is not met, with a hint.
    fn with_rail(
        &self,
        model: &Model,
        member: usize,
        rail: &PlaneSection,
        centroid: f64,
    ) -> Result<CrossSection, (&'static str, &'static str)> {
        let own = &model.members[member];
        let section = model.sections[own.section];
        let hint = "leave `composite` out and give the properties of the whole section as numbers";
        if own.kind != MemberKind::Beam {
            return Err(("the members of a composite rail must be beams", hint));
        }
        if self.taken {
            return Err(("a member can be a plane section with one rail only", hint));
        }
        let Some(axis) = self.axis.filter(|axis| parallel(*axis, self.along)) else {
            return Err(("the members of a composite rail must be parallel to it", hint));
        };
        let height = dot(self.offset, self.up);
        if height < 0.0 || dot(self.offset, cross(self.along, self.up)).abs() > IN_PLANE * (height + centroid)
        {
            return Err(("a composite rail must lie above the axes of its members", hint));
        }
        // the component of `orientation` normal to the member is local y
        let normal = cross(axis, own.orientation);
        let is_y_up = parallel(cross(normal, axis), self.up) && length(normal) > 0.0;
        let is_z_up = parallel(normal, self.up) && length(normal) > 0.0;
        if !is_y_up && !is_z_up {
            return Err(("a local axis of the members of a composite rail must be upright", hint));
        }
        let [i_vertical, i_lateral] =
            if is_y_up { [section.iz, section.iy] } else { [section.iy, section.iz] };
        let whole = PlaneSection { area: section.area, i_vertical, i_lateral };
        let (whole, _) = whole.with_rail(rail, height + centroid);
        let [iz, iy] =
            if is_y_up { [whole.i_vertical, whole.i_lateral] } else { [whole.i_lateral, whole.i_vertical] };
        Ok(CrossSection { area: whole.area, iz, iy, ..section })
    }
}
